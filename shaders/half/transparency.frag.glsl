// The host's image before our drawing; the blend constant is its weight.
layout(set = 1, binding = 0) uniform sampler2D hostColor;
layout(location = 0) out vec4 outColor;

void main() { outColor = texelFetch(hostColor, ivec2(gl_FragCoord.xy), 0); }
