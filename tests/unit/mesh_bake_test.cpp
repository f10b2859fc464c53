// The bake on meshes with known answers and on real ones: figures, areas, links, worst cases.
#include <cstdio>
#include <ctime>
#include <queue>

#include "support/sanitized.h"
#include "unit/mesh_checks.h"

namespace {

using namespace fw;
using namespace fw::test;

struct Figures {
    uint32_t width, height, real, forced, open, lost, withoutDependents;
    double linkLow, linkHigh;  // 0.1 % and 99.9 %, in texel sides
};

void expectFigures(const BurnDomain& d, const Figures& f, double rimShare) {
    expectSound(d);
    EXPECT_EQ(f.width, d.width);
    EXPECT_EQ(f.height, d.height);
    EXPECT_EQ(f.real, d.report.realTexels);
    EXPECT_EQ(f.forced, d.report.forcedTexels);
    EXPECT_EQ(f.open, d.report.linksOpen);
    EXPECT_EQ(f.lost, d.report.linksLost);
    EXPECT_EQ(f.withoutDependents, d.report.withoutDependents);
    EXPECT_NEAR(rimShare, double(d.report.rimTexels) / d.report.realTexels, 0.006);
    EXPECT_NEAR(1, d.report.texelArea / d.report.meshArea, 1e-6);
    std::vector<double> lengths;
    for (uint32_t i = 0; i < d.texelCount(); ++i)
        for (uint32_t k = 0; d.real(i) && k < 8; ++k)
            if (const uint32_t j = ringOf(d, i, k); j != kNone)
                lengths.push_back(linkMetres(d, i, j) / double(d.texelSide));
    std::sort(lengths.begin(), lengths.end());
    EXPECT_NEAR(f.linkLow, lengths[lengths.size() / 1000], 0.011);
    EXPECT_NEAR(f.linkHigh, lengths[lengths.size() - 1 - lengths.size() / 1000], 0.011);
    EXPECT_EQ(0u, neverReached(d, firstReal(d)));
}

TEST(MeshBake, PlaneTurned33Degrees) {
    const Mesh mesh = makePlane(1, 1, 33);
    const BurnDomain d = bakeOf(mesh.input());
    expectFigures(d, {184, 184, 16386, 0, 1568, 0, 0, 1.00, 1.42}, 0.043);
    EXPECT_EQ(1u, d.report.usedOwnUv);
    EXPECT_EQ(1u, d.report.charts);
    EXPECT_NEAR(1.0 / 128, double(d.linkShort), 1e-6);
    EXPECT_NEAR(std::sqrt(2.0) / 128, double(d.linkMax), 1e-5);
}

TEST(MeshBake, CubeOfSixTurnedCharts) {
    const Mesh mesh = makeCube(1, 8);
    expectFigures(bakeOf(mesh.input()), {568, 376, 98311, 5, 0, 0, 0, 0.71, 1.69}, 0.040);
}

TEST(MeshBake, CylinderOfFourTurnedCharts) {
    const Mesh mesh = makeCylinder(0.2, 0.8, 96, 8, 4, true);
    expectFigures(bakeOf(mesh.input()), {736, 144, 16472, 2, 1002, 0, 0, 0.75, 2.01}, 0.087);
}

TEST(MeshBake, CubeSphere) {
    const Mesh mesh = makeCube(1, 32, true);
    expectFigures(bakeOf(mesh.input()), {416, 272, 51331, 4, 0, 0, 0, 0.75, 2.04}, 0.055);
}

TEST(MeshBake, Bunny4k) {
    Mesh mesh;
    FW_LOAD_OR_SKIP(mesh, "bunny_4k.glb");
    const BurnDomain d = bakeOf(mesh.input());
    expectFigures(d, {296, 288, 39908, 551, 954, 1, 0, 0.53, 2.41}, 0.275);
    EXPECT_EQ(216u, d.report.charts);
    EXPECT_EQ(1u, d.report.usedOwnUv);
    for (double density : {16.0, 32.0, 256.0}) {  // sparse atlases lose no area either
        const BurnDomain other = bakeOf(mesh.input(density));
        expectSound(other);
        EXPECT_NEAR(1, other.report.texelArea / other.report.meshArea, 1e-6) << density;
        EXPECT_EQ(0u, neverReached(other, firstReal(other))) << density;
        EXPECT_EQ(0u, other.report.withoutDependents) << density;
    }
}

TEST(MeshBake, StretchedChartsOfSpotAreCutAgain) {
    Mesh mesh;
    FW_LOAD_OR_SKIP(mesh, "spot.glb");
    mesh::BakeInput input = mesh.input();
    input.trustUvs = true;
    const BurnDomain own = bakeOf(input);
    EXPECT_EQ(1u, own.report.usedOwnUv);
    EXPECT_EQ(32757u, own.report.realTexels);
    EXPECT_NEAR(8.6, own.report.aspectP99, 0.1);
    EXPECT_EQ(132u, own.report.linksLost);
    input.trustUvs = false;
    const BurnDomain d = bakeOf(input);
    expectSound(d);
    EXPECT_EQ(0u, d.report.usedOwnUv);
    EXPECT_GT(d.report.rechartedTriangles, 0u);
    EXPECT_LT(d.report.rechartedTriangles, d.report.triangles) << "good islands should stay";
    EXPECT_LE(d.report.aspectMax, 2.03);
    EXPECT_LT(d.report.linkMax, 5);
    EXPECT_LT(d.report.linksLost, 20u);
    EXPECT_EQ(0u, neverReached(d, firstReal(d)));
    uint32_t strangers = 0;  // the mesh's own UVs stay for textures
    std::set<std::pair<float, float>> given;
    for (size_t v = 0; v < mesh.uvs.size(); v += 2) given.insert({mesh.uvs[v], mesh.uvs[v + 1]});
    for (const mesh::RenderVertex& v : d.vertices)
        strangers += given.count({v.textureUv[0], v.textureUv[1]}) == 0;
    EXPECT_EQ(0u, strangers);
}

// The whole bake on one thread, 1024^2 texels.
void bakeLarge(const char* name) {
    Mesh mesh;
    FW_LOAD_OR_SKIP(mesh, name);
    const std::clock_t start = std::clock();  // processor time: other processes do not count
    const BurnDomain d = bakeOf(mesh.input(4096, 1024));  // as dense as 1024^2 holds
    const double milliseconds = 1000.0 * double(std::clock() - start) / CLOCKS_PER_SEC;
    expectSound(d);
    EXPECT_LE(d.width, 1024u);
    EXPECT_LE(d.height, 1024u);
    EXPECT_GT(d.texelCount(), 900u * 1024u) << "the density should fill the atlas";
    EXPECT_LE(d.report.aspectP99, 2.0);
    EXPECT_EQ(0u, d.report.withoutDependents);
    EXPECT_EQ(0u, neverReached(d, firstReal(d)));
    std::printf("[   FIGURE ] %s: %u x %u, %u texels, %u charts, baked in %.0f ms (limit 5000)\n",
                name, d.width, d.height, d.report.realTexels, d.report.charts, milliseconds);
#ifdef NDEBUG
    if (!fw::test::kSanitized) {
        EXPECT_LE(milliseconds, 5000);
    }
#endif
}
TEST(MeshBake, Bunny31kWithItsOwnUvsAt1024) { bakeLarge("bunny_31k.glb"); }
TEST(MeshBake, Bunny35kWithoutUvsAt1024) { bakeLarge("bunny_35k_nouv.glb"); }

TEST(MeshBake, FoldedUvsGetNoLinksThroughSpace) {
    Mesh mesh;
    FW_LOAD_OR_SKIP(mesh, "bunny_31k.glb");  // 16 texel centres lie in two triangles
    const BurnDomain d = bakeOf(mesh.input());
    expectSound(d);
    EXPECT_EQ(1u, d.report.usedOwnUv);
    EXPECT_LT(d.report.linkMax, 5) << "in texel sides";
    EXPECT_EQ(0u, neverReached(d, firstReal(d)));
}

TEST(MeshBake, ConfettiAtlas) {  // every triangle is its own chart, legs down to half a texel
    for (double leg : {16.0, 8.0, 4.0, 2.0, 1.0, 0.5}) {
        if (kSanitized && leg < 2) continue;
        const int cells = int(std::min(100.0, 120 / leg));
        const Mesh mesh = makeConfetti(cells * leg / 128, cells, 3.0 / 128);
        mesh::BakeInput input = mesh.input(128, 4096);
        input.trustUvs = true;
        const BurnDomain d = bakeOf(input);
        SCOPED_TRACE(leg);
        expectSound(d);
        EXPECT_EQ(mesh.triangleCount(), d.report.charts);
        EXPECT_NEAR(1, d.report.texelArea / d.report.meshArea, 1e-6);
        EXPECT_EQ(0u, neverReached(d, firstReal(d)));
        EXPECT_EQ(0u, d.report.withoutDependents) << "fire lit there could not spread";
        // Our own packing of the same pieces.
        input.trustUvs = false;
        input.uvs = {};
        const BurnDomain joined = bakeOf(input);
        expectSound(joined);
        EXPECT_EQ(1u, joined.report.charts) << "a flat square needs one chart";
    }
}

TEST(MeshBake, StripAtlas) {
    for (double width : {8.0, 4.0, 2.0, 1.5, 1.0, 0.7, 0.3}) {
        const int strips = int(100 / width);
        const Mesh mesh = makeStrips(strips * width / 128, strips, 3.0 / 128);
        mesh::BakeInput input = mesh.input(128, 4096);
        input.trustUvs = true;
        const BurnDomain d = bakeOf(input);
        SCOPED_TRACE(width);
        expectSound(d);
        EXPECT_EQ(0u, neverReached(d, firstReal(d)));
        EXPECT_EQ(0u, d.report.withoutDependents);
    }
}

// Shortest paths over the links from the texel nearest to a point to those nearest to others.
std::vector<double> distances(const BurnDomain& d,
                              const std::vector<std::array<float, 3>>& points) {
    std::vector<double> best(d.texelCount(), 1e30);
    std::vector<std::vector<std::pair<uint32_t, double>>> heardBy(d.texelCount());
    for (uint32_t i = 0; i < d.texelCount(); ++i)
        for (uint32_t k = 0; d.real(i) && k < 8; ++k)
            if (const uint32_t j = ringOf(d, i, k); j != kNone)
                heardBy[j].push_back({i, linkMetres(d, i, j)});
    using Item = std::pair<double, uint32_t>;
    std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
    const uint32_t seed = mesh::nearestTexel(d, points[0].data(), 1);
    queue.push({0, seed});
    best[seed] = 0;
    while (!queue.empty()) {
        const auto [at, i] = queue.top();
        queue.pop();
        if (at > best[i]) continue;
        for (const auto& [j, length] : heardBy[i])
            if (at + length < best[j]) {
                best[j] = at + length;
                queue.push({best[j], j});
            }
    }
    std::vector<double> out;
    for (const auto& p : points) out.push_back(best[mesh::nearestTexel(d, p.data(), 1)]);
    return out;
}

TEST(MeshBake, TenRandomUnwrapsOfOneRealMesh) {
    Mesh mesh;
    FW_LOAD_OR_SKIP(mesh, "bunny_4k.glb");
    std::vector<std::array<float, 3>> points;
    for (uint32_t v = 0; v < mesh.vertexCount(); v += 97)
        points.push_back(
            {mesh.positions[v * 3], mesh.positions[v * 3 + 1], mesh.positions[v * 3 + 2]});
    const BurnDomain original = bakeOf(mesh.input());
    const std::vector<double> reference = distances(original, points);
    double worst = 0;
    for (uint32_t seed = 0; seed < rounds(10u, 4u); ++seed) {
        const Mesh other = randomUnwrap(mesh, seed, 20 + seed * 25);
        const BurnDomain d = bakeOf(other.input());
        SCOPED_TRACE(seed);
        expectSound(d);
        EXPECT_EQ(0u, neverReached(d, firstReal(d)));
        EXPECT_NEAR(original.report.meshArea, d.report.meshArea, 1e-6);
        EXPECT_LT(d.report.linkMax, 5);
        EXPECT_GT(d.report.charts, 60u);
        // Paths along 8 directions are up to 8 % longer than straight ones, depending on the UVs'
        // rotation.
        const std::vector<double> found = distances(d, points);
        double sum = 0, sumReference = 0;
        for (size_t i = 0; i < points.size(); ++i) {
            sum += found[i];
            sumReference += reference[i];
            if (reference[i] < 0.2) continue;
            worst = std::max(worst, std::abs(found[i] / reference[i] - 1));
        }
        EXPECT_NEAR(1, sum / sumReference, 0.02);
    }
    std::printf("[   FIGURE ] worst way between two points, unwrap against unwrap: %.1f %%\n",
                worst * 100);
    EXPECT_LT(worst, 0.10);
}

TEST(MeshBake, ThreeHundredTriangleSoups) {
    uint32_t baked = 0, refused = 0;
    const uint32_t soups = rounds(300u, 60u);
    for (uint32_t seed = 0; seed < soups; ++seed) {
        Mesh mesh = makeSoup(seed);
        for (int way = 0; way < 3; ++way) {  // own UVs if usable; trusted; none
            mesh::BakeInput input = mesh.input(24, 512);
            input.trustUvs = way == 1;
            if (way == 2) input.uvs = {};
            SCOPED_TRACE(testing::Message() << "soup " << seed << ", way " << way);
            try {
                const BurnDomain d = mesh::bake(input, std::pmr::new_delete_resource());
                expectSound(d);
                ++baked;
            } catch (const core::Error& error) {  // refused only without any area
                EXPECT_TRUE(std::string(error.message).find("degenerate") != std::string::npos ||
                            std::string(error.message).find("longest side") != std::string::npos)
                    << error.message;
                ++refused;
            }
            if (HasFailure()) return;
        }
    }
    EXPECT_GT(baked, soups * 17 / 6);
    EXPECT_LT(refused, soups / 6);
}

TEST(MeshBake, RepacksOverlappingUvs) {
    // Six faces of a cube with the same UVs: each island is valid, but they overlap.
    Mesh mesh = makeCube(0.5, 4, false, false);
    for (uint32_t v = 0; v < mesh.vertexCount(); ++v)
        for (uint32_t c = 0; c < 2; ++c) mesh.uvs[v * 2 + c] = mesh.uvs[(v % 25) * 2 + c];
    const BurnDomain d = bakeOf(mesh.input());
    expectSound(d);
    EXPECT_EQ(0u, d.report.usedOwnUv);
    EXPECT_EQ(0u, d.report.overlaps);
    EXPECT_EQ(0u, d.report.rechartedTriangles) << "valid islands stay whole";
    EXPECT_EQ(6u, d.report.charts);
    EXPECT_EQ(0u, neverReached(d, firstReal(d)));

    // An island that overlaps itself is cut: a strip wound twice over the same UVs.
    Mesh wound = makeCylinder(0.1, 0.2, 64, 1, 1, false);
    for (uint32_t v = 0; v < wound.vertexCount(); ++v)
        wound.uvs[v * 2] = std::fmod(wound.uvs[v * 2], 0.3f);
    const BurnDomain w = bakeOf(wound.input());
    expectSound(w);
    EXPECT_EQ(0u, w.report.usedOwnUv);
    EXPECT_EQ(0u, w.report.overlaps);
    EXPECT_EQ(0u, neverReached(w, firstReal(w)));
}

// Every triangle covers the whole unit square and is smaller than a texel: no texel centre shows
// the overlap, but the area exceeds the atlas.
TEST(MeshBake, RepacksStackedUvsBelowATexel) {
    Mesh mesh;
    for (int i = 0; i < 2000; ++i) {
        const double x = i % 50 * 0.01, y = i / 50 * 0.01;
        const uint32_t base = mesh.addVertex(x, y, 0, 0, 0);
        mesh.addVertex(x + 1e-3, y, 0, 1, 0);
        mesh.addVertex(x, y + 1e-3, 0, 0, 1);
        mesh.addTriangle(base, base + 1, base + 2);
    }
    const BurnDomain d = bakeOf(mesh.input());
    expectSound(d);
    EXPECT_EQ(0u, d.report.usedOwnUv);
    EXPECT_EQ(2000u, d.report.realTexels);
}

TEST(MeshBake, PackedChartsAreTwoTexelsApart) {
    Mesh mesh = makeCube(0.5, 4);
    mesh.uvs.clear();
    const BurnDomain d = bakeOf(mesh.input());
    expectSound(d);
    EXPECT_EQ(6u, d.report.charts);
    // A chart is a face here: its texels share a coordinate at the cube's side.
    const auto faceOf = [&](uint32_t i) {
        const uint16_t at[3] = {d.texels[i].x, d.texels[i].y, d.texels[i].z};
        const long top = std::lround(0.5 / double(d.quantum));
        for (int k = 0; k < 3; ++k) {
            if (at[k] == 0) return 2 * k;
            if (std::abs(at[k] - top) <= 1) return 2 * k + 1;
        }
        return -1;
    };
    uint32_t tooNear = 0;
    for (uint32_t i = 0; i < d.texelCount(); ++i) {
        if (!d.real(i)) continue;
        ASSERT_NE(-1, faceOf(i));
        const uint32_t x = i % d.width, y = i / d.width;
        ASSERT_TRUE(x >= 2 && y >= 2 && x + 2 < d.width && y + 2 < d.height);
        for (int dy = -2; dy <= 2; ++dy)
            for (int dx = -2; dx <= 2; ++dx) {
                const uint32_t j = uint32_t(int(i) + dy * int(d.width) + dx);
                tooNear += d.real(j) && faceOf(j) != faceOf(i);
            }
    }
    EXPECT_EQ(0u, tooNear);
}

TEST(MeshBake, LinksAreMutual) {
    for (const Mesh& mesh :
         {makeCube(1, 8), makeCube(1, 16, true), makeCylinder(0.2, 0.8, 96, 8, 4, true)}) {
        const BurnDomain d = bakeOf(mesh.input());
        uint32_t links = 0, oneWay = 0;
        for (uint32_t i = 0; i < d.texelCount(); ++i)
            for (uint32_t k = 0; d.real(i) && k < 8; ++k) {
                const uint32_t j = ringOf(d, i, k);
                if (j == kNone || !isRim(d, i)) continue;
                bool answered = false;
                for (uint32_t q = 0; q < 8; ++q) answered |= ringOf(d, j, q) == i;
                ++links;
                oneWay += !answered;
            }
        std::printf("[   FIGURE ] %u of %u rim links are one-way\n", oneWay, links);
        EXPECT_LT(oneWay, links / 5);
    }
}

TEST(MeshBake, AcceptsDegenerateAndNonManifoldTriangles) {
    Mesh mesh = makePlane(1, 1, 0, 1, 0, 4);
    const uint32_t whole = mesh.triangleCount();
    mesh.addTriangle(0, 0, 1);
    mesh.addTriangle(0, 1, 2);  // three points in a row: no area
    const uint32_t fin = mesh.addVertex(0.5, 0.5, 0.4, 3, 3);
    const uint32_t other = mesh.addVertex(0.5, 0.5, -0.4, 4, 3);
    mesh.addTriangle(12, 13, fin);  // two more sheets on an inner edge
    mesh.addTriangle(12, 13, other);
    const BurnDomain d = bakeOf(mesh.input(64));
    expectSound(d);
    EXPECT_EQ(2u, d.report.degenerate);
    EXPECT_EQ(whole + 2, d.report.triangles);
    EXPECT_EQ(1u, d.report.nonManifoldEdges);
}

// Small real files of Debian's assimp-testmodels, in local positions.
TEST(MeshBake, BakesInstalledTestModels) {
    const std::string folder = "/usr/share/assimp/models/glTF2/";
    uint32_t baked = 0;
    for (const char* name :
         {"BoxTextured-glTF-Binary/BoxTextured.glb", "BoxBadNormals-glTF-Binary/BoxBadNormals.glb",
          "2CylinderEngine-glTF-Binary/2CylinderEngine.glb",
          "BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb"}) {
        Mesh mesh;
        std::string error;
        if (!loadGlb(folder + name, mesh, error)) {
            std::printf("[   FIGURE ] not here: %s (%s)\n", name, error.c_str());
            continue;
        }
        SCOPED_TRACE(name);
        try {
            const BurnDomain d = mesh::bake(mesh.input(64, 512), std::pmr::new_delete_resource());
            expectSound(d);
            std::printf("[   FIGURE ] %s: %u triangles, %u charts, %u texels of %.2g m\n", name,
                        d.report.triangles, d.report.charts, d.report.realTexels,
                        double(d.texelSide));
            ++baked;
        } catch (const core::Error& refused) {
            std::printf("[   FIGURE ] %s is refused: %s\n", name, refused.message);
            EXPECT_TRUE(std::string(refused.message).find("finite") != std::string::npos);
        }
    }
    if (baked == 0) GTEST_SKIP() << "no models in " << folder;
}

// Shapes that are slow for careless loops: none may take longer than a large plain mesh.
TEST(MeshBake, AwkwardShapesStayFast) {
    std::vector<std::pair<const char*, Mesh>> meshes;
    Mesh needles;  // long, diagonal, thinner than a texel
    for (int i = 0; i < 2000; ++i) {
        const uint32_t base = needles.vertexCount();
        needles.addVertex(0, i * 1e-3, 0, 0, i * 1e-3);
        needles.addVertex(2, 2 + i * 1e-3, 0, 2, 2 + i * 1e-3);
        needles.addVertex(2, 2 + i * 1e-3 + 5e-4, 0, 2, 2 + i * 1e-3 + 5e-4);
        needles.addTriangle(base, base + 1, base + 2);
    }
    meshes.push_back({"needles", needles});
    needles.uvs.clear();
    meshes.push_back({"needles without UVs", needles});
    Mesh book;  // 1000 pages on one spine
    book.addVertex(0, 0, 0);
    book.addVertex(0, 0, 1);
    for (int i = 0; i < 1000; ++i) {
        const double a = i * 6.28 / 1000;
        book.addTriangle(0, 1, book.addVertex(std::cos(a), std::sin(a), 0.5));
    }
    meshes.push_back({"book", book});
    book.uvs.clear();
    meshes.push_back({"book without UVs", book});
    Mesh leaves = makeConfetti(1, 80, 0.01);  // 12,800 separate pieces at different heights
    for (size_t v = 0; v < leaves.vertexCount(); ++v)
        leaves.positions[v * 3 + 2] = float(v / 3) * 1e-3f;
    leaves.uvs.clear();
    meshes.push_back({"leaves", leaves});
    for (const auto& [name, mesh] : meshes) {
        SCOPED_TRACE(name);
        const std::clock_t start = std::clock();
        const BurnDomain d =
            bakeOf(mesh.input(128, rounds(1024u, mesh.triangleCount() > 5000 ? 512u : 256u)));
        const double milliseconds = 1000.0 * double(std::clock() - start) / CLOCKS_PER_SEC;
        expectSound(d);
        std::printf("[   FIGURE ] %s: %u triangles, %u charts, %u x %u, %.0f ms\n", name,
                    d.report.triangles, d.report.charts, d.width, d.height, milliseconds);
#ifdef NDEBUG
        if (!fw::test::kSanitized) {
            EXPECT_LE(milliseconds, 5000);
        }
#endif
    }
}

TEST(MeshBake, DensityIsLoweredToFit) {
    Mesh plane = makePlane(10, 10);
    const BurnDomain own = bakeOf(plane.input(128, 256));
    expectSound(own);
    EXPECT_LE(std::max(own.width, own.height), 256u);
    EXPECT_NEAR(252.0 / 10, 1 / double(own.texelSide), 0.1);
    plane.uvs.clear();
    const BurnDomain packed = bakeOf(plane.input(128, 256));
    expectSound(packed);
    EXPECT_LE(std::max(packed.width, packed.height), 256u);
    EXPECT_GT(1 / packed.texelSide, 22);
    for (uint32_t side : {8u, 9u, 16u, 4096u}) {
        const BurnDomain d = bakeOf(plane.input(128, side));
        expectSound(d);
        EXPECT_LE(std::max(d.width, d.height), side);
    }
}

TEST(MeshBake, AMeshSmallerThanATexelKeepsItsShape) {
    for (double density : {1.0, 1e-3, 1e-6}) {
        const Mesh mesh = makeCube(0.2, 2);
        const BurnDomain d = bakeOf(mesh.input(density));
        SCOPED_TRACE(density);
        expectSound(d);
        EXPECT_EQ(48u, d.report.triangles);
        EXPECT_GT(d.report.realTexels, 0u);
        EXPECT_LT(d.quantum, 0.001f);
        const auto bytes = mesh::writeCooked(d, 0, std::pmr::new_delete_resource());
        expectSound(mesh::readCooked(bytes, std::pmr::new_delete_resource()));
    }
}

TEST(MeshBake, BakesAreDeterministic) {
    std::vector<Mesh> meshes{makeCube(1, 8), makeSoup(3), makeConfetti(0.3, 10, 0.02)};
    meshes.push_back(makeCube(1, 16, true));
    meshes.back().uvs.clear();
    for (const Mesh& mesh : meshes) {
        mesh::BakeInput input = mesh.input(64);
        input.noiseAmplitude = 0.15f;
        std::pmr::monotonic_buffer_resource other;  // other addresses
        const BurnDomain a = bakeOf(input);
        const BurnDomain b = mesh::bake(input, &other);
        EXPECT_EQ(mesh::writeCooked(a, 1, std::pmr::new_delete_resource()),
                  mesh::writeCooked(b, 1, std::pmr::new_delete_resource()));
    }
}

}  // namespace
