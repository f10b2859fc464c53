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
