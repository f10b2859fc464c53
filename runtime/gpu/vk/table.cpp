#include "gpu/vk/table.h"

#include "core/error.h"

#include <utility>

namespace fw::gpu::vk {

void Table::loadInstance(PFN_vkGetInstanceProcAddr get, VkInstance instance) {
    GetInstanceProcAddr = get;
#define FW_VK_LOAD(entry)                                                \
    entry = reinterpret_cast<PFN_vk##entry>(get(instance, "vk" #entry)); \
    if (!entry)                                                          \
        core::fail(FW_ERROR_UNSUPPORTED_DEVICE,                          \
                   "getInstanceProcAddr of the Vulkan host knows no vk" #entry ".");
    FW_VK_INSTANCE_ENTRIES(FW_VK_LOAD)
#undef FW_VK_LOAD
}

void Table::loadDevice(VkInstance instance, VkDevice device, bool debugUtils) {
#define FW_VK_LOAD(entry)                                                            \
    entry = reinterpret_cast<PFN_vk##entry>(GetDeviceProcAddr(device, "vk" #entry)); \
    if (!entry)                                                                      \
        core::fail(FW_ERROR_UNSUPPORTED_DEVICE,                                      \
                   "vkGetDeviceProcAddr of the Vulkan host knows no vk" #entry ".");
    FW_VK_DEVICE_ENTRIES(FW_VK_LOAD)
#undef FW_VK_LOAD
    if (!debugUtils) return;
        // An instance extension: some layers answer for it at instance level only.
#define FW_VK_LOAD(entry)                                                            \
    entry = reinterpret_cast<PFN_vk##entry>(GetDeviceProcAddr(device, "vk" #entry)); \
    if (!entry)                                                                      \
        entry = reinterpret_cast<PFN_vk##entry>(GetInstanceProcAddr(instance,        \
                                                                    "v"              \
                                                                    "k" #entry));
    FW_VK_DEBUG_ENTRIES(FW_VK_LOAD)
#undef FW_VK_LOAD
}

const char* resultName(VkResult result) noexcept {
#define FW_VK_NAME(name) \
    { name, #name }
    static constexpr std::pair<VkResult, const char*> kNames[] = {
        FW_VK_NAME(VK_SUCCESS),
        FW_VK_NAME(VK_NOT_READY),
        FW_VK_NAME(VK_TIMEOUT),
        FW_VK_NAME(VK_INCOMPLETE),
        FW_VK_NAME(VK_ERROR_OUT_OF_HOST_MEMORY),
        FW_VK_NAME(VK_ERROR_OUT_OF_DEVICE_MEMORY),
        FW_VK_NAME(VK_ERROR_INITIALIZATION_FAILED),
        FW_VK_NAME(VK_ERROR_DEVICE_LOST),
        FW_VK_NAME(VK_ERROR_MEMORY_MAP_FAILED),
        FW_VK_NAME(VK_ERROR_LAYER_NOT_PRESENT),
        FW_VK_NAME(VK_ERROR_EXTENSION_NOT_PRESENT),
        FW_VK_NAME(VK_ERROR_FEATURE_NOT_PRESENT),
        FW_VK_NAME(VK_ERROR_INCOMPATIBLE_DRIVER),
        FW_VK_NAME(VK_ERROR_TOO_MANY_OBJECTS),
        FW_VK_NAME(VK_ERROR_FORMAT_NOT_SUPPORTED),
    };
#undef FW_VK_NAME
    for (const auto& [code, name] : kNames)
        if (code == result) return name;
    return "an unnamed VkResult";
}

void check(VkResult result, const char* what) {
    if (result == VK_SUCCESS) return;
    FwResult code = FW_ERROR_INTERNAL;
    if (result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY ||
        result == VK_ERROR_TOO_MANY_OBJECTS)
        code = FW_ERROR_OUT_OF_MEMORY;
    if (result == VK_ERROR_DEVICE_LOST) code = FW_ERROR_DEVICE_LOST;
    core::fail(code, "%s fails with %s (%d).", what, resultName(result), int(result));
}

}  // namespace fw::gpu::vk
