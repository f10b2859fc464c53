// Invariants of every burn domain, and small tools to inspect one, for the mesh tests.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <utility>
#include <vector>

#include "core/error.h"
#include "mesh/bake.h"
#include "support/meshes.h"

namespace fw::test {

using mesh::BurnDomain;
using mesh::kNone;

inline BurnDomain bakeOf(const mesh::BakeInput& input) {
    try {
        return mesh::bake(input, std::pmr::new_delete_resource());
    } catch (const core::Error& error) {
        ADD_FAILURE() << error.message;
        return BurnDomain(std::pmr::new_delete_resource());
    }
}

// The message of a refused bake; "" if it succeeded.
inline std::string refusal(const mesh::BakeInput& input) {
    try {
        (void)mesh::bake(input, std::pmr::new_delete_resource());
    } catch (const core::Error& error) {
        return error.message;
    }
    return "";
}

inline uint32_t tileOf(const BurnDomain& d, uint32_t texel) {
    return texel / d.width / mesh::kTileSide * d.tilesX + texel % d.width / mesh::kTileSide;
}
inline uint32_t laneOf(const BurnDomain& d, uint32_t texel) {
    return texel / d.width % 8 * 8 + texel % d.width % 8;
}
inline bool isRim(const BurnDomain& d, uint32_t texel) {
    return (d.texels[texel].materialFlags & mesh::kTexelRim) != 0;
}

// The neighbour that a texel reads in ring direction k, found as the simulation does.
inline uint32_t ringOf(const BurnDomain& d, uint32_t texel, uint32_t k) {
    const mesh::TileStatic& tile = d.tiles[tileOf(d, texel)];
    const uint64_t rim = tile.rimMask;
    const uint32_t lane = laneOf(d, texel);
    if ((rim >> lane & 1) == 0)
        return uint32_t(int(texel) + mesh::kRingY[k] * int(d.width) + mesh::kRingX[k]);
    const uint64_t below = rim & ((uint64_t(1) << lane) - 1);
    const uint32_t record = tile.rimBase + uint32_t(__builtin_popcountll(below));
    return d.links[size_t(record) * 8 + k];
}

inline double linkUnits(const BurnDomain& d, uint32_t a, uint32_t b) {
    const double x = double(d.texels[a].x) - d.texels[b].x;
    const double y = double(d.texels[a].y) - d.texels[b].y;
    const double z = double(d.texels[a].z) - d.texels[b].z;
    return std::sqrt(x * x + y * y + z * z);
}
inline double linkMetres(const BurnDomain& d, uint32_t a, uint32_t b) {
    return linkUnits(d, a, b) * double(d.quantum);
}

// Invariants of burn_domain.h. Counts violations so that a broken bake prints one line per kind.
inline void expectSound(const BurnDomain& d) {
    ASSERT_GT(d.texelCount(), 0u);
    ASSERT_EQ(0u, d.width % 8 + d.height % 8);
    ASSERT_EQ(d.texelCount(), d.texels.size());
    ASSERT_EQ(d.texelCount(), d.slowness.size());
    ASSERT_EQ(d.texelCount(), d.thickness.size());
    ASSERT_EQ(d.tileCount(), d.tiles.size());
    ASSERT_EQ(d.tileCount(), d.tileBounds.size());
    ASSERT_EQ(0u, d.links.size() % 8);
    uint32_t real = 0, badFlags = 0, badRing = 0, unread = 0, longLinks = 0, outside = 0;
    std::set<std::pair<uint32_t, uint32_t>> reads;
    std::vector<uint64_t> seam(d.tileCount(), 0);
    double area = 0;
    for (uint32_t i = 0; i < d.texelCount(); ++i) {
        const uint32_t t = tileOf(d, i), flags = d.texels[i].materialFlags;
        const uint64_t rim = d.tiles[t].rimMask;
        badFlags += ((rim >> laneOf(d, i) & 1) != 0) != isRim(d, i);
        badFlags += (d.slowness[i] != 0) != d.real(i);
        badFlags += (d.triangleOf[i] != kNone) != d.real(i);
        badFlags += !d.real(i) && flags != 0;
        if (!d.real(i)) {
            badFlags += d.areas[i] != 0;
            continue;
        }
        ++real;
        area += double(d.areas[i]);
        badFlags += (flags & 0xFF) >= d.materialCount || d.triangleOf[i] >= d.indices.size() / 3;
        const uint16_t at[3] = {d.texels[i].x, d.texels[i].y, d.texels[i].z};
        for (int k = 0; k < 3; ++k)
            outside += at[k] < d.tileBounds[t].low[k] || at[k] > d.tileBounds[t].high[k];
        const uint32_t x = i % d.width, y = i / d.width;
        if (!isRim(d, i) && (x == 0 || y == 0 || x + 1 == d.width || y + 1 == d.height)) {
            ++badRing;
            continue;
        }
        for (uint32_t k = 0; k < 8; ++k) {
            const uint32_t j = ringOf(d, i, k);
            if (j == kNone && isRim(d, i)) continue;
            if (j >= d.texelCount() || !d.real(j) || j == i) {
                ++badRing;
                continue;
            }
            longLinks += linkUnits(d, i, j) >= 8191 ||
                         linkMetres(d, i, j) > double(d.linkMax + 2 * d.quantum);
            if (!isRim(d, i) || tileOf(d, j) == t) continue;
            reads.insert({tileOf(d, j), t});
            seam[tileOf(d, j)] |= uint64_t(1) << laneOf(d, j);
        }
    }
    size_t listed = 0;
    for (uint32_t t = 0; t < d.tileCount(); ++t) {
        const mesh::TileStatic& tile = d.tiles[t];
        ASSERT_LE(size_t(tile.dependentStart) + tile.dependentCount, d.dependents.size());
        listed += tile.dependentCount;
        for (uint32_t r = 0; r < tile.dependentCount; ++r)
            unread += reads.count({t, d.dependents[tile.dependentStart + r]}) == 0;
        unread += tile.seamMask != seam[t];
    }
    EXPECT_EQ(reads.size(), listed) << "dependent tiles by links, and those listed";
    EXPECT_EQ(0u, unread) << "dependent tiles or seam masks without a link";
    EXPECT_EQ(0u, badFlags);
    EXPECT_EQ(0u, badRing);
    EXPECT_EQ(0u, longLinks);
    EXPECT_EQ(0u, outside) << "texels outside their tile's bounds";
    EXPECT_EQ(d.report.realTexels, real);
    EXPECT_NEAR(d.report.meshArea, area, 1e-4 * d.report.meshArea);
    for (uint32_t index : d.indices) ASSERT_LT(index, d.vertices.size());
}

// Texels that a fire lit at `seed` never reaches.
inline uint32_t neverReached(const BurnDomain& d, uint32_t seed) {
    std::vector<std::vector<uint32_t>> heardBy(d.texelCount());
    uint32_t left = 0;
    for (uint32_t i = 0; i < d.texelCount(); ++i)
        if (d.real(i)) {
            ++left;
            for (uint32_t k = 0; k < 8; ++k)
                if (const uint32_t j = ringOf(d, i, k); j != kNone) heardBy[j].push_back(i);
        }
    std::vector<uint8_t> lit(d.texelCount(), 0);
    std::vector<uint32_t> queue{seed};
    lit[seed] = 1;
    for (size_t head = 0; head < queue.size(); ++head)
        for (uint32_t i : heardBy[queue[head]])
            if (!lit[i]) {
                lit[i] = 1;
                queue.push_back(i);
            }
    return left - uint32_t(queue.size());
}
inline uint32_t firstReal(const BurnDomain& d) {
    uint32_t i = 0;
    while (i < d.texelCount() && !d.real(i)) ++i;
    return i;
}

// Loads a mesh of FLAMEWRIGHT_ASSETS or skips the test with a message.
#define FW_LOAD_OR_SKIP(mesh, name)                                           \
    do {                                                                      \
        std::string reason;                                                   \
        if (!::fw::test::loadGlb(name, mesh, reason)) GTEST_SKIP() << reason; \
    } while (false)

}  // namespace fw::test
