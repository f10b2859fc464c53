// From readbacks to what a game hears: counters become events, answers become states and tags,
// burning clusters become lights with ids that stay. Allocates nothing itself.
#include "world/world.h"

#include "core/growth.h"
#include "core/hash.h"
#include "world/save.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace fw::world {
namespace {

// Counters of `reduce` are at most 4 steps old; a fire is judged only well after its last event.
constexpr uint64_t kSettleTicks = 6 * gpu::kStepTicks;
constexpr uint64_t kWaterWorks = 2 * gpu::kTicksPerSecond;  // until it has put out what it hit
constexpr uint32_t kClampsToTell = 32;

// Fire may come to it, and none has: its counters say what they said before.
bool waitsForFire(const Object& object, const gpu::ObjectCounters& now) noexcept {
    return now.ignited == 0 && now.burning == 0 && !object.story.active && !object.story.sawFire &&
           object.play.began == 0 && object.story.power == 0 &&
           std::memcmp(&now, &object.counters, sizeof now) == 0;
}

}  // namespace

void World::raise(uint32_t type, const Object* object, uint32_t tag, uint64_t frameIndex,
                  const float position[3], float value, FwBurnableMeshId other) noexcept {
    FwEvent event{};
    event.type = type;
    event.tag = tag;
    event.frameIndex = frameIndex;
    event.value = value;
    event.other = other;
    if (object) {
        event.userData = object->data.userData;
        event.object = object->id;
    } else {
        event.userData = def_.userData;
    }
    std::copy_n(position, 3, event.position);
    events_.push(event);
}

void World::collect() noexcept {
    try {
        collectReadbacks();
    } catch (...) {  // the next frame asks again, and may say so
    }
}

void World::collectReadbacks() {
    while (const gpu::Readback* readback = backend_.nextReadback()) {
        if (readback->frameIndex <= loadedFrame_) continue;
        takeStimuli(readback->frameIndex);
        readbackFrame_ = readback->frameIndex;
        while (shiftCount_ > 0 && shifts_[0].frame < readbackFrame_) {
            std::copy(shifts_.begin() + 1, shifts_.begin() + shiftCount_, shifts_.begin());
            --shiftCount_;
        }
        readbackTick_ = readback->endTick;
        runTiles_ = readback->runTiles;
        // Of a save it is known how many there were, until they are counted again.
        const bool counted = loadedTick_ == ~0ull || lastReduced(readback->endTick) > loadedTick_;
        if (counted) loadedReceivers_ = loadedBurning_ = 0;
        if (readback->endTick > loadedTick_) loadedFront_ = 0;
        if (heatStepsBefore(readback->endTick) > heatStepsBefore(loadedTick_)) loadedHot_ = 0;
        frontTiles_ = readback->frontTiles + loadedFront_;
        hotTiles_ = readback->hotTiles + loadedHot_;
        burningTiles_ = counted ? readback->burningTiles : loadedBurning_;
        receivers_ = std::max(readback->receivers, loadedReceivers_);
        if (readback->milliseconds >= 0 && !budgetMeasured_) spent_.gpu = readback->milliseconds;
        takeCounters(*readback);
        takeAnswers(*readback);
        takeLights(*readback);
        takeFields(*readback);
        takeRooms(*readback);
        for (const gpu::BurnMap& map : readback->burnMaps) {
            if (map.object >= objects_.slotCount()) continue;
            auto* owned = objects_.at(map.object);
            if (!owned || (*owned)->firstFrame > readback->frameIndex) continue;
            if (recording_) recordHash(map, *readback);
            if ((*owned)->forecast && (*owned)->forecast->pending)
                takeForecast(**owned, map, *readback);
            if ((*owned)->breaks) takeBreaks(**owned, map, *readback);
            BurnMapCopy& copy = (*owned)->map;
            if (!copy.pending || copy.ticks.size() != map.ticks.size()) continue;
            std::copy(map.ticks.begin(), map.ticks.end(), copy.ticks.begin());
            if (copy.heat.size() == map.heat.size())
                std::copy(map.heat.begin(), map.heat.end(), copy.heat.begin());
            copy.tick = readback->endTick;
            copy.pending = false;
            copy.ready = true;
        }
        const bool rests =
            frontTiles_ == 0 && burningTiles_ == 0 && hotTiles_ == 0 && receivers_ == 0;
        seenIdle_ = seenIdle_ || (rests && readback->endTick >= seenStimulus_ + kSettleTicks);
        if (rests && readback->endTick >= lastStimulus_ + kSettleTicks) idle_ = true;
        takeSaves(*readback);
    }
}

// ---- what frames did, taken in their order
// --------------------------------------------------------

// Before a frame is committed: one for each object that it may address.
void World::reserveStimuli() {
    const size_t most = std::min<size_t>(
        frame_.due.size() + frame_.latches.size() + frame_.plays.size(), objects_.live());
    core::growTo(stimuli_, stimuli_.size() + most);
    core::growTo(frameNotes_, frameNotes_.size() + 1);
}

// The one of the frame that is being committed.
Stimulus& World::stimulusOf(Object& object, uint64_t frameIndex) noexcept {
    if (object.stimulusAt == mesh::kNone) {
        object.stimulusAt = uint32_t(stimuli_.size());
        ++object.stimuli;
        stimuli_.push_back({frameIndex, object.slot});  // room is there
    }
    return stimuli_[object.stimulusAt];
}

// The first of a frame.
void World::noteIgnition(Object& object, Stimulus& stimulus, uint32_t texel,
                         uint32_t tick) noexcept {
    if (stimulus.ignites) return;
    stimulus.ignites = true;
    stimulus.ignition = tick;
    texelPlace(object, texel, stimulus.ignitionPoint);
    if (!object.story.ignitionKnown && !object.story.sawFire && !object.ignites)
        backend_.startBoundary(object.slot, stimulus.ignitionPoint, tick);
    object.ignites = true;
}

void World::commitStimuli(const ClockAdvance& time, uint64_t frameIndex) noexcept {
    for (size_t i = stimuli_.size(); i-- > 0 && stimuli_[i].frameIndex == frameIndex;)
        (*objects_.at(stimuli_[i].slot))->stimulusAt = mesh::kNone;
    FrameNote note;
    note.frameIndex = frameIndex;
    note.end = time.after.tick;
    note.roomsStirred = roomsStirred_;
    note.steps = time.steps;
    note.stirs = !frame_.events.empty();
    note.never = (switches_ & (FW_DEBUG_NEVER_IDLE | FW_DEBUG_DENSE)) != 0;
    frameNotes_.push_back(note);  // room is there
}

// With the readback of a frame, before anything else of it.
void World::takeStimuli(uint64_t frameIndex) noexcept {
    size_t frames = 0;
    for (const FrameNote& note : frameNotes_) {
        if (note.frameIndex > frameIndex) break;
        ++frames;
        seenRoomsStirred_ = std::max(seenRoomsStirred_, note.roomsStirred);
        if (!seenIdle_ || note.stirs || note.never || !roomsRest(seenRoomsStirred_))
            steps_ += note.steps;
        if (!note.stirs) continue;
        seenIdle_ = false;
        seenStimulus_ = note.end;
    }
    frameNotes_.erase(frameNotes_.begin(), frameNotes_.begin() + std::ptrdiff_t(frames));
    size_t taken = 0;
    for (const Stimulus& one : stimuli_) {
        if (one.frameIndex > frameIndex) break;
        ++taken;
        Object& object = **objects_.at(one.slot);
        Story& story = object.story;
        if (--object.stimuli == 0) object.ignites = false;
        if (one.from1 != 0)
            continueBurn(object, one.given ? *one.given : (*objects_.at(one.from1 - 1))->story);
        if (one.first) story.heatSteps = one.heatSteps;
        if (one.starts) {
            story.active = true;
            story.lastStimulus = std::max(story.lastStimulus, one.latest);
        }
        if (one.ignites && !story.ignitionKnown && !story.sawFire) {
            story.ignitionKnown = true;
            story.firstIgnition = one.ignition;
            std::copy_n(one.ignitionPoint, 3, story.ignitionPoint);
        }
        if (one.douses) {
            story.lastDouse = one.douse;
            story.douseCause = one.douseCause;
        }
    }
    stimuli_.erase(stimuli_.begin(), stimuli_.begin() + std::ptrdiff_t(taken));
}

void World::takeCounters(const gpu::Readback& readback) noexcept {
    uint32_t clamps = 0;
    for (Object* touched : touched_) {
        Object& object = *touched;
        const uint32_t slot = object.slot;
        if (slot >= readback.objects.size() || object.firstFrame > readback.frameIndex) continue;
        const gpu::ObjectCounters& now = readback.objects[slot];
        if (waitsForFire(object, now)) {
            object.countersFrame = readback.frameIndex;
            if (components::hasHeat(object.data))
                object.story.heatSteps = heatStepsBefore(readback.endTick);
            clamps += now.lateClamps;
            continue;
        }
        const gpu::ObjectCounters before = object.counters;
        object.counters = now;
        object.countersFrame = readback.frameIndex;
        object.story.mostIgnited = std::max(object.story.mostIgnited, now.ignited);
        clamps += now.lateClamps;
        if (object.play.began != 0 && readback.endTick >= object.play.began &&
            !gpu::playsAt(now.playsUntil, readback.endTick))
            endPlay(object, readback.frameIndex, now.playsUntil);  // others' fire came
        takeEnergy(object, readback.endTick);
        tellSpread(object, readback);
        float place[3];
        if (now.burning > 0) object.story.lastBurning = readback.endTick;
        countFlames(object, before, readback.endTick);

        const bool freshFire = now.ignited > before.ignited || now.burning > 0;
        if (!object.story.sawFire && now.ignited > 0 && freshFire) {
            object.story.sawFire = true;
            object.story.active = true;
            const uint64_t tick =
                object.story.ignitionKnown ? object.story.firstIgnition : now.lastIgnition;
            components::toWorld(object.data.pose, object.story.ignitionPoint, place);
            raise(FW_EVENT_IGNITED, &object, 0, readback.frameIndex, place,
                  float(double(tick) / gpu::kTicksPerSecond));
        }
        // A few late arrivals come with any turn of the wind; only many of them are a limit.
        const uint32_t limit = std::max(kClampsToTell, now.ignited / 50);
        if (now.lateClamps >= object.story.clampsTold + limit) {
            components::toWorld(object.data.pose, object.story.ignitionPoint, place);
            raise(FW_EVENT_FRONT_LIMITED, &object, 0, readback.frameIndex, place,
                  float(now.lateClamps - object.story.clampsTold));
            object.story.clampsTold = now.lateClamps;
        }
        const bool settled = now.burning == 0 && now.frontTiles == 0 &&
                             readback.endTick >= object.story.lastStimulus + kSettleTicks &&
                             readback.endTick >= uint64_t(now.lastIgnition) + kSettleTicks;
        if (settled && object.story.active) {
            object.story.active = false;
            if (object.story.sawFire) {
                const float fraction =
                    object.texels ? float(object.story.mostIgnited) / float(object.texels) : 0.0f;
                components::toWorld(object.data.pose, object.story.ignitionPoint, place);
                // At least half of its last flames left fuel behind.
                const Story& end = object.story;
                const bool out = end.wentOut > 0 && end.wentOut >= end.flames - end.wentOut;
                raise(out ? FW_EVENT_EXTINGUISHED : FW_EVENT_BURNT_OUT, &object,
                      out ? end.outCause : 0u, readback.frameIndex, place, fraction);
            }
            object.story.sawFire = false;
            object.story.ignitionKnown = false;
            object.story.flames = object.story.wentOut = object.story.outCause = 0;
        }
    }
    lateClamps_ = clamps;
}

// A texel that burnt out is a source for good; one that went out is none any more.
void World::countFlames(Object& object, const gpu::ObjectCounters& before,
                        uint32_t endTick) noexcept {
    const gpu::ObjectCounters& now = object.counters;
    Story& story = object.story;
    const uint32_t out = before.ignited - std::min(before.ignited, now.ignited);
    if (now.burning == 0 && before.burning == 0 && out == 0) return;
    const uint64_t seconds = endTick / gpu::kTicksPerSecond -
                             std::min<uint64_t>(endTick, story.halvedUntil) / gpu::kTicksPerSecond;
    const uint64_t halvings = std::min<uint64_t>(seconds, 31);
    story.halvedUntil = endTick;
    story.wentOut = (story.wentOut >> halvings) + out;
    story.flames = std::max({story.flames >> halvings, now.burning, story.wentOut});
    if (out == 0) return;
    const bool air =
        std::min(gpu::airStrength(now.air), gpu::airStrength(before.air)) < gpu::kAirFull;
    if (story.lastDouse != 0 && endTick <= story.lastDouse + kWaterWorks)
        story.outCause = story.douseCause;
    else
        story.outCause = air ? FW_EXTINGUISHED_BY_AIR : FW_EXTINGUISHED_BY_COLD;
}

// Without fuel per texel a texel has all of its own until it has burnt out, and none from then on.
// What caught since flames were counted last would pass for burnt out: that waits for the next
// count.
void World::takeBurnt(Object& object, uint32_t endTick) noexcept {
    const gpu::ObjectCounters& now = object.counters;
    const components::Fuel& fuel = object.fuel;
    if (fuel.texels == 0 || now.lastIgnition > lastReduced(endTick)) return;
    const uint64_t burnt = std::min(now.ignited - std::min(now.ignited, now.burning), fuel.texels);
    // In parts, as the product is too large.
    object.story.energy =
        fuel.energy / fuel.texels * burnt + fuel.energy % fuel.texels * burnt / fuel.texels;
}

void World::takeEnergy(Object& object, uint32_t endTick) noexcept {
    const gpu::ObjectCounters& now = object.counters;
    if (!components::hasHeat(object.data)) {
        takeBurnt(object, endTick);
        return;
    }
    const uint64_t energy = uint64_t(now.energyHigh) << 32 | now.energyLow;
    const uint64_t steps = heatStepsBefore(endTick);
    if (steps == object.story.heatSteps) return;
    const double seconds = double(steps - object.story.heatSteps) * gpu::kHeatSteps / 32;
    if (!std::exchange(object.carried, false))
        object.story.power = now.burning == 0 ? 0.0f
                                              : float(double(energy - object.story.energy) /
                                                      1048576 / seconds / double(def_.paceFactor));
    object.story.energy = energy;
    object.story.heatSteps = steps;
}

void World::takeAnswers(const gpu::Readback& readback) noexcept {
    const auto known = std::find_if(
        probeFrames_.begin(), probeFrames_.end(),
        [&](const ProbeFrame& frame) { return frame.frameIndex == readback.frameIndex; });
    if (known == probeFrames_.end()) return;
    const size_t count = std::min(known->refs.size(), readback.answers.size());
    for (size_t i = 0; i < count; ++i) {
        const ProbeRef& ref = known->refs[i];
        auto* owned = objects_.find(ref.object);
        if (!owned) continue;
        const Object& object = **owned;
        const uint32_t code = readback.answers[i].state;
        if (ref.jet > 0) {
            const gpu::ProbeAnswer& answer = readback.answers[i];
            const gpu::HeatTexel x = gpu::unpackHeat({answer.heatX, answer.heatY});
            const bool gone = answer.heat != 0 && gpu::gateLets(gpu::kEventGate, ref.holeTicks, x,
                                                                code, readback.endTick);
            if (components::FireEmitter* emitter = emitters_.at(ref.jet - 1))
                emitter->holes[ref.ray] = {gone ? ref.object : FwBurnableMeshId{}, ref.texel};
        } else if (ref.isTag) {
            if (!gpu::isSource(code) || code > readback.endTick) continue;
            const auto tag = std::find_if(tags_.begin(), tags_.end(), [&](const Tag& t) {
                return t.object.index1 == ref.object.index1 &&
                       t.object.generation == ref.object.generation && t.texel == ref.texel &&
                       t.tag == ref.tag;
            });
            if (tag == tags_.end()) continue;  // an older frame said so already
            for (core::Owned<Save>& save : saves_)
                if (save && save->pending) forgetTag(*save, *tag, readback.frameIndex);
            tags_.erase(tag);
            float place[3];
            texelPosition(object, ref.texel, place);
            raise(FW_EVENT_TAG_REACHED, &object, ref.tag, readback.frameIndex, place,
                  float(double(code) / gpu::kTicksPerSecond));
        } else if (Query* query = queries_.find(ref.query)) {
            const float distance = query->distance;
            query->answer = pointState(object, ref.texel, readback.answers[i], readback);
            query->answer.distance = distance;
            query->ready = true;
        }
    }
    known->frameIndex = 0;
}

}  // namespace fw::world
