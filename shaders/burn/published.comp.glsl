// One step of the published sixteen-tap kernel over a whole object, for comparison. A lane takes
// four texels of a column (its taps overlap), a group 16 x 16; groups run over push.object alone.
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
#define FW_USE_PUBLISHED FW_READ_WRITE
#include "lib/buffers.glsl"
#include "shared/front.h"
#include "shared/published.h"
#include "lib/lists.glsl"

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

void main() {
    uint object = push.object;
    int width = int(objects[object].width);
    int height = int(objects[object].height);
    int groupsX = (width + 15) / 16;
    int groups = groupsX * ((height + 15) / 16);
    int plane = width * height;
    int base = int(objects[object].publishedBase);
    int from = base + int(push.publishedParity) * plane;
    int to = base + int(push.publishedParity ^ 1u) * plane;
    for (int g = int(gl_WorkGroupID.x); g < groups; g += int(gl_NumWorkGroups.x)) {
        int x = (g % groupsX) * 16 + int(gl_LocalInvocationID.x & 15u);
        int y = (g / groupsX) * 16 + int(gl_LocalInvocationID.x >> 4u) * 4;
        if (x >= width || y >= height) continue;
        // Columns x-2 .. x+2, rows y-2 .. y+5; only the taps that are used.
        float c[5][8];
        for (int i = 0; i < 5; ++i) {
            int cx = x + i - 2;
            for (int j = 0; j < 8; ++j) {
                int cy = y + j - 2;
                bool wide = i == 0 || i == 4 || i == 2;
                bool skip = wide && (j == 0 || j == 7);
                c[i][j] = skip || cx < 0 || cx >= width || cy < 0 || cy >= height
                              ? 0.0
                              : published[from + cy * width + cx];
            }
        }
        for (int r = 0; r < 4; ++r) {
            if (y + r >= height) break;
            int j = r + 2;
            int texel = (y + r) * width + x;
            float q = c[2][j];
            float d = published[base + 2 * plane + texel];
            float next = q;
            if (q < d) {
                float sum = publishedSum(
                    c[1][j] + c[3][j] + c[2][j - 1] + c[2][j + 1],
                    c[1][j - 1] + c[3][j - 1] + c[1][j + 1] + c[3][j + 1],
                    c[0][j - 1] + c[0][j + 1] + c[4][j - 1] + c[4][j + 1] + c[1][j - 2] +
                        c[3][j - 2] + c[1][j + 2] + c[3][j + 2]);
                next = publishedNext(q, d, sum);
                if (2.0 * next >= d && 2.0 * q < d) {
                    uint at = objects[object].stateBase + uint(texel);
                    if (isReceptive(state[at])) light(object, x, y + r, at);
                }
            }
            published[to + texel] = next;
        }
    }
}
