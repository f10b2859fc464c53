// Shapes that flames flow around: what a host names, as distances and normals. A callback may stand
// for any other. Cosmetic: nothing authoritative reads them.
#pragma once
#include "volume/curve.h"

namespace fw::volume {

enum class ColliderKind : uint32_t { Sphere, Capsule, Box, Plane, HeightField, Callback, Depth };

struct DepthPicture;  // depth_picture.h

struct Collider {
    ColliderKind kind = ColliderKind::Sphere;
    vec3 place{0.0f};  // m: centre; capsule: one end; plane: a point; height field: low corner
    vec3 extent{0.0f, 1.0f, 0.0f};          // capsule: other end; box: half sides, m; plane: normal
    vec4 rotation{0.0f, 0.0f, 0.0f, 1.0f};  // box: unit quaternion xyzw
    // m: sphere, capsule; height field: side of a cell; picture of depth: how far around a point
    // it is looked at
    float radius = 0.5f;
    const float* heights =
        nullptr;  // height field: m above place.y, rows along x; the caller keeps it
    uint32_t columns = 0, rows = 0;  // >= 2 each
    // Signed distance, m, and a unit normal. What is not finite counts as far away.
    float (*distance)(void* user, const float point[3], float normal[3]) = nullptr;
    void* user = nullptr;
    const DepthPicture* picture = nullptr;  // the caller keeps it
};

struct Surface {
    float distance = 1e9f;          // m, negative inside
    vec3 normal{0.0f, 1.0f, 0.0f};  // unit, outward
};
Surface surfaceOf(const Collider& collider, vec3 point) noexcept;
// m, world: of a height field, at its border beyond it. False: x and z are beyond it.
bool heightOf(const Collider& field, float x, float z, float& height) noexcept;
// Of all of them the nearest; far away if there are none.
Surface nearestSurface(std::span<const Collider> colliders, vec3 point) noexcept;

// Whether it stands between a source of radiation and a point. What the source is in hides nothing,
// nor does a body that the point is in, but ground and planes hide what is more than a hand's
// breadth below them. Height fields and callbacks are felt along the way: thin ones may be missed.
// A picture of depth says too little of what it shows: it shades nothing.
bool shades(const Collider& collider, vec3 source, vec3 point) noexcept;

// Throws core::Error that names the field, the value and the limit.
void checkCollider(const Collider& collider);

// Flattens the tube of a laid curve against what is nearer than its radius, and widens it as much:
// along a ceiling a flame is a jet, along a wall half a flame.
void squeezeNodes(std::span<const Collider> colliders, std::span<gpu::FlameNode> nodes) noexcept;

}  // namespace fw::volume
