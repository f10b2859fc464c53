// The look textures' noise at a place in metres. The includer declares `lookTextures`.

float saturate(float x) { return clamp(x, 0.0, 1.0); }

// Level of detail of a pattern of `tiles` per metre at `pixel` metres per pixel. A whole one: the
// software device fetches two levels otherwise, for twice the time.
float noiseLod(float pixel, float tiles) {
    return floor(log2(max(pixel * tiles * kLookTextureSide, 1.0)) + 0.5);
}

vec4 noiseAt(vec2 d, float tiles, float pixel) {
    return textureLod(lookTextures, vec3(d * tiles, kLayerNoise), noiseLod(pixel, tiles));
}

vec4 lookLayer(vec2 uv, float layer, float lod) {
    return textureLod(lookTextures, vec3(uv, layer), lod);
}

float hash(uvec3 v) {
    uint x = v.x * 73856093u ^ v.y * 19349663u ^ v.z * 83492791u;
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    x ^= x >> 16;
    return float(x >> 8) * (1.0 / 16777216.0);
}

float hash(int x, int y, int seed) { return hash(uvec3(uint(x), uint(y), uint(seed))); }
