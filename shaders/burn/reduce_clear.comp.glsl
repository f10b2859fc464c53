// Zeroes the per-object figures that the next passes count anew.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_PUSH
#define FW_USE_OBJECT_COUNTERS FW_READ_WRITE
#include "lib/buffers.glsl"

void main() {
    uint object = gl_GlobalInvocationID.x;
    if (object >= push.count) return;
    objectCounters[object].burning = 0u;
    objectCounters[object].burningTiles = 0u;
    objectCounters[object].frontTiles = 0u;
}
