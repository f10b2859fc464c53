// A heat step of the hot tiles: temperature, fuel and water of each texel, and its state in the
// front. Cooled tiles leave the list. Most other tiles are only warm or wet and are due at
// intervals: a group scans the list until it has 64 due tiles, runs them by eight with eight
// threads each, and finishes them with one thread each. A thread scans a row for due texels, which
// are listed and shared out, as fire rarely fills a tile. Tiles that stay hot are appended
// together, to reduce contention on the list's counter.
#include "lib/compute.glsl"
FW_READ(OBJECTS) FW_READ(MATERIALS) FW_READ(TEXELS) FW_READ(STATE_QUADS) FW_READ(HEAT_PAIRS)
FW_READ(TILE_HEAT) FW_READ_WRITE(STATE) FW_READ_WRITE(TILE_STATE) FW_READ_WRITE(COUNTERS)
FW_READ_WRITE(OBJECT_COUNTERS) FW_READ_WRITE(HEAT) FW_WRITE(TILE_FIRE) FW_PUSH(StepPush)
#include "lib/hot_list.glsl"
#include "lib/burn_budget.glsl"
#include "lib/touch.glsl"
#include "lib/heat_material.glsl"
#include "lib/tile.glsl"

const uint kBlock = 64u;  // finished together

shared uint running;
shared uint runs[2u * kBlock];  // world tiles
shared uint staying;
shared uint stays[kBlock];
shared uint staysAt;
shared uint rowTodo[64];
shared uint items[512];  // of eight tiles: lane, and kItem bits
shared uint kinds[8];    // of eight tiles: materials of their texels, by bits
shared uint tileChanged[2u * kBlock];
// Results of eight threads per tile: lit | put out << 8 | work << 16, and heat of the burnt fuel.
shared uint threadChanges[8u * kBlock];
shared uint threadLow[8u * kBlock];
shared uint threadHigh[8u * kBlock];
shared float threadWatts[8u * kBlock];

const uint kItemDozes = 64u, kItemSleeps = 128u, kItemReal = 256u;
const uint kItemKindShift = 9u;

struct Row {
    uint todo;    // due texels, by bits
    uint dozes;
    uint sleeps;
    uint waits;   // work of the others
};
Row rowWork(TileRef tile, uint row, uint flux, uint turn) {
    uint object = tile.object;
    uint texel = texelOf(object, tile.local, row * 8u);
    uint stateAt = objects[object].stateBase + texel;
    uint heatAt = objects[object].heatBase + texel;
    uint ambient = heatQuads[object * kMaterialsPerObject * 6u + 1u].w;
    uvec4 ta = stateQuads[stateAt >> 2u];
    uvec4 tb = stateQuads[(stateAt >> 2u) + 1u];
    uint t[8] = uint[8](ta.x, ta.y, ta.z, ta.w, tb.x, tb.y, tb.z, tb.w);
    Row r = Row(0u, 0u, 0u, 0u);
    FW_UNROLL for (int i = 0; i < 4; ++i) {
        uvec4 two = heatPairs[(heatAt >> 1u) + uint(i)];
        FW_UNROLL for (int k = 0; k < 2; ++k) {
            HeatTexel x = unpackHeat(k == 0 ? two.xy : two.zw);
            uint work = workThisStep(workOfTexel(x, t[2 * i + k], flux, ambient), turn);
            uint bit = 1u << uint(2 * i + k);
            r.todo |= (work & turn) != 0u ? bit : 0u;
            r.dozes |= work == kWorkColdWater ? bit : 0u;
            r.sleeps |= work == kWorkWarm ? bit : 0u;
            r.waits |= (work & turn) == 0u ? work : 0u;
        }
    }
    return r;
}

// Lists a row's texels after those of the rows before it.
void listRow(TileRef tile, uint thread, Row r) {
    uint row = thread & 7u, at = (thread & ~7u) * 8u;
    FW_UNROLL for (uint other = 0u; other < 7u; ++other)
        at += other < row ? uint(bitCount(rowTodo[(thread & ~7u) + other])) : 0u;
    uint texelAt = objects[tile.object].texelBase + texelOf(tile.object, tile.local, row * 8u);
    uint todo = r.todo;
    if (todo == 0u) return;
    do {
        uint i = uint(findLSB(todo)), bit = 1u << i;
        uint flags = texels[texelAt + i].y >> 16u;
        uint kind = flags & (kMaterialsPerObject - 1u);
        items[at] = row * 8u + i + ((r.dozes & bit) != 0u ? kItemDozes : 0u) +
                    ((r.sleeps & bit) != 0u ? kItemSleeps : 0u) +
                    ((flags & kTexelReal) != 0u ? kItemReal : 0u) + (kind << kItemKindShift);
        atomicOr(kinds[thread >> 3u], 1u << kind);
        ++at;
        todo &= todo - 1u;
    } while (todo != 0u);
}

struct Changes {
    uint bits;       // as threadChanges
    uint low, high;  // 2^-20 J
    float watts;
};

// A thread's part of the list of tile `slot` of the block: every eighth item. held: the tile may
// not catch; texels that would catch stay unchanged and are tried again.
Changes heatItems(TileRef tile, uint slot, uint thread, uvec2 comes, bool held) {
    Changes sum = Changes(0u, 0u, 0u, 0.0);
    uint count = 0u, first = (thread & ~7u) * 8u + (thread & 7u);
    FW_UNROLL for (uint row = 0u; row < 8u; ++row)
        count += uint(bitCount(rowTodo[(thread & ~7u) + row]));
    if (count == 0u) return sum;
    uint object = tile.object, width = objects[object].width;
    uint corner = texelOf(object, tile.local, 0u);
    uint stateAt = objects[object].stateBase;
    uint heatAt = objects[object].heatBase;
    uint ambient = heatQuads[object * kMaterialsPerObject * 6u + 1u].w;
    uint step = hash32(push.now), strength = airStrength(objectCounters[object].air);
    // A material is many words, and most tiles have one: texels of each material in turn. Both
    // loops have the same length for all threads of a tile.
    uint left = kinds[thread >> 3u];
    do {
        uint kind = uint(findLSB(left)), material = object * kMaterialsPerObject + kind;
        HeatMaterial own = materialInAir(heatMaterial(material), strength);
        uint air = materials[material].air;
        uint at = 0u;
        do {
            uint item = at + (thread & 7u) < count ? items[first + at] : 0u;
            uint lane = item & 63u;
            uint texel = corner + (lane >> 3u) * width + (lane & 7u);
            HeatTexel x = unpackHeat(heat[heatAt + texel]);
            uint before = state[stateAt + texel];
            uint now = before;
            uint chance = heatChance(texel, step);
            uint units = 0u;
            if ((item & kItemDozes) != 0u)
                now = dryColdWater(x, own, before, chance);
            else
                now = heatTexelStep(x, heatMaterialOver(own, (item & kItemSleeps) != 0u, comes.x),
                                    before, push.now, comes.x, comes.y != 0u, air, chance, units);
            bool real = (item & kItemReal) != 0u && item >> kItemKindShift == kind;
            bool lights = real && isSource(now) && !isSource(before);
            bool writes = !isRequestPass() && !(held && lights);
            sum.bits |= lights && !writes ? kWorkAlways << 16u : 0u;
            sum.bits += lights && isRequestPass() ? 1u : 0u;
            if (real && writes) {
                uint low, high;
                umulExtended(units, own.energy, high, low);
                sum.high += high + (sum.low + low < low ? 1u : 0u);
                sum.low += low;
                sum.watts += float(units) * own.watts;
                heat[heatAt + texel] = packHeat(x);
                if (now != before) {
                    state[stateAt + texel] = now;
                    atomicOr(tileChanged[slot * 2u + (lane >> 5u)], 1u << (lane & 31u));
                }
                sum.bits += lights ? 1u : 0u;
                sum.bits += isSource(before) && !isSource(now) ? 0x100u : 0u;
                sum.bits |= workOfTexel(x, now, comes.x, ambient) << 16u;
            }
            at += 8u;
        } while (at < count);
        left &= left - 1u;
    } while (left != 0u);
    return sum;
}

void finishTile(uint worldTile, TileRef tile, uint slot) {
    uint object = tile.object;
    uvec2 changed = uvec2(tileChanged[slot * 2u], tileChanged[slot * 2u + 1u]);
    uint lit = 0u, gone = 0u, work = workOfFlux(tileHeat[worldTile].flux), low = 0u, high = 0u;
    float watts = 0.0;
    for (uint k = slot * 8u; k < slot * 8u + 8u; ++k) {
        uint changes = threadChanges[k];
        lit += changes & 0xFFu;
        gone += changes >> 8u & 0xFFu;
        work |= changes >> 16u;
        low += threadLow[k];
        high += threadHigh[k] + (low < threadLow[k] ? 1u : 0u);
        watts += threadWatts[k];
    }
    if (isRequestPass()) {
        if (lit != 0u) requestToBurn(worldTile);
        return;
    }
    if (work != 0u) {
        // Only texels that are always due can show anything.
        if ((work & kWorkAlways) != 0u)
            atomicOr(tileState[worldTile].flag, kTileWarm | kTileMarked);
        else atomicAnd(tileState[worldTile].flag, ~kTileWarm);
        stays[atomicAdd(staying, 1u)] = worldTile;
    } else {
        atomicAnd(tileState[worldTile].flag, ~(kTileHot | kTileWarm));
    }
    tileFire[worldTile] = watts;
    if ((low | high) != 0u) addEnergy(object, low, high);
    if ((changed.x | changed.y) == 0u) return;
    if (lit != gone) atomicAdd(objectCounters[object].ignited, lit - gone);
    if (lit != 0u) {
        atomicMin(objectCounters[object].playsUntil, push.now + kStepTicks);
        nowBurns(object, worldTile, push.now + kStepTicks);
    }
    tileState[worldTile].lastChange = push.now;
    predictTouch(push.predictParity, worldTile);
    touchDependents(object, tile.local, changed);
}

uint turnOf(uint worldTile, TileRef tile) {
    bool warm = (tileState[worldTile].flag & kTileWarm) != 0u;
    return workDue(warm, tile.object, tile.local, tileHeat[worldTile].flux, push.now);
}

// Takes a tile of the list: it runs, waits, or is gone.
void takeTile(uint worldTile) {
    TileRef tile = tileRef(worldTile);
    bool alive = tile.alive && (objects[tile.object].flags & kObjectHeat) != 0u;
    if (!alive) {
        if (!isRequestPass()) atomicAnd(tileState[worldTile].flag, ~(kTileHot | kTileWarm));
    } else if (turnOf(worldTile, tile) == 0u) {
        if (!isRequestPass()) stays[atomicAdd(staying, 1u)] = worldTile;  // not due
    } else if (!isRequestPass() || !mayBurn(worldTile)) {
        runs[atomicAdd(running, 1u)] = worldTile;
    }
}

uint hotTile(uint slot) { return hotLists[2u * slot + push.hotParity]; }

// First of `count` slots of the list of tiles that stay hot.
uint hotSlots(uint count) {
    uint row = kRowHot + (push.hotParity ^ 1u);
    uint slot = atomicAdd(counters[row].listCount, count);
    if (count != 0u) {
        atomicMax(counters[row].listX, min((slot + count - 1u) / kHotPerGroup + 1u, kMaxGroups));
        if (slot == 0u) counters[row].listY = counters[row].listZ = 1u;
    }
    return slot;
}

// Appends all tiles that stay hot.
void keepHot(uint thread) {
    barrier();
    uint count = staying;
    if (thread == 0u) staysAt = hotSlots(count);
    barrier();
    if (thread < count)
        hotLists[2u * (staysAt + thread) + (push.hotParity ^ 1u)] = stays[thread];
    if (thread == 0u) staying = 0u;
    barrier();
}

// Runs eight tiles of a block, starting at `first`.
void runEight(uint thread, uint base, uint first, uint all) {
    uint slot = first + (thread >> 3u);
    bool here = base + slot < all;
    uint worldTile = here ? runs[base + slot] : 0u;
    TileRef tile = tileRef(worldTile);
    uvec2 comes = here ? uvec2(tileHeat[worldTile].flux, tileHeat[worldTile].pilot) : uvec2(0u);
    Row row = Row(0u, 0u, 0u, 0u);
    if (here) row = rowWork(tile, thread & 7u, comes.x, turnOf(worldTile, tile));
    rowTodo[thread] = row.todo;
    if (thread < 8u) kinds[thread] = 0u;
    barrier();
    listRow(tile, thread, row);
    barrier();
    Changes changes = heatItems(tile, slot, thread, comes, !mayBurn(worldTile));
    uint at = slot * 8u + (thread & 7u);
    threadChanges[at] = changes.bits | row.waits << 16u;
    threadLow[at] = changes.low;
    threadHigh[at] = changes.high;
    threadWatts[at] = changes.watts;
    barrier();
}

void main() {
    uint count = counters[kRowHot + push.hotParity].listCount;
    uint thread = gl_LocalInvocationID.x;
    uint base = gl_WorkGroupID.x * 64u;
    if (thread == 0u) staying = 0u;
    while (base < count) {
        if (thread == 0u) running = 0u;
        barrier();
        uint all = 0u;
        do {
            if (base + thread < count) takeTile(hotTile(base + thread));
            base += gl_NumWorkGroups.x * 64u;
            keepHot(thread);
            all = running;
            barrier();
        } while (all < kBlock && base < count);
        for (uint block = 0u; block < all; block += kBlock) {
            tileChanged[thread] = 0u;
            tileChanged[kBlock + thread] = 0u;
            uint tiles = min(all - block, kBlock);
            for (uint first = 0u; first < tiles; first += 8u) runEight(thread, block, first, all);
            if (thread < tiles) {
                uint worldTile = runs[block + thread];
                finishTile(worldTile, tileRef(worldTile), thread);
            }
            keepHot(thread);
        }
    }
}
