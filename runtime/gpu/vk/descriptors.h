// Descriptor sets: one per pass for a generation of the world's buffers, rebuilt when a buffer is
// another one; and one per image. Never touched while recording a steady frame.
#pragma once
#include "gpu/vk/pipelines.h"
#include "gpu/vk/world_buffers.h"

namespace fw::gpu::vk {

class PassSets {
 public:
    PassSets(Device& device, const Pipelines& pipelines, RetireQueue& retired,
             std::pmr::memory_resource* memory);
    ~PassSets();
    PassSets(const PassSets&) = delete;
    PassSets& operator=(const PassSets&) = delete;

    // Makes new sets for view `view` if the buffers changed since; the old ones go when frame
    // `lastFrame` is done. Of views beyond the first only passes of views have their own.
    void update(const WorldBuffers& buffers, VkBuffer views, VkDeviceSize viewBytes,
                uint64_t lastFrame, uint32_t view = 0);
    // The sets of a view beyond the first go when frame `lastFrame` is done. May throw, and then
    // did nothing.
    void drop(uint32_t view, uint64_t lastFrame);
    [[nodiscard]] bool has(uint32_t view) const noexcept { return views_[view].generation != 0; }
    // Null before the first update.
    [[nodiscard]] VkDescriptorSet compute(size_t pass, uint32_t view) const;
    [[nodiscard]] VkDescriptorSet draw(size_t pass, uint32_t view) const {
        return compute(computePasses().size() + pass, view);
    }

 private:
    struct OfView {
        explicit OfView(std::pmr::memory_resource* memory) : sets(memory) {}
        VkDescriptorPool pool = VK_NULL_HANDLE;
        uint64_t generation = 0;                 // of the buffers; 0: there are no sets
        std::pmr::vector<VkDescriptorSet> sets;  // as Pipelines::passes; null: the first view's
    };
    void write(VkDescriptorSet set, std::span<const Use> uses, const WorldBuffers& buffers,
               VkBuffer views, VkDeviceSize viewBytes, uint32_t view) const;

    Device& device_;
    const Pipelines& pipelines_;
    RetireQueue& retired_;
    std::pmr::vector<OfView> views_;
};

// A set with one combined image sampler, in a pool of its own.
struct ImageSet {
    VkDescriptorPool pool = VK_NULL_HANDLE;
    VkDescriptorSet set = VK_NULL_HANDLE;
};
// `sampler`: null for that of images with mips.
ImageSet makeImageSet(Device& device, const Pipelines& pipelines, VkImageView view,
                      VkSampler sampler = VK_NULL_HANDLE);

}  // namespace fw::gpu::vk
