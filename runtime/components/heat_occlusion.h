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

struct OcclusionGridShape {  // places of the cells; counts of 0: there is no grid
    std::array<uint32_t, 3> counts{};
    std::array<int32_t, 3> origin{};  // mm, low corner
    uint32_t cell = 0;                // mm
    [[nodiscard]] uint32_t cells() const noexcept { return counts[0] * counts[1] * counts[2]; }
    [[nodiscard]] uint32_t words() const noexcept { return (cells() + 31) / 32; }
    bool operator==(const OcclusionGridShape&) const = default;

    template <class A>
    void serialize(A& a) {
        a(counts, origin, cell);
        a.require(plausible(), "heat-occlusion grid");
    }
    [[nodiscard]] bool plausible() const noexcept;  // makeOcclusionGridShape may have made it
};

[[nodiscard]] uint32_t countsOf(
    const OcclusionGridShape& shape) noexcept;  // packed as in ExchangePush

struct OcclusionCell {  // a cell that an object fills
    uint32_t cell = 0;  // x runs fastest, then y, then z
    uint32_t what = 0;  // slot | material << 24 | kOcclusionPermanent
    uint32_t texel = 0;
    bool operator==(const OcclusionCell&) const = default;
};

struct HeatOcclusion {
    explicit HeatOcclusion(std::pmr::memory_resource* memory) : solid(memory), baked(memory) {}
    OcclusionGridShape shape;
    std::pmr::vector<uint32_t> solid;       // a bit per cell: the host's
    std::pmr::vector<OcclusionCell> baked;  // sorted by cell, one each

    template <class A>
    void serialize(A& a) {
        constexpr const char* kName = "heat-occlusion grid";
        a(shape);
        if constexpr (A::kReads) solid.assign(shape.words(), 0);
        if (shape.cells() == 0) return;
        const auto plane = [&](size_t count, uint32_t width, auto&& value) {
            a.plane(kName, count, width, {}, 0xFFFFFFFFu, value,
                    [&](size_t i, uint32_t read) { value(i) = read; });
        };
        plane(solid.size(), (shape.counts[0] + 31) / 32,
              [&](size_t i) -> uint32_t& { return solid[i]; });
        const uint32_t over = shape.cells() % 32;
        a.require(over == 0 || solid.back() >> over == 0, kName);
        auto count = uint32_t(baked.size());
        a(count);
        a.require(count <= gpu::kMaxBakedOcclusionCells, kName);
        if constexpr (A::kReads) baked.assign(count, {});
        if (count == 0) return;
        uint64_t before = 0;  // a cell is written as its distance from the one before
        a.plane(
            kName, count, count, {}, 0xFFFFFFFFu,
            [&](size_t i) { return baked[i].cell - (i != 0 ? baked[i - 1].cell : 0); },
            [&](size_t i, uint32_t step) {
                before += step;
                a.require(before < shape.cells() && (i == 0 || step != 0), kName);
                baked[i].cell = uint32_t(before);
            });
        plane(count, count, [&](size_t i) -> uint32_t& { return baked[i].what; });
        plane(count, count, [&](size_t i) -> uint32_t& { return baked[i].texel; });
    }
};

// Throw core::Error naming the field.
[[nodiscard]] OcclusionGridShape makeOcclusionGridShape(const FwHeatOcclusionDef& def);
// Calls the def's callback, which gets and gives units, for every cell, and reads its bytes.
void readOcclusionCells(const FwHeatOcclusionDef& def, const OcclusionGridShape& shape,
                        float unitsPerMetre, std::pmr::vector<uint32_t>& solid);

struct OcclusionObject {  // an object that fills cells
    uint32_t slot = 0;
    const mesh::BurnDomain* domain = nullptr;
    gpu::ExchangeObject place{};
    uint32_t texelSide = 0;  // mm
    uint32_t stays = 0;      // bit i: its material i never burns through
};
// The cells that the objects' texels reach into, each with the texel nearest to its middle.
// Replaces `out`. Throws if there are more than gpu::kMaxBakedOcclusionCells.
void bakeOcclusion(const OcclusionGridShape& shape, std::span<const OcclusionObject> objects,
                   std::pmr::vector<OcclusionCell>& out);

// Packs the grid for the backends.
void packOcclusion(const HeatOcclusion& grid, std::pmr::vector<uint32_t>& words);

// m along a ray until it enters a solid cell of the host from an open one, or `most`. A ray that
// begins in solid cells leaves them first.
[[nodiscard]] float sweepOcclusion(const HeatOcclusion& grid, const float from[3],
                                   const float direction[3], float most) noexcept;

struct OcclusionView {  // the packed grid, for cosmetic questions
    OcclusionGridShape shape;
    std::span<const uint32_t> words;  // packed; empty: there is no grid
    std::span<const uint8_t> fallen;  // by slot, 1: the object's cells have fallen
};
// Whether a cell lies between two places, further than `spare` m from the first.
[[nodiscard]] bool isShadedByOcclusion(const OcclusionView& grid, const float from[3],
                                       const float to[3], float spare) noexcept;

}  // namespace fw::components
