// Shims between library and loader. One ends one storage buffer too early, to prove that an access
// past the end is noticed; the other limits the texels per buffer.
#include "support/vulkan_device.h"

#include <cstring>
#include <map>

namespace fw::test {
namespace {

// The layer compares with the buffer's size, not the descriptor's range. So shaders get another
// buffer over the same memory that is a word shorter.
struct Known {
    VkBufferCreateInfo info{};
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize offset = 0;
    VkBuffer shorter = VK_NULL_HANDLE;
};
std::mutex mutex;
std::map<VkBuffer, Known> buffers;
uint32_t shortBinding = kNoBinding;
constexpr VkDeviceSize kMissing = 4;  // bytes

VKAPI_ATTR VkResult VKAPI_CALL createBuffer(VkDevice device, const VkBufferCreateInfo* info,
                                            const VkAllocationCallbacks* callbacks,
                                            VkBuffer* buffer) {
    const VkResult result = vkCreateBuffer(device, info, callbacks, buffer);
    const std::lock_guard lock(mutex);
    if (result == VK_SUCCESS) buffers[*buffer] = {*info};
    return result;
}

VKAPI_ATTR VkResult VKAPI_CALL bindBufferMemory(VkDevice device, VkBuffer buffer,
                                                VkDeviceMemory memory, VkDeviceSize offset) {
    const std::lock_guard lock(mutex);
    buffers[buffer].memory = memory;
    buffers[buffer].offset = offset;
    return vkBindBufferMemory(device, buffer, memory, offset);
}

VKAPI_ATTR void VKAPI_CALL destroyBuffer(VkDevice device, VkBuffer buffer,
                                         const VkAllocationCallbacks* callbacks) {
    const std::lock_guard lock(mutex);
    vkDestroyBuffer(device, buffers[buffer].shorter, nullptr);
    buffers.erase(buffer);
    vkDestroyBuffer(device, buffer, callbacks);
}

VkBuffer shorterOf(VkDevice device, VkBuffer buffer) {
    Known& known = buffers[buffer];
    if (known.shorter) return known.shorter;
    VkBufferCreateInfo info = known.info;
    info.size -= kMissing;
    VkMemoryRequirements needs{};
    EXPECT_EQ(vkCreateBuffer(device, &info, nullptr, &known.shorter), VK_SUCCESS);
    vkGetBufferMemoryRequirements(device, known.shorter, &needs);
    EXPECT_EQ(vkBindBufferMemory(device, known.shorter, known.memory, known.offset), VK_SUCCESS);
    return known.shorter;
}

VKAPI_ATTR void VKAPI_CALL updateDescriptorSets(VkDevice device, uint32_t writeCount,
                                                const VkWriteDescriptorSet* writes,
                                                uint32_t copyCount,
                                                const VkCopyDescriptorSet* copies) {
    std::vector<VkWriteDescriptorSet> changed(writes, writes + writeCount);
    std::vector<VkDescriptorBufferInfo> infos(writeCount);
    const std::lock_guard lock(mutex);
    for (uint32_t i = 0; i < writeCount; ++i) {
        VkWriteDescriptorSet& write = changed[i];
        if (write.descriptorType != VK_DESCRIPTOR_TYPE_STORAGE_BUFFER ||
            write.dstBinding != shortBinding || buffers[write.pBufferInfo->buffer].info.size <= 4)
            continue;
        infos[i] = *write.pBufferInfo;
        infos[i].buffer = shorterOf(device, infos[i].buffer);
        write.pBufferInfo = &infos[i];
    }
    vkUpdateDescriptorSets(device, writeCount, changed.data(), copyCount, copies);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL deviceEntry(VkDevice device, const char* name) {
    if (!std::strcmp(name, "vkCreateBuffer"))
        return reinterpret_cast<PFN_vkVoidFunction>(&createBuffer);
    if (!std::strcmp(name, "vkBindBufferMemory"))
        return reinterpret_cast<PFN_vkVoidFunction>(&bindBufferMemory);
    if (!std::strcmp(name, "vkDestroyBuffer"))
        return reinterpret_cast<PFN_vkVoidFunction>(&destroyBuffer);
    if (!std::strcmp(name, "vkUpdateDescriptorSets"))
        return reinterpret_cast<PFN_vkVoidFunction>(&updateDescriptorSets);
    return vkGetDeviceProcAddr(device, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instanceEntry(VkInstance instance, const char* name) {
    if (!std::strcmp(name, "vkGetDeviceProcAddr"))
        return reinterpret_cast<PFN_vkVoidFunction>(&deviceEntry);
    return vkGetInstanceProcAddr(instance, name);
}

VKAPI_ATTR void VKAPI_CALL fewTexels(VkPhysicalDevice device, VkPhysicalDeviceProperties* out) {
    vkGetPhysicalDeviceProperties(device, out);
    out->limits.maxTexelBufferElements = 65536;  // the least that Vulkan allows
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL fewTexelsEntryOf(VkInstance instance, const char* name) {
    if (!std::strcmp(name, "vkGetPhysicalDeviceProperties"))
        return reinterpret_cast<PFN_vkVoidFunction>(&fewTexels);
    return vkGetInstanceProcAddr(instance, name);
}

}  // namespace

PFN_vkGetInstanceProcAddr fewTexelsEntry() { return &fewTexelsEntryOf; }

PFN_vkGetInstanceProcAddr shorteningEntry(uint32_t binding) {
    const std::lock_guard lock(mutex);
    buffers.clear();
    shortBinding = binding;
    return &instanceEntry;
}

}  // namespace fw::test
