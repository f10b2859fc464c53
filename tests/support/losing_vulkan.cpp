// Linked into a test whose host provides `losingEntry`; or, with FW_LOSING_LOADER (path of the real
// one), a libvulkan.so.1 of its own that also loses the library's own device.
#define VK_NO_PROTOTYPES
#include "support/losing_vulkan.h"

#ifdef FW_LOSING_LOADER
#include <dlfcn.h>
#endif

#include <algorithm>
#include <cstring>
#include <vector>

namespace fw::test {
namespace {

LosingVulkan vulkan;

// True if this call must report the loss.
bool loses(const char* name) {
    const int64_t call = vulkan.calls.fetch_add(1);
    if (call < LosingVulkan::kMostCalls) vulkan.names[size_t(call)] = name;
    if (call == vulkan.loseAt) vulkan.lost = true;
    return vulkan.lost;
}

// True if a call of this name creates an object.
bool makes(const char* name) {
    return std::strncmp(name, "vkCreate", 8) == 0 || std::strcmp(name, "vkAllocateMemory") == 0;
}
// After a loss during a wait the device no longer works.
bool waits(const char* name) {
    return std::strcmp(name, "vkWaitForFences") == 0 || std::strcmp(name, "vkQueueWaitIdle") == 0 ||
           std::strcmp(name, "vkDeviceWaitIdle") == 0;
}

struct Kept {
    VkInstance instance = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;  // owner of the pipelines; own: destroyed here
    bool own = false;
    std::vector<VkPipeline> pipelines[2];  // compute, graphics
    [[nodiscard]] bool has(VkPipeline one) const {
        return std::any_of(std::begin(pipelines), std::end(pipelines), [&](const auto& list) {
            return std::find(list.begin(), list.end(), one) != list.end();
        });
    }
} kept;

#define FW_LOSING(entry)                                                         \
    struct Losing##entry {                                                       \
        static inline PFN_vk##entry next = nullptr;                              \
        template <class... Arguments>                                            \
        static PFN_vk##entry of(VkResult(VKAPI_PTR*)(Arguments...)) {            \
            return [](Arguments... arguments) -> VkResult {                      \
                const bool before = vulkan.lost;                                 \
                if (loses("vk" #entry)) {                                        \
                    if (waits("vk" #entry) && !before) (void)next(arguments...); \
                    return VK_ERROR_DEVICE_LOST;                                 \
                }                                                                \
                const VkResult result = next(arguments...);                      \
                if (makes("vk" #entry) && result == VK_SUCCESS) ++vulkan.live;   \
                return result;                                                   \
            };                                                                   \
        }                                                                        \
    };
// clang-format off
#define FW_ALL_LOSING(X)                                                                \
    X(QueueSubmit) X(QueueWaitIdle) X(DeviceWaitIdle) X(AllocateMemory) X(MapMemory)    \
    X(CreateBuffer) X(BindBufferMemory) X(CreateBufferView) X(CreateImage)              \
    X(BindImageMemory) X(CreateImageView) X(CreateSampler) X(CreateShaderModule)        \
    X(CreateDescriptorSetLayout) X(CreatePipelineLayout) X(CreateDescriptorPool) X(AllocateDescriptorSets)        \
    X(CreateRenderPass) X(CreateFramebuffer) X(CreateQueryPool) X(GetQueryPoolResults)  \
    X(CreateCommandPool) X(AllocateCommandBuffers) X(BeginCommandBuffer)                \
    X(EndCommandBuffer) X(CreateFence) X(WaitForFences) X(ResetFences) X(ResetCommandPool)
#define FW_ALL_DESTROYING(X)                                                            \
    X(FreeMemory) X(DestroyBuffer) X(DestroyBufferView) X(DestroyImage)                 \
    X(DestroyImageView) X(DestroySampler) X(DestroyShaderModule)                        \
    X(DestroyDescriptorSetLayout) X(DestroyPipelineLayout)                              \
    X(DestroyDescriptorPool) X(DestroyRenderPass) X(DestroyFramebuffer)                 \
    X(DestroyQueryPool) X(DestroyCommandPool) X(DestroyFence)
// clang-format on
FW_ALL_LOSING(FW_LOSING)

#define FW_DESTROYING(entry)                                                            \
    struct Losing##entry {                                                              \
        static inline PFN_vk##entry next = nullptr;                                     \
        template <class Handle>                                                         \
        static PFN_vk##entry of(void(VKAPI_PTR*)(VkDevice, Handle,                      \
                                                 const VkAllocationCallbacks*)) {       \
            return [](VkDevice device, Handle one, const VkAllocationCallbacks* with) { \
                if (one) --vulkan.live;                                                 \
                next(device, one, with);                                                \
            };                                                                          \
        }                                                                               \
    };
FW_ALL_DESTROYING(FW_DESTROYING)

// One at a time, as the library creates them.
template <size_t kKind, class Info>
struct LosingPipelines {
    using Entry = VkResult(VKAPI_PTR*)(VkDevice, VkPipelineCache, uint32_t, const Info*,
                                       const VkAllocationCallbacks*, VkPipeline*);
    static inline Entry next = nullptr;
    static VkResult VKAPI_CALL call(VkDevice device, VkPipelineCache cache, uint32_t count,
                                    const Info* infos, const VkAllocationCallbacks* with,
                                    VkPipeline* out) {
        if (loses(kKind == 0 ? "vkCreateComputePipelines" : "vkCreateGraphicsPipelines"))
            return VK_ERROR_DEVICE_LOST;
        std::vector<VkPipeline>& known = kept.pipelines[kKind];
        const size_t number = vulkan.madePipelines[kKind]++;
        if (vulkan.keeps && number < known.size()) {
            *out = known[number];
        } else {
            const VkResult result = next(device, cache, count, infos, with, out);
            if (result != VK_SUCCESS) return result;
            if (vulkan.keeps) known.push_back(*out);
            kept.device = device;
        }
        ++vulkan.live;
        return VK_SUCCESS;
    }
};
using LosingCompute = LosingPipelines<0, VkComputePipelineCreateInfo>;
using LosingGraphics = LosingPipelines<1, VkGraphicsPipelineCreateInfo>;
struct LosingDestroyPipeline {
    static inline PFN_vkDestroyPipeline next = nullptr;
    static void VKAPI_CALL call(VkDevice device, VkPipeline one,
                                const VkAllocationCallbacks* with) {
        if (one) --vulkan.live;
        if (!kept.has(one)) next(device, one, with);
    }
};

// An own instance and device.
struct LosingCreateInstance {
    static inline PFN_vkCreateInstance next = nullptr;
    static VkResult VKAPI_CALL call(const VkInstanceCreateInfo* info,
                                    const VkAllocationCallbacks* with, VkInstance* out) {
        if (vulkan.keeps && kept.instance) {
            *out = kept.instance;
            return VK_SUCCESS;
        }
        const VkResult result = next(info, with, out);
        if (vulkan.keeps && result == VK_SUCCESS) kept.instance = *out;
        return result;
    }
};
struct LosingDestroyInstance {
    static inline PFN_vkDestroyInstance next = nullptr;
    static void VKAPI_CALL call(VkInstance instance, const VkAllocationCallbacks* with) {
        if (instance != kept.instance) next(instance, with);
    }
};
struct LosingCreateDevice {
    static inline PFN_vkCreateDevice next = nullptr;
    static VkResult VKAPI_CALL call(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                    const VkAllocationCallbacks* with, VkDevice* out) {
        if (loses("vkCreateDevice")) return VK_ERROR_DEVICE_LOST;
        if (vulkan.keeps && kept.own) {
            *out = kept.device;
        } else {
            const VkResult result = next(physical, info, with, out);
            if (result != VK_SUCCESS) return result;
            if (vulkan.keeps) kept.device = *out, kept.own = true;
        }
        ++vulkan.live;
        return VK_SUCCESS;
    }
};
struct LosingDestroyDevice {
    static inline PFN_vkDestroyDevice next = nullptr;
    static void VKAPI_CALL call(VkDevice device, const VkAllocationCallbacks* with) {
        if (device) --vulkan.live;
        if (!kept.own || device != kept.device) next(device, with);
    }
};

template <class Losing>
PFN_vkVoidFunction instead(PFN_vkVoidFunction real) {
    if (!real) return nullptr;
    Losing::next = reinterpret_cast<decltype(Losing::next)>(real);
    return reinterpret_cast<PFN_vkVoidFunction>(&Losing::call);
}

template <class Losing, class Entry>
PFN_vkVoidFunction between(PFN_vkVoidFunction real, Entry entry) {
    if (!real) return nullptr;
    Losing::next = reinterpret_cast<decltype(Losing::next)>(real);
    return reinterpret_cast<PFN_vkVoidFunction>(Losing::of(entry));
}

PFN_vkGetDeviceProcAddr realDeviceEntry = nullptr;

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL deviceEntry(VkDevice device, const char* name) {
    const PFN_vkVoidFunction real = realDeviceEntry(device, name);
#define FW_MATCH(entry) \
    if (!std::strcmp(name, "vk" #entry)) return between<Losing##entry>(real, PFN_vk##entry{});
    FW_ALL_LOSING(FW_MATCH)
    FW_ALL_DESTROYING(FW_MATCH)
    if (!std::strcmp(name, "vkCreateComputePipelines")) return instead<LosingCompute>(real);
    if (!std::strcmp(name, "vkCreateGraphicsPipelines")) return instead<LosingGraphics>(real);
    if (!std::strcmp(name, "vkDestroyPipeline")) return instead<LosingDestroyPipeline>(real);
    if (!std::strcmp(name, "vkDestroyDevice")) return instead<LosingDestroyDevice>(real);
    return real;
}

}  // namespace

extern "C" {

LosingVulkan* losingVulkan() {
#ifdef FW_LOSING_LOADER
    if (!vulkan.real)
        if (void* loader = dlopen(FW_LOSING_LOADER, RTLD_NOW | RTLD_LOCAL))
            vulkan.real =
                reinterpret_cast<PFN_vkGetInstanceProcAddr>(dlsym(loader, "vkGetInstanceProcAddr"));
#endif
    return &vulkan;
}

void losingDrop() {
    vulkan.begin(-1);
    vulkan.keeps = false;
    for (auto& list : kept.pipelines) {
        for (const VkPipeline one : list) LosingDestroyPipeline::next(kept.device, one, nullptr);
        list.clear();
    }
    if (kept.own) LosingDestroyDevice::next(kept.device, nullptr);
    if (kept.instance) LosingDestroyInstance::next(kept.instance, nullptr);
    kept = {};
}

PFN_vkVoidFunction VKAPI_CALL losingEntry(VkInstance instance, const char* name) {
    const PFN_vkGetInstanceProcAddr entry = losingVulkan()->real;
    const PFN_vkVoidFunction real = entry ? entry(instance, name) : nullptr;
    if (!std::strcmp(name, "vkGetDeviceProcAddr")) {
        realDeviceEntry = reinterpret_cast<PFN_vkGetDeviceProcAddr>(real);
        return reinterpret_cast<PFN_vkVoidFunction>(&deviceEntry);
    }
    if (!std::strcmp(name, "vkCreateDevice")) return instead<LosingCreateDevice>(real);
    if (!std::strcmp(name, "vkCreateInstance")) return instead<LosingCreateInstance>(real);
    if (!std::strcmp(name, "vkDestroyInstance")) return instead<LosingDestroyInstance>(real);
    return real;
}

#ifdef FW_LOSING_LOADER
__attribute__((visibility("default"))) PFN_vkVoidFunction VKAPI_CALL
vkGetInstanceProcAddr(VkInstance instance, const char* name) {
    return losingEntry(instance, name);
}
#endif

}  // extern "C"

}  // namespace fw::test
