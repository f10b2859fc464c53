#include "gpu/vk/descriptors.h"

#include "gpu/passes/frame_graph.h"
#include "shared/volume_draw.h"

#include <array>

namespace fw::gpu::vk {

PassSets::~PassSets() {
    device_.table.DestroyDescriptorPool(device_.handle, pool_, device_.allocationCallbacks);
}

void PassSets::write(VkDescriptorSet set, std::span<const Use> uses, const Planes& planes,
                     VkBuffer views, VkDeviceSize viewBytes) const {
    std::array<VkDescriptorBufferInfo, 2 * FW_BIND_COUNT> infos{};
    std::array<VkWriteDescriptorSet, 2 * FW_BIND_COUNT> writes{};
    uint32_t count = 0;
    std::array<bool, 2 * FW_BIND_COUNT> seen{};
    for (const Use& use : uses) {
        const bool texels = device_.texels && byTexels(use.access);
        const uint32_t number = texels ? texelBinding(use.resource) : use.resource;
        if (use.resource >= FW_BIND_COUNT || seen[number]) continue;
        if (use.access == Access::indirect || use.access == Access::copyRead ||
            use.access == Access::copyWrite || use.access == Access::vertexInput)
            continue;
        seen[number] = true;
        const bool view = use.resource == FW_BIND_VIEW;
        const bool each = use.access == Access::drawEach || use.access == Access::each;
        infos[count] = view ? VkDescriptorBufferInfo{views, 0, viewBytes}
                            : VkDescriptorBufferInfo{planes.buffer(use.resource).handle, 0,
                                                     each ? kVolumeFlameBytes : VK_WHOLE_SIZE};
        VkWriteDescriptorSet& one = writes[count];
        one.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
        one.dstSet = set;
        one.dstBinding = number;
        one.descriptorCount = 1;
        one.descriptorType = view || each ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC
                             : use.access == Access::drawUniform ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER
                             : texels ? VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER
                                      : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        if (texels)
            one.pTexelBufferView = &planes.buffer(use.resource).texels;
        else
            one.pBufferInfo = &infos[count];
        ++count;
    }
    device_.table.UpdateDescriptorSets(device_.handle, count, writes.data(), 0, nullptr);
}

void PassSets::update(const Planes& planes, VkBuffer views, VkDeviceSize viewBytes,
                      uint64_t lastFrame) {
    if (generation_ == planes.generation()) return;
    const size_t computeCount = computePasses().size(), drawCount = drawPasses().size();
    compute_.resize(computeCount);
    draw_.resize(drawCount);
    retired_.promise(1);
    uint32_t storage = 0, uniform = 0, view = 0, texels = 0;
    const auto add = [&](std::span<const Use> uses) {
        for (const Use& use : uses)
            ++(use.resource == FW_BIND_VIEW || use.resource == FW_BIND_VOLUMES ? view
               : use.access == Access::drawUniform                             ? uniform
               : device_.texels && byTexels(use.access)                        ? texels
                                                                               : storage);
    };
    for (const ComputePass* pass : computePasses()) add(pass->uses);
    for (const DrawPass* pass : drawPasses()) add(pass->uses);
    const auto sets = uint32_t(computeCount + drawCount);
    const std::array<VkDescriptorPoolSize, 4> sizes{
        {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, storage + 1},
         {VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, texels + 1},
         {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, uniform + 1},
         {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, view + 1}}};
    auto info = typed<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    info.maxSets = sets;
    info.poolSizeCount = uint32_t(sizes.size());
    info.pPoolSizes = sizes.data();
    VkDescriptorPool pool = VK_NULL_HANDLE;
    device_.check(device_.table.CreateDescriptorPool(device_.handle, &info,
                                                     device_.allocationCallbacks, &pool),
                  "vkCreateDescriptorPool");
    std::array<VkDescriptorSetLayout, 128> layouts{};
    std::array<VkDescriptorSet, 128> made{};
    for (size_t i = 0; i < computeCount; ++i) layouts[i] = pipelines_.compute(i).setLayout;
    for (size_t i = 0; i < drawCount; ++i) layouts[computeCount + i] = pipelines_.draw(i).setLayout;
    auto allocate =
        typed<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    allocate.descriptorPool = pool;
    allocate.descriptorSetCount = sets;
    allocate.pSetLayouts = layouts.data();
    const VkResult result =
        device_.table.AllocateDescriptorSets(device_.handle, &allocate, made.data());
    if (result != VK_SUCCESS) {
        device_.table.DestroyDescriptorPool(device_.handle, pool, device_.allocationCallbacks);
        device_.check(result, "vkAllocateDescriptorSets");
    }
    retired_.push(lastFrame, pool_);
    pool_ = pool;
    for (size_t i = 0; i < computeCount; ++i) {
        compute_[i] = made[i];
        write(compute_[i], computePasses()[i]->uses, planes, views, viewBytes);
    }
    for (size_t i = 0; i < drawCount; ++i) {
        draw_[i] = made[computeCount + i];
        write(draw_[i], drawPasses()[i]->uses, planes, views, viewBytes);
    }
    generation_ = planes.generation();
}

ImageSet makeImageSet(Device& device, const Pipelines& pipelines, VkImageView view,
                      VkSampler sampler) {
    ImageSet out;
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1};
    auto info = typed<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    info.maxSets = 1;
    info.poolSizeCount = 1;
    info.pPoolSizes = &size;
    device.check(device.table.CreateDescriptorPool(device.handle, &info, device.allocationCallbacks,
                                                   &out.pool),
                 "vkCreateDescriptorPool");
    auto allocate =
        typed<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    const VkDescriptorSetLayout layout = pipelines.imageSetLayout();
    allocate.descriptorPool = out.pool;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &layout;
    const VkResult result = device.table.AllocateDescriptorSets(device.handle, &allocate, &out.set);
    if (result != VK_SUCCESS) {
        device.table.DestroyDescriptorPool(device.handle, out.pool, device.allocationCallbacks);
        device.check(result, "vkAllocateDescriptorSets");
    }
    const VkDescriptorImageInfo image{sampler ? sampler : pipelines.imageSampler(), view,
                                      VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    auto write = typed<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
    write.dstSet = out.set;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    write.pImageInfo = &image;
    device.table.UpdateDescriptorSets(device.handle, 1, &write, 0, nullptr);
    return out;
}

}  // namespace fw::gpu::vk
