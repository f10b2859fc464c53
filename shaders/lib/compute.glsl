// Start of a compute pass: threads of a group, buffers, push constants and loops.
#include "lib/buffers.glsl"
#include "shared/exchange.h"
#ifndef FW_THREADS
#define FW_THREADS 64
#endif
layout(local_size_x = FW_THREADS) in;
#define FW_PUSH(type) layout(push_constant) uniform PushBlock { type push; };

// A group's barrier, behind which all its threads see what each wrote into coherent buffers.
void syncBuffers() {
    memoryBarrierBuffer();
    barrier();
}
// Inclusive sums of FW_THREADS words in shared memory, from sums[first] on, one per thread.
#define FW_SUM_UP(sums, first, thread)                                           \
    for (uint reach = 1u; reach < FW_THREADS; reach <<= 1u) {                    \
        uint below = thread >= reach ? sums[(first) + thread - reach] : 0u;      \
        barrier();                                                               \
        sums[(first) + thread] += below;                                         \
        barrier();                                                               \
    }

const uint kMaxGroups = 65535u;  // of an indirect dispatch; passes stride over the rest

// Runs a function for every item of a list, a dispatch apart per thread. Tests at the end: a
// software device runs a loop's body once more with no active lane otherwise.
#define FW_STRIDE(number, function)                  \
    uint strideCount = number;                       \
    uint strideItem = gl_GlobalInvocationID.x;       \
    if (strideItem >= strideCount) return;           \
    do {                                             \
        function(strideItem);                        \
        strideItem += gl_NumWorkGroups.x * 64u;      \
    } while (strideItem < strideCount);

// The same for tiles of a list, eight per group: function(slot, row), one thread per row of eight
// texels.
#define FW_STRIDE_ROWS(number, function)                                                  \
    uint strideCount = number;                                                            \
    uint strideRow = gl_LocalInvocationID.x & 7u;                                         \
    uint strideSlot = gl_WorkGroupID.x * 8u + (gl_LocalInvocationID.x >> 3u);             \
    if (strideSlot >= strideCount) return;                                                \
    do {                                                                                  \
        function(strideSlot, strideRow);                                                  \
        strideSlot += gl_NumWorkGroups.x * 8u;                                            \
    } while (strideSlot < strideCount);
