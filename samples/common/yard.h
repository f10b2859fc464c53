// A yard of wooden crates in rows, on any backend: what a server has to keep burning.
#pragma once
#include <flamewright/flamewright.h>
#include <cstdint>
#include <string>
#include <vector>

// Throws std::runtime_error with the library's message if the result is an error.
void check(FwResult result, FwWorld* world);

// An argument that is a whole number in [low, high]; throws std::runtime_error with its name
// otherwise.
uint32_t wholeOf(const std::string& name, const char* text, uint32_t low, uint32_t high);

struct Yard {
    std::vector<FwBurnableMeshId> crates;
    uint32_t columns = 0;
};

// Crates of half a metre, 0.9 m from middle to middle, on y = 0. Throws std::runtime_error with the
// library's message.
Yard makeYard(FwWorld* world, uint32_t crates);
// Where a crate stands: the middle of its foot, m.
void placeOf(const Yard& yard, uint32_t crate, float (&place)[3]);
// A match at a crate's foot.
void lightCrate(FwWorld* world, const Yard& yard, uint32_t crate);

struct YardState {
    uint32_t burning = 0, burnt = 0, plays = 0;  // crates
    float power = 0;                             // W
};
YardState stateOf(FwWorld* world, const Yard& yard);
// Of every texel of every crate, as each machine of a game must have it. On the cpu backend.
uint64_t hashOf(FwWorld* world, const Yard& yard);
