// One slab of a volumetric flame: its screen bounds as two polygons, see makeDepthTest. Instances
// go from far to near.
#include "shared/volume_draw.h"

layout(push_constant) uniform Push { VolumeDraw draw; };

layout(location = 0) out vec3 outRay;        // m, see VolumeDraw
layout(location = 1) flat out vec2 outSlab;  // m along the view: from, to
layout(location = 2) flat out uint outZero;
layout(location = 3) out float outBase;      // clip z / w of the plane through the base

void main() {
    uint vertex = uint(gl_VertexIndex);
    uint slab = draw.slabs - 1u - uint(gl_InstanceIndex);
    float near = draw.front + draw.deep * float(slab);
    // The outermost slabs include everything beyond.
    outSlab.x = slab == 0u ? -1e9 : near;
    outSlab.y = gl_InstanceIndex == 0 ? 1e9 : near + draw.deep;
    vec4 over = vec4(baseSide(draw.base, draw.clip, near, draw.deep, draw.rect.xy),
                     baseSide(draw.base, draw.clip, near, draw.deep, draw.rect.zy),
                     baseSide(draw.base, draw.clip, near, draw.deep, draw.rect.zw),
                     baseSide(draw.base, draw.clip, near, draw.deep, draw.rect.xw));
    vec2 place = mix(draw.rect.xy, draw.rect.zw, splitQuadVertex(over, vertex));
    outRay = draw.rayO.xyz + place.x * draw.rayX.xyz + place.y * draw.rayY.xyz;
    outZero = vertex >> 31u;
    outBase = volumeBaseDepth(draw.base, place);
    float depth = testedDepth(makeDepthTest(draw.base, draw.clip, near, draw.deep, place));
    gl_Position = vec4(place, depth, 1.0);
}
