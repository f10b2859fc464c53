// Refinement pattern of the reference, in phases with a barrier between: 0 places all pattern
// vertices, one lane each; 1 writes the vertices of each triangle that the host's statuses draw,
// degenerate if consumed.
#include "lib/compute.glsl"
#include "reference/pattern_word.h"
// Per frame, of phase 0: object slot, first of 64 pattern vertices; of phase 1: of 64 listed
// triangles.
#define FW_BUFFER_EXTENSION_GROUPS(access) FW_BUFFER(EXTENSION_GROUPS, access, uvec2, groups)
#define FW_BUFFER_EXTENSION_WORDS(access) FW_BUFFER(EXTENSION_WORDS, access, uint, patternList)
FW_READ(REFINE_OBJECTS) FW_READ(EXTENSION_GROUPS) FW_READ(EXTENSION_WORDS)
FW_READ(REFINE_TRIANGLES) FW_READ(REFINE_SLOTS) FW_READ(VERTICES) FW_READ(PREDICT)
FW_READ(GRADIENT) FW_READ_WRITE(REFINE_VERTICES) FW_WRITE(REFINE_INDICES) FW_PUSH(PatternPush)
#include "lib/refine_arrival.glsl"

void place(uint object, uint s) {
    RefineSlot slot = slots[refined[object].meshSlots + s];
    float behind;
    vertices[refined[object].vertices + s] =
        evaluateSlotNow(object, slot, push.nowTick, push.recede, behind);
}

void name(uint object, uint entry) {
    uint word = patternList[refined[object].items + entry];
    if (word == kPatternEmpty) return;
    RefineTriangle t = triangles[refined[object].meshTriangles + patternCoarse(word)];
    uint depth = refineInteriorDepth(t.flags);
    bool finest = patternHalvings(word) == depth;
    uint drawn[3];
    uint gone = 0u;
    for (uint k = 0u; k < (finest ? 3u : 6u); ++k) {
        uvec2 c = patternPoint(word, depth, k);
        uint vertex = patternDrawVertex(t, c.x, c.y);
        uint slot = meshVertices[(refined[object].meshDraws + vertex) * 3u + 2u].w;
        bool open = vertices[refined[object].vertices + slot].hole <= refined[object].now;
        gone |= open ? 1u << k : 0u;
        if (k < 3u) drawn[k] = vertex;
    }
    bool consumed = isPatternConsumed(gone, finest);
    uint to = refined[object].indices + entry * 3u;
    indices[to] = drawn[0];
    indices[to + 1u] = consumed ? drawn[0] : drawn[1];
    indices[to + 2u] = consumed ? drawn[0] : drawn[2];
}

void main() {
    uvec2 group = groups[push.firstGroup + gl_WorkGroupID.x];
    uint i = group.y + gl_LocalInvocationID.x;
    if (push.phase != 0u) name(group.x, i);
    else if (i < refined[group.x].cornerCount) place(group.x, i);
}
