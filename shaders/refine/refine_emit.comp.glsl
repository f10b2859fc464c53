// One lane per output triangle of the objects whose levels changed: finds its coarse triangle,
// looks up the pattern, writes three draw vertices.
#include "lib/refine.glsl"
FW_READ(REFINE_WORK) FW_READ(REFINE_WORDS) FW_READ(REFINE_TRIANGLES) FW_READ(REFINE_LEVELS)
FW_WRITE(REFINE_INDICES)

void main() {
    uint jobs = work[kRefineWorkEmit + 3u];
    for (uint job = gl_WorkGroupID.x; job < jobs; job += gl_NumWorkGroups.x) {
        uint object = work[push.emitJobs + 2u * job];
        uint k = work[push.emitJobs + 2u * job + 1u] + gl_LocalInvocationID.x;
        uint total = work[objectList() + 2u * refined[object].ordinal + 1u];
        bool here = k < total;
        k = min(k, total - 1u);
        uint base = refined[object].triangles;
        uint low = 0u;  // its start <= k < start of high
        uint high = refined[object].triangleCount;
        while (high - low > 1u) {
            uint middle = (low + high) >> 1u;
            bool below = levels[base + middle].y <= k;
            low = below ? middle : low;
            high = below ? high : middle;
        }
        uvec2 packed = levels[base + low];
        RefinePlace place = refineLocate(packed.x, k - packed.y);
        uvec3 codes = refineCodes(packed.x, place, tableToken(place.entry));
        RefineTriangle t = triangles[refined[object].meshTriangles + low];
        uint at = refined[object].indices + k * 3u;
        if (!here) continue;
        indices[at] = refineDrawVertex(t, packed.x, codes.x);
        indices[at + 1u] = refineDrawVertex(t, packed.x, codes.y);
        indices[at + 2u] = refineDrawVertex(t, packed.x, codes.z);
    }
}
