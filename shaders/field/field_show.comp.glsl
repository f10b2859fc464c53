// Displayed cells of particle fields: density between the last two steps, advected by each cell's
// motion so that nothing jumps, and the share of sunlight. kFieldShowGroups groups per field.
// Cosmetic.
#include "lib/compute.glsl"
#include "lib/view.glsl"
#include "shared/field.h"
FW_READ(FIELD_DRAWS) FW_READ(FIELD_CELLS) FW_WRITE(FIELD_SHOWN)

const float kShadow = 0.004;  // of sunlight, absorbed per particle on its path

uint width, height, ring;

uint cellIndex(int x, int y) {
    int w = int(width);
    x = ring != 0u ? (x < 0 ? x + w : (x >= w ? x - w : x)) : clamp(x, 0, w - 1);
    return uint(clamp(y, 0, int(height) - 1)) * width + uint(x);
}

float particlesAt(uint first, vec2 at) {
    vec2 low = floor(at), part = at - low;
    int x = int(low.x), y = int(low.y);
    vec4 n = vec4(fieldNumber(cells[first + cellIndex(x, y)]),
                  fieldNumber(cells[first + cellIndex(x + 1, y)]),
                  fieldNumber(cells[first + cellIndex(x, y + 1)]),
                  fieldNumber(cells[first + cellIndex(x + 1, y + 1)]));
    vec2 rows = mix(n.xz, n.yw, part.x);
    return mix(rows.x, rows.y, part.y);
}

void main() {
    FieldDraw d = draws[gl_WorkGroupID.x / kFieldShowGroups];
    uint part = gl_WorkGroupID.x % kFieldShowGroups;
    width = d.width;
    height = d.height;
    ring = d.shape != kFieldBillboard ? 1u : 0u;
    uint count = width * height, share = (count + kFieldShowGroups - 1u) / kFieldShowGroups;
    uint end = min((part + 1u) * share, count);
    float between = d.place.w;
    // Direction to the sun in cells. A billboard is lit from its side; light from behind shines
    // through.
    vec2 sun = vec2(dot(view.sunDirection.xyz, d.right.xyz), dot(view.sunDirection.xyz, d.up.xyz));
    sun = sun / max(length(sun), 0.3);
    for (uint i = part * share + gl_LocalInvocationID.x; i < end; i += 64u) {
        uint y = i / width, x = i - y * width;
        vec2 at = vec2(float(x), float(y));
        uint cell = cells[d.cells + i];
        vec2 motion = (vec2(fieldMotionOf(cell)) - float(kFieldStill)) * (1.0 / float(kFieldSpeed));
        float before = particlesAt(d.before, at - between * motion);
        float after = particlesAt(d.cells, at + (1.0 - between) * motion);
        float n = mix(before, after, between);
        float column = 0.0, reach = 2.0;
        FW_UNROLL for (int k = 0; k < 4; ++k) {
            vec2 there = at + sun * reach + 0.5;
            uint c = cellIndex(int(floor(there.x)), int(floor(there.y)));
            column += 0.9 * reach *
                      mix(float(fieldNumber(cells[d.before + c])),
                          float(fieldNumber(cells[d.cells + c])), between);
            reach *= 1.9;
        }
        bool wall = cell == kFieldWallCell;
        shown[d.shown + i] = fieldShownPacked(wall ? 0.0 : sqrt(n * (1.0 / kFieldFull)), motion,
                                              exp(-kShadow * column));
    }
}
