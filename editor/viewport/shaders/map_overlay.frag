// Colours over a mesh's burn map, display values, premultiplied.
#version 450
layout(location = 0) in vec2 uv;
layout(set = 0, binding = 0) uniform sampler2D colors;
layout(push_constant) uniform Push { mat4 clip; vec2 texel; float opacity; } push;
layout(location = 0) out vec4 color;
void main() { color = texture(colors, uv) * push.opacity; }
