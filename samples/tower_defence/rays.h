// A bounding volume tree over triangles and rays against it, for baking ambient occlusion.
// Not used while the game runs.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "village/village_math.h"

namespace tower {

class RayTree {
 public:
    // Three corners per triangle, world or model space.
    explicit RayTree(std::vector<village::Vec3> corners);
    // The nearest hit's distance within reach, or reach itself.
    float reach(village::Vec3 origin, village::Vec3 direction, float reach) const;

 private:
    struct Node {
        village::Vec3 low, high;
        uint32_t first, count;  // count 0: first is the left child, the right one follows it
    };
    void split(uint32_t node, std::vector<uint32_t>& order, uint32_t first, uint32_t count);

    std::vector<village::Vec3> corners_;
    std::vector<Node> nodes_;
};

// The share of the sky seen from a point, [floor, 1]; near hits count for more than far ones.
float openSky(const RayTree& tree, village::Vec3 point, village::Vec3 normal, int rays,
              float metres);

// Runs body(i) for i in [0, count) on all cores.
void inParallel(int count, const std::function<void(int)>& body);

}  // namespace tower
