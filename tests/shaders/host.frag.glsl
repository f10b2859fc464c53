#version 450
// See host.vert.glsl; two descriptor sets, each of which shows in the picture.
layout(set = 0, binding = 0, std140) uniform First { vec4 scale; } first;
layout(set = 1, binding = 0, std140) uniform Second { vec4 offset; } second;
layout(location = 0) in vec4 inColor;
layout(location = 0) out vec4 outColor;

void main() { outColor = inColor * first.scale + second.offset; }
