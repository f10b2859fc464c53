// Saves: a Snapshot holds what a world knows as of one frame, and its objects' images come with
// that frame's readback. As bytes it is a header and the snapshot, serialized.
#pragma once
#include "components/remote.h"
#include "save/archive.h"
#include "world/world.h"

namespace fw::world {

template <class T>
struct Slotted : T {  // of a pool
    uint32_t slot = 0;

    template <class A>
    void serialize(A& a) {
        a(slot);
        T::serialize(a);
    }
};

struct FireSnapshot : components::FireControls {
    uint32_t flags = 0;  // FW_FIRE_IGNITES
    std::array<FireTouch, 8> touches{};

    template <class A>
    void serialize(A& a) {
        components::FireControls::serialize(a);
        a(flags, touches);
    }
};

struct EmitterSnapshot {
    uint32_t flags = 0;  // FW_EMITTER_JET, FW_EMITTER_IGNITES
    float position[3] = {}, direction[3] = {}, power = 0;
    std::array<components::JetTouch, 8> touches{};
    core::Owned<components::JetStream> stream;

    template <class A>
    void serialize(A& a) {
        a(flags, position, direction, power, touches);
        a.optional(stream);
        a.range("fire emitter's place", position, -1e6, 1e6);
        a.range("fire emitter's direction", direction, -1e6, 1e6);
        a.range("fire emitter's power", power, 0, components::kMaxPower);
    }
};

struct FieldSnapshot {
    uint32_t width = 0, height = 0;
    uint64_t began = 0;  // tick
    float position[3] = {}, rotation[4] = {}, amount = 0;
    core::Owned<field::FieldCells> cells;  // of one that wets

    template <class A>
    void serialize(A& a) {
        a(width, height, began, position, rotation, amount);
        a.optional(cells);
        a.range("particle field's place", position, -1e6, 1e6);
        a.range("particle field's amount", amount, 0, 4);
        double length = 0;
        for (const float value : rotation) length += double(value) * double(value);
        a.range("square of the length of a particle field's rotation", length, 0.99, 1.01);
    }
};

struct ObjectSnapshot : ObjectState {
    uint32_t slot = 0;
    uint64_t asset = 0;  // hash of its mesh, materials and rules
    components::Pose pose;
    uint64_t burnHash = 0;  // of the baked burn that it plays
    bool placed = false;
    std::array<fire::WindFilter, components::kMaterials> filters{};
    components::Pose latched;
    bool findsBreaks = false;
    BreakState breaks;
    std::span<const std::byte> lost;    // plane of the texels that hung on nothing
    std::span<const std::byte> planes;  // of its image

    template <class A>
    void serialize(A& a) {
        a(slot, asset, pose, firstEvent, play, zoneWind, placed, exchangeDue);
        a.range("burnable mesh's place", pose.translation, -1e6, 1e6);
        if (play.burn1 != 0) a(burnHash);
        // A latched record follows from the pose, but for the wind that it was latched in.
        if (placed && exchangeDue) a(remote);
        if (placed && !exchangeDue) a(remote.high.w);
        a(touched, carried);
        if (!touched) {
            a(counters.air);
            return;
        }
        a(filters, latched, lifecycle, counters, findsBreaks);
        if (findsBreaks) {
            a(breaks);
            a.blob("bytes of broken texels", lost);
        }
        a.blob("bytes of a burnable mesh's planes", planes);
    }
};

struct ReadbackStats {  // as of the readback
    uint32_t frontTiles = 0, burningTiles = 0, hotTiles = 0, receivers = 0, lateClamps = 0;

    FW_SERIALIZE(frontTiles, burningTiles, hotTiles, receivers, lateClamps)
};

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
    explicit Snapshot(std::pmr::memory_resource* memory)
        : windGrid(memory),
          heatOcclusion(memory),
          objects(memory),
          pending(memory),
          tags(memory),
          pairs(memory),
          seen(memory),
          occluders(memory),
          latchedOccluders(memory),
          windZones(memory),
          rooms(memory),
          fires(memory),
          emitters(memory),
          fields(memory),
          events(memory),
          zones(memory) {}
    FwWorldDef rules{};  // which must be the world's
    Clock clock;
    uint64_t steps = 0, droppedSteps = 0, order = 0;
    float wind[3] = {};
    components::WindGrid windGrid;
    components::HeatOcclusion heatOcclusion;
    components::Gusts gusts;
    double origin[3] = {};  // m, see OriginShifts::moved
    uint32_t flags = 0;
    bool warms = false, occludersDue = false;
    uint64_t fades = 0;
    bool idle = true;  // nothing burns, and nobody has to hear of who moves
    uint64_t lastStimulus = 0;
    uint64_t gustsShown = 0;    // tick of the gusts that objects keep
    uint64_t roomsStirred = 0;  // tick
    ReadbackStats stats;
    std::pmr::vector<ObjectSnapshot> objects;
    std::pmr::vector<PendingTexel> pending;
    std::pmr::vector<Tag> tags;
    std::pmr::vector<PairContacts> pairs;  // that touch
    std::pmr::vector<Seen> seen;
    std::pmr::vector<Slotted<HeatOccluderEntry>> occluders;
    std::pmr::vector<gpu::HeatOccluder> latchedOccluders;
    std::pmr::vector<Slotted<components::WindZone>> windZones;
    std::pmr::vector<Slotted<RoomEntry>> rooms;
    std::pmr::vector<Slotted<FireSnapshot>> fires;
    std::pmr::vector<Slotted<EmitterSnapshot>> emitters;
    std::pmr::vector<Slotted<FieldSnapshot>> fields;
    std::pmr::vector<SavedEvent> events;           // oldest first
    std::pmr::vector<components::WindZone> zones;  // windZones in the order in which they apply

    template <class A>
    void serialize(A& a) {
        serializeRules(a, rules);
        a(clock, steps, droppedSteps, order, wind, flags, warms, occludersDue, fades, idle,
          lastStimulus, gustsShown, roomsStirred, stats);
        a.range("wind", wind, -double(fire::kMaxWind), double(fire::kMaxWind));
        a.list("burnable meshes", objects, 64);
        a.list("events that wait", pending, 32);
        a.list("tags", tags, 12);
        a.list("pairs that touch", pairs, 12);
        a.list("pairs whose sight is known", seen, 12);
        a.list("occluders", occluders, 64);
        a.list("latched occluders", latchedOccluders, 64);
        a(windGrid, heatOcclusion, gusts, origin);
        a.range("origin", origin, -1e9, 1e9);
        a.list("wind zones", windZones, 108);
        a.list("rooms", rooms, 164);
        a.list("volumetric fires", fires, 28);
        a.list("fire emitters", emitters, 36);
        a.list("particle fields", fields, 53);
        a.list("events", events, 32);
    }
};

struct ImageStore {  // the arrays of a read ObjectImage
    explicit ImageStore(std::pmr::memory_resource* memory)
        : ticks(memory), heat(memory), tiles(memory), tileHeat(memory), lost(memory) {}
    std::pmr::vector<uint32_t> ticks;
    std::pmr::vector<gpu::uvec2> heat;
    std::pmr::vector<gpu::TileState> tiles;
    std::pmr::vector<gpu::TileHeat> tileHeat;
    std::pmr::vector<uint32_t> lost;  // of its breaks, apart from the image; empty: none are saved
};
// `window`: ticks beyond which nobody asks when a tile last changed.
void writeImage(const gpu::ObjectImage& image, const mesh::BurnDomain& domain, uint32_t tick,
                uint32_t window, std::pmr::vector<std::byte>& out);
// Throws unless writeImage wrote the planes. `heat`: of its materials; empty: it has none.
void readImage(std::span<const std::byte> planes, const mesh::BurnDomain& domain, uint32_t tick,
               uint32_t window, std::span<const gpu::HeatMaterial> heat, ImageStore& store);

struct BurnRecords {  // with which a saved object's planes are read
    components::Records records;
    uint32_t window = 0;
    bool heated = false;
    std::array<gpu::HeatMaterial, gpu::kMaterialsPerObject> heat{};
    [[nodiscard]] std::span<const gpu::HeatMaterial> heatSpan() const noexcept {
        return std::span(heat).first(heated ? heat.size() : 0);
    }
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
