// Runs single compute passes on a device: host-visible buffers, one descriptor set, a barrier after
// every dispatch. Compares a pass with the library's code.
#pragma once
#include "support/vulkan_device.h"

#include "embedded_shaders.h"
#include "gpu/passes/pass.h"
#include "shared/burn.h"

#include <algorithm>
#include <cstring>
#include <span>

namespace fw::test {

class PassRig {
 public:
    // `bindings`: bound by the passes; each needs a buffer from `make` before the first dispatch.
    // `texels`: those read as texel buffers; `uniforms`: those that are uniform blocks.
    PassRig(TestDevice& device, std::span<const uint32_t> bindings, uint32_t pushBytes,
            std::span<const uint32_t> texels = {}, std::span<const uint32_t> uniforms = {})
        : device_(device),
          pushBytes_(pushBytes),
          texels_(texels.begin(), texels.end()),
          uniforms_(uniforms.begin(), uniforms.end()) {
        makeLayouts(bindings);
    }
    ~PassRig() {
        for (VkBufferView v : views_) vkDestroyBufferView(device_.device, v, nullptr);
        for (VkPipeline p : pipelines_) vkDestroyPipeline(device_.device, p, nullptr);
        vkDestroyDescriptorPool(device_.device, pool_, nullptr);
        vkDestroyPipelineLayout(device_.device, layout_, nullptr);
        vkDestroyDescriptorSetLayout(device_.device, setLayout_, nullptr);
    }
    PassRig(const PassRig&) = delete;
    PassRig& operator=(const PassRig&) = delete;

    template <typename T>
    [[nodiscard]] std::span<T> of(uint32_t binding) const {
        return {static_cast<T*>(data_[binding]), size_t(sizes_[binding]) / sizeof(T)};
    }

    void make(uint32_t binding, size_t bytes, const void* content = nullptr) {
        const TestBuffer made = device_.makeBuffer(
            bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT |
                       VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
        data_[binding] = made.mapped;
        sizes_[binding] = bytes;
        std::memset(data_[binding], 0, bytes);
        if (content != nullptr) std::memcpy(data_[binding], content, bytes);
        const VkDescriptorBufferInfo buffer{made.buffer, 0, VK_WHOLE_SIZE};
        VkWriteDescriptorSet write{};
        write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
        write.dstSet = set_;
        write.dstBinding = binding;
        write.descriptorCount = 1;
        write.descriptorType = typeOf(binding);
        write.pBufferInfo = &buffer;
        vkUpdateDescriptorSets(device_.device, 1, &write, 0, nullptr);
        if (std::find(texels_.begin(), texels_.end(), binding) == texels_.end()) return;
        VkBufferViewCreateInfo view{};
        view.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO;
        view.buffer = made.buffer;
        view.format = VK_FORMAT_R32G32B32A32_UINT;
        view.range = VK_WHOLE_SIZE;
        views_.push_back(VK_NULL_HANDLE);
        must(vkCreateBufferView(device_.device, &view, nullptr, &views_.back()));
        write.dstBinding = gpu::texelBinding(binding);
        write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
        write.pTexelBufferView = &views_.back();
        vkUpdateDescriptorSets(device_.device, 1, &write, 0, nullptr);
    }

    // Returns an index for dispatch.
    uint32_t add(const char* name) {
        pipelines_.push_back(makePipeline(name));
        return uint32_t(pipelines_.size() - 1);
    }

    void begin(VkCommandBuffer commands) const {
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_, 0, 1, &set_, 0,
                                nullptr);
    }
    void dispatch(VkCommandBuffer commands, uint32_t pipeline, const void* push,
                  uint32_t groups) const {
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipelines_[pipeline]);
        vkCmdPushConstants(commands, layout_, VK_SHADER_STAGE_COMPUTE_BIT, 0, pushBytes_, push);
        vkCmdDispatch(commands, groups, 1, 1);
        VkMemoryBarrier barrier{};
        barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
        barrier.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT;
        barrier.dstAccessMask =
            VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_HOST_READ_BIT;
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                             VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_HOST_BIT, 0,
                             1, &barrier, 0, nullptr, 0, nullptr);
    }

 private:
    [[nodiscard]] VkDescriptorType typeOf(uint32_t binding) const {
        const bool uniform =
            std::find(uniforms_.begin(), uniforms_.end(), binding) != uniforms_.end();
        return uniform ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    }
    void must(VkResult result) { ASSERT_EQ(VK_SUCCESS, result); }

    void makeLayouts(std::span<const uint32_t> used) {
        const auto count = uint32_t(used.size());
        std::vector<VkDescriptorSetLayoutBinding> bindings;
        for (const uint32_t binding : used)
            bindings.push_back({binding, typeOf(binding), 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
        for (const uint32_t binding : texels_)
            bindings.push_back({gpu::texelBinding(binding), VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER,
                                1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
        VkDescriptorSetLayoutCreateInfo set{};
        set.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
        set.bindingCount = uint32_t(bindings.size());
        set.pBindings = bindings.data();
        must(vkCreateDescriptorSetLayout(device_.device, &set, nullptr, &setLayout_));
        const VkPushConstantRange push{VK_SHADER_STAGE_COMPUTE_BIT, 0, pushBytes_};
        VkPipelineLayoutCreateInfo layout{};
        layout.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
        layout.setLayoutCount = 1;
        layout.pSetLayouts = &setLayout_;
        layout.pushConstantRangeCount = 1;
        layout.pPushConstantRanges = &push;
        must(vkCreatePipelineLayout(device_.device, &layout, nullptr, &layout_));
        const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, count},
                                              {VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, count},
                                              {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, count}};
        VkDescriptorPoolCreateInfo pool{};
        pool.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
        pool.maxSets = 1;
        pool.poolSizeCount = 3;
        pool.pPoolSizes = sizes;
        must(vkCreateDescriptorPool(device_.device, &pool, nullptr, &pool_));
        VkDescriptorSetAllocateInfo allocate{};
        allocate.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
        allocate.descriptorPool = pool_;
        allocate.descriptorSetCount = 1;
        allocate.pSetLayouts = &setLayout_;
        must(vkAllocateDescriptorSets(device_.device, &allocate, &set_));
    }

    VkPipeline makePipeline(const char* name) {
        const gpu::ShaderCode* code = gpu::findShader(name);
        if (code == nullptr) {
            ADD_FAILURE() << name << " is not embedded";
            return VK_NULL_HANDLE;
        }
        VkShaderModuleCreateInfo module{};
        module.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
        module.codeSize = code->words.size_bytes();
        module.pCode = code->words.data();
        VkComputePipelineCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
        info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
        info.stage.pName = "main";
        info.layout = layout_;
        must(vkCreateShaderModule(device_.device, &module, nullptr, &info.stage.module));
        VkPipeline pipeline = VK_NULL_HANDLE;
        must(
            vkCreateComputePipelines(device_.device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline));
        vkDestroyShaderModule(device_.device, info.stage.module, nullptr);
        return pipeline;
    }

    TestDevice& device_;
    uint32_t pushBytes_;
    VkDescriptorSetLayout setLayout_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
    std::vector<VkPipeline> pipelines_;
    std::vector<uint32_t> texels_, uniforms_;
    std::vector<VkBufferView> views_;
    void* data_[FW_BIND_COUNT] = {};
    size_t sizes_[FW_BIND_COUNT] = {};
};

}  // namespace fw::test
