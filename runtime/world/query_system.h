// Questions of a game: states, points, tags, arrival times, surroundings. Answers are of the last
// readback.
#pragma once
#include "components/jet.h"
#include "components/surroundings.h"
#include "host_limits.h"
#include "world/scene.h"

namespace fw::world {

class BurnSystem;
class EmitterSystem;
class ExchangeSystem;
class FlameSystem;
class LightSystem;
class WindSystem;

struct StateCopy {            // of the object in a slot
    uint32_t generation = 0;  // of it; where there is none: of the next one there
    bool live = false;
    bool touched = false;  // its fire may change; else frameIndex is that of the last readback
    FwObjectState state{};
};

struct Tag {
    FwBurnableMeshId object{};
    uint32_t texel = 0, tag = 0;

    template <class A>
    void serialize(A& a) {
        a.texel("a tag", object, texel);
        a(tag);
    }
};

struct Query {
    FwBurnableMeshId object{};
    uint32_t texel = 0;
    float distance = 0;  // m
    FwPointState answer{};
    bool asked = false, ready = false;
    bool isArrival = false;
    uint64_t since = 0, sinceTick = 0;  // of an arrival: a forecast from there on answers it
};

struct QueryState {
    explicit QueryState(std::pmr::memory_resource* memory)
        : queries("Query", memory), tags(memory) {}
    core::HandlePool<FwQueryId, Query> queries;
    std::pmr::vector<Tag> tags;
};

class QuerySystem {
 public:
    QuerySystem(const WorldContext& context, Scene& scene, const WindSystem& wind,
                ExchangeSystem& exchange, FlameSystem& flames, EmitterSystem& emitters,
                const LightSystem& lights, const BurnSystem& burn);

    uint32_t pollEvents(std::span<FwEvent> out);  // [any]
    void tagPoint(FwBurnableMeshId id, const float position[3], uint32_t tag);
    void untagPoint(FwBurnableMeshId id, uint32_t tag);
    void objectState(FwBurnableMeshId id, FwObjectState& state);
    // Of all burnable meshes, by slot, as objectState has them. `to` is that of an earlier call, or
    // empty: what never burnt is not read again.
    void copyStates(std::pmr::vector<StateCopy>& to);
    void energyLedger(FwEnergyLedger& ledger) noexcept;
    FwQueryId requestPoint(FwBurnableMeshId id, const float position[3]);
    bool fetchPoint(FwQueryId id, FwPointState& state);  // false: not ready
    FwQueryId requestArrival(FwBurnableMeshId id, const float position[3]);
    bool fetchArrival(FwQueryId id, FwArrivalState& state);  // false: not ready
    void cancel(FwQueryId id) { state_.queries.destroy(id); }
    void querySurroundings(const float point[3], FwSurroundings& out);
    float querySight(const float from[3], const float to[3]);
    void makeSafetyMask(const float corner[3], const float columnStep[3], const float rowStep[3],
                        uint32_t columns, uint32_t rows, uint8_t* mask);
    // flamewright_debug.h
    void requestBurnMap(FwBurnableMeshId id);
    const BurnMapCopy* fetchBurnMap(FwBurnableMeshId id);  // null: not ready
    void cancelBurnMap(FwBurnableMeshId id);

    void plan();  // throws std::bad_alloc
    void commit(uint64_t frameIndex) noexcept;
    void onReadback(const gpu::Readback& readback) noexcept;
    void onBurnMap(Object& object, const gpu::BurnMap& map, const gpu::Readback& readback) noexcept;
    void runForecasts() noexcept;
    void forgetObject(const Object& object) noexcept;  // that goes
    void shiftOrigin(const double (&by)[3]) noexcept;
    void reserveSlots();  // throws std::bad_alloc

    // The frame's probes, and the objects whose whole state it reads back.
    void fillPlan(gpu::FramePlan& plan) const noexcept;
    void addBurnMap(uint32_t slot) noexcept;  // capacity for all objects is reserved
    void reserveJetProbes(size_t rays);       // throws std::bad_alloc
    void addJetProbe(const components::JetHit& hit, uint32_t slot, uint32_t ray,
                     uint32_t holeTicks) noexcept;
    void forgetJet(FwFireEmitterId id) noexcept;

 private:
    friend class PersistenceSystem;
    static constexpr uint32_t kMaxTags = limits::kTags;
    static constexpr uint32_t kMaxQueries = limits::kQueries;
    static constexpr uint32_t kFramesInFlight =
        limits::kFramesInFlight;  // readbacks whose probes are still known

    struct ProbeRef {  // what a probe of a frame was for
        bool isTag = false;
        FwBurnableMeshId object{};
        uint32_t texel = 0, tag = 0;
        FwQueryId query{};
        uint32_t jet = 0, ray = 0;  // slot + 1 of an emitter
        uint32_t holeTicks = 0;     // of a jet's: see gateTicks
    };
    struct ProbeFrame {
        explicit ProbeFrame(std::pmr::memory_resource* memory) : refs(memory) {}
        uint64_t frameIndex = 0;
        std::pmr::vector<ProbeRef> refs;
    };

    [[nodiscard]] ProbeFrame& currentProbes() noexcept {
        return probeFrames_[context_.frames % kFramesInFlight];
    }
    // The texel nearest to a place of the world. Throws FW_ERROR_BAD_DATA if the mesh has none.
    uint32_t texelAt(FwBurnableMeshId id, const Object& object, const float position[3]) const;
    Query makeQuery(FwBurnableMeshId id, const float position[3]);
    Query& openQuery(FwQueryId id, bool isArrival);
    FwPointState pointState(const Object& object, uint32_t texel, const gpu::ProbeAnswer& answer,
                            const gpu::Readback& readback) const noexcept;
    // arrivals.cpp
    [[nodiscard]] uint64_t changesOf(const Object& object) const noexcept;
    void requestForecasts() noexcept;
    void beginForecast(Object& object, const gpu::BurnMap& map,
                       const gpu::Readback& readback) noexcept;
    // surroundings.cpp
    components::SurroundingAir listSources();
    components::Surroundings surroundingsAt(const components::SurroundingAir& air,
                                            components::vec3 point) const noexcept;

    const WorldContext& context_;
    Scene& scene_;
    const WindSystem& wind_;
    ExchangeSystem& exchange_;
    FlameSystem& flames_;
    EmitterSystem& emitters_;
    const LightSystem& lights_;
    const BurnSystem& burn_;
    QueryState state_{context_.memory};
    std::pmr::vector<ProbeFrame> probeFrames_{context_.memory};
    std::pmr::vector<gpu::Probe> probes_{context_.memory};  // of a frame
    std::pmr::vector<uint32_t> burnMaps_{context_.memory};  // of a frame: slots of objects
    uint32_t mapsRequested_ = 0;  // that no frame has asked the backend for
    std::pmr::vector<uint32_t> forecasts_{
        context_.memory};      // slots of objects that have a forecast
    size_t nextForecast_ = 0;  // of those, whose turn it is
    std::pmr::vector<components::FireSource> sources_{context_.memory};  // of the last question
};

}  // namespace fw::world
