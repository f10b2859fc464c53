// Distance of the host's scene, for volumetric flames.
#include "lib/scene_depth.glsl"
#include "shared/volume_draw.h"

// m along the view. clip: VolumeDraw::clip.
float depthOfSceneAt(vec4 clip, ivec2 pixel) {
    return metresOfDepth(clip, texelFetch(sceneDepth, pixel, 0).r);
}
float depthOfScene(vec4 clip) { return depthOfSceneAt(clip, ivec2(gl_FragCoord.xy)); }
