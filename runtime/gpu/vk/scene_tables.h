// Meshes, objects, images and rooms that the host created, as the device holds them, and their
// changes that wait for the next frame.
#pragma once
#include "core/slot_set.h"
#include "gpu/vk/deform_renderer.h"
#include "gpu/vk/descriptors.h"
#include "gpu/vk/refine_renderer.h"
#include "gpu/vk/uploads.h"

namespace fw::gpu::vk {

struct SimulationState;

struct MeshEntry {
    bool live = false;
    uint32_t width = 0, height = 0, tilesX = 0, tiles = 0, vertices = 0, indices = 0;
    BufferRange meshTiles, slowness, links, dependents, vertexRange, indexRange;
    uint32_t materialEnd[kMaterialsPerObject] = {};  // indices are sorted by material: ends of runs
    RefineMesh refine[2 * (kRefineDepth + 1)];       // by refineKey
    uint32_t sourceCells = 1;                        // see mesh/exchange_tiles.h
    bool parts = false;                              // some touch
    float edge = 0;       // m at scale 1: side of a square as large as two mean triangles
    float texelEdge = 0;  // texels, longest edge in the map
    const mesh::BurnDomain* domain = nullptr;
    BufferRange innerVertices;  // of the vertices on the inner skin, once an object shows it
    BufferRange particles, embeddings;  // once an object deforms
    BufferRange skin, skinSources;      // once one is skinned
};

// How far an object's fire has come, as far as draws and predictions ask.
struct BurnLifecycle {
    bool touched = false;    // some event reached it: it may burn, or be wet
    bool doused = false;     // one of them was not fire
    bool lit = false;        // one of them was
    bool catches = false;    // in this frame: the first that was
    bool warmed = false;     // others' fires sent heat to it
    bool charred = false;    // most of it burns or has burnt: its cold rest is not worth a draw
    bool forget = false;     // in this frame: its predictions are made again
    uint32_t douseEnds = 0;  // tick by which the last dousing has had its effect
    uint64_t lastDouse = 0;  // ring frame that wetted or put out some of it; 0: none to forget
    uint64_t lastEvent = 0;  // tick
};

struct ObjectEntry {
    bool live = false;
    bool recordDirty = false, materialsDirty = false;  // to upload with the next frame
    bool resetDue = false;                             // no frame has recorded it yet
    bool inner = false;  // its back faces are drawn on the mesh's inner skin
    BurnLifecycle burn;
    uint64_t seenFrame = 0;  // ring frame whose view last showed it; kObjectUnseen: long ago
    bool turns = false;      // in this frame it comes into view, or leaves it
    uint32_t mesh = 0;
    BurnObject record{};
    BufferRange tiles, slowness, heatTiles, sources;
    BufferRange extensionWords, extensionTiles;  // of an extension's methods
    RefineUse refine;
    bool extensionTouched = false;  // some event reached it, and an extension burns it
    uint32_t extensionParity = 0;
    DeformUse deforms;           // none if `shown` is empty
    BufferRange shown, soft;     // its shown vertices; of those with a solver
    float shape[3] = {1, 1, 1};  // by which its mesh was stretched
    // Cold data: not read for sleeping objects, so it is stored last.
    DeformObject deform{};
    BurnMaterial materials[kMaterialsPerObject]{};
    uint32_t images[kMaterialsPerObject] = {};  // slot + 1, 0: none
    HeatMaterial heat[kMaterialsPerObject]{};   // with kObjectHeat

    [[nodiscard]] uint32_t texelCount() const noexcept { return record.width * record.height; }
};

// m that the object's fire may run in a tick.
[[nodiscard]] double metresPerTick(const ObjectEntry& object) noexcept;

struct ImageEntry {
    Image image;
    ImageSet set;
    bool live = false;
};

// Tiles of a destroyed object: list entries may still name them. Free once every list was walked.
struct Quarantined {
    BufferRange tiles;
    ListWalks walks;  // to be passed
};

struct SceneTables {
    SceneTables(DeviceMemory& deviceMemory, RetireQueue& retired, std::pmr::memory_resource* pmr)
        : memory(pmr), uploads(deviceMemory, retired, pmr), restores(deviceMemory, retired, pmr) {}
    // The object's record goes to the device with the next frame.
    void changed(uint32_t slot) noexcept;
    // The object burns at `tick`, as far as is known.
    void noteFire(uint32_t slot, uint32_t tick) noexcept;
    // Releases the tiles that no list names any more.
    void freeQuarantine(const SimulationState& simulation) noexcept;
    [[nodiscard]] const MeshEntry& meshOf(const ObjectEntry& object) const noexcept {
        return meshes[object.mesh];
    }
    [[nodiscard]] const RefineMesh& refineOf(const ObjectEntry& object) const noexcept {
        return meshes[object.mesh].refine[object.refine.key];
    }

    std::pmr::memory_resource* memory;
    std::pmr::vector<MeshEntry> meshes{memory};
    std::pmr::vector<ObjectEntry> objects{memory};
    // Objects that frames look at. The others sleep: a change or an event inserts an object here,
    // and settle lets it go.
    core::SlotSet awake{memory};
    std::pmr::vector<ImageEntry> images{memory};
    ImageEntry white, appearanceTextures, profiles;
    ImageEntry flipbooks;  // not live: there are none
    UploadQueue uploads;
    // For the next frame: the content of restored objects, which replaces that of new ones.
    UploadQueue restores;
    std::pmr::vector<uint32_t> restoredObjects{memory};
    bool restoreDue = false;
    std::pmr::vector<Quarantined> quarantine{memory};
    uint32_t liveObjects = 0;
    uint32_t partMeshes = 0;    // of parts that touch
    bool recordsDirty = false;  // some object has dirty records or a reset due
    std::array<Room, kMaxRooms> rooms{};
    bool roomsDirty = false;
    bool airs = false;  // some step had rooms
};

// An entry of a table by slot, which grows as needed.
template <class T>
T& slotOf(std::pmr::vector<T>& table, uint32_t slot) {
    if (slot >= table.size()) table.resize(slot + 1);
    return table[slot];
}

// objects.cpp: once a frame's records are written, objects that have nothing to do fall asleep.
void settle(BackendState& s) noexcept;
// images.cpp
void addImage(BackendState& s, ImageEntry& entry, uint32_t width, uint32_t height, uint32_t layers,
              uint32_t mips, VkFormat format, std::span<const std::byte> pixels, const char* name);
void dropImage(BackendState& s, ImageEntry& entry) noexcept;     // once frames are done with it
void destroyImage(BackendState& s, ImageEntry& entry) noexcept;  // now
// restore.cpp
void recordMovedTiles(BackendState& s, FrameRecorder& recorder);
void recordRestores(BackendState& s, FrameRecorder& recorder);

}  // namespace fw::gpu::vk
