// The parts of a Context that are tables: encodings of formats, and its description for hosts.
#include "gpu/vk/vk_backend.h"

#include <algorithm>
#include <cstring>

namespace fw::gpu::vk {

FwOutputEncoding Context::encodingOf(VkFormat color) noexcept {
    static constexpr VkFormat kLinear[] = {VK_FORMAT_R16_SFLOAT,
                                           VK_FORMAT_R16G16_SFLOAT,
                                           VK_FORMAT_R16G16B16_SFLOAT,
                                           VK_FORMAT_R16G16B16A16_SFLOAT,
                                           VK_FORMAT_R32_SFLOAT,
                                           VK_FORMAT_R32G32_SFLOAT,
                                           VK_FORMAT_R32G32B32_SFLOAT,
                                           VK_FORMAT_R32G32B32A32_SFLOAT,
                                           VK_FORMAT_B10G11R11_UFLOAT_PACK32};
    static constexpr VkFormat kSrgb[] = {VK_FORMAT_R8_SRGB,
                                         VK_FORMAT_R8G8_SRGB,
                                         VK_FORMAT_R8G8B8_SRGB,
                                         VK_FORMAT_B8G8R8_SRGB,
                                         VK_FORMAT_R8G8B8A8_SRGB,
                                         VK_FORMAT_B8G8R8A8_SRGB,
                                         VK_FORMAT_A8B8G8R8_SRGB_PACK32};
    static constexpr VkFormat kDisplay[] = {VK_FORMAT_R4G4_UNORM_PACK8,
                                            VK_FORMAT_R4G4B4A4_UNORM_PACK16,
                                            VK_FORMAT_B4G4R4A4_UNORM_PACK16,
                                            VK_FORMAT_R5G6B5_UNORM_PACK16,
                                            VK_FORMAT_B5G6R5_UNORM_PACK16,
                                            VK_FORMAT_R5G5B5A1_UNORM_PACK16,
                                            VK_FORMAT_B5G5R5A1_UNORM_PACK16,
                                            VK_FORMAT_A1R5G5B5_UNORM_PACK16,
                                            VK_FORMAT_R8_UNORM,
                                            VK_FORMAT_R8G8_UNORM,
                                            VK_FORMAT_R8G8B8_UNORM,
                                            VK_FORMAT_B8G8R8_UNORM,
                                            VK_FORMAT_R8G8B8A8_UNORM,
                                            VK_FORMAT_B8G8R8A8_UNORM,
                                            VK_FORMAT_A8B8G8R8_UNORM_PACK32,
                                            VK_FORMAT_A2R10G10B10_UNORM_PACK32,
                                            VK_FORMAT_A2B10G10R10_UNORM_PACK32,
                                            VK_FORMAT_R16_UNORM,
                                            VK_FORMAT_R16G16_UNORM,
                                            VK_FORMAT_R16G16B16_UNORM,
                                            VK_FORMAT_R16G16B16A16_UNORM};
    const auto isOf = [&](std::span<const VkFormat> formats) {
        return std::find(formats.begin(), formats.end(), color) != formats.end();
    };
    return isOf(kLinear)    ? FW_OUTPUT_LINEAR
           : isOf(kSrgb)    ? FW_OUTPUT_SRGB_VIEW
           : isOf(kDisplay) ? FW_OUTPUT_DISPLAY_UNORM
                            : FW_OUTPUT_AUTO;
}

void Context::fillInfo(FwContextInfo& info) const noexcept {
    info.apiVersion = device.apiVersion;
    info.ownDevice = device.own ? 1 : 0;
    info.gpuTimers = device.timestamps ? 1 : 0;
    info.debugLabels = device.debugUtils ? 1 : 0;
    info.gpuMemoryUsed = deviceMemory.used();
    info.gpuMemoryBudget = deviceMemory.budget();
    std::strncpy(info.deviceName, device.properties.deviceName, sizeof info.deviceName - 1);
    info.deviceName[sizeof info.deviceName - 1] = 0;
}

void Context::requirements(FwVulkanRequirements& requirements) noexcept {
    static constexpr const char* kInstanceExtensions[] = {"VK_EXT_debug_utils"};
    requirements.minimumApiVersion = VK_API_VERSION_1_0;
    requirements.extensionCount = 0;
    requirements.extensions = nullptr;
    requirements.instanceExtensionCount = 1;
    requirements.instanceExtensions = kInstanceExtensions;
    requirements.features = {};
    requirements.features.independentBlend = VK_TRUE;
    requirements.queueFlags = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
}

}  // namespace fw::gpu::vk
