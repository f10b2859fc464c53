// Restores objects of a snapshot: every object is created again, what the images hold is copied
// over that, and the tiles join their lists. All of it is recorded with the next frame.
#include "gpu/vk/frame_needs.h"

#include <algorithm>
#include <cstring>

namespace fw::gpu::vk {
namespace {

// What was wetted or put out shows in looks of its own.
bool showsWater(const ObjectImage& image) noexcept {
    const auto wet = [](uint32_t t) { return t == kWet || t == kOut || t == kOutWet; };
    return std::any_of(image.ticks.begin(), image.ticks.end(), wet) ||
           std::any_of(image.heat.begin(), image.heat.end(),
                       [](const uvec2& texel) { return (texel.y & 0x3FFu) != 0; });
}

void stageImage(VkBackend::State& s, const ObjectImage& image) {
    const BurnObject& record = s.scene.objects[image.object].record;
    PendingUpload& upload =
        s.stage(image.ticks.size_bytes() + image.heat.size_bytes() + image.tiles.size_bytes() +
                    image.tileHeat.size_bytes() + sizeof image.counters,
                "restore staging");
    uint64_t from = 0;
    const auto add = [&](uint32_t resource, uint64_t at, const void* data, uint64_t bytes) {
        if (bytes == 0) return;
        std::memcpy(upload.staging.mapped + from, data, bytes);
        upload.regions[upload.regionCount++] = {resource, from, at, bytes};
        from += bytes;
    };
    add(FW_BIND_STATE, uint64_t(record.stateBase) * 4, image.ticks.data(),
        image.ticks.size_bytes());
    add(FW_BIND_HEAT, uint64_t(record.heatBase) * sizeof(uvec2), image.heat.data(),
        image.heat.size_bytes());
    const uint64_t tilesFrom = from;
    add(FW_BIND_TILE_STATE, uint64_t(record.worldTileBase) * sizeof(TileState), image.tiles.data(),
        image.tiles.size_bytes());
    for (size_t i = 0; i < image.tiles.size(); ++i) {
        const TileState tile{image.tiles[i].flag & kTileKept, 0, image.tiles[i].lastChange,
                             image.object};
        std::memcpy(upload.staging.mapped + tilesFrom + i * sizeof tile, &tile, sizeof tile);
    }
    add(FW_BIND_TILE_HEAT, uint64_t(record.worldTileBase) * sizeof(TileHeat), image.tileHeat.data(),
        image.tileHeat.size_bytes());
    add(FW_BIND_OBJECT_COUNTERS, uint64_t(image.object) * sizeof(ObjectCounters), &image.counters,
        sizeof image.counters);
}

}  // namespace

void VkBackend::restore(std::span<const RestoredObject> restored, uint32_t tick) {
    State& s = *state_;
    const size_t uploadsBefore = s.scene.uploads.size();
    s.scene.restores.reserve(std::max(s.scene.restores.size(), restored.size()));
    s.scene.restoredObjects.reserve(restored.size());
    try {
        for (const RestoredObject& one : restored) stageImage(s, one.image);
    } catch (...) {
        s.dropUploads(uploadsBefore);
        throw;
    }
    // One that no frame has recorded is of no use any more.
    for (PendingUpload& old : s.scene.restores) s.deviceMemory.destroy(old.staging);
    s.scene.restores.assign(s.scene.uploads.begin() + std::ptrdiff_t(uploadsBefore),
                            s.scene.uploads.end());
    s.scene.uploads.resize(uploadsBefore);
    s.scene.restoredObjects.clear();
    for (uint32_t i = 0; i < s.scene.objects.size(); ++i) {
        ObjectEntry& object = s.scene.objects[i];
        if (!object.live) continue;
        s.changed(i);
        object.resetDue = true;
        object.burn.touched = object.burn.doused = object.burn.warmed = object.burn.charred =
            object.burn.lit = false;
        object.publishedTouched = false;
        object.publishedParity = 0;
        object.burn.lastDouse = 0;
        object.burn.lastEvent = 0;
        object.deforms.softUntil = 0;
        object.refine.quietTick = 0;
        object.refine.epochTick = std::min(object.refine.epochTick, tick);
        if (object.shown.units != 0 && object.deforms.skinPlus1 == 0) object.deforms.reset = true;
    }
    for (const RestoredObject& one : restored) {
        if (one.rests) continue;
        ObjectEntry& object = s.scene.objects[one.image.object];
        std::copy_n(one.materials, kMaterialsPerObject, object.materials);
        object.record.window = one.window;
        object.record.substepShift = one.substepShift;
        object.materialsDirty = true;
        object.burn.touched = true;
        object.burn.doused = showsWater(one.image);
        object.burn.warmed =
            one.image.counters.until != 0 && (object.record.flags & kObjectHeat) != 0;
        object.burn.lastEvent = tick;
        s.scene.restoredObjects.push_back(one.image.object);
        if (one.image.counters.ignited != 0) s.recordFire(one.image.object, tick);
    }
    s.scene.recordsDirty = s.scene.restoreDue = true;
    s.simulation.shownTick = tick;
    s.simulation.links = s.simulation.occluders = 0;
    s.simulation.shield = {};
    s.results.pendingCount = 0;
    for (FrameInFlight& slot : s.ring.slots()) slot.readbackPending = false;
    s.simulation.frontEmpty = s.simulation.burnEmpty = s.simulation.predictEmpty =
        s.simulation.hotEmpty = false;
}

void VkBackend::moveWorld(const double (&by)[3]) noexcept {
    State& s = *state_;
    const vec3 metres{float(by[0]), float(by[1]), float(by[2])};
    const vec3 up{s.limits.up[0], s.limits.up[1], s.limits.up[2]};
    s.particles.particlesMove += metres;
    s.simulation.tilesMoved = true;
    for (uint32_t i = 0; i < s.scene.objects.size(); ++i) {
        ObjectEntry& object = s.scene.objects[i];
        if (!object.live || (object.deform.flags & kDeformShell) == 0) continue;
        object.deform.ground += glm::dot(metres, up);
        object.deforms.recordDirty = true;
        s.changed(i);
    }
}

namespace {

void showTiles(VkBackend::State& s, FrameRecorder& recorder) {
    recordShownTiles(recorder, s.simulation.lists, s.simulation.shownTick);
    s.simulation.tilesMoved = false;
}

}  // namespace

void recordMovedTiles(VkBackend::State& s, FrameRecorder& recorder) {
    if (s.simulation.tilesMoved && !s.simulation.burnEmpty) showTiles(s, recorder);
}

void recordRestores(VkBackend::State& s, FrameRecorder& recorder) {
    if (!s.scene.restoreDue) return;
    s.scene.restoreDue = false;
    // The lists start empty, so nobody waits for a walk through them.
    recorder.fillZero(FW_BIND_COUNTERS, 0, VK_WHOLE_SIZE);
    ++s.simulation.frontWalks, ++s.simulation.burnWalks, ++s.simulation.predictWalks,
        ++s.simulation.hotWalks;
    const Table& vk = s.device.table;
    for (PendingUpload& upload : s.scene.restores) {
        recordRegions(vk, s, upload);
        s.retired.push(s.open.ringFrame, upload.staging);
    }
    s.scene.restores.clear();
    for (const uint32_t slot : s.scene.restoredObjects) {
        const ObjectEntry& object = s.scene.objects[slot];
        if (!object.live) continue;
        const uint64_t texels = uint64_t(object.record.width) * object.record.height;
        recorder.fillZero(FW_BIND_SETTLED, uint64_t(object.record.stateBase) / 8 * 4,
                          texels / 8 * 4);
        recorder.copyBetween(FW_BIND_STATE, FW_BIND_PREDICT, uint64_t(object.record.stateBase) * 4,
                             texels * 4);
        recordRestore(recorder, s.simulation.lists, slot, object.record.tileCount);
    }
    s.scene.restoredObjects.clear();
    showTiles(s, recorder);
}

void allocateImages(VkBackend::State& s, std::span<const uint32_t> slots, ReadbackLayout& layout,
                    const std::function<uint64_t(uint64_t)>& place) {
    layout.images = !slots.empty();
    if (slots.empty()) return;
    s.results.imageLayout.clear();
    for (const uint32_t slot : slots) {
        const BurnObject& record = s.scene.objects[slot].record;
        ImageAt& at = s.results.imageLayout.emplace_back();
        at.object = slot;
        at.texels = record.width * record.height;
        at.tiles = record.tileCount;
        at.heat = (record.flags & kObjectHeat) != 0;
        at.ticksAt = place(uint64_t(at.texels) * 4);
        if (at.heat) at.heatAt = place(uint64_t(at.texels) * sizeof(uvec2));
        at.tilesAt = place(uint64_t(at.tiles) * sizeof(TileState));
        at.tileHeatAt = place(uint64_t(at.tiles) * sizeof(TileHeat));
    }
    s.results.imagesFrame = s.open.ringFrame;
}

void recordImages(VkBackend::State& s, FrameRecorder& recorder) {
    for (const ImageAt& at : s.results.imageLayout) {
        const BurnObject& record = s.scene.objects[at.object].record;
        recorder.copyOut(FW_BIND_STATE, uint64_t(record.stateBase) * 4, at.ticksAt,
                         uint64_t(at.texels) * 4);
        if (at.heat)
            recorder.copyOut(FW_BIND_HEAT, uint64_t(record.heatBase) * sizeof(uvec2), at.heatAt,
                             uint64_t(at.texels) * sizeof(uvec2));
        recorder.copyOut(FW_BIND_TILE_STATE, uint64_t(record.worldTileBase) * sizeof(TileState),
                         at.tilesAt, uint64_t(at.tiles) * sizeof(TileState));
        recorder.copyOut(FW_BIND_TILE_HEAT, uint64_t(record.worldTileBase) * sizeof(TileHeat),
                         at.tileHeatAt, uint64_t(at.tiles) * sizeof(TileHeat));
    }
}

// As they lie in the readback buffer, which is not written again before the next frame.
std::span<const ObjectImage> giveImages(VkBackend::State& s, const std::byte* from) {
    s.results.givenImages.clear();
    const auto array = [&]<class T>(uint64_t at, uint32_t count, std::span<const T>& out) {
        out = {reinterpret_cast<const T*>(from + at), count};
    };
    for (const ImageAt& at : s.results.imageLayout) {
        ObjectImage& image = s.results.givenImages.emplace_back();
        image.object = at.object;
        array(at.ticksAt, at.texels, image.ticks);
        if (at.heat) array(at.heatAt, at.texels, image.heat);
        array(at.tilesAt, at.tiles, image.tiles);
        array(at.tileHeatAt, at.tiles, image.tileHeat);
        if (at.object < s.results.givenObjects.size())
            image.counters = s.results.givenObjects[at.object];
    }
    return s.results.givenImages;
}

}  // namespace fw::gpu::vk
