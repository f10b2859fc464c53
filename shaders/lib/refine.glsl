// Objects and work lists of the refinement passes. One list entry is one workgroup's share.
#include "lib/compute.glsl"
#include "shared/refine.h"
FW_READ(REFINE_OBJECTS) FW_PUSH(RefinePush)

uint edgeList() { return kRefineWorkLists; }
uint triangleList() { return edgeList() + 2u * push.edgeGroups; }
uint cornerList() { return triangleList() + 2u * push.triangleGroups; }
uint morphJobs() { return push.placeJobs + ((push.cutJobs - push.placeJobs) >> 1u); }
uint edgeJobs() { return push.cutJobs + ((push.cutJobs - push.placeJobs) >> 1u); }
uint objectList() { return cornerList() + 2u * push.cornerGroups; }
// Per object of the list: cut triangles of each material, then the first that exceeds the capacity.
uint cutCounts(uint ordinal) { return objectList() + 2u * push.objects + 16u * ordinal; }
// Appends (object, number) to a list that the device writes. header: its dispatch in the work
// buffer, perGroup jobs a workgroup. Needs `work`.
#define FW_ADD_JOB(header, list, perGroup, object, number)                              \
    {                                                                                   \
        uint job = atomicAdd(work[(header) + 3u], 1u);                                  \
        atomicMax(work[header], min(job / (perGroup) + 1u, kMaxGroups));                \
        work[(list) + 2u * job] = object;                                               \
        work[(list) + 2u * job + 1u] = number;                                          \
    }
// Triangles up to the end of material m, and before it.
uint materialEnd(uint object, uint m) {
    uvec4 low = refined[object].materialEnd0;
    uvec4 high = refined[object].materialEnd1;
    return m < 4u ? low[m & 3u] : high[m & 3u];
}
uint materialStart(uint object, uint m) {
    uint start = materialEnd(object, max(m, 1u) - 1u);
    return m == 0u ? 0u : start;
}
