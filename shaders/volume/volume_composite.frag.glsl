// A slab of a marched flame at a pixel: the nearest nine march pixels, weighted so that the four
// sample phases count alike; for a small flame all that lie in the pixel. With the host's depth:
// light in front of it, else light on the flame's side of the base plane, which light of
// neighbouring march pixels would cross.
#include "shared/burn.h"
#include "shared/volume_draw.h"

layout(push_constant) uniform Push { CompositePush draw; };

layout(location = 0) centroid in vec2 inPixel;
layout(location = 1) flat in uint inWords;
layout(location = 2) flat in vec2 inSlab;
layout(location = 3) flat in ivec4 inPixels;
layout(location = 4) flat in uint inPerPixel;
layout(location = 5) flat in vec2 inShows;
layout(location = 6) centroid in vec2 inBase;

layout(location = 0) out vec4 outColor;

#include "volume/march_pixels.glsl"

// A march pixel is weighted by the transmittance of the slabs in front: its mean is what they let
// through when drawn, so slabs neither lose nor create light.
void add(uint at, float weight, float cut, inout vec4 color, inout float through) {
    uvec4 pixel = marchPixelAt(at);
    weight *= slabTransmittance(pixel.z);
    through += weight;
    color += weight * countingShare(pixel.z, cut, inPerPixel > 1u) * marchPixelColor(pixel);
}

void main() {
    outColor = vec4(0.0);
    bool elsewhere = all(greaterThan(inPixel + 0.5, draw.window.xy)) &&
                     all(lessThan(inPixel + 0.5, draw.window.zw));
    if (elsewhere ||
        !passesDither(uint(gl_FragCoord.x), uint(gl_FragCoord.y), inShows.x, inShows.y))
        return;
    uint pitch = kMarchPixelWords * kMarchTileSide * draw.tilesX;
    vec4 color = vec4(0.0);
    float through = 0.0, cut = slabsToCut();
    if (inPerPixel > 1u) {
        uvec2 first = uvec2(floor((inPixel + 0.5) / float(inPerPixel))) * inPerPixel;
        uint row = inWords + pitch * first.y + kMarchPixelWords * first.x;
        for (uint y = 0u; y < inPerPixel; ++y) {
            for (uint x = 0u; x < inPerPixel; ++x)
                add(row + kMarchPixelWords * x, 1.0, cut, color, through);
            row += pitch;
        }
    } else {
        vec2 whole = floor(inPixel + 0.5);
        vec2 off = inPixel - whole;
        FW_UNROLL
        for (int y = -1; y <= 1; ++y) {
            uint row = inWords + pitch * uint(clamp(int(whole.y) + y, inPixels.y, inPixels.w));
            FW_UNROLL
            for (int x = -1; x <= 1; ++x) {
                uint column =
                    kMarchPixelWords * uint(clamp(int(whole.x) + x, inPixels.x, inPixels.z));
                float weight = neighbourWeight(x, off.x) * neighbourWeight(y, off.y);
                add(row + column, weight, cut, color, through);
            }
        }
    }
    outColor = color / max(through, 1e-6);
}
