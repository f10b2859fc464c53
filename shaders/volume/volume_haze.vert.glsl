// Screen bounds of a volumetric flame's hot column as a grid: eddies are wider than its cells, so
// refraction is evaluated at corners and interpolated.
#include "volume/flame.glsl"
#include "shared/volume_haze.h"

layout(push_constant) uniform Push { HazePush draw; };

layout(location = 0) centroid out vec3 outRay;   // m, see VolumeDraw
// Deflection per m behind the column; m along the ray to the column.
layout(location = 1) centroid out vec4 outBend;

#include "shared/volume_march.h"

struct Passing {  // closest point of a ray to the column's axis
    FlamePlace at;
    float away;   // m along the ray
    vec3 side, along;
    float open;   // [0, 1]: 0 beyond a wall or ceiling that holds the gas up
};

// By distance in half widths of the plume: where the curve loops, the part that covers more.
Passing passAxis(FlameRecord f, vec3 from, vec3 direction) {
    float least = 1e30, part = 0.0, open = 1.0, openThere = 1.0;
    uint piece = 0u;
    FW_UNROLL
    for (uint k = 0u; k < kFlamePieces; ++k) {
        vec4 a = FW_FLAME_NODE(flameNodeOf(k)).centre,
             b = FW_FLAME_NODE(flameNodeOf(k + 1u)).centre;
        float s = FW_FLAME_NODE(flameNodeOf(k)).along.w;
        float long_ = FW_FLAME_NODE(flameNodeOf(k + 1u)).along.w - s;
        vec3 segment = b.xyz - a.xyz, to = a.xyz - from;
        to -= direction * dot(to, direction);
        segment -= direction * dot(segment, direction);
        // The last piece is extended to the end of the column.
        float most =
            k + 1u < kFlamePieces ? 1.0 : max((kHazeTop * f.high.w - s) / max(long_, 1e-6), 1.0);
        float u = clamp(-dot(to, segment) / max(dot(segment, segment), 1e-9), 0.0, most);
        vec3 off = to + u * segment;
        float wide = flamePlumeWide(f, s + u * long_);
        open = min(open, 1.0 - FW_FLAME_NODE(flameNodeOf(k + 1u)).squeeze.w / 0.9);
        float cost = dot(off, off) / (wide * wide);
        part = cost < least ? u : part;
        piece = cost < least ? k : piece;
        openThere = cost < least ? open : openThere;
        least = min(least, cost);
    }
    FlameNode a = FW_FLAME_NODE(flameNodeOf(piece)), b = FW_FLAME_NODE(flameNodeOf(piece + 1u));
    Passing pass;
    pass.open = max(openThere, 0.0);
    pass.side = mix(a.side.xyz, b.side.xyz, min(part, 1.0));
    pass.along = mix(a.along.xyz, b.along.xyz, min(part, 1.0));
    vec3 to = mix(a.centre.xyz, b.centre.xyz, part) - from;
    pass.away = dot(to, direction);
    vec3 off = direction * pass.away - to;
    pass.at = FlamePlace(vec2(dot(off, pass.side), dot(off, cross(pass.along, pass.side))),
                         mix(a.along.w, b.along.w, part), 0.0);
    return pass;
}

void main() {
    uint quad = uint(gl_VertexIndex) / 6u, corner = uint(gl_VertexIndex) % 6u;
    corner = corner < 3u ? corner : 6u - corner;  // 0 1 2, 3 2 1
    vec2 cell = vec2(quad % kHazeColumns + (corner & 1u), quad / kHazeColumns + (corner >> 1u));
    vec2 place = mix(draw.rect.xy, draw.rect.zw, cell / vec2(kHazeColumns, kHazeRows));
    gl_Position = vec4(place, 0.0, 1.0);
    outRay = draw.rayO.xyz + place.x * draw.rayX.xyz + place.y * draw.rayY.xyz;

    FlameRecord f = flame.record;
    float perspective = view.forward.w;  // weighed with, not branched on, see ARCHITECTURE.md
    vec3 from = view.eye.xyz + outRay * (1.0 - perspective);
    vec3 direction = normalize(mix(view.forward.xyz, outRay, perspective));
    Passing pass = passAxis(f, from, direction);
    vec3 haze = flameHaze(f, pass.at);
    vec3 bend = haze.x * pass.side + haze.y * pass.along + haze.z * cross(pass.along, pass.side);
    bend -= direction * dot(bend, direction);
    // No refraction around the camera, which is inside the column.
    bend *= draw.strength * pass.open * clamp(pass.away / flamePlumeWide(f, pass.at.s), 0.0, 1.0);
    outBend = vec4(bend, pass.away);
}
