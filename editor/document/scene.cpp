#include "document/scene.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace fwedit {
namespace {

constexpr float kDegree = 0.017453292519943295f;
// Equal to the limits in fields.cpp.
constexpr float kMostPosition = 1e6f, kMostDirection = 1000, kMostExtent = 100;

Vec3 bounded(Vec3 v, float most) {
    for (float& part : v) part = std::isfinite(part) ? std::clamp(part, -most, most) : 0;
    return v;
}

Pose product(const Pose& a, const Pose& b) {
    Pose result{};
    for (size_t c = 0; c < 4; ++c)
        for (size_t r = 0; r < 4; ++r)
            for (size_t k = 0; k < 4; ++k) result[c * 4 + r] += a[k * 4 + r] * b[c * 4 + k];
    return result;
}

Vec3 column(const Pose& m, size_t c) { return {m[c * 4], m[c * 4 + 1], m[c * 4 + 2]}; }

// Returns orthonormal axes without scale and shear (mirrored if m is), or the world's axes if m is
// degenerate.
std::array<Vec3, 3> axesOf(const Pose& m) {
    std::array<Vec3, 3> axes{};
    for (size_t c = 0; c < 3; ++c) {
        Vec3 axis = column(m, c);
        for (size_t before = 0; before < c; ++before) {
            const float along = dot(axis, axes[before]);
            for (size_t k = 0; k < 3; ++k) axis[k] -= along * axes[before][k];
        }
        const float length = std::sqrt(dot(axis, axis));
        if (!(length > 1e-12f)) return {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
        for (size_t k = 0; k < 3; ++k) axes[c][k] = axis[k] / length;
    }
    return axes;
}

// An object's local position and parent.
struct Place {
    Vec3 position{};
    ObjectId sticksTo = 0;
    std::string_view node;
    const Mesh* mesh = nullptr;
};

Place placeOf(const Scene& scene, ObjectId id) {
    Place place;
    forEachList(scene, [&](Kind, const auto& list) {
        for (const auto& object : list) {
            if (object.id != id) continue;
            if constexpr (requires { object.position; }) place.position = object.position;
            if constexpr (requires { object.sticksTo; }) place.sticksTo = object.sticksTo;
            if constexpr (requires { object.sticksToNode; }) place.node = object.sticksToNode;
            if constexpr (requires { object.pins; }) place.mesh = &object;
        }
    });
    return place;
}

// The end of a parent chain: a mesh and one of its nodes, or nothing, plus the offset of the
// chain's start.
struct Root {
    const Mesh* mesh = nullptr;
    std::string_view node;
    Vec3 offset{};
};

Root rootOf(const Scene& scene, ObjectId parent, std::string_view node) {
    Root root;
    for (const ObjectId holder : ancestorsOf(scene, parent)) {
        const Place place = placeOf(scene, holder);
        if (place.mesh) {
            root.mesh = place.mesh;
            root.node = node;
            break;
        }
        for (size_t k = 0; k < 3; ++k) root.offset[k] += place.position[k];
        node = place.node;
    }
    return root;
}

// Returns the pose within the mesh of a root. On failure sets `error` and uses the mesh's own pose.
bool poseWithin(const Root& root, const NodePoseOf& nodePose, Pose& pose, std::string& error) {
    pose = kWorldPose;
    const bool good =
        root.node.empty() || !nodePose || nodePose(*root.mesh, root.node, pose, error);
    if (!good) pose = kWorldPose;
    const Vec3 at = placedBy(pose, root.offset);
    std::copy(at.begin(), at.end(), pose.begin() + 12);
    return good;
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

Pose transformOf(const Mesh& mesh) {
    const Vec3& r = mesh.rotation;
    const float cx = std::cos(r[0] * kDegree), sx = std::sin(r[0] * kDegree);
    const float cy = std::cos(r[1] * kDegree), sy = std::sin(r[1] * kDegree);
    const float cz = std::cos(r[2] * kDegree), sz = std::sin(r[2] * kDegree);
    // Columns of rotate(z) rotate(y) rotate(x).
    const Vec3 columns[3] = {{cy * cz, cy * sz, -sy},
                             {sx * sy * cz - cx * sz, sx * sy * sz + cx * cz, sx * cy},
                             {cx * sy * cz + sx * sz, cx * sy * sz - sx * cz, cx * cy}};
    Pose m{};
    for (size_t c = 0; c < 3; ++c)
        for (size_t k = 0; k < 3; ++k) m[c * 4 + k] = columns[c][k] * mesh.scale[c];
    for (size_t k = 0; k < 3; ++k) m[12 + k] = mesh.position[k];
    m[15] = 1;
    return m;
}

Vec3 placedBy(const Pose& m, const Vec3& p) {
    Vec3 result;
    for (size_t r = 0; r < 3; ++r)
        result[r] = m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r];
    return result;
}

Vec3 turnedBy(const Pose& holder, const Vec3& direction) {
    const std::array<Vec3, 3> axes = axesOf(holder);
    Vec3 result{};
    for (size_t c = 0; c < 3; ++c)
        for (size_t k = 0; k < 3; ++k) result[k] += axes[c][k] * direction[c];
    return result;
}

Vec3 directionWithin(const Pose& holder, const Vec3& world) {
    const std::array<Vec3, 3> axes = axesOf(holder);
    return {dot(axes[0], world), dot(axes[1], world), dot(axes[2], world)};
}

Vec3 positionWithin(const Pose& holder, const Vec3& world) {
    return offsetWithin(holder,
                        {world[0] - holder[12], world[1] - holder[13], world[2] - holder[14]});
}

Vec3 offsetWithin(const Pose& holder, const Vec3& world) {
    // Cramer's rule, in double precision because axes may be sheared and differ in length.
    double m[3][3], away[3];
    for (size_t k = 0; k < 3; ++k) {
        away[k] = static_cast<double>(world[k]);
        for (size_t c = 0; c < 3; ++c) m[c][k] = static_cast<double>(holder[c * 4 + k]);
    }
    const auto volume = [](const double* a, const double* b, const double* c) {
        return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
               a[2] * (b[0] * c[1] - b[1] * c[0]);
    };
    const double whole = volume(m[0], m[1], m[2]);
    if (!(std::abs(whole) > 1e-30)) return {};
    return {static_cast<float>(volume(away, m[1], m[2]) / whole),
            static_cast<float>(volume(m[0], away, m[2]) / whole),
            static_cast<float>(volume(m[0], m[1], away) / whole)};
}

ObjectId parentOf(const Scene& scene, ObjectId id) { return placeOf(scene, id).sticksTo; }

std::vector<ObjectId> ancestorsOf(const Scene& scene, ObjectId parent) {
    std::vector<ObjectId> holders;
    if (parent == 0) return holders;
    std::unordered_map<ObjectId, ObjectId> next;
    forEachList(scene, [&](Kind, const auto& list) {
        for (const auto& object : list)
            if constexpr (requires { object.sticksTo; })
                if (object.sticksTo != 0) next[object.id] = object.sticksTo;
    });
    holders.push_back(parent);
    for (auto at = next.find(parent); at != next.end();) {
        const ObjectId holder = at->second;
        holders.push_back(holder);
        next.erase(at);  // visited once: a cycle ends here
        at = next.find(holder);
    }
    return holders;
}

Pose parentPose(const Scene& scene, ObjectId id, const NodePoseOf& nodePose) {
    const Place place = placeOf(scene, id);
    const Root root = rootOf(scene, place.sticksTo, place.node);
    Pose pose = kWorldPose;
    std::string ignored;
    if (root.mesh) {
        poseWithin(root, nodePose, pose, ignored);
        return product(transformOf(*root.mesh), pose);
    }
    std::copy(root.offset.begin(), root.offset.end(), pose.begin() + 12);
    return pose;
}

Vec3 worldPosition(const Scene& scene, ObjectId id, const NodePoseOf& nodePose) {
    return placedBy(parentPose(scene, id, nodePose), placeOf(scene, id).position);
}

const Mesh* meshHolding(const Scene& scene, ObjectId id) {
    return rootOf(scene, placeOf(scene, id).sticksTo, "").mesh;
}

void keepInWorld(Scene& scene, ObjectId id, const Pose& before, const Pose& after) {
    forEachList(scene, [&](Kind, auto& list) {
        for (auto& object : list) {
            if (object.id != id) continue;
            if constexpr (requires { object.position; })
                object.position = bounded(positionWithin(after, placedBy(before, object.position)),
                                          kMostPosition);
            if constexpr (requires { object.direction; })
                object.direction = bounded(
                    directionWithin(after, turnedBy(before, object.direction)), kMostDirection);
            if constexpr (requires { object.extent; })
                object.extent =
                    bounded(directionWithin(after, turnedBy(before, object.extent)), kMostExtent);
        }
    });
}

Scene placedScene(const Scene& scene, const NodePoseOf& nodePose,
                  std::vector<std::string>* problems) {
    Scene placed = scene;
    forEachList(placed, [&](Kind, auto& list) {
        for (auto& object : list) {
            if constexpr (requires { object.sticksTo; }) {
                std::string_view node;
                if constexpr (requires { object.sticksToNode; }) node = object.sticksToNode;
                const Root root = rootOf(scene, object.sticksTo, node);
                if (!root.mesh || root.node.empty()) continue;
                Pose pose;
                std::string error;
                if (!poseWithin(root, nodePose, pose, error) && problems)
                    problems->push_back("\"" + object.name + "\" sticks to \"" + root.mesh->name +
                                        "\" itself: " + error);
                const Pose mesh = transformOf(*root.mesh), whole = product(mesh, pose);
                object.position = placedBy(pose, object.position);
                if constexpr (requires { object.direction; })
                    object.direction = directionWithin(mesh, turnedBy(whole, object.direction));
                if constexpr (requires { object.extent; })
                    object.extent = directionWithin(mesh, turnedBy(whole, object.extent));
                object.sticksTo = root.mesh->id;
                if constexpr (requires { object.sticksToNode; }) object.sticksToNode.clear();
            }
        }
    });
    return placed;
}

}  // namespace fwedit
