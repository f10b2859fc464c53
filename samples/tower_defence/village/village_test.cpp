// Checks what the fire requires of the kit: unique texels, one material per triangle, UVs inside
// the atlas.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "layout.h"

namespace {

using village::Model;
using village::Vec2;
using village::Vec3;

float cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }

// Texels of an n x n map whose centre lies strictly inside more than one triangle.
int sharedTexels(const Model& model, int n) {
    std::vector<bool> taken(size_t(n) * size_t(n), false);
    int shared = 0;
    for (size_t t = 0; t < model.indices.size(); t += 3) {
        const Vec2 a = model.vertices[model.indices[t]].uv;
        const Vec2 ab = model.vertices[model.indices[t + 1]].uv - a;
        const Vec2 ac = model.vertices[model.indices[t + 2]].uv - a;
        const float area = cross(ab, ac);
        if (std::fabs(area) < 1e-10f) continue;
        const float size = float(n);
        const int x0 = int((a.x + std::min({0.0f, ab.x, ac.x})) * size);
        const int x1 = std::min(n - 1, int((a.x + std::max({0.0f, ab.x, ac.x})) * size));
        const int y0 = int((a.y + std::min({0.0f, ab.y, ac.y})) * size);
        const int y1 = std::min(n - 1, int((a.y + std::max({0.0f, ab.y, ac.y})) * size));
        for (int y = std::max(0, y0); y <= y1; ++y) {
            for (int x = std::max(0, x0); x <= x1; ++x) {
                constexpr float kInside = 1e-3f;
                const Vec2 p{(float(x) + 0.5f) / size - a.x, (float(y) + 0.5f) / size - a.y};
                const float u = cross(p, ac) / area, v = cross(ab, p) / area;
                if (u < kInside || v < kInside || u + v > 1 - kInside) continue;
                const size_t texel = size_t(y) * size_t(n) + size_t(x);
                shared += taken[texel];
                taken[texel] = true;
            }
        }
    }
    return shared;
}

std::vector<Model> allModels() {
    village::Scene scene = village::makeVillage(1);
    std::vector<Model> models = std::move(scene.models);
    models.push_back(std::move(scene.terrain));
    models.push_back(std::move(scene.road));
    models.push_back(std::move(scene.water));
    return models;
}

TEST(Village, NoTwoTrianglesShareATexel) {
    for (const Model& model : allModels()) EXPECT_EQ(sharedTexels(model, 1024), 0) << model.name;
}

TEST(Village, SharedTexelsAreFound) {  // proves that the previous check can fail
    Model broken = village::makeKit()[size_t(village::Kit::kCottage)];
    for (size_t i = 0; i < broken.vertices.size() / 2; ++i) broken.vertices[i].uv.x += 0.05f;
    EXPECT_GT(sharedTexels(broken, 1024), 1000);
}

TEST(Village, EveryTriangleHasOneMaterial) {
    for (const Model& model : allModels()) {
        ASSERT_EQ(model.materials.size() * 3, model.indices.size()) << model.name;
        int mixed = 0;
        for (size_t i = 0; i < model.indices.size(); ++i)
            mixed += model.vertices[model.indices[i]].material != model.materials[i / 3];
        EXPECT_EQ(mixed, 0) << model.name;
    }
}

TEST(Village, UvsLieInsideTheAtlas) {
    for (const Model& model : allModels()) {
        int outside = 0;
        for (const village::Vertex& v : model.vertices)
            outside += !(v.uv.x >= 0 && v.uv.x <= 1 && v.uv.y >= 0 && v.uv.y <= 1);
        EXPECT_EQ(outside, 0) << model.name;
    }
}

TEST(Village, VerticesAreFiniteWithUnitNormals) {
    for (const Model& model : allModels()) {
        for (const village::Vertex& v : model.vertices) {
            const Vec3 p = v.position;
            ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
            ASSERT_NEAR(village::length(v.normal), 1.0f, 1e-3f) << model.name;
        }
        for (uint32_t i : model.indices) ASSERT_LT(i, model.vertices.size()) << model.name;
    }
}

// uv * atlasSide is in metres; only cones and blobs may be denser, at their poles
TEST(Village, TexelDensityStaysNearNominal) {
    double thin = 0, all = 0;
    for (const Model& model : village::makeKit()) {
        for (size_t t = 0; t < model.indices.size(); t += 3) {
            const village::Vertex& a = model.vertices[model.indices[t]];
            const village::Vertex& b = model.vertices[model.indices[t + 1]];
            const village::Vertex& c = model.vertices[model.indices[t + 2]];
            const float metres =
                village::length(village::cross(b.position - a.position, c.position - a.position));
            const float chart =
                std::fabs(cross(b.uv - a.uv, c.uv - a.uv)) * model.atlasSide * model.atlasSide;
            const float density = std::sqrt(chart / metres);
            all += metres;
            thin += density < 0.8f ? metres : 0;
            if (metres > 0.02f) {
                EXPECT_GT(density, 0.45f) << model.name;
            }
        }
    }
    EXPECT_LT(thin / all, 0.10);
}

TEST(Village, SameSeedSameVillage) {
    const village::Scene a = village::makeVillage(7), b = village::makeVillage(7);
    const village::Scene other = village::makeVillage(8);
    ASSERT_EQ(a.instances.size(), b.instances.size());
    for (size_t i = 0; i < a.instances.size(); ++i) {
        EXPECT_EQ(a.instances[i].frame.origin.x, b.instances[i].frame.origin.x);
        EXPECT_EQ(a.instances[i].seed, b.instances[i].seed);
    }
    EXPECT_NE(a.instances.back().seed, other.instances.back().seed);
}

// From afar, everything is in view without fine parts; from near, most is out of view.
TEST(Village, DrawnTrianglesKeepToTheGuide) {
    constexpr int kGuide = 20000;
    const village::Scene scene = village::makeVillage(1);
    const int land =
        scene.terrain.triangleCount() + scene.road.triangleCount() + scene.water.triangleCount();
    int afar = land, whole = land;
    for (const village::Instance& instance : scene.instances) {
        const Model& model = scene.models[size_t(instance.model)];
        EXPECT_LE(model.farTriangles, model.triangleCount());
        EXPECT_GT(model.farTriangles, model.triangleCount() * 2 / 5) << model.name;
        afar += model.farTriangles;
        whole += model.triangleCount();
    }
    std::printf("village: %zu instances, %d triangles, %d from afar\n", scene.instances.size(),
                whole, afar);
    EXPECT_LT(afar, kGuide);
    EXPECT_LT(whole, kGuide * 11 / 10);
}

}  // namespace
