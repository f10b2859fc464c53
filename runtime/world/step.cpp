// One frame: what is due becomes a plan, the backend runs it, then the world takes it over. Nothing
// persistent changes before the backend is through, so a failure leaves the world as it was.
#include "core/growth.h"
#include "world/world.h"

#include <algorithm>
#include <tuple>

namespace fw::world {
namespace {

constexpr size_t kMaxBurnMapsPerFrame = 64;

uint32_t firstReal(const mesh::BurnDomain& domain) noexcept {
    uint32_t texel = 0;
    while (texel + 1 < domain.texelCount() && !domain.real(texel)) ++texel;
    return texel;
}

// Does it want the state of this frame? One that runs still answers what was asked before.
bool startsForecast(const Object& object) noexcept {
    return object.forecast && object.forecast->wished && !object.forecast->pending &&
           object.forecast->arrivals.whole;
}

}  // namespace

void World::checkFrame(uint64_t frameIndex, float deltaTime) const {
    components::checkValue(deltaTime, "deltaTime", 0.0f, 10.0f);
    if (frameIndex <= lastFrame_)
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "frameIndex is %llu and the last frame was %llu; it grows.",
                   static_cast<unsigned long long>(frameIndex),
                   static_cast<unsigned long long>(lastFrame_));
    if (deltaTime > 0 && clock_.tick >= Clock::kLastTick)
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "The world has simulated %llu s, which is the limit; create a new one. With "
                   "deltaTime 0 it can still be drawn and asked.",
                   static_cast<unsigned long long>(Clock::kLastTick / 4096));
    if (!recording_ || !recording_->follows) return;
    const uint64_t end = fw::world::advance(clock_, deltaTime, def_.maxStepsPerFrame).after.tick;
    if (end > std::max(recording_->until, clock_.tick))
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "deltaTime is %g; the world follows a server's, and fwNet_TakeTurn says how "
                   "far a frame may go.",
                   double(deltaTime));
}

void World::advance(uint64_t frameIndex, float deltaTime) {
    checkFrame(frameIndex, deltaTime);
    collectReadbacks();
    settleWind();
    const ClockAdvance time = fw::world::advance(clock_, deltaTime, def_.maxStepsPerFrame);
    const size_t waiting = pending_.size();
    ++sweeps_;
    try {
        touchByFires(time.after.tick);
        planSteps(time);
        planProbes();
        if (recording_) planHashes(time);
        planTimeline(time.after.tick);
        planSave();
        planBreaks(time.after.tick);
        reserveStimuli();
    } catch (...) {
        pending_.resize(waiting);
        throw;
    }
    planFires(deltaTime);
    planEmitters(deltaTime);
    planFields(time);

    // Nothing listed, nothing new: time passes without the device.
    const bool skip = idle_ && roomsRest(roomsStirred_) && frame_.events.empty() &&
                      frame_.updates.empty() &&
                      !(switches_ & (FW_DEBUG_NEVER_IDLE | FW_DEBUG_DENSE));
    gpu::FramePlan plan;
    plan.frameIndex = frameIndex;
    if (!skip) plan.steps = frame_.steps;
    plan.probes = frame_.probes;
    plan.burnMaps = frame_.burnMaps;
    plan.images = frame_.images;
    plan.switches = switches_;
    plan.endTick = uint32_t(time.after.tick);
    std::copy_n(wind_, 3, plan.wind);
    if (frame_.volumesDue) plan.volumes = &frame_.volumes;
    if (frame_.emittersDue) plan.emitters = &frame_.emitters;
    if (frame_.fieldsDue) plan.fields = &frame_.fields;
    plan.tickFraction = float(double(time.after.fraction) / double(Clock::kStepUnits));
    spent_.bytes = double(backend_.detailBytes());
    govern(budget_, spent_, governor_);
    spent_.cpu = 0;
    plan.detail = detailOf(governor_.level);
    if (!(budget_.bytes > 0)) plan.detail.memory = 1;
    backend_.run(plan);

    commitFrame(frameIndex, time);
    commitEmitters(deltaTime);
    followLights(deltaTime);
    commitSave(frameIndex);
    collect();
    runForecasts();
}

void World::planSteps(const ClockAdvance& time) {
    frame_.steps.clear();
    frame_.events.clear();
    frame_.updates.clear();
    frame_.latches.clear();
    frame_.due.clear();
    const uint64_t end = time.after.tick;
    waitForCarries();
    for (const PendingTexel& event : pending_) {
        if (event.tick >= end) continue;
        const uint64_t at = std::max<uint64_t>(event.tick, clock_.tick);
        frame_.due.push_back({event, uint32_t((at - clock_.tick) / gpu::kStepTicks)});
        frame_.due.back().event.tick = uint32_t(at);  // never before its step
    }
    sortDue();
    size_t gates = 0;
    for (const Frame::Due& due : frame_.due) gates += due.event.gateCount;
    const size_t plays = beginPlays(end);
    // Spans into it must hold. Who plays and is disturbed has one more.
    core::growTo(frame_.events, frame_.due.size() + gates + plays + frame_.plays.size());
    frame_.remoteUsed = 0;
    frame_.remoteLatched = frame_.remoteFlushed = frame_.shieldSent = false;
    frame_.spreadFound = frame_.waitersTouched = false;
    ++planStamp_;
    const bool awake = !idle_ || !frame_.due.empty() || plays > 0 ||
                       (switches_ & (FW_DEBUG_NEVER_IDLE | FW_DEBUG_DENSE)) != 0;
    for (Object* object : touched_) {
        // Where fire goes from object to object, many wait for it under a wind that they know.
        if (remoteOn() && !gusty()) {
            if (object->restsUnder == driveChanges_ + 1) continue;
            if (components::atRest(object->data, domainOf(*object),
                                   driveInput(*object, clock_.tick), object->latch)) {
                object->restsUnder = driveChanges_ + 1;
                continue;
            }
        }
        addLatch(*object, object->latch, false);
    }
    frame_.spreadFrom = frame_.latches.size();

    // Updates of all steps share one vector; its room is known only when all are there.
    size_t firstUpdate[kMaxSteps + 1] = {};
    size_t nextDue = 0;
    for (uint32_t step = 0; step < time.steps; ++step) {
        const uint32_t now = uint32_t(clock_.tick) + step * gpu::kStepTicks;
        gpu::StepPlan plan;
        plan.now = now;
        plan.reduce = reducesAt(now);
        plan.heat = heatsAt(now);
        plan.rooms = plan.heat && roomsMet_;
        const size_t firstEvent = frame_.events.size(), firstDue = nextDue;
        for (; nextDue < frame_.due.size() && frame_.due[nextDue].step == step; ++nextDue) {
            const PendingTexel& event = frame_.due[nextDue].event;
            frame_.events.push_back(
                {event.object, event.texel, event.kind,
                 event.kind == FW_WET || event.kind >= gpu::kEventHeat ? event.water : event.tick});
        }
        const auto due = std::span(frame_.due).subspan(firstDue, nextDue - firstDue);
        plan.plays = !frame_.plays.empty();
        planPlays(now, due);
        planGates(due, firstEvent);
        plan.events = std::span<const gpu::TexelEvent>(frame_.events).subspan(firstEvent);
        firstUpdate[step] = frame_.updates.size();
        planRemote(plan, now, awake);
        planLatches(now, firstEvent, plan.remote != nullptr);
        frame_.steps.push_back(plan);
    }
    firstUpdate[time.steps] = frame_.updates.size();
    // The largest shift that any object at work wants, before or after a latch, serves all steps
    // of the frame: an object takes part in as many iterations as its own shift says.
    uint32_t shift = 0;
    const bool others = remoteOn();  // then any of them may burn before we hear of it
    for (const Object* object : touched_)
        if (others) shift = std::max(shift, object->latch.substepShift);
    for (const Frame::LatchOf& entry : frame_.latches)
        if (others || isActive(*entry.object) || entry.due)
            shift = std::max({shift, entry.latch.substepShift, entry.object->latch.substepShift});
    for (uint32_t step = 0; step < time.steps; ++step) {
        frame_.steps[step].substepShift = shift;
        frame_.steps[step].materials =
            std::span<const gpu::MaterialUpdate>(frame_.updates)
                .subspan(firstUpdate[step], firstUpdate[step + 1] - firstUpdate[step]);
    }
}

// By step, object and texel. An event of all texels stays one only where no other event of the step
// is of some of them: their order is by texel.
void World::sortDue() {
    auto& due = frame_.due;
    const auto sort = [&] {
        std::sort(due.begin(), due.end(), [](const Frame::Due& a, const Frame::Due& b) {
            return std::tie(a.step, a.event.object, a.event.texel, a.event.order) <
                   std::tie(b.step, b.event.object, b.event.texel, b.event.order);
        });
    };
    sort();
    bool spread = false;
    for (size_t first = 0, end = 0, count = due.size(); first < count; first = end) {
        while (end < count && due[end].step == due[first].step &&
               due[end].event.object == due[first].event.object)
            ++end;
        if (due[first].event.texel == kAllTexels || due[end - 1].event.texel != kAllTexels)
            continue;
        const mesh::BurnDomain& domain = domainOf(**objects_.at(due[first].event.object));
        for (size_t i = first; i < end; ++i) {
            if (due[i].event.texel != kAllTexels) continue;
            Frame::Due one = due[i];
            due[i].step = kMaxSteps;  // to be erased
            for (uint32_t texel = 0; texel < domain.texelCount(); ++texel) {
                if (!domain.real(texel)) continue;
                one.event.texel = texel;
                due.push_back(one);
            }
            spread = true;
        }
    }
    if (!spread) return;
    std::erase_if(due, [](const Frame::Due& one) { return one.step == kMaxSteps; });
    sort();
}

// What a batch's heat came through, after its events: once for those that came the same way.
void World::planGates(std::span<const Frame::Due> due, size_t firstEvent) {
    constexpr size_t kRecent = 64;  // ways that are looked for
    std::array<std::pair<const PendingTexel*, uint32_t>, kRecent> known;
    size_t count = 0;
    const auto same = [](const PendingTexel& a, const PendingTexel& b) {
        if (a.gateCount != b.gateCount || a.shut != b.shut) return false;
        for (uint32_t k = 0; k < a.gateCount; ++k)
            if (a.gates[k] != b.gates[k]) return false;
        return true;
    };
    for (size_t i = 0; i < due.size(); ++i) {
        const PendingTexel& event = due[i].event;
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

void World::planProbes() {
    ProbeFrame& known = probeFrames_[frames_ % kFramesInFlight];
    frame_.probes.clear();
    known.frameIndex = 0;
    known.refs.clear();
    const size_t most = tags_.size() + queries_.live();  // those of jets have room
    frame_.probes.reserve(most);
    known.refs.reserve(most);
    for (const Tag& tag : tags_) {
        frame_.probes.push_back({tag.object.index1 - 1, tag.texel});
        known.refs.push_back({true, tag.object, tag.texel, tag.tag, {}, 0, 0, 0});
    }
    for (uint32_t i = 0; i < queries_.slotCount(); ++i) {
        const Query* query = queries_.at(i);
        if (!query || query->asked || query->isArrival) continue;
        frame_.probes.push_back({query->object.index1 - 1, query->texel});
        known.refs.push_back({false, query->object, query->texel, 0, queries_.idOf(i), 0, 0, 0});
    }
    wishForecasts();
    probeJets(known);
    frame_.burnMaps.clear();
    for (uint32_t i = 0; mapsWished_ > 0 && i < objects_.slotCount(); ++i)
        if (auto* object = objects_.at(i); object &&
                                           frame_.burnMaps.size() < kMaxBurnMapsPerFrame &&
                                           ((*object)->map.wished || startsForecast(**object)))
            frame_.burnMaps.push_back(i);  // the others wait for the next frame
}

void World::commitFrame(uint64_t frameIndex, const ClockAdvance& time) noexcept {
    ProbeFrame& known = probeFrames_[frames_ % kFramesInFlight];
    known.frameIndex = frameIndex;
    for (const ProbeRef& ref : known.refs)
        if (!ref.isTag)
            if (Query* query = queries_.find(ref.query)) query->asked = true;
    for (const Frame::LatchOf& entry : frame_.latches) {
        entry.object->latch = entry.latch;
        entry.object->restsUnder = 0;
    }
    // All objects that an event addresses are among the latches.
    const size_t touchedBefore = touched_.size();
    for (const Frame::LatchOf& entry : frame_.latches) {
        Object& object = *entry.object;
        if (object.touched) continue;  // room for every object was found at its creation
        object.touched = true;
        Stimulus& stimulus = stimulusOf(object, frameIndex);
        stimulus.first = true;
        stimulus.heatSteps = heatStepsBefore(clock_.tick);
        touched_.push_back(&object);
    }
    const auto bySlot = [](const Object* a, const Object* b) { return a->slot < b->slot; };
    if (touched_.size() != touchedBefore &&
        !std::is_sorted(touched_.begin(), touched_.end(), bySlot))
        std::sort(touched_.begin(), touched_.end(), bySlot);
    commitRemote();
    for (const Frame::Due& due : frame_.due) {
        Object& object = **objects_.at(due.event.object);
        ++object.changes;
        Stimulus& stimulus = stimulusOf(object, frameIndex);
        stimulus.starts = true;
        stimulus.latest = std::max<uint64_t>(stimulus.latest, due.event.tick);
        if (isCarry(due.event)) stimulus.from1 = carriedFrom(due.event) + 1;
        if (due.event.kind == FW_IGNITE) {
            const uint32_t texel =
                due.event.texel == kAllTexels ? firstReal(domainOf(object)) : due.event.texel;
            noteIgnition(object, stimulus, texel, due.event.tick);
        } else if (due.event.kind == FW_WET || due.event.kind == FW_EXTINGUISH) {
            stimulus.douses = true;
            stimulus.douse = due.event.tick;
            stimulus.douseCause =
                due.event.kind == FW_WET ? FW_EXTINGUISHED_BY_WATER : FW_EXTINGUISHED_BY_CALL;
        }
    }
    commitPlays(frameIndex);
    commitStimuli(time, frameIndex);
    commitBreaks(frameIndex);
    for (uint32_t slot : frame_.burnMaps) {
        Object& object = **objects_.at(slot);
        const auto send = [&](bool& wished, bool& pending) {
            if (!wished) return;
            wished = false;
            pending = true;
            --mapsWished_;
        };
        send(object.map.wished, object.map.pending);
        if (!startsForecast(object)) continue;
        object.forecast->pendingChanges = changesOf(object);
        send(object.forecast->wished, object.forecast->pending);
    }
    const uint64_t end = time.after.tick;
    std::erase_if(pending_, [&](const PendingTexel& p) { return p.tick < end; });
    if (!frame_.events.empty()) {
        idle_ = false;
        lastStimulus_ = end;
    }
    if (clock_.tick < Clock::kWarnTick && time.after.tick >= Clock::kWarnTick)
        log_.write(FW_LOG_WARNING, "A world has a day left: it simulates at most %llu s.",
                   static_cast<unsigned long long>(Clock::kLastTick / 4096));
    commitFires();
    commitFields(time.after.tick);
    const uint64_t before = clock_.tick;
    clock_ = time.after;
    commitTimeline(before);
    lastFrame_ = frameIndex;
    countMemory();
    ++frames_;
    if (time.dropped > 0) {
        droppedSteps_ += time.dropped;
        const float nowhere[3] = {};
        raise(FW_EVENT_TIME_DROPPED, nullptr, 0, frameIndex, nowhere, float(time.dropped) / 32.0f);
    }
}

}  // namespace fw::world
