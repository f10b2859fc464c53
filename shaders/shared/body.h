// The fire of a burning object as one body: each cell of its mesh (mesh::BurnDomain::flameCells)
// has the flame of the texels that burn in it. Their gas adds up, and fire stands where there is
// enough of it: flames side by side melt into one, and a dying flame sinks into its surface.
// clang-format off
#ifndef FW_SHARED_BODY_H
#define FW_SHARED_BODY_H
#include "shared/types.h"

FW_SHARED_BEGIN

FW_CONST uint kMaxBodies = 96u;        // of a world, in a frame
FW_CONST uint kBodyCells = 384u;       // of a body, at most
FW_CONST uint kBodyCellWords = 12u;    // see body_cells
FW_CONST uint kBodyCellUnits = 256u;   // of a place, per side of a cell
FW_CONST uint kBodyFlameWords = 20u;   // see body_flames
FW_CONST uint kBodyMaskWords = kBodyCells / 32u;
FW_CONST uint kBodyNodes = 9u;         // of a tile: 3 x 3, every fourth march pixel
FW_CONST uint kBodyNodeWords = 4u;     // per slab: eight half floats, see body_field
FW_CONST uint kBodyWords = kBodyCells * kBodyFlameWords;  // of a body, before its nodes

struct FlameBody {       // of one object in one frame
    vec4 low;            // m, object space: corner of its box; w: m, side of a cell
    uint object;         // slot
    uint cells;
    uint reserved0; uint reserved1;
};
FW_SIZE(FlameBody, 32)

// A flame's gas at its foot is e^kBodyFoot times what burns, and falls by as much over its height.
FW_CONST float kBodyFoot = 2.5f;
FW_CONST float kBodyNarrow = 2.0f;     // exponent of its fall across, at its radius
FW_CONST float kBodyCut = 0.12f;       // gas thinner than this is none: a flame ends
FW_CONST float kBodyEnd = 2.12f;       // -ln of that
FW_CONST float kBodyTop = 1.85f;       // heights above its foot at which it ends
FW_CONST float kBodyAlone = 0.62f;     // of Heskestad's height: neighbours raise a flame
FW_CONST float kBodyWiden = 0.25f;     // of its radius per height
FW_SHARED_END
#endif
