#include "support/vulkan_device.h"

#include "support/device_rank.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace fw::test {
namespace {

void must(VkResult result, const char* what) {
    if (result != VK_SUCCESS) {
        ADD_FAILURE() << what << " failed: " << result;
        std::abort();
    }
}

}  // namespace

bool gpuAssisted() {
    const char* value = std::getenv("FLAMEWRIGHT_GPU_ASSISTED");
    return value && std::strcmp(value, "1") == 0;
}

uint32_t testApiVersion() {
    uint32_t version = VK_API_VERSION_1_0;
    if (const char* value = std::getenv("FLAMEWRIGHT_API"); value && *value) {
        if (value[0] != '1' || value[1] != '.' || value[2] < '0' || value[2] > '3' || value[3]) {
            ADD_FAILURE() << "FLAMEWRIGHT_API \"" << value << "\" is none of 1.0, 1.1, 1.2, 1.3";
            return version;
        }
        version = VK_MAKE_API_VERSION(0, 1, uint32_t(value[2] - '0'), 0);
    }
    // The layer itself needs 1.1.
    return gpuAssisted() ? std::max(version, VK_API_VERSION_1_1) : version;
}

bool gpuRequired() {
    const char* value = std::getenv("FLAMEWRIGHT_REQUIRE_GPU");
    return value && std::strcmp(value, "1") == 0;
}

VKAPI_ATTR VkBool32 VKAPI_CALL TestDevice::listen(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                                  VkDebugUtilsMessageTypeFlagsEXT type,
                                                  const VkDebugUtilsMessengerCallbackDataEXT* data,
                                                  void* user) {
    // Ignores the loader's remarks about drivers, but not the drivers' about our shaders.
    if (!(type & (VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
                  VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT)) &&
        data->pMessageIdName && std::strstr(data->pMessageIdName, "Loader"))
        return VK_FALSE;
    // Messages of the layers about their own instrumentation.
    if (data->pMessageIdName && std::strstr(data->pMessageIdName, "UNASSIGNED-GPU-Assisted") &&
        data->pMessage && std::strstr(data->pMessage, "Validation Setup"))
        return VK_FALSE;
    auto* self = static_cast<TestDevice*>(user);
    const std::lock_guard lock(self->mutex_);
    if (self->messages_.size() < 32) self->messages_.emplace_back(data->pMessage);
    return VK_FALSE;
}

std::unique_ptr<TestDevice> TestDevice::make(const DeviceOptions& wanted, std::string& reason) {
    uint32_t layerCount = 0;
    vkEnumerateInstanceLayerProperties(&layerCount, nullptr);
    std::vector<VkLayerProperties> layers(layerCount);
    vkEnumerateInstanceLayerProperties(&layerCount, layers.data());
    constexpr const char* kLayer = "VK_LAYER_KHRONOS_validation";
    bool found = false;
    for (const VkLayerProperties& layer : layers) found |= !std::strcmp(layer.layerName, kLayer);
    if (!found) {
        reason = "VK_LAYER_KHRONOS_validation is not installed";
        return nullptr;
    }
    std::unique_ptr<TestDevice> out(new TestDevice);
    out->options = wanted;
    const bool assisted = gpuAssisted();
    out->options.apiVersion = std::max(wanted.apiVersion, testApiVersion());

    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.apiVersion = out->options.apiVersion;
    std::vector<VkValidationFeatureEnableEXT> enables{
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    if (assisted) {
        enables.push_back(VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_EXT);
        enables.push_back(VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_RESERVE_BINDING_SLOT_EXT);
    }
    VkValidationFeaturesEXT validation{};
    validation.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
    validation.enabledValidationFeatureCount = uint32_t(enables.size());
    validation.pEnabledValidationFeatures = enables.data();
    VkDebugUtilsMessengerCreateInfoEXT messenger{};
    messenger.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    messenger.pNext = &validation;
    messenger.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                                VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
                            VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT |
                            VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT;
    messenger.pfnUserCallback = listen;
    messenger.pUserData = out.get();
    const char* instanceExtensions[] = {"VK_EXT_debug_utils", "VK_EXT_validation_features"};
    VkInstanceCreateInfo instanceInfo{};
    instanceInfo.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    instanceInfo.pNext = &messenger;
    instanceInfo.pApplicationInfo = &application;
    instanceInfo.enabledLayerCount = 1;
    instanceInfo.ppEnabledLayerNames = &kLayer;
    instanceInfo.enabledExtensionCount = 2;
    instanceInfo.ppEnabledExtensionNames = instanceExtensions;
    const VkResult made = vkCreateInstance(&instanceInfo, nullptr, &out->instance);
    if (made != VK_SUCCESS) {
        reason = "vkCreateInstance fails with " + std::to_string(int(made));
        return nullptr;
    }
    messenger.pNext = nullptr;
    const auto createMessenger = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(out->instance, "vkCreateDebugUtilsMessengerEXT"));
    must(createMessenger(out->instance, &messenger, nullptr, &out->messenger_),
         "vkCreateDebugUtilsMessengerEXT");

    for (VkPhysicalDevice candidate : rankedDevices(out->instance)) {
        uint32_t families = 0;
        vkGetPhysicalDeviceQueueFamilyProperties(candidate, &families, nullptr);
        std::vector<VkQueueFamilyProperties> properties(families);
        vkGetPhysicalDeviceQueueFamilyProperties(candidate, &families, properties.data());
        for (uint32_t i = 0; i < families; ++i) {
            constexpr VkQueueFlags kNeeded = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
            if ((properties[i].queueFlags & kNeeded) != kNeeded) continue;
            out->physicalDevice = candidate;
            out->queueFamily = i;
            break;
        }
        if (out->physicalDevice) break;
    }
    if (!out->physicalDevice) {
        reason = "there is no Vulkan device with graphics and compute";
        return nullptr;
    }
    vkGetPhysicalDeviceProperties(out->physicalDevice, &out->properties);
    const float priority = 1;
    VkDeviceQueueCreateInfo queueInfo{};
    queueInfo.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queueInfo.queueFamilyIndex = out->queueFamily;
    queueInfo.queueCount = 1;
    queueInfo.pQueuePriorities = &priority;
    if (out->options.apiVersion >= VK_API_VERSION_1_3) {  // everything that the library can use
        VkPhysicalDeviceFeatures supported{};
        vkGetPhysicalDeviceFeatures(out->physicalDevice, &supported);
        out->options.independentBlend |= supported.independentBlend == VK_TRUE;
    }
    out->features_.features.independentBlend = out->options.independentBlend;
    VkPhysicalDeviceFeatures enabled = out->features_.features;
    if (assisted) {  // for the layer's own writes; hidden from the library
        enabled.vertexPipelineStoresAndAtomics = VK_TRUE;
        enabled.fragmentStoresAndAtomics = VK_TRUE;
    }
    VkDeviceCreateInfo deviceInfo{};
    deviceInfo.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    deviceInfo.queueCreateInfoCount = 1;
    deviceInfo.pQueueCreateInfos = &queueInfo;
    deviceInfo.pEnabledFeatures = &enabled;
    must(vkCreateDevice(out->physicalDevice, &deviceInfo, nullptr, &out->device), "vkCreateDevice");
    vkGetDeviceQueue(out->device, out->queueFamily, 0, &out->queue);
    VkCommandPoolCreateInfo poolInfo{};
    poolInfo.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    poolInfo.queueFamilyIndex = out->queueFamily;
    poolInfo.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    must(vkCreateCommandPool(out->device, &poolInfo, nullptr, &out->pool), "vkCreateCommandPool");
    return out;
}

TestDevice::~TestDevice() {
    if (device) {
        for (const TestImage& one : images_) {
            vkDestroyImageView(device, one.view, nullptr);
            vkDestroyImage(device, one.image, nullptr);
            vkFreeMemory(device, one.memory, nullptr);
        }
        for (const TestBuffer& one : buffers_) {
            vkDestroyBuffer(device, one.buffer, nullptr);
            vkFreeMemory(device, one.memory, nullptr);
        }
        vkDestroyCommandPool(device, pool, nullptr);
        vkDestroyDevice(device, nullptr);
    }
    if (messenger_) {
        const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT"));
        destroy(instance, messenger_, nullptr);
    }
    if (instance) vkDestroyInstance(instance, nullptr);
}

FwVulkanHost TestDevice::host() const {
    static constexpr const char* kDebugUtils[] = {"VK_EXT_debug_utils"};
    FwVulkanHost host{};
    host.structSize = sizeof host;
    host.apiVersion = options.apiVersion;
    host.getInstanceProcAddr = vkGetInstanceProcAddr;
    host.instance = instance;
    host.physicalDevice = physicalDevice;
    host.device = device;
    host.queueFamilyIndex = queueFamily;
    if (options.declareDebugUtils) {
        host.enabledInstanceExtensionCount = 1;
        host.enabledInstanceExtensions = kDebugUtils;
    }
    if (options.apiVersion >= VK_API_VERSION_1_1)
        host.enabledFeatureChain = &features_;
    else if (options.independentBlend)
        host.enabledFeatures = &features_.features;
    return host;
}

void TestDevice::run(const std::function<void(VkCommandBuffer)>& record) {
    VkCommandBufferAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    allocate.commandPool = pool;
    allocate.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    must(vkAllocateCommandBuffers(device, &allocate, &commands), "vkAllocateCommandBuffers");
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    must(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
    record(commands);
    must(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    must(vkQueueSubmit(queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
    must(vkQueueWaitIdle(queue), "vkQueueWaitIdle");
    vkFreeCommandBuffers(device, pool, 1, &commands);
}

uint32_t TestDevice::memoryType(uint32_t allowed, VkMemoryPropertyFlags flags) const {
    VkPhysicalDeviceMemoryProperties types{};
    vkGetPhysicalDeviceMemoryProperties(physicalDevice, &types);
    for (uint32_t i = 0; i < types.memoryTypeCount; ++i) {
        if ((allowed >> i & 1u) && (types.memoryTypes[i].propertyFlags & flags) == flags) return i;
    }
    ADD_FAILURE() << "no memory type " << flags;
    return 0;
}

TestBuffer TestDevice::makeBuffer(VkDeviceSize bytes, VkBufferUsageFlags usage) {
    TestBuffer& out = buffers_.emplace_back();
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = bytes;
    info.usage = usage;
    must(vkCreateBuffer(device, &info, nullptr, &out.buffer), "vkCreateBuffer");
    VkMemoryRequirements needs{};
    vkGetBufferMemoryRequirements(device, out.buffer, &needs);
    VkMemoryAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    allocate.allocationSize = needs.size;
    allocate.memoryTypeIndex =
        memoryType(needs.memoryTypeBits,
                   VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    must(vkAllocateMemory(device, &allocate, nullptr, &out.memory), "vkAllocateMemory");
    must(vkBindBufferMemory(device, out.buffer, out.memory, 0), "vkBindBufferMemory");
    must(vkMapMemory(device, out.memory, 0, VK_WHOLE_SIZE, 0, &out.mapped), "vkMapMemory");
    return out;
}

TestImage TestDevice::makeImage(VkFormat format, VkExtent2D extent, uint32_t samples,
                                VkImageUsageFlags usage) {
    TestImage out;
    VkImageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {extent.width, extent.height, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VkSampleCountFlagBits(samples);
    info.usage = usage;
    must(vkCreateImage(device, &info, nullptr, &out.image), "vkCreateImage");
    VkMemoryRequirements needs{};
    vkGetImageMemoryRequirements(device, out.image, &needs);
    VkMemoryAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    allocate.allocationSize = needs.size;
    allocate.memoryTypeIndex = memoryType(needs.memoryTypeBits, 0);
    must(vkAllocateMemory(device, &allocate, nullptr, &out.memory), "vkAllocateMemory");
    must(vkBindImageMemory(device, out.image, out.memory, 0), "vkBindImageMemory");
    VkImageViewCreateInfo view{};
    view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    view.image = out.image;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format;
    const bool depth = (usage & VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT) != 0;
    const VkImageAspectFlags aspect = depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
    view.subresourceRange = {aspect, 0, 1, 0, 1};
    must(vkCreateImageView(device, &view, nullptr, &out.view), "vkCreateImageView");
    images_.push_back(out);
    return out;
}

std::vector<std::string> TestDevice::takeMessages() {
    const std::lock_guard lock(mutex_);
    return std::exchange(messages_, {});
}

HostFrames::HostFrames(TestDevice& device, uint32_t inFlight) : device_(device), slots_(inFlight) {
    VkCommandPoolCreateInfo poolInfo{};
    poolInfo.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    poolInfo.queueFamilyIndex = device.queueFamily;
    poolInfo.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    must(vkCreateCommandPool(device.device, &poolInfo, nullptr, &pool_), "vkCreateCommandPool");
    for (Slot& slot : slots_) {
        VkCommandBufferAllocateInfo allocate{};
        allocate.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
        allocate.commandPool = pool_;
        allocate.commandBufferCount = 1;
        must(vkAllocateCommandBuffers(device.device, &allocate, &slot.commands),
             "vkAllocateCommandBuffers");
        VkFenceCreateInfo fence{};
        fence.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
        must(vkCreateFence(device.device, &fence, nullptr, &slot.fence), "vkCreateFence");
    }
}

HostFrames::~HostFrames() {
    vkDeviceWaitIdle(device_.device);
    for (Slot& slot : slots_) vkDestroyFence(device_.device, slot.fence, nullptr);
    vkDestroyCommandPool(device_.device, pool_, nullptr);
}

FwVulkanFrame HostFrames::begin(float deltaTime) {
    ++index_;
    Slot& slot = slots_[index_ % slots_.size()];
    if (slot.index) {
        must(vkWaitForFences(device_.device, 1, &slot.fence, VK_TRUE, ~0ull), "vkWaitForFences");
        must(vkResetFences(device_.device, 1, &slot.fence), "vkResetFences");
        completed_ = std::max(completed_, slot.index);
    }
    slot.index = index_;
    must(vkResetCommandBuffer(slot.commands, 0), "vkResetCommandBuffer");
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    must(vkBeginCommandBuffer(slot.commands, &begin), "vkBeginCommandBuffer");
    FwVulkanFrame frame{};
    frame.structSize = sizeof frame;
    frame.commandBuffer = slot.commands;
    frame.frameIndex = index_;
    frame.completedFrameIndex = completed_;
    frame.deltaTime = deltaTime;
    return frame;
}

void HostFrames::submit() {
    Slot& slot = slots_[index_ % slots_.size()];
    must(vkEndCommandBuffer(slot.commands), "vkEndCommandBuffer");
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &slot.commands;
    must(vkQueueSubmit(device_.queue, 1, &submit, slot.fence), "vkQueueSubmit");
}

void HostFrames::waitAll() {
    must(vkDeviceWaitIdle(device_.device), "vkDeviceWaitIdle");
    completed_ = index_;
}

void GpuTest::makeDevice(const DeviceOptions& options) {
    std::string reason;
    device_ = TestDevice::make(options, reason);
    if (device_) return;
    if (gpuRequired()) FAIL() << reason;
    GTEST_SKIP() << reason;
}

void GpuTest::TearDown() {
    if (!device_) return;
    vkDeviceWaitIdle(device_->device);
    for (const std::string& message : device_->takeMessages()) ADD_FAILURE() << message;
    device_.reset();
}

}  // namespace fw::test
