// A mesh with its burn map coordinates.
#version 450
layout(location = 0) in vec3 position;  // m, object space
layout(location = 1) in vec2 place;     // texels
layout(push_constant) uniform Push { mat4 clip; vec2 texel; float opacity; } push;
layout(location = 0) out vec2 uv;
void main() {
    uv = place * push.texel;
    gl_Position = push.clip * vec4(position, 1.0);
}
