// Composites the half-resolution target. Of the four texels around a pixel, those drawn against a
// similar depth count, so edges of objects in flames and smoke stay at full resolution.
// Premultiplied, encoded and blended: `over` is associative.
#include "shared/half.h"

layout(set = 1, binding = 0) uniform sampler2D halfColor;
layout(set = 2, binding = 0) uniform sampler2D halfDepth;
layout(push_constant) uniform Push { HalfPush push; };
layout(location = 0) out vec4 outColor;

#include "volume/scene_depth.glsl"

void main() {
    vec2 at = 0.5 * (gl_FragCoord.xy - vec2(push.left, push.top)) - 0.5;
    ivec2 first = ivec2(floor(at)), last = ivec2(push.texelsX, push.texelsY) - 1;
    vec2 part = at - vec2(first);
    float away = depthOfScene(push.clip);
    vec4 four[4];
    float apart[4], shares[4], nearest = 1e30;
    vec4 least = vec4(1e30), greatest = vec4(0.0);
    FW_UNROLL
    for (int i = 0; i < 4; ++i) {
        ivec2 step = ivec2(i & 1, i >> 1), texel = clamp(first + step, ivec2(0), last);
        vec2 share = mix(1.0 - part, part, vec2(step));
        shares[i] = share.x * share.y;
        apart[i] = halfApart(away, metresOfDepth(push.clip, texelFetch(halfDepth, texel, 0).r));
        four[i] = texelFetch(halfColor, texel, 0);
        least = min(least, four[i]);
        greatest = max(greatest, four[i]);
        nearest = min(nearest, apart[i]);
    }
    // All four lie across an edge, as around a thin object: uses a matching one of those around
    // them, else the darkest, so that light behind an object does not show in front.
    vec4 other = least;
    float best = kHalfEdge;
    int around = nearest > kHalfEdge ? 12 : 0;
    for (int i = 0; i < around; ++i) {
        ivec2 step = ivec2(i < 4 ? i - 1 : i < 6 ? 2 : i < 10 ? 8 - i : -1,
                           i < 4 ? -1 : i < 6 ? i - 4 : i < 10 ? 2 : 11 - i);
        ivec2 texel = clamp(first + step, ivec2(0), last);
        float off = halfApart(away, metresOfDepth(push.clip, texelFetch(halfDepth, texel, 0).r));
        if (off < best) {
            best = off;
            other = texelFetch(halfColor, texel, 0);
        }
    }
    float alike = halfAlike(dot(greatest, vec4(1.0)), dot(least, vec4(1.0)));
    vec4 color = vec4(0.0);
    float sum = 0.0;
    FW_UNROLL
    for (int i = 0; i < 4; ++i) {
        float weight = halfWeight(shares[i], apart[i], nearest, alike);
        color += weight * four[i];
        sum += weight;
    }
    color /= sum;
    outColor = around > 0 ? other : color;
}
