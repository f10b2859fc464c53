// Objects that burn away: the shell is closed at every step, its volume only falls, holes are where
// the texels say, and both walls of a slab open together.
#include "mesh/refine/table.h"
#include "support/refine_scene.h"
#include "support/sanitized.h"

#include <gtest/gtest.h>

namespace fw::test {
namespace {

using mesh::RefineOptions;

// The area left of the outer skin in its rest pose never grows, but for float rounding (1e-8
// measured): a hole never closes, whatever the levels do.
constexpr double kRounding = 1e-7;
// The current area may grow by this share in one step, because receding surfaces become slopes,
// which are longer. Measured: 6e-4, for a sheet.
constexpr double kSlopes = 2e-3;

// Rest position of a corner on the outer skin, cut or not.
glm::vec3 restOf(const mesh::RefineModel& model, const mesh::RefineState& state, float now,
                 const mesh::RefineCorner& corner) {
    const auto rest = [&](uint32_t slot) {
        const gpu::RefineSlot& s = model.slots[slot];
        return glm::vec3(s.x, s.y, s.z);
    };
    if (corner.high == corner.low) return rest(corner.low);
    return gpu::refineCutPoint(rest(corner.low), rest(corner.high),
                               gpu::secondsToHole(state.vertices[corner.low].hole, now),
                               gpu::secondsToHole(state.vertices[corner.high].hole, now));
}

struct Burn {
    uint32_t openSteps = 0, shared = 0, degenerate = 0, slivers = 0, grew = 0, flips = 0;
    size_t triangles = 0, outer = 0;
    uint32_t mostRim = 0, mostAll = 0;
    double firstVolume = 0, lastVolume = 0;
    double areaGrowth = 0;  // of the outer skin, largest in one step, relative to its first area
    double restGrowth = 0;  // the same in the rest pose
};

// Flipped outer triangles with area left. Burnt-through triangles are not drawn; where their level
// falls, a corner may lie deeper than its surroundings.
uint32_t flipsOf(const RefineScene& scene, const mesh::RefineState& state, float now) {
    uint32_t flips = 0;
    for (size_t i = 0; i < scene.model.triangles.size(); ++i)
        for (uint32_t k = state.starts[i]; k < state.starts[i + 1]; ++k) {
            glm::vec3 at[3], rest[3];
            bool left = false;
            for (int v = 0; v < 3; ++v) {
                const uint32_t s = scene.model.draws[state.indices[k * 3 + uint32_t(v)]].slot;
                const gpu::RefineVertex& x = state.vertices[s];
                const gpu::RefineSlot& r = scene.model.slots[s];
                at[v] = {x.x, x.y, x.z};
                left |= x.hole > now;
                rest[v] = {r.x, r.y, r.z};
            }
            flips += left && glm::dot(glm::cross(at[1] - at[0], at[2] - at[0]),
                                      glm::cross(rest[1] - rest[0], rest[2] - rest[0])) < 0;
        }
    return flips;
}

Burn burnDown(const RefineScene& scene, int steps, bool byDistance) {
    RefinePlayer player(scene);
    if (byDistance) player.views = {{{-1.5f, 0.7f, 0.4f}, 1000}};
    mesh::RefineShell shell(std::pmr::new_delete_resource());
    Burn b;
    const float dt = (scene.end + kBurnSeconds + 2) / float(steps);
    double last = 1e30, lastArea = 1e30, lastRest = 1e30, firstArea = 0;
    for (int k = 0; k <= steps; ++k) {
        const float now = float(k) * dt;
        player.frame(now, dt);
        b.flips += flipsOf(scene, player.state, now);
        b.outer += player.triangles();
        mesh::refineShell(scene.model, player.state, now, true, shell);
        EXPECT_EQ(shell.corners.size(),
                  3 * size_t(shell.outer + shell.inner + shell.rim + shell.wall));
        const Closedness c = closedness(shellIds(shell));
        b.openSteps += c.open > 0;
        b.shared += c.shared;
        b.degenerate += c.degenerate;
        b.triangles += shell.corners.size() / 3;
        b.mostRim = std::max(b.mostRim, shell.rim);
        b.mostAll = std::max(b.mostAll, uint32_t(shell.corners.size() / 3));
        double volume = 0, area = 0, restArea = 0;
        for (size_t i = 0; i < shell.corners.size(); i += 3) {
            glm::vec3 p[3];
            for (size_t v = 0; v < 3; ++v)
                p[v] = refineCornerPlace(scene.model, player.state, now, shell.corners[i + v]);
            const glm::vec3 across = glm::cross(p[1] - p[0], p[2] - p[0]);
            volume += double(glm::dot(p[0], glm::cross(p[1], p[2]))) / 6;
            b.slivers += glm::length(across) / 2 < 1e-10f;
            bool outer = true;
            for (size_t v = 0; v < 3; ++v)
                outer &= (shell.corners[i + v].high & mesh::kRefineInside) == 0;
            if (!outer) continue;
            area += double(glm::length(across)) / 2;
            for (size_t v = 0; v < 3; ++v)
                p[v] = restOf(scene.model, player.state, now, shell.corners[i + v]);
            restArea += double(glm::length(glm::cross(p[1] - p[0], p[2] - p[0]))) / 2;
        }
        if (k == 0) b.firstVolume = volume;
        b.grew += volume > last + 1e-6;
        last = volume;
        if (k == 0) firstArea = area;
        b.areaGrowth = std::max(b.areaGrowth, (area - lastArea) / firstArea);
        lastArea = area;
        b.restGrowth = std::max(b.restGrowth, (restArea - lastRest) / firstArea);
        lastRest = restArea;
    }
    b.lastVolume = last;
    return b;
}

Burn expectConsumed(const char* name, const RefineScene& scene, int steps, bool byDistance) {
    const Burn b = burnDown(scene, steps, byDistance);
    EXPECT_EQ(0u, b.openSteps) << name << ": steps with an open edge";
    EXPECT_EQ(0u, b.shared) << name;
    EXPECT_EQ(0u, b.degenerate) << name;
    EXPECT_EQ(0u, b.grew) << name << ": steps in which the volume grew";
    EXPECT_GT(b.firstVolume, 0) << name;
    EXPECT_NEAR(0, b.lastVolume, 1e-9) << name;
    EXPECT_GT(b.mostRim, 20u) << name;
    EXPECT_LT(b.areaGrowth, kSlopes) << name;
    EXPECT_LT(b.restGrowth, kRounding) << name;
    std::printf(
        "%s: %zu shell triangles in %d steps, %u of no area, %.4f %% of the outer ones "
        "turned over; at most %u rim and %u in all; volume %.5f m3 to %.1e; outer area grew by at "
        "most %.1e a step, at rest %.1e\n",
        name, b.triangles, steps, b.slivers, 100.0 * b.flips / double(b.outer), b.mostRim,
        b.mostAll, b.firstVolume, b.lastVolume, b.areaGrowth, b.restGrowth);
    return b;
}

TEST(RefineBurn, ABoxStaysClosedWhileItBurnsAway) {
    RefineScene box(gridBox(1, 1, 1, 1, 1, 1), unsplit(5), 64);
    box.light({0.02, 0.45, 0.37}, 0.02);
    const Burn b = expectConsumed("box", box, 50, false);
    // Six mitred walls of 20 mm: 1 - 0.96^3.
    EXPECT_NEAR(1 - 0.96 * 0.96 * 0.96, b.firstVolume, 0.0005);
    EXPECT_EQ(0u, b.flips);
    RefineScene split(gridBox(1, 1, 1, 1, 1, 1, 11), RefineOptions{}, 128);
    split.light({0.02, 0.45, 0.37}, 0.02, 0.25);
    const Burn s = expectConsumed("split box, noise, distance", split, 25, true);
    EXPECT_EQ(0u, s.flips);
}

TEST(RefineBurn, AHouseStaysClosedWhileItBurnsAway) {
    RefineScene scene(house(1, 0.8, 1.5, 0.4, 1, 3), unsplit(4), 64);
    scene.light({0.02, 0.45, 0.37}, 0.03, 0.15);
    EXPECT_EQ(0u, expectConsumed("house", scene, 40, false).flips);
}

TEST(RefineBurn, AnOpenSheetGetsWalls) {
    RefineScene scene(makePlane(0.6, 0.4), unsplit(4), 64);
    scene.light({0.2, 0.2, 0}, 0.03, 0.1);
    const Burn b = expectConsumed("sheet", scene, 40, false);
    EXPECT_NEAR(0.6 * 0.4 * 0.02, b.firstVolume, 1e-4);
}

TEST(RefineBurn, FuzzedMeshesStayClosed) {
    std::mt19937 random(5);
    const auto of = [&](double low, double high) {
        return low + (high - low) * double(random() & 0xFFFF) / 65535;
    };
    const auto some = [&](int most) { return 1 + int(random() % uint32_t(most)); };
    size_t triangles = 0;
    const int meshes = rounds(24, 6);
    for (int k = 0; k < meshes; ++k) {
        const double x = of(0.3, 1.2), y = of(0.3, 1.0), z = k % 3 == 1 ? 0.05 : of(0.3, 1.4);
        const Mesh mesh = k % 3 == 2 ? house(x, y, z, of(0.1, 0.5), some(2), some(3))
                                     : gridBox(x, y, z, some(3), some(3), some(2), of(0, 30));
        RefineScene scene(mesh, unsplit(2 + uint32_t(random() % 3)), 48);
        scene.light({of(0, x), of(0, y), of(0, z)}, of(0.02, 0.08), of(0, 0.3));
        const Burn b = burnDown(scene, 16, k % 2 == 0);
        EXPECT_EQ(0u, b.openSteps) << "mesh " << k;
        EXPECT_EQ(0u, b.shared) << "mesh " << k;
        EXPECT_EQ(0u, b.degenerate) << "mesh " << k;
        EXPECT_LT(b.areaGrowth, kSlopes) << "mesh " << k;
        EXPECT_LT(b.restGrowth, kRounding) << "mesh " << k;
        triangles += b.triangles;
    }
    std::printf("%d meshes, %zu shell triangles\n", meshes, triangles);
}

TEST(RefineBurn, TheBunnyStaysClosedWhileItBurnsAway) {
    Mesh mesh;
    std::string reason;
    if (!loadGlb("bunny_4k.glb", mesh, reason)) GTEST_SKIP() << reason;
    RefineOptions o = unsplit(1);
    o.wall = 0.012f;
    RefineScene scene(mesh, o, 64);
    const Vec3 foot = texelPosition(scene.domain, 0);
    scene.light({foot.x, foot.y, foot.z}, 0.02, 0.15);
    const Burn b = burnDown(scene, 16, false);
    EXPECT_EQ(0u, b.openSteps);
    EXPECT_EQ(0u, b.degenerate);
    EXPECT_LT(double(b.flips), 0.0005 * double(b.outer));
    std::printf("bunny: %zu shell triangles, %.4f %% of the outer ones turned over, most %u\n",
                b.triangles, 100.0 * b.flips / double(b.outer), b.mostAll);
}

// The closedness test must notice missing rims and lost edge directions.
TEST(RefineBurn, ClosednessTestCatchesMutants) {
    RefineScene scene(gridBox(1, 1, 1, 1, 1, 1, 11), unsplit(5), 64);
    scene.light({0.02, 0.45, 0.37}, 0.02, 0.15);
    RefinePlayer player(scene);
    const float now = scene.timeAt(0.4) + kBurnSeconds;
    player.runTo(now - 3, now, 0.25f);
    mesh::RefineShell shell(std::pmr::new_delete_resource());
    mesh::refineShell(scene.model, player.state, now, true, shell);
    EXPECT_EQ(0u, closedness(shellIds(shell)).open);
    std::vector<uint64_t> ids = shellIds(shell), rimless;
    for (size_t i = 0; i < ids.size(); i += 3) {
        bool inner[3];
        for (size_t k = 0; k < 3; ++k) inner[k] = (ids[i + k] >> 63) != 0;
        if (inner[0] == inner[1] && inner[1] == inner[2])
            rimless.insert(rimless.end(), ids.begin() + long(i), ids.begin() + long(i) + 3);
    }
    EXPECT_GT(closedness(rimless).open, 100u) << "no rims";
    for (gpu::RefineTriangle& t : scene.model.triangles) t.flags &= ~7u;
    mesh::refineShell(scene.model, player.state, now, true, shell);
    EXPECT_GT(closedness(shellIds(shell)).open, 100u) << "flip bits ignored";
}

// Triangles without a hole need no cut, and those with a hole are marked.
TEST(RefineBurn, OnlyHoledTrianglesAreCut) {
    RefineScene scene(gridBox(1, 1, 1, 2, 2, 2), unsplit(4), 64);
    scene.light({0.02, 0.45, 0.37}, 0.02);
    RefinePlayer player(scene);
    const float now = scene.timeAt(0.3) + kBurnSeconds;
    player.runTo(now - 3, now, 0.25f);
    mesh::RefineShell shell(std::pmr::new_delete_resource());
    mesh::refineShell(scene.model, player.state, now, false, shell);
    EXPECT_EQ(0u, shell.inner + shell.rim + shell.wall);
    EXPECT_GT(shell.gone, 0u);
    uint32_t holed = 0;
    for (uint32_t i = 0; i < scene.model.triangles.size(); ++i)
        holed += mesh::refineHoled(scene.model, player.state, now, i);
    EXPECT_GT(holed, 5u);
    EXPECT_LT(holed, scene.model.triangles.size());
    uint32_t marked = 0;  // cut corners lie in holed triangles only
    for (const gpu::RefineVertex& v : player.state.vertices) marked += v.hole <= now;
    EXPECT_GT(marked, 0u);
}

TEST(RefineBurn, PermanentCharNeverOpens) {
    RefineScene scene(gridBox(1, 1, 1, 1, 1, 1), unsplit(3), 32);
    scene.light({0.02, 0.45, 0.37}, 0.05);
    std::fill(scene.burn.begin(), scene.burn.end(), -kBurnSeconds);
    RefinePlayer player(scene);
    const float now = scene.end;
    player.runTo(now - 3, now, 0.25f);
    mesh::RefineShell shell(std::pmr::new_delete_resource());
    mesh::refineShell(scene.model, player.state, now + 100, true, shell);
    EXPECT_EQ(0u, shell.gone + shell.rim);
}

TEST(RefineBurn, HoleTimesCombineBothSides) {
    const float never = gpu::kRefineNever;
    EXPECT_EQ(never, gpu::burnThroughTime(never, never, 4));
    EXPECT_EQ(7, gpu::burnThroughTime(3, never, 4));
    EXPECT_EQ(7, gpu::burnThroughTime(never, 3, 4));
    EXPECT_EQ(5, gpu::burnThroughTime(3, 3, 4)) << "from both sides at once: half the time";
    EXPECT_EQ(6, gpu::burnThroughTime(3, 5, 4));
    EXPECT_EQ(7, gpu::burnThroughTime(3, 9, 4)) << "burnt through before the other side is lit";
    EXPECT_EQ(gpu::burnThroughTime(2, 5.5f, 4), gpu::burnThroughTime(5.5f, 2, 4));
}

// Both walls of a slab cut the same hole although their charts are rotated against each other.
TEST(RefineBurn, BothWallsOfASlabOpenTogether) {
    const double thick = 0.02;
    RefineScene scene(gridBox(1, 1, thick, 4, 4, 1, 13), unsplit(4), 128);
    scene.light({0.02, 0.5, thick}, 0.02, 0.15);
    RefinePlayer player(scene);
    player.settings.skipStill = false;
    const float now = scene.timeAt(0.4) + kBurnSeconds;
    player.runTo(now - 3, now, 0.25f);
    std::map<std::pair<long, long>, uint32_t> below;
    const auto key = [](const gpu::RefineSlot& s) {
        return std::make_pair(std::lround(double(s.x) * 8192), std::lround(double(s.y) * 8192));
    };
    uint32_t opposed = 0, walls = 0, far = 0, crossing = 0;
    double worst = 0, sum = 0;
    for (const gpu::RefineSlot& s : scene.model.slots)
        if (s.z == 0) below[key(s)] = uint32_t(&s - scene.model.slots.data());
    uint32_t pairs = 0;
    for (uint32_t i = 0; i < scene.model.slots.size(); ++i) {
        const gpu::RefineSlot& s = scene.model.slots[i];
        const bool rim = s.x < 0.03f || s.y < 0.03f || s.x > 0.97f || s.y > 0.97f;
        if (std::abs(double(s.z) - thick) > 1e-6 || rim) continue;
        ++walls;
        opposed += s.opposite != gpu::kRefineOpposed;
        crossing += double(s.reach & 0xFFFF) * 1e-5 > 0.45 * thick + 1.1e-5;
        const auto other = below.find(key(s));
        if (other == below.end()) continue;
        const float a = player.state.vertices[i].hole,
                    b = player.state.vertices[other->second].hole;
        if (a >= gpu::kRefineNever || b >= gpu::kRefineNever) {
            far += (a < now) != (b < now);
            continue;
        }
        ++pairs;
        const double apart = std::abs(double(a - b)) * 0.02;  // m of front travel
        sum += apart;
        worst = std::max(worst, apart);
    }
    EXPECT_EQ(walls, opposed);
    EXPECT_EQ(0u, far);
    EXPECT_EQ(0u, crossing) << "vertices that can recede past the middle";
    ASSERT_GT(pairs, 300u);
    std::printf(
        "slab: %u pairs of opposite vertices, holes %.2f mm apart on average, %.2f at most\n",
        pairs, 1000 * sum / pairs, 1000 * worst);
    EXPECT_LT(1000 * sum / pairs, 0.3);
    EXPECT_LT(1000 * worst, 3);
}

}  // namespace
}  // namespace fw::test
