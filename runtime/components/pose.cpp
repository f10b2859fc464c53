#include "components/pose.h"

#include "core/assert.h"
#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace fw::components {

void checkRotation(const float q[4], const char* name) {
    checkValues(q, 4, name, -1.001f, 1.001f);
    const float length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (std::fabs(length - 1) > 1e-3f)
        core::refuse("%s has length %g; it is a unit quaternion within 0.001.", name,
                     double(length));
}

void checkWhole(uint32_t value, const char* name, uint32_t low, uint32_t most) {
    FW_ASSERT(low <= most, "%s: [%u, %u]", name, low, most);
    if (value < low || value > most)
        core::refuse("%s is %u; the limits are [%u, %u].", name, value, low, most);
}

void checkFlags(uint32_t flags, const char* name, uint32_t known) {
    if (flags & ~known) core::refuse("%s is 0x%x; the known flags are 0x%x.", name, flags, known);
}

void checkValue(float value, const char* field, float low, float high) {
    if (!(value >= low && value <= high))  // also catches NaN
        core::refuse("%s is %g; the limits are [%g, %g].", field, double(value), double(low),
                     double(high));
}

void checkValues(const float* values, unsigned count, const char* field, float low, float high) {
    FW_ASSERT(values && low <= high, "%s: [%g, %g]", field, double(low), double(high));
    for (unsigned i = 0; i < count; ++i)
        if (!(values[i] >= low && values[i] <= high))
            core::refuse("%s[%u] is %g; the limits are [%g, %g].", field, i, double(values[i]),
                         double(low), double(high));
}

void checkLength(float value, const char* field, float low, float high) {
    if (!(value >= low && value <= high))
        core::refuse("%s is " FW_LENGTH "; the limits are [" FW_LENGTH ", " FW_LENGTH "].", field,
                     double(value), double(low), double(high));
}

void checkLengths(const float* values, unsigned count, const char* field, float low, float high) {
    for (unsigned i = 0; i < count; ++i)
        if (!(values[i] >= low && values[i] <= high)) {
            char name[128];
            std::snprintf(name, sizeof name, "%s[%u]", field, i);
            checkLength(values[i], name, low, high);
        }
}

Pose makePose(const float transform[16], const char* field) {
    constexpr float kFar = 1e6f;         // m
    constexpr double kTolerance = 1e-3;  // of the scale
    checkValues(transform, 12, field, -kFar, kFar);
    for (unsigned i = 12; i < 15; ++i) {
        char name[128];
        std::snprintf(name, sizeof name, "%s[%u]", field, i);
        checkLength(transform[i], name, -kFar, kFar);
    }
    const float lastRow[4] = {transform[3], transform[7], transform[11], transform[15]};
    for (unsigned i = 0; i < 4; ++i)
        if (!(std::fabs(double(lastRow[i]) - (i == 3 ? 1.0 : 0.0)) <= 1e-6))  // also catches NaN
            core::refuse("%s[%u] is %g; the last row of the matrix is 0 0 0 1.", field, i * 4 + 3,
                         double(lastRow[i]));
    double column[3][3], length[3];
    for (int c = 0; c < 3; ++c) {
        double sum = 0;
        for (int r = 0; r < 3; ++r) {
            column[c][r] = double(transform[c * 4 + r]);
            sum += column[c][r] * column[c][r];
        }
        length[c] = std::sqrt(sum);
    }
    const double scale = (length[0] + length[1] + length[2]) / 3;
    if (!(scale >= 1e-3 && scale <= 1e3))
        core::refuse("%s has scale %g; the limits are [0.001, 1000].", field, scale);
    const auto [shortest, longest] = std::minmax({length[0], length[1], length[2]});
    if (!(longest <= shortest * double(kMaxStretch)))
        core::refuse(
            "%s scales its axes by %g, %g and %g; the largest is at most %g times the "
            "smallest.",
            field, length[0], length[1], length[2], double(kMaxStretch));
    for (int c = 0; c < 3; ++c) {
        const int d = (c + 1) % 3;
        double dot = 0;
        for (int r = 0; r < 3; ++r) dot += column[c][r] * column[d][r];
        const double cosine = dot / (length[c] * length[d]);
        if (std::fabs(cosine) > kTolerance)
            core::refuse("%s is sheared: axes %d and %d have cosine %g; the limit is 0.001.", field,
                         c, d, cosine);
    }
    const double determinant =
        column[0][0] * (column[1][1] * column[2][2] - column[1][2] * column[2][1]) -
        column[1][0] * (column[0][1] * column[2][2] - column[0][2] * column[2][1]) +
        column[2][0] * (column[0][1] * column[1][2] - column[0][2] * column[1][1]);
    bool even = true;
    for (int c = 0; c < 3; ++c) even &= std::fabs(length[c] - scale) <= kTolerance * scale;
    Pose pose;
    pose.scale = float(scale);
    if (!even)
        for (int c = 0; c < 3; ++c) pose.stretch[c] = float(length[c] / scale);
    // A mirror is a mirror of x and a rotation.
    const double turn = determinant < 0 ? -1 : 1;
    pose.stretch[0] *= float(turn);
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c)
            pose.rotation[r][c] = float((c == 0 ? turn : 1) * column[c][r] / length[c]);
        pose.translation[r] = double(transform[12 + r]);
    }
    return pose;
}

bool uniform(const Pose& pose) noexcept {
    return pose.stretch[0] == 1 && pose.stretch[1] == 1 && pose.stretch[2] == 1;
}

void toWorld(const Pose& pose, const float point[3], float (&out)[3]) noexcept {
    double place[3];
    toWorld(pose, point, place);
    for (int i = 0; i < 3; ++i) out[i] = float(place[i]);
}

void toWorld(const Pose& pose, const float point[3], double (&out)[3]) noexcept {
    for (int r = 0; r < 3; ++r) {
        float sum = 0;
        for (int c = 0; c < 3; ++c) sum += pose.rotation[r][c] * (pose.stretch[c] * point[c]);
        out[r] = double(pose.scale * sum) + pose.translation[r];
    }
}

void toObject(const Pose& pose, const float point[3], float (&out)[3]) noexcept {
    FW_ASSERT(
        pose.scale > 0 && pose.stretch[0] != 0 && pose.stretch[1] != 0 && pose.stretch[2] != 0,
        "scale %g, stretch (%g, %g, %g)", double(pose.scale), double(pose.stretch[0]),
        double(pose.stretch[1]), double(pose.stretch[2]));
    float from[3];
    for (int i = 0; i < 3; ++i)
        from[i] = float(double(point[i]) - pose.translation[i]) / pose.scale;
    directionToObject(pose, from, out);
    for (int i = 0; i < 3; ++i) out[i] /= pose.stretch[i];
}

void directionToObject(const Pose& pose, const float vector[3], float (&out)[3]) noexcept {
    for (int c = 0; c < 3; ++c)
        out[c] = pose.rotation[0][c] * vector[0] + pose.rotation[1][c] * vector[1] +
                 pose.rotation[2][c] * vector[2];
}

}  // namespace fw::components
