// One step of the reference's sixteen-tap kernel over a whole object, for comparison. A lane takes
// a column of eights row by row and keeps the five rows around it, as taps overlap and loads
// dominate on a software device.
#include "lib/compute.glsl"
#include "reference/published.h"
FW_READ(OBJECTS) FW_READ_WRITE(STATE) FW_READ_WRITE(TILE_STATE) FW_READ_WRITE(COUNTERS)
FW_READ_WRITE(OBJECT_COUNTERS) FW_PUSH(StepPush)
#include "lib/burn_budget.glsl"

// Four texels of a row: buffers begin at whole tiles, rows are multiples of eight.
layout(std430, set = 0, binding = FW_BIND_EXTENSION_TILES) buffer PublishedRows { vec4 quads[]; };

// False: the tile may not burn.
bool light(uint object, int x, int y, uint at) {
    uint end = push.now + kStepTicks;
    uint worldTile =
        objects[object].worldTileBase + uint(y >> 3) * objects[object].tilesX + uint(x >> 3);
    if (isRequestPass() && !mayBurn(worldTile)) requestToBurn(worldTile);
    if (isRequestPass() || !mayBurn(worldTile)) return false;
    state[at] = end;
    atomicAdd(objectCounters[object].ignited, 1u);
    nowBurns(object, worldTile, end);
    predictTouch(push.predictParity, worldTile);
    return true;
}

// Tap sums of eight texels of a row.
struct Row {
    vec4 left, right;                // the texels
    vec4 oneLeft, oneRight;          // sums of the two adjacent texels
    vec4 twoLeft, twoRight;          // sums of the two texels at distance 2
};
Row loadRow(int plane, int width, int height, int x, int y) {
    Row row;
    row.left = row.right = vec4(0.0);
    vec2 low = vec2(0.0);
    vec2 high = vec2(0.0);
    if (y >= 0 && y < height) {
        int at = (plane + y * width + x) / 4;
        row.left = quads[at];
        row.right = quads[at + 1];
        if (x > 0) low = quads[at - 1].zw;
        if (x + 8 < width) high = quads[at + 2].xy;
    }
    row.oneLeft = vec4(low.y, row.left.xyz) + vec4(row.left.yzw, row.right.x);
    row.oneRight = vec4(row.left.w, row.right.xyz) + vec4(row.right.yzw, high.x);
    row.twoLeft = vec4(low, row.left.xy) + vec4(row.left.zw, row.right.xy);
    row.twoRight = vec4(row.left.zw, row.right.xy) + vec4(row.right.zw, high);
    return row;
}

// Sign bits: S of a texel crosses one half.
uvec4 crossings(vec4 q, vec4 next, vec4 d) {
    precise vec4 before = q + q - d;
    precise vec4 after = next + next - d;
    return floatBitsToUint(before) & ~floatBitsToUint(after);
}

// Lights the crossed texels of these eight, from the buffers: it is rare, and cached rows would
// cost all other steps.
void lightRow(uint object, int x, int y, int from, int to, int spread) {
    uvec4 left = crossings(quads[from], quads[to], quads[spread]) >> 31u;
    uvec4 right = crossings(quads[from + 1], quads[to + 1], quads[spread + 1]) >> 31u;
    uint bits = left.x | left.y << 1u | left.z << 2u | left.w << 3u | right.x << 4u |
                right.y << 5u | right.z << 6u | right.w << 7u;
    for (; bits != 0u; bits &= bits - 1u) {
        int column = findLSB(bits);
        int atX = x + column;
        uint stateAt = objects[object].stateBase + uint(y) * objects[object].width + uint(atX);
        // A texel that may not burn yet crosses again in the next step.
        if (isReceptive(state[stateAt]) && !light(object, atX, y, stateAt))
            quads[to + column / 4][column % 4] = quads[from + column / 4][column % 4];
    }
}

void runBlock(uint object, int x, int y) {
    int width = int(objects[object].width);
    int height = int(objects[object].height);
    int plane = width * height;
    int base = int(objects[object].extensionBase);
    int from = base + int(push.extensionParity) * plane;
    int to = (base + int(push.extensionParity ^ 1u) * plane) / 4;
    int spread = (base + 2 * plane) / 4;
    Row below2 = loadRow(from, width, height, x, y - 2);
    Row below1 = loadRow(from, width, height, x, y - 1);
    Row centre = loadRow(from, width, height, x, y);
    Row above1 = loadRow(from, width, height, x, y + 1);
    int end = min(y + int(kPublishedBlockY), height);
    uint rows = 0u;  // rows with a crossing; bit 31 is the last
    do {
        Row above2 = loadRow(from, width, height, x, y + 2);
        int at = (y * width + x) / 4;
        vec4 dLeft = quads[spread + at];
        vec4 dRight = quads[spread + at + 1];
        vec4 left =
            publishedNext(centre.left, dLeft, (below1.left + above1.left) + centre.oneLeft,
                          below1.oneLeft + above1.oneLeft,
                          (below1.twoLeft + above1.twoLeft) + (below2.oneLeft + above2.oneLeft));
        vec4 right = publishedNext(
            centre.right, dRight, (below1.right + above1.right) + centre.oneRight,
            below1.oneRight + above1.oneRight,
            (below1.twoRight + above1.twoRight) + (below2.oneRight + above2.oneRight));
        quads[to + at] = left;
        quads[to + at + 1] = right;
        uvec4 pass = crossings(centre.left, left, dLeft) | crossings(centre.right, right, dRight);
        rows = rows >> 1u | ((pass.x | pass.y | pass.z | pass.w) & 0x80000000u);
        below2 = below1;
        below1 = centre;
        centre = above1;
        above1 = above2;
    } while (++y < end);
    while (rows != 0u) {
        int bit = findMSB(rows);
        rows ^= 1u << uint(bit);
        int passY = end - 32 + bit;
        int at = (passY * width + x) / 4;
        lightRow(object, x, passY, from / 4 + at, to + at, spread + at);
    }
}

void runColumn(uint i) {
    uint columns = objects[push.object].width / kPublishedBlockX;
    uint blockY = divide(i, columns);
    runBlock(push.object, int((i - blockY * columns) * kPublishedBlockX),
             int(blockY * kPublishedBlockY));
}

void main() {
    uint columns = objects[push.object].width / kPublishedBlockX;
    uint rows = (objects[push.object].height + kPublishedBlockY - 1u) / kPublishedBlockY;
    FW_STRIDE(columns * rows, runColumn)
}
