// The burn domain of a triangle mesh, made by the bake: a unique-UV atlas of texels with rest
// positions, normals and areas, links across chart borders, tiles and their dependents. Immutable
// and shared by all objects of the mesh. The simulation reads integers only; doubles and floats
// serve the bake, drawing and queries.
#pragma once
#include "core/assert.h"

#include <array>
#include <bit>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory_resource>
#include <span>
#include <vector>

namespace fw::mesh {

constexpr uint32_t kNone = 0xFFFFFFFFu;
constexpr uint32_t kTileSide = 8;  // texels; a tile is 8x8 = 64 lanes, lane = (y % 8) * 8 + x % 8
constexpr uint32_t kTileLanes = kTileSide * kTileSide;
// Ring order: counter-clockwise, odd = diagonal. All link records use it.
constexpr std::array<int, 8> kRingX{1, 1, 0, -1, -1, -1, 0, 1};
constexpr std::array<int, 8> kRingY{0, 1, 1, 1, 0, -1, -1, -1};

// Flags in TexelPosition::materialFlags, above the material index (bits 0..7).
enum TexelFlag : uint32_t {
    kTexelReal = 0x100,    // owned by a triangle: takes part in the simulation
    kTexelRim = 0x200,     // neighbours come from a link record, not from the image
    kTexelForced = 0x400,  // sub-texel part: position is the closest point of its triangle
};

struct TexelPosition {  // 8 bytes, RGBA16_UINT: rest position in units of `quantum` from `origin`
    uint16_t x = 0, y = 0, z = 0, materialFlags = 0;
    [[nodiscard]] glm::ivec3 units() const noexcept { return {x, y, z}; }
};

struct TileStatic {         // 32 bytes, mirrored by the shaders (shaders/shared/burn.h)
    uint64_t seamMask = 0;  // texels of this tile that some other tile reads through a link
    uint32_t dependentStart = 0, dependentCount = 0;  // into BurnDomain::dependents
    uint64_t rimMask = 0;                             // texels of this tile with a link record
    uint32_t rimBase = 0;  // record of a rim texel = rimBase + popcount(rimMask below its lane)
    uint32_t reserved = 0;
    // The link record of a rim texel.
    [[nodiscard]] uint32_t recordOf(uint32_t lane) const noexcept {
        FW_ASSERT(lane < 64 && (rimMask >> lane & 1) != 0, "lane %u is no rim texel", lane);
        return rimBase + uint32_t(std::popcount(rimMask & ((uint64_t(1) << lane) - 1)));
    }
};

// The texels of a tile, by lane.
struct TileTexels {
    uint32_t corner = 0, width = 0;  // lane 0; texels of a row of the atlas
    [[nodiscard]] uint32_t operator[](uint32_t lane) const noexcept {
        FW_ASSERT(lane < kTileLanes, "lane %u", lane);
        return corner + lane / kTileSide * width + lane % kTileSide;
    }
};

struct TileBounds {  // of a tile's real texels, in position units; low > high: none
    uint16_t low[3] = {0xFFFF, 0xFFFF, 0xFFFF};
    uint16_t high[3] = {0, 0, 0};
};

// A corner of the drawn mesh; 48 bytes. Vertices are split where the atlas is cut.
struct RenderVertex {
    float position[3] = {};       // m, rest, object space
    uint32_t normal = 0;          // signed 11:11:10 xyz, x in the low bits; 1023, 1023, 511 = 1
    float atlasUv[2] = {};        // burn atlas, in TEXELS (texel centre = i + 0.5)
    float textureUv[2] = {};      // the mesh's own UV 0 (0 if none)
    float detail[2] = {};         // m, y along the grain; see BurnDomain::hasDetail
    uint32_t tint = 0xFFFFFFFFu;  // RGBA8 linear, multiplies the base colour
    uint32_t material = 0;        // material index of the triangle
    [[nodiscard]] glm::vec3 place() const noexcept {
        return {position[0], position[1], position[2]};
    }
};

struct BakeReport {                       // for people and tests; never read by the simulation
    double meshArea = 0;                  // m^2, non-degenerate triangles
    double texelArea = 0;                 // m^2, sum over texels
    double milliseconds = 0;              // of the whole bake
    double linkMin = 0, linkMax = 0;      // in texel sides
    double aspectP99 = 0, aspectMax = 0;  // texel stretch
    uint32_t vertices = 0, triangles = 0, charts = 0;
    uint32_t degenerate = 0, openEdges = 0, nonManifoldEdges = 0, seamEdges = 0;
    uint32_t realTexels = 0, forcedTexels = 0, rimTexels = 0, overlaps = 0;
    uint32_t linksOpen = 0, linksLost = 0, withoutDependents = 0;
    uint32_t usedOwnUv = 0;  // 1: the mesh's UVs; 0: our packing
    uint32_t rechartedTriangles = 0;
};

struct BurnDomain {
    explicit BurnDomain(std::pmr::memory_resource* of) : memory(of) {}

    std::pmr::memory_resource* memory;  // that the vectors begin with
    uint32_t width = 0, height = 0;     // texels, multiples of 8
    uint32_t tilesX = 0, tilesY = 0;
    float quantum = 0;     // m per position unit; every link is shorter than 8191 units
    float origin[3] = {};  // m, object space, of position 0,0,0
    float texelSide = 0;   // m, nominal h = 1 / density
    float linkShort = 0;   // m, 5th percentile of the texel's shorter side (for substeps)
    float linkMax = 0;     // m, longest link (a doused band must be wider)
    float boundsLow[3] = {}, boundsHigh[3] = {};  // m, object space
    uint32_t materialCount = 0;                   // 1 + highest material index
    uint32_t hasDetail = 0;  // 1: RenderVertex::detail is given; 0: shade triplanar

    std::pmr::vector<TexelPosition> texels{memory};  // width * height, row-major
    std::pmr::vector<uint32_t> normals{memory};      // signed 11:11:10 xyz, per texel
    std::pmr::vector<float> areas{memory};           // m^2 per texel; sum = mesh area within 1 %
    std::pmr::vector<uint16_t> thickness{memory};    // 0.1 mm by an inward ray; 0xFFFF: none hit
    std::pmr::vector<uint16_t> slowness{
        memory};  // Q7 noise factor per texel, 128 = 1; 0 = not real
    std::pmr::vector<uint32_t> triangleOf{
        memory};                               // per texel: drawn triangle (index / 3), or kNone
    std::pmr::vector<uint32_t> links{memory};  // 8 texel indices (or kNone) per rim record
    std::pmr::vector<uint32_t> dependents{memory};  // tiles, see TileStatic
    std::pmr::vector<TileStatic> tiles{memory};     // tilesX * tilesY
    std::pmr::vector<TileBounds> tileBounds{
        memory};  // per tile, for queries; not stored when cooked
    // Cells of neighbouring tiles that face alike, for drawing: each shows one flame. Not stored
    // when cooked.
    std::pmr::vector<uint32_t> flameCells{memory};  // per tile; kNone: it has no real texels
    uint32_t flameCellCount = 0;                    // at most gpu::kBodyCells
    float flameCellSide = 0;                        // m
    std::pmr::vector<uint32_t> partLinks{
        memory};  // 4 per tile, as gpu::ExchangeTile::parts; not stored
                  // when cooked. Empty: no part is near another one
    std::pmr::vector<RenderVertex> vertices{memory};  // what is drawn, split at chart borders
    std::pmr::vector<uint32_t> sources{memory};       // per drawn vertex: the host's, for skinning
    std::pmr::vector<uint32_t> indices{memory};       // 3 per triangle
    BakeReport report;

    // m^2, mean over the real texels, at scale 1.
    [[nodiscard]] double texelArea() const noexcept {
        return report.realTexels ? report.texelArea / double(report.realTexels)
                                 : double(texelSide) * double(texelSide);
    }
    void setSize(uint32_t columns, uint32_t rows) noexcept {  // texels, multiples of 8
        width = columns, height = rows;
        tilesX = columns / kTileSide, tilesY = rows / kTileSide;
    }
    [[nodiscard]] uint32_t texelCount() const noexcept { return width * height; }
    // m, object space, at rest.
    [[nodiscard]] glm::dvec3 placeOf(uint32_t texel) const noexcept {
        FW_ASSERT(texel < texels.size(), "%u of %zu texels", texel, texels.size());
        return glm::dvec3(origin[0], origin[1], origin[2]) +
               double(quantum) * glm::dvec3(texels[texel].units());
    }
    // The vertex at a corner, 0 to 2, of a drawn triangle.
    [[nodiscard]] const RenderVertex& cornerOf(uint32_t triangle, size_t corner) const noexcept {
        FW_ASSERT(size_t(triangle) * 3 + corner < indices.size(), "triangle %u", triangle);
        return vertices[indices[size_t(triangle) * 3 + corner]];
    }
    [[nodiscard]] uint32_t tileCount() const noexcept { return tilesX * tilesY; }
    [[nodiscard]] bool real(uint32_t texel) const noexcept {
        FW_ASSERT(texel < texels.size(), "%u of %zu texels", texel, texels.size());
        return (texels[texel].materialFlags & kTexelReal) != 0;
    }
    [[nodiscard]] uint32_t tileOf(uint32_t texel) const noexcept {
        FW_ASSERT(texel < texelCount(), "%u of %u texels", texel, texelCount());
        return texel / width / kTileSide * tilesX + texel % width / kTileSide;
    }
    [[nodiscard]] uint32_t laneOf(uint32_t texel) const noexcept {
        FW_ASSERT(texel < texelCount(), "%u of %u texels", texel, texelCount());
        return texel / width % kTileSide * kTileSide + texel % width % kTileSide;
    }
    [[nodiscard]] TileTexels texelsOf(uint32_t tile) const noexcept {
        FW_ASSERT(tile < tileCount(), "%u of %u tiles", tile, tileCount());
        return {tile / tilesX * kTileSide * width + tile % tilesX * kTileSide, width};
    }
    // The k-th in the ring of a real texel: from the image, or from a rim texel's link record; or
    // kNone.
    [[nodiscard]] uint32_t ringOf(uint32_t texel, uint32_t k) const noexcept {
        FW_ASSERT(k < 8 && real(texel), "slot %u of texel %u", k, texel);
        if (texels[texel].materialFlags & kTexelRim) {
            const size_t record = tiles[tileOf(texel)].recordOf(laneOf(texel));
            FW_ASSERT(record * 8 + k < links.size(), "record %zu", record);
            return links[record * 8 + k];
        }
        const int other = int(texel) + kRingY[k] * int(width) + kRingX[k];
        FW_ASSERT(other >= 0 && other < int(texelCount()), "texel %d", other);
        return uint32_t(other);
    }
};

// Calls visit(texel) or visit(texel, lane) for the real texels of a tile, in order.
template <class Visit>
void eachTexel(const BurnDomain& domain, uint32_t tile, Visit&& visit) {
    const TileTexels texels = domain.texelsOf(tile);
    for (uint32_t lane = 0; lane < kTileLanes; ++lane)
        if (domain.real(texels[lane])) {
            if constexpr (requires { visit(texels[lane], lane); })
                visit(texels[lane], lane);
            else
                visit(texels[lane]);
        }
}

}  // namespace fw::mesh
