// Where each triangle's output begins: an exclusive sum of its count, by one workgroup.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 128) in;
#define FW_USE_LEVELS readonly
#define FW_USE_STARTS writeonly
#include "lib/refine_buffers.glsl"

shared uint part[128];

void main() {
    uint lane = gl_LocalInvocationID.x;
    uint each = (frame.triangleCount + 127u) / 128u;
    uint first = min(lane * each, frame.triangleCount);
    uint end = min(first + each, frame.triangleCount);
    uint sum = 0u;
    for (uint i = first; i < end; ++i) sum += refineCount(levels[i]);
    part[lane] = sum;
    barrier();
    for (uint step = 1u; step < 128u; step <<= 1u) {
        uint below = lane >= step ? part[lane - step] : 0u;
        barrier();
        part[lane] += below;
        barrier();
    }
    uint start = part[lane] - sum;
    for (uint i = first; i < end; ++i) {
        starts[i] = start;
        start += refineCount(levels[i]);
    }
    if (lane == 127u) starts[frame.triangleCount] = part[127];
}
