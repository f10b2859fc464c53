// Heat-occlusion grid: solid cells that stop heat between objects, the host's own and those that
// objects fill. Integers once the def is read. shared/exchange.h walks rays through the grid; the
// backends decide whether an object's cell still stands.
#pragma once
#include "flamewright/flamewright.h"
#include "mesh/burn_domain.h"
#include "shared/exchange.h"

#include <array>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace fw::components {

struct ShieldShape {  // places of the cells; counts of 0: there is no grid
    std::array<uint32_t, 3> counts{};
    std::array<int32_t, 3> origin{};  // mm, low corner
    uint32_t cell = 0;                // mm
    [[nodiscard]] uint32_t cells() const noexcept { return counts[0] * counts[1] * counts[2]; }
    [[nodiscard]] uint32_t words() const noexcept { return (cells() + 31) / 32; }
    bool operator==(const ShieldShape&) const = default;
};

[[nodiscard]] uint32_t countsOf(const ShieldShape& shape) noexcept;  // packed as in ExchangePush

struct ShieldCell {     // a cell that an object fills
    uint32_t cell = 0;  // x runs fastest, then y, then z
    uint32_t what = 0;  // slot | material << 24 | kShieldStays
    uint32_t texel = 0;
    bool operator==(const ShieldCell&) const = default;
};

struct HeatShield {
    explicit HeatShield(std::pmr::memory_resource* memory) : solid(memory), baked(memory) {}
    ShieldShape shape;
    std::pmr::vector<uint32_t> solid;    // a bit per cell: the host's
    std::pmr::vector<ShieldCell> baked;  // sorted by cell, one each
};

// Throw core::Error naming the field.
[[nodiscard]] ShieldShape makeShieldShape(const FwHeatShieldDef& def);
// Calls the def's callback for every cell, and reads its bytes.
void readShieldCells(const FwHeatShieldDef& def, const ShieldShape& shape,
                     std::pmr::vector<uint32_t>& solid);

// Whether makeShieldShape may have made it.
[[nodiscard]] bool plausible(const ShieldShape& shape) noexcept;

struct ShieldObject {  // an object that fills cells
    uint32_t slot = 0;
    const mesh::BurnDomain* domain = nullptr;
    gpu::RemoteObject place{};
    uint32_t texelSide = 0;  // mm
    uint32_t stays = 0;      // bit i: its material i never burns through
};
// The cells that the objects' texels reach into, each with the texel nearest to its middle.
// Replaces `out`. Throws if there are more than gpu::kShieldBaked.
void bakeShield(const ShieldShape& shape, std::span<const ShieldObject> objects,
                std::pmr::vector<ShieldCell>& out);

// Packs the grid for the backends.
void packShield(const HeatShield& shield, std::pmr::vector<uint32_t>& words);

// m along a ray until it enters a solid cell of the host from an open one, or `most`. A ray that
// begins in solid cells leaves them first.
[[nodiscard]] float sweepShield(const HeatShield& shield, const float from[3],
                                const float direction[3], float most) noexcept;

struct ShieldView {  // the packed grid, for cosmetic questions
    ShieldShape shape;
    std::span<const uint32_t> words;  // packed; empty: there is no grid
    std::span<const uint8_t> fallen;  // by slot, 1: the object's cells have fallen
};
// Whether a cell lies between two places, further than `spare` m from the first.
[[nodiscard]] bool shieldShades(const ShieldView& shield, const float from[3], const float to[3],
                                float spare) noexcept;

}  // namespace fw::components
