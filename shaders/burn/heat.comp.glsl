// A heat step of the tiles on the hot list, 8 tiles a group and a thread per row: temperature, fuel
// and water of each texel, and what becomes of its state in the front. Tiles at rest leave the list,
// tiles with nothing but cold water left take a step in 32.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_PUSH
#define FW_USE_OBJECTS readonly
#define FW_USE_MATERIALS readonly
#define FW_USE_TEXELS readonly
#define FW_USE_TILES readonly
#define FW_USE_READERS readonly
#define FW_USE_STATE FW_READ_WRITE
#define FW_USE_STATE_QUADS
#define FW_USE_TILE_STATE FW_READ_WRITE
#define FW_USE_LISTS FW_READ_WRITE
#define FW_USE_COUNTERS FW_READ_WRITE
#define FW_USE_OBJECT_COUNTERS FW_READ_WRITE
#define FW_USE_BURN_LISTS FW_READ_WRITE
#define FW_USE_PREDICT_LISTS FW_READ_WRITE
#define FW_USE_HEAT FW_READ_WRITE
#define FW_USE_HEAT_QUADS
#define FW_USE_TILE_HEAT readonly
#define FW_USE_HEAT_MATERIALS
#define FW_USE_HOT_LISTS FW_READ_WRITE
#define FW_USE_TILE_FIRE writeonly
#include "lib/buffers.glsl"
#include "shared/heat.h"
#include "lib/lists.glsl"

// What the rows of a tile tell: changed | lit << 8 | put out << 16 | work << 24, heat of what burnt.
shared uint rowNews[64];
shared uint rowLow[64];
shared uint rowHigh[64];
shared float rowWatts[64];

struct Burnt {
    uint low, high;  // 2^-20 J
    float watts;
};

// `held`: it may not catch: what would stays as it is, and is looked at again.
uint heatRow(TileRef tile, uint row, uvec2 comes, bool doze, bool held, inout Burnt burnt) {
    uint object = tile.object;
    uint texel = texelOf(object, tile.local, row * 8u);
    uint stateAt = objects[object].stateBase + texel;
    uint heatAt = objects[object].heatBase + texel;
    uint texelAt = objects[object].texelBase + texel;
    uint ambient = heatQuads[object * kMaterialsPerObject * 6u + 1u].w;
    uvec4 ta = stateQuads[stateAt >> 2u];
    uvec4 tb = stateQuads[(stateAt >> 2u) + 1u];
    uint t[8] = uint[8](ta.x, ta.y, ta.z, ta.w, tb.x, tb.y, tb.z, tb.w);
    uint todo = 0u;
    FW_UNROLL for (int i = 0; i < 4; ++i) {
        uvec4 two = heatPairs[(heatAt >> 1u) + uint(i)];
        todo |= heatWork(unpackHeat(two.xy), t[2 * i], ambient) != 0u ? 1u << uint(2 * i) : 0u;
        todo |= heatWork(unpackHeat(two.zw), t[2 * i + 1], ambient) != 0u ? 2u << uint(2 * i) : 0u;
    }
    todo = comes.x != 0u ? 0xFFu : todo;
    uint news = 0u;
    uint step = hash32(push.now);
    if (todo == 0u) return 0u;
    do {
        uint i = uint(findLSB(todo));
        uint kind = texels[texelAt + i].y >> 16u;
        uint material = object * kMaterialsPerObject + (kind & 7u);
        HeatMaterial m = heatMaterial(material);
        HeatTexel x = unpackHeat(heat[heatAt + i]);
        uint before = state[stateAt + i];
        uint now = before;
        uint chance = heatChance(texel + i, step);
        uint units = 0u;
        if (doze)
            now = heatDozes(x, m, before, chance);
        else
            now = heatTexelStep(x, m, before, push.now, comes.x, comes.y != 0u,
                                materials[material].air, chance, units);
        bool lights = (kind & kTexelReal) != 0u && isSource(now) && !isSource(before);
        bool writes = !asksOnly() && !(held && lights);
        news |= lights && !writes ? 2u << 24u | (asksOnly() ? 1u << (i + 8u) : 0u) : 0u;
        if ((kind & kTexelReal) != 0u && writes) {
            uint low, high;
            umulExtended(units, m.energy, high, low);
            burnt.high += high + (burnt.low + low < low ? 1u : 0u);
            burnt.low += low;
            burnt.watts += float(units) * m.watts;
            heat[heatAt + i] = packHeat(x);
            if (now != before) state[stateAt + i] = now;
            uint bit = 1u << i;
            news |= now != before ? bit : 0u;
            news |= lights ? bit << 8u : 0u;
            news |= isSource(before) && !isSource(now) ? bit << 16u : 0u;
            news |= heatWork(x, now, ambient) << 24u;
        }
        todo &= todo - 1u;
    } while (todo != 0u);
    return news;
}

void finishTile(uint worldTile, TileRef tile, uint thread, bool flux) {
    uint object = tile.object;
    uvec2 changed = uvec2(0u);
    uint lit = 0u, gone = 0u, work = flux ? 2u : 0u, low = 0u, high = 0u;
    float watts = 0.0;
    for (uint row = 0u; row < 8u; ++row) {
        uint news = rowNews[thread + row];
        uint bits = (news & 0xFFu) << ((row & 3u) * 8u);
        changed.x |= row < 4u ? bits : 0u;
        changed.y |= row < 4u ? 0u : bits;
        lit += uint(bitCount(news & 0xFF00u));
        gone += uint(bitCount(news & 0xFF0000u));
        work |= news >> 24u;
        low += rowLow[thread + row];
        high += rowHigh[thread + row] + (low < rowLow[thread + row] ? 1u : 0u);
        watts += rowWatts[thread + row];
    }
    if (asksOnly()) {
        if (lit != 0u) askToBurn(worldTile);
        return;
    }
    if (work != 0u) {
        if ((work & 2u) != 0u) atomicOr(tileState[worldTile].flag, kTileWarm | kTileMarked);
        else atomicAnd(tileState[worldTile].flag, ~kTileWarm);
        hotAppend(push.hotParity ^ 1u, worldTile);
    } else {
        atomicAnd(tileState[worldTile].flag, ~(kTileHot | kTileWarm));
    }
    tileFire[worldTile] = watts;
    if ((low | high) != 0u) {
        uint had = atomicAdd(objectCounters[object].energyLow, low);
        atomicAdd(objectCounters[object].energyHigh, high + (had + low < low ? 1u : 0u));
    }
    if ((changed.x | changed.y) == 0u) return;
    if (lit != gone) atomicAdd(objectCounters[object].ignited, lit - gone);
    if (lit != 0u) {
        atomicMax(objectCounters[object].lastIgnition, push.now + kStepTicks);
        if ((atomicOr(tileState[worldTile].flag, kTileBurning) & kTileBurning) == 0u) {
            burnAppend(push.burnParity, worldTile);
            atomicAdd(objectCounters[object].burningTiles, 1u);
        }
    }
    tileState[worldTile].lastChange = push.now;
    predictTouch(push.predictParity, worldTile);
    touchReaders(object, tile.local, changed);
}

void main() {
    uint count = counters[kRowHot + push.hotParity].listCount;
    uint thread = gl_LocalInvocationID.x;
    for (uint base = gl_WorkGroupID.x * 8u; base < count; base += gl_NumWorkGroups.x * 8u) {
        uint slot = base + (thread >> 3u);
        uint worldTile = slot < count ? hotTile(push.hotParity, slot) : 0u;
        TileRef tile = tileRef(worldTile);
        bool here = slot < count;
        bool alive = here && tile.alive && (objects[tile.object].flags & kObjectHeat) != 0u;
        uvec2 comes = alive ? uvec2(tileHeat[worldTile].flux, tileHeat[worldTile].pilot) : uvec2(0u);
        bool flux = comes.x != 0u;
        uint flag = tileState[worldTile].flag;
        bool doze = (flag & kTileWarm) == 0u && !flux;
        bool runs = alive && (!doze || dozeEnds(tile.object, tile.local, push.now));
        bool held = !mayBurn(worldTile);
        if (asksOnly()) runs = runs && held;
        uint news = alive && !runs ? 1u << 24u : 0u;  // sleeps on
        Burnt burnt = Burnt(0u, 0u, 0.0);
        if (runs) news = heatRow(tile, thread & 7u, comes, doze, held, burnt);
        rowNews[thread] = news;
        rowLow[thread] = burnt.low;
        rowHigh[thread] = burnt.high;
        rowWatts[thread] = burnt.watts;
        barrier();
        if ((thread & 7u) == 0u && here) {
            if (alive) finishTile(worldTile, tile, thread, flux);
            else if (!asksOnly()) atomicAnd(tileState[worldTile].flag, ~(kTileHot | kTileWarm));
        }
        barrier();
    }
}
