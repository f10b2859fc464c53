#include "gpu/vk/vk_backend.h"

#include "core/error.h"
#include "gpu/vk/world_state.h"
#include "mesh/bake.h"
#include "mesh/remote_tiles.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <tuple>

namespace fw::gpu::vk {
namespace {

constexpr uint32_t kTileTexels = 64;

uint32_t mipsOf(uint32_t width, uint32_t height) noexcept {
    uint32_t mips = 1;
    while (std::max(width, height) >> mips) ++mips;
    return mips;
}

// Box-filtered RGBA8 sRGB mips in linear light, appended one behind the other.
struct SrgbTable {
    float toLinear[256];
    SrgbTable() {
        for (int i = 0; i < 256; ++i) {
            const float s = float(i) / 255.0f;
            toLinear[i] = s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
        }
    }
    static std::byte fromLinear(float value) {
        const float s =
            value <= 0.0031308f ? value * 12.92f : 1.055f * std::pow(value, 1.0f / 2.4f) - 0.055f;
        return std::byte(std::clamp(int(s * 255.0f + 0.5f), 0, 255));
    }
};

void halveSrgb(const SrgbTable& table, const std::byte* from, uint32_t width, uint32_t height,
               std::byte* to) {
    const uint32_t w = std::max(width / 2, 1u), h = std::max(height / 2, 1u);
    for (uint32_t y = 0; y < h; ++y) {
        for (uint32_t x = 0; x < w; ++x) {
            const uint32_t x0 = std::min(x * 2, width - 1), x1 = std::min(x * 2 + 1, width - 1);
            const uint32_t y0 = std::min(y * 2, height - 1), y1 = std::min(y * 2 + 1, height - 1);
            const std::byte* taps[4] = {
                from + (size_t(y0) * width + x0) * 4, from + (size_t(y0) * width + x1) * 4,
                from + (size_t(y1) * width + x0) * 4, from + (size_t(y1) * width + x1) * 4};
            std::byte* out = to + (size_t(y) * w + x) * 4;
            for (int c = 0; c < 3; ++c) {
                float sum = 0;
                for (const std::byte* tap : taps) sum += table.toLinear[uint8_t(tap[c])];
                out[c] = SrgbTable::fromLinear(sum * 0.25f);
            }
            uint32_t alpha = 2;
            for (const std::byte* tap : taps) alpha += uint8_t(tap[3]);
            out[3] = std::byte(alpha / 4);
        }
    }
}

template <class T>
T& slotOf(std::pmr::vector<T>& table, uint32_t slot) {
    if (slot >= table.size()) table.resize(slot + 1);
    return table[slot];
}

}  // namespace

// --- Context ---

Context::Context(const FwVulkanHost* host, uint64_t gpuMemoryBudget,
                 std::pmr::memory_resource* memory, const core::Log& log)
    : memory_(memory) {
    state_ = std::pmr::polymorphic_allocator<>(memory).new_object<State>(host, gpuMemoryBudget,
                                                                         memory, log);
}

Context::~Context() { std::pmr::polymorphic_allocator<>(memory_).delete_object(state_); }

void Context::prepare() { state_->pipelines.prepare(); }
bool Context::ready() const noexcept { return state_->pipelines.ready(); }
FwTargetId Context::registerTarget(const FwVulkanTargetDef& def) {
    return state_->pipelines.registerTarget(def);
}
void Context::unregisterTarget(FwTargetId id) { state_->pipelines.unregisterTarget(id); }
void Context::notifyDeviceLost() noexcept { state_->device.notifyLost(); }
bool Context::deviceLost() const noexcept { return state_->device.lost(); }
bool Context::ownDevice() const noexcept { return state_->device.own; }

void Context::fillInfo(FwContextInfo& info) const noexcept {
    const Device& device = state_->device;
    info.apiVersion = device.apiVersion;
    info.ownDevice = device.own ? 1 : 0;
    info.gpuTimers = device.timestamps ? 1 : 0;
    info.debugLabels = device.debugUtils ? 1 : 0;
    info.gpuMemoryUsed = state_->deviceMemory.used();
    info.gpuMemoryBudget = state_->deviceMemory.budget();
    std::strncpy(info.deviceName, device.properties.deviceName, sizeof info.deviceName - 1);
    info.deviceName[sizeof info.deviceName - 1] = 0;
}

void Context::wishes(FwVulkanWishes& wishes) noexcept {
    static constexpr const char* kInstanceExtensions[] = {"VK_EXT_debug_utils"};
    wishes.minimumApiVersion = VK_API_VERSION_1_0;
    wishes.extensionCount = 0;
    wishes.extensions = nullptr;
    wishes.instanceExtensionCount = 1;
    wishes.instanceExtensions = kInstanceExtensions;
    wishes.features = {};
    wishes.features.independentBlend = VK_TRUE;
    wishes.queueFlags = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
}

// --- VkBackend::State ---

VkBackend::State::State(Context::State& contextState, const WorldLimits& worldLimits,
                        std::pmr::memory_resource* pmr, const core::Log& logTo)
    : context(contextState),
      device(contextState.device),
      deviceMemory(contextState.deviceMemory),
      limits(worldLimits),
      memory(pmr),
      log(logTo),
      retired(device, deviceMemory, pmr),
      ring(device),
      planes(device, deviceMemory, retired,
             {std::max(worldLimits.maxLights, kSurfaceLights),
              std::clamp(worldLimits.maxFlames, 1u, kFlameCapacity), worldLimits.exactBuffers},
             pmr),
      sets(device, contextState.pipelines, retired, pmr),
      meshes(pmr),
      objects(pmr),
      images(pmr),
      uploads(pmr),
      quarantine(pmr),
      skins(pmr),
      published(pmr),
      drawItems(pmr),
      refine(pmr),
      givenObjects(pmr),
      givenAnswers(pmr),
      givenTexels(pmr),
      givenHeat(pmr),
      givenMaps(pmr),
      givenLights(pmr),
      times(pmr) {
    times.reserve(computePasses().size() + drawPasses().size());
    const auto alignment = uint32_t(device.properties.limits.minUniformBufferOffsetAlignment);
    viewStride = uint32_t((sizeof(ViewParams) + alignment - 1) / alignment * alignment);
    views = deviceMemory.createBuffer(
        uint64_t(viewStride) * FrameRing::kMaxInFlight * FrameRing::kMaxViews,
        VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, MemoryKind::upload, kComponentStaging, "views");
    try {
        std::byte whitePixel[4];
        std::fill(std::begin(whitePixel), std::end(whitePixel), std::byte(255));
        addImage(white, 1, 1, 1, 1, VK_FORMAT_R8G8B8A8_UNORM, whitePixel, "white");
        if (!limits.looks.textures.empty())
            addImage(lookTextures, 512, 512, kLookTextureLayers, 10, VK_FORMAT_R8G8B8A8_UNORM,
                     limits.looks.textures, "look textures");
        uploadRefineTable();
        if (!limits.looks.table.empty()) {
            PendingUpload& upload = stage(limits.looks.table.size_bytes(), "looks");
            std::memcpy(upload.staging.mapped, limits.looks.table.data(),
                        limits.looks.table.size_bytes());
            upload.regions[upload.regionCount++] = {
                FW_BIND_LOOKS, 0, 0,
                std::min<uint64_t>(limits.looks.table.size_bytes(),
                                   planes.buffer(FW_BIND_LOOKS).size)};
        }
    } catch (...) {
        for (PendingUpload& upload : uploads) deviceMemory.destroy(upload.staging);
        for (ImageEntry* entry : {&white, &lookTextures}) {
            deviceMemory.destroy(entry->image);
            device.table.DestroyDescriptorPool(device.handle, entry->set.pool,
                                               device.allocationCallbacks);
        }
        deviceMemory.destroy(views);
        throw;
    }
    limits.looks.table = {};
    limits.looks.textures = {};
}

VkBackend::State::~State() {
    const Table& vk = device.table;
    const VkAllocationCallbacks* callbacks = device.allocationCallbacks;
    for (PendingUpload& upload : uploads) deviceMemory.destroy(upload.staging);
    const auto drop = [&](ImageEntry& entry) {
        deviceMemory.destroy(entry.image);
        vk.DestroyDescriptorPool(device.handle, entry.set.pool, callbacks);
    };
    for (ImageEntry& entry : images) drop(entry);
    drop(white);
    drop(lookTextures);
    for (FrameInFlight& slot : ring.slots()) {
        deviceMemory.destroy(slot.upload);
        deviceMemory.destroy(slot.readback);
        slot.timers.destroy(device);
        ring.dropFramebuffers(slot);
        vk.DestroyDescriptorPool(device.handle, slot.depthPool, callbacks);
    }
    destroyFramebuffers();
    deviceMemory.destroy(views);
    dropOffscreen();
    vk.DestroyRenderPass(device.handle, own.clearPass, callbacks);
    vk.DestroyFence(device.handle, own.fence, callbacks);
    vk.DestroyCommandPool(device.handle, own.pool, callbacks);
}

void VkBackend::State::failIfLost() const {
    if (device.lost())
        core::fail(FW_ERROR_DEVICE_LOST, "The Vulkan device is lost; nothing more is recorded.");
}

PendingUpload& VkBackend::State::stage(uint64_t bytes, const char* name) {
    uploads.reserve(uploads.size() + 1);
    retired.promise(1);
    PendingUpload upload;
    upload.staging = deviceMemory.createBuffer(bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                               MemoryKind::upload, kComponentStaging, name);
    uploads.push_back(upload);
    return uploads.back();
}

void VkBackend::State::addImage(ImageEntry& entry, uint32_t width, uint32_t height, uint32_t layers,
                                uint32_t mips, VkFormat format, std::span<const std::byte> pixels,
                                const char* name) {
    retired.promise(2);
    auto info = typed<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {width, height, 1};
    info.mipLevels = mips;
    info.arrayLayers = layers;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    info.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    ImageEntry fresh;
    fresh.image = deviceMemory.createImage(info, VK_IMAGE_ASPECT_COLOR_BIT, kComponentImages, name);
    try {
        fresh.set = makeImageSet(device, context.pipelines, fresh.image.view);
        PendingUpload& upload = stage(pixels.size(), name);
        std::memcpy(upload.staging.mapped, pixels.data(), pixels.size());
        upload.image = fresh.image.handle;
        upload.width = width;
        upload.height = height;
        upload.mips = mips;
        upload.layers = layers;
    } catch (...) {
        device.table.DestroyDescriptorPool(device.handle, fresh.set.pool,
                                           device.allocationCallbacks);
        deviceMemory.destroy(fresh.image);
        throw;
    }
    fresh.live = true;
    entry = fresh;
}

void VkBackend::State::freeQuarantine() noexcept {
    size_t kept = 0;
    for (const Quarantined& one : quarantine) {
        const bool passed = (frontWalks > one.frontWalks || frontEmpty) &&
                            (burnWalks > one.burnWalks || burnEmpty) &&
                            (predictWalks > one.predictWalks || predictEmpty) &&
                            (hotWalks > one.hotWalks || hotEmpty);
        if (passed)
            planes.release(kSpaceObjectTiles, one.tiles.first, one.tiles.units);
        else
            quarantine[kept++] = one;
    }
    quarantine.resize(kept);
}

// --- VkBackend ---

VkBackend::VkBackend(Context& context, const WorldLimits& limits, std::pmr::memory_resource* memory,
                     const core::Log& log)
    : memory_(memory) {
    state_ = std::pmr::polymorphic_allocator<>(memory).new_object<State>(context.state(), limits,
                                                                         memory, log);
}

VkBackend::~VkBackend() { std::pmr::polymorphic_allocator<>(memory_).delete_object(state_); }

namespace {

uint32_t materialOf(const mesh::BurnDomain& domain, size_t corner) {
    return std::min(domain.vertices[domain.indices[corner]].material, kMaterialsPerObject - 1);
}

// Where the runs of each material end, and how large triangles are.
void measureDrawn(const mesh::BurnDomain& domain, MeshEntry& entry) {
    double area = 0;
    for (size_t i = 0; i + 2 < domain.indices.size(); i += 3) {
        glm::dvec3 p[3];
        for (size_t k = 0; k < 3; ++k) {
            const auto& at = domain.vertices[domain.indices[i + k]].position;
            p[k] = {at[0], at[1], at[2]};
        }
        area += glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));  // of two
        entry.materialEnd[materialOf(domain, i)] += 3;
    }
    for (uint32_t m = 1; m < kMaterialsPerObject; ++m)
        entry.materialEnd[m] += entry.materialEnd[m - 1];
    if (entry.indices >= 3) entry.edge = float(std::sqrt(area / double(entry.indices / 3)));
}

// The bits of `v` at even places.
uint32_t spread(uint32_t v) {
    v = (v | v << 8) & 0x00FF00FFu;
    v = (v | v << 4) & 0x0F0F0F0Fu;
    v = (v | v << 2) & 0x33333333u;
    return (v | v << 1) & 0x55555555u;
}

// Triangles by material, then along a space-filling curve over the atlas; vertices as they come.
// Neighbours share vertices, so devices shade each vertex about once, whatever order hosts give.
struct DrawnOrder {
    std::pmr::vector<uint32_t> triangles;  // first corner of each
    std::pmr::vector<uint32_t> vertices;   // old number by new
    std::pmr::vector<uint32_t> numbers;    // new by old

    DrawnOrder(const mesh::BurnDomain& domain, std::pmr::memory_resource* memory)
        : triangles(memory), vertices(memory), numbers(domain.vertices.size(), ~0u, memory) {
        struct Key {
            uint32_t material, curve, corner;
        };
        std::pmr::vector<Key> keys(memory);
        keys.reserve(domain.indices.size() / 3);
        for (uint32_t i = 0; i + 2 < domain.indices.size(); i += 3) {
            float at[2] = {};
            for (uint32_t k = 0; k < 3; ++k) {
                const mesh::RenderVertex& v = domain.vertices[domain.indices[i + k]];
                for (uint32_t c = 0; c < 2; ++c) at[c] += v.atlasUv[c] * 2.0f;
            }
            const auto cell = [](float x) { return uint32_t(std::clamp(x, 0.0f, 65535.0f)); };
            keys.push_back(
                {materialOf(domain, i), spread(cell(at[0])) | spread(cell(at[1])) << 1, i});
        }
        std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
            return std::tie(a.material, a.curve, a.corner) <
                   std::tie(b.material, b.curve, b.corner);
        });
        triangles.reserve(keys.size());
        vertices.reserve(domain.vertices.size());
        const auto number = [&](uint32_t vertex) {
            if (numbers[vertex] != ~0u) return;
            numbers[vertex] = uint32_t(vertices.size());
            vertices.push_back(vertex);
        };
        for (const Key& key : keys) {
            triangles.push_back(key.corner);
            for (uint32_t k = 0; k < 3; ++k) number(domain.indices[key.corner + k]);
        }
        for (uint32_t i = 0; i < domain.vertices.size(); ++i) number(i);
    }

    void copyIndices(const mesh::BurnDomain& domain, std::byte* out) const {
        for (const uint32_t corner : triangles) {
            for (uint32_t k = 0; k < 3; ++k, out += 4)
                std::memcpy(out, &numbers[domain.indices[corner + k]], 4);
        }
    }
    void copyVertices(const mesh::BurnDomain& domain, std::byte* out) const {
        for (const uint32_t old : vertices) {
            std::memcpy(out, &domain.vertices[old], sizeof(mesh::RenderVertex));
            out += sizeof(mesh::RenderVertex);
        }
    }
};

// Records of a mesh that deforms, with vertices as the device numbers them.
void stageDeformModel(VkBackend::State& s, const mesh::BurnDomain& domain,
                      const mesh::DeformModel& model, uint32_t firstNode, uint32_t firstCoat) {
    const DrawnOrder order(domain, s.memory);
    const uint64_t nodeBytes = model.nodes.size() * sizeof(DeformNode);
    const uint64_t coatBytes = model.coats.size() * sizeof(DeformCoat);
    PendingUpload& upload = s.stage(nodeBytes + coatBytes, "deformation staging");
    const auto number = [&](uint32_t& vertex) {
        if (vertex != kNoneTexel) vertex = order.numbers[vertex];
    };
    std::byte* to = upload.staging.mapped;
    for (uint32_t i = 0; i < model.nodes.size(); ++i) {
        DeformNode node = mesh::deviceNode(model, i);
        number(node.vertex);
        std::memcpy(to, &node, sizeof node);
        to += sizeof node;
    }
    for (const uint32_t old : order.vertices) {
        DeformCoat coat = model.coats[old];
        number(coat.node);
        for (uint32_t& vertex : coat.ring) number(vertex);
        std::memcpy(to, &coat, sizeof coat);
        to += sizeof coat;
    }
    upload.regions[0] = {FW_BIND_DEFORM_NODES, 0, uint64_t(firstNode) * sizeof(DeformNode),
                         nodeBytes};
    upload.regions[1] = {FW_BIND_DEFORM_COATS, nodeBytes, uint64_t(firstCoat) * sizeof(DeformCoat),
                         coatBytes};
    upload.regionCount = 2;
}

// Where each texel is on its triangle.
void stageSkinTexels(VkBackend::State& s, const mesh::BurnDomain& domain, const DrawnOrder& order,
                     uint32_t firstTile, uint32_t firstSource) {
    const uint64_t bytes = uint64_t(domain.texelCount()) * sizeof(uvec4);
    const uint64_t sourceBytes = order.vertices.size() * 4;
    PendingUpload& upload = s.stage(bytes + sourceBytes, "skin staging");
    for (size_t i = 0; i < order.vertices.size(); ++i)
        std::memcpy(upload.staging.mapped + bytes + i * 4, &domain.sources[order.vertices[i]], 4);
    upload.regions[upload.regionCount++] = {FW_BIND_SKIN_SOURCES, bytes, uint64_t(firstSource) * 4,
                                            sourceBytes};
    for (uint32_t i = 0; i < domain.texelCount(); ++i) {
        uvec4 record{0, 0, 0, 0};
        if (domain.triangleOf[i] != mesh::kNone) {
            uint32_t number[3];
            for (uint32_t k = 0; k < 3; ++k)
                number[k] = order.numbers[domain.indices[size_t(domain.triangleOf[i]) * 3 + k]];
            float weights[3];
            mesh::texelWeights(domain, i, weights);
            const auto unorm = [](float w) { return uint32_t(w * 65535.0f + 0.5f); };
            record = {number[0], number[1], number[2], unorm(weights[0]) | unorm(weights[1]) << 16};
        }
        std::memcpy(upload.staging.mapped + size_t(i) * sizeof record, &record, sizeof record);
    }
    upload.regions[upload.regionCount++] = {
        FW_BIND_SKIN_TEXELS, 0, uint64_t(firstTile) * kTileTexels * sizeof(uvec4), bytes};
}

// A skinned object's vertices at rest: kept here, and on their way to the device.
void stageSkin(VkBackend::State& s, const mesh::BurnDomain& domain, const DrawnOrder& order,
               Skin& skin, uint32_t firstShown) {
    skin.shown.assign(domain.vertices.size(), ShownVertex{});
    skin.sources.resize(domain.vertices.size());
    for (size_t i = 0; i < order.vertices.size(); ++i) {
        const mesh::RenderVertex& v = domain.vertices[order.vertices[i]];
        skin.shown[i].x = v.position[0];
        skin.shown[i].y = v.position[1];
        skin.shown[i].z = v.position[2];
        skin.shown[i].normal = v.normal;
        skin.sources[i] = domain.sources[order.vertices[i]];
    }
    const uint64_t bytes = skin.shown.size() * sizeof(ShownVertex);
    PendingUpload& upload = s.stage(bytes, "skin staging");
    std::memcpy(upload.staging.mapped, skin.shown.data(), bytes);
    upload.regions[upload.regionCount++] = {FW_BIND_SHOWN, 0,
                                            uint64_t(firstShown) * sizeof(ShownVertex), bytes};
}

// All of an object's but its tiles, which lists may still name.
void releaseRanges(VkBackend::State& s, const ObjectEntry& entry) noexcept {
    if (entry.slowness.units)
        s.planes.release(kSpaceSlowness, entry.slowness.first, entry.slowness.units);
    if (entry.published.units)
        s.planes.release(kSpacePublished, entry.published.first, entry.published.units);
    if (entry.heatTiles.units)
        s.planes.release(kSpaceHeat, entry.heatTiles.first, entry.heatTiles.units);
    if (entry.sources.units)
        s.planes.release(kSpaceSources, entry.sources.first, entry.sources.units);
    if (entry.deformer.units)
        s.planes.release(kSpaceDeformers, entry.deformer.first, entry.deformer.units);
    if (entry.soft.units) s.planes.release(kSpaceSoft, entry.soft.first, entry.soft.units);
    if (entry.shown.units) s.planes.release(kSpaceShown, entry.shown.first, entry.shown.units);
    if (entry.skinPlus1) {
        s.skins[entry.skinPlus1 - 1].shown.clear();
        Skin& skin = s.skins[entry.skinPlus1 - 1];
        skin.dirty = skin.givenDue = false;
        if (skin.words.units) s.planes.release(kSpaceSkinGiven, skin.words.first, skin.words.units);
        skin.words = {};
    }
}

}  // namespace

void VkBackend::createMesh(uint32_t slot, const mesh::BurnDomain& domain) {
    State& s = *state_;
    const uint64_t last = s.ring.newest();
    MeshEntry& entry = slotOf(s.meshes, slot);
    MeshEntry fresh;
    fresh.live = true;
    fresh.width = domain.width;
    fresh.height = domain.height;
    fresh.tilesX = domain.tilesX;
    fresh.tiles = domain.tileCount();
    fresh.vertices = uint32_t(domain.vertices.size());
    fresh.indices = uint32_t(domain.indices.size());
    fresh.domain = &domain;
    measureDrawn(domain, fresh);
    std::pmr::vector<RemoteTile> remoteTiles(s.memory);
    fresh.sourceCells = mesh::remoteTiles(domain, remoteTiles);
    const DrawnOrder order(domain, s.memory);
    const size_t uploadsBefore = s.uploads.size();
    const struct {
        RangeOf* range;
        Space space;
        uint32_t units;
    } wanted[] = {
        {&fresh.meshTiles, kSpaceMeshTiles, fresh.tiles},
        {&fresh.slowness, kSpaceSlowness, fresh.tiles},
        {&fresh.links, kSpaceLinks, std::max(1u, uint32_t(domain.links.size() / 8))},
        {&fresh.readers, kSpaceReaders, std::max(1u, uint32_t(domain.readers.size()))},
        {&fresh.vertexRange, kSpaceVertices, std::max(1u, fresh.vertices)},
        {&fresh.indexRange, kSpaceIndices, std::max(1u, fresh.indices)},
    };
    try {
        for (const auto& one : wanted) {
            one.range->first = s.planes.allocate(one.space, one.units, last);
            one.range->units = one.units;
        }
        const struct {
            uint32_t resource;
            const void* data;
            uint64_t bytes, at;
        } parts[] = {
            {FW_BIND_TEXELS, domain.texels.data(), domain.texels.size() * 8,
             uint64_t(fresh.meshTiles.first) * kTileTexels * 8},
            {FW_BIND_NORMALS, domain.normals.data(), domain.normals.size() * 4,
             uint64_t(fresh.meshTiles.first) * kTileTexels * 4},
            {FW_BIND_TILES, domain.tiles.data(), domain.tiles.size() * 32,
             uint64_t(fresh.meshTiles.first) * 32},
            {FW_BIND_REMOTE_TILES, remoteTiles.data(), remoteTiles.size() * sizeof(RemoteTile),
             uint64_t(fresh.meshTiles.first) * sizeof(RemoteTile)},
            {FW_BIND_SLOWNESS, domain.slowness.data(), domain.slowness.size() * 2,
             uint64_t(fresh.slowness.first) * kTileTexels * 2},
            {FW_BIND_LINKS, domain.links.data(), domain.links.size() * 4,
             uint64_t(fresh.links.first) * 32},
            {FW_BIND_READERS, domain.readers.data(), domain.readers.size() * 4,
             uint64_t(fresh.readers.first) * 4},
            {kResourceVertices, domain.vertices.data(), domain.vertices.size() * 48,
             uint64_t(fresh.vertexRange.first) * 48},
            {kResourceIndices, domain.indices.data(), domain.indices.size() * 4,
             uint64_t(fresh.indexRange.first) * 4},
        };
        static_assert(std::size(parts) <= PendingUpload::kMaxRegions);
        uint64_t bytes = 0;
        for (const auto& part : parts) bytes += part.bytes;
        PendingUpload& upload = s.stage(bytes, "mesh staging");
        uint64_t from = 0;
        for (const auto& part : parts) {
            if (part.bytes == 0) continue;
            if (part.resource == kResourceIndices)
                order.copyIndices(domain, upload.staging.mapped + from);
            else if (part.resource == kResourceVertices)
                order.copyVertices(domain, upload.staging.mapped + from);
            else
                std::memcpy(upload.staging.mapped + from, part.data, part.bytes);
            upload.regions[upload.regionCount++] = {part.resource, from, part.at, part.bytes};
            from += part.bytes;
        }
    } catch (...) {
        for (const auto& one : wanted) {
            if (one.range->units) s.planes.release(one.space, one.range->first, one.range->units);
        }
        while (s.uploads.size() > uploadsBefore) {
            s.deviceMemory.destroy(s.uploads.back().staging);
            s.uploads.pop_back();
        }
        throw;
    }
    entry = fresh;
}

void VkBackend::destroyMesh(uint32_t slot) noexcept {
    State& s = *state_;
    MeshEntry& entry = s.meshes[slot];
    if (!entry.live) return;
    // Ranges are reused at once: all our work is in one queue's order, behind barriers.
    s.planes.release(kSpaceMeshTiles, entry.meshTiles.first, entry.meshTiles.units);
    s.planes.release(kSpaceSlowness, entry.slowness.first, entry.slowness.units);
    s.planes.release(kSpaceLinks, entry.links.first, entry.links.units);
    s.planes.release(kSpaceReaders, entry.readers.first, entry.readers.units);
    s.planes.release(kSpaceVertices, entry.vertexRange.first, entry.vertexRange.units);
    s.planes.release(kSpaceIndices, entry.indexRange.first, entry.indexRange.units);
    for (RefineMesh& one : entry.refine)
        if (one.live) one.release(s.planes);
    if (entry.nodes.units) s.planes.release(kSpaceNodes, entry.nodes.first, entry.nodes.units);
    if (entry.coats.units) s.planes.release(kSpaceCoats, entry.coats.first, entry.coats.units);
    if (entry.skin.units) s.planes.release(kSpaceSkin, entry.skin.first, entry.skin.units);
    if (entry.skinSources.units)
        s.planes.release(kSpaceSkinSources, entry.skinSources.first, entry.skinSources.units);
    entry = {};
}

void VkBackend::createObject(uint32_t slot, const ObjectInit& init) {
    State& s = *state_;
    const uint64_t last = s.ring.newest();
    MeshEntry& mesh = s.meshes[init.mesh];
    RangeOf nodes = mesh.nodes, coats = mesh.coats, skin = mesh.skin, sources = mesh.skinSources;
    const size_t uploadsBefore = s.uploads.size();
    ObjectEntry fresh;
    fresh.live = true;
    fresh.mesh = init.mesh;
    fresh.record = init.record;
    try {
        s.quarantine.reserve(s.quarantine.size() + s.liveObjects + 1);
        s.drawItems.reserve((s.liveObjects + 1) * kMaterialsPerObject);
        s.published.reserve(s.liveObjects + 1);
        s.givenObjects.reserve(std::max<size_t>(slot + 1, s.objects.size()));
        (void)slotOf(s.objects, slot);
        s.planes.atLeast(kSpaceObjects, slot + 1, last);
        s.freeQuarantine();
        fresh.tiles = {s.planes.allocate(kSpaceObjectTiles, mesh.tiles, last), mesh.tiles};
        if (init.refine) {
            fresh.refine.on = true;
            fresh.refine.depth = init.refineDepth;
            fresh.refine.pixelsPerEdge = init.refinePixelsPerEdge;
            fresh.refine.epochTick = s.shownTick;
            fresh.refine.allocate(s.planes, mesh.refine[init.refineDepth], last);
        }
        if (!init.slowness.empty()) {
            fresh.slowness = {s.planes.allocate(kSpaceSlowness, mesh.tiles, last), mesh.tiles};
            PendingUpload& upload = s.stage(init.slowness.size_bytes(), "slowness staging");
            std::memcpy(upload.staging.mapped, init.slowness.data(), init.slowness.size_bytes());
            upload.regions[upload.regionCount++] = {
                FW_BIND_SLOWNESS, 0, uint64_t(fresh.slowness.first) * kTileTexels * 2,
                init.slowness.size_bytes()};
        }
        if (init.record.flags & kObjectPublished)
            fresh.published = {s.planes.allocate(kSpacePublished, mesh.tiles, last), mesh.tiles};
        fresh.sources = {s.planes.allocate(kSpaceSources, mesh.sourceCells, last),
                         mesh.sourceCells};
        if (!init.heat.empty())
            fresh.heatTiles = {s.planes.allocate(kSpaceHeat, mesh.tiles, last), mesh.tiles};
        if (init.deform) {
            const mesh::DeformModel& model = *init.deformModel;
            fresh.deformer = {s.planes.allocate(kSpaceDeformers, 1, last), 1};
            const auto count = uint32_t(model.nodes.size());
            if (init.deform->flags & (kDeformShell | kDeformSprings))
                fresh.soft = {s.planes.allocate(kSpaceSoft, count, last), count};
            fresh.shown = {s.planes.allocate(kSpaceShown, mesh.vertices, last), mesh.vertices};
            if (nodes.units == 0) {
                nodes = {s.planes.allocate(kSpaceNodes, count, last), count};
                coats = {s.planes.allocate(kSpaceCoats, mesh.vertices, last), mesh.vertices};
                stageDeformModel(s, *mesh.domain, model, nodes.first, coats.first);
            }
        }
        if (init.record.flags & kObjectSkinned) {
            const DrawnOrder order(*mesh.domain, s.memory);
            if (skin.units == 0) {
                skin = {s.planes.allocate(kSpaceSkin, mesh.tiles, last), mesh.tiles};
                sources = {s.planes.allocate(kSpaceSkinSources, mesh.vertices, last),
                           mesh.vertices};
                stageSkinTexels(s, *mesh.domain, order, skin.first, sources.first);
            }
            if (!(init.deform->flags & (kDeformShell | kDeformSprings))) {  // the host moves it
                uint32_t free = 0;
                while (free < s.skins.size() && !s.skins[free].shown.empty()) ++free;
                if (free == s.skins.size()) s.skins.emplace_back();
                fresh.skinPlus1 = free + 1;
                stageSkin(s, *mesh.domain, order, s.skins[free], fresh.shown.first);
            }
        }
    } catch (...) {
        fresh.refine.release(s.planes);
        if (mesh.nodes.units == 0) {
            if (nodes.units) s.planes.release(kSpaceNodes, nodes.first, nodes.units);
            if (coats.units) s.planes.release(kSpaceCoats, coats.first, coats.units);
        }
        if (mesh.skin.units == 0) {
            if (skin.units) s.planes.release(kSpaceSkin, skin.first, skin.units);
            if (sources.units) s.planes.release(kSpaceSkinSources, sources.first, sources.units);
        }
        releaseRanges(s, fresh);
        if (fresh.tiles.units)
            s.planes.release(kSpaceObjectTiles, fresh.tiles.first, fresh.tiles.units);
        while (s.uploads.size() > uploadsBefore) {
            s.deviceMemory.destroy(s.uploads.back().staging);
            s.uploads.pop_back();
        }
        throw;
    }
    BurnObject& r = fresh.record;
    r.texelBase = mesh.meshTiles.first * kTileTexels;
    r.stateBase = fresh.tiles.first * kTileTexels;
    r.slowBase =
        (fresh.slowness.units ? fresh.slowness.first : mesh.slowness.first) * (kTileTexels / 2);
    r.tileBase = mesh.meshTiles.first;
    r.worldTileBase = fresh.tiles.first;
    r.linkBase = mesh.links.first;
    r.readerBase = mesh.readers.first;
    r.publishedBase = fresh.published.first * kTileTexels * 3;
    r.heatBase = fresh.heatTiles.first * kTileTexels;
    r.width = mesh.width;
    r.height = mesh.height;
    r.tilesX = mesh.tilesX;
    r.tileCount = mesh.tiles;
    r.flags = (r.flags & ~kObjectHeat) | kObjectLive | (init.heat.empty() ? 0 : kObjectHeat);
    for (size_t i = 0; i < kMaterialsPerObject && i < init.heat.size(); ++i)
        fresh.heat[i] = init.heat[i];
    for (size_t i = 0; i < kMaterialsPerObject && i < init.materials.size(); ++i)
        fresh.materials[i] = init.materials[i];
    std::copy(std::begin(init.images), std::end(init.images), std::begin(fresh.images));
    fresh.recordDirty = fresh.materialsDirty = fresh.resetDue = true;
    if (init.deform) {
        mesh.nodes = nodes;
        mesh.coats = coats;
        fresh.deform = *init.deform;
        fresh.deform.nodeBase = nodes.first;
        fresh.deform.nodeCount = nodes.units;
        fresh.deform.coatBase = coats.first;
        fresh.deform.vertexCount = mesh.vertices;
        fresh.deform.shownBase = fresh.shown.first;
        fresh.deform.softBase = fresh.soft.first;
        fresh.deform.stateBase = r.stateBase;
        fresh.deform.slot = slot;
        fresh.deform.scale = length(vec3(r.worldRow0));
        for (const DeformMaterial& m : fresh.deform.materials)
            for (const uint32_t ticks : {m.charTicks, m.holeTicks})
                if (ticks != kNoneTexel) fresh.deformTicks = std::max(fresh.deformTicks, ticks);
        fresh.deformTicks += kTicksPerSecond;  // readbacks come late
        fresh.deformDirty = fresh.deformReset = true;
    }
    if (init.record.flags & kObjectSkinned) {
        mesh.skin = skin;
        mesh.skinSources = sources;
        r.skinBase = skin.first * kTileTexels;
        r.shownBase = fresh.shown.first;
    }
    if (fresh.skinPlus1) {
        std::copy_n(init.shape, 3, fresh.shape);
        fresh.deformReset = false;  // at rest already
    }
    s.objects[slot] = fresh;
    s.recordsDirty = true;
    s.refine.users += fresh.refine.on ? 1 : 0;
    ++s.liveObjects;
}

void VkBackend::destroyObject(uint32_t slot) noexcept {
    State& s = *state_;
    ObjectEntry& entry = s.objects[slot];
    if (!entry.live) return;
    const bool met = !entry.resetDue;  // by a recorded frame, so lists may name its tiles
    if (met)
        s.quarantine.push_back(
            {entry.tiles, s.frontWalks, s.burnWalks, s.predictWalks, s.hotWalks});
    else
        s.planes.release(kSpaceObjectTiles, entry.tiles.first, entry.tiles.units);
    s.refine.users -= entry.refine.on ? 1 : 0;
    entry.refine.release(s.planes);
    releaseRanges(s, entry);
    entry = {};
    entry.recordDirty = true;  // a record without kObjectLive: list entries fall out
    s.recordsDirty = true;
    --s.liveObjects;
    std::erase_if(s.drawItems, [slot](const DrawItem& item) { return item.object == slot; });
}

void VkBackend::setObjectPose(uint32_t slot, const vec4 rows[3], const vec4& tint, uint32_t flags) {
    State& s = *state_;
    ObjectEntry& entry = s.objects[slot];
    entry.record.worldRow0 = rows[0];
    entry.record.worldRow1 = rows[1];
    entry.record.worldRow2 = rows[2];
    entry.record.tint = tint;
    if (entry.shown.units) {
        entry.deform.scale = length(vec3(rows[0]));
        entry.deformDirty = true;
        entry.softUntil = 0;  // it swings anew
    }
    constexpr uint32_t kFixed = kObjectPublished | kObjectHeat;
    entry.record.flags = (flags & ~kFixed) | (entry.record.flags & kFixed) | kObjectLive;
    entry.recordDirty = true;
    s.recordsDirty = true;
}

void VkBackend::setVertices(uint32_t slot, std::span<const float> positions,
                            std::span<const float> normals) noexcept {
    State& s = *state_;
    Skin& skin = s.skins[s.objects[slot].skinPlus1 - 1];
    for (size_t i = 0; i < skin.shown.size(); ++i) {
        ShownVertex& v = skin.shown[i];
        const size_t from = size_t(skin.sources[i]) * 3;
        v.x = positions[from];
        v.y = positions[from + 1];
        v.z = positions[from + 2];
        if (!normals.empty())
            v.normal = packDirection({normals[from], normals[from + 1], normals[from + 2]});
    }
    skin.dirty = true;
    skin.givenDue = false;
    skin.normals = !normals.empty();
}

void VkBackend::setVertexBuffer(uint32_t slot, const FwVulkanVertices& vertices) {
    State& s = *state_;
    Skin& skin = s.skins[s.objects[slot].skinPlus1 - 1];
    const uint64_t last = vertices.normalOffset ? uint64_t(vertices.normalOffset) + 12 : 12;
    const uint64_t words = (uint64_t(vertices.vertexCount - 1) * vertices.stride + last) / 4;
    if (skin.words.units < words) {
        const RangeOf fresh{s.planes.allocate(kSpaceSkinGiven, uint32_t(words), s.ring.newest()),
                            uint32_t(words)};
        if (skin.words.units) s.planes.release(kSpaceSkinGiven, skin.words.first, skin.words.units);
        skin.words = fresh;
    }
    skin.given = vertices;
    skin.givenDue = true;
    skin.dirty = false;
    skin.normals = vertices.normalOffset != 0;
}

void VkBackend::createImage(uint32_t slot, uint32_t width, uint32_t height,
                            std::span<const std::byte> pixels) {
    State& s = *state_;
    const uint32_t most = s.device.properties.limits.maxImageDimension2D;
    if (width > most || height > most)
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "The image is %u x %u pixels; the device's maxImageDimension2D is %u.", width,
                   height, most);
    ImageEntry& entry = slotOf(s.images, slot);
    const uint32_t mips = mipsOf(width, height);
    size_t bytes = 0;
    for (uint32_t mip = 0; mip < mips; ++mip)
        bytes += size_t(std::max(width >> mip, 1u)) * std::max(height >> mip, 1u) * 4;
    std::pmr::vector<std::byte> all(bytes, s.memory);
    std::memcpy(all.data(), pixels.data(), size_t(width) * height * 4);
    const SrgbTable table;
    size_t at = 0;
    for (uint32_t mip = 0; mip + 1 < mips; ++mip) {
        const uint32_t w = std::max(width >> mip, 1u), h = std::max(height >> mip, 1u);
        halveSrgb(table, all.data() + at, w, h, all.data() + at + size_t(w) * h * 4);
        at += size_t(w) * h * 4;
    }
    s.addImage(entry, width, height, 1, mips, VK_FORMAT_R8G8B8A8_SRGB, all, "base colour");
}

void VkBackend::destroyImage(uint32_t slot) noexcept {
    State& s = *state_;
    ImageEntry& entry = s.images[slot];
    if (!entry.live) return;
    for (size_t i = 0; i < s.uploads.size(); ++i) {
        if (s.uploads[i].image != entry.image.handle) continue;
        s.deviceMemory.destroy(s.uploads[i].staging);
        s.uploads.erase(s.uploads.begin() + std::ptrdiff_t(i));
        break;
    }
    s.retired.push(s.ring.newest(), entry.image);
    s.retired.push(s.ring.newest(), entry.set.pool);
    entry = {};
    for (ObjectEntry& object : s.objects) {  // back to their own base colour
        for (uint32_t& image : object.images) {
            if (image != slot + 1) continue;
            image = 0;
            object.recordDirty = true;
            s.recordsDirty = true;
        }
    }
}

bool VkBackend::beginOutside(const FwVulkanFrame& frame) {
    State& s = *state_;
    s.failIfLost();
    if (!s.context.pipelines.ready()) return false;
    s.ring.pace(frame, true);
    s.retired.collect(s.ring.completed());
    s.openFrame(frame.commandBuffer, frame.frameIndex);
    return true;
}

void VkBackend::run(const FramePlan& plan) { state_->run(plan); }
void VkBackend::endOutside(const FwView& view) { state_->closeFrame(&view); }
void VkBackend::cancelOutside() noexcept {
    if (!state_->open.open) return;
    state_->open = {};
    state_->ring.undoOutside();
}

void VkBackend::beginOwn() {
    state_->beginOwn();
    state_->open.unseen = true;  // pictures are frames of their own
}
void VkBackend::endOwn() {
    state_->closeFrame(nullptr);
    state_->submitOwn();
}

void VkBackend::renderOffscreen(const FwOffscreenDef& def) { state_->renderOffscreen(def); }

const Readback* VkBackend::nextReadback() { return state_->nextReadback(); }
std::span<const PassTime> VkBackend::passTimes() { return state_->times; }

void VkBackend::memoryRows(std::pmr::vector<MemoryRow>& out) {
    state_->deviceMemory.rows(out);
    state_->planes.rows(out);
}

}  // namespace fw::gpu::vk
