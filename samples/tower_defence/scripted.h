// A whole game by the scripted player, with nobody watching.
#pragma once

#include <cstdint>

namespace tower {

struct ScriptedGame {
    uint32_t seed = 1;
    int32_t waves = 0;    // ends after so many; 0: all
    bool server = false;  // on the cpu backend, without a device
    bool rewind = false;  // goes ten seconds back once, and plays on
    float pace = 14;      // as FwWorldDef::paceFactor
};

// Prints one line: outcome, score, lives, waves, hash. The line is the same on every backend.
int playScripted(const ScriptedGame& wanted);

}  // namespace tower
