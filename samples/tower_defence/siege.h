// The game coupled to a burning world: each tick the rules hear what burns, and the world gets the
// jets, embers, water, wind and marching enemies that the rules ask for. The same on every backend.
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

    // Null: done. Else why not.
    const char* give(const game::Order& order);
    // Before the world's step of as many ticks.
    void advance(int32_t ticks);

    const game::State& state() const { return state_; }
    // Of the last advance.
    std::span<const game::Happening> happened() const { return happened_; }
    // Houses that the last advance heard to have broken; and whether one has, ever.
    size_t housesBroke() const { return housesBroke_; }
    bool broken(size_t house) const { return houseThing(house).broken; }
    std::span<const Placed> placed() const { return placed_; }
    const Wind& wind() const { return wind_; }
    // The jets and embers, which the library's own lights name too weakly for a night.
    void addLights(float scale, std::vector<PointLight>& lights) const;

    // A point to come back to. `world` is the library's save of the moment after the step that
    // follows the advance.
    struct Moment {
        game::State state;
        std::vector<uint8_t> flags;  // FireVillage::flags
        std::vector<uint8_t> world;
        Wind wind;
    };
    Moment moment() const { return {state_, fires_.flags(), {}, wind_}; }
    void comeBack(const Moment& moment);

 private:
    void lightBrazier(const village::Frame& frame);
    void makeEmitters();
    void makeRooms();
    const Thing& houseThing(size_t house) const {
        return fires_.things[fires_.thingOf(field_.houses[house])];
    }
    game::Burning askBurning();
    void carryOut(const game::Happening& happening);
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
    std::vector<game::Happening> happened_;
    std::vector<Placed> placed_;
    Wind wind_;
    size_t housesBroke_ = 0;
    // One of each for every plot, whatever stands there: a save wants a world of the same things.
    std::array<FwFireEmitterId, game::kPlots> jets_{}, embers_{};
    std::array<FwParticleFieldId, game::kPlots> sprays_{};
    std::array<FwWindZoneId, game::kPlots> fans_{};
    std::array<FwRoomId, game::kHouses> rooms_{};
};

}  // namespace tower
