// The world's device buffers: one plane per resource, cut into ranges by spaces (object tiles, mesh
// tiles, vertices ...). A space that is full doubles all of its planes: new buffers now, their old
// content is copied when the next frame is recorded. Not staging, not readback.
#pragma once
#include "core/growth.h"
#include "gpu/passes/pass.h"
#include "gpu/vk/memory.h"
#include "shared/look.h"

#include <array>
#include <atomic>

namespace fw::gpu::vk {

constexpr uint32_t kTileTexels = 64;
constexpr uint32_t kFieldUnit = 64;  // cells of a particle field

// What ranges are allocated of, and the unit.
enum Space : uint32_t {
    kSpaceObjects,      // object slots
    kSpaceObjectTiles,  // 8x8 tiles of objects: state, lists, scratch
    kSpaceMeshTiles,    // 8x8 tiles of meshes: texels, normals
    kSpaceSlowness,     // 8x8 tiles of slowness, of meshes and of painted objects
    kSpaceLinks,        // rim records
    kSpaceReaders,      // words
    kSpaceVertices,
    kSpaceIndices,
    kSpaceIterations,  // per frame
    kSpaceEvents,      // per frame
    kSpaceWakeGroups,  // per frame
    kSpaceProbes,      // per frame
    kSpaceRefineMeshTriangles,
    kSpaceRefineMeshEdges,
    kSpaceRefineMeshSlots,
    kSpaceRefineWords,
    kSpaceRefineItems,      // of objects: edges and interiors
    kSpaceRefineTriangles,  // of objects
    kSpaceRefineSlots,      // of objects
    kSpaceRefineIndices,    // words, of objects
    kSpaceRefineCuts,       // vertices, of objects
    kSpaceRefineWork,       // words, per frame
    kSpaceArpList,          // listed triangles, of objects
    kSpaceArpGroups,        // per frame
    kSpacePublished,        // 8x8 tiles of objects in as-published mode
    kSpaceHeat,             // 8x8 tiles of objects with heat
    kSpaceDeformers,        // objects that deform
    kSpaceShown,            // drawn vertices of such objects
    kSpaceSoft,             // those of sheets and springs
    kSpaceNodes,            // of meshes that deform
    kSpaceCoats,            // drawn vertices of such meshes
    kSpaceDeformGroups,     // per frame
    kSpaceSkin,             // 8x8 tiles of meshes with skinned objects
    kSpaceSkinSources,      // drawn vertices of such meshes
    kSpaceSkinGiven,        // words of hosts' vertex buffers
    kSpaceSources,          // fire sources of objects
    kSpaceNeighbours,       // words, and
    kSpaceContacts,         // links between objects, as of the last update
    kSpaceVolumes,          // volumetric flames, per frame
    kSpaceVolumeRays,       // words, of a view
    kSpaceEmitters,         // fire emitters, per frame
    kSpaceEmitterGroups,    // per frame
    kSpaceSparks,           // who throws sparks, per frame
    kSpaceParticles,        // of all emitters
    kSpaceFlames,           // quads of flames and particles, per frame
    kSpaceFields,           // field slots
    kSpaceFieldCells,       // 64 cells of particle fields
    kSpaceFieldRuns,        // per frame
    kSpaceFieldDraws,       // per frame
    kSpaceShield,           // words, as of the last update
    kSpaceFixed,            // one unit
    kSpaceOfViews,          // those of the second view, of the third, ...; none until it is given
    kSpaceCount = kSpaceOfViews + (kMaxViews - 1) * 3,
};
// Flames, VolumeRays and Volumes (of which a further view has the work alone) of view `view`.
constexpr Space spaceOf(Space space, uint32_t view) noexcept {
    if (view == 0) return space;
    const uint32_t i = space == kSpaceFlames ? 0 : space == kSpaceVolumeRays ? 1 : 2;
    return Space(kSpaceOfViews + (view - 1) * 3 + i);
}

// Units of kSpaceFlames that hold so many quads: draw arguments begin with eight words, a unit of
// theirs has two.
constexpr uint32_t quadUnits(uint32_t quads) noexcept { return quads + kFlameOrder / 2; }

// First-fit ranges of whole units.
class RangeAllocator {
 public:
    explicit RangeAllocator(std::pmr::memory_resource* memory) : free_(memory) {}
    static constexpr uint32_t kNoRange = 0xFFFFFFFFu;
    void addCapacity(uint32_t units);            // at the end
    void dropCapacity(uint32_t units) noexcept;  // likewise, of what is free there
    uint32_t allocate(uint32_t units);           // kNoRange: does not fit
    void release(uint32_t first, uint32_t units) noexcept;
    [[nodiscard]] uint32_t capacity() const noexcept { return capacity_; }
    [[nodiscard]] uint32_t used() const noexcept { return used_; }
    [[nodiscard]] uint32_t freeAtEnd() const noexcept {
        const bool any = !free_.empty() && free_.back().first + free_.back().units == capacity_;
        return any ? free_.back().units : 0;
    }

 private:
    struct Range {
        uint32_t first, units;
    };
    std::pmr::vector<Range> free_;  // by first; room for pieces_ + 2
    uint32_t capacity_ = 0, used_ = 0, pieces_ = 0;
};

struct Plane {
    uint32_t resource = 0;
    Space space = kSpaceFixed;
    uint32_t unitBytes = 0;
    bool keep = false;  // content survives growth
    Component component = kComponentObjects;
    const char* name = "";
    VkBufferUsageFlags usage = 0;  // beyond storage and transfer
};

struct WorldSizes {       // of the fixed planes
    uint32_t lights = 1;  // records
    uint32_t flames = 1;
    bool exact = false;  // planes have no room to spare: see WorldLimits::exactBuffers
};

// What is freed once the GPU is done with a frame.
struct Retired {
    uint64_t frameIndex = 0;
    Buffer buffer;
    Image image;
    VkDescriptorPool pool = VK_NULL_HANDLE;
    VkFramebuffer framebuffer = VK_NULL_HANDLE;
};

class RetireQueue {
 public:
    RetireQueue(Device& device, DeviceMemory& deviceMemory, std::pmr::memory_resource* memory)
        : device_(device), deviceMemory_(deviceMemory), queue_(memory) {}
    ~RetireQueue() { collect(~0ull); }
    RetireQueue(const RetireQueue&) = delete;
    RetireQueue& operator=(const RetireQueue&) = delete;
    // Every push is promised before, where throwing is still allowed; push itself never throws.
    void promise(size_t count) {
        core::growTo(queue_, queue_.size() + promised_ + count);
        promised_ += count;
    }
    void push(uint64_t lastFrame, Buffer& buffer) noexcept;
    void push(uint64_t lastFrame, Image& image) noexcept;
    void push(uint64_t lastFrame, VkDescriptorPool pool) noexcept;
    void pushFramebuffer(uint64_t lastFrame, VkFramebuffer framebuffer) noexcept;
    void collect(uint64_t completedFrame) noexcept;

 private:
    Device& device_;
    DeviceMemory& deviceMemory_;
    void add(const Retired& one) noexcept;
    std::pmr::vector<Retired> queue_;
    size_t promised_ = 0;
};

class Planes {
 public:
    Planes(Device& device, DeviceMemory& deviceMemory, RetireQueue& retired,
           const WorldSizes& sizes, std::pmr::memory_resource* memory);
    ~Planes();
    Planes(const Planes&) = delete;
    Planes& operator=(const Planes&) = delete;

    // Throws FW_ERROR_OUT_OF_MEMORY (budget, device, or the device's storage buffer range) and then
    // changed nothing. lastFrame: the newest frame that may use the present buffers.
    uint32_t allocate(Space space, uint32_t units, uint64_t lastFrame);
    void release(Space space, uint32_t first, uint32_t units) noexcept;
    // For spaces that are refilled each frame or indexed by slot.
    void atLeast(Space space, uint32_t units, uint64_t lastFrame);
    // Likewise, with little to spare; `shrinks`: with none, and fewer where it has many more. For
    // spaces that follow detail.
    void fit(Space space, uint32_t units, bool shrinks, uint64_t lastFrame);

    // All that a view beyond the first needs at least. Throws as atLeast does.
    void makeView(uint32_t view, uint64_t lastFrame);
    // Frees what such a view has once frame `lastFrame` is done. May throw, and then did nothing.
    void dropView(uint32_t view, uint64_t lastFrame);

    [[nodiscard]] const Buffer& buffer(uint32_t resource) const { return slots_[resource].now; }
    [[nodiscard]] uint32_t capacity(Space space) const { return spaces_[space].capacity(); }
    // Changes whenever a buffer is another one: descriptor sets are rewritten then.
    [[nodiscard]] uint64_t generation() const noexcept { return generation_; }
    // Records the copies that growth left over. True: something was recorded.
    bool recordMoves(const Table& table, VkCommandBuffer commands, uint64_t frameIndex);
    [[nodiscard]] bool movesPending() const noexcept { return movesPending_; }
    void rows(std::pmr::vector<MemoryRow>& out) const;  // [any]
    [[nodiscard]] uint64_t bytes(Space space) const noexcept;

 private:
    struct Slot {
        Plane plane;
        Buffer now;
        Buffer before;          // holds the recorded content until the next frame moves it
        bool recorded = false;  // `now` was used by a recorded frame
    };
    uint32_t allocateIn(Space space, uint32_t units, uint64_t lastFrame);
    // New buffers of so many units, more or fewer; fewer: the last ones are free.
    void resize(Space space, uint32_t units, uint64_t lastFrame);
    uint32_t limit(Space space) const noexcept;
    void checkLimit(Space space, uint32_t units) const;  // throws FW_ERROR_OUT_OF_MEMORY

    Device& device_;
    DeviceMemory& deviceMemory_;
    RetireQueue& retired_;
    std::array<Slot, kResourceCount> slots_{};
    std::pmr::vector<RangeAllocator> spaces_;
    // For `rows`, which any thread calls: units in use by space, bytes by resource.
    std::array<std::atomic<uint32_t>, kSpaceCount> usedUnits_{};
    std::array<std::atomic<uint64_t>, kResourceCount> bytes_{};
    uint64_t generation_ = 1;
    bool exact_ = false;
    bool movesPending_ = false;
};

}  // namespace fw::gpu::vk
