// Storage buffers of set 0. A shader includes the headers of the records, then declares the buffers
// that it uses by the names of their bindings (shared/burn.h): FW_READ(STATE), FW_WRITE(MASKS).
//
// *_WORDS and *_QUADS are the same buffers by words or by four: a software device loads four words
// at once for little more than one, and pays for every load, taken or not. It also runs a loop's
// text until no lane is left, and a `for` finds that out one turn late: hot loops are `do`,
// `while`.
#ifndef FW_LIB_BUFFERS_GLSL
#define FW_LIB_BUFFERS_GLSL

#define FW_BOTH
#define FW_READ(buffer) FW_BUFFER_##buffer(readonly)
#define FW_WRITE(buffer) FW_BUFFER_##buffer(writeonly)
#define FW_READ_WRITE(buffer) FW_BUFFER_##buffer(FW_BOTH)
#define FW_COHERENT(buffer) FW_BUFFER_##buffer(coherent)
#define FW_BUFFER(number, access, type, name) \
    layout(std430, set = 0, binding = FW_BIND_##number) access buffer name##Buffer { type name[]; };
#define FW_UNIFORM(number, type, name) \
    layout(std140, set = 0, binding = FW_BIND_##number) uniform number##Block { type name; };
// The buffer's words by four, through a texel buffer.
#define FW_TEXEL_BUFFER(number, access, name) \
    layout(rgba32ui, set = 0, binding = FW_BIND_COUNT + FW_BIND_##number) \
        access uniform uimageBuffer name;

// Simulation.
#define FW_BUFFER_OBJECTS(access) FW_BUFFER(OBJECTS, access, BurnObject, objects)
#define FW_BUFFER_MATERIALS(access) FW_BUFFER(MATERIALS, access, BurnMaterial, materials)
#define FW_BUFFER_TEXELS(access) FW_BUFFER(TEXELS, access, uvec2, texels)
#define FW_BUFFER_NORMALS(access) FW_BUFFER(NORMALS, access, uint, normals)
#define FW_BUFFER_SLOWNESS(access) FW_BUFFER(SLOWNESS, access, uint, slowness) \
    uint slownessAt(uint base, uint texel) { \
        return (slowness[base + (texel >> 1u)] >> ((texel & 1u) * 16u)) & 0xFFFFu; \
    }
#define FW_BUFFER_LINK_QUADS(access) FW_BUFFER(LINKS, access, uvec4, linkQuads)
#define FW_BUFFER_DEPENDENTS(access) FW_BUFFER(DEPENDENTS, access, uint, dependents)
// Two words of four per tile: seam mask, dependents' start and count; rim mask, rim base, unused.
#define FW_BUFFER_TILES(access) FW_BUFFER(TILES, access, uvec4, tiles)
// rimOfRow: those texels of a row of eight that have a ring record.
#define FW_BUFFER_TILE_WORDS(access) FW_BUFFER(TILES, access, uint, tileWords) \
    uint rimOfRow(uint tile, uint row) { \
        return (tileWords[tile * 8u + 4u + (row >> 2u)] >> ((row & 3u) * 8u)) & 0xFFu; \
    }
#define FW_BUFFER_STATE(access) FW_BUFFER(STATE, access, uint, state)
#define FW_BUFFER_STATE_QUADS(access) FW_BUFFER(STATE, access, uvec4, stateQuads)
#define FW_BUFFER_PENDING(access) FW_BUFFER(PENDING, access, uint, pendingTick)
#define FW_BUFFER_PENDING_QUADS(access) FW_BUFFER(PENDING, access, uvec4, pendingQuads)
#define FW_BUFFER_SETTLED(access) FW_BUFFER(SETTLED, access, uint, settledRows)
#define FW_BUFFER_TILE_STATE(access) FW_BUFFER(TILE_STATE, access, TileState, tileState)
#define FW_BUFFER_FRONT_LISTS(access) FW_BUFFER(FRONT_LISTS, access, uint, frontLists)
// World tile; object; its first texel in the object's map, a multiple of eight, + kRun bits; its
// row of `tiles`.
#define FW_BUFFER_RUN(access) FW_BUFFER(RUN, access, uvec4, run)
const uint kRunWoken = 1u;  // due because a known arrival is: nothing else has changed
const uint kRunLitBeside = 2u;   // due because texels just caught: settled ones need no run
const uint kRunBits = 3u;
// rimItem: word of rim texel `i` of an iteration: its gathered row * 8 + its column.
#define FW_BUFFER_SCRATCH(access) FW_BUFFER(SCRATCH, access, uint, scratch) \
    uint rimItem(uint i) { return uint(scratch.length()) - 1u - i; }
// A gathered row: (run slot * 8 + row, chosen texels | changed ones << 8, first texel, object). Of
// the prediction: (world tile * 8 + row, chosen texels | changed ones << 8 | wet ones << 16, first
// texel, object). The scratch's end lists rim texels, see rimItem.
#define FW_BUFFER_SCRATCH_QUADS(access) FW_BUFFER(SCRATCH, access, uvec4, scratchQuads)
#define FW_BUFFER_MASKS(access) FW_BUFFER(MASKS, access, uvec4, masks)
#define FW_BUFFER_MASK_WORDS(access) FW_BUFFER(MASKS, access, uint, maskWords)
#define FW_BUFFER_COUNTERS(access) FW_BUFFER(COUNTERS, access, IterationCounters, counters)
#define FW_BUFFER_EVENTS(access) FW_BUFFER(EVENTS, access, TexelEvent, events)
#define FW_BUFFER_WAKE_GROUPS(access) FW_BUFFER(WAKE_GROUPS, access, uvec2, wakeGroups)
#define FW_BUFFER_OBJECT_COUNTERS(access) \
    FW_BUFFER(OBJECT_COUNTERS, access, ObjectCounters, objectCounters)
#define FW_BUFFER_BURN_LISTS(access) FW_BUFFER(BURN_LISTS, access, uint, burnLists)
#define FW_BUFFER_BURN_TILES(access) FW_BUFFER(BURN_TILES, access, BurnTile, burnTiles)
#define FW_BUFFER_PREDICT(access) FW_BUFFER(PREDICT, access, uint, predict)
#define FW_BUFFER_PREDICT_QUADS(access) FW_BUFFER(PREDICT, access, uvec4, predictQuads)
#define FW_BUFFER_GRADIENT(access) FW_BUFFER(GRADIENT, access, uint, gradient)
#define FW_BUFFER_PREDICT_LISTS(access) FW_BUFFER(PREDICT_LISTS, access, uint, predictLists)
#define FW_BUFFER_PROBES(access) FW_BUFFER(PROBES, access, uvec2, probes)
#define FW_BUFFER_ANSWERS(access) FW_BUFFER(ANSWERS, access, ProbeAnswer, answers)
#define FW_BUFFER_HEAT(access) FW_BUFFER(HEAT, access, uvec2, heat)
#define FW_BUFFER_HEAT_PAIRS(access) FW_BUFFER(HEAT, access, uvec4, heatPairs)  // two texels each
#define FW_BUFFER_TILE_HEAT(access) FW_BUFFER(TILE_HEAT, access, TileHeat, tileHeat)
#define FW_BUFFER_HOT_LISTS(access) FW_BUFFER(HOT_LISTS, access, uint, hotLists)
#define FW_BUFFER_TILE_FIRE(access) FW_BUFFER(TILE_FIRE, access, float, tileFire)
#define FW_BUFFER_SKIN_TEXELS(access) FW_BUFFER(SKIN_TEXELS, access, uvec4, skinTexels)

// Exchange.
#define FW_BUFFER_EXCHANGE_OBJECTS(access) \
    FW_BUFFER(EXCHANGE_OBJECTS, access, ExchangeObject, exchangeObjects)
#define FW_BUFFER_EXCHANGE_TILES(access) \
    FW_BUFFER(EXCHANGE_TILES, access, ExchangeTile, exchangeTiles)
#define FW_BUFFER_SOURCES(access) FW_BUFFER(SOURCES, access, FireSource, sources)
#define FW_BUFFER_NEIGHBOURS(access) FW_BUFFER(NEIGHBOURS, access, uint, neighbours)
#define FW_BUFFER_CONTACTS(access) FW_BUFFER(CONTACTS, access, ContactLink, contacts)
#define FW_BUFFER_HEAT_OCCLUDERS(access) FW_BUFFER(HEAT_OCCLUDERS, access, HeatOccluder, occluders)
#define FW_BUFFER_HEAT_OCCLUSION(access) FW_BUFFER(HEAT_OCCLUSION, access, uint, occlusion)
#define FW_BUFFER_RECEIVERS(access) FW_BUFFER(RECEIVERS, access, uint, receivers)
#define FW_BUFFER_ROOMS(access) FW_BUFFER(ROOMS, access, Room, rooms)
#define FW_BUFFER_ROOM_AIR(access) FW_BUFFER(ROOM_AIR, access, RoomAir, roomAir)

// Refinement. One list entry of the work buffer is one workgroup's share.
#define FW_BUFFER_REFINE_WORK(access) FW_BUFFER(REFINE_WORK, access, uint, work)
#define FW_BUFFER_REFINE_OBJECTS(access) FW_BUFFER(REFINE_OBJECTS, access, RefineObject, refined)
#define FW_BUFFER_REFINE_WORDS(access) FW_BUFFER(REFINE_WORDS, access, uint, words) \
    uint tableToken(uint entry) { return (words[entry >> 1u] >> (16u * (entry & 1u))) & 0xFFFFu; }
#define FW_BUFFER_REFINE_TRIANGLES(access) \
    FW_BUFFER(REFINE_TRIANGLES, access, RefineTriangle, triangles)
#define FW_BUFFER_REFINE_EDGES(access) FW_BUFFER(REFINE_EDGES, access, RefineEdge, edges)
#define FW_BUFFER_REFINE_SLOTS(access) FW_BUFFER(REFINE_SLOTS, access, RefineSlot, slots)
#define FW_BUFFER_REFINE_ITEMS(access) FW_BUFFER(REFINE_ITEMS, access, RefineLevel, items)
#define FW_BUFFER_REFINE_HEAT(access) FW_BUFFER(REFINE_HEAT, access, uint, heat)
#define FW_BUFFER_REFINE_LEVELS(access) FW_BUFFER(REFINE_LEVELS, access, uvec2, levels)
#define FW_BUFFER_REFINE_VERTICES(access) FW_BUFFER(REFINE_VERTICES, access, RefineVertex, vertices)
#define FW_BUFFER_REFINE_INDICES(access) FW_BUFFER(REFINE_INDICES, access, uint, indices)
#define FW_BUFFER_REFINE_DRAWS(access) FW_BUFFER(REFINE_DRAWS, access, uint, draws)
#define FW_BUFFER_REFINE_CUTS(access) FW_BUFFER(REFINE_CUTS, access, uvec4, cuts)
#define FW_BUFFER_REFINE_CUT_DRAWS(access) FW_BUFFER(REFINE_CUT_DRAWS, access, uint, cutDraws)
#define FW_BUFFER_VERTICES(access) FW_BUFFER(VERTICES, access, uvec4, meshVertices)

// Effects.
#define FW_BUFFER_APPEARANCES(access) \
    FW_BUFFER(APPEARANCES, access, MaterialAppearance, appearances)
#define FW_BUFFER_LIGHTS(access) FW_BUFFER(LIGHTS, access, BurnLight, lights)
#define FW_BUFFER_CLUSTERS(access) FW_BUFFER(CLUSTERS, access, uint, clusters)
#define FW_BUFFER_FLAMES(access) FW_BUFFER(FLAMES, access, FlameQuad, flameQuad)
#define FW_BUFFER_DRAW_ARGS(access) FW_BUFFER(DRAW_ARGS, access, uint, drawArgs)
#define FW_BUFFER_FLIPBOOKS(access) FW_BUFFER(FLIPBOOKS, access, uint, flipbooks)
#define FW_BUFFER_EMITTERS(access) FW_BUFFER(EMITTERS, access, ParticleEmitter, emitters)
#define FW_BUFFER_EMITTER_GROUPS(access) FW_BUFFER(EMITTER_GROUPS, access, uvec2, groups)
#define FW_BUFFER_PARTICLES(access) FW_BUFFER(PARTICLES, access, ParticleWords, particles)
#define FW_BUFFER_SPARKS(access) FW_BUFFER(SPARKS, access, SparkSource, sources)
#define FW_BUFFER_FIELDS(access) FW_BUFFER(FIELDS, access, FieldRecord, fields)
#define FW_BUFFER_FIELD_RUNS(access) FW_BUFFER(FIELD_RUNS, access, uvec2, runs)
#define FW_BUFFER_FIELD_CELLS(access) FW_BUFFER(FIELD_CELLS, access, uint, cells)
#define FW_BUFFER_FIELD_QUADS(access) FW_BUFFER(FIELD_CELLS, access, uvec4, quads)
#define FW_BUFFER_FIELD_MASKS(access) FW_BUFFER(FIELD_MASKS, access, uint, masks)
#define FW_BUFFER_FIELD_COUNTERS(access) FW_BUFFER(FIELD_COUNTERS, access, FieldCounters, counters)
#define FW_BUFFER_FIELD_SHOWN(access) FW_BUFFER(FIELD_SHOWN, access, uint, shown)
#define FW_BUFFER_FIELD_DRAWS(access) FW_BUFFER(FIELD_DRAWS, access, FieldDraw, draws)
#define FW_BUFFER_BODIES(access) FW_BUFFER(BODIES, access, FlameBody, bodies)
#define FW_BUFFER_FLAME_CELLS(access) FW_BUFFER(FLAME_CELLS, access, uint, flameCells)
#define FW_BUFFER_BODY_OF(access) FW_BUFFER(BODY_OF, access, uint, bodyOf)
#define FW_BUFFER_BODY_CELLS(access) FW_BUFFER(BODY_CELLS, access, uint, bodyCells)
#define FW_BUFFER_VOLUME_RAYS(access) FW_BUFFER(VOLUME_RAYS, access, uint, rays)
#define FW_BUFFER_VOLUME_WORK(access) FW_BUFFER(VOLUME_WORK, access, VolumeWork, work)
#endif
