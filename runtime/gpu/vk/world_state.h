// What a VkBackend holds: the parts, the tables of meshes, objects and images, and what waits to be
// uploaded with the next frame. Internal to the backend's .cpp files.
#pragma once
#include "gpu/passes/draw.h"
#include "gpu/vk/frame.h"
#include "gpu/vk/outside_view.h"
#include "gpu/vk/recorder.h"
#include "gpu/vk/vk_backend.h"

#include "core/owned.h"
#include "core/slot_set.h"
#include "shared/deform.h"

#include <optional>

namespace fw::gpu::vk {

struct Context::State {
    State(const FwVulkanHost* host, uint64_t budget, std::pmr::memory_resource* memory,
          const core::Log& logTo)
        : device(host, logTo), deviceMemory(device, budget, memory), pipelines(device, memory) {}
    Device device;
    DeviceMemory deviceMemory;
    Pipelines pipelines;
};

struct RangeOf {  // of a pool
    uint32_t first = 0, units = 0;
};

struct PoolRange {
    RangeOf* range;
    BufferPool pool;
};

// A mesh's refinement at one depth: what its objects share.
struct RefineMesh {
    bool live = false;
    uint32_t edgeCount = 0, triangleCount = 0, cornerCount = 0, slotCount = 0;
    uint32_t fullCount = 0;  // triangles with everything at its deepest
    uint32_t openEdges = 0;
    bool solid = false;                              // it has an inside
    float edgeLength = 0;                            // m, mean of its edges
    uint32_t materialEnd[kMaterialsPerObject] = {};  // of its triangles
    RangeOf triangles, edges, slots, words, draws;
    void release(WorldBuffers& buffers) noexcept;
};

struct RefineUse {  // an object's own
    bool on = false;
    bool started = false;  // it is drawn refined: some frame placed it
    uint32_t key = 0;      // of its mesh's refinement
    float pixelsPerEdge = 8;
    uint32_t epochTick = 0;
    uint32_t quietTick = 0;      // it is refined before this; 0: no fire yet
    bool cut = false;            // near: its holes are cut
    bool perPixelHoles = false;  // its cut is too coarse for the holes: texels show them
    uint32_t inner = 0;          // as RefineObject
    bool border = false;         // walls stand along its open edges, whether it burns or not
    float nearness = 0;          // as SurfaceDraw
    float now = 0;               // s since its epoch, of the frame that last placed it
    double turnTick = 0;         // of that frame
    vec4 turnEye{};              // in it: m, object space; w: as refine.eye
    bool due = false;            // it was among the last frame's that refined
    RangeOf items, triangles, slots, indices, cuts;
    uint32_t patternPlus1 = 0;  // by the published scheme: its PatternUse
    RangeOf patternList;
    // `thick`: with an inner skin, where the mesh has an inside.
    void allocate(WorldBuffers& buffers, const RefineMesh& mesh, bool thick, uint64_t last);
    void allocatePattern(WorldBuffers& buffers, const RefineMesh& mesh, uint64_t last);
    void release(WorldBuffers& buffers) noexcept;
};

// What the published scheme keeps of an object.
struct PatternUse {
    explicit PatternUse(std::pmr::memory_resource* memory) : state(memory) {}
    const mesh::PatternModel* model = nullptr;  // null: free
    mesh::PatternSettings settings;
    mesh::PatternState state;
};

constexpr uint32_t refineKey(bool published, uint32_t depth) noexcept {
    return published ? kRefineDepth + 1 + depth : depth;
}

struct MeshEntry {
    bool live = false;
    uint32_t width = 0, height = 0, tilesX = 0, tiles = 0, vertices = 0, indices = 0;
    RangeOf meshTiles, slowness, links, readers, vertexRange, indexRange;
    uint32_t materialEnd[kMaterialsPerObject] = {};  // indices are sorted by material: ends of runs
    RefineMesh refine[2 * (kRefineDepth + 1)];       // by refineKey
    uint32_t sourceCells = 1;                        // see mesh/exchange_tiles.h
    bool parts = false;                              // some touch
    float edge = 0;       // m at scale 1: side of a square as large as two mean triangles
    float texelEdge = 0;  // texels, longest edge in the map
    const mesh::BurnDomain* domain = nullptr;
    RangeOf innerVertices;      // of the vertices on the inner skin, once an object shows it
    RangeOf nodes, embeddings;  // once an object deforms
    RangeOf skin, skinSources;  // once one is skinned
};

// How far an object's fire has come, as far as draws and predictions ask.
struct BurnLifecycle {
    bool touched = false;    // some event reached it: it may burn, or be wet
    bool doused = false;     // one of them was not fire
    bool lit = false;        // one of them was
    bool catches = false;    // scratch of run: the first that was
    bool warmed = false;     // others' fires sent heat to it
    bool charred = false;    // most of it burns or has burnt: its cold rest is not worth a draw
    bool forget = false;     // scratch of run
    uint32_t douseEnds = 0;  // tick by which the last dousing has had its effect
    uint64_t lastDouse = 0;  // ring frame that wetted or put out some of it; 0: none to forget
    uint64_t lastEvent = 0;  // tick
};

struct DeformUse {  // an object's deformation
    RangeOf range;  // of DeformObjects
    bool recordDirty = false, reset = false;
    bool now = false;         // scratch of run: it deforms in this frame
    bool woke = false;        // scratch of run: it did not move in the frame before
    bool softOdd = false;     // its places are the second ones
    uint32_t recedeTurn = 0;  // which groups of a sheet learn next what has burnt
    uint32_t ticks = 0;       // that something moves after the last texel caught
    uint64_t softUntil = 0;   // tick until which it is not yet at rest
    uint32_t skinPlus1 = 0;   // of a skinned object: its Skin
};

struct ObjectEntry {
    bool live = false;
    bool recordDirty = false, materialsDirty = false;  // to upload with the next frame
    bool resetDue = false;
    bool drawable = false;  // a recorded frame holds it
    bool inner = false;     // what faces away is drawn on the mesh's inner skin
    BurnLifecycle burn;
    uint64_t seenFrame = 0;  // ring frame whose view last showed it; kObjectUnseen: long ago
    bool turns = false;      // scratch of run: it comes into view, or leaves it
    uint32_t mesh = 0;
    BurnObject record{};
    RangeOf tiles, slowness, published, heatTiles, sources;
    RefineUse refine;
    bool publishedTouched = false;  // as-published mode: some event reached it
    uint32_t publishedParity = 0;
    DeformUse deforms;           // none if `shown` is empty
    RangeOf shown, soft;         // its shown vertices; of sheets and springs
    float shape[3] = {1, 1, 1};  // what its mesh was stretched by
    // Cold data: not read for sleeping objects, so it is stored last.
    DeformObject deform{};
    BurnMaterial materials[kMaterialsPerObject]{};
    uint32_t images[kMaterialsPerObject] = {};  // slot + 1, 0: none
    HeatMaterial heat[kMaterialsPerObject]{};   // with kObjectHeat
};

// Vertices that a host moves, as they go to the device with the next frame.
struct Skin {
    std::pmr::vector<ShownVertex> shown;  // by drawn vertex, in the device's order; empty: free
    std::pmr::vector<uint32_t> sources;   // the host's vertex of each
    bool dirty = false, normals = false;  // normals: the host's; else they follow the triangles
    // Instead of `shown`, what a buffer of the host's holds: copied by the next frame.
    FwVulkanVertices given{};
    float metersPerUnit = 1;  // of its positions
    bool givenDue = false;
    RangeOf words;  // where it is copied to
    using allocator_type = std::pmr::polymorphic_allocator<>;
    explicit Skin(const allocator_type& a) : shown(a), sources(a) {}
    Skin(Skin&&) = default;
    Skin(Skin&& other, const allocator_type& a)
        : shown(std::move(other.shown), a),
          sources(std::move(other.sources), a),
          dirty(other.dirty),
          normals(other.normals),
          given(other.given),
          givenDue(other.givenDue),
          words(other.words) {}
    Skin& operator=(Skin&&) = default;
};

struct FieldEntry {
    bool live = false;
    bool recordDirty = false, masksDue = false, fresh = false;  // for the next frame
    FieldRules rules{};
    uint32_t steps = 0;  // that it has run
    RangeOf cells;
};

struct ImageEntry {
    Image image;
    ImageSet set;
    bool live = false;
};

// Bytes for the buffers or an image, in a staging buffer of their own until the next frame.
struct PendingUpload {
    Buffer staging;
    struct Region {
        uint32_t resource = 0;
        uint64_t from = 0, at = 0, bytes = 0;
    };
    static constexpr uint32_t kMaxRegions = 10;
    Region regions[kMaxRegions];
    uint32_t regionCount = 0;
    VkImage image = VK_NULL_HANDLE;  // instead of regions
    uint32_t width = 0, height = 0, mips = 0, layers = 0;
    uint32_t firstLayer = 0;
};

// Tiles of a destroyed object: list entries may still name them. Free once every list was walked.
struct Quarantined {
    RangeOf tiles;
    uint64_t frontWalks = 0, burnWalks = 0, predictWalks = 0, hotWalks = 0;  // to be passed
};

struct ImageAt {  // an object's image in a frame's readback, bytes
    uint32_t object = 0, texels = 0, tiles = 0;
    uint64_t ticksAt = 0, heatAt = 0, tilesAt = 0, tileHeatAt = 0;
    bool heat = false;
};

struct PendingReadback {  // in the order of frames
    uint64_t ringFrame = 0;
    int32_t slot = -1;   // -1: nothing was simulated, the last figures hold
    int32_t looks = -1;  // slot of a frame that recorded looks alone, whose passes took time
    uint64_t frameIndex = 0;
    uint32_t endTick = 0;
};

// A composite's framebuffer over images that the host keeps (FW_COMPOSITE_KEEP).
struct KeptFramebuffer {
    VkFramebuffer handle = VK_NULL_HANDLE;
    FwTargetId target{};
    VkImageView color = VK_NULL_HANDLE, depth = VK_NULL_HANDLE;
    uint32_t width = 0, height = 0;
    uint64_t lastFrame = 0;  // that may use it
    bool dropped = false;    // destroyed once that frame is done
};

// Of half resolution, for targets with FW_TARGET_HALF_EFFECTS of one size and kind.
struct HalfImages {
    VkFormat format = VK_FORMAT_UNDEFINED;       // of colour
    uint32_t width = 0, height = 0, tilesY = 0;  // texels; 0: none
    Image color;  // premultiplied, encoded as its target: what is soft of a view
    Image depth;  // the host's, and below it by tile whether it shows anything
    ImageSet colorSet, depthSet;
    VkFramebuffer colorBuffer = VK_NULL_HANDLE, depthBuffer = VK_NULL_HANDLE;
    uint64_t lastFrame = 0;  // that used it
    bool fresh = true;       // depth has no layout yet
};
// What a draw draws of a view: all; or by turns what is soft, at half resolution, and the rest with
// that over it.
enum class DrawPart : uint8_t { all, half, over };

// Sets with images that a view's draws read, or null.
struct HostImages {
    VkDescriptorSet depth = VK_NULL_HANDLE;  // the host's, of half resolution where they draw there
    VkDescriptorSet color = VK_NULL_HANDLE;  // a copy of what the host's target holds
    const HalfImages* half = nullptr;        // what was drawn at half resolution
};

struct OwnDevice {  // command pool and offscreen images of the own-device mode
    VkCommandPool pool = VK_NULL_HANDLE;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;
    Image color, depth;
    Buffer pixels;
    VkRenderPass clearPass = VK_NULL_HANDLE;
    VkFramebuffer framebuffer = VK_NULL_HANDLE;
    FwTargetId target{};
    VkFormat depthFormat = VK_FORMAT_UNDEFINED;
    uint32_t width = 0, height = 0;
};

// Meshes, objects, images and rooms that the host created, and those that wait for a frame.
struct SceneTables {
    explicit SceneTables(std::pmr::memory_resource* pmr)
        : meshes(pmr),
          objects(pmr),
          awake(pmr),
          images(pmr),
          uploads(pmr),
          restores(pmr),
          restoredObjects(pmr),
          quarantine(pmr) {}
    std::pmr::vector<MeshEntry> meshes;
    std::pmr::vector<ObjectEntry> objects;
    // Objects that frames look at. The others sleep: a change or an event inserts an object here,
    // and settle lets it go.
    core::SlotSet awake;
    std::pmr::vector<ImageEntry> images;
    ImageEntry white, lookTextures, profiles;
    ImageEntry books;  // the flipbooks; not live: there are none
    std::pmr::vector<PendingUpload> uploads;
    // For the next frame: the content of restored objects, which replaces that of new ones.
    std::pmr::vector<PendingUpload> restores;
    std::pmr::vector<uint32_t> restoredObjects;
    bool restoreDue = false;
    std::pmr::vector<Quarantined> quarantine;
    uint32_t liveObjects = 0;
    uint32_t partMeshes = 0;    // of parts that touch
    bool initialized = false;   // the buffers that must start as zero do
    bool recordsDirty = false;  // some object has dirty records or a reset due
    std::array<Room, kMaxRooms> rooms{};
    bool roomsDirty = false;
    bool airs = false;  // some step had rooms
};

// Lists on the device, as the frames recorded so far leave them, and what steps carry over.
struct SimulationState {
    explicit SimulationState(std::pmr::memory_resource* pmr) : published(pmr) {}
    FrameLists lists;
    uint64_t frontWalks = 0, burnWalks = 0, predictWalks = 0, hotWalks = 0;
    uint64_t lastStimulus = 0;  // ring frame that last brought the front something new
    uint64_t seenFrame = 0;     // ring frame whose view last showed some object
    // Known from a readback. While a tile is hot, its front may move again.
    bool frontEmpty = true, burnEmpty = true, predictEmpty = true, hotEmpty = true;
    uint32_t supportUntil = 0;             // tick until which burnt pieces may still fall
    uint32_t supportFirst = 0;             // tile that the next `support` begins at
    uint32_t sootFirst = 0, sootTick = 0;  // as supportFirst; when it was last laid
    uint32_t predictTick = 0;              // of the last round of predictions
    uint32_t shownTick = 0;                // tick of the state that draws show
    uint32_t links = 0, occluders = 0;     // of the last exchange update
    OcclusionUpdate shield;                // the last one's place, without its words
    float wind[3] = {};
    float tickFraction = 0;
    std::pmr::vector<PublishedStep> published;  // scratch of run
    bool tilesMoved = false;  // BurnTiles stand where they were before all places moved
};

struct DeformRenderer {
    explicit DeformRenderer(std::pmr::memory_resource* pmr) : skins(pmr) {}
    std::pmr::vector<Skin> skins;
    uint64_t softStep = 0;   // number of the step that sheets and springs have come to
    uint32_t softSteps = 0;  // that they take in the frame
    uint32_t bendSet = 0;    // which bending constraints the next one takes
};

struct VolumeBox {  // as in FlameRecord
    vec4 low{}, high{};
    vec4 flameLow{}, flameHigh{};  // without its smoke
    uint32_t intervals = 1;        // see VolumeDraw
    vec3 base{};                   // where it stands
    uint32_t key = 0, tier = 0;
    bool smokes = false;
    vec4 hazeLow{}, hazeHigh{};  // of its column of hot gas
    AtlasKind kind;
    vec3 tip{};        // as VolumeItem's
    vec4 basePlane{};  // as volumeBasePlane has it
};

struct FlameRenderer {
    explicit FlameRenderer(std::pmr::memory_resource* pmr) : volumes(pmr) {}
    std::pmr::vector<VolumeBox> volumes;              // volumetric flames that draws show
    uint32_t volumeStepsNow = Detail{}.rayStepCount;  // on its way to detail's
    // Of RecordOutside, by number; null: not there. The first is always there.
    std::array<core::Owned<OutsideView>, kMaxViews> outsideViews;
};

struct ParticleRenderer {
    explicit ParticleRenderer(float lights) : lightCount(lights) {}
    float lightCount;            // on its way to detail's; its fraction is the last one's share
    float quadShare = 1;         // on its way to detail's
    uint32_t quadsShown = 0;     // by the last view whose readback came
    vec3 particlesMove{0.0f};    // m, with the next dispatch that moves particles
    uint32_t emitterGroups = 0;  // of the dispatch that moves particles; 0: there are none
    bool particlesByFlipbook = false;  // flipbooks show all fire and smoke of them
    uint32_t sparkSources = 0;         // that throw sparks
    float lightShare = 0.0f;           // of particles' quads: those that emit alone, [0, 1]
    bool emittersMove = false;         // in the open frame
    uint32_t flameFlipbooks = 0;       // as setTileFlipbooks has them
};

struct FieldRenderer {
    explicit FieldRenderer(std::pmr::memory_resource* pmr) : fields(pmr), fieldDraws(pmr) {}
    std::pmr::vector<FieldEntry> fields;
    std::pmr::vector<FieldDraw> fieldDraws;  // that draws show, as their buffer has them
    bool fieldsDirty = false;                // one of them has something for the next frame
};

struct SurfaceRenderer {
    explicit SurfaceRenderer(std::pmr::memory_resource* pmr) : drawItems(pmr), surfaceSteps(pmr) {}
    std::pmr::vector<DrawItem> drawItems;        // objects that draws show
    std::pmr::vector<SurfaceStep> surfaceSteps;  // their draws, in order
    bool surfacesDirty = false;                  // `drawItems` changed since
    // As last recorded.
    VkBuffer drawVertices = VK_NULL_HANDLE, drawIndices = VK_NULL_HANDLE,
             drawShown = VK_NULL_HANDLE;
    // Of the call that is recorded.
    uint32_t drawnView = 0;  // OutsideView::number
    float transparency = 0;
    VkRect2D scissor{};  // px of the host's target; no extent: none
    std::array<KeptFramebuffer, 16> framebuffers{};
    static constexpr size_t kHalfSizes = 4;  // of targets that a world draws into round-robin
    std::array<HalfImages, kHalfSizes> halves{};
};

// Readbacks that are due, oldest first, and the last one as the world gets it.
struct ReadbackResults {
    explicit ReadbackResults(std::pmr::memory_resource* pmr)
        : givenObjects(pmr),
          givenAnswers(pmr),
          givenTexels(pmr),
          givenHeat(pmr),
          givenMaps(pmr),
          givenLights(pmr),
          givenFields(pmr),
          times(pmr),
          imageLayout(pmr),
          givenImages(pmr) {}
    std::array<PendingReadback, FrameRing::kMaxInFlight * 4> pending{};
    uint32_t pendingFirst = 0, pendingCount = 0;
    Readback given;
    std::pmr::vector<ObjectCounters> givenObjects;
    std::pmr::vector<ProbeAnswer> givenAnswers;
    std::pmr::vector<uint32_t> givenTexels;
    std::pmr::vector<uvec2> givenHeat;
    std::pmr::vector<BurnMap> givenMaps;
    std::pmr::vector<BurnLight> givenLights;
    std::pmr::vector<FieldCounters> givenFields;
    std::array<RoomAir, kMaxRooms> givenRooms{};
    bool givesRooms = false;
    std::pmr::vector<PassTime> times;
    float pictureTime = 0;  // ms of a picture on our own device that no frame has counted
    std::pmr::vector<ImageAt> imageLayout;  // of the last frame that took images
    uint64_t imagesFrame = 0;               // ring frame, of that
    std::pmr::vector<ObjectImage> givenImages;
};

// An entry of a table by slot, which grows as needed.
template <class T>
T& slotOf(std::pmr::vector<T>& table, uint32_t slot) {
    if (slot >= table.size()) table.resize(slot + 1);
    return table[slot];
}

struct VkBackend::State {
    State(Context::State& contextState, const WorldLimits& limits, std::pmr::memory_resource* pmr,
          const core::Log& logTo);
    ~State();
    State(const State&) = delete;
    State& operator=(const State&) = delete;

    Context::State& context;
    Device& device;
    DeviceMemory& deviceMemory;
    WorldLimits limits;
    std::pmr::memory_resource* memory;
    const core::Log& log;

    RetireQueue retired;
    FrameRing ring;
    WorldBuffers buffers;
    PassSets sets;
    BarrierTracker barriers;
    Buffer views;             // view ring: frame in flight, then view
    uint32_t viewStride = 0;  // bytes

    SceneTables scene;
    SimulationState simulation;
    DeformRenderer deforming;
    FlameRenderer flames;
    ParticleRenderer particles;
    FieldRenderer particleFields;
    SurfaceRenderer surfaces;
    ReadbackResults results;
    Detail detail;          // as of the frame's plan
    uint32_t crossing = 0;  // of kSwitchCrossing and kSwitchNoZPass
    ViewParams seen{};      // of the last pushView
    OwnDevice own;

    // The frame that is open.
    struct Open {
        bool open = false, ran = false, recording = false, readback = false;
        bool unseen = false;   // nothing draws before the next one
        bool refined = false;  // the refinement budget was allocated again
        VkCommandBuffer commands = VK_NULL_HANDLE;
        uint64_t ringFrame = 0, planFrame = 0;
        uint32_t endTick = 0;
        FrameInFlight* slot = nullptr;
        std::array<OutsideView*, kMaxViews> views{};  // that it is recorded for
        uint32_t viewCount = 0;
    } open;
    struct Refine {
        explicit Refine(std::pmr::memory_resource* memory) : lists(memory), noise(memory) {}
        std::pmr::vector<uint32_t> lists;  // of the frame's work buffer, as it begins
        std::pmr::vector<uint8_t> noise;   // of holes, tiling
        RefinePush push{};                 // of the frame; no objects: nothing is refined
        RefinePush last{};                 // of the last frame that refined
        uint32_t users = 0;                // objects that refine
        // Of the open frame's views. m, world; w: pixels of 1 m at 1 m, 0: no limit by size.
        std::array<vec4, kMaxViews> eyes{};
        uint32_t eyeCount = 0;
        float pixels = 0;   // of 1 m at clip w = 1, where it has most
        float bias = -1;    // levels that the budget takes; below 0: not known yet
        bool full = false;  // everything at its deepest, and placed in every frame
    } refine;
    struct PatternFrame {  // refined by the published scheme
        explicit PatternFrame(std::pmr::memory_resource* memory) : patternUses(memory) {}
        std::pmr::vector<core::Owned<PatternUse>> patternUses;
        uint32_t users = 0;  // objects
        uint32_t placeGroups = 0, nameGroups = 0;
        double lastTick = 0;  // of the last frame with any
    } pattern;

    // vk_backend.cpp
    void failIfLost() const;
    PendingUpload& stage(uint64_t bytes, const char* name);
    void dropUploads(size_t kept) noexcept;  // all but the first
    void freeQuarantine() noexcept;
    // vk_objects.cpp
    void changed(uint32_t slot) noexcept;  // its record goes to the device with the next frame
    void settle() noexcept;  // once a frame's records are written: what has nothing to do rests
    // vk_images.cpp
    void addImage(ImageEntry& entry, uint32_t width, uint32_t height, uint32_t layers,
                  uint32_t mips, VkFormat format, std::span<const std::byte> pixels,
                  const char* name);
    void dropImage(ImageEntry& entry) noexcept;
    // vk_record.cpp
    void openFrame(VkCommandBuffer commands, uint64_t ringFrame);
    void run(const FramePlan& plan);
    void followDetail(const Detail& planned) noexcept;
    void closeFrame();
    // Whose soot is due; count 0: none is. `looked`: some view may show it.
    TileShare sootShare(bool looked) noexcept;
    // frame.cpp
    void recordEffects(FrameInFlight& slot);
    void recordReadback(FrameInFlight& slot);
    RecordTarget recordTarget(FrameInFlight& slot, VkCommandBuffer commands) noexcept;
    uint32_t pushView(FrameInFlight& slot, const FwView& view, const VkViewport& viewport);
    // vk_views.cpp
    // The open frame is recorded for these. May throw.
    void openViews(std::span<const FwView> from);
    [[nodiscard]] OutsideView& validatedView(std::span<OutsideView* const> taken);
    // Buffers of the open frame's views; `marches`: they march so many flames.
    void makeViewRoom(uint32_t flameCount, bool marches, uint64_t last);
    [[nodiscard]] std::span<OutsideView* const> seenFrom() const noexcept {
        return {open.views.data(), open.viewCount};
    }
    // Of the newest frame's views the one that a draw of `view` shows.
    [[nodiscard]] OutsideView& viewFor(const FwView& view) const noexcept;
    // vk_seen.cpp
    // In ring frame `frame` a view of `height` px shows what it shows.
    void look(const FwView& view, float height, uint64_t frame) noexcept;
    // vk_refine.cpp
    void uploadRefineTable();
    void recordFire(uint32_t object, uint32_t tick) noexcept;
    [[nodiscard]] bool refines(const ObjectEntry& object) const noexcept;
    uint64_t planRefine(const FramePlan& plan);
    void listRefined(bool all);
    void refineObjects(FrameInFlight& slot);
    bool chooseDue(double now) noexcept;
    [[nodiscard]] bool isDue(const ObjectEntry& object, const RefineObject& record,
                             double now) const noexcept;
    [[nodiscard]] float eyeDistance(const ObjectEntry& object, const vec4& eye) const noexcept;
    [[nodiscard]] vec4 eyeFor(const ObjectEntry& object) const noexcept;
    RefineObject refineRecord(const ObjectEntry& object, bool full) const noexcept;
    float cutSegments(const ObjectEntry& object, const RefineObject& record) const noexcept;
    bool hasPerPixelHoles(const ObjectEntry& object) const noexcept;
    void visibilityFromViews() noexcept;
    // vk_published.cpp
    [[nodiscard]] bool refinesAsPublished(const ObjectEntry& object) const noexcept;
    void adoptPattern(RefineUse& use, const ObjectInit& init, const RefineMesh& mesh,
                      uint64_t last);
    void dropPattern(RefineUse& use) noexcept;
    uint64_t planPatterns();
    void refineAsPublished(FrameInFlight& slot);
    // vk_readback.cpp
    void pushPending(const PendingReadback& one) noexcept;
    void applyShown(const ReadbackLayout& layout, const std::byte* from) noexcept;
    void updateFromCounters(uint32_t slot, ObjectCounters& counters, uint32_t tick) noexcept;
    const Readback* nextReadback();
    // vk_volume.cpp
    // What the view that was last pushed shows of them, farthest first; how many.
    uint32_t orderVolumes(uint32_t slabs,
                          std::array<VolumeItem, kMaxVolumeFlames>& out) const noexcept;
    [[nodiscard]] uint32_t rayStepCount() const noexcept {
        return std::min(limits.rayStepCount, flames.volumeStepsNow);
    }
    // How a target of `size` px shows what is marched for it.
    [[nodiscard]] VolumeScreen screenOf(const TargetKey& target, vec2 size) const noexcept;
    // A draw in `frame` shows `view` so.
    static void recordScreen(OutsideView& of, const FwView& view, const VolumeScreen& screen,
                             uint64_t frame) noexcept;
    // Before the first command: room for what is marched; less of it makes it coarser.
    void makeMarchRoom(OutsideView& of, uint32_t flameCount, uint64_t last);
    [[nodiscard]] uint32_t rayWords(const March& march) const noexcept;  // at the frame's detail
    // For the view that was last pushed, which is `of`'s.
    [[nodiscard]] MarchRecord marchVolumes(OutsideView& of) noexcept;
    [[nodiscard]] MarchRecord allocateMarch(OutsideView& of,
                                            std::span<const VolumeItem> items) noexcept;
    // What a flame's card shows, of the last two marches of it.
    void showPair(March& march, const VolumeItem& item, uint32_t place) const noexcept;
    // Which of `room` books each item may show.
    void assignAtlases(March& march, std::span<const VolumeItem> items, uint32_t room,
                       std::span<uint32_t> numbers) const noexcept;
    void sampleFlipbook(March& march, const VolumeItem& item, uint32_t place,
                        uint32_t number) const noexcept;
    // Whether what is marched is for a view on a screen; else they are to be marched as they are
    // drawn.
    [[nodiscard]] static bool marchedFor(const OutsideView& of, const FwView& view,
                                         const VolumeScreen& screen) noexcept;
    // A side of a pixel, of the view as it is drawn: more where nobody could know its screen, in
    // the first picture and after a resize. A second screen of each frame takes them once.
    static uint32_t minRays(OutsideView& of, const FwView& view,
                            const VolumeScreen& screen) noexcept;
    // What bends what is behind it in the view that was last pushed, farthest first; how many.
    // `march`: that shows the flames, or null.
    uint32_t orderHazes(const March* march, float strength,
                        std::array<HazedVolume, kMaxVolumeFlames>& out) const noexcept;
    // vk_emitters.cpp
    [[nodiscard]] uint32_t tileQuads() const noexcept;
    [[nodiscard]] bool showsEmitters() const noexcept {
        return particles.emitterGroups > 0 || particles.sparkSources > 0;
    }
    [[nodiscard]] bool showsAnything() const noexcept {
        return (surfaces.drawVertices || showsEmitters()) && scene.lookTextures.live &&
               limits.looks.viewParams;
    }
    // Books show all quads but sparks.
    [[nodiscard]] bool onlyFlipbooks() const noexcept;
    void makeEmitterRoom(const EmitterUpdate& update, uint64_t last);
    [[nodiscard]] SortPush quadRoom() const noexcept;
    // vk_field.cpp
    uint32_t orderFields(std::array<FieldItem, kMaxFields>& out) const noexcept;  // how many
    // vk_draw.cpp
    void recordDraws(FrameInFlight& slot, VkCommandBuffer commands, const Target& target,
                     const FwView& view, const VkViewport& viewport, const HostImages& host,
                     DrawPart part = DrawPart::all);
    void setViewport(VkCommandBuffer commands, const VkViewport& viewport) const noexcept;
    HostImages hostImagesFor(FrameInFlight& slot, const Target& target, const FwVulkanFrame& frame,
                             VkImageView depth, VkImageLayout depthLayout);
    [[nodiscard]] bool turnsFaces(const FwView& view, const VkViewport& viewport) const noexcept;
    VkDescriptorSet hostSetFor(FrameInFlight& slot, VkImageView view, VkImageLayout layout);
    VkFramebuffer framebufferFor(FrameInFlight& slot, const Target& target, FwTargetId targetId,
                                 const FwVulkanComposite& images);
    // Of targets that are gone, and of `forget`; what the device may still use goes later.
    void dropFramebuffers(FwTargetId forget) noexcept;
    void destroyFramebuffers() noexcept;
    // vk_half.cpp
    // Outside any pass: what is soft of a view, in images of half resolution. Null: nothing is.
    HalfImages* recordHalf(FrameInFlight& slot, VkCommandBuffer commands, const Target& target,
                           const FwView& view, const VkViewport& viewport, const HostImages& host);
    // For the view that was last pushed.
    [[nodiscard]] HalfPush halfPushFor(const VkViewport& viewport) const noexcept;
    HalfImages& halfFor(VkFormat format, uint32_t width, uint32_t height, uint64_t frame);
    void makeHalf(HalfImages& half, VkFormat format, uint32_t width, uint32_t height);
    void dropHalf(HalfImages& half) noexcept;  // once its last frame is done
    // vk_own.cpp
    void beginOwn();
    void submitOwn();
    void renderOffscreen(const FwOffscreenDef& def);
    void makeOffscreen(uint32_t width, uint32_t height);
    void dropOffscreen() noexcept;
};

}  // namespace fw::gpu::vk
