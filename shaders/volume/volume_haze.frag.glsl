// Heat haze: the host's scene refracted by a volumetric flame's hot column. A pixel shows where its
// bent ray arrives, without objects in front of the column, so no foreground smears.
#include "lib/view.glsl"
#include "shared/volume_draw.h"
#include "shared/volume_haze.h"

layout(set = 1, binding = 0) uniform sampler2D sceneColor;
layout(push_constant) uniform Push { HazePush draw; };

layout(location = 0) centroid in vec3 inRay;
layout(location = 1) centroid in vec4 inBend;

layout(location = 0) out vec4 outColor;

#include "volume/scene_depth.glsl"

const float kFarthest = 1000.0;  // m behind the column: beyond, displacement is constant
const float kSeen = 0.25;        // px of displacement at full opacity

// Position in pixels of the view.
vec2 pixelOf(vec3 fromEye) {
    vec4 clip =
        fromEye.x * view.clip0 + fromEye.y * view.clip1 + fromEye.z * view.clip2 + view.clip3;
    return 0.5 * clip.xy / clip.w * view.viewport.zw;
}

void main() {
    outColor = vec4(0.0);
    float perspective = view.forward.w;  // a weight instead of a branch, see ARCHITECTURE.md
    vec3 start = inRay * (1.0 - perspective);
    vec3 ray = mix(view.forward.xyz, inRay, perspective);
    float perDepth = length(ray), away = inBend.w;
    float behind = min(depthOfScene(draw.clip) * perDepth - away, kFarthest);
    if (behind <= 0.0 || away <= 0.0) return;
    vec3 seen = start + ray * ((away + behind) / perDepth);
    vec2 shift = pixelOf(seen + inBend.xyz * behind) - pixelOf(seen);
    float pixels = length(shift);
    shift *= min(kHazePixels / max(pixels, 1e-6), 1.0);

    // Bilinear without texels in front of the column.
    vec2 corner = min(view.viewport.xy, view.viewport.xy + view.viewport.zw);
    ivec2 low = ivec2(max(corner, vec2(0.0)));
    ivec2 high = min(ivec2(corner + abs(view.viewport.zw)), textureSize(sceneColor, 0)) - 1;
    vec2 place = gl_FragCoord.xy + shift - 0.5, whole = floor(place), part = place - whole;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 side = ivec2(i & 1, i >> 1);
        ivec2 texel = clamp(ivec2(whole) + side, low, high);
        vec2 weights = mix(1.0 - part, part, vec2(side));
        float weight = weights.x * weights.y;
        weight = depthOfSceneAt(draw.clip, texel) * perDepth > away ? weight : 0.0;
        sum += weight * vec4(texelFetch(sceneColor, texel, 0).rgb, 1.0);
    }
    float shown = sum.a > 1e-3 ? min(pixels / kSeen, 1.0) : 0.0;
    outColor = vec4(sum.rgb / max(sum.a, 1e-3) * shown, shown);
}
