// Rough grey plaster under the sun, the sky and the fires, with the object's shadow on the floor.
#version 450
#extension GL_GOOGLE_include_directive : require
#include "studio_block.glsl"
layout(constant_id = 0) const int displayValues = 0;  // 0: linear, 1: tone mapped, 2: tone mapped
                                                      // and encoded
layout(location = 0) in vec3 worldPosition;
layout(location = 1) in vec3 worldNormal;
layout(location = 0) out vec4 color;
layout(push_constant) uniform Push { float solid; } push;  // 0: the room, 1: a stone block
layout(set = 0, binding = 1) uniform sampler2D plaster;
layout(set = 0, binding = 2) uniform sampler2D shadow;

vec3 display(vec3 c) {
    c = c * (c + 0.0245786) / (c * (0.983729 * c + 0.4329510) + 0.238081);
    if (displayValues == 1) return clamp(c, 0.0, 1.0);
    return pow(clamp(c, 0.0, 1.0), vec3(1.0 / 2.2));
}

void main() {
    vec3 n = normalize(worldNormal);
    vec3 local = worldPosition - block.center.xyz;
    float scale = 1.0 / block.sunColor.w;
    // Unfolds the wall into the floor's plane, so that no seam shows.
    vec2 uv = local.xz * (1.0 + max(0.0, local.y) / block.center.w) * scale;
    vec2 side = abs(n.x) > 0.5 ? local.zy : local.xy;
    if (push.solid > 0.5) uv = 2.0 * (abs(n.y) > 0.5 ? local.xz : side) * scale;
    vec2 grain = texture(plaster, uv * 0.41).rg;
    vec3 albedo = mix(vec3(0.150, 0.145, 0.140), vec3(0.20, 0.215, 0.24),
                      smoothstep(0.0, 0.3, local.y * scale));
    albedo *= 0.70 + 0.42 * grain.r + 0.18 * grain.g;
    if (push.solid > 0.5) albedo *= vec3(0.62, 0.60, 0.57);
    vec2 place = local.xz / (2.0 * block.ambientSky.w) + 0.5;
    vec2 shade = vec2(1.0);
    bool mapped = all(greaterThan(place, vec2(0.0))) && all(lessThan(place, vec2(1.0)));
    if (mapped && push.solid < 0.5) {
        shade = 1.0 - texture(shadow, place).rg * smoothstep(0.5, 0.9, n.y);
    }
    // The room darkens away from the lamp, which keeps attention on the object.
    float pool = 1.0 / (1.0 + 0.55 * dot(local, local) * scale * scale / 9.0);
    vec3 light = block.sunColor.rgb * max(0.0, dot(n, block.sunDirection.xyz)) * shade.x * pool;
    light += mix(block.ambientGround.rgb, block.ambientSky.rgb, 0.5 + 0.5 * n.y) * shade.y *
             (0.35 + 0.65 * pool);
    // The added zero is unknown at compile time. Otherwise lavapipe would compile and keep one
    // shader per frame.
    int fires = int(block.ambientGround.w) + (int(gl_FragCoord.x) >> 31);
    for (int i = 0; i < fires; ++i) {
        vec3 to = block.firePlace[i].xyz - worldPosition;
        float squared = dot(to, to) + block.firePlace[i].w;
        float faces = dot(n, to) * inversesqrt(squared);
        // The floor reflects light, except to surfaces above a fire that face up.
        float away = clamp(-4.0 * faces, 0.0, 1.0) * max(0.0, n.y);
        faces = 0.8 * max(0.0, faces) + 0.2 * (1.0 - away);
        light += block.fireColor[i].rgb * faces * mix(1.0, shade.y, 0.6) / squared;
    }
    vec3 c = albedo * light * block.sunDirection.w;
    if (displayValues != 0) c = display(c);
    color = vec4(c, 1.0);
}
