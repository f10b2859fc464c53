// A host with its own layouts, pipelines and render passes in which everything dynamic is set. A
// world burns in the middle of its picture. Fixture of host_clobber_test.cpp.
#pragma once
#include "support/burn_scene.h"
#include "support/host_context.h"

#include <array>
#include <cstring>

namespace fw::test {

constexpr uint32_t kWidth = 96, kHeight = 64;
constexpr uint32_t kPixels = kWidth * kHeight;
constexpr float kHostDepth = 0.5f;  // nearer than the fire, reversed or not

inline void must(VkResult result, const char* what) { ASSERT_EQ(result, VK_SUCCESS) << what; }
#define FW_MUST(call) must(call, #call)

struct Case {
    uint32_t samples;
    bool reversed, srgb;
    [[nodiscard]] VkFormat format() const {
        return srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM;
    }
};

// One rectangle of the host, in pixels.
struct Rect {
    int32_t x0, y0, x1, y1;
};
// Drawn before and after the library. The first of each stands aside, the second covers the fire,
// the third reaches past the host's scissor.
constexpr Rect kBefore[] = {{8, 8, 24, 56}, {40, 44, 56, 50}, {0, 0, 24, 6}};
constexpr Rect kAfter[] = {{72, 8, 88, 56}, {40, 28, 56, 36}, {16, 20, 84, 26}, {72, 58, 96, 64}};
constexpr VkRect2D kScissorRect{{6, 5}, {84, 54}};
constexpr VkViewport kHostViewport{4, 2, 88, 60, 0, 1};

class HostWithState : public HostContext {
 protected:
    void SetUp() override {
        HostContext::SetUp();
        if (!context_) return;
        ASSERT_EQ(fwContext_Prepare(context_), FW_OK);
        frames_ = std::make_unique<HostFrames>(*device_, 2);
        makeWorld();
        makeLayouts();
    }

    void TearDown() override {
        if (device_) vkDeviceWaitIdle(device_->device);
        destroyContext();
        frames_.reset();
        for (auto drop = cleanup_.rbegin(); drop != cleanup_.rend(); ++drop) (*drop)();
        GpuTest::TearDown();
    }

    // Pipelines and targets of a case, shared by several shots because software devices compile
    // slowly.
    struct Stage {
        VkRenderPass pass = VK_NULL_HANDLE;
        VkPipeline pipeline = VK_NULL_HANDLE;
        VkFramebuffer framebuffer = VK_NULL_HANDLE;
        VkImage resolved = VK_NULL_HANDLE;
        FwTargetId target{};
        bool reversed = false;
    };

    void makeWorld();
    void makeLayouts();
    VkPipelineLayout makeLayout(VkDescriptorType type, VkShaderStageFlags stages, uint32_t push,
                                const TestBuffer (&buffers)[2], VkDescriptorSet (&sets)[2]);
    // Everything dynamic: blend constants, a stencil test that fails for reference 0, and a strict
    // depth test that passes only with bias where kHostDepth is already stored.
    VkPipeline makePipeline(const Case& one, VkRenderPass pass);
    // Colour, depth with stencil, and a resolve with several samples; one pass after another.
    VkRenderPass makePass(const Case& one);
    Stage makeStage(const Case& one);
    VkShaderModule makeModule(const uint32_t* words, size_t bytes);

    // Created once per kind: `make` creates the handle, `drop` is its vkDestroy.
    template <class Handle, class Info>
    Handle made(VkResult(VKAPI_PTR* make)(VkDevice, const Info*, const VkAllocationCallbacks*,
                                          Handle*),
                void(VKAPI_PTR* drop)(VkDevice, Handle, const VkAllocationCallbacks*),
                const Info& info) {
        Handle handle = VK_NULL_HANDLE;
        FW_MUST(make(device_->device, &info, nullptr, &handle));
        cleanup_.emplace_back(
            [device = device_->device, drop, handle] { drop(device, handle, nullptr); });
        return handle;
    }

    template <class T>
    TestBuffer makeBuffer(VkBufferUsageFlags usage, const std::vector<T>& content) {
        const TestBuffer out = device_->makeBuffer(content.size() * sizeof(T), usage);
        std::memcpy(out.mapped, content.data(), content.size() * sizeof(T));
        return out;
    }

    FwWorld* world_ = nullptr;
    std::unique_ptr<HostFrames> frames_;
    std::array<FwView, 2> views_{};  // normal, reversed depth
    VkFormat depthFormat_ = VK_FORMAT_D32_SFLOAT_S8_UINT;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkDescriptorSet sets_[2]{};
    VkBuffer vertices_[4]{}, indices_ = VK_NULL_HANDLE;
    VkQueryPool queries_ = VK_NULL_HANDLE;
    TestBuffer pixels_;
    std::vector<std::function<void()>> cleanup_;
};

}  // namespace fw::test
