// Distances to shapes, and the flattening of a tube against them.
#include "volume/collide.h"

#include "core/assert.h"
#include "core/error.h"
#include "volume/depth_picture.h"

#include <algorithm>
#include <cmath>

namespace fw::volume {
namespace {

constexpr float kMaxSqueeze = 0.88f;
constexpr float kMaxWiden = 1.7f;
constexpr float kBelow = 0.1f;        // m below ground that still counts as on it
constexpr float kSkin = 1e-3f;        // m by which a ray may graze a shape
constexpr uint32_t kMaxFeeler = 48u;  // samples along a ray

constexpr vec3 kUp(0, 1, 0);
vec3 normalOr(vec3 v) noexcept { return unitOr(v, kUp, 1e-9f); }

Surface ofBox(const Collider& c, vec3 point) noexcept {
    const vec4 back(-vec3(c.rotation), c.rotation.w);
    const vec3 p = turned(back, point - c.place);
    const vec3 q = glm::abs(p) - c.extent;
    const vec3 sign(p.x < 0 ? -1.0f : 1.0f, p.y < 0 ? -1.0f : 1.0f, p.z < 0 ? -1.0f : 1.0f);
    const float deepest = std::max({q.x, q.y, q.z});
    if (deepest > 0.0f) {
        const vec3 out = glm::max(q, vec3(0.0f));
        return {glm::length(out), turned(c.rotation, normalOr(out * sign))};
    }
    const int axis = q.x >= q.y && q.x >= q.z ? 0 : q.y >= q.z ? 1 : 2;
    vec3 normal(0.0f);
    normal[axis] = sign[axis];
    return {deepest, turned(c.rotation, normal)};
}

struct Slope {                         // of a height field at a place, or at its border
    float height = 0, dx = 0, dz = 0;  // m above the field's place; m per m
    bool within = false;
};
Slope slopeOf(const Collider& c, float x, float z) noexcept {
    Slope slope;
    float u = (x - c.place.x) / c.radius, v = (z - c.place.z) / c.radius;
    if (!c.heights || c.columns < 2 || c.rows < 2 || !std::isfinite(u) || !std::isfinite(v))
        return slope;
    const float most[2] = {float(c.columns - 1), float(c.rows - 1)};
    slope.within = u >= 0.0f && v >= 0.0f && u <= most[0] && v <= most[1];
    u = std::clamp(u, 0.0f, most[0]), v = std::clamp(v, 0.0f, most[1]);
    const uint32_t i = std::min(uint32_t(u), c.columns - 2), k = std::min(uint32_t(v), c.rows - 2);
    FW_ASSERT(i + 1 < c.columns && k + 1 < c.rows, "cell (%u, %u)", i, k);
    const auto at = [&](uint32_t x1, uint32_t z1) {
        return c.heights[size_t(z1) * c.columns + x1];
    };
    const float fu = u - float(i), fv = v - float(k);
    const float h00 = at(i, k), h10 = at(i + 1, k), h01 = at(i, k + 1), h11 = at(i + 1, k + 1);
    slope.height = glm::mix(glm::mix(h00, h10, fu), glm::mix(h01, h11, fu), fv);
    slope.dx = glm::mix(h10 - h00, h11 - h01, fv) / c.radius;
    slope.dz = glm::mix(h01 - h00, h11 - h10, fu) / c.radius;
    return slope;
}

Surface ofHeights(const Collider& c, vec3 point) noexcept {
    const Slope slope = slopeOf(c, point.x, point.z);
    if (!slope.within) return {};
    const vec3 normal = normalOr(vec3(-slope.dx, 1.0f, -slope.dz));
    const float distance = (point.y - c.place.y - slope.height) * normal.y;
    if (!std::isfinite(distance)) return {};
    return {distance, normal};
}

float square(vec3 v) noexcept { return glm::dot(v, v); }

// The place along a line segment that is nearest to a point, [0, 1].
float nearestPart(vec3 a, vec3 b, vec3 point) noexcept {
    const vec3 along = b - a;
    const float l2 = square(along);
    return l2 > 0.0f ? std::clamp(glm::dot(point - a, along) / l2, 0.0f, 1.0f) : 0.0f;
}

// Squared distance from a point to a line segment.
float awayFrom(vec3 a, vec3 b, vec3 point) noexcept {
    return square((point - a) - nearestPart(a, b, point) * (b - a));
}

// Squared distance between two segments.
float awayFrom(vec3 a, vec3 b, vec3 c, vec3 d) noexcept {
    const vec3 u = b - a, v = d - c, w = a - c;
    const float uu = glm::dot(u, u), uv = glm::dot(u, v), vv = glm::dot(v, v);
    const float uw = glm::dot(u, w), vw = glm::dot(v, w), skew = uu * vv - uv * uv;
    float least =
        std::min({awayFrom(c, d, a), awayFrom(c, d, b), awayFrom(a, b, c), awayFrom(a, b, d)});
    if (skew > 1e-12f) {
        const float s = (uv * vw - vv * uw) / skew, t = (uu * vw - uv * uw) / skew;
        if (s > 0.0f && s < 1.0f && t > 0.0f && t < 1.0f) {
            least = std::min(least, square(w + s * u - t * v));
        }
    }
    return least;
}

bool crossesBox(const Collider& c, vec3 from, vec3 to) noexcept {
    const vec4 back(-vec3(c.rotation), c.rotation.w);
    const vec3 a = turned(back, from - c.place), across = turned(back, to - c.place) - a;
    float in = 0.0f, out = 1.0f;
    for (int k = 0; k < 3; ++k) {
        const float half = c.extent[k] - kSkin;
        if (std::abs(across[k]) < 1e-9f) {
            if (std::abs(a[k]) >= half) return false;
            continue;
        }
        const float first = (-half - a[k]) / across[k], last = (half - a[k]) / across[k];
        in = std::max(in, std::min(first, last)), out = std::min(out, std::max(first, last));
    }
    return in < out;
}

bool feels(const Collider& c, vec3 from, vec3 to) noexcept {
    const float length = glm::length(to - from);
    const float least = length / float(kMaxFeeler);
    for (float t = 0.0f; t < length;) {
        const float d = surfaceOf(c, from + (to - from) * (t / length)).distance;
        if (d < -kSkin) return true;
        // A height is not a distance, and outside the field there is none.
        t += c.kind == ColliderKind::HeightField ? least : std::max(0.9f * d, least);
    }
    return false;
}

}  // namespace

bool shades(const Collider& c, vec3 source, vec3 point) noexcept {
    if (c.kind == ColliderKind::Depth) return false;
    const float here = surfaceOf(c, point).distance;
    if (surfaceOf(c, source).distance < 0.0f) return false;
    const bool ground = c.kind == ColliderKind::Plane || c.kind == ColliderKind::HeightField;
    if (ground && here < -kBelow) return true;
    if (here < -kSkin && c.kind != ColliderKind::HeightField) return false;
    const float radius = std::max(c.radius - kSkin, 0.0f);
    switch (c.kind) {
        case ColliderKind::Sphere:
            return awayFrom(source, point, c.place) < radius * radius;
        case ColliderKind::Capsule:
            return awayFrom(source, point, c.place, c.extent) < radius * radius;
        case ColliderKind::Box:
            return crossesBox(c, source, point);
        case ColliderKind::HeightField:
            return feels(c, source,
                         point + surfaceOf(c, point).normal * std::max(kSkin - here, 0.0f));
        case ColliderKind::Callback:
            return feels(c, source, point);
        default:
            return false;
    }
}

Surface surfaceOf(const Collider& c, vec3 point) noexcept {
    switch (c.kind) {
        case ColliderKind::Sphere:
        case ColliderKind::Capsule: {
            const bool sphere = c.kind == ColliderKind::Sphere;
            const float part = sphere ? 0.0f : nearestPart(c.place, c.extent, point);
            const vec3 out = point - (sphere ? c.place : c.place + part * (c.extent - c.place));
            return {glm::length(out) - c.radius, normalOr(out)};
        }
        case ColliderKind::Box:
            return ofBox(c, point);
        case ColliderKind::Plane: {
            const vec3 n = normalOr(c.extent);
            return {glm::dot(point - c.place, n), n};
        }
        case ColliderKind::HeightField:
            return ofHeights(c, point);
        case ColliderKind::Callback: {
            if (!c.distance) return {};
            const float p[3] = {point.x, point.y, point.z};
            float n[3] = {0.0f, 1.0f, 0.0f};
            const float d = c.distance(c.user, p, n);
            const vec3 normal(n[0], n[1], n[2]);
            if (!std::isfinite(d) || !std::isfinite(n[0] + n[1] + n[2])) return {};
            return {d, normalOr(normal)};
        }
        case ColliderKind::Depth:
            return c.picture ? surfaceOf(*c.picture, c.radius, point) : Surface{};
    }
    return {};
}

bool heightOf(const Collider& field, float x, float z, float& height) noexcept {
    const Slope slope = slopeOf(field, x, z);
    height = field.place.y + slope.height;
    return slope.within;
}

Surface nearestSurface(std::span<const Collider> colliders, vec3 point) noexcept {
    Surface best;
    for (const Collider& c : colliders) {
        const Surface s = surfaceOf(c, point);
        if (s.distance < best.distance) best = s;
    }
    return best;
}

void checkCollider(const Collider& c) {
    using enum ColliderKind;
    if (c.kind > Depth)
        core::refuse("kind of the collider is %u; the last one is %u.", uint32_t(c.kind),
                     uint32_t(Depth));
    const auto check = [](const char* name, vec3 v, bool good, const char* rule) {
        if (!good)
            core::refuse("%s is (%g, %g, %g); %s.", name, double(v.x), double(v.y), double(v.z),
                         rule);
    };
    const auto isFinite = [](vec3 v) { return std::isfinite(glm::dot(v, vec3(1.0f))); };
    check("place of the collider", c.place, isFinite(c.place), "it must be finite");
    check("extent of the collider", c.extent, isFinite(c.extent), "it must be finite");
    const bool round = c.kind != Box && c.kind != Plane && c.kind != Callback;
    if (round && !(c.radius > 0.0f && c.radius < 1e6f))
        core::refuse("radius of the collider is %g m; it must lie in (0, 1e6).", double(c.radius));
    check("normal of the plane", c.extent, c.kind != Plane || glm::length(c.extent) > 1e-6f,
          "it must not be zero");
    const float turn = glm::dot(c.rotation, c.rotation);
    if (c.kind == Box && !(std::abs(turn - 1.0f) < 1e-2f))
        core::refuse("rotation of the box has the squared length %g; a unit quaternion has 1.",
                     double(turn));
    check("half size of the box", c.extent,
          c.kind != Box || std::min({c.extent.x, c.extent.y, c.extent.z}) > 0.0f,
          "each side must be above 0 m");
    if (c.kind == HeightField && (!c.heights || c.columns < 2 || c.rows < 2))
        core::refuse("the height field has %u x %u heights%s; it needs at least 2 x 2.", c.columns,
                     c.rows, c.heights ? "" : " at a null pointer");
    if (c.kind == Callback && !c.distance)
        core::refuse("distance of the callback collider is null; it must be a function.");
}

void flattenNodes(std::span<const Collider> colliders, std::span<gpu::FlameNode> nodes) noexcept {
    if (colliders.empty() || nodes.empty()) return;
    for (gpu::FlameNode& node : nodes) {
        const float radius = node.centre.w;
        FW_ASSERT(radius >= 0, "%g m", double(radius));
        const Surface s = nearestSurface(colliders, vec3(node.centre));
        if (!(s.distance < radius) || radius <= 0.0f) continue;
        const vec3 along(node.along);
        const vec3 across = s.normal - along * glm::dot(along, s.normal);
        const float square = glm::dot(across, across);  // 1: the tube runs along the surface
        const float most = kMaxSqueeze * glm::smoothstep(0.1f, 0.8f, square);
        const float squeeze = std::clamp(1.0f - s.distance / radius, 0.0f, 1.0f) * most;
        if (squeeze <= 0.0f) continue;
        const float widen = std::min(1.0f / std::sqrt(1.0f - squeeze), kMaxWiden);
        FW_ASSERT(squeeze < 1.0f, "squeeze %g", double(squeeze));
        node.squeeze = vec4(normalOr(across), squeeze);
        node.side.w = widen;
        node.centre.w = radius * widen;
    }
    repairNodes(nodes, vec3(nodes[0].along));
}

}  // namespace fw::volume
