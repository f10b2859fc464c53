// March pixels as a draw reads them: four words each, one texel where the device has texel buffers.
#include "lib/buffers.glsl"
#ifdef FW_TEXELS
FW_TEXEL_BUFFER(VOLUME_RAYS, readonly, marchPixels)
uvec4 marchPixelAt(uint word) { return imageLoad(marchPixels, int(word / kMarchPixelWords)); }
#else
FW_READ(VOLUME_RAYS)
uvec4 marchPixelAt(uint word) { return uvec4(rays[word], rays[word + 1u], rays[word + 2u], 0u); }
#endif
vec4 marchPixelColor(uvec4 pixel) {
    return vec4(unpackHalf2x16(pixel.x), unpackHalf2x16(pixel.y));
}

// Light counts if it lies in front of the host's scene; without the host's depth, if it lies on the
// flame's side of the base plane. Needs `draw`, `vSlab` and `vBase`.
#ifdef FW_SOFT
#include "volume/scene_depth.glsl"
float cutDepth() { return depthOfScene(draw.clip); }
#else
float cutDepth() { return metresOfDepth(draw.clip, vBase.x); }
#endif
// Slabs from this slab's near distance to the cut.
float slabsToCut() { return (cutDepth() - vSlab.x) * vSlab.y; }
// Share of a march pixel's light that counts. small: march pixels smaller than a pixel have bases
// of their own.
float countingShare(uint range, float cut, bool small) {
#ifdef FW_SOFT
    return slabShareNearer(range, cut);
#else
    return small ? 1.0 : slabShareBeside(range, cut, vBase.y);
#endif
}
