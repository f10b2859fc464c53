// Common ground of shared headers: GLSL 4.50, and C++ through GLM. Structs use vec4, uvec4, uint,
// int and float only, in multiples of 16 bytes; C++ asserts their sizes.
#ifndef FW_SHARED_TYPES_H
#define FW_SHARED_TYPES_H
#ifdef __cplusplus
#if defined(__FAST_MATH__) || defined(_M_FP_FAST) || (__FINITE_MATH_ONLY__ + 0)
#error "Fast-math changes what burns. Remove -ffast-math, -Ofast, -ffinite-math-only or /fp:fast."
#endif
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
namespace fw::gpu {
using uint = std::uint32_t;
using glm::clamp;
using glm::cross;
using glm::dot;
using glm::ivec2;
using glm::ivec3;
using glm::ivec4;
using glm::length;
using glm::max;
using glm::min;
using glm::mix;
using glm::normalize;
using glm::smoothstep;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using std::abs;
using std::cos;
using std::exp;
using std::exp2;
using std::floor;
using std::log2;
using std::pow;
using std::sin;
using std::sqrt;
inline int findMSB(uint x) { return int(std::bit_width(x)) - 1; }
inline void umulExtended(uint a, uint b, uint& high, uint& low) {
    const std::uint64_t product = std::uint64_t(a) * b;
    high = uint(product >> 32);
    low = uint(product);
}
}  // namespace fw::gpu
#define FW_SHARED_BEGIN namespace fw::gpu {
#define FW_SHARED_END }
#define FW_FN inline
#define FW_CONST constexpr
#define FW_IN(T) const T&
#define FW_OUT(T) T&
#define FW_INOUT(T) T&
#define FW_PRECISE
#define FW_UNROLL
#define FW_SIZE(T, bytes) static_assert(sizeof(T) == (bytes));
#else
#define FW_SHARED_BEGIN
#define FW_SHARED_END
#define FW_FN
#define FW_CONST const
#define FW_IN(T) T
#define FW_OUT(T) out T
#define FW_INOUT(T) inout T
#define FW_PRECISE precise
// For loops over small arrays: these become registers only if every index is constant.
#extension GL_EXT_control_flow_attributes : require
#define FW_UNROLL [[unroll]]
#define FW_SIZE(T, bytes)
#endif

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
