// From drawn triangles back to a welded surface, and long coarse edges cut to size.
#include "mesh/refine/coarse.h"

#include "mesh/refine/table.h"

#include <cmath>

namespace fw::mesh {
namespace {

constexpr double kWeldTexels = 0.5 / 1024;  // equal to the weld distance of the domain's bake

struct Split {  // of one base edge
    uint32_t low, high;
    uint32_t level;
    uint32_t firstPoint;  // of its 2^level - 1 new ones, from the low end
};

uint32_t splitLevel(double length, double longest) {
    uint32_t level = 0;
    while (longest > 0 && level < gpu::kRefineDepth &&
           length / double(1u << level) > longest * (1 + 1e-6))
        ++level;
    return level;
}

uint32_t fitted(const std::pmr::vector<Split>& splits, const std::array<uint32_t, 3>& sides) {
    FW_ASSERT(std::max({sides[0], sides[1], sides[2]}) < splits.size(), "%zu edges", splits.size());
    const uint32_t a = splits[sides[0]].level, b = splits[sides[1]].level,
                   c = splits[sides[2]].level;
    return gpu::refinePack(a, b, c, gpu::fitInterior(a, b, c, std::max({a, b, c})));
}

}  // namespace

Surface surfaceOf(const BurnDomain& domain, std::pmr::memory_resource* memory) {
    std::pmr::vector<float> positions(memory), uvs(memory);
    positions.reserve(domain.vertices.size() * 3);
    uvs.reserve(domain.vertices.size() * 2);
    for (const RenderVertex& v : domain.vertices) {
        positions.insert(positions.end(), v.position, v.position + 3);
        uvs.insert(uvs.end(), v.atlasUv, v.atlasUv + 2);
    }
    BakeInput input;
    input.positions = positions;
    input.uvs = uvs;
    input.indices = domain.indices;
    Surface surface = collectSurface(input, kWeldTexels * double(domain.texelSide), memory);
    pairEdges(surface, true);
    return surface;
}

CoarseMesh coarseMesh(const Surface& surface, double longest, uint32_t most) {
    CoarseMesh base(surface.memory);
    base.points.resize(surface.pointCount);
    base.triangles.reserve(surface.triangles.size());
    for (uint32_t i = 0; i < surface.triangles.size(); ++i) {
        const Triangle& t = surface.triangles[i];
        CoarseTriangle c{{}, {}, i};
        for (int k = 2; k >= 0; --k) {
            c.weight[k][k] = 1;
            c.point[k] = t.point[k];
            base.points[t.point[k]] = t.position[k];
        }
        base.triangles.push_back(c);
    }
    if (!(longest > 0)) return base;

    std::pmr::vector<Split> splits(surface.memory);
    std::pmr::vector<std::array<uint32_t, 3>> sides(base.triangles.size(), surface.memory);
    for (const EdgeUse& use : sortedUses(base.triangles, surface.memory)) {
        if (splits.empty() || splits.back().low != use.low || splits.back().high != use.high)
            splits.push_back({use.low, use.high, 0, 0});
        sides[use.triangle][use.side] = uint32_t(splits.size() - 1);
    }
    uint64_t triangles = 0;
    for (bool first = true; first || triangles > most; first = false, longest *= 2) {
        for (Split& s : splits)
            s.level = splitLevel(glm::length(base.points[s.low] - base.points[s.high]), longest);
        FW_ASSERT(longest > 0, "%g m", longest);
        triangles = 0;
        for (const auto& side : sides) triangles += gpu::refineCount(fitted(splits, side));
        if (triangles == base.triangles.size()) return base;
    }

    CoarseMesh fine(surface.memory);
    fine.points = base.points;
    fine.triangles.reserve(triangles);
    for (Split& s : splits) {
        s.firstPoint = uint32_t(fine.points.size());
        const uint32_t steps = 1u << s.level;
        for (uint32_t i = 1; i < steps; ++i) {
            const double f = double(i) / steps;
            fine.points.push_back(base.points[s.low] * (1 - f) + base.points[s.high] * f);
        }
    }
    for (uint32_t q = 0; q < base.triangles.size(); ++q) {
        const CoarseTriangle& t = base.triangles[q];
        const uint32_t levels = fitted(splits, sides[q]);
        const uint32_t m = gpu::refineInterior(levels), n = 1u << m;
        const uint32_t firstInner = uint32_t(fine.points.size());
        eachInner(n, [&](uint32_t, glm::dvec3 w) {
            fine.points.push_back(mixed(base.points[t.point[0]], base.points[t.point[1]],
                                        base.points[t.point[2]], w));
        });
        const auto pointOf = [&](uint32_t code) {
            if ((code & gpu::kRefineOnSide) == 0)
                return firstInner + gpu::refineInnerPoint(code >> 6, code & 63, n);
            const uint32_t e = gpu::refineCodeSide(code);
            const Split& s = splits[sides[q][e]];
            const uint32_t steps = 1u << s.level, i = gpu::refineCodeStep(code);
            if (i == 0) return t.point[e];
            if (i == steps) return t.point[(e + 1) % 3];
            return s.firstPoint + (t.point[e] == s.low ? i : steps - i) - 1;
        };
        for (uint32_t k = 0; k < gpu::refineCount(levels); ++k) {
            const glm::uvec3 codes = refineTriangle(levels, k);
            CoarseTriangle c{};
            c.source = t.source;
            for (int v = 0; v < 3; ++v) {
                c.point[v] = pointOf(codes[v]);
                c.weight[v] = glm::dvec3(gpu::refineWeights(levels, codes[v])) / 32.0;
            }
            fine.triangles.push_back(c);
        }
    }
    FW_ASSERT(fine.triangles.size() == triangles, "%zu of %llu triangles", fine.triangles.size(),
              static_cast<unsigned long long>(triangles));
    return fine;
}

}  // namespace fw::mesh
