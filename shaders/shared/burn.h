// Buffers, records, texel codes and lists of the burn simulation, for every backend and shader.
// Times are ticks of 2^-12 s. The front's arithmetic is in front.h.
// clang-format off
#ifndef FW_SHARED_BURN_H
#define FW_SHARED_BURN_H
#include "shared/types.h"

// Bindings of set 0, one number per buffer in all passes. A layout has only the pass's buffers.
#define FW_BIND_OBJECTS 0  // BurnObject[], by object slot
#define FW_BIND_MATERIALS 1  // BurnMaterial[], 8 per object slot
#define FW_BIND_TEXELS 2  // uvec2[]: position xyz u16, material | flags u16 (per mesh)
#define FW_BIND_NORMALS 3  // uint[]: signed 11:11:10 (per mesh)
#define FW_BIND_SLOWNESS 4  // uint[]: two u16 Q7 factors per word (per mesh or per object)
#define FW_BIND_LINKS 5  // uint[]: 8 texel indices per rim record (per mesh)
#define FW_BIND_DEPENDENTS 6  // uint[]: dependent tiles (per mesh)
#define FW_BIND_TILES 7  // TileStatic as 2 x uvec4 (per mesh)
#define FW_BIND_STATE 8  // uint[]: ignition tick or code (per object)
#define FW_BIND_TILE_STATE 9  // TileState[] (per object)
// Lists of world tiles: two (ping, pong), whose entries alternate.
#define FW_BIND_FRONT_LISTS 10  // uint[]
#define FW_BIND_RUN 12  // uvec4[]: due tiles, see lib/buffers.glsl
#define FW_BIND_SCRATCH 13  // uint[]: gathered rows and rim texels, 96 words per due tile
#define FW_BIND_MASKS 14  // uvec4[]: texels changed (xy) and newly lit (zw) per due tile
#define FW_BIND_COUNTERS 15  // IterationCounters[], see the kRow constants
#define FW_BIND_EVENTS 16  // TexelEvent[]
#define FW_BIND_WAKE_GROUPS 17  // uvec2[]: object slot, first tile of 64
#define FW_BIND_OBJECT_COUNTERS 18  // ObjectCounters[]
#define FW_BIND_BURN_LISTS 19  // uint[]: as FRONT_LISTS, tiles that flame
#define FW_BIND_BURN_TILES 21  // BurnTile[]: what `reduce` says of each of them
#define FW_BIND_PREDICT 22  // uint[]: predicted arrival ticks, or codes; cosmetic
#define FW_BIND_GRADIENT 23  // uint[]: slope of the predicted arrival, and soot: lib/gradient.glsl
#define FW_BIND_PREDICT_LISTS 24  // uint[]: as FRONT_LISTS
#define FW_BIND_PROBES 26  // uvec2[]: object slot, texel
#define FW_BIND_ANSWERS 27  // ProbeAnswer[]: one per probe
#define FW_BIND_EXTENSION_TILES 28  // 768 bytes a tile of objects that an extension works on
#define FW_BIND_LIGHTS 29  // BurnLight[]
#define FW_BIND_CLUSTERS 30  // uint[]: hash grid of burning cells
#define FW_BIND_FLAMES 31  // FlameQuad[]
#define FW_BIND_DRAW_ARGS 32  // uint[]: indirect draw of the flames, their order; see kFlameOrder
#define FW_BIND_VIEW 33  // uniform ViewParams
#define FW_BIND_APPEARANCES 34  // MaterialAppearance[]
#define FW_BIND_HEAT 35  // uvec2[]: packed HeatTexel; objects with kObjectHeat
#define FW_BIND_TILE_HEAT 36  // TileHeat[] (per object): heat that other objects send to a tile
#define FW_BIND_HEAT_MATERIALS 37  // HeatMaterial[], 8 per object slot
#define FW_BIND_HOT_LISTS 38  // uint[]: as FRONT_LISTS, hot tiles
#define FW_BIND_TILE_FIRE 39  // float[]: W of a tile's thick fuel in the last heat step
#define FW_BIND_EXCHANGE_OBJECTS 40  // ExchangeObject[], by object slot: see exchange.h
#define FW_BIND_EXCHANGE_TILES 41  // ExchangeTile[] (per mesh)
#define FW_BIND_SOURCES 42  // FireSource[] (per object)
#define FW_BIND_NEIGHBOURS 43  // uint[]: object slot | visible share, of 255, << 24
#define FW_BIND_CONTACTS 44  // ContactLink[]
#define FW_BIND_HEAT_OCCLUDERS 45  // HeatOccluder[kMaxHeatOccluders]
#define FW_BIND_RECEIVERS 46  // uint[kReceiverWords] per object slot
#define FW_BIND_ROOMS 47  // Room[kMaxRooms]: see room.h
#define FW_BIND_SHOWN 48  // ShownVertex[]: instead of the mesh's (per object); vertex input
#define FW_BIND_DEFORM_PARTICLES 49  // DeformParticle[] (per mesh)
#define FW_BIND_DEFORM_EMBEDDINGS 50  // DeformEmbedding[] (per mesh)
#define FW_BIND_DEFORM_OBJECTS 51  // DeformObject[], by object slot
#define FW_BIND_DEFORM_GROUPS 52  // uvec2[]: object slot, first of 64 particles or vertices
#define FW_BIND_SOFT 53  // uvec4[]: state of the particles of sheets, see lib/deform.glsl
#define FW_BIND_ROOM_AIR 54  // RoomAir[kMaxRooms]
#define FW_BIND_HEAT_OCCLUSION 55  // uint[]: heat-occlusion grid, see exchange.h
#define FW_BIND_SKIN_TEXELS 56  // uvec4[]: per texel three vertices, two unorm16 weights
#define FW_BIND_SKIN_SOURCES 57  // uint[]: host vertex of each drawn vertex (per mesh)
#define FW_BIND_SKIN_GIVEN 58  // uint[]: copies of the hosts' vertex buffers (per object)
#define FW_BIND_REFINE_WORK 60  // uint[]: work lists of the frame, see kRefineWork... in refine.h
#define FW_BIND_REFINE_OBJECTS 61  // RefineObject[], by object slot
#define FW_BIND_REFINE_TRIANGLES 62  // RefineTriangle[] (per mesh)
#define FW_BIND_REFINE_EDGES 63  // RefineEdge[] (per mesh)
#define FW_BIND_REFINE_SLOTS 64  // RefineSlot[] (per mesh)
#define FW_BIND_REFINE_WORDS 65  // uint[]: token table; per mesh: items that each tile warms
#define FW_BIND_REFINE_ITEMS 66  // RefineLevel[]: edges, then interiors (per object)
#define FW_BIND_REFINE_HEAT 67  // uint[], as items: kRefineHeat...
#define FW_BIND_REFINE_LEVELS 68  // uvec2[], per triangle: levels, first output triangle
#define FW_BIND_REFINE_VERTICES 69  // RefineVertex[], per slot of an object
#define FW_BIND_REFINE_INDICES 70  // uint[]: output triangles
#define FW_BIND_REFINE_DRAWS 71  // uint[]: indexed indirect draws, 8 per object slot
// FW_BIND_PENDING: as state: tick at which a texel catches, which `commit` writes. Also valid for
// receptive texels beside a source, until a neighbour changes.
#define FW_BIND_PENDING 72  // uint[]
#define FW_BIND_SETTLED 73  // uint[]: settled texels of a row of eight, bits, see `arrival`
#define FW_BIND_VERTICES 74  // mesh::RenderVertex[], as three uvec4 (per mesh)
#define FW_BIND_REFINE_CUTS 75  // vertices along holes (per object), see kRefineCut... in refine.h
#define FW_BIND_REFINE_CUT_DRAWS 76  // uint[]: indirect draws, 8 per object slot
#define FW_BIND_EXTENSION_GROUPS 77  // uvec2[]: per frame
#define FW_BIND_EXTENSION_WORDS 78  // uvec4[]: of objects that an extension works on
#define FW_BIND_VOLUMES 90  // VolumeFlame[]: volumetric flames of the frame, see volume_draw.h
#define FW_BIND_VOLUME_RAYS 91  // uint[]: marched flames of a view, see volume_draw.h
#define FW_BIND_VOLUME_WORK 92  // VolumeWork[]: result of the probe per flame
#define FW_BIND_BODIES 93  // FlameBody[]: of burning objects, see body.h
#define FW_BIND_BODY_OF 94  // uint[], by object slot: its body + 1; 0: none
#define FW_BIND_BODY_CELLS 95  // uint[]: cells of all bodies, see body_cells
#define FW_BIND_FLAME_CELLS 96  // uint[] (per mesh): cell of each tile, see body.h
#define FW_BIND_FIELDS 110  // FieldRecord[], by field slot: see field.h
#define FW_BIND_FIELD_CELLS 111  // uint[]: fieldCell, twice (per field)
#define FW_BIND_FIELD_MASKS 113  // uint[]: one byte per cell (per field)
#define FW_BIND_FIELD_COUNTERS 114  // FieldCounters[], by field slot
#define FW_BIND_FIELD_RUNS 115  // uvec2[]: field slot, step number; for steps also the unit << 16
#define FW_BIND_FIELD_SHOWN 116  // uint[]: displayed cells (per field), see field.h
#define FW_BIND_FIELD_DRAWS 117  // FieldDraw[]: visible fields
#define FW_BIND_SPARKS 119  // SparkSource[]: sources of the frame, see spark.h
#define FW_BIND_EMITTERS 120  // ParticleEmitter[]: fire emitters of the frame, see particle.h
#define FW_BIND_EMITTER_GROUPS 121  // uvec2[]: emitter, first ring slot of the group
#define FW_BIND_PARTICLES 122  // Particle[]: rings of all emitters
#define FW_BIND_FLIPBOOKS 123  // uint[]: flipbooks, see flipbook.h
#define FW_BIND_COUNT 124

FW_SHARED_BEGIN

FW_CONST uint kNoneTexel = 0xFFFFFFFFu;
// Codes of a texel's state. A value below kLiveEnd is an ignition tick: the texel is a source.
FW_CONST uint kNever = 0xFFFFFFFFu;   // unburnt, receptive
FW_CONST uint kInert = 0xFFFFFFFEu;   // cannot burn, or no texel: a barrier
FW_CONST uint kWet = 0xFFFFFFFDu;     // unburnt, water film: a barrier
FW_CONST uint kOut = 0xFFFFFFFCu;     // extinguished and dry: receptive
FW_CONST uint kOutWet = 0xFFFFFFFBu;  // extinguished, water film: a barrier
FW_CONST uint kLiveEnd = 0xFFFFFFF0u;

FW_CONST uint kTicksPerSecond = 4096u;
FW_CONST uint kStepTicks = 128u;      // 1/32 s
FW_CONST uint kHeatSteps = 4u;        // steps from one heat step to the next
FW_CONST uint kMaxSubsteps = 8u;
FW_CONST uint kMaterialsPerObject = 8u;

FW_CONST uint kTexelReal = 0x100u;    // as mesh::TexelFlag
FW_CONST uint kTexelRim = 0x200u;

// BurnObject::flags
FW_CONST uint kObjectLive = 1u;
FW_CONST uint kObjectExtended = 2u;  // an extension burns its texels
FW_CONST uint kObjectTwoSided = 4u;
FW_CONST uint kObjectNoHoles = 8u;
FW_CONST uint kObjectHidden = 16u;
FW_CONST uint kObjectDetail = 32u;    // vertices carry detail coordinates
FW_CONST uint kObjectHeat = 64u;      // has a heat buffer
FW_CONST uint kObjectNoDamage = 128u; // burns without visible damage
FW_CONST uint kObjectSkinned = 0x1000u; // its fire follows the shown vertices
FW_CONST uint kObjectDepthFirst = 0x2000u;  // draws depth before colour
FW_CONST uint kObjectUnseen = 0x4000u;  // no view shows it: not predicted
// A view shows it again: prediction restarts from the burning texels.
FW_CONST uint kObjectShownAgain = 0x8000u;
FW_CONST uint kObjectRoomShift = 16u;   // 8 bits: index of its room, plus 1

// TileState::flag
FW_CONST uint kTileListed = 1u;       // in the front list
FW_CONST uint kTileTouched = 2u;      // an input changed: due now
FW_CONST uint kTileLitBeside = 0x80000u;  // due only because neighbouring texels just caught
FW_CONST uint kTileCorrected = 0x100000u; // a texel of this run was corrected, not just lit
FW_CONST uint kTileBurning = 4u;      // in the burn list
FW_CONST uint kTilePredict = 8u;      // in the first list of predict; << 1: in the second
// `wake` may be something other than a known arrival.
FW_CONST uint kTilePendingUnknown = 128u;
FW_CONST uint kTileHot = 32u;         // in the hot list
FW_CONST uint kTileWarm = 64u;        // and takes part in every heat step, see workDue
// Cosmetic, written by `support`: facts of the tile's texels, results, and the distance to a
// support.
FW_CONST uint kTileSidesShift = 8u;   // 4 bits: the surface continues over that side
FW_CONST uint kTileSpent = 0x1000u;   // all its texels burn or have burnt
FW_CONST uint kTileGround = 0x2000u;
FW_CONST uint kTileMaterialShift = 14u; // 3 bits
FW_CONST uint kTileFacts = 0x1FF00u;
FW_CONST uint kTileSolid = 0x20000u;
FW_CONST uint kTileFalling = 0x40000u;
// Fire, heat, water or soot has shown on it; never cleared.
FW_CONST uint kTileMarked = 0x200000u;
FW_CONST uint kTileDistanceShift = 22u; // 10 bits

// Rows of IterationCounters. The first rows belong to persistent lists. list*: indirect groups of
// 64 tiles (burn, hot) or of 8 (predict).
FW_CONST uint kRowBurn = 0u;          // + parity of the burn list; run*: its BurnTiles / 64
FW_CONST uint kRowPredict = 2u;       // + parity of the predict list
FW_CONST uint kRowHot = 4u;           // + parity of the hot list
FW_CONST uint kRowExchange = 6u;      // run*: receivers; list*: embers / 64
FW_CONST uint kRowIteration = 7u;     // + iteration of the frame

// StepPush::switches, as FwDebugSwitch
FW_CONST uint kSwitchDense = 1u;
FW_CONST uint kSwitchShuffle = 2u;
FW_CONST uint kSwitchNoSeamWake = 4u;
FW_CONST uint kSwitchWrongDependents = 8u;
FW_CONST uint kSwitchNoWindWake = 16u;
FW_CONST uint kSwitchRefineFull = 64u;
FW_CONST uint kSwitchCrossing = 128u;
FW_CONST uint kSwitchNoDepthFirst = 256u;
// internal: an object or the world limits its fire.
FW_CONST uint kSwitchGoverned = 0x10000u;
FW_CONST uint kSwitchPlayback = 0x80000u;     // internal: an object may play a baked burn
FW_CONST uint kSwitchBodies = 0x200000u;  // internal: no view needs flame quads of bodies
FW_CONST uint kSwitchDisplayOnly = 0x100000u;    // internal: `reduce` writes BurnTiles only

// TexelEvent::kind, as FwIgnitionKind
FW_CONST uint kEventIgnite = 0u;
FW_CONST uint kEventWet = 1u;
FW_CONST uint kEventDry = 2u;
FW_CONST uint kEventExtinguish = 3u;
// Internal: a jet heats the texel for one heat step if its gates let it pass. Index of the first
// gate, plus 1, above kEventKindBits.
FW_CONST uint kEventHeat = 4u;
// Internal: a texel on a jet's path, stored unordered after the batch's other events. Changes
// nothing. tick: from ignition until the texel gives way.
FW_CONST uint kEventGate = 5u;
// Baked burn: kEventPlayback lights the texel if its object plays back. kEventPlaybackSpan (texel:
// kNoneTexel) starts playback (tick: kNever) or ends it at `tick` at the latest.
FW_CONST uint kEventPlayback = 6u;
FW_CONST uint kEventPlaybackSpan = 7u;
// Copies the state of another object's texel; tick: that texel. Its object slot plus 1 is stored
// above kEventKindBits. No other event of the step addresses either object.
FW_CONST uint kEventCarry = 8u;
FW_CONST uint kEventKindBits = 8u;
// Of a gate's kind: the texel must still stand, else be gone.
FW_CONST uint kGateShut = 0x100u;
FW_CONST uint kGateMore = 0x200u;  // of a gate's kind: the next gate must open, too
FW_CONST uint kGates = 2u;         // gates of an event, at most

struct BurnObject {   // offsets and constants of one object
    uint texelBase;   // into texels, normals (per mesh)
    uint stateBase;   // into state, predict, gradient; a multiple of 64
    uint slowBase;    // into slowness, in WORDS
    uint width;       // texels, a multiple of 8
    uint worldTileBase;  // into tileState; a world tile id = worldTileBase + local tile
    uint linkBase;    // into links, in records
    uint dependentBase;  // into dependents
    uint flags;
    uint tileBase;    // into tiles (per mesh)
    uint height;      // texels
    uint tilesX;
    uint tileCount;
    uint window;      // correction window, ticks
    uint substepShift;  // log2 of its substeps per step, 0..3
    uint horizon;     // ticks that the prediction reaches ahead
    uint shownBase;   // into the shown vertices; with kObjectSkinned
    vec4 originQuantum;  // m: rest position = origin + quantum * xyz
    vec4 worldRow0;   // object to world, rows of a 3x4 matrix
    vec4 worldRow1;
    vec4 worldRow2;
    vec4 tint;        // rgb; w: mean texel area, m^2, world scale
    uint extensionBase;  // floats, into the tiles of an extension
    uint heatBase;    // into heat; with kObjectHeat
    uint skinBase;    // into the skin texels; with kObjectSkinned
    uint zoneWind;    // wind of the zones at the object, see unpackWind; cosmetic
};
FW_SIZE(BurnObject, 160)

struct BurnMaterial { // integers of the spread law of one material on one object; see front.h
    uint sigma0;      // slowness at R0: Q22 ticks per 1/8 position unit
    uint headGain;    // Q8
    uint backGain;    // Q8
    uint driveMax;    // Q10
    uint breadthMax;  // Q8, largest back/head slowness ratio
    uint burnTicks;   // ticks that a texel flames; kNoneTexel: unlimited
    uint ceiling;     // Q8 speed-up of downward-facing surfaces
    uint appearance;        // row of the appearance table
    int driveX;       // Q10, object space: windGain * wind + upGain * up
    int driveY;
    int driveZ;
    uint flags;       // 1: can burn
    float powerPerArea;  // W/m^2 while it flames; cosmetic, lights, queries
    // Appearance seconds per second: pace and spread rate against the appearance's own.
    float timeScale;
    float thickness;  // m
    float roughness;
    vec4 baseColor;   // linear albedo; w: ticks from ignition until nothing is visible
    uvec4 upCeiling;  // xyz: up in object space as int Q10 bits; w: height, in Q10 position units,
                      // of what counts as on the ground (cosmetic)
    uint flameTicks;  // as burnTicks, but thick fuel ends when it is consumed
    uint windowMax;   // largest correction window that its object may get, ticks
    uint air;         // Q8: wind gain of thick fuel's burning rate, 256 = still air
    uint holeTicks;   // ticks from ignition until it gives way (cosmetic); 0: never
};
FW_SIZE(BurnMaterial, 112)

struct TileState {
    uint wake;        // earliest pending arrival, ticks; kNever: none
    uint flag;
    uint lastChange;  // end tick of the last window that changed it
    uint object;      // object slot
};
FW_SIZE(TileState, 16)

struct IterationCounters {  // zeroed before a frame from kRowIteration on, except the carried list
    // Gathered rows: arrival, commit; X also covers runCount.
    uint workX; uint workY; uint workZ; uint workCount;
    uint rimX; uint rimY; uint rimZ; uint rimCount;     // gathered rim texels: arrival_rim
    uint runX; uint runY; uint runZ; uint runCount;     // indirect groups of gather, due tiles
    uint listX; uint listY; uint listZ; uint listCount; // indirect groups of schedule, and its size
};
FW_SIZE(IterationCounters, 64)

struct TexelEvent {   // sorted by (object, texel, order); one batch per step
    uint object;      // slot
    uint texel;       // index in the object's map; kNoneTexel: all texels, and
                      // then no other event of the step addresses one of them
    uint kind;
    uint tick;        // ignition: tick; wetting: g/m^2 of water; heat: W/m^2
};
FW_SIZE(TexelEvent, 16)

struct ObjectCounters {
    uint ignited;     // texels that are sources now: exact, updated by events and commit
    uint burning;     // texels that flame, as of the last reduce
    uint frontTiles;  // tiles of the front list, as of the last reduce
    uint lateClamps;  // total
    uint lastIgnition;  // end tick of the last window in which a texel caught
    uint burningTiles;  // as of the last reduce, plus tiles lit since
    uint energyLow;   // total heat released, 2^-20 J: exactly the loss of the texels' fuel
    uint energyHigh;  // 2^12 J
    // Spread from object to object: exchange.h.
    uint litBy;       // key of the object that lit it (see litBy()); 0: none yet
    uint litTick;     // tick at which the exchange found it alight; 0: not alight
    uint stopTick;    // tick from which its front stops; 0: never
    uint until;       // tick until which other objects may heat it
    uint held;        // kHeld bits of the last exchange
    uint spots;       // embers that lit it, total
    uint spotTexel;   // texel of one of them, | kSpotFresh
    uint refined;     // triangles of its refined surface
    uint air;         // burning strength in its room, Q8, | kAirKnown; 0: in no room
    uint drawnLow;    // part of its energy that its room has accounted for; unused without a room
    uint drawnHigh;
    uint playsUntil;  // plays a baked burn in steps that start before this tick: its front stops
};
FW_SIZE(ObjectCounters, 80)
FW_CONST uint kAirFull = 256u;
FW_CONST uint kAirKnown = 0x200u;
// Set for embers of the last exchange: the highest texel wins, so the order does not matter.
FW_CONST uint kSpotFresh = 0x80000000u;
FW_CONST uint kHeldByLimit = 1u;     // burning tiles are at their limit: no new tile catches
FW_CONST uint kHeldStopped = 2u;  // its lifetime is over
FW_CONST uint kHeldWarm = 4u;     // not held, but heated by others

// Heat that other objects send to a tile; a writer also adds the tile to the hot list.
struct TileHeat {
    uint flux;        // W/m^2, before the surface's absorption
    uint pilot;       // 1: a flame is near
};
FW_SIZE(TileHeat, 8)

struct ProbeAnswer {
    uint state;
    uint heatX; uint heatY;  // packed HeatTexel
    uint heat;        // 1: the object has heat
};
FW_SIZE(ProbeAnswer, 16)

struct BurnTile {     // one burning 8x8 tile, for flames and lights (cosmetic)
    vec4 positionArea;  // world m; flaming area m^2
    vec4 normalPower;   // world normal; W
    // Slot, local tile, flaming texels, mean age in ticks.
    uint object; uint tile; uint texels; uint age;
};
FW_SIZE(BurnTile, 48)

struct BurnLight {    // as FwLight
    vec4 positionRadius;
    vec4 colorIntensity;
    float power; uint id; // W that shine: old embers count less
    float release;        // W, total
    uint reserved;
};
FW_SIZE(BurnLight, 48)

struct StepPush {     // push constants of the simulation passes
    uint now;         // tick at the step's start; reduce, predict: tick after the last step
    uint stepShift;   // log2 of the step's iterations
    uint iteration;   // of the step
    uint row;         // counters row of the front list that is read (events, wake: appended to)
    uint parity;      // parity of that list: 0 = A
    uint burnParity;  // burn list that is read (other passes: appended to)
    uint predictParity;
    uint switches;    // FwDebugSwitch
    uint count;       // events, wake groups, probes or object slots
    uint object;      // reset, an extension's step: slot
    uint extensionParity;  // of the object's steps by an extension
    uint hotParity;   // hot list that is read (other passes: appended to)
    uint maxTiles;   // limit of the world's burning tiles, with kSwitchGoverned
    uint reserved0; uint reserved1; uint reserved2;
};
FW_SIZE(StepPush, 64)

FW_FN bool isSource(uint t) { return t < kLiveEnd; }
// Burning strength in this air (ObjectCounters::air), Q8.
FW_FN uint airStrength(uint air) {
    uint strength = air & 0x1FFu;
    return (air & kAirKnown) == 0u || strength > kAirFull ? kAirFull : strength;
}
FW_FN bool isReceptive(uint t) { return t == kNever || t == kOut; }
FW_FN bool isBarrier(uint t) { return t == kInert || t == kWet || t == kOutWet; }

FW_FN uint eventKind(uint kind) { return kind & ((1u << kEventKindBits) - 1u); }
FW_FN bool eventHasGates(uint kind) { return (kind >> kEventKindBits) != 0u; }

// A disturbance lowers `playsUntil` to the end of the step or exchange, so all work of one step
// sees the same value in any order.
FW_FN bool isPlayingBack(uint playsUntil, uint now) { return playsUntil > now; }
// The event's kind for an object that does or does not play back.
FW_FN uint playedKind(uint kind, uint playsUntil, uint now) {
    uint k = eventKind(kind);
    return k != kEventPlayback ? k : isPlayingBack(playsUntil, now) ? kEventIgnite : kEventGate;
}

// State of a texel after one event. now: start tick of the step.
FW_FN uint applyEvent(uint t, uint kind, uint tick, uint now) {
    if (kind == kEventIgnite)
        return (isReceptive(t) || (isSource(t) && tick < t && t > now)) ? tick : t;
    if (kind == kEventWet) {
        if (t == kNever) return kWet;
        return (isSource(t) || t == kOut) ? kOutWet : t;
    }
    if (kind == kEventDry) return t == kWet ? kNever : (t == kOutWet ? kOut : t);
    if (kind == kEventHeat || kind == kEventGate) return t;
    return isSource(t) ? kOut : t;  // extinguish
}

// ---- packed wind of the zones at an object: three times 10 bits, 1/4 m/s
FW_CONST uint kWindBits = 10u;
FW_CONST int kWindZero = 512;
FW_CONST int kMaxWind = 511;

// mm/s. A word of 0 is no wind.
FW_FN ivec3 unpackWind(uint word) {
    if (word == 0u) return ivec3(0, 0, 0);
    return ivec3((int(word & 1023u) - kWindZero) * 250,
                 (int((word >> 10u) & 1023u) - kWindZero) * 250,
                 (int((word >> 20u) & 1023u) - kWindZero) * 250);
}

FW_SHARED_END
#endif
