#version 450
// A host's own drawing: four vertex bindings and a push constant, all of which show in the picture.
layout(location = 0) in vec2 inPosition;  // binding 0
layout(location = 1) in vec4 inColor;     // binding 1
layout(location = 2) in vec4 inShade;     // binding 2
layout(location = 3) in vec4 inInstance;  // binding 3, one for all vertices
layout(push_constant) uniform Push {
    vec4 gain;
    float depth;
}
push;
layout(location = 0) out vec4 outColor;

void main() {
    gl_Position = vec4(inPosition, push.depth, 1.0);
    outColor = inColor * inShade * inInstance * push.gain;
}
