#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"

layout(location = 0) in vec3 inPosition;
layout(location = 1) in vec3 inNormal;
layout(location = 2) in vec2 inUv;
layout(location = 3) in vec3 inTraits;  // open sky, glow, softness
layout(location = 4) in vec4 inRow0;    // model to world, three rows
layout(location = 5) in vec4 inRow1;
layout(location = 6) in vec4 inRow2;
layout(location = 7) in vec4 inTint;

layout(location = 0) out vec3 outPlace;
layout(location = 1) out vec3 outNormal;
layout(location = 2) out vec2 outUv;
layout(location = 3) out vec3 outTraits;
layout(location = 4) out vec3 outTint;

void main() {
    vec4 p = vec4(inPosition, 1.0);
    outPlace = vec3(dot(inRow0, p), dot(inRow1, p), dot(inRow2, p));
    outNormal = vec3(dot(inRow0.xyz, inNormal), dot(inRow1.xyz, inNormal),
                     dot(inRow2.xyz, inNormal));
    outUv = inUv;
    outTraits = inTraits;
    outTint = inTint.rgb;
    gl_Position = frame.viewProjection * vec4(outPlace, 1.0);
}
