// What the village hands out: models and placed instances as plain data.
// Knows nothing of a renderer or of the fire library; a host uploads these arrays as they are.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "village_math.h"

namespace village {

// What a triangle is made of, as the fire sees it. Stone, metal, ground and water never burn.
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

// What a triangle looks like: which function of textures.h paints it.
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
    Vec3 position;                        // m, model space, y up, front = +z, origin on the ground
    Vec3 normal;                          // unit
    Vec2 uv;                              // [0, 1]: this vertex's own place in the burn atlas;
                                          // uv * atlasSide = metres, V along the grain
    Vec3 tint;                            // linear Rec.709 albedo
    float glow = 0;                       // 0 none, <= 1.5 a lit window, > 1.5 coals
    float sway = 0;                       // m that it yields to a wind of 1 m/s
    Texture texture = Texture::kPlank;    // the look
    Material material = Material::kWood;  // the same at all three corners of a triangle
};

struct Model {
    std::string name;
    std::vector<Vertex> vertices;     // welded where all attributes agree
    std::vector<uint32_t> indices;    // three per triangle, counter-clockwise seen from outside
    std::vector<Material> materials;  // one per triangle
    int farTriangles = 0;             // as many of the first show from afar; the rest is fine work
    float atlasSide = 1;              // m, the side of the square burn atlas
    int burnTexels = 256;             // the side the atlas was packed for: gutters are 2 texels
    Vec3 low{1e9f, 1e9f, 1e9f};       // m, bounds
    Vec3 high{-1e9f, -1e9f, -1e9f};

    int triangleCount() const { return int(indices.size() / 3); }
};

struct Instance {
    int model = 0;          // into Scene::models
    Frame frame;            // model to world; a uniform scale may be in it
    uint32_t seed = 0;      // varies whatever the host likes to vary
    Vec3 tint{1, 1, 1};     // multiplies the vertex tint
    float roadSide = 0;     // m left of the centre line; marchers only
    float roadMetres = -1;  // m along the road; < 0: does not march
};

}  // namespace village
