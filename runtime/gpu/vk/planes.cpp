#include "gpu/vk/planes.h"

#include "core/error.h"
#include "shared/book.h"
#include "shared/deform.h"
#include "shared/exchange.h"
#include "shared/field.h"
#include "shared/field_draw.h"
#include "shared/look.h"
#include "shared/refine.h"
#include "shared/room.h"
#include "shared/spark.h"
#include "shared/volume_draw.h"

#include <algorithm>

namespace fw::gpu::vk {
namespace {

constexpr uint32_t kCounterRows = kRowIteration + 64 * kMaxSubsteps + 1;  // one more to carry over

// Beside words: dropped where a device has too few texels.
constexpr VkBufferUsageFlags kTexels = VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT;

constexpr Plane kPlanes[] = {
    // resource, space, bytes of a unit, keep, component, name, usage
    {FW_BIND_OBJECTS, kSpaceObjects, sizeof(BurnObject), true, kComponentObjects, "object records",
     0},
    {FW_BIND_MATERIALS, kSpaceObjects, sizeof(BurnMaterial) * kMaterialsPerObject, true,
     kComponentObjects, "materials", 0},
    {FW_BIND_OBJECT_COUNTERS, kSpaceObjects, sizeof(ObjectCounters), true, kComponentObjects,
     "object counters", 0},
    {FW_BIND_TEXELS, kSpaceMeshTiles, 8 * kTileTexels, true, kComponentMeshes, "texels", 0},
    {FW_BIND_NORMALS, kSpaceMeshTiles, 4 * kTileTexels, true, kComponentMeshes, "normals", 0},
    {FW_BIND_TILES, kSpaceMeshTiles, 32, true, kComponentMeshes, "tiles", 0},
    {FW_BIND_SLOWNESS, kSpaceSlowness, 2 * kTileTexels, true, kComponentMeshes, "slowness", 0},
    {FW_BIND_LINKS, kSpaceLinks, 32, true, kComponentMeshes, "links", 0},
    {FW_BIND_READERS, kSpaceReaders, 4, true, kComponentMeshes, "readers", 0},
    {kResourceVertices, kSpaceVertices, 48, true, kComponentMeshes, "vertices",
     VK_BUFFER_USAGE_VERTEX_BUFFER_BIT},
    {kResourceIndices, kSpaceIndices, 4, true, kComponentMeshes, "indices",
     VK_BUFFER_USAGE_INDEX_BUFFER_BIT},
    {FW_BIND_STATE, kSpaceObjectTiles, 4 * kTileTexels, true, kComponentObjects, "state", 0},
    {FW_BIND_PENDING, kSpaceObjectTiles, 4 * kTileTexels, true, kComponentObjects, "pending", 0},
    {FW_BIND_SETTLED, kSpaceObjectTiles, 4 * kTileTexels / 8, true, kComponentObjects, "settled",
     0},
    {FW_BIND_TILE_STATE, kSpaceObjectTiles, sizeof(TileState), true, kComponentObjects,
     "tile state", 0},
    {FW_BIND_LIST_A, kSpaceObjectTiles, 4, true, kComponentLists, "front list A", 0},
    {FW_BIND_LIST_B, kSpaceObjectTiles, 4, true, kComponentLists, "front list B", 0},
    {FW_BIND_RUN, kSpaceObjectTiles, 16, false, kComponentLists, "run list", 0},
    {FW_BIND_SCRATCH, kSpaceObjectTiles, 6 * kTileTexels, false, kComponentLists, "scratch", 0},
    {FW_BIND_MASKS, kSpaceObjectTiles, 16, false, kComponentLists, "masks", 0},
    {FW_BIND_BURN_A, kSpaceObjectTiles, 4, true, kComponentLists, "burn list A", 0},
    {FW_BIND_BURN_B, kSpaceObjectTiles, 4, true, kComponentLists, "burn list B", 0},
    {FW_BIND_BURN_TILES, kSpaceObjectTiles, sizeof(BurnTile), true, kComponentLists, "burn tiles",
     0},
    {FW_BIND_PREDICT, kSpaceObjectTiles, 4 * kTileTexels, true, kComponentPredict,
     "predicted arrivals", 0},
    {FW_BIND_GRADIENT, kSpaceObjectTiles, 4 * kTileTexels, true, kComponentPredict, "gradient", 0},
    {FW_BIND_PREDICT_LIST_A, kSpaceObjectTiles, 4, true, kComponentPredict, "predict list A", 0},
    {FW_BIND_PREDICT_LIST_B, kSpaceObjectTiles, 4, true, kComponentPredict, "predict list B", 0},
    {FW_BIND_COUNTERS, kSpaceIterations, sizeof(IterationCounters), true, kComponentLists,
     "counters", VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT},
    {FW_BIND_EVENTS, kSpaceEvents, sizeof(TexelEvent), false, kComponentLists, "events", 0},
    {FW_BIND_WAKE_GROUPS, kSpaceWakeGroups, 8, false, kComponentLists, "wake groups", 0},
    {FW_BIND_PROBES, kSpaceProbes, 8, false, kComponentLists, "probes", 0},
    {FW_BIND_ANSWERS, kSpaceProbes, sizeof(ProbeAnswer), false, kComponentLists, "answers", 0},
    {FW_BIND_PUBLISHED, kSpacePublished, 3 * 4 * kTileTexels, true, kComponentObjects, "published",
     0},
    {FW_BIND_HEAT, kSpaceHeat, 8 * kTileTexels, true, kComponentHeat, "heat texels", 0},
    {FW_BIND_TILE_HEAT, kSpaceObjectTiles, sizeof(TileHeat), true, kComponentHeat, "tile heat", 0},
    {FW_BIND_HEAT_MATERIALS, kSpaceObjects, sizeof(HeatMaterial) * kMaterialsPerObject, true,
     kComponentHeat, "heat materials", 0},
    {FW_BIND_HOT_LISTS, kSpaceObjectTiles, 8, true, kComponentHeat, "hot lists", 0},
    {FW_BIND_TILE_FIRE, kSpaceObjectTiles, 4, true, kComponentHeat, "tile fire", 0},
    {FW_BIND_DEFORM_OBJECTS, kSpaceDeformers, sizeof(DeformObject), true, kComponentObjects,
     "deforming objects", 0},
    {FW_BIND_SHOWN, kSpaceShown, sizeof(ShownVertex), true, kComponentObjects, "shown vertices",
     VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | kTexels},
    {FW_BIND_SOFT, kSpaceSoft, 16 * kSoftQuads, true, kComponentObjects, "soft nodes", kTexels},
    {FW_BIND_DEFORM_NODES, kSpaceNodes, sizeof(DeviceNode), true, kComponentMeshes, "nodes",
     kTexels},
    {FW_BIND_DEFORM_COATS, kSpaceCoats, sizeof(DeformCoat), true, kComponentMeshes, "coats",
     kTexels},
    {FW_BIND_DEFORM_GROUPS, kSpaceDeformGroups, 8, false, kComponentLists, "deform groups", 0},
    {FW_BIND_SKIN_SOURCES, kSpaceSkinSources, 4, true, kComponentMeshes, "skin sources", 0},
    {FW_BIND_SKIN_GIVEN, kSpaceSkinGiven, 4, false, kComponentObjects, "skin vertices", 0},
    {FW_BIND_SKIN_TEXELS, kSpaceSkin, 16 * kTileTexels, true, kComponentMeshes, "skin texels", 0},
    {FW_BIND_REMOTE_OBJECTS, kSpaceObjects, sizeof(RemoteObject), true, kComponentObjects,
     "remote objects", 0},
    {FW_BIND_REMOTE_TILES, kSpaceMeshTiles, sizeof(RemoteTile), true, kComponentMeshes,
     "remote tiles", 0},
    {FW_BIND_SOURCES, kSpaceSources, sizeof(FireSource), true, kComponentObjects, "fire sources",
     0},
    {FW_BIND_RECEIVERS, kSpaceObjects, 4 * kReceiverWords, false, kComponentLists, "receivers", 0},
    {FW_BIND_NEIGHBOURS, kSpaceNeighbours, 4, true, kComponentObjects, "neighbours", 0},
    {FW_BIND_CONTACTS, kSpaceContacts, sizeof(ContactLink), true, kComponentObjects, "contacts", 0},
    {FW_BIND_BLOCKERS, kSpaceFixed, sizeof(Blocker) * kMaxBlockers, true, kComponentObjects,
     "blockers", 0},
    {FW_BIND_SHIELD, kSpaceShield, 4, true, kComponentObjects, "heat shield", 0},
    {FW_BIND_ROOMS, kSpaceFixed, sizeof(Room) * kMaxRooms, true, kComponentObjects, "rooms", 0},
    {FW_BIND_ROOM_AIR, kSpaceFixed, sizeof(RoomAir) * kMaxRooms, true, kComponentObjects,
     "rooms' air", 0},
    {FW_BIND_LIGHTS, kSpaceFixed, sizeof(BurnLight), true, kComponentFlames, "lights",
     VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT},
    {FW_BIND_LIGHT_CELLS, kSpaceFixed, 4, true, kComponentFlames, "light cells", 0},
    {FW_BIND_FLAMES, kSpaceFlames, sizeof(FlameQuad), true, kComponentFlames, "flame quads", 0},
    {FW_BIND_DRAW_ARGS, kSpaceFlames, 8, true, kComponentFlames, "draw arguments",
     VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT},
    {FW_BIND_EMITTERS, kSpaceEmitters, sizeof(ParticleEmitter), false, kComponentFlames, "emitters",
     0},
    {FW_BIND_EMITTER_GROUPS, kSpaceEmitterGroups, 8, false, kComponentFlames, "emitter groups", 0},
    {FW_BIND_SPARKS, kSpaceSparks, sizeof(SparkSource), false, kComponentFlames, "spark sources",
     kTexels},
    {FW_BIND_PARTICLES, kSpaceParticles, sizeof(ParticleWords), true, kComponentFlames, "particles",
     kTexels},
    {FW_BIND_BOOKS, kSpaceFixed, 4 * kBookWords, true, kComponentFlames, "flipbooks", 0},
    {FW_BIND_REFINE_OBJECTS, kSpaceObjects, sizeof(RefineObject), true, kComponentRefine,
     "refined objects", 0},
    {FW_BIND_REFINE_DRAWS, kSpaceObjects, 20 * kMaterialsPerObject, true, kComponentRefine,
     "refined draws", VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT},
    {FW_BIND_REFINE_TRIANGLES, kSpaceRefineMeshTriangles, sizeof(RefineTriangle), true,
     kComponentRefine, "coarse triangles", 0},
    {FW_BIND_REFINE_EDGES, kSpaceRefineMeshEdges, sizeof(RefineEdge), true, kComponentRefine,
     "coarse edges", 0},
    {FW_BIND_REFINE_SLOTS, kSpaceRefineMeshSlots, sizeof(RefineSlot), true, kComponentRefine,
     "refined rest places", 0},
    {FW_BIND_REFINE_WORDS, kSpaceRefineWords, 4, true, kComponentRefine, "refinement tables", 0},
    {FW_BIND_REFINE_ITEMS, kSpaceRefineItems, sizeof(RefineLevel), true, kComponentRefine, "levels",
     0},
    {FW_BIND_REFINE_HEAT, kSpaceRefineItems, 4, true, kComponentRefine, "refinement heat", 0},
    {FW_BIND_REFINE_LEVELS, kSpaceRefineTriangles, 8, true, kComponentRefine, "triangle levels", 0},
    {FW_BIND_REFINE_VERTICES, kSpaceRefineSlots, sizeof(RefineVertex), true, kComponentRefine,
     "refined places", 0},
    {FW_BIND_REFINE_INDICES, kSpaceRefineIndices, 4, true, kComponentRefine, "refined indices",
     VK_BUFFER_USAGE_INDEX_BUFFER_BIT},
    {FW_BIND_REFINE_CUTS, kSpaceRefineCuts, 48, true, kComponentRefine, "cut vertices",
     VK_BUFFER_USAGE_VERTEX_BUFFER_BIT},
    {FW_BIND_REFINE_CUT_DRAWS, kSpaceObjects, 16 * kMaterialsPerObject, true, kComponentRefine,
     "cut draws", VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT},
    {FW_BIND_ARP_LIST, kSpaceArpList, 4, true, kComponentRefine, "template triangles", 0},
    {FW_BIND_ARP_GROUPS, kSpaceArpGroups, 8, false, kComponentRefine, "template groups", 0},
    {FW_BIND_REFINE_WORK, kSpaceRefineWork, 4, false, kComponentRefine, "refinement work",
     VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT},
    {FW_BIND_VOLUMES, kSpaceVolumes, kVolumeFlameBytes, false, kComponentFlames, "volumes",
     VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT},
    {FW_BIND_VOLUME_RAYS, kSpaceVolumeRays, 4, false, kComponentFlames, "marched volumes", kTexels},
    {FW_BIND_VOLUME_WORK, kSpaceVolumes, sizeof(VolumeWork), false, kComponentFlames,
     "volumes' work", VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT},
    {FW_BIND_FIELDS, kSpaceFields, sizeof(FieldRecord), true, kComponentFlames, "fields", 0},
    {FW_BIND_FIELD_COUNTERS, kSpaceFields, sizeof(FieldCounters), true, kComponentFlames,
     "field counters", 0},
    {FW_BIND_FIELD_CELLS, kSpaceFieldCells, 2 * 4 * kFieldUnit, true, kComponentFlames,
     "field cells", kTexels},
    {FW_BIND_FIELD_MASKS, kSpaceFieldCells, kFieldUnit, true, kComponentFlames, "field masks", 0},
    {FW_BIND_FIELD_SHOWN, kSpaceFieldCells, 4 * kFieldUnit, false, kComponentFlames, "field shown",
     0},
    {FW_BIND_FIELD_DRAWS, kSpaceFieldDraws, sizeof(FieldDraw), true, kComponentFlames,
     "field draws", 0},
    {FW_BIND_FIELD_RUNS, kSpaceFieldRuns, 8, false, kComponentFlames, "field runs", 0},
    {FW_BIND_LOOKS, kSpaceFixed, sizeof(MaterialLook), true, kComponentFlames, "looks",
     VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT},
};

// Of the resources that views have for themselves, in their order.
constexpr const char* kNamesOfViews[kMaxViews - 1][kResourcesOfViews.size()] = {
    {"flame quads, view 2", "draw arguments, view 2", "marched volumes, view 2",
     "volumes' work, view 2"},
    {"flame quads, view 3", "draw arguments, view 3", "marched volumes, view 3",
     "volumes' work, view 3"},
    {"flame quads, view 4", "draw arguments, view 4", "marched volumes, view 4",
     "volumes' work, view 4"}};

constexpr uint32_t kInitialUnits[kSpaceCount] = {
    64,   1024, 512,  512, 1024, 1024, 4096, 16384, kCounterRows,
    4096, 1024, 1024, 256, 256,  1024, 1024, 512,   256,
    1024, 4096, 256,  256, 1,    1,    1,    1,     1,
    1,    1,    1,    1,   1,    1,    1,    1,     1024,
    1,    1,    1,    4,   1,    1,    1,    1,     1,
    1,    1,    1,    1,   1,    1};

}  // namespace

// --- RangeAllocator ---

void RangeAllocator::addCapacity(uint32_t units) {
    core::growTo(free_, pieces_ + 3);
    if (!free_.empty() && free_.back().first + free_.back().units == capacity_)
        free_.back().units += units;
    else
        free_.push_back({capacity_, units});
    capacity_ += units;
}

void RangeAllocator::dropCapacity(uint32_t units) noexcept {
    free_.back().units -= units;
    if (free_.back().units == 0) free_.pop_back();
    capacity_ -= units;
}

uint32_t RangeAllocator::allocate(uint32_t units) {
    for (size_t i = 0; i < free_.size(); ++i) {
        if (free_[i].units < units) continue;
        core::growTo(free_, pieces_ + 3);
        const uint32_t first = free_[i].first;
        free_[i].first += units;
        free_[i].units -= units;
        if (free_[i].units == 0) free_.erase(free_.begin() + std::ptrdiff_t(i));
        used_ += units;
        ++pieces_;
        return first;
    }
    return kNoRange;
}

void RangeAllocator::release(uint32_t first, uint32_t units) noexcept {
    auto at =
        std::lower_bound(free_.begin(), free_.end(), first,
                         [](const Range& range, uint32_t wanted) { return range.first < wanted; });
    at = free_.insert(at, {first, units});
    if (at + 1 != free_.end() && at->first + at->units == (at + 1)->first) {
        at->units += (at + 1)->units;
        free_.erase(at + 1);
    }
    if (at != free_.begin() && (at - 1)->first + (at - 1)->units == at->first) {
        (at - 1)->units += at->units;
        free_.erase(at);
    }
    used_ -= units;
    --pieces_;
}

// --- RetireQueue ---

void RetireQueue::add(const Retired& one) noexcept {
    queue_.push_back(one);  // room was promised
    if (promised_) --promised_;
}

void RetireQueue::push(uint64_t lastFrame, Buffer& buffer) noexcept {
    if (!buffer.handle) return;
    Retired one;
    one.frameIndex = lastFrame;
    one.buffer = buffer;
    add(one);
    buffer = {};
}

void RetireQueue::push(uint64_t lastFrame, Image& image) noexcept {
    if (!image.handle) return;
    Retired one;
    one.frameIndex = lastFrame;
    one.image = image;
    add(one);
    image = {};
}

void RetireQueue::push(uint64_t lastFrame, VkDescriptorPool pool) noexcept {
    if (!pool) return;
    Retired one;
    one.frameIndex = lastFrame;
    one.pool = pool;
    add(one);
}

void RetireQueue::pushFramebuffer(uint64_t lastFrame, VkFramebuffer framebuffer) noexcept {
    if (!framebuffer) return;
    Retired one;
    one.frameIndex = lastFrame;
    one.framebuffer = framebuffer;
    add(one);
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
        if (one.framebuffer)
            device_.table.DestroyFramebuffer(device_.handle, one.framebuffer,
                                             device_.allocationCallbacks);
        if (one.pool)
            device_.table.DestroyDescriptorPool(device_.handle, one.pool,
                                                device_.allocationCallbacks);
    }
    queue_.resize(kept);
}

// --- Planes ---

Planes::Planes(Device& device, DeviceMemory& deviceMemory, RetireQueue& retired,
               const WorldSizes& sizes, std::pmr::memory_resource* memory)
    : device_(device),
      deviceMemory_(deviceMemory),
      retired_(retired),
      spaces_(memory),
      exact_(sizes.exact) {
    for (uint32_t space = 0; space < kSpaceCount; ++space) spaces_.emplace_back(memory);
    for (const Plane& plane : kPlanes) {
        Slot& slot = slots_[plane.resource];
        slot.plane = plane;
        if (!device.texels) slot.plane.usage &= ~kTexels;
        if (plane.resource == FW_BIND_LIGHTS) slot.plane.unitBytes *= std::max(1u, sizes.lights);
        if (plane.resource == FW_BIND_LIGHT_CELLS)
            slot.plane.unitBytes *= kLightCellHeader + kLightCells * kLightCellWords;
        if (plane.resource == FW_BIND_LOOKS) slot.plane.unitBytes *= kLookRows;
    }
    for (uint32_t view = 1; view < kMaxViews; ++view)
        for (size_t i = 0; i < kResourcesOfViews.size(); ++i) {
            Plane plane = slots_[kResourcesOfViews[i]].plane;
            plane.resource = resourceOf(plane.resource, view);
            plane.space = spaceOf(plane.space, view);
            plane.name = kNamesOfViews[view - 1][i];
            slots_[plane.resource].plane = plane;
        }
    try {
        for (uint32_t space = 0; space < kSpaceOfViews; ++space)
            resize(Space(space),
                   space == kSpaceFlames                 ? quadUnits(sizes.flames)
                   : exact_ && space != kSpaceIterations ? 1
                                                         : kInitialUnits[space],
                   0);
    } catch (...) {
        for (Slot& slot : slots_) deviceMemory_.destroy(slot.now);
        throw;
    }
}

Planes::~Planes() {
    for (Slot& slot : slots_) {
        deviceMemory_.destroy(slot.now);
        deviceMemory_.destroy(slot.before);
    }
}

uint32_t Planes::limit(Space space) const noexcept {
    uint64_t units = 0xFFFFFFFEu;
    for (const Slot& slot : slots_) {
        if (!slot.plane.unitBytes || slot.plane.space != space) continue;
        const VkPhysicalDeviceLimits& limits = device_.properties.limits;
        uint64_t bytes = limits.maxStorageBufferRange;
        if (slot.plane.usage & kTexels)
            bytes = std::min(bytes, uint64_t(limits.maxTexelBufferElements) * 16);
        units = std::min(units, bytes / slot.plane.unitBytes);
    }
    return uint32_t(units);
}

void Planes::resize(Space space, uint32_t units, uint64_t lastFrame) {
    std::array<Buffer, kResourceCount> fresh{};
    size_t planes = 0;
    try {
        for (uint32_t i = 0; i < kResourceCount; ++i) {
            const Plane& plane = slots_[i].plane;
            if (!plane.unitBytes || plane.space != space) continue;
            fresh[i] = deviceMemory_.createBuffer(
                uint64_t(plane.unitBytes) * units,
                VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                    VK_BUFFER_USAGE_TRANSFER_DST_BIT | plane.usage,
                MemoryKind::device, plane.component, plane.name);
            ++planes;
        }
        retired_.promise(planes);
        if (const uint32_t had = spaces_[space].capacity(); units < had)
            spaces_[space].dropCapacity(had - units);
        else
            spaces_[space].addCapacity(units - had);
    } catch (...) {
        for (Buffer& buffer : fresh) deviceMemory_.destroy(buffer);
        throw;
    }
    for (uint32_t i = 0; i < kResourceCount; ++i) {
        if (!fresh[i].handle) continue;
        Slot& slot = slots_[i];
        if (!slot.recorded)
            deviceMemory_.destroy(slot.now);  // no frame ever saw it
        else if (slot.plane.keep)
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

uint32_t Planes::allocate(Space space, uint32_t units, uint64_t lastFrame) {
    const uint32_t first = allocateIn(space, units, lastFrame);
    usedUnits_[space] = spaces_[space].used();
    return first;
}

uint32_t Planes::allocateIn(Space space, uint32_t units, uint64_t lastFrame) {
    const uint32_t first = spaces_[space].allocate(units);
    if (first != RangeAllocator::kNoRange) return first;
    const uint32_t capacity = spaces_[space].capacity();
    const uint32_t most = limit(space);
    if (units > most || capacity > most - units)
        core::fail(FW_ERROR_OUT_OF_MEMORY,
                   "%u more units do not fit: %u are in use and the device's "
                   "maxStorageBufferRange of %u bytes holds %u.",
                   units, spaces_[space].used(), device_.properties.limits.maxStorageBufferRange,
                   most);
    const uint32_t least = capacity + units - (exact_ ? spaces_[space].freeAtEnd() : 0);
    const auto doubled = uint32_t(std::min<uint64_t>(most, uint64_t(capacity) * 2));
    if (doubled > least && !exact_) {
        try {
            resize(space, doubled, lastFrame);
            return spaces_[space].allocate(units);
        } catch (const core::Error& error) {
            if (error.result != FW_ERROR_OUT_OF_MEMORY) throw;
        }
    }
    resize(space, least, lastFrame);
    return spaces_[space].allocate(units);
}

void Planes::release(Space space, uint32_t first, uint32_t units) noexcept {
    spaces_[space].release(first, units);
    usedUnits_[space] = spaces_[space].used();
}

void Planes::atLeast(Space space, uint32_t units, uint64_t lastFrame) {
    const uint32_t capacity = spaces_[space].capacity();
    if (units <= capacity) return;
    checkLimit(space, units);
    const uint64_t doubled = exact_ ? units : std::max<uint64_t>(units, capacity * 2ull);
    resize(space, uint32_t(std::min<uint64_t>(limit(space), doubled)), lastFrame);
}

void Planes::checkLimit(Space space, uint32_t units) const {
    const uint32_t most = limit(space);
    if (units > most)
        core::fail(FW_ERROR_OUT_OF_MEMORY,
                   "%u units in one frame do not fit: the device's maxStorageBufferRange of %u "
                   "bytes holds %u.",
                   units, device_.properties.limits.maxStorageBufferRange, most);
}

void Planes::fit(Space space, uint32_t units, bool shrinks, uint64_t lastFrame) {
    // What is asked for sways, and it grows by and by.
    const uint32_t capacity = spaces_[space].capacity(), spare = units / 8;
    if (units <= capacity && (!shrinks || capacity - units <= spare)) return;
    checkLimit(space, units);
    const uint32_t room = shrinks || exact_ ? units : std::min(limit(space), units + spare);
    resize(space, std::max(room, 1u), lastFrame);
}

void Planes::makeView(uint32_t view, uint64_t lastFrame) {
    for (const Space space : {kSpaceFlames, kSpaceVolumeRays, kSpaceVolumes})
        atLeast(spaceOf(space, view), exact_ ? 1 : std::max(kInitialUnits[space], 1u), lastFrame);
}

void Planes::dropView(uint32_t view, uint64_t lastFrame) {
    size_t buffers = 0;
    for (const uint32_t resource : kResourcesOfViews) {
        const Slot& slot = slots_[resourceOf(resource, view)];
        buffers += (slot.now.handle ? 1 : 0) + (slot.before.handle ? 1 : 0);
    }
    retired_.promise(buffers);
    for (const uint32_t resource : kResourcesOfViews) {
        Slot& slot = slots_[resourceOf(resource, view)];
        retired_.push(lastFrame, slot.now);
        retired_.push(lastFrame, slot.before);
        bytes_[resourceOf(resource, view)] = 0;
        slot.recorded = false;
    }
    for (const Space space : {kSpaceFlames, kSpaceVolumeRays, kSpaceVolumes})
        if (const uint32_t units = capacity(spaceOf(space, view)))
            spaces_[spaceOf(space, view)].dropCapacity(units);
}

uint64_t Planes::bytes(Space space) const noexcept {
    uint64_t all = 0;
    for (const Slot& slot : slots_)
        if (slot.plane.unitBytes && slot.plane.space == space) all += slot.now.size;
    return all;
}

bool Planes::recordMoves(const Table& table, VkCommandBuffer commands, uint64_t frameIndex) {
    bool moved = false;
    for (Slot& slot : slots_) {
        slot.recorded = slot.now.handle != VK_NULL_HANDLE;
        if (!slot.before.handle) continue;
        const VkBufferCopy all{0, 0, std::min(slot.before.size, slot.now.size)};
        table.CmdCopyBuffer(commands, slot.before.handle, slot.now.handle, 1, &all);
        retired_.push(frameIndex, slot.before);  // room was reserved by resize
        moved = true;
    }
    movesPending_ = false;
    return moved;
}

void Planes::rows(std::pmr::vector<MemoryRow>& out) const {
    for (uint32_t i = 0; i < kResourceCount; ++i) {
        const Plane& plane = slots_[i].plane;  // written by the constructor alone
        const uint64_t units = usedUnits_[plane.space], capacity = bytes_[i];
        if (!plane.unitBytes || capacity == 0) continue;
        out.push_back({plane.name, units ? units * plane.unitBytes : capacity, capacity});
    }
}

}  // namespace fw::gpu::vk
