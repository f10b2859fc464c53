// The burning-state kernel as published (sixteen taps on a plane S in [0, 1]), for comparison with
// the product front: its speed depends on texel size and time step. Floats, but the same on every
// device: nothing contracts, nothing gets small enough to be flushed. Never authoritative.
#ifndef FW_SHARED_PUBLISHED_H
#define FW_SHARED_PUBLISHED_H
#include "shared/front.h"

#ifdef __cplusplus
#define FW_PRECISE
#define FW_TAPS float
#else
#define FW_PRECISE precise
#define FW_TAPS vec4
#endif

FW_SHARED_BEGIN

// S' = min(1, S + sum W S D) over the eight neighbours and eight knight's moves, W falling with the
// inverse distance, sum W = 1. D = rate * C * (1 + gravity * N.G) of the tap's own texel. Planes
// hold S * D, so that a tap is one load.
FW_SHARED_CONST float kPublishedNear = 0.09609710f;      // distance 1
FW_SHARED_CONST float kPublishedDiagonal = 0.06795091f;  // sqrt 2
FW_SHARED_CONST float kPublishedKnight = 0.04297593f;    // sqrt 5
FW_SHARED_CONST float kPublishedRate = 0.3f;             // C_D, 1/s
FW_SHARED_CONST float kPublishedGravity = 0.1f;          // C_G
FW_SHARED_CONST float kPublishedUnit = 4.4703484e-10f;   // C_D / 32 * C_G / 2^21
// Less is none. Far above the smallest normal float, and far below what a front's speed feels: the
// tail that a front grows from has shrunk e^69 times by then.
FW_SHARED_CONST float kPublishedLeast = 1e-30f;

// The texels that a lane of the pass takes: a column of eights.
FW_SHARED_CONST uint kPublishedBlockX = 8u;
FW_SHARED_CONST uint kPublishedBlockY = 16u;

// D of a texel for one step. slow: Q7 slowness, not 0; fall: N.G, 1 = faces down, Q12. An integer
// quotient of at most 24 bits, scaled once.
FW_SHARED_FN float publishedSpread(uint slow, int fall) {
    uint upright = uint(40960 + fall);  // Q12 / C_G
    uint n = slow < 256u ? divide(upright << 8u, slow) << 8u : divide(upright << 16u, slow);
    return float(n) * kPublishedUnit;
}

// New S * D from the old one, D, and the sums of the three kinds of taps.
FW_SHARED_FN FW_TAPS publishedNext(FW_TAPS q, FW_TAPS d, FW_TAPS nearTaps, FW_TAPS diagonalTaps,
                                   FW_TAPS knightTaps) {
    FW_PRECISE FW_TAPS sum = kPublishedNear * nearTaps + kPublishedDiagonal * diagonalTaps +
                             kPublishedKnight * knightTaps;
    FW_PRECISE FW_TAPS next = q + d * sum;
#ifdef __cplusplus
    next = next < d ? next : d;
    return next < kPublishedLeast ? 0.0f : next;
#else
    next = min(next, d);
    return mix(next, vec4(0.0), lessThan(next, vec4(kPublishedLeast)));
#endif
}

FW_SHARED_END
#endif
