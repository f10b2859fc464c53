// Forecast of ignition times within one object: the front kernel runs ahead on a copy of the
// object's state with today's materials and wind. It runs in slices across frames; the ticks do not
// depend on the slicing. Ignores heat and other objects.
#pragma once
#include "mesh/front/tile.h"

#include <array>

namespace fw::mesh {

struct ArrivalInput {                    // of one object
    const BurnDomain* domain = nullptr;  // outlives the forecast
    std::span<const uint16_t> slowness;  // per texel; empty: the mesh's own. Outlives the forecast
    std::span<const gpu::BurnMaterial> materials;  // kMaterialsPerObject
    uint32_t window = 0;                           // correction window, ticks
    std::span<const uint32_t> state;               // per texel, as of `now`
    uint32_t now = 0;                              // tick
    bool parts = false;                            // fire crosses from part to part
};

struct Arrivals {
    explicit Arrivals(std::pmr::memory_resource* of) : memory(of) {}

    std::pmr::memory_resource* memory;
    const BurnDomain* domain = nullptr;
    std::span<const uint16_t> slowness;
    std::array<gpu::BurnMaterial, gpu::kMaterialsPerObject> materials{};
    std::pmr::vector<uint32_t> ticks{memory};  // per texel, as its state: past and future ignitions
    // Per tile: as TileState::wake, and whether `list` holds it.
    std::pmr::vector<uint32_t> wake{memory};
    std::pmr::vector<uint8_t> flags{memory};
    // Tiles; `due`: those of this round, run up to `next`.
    std::pmr::vector<uint32_t> list{memory}, due{memory};
    size_t next = 0;
    uint32_t window = 0, stride = 0;  // ticks
    uint32_t now = 0;                 // first tick of the forecast
    uint32_t end = 0;                 // last tick of the round
    bool parts = false;
    bool whole = true;  // complete: nothing more will ignite

    // Ticks below this one are final.
    [[nodiscard]] uint32_t settled() const noexcept;
};

// Reserves the memory of beginArrivals and all slices for this mesh. Throws std::bad_alloc.
void reserveArrivals(Arrivals& arrivals, const BurnDomain& domain);
// Restarts the forecast from a state. Needs no memory after reserveArrivals.
void beginArrivals(Arrivals& arrivals, const ArrivalInput& input);
// Runs at most `tiles` tiles, >= 1. Returns the unused rest: 0 unless the forecast is complete.
uint32_t runArrivals(Arrivals& arrivals, uint32_t tiles) noexcept;

}  // namespace fw::mesh
