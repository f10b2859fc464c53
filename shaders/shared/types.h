// One language for shared headers: GLSL 4.50, and C++ through GLM. Structs use vec4, uvec4, uint,
// int and float only, in multiples of 16 bytes; their sizes are asserted in C++.
#ifndef FW_SHARED_TYPES_H
#define FW_SHARED_TYPES_H
#ifdef __cplusplus
#include <cstdint>
#include <glm/glm.hpp>
namespace fw::gpu {
using uint = std::uint32_t;
using glm::ivec2;
using glm::ivec3;
using glm::ivec4;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
inline void umulExtended(uint a, uint b, uint& high, uint& low) {
    const std::uint64_t product = std::uint64_t(a) * b;
    high = uint(product >> 32);
    low = uint(product);
}
}  // namespace fw::gpu
#define FW_SHARED_BEGIN namespace fw::gpu {
#define FW_SHARED_END }
#define FW_SHARED_FN inline
#define FW_SHARED_CONST constexpr
#define FW_OUT(T) T&
#define FW_UNROLL
#define FW_SHARED_SIZE(T, bytes) static_assert(sizeof(T) == (bytes));
#else
#define FW_SHARED_BEGIN
#define FW_SHARED_END
#define FW_SHARED_FN
#define FW_SHARED_CONST const
#define FW_OUT(T) out T
// Of loops over small arrays: these become registers only if every index is a constant.
#extension GL_EXT_control_flow_attributes : require
#define FW_UNROLL [[unroll]]
#define FW_SHARED_SIZE(T, bytes)
#endif
#endif
