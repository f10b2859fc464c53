// Couples the game to a burning world. Each tick the rules read the burn state, and the world
// receives jets, embers, water, wind and enemies from the rules. Equal on all backends.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "battlefield.h"
#include "fire_village.h"
#include "placed.h"
#include "wind.h"

namespace tower {

constexpr float kTickSeconds = 1.0f / float(game::kTicksPerSecond);

class Siege {
 public:
    Siege(FwWorld* world, FireVillage& fires, const Battlefield& field, const game::State& state);

    // Returns null if the order is applied, otherwise the reason.
    const char* give(const game::Order& order);
    // Advances the rules. Call it before the world's step of equal length.
    void advance(int32_t ticks);

    const game::State& state() const { return state_; }
    // Events of the last advance.
    std::span<const game::Event> events() const { return events_; }
    // Number of houses that broke in the last advance.
    size_t brokenHouses() const { return brokenHouses_; }
    bool broken(size_t house) const { return houseThing(house).broken; }
    std::span<const Placed> placed() const { return placed_; }
    const Wind& wind() const { return wind_; }
    // Adds lights for jets and embers, which the library's lights show too weakly at night.
    void addLights(float scale, std::vector<PointLight>& lights) const;

    // A snapshot of game and world. `world` is the library's save after the step that follows the
    // advance.
    struct Snapshot {
        game::State state;
        std::vector<uint8_t> flags;  // FireVillage::flags
        std::vector<uint8_t> world;
        Wind wind;
    };
    Snapshot snapshot() const { return {state_, fires_.flags(), {}, wind_}; }
    void restore(const Snapshot& snapshot);

 private:
    void lightBrazier(const village::Frame& frame);
    void makeEmitters();
    void makeRooms();
    const Thing& houseThing(size_t house) const {
        return fires_.things[fires_.thingOf(field_.houses[house])];
    }
    game::Burning queryBurning();
    void apply(const game::Event& event);
    void moveEnemies();
    void aimTowers();
    void aimJet(size_t plot);
    void flyEmber(size_t plot);
    void aimSpray(size_t plot);
    FwWindZoneDef windOfPlot(size_t plot) const;
    void turnFan(size_t plot);
    void check(FwResult result, const char* what) const { checkFire(world_, result, what); }

    FwWorld* world_;
    FireVillage& fires_;
    const Battlefield& field_;
    game::State state_;
    std::vector<game::Event> events_;
    std::vector<Placed> placed_;
    Wind wind_;
    size_t brokenHouses_ = 0;
    // One per plot for any tower kind, because a save loads only into a world with equal objects.
    std::array<FwFireEmitterId, game::kPlots> jets_{}, embers_{};
    std::array<FwParticleFieldId, game::kPlots> sprays_{};
    std::array<FwWindZoneId, game::kPlots> fans_{};
    std::array<FwRoomId, game::kHouses> rooms_{};
};

}  // namespace tower
