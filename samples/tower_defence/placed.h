// State of the instances that the game passes to the renderer.
#pragma once

#include <glm/glm.hpp>

#include "village/model.h"

namespace tower {

inline glm::vec3 toGlm(village::Vec3 v) { return {v.x, v.y, v.z}; }

// One instance in this frame.
struct Placed {
    int model = 0;
    village::Frame frame;
    village::Vec3 tint{1, 1, 1};
    bool there = true;   // false: hidden and without a shadow
    bool drawn = true;   // false: the library draws it; it still casts a shadow
    bool moves = false;  // re-renders its shadow in every frame
};

}  // namespace tower
