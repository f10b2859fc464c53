// The Vulkan entry points of one device, loaded through the host's vkGetInstanceProcAddr. Nothing
// links the loader. Optional entries are null unless their extension was declared.
#pragma once
#ifndef VK_NO_PROTOTYPES
#define VK_NO_PROTOTYPES
#endif
#include <vulkan/vulkan_core.h>

namespace fw::gpu::vk {

// clang-format off
#define FW_VK_INSTANCE_ENTRIES(X) \
    X(GetDeviceProcAddr) X(GetPhysicalDeviceProperties) X(GetPhysicalDeviceMemoryProperties) \
    X(GetPhysicalDeviceQueueFamilyProperties) X(GetPhysicalDeviceFormatProperties) \
    X(EnumeratePhysicalDevices) X(CreateDevice) X(DestroyInstance)

#define FW_VK_DEVICE_ENTRIES(X) \
    X(DestroyDevice) X(GetDeviceQueue) X(QueueSubmit) X(QueueWaitIdle) X(DeviceWaitIdle) \
    X(AllocateMemory) X(FreeMemory) X(MapMemory) X(UnmapMemory) \
    X(CreateBuffer) X(DestroyBuffer) X(GetBufferMemoryRequirements) X(BindBufferMemory) \
    X(CreateBufferView) X(DestroyBufferView) \
    X(CreateImage) X(DestroyImage) X(GetImageMemoryRequirements) X(BindImageMemory) \
    X(CreateImageView) X(DestroyImageView) X(CreateSampler) X(DestroySampler) \
    X(CreateShaderModule) X(DestroyShaderModule) \
    X(CreateDescriptorSetLayout) X(DestroyDescriptorSetLayout) \
    X(CreatePipelineLayout) X(DestroyPipelineLayout) \
    X(CreateComputePipelines) X(CreateGraphicsPipelines) X(DestroyPipeline) \
    X(CreateDescriptorPool) X(DestroyDescriptorPool) X(AllocateDescriptorSets) \
    X(UpdateDescriptorSets) X(CreateRenderPass) X(DestroyRenderPass) \
    X(CreateFramebuffer) X(DestroyFramebuffer) X(CreateQueryPool) X(DestroyQueryPool) \
    X(GetQueryPoolResults) X(CreateCommandPool) X(DestroyCommandPool) X(AllocateCommandBuffers) \
    X(BeginCommandBuffer) X(EndCommandBuffer) X(CreateFence) X(DestroyFence) X(WaitForFences) \
    X(ResetFences) X(ResetCommandPool) \
    X(CmdPipelineBarrier) X(CmdBindPipeline) X(CmdBindDescriptorSets) X(CmdPushConstants) \
    X(CmdDispatch) X(CmdDispatchIndirect) X(CmdCopyBuffer) X(CmdCopyBufferToImage) \
    X(CmdCopyImageToBuffer) X(CmdFillBuffer) X(CmdBindVertexBuffers) X(CmdBindIndexBuffer) \
    X(CmdDrawIndexed) X(CmdDraw) X(CmdDrawIndirect) X(CmdDrawIndexedIndirect) X(CmdSetViewport) X(CmdSetScissor) X(CmdSetBlendConstants) \
    X(CmdBeginRenderPass) X(CmdEndRenderPass) X(CmdResetQueryPool) X(CmdWriteTimestamp)

// Of VK_EXT_debug_utils.
#define FW_VK_DEBUG_ENTRIES(X) \
    X(CmdBeginDebugUtilsLabelEXT) X(CmdEndDebugUtilsLabelEXT) X(SetDebugUtilsObjectNameEXT)
// clang-format on

struct Table {
    PFN_vkGetInstanceProcAddr GetInstanceProcAddr = nullptr;
#define FW_VK_MEMBER(name) PFN_vk##name name = nullptr;
    FW_VK_INSTANCE_ENTRIES(FW_VK_MEMBER)
    FW_VK_DEVICE_ENTRIES(FW_VK_MEMBER)
    FW_VK_DEBUG_ENTRIES(FW_VK_MEMBER)
#undef FW_VK_MEMBER

    // Throw core::Error naming the first entry that is missing.
    void loadInstance(PFN_vkGetInstanceProcAddr get, VkInstance instance);
    void loadDevice(VkInstance instance, VkDevice device, bool debugUtils);
};

// An empty Vulkan structure of its type.
template <class T>
T typed(VkStructureType type) noexcept {
    T value{};
    value.sType = type;
    return value;
}

const char* resultName(VkResult result) noexcept;
// VK_SUCCESS or a thrown core::Error: out of memory, device lost, or internal with `what`.
void check(VkResult result, const char* what);

}  // namespace fw::gpu::vk
