// Storage buffers of the refinement passes, of one object. A shader defines FW_USE_<NAME> as the
// access it needs before it includes this; only those are declared.
#ifndef FW_LIB_REFINE_BUFFERS_GLSL
#define FW_LIB_REFINE_BUFFERS_GLSL
#include "shared/refine.h"

#define FW_READ_WRITE
#define FW_BUFFER(number, access, block, type, name) \
    layout(std430, set = 0, binding = number) access buffer block { type name[]; }

#ifdef FW_USE_TABLE
FW_BUFFER(FW_REFINE_BIND_TABLE, FW_USE_TABLE, TableBuffer, uint, table);
uint tableToken(uint entry) { return (table[entry >> 1u] >> (16u * (entry & 1u))) & 0xFFFFu; }
#endif
#ifdef FW_USE_TRIANGLES
FW_BUFFER(FW_REFINE_BIND_TRIANGLES, FW_USE_TRIANGLES, TrianglesBuffer, RefineTriangle, triangles);
#endif
#ifdef FW_USE_EDGES
FW_BUFFER(FW_REFINE_BIND_EDGES, FW_USE_EDGES, EdgesBuffer, RefineEdge, edges);
#endif
#ifdef FW_USE_SLOTS
FW_BUFFER(FW_REFINE_BIND_SLOTS, FW_USE_SLOTS, SlotsBuffer, RefineSlot, slots);
#endif
#ifdef FW_USE_HEAT
FW_BUFFER(FW_REFINE_BIND_HEAT, FW_USE_HEAT, HeatBuffer, uint, heat);
#endif
#ifdef FW_USE_ITEMS
FW_BUFFER(FW_REFINE_BIND_ITEMS, FW_USE_ITEMS, ItemsBuffer, RefineLevel, items);
#endif
#ifdef FW_USE_LEVELS
FW_BUFFER(FW_REFINE_BIND_LEVELS, FW_USE_LEVELS, LevelsBuffer, uint, levels);
#endif
#ifdef FW_USE_SUMS
FW_BUFFER(FW_REFINE_BIND_SUMS, FW_USE_SUMS, SumsBuffer, uint, sums);
#endif
#ifdef FW_USE_STARTS
FW_BUFFER(FW_REFINE_BIND_STARTS, FW_USE_STARTS, StartsBuffer, uint, starts);
#endif
#ifdef FW_USE_INDICES
FW_BUFFER(FW_REFINE_BIND_INDICES, FW_USE_INDICES, IndicesBuffer, uint, indices);
#endif
#ifdef FW_USE_VERTICES
FW_BUFFER(FW_REFINE_BIND_VERTICES, FW_USE_VERTICES, VerticesBuffer, RefineVertex, vertices);
#endif
#ifdef FW_USE_TICKS
FW_BUFFER(FW_REFINE_BIND_TICKS, FW_USE_TICKS, TicksBuffer, uint, ticks);
#endif
layout(std430, set = 0, binding = FW_REFINE_BIND_FRAME) readonly buffer FrameBuffer {
    RefineFrameParams frame;
};
layout(push_constant) uniform Push { uint phase; } push;
#endif
