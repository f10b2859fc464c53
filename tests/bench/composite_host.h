// A host with its own solids (none: a distant grey picture) and the library's effects composited
// over them at 1280 x 720 with readable depth. For target kinds that an own device does not have.
#pragma once
#include "bench/bench_device.h"
#include "flamewright/flamewright.h"
#include "flamewright/flamewright_vulkan.h"

#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <cstring>

namespace fw::test {

constexpr VkExtent3D kPicture{1280, 720, 1};

struct BenchImage {
    VkImage image = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
};

class CompositeHost {
 public:
    CompositeHost() : device_(benchDevice()) {}
    CompositeHost(const CompositeHost&) = delete;
    CompositeHost& operator=(const CompositeHost&) = delete;
    ~CompositeHost() {
        fwDestroyWorld(world_);
        fwDestroyContext(context_);
        for (const BenchImage& image : {color_, behind_, depth_}) {
            vkDestroyImageView(device_.device, image.view, nullptr);
            vkDestroyImage(device_.device, image.image, nullptr);
            vkFreeMemory(device_.device, image.memory, nullptr);
        }
    }

    // Returns null, or the reason of failure.
    const char* make(const FwWorldDef& worldDef) {
        if (!device_.fence) return "no device";
        color_ = imageOf(VK_FORMAT_R8G8B8A8_UNORM,
                         VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
        behind_ = imageOf(VK_FORMAT_R8G8B8A8_UNORM,
                          VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
        depth_ = imageOf(VK_FORMAT_D32_SFLOAT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
                                                   VK_IMAGE_USAGE_SAMPLED_BIT |
                                                   VK_IMAGE_USAGE_TRANSFER_DST_BIT);
        const FwVulkanHost host = device_.host();
        FwContextDef contextDef = fwDefaultContextDef();
        contextDef.vulkan = &host;
        FwErrorInfo info{};
        if (fwCreateContext(&contextDef, &context_, &info) != FW_OK ||
            fwCreateWorld(context_, &worldDef, &world_) != FW_OK)
            return "no world";
        return nullptr;
    }
    // FW_TARGET_COMPOSITE and `flags`. Returns zero on failure.
    FwTargetId target(uint32_t flags) {
        FwVulkanTargetDef def = fwDefaultVulkanTargetDef();
        def.flags = FW_TARGET_COMPOSITE | flags;
        def.colorFormat = VK_FORMAT_R8G8B8A8_UNORM;
        def.depthFormat = VK_FORMAT_D32_SFLOAT;
        def.depthMode = FW_DEPTH_SAMPLED;
        def.encoding = FW_OUTPUT_DISPLAY_UNORM;
        FwTargetId id{};
        const bool registered = fwContext_RegisterTarget(context_, &def, &id) == FW_OK &&
                                fwContext_Prepare(context_) == FW_OK;
        return registered ? id : FwTargetId{};
    }
    void look(glm::vec3 from, glm::vec3 at, float zoom) {
        const glm::mat4 view = glm::lookAt(from, at, glm::vec3(0, 1, 0));
        glm::mat4 projection(0.0f);
        projection[0][0] = zoom * 9.0f / 16.0f;
        projection[1][1] = -zoom;
        projection[2][2] = projection[2][3] = -1.0f;
        projection[3][2] = -0.05f;
        FwView& to = views_[0];
        to = fwDefaultView();
        std::memcpy(to.view, glm::value_ptr(view), sizeof to.view);
        std::memcpy(to.projection, glm::value_ptr(projection), sizeof to.projection);
    }
    [[nodiscard]] FwWorld* world() const { return world_; }
    [[nodiscard]] FwView& view() { return views_[0]; }
    [[nodiscard]] FwView& second() { return views_[1]; }
    uint32_t drawnViews = 1,
             givenViews = 1;  // of the two views: drawn one after the other; recorded for

    // A frame of `seconds`; costs in s by the clock and of all threads. False if it was not drawn.
    bool frame(FwTargetId target, float seconds, double& wall, double& cpu) {
        const auto start = Clock::now();
        const double before = cpuSeconds();
        VkCommandBufferBeginInfo begin{};
        begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
        vkBeginCommandBuffer(device_.commands, &begin);
        if (++index_ == 1) clear();
        FwVulkanFrame frame = fwDefaultVulkanFrame();
        frame.commandBuffer = device_.commands;
        frame.frameIndex = index_;
        frame.completedFrameIndex = index_ - 1;
        frame.deltaTime = seconds;
        const bool outside =
            fwWorld_RecordOutsideViews(world_, &frame, views_, givenViews) == FW_OK;
        frame.sampledColor = behind_.view;
        frame.sampledColorLayout = VK_IMAGE_LAYOUT_GENERAL;
        FwVulkanComposite images = fwDefaultVulkanComposite();
        images.flags = FW_COMPOSITE_KEEP;
        images.width = kPicture.width;
        images.height = kPicture.height;
        const auto describe = [](const BenchImage& image) {
            return FwVulkanImage{image.image,
                                 image.view,
                                 VK_IMAGE_LAYOUT_GENERAL,
                                 VK_IMAGE_LAYOUT_GENERAL,
                                 VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                                 VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                                 VK_ACCESS_MEMORY_WRITE_BIT,
                                 VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT};
        };
        images.color = describe(color_);
        images.depth = describe(depth_);
        bool drawn = true;
        for (uint32_t i = 0; i < drawnViews; ++i)
            drawn = fwWorld_RecordComposite(world_, &frame, target, &views_[i], &images) == FW_OK &&
                    drawn;
        vkEndCommandBuffer(device_.commands);
        VkSubmitInfo submit{};
        submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
        submit.commandBufferCount = 1;
        submit.pCommandBuffers = &device_.commands;
        vkQueueSubmit(device_.queue, 1, &submit, device_.fence);
        vkWaitForFences(device_.device, 1, &device_.fence, VK_TRUE, ~uint64_t{0});
        vkResetFences(device_.device, 1, &device_.fence);
        wall = secondsSince(start);
        cpu = cpuSeconds() - before;
        return outside && drawn;
    }

 private:
    BenchImage imageOf(VkFormat format, VkImageUsageFlags usage) {
        BenchImage out;
        VkImageCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
        info.imageType = VK_IMAGE_TYPE_2D;
        info.format = format;
        info.extent = kPicture;
        info.mipLevels = info.arrayLayers = 1;
        info.samples = VK_SAMPLE_COUNT_1_BIT;
        info.usage = usage;
        vkCreateImage(device_.device, &info, nullptr, &out.image);
        VkMemoryRequirements needs{};
        vkGetImageMemoryRequirements(device_.device, out.image, &needs);
        VkMemoryAllocateInfo allocate{};
        allocate.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
        allocate.allocationSize = needs.size;
        while (!(needs.memoryTypeBits >> allocate.memoryTypeIndex & 1u)) ++allocate.memoryTypeIndex;
        vkAllocateMemory(device_.device, &allocate, nullptr, &out.memory);
        vkBindImageMemory(device_.device, out.image, out.memory, 0);
        VkImageViewCreateInfo viewInfo{};
        viewInfo.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
        viewInfo.image = out.image;
        viewInfo.viewType = VK_IMAGE_VIEW_TYPE_2D;
        viewInfo.format = format;
        viewInfo.subresourceRange = rangeOf(format);
        vkCreateImageView(device_.device, &viewInfo, nullptr, &out.view);
        return out;
    }
    static VkImageSubresourceRange rangeOf(VkFormat format) {
        const bool depth = format == VK_FORMAT_D32_SFLOAT;
        return {VkImageAspectFlags(depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT),
                0, 1, 0, 1};
    }
    // A distant grey scene.
    void clear() {
        const VkImageSubresourceRange color = rangeOf(VK_FORMAT_R8G8B8A8_UNORM);
        const VkImageSubresourceRange depth = rangeOf(VK_FORMAT_D32_SFLOAT);
        VkImageMemoryBarrier barriers[3]{};
        const VkImage all[3] = {color_.image, behind_.image, depth_.image};
        for (int i = 0; i < 3; ++i) {
            barriers[i].sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
            barriers[i].dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
            barriers[i].newLayout = VK_IMAGE_LAYOUT_GENERAL;
            barriers[i].srcQueueFamilyIndex = barriers[i].dstQueueFamilyIndex =
                VK_QUEUE_FAMILY_IGNORED;
            barriers[i].image = all[i];
            barriers[i].subresourceRange = i == 2 ? depth : color;
        }
        vkCmdPipelineBarrier(device_.commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT,
                             VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0, nullptr, 3,
                             barriers);
        const VkClearColorValue grey{{0.4f, 0.4f, 0.4f, 1.0f}};
        const VkClearDepthStencilValue far{1.0f, 0};
        vkCmdClearColorImage(device_.commands, color_.image, VK_IMAGE_LAYOUT_GENERAL, &grey, 1,
                             &color);
        vkCmdClearColorImage(device_.commands, behind_.image, VK_IMAGE_LAYOUT_GENERAL, &grey, 1,
                             &color);
        vkCmdClearDepthStencilImage(device_.commands, depth_.image, VK_IMAGE_LAYOUT_GENERAL, &far,
                                    1, &depth);
        VkMemoryBarrier after{};
        after.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
        after.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
        after.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
        vkCmdPipelineBarrier(device_.commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                             VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1, &after, 0, nullptr, 0,
                             nullptr);
    }

    DeviceWithoutLayers& device_;
    BenchImage color_, behind_, depth_;
    FwContext* context_ = nullptr;
    FwWorld* world_ = nullptr;
    FwView views_[2] = {fwDefaultView(), fwDefaultView()};
    uint64_t index_ = 0;
};

}  // namespace fw::test
