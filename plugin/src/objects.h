// What the two opaque pointers point to.
#pragma once
#include "device.h"
#include "edge.h"
#include "net/client.h"
#include "net/server.h"

#include <atomic>
#include <mutex>
#include <optional>

namespace fw::edge {

// The copy that each frame leaves for fwWorld_Read..., which any thread may call.
struct Snapshot {
    explicit Snapshot(std::pmr::memory_resource* memory) : lights(memory), objects(memory) {}
    std::atomic<bool> wanted{false};  // some thread reads
    std::mutex mutex;                 // of what follows
    bool there = false;
    std::pmr::vector<FwLight> lights;
    std::pmr::vector<world::StateCopy> objects;  // by slot
};

template <class What>
struct Deferred {  // to be destroyed once the frame is complete
    What what{};
    uint64_t frameIndex = 0;
};

}  // namespace fw::edge

struct FwContext {
    explicit FwContext(const FwCallbacks& given)
        : callbacks(given),
          memory(given),
          log(given),
          worlds(&memory),
          deferredWorlds(&memory),
          deferredTargets(&memory),
          cooked(&memory) {}

    FwCallbacks callbacks;
    fw::core::Memory memory;
    fw::core::Log log;
    fw::edge::LastMessage message;
    uint32_t backend = FW_BACKEND_CPU;
    fw::edge::Device* device = nullptr;

    std::mutex mutex;  // of what is below
    std::pmr::vector<FwWorld*> worlds;
    std::pmr::vector<fw::edge::Deferred<FwWorld*>> deferredWorlds;  // of `worlds`
    std::pmr::vector<fw::edge::Deferred<FwTargetId>> deferredTargets;
    // The last cooked mesh, between the call that asks for its size and the one that takes it.
    std::pmr::vector<std::byte> cooked;
    uint64_t cookedKey = 0;
};

struct FwWorld {
    explicit FwWorld(FwContext* owner)
        : context(owner),
          snapshot(&owner->memory),
          doomed(&owner->memory),
          dooming(&owner->memory) {}

    FwContext* context;
    fw::edge::LastMessage message;
    fw::gpu::Backend* backend = nullptr;
    std::optional<fw::world::World> world;
    // At most one of them, while the world is shared.
    std::optional<fw::net::Server> server;
    std::optional<fw::net::Client> client;

    // State that other threads use while one thread steps or records the world.
    std::atomic<uint64_t> newestFrame{0};  // that it has begun to step or record
    fw::edge::Snapshot snapshot;
    std::mutex doomedMutex;
    std::pmr::vector<FwObjectRef> doomed;  // fwWorld_DestroyLater, since the last step
    // Of the thread that steps: what earlier calls named and something still uses, in their order.
    std::pmr::vector<FwObjectRef> dooming;
};

namespace fw::edge {

// Runs `body(context)`; a null context has nowhere to write a message.
template <class Body>
FwResult onContext(const char* function, FwContext* context, Body&& body) noexcept {
    if (!context) return FW_ERROR_INVALID_ARGUMENT;
    return guard(
        function,
        [&](FwResult, const char* text) {
            context->message.set(text);
            context->log.write(FW_LOG_ERROR, "%s", text);
        },
        [&] { return body(*context); });
}

template <class Body>
FwResult onWorld(const char* function, FwWorld* world, Body&& body) noexcept {
    if (!world) return FW_ERROR_INVALID_ARGUMENT;
    return guard(
        function,
        [&](FwResult, const char* text) {
            world->message.set(text);
            world->context->log.write(FW_LOG_ERROR, "%s", text);
        },
        [&] { return body(*world->world); });
}

// Where answers need no frame of the host's, they are there when the call returns.
inline void answerAtOnce(FwWorld* handle) {
    Device& device = *handle->context->device;
    if (device.answersAtOnce()) device.step(*handle->backend, *handle->world, 0.0f);
}

// Before a step: destroys what fwWorld_DestroyLater named, as far as nothing uses it. deferred.cpp
void destroyDoomed(FwWorld& handle);
// After a step: the copy for other threads, where one reads. snapshot.cpp
void publish(FwWorld& handle) noexcept;

template <class T>
void checkPointer(T* pointer, const char* name) {
    if (!pointer) core::fail(FW_ERROR_INVALID_ARGUMENT, "%s is null.", name);
}

}  // namespace fw::edge
