#include "gpu/vk/vk_backend.h"

#include "core/error.h"
#include "core/growth.h"
#include "gpu/vk/world_state.h"
#include "shared/volume.h"

#include <algorithm>
#include <cstring>

namespace fw::gpu::vk {

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
      buffers(device, deviceMemory, retired,
              {std::max(worldLimits.maxLights, kSurfaceLights),
               std::clamp(worldLimits.maxFlames, 1u, kFlameCapacity), worldLimits.exactBuffers},
              pmr),
      sets(device, contextState.pipelines, retired, pmr),
      scene(pmr),
      simulation(pmr),
      deforming(pmr),
      flames(pmr),
      particles(float(worldLimits.maxLights)),
      particleFields(pmr),
      surfaces(pmr),
      results(pmr),
      refine(pmr),
      pattern(pmr) {
    results.times.reserve(computePasses().size() + drawPasses().size());
    flames.outsideViews[0] = core::Owned<OutsideView>::make(memory, 0u);
    const auto alignment = uint32_t(device.properties.limits.minUniformBufferOffsetAlignment);
    viewStride = uint32_t((sizeof(ViewParams) + alignment - 1) / alignment * alignment);
    views = deviceMemory.createBuffer(
        uint64_t(viewStride) * FrameRing::kMaxInFlight * FrameRing::kMaxViews,
        VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, MemoryKind::upload, kComponentStaging, "views");
    try {
        std::byte whitePixel[4];
        std::fill(std::begin(whitePixel), std::end(whitePixel), std::byte(255));
        addImage(scene.white, 1, 1, 1, 1, VK_FORMAT_R8G8B8A8_UNORM, whitePixel, "white");
        if (!limits.looks.textures.empty())
            addImage(scene.lookTextures, 512, 512, kLookTextureLayers, 10, VK_FORMAT_R8G8B8A8_UNORM,
                     limits.looks.textures, "look textures");
        if (!limits.looks.profiles.empty()) {
            // The host's come behind the presets; none of them is there yet.
            std::pmr::vector<std::byte> layers(limits.looks.profiles.begin(),
                                               limits.looks.profiles.end(), memory);
            layers.resize(size_t(kFirePresets + kMaxFireProfiles) * kProfileBytes);
            addImage(scene.profiles, kProfileWidth, kProfileHeight, kFirePresets + kMaxFireProfiles,
                     1, VK_FORMAT_R16G16_SFLOAT, layers, "fire profiles");
        }
        uploadRefineTable();
        if (!limits.looks.table.empty()) {
            PendingUpload& upload = stage(limits.looks.table.size_bytes(), "looks");
            std::memcpy(upload.staging.mapped, limits.looks.table.data(),
                        limits.looks.table.size_bytes());
            upload.regions[upload.regionCount++] = {
                FW_BIND_APPEARANCES, 0, 0,
                std::min<uint64_t>(limits.looks.table.size_bytes(),
                                   buffers.buffer(FW_BIND_APPEARANCES).size)};
        }
    } catch (...) {
        for (PendingUpload& upload : scene.uploads) deviceMemory.destroy(upload.staging);
        for (ImageEntry* entry : {&scene.white, &scene.lookTextures, &scene.profiles}) {
            deviceMemory.destroy(entry->image);
            device.table.DestroyDescriptorPool(device.handle, entry->set.pool,
                                               device.allocationCallbacks);
        }
        deviceMemory.destroy(views);
        throw;
    }
    limits.looks.table = {};
    limits.looks.textures = {};
    limits.looks.profiles = {};
}

VkBackend::State::~State() {
    const Table& vk = device.table;
    const VkAllocationCallbacks* callbacks = device.allocationCallbacks;
    for (auto* waiting : {&scene.uploads, &scene.restores})
        for (PendingUpload& upload : *waiting) deviceMemory.destroy(upload.staging);
    const auto drop = [&](ImageEntry& entry) {
        deviceMemory.destroy(entry.image);
        vk.DestroyDescriptorPool(device.handle, entry.set.pool, callbacks);
    };
    for (ImageEntry& entry : scene.images) drop(entry);
    drop(scene.white);
    drop(scene.lookTextures);
    drop(scene.profiles);
    drop(scene.books);
    for (FrameInFlight& slot : ring.slots()) {
        deviceMemory.destroy(slot.upload);
        deviceMemory.destroy(slot.readback);
        slot.timers.destroy(device);
        ring.dropFramebuffers(slot);
        vk.DestroyDescriptorPool(device.handle, slot.hostPool, callbacks);
    }
    destroyFramebuffers();
    for (HalfImages& half : surfaces.halves) {
        deviceMemory.destroy(half.color);
        deviceMemory.destroy(half.depth);
        vk.DestroyDescriptorPool(device.handle, half.colorSet.pool, callbacks);
        vk.DestroyDescriptorPool(device.handle, half.depthSet.pool, callbacks);
        vk.DestroyFramebuffer(device.handle, half.colorBuffer, callbacks);
        vk.DestroyFramebuffer(device.handle, half.depthBuffer, callbacks);
    }
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
    core::growTo(scene.uploads, scene.uploads.size() + 1);
    retired.promise(1);
    PendingUpload upload;
    upload.staging = deviceMemory.createBuffer(bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                               MemoryKind::upload, kComponentStaging, name);
    scene.uploads.push_back(upload);
    return scene.uploads.back();
}

void VkBackend::State::dropUploads(size_t kept) noexcept {
    while (scene.uploads.size() > kept) {
        deviceMemory.destroy(scene.uploads.back().staging);
        scene.uploads.pop_back();
    }
}

void VkBackend::State::freeQuarantine() noexcept {
    size_t kept = 0;
    for (const Quarantined& one : scene.quarantine) {
        const bool passed =
            (simulation.frontWalks > one.frontWalks || simulation.frontEmpty) &&
            (simulation.burnWalks > one.burnWalks || simulation.burnEmpty) &&
            (simulation.predictWalks > one.predictWalks || simulation.predictEmpty) &&
            (simulation.hotWalks > one.hotWalks || simulation.hotEmpty);
        if (passed)
            buffers.release(kPoolObjectTiles, one.tiles.first, one.tiles.units);
        else
            scene.quarantine[kept++] = one;
    }
    scene.quarantine.resize(kept);
}

// --- VkBackend ---

VkBackend::VkBackend(Context& context, const WorldLimits& limits, std::pmr::memory_resource* memory,
                     const core::Log& log)
    : memory_(memory) {
    state_ = std::pmr::polymorphic_allocator<>(memory).new_object<State>(context.state(), limits,
                                                                         memory, log);
}

VkBackend::~VkBackend() { std::pmr::polymorphic_allocator<>(memory_).delete_object(state_); }

bool VkBackend::beginOutside(const FwVulkanFrame& frame, std::span<const FwView> views) {
    State& s = *state_;
    s.failIfLost();
    if (!s.context.pipelines.ready()) return false;
    s.ring.pace(frame, true);
    s.retired.collect(s.ring.completed());
    s.openFrame(frame.commandBuffer, frame.frameIndex);
    try {
        s.openViews(views);
    } catch (...) {
        cancelOutside();
        throw;
    }
    return true;
}

void VkBackend::run(const FramePlan& plan) { state_->run(plan); }
void VkBackend::endOutside() { state_->closeFrame(); }
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
    state_->closeFrame();
    state_->submitOwn();
}

void VkBackend::renderOffscreen(const FwOffscreenDef& def) { state_->renderOffscreen(def); }

const Readback* VkBackend::nextReadback() { return state_->nextReadback(); }
std::span<const PassTime> VkBackend::passTimes() { return state_->results.times; }

void VkBackend::memoryRows(std::pmr::vector<MemoryRow>& out) const { state_->buffers.rows(out); }

}  // namespace fw::gpu::vk
