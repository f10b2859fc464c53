// Patterns of refined triangles: the k-th triangle of a pattern, and the vertices at its corners,
// for any levels around it.
// clang-format off
#ifndef FW_SHARED_REFINE_PATTERN_H
#define FW_SHARED_REFINE_PATTERN_H
#include "shared/refine_records.h"

FW_SHARED_BEGIN

// ---- patterns. A vertex code: 0x8000 | side << 8 | i, i in 0..2^l from the side's first corner;
// or c1 << 6 | c2 of the lattice, both >= 1, c1 + c2 < 2^m.

FW_CONST uint kRefineOnSide = 0x8000u;
FW_FN uint refineOnSide(uint e, uint i) { return kRefineOnSide | (e << 8u) | i; }
FW_FN uint refineInside(uint c1, uint c2) { return (c1 << 6u) | c2; }
FW_FN uint refineCodeSide(uint code) { return (code >> 8u) & 3u; }
FW_FN uint refineCodeStep(uint code) { return code & 255u; }

FW_FN uint refineStripStart(uint l, uint m) {
    uint n = 1u << m;
    return 63u * (m - 2u) + 6u * (n - 4u - 3u * (m - 2u)) + (1u << l) - 1u + l * (n - 3u);
}
FW_FN uint refineInnerStart(uint m) {
    return kRefineInner + (m < 4u ? m - 2u : m == 4u ? 26u : 195u);
}

// Token j of a strip: bit 0 set: (edge i, row j + 1, row j), else (edge i, edge i + 1, row j).
FW_CONSTANT_FN uint refineStripToken(uint row, uint i, uint j) {
    return row | (i << 1u) | (j << 7u);
}
// Token of the lattice: bit 10: the triangle points down.
FW_CONSTANT_FN uint refineInnerToken(uint down, uint a, uint b) {
    return a | (b << 5u) | (down << 10u);
}
// Token for m < 2: three vertices of three bits; 0..2 corners, 3..5 middles of the sides.
FW_FN uint refineHandCode(uint v) {
    return v < 3u ? refineOnSide(v, 0u) : refineOnSide(v - 3u, 1u);
}

// j-th point of the lattice row beside side e, in the side's direction.
FW_FN uint refineRowPoint(uint e, uint j, uint n) {
    uint near = n - 1u - j;  // c[e]; c[e + 1] = j, c[e + 2] = 1
    return e == 0u ? refineInside(j, 1u) : e == 1u ? refineInside(near, j) : refineInside(1u, near);
}

struct RefinePlace {  // table position of the k-th triangle
    uint entry;       // of the table
    uint part;        // 0..2: strip of that side; 3: lattice; 4: m < 2
    uint k;           // number in that part
};

FW_FN RefinePlace refineLocate(uint levels, uint k) {
    RefinePlace place;
    uint m = refineInterior(levels);
    if (m < 2u) {
        uint mask = refineSide(levels, 0u) | (refineSide(levels, 1u) << 1u) |
                    (refineSide(levels, 2u) << 2u);
        place.entry = kRefineHand + mask * 4u + k;
        place.part = 4u;
        place.k = k;
        return place;
    }
    uint s = (1u << m) - 3u;
    if (k < s * s) {
        place.entry = refineInnerStart(m) + k;
        place.part = 3u;
        place.k = k;
        return place;
    }
    k -= s * s;
    uint e = 0u;
    uint length = (1u << refineSide(levels, 0u)) + s;
    if (k >= length) {
        k -= length;
        e = 1u;
        length = (1u << refineSide(levels, 1u)) + s;
        if (k >= length) {
            k -= length;
            e = 2u;
        }
    }
    place.entry = refineStripStart(refineSide(levels, e), m) + k;
    place.part = e;
    place.k = k;
    return place;
}

// Codes of the triangle, counter-clockwise. token: table[place.entry].
FW_FN uvec3 refineCodes(uint levels, FW_IN(RefinePlace) place, uint token) {
    if (place.part == 4u)
        return uvec3(refineHandCode(token & 7u), refineHandCode((token >> 3u) & 7u),
                     refineHandCode((token >> 6u) & 7u));
    if (place.part == 3u) {
        uint a = token & 31u;
        uint b = (token >> 5u) & 31u;
        if ((token & 1024u) != 0u)
            return uvec3(refineInside(a + 2u, b + 1u), refineInside(a + 2u, b + 2u),
                         refineInside(a + 1u, b + 2u));
        return uvec3(refineInside(a + 1u, b + 1u), refineInside(a + 2u, b + 1u),
                     refineInside(a + 1u, b + 2u));
    }
    uint e = place.part, f = refineNext(e), p = refineBefore(e);
    uint m = refineInterior(levels), n = 1u << m;
    uint l = refineSide(levels, e), steps = 1u << l;
    uint i = (token >> 1u) & 63u, j = token >> 7u;
    uint row = refineRowPoint(e, j, n);
    // Corners use the other diagonal where both sides have the lattice's level: with l = m
    // everywhere the result is the regular lattice, and levels nest.
    if (place.k == 0u && l == m && refineSide(levels, p) == m)
        return uvec3(refineOnSide(e, 1u), row, refineOnSide(p, (1u << refineSide(levels, p)) - 1u));
    if (place.k == steps + n - 4u && l == m && refineSide(levels, f) == m)
        return uvec3(refineOnSide(e, steps - 1u), refineOnSide(f, 0u), refineOnSide(f, 1u));
    if ((token & 1u) != 0u) return uvec3(refineOnSide(e, i), refineRowPoint(e, j + 1u, n), row);
    return uvec3(refineOnSide(e, i), refineOnSide(e, i + 1u), row);
}

// Weights of the three corners in 1/32.
FW_FN uvec3 refineWeights(uint levels, uint code) {
    if ((code & kRefineOnSide) != 0u) {
        uint e = refineCodeSide(code);
        uint i = refineCodeStep(code) << (kRefineDepth - refineSide(levels, e));
        uint k = 32u - i;
        return e == 0u ? uvec3(k, i, 0u) : e == 1u ? uvec3(0u, k, i) : uvec3(i, 0u, k);
    }
    uint shift = kRefineDepth - refineInterior(levels);
    uint c1 = (code >> 6u) << shift, c2 = (code & 63u) << shift;
    return uvec3(32u - c1 - c2, c1, c2);
}

// Sides of the coarse triangle that contain a code, one bit each.
FW_FN uint refineSidesOf(uint levels, uint code) {
    if ((code & kRefineOnSide) == 0u) return 0u;
    uint e = refineCodeSide(code), i = refineCodeStep(code);
    uint bits = 1u << e;
    if (i == 0u) bits |= 1u << refineBefore(e);
    if (i == (1u << refineSide(levels, e))) bits |= 1u << refineNext(e);
    return bits;
}

// ---- identity: a vertex keeps its number on all levels

// Inner point i (1 .. 2^l - 1, from the low end) of an edge, counted from the edge's first.
FW_FN uint refineEdgePoint(uint i, uint l, uint depth) { return (i << (depth - l)) - 1u; }
// Lattice point of n = 2^depth steps, counted from the interior's first.
FW_FN uint refineInnerPoint(uint c1, uint c2, uint n) {
    uint r = c2 - 1u;
    return r * (n - 2u) - ((r * (r - 1u)) >> 1u) + c1 - 1u;
}
FW_FN uint refineInnerCount(uint m) {
    uint n = 1u << m;
    return m < 2u ? 0u : ((n - 1u) * (n - 2u)) >> 1u;
}
// i in 0..2^l from the low end.
FW_FN uint refineEdgeSlot(FW_IN(RefineEdge) edge, uint i, uint l) {
    if (i == 0u) return edge.low;
    if (i == (1u << l)) return edge.high;
    return edge.slot + refineEdgePoint(i, l, edge.flags & 15u);
}
// m: the interior's level.
FW_FN uint refineInnerSlot(FW_IN(RefineTriangle) t, uint c1, uint c2, uint m) {
    uint depth = refineInteriorDepth(t.flags);
    uint shift = depth - m;
    return t.slot + refineInnerPoint(c1 << shift, c2 << shift, 1u << depth);
}
FW_FN uint refineDrawVertex(FW_IN(RefineTriangle) t, uint levels, uint code) {
    if ((code & kRefineOnSide) == 0u)
        return refineInnerSlot(t, code >> 6u, code & 63u, refineInterior(levels));
    uint e = refineCodeSide(code), i = refineCodeStep(code);
    uint l = refineSide(levels, e), steps = 1u << l;
    if (i == 0u) return t.corner[e];
    if (i == steps) return t.corner[refineNext(e)];
    i = refineFlipped(t.flags, e) ? steps - i : i;
    return t.side[e] + refineEdgePoint(i, l, refineSideDepth(t.flags, e));
}

FW_SHARED_END
#endif
