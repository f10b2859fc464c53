// Bodies that flames of volumetric fires flow around: the host's colliders, among them pictures of
// depth, and the world's occluders as boxes. Cosmetic.
#include "host_limits.h"
#include "world/exchange_system.h"
#include "world/flame_system.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace fw::world {
namespace {

using components::checkLength;
using components::checkLengths;
using components::checkValue;
using components::checkValues;

float callHost(void* user, const float point[3], float normal[3]) noexcept {
    const auto& entry = *static_cast<const FireColliderEntry*>(user);
    const float asked[3] = {point[0] * entry.unitsPerMetre, point[1] * entry.unitsPerMetre,
                            point[2] * entry.unitsPerMetre};
    return entry.distance(entry.distanceData, asked, normal) / entry.unitsPerMetre;
}

// Rows of a rotation to a quaternion.
volume::vec4 quaternion(const float r[3][3]) noexcept {
    const float w = std::sqrt(std::max(1 + r[0][0] + r[1][1] + r[2][2], 0.0f)) * 0.5f;
    const auto part = [](float sum, float sign) {
        return std::copysign(std::sqrt(std::max(sum, 0.0f)) * 0.5f, sign);
    };
    volume::vec4 q(part(1 + r[0][0] - r[1][1] - r[2][2], r[2][1] - r[1][2]),
                   part(1 - r[0][0] + r[1][1] - r[2][2], r[0][2] - r[2][0]),
                   part(1 - r[0][0] - r[1][1] + r[2][2], r[1][0] - r[0][1]), w);
    if (w < 1e-3f) {  // half a turn: signs from products instead
        const int most = std::abs(q.x) >= std::abs(q.y) && std::abs(q.x) >= std::abs(q.z) ? 0
                         : std::abs(q.y) >= std::abs(q.z)                                 ? 1
                                                                                          : 2;
        for (int i = 0; i < 3; ++i)
            q[i] = i == most ? std::abs(q[i]) : std::copysign(q[i], r[i][most] + r[most][i]);
    }
    return q / std::max(glm::length(q), 1e-6f);
}

void checkSides(const FwFireColliderDef& def, uint32_t most) {
    for (const uint32_t side : {def.columns, def.rows})
        if (side < 2 || side > most)
            core::refuse("FwFireColliderDef has %u columns and %u rows; the limits are [2, %u].",
                         def.columns, def.rows, most);
}

template <class Check>
void checkNumbers(const float* numbers, size_t count, const char* name, float low, float high,
                  Check check) {
    char field[64];
    std::snprintf(field, sizeof field, "FwFireColliderDef::%s", name);
    if (!numbers) core::refuse("%s is null.", field);
    check(numbers, unsigned(count), field, low, high);
}

// Throws, and then `entry` is as it was.
void setShape(const FwFireColliderDef& def, float unitsPerMetre, FireColliderEntry& entry) {
    volume::Collider shape;
    if (def.kind > FW_COLLIDER_DEPTH)
        core::refuse("FwFireColliderDef::kind is %u; the limits are [0, %u].", def.kind,
                     uint32_t(FW_COLLIDER_DEPTH));
    checkLengths(def.position, 3, "FwFireColliderDef::position", -1e6f, 1e6f);
    shape.kind = volume::ColliderKind(def.kind);
    shape.place = volume::vecOf(def.position);
    bool keep = false;
    switch (shape.kind) {
        case volume::ColliderKind::Capsule:
            checkLengths(def.end, 3, "FwFireColliderDef::end", -1e6f, 1e6f);
            shape.extent = volume::vecOf(def.end);
            [[fallthrough]];
        case volume::ColliderKind::Sphere:
            checkLength(def.radius, "FwFireColliderDef::radius", 1e-4f, 1e5f);
            shape.radius = def.radius;
            break;
        case volume::ColliderKind::Box:
            checkLengths(def.halfSize, 3, "FwFireColliderDef::halfSize", 1e-4f, 1e5f);
            checkValues(def.rotation, 4, "FwFireColliderDef::rotation", -1.01f, 1.01f);
            shape.extent = volume::vecOf(def.halfSize);
            for (int i = 0; i < 4; ++i) shape.rotation[i] = def.rotation[i];
            break;
        case volume::ColliderKind::Plane:
            checkValues(def.normal, 3, "FwFireColliderDef::normal", -1e6f, 1e6f);
            shape.extent = volume::vecOf(def.normal);
            break;
        case volume::ColliderKind::HeightField: {
            checkLength(def.cellSize, "FwFireColliderDef::cellSize", 1e-3f, 1e5f);
            checkSides(def, 4096);
            shape.radius = def.cellSize;
            shape.columns = def.columns;
            shape.rows = def.rows;
            keep = !def.heights && entry.heights.size() == size_t(def.columns) * def.rows &&
                   entry.shape.columns == def.columns;
            break;
        }
        case volume::ColliderKind::Callback:
            if (!def.distance) core::refuse("FwFireColliderDef::distance is null.");
            shape.distance = &callHost;
            shape.user = &entry;
            break;
        case volume::ColliderKind::Depth:
            checkLength(def.radius, "FwFireColliderDef::radius", 0.01f, 100.0f);
            checkSides(def, volume::kMaxDepthSide);
            checkNumbers(def.depths, size_t(def.columns) * def.rows, "depths", 0.0f, 1.0f,
                         &checkValues);
            checkValues(def.view, 16, "FwFireColliderDef::view", -1e9f, 1e9f);
            checkValues(def.projection, 16, "FwFireColliderDef::projection", -1e9f, 1e9f);
            shape.radius = def.radius;
            shape.picture = &entry.picture;
            break;
    }
    if (shape.kind != volume::ColliderKind::HeightField) volume::checkCollider(shape);
    std::pmr::vector<float> heights(entry.heights.get_allocator());
    if (shape.kind == volume::ColliderKind::HeightField && !keep) {
        const size_t count = size_t(def.columns) * def.rows;
        checkNumbers(def.heights, count, "heights", -1e6f, 1e6f, &checkLengths);
        heights.assign(def.heights, def.heights + count);
    }
    if (shape.kind == volume::ColliderKind::Depth)
        volume::setDepthPicture(entry.picture, {def.depths, size_t(def.columns) * def.rows},
                                def.columns, def.rows, def.view, def.projection);
    else
        entry.picture.texels.clear();
    if (!keep) entry.heights.swap(heights);
    entry.shape = shape;
    entry.shape.heights = entry.heights.data();
    entry.distance = def.distance;
    entry.distanceData = def.distanceData;
    entry.unitsPerMetre = unitsPerMetre;
}

}  // namespace

// Pictures of depth stop no jet: flames alone see them.
FwFireColliderId FlameSystem::addCollider(const FwFireColliderDef& def, float unitsPerMetre) {
    scene_.geometryVersion += def.kind != FW_COLLIDER_DEPTH;
    checkRoom(colliders_, limits::kFireColliders, "fire colliders");
    auto entry = core::Owned<FireColliderEntry>::make(context_.memory, context_.memory);
    setShape(def, unitsPerMetre, *entry);
    return colliders_.create(std::move(entry));
}

void FlameSystem::setCollider(FwFireColliderId id, const FwFireColliderDef& def,
                              float unitsPerMetre) {
    FireColliderEntry& entry = *colliders_.get(id);
    const bool body = entry.shape.kind != volume::ColliderKind::Depth;
    setShape(def, unitsPerMetre, entry);
    scene_.geometryVersion += body || def.kind != FW_COLLIDER_DEPTH;
}

void FlameSystem::removeCollider(FwFireColliderId id) {
    scene_.geometryVersion += colliders_.get(id)->shape.kind != volume::ColliderKind::Depth;
    colliders_.destroy(id);
}

void FlameSystem::listShapes() noexcept {
    FW_ASSERT(colliders_.live() + exchange_.occluders().live() <= shapes_.capacity(),
              "%u colliders", colliders_.live());
    shapes_.clear();
    for (const bool pictures : {true, false}) {
        for (auto [i, entry] : colliders_.entries()) {
            const volume::Collider& shape = entry.shape;
            if ((shape.kind == volume::ColliderKind::Depth) != pictures) continue;
            shapes_.push_back(shape);
            // The host's function may return something else at any time.
            if (shape.kind == volume::ColliderKind::Callback) ++scene_.geometryVersion;
        }
        if (pictures) pictures_ = uint32_t(shapes_.size());
    }
    for (auto [i, entry] : exchange_.occluders().entries()) {
        volume::Collider box;
        box.kind = volume::ColliderKind::Box;
        for (int k = 0; k < 3; ++k) box.place[k] = float(entry.pose.translation[k]);
        box.extent = volume::vecOf(entry.halfSize) * entry.pose.scale;
        box.rotation = quaternion(entry.pose.rotation);
        shapes_.push_back(box);
    }
}

}  // namespace fw::world
