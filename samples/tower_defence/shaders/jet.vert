#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"

layout(location = 0) in vec4 inPlace;   // w: size
layout(location = 1) in vec4 inAxis;    // w: stretch
layout(location = 2) in vec4 inState;   // age, temperature, opacity, seed

layout(location = 0) out vec2 outCorner;
layout(location = 1) flat out vec4 outState;

void main() {
    vec2 corner = vec2(gl_VertexIndex == 1 || gl_VertexIndex == 2 || gl_VertexIndex == 4 ? 1 : -1,
                       gl_VertexIndex == 2 || gl_VertexIndex == 4 || gl_VertexIndex == 5 ? 1 : -1);
    vec2 flat2 = vec2(dot(inAxis.xyz, frame.cameraRight.xyz), dot(inAxis.xyz, frame.cameraUp.xyz));
    float seen = length(flat2);
    // End-on and late bodies turn freely; fresh ones lie along their flight.
    float turn = (inState.w - 0.5) * 6.2832 * smoothstep(0.25, 0.65, inState.x) + inState.x;
    vec2 free = vec2(sin(turn), cos(turn));
    vec2 way = seen > 0.02 ? flat2 / seen : free;
    way = normalize(mix(way, free, smoothstep(0.25, 0.65, inState.x) * 0.85));
    float stretch = 1.0 + (inAxis.w - 1.0) * seen;
    vec3 up = frame.cameraRight.xyz * way.x + frame.cameraUp.xyz * way.y;
    vec3 side = frame.cameraRight.xyz * way.y - frame.cameraUp.xyz * way.x;
    float half_ = 0.5 * inPlace.w;
    vec3 place = inPlace.xyz + side * (corner.x * half_ * pow(stretch, -0.25)) +
                 up * (corner.y * half_ * pow(stretch, 0.75));
    outCorner = corner;
    outState = inState;
    gl_Position = frame.viewProjection * vec4(place, 1.0);
}
