// The curve of a volumetric flame: spline, arc length, frames, bisector coordinates, degenerate
// curves.
#include "volume/curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace {

using namespace fw::volume;
using fw::gpu::FlameNode;
using fw::gpu::kFlameNodes;

const vec3 kUp(0.0f, 1.0f, 0.0f);

FlameNodes nodesOf(const std::vector<ControlPoint>& points, float length) {
    Curve curve;
    curve.set(points, kUp);
    FlameNodes nodes;
    placeFlameNodes(curve, length, nodes);
    return nodes;
}

void expectSoundNodes(const FlameNodes& nodes) {
    for (size_t k = 0; k < nodes.size(); ++k) {
        const FlameNode& n = nodes[k];
        for (int c = 0; c < 4; ++c) {
            ASSERT_TRUE(std::isfinite(n.centre[c])) << "node " << k;
            ASSERT_TRUE(std::isfinite(n.along[c])) << "node " << k;
            ASSERT_TRUE(std::isfinite(n.side[c])) << "node " << k;
        }
        ASSERT_GE(n.centre.w, 0.0f) << "node " << k;
        ASSERT_NEAR(glm::length(vec3(n.along)), 1.0f, 1e-4f) << "node " << k;
        ASSERT_NEAR(glm::length(vec3(n.side)), 1.0f, 1e-4f) << "node " << k;
        ASSERT_NEAR(glm::dot(vec3(n.along), vec3(n.side)), 0.0f, 1e-4f) << "node " << k;
    }
}

std::vector<ControlPoint> helix(float radius, float pitch, int points) {
    std::vector<ControlPoint> out;
    for (int k = 0; k < points; ++k) {
        const float a = 0.4f * float(k);
        out.push_back({{radius * std::cos(a), pitch * a, radius * std::sin(a)}, 0.1f});
    }
    return out;
}

TEST(VolumeCurve, StartsAtTheBaseAndEndsAtTheLastPoint) {
    const std::vector<ControlPoint> points{{{1, 0, 2}, 0.3f},
                                           {{1.1f, 0.5f, 2}, 0.2f},
                                           {{1.4f, 1.0f, 2.2f}, 0.2f},
                                           {{2, 1.5f, 2}, 0.1f}};
    Curve curve;
    curve.set(points, kUp);
    EXPECT_NEAR(glm::length(curve.at(0).position - points[0].position), 0.0f, 1e-5f);
    EXPECT_NEAR(glm::length(curve.at(curve.length()).position - points[3].position), 0.0f, 1e-5f);
    EXPECT_NEAR(curve.at(0).radius, 0.3f, 0.02f);
    // The curve continues straight beyond its end.
    const CurveSample end = curve.at(curve.length()), beyond = curve.at(curve.length() + 0.5f);
    EXPECT_NEAR(glm::length(beyond.position - end.position - 0.5f * end.tangent), 0.0f, 1e-5f);
}

TEST(VolumeCurve, ArcLengthMatchesAFinePolyline) {
    const auto points = helix(0.5f, 0.2f, 20);
    Curve curve;
    curve.set(points, kUp);
    double fine = 0;
    vec3 before = curve.at(0).position;
    constexpr int kPieces = 20000;
    float longest = 0, shortest = 1e9f;
    for (int k = 1; k <= kPieces; ++k) {
        const vec3 here = curve.at(curve.length() * float(k) / kPieces).position;
        const float piece = glm::length(here - before);
        fine += piece, before = here;
        longest = std::max(longest, piece), shortest = std::min(shortest, piece);
    }
    EXPECT_NEAR(curve.length() / fine, 1.0, 1e-3);
    EXPECT_LT(longest / shortest, 1.2f) << "equal steps of s are equal steps along the curve";
}

TEST(VolumeCurve, FramesDoNotTwistOnAHelix) {
    const FlameNodes nodes = nodesOf(helix(0.5f, 0.25f, 20), 3.0f);
    expectSoundNodes(nodes);
    for (size_t k = 0; k + 1 < nodes.size(); ++k) {
        // The side turned by the least rotation between the tangents.
        const vec3 a = vec3(nodes[k].along), b = vec3(nodes[k + 1].along), axis = glm::cross(a, b);
        const float c = glm::dot(a, b);
        const vec3 s = vec3(nodes[k].side);
        const vec3 turned = s * c + glm::cross(axis, s) + axis * (glm::dot(axis, s) / (1.0f + c));
        const float twist = std::acos(std::min(1.0f, glm::dot(turned, vec3(nodes[k + 1].side))));
        EXPECT_LT(glm::degrees(twist), 1.0f) << "segment " << k;
    }
}

TEST(VolumeCurve, DegenerateCurvesGiveFiniteNumbers) {
    const float r = 0.3f;
    const std::vector<std::vector<ControlPoint>> curves{
        {},
        {{{1, 2, 3}, r}},
        {{{1, 2, 3}, 0}},
        {{{0, 0, 0}, r}, {{0, 0, 0}, r}},
        std::vector<ControlPoint>(16, {{5, 5, 5}, r}),
        {{{0, 0, 0}, r}, {{0, 1, 0}, r}, {{0, 2, 0}, r}, {{0, 3, 0}, r}},  // collinear
        {{{0, 0, 0}, r}, {{0, 1, 0}, r}, {{0, 0, 0}, r}, {{0, 1, 0}, r}},  // back and forth
        {{{0, 0, 0}, r}, {{0, 0, 0}, r}, {{0, 0, 0}, r}, {{0, 1, 0}, r}},  // triple base
        {{{0, 0, 0}, r}, {{1, 0, 0}, r}, {{1, 1, 0}, r}, {{0, 1, 0}, r}, {{0, 0, 0}, r}},  // closed
        {{{0, 0, 0}, 0}, {{0, 1, 0}, 0}, {{0, 2, 0}, 0}},    // no radius
        {{{0, 0, 0}, r}, {{0, -1, 0}, r}, {{0, -2, 0}, r}},  // down
        {{{0, 0, 0}, r}, {{1e-5f, 0, 0}, r}, {{0, 1e-5f, 0}, r}},
        {{{1e5f, 0, 0}, r}, {{1e5f, 1, 0}, r}, {{1e5f, 2, 1}, r}},
        helix(0.05f, 0.001f, 32),
        std::vector<ControlPoint>(40, {{0, 1, 0}, r}),  // more points than the limit
    };
    for (size_t k = 0; k < curves.size(); ++k)
        for (const float length : {0.0f, 1e-6f, 0.5f, 20.0f}) {
            SCOPED_TRACE("curve " + std::to_string(k));
            const FlameNodes nodes = nodesOf(curves[k], length);
            expectSoundNodes(nodes);
            for (const vec3 p : {vec3(0), vec3(1, 2, 3), vec3(0, 0.5f, 0.1f), vec3(1e5f, 1, 0)}) {
                const auto at = locate(nodes, p);
                if (!at) continue;
                EXPECT_TRUE(std::isfinite(at->place.s) && std::isfinite(at->rho) &&
                            std::isfinite(at->angle));
            }
        }
    // S-shaped and random curves of every size.
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
    for (int k = 0; k < 400; ++k) {
        std::vector<ControlPoint> points(size_t(2 + k % 20));
        const float size = std::pow(10.0f, float(k % 7) - 3.0f);
        for (ControlPoint& p : points)
            p = {size * vec3(unit(random), unit(random), unit(random)),
                 size * std::abs(unit(random))};
        expectSoundNodes(nodesOf(points, size * 3.0f));
    }
}

TEST(VolumeCurve, PlanesDoNotIntersectInsideTheTube) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<ControlPoint> points;
        vec3 p(0);
        for (int k = 0; k < 8; ++k) {
            points.push_back({p, 0.6f});
            p += vec3(0.25f * unit(random), 0.15f + 0.1f * unit(random), 0.25f * unit(random));
        }
        const FlameNodes nodes = nodesOf(points, 1.5f);
        for (size_t k = 0; k + 1 < nodes.size(); ++k)
            for (int a = 0; a < 12; ++a) {
                const float angle = 0.5236f * float(a);
                const auto rim = [&](const FlameNode& n) {
                    const vec3 t(n.along), s(n.side);
                    return vec3(n.centre) +
                           fw::gpu::kFlameReach * n.centre.w *
                               (std::cos(angle) * s + std::sin(angle) * glm::cross(t, s));
                };
                EXPECT_LE(fw::gpu::flamePlane(rim(nodes[k]), nodes[k + 1]), 1e-4f);
                EXPECT_GE(fw::gpu::flamePlane(rim(nodes[k + 1]), nodes[k]), -1e-4f);
            }
    }
}

TEST(VolumeCurve, LocateInvertsTheCurve) {
    Curve curve;
    const std::vector<ControlPoint> points{{{0, 0, 0}, 0.2f},
                                           {{0.1f, 0.4f, 0}, 0.2f},
                                           {{0.3f, 0.8f, 0.1f}, 0.18f},
                                           {{0.7f, 1.1f, 0.2f}, 0.15f},
                                           {{1.2f, 1.3f, 0.2f}, 0.1f}};
    curve.set(points, kUp);
    FlameNodes nodes;
    placeFlameNodes(curve, curve.length(), nodes);
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    for (int k = 0; k < 2000; ++k) {
        const uint32_t i = uint32_t(unit(random) * float(kFlameNodes - 1));
        const float w = unit(random), rho = unit(random), angle = 6.2831f * unit(random) - 3.14159f;
        const FlameNode &a = nodes[i], &b = nodes[i + 1];
        const vec3 centre = glm::mix(vec3(a.centre), vec3(b.centre), w);
        const float radius = glm::mix(a.centre.w, b.centre.w, w);
        const vec3 t = glm::normalize(glm::mix(vec3(a.along), vec3(b.along), w));
        const vec3 s = glm::normalize(glm::mix(vec3(a.side), vec3(b.side), w));
        const vec3 x =
            centre + rho * radius * (std::cos(angle) * s + std::sin(angle) * glm::cross(t, s));
        const auto at = locate(nodes, x);
        if (i == 0 && !at) continue;  // just below the base plane
        ASSERT_TRUE(at) << i << " " << w;
        EXPECT_NEAR(at->place.s, glm::mix(a.along.w, b.along.w, w), 0.02f);
        EXPECT_NEAR(at->rho, rho, 0.06f);
        if (rho > 0.2f) {
            const float off = std::remainder(at->angle - angle, 6.2831853f);
            EXPECT_NEAR(off, 0.0f, 0.12f);
        }
    }
    EXPECT_FALSE(locate(nodes, vec3(0, -0.1f, 0)));
    EXPECT_FALSE(locate(nodes, vec3(5, 2, 0)));
}

TEST(VolumeCurve, CoordinatesAreContinuousAcrossPlanes) {
    const FlameNodes nodes = nodesOf(helix(0.6f, 0.3f, 16), 3.0f);
    const FlameNode &a = nodes[9], &b = nodes[10], &c = nodes[11];
    const vec3 x = vec3(b.centre) + 0.5f * b.centre.w * vec3(b.side);
    const auto before = fw::gpu::flamePlaceAt(x, a, b, fw::gpu::flamePlane(x, a), -1e-9f);
    const auto after = fw::gpu::flamePlaceAt(x, b, c, 0.0f, fw::gpu::flamePlane(x, c));
    EXPECT_NEAR(before.s, after.s, 1e-4f);
    EXPECT_NEAR(before.radius, after.radius, 1e-4f);
    EXPECT_NEAR(glm::length(before.p - after.p), 0.0f, 1e-4f);
}

}  // namespace
