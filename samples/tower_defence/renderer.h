// The host's renderer of this sample: a small forward renderer with a sun shadow map. Draws the
// land, the pond and all models that the fire library does not draw. Fires reach it only as lights.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "common/camera.h"
#include "common/stage.h"
#include "light.h"
#include "paint.h"
#include "placed.h"
#include "shadow_map.h"
#include "wind.h"

namespace tower {

// Technique for the land's relief.
enum class Ground { kBump, kParallax };

struct SceneFrame {
    sample::Camera camera;
    Daylight daylight;
    std::span<const Placed> placed;
    std::span<const PointLight> lights;  // strongest first; the renderer uses at most 16
    Wind wind;                           // moves grass, leaves and cloth
};

class Renderer {
 public:
    Renderer(const sample::VulkanHost& host, const sample::Stage& stage,
             const village::Scene& scene, const PaintedVillage& painted, Ground ground);
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    // Uploads the frame and draws the shadow map. Call it outside any pass.
    void prepare(const sample::StageFrame& frame, const SceneFrame& scene);
    // Draws all opaque geometry, inside the stage's scene pass.
    void drawSolid(const sample::StageFrame& frame);

    // Returns the most triangles of one view so far, including the library's.
    uint32_t mostTriangles() const { return mostTriangles_; }

 private:
    struct Push {
        float uvWindow[4], metres[4];
    };
    struct Surface {  // draw data of one model
        uint32_t firstIndex = 0, indexCount = 0;
        uint32_t farIndexCount = 0;  // without the fine parts
        int32_t firstVertex = 0;
        VkDescriptorSet set = VK_NULL_HANDLE;
        sample::Image color, relief;
        Push push{};
        village::Vec3 middle;  // m, model space
        float radius = 0;      // m
    };
    struct Run {  // instances of one model, contiguous in the slot's buffer
        size_t surface;
        uint32_t indexCount;
        uint32_t first, count;
    };
    struct Slot {
        sample::Buffer uniform, instances;
        VkDescriptorSet set = VK_NULL_HANDLE;
        VkExtent2D extent{};
    };

    void makeLayouts();
    void makeGeometry(const village::Scene& scene, const PaintedVillage& painted);
    void makeSurface(const village::Model& model, const Painting& painting, village::Vec2 low,
                     village::Vec2 high, glm::vec2 metres);
    void makeSlots(uint32_t count, size_t instances);
    void makePipelines(const sample::Stage& stage, Ground ground);
    void gather(Slot& slot, const SceneFrame& scene);
    void upload(Slot& slot, const sample::StageFrame& frame, const SceneFrame& scene);
    void drawRun(VkCommandBuffer commands, const Run& run) const;
    void bindGeometry(VkCommandBuffer commands, const Slot& slot) const;

    const sample::VulkanHost& host_;
    std::vector<Surface> surfaces_;  // the scene's models, then ground, road, water
    size_t ground_ = 0, road_ = 0, water_ = 0;
    sample::Buffer vertices_, indices_;
    std::vector<Slot> slots_;
    std::vector<Run> solid_, stillRuns_, movingRuns_;
    uint32_t mostTriangles_ = 0;
    glm::mat4 shadowClip_{1.0f};
    ShadowMap shadows_;

    VkSampler sampler_ = VK_NULL_HANDLE;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkDescriptorSetLayout frameLayout_ = VK_NULL_HANDLE, surfaceLayout_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkPipeline model_ = VK_NULL_HANDLE, groundPipeline_ = VK_NULL_HANDLE;
    VkPipeline roadPipeline_ = VK_NULL_HANDLE, waterPipeline_ = VK_NULL_HANDLE;
};

}  // namespace tower
