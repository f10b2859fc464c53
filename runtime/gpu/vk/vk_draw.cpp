// Drawing: inside the host's pass, or as a composite over the host's images. Draws only; what they
// read was made ready by the outside part.
#include "core/error.h"
#include "gpu/vk/world_state.h"
#include "shared/volume_haze.h"
#include "shared/volume_slices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace fw::gpu::vk {
namespace {

// One pass bound, then its draws.
class PassRecorder {
 public:
    PassRecorder(VkBackend::State& state, VkCommandBuffer commands, uint32_t pass,
                 uint32_t viewOffset)
        : s_(state),
          commands_(commands),
          number_(pass),
          viewOffset_(viewOffset),
          pass_(drawPasses()[pass]),
          objects_(state.context.pipelines.draw(pass)),
          layout_(objects_.layout) {}

    // The pipeline and what all its draws share. A flame at a time has set 0 bound with it.
    void bind(VkPipeline pipeline, const HostImages& host) {
        const Table& vk = s_.device.table;
        vk.CmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        const std::span<const Use> uses = objects_.declared.uses();
        const bool eachFlame = std::any_of(uses.begin(), uses.end(), [](const Use& use) {
            return use.resource == FW_BIND_VOLUMES;
        });
        if (!eachFlame && !uses.empty()) {
            const VkDescriptorSet set = s_.sets.draw(number_, s_.surfaces.drawnView);
            vk.CmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, 1,
                                     &set, objects_.declared.usesView() ? 1 : 0, &viewOffset_);
        }
        bindTextures(1, pass_.textures1, host);
        bindTextures(2, pass_.textures2, host);
        if (pass_.softShader && host.depth) bindSet(3, host.depth);
        if (pass_.vertexInput == VertexInput::mesh) {
            const VkDeviceSize zeros[2] = {};
            const VkBuffer vertices[2] = {s_.surfaces.drawVertices, s_.surfaces.drawVertices};
            vk.CmdBindVertexBuffers(commands_, 0, 2, vertices, zeros);
            vk.CmdBindIndexBuffer(commands_, s_.surfaces.drawIndices, 0, VK_INDEX_TYPE_UINT32);
        }
    }

    void drawSurface(const DrawItem& item, bool turned) {
        const bool burning = (pass_.variant & kSurfaceBurns) != 0;
        const bool cold = (pass_.variant & kSurfaceCold) != 0;
        const bool behind = pass_.cull == Cull::front;
        SurfaceDraw draw = item.draw;
        if (!burning) draw.nearness = item.coldReach;
        if (burning && ((item.cut && !item.perPixelHoles) || (item.refined && item.consumed)))
            draw.flags |= kDrawCut;
        if (item.refined) {
            draw.flags |= kDrawPlaced;
            // A triangle that turns its back is seen from inside.
            draw.inner = item.inner;
            if (behind != turned && item.inner != 0) draw.flags |= kDrawInner;
        }
        drawItem(item, &draw,
                 burning && !item.refined && behind != turned && item.inside != kNoneTexel);
        if (!item.cut || cold) return;
        draw.flags =
            (draw.flags & ~kDrawPlaced) | kDrawCut | (item.perPixelHoles ? kDrawPerPixelHoles : 0);
        drawCut(item, &draw);
    }
    // `inside`: on its inner skin.
    void drawItem(const DrawItem& item, const void* push, bool inside) {
        const Table& vk = s_.device.table;
        bindFor(item, push);
        const uint64_t shown = !inside            ? item.shown
                               : item.insideShown ? item.inside
                                                  : kInside | item.inside;
        if (shown != shown_) bindVertices(item, shown);
        if (item.refined != refined_) {
            vk.CmdBindIndexBuffer(commands_,
                                  item.refined ? s_.buffers.buffer(FW_BIND_REFINE_INDICES).handle
                                               : s_.surfaces.drawIndices,
                                  0, VK_INDEX_TYPE_UINT32);
            refined_ = item.refined;
        }
        const bool own = shown != kNoneTexel;
        // One draw per call: several would need a feature.
        if (item.refined)
            vk.CmdDrawIndexedIndirect(
                commands_, s_.buffers.buffer(FW_BIND_REFINE_DRAWS).handle,
                (uint64_t(item.object) * kMaterialsPerObject + item.material) *
                    sizeof(VkDrawIndexedIndirectCommand),
                1, 0);
        else
            vk.CmdDrawIndexed(commands_, item.indexCount, 1, item.firstIndex,
                              own ? 0 : item.vertexOffset, 0);
    }
    // The rest of its triangles along holes.
    void drawCut(const DrawItem& item, const void* push) {
        bindFor(item, push);
        if (shown_ != kCuts) {
            const VkBuffer cuts = s_.buffers.buffer(FW_BIND_REFINE_CUTS).handle;
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
        VkDescriptorSet set = s_.scene.white.set.set;
        if (item.image && item.image - 1 < s_.scene.images.size() &&
            s_.scene.images[item.image - 1].live)
            set = s_.scene.images[item.image - 1].set.set;
        if (set != bound_) {
            vk.CmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 1, 1,
                                     &set, 0, nullptr);
            bound_ = set;
        }
        pushConstants(push);
    }
    // Of ordinary items all is bound from the first vertex on, of one with shown vertices of its
    // own, or on its inner skin, both its ranges.
    void bindVertices(const DrawItem& item, uint64_t shown) {
        static_assert(sizeof(mesh::RenderVertex) == sizeof(ShownVertex));
        const bool own = shown != kNoneTexel, inside = own && (shown & kInside) != 0;
        const VkBuffer buffers[2] = {s_.surfaces.drawVertices, own && !inside
                                                                   ? s_.surfaces.drawShown
                                                                   : s_.surfaces.drawVertices};
        const VkDeviceSize offsets[2] = {
            own ? VkDeviceSize(item.vertexOffset) * sizeof(mesh::RenderVertex) : 0,
            own ? VkDeviceSize(shown & ~kInside) * sizeof(ShownVertex) : 0};
        s_.device.table.CmdBindVertexBuffers(commands_, 0, 2, buffers, offsets);
        shown_ = shown;
    }
    // A VkDrawIndirectCommand at `offset` bytes of the resource.
    void drawIndirect(uint32_t resource, uint64_t offset) {
        const Buffer& buffer = s_.buffers.buffer(resourceOf(resource, s_.surfaces.drawnView));
        s_.device.table.CmdDrawIndirect(commands_, buffer.handle, offset, 1, 0);
    }
    // A volumetric flame, of vertices that the shader makes.
    void drawVolume(uint32_t flame, const void* push, uint32_t vertices, uint32_t instances) {
        // In the order of their bindings: the view, the flame.
        const std::array<uint32_t, 2> offsets{viewOffset_, flame * kVolumeFlameBytes};
        const VkDescriptorSet set = s_.sets.draw(number_, s_.surfaces.drawnView);
        s_.device.table.CmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_,
                                              0, 1, &set, uint32_t(offsets.size()), offsets.data());
        drawVertices(push, vertices, instances);
    }
    void drawListed(uint32_t resource, uint64_t offset, const void* push) {
        pushConstants(push);
        drawIndirect(resource, offset);
    }
    void drawVertices(const void* push, uint32_t vertices, uint32_t instances = 1,
                      uint32_t firstInstance = 0) {
        pushConstants(push);
        s_.device.table.CmdDraw(commands_, vertices, instances, 0, firstInstance);
    }

 private:
    void bindSet(uint32_t place, VkDescriptorSet set) {
        s_.device.table.CmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_,
                                              place, 1, &set, 0, nullptr);
    }
    void bindTextures(uint32_t place, Textures textures, const HostImages& host) {
        switch (textures) {
            case Textures::none:
            case Textures::ofItem:
                return;  // bound with each item
            case Textures::flipbooks:
                return bindSet(place, s_.scene.books.set.set);
            case Textures::hostColor:
                return bindSet(place, host.color);
            case Textures::looks:
                return bindSet(place, s_.scene.lookTextures.set.set);
            case Textures::profiles:
                return bindSet(place, s_.scene.profiles.set.set);
            case Textures::halfColor:
                return bindSet(place, host.half->colorSet.set);
            case Textures::halfDepth:
                return bindSet(place, host.half->depthSet.set);
        }
    }
    void pushConstants(const void* push) {
        if (pass_.pushBytes)
            s_.device.table.CmdPushConstants(
                commands_, layout_, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                pass_.pushBytes, push);
    }

    VkBackend::State& s_;
    VkCommandBuffer commands_;
    uint32_t number_;
    uint32_t viewOffset_;
    const DrawPass& pass_;
    const PassObjects& objects_;
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

// Haze is drawn where a frame gives its colour, so none is no fault.
void checkHostColor(const Target& target, const FwVulkanFrame& frame) {
    if (isMixed(frame) && !target.key.transparency)
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "FwVulkanFrame::transparency is %g and the target was registered without "
                   "FW_TARGET_TRANSPARENCY (64); only 0 and 1 are drawn there.",
                   double(frame.transparency));
    if (isMixed(frame) && !frame.sampledColor)
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "FwVulkanFrame::transparency is %g and sampledColor is null; between 0 and 1 a "
                   "copy of what the target holds is needed. Give one in FwFrameInfo, or draw into "
                   "a layer of "
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
    if (surfaces.scissor.extent.width != 0) {
        const auto meet = [](int32_t& offset, uint32_t& extent, int32_t by, uint32_t byExtent) {
            const int64_t end = std::min(int64_t(offset) + extent, int64_t(by) + byExtent);
            offset = std::max(offset, by);
            extent = uint32_t(std::max<int64_t>(end - offset, 0));
        };
        meet(shown.offset.x, shown.extent.width, surfaces.scissor.offset.x,
             surfaces.scissor.extent.width);
        meet(shown.offset.y, shown.extent.height, surfaces.scissor.offset.y,
             surfaces.scissor.extent.height);
    }
    device.table.CmdSetScissor(commands, 0, 1, &shown);
}

namespace {

constexpr bool isSoft(DrawPhase phase) noexcept {
    return phase == DrawPhase::Fields || phase == DrawPhase::Flames || phase == DrawPhase::Volumes;
}

// The draws of one view in one target, phase by phase.
class ViewDraws {
 public:
    ViewDraws(VkBackend::State& state, FrameInFlight& slot, VkCommandBuffer commands,
              const Target& target, const VkViewport& viewport, const HostImages& host,
              DrawPart part, uint32_t viewOffset)
        : s_(state),
          slot_(slot),
          commands_(commands),
          target_(target),
          viewport_(viewport),
          host_(host),
          part_(part),
          viewOffset_(viewOffset) {}

    // Collects the fields and volumetric flames that the view shows. A flame that was not marched
    // for this view is marched while it is drawn.
    void prepare(OutsideView& of, const FwView& view);
    void record() {
        for (uint32_t i = 0; i < uint32_t(DrawPhase::Count); ++i)
            if (const auto phase = DrawPhase(i); isIncluded(phase) && hasWork(phase)) record(phase);
    }

 private:
    [[nodiscard]] bool isIncluded(DrawPhase phase) const noexcept {
        return part_ == DrawPart::all || isSoft(phase) == (part_ == DrawPart::half);
    }
    [[nodiscard]] bool hasWork(DrawPhase phase) const noexcept;
    void record(DrawPhase phase);
    [[nodiscard]] std::span<const SurfaceStep> surfacesOf(DrawPhase phase) const noexcept;
    void recordSurfaces(DrawPhase phase);
    void recordVolumes(const VolumeRun& run);
    // Binds `pass`, has `draws` record with it, and times that. Nothing if the target lacks it.
    template <class Draws>
    void recordPass(uint32_t pass, const Draws& draws) {
        if (!target_.pipelines[pass]) return;
        slot_.timers.begin(s_.device, commands_, drawPasses()[pass].name);
        PassRecorder recorder(s_, commands_, pass, viewOffset_);
        recorder.bind(target_.pipelines[pass], host_);
        draws(recorder);
        slot_.timers.end(s_.device, commands_);
    }

    VkBackend::State& s_;
    FrameInFlight& slot_;
    VkCommandBuffer commands_;
    const Target& target_;
    const VkViewport& viewport_;
    const HostImages& host_;
    DrawPart part_;
    uint32_t viewOffset_;
    bool turned_ = false;  // counter-clockwise triangles turn their backs to the view
    uint32_t fieldCount_ = 0, hazeCount_ = 0;
    std::array<FieldItem, kMaxFields> fields_;
    std::array<HazedVolume, kMaxVolumeFlames> hazes_;
    // Volumetric flames by pass, and the order of all of them.
    std::array<VolumeItem, kMaxVolumeFlames> items_;
    std::array<SlicedVolume, kMaxVolumeFlames> ownSlices_;
    const SlicedVolume* slices_ = nullptr;
    const March* march_ = nullptr;
    VolumeOrder ownOrder_;
    const VolumeOrder* order_ = nullptr;
};

void ViewDraws::prepare(OutsideView& of, const FwView& view) {
    turned_ = s_.turnsFaces(view, viewport_);
    fieldCount_ = s_.orderFields(fields_);
    if (!target_.key.flames || s_.flames.volumes.empty()) return;
    const float share = part_ == DrawPart::over ? 0.5f : 1.0f;
    const VolumeScreen screen =
        s_.screenOf(target_.key, {share * viewport_.width, share * std::fabs(viewport_.height)});
    s_.recordScreen(of, view, screen, slot_.frameIndex);
    if (s_.marchedFor(of, view, screen)) {
        march_ = &of.march;
        slices_ = march_->sliced.data();
        order_ = &march_->order;
    } else {
        const uint32_t slabs = target_.key.attachesDepth() ? kVolumeSlabs : 1;
        const uint32_t count = s_.orderVolumes(slabs, items_);
        const uint32_t least = s_.minRays(of, view, screen);
        uint32_t whole = 0, cut = 0;
        for (uint32_t i = 0; i < count; ++i) {
            if (s_.flames.volumes[items_[i].flame].tier == FW_FIRE_TIER_SLICES &&
                slicesShow(screen.encoding)) {
                ownSlices_[cut] = makeSlicedVolume(items_[i]);
                ownOrder_.add(draw::volume_slices, cut++);
            } else {
                items_[whole] = items_[i];
                VolumeDraw& draw = items_[whole].draw;
                volumeRays(screen, draw);
                draw.perPixel = std::max(draw.perPixel, least);
                ownOrder_.add(draw::volume, whole++);
            }
        }
        slices_ = ownSlices_.data();
        order_ = &ownOrder_;
    }
    if (target_.key.haze && host_.color) hazeCount_ = s_.orderHazes(march_, view.haze, hazes_);
}

bool ViewDraws::hasWork(DrawPhase phase) const noexcept {
    const bool quads = !s_.simulation.burnEmpty || s_.showsEmitters();
    switch (phase) {
        case DrawPhase::OpaqueFresh:
        case DrawPhase::OpaqueBurning:
        case DrawPhase::OpaqueSelfIntersecting:
            return !surfacesOf(phase).empty();
        case DrawPhase::Distortion:
            return hazeCount_ > 0;
        case DrawPhase::Fields:
            return fieldCount_ > 0;
        case DrawPhase::Flames:
            return quads;
        case DrawPhase::Volumes:
            return order_ && order_->count > 0;
        case DrawPhase::HalfResolutionComposite:
            return host_.half != nullptr;
        case DrawPhase::Sparks:
            return quads && part_ == DrawPart::over;
        case DrawPhase::Transparency:
            return s_.surfaces.transparency > 0.0f;
        case DrawPhase::Count:
            break;
    }
    return false;
}

void ViewDraws::record(DrawPhase phase) {
    switch (phase) {
        case DrawPhase::OpaqueFresh:
        case DrawPhase::OpaqueBurning:
        case DrawPhase::OpaqueSelfIntersecting:
            return recordSurfaces(phase);
        case DrawPhase::Distortion:
            return recordPass(draw::volume_haze, [&](PassRecorder& recorder) {
                for (const HazedVolume& one : std::span(hazes_).first(hazeCount_))
                    recorder.drawVolume(one.flame, &one.draw, 6 * kHazeColumns * kHazeRows, 1);
            });
        case DrawPhase::Fields:
            for (uint32_t i = 0, end = 0; i < fieldCount_; i = end) {
                while (end < fieldCount_ && fields_[end].pass == fields_[i].pass) ++end;
                recordPass(fields_[i].pass, [&](PassRecorder& recorder) {
                    for (const FieldItem& item : std::span(fields_).subspan(i, end - i))
                        recorder.drawVertices(nullptr, item.vertices, 1, item.draw);
                });
            }
            return;
        case DrawPhase::Flames:
            return recordPass(
                !s_.scene.books.live ? draw::flames
                : s_.onlyFlipbooks() ? draw::flipbook_flames_only
                                     : draw::flipbook_flames,
                [&](PassRecorder& recorder) { recorder.drawIndirect(FW_BIND_DRAW_ARGS, 0); });
        case DrawPhase::Volumes:
            for (const VolumeRun& run : std::span(order_->runs).first(order_->count))
                recordVolumes(run);
            return;
        case DrawPhase::HalfResolutionComposite:
            return recordPass(draw::half_composite, [&](PassRecorder& recorder) {
                const HalfPush push = s_.halfPushFor(viewport_);
                recorder.drawVertices(&push, 6 * push.tilesX * push.tilesY);
            });
        case DrawPhase::Sparks:
            return recordPass(s_.scene.books.live ? draw::half_flipbook_sparks : draw::half_sparks,
                              [&](PassRecorder& recorder) {
                                  recorder.drawIndirect(FW_BIND_DRAW_ARGS, kFlameEmissiveDraw * 4);
                              });
        case DrawPhase::Transparency:
            return recordPass(draw::transparency, [&](PassRecorder& recorder) {
                const float share = s_.surfaces.transparency;
                const std::array<float, 4> constants{share, share, share, share};
                s_.device.table.CmdSetBlendConstants(commands_, constants.data());
                recorder.drawVertices(nullptr, 6);
            });
        case DrawPhase::Count:
            return;
    }
}

std::span<const SurfaceStep> ViewDraws::surfacesOf(DrawPhase phase) const noexcept {
    const auto range = std::equal_range(
        s_.surfaces.surfaceSteps.begin(), s_.surfaces.surfaceSteps.end(), SurfaceStep{phase},
        [](const SurfaceStep& a, const SurfaceStep& b) { return a.phase < b.phase; });
    return {range.first, range.second};
}

void ViewDraws::recordSurfaces(DrawPhase phase) {
    const std::span<const SurfaceStep> steps = surfacesOf(phase);
    for (size_t first = 0, end = 0; first < steps.size(); first = end) {
        const uint32_t pass = steps[first].pass;
        while (end < steps.size() && steps[end].pass == pass) ++end;
        const bool depthAlone = pass == draw::self_intersection_depth;
        if (depthAlone && (s_.crossing & kSwitchNoZPass)) continue;
        recordPass(pass, [&](PassRecorder& recorder) {
            for (const SurfaceStep& step : steps.subspan(first, end - first)) {
                const DrawItem& item = s_.surfaces.drawItems[step.item];
                if (depthAlone)
                    recorder.drawItem(item, &item.draw, false);
                else
                    recorder.drawSurface(item, turned_);
            }
        });
    }
}

// Neighbours that one pass draws, farthest first.
void ViewDraws::recordVolumes(const VolumeRun& run) {
    recordPass(run.pass, [&](PassRecorder& recorder) {
        for (uint32_t i = run.first; i < run.first + run.count; ++i) {
            switch (run.pass) {
                case draw::volume_impostor:
                    recorder.drawVertices(&march_->cards[i], kVolumeSplitVertices);
                    break;
                case draw::volume_composite: {
                    const MarchedVolume& one = march_->items[i];
                    recorder.drawListed(
                        FW_BIND_VOLUME_WORK,
                        one.march.flame * sizeof(VolumeWork) + offsetof(VolumeWork, vertices),
                        &one.composite);
                    break;
                }
                case draw::volume_slices:
                    recorder.drawVolume(slices_[i].flame, &slices_[i].draw,
                                        kFlamePieces * kSliceVertices, slices_[i].draw.slices);
                    break;
                default:
                    recorder.drawVolume(items_[i].flame, &items_[i].draw, kVolumeSplitVertices,
                                        items_[i].draw.slabs);
            }
        }
    });
}

}  // namespace

void VkBackend::State::recordDraws(FrameInFlight& slot, VkCommandBuffer commands,
                                   const Target& target, const FwView& view,
                                   const VkViewport& viewport, const HostImages& host,
                                   DrawPart part) {
    if (!showsAnything() || surfaces.transparency >= 1.0f) return;
    OutsideView& of = viewFor(view);
    surfaces.drawnView = of.number;
    const uint32_t viewOffset = pushView(slot, view, viewport);
    if (part != DrawPart::half) {
        const float height = std::fabs(viewport.height);
        if (view.viewId == of.view.viewId || sameView(view, of.view)) of.height = height;
        look(view, height, slot.frameIndex);
    }
    setViewport(commands, viewport);
    if (surfaces.surfacesDirty) orderSurfaces(surfaces.drawItems, surfaces.surfaceSteps);
    surfaces.surfacesDirty = false;
    ViewDraws draws(*this, slot, commands, target, viewport, host, part, viewOffset);
    draws.prepare(of, view);
    draws.record();
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
VkDescriptorSet VkBackend::State::hostSetFor(FrameInFlight& slot, VkImageView view,
                                             VkImageLayout layout) {
    const Table& vk = device.table;
    constexpr uint32_t kSets = FrameInFlight::kHostSets;
    if (!slot.hostPool) {
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
            vk.AllocateDescriptorSets(device.handle, &allocate, slot.hostSets.data());
        if (result != VK_SUCCESS) {
            vk.DestroyDescriptorPool(device.handle, pool, device.allocationCallbacks);
            device.check(result, "vkAllocateDescriptorSets");
        }
        slot.hostPool = pool;
    }
    if (slot.hostSetCount == kSets)
        core::fail(
            FW_ERROR_INVALID_ARGUMENT,
            "A frame is drawn more than %u times against a sampled depth; that is the limit.",
            FrameInFlight::kHostDraws);
    const VkDescriptorSet set = slot.hostSets[slot.hostSetCount++];
    const VkDescriptorImageInfo image{context.pipelines.depthSampler(), view, layout};
    auto write = typed<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
    write.dstSet = set;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    write.pImageInfo = &image;
    vk.UpdateDescriptorSets(device.handle, 1, &write, 0, nullptr);
    return set;
}

// What the target's passes read of the images that the host gives; throws where that cannot be.
HostImages VkBackend::State::hostImagesFor(FrameInFlight& slot, const Target& target,
                                           const FwVulkanFrame& frame, VkImageView depth,
                                           VkImageLayout depthLayout) {
    HostImages host;
    if (target.key.samplesDepth()) host.depth = hostSetFor(slot, depth, depthLayout);
    if ((target.key.haze || isMixed(frame)) && frame.sampledColor)
        host.color = hostSetFor(slot, frame.sampledColor, frame.sampledColorLayout);
    return host;
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
    checkHostColor(target, frame);
    const VkPhysicalDeviceLimits& limits = s.device.properties.limits;
    if (viewport.width > float(limits.maxViewportDimensions[0]) ||
        viewport.height > float(limits.maxViewportDimensions[1]))
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "viewport is %g x %g pixels; the device's maxViewportDimensions are %u x %u.",
                   double(viewport.width), double(viewport.height), limits.maxViewportDimensions[0],
                   limits.maxViewportDimensions[1]);
    s.ring.pace(frame, false);
    FrameInFlight& slot = s.ring.slotFor(frame.frameIndex);
    s.surfaces.scissor = frame.scissor;
    s.surfaces.transparency = frame.transparency;
    s.recordDraws(
        slot, frame.commandBuffer, target, view, viewport,
        s.hostImagesFor(slot, target, frame, frame.sampledDepth, frame.sampledDepthLayout));
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
    checkHostColor(target, frame);
    if (images.width == 0 || images.height == 0) return true;
    const VkPhysicalDeviceLimits& limits = s.device.properties.limits;
    if (images.width > limits.maxFramebufferWidth || images.height > limits.maxFramebufferHeight)
        core::fail(
            FW_ERROR_INVALID_ARGUMENT,
            "FwVulkanComposite is %u x %u pixels; the device's largest framebuffer is %u x %u.",
            images.width, images.height, limits.maxFramebufferWidth, limits.maxFramebufferHeight);
    s.ring.pace(frame, false);
    FrameInFlight& slot = s.ring.slotFor(frame.frameIndex);
    HostImages host = s.hostImagesFor(slot, target, frame, images.depth.view,
                                      VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
    const VkFramebuffer framebuffer = s.framebufferFor(slot, target, targetId, images);
    s.surfaces.scissor = frame.scissor;
    s.surfaces.transparency = frame.transparency;

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
    if (target.key.half) host.half = s.recordHalf(slot, commands, target, view, viewport, host);
    auto begin = typed<VkRenderPassBeginInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO);
    begin.renderPass = target.ownPass;
    begin.framebuffer = framebuffer;
    begin.renderArea.extent = {images.width, images.height};
    vk.CmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    s.recordDraws(slot, commands, target, view, viewport, host,
                  target.key.half ? DrawPart::over : DrawPart::all);
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
    for (KeptFramebuffer& one : surfaces.framebuffers) {
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
        for (KeptFramebuffer& one : surfaces.framebuffers)
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
    for (KeptFramebuffer& one : surfaces.framebuffers) {
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
    for (KeptFramebuffer& one : surfaces.framebuffers)
        device.table.DestroyFramebuffer(device.handle, one.handle, device.allocationCallbacks);
    surfaces.framebuffers = {};
}

}  // namespace fw::gpu::vk
