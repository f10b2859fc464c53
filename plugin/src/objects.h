// What the two opaque pointers point to.
#pragma once
#include "device.h"
#include "edge.h"
#include "net/client.h"
#include "net/server.h"

#include <atomic>
#include <mutex>
#include <optional>
#include <tuple>

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

struct Deferred {              // to be destroyed once the frame is complete
    FwWorld* world = nullptr;  // null: the target
    FwTargetId target{};
    uint64_t frameIndex = 0;
};

}  // namespace fw::edge

struct FwContext {
    explicit FwContext(const FwCallbacks& given) : callbacks(given), memory(given), log(given) {}

    FwCallbacks callbacks;
    fw::core::Memory memory;
    fw::core::Log log;
    fw::edge::LastMessage message;
    uint32_t backend = FW_BACKEND_CPU;
    fw::edge::Device* device = nullptr;

    std::mutex mutex;  // of what is below
    std::pmr::vector<FwWorld*> worlds{&memory};
    std::pmr::vector<fw::edge::Deferred> deferred{&memory};
    // The last cooked mesh, between the call that asks for its size and the one that takes it.
    std::pmr::vector<std::byte> cooked{&memory};
    uint64_t cookedKey = 0;
};

struct FwWorld {
    FwWorld(FwContext* owner, const fw::edge::Unit& given) : context(owner), unit(given) {}

    FwContext* context;
    const fw::edge::Unit unit;  // of the host's lengths
    // Of object space, by slot of the mesh and of the burnable mesh.
    std::pmr::vector<fw::edge::Unit> meshUnits{&context->memory}, objectUnits{&context->memory};
    fw::edge::LastMessage message;
    fw::gpu::Backend* backend = nullptr;
    std::optional<fw::world::World> world;
    // At most one of them, while the world is shared.
    std::optional<fw::net::Server> server;
    std::optional<fw::net::Client> client;

    // State that other threads use while one thread steps or records the world.
    std::atomic<uint64_t> newestFrame{0};  // that it has begun to step or record
    fw::edge::Snapshot snapshot{&context->memory};
    std::mutex doomedMutex;
    std::pmr::vector<FwObjectRef> doomed{
        &context->memory};  // fwWorld_DestroyLater, since the last step
    // Of the thread that steps: what earlier calls named and something still uses, in their order.
    std::pmr::vector<FwObjectRef> dooming{&context->memory};
};

namespace fw::edge {

// Runs `body(context)`; a null context has nowhere to write a message.
template <class Body>
FwResult onContext(const char* function, FwContext* context, Body&& body,
                   const Unit& unit = {}) noexcept {
    if (!context) return FW_ERROR_INVALID_ARGUMENT;
    return guard(
        function,
        [&](FwResult, const char* text) {
            context->message.set(text);
            context->log.write(FW_LOG_ERROR, "%s", text);
        },
        [&] { return body(*context); }, unit);
}

// `unit`: of the lengths that a failure names; null: the world's.
template <class Body>
FwResult onWorld(const char* function, FwWorld* world, Body&& body,
                 const Unit* unit = nullptr) noexcept {
    if (!world) return FW_ERROR_INVALID_ARGUMENT;
    return guard(
        function,
        [&](FwResult, const char* text) {
            world->message.set(text);
            world->context->log.write(FW_LOG_ERROR, "%s", text);
        },
        [&] { return body(*world->world); }, unit ? *unit : world->unit);
}

// A system of a world, or the world itself.
template <class System>
System& systemOf(world::World& w) noexcept {
    return std::get<System&>(std::tie(w, w.scene(), w.wind(), w.rooms(), w.fields(), w.flames(),
                                      w.emitters(), w.lights(), w.exchange(), w.burn(), w.queries(),
                                      w.persistence(), w.budget()));
}

// A def of the host's, in metres while the call lasts.
template <class Def>
class InMetres {
 public:
    InMetres(FwWorld& world, const Def* given) : InMetres(world, given, world.unit) {}
    InMetres(FwWorld& world, const Def* given, const Unit& arrays)
        : arrays_(arrays, &world.context->memory), def_(readDef(given, world.unit)) {
        visitArrays(def_, arrays_);
    }
    operator const Def&() const noexcept { return def_; }
    Def* operator->() noexcept { return &def_; }

 private:
    MetreArrays arrays_;
    Def def_;
};

// Units of object spaces, for those that differ from the world's. A stale id has any unit: the
// world refuses it.
inline const Unit& unitOf(const FwWorld& world, const std::pmr::vector<Unit>& units,
                          uint32_t index1) noexcept {
    return index1 - 1 < units.size() ? units[index1 - 1] : world.unit;
}
inline const Unit& meshUnit(const FwWorld& world, FwMeshId id) noexcept {
    return unitOf(world, world.meshUnits, id.index1);
}
inline const Unit& objectUnit(const FwWorld& world, FwBurnableMeshId id) noexcept {
    return unitOf(world, world.objectUnits, id.index1);
}
inline void setUnit(const FwWorld& world, std::pmr::vector<Unit>& units, uint32_t index1,
                    const Unit& unit) {
    if (index1 > units.size() && unit == world.unit) return;
    if (index1 > units.size()) units.resize(index1, world.unit);
    units[index1 - 1] = unit;
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
    if (!pointer) core::refuse("%s is null.", name);
}

}  // namespace fw::edge
