#include "lib/lists.glsl"

// Appends a gathered row and its rim texels (bits) to the scratch lists counted in `row`.
void gatherItem(uint row, uvec4 gathered, uint rim) {
    uint item = atomicAdd(counters[row].workCount, 1u);
    FW_COVER(row, work, item, 64u)
    scratchQuads[item] = gathered;
    if (rim == 0u) return;
    uint count = uint(bitCount(rim));
    uint first = atomicAdd(counters[row].rimCount, count);
    atomicMax(counters[row].rimX, min((first + count - 1u) / 64u + 1u, kMaxGroups));
    counters[row].rimY = counters[row].rimZ = 1u;
    do {
        scratch[rimItem(first)] = item * 8u + uint(findLSB(rim));
        ++first;
        rim &= rim - 1u;
    } while (rim != 0u);
}
