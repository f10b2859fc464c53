// See ui_renderer.h.
#include "shell/ui_renderer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <utility>

#include "common/pipeline.h"

namespace fwui {
namespace {

#include "ui.frag.h"
#include "ui.vert.h"

constexpr uint32_t kMostTextures = 128;
constexpr uint32_t kClearCorners = 4, kClearIndices = 6;  // geometry that clears a part
constexpr size_t kMostChanges = 12;                       // separate parts to redraw
constexpr float kJoined = 1.3f;  // two parts merge if the union is at most this factor larger

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
    request.blend = false;
    solidPipeline_ = sample::makePipeline(host, request);
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
    vkDestroyPipeline(host_.device, solidPipeline_, nullptr);
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
    // White with coverage in alpha, so the channel order is irrelevant.
    sample::ImageRequest request;
    request.width = uint32_t(width);
    request.height = uint32_t(height);
    request.format = kUiFormat;
    fonts_ = host_.createTexture(request, pixels);
    fontTexture_ = addTexture(fonts_.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    atlas->SetTexID(fontTexture_);
    atlas->ClearTexData();
    before_.clear();  // the texture content changed
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
    host_.destroy(buffer);  // the slot's last frame has finished
    buffer = host_.createBuffer(size + size / 2, usage, true);
}

// ---- changes from the previous frame

void UiRenderer::addChange(Part part) {
    if (part.x0 >= part.x1 || part.y0 >= part.y1) return;
    const auto area = [](const Part& p) { return float(p.x1 - p.x0) * float(p.y1 - p.y0); };
    const auto both = [](const Part& a, const Part& b) {
        return Part{std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1),
                    std::max(a.y1, b.y1)};
    };
    // A part that grew may overlap others.
    for (size_t i = 0; i < changes_.size();) {
        const Part joined = both(changes_[i], part);
        if (area(joined) > kJoined * (area(changes_[i]) + area(part))) {
            ++i;
            continue;
        }
        part = joined;
        changes_.erase(changes_.begin() + ptrdiff_t(i));
        i = 0;
    }
    if (changes_.size() < kMostChanges) {
        changes_.push_back(part);
        return;
    }
    const auto growth = [&](const Part& at) { return area(both(at, part)) - area(at); };
    Part& least =
        *std::min_element(changes_.begin(), changes_.end(),
                          [&](const Part& a, const Part& b) { return growth(a) < growth(b); });
    least = both(least, part);
}

// The bounds of a triangle, clipped to the command's rectangle.
UiRenderer::Part UiRenderer::boundsOf(const ImDrawCmd& command, const ImVec2& a, const ImVec2& b,
                                      const ImVec2& c) const {
    const ImVec4& clip = command.ClipRect;
    const auto low = [](float x, float y, float z, float edge) {
        return int32_t(std::floor(std::max(std::min({x, y, z}), edge)));
    };
    const auto high = [](float x, float y, float z, float edge) {
        return int32_t(std::ceil(std::min(std::max({x, y, z}), edge)));
    };
    Part part{low(a.x, b.x, c.x, clip.x), low(a.y, b.y, c.y, clip.y), high(a.x, b.x, c.x, clip.z),
              high(a.y, b.y, c.y, clip.w)};
    part.x0 = std::max(part.x0, 0);
    part.y0 = std::max(part.y0, 0);
    part.x1 = std::min(part.x1, int32_t(sizeBefore_.x));
    part.y1 = std::min(part.y1, int32_t(sizeBefore_.y));
    return part;
}

// Records a command and the bounds of its triangles.
void UiRenderer::addCommand(const ImDrawCmd& command, const ImDrawVert* vertices,
                            const ImDrawIdx* indices) {
    const ImDrawVert* from = vertices + command.VtxOffset;
    Part all{INT32_MAX, INT32_MAX, INT32_MIN, INT32_MIN};
    for (uint32_t i = 0; i + 2 < command.ElemCount; i += 3) {
        const ImDrawIdx* at = indices + command.IdxOffset + i;
        const Part one = boundsOf(command, from[at[0]].pos, from[at[1]].pos, from[at[2]].pos);
        if (one.x0 >= one.x1 || one.y0 >= one.y1) continue;
        all = {std::min(all.x0, one.x0), std::min(all.y0, one.y0), std::max(all.x1, one.x1),
               std::max(all.y1, one.y1)};
    }
    addChange(all);
}

void UiRenderer::compare(const ImDrawList& list, const List& before) {
    const auto alike = [](const ImDrawCmd& a, const ImDrawCmd& b) {
        return std::memcmp(&a.ClipRect, &b.ClipRect, sizeof a.ClipRect) == 0 &&
               a.TextureId == b.TextureId && a.VtxOffset == b.VtxOffset &&
               a.IdxOffset == b.IdxOffset && a.ElemCount == b.ElemCount;
    };
    const bool same = size_t(list.VtxBuffer.Size) == before.vertices.size() &&
                      size_t(list.IdxBuffer.Size) == before.indices.size() &&
                      std::equal(list.CmdBuffer.begin(), list.CmdBuffer.end(),
                                 before.commands.begin(), before.commands.end(), alike) &&
                      std::equal(before.indices.begin(), before.indices.end(), list.IdxBuffer.Data);
    if (!same) {
        for (const ImDrawCmd& command : list.CmdBuffer)
            addCommand(command, list.VtxBuffer.Data, list.IdxBuffer.Data);
        for (const ImDrawCmd& command : before.commands)
            addCommand(command, before.vertices.data(), before.indices.data());
        return;
    }
    const bool still =
        before.vertices.empty() || std::memcmp(list.VtxBuffer.Data, before.vertices.data(),
                                               before.vertices.size() * sizeof(ImDrawVert)) == 0;
    for (const ImDrawCmd& command : list.CmdBuffer) {
        if (command.GetTexID() != fontTexture_) {
            addCommand(command, list.VtxBuffer.Data, list.IdxBuffer.Data);
            if (still) continue;
        } else if (still) {
            continue;
        }
        const ImDrawVert* now = list.VtxBuffer.Data + command.VtxOffset;
        const ImDrawVert* then = before.vertices.data() + command.VtxOffset;
        for (uint32_t i = 0; i + 2 < command.ElemCount; i += 3) {
            const ImDrawIdx* at = list.IdxBuffer.Data + command.IdxOffset + i;
            const bool moved = std::any_of(at, at + 3, [&](ImDrawIdx k) {
                return std::memcmp(&now[k], &then[k], sizeof(ImDrawVert)) != 0;
            });
            if (!moved) continue;
            for (const ImDrawVert* of : {now, then})
                addChange(boundsOf(command, of[at[0]].pos, of[at[1]].pos, of[at[2]].pos));
        }
    }
}

void UiRenderer::findChanges(const ImDrawData& data, bool whole) {
    changes_.clear();
    const auto count = size_t(data.CmdListsCount);
    whole = whole || count != before_.size() || data.DisplaySize.x != sizeBefore_.x ||
            data.DisplaySize.y != sizeBefore_.y;
    sizeBefore_ = data.DisplaySize;
    before_.resize(count);
    for (size_t i = 0; i < count; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        List& kept = before_[i];
        if (!whole) compare(list, kept);
        kept.vertices.assign(list.VtxBuffer.begin(), list.VtxBuffer.end());
        kept.indices.assign(list.IdxBuffer.begin(), list.IdxBuffer.end());
        kept.commands.assign(list.CmdBuffer.begin(), list.CmdBuffer.end());
    }
    if (whole) changes_ = {{0, 0, int32_t(data.DisplaySize.x), int32_t(data.DisplaySize.y)}};
}

// ---- drawing

void UiRenderer::draw(VkCommandBuffer commands, uint32_t slot, const ImDrawData& data, bool whole) {
    findChanges(data, whole);
    drawChanges(commands, slot, data, true);
}

void UiRenderer::drawOver(VkCommandBuffer commands, uint32_t slot, const ImDrawData& data) {
    changes_ = {{0, 0, int32_t(data.DisplaySize.x), int32_t(data.DisplaySize.y)}};
    drawChanges(commands, slot, data, false);
}

void UiRenderer::drawChanges(VkCommandBuffer commands, uint32_t slotIndex, const ImDrawData& data,
                             bool clears) {
    if (changes_.empty()) return;
    Slot& slot = slots_[slotIndex];
    reserve(slot.vertices,
            (size_t(data.TotalVtxCount) + changes_.size() * kClearCorners) * sizeof(ImDrawVert),
            VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    reserve(slot.indices, (size_t(data.TotalIdxCount) + kClearIndices) * sizeof(ImDrawIdx),
            VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    auto* vertices = static_cast<ImDrawVert*>(slot.vertices.mapped);
    auto* indices = static_cast<ImDrawIdx*>(slot.indices.mapped);
    for (const ImDrawIdx index : {0, 1, 2, 0, 2, 3}) *indices++ = index;
    const ImVec2 white = ImGui::GetIO().Fonts->TexUvWhitePixel;
    for (const Part& part : changes_) {
        const ImVec2 low(float(part.x0), float(part.y0)), high(float(part.x1), float(part.y1));
        for (const ImVec2& at : {low, ImVec2(high.x, low.y), high, ImVec2(low.x, high.y)})
            *vertices++ = {at, white, IM_COL32_BLACK};
    }
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
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdBindVertexBuffers(commands, 0, 1, &slot.vertices.buffer, &zero);
    vkCmdBindIndexBuffer(commands, slot.indices.buffer, 0,
                         sizeof(ImDrawIdx) == 2 ? VK_INDEX_TYPE_UINT16 : VK_INDEX_TYPE_UINT32);
    vkCmdPushConstants(commands, layout_, VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof push, &push);

    for (uint32_t i = 0; i < changes_.size(); ++i) drawPart(commands, data, i, clears);
}

// Draws everything in a part of the output, over black, so that translucent content never blends
// with its own previous frame or with an overlapping part.
void UiRenderer::drawPart(VkCommandBuffer commands, const ImDrawData& data, uint32_t number,
                          bool clears) {
    const Part& part = changes_[number];
    void* bound = fontTexture_;
    const auto fontSet = reinterpret_cast<VkDescriptorSet>(fontTexture_);
    const VkRect2D whole{{part.x0, part.y0},
                         {uint32_t(part.x1 - part.x0), uint32_t(part.y1 - part.y0)}};
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, 1, &fontSet, 0,
                            nullptr);
    if (clears) {
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, solidPipeline_);
        vkCmdSetScissor(commands, 0, 1, &whole);
        vkCmdDrawIndexed(commands, kClearIndices, 1, 0, int32_t(number * kClearCorners), 0);
    }
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_);

    uint32_t firstIndex = kClearIndices;
    auto firstVertex = int32_t(changes_.size() * kClearCorners);
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        for (const ImDrawCmd& command : list.CmdBuffer) {
            const ImVec4& clip = command.ClipRect;
            const int32_t x0 = std::max(int32_t(clip.x - data.DisplayPos.x), part.x0);
            const int32_t y0 = std::max(int32_t(clip.y - data.DisplayPos.y), part.y0);
            const int32_t x1 = std::min(int32_t(clip.z - data.DisplayPos.x), part.x1);
            const int32_t y1 = std::min(int32_t(clip.w - data.DisplayPos.y), part.y1);
            if (x1 <= x0 || y1 <= y0 || command.ElemCount == 0) continue;
            const VkRect2D scissor{{x0, y0}, {uint32_t(x1 - x0), uint32_t(y1 - y0)}};
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
