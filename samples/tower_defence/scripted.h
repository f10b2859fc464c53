// A whole game by the scripted player, without a picture.
#pragma once

#include <cstdint>

namespace tower {

struct ScriptedGame {
    uint32_t seed = 1;
    int32_t waves = 0;    // number of waves; 0: all
    bool server = false;  // uses the cpu backend, without a device
    bool rewind = false;  // rewinds ten seconds once, and continues
    float pace = 14;      // as FwWorldDef::paceFactor
};

// Prints one line: outcome, score, lives, waves, hash. All backends print the same line.
int playScripted(const ScriptedGame& wanted);

}  // namespace tower
