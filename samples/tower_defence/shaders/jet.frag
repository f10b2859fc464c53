#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"

layout(location = 0) in vec2 inCorner;
layout(location = 1) flat in vec4 inState;
layout(location = 0) out vec4 outColor;

uint hash(uint a) {
    a ^= a >> 16;
    a *= 0x7feb352du;
    a ^= a >> 15;
    return a;
}
float cell(ivec2 c, uint s) {
    return float(hash(uint(c.x) * 0x9E3779B1u ^ uint(c.y) * 0x85EBCA77u ^ s) & 0xffffu) / 65535.0;
}
float noise(vec2 p, uint s) {
    ivec2 c = ivec2(floor(p));
    vec2 f = fract(p);
    f = f * f * (3.0 - 2.0 * f);
    return mix(mix(cell(c, s), cell(c + ivec2(1, 0), s), f.x),
               mix(cell(c + ivec2(0, 1), s), cell(c + ivec2(1, 1), s), f.x), f.y);
}

// Radiance of soot at a temperature: a black body's colour, and a brightness that falls fast.
vec3 glow(float kelvin) {
    float x = clamp((kelvin - 1000.0) / 1000.0, -0.2, 1.2);
    vec3 tint = vec3(1.0, 0.07 + 0.36 * max(x, 0.0), 0.10 * max(x, 0.0) * max(x, 0.0));
    return tint * exp(5.0 * (x - 0.42));
}

void main() {
    float r = length(inCorner);
    if (r > 1.0) discard;
    float age = inState.x;
    uint seed = uint(inState.w * 65535.0) + 1u;
    // Rolls of flame: noise folded by noise. The creases between rolls are dark, and the body
    // tears open along them as it ages.
    vec2 p = inCorner * 1.5 + inState.w * 37.0;
    float fold = noise(p + vec2(0.0, -2.0 * age), seed);
    float roll = noise(p * 1.7 + 1.8 * vec2(fold, -fold) + vec2(0.0, -3.0 * age), seed + 7u);
    float billow = abs(2.0 * roll - 1.0);
    float body = 1.0 - r * r - 0.45 * fold;
    if (age > 1.0) {
        float smoke = inState.z * smoothstep(0.05, 0.65, body) * (0.6 + 0.4 * roll);
        vec3 ambient = mix(frame.ground.rgb, frame.sky.rgb, 0.7) + 0.22 * frame.sun.rgb;
        outColor = vec4(ambient * 0.055 * smoke, smoke * 0.55);
        return;
    }
    float torn = mix(0.02, 0.40, clamp(age, 0.0, 1.0));
    float thick = smoothstep(torn, torn + 0.45, body * (0.45 + 0.9 * billow));
    float kelvin = inState.y + 420.0 * (billow - 0.45) - 260.0 * r * r;
    float alpha = inState.z * thick;
    outColor = vec4(glow(kelvin) * (frame.cameraRight.w * alpha), 0.85 * alpha);
}
