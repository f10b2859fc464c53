// Half-resolution target: soft effects are drawn into it, then composited over the host's image.
// clang-format off
#ifndef FW_SHARED_HALF_H
#define FW_SHARED_HALF_H
#include "shared/types.h"

FW_SHARED_BEGIN
// Texels per side of a tile that the composite draws or skips.
FW_CONST uint kHalfTile = 16u;

// Push constants of all half-resolution passes. A texel covers four pixels, starting at twice its
// coordinate.
struct HalfPush {
    vec4 clip;            // as VolumeDraw's
    int left; int top;    // px of the host's image: origin of the viewport
    uint width; uint height;  // px, of the viewport
    uint texelsX; uint texelsY; // half of them, rounded up
    uint tilesX; uint tilesY;   // of kHalfTile
};
FW_SIZE(HalfPush, 48)

// Texels alternate between the greatest and the least depth, see half_depth.frag.
FW_FN bool halfTakesGreater(int x, int y) { return ((x + y) & 1) != 0; }

// Similarity of four texels, [0, 1], from the sums of the greatest and least components. Similar
// texels are filtered across depth edges: the edge of a wall far behind a flame would be a seam in
// it.
FW_FN float halfAlike(float greatest, float least) {
    float apart =
        clamp(((greatest - least) / max(greatest, 1e-6f) - 0.15f) * (1.0f / 0.35f), 0.0f, 1.0f);
    return 1.0f - apart * apart * (3.0f - 2.0f * apart);
}

// Relative distance of two depths, m along the view, as a share of the nearer one.
FW_FN float halfApart(float a, float b) {
    float d = a - b;
    return (d < 0.0f ? -d : d) / max(min(a, b), 1e-3f);
}
// Beyond this distance a pixel and a texel lie on two sides of an edge.
FW_CONST float kHalfEdge = 0.03f;

// Bilateral weight of a texel. share: its bilinear weight; apart: relative depth distance to the
// pixel; least: that of the nearest texel. A hundredth more halves the weight: slopes are filtered,
// and a surface behind an edge does not bleed onto it.
FW_FN float halfWeight(float share, float apart, float least, float alike) {
    float off = (apart - least) * 100.0f;
    float near = 1.0f / (1.0f + off * off * off * off);
    return share * (near + alike * (1.0f - near));
}
FW_SHARED_END
#endif
