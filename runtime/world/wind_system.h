// Which wind blows where: the world's own, the host's grid in its place or beside it, gusts on
// both, and zones. All but the first count in integers, so that all machines agree.
#pragma once
#include "components/gusts.h"
#include "components/wind_grid.h"
#include "components/wind_zone.h"
#include "world/command.h"
#include "world/scene.h"
#include "world/slotted.h"

#include <array>

namespace fw::world {

// The middle of an object's box, at rest.
[[nodiscard]] components::WindPlace windPlaceOf(const components::Pose& pose,
                                                const mesh::BurnDomain& domain) noexcept;

struct WindFields {  // that a save has
    explicit WindFields(std::pmr::memory_resource* memory) : grid(memory) {}
    float wind[3] = {};       // m/s, everywhere
    uint64_t gustsShown = 0;  // tick of the gusts that objects keep
    components::WindGrid grid;
    components::Gusts gusts;

    template <class A>
    void serialize(A& a) {
        a(wind, gustsShown, grid, gusts);
        a.range("wind", wind, -double(fire::kMaxWind), double(fire::kMaxWind));
    }
};

// `zones`: in the order in which they count.
[[nodiscard]] fire::WindVector windOf(const WindFields& winds, const components::Gusts& gusts,
                                      std::span<const components::WindZone> zones, uint32_t seed,
                                      const components::WindPlace& place, uint64_t tick) noexcept;

struct WindSnapshot : WindFields {
    explicit WindSnapshot(std::pmr::memory_resource* memory)
        : WindFields(memory), zones(memory), ordered(memory) {}
    SlottedList<components::WindZone> zones;
    std::pmr::vector<components::WindZone> ordered;  // in the order in which they count

    template <class A>
    void serialize(A& a) {
        WindFields::serialize(a);
        a.list("wind zones", zones, 108);
        if constexpr (!A::kReads) return;
        ordered.assign(zones.begin(), zones.end());
        components::sortWindZones(ordered);
    }
};

struct WindState : WindFields {
    explicit WindState(std::pmr::memory_resource* memory)
        : WindFields(memory), zones("Wind zone", memory), ordered(memory) {}
    core::HandlePool<FwWindZoneId, components::WindZone> zones;
    std::pmr::vector<components::WindZone> ordered;  // `zones` in the order in which they count
    bool due = false;   // what objects keep of the wind is to be found again
    bool kept = false;  // some may keep another than the world's own
    uint64_t changes = 0;
    uint64_t updates = 0;  // grows whenever a place may have another wind than before
};

class WindSystem {
 public:
    WindSystem(const WorldContext& context, Scene& scene);

    void set(const float wind[3]);
    void setGrid(const FwWindGridDef& def);  // of structSize 0: removes the grid
    void setGusts(const FwGustDef& def);
    FwWindZoneId createZone(const FwWindZoneDef& def);
    void setZone(FwWindZoneId id, const FwWindZoneDef& def) {
        setZone(id, components::makeWindZone(def));
    }
    void setZone(FwWindZoneId id, const components::WindZone& zone);
    void destroyZone(FwWindZoneId id);
    void atPoint(const float point[3], float wind[3]) const;

    void plan(gpu::FramePlan& plan) noexcept;  // first of all
    // visit(place, name, slot) for all that a shift of the origin moves and may refuse.
    template <class Visit>
    void eachPlace(const Visit& visit) {
        for (auto [i, zone] : state_.zones.entries()) visit(zone.middle, "wind zone", i);
        if (!state_.grid.points.empty()) visit(state_.grid.shape.origin, "wind grid", 0u);
    }
    void shiftOrigin(const double (&by)[3]) noexcept;  // all else

    [[nodiscard]] const WindState& state() const noexcept { return state_; }
    [[nodiscard]] uint64_t changes() const noexcept { return state_.changes; }
    [[nodiscard]] bool hasGusts() const noexcept { return state_.gusts.strength != 0; }
    [[nodiscard]] fire::WindVector at(const components::WindPlace& place,
                                      uint64_t tick) const noexcept;
    [[nodiscard]] std::array<float, 3> at(const float place[3], uint64_t tick) const noexcept;
    // m/s, as if there were no gusts.
    [[nodiscard]] std::array<float, 3> steadyAt(const float place[3]) const noexcept;
    [[nodiscard]] components::DriveInput driveInput(const Object& object,
                                                    uint64_t tick) const noexcept;
    // The wind where an object is, less the world's own, packed as in its records.
    [[nodiscard]] uint32_t localWindOf(const Object& object, uint64_t tick) const noexcept;
    void updateObject(Object& object) noexcept;  // that moved
    void addObject(const Object& object) noexcept;
    void apply(const SetWind& command) { set(command.wind); }
    void apply(const SetWindZone& command) {
        setZone(state_.zones.findId(command.slot), command.zone);
    }
    void apply(const SetWindGrid& command);
    void apply(const SetWindPoints& command);
    void apply(const SetGusts& command);
    void capture(WindSnapshot& to) const;
    void restore(WindSnapshot& from) noexcept;  // before objects are

 private:
    [[nodiscard]] bool isUniform() const noexcept;  // the world's own wind blows everywhere
    void sortZones() noexcept;
    void updateObjects() noexcept;
    void updateObjectsIn(const components::WindZone& zone) noexcept;

    const WorldContext& context_;
    Scene& scene_;
    WindState state_{context_.memory};
};

}  // namespace fw::world
