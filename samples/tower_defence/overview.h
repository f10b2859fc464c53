// The strategy camera: fixed heading, 45 degrees down; pans and zooms.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "common/camera.h"
#include "common/stage.h"

namespace tower {

struct Overview {
    glm::vec2 pan{0, 0.8f};  // m, x and z, within +-8
    float zoom = 1;          // factor of the distance, [0.35, 1.3]

    sample::Camera camera() const {
        const glm::vec3 target(-1.5f + pan.x, 0.2f, -2.9f + pan.y);
        sample::Camera camera;
        camera.target = target;
        camera.eye = target + zoom * glm::vec3(0.0f, 35.8f, 36.3f);
        camera.fieldOfView = glm::radians(29.0f);
        camera.nearPlane = 4.0f;
        camera.farPlane = 150.0f;
        return camera;
    }
    void steer(const sample::Input& input, float deltaTime, VkExtent2D size) {
        const float metres = 47.0f * zoom / std::max(1.0f, float(size.width));  // m per pixel
        pan.x += -metres * (input.dragX + input.panX) + 14 * zoom * deltaTime * input.moveRight;
        pan.y +=
            -1.4f * metres * (input.dragY + input.panY) - 14 * zoom * deltaTime * input.moveForward;
        pan = glm::clamp(pan, glm::vec2(-8), glm::vec2(8));
        zoom = std::clamp(zoom * std::pow(0.92f, input.wheel), 0.35f, 1.3f);
    }
    // Without input: moves slowly from the whole village down to the fire.
    void follow(float share) {
        const float t = share * share * (3 - 2 * share);
        pan = glm::mix(glm::vec2(0, 0.8f), glm::vec2(-1.7f, 7.6f), t);
        zoom = std::exp(std::log(0.5f) * t);
    }
};

// Converts between the world and a picture's pixels.
struct Lens {
    glm::mat4 clip{1.0f};
    glm::vec3 eye{0};
    glm::vec2 size{1};  // px

    Lens(const sample::Camera& camera, VkExtent2D extent)
        : eye(camera.eye), size(float(extent.width), float(extent.height)) {
        clip = sample::projectionMatrix(camera, size.x / size.y) * sample::viewMatrix(camera);
    }
    glm::vec2 project(glm::vec3 place) const {
        const glm::vec4 p = clip * glm::vec4(place, 1);
        return (glm::vec2(p) / p.w * 0.5f + 0.5f) * size;
    }
    // Returns the intersection of a pixel's ray with the level at height `high` (m).
    glm::vec3 ground(glm::vec2 pixel, float high) const {
        const glm::vec2 ndc = pixel / size * 2.0f - 1.0f;
        const glm::vec4 far = glm::inverse(clip) * glm::vec4(ndc, 1, 1);
        const glm::vec3 direction = glm::vec3(far) / far.w - eye;
        return eye + direction * ((high - eye.y) / direction.y);
    }
};

}  // namespace tower
