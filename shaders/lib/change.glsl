// Effects of a texel's change outside the front kernel: dependent tiles become due, counters and
// lists are updated. For events, contacts and embers.
#include "lib/extension_change.glsl"
#include "lib/predict_list.glsl"
#include "lib/touch.glsl"

struct TexelPlace {
    uint local, lane, worldTile;
};
TexelPlace placeOfTexel(uint object, uint texel) {
    uint width = objects[object].width;
    uint x = texel % width;
    uint y = texel / width;
    TexelPlace p;
    p.local = (y >> 3u) * objects[object].tilesX + (x >> 3u);
    p.lane = (y & 7u) * 8u + (x & 7u);
    p.worldTile = objects[object].worldTileBase + p.local;
    return p;
}

// Row of the object's materials that a texel uses.
uint materialOfTexel(uint object, uint texel) {
    return object * kMaterialsPerObject +
           ((texels[objects[object].texelBase + texel].y >> 16u) & 7u);
}
void litFrom(uint object, uint by) {
    if (objectCounters[object].litTick == 0u) atomicMax(objectCounters[object].litBy, by);
}

// burns: the texel is a source now.
void texelChanged(uint object, uint texel, TexelPlace p, bool burns) {
    predictTouch(push.predictParity, p.worldTile);
    if ((objects[object].flags & kObjectExtended) != 0u) {
        extensionChanged(object, texel, burns);
        return;
    }
    tileState[p.worldTile].lastChange = push.now;
    touchDependents(object, p.local, laneMask(p.lane));
}
