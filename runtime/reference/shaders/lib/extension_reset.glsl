// A texel of the published kernel: S * D, twice, and D.
#include "reference/published.h"
FW_BUFFER(EXTENSION_TILES, writeonly, float, published)
FW_READ(NORMALS)

void extensionReset(uint object, uint texel, uint material, uint slow, bool burns) {
    uint plane = objects[object].width * objects[object].height;
    uint base = objects[object].extensionBase + texel;
    ivec3 n = decodeNormal(normals[objects[object].texelBase + texel]);
    uvec4 up = materials[material].upCeiling;
    int rise = dotInt(n, ivec3(int(up.x), int(up.y), int(up.z)));  // Q24
    published[base] = 0.0;
    published[base + plane] = 0.0;
    published[base + 2u * plane] = burns ? publishedSpread(slow, -rise >> 12) : 0.0;
}
