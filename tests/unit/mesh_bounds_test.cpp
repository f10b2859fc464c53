// Extreme meshes: the bake answers or refuses with a message in bounded work. Each of these took
// minutes or hung with quadratic work.
#include <cmath>
#include <random>

#include "support/sanitized.h"
#include "unit/mesh_checks.h"

namespace {

using namespace fw;
using namespace fw::test;

// ms on a slow machine. Quadratic work takes minutes; under a sanitizer one bake varied from 10 to
// 22 s on a shared machine.
constexpr double kMostMilliseconds = rounds(20000.0, 60000.0);

class Dice {
 public:
    double operator()() { return double(engine_()) / 4294967296.0; }

 private:
    std::mt19937 engine_{7};
};

// Triangles with random corners in a 1 m box, each with its own UVs.
Mesh makeBoxSoup(uint32_t triangles) {
    Mesh mesh;
    Dice dice;
    for (uint32_t i = 0; i < triangles * 3; ++i) {
        const double x = dice(), y = dice(), z = dice(), u = dice(), v = dice();
        mesh.addVertex(x, y, z, u, v);
        if (i % 3 == 2) mesh.addTriangle(i - 2, i - 1, i);
    }
    return mesh;
}

// A metre long, a tenth of a millimetre wide, anywhere.
Mesh makeNeedles(uint32_t triangles) {
    Mesh mesh;
    Dice dice;
    for (uint32_t i = 0; i < triangles; ++i) {
        const double x = dice(), y = dice(), z = dice(), turn = 6.28 * dice();
        const double c = std::cos(turn), s = std::sin(turn);
        const uint32_t base = mesh.addVertex(x, y, z, dice(), dice());
        mesh.addVertex(x + c, y + s, z, dice(), dice());
        mesh.addVertex(x - 1e-4 * s, y + 1e-4 * c, z, dice(), dice());
        mesh.addTriangle(base, base + 1, base + 2);
    }
    return mesh;
}

// A disc of needles from its middle to its rim.
Mesh makeDisc(uint32_t triangles, double radius) {
    Mesh mesh;
    mesh.addVertex(0, 0, 0, 0.5, 0.5);
    for (uint32_t i = 0; i <= triangles; ++i) {
        const double turn = 6.283185307 * i / triangles, c = std::cos(turn), s = std::sin(turn);
        mesh.addVertex(radius * c, radius * s, 0, 0.5 + 0.5 * c, 0.5 + 0.5 * s);
        if (i > 0) mesh.addTriangle(0, i, i + 1);
    }
    return mesh;
}

Mesh makeCoincident(uint32_t triangles) {
    Mesh mesh;
    for (uint32_t i = 0; i < triangles; ++i) {
        const uint32_t base = mesh.addVertex(0, 0, 0, 0, 0);
        mesh.addVertex(1, 0, 0, 1, 0);
        mesh.addVertex(0, 1, 0, 0, 1);
        mesh.addTriangle(base, base + 1, base + 2);
    }
    return mesh;
}

// A square of rolling 1 m cells, all of which use the whole unit square of UVs.
Mesh makeTiledTerrain(int cells) {
    Mesh mesh;
    for (int i = 0; i < cells * cells; ++i) {
        uint32_t corner[4];
        for (int k = 0; k < 4; ++k) {
            const int u = k == 1 || k == 2, v = k >= 2;
            const double x = i % cells + u, y = i / cells + v;
            corner[k] = mesh.addVertex(x, y, 0.5 * std::sin(x) * std::cos(0.7 * y), u, v);
        }
        mesh.addTriangle(corner[0], corner[1], corner[2]);
        mesh.addTriangle(corner[0], corner[2], corner[3]);
    }
    return mesh;
}

// A valid domain or a refusal for too many charts, in time.
void expectAnswer(const Mesh& mesh, bool trust, double texelsPerMetre = 128,
                  uint32_t maxSide = 256) {
    mesh::BakeInput input = mesh.input(texelsPerMetre, maxSide);
    input.trustUvs = trust;
    try {
        const BurnDomain d = mesh::bake(input, std::pmr::new_delete_resource());
        EXPECT_LT(d.report.milliseconds, kMostMilliseconds);
        EXPECT_GT(d.report.realTexels, 0u);
        expectSound(d);
    } catch (const core::Error& error) {
        EXPECT_NE(std::string::npos, std::string(error.message).find("has no room for them"))
            << error.message;
    }
}

TEST(MeshBounds, BoundsASoupOfLongTriangles) {
    for (bool trust : {false, true}) expectAnswer(makeBoxSoup(2000), trust);
}

TEST(MeshBounds, BoundsNeedles) {
    for (bool trust : {false, true}) expectAnswer(makeNeedles(5000), trust);
    Mesh bare = makeNeedles(5000);
    bare.uvs.clear();
    expectAnswer(bare, false);
    EXPECT_EQ(
        "The mesh falls into 20000 charts; an atlas of 256 x 256 texels has no room for them.",
        refusal(makeNeedles(20000).input(128, 256)));
}

// Its middle would be drawn once per needle: the density is lowered, the area kept.
TEST(MeshBounds, BoundsADiscOfNeedles) {
    const BurnDomain d = bakeOf(makeDisc(60000, 4).input(128, 1024));
    expectSound(d);
    EXPECT_LT(d.report.milliseconds, kMostMilliseconds);
    // 60000 * 8 m of edges at 128 texels/m would be 61 million texels; 8.4 million are allowed.
    EXPECT_GT(double(d.texelSide) * 8388608, 60000 * 8.0);
    EXPECT_LT(double(d.texelSide) * 8388608, 60000 * 8.0 * 1.1);
    const BurnDomain few = bakeOf(makeDisc(64, 1).input(128, 1024));
    EXPECT_EQ(1 / 128.0f, few.texelSide) << "an ordinary disc keeps its density";
}

// 1.2 texels per hundred triangles, all one surface: a walk crosses hundreds of them.
TEST(MeshBounds, BoundsConfettiFarBelowATexel) { expectAnswer(makeConfetti(5, 60, 0.2), true, 2); }

TEST(MeshBounds, BoundsTrustedTiledTerrain) {
    expectAnswer(makeTiledTerrain(100), true);
    expectAnswer(makeTiledTerrain(20), true);
}

// Ten thousand sheets exceed the UV box, so no drawing is needed to find the overlap.
TEST(MeshBounds, RepacksTiledTerrain) {
    const BurnDomain d = bakeOf(makeTiledTerrain(100).input(128, 256));
    expectSound(d);
    EXPECT_EQ(0u, d.report.usedOwnUv);
    EXPECT_LT(d.report.milliseconds, kMostMilliseconds);
}

TEST(MeshBounds, BoundsCoincidentTriangles) {
    expectAnswer(makeCoincident(5000), false);
    // Trusted, they share texels: few, drawn about four times the largest atlas.
    const Mesh mesh = makeCoincident(100000);
    mesh::BakeInput input = mesh.input(128, 256);
    input.trustUvs = true;
    const BurnDomain d = bakeOf(input);
    expectSound(d);
    EXPECT_LT(d.report.milliseconds, kMostMilliseconds);
    EXPECT_LE(d.report.overlaps, 8u * 256 * 256);
    EXPECT_EQ(
        "The mesh falls into 50000 charts; an atlas of 256 x 256 texels has no room for them.",
        refusal(mesh.input(128, 256)));
}

}  // namespace
