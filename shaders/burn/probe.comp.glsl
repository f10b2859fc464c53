// Collects the state of the probed texels for the readback.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_PUSH
#define FW_USE_OBJECTS readonly
#define FW_USE_STATE readonly
#define FW_USE_PROBES readonly
#define FW_USE_ANSWERS writeonly
#define FW_USE_HEAT readonly
#include "lib/buffers.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.count) return;
    uvec2 probe = probes[i];
    answers[i].state = state[objects[probe.x].stateBase + probe.y];
    bool heats = (objects[probe.x].flags & kObjectHeat) != 0u;
    uvec2 words = heats ? heat[objects[probe.x].heatBase + probe.y] : uvec2(0u);
    answers[i].heatX = words.x;
    answers[i].heatY = words.y;
    answers[i].heat = heats ? 1u : 0u;
}
