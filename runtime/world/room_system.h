// Rooms: which object is in which, and what the backend needs of them. What becomes of their air is
// decided there, in the steps, and comes back with readbacks.
#pragma once
#include "components/room.h"
#include "world/command.h"
#include "world/scene.h"
#include "world/slotted.h"

namespace fw::world {

struct RoomEntry {
    components::Room room;
    gpu::RoomAir air{};  // as of the last readback, or as it begins

    template <class A>
    void serialize(A& a) {
        a(room, air.oxygen, air.power, air.flash, air.drawn, air.stirs);
        a.range("power of a room's fires", air.power, 0,
                double(gpu::kMaxFlash * (gpu::kRoomMeans - 1)));
    }
};

struct RoomSnapshot {
    explicit RoomSnapshot(std::pmr::memory_resource* memory) : rooms(memory) {}
    uint64_t stirred = 0;  // tick
    SlottedList<RoomEntry> rooms;

    template <class A>
    void serialize(A& a) {
        a(stirred);
        a.list("rooms", rooms, 164);
    }
};

struct RoomState {
    explicit RoomState(std::pmr::memory_resource* memory) : rooms("Room", memory) {}
    core::HandlePool<FwRoomId, RoomEntry> rooms;
    uint32_t epoch = 0;        // of their airs' beginnings, the last one
    bool met = false;          // there were some: objects may still know their air
    uint64_t stirred = 0;      // tick at which something of their airs may have changed last
    uint64_t seenStirred = 0;  // the same, as of the last readback
};

class RoomSystem {
 public:
    RoomSystem(const WorldContext& context, Scene& scene);

    FwRoomId create(const FwRoomDef& def);
    void set(FwRoomId id, const FwRoomDef& def) {
        set(id, components::makeRoom(def), (def.flags & FW_ROOM_REFILL) != 0);
    }
    void set(FwRoomId id, const components::Room& room, bool refills);
    void destroy(FwRoomId id);
    void fillState(FwRoomId id, FwRoomState& state);

    // `burns`: something is hot or burns anywhere.
    void onReadback(const gpu::Readback& readback, bool burns) noexcept;
    void onFrameDone(uint64_t stirred) noexcept;  // with the readback of a frame
    // visit(place, name, slot) for all that a shift of the origin moves and may refuse.
    template <class Visit>
    void eachPlace(const Visit& visit) {
        for (auto [i, entry] : state_.rooms.entries()) visit(entry.room.middle, "room", i);
    }

    [[nodiscard]] const RoomState& state() const noexcept { return state_; }
    [[nodiscard]] bool isSettled(uint64_t stirred) const noexcept;
    // Slot + 1 of the first of those that an object is in; 0: none.
    [[nodiscard]] uint32_t roomOf(const Object& object) const noexcept;
    void stir() noexcept;
    void apply(const SetRoom& command) {
        set(state_.rooms.findId(command.slot), command.room, command.refills);
    }
    void capture(RoomSnapshot& to) const { captureSlots(state_.rooms, to.rooms); }
    // With the readback of its frame.
    void complete(RoomSnapshot& to, const gpu::Readback& readback) const noexcept;
    void restore(const RoomSnapshot& from) noexcept;  // before objects are
    void restoreObject(Object& object) noexcept;

 private:
    void updateObjects(const components::Room& room) noexcept;
    void send(uint32_t slot) noexcept;
    // From here on its air is that; a save adds the fire that burnt so in it.
    void fill(RoomEntry& entry, uint32_t oxygen, uint32_t power = 0, uint32_t flash = 0) noexcept;

    const WorldContext& context_;
    Scene& scene_;
    RoomState state_{context_.memory};
};

}  // namespace fw::world
