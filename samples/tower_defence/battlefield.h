// The village as a battlefield: plots for towers, enemies, and the same as the rules see it.
// Independent of fire and renderer.
#pragma once

#include <array>

#include "game/game.h"
#include "village/layout.h"

namespace tower {

// Every instance that may ever appear exists from the start. The game decides which ones show and
// where.
struct Battlefield {
    village::Scene scene;
    game::Ground ground;
    // Instances by plot and kind; for kNone the empty plinth, on which the flamethrower stands.
    std::array<std::array<size_t, game::kTowerKinds>, game::kPlots> towers{};
    std::array<size_t, game::kEnemySlots> enemies{};  // instances
    std::array<size_t, game::kHouses> houses{};
};

Battlefield makeBattlefield(uint32_t seed);
// Returns true for models with a compartment inside. Their burning counts in the score.
bool isHouse(int model);

// Returns the position of a plot, m.
village::Vec2 metres(game::Point point);
// Returns the frame of an enemy that walks with a bobbing step, or of one that lies on the ground.
village::Frame enemyFrame(const game::Ground& ground, const game::Enemy& enemy, float size);
// Returns the frame of a tower that faces its aim.
village::Frame towerFrame(game::Point plot, game::Point aim);

}  // namespace tower
