// Stone or char with a relief below the drawn surface: bump mapping, or parallax occlusion with
// depth, shadows and a silhouette.
#version 450
#extension GL_GOOGLE_include_directive : require
#include "relief_block.glsl"
layout(constant_id = 0) const bool kParallax = true;
layout(constant_id = 1) const bool kLinear = true;  // false: write display values
layout(constant_id = 2) const bool kCurved = true;  // false: no surface of the model is curved

layout(set = 1, binding = 0) uniform sampler2D colorMap;  // a: roughness
layout(set = 1, binding = 1) uniform sampler2D shapeMap;  // slopes, cone, height
layout(set = 1, binding = 2) uniform sampler2D horizonMap;  // half resolution

layout(push_constant) uniform Push {
    vec4 picture;  // m: width, height, depth; steepest slope
    vec4 texels;  // width, height; 1: the picture ends at its border; m along v, 0: endless
} push;

layout(location = 0) in vec3 inPosition;
layout(location = 1) in vec3 inNormal;
layout(location = 2) in vec3 inAcross;
layout(location = 3) in vec4 inRelief;
layout(location = 0) out vec4 outColor;
// Hits lie behind the surface, so early depth tests stay possible.
layout(depth_greater) out float gl_FragDepth;

const float kPi = 3.14159265;
float reliefLod;  // a whole mip level costs one read instead of two
vec2 perMetre;  // on the picture; hoisted, since the search evaluates it often
const float kWidestCone = 8.0;  // relief_maps.h

vec4 shape;  // the last sample of the relief
float reliefDepth(vec2 at) {
    shape = textureLod(shapeMap, at * perMetre, reliefLod);
    return 1.0 - shape.a;
}
vec2 reliefCone(vec2 at) {
    vec2 coneAndHeight = textureLod(shapeMap, at * perMetre, reliefLod).ba;
    return vec2(1.0 - coneAndHeight.y, kWidestCone * coneAndHeight.x * coneAndHeight.x);
}
#define RELIEF_CONES
#include "parallax.h"

// Returns m of ray to the picture's border.
float toBorder(vec2 at, vec2 along, vec2 size) {
    vec2 side = mix(vec2(0.0), size, greaterThan(along, vec2(0.0)));
    vec2 reach = (side - at) / mix(along, vec2(1e-9), lessThan(abs(along), vec2(1e-9)));
    return max(min(reach.x, reach.y), 0.0);
}

vec3 display(vec3 c) {
    c = c * (c + 0.0245786) / (c * (0.983729 * c + 0.4329510) + 0.238081);
    return pow(clamp(c, 0.0, 1.0), vec3(1.0 / 2.2));
}

void main() {
    float scale = push.picture.z;
    vec3 n = normalize(inNormal), u = normalize(inAcross - n * dot(inAcross, n)), v = cross(u, n);
    vec3 toEye = block.eye.xyz - inPosition;
    float distance_ = length(toEye);
    toEye /= distance_;
    vec2 at = inRelief.xy;
    perMetre = 1.0 / push.picture.xy;
    vec2 pixel = max(abs(dFdx(at)), abs(dFdy(at))) * perMetre * push.texels.xy;
    reliefLod = floor(max(0.0, log2(max(pixel.x, pixel.y))));

    float travel = 0.0, depth = 0.0;
    if (kParallax) {
        ReliefRay ray;
        ray.at = at;
        ray.along = -vec2(dot(toEye, u), dot(toEye, v));
        ray.depth = inRelief.z;
        ray.down = dot(toEye, n);
        ray.sag = kCurved ? 0.5 * inRelief.w * ray.along.x * ray.along.x : 0.0;
        ray.most = 1e3;
        bool bordered = push.texels.z > 0.5, round_ = kCurved && push.texels.w * inRelief.w > 0.0;
        if (bordered || round_)
            ray.most = toBorder(at, ray.along,
                                bordered ? push.picture.xy : vec2(1e3, push.texels.w));
        travel = reliefHitByCones(ray, scale, int(mix(10.0, 5.0, clamp(ray.down, 0.0, 1.0))));
        if (travel < 0.0) discard;
        at += ray.along * travel;
        depth = reliefBelow(ray, travel);
        if (kCurved) {  // the direction turns with the surface around v
            float turned = inRelief.w * ray.along.x * travel, unit = inversesqrt(1.0 + turned * turned);
            vec3 level = n;
            n = (level + u * turned) * unit;
            u = (u - level * turned) * unit;
        }
    }
    vec3 position = inPosition - toEye * travel;
    vec4 clip = block.viewProjection * vec4(position, 1.0);
    gl_FragDepth = max(clip.z / clip.w, gl_FragCoord.z);

    vec4 color = textureLod(colorMap, at * perMetre, reliefLod);
    if (!kParallax) reliefDepth(at);
    vec3 albedo = color.rgb * color.rgb;
    vec2 slope = (shape.rg * 2.0 - 1.0) * push.picture.w;
    vec3 bent = normalize(n - u * slope.x - v * slope.y);

    vec3 light = mix(block.ambientGround.rgb, block.ambientSky.rgb, 0.5 + 0.5 * bent.y) *
                 (0.45 + 0.55 * shape.a);
    vec4 horizon = vec4(0.0);
    if (kParallax)
        horizon = textureLod(horizonMap, at * perMetre, max(reliefLod - 1.0, 0.0));
    vec3 gloss = vec3(0.0);
    // The added zero is unknown at compile time. Otherwise lavapipe would compile and keep one
    // shader per frame.
    int fires = int(block.sunDirection.w) + (int(gl_FragCoord.x) >> 31);
    for (int i = -1; i < fires; ++i) {
        bool sun = i < 0;
        int k = max(i, 0);
        vec3 to = sun ? block.sunDirection.xyz : block.firePlace[k].xyz - position;
        float far2 = dot(to, to), size = sun ? 0.0 : block.firePlace[k].w;
        vec3 toLight = to * inversesqrt(far2);
        vec3 strong = sun ? block.sunColor.rgb : block.fireColor[k].rgb / (far2 + size * size);
        float facing = dot(bent, toLight);
        facing = sun ? max(facing, 0.0) : max(facing + 0.15, 0.0) / 1.15;
        if (facing <= 0.0) continue;
        float lit = 1.0;
        if (kParallax) {
            float softness = sun ? 8.0 : clamp(1.5 * sqrt(far2) / max(size, 0.01), 1.5, 8.0);
            lit = reliefLitByHorizon(horizon, vec2(dot(toLight, u), dot(toLight, v)),
                                     max(dot(toLight, n), 0.05), softness);
        }
        strong *= facing * lit;
        light += strong;
        vec3 h = normalize(toLight + toEye);
        float rough = color.a * color.a, nh = max(dot(bent, h), 0.0);
        float d = nh * nh * (rough * rough - 1.0) + 1.0;
        gloss += strong * (0.04 * min(rough * rough / (d * d), 40.0) * 0.25);
    }
    // Distant ground fades into the night.
    float fade = 1.0 / (1.0 + 0.02 * distance_ * distance_);
    vec3 c = (albedo / kPi * light + gloss) * (block.eye.w * fade * kPi);
    outColor = vec4(kLinear ? c : display(c), 1.0);
}
