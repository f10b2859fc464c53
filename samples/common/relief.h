// Surfaces with a relief, drawn by the host: by bump mapping, or by parallax occlusion mapping with
// its own depth, shadows and silhouettes. What lies in a relief may hide what the plugin draws.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "common/stage.h"
#include "flamewright/flamewright.h"

namespace sample {

// A share in [0, 1] as a byte.
inline uint8_t toByte(float x) {
    return static_cast<uint8_t>(std::clamp(x, 0.0f, 1.0f) * 255.0f + 0.5f);
}

struct ReliefPicture {
    uint32_t width = 0, height = 0;  // texels
    glm::vec2 metres{1};             // the picture's size
    float depth = 0.05f;             // m, from the highest to the lowest
    std::vector<uint8_t> color;      // RGBA8: square roots of linear colours, roughness
    std::vector<float> heights;      // [0, 1], 1 on the surface that is drawn
};

// A corner of what is drawn. The relief lies below the surface whose normal this is, also where
// the triangle itself is a side of the block that the relief is cut from.
struct ReliefVertex {
    glm::vec3 position;  // m, world
    glm::vec3 normal;    // unit, of the surface
    glm::vec3 across;    // unit, along the picture's u
    glm::vec2 at;        // m on the picture
    float depth = 0;     // m below the surface
    float curve = 0;     // 1/m, how the surface bends along u; outwards positive
};

struct ReliefModel {
    ReliefPicture picture;
    std::vector<ReliefVertex> vertices;
    std::vector<uint32_t> indices;
    bool repeats = false;  // the picture goes on and on; otherwise the relief ends at its border
    float length = 0;      // m along v that a picture goes on for that repeats; 0: for ever
};

// A block that a relief is cut from: its top is `size` around `center`, as large as the picture.
void addReliefBlock(ReliefModel& model, glm::vec3 center, glm::vec2 size);
// A log from a to b, model.length apart. Around it goes a whole number of pictures.
void addReliefLog(ReliefModel& model, glm::vec3 a, glm::vec3 b, float radius);

enum class ReliefMode { kBump, kParallax };

class Relief {
 public:
    Relief(const VulkanHost& host, const Stage& stage, std::span<const ReliefModel> models);
    ~Relief();
    Relief(const Relief&) = delete;
    Relief& operator=(const Relief&) = delete;

    // What the frame is seen by, once a frame before the draws.
    void prepare(const StageFrame& frame, const FwView& view, std::span<const FwLight> fires);
    // In the scene pass, within `area`: two modes can share a picture.
    void draw(const StageFrame& frame, ReliefMode mode, VkRect2D area);

    float fireGain = 0.02f;  // as Studio's

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
    std::vector<Buffer> blocks_;  // one for each frame in flight
    std::vector<VkDescriptorSet> sets_;
    VkSampler repeat_ = VK_NULL_HANDLE, clamp_ = VK_NULL_HANDLE;
    VkDescriptorSetLayout frameLayout_ = VK_NULL_HANDLE, modelLayout_ = VK_NULL_HANDLE;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkPipeline pipelines_[2][2] = {};  // of a mode; of flat models, of those with round surfaces
};

}  // namespace sample
