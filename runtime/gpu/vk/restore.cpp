// Restores objects of a snapshot: every object is created again, the images' content is copied
// over that, and the tiles join their lists. All of it is recorded with the next frame.
#include "gpu/vk/backend_state.h"

#include <algorithm>
#include <cstring>

namespace fw::gpu::vk {
namespace {

// Whether some texel is wet or was put out, which shows.
bool showsWater(const ObjectImage& image) noexcept {
    const auto wet = [](uint32_t t) { return t == kWet || t == kOut || t == kOutWet; };
    return std::any_of(image.ticks.begin(), image.ticks.end(), wet) ||
           std::any_of(image.heat.begin(), image.heat.end(),
                       [](const uvec2& texel) { return (texel.y & 0x3FFu) != 0; });
}

void stageImage(SceneTables& scene, const ObjectImage& image) {
    const BurnObject& record = scene.objects[image.object].record;
    FW_ASSERT(image.tiles.size() <= record.tileCount &&
                  image.ticks.size() <= scene.objects[image.object].texelCount(),
              "%zu tiles and %zu texels of object %u", image.tiles.size(), image.ticks.size(),
              image.object);
    PendingUpload& upload = scene.restores.stage(
        image.ticks.size_bytes() + image.heat.size_bytes() + image.tiles.size_bytes() +
            image.tileHeat.size_bytes() + sizeof image.counters,
        "restore staging");
    upload.add(FW_BIND_STATE, record.stateBase, image.ticks);
    upload.add(FW_BIND_HEAT, record.heatBase, image.heat);
    std::byte* const tiles =
        upload.region(FW_BIND_TILE_STATE, uint64_t(record.worldTileBase) * sizeof(TileState),
                      image.tiles.size_bytes());
    for (size_t i = 0; i < image.tiles.size(); ++i) {
        const TileState tile{image.tiles[i].flag & kTileKept, 0, image.tiles[i].lastChange,
                             image.object};
        std::memcpy(tiles + i * sizeof tile, &tile, sizeof tile);
    }
    upload.add(FW_BIND_TILE_HEAT, record.worldTileBase, image.tileHeat);
    upload.add(FW_BIND_OBJECT_COUNTERS, image.object, std::span(&image.counters, 1));
}

// As if the object was created now.
void resetObject(ObjectEntry& object, uint32_t tick) noexcept {
    object.resetDue = true;
    object.burn.touched = object.burn.doused = object.burn.warmed = object.burn.charred =
        object.burn.lit = false;
    object.extensionTouched = false;
    object.extensionParity = 0;
    object.burn.lastDouse = 0;
    object.burn.lastEvent = 0;
    object.deforms.softUntil = 0;
    object.refine.quietTick = 0;
    object.refine.epochTick = std::min(object.refine.epochTick, tick);
    if (object.shown && object.deforms.skinPlus1 == 0) object.deforms.reset = true;
}

void showTiles(BackendState& s, FrameRecorder& recorder) {
    recordShownTiles(recorder, s.simulation.lists, s.simulation.shownTick);
    s.simulation.tilesMoved = false;
}

}  // namespace

void VkBackend::restore(std::span<const RestoredObject> restored, uint32_t tick) {
    BackendState& s = *state_;
    SceneTables& scene = s.scene;
    scene.restoredObjects.reserve(restored.size());
    const size_t before = scene.restores.size();
    UploadGuard staged(scene.restores);
    for (const RestoredObject& one : restored) stageImage(scene, one.image);
    staged.keep();
    scene.restores.dropFirst(before);  // no frame will record those
    scene.restoredObjects.clear();
    for (uint32_t i = 0; i < scene.objects.size(); ++i) {
        if (!scene.objects[i].live) continue;
        scene.changed(i);
        resetObject(scene.objects[i], tick);
    }
    for (const RestoredObject& one : restored) {
        if (one.sleeps) continue;
        ObjectEntry& object = scene.objects[one.image.object];
        std::copy_n(one.materials, kMaterialsPerObject, object.materials);
        object.record.window = one.window;
        object.record.substepShift = one.substepShift;
        object.materialsDirty = true;
        object.burn.touched = true;
        object.burn.doused = showsWater(one.image);
        object.burn.warmed =
            one.image.counters.until != 0 && (object.record.flags & kObjectHeat) != 0;
        object.burn.lastEvent = tick;
        scene.restoredObjects.push_back(one.image.object);
        if (one.image.counters.ignited != 0) scene.noteFire(one.image.object, tick);
    }
    scene.recordsDirty = scene.restoreDue = true;
    s.simulation.shownTick = tick;
    s.simulation.links = s.simulation.occluders = 0;
    s.simulation.occlusion = {};
    s.simulation.setAllEmpty(false);
    s.results.pendingCount = 0;
    for (FrameInFlight& slot : s.ring.slots()) slot.readbackPending = false;
}

void VkBackend::moveWorld(const double (&by)[3]) noexcept {
    BackendState& s = *state_;
    const vec3 metres{float(by[0]), float(by[1]), float(by[2])};
    const vec3 up{s.limits.up[0], s.limits.up[1], s.limits.up[2]};
    s.particles.particlesMove += metres;
    s.simulation.tilesMoved = true;
    for (uint32_t i = 0; i < s.scene.objects.size(); ++i) {
        ObjectEntry& object = s.scene.objects[i];
        if (!object.live || (object.deform.flags & kDeformShell) == 0) continue;
        object.deform.ground += glm::dot(metres, up);
        object.deforms.recordDirty = true;
        s.scene.changed(i);
    }
}

void recordMovedTiles(BackendState& s, FrameRecorder& recorder) {
    if (s.simulation.tilesMoved && !s.simulation.burnEmpty) showTiles(s, recorder);
}

void recordRestores(BackendState& s, FrameRecorder& recorder) {
    if (!s.scene.restoreDue) return;
    s.scene.restoreDue = false;
    // The lists start empty, so nobody waits for a walk through them.
    recorder.fillZero(FW_BIND_COUNTERS, 0, VK_WHOLE_SIZE);
    ++s.simulation.walks.front, ++s.simulation.walks.burn;
    ++s.simulation.walks.predict, ++s.simulation.walks.hot;
    s.scene.restores.record(s.device, s.open.commands, s.barriers, s.buffers, s.open.ringFrame);
    for (const uint32_t slot : s.scene.restoredObjects) {
        const ObjectEntry& object = s.scene.objects[slot];
        if (!object.live) continue;
        const uint64_t texels = object.texelCount();
        recorder.fillZero(FW_BIND_SETTLED, uint64_t(object.record.stateBase) / 8 * 4,
                          texels / 8 * 4);
        const uint64_t at = uint64_t(object.record.stateBase) * 4;
        recorder.copyBetween({FW_BIND_STATE, at}, {FW_BIND_PREDICT, at}, texels * 4);
        recordRestore(recorder, s.simulation.lists, slot, object.record.tileCount);
    }
    s.scene.restoredObjects.clear();
    showTiles(s, recorder);
}

}  // namespace fw::gpu::vk
