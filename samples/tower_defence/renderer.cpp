// See renderer.h. One vertex and one index buffer for everything, one instance stream per frame
// slot, one descriptor set per painted surface.
#include "renderer.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>

#include "common/pipeline.h"

namespace tower {

namespace {

#include "land.frag.h"
#include "village.frag.h"
#include "village.vert.h"

using village::Vec3;

constexpr uint32_t kMaxLights = 16;

struct FrameUniform {  // mirrors shaders/frame.glsl
    glm::mat4 viewProjection, shadowMatrix;
    glm::vec4 eye, toSun, sun, sky, ground, haze, cameraRight, cameraUp, wind;
    glm::vec4 lightPlaces[kMaxLights], lightColors[kMaxLights];
};

struct DrawnVertex {
    float position[3], normal[3], uv[2], traits[4];
};

struct DrawnInstance {
    glm::vec4 rows[3], tint;
};

DrawnVertex drawnVertex(const village::Vertex& v, float openSky) {
    const bool soft = v.material == village::Material::kLeaf ||
                      v.material == village::Material::kStraw ||
                      v.material == village::Material::kCloth;
    return {{v.position.x, v.position.y, v.position.z},
            {v.normal.x, v.normal.y, v.normal.z},
            {v.uv.x, v.uv.y},
            {openSky, v.texture == village::Texture::kGlow ? v.glow : 0.0f, soft ? 1.0f : 0.0f,
             v.sway}};
}

DrawnInstance drawnInstance(const village::Frame& f, Vec3 tint) {
    return {{{f.x.x, f.y.x, f.z.x, f.origin.x},
             {f.x.y, f.y.y, f.z.y, f.origin.y},
             {f.x.z, f.y.z, f.z.z, f.origin.z}},
            {tint.x, tint.y, tint.z, 1}};
}

const std::vector<VkVertexInputBindingDescription> kBindings = {
    {0, sizeof(DrawnVertex), VK_VERTEX_INPUT_RATE_VERTEX},
    {1, sizeof(DrawnInstance), VK_VERTEX_INPUT_RATE_INSTANCE}};
const std::vector<VkVertexInputAttributeDescription> kAttributes = {
    {0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(DrawnVertex, position)},
    {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(DrawnVertex, normal)},
    {2, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(DrawnVertex, uv)},
    {3, 0, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(DrawnVertex, traits)},
    {4, 1, VK_FORMAT_R32G32B32A32_SFLOAT, 0},
    {5, 1, VK_FORMAT_R32G32B32A32_SFLOAT, 16},
    {6, 1, VK_FORMAT_R32G32B32A32_SFLOAT, 32},
    {7, 1, VK_FORMAT_R32G32B32A32_SFLOAT, 48}};
const std::vector<VkVertexInputAttributeDescription> kCasterAttributes = {
    kAttributes[0], kAttributes[4], kAttributes[5], kAttributes[6]};
constexpr float kFineWithin = 36.0f;        // m; beyond it, models skip their fine parts
constexpr uint32_t kMostTriangles = 20000;  // per view

bool isHerb(village::Kit model) {
    return model == village::Kit::kDryGrass || model == village::Kit::kFlowers ||
           model == village::Kit::kReeds;
}

// The shadow map covers the whole play area and ignores the camera, so shadows never shimmer.
glm::mat4 sunClip(glm::vec3 toSun, float* texel) {
    const glm::vec3 centre(0.0f, 1.0f, -4.0f);
    constexpr float kWide = 29.0f;
    const glm::mat4 view = glm::lookAtRH(centre + toSun * 70.0f, centre, glm::vec3(0, 1, 0));
    // The play area is wider than deep, so each axis of the sun's view is fitted separately.
    float reachX = 0, reachY = 0;
    for (float x : {-kWide + 1.5f, kWide - 3.0f}) {
        for (float z : {-25.0f, 17.5f}) {
            for (float y : {0.0f, 6.0f}) {
                const glm::vec4 p = view * glm::vec4(x, y, z, 1);
                reachX = std::max(reachX, std::fabs(p.x));
                reachY = std::max(reachY, std::fabs(p.y));
            }
        }
    }
    glm::mat4 projection(1.0f);
    projection[0][0] = 1 / reachX;
    projection[1][1] = 1 / reachY;
    projection[2][2] = -1 / 140.0f;
    *texel = 2 * std::max(reachX, reachY) / float(kShadowSide);
    return projection * view;
}

glm::mat4 clipToPicture() {
    glm::mat4 m(1.0f);
    m[0][0] = m[1][1] = 0.5f;
    m[3][0] = m[3][1] = 0.5f;
    return m;
}

}  // namespace

Renderer::Renderer(const sample::VulkanHost& host, const sample::Stage& stage,
                   const village::Scene& scene, const PaintedVillage& painted, Ground ground)
    : host_(host), shadows_(host, kBindings, kCasterAttributes) {
    // One mip at a time, because a software device pays for every texel it reads.
    sampler_ = host.createSampler(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                  VK_SAMPLER_MIPMAP_MODE_NEAREST);
    makeLayouts();
    makeGeometry(scene, painted);
    makeSlots(stage.made.framesInFlight, scene.instances.size());
    makePipelines(stage, ground);
}

Renderer::~Renderer() {
    vkDeviceWaitIdle(host_.device);
    for (VkPipeline p : {model_, groundPipeline_, roadPipeline_, waterPipeline_})
        vkDestroyPipeline(host_.device, p, nullptr);
    for (Surface& s : surfaces_) {
        host_.destroy(s.color);
        host_.destroy(s.relief);
    }
    for (Slot& s : slots_) {
        host_.destroy(s.uniform);
        host_.destroy(s.instances);
    }
    host_.destroy(vertices_);
    host_.destroy(indices_);
    vkDestroySampler(host_.device, sampler_, nullptr);
    vkDestroyDescriptorPool(host_.device, pool_, nullptr);
    vkDestroyPipelineLayout(host_.device, layout_, nullptr);
    vkDestroyDescriptorSetLayout(host_.device, frameLayout_, nullptr);
    vkDestroyDescriptorSetLayout(host_.device, surfaceLayout_, nullptr);
}

void Renderer::makeLayouts() {
    constexpr VkDescriptorType kImage = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    frameLayout_ = sample::makeSetLayout(host_, {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, kImage});
    surfaceLayout_ = sample::makeSetLayout(host_, {kImage, kImage});
    layout_ = sample::makeLayout(host_, {frameLayout_, surfaceLayout_},
                                 {VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(Push)});
    constexpr uint32_t kSets = 64;
    pool_ = sample::makeSetPool(host_, kSets, 4, 2 * kSets);
}

void Renderer::makeSurface(const village::Model& model, const Painting& painting, village::Vec2 low,
                           village::Vec2 high, glm::vec2 metres) {
    Surface s;
    s.indexCount = uint32_t(model.indices.size());
    s.farIndexCount = uint32_t(model.farTriangles) * 3;
    s.middle = (model.low + model.high) * 0.5f;
    s.radius = 0.5f * village::length(model.high - model.low);
    s.set = sample::makeSet(host_, pool_, surfaceLayout_);
    s.color = host_.createTexture(painting.width, painting.height, painting.color.data(), false);
    s.relief = host_.createTexture(painting.width, painting.height, painting.relief.data(), false);
    sample::writeImage(host_, s.set, 0, sampler_, s.color.view);
    sample::writeImage(host_, s.set, 1, sampler_, s.relief.view);
    s.push = {{low.x, low.y, 1 / (high.x - low.x), 1 / (high.y - low.y)},
              {metres.x, metres.y, 0, 0}};
    surfaces_.push_back(s);
}

void Renderer::makeGeometry(const village::Scene& scene, const PaintedVillage& painted) {
    std::vector<DrawnVertex> vertices;
    std::vector<uint32_t> indices;
    auto append = [&](const village::Model& model, const std::vector<float>& openSky) {
        Surface& s = surfaces_.back();
        s.firstIndex = uint32_t(indices.size());
        s.firstVertex = int32_t(vertices.size());
        for (size_t i = 0; i < model.vertices.size(); ++i)
            vertices.push_back(drawnVertex(model.vertices[i], openSky.empty() ? 1.0f : openSky[i]));
        indices.insert(indices.end(), model.indices.begin(), model.indices.end());
    };
    for (size_t i = 0; i < scene.models.size(); ++i) {
        const village::Model& model = scene.models[i];
        makeSurface(model, painted.models[i].painting, {0, 0}, {1, 1}, glm::vec2(model.atlasSide));
        append(model, painted.models[i].openSky);
    }
    ground_ = surfaces_.size();
    makeSurface(scene.terrain, painted.ground, painted.groundLow, painted.groundHigh,
                glm::vec2(72));
    append(scene.terrain, {});
    road_ = surfaces_.size();
    makeSurface(scene.road, painted.road, painted.roadLow, painted.roadHigh,
                {village::kRoadWidth, village::roadLength()});
    append(scene.road, {});
    water_ = surfaces_.size();
    const Painting blank{1, 1, {0, 0, 0, 255}, {128, 128, 20, 0}};
    makeSurface(scene.water, blank, {0, 0}, {1, 1}, glm::vec2(1));
    append(scene.water, {});
    vertices_ = host_.createFilledBuffer(vertices.data(), vertices.size() * sizeof(DrawnVertex),
                                         VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    indices_ = host_.createFilledBuffer(indices.data(), indices.size() * sizeof(uint32_t),
                                        VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
}

void Renderer::makeSlots(uint32_t count, size_t instances) {
    slots_.resize(count);
    for (Slot& slot : slots_) {
        slot.uniform =
            host_.createBuffer(sizeof(FrameUniform), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, true);
        // Each instance may be in the visible list and in the shadow list. The land has one
        // instance.
        slot.instances = host_.createBuffer((instances * 2 + 1) * sizeof(DrawnInstance),
                                            VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, true);
        slot.set = sample::makeSet(host_, pool_, frameLayout_);
        sample::writeBuffer(host_, slot.set, 0, slot.uniform.buffer);
        sample::writeImage(host_, slot.set, 1, shadows_.sampler(), shadows_.view(),
                           VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
    }
}

void Renderer::makePipelines(const sample::Stage& stage, Ground ground) {
    sample::PipelineRequest request;
    request.pass = stage.scenePass;
    request.layout = layout_;
    request.samples = stage.made.samples;
    request.bindings = kBindings;
    request.attributes = kAttributes;
    request.depthCompare = stage.depthCompare();
    request.vertex = host_.createShader(kVillageVert, sizeof kVillageVert);
    // Shaders that write depth disable early depth tests, so models use one that does not.
    const VkShaderModule plain = host_.createShader(kVillageFrag, sizeof kVillageFrag);
    const VkShaderModule hollow = host_.createShader(kLandFrag, sizeof kLandFrag);
    VkPipeline* const pipelines[] = {&model_, &groundPipeline_, &roadPipeline_, &waterPipeline_};
    for (int32_t kind = 0; kind < 4; ++kind) {
        const VkSpecializationMapEntry entry{0, 0, sizeof kind};
        const VkSpecializationInfo special{1, &entry, sizeof kind, &kind};
        request.specialization = &special;
        const bool land = kind == 1 || kind == 2;
        request.fragment = land && ground == Ground::kParallax ? hollow : plain;
        *pipelines[kind] = sample::makePipeline(host_, request);
    }
    for (VkShaderModule shader : {request.vertex, plain, hollow})
        vkDestroyShaderModule(host_.device, shader, nullptr);
}

// Returns true if the sphere is in view.
static bool inView(const glm::mat4& viewProjection, glm::vec3 place, float radius) {
    const glm::mat4 rows = glm::transpose(viewProjection);
    const glm::vec4 planes[] = {rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1],
                                rows[3] - rows[1]};
    for (const glm::vec4& plane : planes)
        if (glm::dot(plane, glm::vec4(place, 1)) < -radius * glm::length(glm::vec3(plane)))
            return false;
    return true;
}

// Sorts the instances by model into runs: near, far, static shadow casters, moving shadow casters.
void Renderer::gather(Slot& slot, const SceneFrame& scene) {
    const float aspect = float(slot.extent.width) / float(slot.extent.height);
    const glm::mat4 viewProjection =
        sample::projectionMatrix(scene.camera, aspect) * sample::viewMatrix(scene.camera);
    enum Seen : uint8_t { kNot, kNear, kFar };
    std::vector<Seen> seen;
    struct Fine {
        float away;  // m from the camera
        size_t placed;
    };
    std::vector<Fine> fineWork, herbs;
    uint32_t triangles = (surfaces_[ground_].indexCount + surfaces_[road_].indexCount +
                          surfaces_[water_].indexCount) /
                         3;
    for (const Placed& p : scene.placed) {
        const Surface& s = surfaces_[size_t(p.model)];
        const Vec3 c = p.frame.point(s.middle);
        const glm::vec3 middle(c.x, c.y, c.z);
        const float radius = s.radius * village::length(p.frame.x);
        if (!p.there || !inView(viewProjection, middle, radius)) {
            seen.push_back(kNot);
            continue;
        }
        // The library draws a whole model at any distance.
        const float away = glm::length(middle - scene.camera.eye) - radius;
        const bool whole = !p.drawn || away < kFineWithin;
        if (p.drawn && whole) fineWork.push_back({away, seen.size()});
        if (p.drawn && isHerb(village::Kit(p.model))) herbs.push_back({away, seen.size()});
        seen.push_back(!p.drawn ? kNot : whole ? kNear : kFar);
        triangles += (whole ? s.indexCount : s.farIndexCount) / 3;
    }
    // In a crowd, the farthest models skip their fine parts. If much of it burns, herbs skip theirs
    // too.
    const auto farthestLast = [](std::vector<Fine>& list) {
        std::sort(list.begin(), list.end(),
                  [](const Fine& a, const Fine& b) { return a.away < b.away; });
    };
    farthestLast(fineWork);
    for (; triangles > kMostTriangles && !fineWork.empty(); fineWork.pop_back()) {
        const size_t i = fineWork.back().placed;
        const Surface& s = surfaces_[size_t(scene.placed[i].model)];
        seen[i] = kFar;
        triangles -= (s.indexCount - s.farIndexCount) / 3;
    }
    farthestLast(herbs);
    for (; triangles > kMostTriangles && !herbs.empty(); herbs.pop_back()) {
        const size_t i = herbs.back().placed;
        seen[i] = kNot;
        triangles -= surfaces_[size_t(scene.placed[i].model)].farIndexCount / 3;
    }
    mostTriangles_ = std::max(mostTriangles_, triangles);

    auto* out = static_cast<DrawnInstance*>(slot.instances.mapped);
    uint32_t used = 0;
    out[used++] = drawnInstance(village::Frame{}, {1, 1, 1});  // the land's instance
    auto collect = [&](std::vector<Run>& runs, bool fine, auto&& wanted) {
        for (size_t model = 0; model < ground_; ++model) {
            const Surface& s = surfaces_[model];
            const uint32_t first = used;
            for (size_t i = 0; i < scene.placed.size(); ++i) {
                const Placed& p = scene.placed[i];
                if (size_t(p.model) == model && wanted(i))
                    out[used++] = drawnInstance(p.frame, p.tint);
            }
            if (used > first)
                runs.push_back({model, fine ? s.indexCount : s.farIndexCount, first, used - first});
        }
    };
    solid_.clear();
    stillRuns_.clear();
    movingRuns_.clear();
    collect(solid_, true, [&](size_t i) { return seen[i] == kNear; });
    collect(solid_, false, [&](size_t i) { return seen[i] == kFar; });
    collect(stillRuns_, false,
            [&](size_t i) { return scene.placed[i].there && !scene.placed[i].moves; });
    collect(movingRuns_, false,
            [&](size_t i) { return scene.placed[i].there && scene.placed[i].moves; });
}

void Renderer::upload(Slot& slot, const sample::StageFrame& frame, const SceneFrame& scene) {
    const float aspect = float(frame.extent.width) / float(frame.extent.height);
    const glm::mat4 view = sample::viewMatrix(scene.camera);
    FrameUniform u{};
    float texel = 0;
    shadowClip_ = sunClip(scene.daylight.toSun, &texel);
    u.viewProjection = sample::projectionMatrix(scene.camera, aspect) * view;
    u.shadowMatrix = clipToPicture() * shadowClip_;
    u.eye = glm::vec4(scene.camera.eye, float(kShadowSide));
    u.toSun = glm::vec4(scene.daylight.toSun, texel);
    const size_t lights = std::min<size_t>(scene.lights.size(), kMaxLights);
    u.sun = glm::vec4(scene.daylight.sun, float(lights));
    u.sky = glm::vec4(scene.daylight.sky, scene.daylight.windows);
    u.ground = glm::vec4(scene.daylight.ground, 0);
    u.haze = glm::vec4(scene.daylight.haze, 0);
    u.cameraRight = glm::vec4(view[0][0], view[1][0], view[2][0], scene.daylight.emission);
    u.cameraUp = glm::vec4(view[0][1], view[1][1], view[2][1], float(frame.time));
    u.wind = glm::vec4(scene.wind.velocity, scene.wind.blown);
    for (size_t i = 0; i < lights; ++i) {
        u.lightPlaces[i] = glm::vec4(scene.lights[i].place, scene.lights[i].reach);
        u.lightColors[i] = glm::vec4(scene.lights[i].color, scene.lights[i].size);
    }
    std::memcpy(slot.uniform.mapped, &u, sizeof u);
}

void Renderer::bindGeometry(VkCommandBuffer commands, const Slot& slot) const {
    const VkBuffer buffers[] = {vertices_.buffer, slot.instances.buffer};
    const VkDeviceSize offsets[] = {0, 0};
    vkCmdBindVertexBuffers(commands, 0, 2, buffers, offsets);
    vkCmdBindIndexBuffer(commands, indices_.buffer, 0, VK_INDEX_TYPE_UINT32);
}

void Renderer::prepare(const sample::StageFrame& frame, const SceneFrame& scene) {
    Slot& slot = slots_[frame.slot];
    slot.extent = frame.extent;
    gather(slot, scene);
    upload(slot, frame, scene);
    shadows_.record(frame.commands, shadowClip_, [&](bool moving) {
        bindGeometry(frame.commands, slot);
        for (const Run& run : moving ? movingRuns_ : stillRuns_) drawRun(frame.commands, run);
    });
}

void Renderer::drawRun(VkCommandBuffer commands, const Run& run) const {
    const Surface& s = surfaces_[run.surface];
    vkCmdDrawIndexed(commands, run.indexCount, run.count, s.firstIndex, s.firstVertex, run.first);
}

void Renderer::drawSolid(const sample::StageFrame& frame) {
    const Slot& slot = slots_[frame.slot];
    VkCommandBuffer commands = frame.commands;
    bindGeometry(commands, slot);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, 1, &slot.set, 0,
                            nullptr);
    auto draw = [&](const Run& run) {
        const Surface& s = surfaces_[run.surface];
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 1, 1, &s.set, 0,
                                nullptr);
        vkCmdPushConstants(commands, layout_, VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof s.push,
                           &s.push);
        drawRun(commands, run);
    };
    auto drawLand = [&](size_t surface) { draw({surface, surfaces_[surface].indexCount, 0, 1}); };
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, model_);
    for (const Run& run : solid_) draw(run);
    // The land comes last, so that models occlude most of it before shading.
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, roadPipeline_);
    drawLand(road_);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, waterPipeline_);
    drawLand(water_);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, groundPipeline_);
    drawLand(ground_);
}

}  // namespace tower
