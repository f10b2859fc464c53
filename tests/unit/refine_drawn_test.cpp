// Rasterised refined triangles never show the background at any edge levels. In integers as devices
// do it: 1/256 pixel, top-left rule.
#include "mesh/refine/table.h"
#include "support/refine_scene.h"
#include "support/sanitized.h"

#include <gtest/gtest.h>

#include <array>

namespace fw::test {
namespace {

constexpr int kWide = 192, kHigh = 144, kSub = 256;

using Point = std::array<int64_t, 2>;

// Triangles over each pixel's centre, front-facing and back-facing.
struct Layers {
    std::vector<uint16_t> front = std::vector<uint16_t>(kWide * kHigh);
    std::vector<uint16_t> back = front;

    void clear() {
        std::fill(front.begin(), front.end(), uint16_t(0));
        std::fill(back.begin(), back.end(), uint16_t(0));
    }

    void draw(Point a, Point b, Point c) {
        const int64_t area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if (area == 0) return;
        if (area < 0) std::swap(b, c);
        std::vector<uint16_t>& layer = area > 0 ? front : back;
        const Point corners[3] = {a, b, c};
        const auto cell = [](int64_t v, int most) {
            return std::clamp<int64_t>(v / kSub, 0, most - 1);
        };
        const int64_t left = cell(std::min({a[0], b[0], c[0]}), kWide);
        const int64_t right = cell(std::max({a[0], b[0], c[0]}), kWide);
        const int64_t low = cell(std::min({a[1], b[1], c[1]}), kHigh);
        const int64_t high = cell(std::max({a[1], b[1], c[1]}), kHigh);
        for (int64_t y = low; y <= high; ++y)
            for (int64_t x = left; x <= right; ++x) {
                const int64_t px = x * kSub + kSub / 2, py = y * kSub + kSub / 2;
                bool inside = true;
                for (size_t k = 0; k < 3 && inside; ++k) {
                    const Point &p = corners[k], &q = corners[(k + 1) % 3];
                    const int64_t dx = q[0] - p[0], dy = q[1] - p[1];
                    const int64_t side = dx * (py - p[1]) - dy * (px - p[0]);
                    inside = side > 0 || (side == 0 && (dy < 0 || (dy == 0 && dx > 0)));
                }
                if (inside) ++layer[size_t(y * kWide + x)];
            }
    }
};

// Position of a drawn slot: its rest position moved by its own amount, so that unmatched slots
// leave gaps.
glm::dvec3 placeOf(const mesh::RefineModel& model, uint32_t slot) {
    const gpu::RefineSlot& s = model.slots[slot];
    const auto part = [&](uint32_t salt) {
        return (double(gpu::hash32(slot * 3 + salt) & 0xFFFF) / 65535 - 0.5) * 0.02;
    };
    return {double(s.x) + part(0), double(s.y) + part(1), double(s.z) + part(2)};
}

// Orthographic; the view puts no point on a pixel's centre.
Point project(glm::dvec3 p) {
    const double u = 0.83 * p.x - 0.56 * p.z, v = -0.31 * p.x + 0.84 * p.y - 0.44 * p.z;
    return {std::llround((96.3 + 70.1 * u) * kSub), std::llround((92.7 + 70.1 * v) * kSub)};
}

void drawModel(const mesh::RefineModel& model, const mesh::RefineState& state, Layers& layers) {
    layers.clear();
    for (size_t i = 0; i < state.indices.size(); i += 3) {
        Point p[3];
        for (size_t k = 0; k < 3; ++k)
            p[k] = project(placeOf(model, model.draws[state.indices[i + k]].slot));
        layers.draw(p[0], p[1], p[2]);
    }
}

struct Gaps {
    uint32_t cracks = 0;   // pixels where the surface is not closed
    uint32_t covered = 0;  // pixels of the box
    uint32_t bare = 0;     // uncovered among those that a slightly smaller box covers
};

Gaps gapsOf(const Layers& layers, const Layers& core) {
    Gaps gaps;
    for (size_t i = 0; i < layers.front.size(); ++i) {
        gaps.cracks += layers.front[i] != layers.back[i];
        gaps.covered += layers.front[i] > 0;
        gaps.bare += core.front[i] > 0 && layers.front[i] == 0;
    }
    return gaps;
}

// A box of 0.9 of the size about the same middle.
Layers coreOf(const RefineScene& scene, glm::dvec3 middle) {
    Layers layers;
    for (size_t i = 0; i < scene.domain.indices.size(); i += 3) {
        Point p[3];
        for (size_t k = 0; k < 3; ++k) {
            const float* at = scene.domain.vertices[scene.domain.indices[i + k]].position;
            p[k] = project(middle + 0.9 * (glm::dvec3(at[0], at[1], at[2]) - middle));
        }
        layers.draw(p[0], p[1], p[2]);
    }
    return layers;
}

TEST(RefineDrawn, NoBackgroundShowsThroughABox) {
    RefineScene scene(gridBox(1.1, 0.9, 1.3, 1, 1, 1, 11), unsplit(5), 16);
    const Layers core = coreOf(scene, {0.55, 0.45, 0.65});
    mesh::RefineState state(scene.model, std::pmr::new_delete_resource());
    std::mt19937 random(21);
    Layers layers;
    size_t triangles = 0, covered = 0;
    const int sets = rounds(1000, 60);
    for (int k = 0; k < sets; ++k) {
        ASSERT_EQ(0u, randomLevels(scene.model, random, state));
        drawModel(scene.model, state, layers);
        const Gaps gaps = gapsOf(layers, core);
        ASSERT_EQ(0u, gaps.cracks) << "set " << k;
        ASSERT_EQ(0u, gaps.bare) << "set " << k;
        ASSERT_GT(gaps.covered, 8000u);
        triangles += state.indices.size() / 3;
        covered += gaps.covered;
    }
    std::printf("%d level sets: %zu triangles over %zu pixels, no background within\n", sets,
                triangles, covered);

    // The test must notice gaps: one level per triangle instead of per edge.
    for (size_t i = 0; i < scene.model.triangles.size(); ++i) {
        const uint32_t l = uint32_t(i) % 6;
        state.levels[i] = gpu::refinePack(l, l, l, l);
    }
    mesh::refineScan(scene.model, state);
    mesh::refineEmit(scene.model, state);
    drawModel(scene.model, state, layers);
    const uint32_t cracks = gapsOf(layers, core).cracks;
    EXPECT_GT(cracks, 20u);
    std::printf("with a level for each triangle: %u pixels gape\n", cracks);
}

}  // namespace
}  // namespace fw::test
