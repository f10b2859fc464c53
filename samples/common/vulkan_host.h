// The engine's side of Vulkan: instance, device, queue, and the plainest buffers and images.
// Every allocation is its own and every upload waits: right for a sample, wrong for an engine.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "common/options.h"

namespace sample {

// Throws Failure("<what> failed: <code>") unless result is VK_SUCCESS.
void checkVulkan(VkResult result, const char* what);
const char* vulkanResultName(VkResult result);

// What the validation layers said. Outlives the host, since destroying can be wrong, too.
struct ValidationLog {
    std::mutex mutex;
    uint32_t count = 0;                 // of warnings and errors
    std::vector<std::string> messages;  // the first 32 of them
    // 0 if there was none; else prints how many and returns 1.
    int exitCode();
};

struct HostRequest {
    uint32_t apiVersion = VK_API_VERSION_1_0;  // of the instance; the samples' floor
    bool windowed = false;                     // add what a window and a swapchain need
    ValidationLog* validation = nullptr;       // not null: layers on, messages go there
    VkPhysicalDeviceFeatures features{};       // to enable; refused if absent
    std::vector<const char*> instanceExtensions;
    std::vector<const char*> deviceExtensions;
    const void* featureChain = nullptr;  // VkPhysicalDeviceFeatures2 chain instead of `features`
};

// As the options want it; messages go to `log` if they ask for validation.
HostRequest hostRequest(const Options& options, ValidationLog& log);

struct Buffer {
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize size = 0;   // bytes
    void* mapped = nullptr;  // host-visible ones stay mapped
};

struct ImageRequest {
    uint32_t width = 1, height = 1, mips = 1;
    VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
    VkImageUsageFlags usage = 0;
    VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
};

struct Image {
    VkImage image = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;      // all mips
    VkImageView firstMip = VK_NULL_HANDLE;  // mip 0 alone, to render into
    ImageRequest made;
};

class VulkanHost {
 public:
    explicit VulkanHost(const HostRequest& request);
    ~VulkanHost();
    VulkanHost(const VulkanHost&) = delete;
    VulkanHost& operator=(const VulkanHost&) = delete;

    // What was made, and with what: a host has to tell the plugin all of it.
    HostRequest made;
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
    VkPhysicalDeviceProperties properties{};
    VkDevice device = VK_NULL_HANDLE;
    uint32_t queueFamily = 0;
    VkQueue queue = VK_NULL_HANDLE;

    Buffer createBuffer(VkDeviceSize size, VkBufferUsageFlags usage, bool hostVisible) const;
    // Device-local, filled from `data` before it returns.
    Buffer createFilledBuffer(const void* data, VkDeviceSize size, VkBufferUsageFlags usage) const;
    void destroy(Buffer& buffer) const;

    Image createImage(const ImageRequest& request) const;
    // A sampled image with a full mip chain, filled before it returns. RGBA8, rows top first.
    Image createTexture(uint32_t width, uint32_t height, const uint8_t* rgba, bool srgb) const;
    // Of any format of 4 bytes a texel, with as many mips as are asked for; the usage is its own.
    Image createTexture(ImageRequest request, const uint8_t* texels) const;
    void destroy(Image& image) const;

    VkSampler createSampler(VkFilter filter, VkSamplerAddressMode address,
                            VkSamplerMipmapMode mips = VK_SAMPLER_MIPMAP_MODE_LINEAR) const;
    VkShaderModule createShader(const uint32_t* words, size_t bytes) const;

    // Records, submits and waits: for set-up only.
    template <typename Body>
    void runNow(Body&& body) const {
        VkCommandBuffer commands = beginNow();
        body(commands);
        endNow(commands);
    }

    uint32_t memoryType(uint32_t allowedTypes, VkMemoryPropertyFlags wanted) const;
    // D32 float if it can be rendered to, else a packed one that can.
    VkFormat depthFormat() const;

 private:
    VkCommandBuffer beginNow() const;
    void endNow(VkCommandBuffer commands) const;
    void createInstance();
    void chooseDevice();
    void createDevice();
    void release();

    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    VkCommandPool setupPool_ = VK_NULL_HANDLE;
};

// One image barrier over all mips of a colour image, or `mips` of them from `firstMip`.
void imageBarrier(VkCommandBuffer commands, VkImage image, VkImageLayout before,
                  VkImageLayout after, VkPipelineStageFlags stageBefore, VkAccessFlags accessBefore,
                  VkPipelineStageFlags stageAfter, VkAccessFlags accessAfter, uint32_t firstMip = 0,
                  uint32_t mips = VK_REMAINING_MIP_LEVELS);

}  // namespace sample
