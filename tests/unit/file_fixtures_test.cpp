// Files of tests/fixtures load and hold the values with which they were written.
#include "core/hash.h"
#include "flipbook/flipbook.h"
#include "mesh/bake.h"
#include "support/paths.h"
#include "volume/profile.h"
#include "world/played.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace {

using namespace fw;

std::vector<std::byte> contentOf(const char* name) {
    const auto path = std::filesystem::path(fw::test::kTestFolder) / "fixtures" / name;
    std::ifstream file(path, std::ios::binary);
    std::vector<std::byte> bytes(std::filesystem::file_size(path));
    file.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size()));
    EXPECT_TRUE(file.good()) << path;
    return bytes;
}

TEST(FileFixtures, FireProfileLoads) {
    volume::Profile profile;
    volume::readProfile(contentOf("campfire.fwprofile"), profile);
    const gpu::vec2 base = profile.sample(0, 0);
    EXPECT_FLOAT_EQ(1.671875f, base.x);
    EXPECT_FLOAT_EQ(0.00189208984375f, base.y);
    EXPECT_EQ(1570069901u, uint32_t(core::hashWords(profile.texels)));
}

TEST(FileFixtures, FlipbookLoads) {
    flipbook::Flipbook book(std::pmr::get_default_resource());
    flipbook::readFlipbook(contentOf("small.fwbook"), book);
    EXPECT_EQ(flipbook::Kind::Fire, book.facts.kind);
    EXPECT_EQ(1u, book.facts.loops);
    EXPECT_EQ(16u, book.facts.width);
    EXPECT_EQ(4u, book.facts.frames);
    EXPECT_FLOAT_EQ(2.0f, book.facts.seconds);
    const size_t middle = 4 * (8 * 16 + 8);
    EXPECT_EQ(171, book.texels[middle]);
    EXPECT_EQ(69, book.texels[middle + 3]);
}

TEST(FileFixtures, CookedMeshAndItsBakedBurnLoad) {
    const auto cooked = contentOf("box.fwburn");
    const mesh::BurnDomain domain = mesh::readCooked(cooked, std::pmr::get_default_resource());
    EXPECT_EQ(64u, domain.width);
    EXPECT_EQ(16u, domain.height);
    uint32_t real = 0;
    for (uint32_t i = 0; i < domain.texelCount(); ++i) real += domain.real(i) ? 1 : 0;
    EXPECT_EQ(600u, real);
    world::Burn burn(std::pmr::get_default_resource());
    world::readBurn(contentOf("box_baked.fwburn"), burn);
    EXPECT_EQ(7935894202736001262u, burn.hash);
    EXPECT_EQ(14051199178258026891u, burn.mesh);
    EXPECT_EQ(domain.width, burn.width);
    EXPECT_EQ(domain.height, burn.height);
    ASSERT_FALSE(burn.order.empty());
    EXPECT_EQ(0u, burn.ticks[burn.order.front()]);
}

}  // namespace
