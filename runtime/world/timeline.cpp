// See timeline.h. Moments are asked for, kept and taken out as frames go by; seeking loads the last
// one before a tick and does again what the host did since, step by step.
#include "world/timeline.h"

#include "world/save.h"
#include "world/world.h"

#include <algorithm>
#include <cmath>

namespace fw::world {
namespace {

constexpr uint64_t kLeastTimeline = uint64_t(1) << 16;   // bytes
constexpr float kShortest = 1.0f / 32, kLongest = 3600;  // s between two moments

uint64_t ticksOf(float seconds) noexcept {
    return uint64_t(std::llround(double(seconds) * 32)) * gpu::kStepTicks;
}

struct Seeking {
    explicit Seeking(Timeline& given) : timeline(given) { timeline.seeks = true; }
    ~Seeking() { timeline.seeks = false; }
    Seeking(const Seeking&) = delete;
    Seeking& operator=(const Seeking&) = delete;
    Timeline& timeline;
};

}  // namespace

uint64_t Timeline::bytes() const noexcept {
    uint64_t sum = deeds.entries.size() * sizeof(LogEntry);
    for (const Moment& moment : moments) sum += moment.save.size();
    return sum;
}

void Timeline::fit() noexcept {
    while (moments.size() > 1 && bytes() > most) {
        if (apart * 2 <= farthest) {
            apart *= 2;
            uint64_t last = moments.front().tick;
            const auto near = [&](const Moment& moment) {
                if (moment.tick - last < apart) return true;
                last = moment.tick;
                return false;
            };
            moments.erase(std::remove_if(moments.begin() + 1, moments.end(), near), moments.end());
            continue;
        }
        moments.erase(moments.begin());
        const size_t before = moments.front().deeds;  // nobody plays these any more
        deeds.entries.erase(deeds.entries.begin(), deeds.entries.begin() + ptrdiff_t(before));
        for (Moment& moment : moments) moment.deeds -= before;
        done -= std::min(done, before);
        captured -= std::min(captured, before);
    }
}

void Timeline::forget(uint64_t now) noexcept {
    std::erase_if(moments, [&](const Moment& moment) { return moment.tick > now; });
    deeds.entries.resize(std::min(done, deeds.entries.size()));
    end = now;
}

void Timeline::restart(uint64_t now) noexcept {
    moments.clear();
    deeds.entries.clear();
    deeds.lost = false;
    done = captured = 0;
    end = granted = now;
}

// ---- World --------------------------------------------------------------------------------------

void PersistenceSystem::startTimeline(const FwTimelineDef& def) {
    components::checkValue(def.interval, "FwTimelineDef::interval", kShortest, kLongest);
    components::checkValue(def.longest, "FwTimelineDef::longest", kShortest, kLongest);
    if (def.reserved != 0 || def.longest < def.interval)
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "FwTimelineDef::longest is %g s, below its interval of %g s, or reserved is %u, "
                   "not zero.",
                   double(def.longest), double(def.interval), def.reserved);
    if (def.bytes < kLeastTimeline)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "FwTimelineDef::bytes is %llu; at least %llu.",
                   static_cast<unsigned long long>(def.bytes),
                   static_cast<unsigned long long>(kLeastTimeline));
    auto timeline = core::Owned<Timeline>::make(world_.context_.memory, world_.context_.memory);
    timeline->apart = ticksOf(def.interval);
    timeline->farthest = std::max(ticksOf(def.longest), timeline->apart);
    timeline->most = def.bytes;
    timeline->restart(world_.context_.clock.tick);
    requestSave(SaveFor::timeline);
    saves_[size_t(SaveFor::timeline)]->pending = false;  // of one that was kept before
    timeline_ = std::move(timeline);
}

void PersistenceSystem::stopTimeline() noexcept {
    timeline_ = {};
    saves_[size_t(SaveFor::timeline)] = {};
}

// Before a frame's plan: is one of its moments to be kept? Of what burnt before, none.
void PersistenceSystem::planTimeline(uint64_t after) noexcept {
    if (!timeline_) return;
    const Timeline& timeline = *timeline_;
    const core::Owned<Save>& save = saves_[size_t(SaveFor::timeline)];
    if (!save || save->wished || save->pending || after < timeline.end) return;
    if (!timeline.moments.empty() && after < timeline.moments.back().tick + timeline.apart) return;
    if (unsavable() != 0) return;
    save->wished = true;
    save->ready = false;
}

// A frame was: from `before` to the present.
void PersistenceSystem::commitTimeline(uint64_t before) noexcept {
    if (!timeline_) return;
    Timeline& timeline = *timeline_;
    if (world_.context_.clock.tick == before) return;
    if (before < timeline.end && world_.context_.clock.tick > timeline.granted)
        timeline.forget(before);
    timeline.end = std::max(timeline.end, world_.context_.clock.tick);
}

void PersistenceSystem::keepMoment() noexcept {
    if (!timeline_ || !saves_[size_t(SaveFor::timeline)]->ready) return;
    Save& save = *saves_[size_t(SaveFor::timeline)];
    save.ready = false;
    Timeline& timeline = *timeline_;
    try {
        timeline.moments.push_back(
            {save.saved.clock.tick, timeline.captured,
             std::pmr::vector<std::byte>(save.bytes.begin(), save.bytes.end(),
                                         world_.context_.memory)});
    } catch (...) {  // there will be another one
        return;
    }
    timeline.fit();
}

// What the host does: in the past it makes another future.
void PersistenceSystem::noteInTimeline(const Deed& deed) noexcept {
    if (!timeline_ || timeline_->seeks) return;
    Timeline& timeline = *timeline_;
    if (world_.context_.clock.tick < timeline.end) timeline.forget(world_.context_.clock.tick);
    timeline.deeds.push({world_.context_.clock.tick, false, deed});
    timeline.done = timeline.deeds.entries.size();
}

bool PersistenceSystem::seek(uint64_t untilTick, float& seconds) {
    seconds = 0;
    if (!timeline_)
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "The world keeps no timeline; fwWorld_StartTimeline first.");
    mayChange();
    if (const uint32_t object1 = unsavable())
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "Burnable mesh %u has FW_BURNABLE_PUBLISHED; such fires cannot be sought.",
                   object1);
    Timeline& timeline = *timeline_;
    if (timeline.deeds.lost)
        core::fail(FW_ERROR_OUT_OF_MEMORY,
                   "Memory ended while the timeline was kept; it has a gap.");
    const uint64_t until = untilTick - untilTick % gpu::kStepTicks;
    if (timeline.moments.empty() && until <= timeline.end)
        return until == world_.context_.clock.tick;
    if (timeline.moments.empty() || until < timeline.moments.front().tick || until > timeline.end)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "untilTick is %llu; the timeline has %llu to %llu.",
                   static_cast<unsigned long long>(untilTick),
                   static_cast<unsigned long long>(
                       timeline.moments.empty() ? timeline.end : timeline.moments.front().tick),
                   static_cast<unsigned long long>(timeline.end));
    const Seeking seeking(timeline);
    auto from = std::upper_bound(timeline.moments.begin(), timeline.moments.end(), until,
                                 [](uint64_t tick, const Moment& m) { return tick < m.tick; });
    --from;
    if (until < world_.context_.clock.tick || from->tick > world_.context_.clock.tick) {
        load(from->save);
        timeline.done = from->deeds;
    }
    const auto& entries = timeline.deeds.entries;
    const bool present =
        world_.context_.clock.tick == timeline.end;  // with all that was done in it
    if (world_.context_.clock.tick < until || present) {
        for (; timeline.done < entries.size() &&
               entries[timeline.done].tick <= world_.context_.clock.tick;
             ++timeline.done) {
            try {
                perform(entries[timeline.done].deed);
            } catch (const core::Error& error) {
                world_.context_.log.write(
                    FW_LOG_WARNING, "A call of the timeline at tick %llu is refused: %s",
                    static_cast<unsigned long long>(world_.context_.clock.tick), error.message);
            }
        }
    }
    if (world_.context_.clock.tick >= until) return true;
    uint64_t next = std::min(
        until, world_.context_.clock.tick + uint64_t(world_.mostSteps()) * gpu::kStepTicks);
    if (timeline.done < entries.size()) next = std::min(next, entries[timeline.done].tick);
    timeline.granted = next;
    seconds = secondsUpTo(next);
    return true;
}

void PersistenceSystem::timelineState(FwTimelineState& state) {
    if (!timeline_) return;
    const Timeline& timeline = *timeline_;
    state.moments = uint32_t(timeline.moments.size());
    state.firstTick = timeline.moments.empty() ? timeline.end : timeline.moments.front().tick;
    state.endTick = timeline.end;
    state.bytes = timeline.bytes();
    state.interval = float(double(timeline.apart) / gpu::kTicksPerSecond);
}

}  // namespace fw::world
