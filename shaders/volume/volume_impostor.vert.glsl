// A flame's billboard impostor: a previous march of it, or of a similar flame, facing the camera at
// its current size.
#include "shared/volume_draw.h"

layout(push_constant) uniform Push { VolumeImpostor draw; };

layout(location = 0) centroid out vec2 outPixel;
layout(location = 1) flat out vec2 outSlab;    // m along the view: near distance; 1/m: depth
layout(location = 2) flat out ivec4 outTaps;   // march pixels around a pixel, then all
layout(location = 3) flat out vec2 outHalf;    // march pixels, half the averaged square
layout(location = 4) flat out vec2 outShows;
layout(location = 5) centroid out vec2 outBase;  // as volume_composite's

vec2 placeOf(vec2 pixel) {
    return draw.place.xy + draw.place.zw * pixel.x + vec2(draw.upX, draw.upY) * pixel.y;
}

void main() {
    uint vertex = uint(gl_VertexIndex);
    int zero = int(vertex >> 31u);  // not constant, see volume_march
    // A multiple of whole pixels, so all march pixels count alike, and at least one march pixel.
    vec2 perPixel = vec2(draw.perX, draw.perY);
    outHalf = 0.5 * perPixel * ceil(max(1.0 / perPixel, 1.0));
    ivec2 pixels = ivec2(draw.tilesX, draw.tilesY) * int(kMarchTileSide);
    outTaps = ivec4(ivec2(ceil(2.0 * outHalf)) + 1, pixels) + zero;
    outShows = vec2(draw.from, draw.to) + float(zero);
    outSlab = vec2(draw.front, 1.0 / draw.deep);
    vec2 low = -outHalf, high = vec2(pixels) + outHalf;
    vec4 over =
        vec4(baseSide(draw.base, draw.clip, draw.front, draw.deep, placeOf(low)),
             baseSide(draw.base, draw.clip, draw.front, draw.deep, placeOf(vec2(high.x, low.y))),
             baseSide(draw.base, draw.clip, draw.front, draw.deep, placeOf(high)),
             baseSide(draw.base, draw.clip, draw.front, draw.deep, placeOf(vec2(low.x, high.y))));
    outPixel = mix(low, high, splitQuadVertex(over, vertex));
    vec2 place = placeOf(outPixel);
    outBase = vec2(volumeBaseDepth(draw.base, place), draw.base.w);
    float depth = testedDepth(makeDepthTest(draw.base, draw.clip, draw.front, draw.deep, place));
    gl_Position = vec4(place, depth, 1.0);
}
