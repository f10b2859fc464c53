// A yard of wooden crates in rows, for any backend. The server samples burn it.
#pragma once
#include <flamewright/flamewright.h>
#include <cstdint>
#include <string>
#include <vector>

// Throws std::runtime_error with the library's message if the result is an error.
void check(FwResult result, FwWorld* world);

// Parses a whole number in [low, high]. Otherwise throws std::runtime_error with the argument's
// name.
uint32_t wholeOf(const std::string& name, const char* text, uint32_t low, uint32_t high);

struct Yard {
    std::vector<FwBurnableMeshId> crates;
    uint32_t columns = 0;
};

// Creates 0.5 m crates on y = 0, 0.9 m apart from centre to centre. Throws std::runtime_error with
// the library's message.
Yard makeYard(FwWorld* world, uint32_t crates);
// Returns the centre of a crate's base, m.
void placeOf(const Yard& yard, uint32_t crate, float (&place)[3]);
// Ignites a crate at its base.
void lightCrate(FwWorld* world, const Yard& yard, uint32_t crate);

struct YardState {
    uint32_t burning = 0, burnt = 0, plays = 0;  // crates
    float power = 0;                             // W
};
YardState stateOf(FwWorld* world, const Yard& yard);
// Hashes every texel of every crate. All machines of a game must agree on it. Cpu backend only.
uint64_t hashOf(FwWorld* world, const Yard& yard);
