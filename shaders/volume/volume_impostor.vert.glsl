// A flame's billboard impostor: a previous march of it, or of a similar flame, facing the camera at
// its current size.
#include "volume/volume_impostor.glsl"

vec2 placeOf(vec2 pixel) {
    return draw.place.xy + draw.place.zw * pixel.x + vec2(draw.upX, draw.upY) * pixel.y;
}

void main() {
    uint vertex = uint(gl_VertexIndex);
    int zero = int(vertex >> 31u);  // not constant, see volume_march
    // A multiple of whole pixels, so all march pixels count alike, and at least one march pixel.
    vec2 perPixel = vec2(draw.perX, draw.perY);
    vHalf = 0.5 * perPixel * ceil(max(1.0 / perPixel, 1.0));
    ivec2 pixels = ivec2(draw.tilesX, draw.tilesY) * int(kMarchTileSide);
    vTaps = ivec4(ivec2(ceil(2.0 * vHalf)) + 1, pixels) + zero;
    vShows = vec2(draw.from, draw.to) + float(zero);
    vSlab = vec2(draw.front, 1.0 / draw.deep);
    vec2 low = -vHalf, high = vec2(pixels) + vHalf;
    vec4 over =
        vec4(baseSide(draw.base, draw.clip, draw.front, draw.deep, placeOf(low)),
             baseSide(draw.base, draw.clip, draw.front, draw.deep, placeOf(vec2(high.x, low.y))),
             baseSide(draw.base, draw.clip, draw.front, draw.deep, placeOf(high)),
             baseSide(draw.base, draw.clip, draw.front, draw.deep, placeOf(vec2(low.x, high.y))));
    vPixel = mix(low, high, splitQuadVertex(over, vertex));
    vec2 place = placeOf(vPixel);
    vBase = vec2(volumeBaseDepth(draw.base, place), draw.base.w);
    float depth = testedDepth(makeDepthTest(draw.base, draw.clip, draw.front, draw.deep, place));
    gl_Position = vec4(place, depth, 1.0);
}
