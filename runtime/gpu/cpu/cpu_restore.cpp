// Images of objects: taken at a frame's end, and put back. Images hold no lists: the tiles' flags
// say which lists they are in, and touched tiles find their pending arrivals again.
#include "gpu/cpu/cpu_state.h"
#include "gpu/extension.h"

#include <algorithm>

namespace fw::gpu::cpu {

void CpuBackend::State::reserveImages(ImageStore& store, std::span<const uint32_t> slots,
                                      bool whole) const {
    size_t texels = 0, heated = 0, tileCount = 0;
    for (const uint32_t slot : slots)
        if (const CpuObject* object = find(slot)) {
            texels += object->state.size();
            heated += object->heat.size();
            tileCount += whole ? object->record.tileCount : 0;
        }
    store.ticks.resize(texels);
    store.heat.resize(heated);
    store.tiles.resize(tileCount);
    store.tileHeat.resize(tileCount);
    store.images.clear();
    store.images.reserve(slots.size());
}

void CpuBackend::State::collectImages(ImageStore& store, std::span<const uint32_t> slots,
                                      bool whole) const noexcept {
    std::span ticks(store.ticks);
    std::span heat(store.heat);
    std::span imageTiles(store.tiles);
    std::span imageHeat(store.tileHeat);
    for (const uint32_t slot : slots) {
        const CpuObject* object = find(slot);
        if (!object) continue;
        FW_ASSERT(store.images.size() < store.images.capacity(), "%zu images", store.images.size());
        ObjectImage& image = store.images.emplace_back();
        image.object = slot;
        image.ticks = copyNext<uint32_t>(object->state, ticks);
        image.heat = copyNext<uvec2>(object->heat, heat);
        if (!whole) continue;
        const size_t first = object->record.worldTileBase, count = object->record.tileCount;
        image.tiles = copyNext(std::span(tiles).subspan(first, count), imageTiles);
        image.tileHeat = copyNext(std::span(tileHeat).subspan(first, count), imageHeat);
        image.counters = object->counters;
    }
    FW_ASSERT(ticks.empty() && heat.empty() && imageTiles.empty() && imageHeat.empty(),
              "%zu texels and %zu with heat are left", ticks.size(), heat.size());
}

void CpuBackend::State::resetObject(CpuObject& object, uint32_t slot) noexcept {
    const mesh::BurnDomain& domain = *object.domain;
    const std::span<const uint16_t> slow = object.slownessOf();
    for (uint32_t i = 0; i < object.state.size(); ++i) {
        const uint32_t flags = domain.texels[i].materialFlags;
        const bool burns = canTexelBurn(flags, slow[i], object.materials[flags & 7].flags);
        object.state[i] = burns ? kNever : kInert;
    }
    if (!object.heat.empty()) createHeat(object);
    if (!object.extended.empty()) {
        std::fill(object.extended.begin(), object.extended.end(), 0.0f);
        extension()->cpu->create(object);  // allocates nothing: its planes have their size
    }
    object.counters = {};
    std::fill(object.sources.begin(), object.sources.end(), FireSource{});
    object.gives = false;
    const uint32_t first = object.record.worldTileBase;
    for (uint32_t worldTile = first; worldTile < first + object.record.tileCount; ++worldTile) {
        tiles[worldTile] = {kNever, 0, kNeverChanged, slot};
        tileHeat[worldTile] = {};
        tileFire[worldTile] = 0;
    }
}

void CpuBackend::restore(std::span<const RestoredObject> restored, uint32_t tick) {
    State& s = *state_;
    for (auto* entries : {&s.list, &s.listOut, &s.runList, &s.burnList, &s.hotList, &s.hotOut})
        entries->clear();
    s.burnTiles.clear();
    s.goneBurning = s.goneListed = s.goneHot = 0;
    s.scheduledBurning = s.reducedBurning = s.receivers = 0;
    s.head = s.waiting = 0;
    s.neighbours.clear();
    s.links.clear();
    s.occluders.clear();
    s.occlusion = {};
    for (uint32_t slot = 0; slot < s.objects.size(); ++slot) {
        if (!s.objects[slot]) continue;
        s.resetObject(*s.objects[slot], slot);
        s.objects[slot]->exchangeObject = {};
    }
    for (const RestoredObject& one : restored) {
        const ObjectImage& image = one.image;
        CpuObject& object = s.at(image.object);
        object.counters = image.counters;
        if (one.sleeps) continue;
        std::copy_n(one.materials, kMaterialsPerObject, object.materials.begin());
        object.record.window = one.window;
        object.record.substepShift = one.substepShift;
        FW_ASSERT(image.ticks.size() == object.state.size(), "%zu of %zu texels",
                  image.ticks.size(), object.state.size());
        FW_ASSERT(image.heat.size() == object.heat.size(), "%zu of %zu texels with heat",
                  image.heat.size(), object.heat.size());
        FW_ASSERT(image.tiles.size() == object.record.tileCount &&
                      image.tileHeat.size() == image.tiles.size(),
                  "%zu of %u tiles", image.tiles.size(), object.record.tileCount);
        std::copy(image.ticks.begin(), image.ticks.end(), object.state.begin());
        std::copy(image.heat.begin(), image.heat.end(), object.heat.begin());
        const uint32_t base = object.record.worldTileBase;
        for (uint32_t local = 0; local < object.record.tileCount; ++local) {
            FW_ASSERT((image.tiles[local].flag & kTileHot) == 0 || !object.heat.empty(),
                      "tile %u of an object without heat is hot", local);
            const uint32_t kept = image.tiles[local].flag & kTileKept;
            const uint32_t worldTile = base + local;
            s.tiles[worldTile].lastChange = image.tiles[local].lastChange;
            s.tileHeat[worldTile] = image.tileHeat[local];
            if ((kept & kTileListed) != 0) s.touch(worldTile, kTileTouched);
            if ((kept & kTileBurning) != 0) s.append(s.burnList, worldTile);
            if ((kept & kTileHot) != 0) s.append(s.hotList, worldTile);
            s.tiles[worldTile].flag |= kept;
        }
    }
    s.showsDue = true;  // in the next frame, when objects have the poses of the save
    s.showsTick = tick;
}

void CpuBackend::moveWorld(const double (&by)[3]) noexcept {
    for (BurnTile& tile : state_->burnTiles)
        for (int i = 0; i < 3; ++i)
            tile.positionArea[i] = float(double(tile.positionArea[i]) + by[i]);
}

// Lights from the first frame on; counts stay those of the save until the next reduction.
void CpuBackend::State::showRestored() noexcept {
    if (!showsDue) return;
    showsDue = false;
    burnTiles.clear();
    for (const uint32_t worldTile : burnList) {
        const BurnTile tile = burnTileOf(worldTile, showsTick, true, 0);
        if (tile.texels != 0) burnTiles.push_back(tile);
    }
}

}  // namespace fw::gpu::cpu
