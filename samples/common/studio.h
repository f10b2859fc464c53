// A photographer's backdrop drawn by the host, in the host's pass, before the plugin draws: floor,
// wall, one soft shadow, and the light of the fires as the plugin reports it.
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
    // `center` is on the floor; `size` is about the object's largest side, m.
    Studio(const VulkanHost& host, const Stage& stage, glm::vec3 center, float size);
    // For a host whose scene pass is not a stage's.
    Studio(const VulkanHost& host, const ScenePass& pass, glm::vec3 center, float size);
    ~Studio();
    Studio(const Studio&) = delete;
    Studio& operator=(const Studio&) = delete;

    // Casts the shadows of the mesh and of the blocks onto the floor, softly, once.
    void castShadow(std::span<const float> positions, std::span<const uint32_t> indices,
                    const glm::mat4& transform, glm::vec3 sunDirection);
    // A block of stone, axis-aligned, for drawBlocks. Before the first frame.
    void addBlock(glm::vec3 center, glm::vec3 half);
    // `view` carries the camera and the light. `commands`: in the scene pass.
    void draw(const StageFrame& frame, VkCommandBuffer commands, const FwView& view,
              std::span<const FwLight> fires);
    // The blocks, after draw() of the same frame; a host draws behind and in front of the fire.
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
    std::vector<Buffer> blocks_;           // one for each frame in flight
    Image plaster_, shadow_;
    VkSampler repeat_ = VK_NULL_HANDLE, clamp_ = VK_NULL_HANDLE;
    VkDescriptorSetLayout setLayout_ = VK_NULL_HANDLE;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    std::vector<VkDescriptorSet> sets_;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkPipeline pipeline_ = VK_NULL_HANDLE;
};

// The whole of a frame in a studio: the fire's step, the backdrop in the light of the fires, the
// blocks, and the fire. Lights are those before this frame's step.
void showStudio(const StageFrame& frame, Stage& stage, Studio& studio, FireHost& fire,
                const FwView& view);

// Evening light in a studio, the light in which fire reads best; fills all but the matrices.
void duskLight(FwView& view, float share = 1.0f);  // share: of that light, for night and noon

// From where and in what light fires are looked at, as options name it: view is "side", "above",
// "below" or "inside", light is "night", "day" or "sky", a bright one behind the fires.
struct FireLook {
    std::string view = "side", light = "night";
    void addTo(OptionParser& parser);
    // Turns a camera that looks from the side. `within`: a place in one of the fires. Throws
    // Failure.
    Camera camera(const OrbitCamera& orbit, glm::vec3 within) const;
    void lightUp(FwView& lit, float night, float day) const;  // shares, as duskLight takes them
};

}  // namespace sample
