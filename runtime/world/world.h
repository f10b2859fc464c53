// A world of burnable meshes: it owns the systems, and keeps the clock and the order in which they
// work. It knows no device and no C edge. Calls throw core::Error or std::bad_alloc and then have
// changed nothing. One thread at a time.
#pragma once
#include "world/burn_system.h"
#include "world/context.h"
#include "world/emitter_system.h"
#include "world/exchange_system.h"
#include "world/field_system.h"
#include "world/flame_system.h"
#include "world/governor.h"
#include "world/light_system.h"
#include "world/persistence.h"
#include "world/query_system.h"
#include "world/room_system.h"
#include "world/scene.h"
#include "world/wind_system.h"

#include <atomic>

namespace fw::world {

void checkWorldDef(const FwWorldDef& def);  // throws

class World {
 public:
    // `def` is checked here. The backend outlives the world.
    World(const FwWorldDef& def, gpu::Backend& backend, const core::Log& log,
          std::pmr::memory_resource* memory);
    World(const World&) = delete;
    World& operator=(const World&) = delete;

    [[nodiscard]] Scene& scene() noexcept { return scene_; }
    [[nodiscard]] WindSystem& wind() noexcept { return wind_; }
    [[nodiscard]] RoomSystem& rooms() noexcept { return rooms_; }
    [[nodiscard]] FieldSystem& fields() noexcept { return fields_; }
    [[nodiscard]] FlameSystem& flames() noexcept { return flames_; }
    [[nodiscard]] EmitterSystem& emitters() noexcept { return emitters_; }
    [[nodiscard]] LightSystem& lights() noexcept { return lights_; }
    [[nodiscard]] ExchangeSystem& exchange() noexcept { return exchange_; }
    [[nodiscard]] BurnSystem& burn() noexcept { return burn_; }
    [[nodiscard]] QuerySystem& queries() noexcept { return queries_; }
    [[nodiscard]] PersistenceSystem& persistence() noexcept { return persistence_; }
    [[nodiscard]] BudgetSystem& budget() noexcept { return budget_; }

    FwBurnableMeshId createBurnableMesh(const FwBurnableMeshDef& given);
    void destroyBurnableMesh(FwBurnableMeshId id);
    void setTransform(FwBurnableMeshId id, const float transform[16]);
    void apply(const SetPose& command) {
        setTransform(scene_.objects.findId(command.slot), command.transform.matrix().data());
    }
    void apply(const ShiftOrigin& command);
    void setVertexPositions(FwBurnableMeshId id, const float* positions, const float* normals,
                            uint32_t count);
    // Moves every place of the world by whole metres; `applied`: those, or null.
    void shiftOrigin(const float offset[3], float applied[3]);
    void origin(double* moved) const noexcept { std::copy_n(context_.origin.moved, 3, moved); }
    // The origin moved since the last frame: the backend shows everything where it was.
    [[nodiscard]] bool shifted() const noexcept {
        return context_.origin.movedAfter(context_.lastFrame);
    }

    // Throws unless advance would take these.
    void checkFrame(uint64_t frameIndex, float deltaTime) const;
    // One frame: collects readbacks, plans, runs the backend, collects again.
    void advance(uint64_t frameIndex, float deltaTime);
    // Applies readbacks that have come since; if memory ends, the next frame applies the rest.
    void collect() noexcept;
    [[nodiscard]] uint64_t lastFrame() const noexcept { return context_.lastFrame; }
    [[nodiscard]] uint64_t tick() const noexcept { return context_.clock.tick; }
    [[nodiscard]] uint32_t maxLights() const noexcept { return context_.def.maxLights; }
    [[nodiscard]] uint32_t mostSteps() const noexcept { return context_.def.maxStepsPerFrame; }
    [[nodiscard]] const core::Log& log() const noexcept { return context_.log; }
    void stats(FwWorldStats& stats) noexcept;
    // Appends what the world keeps of objects in this machine's memory, as the last step left it.
    // [any]
    void memoryRows(std::pmr::vector<gpu::MemoryRow>& out) const;
    void setSwitches(uint32_t switches);  // flamewright_debug.h

 private:
    friend class PersistenceSystem;
    FwBurnableMeshId createOn(uint32_t meshSlot, const FwBurnableMeshDef& def,
                              core::Owned<Object> owned);
    struct ObjectRecords;
    void makeRecords(Object& object, MeshEntry& mesh, const FwBurnableMeshDef& def,
                     ObjectRecords& made);
    void countObjectFuel(Object& object, const MeshEntry& mesh,
                         std::span<const uint8_t> gone) const;
    void shiftBy(const double (&by)[3]) noexcept;
    // Visits the scene and all systems whose places move and that know of objects.
    template <class Visit>
    void eachSystem(const Visit& visit) {
        visit(scene_), visit(burn_), visit(emitters_), visit(queries_), visit(exchange_);
        visit(flames_), visit(fields_), visit(wind_), visit(rooms_), visit(lights_);
    }
    // At each exchange up to a tick: fires, jets and fields address the objects that they reach.
    void actOnObjects(uint64_t end);
    void plan(const HostFrame& frame, gpu::FramePlan& plan);
    void commit(const HostFrame& frame);
    void collectReadbacks();  // throws std::bad_alloc; the readback then stays with the backend
    void applyReadback(const gpu::Readback& readback);
    void countMemory() noexcept;

    // Bytes, for memoryRows, which any thread may call.
    struct MemoryCounts {
        std::atomic<uint64_t> objects{0}, frames{0}, neighbours{0}, contacts{0};
    };
    MemoryCounts memoryCounts_;
    EventQueue events_;
    WorldContext context_;
    Recorder recorder_;
    Scene scene_;
    WindSystem wind_;
    RoomSystem rooms_;
    FieldSystem fields_;
    FlameSystem flames_;
    EmitterSystem emitters_;
    LightSystem lights_;
    ExchangeSystem exchange_;
    BurnSystem burn_;
    QuerySystem queries_;
    BudgetSystem budget_;
    PersistenceSystem persistence_;
};

}  // namespace fw::world
