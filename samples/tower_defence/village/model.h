// The village's output: models and placed instances as plain data, independent of renderer and fire
// library. A host uploads these arrays as they are.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "village_math.h"

namespace village {

// Material of a triangle for the fire. Stone, metal, ground and water never burn.
enum class Material : uint8_t {
    kWood,
    kPaint,  // painted or limewashed boards
    kThatch,
    kStraw,
    kLeaf,
    kCloth,
    kStone,
    kMetal,
    kGround,
    kWater,
};

// Appearance of a triangle: selects a painter of textures.h.
enum class Texture : uint8_t {
    kPlank,
    kTimber,
    kBark,
    kThatch,
    kStraw,
    kLeaf,
    kCloth,
    kStone,
    kMetal,
    kGlow,
    kCobble,
    kGrass,
    kWater,
};

struct Vertex {
    Vec3 position;  // m, model space, y up, front = +z, origin on the ground
    Vec3 normal;    // unit
    Vec2 uv;  // [0, 1]: unique position in the burn atlas; uv * atlasSide is in metres, V along the
              // grain
    Vec3 tint;                            // linear Rec.709 albedo
    float glow = 0;                       // 0 none, <= 1.5 a lit window, > 1.5 coals
    float sway = 0;                       // m of sway in a wind of 1 m/s
    Texture texture = Texture::kPlank;    // appearance
    Material material = Material::kWood;  // equal at all three corners of a triangle
};

struct Model {
    std::string name;
    std::vector<Vertex> vertices;     // welded where all attributes agree
    std::vector<uint32_t> indices;    // three per triangle, counter-clockwise from outside
    std::vector<Material> materials;  // one per triangle
    int farTriangles = 0;  // number of leading triangles that show from afar; the rest is fine
                           // detail
    float atlasSide = 1;   // m, side of the square burn atlas
    int burnTexels = 256;  // burn map side that the atlas is packed for: gutters have 2 texels
    Vec3 low{1e9f, 1e9f, 1e9f};  // m, bounds
    Vec3 high{-1e9f, -1e9f, -1e9f};

    int triangleCount() const { return int(indices.size() / 3); }
};

struct Instance {
    int model = 0;          // into Scene::models
    Frame frame;            // model to world; may contain a uniform scale
    uint32_t seed = 0;      // for variation by the host
    Vec3 tint{1, 1, 1};     // multiplies the vertex tint
    float roadSide = 0;     // m left of the centre line; enemies only
    float roadMetres = -1;  // m along the road; < 0: not an enemy
};

}  // namespace village
