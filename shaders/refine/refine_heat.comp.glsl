// Heats the edges and interiors near the tiles of the front (lit soon, or moving) or of the burn
// list, ahead of the fire. One lane per tile. For fresh objects all burnt tiles are heated once,
// one workgroup per object, so their holes are there in the first frame.
#include "lib/refine.glsl"
FW_READ(TILE_STATE) FW_READ(COUNTERS) FW_READ(FRONT_LISTS) FW_READ(BURN_LISTS) FW_READ(REFINE_WORK)
FW_READ(REFINE_WORDS) FW_READ(PREDICT) FW_READ(GRADIENT) FW_READ_WRITE(REFINE_HEAT)
#include "lib/object_quads.glsl"

uint entry(uint i) {
    uint at = 2u * i + (push.parity & 1u);
    return push.parity < 2u ? frontLists[at] : burnLists[at];
}

void warm(uint object, uint local, uint bits) {
    uint base = refined[object].meshWords;
    uint list = base + refined[object].tileCount + 1u;
    uint first = refined[object].items;
    uint end = words[base + local + 1u];
    for (uint at = words[base + local]; at < end; ++at)
        atomicOr(heat[first + words[list + at]], bits);
}

bool burnt(uint object, uint local) {
    uint width = refined[object].textureWidth, across = width >> 3u;
    uint base = refined[object].stateBase + local / across * 8u * width + local % across * 8u;
    uint lit = 0u;
    for (uint k = 0u; k < 64u; ++k) {
        uint t = predict[base + (k >> 3u) * width + (k & 7u)];
        bool live = t < kLiveEnd && int(push.nowTick - t) >= 0;
        lit |= live || t == kOut || t == kOutWet ? 1u : 0u;
    }
    return lit != 0u;
}

void warmFresh() {
    for (uint g = gl_WorkGroupID.x; g < push.objects; g += gl_NumWorkGroups.x) {
        uint object = work[objectList() + 2u * g];
        uint first = objectPlaces(object).x;
        bool fresh = (refined[object].flags & kRefineIsFresh) != 0u;
        uint tiles = fresh ? refined[object].tileCount : 0u;
        for (uint local = gl_LocalInvocationID.x; local < tiles; local += 64u) {
            uint shows = tileState[first + local].flag & kTileMarked;
            while (shows != 0u) {
                if (burnt(object, local)) warm(object, local, kRefineHot);
                shows = 0u;
            }
        }
    }
}

void main() {
    if (push.parity == kRefineFreshHeat) {
        warmFresh();
        return;
    }
    uint count = counters[push.row].listCount;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * 64u) {
        uint tile = entry(i);
        uint object = tileState[tile].object;
        uint local = tile - objectPlaces(object).x;
        bool known = object < push.objectEnd;
        object = known ? object : 0u;
        known = known && (refined[object].flags & kRefineIsActive) != 0u &&
                local < refined[object].tileCount;
        bool burns = push.parity >= 2u || (tileState[tile].flag & kTileBurning) != 0u;
        uint bits = kRefineHot | (burns ? kRefineBurning : 0u);
        while (known) {
            warm(object, local, bits);
            known = false;
        }
    }
}
