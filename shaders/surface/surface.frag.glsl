#version 450
// A burning surface in the host's pass: looks up when this point caught or will catch fire, lets
// look.glsl say what that looks like, and lights it. Writes linear HDR or what the target shows.
#extension GL_GOOGLE_include_directive : require
#include "shared/burn.h"
#include "shared/look.h"

layout(constant_id = 0) const uint kEncoding = 0u;
// Families of materials that a variant can draw, and whether they can burn (kSurface...). The
// software device runs both sides of every branch, so what is of no use is left out.
layout(constant_id = 2) const uint kVariant = 31u;
const bool kHasWood = (kVariant & kSurfaceWood) != 0u;
const bool kHasSheet = (kVariant & kSurfaceSheet) != 0u;
const bool kHasPlant = (kVariant & kSurfacePlant) != 0u;
const bool kHasHide = (kVariant & kSurfaceHide) != 0u;
const bool kBurns = (kVariant & kSurfaceBurns) != 0u;

layout(set = 0, binding = FW_BIND_OBJECTS, std430) readonly buffer Objects {
    BurnObject objects[];
};
layout(set = 0, binding = FW_BIND_MATERIALS, std430) readonly buffer Materials {
    BurnMaterial materials[];
};
layout(set = 0, binding = FW_BIND_PREDICT, std430) readonly buffer Predict { uint predict[]; };
layout(set = 0, binding = FW_BIND_GRADIENT, std430) readonly buffer Gradient { uint gradient[]; };
layout(set = 0, binding = FW_BIND_LIGHTS, std430) readonly buffer Lights { BurnLight lights[]; };
layout(set = 0, binding = FW_BIND_LOOKS, std430) readonly buffer Looks { MaterialLook looks[]; };
layout(set = 0, binding = FW_BIND_VIEW, std140) uniform View { ViewParams view; };
layout(set = 1, binding = 0) uniform sampler2D baseImage;
layout(set = 2, binding = 0) uniform sampler2DArray lookTextures;
layout(push_constant) uniform Push { uint objectSlot; };

layout(location = 0) in vec3 inPosition;
layout(location = 1) in vec3 inRest;
layout(location = 2) in vec3 inNormal;
layout(location = 3) in vec2 inAtlas;
layout(location = 4) in vec4 inTexture;
layout(location = 5) in vec3 inTint;
layout(location = 6) flat in uvec2 inMaterial;

layout(location = 0) out vec4 outColor;

#include "lib/colour.glsl"
#include "lib/look_noise.glsl"
#include "surface/look.glsl"
#include "surface/base.glsl"

// W/sr of the visible part of a flame to candela: soot glows a little for much heat.
const float kCandelaPerWatt = 0.013;

struct Arrival {
    float age;      // s since ignition, look time not applied; very negative: not in sight
    vec2 gradient;  // s/texel
    float known;    // [0, 1] weight of texels with a tick
    float wet;      // [0, 1]
    float out_;     // [0, 1]
};

// Bilinear over the taps that exist; towards chart borders each tap is continued along its own
// gradient, so that both sides of a seam agree.
Arrival arrivalAt(BurnObject object, vec2 uv) {
    vec2 st = uv - 0.5;
    vec2 corner = floor(st), f = st - corner;
    ivec2 limit = ivec2(int(object.width) - 1, int(object.height) - 1);
    Arrival o;
    o.age = 0.0;
    o.gradient = vec2(0.0);
    o.known = o.wet = o.out_ = 0.0;
    float total = 0.0, never = 0.0;
    float horizon = float(object.horizon) * (1.0 / 4096.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 o2 = ivec2(i & 1, i >> 1);
        ivec2 texel = clamp(ivec2(corner) + o2, ivec2(0), limit);
        uint index = object.stateBase + uint(texel.y) * object.width + uint(texel.x);
        uint t = predict[index];
        if (t == kInert) continue;
        float w = (o2.x == 1 ? f.x : 1.0 - f.x) * (o2.y == 1 ? f.y : 1.0 - f.y) + 1e-4;
        total += w;
        if (t < kLiveEnd) {
            vec2 g = unpackHalf2x16(gradient[index]);
            float age = float(int(view.now - t)) * (1.0 / 4096.0);
            vec2 off = st - corner - vec2(o2);
            o.age += w * (age - 0.5 * dot(g, off));
            o.gradient += w * g;
            o.known += w;
        } else if (t == kOut || t == kOutWet) {
            uint burnt = gradient[index];  // how long it had burnt
            o.age += w * (burnt == 0u ? 60.0 : float(burnt) * (1.0 / 4096.0));
            o.out_ += w;
            o.wet += t == kOutWet ? w : 0.0;
        } else {
            never += w;
            o.wet += t == kWet ? w : 0.0;
        }
    }
    // At a chart's border all four taps can miss: then the nearest texel that exists stands in.
    if (total == 0.0) {
        float best = 1e9;
        for (int i = 0; i < 25; ++i) {
            ivec2 o2 = ivec2(i % 5 - 2, i / 5 - 2);
            ivec2 texel = clamp(ivec2(floor(uv)) + o2, ivec2(0), limit);
            uint index = object.stateBase + uint(texel.y) * object.width + uint(texel.x);
            uint t = predict[index];
            vec2 off = uv - 0.5 - vec2(texel);
            float away = dot(off, off);
            if (t == kInert || away >= best) continue;
            best = away;
            total = 1.0;
            o.gradient = vec2(0.0);
            o.age = o.known = o.out_ = never = 0.0;
            o.wet = t == kOutWet || t == kWet ? 1.0 : 0.0;
            if (t < kLiveEnd) {
                o.gradient = unpackHalf2x16(gradient[index]);
                o.age = float(int(view.now - t)) * (1.0 / 4096.0);
                o.known = 1.0;
            } else if (t == kOut || t == kOutWet) {
                uint burnt = gradient[index];
                o.age = burnt == 0u ? 60.0 : float(burnt) * (1.0 / 4096.0);
                o.out_ = 1.0;
            } else {
                never = 1.0;
            }
        }
    }
    float inverse = 1.0 / max(total, 1e-4);
    if (total == 0.0 || (o.known == 0.0 && o.out_ == 0.0)) {
        o.age = -1e6;
    } else {
        o.age = (o.age - never * horizon) * inverse;
    }
    o.age += view.ambientGround.w * (1.0 / 4096.0);
    if (o.known > 0.0) o.gradient /= o.known;
    o.known *= inverse;
    o.wet *= inverse;
    o.out_ *= inverse;
    return o;
}

vec3 lit(Skin s, vec3 n, vec3 v, vec3 l, vec3 e) {
    float nl = dot(n, l);
    if (nl <= 0.0) return vec3(0.0);
    vec3 h = normalize(l + v);
    float nh = max(0.0, dot(n, h)), vh = max(0.0, dot(v, h)), nv = max(0.05, dot(n, v));
    float a2 = s.rough * s.rough * s.rough * s.rough;
    float t = nh * nh * (a2 - 1.0) + 1.0;
    float d = a2 / (3.14159 * t * t);
    float k = (s.rough + 1.0) * (s.rough + 1.0) / 8.0;
    float g = 0.25 / ((nv * (1.0 - k) + k) * (nl * (1.0 - k) + k));
    float m = 1.0 - vh;
    float fresnel = s.f0 + (1.0 - s.f0) * m * m * m * m * m;
    float gleam = 0.03 * s.sheen * (1.0 - nh * nh) * (1.0 - nh * nh);  // graphite veil
    return e * (s.albedo * (0.31831 * nl) + vec3((d * g * fresnel + gleam) * nl));
}

// `open`: share of the light from outside that gets here; no shadows are traced.
vec3 shade(Skin s, vec3 position, vec3 n, vec3 v, float open) {
    if (dot(n, v) < 0.02) n = normalize(n + v * (0.04 - dot(n, v)));
    vec3 c = s.emission * (view.sunColor.w / kWhiteLuminance);
    c += lit(s, n, v, view.sunDirection.xyz,
             view.sunColor.rgb * (open * (0.35 + 0.65 * s.occlusion)));
    float height = dot(n, view.up.xyz);
    c += mix(view.ambientGround.rgb, view.ambientSky.rgb, 0.5 + 0.5 * height) * s.albedo *
         (open * s.occlusion);
    vec3 mirror = reflect(-v, n);
    vec3 env = mix(view.ambientGround.rgb * 0.8, view.ambientSky.rgb * 1.6,
                   smoothstep(-0.3, 0.6, dot(mirror, view.up.xyz)));
    float m = 1.0 - max(0.0, dot(n, v)), m2 = m * m;
    float fresnel = s.f0 + (max(1.0 - s.rough, s.f0) - s.f0) * m2 * m2 * m;
    c += env * (open * fresnel * s.occlusion * (1.0 - 0.5 * s.rough));

    vec3 fire = vec3(0.0);
    for (uint i = 0u; i < view.lightCount; ++i) {
        vec4 at = lights[i].positionRadius;
        vec4 color = lights[i].colorIntensity;
        if (color.w <= 0.0) break;  // strongest first
        vec3 d = at.xyz - view.eye.xyz - position;
        float r2 = dot(d, d);
        float wrapped = max(0.0, dot(n, d) * inversesqrt(max(r2, 1e-8)) + 0.25) * 0.64;
        fire += color.rgb * (color.w * wrapped / (r2 + max(at.w * at.w * 0.25, 0.004)));
    }
    fire *= kCandelaPerWatt * view.sunColor.w / kWhiteLuminance;
    // Softly limited: a flame that touches the surface must not bleach it.
    fire /= 1.0 + 0.4 * view.sunDirection.w * (fire.r + fire.g);
    c += fire * s.albedo * (open * s.occlusion * 0.31831);
    return c;
}

void main() {
    BurnObject object = objects[objectSlot];
    uint row = objectSlot * kMaterialsPerObject + inMaterial.x;
    MaterialLook look = looks[materials[row].look];
    float timeScale = materials[row].timeScale;
    if ((object.flags & kObjectNoHoles) != 0u) look.holeTime = 0.0;
    // The rim shows the host's thickness within what the look was made for.
    if (materials[row].thickness > 0.0)
        look.thickness =
            clamp(materials[row].thickness, 0.4 * look.thickness, 2.0 * look.thickness);

    // The tangent plane: how atlas and detail coordinates move along the surface.
    vec3 normal = normalize(inNormal);
    vec3 px = dFdx(inPosition), py = dFdy(inPosition);
    vec3 toEye = view.forward.w > 0.5 ? normalize(-inPosition) : -view.forward.xyz;
    vec3 face = cross(px, py);
    face *= dot(face, toEye) < 0.0 ? -1.0 : 1.0;
    bool back = dot(face, normal) < 0.0;
    vec3 r1 = cross(py, normal), r2 = cross(normal, px);
    float det = dot(px, r1);
    float inverse = abs(det) > 1e-16 ? 1.0 / det : 0.0;
    r1 *= inverse;
    r2 *= inverse;
    vec2 ux = dFdx(inAtlas), uy = dFdy(inAtlas);
    vec3 gradU = r1 * ux.x + r2 * uy.x, gradV = r1 * ux.y + r2 * uy.y;  // texels/m
    float depth = view.forward.w > 0.5 ? dot(inPosition, view.forward.xyz) : 1.0;
    float facing = max(abs(dot(normal, toEye)), 0.2);
    float pixel = view.eye.w * depth * inversesqrt(facing);

    bool detailed = (object.flags & kObjectDetail) != 0u;
    vec2 d;
    vec3 axisX, axisY;
    if (detailed) {
        d = inTexture.zw;
        vec2 dx = dFdx(d), dy = dFdy(d);
        axisX = r1 * dx.x + r2 * dy.x;
        axisY = r1 * dx.y + r2 * dy.y;
        axisX /= max(length(axisX), 1e-4);
        axisY /= max(length(axisY), 1e-4);
    } else {
        // Dominant axis of the normal, dithered by noise: ragged joins do not show in wood.
        float scale = length(object.worldRow0.xyz);
        vec3 ex = vec3(object.worldRow0.x, object.worldRow1.x, object.worldRow2.x) / scale;
        vec3 ey = vec3(object.worldRow0.y, object.worldRow1.y, object.worldRow2.y) / scale;
        vec3 ez = vec3(object.worldRow0.z, object.worldRow1.z, object.worldRow2.z) / scale;
        vec4 dither = noiseAt(vec2(inRest.x + inRest.z, inRest.y), 6.0, pixel);
        vec3 w = abs(vec3(dot(normal, ex), dot(normal, ey), dot(normal, ez))) +
                 (vec3(dither.r, dither.g + 0.1, dither.b) - 0.5) * 0.35;
        if (w.x > w.y && w.x > w.z) {
            d = inRest.zy;
            axisX = ez;
            axisY = ey;
        } else if (w.y > w.z) {
            d = inRest.xz;
            axisX = ex;
            axisY = ez;
        } else {
            d = inRest.xy;
            axisX = ex;
            axisY = ey;
        }
    }

    vec4 coarse, fine;
    vec2 warp = frontWarp(d, pixel, look, coarse, fine);
    vec3 along = axisX * warp.x + axisY * warp.y;
    vec2 shift = vec2(dot(gradU, along), dot(gradV, along));  // texels
    // A long shift could leave the chart: what is beyond half a texel goes the linear way.
    vec2 near = clamp(shift, -0.5, 0.5);
    Arrival arrival = Arrival(-1e6, vec2(0.0), 0.0, 0.0, 0.0);
    if (kBurns) {
        arrival = arrivalAt(object, inAtlas + near);
        arrival.age -= dot(arrival.gradient, shift - near);
    }

    vec3 color = materials[row].baseColor.rgb;
    Base fresh;
    if (object.image != 0u) {
        fresh = freshBase(kBasePlain, d, pixel, detailed, color, coarse, fine);
        color = texture(baseImage, inTexture.xy).rgb;
        fresh.factor = vec3(1.0);
        fresh.rough = materials[row].roughness;
        fresh.delay = (fine.b - 0.5) * 1.2;
        fresh.cavity = 0.45 + 0.55 * saturate(dot(color, vec3(0.9)) + 0.3);
    } else {
        fresh = freshBase(inMaterial.y, d, pixel, detailed, color, coarse, fine);
        fresh.rough = clamp(fresh.rough + materials[row].roughness - 0.7, 0.1, 1.0);
    }

    // Differences between pixels before any branch, and only of what no buffer is read for: lanes
    // outside the triangle read nothing.
    float height = -fresh.height;
    vec2 relief = vec2(dFdx(height), dFdy(height));
    relief = clamp(relief, -pixel, pixel);
    float bubble = bubbleShape(d, pixel, coarse, inMaterial.y != kBasePaint);
    vec3 swell = r1 * dFdx(bubble) + r2 * dFdy(bubble);

    Site site;
    site.d = d;
    site.pixel = pixel;
    site.age = arrival.age * timeScale;
    vec3 slope = (gradU * arrival.gradient.x + gradV * arrival.gradient.y) * timeScale;  // s/m
    vec2 flat_ = vec2(dot(slope, axisX), dot(slope, axisY));
    float steep = length(flat_);
    float rate = max(look.spreadRate, 1e-5);
    site.slow = clamp(length(slope), 0.25 / rate, 1.6 / rate);
    site.ahead = steep > 1e-6 ? flat_ / steep : vec2(0.0, 1.0);
    site.out_ = saturate(arrival.out_ * 1.5);
    site.water = smoothstep(0.25, 0.75, arrival.wet);
    bool inside = back && (object.flags & kObjectTwoSided) == 0u;
    site.soot = inside ? 0.92 * smoothstep(-10.0, -0.3, site.age / max(look.charTime, 1e-3)) : 0.0;
    site.base = color * fresh.factor * inTint;
    site.baseRough = fresh.rough;
    site.delay = clamp(fresh.delay, -1.5, 1.5);
    site.cavity = fresh.cavity;
    site.time = view.ambientSky.w;
    site.coarse = coarse;
    site.fine = fine;
    site.bubbleSlope = vec2(dot(swell, axisX), dot(swell, axisY));

    float ahead = 1.3 * max(look.scorchWidth, look.wiltColor.w) * site.slow + 1.5 * look.jitter;
    bool cold = !kBurns || look.spreadRate <= 0.0 || site.age < -ahead;
    Skin skin;
    vec3 position = inPosition;
    vec3 facingNormal = back ? -normal : normal;
    float deep = -1.0;
    skin = freshSkin(site, look);
    if (inside) skin.occlusion = 0.4;
    if (kBurns && !cold) {
        float a = site.age - look.jitter * site.delay;
        if (holeEdge(a, site, site.fine.rb, look) < 0.0) {
            vec3 ray = vec3(dot(-toEye, axisX), dot(-toEye, axisY), -abs(dot(toEye, normal)));
            Site hit;
            float jitter = hash(uvec3(gl_FragCoord.xy, 3u));
            deep = rimMarch(site, look, ray, jitter, hit);
            if (deep < 0.0) discard;
            hit.soot = 0.0;
            site = hit;
            vec2 bump = noiseAt(hit.d + vec2(0.8 * deep), 20.0, pixel).rb - 0.5;
            // The wall faces the hole: away from fresh material.
            vec3 wall = -(axisX * site.ahead.x + axisY * site.ahead.y);
            facingNormal = normalize(wall + facingNormal * (0.4 - 1.2 * deep / look.thickness) +
                                     0.8 * (axisX * bump.x + axisY * bump.y));
            position -= toEye * deep;
        }
        skin = burningSkin(site, look);
        if (deep >= 0.0) {
            skin.slope = vec2(0.0);
            skin.occlusion *= 0.8;
        } else if (inside) {
            skin.occlusion *= 0.5;
        }
    }

    float charred = smoothstep(0.0, max(look.charTime, 1e-3), site.age);
    relief *= deep >= 0.0 ? 0.0 : 1.0 - 0.6 * charred;
    vec3 tilt = axisX * clamp(skin.slope.x, -1.4, 1.4) + axisY * clamp(skin.slope.y, -1.4, 1.4);
    tilt += r1 * relief.x + r2 * relief.y;
    tilt -= normal * dot(normal, tilt);
    tilt *= min(1.0, 1.6 * inversesqrt(max(dot(tilt, tilt), 1e-8)));
    vec3 n = normalize(facingNormal + (deep >= 0.0 ? vec3(0.0) : (back ? -tilt : tilt)));

    vec3 linear = shade(skin, position, n, toEye, inside ? 0.3 : 1.0);
    outColor = vec4(encodeOutput(min(linear, vec3(60000.0)) * view.sunDirection.w, kEncoding), 1.0);
}
