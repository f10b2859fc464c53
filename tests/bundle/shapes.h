// Meshes of flamewright-check. Their corners need only + - * / and square roots, which are exact or
// correctly rounded everywhere: every machine bakes the same mesh.
#pragma once
#include <flamewright/flamewright.h>

#include <cstdint>
#include <vector>

namespace fw::bundle {

struct Shape {
    std::vector<float> positions;  // 3 per vertex, m
    std::vector<uint32_t> indices;
    std::vector<uint8_t> materials;  // 1 per triangle, or empty

    [[nodiscard]] FwMeshDef def() const;  // points into the shape
};

// 4 x 5 m, walls 2.4 m high (material 0) under a roof with its ridge along z (material 1).
Shape makeHouse();
// A round animal with two ears, 1 m high, as round as 6 * cells * cells * 2 triangles allow.
Shape makeAnimal(uint32_t cells);
// width x height m in the plane z = 0, its lower edge in the middle of the origin.
Shape makeSheet(float width, float height, uint32_t cells);

}  // namespace fw::bundle
