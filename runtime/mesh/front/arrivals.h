// When will the fire of an object reach what has not caught yet? The front kernel, run ahead on a
// copy of the object's state under a drive that stays as it is. In slices, so that a game's frame
// need not wait for it; the ticks that come out do not depend on how it is sliced. Not heat, nor
// what other objects do.
#pragma once
#include "mesh/front/tile.h"

#include <array>

namespace fw::mesh {

struct ArrivalInput {                    // of one object
    const BurnDomain* domain = nullptr;  // outlives the forecast
    std::span<const uint16_t> slowness;  // per texel; empty: the mesh's own. Outlives it too
    std::span<const gpu::BurnMaterial> materials;  // kMaterialsPerObject
    uint32_t window = 0;                           // correction window, ticks
    std::span<const uint32_t> state;               // per texel, as of `now`
    uint32_t now = 0;                              // tick
    bool parts = false;                            // fire crosses from part to part
};

struct Arrivals {
    explicit Arrivals(std::pmr::memory_resource* memory)
        : ticks(memory), wake(memory), flags(memory), list(memory), due(memory) {}

    const BurnDomain* domain = nullptr;
    std::span<const uint16_t> slowness;
    std::array<gpu::BurnMaterial, gpu::kMaterialsPerObject> materials{};
    std::pmr::vector<uint32_t> ticks;  // per texel, as its state: ignitions, those to come too
    // Per tile: as TileState's, and whether it is in `list`.
    std::pmr::vector<uint32_t> wake;
    std::pmr::vector<uint8_t> flags;
    std::pmr::vector<uint32_t> list, due;  // tiles; `due` are those of the round, from `next` on
    size_t next = 0;
    uint32_t window = 0, stride = 0;  // ticks
    uint32_t now = 0;                 // tick at which it begins
    uint32_t end = 0;                 // tick that the round works up to
    bool parts = false;
    bool whole = true;  // nothing more will catch

    // Ticks below this one stay as they are.
    [[nodiscard]] uint32_t settled() const noexcept;
};

// The memory that beginArrivals and all slices need for this mesh. Throws std::bad_alloc.
void reserveArrivals(Arrivals& arrivals, const BurnDomain& domain);
// Anew, from the state that it is given. Needs no memory after reserveArrivals.
void beginArrivals(Arrivals& arrivals, const ArrivalInput& input);
// Runs at most so many tiles, [1, ...); returns how many it did not use: 0 but when it is whole.
uint32_t runArrivals(Arrivals& arrivals, uint32_t tiles) noexcept;

}  // namespace fw::mesh
