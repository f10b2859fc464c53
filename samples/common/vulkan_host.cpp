// See vulkan_host.h.
#include "common/vulkan_host.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace sample {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                         VkDebugUtilsMessageTypeFlagsEXT type,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data,
                                         void* userData) {
    // GENERAL messages come from the loader about other drivers, so they are ignored.
    const bool general = type == VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT;
    if (general && severity < VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT) return VK_FALSE;
    auto* log = static_cast<ValidationLog*>(userData);
    std::lock_guard lock(log->mutex);
    if (log->count++ < 32) {
        log->messages.emplace_back(data->pMessage);
        std::fprintf(stderr, "\nvalidation: %s\n", data->pMessage);
    }
    return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messengerInfo(ValidationLog* log) {
    VkDebugUtilsMessengerCreateInfoEXT info{};
    info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                           VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT |
                       VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
                       VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    info.pfnUserCallback = onMessage;
    info.pUserData = log;
    return info;
}

bool contains(const std::vector<const char*>& names, const char* name) {
    return std::any_of(names.begin(), names.end(),
                       [&](const char* other) { return std::strcmp(name, other) == 0; });
}

void addOnce(std::vector<const char*>& names, const char* name) {
    if (!contains(names, name)) names.push_back(name);
}

}  // namespace

const char* vulkanResultName(VkResult result) {
    switch (result) {
        case VK_SUCCESS:
            return "VK_SUCCESS";
        case VK_NOT_READY:
            return "VK_NOT_READY";
        case VK_TIMEOUT:
            return "VK_TIMEOUT";
        case VK_INCOMPLETE:
            return "VK_INCOMPLETE";
        case VK_SUBOPTIMAL_KHR:
            return "VK_SUBOPTIMAL_KHR";
        case VK_ERROR_OUT_OF_HOST_MEMORY:
            return "VK_ERROR_OUT_OF_HOST_MEMORY";
        case VK_ERROR_OUT_OF_DEVICE_MEMORY:
            return "VK_ERROR_OUT_OF_DEVICE_MEMORY";
        case VK_ERROR_INITIALIZATION_FAILED:
            return "VK_ERROR_INITIALIZATION_FAILED";
        case VK_ERROR_DEVICE_LOST:
            return "VK_ERROR_DEVICE_LOST";
        case VK_ERROR_LAYER_NOT_PRESENT:
            return "VK_ERROR_LAYER_NOT_PRESENT";
        case VK_ERROR_EXTENSION_NOT_PRESENT:
            return "VK_ERROR_EXTENSION_NOT_PRESENT";
        case VK_ERROR_FEATURE_NOT_PRESENT:
            return "VK_ERROR_FEATURE_NOT_PRESENT";
        case VK_ERROR_INCOMPATIBLE_DRIVER:
            return "VK_ERROR_INCOMPATIBLE_DRIVER";
        case VK_ERROR_FORMAT_NOT_SUPPORTED:
            return "VK_ERROR_FORMAT_NOT_SUPPORTED";
        case VK_ERROR_SURFACE_LOST_KHR:
            return "VK_ERROR_SURFACE_LOST_KHR";
        case VK_ERROR_OUT_OF_DATE_KHR:
            return "VK_ERROR_OUT_OF_DATE_KHR";
        default:
            return "an unknown code";
    }
}

void checkVulkan(VkResult result, const char* what) {
    if (result == VK_SUCCESS) return;
    throw Failure(std::string(what) + " failed: " + vulkanResultName(result) + " (" +
                  std::to_string(static_cast<int>(result)) + ")");
}

int ValidationLog::exitCode() {
    std::lock_guard lock(mutex);
    if (count == 0) return 0;
    std::fprintf(stderr, "\n%u validation messages; expected none\n", count);
    return 1;
}

HostRequest hostRequest(const Options& options, ValidationLog& log) {
    HostRequest request;
    request.windowed = !options.headless;
    if (options.validate) request.validation = &log;
    return request;
}

VulkanHost::VulkanHost(const HostRequest& request) : made(request) {
    try {
        createInstance();
        chooseDevice();
        createDevice();
    } catch (...) {
        release();
        throw;
    }
}

VulkanHost::~VulkanHost() { release(); }

void VulkanHost::release() {
    if (device) {
        vkDeviceWaitIdle(device);
        vkDestroyCommandPool(device, setupPool_, nullptr);
        vkDestroyDevice(device, nullptr);
        device = VK_NULL_HANDLE;
    }
    if (messenger_) {
        auto destroyMessenger = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT"));
        destroyMessenger(instance, messenger_, nullptr);
        messenger_ = VK_NULL_HANDLE;
    }
    if (instance) vkDestroyInstance(instance, nullptr);
    instance = VK_NULL_HANDLE;
}

void VulkanHost::createInstance() {
    if (made.windowed) {
        if (!glfwInit()) throw Failure("GLFW cannot start; without a display use --headless");
        uint32_t count = 0;
        const char** names = glfwGetRequiredInstanceExtensions(&count);
        if (!names) throw Failure("this display has no Vulkan surface; use --headless");
        for (uint32_t i = 0; i < count; ++i) addOnce(made.instanceExtensions, names[i]);
        addOnce(made.deviceExtensions, VK_KHR_SWAPCHAIN_EXTENSION_NAME);
    }
    std::vector<const char*> layers;
    if (made.validation) {
        uint32_t count = 0;
        vkEnumerateInstanceLayerProperties(&count, nullptr);
        std::vector<VkLayerProperties> present(count);
        vkEnumerateInstanceLayerProperties(&count, present.data());
        const bool found = std::any_of(present.begin(), present.end(), [](const auto& layer) {
            return std::strcmp(layer.layerName, kValidationLayer) == 0;
        });
        if (!found) {
            throw Failure(std::string("validation is requested, but the layer ") +
                          kValidationLayer + " is not installed");
        }
        layers.push_back(kValidationLayer);
        addOnce(made.instanceExtensions, VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    }

    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.pApplicationName = "flamewright sample";
    application.apiVersion = made.apiVersion;
    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pApplicationInfo = &application;
    info.enabledLayerCount = static_cast<uint32_t>(layers.size());
    info.ppEnabledLayerNames = layers.data();

    const VkValidationFeatureEnableEXT enables[] = {
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    VkValidationFeaturesEXT features{};
    features.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = enables;
    VkDebugUtilsMessengerCreateInfoEXT messenger = messengerInfo(made.validation);
    std::vector<const char*> extensions = made.instanceExtensions;
    if (made.validation) {
        // The layer provides this extension for itself; the plugin does not use it, so it is not
        // reported.
        addOnce(extensions, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
        messenger.pNext = &features;
        info.pNext = &messenger;
    }
    info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    checkVulkan(vkCreateInstance(&info, nullptr, &instance), "vkCreateInstance");

    if (made.validation) {
        messenger.pNext = nullptr;
        auto createMessenger = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance, "vkCreateDebugUtilsMessengerEXT"));
        checkVulkan(createMessenger(instance, &messenger, nullptr, &messenger_),
                    "vkCreateDebugUtilsMessengerEXT");
    }
}

void VulkanHost::chooseDevice() {
    uint32_t count = 0;
    checkVulkan(vkEnumeratePhysicalDevices(instance, &count, nullptr),
                "vkEnumeratePhysicalDevices");
    std::vector<VkPhysicalDevice> devices(count);
    vkEnumeratePhysicalDevices(instance, &count, devices.data());
    // FLAMEWRIGHT_DEVICE selects by part of the name. Otherwise the fastest type wins.
    const char* wanted = std::getenv("FLAMEWRIGHT_DEVICE");
    int best = -1;
    for (VkPhysicalDevice candidate : devices) {
        VkPhysicalDeviceProperties found{};
        vkGetPhysicalDeviceProperties(candidate, &found);
        if (wanted && *wanted && !std::strstr(found.deviceName, wanted)) continue;
        int score = found.deviceType == VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU     ? 3
                    : found.deviceType == VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU ? 2
                    : found.deviceType == VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU    ? 1
                                                                                 : 0;
        if (score <= best) continue;
        uint32_t families = 0;
        vkGetPhysicalDeviceQueueFamilyProperties(candidate, &families, nullptr);
        std::vector<VkQueueFamilyProperties> family(families);
        vkGetPhysicalDeviceQueueFamilyProperties(candidate, &families, family.data());
        for (uint32_t i = 0; i < families; ++i) {
            constexpr VkQueueFlags kNeeded = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
            if ((family[i].queueFlags & kNeeded) != kNeeded) continue;
            if (made.windowed &&
                !glfwGetPhysicalDevicePresentationSupport(instance, candidate, i)) {
                continue;
            }
            best = score;
            physicalDevice = candidate;
            properties = found;
            queueFamily = i;
            break;
        }
    }
    if (!physicalDevice) {
        throw Failure("none of the " + std::to_string(count) + " Vulkan devices" +
                      (wanted && *wanted ? std::string(" named like \"") + wanted + "\"" : "") +
                      " has a queue for graphics and compute" +
                      (made.windowed ? " that can show in this window" : ""));
    }
}

void VulkanHost::createDevice() {
    const float priority = 1.0f;
    VkDeviceQueueCreateInfo queueInfo{};
    queueInfo.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queueInfo.queueFamilyIndex = queueFamily;
    queueInfo.queueCount = 1;
    queueInfo.pQueuePriorities = &priority;
    VkDeviceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.pNext = made.featureChain;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queueInfo;
    info.enabledExtensionCount = static_cast<uint32_t>(made.deviceExtensions.size());
    info.ppEnabledExtensionNames = made.deviceExtensions.data();
    info.pEnabledFeatures = made.featureChain ? nullptr : &made.features;
    checkVulkan(vkCreateDevice(physicalDevice, &info, nullptr, &device), "vkCreateDevice");
    vkGetDeviceQueue(device, queueFamily, 0, &queue);

    VkCommandPoolCreateInfo poolInfo{};
    poolInfo.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    poolInfo.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    poolInfo.queueFamilyIndex = queueFamily;
    checkVulkan(vkCreateCommandPool(device, &poolInfo, nullptr, &setupPool_),
                "vkCreateCommandPool");
}

uint32_t VulkanHost::memoryType(uint32_t allowedTypes, VkMemoryPropertyFlags wanted) const {
    VkPhysicalDeviceMemoryProperties memory{};
    vkGetPhysicalDeviceMemoryProperties(physicalDevice, &memory);
    for (uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
        const bool allowed = (allowedTypes >> i) & 1u;
        if (allowed && (memory.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
    }
    if (wanted == VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT) return memoryType(allowedTypes, 0);
    throw Failure("the device has no memory type with the flags " + std::to_string(wanted));
}

VkFormat VulkanHost::depthFormat() const {
    for (VkFormat format : {VK_FORMAT_D32_SFLOAT, VK_FORMAT_X8_D24_UNORM_PACK32,
                            VK_FORMAT_D24_UNORM_S8_UINT, VK_FORMAT_D16_UNORM}) {
        VkFormatProperties found{};
        vkGetPhysicalDeviceFormatProperties(physicalDevice, format, &found);
        if (found.optimalTilingFeatures & VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT) {
            return format;
        }
    }
    throw Failure("the device can render to no depth format");
}

Buffer VulkanHost::createBuffer(VkDeviceSize size, VkBufferUsageFlags usage,
                                bool hostVisible) const {
    Buffer result;
    result.size = std::max<VkDeviceSize>(size, 4);
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = result.size;
    info.usage = usage;
    checkVulkan(vkCreateBuffer(device, &info, nullptr, &result.buffer), "vkCreateBuffer");
    VkMemoryRequirements needs{};
    vkGetBufferMemoryRequirements(device, result.buffer, &needs);
    VkMemoryAllocateInfo allocation{};
    allocation.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    allocation.allocationSize = needs.size;
    allocation.memoryTypeIndex =
        memoryType(needs.memoryTypeBits, hostVisible ? VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                                           VK_MEMORY_PROPERTY_HOST_COHERENT_BIT
                                                     : VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    checkVulkan(vkAllocateMemory(device, &allocation, nullptr, &result.memory), "vkAllocateMemory");
    checkVulkan(vkBindBufferMemory(device, result.buffer, result.memory, 0), "vkBindBufferMemory");
    if (hostVisible) {
        checkVulkan(vkMapMemory(device, result.memory, 0, VK_WHOLE_SIZE, 0, &result.mapped),
                    "vkMapMemory");
    }
    return result;
}

Buffer VulkanHost::createFilledBuffer(const void* data, VkDeviceSize size,
                                      VkBufferUsageFlags usage) const {
    Buffer staging = createBuffer(size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, true);
    std::memcpy(staging.mapped, data, size);
    Buffer result = createBuffer(size, usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT, false);
    runNow([&](VkCommandBuffer commands) {
        const VkBufferCopy region{0, 0, size};
        vkCmdCopyBuffer(commands, staging.buffer, result.buffer, 1, &region);
    });
    destroy(staging);
    return result;
}

void VulkanHost::destroy(Buffer& buffer) const {
    vkDestroyBuffer(device, buffer.buffer, nullptr);
    vkFreeMemory(device, buffer.memory, nullptr);
    buffer = {};
}

Image VulkanHost::createImage(const ImageRequest& request) const {
    Image result;
    result.made = request;
    VkImageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = request.format;
    info.extent = {request.width, request.height, 1};
    info.mipLevels = request.mips;
    info.arrayLayers = 1;
    info.samples = request.samples;
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = request.usage;
    checkVulkan(vkCreateImage(device, &info, nullptr, &result.image), "vkCreateImage");
    VkMemoryRequirements needs{};
    vkGetImageMemoryRequirements(device, result.image, &needs);
    VkMemoryAllocateInfo allocation{};
    allocation.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    allocation.allocationSize = needs.size;
    allocation.memoryTypeIndex =
        memoryType(needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    checkVulkan(vkAllocateMemory(device, &allocation, nullptr, &result.memory), "vkAllocateMemory");
    checkVulkan(vkBindImageMemory(device, result.image, result.memory, 0), "vkBindImageMemory");
    VkImageViewCreateInfo viewInfo{};
    viewInfo.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    viewInfo.image = result.image;
    viewInfo.viewType = VK_IMAGE_VIEW_TYPE_2D;
    viewInfo.format = request.format;
    viewInfo.subresourceRange = {request.aspect, 0, request.mips, 0, 1};
    checkVulkan(vkCreateImageView(device, &viewInfo, nullptr, &result.view), "vkCreateImageView");
    viewInfo.subresourceRange.levelCount = 1;
    checkVulkan(vkCreateImageView(device, &viewInfo, nullptr, &result.firstMip),
                "vkCreateImageView");
    return result;
}

Image VulkanHost::createTexture(uint32_t width, uint32_t height, const uint8_t* rgba,
                                bool srgb) const {
    ImageRequest request;
    request.width = width;
    request.height = height;
    while ((std::max(width, height) >> request.mips) > 0) ++request.mips;
    request.format = srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM;
    return createTexture(request, rgba);
}

Image VulkanHost::createTexture(ImageRequest request, const uint8_t* texels) const {
    const uint32_t width = request.width, height = request.height;
    request.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                    VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    Image result = createImage(request);
    const VkDeviceSize bytes = VkDeviceSize{width} * height * 4;
    Buffer staging = createBuffer(bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, true);
    std::memcpy(staging.mapped, texels, bytes);
    runNow([&](VkCommandBuffer commands) {
        imageBarrier(commands, result.image, VK_IMAGE_LAYOUT_UNDEFINED,
                     VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, 0,
                     VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageExtent = {width, height, 1};
        vkCmdCopyBufferToImage(commands, staging.buffer, result.image,
                               VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
        for (uint32_t mip = 1; mip < request.mips; ++mip) {
            imageBarrier(commands, result.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                         VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_PIPELINE_STAGE_TRANSFER_BIT,
                         VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT,
                         VK_ACCESS_TRANSFER_READ_BIT, mip - 1, 1);
            VkImageBlit blit{};
            blit.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip - 1, 0, 1};
            blit.srcOffsets[1] = {static_cast<int32_t>(std::max(1u, width >> (mip - 1))),
                                  static_cast<int32_t>(std::max(1u, height >> (mip - 1))), 1};
            blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip, 0, 1};
            blit.dstOffsets[1] = {static_cast<int32_t>(std::max(1u, width >> mip)),
                                  static_cast<int32_t>(std::max(1u, height >> mip)), 1};
            vkCmdBlitImage(commands, result.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                           result.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit,
                           VK_FILTER_LINEAR);
        }
        if (request.mips > 1) {
            imageBarrier(commands, result.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                         VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_PIPELINE_STAGE_TRANSFER_BIT,
                         VK_ACCESS_TRANSFER_READ_BIT, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                         VK_ACCESS_SHADER_READ_BIT, 0, request.mips - 1);
        }
        imageBarrier(commands, result.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                     VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_PIPELINE_STAGE_TRANSFER_BIT,
                     VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                     VK_ACCESS_SHADER_READ_BIT, request.mips - 1, 1);
    });
    destroy(staging);
    return result;
}

void VulkanHost::destroy(Image& image) const {
    vkDestroyImageView(device, image.view, nullptr);
    vkDestroyImageView(device, image.firstMip, nullptr);
    vkDestroyImage(device, image.image, nullptr);
    vkFreeMemory(device, image.memory, nullptr);
    image = {};
}

VkSampler VulkanHost::createSampler(VkFilter filter, VkSamplerAddressMode address,
                                    VkSamplerMipmapMode mips) const {
    VkSamplerCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
    info.magFilter = filter;
    info.minFilter = filter;
    info.mipmapMode = mips;
    info.addressModeU = info.addressModeV = info.addressModeW = address;
    info.maxLod = VK_LOD_CLAMP_NONE;
    VkSampler sampler = VK_NULL_HANDLE;
    checkVulkan(vkCreateSampler(device, &info, nullptr, &sampler), "vkCreateSampler");
    return sampler;
}

VkShaderModule VulkanHost::createShader(const uint32_t* words, size_t bytes) const {
    VkShaderModuleCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    info.codeSize = bytes;
    info.pCode = words;
    VkShaderModule shader = VK_NULL_HANDLE;
    checkVulkan(vkCreateShaderModule(device, &info, nullptr, &shader), "vkCreateShaderModule");
    return shader;
}

VkCommandBuffer VulkanHost::beginNow() const {
    VkCommandBufferAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    info.commandPool = setupPool_;
    info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    info.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    checkVulkan(vkAllocateCommandBuffers(device, &info, &commands), "vkAllocateCommandBuffers");
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    checkVulkan(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
    return commands;
}

void VulkanHost::endNow(VkCommandBuffer commands) const {
    checkVulkan(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    checkVulkan(vkQueueSubmit(queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
    checkVulkan(vkQueueWaitIdle(queue), "vkQueueWaitIdle");
    vkFreeCommandBuffers(device, setupPool_, 1, &commands);
}

void imageBarrier(VkCommandBuffer commands, VkImage image, VkImageLayout before,
                  VkImageLayout after, VkPipelineStageFlags stageBefore, VkAccessFlags accessBefore,
                  VkPipelineStageFlags stageAfter, VkAccessFlags accessAfter, uint32_t firstMip,
                  uint32_t mips) {
    VkImageMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
    barrier.srcAccessMask = accessBefore;
    barrier.dstAccessMask = accessAfter;
    barrier.oldLayout = before;
    barrier.newLayout = after;
    barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, firstMip, mips, 0, 1};
    vkCmdPipelineBarrier(commands, stageBefore, stageAfter, 0, 0, nullptr, 0, nullptr, 1, &barrier);
}

}  // namespace sample
