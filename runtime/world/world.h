// A world of burnable meshes: ids, time, wind, queues and what comes back from a backend. Integer
// CPU code, the same for every backend; it knows no device and no C edge. Calls throw core::Error
// or std::bad_alloc and then have changed nothing. One thread at a time.
#pragma once
#include "book/book.h"
#include "components/fire_emitter.h"
#include "components/fire_flames.h"
#include "components/gusts.h"
#include "components/heat_shield.h"
#include "components/particle_field.h"
#include "components/remote.h"
#include "components/room.h"
#include "components/surroundings.h"
#include "components/wind_grid.h"
#include "components/wind_zone.h"
#include "core/handle_pool.h"
#include "core/log.h"
#include "core/owned.h"
#include "flamewright/flamewright_debug.h"
#include "gpu/backend.h"
#include "mesh/burn_domain.h"
#include "mesh/front/arrivals.h"
#include "mesh/hold.h"
#include "mesh/remote_tiles.h"
#include "volume/depth_picture.h"
#include "world/clock.h"
#include "world/command_log.h"
#include "world/event_queue.h"
#include "world/governor.h"
#include "world/neighbours.h"
#include "world/played.h"
#include "world/recording.h"
#include "world/timeline.h"

#include <algorithm>
#include <array>
#include <atomic>

namespace fw::world {

// PendingTexel::texel of an event that addresses all texels of an object.
constexpr uint32_t kAllTexels = 0xFFFFFFFFu;

enum class SaveFor : uint8_t { host, net, timeline, count };  // each has a save of its own

enum class InnerSkin : uint8_t { unknown, none, there };
struct GoneTexels {  // of objects that show these cut-outs
    std::array<FwImageId, gpu::kMaterialsPerObject> images{};  // by material; null: no cut-out
    std::pmr::vector<uint8_t> texels;                          // as components::makeGone
    explicit GoneTexels(std::pmr::memory_resource* memory) : texels(memory) {}
};
struct MeshEntry {
    core::Owned<mesh::BurnDomain> domain;
    core::Owned<mesh::DeformModel> deform;                      // once an object deforms
    std::array<uint32_t, gpu::kMaterialsPerObject> texelsOf{};  // real texels per material index
    uint32_t users = 0;                                         // objects, and shapes of it
    // A shape of another mesh, for objects whose scale is not uniform: lives while one uses it.
    uint32_t parentPlus1 = 0;  // its slot + 1; 0: a mesh of the host's
    float shape[3] = {1, 1, 1};
    uint64_t hash = 0;                         // of the domain, once a save asked; 0: not yet
    core::Owned<GoneTexels> gone;              // of the last object with cut-outs: most are alike
    InnerSkin innerSkin = InnerSkin::unknown;  // that the backend has
    float innerWall = 0;                       // m, how deep that is
    core::Owned<mesh::Pieces> pieces;          // once an object asks what breaks
    uint32_t refinements = 0;  // bit per depth that the backend has; 16 higher: as published
    // By depth, once an object is refined by the published scheme.
    std::array<core::Owned<mesh::ArpModel>, gpu::kRefineDepth + 1> arps;
};

struct ImageEntry {
    uint32_t slot = 0;  // the backend's; outlives the id while an object uses it
    components::CutOut cutOut;
};

struct BurnMapCopy {  // of fwDebug_RequestBurnMap
    std::pmr::vector<uint32_t> ticks;
    std::pmr::vector<gpu::uvec2> heat;  // packed HeatTexel; empty: none
    uint64_t tick = 0;
    bool wished = false, pending = false, ready = false;
    explicit BurnMapCopy(std::pmr::memory_resource* memory) : ticks(memory), heat(memory) {}
};

struct Forecast {  // of an object that was asked when fire arrives
    explicit Forecast(std::pmr::memory_resource* memory) : arrivals(memory) {}
    mesh::Arrivals arrivals;
    uint64_t tick = 0, frameIndex = 0;         // whose state it began with
    uint64_t changes = 0, pendingChanges = 0;  // World::changesOf then, and of the one on its way
    bool told = false;                         // it began
    bool wished = false;                       // with the state of the next frame
    bool pending = false;                      // that is on its way
};

struct BreakState {
    float share = 0, area = 0;  // as in its def; 0: not asked
    bool shareTold = false;
    bool waits = false;  // some of what caught is not gone yet

    template <class A>
    void serialize(A& a) {
        a(share, area, shareTold, waits);
    }
};

// Of an object whose host asks what breaks, see breaks.cpp.
struct Breaks : BreakState {
    explicit Breaks(std::pmr::memory_resource* memory) : lost(memory) {}
    bool hangs = false;           // from its pins; else it stands
    std::array<FwPin, 8> pins{};  // object space
    uint32_t pinCount = 0;
    std::pmr::vector<bool> lost;       // by texel: it hung on nothing when it was last looked for
    core::Owned<mesh::Pieces> pieces;  // of an object with cut-outs; null: its mesh's
    std::array<uint64_t, 8> looks{};   // frames whose state of it is on its way, oldest first
    uint32_t lookCount = 0;
};

// A frame whose readback is on its way, as the count of steps and sleep follow from it.
struct FrameNote {
    uint64_t frameIndex = 0, end = 0;  // tick
    uint64_t roomsStirred = 0;         // tick
    uint32_t steps = 0;
    bool stirs = false;  // some event came
    bool never = false;  // it may not sleep
};

// The course of an object's fire, and the part reported to the host, as of a readback. In ticks.
struct Story {
    bool active = false;   // its front or flames may still move
    bool sawFire = false;  // since the last IGNITED
    bool ignitionKnown = false;
    uint64_t lastStimulus = 0;  // tick of the last event
    uint64_t lastDouse = 0;     // tick, 0: never
    uint32_t douseCause = 0;    // FwExtinguishCause of that
    // How it ends: flames as they are at most, and texels that went out with fuel left. Both halve
    // with each second of the fire, so that its last flames decide.
    uint32_t flames = 0, wentOut = 0;
    uint64_t halvedUntil = 0;     // tick
    uint32_t outCause = 0;        // FwExtinguishCause of the last that went out
    uint64_t lastBurning = 0;     // tick of the last readback with burning texels
    uint64_t firstIgnition = 0;   // tick of the ignition that started this fire
    float ignitionPoint[3] = {};  // m, object space
    uint32_t litTold = 0;         // litTick of the last SPREAD_TO
    uint32_t spotsTold = 0;
    uint32_t mostIgnited = 0;
    uint32_t clampsTold = 0;             // late clamps that an event has told
    uint64_t energy = 0, heatSteps = 0;  // 2^-20 J after so many heat steps
    float power = 0;                     // W, at pace 1; of objects with heat

    template <class A>
    void serialize(A& a) {
        a(active, sawFire, ignitionKnown, lastStimulus, lastDouse, douseCause, flames, wentOut,
          halvedUntil, outCause, lastBurning, firstIgnition, ignitionPoint, litTold, spotsTold,
          mostIgnited, clampsTold, energy, heatSteps, power);
    }
};

// Effects of one frame on an object's fire. The object's record applies them with the readback of
// that frame, so that events and saves are alike however late readbacks come.
struct Stimulus {
    uint64_t frameIndex = 0;
    uint32_t slot = 0;
    bool first = false;   // the first that ever addressed the object
    bool starts = false;  // its front or flames may move
    bool ignites = false, douses = false;
    uint64_t heatSteps = 0;  // of `first`: steps of heat before it
    uint64_t latest = 0;     // of `starts`: tick of the last event
    uint64_t ignition = 0;   // of `ignites`: tick, and m in object space
    float ignitionPoint[3] = {};
    uint64_t douse = 0;       // of `douses`: tick
    uint32_t douseCause = 0;  // FwExtinguishCause of that
    uint32_t from1 = 0;       // slot + 1 of the object whose burn is carried to this one; 0: none
    core::Owned<Story> given{};  // of that other one, if it is gone before the readback comes
};

struct ObjectState {                    // of an object, that a save has as it is
    uint32_t firstEvent = 0xFFFFFFFFu;  // tick of the first event ever
    Play play;                          // the baked burn that it plays
    uint32_t zoneWind = 0;              // that zones add where it is, packed
    bool touched = false;               // an event ever addressed it: it filters wind and latches
    bool carried = false;        // from another: what it got so far counts as no power of its own
    bool remoteDue = false;      // pose or def changed since its latch: it is in remote_.due
    gpu::RemoteObject remote{};  // as others see it, latched every kRemoteLatchTicks
    Story story;
    gpu::ObjectCounters counters{};  // as of the last readback
};

struct Object : ObjectState {
    explicit Object(std::pmr::memory_resource* memory)
        : slowness(memory), map(memory), skin(memory), skinNormals(memory) {}

    components::BurnableMesh data;
    components::Latch latch;  // the drive that its front sees
    uint32_t slot = 0;        // the backend's: its index in the pool
    FwBurnableMeshId id{};
    uint32_t texels = 0;                  // that can burn
    components::Fuel fuel;                // when it was made; none: it keeps no book
    uint64_t firstFrame = 0;              // readbacks of older frames speak of another object
    std::pmr::vector<uint16_t> slowness;  // per texel, Q7; empty: the mesh's own
    uint64_t memoryBytes = 0;             // of it in World::memoryCounts_
    uint32_t stimuli = 0;                 // of World::stimuli_ that it has
    uint32_t stimulusAt = mesh::kNone;    // of those, the one of the frame that is committed
    bool ignites = false;                 // some of those ignite it
    // Fire at a distance: as others see it, latched every kRemoteLatchTicks.
    components::Governance governance;
    uint32_t reach = 0;          // mm
    uint32_t remoteVersion = 0;  // grows with every latch; 0: never placed
    uint64_t planStamp = 0;      // of the plan whose latches hold it
    size_t latchIndex = 0;       // of frame_.latches, in that plan
    uint64_t restsUnder = 0;   // driveChanges_ + 1 under which its latch, as it is, rests; 0: none
    bool remoteSent = true;    // the backend has the latched record; else it is in remote_.unsent
    bool contactsDue = false;  // it is in remote_.contactsDue
    bool seenDue = false;      // it is in remote_.seenDue
    uint32_t room1 = 0;        // slot + 1 of the room that it is in; 0: none
    // As of the last readback.
    uint64_t countersFrame = 0;
    BurnMapCopy map;
    core::Owned<Forecast> forecast;  // null: never asked for
    core::Owned<Breaks> breaks;      // null: not asked for
    uint64_t changes = 0;            // of what its fire will do, that we know of
    // A burn is carried from or to it: its other events wait until the end of that step.
    uint32_t carryEnd = 0;  // tick
    // Of a skinned object: the host's vertices, m, in its mesh's shape; 3 each. Normals are
    // scratch.
    std::pmr::vector<float> skin, skinNormals;
    bool skinMoved = false;  // else they are at rest
};

struct StateCopy {            // of the object in a slot
    uint32_t generation = 0;  // of it; where there is none: of the next one there
    bool live = false;
    bool touched = false;  // its fire may change; else frameIndex is that of the last readback
    FwObjectState state{};
};

struct Tag {
    FwBurnableMeshId object{};
    uint32_t texel = 0, tag = 0;

    template <class A>
    void serialize(A& a) {
        a.texel("a tag", object, texel);
        a(tag);
    }
};

struct Query {
    FwBurnableMeshId object{};
    uint32_t texel = 0;
    float distance = 0;  // m
    FwPointState answer{};
    bool asked = false, ready = false;
    bool isArrival = false;
    uint64_t since = 0, sinceTick = 0;  // of an arrival: a forecast from there on answers it
};

constexpr uint32_t kWaysOfFire =
    FW_WORLD_RADIATION | FW_WORLD_PLUME | FW_WORLD_CONTACT | FW_WORLD_EMBERS;
constexpr uint32_t kWorldFlags =
    kWaysOfFire | FW_WORLD_NO_SPREAD | FW_WORLD_NO_DAMAGE | FW_WORLD_NO_HOLES;

struct BlockerEntry {
    components::Pose pose;
    float halfSize[3] = {};

    template <class A>
    void serialize(A& a) {
        a(pose, halfSize);
        a.range("blocker's place", pose.translation, -1e6, 1e6);
        a.range("blocker's half size", halfSize, 0, 30);
    }
};

struct RoomEntry {
    components::Room room;
    gpu::RoomAir air{};  // as of the last readback, or as it begins

    template <class A>
    void serialize(A& a) {
        a(room, air.oxygen, air.power, air.flash, air.drawn, air.stirs);
        a.range("power of a room's fires", air.power, 0,
                double(gpu::kFlashMost * (gpu::kRoomMeans - 1)));
    }
};

// A burnable mesh within a fire's flame, since when and where; of fires that ignite.
struct FireTouch {
    FwBurnableMeshId object{};
    uint64_t since = 0;      // tick
    float fireAt[3] = {};    // m, the fire's base then
    float objectAt[3] = {};  // and the object's
    bool lit = false;        // it caught already
    bool seen = false;       // in this exchange

    template <class A>
    void serialize(A& a) {
        a.object("a flame", object);
        if (object.index1 != 0) a(since, fireAt, objectAt, lit);
    }
};

struct Fire {
    explicit Fire(std::pmr::memory_resource* memory) : data(memory) {}
    components::VolumetricFire data;
    std::array<FireTouch, 8> touches{};
};

struct Field {
    explicit Field(std::pmr::memory_resource* memory) : data(memory) {}
    components::ParticleField data;
    uint64_t began = 0;       // tick
    uint32_t steps = 0;       // that it has come to
    uint32_t shownBase = 0;   // the backend has run all but these
    uint64_t firstFrame = 0;  // readbacks of older frames speak of another field
    gpu::FieldCounters counters{};
    uint64_t countersFrame = 0;
    // The same cells as the backend's, of one that wets: what it touches is ours to know.
    core::Owned<field::Field> cells;
};

// Piloted ignition under `flux` W/m^2: thick or thin, whichever is sooner.
uint64_t ticksToCatch(const FwMaterialDef& material, float moisture, float pace,
                      double flux) noexcept;

struct FireProfileEntry {
    uint32_t layer = 0, users = 0;
};

struct FlipbookEntry {
    core::Owned<book::Book> book;
    uint32_t users = 0;
    bool emits = false;  // it hides nothing
};

struct FireColliderEntry {
    explicit FireColliderEntry(std::pmr::memory_resource* memory)
        : heights(memory), picture(memory) {}
    volume::Collider shape;
    std::pmr::vector<float> heights;
    float(FW_CALL* distance)(void*, const float*, float*) = nullptr;
    void* distanceData = nullptr;
    float unitsPerMetre = 1;  // what the host's function gets and gives
    volume::DepthPicture picture;
};

// Contacts of two objects as they were last found.
struct PairContacts {
    uint32_t slots[2] = {}, versions[2] = {};
    FwBurnableMeshId ids[2] = {};
    uint32_t since = 0;  // tick, while they touch
    bool touches = false;
    uint64_t stamp = 0;  // RemoteBook::contactStamp when it was last found near

    template <class A>
    void serialize(A& a) {
        for (uint32_t& slot : slots) a.object("a contact", slot);
        a(since);
    }
};

// An object whose box is so near that the two may touch.
struct CloseObject {
    uint32_t slot = 0xFFFFFFFFu;
    uint32_t pair = 0;  // of RemoteBook::pairs
};

struct Seen {  // what the host said that a fire of slots[1] sees of slots[0]
    uint32_t slots[2] = {};
    uint32_t part = 255;  // of 255

    template <class A>
    void serialize(A& a) {
        for (uint32_t& slot : slots) a.object("a line of sight", slot);
        a(part);
        a.range("visible share", part, 0, 255);
    }
};

// What the frame plans of who is where. Kept across frames, so that what did not move is not sought
// again; a frame that fails leaves it stale at worst, and the next one sends it once more.
struct RemoteBook {
    explicit RemoteBook(std::pmr::memory_resource* memory)
        : due(memory),
          unsentSlots(memory),
          neighbours(memory),
          loadedSeen(memory),
          waiting(memory),
          contactsDue(memory),
          seenDue(memory),
          close(memory, {}),
          closeOf(memory),
          pairs(memory),
          links(memory, noLink()),
          linksOf(memory),
          contacts(memory),
          pairLinks(memory),
          mergedLinks(memory),
          blockers(memory) {}
    [[nodiscard]] static gpu::ContactLink noLink() noexcept {
        gpu::ContactLink link{};
        link.object = gpu::kNoneTexel;
        return link;
    }
    uint32_t flags = 0;        // FwWorldFlags that open ways
    uint32_t objectFlags = 0;  // and those that objects are created under
    components::Governance governance;
    bool governed = false;  // some object or the world limits its fire
    bool capped = false;    // and how many tiles may burn
    uint32_t governedObjects = 0, cappedObjects = 0;
    bool unsent = false;  // the backend does not know the latest
    bool blockersDue = false;
    bool warms = false;                      // flags ever let fire shine or blow on others
    uint64_t fades = 0;                      // tick until which what they received is taken back
    std::pmr::vector<uint32_t> due;          // slots to latch
    std::pmr::vector<uint32_t> unsentSlots;  // whose records the backend does not have
    uint32_t version = 0;                    // of the last latched object
    Neighbours neighbours;                   // of latched boxes
    std::pmr::vector<Seen> loadedSeen;       // kept by slots until the lists are rebuilt
    bool rebuild = false;                    // all but `pairs` is of another world
    // Placed objects that no event ever touched, and some that one did since; and whether the
    // neighbours of all touched objects have been touched, but for `neighbours.changed()`.
    std::pmr::vector<uint32_t> waiting;
    bool spreadKnown = false;
    // Objects that were latched since their contacts were found, and since the host was asked what
    // they see of their neighbours.
    std::pmr::vector<uint32_t> contactsDue, seenDue;
    ListPool<CloseObject> close;
    std::pmr::vector<ListPlace> closeOf;  // by slot: of `close`, by the other's slot
    std::pmr::vector<PairContacts> pairs;
    ListPool<gpu::ContactLink> links;
    std::pmr::vector<ListPlace> linksOf;  // by slot that they lead to: of `links`, by texel
    uint64_t contactStamp = 0;
    mesh::Contacts contacts;                                    // scratch
    std::pmr::vector<gpu::ContactLink> pairLinks, mergedLinks;  // scratch
    std::pmr::vector<gpu::Blocker> blockers;                    // latched
};

struct ShieldBook {
    explicit ShieldBook(std::pmr::memory_resource* memory)
        : grid(memory), told(memory), words(memory), fallen(memory) {}
    components::HeatShield grid;
    std::pmr::vector<uint32_t> told;   // slots that commands named so far
    std::pmr::vector<uint32_t> words;  // as the backend gets it
    std::pmr::vector<uint8_t> fallen;  // scratch
    gpu::ShieldUpdate update;
    bool unpacked = false;  // `words` are of another grid
    bool unsent = false;    // the backend does not know the latest
};

struct RemoteTables {  // what a RemoteUpdate of a frame points to
    explicit RemoteTables(std::pmr::memory_resource* memory)
        : objects(memory),
          neighbourRanges(memory),
          linkRanges(memory),
          neighbours(memory),
          links(memory),
          blockers(memory) {}
    std::pmr::vector<gpu::RemoteUpdate::Placed> objects;
    std::pmr::vector<gpu::RemoteUpdate::Range> neighbourRanges, linkRanges;
    // As they were, where they change again in the same frame; else the world's own.
    std::pmr::vector<uint32_t> neighbours;
    std::pmr::vector<gpu::ContactLink> links;
    std::pmr::vector<gpu::Blocker> blockers;
    gpu::RemoteUpdate update;
};

struct PendingTexel {  // an event that waits for its step; texel kAllTexels: of all of the object
    uint32_t object = 0, texel = 0, kind = 0, tick = 0, water = 0;  // g/m^2; of heat: W/m^2
    uint64_t order = 0;
    // Of heat that came through holes, if they are there: the last gate may have to be shut.
    std::array<components::JetGate, components::kJetGates> gates{};
    uint32_t gateCount = 0;
    bool shut = false;

    template <class A>
    void serialize(A& a) {
        a(object, texel, kind, tick, water, order, gateCount, shut);
        a.require(gateCount <= components::kJetGates, "number of holes that an event waits for");
        for (uint32_t i = 0; i < gateCount; ++i) a(gates[i]);
    }
};
inline bool isCarry(const PendingTexel& event) noexcept {
    return gpu::eventKind(event.kind) == gpu::kEventCarry;
}
inline uint32_t carriedFrom(const PendingTexel& event) noexcept {  // slot
    return (event.kind >> gpu::kEventKindBits) - 1;
}

// All that blows.
struct Winds {
    fire::WindVector around{};  // everywhere
    const components::WindGrid& grid;
    const components::Gusts& gusts;
    std::span<const components::WindZone> zones;  // in the order in which they count
    uint32_t seed = 0;
};
[[nodiscard]] fire::WindVector windOf(const Winds& winds, const components::WindPlace& place,
                                      uint64_t tick) noexcept;

void checkWorldDef(const FwWorldDef& def);  // throws

// save.h
struct Snapshot;
struct ObjectSnapshot;
struct BurnRecords;
struct ImageStore;
struct Save;

class World {
 public:
    // `def` is checked here. The backend outlives the world.
    World(const FwWorldDef& def, gpu::Backend& backend, const core::Log& log,
          std::pmr::memory_resource* memory);
    ~World();
    World(const World&) = delete;
    World& operator=(const World&) = delete;

    void setWind(const float wind[3]);
    // Every place of the world moves by whole metres; `applied`: those, or null.
    void shiftOrigin(const float offset[3], float applied[3]);
    void origin(double* moved) const noexcept { std::copy_n(origin_, 3, moved); }
    // It moved since the last frame: what the backend shows stands where it was.
    [[nodiscard]] bool shifted() const noexcept {
        return shiftCount_ > 0 && shifts_[shiftCount_ - 1].frame == lastFrame_;
    }
    void setHeatShield(const FwHeatShieldDef& def);  // of structSize 0: none any more
    void setWindGrid(const FwWindGridDef& def);      // of structSize 0: none any more
    void setGusts(const FwGustDef& def);
    FwWindZoneId createWindZone(const FwWindZoneDef& def);
    void setWindZone(FwWindZoneId id, const FwWindZoneDef& def) {
        setWindZone(id, components::makeWindZone(def));
    }
    void setWindZone(FwWindZoneId id, const components::WindZone& zone);
    void destroyWindZone(FwWindZoneId id);
    FwRoomId createRoom(const FwRoomDef& def);
    void setRoom(FwRoomId id, const FwRoomDef& def) {
        setRoom(id, components::makeRoom(def), (def.flags & FW_ROOM_REFILL) != 0);
    }
    void setRoom(FwRoomId id, const components::Room& room, bool refills);
    void destroyRoom(FwRoomId id);
    void roomState(FwRoomId id, FwRoomState& state);
    void energyBook(FwEnergyBook& book) noexcept;
    void windAtPoint(const float point[3], float wind[3]) const;
    void setFlags(uint32_t given);
    FwBlockerId addBlocker(const FwBlockerDef& def);
    void moveBlocker(FwBlockerId id, const float transform[16]);
    void removeBlocker(FwBlockerId id);

    FwMaterialId createMaterial(const FwMaterialDef& def);
    void destroyMaterial(FwMaterialId id) { materials_.destroy(id); }
    FwImageId createImage(const FwImageDef& def);
    void destroyImage(FwImageId id);
    [[nodiscard]] bool showsImage(FwImageId id);  // some object does
    FwMeshId createMesh(const FwMeshDef& def);
    void destroyMesh(FwMeshId id);
    void meshInfo(FwMeshId id, FwMeshInfo& info);

    FwBurnableMeshId createBurnableMesh(const FwBurnableMeshDef& given);
    void destroyBurnableMesh(FwBurnableMeshId id);
    void setTransform(FwBurnableMeshId id, const float transform[16]);
    // Its backend slot; throws unless it is skinned and has so many vertices.
    uint32_t skinnedSlot(FwBurnableMeshId id, uint32_t vertexCount);
    void setVertexPositions(FwBurnableMeshId id, const float* positions, const float* normals,
                            uint32_t count);
    void setHidden(FwBurnableMeshId id, bool hidden);
    // Texels addressed. `acts`: one of them, or of a match one that can burn.
    uint32_t ignite(const FwIgnitionDef& def, bool* acts = nullptr);
    // Why a match that addressed so many texels lights nothing, for people.
    void explainNothingThere(const FwIgnitionDef& def, uint32_t texels,
                             std::span<char> text) noexcept;
    void transferBurn(FwBurnableMeshId from, FwBurnableMeshId to);

    FwVolumetricFireId createVolumetricFire(const FwVolumetricFireDef& def);
    void destroyVolumetricFire(FwVolumetricFireId id);
    void moveVolumetricFire(FwVolumetricFireId id, const float position[3]);
    void setVolumetricFirePower(FwVolumetricFireId id, float power);
    void setVolumetricFirePoints(FwVolumetricFireId id, const FwFirePoint* points, uint32_t count);
    void setVolumetricFireHidden(FwVolumetricFireId id, bool hidden);
    void setVolumetricFireTier(FwVolumetricFireId id, uint32_t tier);
    void setVolumetricFireTrack(FwVolumetricFireId id, const FwFireTrackDef* def);
    void volumetricFireState(FwVolumetricFireId id, FwVolumetricFireState& state);
    FwFireEmitterId createFireEmitter(const FwFireEmitterDef& def);
    void destroyFireEmitter(FwFireEmitterId id);
    void moveFireEmitter(FwFireEmitterId id, const float position[3], const float* direction);
    void setFireEmitterPower(FwFireEmitterId id, float power);
    void setFireEmitterHidden(FwFireEmitterId id, bool hidden);
    void fireEmitterState(FwFireEmitterId id, FwFireEmitterState& state);
    FwFlipbookId createFlipbook(const FwFlipbookDef& def);
    void destroyFlipbook(FwFlipbookId id);
    void setFlameFlipbooks(FwFlipbookId fire, FwFlipbookId smoke);
    FwFireProfileId createFireProfile(const FwFireProfileDef& def);
    void destroyFireProfile(FwFireProfileId id);
    FwFireColliderId addFireCollider(const FwFireColliderDef& def, float unitsPerMetre = 1);
    void setFireCollider(FwFireColliderId id, const FwFireColliderDef& def,
                         float unitsPerMetre = 1);
    void removeFireCollider(FwFireColliderId id);
    FwParticleFieldId createParticleField(const FwParticleFieldDef& def);
    void destroyParticleField(FwParticleFieldId id);
    void moveParticleField(FwParticleFieldId id, const float position[3], const float rotation[4]);
    void setParticleFieldAmount(FwParticleFieldId id, float amount);
    void setParticleFieldHidden(FwParticleFieldId id, bool hidden);
    void paintParticleField(FwParticleFieldId id, const uint8_t* paint, const uint8_t* walls);
    void particleFieldState(FwParticleFieldId id, FwParticleFieldState& state);

    void askVolumetricFires(const float point[3], FwFireAnswer& answer);
    void volumetricFirePush(const float centre[3], float radius, FwFirePush& push);

    // Throws unless advance would take these.
    void checkFrame(uint64_t frameIndex, float deltaTime) const;
    // One frame: collects readbacks, plans, runs the backend, collects again.
    void advance(uint64_t frameIndex, float deltaTime);
    // Takes readbacks that have come since; what memory refuses comes with the next frame.
    void collect() noexcept;
    [[nodiscard]] uint64_t lastFrame() const noexcept { return lastFrame_; }
    [[nodiscard]] uint32_t maxLights() const noexcept { return def_.maxLights; }

    uint32_t pollEvents(std::span<FwEvent> out);  // [any]
    // Of all burnable meshes, by slot, as objectState has them. `to` is that of an earlier call, or
    // empty: what never burnt is not read again.
    void copyStates(std::pmr::vector<StateCopy>& to);
    void tagPoint(FwBurnableMeshId id, const float position[3], uint32_t tag);
    void untagPoint(FwBurnableMeshId id, uint32_t tag);
    void objectState(FwBurnableMeshId id, FwObjectState& state);
    FwQueryId requestPoint(FwBurnableMeshId id, const float position[3]);
    bool fetchPoint(FwQueryId id, FwPointState& state);  // false: not ready
    FwQueryId requestArrival(FwBurnableMeshId id, const float position[3]);
    bool fetchArrival(FwQueryId id, FwArrivalState& state);  // false: not ready
    void cancelQuery(FwQueryId id) { queries_.destroy(id); }
    uint32_t lights(std::span<FwLight> out);
    void askSurroundings(const float point[3], FwSurroundings& out);
    float askSight(const float from[3], const float to[3]);
    void makeSafetyMask(const float corner[3], const float columnStep[3], const float rowStep[3],
                        uint32_t columns, uint32_t rows, uint8_t* mask);
    void stats(FwWorldStats& stats) noexcept;
    void setBudget(const FwBudgetDef& def);
    void budgetState(FwBudgetState& state) const noexcept;
    // ms that the host's thread was in a call of the frame that is about to be, or is.
    void spend(float milliseconds) noexcept { spent_.cpu += milliseconds; }

    // save.cpp. A save comes with the readback of the next frame; load is at once, or throws and
    // has changed nothing.
    void requestSave(SaveFor who = SaveFor::host);
    const std::pmr::vector<std::byte>* fetchSave(SaveFor who = SaveFor::host);  // null: not ready
    void cancelSave() noexcept;
    void load(std::span<const std::byte> bytes);

    // played.cpp. A burn is made of what requestBurnMap brings.
    const std::pmr::vector<std::byte>* fetchBurn(FwBurnableMeshId id);  // null: not ready
    void cancelBurnMap(FwBurnableMeshId id);
    FwBurnId createBurn(std::span<const std::byte> bytes);
    void destroyBurn(FwBurnId id);
    void playBurn(FwBurnableMeshId id, FwBurnId burn, float delay, float speed);
    void stopBurn(FwBurnableMeshId id);

    // recording.cpp
    Recording& startRecording(bool follows);
    void stopRecording() noexcept { recording_ = {}; }
    // command_log.cpp
    void startLog();
    void stopLog() noexcept;
    const std::pmr::vector<std::byte>& fetchLog();  // until the next call
    void openLog(std::span<const std::byte> bytes);
    // Applies the commands before the next step; s that the world may go then. 0: `untilTick` is
    // there.
    float playLog(uint64_t untilTick);
    // timeline.cpp
    void startTimeline(const FwTimelineDef& def);
    void stopTimeline() noexcept;
    // One piece of the way to a tick: `seconds` that the world may go then; 0: it is there. False:
    // nothing to begin from is there yet.
    bool seek(uint64_t untilTick, float& seconds);
    void timelineState(FwTimelineState& state);
    // save_tiles.cpp. Of an object in a save, a hash for each block of its tiles; none: it is at
    // rest there. The blocks whose hashes are not `theirs`, of a save of the same tick: as bytes
    // (false: the object is at rest), and put into that other save.
    std::pmr::vector<uint32_t> hashBlocks(std::span<const std::byte> save, uint32_t slot);
    bool writeBlocks(std::span<const std::byte> save, uint32_t slot,
                     std::span<const uint32_t> theirs, std::pmr::vector<std::byte>& out);
    void mergeBlocks(std::span<const std::byte> save, std::span<const std::byte> theirs,
                     std::pmr::vector<std::byte>& out);
    // Another world's command, before this one's next step. Throws unless this world can apply it.
    void apply(const Command& command);
    void applyLoad(std::span<const std::byte> bytes);  // of its save
    [[nodiscard]] uint64_t tick() const noexcept { return clock_.tick; }
    [[nodiscard]] double seconds() const noexcept;  // since its beginning
    // s from the present to the beginning of a later tick.
    [[nodiscard]] double secondsTo(uint64_t tick) const noexcept;
    // As that, and never a hair too short.
    [[nodiscard]] float secondsUpTo(uint64_t tick) const noexcept;
    [[nodiscard]] uint32_t mostSteps() const noexcept { return def_.maxStepsPerFrame; }
    // Of the rules, and of all that a save has to find here: worlds of one identity can follow
    // each other.
    [[nodiscard]] uint64_t identity() noexcept;
    [[nodiscard]] const core::Log& log() const noexcept { return log_; }

    // Appends what the world keeps of objects in this machine's memory, as the last step left it.
    // [any]
    void memoryRows(std::pmr::vector<gpu::MemoryRow>& out) const;
    // Boxes of objects that were compared to find neighbours, since the world was made; and to find
    // those near a place.
    [[nodiscard]] uint64_t pairsExamined() const noexcept { return remote_.neighbours.examined(); }
    [[nodiscard]] uint64_t placesExamined() const noexcept { return places_.examined(); }

    // flamewright_debug.h
    void requestBurnMap(FwBurnableMeshId id);
    const BurnMapCopy* fetchBurnMap(FwBurnableMeshId id);  // null: not ready
    void setSwitches(uint32_t switches);
    void pushTexels(FwBurnableMeshId id, uint32_t kind, std::span<const uint32_t> texels);
    const mesh::BurnDomain& domain(FwMeshId id) { return *meshes_.get(id).domain; }
    const mesh::BurnDomain& objectDomain(FwBurnableMeshId id) {
        return domainOf(*objects_.get(id));
    }

 private:
    static constexpr uint32_t kMaxSteps = 64;
    static_assert(kMaxSteps == gpu::kMaxFieldRounds);
    static constexpr uint32_t kMaxTags = 4096;
    static constexpr uint32_t kMaxQueries = 1024;
    static constexpr size_t kMaxPending = size_t(1) << 22;              // texel events that wait
    static constexpr uint32_t kMaxFireShapes = 64 + gpu::kMaxBlockers;  // colliders and blockers
    static constexpr uint32_t kFramesInFlight = 16;  // readbacks we still know the probes of

    struct ProbeRef {  // what a probe of a frame was for
        bool isTag = false;
        FwBurnableMeshId object{};
        uint32_t texel = 0, tag = 0;
        FwQueryId query{};
        uint32_t jet = 0, ray = 0;  // slot + 1 of an emitter
        uint32_t holeTicks = 0;     // of a jet's: see gateTicks
    };
    struct ProbeFrame {
        explicit ProbeFrame(std::pmr::memory_resource* memory) : refs(memory) {}
        uint64_t frameIndex = 0;
        std::pmr::vector<ProbeRef> refs;
    };
    struct Frame {  // scratch of one frame; keeps its room between frames
        explicit Frame(std::pmr::memory_resource* memory)
            : steps(memory),
              due(memory),
              events(memory),
              updates(memory),
              latches(memory),
              plays(memory),
              probes(memory),
              burnMaps(memory),
              breaks(memory),
              images(memory),
              remote(memory),
              fieldRuns(memory),
              fieldRounds(memory),
              fieldDraws(memory),
              fieldsDrawn(memory) {}
        struct Due {
            PendingTexel event;
            uint32_t step = 0;
        };
        struct LatchOf {
            Object* object = nullptr;
            components::Latch latch;
            bool due = false;  // an event of this frame addresses it
        };
        struct PlayOf {
            Object* object = nullptr;
            Play play;                   // as it is at the frame's end
            uint32_t lit = mesh::kNone;  // the first texel that catches by it
            uint32_t ended = 0;          // tick at which it went live
        };
        std::pmr::vector<gpu::StepPlan> steps;
        std::pmr::vector<Due> due;
        std::pmr::vector<gpu::TexelEvent> events;
        std::pmr::vector<gpu::MaterialUpdate> updates;
        std::pmr::vector<LatchOf> latches;  // of touched objects, as they are at the frame's end
        size_t spreadFrom = 0;              // of those, the first whose neighbours are not touched
        bool spreadFound = false;           // touchNear ran, and went through neighbours
        bool waitersTouched = false;        // or through all that waited
        std::pmr::vector<PlayOf> plays;     // of those that play a baked burn
        std::pmr::vector<gpu::Probe> probes;
        std::pmr::vector<uint32_t> burnMaps;
        std::pmr::vector<uint32_t> breaks;                   // slots of those looked at for breaks
        std::pmr::vector<uint32_t> images;                   // slots of objects that a save takes
        std::pmr::vector<core::Owned<RemoteTables>> remote;  // the first `remoteUsed` of them
        size_t remoteUsed = 0;
        bool remoteLatched = false, remoteFlushed = false, shieldSent = false;
        std::pmr::vector<gpu::FieldRun> fieldRuns;  // there is room for all of a frame
        std::pmr::vector<uint32_t> fieldRounds;
        std::pmr::vector<gpu::FieldDraw> fieldDraws;
        std::pmr::vector<uint32_t> fieldsDrawn;
        gpu::FieldUpdate fields;
        bool fieldsDue = false;     // the backend is told
        gpu::VolumeUpdate volumes;  // of fireFlames_
        bool volumesDue = false;    // the backend is told
        gpu::EmitterUpdate emitters;
        bool emittersDue = false;
    };

    // shift.cpp
    void shiftBy(const double (&by)[3]) noexcept;
    void noteShift(const double (&by)[3]) noexcept;
    // As a frame's readback says, to where it is now.
    void movePlace(float (&place)[3], uint64_t frame) const noexcept;
    // step.cpp
    void planSteps(const ClockAdvance& time);
    void sortDue();
    void planProbes();
    void commitFrame(uint64_t frameIndex, const ClockAdvance& time) noexcept;
    // fires.cpp
    void findFireRoom(uint32_t more);
    void foresee(components::VolumetricFire& fire) noexcept;
    uint32_t profileLayer(const FwVolumetricFireDef& def);
    void planFires(float seconds) noexcept;
    void commitFires() noexcept;
    // emitters.cpp
    [[nodiscard]] components::EmitterAir emitterAir(const components::FireEmitter& emitter,
                                                    float ahead) const noexcept;
    [[nodiscard]] bool showEmitters() const noexcept {  // in the planned frame
        return !emitterRecords_.empty() || !sparkSources_.empty();
    }
    [[nodiscard]] float burningAreaOf(const Object& object) noexcept;  // m^2
    [[nodiscard]] float powerOf(const Object& object) noexcept;        // W
    [[nodiscard]] float burningShare(const components::FireEmitter& emitter) noexcept;
    // books.cpp
    void showBooks(uint32_t slot, const book::Book* fresh);
    uint32_t bookByte(FwFlipbookId id, const char* name, book::Kind kind);
    components::EmitterBooks emitterBooks(const FwFireEmitterDef& def);
    void countBookUsers(const FwFireEmitterDef& def, int by) noexcept;
    uint32_t emitterRoom(uint32_t particles);
    void layGround(gpu::SparkSource& source) const noexcept;
    void planEmitters(float seconds) noexcept;
    void commitEmitters(float seconds) noexcept;
    // fields.cpp
    void planFields(const ClockAdvance& time) noexcept;
    void planFieldDraws(const Clock& now) noexcept;
    void commitFields(uint64_t end) noexcept;
    void takeFields(const gpu::Readback& readback) noexcept;
    [[nodiscard]] field::FieldRules rulesOf(const components::ParticleField& field) const noexcept;
    void sendFieldRules() noexcept;
    // jets.cpp
    float sweepJet(const float start[3], const float way[3], float most, components::JetHit& hit,
                   const components::JetGate* passed = nullptr) noexcept;
    uint32_t gateTicks(const components::JetHit& hit, uint32_t tick) noexcept;
    bool stands(const components::JetHit& hit, uint32_t holeTicks, uint32_t tick) noexcept;
    void listJetTargets(const float from[3], float reach) noexcept;
    void sweepJets(components::FireEmitter& emitter) noexcept;
    void shieldJet(components::FireEmitter& emitter, double now) noexcept;
    void touchByJet(components::FireEmitter& emitter, uint32_t now);
    void forgetGates(uint32_t slot) noexcept;  // of an object that goes
    void passHole(const components::FireEmitter& emitter, components::JetHit& hit) noexcept;
    void launchJet(const components::FireEmitter& emitter, components::JetParcel& parcel,
                   uint32_t now) const noexcept;
    void flyJet(components::FireEmitter& emitter, components::JetParcel& parcel, uint32_t now);
    bool flyRay(components::FireEmitter& emitter, const components::JetParcel& parcel,
                components::JetRay& ray, uint32_t from, uint32_t to, uint32_t now, bool& listed);
    void heatByJet(components::FireEmitter& emitter, const components::JetParcel& parcel,
                   const components::JetRay& ray, const components::JetHit& hit,
                   const components::JetGate& gate, uint32_t tick, uint64_t brought);
    bool heatFootprint(Object& object, const components::JetHit& hit, float radius, uint64_t power,
                       uint32_t tick, size_t most, const PendingTexel& like, uint64_t& left);
    uint64_t stickFuel(components::FireEmitter& emitter, const components::JetHit& hit,
                       uint64_t fuel) noexcept;
    void settlePatches(components::FireEmitter& emitter, uint32_t first) noexcept;
    void burnPatches(components::FireEmitter& emitter, uint32_t now);
    void wetPatches(const Object& object, const FwIgnitionDef& def, uint32_t grams,
                    uint32_t tick) noexcept;
    void heatLite(components::FireEmitter& emitter, Object& object, const components::JetHit& hit,
                  float radius, float flux, uint32_t now);
    void probeJets(ProbeFrame& known);
    void planGates(std::span<const Frame::Due> due, size_t firstEvent);
    void findFootprint(const Object& object, const components::JetHit& hit, float radius);
    // fire_colliders.cpp
    void listFireColliders() noexcept;
    // Of those that are listed what is a body to all, not to flames alone.
    [[nodiscard]] std::span<const volume::Collider> walls() const noexcept {
        return std::span(fireShapes_).subspan(firePictures_);
    }
    // fire_touch.cpp
    void touchByFires(uint64_t end);  // events up to a tick
    void touchByFire(Fire& fire, uint32_t now);
    void forgetTouches(FwBurnableMeshId id) noexcept;  // of an object that goes
    // field_touch.cpp
    void stepCells(Field& field, uint64_t tick) noexcept;
    void touchByField(Field& field, uint32_t now);
    // played.cpp
    void playBurnAt(FwBurnableMeshId id, FwBurnId burn, uint32_t tick, float speed);
    void reservePlays(size_t more);
    void startPlay(Object& object) noexcept;
    void endPlay(Object& object, uint64_t frameIndex, uint32_t tick) noexcept;
    size_t beginPlays(uint64_t end);
    void planPlays(uint32_t now, std::span<const Frame::Due> due);
    void turnPlay(const Object& object) noexcept;
    void settlePlays(Snapshot& snapshot);  // of a save: throws where this world has other burns
    void commitPlays(uint64_t frameIndex) noexcept;
    // latch.cpp
    void planLatches(uint32_t now, size_t firstEvent, bool placed);
    // wind.cpp
    [[nodiscard]] fire::WindVector windAt(const components::WindPlace& place,
                                          uint64_t tick) const noexcept;
    [[nodiscard]] std::array<float, 3> windAt(const float place[3], uint64_t tick) const noexcept;
    // m/s, as if there were no gusts.
    [[nodiscard]] std::array<float, 3> steadyWindAt(const float place[3]) const noexcept;
    [[nodiscard]] Winds winds() const noexcept;
    [[nodiscard]] bool evenWind() const noexcept;
    [[nodiscard]] bool gusty() const noexcept { return gusts_.strength != 0; }
    [[nodiscard]] static components::WindPlace windPlaceOf(const components::Pose& pose,
                                                           const mesh::BurnDomain& domain) noexcept;
    [[nodiscard]] components::DriveInput driveInput(const Object& object,
                                                    uint64_t tick) const noexcept;
    [[nodiscard]] uint32_t zoneWindOf(const Object& object, uint64_t tick) const noexcept;
    void listWindZones() noexcept;
    components::ShieldObject shieldObjectOf(uint32_t slot) noexcept;
    void bakeHeatShield(const components::ShieldShape& shape, std::pmr::vector<uint32_t>& slots,
                        std::pmr::vector<components::ShieldCell>& baked);
    void recordShield(const components::HeatShield& made, std::span<const uint32_t> slots) noexcept;
    void applyShield(const SetHeatShield& command);
    void applyShieldCells(const SetShieldCells& command);
    void applyShieldObject(const AddShieldObject& command);
    void adoptShield(components::HeatShield& made) noexcept;  // takes its cells
    void shieldChanged() noexcept;
    void dropFromShield(uint32_t slot) noexcept;
    void packHeatShield();
    components::ShieldView shieldView();
    void planShield(gpu::StepPlan& step, bool awake);
    void applyWindGrid(const SetWindGrid& command);
    void applyWindPoints(const SetWindPoints& command);
    void applyGusts(const SetGusts& command);
    void windTurns() noexcept;
    void zoneTurns(const components::WindZone& zone) noexcept;
    void settleWind() noexcept;
    void takeZoneWind(Object& object) noexcept;
    // rooms.cpp
    [[nodiscard]] bool roomsRest(uint64_t stirred) const noexcept;
    void stirRooms() noexcept;
    [[nodiscard]] uint32_t roomOf(const Object& object) const noexcept;
    void roomTurns(const components::Room& room) noexcept;
    void sendRoom(uint32_t slot) noexcept;
    void fillRoom(RoomEntry& entry, uint32_t oxygen, uint32_t power = 0,
                  uint32_t flash = 0) noexcept;
    void takeRooms(const gpu::Readback& readback) noexcept;
    // remote.cpp
    [[nodiscard]] bool remoteOn() const noexcept {
        return remote_.flags != 0 || remote_.governed || clock_.tick < remote_.fades;
    }
    void planRemote(gpu::StepPlan& step, uint32_t now, bool awake);
    void latchRemote(uint32_t now);
    void takeRemoteWind(Object& object, int wind) noexcept;
    void markUnsent(Object& object) noexcept;  // its record
    void rebuildRemote();
    void keepPlanned();
    void askVisibility();
    uint32_t seenPart(const Object& from, const Object& to) const;
    void findLinks(uint32_t now);
    void linkClose(Object& object, uint32_t now);
    void addClose(uint32_t slot, uint32_t other, uint32_t pair);
    uint32_t closePair(uint32_t a, uint32_t b);
    void dropPair(uint32_t pair) noexcept;
    void dropLinks(uint32_t to, uint32_t from) noexcept;
    void addLinks(uint32_t to, std::span<gpu::ContactLink> fresh);
    void forgetRemote(const Object& object) noexcept;  // it is destroyed
    gpu::ExchangePush exchangeRules() const noexcept;
    void touchNear(uint32_t now);
    void addLatch(Object& object, const components::Latch& latch, bool due) noexcept;
    void linkPair(const Object& to, const Object& from, std::span<const mesh::Contact> contacts,
                  uint32_t since, std::pmr::vector<gpu::ContactLink>& out);
    void commitRemote() noexcept;
    void countGoverned(const Object& object, bool more) noexcept;
    void noteSeen(std::pmr::vector<Seen>& to) const;
    void seeAsLoaded();
    void tellSpread(Object& object, const gpu::Readback& readback) noexcept;
    // events.cpp
    void collectReadbacks();  // throws std::bad_alloc; the readback then stays with the backend
    void takeCounters(const gpu::Readback& readback) noexcept;
    void reserveStimuli();
    Stimulus& stimulusOf(Object& object, uint64_t frameIndex) noexcept;
    void noteIgnition(Object& object, Stimulus& stimulus, uint32_t texel, uint32_t tick) noexcept;
    void commitStimuli(const ClockAdvance& time, uint64_t frameIndex) noexcept;
    void takeStimuli(uint64_t frameIndex) noexcept;
    // As of the last readback, or by what came since.
    [[nodiscard]] static bool isActive(const Object& object) noexcept {
        return object.story.active || object.stimuli > 0;
    }
    [[nodiscard]] bool needsRecords(const Object& object, uint32_t now) const noexcept;
    void takeEnergy(Object& object, uint32_t endTick) noexcept;
    void countFlames(Object& object, const gpu::ObjectCounters& before, uint32_t endTick) noexcept;
    void takeBurnt(Object& object, uint32_t endTick) noexcept;
    void takeAnswers(const gpu::Readback& readback) noexcept;
    void takeLights(const gpu::Readback& readback) noexcept;
    void showSavedLights() noexcept;  // after a load, until a readback comes
    void followLights(float seconds);
    components::SurroundingAir listSources();
    components::Surroundings surroundingsAt(const components::SurroundingAir& air,
                                            components::vec3 point) const noexcept;
    void raise(uint32_t type, const Object* object, uint32_t tag, uint64_t frameIndex,
               const float position[3], float value, FwBurnableMeshId other = {}) noexcept;
    // carry.cpp
    void waitForCarries() noexcept;
    void continueBurn(Object& to, const Story& from) noexcept;
    void keepGiven(const Object& from);                      // before it is destroyed; throws
    [[nodiscard]] bool gives(uint32_t slot) const noexcept;  // its burn is about to be carried
    void checkCarry(const PendingTexel& event, const Clock& clock);  // of a save; throws
    void settlePending() noexcept;                                   // after a load
    // arrivals.cpp
    [[nodiscard]] uint64_t changesOf(const Object& object) const noexcept {
        return object.changes + driveChanges_;
    }
    void wishForecasts() noexcept;
    void takeForecast(Object& object, const gpu::BurnMap& map,
                      const gpu::Readback& readback) noexcept;
    void runForecasts() noexcept;
    // breaks.cpp
    core::Owned<Breaks> makeBreaks(const FwBurnableMeshDef& def, MeshEntry& entry,
                                   std::span<const uint8_t> gone);
    [[nodiscard]] const mesh::Pieces& piecesOf(const Object& object) noexcept;  // it has breaks
    void planBreaks(uint64_t end) noexcept;
    void commitBreaks(uint64_t frameIndex) noexcept;
    void markBearers(const Object& object) noexcept;
    void findBreaks(Object& object, std::span<const uint32_t> ticks,
                    std::span<const gpu::uvec2> heat, uint32_t now, const uint64_t* tells) noexcept;
    void takeBreaks(Object& object, const gpu::BurnMap& map,
                    const gpu::Readback& readback) noexcept;
    void restoreBreaks(Object& object, const BreakState* saved, const ImageStore& store,
                       uint32_t now) noexcept;
    // save.cpp
    [[nodiscard]] uint64_t meshHash(const Object& object) noexcept;
    [[nodiscard]] uint64_t assetOf(const Object& object) noexcept;
    [[nodiscard]] uint32_t windowOf(const Object& object) noexcept;
    void planSave();
    void commitSave(uint64_t frameIndex) noexcept;
    void takeSaves(const gpu::Readback& readback) noexcept;
    [[nodiscard]] uint32_t unsavable() noexcept;  // a burning object's slot + 1; 0: there is none
    // timeline.cpp
    void planTimeline(uint64_t after) noexcept;
    void commitTimeline(uint64_t before) noexcept;
    void keepKeyframe() noexcept;
    void recordInTimeline(const Command& command) noexcept;
    void capture(Snapshot& to);
    void captureObject(Object& object, ObjectSnapshot& to) noexcept;
    void takeSave(Save& save, const gpu::Readback& readback);
    void captureEvents(Save& save);
    static void forgetTag(Save& save, const Tag& tag, uint64_t frameIndex) noexcept;
    // recording.cpp
    void mayChange() const;  // throws where another machine's commands alone count
    [[nodiscard]] bool records() const noexcept { return recording_ || commandLog_ || timeline_; }
    void record(const Command& command) noexcept;
    void recordTexels(size_t first) noexcept;
    void checkCommandTick(uint32_t tick) const;
    void igniteTexels(const IgniteTexels& command);
    void igniteObjects(const IgniteObjects& command);
    void addChange(Object& object, const TexelChange& change, std::span<const uint32_t> texels);
    void planHashes(const ClockAdvance& time);
    void recordSave() noexcept;
    void recordHash(const gpu::BurnMap& map, const gpu::Readback& readback);
    class SnapshotChecker;
    // Throws unless the snapshot fits this world, whose ids it then has.
    void checkSnapshot(Snapshot& snapshot);
    // Its latch, too, as it was.
    BurnRecords recordsOf(const Snapshot& snapshot, const ObjectSnapshot& from,
                          components::Latch& latch);
    bool readObject(std::span<const std::byte> save, uint32_t slot, Snapshot& snapshot,
                    ImageStore& store);
    void apply(const Snapshot& snapshot, std::span<const components::Latch> latches) noexcept;
    void applyObject(const ObjectSnapshot& from, const components::Latch& latch,
                     Object& object) noexcept;
    // queries.cpp
    Query makeQuery(FwBurnableMeshId id, const float position[3]);
    Query& openQuery(FwQueryId id, bool isArrival);
    FwPointState pointState(const Object& object, uint32_t texel, const gpu::ProbeAnswer& answer,
                            const gpu::Readback& readback) const noexcept;
    void texelPosition(const Object& object, uint32_t texel, float (&out)[3]) const noexcept;
    // Where a texel is, m, object space: at rest, or on the vertices that the host moved.
    void texelPlace(const Object& object, uint32_t texel, float (&out)[3]) const noexcept;
    // Nearest texel within `reach` m of a point in object space, or kNone.
    uint32_t nearestTexel(const Object& object, const float point[3], float reach) const noexcept;
    // The same, at no cost for what is far away.
    uint32_t nearTexel(const Object& object, const float point[3], float reach) const noexcept;
    uint32_t texelMaterial(const Object& object, uint32_t texel) const noexcept;
    [[nodiscard]] const mesh::BurnDomain& domainOf(const Object& object) const noexcept;
    // world.cpp
    // As components::makeGone. Stands until the mesh's next object with other pictures is made.
    std::span<const uint8_t> goneOf(const FwBurnableMeshDef& def, MeshEntry& mesh);
    FwBurnableMeshId createOn(uint32_t meshSlot, const FwBurnableMeshDef& def,
                              core::Owned<Object> owned);
    [[nodiscard]] bool canBurn(const Object& object, uint32_t texel) const noexcept;
    uint32_t igniteObject(Object& object, const FwIgnitionDef& def, uint32_t tick);
    void findPendingRoom(size_t more);  // throws
    // Boxes of objects as their poses are now, for what asks who is somewhere.
    void placeNow(const Object& object);  // throws std::bad_alloc
    // Slots of the objects that come within `margin` m of a box, in order; until the next call.
    std::span<const uint32_t> objectsNear(const mesh::Box& box, float margin) noexcept;
    std::span<const uint32_t> objectsNear(const float point[3], float margin) noexcept;
    void addPending(Object& object, uint32_t kind, uint32_t tick, uint32_t water,
                    std::span<const uint32_t> texels);
    uint32_t igniteAt(const FwIgnitionDef& def, uint32_t tick);
    [[nodiscard]] bool lightsSomething(size_t first) const noexcept;
    uint32_t eventTick(float delay) const;
    MeshEntry makeEntry(core::Owned<mesh::BurnDomain> domain) const;
    FwMeshId createEntry(MeshEntry entry);
    // Slot of the mesh in this shape: itself, one that is there, or a new one.
    uint32_t shapedSlot(uint32_t slot, const float shape[3]);
    void releaseShape(uint32_t slot) noexcept;
    void countImages(const components::BurnableMesh& object, bool more) noexcept;
    void countFuel(const Object& object, bool more) noexcept;
    bool innerSkin(MeshEntry& mesh, uint32_t slot, const components::BurnableMesh& object);
    void refineMesh(MeshEntry& mesh, uint32_t slot, const FwBurnableMeshDef& def,
                    const components::BurnableMesh& object);
    mesh::ArpSettings arpSettings(const FwBurnableMeshDef& def, const mesh::ArpModel& model,
                                  const components::BurnableMesh& object) const;
    void sendPose(const Object& object) noexcept;

    std::pmr::memory_resource* memory_;
    gpu::Backend& backend_;
    const core::Log& log_;
    FwWorldDef def_;
    float wind_[3] = {};     // m/s, world
    double origin_[3] = {};  // m that all places moved since the world's beginning
    struct Shift {
        uint64_t frame = 0;  // the last one before it
        double by[3] = {};   // m
    };
    std::array<Shift, 8> shifts_{};  // of which readbacks are still on their way, oldest first
    uint32_t shiftCount_ = 0;
    uint64_t carriesUntil_ = 0;  // tick: until then burns are carried
    uint64_t wetUntil_ = 0;      // tick: from then on no FW_WET event waits
    FrameCost budget_, spent_;   // gpu: as of the last readback
    Governor governor_;
    bool budgetMeasured_ = false;  // the host tells spent_.gpu

    void countMemory() noexcept;

    // Bytes, for memoryRows, which any thread may call.
    struct MemoryCounts {
        std::atomic<uint64_t> objects{0}, frames{0}, neighbours{0}, contacts{0};
    };
    MemoryCounts memoryCounts_;
    core::HandlePool<FwMaterialId, FwMaterialDef> materials_;
    core::HandlePool<FwImageId, ImageEntry> images_;
    core::HandlePool<FwMeshId, MeshEntry> meshes_;
    core::HandlePool<FwBurnableMeshId, core::Owned<Object>> objects_;
    core::HandlePool<FwQueryId, Query> queries_;
    core::HandlePool<FwBlockerId, BlockerEntry> blockers_;
    core::HandlePool<FwWindZoneId, components::WindZone> windPool_;
    core::HandlePool<FwBurnId, core::Owned<Burn>> burns_;
    std::pmr::vector<components::WindZone> windZones_;  // in the order in which they count
    components::WindGrid windGrid_;
    ShieldBook shield_;
    components::Gusts gusts_;
    bool windDue_ = false;     // what objects keep of the wind is to be found anew
    bool windKept_ = false;    // some may keep another than the world's own
    uint64_t gustsShown_ = 0;  // tick of the gusts that objects keep
    core::HandlePool<FwRoomId, RoomEntry> rooms_;
    uint32_t roomEpoch_ = 0;     // of their airs' beginnings, the last one
    bool roomsMet_ = false;      // some were there: objects may still know their air
    uint64_t roomsStirred_ = 0;  // tick at which something of their airs may have changed last
    core::HandlePool<FwVolumetricFireId, core::Owned<Fire>> fires_;
    core::HandlePool<FwParticleFieldId, core::Owned<Field>> fields_;
    core::HandlePool<FwFireProfileId, FireProfileEntry> fireProfiles_;
    core::HandlePool<FwFlipbookId, FlipbookEntry> flipbooks_;
    FwFlipbookId flameBooks_[2] = {};  // of burning meshes' flames: fire's, smoke's
    core::HandlePool<FwFireColliderId, core::Owned<FireColliderEntry>> fireColliders_;
    std::pmr::vector<core::Owned<volume::Profile>> profiles_;  // by layer; null: none needed it
    // Of a frame: pictures of depth, which flames alone heed, colliders, blockers.
    std::pmr::vector<volume::Collider> fireShapes_;
    uint32_t firePictures_ = 0;
    components::FireFlames burning_;
    std::pmr::vector<gpu::VolumeFlame> fireFlames_;  // room for a frame's flames
    uint32_t flamesShown_ = 0;                       // that the backend draws
    uint32_t firesMade_ = 0;                         // since ever
    core::HandlePool<FwFireEmitterId, components::FireEmitter> emitters_;
    // Of a frame; room for all of it is found with each emitter.
    std::pmr::vector<gpu::ParticleEmitter> emitterRecords_;
    std::pmr::vector<gpu::uvec2> emitterGroups_;
    std::pmr::vector<std::pair<uint32_t, uint32_t>> emitterRings_;  // scratch: first, ring
    uint32_t emittersMade_ = 0;                                     // since ever
    double emitterTime_ = 0;                                        // s
    std::pmr::vector<gpu::SparkSource> sparkSources_;               // of a frame
    bool emittersShown_ = false;                                    // the backend has some
    uint32_t fieldsMade_ = 0;                                       // since ever
    uint32_t fieldsShown_ = 0;                                      // that the backend draws
    RemoteBook remote_;
    BoxGrid places_;                         // of all objects, as their poses are now
    std::pmr::vector<uint32_t> nearSlots_;   // scratch of objectsNear
    std::pmr::vector<uint32_t> imageUsers_;  // by backend slot: objects + 1 for a live id; 0: free
    std::pmr::vector<Object*> touched_;      // in slot order: idle objects cost a frame nothing
    std::pmr::vector<Object*> playing_;      // baked burns, in slot order
    std::pmr::vector<std::byte> burnBytes_;  // of the last fetchBurn
    uint32_t shapes_ = 0;                    // entries of meshes_ that are shapes
    uint64_t texels_ = 0;                    // of all objects, that can burn
    uint64_t fuel_ = 0;                      // of all objects when they were made
    uint32_t ledgers_ = 0;                   // objects that keep account of theirs
    uint32_t mapsWished_ = 0;                // wishes for objects' states that are still to be sent
    uint64_t driveChanges_ = 0;              // of the wind
    std::pmr::vector<uint32_t> forecasts_;   // slots of objects that were asked when fire arrives
    size_t nextForecast_ = 0;                // of those, whose turn it is
    std::pmr::vector<Tag> tags_;
    std::pmr::vector<PendingTexel> pending_;
    std::pmr::vector<uint32_t> found_;  // scratch of ball queries
    mesh::HoldScratch holds_;           // room for the largest that asks what breaks
    // Scratch of a jet's ray: of the texels found, 1e-9 m^2 and W/m^2.
    std::pmr::vector<uint64_t> jetAreas_;
    std::pmr::vector<uint32_t> jetFlux_;
    std::pmr::vector<uint32_t> jetSlots_;  // objects that a jet may meet
    uint64_t geometry_ = 1;                // grows whenever what may stop a jet moves
    uint64_t sweeps_ = 0;  // frames begun: what was swept in one is not swept again in it
    EventQueue events_;
    std::pmr::vector<ProbeFrame> probeFrames_;
    Frame frame_;

    Clock clock_;
    uint64_t steps_ = 0, droppedSteps_ = 0, order_ = 0;
    uint64_t lastFrame_ = 0;
    uint64_t frames_ = 0;
    uint64_t lastStimulus_ = 0;  // tick
    bool idle_ = true;
    std::pmr::vector<Stimulus> stimuli_;  // of frames whose readback is on its way
    std::pmr::vector<FrameNote> frameNotes_;
    // The same as of the last readback.
    uint64_t seenStimulus_ = 0;
    bool seenIdle_ = true;
    uint64_t seenRoomsStirred_ = 0;
    uint32_t switches_ = 0;
    uint64_t planStamp_ = 0;
    std::array<core::Owned<Save>, size_t(SaveFor::count)> saves_;  // once one was asked for
    core::Owned<Recording> recording_;                             // null: nobody asks
    core::Owned<CommandLog> commandLog_, playedLog_;               // null: none
    core::Owned<Timeline> timeline_;                               // null: none is kept
    uint64_t loadedFrame_ = 0;     // readbacks up to this frame are of another past
    uint64_t loadedTick_ = ~0ull;  // of the save that was loaded last

    // As of the last readback.
    uint64_t readbackFrame_ = 0, readbackTick_ = 0;
    uint32_t frontTiles_ = 0, runTiles_ = 0, burningTiles_ = 0, lateClamps_ = 0;
    uint32_t hotTiles_ = 0;
    uint32_t receivers_ = 0;
    uint32_t loadedReceivers_ = 0, loadedBurning_ = 0;  // of a save; until the next count
    uint32_t loadedFront_ = 0, loadedHot_ = 0;  // of what was gone by then; until the next walk
    std::pmr::vector<FwLight> lights_, lightsBefore_;  // of burning meshes
    uint32_t nextLight_ = 1;
    bool lightsDue_ = false;                  // a load: the next that come show at once
    std::pmr::vector<FwLight> shownLights_;   // those, smooth from frame to frame
    std::pmr::vector<uint32_t> keptLights_;   // ids of those that the last frame chose
    std::pmr::vector<FwLight> lightSources_;  // scratch
    std::pmr::vector<uint8_t> lightTaken_;
    std::pmr::vector<components::FireSource> sources_;  // of the last question
};

}  // namespace fw::world
