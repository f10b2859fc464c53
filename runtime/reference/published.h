// The burning-state kernel of the reference (sixteen taps on a buffer S in [0, 1]), for comparison:
// its speed depends on texel size and time step. Floats, but equal on all devices: nothing
// contracts and nothing is flushed. Never authoritative.
#ifndef FW_REFERENCE_PUBLISHED_H
#define FW_REFERENCE_PUBLISHED_H
#include "shared/front.h"

#ifdef __cplusplus
#define FW_TAPS float
#else
#define FW_TAPS vec4
#endif

FW_SHARED_BEGIN

// S' = min(1, S + sum W S D) over the eight neighbours and eight knight's moves. W falls with the
// inverse distance, sum W = 1. D = rate * C * (1 + gravity * N.G) of the tap's texel. Buffers hold
// S * D, so that a tap is one load.
FW_CONST float kPublishedNear = 0.09609710f;      // distance 1
FW_CONST float kPublishedDiagonal = 0.06795091f;  // sqrt 2
FW_CONST float kPublishedKnight = 0.04297593f;    // sqrt 5
FW_CONST float kPublishedRate = 0.3f;             // C_D, 1/s
FW_CONST float kPublishedGravity = 0.1f;          // C_G
FW_CONST float kPublishedUnit = 4.4703484e-10f;   // C_D / 32 * C_G / 2^21
// Smaller values are set to 0. Far above the smallest normal float, and too small to affect a
// front's speed: the front's tail has shrunk by e^69 there.
FW_CONST float minKPublished = 1e-30f;

// Texels of a lane: a column of eights.
FW_CONST uint kPublishedBlockX = 8u;
FW_CONST uint kPublishedBlockY = 16u;

// D of a texel for one step. slow: Q7 slowness, not 0; fall: N.G, 1 = faces down, Q12. An integer
// quotient of at most 24 bits, scaled once.
FW_FN float publishedSpread(uint slow, int fall) {
    uint upright = uint(40960 + fall);  // Q12 / C_G
    uint n = slow < 256u ? divide(upright << 8u, slow) << 8u : divide(upright << 16u, slow);
    return float(n) * kPublishedUnit;
}

// Next S * D from the last, D, and the sums of the three kinds of taps.
FW_FN FW_TAPS publishedNext(FW_TAPS q, FW_TAPS d, FW_TAPS nearTaps, FW_TAPS diagonalTaps,
                            FW_TAPS knightTaps) {
    FW_PRECISE FW_TAPS sum = kPublishedNear * nearTaps + kPublishedDiagonal * diagonalTaps +
                             kPublishedKnight * knightTaps;
    FW_PRECISE FW_TAPS next = q + d * sum;
#ifdef __cplusplus
    next = next < d ? next : d;
    return next < minKPublished ? 0.0f : next;
#else
    next = min(next, d);
    return mix(next, vec4(0.0), lessThan(next, vec4(minKPublished)));
#endif
}

FW_SHARED_END
#endif
