#version 450
// A slab of a marched flame at a pixel: the nearest nine cells, so weighed that the four places at
// which neighbours' samples begin count alike. Where the host's depth can be read, of each what of its
// light lies before it.
#extension GL_GOOGLE_include_directive : require
#include "shared/burn.h"
#include "shared/volume_draw.h"

layout(set = 0, binding = FW_BIND_VOLUME_RAYS, std430) readonly buffer Rays { uint rays[]; };
layout(push_constant) uniform Push { VolumeComposite draw; };

layout(location = 0) in vec2 inCell;
layout(location = 1) flat in uint inWords;
layout(location = 2) flat in vec2 inSlab;
layout(location = 3) flat in ivec4 inCells;

layout(location = 0) out vec4 outColor;

#ifdef FW_SOFT
#include "volume/scene_depth.glsl"
#endif

void main() {
    vec2 whole = floor(inCell + 0.5);
    vec2 off = inCell - whole;
    uint pitch = kVolumeCellWords * kVolumeTile * draw.tilesX;
    vec4 color = vec4(0.0);
#ifdef FW_SOFT
    float cut = (depthOfScene(draw.clip) - inSlab.x) * inSlab.y;
#endif
    FW_UNROLL
    for (int y = -1; y <= 1; ++y) {
        uint row = inWords + pitch * uint(clamp(int(whole.y) + y, inCells.y, inCells.w));
        FW_UNROLL
        for (int x = -1; x <= 1; ++x) {
            uint at = row + kVolumeCellWords * uint(clamp(int(whole.x) + x, inCells.x, inCells.z));
            float weight = volumeWeight(x, off.x) * volumeWeight(y, off.y);
#ifdef FW_SOFT
            vec2 lies = unpackHalf2x16(rays[at + 2u]);
            weight *= clamp((cut - lies.x) * lies.y, 0.0, 1.0);
#endif
            color += weight * vec4(unpackHalf2x16(rays[at]), unpackHalf2x16(rays[at + 1u]));
        }
    }
    outColor = color;
}
