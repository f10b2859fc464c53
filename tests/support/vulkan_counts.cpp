// Counts the entry points that a steady frame may not call and forwards all others.
#include "support/vulkan_device.h"

#include <atomic>
#include <cstring>

namespace fw::test {
namespace {

std::atomic<uint64_t> submits, waits, memory, maps, pipelines, descriptorPools, objects, work,
    barriers, draws, passes;

// Each wrapper counts and calls the loader's function of that name.
#define FW_COUNTED(entry, counter)                                  \
    struct Counted##entry {                                         \
        template <class Result, class... Arguments>                 \
        static PFN_vk##entry of(Result(VKAPI_PTR*)(Arguments...)) { \
            return [](Arguments... arguments) -> Result {           \
                counter.fetch_add(1, std::memory_order_relaxed);    \
                return vk##entry(arguments...);                     \
            };                                                      \
        }                                                           \
    };
// clang-format off
#define FW_ALL_COUNTED(X)                                                             \
    X(QueueSubmit, submits) X(QueueWaitIdle, waits) X(DeviceWaitIdle, waits)          \
    X(WaitForFences, waits) X(AllocateMemory, memory) X(MapMemory, maps)              \
    X(CreateComputePipelines, pipelines) X(CreateGraphicsPipelines, pipelines)        \
    X(CreateDescriptorPool, descriptorPools) X(AllocateDescriptorSets, descriptorPools) \
    X(CreateBuffer, objects) X(CreateImage, objects) X(CreateImageView, objects)      \
    X(CreateBufferView, objects)                                                      \
    X(CreatePipelineLayout, objects) X(CreateDescriptorSetLayout, objects)            \
    X(CreateShaderModule, objects) X(CreateRenderPass, objects)                       \
    X(CreateFramebuffer, objects) X(CreateQueryPool, objects)                         \
    X(CreateSampler, objects) X(CreateFence, objects) X(CreateCommandPool, objects)   \
    X(CmdDispatch, work) X(CmdDispatchIndirect, work) X(CmdCopyBuffer, work)          \
    X(CmdFillBuffer, work) X(CmdCopyBufferToImage, work) X(CmdResetQueryPool, work)   \
    X(CmdPipelineBarrier, barriers) X(CmdDraw, draws) X(CmdDrawIndexed, draws)        \
    X(CmdDrawIndirect, draws) X(CmdBeginRenderPass, passes)
// clang-format on
FW_ALL_COUNTED(FW_COUNTED)

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL deviceEntry(VkDevice device, const char* name) {
#define FW_MATCH(entry, counter)         \
    if (!std::strcmp(name, "vk" #entry)) \
        return reinterpret_cast<PFN_vkVoidFunction>(Counted##entry::of(&vk##entry));
    FW_ALL_COUNTED(FW_MATCH)
    return vkGetDeviceProcAddr(device, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instanceEntry(VkInstance instance, const char* name) {
    if (!std::strcmp(name, "vkGetDeviceProcAddr"))
        return reinterpret_cast<PFN_vkVoidFunction>(&deviceEntry);
    return vkGetInstanceProcAddr(instance, name);
}

}  // namespace

PFN_vkGetInstanceProcAddr countingEntry() { return &instanceEntry; }

VulkanCounts takeCounts() {
    VulkanCounts counts;
    counts.submits = submits.exchange(0);
    counts.waits = waits.exchange(0);
    counts.memory = memory.exchange(0);
    counts.maps = maps.exchange(0);
    counts.pipelines = pipelines.exchange(0);
    counts.descriptorPools = descriptorPools.exchange(0);
    counts.objects = objects.exchange(0);
    counts.work = work.exchange(0);
    counts.barriers = barriers.exchange(0);
    counts.draws = draws.exchange(0);
    counts.passes = passes.exchange(0);
    return counts;
}

}  // namespace fw::test
