#version 450
// A marched flame's tiles that show anything, slab by slab from the farthest to the nearest, each
// at its slab's depth.
#extension GL_GOOGLE_include_directive : require
#include "shared/burn.h"
#include "shared/volume_draw.h"

layout(set = 0, binding = FW_BIND_VOLUME_RAYS, std430) readonly buffer Rays { uint rays[]; };
layout(push_constant) uniform Push { VolumeComposite draw; };

layout(location = 0) out vec2 outCell;        // of the flame, from the middle of its first
layout(location = 1) flat out uint outWords;  // the slab's first
layout(location = 2) flat out vec2 outSlab;   // m along the view: from; 1/m: its depth

void main() {
    uint vertex = uint(gl_VertexIndex);
    uint quad = vertex / 6u, corner = vertex % 6u;
    corner = corner < 3u ? corner : 6u - corner;  // 0 1 2, 3 2 1
    uint tiles = draw.tilesX * draw.tilesY;
    uint tile = quad % tiles;
    uint slab = draw.slabs - 1u - quad / tiles;
    uvec2 at = uvec2(tile % draw.tilesX, tile / draw.tilesX);
    // Cells around a tile reach a little into it: those of its neighbours' nearest rows and columns.
    uint lit = 0u;
    FW_UNROLL
    for (int y = -1; y <= 1; ++y) {
        FW_UNROLL
        for (int x = -1; x <= 1; ++x) {
            ivec2 near = clamp(ivec2(at) + ivec2(x, y), ivec2(0),
                               ivec2(draw.tilesX, draw.tilesY) - 1);
            uint there = rays[draw.flags + uint(near.y) * draw.tilesX + uint(near.x)];
            uint column = x == 0 ? there : x < 0 ? there >> (2u * kVolumeSlabs) : there >> kVolumeSlabs;
            uint row = y == 0 ? there : y < 0 ? there >> (4u * kVolumeSlabs) : there >> (3u * kVolumeSlabs);
            lit |= column & row;
        }
    }
    vec2 cell = vec2((at + uvec2(corner & 1u, corner >> 1u)) * kVolumeTile);
    outCell = cell - 0.5;
    uint cells = tiles * kVolumeTile * kVolumeTile;
    outWords = draw.samples + kVolumeCellWords * cells * slab;
    float front = draw.front + draw.deep * float(slab);
    outSlab = vec2(front, 1.0 / draw.deep);
    vec2 place = draw.place.xy + draw.place.zw * cell;
    float middle = front + 0.5 * draw.deep;
    float w = draw.clip.z * middle + draw.clip.w;
    gl_Position = ((lit >> slab) & 1u) != 0u
                      ? vec4(place * w, clamp(draw.clip.x * middle + draw.clip.y, 0.0, w), w)
                      : vec4(0.0, 0.0, 0.0, 1.0);
}
