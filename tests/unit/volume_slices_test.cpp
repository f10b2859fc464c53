// The sliced lattice of the reference implementation: polygons of planes and hexahedra, and the sum
// over slices.
#include "volume_scene.h"

#include "reference/volume_slices.h"

#include <gtest/gtest.h>

namespace {

using namespace volume_scene;
namespace gpu = fw::gpu;

float areaOf(const Shown& flame, uint32_t piece, vec3 eye, vec3 forward, float depth) {
    const gpu::FlameNode& a = flame.nodes[gpu::flameNodeOf(piece)];
    const gpu::FlameNode& b = flame.nodes[gpu::flameNodeOf(piece + 1)];
    vec3 corner[gpu::kSliceVertices];
    for (uint32_t v = 0; v < gpu::kSliceVertices; ++v) {
        const gpu::SlicePoint point =
            gpu::sliceVertex(flame.record, a, b, eye, forward, depth, gpu::sliceFan(v));
        if (point.corners == 0) return 0;
        EXPECT_LE(point.corners, gpu::kSliceCorners);
        EXPECT_NEAR(glm::dot(point.at - eye, forward), depth, 1e-4f) << "off the plane";
        corner[v] = point.at;
    }
    float area = 0;
    for (uint32_t t = 0; t < gpu::kSliceVertices; t += 3) {
        const float signedArea =
            0.5f *
            glm::dot(glm::cross(corner[t + 1] - corner[t], corner[t + 2] - corner[t]), forward);
        // All triangles of a fan have one orientation only if the polygon is convex and in order.
        EXPECT_GE(signedArea * (area < 0 ? -1.0f : area > 0 ? 1.0f : signedArea), -1e-6f);
        area += signedArea;
    }
    return std::abs(area);
}

// A hexahedron as six tetrahedra around its diagonal.
float volumeOf(const Shown& flame, uint32_t piece) {
    const gpu::FlameNode& a = flame.nodes[gpu::flameNodeOf(piece)];
    const gpu::FlameNode& b = flame.nodes[gpu::flameNodeOf(piece + 1)];
    vec3 c[8];
    for (uint32_t k = 0; k < 4; ++k) {
        c[k] = gpu::sliceCorner(a, gpu::sliceReach(flame.record, a), k);
        c[k + 4] = gpu::sliceCorner(b, gpu::sliceReach(flame.record, b), k);
    }
    constexpr uint32_t kAround[6] = {1, 2, 3, 7, 4, 5};
    float sum = 0;
    for (uint32_t i = 0; i < 6; ++i)
        sum += std::abs(glm::dot(c[kAround[i]] - c[0],
                                 glm::cross(c[kAround[(i + 1) % 6]] - c[0], c[6] - c[0]))) /
               6;
    return sum;
}

TEST(VolumeSlices, FillTheLattice) {
    Shown flame = Shown::preset(FlamePreset::CampFire);
    flame.record.smoke = 0;
    const vec3 eye(1.3f, 0.7f, 4.0f), forward = glm::normalize(vec3(-0.31f, 0.11f, -1.0f));
    constexpr float kApart = 0.002f;
    for (uint32_t piece = 0; piece < gpu::kFlamePieces; ++piece) {
        float sum = 0;
        for (float depth = 1; depth < 8; depth += kApart)
            sum += kApart * areaOf(flame, piece, eye, forward, depth);
        EXPECT_NEAR(sum / volumeOf(flame, piece), 1.0f, 0.01f) << "piece " << piece;
    }
}

// A slice's sample stands for the span to the next one, so the number of slices does not change the
// brightness.
TEST(VolumeSlices, BrightnessIsIndependentOfTheirSpacing) {
    Shown flame = Shown::preset(FlamePreset::CampFire);
    gpu::FlameRecord& r = flame.record;
    r.smoke = r.turbulence = r.radial = r.warp = r.columns = r.filament = r.erode = r.puff = 0;
    const auto light = [&](uint32_t slices) {
        constexpr float kNear = 2, kFar = 4;
        const float apart = (kFar - kNear) / float(slices);
        double sum = 0;
        for (uint32_t i = 0; i < 20 * 30; ++i) {
            const vec3 from(0.06f * (float(i % 20) - 9.5f), 0.03f * (float(i / 20) + 0.5f), 3.0f);
            const vec3 direction(0, 0, -1);
            gpu::FlameRay ray{vec3(0.0f), vec3(1.0f)};
            for (uint32_t k = 0; k < slices; ++k) {
                const vec3 x = from + direction * (kNear + apart * (float(k) + 0.5f));
                for (uint32_t piece = 0; piece < gpu::kFlamePieces; ++piece) {
                    const gpu::FlameNode& a = flame.nodes[gpu::flameNodeOf(piece)];
                    const gpu::FlameNode& b = flame.nodes[gpu::flameNodeOf(piece + 1)];
                    if (gpu::flamePlane(x, a) < 0 || gpu::flamePlane(x, b) >= 0) continue;
                    const gpu::FlamePlace at = gpu::slicePlace(a, b, x);
                    ray = gpu::flameStep(ray, sampleFlame(r, *flame.profile, at, 0.01f, false),
                                         vec3(0.0f), apart);
                }
            }
            sum += double(ray.radiance.x);
        }
        return sum;
    };
    const double exact = light(400);
    ASSERT_GT(exact, 1);
    for (const uint32_t slices : {32u, 48u, 64u, 96u})
        EXPECT_NEAR(light(slices) / exact, 1.0, 0.02) << slices << " slices";
}

}  // namespace
