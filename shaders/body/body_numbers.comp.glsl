// Which body shows the flames of each object.
#include "lib/compute.glsl"
#include "shared/body.h"
FW_READ(BODIES) FW_WRITE(BODY_OF) FW_PUSH(StepPush)

void main() {
    uint body = gl_GlobalInvocationID.x;
    if (body < push.count) bodyOf[bodies[body].object] = body + 1u;
}
