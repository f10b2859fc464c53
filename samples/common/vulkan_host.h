// The host side of Vulkan: instance, device, queue, and minimal buffers and images. Each resource
// has its own allocation and each upload waits. That suits a sample, not an engine.
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

// Collects the messages of the validation layers. It outlives the host, because destruction can
// raise messages too.
struct ValidationLog {
    std::mutex mutex;
    uint32_t count = 0;                 // warnings and errors
    std::vector<std::string> messages;  // the first 32 messages
    // Returns 0 if there were no messages. Otherwise prints their number and returns 1.
    int exitCode();
};

struct HostRequest {
    uint32_t apiVersion = VK_API_VERSION_1_0;  // version of the instance; the samples' minimum
    bool windowed = false;                     // adds the extensions for a window and a swapchain
    ValidationLog* validation = nullptr;       // if set, enables the validation layers and receives
                                               // their messages
    VkPhysicalDeviceFeatures features{};  // features to enable; creation fails if one is missing
    std::vector<const char*> instanceExtensions;
    std::vector<const char*> deviceExtensions;
    const void* featureChain = nullptr;  // a VkPhysicalDeviceFeatures2 chain that replaces
                                         // `features`
};

// Translates the options into a request. If they ask for validation, messages go to `log`.
HostRequest hostRequest(const Options& options, ValidationLog& log);

struct Buffer {
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize size = 0;   // bytes
    void* mapped = nullptr;  // host-visible buffers stay mapped
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
    VkImageView firstMip = VK_NULL_HANDLE;  // mip 0 only, as a render target
    ImageRequest made;
};

class VulkanHost {
 public:
    explicit VulkanHost(const HostRequest& request);
    ~VulkanHost();
    VulkanHost(const VulkanHost&) = delete;
    VulkanHost& operator=(const VulkanHost&) = delete;

    // The request that this host was created with. The plugin must receive all of it.
    HostRequest made;
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
    VkPhysicalDeviceProperties properties{};
    VkDevice device = VK_NULL_HANDLE;
    uint32_t queueFamily = 0;
    VkQueue queue = VK_NULL_HANDLE;

    Buffer createBuffer(VkDeviceSize size, VkBufferUsageFlags usage, bool hostVisible) const;
    // Creates a device-local buffer and waits until `data` is uploaded.
    Buffer createFilledBuffer(const void* data, VkDeviceSize size, VkBufferUsageFlags usage) const;
    void destroy(Buffer& buffer) const;

    Image createImage(const ImageRequest& request) const;
    // Creates a sampled RGBA8 image with a full mip chain and waits for the upload. Rows start at
    // the top.
    Image createTexture(uint32_t width, uint32_t height, const uint8_t* rgba, bool srgb) const;
    // Creates a texture of any format with 4 bytes per texel and `request.mips` mips. Sets the
    // usage itself.
    Image createTexture(ImageRequest request, const uint8_t* texels) const;
    void destroy(Image& image) const;

    VkSampler createSampler(VkFilter filter, VkSamplerAddressMode address,
                            VkSamplerMipmapMode mips = VK_SAMPLER_MIPMAP_MODE_LINEAR) const;
    VkShaderModule createShader(const uint32_t* words, size_t bytes) const;

    // Records, submits and waits. Use it for set-up only.
    template <typename Body>
    void runNow(Body&& body) const {
        VkCommandBuffer commands = beginNow();
        body(commands);
        endNow(commands);
    }

    uint32_t memoryType(uint32_t allowedTypes, VkMemoryPropertyFlags wanted) const;
    // Returns D32_SFLOAT if the device can render to it, otherwise a packed depth format.
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

// Records one barrier over `mips` mips of a colour image, starting at `firstMip`.
void imageBarrier(VkCommandBuffer commands, VkImage image, VkImageLayout before,
                  VkImageLayout after, VkPipelineStageFlags stageBefore, VkAccessFlags accessBefore,
                  VkPipelineStageFlags stageAfter, VkAccessFlags accessAfter, uint32_t firstMip = 0,
                  uint32_t mips = VK_REMAINING_MIP_LEVELS);

}  // namespace sample
