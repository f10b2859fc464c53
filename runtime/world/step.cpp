// The steps of a frame: events that are due become a plan, the backend runs it, then the plan is
// committed. Nothing persistent changes before, so a failure leaves the world as it was.
#include "world/burn_system.h"

#include "core/growth.h"
#include "flamewright/flamewright_debug.h"
#include "world/exchange_system.h"
#include "world/room_system.h"
#include "world/wind_system.h"

#include <algorithm>
#include <tuple>

namespace fw::world {
namespace {

uint32_t firstReal(const mesh::BurnDomain& domain) noexcept {
    uint32_t texel = 0;
    while (texel + 1 < domain.texelCount() && !domain.real(texel)) ++texel;
    return texel;
}

}  // namespace

bool BurnSystem::keepsAwake() const noexcept {
    return (context_.switches & (FW_DEBUG_NEVER_IDLE | FW_DEBUG_DENSE)) != 0;
}

void BurnSystem::listLatches() noexcept {
    frame_.latches.clear();
    ++state_.planStamp;
    const uint64_t wind = wind_.changes() + 1;
    for (Object* object : scene_.touched) {
        // Where fire goes from object to object, many wait for it under a wind that they know.
        if (exchange_.isOn() && !wind_.hasGusts()) {
            if (object->sleepsUnder == wind) continue;
            if (components::atRest(object->data, scene_.domainOf(*object),
                                   wind_.driveInput(*object, context_.clock.tick), object->latch)) {
                object->sleepsUnder = wind;
                continue;
            }
        }
        addLatch(*object, object->latch);
    }
    frame_.spreadFrom = frame_.latches.size();
    frame_.spreadFound = frame_.waitersTouched = false;
}

gpu::StepPlan BurnSystem::planStep(uint32_t now, size_t& nextDue, bool awake) {
    gpu::StepPlan plan;
    plan.now = now;
    plan.reduce = reducesAt(now);
    plan.heat = heatsAt(now);
    plan.rooms = plan.heat && rooms_.state().met;
    const size_t firstEvent = frame_.events.size(), firstDue = nextDue;
    for (; nextDue < frame_.due.size() && frame_.due[nextDue].tick < now + gpu::kStepTicks;
         ++nextDue) {
        const PendingTexel& event = frame_.due[nextDue];
        frame_.events.push_back(
            {event.object, event.texel, event.kind,
             event.kind == FW_WET || event.kind >= gpu::kEventHeat ? event.water : event.tick});
    }
    const auto due = std::span(frame_.due).subspan(firstDue, nextDue - firstDue);
    plan.plays = !frame_.plays.empty();
    planPlays(now, due);
    planGates(due, firstEvent);
    plan.events = std::span<const gpu::TexelEvent>(frame_.events).subspan(firstEvent);
    exchange_.plan(plan, now, awake);
    planLatches(now, firstEvent, plan.exchangeUpdate != nullptr);
    return plan;
}

// The largest shift that any object at work needs, before or after a latch, serves all steps of the
// frame: an object takes part in as many iterations as its own shift says.
uint32_t BurnSystem::substepShift() const noexcept {
    uint32_t shift = 0;
    const bool others = exchange_.isOn();  // then any of them may burn before a readback says so
    for (const Object* object : scene_.touched)
        if (others) shift = std::max(shift, object->latch.substepShift);
    for (const Frame::LatchOf& entry : frame_.latches)
        if (others || isActive(*entry.object) || entry.due)
            shift = std::max({shift, entry.latch.substepShift, entry.object->latch.substepShift});
    return shift;
}

void BurnSystem::plan(const HostFrame& frame, gpu::FramePlan& plan) {
    const ClockAdvance& time = frame.time;
    FW_ASSERT(time.steps <= kMaxSteps, "%u steps", time.steps);
    frame_.steps.clear();
    frame_.events.clear();
    frame_.updates.clear();
    frame_.due.clear();
    waitForTransfers();
    const auto begin = uint32_t(context_.clock.tick);
    size_t gates = 0;
    for (const PendingTexel& event : state_.pending) {
        if (event.tick >= time.after.tick) continue;
        frame_.due.push_back(event);
        frame_.due.back().tick = std::max(event.tick, begin);  // never before its step
        gates += event.gateCount;
    }
    sortDue();
    const size_t plays = beginPlays(time.after.tick);
    // Spans into it must hold. An object that plays and is disturbed has one more.
    core::growTo(frame_.events, frame_.due.size() + gates + plays + frame_.plays.size());
    exchange_.beginFrame();
    const bool awake = !state_.idle || !frame_.due.empty() || plays > 0 || keepsAwake();
    listLatches();
    // Updates of all steps share one vector; its size is known only when all are there.
    size_t firstUpdate[kMaxSteps + 1] = {};
    size_t nextDue = 0;
    for (uint32_t step = 0; step < time.steps; ++step) {
        firstUpdate[step] = frame_.updates.size();
        frame_.steps.push_back(planStep(begin + step * gpu::kStepTicks, nextDue, awake));
    }
    firstUpdate[time.steps] = frame_.updates.size();
    const uint32_t shift = substepShift();
    for (uint32_t step = 0; step < time.steps; ++step) {
        frame_.steps[step].substepShift = shift;
        frame_.steps[step].materials =
            std::span<const gpu::MaterialUpdate>(frame_.updates)
                .subspan(firstUpdate[step], firstUpdate[step + 1] - firstUpdate[step]);
    }
    FW_ASSERT(nextDue == frame_.due.size(), "%zu of %zu events", nextDue, frame_.due.size());
    planBreaks(time.after.tick);
    reserveStimuli();
    // Nothing listed, nothing new: time passes without the device.
    const bool isSleeping = state_.idle && rooms_.isSettled(rooms_.state().stirred) &&
                            frame_.events.empty() && frame_.updates.empty() && !keepsAwake();
    if (!isSleeping) plan.steps = frame_.steps;
}

// By step, object and texel. An event of all texels stays one only where no other event of the step
// is of some of them: their order is by texel.
void BurnSystem::sortDue() {
    auto& due = frame_.due;
    const auto stepOf = [](const PendingTexel& event) { return event.tick / gpu::kStepTicks; };
    const auto sort = [&] {
        std::sort(due.begin(), due.end(), [&](const PendingTexel& a, const PendingTexel& b) {
            return std::tuple(stepOf(a), a.object, a.texel, a.order) <
                   std::tuple(stepOf(b), b.object, b.texel, b.order);
        });
    };
    sort();
    constexpr uint32_t kErased = ~0u;  // tick
    bool spread = false;
    for (size_t first = 0, end = 0, count = due.size(); first < count; first = end) {
        while (end < count && stepOf(due[end]) == stepOf(due[first]) &&
               due[end].object == due[first].object)
            ++end;
        if (due[first].texel == kAllTexels || due[end - 1].texel != kAllTexels) continue;
        const mesh::BurnDomain& domain = scene_.domainOf(scene_.objectAt(due[first].object));
        for (size_t i = first; i < end; ++i) {
            if (due[i].texel != kAllTexels) continue;
            PendingTexel one = due[i];
            due[i].tick = kErased;
            for (uint32_t texel = 0; texel < domain.texelCount(); ++texel) {
                if (!domain.real(texel)) continue;
                one.texel = texel;
                due.push_back(one);
            }
            spread = true;
        }
    }
    if (!spread) return;
    std::erase_if(due, [](const PendingTexel& one) { return one.tick == kErased; });
    sort();
}

// The holes that a batch's heat came through, after its events: once for equal chains of holes.
void BurnSystem::planGates(std::span<const PendingTexel> due, size_t firstEvent) {
    constexpr size_t kRecent = 64;  // chains that are compared
    std::array<std::pair<const PendingTexel*, uint32_t>, kRecent> known;
    size_t count = 0;
    const auto same = [](const PendingTexel& a, const PendingTexel& b) {
        return a.shut == b.shut && std::ranges::equal(std::span(a.gates).first(a.gateCount),
                                                      std::span(b.gates).first(b.gateCount));
    };
    for (size_t i = 0; i < due.size(); ++i) {
        const PendingTexel& event = due[i];
        FW_ASSERT(event.gateCount <= event.gates.size(), "%u gates", event.gateCount);
        if (event.gateCount == 0) continue;
        uint32_t at = 0;
        for (size_t k = 0; k < std::min(count, kRecent) && at == 0; ++k)
            if (same(*known[k].first, event)) at = known[k].second;
        if (at == 0) {
            at = uint32_t(frame_.events.size() - firstEvent) + 1;
            known[count++ % kRecent] = {&event, at};
            for (uint32_t k = 0; k < event.gateCount; ++k) {
                const bool last = k + 1 == event.gateCount;
                const uint32_t kind = gpu::kEventGate | (last && event.shut ? gpu::kGateShut : 0u) |
                                      (last ? 0u : gpu::kGateMore);
                const components::JetGate& gate = event.gates[k];
                frame_.events.push_back({gate.object, gate.texel, kind, gate.holeTicks});
            }
        }
        frame_.events[firstEvent + i].kind |= at << gpu::kEventKindBits;
    }
}

// All objects that an event addresses are among the latches.
void BurnSystem::touchLatched(uint64_t frameIndex) noexcept {
    for (const Frame::LatchOf& entry : frame_.latches) {
        entry.object->latch = entry.latch;
        entry.object->sleepsUnder = 0;
    }
    const size_t touchedBefore = scene_.touched.size();
    for (const Frame::LatchOf& entry : frame_.latches) {
        Object& object = *entry.object;
        if (object.touched) continue;
        FW_ASSERT(scene_.touched.size() < scene_.touched.capacity(), "%zu objects",
                  scene_.touched.size());
        object.touched = true;
        Stimulus& stimulus = stimulusOf(object, frameIndex);
        stimulus.first = true;
        stimulus.heatSteps = heatStepsBefore(context_.clock.tick);
        scene_.touched.push_back(&object);
    }
    const auto bySlot = [](const Object* a, const Object* b) { return a->slot < b->slot; };
    if (scene_.touched.size() != touchedBefore &&
        !std::is_sorted(scene_.touched.begin(), scene_.touched.end(), bySlot))
        std::sort(scene_.touched.begin(), scene_.touched.end(), bySlot);
}

void BurnSystem::stimulateDue(uint64_t frameIndex) noexcept {
    for (const PendingTexel& due : frame_.due) {
        Object& object = scene_.objectAt(due.object);
        ++object.changes;
        Stimulus& stimulus = stimulusOf(object, frameIndex);
        stimulus.starts = true;
        stimulus.latest = std::max<uint64_t>(stimulus.latest, due.tick);
        if (isCarry(due)) stimulus.from1 = carriedFrom(due) + 1;
        if (due.kind == FW_IGNITE) {
            const uint32_t texel =
                due.texel == kAllTexels ? firstReal(scene_.domainOf(object)) : due.texel;
            recordIgnition(object, stimulus, texel, due.tick);
        } else if (due.kind == FW_WET || due.kind == FW_EXTINGUISH) {
            stimulus.douses = true;
            stimulus.douse = due.tick;
            stimulus.douseCause =
                due.kind == FW_WET ? FW_EXTINGUISHED_BY_WATER : FW_EXTINGUISHED_BY_CALL;
        }
    }
}

void BurnSystem::commit(const HostFrame& frame) noexcept {
    touchLatched(frame.index);
    exchange_.commit(frame_.spreadFound, frame_.waitersTouched);
    stimulateDue(frame.index);
    commitPlays(frame.index);
    commitStimuli(frame);
    commitBreaks(frame.index);
    std::erase_if(state_.pending, [&](const PendingTexel& p) { return p.tick < frame.end(); });
    if (!frame_.events.empty()) {
        state_.idle = false;
        state_.lastStimulus = frame.end();
    }
    if (frame.time.dropped == 0) return;
    state_.droppedSteps += frame.time.dropped;
    const float nowhere[3] = {};
    context_.raise(FW_EVENT_TIME_DROPPED, nullptr, 0, frame.index, nowhere,
                   float(frame.time.dropped) / 32.0f);
}

// So that a warmed-up frame finds its capacity: one latch and update per object.
void BurnSystem::reserveSlots() {
    const size_t slots = scene_.objects.slotCount();
    core::growTo(frame_.latches, slots);
    core::growTo(frame_.updates, slots);
    core::growTo(frame_.breaks, slots);
}

void BurnSystem::forgetObject(const Object& object) noexcept {
    const uint32_t slot = object.slot;
    std::erase_if(state_.pending, [&](const PendingTexel& p) {
        bool there = p.object == slot;
        for (uint32_t g = 0; g < p.gateCount; ++g) there |= p.gates[g].object == slot;
        return there;
    });
    std::erase_if(state_.stimuli, [&](const Stimulus& one) { return one.slot == slot; });
}

uint64_t BurnSystem::bytes() const noexcept {
    return frame_.latches.capacity() * sizeof(Frame::LatchOf) +
           frame_.updates.capacity() * sizeof(gpu::MaterialUpdate) +
           frame_.due.capacity() * sizeof(PendingTexel) +
           frame_.events.capacity() * sizeof(gpu::TexelEvent) +
           state_.pending.capacity() * sizeof(PendingTexel);
}

}  // namespace fw::world
