#version 450
// The host's picture as it was before we drew; the blend constant says how much of it counts.
layout(set = 1, binding = 0) uniform sampler2D hostColor;
layout(location = 0) out vec4 outColor;

void main() { outColor = texelFetch(hostColor, ivec2(gl_FragCoord.xy), 0); }
