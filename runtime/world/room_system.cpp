#include "world/room_system.h"

#include "world/recording.h"
#include "world/wind_system.h"

#include <algorithm>

namespace fw::world {
namespace {

// After the last change: what fires gave off has been drawn by then.
constexpr uint64_t kRoomsSettle = 4 * uint64_t(gpu::kRoomPeriod);

// How often a room has flashed over since its air began.
uint32_t flashesOf(const gpu::RoomAir& air) noexcept { return (air.flash + 1) / 2; }

// It holds the room, however that is turned.
mesh::Box boxOf(const components::Room& room) noexcept {
    return cubeAround(room.middle, room.half[0] + room.half[1] + room.half[2] + 1);
}

}  // namespace

RoomSystem::RoomSystem(const WorldContext& context, Scene& scene)
    : context_(context), scene_(scene) {}

bool RoomSystem::isSettled(uint64_t stirred) const noexcept {
    return !state_.met || context_.readbackTick >= stirred + kRoomsSettle;
}

void RoomSystem::stir() noexcept { state_.stirred = context_.clock.tick; }

uint32_t RoomSystem::roomOf(const Object& object) const noexcept {
    if (state_.rooms.live() == 0) return 0;
    const components::WindPlace place = windPlaceOf(object.data.pose, scene_.domainOf(object));
    for (auto [slot, entry] : state_.rooms.entries())
        if (components::isIn(entry.room, place)) return slot + 1;
    return 0;
}

// An object where a room was, or is now, may be in another room.
void RoomSystem::updateObjects(const components::Room& room) noexcept {
    for (const uint32_t slot : scene_.objectsNear(boxOf(room), 0)) {
        Object& object = scene_.objectAt(slot);
        const uint32_t room1 = roomOf(object);
        if (room1 == object.room1) continue;
        object.room1 = room1;
        scene_.sendPose(object);
    }
    stir();
}

void RoomSystem::send(uint32_t slot) noexcept {
    const RoomEntry& entry = *state_.rooms.at(slot);
    context_.backend.setRoom(
        slot, components::roomRecord(entry.room, context_.def.paceFactor, entry.air));
}

void RoomSystem::fill(RoomEntry& entry, uint32_t oxygen, uint32_t power, uint32_t flash) noexcept {
    entry.air = {};
    entry.air.oxygen = oxygen;
    entry.air.power = power;
    entry.air.flash = flash;
    entry.air.epoch = ++state_.epoch;
}

FwRoomId RoomSystem::create(const FwRoomDef& def) {
    checkRoom(state_.rooms, gpu::kMaxRooms, "rooms");
    RoomEntry entry;
    entry.room = components::makeRoom(def);
    fill(entry, entry.room.oxygen);
    const FwRoomId id = state_.rooms.create(entry);
    state_.met = true;
    send(id.index1 - 1);
    updateObjects(entry.room);
    return id;
}

void RoomSystem::set(FwRoomId id, const components::Room& room, bool refills) {
    context_.recorder.mayChange();
    RoomEntry& entry = state_.rooms.get(id);
    const components::Room before = std::exchange(entry.room, room);
    if (refills) fill(entry, entry.room.oxygen);
    send(id.index1 - 1);
    updateObjects(before);
    updateObjects(entry.room);
    context_.recorder.record(SetRoom{id.index1 - 1, refills, room});
}

void RoomSystem::destroy(FwRoomId id) {
    const components::Room before = state_.rooms.get(id).room;
    state_.rooms.destroy(id);
    context_.backend.setRoom(id.index1 - 1, {});
    updateObjects(before);
}

void RoomSystem::onReadback(const gpu::Readback& readback, bool burns) noexcept {
    const auto count = uint32_t(std::min<size_t>(readback.rooms.size(), state_.rooms.slotCount()));
    bool stirs = burns;
    for (uint32_t slot = 0; slot < count; ++slot) {
        RoomEntry* entry = state_.rooms.at(slot);
        if (!entry) continue;
        const uint32_t reported = flashesOf(entry->air);
        if (entry->air.epoch == readback.rooms[slot].epoch) entry->air = readback.rooms[slot];
        stirs = stirs || entry->air.stirs != 0;
        if (flashesOf(entry->air) == reported) continue;
        float middle[3];
        for (size_t i = 0; i < 3; ++i) middle[i] = float(double(entry->room.middle[i]) / 1000);
        context_.raise(FW_EVENT_FLASHED_OVER, nullptr, slot + 1, readback.frameIndex, middle,
                       float(double(entry->air.flashTick) / gpu::kTicksPerSecond));
    }
    if (!stirs) return;
    state_.stirred = std::max<uint64_t>(state_.stirred, readback.endTick);
    state_.seenStirred = std::max<uint64_t>(state_.seenStirred, readback.endTick);
}

void RoomSystem::fillState(FwRoomId id, FwRoomState& state) {
    const RoomEntry& entry = state_.rooms.get(id);
    state.frameIndex = context_.readbackFrame;
    for (const uint32_t slot : scene_.objectsNear(boxOf(entry.room), 0))
        state.objects += scene_.objectAt(slot).room1 == id.index1 ? 1 : 0;
    state.oxygen = float(double(entry.air.oxygen) / 4294967296.0);
    state.strength = float(gpu::burnStrengthOfOxygen(entry.air.oxygen)) / float(gpu::kAirFull);
    // J of a period, at pace 1.
    state.power = float(double(entry.air.drawn) * gpu::kTicksPerSecond / gpu::kRoomPeriod /
                        double(context_.def.paceFactor));
    state.flashedOver = entry.air.flash & 1u;
    state.flashOverPower = float(entry.room.flashPower());
}

void RoomSystem::onFrameDone(uint64_t stirred) noexcept {
    state_.seenStirred = std::max(state_.seenStirred, stirred);
}

// Their air goes on from what the frame left.
void RoomSystem::complete(RoomSnapshot& to, const gpu::Readback& readback) const noexcept {
    to.stirred = state_.seenStirred;
    for (Slotted<RoomEntry>& room : to.rooms)
        if (room.slot < readback.rooms.size() && readback.rooms[room.slot].epoch == room.air.epoch)
            room.air = readback.rooms[room.slot];
}

void RoomSystem::restore(const RoomSnapshot& from) noexcept {
    state_.met = !from.rooms.empty();
    for (const Slotted<RoomEntry>& one : from.rooms) {
        RoomEntry& entry = *state_.rooms.at(one.slot);
        entry.room = one.room;
        fill(entry, one.air.oxygen, one.air.power, one.air.flash);
        entry.air.drawn = one.air.drawn;
        entry.air.stirs = one.air.stirs;
        send(one.slot);
    }
    state_.stirred = state_.seenStirred = from.stirred;
}

void RoomSystem::restoreObject(Object& object) noexcept {
    object.room1 = roomOf(object);
    state_.met |= object.counters.air != 0;
}

}  // namespace fw::world
