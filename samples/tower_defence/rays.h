// A bounding volume hierarchy over triangles, and rays against it, for baking ambient occlusion.
// Not used during the game.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "village/village_math.h"

namespace tower {

class RayTree {
 public:
    // Three corners per triangle, in world or model space.
    explicit RayTree(std::vector<village::Vec3> corners);
    // Returns the distance of the nearest hit, or `reach` if there is none.
    float reach(village::Vec3 origin, village::Vec3 direction, float reach) const;

 private:
    struct Node {
        village::Vec3 low, high;
        uint32_t first, count;  // count 0: an inner node, first is the left child and first + 1 the
                                // right one
    };
    void split(uint32_t node, std::vector<uint32_t>& order, uint32_t first, uint32_t count);

    std::vector<village::Vec3> corners_;
    std::vector<Node> nodes_;
};

// Returns the visible share of the sky, [floor, 1]. Near occluders weigh more than far ones.
float openSky(const RayTree& tree, village::Vec3 point, village::Vec3 normal, int rays,
              float metres);

// Runs body(i) for i in [0, count) on all cores.
void inParallel(int count, const std::function<void(int)>& body);

}  // namespace tower
