#include "world/persistence.h"

#include "components/pose.h"
#include "world/save.h"
#include "world/world.h"

#include <algorithm>

namespace fw::world {

PersistenceSystem::PersistenceSystem(World& world)
    : world_(world), images_(world.context_.memory) {}

PersistenceSystem::~PersistenceSystem() = default;

void PersistenceSystem::checkFrame(float deltaTime) const {
    if (!recording_ || !recording_->follows) return;
    const uint64_t end =
        fw::world::advance(world_.context_.clock, deltaTime, world_.context_.def.maxStepsPerFrame)
            .after.tick;
    if (end > std::max(recording_->until, world_.context_.clock.tick))
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "deltaTime is %g; the world follows a server's, and fwNet_NextAction says how "
                   "far a frame may go.",
                   double(deltaTime));
}

void PersistenceSystem::plan(const ClockAdvance& time) {
    if (recording_) planHashes(time);
    planTimeline(time.after.tick);
    planSave();
}

void PersistenceSystem::onBurnMap(const gpu::BurnMap& map, const gpu::Readback& readback) {
    if (recording_) recordHash(map, readback);
}

void PersistenceSystem::forgetTag(const Tag& tag, uint64_t frameIndex) noexcept {
    for (core::Owned<Save>& save : saves_)
        if (save && save->pending) forgetTag(*save, tag, frameIndex);
}

}  // namespace fw::world
