// Rooms: which object is in which, and what the backend has to know of them. What becomes of their
// air is decided there, in the steps, and comes back with readbacks.
#include "components/room.h"

#include "world/world.h"

#include <algorithm>

namespace fw::world {
namespace {

// After the last change: what fires gave off has been drawn by then.
constexpr uint64_t kRoomsSettle = 4 * uint64_t(gpu::kRoomPeriod);

// How often a room has flashed over since its air began.
uint32_t flashesOf(const gpu::RoomAir& air) noexcept { return (air.flash + 1) / 2; }

// It fits in, however it is turned.
mesh::Box boxOf(const components::Room& room) noexcept {
    constexpr int64_t kFarthest = 2000000000;
    const int64_t reach = room.half[0] + room.half[1] + room.half[2] + 1;
    mesh::Box box;
    for (size_t i = 0; i < 3; ++i) {
        box.low[i] = int(std::clamp(room.middle[i] - reach, -kFarthest, kFarthest));
        box.high[i] = int(std::clamp(room.middle[i] + reach, -kFarthest, kFarthest));
    }
    return box;
}

}  // namespace

bool World::roomsRest(uint64_t stirred) const noexcept {
    return !roomsMet_ || readbackTick_ >= stirred + kRoomsSettle;
}

void World::stirRooms() noexcept { roomsStirred_ = clock_.tick; }

// Of those that it is in, the one made first (plus 1); 0: none.
uint32_t World::roomOf(const Object& object) const noexcept {
    if (rooms_.live() == 0) return 0;
    const components::WindPlace place = windPlaceOf(object.data.pose, domainOf(object));
    for (uint32_t slot = 0; slot < rooms_.slotCount(); ++slot)
        if (const RoomEntry* entry = rooms_.at(slot); entry && components::isIn(entry->room, place))
            return slot + 1;
    return 0;
}

// An object where a room was, or is now, may be in another room.
void World::roomTurns(const components::Room& room) noexcept {
    for (const uint32_t slot : objectsNear(boxOf(room), 0)) {
        Object& object = **objects_.at(slot);
        const uint32_t room1 = roomOf(object);
        if (room1 == object.room1) continue;
        object.room1 = room1;
        sendPose(object);
    }
    stirRooms();
}

void World::sendRoom(uint32_t slot) noexcept {
    const RoomEntry& entry = *rooms_.at(slot);
    backend_.setRoom(slot, components::roomRecord(entry.room, def_.paceFactor, entry.air));
}

// From here on its air is that; with fire that burnt so in it: of a save.
void World::fillRoom(RoomEntry& entry, uint32_t oxygen, uint32_t power, uint32_t flash) noexcept {
    entry.air = {};
    entry.air.oxygen = oxygen;
    entry.air.power = power;
    entry.air.flash = flash;
    entry.air.epoch = ++roomEpoch_;
}

FwRoomId World::createRoom(const FwRoomDef& def) {
    if (rooms_.live() >= gpu::kMaxRooms)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "%u rooms are there; the limit is %u.", rooms_.live(),
                   gpu::kMaxRooms);
    RoomEntry entry;
    entry.room = components::makeRoom(def);
    fillRoom(entry, entry.room.oxygen);
    const FwRoomId id = rooms_.create(entry);
    roomsMet_ = true;
    sendRoom(id.index1 - 1);
    roomTurns(entry.room);
    return id;
}

void World::setRoom(FwRoomId id, const components::Room& room, bool refills) {
    mayChange();
    RoomEntry& entry = rooms_.get(id);
    const components::Room before = std::exchange(entry.room, room);
    if (refills) fillRoom(entry, entry.room.oxygen);
    sendRoom(id.index1 - 1);
    roomTurns(before);
    roomTurns(entry.room);
    record(SetRoom{id.index1 - 1, refills, room});
}

void World::destroyRoom(FwRoomId id) {
    const components::Room before = rooms_.get(id).room;
    rooms_.destroy(id);
    backend_.setRoom(id.index1 - 1, {});
    roomTurns(before);
}

// Of a readback of beginnings that still count.
void World::takeRooms(const gpu::Readback& readback) noexcept {
    const auto count = uint32_t(std::min<size_t>(readback.rooms.size(), rooms_.slotCount()));
    bool stirs = hotTiles_ != 0 || burningTiles_ != 0;
    for (uint32_t slot = 0; slot < count; ++slot) {
        RoomEntry* entry = rooms_.at(slot);
        if (!entry) continue;
        const uint32_t told = flashesOf(entry->air);
        if (entry->air.epoch == readback.rooms[slot].epoch) entry->air = readback.rooms[slot];
        stirs = stirs || entry->air.stirs != 0;
        if (flashesOf(entry->air) == told) continue;
        float middle[3];
        for (size_t i = 0; i < 3; ++i) middle[i] = float(double(entry->room.middle[i]) / 1000);
        raise(FW_EVENT_FLASHED_OVER, nullptr, slot + 1, readback.frameIndex, middle,
              float(double(entry->air.flashTick) / gpu::kTicksPerSecond));
    }
    if (!stirs) return;
    roomsStirred_ = std::max<uint64_t>(roomsStirred_, readback.endTick);
    seenRoomsStirred_ = std::max<uint64_t>(seenRoomsStirred_, readback.endTick);
}

void World::roomState(FwRoomId id, FwRoomState& state) {
    const RoomEntry& entry = rooms_.get(id);
    state.frameIndex = readbackFrame_;
    for (const uint32_t slot : objectsNear(boxOf(entry.room), 0))
        state.objects += (*objects_.at(slot))->room1 == id.index1 ? 1 : 0;
    state.oxygen = float(double(entry.air.oxygen) / 4294967296.0);
    state.strength = float(gpu::roomStrength(entry.air.oxygen)) / float(gpu::kAirFull);
    // J of a period, at pace 1.
    state.power = float(double(entry.air.drawn) * gpu::kTicksPerSecond / gpu::kRoomPeriod /
                        double(def_.paceFactor));
    state.flashedOver = entry.air.flash & 1u;
    state.flashOverPower = float(entry.room.flashPower());
}

}  // namespace fw::world
