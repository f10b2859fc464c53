// A Vulkan device made as a host would: by default API 1.0 without features or extensions.
// FLAMEWRIGHT_API=1.3 runs the same tests on that version with every feature that the library can
// use. Validation and synchronization validation are on; any message fails the test.
#pragma once
#include <gtest/gtest.h>

#include <vulkan/vulkan.h>

#include "flamewright/flamewright_vulkan.h"

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace fw::test {

struct DeviceOptions {
    uint32_t apiVersion = VK_API_VERSION_1_0;
    bool declareDebugUtils = true;  // declares VK_EXT_debug_utils to the library
    bool independentBlend = false;
};

struct TestImage {
    VkImage image = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
};

struct TestBuffer {
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    void* mapped = nullptr;
};

class TestDevice {
 public:
    // Null, with the reason, if there is no device or no validation layer.
    static std::unique_ptr<TestDevice> make(const DeviceOptions& options, std::string& reason);
    ~TestDevice();
    TestDevice(const TestDevice&) = delete;
    TestDevice& operator=(const TestDevice&) = delete;

    [[nodiscard]] FwVulkanHost host() const;
    // Records with `record`, submits and waits.
    void run(const std::function<void(VkCommandBuffer)>& record);
    [[nodiscard]] uint32_t memoryType(uint32_t allowed, VkMemoryPropertyFlags flags) const;
    std::vector<std::string> takeMessages();
    // A 2D image with one mip and layer; lives as long as the device.
    TestImage makeImage(VkFormat format, VkExtent2D extent, uint32_t samples,
                        VkImageUsageFlags usage);
    // A mapped host-visible buffer of undefined content; lives as long as the device.
    TestBuffer makeBuffer(VkDeviceSize bytes, VkBufferUsageFlags usage);

    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    uint32_t queueFamily = 0;
    VkCommandPool pool = VK_NULL_HANDLE;
    VkPhysicalDeviceProperties properties{};
    DeviceOptions options;

 private:
    TestDevice() = default;
    static VKAPI_ATTR VkBool32 VKAPI_CALL listen(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                 VkDebugUtilsMessageTypeFlagsEXT type,
                                                 const VkDebugUtilsMessengerCallbackDataEXT* data,
                                                 void* user);
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    VkPhysicalDeviceFeatures2 features_{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, nullptr, {}};
    std::vector<TestImage> images_;
    std::vector<TestBuffer> buffers_;
    std::mutex mutex_;
    std::vector<std::string> messages_;
};

// A host's frames: several in flight, each with a command buffer and a fence.
class HostFrames {
 public:
    HostFrames(TestDevice& device, uint32_t inFlight);
    ~HostFrames();
    HostFrames(const HostFrames&) = delete;
    HostFrames& operator=(const HostFrames&) = delete;

    // Waits for the slot and begins its command buffer.
    FwVulkanFrame begin(float deltaTime = 0);
    void submit();  // the frame begun last
    void waitAll();
    // A frame struct that says everything is complete, for use after waitAll.
    [[nodiscard]] uint64_t submitted() const { return index_; }

 private:
    struct Slot {
        VkCommandBuffer commands = VK_NULL_HANDLE;
        VkFence fence = VK_NULL_HANDLE;
        uint64_t index = 0;
    };
    TestDevice& device_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    std::vector<Slot> slots_;
    uint64_t index_ = 0, completed_ = 0;
};

// Creates a device, skips without one (with FLAMEWRIGHT_REQUIRE_GPU fails), and fails on messages.
class GpuTest : public ::testing::Test {
 protected:
    void SetUp() override { makeDevice({}); }
    void TearDown() override;
    void makeDevice(const DeviceOptions& options);

    std::unique_ptr<TestDevice> device_;
};

bool gpuRequired();
bool gpuAssisted();  // GPU-assisted validation is on
// Version of devices with default options: 1.0, or FLAMEWRIGHT_API. GPU-assisted: at least 1.1.
uint32_t testApiVersion();

// Counts calls that a steady frame may not make. One instance at a time.
struct VulkanCounts {
    uint64_t submits = 0, waits = 0, memory = 0, maps = 0, pipelines = 0, descriptorPools = 0,
             objects =
                 0;  // objects: buffers, images, views, layouts, modules, passes, framebuffers
    // Commands by use; not part of total.
    uint64_t work = 0;  // dispatches, copies, fills
    uint64_t barriers = 0, draws = 0, passes = 0;
    [[nodiscard]] uint64_t total() const {
        return submits + waits + memory + maps + pipelines + descriptorPools + objects;
    }
};
// Entry point between the library and the loader, to be used in FwVulkanHost.
PFN_vkGetInstanceProcAddr countingEntry();
VulkanCounts takeCounts();  // since the last take

// An entry point that ends storage buffers of this binding one word early. One instance at a time.
constexpr uint32_t kNoBinding = 0xFFFFFFFFu;
PFN_vkGetInstanceProcAddr shorteningEntry(uint32_t binding);
// An entry point whose device has the least texels per buffer that Vulkan allows.
PFN_vkGetInstanceProcAddr fewTexelsEntry();

}  // namespace fw::test
