#version 450
// One slab of a volumetric flame: the part of the view that its bounds cover, at the slab's depth.
// Instances go from the farthest slab to the nearest.
#extension GL_GOOGLE_include_directive : require
#include "shared/volume_draw.h"

layout(push_constant) uniform Push { VolumeDraw draw; };

layout(location = 0) out vec3 outRay;        // m, see VolumeDraw
layout(location = 1) flat out vec2 outSlab;  // m along the view: from, to
layout(location = 2) flat out uint outZero;

void main() {
    uint corner = uint(gl_VertexIndex) < 3u ? uint(gl_VertexIndex) : 6u - uint(gl_VertexIndex);
    vec2 place = vec2((corner & 1u) == 0u ? draw.rect.x : draw.rect.z,
                      (corner & 2u) == 0u ? draw.rect.y : draw.rect.w);
    if (gl_VertexIndex == 3) place = draw.rect.zw;
    uint slab = draw.slabs - 1u - uint(gl_InstanceIndex);
    float near = draw.front + draw.deep * float(slab);
    // What is in front of all slabs, or behind them, belongs to the outermost.
    outSlab.x = slab == 0u ? -1e9 : near;
    outSlab.y = gl_InstanceIndex == 0 ? 1e9 : near + draw.deep;
    outRay = draw.rayO.xyz + place.x * draw.rayX.xyz + place.y * draw.rayY.xyz;
    outZero = uint(gl_VertexIndex) >> 31u;
    float middle = near + 0.5 * draw.deep;
    float w = draw.clip.z * middle + draw.clip.w;
    gl_Position = vec4(place * w, clamp(draw.clip.x * middle + draw.clip.y, 0.0, w), w);
}
