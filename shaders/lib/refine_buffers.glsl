// Buffers of the refinement passes. A shader defines FW_USE_<NAME> as the access it needs before it
// includes this. One list entry is one workgroup's share.
#ifndef FW_LIB_REFINE_BUFFERS_GLSL
#define FW_LIB_REFINE_BUFFERS_GLSL
#include "shared/burn.h"
#include "shared/refine.h"

#define FW_READ_WRITE
#define FW_BUFFER(number, access, block, type, name) \
    layout(std430, set = 0, binding = number) access buffer block { type name[]; }

#ifdef FW_USE_WORK
FW_BUFFER(FW_BIND_REFINE_WORK, FW_USE_WORK, RefineWorkBuffer, uint, work);
#endif
FW_BUFFER(FW_BIND_REFINE_OBJECTS, readonly, RefineObjectsBuffer, RefineObject, refined);
#ifdef FW_USE_WORDS
FW_BUFFER(FW_BIND_REFINE_WORDS, FW_USE_WORDS, RefineWordsBuffer, uint, words);
uint tableToken(uint entry) { return (words[entry >> 1u] >> (16u * (entry & 1u))) & 0xFFFFu; }
#endif
#ifdef FW_USE_TRIANGLES
FW_BUFFER(FW_BIND_REFINE_TRIANGLES, FW_USE_TRIANGLES, RefineTrianglesBuffer, RefineTriangle, triangles);
#endif
#ifdef FW_USE_EDGES
FW_BUFFER(FW_BIND_REFINE_EDGES, FW_USE_EDGES, RefineEdgesBuffer, RefineEdge, edges);
#endif
#ifdef FW_USE_SLOTS
FW_BUFFER(FW_BIND_REFINE_SLOTS, FW_USE_SLOTS, RefineSlotsBuffer, RefineSlot, slots);
#endif
#ifdef FW_USE_ITEMS
FW_BUFFER(FW_BIND_REFINE_ITEMS, FW_USE_ITEMS, RefineItemsBuffer, RefineLevel, items);
#endif
#ifdef FW_USE_HEAT
FW_BUFFER(FW_BIND_REFINE_HEAT, FW_USE_HEAT, RefineHeatBuffer, uint, heat);
#endif
#ifdef FW_USE_LEVELS
FW_BUFFER(FW_BIND_REFINE_LEVELS, FW_USE_LEVELS, RefineLevelsBuffer, uvec2, levels);
#endif
#ifdef FW_USE_VERTICES
FW_BUFFER(FW_BIND_REFINE_VERTICES, FW_USE_VERTICES, RefineVerticesBuffer, RefineVertex, vertices);
#endif
#ifdef FW_USE_INDICES
FW_BUFFER(FW_BIND_REFINE_INDICES, FW_USE_INDICES, RefineIndicesBuffer, uint, indices);
#endif
#ifdef FW_USE_DRAWS
FW_BUFFER(FW_BIND_REFINE_DRAWS, FW_USE_DRAWS, RefineDrawsBuffer, uint, draws);
#endif
#ifdef FW_USE_MESH_VERTICES
FW_BUFFER(FW_BIND_VERTICES, FW_USE_MESH_VERTICES, MeshVerticesBuffer, uvec4, meshVertices);
#endif
#ifdef FW_USE_CUTS
FW_BUFFER(FW_BIND_REFINE_CUTS, FW_USE_CUTS, RefineCutsBuffer, uvec4, cuts);
FW_BUFFER(FW_BIND_REFINE_CUT_DRAWS, FW_USE_CUTS, RefineCutDrawsBuffer, uint, cutDraws);
#endif
#ifdef FW_USE_OBJECT_COUNTERS
FW_BUFFER(FW_BIND_OBJECT_COUNTERS, FW_USE_OBJECT_COUNTERS, ObjectCountersBuffer, ObjectCounters, objectCounters);
#endif
#ifdef FW_USE_PREDICT
FW_BUFFER(FW_BIND_PREDICT, FW_USE_PREDICT, PredictBuffer, uint, predict);
FW_BUFFER(FW_BIND_GRADIENT, FW_USE_PREDICT, GradientBuffer, uint, gradient);
#endif
#ifdef FW_USE_PATTERN
#include "shared/reference_pattern.h"
FW_BUFFER(FW_BIND_PATTERN_GROUPS, readonly, PatternGroupsBuffer, uvec2, groups);
FW_BUFFER(FW_BIND_PATTERN_LIST, readonly, PatternListBuffer, uint, patternList);
layout(push_constant) uniform Push { PatternPush push; };
#else
layout(push_constant) uniform Push { RefinePush push; };

const uint kMaxGroups = 65535u;  // of a dispatch; the rest is strided over

uint edgeList() { return kRefineWorkLists; }
uint triangleList() { return edgeList() + 2u * push.edgeGroups; }
uint cornerList() { return triangleList() + 2u * push.triangleGroups; }
uint morphJobs() { return push.placeJobs + ((push.cutJobs - push.placeJobs) >> 1u); }
uint edgeJobs() { return push.cutJobs + ((push.cutJobs - push.placeJobs) >> 1u); }
uint objectList() { return cornerList() + 2u * push.cornerGroups; }
// Per object of the list: cut triangles of each material, then the first that exceeds the capacity.
uint cutCounts(uint ordinal) { return objectList() + 2u * push.objects + 16u * ordinal; }
#endif
#endif
