// Data of texels and drawn vertices: thickness, slowness, normals, details, queries.
#include <cstdio>
#include <random>

#include "unit/mesh_checks.h"

namespace {

using namespace fw;
using namespace fw::test;

// Decoded as the shaders do; 1 is 1023, 1023, 511.
std::array<double, 3> decode(uint32_t n) {
    return {double(int32_t(n << 21) >> 21) / 1023, double(int32_t(n << 10) >> 21) / 1023,
            double(int32_t(n) >> 22) / 511};
}

TEST(MeshThickness, CubeSphereAndSheet) {
    const Mesh cube = makeCube(0.1, 4);
    const BurnDomain c = bakeOf(cube.input(256));
    for (uint32_t i = 0; i < c.texelCount(); ++i)
        if (c.real(i)) {
            ASSERT_NEAR(1000, c.thickness[i], 1) << i;
        }

    const Mesh sphere = makeCube(0.2, 32, true);
    const BurnDomain s = bakeOf(sphere.input(256));
    for (uint32_t i = 0; i < s.texelCount(); ++i)
        if (s.real(i)) {
            ASSERT_NEAR(2000, s.thickness[i], 20) << i;
        }

    const Mesh sheet = makePlane(1, 1);
    const BurnDomain p = bakeOf(sheet.input(32));
    for (uint32_t i = 0; i < p.texelCount(); ++i) ASSERT_EQ(0xFFFF, p.thickness[i]) << i;
}

TEST(MeshThickness, TwoSheetsMeasureTheGap) {
    Mesh mesh = makePlane(0.5, 0.5);  // normals +z, and a second sheet 3 cm below
    const Mesh below = makePlane(0.5, 0.5);
    for (uint32_t v = 0; v < below.vertexCount(); ++v)
        mesh.addVertex(double(below.positions[v * 3]), double(below.positions[v * 3 + 1]), -0.03,
                       double(below.uvs[v * 2]) + 0.6, double(below.uvs[v * 2 + 1]));
    mesh.addTriangle(4, 6, 5);
    mesh.addTriangle(5, 6, 7);
    const BurnDomain d = bakeOf(mesh.input(64));
    uint32_t measured = 0;
    for (uint32_t i = 0; i < d.texelCount(); ++i)
        if (d.real(i) && d.thickness[i] != 0xFFFF) {
            ++measured;
            ASSERT_NEAR(300, d.thickness[i], 1);
        }
    EXPECT_GE(measured, d.report.realTexels * 95 / 100);
}

TEST(MeshSlowness, ExactlyOneWithoutNoise) {
    const Mesh mesh = makePlane(1, 1, 20);
    const BurnDomain d = bakeOf(mesh.input());
    for (uint32_t i = 0; i < d.texelCount(); ++i) ASSERT_EQ(d.real(i) ? 128 : 0, d.slowness[i]);
}

TEST(MeshSlowness, MeanCompensatesShortcuts) {
    const Mesh mesh = makePlane(2, 2, 20);
    mesh::BakeInput input = mesh.input();
    input.noiseAmplitude = 0.25f;
    const BurnDomain d = bakeOf(input);
    double sum = 0;
    uint32_t low = 65535, high = 0;
    for (uint32_t i = 0; i < d.texelCount(); ++i)
        if (d.real(i)) {
            sum += d.slowness[i];
            low = std::min<uint32_t>(low, d.slowness[i]);
            high = std::max<uint32_t>(high, d.slowness[i]);
        }
    // Features of 1.5 texels: two thirds of the way from the measured 1.024 to 1.037.
    EXPECT_NEAR(1.0327, sum / d.report.realTexels / 128, 0.004);
    EXPECT_GE(low, 128 * 1.03 * 0.75 - 1);
    EXPECT_LE(high, 128 * 1.04 * 1.25 + 1);
    EXPECT_GT(high - low, 40u);
    input.noiseSeed = 2;
    EXPECT_NE(d.slowness, bakeOf(input).slowness);
}

TEST(MeshSlowness, NoSeamShows) {  // the same points have the same noise under another unwrap
    const Mesh one = makeCylinder(0.2, 0.8, 96, 8, 1, false);
    const Mesh four = makeCylinder(0.2, 0.8, 96, 8, 4, true);
    mesh::BakeInput a = one.input(), b = four.input();
    a.noiseAmplitude = b.noiseAmplitude = 0.5f;
    a.noiseFeature = b.noiseFeature = 0.1f;
    const BurnDomain da = bakeOf(a), db = bakeOf(b);
    for (uint32_t i = 0; i < da.texelCount(); i += 7) {
        if (!da.real(i)) continue;
        float p[3];
        const uint16_t at[3] = {da.texels[i].x, da.texels[i].y, da.texels[i].z};
        for (int k = 0; k < 3; ++k) p[k] = da.origin[k] + float(at[k]) * da.quantum;
        const uint32_t j = mesh::nearestTexel(db, p, 0.02f);
        ASSERT_NE(kNone, j);
        ASSERT_NEAR(da.slowness[i], db.slowness[j], 14);  // half a texel away on a 13-texel feature
    }
}

TEST(MeshNormals, TexelsPointOutwards) {
    const Mesh mesh = makeCube(1, 32, true);
    const BurnDomain d = bakeOf(mesh.input(64));
    for (uint32_t i = 0; i < d.texelCount(); ++i) {
        if (!d.real(i)) continue;
        const auto n = decode(d.normals[i]);
        const uint16_t at[3] = {d.texels[i].x, d.texels[i].y, d.texels[i].z};
        double along = 0, length = 0;
        for (size_t k = 0; k < 3; ++k) {
            along += n[k] * (double(at[k]) * double(d.quantum) + double(d.origin[k])) * 2;
            length += n[k] * n[k];
        }
        ASSERT_NEAR(1, length, 0.004);
        ASSERT_GT(along, 0.99);
    }
}

TEST(MeshNormals, ComputedNormalsKeepCreases) {
    const Mesh cube = makeCube(1, 4);
    for (const mesh::RenderVertex& v : bakeOf(cube.input(32)).vertices) {
        const auto n = decode(v.normal);  // one axis is 1: faces meet at 90 degrees
        ASSERT_NEAR(1, std::max({std::abs(n[0]), std::abs(n[1]), std::abs(n[2])}), 0.003);
    }
    const Mesh sphere = makeCube(1, 16, true);
    for (const mesh::RenderVertex& v : bakeOf(sphere.input(32)).vertices) {
        const auto n = decode(v.normal);  // also across the seams of its six charts
        double along = 0;
        for (size_t k = 0; k < 3; ++k) along += n[k] * double(v.position[k]) * 2;
        ASSERT_GT(along, 0.995);
    }
}

TEST(MeshDrawn, KeepsTheGivenAttributes) {
    Mesh mesh = makePlane(1, 1);
    mesh.normals = {1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0};  // one has zero length
    const std::vector<float> details{0, 1, 2, 3, 4, 5, 6, 7};
    const std::vector<uint32_t> tints{1, 2, 3, 4};
    const std::vector<uint8_t> materials{0, 5};
    mesh::BakeInput input = mesh.input(32);
    input.details = details;
    input.tints = tints;
    input.triangleMaterials = materials;
    const BurnDomain d = bakeOf(input);
    expectSound(d);
    EXPECT_EQ(1u, d.hasDetail);
    EXPECT_EQ(6u, d.materialCount);
    ASSERT_EQ(6u, d.vertices.size()) << "corners of two materials are not shared";
    for (const mesh::RenderVertex& v : d.vertices) {
        const size_t source = v.tint - 1;
        EXPECT_EQ(details[source * 2 + 1], v.detail[1]);
        EXPECT_EQ(mesh.uvs[source * 2], v.textureUv[0]);
        EXPECT_EQ(mesh.positions[source * 3 + 1], v.position[1]);
        EXPECT_NEAR(source == 2 ? 0 : 1, decode(v.normal)[0], 0.002);
        EXPECT_NEAR(source == 2 ? 1 : 0, decode(v.normal)[2], 0.002) << "the face normal";
    }
    for (uint32_t i = 0; i < d.texelCount(); ++i)
        if (d.real(i)) {
            ASSERT_EQ(d.vertices[d.indices[d.triangleOf[i] * 3]].material,
                      d.texels[i].materialFlags & 0xFFu);
        }
}

TEST(MeshDrawn, AtlasUvsMapBackToTheTexelsPlace) {
    for (bool own : {true, false}) {
        Mesh mesh = makeCube(1, 8);
        if (!own) mesh.uvs.clear();
        const BurnDomain d = bakeOf(mesh.input(64));
        for (uint32_t i = 0; i < d.texelCount(); ++i) {
            if (!d.real(i) || (d.texels[i].materialFlags & mesh::kTexelForced)) continue;
            // Weights of the texel's centre in its drawn triangle give its rest position.
            const uint32_t* corner = &d.indices[d.triangleOf[i] * 3];
            const auto& a = d.vertices[corner[0]];
            const auto& b = d.vertices[corner[1]];
            const auto& c = d.vertices[corner[2]];
            const double x = i % d.width + 0.5 - double(a.atlasUv[0]);
            const double y = i / d.width + 0.5 - double(a.atlasUv[1]);
            const double bx = double(b.atlasUv[0] - a.atlasUv[0]);
            const double by = double(b.atlasUv[1] - a.atlasUv[1]);
            const double cx = double(c.atlasUv[0] - a.atlasUv[0]);
            const double cy = double(c.atlasUv[1] - a.atlasUv[1]);
            const double wb = (x * cy - y * cx) / (bx * cy - by * cx);
            const double wc = (bx * y - by * x) / (bx * cy - by * cx);
            const uint16_t at[3] = {d.texels[i].x, d.texels[i].y, d.texels[i].z};
            for (int k = 0; k < 3; ++k) {
                const double p = double(a.position[k]) +
                                 wb * double(b.position[k] - a.position[k]) +
                                 wc * double(c.position[k] - a.position[k]);
                ASSERT_NEAR(p, double(d.origin[k]) + at[k] * double(d.quantum), 1e-4);
            }
        }
    }
}

TEST(MeshQuery, AgreesWithBruteForce) {
    const Mesh mesh = makeCube(1, 16, true);
    const BurnDomain d = bakeOf(mesh.input(64));
    std::mt19937 random(1);
    const auto number = [&] { return float(random() % 2000) / 1000 - 1; };
    std::pmr::vector<uint32_t> found;
    for (int round = 0; round < 50; ++round) {
        const float point[3] = {number(), number(), number()};
        double nearest = 1e30;
        for (uint32_t i = 0; i < d.texelCount(); ++i) {
            if (!d.real(i)) continue;
            const uint16_t at[3] = {d.texels[i].x, d.texels[i].y, d.texels[i].z};
            double square = 0;
            for (int k = 0; k < 3; ++k) {
                const double e = double(d.origin[k]) + at[k] * double(d.quantum) - double(point[k]);
                square += e * e;
            }
            nearest = std::min(nearest, std::sqrt(square));
        }
        const uint32_t texel = mesh::nearestTexel(d, point, 10);
        ASSERT_NE(kNone, texel);
        EXPECT_EQ(kNone, mesh::nearestTexel(d, point, float(nearest) * 0.99f - 0.001f));
        EXPECT_EQ(texel, mesh::nearestTexel(d, point, float(nearest) + 2 * d.quantum));
        const float radius = float(random() % 100) / 500;
        mesh::texelsNear(d, point, radius, found);
        std::vector<uint32_t> expected;
        for (uint32_t i = 0; i < d.texelCount(); ++i)
            if (d.real(i) && linkMetres(d, i, texel) <= double(radius)) expected.push_back(i);
        EXPECT_NEAR(double(expected.size()), double(found.size()), 2 + expected.size() * 0.01);
        EXPECT_TRUE(std::find(found.begin(), found.end(), texel) != found.end());
        EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
    }
    const float nowhere[3] = {std::nanf(""), 1e30f, -1e30f};
    mesh::texelsNear(d, nowhere, std::nanf(""), found);
    EXPECT_EQ(1u, found.size()) << "the nearest at least";
    EXPECT_EQ(kNone, mesh::nearestTexel(d, nowhere, 1));
}

}  // namespace
