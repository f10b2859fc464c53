#include "mesh/bake.h"

#include "mesh/texels.h"
#include "shared/front.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace fw::mesh {
namespace {

// As the front reads it.
glm::dvec3 normalOf(uint32_t packed) { return glm::dvec3(gpu::decodeNormal(packed)) / 16384.0; }

// Stretched places of texels, m.
struct Places {
    const BurnDomain& from;
    glm::dvec3 shape;

    [[nodiscard]] glm::dvec3 at(uint32_t texel) const { return shape * from.placeOf(texel); }
};

void measure(const Places& places, BurnDomain& out) {
    const BurnDomain& from = places.from;
    std::pmr::vector<float> shorter(out.memory);
    double longest = 0;
    for (uint32_t i = 0; i < from.texelCount(); ++i) {
        if (!from.real(i)) continue;
        const glm::dvec3 here = places.at(i);
        double side[2] = {};
        for (uint32_t k = 0; k < 8; ++k) {
            const uint32_t other = from.ringOf(i, k);
            if (other == kNone || !from.real(other)) continue;
            const double length = glm::length(places.at(other) - here);
            longest = std::max(longest, length);
            if (k == 0 || k == 2) side[k / 2] = length;
        }
        if (!(from.texels[i].materialFlags & kTexelRim) && side[0] > 0 && side[1] > 0)
            shorter.push_back(float(std::min(side[0], side[1])));
    }
    const double least = std::min({std::abs(places.shape.x), places.shape.y, places.shape.z});
    out.linkMax = float(longest);
    out.linkShort = from.linkShort * float(least);
    if (shorter.empty()) return;
    const auto fifth = shorter.begin() + std::ptrdiff_t(shorter.size() / 20);
    std::nth_element(shorter.begin(), fifth, shorter.end());
    out.linkShort = std::max(out.linkShort, *fifth);
}

// Newton's method from above: std::cbrt differs between C libraries, also for the cube of a scale.
double cubeRoot(double x) noexcept {
    double root = std::max(x, 1.0);
    for (double next = root; (next -= (next - x / (next * next)) / 3) < root;) root = next;
    return root;
}

}  // namespace

BurnDomain shaped(const BurnDomain& from, const float given[3], std::pmr::memory_resource* memory) {
    const glm::dvec3 shape(given[0], given[1], given[2]);
    FW_ASSERT(shape.x != 0 && shape.y > 0 && shape.z > 0, "%g, %g, %g", shape.x, shape.y, shape.z);
    const double volume = std::abs(shape.x * shape.y * shape.z);
    BurnDomain out(memory);
    out = from;  // vectors keep `memory`
    const Places places{from, shape};
    measure(places, out);

    glm::dvec3 low, high;
    for (int k = 0; k < 3; ++k) {
        std::tie(low[k], high[k]) = std::minmax(
            {shape[k] * double(from.boundsLow[k]), shape[k] * double(from.boundsHigh[k])});
        out.origin[k] = out.boundsLow[k] = float(low[k]);
        out.boundsHigh[k] = float(high[k]);
    }
    const glm::dvec3 size = high - low;
    const double extent = std::max({size.x, size.y, size.z, 1e-12});
    // As fine as the bake: a flattened axis keeps its share of the units.
    const double fine = double(from.quantum) * cubeRoot(volume);
    const double quantum = std::max({extent / 65535, fine, double(out.linkMax) / kLongestLink});
    out.quantum = floatAtLeast(quantum);
    FW_ASSERT(out.quantum > 0 && out.linkMax >= 0, "%g m, links of %g m", quantum,
              double(out.linkMax));

    double areas = 0, areasBefore = 0;
    for (uint32_t i = 0; i < from.texelCount(); ++i) {
        if (!from.real(i)) continue;
        const glm::dvec3 at = (places.at(i) - low) / double(out.quantum);
        uint16_t* const fields[3] = {&out.texels[i].x, &out.texels[i].y, &out.texels[i].z};
        for (int k = 0; k < 3; ++k)
            *fields[k] = uint16_t(std::clamp(std::floor(at[k] + 0.5), 0.0, 65535.0));
        const glm::dvec3 before = normalOf(from.normals[i]), normal = before / shape;
        const double grown = glm::length(normal) / std::max(glm::length(before), 1e-12);
        out.normals[i] = packNormal(glm::normalize(normal));
        // A slab that grows in area thins along its normal.
        out.areas[i] = float(double(from.areas[i]) * volume * grown);
        areas += double(out.areas[i]);
        areasBefore += double(from.areas[i]);
        if (from.thickness[i] != 0xFFFF)
            out.thickness[i] = uint16_t(
                std::clamp(std::floor(double(from.thickness[i]) / grown + 0.5), 1.0, 65534.0));
    }
    const double growth = areasBefore > 0 ? areas / areasBefore : 1;
    out.texelSide = float(double(from.texelSide) * std::sqrt(growth));
    out.report.meshArea = from.report.meshArea * growth;
    out.report.texelArea = areas;
    for (RenderVertex& v : out.vertices) {
        for (int k = 0; k < 3; ++k) v.position[k] = float(shape[k] * double(v.position[k]));
        v.normal = packNormal(glm::normalize(normalOf(v.normal) / shape));
    }
    if (shape.x * shape.y * shape.z < 0)  // faces go on turning outwards
        for (size_t i = 0; i + 2 < out.indices.size(); i += 3)
            std::swap(out.indices[i + 1], out.indices[i + 2]);
    FW_ASSERT(growth > 0 && growth < 1e12, "growth %g", growth);
    buildTileBounds(out);
    buildFlameCells(out);
    linkParts(out);
    return out;
}

}  // namespace fw::mesh
