// Distance of the host's scene behind a fragment. The includer declares `view`.
#include "lib/scene_depth.glsl"

// m along the view from the fragment to the host's scene; below 0: the fragment is behind it. For
// any projection matrix, reversed or infinite: depth is A + B / w with A and B from its rows.
float gapToScene() {
    float depth = texelFetch(sceneDepth, ivec2(gl_FragCoord.xy), 0).r;
    vec3 alongZ = vec3(view.clip0.z, view.clip1.z, view.clip2.z);
    vec3 alongW = vec3(view.clip0.w, view.clip1.w, view.clip2.w);
    if (view.forward.w < 0.5) {  // orthographic
        float perMetre = dot(alongZ, view.forward.xyz);
        return (depth - gl_FragCoord.z) / (abs(perMetre) > 1e-12 ? perMetre : 1e-12);
    }
    float a = dot(alongZ, alongW) / dot(alongW, alongW), b = view.clip3.z - a * view.clip3.w;
    float d = (depth - a) / b;  // 1 / w
    float here = (gl_FragCoord.z - a) / b;
    return 1.0 / max(d, 1e-6) - 1.0 / max(here, 1e-6);
}
