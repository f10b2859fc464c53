// A player who follows a plan: for whole games without hands, and for the tests.
#pragma once

#include "game.h"

namespace game {

// What it would do now; of type kNone: wait. Looks at nothing but the state.
Order botsOrder(const State& state);

// A game in the middle of it: its towers stand, and the fourth wave is on the road.
State underWay(const Ground& ground, uint32_t seed);

}  // namespace game
