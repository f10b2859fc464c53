#include "world/persistence.h"

#include "components/pose.h"
#include "world/save.h"
#include "world/world.h"

#include <algorithm>

namespace fw::world {

PersistenceSystem::PersistenceSystem(World& world)
    : world_(world),
      context_(world.context_),
      scene_(world.scene_),
      recorder_(world.recorder_),
      images_(context_.memory),
      hashed_(context_.memory) {}

PersistenceSystem::~PersistenceSystem() = default;

void PersistenceSystem::checkFrame(float deltaTime) const {
    if (!recorder_.network || !recorder_.network->follows) return;
    const uint64_t end =
        fw::world::advance(context_.clock, deltaTime, context_.def.maxStepsPerFrame).after.tick;
    if (end > std::max(recorder_.network->until, context_.clock.tick))
        core::refuse(
            "deltaTime is %g; the world follows a server's, and fwNet_NextAction says how "
            "far a frame may go.",
            double(deltaTime));
}

void PersistenceSystem::plan(const HostFrame& frame, gpu::FramePlan& plan) {
    hashed_.clear();
    if (recorder_.network) planHashes(frame);
    planTimeline(frame.end());
    planSave();
    plan.images = images_;
}

void PersistenceSystem::commit(const HostFrame& frame) noexcept {
    commitTimeline(frame.begin);
    commitSave(frame.index);
}

void PersistenceSystem::onBurnMap(const gpu::ObjectImage& map, const gpu::Readback& readback) {
    if (recorder_.network) recordHash(map, readback);
}

// Of a tag that was reached by a save's frame the save has the event alone.
void PersistenceSystem::forgetTags(std::span<const Tag> reached, uint64_t frameIndex) noexcept {
    for (core::Owned<Save>& save : saves_)
        if (save && save->pending && frameIndex <= save->frameIndex)
            std::erase_if(save->snapshot.tags, [&](const Tag& tag) {
                return std::find(reached.begin(), reached.end(), tag) != reached.end();
            });
}

}  // namespace fw::world
