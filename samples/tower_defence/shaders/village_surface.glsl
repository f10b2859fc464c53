// Shading of all opaque surfaces of the village. FW_LAND adds parallax occlusion to ground and
// road, with depth and shadows.
#include "frame.glsl"

// 0: a kit model, 1: the ground, 2: the road, 3: the pond
layout(constant_id = 0) const int kSurface = 0;

layout(set = 1, binding = 0) uniform sampler2D colorMap;
layout(set = 1, binding = 1) uniform sampler2D reliefMap;

layout(push_constant) uniform Push {
    vec4 uvWindow;  // image uv = (uv - xy) * zw
    vec4 metres;  // xy: the image's size in m
} push;

layout(location = 0) in vec3 inPlace;
layout(location = 1) in vec3 inNormal;
layout(location = 2) in vec2 inUv;
layout(location = 3) in vec3 inTraits;
layout(location = 4) in vec3 inTint;
layout(location = 0) out vec4 outColor;

const float kPi = 3.14159265;
const float kReliefRange = 1.5;

struct Skin {
    vec3 albedo;
    float roughness, metalness, soft;
};

// Returns the visible share of the sun: the four nearest texels, weighted by distance.
float sunlight(vec3 place, vec3 normal) {
    vec3 from = place + normal * (1.6 * frame.toSun.w);
    vec4 s = frame.shadowMatrix * vec4(from, 1.0);
    vec4 lit = step(vec4(s.z - 0.0006), textureGather(shadowMap, s.xy, 0));
    vec2 f = fract(s.xy * frame.eye.w - 0.5);
    return mix(mix(lit.w, lit.z, f.x), mix(lit.x, lit.y, f.x), f.y);
}

vec3 shade(Skin skin, vec3 n, vec3 toEye, vec3 toLight, vec3 light, float wrap) {
    float facing = clamp((dot(n, toLight) + wrap) / (1.0 + wrap), 0.0, 1.0);
    vec3 result = skin.albedo * (1.0 - 0.85 * skin.metalness) * (facing / kPi);
    if (kSurface == 1) return light * result;  // grass and dirt have no specular highlight
    vec3 h = normalize(toLight + toEye);
    float a = skin.roughness * skin.roughness, a2 = a * a;
    float nh = clamp(dot(n, h), 0.0, 1.0), d = nh * nh * (a2 - 1.0) + 1.0;
    float fresnel = 1.0 - clamp(dot(h, toEye), 0.0, 1.0);
    fresnel *= fresnel * fresnel * fresnel * fresnel;
    vec3 f0 = mix(vec3(0.04), skin.albedo, skin.metalness);
    float gloss = min(a2 / (d * d), 60.0) * 0.08 * facing * (1.0 - 0.5 * skin.roughness);
    return light * (result + (f0 + (1.0 - f0) * fresnel) * gloss);
}

// Bends the normal by the image's slopes, through the surface gradient of the uv.
vec3 bend(vec3 n, vec2 slopes, vec2 metres) {
    vec3 px = dFdx(inPlace), py = dFdy(inPlace);
    vec2 ux = dFdx(metres), uy = dFdy(metres);
    vec3 cx = cross(py, n), cy = cross(n, px);
    float area = dot(px, cx);
    vec3 gradient = cx * dot(ux, slopes) + cy * dot(uy, slopes);
    return normalize(n - gradient / (abs(area) > 1e-9 ? area : 1e-9));
}

#ifdef FW_LAND
layout(depth_greater) out float gl_FragDepth;
float deepest() { return kSurface == 2 ? 0.045 : 0.16; }  // m, as in paint.h
float reliefLod;
float reliefDepth(vec2 at) {
    float height = textureLod(reliefMap, at, reliefLod).a;
    return clamp(kSurface == 2 ? (1.0 - height) / 0.75 : 1.0 - height, 0.0, 1.0);
}
#include "parallax.h"

// Movement of the image's uv per m along the surface.
struct Gradient {
    vec3 u, v;
};
Gradient gradientOf(vec3 n, vec2 uv) {
    vec3 px = dFdx(inPlace), py = dFdy(inPlace), cx = cross(py, n), cy = cross(n, px);
    vec2 ux = dFdx(uv), uy = dFdy(uv);
    float area = dot(px, cx);
    area = 1.0 / (abs(area) > 1e-9 ? area : 1e-9);
    return Gradient((cx * ux.x + cy * uy.x) * area, (cx * ux.y + cy * uy.y) * area);
}
#endif

float pondNoise(vec2 p) {
    return sin(p.x * 3.1 + sin(p.y * 2.3)) * sin(p.y * 4.7 + 1.3 * sin(p.x * 1.9));
}

void main() {
    vec3 n = normalize(gl_FrontFacing ? inNormal : -inNormal);
    vec2 uv = (inUv - push.uvWindow.xy) * push.uvWindow.zw;
    vec2 metres = uv * push.metres.xy;  // of the surface, for its slopes
    vec3 place = inPlace, toEye = normalize(frame.eye.xyz - place);
    float shadow = 1.0;  // shadow of the relief itself
#ifdef FW_LAND
    Gradient gradient = gradientOf(n, uv);
    vec2 texels = vec2(textureSize(reliefMap, 0));
    vec2 pixel = max(abs(dFdx(uv)), abs(dFdy(uv))) * texels;
    reliefLod = max(0.0, log2(max(pixel.x, pixel.y)) - 0.5);
    texels *= exp2(-reliefLod);
    float deep = deepest();
    ReliefRay ray;
    ray.at = uv;
    ray.along = -vec2(dot(gradient.u, toEye), dot(gradient.v, toEye));
    ray.depth = 0.0;
    ray.down = max(dot(toEye, n), 0.15);
    ray.sag = 0.0;
    ray.most = 1e3;
    float crossed = length(ray.along * texels) * deep / ray.down;
    float travel = reliefHit(ray, deep, reliefLayers(ray.down, crossed, 6.0, 32.0));
    float depth = reliefBelow(ray, travel);
    uv += ray.along * travel;
    place -= toEye * travel;
    vec4 clip = frame.viewProjection * vec4(place, 1.0);
    gl_FragDepth = max(clip.z / clip.w, gl_FragCoord.z);
    float up = dot(frame.toSun.xyz, n);
    vec2 along = vec2(dot(gradient.u, frame.toSun.xyz), dot(gradient.v, frame.toSun.xyz));
    crossed = length(along * texels) * depth / max(up, 0.05);
    int layers = depth > 0.06 * deep ? reliefLayers(up, crossed, 4.0, 12.0) : 0;
    shadow = reliefLit(uv, along, up, depth, deep, 4.0, layers);
    vec4 color = textureLod(colorMap, uv, reliefLod), relief = textureLod(reliefMap, uv, reliefLod);
#else
    vec4 color = texture(colorMap, uv), relief = texture(reliefMap, uv);
#endif
    color.rgb *= color.rgb;
    if (kSurface == 2 && relief.a < 0.125) discard;

    Skin skin;
    skin.albedo = color.rgb * inTint;
    skin.roughness = relief.b;
    skin.metalness = kSurface == 0 ? relief.a : 0.0;
    skin.soft = inTraits.z;
    float open = kSurface == 0 ? inTraits.x : color.a;
    if (kSurface == 3) {
        float t = frame.cameraUp.w;
        vec2 p = place.xz;
        vec2 ripple = vec2(pondNoise(p * 1.3 + 0.3 * t), pondNoise(p.yx * 1.1 - 0.25 * t));
        n = normalize(vec3(0.05 * ripple.x, 1.0, 0.05 * ripple.y));
        float rim = length((place.xz - vec2(13.2, 7.2)) / vec2(4.3, 2.9));
        skin.albedo = mix(vec3(0.008, 0.030, 0.036), vec3(0.045, 0.105, 0.085),
                          smoothstep(0.45, 0.98, rim));
        skin.roughness = 0.08;
        open = 1.0;
    } else {
        n = bend(n, (relief.rg - 0.5) * (2.0 * kReliefRange * 0.85), metres);
    }

    float wrap = 0.25 * skin.soft;
    float lit = dot(n, frame.toSun.xyz) > -wrap ? shadow * sunlight(place, n) : 0.0;
    vec3 result = shade(skin, n, toEye, frame.toSun.xyz, frame.sun.rgb * (0.5 * kPi) * lit, wrap);

    vec3 ambient = mix(frame.ground.rgb, frame.sky.rgb, 0.5 + 0.5 * n.y);
    vec3 f0 = mix(vec3(0.04), skin.albedo, skin.metalness);
    result += ambient * open *
              (skin.albedo * (1.0 - 0.85 * skin.metalness) + f0 * (0.9 * skin.metalness));
    if (skin.soft > 0.5) {  // thin surfaces glow against the sun
        float behind = clamp(-dot(toEye, frame.toSun.xyz), 0.0, 1.0);
        result += skin.albedo * frame.sun.rgb * (0.12 * behind * behind * behind * behind * open);
    }
    if (kSurface == 3 || skin.metalness > 0.5) {
        vec3 r = reflect(-toEye, n);
        float fresnel = 1.0 - clamp(dot(toEye, n), 0.0, 1.0);
        fresnel = 0.04 + 0.96 * fresnel * fresnel * fresnel * fresnel * fresnel;
        vec3 mirrored = mix(frame.haze.rgb, frame.sky.rgb * 1.1, smoothstep(-0.1, 0.7, r.y));
        result += mirrored * (kSurface == 3 ? vec3(1.6 * fresnel) : 0.35 * skin.albedo * open);
    }
    // Fires are large and near: their light is soft and needs no specular term.
    int lights = int(frame.sun.w);
    vec3 fire = vec3(0.0);
    for (int i = 0; i < lights; ++i) {
        vec3 to = frame.lightPlaces[i].xyz - place;
        float far2 = dot(to, to), reach2 = frame.lightPlaces[i].w * frame.lightPlaces[i].w;
        if (far2 > reach2) continue;
        float size = frame.lightColors[i].w;
        float window = 1.0 - far2 * far2 / (reach2 * reach2);
        float facing = max(dot(n, to) * inversesqrt(far2) + 0.35, 0.0) / 1.35;
        fire += frame.lightColors[i].rgb * (facing * window * window / (far2 + size * size));
    }
    result += fire * skin.albedo * ((0.7 * open + 0.3) / kPi);
    if (inTraits.y > 0.0) {  // coals and windows
        float heat = color.a * 1.7 - 0.4;
        bool hot = inTraits.y > 1.5;
        vec3 coal = mix(vec3(0.5, 0.045, 0.006), vec3(1.0, 0.30, 0.04), clamp(heat, 0.0, 1.0)) *
                    max(heat, 0.12);
        result = result * 0.5 + (hot ? coal * (0.75 * inTraits.y)
                                     : vec3(1.0, 0.52, 0.16) * (inTraits.y * frame.sky.w));
    }
    float away = max(abs(place.x) * 0.9, -place.z);
    result = mix(result, frame.haze.rgb * 0.8, 0.44 * smoothstep(14.0, 32.0, away));
    outColor = vec4(result, 1.0);
}
