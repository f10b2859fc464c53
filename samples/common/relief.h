// Surfaces with a relief that the host draws by bump mapping or by parallax occlusion mapping.
// Parallax adds depth, shadows and silhouettes, and its depth occludes the plugin's flames.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "common/stage.h"
#include "flamewright/flamewright.h"

namespace sample {

// Converts [0, 1] to a byte.
inline uint8_t toByte(float x) {
    return static_cast<uint8_t>(std::clamp(x, 0.0f, 1.0f) * 255.0f + 0.5f);
}

struct ReliefPicture {
    uint32_t width = 0, height = 0;  // texels
    glm::vec2 metres{1};             // m, size of the picture
    float depth = 0.05f;             // m, from the highest to the lowest point
    std::vector<uint8_t> color;      // RGBA8: square roots of linear colours; alpha: roughness
    std::vector<float> heights;      // [0, 1]; 1: on the drawn surface
};

// A vertex of the drawn surface. The relief lies below the surface that `normal` belongs to. This
// also holds for the side triangles of a relief block.
struct ReliefVertex {
    glm::vec3 position;  // m, world
    glm::vec3 normal;    // unit; normal of the relief's surface
    glm::vec3 across;    // unit; direction of the picture's u
    glm::vec2 at;        // m, position on the picture
    float depth = 0;     // m below the surface
    float curve = 0;     // 1/m, curvature of the surface along u; positive: convex
};

struct ReliefModel {
    ReliefPicture picture;
    std::vector<ReliefVertex> vertices;
    std::vector<uint32_t> indices;
    bool repeats = false;  // true: the picture tiles; false: the relief ends at its border
    float length = 0;      // m along v at which a tiled picture ends; 0: endless
};

// Adds a block with a relief on top. The top has `size` around `center` and equals the picture's
// size.
void addReliefBlock(ReliefModel& model, glm::vec3 center, glm::vec2 size);
// Adds a log from a to b, model.length apart. A whole number of pictures wraps around it.
void addReliefLog(ReliefModel& model, glm::vec3 a, glm::vec3 b, float radius);

enum class ReliefMode { kBump, kParallax };

class Relief {
 public:
    Relief(const VulkanHost& host, const Stage& stage, std::span<const ReliefModel> models);
    ~Relief();
    Relief(const Relief&) = delete;
    Relief& operator=(const Relief&) = delete;

    // Sets the camera and the lights of the frame. Call it once per frame, before the draws.
    void prepare(const StageFrame& frame, const FwView& view, std::span<const FwLight> fires);
    // Draws in the scene pass, within `area`, so that two modes can share a picture.
    void draw(const StageFrame& frame, ReliefMode mode, VkRect2D area);

    float fireGain = 0.02f;  // as Studio::fireGain

 private:
    struct Drawn {
        Image color, shape, horizon;
        uint32_t firstIndex = 0, indexCount = 0;
        bool curved = false;
        VkDescriptorSet set = VK_NULL_HANDLE;
        float push[8] = {};
    };
    const VulkanHost& host_;
    std::vector<Drawn> models_;
    Buffer vertices_, indices_;
    std::vector<Buffer> blocks_;  // one per frame in flight
    std::vector<VkDescriptorSet> sets_;
    VkSampler repeat_ = VK_NULL_HANDLE, clamp_ = VK_NULL_HANDLE;
    VkDescriptorSetLayout frameLayout_ = VK_NULL_HANDLE, modelLayout_ = VK_NULL_HANDLE;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkPipeline pipelines_[2][2] = {};  // by mode; flat models, curved models
};

}  // namespace sample
