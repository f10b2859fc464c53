// Questions of a game: states, points, tags, arrival times, surroundings. Answers are of the last
// readback.
#pragma once
#include "components/jet.h"
#include "components/surroundings.h"
#include "host_limits.h"
#include "world/geometry.h"
#include "world/pending.h"
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
    bool operator==(const Tag& other) const noexcept {
        return same(object, other.object) && texel == other.texel && tag == other.tag;
    }

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

class QuerySystem {
 public:
    static constexpr uint32_t kMaxTags = limits::kTags;

    QuerySystem(const WorldContext& context, Scene& scene, const WindSystem& wind,
                ExchangeSystem& exchange, FlameSystem& flames, const EmitterSystem& emitters,
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
    void cancel(FwQueryId id) { queries_.destroy(id); }
    void querySurroundings(const float point[3], FwSurroundings& out);
    float querySight(const float from[3], const float to[3]);
    void makeSafetyMask(const float corner[3], const float columnStep[3], const float rowStep[3],
                        uint32_t columns, uint32_t rows, uint8_t* mask);
    // A baked burn, made of what requestBurnMap brings. Null: not ready.
    const std::pmr::vector<std::byte>* fetchBurn(FwBurnableMeshId id);
    // flamewright_debug.h
    void requestBurnMap(FwBurnableMeshId id);
    const BurnMapCopy* fetchBurnMap(FwBurnableMeshId id);  // null: not ready
    void cancelBurnMap(FwBurnableMeshId id);

    [[nodiscard]] const std::pmr::vector<Tag>& tags() const noexcept { return tags_; }
    void restore(std::pmr::vector<Tag>& tags) noexcept;  // of a save
    void restoreObject(Object& object) noexcept;
    // After the emitters listed their probes. `others`: more objects whose whole state the frame
    // reads back. Throws std::bad_alloc.
    void plan(std::initializer_list<std::span<const uint32_t>> others, gpu::FramePlan& plan);
    void commit(const HostFrame& frame) noexcept;
    void onReadback(const gpu::Readback& readback) noexcept;
    void onBurnMap(Object& object, const gpu::ObjectImage& map,
                   const gpu::Readback& readback) noexcept;
    void runForecasts() noexcept;
    void forgetObject(const Object& object) noexcept;  // that goes
    void shiftOrigin(const double (&by)[3]) noexcept;
    void reserveSlots();  // throws std::bad_alloc

    // Of the last readback: answers to probes of jets, and tags that fire reached.
    [[nodiscard]] std::span<const JetProbe> jetAnswers() const noexcept { return jetAnswers_; }
    [[nodiscard]] std::span<const Tag> reachedTags() const noexcept { return reachedTags_; }

 private:
    static constexpr uint32_t kMaxQueries = limits::kQueries;
    // Readbacks whose probes are still known.
    static constexpr uint32_t kFramesInFlight = limits::kFramesInFlight;

    struct PointProbe {
        FwQueryId query{};
        FwBurnableMeshId object{};
        uint32_t texel = 0;
    };
    // A frame's probes, and their answers, are of tags, then of queries, then of jets.
    struct ProbeFrame {
        explicit ProbeFrame(std::pmr::memory_resource* memory)
            : tags(memory), points(memory), jets(memory) {}
        uint64_t frameIndex = 0;
        std::pmr::vector<Tag> tags;
        std::pmr::vector<PointProbe> points;
        std::pmr::vector<JetProbe> jets;
    };

    [[nodiscard]] ProbeFrame& currentProbes() noexcept {
        return probeFrames_[context_.frames % kFramesInFlight];
    }
    // The texel nearest to a place of the world. Throws FW_ERROR_BAD_DATA if the mesh has none.
    uint32_t texelAt(FwBurnableMeshId id, const Object& object, const float position[3]) const;
    Query makeQuery(FwBurnableMeshId id, const float position[3]);
    Query& openQuery(FwQueryId id, bool isArrival);
    void onTag(const Tag& tag, uint32_t code, const gpu::Readback& readback) noexcept;
    FwPointState pointState(const Object& object, uint32_t texel, const gpu::ProbeAnswer& answer,
                            const gpu::Readback& readback) const noexcept;
    // arrivals.cpp
    [[nodiscard]] uint64_t changesOf(const Object& object) const noexcept;
    void requestForecasts() noexcept;
    void beginForecast(Object& object, const gpu::ObjectImage& map,
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
    const EmitterSystem& emitters_;
    const LightSystem& lights_;
    const BurnSystem& burn_;
    core::HandlePool<FwQueryId, Query> queries_{"Query", context_.memory};
    std::pmr::vector<Tag> tags_{context_.memory};
    std::pmr::vector<ProbeFrame> probeFrames_{context_.memory};
    std::pmr::vector<gpu::Probe> probes_{context_.memory};  // of a frame
    std::span<const JetProbe> jetAnswers_;
    std::pmr::vector<Tag> reachedTags_{context_.memory};
    std::pmr::vector<uint32_t> burnMaps_{context_.memory};  // of a frame: slots of objects
    uint32_t mapsRequested_ = 0;  // that no frame has asked the backend for
    std::pmr::vector<std::byte> burnBytes_{context_.memory};  // of the last fetchBurn
    std::pmr::vector<uint32_t> forecasts_{
        context_.memory};      // slots of objects that have a forecast
    size_t nextForecast_ = 0;  // of those, whose turn it is
    std::pmr::vector<components::FireSource> sources_{context_.memory};  // of the last question
};

}  // namespace fw::world
