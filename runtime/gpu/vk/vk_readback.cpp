// Readbacks, oldest first, once the host says that their frame is done. Never waits.
#include "gpu/vk/frame_needs.h"
#include "shared/refine.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace fw::gpu::vk {

void VkBackend::State::pushPending(const PendingReadback& one) noexcept {
    const auto size = uint32_t(results.pending.size());
    if (results.pendingCount == size) {  // nobody fetched them: the oldest goes
        results.pendingFirst = (results.pendingFirst + 1) % size;
        --results.pendingCount;
    }
    results.pending[(results.pendingFirst + results.pendingCount) % size] = one;
    ++results.pendingCount;
}

// What an object's counters say of how it is drawn from now on.
void VkBackend::State::updateFromCounters(uint32_t slot, ObjectCounters& counters,
                                          uint32_t tick) noexcept {
    if (counters.burning != 0 || counters.frontTiles != 0) recordFire(slot, tick);
    // What others lit or warm is found here; of what rests nothing more is read.
    if (counters.ignited != 0 || counters.until != 0) scene.awake.insert(slot);
    if (!scene.awake.contains(slot)) return;
    ObjectEntry& object = scene.objects[slot];
    // The published scheme's lists are the host's.
    if (const uint32_t patternPlus1 = object.refine.patternPlus1)
        counters.refined = uint32_t(pattern.patternUses[patternPlus1 - 1]->state.list.size());
    // Of what burns little is left cold; what is warm may turn brown before it burns.
    const bool known = object.live && !object.resetDue;
    const bool lit = known && counters.ignited != 0;
    const bool warm = known && counters.until != 0 && (object.record.flags & kObjectHeat) != 0;
    const uint32_t all = object.record.width * object.record.height;
    const bool charred = object.live && counters.ignited > all / 4;
    scene.recordsDirty |= (lit && !object.burn.touched) || (warm && !object.burn.warmed) ||
                          charred != object.burn.charred;
    object.burn.touched |= lit;
    object.burn.warmed |= warm;
    object.burn.charred = charred;
}

// Applies the counters that a view wrote.
void VkBackend::State::applyShown(const ReadbackLayout& layout, const std::byte* from) noexcept {
    if (layout.quads) {
        uint32_t arguments[2];  // of VkDrawIndirectCommand: vertices, instances
        std::memcpy(arguments, from + layout.flamesAt, sizeof arguments);
        particles.quadsShown = arguments[0] / 6 * arguments[1];
    }
    if (!layout.bias) return;
    uint32_t steps = 0;
    std::memcpy(&steps, from + layout.biasAt, sizeof steps);
    refine.bias = float(steps) * kRefineBiasStep;
}

const Readback* VkBackend::State::nextReadback() {
    while (results.pendingCount) {
        const PendingReadback one = results.pending[results.pendingFirst];
        if (one.ringFrame > ring.completed()) return nullptr;
        FrameInFlight* slot = one.slot >= 0 ? &ring.slots()[size_t(one.slot)] : nullptr;
        const bool stolen = slot && (slot->frameIndex != one.ringFrame || !slot->readbackPending);
        results.given.answers = {};
        results.given.burnMaps = {};
        results.given.images = {};
        if (slot && !stolen) {
            // Room first: it may throw, and then the readback is still there.
            const ReadbackLayout& layout = slot->layout;
            uint64_t texels = 0, heatTexels = 0;
            for (uint32_t i = 0; i < layout.mapCount; ++i) {
                texels += layout.maps[i].texels;
                heatTexels += layout.maps[i].heat ? layout.maps[i].texels : 0;
            }
            results.givenObjects.resize(layout.objects);
            results.givenFields.resize(layout.fields);
            results.givenAnswers.resize(layout.answers);
            results.givenTexels.resize(texels);
            results.givenHeat.resize(heatTexels);
            results.givenMaps.resize(layout.mapCount);
            results.givenLights.reserve(layout.lights);
            const std::byte* from = slot->readback.mapped;
            // Empty vectors have no address, which memcpy must not be given.
            if (layout.objects > 0)
                std::memcpy(results.givenObjects.data(), from + layout.objectsAt,
                            layout.objects * sizeof(ObjectCounters));
            if (layout.fields > 0)
                std::memcpy(results.givenFields.data(), from + layout.fieldsAt,
                            layout.fields * sizeof(FieldCounters));
            results.givesRooms = results.givesRooms || layout.rooms;
            if (layout.rooms)
                std::memcpy(results.givenRooms.data(), from + layout.roomsAt,
                            sizeof results.givenRooms);
            if (layout.answers > 0)
                std::memcpy(results.givenAnswers.data(), from + layout.answersAt,
                            uint64_t(layout.answers) * sizeof(ProbeAnswer));
            for (uint32_t i = 0; i < std::min(layout.objects, uint32_t(scene.objects.size())); ++i)
                updateFromCounters(i, results.givenObjects[i], one.endTick);
            uint64_t at = 0, heatAt = 0;
            for (uint32_t i = 0; i < layout.mapCount; ++i) {
                const ReadbackLayout::MapAt& map = layout.maps[i];
                std::memcpy(results.givenTexels.data() + at, from + map.at,
                            uint64_t(map.texels) * 4);
                results.givenMaps[i] = {
                    map.object, {results.givenTexels.data() + at, map.texels}, {}};
                at += map.texels;
                if (!map.heat) continue;
                std::memcpy(results.givenHeat.data() + heatAt, from + map.heatAt,
                            uint64_t(map.texels) * sizeof(uvec2));
                results.givenMaps[i].heat = {results.givenHeat.data() + heatAt, map.texels};
                heatAt += map.texels;
            }
            const auto row = [&](uint32_t number) {
                IterationCounters counters;
                std::memcpy(&counters,
                            from + layout.countersAt + number * sizeof(IterationCounters),
                            sizeof counters);
                return counters;
            };
            results.given.runTiles = 0;
            for (uint32_t i = layout.firstRow; i < layout.rows; ++i)
                results.given.runTiles += row(i).runCount;
            results.given.frontTiles = row(layout.rows).listCount;
            results.given.receivers = row(kRowExchange).runCount;
            results.given.burningTiles = row(kRowBurn + layout.burnParity).runCount;
            results.given.hotTiles = row(kRowHot + layout.hotParity).listCount;
            results.givenLights.clear();
            for (uint32_t i = 0; i < layout.lights; ++i) {
                BurnLight light;
                std::memcpy(&light, from + layout.lightsAt + i * sizeof light, sizeof light);
                if (light.power > 0) results.givenLights.push_back(light);
            }
            applyShown(layout, from);
            bool spreading = false;
            for (const uint32_t i : scene.awake) spreading |= scene.objects[i].publishedTouched;
            if (one.ringFrame >= simulation.lastStimulus && !spreading) {
                simulation.hotEmpty = results.given.hotTiles == 0;
                simulation.frontEmpty = results.given.frontTiles == 0 && simulation.hotEmpty;
                simulation.burnEmpty = simulation.frontEmpty && results.given.receivers == 0 &&
                                       row(kRowBurn + layout.burnParity).listCount == 0;
                simulation.predictEmpty =
                    simulation.frontEmpty && row(kRowPredict + layout.predictParity).listCount == 0;
            }
            if (layout.images && results.imagesFrame == one.ringFrame)
                results.given.images = giveImages(*this, from);
            results.given.answers = results.givenAnswers;
            results.given.burnMaps = results.givenMaps;
            slot->timers.read(device, one.frameIndex, results.times);
            slot->readbackPending = false;
        } else {
            results.given.runTiles = 0;
            FrameInFlight* looks = one.looks >= 0 ? &ring.slots()[size_t(one.looks)] : nullptr;
            if (looks && looks->frameIndex == one.ringFrame)
                looks->timers.read(device, one.frameIndex, results.times);
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
        results.given.rooms =
            std::span<const RoomAir>(results.givenRooms).first(results.givesRooms ? kMaxRooms : 0);
        freeQuarantine();
        return &results.given;
    }
    return nullptr;
}

}  // namespace fw::gpu::vk
