// A flame's billboard impostor at a pixel: its mean over the pixel's square, so a small impostor
// keeps its light. With the host's depth: what lies in front of it, else what lies on the flame's
// side of the base plane.
#include "volume/volume_impostor.glsl"

layout(location = 0) out vec4 outColor;

#include "volume/march_pixels.glsl"

void main() {
    outColor = vec4(0.0);
    if (!passesDither(uint(gl_FragCoord.x), uint(gl_FragCoord.y), vShows.x, vShows.y)) return;
    float cut = slabsToCut();
    bool small = min(draw.perX, draw.perY) >= 1.0;
    vec2 low = vPixel - vHalf, high = vPixel + vHalf;
    ivec2 first = ivec2(floor(low));
    vec4 color = vec4(0.0);
    // The same number of iterations for all pixels; march pixels outside have weight 0.
    for (int j = 0; j < vTaps.y; ++j) {
        int y = first.y + j;
        float tall = clamp(min(high.y, float(y + 1)) - max(low.y, float(y)), 0.0, 1.0);
        if (y < 0 || y >= vTaps.w) tall = 0.0;
        uint row = uint(clamp(y, 0, vTaps.w - 1) * vTaps.z);
        for (int i = 0; i < vTaps.x; ++i) {
            int x = first.x + i;
            float weight = tall * clamp(min(high.x, float(x + 1)) - max(low.x, float(x)), 0.0, 1.0);
            if (x < 0 || x >= vTaps.z) weight = 0.0;
            uint column = uint(clamp(x, 0, vTaps.z - 1));
            uvec4 pixel = marchPixelAt(draw.samples + kMarchPixelWords * (row + column));
            color += weight * countingShare(pixel.z, cut, small) * marchPixelColor(pixel);
        }
    }
    outColor = color / (4.0 * vHalf.x * vHalf.y);
}
