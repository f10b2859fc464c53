// Draws the tiles of the half-resolution target that show anything.
#include "shared/half.h"

layout(set = 2, binding = 0) uniform sampler2D halfDepth;  // below it: output of half_tiles.frag
layout(push_constant) uniform Push { HalfPush push; };

void main() {
    uint number = uint(gl_VertexIndex) / 6u, corner = uint(gl_VertexIndex) % 6u;
    corner = corner < 3u ? corner : 6u - corner;  // 0 1 2, 3 2 1
    uvec2 tile = uvec2(number % push.tilesX, number / push.tilesX);
    bool shows = texelFetch(halfDepth, ivec2(tile.x, push.texelsY + tile.y), 0).r > 0.5;
    vec2 size = vec2(push.width, push.height);
    vec2 at = min(vec2((tile + uvec2(corner & 1u, corner >> 1u)) * (2u * kHalfTile)), size);
    gl_Position = vec4(shows ? 2.0 * at / size - 1.0 : vec2(-2.0), 0.0, 1.0);
}
