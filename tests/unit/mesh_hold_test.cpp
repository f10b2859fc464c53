// Support of parts: boards cut through, cylinders cut around across their charts, separate pieces.
#include "mesh/bake.h"
#include "mesh/hold.h"
#include "support/meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

namespace fw::test::mesh_hold_test {
namespace {

struct Held {
    explicit Held(const Mesh& mesh, double texels = 64)
        : domain(mesh::bake(mesh.input(texels), std::pmr::get_default_resource())) {
        mesh::findPieces(domain, {}, pieces);
        mesh::reserveHold(domain, pieces, scratch);
    }
    [[nodiscard]] std::array<double, 3> place(uint32_t i) const {
        const mesh::TexelPosition& p = domain.texels[i];
        const double q = double(domain.quantum);
        return {double(domain.origin[0]) + q * p.x, double(domain.origin[1]) + q * p.y,
                double(domain.origin[2]) + q * p.z};
    }
    // Texels of unsupported parts, where `gone` says what has burnt.
    std::vector<size_t> lost(const std::function<bool(double, double, double)>& gone,
                             const int32_t (&up)[3]) {
        scratch.marks.assign(domain.texelCount(), 0);
        for (uint32_t i = 0; i < domain.texelCount(); ++i) {
            if (!domain.real(i)) continue;
            const auto [x, y, z] = place(i);
            if (!gone(x, y, z)) scratch.marks[i] = mesh::kHoldStands;
        }
        const auto reach = int64_t(2048 * domain.texelSide / domain.quantum);
        mesh::markFeet(domain, pieces, up, reach, scratch);
        mesh::markHeld(domain, scratch);
        std::vector<size_t> made;
        for (uint32_t from = 0; mesh::nextLost(domain, from, scratch);) {
            EXPECT_TRUE(std::none_of(scratch.lost.begin(), scratch.lost.end(), [&](uint32_t i) {
                return gone(place(i)[0], place(i)[1], place(i)[2]);
            }));
            made.push_back(scratch.lost.size());
        }
        return made;
    }

    mesh::BurnDomain domain;
    mesh::Pieces pieces{std::pmr::get_default_resource()};
    mesh::HoldScratch scratch{std::pmr::get_default_resource()};
};

constexpr int32_t kUp[3] = {0, 1024, 0}, kDown[3] = {0, -1024, 0};

TEST(MeshHold, CutOffPartsAreLost) {
    Held board(makeSheet(1, 4));
    EXPECT_EQ(1u, board.pieces.count);
    const double texels = board.domain.report.realTexels;
    const auto nothing = [](double, double, double) { return false; };
    EXPECT_TRUE(board.lost(nothing, kUp).empty());
    const auto through = [](double, double y, double) { return y > 0.6 && y < 0.7; };
    const std::vector<size_t> above = board.lost(through, kUp);
    ASSERT_EQ(1u, above.size());
    EXPECT_NEAR(0.3 * texels, double(above[0]), 0.03 * texels);
    const std::vector<size_t> below = board.lost(through, kDown);  // it hangs from its top
    ASSERT_EQ(1u, below.size());
    EXPECT_NEAR(0.6 * texels, double(below[0]), 0.03 * texels);
    const auto nearly = [](double x, double y, double) { return y > 0.6 && y < 0.7 && x > 0.05; };
    EXPECT_TRUE(board.lost(nearly, kUp).empty());
    const auto twice = [](double x, double y, double) {
        return (y > 0.2 && y < 0.3) || (y > 0.6 && y < 0.7) || (y > 0.65 && x > 0.45 && x < 0.55);
    };
    const std::vector<size_t> parts = board.lost(twice, kUp);
    ASSERT_EQ(3u, parts.size());
    EXPECT_NEAR((0.3 + 2 * 0.3 * 0.45) * texels, double(parts[0] + parts[1] + parts[2]),
                0.05 * texels);
    const auto feet = [](double, double y, double) { return y < 0.1; };
    ASSERT_EQ(1u, board.lost(feet, kUp).size());
    EXPECT_TRUE(board.lost(feet, kDown).empty());
}

TEST(MeshHold, ChartsSupportEachOtherAcrossSeams) {
    for (const bool turned : {false, true}) {
        Held ring(makeCylinder(0.3, 1, 24, 8, 5, turned));
        EXPECT_EQ(1u, ring.pieces.count);
        const auto around = [](double, double y, double) { return std::abs(y - 0.5) < 0.06; };
        ASSERT_EQ(1u, ring.lost(around, kUp).size());
        const auto half = [](double x, double y, double) {
            return x < 0.1 && std::abs(y - 0.5) < 0.06;
        };
        EXPECT_TRUE(ring.lost(half, kUp).empty());
    }
}

TEST(MeshHold, PiecesAreSupportedIndependently) {
    Mesh mesh = makeSheet(1, 2);
    const Mesh upper = makeSheet(0.5, 2);
    const uint32_t first = mesh.vertexCount();
    for (uint32_t i = 0; i < upper.vertexCount(); ++i)
        mesh.addVertex(double(upper.positions[3 * i]), double(upper.positions[3 * i + 1]) + 2, 0);
    for (uint32_t i = 0; i < upper.triangleCount(); ++i)
        mesh.addTriangle(first + upper.indices[3 * i], first + upper.indices[3 * i + 1],
                         first + upper.indices[3 * i + 2]);
    mesh.uvs.clear();
    mesh.normals.clear();
    Held both(mesh);
    EXPECT_EQ(2u, both.pieces.count);
    EXPECT_TRUE(both.lost([](double, double, double) { return false; }, kUp).empty());
    EXPECT_EQ(1u, both.lost([](double, double y, double) { return y > 2 && y < 2.1; }, kUp).size());
}

}  // namespace
}  // namespace fw::test::mesh_hold_test
