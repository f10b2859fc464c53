// Orders the flame quads of a view, farthest first. One group, a bitonic sort in shared memory.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 128) in;
#include "shared/burn.h"
#include "shared/look.h"
layout(std430, set = 0, binding = FW_BIND_FLAMES) readonly buffer FlamesBuffer {
    FlameQuad flameQuad[];
};
layout(std430, set = 0, binding = FW_BIND_DRAW_ARGS) buffer ArgsBuffer { uint drawArgs[]; };
layout(set = 0, binding = FW_BIND_VIEW, std140) uniform View { ViewParams view; };

shared uint keys[kFlameCapacity];

void main() {
    uint me = gl_LocalInvocationID.x;
    uint count = min(drawArgs[1], min(view.flameCapacity, kFlameCapacity));
    uint size = 2u;
    while (size < count) size <<= 1u;
    for (uint i = me; i < size; i += 128u) {
        uint key = 0xFFFFFFFFu;
        if (i < count) {
            vec3 d = flameQuad[i].baseHeight.xyz +
                     flameQuad[i].axisWidth.xyz * (0.5 * flameQuad[i].baseHeight.w) - view.eye.xyz;
            float depth = clamp(dot(d, view.forward.xyz), 0.0, 1e6);
            // 12 mantissa bits are 1 part in 4000; positive floats sort as their bits do.
            key = (0xFFFFFu - (floatBitsToUint(depth) >> 11u & 0xFFFFFu)) << 12u | i;
        }
        keys[i] = key;
    }
    barrier();
    for (uint block = 2u; block <= size; block <<= 1u) {
        for (uint step = block >> 1u; step > 0u; step >>= 1u) {
            for (uint k = me; k < size / 2u; k += 128u) {
                uint i = 2u * k - (k & (step - 1u)), j = i + step;
                uint low = keys[i], high = keys[j];
                bool ascending = (i & block) == 0u;
                if ((low > high) == ascending) {
                    keys[i] = high;
                    keys[j] = low;
                }
            }
            barrier();
        }
    }
    for (uint i = me; i < count; i += 128u) drawArgs[kFlameOrder + i] = keys[i] & 0xFFFu;
    barrier();
    if (me == 0u) drawArgs[1] = count;
}
