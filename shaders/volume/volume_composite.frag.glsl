// A slab of a marched flame at a pixel: the nearest nine march pixels, weighted so that the four
// sample phases count alike; for a small flame all that lie in the pixel. With the host's depth:
// light in front of it, else light on the flame's side of the base plane, which light of
// neighbouring march pixels would cross. FW_BODY: fire on a surface is tested where its light is, not
// at its slab's depth.
#include "volume/volume_composite.glsl"

layout(location = 0) out vec4 outColor;

#include "volume/march_pixels.glsl"

// A march pixel is weighted by the transmittance of the slabs in front: its mean is what they let
// through when drawn, so slabs neither lose nor create light.
#ifdef FW_BODY
vec2 lies = vec2(0.0);  // slabs from this slab's front to where its light begins, times weight; weight
#endif

void add(uint at, float weight, float cut, inout vec4 color, inout float through) {
    uvec4 pixel = marchPixelAt(at);
#ifdef FW_BODY
    vec2 ends = slabEnds(pixel.z);
    float counts = weight * unpackHalf2x16(pixel.y).y;
    lies += counts * vec2(mix(ends.x, ends.y, 0.1), 1.0);
#endif
    weight *= slabTransmittance(pixel.z);
    through += weight;
    color += weight * countingShare(pixel.z, cut, vPerPixel > 1u) * marchPixelColor(pixel);
}

void main() {
    outColor = vec4(0.0);
#ifdef FW_BODY
    gl_FragDepth = gl_FragCoord.z;
#endif
    bool elsewhere = all(greaterThan(vPixel + 0.5, draw.window.xy)) &&
                     all(lessThan(vPixel + 0.5, draw.window.zw));
    if (elsewhere ||
        !passesDither(uint(gl_FragCoord.x), uint(gl_FragCoord.y), vShows.x, vShows.y))
        return;
    uint pitch = kMarchPixelWords * kMarchTileSide * draw.tilesX;
    vec4 color = vec4(0.0);
    float through = 0.0, cut = slabsToCut() + draw.nearer * vSlab.y;
    if (vPerPixel > 1u) {
        uvec2 first = uvec2(floor((vPixel + 0.5) / float(vPerPixel))) * vPerPixel;
        uint row = vWords + pitch * first.y + kMarchPixelWords * first.x;
        for (uint y = 0u; y < vPerPixel; ++y) {
            for (uint x = 0u; x < vPerPixel; ++x)
                add(row + kMarchPixelWords * x, 1.0, cut, color, through);
            row += pitch;
        }
    } else {
        vec2 whole = floor(vPixel + 0.5);
        vec2 off = vPixel - whole;
        FW_UNROLL
        for (int y = -1; y <= 1; ++y) {
            uint row = vWords + pitch * uint(clamp(int(whole.y) + y, vPixels.y, vPixels.w));
            FW_UNROLL
            for (int x = -1; x <= 1; ++x) {
                uint column =
                    kMarchPixelWords * uint(clamp(int(whole.x) + x, vPixels.x, vPixels.z));
                float weight = neighbourWeight(x, off.x) * neighbourWeight(y, off.y);
                add(row + column, weight, cut, color, through);
            }
        }
    }
    outColor = color / max(through, 1e-6);
#ifdef FW_BODY
    float at = vSlab.x + lies.x / max(lies.y * vSlab.y, 1e-9);
    gl_FragDepth = clamp(depthOfMetres(draw.clip, max(at - draw.nearer, 1e-3)), 0.0, 1.0);
#endif
}
