// Burning tiles to flame and smoke quads. All that changes a quad is a function of its tile and of
// time: nothing is kept, and nothing pops.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_PUSH
#define FW_USE_OBJECTS readonly
#define FW_USE_MATERIALS readonly
#define FW_USE_COUNTERS readonly
#define FW_USE_BURN_TILES readonly
#include "lib/buffers.glsl"
#include "shared/look.h"
layout(std430, set = 0, binding = FW_BIND_LOOKS) readonly buffer LooksBuffer {
    MaterialLook looks[];
};
layout(std430, set = 0, binding = FW_BIND_FLAMES) writeonly buffer FlamesBuffer {
    FlameQuad flameQuad[];
};
layout(std430, set = 0, binding = FW_BIND_DRAW_ARGS) buffer ArgsBuffer { uint drawArgs[]; };
layout(set = 0, binding = FW_BIND_VIEW, std140) uniform View { ViewParams view; };
#include "emitter/cells.glsl"

vec3 perpendicular(vec3 n) {
    return normalize(cross(n, abs(n.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0)));
}

void emit(FlameQuad quad) {
    uint slot = atomicAdd(drawArgs[1], 1u);
    if (slot < min(view.flameCapacity, kFlameCapacity)) flameQuad[slot] = quad;
}

void main() {
    uint count = counters[kRowBurn + push.burnParity].runCount;
    float share = min(1.0, float(view.flameCapacity) * 12.0 / float(max(cells[0], 1u)));
    float time = view.ambientSky.w;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * 64u) {
        BurnTile tile = burnTiles[i];
        float side = flameCellSide(tile.object), small = tileSide(tile.object);
        MaterialLook look = looks[materials[tile.object * kMaterialsPerObject].look];
        uint seed = mixBits(tile.object * 7919u + tile.tile * 31u + view.seed);
        vec3 normal = tile.normalPower.xyz, up = view.up.xyz;
        vec3 right = perpendicular(normal + up * 1e-4), ahead = cross(normal, right);
        vec3 above = flamePlaceOf(tile, side);
        float fade = flameFade(tile);

        for (uint k = 0u; k < 4u; ++k) {
            bool smoke = k == 3u;
            uint s = mixBits(seed + k * 977u);
            // Cells are met at random distances, or their borders would show in the heights.
            vec3 jitter = vec3(unit(s), unit(s + 1u), unit(s + 2u)) - 0.5;
            uint slot = findCell(cellKey(
                ivec3(floor((above + jitter * side) / side)), side));
            if (slot == kNoCell) slot = findCell(cellKey(ivec3(floor(above / side)), side));
            float power = tile.normalPower.w * fade, area = tile.positionArea.w * fade;
            if (slot != kNoCell) {
                power = max(power, float(cells[cellWord(slot, 1u)]) * 16.0);
                area = max(area, float(cells[cellWord(slot, 5u)]) * 1e-5);
            }
            float len = flameLength(power, area, small) * (look.flame > 0.0 ? look.flame : 1.0);
            float wish = flameQuads(tile.positionArea.w, len, fade) * share;
            if (smoke) wish = min(0.12 * wish * look.smoke, 0.5);
            float spare = wish - (smoke ? 0.0 : float(k)) - unit(s + 3u);
            if (spare <= 0.0) continue;
            float opacity = smoothstep(0.0, 0.25, spare);

            float period = (smoke ? 1.6 : 0.55) * sqrt(len + 0.05) + (smoke ? 0.6 : 0.18);
            float life = time / period + unit(s + 4u) * 16.0;
            float generation = floor(life), a = life - generation;
            uint g = mixBits(s + uint(generation) * 2654435761u);
            float r1 = unit(g), r2 = unit(g + 1u), r3 = unit(g + 2u), r4 = unit(g + 3u);
            vec3 place = tile.positionArea.xyz +
                         (right * (r1 - 0.5) + ahead * (r2 - 0.5)) * max(small, 0.12 * len);
            FlameQuad quad;
            float rise = 1.0 + 2.5 * sqrt(len);  // m/s
            vec3 drift = view.wind.xyz - up * dot(view.wind.xyz, up);
            if (!smoke) {
                float grown = 0.55 + 0.45 * smoothstep(0.0, 0.4, a);
                float tall = len * (0.55 + 0.75 * r3 * r3) * grown;
                vec3 axis = normalize(up * rise + drift + normal * (0.16 * rise) +
                                      (right * (r4 - 0.5) + ahead * (r1 - 0.5)) * (0.35 * rise));
                float halfWidth = (0.15 + 0.10 * r2) * len + 0.25 * small;
                float loose = smoothstep(0.55, 1.0, a);
                quad.baseHeight = vec4(place + normal * (0.15 * halfWidth) - axis * (0.06 * tall) +
                                           axis * (0.45 * tall * loose * loose), tall);
                quad.axisWidth = vec4(axis, halfWidth * (1.0 - 0.35 * loose));
                quad.opacity = opacity * smoothstep(0.0, 0.22, a) *
                               (1.0 - smoothstep(0.62, 1.0, a));
                quad.phase = time * rise * 0.5 / max(len, 0.05) + 7.0 * r4;
                quad.kelvin = 1570.0 + 90.0 * r3;
            } else {
                float age = a * period;
                float size = (0.30 + 0.55 * a + 0.15 * r3) * len + 0.04;
                vec3 at = place + up * (len * (0.75 + 0.2 * r4) + 0.55 * rise * age) +
                          drift * (0.75 * age) + right * ((r2 - 0.5) * 0.5 * len * a);
                quad.baseHeight = vec4(at - up * size, 2.0 * size);
                quad.axisWidth = vec4(up, size);
                quad.opacity = opacity * 0.42 * min(look.smoke, 1.6) * smoothstep(0.0, 0.30, a) *
                               (1.0 - smoothstep(0.35, 1.0, a));
                quad.phase = 0.10 * age + 5.0 * r4;
                // The fire below lights it from its first moments.
                quad.kelvin = 1.0 - a;
            }
            quad.kind = (g & 0xFFFFu) << 1u | (smoke ? 1u : 0u);
            if (quad.opacity > 0.004) emit(quad);
        }
    }
}
