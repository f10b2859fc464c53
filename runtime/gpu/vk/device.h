// The device, the host's or our own: its handles, limits and declared features. Not its memory.
#pragma once
#include "core/log.h"
#include "flamewright/flamewright_vulkan.h"
#include "gpu/vk/table.h"

#include <atomic>
#include <memory_resource>
#include <mutex>
#include <type_traits>

namespace fw::gpu::vk {

class Device {
 public:
    // Checks the device of `host`, or makes one if `host` is null. Throws core::Error.
    Device(const FwVulkanHost* host, const core::Log& log);
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    Table table;
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
    VkDevice handle = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;  // own device only
    uint32_t queueFamily = 0;
    uint32_t apiVersion = VK_API_VERSION_1_0;
    bool own = false;
    bool debugUtils = false;  // labels and names
    bool timestamps = false;
    bool independentBlend = false;  // declared
    bool texels = false;            // buffers of any size may be read by texels
    VkPhysicalDeviceProperties properties{};
    VkPhysicalDeviceMemoryProperties memoryProperties{};
    VkPipelineCache pipelineCache = VK_NULL_HANDLE;              // the host's
    const VkAllocationCallbacks* allocationCallbacks = nullptr;  // the host's

    [[nodiscard]] bool lost() const noexcept { return lost_.load(std::memory_order_acquire); }
    void notifyLost() noexcept;
    // As vk::check, and latches a lost device.
    void check(VkResult result, const char* what);
    // Throws FW_ERROR_DEVICE_LOST once the loss is known.
    void failIfLost() const;
    // A new object: `create(table.CreateFence, info, "vkCreateFence")`. Throws as check does.
    template <class Info, class Handle>
    Handle create(VkResult(VKAPI_PTR* creates)(VkDevice, const Info*, const VkAllocationCallbacks*,
                                               Handle*),
                  const std::type_identity_t<Info>& info, const char* what) {
        Handle made{};
        check(creates(handle, &info, allocationCallbacks, &made), what);
        return made;
    }
    // Destroys `object`, which may be null, and sets it to null.
    template <class Handle>
    void destroy(void(VKAPI_PTR* drop)(VkDevice, Handle, const VkAllocationCallbacks*),
                 Handle& object) const noexcept {
        drop(handle, object, allocationCallbacks);
        object = Handle{};
    }
    void name(VkObjectType type, uint64_t object, const char* text) const noexcept;

 private:
    void adoptHost(const FwVulkanHost& host);
    void make();
    void checkDevice();
    void close() noexcept;

    const core::Log& log_;
    std::atomic<bool> lost_{false};
};

}  // namespace fw::gpu::vk
