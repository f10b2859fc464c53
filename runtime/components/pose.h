// Pose of an object: a rotation, a scale along each of its axes and a translation, checked on
// entry; and the checks of other numbers of a def.
#pragma once
#include "flamewright/flamewright.h"
#include "host_limits.h"

namespace fw::components {

constexpr double kFarthestPlace = 2e6;  // m: beyond 1e6 of places from before the origin moved

struct Pose {
    float rotation[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  // rows, object to world, no scale
    float scale = 1;               // mean of the three axes, [1e-3, 1e3]
    float stretch[3] = {1, 1, 1};  // of each object axis, beyond scale; x < 0: mirrored
    double translation[3] = {};    // m, [-1e6, 1e6]; double: exact however far the origin moved
    bool operator==(const Pose&) const = default;

    template <class A>
    void serialize(A& a) {
        a(rotation, scale, stretch, translation);
        a.range("rotation", rotation, -1.01, 1.01);
        a.range("scale", scale, 1e-4, 1e4);
        for (const float size : stretch) a.range("stretch", size < 0 ? -size : size, 1.0 / 64, 64);
        a.range("place", translation, -kFarthestPlace, kFarthestPlace);
    }
};

constexpr float kMaxStretch = float(limits::kStretch);  // longest axis over shortest

// Throws core::Error naming `field`, the value and the limit unless every value is finite, the
// last row is 0 0 0 1, and the upper 3x3 is a rotation times a scale per axis, without shear
// (1e-3). Scales that agree within 1e-3 are one.
Pose makePose(const float transform[16], const char* field);

void toWorld(const Pose& pose, const float point[3], float (&out)[3]) noexcept;
void toWorld(const Pose& pose, const float point[3], double (&out)[3]) noexcept;
void toObject(const Pose& pose, const float point[3], float (&out)[3]) noexcept;
[[nodiscard]] bool uniform(const Pose& pose) noexcept;  // one scale, not mirrored
// A direction: rotated only.
void directionToObject(const Pose& pose, const float vector[3], float (&out)[3]) noexcept;

constexpr float kMaxPower = float(limits::kFirePower);  // kW, of a fire

// Throws unless all `count` values are finite and within [low, high]: "field[i] is v; ...".
void checkValues(const float* values, unsigned count, const char* field, float low, float high);
void checkValue(float value, const char* field, float low, float high);
// Likewise for metres or m/s; the message is in the unit of the host's world.
void checkLengths(const float* values, unsigned count, const char* field, float low, float high);
void checkLength(float value, const char* field, float low, float high);
// Throws unless `q` is a unit quaternion.
void checkRotation(const float q[4], const char* name);
// Throws unless the whole number is within [low, most]: "field is v; ...".
void checkWhole(uint32_t value, const char* name, uint32_t low, uint32_t most);
// Throws unless all flags are known.
void checkFlags(uint32_t flags, const char* name, uint32_t known);

}  // namespace fw::components
