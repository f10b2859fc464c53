// A texture times a colour; leaves alpha multiplied in.
#version 450
layout(location = 0) in vec2 textureUv;
layout(location = 1) in vec4 tint;
layout(binding = 0) uniform sampler2D picture;
layout(location = 0) out vec4 color;
void main() {
    vec4 c = tint * textureLod(picture, textureUv, 0.0);
    color = vec4(c.rgb * c.a, c.a);
}
