// Bloom: a sum of soft mips, at a quarter of the resolution.
#version 450
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
layout(binding = 0) uniform sampler2D scene;

// Four taps, half a texel out, hide the squares of a coarse mip.
vec3 softMip(float lod) {
    vec2 texel = 0.5 / vec2(textureSize(scene, int(lod)));
    return 0.25 * (textureLod(scene, uv + texel * vec2(1.0, 1.0), lod).rgb +
                   textureLod(scene, uv + texel * vec2(-1.0, 1.0), lod).rgb +
                   textureLod(scene, uv + texel * vec2(1.0, -1.0), lod).rgb +
                   textureLod(scene, uv + texel * vec2(-1.0, -1.0), lod).rgb);
}

void main() {
    float last = float(textureQueryLevels(scene)) - 1.0;
    color = vec4(0.40 * softMip(min(2.0, last)) + 0.35 * softMip(min(3.0, last)) +
                     0.25 * softMip(last), 1.0);
}
