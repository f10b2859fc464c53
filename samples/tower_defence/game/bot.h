// A player who follows a plan: for whole games without hands, and for the tests.
#pragma once

#include "game.h"

namespace game {

// What it would do now; of type kNone: wait. Looks at nothing but the state.
Order botsOrder(const State& state);

}  // namespace game
