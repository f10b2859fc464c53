// Parts of saves: compressed planes that round-trip, archives that refuse damaged bytes, and a file
// that no killed process leaves half written.
#include "world/save.h"
#include "common/save_file.h"
#include "core/error.h"
#include "core/stream.h"
#include "fire/presets.h"
#include "gpu/cpu/cpu_backend.h"
#include "save/plane.h"
#include "support/meshes.h"
#include "support/world_defs.h"
#include "world/world.h"

#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <random>

namespace {

using namespace fw;
using Values = std::vector<uint32_t>;
using Mask = std::vector<uint8_t>;
using Bytes = std::pmr::vector<std::byte>;

Bytes written(const Values& values, uint32_t width, const Mask& mask) {
    Bytes bytes;
    save::writePlane(values, width, mask, bytes);
    return bytes;
}

double bitsOf(const Values& values, uint32_t width, const Mask& mask = {}) {
    const Bytes bytes = written(values, width, mask);
    Values back(values.size());
    EXPECT_TRUE(save::readPlane(bytes, width, mask, back));
    for (size_t i = 0; i < values.size(); ++i)
        if (mask.empty() || mask[i] != 0) {
            EXPECT_EQ(values[i], back[i]) << i;
            if (values[i] != back[i]) break;
        }
    return 8.0 * double(bytes.size()) / double(values.size());
}

TEST(PlaneCodec, RoundTrips) {
    std::mt19937 random(3);
    for (int turn = 0; turn < 200; ++turn) {
        const uint32_t width = 1 + random() % 40, height = 1 + random() % 40;
        Values values(size_t(width) * height);
        Mask mask(turn % 3 == 0 ? 0 : values.size());
        const uint32_t kind = random() % 5;
        const uint32_t spread = 1u << (random() % 32);
        for (size_t i = 0; i < values.size(); ++i) {
            if (!mask.empty()) mask[i] = random() % 4 != 0 ? 1 : 0;
            const auto x = uint32_t(i) % width, y = uint32_t(i) / width;
            values[i] = kind == 0   ? uint32_t(random())
                        : kind == 1 ? 5 * x + 900 * y + uint32_t(random() % spread)
                        : kind == 2 ? uint32_t(x > width / 2)
                        : kind == 3 ? 0xFFFFFFFFu - uint32_t(random() % 2)
                                    : 77u;
        }
        (void)bitsOf(values, width, mask);
    }
    EXPECT_EQ(0u, written({}, 1, {}).size());
}

TEST(PlaneCodec, CompressesUniformData) {
    const uint32_t side = 256;
    Values cone(side * side), still(side * side, 12345), half(side * side);
    for (uint32_t i = 0; i < side * side; ++i) {
        const double x = i % side - 40.0, y = i / side - 70.0, away = std::sqrt(x * x + y * y);
        cone[i] = uint32_t(away * 160);
        half[i] = away < 90 ? 1 : 0;
    }
    EXPECT_LT(bitsOf(cone, side), 2.5);  // of the 16 that each value has
    EXPECT_LT(bitsOf(still, side), 0.01);
    EXPECT_LT(bitsOf(half, side), 0.05);
}

TEST(PlaneCodec, DamagedDataEndsOrIsRefused) {
    std::mt19937 random(9);
    Values values(1000);
    for (uint32_t& value : values) value = uint32_t(random() % 3 == 0 ? random() : 4);
    const Bytes bytes = written(values, 25, {});
    uint32_t refused = 0;
    for (int turn = 0; turn < 500; ++turn) {
        Bytes wrong = bytes;
        wrong[random() % wrong.size()] ^= std::byte(1u << (random() % 8));
        if (turn % 2 == 0) wrong.resize(random() % wrong.size());
        Values back(values.size());
        refused += save::readPlane(wrong, 25, {}, back) ? 0 : 1;
    }
    EXPECT_GT(refused, 200u);
}

TEST(ArchiveReader, ChecksCountsAgainstRemainingBytes) {
    Bytes bytes;
    core::Writer writer(bytes);
    writer.number(uint32_t(0x01020304));
    writer.number(-1.5f);
    writer.number(true);
    EXPECT_EQ(std::byte(4), bytes[0]);  // little-endian
    core::Reader reader(bytes, "save");
    uint32_t word = 0;
    float real = 0;
    bool flag = false;
    reader.number(word), reader.number(real), reader.number(flag);
    EXPECT_EQ(0x01020304u, word);
    EXPECT_EQ(-1.5f, real);
    EXPECT_TRUE(flag);
    EXPECT_THROW(reader.number(word), core::Error);
    core::Reader again(bytes, "save");
    EXPECT_THROW((void)again.count("things", 1), core::Error);
}

// A world makes no events of texels that no triangle covers, since heat steps skip those.
TEST(SaveChecks, RefuseEventsOfUncoveredTexels) {
    std::pmr::memory_resource* memory = std::pmr::get_default_resource();
    core::Log log(FwCallbacks{});
    gpu::cpu::CpuBackend backend(memory, 4);
    world::World world(test::plainWorldDef(0), backend, log, memory);
    const test::Mesh plane = test::makePlane(0.5, 0.3);
    FwBurnableMeshDef object =
        test::plainBurnableDef(world.scene().createMesh(test::plainMeshDef(plane, 40)));
    object.materials[0] = world.scene().createMaterial(fire::presetDef(FW_MATERIAL_PAPER));
    object.transform[0] = object.transform[5] = object.transform[10] = object.transform[15] = 1;
    const mesh::BurnDomain& domain = world.scene().objectDomain(world.createBurnableMesh(object));
    FwIgnitionDef ball{};
    ball.kind = FW_WET;
    ball.delay = 3;
    EXPECT_LT(0u, world.burn().ignite(ball));
    world.persistence().requestSave();
    world.advance(1, 0);
    const Bytes* bytes = world.persistence().fetchSave();
    ASSERT_TRUE(bytes);
    EXPECT_NO_THROW(world.persistence().load(*bytes));
    uint32_t beside = 0;
    while (beside < domain.texelCount() && domain.real(beside)) ++beside;
    ASSERT_LT(beside, domain.texelCount());
    world::Snapshot saved(memory);
    world::readSnapshot(*bytes, saved);
    ASSERT_FALSE(saved.burn.pending.empty());
    saved.burn.pending[0].texel = beside;
    Bytes bent;
    world::writeSnapshot(saved, bent);
    EXPECT_THROW(world.persistence().load(bent), core::Error);
}

// A child replaces a file repeatedly; killed at any moment, it leaves the file whole.
TEST(SaveFile, AKilledWriterLeavesAWholeFile) {
    const auto path = std::filesystem::temp_directory_path() /
                      ("flamewright_save_" + std::to_string(getpid()) + ".fwsave");
    const auto content = [](uint32_t seed) {
        std::vector<std::byte> bytes(1 << 20, std::byte(seed));
        return bytes;
    };
    ASSERT_TRUE(sample::replaceFile(path, content(1)));
    for (uint32_t turn = 0; turn < 8; ++turn) {
        const pid_t child = fork();
        ASSERT_GE(child, 0);
        if (child == 0)
            for (uint32_t seed = 1;; ++seed) (void)sample::replaceFile(path, content(seed));
        usleep(3000 + 1777 * turn);
        kill(child, SIGKILL);
        int status = 0;
        ASSERT_EQ(child, waitpid(child, &status, 0));
        const std::vector<std::byte> bytes = sample::readWholeFile(path);
        ASSERT_EQ(size_t(1) << 20, bytes.size());
        EXPECT_TRUE(
            std::all_of(bytes.begin(), bytes.end(), [&](std::byte b) { return b == bytes[0]; }));
    }
    EXPECT_FALSE(sample::replaceFile(path / "no_folder", content(1)));
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
    std::filesystem::remove(path.string() + ".new", ignored);
}

}  // namespace
