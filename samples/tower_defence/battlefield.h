// The village as a battlefield: where towers may stand, what marches, and the same as the rules
// see it. Knows neither fire nor a renderer.
#pragma once

#include <array>

#include "game/game.h"
#include "village/layout.h"

namespace tower {

// All that may ever show is an instance from the beginning: what shows and where is the game's.
struct Battlefield {
    village::Scene scene;
    game::Ground ground;
    std::array<std::array<size_t, game::kTowerKinds>, game::kPlots> towers{};  // by plot and kind:
    // instances; of kNone the empty plinth, on which the flamethrower stands
    std::array<size_t, game::kEnemySlots> enemies{};  // instances
    std::array<size_t, game::kHouses> houses{};
};

Battlefield makeBattlefield(uint32_t seed);
// One of those whose burning counts: with a room inside.
bool isHouse(int model);

// Where a plot is, m.
village::Vec2 metres(game::Point point);
// A marcher as it walks, bobbing; fallen: 0 upright .. 1 on the ground.
village::Frame enemyFrame(const game::Ground& ground, const game::Enemy& enemy, float size);
// Turned towards where it aims.
village::Frame towerFrame(game::Point plot, game::Point aim);

}  // namespace tower
