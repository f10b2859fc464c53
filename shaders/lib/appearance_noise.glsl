// Samples of the appearance textures at a place in metres. The includer declares
// `appearanceTextures`.
#include "shared/types.h"

// Mip of a pattern of `tiles` per metre at `pixel` metres per pixel, rounded: a software device
// would fetch two mips otherwise, for twice the time.
float noiseLod(float pixel, float tiles) {
    return floor(log2(max(pixel * tiles * kAppearanceTextureSide, 1.0)) + 0.5);
}

vec4 noiseAt(vec2 d, float tiles, float pixel) {
    return textureLod(appearanceTextures, vec3(d * tiles, kLayerNoise), noiseLod(pixel, tiles));
}

vec4 appearanceLayer(vec2 uv, float layer, float lod) {
    return textureLod(appearanceTextures, vec3(uv, layer), lod);
}

float hash(uvec3 v) {
    return hashUnit(v.x * 73856093u ^ v.y * 19349663u ^ v.z * 83492791u);
}

float hash(int x, int y, int seed) { return hash(uvec3(uint(x), uint(y), uint(seed))); }
