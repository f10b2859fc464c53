// The header of a save, and an object's image as planes.
#include "core/hash.h"
#include "shared/heat.h"
#include "world/save.h"

#include <algorithm>

namespace fw::world {
namespace {

constexpr char kMagic[] = "FWSV";
constexpr size_t kHeaderBytes = 24;
constexpr const char* kSaveName = "save";

// FNV-1a over 8 bytes at a time, the last few one by one: saves are large.
uint64_t checksum(std::span<const std::byte> bytes) noexcept {
    uint64_t hash = core::kFnvOffset;
    size_t at = 0;
    for (; at + 8 <= bytes.size(); at += 8) {
        uint64_t word = 0;
        for (size_t k = 0; k < 8; ++k) word |= uint64_t(bytes[at + k]) << (8 * k);
        hash = (hash ^ word) * core::kFnvPrime;
        hash ^= hash >> 29;
    }
    for (; at < bytes.size(); ++at) hash = (hash ^ uint64_t(bytes[at])) * core::kFnvPrime;
    return hash;
}

// A texel's code as a small number: 5 is a source, whose tick is in another plane.
constexpr uint32_t kClassSource = 5;
constexpr uint32_t kClassCodes[kClassSource] = {gpu::kNever, gpu::kInert, gpu::kWet, gpu::kOut,
                                                gpu::kOutWet};
uint32_t classOf(uint32_t code) noexcept {
    if (gpu::isSource(code)) return kClassSource;
    uint32_t found = 0;
    while (found + 1 < kClassSource && kClassCodes[found] != code) ++found;
    return found;
}

// Fields of a packed HeatTexel, by word and bits.
struct HeatField {
    uint32_t word, shift, bits;
};
constexpr HeatField kHeatFields[] = {{0, 0, 16}, {0, 16, 16}, {1, 0, 10}, {1, 10, 2},
                                     {1, 12, 8}, {1, 20, 8},  {1, 28, 2}, {1, 30, 2}};

constexpr uint32_t kKeptBits[] = {gpu::kTileListed, gpu::kTileBurning, gpu::kTileHot,
                                  gpu::kTileWarm};

// Both directions: `image` is an ObjectImage on a writer and an ImageStore on a reader, whose
// arrays have their sizes and the values of what no plane holds.
template <class A, class Image>
void visitImage(A& a, Image& image, const mesh::BurnDomain& domain, uint32_t tick, uint32_t window,
                std::pmr::memory_resource* memory) {
    const uint32_t texels = domain.texelCount(), tiles = domain.tileCount();
    std::pmr::vector<uint8_t> real(texels, 0, memory), sources(texels, 0, memory);
    for (uint32_t i = 0; i < texels; ++i) real[i] = domain.real(i) ? 1 : 0;
    a.plane(
        "states", texels, domain.width, real, kClassSource,
        [&](size_t i) {
            const uint32_t found = classOf(image.ticks[i]);
            sources[i] = real[i] != 0 && found == kClassSource ? 1 : 0;
            return found;
        },
        [&](auto i, auto found) {
            sources[i] = real[i] != 0 && found == kClassSource ? 1 : 0;
            if (real[i] != 0 && found < kClassSource) image.ticks[i] = kClassCodes[found];
        });
    a.plane(
        "ignition ticks", texels, domain.width, sources, gpu::kLiveEnd - 1,
        [&](size_t i) { return image.ticks[i]; },
        [&](auto i, auto t) {
            if (sources[i] != 0) image.ticks[i] = t;
        });
    const bool expected = !image.heat.empty();
    bool heated = expected;
    a(heated);
    if (heated != expected)
        core::failData("The save has %s heat for an object that has %s.", heated ? "some" : "no",
                       heated ? "none" : "some");
    for (const HeatField& field : kHeatFields) {
        if (!heated) break;
        const uint32_t mask = (1u << field.bits) - 1;
        a.plane(
            "heat", texels, domain.width, real, mask,
            [&](size_t i) {
                return ((field.word == 0 ? image.heat[i].x : image.heat[i].y) >> field.shift) &
                       mask;
            },
            [&](auto i, auto value) {
                if (real[i] != 0)
                    (field.word == 0 ? image.heat[i].x : image.heat[i].y) |= value << field.shift;
            });
    }
    const auto perTile = [&](const char* name, uint32_t most, const auto& get, const auto& set) {
        a.plane(name, tiles, domain.tilesX, {}, most, get, set);
    };
    perTile(
        "tiles", 15,
        [&](size_t i) {
            uint32_t bits = 0;
            for (uint32_t bit = 0; bit < std::size(kKeptBits); ++bit)
                bits |= (image.tiles[i].flag & kKeptBits[bit]) != 0 ? 1u << bit : 0u;
            return bits;
        },
        [&](auto i, auto bits) {
            for (uint32_t bit = 0; bit < std::size(kKeptBits); ++bit)
                if ((bits >> bit & 1) != 0) image.tiles[i].flag |= kKeptBits[bit];
        });
    // Beyond the window nobody asks how long ago a tile changed.
    perTile(
        "ages of tiles", window + 1,
        [&](size_t i) {
            const uint32_t changed = image.tiles[i].lastChange;
            return changed == gpu::kNeverChanged ? window + 1 : std::min(tick - changed, window);
        },
        [&](auto i, auto age) {
            if (age <= window) image.tiles[i].lastChange = tick - age;
        });
    perTile(
        "flux to tiles", 0xFFFFFFFFu, [&](size_t i) { return image.tileHeat[i].flux; },
        [&](auto i, auto flux) { image.tileHeat[i].flux = flux; });
    perTile(
        "flames near tiles", 1, [&](size_t i) { return image.tileHeat[i].pilot; },
        [&](auto i, auto pilot) { image.tileHeat[i].pilot = pilot; });
}

}  // namespace

void writeImage(const gpu::ObjectImage& image, const mesh::BurnDomain& domain, uint32_t tick,
                uint32_t window, std::pmr::vector<std::byte>& out) {
    save::Writer writer(out);
    visitImage(writer, image, domain, tick, window, out.get_allocator().resource());
}

void readImage(std::span<const std::byte> planes, const mesh::BurnDomain& domain, uint32_t tick,
               uint32_t window, std::span<const gpu::HeatMaterial> heat, ImageStore& store) {
    const uint32_t texels = domain.texelCount(), tiles = domain.tileCount();
    store.ticks.assign(texels, gpu::kInert);
    store.heat.assign(heat.empty() ? 0 : texels, gpu::uvec2(0, 0));
    for (uint32_t i = 0; i < store.heat.size(); ++i)
        if (!domain.real(i))
            store.heat[i] =
                gpu::packHeat(gpu::unheatedTexel(heat[domain.texels[i].materialFlags & 7], false));
    store.tiles.assign(tiles, gpu::TileState{gpu::kNever, 0, gpu::kNeverChanged, 0});
    store.tileHeat.assign(tiles, gpu::TileHeat{});
    std::pmr::memory_resource* memory = store.ticks.get_allocator().resource();
    save::Reader reader(planes, kSaveName, memory);
    visitImage(reader, store, domain, tick, window, memory);
    if (reader.left() != 0)
        core::failData("%zu bytes follow an object's planes in the save.", reader.left());
}

void writeSnapshot(const Snapshot& snapshot, std::pmr::vector<std::byte>& out) {
    out.clear();
    save::Writer writer(out);
    save::writeHead(writer, kMagic, kSaveVersion);
    const uint64_t later = 0;
    writer(later, later, snapshot);
    const auto content = std::span(out).subspan(kHeaderBytes);
    writer.numberAt(8, uint64_t(content.size()));
    writer.numberAt(16, checksum(content));
}

void readSnapshot(std::span<const std::byte> bytes, Snapshot& snapshot) {
    if (bytes.size() < kHeaderBytes)
        core::failData("The save has %zu bytes; its header alone has %zu.", bytes.size(),
                       kHeaderBytes);
    save::Reader reader(bytes, kSaveName, snapshot.memory);
    uint64_t size = 0, sum = 0;
    save::readHead(reader, kMagic, kSaveVersion);
    reader(size, sum);
    const auto content = bytes.subspan(kHeaderBytes);
    if (size != content.size())
        core::failData("The save has %zu bytes of content; its header says %llu.", content.size(),
                       static_cast<unsigned long long>(size));
    const uint64_t found = checksum(content);
    if (found != sum)
        core::failData("The save's checksum is 0x%016llX; its header says 0x%016llX.",
                       static_cast<unsigned long long>(found),
                       static_cast<unsigned long long>(sum));
    reader(snapshot);
    if (reader.left() != 0)
        core::failData("%zu bytes follow the content of the save.", reader.left());
}

}  // namespace fw::world
