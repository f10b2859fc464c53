// The course of each object's fire: counters of readbacks become events and figures. Allocates
// nothing itself.
#include "world/burn_system.h"

#include "core/growth.h"
#include "world/exchange_system.h"
#include "world/room_system.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace fw::world {
namespace {

// Counters of `reduce` are at most 4 steps old; a fire is judged only well after its last event.
constexpr uint64_t kSettleTicks = 6 * gpu::kStepTicks;
constexpr uint64_t kWaterWorks = 2 * gpu::kTicksPerSecond;  // until it has put out what it hit
constexpr uint32_t kReportedClampStep = 32;

// Fire may come to it, and none has: its counters have not changed.
bool waitsForFire(const Object& object, const gpu::ObjectCounters& now) noexcept {
    return now.ignited == 0 && now.burning == 0 && !object.lifecycle.active &&
           !object.lifecycle.sawFire && object.play.began == 0 && object.lifecycle.power == 0 &&
           std::memcmp(&now, &object.counters, sizeof now) == 0;
}

}  // namespace

BurnSystem::BurnSystem(const WorldContext& context, Scene& scene, const WindSystem& wind,
                       RoomSystem& rooms, ExchangeSystem& exchange)
    : context_(context), scene_(scene), wind_(wind), rooms_(rooms), exchange_(exchange) {
    frame_.steps.reserve(kMaxSteps);
}

// One for each object that the frame may address.
void BurnSystem::reserveStimuli() {
    const size_t most = std::min<size_t>(
        frame_.due.size() + frame_.latches.size() + frame_.plays.size(), scene_.objects.live());
    core::growTo(state_.stimuli, state_.stimuli.size() + most);
    core::growTo(state_.frameNotes, state_.frameNotes.size() + 1);
}

Stimulus& BurnSystem::stimulusOf(Object& object, uint64_t frameIndex) noexcept {
    if (object.stimulusAt == mesh::kNone) {
        object.stimulusAt = uint32_t(state_.stimuli.size());
        ++object.stimuli;
        FW_ASSERT(state_.stimuli.size() < state_.stimuli.capacity(), "%zu stimuli",
                  state_.stimuli.size());
        state_.stimuli.push_back({frameIndex, object.slot});
    }
    FW_ASSERT(object.stimulusAt < state_.stimuli.size(), "%u of %zu stimuli", object.stimulusAt,
              state_.stimuli.size());
    return state_.stimuli[object.stimulusAt];
}

void BurnSystem::recordIgnition(Object& object, Stimulus& stimulus, uint32_t texel,
                                uint32_t tick) noexcept {
    if (stimulus.ignites) return;
    stimulus.ignites = true;
    stimulus.ignition = tick;
    scene_.texelPlace(object, texel, stimulus.ignitionPoint);
    if (!object.lifecycle.ignitionKnown && !object.lifecycle.sawFire && !object.ignites)
        context_.backend.startBoundary(object.slot, stimulus.ignitionPoint, tick);
    object.ignites = true;
}

void BurnSystem::commitStimuli(const HostFrame& frame) noexcept {
    for (size_t i = state_.stimuli.size(); i-- > 0 && state_.stimuli[i].frameIndex == frame.index;)
        scene_.objectAt(state_.stimuli[i].slot).stimulusAt = mesh::kNone;
    InFlightFrame note;
    note.frameIndex = frame.index;
    note.end = frame.end();
    note.roomsStirred = rooms_.state().stirred;
    note.steps = frame.time.steps;
    note.stirs = !frame_.events.empty();
    note.never = keepsAwake();
    FW_ASSERT(state_.frameNotes.size() < state_.frameNotes.capacity(), "%zu frames in flight",
              state_.frameNotes.size());
    state_.frameNotes.push_back(note);
}

// With the readback of a frame, before anything else of it.
void BurnSystem::onFrameDone(uint64_t frameIndex) noexcept {
    std::erase_if(state_.frameNotes, [&](const InFlightFrame& note) {
        if (note.frameIndex > frameIndex) return false;
        rooms_.onFrameDone(note.roomsStirred);
        if (!state_.seenIdle || note.stirs || note.never ||
            !rooms_.isSettled(rooms_.state().seenStirred))
            state_.steps += note.steps;
        state_.seenIdle &= !note.stirs;
        if (note.stirs) state_.seenStimulus = note.end;
        return true;
    });
    std::erase_if(state_.stimuli, [&](const Stimulus& one) {
        if (one.frameIndex > frameIndex) return false;
        Object& object = scene_.objectAt(one.slot);
        BurnLifecycle& lifecycle = object.lifecycle;
        FW_ASSERT(object.stimuli > 0, "burnable mesh %u", object.id.index1);
        if (--object.stimuli == 0) object.ignites = false;
        if (one.from1 != 0)
            continueBurn(object, one.given ? *one.given : scene_.objectAt(one.from1 - 1).lifecycle);
        if (one.first) lifecycle.heatSteps = one.heatSteps;
        if (one.starts) {
            lifecycle.active = true;
            lifecycle.lastStimulus = std::max(lifecycle.lastStimulus, one.latest);
        }
        if (one.ignites && !lifecycle.ignitionKnown && !lifecycle.sawFire) {
            lifecycle.ignitionKnown = true;
            lifecycle.firstIgnition = one.ignition;
            std::copy_n(one.ignitionPoint, 3, lifecycle.ignitionPoint);
        }
        if (one.douses) {
            lifecycle.lastDouse = one.douse;
            lifecycle.douseCause = one.douseCause;
        }
        return true;
    });
}

void BurnSystem::onReadback(const gpu::Readback& readback) noexcept {
    BurnCounts& counts = state_.counts;
    BurnCounts& loaded = state_.loaded;
    const uint64_t end = readback.endTick;
    // Of a save it is known how many there were, until they are counted again.
    const bool counted = context_.loadedTick == ~0ull || lastReduced(end) > context_.loadedTick;
    if (counted) loaded.receivers = loaded.burning = 0;
    if (end > context_.loadedTick) loaded.front = 0;
    if (heatStepsBefore(end) > heatStepsBefore(context_.loadedTick)) loaded.hot = 0;
    counts.run = readback.runTiles;
    counts.front = readback.frontTiles + loaded.front;
    counts.hot = readback.hotTiles + loaded.hot;
    counts.burning = counted ? readback.burningTiles : loaded.burning;
    counts.receivers = std::max(readback.receivers, loaded.receivers);
    applyCounters(readback);
}

void BurnSystem::settle(const gpu::Readback& readback) noexcept {
    const BurnCounts& counts = state_.counts;
    const bool isSleeping =
        counts.front == 0 && counts.burning == 0 && counts.hot == 0 && counts.receivers == 0;
    state_.seenIdle |= isSleeping && readback.endTick >= state_.seenStimulus + kSettleTicks;
    if (isSleeping && readback.endTick >= state_.lastStimulus + kSettleTicks) state_.idle = true;
}

void BurnSystem::applyCounters(const gpu::Readback& readback) noexcept {
    uint32_t clamps = 0;
    for (Object* touched : scene_.touched) {
        Object& object = *touched;
        const uint32_t slot = object.slot;
        if (slot >= readback.objects.size() || object.firstFrame > readback.frameIndex) continue;
        const gpu::ObjectCounters& now = readback.objects[slot];
        object.countersFrame = readback.frameIndex;
        clamps += now.lateClamps;
        if (waitsForFire(object, now)) {
            if (components::hasHeat(object.data))
                object.lifecycle.heatSteps = heatStepsBefore(readback.endTick);
            continue;
        }
        const gpu::ObjectCounters before = object.counters;
        object.counters = now;
        object.lifecycle.maxIgnited = std::max(object.lifecycle.maxIgnited, now.ignited);
        if (object.play.began != 0 && readback.endTick >= object.play.began &&
            !gpu::isPlayingBack(now.playsUntil, readback.endTick))
            endPlay(object, readback.frameIndex, now.playsUntil);  // others' fire came
        applyEnergy(object, readback.endTick);
        exchange_.onCounters(object, readback);
        BurnLifecycle& lifecycle = object.lifecycle;
        const auto raise = [&](uint32_t type, uint32_t tag, float value) {
            float place[3];
            components::toWorld(object.data.pose, lifecycle.ignitionPoint, place);
            context_.raise(type, &object, tag, readback.frameIndex, place, value);
        };
        if (now.burning > 0) lifecycle.lastBurning = readback.endTick;
        countFlames(object, before, readback.endTick);

        const bool freshFire = now.ignited > before.ignited || now.burning > 0;
        if (!lifecycle.sawFire && now.ignited > 0 && freshFire) {
            lifecycle.sawFire = true;
            lifecycle.active = true;
            const uint64_t tick =
                lifecycle.ignitionKnown ? lifecycle.firstIgnition : now.lastIgnition;
            raise(FW_EVENT_IGNITED, 0, float(double(tick) / gpu::kTicksPerSecond));
        }
        // A few late arrivals come with any change of the wind; only many of them are a limit.
        const uint32_t limit = std::max(kReportedClampStep, now.ignited / 50);
        if (now.lateClamps >= lifecycle.clampsReported + limit) {
            raise(FW_EVENT_FRONT_LIMITED, 0, float(now.lateClamps - lifecycle.clampsReported));
            lifecycle.clampsReported = now.lateClamps;
        }
        const bool settled = now.burning == 0 && now.frontTiles == 0 &&
                             readback.endTick >= lifecycle.lastStimulus + kSettleTicks &&
                             readback.endTick >= uint64_t(now.lastIgnition) + kSettleTicks;
        if (settled && lifecycle.active) {
            lifecycle.active = false;
            if (lifecycle.sawFire) {
                const float fraction =
                    object.texels ? float(lifecycle.maxIgnited) / float(object.texels) : 0.0f;
                // At least half of its last flames left fuel behind.
                const bool out = lifecycle.wentOut > 0 &&
                                 lifecycle.wentOut >= lifecycle.flames - lifecycle.wentOut;
                raise(out ? FW_EVENT_EXTINGUISHED : FW_EVENT_BURNT_OUT,
                      out ? lifecycle.outCause : 0u, fraction);
            }
            lifecycle.sawFire = false;
            lifecycle.ignitionKnown = false;
            lifecycle.flames = lifecycle.wentOut = lifecycle.outCause = 0;
        }
    }
    state_.counts.lateClamps = clamps;
}

// A texel that burnt out is a source for good; one that went out is none any more.
void BurnSystem::countFlames(Object& object, const gpu::ObjectCounters& before,
                             uint32_t endTick) noexcept {
    const gpu::ObjectCounters& now = object.counters;
    BurnLifecycle& lifecycle = object.lifecycle;
    const uint32_t out = before.ignited - std::min(before.ignited, now.ignited);
    if (now.burning == 0 && before.burning == 0 && out == 0) return;
    const uint64_t seconds =
        endTick / gpu::kTicksPerSecond -
        std::min<uint64_t>(endTick, lifecycle.halvedUntil) / gpu::kTicksPerSecond;
    const uint64_t halvings = std::min<uint64_t>(seconds, 31);
    lifecycle.halvedUntil = endTick;
    lifecycle.wentOut = (lifecycle.wentOut >> halvings) + out;
    lifecycle.flames = std::max({lifecycle.flames >> halvings, now.burning, lifecycle.wentOut});
    if (out == 0) return;
    const bool air =
        std::min(gpu::airStrength(now.air), gpu::airStrength(before.air)) < gpu::kAirFull;
    if (lifecycle.lastDouse != 0 && endTick <= lifecycle.lastDouse + kWaterWorks)
        lifecycle.outCause = lifecycle.douseCause;
    else
        lifecycle.outCause = air ? FW_EXTINGUISHED_BY_AIR : FW_EXTINGUISHED_BY_COLD;
}

// Without fuel per texel, a texel has all of its own until it has burnt out. A texel that caught
// since flames were counted last would count as burnt out: the next count adds it.
void BurnSystem::applyBurntFuel(Object& object, uint32_t endTick) noexcept {
    const gpu::ObjectCounters& now = object.counters;
    const components::Fuel& fuel = object.fuel;
    if (fuel.texels == 0 || now.lastIgnition > lastReduced(endTick)) return;
    const uint64_t burnt = std::min(now.ignited - std::min(now.ignited, now.burning), fuel.texels);
    // In parts, as the product is too large.
    object.lifecycle.energy =
        fuel.energy / fuel.texels * burnt + fuel.energy % fuel.texels * burnt / fuel.texels;
}

void BurnSystem::applyEnergy(Object& object, uint32_t endTick) noexcept {
    const gpu::ObjectCounters& now = object.counters;
    if (!components::hasHeat(object.data)) {
        applyBurntFuel(object, endTick);
        return;
    }
    const uint64_t energy = uint64_t(now.energyHigh) << 32 | now.energyLow;
    const uint64_t steps = heatStepsBefore(endTick);
    if (steps == object.lifecycle.heatSteps) return;
    FW_ASSERT(context_.def.paceFactor > 0, "pace %g", double(context_.def.paceFactor));
    const double seconds = double(steps - object.lifecycle.heatSteps) * gpu::kHeatSteps / 32;
    if (!std::exchange(object.carried, false))
        object.lifecycle.power = now.burning == 0
                                     ? 0.0f
                                     : float(double(energy - object.lifecycle.energy) / 1048576 /
                                             seconds / double(context_.def.paceFactor));
    object.lifecycle.energy = energy;
    object.lifecycle.heatSteps = steps;
}

// ---- saves ------------------------------------------------------------------------------------

void BurnSystem::capture(BurnSnapshot& to) const { to = state_; }

void BurnSystem::complete(BurnSnapshot& to) const noexcept {
    to.steps = state_.steps;
    to.idle = state_.seenIdle;
    to.lastStimulus = state_.seenStimulus;
    to.counts = state_.counts;
}

void BurnSystem::restore(BurnSnapshot& from, uint32_t listed, uint32_t hot) noexcept {
    static_cast<BurnSnapshot&>(state_) = std::move(from);
    // An awake world would filter the wind from here on, not from its first ignition.
    state_.seenIdle = state_.idle;
    state_.seenStimulus = state_.lastStimulus;
    state_.stimuli.clear();
    state_.frameNotes.clear();
    state_.loaded = state_.counts;
    state_.counts.run = 0;
    state_.loaded.front -= std::min(state_.loaded.front, listed);
    state_.loaded.hot -= std::min(state_.loaded.hot, hot);
    settlePending();
}

void BurnSystem::restoreObject(Object& object) noexcept {
    object.sleepsUnder = 0;
    object.carryEnd = 0;  // what the save carries is settled with its events
    object.stimuli = 0;
    object.ignites = false;
    object.firstFrame = context_.lastFrame + 1;
    ++object.changes;
    if (object.play.burn1 != 0) startPlay(object);
    if (object.breaks) {  // it has not burnt, or restoreBreaks comes next
        object.breaks->checkCount = 0;
        object.breaks->shareReported = object.breaks->waits = false;
        std::fill(object.breaks->lost.begin(), object.breaks->lost.end(), false);
    }
    if (!object.touched) {
        object.counters = {};
        return;
    }
    scene_.touched.push_back(&object);
    if (object.lifecycle.ignitionKnown)
        context_.backend.startBoundary(object.slot, object.lifecycle.ignitionPoint,
                                       uint32_t(object.lifecycle.firstIgnition));
}

}  // namespace fw::world
