// How far the host's scene is, for volumetric flames.
#include "lib/scene_depth.glsl"

// m along the view to what the host drew, from depth = clip z / clip w. `clip`: as VolumeDraw's.
float depthOfSceneAt(vec4 clip, ivec2 pixel) {
    float depth = texelFetch(sceneDepth, pixel, 0).r;
    float per = clip.x - depth * clip.z;
    float at = (depth * clip.w - clip.y) / (abs(per) > 1e-12 ? per : 1e-12);
    return at > 0.0 ? at : 1e9;  // at the far end of an infinite view
}
float depthOfScene(vec4 clip) { return depthOfSceneAt(clip, ivec2(gl_FragCoord.xy)); }
