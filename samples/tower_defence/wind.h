// The wind as it is seen: what sways goes by it.
#pragma once

#include <glm/glm.hpp>

namespace tower {

struct Wind {
    glm::vec2 velocity{0};  // m/s along x and z
    glm::vec2 blown{0};     // m, how far it has carried its gusts
};

}  // namespace tower
