// The bake as a list of steps, and its last step: working doubles to integer texels.
#include "mesh/bake.h"

#include "mesh/texels.h"

#include <chrono>
#include <cmath>

namespace fw::mesh {
namespace {

constexpr double kUnitsPerTexel = 1024;  // finer positions would only make links overflow

// The texels' data for the simulation: positions, normals, flags.
void quantise(const Surface& surface, const TexelGrid& grid, BurnDomain& domain) {
    // A mesh smaller than a texel still gets a thousand units.
    const double coarse = std::min(grid.side, surface.extent) / kUnitsPerTexel;
    const double quantum = std::max({surface.extent / 65535, coarse, grid.linkMax / kLongestLink});
    domain.quantum = floatAtLeast(quantum);
    FW_ASSERT(domain.quantum > 0, "%g m", quantum);
    const auto units = [&](float metres) {
        const double u = std::floor(double(metres) / double(domain.quantum) + 0.5);
        return uint16_t(std::clamp(u, 0.0, 65535.0));
    };
    domain.texels.resize(grid.count());
    domain.normals.resize(grid.count());
    domain.areas.resize(grid.count());
    domain.triangleOf.assign(grid.count(), kNone);
    for (uint32_t i = 0; i < grid.count(); ++i) {
        if (!grid.real(i)) continue;
        FW_ASSERT(grid.owner[i] < surface.triangles.size(), "owner %u of texel %u", grid.owner[i],
                  i);
        const Triangle& t = surface.triangles[grid.owner[i]];
        const glm::vec3 p = grid.position[i];
        domain.texels[i] = {units(p.x), units(p.y), units(p.z),
                            uint16_t(grid.flags[i] | t.material)};
        domain.normals[i] = packNormal(t.normal);
        domain.areas[i] = float(grid.area[i]);
        domain.triangleOf[i] = grid.owner[i];
    }
}

// Texel sides and stretch over the real texels.
void measureShapes(const TexelGrid& grid, BurnDomain& domain) {
    std::pmr::vector<double> shorter(grid.memory), aspects(grid.memory);
    for (uint32_t i = 0; i < grid.count(); ++i) {
        if (!grid.real(i)) continue;
        domain.report.texelArea += grid.area[i];
        const TexelShape& shape = grid.shapes[grid.owner[i]];
        if (!shape.usable || !(shape.shorter > 0)) continue;
        shorter.push_back(shape.shorter);
        aspects.push_back(shape.longer / shape.shorter);
    }
    domain.linkShort = domain.texelSide;
    if (shorter.empty()) return;
    std::sort(shorter.begin(), shorter.end());
    std::sort(aspects.begin(), aspects.end());
    domain.linkShort = float(shorter[shorter.size() / 20]);
    domain.report.aspectP99 = aspects[aspects.size() * 99 / 100];
    domain.report.aspectMax = aspects.back();
}

void fillHeader(const BakeInput& input, const Surface& surface, const AtlasPlan& plan,
                const TexelGrid& grid, BurnDomain& domain) {
    FW_ASSERT(plan.width == grid.width && plan.height == grid.height, "%u x %u and %u x %u texels",
              plan.width, plan.height, grid.width, grid.height);
    domain.setSize(plan.width, plan.height);
    domain.texelSide = float(grid.side);
    domain.linkMax = float(grid.linkMax);
    for (int k = 0; k < 3; ++k) {
        domain.origin[k] = domain.boundsLow[k] = float(surface.low[k]);
        domain.boundsHigh[k] = float(surface.high[k]);
    }
    BakeReport& report = domain.report;
    for (const Triangle& t : surface.triangles)
        domain.materialCount = std::max(domain.materialCount, t.material + 1);
    report.meshArea = surface.area;
    report.vertices = uint32_t(input.positions.size() / 3);
    report.triangles = uint32_t(surface.triangles.size());
    report.charts = surface.chartCount;
    report.usedOwnUv = plan.ownUv;
    report.rechartedTriangles = plan.recharted;
}

}  // namespace

BurnDomain bake(const BakeInput& input, std::pmr::memory_resource* memory) {
    const auto start = std::chrono::steady_clock::now();
    validate(input);
    BurnDomain domain(memory);
    Surface surface = collectSurface(input, 0.5 / (input.texelsPerMetre * kUnitsPerTexel), memory);
    const AtlasPlan plan = packAtlas(surface, input);
    pairEdges(surface, true);
    domain.report = surface.report;
    TexelGrid grid = rasterise(surface, plan, domain.report);
    linkTexels(surface, grid, domain.report);
    fillHeader(input, surface, plan, grid, domain);
    quantise(surface, grid, domain);
    measureShapes(grid, domain);
    buildTiles(grid, domain);
    buildTileBounds(domain);
    buildFlameCells(domain);
    linkParts(domain);
    bakeThickness(surface, grid, domain.thickness);
    bakeSlowness(input, grid, surface.low, surface.extent, domain.slowness);
    buildDrawn(input, surface, domain);
    domain.report.milliseconds =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    return domain;
}

}  // namespace fw::mesh
