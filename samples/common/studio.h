// A photographer's backdrop with floor, wall, one soft shadow, and the light of the reported fires.
// The host draws it in its own pass before the plugin.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "common/camera.h"
#include "common/fire_host.h"
#include "common/options.h"
#include "common/stage.h"
#include "flamewright/flamewright.h"

namespace sample {

class Studio {
 public:
    // `center`: on the floor; `size`: m, about the object's largest side.
    Studio(const VulkanHost& host, const Stage& stage, glm::vec3 center, float size);
    // For a host whose scene pass does not come from a Stage.
    Studio(const VulkanHost& host, const ScenePass& pass, glm::vec3 center, float size);
    ~Studio();
    Studio(const Studio&) = delete;
    Studio& operator=(const Studio&) = delete;

    // Renders the soft shadow of the mesh and the blocks onto the floor, once.
    void castShadow(std::span<const float> positions, std::span<const uint32_t> indices,
                    const glm::mat4& transform, glm::vec3 sunDirection);
    // Adds an axis-aligned stone block for drawBlocks. Call it before the first frame.
    void addBlock(glm::vec3 center, glm::vec3 half);
    // Draws the backdrop. `view`: camera and light; `commands`: inside the scene pass.
    void draw(const StageFrame& frame, VkCommandBuffer commands, const FwView& view,
              std::span<const FwLight> fires);
    // Draws the blocks. Call it after draw() of the same frame, so that the host draws behind and
    // in front of the fire.
    void drawBlocks(const StageFrame& frame, VkCommandBuffer commands);

    float fireGain = 0.02f;  // irradiance at 1 m per unit of FwLight::intensity, cd per W/sr

 private:
    void writeSets();
    void bind(const StageFrame& frame, VkCommandBuffer commands, const Buffer& vertices,
              float solid);
    const VulkanHost& host_;
    glm::vec3 center_;
    float size_;
    uint32_t indexCount_ = 0;
    Buffer vertices_, indices_, blockVertices_;
    std::vector<glm::vec3> blockCorners_;  // position, normal, position, normal, ...
    std::vector<Buffer> blocks_;           // one per frame in flight
    Image plaster_, shadow_;
    VkSampler repeat_ = VK_NULL_HANDLE, clamp_ = VK_NULL_HANDLE;
    VkDescriptorSetLayout setLayout_ = VK_NULL_HANDLE;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    std::vector<VkDescriptorSet> sets_;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkPipeline pipeline_ = VK_NULL_HANDLE;
};

// Records a whole studio frame: the fire's step, the backdrop lit by the fires, the blocks, and the
// fire. The lights come from before this frame's step.
void showStudio(const StageFrame& frame, Stage& stage, Studio& studio, FireHost& fire,
                const FwView& view);

// Sets evening light, which shows fire best. Fills all fields of the view but the matrices.
void duskLight(FwView& view, float share = 1.0f);  // share of that light, for night and noon

// Camera side and light of a fire sample, by option names. `view`: "side", "above", "below" or
// "inside". `light`: "night", "day" or "sky" (a bright sky behind the fires).
struct FireLook {
    std::string view = "side", light = "night";
    void addTo(OptionParser& parser);
    // Turns a side camera to the chosen view. `within`: a point inside one of the fires. Throws
    // Failure.
    Camera camera(const OrbitCamera& orbit, glm::vec3 within) const;
    void applyLight(FwView& lit, float night, float day) const;  // shares as in duskLight
};

}  // namespace sample
