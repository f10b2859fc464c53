// A world as bytes: what is in a save, besides the planes of its objects. Filled from a world, or
// read from a file and checked against one before anything of it changes.
#pragma once
#include "components/remote.h"
#include "world/shift.h"
#include "world/world.h"

namespace fw::world {

struct SavedTouch {        // of a fire or a jet
    uint32_t object1 = 0;  // slot + 1; 0: none
    uint64_t since = 0;
    float fireAt[3] = {}, objectAt[3] = {};
    bool flag = false;  // it lit it, or saw it
};

struct SavedFire {
    uint32_t slot = 0, flags = 0;
    float position[3] = {}, power = 0;
    uint32_t pointCount = 0;
    std::array<volume::ControlPoint, volume::kMaxControlPoints> points{};
    std::array<SavedTouch, 8> touches{};
};

struct SavedEmitter {
    uint32_t slot = 0, flags = 0;
    float position[3] = {}, direction[3] = {}, power = 0;
    std::array<SavedTouch, 8> touches{};
    bool streams = false;
    uint64_t kept = 0;
    components::JetPatches patches{};  // fuel that sticks
    uint32_t patchedAt = 0;
    std::pmr::vector<components::JetParcel> parcels;  // in flight, by their place
    std::pmr::vector<uint32_t> places;
    std::pmr::vector<uint8_t> swept;  // by parcel and ray: its hit is of the world as it is
    using allocator_type = std::pmr::polymorphic_allocator<>;
    explicit SavedEmitter(const allocator_type& a) : parcels(a), places(a), swept(a) {}
    SavedEmitter(SavedEmitter&& other, const allocator_type& a) : parcels(a), places(a), swept(a) {
        *this = std::move(other);
    }
    SavedEmitter(SavedEmitter&&) = default;
    SavedEmitter& operator=(SavedEmitter&&) = default;
};

struct SavedField {
    uint32_t slot = 0, width = 0, height = 0;
    uint64_t began = 0;
    float position[3] = {}, rotation[4] = {}, amount = 0;
    bool wets = false;
    uint32_t step = 0;
    uint64_t emitted = 0, died = 0, left = 0;
    std::pmr::vector<uint32_t> cells;
    using allocator_type = std::pmr::polymorphic_allocator<>;
    explicit SavedField(const allocator_type& a) : cells(a) {}
    SavedField(SavedField&& other, const allocator_type& a) : cells(a) { *this = std::move(other); }
    SavedField(SavedField&&) = default;
    SavedField& operator=(SavedField&&) = default;
};

struct SavedBlocker {
    uint32_t slot = 0;
    components::Pose pose;
    float halfSize[3] = {};
};

struct SavedWindZone {
    uint32_t slot = 0;
    components::WindZone zone;
};

struct SavedRoom {
    uint32_t slot = 0;
    components::Room room;
    uint32_t oxygen = 0;  // of its air, as power and flash
    uint32_t power = 0, flash = 0, drawn = 0, stirs = 0;
    uint32_t epoch = 0;  // which beginning's; not in files
};

struct SavedTag {
    uint32_t object = 0, texel = 0, tag = 0;
};

struct SavedEvent {  // that was not polled yet
    uint32_t type = 0, tag = 0;
    uint32_t object1 = 0, other1 = 0;  // slot + 1; 0: none
    float position[3] = {}, value = 0;
};

// Of an object whose host asks what breaks, see Breaks.
struct SavedBreaks {
    float share = 0, area = 0;
    bool shareTold = false, waits = false;
    std::span<const std::byte> lost;  // a plane, 1 by texel that hung on nothing
};

struct SavedPair {  // that touch, since when
    uint32_t slots[2] = {}, since = 0;
};

struct SavedStats {  // as of the readback
    uint32_t frontTiles = 0, burningTiles = 0, hotTiles = 0, receivers = 0;
    uint32_t lateClamps = 0;
};

struct SavedObject {
    uint32_t slot = 0;
    uint64_t asset = 0;  // of its mesh, materials and rules
    components::Pose pose;
    uint32_t firstEvent = 0;
    Play play;
    uint64_t burnHash = 0;
    uint32_t zoneWind = 0;             // that zones and gusts add where it is, packed
    bool placed = false, due = false;  // as others see it; it is to be seen anew
    gpu::RemoteObject remote{};        // where it is due; else its wind alone
    bool touched = false;
    uint32_t air = 0;      // of its room, if it is not touched; the rest is of those
    bool carried = false;  // another's burn, which its power does not count yet
    std::array<fire::WindFilter, components::kMaterials> filters{};
    components::Pose latched;
    Story story;  // as of its last readback
    gpu::ObjectCounters counters{};
    bool asksBreaks = false;
    SavedBreaks breaks;
    std::span<const std::byte> planes;  // of its image
};

struct SavedWorld {
    explicit SavedWorld(std::pmr::memory_resource* memory)
        : windGrid(memory),
          heatShield(memory),
          objects(memory),
          pending(memory),
          tags(memory),
          pairs(memory),
          seen(memory),
          blockers(memory),
          latchedBlockers(memory),
          windZones(memory),
          zones(memory),
          rooms(memory),
          fires(memory),
          emitters(memory),
          fields(memory),
          events(memory) {}
    // Rules, which must be the world's.
    float pace = 1, up[3] = {}, spreadChance = 1, timeToLive = 0;
    uint32_t seed = 0, maxHops = 0, maxBurningTiles = 0;
    // State.
    Clock clock;
    uint64_t steps = 0, droppedSteps = 0, order = 0;
    float wind[3] = {};
    components::WindGrid windGrid;
    components::HeatShield heatShield;
    components::Gusts gusts;
    double origin[3] = {};  // m, see World::origin_
    uint32_t flags = 0;
    bool warms = false, blockersDue = false;
    uint64_t fades = 0;
    bool idle = true;  // nothing burns, and nobody has to hear of who moves
    uint64_t lastStimulus = 0;
    uint64_t gustsShown = 0;    // tick of the gusts that objects keep
    uint64_t roomsStirred = 0;  // tick
    SavedStats stats;
    std::pmr::vector<SavedObject> objects;
    std::pmr::vector<PendingTexel> pending;
    std::pmr::vector<SavedTag> tags;
    std::pmr::vector<SavedPair> pairs;
    std::pmr::vector<Seen> seen;
    std::pmr::vector<SavedBlocker> blockers;
    std::pmr::vector<gpu::Blocker> latchedBlockers;
    std::pmr::vector<SavedWindZone> windZones;
    std::pmr::vector<components::WindZone> zones;  // the same in the order in which they count
    std::pmr::vector<SavedRoom> rooms;
    std::pmr::vector<SavedFire> fires;
    std::pmr::vector<SavedEmitter> emitters;
    std::pmr::vector<SavedField> fields;
    std::pmr::vector<SavedEvent> events;  // oldest first
};

// The planes of an image, which together are `planes` of a SavedObject.
struct PlaneScratch {
    explicit PlaneScratch(std::pmr::memory_resource* memory)
        : real(memory), sources(memory), values(memory) {}
    std::pmr::vector<uint8_t> real, sources;
    std::pmr::vector<uint32_t> values;
};
void writeImage(const gpu::ObjectImage& image, const mesh::BurnDomain& domain, uint32_t tick,
                uint32_t windowMost, PlaneScratch& scratch, std::pmr::vector<std::byte>& out);

struct ImageStore {  // what a read ObjectImage points to
    explicit ImageStore(std::pmr::memory_resource* memory)
        : ticks(memory), heat(memory), tiles(memory), tileHeat(memory), lost(memory) {}
    std::pmr::vector<uint32_t> ticks;
    std::pmr::vector<gpu::uvec2> heat;
    std::pmr::vector<gpu::TileState> tiles;
    std::pmr::vector<gpu::TileHeat> tileHeat;
    std::pmr::vector<uint32_t> lost;  // of its breaks, apart from the image; empty: none are saved
};
// Throws where the planes are none of writeImage's. `heat`: of its materials; empty: it has none.
void readImage(std::span<const std::byte> planes, const mesh::BurnDomain& domain, uint32_t tick,
               uint32_t windowMost, std::span<const gpu::HeatMaterial> heat, PlaneScratch& scratch,
               ImageStore& store);

struct SavedRecords {  // what a saved object's planes are read by
    components::Records records;
    uint32_t window = 0;  // ticks beyond which nobody asks when a tile last changed
    bool heated = false;
    std::array<gpu::HeatMaterial, gpu::kMaterialsPerObject> heat{};
    [[nodiscard]] std::span<const gpu::HeatMaterial> heatSpan() const noexcept {
        return std::span(heat).first(heated ? heat.size() : 0);
    }
};

struct Save {  // on its way, and the last one
    explicit Save(std::pmr::memory_resource* memory)
        : saved(memory), scratch(memory), planes(memory), bytes(memory) {}
    bool wished = false, pending = false, ready = false, failed = false;
    uint64_t frameIndex = 0;  // whose state is taken
    uint64_t eventsFrom = 0;  // number of the first that was not polled then
    SavedWorld saved;
    PlaneScratch scratch;
    std::pmr::vector<std::byte> planes, bytes;
};

// The whole file: a header, and what it sums up.
constexpr uint32_t kSaveVersion = 8;
constexpr uint32_t kMostSavedEvents = EventQueue::kCapacity;
void writeSaved(const SavedWorld& saved, std::pmr::vector<std::byte>& out);
void readSaved(std::span<const std::byte> bytes, SavedWorld& saved);  // throws

}  // namespace fw::world
