// Deferred destruction: any thread may request it while another one steps or records.
#include "core/assert.h"
#include "flamewright/flamewright_vulkan.h"
#include "objects.h"

#include <algorithm>

using namespace fw;
using edge::checkPointer;
using edge::onContext;
using edge::onWorld;

namespace {

void destroyObject(world::World& w, const FwObjectRef& object) {
    switch (FwObjectKind(object.kind)) {  // the compiler misses a kind without a row
#define FW_KIND(KIND, Name, System, destroyFunction, destroy)                                     \
    case FW_OBJECT_##KIND:                                                                        \
        edge::systemOf<world::System>(w).destroy(Fw##Name##Id{object.index1, object.generation}); \
        break;
#include "kinds.inl"
        case FW_OBJECT_KIND_COUNT:
        case FW_OBJECT_KIND_FORCE32:
            FW_ASSERT(false, "kind %u", object.kind);
    }
}

void checkRef(const FwObjectRef& object) {
    components::checkWhole(object.kind, "FwObjectRef::kind", 1, FW_OBJECT_KIND_COUNT - 1);
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
        destroyObject(w, object);
    } catch (const core::Error& error) {
        if (error.result == FW_ERROR_INVALID_ARGUMENT) return false;
        throw;
    }
    return true;
}

void defer(FwContext& context, const edge::Deferred& one) {
    const std::lock_guard lock(context.mutex);
    const auto known = std::ranges::find_if(context.deferred, [&](const edge::Deferred& had) {
        return had.world == one.world && had.target.index1 == one.target.index1 &&
               had.target.generation == one.target.generation;
    });
    if (known == context.deferred.end())
        context.deferred.push_back(one);
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
        defer(*world->context, {world, {}, frame});
    });
}

FwResult FW_CALL fwContext_UnregisterTargetAfterFrame(FwContext* context, FwTargetId id,
                                                      uint64_t frameIndex) {
    return onContext(__func__, context, [&](FwContext& c) {
        if (id.index1 == 0) core::fail(FW_ERROR_STALE_ID, "Target id is null.");
        c.device->checkTarget(id);
        defer(c, {nullptr, id, frameIndex});
    });
}

uint32_t FW_CALL fwContext_Collect(FwContext* context, uint64_t completedFrameIndex) {
    uint32_t waiting = 0;
    (void)onContext(__func__, context, [&](FwContext& c) {
        for (;;) {
            edge::Deferred one;
            {
                const std::lock_guard lock(c.mutex);
                const auto due = std::ranges::find_if(c.deferred, [&](const edge::Deferred& had) {
                    return had.frameIndex <= completedFrameIndex;
                });
                if (due == c.deferred.end()) {
                    waiting = uint32_t(c.deferred.size());
                    return FW_OK;
                }
                one = *due;
                c.deferred.erase(due);
            }
            if (one.world)
                fwDestroyWorld(one.world);
            else
                unregister(*c.device, one.target);
        }
    });
    return waiting;
}

}  // extern "C"
