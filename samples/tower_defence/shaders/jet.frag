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

// Radiance of soot against its colour at 1650 K, linear Rec.709.
vec3 glow(float kelvin) {
    float x = (kelvin - 1000.0) / 1000.0;
    vec3 tint = vec3(1.0, mix(0.12, 0.56, clamp(x, 0.0, 1.0)),
                     mix(0.004, 0.17, clamp(x * x, 0.0, 1.0)));
    return tint * exp(4.6 * (x - 0.65));
}

void main() {
    float r = length(inCorner);
    if (r > 1.0) discard;
    float age = inState.x;
    uint seed = uint(inState.w * 65535.0) + 1u;
    // Rolls of flame: noise folded by noise, torn open as the body ages.
    vec2 p = inCorner * 1.9 + inState.w * 37.0;
    float fold = noise(p + vec2(0.0, -2.0 * age), seed);
    float roll = noise(p * 1.9 + 1.6 * vec2(fold, -fold) + vec2(0.0, -3.0 * age), seed + 7u);
    float billow = 1.0 - abs(2.0 * roll - 1.0);
    float body = 1.0 - r * r - 0.55 * fold;
    float torn = mix(0.05, 0.42, clamp(age, 0.0, 1.0));
    float thick = smoothstep(torn, torn + 0.42, body * (0.55 + 0.75 * billow));
    if (age > 1.0) {
        float smoke = inState.z * smoothstep(0.05, 0.65, body) * (0.6 + 0.4 * roll);
        vec3 ambient = mix(frame.ground.rgb, frame.sky.rgb, 0.7) + 0.22 * frame.sun.rgb;
        outColor = vec4(ambient * 0.055 * smoke, smoke * 0.55);
        return;
    }
    float kelvin = inState.y + 300.0 * (billow - 0.62) - 160.0 * r;
    float alpha = inState.z * thick;
    outColor = vec4(glow(kelvin) * (frame.cameraRight.w * alpha), 0.85 * alpha);
}
