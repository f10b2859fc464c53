#include "gpu/vk/device.h"

#include "core/error.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#if defined(_WIN32)  // as windows.h, which defines macros such as min, declares them
extern "C" __declspec(dllimport) void* __stdcall LoadLibraryA(const char* name);
extern "C" __declspec(dllimport) void* __stdcall GetProcAddress(void* library, const char* name);
#define FW_LOADER "vulkan-1.dll"
#else
#include <dlfcn.h>
#define FW_LOADER "libvulkan.so.1"
#define LoadLibraryA(name) dlopen(name, RTLD_NOW | RTLD_LOCAL)
#define GetProcAddress dlsym
#endif

namespace fw::gpu::vk {
namespace {

constexpr uint32_t kMaxFamilies = 32;
// The largest number of storage buffers that one of our passes binds.
constexpr uint32_t kStorageBuffersNeeded = 17;

bool declared(const char* const* names, uint32_t count, const char* wanted) noexcept {
    for (uint32_t i = 0; i < count; ++i) {
        if (names[i] && std::strcmp(names[i], wanted) == 0) return true;
    }
    return false;
}

// Larger is better; a software device last.
int rank(VkPhysicalDeviceType type) noexcept {
    return type == VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU     ? 4
           : type == VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU ? 3
           : type == VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU    ? 2
                                                            : 1;
}

constexpr VkQueueFlags kQueueFlags = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;

}  // namespace

Device::Device(const FwVulkanHost* host, const core::Log& log) : log_(log) {
    try {
        if (host)
            adoptHost(*host);
        else
            make();
        checkDevice();
    } catch (...) {
        close();
        throw;
    }
    log_.write(FW_LOG_INFO, "Vulkan device \"%s\", %s, Vulkan %u.%u declared, queue family %u.",
               properties.deviceName, own ? "own" : "of the host", VK_API_VERSION_MAJOR(apiVersion),
               VK_API_VERSION_MINOR(apiVersion), queueFamily);
}

Device::~Device() { close(); }

void Device::adoptHost(const FwVulkanHost& host) {
    const std::pair<const char*, bool> handles[] = {
        {"getInstanceProcAddr", host.getInstanceProcAddr != nullptr},
        {"instance", host.instance != VK_NULL_HANDLE},
        {"physicalDevice", host.physicalDevice != VK_NULL_HANDLE},
        {"device", host.device != VK_NULL_HANDLE}};
    for (const auto& [field, given] : handles)
        if (!given) core::refuse("FwVulkanHost::%s is null.", field);
    if (host.enabledExtensionCount && !host.enabledExtensions)
        core::refuse("FwVulkanHost::enabledExtensions is null but enabledExtensionCount is %u.",
                     host.enabledExtensionCount);
    if (host.enabledInstanceExtensionCount && !host.enabledInstanceExtensions)
        core::refuse(
            "FwVulkanHost::enabledInstanceExtensions is null but "
            "enabledInstanceExtensionCount is %u.",
            host.enabledInstanceExtensionCount);
    instance = host.instance;
    physicalDevice = host.physicalDevice;
    handle = host.device;
    queueFamily = host.queueFamilyIndex;
    apiVersion = host.apiVersion ? host.apiVersion : VK_API_VERSION_1_0;
    pipelineCache = host.pipelineCache;
    allocationCallbacks = host.allocationCallbacks;
    debugUtils = declared(host.enabledInstanceExtensions, host.enabledInstanceExtensionCount,
                          "VK_EXT_debug_utils");
    const VkPhysicalDeviceFeatures* features = host.enabledFeatures;
    for (auto* link = static_cast<const VkBaseInStructure*>(host.enabledFeatureChain);
         link && !features; link = link->pNext) {
        if (link->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2)
            features = &reinterpret_cast<const VkPhysicalDeviceFeatures2*>(link)->features;
    }
    independentBlend = features && features->independentBlend;
    table.loadInstance(host.getInstanceProcAddr, instance);
    table.loadDevice(instance, handle, debugUtils);
}

void Device::make() {
    own = true;
    // Stays open: layers keep destructors of their own for the process's end.
    void* const library = LoadLibraryA(FW_LOADER);
    if (!library)
        core::fail(FW_ERROR_UNSUPPORTED_DEVICE,
                   "No Vulkan loader: " FW_LOADER
                   " cannot be opened. Give a device (FwVulkanHost) or use FW_BACKEND_CPU.");
    const auto get = reinterpret_cast<PFN_vkGetInstanceProcAddr>(
        GetProcAddress(library, "vkGetInstanceProcAddr"));
    const auto createInstance =
        get ? reinterpret_cast<PFN_vkCreateInstance>(get(nullptr, "vkCreateInstance")) : nullptr;
    if (!createInstance)
        core::fail(FW_ERROR_UNSUPPORTED_DEVICE, FW_LOADER " offers no vkCreateInstance.");

    Typed<VkApplicationInfo> application;
    application.pEngineName = "Flamewright";
    application.apiVersion = VK_API_VERSION_1_0;
    Typed<VkInstanceCreateInfo> instanceInfo;
    instanceInfo.pApplicationInfo = &application;
    vk::check(createInstance(&instanceInfo, nullptr, &instance), "vkCreateInstance");
    table.loadInstance(get, instance);

    std::array<VkPhysicalDevice, 16> devices{};
    auto count = uint32_t(devices.size());
    const VkResult listed = table.EnumeratePhysicalDevices(instance, &count, devices.data());
    if (listed != VK_INCOMPLETE) vk::check(listed, "vkEnumeratePhysicalDevices");
    int best = 0;
    for (uint32_t i = 0; i < count; ++i) {
        VkPhysicalDeviceProperties found{};
        table.GetPhysicalDeviceProperties(devices[i], &found);
        std::array<VkQueueFamilyProperties, kMaxFamilies> families{};
        uint32_t familyCount = kMaxFamilies;
        table.GetPhysicalDeviceQueueFamilyProperties(devices[i], &familyCount, families.data());
        for (uint32_t family = 0; family < familyCount; ++family) {
            if ((families[family].queueFlags & kQueueFlags) != kQueueFlags) continue;
            if (rank(found.deviceType) > best) {
                best = rank(found.deviceType);
                physicalDevice = devices[i];
                queueFamily = family;
            }
            break;
        }
    }
    if (!physicalDevice)
        core::fail(FW_ERROR_UNSUPPORTED_DEVICE,
                   "None of the %u Vulkan devices has a queue family with graphics and compute.",
                   count);

    const float priority = 1.0f;
    Typed<VkDeviceQueueCreateInfo> queueInfo;
    queueInfo.queueFamilyIndex = queueFamily;
    queueInfo.queueCount = 1;
    queueInfo.pQueuePriorities = &priority;
    Typed<VkDeviceCreateInfo> deviceInfo;
    deviceInfo.queueCreateInfoCount = 1;
    deviceInfo.pQueueCreateInfos = &queueInfo;
    vk::check(table.CreateDevice(physicalDevice, &deviceInfo, nullptr, &handle), "vkCreateDevice");
    table.loadDevice(instance, handle, false);
    table.GetDeviceQueue(handle, queueFamily, 0, &queue);
}

void Device::checkDevice() {
    table.GetPhysicalDeviceProperties(physicalDevice, &properties);
    table.GetPhysicalDeviceMemoryProperties(physicalDevice, &memoryProperties);
    std::array<VkQueueFamilyProperties, kMaxFamilies> families{};
    uint32_t count = kMaxFamilies;
    table.GetPhysicalDeviceQueueFamilyProperties(physicalDevice, &count, families.data());
    if (queueFamily >= count)
        core::refuse("FwVulkanHost::queueFamilyIndex is %u; the device has %u queue families.",
                     queueFamily, count);
    const VkQueueFamilyProperties& family = families[queueFamily];
    if ((family.queueFlags & kQueueFlags) != kQueueFlags)
        core::fail(FW_ERROR_UNSUPPORTED_DEVICE,
                   "Queue family %u has flags 0x%x; the recorded work needs graphics and compute "
                   "(0x%x).",
                   queueFamily, family.queueFlags, kQueueFlags);
    timestamps = family.timestampValidBits != 0;

    const VkPhysicalDeviceLimits& limits = properties.limits;
    const struct {
        const char* name;
        uint64_t value, needed;
    } needs[] = {
        {"maxPerStageDescriptorStorageBuffers", limits.maxPerStageDescriptorStorageBuffers,
         kStorageBuffersNeeded},
        {"maxDescriptorSetStorageBuffers", limits.maxDescriptorSetStorageBuffers,
         kStorageBuffersNeeded},
        {"maxPushConstantsSize", limits.maxPushConstantsSize, 128},
        {"maxBoundDescriptorSets", limits.maxBoundDescriptorSets, 4},
        {"maxComputeWorkGroupInvocations", limits.maxComputeWorkGroupInvocations, 128},
        {"maxComputeWorkGroupSize[0]", limits.maxComputeWorkGroupSize[0], 128},
        {"maxComputeSharedMemorySize", limits.maxComputeSharedMemorySize, 16384},
        {"maxStorageBufferRange", limits.maxStorageBufferRange, 1u << 27},
    };
    texels = limits.maxTexelBufferElements >= limits.maxStorageBufferRange / 16;
    for (const auto& need : needs) {
        if (need.value < need.needed)
            core::fail(FW_ERROR_UNSUPPORTED_DEVICE,
                       "The device \"%s\" has %s %llu; at least %llu is needed.",
                       properties.deviceName, need.name, (unsigned long long)need.value,
                       (unsigned long long)need.needed);
    }
}

void Device::close() noexcept {
    if (own) {
        if (handle) table.DestroyDevice(handle, nullptr);
        if (instance && table.DestroyInstance) table.DestroyInstance(instance, nullptr);
    }
    handle = VK_NULL_HANDLE;
    instance = VK_NULL_HANDLE;
}

void Device::notifyLost() noexcept {
    if (!lost_.exchange(true, std::memory_order_acq_rel))
        log_.write(FW_LOG_ERROR, "The Vulkan device is lost: nothing more is recorded.");
}

void Device::check(VkResult result, const char* what) {
    if (result == VK_ERROR_DEVICE_LOST) notifyLost();
    vk::check(result, what);
}

void Device::failIfLost() const {
    if (lost())
        core::fail(FW_ERROR_DEVICE_LOST, "The Vulkan device is lost; nothing more is recorded.");
}

void Device::name(VkObjectType type, uint64_t object, const char* text) const noexcept {
    if (!debugUtils || !table.SetDebugUtilsObjectNameEXT) return;
    Typed<VkDebugUtilsObjectNameInfoEXT> info;
    info.objectType = type;
    info.objectHandle = object;
    info.pObjectName = text;
    table.SetDebugUtilsObjectNameEXT(handle, &info);
}

}  // namespace fw::gpu::vk
