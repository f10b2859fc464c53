// Burning tiles into the cells of their object's body. All sums are of integers: the order of
// threads does not matter. What a texel adds follows from its age, so it grows and fades with every
// frame, not with the steps of the simulation.
//
// Words of a cell: 0 weight; 1..3 place, 4..6 normal (Q7), both times weight; 7 area that flames,
// 1e-6 m^2; 8 W, times 16; 9 that area, each texel by its strength.
#include "lib/compute.glsl"
#include "lib/view.glsl"
#include "shared/body.h"
FW_READ(OBJECTS) FW_READ(MATERIALS) FW_READ(TEXELS) FW_READ(NORMALS) FW_READ(STATE)
FW_READ(COUNTERS) FW_READ(TILE_STATE) FW_READ(BURN_TILES) FW_READ(APPEARANCES)
FW_READ(BODIES) FW_READ(BODY_OF) FW_READ(FLAME_CELLS) FW_READ_WRITE(BODY_CELLS) FW_PUSH(StepPush)
#include "emitter/flame_laws.glsl"
#include "lib/tile.glsl"
#include "lib/skin.glsl"

// Ticks from a texel's ignition until its flame shows, and is whole, but no more than these shares of
// its duration. Tiles are listed late by up to the first.
const float kShows = 512.0, kWhole = 1400.0, kShowsOf = 0.1, kWholeOf = 0.4;

void addTile(uint i) {
    BurnTile tile = burnTiles[i];
    uint number = bodyOf[tile.object];
    if (!burnTileAlive(tile.object, tile.tile)) return;
    BurnObject object = objects[tile.object];
    uint worldTile = object.worldTileBase + tile.tile;
    if (number == 0u || (tileState[worldTile].flag & kTileFalling) != 0u) return;
    FlameBody body = bodies[number - 1u];
    uint corner = texelOf(tile.object, tile.tile, 0u), anchor = corner;
    vec3 place = vec3(0.0), normal = vec3(0.0);
    float fire = 0.0, count = 0.0, watts = 0.0, fresh = 0.0, most = 0.0;
    for (uint lane = 0u; lane < 64u; ++lane) {
        uint texel = corner + (lane >> 3u) * object.width + (lane & 7u);
        uvec2 words = texels[object.texelBase + texel];
        if ((words.y & (kTexelReal << 16u)) == 0u) continue;
        uint t = state[object.stateBase + texel];
        if (!isSource(t) || t > view.now) continue;
        float age = float(view.now - t) + view.ambientGround.w;
        BurnMaterial material =
            materials[tile.object * kMaterialsPerObject + (words.y >> 16u & 7u)];
        float lasts = flameLasts(material, object.flags);
        if (age >= lasts) continue;
        float shows = min(kShows, kShowsOf * lasts), whole = min(kWhole, kWholeOf * lasts);
        float f = smoothstep(shows, whole, age) * (1.0 - smoothstep(0.75 * lasts, lasts, age)) *
                  flameFade(material, max(age - shows, 0.0), 0.45);
        place += f * vec3(words.x & 0xFFFFu, words.x >> 16u, words.y & 0xFFFFu);
        normal += f * vec3(decodeNormal(normals[object.texelBase + texel])) * (1.0 / 16384.0);
        fire += f;
        count += 1.0;
        watts += f * material.powerPerArea;
        fresh += material.powerPerArea;
        anchor = f > most ? texel : anchor;
        most = max(most, f);
    }
    if (fire < 0.02) return;
    vec4 quantum = object.originQuantum;
    vec3 rest = quantum.xyz + quantum.w * place / fire;
    normal /= max(length(normal), 1e-6);
    // A moved texel moves its tile.
    vec3 from = restOf(tile.object, texels[object.texelBase + anchor]), to = from;
    vec3 turned = normal * 16384.0;
    moveWithSkin(tile.object, anchor, to, turned);
    rest += to - from;
    normal = turned * (1.0 / 16384.0);
    uint cell = flameCells[object.tileBase + tile.tile];
    uint at = ((number - 1u) * kBodyCells + cell) * kBodyCellWords;
    int weight = int(fire * 8.0) + 1;  // [1, 513]
    ivec3 units = ivec3((rest - body.low.xyz) * (float(kBodyCellUnits) / body.low.w));
    ivec3 n = ivec3(normal * 127.0);
    atomicAdd(bodyCells[at], uint(weight));
    for (uint k = 0u; k < 3u; ++k) {
        atomicAdd(bodyCells[at + 1u + k], uint(units[k] * weight));
        atomicAdd(bodyCells[at + 4u + k], uint(n[k] * weight));
    }
    float area = object.tint.w;
    // As much as the tile releases, where that is known.
    float share = tile.normalPower.w / max(float(tile.texels) * area * fresh / count, 1e-6);
    watts *= area * clamp(share, 0.1, 4.0);
    atomicAdd(bodyCells[at + 7u], uint(count * area * 1e6) + 1u);
    atomicAdd(bodyCells[at + 8u], uint(min(watts * 16.0, 1e7)));
    atomicAdd(bodyCells[at + 9u], uint(fire * area * 1e6) + 1u);
}

void main() {
    uint count = counters[kRowBurn + push.burnParity].runCount;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * 64u) addTile(i);
}
