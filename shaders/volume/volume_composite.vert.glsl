// A marched flame's visible tiles, slab by slab from far to near, each at its slab's depth.
#include "lib/buffers.glsl"
#include "volume/volume_composite.glsl"

FW_READ(VOLUME_RAYS)

void main() {
    uint vertex = uint(gl_VertexIndex);
    uint quad = vertex / 6u, corner = vertex % 6u;
    corner = corner < 3u ? corner : 6u - corner;  // 0 1 2, 3 2 1
    uint tiles = draw.tilesX * draw.tilesY;
    uint listed = quotient22(quad, draw.slabs);
    uint tile = rays[draw.flags + kMarchTileList * tiles + listed];
    uint slab = draw.slabs - 1u - (quad - listed * draw.slabs);
    uint row = quotient22(tile, draw.tilesX);
    ivec2 at = ivec2(tile - row * draw.tilesX, row);
    // Filters at a tile's edge read the nearest rows and columns of its neighbours; unmarched
    // neighbours contain nothing. A small flame's pixels read their own tile only.
    uint lit = 0u;
    ivec4 reach = ivec4(-1, -1, 1, 1);
    FW_UNROLL
    for (int y = -1; y <= 1; ++y) {
        FW_UNROLL
        for (int x = -1; x <= 1; ++x) {
            ivec2 near = at + ivec2(x, y);
            bool inside = near.x >= 0 && near.y >= 0 && near.x < int(draw.tilesX) &&
                          near.y < int(draw.tilesY);
            uint of = draw.flags + (inside ? uint(near.y) * draw.tilesX + uint(near.x) : tile);
            bool is = inside && rays[of + kMarchTileListed * tiles] != 0u;
            uint there = rays[of], edges = there >> kVolumeSlabs;
            bool touches = (x == 0 || (edges & (x < 0 ? 2u : 1u)) != 0u) &&
                           (y == 0 || (edges & (y < 0 ? 8u : 4u)) != 0u);
            lit |= is && touches && (draw.perPixel == 0u || (x == 0 && y == 0)) ? there : 0u;
            // Beyond a corner of the flame nothing is read.
            bool may = is || (x != 0 && y != 0 && !inside);
            if (x < 0) reach.x = may ? reach.x : 0;
            if (x > 0) reach.z = may ? reach.z : 0;
            if (y < 0) reach.y = may ? reach.y : 0;
            if (y > 0) reach.w = may ? reach.w : 0;
        }
    }
    vPixels =
        ivec4(at, at) * int(kMarchTileSide) + reach + ivec4(0, 0, ivec2(kMarchTileSide - 1u));
    vec2 pixel = vec2((uvec2(at) + uvec2(corner & 1u, corner >> 1u)) * kMarchTileSide);
    vPixel = pixel - 0.5;
    uint pixels = tiles * kMarchTileSide * kMarchTileSide;
    vWords = draw.samples + kMarchPixelWords * pixels * slab;
    float front = draw.front + draw.deep * float(slab);
    vPerPixel = draw.perPixel | (vertex >> 31u);  // not constant, see volume_march
    vShows = vec2(draw.from, draw.to) + float(vertex >> 31u);
    vSlab = vec2(front, 1.0 / draw.deep);
    vec2 place = draw.place.xy + draw.place.zw * pixel;
    vBase = vec2(volumeBaseDepth(draw.base, place), draw.base.w);
    float depth = testedDepth(makeDepthTest(draw.base, draw.clip, front, draw.deep, place));
    gl_Position = ((lit >> slab) & 1u) != 0u ? vec4(place, depth, 1.0) : vec4(0.0, 0.0, 0.0, 1.0);
}
