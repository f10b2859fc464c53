// The interface between the world and the burn simulation. Two backends implement it: vk records
// into a command buffer; cpu computes the same integers at once, without a device. Plain data goes
// in, readbacks come out.
#pragma once
#include "mesh/deform/model.h"
#include "mesh/refine/model.h"
#include "shared/burn.h"
#include "shared/exchange.h"
#include "shared/field.h"
#include "shared/room.h"

#include <cmath>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace fw::gpu {

struct HeatBoundary {  // by which an extension refines. See FwBurnableMeshDef
    float psi = 0;     // 1/m^2, 0: by the size of the triangles
    float step = 0;    // m, 0: by `speed`
    float speed = 0;   // m/s, object space, of the fire's head
};

struct ObjectInit {
    uint32_t mesh = 0;                        // slot
    BurnObject record;                        // bases are the backend's to fill
    std::span<const BurnMaterial> materials;  // kMaterialsPerObject
    // Per texel Q7, 0 = cannot burn; empty: the mesh's own with nothing painted. Width of the map.
    std::span<const uint16_t> slowness;
    uint32_t images[kMaterialsPerObject] = {};  // base-colour image slot + 1, 0: none
    bool refine = false;  // createRefinement was called for its mesh and this depth
    bool inner = false;   // createInnerSkin was: from inside it is drawn there
    uint32_t refineDepth = 0;
    float refinePixelsPerEdge = 8;
    bool refineExtended = false;         // by an extension
    HeatBoundary boundary;               // then
    std::span<const HeatMaterial> heat;  // kMaterialsPerObject; empty: no heat per texel
    // For objects that deform; the model outlives the mesh. The backend fills the bases.
    const mesh::DeformModel* deformModel = nullptr;
    const DeformObject* deform = nullptr;
    float shape[3] = {1, 1, 1};  // by which the mesh was stretched since the host gave it
};

struct MaterialUpdate {  // new records of one object at a step's start (a wind or pose latch)
    uint32_t object = 0;
    BurnMaterial materials[kMaterialsPerObject];
    uint32_t window = 0;  // correction window, ticks
    uint32_t substepShift = 0;
};

// Places of objects for the exchange, from a step's start on. The exchange knows an object from its
// first update on.
struct ExchangeUpdate {
    struct Placed {
        uint32_t object = 0;
        ExchangeObject record;  // sources are the backend's to fill
    };
    struct Range {
        uint32_t first = 0, count = 0;
    };
    std::span<const Placed> objects;  // that changed
    // All lists in one array: slot | visible share, of 255, << 24.
    std::span<const uint32_t> neighbours;
    std::span<const Range> neighbourRanges;  // of it, that changed
    // Likewise. The links of one (object, texel) are side by side; kNoneTexel: of no object.
    std::span<const ContactLink> links;
    std::span<const Range> linkRanges;
    std::span<const HeatOccluder> occluders;  // all of them, at most kMaxHeatOccluders
};

// The whole heat-occlusion grid, in place of the last one. See exchange.h.
struct OcclusionUpdate {
    ivec3 origin{};                 // mm
    uint32_t cell = 0, counts = 0;  // as ExchangePush has them; cell 0: there is none
    std::span<const uint32_t> words;
};
inline void setOcclusionPush(const OcclusionUpdate& grid, ExchangePush& rules) noexcept {
    rules.occlusionX = grid.origin.x;
    rules.occlusionY = grid.origin.y;
    rules.occlusionZ = grid.origin.z;
    rules.occlusionCell = grid.cell;
    rules.occlusionCounts = grid.counts;
}

struct StepPlan {               // one fixed step of 1/32 s
    uint32_t now = 0;           // tick at its start
    uint32_t substepShift = 0;  // log2 of its iterations: the largest of the objects that burn
    bool reduce = false;        // also count burning texels and rebuild BurnTiles
    bool heat = false;          // also a heat step: kHeatSteps steps at once, at its start
    bool rooms = false;         // with `heat`, before it: some room is there, or was
    bool exchange = false;      // with `reduce`: heat between objects, and the burn budget
    bool governed = false;      // some object or the world limits its fire
    bool capped = false;        // and how many tiles may burn
    bool plays = false;         // some object may play a baked burn
    ExchangePush rules{};       // of the exchange; the backend fills the parts about lists
    const ExchangeUpdate* exchangeUpdate = nullptr;  // null: nothing changed
    const OcclusionUpdate* occlusionUpdate =
        nullptr;                         // null: as it was; none at first, and after `restore`
    std::span<const TexelEvent> events;  // sorted by (object, texel, order)
    std::span<const MaterialUpdate> materials;  // applied first; each object's tiles wake
};

struct Probe {
    uint32_t object = 0, texel = 0;
};

struct VolumeFlame;    // shared/volume.h
struct FlameBody;      // shared/body.h
struct VolumeUpdate {  // the volumetric flames that draws show from this frame on; cosmetic
    const VolumeFlame* flames = nullptr;  // their bounds are in the records
    uint32_t count = 0;                   // at most kMaxVolumeFlames
    // The last of the flames are the fires of burning objects: bodies, without nodes.
    const FlameBody* bodies = nullptr;
    uint32_t bodyCount = 0;  // at most kMaxBodies
};

struct ParticleEmitter;  // shared/particle.h
struct SparkSource;      // shared/spark.h
struct EmitterUpdate {   // fire emitters in this frame; cosmetic
    const ParticleEmitter* records = nullptr;
    uint32_t count = 0;
    std::span<const uvec2> groups;        // record, first of kParticleGroup slots of its ring
    uint32_t particleEnd = 0;             // behind the last particle of any of them
    uint32_t particles = 0;               // of all rings that may show particles that occlude
    uint32_t lightParticles = 0;          // of rings that may show particles that only emit
    const SparkSource* sparks = nullptr;  // emitters that throw some
    uint32_t sparkCount = 0;
    uint32_t sparkQuads = 0;  // of all of those, at most
};
struct FieldRun {                  // a step of a particle field
    uint32_t field = 0, step = 0;  // slot; its number, from 0
};
struct FieldDraw;  // shared/field.h
struct FieldUpdate {
    std::span<const FieldRun> runs;    // round by round; in one a field is once at most
    std::span<const uint32_t> rounds;  // where each ends
    // Of the fields that are shown; the backend fills where their cells are. Cosmetic.
    const FieldDraw* draws = nullptr;
    std::span<const uint32_t> drawn;  // their slots
};

// Everything that decides an object's future. The rest of its state follows from it, or steps bring
// it back.
struct ObjectImage {
    uint32_t object = 0;
    std::span<const uint32_t> ticks;  // codes, by texel
    std::span<const uvec2> heat;      // packed HeatTexel; empty: none
    // By tile: the bits kTileKept of the flag, and lastChange. The rest is ignored.
    std::span<const TileState> tiles;
    std::span<const TileHeat> tileHeat;
    ObjectCounters counters;
};
constexpr uint32_t kTileKept = kTileListed | kTileBurning | kTileHot | kTileWarm;

struct RestoredObject {
    ObjectImage image;
    BurnMaterial materials[kMaterialsPerObject];
    uint32_t window = 0, substepShift = 0;
    bool sleeps = false;  // no part of it burnt: its image has counters alone
};

// The cosmetic detail that a frame may have. It does not decide what burns: burn hashes are equal
// at all levels.
struct Detail {
    uint32_t marchedHigh = 16;   // volumetric flames at most, with many samples a ray
    uint32_t marched = 32;       // and in all; the others are impostors
    uint32_t rayStepCount = 64;  // samples of a ray at most; see FwWorldDef
    float triangles = 1;         // share of FwWorldDef::maxRefinedTriangles
    float quads = 1;  // share of flames' quads and particles that show; the fewer, the larger
    // Share of FwWorldDef::maxLights: the fewer there are, the more fires each stands for.
    float lights = 1;
    float memory = 1;  // share of what marched flames and quads have otherwise; 1: it never shrinks

    [[nodiscard]] bool operator==(const Detail&) const = default;
};
// The number of lights, of `most`.
[[nodiscard]] inline uint32_t lightsOf(const Detail& detail, uint32_t most) noexcept {
    return uint32_t(std::ceil(double(detail.lights) * double(most)));
}

struct FramePlan {
    uint64_t frameIndex = 0;
    std::span<const StepPlan> steps;
    std::span<const Probe> probes;            // answered in this frame's readback, in order
    std::span<const uint32_t> burnMaps;       // object slots whose whole state is read back
    std::span<const uint32_t> images;         // object slots that are read back as ObjectImages
    uint32_t switches = 0;                    // FwDebugSwitch
    uint32_t endTick = 0;                     // tick after the last step
    float wind[3] = {};                       // m/s, world; cosmetic
    float tickFraction = 0;                   // into the running step, [0, 1); cosmetic
    const VolumeUpdate* volumes = nullptr;    // null: as before
    const EmitterUpdate* emitters = nullptr;  // null: none, or no time passes for them
    const FieldUpdate* fields = nullptr;      // null: none steps
    Detail detail;                            // cosmetic
};

struct Readback {  // valid until the next call of nextReadback
    uint64_t frameIndex = 0;
    uint32_t endTick = 0;
    std::span<const ObjectCounters> objects;  // by object slot
    std::span<const ProbeAnswer> answers;     // of the probes of that frame
    std::span<const ObjectImage> burnMaps;    // without tiles and counters
    std::span<const ObjectImage> images;
    std::span<const BurnLight> lights;
    std::span<const FieldCounters> fields;  // by slot; those of its rows are the backend's
    std::span<const RoomAir> rooms;         // by slot; empty: no step ever had any
    uint32_t frontTiles = 0;                // length of the front list: 0 and no events = idle
    uint32_t runTiles = 0;                  // tiles run in the frame
    uint32_t burningTiles = 0;
    uint32_t hotTiles = 0;    // length of the hot list
    uint32_t receivers = 0;   // objects that others may warm
    float milliseconds = -1;  // of the frame's passes on the device; < 0: not known
};

struct PassTime {
    char name[32] = {};
    double milliseconds = 0;
    uint64_t frameIndex = 0;
    uint32_t count = 0;
};

struct MemoryRow {
    const char* name = "";
    uint64_t bytes = 0, capacity = 0;
};

class Backend {
 public:
    virtual ~Backend() = default;

    // Creation: unchanged when they throw (core::Error, std::bad_alloc). Slots are the caller's
    // numbers, dense from 0. A domain outlives its mesh.
    virtual void createMesh(uint32_t slot, const mesh::BurnDomain& domain) = 0;
    virtual void destroyMesh(uint32_t slot) noexcept = 0;
    // How a mesh is baked for an extension's refinement.
    [[nodiscard]] virtual mesh::RefineOptions extendedRefineOptions(uint32_t /*depth*/) const {
        return {};
    }
    // The data that objects of the mesh share if they refine down to `depth`, by an extension or by
    // the library; once for each. Cosmetic.
    virtual void createRefinement(uint32_t /*mesh*/, uint32_t /*depth*/, bool /*extended*/,
                                  const mesh::BurnDomain&, const mesh::RefineModel&,
                                  std::span<const mesh::RefineHoles> /*materials*/) {}
    // Places of its vertices on the inner skin, once a mesh. Cosmetic.
    virtual void createInnerSkin(uint32_t /*mesh*/, const mesh::BurnDomain&,
                                 std::span<const glm::vec3> /*places*/) {}
    virtual void createObject(uint32_t slot, const ObjectInit& init) = 0;
    virtual void destroyObject(uint32_t slot) noexcept = 0;
    // The wind that zones add at an object, packed (shared/burn.h). Cosmetic.
    virtual void setObjectWind(uint32_t /*slot*/, uint32_t /*wind*/) {}
    // Pose, tint and flags; the rest of the record stays.
    virtual void setObjectPose(uint32_t slot, const vec4 rows[3], const vec4& tint,
                               uint32_t flags) = 0;
    // The heat boundary of an object with refineExtended begins at a point (m, object space), once.
    virtual void startBoundary(uint32_t /*slot*/, const float /*point*/[3],
                               uint32_t /*tick*/) noexcept {}
    // For an object with kObjectSkinned: the host's vertices from the next frame on, m, object
    // space, 3 each; normals 3 each or none. Never throws, needs no memory. Cosmetic.
    virtual void setVertices(uint32_t slot, std::span<const float> positions,
                             std::span<const float> normals) noexcept = 0;
    // RGBA8 sRGB, with alphaCutoff as FwImageDef's. The cpu backend keeps nothing.
    virtual void createImage(uint32_t slot, uint32_t width, uint32_t height,
                             std::span<const std::byte> pixels, float alphaCutoff) = 0;
    // Objects that show it fall back to their base colour. May throw, because they may need other
    // pipelines for that, and then changed nothing.
    virtual void destroyImage(uint32_t slot) = 0;
    // A fire profile of the host's, kProfileWidth x kProfileHeight pairs of halfs. Cosmetic.
    virtual void setFireProfile(uint32_t /*slot*/, std::span<const uint32_t> /*texels*/) {}
    // All flipbooks, in place of the last ones: RGBA8, and words as in shared/flipbook.h; a width
    // of 0: there are none. Unchanged when it throws. Cosmetic.
    virtual void setFlipbooks(uint32_t /*width*/, uint32_t /*height*/,
                              std::span<const std::byte> /*texels*/,
                              std::span<const uint32_t> /*words*/) {}
    // Flipbooks of burning meshes' flames, from the next frame on: byte 0 fire's + 1, byte 1
    // smoke's.
    virtual void setTileFlipbooks(uint32_t /*flipbooks*/) noexcept {}

    // All places move by whole metres. The world sends poses and exchange updates by itself.
    virtual void moveWorld(const double (&/*by*/)[3]) noexcept {}

    // From the next frame on; flags of objects name the room that they are in.
    virtual void setRoom(uint32_t slot, const Room& room) noexcept = 0;

    // Particle fields. Masks: a byte per cell, see kFieldWall. A field begins empty; a new wall
    // kills the particles there. Creation and masking: unchanged when they throw.
    virtual void createField(uint32_t /*slot*/, const FieldRules&,
                             std::span<const uint8_t> /*masks*/) {}
    virtual void destroyField(uint32_t /*slot*/) noexcept {}
    virtual void setFieldRules(uint32_t /*slot*/, const FieldRules&) noexcept {}
    virtual void setFieldMasks(uint32_t /*slot*/, std::span<const uint8_t> /*masks*/) {}
    [[nodiscard]] virtual uint64_t fieldBytes(uint32_t /*slot*/) const noexcept { return 0; }

    // Restores all objects: these from their images, the others to their unburnt state. Frames go
    // on from `tick`; readbacks of earlier frames never come. The world sends neighbours, links and
    // occluders again. Unchanged when it throws.
    virtual void restore(std::span<const RestoredObject> objects, uint32_t tick) = 0;

    // Runs (cpu) or records (vk, between its begin and end of the outside part) a frame's steps.
    virtual void run(const FramePlan& plan) = 0;
    // Oldest finished readback not yet given, or null. Never waits.
    virtual const Readback* nextReadback() = 0;

    virtual std::span<const PassTime> passTimes() = 0;
    // Memory that this world holds. [any]: also while it is stepped or recorded.
    virtual void memoryRows(std::pmr::vector<MemoryRow>& out) const = 0;
    // Bytes of device memory that follow a plan's Detail::memory.
    [[nodiscard]] virtual uint64_t detailBytes() const noexcept { return 0; }

    // Quads of flames, smoke and particles that the last view showed, as far as that is known.
    [[nodiscard]] virtual uint32_t quadsShown() const noexcept { return 0; }

    // Whether it draws: if not, cosmetic data need not be made.
    [[nodiscard]] virtual bool draws() const noexcept { return false; }
};

}  // namespace fw::gpu
