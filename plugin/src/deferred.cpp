// Deferred destruction: any thread may request it while another one steps or records.
#include "flamewright/flamewright_vulkan.h"
#include "objects.h"

#include <algorithm>

using namespace fw;
using edge::checkPointer;
using edge::onContext;
using edge::onWorld;

namespace {

template <auto kDestroy>
void destroyBy(world::World& w, const FwObjectRef& object) {
    const auto destroy = []<class System, class Id>(world::World& from, void (System::*)(Id),
                                                    const FwObjectRef& gone) {
        (edge::systemOf<System>(from).*kDestroy)(Id{gone.index1, gone.generation});
    };
    destroy(w, kDestroy, object);
}

struct Kind {
    uint32_t kind;
    void (*destroy)(world::World& w, const FwObjectRef& object);
};
constexpr Kind kKinds[] = {
    {FW_OBJECT_MATERIAL, &destroyBy<&world::Scene::destroyMaterial>},
    {FW_OBJECT_IMAGE, &destroyBy<&world::Scene::destroyImage>},
    {FW_OBJECT_MESH, &destroyBy<&world::Scene::destroyMesh>},
    {FW_OBJECT_BURNABLE_MESH, &destroyBy<&world::World::destroyBurnableMesh>},
    {FW_OBJECT_HEAT_OCCLUDER, &destroyBy<&world::ExchangeSystem::removeHeatOccluder>},
    {FW_OBJECT_VOLUMETRIC_FIRE, &destroyBy<&world::FlameSystem::destroy>},
    {FW_OBJECT_FIRE_PROFILE, &destroyBy<&world::FlameSystem::destroyProfile>},
    {FW_OBJECT_FIRE_COLLIDER, &destroyBy<&world::FlameSystem::removeCollider>},
    {FW_OBJECT_FIRE_EMITTER, &destroyBy<&world::EmitterSystem::destroy>},
    {FW_OBJECT_FLIPBOOK, &destroyBy<&world::FlameSystem::destroyFlipbook>},
    {FW_OBJECT_PARTICLE_FIELD, &destroyBy<&world::FieldSystem::destroy>},
    {FW_OBJECT_WIND_ZONE, &destroyBy<&world::WindSystem::destroyZone>},
    {FW_OBJECT_ROOM, &destroyBy<&world::RoomSystem::destroy>},
    {FW_OBJECT_BURN, &destroyBy<&world::BurnSystem::destroyBurn>},
};
static_assert(std::size(kKinds) == FW_OBJECT_KIND_COUNT - 1);

void checkRef(const FwObjectRef& object) {
    if (object.kind < 1 || object.kind >= FW_OBJECT_KIND_COUNT)
        core::refuse("FwObjectRef::kind is %u; the limits are [1, %u].", object.kind,
                     uint32_t(FW_OBJECT_KIND_COUNT) - 1);
    if (object.reserved != 0)
        core::refuse("FwObjectRef::reserved is %u; it is zero.", object.reserved);
    if (object.index1 == 0)
        core::fail(FW_ERROR_STALE_ID, "FwObjectRef::index1 is 0; the id is null.");
}

// False: the object is still in use, and nothing changed.
bool destroyNow(world::World& w, const FwObjectRef& object) {
    try {
        if (object.kind == FW_OBJECT_IMAGE &&
            w.scene().showsImage({object.index1, object.generation}))
            return false;
        std::find_if(std::begin(kKinds), std::end(kKinds), [&](const Kind& one) {
            return one.kind == object.kind;
        })->destroy(w, object);
    } catch (const core::Error& error) {
        if (error.result == FW_ERROR_INVALID_ARGUMENT) return false;
        throw;
    }
    return true;
}

template <class What>
void defer(std::pmr::vector<edge::Deferred<What>>& list, const edge::Deferred<What>& one) {
    const auto known = std::find_if(list.begin(), list.end(), [&](const edge::Deferred<What>& had) {
        return std::memcmp(&had.what, &one.what, sizeof one.what) == 0;
    });
    if (known == list.end())
        list.push_back(one);
    else
        known->frameIndex = one.frameIndex;
}

void unregister(edge::Device& device, FwTargetId target) {
    try {
        device.unregisterTarget(target);
    } catch (const core::Error& error) {
        if (error.result != FW_ERROR_STALE_ID) throw;  // the host has unregistered it meanwhile
    }
}

// Removes an entry of a completed frame from the list.
template <class What>
bool takeDue(std::pmr::vector<edge::Deferred<What>>& list, uint64_t completed,
             What& what) noexcept {
    const auto due = std::find_if(list.begin(), list.end(), [&](const edge::Deferred<What>& one) {
        return one.frameIndex <= completed;
    });
    if (due == list.end()) return false;
    what = due->what;
    list.erase(due);
    return true;
}

}  // namespace

namespace fw::edge {

void destroyDoomed(FwWorld& handle) {
    std::pmr::vector<FwObjectRef>& due = handle.dooming;
    {
        const std::lock_guard lock(handle.doomedMutex);
        due.insert(due.end(), handle.doomed.begin(), handle.doomed.end());
        handle.doomed.clear();
    }
    const auto goes = [&](const FwObjectRef& object) {
        try {
            return destroyNow(*handle.world, object);
        } catch (const core::Error& error) {
            handle.context->log.write(FW_LOG_WARNING, "fwWorld_DestroyLater: %s", error.message);
            return error.result == FW_ERROR_STALE_ID;  // other errors: the next step tries again
        } catch (...) {
            return false;  // no memory: the next step tries again
        }
    };
    // Repeats, since a destroyed object may release others that it used.
    while (std::erase_if(due, goes) != 0) {
    }
}

}  // namespace fw::edge

extern "C" {

FwResult FW_CALL fwWorld_DestroyLater(FwWorld* world, const FwObjectRef* object) {
    return onWorld(__func__, world, [&](world::World&) {
        checkPointer(object, "object");
        checkRef(*object);
        const std::lock_guard lock(world->doomedMutex);
        world->doomed.push_back(*object);
    });
}

FwResult FW_CALL fwWorld_DestroyAfterFrame(FwWorld* world, uint64_t frameIndex) {
    return onWorld(__func__, world, [&](world::World&) {
        const uint64_t frame = frameIndex ? frameIndex : world->newestFrame.load();
        FwContext& context = *world->context;
        const std::lock_guard lock(context.mutex);
        defer(context.deferredWorlds, {world, frame});
    });
}

FwResult FW_CALL fwContext_UnregisterTargetAfterFrame(FwContext* context, FwTargetId id,
                                                      uint64_t frameIndex) {
    return onContext(__func__, context, [&](FwContext& c) {
        if (id.index1 == 0) core::fail(FW_ERROR_STALE_ID, "Target id is null.");
        c.device->checkTarget(id);
        const std::lock_guard lock(c.mutex);
        defer(c.deferredTargets, {id, frameIndex});
    });
}

uint32_t FW_CALL fwContext_Collect(FwContext* context, uint64_t completedFrameIndex) {
    uint32_t waiting = 0;
    (void)onContext(__func__, context, [&](FwContext& c) {
        for (;;) {
            FwWorld* world = nullptr;
            FwTargetId target{};
            {
                const std::lock_guard lock(c.mutex);
                if (!takeDue(c.deferredWorlds, completedFrameIndex, world) &&
                    !takeDue(c.deferredTargets, completedFrameIndex, target)) {
                    waiting = uint32_t(c.deferredWorlds.size() + c.deferredTargets.size());
                    return FW_OK;
                }
            }
            if (world)
                fwDestroyWorld(world);
            else
                unregister(*c.device, target);
        }
    });
    return waiting;
}

}  // extern "C"
