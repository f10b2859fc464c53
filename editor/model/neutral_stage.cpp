// See neutral_stage.h.
#include "model/neutral_stage.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace fwmodel {

FwView neutralView(const std::array<float, 3>& low, const std::array<float, 3>& high,
                   const NeutralCamera& camera, uint32_t width, uint32_t height) {
    constexpr float kFilled = 0.9f;       // share of the picture's height, or of its width
    constexpr float kFieldOfView = 0.5f;  // rad, vertical
    const float yaw = glm::radians(camera.yaw), pitch = glm::radians(camera.pitch);
    const glm::vec3 back(std::sin(yaw) * std::cos(pitch), std::sin(pitch),
                         std::cos(yaw) * std::cos(pitch));
    const glm::vec3 side(std::cos(yaw), 0, -std::sin(yaw)), up = glm::cross(back, side);
    const float aspect = static_cast<float>(width) / static_cast<float>(std::max(1u, height));
    const float tall = kFilled * std::tan(0.5f * kFieldOfView), wide = tall * aspect;

    const glm::vec3 least(low[0], low[1], low[2]), most(high[0], high[1], high[2]);
    const glm::vec3 middle = 0.5f * (least + most);
    const float radius = std::max(0.5f * glm::length(most - least), 1e-6f);
    float distance = 0;
    for (int corner = 0; corner < 8; ++corner) {
        glm::vec3 p;
        for (int c = 0; c < 3; ++c) p[c] = (corner >> c & 1 ? most : least)[c] - middle[c];
        distance =
            std::max(distance, glm::dot(p, back) + std::max(std::abs(glm::dot(p, side)) / wide,
                                                            std::abs(glm::dot(p, up)) / tall));
    }
    distance = std::max(distance, 1.01f * radius);

    FwView view = fwDefaultView();
    const glm::mat4 matrix = glm::lookAtRH(middle + distance * back, middle, up);
    std::memcpy(view.view, &matrix[0][0], sizeof view.view);
    const float near = std::max(distance - 1.1f * radius, 1e-3f * distance);
    const float far = distance + 1.1f * radius;
    setPerspective(view, kFieldOfView, aspect, near, far);
    for (size_t c = 0; c < 3; ++c) {
        view.sunColor[c] = 0;
        view.ambientSky[c] = 1.1f;
        view.ambientGround[c] = 0.95f;  // slightly darker from below, so that shapes remain visible
    }
    view.exposure = 1;
    view.emissionScale = 1;
    return view;
}

void setPerspective(FwView& view, float fieldOfView, float aspect, float near, float far) {
    const float scale = 1.0f / std::tan(0.5f * fieldOfView);
    std::fill(std::begin(view.projection), std::end(view.projection), 0.0f);
    view.projection[0] = scale / aspect;
    view.projection[5] = -scale;
    view.projection[10] = far / (near - far);
    view.projection[11] = -1;
    view.projection[14] = near * far / (near - far);
}

}  // namespace fwmodel
