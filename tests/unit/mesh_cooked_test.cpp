// The cooked mesh: reading returns what was written, and no broken file does harm.
#include <cstring>
#include <random>

#include "support/sanitized.h"
#include "unit/mesh_checks.h"

namespace {

using namespace fw;
using namespace fw::test;
using Bytes = std::pmr::vector<std::byte>;

constexpr size_t kHeader = 32;

Bytes cook(const BurnDomain& d, uint64_t key) {
    return mesh::writeCooked(d, key, std::pmr::new_delete_resource());
}
BurnDomain read(std::span<const std::byte> bytes) {
    return mesh::readCooked(bytes, std::pmr::new_delete_resource());
}
std::string refusalOf(std::span<const std::byte> bytes) {
    try {
        (void)read(bytes);
    } catch (const core::Error& error) {
        EXPECT_EQ(FW_ERROR_BAD_DATA, error.result);
        return error.message;
    }
    return "";
}
void fixChecksum(Bytes& bytes) {
    uint64_t hash = 1469598103934665603ull;
    for (size_t i = 0; i < bytes.size(); ++i) {
        if (i == 24) i = kHeader;  // all but the checksum itself
        hash ^= uint64_t(bytes[i]);
        hash *= 1099511628211ull;
    }
    for (size_t k = 0; k < 8; ++k) bytes[24 + k] = std::byte(hash >> (8 * k));
}
template <typename T>
bool sameBytes(const std::pmr::vector<T>& a, const std::pmr::vector<T>& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

BurnDomain small() {
    const Mesh mesh = makeCube(0.3, 2);
    mesh::BakeInput input = mesh.input(32);
    input.noiseAmplitude = 0.15f;
    return bakeOf(input);
}

TEST(MeshCooked, RoundTrips) {
    const BurnDomain a = small();
    const Bytes bytes = cook(a, 0x123456789ABCDEFull);
    EXPECT_EQ(0x123456789ABCDEFull, mesh::cookedKey(bytes));
    const BurnDomain b = read(bytes);
    expectSound(b);
    EXPECT_TRUE(sameBytes(a.texels, b.texels));
    EXPECT_TRUE(sameBytes(a.normals, b.normals));
    EXPECT_TRUE(sameBytes(a.areas, b.areas));
    EXPECT_TRUE(sameBytes(a.thickness, b.thickness));
    EXPECT_TRUE(sameBytes(a.slowness, b.slowness));
    EXPECT_TRUE(sameBytes(a.triangleOf, b.triangleOf));
    EXPECT_TRUE(sameBytes(a.links, b.links));
    EXPECT_TRUE(sameBytes(a.dependents, b.dependents));
    EXPECT_TRUE(sameBytes(a.tiles, b.tiles));
    EXPECT_TRUE(sameBytes(a.tileBounds, b.tileBounds));
    EXPECT_TRUE(sameBytes(a.vertices, b.vertices));
    EXPECT_TRUE(sameBytes(a.indices, b.indices));
    EXPECT_EQ(a.width, b.width);
    EXPECT_EQ(a.height, b.height);
    EXPECT_EQ(a.tilesX, b.tilesX);
    EXPECT_EQ(a.tilesY, b.tilesY);
    EXPECT_EQ(a.quantum, b.quantum);
    EXPECT_EQ(a.texelSide, b.texelSide);
    EXPECT_EQ(a.linkShort, b.linkShort);
    EXPECT_EQ(a.linkMax, b.linkMax);
    EXPECT_EQ(a.materialCount, b.materialCount);
    EXPECT_EQ(a.hasDetail, b.hasDetail);
    EXPECT_EQ(0, std::memcmp(a.origin, b.origin, sizeof a.origin));
    EXPECT_EQ(0, std::memcmp(a.boundsLow, b.boundsLow, sizeof a.boundsLow));
    EXPECT_EQ(0, std::memcmp(a.boundsHigh, b.boundsHigh, sizeof a.boundsHigh));
    EXPECT_EQ(a.report.charts, b.report.charts);
    EXPECT_EQ(a.report.meshArea, b.report.meshArea);
    EXPECT_EQ(bytes, cook(b, 0x123456789ABCDEFull));
}

TEST(MeshCooked, KeyChangesWithEveryInput) {
    Mesh mesh = makePlane(1, 1);
    const mesh::BakeInput base = mesh.input();
    std::set<uint64_t> keys{mesh::bakeKey(base)};
    const auto differs = [&](const mesh::BakeInput& input) {
        return keys.insert(mesh::bakeKey(input)).second;
    };
    EXPECT_EQ(*keys.begin(), mesh::bakeKey(base));
    mesh::BakeInput input = base;
    input.texelsPerMetre = 64;
    EXPECT_TRUE(differs(input));
    input = base, input.maxSide = 512;
    EXPECT_TRUE(differs(input));
    input = base, input.noiseAmplitude = 0.1f;
    EXPECT_TRUE(differs(input));
    input = base, input.noiseFeature = 0.02f;
    EXPECT_TRUE(differs(input));
    input = base, input.noiseSeed = 2;
    EXPECT_TRUE(differs(input));
    input = base, input.trustUvs = true;
    EXPECT_TRUE(differs(input));
    input = base, input.uvs = {};
    EXPECT_TRUE(differs(input));
    input = base, input.details = base.uvs;
    EXPECT_TRUE(differs(input));
    input = base, input.details = base.uvs, input.uvs = {};
    EXPECT_TRUE(differs(input)) << "the same numbers in another array";
    mesh.positions[0] = 0.25f;
    EXPECT_TRUE(differs(mesh.input()));
}

TEST(MeshCooked, RefusesBadFilesByName) {
    const Bytes good = cook(small(), 7);
    EXPECT_EQ("The cooked mesh has 0 bytes; its header alone has 32.", refusalOf({}));
    Bytes bytes = good;
    bytes[0] = std::byte('X');
    EXPECT_EQ("The cooked mesh begins with 0x44425758; 0x44425746 (\"FWBD\") is expected.",
              refusalOf(bytes));
    bytes = good;
    bytes[4] = std::byte(99);
    EXPECT_EQ("The cooked mesh has format version 99; this library reads version 2.",
              refusalOf(bytes));
    bytes = good;
    bytes.resize(bytes.size() - 1);
    EXPECT_NE(std::string::npos, refusalOf(bytes).find("bytes of payload; its header says"));
    bytes = good;
    bytes.back() ^= std::byte(1);
    EXPECT_NE(std::string::npos, refusalOf(bytes).find("checksum"));
    bytes = good;
    bytes[9] ^= std::byte(1);  // the key
    EXPECT_NE(std::string::npos, refusalOf(bytes).find("checksum"));
    for (size_t size = 0; size < good.size(); size += 1 + size / 40)
        EXPECT_NE("", refusalOf(std::span(good).first(size))) << size;
}

// The front's integer products hold links of at most 8191 units and unit normals.
TEST(MeshCooked, RefusesValuesBeyondTheFrontsRange) {
    const BurnDomain good = small();
    uint32_t texel = 0;
    while (!good.real(texel)) ++texel;
    const auto refused = [&](auto&& spoil) {
        BurnDomain bad = good;
        spoil(bad);
        return refusalOf(cook(bad, 7));
    };
    const auto saysOf = [](const std::string& message, const char* part) {
        EXPECT_NE(std::string::npos, message.find(part)) << message;
    };
    saysOf(
        refused([&](BurnDomain& d) { d.texels[texel].x = d.texels[texel].x < 30000 ? 65535 : 0; }),
        "units apart; the limit is 8191");
    saysOf(refused([&](BurnDomain& d) {
               for (mesh::TexelPosition& t : d.texels) t.z = uint16_t(t.z * 7919u);
           }),
           "units apart; the limit is 8191");
    saysOf(refused([&](BurnDomain& d) { d.normals[texel] = 0x400u | 0x400u << 11 | 0x200u << 22; }),
           "has length 1.73");
    saysOf(refused([&](BurnDomain& d) { ++d.report.realTexels; }), "its report says");
    saysOf(refused([&](BurnDomain& d) { d.report.texelArea = std::nan(""); }),
           "its report says nan");
    saysOf(refused([&](BurnDomain& d) { d.areas[texel] = 1e30f; }), "Area of a texel");
    saysOf(refused([&](BurnDomain& d) { d.quantum = 1e9f; }), "Size of a texel");
    EXPECT_EQ("", refused([](BurnDomain&) {}));
}

// Reads everything that simulation and drawing read by index.
uint64_t touch(const BurnDomain& d) {
    uint64_t sum = 0;
    for (uint32_t i = 0; i < d.texelCount(); ++i) {
        if (!d.real(i)) continue;
        for (uint32_t k = 0; k < 8; ++k) {
            const uint32_t j = ringOf(d, i, k);
            if (j != kNone) sum += d.texels.at(j).x;
        }
        sum += d.indices.at(d.triangleOf[i] * 3);
    }
    for (const mesh::TileStatic& tile : d.tiles)
        for (uint32_t r = 0; r < tile.dependentCount; ++r)
            sum += d.tiles.at(d.dependents.at(tile.dependentStart + r)).rimBase;
    for (uint32_t index : d.indices) sum += d.vertices.at(index).tint;
    return sum;
}

TEST(MeshCooked, SurvivesAnyDamagedByte) {
    const Bytes good = cook(small(), 7);
    std::mt19937 random(11);
    constexpr uint32_t kRounds = rounds(4000, 1000);
    uint32_t refused = 0, read = 0;
    for (uint32_t round = 0; round < kRounds; ++round) {
        Bytes bytes = good;
        const bool fixed = round % 8 != 0;  // with a valid checksum the reader itself must refuse
        const size_t from = fixed ? kHeader : 0;
        for (uint32_t n = 1 + random() % 4; n > 0; --n) {
            // Half the time in the scalars, which do the greatest harm.
            const size_t range =
                random() % 2 ? std::min<size_t>(300, bytes.size() - from) : bytes.size() - from;
            const size_t at = from + random() % range;
            bytes[at] = random() % 3 ? std::byte(random()) : std::byte(0xFF);
        }
        if (fixed) fixChecksum(bytes);
        try {
            const BurnDomain d = mesh::readCooked(bytes, std::pmr::new_delete_resource());
            touch(d);
            ++read;
        } catch (const core::Error& error) {
            ASSERT_EQ(FW_ERROR_BAD_DATA, error.result);
            ++refused;
        }
    }
    EXPECT_GT(refused, kRounds / 4);
    EXPECT_GT(read, kRounds / 40) << "harmless changes (a colour, an area) are read";
}

}  // namespace
