#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"

layout(location = 0) in vec3 inPosition;
layout(location = 1) in vec3 inNormal;
layout(location = 2) in vec2 inUv;
layout(location = 3) in vec4 inTraits;  // open sky, glow, softness; m of sway at 1 m/s
layout(location = 4) in vec4 inRow0;    // model to world, three rows
layout(location = 5) in vec4 inRow1;
layout(location = 6) in vec4 inRow2;
layout(location = 7) in vec4 inTint;

layout(location = 0) out vec3 outPlace;
layout(location = 1) out vec3 outNormal;
layout(location = 2) out vec2 outUv;
layout(location = 3) out vec3 outTraits;
layout(location = 4) out vec3 outTint;

// Gusts cover the land and move with the wind.
vec2 windAt(vec2 place) {
    vec2 gusts = place - frame.wind.zw;
    return frame.wind.xy * (1.0 + 0.45 * sin(dot(gusts, vec2(0.55, 0.2))) +
                            0.3 * sin(dot(gusts, vec2(-0.25, 0.8)) + 1.7) +
                            0.12 * sin(dot(gusts, vec2(2.1, 1.3))));
}

void main() {
    vec4 p = vec4(inPosition, 1.0);
    outPlace = vec3(dot(inRow0, p), dot(inRow1, p), dot(inRow2, p));
    outPlace.xz += inTraits.w * windAt(outPlace.xz);
    outNormal = vec3(dot(inRow0.xyz, inNormal), dot(inRow1.xyz, inNormal),
                     dot(inRow2.xyz, inNormal));
    outUv = inUv;
    outTraits = inTraits.xyz;
    outTint = inTint.rgb;
    gl_Position = frame.viewProjection * vec4(outPlace, 1.0);
}
