// See relief.h.
#include "common/relief.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "common/pipeline.h"
#include "common/relief_maps.h"

namespace sample {
namespace {

#include "relief.frag.h"
#include "relief.vert.h"

constexpr uint32_t kMostFires = 4;
constexpr uint32_t kPictures = 3;  // per model

struct Block {  // relief_block.glsl
    glm::mat4 viewProjection;
    glm::vec4 eye, sunDirection, sunColor, ambientSky, ambientGround;
    glm::vec4 firePlace[kMostFires], fireColor[kMostFires];
};

ReliefHeights viewHeights(const ReliefModel& model) {
    const ReliefPicture& p = model.picture;
    return {p.width, p.height, p.metres, p.depth, model.repeats, p.heights};
}

// Packs slopes along u and v, cone (square root of its share of kWidestCone), and height.
// `steepest`: slope that the value 1 represents.
std::vector<uint8_t> shapeOf(const ReliefModel& model, float& steepest) {
    const ReliefPicture& p = model.picture;
    const auto w = static_cast<int>(p.width), h = static_cast<int>(p.height);
    auto height = [&](int x, int y) {
        x = model.repeats ? (x + w) % w : std::clamp(x, 0, w - 1);
        y = model.repeats ? (y + h) % h : std::clamp(y, 0, h - 1);
        return p.heights[static_cast<size_t>(y) * p.width + static_cast<size_t>(x)];
    };
    const glm::vec2 texel = p.metres / glm::vec2(p.width, p.height);
    auto slope = [&](int x, int y) {
        return 0.5f * p.depth *
               glm::vec2(height(x + 1, y) - height(x - 1, y), height(x, y + 1) - height(x, y - 1)) /
               texel;
    };
    steepest = 1e-3f;
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            const glm::vec2 s = glm::abs(slope(x, y));
            steepest = std::max({steepest, s.x, s.y});
        }
    steepest = std::min(steepest, 4.0f);
    const std::vector<float> cones = reliefCones(viewHeights(model));
    std::vector<uint8_t> shape(p.heights.size() * 4);
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            const size_t at = static_cast<size_t>(y) * p.width + static_cast<size_t>(x);
            const glm::vec2 s = 0.5f + 0.5f * slope(x, y) / steepest;
            shape[at * 4] = toByte(s.x);
            shape[at * 4 + 1] = toByte(s.y);
            shape[at * 4 + 2] = toByte(std::sqrt(cones[at] / kWidestCone));
            shape[at * 4 + 3] = toByte(height(x, y));
        }
    return shape;
}

}  // namespace

void addReliefBlock(ReliefModel& model, glm::vec3 center, glm::vec2 size) {
    const float deep = model.picture.depth;
    const glm::vec3 low = center - 0.5f * glm::vec3(size.x, 0, size.y);
    // The picture's u is x and its v is z, which equals cross(across, normal).
    auto corner = [&](float x, float z, float depth) {
        model.vertices.push_back({low + glm::vec3(x * size.x, -depth, z * size.y),
                                  {0, 1, 0},
                                  {1, 0, 0},
                                  glm::vec2(x, z) * model.picture.metres,
                                  depth,
                                  0});
    };
    auto quad = [&] {
        const auto last = static_cast<uint32_t>(model.vertices.size());
        for (const uint32_t k : {4, 3, 2, 4, 2, 1}) model.indices.push_back(last - k);
    };
    corner(0, 0, 0), corner(0, 1, 0), corner(1, 1, 0), corner(1, 0, 0);
    quad();
    const glm::vec2 around[] = {{0, 0}, {0, 1}, {1, 1}, {1, 0}, {0, 0}};
    for (int side = 0; side < 4; ++side) {
        const glm::vec2 a = around[side], b = around[side + 1];
        corner(a.x, a.y, 0), corner(a.x, a.y, deep), corner(b.x, b.y, deep), corner(b.x, b.y, 0);
        quad();
    }
}

void addReliefLog(ReliefModel& model, glm::vec3 a, glm::vec3 b, float radius) {
    constexpr int kSides = 40;
    const float length = glm::length(b - a);
    const glm::vec3 along = (b - a) / length;
    const glm::vec3 side = glm::normalize(
        glm::cross(along, std::abs(along.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0)));
    const glm::vec3 other = glm::cross(along, side);
    const float girth = glm::two_pi<float>() * radius;
    const float turns = std::max(1.0f, std::round(girth / model.picture.metres.x));
    const auto first = static_cast<uint32_t>(model.vertices.size());
    for (int i = 0; i <= kSides; ++i) {
        const float share = static_cast<float>(i) / kSides, angle = share * glm::two_pi<float>();
        const glm::vec3 out = side * std::cos(angle) + other * std::sin(angle);
        const glm::vec3 across = other * std::cos(angle) - side * std::sin(angle);
        const float u = share * turns * model.picture.metres.x;
        for (int end = 0; end < 2; ++end)
            model.vertices.push_back(
                {(end ? b : a) + out * radius, out, across, {u, end ? 0 : length}, 0, 1 / radius});
    }
    for (uint32_t i = 0; i < kSides; ++i)
        for (const uint32_t k : {0, 2, 1, 1, 2, 3}) model.indices.push_back(first + 2 * i + k);
    for (int end = 0; end < 2; ++end) {
        const glm::vec3 out = end ? along : -along;
        const auto middle = static_cast<uint32_t>(model.vertices.size());
        model.vertices.push_back({end ? b : a, out, side, model.picture.metres * 0.5f, 0, 0});
        for (int i = 0; i <= kSides; ++i) {
            const float angle = static_cast<float>(i) / kSides * glm::two_pi<float>();
            const glm::vec2 place = glm::vec2(std::cos(angle), std::sin(angle)) * radius;
            model.vertices.push_back(
                {model.vertices[middle].position + side * place.x + other * place.y, out, side,
                 model.vertices[middle].at + place, 0, 0});
        }
        for (uint32_t i = 0; i < kSides; ++i)
            for (const uint32_t k : {0u, i + 2 - uint32_t(end), i + 1 + uint32_t(end)})
                model.indices.push_back(middle + k);
    }
}

Relief::Relief(const VulkanHost& host, const Stage& stage, std::span<const ReliefModel> models)
    : host_(host) {
    repeat_ = host.createSampler(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT,
                                 VK_SAMPLER_MIPMAP_MODE_NEAREST);
    clamp_ = host.createSampler(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                VK_SAMPLER_MIPMAP_MODE_NEAREST);
    constexpr VkDescriptorType kImage = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    frameLayout_ = makeSetLayout(host, {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER});
    modelLayout_ = makeSetLayout(host, {kImage, kImage, kImage});
    const uint32_t slots = stage.made.framesInFlight;
    const auto count = static_cast<uint32_t>(models.size());
    pool_ = makeSetPool(host, slots + count, slots, kPictures * count);
    for (uint32_t i = 0; i < slots; ++i) {
        blocks_.push_back(
            host.createBuffer(sizeof(Block), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, true));
        sets_.push_back(makeSet(host, pool_, frameLayout_));
        writeBuffer(host, sets_.back(), 0, blocks_.back().buffer);
    }
    std::vector<ReliefVertex> vertices;
    std::vector<uint32_t> indices;
    for (const ReliefModel& model : models) {
        const ReliefPicture& p = model.picture;
        Drawn drawn;
        float steepest = 1;
        const std::vector<uint8_t> shape = shapeOf(model, steepest);
        drawn.color = host.createTexture(p.width, p.height, p.color.data(), false);
        drawn.shape = host.createTexture(p.width, p.height, shape.data(), false);
        const ReliefHorizon horizon = reliefHorizon(viewHeights(model));
        drawn.horizon =
            host.createTexture(horizon.width, horizon.height, horizon.texels.data(), false);
        drawn.set = makeSet(host, pool_, modelLayout_);
        const VkSampler sampler = model.repeats ? repeat_ : clamp_;
        writeImage(host, drawn.set, 0, sampler, drawn.color.view);
        writeImage(host, drawn.set, 1, sampler, drawn.shape.view);
        writeImage(host, drawn.set, 2, sampler, drawn.horizon.view);
        const float push[8] = {p.metres.x,
                               p.metres.y,
                               p.depth,
                               steepest,
                               static_cast<float>(p.width),
                               static_cast<float>(p.height),
                               model.repeats ? 0.0f : 1.0f,
                               model.length};
        std::memcpy(drawn.push, push, sizeof push);
        drawn.firstIndex = static_cast<uint32_t>(indices.size());
        drawn.indexCount = static_cast<uint32_t>(model.indices.size());
        drawn.curved = std::any_of(model.vertices.begin(), model.vertices.end(),
                                   [](const ReliefVertex& v) { return v.curve != 0; });
        const auto base = static_cast<uint32_t>(vertices.size());
        for (const uint32_t i : model.indices) indices.push_back(base + i);
        vertices.insert(vertices.end(), model.vertices.begin(), model.vertices.end());
        models_.push_back(drawn);
    }
    vertices_ = host.createFilledBuffer(vertices.data(), vertices.size() * sizeof(ReliefVertex),
                                        VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    indices_ = host.createFilledBuffer(indices.data(), indices.size() * sizeof(uint32_t),
                                       VK_BUFFER_USAGE_INDEX_BUFFER_BIT);

    layout_ = makeLayout(host, {frameLayout_, modelLayout_},
                         {VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof Drawn::push});
    PipelineRequest request;
    request.pass = stage.scenePass;
    request.layout = layout_;
    request.samples = stage.made.samples;
    request.depthCompare = stage.depthCompare();
    request.vertex = host.createShader(kReliefVert, sizeof kReliefVert);
    request.fragment = host.createShader(kReliefFrag, sizeof kReliefFrag);
    request.bindings = {{0, sizeof(ReliefVertex), VK_VERTEX_INPUT_RATE_VERTEX}};
    request.attributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(ReliefVertex, position)},
                          {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(ReliefVertex, normal)},
                          {2, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(ReliefVertex, across)},
                          {3, 0, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(ReliefVertex, at)}};
    request.cull = VK_CULL_MODE_BACK_BIT;
    const VkBool32 linear = stage.made.colorFormat == VK_FORMAT_R16G16B16A16_SFLOAT;
    for (const ReliefMode mode : {ReliefMode::kBump, ReliefMode::kParallax})
        for (const bool curved : {false, true}) {
            const VkBool32 constants[] = {mode == ReliefMode::kParallax, linear, curved};
            constexpr uint32_t kSize = sizeof(VkBool32);
            const VkSpecializationMapEntry entries[] = {
                {0, 0, kSize}, {1, kSize, kSize}, {2, 2 * kSize, kSize}};
            const VkSpecializationInfo special{3, entries, sizeof constants, constants};
            request.specialization = &special;
            pipelines_[static_cast<int>(mode)][curved] = makePipeline(host, request);
        }
    vkDestroyShaderModule(host.device, request.vertex, nullptr);
    vkDestroyShaderModule(host.device, request.fragment, nullptr);
}

Relief::~Relief() {
    vkDeviceWaitIdle(host_.device);
    for (const auto& pair : pipelines_)
        for (VkPipeline pipeline : pair) vkDestroyPipeline(host_.device, pipeline, nullptr);
    vkDestroyPipelineLayout(host_.device, layout_, nullptr);
    vkDestroyDescriptorPool(host_.device, pool_, nullptr);
    vkDestroyDescriptorSetLayout(host_.device, frameLayout_, nullptr);
    vkDestroyDescriptorSetLayout(host_.device, modelLayout_, nullptr);
    vkDestroySampler(host_.device, repeat_, nullptr);
    vkDestroySampler(host_.device, clamp_, nullptr);
    for (Drawn& drawn : models_) {
        host_.destroy(drawn.color);
        host_.destroy(drawn.shape);
        host_.destroy(drawn.horizon);
    }
    host_.destroy(vertices_);
    host_.destroy(indices_);
    for (Buffer& block : blocks_) host_.destroy(block);
}

void Relief::prepare(const StageFrame& frame, const FwView& view, std::span<const FwLight> fires) {
    Block block{};
    const glm::mat4 toView = glm::make_mat4(view.view);
    block.viewProjection = glm::make_mat4(view.projection) * toView;
    block.eye = glm::vec4(glm::vec3(glm::inverse(toView)[3]), view.exposure);
    const size_t count = std::min<size_t>(fires.size(), kMostFires);
    block.sunDirection = glm::vec4(glm::make_vec3(view.sunDirection), static_cast<float>(count));
    block.sunColor = glm::vec4(glm::make_vec3(view.sunColor), 0);
    block.ambientSky = glm::vec4(glm::make_vec3(view.ambientSky), 0);
    block.ambientGround = glm::vec4(glm::make_vec3(view.ambientGround), 0);
    for (size_t i = 0; i < count; ++i) {
        block.firePlace[i] =
            glm::vec4(glm::make_vec3(fires[i].position), std::max(fires[i].radius, 0.05f));
        block.fireColor[i] =
            glm::vec4(glm::make_vec3(fires[i].color) * fires[i].intensity * fireGain, 0);
    }
    std::memcpy(blocks_[frame.slot].mapped, &block, sizeof block);
}

void Relief::draw(const StageFrame& frame, ReliefMode mode, VkRect2D area) {
    VkCommandBuffer commands = frame.commands;
    vkCmdSetViewport(commands, 0, 1, &frame.viewport);
    vkCmdSetScissor(commands, 0, 1, &area);
    const VkDeviceSize zero = 0;
    vkCmdBindVertexBuffers(commands, 0, 1, &vertices_.buffer, &zero);
    vkCmdBindIndexBuffer(commands, indices_.buffer, 0, VK_INDEX_TYPE_UINT32);
    for (const Drawn& drawn : models_) {
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS,
                          pipelines_[static_cast<int>(mode)][drawn.curved]);
        const VkDescriptorSet sets[] = {sets_[frame.slot], drawn.set};
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, 2, sets, 0,
                                nullptr);
        vkCmdPushConstants(commands, layout_, VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof drawn.push,
                           drawn.push);
        vkCmdDrawIndexed(commands, drawn.indexCount, 1, drawn.firstIndex, 0, 0);
    }
    const VkRect2D all{{0, 0}, frame.extent};
    vkCmdSetScissor(commands, 0, 1, &all);
}

}  // namespace sample
