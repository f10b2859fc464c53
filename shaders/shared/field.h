// A 2D particle field: what one cell gives to its eight neighbours, and what it becomes of what
// they give. Integers only, so that no particle is lost or made. It loads nothing: callers hand
// over cells.
//
// One cell side and one step are the units: a speed of 1 is a cell per step. Directions are a ring
// as the front's: counter-clockwise from +x, odd ones diagonal; +y is up.
// GLSL too, and laid out by hand.
// clang-format off
#ifndef FW_SHARED_FIELD_H
#define FW_SHARED_FIELD_H
#include "shared/integer.h"

FW_SHARED_BEGIN

FW_SHARED_CONST uint kFieldSources = 4u;         // of a field
FW_SHARED_CONST uint kFieldSideMost = 256u;      // cells
FW_SHARED_CONST uint kFieldMovesMost = 65535u;   // particles that leave a cell in one step
FW_SHARED_CONST uint kFieldCellFull = 1u << 20u; // particles from which nothing is emitted into a cell
FW_SHARED_CONST uint kFieldSpreadMost = 8192u;   // Q16: an eighth; twice this is unstable

FW_SHARED_CONST uint kFieldWall = 1u;            // bits of FieldCell::kind
FW_SHARED_CONST uint kFieldOpenLeft = 1u;        // bits of FieldRules::open: particles leave the field there
FW_SHARED_CONST uint kFieldOpenRight = 2u;
FW_SHARED_CONST uint kFieldOpenBottom = 4u;
FW_SHARED_CONST uint kFieldOpenTop = 8u;

struct FieldSource {     // a rectangle of cells that emits
    ivec4 cells;         // first x, first y, end x, end y
    uint rate;           // Q8 particles of a cell and step
    uint pad0; uint pad1; uint pad2;
};
FW_SHARED_SIZE(FieldSource, 32)

struct FieldRules {      // of one field
    int forceX;          // Q7, outer force (wind, buoyancy, weight): 128 moves all by one cell a step
    int forceY;
    uint inertia;        // Q8, weight of the cell's mean motion
    uint chaos;          // Q8, weight of a random direction, the same over 4 x 4 cells and 4 steps

    uint spread;         // Q16, [0, kFieldSpreadMost]: share of a difference that flows to each neighbour
    uint memory;         // Q8, how much of its motion a particle keeps in a step
    uint death;          // Q16, share that dies in a step
    uint seed;

    uint width;          // cells
    uint height;
    uint open;           // kFieldOpen bits; elsewhere borders are walls
    uint sourceCount;

    FieldSource sources[kFieldSources];
};
FW_SHARED_SIZE(FieldRules, 176)

// Unit vector of direction k, Q7.
FW_SHARED_FN ivec2 fieldDirection(uint k) {
    int diagonal = (k & 1u) != 0u ? 91 : 128;
    int x = (k == 2u || k == 6u) ? 0 : ((k > 2u && k < 6u) ? -diagonal : diagonal);
    int y = (k == 0u || k == 4u) ? 0 : (k > 4u ? -diagonal : diagonal);
    return ivec2(x, y);
}
FW_SHARED_FN ivec2 fieldNeighbour(uint k) {  // the same in cells
    ivec2 d = fieldDirection(k);
    return ivec2(d.x == 0 ? 0 : (d.x > 0 ? 1 : -1), d.y == 0 ? 0 : (d.y > 0 ? 1 : -1));
}

// A random number of a cell in a step. Each use has its own salt.
FW_SHARED_FN uint fieldRandom(uint x, uint y, uint step, uint seed, uint salt) {
    return hash32(hash32((x | (y << 16u)) ^ (seed * 0x9E3779B9u)) ^ (step * 0x85EBCA6Bu + salt));
}

// A random unit vector, Q7 (within 1 of it), all angles alike: an eighth of a turn to both sides of
// an axis by the first terms of sine and cosine.
FW_SHARED_FN ivec2 fieldChaos(uint x, uint y, uint step, uint seed) {
    uint h = fieldRandom(x >> 2u, y >> 2u, step >> 2u, seed, 1u);
    int a = int(h & 255u) - 128;
    a += a >= 0 ? 1 : 0;  // -128..-1, 1..128: no side is favoured
    int c = 128 - ((a * a * 75) >> 15u);
    int s = a * (1646592 - 10 * a * a);  // Q28
    s = s >= 0 ? (s >> 21u) : -((-s) >> 21u);
    ivec2 d = (h & 256u) != 0u ? ivec2(c, s) : ivec2(-s, c);
    return (h & 512u) != 0u ? d : ivec2(-d.x, -d.y);
}

FW_SHARED_FN int fieldLobe(int along) { return along > 0 ? along : 0; }

// What leaves a cell in each direction, two 16-bit counts to a word: direction 0 is the low half of
// .x. `n`: its particles; mean: Q10, their mean motion; around: particles of its neighbours;
// closed: bit k, no way there (a wall, a closed border); random: fieldChaos; dither: [0, 255].
// Flows are kept in 1/256 particles and rounded along the ring: what is cut off one direction is
// carried to the next, the first begins at the dither. The sum is theirs, within one, and every
// direction gets its flow on average.
FW_SHARED_FN uvec4 fieldShares(uint n, ivec2 mean, uint around[8], uint closed, FieldRules rules,
                               ivec2 random, uint dither) {
    uint moves = n < kFieldMovesMost ? n : kFieldMovesMost;
    uint flow[8];
    uint sum = 0u;
    FW_UNROLL for (uint k = 0u; k < 8u; ++k) {
        ivec2 u = fieldDirection(k);
        // Q22: cosine lobes of motion, force and chance.
        int lobes = (fieldLobe(mean.x * u.x + mean.y * u.y) >> 3u) * int(rules.inertia) +
                    (fieldLobe(rules.forceX * u.x + rules.forceY * u.y) << 8u) +
                    fieldLobe(random.x * u.x + random.y * u.y) * int(rules.chaos);
        // The eight cosines of a unit vector sum up to 2.41..2.61: 0.41 of it is a share. Q16.
        uint share = ((uint(lobes) >> 6u) * 105u) >> 8u;
        share = share < 65535u ? share : 65535u;
        uint less = n > around[k] ? n - around[k] : 0u;
        less = less < kFieldMovesMost ? less : kFieldMovesMost;
        uint f = ((moves * share) >> 8u) + ((less * rules.spread) >> 8u);
        f = f < 0xFFFFFFu ? f : 0xFFFFFFu;
        flow[k] = (closed & (1u << k)) != 0u ? 0u : f;
        sum += flow[k];
    }
    // More than it has: all of them in the same proportion. Q16, below 1.
    uint scale = sum > (moves << 8u) ? divide(moves << 16u, (sum >> 8u) + 1u) : 65536u;
    uvec4 shares = uvec4(0u);
    uint carry = dither;
    FW_UNROLL for (uint k = 0u; k < 8u; ++k) {
        uint f = scale == 65536u ? flow[k]
                                 : (((flow[k] >> 8u) * scale) >> 8u) + (((flow[k] & 255u) * scale) >> 16u);
        carry += f;
        shares[int(k >> 1u)] |= (carry >> 8u) << ((k & 1u) * 16u);
        carry &= 255u;
    }
    return shares;
}

FW_SHARED_FN uint fieldShare(uvec4 shares, uint k) { return (shares[int(k >> 1u)] >> ((k & 1u) * 16u)) & 0xFFFFu; }

FW_SHARED_FN uint fieldShareSum(uvec4 s) {
    uvec4 both = uvec4(s.x & 0xFFFFu, s.y & 0xFFFFu, s.z & 0xFFFFu, s.w & 0xFFFFu);
    return both.x + both.y + both.z + both.w + (s.x >> 16u) + (s.y >> 16u) + (s.z >> 16u) + (s.w >> 16u);
}

FW_SHARED_FN int fieldMean(int sum, uint count) {
    if (count == 0u) return 0;
    return sum >= 0 ? int(divide(uint(sum), count)) : -int(divide(uint(-sum), count));
}

// What motion a particle has that comes from direction k of a cell, where the mean was `mean`. Q10.
FW_SHARED_FN ivec2 fieldCarried(ivec2 mean, uint k, uint memory) {
    ivec2 u = fieldDirection(k);
    int kept = int(memory), fresh = 256 - kept;
    return ivec2((mean.x * kept - u.x * 8 * fresh + 128) >> 8u, (mean.y * kept - u.y * 8 * fresh + 128) >> 8u);
}

// The mean motion after a step: of those that stayed, and of those that came from each direction.
FW_SHARED_FN ivec2 fieldMotion(uint stayed, ivec2 mean, uint came[8], ivec2 means[8], uint memory) {
    uint count = stayed < kFieldCellFull ? stayed : kFieldCellFull;
    int kept = int(memory);
    ivec2 sum = ivec2(((mean.x * kept + 128) >> 8u) * int(count), ((mean.y * kept + 128) >> 8u) * int(count));
    FW_UNROLL for (uint k = 0u; k < 8u; ++k) {
        ivec2 carried = fieldCarried(means[k], k, memory);
        sum = ivec2(sum.x + int(came[k]) * carried.x, sum.y + int(came[k]) * carried.y);
        count += came[k];
    }
    return ivec2(fieldMean(sum.x, count), fieldMean(sum.y, count));
}

// How many of n die. random: 32 bits.
FW_SHARED_FN uint fieldDeaths(uint n, uint death, uint random) {
    uint most = n < 65535u ? n : 65535u;
    return (most * death + (random & 0xFFFFu)) >> 16u;
}

// How many are emitted into a cell of n particles.
FW_SHARED_FN uint fieldEmission(uint x, uint y, uint n, FieldRules rules, uint random) {
    uint rate = 0u;
    FW_UNROLL for (uint k = 0u; k < kFieldSources; ++k) {
        ivec4 c = rules.sources[k].cells;
        bool within = k < rules.sourceCount && int(x) >= c.x && int(y) >= c.y && int(x) < c.z && int(y) < c.w;
        rate += within ? rules.sources[k].rate : 0u;
    }
    return n < kFieldCellFull ? (rate + (random >> 24u)) >> 8u : 0u;
}

FW_SHARED_END
#endif
