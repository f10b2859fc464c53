// Surfaces heated by a fire that never reaches them turn brown and stay brown; others do not.
// FLAMEWRIGHT_MOTION=<folder> keeps the pictures.
#include "support/own_world.h"

#include <cstdlib>

namespace fw::test::browning_test {
namespace {

constexpr uint32_t kWidth = 200, kHeight = 160;  // px

// Upright, from (x, y, z) on: across > 0 faces +z, across < 0 faces -z.
Mesh panel(double x, double y, double z, double across, double up) {
    Mesh mesh;
    for (int k = 0; k < 4; ++k) {
        const double u = k & 1 ? across : 0, v = k & 2 ? up : 0;
        mesh.addVertex(x + u, y + v, z, std::abs(u), v);
    }
    mesh.addTriangle(0, 1, 3);
    mesh.addTriangle(0, 3, 2);
    return mesh;
}

class Browning : public OwnWorld {
 protected:
    // A board of 0.5 m at x that faces -z at z = 0.35 and ignites only at a thousand degrees.
    FwBurnableMeshId board(float x) {
        const Mesh mesh = panel(double(x) + 0.25, 0.25, 0.35, -0.5, 0.5);
        FwMaterialDef wood = fwDefaultMaterialDef();
        wood.density = 120;
        wood.ignitionTemperature = 1900;
        wood.autoIgnitionTemperature = 2900;
        add(meshDefOf(mesh), wood, FW_BURNABLE_TWO_SIDED);
        return added_;
    }
    // From the burning panel's side, and from beside it.
    Picture look(float x) {
        return pictureOf(
            world_,
            viewAt({x + 1.1f, 0.5f, -0.35f}, {x, 0.5f, 0.35f}, float(kWidth) / float(kHeight)),
            kWidth, kHeight);
    }
    // Mean colour of the board's upper middle, 0 to 255; heat rises.
    static glm::dvec3 colorOf(const Picture& p) {
        glm::dvec3 sum(0);
        for (uint32_t y = kHeight / 4; y < kHeight * 2 / 5; ++y)
            for (uint32_t x = kWidth * 2 / 5; x < kWidth * 3 / 5; ++x)
                for (int c = 0; c < 3; ++c)
                    sum[c] += p.rgb[(size_t{y} * kWidth + x) * 3 + size_t(c)];
        return sum / double(kWidth / 5 * (kHeight * 2 / 5 - kHeight / 4));
    }
};

TEST_F(Browning, HeatedSurfacesTurnBrown) {
    makeWorld(1, 64, FW_WORLD_RADIATION);
    const Mesh mesh = panel(-0.4, 0.1, 0, 0.8, 0.8);
    FwMaterialDef pine = fwDefaultMaterialDef();
    pine.burnTime = 10;
    pine.spreadRate = 0.05f;
    pine.burningFlux = 0.03f;
    pine.radiantFraction = 0.6f;
    add(meshDefOf(mesh), pine, FW_BURNABLE_TWO_SIDED);
    const FwBurnableMeshId near = board(0);
    board(6);
    fwWorld_Step(world_, 0);
    const Picture fresh = look(0), farFresh = look(6);
    touch(FW_IGNITE, 0, 0.5f, 0, 0.3f);  // the board is farther
    run(16, 0.25f);                      // by then it is out and ignites nothing
    const Picture browned = look(0), farAfter = look(6);
    if (const char* folder = std::getenv("FLAMEWRIGHT_MOTION")) {
        writePng(std::string(folder) + "/browning_fresh.png", fresh);
        writePng(std::string(folder) + "/browning_after.png", browned);
        writePng(std::string(folder) + "/browning_far.png", farAfter);
    }
    FwObjectState state{};
    state.structSize = sizeof state;
    ASSERT_EQ(fwWorld_GetObjectState(world_, near, &state), FW_OK);
    EXPECT_EQ(state.ignited, 0u) << "it must not burn";
    const glm::dvec3 a = colorOf(fresh), b = colorOf(browned);
    std::printf("a board's colour before %.0f %.0f %.0f, after %.0f %.0f %.0f\n", a.r, a.g, a.b,
                b.r, b.g, b.b);
    EXPECT_LT(b.g, 0.85 * a.g);
    EXPECT_GT(b.g, 0.1 * a.g) << "brown, not char";
    EXPECT_GT(b.r / b.b, 1.05 * a.r / a.b) << "warmer in hue";
    EXPECT_LT(glm::length(colorOf(farAfter) - colorOf(farFresh)), 2);
}

// A match lights it, but the fire goes out before any picture shows it. That leaves a brown spot
// with some char and no embers.
TEST_F(Browning, AFireThatGoesOutAtOnceOnlyScorches) {
    makeWorld(1, 64);
    const FwBurnableMeshId lit = board(0);
    fwWorld_Step(world_, 0);
    const Picture fresh = look(0);
    touch(FW_IGNITE, 0, 0.5f, 0.35f, 0.2f);
    run(8, 0.25f);
    const Picture scorched = look(0);
    if (const char* folder = std::getenv("FLAMEWRIGHT_MOTION"))
        writePng(std::string(folder) + "/browning_match.png", scorched);
    FwObjectState state{};
    state.structSize = sizeof state;
    ASSERT_EQ(fwWorld_GetObjectState(world_, lit, &state), FW_OK);
    EXPECT_EQ(state.ignited, 0u) << "out again within a step";
    const glm::dvec3 a = colorOf(fresh), b = colorOf(scorched);
    std::printf("a board's colour before %.0f %.0f %.0f, after %.0f %.0f %.0f\n", a.r, a.g, a.b,
                b.r, b.g, b.b);
    EXPECT_LT(b.r, 0.9 * a.r) << "no bed of embers";
    EXPECT_GT(b.g, 0.3 * a.g) << "brown, not char all over";
    EXPECT_GT(b.r / b.b, 1.05 * a.r / a.b) << "warmer in hue";
}

}  // namespace
}  // namespace fw::test::browning_test
