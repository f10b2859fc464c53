// 1 where a tile, or an adjacent texel that its pixels sample, shows anything.
#include "shared/half.h"

layout(set = 1, binding = 0) uniform sampler2D halfColor;
layout(push_constant) uniform Push { HalfPush push; };
layout(location = 0) out float outShows;

void main() {
    // Stored below the depth.
    ivec2 tile = ivec2(gl_FragCoord.xy) - ivec2(0, push.texelsY);
    ivec2 last = ivec2(push.texelsX, push.texelsY) - 1;
    ivec2 low = max(tile * int(kHalfTile) - 1, ivec2(0));
    ivec2 high = min((tile + 1) * int(kHalfTile), last);
    float most = 0.0;
    for (int y = low.y; y <= high.y && most == 0.0; ++y) {
        for (int x = low.x; x <= high.x; ++x) {
            vec4 color = texelFetch(halfColor, ivec2(x, y), 0);
            most = max(most, max(max(color.r, color.g), max(color.b, color.a)));
        }
    }
    outShows = most > 0.0 ? 1.0 : 0.0;
}
