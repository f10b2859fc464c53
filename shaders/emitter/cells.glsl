// The hash grid of burning cells: two sizes of cell per object, keyed by place. Slots depend on who
// came first, contents do not.
layout(std430, set = 0, binding = FW_BIND_LIGHT_CELLS) buffer CellsBuffer { uint cells[]; };

float tileSide(uint object) { return 8.0 * sqrt(max(objects[object].tint.w, 1e-8)); }
// Side of the cells that lights are made of, m: fixed per object, so that nothing pops.
float lightCellSide(uint object) {
    return clamp(exp2(floor(log2(2.5 * tileSide(object)) + 0.5)), 0.125, 2.0);
}
// Side of the cells whose power says how tall flames are.
float flameCellSide(uint object) { return clamp(4.0 * lightCellSide(object), 0.5, 4.0); }

// Where a tile counts: above the surface, as flames are. The small cells make lights, which stand
// further off.
vec3 lightPlaceOf(BurnTile tile, float side) {
    return tile.positionArea.xyz + tile.normalPower.xyz * (0.35 * side) +
           view.up.xyz * (0.15 * side);
}
vec3 flamePlaceOf(BurnTile tile, float side) {
    return tile.positionArea.xyz + tile.normalPower.xyz * (0.3 * tileSide(tile.object)) +
           view.up.xyz * (0.1 * side);
}
// Wood flames for as long as it lasts, but most of it comes off near the front.
float flameFade(BurnTile tile) {
    BurnMaterial material = materials[tile.object * kMaterialsPerObject];
    float lasting = max(6.0 * looks[material.look].charTime, 8.0);
    return 0.12 + 0.88 * exp(-float(tile.age) * (1.0 / 4096.0) * material.timeScale / lasting);
}

uint mixBits(uint x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ (x >> 16);
}
float unit(uint x) { return float(mixBits(x) >> 8) * (1.0 / 16777216.0); }

uint cellKey(ivec3 cell, float side) {
    uint h = mixBits(uint(cell.x) * 73856093u ^ floatBitsToUint(side));
    h = mixBits(h ^ uint(cell.y) * 19349663u);
    return max(mixBits(h ^ uint(cell.z) * 83492791u), 1u);
}
uint cellWord(uint slot, uint word) { return kLightCellHeader + slot * kLightCellWords + word; }

const uint kCellProbes = 24u;
const uint kNoCell = 0xFFFFFFFFu;
uint findCell(uint key) {
    for (uint i = 0u; i < kCellProbes; ++i) {
        uint slot = (key + i) % kLightCells;
        uint there = cells[cellWord(slot, 0u)];
        if (there == key) return slot;
        if (there == 0u) return kNoCell;
    }
    return kNoCell;
}

// m: Heskestad's height for what burns in a cell, kept sane for thin and for wide fires.
float flameLength(float watts, float area, float tile) {
    float diameter = sqrt(area * 1.273);
    return max(0.235 * pow(max(watts, 1.0) * 1e-3, 0.4) - 0.6 * diameter,
               max(0.35 * diameter, max(1.6 * tile, 0.05)));
}
// Quads that a tile of this burning area is worth; old embers have none, or they show as dots.
float flameQuads(float area, float len, float fade) {
    float halfWidth = 0.27 * len;
    return 5.0 * smoothstep(0.15, 0.45, fade) * area * fade / (4.0 * halfWidth * halfWidth);
}
