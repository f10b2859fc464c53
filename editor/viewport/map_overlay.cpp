// See map_overlay.h.
#include "viewport/map_overlay.h"

#include <algorithm>
#include <cstring>

namespace fwview {
namespace {

#include "map_overlay.frag.h"
#include "map_overlay.vert.h"

constexpr uint32_t kMost = 64;  // limit of coloured meshes
constexpr uint32_t kCornerBytes = 5 * sizeof(float);
// Towards the camera, so that a map covers the same triangles that the plugin drew.
constexpr float kDepthBias = -64, kDepthBiasSlope = -1.5f;

struct OverlayPush {  // map_overlay.vert
    glm::mat4 clip;
    glm::vec2 texel;
    float opacity;
};

void take(fwedit::PaintedArea& all, const fwedit::PaintedArea& area) {
    if (area.empty()) return;
    if (all.empty()) {
        all = area;
        return;
    }
    all = {std::min(all.x0, area.x0), std::min(all.y0, area.y0), std::max(all.x1, area.x1),
           std::max(all.y1, area.y1)};
}

std::vector<std::pair<uint32_t, uint32_t>> gutterOf(const fwedit::PaintSurface& surface) {
    std::vector<std::pair<uint32_t, uint32_t>> gutter;
    const auto width = int32_t(surface.width), height = int32_t(surface.height);
    for (int32_t y = 0; y < height; ++y) {
        for (int32_t x = 0; x < width; ++x) {
            const auto texel = uint32_t(y * width + x);
            if (surface.real[texel]) continue;
            // Nearest first: sides, then corners.
            constexpr int32_t kX[] = {1, -1, 0, 0, 1, -1, 1, -1},
                              kY[] = {0, 0, 1, -1, 1, 1, -1, -1};
            for (int i = 0; i < 8; ++i) {
                const int32_t u = x + kX[i], v = y + kY[i];
                if (u < 0 || v < 0 || u >= width || v >= height) continue;
                const auto beside = uint32_t(v * width + u);
                if (!surface.real[beside]) continue;
                gutter.emplace_back(texel, beside);
                break;
            }
        }
    }
    return gutter;
}

}  // namespace

uint32_t premultiplied(ImU32 color, float opacity) {
    uint32_t result = 0;
    for (uint32_t c = 0; c < 3; ++c) {
        const float value = opacity * float(color >> (8 * c) & 255);
        result |= uint32_t(value + 0.5f) << (8 * c);
    }
    return result | uint32_t(255 * opacity + 0.5f) << 24;
}

Palette rampPalette(std::span<const fwui::MapStop> map, float opacity) {
    Palette palette{};
    for (uint32_t i = 0; i < 255; ++i)
        palette[i] = premultiplied(fwui::sampleMap(map, float(i) / 254), opacity);
    return palette;
}

MapOverlay::MapOverlay(const sample::VulkanHost& host, fwui::UiRenderer& ui, VkRenderPass pass)
    : host_(host),
      ui_(ui),
      drawing_(
          host, kMost, 1,
          {VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(OverlayPush)}) {
    sample::PipelineRequest request;
    request.pass = pass;
    request.vertex = host.createShader(kMapOverlayVert, sizeof kMapOverlayVert);
    request.fragment = host.createShader(kMapOverlayFrag, sizeof kMapOverlayFrag);
    request.bindings = {{0, kCornerBytes, VK_VERTEX_INPUT_RATE_VERTEX}};
    request.attributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0},
                          {1, 0, VK_FORMAT_R32G32_SFLOAT, 3 * sizeof(float)}};
    request.depthWrite = false;
    request.depthBias = kDepthBias;
    request.depthBiasSlope = kDepthBiasSlope;
    request.blend = true;
    pipeline_ = drawing_.pipeline(request);
    vkDestroyShaderModule(host.device, request.vertex, nullptr);
    vkDestroyShaderModule(host.device, request.fragment, nullptr);
}

MapOverlay::~MapOverlay() { clear(); }

MapOverlay::Map MapOverlay::makeMap(const std::shared_ptr<const fwedit::PaintSurface>& surface) {
    Map map;
    map.surface = surface;
    map.corners = host_.createFilledBuffer(surface->corners.data(), surface->corners.size() * 4,
                                           VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    sample::ImageRequest request;
    request.width = surface->width;
    request.height = surface->height;
    request.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    map.image = host_.createImage(request);
    map.pixels.assign(size_t{surface->width} * surface->height, 0);
    for (sample::Buffer& buffer : map.staging)
        buffer = host_.createBuffer(map.pixels.size() * 4, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, true);
    host_.runNow([&](VkCommandBuffer commands) {
        sample::imageBarrier(commands, map.image.image, VK_IMAGE_LAYOUT_UNDEFINED,
                             VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                             VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, 0,
                             VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT);
    });
    map.set = drawing_.newSet();
    drawing_.write(map.set, 0, map.image.view);
    map.texture = ui_.addTexture(map.image.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    map.gutter = gutterOf(*surface);
    return map;
}

void MapOverlay::destroy(Map& map) {
    if (map.texture) ui_.removeTexture(map.texture);
    drawing_.freeSet(map.set);
    host_.destroy(map.corners);
    host_.destroy(map.image);
    for (sample::Buffer& buffer : map.staging) host_.destroy(buffer);
}

void MapOverlay::clear() {
    if (maps_.empty()) return;
    vkDeviceWaitIdle(host_.device);
    for (auto& [mesh, map] : maps_) destroy(map);
    maps_.clear();
}

MapOverlay::Map* MapOverlay::mapOf(fwedit::ObjectId mesh,
                                   const std::shared_ptr<const fwedit::PaintSurface>& surface) {
    auto found = maps_.find(mesh);
    if (found != maps_.end() && found->second.surface != surface) {
        vkDeviceWaitIdle(host_.device);
        destroy(found->second);
        maps_.erase(found);
        found = maps_.end();
    }
    if (found == maps_.end()) {
        if (maps_.size() >= kMost || surface->corners.empty()) return nullptr;
        found = maps_.emplace(mesh, makeMap(surface)).first;
        found->second.fresh = {0, 0, surface->width, surface->height};
    }
    return &found->second;
}

void MapOverlay::prepare(fwedit::ObjectId mesh,
                         const std::shared_ptr<const fwedit::PaintSurface>& surface) {
    (void)mapOf(mesh, surface);
}

void MapOverlay::color(fwedit::ObjectId mesh,
                       const std::shared_ptr<const fwedit::PaintSurface>& surface,
                       std::span<const uint8_t> values, const Palette& palette,
                       const fwedit::PaintedArea& area) {
    Map* made = mapOf(mesh, surface);
    if (!made) return;
    Map& map = *made;
    const uint32_t width = surface->width, height = surface->height;
    const uint32_t x1 = std::min(area.x1, width), y1 = std::min(area.y1, height);
    for (uint32_t y = area.y0; y < y1; ++y)
        for (uint32_t x = area.x0; x < x1; ++x) {
            const size_t texel = size_t{y} * width + x;
            map.pixels[texel] = surface->real[texel] ? palette[values[texel]] : 0;
        }
    // Include the gutter, one texel around the change.
    const fwedit::PaintedArea wide = {area.x0 > 0 ? area.x0 - 1 : 0, area.y0 > 0 ? area.y0 - 1 : 0,
                                      std::min(x1 + 1, width), std::min(y1 + 1, height)};
    const auto first = std::lower_bound(map.gutter.begin(), map.gutter.end(),
                                        std::pair<uint32_t, uint32_t>(wide.y0 * width, 0));
    for (auto at = first; at != map.gutter.end() && at->first < wide.y1 * width; ++at) {
        const uint32_t x = at->first % width;
        if (x >= wide.x0 && x < wide.x1) map.pixels[at->first] = map.pixels[at->second];
    }
    take(map.fresh, wide);
}

bool MapOverlay::isSettled() const {
    return std::all_of(maps_.begin(), maps_.end(),
                       [](const auto& entry) { return entry.second.fresh.empty(); });
}

void* MapOverlay::texture(fwedit::ObjectId mesh) const {
    const auto found = maps_.find(mesh);
    return found == maps_.end() ? nullptr : found->second.texture;
}

void MapOverlay::upload(const fwui::Frame& frame) {
    for (auto& [mesh, map] : maps_) {
        if (map.fresh.empty()) continue;
        const fwedit::PaintedArea area = map.fresh;
        map.fresh = {};
        const uint32_t width = map.surface->width;
        const sample::Buffer& staging = map.staging[frame.slot];
        for (uint32_t y = area.y0; y < area.y1; ++y) {
            const size_t first = size_t{y} * width + area.x0;
            std::memcpy(static_cast<uint32_t*>(staging.mapped) + first, map.pixels.data() + first,
                        size_t{area.x1 - area.x0} * 4);
        }
        sample::imageBarrier(frame.commands, map.image.image,
                             VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                             VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                             VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT,
                             VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
        VkBufferImageCopy copy{};
        copy.bufferOffset = (VkDeviceSize{area.y0} * width + area.x0) * 4;
        copy.bufferRowLength = width;
        copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        copy.imageOffset = {int32_t(area.x0), int32_t(area.y0), 0};
        copy.imageExtent = {area.x1 - area.x0, area.y1 - area.y0, 1};
        vkCmdCopyBufferToImage(frame.commands, staging.buffer, map.image.image,
                               VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
        sample::imageBarrier(frame.commands, map.image.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                             VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                             VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                             VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT);
    }
}

void MapOverlay::draw(const fwui::Frame& frame, fwedit::ObjectId mesh, const glm::mat4& clip,
                      float opacity) const {
    const auto found = maps_.find(mesh);
    if (found == maps_.end()) return;
    const Map& map = found->second;
    const OverlayPush push{
        clip, {1 / float(map.surface->width), 1 / float(map.surface->height)}, opacity};
    vkCmdBindPipeline(frame.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_);
    vkCmdBindDescriptorSets(frame.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, drawing_.layout(), 0,
                            1, &map.set, 0, nullptr);
    vkCmdPushConstants(frame.commands, drawing_.layout(),
                       VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof push,
                       &push);
    const VkDeviceSize start = 0;
    vkCmdBindVertexBuffers(frame.commands, 0, 1, &map.corners.buffer, &start);
    vkCmdDraw(frame.commands, uint32_t(map.surface->corners.size() / 5), 1, 0, 0);
}

}  // namespace fwview
