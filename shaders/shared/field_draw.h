// Drawing of a particle field: draw records and displayed cells. The simulation step is in field.h.
// clang-format off
#ifndef FW_SHARED_FIELD_DRAW_H
#define FW_SHARED_FIELD_DRAW_H
#include "shared/types.h"

FW_SHARED_BEGIN
FW_CONST uint kFieldShowGroups = 8u;  // per field, by rows
FW_CONST uint kFieldBillboard = 0u;        // FieldDraw::shape, as FwFieldShape
FW_CONST uint kFieldSpheroid = 1u;
FW_CONST uint kFieldDisplaced = 2u;
FW_CONST uint kFieldAround = 32u;     // quads around a spheroid; kFieldUp: along its axis
FW_CONST uint kFieldUp = 16u;
FW_CONST float kFieldFull = 96.0f;    // particles of a cell displayed as full

struct FieldDraw {
    // m, world: middle of the lower edge; w: time since the last step, [0, 1] of a step.
    vec4 place;
    vec4 size;           // m: width, height, depth; w: opacity
    vec4 right;          // axes in the world; w: detail
    vec4 up;             // w: body
    vec4 forward;        // w: s, cosmetic time
    vec4 tint;           // w: steps a second
    uint cells;          // first cell that the last step wrote
    uint before;         // first cell that the last step read
    uint shown;
    uint width;          // cells
    uint height;
    uint shape;          // kFieldBillboard ...
    float tall;          // cells, mean height of the particles
    uint seed;
};
FW_SIZE(FieldDraw, 128)

// A displayed cell: density (0 to 2: root of its particles over kFieldFull), motion (cells per
// step, within 1.3), and the share of sunlight that reaches it.
FW_FN uint fieldShownPacked(float density, vec2 motion, float sun) {
    uint d = uint(clamp(density, 0.0f, 2.0f) * 511.5f + 0.5f);
    uint x = uint(clamp(motion.x * 48.0f + 64.5f, 0.0f, 127.0f));
    uint y = uint(clamp(motion.y * 48.0f + 64.5f, 0.0f, 127.0f));
    return d | (x << 10u) | (y << 17u) | (uint(clamp(sun, 0.0f, 1.0f) * 255.0f + 0.5f) << 24u);
}
FW_FN vec4 fieldShown(uint word) {
    return vec4(float(word & 1023u) * (1.0f / 511.5f),
                (float((word >> 10u) & 127u) - 64.0f) * (1.0f / 48.0f),
                (float((word >> 17u) & 127u) - 64.0f) * (1.0f / 48.0f),
                float(word >> 24u) * (1.0f / 255.0f));
}

FW_SHARED_END
#endif
