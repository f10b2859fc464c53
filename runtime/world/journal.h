// What other machines have to know of a world: what its host did to the burn, in order, and hashes
// of its objects at fixed steps. Kept while someone asks for it (net/), and taken from there.
#pragma once
#include "flamewright/flamewright.h"
#include "shared/burn.h"

#include <array>
#include <cstdint>
#include <iterator>
#include <memory_resource>
#include <span>
#include <vector>

namespace fw::world {

// A call of the host's that changes what burns. What it makes and destroys is none: each host does
// that by itself.
struct Deed {
    enum class Kind : uint8_t {
        wind,
        flags,
        ignite,
        pose,
        moveBlocker,
        moveFire,
        firePower,
        moveEmitter,
        emitterPower,
        moveField,
        fieldAmount,
        windZone,
        room,
        playBurn,
        stopBurn,
        windGrid,
        windPoints,
        gusts,
        heatShield,
        shieldCells,
        shieldObject,
        shiftOrigin,
        transferBurn,
        count
    };
    Kind kind = Kind::count;
    uint32_t slot = 0;  // of whom; ignite: slot + 1 of the object, 0: all; windPoints: the first;
                        // shieldCells: which 288 of them; shieldObject: slot + 1, 0: none
    uint32_t tick = 0;  // ignite, playBurn: when it takes effect
    uint32_t word = 0;  // flags; ignite: FwIgnitionKind; moveEmitter: 1: with a direction;
                        // windZone, room, windGrid, heatShield: what of a def is no float, see
                        // deedOf; shieldObject: 1: the last one
                        // playBurn: slot + 1 of the burn
                        // transferBurn: slot + 1 of whose burn it is
    std::array<float, 13> numbers{};
};

// What of a deed its kind has, in bytes. `s` is a core::Writer, or a core::Reader of a known kind.
struct DeedForm {
    bool slot, tick, word;
    uint32_t numbers;
};
constexpr DeedForm kDeedForms[] = {
    {false, false, false, 3},  // wind
    {false, false, true, 0},   // flags
    {true, true, true, 5},     // ignite
    {true, false, false, 12},  // pose
    {true, false, false, 12},  // moveBlocker
    {true, false, false, 3},   // moveFire
    {true, false, false, 1},   // firePower
    {true, false, true, 6},    // moveEmitter
    {true, false, false, 1},   // emitterPower
    {true, false, true, 7},    // moveField
    {true, false, false, 1},   // fieldAmount
    {true, false, true, 11},   // windZone
    {true, false, true, 13},   // room
    {true, true, true, 1},     // playBurn
    {true, false, false, 0},   // stopBurn
    {false, false, true, 5},   // windGrid
    {true, false, false, 12},  // windPoints
    {false, false, false, 2},  // gusts
    {false, false, true, 4},   // heatShield
    {true, false, false, 12},  // shieldCells
    {true, false, true, 0},    // shieldObject
    {false, false, false, 3},  // shiftOrigin
    {true, false, true, 0},    // transferBurn
};
static_assert(std::size(kDeedForms) == size_t(Deed::Kind::count));
template <class S, class T>
void putDeed(S& s, T& deed) {
    const DeedForm& form = kDeedForms[size_t(deed.kind)];
    if (form.slot) s.number(deed.slot);
    if (form.tick) s.number(deed.tick);
    if (form.word) s.number(deed.word);
    for (uint32_t i = 0; i < form.numbers; ++i) s.number(deed.numbers[i]);
}

// A def as a deed's word and numbers, and back. Its kind and slot are others' business.
[[nodiscard]] Deed deedOf(const FwWindZoneDef& def) noexcept;
[[nodiscard]] Deed deedOf(const FwRoomDef& def) noexcept;
[[nodiscard]] Deed deedOf(const FwWindGridDef& def) noexcept;    // without its points
[[nodiscard]] Deed deedOf(const FwHeatShieldDef& def) noexcept;  // without its cells and objects
[[nodiscard]] FwHeatShieldDef heatShieldDefOf(const Deed& deed) noexcept;
[[nodiscard]] FwWindZoneDef windZoneDefOf(const Deed& deed) noexcept;
[[nodiscard]] FwRoomDef roomDefOf(const Deed& deed) noexcept;
[[nodiscard]] FwWindGridDef windGridDefOf(const Deed& deed) noexcept;

constexpr uint32_t kHashSteps = 8;    // an object's turn is at multiples of these
constexpr uint32_t kHashRounds = 16;  // each has its turn once in so many; in more, if it is more
constexpr uint32_t kMostHashes = 64;  // of a round than these
constexpr uint32_t kHashTicks = kHashSteps * gpu::kStepTicks;

constexpr uint32_t kMostBlocks = 100;  // of tiles, of an object: each has a hash

constexpr uint32_t hashRounds(uint32_t slots) noexcept {
    const uint32_t needed = (slots + kMostHashes - 1) / kMostHashes;
    return needed > kHashRounds ? needed : kHashRounds;
}

// Of an object's whole state: its ticks, and its heat where it has some.
uint64_t hashState(std::span<const uint32_t> ticks, std::span<const gpu::uvec2> heat) noexcept;

struct ObjectHash {
    uint32_t slot = 0, stride = 1;  // the next of its round is so many slots on
    uint64_t tick = 0, hash = 0;
};

struct Journal {
    explicit Journal(std::pmr::memory_resource* memory) : deeds(memory), hashes(memory) {}
    struct Entry {
        uint64_t tick = 0;  // of the step that it came before
        Deed deed;
    };
    std::pmr::vector<Entry> deeds;
    std::pmr::vector<ObjectHash> hashes;
    bool follows = false;     // another machine's deeds alone count
    bool performs = false;    // one of them is being done
    bool lost = false;        // memory ended, and with it the order of deeds
    bool loaded = false;      // another past since
    uint64_t capturedAt = 0;  // tick of the last capture, and deeds before it that wait here
    size_t capturedBehind = 0;
    bool captured = false;
    uint64_t until = 0;  // with `follows`: the tick that frames may come to
};

}  // namespace fw::world
