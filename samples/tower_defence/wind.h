// The visible wind, which sways plants and cloth.
#pragma once

#include <glm/glm.hpp>

namespace tower {

struct Wind {
    glm::vec2 velocity{0};  // m/s along x and z
    glm::vec2 blown{0};     // m, distance that gusts have moved
};

}  // namespace tower
