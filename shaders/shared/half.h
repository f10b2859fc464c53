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

// What a texel weighs of which a bilinear filter would take `share`, `away` and `there` m along the view: of the pixel
// and of the texel. A twentieth of the way nearer or farther is half of it, so that slopes are filtered and the other
// side of an edge does not count unless there is nothing else.
FW_SHARED_FN float halfWeight(float share, float away, float there, float alike) {
    float off = (away - there) / max(min(away, there), 1e-3f) * 20.0f;
    float near = 1.0f / (1.0f + off * off);
    return share * (near + alike * (1.0f - near));
}
FW_SHARED_END
#endif
