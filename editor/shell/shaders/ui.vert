// Dear ImGui's vertices: pixels to clip space. Colours are display values and stay so.
#version 450
layout(location = 0) in vec2 position;
layout(location = 1) in vec2 uv;
layout(location = 2) in vec4 color;
layout(push_constant) uniform Push { vec2 scale, shift; } push;
layout(location = 0) out vec2 textureUv;
layout(location = 1) out vec4 tint;
void main() {
    textureUv = uv;
    tint = color;
    gl_Position = vec4(position * push.scale + push.shift, 0.0, 1.0);
}
