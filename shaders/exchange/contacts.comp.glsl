// Fire across gaps of a few centimetres: a texel's run of links by the thread of its first link.
#include "lib/light.glsl"
FW_READ(MATERIALS) FW_READ(CONTACTS)

#define FW_PASS_GIVES
#define FW_PASS_CONTACTS
#include "shared/exchange_pass.h"

void main() {
    if (gl_GlobalInvocationID.x < push.count) lightContact(gl_GlobalInvocationID.x);
}
