// Blocks of tiles of one object that differ between two saves of the same tick: found by their
// hashes, written as planes of their own, and merged into the other save.
#include "core/hash.h"
#include "core/stream.h"
#include "world/save.h"

#include <algorithm>

namespace fw::world {
namespace {

constexpr uint32_t kTileSide = 8;  // texels

struct BlockGrid {
    uint32_t side = 8;  // tiles
    uint32_t across = 0, down = 0;
    [[nodiscard]] uint32_t count() const noexcept { return across * down; }
};

BlockGrid gridOf(const mesh::BurnDomain& domain) noexcept {
    BlockGrid grid;
    for (;; grid.side *= 2) {
        grid.across = (domain.tilesX + grid.side - 1) / grid.side;
        grid.down = (domain.tilesY + grid.side - 1) / grid.side;
        if (grid.count() <= kMaxBlocks) return grid;
    }
}

// Blocks below each other, as a map of their own. at(stripe index, map index, texels or tiles).
template <class At>
void eachCell(const BlockGrid& grid, std::span<const uint32_t> blocks, uint32_t cellsPerTile,
              uint32_t width, uint32_t height, const At& at) {
    const uint32_t side = grid.side * cellsPerTile;
    size_t to = 0;
    for (const uint32_t block : blocks) {
        FW_ASSERT(block < grid.count(), "block %u of %u", block, grid.count());
        const uint32_t left = block % grid.across * side, top = block / grid.across * side;
        for (uint32_t y = 0; y < side; ++y)
            for (uint32_t x = 0; x < side; ++x, ++to)
                if (left + x < width && top + y < height)
                    at(to, size_t(top + y) * width + left + x);
    }
}

mesh::BurnDomain stripeOf(const mesh::BurnDomain& domain, const BlockGrid& grid,
                          std::span<const uint32_t> blocks, std::pmr::memory_resource* memory) {
    mesh::BurnDomain stripe(memory);
    stripe.tilesX = grid.side;
    stripe.tilesY = grid.side * uint32_t(blocks.size());
    stripe.width = stripe.tilesX * kTileSide;
    stripe.height = stripe.tilesY * kTileSide;
    stripe.texels.resize(stripe.texelCount());  // none of them real
    eachCell(grid, blocks, kTileSide, domain.width, domain.height,
             [&](size_t to, size_t from) { stripe.texels[to] = domain.texels[from]; });
    return stripe;
}

// direction(stripe index, map index): the indices that it copies from and to.
template <class Direction>
void copyCells(const ImageStore& from, ImageStore& to, const mesh::BurnDomain& domain,
               const BlockGrid& grid, std::span<const uint32_t> blocks,
               const Direction& direction) {
    eachCell(grid, blocks, kTileSide, domain.width, domain.height, [&](size_t stripe, size_t map) {
        const auto [source, target] = direction(stripe, map);
        to.ticks[target] = from.ticks[source];
        if (!from.heat.empty()) to.heat[target] = from.heat[source];
    });
    eachCell(grid, blocks, 1, domain.tilesX, domain.tilesY, [&](size_t stripe, size_t map) {
        const auto [source, target] = direction(stripe, map);
        to.tiles[target] = from.tiles[source];
        to.tileHeat[target] = from.tileHeat[source];
    });
}

ImageStore copyTileBlocks(const ImageStore& whole, const mesh::BurnDomain& domain,
                          const BlockGrid& grid, std::span<const uint32_t> blocks,
                          std::pmr::memory_resource* memory) {
    ImageStore part(memory);
    const size_t tiles = size_t(grid.side) * grid.side * blocks.size();
    const size_t texels = tiles * kTileSide * kTileSide;
    part.ticks.assign(texels, gpu::kInert);
    part.heat.assign(whole.heat.empty() ? 0 : texels, gpu::uvec2(0, 0));
    part.tiles.assign(tiles, gpu::TileState{gpu::kNever, 0, gpu::kNeverChanged, 0});
    part.tileHeat.assign(tiles, gpu::TileHeat{});
    copyCells(whole, part, domain, grid, blocks,
              [](size_t stripe, size_t map) { return std::pair(map, stripe); });
    return part;
}

gpu::ObjectImage imageOf(const ImageStore& store, const ObjectSnapshot& object) noexcept {
    return {object.slot, store.ticks, store.heat, store.tiles, store.tileHeat, object.counters};
}

ObjectSnapshot* findObject(Snapshot& saved, uint32_t slot) noexcept {
    for (ObjectSnapshot& object : saved.objects)
        if (object.slot == slot) return &object;
    return nullptr;
}

std::pmr::vector<uint32_t> hashesOf(const ImageStore& store, const mesh::BurnDomain& domain,
                                    std::pmr::memory_resource* memory) {
    const BlockGrid grid = gridOf(domain);
    std::pmr::vector<uint32_t> hashes(memory);
    for (uint32_t block = 0; block < grid.count(); ++block) {
        uint64_t hash = core::kFnvOffset;
        const uint32_t one[] = {block};
        eachCell(grid, one, kTileSide, domain.width, domain.height, [&](size_t, size_t from) {
            const gpu::uvec2 heat = store.heat.empty() ? gpu::uvec2(0, 0) : store.heat[from];
            const uint32_t words[] = {store.ticks[from], heat.x, heat.y};
            hash = core::hashWords(words, hash);
        });
        eachCell(grid, one, 1, domain.tilesX, domain.tilesY, [&](size_t, size_t from) {
            const uint32_t words[] = {store.tiles[from].flag & gpu::kTileKept,
                                      store.tiles[from].lastChange, store.tileHeat[from].flux,
                                      store.tileHeat[from].pilot};
            hash = core::hashWords(words, hash);
        });
        hashes.push_back(uint32_t(hash) ^ uint32_t(hash >> 32));
    }
    return hashes;
}

}  // namespace

// Reads an object's planes; false: it has none in this save.
bool PersistenceSystem::readObject(std::span<const std::byte> save, uint32_t slot, Snapshot& saved,
                                   ImageStore& store) {
    readSnapshot(save, saved);
    checkSnapshot(saved);
    const ObjectSnapshot* object = findObject(saved, slot);
    if (!object || !object->touched) return false;
    components::Latch latch;
    const BurnRecords records = recordsOf(saved, *object, latch);
    readImage(object->planes, scene_.domainOf(scene_.objectAt(slot)), uint32_t(saved.clock.tick),
              records.window, records.heatSpan(), store);
    return true;
}

std::pmr::vector<uint32_t> PersistenceSystem::hashBlocks(std::span<const std::byte> save,
                                                         uint32_t slot) {
    Snapshot saved(context_.memory);
    ImageStore store(context_.memory);
    if (!readObject(save, slot, saved, store)) return std::pmr::vector<uint32_t>(context_.memory);
    return hashesOf(store, scene_.domainOf(scene_.objectAt(slot)), context_.memory);
}

bool PersistenceSystem::writeBlocks(std::span<const std::byte> save, uint32_t slot,
                                    std::span<const uint32_t> theirs,
                                    std::pmr::vector<std::byte>& out) {
    Snapshot saved(context_.memory);
    ImageStore store(context_.memory);
    if (!readObject(save, slot, saved, store)) return false;
    const mesh::BurnDomain& domain = scene_.domainOf(scene_.objectAt(slot));
    const BlockGrid grid = gridOf(domain);
    const std::pmr::vector<uint32_t> ours = hashesOf(store, domain, context_.memory);
    if (theirs.size() != ours.size()) return false;
    std::pmr::vector<uint32_t> blocks(context_.memory);
    for (uint32_t i = 0; i < ours.size(); ++i)
        if (ours[i] != theirs[i]) blocks.push_back(i);
    Snapshot part(context_.memory);
    part.clock = saved.clock;
    ObjectSnapshot& object = part.objects.emplace_back(*findObject(saved, slot));
    components::Latch latch;
    const uint32_t window = recordsOf(saved, object, latch).window;
    std::pmr::vector<std::byte> planes(context_.memory);
    core::Writer writer(planes);
    writer.number(uint32_t(blocks.size()));
    for (const uint32_t block : blocks) writer.number(block);
    const mesh::BurnDomain stripe = stripeOf(domain, grid, blocks, context_.memory);
    const ImageStore taken = copyTileBlocks(store, domain, grid, blocks, context_.memory);
    writeImage(imageOf(taken, object), stripe, uint32_t(saved.clock.tick), window, planes);
    object.planes = planes;
    writeSnapshot(part, out);
    return true;
}

void PersistenceSystem::mergeBlocks(std::span<const std::byte> save,
                                    std::span<const std::byte> theirs,
                                    std::pmr::vector<std::byte>& out) {
    Snapshot part(context_.memory), saved(context_.memory);
    readSnapshot(theirs, part);
    ImageStore store(context_.memory), taken(context_.memory);
    if (part.objects.size() != 1 || !readObject(save, part.objects[0].slot, saved, store) ||
        part.clock.tick != saved.clock.tick || !part.objects[0].touched)
        core::failData("The tiles are of tick %llu and another state.",
                       static_cast<unsigned long long>(part.clock.tick));
    const ObjectSnapshot& from = part.objects[0];
    const mesh::BurnDomain& domain = scene_.domainOf(scene_.objectAt(from.slot));
    const BlockGrid grid = gridOf(domain);
    core::Reader reader(from.planes, "state");
    const uint32_t count = reader.count("blocks of tiles", sizeof(uint32_t));
    std::pmr::vector<uint32_t> blocks(context_.memory);
    for (uint32_t i = 0; i < count; ++i) {
        reader.number(blocks.emplace_back());
        if (blocks[i] >= grid.count() || (i > 0 && blocks[i] <= blocks[i - 1]))
            core::failData("The tiles are of block %u; there are %u.", blocks[i], grid.count());
    }
    ObjectSnapshot& object = *findObject(saved, from.slot);
    object = from;
    checkSnapshot(saved);
    components::Latch latch;
    const BurnRecords records = recordsOf(saved, object, latch);
    const auto tick = uint32_t(saved.clock.tick);
    readImage(reader.take(reader.left()), stripeOf(domain, grid, blocks, context_.memory), tick,
              records.window, records.heatSpan(), taken);
    copyCells(taken, store, domain, grid, blocks,
              [](size_t stripe, size_t map) { return std::pair(stripe, map); });
    std::pmr::vector<std::byte> planes(context_.memory);
    writeImage(imageOf(store, object), domain, tick, records.window, planes);
    object.planes = planes;
    writeSnapshot(saved, out);
}

}  // namespace fw::world
