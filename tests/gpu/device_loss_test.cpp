// Loses a host device at one of the library's Vulkan calls after another through the host's entry
// points. The host hears of it, everything is freed, and the fire continues from the last mirror in
// another context. FLAMEWRIGHT_LOSE_EVERY=1 in the environment tests every call.
#include "support/loss_scene.h"
#include "support/views.h"
#include "support/vulkan_device.h"

#include <cstdio>

namespace fw::test::device_loss_test {
namespace {

using host::Bytes;
using host::Host;
using host::LossReference;
using host::LossScene;

constexpr uint32_t kWidth = 64, kHeight = 36;

class HostDeviceLoss : public GpuTest {
 protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (!device_) return;
        losingVulkan()->real = vkGetInstanceProcAddr;
        color_ = device_->makeImage(VK_FORMAT_R8G8B8A8_SRGB, {kWidth, kHeight}, 1,
                                    VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
        depth_ = device_->makeImage(VK_FORMAT_D32_SFLOAT, {kWidth, kHeight}, 1,
                                    VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
        device_->run([&](VkCommandBuffer commands) {
            const VkImageMemoryBarrier first[] = {barrierOf(color_, false),
                                                  barrierOf(depth_, true)};
            vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT,
                                 VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0, nullptr, 2,
                                 first);
        });
    }
    static VkImageLayout layoutOf(bool depth) {
        return depth ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL
                     : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    }
    static VkImageMemoryBarrier barrierOf(const TestImage& image, bool depth) {
        VkImageMemoryBarrier barrier{};
        barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
        barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
        barrier.newLayout = layoutOf(depth);
        barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
        barrier.image = image.image;
        barrier.subresourceRange = {
            VkImageAspectFlags(depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT), 0, 1,
            0, 1};
        return barrier;
    }

    // One run of a context on the host device until a call fails.
    struct Life {
        Host host;
        HostFrames frames;
        LossScene scene;
        FwContext* context = nullptr;
        FwTargetId target{};
        FwResult result = FW_OK;
        TestDevice& device;
        int64_t playedFrom = 0;  // Vulkan calls before the first frame

        explicit Life(HostDeviceLoss& test) : frames(*test.device_, 2), device(*test.device_) {
            scene.step = [this, &test](FwWorld* world, float seconds) {
                return record(test, world, seconds);
            };
            FwVulkanHost vulkanHost = test.device_->host();
            vulkanHost.getInstanceProcAddr = losingEntry;
            FwContextDef def = fwDefaultContextDef();
            def.vulkan = &vulkanHost;
            def.callbacks = host.callbacks();
            FwErrorInfo error{};
            result = fwCreateContext(&def, &context, &error);
            if (result == FW_OK) result = fwContext_Prepare(context);
            FwVulkanTargetDef targetDef = fwDefaultVulkanTargetDef();
            targetDef.flags = FW_TARGET_COMPOSITE;
            targetDef.colorFormat = VK_FORMAT_R8G8B8A8_SRGB;
            targetDef.depthFormat = VK_FORMAT_D32_SFLOAT;
            targetDef.encoding = FW_OUTPUT_SRGB_VIEW;
            if (result == FW_OK) result = fwContext_RegisterTarget(context, &targetDef, &target);
        }
        Life(const Life&) = delete;
        Life& operator=(const Life&) = delete;
        ~Life() {
            frames.waitAll();  // work submitted before
            fwDestroyContext(context);
            EXPECT_EQ(0, host.blocks);
            EXPECT_EQ(0, losingVulkan()->live) << "objects of the device leak";
        }
        void burn() {
            if (result == FW_OK) result = scene.make(context);
            scene.calls = [] { return losingVulkan()->calls.load(); };
            playedFrom = scene.calls();
            if (result == FW_OK) result = scene.play();
        }
        FwResult record(HostDeviceLoss& test, FwWorld* world, float seconds) {
            const FwView view =
                viewAt({0.4f, 0.6f, 1.5f}, {0.4f, 0.1f, 0.1f}, float(kWidth) / kHeight);
            const FwVulkanFrame frame = frames.begin(seconds);
            FwVulkanComposite images = fwDefaultVulkanComposite();
            images.width = kWidth, images.height = kHeight;
            images.color = imageOf(test.color_, false);
            images.depth = imageOf(test.depth_, true);
            FwResult done = fwWorld_RecordOutside(world, &frame, &view);
            if (done == FW_OK)
                done = fwWorld_RecordComposite(world, &frame, target, &view, &images);
            if (done == FW_OK) frames.submit();  // impossible for a host whose device is lost
            return done;
        }
    };
    static FwVulkanImage imageOf(const TestImage& image, bool depth) {
        FwVulkanImage out{};
        out.image = image.image;
        out.view = image.view;
        out.layoutBefore = out.layoutAfter = layoutOf(depth);
        out.stageBefore = out.stageAfter = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
        out.accessBefore = out.accessAfter = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
        return out;
    }

    TestImage color_, depth_;
};

TEST_F(HostDeviceLoss, IsSurvivedAtEveryCallOfAHostDevice) {
    if (!device_) return;
    LosingVulkan& vulkan = *losingVulkan();
    LossReference reference;
    int64_t calls = 0, frames = 0;
    std::vector<int64_t> mirroredAt;
    vulkan.begin(-1);
    {
        Life whole(*this);
        whole.burn();
        ASSERT_EQ(FW_OK, whole.result) << whole.host.lastError;
        calls = vulkan.calls;
        frames = whole.playedFrom;
        mirroredAt = whole.scene.mirroredAt;
        ASSERT_GT(calls, 400) << "the library does not call through the table";
        EXPECT_EQ(reference.end, whole.scene.save());
    }
    const std::vector<int64_t> losses =
        host::chooseLosses(vulkan, frames, calls, mirroredAt, 24, false);
    std::map<uint32_t, uint32_t> mirrors;  // mirrors by frame
    std::vector<Bytes> recovered;
    for (const int64_t call : losses) {
        SCOPED_TRACE("lost at call " + std::to_string(call) + ", " + vulkan.nameOf(call));
        vulkan.begin(call);
        Bytes mirror;
        uint32_t frame = 0;
        {
            Life life(*this);
            life.burn();
            ASSERT_TRUE(vulkan.lost) << "the call did not come";
            EXPECT_TRUE(host::reportsLoss(life.result, vulkan.nameOf(call)))
                << fwResultName(life.result) << ": " << life.host.lastError;
            if (life.scene.world) {  // the device stays lost, and the world returns what it has
                EXPECT_EQ(FW_ERROR_DEVICE_LOST, life.record(*this, life.scene.world, 0.1f));
                EXPECT_EQ(FW_OK, life.scene.completeSave());
            }
            mirror = life.scene.mirror;
            frame = life.scene.mirrored;
        }
        vulkan.begin(-1);
        ++mirrors[frame];
        if (frame == 0) continue;
        EXPECT_EQ(reference.saves[frame], mirror) << "the mirror of frame " << frame;
        if (std::find(recovered.begin(), recovered.end(), mirror) != recovered.end()) continue;
        recovered.push_back(mirror);
        Life other(*this);
        ASSERT_EQ(FW_OK, other.result) << other.host.lastError;
        reference.expectRecovers(other.context, other.scene, mirror, frame);
    }
    host::printLosses(losses.size(), calls, mirrors);
    EXPECT_EQ(std::size(LossScene::kSaves), recovered.size());
    losingDrop();
}

}  // namespace
}  // namespace fw::test::device_loss_test
