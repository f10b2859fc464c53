// Storage buffers of the simulation passes. A shader defines FW_USE_<NAME> as the access it needs
// (readonly, writeonly, or FW_READ_WRITE) before it includes this; only those are declared.
#ifndef FW_LIB_BUFFERS_GLSL
#define FW_LIB_BUFFERS_GLSL
#include "shared/burn.h"
#if defined(FW_USE_EXCHANGE_OBJECTS) || defined(FW_USE_EXCHANGE_PUSH)
#include "shared/exchange.h"
#endif
#ifdef FW_USE_HEAT_MATERIALS
#include "shared/heat.h"
#endif

// *_WORDS and *_QUADS are the same buffers by words or by four: a software device loads four words
// at once for little more than one, and pays for every load, taken or not. It also runs a loop's
// text until no lane is left, and a `for` finds that out one turn late: hot loops are `do`,
// `while`.
#define FW_READ_WRITE
#define FW_BUFFER(number, access, block, type, name) \
    layout(std430, set = 0, binding = number) access buffer block { type name[]; }

#ifdef FW_USE_OBJECTS
FW_BUFFER(FW_BIND_OBJECTS, FW_USE_OBJECTS, ObjectsBuffer, BurnObject, objects);
#endif
#ifdef FW_USE_OBJECT_QUADS
FW_BUFFER(FW_BIND_OBJECTS, readonly, ObjectQuadsBuffer, uvec4, objectQuads);
uvec4 objectBases(uint object) { return objectQuads[object * 10u]; }  // texelBase .. width
uvec4 objectPlaces(uint object) { return objectQuads[object * 10u + 1u]; }  // .. flags
uvec4 objectSizes(uint object) { return objectQuads[object * 10u + 2u]; }  // tileBase .. tileCount
uvec4 objectTimes(uint object) { return objectQuads[object * 10u + 3u]; }  // window .. image
#endif
#ifdef FW_USE_MATERIAL_QUADS
FW_BUFFER(FW_BIND_MATERIALS, readonly, MaterialQuadsBuffer, uvec4, materialQuads);
BurnMaterial burnMaterial(uint material) {  // what the spread law needs of it
    uvec4 a = materialQuads[material * 7u];
    uvec4 b = materialQuads[material * 7u + 1u];
    uvec4 c = materialQuads[material * 7u + 2u];
    BurnMaterial m;
    m.sigma0 = a.x;
    m.headGain = a.y;
    m.backGain = a.z;
    m.driveMax = a.w;
    m.breadthMax = b.x;
    m.burnTicks = b.y;
    m.ceiling = b.z;
    m.driveX = int(c.x);
    m.driveY = int(c.y);
    m.driveZ = int(c.z);
    m.upCeiling = materialQuads[material * 7u + 5u];
    m.windowMax = materialQuads[material * 7u + 6u].y;
    return m;
}
uint burnTicksOf(uint material) { return materialQuads[material * 7u + 1u].y; }
#endif
#ifdef FW_USE_MATERIALS
FW_BUFFER(FW_BIND_MATERIALS, FW_USE_MATERIALS, MaterialsBuffer, BurnMaterial, materials);
#endif
#ifdef FW_USE_TEXELS
FW_BUFFER(FW_BIND_TEXELS, FW_USE_TEXELS, TexelsBuffer, uvec2, texels);
#endif
#ifdef FW_USE_NORMALS
FW_BUFFER(FW_BIND_NORMALS, FW_USE_NORMALS, NormalsBuffer, uint, normals);
#endif
#ifdef FW_USE_SLOWNESS
FW_BUFFER(FW_BIND_SLOWNESS, FW_USE_SLOWNESS, SlownessBuffer, uint, slowness);
uint slownessAt(uint base, uint texel) {
    return (slowness[base + (texel >> 1u)] >> ((texel & 1u) * 16u)) & 0xFFFFu;
}
#endif
#ifdef FW_USE_LINKS
FW_BUFFER(FW_BIND_LINKS, FW_USE_LINKS, LinksBuffer, uint, links);
FW_BUFFER(FW_BIND_LINKS, FW_USE_LINKS, LinkQuadsBuffer, uvec4, linkQuads);
#endif
#ifdef FW_USE_DEPENDENTS
FW_BUFFER(FW_BIND_DEPENDENTS, FW_USE_DEPENDENTS, DependentsBuffer, uint, readers);
#endif
#ifdef FW_USE_TILES
// Two words of four per tile: seam mask, reader start and count; rim mask, rim base, unused.
FW_BUFFER(FW_BIND_TILES, FW_USE_TILES, TilesBuffer, uvec4, tiles);
#endif
#ifdef FW_USE_TILE_WORDS
FW_BUFFER(FW_BIND_TILES, readonly, TileWordsBuffer, uint, tileWords);
// Of a row of eight texels: those with a ring record.
uint rimOfRow(uint tile, uint row) {
    return (tileWords[tile * 8u + 4u + (row >> 2u)] >> ((row & 3u) * 8u)) & 0xFFu;
}
#endif
#ifdef FW_USE_STATE
FW_BUFFER(FW_BIND_STATE, FW_USE_STATE, StateBuffer, uint, state);
#endif
#ifdef FW_USE_STATE_QUADS
FW_BUFFER(FW_BIND_STATE, readonly, StateQuadsBuffer, uvec4, stateQuads);
#endif
#ifdef FW_USE_PENDING
FW_BUFFER(FW_BIND_PENDING, FW_USE_PENDING, PendingBuffer, uint, pendingTick);
#endif
#ifdef FW_USE_PENDING_QUADS
FW_BUFFER(FW_BIND_PENDING, readonly, PendingQuadsBuffer, uvec4, pendingQuads);
#endif
#ifdef FW_USE_SETTLED
FW_BUFFER(FW_BIND_SETTLED, FW_USE_SETTLED, SettledBuffer, uint, settledRows);
#endif
#ifdef FW_USE_TILE_STATE
FW_BUFFER(FW_BIND_TILE_STATE, FW_USE_TILE_STATE, TileStateBuffer, TileState, tileState);
#endif
#ifdef FW_USE_LISTS
FW_BUFFER(FW_BIND_LIST_A, FW_USE_LISTS, ListABuffer, uint, listA);
FW_BUFFER(FW_BIND_LIST_B, FW_USE_LISTS, ListBBuffer, uint, listB);
#endif
#ifdef FW_USE_RUN
// World tile; object; its first texel in the object's map, a multiple of eight, + kRun bits; its
// row of `tiles`.
FW_BUFFER(FW_BIND_RUN, FW_USE_RUN, RunBuffer, uvec4, run);
const uint kRunWoken = 1u;  // due because a known arrival is: nothing else has changed
const uint kRunLitBeside = 2u;   // due because texels just caught: settled ones need no run
const uint kRunBits = 3u;
#endif
#ifdef FW_USE_SCRATCH
FW_BUFFER(FW_BIND_SCRATCH, FW_USE_SCRATCH, ScratchBuffer, uint, scratch);
// Word of rim texel `i` of an iteration: its gathered row * 8 + its column.
uint rimItem(uint i) { return uint(scratch.length()) - 1u - i; }
#endif
#ifdef FW_USE_SCRATCH_QUADS
// A gathered row: (run slot * 8 + row, chosen texels | changed ones << 8, first texel, object). Of
// the prediction: (world tile * 8 + row, chosen texels | changed ones << 8 | wet ones << 16, first
// texel, object). The scratch's end lists rim texels, see rimItem.
FW_BUFFER(FW_BIND_SCRATCH, FW_USE_SCRATCH_QUADS, ScratchQuadsBuffer, uvec4, scratchQuads);
#endif
#ifdef FW_USE_MASKS
FW_BUFFER(FW_BIND_MASKS, FW_USE_MASKS, MasksBuffer, uvec4, masks);
#endif
#ifdef FW_USE_MASK_WORDS
FW_BUFFER(FW_BIND_MASKS, FW_READ_WRITE, MaskWordsBuffer, uint, maskWords);
#endif
#ifdef FW_USE_COUNTERS
FW_BUFFER(FW_BIND_COUNTERS, FW_USE_COUNTERS, CountersBuffer, IterationCounters, counters);
#endif
#ifdef FW_USE_EVENTS
FW_BUFFER(FW_BIND_EVENTS, FW_USE_EVENTS, EventsBuffer, TexelEvent, events);
#endif
#ifdef FW_USE_WAKE_GROUPS
FW_BUFFER(FW_BIND_WAKE_GROUPS, FW_USE_WAKE_GROUPS, WakeGroupsBuffer, uvec2, wakeGroups);
#endif
#ifdef FW_USE_OBJECT_COUNTERS
FW_BUFFER(FW_BIND_OBJECT_COUNTERS, FW_USE_OBJECT_COUNTERS, ObjectCountersBuffer, ObjectCounters, objectCounters);
#endif
#ifdef FW_USE_BURN_LISTS
FW_BUFFER(FW_BIND_BURN_A, FW_USE_BURN_LISTS, BurnABuffer, uint, burnA);
FW_BUFFER(FW_BIND_BURN_B, FW_USE_BURN_LISTS, BurnBBuffer, uint, burnB);
#endif
#ifdef FW_USE_BURN_TILES
FW_BUFFER(FW_BIND_BURN_TILES, FW_USE_BURN_TILES, BurnTilesBuffer, BurnTile, burnTiles);
#endif
#ifdef FW_USE_PREDICT
FW_BUFFER(FW_BIND_PREDICT, FW_USE_PREDICT, PredictBuffer, uint, predict);
#endif
#ifdef FW_USE_PREDICT_QUADS
FW_BUFFER(FW_BIND_PREDICT, readonly, PredictQuadsBuffer, uvec4, predictQuads);
#endif
#ifdef FW_USE_GRADIENT
FW_BUFFER(FW_BIND_GRADIENT, FW_USE_GRADIENT, GradientBuffer, uint, gradient);
#endif
#ifdef FW_USE_PREDICT_LISTS
FW_BUFFER(FW_BIND_PREDICT_LIST_A, FW_USE_PREDICT_LISTS, PredictListABuffer, uint, predictA);
FW_BUFFER(FW_BIND_PREDICT_LIST_B, FW_USE_PREDICT_LISTS, PredictListBBuffer, uint, predictB);
#endif
#ifdef FW_USE_PROBES
FW_BUFFER(FW_BIND_PROBES, FW_USE_PROBES, ProbesBuffer, uvec2, probes);
#endif
#ifdef FW_USE_ANSWERS
FW_BUFFER(FW_BIND_ANSWERS, FW_USE_ANSWERS, AnswersBuffer, ProbeAnswer, answers);
#endif
#ifdef FW_USE_PUBLISHED
FW_BUFFER(FW_BIND_PUBLISHED, FW_USE_PUBLISHED, PublishedBuffer, float, published);
#endif
#ifdef FW_USE_HEAT
FW_BUFFER(FW_BIND_HEAT, FW_USE_HEAT, HeatBuffer, uvec2, heat);
#endif
#ifdef FW_USE_HEAT_QUADS
FW_BUFFER(FW_BIND_HEAT, readonly, HeatPairsBuffer, uvec4, heatPairs);  // two texels each
#endif
#ifdef FW_USE_TILE_HEAT
FW_BUFFER(FW_BIND_TILE_HEAT, FW_USE_TILE_HEAT, TileHeatBuffer, TileHeat, tileHeat);
#endif
#ifdef FW_USE_HEAT_MATERIALS
FW_BUFFER(FW_BIND_HEAT_MATERIALS, readonly, HeatMaterialsBuffer, uvec4, heatQuads);
HeatMaterial heatMaterial(uint material) {
    uvec4 a = heatQuads[material * 6u];
    uvec4 b = heatQuads[material * 6u + 1u];
    uvec4 c = heatQuads[material * 6u + 2u];
    uvec4 d = heatQuads[material * 6u + 3u];
    uvec4 e = heatQuads[material * 6u + 4u];
    uvec4 f = heatQuads[material * 6u + 5u];
    return HeatMaterial(a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w, c.x, c.y, c.z, c.w, d.x, d.y, d.z,
                        d.w, e.x, e.y, e.z, e.w, f.x, f.y, f.z, uintBitsToFloat(f.w));
}
#endif
#ifdef FW_USE_HOT_LISTS
FW_BUFFER(FW_BIND_HOT_LISTS, FW_USE_HOT_LISTS, HotListsBuffer, uvec2, hotLists);
#endif
#ifdef FW_USE_TILE_FIRE
FW_BUFFER(FW_BIND_TILE_FIRE, FW_USE_TILE_FIRE, TileFireBuffer, float, tileFire);
#endif

#ifdef FW_USE_EXCHANGE_OBJECTS
FW_BUFFER(FW_BIND_EXCHANGE_OBJECTS, readonly, ExchangeObjectsBuffer, ExchangeObject, exchangeObjects);
#endif
#ifdef FW_USE_EXCHANGE_TILES
FW_BUFFER(FW_BIND_EXCHANGE_TILES, readonly, ExchangeTilesBuffer, ExchangeTile, exchangeTiles);
#endif
#ifdef FW_USE_SOURCES
FW_BUFFER(FW_BIND_SOURCES, FW_USE_SOURCES, SourcesBuffer, FireSource, sources);
#endif
#ifdef FW_USE_NEIGHBOURS
FW_BUFFER(FW_BIND_NEIGHBOURS, readonly, NeighboursBuffer, uint, neighbours);
#endif
#ifdef FW_USE_CONTACTS
FW_BUFFER(FW_BIND_CONTACTS, readonly, ContactsBuffer, ContactLink, contacts);
#endif
#ifdef FW_USE_HEAT_OCCLUDERS
FW_BUFFER(FW_BIND_HEAT_OCCLUDERS, readonly, HeatOccludersBuffer, HeatOccluder, occluders);
#endif
#ifdef FW_USE_HEAT_OCCLUSION
FW_BUFFER(FW_BIND_HEAT_OCCLUSION, readonly, OcclusionBuffer, uint, shield);
#endif
#ifdef FW_USE_ROOMS
#include "shared/room.h"
FW_BUFFER(FW_BIND_ROOMS, readonly, RoomsBuffer, Room, rooms);
FW_BUFFER(FW_BIND_ROOM_AIR, FW_READ_WRITE, RoomAirBuffer, RoomAir, roomAir);
#endif
#ifdef FW_USE_RECEIVERS
FW_BUFFER(FW_BIND_RECEIVERS, FW_USE_RECEIVERS, ReceiversBuffer, uint, receivers);
#endif

#ifdef FW_USE_EXCHANGE_PUSH
layout(push_constant) uniform ExchangePushBlock { ExchangePush push; };
#endif
#ifdef FW_USE_PUSH
layout(push_constant) uniform StepPushBlock { StepPush push; };
#endif

const uint kMaxGroups = 65535u;  // of an indirect dispatch; passes stride over the rest

// A world tile as its object sees it. Entries of a destroyed object are met in lists until the next
// pass drops them: `alive` is false for those.
#if defined(FW_USE_OBJECTS) && defined(FW_USE_TILE_STATE)
struct TileRef {
    uint object, local;
    bool alive;
};
TileRef tileRef(uint worldTile) {
    TileRef r;
    r.object = tileState[worldTile].object;
    r.local = worldTile - objects[r.object].worldTileBase;
    r.alive = (objects[r.object].flags & kObjectLive) != 0u && r.local < objects[r.object].tileCount;
    return r;
}
// Texel of a lane of a tile, in the object's own map.
uint texelOf(uint object, uint local, uint lane) {
    uint tilesX = objects[object].tilesX;
    return ((local / tilesX) * 8u + (lane >> 3u)) * objects[object].width + (local % tilesX) * 8u + (lane & 7u);
}
#endif
#endif
