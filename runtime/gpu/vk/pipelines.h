// Set layouts, pipeline layouts and pipelines of all passes. Compute pipelines are built by
// prepare, graphics pipelines per registered target: all of them then, or with FW_TARGET_AS_NEEDED
// some as what they draw is made; none while recording. Shared by the worlds of a context.
#pragma once
#include "core/handle_pool.h"
#include "core/owned.h"
#include "gpu/passes/shader_interface.h"
#include "gpu/vk/device.h"

#include <array>
#include <atomic>
#include <span>
#include <vector>

namespace fw::gpu::vk {

struct PassObjects {
    ShaderInterface declared;
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkPipeline pipeline = VK_NULL_HANDLE;  // compute
};

struct DescriptorSlot {
    uint32_t binding = 0;
    VkDescriptorType type{};
};
[[nodiscard]] constexpr DescriptorSlot descriptorSlot(const Use& use) noexcept {
    if (use.access == Access::readTexels)
        return {texelBinding(use.resource), VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER};
    return {use.resource, isDynamic(use.resource) ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC
                          : use.access == Access::uniform ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER
                                                          : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
}

// The properties of a target that decide its pipelines.
struct TargetKey {
    VkFormat color = VK_FORMAT_UNDEFINED, depth = VK_FORMAT_UNDEFINED;
    uint32_t subpass = 0, samples = 1, colorAttachments = 1;
    uint32_t depthSamples = 1;  // of a sampled depth
    FwDepthMode depthMode = FW_DEPTH_NONE;
    bool surfaces = true, flames = true;
    bool reversedDepth = false, composite = false, haze = false;
    bool transparency = false;  // frames may be transparent
    bool half = false;          // soft effects are drawn at half resolution
    bool asNeeded = false;
    VkFormat halfColor = VK_FORMAT_UNDEFINED;
    FwOutputEncoding encoding = FW_OUTPUT_LINEAR;
    [[nodiscard]] bool samplesDepth() const noexcept { return depthMode == FW_DEPTH_SAMPLED; }
    [[nodiscard]] bool attachesDepth() const noexcept {
        return depthMode != FW_DEPTH_NONE && !samplesDepth();
    }
};

struct Target {
    TargetKey key;
    VkRenderPass ownPass = VK_NULL_HANDLE;   // composite
    VkRenderPass hostPass = VK_NULL_HANDLE;  // else; with asNeeded alone it may be used again
    // By draw pass; null: not drawn here, or not needed yet. Worlds draw while others need more.
    std::pmr::vector<std::atomic<VkPipeline>> pipelines;
    std::atomic<uint32_t> made{0}, total{0};  // of them: there now, and needed
    Target(size_t passes, std::pmr::memory_resource* memory) : pipelines(passes, memory) {}
};

class Pipelines {
 public:
    Pipelines(Device& device, std::pmr::memory_resource* memory);
    ~Pipelines();
    Pipelines(const Pipelines&) = delete;
    Pipelines& operator=(const Pipelines&) = delete;

    void prepare();  // [any]
    [[nodiscard]] bool ready() const noexcept { return ready_.load(std::memory_order_acquire); }

    FwTargetId registerTarget(const FwVulkanTargetDef& def);  // [any]
    void unregisterTarget(FwTargetId id);                     // [any]
    // From here on all targets have the pipelines of these passes, or it throws. Of the passes that
    // wait for it: with FW_TARGET_AS_NEEDED those that draw surfaces.
    void need(DrawPassSet passes);  // [any]
    // As fwTarget_IsReady. Throws FW_ERROR_STALE_ID.
    bool targetReady(FwTargetId id, FwPipelineProgress& progress);  // [any]
    // Throws FW_ERROR_STALE_ID. The pointer is good until the target is unregistered.
    const Target* findTarget(FwTargetId id);               // [any]
    [[nodiscard]] bool isTarget(FwTargetId id) noexcept {  // [any]
        const std::lock_guard lock(mutex_);
        return targets_.find(id) != nullptr;
    }

    // All passes: of computePasses(), then of drawPasses().
    [[nodiscard]] std::span<const PassObjects> passes() const { return passes_; }
    [[nodiscard]] const PassObjects& compute(size_t pass) const { return passes_[pass]; }
    [[nodiscard]] const PassObjects& draw(size_t pass) const {
        return passes_[computePasses().size() + pass];
    }
    [[nodiscard]] VkDescriptorSetLayout imageSetLayout() const { return imageLayout_; }
    [[nodiscard]] VkSampler imageSampler() const { return imageSampler_; }
    [[nodiscard]] VkSampler depthSampler() const { return depthSampler_; }
    // Over images of half resolution (HalfImages): colour, which is cleared; depth, which is kept.
    // Both leave them ready for our shaders.
    [[nodiscard]] VkRenderPass halfPass(VkFormat color) const;
    [[nodiscard]] VkRenderPass halfDepthPass() const { return halfDepthPass_; }
    // An image that ends at 1 loses brighter light before smoke covers it. The image of half
    // resolution ends where its target does, or it would be brighter.
    static constexpr std::array kHalfColors{VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R8G8B8A8_SRGB,
                                            VK_FORMAT_R8G8B8A8_UNORM};
    static constexpr VkFormat kHalfDepth = VK_FORMAT_R32_SFLOAT;

 private:
    void makeLayouts();
    class Modules;  // of the pipelines that are made together
    VkShaderModule module(std::span<const uint32_t> code) const;
    VkRenderPass makePass(const TargetKey& key) const;
    VkRenderPass makeHalfPass(VkFormat format, bool clears) const;
    VkPipeline makeDraw(size_t pass, const TargetKey& key, VkRenderPass renderPass,
                        Modules& modules) const;
    void makePipelines(Target& target, DrawPassSet passes);
    void makeDue(Target& target, DrawPassSet due, VkRenderPass renderPass, Modules& modules);
    void destroyTarget(Target& target) noexcept;
    void destroy() noexcept;

    Device& device_;
    std::pmr::memory_resource* memory_;
    std::pmr::vector<PassObjects> passes_;
    VkDescriptorSetLayout imageLayout_ = VK_NULL_HANDLE;
    VkSampler imageSampler_ = VK_NULL_HANDLE, depthSampler_ = VK_NULL_HANDLE;
    std::array<VkRenderPass, kHalfColors.size()> halfPasses_{};
    VkRenderPass halfDepthPass_ = VK_NULL_HANDLE;
    std::mutex prepares_;  // of compute pipelines, until ready_
    std::atomic<uint32_t> computeMade_{0};
    std::atomic<uint32_t> drawMade_{0}, drawTotal_{0};  // of all targets, those being made included
    std::mutex makes_;  // taken before mutex_, to make targets or their pipelines
    std::atomic<DrawPassSet> needed_{0};
    std::mutex mutex_;  // of what follows; held for no longer than a record call may wait
    core::HandlePool<FwTargetId, core::Owned<Target>> targets_;
    std::atomic<bool> ready_{false};
};

}  // namespace fw::gpu::vk
