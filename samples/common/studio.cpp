// See studio.h.
#include "common/studio.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/type_ptr.hpp>

#include "common/pipeline.h"

namespace sample {
namespace {

#include "studio.frag.h"
#include "studio.vert.h"

constexpr uint32_t kMostFires = 8;
constexpr uint32_t kShadowSide = 256;  // texels

struct Block {  // studio_block.glsl
    glm::mat4 viewProjection;
    glm::vec4 sunDirection, sunColor, ambientSky, ambientGround, center;
    glm::vec4 firePlace[kMostFires], fireColor[kMostFires];
};

struct Vertex {
    glm::vec3 position, normal;
};

uint32_t mixBits(uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ (x >> 16);
}

// Tiling value noise with smooth interpolation and `cells` cells across the unit square.
float valueNoise(float u, float v, int cells, uint32_t seed) {
    const float x = u * static_cast<float>(cells), y = v * static_cast<float>(cells);
    const int ix = static_cast<int>(std::floor(x)), iy = static_cast<int>(std::floor(y));
    const float fx = x - std::floor(x), fy = y - std::floor(y);
    auto at = [&](int i, int j) {
        const auto a = static_cast<uint32_t>((i % cells + cells) % cells);
        const auto b = static_cast<uint32_t>((j % cells + cells) % cells);
        return static_cast<float>(mixBits(a * 7919u ^ mixBits(b + seed * 977u))) / 4294967296.0f;
    };
    const float sx = fx * fx * (3 - 2 * fx), sy = fy * fy * (3 - 2 * fy);
    return glm::mix(glm::mix(at(ix, iy), at(ix + 1, iy), sx),
                    glm::mix(at(ix, iy + 1), at(ix + 1, iy + 1), sx), sy);
}

std::vector<uint8_t> plasterPixels(uint32_t side) {
    std::vector<uint8_t> pixels(size_t{side} * side * 4, 255);
    for (uint32_t y = 0; y < side; ++y) {
        for (uint32_t x = 0; x < side; ++x) {
            const float u = (static_cast<float>(x) + 0.5f) / static_cast<float>(side);
            const float v = (static_cast<float>(y) + 0.5f) / static_cast<float>(side);
            float coarse = 0, fine = 0, weight = 0.5f;
            for (int octave = 0; octave < 5; ++octave) {
                const auto seed = static_cast<uint32_t>(octave);
                coarse += weight * valueNoise(u, v, 3 << octave, seed + 1);
                fine += weight * valueNoise(u, v, 48 << std::min(octave, 2), seed + 31);
                weight *= 0.55f;
            }
            uint8_t* to = &pixels[(size_t{y} * side + x) * 4];
            to[0] = static_cast<uint8_t>(std::clamp(coarse * 255.0f, 0.0f, 255.0f));
            to[1] = static_cast<uint8_t>(std::clamp(fine * 255.0f, 0.0f, 255.0f));
        }
    }
    return pixels;
}

void blur(std::vector<float>& field, uint32_t side, int radius) {
    std::vector<float> other(field.size());
    const auto n = static_cast<int>(side);
    for (int pass = 0; pass < 3; ++pass) {
        for (int axis = 0; axis < 2; ++axis) {
            for (int a = 0; a < n; ++a) {
                auto at = [&](int b) {
                    return static_cast<size_t>(axis == 0 ? a * n + b : b * n + a);
                };
                float sum = 0;
                for (int b = -radius; b <= radius; ++b) sum += b >= 0 && b < n ? field[at(b)] : 0;
                for (int b = 0; b < n; ++b) {
                    other[at(b)] = sum / static_cast<float>(2 * radius + 1);
                    if (b - radius >= 0) sum -= field[at(b - radius)];
                    if (b + radius + 1 < n) sum += field[at(b + radius + 1)];
                }
            }
            field.swap(other);
        }
    }
}

void fillTriangle(std::vector<float>& field, uint32_t side, glm::vec2 a, glm::vec2 b, glm::vec2 c) {
    const glm::vec2 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
    const auto last = static_cast<float>(side) - 1;
    if (!(high.x >= 0 && high.y >= 0 && low.x <= last && low.y <= last)) return;
    const auto x0 = static_cast<uint32_t>(std::max(0.0f, low.x));
    const auto y0 = static_cast<uint32_t>(std::max(0.0f, low.y));
    const auto x1 = static_cast<uint32_t>(std::min(last, high.x));
    const auto y1 = static_cast<uint32_t>(std::min(last, high.y));
    auto edge = [](glm::vec2 p, glm::vec2 q, glm::vec2 r) {
        return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
    };
    const float area = edge(a, b, c);
    for (uint32_t y = y0; y <= y1; ++y) {
        for (uint32_t x = x0; x <= x1; ++x) {
            const glm::vec2 p(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            const float u = edge(a, b, p), v = edge(b, c, p), w = edge(c, a, p);
            const bool inside = area >= 0 ? u >= 0 && v >= 0 && w >= 0 : u <= 0 && v <= 0 && w <= 0;
            if (inside) field[size_t{y} * side + x] = 1.0f;
        }
    }
}

}  // namespace

void duskLight(FwView& view, float share) {
    const glm::vec3 sun = glm::normalize(glm::vec3(-0.5f, 0.75f, 0.65f));
    const float sunColor[3] = {66.0f, 57.2f, 46.2f};
    const float sky[3] = {13.0f, 16.0f, 22.0f}, ground[3] = {9.0f, 8.0f, 7.0f};
    std::memcpy(view.sunDirection, glm::value_ptr(sun), sizeof view.sunDirection);
    for (int c = 0; c < 3; ++c) {
        view.sunColor[c] = share * sunColor[c];
        view.ambientSky[c] = share * sky[c];
        view.ambientGround[c] = share * ground[c];
    }
    view.exposure = 1.0f / 40.0f;
    view.emissionScale = 40.0f;  // the light above is in cd/m^2
}

void FireLook::addTo(OptionParser& parser) {
    parser.addText("--view", "NAME", "side, above, below or inside one of them", view);
    parser.addText("--light", "NAME", "night, day or sky, a bright one", light);
}

Camera FireLook::camera(const OrbitCamera& orbit, glm::vec3 within) const {
    OrbitCamera turned = orbit;
    if (view == "above") {
        turned.pitch = glm::radians(58.0f);
        turned.fieldOfView *= 1.35f;
    } else if (view == "below") {
        turned.target.y += 0.1f;
        turned.pitch = -std::asin((turned.target.y - 0.08f) /
                                  turned.distance);  // the camera is near the floor
    } else if (view == "inside") {
        Camera camera;
        camera.eye = within;
        camera.target = within + glm::vec3(1.0f, 0.08f, -0.15f);
        camera.fieldOfView = 0.75f;
        camera.nearPlane = 0.01f;
        return camera;
    } else if (view != "side") {
        throw Failure("--view is \"" + view + "\"; it is side, above, below or inside.");
    }
    return turned.camera();
}

void FireLook::applyLight(FwView& lit, float night, float day) const {
    if (light != "night" && light != "day" && light != "sky")
        throw Failure("--light is \"" + light + "\"; it is night, day or sky.");
    duskLight(lit, light == "night" ? night : light == "day" ? day : 4.0f * day);
    if (light == "sky") lit.exposure *= 0.5f;  // as a photographer would expose
}

Studio::Studio(const VulkanHost& host, const Stage& stage, glm::vec3 center, float size)
    : Studio(host, stage.describePass(), center, size) {}

Studio::Studio(const VulkanHost& host, const ScenePass& scene, glm::vec3 center, float size)
    : host_(host), center_(center), size_(size) {
    // A profile that rotates around the vertical axis: flat floor, quarter circle, wall.
    constexpr int kAround = 64;
    const float radius = 7.0f * size, bend = 2.2f * size;
    std::vector<glm::vec4> profile = {{0, 0, 0, 1}, {2 * size, 0, 0, 1}};  // r, y, normal r, y
    for (int i = 0; i <= 8; ++i) {
        const float angle = glm::half_pi<float>() * static_cast<float>(i) / 8.0f;
        profile.push_back({radius - bend + bend * std::sin(angle), bend - bend * std::cos(angle),
                           -std::sin(angle), std::cos(angle)});
    }
    profile.push_back({radius, 6 * size, -1, 0});
    std::vector<Vertex> vertices;
    std::vector<uint32_t> indices;
    for (int i = 0; i <= kAround; ++i) {
        const float angle = glm::two_pi<float>() * static_cast<float>(i) / kAround;
        const float s = std::sin(angle), c = std::cos(angle);
        for (const glm::vec4& p : profile) {
            vertices.push_back(
                {center + glm::vec3(p.x * s, p.y, p.x * c), {p.z * s, p.w, p.z * c}});
        }
    }
    const auto rows = static_cast<uint32_t>(profile.size());
    for (uint32_t i = 0; i < kAround; ++i) {
        for (uint32_t j = 0; j + 1 < rows; ++j) {
            const uint32_t a = i * rows + j, b = a + rows;
            for (uint32_t k : {a, b, a + 1, a + 1, b, b + 1}) indices.push_back(k);
        }
    }
    indexCount_ = static_cast<uint32_t>(indices.size());
    vertices_ = host.createFilledBuffer(vertices.data(), vertices.size() * sizeof(Vertex),
                                        VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    indices_ = host.createFilledBuffer(indices.data(), indices.size() * sizeof(uint32_t),
                                       VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    plaster_ = host.createTexture(512, 512, plasterPixels(512).data(), false);
    const uint8_t none[4] = {0, 0, 0, 255};
    shadow_ = host.createTexture(1, 1, none, false);
    repeat_ = host.createSampler(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT,
                                 VK_SAMPLER_MIPMAP_MODE_NEAREST);
    clamp_ = host.createSampler(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                VK_SAMPLER_MIPMAP_MODE_NEAREST);

    constexpr VkDescriptorType kImage = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    setLayout_ = makeSetLayout(host, {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, kImage, kImage});
    const uint32_t slots = scene.framesInFlight;
    pool_ = makeSetPool(host, slots, slots, 2 * slots);
    for (uint32_t i = 0; i < slots; ++i) {
        sets_.push_back(makeSet(host, pool_, setLayout_));
        blocks_.push_back(
            host.createBuffer(sizeof(Block), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, true));
    }
    writeSets();

    layout_ = makeLayout(host, {setLayout_}, {VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(float)});
    const int32_t display = scene.colorFormat == VK_FORMAT_R16G16B16A16_SFLOAT ? 0
                            : scene.colorFormat == VK_FORMAT_R8G8B8A8_SRGB     ? 1
                                                                               : 2;
    const VkSpecializationMapEntry entry{0, 0, sizeof display};
    const VkSpecializationInfo specialization{1, &entry, sizeof display, &display};
    PipelineRequest request;
    request.pass = scene.pass;
    request.layout = layout_;
    request.samples = scene.samples;
    request.depthCompare = scene.depthCompare;
    request.vertex = host.createShader(kStudioVert, sizeof kStudioVert);
    request.fragment = host.createShader(kStudioFrag, sizeof kStudioFrag);
    request.bindings = {{0, sizeof(Vertex), VK_VERTEX_INPUT_RATE_VERTEX}};
    request.attributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0},
                          {1, 0, VK_FORMAT_R32G32B32_SFLOAT, sizeof(glm::vec3)}};
    request.specialization = &specialization;
    pipeline_ = makePipeline(host, request);
    vkDestroyShaderModule(host.device, request.vertex, nullptr);
    vkDestroyShaderModule(host.device, request.fragment, nullptr);
}

Studio::~Studio() {
    vkDeviceWaitIdle(host_.device);
    vkDestroyPipeline(host_.device, pipeline_, nullptr);
    vkDestroyPipelineLayout(host_.device, layout_, nullptr);
    vkDestroyDescriptorPool(host_.device, pool_, nullptr);
    vkDestroyDescriptorSetLayout(host_.device, setLayout_, nullptr);
    vkDestroySampler(host_.device, repeat_, nullptr);
    vkDestroySampler(host_.device, clamp_, nullptr);
    for (Buffer* buffer : {&vertices_, &indices_, &blockVertices_}) host_.destroy(*buffer);
    for (Buffer& buffer : blocks_) host_.destroy(buffer);
    for (Image* image : {&plaster_, &shadow_}) host_.destroy(*image);
}

void Studio::writeSets() {
    for (size_t i = 0; i < sets_.size(); ++i) {
        writeBuffer(host_, sets_[i], 0, blocks_[i].buffer);
        writeImage(host_, sets_[i], 1, repeat_, plaster_.view);
        writeImage(host_, sets_[i], 2, clamp_, shadow_.view);
    }
}

void Studio::castShadow(std::span<const float> positions, std::span<const uint32_t> indices,
                        const glm::mat4& transform, glm::vec3 sunDirection) {
    constexpr float kReach = 2.0f;  // half side of the map, in object sizes
    std::vector<float> sun(size_t{kShadowSide} * kShadowSide, 0.0f), contact = sun;
    const float half = kReach * size_;
    const glm::vec3 toSun = sunDirection / std::max(0.2f, sunDirection.y);
    auto toMap = [&](glm::vec3 p) {
        return glm::vec2((p.x / half) * 0.5f + 0.5f, (p.z / half) * 0.5f + 0.5f) *
               static_cast<float>(kShadowSide);
    };
    auto cover = [&](const glm::vec3(&p)[3]) {
        glm::vec2 cast[3], below[3];
        for (int k = 0; k < 3; ++k) {
            cast[k] = toMap(p[k] - toSun * p[k].y);
            below[k] = toMap(p[k]);
        }
        fillTriangle(sun, kShadowSide, cast[0], cast[1], cast[2]);
        if (std::min({p[0].y, p[1].y, p[2].y}) < 0.3f * size_) {
            fillTriangle(contact, kShadowSide, below[0], below[1], below[2]);
        }
    };
    for (size_t i = 0; i + 2 < indices.size(); i += 3) {
        glm::vec3 p[3];
        for (size_t k = 0; k < 3; ++k) {
            const float* from = &positions[size_t{indices[i + k]} * 3];
            p[k] = glm::vec3(transform * glm::vec4(from[0], from[1], from[2], 1.0f)) - center_;
        }
        cover(p);
    }
    for (size_t i = 0; i + 5 < blockCorners_.size(); i += 6) {
        cover({blockCorners_[i] - center_, blockCorners_[i + 2] - center_,
               blockCorners_[i + 4] - center_});
    }
    blur(sun, kShadowSide, 3);
    blur(contact, kShadowSide, 6);
    std::vector<uint8_t> pixels(size_t{kShadowSide} * kShadowSide * 4, 255);
    for (size_t i = 0; i < sun.size(); ++i) {
        pixels[i * 4] = static_cast<uint8_t>(std::clamp(sun[i] * 225.0f, 0.0f, 255.0f));
        pixels[i * 4 + 1] = static_cast<uint8_t>(std::clamp(contact[i] * 200.0f, 0.0f, 255.0f));
    }
    vkDeviceWaitIdle(host_.device);
    host_.destroy(shadow_);
    shadow_ = host_.createTexture(kShadowSide, kShadowSide, pixels.data(), false);
    writeSets();
}

void Studio::draw(const StageFrame& frame, VkCommandBuffer commands, const FwView& view,
                  std::span<const FwLight> fires) {
    Block block{};
    block.viewProjection = glm::make_mat4(view.projection) * glm::make_mat4(view.view);
    block.sunDirection = glm::vec4(glm::make_vec3(view.sunDirection), view.exposure);
    block.sunColor = glm::vec4(glm::make_vec3(view.sunColor), size_);
    block.ambientSky = glm::vec4(glm::make_vec3(view.ambientSky), 2.0f * size_);
    const size_t count = std::min<size_t>(fires.size(), kMostFires);
    block.ambientGround = glm::vec4(glm::make_vec3(view.ambientGround), static_cast<float>(count));
    block.center = glm::vec4(center_, 7.0f * size_);
    for (size_t i = 0; i < count; ++i) {
        const FwLight& fire = fires[i];
        const float radius = std::max(fire.radius, 0.05f * size_);
        block.firePlace[i] = glm::vec4(glm::make_vec3(fire.position), radius * radius);
        block.fireColor[i] =
            glm::vec4(glm::make_vec3(fire.color) * fire.intensity * fireGain, 0.0f);
    }
    std::memcpy(blocks_[frame.slot].mapped, &block, sizeof block);
    bind(frame, commands, vertices_, 0.0f);
    vkCmdBindIndexBuffer(commands, indices_.buffer, 0, VK_INDEX_TYPE_UINT32);
    vkCmdDrawIndexed(commands, indexCount_, 1, 0, 0, 0);
}

void Studio::bind(const StageFrame& frame, VkCommandBuffer commands, const Buffer& vertices,
                  float solid) {
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, 1,
                            &sets_[frame.slot], 0, nullptr);
    vkCmdPushConstants(commands, layout_, VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof solid, &solid);
    const VkDeviceSize zero = 0;
    vkCmdBindVertexBuffers(commands, 0, 1, &vertices.buffer, &zero);
}

void Studio::addBlock(glm::vec3 center, glm::vec3 half) {
    for (int face = 0; face < 6; ++face) {
        const int x = face / 2, y = (x + 1) % 3, z = (x + 2) % 3;
        glm::vec3 normal(0), corner[4];
        normal[x] = face & 1 ? 1.0f : -1.0f;
        for (int k = 0; k < 4; ++k) {
            corner[k] = center;
            corner[k][x] += normal[x] * half[x];
            corner[k][y] += ((k ^ (k >> 1)) & 1 ? normal[x] : -normal[x]) * half[y];
            corner[k][z] += (k & 2 ? 1.0f : -1.0f) * half[z];
        }
        for (int k : {0, 1, 2, 0, 2, 3}) {
            blockCorners_.push_back(corner[k]);
            blockCorners_.push_back(normal);
        }
    }
    host_.destroy(blockVertices_);
    blockVertices_ =
        host_.createFilledBuffer(blockCorners_.data(), blockCorners_.size() * sizeof(glm::vec3),
                                 VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
}

void Studio::drawBlocks(const StageFrame& frame, VkCommandBuffer commands) {
    if (blockCorners_.empty()) return;
    bind(frame, commands, blockVertices_, 1.0f);
    vkCmdDraw(commands, static_cast<uint32_t>(blockCorners_.size() / 2), 1, 0, 0);
}

void showStudio(const StageFrame& frame, Stage& stage, Studio& studio, FireHost& fire,
                const FwView& view) {
    FwLight lights[8];
    const uint32_t lightCount = fwWorld_GetLights(fire.world, lights, 8);
    fire.recordOutside(frame, view);
    stage.beginScene(frame);
    studio.draw(frame, frame.commands, view, {lights, lightCount});
    studio.drawBlocks(frame, frame.commands);
    fire.recordInside(frame, view);
    stage.endScene(frame);
    if (stage.made.capturesScene) fire.recordOver(frame, view, stage.captureScene(frame));
    stage.finish(frame);
}

}  // namespace sample
