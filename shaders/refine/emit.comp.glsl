// One lane per output triangle: finds its coarse triangle, looks its pattern's triangle up, writes
// three draw vertices.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_TABLE readonly
#define FW_USE_TRIANGLES readonly
#define FW_USE_LEVELS readonly
#define FW_USE_STARTS readonly
#define FW_USE_INDICES writeonly
#include "lib/refine_buffers.glsl"

void main() {
    uint count = min(starts[frame.triangleCount], frame.capacity);
    for (uint k = gl_GlobalInvocationID.x; k < count; k += gl_NumWorkGroups.x * 64u) {
        uint low = 0u;  // starts[low] <= k < starts[high]
        uint high = frame.triangleCount;
        while (high - low > 1u) {
            uint middle = (low + high) >> 1u;
            if (starts[middle] <= k) low = middle;
            else high = middle;
        }
        uint packed = levels[low];
        RefinePlace place = refineLocate(packed, k - starts[low]);
        uvec3 codes = refineCodes(packed, place, tableToken(place.entry));
        RefineTriangle t = triangles[low];
        indices[k * 3u] = refineDrawVertex(t, packed, codes.x);
        indices[k * 3u + 1u] = refineDrawVertex(t, packed, codes.y);
        indices[k * 3u + 2u] = refineDrawVertex(t, packed, codes.z);
    }
}
