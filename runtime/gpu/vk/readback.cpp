#include "gpu/vk/readback.h"

#include "gpu/vk/backend_state.h"
#include "gpu/vk/vk_extension.h"
#include "shared/refine.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace fw::gpu::vk {
namespace {

constexpr uint64_t kCounterRow = sizeof(IterationCounters);

// The bytes of a readback that are still free.
struct Places {
    uint64_t end = 0;
    uint64_t take(uint64_t bytes) noexcept { return std::exchange(end, alignUp(end + bytes, 16)); }
    ReadbackLayout::Piece piece(uint64_t bytes) noexcept { return {take(bytes), bytes}; }
    ObjectAt object(const BackendState& s, uint32_t slot, bool withTiles) noexcept {
        const ObjectEntry& entry = s.scene.objects[slot];
        ObjectAt out;
        out.object = slot;
        out.texels = entry.texelCount();
        out.ticksAt = take(uint64_t(out.texels) * sizeof(uint32_t));
        out.heat = (entry.record.flags & kObjectHeat) != 0;
        if (out.heat) out.heatAt = take(uint64_t(out.texels) * sizeof(uvec2));
        if (!withTiles) return out;
        out.tiles = entry.record.tileCount;
        out.tilesAt = take(uint64_t(out.tiles) * sizeof(TileState));
        out.tileHeatAt = take(uint64_t(out.tiles) * sizeof(TileHeat));
        return out;
    }
};

void copyObject(FrameRecorder& r, const BackendState& s, const ObjectAt& at) {
    const BurnObject& object = s.scene.objects[at.object].record;
    const auto copy = [&]<class T>(uint32_t resource, uint32_t first, uint64_t to, uint32_t count) {
        if (count > 0)
            r.copyOut(resource, uint64_t(first) * sizeof(T), to, uint64_t(count) * sizeof(T));
    };
    copy.operator()<uint32_t>(FW_BIND_STATE, object.stateBase, at.ticksAt, at.texels);
    copy.operator()<uvec2>(FW_BIND_HEAT, object.heatBase, at.heatAt, at.heat ? at.texels : 0);
    copy.operator()<TileState>(FW_BIND_TILE_STATE, object.worldTileBase, at.tilesAt, at.tiles);
    copy.operator()<TileHeat>(FW_BIND_TILE_HEAT, object.worldTileBase, at.tileHeatAt, at.tiles);
}

// The array at byte `at` of a readback, where it lies.
template <class T>
std::span<const T> arrayAt(const std::byte* from, uint64_t at, uint64_t count) noexcept {
    FW_ASSERT(at % alignof(T) == 0, "byte %llu", (unsigned long long)at);
    return {reinterpret_cast<const T*>(from + at), size_t(count)};
}

template <class T>
void take(std::pmr::vector<T>& out, const std::byte* from, const ReadbackLayout::Piece& piece) {
    const std::span<const T> given = arrayAt<T>(from, piece.at, piece.bytes / sizeof(T));
    out.assign(given.begin(), given.end());
}

// As it lies in the readback buffer, which is not written again before the next frame.
ObjectImage objectFrom(const std::byte* from, const ObjectAt& at) noexcept {
    ObjectImage image;
    image.object = at.object;
    image.ticks = arrayAt<uint32_t>(from, at.ticksAt, at.texels);
    if (at.heat) image.heat = arrayAt<uvec2>(from, at.heatAt, at.texels);
    image.tiles = arrayAt<TileState>(from, at.tilesAt, at.tiles);
    image.tileHeat = arrayAt<TileHeat>(from, at.tileHeatAt, at.tiles);
    return image;
}

// An object's counters decide how it is drawn from now on.
void updateFromCounters(BackendState& s, uint32_t slot, ObjectCounters& counters, uint32_t tick) {
    SceneTables& scene = s.scene;
    if (counters.burning != 0 || counters.frontTiles != 0) scene.noteFire(slot, tick);
    // Objects that others lit or warmed wake here; sleeping objects need nothing more.
    if (counters.ignited != 0 || counters.until != 0) scene.awake.insert(slot);
    if (!scene.awake.contains(slot)) return;
    ObjectEntry& object = scene.objects[slot];
    if (object.refine.extendedPlus1)
        counters.refined = extension()->vulkan->refinedCount(s, object);
    // A charred object has few cold texels; a warm one may turn brown before it burns.
    const bool known = object.live && !object.resetDue;
    const bool lit = known && counters.ignited != 0;
    const bool warm = known && counters.until != 0 && (object.record.flags & kObjectHeat) != 0;
    const bool charred = object.live && counters.ignited > object.texelCount() / 4;
    scene.recordsDirty |= (lit && !object.burn.touched) || (warm && !object.burn.warmed) ||
                          charred != object.burn.charred;
    object.burn.touched |= lit;
    object.burn.warmed |= warm;
    object.burn.charred = charred;
}

// The counters' rows say which lists are empty, and so which passes later frames may skip.
void takeCounters(BackendState& s, const std::byte* from, const ReadbackLayout& layout,
                  uint64_t ringFrame) {
    Readback& given = s.results.given;
    const std::span<const IterationCounters> rows =
        arrayAt<IterationCounters>(from, layout.counters.at, layout.counters.bytes / kCounterRow);
    FW_ASSERT(layout.rows < rows.size(), "row %u of %zu", layout.rows, rows.size());
    given.runTiles = 0;
    for (uint32_t i = layout.firstRow; i < layout.rows; ++i) given.runTiles += rows[i].runCount;
    const IterationCounters& burn = rows[kRowBurn + layout.burnParity];
    given.frontTiles = rows[layout.rows].listCount;
    given.receivers = rows[kRowExchange].runCount;
    given.burningTiles = burn.runCount;
    given.hotTiles = rows[kRowHot + layout.hotParity].listCount;
    bool spreading = false;
    for (const uint32_t i : s.scene.awake) spreading |= s.scene.objects[i].extensionTouched;
    SimulationState& simulation = s.simulation;
    if (ringFrame < simulation.lastStimulus || spreading) return;
    simulation.hotEmpty = given.hotTiles == 0;
    simulation.frontEmpty = given.frontTiles == 0 && simulation.hotEmpty;
    simulation.burnEmpty = simulation.frontEmpty && given.receivers == 0 && burn.listCount == 0;
    simulation.predictEmpty =
        simulation.frontEmpty && rows[kRowPredict + layout.predictParity].listCount == 0;
}

// All of a frame's readback; until this returns, it can be taken again.
void takeReadback(BackendState& s, FrameInFlight& slot, const PendingReadback& one) {
    ReadbackResults& results = s.results;
    const ReadbackLayout& layout = slot.layout;
    const std::byte* const from = slot.readback.mapped;
    take(results.givenObjects, from, layout.objects);
    take(results.givenFields, from, layout.fields);
    if (layout.rooms.bytes > 0) take(results.givenRooms, from, layout.rooms);
    take(results.givenAnswers, from, layout.answers);
    take(results.givenLights, from, layout.lights);
    std::erase_if(results.givenLights, [](const BurnLight& light) { return !(light.power > 0); });
    results.givenMaps.clear();
    for (const ObjectAt& map : layout.burnMaps())
        results.givenMaps.push_back(objectFrom(from, map));
    results.givenImages.clear();
    if (layout.hasImages && results.imagesFrame == one.ringFrame)
        for (const ObjectAt& at : results.imageLayout) {
            ObjectImage& image = results.givenImages.emplace_back(objectFrom(from, at));
            if (image.object < results.givenObjects.size())
                image.counters = results.givenObjects[image.object];
        }
    results.given.images = results.givenImages;
    const size_t objects = std::min(results.givenObjects.size(), s.scene.objects.size());
    for (uint32_t i = 0; i < objects; ++i)
        updateFromCounters(s, i, results.givenObjects[i], one.endTick);
    takeCounters(s, from, layout, one.ringFrame);
    applyShown(s, layout, from);
    results.given.answers = results.givenAnswers;
    results.given.burnMaps = results.givenMaps;
    slot.timers.read(s.device, one.frameIndex, results.times);
    slot.readbackPending = false;
}

}  // namespace

void ReadbackResults::push(const PendingReadback& one) noexcept {
    const auto size = uint32_t(pending.size());
    if (pendingCount == size) {  // the host fetched none: the oldest is dropped
        pendingFirst = (pendingFirst + 1) % size;
        --pendingCount;
    }
    pending[(pendingFirst + pendingCount) % size] = one;
    ++pendingCount;
}

ReadbackLayout layoutReadback(BackendState& s, const FramePlan& plan, uint64_t iterations,
                              bool airs, uint64_t& bytes) {
    ReadbackLayout layout;
    Places places;
    const uint64_t lastRow = iterations ? kRowIteration + iterations : s.simulation.lists.row;
    layout.counters = places.piece((lastRow + 1) * kCounterRow);
    layout.objects = places.piece(s.scene.objects.size() * sizeof(ObjectCounters));
    layout.answers = places.piece(plan.probes.size() * sizeof(ProbeAnswer));
    layout.lights = places.piece(s.limits.maxLights * sizeof(BurnLight));
    layout.flames = places.piece(16);
    layout.bias = places.piece(4);
    layout.fields = places.piece(s.particleFields.fields.size() * sizeof(FieldCounters));
    if (s.scene.airs || airs) layout.rooms = places.piece(kMaxRooms * sizeof(RoomAir));
    FW_ASSERT(plan.burnMaps.size() <= ReadbackLayout::kMaxMaps, "%zu burn maps",
              plan.burnMaps.size());
    for (const uint32_t object : plan.burnMaps)
        layout.maps[layout.mapCount++] = places.object(s, object, false);
    layout.hasImages = !plan.images.empty();
    if (layout.hasImages) {
        s.results.imageLayout.clear();
        for (const uint32_t object : plan.images)
            s.results.imageLayout.push_back(places.object(s, object, true));
        s.results.imagesFrame = s.open.ringFrame;
    }
    bytes = places.end;
    return layout;
}

void recordReadback(BackendState& s, FrameInFlight& slot) {
    const bool looked = s.open.viewCount > 0;
    FrameRecorder r(s, slot, looked ? s.open.views[0]->number : 0);  // whose quads are counted
    ReadbackLayout& layout = slot.layout;
    const auto copy = [&](uint32_t resource, const ReadbackLayout::Piece& piece,
                          uint64_t from = 0) {
        if (piece.bytes > 0) r.copyOut(resource, from, piece.at, piece.bytes);
    };
    const auto copyShown = [&] {
        layout.hasQuads = looked && s.showsQuads();
        layout.hasBias = s.open.refined;
        if (layout.hasQuads) copy(FW_BIND_DRAW_ARGS, layout.flames);
        if (layout.hasBias) copy(FW_BIND_REFINE_WORK, layout.bias, kRefineWorkBias * 4);
    };
    if (s.open.planFrame == 0 && looked) copyShown();  // a picture of an own device's
    if (s.open.planFrame == 0 || !s.open.readback) return;
    // Rows that this frame used, and the one its list ended in.
    FW_ASSERT((layout.rows + 1) * kCounterRow <= layout.counters.bytes, "%u rows", layout.rows);
    layout.counters.bytes = (layout.rows + 1) * kCounterRow;
    copy(FW_BIND_COUNTERS, layout.counters);
    copy(FW_BIND_OBJECT_COUNTERS, layout.objects);
    copy(FW_BIND_ANSWERS, layout.answers);
    copy(FW_BIND_LIGHTS, layout.lights);
    copyShown();
    copy(FW_BIND_FIELD_COUNTERS, layout.fields);
    copy(FW_BIND_ROOM_AIR, layout.rooms);
    for (const ObjectAt& map : layout.burnMaps()) copyObject(r, s, map);
    if (layout.hasImages)
        for (const ObjectAt& at : s.results.imageLayout) copyObject(r, s, at);
    slot.readbackPending = true;
}

void applyShown(BackendState& s, const ReadbackLayout& layout, const std::byte* from) noexcept {
    if (layout.hasQuads) {
        // Of VkDrawIndirectCommand: vertices, instances.
        const auto arguments = arrayAt<uint32_t>(from, layout.flames.at, 2);
        s.particles.quadsShown = arguments[0] / 6 * arguments[1];
    }
    if (layout.hasBias)
        s.refine.bias = float(arrayAt<uint32_t>(from, layout.bias.at, 1)[0]) * kRefineBiasStep;
}

const Readback* VkBackend::nextReadback() {
    BackendState& s = *state_;
    ReadbackResults& results = s.results;
    while (results.pendingCount) {
        const PendingReadback one = results.pending[results.pendingFirst];
        if (one.ringFrame > s.ring.completed()) return nullptr;
        FrameInFlight* const slot = one.slot >= 0 ? &s.ring.slots()[size_t(one.slot)] : nullptr;
        const bool stolen = slot && (slot->frameIndex != one.ringFrame || !slot->readbackPending);
        results.given.answers = {};
        results.given.burnMaps = {};
        results.given.images = {};
        if (slot && !stolen) {
            takeReadback(s, *slot, one);
        } else {
            results.given.runTiles = 0;
            FrameInFlight* effects =
                one.effectsSlot >= 0 ? &s.ring.slots()[size_t(one.effectsSlot)] : nullptr;
            if (effects && effects->frameIndex == one.ringFrame)
                effects->timers.read(s.device, one.frameIndex, results.times);
        }
        results.pendingFirst = (results.pendingFirst + 1) % uint32_t(results.pending.size());
        --results.pendingCount;
        if (stolen) continue;
        results.given.milliseconds = sumOf(results.times, one.frameIndex);
        if (results.given.milliseconds >= 0)
            results.given.milliseconds += std::exchange(results.pictureTime, 0.0f);
        results.given.frameIndex = one.frameIndex;
        results.given.endTick = one.endTick;
        results.given.objects = results.givenObjects;
        results.given.lights = results.givenLights;
        results.given.fields = results.givenFields;
        results.given.rooms = results.givenRooms;
        s.scene.freeQuarantine(s.simulation);
        return &results.given;
    }
    return nullptr;
}

}  // namespace fw::gpu::vk
