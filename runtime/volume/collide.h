// Shapes that flames flow around, as distances and normals; a callback may stand for any other
// shape. Cosmetic: the simulation reads none of them.
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
    // m: sphere, capsule; height field: side of a cell; depth picture: radius of the search around
    // a point
    float radius = 0.5f;
    const float* heights =
        nullptr;  // height field: m above place.y, rows along x; the caller keeps it
    uint32_t columns = 0, rows = 0;  // >= 2 each
    // Signed distance, m, and a unit normal. Values that are not finite count as far away.
    float (*distance)(void* user, const float point[3], float normal[3]) = nullptr;
    void* user = nullptr;
    const DepthPicture* picture = nullptr;  // the caller keeps it
};

struct Surface {
    float distance = 1e9f;          // m, negative inside
    vec3 normal{0.0f, 1.0f, 0.0f};  // unit, outward
};
Surface surfaceOf(const Collider& collider, vec3 point) noexcept;
// Height of a height field, m, world; outside, its height at the border. False: x and z are
// outside.
bool heightOf(const Collider& field, float x, float z, float& height) noexcept;
// The nearest surface of all; far away if there are none.
Surface nearestSurface(std::span<const Collider> colliders, vec3 point) noexcept;

// Whether the collider stops radiation from a source to a point. A body that holds the source or
// the point stops nothing, except that ground and planes hide points more than kBelow under them.
// Height fields and callbacks are sampled along the ray: thin ones may be missed. Depth pictures
// stop nothing.
bool shades(const Collider& collider, vec3 source, vec3 point) noexcept;

// Throws core::Error that names the field, the value and the limit.
void checkCollider(const Collider& collider);

// Flattens the tube of a curve against surfaces nearer than its radius, and widens it accordingly:
// along a ceiling a flame is a jet, along a wall half a flame.
void flattenNodes(std::span<const Collider> colliders, std::span<gpu::FlameNode> nodes) noexcept;

}  // namespace fw::volume
