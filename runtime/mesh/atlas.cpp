// Judges the mesh's own layout: unique and even parts stay, the rest is cut into charts and packed.
#include "mesh/atlas.h"

#include <cmath>

namespace fw::mesh {
namespace {

constexpr double kMargin = 2;            // texels left free around the mesh's own layout
constexpr double kAspectLimit = 2.02;    // 2 : 1 with room for rounding
constexpr double kDensityLimit = 4;      // texel area against the mean: within 1/4 .. 4
constexpr double kBadAreaLimit = 0.01;   // own UVs stay if less of the surface is worse than that
constexpr double kOverlapLimit = 0.001;  // and fewer texels than this overlap
constexpr double kTrustedCover = 4;      // trusted UVs may cover the largest atlas this many times
// Limit of the texels that the edges of all triangles pass: per texel of the largest atlas, and at
// least. Without it a disc of needles would cost minutes for a spot at its middle.
constexpr double kEdgesPerTexel = 8, kEdgesAtLeast = 1 << 23;
constexpr double kIslandBadLimit = 0.1;  // an island with more bad area is cut again as a whole
constexpr double kSparseLimit = 64;      // an island's box over its area; sparser: cut again
constexpr double kIslandTexels = 16;     // a smaller island joins our charts

// Bad: no area in the atlas, stretched, or far denser or sparser than texels of `meanArea` m^2.
bool badTexels(const Triangle& t, double meanArea) {
    const TexelShape shape = texelShape(t);
    if (!shape.usable || shape.longer > kAspectLimit * shape.shorter) return true;
    const double ratio = shape.longer * shape.shorter / meanArea;
    return ratio > kDensityLimit || ratio < 1 / kDensityLimit;
}

// The highest density at which edges of `metres` in all pass no more texels than the limit;
// infinity for a mesh without edges.
double edgeDensity(double metres, uint32_t maxSide) {
    FW_ASSERT(metres >= 0, "%g m", metres);
    return std::max(kEdgesPerTexel * maxSide * maxSide, kEdgesAtLeast) / metres;
}

// The length of all triangles' edges, between `corners` of each.
template <class Corners>
double edgesOf(const Surface& surface, Corners corners) {
    double sum = 0;
    for (const Triangle& t : surface.triangles)
        for (int e = 0; e < 3; ++e) sum += glm::length((t.*corners)[(e + 1) % 3] - (t.*corners)[e]);
    return sum;
}

// Scales the mesh's own layout to the requested density, or to a lower one that fits. uv becomes
// texels.
AtlasPlan scaleOwn(Surface& surface, const BakeInput& input, double uvAreaSum) {
    FW_ASSERT(uvAreaSum > 0 && input.maxSide >= 8, "%g, side %u", uvAreaSum, input.maxSide);
    Extent2 extent;
    for (const Triangle& t : surface.triangles) extent.add(t);
    const double side = double(input.maxSide & ~7u) - 2 * kMargin - 1e-6;
    const double perUnit = std::sqrt(surface.area / uvAreaSum);  // m per UV unit
    const glm::dvec2 size = extent.size() * perUnit;
    AtlasPlan plan;
    plan.ownUv = true;
    plan.density = std::min(input.texelsPerMetre, side / std::max(size.x, size.y));
    // A thousand overlapping sheets would be rasterised a thousand times.
    if (input.trustUvs)
        plan.density =
            std::min({plan.density, side * std::sqrt(kTrustedCover / surface.area),
                      edgeDensity(edgesOf(surface, &Triangle::uv) * perUnit, input.maxSide)});
    plan.width = roundUp8(size.x * plan.density + 2 * kMargin);
    plan.height = roundUp8(size.y * plan.density + 2 * kMargin);
    const double scale = perUnit * plan.density;
    for (Triangle& t : surface.triangles)
        for (glm::dvec2& u : t.uv) u = (u - extent.low) * scale + kMargin;
    return plan;
}

bool ownIsGood(const Surface& surface, const BakeInput& input, const AtlasPlan& plan) {
    const double meanArea = 1 / (plan.density * plan.density);
    double badArea = 0, texels = 0;
    Extent2 extent;
    for (const Triangle& t : surface.triangles) {
        extent.add(t);
        if (badTexels(t, meanArea)) badArea += t.area;
        texels += std::abs(uvArea(t));
    }
    const double fill = texels / (double(plan.width) * plan.height);
    const bool wasteful = plan.density < 0.5 * input.texelsPerMetre && fill < 0.25;
    // UVs of more area than their box overlap: a tiled terrain would take minutes to test.
    const bool stacked = texels > (1 + kOverlapLimit) * extent.size().x * extent.size().y;
    const bool crowded = edgeDensity(edgesOf(surface, &Triangle::uv), input.maxSide) < 1;
    if (badArea > kBadAreaLimit * surface.area || wasteful || stacked || crowded) return false;
    Coverage coverage(surface.memory);
    coverage.clear(plan.width, plan.height);
    double conflicts = 0;
    for (const Triangle& t : surface.triangles) {
        conflicts += coverage.add(t, {0, 0}, 1);
        if (conflicts > kOverlapLimit * texels) return false;
    }
    return true;
}

// Brings every island to the surface's own scale (uv in metres), marks triangles that cannot stay
// in it with chart kNone and numbers the islands that remain. Returns their count.
uint32_t keepIslands(Surface& surface, double density, double longest) {
    const Groups groups = groupByChart(surface, surface.chartCount);
    Coverage coverage(surface.memory);
    uint32_t kept = 0;
    for (uint32_t island = 0; island < surface.chartCount; ++island) {
        const auto members = groups.of(island);
        double area = 0, flat = 0, bad = 0;
        for (uint32_t i : members) {
            area += surface.triangles[i].area;
            flat += std::abs(uvArea(surface.triangles[i]));
        }
        FW_ASSERT(!members.empty() && area > 0, "island %u of %g m^2", island, area);
        const double scale = flat > 1e-9 ? std::sqrt(area / flat) : 0;
        for (uint32_t i : members)
            for (glm::dvec2& u : surface.triangles[i].uv) u *= scale;
        const Extent2 extent = extentOf(surface, members);
        const glm::dvec2 size = extent.size();
        const bool usable = scale > 0 && area * density * density >= kIslandTexels &&
                            std::max(size.x, size.y) <= longest &&
                            size.x * size.y <= kSparseLimit * area;
        if (usable) coverage.clear(uint32_t(size.x * density) + 2, uint32_t(size.y * density) + 2);
        for (uint32_t i : members) {
            Triangle& t = surface.triangles[i];
            t.chart = kept;
            if (usable) {
                for (glm::dvec2& u : t.uv) u *= density;  // judge in texels
                const bool stretched = badTexels(t, 1 / (density * density));
                for (glm::dvec2& u : t.uv) u /= density;
                if (!stretched && coverage.add(t, -extent.low, density) == 0) continue;
            }
            t.chart = kNone;
            bad += t.area;
        }
        if (!usable || bad > kIslandBadLimit * area)
            for (uint32_t i : members) surface.triangles[i].chart = kNone;
        else
            ++kept;
    }
    return kept;
}

}  // namespace

uint32_t Coverage::add(const Triangle& t, glm::dvec2 offset, double scale) {
    Triangle moved;
    for (int k = 0; k < 3; ++k) moved.uv[k] = (t.uv[k] + offset) * scale;
    FW_ASSERT(owner_.size() == size_t(width_) * height_, "%zu of %u x %u texels", owner_.size(),
              width_, height_);
    uint32_t conflicts = 0;
    for (const bool marks : {false, true}) {  // look first, then mark
        if (conflicts != 0) break;
        eachTouched(moved, width_, height_, [&](int x, int y) {
            glm::dvec3 w;
            if (!weightsAt(moved, {x + 0.5, y + 0.5}, w) || std::min({w.x, w.y, w.z}) < 1e-6)
                return;
            uint8_t& owner = owner_[size_t(y) * width_ + size_t(x)];
            conflicts += owner;
            if (marks) owner = 1;
        });
    }
    return conflicts;
}

Groups groupByChart(const Surface& surface, uint32_t charts) {
    return groupBy(charts, uint32_t(surface.triangles.size()), surface.memory,
                   [&](uint32_t i) { return surface.triangles[i].chart; });
}

AtlasPlan packAtlas(Surface& surface, const BakeInput& input) {
    double uvAreaSum = 0;
    for (const Triangle& t : surface.triangles) uvAreaSum += std::abs(uvArea(t));
    const bool hasUv = !input.uvs.empty() && uvAreaSum > 1e-18;
    if (hasUv) {
        const AtlasPlan own = scaleOwn(surface, input, uvAreaSum);
        if (input.trustUvs || ownIsGood(surface, input, own)) return own;
    }
    // The tests use a density that the atlas can hold.
    const double side = double(input.maxSide & ~7u);
    const double edges = edgesOf(surface, &Triangle::position);  // m
    const double asked = std::min(input.texelsPerMetre, edgeDensity(edges, input.maxSide));
    const double density = std::min(asked, side / std::sqrt(surface.area));
    const double texels = surface.area * density * density;
    const double longest = std::clamp(1.5 * std::sqrt(texels), 32.0, side) / density * 0.95;

    pairEdges(surface, hasUv);
    const uint32_t kept = hasUv ? keepIslands(surface, density, longest) : 0;
    std::pmr::vector<uint32_t> pool(surface.memory);
    for (uint32_t i = 0; i < surface.triangles.size(); ++i)
        if (!hasUv || surface.triangles[i].chart == kNone) pool.push_back(i);
    const uint32_t recharted = uint32_t(pool.size());
    const uint32_t charts = growCharts(surface, pool, kept, density, longest);
    AtlasPlan plan = packCharts(surface, charts, asked, input.maxSide);
    FW_ASSERT(plan.width % kTileSide == 0 && plan.height % kTileSide == 0, "%u x %u texels",
              plan.width, plan.height);
    plan.recharted = recharted;
    return plan;
}

}  // namespace fw::mesh
