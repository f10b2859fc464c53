// A Vulkan that loses its device: a table of entry points that passes every call on, until the n-th
// call that gives a VkResult. That one, and all after it, say VK_ERROR_DEVICE_LOST. It also counts
// what is made and not destroyed.
#pragma once
#include <vulkan/vulkan_core.h>

#include <array>
#include <atomic>
#include <cstdint>

namespace fw::test {

struct LosingVulkan {
    static constexpr uint32_t kMostCalls = 1 << 16;  // whose names are kept
    PFN_vkGetInstanceProcAddr real = nullptr;
    std::atomic<int64_t> loseAt{-1};  // number of the call; < 0: never
    std::atomic<int64_t> calls{0};    // that give a VkResult, since `begin`
    std::atomic<bool> lost{false};
    std::atomic<int64_t> live{0};  // objects and memory that are not destroyed yet
    std::array<const char*, kMostCalls> names{};

    // From here on calls count from 0, and what takes long to make is kept from one life of a
    // context to the next: an own instance and device, and pipelines, by the order they are made
    // in, which is always the same. Until losingDrop.
    std::atomic<bool> keeps{false};
    std::array<size_t, 2> madePipelines{};  // of this life: for compute, and for drawing
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
// The one of this process, or of the library that it is in.
__attribute__((visibility("default"))) LosingVulkan* losingVulkan();
// Destroys what was kept; no context is there any more.
__attribute__((visibility("default"))) void losingDrop();
PFN_vkVoidFunction VKAPI_CALL losingEntry(VkInstance instance, const char* name);
}

}  // namespace fw::test
