// Keyframes are requested, kept and removed as frames go by. Seeking loads the last one before a
// tick and applies the commands since, step by step.
#include "world/recording.h"

#include "core/reserved.h"
#include "world/save.h"
#include "world/world.h"

#include <algorithm>
#include <cmath>

namespace fw::world {
namespace {

constexpr uint64_t kMinTimeline = uint64_t(1) << 16;     // bytes
constexpr float kShortest = 1.0f / 32, kLongest = 3600;  // s between two keyframes

uint64_t ticksOf(float seconds) noexcept {
    return uint64_t(std::llround(double(seconds) * 32)) * gpu::kStepTicks;
}

}  // namespace

uint64_t Timeline::bytes() const noexcept {
    uint64_t sum = commands.entries.size() * sizeof(LogEntry);
    for (const Keyframe& keyframe : keyframes) sum += keyframe.save.size();
    return sum;
}

void Timeline::fit() noexcept {
    while (keyframes.size() > 1 && bytes() > most) {
        if (apart * 2 <= farthest) {
            apart *= 2;
            uint64_t last = keyframes.front().tick;
            const auto near = [&](const Keyframe& keyframe) {
                if (keyframe.tick - last < apart) return true;
                last = keyframe.tick;
                return false;
            };
            keyframes.erase(std::remove_if(keyframes.begin() + 1, keyframes.end(), near),
                            keyframes.end());
            continue;
        }
        keyframes.erase(keyframes.begin());
        const size_t before = keyframes.front().commands;  // nobody plays these any more
        FW_ASSERT(before <= commands.entries.size(), "%zu of %zu commands", before,
                  commands.entries.size());
        commands.entries.erase(commands.entries.begin(),
                               commands.entries.begin() + ptrdiff_t(before));
        for (Keyframe& keyframe : keyframes) keyframe.commands -= before;
        applied -= std::min(applied, before);
        captured -= std::min(captured, before);
    }
}

void Timeline::forget(uint64_t now) noexcept {
    std::erase_if(keyframes, [&](const Keyframe& keyframe) { return keyframe.tick > now; });
    commands.entries.resize(std::min(applied, commands.entries.size()));
    end = now;
}

void Timeline::record(const Command& command, uint64_t now) noexcept {
    if (seeks) return;
    if (now < end) forget(now);
    commands.push({now, false, command});
    applied = commands.entries.size();
    fit();
}

void Timeline::restart(uint64_t now) noexcept {
    keyframes.clear();
    commands.entries.clear();
    commands.lost = false;
    applied = captured = 0;
    end = granted = now;
}

void PersistenceSystem::startTimeline(const FwTimelineDef& def) {
    components::checkValue(def.interval, "FwTimelineDef::interval", kShortest, kLongest);
    components::checkValue(def.maxInterval, "FwTimelineDef::maxInterval", kShortest, kLongest);
    if (def.reserved != 0 || def.maxInterval < def.interval)
        core::refuse(
            "FwTimelineDef::maxInterval is %g s, below its interval of %g s, or reserved is %u, "
            "not zero.",
            double(def.maxInterval), double(def.interval), def.reserved);
    if (def.bytes < kMinTimeline)
        core::refuse("FwTimelineDef::bytes is %llu; at least %llu.",
                     static_cast<unsigned long long>(def.bytes),
                     static_cast<unsigned long long>(kMinTimeline));
    auto timeline = core::Owned<Timeline>::make(context_.memory, context_.memory);
    timeline->apart = ticksOf(def.interval);
    timeline->farthest = std::max(ticksOf(def.maxInterval), timeline->apart);
    timeline->most = def.bytes;
    timeline->restart(context_.clock.tick);
    requestSave(SaveFor::timeline);
    saves_[size_t(SaveFor::timeline)]->pending = false;  // of one that was kept before
    recorder_.timeline = std::move(timeline);
}

void PersistenceSystem::stopTimeline() noexcept {
    recorder_.timeline = {};
    saves_[size_t(SaveFor::timeline)] = {};
}

// Before a frame's plan. Nothing is kept of what burnt before.
void PersistenceSystem::planTimeline(uint64_t after) noexcept {
    if (!recorder_.timeline) return;
    const Timeline& timeline = *recorder_.timeline;
    const core::Owned<Save>& save = saves_[size_t(SaveFor::timeline)];
    if (!save || save->requested || save->pending || after < timeline.end) return;
    if (!timeline.keyframes.empty() && after < timeline.keyframes.back().tick + timeline.apart)
        return;
    if (explainUnsavable() != 0) return;
    save->requested = true;
    save->ready = false;
}

// After a frame from `before` to the present.
void PersistenceSystem::commitTimeline(uint64_t before) noexcept {
    if (!recorder_.timeline) return;
    Timeline& timeline = *recorder_.timeline;
    if (context_.clock.tick == before) return;
    if (before < timeline.end && context_.clock.tick > timeline.granted) timeline.forget(before);
    timeline.end = std::max(timeline.end, context_.clock.tick);
}

void PersistenceSystem::keepKeyframe() noexcept {
    if (!recorder_.timeline || !saves_[size_t(SaveFor::timeline)]->ready) return;
    Save& save = *saves_[size_t(SaveFor::timeline)];
    save.ready = false;
    Timeline& timeline = *recorder_.timeline;
    try {
        timeline.keyframes.push_back(
            {save.snapshot.clock.tick, timeline.captured,
             std::pmr::vector<std::byte>(save.bytes.begin(), save.bytes.end(), context_.memory)});
    } catch (...) {  // a later keyframe does
        return;
    }
    timeline.fit();
}

bool PersistenceSystem::seek(uint64_t untilTick, float& seconds) {
    seconds = 0;
    if (!recorder_.timeline)
        core::refuse("The world keeps no timeline; fwWorld_StartTimeline first.");
    recorder_.mayChange();
    if (const uint32_t object1 = explainUnsavable())
        core::refuse("Burnable mesh %u burns by an extension; such fires cannot be sought.",
                     object1);
    Timeline& timeline = *recorder_.timeline;
    if (timeline.commands.lost)
        core::fail(FW_ERROR_OUT_OF_MEMORY,
                   "Memory ended while the timeline was kept; it has a gap.");
    const uint64_t until = untilTick - untilTick % gpu::kStepTicks;
    if (timeline.keyframes.empty() && until <= timeline.end) return until == context_.clock.tick;
    if (timeline.keyframes.empty() || until < timeline.keyframes.front().tick ||
        until > timeline.end)
        core::refuse("untilTick is %llu; the timeline has %llu to %llu.",
                     static_cast<unsigned long long>(untilTick),
                     static_cast<unsigned long long>(timeline.keyframes.empty()
                                                         ? timeline.end
                                                         : timeline.keyframes.front().tick),
                     static_cast<unsigned long long>(timeline.end));
    const Raised seeking(&timeline.seeks);
    auto from = std::upper_bound(timeline.keyframes.begin(), timeline.keyframes.end(), until,
                                 [](uint64_t tick, const Keyframe& m) { return tick < m.tick; });
    --from;
    if (until < context_.clock.tick || from->tick > context_.clock.tick) {
        load(from->save);
        timeline.applied = from->commands;
    }
    const auto& entries = timeline.commands.entries;
    const bool present = context_.clock.tick == timeline.end;
    if (context_.clock.tick < until || present)
        timeline.applied += applyUntilNow(std::span(entries).subspan(timeline.applied), "timeline");
    if (context_.clock.tick >= until) return true;
    uint64_t next =
        std::min(until, context_.clock.tick + uint64_t(world_.mostSteps()) * gpu::kStepTicks);
    if (timeline.applied < entries.size()) next = std::min(next, entries[timeline.applied].tick);
    timeline.granted = next;
    seconds = secondsUpTo(next);
    return true;
}

void PersistenceSystem::timelineState(FwTimelineState& state) {
    if (!recorder_.timeline) return;
    const Timeline& timeline = *recorder_.timeline;
    state.keyframes = uint32_t(timeline.keyframes.size());
    state.firstTick = timeline.keyframes.empty() ? timeline.end : timeline.keyframes.front().tick;
    state.endTick = timeline.end;
    state.bytes = timeline.bytes();
    state.interval = float(double(timeline.apart) / gpu::kTicksPerSecond);
}

}  // namespace fw::world
