// A Vulkan that loses its device: a table of entry points that forwards every call up to the n-th
// that returns a VkResult. That call and all later ones return VK_ERROR_DEVICE_LOST. It also counts
// objects that are not destroyed.
#pragma once
#include <vulkan/vulkan_core.h>

#include <array>
#include <atomic>
#include <cstdint>

namespace fw::test {

struct LosingVulkan {
    static constexpr uint32_t kMostCalls = 1 << 16;  // calls whose names are kept
    PFN_vkGetInstanceProcAddr real = nullptr;
    std::atomic<int64_t> loseAt{-1};  // call number; < 0: never
    std::atomic<int64_t> calls{0};    // calls that return a VkResult since `begin`
    std::atomic<bool> lost{false};
    std::atomic<int64_t> live{0};  // objects and memory not destroyed yet
    std::array<const char*, kMostCalls> names{};

    // Counts calls from 0 and keeps slow objects for the next context: an own instance and device,
    // and pipelines in creation order, which is always the same. Until losingDrop.
    std::atomic<bool> keeps{false};
    std::array<size_t, 2> madePipelines{};  // of this context: compute, graphics
    void begin(int64_t at) {
        calls = 0;
        lost = false;
        loseAt = at;
        keeps = true;
        madePipelines = {};
    }
    [[nodiscard]] const char* nameOf(int64_t call) const {
        return call >= 0 && call < kMostCalls ? names[size_t(call)] : "?";
    }
};

extern "C" {
// The table of this process, or of the library that it is in.
__attribute__((visibility("default"))) LosingVulkan* losingVulkan();
// Destroys the kept objects. No context may exist.
__attribute__((visibility("default"))) void losingDrop();
PFN_vkVoidFunction VKAPI_CALL losingEntry(VkInstance instance, const char* name);
}

}  // namespace fw::test
