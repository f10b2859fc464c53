// The world's device buffers: one per resource, cut into ranges by pools (object tiles, mesh tiles,
// vertices ...). A full pool doubles all of its buffers: new ones now, the old content is copied
// when the next frame is recorded. Not staging, not readback.
#pragma once
#include "core/assert.h"
#include "core/growth.h"
#include "gpu/passes/pass.h"
#include "gpu/vk/memory.h"
#include "gpu/vk/range_allocator.h"
#include "shared/appearance.h"

#include <array>
#include <atomic>
#include <utility>

namespace fw::gpu::vk {

constexpr uint32_t kTileTexels = 64;
constexpr uint32_t kFieldUnit = 64;  // cells of a particle field

// Pools from which ranges are allocated, each with its unit.
enum BufferPool : uint32_t {
    kPoolObjects,      // object slots
    kPoolObjectTiles,  // 8x8 tiles of objects: state, lists, scratch
    kPoolMeshTiles,    // 8x8 tiles of meshes: texels, normals
    kPoolSlowness,     // 8x8 tiles of slowness, of meshes and of painted objects
    kPoolLinks,        // rim records
    kPoolDependents,   // words
    kPoolVertices,
    kPoolIndices,
    kPoolIterations,  // per frame
    kPoolEvents,      // per frame
    kPoolWakeGroups,  // per frame
    kPoolProbes,      // per frame
    kPoolRefineMeshTriangles,
    kPoolRefineMeshEdges,
    kPoolRefineMeshSlots,
    kPoolRefineWords,
    kPoolRefineItems,      // of objects: edges and interiors
    kPoolRefineTriangles,  // of objects
    kPoolRefineSlots,      // of objects
    kPoolRefineIndices,    // words, of objects
    kPoolRefineCuts,       // vertices, of objects
    kPoolRefineWork,       // words, per frame
    kPoolExtensionWords,   // four words, of objects that an extension works on
    kPoolExtensionGroups,  // per frame
    kPoolExtensionTiles,   // 8x8 tiles of such objects
    kPoolHeat,             // 8x8 tiles of objects with heat
    kPoolDeformers,        // objects that deform
    kPoolShown,            // drawn vertices of such objects
    kPoolSoft,             // those of particles with a solver
    kPoolSheetParticles,   // of meshes that deform
    kPoolEmbeddings,       // drawn vertices of such meshes
    kPoolDeformGroups,     // per frame
    kPoolSkin,             // 8x8 tiles of meshes with skinned objects
    kPoolSkinSources,      // drawn vertices of such meshes
    kPoolSkinGiven,        // words of hosts' vertex buffers
    kPoolSources,          // fire sources of objects
    kPoolNeighbours,       // words, and
    kPoolContacts,         // links between objects, as of the last update
    kPoolVolumes,          // volumetric flames, per frame
    kPoolVolumeRays,       // words, of a view
    kPoolBodies,           // burning objects with one body of fire, per frame
    kPoolEmitters,         // fire emitters, per frame
    kPoolEmitterGroups,    // per frame
    kPoolSparks,           // sources of sparks, per frame
    kPoolParticles,        // of all emitters
    kPoolFlames,           // quads of flames and particles, per frame
    kPoolFields,           // field slots
    kPoolFieldCells,       // 64 cells of particle fields
    kPoolFieldRuns,        // per frame
    kPoolFieldDraws,       // per frame
    kPoolOcclusion,        // words, as of the last update
    kPoolFixed,            // one unit
    kPoolOfViews,          // those of the second view, of the third, ...; none until it is given
    kPoolCount = kPoolOfViews + (kMaxViews - 1) * 3,
};
// Flames, VolumeRays and Volumes (of which a further view has the work alone) of view `view`.
constexpr BufferPool poolOf(BufferPool pool, uint32_t view) noexcept {
    if (view == 0) return pool;
    const uint32_t i = pool == kPoolFlames ? 0 : pool == kPoolVolumeRays ? 1 : 2;
    return BufferPool(kPoolOfViews + (view - 1) * 3 + i);
}

// Units of kPoolFlames that hold so many quads: draw arguments begin with eight words, a unit of
// theirs has two.
constexpr uint32_t quadUnits(uint32_t quads) noexcept { return quads + kFlameOrder / 2; }

struct BufferRow {
    uint32_t binding = 0;
    const char* name = "";
    BufferPool pool = kPoolFixed;
    uint32_t stride = 0;  // bytes of a unit of the pool
    Component component = kComponentObjects;
    VkBufferUsageFlags extraUsage = 0;  // beyond storage and transfer
    // When it grows its content stays, or goes, or stays with zeros behind it. The last kind begins
    // as zeros, too: passes read more of such a buffer than objects own.
    enum Content : uint8_t { kept, refilled, zeroed } content = kept;
};

struct WorldSizes {       // of the fixed buffers
    uint32_t lights = 1;  // records
    uint32_t flames = 1;
    bool exact = false;  // buffers have no spare capacity: see WorldLimits::exactBuffers
};

// Resources to free together once the GPU is done with a frame.
struct Retired {
    Buffer buffer{};
    Image image{};
    VkDescriptorPool pool = VK_NULL_HANDLE;
    VkFramebuffer framebuffer = VK_NULL_HANDLE;
    uint64_t frameIndex = 0;  // the queue's
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
    // `lastFrame`: the newest frame that may use them.
    void push(uint64_t lastFrame, Retired resources) noexcept;
    void push(uint64_t lastFrame, Buffer& buffer) noexcept {
        push(lastFrame, {.buffer = std::exchange(buffer, {})});
    }
    void collect(uint64_t completedFrame) noexcept;

 private:
    Device& device_;
    DeviceMemory& deviceMemory_;
    std::pmr::vector<Retired> queue_;
    size_t promised_ = 0;
};

class WorldBuffers;

// Units of a pool, which go back with it.
class BufferRange {
 public:
    BufferRange() = default;
    BufferRange(WorldBuffers& buffers, BufferPool pool, uint32_t first, uint32_t units) noexcept
        : buffers_(&buffers), pool_(pool), first_(first), units_(units) {}
    BufferRange(BufferRange&& other) noexcept { *this = std::move(other); }
    BufferRange& operator=(BufferRange&& other) noexcept {
        std::swap(buffers_, other.buffers_);
        std::swap(pool_, other.pool_);
        std::swap(first_, other.first_);
        std::swap(units_, other.units_);
        return *this;
    }
    ~BufferRange();
    [[nodiscard]] uint32_t first() const noexcept { return first_; }
    [[nodiscard]] uint32_t units() const noexcept { return units_; }
    explicit operator bool() const noexcept { return units_ > 0; }

 private:
    WorldBuffers* buffers_ = nullptr;
    BufferPool pool_{};
    uint32_t first_ = 0, units_ = 0;
};

class WorldBuffers {
 public:
    WorldBuffers(Device& device, DeviceMemory& deviceMemory, RetireQueue& retired,
                 const WorldSizes& sizes, std::pmr::memory_resource* memory);
    ~WorldBuffers();
    WorldBuffers(const WorldBuffers&) = delete;
    WorldBuffers& operator=(const WorldBuffers&) = delete;

    // Throws FW_ERROR_OUT_OF_MEMORY (budget, device, or the device's storage buffer range) and then
    // changed nothing. lastFrame: the newest frame that may use the present buffers.
    [[nodiscard]] BufferRange allocate(BufferPool pool, uint32_t units, uint64_t lastFrame);
    // For pools that are refilled each frame or indexed by slot.
    void atLeast(BufferPool pool, uint32_t units, uint64_t lastFrame);
    // Likewise, with little to spare; `shrinks`: with none, and fewer where it has many more. For
    // pools that follow detail.
    void fit(BufferPool pool, uint32_t units, bool shrinks, uint64_t lastFrame);

    // All that a view beyond the first needs at least. Throws as atLeast does.
    void makeView(uint32_t view, uint64_t lastFrame);
    // Frees what such a view has once frame `lastFrame` is done. May throw, and then did nothing.
    void dropView(uint32_t view, uint64_t lastFrame);

    [[nodiscard]] const Buffer& buffer(uint32_t resource) const {
        FW_ASSERT(resource < kResourceCount, "resource %u", resource);
        return slots_[resource].now;
    }
    [[nodiscard]] uint32_t capacity(BufferPool pool) const {
        return uint32_t(pools_[pool].capacity());
    }
    // Changes whenever a buffer is another one: descriptor sets are rewritten then.
    [[nodiscard]] uint64_t generation() const noexcept { return generation_; }
    // Records the copies that growth left over, and zeros. True: something was recorded.
    bool recordMoves(const Table& table, VkCommandBuffer commands, uint64_t frameIndex);
    [[nodiscard]] bool movesPending() const noexcept { return movesPending_; }
    void rows(std::pmr::vector<MemoryRow>& out) const;  // [any]
    [[nodiscard]] uint64_t bytes(BufferPool pool) const noexcept;

 private:
    struct Slot {
        BufferRow row;
        Buffer now;
        Buffer before;          // holds the recorded content until the next frame moves it
        bool recorded = false;  // `now` was used by a recorded frame
    };
    friend class BufferRange;
    void release(BufferPool pool, uint32_t first, uint32_t units) noexcept;
    uint32_t allocateIn(BufferPool pool, uint32_t units, uint64_t lastFrame);
    // New buffers of so many units, more or fewer; fewer: the last ones are free.
    void resize(BufferPool pool, uint32_t units, uint64_t lastFrame);
    uint32_t limit(BufferPool pool) const noexcept;
    void checkLimit(BufferPool pool, uint32_t units) const;  // throws FW_ERROR_OUT_OF_MEMORY

    Device& device_;
    DeviceMemory& deviceMemory_;
    RetireQueue& retired_;
    std::array<Slot, kResourceCount> slots_{};
    std::array<std::array<char, 40>, (kMaxViews - 1) * kResourcesOfViews.size()> viewNames_{};
    std::pmr::vector<RangeAllocator> pools_;
    // For `rows`, which any thread calls: units in use by pool, bytes by resource.
    std::array<std::atomic<uint32_t>, kPoolCount> usedUnits_{};
    std::array<std::atomic<uint64_t>, kResourceCount> bytes_{};
    uint64_t generation_ = 1;
    bool exact_ = false;
    bool movesPending_ = false;
};

}  // namespace fw::gpu::vk
