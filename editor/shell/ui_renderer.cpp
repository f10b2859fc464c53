// See ui_renderer.h.
#include "shell/ui_renderer.h"

#include <imgui.h>

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "common/pipeline.h"

namespace fwui {
namespace {

#include "ui.frag.h"
#include "ui.vert.h"

constexpr uint32_t kMostTextures = 128;

struct Push {
    float scale[2], shift[2];
};

}  // namespace

UiRenderer::UiRenderer(const sample::VulkanHost& host, VkRenderPass pass, uint32_t slots)
    : host_(host), slots_(slots) {
    sampler_ = host.createSampler(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                  VK_SAMPLER_MIPMAP_MODE_NEAREST);
    setLayout_ = sample::makeSetLayout(host, {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER});
    pool_ = sample::makeSetPool(host, kMostTextures, 0, kMostTextures);
    for (uint32_t i = 0; i < kMostTextures; ++i)
        free_.push_back(sample::makeSet(host, pool_, setLayout_));
    layout_ = sample::makeLayout(host, {setLayout_}, {VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(Push)});

    sample::PipelineRequest request;
    request.pass = pass;
    request.layout = layout_;
    request.vertex = host.createShader(kUiVert, sizeof kUiVert);
    request.fragment = host.createShader(kUiFrag, sizeof kUiFrag);
    request.bindings = {{0, sizeof(ImDrawVert), VK_VERTEX_INPUT_RATE_VERTEX}};
    request.attributes = {{0, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(ImDrawVert, pos)},
                          {1, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(ImDrawVert, uv)},
                          {2, 0, VK_FORMAT_R8G8B8A8_UNORM, offsetof(ImDrawVert, col)}};
    request.depthTest = request.depthWrite = false;
    request.blend = true;
    pipeline_ = sample::makePipeline(host, request);
    vkDestroyShaderModule(host.device, request.vertex, nullptr);
    vkDestroyShaderModule(host.device, request.fragment, nullptr);

    ImGuiIO& io = ImGui::GetIO();
    io.BackendRendererName = "flamewright";
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
}

UiRenderer::~UiRenderer() {
    vkDeviceWaitIdle(host_.device);
    for (Slot& slot : slots_) {
        host_.destroy(slot.vertices);
        host_.destroy(slot.indices);
    }
    host_.destroy(fonts_);
    vkDestroyPipeline(host_.device, pipeline_, nullptr);
    vkDestroyPipelineLayout(host_.device, layout_, nullptr);
    vkDestroyDescriptorPool(host_.device, pool_, nullptr);
    vkDestroyDescriptorSetLayout(host_.device, setLayout_, nullptr);
    vkDestroySampler(host_.device, sampler_, nullptr);
}

void UiRenderer::uploadFonts() {
    sample::checkVulkan(vkDeviceWaitIdle(host_.device), "vkDeviceWaitIdle");
    if (fontTexture_) removeTexture(fontTexture_);
    host_.destroy(fonts_);
    ImFontAtlas* atlas = ImGui::GetIO().Fonts;
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    atlas->GetTexDataAsRGBA32(&pixels, &width, &height);
    fonts_ = host_.createTexture(uint32_t(width), uint32_t(height), pixels, false);
    fontTexture_ = addTexture(fonts_.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    atlas->SetTexID(fontTexture_);
    atlas->ClearTexData();
}

void* UiRenderer::addTexture(VkImageView view, VkImageLayout layout) {
    if (free_.empty()) return nullptr;
    VkDescriptorSet set = free_.back();
    free_.pop_back();
    sample::writeImage(host_, set, 0, sampler_, view, layout);
    return reinterpret_cast<void*>(set);
}

void UiRenderer::removeTexture(void* texture) {
    if (texture) free_.push_back(reinterpret_cast<VkDescriptorSet>(texture));
}

void UiRenderer::reserve(sample::Buffer& buffer, VkDeviceSize size, VkBufferUsageFlags usage) {
    if (buffer.size >= size) return;
    host_.destroy(buffer);  // its slot's last frame is done
    buffer = host_.createBuffer(size + size / 2, usage, true);
}

void UiRenderer::draw(VkCommandBuffer commands, uint32_t slotIndex, const ImDrawData& data) {
    if (data.TotalVtxCount == 0) return;
    Slot& slot = slots_[slotIndex];
    reserve(slot.vertices, size_t(data.TotalVtxCount) * sizeof(ImDrawVert),
            VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    reserve(slot.indices, size_t(data.TotalIdxCount) * sizeof(ImDrawIdx),
            VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    auto* vertices = static_cast<ImDrawVert*>(slot.vertices.mapped);
    auto* indices = static_cast<ImDrawIdx*>(slot.indices.mapped);
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        std::memcpy(vertices, list.VtxBuffer.Data, size_t(list.VtxBuffer.size_in_bytes()));
        std::memcpy(indices, list.IdxBuffer.Data, size_t(list.IdxBuffer.size_in_bytes()));
        vertices += list.VtxBuffer.Size;
        indices += list.IdxBuffer.Size;
    }

    const ImVec2 size = data.DisplaySize;
    const VkViewport viewport{0, 0, size.x, size.y, 0, 1};
    const Push push{{2 / size.x, 2 / size.y},
                    {-1 - data.DisplayPos.x * 2 / size.x, -1 - data.DisplayPos.y * 2 / size.y}};
    const VkDeviceSize zero = 0;
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_);
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdBindVertexBuffers(commands, 0, 1, &slot.vertices.buffer, &zero);
    vkCmdBindIndexBuffer(commands, slot.indices.buffer, 0,
                         sizeof(ImDrawIdx) == 2 ? VK_INDEX_TYPE_UINT16 : VK_INDEX_TYPE_UINT32);
    vkCmdPushConstants(commands, layout_, VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof push, &push);

    uint32_t firstIndex = 0;
    int32_t firstVertex = 0;
    void* bound = nullptr;
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        for (const ImDrawCmd& command : list.CmdBuffer) {
            const float x0 = std::clamp(command.ClipRect.x - data.DisplayPos.x, 0.0f, size.x);
            const float y0 = std::clamp(command.ClipRect.y - data.DisplayPos.y, 0.0f, size.y);
            const float x1 = std::clamp(command.ClipRect.z - data.DisplayPos.x, 0.0f, size.x);
            const float y1 = std::clamp(command.ClipRect.w - data.DisplayPos.y, 0.0f, size.y);
            if (x1 <= x0 || y1 <= y0 || command.ElemCount == 0) continue;
            const VkRect2D scissor{{int32_t(x0), int32_t(y0)},
                                   {uint32_t(x1 - x0), uint32_t(y1 - y0)}};
            vkCmdSetScissor(commands, 0, 1, &scissor);
            if (void* texture = command.GetTexID(); texture != bound) {
                auto set = reinterpret_cast<VkDescriptorSet>(texture);
                vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, 1,
                                        &set, 0, nullptr);
                bound = texture;
            }
            vkCmdDrawIndexed(commands, command.ElemCount, 1, firstIndex + command.IdxOffset,
                             firstVertex + int32_t(command.VtxOffset), 0);
        }
        firstIndex += uint32_t(list.IdxBuffer.Size);
        firstVertex += list.VtxBuffer.Size;
    }
}

}  // namespace fwui
