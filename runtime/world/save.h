// Saves: a Snapshot holds what a world knows as of one frame, and its objects' images come with
// that frame's readback. As bytes it is a header and the snapshot, serialized.
#pragma once
#include "save/archive.h"
#include "world/saved_object.h"
#include "world/world.h"

namespace fw::world {

struct SavedEvent : FwEvent {  // that was not polled yet
    template <class A>
    void serialize(A& a) {
        a(type, tag);
        a.object("an event", object);
        a.object("an event", other);
        a(position, value);
        a.range("event's type", type, FW_EVENT_IGNITED, FW_EVENT_STRUCTURE_BROKE);
        a.range("event's place", position, -3.5e38, 3.5e38);
        a.range("event's value", value, -3.5e38, 3.5e38);
    }
};

// The fields of a def that two worlds must share to follow each other.
template <class A, class Def>
void serializeRules(A& a, Def& def) {
    a(def.paceFactor, def.up, def.spreadChance, def.timeToLive, def.seed, def.maxHops,
      def.maxBurningTiles);
}

struct Snapshot {
    explicit Snapshot(std::pmr::memory_resource* given) : memory(given) {}
    std::pmr::memory_resource* memory;
    FwWorldDef rules{};  // which must be the world's
    Clock clock;
    double origin[3] = {};  // m, see OriginShifts::moved
    std::pmr::vector<ObjectSnapshot> objects{memory};
    BurnSnapshot burn{memory};
    std::pmr::vector<Tag> tags{memory};
    ExchangeSnapshot exchange{memory};
    WindSnapshot wind{memory};
    RoomSnapshot rooms{memory};
    SlottedList<FireSnapshot> fires{memory};
    SlottedList<EmitterSnapshot> emitters{memory};
    SlottedList<FieldSnapshot> fields{memory};
    std::pmr::vector<SavedEvent> events{memory};  // oldest first

    template <class A>
    void serialize(A& a) {
        serializeRules(a, rules);
        a(clock, origin);
        a.range("origin", origin, -1e9, 1e9);
        a.list("burnable meshes", objects, 64);
        a(burn);
        a.list("tags", tags, 12);
        a(exchange, wind, rooms);
        a.list("volumetric fires", fires, 28);
        a.list("fire emitters", emitters, 36);
        a.list("particle fields", fields, 53);
        a.list("events", events, 32);
    }
};

// The objects of a snapshot as the backend and the systems take them.
struct RestoredObjects {
    explicit RestoredObjects(std::pmr::memory_resource* memory)
        : latches(memory), stores(memory), images(memory) {}
    std::pmr::vector<components::Latch> latches;  // of each object
    std::pmr::vector<ImageStore> stores;          // of touched ones
    std::pmr::vector<gpu::RestoredObject> images;
};

struct Save {  // that is under way, and the last one
    explicit Save(std::pmr::memory_resource* memory)
        : snapshot(memory), planes(memory), bytes(memory) {}
    bool requested = false, pending = false, ready = false, failed = false;
    uint64_t frameIndex = 0;  // whose state is taken
    uint64_t eventsFrom = 0;  // number of the first that was not polled then
    Snapshot snapshot;
    std::pmr::vector<std::byte> planes, bytes;
};

// The whole file: a header, and what it sums up.
constexpr uint32_t kSaveVersion = 9;
constexpr uint32_t kMaxSavedEvents = EventQueue::kCapacity;
void writeSnapshot(const Snapshot& snapshot, std::pmr::vector<std::byte>& out);
void readSnapshot(std::span<const std::byte> bytes, Snapshot& snapshot);  // throws

}  // namespace fw::world
