// Holes and open borders of refined triangles: the kept part of a small triangle, walls along its
// rim and along open edges, and the inner skin.
// clang-format off
#ifndef FW_SHARED_REFINE_CUT_H
#define FW_SHARED_REFINE_CUT_H
#include "shared/refine_records.h"

FW_SHARED_BEGIN

// ---- holes. Solid where the hole is still to come; a small triangle keeps the polygon on the
// solid side.

// s to the hole.
FW_FN float secondsToHole(float hole, float now) {
    float f = hole - now;
    return f < kRefineUnlit ? f : kRefineUnlit;
}
// Cut position between the low slot (fa) and the high one (fb), one of them burnt through: a
// function of the small edge, equal for both triangles, and never on a vertex.
FW_FN float refineCutAt(float fa, float fb) {
    float t = fa / (fa - fb);
    t = t > 1.0f / 64.0f ? t : 1.0f / 64.0f;
    return t < 63.0f / 64.0f ? t : 63.0f / 64.0f;
}
FW_FN vec3 refineCutPoint(vec3 low, vec3 high, float fa, float fb) {
    FW_PRECISE vec3 p = low + (high - low) * refineCutAt(fa, fb);
    return p;
}

struct RefineCut {   // kept polygon of a small triangle
    uint points;     // 0, 3 or 4
    uint corner[4];  // k: corner k; 4 + k: cut point of the side from k
    uint rim;        // polygon side along the hole; 4: none
    uint open;       // bit per polygon side: on an open edge of the mesh
};
// solid, open: bit per corner, bit per side.
FW_FN RefineCut refineCut(uint solid, uint open) {
    RefineCut cut;
    cut.points = 0u;
    cut.rim = 4u;
    cut.open = 0u;
    for (uint k = 0u; k < 3u; ++k) {
        bool here = ((solid >> k) & 1u) != 0u;
        bool there = ((solid >> refineNext(k)) & 1u) != 0u;
        uint side = (open >> k) & 1u;
        if (here) {
            cut.open |= side << cut.points;
            cut.corner[cut.points] = k;
            cut.points += 1u;
        }
        if (here != there) {
            if (here) cut.rim = cut.points;
            else cut.open |= side << cut.points;
            cut.corner[cut.points] = 4u + k;
            cut.points += 1u;
        }
    }
    return cut;
}
FW_FN uint refineCutWalls(FW_IN(RefineCut) cut) {
    uint o = cut.open;
    return (cut.rim < 4u ? 1u : 0u) + (o & 1u) + ((o >> 1u) & 1u) + ((o >> 2u) & 1u) + (o >> 3u);
}
// Triangles drawn in addition to the index list; the k-th is refineCutTriangle(refineCutDrawn(k)).
// A whole triangle is in the index list and only adds walls; sheets have no inner skin.
FW_FN uint refineCutDrawnCount(FW_IN(RefineCut) cut, bool inner, bool whole) {
    if (cut.points == 0u) return 0u;
    uint fan = cut.points - 2u;
    return (whole ? 0u : inner ? 2u * fan : fan) + 2u * refineCutWalls(cut);
}
FW_FN uint refineCutDrawn(FW_IN(RefineCut) cut, uint k, bool inner, bool whole) {
    uint fan = cut.points - 2u;
    if (whole) return k + 2u * fan;
    return inner || k < fan ? k : k + fan;
}
// Capacity for cut triangles before a material whose first triangle of `triangles` is `first`.
FW_FN uint refineCutShare(uint room, uint first, uint triangles) {
    return room * (first < triangles ? first : triangles) / triangles;
}
FW_CONST uint kMaxRefineCut = 1u << 14u;  // cut triangles of an object
// Last word of a cut vertex, a float: s to the hole, 0 at the hole; for walls one of these, and 1
// less at the inner skin:
FW_CONST float kRefineCutRim = -1.0f;   // at the outer skin
FW_CONST float kRefineBorder = -3.0f;   // along an open edge, at the outer skin
// Polygon side on which the k-th triangle's wall stands.
FW_FN uint refineCutWallSide(FW_IN(RefineCut) cut, uint k) {
    uint wanted = (k - 2u * (cut.points - 2u)) >> 1u;
    uint x = 0u;
    for (uint i = 0u; i < cut.points; ++i) {
        bool wall = i == cut.rim || ((cut.open >> i) & 1u) != 0u;
        if (!wall) continue;
        if (wanted == 0u) {
            x = i;
            break;
        }
        wanted -= 1u;
    }
    return x;
}
// Polygon points of the k-th triangle; + 4: on the inner skin.
FW_FN uvec3 refineCutTriangle(FW_IN(RefineCut) cut, uint k) {
    uint fan = cut.points - 2u;
    if (k < fan) return uvec3(0u, k + 1u, k + 2u);
    if (k < 2u * fan) return uvec3(4u, k - fan + 6u, k - fan + 5u);
    uint x = refineCutWallSide(cut, k);
    uint y = x + 1u < cut.points ? x + 1u : 0u;
    return (k & 1u) == 0u ? uvec3(y, x, x + 4u) : uvec3(y, x + 4u, y + 4u);
}
FW_SHARED_END
#endif
