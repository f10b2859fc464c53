#include "gpu/vk/descriptors.h"

#include "core/assert.h"
#include "gpu/vk/device_objects.h"
#include "shared/volume_draw.h"

#include <array>
#include <utility>

namespace fw::gpu::vk {

PassSets::PassSets(Device& device, const Pipelines& pipelines, RetireQueue& retired,
                   std::pmr::memory_resource* memory)
    : device_(device), pipelines_(pipelines), retired_(retired), views_(memory) {
    views_.reserve(kMaxViews);
    for (uint32_t view = 0; view < kMaxViews; ++view) views_.emplace_back(memory);
}

PassSets::~PassSets() {
    for (OfView& one : views_) device_.destroy(device_.table.DestroyDescriptorPool, one.pool);
}

VkDescriptorSet PassSets::compute(size_t pass, uint32_t view) const {
    const auto setOf = [pass](const OfView& one) {
        return pass < one.sets.size() ? one.sets[pass] : VkDescriptorSet(VK_NULL_HANDLE);
    };
    const VkDescriptorSet own = setOf(views_[view]);
    return own ? own : setOf(views_[0]);
}

void PassSets::drop(uint32_t view, uint64_t lastFrame) {
    OfView& of = views_[view];
    if (!of.pool) return;
    retired_.promise(1);
    retired_.push(lastFrame, {.pool = std::exchange(of.pool, VK_NULL_HANDLE)});
    of.generation = 0;
    of.sets.clear();
}

void PassSets::write(VkDescriptorSet set, std::span<const Use> uses, const WorldBuffers& buffers,
                     VkBuffer views, VkDeviceSize viewBytes, uint32_t of) const {
    std::array<VkDescriptorBufferInfo, ShaderInterface::kMost> infos{};
    std::array<VkWriteDescriptorSet, ShaderInterface::kMost> writes{};
    uint32_t count = 0;
    for (const Use& use : uses) {
        const DescriptorSlot slot = descriptorSlot(use);
        const bool texels = slot.type == VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
        const Buffer& buffer = buffers.buffer(resourceOf(use.resource, of));
        FW_ASSERT(buffer.handle || use.resource == FW_BIND_VIEW, "resource %u", use.resource);
        infos[count] = use.resource == FW_BIND_VIEW
                           ? VkDescriptorBufferInfo{views, 0, viewBytes}
                           : VkDescriptorBufferInfo{
                                 buffer.handle, 0,
                                 isDynamic(use.resource) ? kVolumeFlameBytes : VK_WHOLE_SIZE};
        VkWriteDescriptorSet& one = writes[count];
        one.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
        one.dstSet = set;
        one.dstBinding = slot.binding;
        one.descriptorCount = 1;
        one.descriptorType = slot.type;
        if (texels)
            one.pTexelBufferView = &buffer.texels;
        else
            one.pBufferInfo = &infos[count];
        ++count;
    }
    device_.table.UpdateDescriptorSets(device_.handle, count, writes.data(), 0, nullptr);
}

void PassSets::update(const WorldBuffers& buffers, VkBuffer views, VkDeviceSize viewBytes,
                      uint64_t lastFrame, uint32_t view) {
    OfView& of = views_[view];
    if (of.generation == buffers.generation()) return;
    const std::span<const PassObjects> passes = pipelines_.passes();
    of.sets.resize(passes.size());
    retired_.promise(1);
    constexpr size_t kMostSets = 128;
    FW_ASSERT(passes.size() <= kMostSets, "%zu passes", passes.size());
    std::array<VkDescriptorSetLayout, kMostSets> layouts{};
    std::array<VkDescriptorSet, kMostSets> made{};
    std::array<size_t, kMostSets> numbers{};
    uint32_t sets = 0;
    for (size_t i = 0; i < passes.size(); ++i) {
        if (view > 0 && !passes[i].declared.isPerView()) continue;
        numbers[sets] = i;
        layouts[sets++] = passes[i].setLayout;
    }
    std::array<VkDescriptorPoolSize, 4> sizes{{{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1},
                                               {VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, 1},
                                               {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1},
                                               {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, 1}}};
    for (uint32_t i = 0; i < sets; ++i)
        for (const Use& use : passes[numbers[i]].declared.uses())
            for (VkDescriptorPoolSize& size : sizes)
                size.descriptorCount += size.type == descriptorSlot(use).type ? 1 : 0;
    const VkDescriptorPool pool =
        makeSets(device_, sizes, std::span(layouts).first(sets), std::span(made).first(sets));
    retired_.push(lastFrame, {.pool = std::exchange(of.pool, pool)});
    for (uint32_t i = 0; i < sets; ++i) {
        of.sets[numbers[i]] = made[i];
        write(made[i], passes[numbers[i]].declared.uses(), buffers, views, viewBytes, view);
    }
    of.generation = buffers.generation();
}

ImageSet makeImageSet(Device& device, const Pipelines& pipelines, VkImageView view,
                      VkSampler sampler) {
    ImageSet out;
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1};
    const VkDescriptorSetLayout layout = pipelines.imageSetLayout();
    out.pool = makeSets(device, {&size, 1}, {&layout, 1}, {&out.set, 1});
    writeImageSet(device, out.set, sampler ? sampler : pipelines.imageSampler(), view,
                  VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    return out;
}

}  // namespace fw::gpu::vk
