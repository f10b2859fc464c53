// Refinement pattern of the reference implementation: packing of a pattern triangle in one word,
// its vertices, and the rule that consumes its children. The host chooses the drawn triangles
// (pattern_frame.h). The product's scheme is in refine.h.
// clang-format off
#ifndef FW_REFERENCE_PATTERN_WORD_H
#define FW_REFERENCE_PATTERN_WORD_H
#include "shared/refine.h"

FW_SHARED_BEGIN

// Pattern word. Bits 0 and 6: lattice point of the right-angled corner, in steps of 2^depth from
// corner 0 of the coarse triangle towards corners 1 and 2. Bit 12: halvings. Bit 15: points down.
// Bit 16: coarse triangle.
FW_CONST uint kPatternEmpty = 0xFFFFFFFFu;  // pads a list to whole groups
FW_CONST uint kPatternDown = 0x8000u;
FW_CONST uint kPatternMaxTriangles = 65535u;  // coarse triangles

FW_FN uint packPatternWord(uint c1, uint c2, uint halvings, bool down) {
    return c1 | (c2 << 6u) | (halvings << 12u) | (down ? kPatternDown : 0u);
}
FW_FN uint patternHalvings(uint word) { return (word >> 12u) & 7u; }
FW_FN uint patternCoarse(uint word) { return word >> 16u; }

// Lattice point k: 0..2 are the corners, 3..5 the middle of the side that starts at corner k - 3.
FW_FN uvec2 patternPoint(uint word, uint depth, uint k) {
    uint c1 = word & 63u, c2 = (word >> 6u) & 63u;
    uint side = 1u << (depth - patternHalvings(word)), half_ = side >> 1u;
    uint d1 = k == 1u ? side : k == 3u || k == 4u ? half_ : 0u;
    uint d2 = k == 2u ? side : k == 4u || k == 5u ? half_ : 0u;
    bool down = (word & kPatternDown) != 0u;
    return uvec2(down ? c1 - d1 : c1 + d1, down ? c2 - d2 : c2 + d2);
}

// Draw vertex of a lattice point. All sides of the coarse triangle have the interior's depth.
FW_FN uint patternDrawVertex(FW_IN(RefineTriangle) t, uint c1, uint c2) {
    uint depth = refineInteriorDepth(t.flags);
    uint c0 = (1u << depth) - c1 - c2;
    uint code = refineInside(c1, c2);
    if (c1 == 0u) code = refineOnSide(2u, c0);
    if (c0 == 0u) code = refineOnSide(1u, c2);
    if (c2 == 0u) code = refineOnSide(0u, c1);
    return refineDrawVertex(t, refinePack(depth, depth, depth, depth), code);
}

// Burn-level rule. gone: one bit for each of the six points that is burnt through. A triangle is
// consumed if all corners are gone, or if two of its four children are. finest: it has no children.
FW_FN bool isPatternConsumed(uint gone, bool finest) {
    if (finest || (gone & 7u) == 7u) return (gone & 7u) == 7u;
    uint children = ((gone & 0x29u) == 0x29u ? 1u : 0u) + ((gone & 0x1Au) == 0x1Au ? 1u : 0u) +
                    ((gone & 0x34u) == 0x34u ? 1u : 0u) + ((gone & 0x38u) == 0x38u ? 1u : 0u);
    return children >= 2u;
}

struct PatternPush {
    uint phase;
    uint nowTick;
    uint firstGroup;  // first group of the phase in the list
    float recede;     // share of a slot's reach, [0, 1)
};
FW_SIZE(PatternPush, 16)

FW_SHARED_END
#endif
