#include "bundle/device_facts.h"

#include <dlfcn.h>
#include <gnu/libc-version.h>
#include <sys/utsname.h>
#include <unistd.h>
#define VK_NO_PROTOTYPES
#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <thread>
#include <vector>

using nlohmann::json;

namespace fw::bundle {
namespace {

// The text after "key" and a separator in a file of such lines.
std::string lineOf(const char* path, const std::string& key, char separator) {
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        if (line.compare(0, key.size(), key) != 0) continue;
        const size_t at = line.find(separator);
        const size_t from = at == std::string::npos ? at : line.find_first_not_of(" \t\"", at + 1);
        if (from == std::string::npos) continue;
        return line.substr(from, line.find_last_not_of(" \t\"") + 1 - from);
    }
    return "unknown";
}

std::string versionText(uint32_t v) {
    return std::to_string(VK_API_VERSION_MAJOR(v)) + "." + std::to_string(VK_API_VERSION_MINOR(v)) +
           "." + std::to_string(VK_API_VERSION_PATCH(v));
}

const char* typeName(VkPhysicalDeviceType type) {
    switch (type) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
            return "discrete GPU";
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
            return "integrated GPU";
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
            return "virtual GPU";
        case VK_PHYSICAL_DEVICE_TYPE_CPU:
            return "software device";
        default:
            return "other";
    }
}

// As the library ranks devices for its own one: larger is better.
int rank(const std::string& type) {
    return type == "discrete GPU"     ? 4
           : type == "integrated GPU" ? 3
           : type == "virtual GPU"    ? 2
                                      : 1;
}

class Loader {
 public:
    Loader() {
        library_ = dlopen("libvulkan.so.1", RTLD_NOW | RTLD_LOCAL);
        if (!library_)
            throw std::runtime_error(
                "libvulkan.so.1, the Vulkan loader, cannot be opened. Install it (Debian, Ubuntu: "
                "libvulkan1; Fedora, Arch: vulkan-loader, vulkan-icd-loader).");
        get_ =
            reinterpret_cast<PFN_vkGetInstanceProcAddr>(dlsym(library_, "vkGetInstanceProcAddr"));
        if (!get_) throw std::runtime_error("libvulkan.so.1 has no vkGetInstanceProcAddr.");
    }
    ~Loader() {
        if (instance_) call<PFN_vkDestroyInstance>("vkDestroyInstance")(instance_, nullptr);
    }
    Loader(const Loader&) = delete;
    Loader& operator=(const Loader&) = delete;

    template <class Function>
    Function call(const char* name) const {
        return reinterpret_cast<Function>(get_(instance_, name));
    }
    [[nodiscard]] uint32_t version() const {
        uint32_t version = VK_API_VERSION_1_0;
        if (const auto ask = call<PFN_vkEnumerateInstanceVersion>("vkEnumerateInstanceVersion"))
            (void)ask(&version);
        return version;
    }
    [[nodiscard]] bool hasLayer(const char* wanted) const {
        const auto list =
            call<PFN_vkEnumerateInstanceLayerProperties>("vkEnumerateInstanceLayerProperties");
        uint32_t count = 0;
        (void)list(&count, nullptr);
        std::vector<VkLayerProperties> layers(count);
        (void)list(&count, layers.data());
        return std::any_of(layers.begin(), layers.end(), [&](const VkLayerProperties& layer) {
            return std::strcmp(layer.layerName, wanted) == 0;
        });
    }
    void createInstance() {
        VkApplicationInfo application{};
        application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
        application.apiVersion = std::min(version(), VK_API_VERSION_1_2);
        VkInstanceCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
        info.pApplicationInfo = &application;
        const VkResult result =
            call<PFN_vkCreateInstance>("vkCreateInstance")(&info, nullptr, &instance_);
        if (result != VK_SUCCESS)
            throw std::runtime_error("vkCreateInstance fails with " + std::to_string(result) +
                                     ". Is a Vulkan driver installed?");
    }
    [[nodiscard]] std::vector<VkPhysicalDevice> devices() const {
        const auto list = call<PFN_vkEnumeratePhysicalDevices>("vkEnumeratePhysicalDevices");
        uint32_t count = 0;
        (void)list(instance_, &count, nullptr);
        std::vector<VkPhysicalDevice> out(count);
        (void)list(instance_, &count, out.data());
        out.resize(count);
        return out;
    }

 private:
    void* library_ = nullptr;  // stays open: drivers keep destructors for the process's end
    PFN_vkGetInstanceProcAddr get_ = nullptr;
    VkInstance instance_ = VK_NULL_HANDLE;
};

json limitsOf(const VkPhysicalDeviceLimits& limits) {
    json out;
#define FW_LIMIT(name) out[#name] = limits.name
    FW_LIMIT(maxPerStageDescriptorStorageBuffers);
    FW_LIMIT(maxDescriptorSetStorageBuffers);
    FW_LIMIT(maxPushConstantsSize);
    FW_LIMIT(maxBoundDescriptorSets);
    FW_LIMIT(maxComputeWorkGroupInvocations);
    FW_LIMIT(maxComputeSharedMemorySize);
    FW_LIMIT(maxStorageBufferRange);
    FW_LIMIT(maxTexelBufferElements);
    FW_LIMIT(maxMemoryAllocationCount);
    FW_LIMIT(bufferImageGranularity);
    FW_LIMIT(nonCoherentAtomSize);
    FW_LIMIT(minStorageBufferOffsetAlignment);
    FW_LIMIT(minUniformBufferOffsetAlignment);
    FW_LIMIT(minTexelBufferOffsetAlignment);
    FW_LIMIT(optimalBufferCopyOffsetAlignment);
    FW_LIMIT(subPixelPrecisionBits);
    FW_LIMIT(timestampPeriod);
#undef FW_LIMIT
    return out;
}

json factsOf(const Loader& loader, VkPhysicalDevice device) {
    VkPhysicalDeviceProperties plain{};
    loader.call<PFN_vkGetPhysicalDeviceProperties>("vkGetPhysicalDeviceProperties")(device, &plain);
    json out;
    out["name"] = plain.deviceName;
    out["type"] = typeName(plain.deviceType);
    out["vulkan"] = versionText(plain.apiVersion);
    out["vendorId"] = plain.vendorID;
    out["deviceId"] = plain.deviceID;
    out["driverVersion"] = plain.driverVersion;
    out["limits"] = limitsOf(plain.limits);
    const auto properties2 =
        loader.call<PFN_vkGetPhysicalDeviceProperties2>("vkGetPhysicalDeviceProperties2");
    if (properties2 && plain.apiVersion >= VK_API_VERSION_1_2 &&
        loader.version() >= VK_API_VERSION_1_2) {
        VkPhysicalDeviceVulkan11Properties v11{};
        v11.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES;
        VkPhysicalDeviceVulkan12Properties v12{};
        v12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES;
        v12.pNext = &v11;
        VkPhysicalDeviceProperties2 all{};
        all.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
        all.pNext = &v12;
        properties2(device, &all);
        out["driver"] = v12.driverName;
        out["driverInfo"] = v12.driverInfo;
        const VkConformanceVersion& c = v12.conformanceVersion;
        out["vulkanConformance"] = std::to_string(c.major) + "." + std::to_string(c.minor) + "." +
                                   std::to_string(c.subminor) + "." + std::to_string(c.patch);
        out["subgroupSize"] = v11.subgroupSize;
    }
    uint32_t count = 0;
    const auto families = loader.call<PFN_vkGetPhysicalDeviceQueueFamilyProperties>(
        "vkGetPhysicalDeviceQueueFamilyProperties");
    families(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> queues(count);
    families(device, &count, queues.data());
    for (const VkQueueFamilyProperties& queue : queues) {
        std::string use;
        for (const auto& [bit, name] : {std::pair{VK_QUEUE_GRAPHICS_BIT, "graphics "},
                                        std::pair{VK_QUEUE_COMPUTE_BIT, "compute "},
                                        std::pair{VK_QUEUE_TRANSFER_BIT, "transfer "},
                                        std::pair{VK_QUEUE_SPARSE_BINDING_BIT, "sparse "}})
            if (queue.queueFlags & bit) use += name;
        out["queueFamilies"].push_back({{"use", use},
                                        {"queues", queue.queueCount},
                                        {"timestampBits", queue.timestampValidBits}});
    }
    VkPhysicalDeviceMemoryProperties memory{};
    loader.call<PFN_vkGetPhysicalDeviceMemoryProperties>("vkGetPhysicalDeviceMemoryProperties")(
        device, &memory);
    for (uint32_t i = 0; i < memory.memoryHeapCount; ++i)
        out["memoryHeaps"].push_back({{"MiB", memory.memoryHeaps[i].size >> 20},
                                      {"deviceLocal", (memory.memoryHeaps[i].flags &
                                                       VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) != 0}});
    for (uint32_t i = 0; i < memory.memoryTypeCount; ++i)
        out["memoryTypes"].push_back({{"heap", memory.memoryTypes[i].heapIndex},
                                      {"flags", memory.memoryTypes[i].propertyFlags}});
    const auto extensions = loader.call<PFN_vkEnumerateDeviceExtensionProperties>(
        "vkEnumerateDeviceExtensionProperties");
    (void)extensions(device, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> names(count);
    (void)extensions(device, nullptr, &count, names.data());
    for (const VkExtensionProperties& name : names) out["extensions"].push_back(name.extensionName);
    return out;
}

}  // namespace

json machineFacts() {
    utsname system{};
    uname(&system);
    json out;
    out["processor"] = lineOf("/proc/cpuinfo", "model name", ':');
    out["threads"] = std::thread::hardware_concurrency();
    out["memoryMiB"] = uint64_t(sysconf(_SC_PHYS_PAGES)) * uint64_t(sysconf(_SC_PAGESIZE)) >> 20;
    out["system"] = lineOf("/etc/os-release", "PRETTY_NAME", '=');
    out["kernel"] = std::string(system.sysname) + " " + system.release + " " + system.machine;
    out["libc"] = gnu_get_libc_version();
    return out;
}

json deviceFacts() {
    json out;
    out["devices"] = json::array();
    try {
        Loader loader;
        out["loader"] = versionText(loader.version());
        loader.createInstance();
        std::vector<json> found;
        for (VkPhysicalDevice device : loader.devices()) found.push_back(factsOf(loader, device));
        if (found.empty()) throw std::runtime_error("The Vulkan loader lists no device.");
        const auto best = [](const json& a, const json& b) {
            return rank(a["type"]) > rank(b["type"]);
        };
        std::stable_sort(found.begin(), found.end(), best);
        out["devices"] = found;
    } catch (const std::exception& error) {
        out["problem"] = error.what();
    }
    return out;
}

bool hasValidationLayer() {
    try {
        return Loader().hasLayer("VK_LAYER_KHRONOS_validation");
    } catch (const std::exception&) {
        return false;
    }
}

}  // namespace fw::bundle
