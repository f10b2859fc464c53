// A player who follows a plan, for unattended games and tests.
#pragma once

#include "game.h"

namespace game {

// Returns the next order, or one of type kNone to wait. Depends on the state only.
Order botsOrder(const State& state);

// Returns a game in progress: its towers stand, and the fourth wave is on the road.
State gameInProgress(const Ground& ground, uint32_t seed);

}  // namespace game
