// Drawing: inside the host's pass, or as a composite over the host's images. Draws only; what they
// read was made ready by the outside part.
#include "core/error.h"
#include "gpu/vk/world_state.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace fw::gpu::vk {
namespace {

// One pass bound, then its draws.
class PassRecorder : public DrawRecorder {
 public:
    PassRecorder(VkBackend::State& state, VkCommandBuffer commands, size_t pass,
                 uint32_t viewOffset)
        : s_(state),
          commands_(commands),
          number_(pass),
          viewOffset_(viewOffset),
          pass_(*drawPasses()[pass]),
          layout_(state.context.pipelines.draw(pass).layout) {}

    void drawItem(const DrawItem& item, const void* push) override { drawFrom(item, push, false); }
    void drawInside(const DrawItem& item, const void* push) override { drawFrom(item, push, true); }
    void drawFrom(const DrawItem& item, const void* push, bool inside) {
        const Table& vk = s_.device.table;
        bindFor(item, push);
        const uint64_t shown = !inside            ? item.shown
                               : item.insideShown ? item.inside
                                                  : kInside | item.inside;
        if (shown != shown_) bindVertices(item, shown);
        if (item.refined != refined_) {
            vk.CmdBindIndexBuffer(
                commands_,
                item.refined ? s_.planes.buffer(FW_BIND_REFINE_INDICES).handle : s_.drawIndices, 0,
                VK_INDEX_TYPE_UINT32);
            refined_ = item.refined;
        }
        const bool own = shown != kNoneTexel;
        // One draw per call: several would need a feature.
        if (item.refined)
            vk.CmdDrawIndexedIndirect(
                commands_, s_.planes.buffer(FW_BIND_REFINE_DRAWS).handle,
                (uint64_t(item.object) * kMaterialsPerObject + item.material) *
                    sizeof(VkDrawIndexedIndirectCommand),
                1, 0);
        else
            vk.CmdDrawIndexed(commands_, item.indexCount, 1, item.firstIndex,
                              own ? 0 : item.vertexOffset, 0);
    }
    void drawCut(const DrawItem& item, const void* push) override {
        bindFor(item, push);
        if (shown_ != kCuts) {
            const VkBuffer cuts = s_.planes.buffer(FW_BIND_REFINE_CUTS).handle;
            const VkBuffer buffers[2] = {cuts, cuts};
            const VkDeviceSize zeros[2] = {};
            s_.device.table.CmdBindVertexBuffers(commands_, 0, 2, buffers, zeros);
            shown_ = kCuts;
        }
        drawIndirect(FW_BIND_REFINE_CUT_DRAWS,
                     (uint64_t(item.object) * kMaterialsPerObject + item.material) *
                         sizeof(VkDrawIndirectCommand));
    }
    void bindFor(const DrawItem& item, const void* push) {
        const Table& vk = s_.device.table;
        VkDescriptorSet set = s_.white.set.set;
        if (item.image && item.image - 1 < s_.images.size() && s_.images[item.image - 1].live)
            set = s_.images[item.image - 1].set.set;
        if (set != bound_) {
            vk.CmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 1, 1,
                                     &set, 0, nullptr);
            bound_ = set;
        }
        if (pass_.pushBytes)
            vk.CmdPushConstants(commands_, layout_,
                                VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                                pass_.pushBytes, push);
    }
    // Of ordinary items all is bound from the first vertex on, of one with shown vertices of its
    // own, or on its inner skin, both its ranges.
    void bindVertices(const DrawItem& item, uint64_t shown) {
        static_assert(sizeof(mesh::RenderVertex) == sizeof(ShownVertex));
        const bool own = shown != kNoneTexel, inside = own && (shown & kInside) != 0;
        const VkBuffer buffers[2] = {s_.drawVertices,
                                     own && !inside ? s_.drawShown : s_.drawVertices};
        const VkDeviceSize offsets[2] = {
            own ? VkDeviceSize(item.vertexOffset) * sizeof(mesh::RenderVertex) : 0,
            own ? VkDeviceSize(shown & ~kInside) * sizeof(ShownVertex) : 0};
        s_.device.table.CmdBindVertexBuffers(commands_, 0, 2, buffers, offsets);
        shown_ = shown;
    }
    void drawIndirect(uint32_t resource, uint64_t offset) override {
        const Buffer& buffer = s_.planes.buffer(resourceOf(resource, s_.drawnView));
        s_.device.table.CmdDrawIndirect(commands_, buffer.handle, offset, 1, 0);
    }
    void drawVolume(uint32_t flame, const void* push, uint32_t vertices,
                    uint32_t instances) override {
        const Table& vk = s_.device.table;
        // In the order of their bindings: the view, the flame.
        const std::array<uint32_t, 2> offsets{viewOffset_, flame * kVolumeFlameBytes};
        const VkDescriptorSet set = s_.sets.draw(number_, s_.drawnView);
        vk.CmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, 1, &set,
                                 uint32_t(offsets.size()), offsets.data());
        vk.CmdPushConstants(commands_, layout_,
                            VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                            pass_.pushBytes, push);
        vk.CmdDraw(commands_, vertices, instances, 0, 0);
    }
    void drawListed(uint32_t resource, uint64_t offset, const void* push) override {
        const Table& vk = s_.device.table;
        vk.CmdPushConstants(commands_, layout_,
                            VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                            pass_.pushBytes, push);
        drawIndirect(resource, offset);
    }
    void drawVertices(const void* push, uint32_t vertices) override {
        const Table& vk = s_.device.table;
        vk.CmdPushConstants(commands_, layout_,
                            VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                            pass_.pushBytes, push);
        vk.CmdDraw(commands_, vertices, 1, 0, 0);
    }

 private:
    VkBackend::State& s_;
    VkCommandBuffer commands_;
    size_t number_;
    uint32_t viewOffset_;
    const DrawPass& pass_;
    VkPipelineLayout layout_;
    VkDescriptorSet bound_ = VK_NULL_HANDLE;
    bool refined_ = false;                           // whose indices are bound
    static constexpr uint64_t kInside = 1ull << 32;  // as `shown`, with the first on the inner skin
    static constexpr uint64_t kCuts = kNoneTexel - 1;  // cut vertices are bound
    uint64_t shown_ = kNoneTexel;
};

VkImageMemoryBarrier imageBarrier(const FwVulkanImage& image, bool depth, VkFormat format) {
    auto barrier = typed<VkImageMemoryBarrier>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER);
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image.image;
    VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
    if (depth) {
        aspect = VK_IMAGE_ASPECT_DEPTH_BIT;
        if (format == VK_FORMAT_D16_UNORM_S8_UINT || format == VK_FORMAT_D24_UNORM_S8_UINT ||
            format == VK_FORMAT_D32_SFLOAT_S8_UINT)
            aspect |= VK_IMAGE_ASPECT_STENCIL_BIT;
    }
    barrier.subresourceRange = {aspect, 0, 1, 0, 1};
    return barrier;
}

bool isMixed(const FwVulkanFrame& frame) noexcept {
    return frame.transparency > 0.0f && frame.transparency < 1.0f;
}

// Haze is drawn where a frame lends its colour, so none is no fault.
void checkLentColor(const Target& target, const FwVulkanFrame& frame) {
    if (isMixed(frame) && !target.key.transparency)
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "FwVulkanFrame::transparency is %g and the target was registered without "
                   "FW_TARGET_TRANSPARENCY (64); only 0 and 1 are drawn there.",
                   double(frame.transparency));
    if (isMixed(frame) && !frame.sampledColor)
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "FwVulkanFrame::transparency is %g and sampledColor is null; between 0 and 1 a "
                   "copy of what the target holds is needed. Lend one, or draw into a layer of "
                   "your own and blend that.",
                   double(frame.transparency));
    if ((!target.key.haze && !isMixed(frame)) || !frame.sampledColor ||
        frame.sampledColorLayout == VK_IMAGE_LAYOUT_GENERAL ||
        frame.sampledColorLayout == VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL)
        return;
    core::fail(FW_ERROR_INVALID_ARGUMENT,
               "FwVulkanFrame::sampledColorLayout is %d; our shaders read colour that is in "
               "GENERAL (1) or SHADER_READ_ONLY_OPTIMAL (5).",
               int(frame.sampledColorLayout));
}

constexpr float kAnyHeight = 1000;  // px

constexpr VkAccessFlags kColorAccess =
    VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
constexpr VkAccessFlags kDepthAccess =
    VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
constexpr VkPipelineStageFlags kDepthStages =
    VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;

}  // namespace

void VkBackend::State::setViewport(VkCommandBuffer commands,
                                   const VkViewport& viewport) const noexcept {
    device.table.CmdSetViewport(commands, 0, 1, &viewport);
    const float left = std::max(viewport.x, 0.0f), top = std::max(viewport.y, 0.0f);
    VkRect2D shown{{int32_t(left), int32_t(top)}, {}};
    // Whole pixels: half of an odd number of them ends in one.
    shown.extent = {uint32_t(std::ceil(std::max(viewport.x + viewport.width - left, 0.0f))),
                    uint32_t(std::ceil(std::max(viewport.y + viewport.height - top, 0.0f)))};
    if (scissor.extent.width != 0) {
        const auto meet = [](int32_t& offset, uint32_t& extent, int32_t by, uint32_t byExtent) {
            const int64_t end = std::min(int64_t(offset) + extent, int64_t(by) + byExtent);
            offset = std::max(offset, by);
            extent = uint32_t(std::max<int64_t>(end - offset, 0));
        };
        meet(shown.offset.x, shown.extent.width, scissor.offset.x, scissor.extent.width);
        meet(shown.offset.y, shown.extent.height, scissor.offset.y, scissor.extent.height);
    }
    device.table.CmdSetScissor(commands, 0, 1, &shown);
}

void VkBackend::State::recordDraws(FrameInFlight& slot, VkCommandBuffer commands,
                                   const Target& target, const FwView& view,
                                   const VkViewport& viewport, const Lent& lent, DrawPart part,
                                   const HalfImages* half) {
    if (!showsAnything() || transparency >= 1.0f) return;
    const Table& vk = device.table;
    OutsideView& of = viewFor(view);
    drawnView = of.number;
    const uint32_t viewOffset = pushView(slot, view, viewport);
    if (part != DrawPart::half) {
        const float height = std::fabs(viewport.height);
        if (view.viewId == of.view.viewId || sameView(view, of.view)) of.height = height;
        look(view, height, slot.frameIndex);
    }
    setViewport(commands, viewport);
    std::array<VolumeItem, kMaxVolumeFlames> items;
    std::array<SlicedVolume, kMaxVolumeFlames> sliced;
    VolumeOrder order;
    std::array<HazedVolume, kMaxVolumeFlames> hazes;
    std::array<FieldItem, kMaxFields> fieldItems;
    DrawList list{drawItems,
                  !burnEmpty || showsEmitters(),
                  books.live,
                  pagesAlone(),
                  {},
                  {},
                  {fieldItems.data(), orderFields(fieldItems)},
                  turnsFaces(view, viewport)};
    list.half = half != nullptr;
    list.transparent = transparency > 0.0f && part != DrawPart::half;
    if (target.key.flames && !volumes.empty()) {
        const float share = part == DrawPart::over ? 0.5f : 1.0f;
        const VolumeScreen screen =
            screenOf(target.key, {share * viewport.width, share * std::fabs(viewport.height)});
        noteScreen(of, view, screen, slot.frameIndex);
        const bool made = marchedFor(of, view, screen);
        const March& march = of.march;
        if (made) {
            list.marched = {march.items.data(), march.count};
            list.cards = {march.cards.data(), march.cardCount};
            list.sliced = {march.sliced.data(), march.slicedCount};
            list.volumeRuns = {march.order.runs.data(), march.order.count};
        } else {
            const uint32_t slabs = target.key.attachesDepth() ? kVolumeSlabs : 1;
            const uint32_t count = orderVolumes(slabs, items), least = leastRays(of, view, screen);
            uint32_t whole = 0, cut = 0;
            for (uint32_t i = 0; i < count; ++i) {
                if (volumes[items[i].flame].tier == FW_FIRE_TIER_SLICES &&
                    slicesShow(screen.encoding)) {
                    sliced[cut] = layVolumeSlices(items[i]);
                    order.add(kVolumeSlicesPass, cut++);
                } else {
                    items[whole] = items[i];
                    VolumeDraw& draw = items[whole].draw;
                    volumeRays(screen, draw);
                    draw.perPixel = std::max(draw.perPixel, least);
                    order.add(kVolumePass, whole++);
                }
            }
            list.volumes = {items.data(), whole};
            list.sliced = {sliced.data(), cut};
            list.volumeRuns = {order.runs.data(), order.count};
        }
        if (target.key.haze && lent.color)
            list.hazes = {hazes.data(), orderHazes(made ? &march : nullptr, view.haze, hazes)};
    }
    for (const DrawStep& step : drawSteps()) {
        const uint32_t i = step.pass;
        const DrawPass& pass = *drawPasses()[i];
        const bool surface = pass.vertexInput == VertexInput::mesh;
        if (!target.pipelines[i] || !drawStepDraws(step, list)) continue;
        if (part != DrawPart::all && (pass.atHalf == AtHalf::soft) != (part == DrawPart::half))
            continue;
        if ((crossing & kSwitchNoZPass) && &pass == &kZPass) continue;
        if (&pass == &kVolumePass) {
            for (const VolumeRun& run : list.volumeRuns)
                recordVolumeDraws(slot, commands, target, list, run, viewOffset, lent);
            continue;
        }
        if (&pass == &kVolumeHazePass) {
            const VolumeRun run{&pass, 0, uint32_t(list.hazes.size())};
            recordVolumeDraws(slot, commands, target, list, run, viewOffset, lent);
            continue;
        }
        slot.timers.begin(device, commands, pass.name);
        if (&pass == &kTransparencyPass) {
            recordTransparency(commands, target, lent);
            slot.timers.end(device, commands);
            continue;
        }
        if (&pass == &kHalfCompositePass) {
            recordHalfComposite(commands, target, *half, viewport, lent);
            slot.timers.end(device, commands);
            continue;
        }
        if (&pass == &kFieldDrawPasses[0]) {
            recordFieldDraws(commands, target, i, list.fields, viewOffset, lent.depth);
            slot.timers.end(device, commands);
            continue;
        }
        const VkPipelineLayout layout = context.pipelines.draw(i).layout;
        vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, target.pipelines[i]);
        bool usesView = false;
        for (const Use& use : pass.uses) usesView |= use.access == Access::uniformView;
        const VkDescriptorSet set = sets.draw(i, drawnView);
        vk.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0, 1, &set,
                                 usesView ? 1 : 0, &viewOffset);
        vk.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 2, 1,
                                 &lookTextures.set.set, 0, nullptr);
        if (&pass == &kBookFlamesPasses[0] || &pass == &kBookFlamesPasses[1] ||
            &pass == &kHalfSparksPasses[1])
            vk.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 1, 1,
                                     &books.set.set, 0, nullptr);
        if (lent.depth)
            vk.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 3, 1,
                                     &lent.depth, 0, nullptr);
        if (surface) {
            const VkDeviceSize zeros[2] = {};
            const VkBuffer vertices[2] = {drawVertices, drawVertices};
            vk.CmdBindVertexBuffers(commands, 0, 2, vertices, zeros);
            vk.CmdBindIndexBuffer(commands, drawIndices, 0, VK_INDEX_TYPE_UINT32);
        }
        PassRecorder recorder(*this, commands, i, viewOffset);
        recordDrawStep(step, recorder, list);
        slot.timers.end(device, commands);
    }
}

void VkBackend::State::recordTransparency(VkCommandBuffer commands, const Target& target,
                                          const Lent& lent) const noexcept {
    const Table& vk = device.table;
    const size_t number = passNumber(kTransparencyPass);
    const std::array<float, 4> share{transparency, transparency, transparency, transparency};
    vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, target.pipelines[number]);
    vk.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS,
                             context.pipelines.draw(number).layout, 1, 1, &lent.color, 0, nullptr);
    vk.CmdSetBlendConstants(commands, share.data());
    vk.CmdDraw(commands, 6, 1, 0, 0);
}

void VkBackend::State::recordVolumeDraws(FrameInFlight& slot, VkCommandBuffer commands,
                                         const Target& target, const DrawList& list,
                                         const VolumeRun& run, uint32_t viewOffset,
                                         const Lent& lent) {
    const Table& vk = device.table;
    const size_t number = passNumber(*run.pass);
    if (!target.pipelines[number]) return;
    slot.timers.begin(device, commands, run.pass->name);
    const VkPipelineLayout layout = context.pipelines.draw(number).layout;
    const auto bind = [&](uint32_t place, const VkDescriptorSet& set) {
        vk.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, place, 1, &set,
                                 0, nullptr);
    };
    vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, target.pipelines[number]);
    // Who sees one flame at a time binds its set 0 for each.
    const bool haze = run.pass == &kVolumeHazePass;
    const bool each = haze || run.pass == &kVolumePass || run.pass == &kVolumeSlicesPass;
    if (!each) bind(0, sets.draw(number, drawnView));
    if (haze) bind(1, lent.color);
    bind(2, each ? profiles.set.set : lookTextures.set.set);
    if (lent.depth) bind(3, lent.depth);
    PassRecorder recorder(*this, commands, number, viewOffset);
    recordVolumeRun(run, recorder, list);
    slot.timers.end(device, commands);
}

// Whether triangles that are counter-clockwise from outside count as backs in a view: hosts' views
// may be mirrored.
bool VkBackend::State::turnsFaces(const FwView& view, const VkViewport& viewport) const noexcept {
    ViewInput input;
    input.view = &view;
    input.viewport[2] = input.viewport[3] = kAnyHeight;
    ViewParams p{};
    limits.looks.viewParams(input, p);
    const glm::vec3 x(p.clip0.x, p.clip1.x, p.clip2.x), y(p.clip0.y, p.clip1.y, p.clip2.y);
    const float handed = glm::dot(glm::cross(x, y), glm::vec3(p.forward));
    return (handed < 0) != (viewport.height < 0);
}

// Hosts' views come and go: a set is written for each use, never kept with a view.
VkDescriptorSet VkBackend::State::lentSetFor(FrameInFlight& slot, VkImageView view,
                                             VkImageLayout layout) {
    const Table& vk = device.table;
    constexpr uint32_t kSets = FrameInFlight::kLentSets;
    if (!slot.lentPool) {
        const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, kSets};
        auto info =
            typed<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
        info.maxSets = kSets;
        info.poolSizeCount = 1;
        info.pPoolSizes = &size;
        VkDescriptorPool pool = VK_NULL_HANDLE;
        device.check(
            vk.CreateDescriptorPool(device.handle, &info, device.allocationCallbacks, &pool),
            "vkCreateDescriptorPool");
        std::array<VkDescriptorSetLayout, kSets> layouts{};
        layouts.fill(context.pipelines.imageSetLayout());
        auto allocate =
            typed<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
        allocate.descriptorPool = pool;
        allocate.descriptorSetCount = kSets;
        allocate.pSetLayouts = layouts.data();
        const VkResult result =
            vk.AllocateDescriptorSets(device.handle, &allocate, slot.lentSets.data());
        if (result != VK_SUCCESS) {
            vk.DestroyDescriptorPool(device.handle, pool, device.allocationCallbacks);
            device.check(result, "vkAllocateDescriptorSets");
        }
        slot.lentPool = pool;
    }
    if (slot.lentSetCount == kSets)
        core::fail(
            FW_ERROR_INVALID_ARGUMENT,
            "A frame is drawn more than %u times against a sampled depth; that is the limit.",
            FrameInFlight::kLentDraws);
    const VkDescriptorSet set = slot.lentSets[slot.lentSetCount++];
    const VkDescriptorImageInfo image{context.pipelines.depthSampler(), view, layout};
    auto write = typed<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
    write.dstSet = set;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    write.pImageInfo = &image;
    vk.UpdateDescriptorSets(device.handle, 1, &write, 0, nullptr);
    return set;
}

// What the target's passes read of what the host lends; throws where that cannot be.
VkBackend::State::Lent VkBackend::State::lentFor(FrameInFlight& slot, const Target& target,
                                                 const FwVulkanFrame& frame, VkImageView depth,
                                                 VkImageLayout depthLayout) {
    Lent lent;
    if (target.key.samplesDepth()) lent.depth = lentSetFor(slot, depth, depthLayout);
    if ((target.key.haze || isMixed(frame)) && frame.sampledColor)
        lent.color = lentSetFor(slot, frame.sampledColor, frame.sampledColorLayout);
    return lent;
}

bool VkBackend::recordInside(const FwVulkanFrame& frame, FwTargetId targetId, const FwView& view,
                             const VkViewport& viewport) {
    State& s = *state_;
    s.failIfLost();
    if (!s.context.pipelines.ready()) return false;
    const Target& target = *s.context.pipelines.findTarget(targetId);
    if (target.key.composite)
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "The target was registered with FW_TARGET_COMPOSITE; it is for "
                   "fwWorld_RecordComposite.");
    if (target.key.samplesDepth()) {
        if (!frame.sampledDepth)
            core::fail(FW_ERROR_INVALID_ARGUMENT,
                       "FwVulkanFrame::sampledDepth is null but the target has FW_DEPTH_SAMPLED.");
        if (frame.sampledDepthLayout != VK_IMAGE_LAYOUT_GENERAL &&
            frame.sampledDepthLayout != VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL &&
            frame.sampledDepthLayout != VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL)
            core::fail(FW_ERROR_INVALID_ARGUMENT,
                       "FwVulkanFrame::sampledDepthLayout is %d; our shaders read images that are "
                       "in GENERAL (1), DEPTH_STENCIL_READ_ONLY_OPTIMAL (4) or "
                       "SHADER_READ_ONLY_OPTIMAL (5).",
                       int(frame.sampledDepthLayout));
        if (viewport.minDepth != 0.0f || viewport.maxDepth != 1.0f)
            core::fail(FW_ERROR_INVALID_ARGUMENT,
                       "viewport->minDepth is %g and maxDepth is %g; FW_DEPTH_SAMPLED needs 0 "
                       "and 1.",
                       double(viewport.minDepth), double(viewport.maxDepth));
    }
    checkLentColor(target, frame);
    const VkPhysicalDeviceLimits& limits = s.device.properties.limits;
    if (viewport.width > float(limits.maxViewportDimensions[0]) ||
        viewport.height > float(limits.maxViewportDimensions[1]))
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "viewport is %g x %g pixels; the device's maxViewportDimensions are %u x %u.",
                   double(viewport.width), double(viewport.height), limits.maxViewportDimensions[0],
                   limits.maxViewportDimensions[1]);
    s.ring.pace(frame, false);
    FrameInFlight& slot = s.ring.slotFor(frame.frameIndex);
    s.scissor = frame.scissor;
    s.transparency = frame.transparency;
    s.recordDraws(slot, frame.commandBuffer, target, view, viewport,
                  s.lentFor(slot, target, frame, frame.sampledDepth, frame.sampledDepthLayout));
    return true;
}

bool VkBackend::recordComposite(const FwVulkanFrame& frame, FwTargetId targetId, const FwView& view,
                                const FwVulkanComposite& images) {
    State& s = *state_;
    s.failIfLost();
    if (!s.context.pipelines.ready()) return false;
    const Target& target = *s.context.pipelines.findTarget(targetId);
    if (!target.key.composite)
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "The target was registered without FW_TARGET_COMPOSITE; it is for "
                   "fwWorld_RecordInside.");
    const bool hasDepth = target.key.depthMode != FW_DEPTH_NONE;
    if (images.color.layoutBefore == VK_IMAGE_LAYOUT_UNDEFINED)
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "FwVulkanComposite::color.layoutBefore is VK_IMAGE_LAYOUT_UNDEFINED; the "
                   "image would lose what the host drew.");
    if (hasDepth && (!images.depth.image || !images.depth.view))
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "FwVulkanComposite::depth is null but the target has depth mode %u.",
                   uint32_t(target.key.depthMode));
    if (hasDepth && images.depth.layoutBefore == VK_IMAGE_LAYOUT_UNDEFINED)
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "FwVulkanComposite::depth.layoutBefore is VK_IMAGE_LAYOUT_UNDEFINED; the image "
                   "would lose the depth that is to be tested or sampled.");
    const auto checkImage = [](const FwVulkanImage& image, const char* name) {
        const auto refuse = [&](const char* field, uint32_t value, const char* why) {
            core::fail(FW_ERROR_INVALID_ARGUMENT, "FwVulkanComposite::%s.%s is %u; %s.", name,
                       field, value, why);
        };
        if (image.layoutAfter == VK_IMAGE_LAYOUT_UNDEFINED ||
            image.layoutAfter == VK_IMAGE_LAYOUT_PREINITIALIZED)
            refuse("layoutAfter", uint32_t(image.layoutAfter),
                   "no image can be brought to that layout; name the one of its next use");
        if (image.stageBefore == 0)
            refuse("stageBefore", 0,
                   "name the stages that used the image last, or TOP_OF_PIPE (1)");
        if (image.stageAfter == 0)
            refuse("stageAfter", 0,
                   "name the stages that use the image next, or BOTTOM_OF_PIPE (8192)");
    };
    checkImage(images.color, "color");
    if (hasDepth) checkImage(images.depth, "depth");
    checkLentColor(target, frame);
    if (images.width == 0 || images.height == 0) return true;
    const VkPhysicalDeviceLimits& limits = s.device.properties.limits;
    if (images.width > limits.maxFramebufferWidth || images.height > limits.maxFramebufferHeight)
        core::fail(
            FW_ERROR_INVALID_ARGUMENT,
            "FwVulkanComposite is %u x %u pixels; the device's largest framebuffer is %u x %u.",
            images.width, images.height, limits.maxFramebufferWidth, limits.maxFramebufferHeight);
    s.ring.pace(frame, false);
    FrameInFlight& slot = s.ring.slotFor(frame.frameIndex);
    const State::Lent lent = s.lentFor(slot, target, frame, images.depth.view,
                                       VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
    const VkFramebuffer framebuffer = s.framebufferFor(slot, target, targetId, images);
    s.scissor = frame.scissor;
    s.transparency = frame.transparency;

    const Table& vk = s.device.table;
    const VkCommandBuffer commands = frame.commandBuffer;
    std::array<VkImageMemoryBarrier, 2> in{}, out{};
    const uint32_t count = hasDepth ? 2 : 1;
    VkPipelineStageFlags before = images.color.stageBefore, after = images.color.stageAfter;
    VkPipelineStageFlags ours = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    for (uint32_t i = 0; i < count; ++i) {
        const FwVulkanImage& image = i ? images.depth : images.color;
        const bool sampled = i && target.key.samplesDepth();
        const VkAccessFlags access = sampled ? VkAccessFlags(VK_ACCESS_SHADER_READ_BIT)
                                     : i     ? kDepthAccess
                                             : kColorAccess;
        const VkImageLayout layout = sampled ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL
                                     : i     ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL
                                             : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
        in[i] = out[i] = imageBarrier(image, i == 1, target.key.depth);
        in[i].srcAccessMask = image.accessBefore;
        in[i].dstAccessMask = access;
        in[i].oldLayout = image.layoutBefore;
        in[i].newLayout = layout;
        out[i].srcAccessMask = access;
        out[i].dstAccessMask = image.accessAfter;
        out[i].oldLayout = layout;
        out[i].newLayout = image.layoutAfter;
        if (i) {
            before |= image.stageBefore;
            after |= image.stageAfter;
            ours |= sampled ? VkPipelineStageFlags(VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT)
                            : kDepthStages;
        }
    }
    if (!before) before = VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT;
    if (!after) after = VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT;
    vk.CmdPipelineBarrier(commands, before, ours, 0, 0, nullptr, 0, nullptr, count, in.data());
    const VkViewport viewport{0, 0, float(images.width), float(images.height), 0, 1};
    const HalfImages* half =
        target.key.half ? s.recordHalf(slot, commands, target, view, viewport, lent) : nullptr;
    auto begin = typed<VkRenderPassBeginInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO);
    begin.renderPass = target.ownPass;
    begin.framebuffer = framebuffer;
    begin.renderArea.extent = {images.width, images.height};
    vk.CmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    s.recordDraws(slot, commands, target, view, viewport, lent,
                  target.key.half ? DrawPart::over : DrawPart::all, half);
    vk.CmdEndRenderPass(commands);
    vk.CmdPipelineBarrier(commands, ours, after, 0, 0, nullptr, 0, nullptr, count, out.data());
    return true;
}

VkFramebuffer VkBackend::State::framebufferFor(FrameInFlight& slot, const Target& target,
                                               FwTargetId targetId,
                                               const FwVulkanComposite& composite) {
    const bool hasDepth = target.key.attachesDepth();
    const std::array<VkImageView, 2> attachments{composite.color.view,
                                                 hasDepth ? composite.depth.view : VK_NULL_HANDLE};
    const bool keep = (composite.flags & FW_COMPOSITE_KEEP) != 0;
    KeptFramebuffer* room = nullptr;
    if (!keep) dropFramebuffers(targetId);
    for (KeptFramebuffer& one : framebuffers) {
        if (!keep || one.dropped || one.target.index1 != targetId.index1 ||
            one.target.generation != targetId.generation || one.color != attachments[0] ||
            one.depth != attachments[1] || one.width != composite.width ||
            one.height != composite.height)
            continue;
        one.lastFrame = slot.frameIndex;
        return one.handle;
    }
    if (keep) {
        dropFramebuffers({});
        for (KeptFramebuffer& one : framebuffers)
            if (!room && !one.handle) room = &one;
    }
    // More than are kept come and go with their frame.
    if (!room && slot.framebufferCount == slot.framebuffers.size())
        core::fail(FW_ERROR_INVALID_ARGUMENT, "A frame has more than %zu composites.",
                   slot.framebuffers.size());
    auto info = typed<VkFramebufferCreateInfo>(VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO);
    info.renderPass = target.ownPass;
    info.attachmentCount = hasDepth ? 2 : 1;
    info.pAttachments = attachments.data();
    info.width = composite.width;
    info.height = composite.height;
    info.layers = 1;
    VkFramebuffer framebuffer = VK_NULL_HANDLE;
    device.check(device.table.CreateFramebuffer(device.handle, &info, device.allocationCallbacks,
                                                &framebuffer),
                 "vkCreateFramebuffer");
    if (room)
        *room = {framebuffer,     targetId,         attachments[0],  attachments[1],
                 composite.width, composite.height, slot.frameIndex, false};
    else
        slot.framebuffers[slot.framebufferCount++] = framebuffer;
    return framebuffer;
}

void VkBackend::State::dropFramebuffers(FwTargetId forget) noexcept {
    for (KeptFramebuffer& one : framebuffers) {
        if (!one.handle) continue;
        const bool forgotten =
            one.target.index1 == forget.index1 && one.target.generation == forget.generation;
        one.dropped |= forgotten || !context.pipelines.isTarget(one.target);
        if (!one.dropped || one.lastFrame > ring.completed()) continue;
        device.table.DestroyFramebuffer(device.handle, one.handle, device.allocationCallbacks);
        one = {};
    }
}

void VkBackend::State::destroyFramebuffers() noexcept {
    for (KeptFramebuffer& one : framebuffers)
        device.table.DestroyFramebuffer(device.handle, one.handle, device.allocationCallbacks);
    framebuffers = {};
}

}  // namespace fw::gpu::vk
