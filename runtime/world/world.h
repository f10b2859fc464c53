// A world of burnable meshes: ids, time, wind, queues and what comes back from a backend. Integer
// CPU code, the same for every backend; it knows no device and no C edge. Calls throw core::Error
// or std::bad_alloc and then have changed nothing. One thread at a time.
#pragma once
#include "components/burnable_mesh.h"
#include "core/handle_pool.h"
#include "core/log.h"
#include "core/owned.h"
#include "flamewright/flamewright_debug.h"
#include "gpu/backend.h"
#include "mesh/burn_domain.h"
#include "world/clock.h"
#include "world/event_queue.h"

#include <array>

namespace fw::world {

struct MeshEntry {
    core::Owned<mesh::BurnDomain> domain;
    core::Owned<mesh::DeformModel> deform;                      // once an object deforms
    std::array<uint32_t, gpu::kMaterialsPerObject> texelsOf{};  // real texels per material index
    uint32_t users = 0;                                         // objects, and shapes of it
    // A shape of another mesh, for objects whose scale is not uniform: lives while one uses it.
    uint32_t parentPlus1 = 0;  // its slot + 1; 0: a mesh of the host's
    float shape[3] = {1, 1, 1};
    uint32_t refinements = 0;  // bit per depth that the backend has
};

struct ImageEntry {
    uint32_t slot = 0;  // the backend's; outlives the id while an object uses it
};

struct BurnMapCopy {  // of fwDebug_RequestBurnMap
    std::pmr::vector<uint32_t> ticks;
    std::pmr::vector<gpu::uvec2> heat;  // packed HeatTexel; empty: none
    uint64_t tick = 0;
    bool wished = false, pending = false, ready = false;
    explicit BurnMapCopy(std::pmr::memory_resource* memory) : ticks(memory), heat(memory) {}
};

struct Object {
    explicit Object(std::pmr::memory_resource* memory)
        : map(memory), skin(memory), skinNormals(memory) {}

    components::BurnableMesh data;
    components::Latch latch;  // the drive that its front sees
    uint32_t slot = 0;        // the backend's: its index in the pool
    FwBurnableMeshId id{};
    uint32_t texels = 0;      // that can burn
    uint64_t firstFrame = 0;  // readbacks of older frames speak of another object
    // What happened, in ticks.
    bool touched = false;        // an event ever addressed it: it filters wind and latches
    bool active = false;         // its front or flames may still move
    bool sawFire = false;        // since the last IGNITED
    uint64_t lastStimulus = 0;   // tick of the last event or latch sent
    uint64_t lastDouse = 0;      // tick, 0: never
    uint64_t lastBurning = 0;    // tick of the last readback with burning texels
    uint64_t firstIgnition = 0;  // tick of the ignition that started this fire
    bool doused = false, ignitionKnown = false;
    float ignitionPoint[3] = {};  // m, object space
    // As of the last readback.
    gpu::ObjectCounters counters{};
    uint32_t mostIgnited = 0;
    uint32_t clampsTold = 0;  // late clamps that an event has told
    uint64_t countersFrame = 0;
    uint64_t energy = 0, heatSteps = 0;  // 2^-20 J after so many heat steps
    float power = 0;                     // W, at pace 1; of objects with heat
    BurnMapCopy map;
    // Of a skinned object: the host's vertices, m, in its mesh's shape; 3 each. Normals are
    // scratch.
    std::pmr::vector<float> skin, skinNormals;
    bool skinMoved = false;  // else they are at rest
};

struct Tag {
    FwBurnableMeshId object{};
    uint32_t texel = 0, tag = 0;
};

struct Query {
    FwBurnableMeshId object{};
    uint32_t texel = 0;
    float distance = 0;  // m
    FwPointState answer{};
    bool asked = false, ready = false, orphaned = false;
};

struct PendingTexel {  // an event that waits for its step
    uint32_t object = 0, texel = 0, kind = 0, tick = 0, water = 0;  // g/m^2
    uint64_t order = 0;
};

void checkWorldDef(const FwWorldDef& def);  // throws

class World {
 public:
    // `def` is checked here. The backend outlives the world.
    World(const FwWorldDef& def, gpu::Backend& backend, const core::Log& log,
          std::pmr::memory_resource* memory);
    ~World();
    World(const World&) = delete;
    World& operator=(const World&) = delete;

    void setWind(const float wind[3]);

    FwMaterialId createMaterial(const FwMaterialDef& def);
    void destroyMaterial(FwMaterialId id) { materials_.destroy(id); }
    FwImageId createImage(const FwImageDef& def);
    void destroyImage(FwImageId id);
    FwMeshId createMesh(const FwMeshDef& def);
    void destroyMesh(FwMeshId id);
    void meshInfo(FwMeshId id, FwMeshInfo& info);

    FwBurnableMeshId createBurnableMesh(const FwBurnableMeshDef& def);
    void destroyBurnableMesh(FwBurnableMeshId id);
    void setTransform(FwBurnableMeshId id, const float transform[16]);
    // Its backend slot; throws unless it is skinned and has so many vertices.
    uint32_t skinnedSlot(FwBurnableMeshId id, uint32_t vertexCount);
    void setVertexPositions(FwBurnableMeshId id, const float* positions, const float* normals,
                            uint32_t count);
    void setHidden(FwBurnableMeshId id, bool hidden);
    uint32_t ignite(const FwIgnitionDef& def);  // texels addressed

    // Throws unless advance would take these.
    void checkFrame(uint64_t frameIndex, float deltaTime) const;
    // One frame: collects readbacks, plans, runs the backend, collects again.
    void advance(uint64_t frameIndex, float deltaTime);
    // Takes readbacks that have come since; what memory refuses comes with the next frame.
    void collect() noexcept;
    [[nodiscard]] uint64_t lastFrame() const noexcept { return lastFrame_; }

    uint32_t pollEvents(std::span<FwEvent> out);
    void tagPoint(FwBurnableMeshId id, const float position[3], uint32_t tag);
    void objectState(FwBurnableMeshId id, FwObjectState& state);
    FwQueryId requestPoint(FwBurnableMeshId id, const float position[3]);
    bool fetchPoint(FwQueryId id, FwPointState& state);  // false: not ready
    void dropQuery(FwQueryId id) { queries_.destroy(id); }
    uint32_t lights(std::span<FwLight> out) const noexcept;
    void stats(FwWorldStats& stats) noexcept;

    // flamewright_debug.h
    void requestBurnMap(FwBurnableMeshId id);
    const BurnMapCopy* fetchBurnMap(FwBurnableMeshId id);  // null: not ready
    void setSwitches(uint32_t switches);
    void pushTexels(FwBurnableMeshId id, uint32_t kind, std::span<const uint32_t> texels);
    const mesh::BurnDomain& domain(FwMeshId id) { return *meshes_.get(id).domain; }

 private:
    static constexpr uint32_t kMaxSteps = 64;
    static constexpr uint32_t kMaxTags = 4096;
    static constexpr uint32_t kMaxQueries = 1024;
    static constexpr size_t kMaxPending = size_t(1) << 22;  // texel events that wait
    static constexpr uint32_t kFramesInFlight = 16;         // readbacks we still know the probes of

    struct ProbeRef {  // what a probe of a frame was for
        bool isTag = false;
        FwBurnableMeshId object{};
        uint32_t texel = 0, tag = 0;
        FwQueryId query{};
    };
    struct ProbeFrame {
        explicit ProbeFrame(std::pmr::memory_resource* memory) : refs(memory) {}
        uint64_t frameIndex = 0;
        std::pmr::vector<ProbeRef> refs;
    };
    struct Frame {  // scratch of one frame; keeps its room between frames
        explicit Frame(std::pmr::memory_resource* memory)
            : steps(memory),
              due(memory),
              events(memory),
              updates(memory),
              latches(memory),
              probes(memory),
              burnMaps(memory) {}
        struct Due {
            PendingTexel event;
            uint32_t step = 0;
        };
        struct LatchOf {
            Object* object = nullptr;
            components::Latch latch;
            bool due = false;  // an event of this frame addresses it
        };
        std::pmr::vector<gpu::StepPlan> steps;
        std::pmr::vector<Due> due;
        std::pmr::vector<gpu::TexelEvent> events;
        std::pmr::vector<gpu::MaterialUpdate> updates;
        std::pmr::vector<LatchOf> latches;  // of touched objects, as they are at the frame's end
        std::pmr::vector<gpu::Probe> probes;
        std::pmr::vector<uint32_t> burnMaps;
    };

    // step.cpp
    void planSteps(const ClockAdvance& time);
    void planProbes();
    void commitFrame(uint64_t frameIndex, const ClockAdvance& time, bool ran) noexcept;
    // latch.cpp
    void planLatches(uint32_t now, size_t firstEvent);
    [[nodiscard]] components::DriveInput driveInput() const noexcept;
    // events.cpp
    void collectReadbacks();  // throws std::bad_alloc; the readback then stays with the backend
    void takeCounters(const gpu::Readback& readback) noexcept;
    void takeEnergy(Object& object, uint32_t endTick) noexcept;
    void takeAnswers(const gpu::Readback& readback) noexcept;
    void takeLights(const gpu::Readback& readback) noexcept;
    void raise(uint32_t type, const Object* object, uint32_t tag, uint64_t frameIndex,
               const float position[3], float value) noexcept;
    // queries.cpp
    FwPointState pointState(const Object& object, uint32_t texel, const gpu::ProbeAnswer& answer,
                            const gpu::Readback& readback) const noexcept;
    void texelPosition(const Object& object, uint32_t texel, float (&out)[3]) const noexcept;
    // Where a texel is, m, object space: at rest, or on the vertices that the host moved.
    void texelPlace(const Object& object, uint32_t texel, float (&out)[3]) const noexcept;
    // Nearest texel within `reach` m of a point in object space, or kNone.
    uint32_t nearestTexel(const Object& object, const float point[3], float reach) const noexcept;
    uint32_t texelMaterial(const Object& object, uint32_t texel) const noexcept;
    [[nodiscard]] const mesh::BurnDomain& domainOf(const Object& object) const noexcept;
    // world.cpp
    FwBurnableMeshId createOn(uint32_t meshSlot, const FwBurnableMeshDef& def,
                              core::Owned<Object> owned);
    uint32_t igniteObject(Object& object, const FwIgnitionDef& def, uint32_t tick);
    void addPending(const Object& object, uint32_t kind, uint32_t tick, uint32_t water,
                    std::span<const uint32_t> texels);
    uint32_t eventTick(float delay) const;
    MeshEntry makeEntry(core::Owned<mesh::BurnDomain> domain) const;
    FwMeshId createEntry(MeshEntry entry);
    // Slot of the mesh in this shape: itself, one that is there, or a new one.
    uint32_t shapedSlot(uint32_t slot, const float shape[3]);
    void releaseShape(uint32_t slot) noexcept;
    void countImages(const components::BurnableMesh& object, bool more) noexcept;
    void refineMesh(MeshEntry& mesh, uint32_t slot, const FwBurnableMeshDef& def,
                    const components::BurnableMesh& object);
    void sendPose(const Object& object) noexcept;

    std::pmr::memory_resource* memory_;
    gpu::Backend& backend_;
    const core::Log& log_;
    FwWorldDef def_;
    float wind_[3] = {};  // m/s, world

    core::HandlePool<FwMaterialId, FwMaterialDef> materials_;
    core::HandlePool<FwImageId, ImageEntry> images_;
    core::HandlePool<FwMeshId, MeshEntry> meshes_;
    core::HandlePool<FwBurnableMeshId, core::Owned<Object>> objects_;
    core::HandlePool<FwQueryId, Query> queries_;
    std::pmr::vector<uint32_t> imageUsers_;  // by backend slot: objects + 1 for a live id; 0: free
    std::pmr::vector<Object*> touched_;      // in slot order: idle objects cost a frame nothing
    uint32_t shapes_ = 0;                    // entries of meshes_ that are shapes
    uint64_t texels_ = 0;                    // of all objects, that can burn
    uint32_t mapsWished_ = 0;                // objects whose burn map is still to be asked for
    std::pmr::vector<Tag> tags_;
    std::pmr::vector<PendingTexel> pending_;
    std::pmr::vector<uint32_t> found_;  // scratch of ball queries
    EventQueue events_;
    std::pmr::vector<ProbeFrame> probeFrames_;
    Frame frame_;

    Clock clock_;
    uint64_t steps_ = 0, droppedSteps_ = 0, order_ = 0;
    uint64_t lastFrame_ = 0;
    uint64_t frames_ = 0;
    uint64_t lastStimulus_ = 0;  // tick
    bool idle_ = true;
    uint32_t switches_ = 0;

    // As of the last readback.
    uint64_t readbackFrame_ = 0, readbackTick_ = 0;
    uint32_t frontTiles_ = 0, runTiles_ = 0, burningTiles_ = 0, flames_ = 0, lateClamps_ = 0;
    uint32_t hotTiles_ = 0;
    std::pmr::vector<FwLight> lights_, lightsBefore_;
    uint32_t nextLight_ = 1;
};

}  // namespace fw::world
