// Refuses input that the bake cannot use. Degenerate triangles, non-manifold edges and overlaps are
// no reason to refuse: later steps handle them.
#include "core/error.h"
#include "mesh/surface.h"

#include <cmath>

namespace fw::mesh {
namespace {

constexpr double kCoordinateLimit = 1e6;  // m; and for UVs, turns of the unit square
constexpr uint64_t kElementLimit = 1u << 28;

enum class Of { lengths, others };

void requireFinite(const char* array, std::span<const float> values, size_t width, Of of) {
    for (size_t i = 0; i < values.size(); ++i) {
        const double value = values[i];
        if (std::isfinite(value) && std::abs(value) <= kCoordinateLimit) continue;
        core::refuse(
            of == Of::lengths
                ? "%s of vertex %zu, component %zu, is " FW_LENGTH
                  "; it must be finite and within +-" FW_LENGTH "."
                : "%s of vertex %zu, component %zu, is %g; it must be finite and within +-%g.",
            array, i / width, i % width, value, kCoordinateLimit);
    }
}

// Elements of `width` values each.
void requireCount(const char* array, size_t size, size_t width, const char* has) {
    if (size == 0) core::refuse("%s is empty; a mesh needs at least %s.", array, has);
    if (size % width != 0)
        core::refuse("%s has %zu elements; it must be a multiple of %zu.", array, size, width);
}

void requireSize(const char* array, size_t size, size_t expected, const char* per) {
    if (size == 0 || size == expected) return;
    core::refuse("%s has %zu elements; %s need %zu (or none).", array, size, per, expected);
}

void requireRange(const char* name, double value, double low, double high) {
    if (value >= low && value <= high) return;
    core::refuse("%s is %g; it must lie in [%g, %g].", name, value, low, high);
}

}  // namespace

void validate(const BakeInput& input) {
    requireCount("positions", input.positions.size(), 3, "3 vertices");
    requireCount("indices", input.indices.size(), 3, "1 triangle");
    const size_t vertices = input.positions.size() / 3;
    const size_t triangles = input.indices.size() / 3;
    if (vertices > kElementLimit || triangles > kElementLimit)
        core::refuse("The mesh has %zu vertices and %zu triangles; the limit is %llu of each.",
                     vertices, triangles, static_cast<unsigned long long>(kElementLimit));
    requireSize("normals", input.normals.size(), vertices * 3, "the vertices");
    requireSize("uvs", input.uvs.size(), vertices * 2, "the vertices");
    requireSize("details", input.details.size(), vertices * 2, "the vertices");
    requireSize("tints", input.tints.size(), vertices, "the vertices");
    requireSize("triangleMaterials", input.triangleMaterials.size(), triangles, "the triangles");
    requireFinite("Position", input.positions, 3, Of::lengths);
    requireFinite("Normal", input.normals, 3, Of::others);
    requireFinite("UV", input.uvs, 2, Of::others);
    requireFinite("Detail coordinate", input.details, 2, Of::lengths);
    for (size_t i = 0; i < input.indices.size(); ++i)
        if (input.indices[i] >= vertices)
            core::refuse("Index %zu (corner %zu of triangle %zu) is %u; the mesh has %zu vertices.",
                         i, i % 3, i / 3, input.indices[i], vertices);
    for (size_t i = 0; i < input.triangleMaterials.size(); ++i)
        if (input.triangleMaterials[i] >= 8)
            core::refuse("Material of triangle %zu is %u; it must be less than 8.", i,
                         static_cast<unsigned>(input.triangleMaterials[i]));
    if (!(input.texelsPerMetre > 0) || input.texelsPerMetre > 4096)
        core::refuse("texelsPerMetre is %g; it must lie in (0, 4096].", input.texelsPerMetre);
    requireRange("maxSide", input.maxSide, 8, 4096);
    requireRange("noiseAmplitude", static_cast<double>(input.noiseAmplitude), 0, 0.5);
    requireRange("noiseFeature", static_cast<double>(input.noiseFeature), 1e-5, 1e3);
}

}  // namespace fw::mesh
