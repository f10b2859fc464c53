// How a volumetric flame is drawn: what a draw is told, where a ray's samples lie. What burns there
// is in volume.h, and what a draw reads in volume_flame.h.
// GLSL too, and laid out by hand.
// clang-format off
#ifndef FW_SHARED_VOLUME_DRAW_H
#define FW_SHARED_VOLUME_DRAW_H
#ifdef __cplusplus
#include <cmath>
#endif
#include "shared/types.h"

FW_SHARED_BEGIN
#ifdef __cplusplus
using glm::clamp;
using std::floor;
#endif

FW_SHARED_CONST uint kMaxVolumeFlames = 256u;   // of a world, in a frame
FW_SHARED_CONST uint kFirePresets = 9u;         // first layers of the profiles
FW_SHARED_CONST uint kMaxFireProfiles = 23u;    // the host's, behind them
FW_SHARED_CONST uint kProfileBytes = 32768u;    // of a layer: 64 x 128 pairs of halfs
FW_SHARED_CONST uint kVolumeSlabs = 6u;         // of a flame where the host's depth is only tested
FW_SHARED_CONST float kVolumeWhite = 1.5f;      // of soot of luminance 1, in the host's units

FW_SHARED_CONST uint kVolumeFlameBytes = 1792u; // a multiple of 256: each is a uniform block of its own

// Push constants: the part of the view that shows a flame, and its slabs in depth. A ray at x, y of
// the view: perspective: depth * (rayO + x rayX + y rayY); else: rayO + x rayX + y rayY + depth * forward.
struct VolumeDraw {
    vec4 rect;            // low x, low y, high x, high y, [-1, 1] over the viewport
    vec4 rayX;            // m, from the eye
    vec4 rayY;
    vec4 rayO;
    vec4 clip;            // clip z = x * depth + y; clip w = z * depth + w
    float front;          // m along the view, where the nearest slab begins
    float deep;           // m, of a slab
    uint slabs;           // [1, kVolumeSlabs]
    uint mostSteps;       // of a ray
    float spacing;        // m, between samples where mostSteps allows it
    uint intervals;       // [1, kFlameIntervals], of a ray, between knots
    float reserved0; float reserved1;
};
FW_SHARED_SIZE(VolumeDraw, 112)

// How many samples a ray takes over so many metres.
FW_SHARED_FN float volumeSteps(float metres, float spacing, uint most) {
    return clamp(floor(metres / spacing) + 1.0f, 4.0f, float(most));
}

// [0, 1): where in its steps a pixel's samples lie; neighbours differ, and so do moments.
FW_SHARED_FN float volumeJitter(float x, float y, float time) {
    float a = 0.06711056f * x + 0.00583715f * y;
    float b = 52.9829189f * (a - floor(a)) + 0.61803399f * floor(60.0f * time);
    return b - floor(b);
}
FW_SHARED_END
#endif
