// A surface above a relief; see relief.frag.
#version 450
#extension GL_GOOGLE_include_directive : require
#include "relief_block.glsl"
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 across;
layout(location = 3) in vec4 relief;  // m on the picture, m below the surface, curve
layout(location = 0) out vec3 outPosition;
layout(location = 1) out vec3 outNormal;
layout(location = 2) out vec3 outAcross;
layout(location = 3) out vec4 outRelief;

void main() {
    outPosition = position;
    outNormal = normal;
    outAcross = across;
    outRelief = relief;
    gl_Position = block.viewProjection * vec4(position, 1.0);
}
