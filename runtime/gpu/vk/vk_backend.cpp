#include "gpu/vk/vk_backend.h"

#include "core/error.h"
#include "gpu/vk/frame_needs.h"
#include "gpu/vk/vk_extension.h"
#include "shared/volume.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace fw::gpu::vk {
namespace {

// White, appearance textures, fire profiles, the table of refinement and that of appearances.
void addSources(BackendState& s) {
    AppearanceSources& appearances = s.limits.appearances;
    std::byte whitePixel[4];
    std::fill(std::begin(whitePixel), std::end(whitePixel), std::byte(255));
    addImage(s, s.scene.white, 1, 1, 1, 1, VK_FORMAT_R8G8B8A8_UNORM, whitePixel, "white");
    if (!appearances.textures.empty())
        addImage(s, s.scene.appearanceTextures, 512, 512, kAppearanceTextureLayers, 10,
                 VK_FORMAT_R8G8B8A8_UNORM, appearances.textures, "appearance textures");
    if (!appearances.profiles.empty()) {
        // The host's come behind the presets; none of them is there yet.
        std::pmr::vector<std::byte> layers(appearances.profiles.begin(), appearances.profiles.end(),
                                           s.memory);
        layers.resize(size_t(kFirePresets + kMaxFireProfiles) * kProfileBytes);
        addImage(s, s.scene.profiles, kProfileWidth, kProfileHeight,
                 kFirePresets + kMaxFireProfiles, 1, VK_FORMAT_R16G16_SFLOAT, layers,
                 "fire profiles");
    }
    s.refine.uploadTable(s);
    if (!appearances.table.empty()) {
        const size_t rows =
            s.buffers.buffer(FW_BIND_APPEARANCES).size / sizeof appearances.table[0];
        s.scene.uploads.stage(appearances.table.size_bytes(), "appearances")
            .add(FW_BIND_APPEARANCES, 0,
                 appearances.table.first(std::min(rows, appearances.table.size())));
    }
    appearances.table = {};
    appearances.textures = {};
    appearances.profiles = {};
}

// Records objects created, moved or restored since the last frame, and the plan's changes outside
// of steps.
void recordChanges(BackendState& s, const FramePlan& plan, const FrameNeeds& needs,
                   FrameRecorder& recorder) {
    const Table& vk = s.device.table;
    if (s.buffers.recordMoves(vk, s.open.commands, s.open.ringFrame))
        s.barriers.begin(vk, s.open.commands);  // rare: waits for all of the moves
    s.scene.uploads.record(s.device, s.open.commands, s.barriers, s.buffers, s.open.ringFrame);
    if (s.scene.recordsDirty) s.surfaces.recordObjects(s, recorder);
    if (s.scene.roomsDirty) recorder.upload(FW_BIND_ROOMS, 0, std::span<const Room>(s.scene.rooms));
    s.scene.roomsDirty = false;
    recordRestores(s, recorder);
    recordMovedTiles(s, recorder);
    recordForgetting(s, recorder);
    s.surfaces.drawVertices = s.buffers.buffer(kResourceVertices).handle;
    s.surfaces.drawIndices = s.buffers.buffer(kResourceIndices).handle;
    s.surfaces.drawShown = s.buffers.buffer(FW_BIND_SHOWN).handle;
    s.particleFields.record(plan, recorder);
    if (plan.volumes) s.flames.record(*plan.volumes, recorder);
    s.particles.emittersMove = plan.emitters != nullptr;
    if (plan.emitters) s.particles.record(*plan.emitters, recorder);
    if (needs.skins) s.deforming.recordSkins(s, recorder);
}

// Moves the detail shown toward the plan's detail, a bounded amount per frame.
void followDetail(BackendState& s, const Detail& planned) noexcept {
    constexpr float kQuadsTurn = 1.0f / 32;  // a frame: none comes or goes at once
    constexpr float kLightsTurn = 1.0f / 16;
    const auto toward = [](auto& now, auto wanted, auto turn) {
        now = now > wanted ? std::max(now - turn, wanted) : std::min(now + turn, wanted);
    };
    s.detail = planned;
    toward(s.flames.volumeStepsNow, planned.rayStepCount, kStepsTurn);
    toward(s.particles.quadShare, planned.quads, kQuadsTurn);
    toward(s.particles.lightCount, float(lightsOf(planned, s.limits.maxLights)), kLightsTurn);
}

PendingReadback pendingOf(const OpenFrame& open) noexcept {
    PendingReadback one;
    one.ringFrame = open.ringFrame;
    one.frameIndex = open.planFrame;
    one.endTick = open.endTick;
    return one;
}

}  // namespace

// --- BackendState ---

BackendState::BackendState(Context& shared, const WorldLimits& worldLimits,
                           std::pmr::memory_resource* pmr, const core::Log& logTo)
    : context(shared),
      limits(worldLimits),
      memory(pmr),
      log(logTo),
      buffers(device, deviceMemory, retired,
              {std::max(worldLimits.maxLights, kSurfaceLights),
               std::clamp(worldLimits.maxFlames, 1u, kFlameCapacity), worldLimits.exactBuffers},
              pmr) {
    results.times.reserve(computePasses().size() + drawPasses().size());
    const auto alignment = device.properties.limits.minUniformBufferOffsetAlignment;
    viewStride = uint32_t(alignUp(sizeof(ViewParams), alignment));
    views = deviceMemory.createBuffer(
        uint64_t(viewStride) * FrameRing::kMaxInFlight * FrameRing::kMaxViews,
        VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, MemoryKind::upload, kComponentStaging, "views");
    try {
        addSources(*this);
    } catch (...) {
        destroyAll();
        throw;
    }
}

BackendState::~BackendState() { destroyAll(); }

void BackendState::destroyAll() noexcept {
    for (ImageEntry& entry : scene.images) destroyImage(*this, entry);
    for (ImageEntry* entry :
         {&scene.white, &scene.appearanceTextures, &scene.profiles, &scene.flipbooks})
        destroyImage(*this, *entry);
    for (FrameInFlight& slot : ring.slots()) {
        deviceMemory.destroy(slot.upload);
        deviceMemory.destroy(slot.readback);
        slot.timers.destroy(device);
        device.destroy(device.table.DestroyDescriptorPool, slot.hostPool);
    }
    for (KeptFramebuffer& one : targets.framebuffers)
        retired.push(one.lastFrame, {.framebuffer = one.handle});
    for (HalfImages& half : targets.halves) dropHalf(*this, half);
    deviceMemory.destroy(views);
    destroyOwn(*this);
}

void BackendState::openFrame(VkCommandBuffer commands, uint64_t ringFrame) noexcept {
    open = {};
    open.open = true;
    open.commands = commands;
    open.ringFrame = ringFrame;
}

uint32_t BackendState::pushView(FrameInFlight& slot, const FwView& view,
                                const VkViewport& viewport) {
    if (slot.views == FrameRing::kMaxViews)
        core::refuse("A frame is drawn with more than %u views; that is the limit.",
                     FrameRing::kMaxDrawn);
    ViewInput input;
    input.view = &view;
    input.viewport[0] = viewport.x;
    input.viewport[1] = viewport.y;
    input.viewport[2] = viewport.width;
    input.viewport[3] = viewport.height;
    input.now = simulation.shownTick;
    input.tickFraction = simulation.tickFraction;
    std::copy(std::begin(simulation.wind), std::end(simulation.wind), input.wind);
    std::copy(std::begin(limits.up), std::end(limits.up), input.up);
    input.paceFactor = limits.paceFactor;
    input.lightCount = uint32_t(std::ceil(particles.lightCount));
    input.lastLight =
        particles.lightCount > 0 ? particles.lightCount - float(input.lightCount - 1) : 1;
    input.flameCapacity = std::min(limits.maxFlames, kFlameCapacity);
    input.quadShare = particles.quadShare;
    input.bodies = flames.bodiesShow;
    input.seed = limits.seed;
    seen = makeViewParams(input);
    const uint32_t offset = (ring.indexOf(slot) * FrameRing::kMaxViews + slot.views) * viewStride;
    std::memcpy(views.mapped + offset, &seen, sizeof seen);
    ++slot.views;
    return offset;
}

ViewParams BackendState::paramsOf(const FwView& view, float height,
                                  float otherwise) const noexcept {
    ViewInput input;
    input.view = &view;
    input.viewport[2] = input.viewport[3] = height > 0 ? height : otherwise;
    return makeViewParams(input);
}

// --- VkBackend ---

VkBackend::VkBackend(Context& context, const WorldLimits& limits, std::pmr::memory_resource* memory,
                     const core::Log& log)
    : state_(core::Owned<BackendState>::make(memory, context, limits, memory, log)) {}

VkBackend::~VkBackend() = default;

bool VkBackend::beginOutside(const FwVulkanFrame& frame, std::span<const FwView> views) {
    BackendState& s = *state_;
    s.device.failIfLost();
    if (!s.context.pipelines.ready()) return false;
    s.ring.pace(frame, true);
    s.retired.collect(s.ring.completed());
    s.openFrame(frame.commandBuffer, frame.frameIndex);
    try {
        s.outsideViews.open(s, views);
    } catch (...) {
        cancelOutside();
        throw;
    }
    return true;
}

void VkBackend::cancelOutside() noexcept {
    if (!state_->open.open) return;
    state_->open = {};
    state_->ring.undoOutside();
}

void VkBackend::run(const FramePlan& plan) {
    BackendState& s = *state_;
    if (!s.open.open || s.open.ran)
        core::fail(FW_ERROR_INTERNAL, "A frame's plan is run once, after the frame is begun.");
    s.deforming.advance(double(plan.endTick) + double(plan.tickFraction) * kStepTicks);
    const FrameNeeds needs = needsOf(s, plan);
    s.open.planFrame = plan.frameIndex;
    s.open.endTick = plan.endTick;
    s.open.readback = needs.readback;
    std::copy(std::begin(plan.wind), std::end(plan.wind), std::begin(s.simulation.wind));
    s.simulation.tickFraction = plan.tickFraction;
    followDetail(s, plan.detail);
    s.crossing = plan.switches & (kSwitchCrossing | kSwitchNoDepthFirst);
    if (!needs.work) {
        s.open.ran = true;
        s.simulation.shownTick = plan.endTick;
        if (plan.frameIndex != 0) s.results.push(pendingOf(s.open));
        return;
    }
    FrameInFlight& slot = makeRoom(s, plan, needs);

    // From here on nothing fails.
    s.open.ran = true;
    s.open.slot = &slot;
    s.open.recording = true;
    s.barriers.begin(s.device.table, s.open.commands);
    slot.timers.reset(s.device, s.open.commands);
    FrameRecorder recorder(s, slot);
    recordChanges(s, plan, needs, recorder);
    recordSteps(s, plan, needs, recorder);
    s.simulation.shownTick = plan.endTick;
    if (needs.predicting && predictsNow(s, needs, plan.endTick))
        recordPredictions(s, plan, recorder);
    if (needs.falling) recordFalling(s, plan, needs.burning, recorder);
    slot.layout.predictParity = s.simulation.lists.predictParity;
    s.deforming.record(s, needs, recorder);
    settle(s);
    if (!plan.probes.empty()) recordProbes(recorder, recorder.stage(plan.probes));
}

void VkBackend::endOutside() {
    BackendState& s = *state_;
    const std::span<OutsideView* const> from = s.seenFrom();
    for (const OutsideView* const of : from) markVisible(s, of->view, of->height, s.open.ringFrame);
    if (!from.empty() && !s.showsQuads()) s.particles.quadsShown = 0;
    if (s.open.recording) {
        FrameInFlight& slot = *s.open.slot;
        recordEffects(s, slot);
        if (!from.empty()) {
            s.refine.record(s, slot);
            if (extension()) extension()->vulkan->recordRefinement(s, slot);
        }
        for (DrawItem& item : s.surfaces.drawItems)
            if (s.scene.awake.contains(item.object)) s.scene.objects[item.object].refine.show(item);
        recordReadback(s, slot);
        if (s.open.planFrame) {
            PendingReadback one = pendingOf(s.open);
            (s.open.readback ? one.slot : one.effectsSlot) = int32_t(s.ring.indexOf(slot));
            s.results.push(one);
        }
        s.barriers.end(s.device.table, s.open.commands);
    }
    s.open = {};
}

std::span<const PassTime> VkBackend::passTimes() { return state_->results.times; }
void VkBackend::memoryRows(std::pmr::vector<MemoryRow>& out) const { state_->buffers.rows(out); }
uint32_t VkBackend::quadsShown() const noexcept { return state_->particles.quadsShown; }
uint64_t VkBackend::detailBytes() const noexcept { return state_->flames.detailBytes(*state_); }
void VkBackend::setTileFlipbooks(uint32_t flipbooks) noexcept {
    state_->particles.flameFlipbooks = flipbooks;
}

}  // namespace fw::gpu::vk
