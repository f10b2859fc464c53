// Volumetric flames on a device against the same maths marched on the CPU ray by ray, and the
// allocations of worlds with fires.
#include "components/particle_field.h"
#include "components/sparks.h"
#include "components/volumetric_fire.h"
#include "flamewright_reference.h"
#include "flipbook/own.h"
#include "flipbook/picture.h"
#include "lod/impostor_atlas.h"
#include "reference/flame_march.h"
#include "shared/spark.h"
#include "support/burn_scene.h"
#include "support/particle_reference.h"
#include "support/spark_reference.h"
#include "support/world_defs.h"
#include "world/world.h"

#include <glm/gtc/type_ptr.hpp>

#include <cmath>
#include <functional>
#include <random>

namespace fw::test::volume_test {
namespace {

constexpr uint32_t kSide = 40;  // px
const glm::vec4 kSeen(0.2126f, 0.7152f, 0.0722f, 0.0f);
constexpr VkFormat kColor = VK_FORMAT_R32G32B32A32_SFLOAT, kDepth = VK_FORMAT_D32_SFLOAT;

using gpu::vec2;
using gpu::vec3;
using gpu::vec4;

// One flame of a fire at the origin, `seconds` after it was lit.
gpu::VolumeFlame flameOf(uint32_t preset, float seconds, uint32_t flags = 0) {
    FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
    components::setFirePreset(def, preset);
    def.flags = flags;
    def.seed = 7;
    def.tier = FW_FIRE_TIER_MARCH_HIGH;
    return flameAlone(def, seconds);
}

// Varies with position only, so that sampling errors show alone.
gpu::VolumeFlame smoothFlame() {
    gpu::VolumeFlame flame = flameOf(FW_FIRE_CAMP, 1, FW_FIRE_NO_SMOKE);
    gpu::FlameRecord& r = flame.record;
    r.turbulence = r.radial = r.warp = r.columns = r.filament = r.erode = r.puff = r.blue = 0;
    return flame;
}

class Volume : public GpuTest {
 protected:
    void makeRig(PFN_vkGetInstanceProcAddr entry = nullptr, uint32_t steps = 64) {
        gpu::vk::WorldLimits limits;
        limits.rayStepCount = steps;
        limits.appearances = testAppearances();
        targets_ = {};  // of the previous rig
        index_ = 0;
        rig_ = std::make_unique<VkRig>(*device_, 2, 0, limits, entry);
        color_ = device_->makeImage(kColor, {kSide, kSide}, 1,
                                    VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                        VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                        VK_IMAGE_USAGE_TRANSFER_DST_BIT);
        depth_ =
            device_->makeImage(kDepth, {kSide, kSide}, 1,
                               VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
                                   VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
        behind_ = device_->makeImage(kColor, {kSide, kSide}, 1,
                                     VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
        scenes_ =
            device_->makeBuffer(kSide * kSide * sizeof(float), VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
        backdrops_ =
            device_->makeBuffer(kSide * kSide * sizeof(vec4), VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
        read_ = device_->makeBuffer(kSide * kSide * sizeof(vec4), VK_BUFFER_USAGE_TRANSFER_DST_BIT);
        const float eye[3] = {0.7f, 0.9f, 2.6f}, at[3] = {0, 0.45f, 0};
        look(eye, at, 30);
    }
    void lookAtSmoothFlame() {
        const float eye[3] = {0.7f, 0.9f, 2.6f}, at[3] = {0, 0.22f, 0};
        look(eye, at, 10);  // its rim covers few pixels
    }
    void look(const float eye[3], const float at[3], float degrees) {
        FwView& view = rig_->view;
        view = testView(eye, at, degrees, 1, reversed_);
        for (int i = 0; i < 3; ++i)
            view.sunColor[i] = view.ambientSky[i] = view.ambientGround[i] = 0;
        view.time = 2;
        looked_ = view;
    }
    // The view of look() in orthographic projection, `across` m wide.
    void lookParallel(float across) {
        const float near = 0.05f, far = 50.0f;
        glm::mat4 projection(1.0f);
        projection[0][0] = 2 / across;
        projection[1][1] = -2 / across;
        projection[2][2] = reversed_ ? 1 / (far - near) : 1 / (near - far);
        projection[3][2] = reversed_ ? far / (far - near) : near / (near - far);
        std::memcpy(rig_->view.projection, glm::value_ptr(projection), sizeof projection);
        looked_ = rig_->view;
    }
    // The view's depth value at `away` m along the view.
    [[nodiscard]] float depthOf(float away) const {
        const float* p = rig_->view.projection;
        return (p[14] - p[10] * away) / (p[15] - p[11] * away);
    }
    void TearDown() override {
        rig_.reset();
        GpuTest::TearDown();
    }

    FwTargetId targetOf(FwDepthMode mode) {
        FwVulkanTargetDef def = fwDefaultVulkanTargetDef();
        def.flags = FW_TARGET_COMPOSITE | FW_TARGET_NO_SURFACES;  // faster to create
        if (!backdrop_.empty()) def.flags |= FW_TARGET_HAZE;
        if (half_) def.flags |= FW_TARGET_HALF_EFFECTS;
        def.colorFormat = kColor;
        def.depthMode = mode;
        if (mode != FW_DEPTH_NONE) def.depthFormat = kDepth;
        def.reversedDepth = reversed_;
        // Pipelines are slow to build: once for all draws of a kind.
        FwTargetId& target = targets_[backdrop_.empty() ? size_t(mode) : targets_.size() - 1];
        if (target.index1 == 0) target = rig_->context.registerTarget(def);
        return target;
    }

    // Marched before it is drawn, as the second picture of a view is. Over black with a flat scene
    // at `far` m along the view; linear, top row first.
    std::vector<vec4> draw(std::span<const gpu::VolumeFlame> flames, FwDepthMode mode,
                           float far = 0) {
        (void)drawOnce(flames, mode, far);
        return drawOnce(flames, mode, far);
    }
    // Marched while it is drawn: the view differs slightly from that of the outside part.
    std::vector<vec4> drawDirect(std::span<const gpu::VolumeFlame> flames, FwDepthMode mode,
                                 float far = 0) {
        other_ = true;
        std::vector<vec4> picture = drawOnce(flames, mode, far);
        other_ = false;
        return picture;
    }
    std::vector<vec4> drawOnce(std::span<const gpu::VolumeFlame> flames, FwDepthMode mode,
                               float far) {
        const FwTargetId target = targetOf(mode);
        gpu::VolumeUpdate update{flames.data(), uint32_t(flames.size())};
        gpu::FramePlan plan;
        plan.frameIndex = ++index_;
        plan.endTick = uint32_t(index_ * gpu::kStepTicks);
        plan.volumes = &update;
        plan.detail.memory = memory_;
        if (emitters_) plan.emitters = emitters_;
        if (fields_) plan.fields = fields_;
        const float behind = far > 0 ? depthOf(far) : reversed_ ? 0.0f : 1.0f;
        rig_->alsoRecord = [&](const FwVulkanFrame& frame) { record(frame, target, mode, behind); };
        rig_->run(plan);
        rig_->alsoRecord = nullptr;
        rig_->frames.waitAll();
        const auto* pixels = static_cast<const vec4*>(read_.mapped);
        return {pixels, pixels + kSide * kSide};
    }
    void record(const FwVulkanFrame& frame, FwTargetId target, FwDepthMode mode, float behind) {
        const VkCommandBuffer commands = frame.commandBuffer;
        VkImageMemoryBarrier barriers[2]{};
        for (uint32_t i = 0; i < 2; ++i) {
            barriers[i].sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
            barriers[i].dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
            barriers[i].newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
            barriers[i].srcQueueFamilyIndex = barriers[i].dstQueueFamilyIndex =
                VK_QUEUE_FAMILY_IGNORED;
            barriers[i].image = i ? depth_.image : color_.image;
            barriers[i].subresourceRange = {
                VkImageAspectFlags(i ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT), 0, 1,
                0, 1};
        }
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                             VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0, nullptr, 2,
                             barriers);
        const VkClearColorValue black{};
        const VkClearDepthStencilValue cleared{behind, 0};
        vkCmdClearColorImage(commands, color_.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &black,
                             1, &barriers[0].subresourceRange);
        if (ground_ != vec4(0.0f)) scene_ = depthsOfGround();
        if (scene_.empty()) {
            vkCmdClearDepthStencilImage(commands, depth_.image,
                                        VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &cleared, 1,
                                        &barriers[1].subresourceRange);
        } else {
            auto* depths = static_cast<float*>(scenes_.mapped);
            for (size_t i = 0; i < scene_.size(); ++i) depths[i] = depthOf(scene_[i]);
            VkBufferImageCopy whole{};
            whole.imageSubresource = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 0, 1};
            whole.imageExtent = {kSide, kSide, 1};
            vkCmdCopyBufferToImage(commands, scenes_.buffer, depth_.image,
                                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &whole);
        }
        FwVulkanFrame hostFrame = frame;
        if (!backdrop_.empty()) showBackdrop(commands, hostFrame);
        FwVulkanComposite images = fwDefaultVulkanComposite();
        images.flags = FW_COMPOSITE_KEEP;
        images.width = images.height = kSide;
        for (FwVulkanImage* image : {&images.color, &images.depth}) {
            image->layoutBefore = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
            image->layoutAfter = image == &images.color ? VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL
                                                        : VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
            image->stageBefore = image->stageAfter = VK_PIPELINE_STAGE_TRANSFER_BIT;
            image->accessBefore = VK_ACCESS_TRANSFER_WRITE_BIT;
            image->accessAfter = VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
        }
        images.color.image = color_.image;
        images.color.view = color_.view;
        if (mode != FW_DEPTH_NONE) {
            images.depth.image = depth_.image;
            images.depth.view = depth_.view;
        } else {
            images.depth = {};
        }
        FwView view = rig_->view;
        if (other_) view.ambientSky[0] = 1e-12f;
        EXPECT_TRUE(rig_->backend.recordComposite(hostFrame, target, view, images));
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageExtent = {kSide, kSide, 1};
        vkCmdCopyImageToBuffer(commands, color_.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                               read_.buffer, 1, &region);
        VkMemoryBarrier toHost{};
        toHost.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
        toHost.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
        toHost.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                             0, 1, &toHost, 0, nullptr, 0, nullptr);
    }

    // m along the view to the ground and the post, per pixel.
    [[nodiscard]] std::vector<float> depthsOfGround() const {
        const FwView& view = rig_->view;
        const glm::mat4 fromClip =
            glm::inverse(glm::make_mat4(view.projection) * glm::make_mat4(view.view));
        const glm::mat4 look = glm::make_mat4(view.view);
        const auto placeOf = [&](vec2 at, float depth) {
            const vec4 place = fromClip * vec4(at, depth, 1.0f);
            return vec3(place) / place.w;
        };
        std::vector<float> depths;
        for (uint32_t i = 0; i < kSide * kSide; ++i) {
            const vec2 at =
                (vec2(float(i % kSide), float(i / kSide)) + 0.5f) * (2.0f / float(kSide)) - 1.0f;
            const vec3 from = placeOf(at, reversed_ ? 1.0f : 0.0f);
            const vec3 way = placeOf(at, 0.5f) - from;
            const vec3 normal(ground_);
            const float along = -(glm::dot(normal, from) + ground_.w) / glm::dot(normal, way);
            const float depth = -(look * vec4(from + along * way, 1.0f)).z;
            depths.push_back(along > 0.0f && depth < 49.0f ? depth : 49.0f);
            if (post_ > 0 && std::abs(at.x + 0.05f) < 0.1f && at.y < 0.5f)
                depths.back() = std::min(depths.back(), post_);
        }
        return depths;
    }

    // Puts the host's picture in the target and in the copy that it provides.
    void showBackdrop(VkCommandBuffer commands, FwVulkanFrame& hostFrame) {
        std::copy(backdrop_.begin(), backdrop_.end(), static_cast<vec4*>(backdrops_.mapped));
        VkImageMemoryBarrier barrier{};
        barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
        barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
        barrier.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
        barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
        barrier.image = behind_.image;
        barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        // Also after the target was cleared.
        const VkMemoryBarrier cleared{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr,
                                      VK_ACCESS_TRANSFER_WRITE_BIT, VK_ACCESS_TRANSFER_WRITE_BIT};
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                             VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 1, &cleared, 0, nullptr, 1,
                             &barrier);
        VkBufferImageCopy whole{};
        whole.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        whole.imageExtent = {kSide, kSide, 1};
        for (const VkImage image : {color_.image, behind_.image})
            vkCmdCopyBufferToImage(commands, backdrops_.buffer, image,
                                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &whole);
        barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
        barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
        barrier.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
        barrier.newLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                             VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, 0, 0, nullptr, 0, nullptr, 1,
                             &barrier);
        hostFrame.sampledColor = behind_.view;
        hostFrame.sampledColorLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    }

    // One flame's picture by the library's march. `cells`: at half resolution and weighted as on
    // the device; otherwise ray by ray. `steps` 0: the device's count.
    std::vector<vec4> march(const gpu::VolumeFlame& flame, uint32_t preset, bool cells = true,
                            uint32_t steps = 0, float far = 0) {
        gpu::ViewInput input;
        input.view = &rig_->view;
        input.viewport[2] = input.viewport[3] = kSide;
        const gpu::ViewParams view = gpu::makeViewParams(input);
        gpu::VolumeDraw draw{};
        std::vector<vec4> picture(kSide * kSide, vec4(0.0f));
        if (!lod::volumeDraw(view, flame.record.low, flame.record.high, 1, draw)) return picture;
        volume::Profile profile;
        volume::paintDefaultProfile(volume::presetDef(volume::FlamePreset(preset)).appearance,
                                    profile);
        if (own_) profile = *own_;
        const vec3 white =
            glm::mix(vec3(1.0f, 1.25f, 1.6f), vec3(1.0f), flame.record.tint.w) * gpu::kVolumeWhite;
        const auto shownOf = [&](vec3 along, const auto& fill) {
            const float perDepth = glm::length(along);
            volume::MarchRules rules;
            if (far > 0) rules.farthest = far * perDepth;
            rules.intervals = lod::volumeIntervals(flame.nodes, gpu::kFlameNodes);
            fill(rules, perDepth, along / perDepth);
            const gpu::FlameRay ray = volume::marchRay(flame.record, flame.nodes, profile,
                                                       vec3(view.eye), along / perDepth, rules);
            return vec4(ray.radiance * white,
                        1.0f - glm::dot(ray.through, vec3(0.2126f, 0.7152f, 0.0722f)));
        };
        if (!cells) {
            if (!steps) lod::volumeRays({{kSide, kSide}, 1}, draw);
            const uint32_t side = draw.perPixel;
            for (uint32_t k = 0; k < side * side * picture.size(); ++k) {
                const uint32_t i = k / (side * side);
                const uint32_t x = i % kSide * side + k % side;
                const uint32_t y = i / kSide * side + k / side % side;
                vec2 cell = vec2(float(x), float(y)) + 0.5f;
                if (side > 1) cell += gpu::marchRayShift(x, y);
                const vec2 ndc = cell * (2.0f / float(kSide * side)) - 1.0f;
                picture[i] += shownOf(
                    vec3(draw.rayO) + ndc.x * vec3(draw.rayX) + ndc.y * vec3(draw.rayY),
                    [&](volume::MarchRules& rules, float perDepth, vec3 direction) {
                        if (!scene_.empty()) rules.farthest = scene_[i] * perDepth;
                        volume::RayKnots knots;
                        const vec2 chord =
                            volume::flameChord(flame.record, flame.nodes, vec3(view.eye), direction,
                                               rules.farthest, rules.intervals, knots);
                        rules.steps = steps ? steps
                                            : uint32_t(gpu::rayStepCount(
                                                  chord.y - chord.x, draw.spacing, draw.mostSteps));
                        rules.jitter = steps ? 0.5f : gpu::marchSamplePhase(x, y);
                        rules.pixel = gpu::sampleFootprint(view.eye.w / perDepth, side);
                    });
            }
            for (vec4& pixel : picture) pixel /= float(side * side);
            return picture;
        }
        vec4 low, high;
        lod::volumeBounds(flame.record, flame.nodes, gpu::kFlameNodes, low, high);
        lod::volumeSlabs(view, low, high, draw);
        draw.rect = {-1, -1, 1, 1};
        const lod::VolumeItem item{0, draw};
        const lod::VolumeScreen screen{{kSide, kSide}, 1};
        lod::MarchedVolume marched;
        const uint32_t words = lod::volumeRayWords(screen);
        EXPECT_GT(lod::allocateVolumes({&item, 1}, screen, view.eye.w, words, {&marched, 1}).count,
                  0u);
        const gpu::MarchPush& m = marched.march;
        const float cell = 0.5f * float(kSide) * marched.composite.place.z;  // px
        const auto side = int(marched.composite.tilesX * gpu::kMarchTileSide);
        std::vector<vec4> coarse;
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) {
                const auto i = uint32_t(x), j = uint32_t(y);
                const vec2 at = vec2(float(x), float(y)) +
                                (m.perPixel > 1 ? gpu::marchRayShift(i, j) : vec2(0.0f));
                coarse.push_back(shownOf(vec3(m.rayO) + at.x * vec3(m.rayX) + at.y * vec3(m.rayY),
                                         [&](volume::MarchRules& rules, float perDepth, vec3) {
                                             rules.pixel = m.rayX.w / perDepth;
                                             rules.steps = steps ? steps : m.turns;
                                             rules.jitter =
                                                 steps ? 0.5f : gpu::marchSamplePhase(i, j);
                                             if (steps) return;
                                             rules.apart = m.rayY.w * perDepth;
                                             rules.first = m.rayO.w * perDepth;
                                             rules.middle =
                                                 rules.first + 0.5f * rules.apart * float(m.turns);
                                         }));
            }
        for (uint32_t i = 0; i < picture.size(); ++i) {
            const vec2 pixel(float(i % kSide), float(i / kSide));
            const auto of = [&](int column, int row) {
                column = std::clamp(column, 0, side - 1), row = std::clamp(row, 0, side - 1);
                return coarse[size_t(row * side + column)];
            };
            if (const int per = int(m.perPixel); per > 1) {
                for (int k = 0; k < per * per; ++k)
                    picture[i] += of(int(pixel.x) * per + k % per, int(pixel.y) * per + k / per) /
                                  float(per * per);
                continue;
            }
            const vec2 at = (pixel + 0.5f) / cell - 0.5f;
            const vec2 whole = glm::floor(at + 0.5f);
            for (int y = -1; y <= 1; ++y)
                for (int x = -1; x <= 1; ++x)
                    picture[i] += gpu::neighbourWeight(x, at.x - whole.x) *
                                  gpu::neighbourWeight(y, at.y - whole.y) *
                                  of(int(whole.x) + x, int(whole.y) + y);
        }
        return picture;
    }

    // Light of a flame summed over a view of this many pixels per side. Rays are equally dense at
    // any size of the flame on the screen.
    vec4 lightOf(const gpu::VolumeFlame& flame, uint32_t preset) {
        gpu::ViewInput input;
        input.view = &rig_->view;
        input.viewport[2] = input.viewport[3] = kSide;
        const gpu::ViewParams view = gpu::makeViewParams(input);
        vec4 low, high;
        lod::volumeBounds(flame.record, flame.nodes, gpu::kFlameNodes, low, high);
        low.w = flame.record.low.w;
        gpu::VolumeDraw draw{};
        EXPECT_TRUE(lod::volumeDraw(view, low, high, 1, draw));
        volume::Profile profile;
        volume::paintDefaultProfile(volume::presetDef(volume::FlamePreset(preset)).appearance,
                                    profile);
        const vec3 white =
            glm::mix(vec3(1.0f, 1.25f, 1.6f), vec3(1.0f), flame.record.tint.w) * gpu::kVolumeWhite;
        volume::MarchRules rules;
        rules.steps = 96;
        rules.smoke = false;
        constexpr uint32_t kColumns = 64, kRows = 128;
        vec4 sum(0.0f);
        for (uint32_t i = 0; i < kColumns * kRows; ++i) {
            const vec2 at((float(i % kColumns) + 0.5f) / kColumns,
                          (float(i / kColumns) + 0.5f) / kRows);
            const vec2 ndc = glm::mix(vec2(draw.rect), vec2(draw.rect.z, draw.rect.w), at);
            const vec3 along = vec3(draw.rayO) + ndc.x * vec3(draw.rayX) + ndc.y * vec3(draw.rayY);
            const gpu::FlameRay ray = volume::marchRay(
                flame.record, flame.nodes, profile, vec3(view.eye), glm::normalize(along), rules);
            sum += vec4(ray.radiance * white,
                        1.0f - glm::dot(ray.through, vec3(0.2126f, 0.7152f, 0.0722f)));
        }
        const vec2 pixels =
            0.5f * float(kSide) * vec2(draw.rect.z - draw.rect.x, draw.rect.w - draw.rect.y);
        return sum * (pixels.x * pixels.y / float(kColumns * kRows));
    }

    // m along the view: the border between slabs nearest to `far`.
    float borderNear(const gpu::VolumeFlame& flame, float far) {
        gpu::ViewInput input;
        input.view = &rig_->view;
        input.viewport[2] = input.viewport[3] = kSide;
        const gpu::ViewParams view = gpu::makeViewParams(input);
        gpu::VolumeDraw draw{};
        vec4 low, high;
        lod::volumeBounds(flame.record, flame.nodes, gpu::kFlameNodes, low, high);
        EXPECT_TRUE(
            lod::volumeDraw(view, flame.record.low, flame.record.high, gpu::kVolumeSlabs, draw));
        lod::volumeSlabs(view, low, high, draw);
        return draw.front + draw.deep * std::floor((far - draw.front) / draw.deep + 0.5f);
    }

    static vec4 meanOf(const std::vector<vec4>& picture) {
        vec4 sum(0.0f);
        for (const vec4& pixel : picture) sum += pixel;
        return sum / float(picture.size());
    }
    // Mean difference per pixel over the mean of the second.
    static float differenceOf(const std::vector<vec4>& a, const std::vector<vec4>& b) {
        double different = 0, all = 0;
        for (size_t i = 0; i < a.size(); ++i)
            for (int c = 0; c < 4; ++c) {
                different += double(std::abs(a[i][c] - b[i][c]));
                all += double(std::abs(b[i][c]));
            }
        return all > 0 ? float(different / all) : 0.0f;
    }

    // Like draw() at `zoom` times the resolution: several pictures, each of a part of the view.
    std::vector<vec4> drawFine(const gpu::VolumeFlame& flame, FwDepthMode mode, uint32_t zoom) {
        const FwView whole = rig_->view;
        const uint32_t side = kSide * zoom;
        std::vector<vec4> all(size_t(side) * side);
        for (uint32_t part = 0; part < zoom * zoom; ++part) {
            const uint32_t x = part % zoom, y = part / zoom;
            const auto offset = [&](uint32_t at) { return float(zoom) - 1 - 2 * float(at); };
            float* projection = rig_->view.projection;
            for (int column = 0; column < 4; ++column) {
                const float w = whole.projection[4 * column + 3];
                projection[4 * column] = float(zoom) * whole.projection[4 * column] + offset(x) * w;
                projection[4 * column + 1] =
                    float(zoom) * whole.projection[4 * column + 1] + offset(y) * w;
            }
            const std::vector<vec4> one = draw({&flame, 1}, mode);
            for (uint32_t i = 0; i < one.size(); ++i)
                all[size_t(y * kSide + i / kSide) * side + x * kSide + i % kSide] = one[i];
        }
        rig_->view = whole;
        return all;
    }

    // px, fractional: where 3 % of the light lies left of, above, right of and below it.
    static vec4 reachOf(const std::vector<vec4>& picture) {
        const auto side = size_t(std::lround(std::sqrt(double(picture.size()))));
        std::vector<double> column(side), row(side);
        for (size_t i = 0; i < picture.size(); ++i) {
            const auto light = double(glm::dot(picture[i], kSeen));
            column[i % side] += light, row[i / side] += light;
        }
        const auto at = [](const std::vector<double>& along, double part) {
            double all = 0, sum = 0;
            for (const double one : along) all += one;
            for (size_t i = 0; i < along.size(); ++i) {
                if (sum + along[i] >= part * all)
                    return float(double(i) + (part * all - sum) / std::max(along[i], 1e-30));
                sum += along[i];
            }
            return float(along.size());
        };
        return {at(column, 0.03), at(row, 0.03), at(column, 0.97), at(row, 0.97)};
    }
    // Differences in size and tip between two pictures, as shares of the size; less than `nothing`
    // px counts as 0.
    static float sizeOff(const std::vector<vec4>& one, const std::vector<vec4>& other,
                         float nothing = 0.33f) {
        const vec4 ours = reachOf(one), theirs = reachOf(other);
        const vec2 size(theirs.z - theirs.x, theirs.w - theirs.y);
        const auto part = [nothing](float pixels, float of) {
            return pixels < nothing ? 0.0f : pixels / of;
        };
        return std::max({part(std::abs(ours.w - ours.y - size.y), size.y),
                         part(std::abs(ours.z - ours.x - size.x), size.x),
                         part(std::abs(ours.y - theirs.y), size.y)});
    }

    // Differences of pixels from the reference beyond those of their neighbourhood's mean, and the
    // reference's light. Pixels near the border are omitted.
    struct Rough {
        double off = 0, light = 0;
    };
    static Rough roughOf(const std::vector<vec4>& drawn, const std::vector<vec4>& wanted,
                         uint32_t columns, uint32_t rows) {
        const uint32_t wide = 2 * columns + 1, all = wide * (2 * rows + 1);
        const auto off = [&](uint32_t i) { return drawn[i].x - wanted[i].x; };
        Rough rough;
        for (uint32_t y = rows; y + rows < kSide; ++y)
            for (uint32_t x = columns; x + columns < kSide; ++x) {
                const uint32_t i = y * kSide + x, first = i - rows * kSide - columns;
                float sum = 0;
                for (uint32_t k = 0; k < all; ++k) sum += off(first + k / wide * kSide + k % wide);
                rough.off += double(std::abs(off(i) - sum / float(all)));
                rough.light += double(wanted[i].x);
            }
        return rough;
    }

    // Difference of pixels from the mean of their four neighbours, over the mean of all.
    static float grainOf(const std::vector<vec4>& picture) {
        double different = 0, all = 0;
        for (uint32_t y = 1; y + 1 < kSide; ++y)
            for (uint32_t x = 1; x + 1 < kSide; ++x) {
                const auto red = [&](uint32_t dx, uint32_t dy) {
                    return double(picture[(y + dy - 1) * kSide + x + dx - 1].x);
                };
                const double around = red(0, 1) + red(2, 1) + red(1, 0) + red(1, 2);
                different += std::abs(red(1, 1) - 0.25 * around);
                all += red(1, 1);
            }
        return all > 0 ? float(different / all) : 0.0f;
    }

    // ---- fires of equal power, averaged over time

    using Mean = std::vector<vec4>;
    static constexpr int kAveraged = 24;
    static constexpr float kApart = 0.21f;  // s
    static void addToMean(Mean& sum, const Mean& picture) {
        for (size_t k = 0; k < sum.size(); ++k) sum[k] += picture[k] / float(kAveraged);
    }
    // Moves the view of look() by a part of a pixel, because the exact pixel coverage of an edge
    // does not matter.
    void nudge(int moment) {
        if (!nudges_) return;
        const auto offset = [&](float part) {
            return 2 / float(kSide) *
                   (part * float(moment) - std::floor(part * float(moment)) - 0.5f);
        };
        float* projection = rig_->view.projection;
        for (int column = 0; column < 4; ++column) {
            const float w = looked_.projection[4 * column + 3];
            projection[4 * column] = looked_.projection[4 * column] + offset(0.618f) * w;
            projection[4 * column + 1] = looked_.projection[4 * column + 1] + offset(0.755f) * w;
        }
    }
    static float tallOf(float power) {
        return 0.235f * std::pow(power, 0.4f);
    }  // m, Heskestad (1984)

    // Flipbooks for emitters: a flame, a roll and a puff.
    void packFlipbooks() {
        std::pmr::memory_resource* memory = std::pmr::get_default_resource();
        std::vector<flipbook::Flipbook> flipbooks;
        for (const uint32_t preset : {FW_FLIPBOOK_FLAME, FW_FLIPBOOK_ROLL, FW_FLIPBOOK_PUFF}) {
            flipbooks.emplace_back(memory);
            flipbook::readFlipbook(flipbook::presetFlipbook(preset, memory), flipbooks.back());
        }
        const flipbook::Flipbook* const placed[] = {&flipbooks[0], &flipbooks[1], &flipbooks[2]};
        const flipbook::Picture pages = flipbook::packFlipbooks(placed, memory);
        rig_->backend.setFlipbooks(pages.width, pages.height,
                                   std::as_bytes(std::span(pages.texels)), pages.words);
    }
    void addVolume(float power, Mean& mean) {
        FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
        components::setFirePreset(def, FW_FIRE_CAMP);
        def.flags = FW_FIRE_NO_SMOKE;
        def.power = power;
        def.diameter = 0.45f * tallOf(power);
        def.tier = FW_FIRE_TIER_MARCH_HIGH;
        for (int i = 0; i < kAveraged; ++i) {
            def.seed = 7 + uint32_t(i);
            gpu::VolumeFlame flame = flameAlone(def, 2 + kApart * float(i));
            flame.record.key = ++key_;
            nudge(i);
            addToMean(mean, draw({&flame, 1}, FW_DEPTH_TEST));
        }
    }
    // Adds the emitter's fire, by the created flipbooks or by noise.
    void addEmitter(FwFireEmitterDef def, Mean& mean, bool byBooks = true) {
        def.flags |= FW_EMITTER_NO_SMOKE;
        def.sparks = 0;
        ParticleReference emitter(def);
        if (byBooks) emitter.emitter.flipbooks.fire = 1u | 2u << 8 | 3u << 16;
        gpu::EmitterUpdate update;
        std::vector<gpu::uvec2> groups;
        for (uint32_t first = 0; first < emitter.emitter.ring; first += gpu::kParticleGroup)
            groups.emplace_back(0, first);
        update.groups = groups;
        update.count = 1;
        update.records = &emitter.record;
        update.particleEnd = update.particles = emitter.emitter.ring;
        emitters_ = &update;
        constexpr int kWarm = 60;
        for (int i = 0; i < kWarm + kAveraged; ++i) {
            EXPECT_TRUE(emitter.step(i < kWarm ? 1 / 30.0f : kApart) || i < 3);
            nudge(i);
            const Mean picture = drawOnce({}, FW_DEPTH_TEST, 0);
            if (i >= kWarm) addToMean(mean, picture);
        }
        emitters_ = nullptr;
    }

    // A field equivalent to a fire of `power` kW, as integration.md describes.
    static FwParticleFieldDef fieldOf(float power) {
        FwParticleFieldDef def = fwDefaultParticleFieldDef();
        components::setFieldPreset(def, FW_FIELD_FIRE);
        const float tall = tallOf(power), tint[3] = {0.91f, 0.87f, 0.855f};
        def.size[0] = 0.66f * tall, def.size[1] = 0.95f * tall;
        def.amount = 1.6f;
        def.life *= float(def.height) / 32;  // speeds are in cells
        std::copy_n(tint, 3, def.tint);
        return def;
    }

    std::unique_ptr<VkRig> rig_;
    FwView looked_{};      // the view that look() made
    bool nudges_ = false;  // each time is seen with a sub-pixel offset
    bool other_ = false;   // the drawn view is not that of the outside part
    bool half_ = false;    // the rig's targets draw at half resolution
    float memory_ = 1;     // gpu::Detail::memory
    const gpu::EmitterUpdate* emitters_ = nullptr;  // emitters beside the flames
    const gpu::FieldUpdate* fields_ = nullptr;
    std::vector<std::vector<Mean>> films_;
    TestImage color_, depth_, behind_;
    TestBuffer read_, scenes_, backdrops_;
    std::vector<float> scene_;    // m along the view, per pixel; empty: flat
    vec4 ground_{0.0f};           // a plane of the scene: dot(xyz, x) + w is 0 on it
    float post_ = 0;              // m along the view, of a post on it; 0: none
    bool reversed_ = false;       // depth is 1 at the camera
    std::vector<vec4> backdrop_;  // the host's own picture; empty: black, no haze
    uint64_t index_ = 0;
    uint32_t key_ = 0;                      // of the previous flame
    std::array<FwTargetId, 5> targets_{};   // by depth mode; with haze
    const volume::Profile* own_ = nullptr;  // used by march() in place of the preset's
};

// Every preset with smoke: the device draws the library's march, before it draws or while it does.
TEST_F(Volume, MatchesTheLibrarysMarch) {
    if (!device_) return;
    makeRig();
    for (const uint32_t preset : {FW_FIRE_CAMP, FW_FIRE_TORCH, FW_FIRE_MAGIC_BLUE}) {
        const gpu::VolumeFlame flame = flameOf(preset, 1.3f);
        const std::vector<vec4> wanted = march(flame, preset);
        const std::vector<vec4> drawn = draw({&flame, 1}, FW_DEPTH_NONE);
        const float difference = differenceOf(drawn, wanted);
        const float direct =
            differenceOf(drawDirect({&flame, 1}, FW_DEPTH_NONE), march(flame, preset, false));
        std::printf("           %s: mean %.4f of %.4f, difference %.4f; as drawn %.4f\n",
                    components::firePresetName(preset), double(meanOf(drawn).x),
                    double(meanOf(wanted).x), double(difference), double(direct));
        EXPECT_LT(difference, 0.01f) << components::firePresetName(preset);
        EXPECT_LT(direct, 0.01f) << components::firePresetName(preset);
        EXPECT_GT(meanOf(wanted).x, 0.001f);
    }
    const gpu::VolumeFlame flame = flameOf(FW_FIRE_CAMP, 1.3f);
    EXPECT_GT(differenceOf(draw({&flame, 1}, FW_DEPTH_NONE), march(flame, FW_FIRE_TORCH)), 0.05f)
        << "another profile would go unnoticed";
    EXPECT_GT(differenceOf(drawDirect({&flame, 1}, FW_DEPTH_NONE), march(flame, FW_FIRE_CAMP)),
              0.02f)
        << "half resolution would go unnoticed";
}

// Two colours that blend as the gas gets hotter.
TEST_F(Volume, BlendsToTheCoreColour) {
    if (!device_) return;
    makeRig();
    const gpu::VolumeFlame plain = flameOf(FW_FIRE_MAGIC_BLUE, 1.3f);
    gpu::VolumeFlame flame = plain;
    flame.record.tintCore = glm::packUnorm4x8(vec4(1.0f, 0.5f, 0.0f, 0.0f));
    const std::vector<vec4> drawn = draw({&flame, 1}, FW_DEPTH_NONE);
    EXPECT_LT(differenceOf(drawn, march(flame, FW_FIRE_MAGIC_BLUE)), 0.01f);
    EXPECT_GT(differenceOf(drawn, draw({&plain, 1}, FW_DEPTH_NONE)), 0.05f);
}

// Sample offsets differ per half-resolution pixel without visible grain.
TEST_F(Volume, HasNoGrain) {
    if (!device_) return;
    makeRig();
    lookAtSmoothFlame();
    const gpu::VolumeFlame flame = smoothFlame();
    std::vector<vec4> grainy = march(flame, FW_FIRE_CAMP, false, 200);
    const float exact = grainOf(grainy);
    for (uint32_t i = 0; i < grainy.size(); ++i)
        grainy[i] *= (i % kSide + i / kSide) % 2 ? 1.03f : 0.97f;
    const float marched = grainOf(draw({&flame, 1}, FW_DEPTH_NONE));
    const float direct = grainOf(drawDirect({&flame, 1}, FW_DEPTH_NONE));
    std::printf("           %.4f exact, %.4f marched before, %.4f as it is drawn\n", double(exact),
                double(marched), double(direct));
    EXPECT_LT(marched, exact + 0.005f);
    EXPECT_LT(direct, exact + 0.005f);
    EXPECT_GT(grainOf(grainy), exact + 0.01f) << "grain would go unnoticed";
}

// The screen bounds are unknown before the first picture, so it takes more rays per pixel instead.
TEST_F(Volume, TheFirstPictureTakesMoreThanOneRayPerPixel) {
    if (!device_) return;
    makeRig();
    const gpu::VolumeFlame flame = flameOf(FW_FIRE_HOUSE, 1.3f, FW_FIRE_NO_SMOKE);
    const float first = grainOf(drawOnce({&flame, 1}, FW_DEPTH_TEST, 0));
    const float one = grainOf(drawDirect({&flame, 1}, FW_DEPTH_TEST));
    std::printf("           %.4f, of one ray a pixel %.4f\n", double(first), double(one));
    EXPECT_LT(first, 0.8f * one);
}

// The bounds of a changed screen are unknown too. A screen beside the one that frames are marched
// for takes more rays only once.
TEST_F(Volume, AChangedScreenShowsNoGrain) {
    if (!device_) return;
    makeRig();
    const gpu::VolumeFlame flame = flameOf(FW_FIRE_HOUSE, 1.3f, FW_FIRE_NO_SMOKE);
    (void)draw({&flame, 1}, FW_DEPTH_TEST);
    const float other = grainOf(drawOnce({&flame, 1}, FW_DEPTH_NONE, 0));
    const float one = grainOf(drawDirect({&flame, 1}, FW_DEPTH_NONE));
    (void)draw({&flame, 1}, FW_DEPTH_NONE);
    const float back = grainOf(drawOnce({&flame, 1}, FW_DEPTH_TEST, 0));
    std::printf("           %.4f, and back %.4f, of one ray a pixel %.4f\n", double(other),
                double(back), double(one));
    EXPECT_LT(other, 0.8f * one);
    EXPECT_LT(back, 0.8f * one);
}

// The host's profiles follow the presets' in memory and may change while frames are in flight.
TEST_F(Volume, DrawsTheHostsProfile) {
    if (!device_) return;
    makeRig();
    gpu::VolumeFlame flame = flameOf(FW_FIRE_CAMP, 1.3f, FW_FIRE_NO_SMOKE);
    const std::vector<vec4> preset = draw({&flame, 1}, FW_DEPTH_NONE);
    const uint32_t slot = gpu::kMaxFireProfiles - 1;
    flame.record.profile = gpu::kFirePresets + slot;
    EXPECT_EQ(meanOf(draw({&flame, 1}, FW_DEPTH_NONE)).w, 0.0f) << "an empty layer";
    const auto profile = std::make_unique<volume::Profile>();
    for (const uint32_t from : {FW_FIRE_TORCH, FW_FIRE_CAMP}) {
        volume::paintDefaultProfile(volume::presetDef(volume::FlamePreset(from)).appearance,
                                    *profile);
        rig_->backend.setFireProfile(slot, profile->texels);
        own_ = profile.get();
        const std::vector<vec4> drawn = draw({&flame, 1}, FW_DEPTH_NONE);
        EXPECT_LT(differenceOf(drawn, march(flame, FW_FIRE_CAMP)), 0.01f);
        if (from == FW_FIRE_CAMP) {
            EXPECT_LT(differenceOf(drawn, preset), 1e-6f);
        } else {
            EXPECT_GT(differenceOf(drawn, preset), 0.05f);
        }
    }
}

// Neither the number of samples nor that of slabs changes the brightness.
TEST_F(Volume, BrightnessMatchesTheMedium) {
    if (!device_) return;
    makeRig();
    lookAtSmoothFlame();
    const gpu::VolumeFlame flame = smoothFlame();
    const vec4 exact = meanOf(march(flame, FW_FIRE_CAMP, true, 200));
    const vec4 one = meanOf(draw({&flame, 1}, FW_DEPTH_NONE));
    const vec4 slabs = meanOf(draw({&flame, 1}, FW_DEPTH_TEST));
    const vec4 direct = meanOf(drawDirect({&flame, 1}, FW_DEPTH_TEST));
    std::printf(
        "           red %.5f exact, %.5f in one slab, %.5f in %u, %.5f as drawn; alpha "
        "%.5f %.5f %.5f %.5f\n",
        double(exact.x), double(one.x), double(slabs.x), gpu::kVolumeSlabs, double(direct.x),
        double(exact.w), double(one.w), double(slabs.w), double(direct.w));
    for (int c = 0; c < 4; ++c) {
        if (exact[c] == 0) continue;  // it has no blue
        EXPECT_NEAR(one[c] / exact[c], 1.0f, 0.01f) << "channel " << c;
        EXPECT_NEAR(slabs[c] / one[c], 1.0f, 0.03f) << "channel " << c;
        EXPECT_NEAR(direct[c] / one[c], 1.0f, 0.035f) << "channel " << c;  // the grain of 40 px
    }
}

// An object in a flame hides exactly what is behind it.
TEST_F(Volume, EndsAtTheScene) {
    if (!device_) return;
    makeRig();
    const gpu::VolumeFlame flame = smoothFlame();
    const float far = 2.75f;  // m along the view: through its middle
    const std::vector<vec4> wanted = march(flame, FW_FIRE_CAMP, true, 200, far);
    const float direct = differenceOf(drawDirect({&flame, 1}, FW_DEPTH_SAMPLED, far),
                                      march(flame, FW_FIRE_CAMP, false, 0, far));
    EXPECT_LT(direct, 0.01f);
    const std::vector<vec4> soft = draw({&flame, 1}, FW_DEPTH_SAMPLED, far);
    const float difference = differenceOf(soft, wanted);
    EXPECT_LT(difference, 0.12f);
    EXPECT_NEAR(meanOf(soft).x / meanOf(wanted).x, 1.0f, 0.05f);
    const float whole = meanOf(draw({&flame, 1}, FW_DEPTH_TEST)).x;
    const float cut = meanOf(draw({&flame, 1}, FW_DEPTH_TEST, far)).x;
    std::printf(
        "           difference %.4f, as drawn %.4f; %.4f whole, %.4f cut, %.4f soft, %.4f "
        "in slabs\n",
        double(difference), double(direct), double(whole), double(meanOf(wanted).x),
        double(meanOf(soft).x), double(cut));
    EXPECT_LT(cut, 0.9f * whole);
    // With tested depth, slabs show whole if their middle is in front.
    const float border = borderNear(flame, far);
    EXPECT_NEAR(cut / meanOf(march(flame, FW_FIRE_CAMP, true, 200, border)).x, 1.0f, 0.05f);
    EXPECT_LT(std::abs(border - far), 0.08f);
    EXPECT_EQ(meanOf(draw({&flame, 1}, FW_DEPTH_SAMPLED, 0.5f)).w, 0.0f) << "a wall in front";
}

// A slanted plane through a flame at half resolution adds no edge: steps between pixels exceed
// those of the ray-by-ray flame by at most 1/255 of the brightest, and the brightness along the cut
// is the same.
TEST_F(Volume, APlaneThroughAFlameAddsNoHardEdge) {
    if (!device_) return;
    makeRig();
    lookAtSmoothFlame();
    const gpu::VolumeFlame flame = smoothFlame();
    for (const bool aside : {true, false}) {
        for (uint32_t i = 0; i < kSide * kSide; ++i) {
            const auto along = float(aside ? i % kSide : i / kSide) / float(kSide) - 0.5f;
            scene_.push_back(2.75f + 0.9f * along);
        }
        const std::vector<vec4> exact = march(flame, FW_FIRE_CAMP, false, 200);
        const std::vector<vec4> soft = draw({&flame, 1}, FW_DEPTH_SAMPLED);
        scene_.clear();
        const std::vector<vec4> whole = march(flame, FW_FIRE_CAMP, false, 200);
        const auto steepest = [&](const std::vector<vec4>& picture) {
            float most = 0;
            for (uint32_t i = 0; i < kSide * kSide; ++i) {
                if (i % kSide + 1 < kSide)
                    most = std::max(most, std::abs(picture[i + 1].x - picture[i].x));
                if (i / kSide + 1 < kSide)
                    most = std::max(most, std::abs(picture[i + kSide].x - picture[i].x));
            }
            return most;
        };
        float brightest = 0;
        for (const vec4& pixel : whole) brightest = std::max(brightest, pixel.x);
        std::printf(
            "           steps: %.4f cut, %.4f exactly, %.4f whole; brightest %.4f; %.3f of "
            "its light\n",
            double(steepest(soft)), double(steepest(exact)), double(steepest(whole)),
            double(brightest), double(meanOf(soft).x / meanOf(exact).x));
        EXPECT_LT(meanOf(exact).x, 0.95f * meanOf(whole).x) << "the plane does not cut it";
        EXPECT_LT(steepest(soft), std::max(steepest(exact), steepest(whole)) + brightest / 255);
        EXPECT_NEAR(meanOf(soft).x / meanOf(exact).x, 1.0f, 0.05f);
    }
}

// A fire on the ground with tested depth looks the same as without ground and as with sampled
// depth. Only light that half-resolution pixels spread differs. From all sides and above, in both
// projections, for all tiers.
TEST_F(Volume, StandsOnTestedGround) {
    if (!device_) return;
    struct Seen {
        const char* name;
        vec3 eye;
        float degrees;
        bool below = false, reversed = false, parallel = false;
    };
    const Seen all[] = {{"as one stands", {0.7f, 0.9f, 2.6f}, 30},
                        {"far", {2.0f, 1.7f, 9.6f}, 10},
                        {"from above", {0.7f, 2.6f, 1.4f}, 26},
                        {"low", {0.5f, 0.12f, 2.0f}, 36},
                        {"from below", {0.6f, -0.7f, 2.2f}, 30, true},
                        {"in parallel", {0.7f, 0.9f, 2.6f}, 30, false, false, true},
                        {"reversed", {0.7f, 0.9f, 2.6f}, 30, false, true},
                        {"reversed, in parallel", {0.7f, 0.9f, 2.6f}, 30, false, true, true}};
    struct Tier {
        uint32_t tier;
        bool direct;
        double none;   // RMS against no ground, in 1/255 of the brightest
        double soft;   // against sampled depth
        double alone;  // of both without ground
    };
    // Where the ground ends the rays of a directly drawn march, samples are offset differently. The
    // ground cuts slices.
    const Tier tiers[] = {{FW_FIRE_TIER_MARCH_HIGH, false, 0.3, 3.2, 1.4},
                          {FW_FIRE_TIER_MARCH_HIGH, true, 0.1, 1.0, 1.6},
                          {FW_FIRE_TIER_IMPOSTOR, false, 0.3, 3.6, 2.9},
                          {FW_FIRE_TIER_SLICES, false, 1.2, 1.2, 0.1}};
    for (const Seen& seen : all) {
        if (!rig_ || reversed_ != seen.reversed) {
            reversed_ = seen.reversed;
            makeRig();
        }
        const vec3 at(0, 0.35f, 0);
        look(&seen.eye.x, &at.x, seen.degrees);
        if (seen.parallel) lookParallel(0.8f);
        gpu::VolumeFlame flame = flameOf(FW_FIRE_CAMP, 1.3f);
        for (const Tier& tier : tiers) {
            const auto shown = [&](FwDepthMode mode, bool ground) {
                ground_ = vec4(0, ground ? 1 : 0, 0, 0);
                scene_.clear();
                flame.record.key = ++key_;
                flame.record.tier = tier.tier;
                return tier.direct ? drawDirect({&flame, 1}, mode) : draw({&flame, 1}, mode);
            };
            const auto off = [&](const Mean& a, const Mean& b) {
                double sum = 0, brightest = 0;
                for (size_t i = 0; i < a.size(); ++i) {
                    brightest = std::max(brightest, double(b[i].x));
                    sum += std::pow(double(a[i].x) - double(b[i].x), 2);
                }
                return 255 * std::sqrt(sum / double(a.size())) / std::max(brightest, 1e-9);
            };
            const Mean alone = shown(FW_DEPTH_TEST, false);
            const double softAlone = off(alone, shown(FW_DEPTH_SAMPLED, false));
            EXPECT_GT(meanOf(alone).x, 0.01f);
            EXPECT_LT(softAlone, tier.alone) << seen.name << ", tier " << tier.tier;
            if (seen.below) continue;
            const Mean tested = shown(FW_DEPTH_TEST, true);
            const double none = off(tested, alone),
                         soft = off(tested, shown(FW_DEPTH_SAMPLED, true));
            std::printf(
                "           %s, tier %u%s: %.2f against no ground, %.2f and %.2f against a "
                "sampled depth\n",
                seen.name, tier.tier, tier.direct ? " as it is drawn" : "", none, soft, softAlone);
            EXPECT_LT(none, tier.none) << seen.name << ", tier " << tier.tier;
            EXPECT_LT(soft, tier.soft) << seen.name << ", tier " << tier.tier;
        }
    }
}

// A wall in front of a fire's base hides it, and a post in the fire hides what is behind it: the
// plane through the base makes no slab nearer than its own near distance.
TEST_F(Volume, ObjectsInFrontOfTheBaseHideIt) {
    if (!device_) return;
    makeRig();
    ground_ = vec4(0, 1, 0, 0);
    gpu::VolumeFlame flame = flameOf(FW_FIRE_CAMP, 1.3f);
    for (const uint32_t tier : {FW_FIRE_TIER_MARCH_HIGH, FW_FIRE_TIER_IMPOSTOR}) {
        flame.record.tier = tier;
        const auto inPost = [&](float away) {
            post_ = away;
            flame.record.key = ++key_;
            const std::vector<vec4> picture = draw({&flame, 1}, FW_DEPTH_TEST);
            float sum = 0;
            for (size_t i = 0; i < picture.size(); ++i)
                if (scene_[i] == away) sum += picture[i].x;
            return sum;
        };
        const float eye[3] = {0.7f, 0.9f, 2.6f}, at[3] = {0, 0.35f, 0};
        look(eye, at, 30);
        const float middle = 2.75f, behind = inPost(middle + 0.4f);
        EXPECT_GT(behind, 1.0f);
        EXPECT_LT(inPost(middle - 0.4f), 0.02f * behind) << "in front of all of it, tier " << tier;
        EXPECT_NEAR(inPost(middle + 0.3f), behind, 1e-3f * behind) << "behind all of it";
        if (tier == FW_FIRE_TIER_IMPOSTOR) continue;  // all of it is tested at its middle
        EXPECT_LT(inPost(middle - 0.1f), 0.6f * behind);
    }
}

TEST_F(Volume, TheCameraMayBeInside) {
    if (!device_) return;
    makeRig();
    const gpu::VolumeFlame flame = flameOf(FW_FIRE_CAMP, 1.3f, FW_FIRE_NO_SMOKE);
    const float eye[3] = {0.02f, 0.15f, 0.05f}, at[3] = {0, 0.2f, -1};
    look(eye, at, 70);
    const std::vector<vec4> wanted = march(flame, FW_FIRE_CAMP, true, 128);
    EXPECT_LT(differenceOf(draw({&flame, 1}, FW_DEPTH_NONE), wanted), 0.01f);
    EXPECT_LT(
        differenceOf(drawDirect({&flame, 1}, FW_DEPTH_NONE), march(flame, FW_FIRE_CAMP, false)),
        0.01f);
    EXPECT_NEAR(meanOf(draw({&flame, 1}, FW_DEPTH_TEST)).x / meanOf(wanted).x, 1.0f, 0.03f);
    const float away[3] = {0, 0.2f, 30};
    const float beyond[3] = {0, 0.2f, 60};
    look(away, beyond, 40);
    EXPECT_EQ(meanOf(draw({&flame, 1}, FW_DEPTH_NONE)).w, 0.0f) << "behind the camera";
}

// From inside, a quarter of a step covers many pixels; edges facing the camera would jump between
// sample layers like a comb.
TEST_F(Volume, NoCombFromInside) {
    if (!device_) return;
    makeRig();
    const gpu::VolumeFlame flame = flameOf(FW_FIRE_CAMP, 1.3f, FW_FIRE_NO_SMOKE);
    const float eye[3] = {0.02f, 0.15f, 0.05f};
    double comb = 0, all = 0;
    for (const float aside : {-0.5f, 0.1f, 0.6f}) {
        const float at[3] = {aside, 0.3f, -1};
        look(eye, at, 10);
        const std::vector<vec4> drawn = draw({&flame, 1}, FW_DEPTH_NONE);
        const std::vector<vec4> wanted = march(flame, FW_FIRE_CAMP, true, 128);
        const Rough rough = roughOf(drawn, wanted, 4, 0);
        comb += rough.off, all += rough.light;
    }
    std::printf("           %.4f of the light\n", comb / all);
    EXPECT_GT(all, 0);
    EXPECT_LT(comb / all, 0.0013);
}

// Detached tongues are thinner than the sample distance and must not become rows of beads, least of
// all at the highest sample count.
TEST_F(Volume, ThinTonguesDoNotBreakIntoBeads) {
    if (!device_) return;
    makeRig();
    constexpr int kViews = 12;
    constexpr float kAcross = 170;  // px, width of the flame
    double beads[2] = {};           // at AUTO, at FW_FIRE_TIER_MARCH_HIGH
    for (int k = 0; k < 2 * kViews; ++k) {
        const int i = k / 2;
        gpu::VolumeFlame flame = flameOf(FW_FIRE_BONFIRE, 1.0f + 0.3f * float(i), FW_FIRE_NO_SMOKE);
        flame.record.key = ++key_;
        flame.record.tier = k % 2 ? FW_FIRE_TIER_MARCH_HIGH : FW_FIRE_TIER_AUTO;
        const float wide = flame.record.low.w, high = flame.record.high.w;
        const float aside = 0.35f * wide * (i % 2 ? 1.0f : -1.0f), away = 20 * high;
        const float up = high * (0.3f + 0.1f * float(i / 2));
        const float eye[3] = {aside, up, away}, at[3] = {aside, up, 0};
        look(eye, at, glm::degrees(2 * std::atan(0.5f * wide * float(kSide) / kAcross / away)));
        const std::vector<vec4> drawn = draw({&flame, 1}, FW_DEPTH_NONE);
        const std::vector<vec4> wanted = march(flame, FW_FIRE_BONFIRE, true, 400);
        const Rough rough = roughOf(drawn, wanted, 3, 3);
        EXPECT_GT(rough.light, 0) << "view " << i;
        beads[k % 2] += rough.off / std::max(rough.light, 1e-9) / kViews;
    }
    std::printf("           %.4f of the light, %.4f where it asks\n", beads[0], beads[1]);
    EXPECT_LT(beads[0], 0.045);
    EXPECT_LT(beads[1], 0.03);
}

// The fewer samples of flames beyond the largest 32 keep brightness and size.
TEST_F(Volume, FewSamplesShowTheSameFlame) {
    if (!device_) return;
    const gpu::VolumeFlame flame = flameOf(FW_FIRE_CAMP, 1.3f, FW_FIRE_NO_SMOKE);
    const auto drawn = [&](uint32_t steps) {
        makeRig(nullptr, steps);
        std::vector<vec4> picture = draw({&flame, 1}, FW_DEPTH_NONE);
        rig_.reset();
        targets_ = {};
        index_ = 0;
        return picture;
    };
    // px from left, top, right and bottom that light reaches
    const auto bounds = [](const std::vector<vec4>& picture) {
        float brightest = 0;
        for (const vec4& pixel : picture) brightest = std::max(brightest, pixel.x);
        glm::ivec4 box(kSide, kSide, 0, 0);
        for (int i = 0; i < int(picture.size()); ++i)
            if (picture[size_t(i)].x > 0.02f * brightest) {
                const int x = i % int(kSide), y = i / int(kSide);
                box = {std::min(box.x, x), std::min(box.y, y), std::max(box.z, x),
                       std::max(box.w, y)};
            }
        return box;
    };
    const std::vector<vec4> many = drawn(64), few = drawn(24);
    const vec4 a = meanOf(many), b = meanOf(few);
    const glm::ivec4 wide = bounds(many), narrow = bounds(few);
    std::printf("           red %.4f of %.4f; %d..%d x %d..%d of %d..%d x %d..%d px\n", double(b.x),
                double(a.x), narrow.x, narrow.z, narrow.y, narrow.w, wide.x, wide.z, wide.y,
                wide.w);
    // Luminance; the thin blue at a base has little of it.
    const vec4 seen(0.2126f, 0.7152f, 0.0722f, 0.0f);
    EXPECT_NEAR(glm::dot(b, seen) / glm::dot(a, seen), 1.0f, 0.05f);
    // Dense parts between two samples are partly missed, so slightly less is covered.
    EXPECT_NEAR(b.w / a.w, 1.0f, 0.07f);
    std::printf("           luminance %.4f, alpha %.4f, blue %.4f of those of many\n",
                double(glm::dot(b, seen) / glm::dot(a, seen)), double(b.w / a.w),
                double(b.z / a.z));
    EXPECT_LT(a.z * seen.z, 0.03f * glm::dot(a, seen));
    for (int c = 0; c < 4; ++c) EXPECT_LE(std::abs(wide[c] - narrow[c]), 1);  // 3 % of 40 px
    EXPECT_GT(differenceOf(many, few), 0.005f) << "both used equally many samples";
}

// At every camera distance the probe finds the whole flame: neither its spacing nor tile borders
// show on approach.
TEST_F(Volume, NothingPopsAsTheCameraApproaches) {
    if (!device_) return;
    makeRig();
    const gpu::VolumeFlame flame = flameOf(FW_FIRE_CAMP, 1.3f, FW_FIRE_NO_SMOKE);
    float worst = 0;
    for (float away = 12.0f; away > 0.9f; away *= 0.87f) {
        const float eye[3] = {0.2f * away, 0.45f + 0.1f * away, away}, at[3] = {0, 0.45f, 0};
        look(eye, at, 30);
        const float wanted = meanOf(march(flame, FW_FIRE_CAMP)).x;
        const float drawn = meanOf(draw({&flame, 1}, FW_DEPTH_NONE)).x;
        worst = std::max(worst, std::abs(drawn / wanted - 1.0f));
        EXPECT_NEAR(drawn / wanted, 1.0f, 0.006f) << away << " m";
    }
    std::printf("           at most %.4f of its light is lost or made\n", double(worst));
}

// A flame of a few pixels is as bright per area as a near one, whatever its alignment to the pixel
// grid.
TEST_F(Volume, ASmallFlameKeepsItsLight) {
    if (!device_) return;
    makeRig();
    const vec4 seen(0.2126f, 0.7152f, 0.0722f, 0.0f);
    for (const uint32_t preset : {FW_FIRE_CANDLE, FW_FIRE_TORCH, FW_FIRE_CAMP, FW_FIRE_BONFIRE,
                                  FW_FIRE_HOUSE, FW_FIRE_GAS_BURNER}) {
        gpu::VolumeFlame flame = flameOf(preset, 1.3f, FW_FIRE_NO_SMOKE);
        const float tall = 1.5f * flame.record.high.w;  // around its visible part
        float least = 9, most = 0, worstCover = 0, leastDirect = 9, mostDirect = 0;
        for (float px = 36; px > 4.5f; px *= 0.79f) {
            const float away = tall * float(kSide) / (px * 2.0f * std::tan(0.2618f));
            const float at[3] = {0, 0.5f * tall, 0};
            const float eye[3] = {0.3f * away, 0.5f * tall + 0.1f * away, 0.95f * away};
            look(eye, at, 30);
            flame.record.key = ++key_;
            const vec4 wanted = lightOf(flame, preset);
            const vec4 drawn = meanOf(draw({&flame, 1}, FW_DEPTH_TEST)) * float(kSide * kSide);
            const float light = glm::dot(drawn, seen) / glm::dot(wanted, seen);
            least = std::min(least, light);
            most = std::max(most, light);
            worstCover = std::max(worstCover, std::abs(drawn.w / wanted.w - 1));
            // A house's flame is so dense that 64 samples are slightly dark.
            EXPECT_NEAR(light, 1.0f, preset == FW_FIRE_HOUSE ? 0.075f : 0.05f)
                << components::firePresetName(preset) << " " << px << " px high";
            const vec4 direct = meanOf(drawDirect({&flame, 1}, FW_DEPTH_TEST));
            const float asDrawn = glm::dot(direct, seen) * float(kSide * kSide);
            leastDirect = std::min(leastDirect, asDrawn / glm::dot(wanted, seen));
            mostDirect = std::max(mostDirect, asDrawn / glm::dot(wanted, seen));
            // Few samples of a house's dense flame are slightly dark.
            EXPECT_NEAR(asDrawn / glm::dot(wanted, seen), 1.0f,
                        preset == FW_FIRE_HOUSE ? 0.09f : 0.06f)
                << components::firePresetName(preset) << " as drawn, " << px << " px high";
        }
        std::printf(
            "           %s: light %.3f to %.3f of what is there, cover within %.3f; %.3f to %.3f "
            "as "
            "drawn\n",
            components::firePresetName(preset), double(least), double(most), double(worstCover),
            double(leastDirect), double(mostDirect));
        // A house's flame is so dense that few samples let slightly more through.
        EXPECT_LT(worstCover, 0.07f) << components::firePresetName(preset);
    }
}

// A billboard has the brightness, width and height of the march it alternates with, and so has the
// flame's own impostor, which is used nearer.
TEST_F(Volume, BillboardsShowTheSameFlame) {
    if (!device_) return;
    makeRig();
    const vec4 seen(0.2126f, 0.7152f, 0.0722f, 0.0f);
    for (const uint32_t preset : {FW_FIRE_CANDLE, FW_FIRE_TORCH, FW_FIRE_CAMP, FW_FIRE_BONFIRE,
                                  FW_FIRE_HOUSE, FW_FIRE_MAGIC_BLUE}) {
        gpu::VolumeFlame flame = flameOf(preset, 1.3f, FW_FIRE_NO_SMOKE);
        const float tall = 1.5f * flame.record.high.w;
        float worst[2] = {}, worstSize[2] = {}, worstCover[2] = {};
        // px across, or as many as a whole flame leaves; the first as an impostor
        for (const float wide : {24.0f, 13.0f, 10.0f, 7.0f, 4.0f}) {
            const bool page = wide > 20;
            const float px = std::min(wide * tall / flame.record.low.w, 34.0f);
            const float away = tall * float(kSide) / (px * 2.0f * std::tan(0.2618f));
            const float at[3] = {0, 0.5f * tall, 0};
            const float eye[3] = {0.3f * away, 0.5f * tall + 0.1f * away, 0.95f * away};
            look(eye, at, 30);
            flame.record.key = ++key_;
            flame.record.tier = FW_FIRE_TIER_MARCH_HIGH;
            const std::vector<vec4> marched = draw({&flame, 1}, FW_DEPTH_TEST);
            flame.record.key = ++key_;
            flame.record.tier = page ? FW_FIRE_TIER_SHARED_IMPOSTOR : FW_FIRE_TIER_IMPOSTOR;
            std::vector<vec4> card = draw({&flame, 1}, FW_DEPTH_TEST);
            // Until the impostor was updated once.
            for (uint32_t k = 0; page && k < lod::kAtlasFrameStep; ++k)
                card = drawOnce({&flame, 1}, FW_DEPTH_TEST, 0);
            const vec4 a = meanOf(card), b = meanOf(marched);
            worst[page] =
                std::max(worst[page], std::abs(glm::dot(a, seen) / glm::dot(b, seen) - 1));
            worstCover[page] = std::max(worstCover[page], std::abs(a.w / b.w - 1));
            worstSize[page] = std::max(worstSize[page], sizeOff(card, marched));
            EXPECT_GT(differenceOf(card, marched), 1e-3f) << "it is not a billboard";
        }
        for (const bool page : {false, true}) {
            std::printf("           %s%s: light within %.4f, cover %.4f, size and tip %.4f\n",
                        components::firePresetName(preset), page ? ", a page" : "",
                        double(worst[page]), double(worstCover[page]), double(worstSize[page]));
            EXPECT_LT(worst[page], 0.05f) << components::firePresetName(preset) << page;
            EXPECT_LT(worstCover[page], 0.05f) << components::firePresetName(preset) << page;
            EXPECT_LT(worstSize[page], 0.03f) << components::firePresetName(preset) << page;
        }
    }
}

// Half the samples, or slices of its lattice, keep brightness, width and height.
TEST_F(Volume, EveryTierShowsTheSameFlame) {
    if (!device_) return;
    makeRig();
    for (const uint32_t tier : {uint32_t(FW_FIRE_TIER_MARCH_LOW), uint32_t(FW_FIRE_TIER_SLICES)}) {
        for (const uint32_t preset :
             {FW_FIRE_CAMP, FW_FIRE_TORCH, FW_FIRE_BONFIRE, FW_FIRE_HOUSE, FW_FIRE_MAGIC_BLUE}) {
            gpu::VolumeFlame flame = flameOf(preset, 1.3f, FW_FIRE_NO_SMOKE);
            const float tall = 1.5f * flame.record.high.w;
            float worst = 0, worstCover = 0;
            for (const float px : {34.0f, 26.0f, 18.0f}) {
                const float away = tall * float(kSide) / (px * 2.0f * std::tan(0.2618f));
                // A slice takes one ray per pixel, a coarse sample at this size, so the mean of
                // slightly moved views counts. Marched views differ little.
                const int views = tier == FW_FIRE_TIER_SLICES ? 6 : 1;
                std::vector<vec4> high(kSide * kSide, vec4(0.0f)), other = high;
                for (int k = 0; k < views; ++k) {
                    const float pixel = tall / px;
                    const float x = pixel * (0.618f * float(k) - std::floor(0.618f * float(k)));
                    const float y = pixel * (0.755f * float(k) - std::floor(0.755f * float(k)));
                    const float at[3] = {x, 0.5f * tall + y, 0};
                    const float eye[3] = {0.3f * away + x, 0.5f * tall + 0.1f * away + y,
                                          0.95f * away};
                    look(eye, at, 30);
                    const auto add = [&](uint32_t as, std::vector<vec4>& sum) {
                        flame.record.key = ++key_;
                        flame.record.tier = as;
                        const std::vector<vec4> picture = draw({&flame, 1}, FW_DEPTH_TEST);
                        for (size_t i = 0; i < sum.size(); ++i) sum[i] += picture[i];
                    };
                    add(FW_FIRE_TIER_MARCH_HIGH, high);
                    add(tier, other);
                }
                const vec4 a = meanOf(other), b = meanOf(high);
                worst = std::max(worst, std::abs(glm::dot(a, kSeen) / glm::dot(b, kSeen) - 1));
                worstCover = std::max(worstCover, std::abs(a.w / b.w - 1));
                EXPECT_GT(differenceOf(other, high), 1e-3f) << "the tiers do not differ";
            }
            // Half-resolution pixels of a march reach half a pixel further than rays of slices, so
            // bounds are compared at a large size.
            const float away = tall * float(kSide) / (34.0f * 2.0f * std::tan(0.2618f));
            const float at[3] = {0, 0.5f * tall, 0};
            const float eye[3] = {0.3f * away, 0.5f * tall + 0.1f * away, 0.95f * away};
            look(eye, at, 30);
            flame.record.key = ++key_;
            flame.record.tier = FW_FIRE_TIER_MARCH_HIGH;
            const std::vector<vec4> high = drawFine(flame, FW_DEPTH_TEST, 4);
            flame.record.key = ++key_;
            flame.record.tier = tier;
            const float worstSize = sizeOff(drawFine(flame, FW_DEPTH_TEST, 4), high);
            std::printf("           %s %s: light within %.4f, cover %.4f, size and tip %.4f\n",
                        tier == FW_FIRE_TIER_SLICES ? "slices of" : "low",
                        components::firePresetName(preset), double(worst), double(worstCover),
                        double(worstSize));
            EXPECT_LT(worst, 0.05f) << components::firePresetName(preset) << " " << tier;
            EXPECT_LT(worstCover, 0.05f) << components::firePresetName(preset) << " " << tier;
            EXPECT_LT(worstSize, 0.03f) << components::firePresetName(preset) << " " << tier;
        }
    }
}

// The same fire as a volume near, as flipbook particles further away, and as a field on a billboard
// far away. Light, brightness, colour and place do not depend on the tier.
TEST_F(Volume, VolumeFlipbooksAndFieldLookTheSame) {
    if (!device_) return;
    nudges_ = true;
    std::pmr::memory_resource* memory = std::pmr::get_default_resource();
    const auto asVolume = [&](float power, Mean& mean) { addVolume(power, mean); };
    const auto asFlipbooks = [&](float power, Mean& mean) {
        FwFireEmitterDef def = fwDefaultFireEmitterDef();
        def.shape = FW_EMITTER_DISC;
        def.radius = 0.225f * tallOf(power);
        def.power = power;
        addEmitter(def, mean);
    };
    const auto asField = [&](float power, Mean& mean) {
        components::ParticleField field(memory);
        components::makeParticleField(fieldOf(power), 1, field);
        const float calm[3] = {0, 0, 0};
        rig_->backend.createField(0, components::rulesOf(field, calm), field.masks);
        constexpr uint32_t kWarm = 60, kSteps = 5;
        for (uint32_t i = 0; i < kWarm + kSteps * kAveraged; ++i) {
            const gpu::FieldRun run{0, i};
            const uint32_t round = 1, slot = 0;
            const double ticks = double(gpu::kTicksPerSecond) / 24 * (i + 1);
            const gpu::FieldDraw drawn = components::fieldDraw(field, ticks, i + 1, ticks);
            gpu::FieldUpdate fields;
            fields.runs = {&run, 1};
            fields.rounds = {&round, 1};
            fields.draws = &drawn;
            fields.drawn = {&slot, 1};
            fields_ = &fields;
            nudge(int(i / kSteps));
            const Mean picture = drawOnce({}, FW_DEPTH_TEST, 0);
            if (i >= kWarm && i % kSteps == 0) addToMean(mean, picture);
        }
        fields_ = nullptr;
        rig_->backend.destroyField(0);
    };

    const std::function<void(float, Mean&)> tiers[] = {asVolume, asFlipbooks, asField};
    constexpr const char* kNames[] = {"volume", "flipbooks", "field"};
    constexpr float kPowers[] = {30, 100, 400};  // kW
    struct Seen {
        float light[3] = {};
        float radiance = 0, green = 0, up = 0, tip = 0;  // means over the powers
        vec4 reach{0.0f};
    } fires[3];
    constexpr float kAway = 6, kDegrees = 22;  // fire heights
    const float heightPx = float(kSide) / (2 * kAway * std::tan(glm::radians(0.5f * kDegrees)));
    for (int i = 0; i < 3; ++i) {
        // A tier keeps its last drawing until another frame, so each gets its own rig.
        makeRig();
        packFlipbooks();
        for (int k = 0; k < 3; ++k) {
            const float power = kPowers[k], tall = tallOf(power);
            const float eye[3] = {0, 0.6f * tall, kAway * tall}, at[3] = {0, 0.6f * tall, 0};
            look(eye, at, kDegrees);
            Mean mean(kSide * kSide, vec4(0.0f));
            tiers[i](power, mean);
            const vec4 m = meanOf(mean);
            const float light = glm::dot(m, kSeen);
            float up = 0, tip = 0;  // px, where its light is; its share near the tip
            for (uint32_t p = 0; p < kSide * kSide; ++p) {
                const float part = glm::dot(mean[p], kSeen) / (light * kSide * kSide);
                const float above = float(kSide - 1 - p / kSide) + 0.5f;
                up += part * above;
                tip += above > 0.5f * float(kSide) ? part : 0;
            }
            Seen& seen = fires[i];
            seen.light[k] = light;
            seen.radiance += light / m.w / 3;
            seen.green += m.y / m.x / 3;
            seen.up += up / 3;
            seen.tip += tip / 3;
            const vec4 reach = reachOf(mean) / heightPx;
            seen.reach += reach / 3.0f;
            std::printf(
                "[   FIGURE ] %g kW, %s: light %.4f, radiance of what it covers %.3f, at "
                "%.2f px, %.4f in its tip, green %.3f of red, %.3f wide and %.3f tall\n",
                double(power), kNames[i], double(light), double(light / m.w), double(up),
                double(tip), double(m.y / m.x), double(reach.z - reach.x),
                double(reach.w - reach.y));
        }
    }
    for (int i = 1; i < 3; ++i) {
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(fires[i].light[k] / fires[0].light[k], 1, 0.05)
                << kNames[i] << ", " << kPowers[k] << " kW";
        EXPECT_NEAR(fires[i].radiance / fires[0].radiance, 1, 0.05) << kNames[i];
        EXPECT_NEAR(fires[i].green / fires[0].green, 1, 0.05) << kNames[i];
        EXPECT_NEAR(fires[i].up / fires[0].up, 1, 0.03) << kNames[i];
        // It ends in a faint tip: light above 0.6 of its height.
        EXPECT_GT(fires[i].tip / fires[0].tip, 0.5f) << kNames[i];
        EXPECT_LT(fires[i].tip / fires[0].tip, 2.0f) << kNames[i];
        // Left, top, right and bottom, relative to the fire's height.
        const vec4 off = glm::abs(fires[i].reach - fires[i - 1].reach);
        const float bounds = std::max({off.x, off.y, off.z, off.w});
        std::printf("[   FIGURE ] %s against %s: radiance of what it covers %.4f, bounds %.4f\n",
                    kNames[i], kNames[i - 1], double(fires[i].radiance / fires[i - 1].radiance),
                    double(bounds));
        EXPECT_LT(bounds, 0.03f) << kNames[i];
    }
}

// A camera moves away from a fire that is a volume near, flipbooks further away and a field far
// away. Around both switches the two tiers are drawn in the same frames: light, brightness,
// beginning and end differ little, and the switch changes the light no more than flicker does. The
// field's billboard is five thirds as wide as the fire's base.
TEST_F(Volume, ADollyThroughVolumeFlipbooksAndFieldShowsOneFire) {
    if (!device_) return;
    std::pmr::memory_resource* memory = std::pmr::get_default_resource();
    constexpr float kPower = 100, kStep = 1 / 6.0f;  // kW, s
    constexpr int kLeg = 56, kFrames = 3 * kLeg;
    const float tall = tallOf(kPower);
    const auto awayAt = [&](int frame) { return 5.5f * tall * std::pow(1.004f, float(frame)); };
    const auto lookFrom = [&](int frame) {
        const float eye[3] = {0, 0.6f * tall, awayAt(frame)}, at[3] = {0, 0.6f * tall, 0};
        look(eye, at, 20);
    };
    using Film = std::vector<Mean>;
    const auto volume = [&] {
        FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
        components::setFirePreset(def, FW_FIRE_CAMP);
        def.flags = FW_FIRE_NO_SMOKE;
        def.power = kPower;
        def.diameter = 0.45f * tall;
        def.tier = FW_FIRE_TIER_MARCH_HIGH;
        Film film;
        for (int frame = 0; frame < kFrames; ++frame) {
            lookFrom(frame);
            gpu::VolumeFlame flame = flameAlone(def, 2 + kStep * float(frame));
            flame.record.key = ++key_;
            film.push_back(draw({&flame, 1}, FW_DEPTH_TEST));
        }
        return film;
    };
    const auto flipbooks = [&] {
        FwFireEmitterDef def = fwDefaultFireEmitterDef();
        def.shape = FW_EMITTER_DISC;
        def.radius = 0.225f * tall;
        def.power = kPower;
        def.flags |= FW_EMITTER_NO_SMOKE;
        def.sparks = 0;
        ParticleReference emitter(def);
        emitter.emitter.flipbooks.fire = 1u | 2u << 8 | 3u << 16;
        gpu::EmitterUpdate update;
        std::vector<gpu::uvec2> groups;
        for (uint32_t first = 0; first < emitter.emitter.ring; first += gpu::kParticleGroup)
            groups.emplace_back(0, first);
        update.groups = groups;
        update.count = 1;
        update.records = &emitter.record;
        update.particleEnd = update.particles = emitter.emitter.ring;
        emitters_ = &update;
        Film film;
        for (int frame = -24; frame < kFrames; ++frame) {
            lookFrom(frame);
            (void)emitter.step(kStep);
            film.push_back(drawOnce({}, FW_DEPTH_TEST, 0));
        }
        emitters_ = nullptr;
        film.erase(film.begin(), film.begin() + 24);
        return film;
    };
    const auto asField = [&] {
        components::ParticleField field(memory);
        components::makeParticleField(fieldOf(kPower), 1, field);
        const float calm[3] = {0, 0, 0};
        rig_->backend.createField(0, components::rulesOf(field, calm), field.masks);
        Film film;
        constexpr int kWarm = 60, kSteps = 4;  // of 1/24 s
        uint32_t step = 0;
        for (int i = -kWarm / kSteps; i < kFrames; ++i) {
            lookFrom(std::max(i, 0));
            gpu::FieldRun runs[kSteps];
            uint32_t rounds[kSteps];
            for (uint32_t k = 0; k < kSteps; ++k) {
                runs[k] = {0, step++};
                rounds[k] = k + 1;
            }
            const uint32_t slot = 0;
            const double ticks = double(gpu::kTicksPerSecond) / 24 * step;
            const gpu::FieldDraw drawn = components::fieldDraw(field, ticks, step, ticks);
            gpu::FieldUpdate fields;
            fields.runs = runs;
            fields.rounds = rounds;
            fields.draws = &drawn;
            fields.drawn = {&slot, 1};
            fields_ = &fields;
            Mean picture = drawOnce({}, FW_DEPTH_TEST, 0);
            if (i >= 0) film.push_back(std::move(picture));
        }
        fields_ = nullptr;
        rig_->backend.destroyField(0);
        return film;
    };
    const std::function<Film()> tiers[] = {volume, flipbooks, asField};
    constexpr const char* kNames[] = {"volume", "flipbooks", "field"};
    Film films[3];
    for (int i = 0; i < 3; ++i) {
        // A tier keeps its last drawing until another frame, so each gets its own rig.
        makeRig();
        packFlipbooks();
        films[i] = tiers[i]();
        ASSERT_EQ(size_t(kFrames), films[i].size());
    }
    const auto lightOf = [&](int tier, int frame) {  // corrected for distance
        const float away = awayAt(frame) / tall;
        return glm::dot(meanOf(films[tier][size_t(frame)]), kSeen) * away * away;
    };
    for (int near = 0; near < 2; ++near) {
        const int first = kLeg * near + kLeg / 2, last = first + kLeg;  // around the switch
        double light[2] = {}, cover[2] = {}, change[2] = {}, cut = 0;
        Mean mean[2] = {Mean(kSide * kSide, vec4(0.0f)), Mean(kSide * kSide, vec4(0.0f))};
        for (int frame = first; frame < last; ++frame) {
            const float away = awayAt(frame) / tall;
            for (int k = 0; k < 2; ++k) {
                const Mean& picture = films[near + k][size_t(frame)];
                light[k] += double(lightOf(near + k, frame)) / kLeg;
                cover[k] += double(meanOf(picture).w * away * away) / kLeg;
                for (size_t p = 0; p < picture.size(); ++p) mean[k][p] += picture[p];
                change[k] +=
                    std::abs(double(lightOf(near + k, frame) - lightOf(near + k, frame - 1))) /
                    kLeg;
            }
            cut += std::abs(double(lightOf(near + 1, frame) - lightOf(near, frame - 1))) / kLeg;
        }
        const double brighter = light[1] / light[0];
        const double radiance = brighter * cover[0] / cover[1];
        // Where its light begins and ends on each side, relative to the fire's height.
        const vec4 moved = glm::abs(reachOf(mean[1]) - reachOf(mean[0]));
        const float pixels =
            float(kSide) * tall / (2 * awayAt(first + kLeg / 2) * std::tan(glm::radians(10.0f)));
        const float bounds = std::max({moved.x, moved.y, moved.z, moved.w}) / pixels;
        std::printf(
            "[   FIGURE ] %s to %s: light %.4f, radiance of what it covers %.4f, bounds %.4f; from "
            "moment to moment light changes by %.3f and %.3f, at a switch by %.3f\n",
            kNames[near], kNames[near + 1], brighter, radiance, double(bounds),
            change[0] / light[0], change[1] / light[1], cut / light[0]);
        EXPECT_NEAR(brighter, 1, 0.05) << kNames[near + 1];
        EXPECT_NEAR(radiance, 1, 0.05) << kNames[near + 1];
        EXPECT_LT(bounds, 0.03f) << kNames[near + 1];
        // No popping: at most a quarter more than the flicker of these tiers.
        EXPECT_LT(cut / light[0], 1.25 * std::max(change[0], change[1]) / light[0])
            << kNames[near + 1];
    }
}

// A flamethrower uses flipbooks, or noise if the host provides none. The light of a volume of equal
// power is printed for comparison only: a jet burns along its whole path.
TEST_F(Volume, AJetByNoiseLooksLikeOneByFlipbooks) {
    if (!device_) return;
    constexpr float kPower = 500;  // kW
    const float far = 9 * tallOf(kPower);
    const auto light = [&](auto&& add, vec3 middle) {
        makeRig();
        packFlipbooks();
        const float eye[3] = {middle.x, middle.y, far}, at[3] = {middle.x, middle.y, 0};
        look(eye, at, 40);
        Mean mean(kSide * kSide, vec4(0.0f));
        add(mean);
        return meanOf(mean);
    };
    FwFireEmitterDef jet = fwDefaultFireEmitterDef();
    jet.flags = FW_EMITTER_JET | FW_EMITTER_NO_COLLISION;
    jet.direction[0] = 1;
    jet.direction[1] = 0.1f;
    jet.power = kPower;
    const float reach = components::emitterAppearance(jet).reach;
    const vec3 above(0, 0.6f * tallOf(kPower), 0), along(0.6f * reach, 0.15f * reach, 0);
    const vec4 flipbooks = light([&](Mean& mean) { addEmitter(jet, mean); }, along);
    const vec4 noise = light([&](Mean& mean) { addEmitter(jet, mean, false); }, along);
    const vec4 volume = light([&](Mean& mean) { addVolume(kPower, mean); }, above);
    const float brighter = glm::dot(noise, kSeen) / glm::dot(flipbooks, kSeen);
    const float greener = (noise.y / noise.x) / (flipbooks.y / flipbooks.x);
    std::printf(
        "[   FIGURE ] %g kW: a jet by noise against flipbooks: light %.2f, green of red %.2f; "
        "its light is %.2f of a volume's\n",
        double(kPower), double(brighter), double(greener),
        double(glm::dot(flipbooks, kSeen) / glm::dot(volume, kSeen)));
    EXPECT_NEAR(1, brighter, 0.08f);
    EXPECT_NEAR(1, greener, 0.1f);
}

// For flames of any two tiers the near one is in front.
TEST_F(Volume, NearFlamesCoverFarOnesInEveryTier) {
    if (!device_) return;
    makeRig();
    const uint32_t tiers[] = {FW_FIRE_TIER_MARCH_HIGH, FW_FIRE_TIER_IMPOSTOR, FW_FIRE_TIER_SLICES,
                              FW_FIRE_TIER_SHARED_IMPOSTOR};
    const float eye[3] = {0, 0.5f, 4}, at[3] = {0, 0.35f, 0};
    look(eye, at, 20);
    const auto flameAt = [&](float z, uint32_t seed) {
        FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
        def.position[2] = z;
        def.seed = seed;
        def.density = 4;  // dense, so that the order is visible
        def.flags = FW_FIRE_NO_SMOKE;
        return flameAlone(def, 1.3f);
    };
    gpu::VolumeFlame flames[2] = {flameAt(0.5f, 7), flameAt(-0.5f, 8)};
    for (const uint32_t near : tiers)
        for (const uint32_t far : tiers) {
            flames[0].record.tier = near, flames[1].record.tier = far;
            for (gpu::VolumeFlame& flame : flames) flame.record.key = ++key_;
            const std::vector<vec4> both = draw(flames, FW_DEPTH_NONE);
            const std::vector<vec4> a = draw({&flames[0], 1}, FW_DEPTH_NONE);
            const std::vector<vec4> b = draw({&flames[1], 1}, FW_DEPTH_NONE);
            std::vector<vec4> right = a, wrong = b;
            for (size_t i = 0; i < right.size(); ++i) {
                right[i] += (1 - a[i].w) * b[i];
                wrong[i] += (1 - b[i].w) * a[i];
            }
            EXPECT_LT(differenceOf(both, right), 0.005f) << near << " in front of " << far;
            EXPECT_GT(differenceOf(wrong, right), 0.05f) << "a wrong order would go unnoticed";
        }
}

// As the camera moves away a flame becomes a billboard, slices or a coarser march, and back. Per
// frame its distance-corrected light changes by at most 0.015 more than without a switch, where
// most change comes from the pixel size.
TEST_F(Volume, SwitchingTiersDoesNotPop) {
    if (!device_) return;
    makeRig();
    const vec4 seen(0.2126f, 0.7152f, 0.0722f, 0.0f);
    for (const uint32_t preset : {FW_FIRE_TORCH, FW_FIRE_CAMP, FW_FIRE_BONFIRE, FW_FIRE_HOUSE}) {
        gpu::VolumeFlame flame = flameOf(preset, 1.3f, FW_FIRE_NO_SMOKE);
        const float tall = 1.5f * flame.record.high.w;
        const auto worstOf = [&](uint32_t first, uint32_t other) {
            flame.record.key = ++key_;
            float last = 0, worst = 0;
            for (int frame = 0; frame < 84; ++frame) {
                const float way = frame < 42 ? float(frame) : float(83 - frame);
                const float away = 4.0f * tall * std::pow(1.01f, way);
                const float at[3] = {0, 0.5f * tall, 0};
                const float eye[3] = {0.2f * away, 0.5f * tall + 0.1f * away, away};
                look(eye, at, 40);
                flame.record.tier = frame >= 20 && frame < 60 ? other : first;
                const float light =
                    glm::dot(meanOf(drawOnce({&flame, 1}, FW_DEPTH_TEST, 0)), seen) * away * away;
                // The first picture is marched while it is drawn.
                if (frame > 1) worst = std::max(worst, std::abs(light / last - 1));
                last = light;
            }
            return worst;
        };
        constexpr uint32_t kHigh = FW_FIRE_TIER_MARCH_HIGH, kSlices = FW_FIRE_TIER_SLICES;
        const float stays = worstOf(kHigh, kHigh), cut = worstOf(kSlices, kSlices);
        const float card = worstOf(kHigh, FW_FIRE_TIER_IMPOSTOR);
        const float low = worstOf(kHigh, FW_FIRE_TIER_MARCH_LOW);
        const float book = worstOf(kHigh, FW_FIRE_TIER_SHARED_IMPOSTOR);
        const float slices = worstOf(kHigh, kSlices);
        std::printf(
            "           %s: at most %.4f a frame, to a card %.4f, book %.4f, low %.4f, slices %.4f "
            "of "
            "%.4f\n",
            components::firePresetName(preset), double(stays), double(card), double(book),
            double(low), double(slices), double(cut));
        // Slices take one ray per pixel, a coarse sample at this size.
        EXPECT_LT(slices, std::max(stays, cut) + 0.015f) << components::firePresetName(preset);
        EXPECT_LT(low, stays + 0.02f) << components::firePresetName(preset);
        EXPECT_LT(card, stays + 0.015f) << components::firePresetName(preset);
        EXPECT_LT(card, 0.04f) << components::firePresetName(preset);
        EXPECT_LT(book, stays + 0.02f) << components::firePresetName(preset);
    }
}

// A camera moves away through all tiers and back: on every stretch brightness, coverage and size
// equal those of a march all the way, and no frame pops.
TEST_F(Volume, ADollyThroughAllTiersShowsOneFlame) {
    if (!device_) return;
    makeRig();
    constexpr uint32_t kLegs[] = {FW_FIRE_TIER_MARCH_HIGH, FW_FIRE_TIER_MARCH_LOW,
                                  FW_FIRE_TIER_SLICES, FW_FIRE_TIER_SHARED_IMPOSTOR,
                                  FW_FIRE_TIER_IMPOSTOR};
    constexpr int kLeg = 18, kWay = kLeg * int(std::size(kLegs));  // frames
    gpu::VolumeFlame flame = flameOf(FW_FIRE_CAMP, 1.3f, FW_FIRE_NO_SMOKE);
    const float tall = 1.5f * flame.record.high.w;
    struct Leg {
        double light = 0, cover = 0;
        float pop = 0;  // largest relative change of light between frames
        Mean mean = Mean(kSide * kSide, vec4(0.0f));
    };
    const auto film = [&](bool all, std::array<Leg, std::size(kLegs)>& legs) {
        flame.record.key = ++key_;
        float last = 0;
        for (int frame = 0; frame < 2 * kWay; ++frame) {
            const int way = frame < kWay ? frame : 2 * kWay - 1 - frame;
            const float away = 3.6f * tall * std::pow(1.007f, float(way));
            const float at[3] = {0, 0.5f * tall, 0};
            const float eye[3] = {0.2f * away, 0.5f * tall + 0.1f * away, away};
            look(eye, at, 40);
            Leg& leg = legs[size_t(way / kLeg)];
            flame.record.tier = kLegs[all ? way / kLeg : 0];
            const Mean picture = drawOnce({&flame, 1}, FW_DEPTH_TEST, 0);
            const vec4 mean = meanOf(picture) * away * away;
            const float light = glm::dot(mean, kSeen);
            for (size_t p = 0; p < picture.size(); ++p) leg.mean[p] += picture[p];
            // The first picture is marched while it is drawn.
            if (frame > 1) leg.pop = std::max(leg.pop, std::abs(light / last - 1));
            last = light;
            leg.light += double(light);
            leg.cover += double(mean.w);
        }
    };
    std::array<Leg, std::size(kLegs)> marched, through;
    film(false, marched);
    film(true, through);
    for (size_t i = 0; i < std::size(kLegs); ++i) {
        const double light = through[i].light / marched[i].light;
        const double cover = through[i].cover / marched[i].cover;
        const float size = sizeOff(through[i].mean, marched[i].mean);
        std::printf(
            "           tier %u: light %.4f, cover %.4f, size and tip %.4f, at most %.4f a frame "
            "of "
            "%.4f\n",
            kLegs[i], light, cover, double(size), double(through[i].pop), double(marched[i].pop));
        // Half-resolution pixels of a march reach half a pixel further than rays of slices: see
        // EveryTierShowsTheSameFlame.
        if (kLegs[i] != FW_FIRE_TIER_SLICES) {
            EXPECT_LT(size, 0.03f) << kLegs[i];
        }
        EXPECT_NEAR(light, 1.0, 0.05) << kLegs[i];
        EXPECT_NEAR(cover, 1.0, 0.05) << kLegs[i];
        EXPECT_LT(through[i].pop, marched[i].pop + (i < 2 ? 0.02f : 0.04f)) << kLegs[i];
    }
}

// A fire shows another fire's impostor at its own size and lean. For a fire that differs only in
// these and is seen from the same side, the impostor equals its own. Brightness, coverage, size and
// change per frame match a march all the way, also where it becomes a billboard. A second view
// marches both, whatever the first shows.
TEST_F(Volume, AFireShowsAnothersImpostorAsItsOwn) {
    if (!device_) return;
    makeRig();
    // A key with almost no delay, so that frames can be compared.
    const auto shelf = std::make_unique<lod::ImpostorAtlases>();
    (*shelf)[0].used = true;
    (*shelf)[0].written = lod::kAtlasFrames;
    const auto isLate = [&](uint32_t key) {
        lod::AtlasCursor reader;
        reader.key = key;
        reader.read(0, *shelf);
        return reader.mirrored || reader.at + 3 < lod::kAtlasFrames;
    };
    uint32_t reads = 2001;
    while (isLate(reads)) ++reads;
    constexpr float kTall = 0.5f, kAway = 5.6f * kTall, kBeside = 0.3f;  // m
    // `scale`, `lean`: of the fire on the left, which shows the other's impostor.
    const auto flameAt = [&](bool left, float seconds, float scale, float lean) {
        FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
        def.flags = FW_FIRE_NO_SMOKE;
        def.seed = 7;
        gpu::VolumeFlame flame = flameAlone(def, seconds);
        gpu::FlameRecord& r = flame.record;
        r.key = left ? reads : 2000;
        if (!left) scale = 1, lean = 0;
        const vec3 to(left ? -kBeside : kBeside, 0, 0);
        const float c = std::cos(lean), s = std::sin(lean);
        // Towards the camera, leaning across the view, at the position where the camera sees it.
        const float aside = left ? std::atan(kBeside / kAway) : 0.0f;
        const float ca = std::cos(aside), sa = std::sin(aside);
        const auto turn = [&](vec4& v) {
            v = vec4(ca * v.x + sa * v.z, v.y, ca * v.z - sa * v.x, v.w);
            v = vec4(c * v.x + s * v.y, c * v.y - s * v.x, v.z, v.w);
            v = vec4(ca * v.x + sa * v.z, v.y, ca * v.z - sa * v.x, v.w);
        };
        const auto place = [&](vec4& v) {
            v = vec4(scale * vec3(v), v.w);
            turn(v);
            v += vec4(to, 0.0f);
        };
        vec3 low(1e9f), high(-1e9f);
        for (gpu::FlameNode& node : flame.nodes) {
            place(node.centre);
            node.centre.w *= scale, node.along.w *= scale;
            turn(node.along), turn(node.side), turn(node.squeeze);
        }
        for (int corner = 0; corner < 8; ++corner) {
            vec4 at(corner & 1 ? r.low.x : r.high.x, corner & 2 ? r.low.y : r.high.y,
                    corner & 4 ? r.low.z : r.high.z, 0);
            place(at);
            low = glm::min(low, vec3(at)), high = glm::max(high, vec3(at));
        }
        r.low = vec4(low, scale * r.low.w), r.high = vec4(high, scale * r.high.w);
        place(r.glow);
        for (float* length : {&r.tauStart, &r.tauFree, &r.lambda, &r.lambdaWarp, &r.lambdaColumn})
            *length *= scale;
        r.soot /= scale;
        r.speed *= std::sqrt(scale);  // equally many eddies: flameTau follows the root
        return flame;
    };
    const auto film = [&](bool marched, int frames, float scale, float lean, float step,
                          const auto& see) {
        for (int frame = 0; frame < frames; ++frame) {
            const float seconds = 1 + step * float(frame);
            gpu::VolumeFlame flames[2] = {flameAt(true, seconds, scale, lean),
                                          flameAt(false, seconds, scale, lean)};
            for (gpu::VolumeFlame& flame : flames) {
                flame.record.key += marched ? 100000 : 0;
                flame.record.tier = marched       ? FW_FIRE_TIER_MARCH_HIGH
                                    : frame >= 96 ? FW_FIRE_TIER_IMPOSTOR
                                                  : FW_FIRE_TIER_SHARED_IMPOSTOR;
            }
            const float eye[3] = {0, 0.5f * kTall, kAway}, at[3] = {0, 0.5f * kTall, 0};
            look(eye, at, 24);
            // The other was there first, so its impostor is shown, whichever is larger.
            const std::span<const gpu::VolumeFlame> shown(flames);
            Mean picture = drawOnce(shown.subspan(frame < 4 ? 1 : 0), FW_DEPTH_TEST, 0);
            for (uint32_t i = 0; i < picture.size(); ++i)
                if (i % kSide >= kSide / 2) picture[i] = vec4(0.0f);
            see(frame, picture);
        }
    };
    // 32 frames fill an impostor, then it repeats.
    constexpr int kStill = 56;
    for (const float lean : {0.0f, 0.2f, -0.2f}) {
        Mean shown;
        film(false, kStill, 0.85f, lean, 0, [&](int, const Mean& picture) { shown = picture; });
        // Half-resolution pixels of a march reach half a pixel further, so means of many pixels
        // count.
        gpu::VolumeFlame flame = flameAt(true, 1, 0.85f, lean);
        flame.record.key = ++key_;
        flame.record.tier = FW_FIRE_TIER_MARCH_HIGH;
        constexpr uint32_t kFine = 3;
        const Mean fine = drawFine(flame, FW_DEPTH_TEST, kFine);
        Mean stands(kSide * kSide, vec4(0.0f));
        for (uint32_t i = 0; i < fine.size(); ++i)
            stands[i / (kSide * kFine) / kFine * kSide + i % (kSide * kFine) / kFine] +=
                fine[i] / float(kFine * kFine);
        const vec4 is = meanOf(shown), was = meanOf(stands);
        const float light = glm::dot(is, kSeen) / glm::dot(was, kSeen);
        const float size = sizeOff(shown, stands, 0), off = differenceOf(shown, stands);
        std::printf(
            "[   FIGURE ] leaning by %.1f: light %.4f, cover %.4f, size and tip %.4f, pixels "
            "differ "
            "by %.3f\n",
            double(lean), double(light), double(is.w / was.w), double(size), double(off));
        EXPECT_NEAR(light, 1, 0.05f) << lean;
        EXPECT_NEAR(is.w / was.w, 1, 0.05f) << lean;
        EXPECT_LT(size, 0.03f) << lean;
        EXPECT_LT(off, 0.25f) << lean;
        EXPECT_GT(off, 1e-3f) << "it is still marched";
    }

    struct Film {
        double light = 0, cover = 0;
        float most = 0, turning = 0, last = 0;  // change of light between frames
        Mean mean = Mean(kSide * kSide, vec4(0.0f));
    } films[2];
    for (const bool marched : {false, true})
        film(marched, 112, 1, 0, 0.1f, [&](int frame, const Mean& picture) {
            Film& of = films[marched];
            const vec4 mean = meanOf(picture);
            const float light = glm::dot(mean, kSeen), change = std::abs(light / of.last - 1);
            of.last = light;
            if (frame < 53) return;
            (frame > 96 ? of.turning : of.most) =
                std::max(frame > 96 ? of.turning : of.most, change);
            if (frame >= 96) return;
            of.light += double(light), of.cover += double(mean.w);
            for (size_t i = 0; i < picture.size(); ++i) of.mean[i] += picture[i];
        });
    const double light = films[0].light / films[1].light, cover = films[0].cover / films[1].cover;
    const float size = sizeOff(films[0].mean, films[1].mean);
    std::printf(
        "[   FIGURE ] by another's pages: light %.4f, cover %.4f, size and tip %.4f; at most %.4f "
        "a "
        "frame of %.4f, as it turns to a card %.4f of %.4f\n",
        light, cover, double(size), double(films[0].most), double(films[1].most),
        double(films[0].turning), double(films[1].turning));
    EXPECT_NEAR(light, 1, 0.05);
    EXPECT_NEAR(cover, 1, 0.05);
    EXPECT_LT(size, 0.03f);
    EXPECT_LT(films[0].most, films[1].most + 0.03f);
    EXPECT_LT(films[0].turning, films[1].turning + 0.05f);

    gpu::VolumeFlame flames[2] = {flameAt(true, 2, 1, 0), flameAt(false, 2, 1, 0)};
    for (gpu::VolumeFlame& flame : flames) flame.record.tier = FW_FIRE_TIER_SHARED_IMPOSTOR;
    const Mean second = drawDirect(flames, FW_DEPTH_TEST);
    for (gpu::VolumeFlame& flame : flames) flame.record.tier = FW_FIRE_TIER_MARCH_HIGH;
    EXPECT_EQ(second, drawDirect(flames, FW_DEPTH_TEST));
}

// The scene is bent behind hot gas above a flame and nowhere else. Objects in front neither move
// nor smear, and there is no haze where the view, the tier or the frame disables it.
TEST_F(Volume, HazeBendsOnlyTheSceneBehindTheFlame) {
    if (!device_) return;
    makeRig();
    const float eye[3] = {0, 1.0f, 4}, at[3] = {0, 1.0f, 0};
    look(eye, at, 34);
    gpu::VolumeFlame flame = flameOf(FW_FIRE_CAMP, 1.3f, FW_FIRE_NO_SMOKE);
    flame.record.soot = flame.record.blue = 0;  // only its heat shows
    // A chequered wall far behind; on the right a post of another colour in front of the flame.
    scene_.assign(kSide * kSide, 30.0f);
    for (uint32_t i = 0; i < kSide * kSide; ++i) {
        const bool white = ((i % kSide / 2) ^ (i / kSide / 2)) & 1u;
        backdrop_.emplace_back(0.0f, white ? 1.0f : 0.1f, 0.0f, 1.0f);
    }
    const auto post = [](uint32_t i) { return i % kSide >= 23 && i % kSide < 26; };
    const auto drawn = [&](float haze) {
        rig_->view.haze = haze;
        flame.record.key = ++key_;
        return draw({&flame, 1}, FW_DEPTH_SAMPLED);
    };
    const auto moved = [&](const std::vector<vec4>& picture, uint32_t row0, uint32_t row1) {
        double sum = 0;
        for (uint32_t i = row0 * kSide; i < row1 * kSide; ++i)
            sum += double(std::abs(picture[i].y - backdrop_[i].y));
        return sum / double((row1 - row0) * kSide);
    };
    const std::vector<vec4> bent = drawn(1), more = drawn(4), none = drawn(0);
    std::printf("           a pixel moves by %.3f, four times as far %.3f, beside it %.3f\n",
                moved(bent, 6, 26), moved(more, 6, 26), moved(bent, 38, 40));
    EXPECT_GT(moved(bent, 6, 26), 0.01);
    EXPECT_GT(moved(more, 6, 26), 1.5 * moved(bent, 6, 26));
    EXPECT_LT(moved(bent, 38, 40), 1e-4) << "below the flame";
    for (uint32_t i = 0; i < kSide * kSide; ++i) {
        EXPECT_EQ(none[i], backdrop_[i]) << "haze is disabled";
        if (i % kSide < 4 || i % kSide >= 36) {
            EXPECT_EQ(more[i].y, backdrop_[i].y) << "beside the column";
        }
    }
    for (uint32_t i = 0; i < kSide * kSide; ++i)
        if (post(i)) backdrop_[i] = {1, 0, 0, 1}, scene_[i] = 2.0f;
    const std::vector<vec4> posted = drawn(8);
    uint32_t near = 0;
    for (uint32_t i = 0; i < kSide * kSide; ++i) {
        if (post(i)) {
            EXPECT_EQ(posted[i], backdrop_[i]) << "the post moved";
        } else {
            EXPECT_LT(posted[i].x, 1e-4f) << "it smears at " << i % kSide << ", " << i / kSide;
            near += posted[i] != backdrop_[i] ? 1 : 0;
        }
    }
    EXPECT_GT(near, 100u) << "an error would go unnoticed";
    flame.record.tier = FW_FIRE_TIER_MARCH_LOW;
    EXPECT_EQ(drawn(8), backdrop_) << "with few samples";
}

// With more billboards than marches per frame, each blends from march to march instead of jumping.
// The largest change per frame is at most 2.5 times the mean; jumping every eighth frame gives 8.
TEST_F(Volume, BillboardsBlendBetweenTheirMarches) {
    if (!device_) return;
    makeRig();
    // One in the left half of the view, the others side by side in the right half.
    std::vector<gpu::VolumeFlame> flames(96, flameOf(FW_FIRE_CAMP, 1.0f, FW_FIRE_NO_SMOKE));
    const float tall = 1.5f * flames[0].record.high.w;
    const auto moveBy = [](gpu::VolumeFlame& flame, vec3 by) {
        for (gpu::FlameNode& node : flame.nodes) node.centre += vec4(by, 0.0f);
        flame.record.low += vec4(by, 0.0f), flame.record.high += vec4(by, 0.0f);
        flame.record.glow += vec4(by, 0.0f);
    };
    const float eye[3] = {0, 0.5f * tall, 5.0f * tall}, at[3] = {0, 0.5f * tall, 0};
    look(eye, at, 30);
    const auto show = [&](gpu::VolumeFlame& flame, uint32_t i) {
        flame.record.tier = FW_FIRE_TIER_IMPOSTOR;
        flame.record.key = 1000 + i;
        moveBy(flame,
               i ? vec3((0.35f + 0.006f * float(i)) * tall, 0, 0) : vec3(-0.6f * tall, 0, 0));
    };
    for (uint32_t i = 1; i < flames.size(); ++i) show(flames[i], i);
    std::vector<vec4> last;
    double sum = 0, worst = 0;
    constexpr int kWarm = 24, kFrames = 40;
    for (int frame = 0; frame < kWarm + kFrames; ++frame) {
        flames[0] = flameOf(FW_FIRE_CAMP, 1.0f + float(frame) / 60, FW_FIRE_NO_SMOKE);
        show(flames[0], 0);
        const std::vector<vec4> now = drawOnce(flames, FW_DEPTH_TEST, 0);
        if (frame > kWarm) {
            double change = 0;
            for (uint32_t i = 0; i < now.size(); ++i)
                if (i % kSide < kSide / 2) change += double(std::abs(now[i].x - last[i].x));
            sum += change, worst = std::max(worst, change);
        }
        last = now;
    }
    const double mean = sum / (kFrames - 1);
    std::printf("           a frame changes a card by %.4f of light at most, %.4f in the mean\n",
                worst, mean);
    EXPECT_GT(mean, 1e-3) << "it moves";
    EXPECT_LT(worst, 2.5 * mean);
}

// Temporal mixing is not needed, although sample offsets change each frame. A still flame changes
// by less than 1 % per frame, and in a dolly by at most 2 % more than rays without grain. Mixing
// would only smear tongues.
TEST_F(Volume, FramesNeedNoTemporalMixing) {
    if (!device_) return;
    makeRig();
    for (const uint32_t preset : {FW_FIRE_TORCH, FW_FIRE_CAMP, FW_FIRE_HOUSE}) {
        gpu::VolumeFlame flame = flameOf(preset, 1.3f, FW_FIRE_NO_SMOKE);
        const float tall = 1.5f * flame.record.high.w;
        flame.record.key = ++key_;
        double still = 0, dolly = 0, exact = 0;
        std::vector<vec4> last, lastExact;
        constexpr int kFrames = 10;
        for (const bool moves : {false, true})
            for (int frame = 0; frame < kFrames; ++frame) {
                const float away = 3.0f * tall * std::pow(1.004f, moves ? float(frame) : 0.0f);
                const float at[3] = {0, 0.5f * tall, 0};
                const float eye[3] = {0.2f * away, 0.5f * tall + 0.1f * away, away};
                look(eye, at, 30);
                rig_->view.time = 2 + float(frame) / 60;
                if (frame == 0) (void)drawOnce({&flame, 1}, FW_DEPTH_TEST, 0);
                const std::vector<vec4> now = drawOnce({&flame, 1}, FW_DEPTH_TEST, 0);
                std::vector<vec4> rays;
                if (moves) rays = march(flame, preset, false, 128);
                if (frame > 0) {
                    const auto change = double(differenceOf(now, last));
                    if (!moves) still = std::max(still, change);
                    if (moves) dolly += change / (kFrames - 1);
                    if (moves) exact += double(differenceOf(rays, lastExact)) / (kFrames - 1);
                }
                last = now, lastExact = rays;
            }
        std::printf("           %s: %.4f a frame where it stands, %.4f in a dolly, of rays %.4f\n",
                    components::firePresetName(preset), still, dolly, exact);
        EXPECT_LT(still, 0.01) << components::firePresetName(preset);
        EXPECT_LT(dolly, exact + 0.02) << components::firePresetName(preset);
    }
}

// For any number and nearness of flames, pixels grow until all fit.
TEST(MarchLayout, FitsAnyFlamesIntoTheMemory) {
    const lod::VolumeScreen screen{{1280, 720}, gpu::kVolumeSlabs};
    const uint32_t words = lod::volumeRayWords(screen);
    std::vector<lod::VolumeItem> items(gpu::kMaxVolumeFlames);
    std::vector<lod::MarchedVolume> out(items.size());
    for (uint32_t i = 0; i < items.size(); ++i) {
        items[i].flame = i;
        items[i].draw.slabs = gpu::kVolumeSlabs;
        items[i].draw.rect = {-1, -1, 1, 1};
        items[i].draw.deep = 0.2f;
        items[i].draw.spacing = 0.1f;
        items[i].draw.mostSteps = 32;
        items[i].draw.wide = 1;
    }
    const auto cell = [&](size_t i) { return 640 * out[i].composite.place.z; };  // px
    for (const size_t count : {size_t(1), size_t(7), items.size()}) {
        const lod::VolumeAllocation allocation =
            lod::allocateVolumes({items.data(), count}, screen, 1, words, out);
        ASSERT_EQ(allocation.count, count);
        EXPECT_EQ(allocation.end, out[0].march.samples);
        std::printf("           %zu over all: cells of %.0f px\n", count, double(cell(0)));
        uint32_t known = 0, sample = out[0].march.samples;
        for (size_t i = 0; i < count; ++i) {
            const gpu::MarchPush& march = out[i].march;
            const gpu::CompositePush& shown = out[i].composite;
            EXPECT_EQ(march.tiles, known);
            EXPECT_EQ(shown.flags, known);
            EXPECT_EQ(march.samples, sample);
            EXPECT_EQ(shown.samples, sample);
            known += gpu::kMarchTileWords * shown.tilesX * shown.tilesY;
            sample += march.pixels * march.slabs * gpu::kMarchPixelWords;
            EXPECT_GE(float(shown.tilesX * gpu::kMarchTileSide) * cell(i), 1280.0f);
            EXPECT_GE(float(shown.tilesY * gpu::kMarchTileSide) * cell(i), 720.0f);
        }
        EXPECT_EQ(known, out[0].march.samples);
        EXPECT_LE(sample, words);
        if (count == 1) {
            EXPECT_EQ(cell(0), 2.0f);
        }
    }
    EXPECT_EQ(lod::allocateVolumes(items, screen, 1, 1000, out).end, 0u) << "it must not fit";

    // A small flame keeps fine pixels however many large ones crowd the memory.
    lod::VolumeItem& small = items.back();
    small.draw.rect = {-0.01f, -0.02f, 0.01f, 0.02f};
    small.draw.wide = 0.05f;
    small.draw.rayX = {4, 0, 0, 0};
    ASSERT_GT(lod::allocateVolumes(std::span(&small, 1), screen, 1, words, out).end, 0u);
    const float alone = cell(0);
    EXPECT_LT(alone, 1.0f);
    ASSERT_GT(lod::allocateVolumes(items, screen, 1, words, out).end, 0u);
    EXPECT_GT(cell(0), 4.0f) << "memory must be short";
    EXPECT_EQ(cell(items.size() - 1), alone);
}

// When memory is short, smoke yields: fire keeps its resolution in its own window, which begins
// where the smoke's ends.
TEST(MarchLayout, SmokeYieldsMemoryToFire) {
    const lod::VolumeScreen screen{{1280, 720}, gpu::kVolumeSlabs};
    const uint32_t words = lod::volumeRayWords(screen);
    std::array<lod::VolumeItem, 24> items;
    for (lod::VolumeItem& item : items) {
        item.flame = uint32_t(&item - items.data());
        item.smokes = true;
        item.draw.slabs = gpu::kVolumeSlabs;
        item.draw.rect = {-1, -1, 1, 1};
        item.burns = {-0.1f, -0.2f, 0.1f, 0.2f};
        item.draw.deep = 0.2f;
        item.draw.spacing = 0.1f;
        item.draw.mostSteps = 32;
        item.draw.wide = 1;
    }
    std::array<lod::MarchedVolume, 2 * items.size()> out;
    const auto cell = [&](size_t i) { return 640 * out[i].composite.place.z; };  // px
    ASSERT_EQ(lod::allocateVolumes({items.data(), 1}, screen, 1, words, out).count, 1u);
    EXPECT_EQ(cell(0), 2.0f) << "there is memory for one";
    EXPECT_EQ(out[0].composite.window, vec4(0.0f));
    ASSERT_EQ(lod::allocateVolumes(items, screen, 1, words, out).count, out.size());
    for (size_t i = 0; i < out.size(); i += 2) {
        const gpu::CompositePush &whole = out[i].composite, &fire = out[i + 1].composite;
        EXPECT_FALSE(out[i].window);
        EXPECT_TRUE(out[i + 1].window);
        EXPECT_GE(cell(i), 8.0f);
        EXPECT_EQ(cell(i + 1), 2.0f);
        const vec2 size = float(gpu::kMarchTileSide) * vec2(fire.tilesX, fire.tilesY);
        const vec2 low(fire.place), high = low + size * vec2(fire.place.z, fire.place.w);
        const vec2 per(whole.place.z, whole.place.w);
        EXPECT_LT(glm::distance(vec2(whole.place) + per * vec2(whole.window), low), 1e-5f);
        EXPECT_LT(
            glm::distance(vec2(whole.place) + per * vec2(whole.window.z, whole.window.w), high),
            1e-5f);
        const vec4& burns = items[0].burns;
        EXPECT_TRUE(low.x < burns.x + 1e-5f && low.y < burns.y + 1e-5f &&
                    high.x > burns.z - 1e-5f && high.y > burns.w - 1e-5f);
    }
}

// It is the same flame: no line where the resolution changes, no light lost or counted twice.
TEST_F(Volume, SmokeAtLowResolutionShowsTheSameFlame) {
    if (!device_) return;
    makeRig();
    const float eye[3] = {0.9f, 1.2f, 5.5f}, at[3] = {0, 1.1f, 0};
    look(eye, at, 30);
    for (int i = 0; i < 3; ++i) rig_->view.ambientSky[i] = rig_->view.ambientGround[i] = 0.6f;
    const gpu::VolumeFlame flame = flameOf(FW_FIRE_CAMP, 1.3f);
    const std::vector<vec4> whole = draw({&flame, 1}, FW_DEPTH_TEST);
    std::vector<vec4> shared = whole;
    for (memory_ = 0.1f; shared == whole && memory_ > 0.004f; memory_ *= 0.7f)
        shared = draw({&flame, 1}, FW_DEPTH_TEST);
    const float difference = differenceOf(shared, whole);
    std::printf("           mean %.4f of %.4f, cover %.4f of %.4f, difference %.4f\n",
                double(meanOf(shared).x), double(meanOf(whole).x), double(meanOf(shared).w),
                double(meanOf(whole).w), double(difference));
    EXPECT_GT(difference, 1e-5f) << "memory must be short";
    EXPECT_LT(difference, 0.02f);
    EXPECT_NEAR(meanOf(shared).x / meanOf(whole).x, 1.0f, 0.02f);
    EXPECT_NEAR(meanOf(shared).w / meanOf(whole).w, 1.0f, 0.02f);
}

// A flame partly behind the camera covers the screen only where it is in front.
TEST(VolumeDraw, IsDrawnOnlyWhereItIsInFrontOfTheCamera) {
    const float eye[3] = {0, 0, 0}, at[3] = {0, 0, -1};
    const FwView camera = testView(eye, at, 40, 1, false);
    gpu::ViewInput input;
    input.view = &camera;
    input.viewport[2] = input.viewport[3] = 100;
    const gpu::ViewParams view = gpu::makeViewParams(input);
    const vec4 low(1, -0.5f, -10, 0.5f), high(2, 0.3f, 3, 1);
    gpu::VolumeDraw draw{};
    vec4 whole(1.0f);
    ASSERT_TRUE(lod::volumeDraw(view, low, high, 1, draw, &whole));
    EXPECT_EQ(whole, vec4(0.0f)) << "it surrounds the camera";
    vec4 seen(1, 1, -1, -1);
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    for (int k = 0; k < 20000; ++k) {
        const vec3 p =
            glm::mix(vec3(low), vec3(high), vec3(unit(random), unit(random), unit(random)));
        const vec4 clip = p.x * view.clip0 + p.y * view.clip1 + p.z * view.clip2 + view.clip3;
        const vec2 place = vec2(clip) / clip.w;
        if (!(clip.w > 1e-3f) || glm::any(glm::greaterThan(glm::abs(place), vec2(1.0f)))) continue;
        seen = vec4(glm::min(vec2(seen), place), glm::max(vec2(seen.z, seen.w), place));
        ASSERT_TRUE(place.x >= draw.rect.x && place.y >= draw.rect.y && place.x <= draw.rect.z &&
                    place.y <= draw.rect.w);
    }
    EXPECT_NEAR(draw.rect.x, seen.x, 0.03f) << "not all of the screen";
    EXPECT_GT(draw.rect.x, 0.2f);
    const vec4 behind(2, 1, 4, 0);
    EXPECT_FALSE(lod::volumeDraw(view, vec4(1, 0, 1, 1), behind, 1, draw));
}

TEST_F(Volume, SteadyFramesAllocateNothing) {
    if (!device_) return;
    core::Log log{FwCallbacks{}};
    makeRig(countingEntry());
    VkRig& rig = *rig_;
    const FwTargetId target = targetOf(FW_DEPTH_TEST);
    world::World world(plainWorldDef(0), rig.backend, log, &rig.memory);
    std::vector<FwVolumetricFireId> ids;
    for (uint32_t i = 0; i < FW_FIRE_PRESET_COUNT; ++i) {
        FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
        components::setFirePreset(def, i);
        ids.push_back(world.flames().create(def));
    }
    const auto frame = [&](int f) {
        const float place[3] = {0.01f * float(f % 50), 0, 0};
        world.flames().move(ids[0], place);
        world.flames().setPower(ids[1], float(f % 3));
        world.flames().setHidden(ids[2], f % 4 == 0);
        const FwVulkanFrame begun = rig.frames.begin();
        ASSERT_TRUE(rig.backend.beginOutside(begun, rig.view));
        world.advance(begun.frameIndex, 1.0f / 32);
        rig.backend.endOutside();
        record(begun, target, FW_DEPTH_TEST, 1);
        rig.frames.submit();
    };
    for (int f = 0; f < 32; ++f) frame(f);  // warm-up
    (void)takeCounts();
    const uint64_t allocations = rig.allocations;
    for (int f = 32; f < 160; ++f) frame(f);
    const VulkanCounts counts = takeCounts();
    EXPECT_EQ(counts.total(), 0u);
    EXPECT_EQ(rig.allocations, allocations);
    EXPECT_GT(counts.work, 100u);
    for (const FwVolumetricFireId id : ids) world.flames().destroy(id);
    for (int f = 0; f < 2; ++f) {
        const FwVulkanFrame begun = rig.frames.begin();
        ASSERT_TRUE(rig.backend.beginOutside(begun, rig.view));
        world.advance(begun.frameIndex, 1.0f / 32);
        rig.backend.endOutside();
        rig.frames.submit();
        if (f == 0) (void)takeCounts();
    }
    const VulkanCounts after = takeCounts();
    EXPECT_EQ(after.work + after.barriers, 0u) << "no fire is left";
}

// A post with thin slanted edges in front of a flame, with a wall close behind: its pixels show no
// light from behind, as at full resolution.
TEST_F(Volume, NoLightLeaksOntoEdgesAtHalfResolution) {
    if (!device_) return;
    std::vector<Mean> pictures;
    std::vector<bool> post(kSide * kSide);
    for (const bool half : {false, true}) {
        half_ = half;
        makeRig();
        const float eye[3] = {0.3f, 0.6f, 2.0f}, at[3] = {0, 0.45f, 0};
        look(eye, at, 30);
        FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
        components::setFirePreset(def, FW_FIRE_CAMP);
        def.diameter = 0.6f;
        def.power = 150;
        def.tier = FW_FIRE_TIER_MARCH_HIGH;
        gpu::VolumeFlame flame = flameAlone(def, 1.3f);
        flame.record.key = 1;
        // The post is in front of the flame, the wall inside or behind it.
        for (const float behind : {1.26f, 2.0f}) {
            for (uint32_t i = 0; i < kSide * kSide; ++i) {
                const uint32_t x = i % kSide, y = i / kSide;
                const float slant = float(x) - 0.45f * float(kSide) - 0.13f * float(y);
                const bool thin = (x + kSide - y) % kSide == kSide / 3;
                post[i] = std::abs(slant) < 3.3f || thin;
                scene_.push_back(post[i] ? 1.55f : 1.55f * behind);
            }
            pictures.push_back(draw({&flame, 1}, FW_DEPTH_SAMPLED));
            scene_.clear();
        }
    }
    ASSERT_EQ(pictures.size(), 4u);
    for (const size_t k : {size_t{0}, size_t{1}}) {
        float brightest = 0, leaks = 0, missing = 0;
        for (uint32_t i = 0; i < kSide * kSide; ++i) {
            const float off = pictures[k + 2][i].x - pictures[k][i].x;
            brightest = std::max(brightest, pictures[k][i].x);
            if (post[i]) leaks = std::max(leaks, off);
            missing = std::max(missing, -off);
        }
        std::printf(
            "[   FIGURE ] at most %.4f of the brightest leaks onto the post, %.4f is missing\n",
            double(leaks / brightest), double(missing / brightest));
        EXPECT_GT(brightest, 0.05f);
        EXPECT_LT(leaks, 0.05f * brightest) << k;
    }
}

// Every soft effect at half and full resolution: a marched flame, a field, fire and smoke
// particles, each alone, all together, particles on both sides of the flame, and objects in front.
// Light and coverage agree. Objects in front keep their edges without halos, also a wall at an odd
// pixel and a post one pixel wide. It costs three bytes per pixel.
TEST_F(Volume, HalfResolutionKeepsBrightnessAndEdges) {
    if (!device_) return;
    std::pmr::memory_resource* memory = std::pmr::get_default_resource();
    constexpr uint32_t kWall = 15, kPost = 22;  // px: columns in front of it; its own
    uint64_t bytes[2] = {};
    const auto film = [&](bool half) {
        half_ = half;
        makeRig();
        packFlipbooks();
        const auto targets = [&] {
            std::pmr::vector<gpu::MemoryRow> rows;
            rig_->context.memoryRows(rows);
            uint64_t sum = 0;
            for (const gpu::MemoryRow& row : rows)
                if (std::string_view(row.name) == "targets") sum += row.bytes;
            return sum;
        };
        std::vector<Mean> pictures;
        const float eye[3] = {0.3f, 0.6f, 2.0f}, at[3] = {0, 0.45f, 0};
        look(eye, at, 30);
        for (int i = 0; i < 3; ++i) rig_->view.ambientSky[i] = rig_->view.ambientGround[i] = 0.3f;
        FwVolumetricFireDef large = fwDefaultVolumetricFireDef();
        components::setFirePreset(large, FW_FIRE_CAMP);
        large.diameter = 0.6f;
        large.power = 150;
        large.seed = 7;
        large.tier = FW_FIRE_TIER_MARCH_HIGH;
        gpu::VolumeFlame flame = flameAlone(large, 1.3f);
        flame.record.key = 1;
        pictures.push_back(draw({&flame, 1}, FW_DEPTH_SAMPLED));

        FwParticleFieldDef fieldDef = fwDefaultParticleFieldDef();
        components::setFieldPreset(fieldDef, uint32_t(field::FieldPreset::Smoke));
        components::ParticleField field(memory);
        fieldDef.size[0] = 0.8f;
        fieldDef.size[1] = 0.9f;
        components::makeParticleField(fieldDef, 1, field);
        const float calm[3] = {0, 0, 0};
        rig_->backend.createField(0, components::rulesOf(field, calm), field.masks);
        gpu::FieldUpdate fields;
        gpu::FieldRun run{};
        gpu::FieldDraw drawn{};
        const uint32_t round = 1, slot = 0;
        fields_ = &fields;
        fields.runs = {&run, 1};
        fields.rounds = {&round, 1};
        fields.draws = &drawn;
        fields.drawn = {&slot, 1};
        for (uint32_t i = 0; i < 50; ++i) {
            run = {0, i};
            const double ticks = double(gpu::kTicksPerSecond) / 24 * (i + 1);
            drawn = components::fieldDraw(field, ticks, i + 1, ticks);
            const Mean picture = drawOnce({}, FW_DEPTH_SAMPLED, 0);
            if (i == 49) pictures.push_back(picture);
        }
        fields.runs = {};
        fields.rounds = {};
        fields.drawn = {};

        FwFireEmitterDef def = fwDefaultFireEmitterDef();
        def.shape = FW_EMITTER_DISC;
        def.radius = 0.25f;
        def.power = 120;
        def.sparks = 0;
        ParticleReference emitter(def);
        emitter.emitter.flipbooks = {1u | 2u << 8, 3u};
        gpu::EmitterUpdate update;
        const gpu::uvec2 group(0, 0);
        ASSERT_LE(emitter.emitter.ring, gpu::kParticleGroup);
        update.groups = {&group, 1};
        update.count = 1;
        update.records = &emitter.record;
        update.particleEnd = update.particles = emitter.emitter.ring;
        emitters_ = &update;
        for (int i = 0; i < 60; ++i) {
            (void)emitter.step(1 / 30.0f);
            (void)drawOnce({}, FW_DEPTH_SAMPLED, 0);
        }
        const auto mean = [&](std::span<const gpu::VolumeFlame> flames) {
            Mean sum(kSide * kSide, vec4(0.0f));
            for (int i = 0; i < kAveraged; ++i) {
                EXPECT_TRUE(emitter.step(kApart));
                addToMean(sum, drawOnce(flames, FW_DEPTH_SAMPLED, 0));
            }
            return sum;
        };
        pictures.push_back(mean({}));
        fields.drawn = {&slot, 1};
        pictures.push_back(mean({&flame, 1}));
        for (uint32_t i = 0; i < kSide * kSide; ++i)
            scene_.push_back(i % kSide < kWall || i % kSide == kPost ? 0.6f : 50.0f);
        pictures.push_back(mean({&flame, 1}));
        scene_.clear();
        fields.drawn = {};
        for (const float by : {-0.7f, 1.4f}) {  // the flame behind the particles, in front of them
            for (gpu::FlameNode& node : flame.nodes) node.centre.z += by;
            for (vec4* moved : {&flame.record.low, &flame.record.high, &flame.record.glow})
                moved->z += by;
            pictures.push_back(mean({&flame, 1}));
        }
        bytes[half] = targets();
        emitters_ = nullptr;
        fields_ = nullptr;
        films_.push_back(pictures);
    };
    film(false);
    film(true);
    ASSERT_EQ(films_.size(), 2u);
    constexpr const char* kNames[] = {"a flame",          "a field",
                                      "particles",        "all",
                                      "all behind walls", "particles before a flame",
                                      "particles behind"};
    for (size_t k = 0; k < std::size(kNames); ++k) {
        const vec4 whole = meanOf(films_[0][k]), half = meanOf(films_[1][k]);
        const float light = glm::dot(half, kSeen) / glm::dot(whole, kSeen);
        const float cover = half.w / whole.w;
        std::printf("[   FIGURE ] %s: light %.4f, at half resolution %.4f of it, cover %.4f\n",
                    kNames[k], double(glm::dot(whole, kSeen)), double(light), double(cover));
        EXPECT_GT(whole.w, 0.01f) << kNames[k];
        EXPECT_NEAR(light, 1.0f, 0.02f) << kNames[k];
        EXPECT_NEAR(cover, 1.0f, 0.02f) << kNames[k];
        EXPECT_GT(differenceOf(films_[1][k], films_[0][k]), 1e-4f)
            << "half resolution makes no difference";
    }
    const auto column = [&](bool half, uint32_t x) {
        vec4 sum(0.0f);
        for (uint32_t y = 0; y < kSide; ++y) sum += films_[half][4][y * kSide + x];
        return sum;
    };
    float brightest = 0;
    for (uint32_t x = 0; x < kSide; ++x) brightest = std::max(brightest, column(false, x).x);
    for (uint32_t x = 0; x < kSide; ++x) {
        const vec4 whole = column(false, x), half = column(true, x);
        if (x < kWall || x == kPost) {
            EXPECT_EQ(whole.w, 0.0f) << "nothing is in front of " << x;
            EXPECT_LT(half.x, 0.01f * brightest) << "a halo at " << x;
            // The flame's position shows equally at both resolutions.
            EXPECT_GT(differenceOf(films_[0][5], films_[0][6]), 0.2f);
            for (const size_t k : {5, 6})
                EXPECT_LT(differenceOf(films_[1][k], films_[0][k]), 0.15f) << kNames[k];
            EXPECT_LT(half.w, 0.01f * float(kSide)) << "a halo at " << x;
        } else if (x == kWall || x + 1 == kPost || x == kPost + 1) {
            std::printf(
                "[   FIGURE ] beside an edge, column %u: %.4f of the light, %.4f of "
                "the cover\n",
                x, double(half.x / whole.x), double(half.w / whole.w));
            EXPECT_NEAR(half.x / whole.x, 1.0f, 0.12f) << x;
            EXPECT_NEAR(half.w / whole.w, 1.0f, 0.12f) << x;
        }
    }
    const uint64_t least = uint64_t{3} * kSide * kSide;
    std::printf("[   FIGURE ] %llu bytes for %u pixels\n",
                static_cast<unsigned long long>(bytes[1] - bytes[0]), kSide * kSide);
    EXPECT_GE(bytes[1] - bytes[0], least);
    EXPECT_LE(bytes[1] - bytes[0], least + 8192) << "rows of tiles, and rounding of images";
}

// Sparks are drawn at full resolution: alone they are equal bit for bit.
TEST_F(Volume, SparksAreDrawnAtFullResolution) {
    if (!device_) return;
    const auto shot = [&](bool half) {
        half_ = half;
        makeRig();
        FwFireEmitterDef def = fwDefaultFireEmitterDef();
        def.flags |= FW_EMITTER_NO_SMOKE;
        def.power = 50;
        def.sparks = 1;
        ParticleReference emitter(def);
        gpu::SparkSource source{};
        gpu::EmitterUpdate update;
        update.sparks = &source;
        update.sparkCount = 1;
        update.sparkQuads = 64;
        emitters_ = &update;
        Mean picture;
        for (int i = 0; i < 12; ++i) {
            (void)emitter.step(0.1f);
            components::settleSparks(emitter.emitter, emitter.air.now);
            EXPECT_TRUE(components::advanceSparks(emitter.emitter, emitter.air, 0.1f, source));
            picture = drawOnce({}, FW_DEPTH_SAMPLED, 0);
        }
        emitters_ = nullptr;
        return picture;
    };
    const Mean whole = shot(false), half = shot(true);
    EXPECT_GT(meanOf(whole).x, 0.0f);
    EXPECT_EQ(whole, half);
}

}  // namespace
}  // namespace fw::test::volume_test
