// A heat step of the tiles on the hot list: temperature, fuel and water of each texel, and what
// becomes of its state in the front. Tiles at rest leave the list. Most of the others are only warm,
// or wet, and have their turn now and then: a group finds those of 64 that have, and runs them by
// eight, a thread per row.
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

shared uint running;
shared uint runs[64];  // world tiles
// What the rows of a tile tell: changed | lit << 8 | put out << 16 | work << 24, heat of what burnt.
shared uint rowNews[64];
shared uint rowLow[64];
shared uint rowHigh[64];
shared float rowWatts[64];

struct Burnt {
    uint low, high;  // 2^-20 J
    float watts;
};

// `turn`: see heatTurn. `held`: it may not catch: what would stays as it is, and is looked at again.
uint heatRow(TileRef tile, uint row, uvec2 comes, uint turn, bool held, inout Burnt burnt) {
    uint object = tile.object;
    uint texel = texelOf(object, tile.local, row * 8u);
    uint stateAt = objects[object].stateBase + texel;
    uint heatAt = objects[object].heatBase + texel;
    uint texelAt = objects[object].texelBase + texel;
    uint ambient = heatQuads[object * kMaterialsPerObject * 6u + 1u].w;
    uvec4 ta = stateQuads[stateAt >> 2u];
    uvec4 tb = stateQuads[(stateAt >> 2u) + 1u];
    uint t[8] = uint[8](ta.x, ta.y, ta.z, ta.w, tb.x, tb.y, tb.z, tb.w);
    uint todo = 0u, dozes = 0u, waits = 0u;
    FW_UNROLL for (int i = 0; i < 4; ++i) {
        uvec4 two = heatPairs[(heatAt >> 1u) + uint(i)];
        FW_UNROLL for (int k = 0; k < 2; ++k) {
            HeatTexel x = unpackHeat(k == 0 ? two.xy : two.zw);
            uint work = heatWork(x, t[2 * i + k], comes.x, ambient), bit = 1u << uint(2 * i + k);
            todo |= (work & turn) != 0u ? bit : 0u;
            dozes |= work == kWorkDozes ? bit : 0u;
            waits |= (work & turn) == 0u ? work : 0u;
        }
    }
    uint news = waits << 24u;
    bool always = (turn & kWorkAlways) != 0u;
    uint step = hash32(push.now), strength = airStrength(objectCounters[object].air);
    if (todo == 0u) return news;
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
        if (!always && (dozes >> i & 1u) != 0u) {
            now = heatDozes(x, m, before, chance);
        } else {
            if (!always) m = heatOverRest(m);
            m = heatInAir(m, strength);
            now = heatTexelStep(x, m, before, push.now, comes.x, comes.y != 0u,
                                materials[material].air, chance, units);
        }
        bool lights = (kind & kTexelReal) != 0u && isSource(now) && !isSource(before);
        bool writes = !asksOnly() && !(held && lights);
        news |= lights && !writes ? kWorkAlways << 24u | (asksOnly() ? 1u << (i + 8u) : 0u) : 0u;
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
            news |= heatWork(x, now, comes.x, ambient) << 24u;
        }
        todo &= todo - 1u;
    } while (todo != 0u);
    return news;
}

void finishTile(uint worldTile, TileRef tile, uint thread, uint flux, bool always) {
    uint object = tile.object;
    uvec2 changed = uvec2(0u);
    uint lit = 0u, gone = 0u, work = fluxWork(flux), low = 0u, high = 0u;
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
        // Only what is in its turn always can show anything.
        bool warm = staysWarm(work, always, tile.local, push.now);
        if (warm) atomicOr(tileState[worldTile].flag, kTileWarm | kTileMarked);
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
        atomicMin(objectCounters[object].playsUntil, push.now + kStepTicks);
        if ((atomicOr(tileState[worldTile].flag, kTileBurning) & kTileBurning) == 0u) {
            burnAppend(push.burnParity, worldTile);
            atomicAdd(objectCounters[object].burningTiles, 1u);
        }
    }
    tileState[worldTile].lastChange = push.now;
    predictTouch(push.predictParity, worldTile);
    touchReaders(object, tile.local, changed);
}

uint turnOf(uint worldTile, TileRef tile) {
    bool warm = (tileState[worldTile].flag & kTileWarm) != 0u;
    return heatTurn(warm, tile.object, tile.local, push.now);
}

void main() {
    uint count = counters[kRowHot + push.hotParity].listCount;
    uint thread = gl_LocalInvocationID.x;
    for (uint base = gl_WorkGroupID.x * 64u; base < count; base += gl_NumWorkGroups.x * 64u) {
        if (thread == 0u) running = 0u;
        barrier();
        if (base + thread < count) {
            uint worldTile = hotTile(push.hotParity, base + thread);
            TileRef tile = tileRef(worldTile);
            bool alive = tile.alive && (objects[tile.object].flags & kObjectHeat) != 0u;
            if (!alive) {
                if (!asksOnly())
                    atomicAnd(tileState[worldTile].flag, ~(kTileHot | kTileWarm));
            } else if (turnOf(worldTile, tile) == 0u) {
                if (!asksOnly()) hotAppend(push.hotParity ^ 1u, worldTile);  // sleeps on
            } else if (!asksOnly() || !mayBurn(worldTile)) {
                runs[atomicAdd(running, 1u)] = worldTile;
            }
        }
        barrier();
        uint all = running;
        for (uint first = 0u; first < all; first += 8u) {
            uint slot = first + (thread >> 3u);
            bool here = slot < all;
            uint worldTile = here ? runs[slot] : 0u;
            TileRef tile = tileRef(worldTile);
            uint turn = turnOf(worldTile, tile);
            uvec2 comes =
                here ? uvec2(tileHeat[worldTile].flux, tileHeat[worldTile].pilot) : uvec2(0u);
            Burnt burnt = Burnt(0u, 0u, 0.0);
            uint news = 0u;
            if (here)
                news = heatRow(tile, thread & 7u, comes, turn, !mayBurn(worldTile), burnt);
            rowNews[thread] = news;
            rowLow[thread] = burnt.low;
            rowHigh[thread] = burnt.high;
            rowWatts[thread] = burnt.watts;
            barrier();
            if (here && (thread & 7u) == 0u)
                finishTile(worldTile, tile, thread, comes.x, (turn & kWorkAlways) != 0u);
            barrier();
        }
    }
}
