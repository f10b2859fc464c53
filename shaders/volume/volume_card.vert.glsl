#version 450
// A volumetric flame's card: what was marched of it, or of one that is like it, facing the camera,
// as large as it is now.
#extension GL_GOOGLE_include_directive : require
#include "shared/volume_draw.h"

layout(push_constant) uniform Push { VolumeCard draw; };

layout(location = 0) centroid out vec2 outCell;
layout(location = 1) flat out vec2 outSlab;    // m along the view: from; 1/m: its depth
layout(location = 2) flat out ivec4 outTaps;   // cells around a pixel, then all
layout(location = 3) flat out vec2 outHalf;    // cells, of what a pixel averages
layout(location = 4) flat out vec2 outShows;

void main() {
    uint vertex = uint(gl_VertexIndex);
    uint corner = vertex < 3u ? vertex : 6u - vertex;  // 0 1 2, 3 2 1
    int zero = int(vertex >> 31u);                     // not a constant, see volume.frag
    // As wide as whole pixels, so that each cell counts alike, and as a cell at least.
    vec2 perPixel = vec2(draw.perX, draw.perY);
    outHalf = 0.5 * perPixel * ceil(max(1.0 / perPixel, 1.0));
    ivec2 cells = ivec2(draw.tilesX, draw.tilesY) * int(kVolumeTile);
    outTaps = ivec4(ivec2(ceil(2.0 * outHalf)) + 1, cells) + zero;
    outShows = vec2(draw.from, draw.to) + float(zero);
    outSlab = vec2(draw.front, 1.0 / draw.deep);
    vec2 side = vec2(corner & 1u, corner >> 1u);
    outCell = mix(-outHalf, vec2(cells) + outHalf, side);
    vec2 place = draw.place.xy + draw.place.zw * outCell.x + vec2(draw.upX, draw.upY) * outCell.y;
    float middle = draw.front + 0.5 * draw.deep;
    float w = draw.clip.z * middle + draw.clip.w;
    gl_Position = vec4(place * w, clamp(draw.clip.x * middle + draw.clip.y, 0.0, w), w);
}
