#include "gpu/vk/view_draws.h"

#include "core/reserved.h"
#include "gpu/extension.h"
#include "gpu/vk/backend_state.h"
#include "shared/volume_haze.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace fw::gpu::vk {
namespace {

// One pass bound, then its draws.
class PassRecorder {
 public:
    PassRecorder(BackendState& state, VkCommandBuffer commands, uint32_t pass, uint32_t viewOffset)
        : s_(state),
          commands_(commands),
          number_(pass),
          viewOffset_(viewOffset),
          pass_(drawPasses()[pass]),
          objects_(state.context.pipelines.draw(pass)),
          layout_(objects_.layout) {}

    // The pipeline and the sets that all its draws share. Draws of single flames bind set 0.
    void bind(VkPipeline pipeline, const HostImages& host) {
        const Table& vk = s_.device.table;
        vk.CmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        const std::span<const Use> uses = objects_.declared.uses();
        const bool eachFlame = std::any_of(uses.begin(), uses.end(), [](const Use& use) {
            return use.resource == FW_BIND_VOLUMES;
        });
        if (!eachFlame && !uses.empty())
            bindSet(0, s_.sets.draw(number_, s_.targets.drawnView),
                    std::span(&viewOffset_, objects_.declared.usesView() ? 1 : 0));
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
        const auto& images = s_.scene.images;
        const bool shows =
            item.image && item.image - 1 < images.size() && images[item.image - 1].live;
        const ImageEntry& image = shows ? images[item.image - 1] : s_.scene.white;
        if (image.set.set != bound_) bindSet(1, image.set.set);
        bound_ = image.set.set;
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
        const Buffer& buffer = s_.buffers.buffer(resourceOf(resource, s_.targets.drawnView));
        s_.device.table.CmdDrawIndirect(commands_, buffer.handle, offset, 1, 0);
    }
    // A volumetric flame, of vertices that the shader makes.
    void drawVolume(uint32_t flame, const void* push, uint32_t vertices, uint32_t instances) {
        // In the order of their bindings: the view, the flame.
        const std::array<uint32_t, 2> offsets{viewOffset_, flame * kVolumeFlameBytes};
        bindSet(0, s_.sets.draw(number_, s_.targets.drawnView), offsets);
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
    void bindSet(uint32_t place, VkDescriptorSet set, std::span<const uint32_t> offsets = {}) {
        FW_ASSERT(set, "set %u of pass %s", place, pass_.name);
        s_.device.table.CmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_,
                                              place, 1, &set, uint32_t(offsets.size()),
                                              offsets.data());
    }
    void bindTextures(uint32_t place, Textures textures, const HostImages& host) {
        switch (textures) {
            case Textures::none:
            case Textures::ofItem:
                return;  // bound with each item
            case Textures::flipbooks:
                return bindSet(place, s_.scene.flipbooks.set.set);
            case Textures::hostColor:
                return bindSet(place, host.color);
            case Textures::appearances:
                return bindSet(place, s_.scene.appearanceTextures.set.set);
            case Textures::profiles:
                return bindSet(place, s_.scene.profiles.set.set);
            case Textures::halfColor:
                return bindSet(place, host.half->color.set.set);
            case Textures::halfDepth:
                return bindSet(place, host.half->depth.set.set);
        }
    }
    void pushConstants(const void* push) {
        if (pass_.pushBytes)
            s_.device.table.CmdPushConstants(
                commands_, layout_, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                pass_.pushBytes, push);
    }

    BackendState& s_;
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

constexpr float kFacesHeight = 1000;  // px; faces turn alike in any

// Whether triangles that are counter-clockwise from outside count as backs in a view: hosts' views
// may be mirrored.
bool turnsFaces(const BackendState& s, const FwView& view, const VkViewport& viewport) noexcept {
    const ViewParams p = s.paramsOf(view, kFacesHeight, kFacesHeight);
    const glm::vec3 x(p.clip0.x, p.clip1.x, p.clip2.x), y(p.clip0.y, p.clip1.y, p.clip2.y);
    const float handed = glm::dot(glm::cross(x, y), glm::vec3(p.forward));
    return (handed < 0) != (viewport.height < 0);
}

}  // namespace

void setViewport(const BackendState& s, VkCommandBuffer commands,
                 const VkViewport& viewport) noexcept {
    s.device.table.CmdSetViewport(commands, 0, 1, &viewport);
    const float left = std::max(viewport.x, 0.0f), top = std::max(viewport.y, 0.0f);
    VkRect2D shown{{int32_t(left), int32_t(top)}, {}};
    // Whole pixels: half of an odd number of them ends in one.
    shown.extent = {uint32_t(std::ceil(std::max(viewport.x + viewport.width - left, 0.0f))),
                    uint32_t(std::ceil(std::max(viewport.y + viewport.height - top, 0.0f)))};
    if (s.targets.scissor.extent.width != 0) {
        const auto meet = [](int32_t& offset, uint32_t& extent, int32_t by, uint32_t byExtent) {
            const int64_t end = std::min(int64_t(offset) + extent, int64_t(by) + byExtent);
            offset = std::max(offset, by);
            extent = uint32_t(std::max<int64_t>(end - offset, 0));
        };
        meet(shown.offset.x, shown.extent.width, s.targets.scissor.offset.x,
             s.targets.scissor.extent.width);
        meet(shown.offset.y, shown.extent.height, s.targets.scissor.offset.y,
             s.targets.scissor.extent.height);
    }
    s.device.table.CmdSetScissor(commands, 0, 1, &shown);
}

namespace {

constexpr bool isSoft(DrawPhase phase) noexcept {
    return phase == DrawPhase::Fields || phase == DrawPhase::Flames || phase == DrawPhase::Volumes;
}

// The draws of one view in one target, phase by phase.
class ViewDraws {
 public:
    ViewDraws(BackendState& state, FrameInFlight& slot, VkCommandBuffer commands,
              const Target& target, const VkViewport& viewport, const HostImages& host,
              DrawPart part, uint32_t viewOffset)
        : s_(state),
          slot_(slot),
          commands_(commands),
          target_(target),
          viewport_(viewport),
          host_(host),
          part_(part),
          viewOffset_(viewOffset),
          surfaceSteps_(state.surfaces.steps()) {}

    // Collects the fields and volumetric flames that the view shows. A flame that was not marched
    // for this view is marched while it is drawn.
    void prepare(OutsideView& of, const FwView& view, const VolumeScreen& screen);
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

    BackendState& s_;
    FrameInFlight& slot_;
    VkCommandBuffer commands_;
    const Target& target_;
    const VkViewport& viewport_;
    const HostImages& host_;
    DrawPart part_;
    uint32_t viewOffset_;
    std::span<const SurfaceStep> surfaceSteps_;
    bool turned_ = false;  // counter-clockwise triangles turn their backs to the view
    uint32_t fieldCount_ = 0, hazeCount_ = 0;
    std::array<FieldItem, kMaxFields> fields_;
    std::array<HazedVolume, kMaxVolumeFlames> hazes_;
    // Volumetric flames by pass, and the order of all of them.
    std::array<VolumeItem, kMaxVolumeFlames> items_;
    std::array<VolumeCall, kMaxVolumeFlames> ownCalls_;
    const VolumeCall* calls_ = nullptr;
    const March* march_ = nullptr;
    VolumeOrder ownOrder_;
    const VolumeOrder* order_ = nullptr;
};

void ViewDraws::prepare(OutsideView& of, const FwView& view, const VolumeScreen& screen) {
    turned_ = turnsFaces(s_, view, viewport_);
    fieldCount_ = s_.particleFields.order(s_, fields_);
    if (!target_.key.flames || s_.flames.volumes.empty()) return;
    of.recordScreen(view, screen, slot_.frameIndex);
    if (of.isMarchedFor(view, screen)) {
        march_ = &of.march;
        calls_ = march_->calls.data();
        order_ = &march_->order;
    } else {
        const uint32_t slabs = target_.key.attachesDepth() ? kVolumeSlabs : 1;
        const uint32_t count = s_.flames.order(s_, slabs, items_);
        const uint32_t least = of.minRays(view, screen);
        uint32_t whole = 0, called = 0;
        for (uint32_t i = 0; i < count; ++i) {
            if (items_[i].body1 != 0) continue;  // shown where it was marched
            if (s_.flames.volumes[items_[i].flame].tier == core::reserved::kFireTier &&
                extension()->showsVolumes(screen.encoding)) {
                ownCalls_[called] = extension()->volumeCall(items_[i], 0, 1);
                ownOrder_.add(draw::Number(extension()->volumePass), called++);
            } else {
                items_[whole] = items_[i];
                VolumeDraw& draw = items_[whole].draw;
                volumeRays(screen, draw);
                draw.perPixel = std::max(draw.perPixel, least);
                ownOrder_.add(draw::volume, whole++);
            }
        }
        calls_ = ownCalls_.data();
        order_ = &ownOrder_;
    }
    if (target_.key.haze && host_.color)
        hazeCount_ = s_.flames.orderHazes(s_, march_, view.haze, hazes_);
}

bool ViewDraws::hasWork(DrawPhase phase) const noexcept {
    const bool quads = s_.showsQuads();
    switch (phase) {
        case DrawPhase::OpaqueFresh:
        case DrawPhase::OpaqueBurning:
        case DrawPhase::DepthFirst:
        case DrawPhase::OpaqueOverDepth:
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
            return s_.targets.transparency > 0.0f;
        case DrawPhase::Count:
            break;
    }
    return false;
}

void ViewDraws::record(DrawPhase phase) {
    switch (phase) {
        case DrawPhase::OpaqueFresh:
        case DrawPhase::OpaqueBurning:
        case DrawPhase::DepthFirst:
        case DrawPhase::OpaqueOverDepth:
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
                !s_.scene.flipbooks.live         ? draw::flames
                : s_.particles.onlyFlipbooks(s_) ? draw::flipbook_flames_only
                                                 : draw::flipbook_flames,
                [&](PassRecorder& recorder) { recorder.drawIndirect(FW_BIND_DRAW_ARGS, 0); });
        case DrawPhase::Volumes:
            for (const VolumeRun& run : std::span(order_->runs).first(order_->count))
                recordVolumes(run);
            return;
        case DrawPhase::HalfResolutionComposite:
            return recordPass(draw::half_composite, [&](PassRecorder& recorder) {
                const HalfPush push = halfPushFor(s_, viewport_);
                recorder.drawVertices(&push, 6 * push.tilesX * push.tilesY);
            });
        case DrawPhase::Sparks:
            return recordPass(
                s_.scene.flipbooks.live ? draw::half_flipbook_sparks : draw::half_sparks,
                [&](PassRecorder& recorder) {
                    recorder.drawIndirect(FW_BIND_DRAW_ARGS, kFlameEmissiveDraw * 4);
                });
        case DrawPhase::Transparency:
            return recordPass(draw::transparency, [&](PassRecorder& recorder) {
                const float share = s_.targets.transparency;
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
        surfaceSteps_.begin(), surfaceSteps_.end(), SurfaceStep{phase},
        [](const SurfaceStep& a, const SurfaceStep& b) { return a.phase < b.phase; });
    return {range.first, range.second};
}

void ViewDraws::recordSurfaces(DrawPhase phase) {
    const std::span<const SurfaceStep> steps = surfacesOf(phase);
    for (size_t first = 0, end = 0; first < steps.size(); first = end) {
        const uint32_t pass = steps[first].pass;
        while (end < steps.size() && steps[end].pass == pass) ++end;
        const bool depthAlone = phase == DrawPhase::DepthFirst;
        if (depthAlone && (s_.crossing & kSwitchNoDepthFirst)) continue;
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
                    recorder.drawVertices(&march_->impostors[i], kVolumeSplitVertices);
                    break;
                case draw::body_composite:
                case draw::volume_composite: {
                    const MarchedVolume& one = march_->items[i];
                    recorder.drawListed(
                        FW_BIND_VOLUME_WORK,
                        one.march.flame * sizeof(VolumeWork) + offsetof(VolumeWork, vertices),
                        &one.composite);
                    break;
                }
                case draw::volume:
                    recorder.drawVolume(items_[i].flame, &items_[i].draw, kVolumeSplitVertices,
                                        items_[i].draw.slabs);
                    break;
                default:  // the extension's
                    recorder.drawVolume(calls_[i].flame, calls_[i].push.data(), calls_[i].vertices,
                                        calls_[i].instances);
            }
        }
    });
}

}  // namespace

namespace {

constexpr uint64_t kQuadsKept = 60;  // frames that flame quads are there after a view needed them

// On which a part of a view's draws shows its marches.
VolumeScreen screenOf(const BackendState& s, const Target& target, const VkViewport& viewport,
                      DrawPart part) noexcept {
    const float share = part == DrawPart::over ? 0.5f : 1.0f;
    return s.flames.screenOf(s, target.key,
                             {share * viewport.width, share * std::fabs(viewport.height)});
}

}  // namespace

void recordDraws(BackendState& s, FrameInFlight& slot, VkCommandBuffer commands,
                 const Target& target, const FwView& view, const VkViewport& viewport,
                 const HostImages& host, DrawPart part) {
    if (!s.showsAnything() || s.targets.transparency >= 1.0f) return;
    OutsideView& of = s.outsideViews.viewFor(s.sets, view);
    s.targets.drawnView = of.number;
    const VolumeScreen screen = screenOf(s, target, viewport, part);
    if (s.flames.bodyCount > 0 && target.key.flames) {
        s.flames.bodiesShow = of.isMarchedFor(view, screen);
        if (!s.flames.bodiesShow) s.flames.quadsUntil = slot.frameIndex + kQuadsKept;
    }
    const uint32_t viewOffset = s.pushView(slot, view, viewport);
    if (part != DrawPart::half) {
        const float height = std::fabs(viewport.height);
        if (view.viewId == of.view.viewId || sameView(view, of.view)) of.height = height;
        markVisible(s, view, height, slot.frameIndex);
    }
    setViewport(s, commands, viewport);
    ViewDraws draws(s, slot, commands, target, viewport, host, part, viewOffset);
    draws.prepare(of, view, screen);
    draws.record();
    s.flames.bodiesShow = false;
}

}  // namespace fw::gpu::vk
