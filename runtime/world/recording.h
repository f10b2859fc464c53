// The part of a world that other machines have to know: the commands of its host, in order, and
// hashes of its objects at fixed steps. Kept while a server or a client (net/) asks for it.
#pragma once
#include "world/command.h"

namespace fw::world {

constexpr uint32_t kHashSteps = 8;    // an object's turn is at multiples of these
constexpr uint32_t kHashRounds = 16;  // each has its turn once in so many; in more, if it is more
constexpr uint32_t kMaxHashes = 64;   // of a round than these
constexpr uint32_t kHashTicks = kHashSteps * gpu::kStepTicks;

constexpr uint32_t kMaxBlocks = 100;  // of tiles, of an object: each has a hash

constexpr uint32_t hashRounds(uint32_t slots) noexcept {
    const uint32_t needed = (slots + kMaxHashes - 1) / kMaxHashes;
    return needed > kHashRounds ? needed : kHashRounds;
}

// Of an object's whole state: its ticks, and its heat where it has some.
uint64_t hashState(std::span<const uint32_t> ticks, std::span<const gpu::uvec2> heat) noexcept;

struct ObjectHash {
    uint32_t slot = 0, stride = 1;  // the next of its round is so many slots on
    uint64_t tick = 0, hash = 0;
};

struct Recording {
    explicit Recording(std::pmr::memory_resource* memory) : commands(memory), hashes(memory) {}
    struct Entry {
        uint64_t tick = 0;  // of the step that it came before
        Command command;
    };
    std::pmr::vector<Entry> commands;
    std::pmr::vector<ObjectHash> hashes;
    bool follows = false;     // another machine's commands alone count
    bool applies = false;     // one of them is being applied
    bool lost = false;        // memory ended, and with it the order of commands
    bool loaded = false;      // another past since
    uint64_t capturedAt = 0;  // tick of the last capture, and commands before it that wait here
    size_t capturedBehind = 0;
    bool captured = false;
    uint64_t until = 0;  // with `follows`: the tick that frames may come to
};

}  // namespace fw::world
