// See scene.h.
#include "document/scene.h"

#include <cmath>

namespace fwedit {
namespace {

constexpr float kDegree = 0.017453292519943295f;

Vec3 transformed(const std::array<float, 16>& m, const Vec3& p) {
    Vec3 result;
    for (size_t r = 0; r < 3; ++r)
        result[r] = m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r];
    return result;
}

// Where an object says it is, and what it sticks to.
struct Place {
    Vec3 position{};
    ObjectId sticksTo = 0;
    const Mesh* mesh = nullptr;
};

Place placeOf(const Scene& scene, ObjectId id) {
    Place place;
    forEachList(scene, [&](Kind, const auto& list) {
        for (const auto& object : list) {
            if (object.id != id) continue;
            if constexpr (requires { object.position; }) place.position = object.position;
            if constexpr (requires { object.sticksTo; }) place.sticksTo = object.sticksTo;
            if constexpr (requires { object.pins; }) place.mesh = &object;
        }
    });
    return place;
}

template <typename SceneT, typename ObjectT>
ObjectT* find(SceneT& scene, ObjectId id, Kind* kind) {
    ObjectT* found = nullptr;
    if (id == 0) return found;
    forEachList(scene, [&](Kind which, auto& list) {
        for (auto& object : list) {
            if (found || object.id != id) continue;
            found = &object;
            if (kind) *kind = which;
        }
    });
    return found;
}

}  // namespace

float valueAt(const Keys& keys, float time) {
    if (keys.empty()) return 1;
    if (time <= keys.front().time) return keys.front().value;
    for (size_t i = 1; i < keys.size(); ++i) {
        if (time >= keys[i].time) continue;
        const Key &a = keys[i - 1], &b = keys[i];
        return a.value + (b.value - a.value) * (time - a.time) / (b.time - a.time);
    }
    return keys.back().value;
}

const Object* findObject(const Scene& scene, ObjectId id, Kind* kind) {
    return find<const Scene, const Object>(scene, id, kind);
}
Object* findObject(Scene& scene, ObjectId id, Kind* kind) {
    return find<Scene, Object>(scene, id, kind);
}

std::array<float, 16> transformOf(const Mesh& mesh) {
    const Vec3& r = mesh.rotation;
    const float cx = std::cos(r[0] * kDegree), sx = std::sin(r[0] * kDegree);
    const float cy = std::cos(r[1] * kDegree), sy = std::sin(r[1] * kDegree);
    const float cz = std::cos(r[2] * kDegree), sz = std::sin(r[2] * kDegree);
    // Columns of turn(z) turn(y) turn(x).
    const Vec3 columns[3] = {{cy * cz, cy * sz, -sy},
                             {sx * sy * cz - cx * sz, sx * sy * sz + cx * cz, sx * cy},
                             {cx * sy * cz + sx * sz, cx * sy * sz - sx * cz, cx * cy}};
    std::array<float, 16> m{};
    for (size_t c = 0; c < 3; ++c)
        for (size_t k = 0; k < 3; ++k) m[c * 4 + k] = columns[c][k] * mesh.scale[c];
    for (size_t k = 0; k < 3; ++k) m[12 + k] = mesh.position[k];
    m[15] = 1;
    return m;
}

Vec3 worldPosition(const Scene& scene, ObjectId id) {
    Place place = placeOf(scene, id);
    Vec3 result = place.position;
    // Each object is passed once at most, however a scene by another hand is knotted.
    for (int hops = 0; place.sticksTo != 0 && hops < 64; ++hops) {
        place = placeOf(scene, place.sticksTo);
        if (place.mesh) return transformed(transformOf(*place.mesh), result);
        for (size_t k = 0; k < 3; ++k) result[k] += place.position[k];
    }
    return result;
}

Vec3 positionWithin(const Scene& scene, ObjectId parent, const Vec3& world) {
    if (parent == 0) return world;
    const Mesh* mesh = findIn(scene.meshes, parent);
    if (!mesh) {
        const Vec3 base = worldPosition(scene, parent);
        return {world[0] - base[0], world[1] - base[1], world[2] - base[2]};
    }
    const std::array<float, 16> m = transformOf(*mesh);
    // Its columns are at right angles, so each coordinate is a projection.
    Vec3 result{};
    for (size_t c = 0; c < 3; ++c) {
        float along = 0, square = 0;
        for (size_t k = 0; k < 3; ++k) {
            along += m[c * 4 + k] * (world[k] - m[12 + k]);
            square += m[c * 4 + k] * m[c * 4 + k];
        }
        result[c] = square > 0 ? along / square : 0;
    }
    return result;
}

}  // namespace fwedit
