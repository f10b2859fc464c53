// Descriptor sets: one per pass for a generation of the world's buffers, made anew when a buffer is
// another one; and one per image. Never touched while recording a steady frame.
#pragma once
#include "gpu/vk/pipelines.h"
#include "gpu/vk/planes.h"

namespace fw::gpu::vk {

class PassSets {
 public:
    PassSets(Device& device, const Pipelines& pipelines, RetireQueue& retired,
             std::pmr::memory_resource* memory)
        : device_(device),
          pipelines_(pipelines),
          retired_(retired),
          compute_(memory),
          draw_(memory) {}
    ~PassSets();
    PassSets(const PassSets&) = delete;
    PassSets& operator=(const PassSets&) = delete;

    // Makes new sets if the planes changed since; the old ones go when frame `lastFrame` is done.
    void update(const Planes& planes, VkBuffer views, VkDeviceSize viewBytes, uint64_t lastFrame);
    [[nodiscard]] VkDescriptorSet compute(size_t pass) const { return compute_[pass]; }
    // Null before the first update.
    [[nodiscard]] VkDescriptorSet draw(size_t pass) const {
        return pass < draw_.size() ? draw_[pass] : VK_NULL_HANDLE;
    }

 private:
    void write(VkDescriptorSet set, std::span<const Use> uses, const Planes& planes, VkBuffer views,
               VkDeviceSize viewBytes) const;

    Device& device_;
    const Pipelines& pipelines_;
    RetireQueue& retired_;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    uint64_t generation_ = 0;
    std::pmr::vector<VkDescriptorSet> compute_, draw_;
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
