// Records and masks of particle fields.
#include "lib/compute.glsl"
#include "shared/field.h"
FW_READ(FIELDS) FW_READ(FIELD_RUNS) FW_READ(FIELD_MASKS) FW_READ_WRITE(FIELD_COUNTERS)
FW_PUSH(FieldPush)

uint fieldMask(uint cell) { return (masks[cell >> 2u] >> (8u * (cell & 3u))) & 255u; }
uint fieldCells(FieldRecord f, uint parity) { return 2u * f.cellBase + (parity & 1u) * f.cellRoom; }
