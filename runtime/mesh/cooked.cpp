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
constexpr size_t kHeaderBytes = 32;
constexpr const char* kWhat = "cooked mesh";

// One description of every record for both directions.
template <typename Stream, typename T>
requires std::is_arithmetic_v<T>
void record(Stream& s, T& value) { s.number(value); }
template <typename Stream>
void record(Stream& s, std::conditional_t<Stream::kReads, TexelPosition, const TexelPosition>& t) {
    s.number(t.x), s.number(t.y), s.number(t.z), s.number(t.materialFlags);
}
template <typename Stream>
void record(Stream& s, std::conditional_t<Stream::kReads, TileStatic, const TileStatic>& t) {
    s.number(t.seamMaskLow), s.number(t.seamMaskHigh), s.number(t.dependentStart);
    s.number(t.dependentCount), s.number(t.rimMaskLow), s.number(t.rimMaskHigh),
        s.number(t.rimBase);
    s.number(t.reserved);
}
template <typename Stream>
void record(Stream& s, std::conditional_t<Stream::kReads, RenderVertex, const RenderVertex>& v) {
    for (auto& c : v.position) s.number(c);
    s.number(v.normal);
    for (auto& c : v.atlasUv) s.number(c);
    for (auto& c : v.textureUv) s.number(c);
    for (auto& c : v.detail) s.number(c);
    s.number(v.tint), s.number(v.material);
}
template <typename Stream, typename Report>
void reportRecord(Stream& s, Report& r) {  // all but the time: equal inputs, equal bytes
    s.number(r.meshArea), s.number(r.texelArea), s.number(r.linkMin), s.number(r.linkMax);
    s.number(r.aspectP99), s.number(r.aspectMax), s.number(r.vertices), s.number(r.triangles);
    s.number(r.charts), s.number(r.degenerate), s.number(r.openEdges);
    s.number(r.nonManifoldEdges), s.number(r.seamEdges), s.number(r.realTexels);
    s.number(r.forcedTexels), s.number(r.rimTexels), s.number(r.overlaps), s.number(r.linksOpen);
    s.number(r.linksLost), s.number(r.readerless), s.number(r.usedOwnUv);
    s.number(r.rechartedTriangles);
}

struct Counts {
    uint32_t linkWords = 0, readers = 0, vertices = 0, indices = 0;
};

// Bytes a record takes in the file.
constexpr size_t kTexelBytes = sizeof(TexelPosition) + 4 + 4 + 2 + 2 + 4;

template <typename Stream, typename Domain>
void scalars(Stream& s, Domain& d, Counts& counts) {
    s.number(d.width), s.number(d.height), s.number(d.quantum), s.number(d.texelSide);
    s.number(d.linkShort), s.number(d.linkMax), s.number(d.materialCount), s.number(d.hasDetail);
    for (int k = 0; k < 3; ++k)
        s.number(d.origin[k]), s.number(d.boundsLow[k]), s.number(d.boundsHigh[k]);
    s.number(counts.linkWords), s.number(counts.readers);
    s.number(counts.vertices), s.number(counts.indices);
    reportRecord(s, d.report);
}

template <typename Stream, typename Domain>
void arrays(Stream& s, Domain& d) {
    const auto all = [&](auto& array) {
        for (auto& element : array) record(s, element);
    };
    all(d.texels), all(d.normals), all(d.areas), all(d.thickness), all(d.slowness);
    all(d.triangleOf), all(d.tiles), all(d.links), all(d.readers), all(d.vertices);
    all(d.sources), all(d.indices);
}

[[noreturn]] void refuse(const char* what, uint64_t element, uint64_t value, uint64_t limit) {
    core::fail(FW_ERROR_BAD_DATA, "%s %llu of the cooked mesh is %llu; it must be less than %llu.",
               what, static_cast<unsigned long long>(element),
               static_cast<unsigned long long>(value), static_cast<unsigned long long>(limit));
}
void require(bool holds, const char* what, uint64_t element) {
    if (!holds)
        core::fail(FW_ERROR_BAD_DATA, "%s (element %llu) of the cooked mesh is not consistent.",
                   what, static_cast<unsigned long long>(element));
}
bool usable(float v) { return std::isfinite(v) && std::abs(v) < 1e7f; }

// Every index is in range, and every invariant of burn_domain.h holds.
void checkTexels(const BurnDomain& d) {
    for (uint32_t i = 0; i < d.texelCount(); ++i) {
        const uint32_t flags = d.texels[i].materialFlags;
        require((flags & ~uint32_t(0xFF | kTexelReal | kTexelRim | kTexelForced)) == 0 &&
                    ((flags & kTexelReal) != 0 || flags == 0),
                "Flags of a texel", i);
        if ((flags & 0xFF) >= d.materialCount)
            refuse("Material of texel", i, flags & 0xFF, d.materialCount);
        require((d.slowness[i] != 0) == d.real(i), "Slowness of a texel", i);
        require(d.areas[i] >= 0 && d.areas[i] < 1e12f, "Area of a texel", i);
        if (d.real(i) ? d.triangleOf[i] >= d.indices.size() / 3 : d.triangleOf[i] != kNone)
            refuse("Triangle of texel", i, d.triangleOf[i], d.indices.size() / 3);
        if (!d.real(i) || (flags & kTexelRim)) continue;
        const uint32_t x = i % d.width, y = i / d.width;
        bool whole = x > 0 && y > 0 && x + 1 < d.width && y + 1 < d.height;
        for (size_t k = 0; k < 8 && whole; ++k)
            whole = d.real(uint32_t(int(i) + kRingY[k] * int(d.width) + kRingX[k]));
        require(whole, "Ring of a texel without a link record", i);
    }
}

void checkTiles(const BurnDomain& d) {
    uint32_t records = 0, readers = 0;
    for (uint32_t t = 0; t < d.tileCount(); ++t) {
        const TileStatic& tile = d.tiles[t];
        const uint64_t rim = uint64_t(tile.rimMaskHigh) << 32 | tile.rimMaskLow;
        require(tile.rimBase == records, "First link record of a tile", t);
        require(tile.dependentStart == readers && tile.dependentCount <= d.readers.size() - readers,
                "Readers of a tile", t);
        records += uint32_t(std::popcount(rim));
        readers += tile.dependentCount;
        const TileTexels texels = d.texelsOf(t);
        for (uint32_t lane = 0; lane < kTileLanes; ++lane) {
            const uint32_t texel = texels[lane];
            const bool isRim = (d.texels[texel].materialFlags & kTexelRim) != 0;
            require(isRim == ((rim >> lane & 1) != 0), "Rim mask of a tile", t);
        }
    }
    require(uint64_t(records) * 8 == d.links.size(), "Number of link records", records);
    require(readers == d.readers.size(), "Number of readers", readers);
    for (size_t i = 0; i < d.readers.size(); ++i)
        if (d.readers[i] >= d.tileCount()) refuse("Reader", i, d.readers[i], d.tileCount());
    for (size_t i = 0; i < d.links.size(); ++i) {
        if (d.links[i] == kNone) continue;
        if (d.links[i] >= d.texelCount()) refuse("Link", i, d.links[i], d.texelCount());
        require(d.real(d.links[i]), "Target of a link", i);
    }
}

// Limits of the integer products of shaders/shared/front.h: links of at most kLongest units, and
// normals no longer than a rounded unit vector.
void checkFront(const BurnDomain& d) {
    constexpr int64_t kLongest = 8191;
    constexpr double kUnit = 16384 * 1.01;  // Q14
    const auto checkLink = [&](uint32_t from, uint32_t to) {
        const TexelPosition &a = d.texels[from], &b = d.texels[to];
        const int64_t x = int64_t(a.x) - b.x, y = int64_t(a.y) - b.y, z = int64_t(a.z) - b.z;
        const int64_t squared = x * x + y * y + z * z;
        if (squared > kLongest * kLongest)
            core::fail(
                FW_ERROR_BAD_DATA,
                "Positions of texels %u and %u of the cooked mesh, which are neighbours, are %.0f "
                "units apart; the limit is %lld. Cook the mesh again.",
                from, to, std::sqrt(double(squared)), static_cast<long long>(kLongest));
    };
    uint32_t real = 0;
    double area = 0;
    for (uint32_t t = 0; t < d.tileCount(); ++t) {
        uint32_t record = d.tiles[t].rimBase;
        const TileTexels texels = d.texelsOf(t);
        for (uint32_t lane = 0; lane < kTileLanes; ++lane) {
            const uint32_t texel = texels[lane];
            if (!d.real(texel)) continue;
            ++real;
            area += double(d.areas[texel]);
            const gpu::ivec3 n = gpu::decodeNormal(d.normals[texel]);
            const double length = std::hypot(double(n.x), double(n.y), double(n.z));
            if (length > kUnit)
                core::fail(
                    FW_ERROR_BAD_DATA,
                    "The normal of texel %u of the cooked mesh has length %.3f; the limit is 1.01.",
                    texel, length / 16384);
            const bool isRim = (d.texels[texel].materialFlags & kTexelRim) != 0;
            for (size_t k = 0; k < 8; ++k) {
                const uint32_t to =
                    isRim ? d.links[size_t(record) * 8 + k]
                          : uint32_t(int(texel) + kRingY[k] * int(d.width) + kRingX[k]);
                if (to != kNone) checkLink(texel, to);
            }
            record += isRim ? 1 : 0;
        }
    }
    if (real != d.report.realTexels)
        core::fail(FW_ERROR_BAD_DATA,
                   "The cooked mesh has %u texels of the surface; its report says %u.", real,
                   d.report.realTexels);
    if (!(std::abs(area - d.report.texelArea) <= 0.001 * area))
        core::fail(FW_ERROR_BAD_DATA,
                   "The texels of the cooked mesh have %g m^2 in all; its report says %g.", area,
                   d.report.texelArea);
}

void checkDrawn(const BurnDomain& d) {
    for (size_t i = 0; i < d.indices.size(); ++i)
        if (d.indices[i] >= d.vertices.size()) refuse("Index", i, d.indices[i], d.vertices.size());
    for (size_t i = 0; i < d.vertices.size(); ++i) {
        const RenderVertex& v = d.vertices[i];
        bool finite = true;
        for (float c : v.position) finite &= usable(c);
        for (float c : v.textureUv) finite &= usable(c);
        for (float c : v.detail) finite &= usable(c);
        finite &= v.atlasUv[0] >= 0 && v.atlasUv[0] <= float(d.width) && v.atlasUv[1] >= 0 &&
                  v.atlasUv[1] <= float(d.height);
        require(finite, "A vertex", i);
        if (v.material >= d.materialCount)
            refuse("Material of vertex", i, v.material, d.materialCount);
        if (d.sources[i] >= d.report.vertices)
            refuse("Source of vertex", i, d.sources[i], d.report.vertices);
    }
}

void checkScalars(const BurnDomain& d) {
    for (uint32_t side : {d.width, d.height})
        if (side < 8 || side > 4096 || side % 8 != 0)
            core::fail(FW_ERROR_BAD_DATA,
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
                "Bounds", uint64_t(k));
}

// FNV-1a over the header before the checksum, and the payload after it.
uint64_t checksumOf(std::span<const std::byte> head, std::span<const std::byte> payload) {
    return hashBytes(payload, hashBytes(head));
}

uint64_t hashMore(uint64_t hash, const void* data, size_t bytes) {
    const uint64_t size = bytes;
    hash = hashBytes(std::as_bytes(std::span(&size, 1)), hash);
    return hashBytes({static_cast<const std::byte*>(data), bytes}, hash);
}

}  // namespace

uint64_t bakeKey(const BakeInput& input) noexcept {
    uint64_t hash = core::kFnvOffset;
    const auto add = [&](const auto& array) {
        hash = hashMore(hash, array.data(), array.size_bytes());
    };
    const auto addValue = [&](auto value) { hash = hashMore(hash, &value, sizeof value); };
    addValue(kBakeVersion);
    add(input.positions), add(input.normals), add(input.uvs), add(input.details);
    add(input.tints), add(input.indices), add(input.triangleMaterials);
    addValue(input.texelsPerMetre), addValue(input.maxSide), addValue(input.noiseAmplitude);
    addValue(input.noiseFeature), addValue(input.noiseSeed), addValue(uint8_t(input.trustUvs));
    return hash;
}

std::pmr::vector<std::byte> writeCooked(const BurnDomain& domain, uint64_t key,
                                        std::pmr::memory_resource* memory) {
    std::pmr::vector<std::byte> out(memory);
    out.reserve(kHeaderBytes + 512 + domain.texelCount() * kTexelBytes +
                domain.tiles.size() * sizeof(TileStatic) + domain.links.size() * 4 +
                domain.readers.size() * 4 + domain.vertices.size() * (sizeof(RenderVertex) + 4) +
                domain.indices.size() * 4);
    FW_ASSERT(domain.tiles.size() == domain.tileCount() &&
                  domain.texels.size() == domain.texelCount() &&
                  domain.sources.size() == domain.vertices.size(),
              "%zu tiles, %zu texels, %zu sources", domain.tiles.size(), domain.texels.size(),
              domain.sources.size());
    out.resize(kHeaderBytes);
    Writer writer(out);
    Counts counts{uint32_t(domain.links.size()), uint32_t(domain.readers.size()),
                  uint32_t(domain.vertices.size()), uint32_t(domain.indices.size())};
    scalars(writer, domain, counts);
    arrays(writer, domain);

    std::pmr::vector<std::byte> header(memory);
    header.reserve(kHeaderBytes);
    Writer headerWriter(header);
    headerWriter.number(kMagic);
    headerWriter.number(kVersion);
    headerWriter.number(key);
    headerWriter.number(uint64_t(out.size() - kHeaderBytes));
    headerWriter.number(checksumOf(header, std::span(out).subspan(kHeaderBytes)));
    FW_ASSERT(header.size() == kHeaderBytes, "%zu bytes", header.size());
    std::copy(header.begin(), header.end(), out.begin());
    return out;
}

uint64_t cookedKey(std::span<const std::byte> bytes) {
    if (bytes.size() < kHeaderBytes)
        core::fail(FW_ERROR_BAD_DATA, "The cooked mesh has %zu bytes; its header alone has %zu.",
                   bytes.size(), kHeaderBytes);
    Reader header(bytes.first(kHeaderBytes), kWhat);
    uint32_t magic = 0, version = 0;
    uint64_t key = 0;
    header.number(magic);
    header.number(version);
    header.number(key);
    if (magic != kMagic)
        core::fail(FW_ERROR_BAD_DATA,
                   "The cooked mesh begins with 0x%08X; 0x%08X (\"FWBD\") is expected.", magic,
                   kMagic);
    if (version != kVersion)
        core::fail(FW_ERROR_BAD_DATA,
                   "The cooked mesh has format version %u; this library reads version %u.", version,
                   kVersion);
    return key;
}

BurnDomain readCooked(std::span<const std::byte> bytes, std::pmr::memory_resource* memory) {
    cookedKey(bytes);
    Reader header(bytes.subspan(16), kWhat);
    uint64_t size = 0, checksum = 0;
    header.number(size);
    header.number(checksum);
    const auto payload = bytes.subspan(kHeaderBytes);
    if (size != payload.size())
        core::fail(FW_ERROR_BAD_DATA,
                   "The cooked mesh has %zu bytes of payload; its header says "
                   "%llu.",
                   payload.size(), static_cast<unsigned long long>(size));
    const uint64_t found = checksumOf(bytes.first(kHeaderBytes - sizeof checksum), payload);
    if (found != checksum)
        core::fail(FW_ERROR_BAD_DATA,
                   "The cooked mesh's checksum is 0x%016llX; its header says 0x%016llX.",
                   static_cast<unsigned long long>(found),
                   static_cast<unsigned long long>(checksum));

    BurnDomain domain(memory);
    Reader reader(payload, kWhat);
    Counts counts;
    scalars(reader, domain, counts);
    checkScalars(domain);
    domain.tilesX = domain.width / kTileSide;
    domain.tilesY = domain.height / kTileSide;
    // Sizes before memory: the arrays must need exactly the bytes that are left.
    const uint64_t texels = domain.texelCount();
    const uint64_t expected = texels * kTexelBytes +
                              uint64_t(domain.tileCount()) * sizeof(TileStatic) +
                              (uint64_t(counts.linkWords) + counts.readers + counts.indices) * 4 +
                              uint64_t(counts.vertices) * (sizeof(RenderVertex) + 4);
    if (expected != reader.left())
        core::fail(FW_ERROR_BAD_DATA, "The cooked mesh's arrays need %llu bytes; it has %zu.",
                   static_cast<unsigned long long>(expected), reader.left());
    require(counts.linkWords % 8 == 0 && counts.indices % 3 == 0, "Number of links or indices", 0);
    domain.texels.resize(texels);
    domain.normals.resize(texels);
    domain.areas.resize(texels);
    domain.thickness.resize(texels);
    domain.slowness.resize(texels);
    domain.triangleOf.resize(texels);
    domain.tiles.resize(domain.tileCount());
    domain.links.resize(counts.linkWords);
    domain.readers.resize(counts.readers);
    domain.vertices.resize(counts.vertices);
    domain.sources.resize(counts.vertices);
    domain.indices.resize(counts.indices);
    arrays(reader, domain);
    checkTexels(domain);
    checkTiles(domain);
    checkFront(domain);
    checkDrawn(domain);
    buildTileBounds(domain);
    linkParts(domain, memory);
    return domain;
}

}  // namespace fw::mesh
