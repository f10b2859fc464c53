// How far the host's scene is, for volumetric flames.
#include "lib/scene_depth.glsl"

// m along the view to what has a depth = clip z / clip w. `clip`: as VolumeDraw's.
float metresOf(vec4 clip, float depth) {
    float per = clip.x - depth * clip.z;
    float at = (depth * clip.w - clip.y) / (abs(per) > 1e-12 ? per : 1e-12);
    return at > 0.0 ? at : 1e9;  // at the far end of an infinite view
}
float depthOfSceneAt(vec4 clip, ivec2 pixel) { return metresOf(clip, texelFetch(sceneDepth, pixel, 0).r); }
float depthOfScene(vec4 clip) { return depthOfSceneAt(clip, ivec2(gl_FragCoord.xy)); }
