// Drawing inside a host's pass and over a host's images: primary and secondary command buffers, one
// and four samples, normal and reversed depth, three encodings. The host draws before and after,
// and its pixels stay unchanged.
#include "host_draw.h"

namespace fw::test::host_draw {
namespace {

TEST_F(HostDraw, InsidePrimaryAndSecondary) {
    if (!device_) return;
    for (const bool secondary : {false, true}) {
        for (const bool reversed : {false, true}) {
            Shot shot;
            shot.secondary = secondary;
            shot.reversedDepth = reversed;
            SCOPED_TRACE(std::string(secondary ? "secondary" : "primary") +
                         (reversed ? ", reversed depth" : ""));
            expectHostsPixels(shoot(shot), shot);
        }
    }
}

TEST_F(HostDraw, FourSamples) {
    if (!device_) return;
    Shot shot;
    shot.samples = 4;
    expectHostsPixels(shoot(shot), shot);
    shot.secondary = true;
    expectHostsPixels(shoot(shot), shot);
}

TEST_F(HostDraw, WithoutDepth) {
    if (!device_) return;
    Shot shot;
    shot.depth = false;
    expectHostsPixels(shoot(shot), shot);
}

// sRGB views and display-referred UNORM hold the same bytes; a linear target holds light.
TEST_F(HostDraw, EncodingsAgree) {
    if (!device_) return;
    Shot srgb, unorm, linear;
    unorm.color = VK_FORMAT_R8G8B8A8_UNORM;
    unorm.encoding = FW_OUTPUT_DISPLAY_UNORM;
    linear.color = VK_FORMAT_R16G16B16A16_SFLOAT;
    linear.encoding = FW_OUTPUT_LINEAR;
    const Picture a = shoot(srgb), b = shoot(unorm), c = shoot(linear);
    expectHostsPixels(a, srgb);
    expectHostsPixels(b, unorm);
    expectHostsPixels(c, linear);
    uint32_t differ = 0;
    float most = 0;
    for (size_t i = 0; i < a.rgb.size(); ++i) {
        if (std::abs(a.rgb[i] - b.rgb[i]) > 2.5f / 255) ++differ;
        most = std::max(most, c.rgb[i]);
    }
    Shot automatic = unorm;
    automatic.encoding = FW_OUTPUT_AUTO;
    EXPECT_EQ(shoot(automatic).rgb, b.rgb);
    // Flames blend in linear light over sRGB and in display values over UNORM.
    EXPECT_LT(differ, a.rgb.size() / 25) << "of " << a.rgb.size();
    EXPECT_GT(most, 1.0f) << "fire is brighter than white";
}

TEST_F(HostDraw, CompositesOverTheHostsImages) {
    if (!device_) return;
    for (const bool reversed : {false, true}) {
        Shot shot;
        shot.composite = true;
        shot.reversedDepth = reversed;
        const Picture over = shoot(shot);
        EXPECT_GT(over.unlike(0, kWidth, 0, 0, 1), 600u);
        shot.depthMode = FW_DEPTH_TEST_ONLY;  // uniformly behind a wall
        const Picture hidden = shoot(shot);
        EXPECT_EQ(hidden.unlike(0, kWidth, 0, 0, 1), 0u);
    }
    Shot shot;
    shot.composite = true;
    shot.depth = false;
    EXPECT_GT(shoot(shot).unlike(0, kWidth, 0, 0, 1), 600u);
}

// Depth of a plane that faces the camera at `distance` m.
float depthOf(const FwView& view, float distance) {
    const float z = -distance;
    return (view.projection[10] * z + view.projection[14]) / (view.projection[11] * z);
}

double lightOf(const Picture& picture) {  // all but the host's blue and its strips
    double sum = 0;
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 8; x < kWidth - 8; ++x)
            sum += double(picture.at(x, y)[0]) + double(picture.at(x, y)[1]);
    return sum;
}

// The same in linear light, since a finer picture changes the stored values.
double linearLightOf(const Picture& picture) {
    double sum = 0;
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 8; x < kWidth - 8; ++x)
            for (int c = 0; c < 2; ++c) sum += std::pow(double(picture.at(x, y)[c]), 2.2);
    return sum;
}

// Flames against a sampled depth: hidden behind it, complete in front of it, fading in between
// where a depth test would cut. The picture is the same for every way that the host passes the
// depth.
TEST_F(HostDraw, SampledDepthFadesFlames) {
    if (!device_) return;
    const float planes[4] = {2.0f, 2.44f, 2.47f, 4.0f};  // m from the camera; the fire is at 2.5
    std::vector<float> reference;
    for (const bool reversed : {false, true}) {
        for (const uint32_t samples : {1u, 4u}) {
            for (const bool composite : {true, false}) {
                SCOPED_TRACE(std::to_string(samples) + (reversed ? " reversed" : "") +
                             (composite ? " composite" : " inside"));
                Shot soft;
                soft.composite = composite;
                soft.reversedDepth = reversed;
                soft.depthMode = FW_DEPTH_SAMPLED;
                soft.depthSamples = samples;
                Shot hard;
                hard.composite = true;
                hard.reversedDepth = reversed;
                hard.depthMode = FW_DEPTH_TEST_ONLY;
                hard.flags = FW_TARGET_NO_SURFACES;
                double softLight[4], hardLight[4];
                std::vector<float> all;
                for (int i = 0; i < 4; ++i) {
                    soft.depthValue = hard.depthValue =
                        depthOf(reversed ? reversed_ : normal_, planes[i]);
                    Picture picture = shoot(soft);
                    if (!composite) {  // without the host's strips
                        EXPECT_EQ(picture.unlike(0, 8, 1, 0, 0), 0u);
                        EXPECT_EQ(picture.unlike(kWidth - 8, kWidth, 0, 1, 0), 0u);
                    }
                    softLight[i] = lightOf(picture);
                    if (composite && (samples > 1) == reversed) {
                        Shot half = soft;
                        half.flags = FW_TARGET_HALF_EFFECTS;
                        // Tongues are a few pixels wide, so sampling is coarse.
                        const double light = linearLightOf(picture);
                        EXPECT_NEAR(linearLightOf(shoot(half)), light, 0.1 * light + 0.01)
                            << planes[i] << " m, at half resolution";
                    }
                    hardLight[i] = lightOf(shoot(hard));
                    for (uint32_t y = 0; y < kHeight; ++y)
                        all.insert(all.end(), picture.at(8, y), picture.at(kWidth - 8, y));
                }
                EXPECT_EQ(softLight[0], 0) << "behind a wall";
                EXPECT_EQ(hardLight[0], 0);
                EXPECT_GT(hardLight[3], 100);
                EXPECT_NEAR(softLight[3], hardLight[3], 1e-3 * hardLight[3])
                    << "nothing near the flame";
                EXPECT_LT(softLight[2], 0.9 * softLight[3]) << "a wall among the flames";
                EXPECT_LT(softLight[1], 0.8 * softLight[2]);
                EXPECT_GT(softLight[1], 1.1 * hardLight[1]) << "half of the flames are in front";
                if (reference.empty()) reference = all;
                float most = 0;
                for (size_t i = 0; i < all.size(); ++i)
                    most = std::max(most, std::abs(all[i] - reference[i]));
                EXPECT_LE(most, 3.5f / 255) << "the picture";
            }
        }
    }
}

// A window resized every frame, down to one pixel, while the fire burns: a warm library allocates
// nothing on device or heap.
TEST_F(HostDraw, ResizingEveryFrameAllocatesNothing) {
    if (!device_) return;
    const Shot shot;
    const VkRenderPass pass = makePass(shot);
    const FwTargetId target = registerTarget(shot, pass);
    const TestImage color =
        device_->makeImage(shot.color, {kWidth, kHeight}, 1,
                           VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    const TestImage depth = device_->makeImage(VK_FORMAT_D32_SFLOAT, {kWidth, kHeight}, 1,
                                               VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
    const VkDevice device = device_->device;
    constexpr uint32_t kWarmUp = 30, kFrames = 300;
    uint64_t allocations = 0;
    for (uint32_t f = 0; f < kWarmUp + kFrames; ++f) {
        const uint32_t width = 1 + f * 37 % kWidth, height = 1 + f * 23 % kHeight;
        const VkImageView views[2] = {color.view, depth.view};
        VkFramebufferCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
        info.renderPass = pass;
        info.attachmentCount = 2;
        info.pAttachments = views;
        info.width = width;
        info.height = height;
        info.layers = 1;
        VkFramebuffer framebuffer = VK_NULL_HANDLE;
        ASSERT_EQ(vkCreateFramebuffer(device, &info, nullptr, &framebuffer), VK_SUCCESS);
        rig_->alsoRecord = [&](const FwVulkanFrame& frame) {
            VkClearValue clears[2]{};
            clears[1].depthStencil.depth = 1;
            VkRenderPassBeginInfo begin{};
            begin.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
            begin.renderPass = pass;
            begin.framebuffer = framebuffer;
            begin.renderArea.extent = {width, height};
            begin.clearValueCount = 2;
            begin.pClearValues = clears;
            vkCmdBeginRenderPass(frame.commandBuffer, &begin, VK_SUBPASS_CONTENTS_INLINE);
            const VkViewport viewport{0, 0, float(width), float(height), 0, 1};
            EXPECT_TRUE(rig_->backend.recordInside(frame, target, normal_, viewport));
            vkCmdEndRenderPass(frame.commandBuffer);
        };
        if (f == kWarmUp) {
            (void)takeCounts();
            allocations = rig_->allocations;
        }
        gpu::StepPlan step;
        step.now = endTick_;
        step.reduce = f % 4 == 3;
        gpu::FramePlan plan;
        plan.frameIndex = 17 + f;
        plan.steps = {&step, 1};
        plan.endTick = endTick_ += gpu::kStepTicks;
        rig_->run(plan);
        rig_->frames.waitAll();  // one picture for all frames
        vkDestroyFramebuffer(device, framebuffer, nullptr);
    }
    rig_->alsoRecord = nullptr;
    const VulkanCounts asked = takeCounts();
    EXPECT_EQ(asked.total(), 0u) << asked.submits << " submits, " << asked.waits << " waits, "
                                 << asked.memory << " allocations, " << asked.pipelines
                                 << " pipelines, " << asked.objects << " objects";
    EXPECT_EQ(asked.passes, 0u);
    EXPECT_EQ(rig_->allocations, allocations);
    EXPECT_GE(asked.draws, uint64_t(kFrames));
    rig_->context.unregisterTarget(target);
}

// Composites alternate over two images: one framebuffer each while warming up, then none until the
// host takes its images back. Without the flag every call creates one. Validation reports leaks.
TEST_F(HostDraw, KeptCompositesCreateNothing) {
    if (!device_) return;
    Shot shot;
    shot.composite = true;
    const FwTargetId target = registerTarget(shot, VK_NULL_HANDLE);
    shot.flags = FW_TARGET_NO_SURFACES;  // faster to create
    FwTargetId second = registerTarget(shot, VK_NULL_HANDLE);
    TestImage colors[2], depths[2];
    for (int i = 0; i < 2; ++i) {
        colors[i] = device_->makeImage(shot.color, {kWidth, kHeight}, 1,
                                       VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                           VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                           VK_IMAGE_USAGE_TRANSFER_DST_BIT);
        depths[i] = device_->makeImage(
            VK_FORMAT_D32_SFLOAT, {kWidth, kHeight}, 1,
            VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    }
    uint64_t index = 16;
    const auto made = [&](FwTargetId into, uint32_t frames, uint32_t flags) {
        (void)takeCounts();
        for (uint32_t f = 0; f < frames; ++f) {
            rig_->alsoRecord = [&](const FwVulkanFrame& frame) {
                (void)recordComposite(shot, frame, into, normal_, colors[f % 2], depths[f % 2], 0,
                                      1, flags);
            };
            gpu::FramePlan plan;
            plan.frameIndex = ++index;
            plan.endTick = endTick_;
            rig_->run(plan);
        }
        rig_->alsoRecord = nullptr;
        rig_->frames.waitAll();
        return takeCounts().total();
    };
    EXPECT_EQ(made(target, 6, FW_COMPOSITE_KEEP), 2u) << "warming up";
    EXPECT_EQ(made(target, 12, FW_COMPOSITE_KEEP), 0u);
    EXPECT_EQ(made(target, 4, 0), 4u) << "kept framebuffers are released";
    EXPECT_EQ(made(target, 6, FW_COMPOSITE_KEEP), 2u);
    EXPECT_EQ(made(second, 6, FW_COMPOSITE_KEEP), 2u) << "another target has its own";
    EXPECT_EQ(made(target, 6, FW_COMPOSITE_KEEP), 0u);
    rig_->context.unregisterTarget(second);
    second = registerTarget(shot, VK_NULL_HANDLE);  // the same slot, another generation
    EXPECT_EQ(made(second, 6, FW_COMPOSITE_KEEP), 2u);
    EXPECT_EQ(made(target, 6, FW_COMPOSITE_KEEP), 0u);
}

// The first object of a material family creates its pipelines. No pipeline is created while a frame
// records (shoot() checks). The picture equals that of a target with all of them.
TEST_F(HostDraw, MaterialFamiliesCreateTheirPipelinesOnFirstUse) {
    if (!device_) return;
    Shot late, all;
    all.asNeeded = false;
    const auto madeBy = [](const auto& call) {
        (void)takeCounts();
        call();
        return takeCounts().pipelines;
    };
    const uint64_t some = madeBy([&] { (void)targetFor(late); });
    EXPECT_EQ(madeBy([&] { (void)targetFor(all); }) - some, gpu::kSurfacePassCount - 5)
        << "wood: fresh, cold and burning, from both sides";
    const auto place = [&](uint32_t slot, FwMaterialPreset look, float x) {
        gpu::ObjectInit init = scene_.init(0);
        std::array<gpu::BurnMaterial, gpu::kMaterialsPerObject> materials =
            scene_.objects[0].materials;
        for (gpu::BurnMaterial& material : materials) material.appearance = look;
        init.materials = materials;
        init.record.worldRow0.w = x;
        init.record.worldRow2.w = -1;
        return madeBy([&] { rig_->backend.createObject(slot, init); });
    };
    EXPECT_EQ(place(1, FW_MATERIAL_PLYWOOD, -0.8f), 0u) << "the wood pipelines exist";
    EXPECT_EQ(shoot(late).rgb, shoot(all).rgb);
    EXPECT_EQ(place(2, FW_MATERIAL_THATCH, 0.8f), 5u);
    EXPECT_EQ(shoot(late).rgb, shoot(all).rgb);
    gpu::StepPlan step;
    step.now = endTick_;
    const gpu::TexelEvent lit[] = {{2, litTexel(), gpu::kEventIgnite, endTick_ + 1}};
    step.events = lit;
    gpu::FramePlan plan;
    plan.frameIndex = 50;
    plan.steps = {&step, 1};
    plan.endTick = endTick_ += gpu::kStepTicks;
    EXPECT_EQ(madeBy([&] { rig_->run(plan); }), 0u);
    EXPECT_EQ(shoot(late).rgb, shoot(all).rgb) << "it burns";
}

// Pixels inside the scissor equal those without it; pixels outside are the host's. In a host pass,
// a composite, and with effects at half resolution.
TEST_F(HostDraw, DrawsOnlyInsideTheScissor) {
    if (!device_) return;
    // One of 255: with the shaders of GPU-assisted validation a driver rounded otherwise where the
    // scissor cuts a triangle.
    constexpr float kAlike = 1.5f / 255;
    Shot inPass, composite, half;
    composite.composite = half.composite = true;
    half.depthMode = FW_DEPTH_SAMPLED;
    half.flags = FW_TARGET_HALF_EFFECTS;
    half.depthValue = 1;
    for (Shot* shot : {&inPass, &composite, &half}) {
        const Picture whole = shoot(*shot);
        shot->scissor = {{50, 20}, {14, 17}};
        const Picture cut = shoot(*shot);
        uint32_t inside = 0, differ = 0, outside = 0;
        for (uint32_t y = 0; y < kHeight; ++y)
            for (uint32_t x = 8; x < kWidth - 8; ++x) {  // the side strips are the host's
                const float *a = whole.at(x, y), *b = cut.at(x, y);
                const bool shown = x >= 50 && x < 64 && y >= 20 && y < 37;
                const bool drawn = std::abs(b[0]) + std::abs(b[1]) + std::abs(b[2] - 1) > 0.02f;
                if (!shown) {
                    outside += drawn;
                    continue;
                }
                inside += drawn;
                for (int k = 0; k < 3; ++k) differ += std::abs(a[k] - b[k]) > kAlike;
            }
        EXPECT_EQ(outside, 0u);
        EXPECT_EQ(differ, 0u);
        EXPECT_GT(inside, shot == &half ? 10u : 100u) << "part of the fire is inside the scissor";
    }
}

double lightOfStored(double stored) {
    return stored <= 0.04045 ? stored / 12.92 : std::pow((stored + 0.055) / 1.055, 2.4);
}

// Surfaces and flames together: at 1 the host's picture is unchanged; at 0.5 each pixel is halfway
// between the host's picture and ours, whatever overlaps. As stored in UNORM and float targets, as
// light in sRGB ones.
TEST_F(HostDraw, TransparencyMixesTheWholePicture) {
    if (!device_) return;
    Shot unorm, srgb, linear;
    unorm.color = VK_FORMAT_R8G8B8A8_UNORM;
    linear.color = VK_FORMAT_R16G16B16A16_SFLOAT;
    unorm.encoding = srgb.encoding = linear.encoding = FW_OUTPUT_AUTO;
    Shot several = unorm, reversed = unorm, composite = unorm, half = unorm;
    several.samples = 4;
    reversed.reversedDepth = true;
    composite.composite = half.composite = true;
    half.depthMode = FW_DEPTH_SAMPLED;
    half.depthValue = 1;
    half.flags = FW_TARGET_HALF_EFFECTS;
    for (Shot* shot : {&unorm, &srgb, &linear, &several, &reversed, &composite, &half}) {
        SCOPED_TRACE(int(shot->color));
        shot->flags |= FW_TARGET_TRANSPARENCY;
        const Picture ours = shoot(*shot);
        shot->transparency = 1;
        EXPECT_EQ(shoot(*shot).unlike(8, kWidth - 8, 0, 0, 1), 0u) << "nothing is drawn";
        for (const float share : {0.5f, 0.25f}) {
            shot->transparency = share;
            const Picture mixed = shoot(*shot);
            const bool light = shot == &srgb;
            double most = 0;
            uint32_t drawn = 0;
            for (uint32_t y = 0; y < kHeight; ++y)
                for (uint32_t x = 8; x < kWidth - 8; ++x)
                    for (int c = 0; c < 3; ++c) {
                        const double host = c == 2 ? 1 : 0, a = double(ours.at(x, y)[c]),
                                     m = double(mixed.at(x, y)[c]);
                        const auto level = [&](double v) { return light ? lightOfStored(v) : v; };
                        const double wanted = level(a) + double(share) * (level(host) - level(a));
                        // One stored step is more light where it is bright.
                        const double step =
                            light ? (lightOfStored(m + 0.5 / 255) - lightOfStored(m - 0.5 / 255)) *
                                        255
                                  : std::max(1.0, a);
                        most = std::max(most, std::abs(level(m) - wanted) / std::max(step, 0.1));
                        drawn += std::abs(a - host) > 0.02;
                    }
            EXPECT_LE(most, 2.0 / 255) << share;
            EXPECT_GT(drawn, 100u);
        }
    }
}

TEST_F(HostDraw, TargetsRefuseInvalidDefs) {
    if (!device_) return;
    const VkRenderPass pass = makePass({});
    const auto refused = [&](const std::function<void(FwVulkanTargetDef&)>& spoil,
                             const char* word) {
        FwVulkanTargetDef def = fwDefaultVulkanTargetDef();
        def.renderPass = pass;
        def.colorFormat = VK_FORMAT_R8G8B8A8_SRGB;
        def.depthFormat = VK_FORMAT_D32_SFLOAT;
        spoil(def);
        try {
            (void)rig_->context.registerTarget(def);
            ADD_FAILURE() << word << " is not refused";
        } catch (const core::Error& error) {
            EXPECT_THAT(error.message, testing::HasSubstr(word));
        }
    };
    refused([](auto& d) { d.renderPass = VK_NULL_HANDLE; }, "renderPass");
    refused([](auto& d) { d.samples = 3; }, "samples");
    refused([](auto& d) { d.viewMask = 3; }, "viewMask");
    refused([](auto& d) { d.encoding = 9; }, "encoding");
    refused([](auto& d) { d.depthMode = 17; }, "depthMode");
    refused([](auto& d) { d.depthFormat = VK_FORMAT_UNDEFINED; }, "depthFormat");
    refused([](auto& d) { d.colorFormat = VK_FORMAT_R32G32B32A32_UINT; }, "colorFormat");
    refused([](auto& d) { d.depthFormat = VK_FORMAT_R32_SFLOAT; }, "depthFormat is 100");
    refused(
        [](auto& d) {
            d.depthMode = FW_DEPTH_SAMPLED;
            d.depthSamples = 16;
        },
        "depthSamples is 16");
    refused([](auto& d) { d.flags = 128; }, "flags is 128");
    refused(
        [](auto& d) {
            d.flags = FW_TARGET_HALF_EFFECTS;
            d.depthMode = FW_DEPTH_SAMPLED;
        },
        "FW_TARGET_HALF_EFFECTS needs FW_TARGET_COMPOSITE and FW_DEPTH_SAMPLED");
    refused(
        [](auto& d) {
            d.flags = FW_TARGET_HALF_EFFECTS | FW_TARGET_COMPOSITE;
            d.renderPass = VK_NULL_HANDLE;
        },
        "FW_TARGET_HALF_EFFECTS needs FW_TARGET_COMPOSITE and FW_DEPTH_SAMPLED");
    refused(
        [](auto& d) {
            d.flags = FW_TARGET_HAZE;
            d.depthMode = FW_DEPTH_TEST;
        },
        "FW_TARGET_HAZE needs depthMode FW_DEPTH_SAMPLED");
    if (!device_->options.independentBlend)
        refused([](auto& d) { d.colorAttachmentCount = 2; },
                "FwVulkanTargetDef::colorAttachmentCount is 2; more than 1 needs the feature "
                "independentBlend, which was not declared");
    FwTargetId stale{1, 77};
    EXPECT_THROW(rig_->context.unregisterTarget(stale), core::Error);
}

}  // namespace
}  // namespace fw::test::host_draw
