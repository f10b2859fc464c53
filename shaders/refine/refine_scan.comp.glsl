// Output offset of each triangle: an exclusive sum, one workgroup per object whose levels changed.
// Writes draw arguments and lists the output to be emitted. Readbacks report the sums.
#define FW_THREADS 128
#include "lib/refine.glsl"
FW_COHERENT(REFINE_WORK) FW_COHERENT(REFINE_LEVELS) FW_WRITE(REFINE_DRAWS) FW_WRITE(OBJECT_COUNTERS)

shared uint part[128];
shared uint firstJob;

void scan(uint object, uint ordinal) {
    uint lane = gl_LocalInvocationID.x;
    uint count = refined[object].triangleCount;
    uint base = refined[object].triangles;
    uint each = (count + 127u) / 128u;
    uint first = min(lane * each, count);
    uint end = min(first + each, count);
    uint sum = 0u;
    for (uint i = first; i < end; ++i) sum += refineCount(levels[base + i].x);
    part[lane] = sum;
    barrier();
    FW_SUM_UP(part, 0u, lane)
    uint start = part[lane] - sum;
    for (uint i = first; i < end; ++i) {
        levels[base + i].y = start;
        start += refineCount(levels[base + i].x);
    }
    syncBuffers();
    uint total = part[127];
    uint jobs = (total + 63u) / 64u;
    if (lane == 0u) {
        work[objectList() + 2u * ordinal + 1u] = total;
        objectCounters[object].refined = total;
        firstJob = atomicAdd(work[kRefineWorkEmit + 3u], jobs);
        atomicMax(work[kRefineWorkEmit], min(firstJob + jobs, kMaxGroups));
    }
    if (lane < kMaterialsPerObject) {
        uint to = materialEnd(object, lane), from = materialStart(object, lane);
        uint a = from < count ? levels[base + min(from, count - 1u)].y : total;
        uint b = to < count ? levels[base + min(to, count - 1u)].y : total;
        uint at = (object * kMaterialsPerObject + lane) * 5u;
        draws[at] = (b - a) * 3u;
        draws[at + 1u] = 1u;
        draws[at + 2u] = refined[object].indices + a * 3u;
        draws[at + 3u] = refined[object].meshDraws;
        draws[at + 4u] = 0u;
    }
    barrier();
    for (uint k = lane; k < jobs; k += 128u) {
        uint at = push.emitJobs + 2u * (firstJob + k);
        work[at] = object;
        work[at + 1u] = k * 64u;
    }
}

void main() {
    for (uint o = gl_WorkGroupID.x; o < push.objects; o += gl_NumWorkGroups.x) {
        uint object = work[objectList() + 2u * o];
        // A loop: a uniform branch costs a software device the same.
        uint changed = work[objectList() + 2u * o + 1u];
        barrier();
        while (changed != 0u) {
            scan(object, o);
            changed = 0u;
        }
        barrier();
    }
}
