// Welds vertices, drops triangles without area, pairs the triangles at edges.
#include "mesh/surface.h"

#include "core/error.h"

#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

namespace fw::mesh {
namespace {

constexpr double kExtentLow = 1e-4, kExtentHigh = 1e5;  // m, longest side of a mesh
constexpr double kUvTouch = 1e-3;    // texels: corners closer than this are one corner
constexpr size_t kPairSearch = 256;  // candidates per edge; only absurd fans have more triangles

glm::dvec3 positionOf(const BakeInput& input, uint32_t vertex) {
    const float* p = &input.positions[size_t(vertex) * 3];
    return {p[0], p[1], p[2]};
}

uint64_t cellHash(int64_t x, int64_t y, int64_t z) {
    uint64_t h = uint64_t(x) * 0x9E3779B97F4A7C15ull;
    h = (h ^ (h >> 29) ^ uint64_t(y)) * 0xBF58476D1CE4E5B9ull;
    h = (h ^ (h >> 32) ^ uint64_t(z)) * 0x94D049BB133111EBull;
    return h ^ (h >> 31);
}

// Point of every vertex: vertices closer than `distance` to an earlier point share it.
uint32_t weld(const BakeInput& input, double distance, std::pmr::vector<uint32_t>& pointOf,
              std::pmr::memory_resource* memory) {
    const uint32_t vertices = uint32_t(input.positions.size() / 3);
    FW_ASSERT(distance > 0 && vertices > 0, "%u vertices, %g m", vertices, distance);
    const uint32_t buckets = std::max(64u, std::bit_ceil(vertices));
    std::pmr::vector<uint32_t> head(buckets, kNone, memory);
    std::pmr::vector<uint32_t> next(memory), first(memory);  // per point; first = its vertex
    next.reserve(vertices);
    first.reserve(vertices);
    pointOf.assign(vertices, kNone);
    for (uint32_t v = 0; v < vertices; ++v) {
        const glm::dvec3 p = positionOf(input, v);
        const glm::dvec3 cell = glm::floor(p / (2 * distance));
        const auto headAt = [&](int64_t dx, int64_t dy, int64_t dz) -> uint32_t& {
            return head[cellHash(int64_t(cell.x) + dx, int64_t(cell.y) + dy, int64_t(cell.z) + dz) &
                        (buckets - 1)];
        };
        uint32_t found = kNone;  // the lowest point in reach, whatever the order of the hash
        for (int d = 0; d < 27; ++d)
            for (uint32_t q = headAt(d % 3 - 1, d / 3 % 3 - 1, d / 9 - 1); q != kNone; q = next[q])
                if (q < found && glm::length(positionOf(input, first[q]) - p) < distance) found = q;
        if (found == kNone) {
            found = uint32_t(first.size());
            first.push_back(v);
            next.push_back(std::exchange(headAt(0, 0, 0), found));
        }
        pointOf[v] = found;
    }
    return uint32_t(first.size());
}

bool near(glm::dvec2 a, glm::dvec2 b) { return glm::length(a - b) < kUvTouch; }

struct Fit {
    bool continuous, opposite;
    int score() const { return continuous * 2 + opposite; }
};
Fit fitOf(const Surface& surface, const EdgeUse& a, const EdgeUse& b, bool uvMeaningful) {
    const Triangle& ta = surface.triangles[a.triangle];
    const Triangle& tb = surface.triangles[b.triangle];
    const uint32_t a1 = (a.side + 1) % 3, b1 = (b.side + 1) % 3;
    const bool opposite = ta.point[a.side] == tb.point[b1];
    const glm::dvec2 start = tb.uv[opposite ? b1 : b.side], end = tb.uv[opposite ? b.side : b1];
    // The two sheets must also lie on different sides of the edge in the atlas.
    const bool sides = (uvArea(ta) > 0) == (opposite == (uvArea(tb) > 0));
    FW_ASSERT(a.sameEdge(b) && a.triangle != b.triangle);
    return {uvMeaningful && sides && near(ta.uv[a.side], start) && near(ta.uv[a1], end), opposite};
}

}  // namespace

glm::dvec3 Faces::offset() const {
    FW_ASSERT(weight > 0, "weight %g", weight);
    const glm::dvec3 mean = sum / weight;
    const double square = glm::dot(mean, mean);
    if (square < 1e-6) return glm::dvec3(0);
    const glm::dvec3 guess = -mean / std::max(square, 0.25);
    const double little = 1e-3 * weight;
    const glm::dvec3 o = glm::inverse(squares + glm::dmat3(little)) * (guess * little - sum);
    const double length = glm::length(o);
    return length > kLongestOffset ? o * (kLongestOffset / length) : o;
}

Extent2 extentOf(const Surface& surface, std::span<const uint32_t> members) {
    Extent2 extent;
    for (const uint32_t i : members)
        if (surface.triangles[i].chart != kNone) extent.add(surface.triangles[i]);
    return extent;
}

RowSpan rowsOf(const Triangle& t, int height) {
    const double low = std::min({t.uv[0].y, t.uv[1].y, t.uv[2].y});
    const double high = std::max({t.uv[0].y, t.uv[1].y, t.uv[2].y});
    return {std::max(0, int(std::floor(low))), std::min(height - 1, int(std::floor(high)))};
}

RowSpan rowSpan(const Triangle& t, int y, int width) {
    FW_ASSERT(width > 0 && y >= 0, "row %d of %d columns", y, width);
    double low = 1e300, high = -1e300;
    for (int e = 0; e < 3; ++e) {
        glm::dvec2 a = t.uv[e], b = t.uv[(e + 1) % 3];
        if (a.y > b.y) std::swap(a, b);
        if (b.y < y || a.y > y + 1) continue;
        const double slope = b.y > a.y ? (b.x - a.x) / (b.y - a.y) : 0;
        const double enter = a.y >= y ? a.x : a.x + (y - a.y) * slope;
        const double leave = b.y <= y + 1 ? b.x : a.x + (y + 1 - a.y) * slope;
        low = std::min({low, enter, leave});
        high = std::max({high, enter, leave});
    }
    if (low > high) return {};
    constexpr double kSlack = 1e-6;  // texels, above the rounding
    return {std::max(0, int(std::floor(low - kSlack))),
            std::min(width - 1, int(std::floor(high + kSlack)))};
}

bool weightsAt(const Triangle& t, glm::dvec2 uv, glm::dvec3& weights) {
    const double area = cross2(t.uv[1] - t.uv[0], t.uv[2] - t.uv[0]);
    if (std::abs(area) < 1e-12) return false;
    weights.x = cross2(t.uv[1] - uv, t.uv[2] - uv) / area;
    weights.y = cross2(t.uv[2] - uv, t.uv[0] - uv) / area;
    weights.z = 1 - weights.x - weights.y;
    return true;
}

TexelShape texelShape(const Triangle& t) {
    TexelShape shape;
    const glm::dvec2 e1 = t.uv[1] - t.uv[0], e2 = t.uv[2] - t.uv[0];
    const double determinant = cross2(e1, e2);
    if (std::abs(determinant) < 1e-9) return shape;
    const glm::dvec3 a = t.position[1] - t.position[0], b = t.position[2] - t.position[0];
    shape.alongU = (a * e2.y - b * e1.y) / determinant;
    shape.alongV = (b * e1.x - a * e2.x) / determinant;
    const double uu = glm::dot(shape.alongU, shape.alongU);
    const double uv = glm::dot(shape.alongU, shape.alongV);
    const double vv = glm::dot(shape.alongV, shape.alongV);
    const double root = std::sqrt((uu - vv) * (uu - vv) / 4 + uv * uv);
    shape.longer = std::sqrt((uu + vv) / 2 + root);
    // area per texel / longer: stable where the difference of squares is not
    shape.shorter = t.area / std::abs(determinant * 0.5) / std::max(shape.longer, 1e-300);
    shape.usable = true;
    return shape;
}

Surface collectSurface(const BakeInput& input, double weldDistance,
                       std::pmr::memory_resource* memory) {
    Surface surface(memory);
    const size_t count = input.indices.size() / 3;
    surface.low = glm::dvec3(1e300);
    surface.high = glm::dvec3(-1e300);
    for (uint32_t index : input.indices) {
        surface.low = glm::min(surface.low, positionOf(input, index));
        surface.high = glm::max(surface.high, positionOf(input, index));
    }
    const glm::dvec3 size = surface.high - surface.low;
    surface.extent = std::max({size.x, size.y, size.z});
    if (!(surface.extent >= kExtentLow && surface.extent <= kExtentHigh))
        core::refuse("The mesh's longest side is " FW_LENGTH " " FW_LENGTH_UNIT
                     "; it must lie in [" FW_LENGTH ", " FW_LENGTH "] " FW_LENGTH_UNIT ".",
                     surface.extent, kExtentLow, kExtentHigh);

    std::pmr::vector<uint32_t> pointOf(memory);
    // Never finer than positions can tell apart, never so coarse that the shape goes.
    const double distance =
        std::clamp(weldDistance, surface.extent / 131070, surface.extent / 8192);
    FW_ASSERT(input.indices.size() % 3 == 0, "%zu indices", input.indices.size());
    surface.pointCount = weld(input, distance, pointOf, memory);
    surface.triangles.reserve(count);
    for (size_t i = 0; i < count; ++i) {
        Triangle t;
        t.source = uint32_t(i);
        for (int k = 0; k < 3; ++k) {
            t.corner[k] = input.indices[i * 3 + size_t(k)];
            t.point[k] = pointOf[t.corner[k]];
            t.position[k] = positionOf(input, t.corner[k]);
            if (!input.uvs.empty())
                t.uv[k] = {input.uvs[size_t(t.corner[k]) * 2],
                           input.uvs[size_t(t.corner[k]) * 2 + 1]};
        }
        const glm::dvec3 across =
            glm::cross(t.position[1] - t.position[0], t.position[2] - t.position[0]);
        t.area = 0.5 * glm::length(across);
        if (t.point[0] == t.point[1] || t.point[1] == t.point[2] || t.point[2] == t.point[0] ||
            t.area < 1e-16 * surface.extent * surface.extent) {
            ++surface.report.degenerate;
            continue;
        }
        t.normal = across / (2 * t.area);
        if (!input.triangleMaterials.empty()) t.material = input.triangleMaterials[i];
        surface.area += t.area;
        surface.triangles.push_back(t);
    }
    if (surface.triangles.empty())
        core::refuse(
            "The mesh's area is 0 m^2: all %zu triangles are degenerate; at least 1 must have "
            "area.",
            count);
    return surface;
}

void pairEdges(Surface& surface, bool uvMeaningful) {
    auto& triangles = surface.triangles;
    BakeReport& report = surface.report;
    report.openEdges = report.nonManifoldEdges = report.seamEdges = surface.chartCount = 0;
    for (Triangle& t : triangles) {
        FW_ASSERT(std::max({t.point[0], t.point[1], t.point[2]}) < surface.pointCount,
                  "points %u, %u, %u of %u", t.point[0], t.point[1], t.point[2],
                  surface.pointCount);
        std::fill_n(t.neighbour, 3, kNone);
        std::fill_n(t.seam, 3, false);
    }
    const std::pmr::vector<EdgeUse> uses = sortedUses(triangles, surface.memory);

    std::pmr::vector<uint32_t> parent(triangles.size(), surface.memory);
    std::iota(parent.begin(), parent.end(), 0u);
    std::pmr::vector<uint8_t> used(uses.size(), 0, surface.memory);
    for (size_t start = 0, end = 0; start < uses.size(); start = end) {
        while (end < uses.size() && uses[start].sameEdge(uses[end])) ++end;
        report.nonManifoldEdges += end - start > 2;
        for (size_t i = start; i < end; ++i) {
            if (used[i]) continue;
            size_t best = end;
            Fit bestFit{};
            for (size_t j = i + 1; j < std::min(end, i + kPairSearch); ++j) {
                if (used[j] || uses[j].triangle == uses[i].triangle) continue;
                const Fit fit = fitOf(surface, uses[i], uses[j], uvMeaningful);
                if (best != end && fit.score() <= bestFit.score()) continue;
                best = j;
                bestFit = fit;
            }
            if (best == end) {
                ++report.openEdges;
                continue;
            }
            used[i] = used[best] = 1;
            const EdgeUse &a = uses[i], &b = uses[best];
            for (const auto& [mine, other] : {std::pair(a, b), std::pair(b, a)}) {
                Triangle& t = triangles[mine.triangle];
                t.neighbour[mine.side] = other.triangle;
                t.neighbourEdge[mine.side] = uint8_t(other.side);
                t.seam[mine.side] = !bestFit.continuous;
            }
            if (bestFit.continuous)
                parent[rootOf(parent, a.triangle)] = rootOf(parent, b.triangle);
            else
                ++report.seamEdges;
        }
    }
    std::pmr::vector<uint32_t> number(triangles.size(), kNone, surface.memory);
    for (uint32_t i = 0; i < triangles.size(); ++i) {
        uint32_t& n = number[rootOf(parent, i)];
        if (n == kNone) n = surface.chartCount++;
        triangles[i].chart = n;
    }
}

}  // namespace fw::mesh
