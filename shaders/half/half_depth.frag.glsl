// The host's depth at half resolution. A texel alternately takes the least or greatest depth of its
// four pixels, not their mean, which lies on no surface. So beside an edge some texel lies on each
// side.
#include "shared/half.h"
#include "lib/scene_depth.glsl"

layout(push_constant) uniform Push { HalfPush push; };
layout(location = 0) out float outDepth;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    ivec2 first = ivec2(push.left, push.top), last = first + ivec2(push.width, push.height) - 1;
    ivec2 low = min(first + 2 * texel, last), high = min(low + 1, last);
    vec4 four =
        vec4(texelFetch(sceneDepth, low, 0).r, texelFetch(sceneDepth, ivec2(high.x, low.y), 0).r,
             texelFetch(sceneDepth, ivec2(low.x, high.y), 0).r, texelFetch(sceneDepth, high, 0).r);
    float least = min(min(four.x, four.y), min(four.z, four.w));
    float greatest = max(max(four.x, four.y), max(four.z, four.w));
    outDepth = halfTakesGreater(texel.x, texel.y) ? greatest : least;
}
