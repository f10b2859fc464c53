// Applies a step's texel events, 64 per group: a texel's run of events by the thread of its first,
// in order. FW_ALL_TEXELS: runs that address all texels of an object, one thread per texel. The
// front kernel reacts in the same step.
#include "lib/compute.glsl"
FW_READ(OBJECTS) FW_READ(EVENTS) FW_READ(TEXELS) FW_READ_WRITE(STATE) FW_READ_WRITE(TILE_STATE)
FW_READ_WRITE(COUNTERS) FW_READ_WRITE(OBJECT_COUNTERS) FW_READ_WRITE(HEAT)
FW_PUSH(StepPush)
#include "lib/hot_list.glsl"
#include "lib/burn_budget.glsl"
#include "lib/heat_material.glsl"
#include "lib/tile.glsl"
#include "lib/change.glsl"

void writeState(uint object, uint texel, uint worldTile, uint before, uint now) {
    state[objects[object].stateBase + texel] = now;
    if (isSource(now) != isSource(before))
        atomicAdd(objectCounters[object].ignited, isSource(now) ? 1u : 0xFFFFFFFFu);
    if (isSource(now)) nowBurns(object, worldTile, push.now + kStepTicks);
}

#define FW_PASS_EVENTS
#include "shared/event_pass.h"

#ifdef FW_ALL_TEXELS
// Tiles by group, one event per row; push.object: the event of the first row.
void main() {
    uint i = push.object + gl_WorkGroupID.y;
    if (i >= push.count || !addressesAll(i)) return;
    uint object = events[i].object;
    if (i > 0u && addressesAll(i - 1u) && events[i - 1u].object == object) return;
    for (uint tile = gl_WorkGroupID.x; tile < objects[object].tileCount;
         tile += gl_NumWorkGroups.x) {
        uint texel = texelOf(object, tile, gl_LocalInvocationID.x);
        uint flags = texels[objects[object].texelBase + texel].y >> 16u;
        if ((flags & kTexelReal) != 0u) applyRun(i, texel);
    }
}
#else
void main() {
    if (gl_GlobalInvocationID.x < push.count) applyOne(gl_GlobalInvocationID.x);
}
#endif
