// Copies the positions, and normals if given, of an object's vertices from the host's vertex
// buffer; otherwise skin-to-mesh makes normals. 64 vertices per group.
#include "lib/compute.glsl"
#include "shared/deform.h"
FW_BUFFER(SKIN_SOURCES, readonly, uint, sources) FW_BUFFER(SKIN_GIVEN, readonly, uint, given)
FW_BUFFER(SHOWN, FW_BOTH, uint, shownWords) FW_PUSH(SkinPush)

vec3 vectorAt(uint word) {
    return uintBitsToFloat(uvec3(given[word], given[word + 1u], given[word + 2u]));
}

void main() {
    for (uint i = gl_GlobalInvocationID.x; i < push.count; i += gl_NumWorkGroups.x * 64u) {
        uint at = push.given + sources[push.sourceBase + i] * push.stride;
        vec3 shape = uintBitsToFloat(uvec3(push.scaleX, push.scaleY, push.scaleZ));
        vec3 place = vectorAt(at) * shape;
        uint to = (push.shownBase + i) * kShownQuads * 4u;
        uvec3 words = floatBitsToUint(place);
        shownWords[to] = words.x;
        shownWords[to + 1u] = words.y;
        shownWords[to + 2u] = words.z;
        if (push.normal != kNoneTexel) {
            vec3 n = vectorAt(at + push.normal) / shape;
            float size = dot(n, n);
            if (size > 1e-20) shownWords[to + 3u] = packDirection(n * inversesqrt(size));
        }
    }
}
