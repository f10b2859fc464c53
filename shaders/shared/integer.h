// A hash and an exact division, for C++ and GLSL. GLSL too, and laid out by hand.
// clang-format off
#ifndef FW_SHARED_INTEGER_H
#define FW_SHARED_INTEGER_H
#include "shared/types.h"

FW_SHARED_BEGIN

FW_FN uint hash32(uint x) {
    x ^= x >> 16u;
    x *= 0x7feb352du;
    x ^= x >> 15u;
    x *= 0x846ca68bu;
    return x ^ (x >> 16u);
}

// Hash of x in [0, 1).
FW_FN float hashUnit(uint x) { return float(hash32(x) >> 8) * (1.0f / 16777216.0f); }
FW_FN float saturate(float x) { return clamp(x, 0.0f, 1.0f); }

// n / d, exact, d > 0. Software devices lack integer division: floats estimate from below (short by
// 2 millionths and one, at most), integers correct.
FW_FN uint divide(uint n, uint d) {
#ifdef __cplusplus
    return n / d;
#else
    float inverse = 0.999999 / float(d);
    uint q = uint(float(n) * inverse);
    uint r = n - q * d;
    uint more = uint(float(r) * inverse);
    q += more;
    r -= more * d;
    if (r >= d) {
        q += 1u;
        r -= d;
    }
    return r >= d ? q + 1u : q;
#endif
}

FW_SHARED_END
#endif
