#version 450
// A host's own computing: each dispatch takes in what the one before it left.
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer In { uint values[]; } source;
layout(set = 1, binding = 0, std430) buffer Out { uint values[]; } result;
layout(push_constant) uniform Push { uint add; } push;

void main() {
    uint i = gl_GlobalInvocationID.x;
    result.values[i] = result.values[i] * 3u + source.values[i] + push.add;
}
