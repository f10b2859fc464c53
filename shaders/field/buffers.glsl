// Buffers of particle fields. A shader defines FW_FIELD_<NAME> as the access it needs before it
// includes this.
#ifndef FW_FIELD_BUFFERS_GLSL
#define FW_FIELD_BUFFERS_GLSL
#include "shared/burn.h"
#include "shared/field.h"

layout(std430, set = 0, binding = FW_BIND_FIELDS) readonly buffer FieldsBuffer {
    FieldRecord fields[];
};
#ifdef FW_FIELD_RUNS
layout(std430, set = 0, binding = FW_BIND_FIELD_RUNS) readonly buffer FieldRunsBuffer {
    uvec2 runs[];  // slot, number of the step
};
#endif
#ifdef FW_FIELD_CELLS
layout(std430, set = 0, binding = FW_BIND_FIELD_CELLS) FW_FIELD_CELLS buffer FieldCellsBuffer {
    uint cells[];  // fieldCell
};
#endif
#ifdef FW_FIELD_MASKS
layout(std430, set = 0, binding = FW_BIND_FIELD_MASKS) readonly buffer FieldMasksBuffer {
    uint masks[];  // a byte per cell
};
uint fieldMask(uint cell) { return (masks[cell >> 2u] >> (8u * (cell & 3u))) & 255u; }
#endif
#ifdef FW_FIELD_COUNTERS
layout(std430, set = 0, binding = FW_BIND_FIELD_COUNTERS) FW_FIELD_COUNTERS buffer
    FieldCountersBuffer {
    FieldCounters counters[];
};
#endif
uint fieldCells(FieldRecord f, uint parity) { return 2u * f.cellBase + (parity & 1u) * f.cellRoom; }
#endif
