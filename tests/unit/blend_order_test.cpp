// The device or the host sorts blended draws.
#include "gpu/passes/blend_order.h"
#include "shared/appearance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace fw::test {
namespace {

using gpu::Orderer;
using gpu::PlacedBy;

TEST(BlendOrder, TheDeviceSortsItsOwnQuads) {
    for (const uint32_t hiding : {1u, 1000u, gpu::kMaxQuads})
        EXPECT_EQ(Orderer::Device, gpu::ordererOf(PlacedBy::Device, hiding));
}

TEST(BlendOrder, TheHostSortsItsOwnDraws) {
    for (const uint32_t hiding : {1u, 256u})
        EXPECT_EQ(Orderer::Host, gpu::ordererOf(PlacedBy::Host, hiding));
}

TEST(BlendOrder, AdditiveDrawsAreNotSorted) {
    EXPECT_EQ(Orderer::None, gpu::ordererOf(PlacedBy::Device, 0));
    EXPECT_EQ(Orderer::None, gpu::ordererOf(PlacedBy::Host, 0));
}

// On every device the sort's shared memory holds as many items as it compares.
TEST(BlendOrder, TheSortFitsInSharedMemory) {
    EXPECT_EQ(1024u, gpu::fewQuads(true));
    EXPECT_EQ(gpu::kMaxFewQuads, gpu::fewQuads(false));
    EXPECT_LE(gpu::fewQuads(true), gpu::kMaxFewQuads);
}

TEST(BlendOrder, SortsFarthestFirstThenByIndex) {
    struct Thing {
        float depth;
        uint32_t number;
    };
    std::array<Thing, 5> things{{{2, 4}, {7, 1}, {2, 0}, {-1, 2}, {7, 3}}};
    gpu::orderOnHost(
        std::span<Thing>(things), [](const Thing& t) { return t.depth; },
        [](const Thing& t) { return t.number; });
    const uint32_t expected[] = {1, 3, 0, 4, 2};
    for (size_t i = 0; i < things.size(); ++i) EXPECT_EQ(expected[i], things[i].number) << i;
}

}  // namespace
}  // namespace fw::test
