// The target of half resolution: what is soft of a view is drawn into it, and it is laid over the
// host's picture.
// GLSL too, and laid out by hand.
// clang-format off
#ifndef FW_SHARED_HALF_H
#define FW_SHARED_HALF_H
#include "shared/types.h"

FW_SHARED_BEGIN
#ifdef __cplusplus
using glm::clamp;
using glm::max;
using glm::min;
#endif

FW_SHARED_CONST uint kHalfTile = 16u;  // texels a side of what is laid over the picture or left out as a whole

// Push constants of all that make it and show it. A texel is the four pixels from twice its place on.
struct HalfPush {
    vec4 clip;            // as VolumeDraw's
    int left; int top;    // px of the host's image: where the viewport begins
    uint width; uint height;  // px, of the viewport
    uint texelsX; uint texelsY; // half of them, rounded up
    uint tilesX; uint tilesY;   // of kHalfTile
};
FW_SHARED_SIZE(HalfPush, 48)

// Of one or the other every second texel in both directions, see half_depth.frag.
FW_SHARED_FN bool halfTakesGreater(int x, int y) { return ((x + y) & 1) != 0; }

// [0, 1]: how much alike four texels are of which the sums of the greatest and the least of each component are given.
// Where they are, what is seen of them does not depend on what stands there, and they are filtered across its edges:
// the edge of a wall far behind a flame would be a seam in it.
FW_SHARED_FN float halfAlike(float greatest, float least) {
    float apart = clamp(((greatest - least) / max(greatest, 1e-6f) - 0.15f) * (1.0f / 0.35f), 0.0f, 1.0f);
    return 1.0f - apart * apart * (3.0f - 2.0f * apart);
}

// How far apart two depths are, m along the view, as a part of the nearer one.
FW_SHARED_FN float halfApart(float a, float b) {
    float d = a - b;
    return (d < 0.0f ? -d : d) / max(min(a, b), 1e-3f);
}
// Farther apart than this a pixel and a texel are on two sides of an edge.
FW_SHARED_CONST float kHalfEdge = 0.03f;

// Weight of a texel of which a bilinear filter would take `share`; `apart`: of the pixel, and `least` of the texel
// that is nearest to it. A hundredth farther than that one is half of it: slopes are filtered, and what stands a step
// behind does not shine onto the edge of what is before it.
FW_SHARED_FN float halfWeight(float share, float apart, float least, float alike) {
    float off = (apart - least) * 100.0f;
    float near = 1.0f / (1.0f + off * off * off * off);
    return share * (near + alike * (1.0f - near));
}
FW_SHARED_END
#endif
