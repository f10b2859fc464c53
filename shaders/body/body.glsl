// Shared by the passes of bodies. Heights are along the world's up.
#include "volume/flame.glsl"
#include "shared/body.h"

float bodyEase(float y) { return smoothstep(0.0, 1.6, y); }
// s of wind by which gas lies downwind at height s: it is slow at the foot, so it bends most there.
float bodyLag(float s, float h) { return 0.22 * s * inversesqrt(s + 0.3 * h); }
vec3 acrossUp(vec3 v) { return v - view.up.xyz * dot(v, view.up.xyz); }
// A direction across up.
vec3 acrossAxis() {
    vec3 up = view.up.xyz;
    return normalize(abs(up.y) > 0.9 ? vec3(1.0, 0.0, 0.0) - up * up.x : cross(up, vec3(0.0, 1.0, 0.0)));
}
