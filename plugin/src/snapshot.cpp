// State of a world that any thread may read while another thread steps or records it.
#include "objects.h"

#include <algorithm>

using namespace fw;
using edge::checkPointer;
using edge::onWorld;

namespace fw::edge {

void publish(FwWorld& handle) noexcept {
    Snapshot& snapshot = handle.snapshot;
    if (!snapshot.wanted.load(std::memory_order_relaxed)) return;
    world::World& world = *handle.world;
    try {
        const std::lock_guard lock(snapshot.mutex);
        snapshot.lights.resize(world.maxLights());
        snapshot.lights.resize(world.lights().gather(snapshot.lights));
        world.queries().copyStates(snapshot.objects);
        snapshot.there = true;
    } catch (...) {  // no memory: readers keep what an earlier frame left
        handle.context->log.write(FW_LOG_WARNING,
                                  "Memory is exhausted; fwWorld_Read... see an earlier frame.");
    }
}

}  // namespace fw::edge

namespace {

// Locked; nothing: no frame has left a copy yet.
std::unique_lock<std::mutex> openSnapshot(FwWorld& world) {
    world.snapshot.wanted.store(true, std::memory_order_relaxed);
    std::unique_lock lock(world.snapshot.mutex);
    if (!world.snapshot.there) lock.unlock();
    return lock;
}

}  // namespace

extern "C" {

FwResult FW_CALL fwWorld_ReadObjectState(FwWorld* world, FwBurnableMeshId id,
                                         FwObjectState* state) {
    return onWorld(__func__, world, [&](world::World&) {
        const uint32_t size = edge::checkInfo(state);
        if (id.index1 == 0) core::fail(FW_ERROR_STALE_ID, "Burnable mesh id is null.");
        const auto lock = openSnapshot(*world);
        const auto& objects = world->snapshot.objects;
        if (!lock || id.index1 > objects.size()) return FW_NOT_READY;
        const world::StateCopy& copy = objects[id.index1 - 1];
        if (id.generation < copy.generation)
            core::fail(FW_ERROR_STALE_ID, "Burnable mesh %u (generation %u) is already destroyed.",
                       id.index1, id.generation);
        if (id.generation > copy.generation || !copy.live) return FW_NOT_READY;
        FwObjectState filled = copy.state;
        edge::fromMetres(world->unit, filled);
        edge::writeInfo(state, size, filled);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_ReadLights(FwWorld* world, FwLight* lights, uint32_t* count) {
    return onWorld(__func__, world, [&](world::World&) {
        checkPointer(count, "count");
        const uint32_t room = std::exchange(*count, 0);
        if (room > 0) checkPointer(lights, "lights");
        const auto lock = openSnapshot(*world);
        if (!lock) return FW_NOT_READY;
        *count = uint32_t(std::min<size_t>(room, world->snapshot.lights.size()));
        if (room > 0) std::copy_n(world->snapshot.lights.begin(), *count, lights);
        for (uint32_t i = 0; i < *count; ++i) edge::fromMetres(world->unit, lights[i]);
        return FW_OK;
    });
}

}  // extern "C"
