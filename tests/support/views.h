// Views for tests and benches: Vulkan clip space, world y up.
#pragma once
#include "flamewright/flamewright.h"

#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <cstring>

namespace fw::test {

// Perspective without a far plane. zoom: of half the height; aspect: width / height.
inline FwView viewAt(glm::vec3 eye, glm::vec3 target, float aspect, float zoom = 3.4f,
                     float nearest = 0.05f) {
    FwView view = fwDefaultView();
    const glm::mat4 look = glm::lookAt(eye, target, glm::vec3(0, 1, 0));
    glm::mat4 projection(0.0f);
    projection[0][0] = zoom / aspect;
    projection[1][1] = -zoom;
    projection[2][2] = projection[2][3] = -1.0f;
    projection[3][2] = -nearest;
    std::memcpy(view.view, glm::value_ptr(look), sizeof view.view);
    std::memcpy(view.projection, glm::value_ptr(projection), sizeof view.projection);
    return view;
}

// Orthographic from 1 m in front of z = 0: `across` m wide and `up` m high around `middle`.
inline FwView frontView(glm::vec2 middle, float across, float up) {
    FwView view = fwDefaultView();
    const glm::mat4 look = glm::translate(glm::mat4(1.0f), glm::vec3(-middle, -1));
    glm::mat4 projection(1.0f);
    projection[0][0] = 2 / across;
    projection[1][1] = -2 / up;
    projection[2][2] = -0.25f;
    std::memcpy(view.view, glm::value_ptr(look), sizeof view.view);
    std::memcpy(view.projection, glm::value_ptr(projection), sizeof view.projection);
    return view;
}

}  // namespace fw::test
