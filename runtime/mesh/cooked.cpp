// The cooked form of a burn domain: bytes in a fixed order, little-endian, checksummed.
//   header: u32 magic 'FWBD', u32 version, u64 key, u64 payload bytes, u64 FNV-1a of all the rest
//   payload: the scalars, the counts, then every array, in the order of `transfer` below
// The reader trusts nothing: it also refuses a file with a right checksum and wrong indices.
#include "core/hash.h"
#include "core/stream.h"
#include "mesh/texels.h"
#include "shared/front.h"

#include <bit>
#include <cmath>
#include <cstring>

namespace fw::mesh {
namespace {

using core::hashBytes;
using core::Reader;
using core::Writer;

constexpr uint32_t kMagic = 0x44425746;  // "FWBD"
constexpr uint32_t kVersion = 2;         // of the format
constexpr uint32_t kBakeVersion = 2;     // of the algorithm: part of the key
constexpr size_t kSizeAt = 16, kChecksumAt = 24, kHeaderBytes = 32;
constexpr const char* kWhat = "cooked mesh";

// One description of every record for both directions.
void record(auto& s, auto& number) { s.number(number); }
template <class T>
concept Texel = std::is_same_v<std::remove_const_t<T>, TexelPosition>;
template <class T>
concept Tile = std::is_same_v<std::remove_const_t<T>, TileStatic>;
template <class T>
concept Vertex = std::is_same_v<std::remove_const_t<T>, RenderVertex>;
void record(auto& s, Texel auto& t) { s.numbers(t.x, t.y, t.z, t.materialFlags); }
void record(auto& s, Tile auto& t) {
    s.numbers(t.seamMask, t.dependentStart, t.dependentCount, t.rimMask, t.rimBase, t.reserved);
}
void record(auto& s, Vertex auto& v) {
    s.numbers(v.position, v.normal, v.atlasUv, v.textureUv, v.detail, v.tint, v.material);
}
void reportRecord(auto& s, auto& r) {  // all but the time: equal inputs, equal bytes
    s.numbers(r.meshArea, r.texelArea, r.linkMin, r.linkMax, r.aspectP99, r.aspectMax, r.vertices,
              r.triangles, r.charts, r.degenerate, r.openEdges, r.nonManifoldEdges, r.seamEdges,
              r.realTexels, r.forcedTexels, r.rimTexels, r.overlaps, r.linksOpen, r.linksLost,
              r.withoutDependents, r.usedOwnUv, r.rechartedTriangles);
}

struct Counts {
    uint32_t linkWords = 0, dependents = 0, vertices = 0, indices = 0;
};

void scalars(auto& s, auto& d, Counts& counts) {
    s.numbers(d.width, d.height, d.quantum, d.texelSide, d.linkShort, d.linkMax, d.materialCount,
              d.hasDetail);
    for (int k = 0; k < 3; ++k) s.numbers(d.origin[k], d.boundsLow[k], d.boundsHigh[k]);
    s.numbers(counts.linkWords, counts.dependents, counts.vertices, counts.indices);
    reportRecord(s, d.report);
}

// Bytes of the arrays in the file.
uint64_t arrayBytes(const BurnDomain& d, const Counts& counts) {
    constexpr uint64_t kTexelBytes = sizeof(TexelPosition) + 4 + 4 + 2 + 2 + 4;
    return d.texelCount() * kTexelBytes + uint64_t(d.tileCount()) * sizeof(TileStatic) +
           (uint64_t(counts.linkWords) + counts.dependents + counts.indices) * 4 +
           uint64_t(counts.vertices) * (sizeof(RenderVertex) + 4);
}

template <typename Stream>
void arrays(Stream& s, auto& d, const Counts& counts) {
    const auto all = [&](size_t count, auto&... arrays) {
        const auto one = [&](auto& array) {
            if constexpr (Stream::kReads) array.resize(count);
            FW_ASSERT(array.size() == count, "%zu of %zu records", array.size(), count);
            for (auto& element : array) record(s, element);
        };
        (one(arrays), ...);
    };
    all(d.texelCount(), d.texels, d.normals, d.areas, d.thickness, d.slowness, d.triangleOf);
    all(d.tileCount(), d.tiles);
    all(counts.linkWords, d.links);
    all(counts.dependents, d.dependents);
    all(counts.vertices, d.vertices, d.sources);
    all(counts.indices, d.indices);
}

void requireBelow(size_t limit, size_t value, const char* what, size_t element) {
    if (value >= limit)
        core::failData("%s %zu of the cooked mesh is %zu; it must be less than %zu.", what, element,
                       value, limit);
}
void require(bool holds, const char* what, size_t element) {
    if (!holds)
        core::failData("%s (element %zu) of the cooked mesh is not consistent.", what, element);
}
bool usable(float v) { return std::isfinite(v) && std::abs(v) < 1e7f; }

// Every index is in range, and every invariant of burn_domain.h holds.
void checkTexels(const BurnDomain& d) {
    for (uint32_t i = 0; i < d.texelCount(); ++i) {
        const uint32_t flags = d.texels[i].materialFlags;
        require((flags & ~uint32_t(0xFF | kTexelReal | kTexelRim | kTexelForced)) == 0 &&
                    ((flags & kTexelReal) != 0 || flags == 0),
                "Flags of a texel", i);
        requireBelow(d.materialCount, flags & 0xFF, "Material of texel", i);
        require((d.slowness[i] != 0) == d.real(i), "Slowness of a texel", i);
        require(d.areas[i] >= 0 && d.areas[i] < 1e12f, "Area of a texel", i);
        if (d.real(i) || d.triangleOf[i] != kNone)
            requireBelow(d.indices.size() / 3, d.real(i) ? d.triangleOf[i] : ~size_t(0),
                         "Triangle of texel", i);
        if (!d.real(i) || (flags & kTexelRim)) continue;
        const uint32_t x = i % d.width, y = i / d.width;
        bool whole = x > 0 && y > 0 && x + 1 < d.width && y + 1 < d.height;
        for (size_t k = 0; k < 8 && whole; ++k)
            whole = d.real(uint32_t(int(i) + kRingY[k] * int(d.width) + kRingX[k]));
        require(whole, "Ring of a texel without a link record", i);
    }
}

void checkTiles(const BurnDomain& d) {
    uint32_t records = 0, dependents = 0;
    for (uint32_t t = 0; t < d.tileCount(); ++t) {
        const TileStatic& tile = d.tiles[t];
        const uint64_t rim = tile.rimMask;
        require(tile.rimBase == records, "First link record of a tile", t);
        require(tile.dependentStart == dependents &&
                    tile.dependentCount <= d.dependents.size() - dependents,
                "Dependents of a tile", t);
        records += uint32_t(std::popcount(rim));
        dependents += tile.dependentCount;
        const TileTexels texels = d.texelsOf(t);
        for (uint32_t lane = 0; lane < kTileLanes; ++lane) {
            const uint32_t texel = texels[lane];
            const bool isRim = (d.texels[texel].materialFlags & kTexelRim) != 0;
            require(isRim == ((rim >> lane & 1) != 0), "Rim mask of a tile", t);
        }
    }
    require(uint64_t(records) * 8 == d.links.size(), "Number of link records", records);
    require(dependents == d.dependents.size(), "Number of dependents", dependents);
    for (size_t i = 0; i < d.dependents.size(); ++i)
        requireBelow(d.tileCount(), d.dependents[i], "Dependent tile", i);
    for (size_t i = 0; i < d.links.size(); ++i) {
        if (d.links[i] == kNone) continue;
        requireBelow(d.texelCount(), d.links[i], "Link", i);
        require(d.real(d.links[i]), "Target of a link", i);
    }
}

// Limits of the integer products of shaders/shared/front.h: links of at most kLongest units, and
// normals no longer than a rounded unit vector.
void checkFront(const BurnDomain& d) {
    constexpr double kLongest = 8191;
    constexpr double kUnit = 16384 * 1.01;  // Q14
    uint32_t real = 0;
    double area = 0;
    for (uint32_t t = 0; t < d.tileCount(); ++t)
        eachTexel(d, t, [&](uint32_t texel) {
            ++real;
            area += double(d.areas[texel]);
            const glm::dvec3 n(gpu::decodeNormal(d.normals[texel]));
            if (glm::length(n) > kUnit)
                core::failData(
                    "The normal of texel %u of the cooked mesh has length %.3f; the limit is 1.01.",
                    texel, glm::length(n) / 16384);
            for (uint32_t k = 0; k < 8; ++k) {
                const uint32_t to = d.ringOf(texel, k);
                if (to == kNone) continue;
                const glm::dvec3 link(d.texels[texel].units() - d.texels[to].units());
                if (glm::dot(link, link) > kLongest * kLongest)
                    core::failData(
                        "Positions of texels %u and %u of the cooked mesh, which are "
                        "neighbours, are %.0f units apart; the limit is %.0f. Cook the mesh "
                        "again.",
                        texel, to, glm::length(link), kLongest);
            }
        });
    if (real != d.report.realTexels)
        core::failData("The cooked mesh has %u texels of the surface; its report says %u.", real,
                       d.report.realTexels);
    if (!(std::abs(area - d.report.texelArea) <= 0.001 * area))
        core::failData("The texels of the cooked mesh have %g m^2 in all; its report says %g.",
                       area, d.report.texelArea);
}

void checkDrawn(const BurnDomain& d) {
    for (size_t i = 0; i < d.indices.size(); ++i)
        requireBelow(d.vertices.size(), d.indices[i], "Index", i);
    for (size_t i = 0; i < d.vertices.size(); ++i) {
        const RenderVertex& v = d.vertices[i];
        bool finite = true;
        core::eachNumber([&](float c) { finite &= usable(c); }, v.position, v.textureUv, v.detail);
        finite &= v.atlasUv[0] >= 0 && v.atlasUv[0] <= float(d.width) && v.atlasUv[1] >= 0 &&
                  v.atlasUv[1] <= float(d.height);
        require(finite, "A vertex", i);
        requireBelow(d.materialCount, v.material, "Material of vertex", i);
        requireBelow(d.report.vertices, d.sources[i], "Source of vertex", i);
    }
}

void checkScalars(const BurnDomain& d) {
    for (uint32_t side : {d.width, d.height})
        if (side < 8 || side > 4096 || side % 8 != 0)
            core::failData(
                "The cooked mesh's atlas is %u x %u texels; sides must be multiples of 8 in "
                "[8, 4096].",
                d.width, d.height);
    const auto size = [](float v) { return v > 0 && usable(v); };
    require(size(d.quantum * 65535) && size(d.texelSide) && size(d.linkShort), "Size of a texel",
            0);
    require(std::isfinite(d.linkMax) && d.linkMax >= 0 && d.linkMax <= 8191 * d.quantum,
            "Longest link", 0);
    require(d.materialCount >= 1 && d.materialCount <= 8, "Number of materials", d.materialCount);
    require(d.hasDetail <= 1, "Detail flag", d.hasDetail);
    for (int k = 0; k < 3; ++k)
        require(usable(d.origin[k]) && usable(d.boundsLow[k]) && usable(d.boundsHigh[k]) &&
                    d.boundsLow[k] <= d.boundsHigh[k],
                "Bounds", size_t(k));
}

// FNV-1a over the header before the checksum, and the payload after it.
uint64_t checksumOf(std::span<const std::byte> file) {
    return hashBytes(file.subspan(kHeaderBytes), hashBytes(file.first(kChecksumAt)));
}

}  // namespace

uint64_t bakeKey(const BakeInput& input) noexcept {
    uint64_t hash = core::kFnvOffset;
    const auto add = [&](const void* data, uint64_t bytes) {
        hash = hashBytes(std::as_bytes(std::span(&bytes, 1)), hash);
        hash = hashBytes({static_cast<const std::byte*>(data), bytes}, hash);
    };
    const auto addArrays = [&](const auto&... spans) {
        (add(spans.data(), spans.size_bytes()), ...);
    };
    const auto addValues = [&](const auto&... values) { (add(&values, sizeof values), ...); };
    addValues(kBakeVersion);
    addArrays(input.positions, input.normals, input.uvs, input.details, input.tints, input.indices,
              input.triangleMaterials);
    addValues(input.texelsPerMetre, input.maxSide, input.noiseAmplitude, input.noiseFeature,
              input.noiseSeed, uint8_t(input.trustUvs));
    return hash;
}

std::pmr::vector<std::byte> writeCooked(const BurnDomain& domain, uint64_t key,
                                        std::pmr::memory_resource* memory) {
    std::pmr::vector<std::byte> out(memory);
    Counts counts{uint32_t(domain.links.size()), uint32_t(domain.dependents.size()),
                  uint32_t(domain.vertices.size()), uint32_t(domain.indices.size())};
    out.reserve(kHeaderBytes + 512 + arrayBytes(domain, counts));
    Writer writer(out);
    writer.numbers(kMagic, kVersion, key, uint64_t(0), uint64_t(0));  // size and checksum: below
    FW_ASSERT(out.size() == kHeaderBytes, "%zu bytes", out.size());
    scalars(writer, domain, counts);
    arrays(writer, domain, counts);
    writer.numberAt(kSizeAt, uint64_t(out.size() - kHeaderBytes));
    writer.numberAt(kChecksumAt, checksumOf(out));
    return out;
}

uint64_t cookedKey(std::span<const std::byte> bytes) {
    if (bytes.size() < kHeaderBytes)
        core::failData("The cooked mesh has %zu bytes; its header alone has %zu.", bytes.size(),
                       kHeaderBytes);
    Reader header(bytes.first(kHeaderBytes), kWhat);
    uint32_t magic = 0, version = 0;
    uint64_t key = 0;
    header.numbers(magic, version, key);
    if (magic != kMagic)
        core::failData("The cooked mesh begins with 0x%08X; 0x%08X (\"FWBD\") is expected.", magic,
                       kMagic);
    if (version != kVersion)
        core::failData("The cooked mesh has format version %u; this library reads version %u.",
                       version, kVersion);
    return key;
}

BurnDomain readCooked(std::span<const std::byte> bytes, std::pmr::memory_resource* memory) {
    cookedKey(bytes);
    Reader header(bytes.subspan(kSizeAt), kWhat);
    uint64_t size = 0, checksum = 0;
    header.numbers(size, checksum);
    const auto payload = bytes.subspan(kHeaderBytes);
    if (size != payload.size())
        core::failData("The cooked mesh has %zu bytes of payload; its header says %zu.",
                       payload.size(), size_t(size));
    if (const uint64_t found = checksumOf(bytes); found != checksum)
        core::failData("The cooked mesh's checksum is 0x%016zX; its header says 0x%016zX.",
                       size_t(found), size_t(checksum));

    BurnDomain domain(memory);
    Reader reader(payload, kWhat);
    Counts counts;
    scalars(reader, domain, counts);
    checkScalars(domain);
    domain.setSize(domain.width, domain.height);
    // Sizes before memory: the arrays must need exactly the bytes that are left.
    if (const uint64_t expected = arrayBytes(domain, counts); expected != reader.left())
        core::failData("The cooked mesh's arrays need %zu bytes; it has %zu.", size_t(expected),
                       reader.left());
    require(counts.linkWords % 8 == 0 && counts.indices % 3 == 0, "Number of links or indices", 0);
    arrays(reader, domain, counts);
    checkTexels(domain);
    checkTiles(domain);
    checkFront(domain);
    checkDrawn(domain);
    buildTileBounds(domain);
    buildFlameCells(domain);
    linkParts(domain);
    return domain;
}

}  // namespace fw::mesh
