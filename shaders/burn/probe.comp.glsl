// Collects the state of the probed texels for the readback.
#include "lib/compute.glsl"
FW_READ(OBJECTS) FW_READ(STATE) FW_READ(PROBES) FW_READ(HEAT) FW_WRITE(ANSWERS) FW_PUSH(StepPush)

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
