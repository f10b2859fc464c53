// Deferred destruction: any thread may request it while another one steps or records.
#include "flamewright/flamewright_vulkan.h"
#include "objects.h"

#include <algorithm>

using namespace fw;
using edge::checkPointer;
using edge::onContext;
using edge::onWorld;

namespace {

template <class Id>
Id idOf(const FwObjectRef& object) noexcept {
    return {object.index1, object.generation};
}

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
        switch (object.kind) {
            case FW_OBJECT_MATERIAL:
                w.scene().destroyMaterial(idOf<FwMaterialId>(object));
                break;
            case FW_OBJECT_IMAGE:
                if (w.scene().showsImage(idOf<FwImageId>(object))) return false;
                w.scene().destroyImage(idOf<FwImageId>(object));
                break;
            case FW_OBJECT_MESH:
                w.scene().destroyMesh(idOf<FwMeshId>(object));
                break;
            case FW_OBJECT_BURNABLE_MESH:
                w.destroyBurnableMesh(idOf<FwBurnableMeshId>(object));
                break;
            case FW_OBJECT_HEAT_OCCLUDER:
                w.exchange().removeHeatOccluder(idOf<FwHeatOccluderId>(object));
                break;
            case FW_OBJECT_VOLUMETRIC_FIRE:
                w.flames().destroy(idOf<FwVolumetricFireId>(object));
                break;
            case FW_OBJECT_FIRE_PROFILE:
                w.flames().destroyProfile(idOf<FwFireProfileId>(object));
                break;
            case FW_OBJECT_FIRE_COLLIDER:
                w.flames().removeCollider(idOf<FwFireColliderId>(object));
                break;
            case FW_OBJECT_FIRE_EMITTER:
                w.emitters().destroy(idOf<FwFireEmitterId>(object));
                break;
            case FW_OBJECT_FLIPBOOK:
                w.flames().destroyFlipbook(idOf<FwFlipbookId>(object));
                break;
            case FW_OBJECT_PARTICLE_FIELD:
                w.fields().destroy(idOf<FwParticleFieldId>(object));
                break;
            case FW_OBJECT_WIND_ZONE:
                w.wind().destroyZone(idOf<FwWindZoneId>(object));
                break;
            case FW_OBJECT_ROOM:
                w.rooms().destroy(idOf<FwRoomId>(object));
                break;
            default:
                w.burn().destroyBurn(idOf<FwBurnId>(object));
                break;
        }
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
