// Cameras for the samples: right-handed world, y up, Vulkan clip space (y down, depth 0 to 1).
// Matrices are column-major and without jitter, as the plugin requires.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace sample {

struct Camera {
    glm::vec3 eye{0.0f, 1.0f, 3.0f};  // m
    glm::vec3 target{0.0f};           // m
    glm::vec3 up{0.0f, 1.0f, 0.0f};
    float fieldOfView = 0.7f;  // rad, vertical
    float nearPlane = 0.05f;   // m
    float farPlane = 200.0f;   // m
};

inline glm::mat4 viewMatrix(const Camera& camera) {
    return glm::lookAtRH(camera.eye, camera.target, camera.up);
}

// `reversed`: near is 1 and far is 0, which gives distant depths more precision.
inline glm::mat4 projectionMatrix(const Camera& camera, float aspect, bool reversed = false) {
    const float scale = 1.0f / std::tan(0.5f * camera.fieldOfView);
    const float near = reversed ? camera.farPlane : camera.nearPlane;
    const float far = reversed ? camera.nearPlane : camera.farPlane;
    glm::mat4 result(0.0f);
    result[0][0] = scale / aspect;
    result[1][1] = -scale;
    result[2][2] = far / (near - far);
    result[2][3] = -1.0f;
    result[3][2] = near * far / (near - far);
    return result;
}

// Orbits a point: drag turns, wheel zooms.
struct OrbitCamera {
    glm::vec3 target{0.0f};    // m
    float distance = 3.0f;     // m
    float yaw = 0.5f;          // rad; 0: looks along -z
    float pitch = 0.25f;       // rad above the horizon
    float fieldOfView = 0.6f;  // rad

    Camera camera() const {
        Camera result;
        result.target = target;
        result.eye = target + distance * glm::vec3(std::sin(yaw) * std::cos(pitch), std::sin(pitch),
                                                   std::cos(yaw) * std::cos(pitch));
        result.fieldOfView = fieldOfView;
        result.nearPlane = std::max(0.002f, 0.02f * distance);
        result.farPlane = 60.0f * distance;
        return result;
    }
    void turn(float dx, float dy) {  // pixels
        yaw -= 0.008f * dx;
        pitch = std::clamp(pitch + 0.008f * dy, -0.1f, 1.5f);
    }
    void zoom(float notches) { distance *= std::pow(0.9f, notches); }
};

}  // namespace sample
