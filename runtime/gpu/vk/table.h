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

#define FW_VK_STRUCTURES(X) \
    X(ApplicationInfo, APPLICATION_INFO) X(BufferCreateInfo, BUFFER_CREATE_INFO) \
    X(BufferMemoryBarrier, BUFFER_MEMORY_BARRIER) X(BufferViewCreateInfo, BUFFER_VIEW_CREATE_INFO) \
    X(CommandBufferAllocateInfo, COMMAND_BUFFER_ALLOCATE_INFO) \
    X(CommandBufferBeginInfo, COMMAND_BUFFER_BEGIN_INFO) \
    X(CommandPoolCreateInfo, COMMAND_POOL_CREATE_INFO) \
    X(ComputePipelineCreateInfo, COMPUTE_PIPELINE_CREATE_INFO) \
    X(DebugUtilsLabelEXT, DEBUG_UTILS_LABEL_EXT) \
    X(DebugUtilsObjectNameInfoEXT, DEBUG_UTILS_OBJECT_NAME_INFO_EXT) \
    X(DescriptorPoolCreateInfo, DESCRIPTOR_POOL_CREATE_INFO) \
    X(DescriptorSetAllocateInfo, DESCRIPTOR_SET_ALLOCATE_INFO) \
    X(DescriptorSetLayoutCreateInfo, DESCRIPTOR_SET_LAYOUT_CREATE_INFO) \
    X(DeviceCreateInfo, DEVICE_CREATE_INFO) X(DeviceQueueCreateInfo, DEVICE_QUEUE_CREATE_INFO) \
    X(FenceCreateInfo, FENCE_CREATE_INFO) X(FramebufferCreateInfo, FRAMEBUFFER_CREATE_INFO) \
    X(GraphicsPipelineCreateInfo, GRAPHICS_PIPELINE_CREATE_INFO) \
    X(ImageCreateInfo, IMAGE_CREATE_INFO) X(ImageMemoryBarrier, IMAGE_MEMORY_BARRIER) \
    X(ImageViewCreateInfo, IMAGE_VIEW_CREATE_INFO) X(InstanceCreateInfo, INSTANCE_CREATE_INFO) \
    X(MemoryAllocateInfo, MEMORY_ALLOCATE_INFO) X(MemoryBarrier, MEMORY_BARRIER) \
    X(PipelineColorBlendStateCreateInfo, PIPELINE_COLOR_BLEND_STATE_CREATE_INFO) \
    X(PipelineDepthStencilStateCreateInfo, PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO) \
    X(PipelineDynamicStateCreateInfo, PIPELINE_DYNAMIC_STATE_CREATE_INFO) \
    X(PipelineInputAssemblyStateCreateInfo, PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO) \
    X(PipelineLayoutCreateInfo, PIPELINE_LAYOUT_CREATE_INFO) \
    X(PipelineMultisampleStateCreateInfo, PIPELINE_MULTISAMPLE_STATE_CREATE_INFO) \
    X(PipelineRasterizationStateCreateInfo, PIPELINE_RASTERIZATION_STATE_CREATE_INFO) \
    X(PipelineVertexInputStateCreateInfo, PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO) \
    X(PipelineViewportStateCreateInfo, PIPELINE_VIEWPORT_STATE_CREATE_INFO) \
    X(QueryPoolCreateInfo, QUERY_POOL_CREATE_INFO) X(RenderPassBeginInfo, RENDER_PASS_BEGIN_INFO) \
    X(RenderPassCreateInfo, RENDER_PASS_CREATE_INFO) X(SamplerCreateInfo, SAMPLER_CREATE_INFO) \
    X(ShaderModuleCreateInfo, SHADER_MODULE_CREATE_INFO) X(SubmitInfo, SUBMIT_INFO) \
    X(WriteDescriptorSet, WRITE_DESCRIPTOR_SET)
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

// A Vulkan structure that is empty but for its sType.
template <class T>
inline constexpr VkStructureType kTypeOf = VK_STRUCTURE_TYPE_MAX_ENUM;
#define FW_VK_TYPE_OF(name, type) \
    template <>                   \
    inline constexpr VkStructureType kTypeOf<Vk##name> = VK_STRUCTURE_TYPE_##type;
FW_VK_STRUCTURES(FW_VK_TYPE_OF)
#undef FW_VK_TYPE_OF
template <class T>
struct Typed : T {
    Typed() noexcept : T{} {
        static_assert(kTypeOf<T> != VK_STRUCTURE_TYPE_MAX_ENUM, "a row of FW_VK_STRUCTURES");
        this->sType = kTypeOf<T>;
    }
};

const char* resultName(VkResult result) noexcept;
// VK_SUCCESS or a thrown core::Error: out of memory, device lost, or internal with `what`.
void check(VkResult result, const char* what);

}  // namespace fw::gpu::vk
