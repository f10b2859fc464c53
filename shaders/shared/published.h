// The burning-state kernel as published (sixteen taps on a plane S in [0, 1]), for comparison with
// the product front: its speed depends on texel size and time step. Floats; never authoritative.
#ifndef FW_SHARED_PUBLISHED_H
#define FW_SHARED_PUBLISHED_H
#include "shared/types.h"

FW_SHARED_BEGIN

// S' = min(1, S + sum W S D) over the eight neighbours and eight knight's moves, W falling with the
// inverse distance, sum W = 1. D = rate * C * (1 + gravity * N.G) of the tap's own texel. Planes
// hold S * D, so that a tap is one load.
FW_SHARED_CONST float kPublishedNear = 0.09609710f;      // distance 1
FW_SHARED_CONST float kPublishedDiagonal = 0.06795091f;  // sqrt 2
FW_SHARED_CONST float kPublishedKnight = 0.04297593f;    // sqrt 5
FW_SHARED_CONST float kPublishedRate = 0.3f;             // C_D, 1/s
FW_SHARED_CONST float kPublishedGravity = 0.1f;          // C_G

// D of a texel. slow: Q7 slowness, not 0; fall: N.G, 1 = faces down.
FW_SHARED_FN float publishedSpread(float rate, float gravity, uint slow, float fall) {
    return rate * (128.0f / float(slow)) * (1.0f + gravity * fall);
}

FW_SHARED_FN float publishedSum(float nearTaps, float diagonalTaps, float knightTaps) {
    return kPublishedNear * nearTaps + kPublishedDiagonal * diagonalTaps +
           kPublishedKnight * knightTaps;
}

// New S * D from the old one, D and the weighted sum.
FW_SHARED_FN float publishedNext(float q, float d, float sum) {
    float next = q + d * sum;
    return next < d ? next : d;
}

FW_SHARED_END
#endif
