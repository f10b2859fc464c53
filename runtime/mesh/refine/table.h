// The table of refinement: 3.2 KB of tokens from which shaders/shared/refine.h reads the k-th
// triangle of any pattern. Made by the compiler; devices receive it unchanged, two tokens per word.
#pragma once
#include "core/assert.h"
#include "shared/refine.h"

#include <array>

namespace fw::mesh {

using RefineTable = std::array<uint16_t, gpu::kRefineTableSize>;

namespace detail {

// Strip between an edge of 2^l segments and the lattice's row beside it: the side whose next vertex
// comes first advances. Edge vertex i lies at i * 2^m / 2^l, row vertex j at j + 1/2; the edge wins
// ties.
constexpr uint32_t fillStrip(RefineTable& table, uint32_t at, uint32_t l, uint32_t m) {
    const uint32_t n = 1u << m, steps = 1u << l;
    uint32_t i = 0, j = 1;
    while (i < steps || j < n - 2) {
        const bool edge = j >= n - 2 || (i < steps && 2 * n * (i + 1) <= steps * (2 * j + 3));
        table[at++] = uint16_t(gpu::refineStripToken(edge ? 0 : 1, i, j));
        ++(edge ? i : j);
    }
    return at;
}

constexpr uint32_t fillLattice(RefineTable& table, uint32_t at, uint32_t m) {
    const uint32_t side = (1u << m) - 3;
    for (uint32_t b = 0; b < side; ++b)
        for (uint32_t a = 0; a + b < side; ++a) {
            table[at++] = uint16_t(gpu::refineInnerToken(0, a, b));
            if (a + b + 1 < side) table[at++] = uint16_t(gpu::refineInnerToken(1, a, b));
        }
    return at;
}

// m < 2, by the mask of split sides. Corner k is vertex k, the middle of side k is 3 + k.
constexpr void fillHand(RefineTable& table, uint32_t at) {
    const auto put = [&](uint32_t mask, uint32_t k, uint32_t a, uint32_t b, uint32_t c) {
        table[at + mask * 4 + k] = uint16_t(a | b << 3 | c << 6);
    };
    put(0, 0, 0, 1, 2);
    for (uint32_t k = 0; k < 3; ++k) {
        const uint32_t f = (k + 1) % 3, g = (k + 2) % 3;
        const uint32_t one = 1u << k, two = 7u & ~one;  // only side k is split; all but side k
        put(one, 0, k, 3 + k, g);
        put(one, 1, 3 + k, f, g);
        put(two, 0, 3 + f, g, 3 + g);
        put(two, 1, k, f, 3 + f);
        put(two, 2, k, 3 + f, 3 + g);
        put(7, k, 3 + g, k, 3 + k);
    }
    put(7, 3, 3, 4, 5);
}

constexpr RefineTable makeRefineTable() {
    RefineTable table{};
    uint32_t at = 0;
    for (uint32_t m = 2; m <= gpu::kRefineDepth; ++m)
        for (uint32_t l = 0; l <= gpu::kRefineDepth; ++l) at = fillStrip(table, at, l, m);
    for (uint32_t m = 2; m <= gpu::kRefineDepth; ++m) at = fillLattice(table, at, m);
    fillHand(table, at);
    return table;
}

}  // namespace detail

inline constexpr RefineTable kRefineTable = detail::makeRefineTable();

// Codes of the k-th triangle of the pattern with these levels.
inline glm::uvec3 refineTriangle(uint32_t levels, uint32_t k) {
    const gpu::RefinePlace place = gpu::refineLocate(levels, k);
    FW_ASSERT(place.entry < kRefineTable.size(), "entry %u", place.entry);
    return gpu::refineCodes(levels, place, kRefineTable[place.entry]);
}

}  // namespace fw::mesh
