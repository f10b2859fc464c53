// Our own charts: discs grown over neighbours with similar normals, flattened by projection. A
// plane keeps stretch under 2 : 1 by its angle alone, so no minimisation is needed. The front
// measures distances in 3D, so one more seam costs only a few link records.
#include "mesh/atlas.h"

#include <cmath>

namespace fw::mesh {
namespace {

constexpr double kGrowCosine = 0.74;    // smoothed normal against the chart's axis
constexpr double kRoughCosine = 0.55;   // the triangle's own normal against it
constexpr double kProjectCosine = 0.5;  // aspect 2
constexpr double kAbsorbCosine = 0.6;
constexpr double kSmallTexels = 32;  // smaller charts go to their neighbours
constexpr double kTestSide = 4096;   // texels, largest image of the overlap test
constexpr double kTestCells = 4096;  // cells that any chart may have in it, and
constexpr double kTestSparse = 64;   // cells per texel of its area
constexpr int kRounds = 6;           // then every triangle left becomes a chart of its own

struct Chart {
    glm::dvec3 axis{0, 0, 1};
    double area = 0;
};

struct Candidate {
    double distance;  // m^2, from the seed
    uint32_t triangle;
    bool operator<(const Candidate& o) const {  // for std::push_heap: nearest first
        return distance != o.distance ? distance > o.distance : triangle > o.triangle;
    }
};

// Two rounds of averaging over edge neighbours: scanned surfaces are rough.
std::pmr::vector<glm::dvec3> smoothNormals(const Surface& surface) {
    const auto& triangles = surface.triangles;
    std::pmr::vector<glm::dvec3> smooth(surface.memory), next(triangles.size(), surface.memory);
    for (const Triangle& t : triangles) smooth.push_back(t.normal);
    for (int round = 0; round < 2; ++round) {
        for (size_t i = 0; i < triangles.size(); ++i) {
            glm::dvec3 sum = smooth[i] * triangles[i].area;
            for (uint32_t n : triangles[i].neighbour)
                if (n != kNone) sum += smooth[n] * triangles[n].area;
            next[i] = unitOr(sum, triangles[i].normal);
        }
        smooth.swap(next);
    }
    return smooth;
}

class Grower {
 public:
    explicit Grower(Surface& surface) : surface_(surface) {}

    // Gives every triangle of the pool a chart number, from `first` on. Returns the next number.
    uint32_t grow(std::span<const uint32_t> pool, uint32_t first, double smallArea) {
        charts_.clear();
        inPool_.assign(triangles_.size(), 0);
        for (uint32_t i : pool) {
            inPool_[i] = 1;
            triangles_[i].chart = kNone;
        }
        for (uint32_t seed : pool)
            if (triangles_[seed].chart == kNone) growOne(seed, first + uint32_t(charts_.size()));
        absorbSmall(pool, first, smallArea);
        FW_ASSERT(pool.empty() || !charts_.empty());
        return first + uint32_t(charts_.size());
    }

 private:
    void growOne(uint32_t seed, uint32_t chart) {
        const glm::dvec3 from = centreOf(triangles_[seed]);
        glm::dvec3 sum(0), axis = smooth_[seed];
        if (glm::dot(axis, triangles_[seed].normal) < kRoughCosine) axis = triangles_[seed].normal;
        double area = 0;
        heap_.clear();
        heap_.push_back({0, seed});
        while (!heap_.empty()) {
            std::pop_heap(heap_.begin(), heap_.end());
            const uint32_t i = heap_.back().triangle;
            heap_.pop_back();
            Triangle& t = triangles_[i];
            if (t.chart != kNone) continue;
            if (i != seed && (glm::dot(smooth_[i], axis) < kGrowCosine ||
                              glm::dot(t.normal, axis) < kRoughCosine))
                continue;
            t.chart = chart;
            sum += t.normal * t.area;
            area += t.area;
            if (area > 0) axis = unitOr(sum + axis * (0.1 * area), axis);
            for (uint32_t n : t.neighbour) {
                if (n == kNone || !inPool_[n] || triangles_[n].chart != kNone) continue;
                const glm::dvec3 d = centreOf(triangles_[n]) - from;
                heap_.push_back({glm::dot(d, d), n});
                std::push_heap(heap_.begin(), heap_.end());
            }
        }
        charts_.push_back({unitOr(sum, axis), area});
    }

    void absorbSmall(std::span<const uint32_t> pool, uint32_t first, double smallArea) {
        bool moved = true;
        for (int pass = 0; pass < 12 && moved; ++pass) {
            moved = false;
            for (uint32_t i : pool) {
                Triangle& t = triangles_[i];
                Chart& mine = charts_[t.chart - first];
                if (mine.area >= smallArea) continue;
                uint32_t best = kNone;
                double bestCosine = kAbsorbCosine;
                for (uint32_t n : t.neighbour) {
                    if (n == kNone || !inPool_[n] || triangles_[n].chart == t.chart) continue;
                    const Chart& other = charts_[triangles_[n].chart - first];
                    const double cosine = glm::dot(t.normal, other.axis);
                    if (other.area <= mine.area || cosine <= bestCosine) continue;
                    best = triangles_[n].chart;
                    bestCosine = cosine;
                }
                if (best == kNone) continue;
                mine.area -= t.area;
                charts_[best - first].area += t.area;
                t.chart = best;
                moved = true;
            }
        }
    }

    Surface& surface_;
    std::pmr::vector<Triangle>& triangles_ = surface_.triangles;
    std::pmr::vector<glm::dvec3> smooth_ = smoothNormals(surface_);
    std::pmr::vector<Candidate> heap_{surface_.memory};
    std::pmr::vector<Chart> charts_{surface_.memory};
    std::pmr::vector<uint8_t> inPool_{surface_.memory};
};

// Flattens chart members onto the plane of their mean normal, at the surface's own scale. A
// triangle too steep for it loses its chart.
void flatten(Surface& surface, std::span<const uint32_t> members) {
    glm::dvec3 sum(0);
    for (uint32_t i : members) sum += surface.triangles[i].normal * surface.triangles[i].area;
    FW_ASSERT(!members.empty());
    const glm::dvec3 axis = unitOr(sum, surface.triangles[members[0]].normal);
    const glm::dvec3 size = glm::abs(axis);
    const glm::dvec3 helper = size.x <= size.y && size.x <= size.z ? glm::dvec3(1, 0, 0)
                              : size.y <= size.z                   ? glm::dvec3(0, 1, 0)
                                                                   : glm::dvec3(0, 0, 1);
    const glm::dvec3 u = glm::normalize(glm::cross(helper, axis)), v = glm::cross(axis, u);
    double area = 0, flat = 0;
    for (uint32_t i : members) {
        Triangle& t = surface.triangles[i];
        const double cosine = glm::dot(t.normal, axis);
        if (cosine < kProjectCosine && members.size() > 1) {
            t.chart = kNone;
            continue;
        }
        for (int k = 0; k < 3; ++k)
            t.uv[k] = {glm::dot(t.position[k], u), glm::dot(t.position[k], v)};
        area += t.area;
        flat += t.area * cosine;
    }
    const double scale = flat > 0 ? std::sqrt(area / flat) : 1;
    for (uint32_t i : members)
        for (glm::dvec2& uv : surface.triangles[i].uv) uv *= scale;
}

// Cuts a chart longer than `longest` into several along its longer side. Returns the next number.
uint32_t splitLong(Surface& surface, std::span<const uint32_t> members, uint32_t nextChart,
                   double longest) {
    const Extent2 extent = extentOf(surface, members);
    const glm::dvec2 size = extent.size(), low = extent.low;
    const double side = std::max(size.x, size.y);
    if (!(side > longest)) return nextChart;
    const int axis = size.x >= size.y ? 0 : 1;
    const uint32_t pieces = uint32_t(std::min(double(members.size()), std::ceil(side / longest)));
    FW_ASSERT(pieces >= 1, "%g m in pieces of %g", side, longest);
    for (uint32_t i : members) {
        Triangle& t = surface.triangles[i];
        if (t.chart == kNone) continue;
        const double along = (t.uv[0][axis] + t.uv[1][axis] + t.uv[2][axis]) / 3 - low[axis];
        const uint32_t piece = std::min(pieces - 1, uint32_t(along / side * pieces));
        if (piece > 0) t.chart = nextChart + piece - 1;
    }
    return nextChart + pieces - 1;
}

// A triangle that lies over another of its chart loses its chart.
void dropOverlaps(Surface& surface, std::span<const uint32_t> members, double density,
                  Coverage& coverage) {
    const Extent2 extent = extentOf(surface, members);
    double area = 0;
    for (uint32_t i : members)
        if (surface.triangles[i].chart != kNone) area += surface.triangles[i].area;
    if (members.size() < 2 || !(area > 0)) return;
    // Huge or sparse charts are tested more coarsely.
    const glm::dvec2 size = extent.size();
    const double cells = kTestCells + kTestSparse * area * density * density;
    const double scale = std::min({density, kTestSide / std::max(size.x, size.y),
                                   std::sqrt(cells / std::max(size.x * size.y, 1e-300))});
    coverage.clear(uint32_t(size.x * scale) + 2, uint32_t(size.y * scale) + 2);
    for (uint32_t i : members) {
        Triangle& t = surface.triangles[i];
        if (t.chart != kNone && coverage.add(t, -extent.low, scale) > 0) t.chart = kNone;
    }
}

}  // namespace

uint32_t growCharts(Surface& surface, std::pmr::vector<uint32_t>& pool, uint32_t firstChart,
                    double density, double longest) {
    FW_ASSERT(density > 0 && longest > 0, "%g per m, %g m", density, longest);
    if (pool.empty()) return firstChart;
    Grower grower(surface);
    Coverage coverage(surface.memory);
    // Triangles that a round throws out (too steep, overlapping) form charts in the next.
    for (int round = 0; round < kRounds && !pool.empty(); ++round) {
        uint32_t next = grower.grow(pool, firstChart, kSmallTexels / (density * density));
        const uint32_t grown = next - firstChart;
        // Members are in the pool's order: the pool is sorted.
        FW_ASSERT(std::is_sorted(pool.begin(), pool.end()));
        Groups groups = groupBy(grown, uint32_t(pool.size()), surface.memory, [&](uint32_t i) {
            return surface.triangles[pool[i]].chart - firstChart;
        });
        for (uint32_t& item : groups.items) item = pool[item];
        for (uint32_t c = 0; c < grown; ++c) {
            const std::span<const uint32_t> members = groups.of(c);
            if (members.empty()) continue;
            flatten(surface, members);
            dropOverlaps(surface, members, density, coverage);
            next = splitLong(surface, members, next, longest);
        }
        pool.clear();
        for (uint32_t i : groups.items)
            if (surface.triangles[i].chart == kNone) pool.push_back(i);
        std::sort(pool.begin(), pool.end());
        firstChart = next;
    }
    for (uint32_t i : pool) {
        surface.triangles[i].chart = firstChart++;
        flatten(surface, {&i, 1});
    }
    return firstChart;
}

}  // namespace fw::mesh
