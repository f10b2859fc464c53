// The burn simulation's data as every backend and shader sees it: texel codes, records, lists,
// bindings. Times are ticks of 2^-12 s. Pure maths is in front.h.
// GLSL too, and laid out by hand.
// clang-format off
#ifndef FW_SHARED_BURN_H
#define FW_SHARED_BURN_H
#include "shared/types.h"

// Bindings of set 0, one number per resource in every pass. A pass's layout holds only what it uses.
#define FW_BIND_OBJECTS 0     // BurnObject[], by object slot
#define FW_BIND_MATERIALS 1   // BurnMaterial[], 8 per object slot
#define FW_BIND_TEXELS 2      // uvec2[]: position xyz u16, material | flags u16 (per mesh)
#define FW_BIND_NORMALS 3     // uint[]: signed 11:11:10 (per mesh)
#define FW_BIND_SLOWNESS 4    // uint[]: two u16 Q7 factors per word (per mesh or per object)
#define FW_BIND_LINKS 5       // uint[]: 8 texel indices per rim record (per mesh)
#define FW_BIND_READERS 6     // uint[]: tiles (per mesh)
#define FW_BIND_TILES 7       // TileStatic as 2 x uvec4 (per mesh)
#define FW_BIND_STATE 8       // uint[]: ignition tick or code (per object)
#define FW_BIND_TILE_STATE 9  // TileState[] (per object)
#define FW_BIND_LIST_A 10     // uint[]: front list, world tile ids (ping)
#define FW_BIND_LIST_B 11     // uint[]: front list (pong)
#define FW_BIND_RUN 12        // uvec4[]: due tiles: world tile, object, first texel + kRunWoken, mesh tile
#define FW_BIND_SCRATCH 13    // uint[]: gathered rows from its start (row, mask, texel, object), rim
                              // texels from its end (row * 8 + column); 96 words per due tile
#define FW_BIND_MASKS 14      // uvec4[]: texels changed (xy) and newly lit (zw) per due tile
#define FW_BIND_COUNTERS 15   // IterationCounters[], see the kRow constants
#define FW_BIND_EVENTS 16     // TexelEvent[]
#define FW_BIND_WAKE_GROUPS 17  // uvec2[]: object slot, first tile of 64
#define FW_BIND_OBJECT_COUNTERS 18  // ObjectCounters[]
#define FW_BIND_BURN_A 19     // uint[]: tiles that flame (ping)
#define FW_BIND_BURN_B 20     // uint[]: tiles that flame (pong)
#define FW_BIND_BURN_TILES 21 // BurnTile[]: what `reduce` says of each of them
#define FW_BIND_PREDICT 22    // uint[]: arrival ticks for looking at, ahead of the front too, or codes
#define FW_BIND_GRADIENT 23   // uint[]: gradient of the above, s/texel, and soot: lib/gradient.glsl;
                              // kOut, kOutWet: ticks that the texel had burnt when it was put out
#define FW_BIND_PREDICT_LIST_A 24
#define FW_BIND_PREDICT_LIST_B 25
#define FW_BIND_PROBES 26     // uvec2[]: object slot, texel
#define FW_BIND_ANSWERS 27    // ProbeAnswer[]: of each probe
#define FW_BIND_PUBLISHED 28  // float[]: 3 planes of an as-published object: S*D ping, pong, D
#define FW_BIND_LIGHTS 29     // BurnLight[]
#define FW_BIND_LIGHT_CELLS 30  // uint[]: hash grid of burning cells
#define FW_BIND_FLAMES 31     // FlameQuad[]
#define FW_BIND_DRAW_ARGS 32  // uint[]: indirect draw of the flames, their order; see kFlameOrder
#define FW_BIND_VIEW 33       // uniform ViewParams
#define FW_BIND_LOOKS 34      // MaterialLook[]
#define FW_BIND_HEAT 35       // uvec2[]: packed HeatTexel, of objects with kObjectHeat
#define FW_BIND_TILE_HEAT 36  // TileHeat[] (per object): what comes to a tile from elsewhere
#define FW_BIND_HEAT_MATERIALS 37  // HeatMaterial[], 8 per object slot
#define FW_BIND_HOT_LISTS 38  // uvec2[]: tiles whose heat changes, list A in x and B in y
#define FW_BIND_TILE_FIRE 39  // float[] (per object): W of a tile's thick fuel in the last heat step
#define FW_BIND_REMOTE_OBJECTS 40  // RemoteObject[], by object slot: see exchange.h
#define FW_BIND_REMOTE_TILES 41    // RemoteTile[] (per mesh)
#define FW_BIND_SOURCES 42    // FireSource[] (per object)
#define FW_BIND_NEIGHBOURS 43 // uint[]: object slot | what is seen of it, of 255, << 24
#define FW_BIND_CONTACTS 44   // ContactLink[]
#define FW_BIND_BLOCKERS 45   // Blocker[kMaxBlockers]
#define FW_BIND_RECEIVERS 46  // uint[kReceiverWords] per object slot, see there
#define FW_BIND_ROOMS 47      // Room[kMaxRooms]: see room.h
#define FW_BIND_SHOWN 48          // ShownVertex[]: drawn instead of the mesh's (per object); vertex input too
#define FW_BIND_DEFORM_NODES 49   // DeformNode[] (per mesh)
#define FW_BIND_DEFORM_COATS 50   // DeformCoat[] (per mesh)
#define FW_BIND_DEFORM_OBJECTS 51 // DeformObject[], by object slot
#define FW_BIND_DEFORM_GROUPS 52  // uvec2[]: object slot, first of 64 nodes or vertices
#define FW_BIND_SOFT 53           // vec4[]: 3 per shown vertex of a sheet: place, place, normal and bend
#define FW_BIND_ROOM_AIR 54          // RoomAir[kMaxRooms]
#define FW_BIND_SHIELD 55     // uint[]: the shield as words, see exchange.h
#define FW_BIND_SKIN_TEXELS 56    // uvec4[]: three vertices and two unorm16 weights per texel (per mesh)
#define FW_BIND_SKIN_SOURCES 57   // uint[]: per drawn vertex the host's (per mesh)
#define FW_BIND_SKIN_GIVEN 58     // uint[]: what hosts' vertex buffers held (per object)
#define FW_BIND_REFINE_WORK 60      // uint[]: what this frame refines, see kRefineWork... in refine.h
#define FW_BIND_REFINE_OBJECTS 61   // RefineObject[], by object slot
#define FW_BIND_REFINE_TRIANGLES 62 // RefineTriangle[] (per mesh)
#define FW_BIND_REFINE_EDGES 63     // RefineEdge[] (per mesh)
#define FW_BIND_REFINE_SLOTS 64     // RefineSlot[] (per mesh)
#define FW_BIND_REFINE_WORDS 65     // uint[]: the pattern table; per mesh: what each tile warms
#define FW_BIND_REFINE_ITEMS 66     // RefineLevel[]: edges, then interiors (per object)
#define FW_BIND_REFINE_HEAT 67      // uint[], as items: kRefineHeat...
#define FW_BIND_REFINE_LEVELS 68    // uvec2[], per triangle of an object: levels, first output triangle
#define FW_BIND_REFINE_VERTICES 69  // RefineVertex[], per slot of an object
#define FW_BIND_REFINE_INDICES 70   // uint[]: output triangles
#define FW_BIND_REFINE_DRAWS 71     // uint[]: indexed indirect draws, 8 per object slot
#define FW_BIND_PENDING 72    // uint[], as state: when a texel catches, and what `commit` writes; true
                              // of receptive texels beside a source, until something beside changes
#define FW_BIND_SETTLED 73    // uint[]: per row of eight texels, those that `arrival` found settled
#define FW_BIND_VERTICES 74   // mesh::RenderVertex[], as three uvec4 (per mesh)
#define FW_BIND_REFINE_CUTS 75      // vertices along holes (per object), see kRefineCut... in refine.h
#define FW_BIND_REFINE_CUT_DRAWS 76 // uint[]: indirect draws, 8 per object slot
#define FW_BIND_ARP_GROUPS 77       // uvec2[]: object slot, first of 64 slots or listed triangles
#define FW_BIND_ARP_LIST 78         // uint[]: drawn triangles of the published scheme, see arp.h
#define FW_BIND_VOLUMES 90          // VolumeFlame[]: volumetric flames of the frame, see volume_draw.h
#define FW_BIND_VOLUME_RAYS 91      // uint[]: marched flames of a view, see VolumeMarch in volume_draw.h
#define FW_BIND_VOLUME_WORK 92      // VolumeWork[]: what the probe found of each flame
#define FW_BIND_FIELDS 110          // FieldRecord[], by field slot: see field.h
#define FW_BIND_FIELD_CELLS 111     // uint[]: fieldCell, twice (per field)
#define FW_BIND_FIELD_MASKS 113     // uint[]: a byte per cell (per field)
#define FW_BIND_FIELD_COUNTERS 114  // FieldCounters[], by field slot
#define FW_BIND_FIELD_RUNS 115      // uvec2[]: field slot, number of the step; of steps also the unit << 16
#define FW_BIND_FIELD_SHOWN 116     // uint[]: what a cell shows in this frame (per field), see field_draw.h
#define FW_BIND_FIELD_DRAWS 117     // FieldDraw[]: fields that are shown
#define FW_BIND_SPARKS 119           // SparkSource[]: who throws sparks in the frame, see spark.h
#define FW_BIND_EMITTERS 120         // ParticleEmitter[]: fire emitters of the frame, see particle.h
#define FW_BIND_EMITTER_GROUPS 121   // uvec2[]: emitter, first slot of its ring that a group works on
#define FW_BIND_PARTICLES 122        // Particle[]: rings of emitters
#define FW_BIND_BOOKS 123            // uint[]: flipbooks, see book.h
#define FW_BIND_COUNT 124

FW_SHARED_BEGIN

FW_SHARED_CONST uint kNoneTexel = 0xFFFFFFFFu;
// Codes of a texel's state; below kLiveEnd it is an ignition tick (a source).
FW_SHARED_CONST uint kNever = 0xFFFFFFFFu;   // unburnt, receptive
FW_SHARED_CONST uint kInert = 0xFFFFFFFEu;   // cannot burn, or no texel: a barrier
FW_SHARED_CONST uint kWet = 0xFFFFFFFDu;     // unburnt, water film: a barrier
FW_SHARED_CONST uint kOut = 0xFFFFFFFCu;     // extinguished and dry: receptive
FW_SHARED_CONST uint kOutWet = 0xFFFFFFFBu;  // extinguished, water film: a barrier
FW_SHARED_CONST uint kLiveEnd = 0xFFFFFFF0u;

FW_SHARED_CONST uint kTicksPerSecond = 4096u;
FW_SHARED_CONST uint kStepTicks = 128u;      // 1/32 s
FW_SHARED_CONST uint kHeatSteps = 4u;        // steps from one heat step to the next
FW_SHARED_CONST uint kMaxSubsteps = 8u;
FW_SHARED_CONST uint kMaterialsPerObject = 8u;

FW_SHARED_CONST uint kTexelReal = 0x100u;    // as mesh::TexelFlag
FW_SHARED_CONST uint kTexelRim = 0x200u;

// BurnObject::flags
FW_SHARED_CONST uint kObjectLive = 1u;
FW_SHARED_CONST uint kObjectPublished = 2u;
FW_SHARED_CONST uint kObjectTwoSided = 4u;
FW_SHARED_CONST uint kObjectNoHoles = 8u;
FW_SHARED_CONST uint kObjectHidden = 16u;
FW_SHARED_CONST uint kObjectDetail = 32u;    // vertices carry detail coordinates
FW_SHARED_CONST uint kObjectHeat = 64u;      // has a heat plane
FW_SHARED_CONST uint kObjectNoDamage = 128u; // flames, and looks as before
FW_SHARED_CONST uint kObjectSkinned = 0x1000u; // its fire stands on its shown vertices
FW_SHARED_CONST uint kObjectZPass = 0x2000u;   // see passes/z_pass.cpp
FW_SHARED_CONST uint kObjectUnseen = 0x4000u;  // no view shows it: nothing is predicted of it
FW_SHARED_CONST uint kObjectShownAgain = 0x8000u; // one does again: its prediction starts from what burns
FW_SHARED_CONST uint kObjectRoomShift = 16u;   // 8 bits: the room that it is in, plus 1

// TileState::flag
FW_SHARED_CONST uint kTileListed = 1u;       // in the front list
FW_SHARED_CONST uint kTileTouched = 2u;      // an input changed: due now
FW_SHARED_CONST uint kTileNews = 0x80000u;   // so it is, but by texels that just caught, nothing else
FW_SHARED_CONST uint kTileUneven = 0x100000u; // of this run: a texel changed that did not just catch
FW_SHARED_CONST uint kTileBurning = 4u;      // in the burn list
FW_SHARED_CONST uint kTilePredict = 8u;      // in the predict list A; << 1: in B
FW_SHARED_CONST uint kTileAhead = 128u;      // `wake` may be another thing than a known arrival
FW_SHARED_CONST uint kTileHot = 32u;         // in the hot list
FW_SHARED_CONST uint kTileWarm = 64u;        // and takes every heat step, see heatTurn
// Cosmetic, of `support`: facts of the tile's texels, what it found, and its distance to a hold.
FW_SHARED_CONST uint kTileSidesShift = 8u;   // 4 bits: the tile beside goes on over that side
FW_SHARED_CONST uint kTileSpent = 0x1000u;   // all its texels burn or have burnt
FW_SHARED_CONST uint kTileGround = 0x2000u;
FW_SHARED_CONST uint kTileMaterialShift = 14u; // 3 bits
FW_SHARED_CONST uint kTileFacts = 0x1FF00u;
FW_SHARED_CONST uint kTileSolid = 0x20000u;
FW_SHARED_CONST uint kTileFalling = 0x40000u;
FW_SHARED_CONST uint kTileMarked = 0x200000u; // fire, heat, water or soot shows on it, or did: for good
FW_SHARED_CONST uint kTileDistanceShift = 22u; // 10 bits

// Rows of IterationCounters. The first are lists that live on; list*: indirect groups of 64 tiles
// (burn, hot) or of 8 (predict).
FW_SHARED_CONST uint kRowBurn = 0u;          // + parity of the burn list; run*: its BurnTiles / 64
FW_SHARED_CONST uint kRowPredict = 2u;       // + parity of the predict list
FW_SHARED_CONST uint kRowHot = 4u;           // + parity of the hot list
FW_SHARED_CONST uint kRowExchange = 6u;      // run*: receivers; list*: embers / 64
FW_SHARED_CONST uint kRowIteration = 7u;     // + iteration of the frame

// StepPush::switches, as FwDebugSwitch
FW_SHARED_CONST uint kSwitchDense = 1u;
FW_SHARED_CONST uint kSwitchShuffle = 2u;
FW_SHARED_CONST uint kSwitchNoSeamWake = 4u;
FW_SHARED_CONST uint kSwitchWrongReaders = 8u;
FW_SHARED_CONST uint kSwitchNoWindWake = 16u;
FW_SHARED_CONST uint kSwitchRefineFull = 64u;
FW_SHARED_CONST uint kSwitchCrossing = 128u;
FW_SHARED_CONST uint kSwitchNoZPass = 256u;
FW_SHARED_CONST uint kSwitchGoverned = 0x10000u;  // ours: some object or the world limits its fire
FW_SHARED_CONST uint kSwitchPlays = 0x80000u;     // ours: some object may play a baked burn
FW_SHARED_CONST uint kSwitchShows = 0x100000u;    // ours: `reduce` makes BurnTiles and nothing else

// TexelEvent::kind, as FwIgnitionKind
FW_SHARED_CONST uint kEventIgnite = 0u;
FW_SHARED_CONST uint kEventWet = 1u;
FW_SHARED_CONST uint kEventDry = 2u;
FW_SHARED_CONST uint kEventExtinguish = 3u;
FW_SHARED_CONST uint kEventHeat = 4u;  // ours: a flame blows on it for a heat step, if its gates let
                                       // it: the index of the first, plus 1, above kEventKindBits
// A texel that a flame came to on its way, after the batch's other events, in no order; changes
// nothing. tick: from ignition until it gives way.
FW_SHARED_CONST uint kEventGate = 5u;
// Of a baked burn: lights the texel if its object plays one. And when its object does (texel:
// kNoneTexel): from now on (tick: kNever), or until a tick at most.
FW_SHARED_CONST uint kEventPlay = 6u;
FW_SHARED_CONST uint kEventPlays = 7u;
// A texel takes over what has become of one of another object; tick: that texel. Its object's slot
// plus 1 stands above kEventKindBits. No other event of the step is of either object.
FW_SHARED_CONST uint kEventCarry = 8u;
FW_SHARED_CONST uint kEventKindBits = 8u;
FW_SHARED_CONST uint kGateShut = 0x100u;  // of a gate's kind: it must still stand, else be gone
FW_SHARED_CONST uint kGateMore = 0x200u;  // of a gate's kind: the next must let it too
FW_SHARED_CONST uint kGates = 2u;         // of an event at most

struct BurnObject {   // everything a pass needs to find an object's planes
    uint texelBase;   // into texels, normals (per mesh)
    uint stateBase;   // into state, predict, gradient; a multiple of 64
    uint slowBase;    // into slowness, in WORDS
    uint width;       // texels, a multiple of 8
    uint worldTileBase;  // into tileState; a world tile id = worldTileBase + local tile
    uint linkBase;    // into links, in records
    uint readerBase;  // into readers
    uint flags;
    uint tileBase;    // into tiles (per mesh)
    uint height;      // texels
    uint tilesX;
    uint tileCount;
    uint window;      // correction window, ticks
    uint substepShift;  // log2 of its substeps per step, 0..3
    uint horizon;     // ticks that the prediction looks ahead
    uint shownBase;   // into the shown vertices; with kObjectSkinned
    vec4 originQuantum;  // m: rest position = origin + quantum * xyz
    vec4 worldRow0;   // object to world, rows of a 3x4 matrix
    vec4 worldRow1;
    vec4 worldRow2;
    vec4 tint;        // rgb; w: mean texel area, m^2, world scale
    uint publishedBase;  // into published, as-published objects only
    uint heatBase;    // into heat; with kObjectHeat
    uint skinBase;    // into the skin texels; with kObjectSkinned
    uint zoneWind;    // that wind zones add where it is (looks): wind.h
};
FW_SHARED_SIZE(BurnObject, 160)

struct BurnMaterial { // integers of the spread law for one material on one object; see front.h
    uint sigma0;      // slowness at R0: Q22 ticks per 1/8 position unit
    uint headGain;    // Q8
    uint backGain;    // Q8
    uint driveMax;    // Q10
    uint breadthMax;  // Q8, largest back/head slowness ratio
    uint burnTicks;   // ticks a texel flames; kNoneTexel: without end
    uint ceiling;     // Q8 speed-up of a surface that faces down
    uint look;        // row of the looks table
    int driveX;       // Q10, object space: windGain * wind + upGain * up
    int driveY;
    int driveZ;
    uint flags;       // 1: can burn
    float powerPerArea;  // W/m^2 while it flames (looks, lights, queries)
    float timeScale;  // look seconds per second: pace and spread rate against the look's own
    float thickness;  // m
    float roughness;
    vec4 baseColor;   // linear albedo; w: ticks after ignition when nothing is left to see
    uvec4 upCeiling;  // xyz: up in object space as int Q10 bits; w: what lies no higher, in these
                      // units times position units, is on the ground (looks)
    uint flameTicks;  // as burnTicks, but thick fuel ends too: when it is consumed
    uint windowMax;   // the largest correction window its object may ever have, ticks
    uint air;         // Q8: what the wind makes of thick fuel's burning rate, 256 = still air
    uint holeTicks;   // ticks after ignition when it gives way (looks); 0: never
};
FW_SHARED_SIZE(BurnMaterial, 112)

struct TileState {
    uint wake;        // earliest pending arrival, ticks; kNever: none
    uint flag;
    uint lastChange;  // end tick of the last window that changed it
    uint object;      // object slot
};
FW_SHARED_SIZE(TileState, 16)

struct IterationCounters {  // zeroed before a frame from kRowIteration on, but for the carried list
    uint workX; uint workY; uint workZ; uint workCount; // gathered rows: arrival, commit: X covers
                                                        // runCount too
    uint rimX; uint rimY; uint rimZ; uint rimCount;     // gathered rim texels: arrival_rim
    uint runX; uint runY; uint runZ; uint runCount;     // indirect groups of gather, due tiles
    uint listX; uint listY; uint listZ; uint listCount; // indirect groups of schedule, and its size
};
FW_SHARED_SIZE(IterationCounters, 64)

struct TexelEvent {   // sorted by (object, texel, order); one batch per step
    uint object;      // slot
    uint texel;       // index in the object's map; kNoneTexel: all of its texels, and then no
                      // other event of the step is of one of them
    uint kind;
    uint tick;        // of an ignition; of a wetting: g/m^2 of water; of heat: W/m^2
};
FW_SHARED_SIZE(TexelEvent, 16)

struct ObjectCounters {
    uint ignited;     // texels that are sources now: exact, kept by events and commit
    uint burning;     // of the last reduce: texels that flame
    uint frontTiles;  // of the last reduce: tiles of the front list
    uint lateClamps;  // since ever
    uint lastIgnition;  // end tick of the last window in which a texel caught
    uint burningTiles;  // of the last reduce, and those that caught since
    uint energyLow;   // heat released since ever, 2^-20 J: exactly what its texels' fuel lost
    uint energyHigh;  // 2^12 J
    // Spread from object to object: exchange.h.
    uint litBy;       // who lit it; 0: nobody yet
    uint litTick;     // at which it was found alight; 0: it is not
    uint stopTick;    // from here on its front stands; 0: never
    uint until;       // tick until which it may be warmed by others
    uint held;        // kHeld bits of the last exchange
    uint spots;       // embers that lit it, since ever
    uint spotTexel;   // one of those texels, | kSpotFresh
    uint refined;     // triangles that its refined surface has
    uint air;         // of its room: how strongly fire burns there, Q8, | kAirKnown; 0: it is in none
    uint drawnLow;    // of its energy, that its room has accounted for; of no account in none
    uint drawnHigh;
    uint playsUntil;  // it plays a baked burn in steps that begin before: its front stands
};
FW_SHARED_SIZE(ObjectCounters, 80)
FW_SHARED_CONST uint kAirFull = 256u;
FW_SHARED_CONST uint kAirKnown = 0x200u;
// Lit in the last exchange: of its embers the highest texel counts, in whatever order they come down.
FW_SHARED_CONST uint kSpotFresh = 0x80000000u;
FW_SHARED_CONST uint kHeldFull = 1u;     // as many tiles burn as may: no other one catches
FW_SHARED_CONST uint kHeldStopped = 2u;  // its time is over
FW_SHARED_CONST uint kHeldWarm = 4u;     // not held, but warmed by others

struct TileHeat {     // of one tile, W/m^2 and flags; whoever writes one also puts its tile on the
    uint flux;        // hot list. From elsewhere, before what the surface absorbs of it.
    uint pilot;       // 1: a flame is near
};
FW_SHARED_SIZE(TileHeat, 8)

struct ProbeAnswer {
    uint state;
    uint heatX; uint heatY;  // packed HeatTexel
    uint heat;        // 1: its object has heat
};
FW_SHARED_SIZE(ProbeAnswer, 16)

struct BurnTile {     // one burning 8x8 tile, for flames and lights (cosmetic)
    vec4 positionArea;  // world m; flaming area m^2
    vec4 normalPower;   // world normal; W
    uint object; uint tile; uint texels; uint age;  // slot, local tile, flaming texels, mean age ticks
};
FW_SHARED_SIZE(BurnTile, 48)

struct BurnLight {    // as FwLight
    vec4 positionRadius;
    vec4 colorIntensity;
    float power; uint id; // W of what shines: old embers count less
    float release;        // W, all
    uint reserved;
};
FW_SHARED_SIZE(BurnLight, 48)

struct StepPush {     // push constants of the simulation passes
    uint now;         // tick at the step's start; reduce, predict: tick after the last step
    uint stepShift;   // log2 of the step's iterations
    uint iteration;   // of the step
    uint row;         // counters row of the front list that is read (events, wake: appended to)
    uint parity;      // of that list: 0 = A
    uint burnParity;  // of the burn list that is read (others: appended to)
    uint predictParity;
    uint switches;    // FwDebugSwitch
    uint count;       // events, wake groups, probes or object slots
    uint object;      // reset, published: slot
    uint publishedParity;  // plane that is read
    uint hotParity;   // of the hot list that is read (others: appended to)
    uint tilesMost;   // of the world, with kSwitchGoverned: none more catches while so many burn
    uint reserved0; uint reserved1; uint reserved2;
};
FW_SHARED_SIZE(StepPush, 64)

FW_SHARED_FN bool isSource(uint t) { return t < kLiveEnd; }
// How strongly fire burns in this air (ObjectCounters), Q8.
FW_SHARED_FN uint airStrength(uint air) {
    uint strength = air & 0x1FFu;
    return (air & kAirKnown) == 0u || strength > kAirFull ? kAirFull : strength;
}
FW_SHARED_FN bool isReceptive(uint t) { return t == kNever || t == kOut; }
FW_SHARED_FN bool isBarrier(uint t) { return t == kInert || t == kWet || t == kOutWet; }

FW_SHARED_FN uint eventKind(uint kind) { return kind & ((1u << kEventKindBits) - 1u); }
FW_SHARED_FN bool hasGates(uint kind) { return (kind >> kEventKindBits) != 0u; }

// Who disturbs an object lowers `playsUntil` to the end of the step, or of the exchange: so all that
// happens in a step sees the same, in whatever order.
FW_SHARED_FN bool playsAt(uint playsUntil, uint now) { return playsUntil > now; }
// What an event is to an object that does so, or does not.
FW_SHARED_FN uint playedKind(uint kind, uint playsUntil, uint now) {
    uint k = eventKind(kind);
    return k != kEventPlay ? k : playsAt(playsUntil, now) ? kEventIgnite : kEventGate;
}

// What one event makes of one texel. `now`: start tick of the step that applies it.
FW_SHARED_FN uint applyEvent(uint t, uint kind, uint tick, uint now) {
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

FW_SHARED_END
#endif
