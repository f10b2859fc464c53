// Bakes triangle arrays to a burn domain, on the CPU, once per mesh. The bake may use doubles: its
// output is integer data that every device receives unchanged. Equal input gives equal bytes on
// every run and thread count.
#pragma once
#include "mesh/burn_domain.h"

#include <cstddef>

namespace fw::mesh {

struct BakeInput {                      // all spans may be freed after the call
    std::span<const float> positions;   // 3 per vertex, m, finite
    std::span<const float> normals;     // 3 per vertex, or empty: computed (crease 60 degrees)
    std::span<const float> uvs;         // 2 per vertex, or empty
    std::span<const float> details;     // 2 per vertex, m, y along the grain, or empty
    std::span<const uint32_t> tints;    // 1 per vertex, RGBA8 linear, or empty: white
    std::span<const uint32_t> indices;  // 3 per triangle (16-bit input is widened by the caller)
    std::span<const uint8_t> triangleMaterials;  // 1 per triangle, < 8, or empty: 0
    double texelsPerMetre = 128;   // (0, 4096]; lowered so that the atlas fits maxSide
    uint32_t maxSide = 1024;       // texels, [8, 4096]
    float noiseAmplitude = 0.15f;  // [0, 0.5] raggedness of slowness
    float noiseFeature = 0.012f;   // m
    uint32_t noiseSeed = 1;
    bool trustUvs = false;  // use the mesh's UVs even where they overlap or stretch
};

// Throws core::Error naming the array, the element, the value and the limit; std::bad_alloc.
BurnDomain bake(const BakeInput& input, std::pmr::memory_resource* memory);

// Cooked form (.fwburn): versioned, checksummed, little-endian, readable without any library.
// The key is a hash of every input of the bake: equal key, equal bytes.
uint64_t bakeKey(const BakeInput& input) noexcept;
std::pmr::vector<std::byte> writeCooked(const BurnDomain& domain, uint64_t key,
                                        std::pmr::memory_resource* memory);
// The key it was written with. Throws core::Error (truncated, wrong magic or version).
uint64_t cookedKey(std::span<const std::byte> bytes);
// Throws core::Error (truncated, wrong magic, version, checksum, or any index out of range).
BurnDomain readCooked(std::span<const std::byte> bytes, std::pmr::memory_resource* memory);

// Texels (real ones, by rest position) within `radius` m of a point on the surface nearest to
// `point` (object space, m); at least the nearest texel. Straight distance. For events.
void texelsNear(const BurnDomain& domain, const float point[3], float radius,
                std::pmr::vector<uint32_t>& out);
// Weights of the corners of a real texel's triangle, in [0, 1], of sum 1.
void texelWeights(const BurnDomain& domain, uint32_t texel, float (&weights)[3]) noexcept;
// Nearest real texel, or kNone when farther than maxDistance m.
uint32_t nearestTexel(const BurnDomain& domain, const float point[3], float maxDistance);

// Matches the texels of two meshes of the same shape (levels of detail): each texel of one takes
// its burn from a texel of the other.
// out, by texel of `to`: the nearest texel of `from` in object space, with preference for texels
// that face the same way. kNone: none is within `reach` m, or the texel is not real. Returns the
// number of matches.
uint32_t matchTexels(const BurnDomain& from, const BurnDomain& to, float reach,
                     std::pmr::vector<uint32_t>& out);

// A burn domain stretched along its axes, or mirrored, with the same atlas, links and tiles. For
// objects with a non-uniform scale.
// `shape`: factor per object axis; a negative x mirrors. Positions, normals, areas, thickness and
// lengths are those of the stretched mesh; detail coordinates stay.
BurnDomain shaped(const BurnDomain& domain, const float shape[3],
                  std::pmr::memory_resource* memory);

}  // namespace fw::mesh
