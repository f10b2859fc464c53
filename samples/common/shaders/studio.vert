// The photographer's backdrop: a floor that curves up into a wall on all sides.
#version 450
#extension GL_GOOGLE_include_directive : require
#include "studio_block.glsl"
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec3 worldPosition;
layout(location = 1) out vec3 worldNormal;
void main() {
    worldPosition = position;
    worldNormal = normal;
    gl_Position = block.viewProjection * vec4(position, 1.0);
}
