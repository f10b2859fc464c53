#include "gpu/vk/world_buffers.h"

#include "core/assert.h"
#include "core/error.h"
#include "shared/appearance.h"
#include "shared/body.h"
#include "shared/deform.h"
#include "shared/exchange.h"
#include "shared/field.h"
#include "shared/flipbook.h"
#include "shared/refine.h"
#include "shared/room.h"
#include "shared/spark.h"
#include "shared/volume_draw.h"

#include <algorithm>
#include <cstdio>
#include <iterator>

namespace fw::gpu::vk {
namespace {

constexpr uint32_t kCounterRows = kRowIteration + 64 * kMaxSubsteps + 1;  // one more to carry over

// Beside words: dropped where a device has too few texels.
constexpr VkBufferUsageFlags kTexels = VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT;

constexpr BufferRow::Content kRefilled = BufferRow::refilled, kZeroed = BufferRow::zeroed;

// All buffers of a world. Buffers of a pool grow together.
constexpr BufferRow kBuffers[] = {
    // binding, name, pool, stride, component, extra usage, content when it grows
    {FW_BIND_OBJECTS, "object records", kPoolObjects, sizeof(BurnObject), kComponentObjects, 0,
     kZeroed},
    {FW_BIND_MATERIALS, "materials", kPoolObjects, sizeof(BurnMaterial) * kMaterialsPerObject,
     kComponentObjects},
    {FW_BIND_OBJECT_COUNTERS, "object counters", kPoolObjects, sizeof(ObjectCounters),
     kComponentObjects, 0, kZeroed},
    {FW_BIND_TEXELS, "texels", kPoolMeshTiles, 8 * kTileTexels, kComponentMeshes},
    {FW_BIND_NORMALS, "normals", kPoolMeshTiles, 4 * kTileTexels, kComponentMeshes},
    {FW_BIND_TILES, "tiles", kPoolMeshTiles, 32, kComponentMeshes},
    {FW_BIND_FLAME_CELLS, "cells of flames", kPoolMeshTiles, 4, kComponentMeshes},
    {FW_BIND_SLOWNESS, "slowness", kPoolSlowness, 2 * kTileTexels, kComponentMeshes},
    {FW_BIND_LINKS, "links", kPoolLinks, 32, kComponentMeshes},
    {FW_BIND_DEPENDENTS, "dependents", kPoolDependents, 4, kComponentMeshes},
    {kResourceVertices, "vertices", kPoolVertices, 48, kComponentMeshes,
     VK_BUFFER_USAGE_VERTEX_BUFFER_BIT},
    {kResourceIndices, "indices", kPoolIndices, 4, kComponentMeshes,
     VK_BUFFER_USAGE_INDEX_BUFFER_BIT},
    {FW_BIND_STATE, "state", kPoolObjectTiles, 4 * kTileTexels, kComponentObjects},
    {FW_BIND_PENDING, "pending", kPoolObjectTiles, 4 * kTileTexels, kComponentObjects},
    {FW_BIND_SETTLED, "settled", kPoolObjectTiles, 4 * kTileTexels / 8, kComponentObjects},
    {FW_BIND_TILE_STATE, "tile state", kPoolObjectTiles, sizeof(TileState), kComponentObjects, 0,
     kZeroed},
    {FW_BIND_FRONT_LISTS, "front lists", kPoolObjectTiles, 8, kComponentLists},
    {FW_BIND_RUN, "run list", kPoolObjectTiles, 16, kComponentLists, 0, kRefilled},
    {FW_BIND_SCRATCH, "scratch", kPoolObjectTiles, 6 * kTileTexels, kComponentLists, 0, kRefilled},
    {FW_BIND_MASKS, "masks", kPoolObjectTiles, 16, kComponentLists, 0, kRefilled},
    {FW_BIND_BURN_LISTS, "burn lists", kPoolObjectTiles, 8, kComponentLists},
    {FW_BIND_BURN_TILES, "burn tiles", kPoolObjectTiles, sizeof(BurnTile), kComponentLists},
    {FW_BIND_PREDICT, "predicted arrivals", kPoolObjectTiles, 4 * kTileTexels, kComponentPredict},
    {FW_BIND_GRADIENT, "gradient", kPoolObjectTiles, 4 * kTileTexels, kComponentPredict},
    {FW_BIND_PREDICT_LISTS, "predict lists", kPoolObjectTiles, 8, kComponentPredict},
    {FW_BIND_COUNTERS, "counters", kPoolIterations, sizeof(IterationCounters), kComponentLists,
     VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT, kZeroed},
    {FW_BIND_EVENTS, "events", kPoolEvents, sizeof(TexelEvent), kComponentLists, 0, kRefilled},
    {FW_BIND_WAKE_GROUPS, "wake groups", kPoolWakeGroups, 8, kComponentLists, 0, kRefilled},
    {FW_BIND_PROBES, "probes", kPoolProbes, 8, kComponentLists, 0, kRefilled},
    {FW_BIND_ANSWERS, "answers", kPoolProbes, sizeof(ProbeAnswer), kComponentLists, 0, kRefilled},
    {FW_BIND_EXTENSION_TILES, "extension tiles", kPoolExtensionTiles, 3 * 4 * kTileTexels,
     kComponentObjects},
    {FW_BIND_HEAT, "heat texels", kPoolHeat, 8 * kTileTexels, kComponentHeat},
    {FW_BIND_TILE_HEAT, "tile heat", kPoolObjectTiles, sizeof(TileHeat), kComponentHeat},
    {FW_BIND_HEAT_MATERIALS, "heat materials", kPoolObjects,
     sizeof(HeatMaterial) * kMaterialsPerObject, kComponentHeat},
    {FW_BIND_HOT_LISTS, "hot lists", kPoolObjectTiles, 8, kComponentHeat},
    {FW_BIND_TILE_FIRE, "tile fire", kPoolObjectTiles, 4, kComponentHeat},
    {FW_BIND_DEFORM_OBJECTS, "deforming objects", kPoolDeformers, sizeof(DeformObject),
     kComponentObjects},
    {FW_BIND_SHOWN, "shown vertices", kPoolShown, sizeof(ShownVertex), kComponentObjects,
     VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | kTexels},
    {FW_BIND_SOFT, "soft nodes", kPoolSoft, 16 * kSoftQuads, kComponentObjects, kTexels},
    {FW_BIND_DEFORM_PARTICLES, "sheet particles", kPoolSheetParticles, sizeof(DeviceParticle),
     kComponentMeshes, kTexels},
    {FW_BIND_DEFORM_EMBEDDINGS, "embeddings", kPoolEmbeddings, sizeof(DeformEmbedding),
     kComponentMeshes, kTexels},
    {FW_BIND_DEFORM_GROUPS, "deform groups", kPoolDeformGroups, 8, kComponentLists, 0, kRefilled},
    {FW_BIND_SKIN_SOURCES, "skin sources", kPoolSkinSources, 4, kComponentMeshes},
    {FW_BIND_SKIN_GIVEN, "skin vertices", kPoolSkinGiven, 4, kComponentObjects, 0, kRefilled},
    {FW_BIND_SKIN_TEXELS, "skin texels", kPoolSkin, 16 * kTileTexels, kComponentMeshes},
    {FW_BIND_EXCHANGE_OBJECTS, "exchange objects", kPoolObjects, sizeof(ExchangeObject),
     kComponentObjects, 0, kZeroed},
    {FW_BIND_EXCHANGE_TILES, "exchange tiles", kPoolMeshTiles, sizeof(ExchangeTile),
     kComponentMeshes},
    {FW_BIND_SOURCES, "fire sources", kPoolSources, sizeof(FireSource), kComponentObjects},
    {FW_BIND_RECEIVERS, "receivers", kPoolObjects, 4 * kReceiverWords, kComponentLists, 0,
     kRefilled},
    {FW_BIND_NEIGHBOURS, "neighbours", kPoolNeighbours, 4, kComponentObjects},
    {FW_BIND_CONTACTS, "contacts", kPoolContacts, sizeof(ContactLink), kComponentObjects},
    {FW_BIND_HEAT_OCCLUDERS, "occluders", kPoolFixed, sizeof(HeatOccluder) * kMaxHeatOccluders,
     kComponentObjects},
    {FW_BIND_HEAT_OCCLUSION, "heat occlusion", kPoolOcclusion, 4, kComponentObjects},
    {FW_BIND_ROOMS, "rooms", kPoolFixed, sizeof(Room) * kMaxRooms, kComponentObjects, 0, kZeroed},
    {FW_BIND_ROOM_AIR, "rooms' air", kPoolFixed, sizeof(RoomAir) * kMaxRooms, kComponentObjects, 0,
     kZeroed},
    {FW_BIND_LIGHTS, "lights", kPoolFixed, sizeof(BurnLight), kComponentFlames,
     VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, kZeroed},
    {FW_BIND_CLUSTERS, "clusters", kPoolFixed, 4, kComponentFlames, 0, kZeroed},
    {FW_BIND_FLAMES, "flame quads", kPoolFlames, sizeof(FlameQuad), kComponentFlames},
    {FW_BIND_DRAW_ARGS, "draw arguments", kPoolFlames, 8, kComponentFlames,
     VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT, kZeroed},
    {FW_BIND_EMITTERS, "emitters", kPoolEmitters, sizeof(ParticleEmitter), kComponentFlames, 0,
     kRefilled},
    {FW_BIND_EMITTER_GROUPS, "emitter groups", kPoolEmitterGroups, 8, kComponentFlames, 0,
     kRefilled},
    {FW_BIND_SPARKS, "spark sources", kPoolSparks, sizeof(SparkSource), kComponentFlames, kTexels,
     kRefilled},
    {FW_BIND_PARTICLES, "particles", kPoolParticles, sizeof(ParticleWords), kComponentFlames,
     kTexels},
    {FW_BIND_FLIPBOOKS, "flipbooks", kPoolFixed, 4 * kFlipbookWords, kComponentFlames},
    {FW_BIND_REFINE_OBJECTS, "refined objects", kPoolObjects, sizeof(RefineObject),
     kComponentRefine, 0, kZeroed},
    {FW_BIND_REFINE_DRAWS, "refined draws", kPoolObjects, 20 * kMaterialsPerObject,
     kComponentRefine, VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT},
    {FW_BIND_REFINE_TRIANGLES, "coarse triangles", kPoolRefineMeshTriangles, sizeof(RefineTriangle),
     kComponentRefine},
    {FW_BIND_REFINE_EDGES, "coarse edges", kPoolRefineMeshEdges, sizeof(RefineEdge),
     kComponentRefine},
    {FW_BIND_REFINE_SLOTS, "refined rest places", kPoolRefineMeshSlots, sizeof(RefineSlot),
     kComponentRefine},
    {FW_BIND_REFINE_WORDS, "refinement tables", kPoolRefineWords, 4, kComponentRefine},
    {FW_BIND_REFINE_ITEMS, "levels", kPoolRefineItems, sizeof(RefineLevel), kComponentRefine},
    {FW_BIND_REFINE_HEAT, "refinement heat", kPoolRefineItems, 4, kComponentRefine},
    {FW_BIND_REFINE_LEVELS, "triangle levels", kPoolRefineTriangles, 8, kComponentRefine},
    {FW_BIND_REFINE_VERTICES, "refined places", kPoolRefineSlots, sizeof(RefineVertex),
     kComponentRefine},
    {FW_BIND_REFINE_INDICES, "refined indices", kPoolRefineIndices, 4, kComponentRefine,
     VK_BUFFER_USAGE_INDEX_BUFFER_BIT},
    {FW_BIND_REFINE_CUTS, "cut vertices", kPoolRefineCuts, 48, kComponentRefine,
     VK_BUFFER_USAGE_VERTEX_BUFFER_BIT},
    {FW_BIND_REFINE_CUT_DRAWS, "cut draws", kPoolObjects, 16 * kMaterialsPerObject,
     kComponentRefine, VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT},
    {FW_BIND_EXTENSION_WORDS, "extension words", kPoolExtensionWords, 16, kComponentObjects},
    {FW_BIND_EXTENSION_GROUPS, "extension groups", kPoolExtensionGroups, 8, kComponentObjects, 0,
     kRefilled},
    {FW_BIND_REFINE_WORK, "refinement work", kPoolRefineWork, 4, kComponentRefine,
     VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT, kRefilled},
    {FW_BIND_VOLUMES, "volumes", kPoolVolumes, kVolumeFlameBytes, kComponentFlames,
     VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, kRefilled},
    {FW_BIND_BODIES, "bodies of fire", kPoolBodies, sizeof(FlameBody), kComponentFlames, 0,
     kRefilled},
    {FW_BIND_BODY_OF, "bodies by object", kPoolObjects, 4, kComponentFlames, 0, kRefilled},
    {FW_BIND_BODY_CELLS, "cells of bodies", kPoolBodies, 4 * kBodyCellWords* kBodyCells,
     kComponentFlames, 0, kRefilled},
    {FW_BIND_VOLUME_RAYS, "marched volumes", kPoolVolumeRays, 4, kComponentFlames, kTexels,
     kRefilled},
    {FW_BIND_VOLUME_WORK, "volumes' work", kPoolVolumes, sizeof(VolumeWork), kComponentFlames,
     VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT, kRefilled},
    {FW_BIND_FIELDS, "fields", kPoolFields, sizeof(FieldRecord), kComponentFlames},
    {FW_BIND_FIELD_COUNTERS, "field counters", kPoolFields, sizeof(FieldCounters),
     kComponentFlames},
    {FW_BIND_FIELD_CELLS, "field cells", kPoolFieldCells, 2 * 4 * kFieldUnit, kComponentFlames,
     kTexels},
    {FW_BIND_FIELD_MASKS, "field masks", kPoolFieldCells, kFieldUnit, kComponentFlames},
    {FW_BIND_FIELD_SHOWN, "field shown", kPoolFieldCells, 4 * kFieldUnit, kComponentFlames, 0,
     kRefilled},
    {FW_BIND_FIELD_DRAWS, "field draws", kPoolFieldDraws, sizeof(FieldDraw), kComponentFlames},
    {FW_BIND_FIELD_RUNS, "field runs", kPoolFieldRuns, 8, kComponentFlames, 0, kRefilled},
    {FW_BIND_APPEARANCES, "appearances", kPoolFixed, sizeof(MaterialAppearance), kComponentFlames,
     VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT},
};

// Units; of other pools 1.
constexpr std::pair<BufferPool, uint32_t> kInitialCapacities[] = {
    {kPoolObjects, 64},           {kPoolMeshTiles, 512},           {kPoolSlowness, 512},
    {kPoolLinks, 1024},           {kPoolDependents, 1024},         {kPoolVertices, 4096},
    {kPoolIndices, 16384},        {kPoolObjectTiles, 1024},        {kPoolIterations, kCounterRows},
    {kPoolEvents, 4096},          {kPoolWakeGroups, 1024},         {kPoolProbes, 1024},
    {kPoolSources, 1024},         {kPoolRefineMeshTriangles, 256}, {kPoolRefineMeshEdges, 256},
    {kPoolRefineMeshSlots, 1024}, {kPoolRefineWords, 1024},        {kPoolRefineItems, 512},
    {kPoolRefineTriangles, 256},  {kPoolRefineSlots, 1024},        {kPoolRefineIndices, 4096},
    {kPoolRefineCuts, 256},       {kPoolRefineWork, 256},          {kPoolVolumeRays, 4}};
constexpr uint32_t initialCapacity(BufferPool pool) noexcept {
    for (const auto& [of, units] : kInitialCapacities)
        if (of == pool) return units;
    return 1;
}

}  // namespace

void RetireQueue::push(uint64_t lastFrame, Retired resources) noexcept {
    if (!resources.buffer.handle && !resources.image.handle && !resources.pool &&
        !resources.framebuffer)
        return;
    FW_ASSERT(queue_.size() < queue_.capacity(), "%zu resources retire; promise reserves for them",
              queue_.size());
    resources.frameIndex = lastFrame;
    queue_.push_back(resources);
    if (promised_) --promised_;
}

void RetireQueue::collect(uint64_t completedFrame) noexcept {
    size_t kept = 0;
    for (Retired& one : queue_) {
        if (one.frameIndex > completedFrame) {
            queue_[kept++] = one;
            continue;
        }
        deviceMemory_.destroy(one.buffer);
        deviceMemory_.destroy(one.image);
        if (one.framebuffer) device_.destroy(device_.table.DestroyFramebuffer, one.framebuffer);
        if (one.pool) device_.destroy(device_.table.DestroyDescriptorPool, one.pool);
    }
    queue_.resize(kept);
}

WorldBuffers::WorldBuffers(Device& device, DeviceMemory& deviceMemory, RetireQueue& retired,
                           const WorldSizes& sizes, std::pmr::memory_resource* memory)
    : device_(device),
      deviceMemory_(deviceMemory),
      retired_(retired),
      pools_(memory),
      exact_(sizes.exact) {
    for (uint32_t pool = 0; pool < kPoolCount; ++pool) pools_.emplace_back(memory);
    for (const BufferRow& row : kBuffers) {
        Slot& slot = slots_[row.binding];
        slot.row = row;
        if (!device.texels) slot.row.extraUsage &= ~kTexels;
        if (row.binding == FW_BIND_LIGHTS) slot.row.stride *= std::max(1u, sizes.lights);
        if (row.binding == FW_BIND_CLUSTERS)
            slot.row.stride *= kClusterHeader + kClusterSlots * kClusterWords;
        if (row.binding == FW_BIND_APPEARANCES) slot.row.stride *= kAppearanceRows;
    }
    for (uint32_t view = 1; view < kMaxViews; ++view)
        for (size_t i = 0; i < kResourcesOfViews.size(); ++i) {
            BufferRow row = slots_[kResourcesOfViews[i]].row;
            row.binding = resourceOf(row.binding, view);
            row.pool = poolOf(row.pool, view);
            auto& name = viewNames_[(view - 1) * kResourcesOfViews.size() + i];
            std::snprintf(name.data(), name.size(), "%s, view %u", row.name, view + 1);
            row.name = name.data();
            slots_[row.binding].row = row;
        }
    try {
        for (uint32_t pool = 0; pool < kPoolOfViews; ++pool)
            resize(BufferPool(pool),
                   pool == kPoolFlames                 ? quadUnits(sizes.flames)
                   : exact_ && pool != kPoolIterations ? 1
                                                       : initialCapacity(BufferPool(pool)),
                   0);
    } catch (...) {
        for (Slot& slot : slots_) deviceMemory_.destroy(slot.now);
        throw;
    }
}

WorldBuffers::~WorldBuffers() {
    for (Slot& slot : slots_) {
        deviceMemory_.destroy(slot.now);
        deviceMemory_.destroy(slot.before);
    }
}

uint32_t WorldBuffers::limit(BufferPool pool) const noexcept {
    uint64_t units = 0xFFFFFFFEu;
    for (const Slot& slot : slots_) {
        if (!slot.row.stride || slot.row.pool != pool) continue;
        const VkPhysicalDeviceLimits& limits = device_.properties.limits;
        uint64_t bytes = limits.maxStorageBufferRange;
        if (slot.row.extraUsage & kTexels)
            bytes = std::min(bytes, uint64_t(limits.maxTexelBufferElements) * 16);
        units = std::min(units, bytes / slot.row.stride);
    }
    return uint32_t(units);
}

void WorldBuffers::resize(BufferPool pool, uint32_t units, uint64_t lastFrame) {
    std::array<Buffer, kResourceCount> fresh{};
    size_t made = 0;
    try {
        for (uint32_t i = 0; i < kResourceCount; ++i) {
            const BufferRow& row = slots_[i].row;
            if (!row.stride || row.pool != pool) continue;
            fresh[i] = deviceMemory_.createBuffer(
                uint64_t(row.stride) * units,
                VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                    VK_BUFFER_USAGE_TRANSFER_DST_BIT | row.extraUsage,
                MemoryKind::device, row.component, row.name);
            ++made;
        }
        retired_.promise(made);
        if (const uint32_t had = capacity(pool); units < had)
            pools_[pool].dropCapacity(had - units);
        else
            pools_[pool].addCapacity(units - had);
    } catch (...) {
        for (Buffer& buffer : fresh) deviceMemory_.destroy(buffer);
        throw;
    }
    for (uint32_t i = 0; i < kResourceCount; ++i) {
        if (!fresh[i].handle) continue;
        Slot& slot = slots_[i];
        if (!slot.recorded)
            deviceMemory_.destroy(slot.now);  // no frame ever saw it
        else if (slot.row.content != BufferRow::refilled)
            std::swap(slot.before, slot.now);
        else
            retired_.push(lastFrame, slot.now);
        slot.now = fresh[i];
        bytes_[i] = slot.now.size;
        slot.recorded = false;
        if (slot.before.handle) movesPending_ = true;
    }
    ++generation_;
}

BufferRange WorldBuffers::allocate(BufferPool pool, uint32_t units, uint64_t lastFrame) {
    const uint32_t first = allocateIn(pool, units, lastFrame);
    FW_ASSERT(uint64_t(first) + units <= pools_[pool].capacity(), "%u units from %u on", units,
              first);
    usedUnits_[pool] = uint32_t(pools_[pool].used());
    return {*this, pool, first, units};
}

uint32_t WorldBuffers::allocateIn(BufferPool pool, uint32_t units, uint64_t lastFrame) {
    RangeAllocator& ranges = pools_[pool];
    const uint64_t first = ranges.allocate(units);
    if (first != RangeAllocator::kNoRange) return uint32_t(first);
    const uint32_t had = capacity(pool), most = limit(pool);
    if (units > most || had > most - units)
        core::fail(FW_ERROR_OUT_OF_MEMORY,
                   "%u more units do not fit: %u are in use and the device's "
                   "maxStorageBufferRange of %u bytes holds %u.",
                   units, uint32_t(ranges.used()), device_.properties.limits.maxStorageBufferRange,
                   most);
    const uint32_t least = had + units - (exact_ ? uint32_t(ranges.freeAtEnd()) : 0);
    const auto doubled = uint32_t(std::min<uint64_t>(most, uint64_t(had) * 2));
    if (doubled > least && !exact_) {
        try {
            resize(pool, doubled, lastFrame);
            return uint32_t(ranges.allocate(units));
        } catch (const core::Error& error) {
            if (error.result != FW_ERROR_OUT_OF_MEMORY) throw;
        }
    }
    resize(pool, least, lastFrame);
    return uint32_t(ranges.allocate(units));
}

void WorldBuffers::release(BufferPool pool, uint32_t first, uint32_t units) noexcept {
    pools_[pool].release(first, units);
    usedUnits_[pool] = uint32_t(pools_[pool].used());
}

BufferRange::~BufferRange() {
    if (units_ > 0) buffers_->release(pool_, first_, units_);
}

void WorldBuffers::atLeast(BufferPool pool, uint32_t units, uint64_t lastFrame) {
    const uint32_t had = capacity(pool);
    if (units <= had) return;
    checkLimit(pool, units);
    const uint64_t doubled = exact_ ? units : std::max<uint64_t>(units, had * 2ull);
    resize(pool, uint32_t(std::min<uint64_t>(limit(pool), doubled)), lastFrame);
}

void WorldBuffers::checkLimit(BufferPool pool, uint32_t units) const {
    const uint32_t most = limit(pool);
    if (units > most)
        core::fail(FW_ERROR_OUT_OF_MEMORY,
                   "%u units in one frame do not fit: the device's maxStorageBufferRange of %u "
                   "bytes holds %u.",
                   units, device_.properties.limits.maxStorageBufferRange, most);
}

void WorldBuffers::fit(BufferPool pool, uint32_t units, bool shrinks, uint64_t lastFrame) {
    // Requests fluctuate and grow slowly: spare capacity avoids a reallocation for each.
    const uint32_t had = capacity(pool), spare = units / 8;
    if (units <= had && (!shrinks || had - units <= spare)) return;
    checkLimit(pool, units);
    const uint32_t room = shrinks || exact_ ? units : std::min(limit(pool), units + spare);
    resize(pool, std::max(room, 1u), lastFrame);
}

void WorldBuffers::makeView(uint32_t view, uint64_t lastFrame) {
    for (const BufferPool pool : {kPoolFlames, kPoolVolumeRays, kPoolVolumes})
        atLeast(poolOf(pool, view), exact_ ? 1 : initialCapacity(pool), lastFrame);
}

void WorldBuffers::dropView(uint32_t view, uint64_t lastFrame) {
    size_t made = 0;
    for (const uint32_t resource : kResourcesOfViews) {
        const Slot& slot = slots_[resourceOf(resource, view)];
        made += (slot.now.handle ? 1 : 0) + (slot.before.handle ? 1 : 0);
    }
    retired_.promise(made);
    for (const uint32_t resource : kResourcesOfViews) {
        Slot& slot = slots_[resourceOf(resource, view)];
        retired_.push(lastFrame, slot.now);
        retired_.push(lastFrame, slot.before);
        bytes_[resourceOf(resource, view)] = 0;
        slot.recorded = false;
    }
    for (const BufferPool pool : {kPoolFlames, kPoolVolumeRays, kPoolVolumes})
        if (const uint32_t units = capacity(poolOf(pool, view)))
            pools_[poolOf(pool, view)].dropCapacity(units);
}

uint64_t WorldBuffers::bytes(BufferPool pool) const noexcept {
    uint64_t all = 0;
    for (const Slot& slot : slots_)
        if (slot.row.stride && slot.row.pool == pool) all += slot.now.size;
    return all;
}

bool WorldBuffers::recordMoves(const Table& table, VkCommandBuffer commands, uint64_t frameIndex) {
    bool moved = false;
    for (Slot& slot : slots_) {
        const bool fresh = slot.now.handle && !slot.recorded;
        slot.recorded = slot.now.handle != VK_NULL_HANDLE;
        const uint64_t kept = std::min(slot.before.size, slot.now.size);
        if (fresh && slot.row.content == BufferRow::zeroed && kept < slot.now.size) {
            table.CmdFillBuffer(commands, slot.now.handle, kept, VK_WHOLE_SIZE, 0);
            moved = true;
        }
        if (!slot.before.handle) continue;
        const VkBufferCopy all{0, 0, kept};
        table.CmdCopyBuffer(commands, slot.before.handle, slot.now.handle, 1, &all);
        retired_.push(frameIndex, slot.before);  // resize reserved for it
        moved = true;
    }
    movesPending_ = false;
    return moved;
}

void WorldBuffers::rows(std::pmr::vector<MemoryRow>& out) const {
    for (uint32_t i = 0; i < kResourceCount; ++i) {
        const BufferRow& row = slots_[i].row;  // written by the constructor alone
        const uint64_t units = usedUnits_[row.pool], capacity = bytes_[i];
        if (!row.stride || capacity == 0) continue;
        out.push_back({row.name, units ? units * row.stride : capacity, capacity});
    }
}

}  // namespace fw::gpu::vk
