// One step of the published sixteen-tap kernel over a whole object, for comparison. A lane takes
// 8 x 8 texels, row by row with the five rows about it at hand: their taps overlap, and loads are
// what a software device pays for. A group takes 64 x 64.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_PUSH
#define FW_USE_OBJECTS readonly
#define FW_USE_STATE FW_READ_WRITE
#define FW_USE_TILE_STATE FW_READ_WRITE
#define FW_USE_COUNTERS FW_READ_WRITE
#define FW_USE_OBJECT_COUNTERS FW_READ_WRITE
#define FW_USE_BURN_LISTS FW_READ_WRITE
#define FW_USE_PREDICT_LISTS FW_READ_WRITE
#include "lib/buffers.glsl"
#include "shared/front.h"
#include "shared/published.h"
#include "lib/lists.glsl"

// Four texels of a row at once: planes begin at whole tiles, rows are multiples of eight.
layout(std430, set = 0, binding = FW_BIND_PUBLISHED) buffer PublishedRows { vec4 quads[]; };

void light(uint object, int x, int y, uint at) {
    uint end = push.now + kStepTicks;
    state[at] = end;
    atomicAdd(objectCounters[object].ignited, 1u);
    atomicMax(objectCounters[object].lastIgnition, end);
    uint worldTile = objects[object].worldTileBase + uint(y >> 3) * objects[object].tilesX +
                     uint(x >> 3);
    if ((atomicOr(tileState[worldTile].flag, kTileBurning) & kTileBurning) == 0u)
        burnAppend(push.burnParity, worldTile);
    predictTouch(push.predictParity, worldTile);
}

// One row of taps: eight texels and two more on either side.
struct Taps {
    vec2 low;
    vec4 left, right;
    vec2 high;
};
Taps loadRow(int plane, int width, int height, int x, int y) {
    Taps t;
    t.low = vec2(0.0);
    t.left = vec4(0.0);
    t.right = vec4(0.0);
    t.high = vec2(0.0);
    if (y >= 0 && y < height) {
        int at = (plane + y * width + x) / 4;
        t.left = quads[at];
        t.right = quads[at + 1];
        if (x > 0) t.low = quads[at - 1].zw;
        if (x + 8 < width) t.high = quads[at + 2].xy;
    }
    return t;
}
// Weighted sums over a row of taps, for the left and the right four.
struct Sums {
    vec4 left, right;
};
Sums same(Taps t) {
    Sums s;
    s.left = kPublishedNear * (vec4(t.low.y, t.left.xyz) + vec4(t.left.yzw, t.right.x));
    s.right = kPublishedNear * (vec4(t.left.w, t.right.xyz) + vec4(t.right.yzw, t.high.x));
    return s;
}
Sums besideOne(Taps t) {
    Sums s;
    s.left = kPublishedNear * t.left +
             kPublishedDiagonal * (vec4(t.low.y, t.left.xyz) + vec4(t.left.yzw, t.right.x)) +
             kPublishedKnight * (vec4(t.low, t.left.xy) + vec4(t.left.zw, t.right.xy));
    s.right = kPublishedNear * t.right +
              kPublishedDiagonal * (vec4(t.left.w, t.right.xyz) + vec4(t.right.yzw, t.high.x)) +
              kPublishedKnight * (vec4(t.left.zw, t.right.xy) + vec4(t.right.zw, t.high));
    return s;
}
Sums besideTwo(Taps t) {
    Sums s;
    s.left = kPublishedKnight * (vec4(t.low.y, t.left.xyz) + vec4(t.left.yzw, t.right.x));
    s.right = kPublishedKnight * (vec4(t.left.w, t.right.xyz) + vec4(t.right.yzw, t.high.x));
    return s;
}

// Bit i: S of texel i passes one half.
uint crossings(vec4 q, vec4 next, vec4 d) {
    bvec4 over = greaterThanEqual(2.0 * next, d);
    bvec4 under = lessThan(2.0 * q, d);
    uvec4 bits = uvec4(over) * uvec4(under) * uvec4(1u, 2u, 4u, 8u);
    return bits.x | bits.y | bits.z | bits.w;
}

void main() {
    uint object = push.object;
    int width = int(objects[object].width);
    int height = int(objects[object].height);
    int groupsX = (width + 63) / 64;
    int groups = groupsX * ((height + 63) / 64);
    int plane = width * height;
    int base = int(objects[object].publishedBase);
    int from = base + int(push.publishedParity) * plane;
    int to = base + int(push.publishedParity ^ 1u) * plane;
    int spread = base + 2 * plane;
    for (int g = int(gl_WorkGroupID.x); g < groups; g += int(gl_NumWorkGroups.x)) {
        int x = (g % groupsX) * 64 + int(gl_LocalInvocationID.x & 7u) * 8;
        int y = (g / groupsX) * 64 + int(gl_LocalInvocationID.x >> 3u) * 8;
        if (x >= width || y >= height) continue;
        Taps below2 = loadRow(from, width, height, x, y - 2);
        Taps below1 = loadRow(from, width, height, x, y - 1);
        Taps centre = loadRow(from, width, height, x, y);
        Taps above1 = loadRow(from, width, height, x, y + 1);
        uvec2 lit = uvec2(0u);  // 64 texels
        for (int r = 0; r < 8; ++r) {
            Taps above2 = loadRow(from, width, height, x, y + r + 2);
            Sums a = besideTwo(below2);
            Sums b = besideOne(below1);
            Sums c = same(centre);
            Sums d = besideOne(above1);
            Sums e = besideTwo(above2);
            int row = ((y + r) * width + x) / 4;
            vec4 dLeft = quads[spread / 4 + row];
            vec4 dRight = quads[spread / 4 + row + 1];
            vec4 left = min(
                centre.left + dLeft * (a.left + b.left + c.left + d.left + e.left), dLeft);
            vec4 right = min(
                centre.right + dRight * (a.right + b.right + c.right + d.right + e.right), dRight);
            quads[to / 4 + row] = left;
            quads[to / 4 + row + 1] = right;
            uint bits = (crossings(centre.left, left, dLeft) |
                         (crossings(centre.right, right, dRight) << 4u))
                        << (uint(r & 3) * 8u);
            if (r < 4) lit.x |= bits;
            else lit.y |= bits;
            below2 = below1;
            below1 = centre;
            centre = above1;
            above1 = above2;
        }
        while ((lit.x | lit.y) != 0u) {
            int bit = lit.x != 0u ? findLSB(lit.x) : 32 + findLSB(lit.y);
            if (bit < 32) lit.x &= lit.x - 1u;
            else lit.y &= lit.y - 1u;
            int atX = x + (bit & 7);
            int atY = y + (bit >> 3);
            uint stateAt = objects[object].stateBase + uint(atY * width + atX);
            if (isReceptive(state[stateAt])) light(object, atX, atY, stateAt);
        }
    }
}
