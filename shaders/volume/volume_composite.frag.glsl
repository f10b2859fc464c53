// A slab of a marched flame at a pixel: the nearest nine march pixels, weighted so that the four
// sample phases count alike; for a small flame all that lie in the pixel. With the host's depth:
// light in front of it, else light on the flame's side of the base plane, which light of
// neighbouring march pixels would cross.
#include "volume/volume_composite.glsl"

layout(location = 0) out vec4 outColor;

#include "volume/march_pixels.glsl"

// A march pixel is weighted by the transmittance of the slabs in front: its mean is what they let
// through when drawn, so slabs neither lose nor create light.
void add(uint at, float weight, float cut, inout vec4 color, inout float through) {
    uvec4 pixel = marchPixelAt(at);
    weight *= slabTransmittance(pixel.z);
    through += weight;
    color += weight * countingShare(pixel.z, cut, vPerPixel > 1u) * marchPixelColor(pixel);
}

void main() {
    outColor = vec4(0.0);
    bool elsewhere = all(greaterThan(vPixel + 0.5, draw.window.xy)) &&
                     all(lessThan(vPixel + 0.5, draw.window.zw));
    if (elsewhere ||
        !passesDither(uint(gl_FragCoord.x), uint(gl_FragCoord.y), vShows.x, vShows.y))
        return;
    uint pitch = kMarchPixelWords * kMarchTileSide * draw.tilesX;
    vec4 color = vec4(0.0);
    float through = 0.0, cut = slabsToCut();
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
}
