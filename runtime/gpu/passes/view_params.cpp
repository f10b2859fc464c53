// The clip matrix takes positions relative to the camera, so that it stays precise far from the
// world's origin.
#include "gpu/passes/draw.h"

#include "core/assert.h"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cmath>

namespace fw::gpu {

ViewParams makeViewParams(const ViewInput& input) noexcept {
    FW_ASSERT(input.view);
    const FwView& view = *input.view;
    const glm::mat4 toView = glm::make_mat4(view.view),
                    projection = glm::make_mat4(view.projection);
    const glm::mat3 rotation(toView);  // rigid: the inverse is the transpose
    const vec3 eye = -(glm::transpose(rotation) * vec3(toView[3]));
    const glm::mat4 clip = projection * glm::mat4(rotation);

    FW_ASSERT(input.quadShare > 0 && input.lastLight > 0, "quads %g, last light %g",
              double(input.quadShare), double(input.lastLight));
    ViewParams p{};
    p.clip0 = clip[0];
    p.clip1 = clip[1];
    p.clip2 = clip[2];
    p.clip3 = clip[3];
    const float height = std::max(input.viewport[3], 1.0f);
    const float zoom = std::max(std::fabs(projection[1][1]), 1e-6f);
    p.eye = vec4(eye, 2.0f / (zoom * height));
    // The direction in which clip w grows, whatever the host's view space.
    const float side = projection[2][3] > 0.0f ? 1.0f : -1.0f;
    const vec3 forward = side * vec3(rotation[0][2], rotation[1][2], rotation[2][2]);
    p.forward = vec4(forward, projection[2][3] != 0.0f ? 1.0f : 0.0f);
    const auto rgb = [](const float v[3], float w) { return vec4(v[0], v[1], v[2], w); };
    p.sunDirection = rgb(view.sunDirection, view.exposure);
    p.sunColor = rgb(view.sunColor, view.emissionScale);
    p.ambientSky = rgb(view.ambientSky, std::fmod(view.time, 4096.0f));
    p.ambientGround = rgb(view.ambientGround, input.tickFraction);
    p.up = rgb(input.up, input.paceFactor);
    // Depth at 1 and at 2 m from the camera: reversed depth falls.
    const auto depthAt = [&](float metres) {
        const float z = side * metres;
        return (projection[2][2] * z + projection[3][2]) /
               (projection[2][3] * z + projection[3][3]);
    };
    p.wind = rgb(input.wind, depthAt(2) < depthAt(1) ? -1.0f : 2.0f);
    p.now = input.now;
    p.lightCount = input.lightCount;
    p.flameCapacity = std::min(input.flameCapacity, kFlameCapacity);
    p.seed = input.seed;
    p.quads = vec4(input.quadShare, 1.0f / std::sqrt(input.quadShare), input.lastLight,
                   input.bodies ? 1.0f : 0.0f);
    p.viewport = vec4(input.viewport[0], input.viewport[1], input.viewport[2], input.viewport[3]);
    return p;
}

}  // namespace fw::gpu
