// Readbacks, oldest first, once the host says that their frame is done. Never waits.
#include "gpu/vk/frame_needs.h"
#include "shared/refine.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace fw::gpu::vk {

void VkBackend::State::pushPending(const PendingReadback& one) noexcept {
    const auto size = uint32_t(pending.size());
    if (pendingCount == size) {  // nobody fetched them: the oldest goes
        pendingFirst = (pendingFirst + 1) % size;
        --pendingCount;
    }
    pending[(pendingFirst + pendingCount) % size] = one;
    ++pendingCount;
}

// What an object's counters say of how it is drawn from now on.
void VkBackend::State::noteCounters(uint32_t slot, ObjectCounters& told, uint32_t tick) noexcept {
    if (told.burning != 0 || told.frontTiles != 0) noteFire(slot, tick);
    // What others lit or warm is found here; of what rests nothing more is read.
    if (told.ignited != 0 || told.until != 0) awake.insert(slot);
    if (!awake.contains(slot)) return;
    ObjectEntry& object = objects[slot];
    // The published scheme's lists are the host's.
    if (const uint32_t arpPlus1 = object.refine.arpPlus1)
        told.refined = uint32_t(arps[arpPlus1 - 1]->state.list.size());
    // Of what burns little is left cold; what is warm may turn brown before it burns.
    const bool known = object.live && !object.resetDue;
    const bool lit = known && told.ignited != 0;
    const bool warm = known && told.until != 0 && (object.record.flags & kObjectHeat) != 0;
    const uint32_t all = object.record.width * object.record.height;
    const bool charred = object.live && told.ignited > all / 4;
    recordsDirty |=
        (lit && !object.touched) || (warm && !object.warmed) || charred != object.charred;
    object.touched |= lit;
    object.warmed |= warm;
    object.charred = charred;
}

// Applies the counters that a view wrote.
void VkBackend::State::takeShown(const ReadbackLayout& layout, const std::byte* from) noexcept {
    if (layout.quads) {
        uint32_t arguments[2];  // of VkDrawIndirectCommand: vertices, instances
        std::memcpy(arguments, from + layout.flamesAt, sizeof arguments);
        quadsShown = arguments[0] / 6 * arguments[1];
    }
    if (!layout.bias) return;
    uint32_t steps = 0;
    std::memcpy(&steps, from + layout.biasAt, sizeof steps);
    refine.bias = float(steps) * kRefineBiasStep;
}

const Readback* VkBackend::State::nextReadback() {
    while (pendingCount) {
        const PendingReadback one = pending[pendingFirst];
        if (one.ringFrame > ring.completed()) return nullptr;
        FrameInFlight* slot = one.slot >= 0 ? &ring.slots()[size_t(one.slot)] : nullptr;
        const bool stolen = slot && (slot->frameIndex != one.ringFrame || !slot->readbackPending);
        given.answers = {};
        given.burnMaps = {};
        given.images = {};
        if (slot && !stolen) {
            // Room first: it may throw, and then the readback is still there.
            const ReadbackLayout& layout = slot->layout;
            uint64_t texels = 0, heatTexels = 0;
            for (uint32_t i = 0; i < layout.mapCount; ++i) {
                texels += layout.maps[i].texels;
                heatTexels += layout.maps[i].heat ? layout.maps[i].texels : 0;
            }
            givenObjects.resize(layout.objects);
            givenFields.resize(layout.fields);
            givenAnswers.resize(layout.answers);
            givenTexels.resize(texels);
            givenHeat.resize(heatTexels);
            givenMaps.resize(layout.mapCount);
            givenLights.reserve(layout.lights);
            const std::byte* from = slot->readback.mapped;
            // Empty vectors have no address, which memcpy must not be given.
            if (layout.objects > 0)
                std::memcpy(givenObjects.data(), from + layout.objectsAt,
                            layout.objects * sizeof(ObjectCounters));
            if (layout.fields > 0)
                std::memcpy(givenFields.data(), from + layout.fieldsAt,
                            layout.fields * sizeof(FieldCounters));
            givesRooms = givesRooms || layout.rooms;
            if (layout.rooms)
                std::memcpy(givenRooms.data(), from + layout.roomsAt, sizeof givenRooms);
            if (layout.answers > 0)
                std::memcpy(givenAnswers.data(), from + layout.answersAt,
                            uint64_t(layout.answers) * sizeof(ProbeAnswer));
            for (uint32_t i = 0; i < std::min(layout.objects, uint32_t(objects.size())); ++i)
                noteCounters(i, givenObjects[i], one.endTick);
            uint64_t at = 0, heatAt = 0;
            for (uint32_t i = 0; i < layout.mapCount; ++i) {
                const ReadbackLayout::MapAt& map = layout.maps[i];
                std::memcpy(givenTexels.data() + at, from + map.at, uint64_t(map.texels) * 4);
                givenMaps[i] = {map.object, {givenTexels.data() + at, map.texels}, {}};
                at += map.texels;
                if (!map.heat) continue;
                std::memcpy(givenHeat.data() + heatAt, from + map.heatAt,
                            uint64_t(map.texels) * sizeof(uvec2));
                givenMaps[i].heat = {givenHeat.data() + heatAt, map.texels};
                heatAt += map.texels;
            }
            const auto row = [&](uint32_t number) {
                IterationCounters counters;
                std::memcpy(&counters,
                            from + layout.countersAt + number * sizeof(IterationCounters),
                            sizeof counters);
                return counters;
            };
            given.runTiles = 0;
            for (uint32_t i = layout.firstRow; i < layout.rows; ++i)
                given.runTiles += row(i).runCount;
            given.frontTiles = row(layout.rows).listCount;
            given.receivers = row(kRowExchange).runCount;
            given.burningTiles = row(kRowBurn + layout.burnParity).runCount;
            given.hotTiles = row(kRowHot + layout.hotParity).listCount;
            givenLights.clear();
            for (uint32_t i = 0; i < layout.lights; ++i) {
                BurnLight light;
                std::memcpy(&light, from + layout.lightsAt + i * sizeof light, sizeof light);
                if (light.power > 0) givenLights.push_back(light);
            }
            takeShown(layout, from);
            bool spreading = false;
            for (const uint32_t i : awake) spreading |= objects[i].publishedTouched;
            if (one.ringFrame >= lastStimulus && !spreading) {
                hotEmpty = given.hotTiles == 0;
                frontEmpty = given.frontTiles == 0 && hotEmpty;
                burnEmpty = frontEmpty && given.receivers == 0 &&
                            row(kRowBurn + layout.burnParity).listCount == 0;
                predictEmpty = frontEmpty && row(kRowPredict + layout.predictParity).listCount == 0;
            }
            if (layout.images && imagesFrame == one.ringFrame)
                given.images = giveImages(*this, from);
            given.answers = givenAnswers;
            given.burnMaps = givenMaps;
            slot->timers.read(device, one.frameIndex, times);
            slot->readbackPending = false;
        } else {
            given.runTiles = 0;
            FrameInFlight* looks = one.looks >= 0 ? &ring.slots()[size_t(one.looks)] : nullptr;
            if (looks && looks->frameIndex == one.ringFrame)
                looks->timers.read(device, one.frameIndex, times);
        }
        pendingFirst = (pendingFirst + 1) % uint32_t(pending.size());
        --pendingCount;
        if (stolen) continue;
        given.milliseconds = sumOf(times, one.frameIndex);
        if (given.milliseconds >= 0) given.milliseconds += std::exchange(pictureTime, 0.0f);
        given.frameIndex = one.frameIndex;
        given.endTick = one.endTick;
        given.objects = givenObjects;
        given.lights = givenLights;
        given.fields = givenFields;
        given.rooms = std::span<const RoomAir>(givenRooms).first(givesRooms ? kMaxRooms : 0);
        freeQuarantine();
        return &given;
    }
    return nullptr;
}

}  // namespace fw::gpu::vk
