// What the game hands to the renderer of each instance.
#pragma once

#include <glm/glm.hpp>

#include "village/model.h"

namespace tower {

inline glm::vec3 toGlm(village::Vec3 v) { return {v.x, v.y, v.z}; }

// One instance as it is this frame.
struct Placed {
    int model = 0;
    village::Frame frame;
    village::Vec3 tint{1, 1, 1};
    bool there = true;   // false: neither seen nor shading
    bool drawn = true;   // false: another draws it; it still casts a shadow
    bool moves = false;  // casts its shadow anew in every frame
};

}  // namespace tower
