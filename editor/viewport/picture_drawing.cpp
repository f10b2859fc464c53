#include "viewport/picture_drawing.h"

namespace fwview {

PictureDrawing::PictureDrawing(const sample::VulkanHost& host, uint32_t sets, uint32_t pictures,
                               const VkPushConstantRange& push)
    : host_(host) {
    constexpr VkDescriptorType kPicture = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    sampler_ = host.createSampler(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                  VK_SAMPLER_MIPMAP_MODE_NEAREST);
    setLayout_ = pictures == 1 ? sample::makeSetLayout(host, {kPicture})
                               : sample::makeSetLayout(host, {kPicture, kPicture});
    const VkDescriptorPoolSize size{kPicture, sets * pictures};
    VkDescriptorPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    info.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
    info.maxSets = sets;
    info.poolSizeCount = 1;
    info.pPoolSizes = &size;
    sample::checkVulkan(vkCreateDescriptorPool(host.device, &info, nullptr, &pool_),
                        "vkCreateDescriptorPool");
    layout_ = sample::makeLayout(host, {setLayout_}, push);
}

PictureDrawing::~PictureDrawing() {
    for (VkPipeline pipeline : pipelines_) vkDestroyPipeline(host_.device, pipeline, nullptr);
    vkDestroyPipelineLayout(host_.device, layout_, nullptr);
    vkDestroyDescriptorPool(host_.device, pool_, nullptr);
    vkDestroyDescriptorSetLayout(host_.device, setLayout_, nullptr);
    vkDestroySampler(host_.device, sampler_, nullptr);
}

VkPipeline PictureDrawing::pipeline(sample::PipelineRequest request) {
    request.layout = layout_;
    return pipelines_.emplace_back(sample::makePipeline(host_, request));
}

VkDescriptorSet PictureDrawing::newSet() const { return sample::makeSet(host_, pool_, setLayout_); }

void PictureDrawing::freeSet(VkDescriptorSet set) const {
    vkFreeDescriptorSets(host_.device, pool_, 1, &set);
}

void PictureDrawing::write(VkDescriptorSet set, uint32_t binding, VkImageView view) const {
    sample::writeImage(host_, set, binding, sampler_, view);
}

}  // namespace fwview
