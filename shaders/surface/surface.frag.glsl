// A burning surface in the host's pass: looks up the ignition time, evaluates appearance.glsl, and
// lights the result. Writes linear HDR or encoded colour.
#include "surface/surface.glsl"
#include "shared/heat.h"

layout(constant_id = 0) const uint kEncoding = 0u;
const bool kHasPaint = (kVariant & kSurfacePaint) != 0u;
const bool kHasWood = (kVariant & kSurfaceWood) != 0u;
const bool kHasSheet = (kVariant & kSurfaceSheet) != 0u;
const bool kHasPlant = (kVariant & kSurfacePlant) != 0u;
const bool kHasHide = (kVariant & kSurfaceHide) != 0u;
const bool kImage = (kVariant & kSurfaceImage) != 0u;
const bool kBurns = (kVariant & kSurfaceBurns) != 0u;
const bool kCold = (kVariant & kSurfaceCold) != 0u;

FW_READ(PREDICT) FW_READ(GRADIENT) FW_BUFFER(HEAT, readonly, uint, heat)
FW_UNIFORM(APPEARANCES, MaterialAppearance, appearances[kAppearanceRows])
layout(set = 1, binding = 0) uniform sampler2D baseImage;
layout(set = 2, binding = 0) uniform sampler2DArray appearanceTextures;

layout(location = 0) out vec4 outColor;

#ifdef FW_MULTISAMPLED
#define FW_POSITION vMiddle
#define FW_ATLAS vMiddleUv.xy
#define FW_DETAIL vMiddleUv.zw
#else
#define FW_POSITION vPositionFire.xyz
#define FW_ATLAS vTexture.xy
#define FW_DETAIL vDetail.xy
#endif

#if FW_MULTISAMPLED == 2
// Samples of the target. Coverage per sample makes hole rims as smooth as triangle edges. Alpha to
// coverage would change the picture's alpha and cannot choose samples.
layout(constant_id = 4) const uint kSamples = 4u;
// Vulkan's standard sample positions for 2, 4, 8 and 16 samples, in sixteenths of a pixel from its
// middle.
const ivec2 kSamplePlaces[30] =
    ivec2[30](ivec2(4, 4), ivec2(-4, -4), ivec2(-2, -6), ivec2(6, -2), ivec2(-6, 2), ivec2(2, 6),
              ivec2(1, -3), ivec2(-1, 3), ivec2(5, 1), ivec2(-3, -5), ivec2(-5, 5), ivec2(-7, -1),
              ivec2(3, 7), ivec2(7, -7), ivec2(1, 1), ivec2(-1, -3), ivec2(-3, 2), ivec2(4, -1),
              ivec2(-5, -2), ivec2(2, 5), ivec2(5, 3), ivec2(3, -5), ivec2(-2, 6), ivec2(0, -7),
              ivec2(-4, -6), ivec2(-6, 4), ivec2(-8, 0), ivec2(7, -4), ivec2(6, 7), ivec2(-7, -8));
#endif

#include "lib/colour.glsl"
#include "lib/gradient.glsl"
#include "lib/appearance_noise.glsl"
#include "surface/base.glsl"
#include "surface/appearance.glsl"

// W/sr of a flame's visible part to candela: soot emits little light for much heat.
const float kCandelaPerWatt = 0.013;

ivec2 lastTexel() { return ivec2(int(draw.size & 0xFFFFu), int(draw.size >> 16u)) - 1; }
uint texelAt(ivec2 texel) { return uint(texel.y) * (draw.size & 0xFFFFu) + uint(texel.x); }

struct Arrival {
    float age;      // s since ignition, real time; very negative: not in sight
    vec2 gradient;  // s/texel
    float known;    // [0, 1] weight of texels with a time
    float out_;     // [0, 1]
    float damp;     // [0, 1] unburnt and wet
    float ahead;    // texels from the wet ones to the fire
    float soot;     // [0, 1]
    bool none;      // no texel is near
};

// Bilinear over valid taps. At chart borders each tap is extrapolated along its gradient, so both
// sides of a seam agree; where all four miss, the nearest of the 25 around are used. steepest:
// s/texel; beyond it, where fronts meet, slopes are meaningless. scorch: s before a front that
// show: beside extinguished texels nothing arrives, and the rim is one texel.
Arrival arrivalAt(vec2 uv, float steepest, float scorch) {
    vec2 st = uv - 0.5;
    vec2 corner = floor(st);
    ivec2 limit = lastTexel();
    Arrival o;
    o.age = 0.0;
    o.gradient = vec2(0.0);
    o.known = o.out_ = o.damp = 0.0;
    float total = 0.0, never = 0.0, ahead = 0.0, soot = 0.0;
    // The test comes first: lavapipe keeps a lane's values from its last test when it leaves a loop
    // early.
    int taps = 4;
    for (int i = 0; i < taps; ++i) {
        ivec2 o2 = i < 4 ? ivec2(i & 1, i >> 1) : ivec2((i - 4) % 5 - 2, (i - 4) / 5 - 2);
        ivec2 texel = clamp(ivec2(corner) + o2, ivec2(0), limit);
        uint index = draw.stateBase + texelAt(texel);
        uint t = predict[index], packed = gradient[index];
        vec2 off = st - corner - vec2(o2);
        float away = dot(off, off);
        vec2 share = 1.0 - abs(off);
        float w = i < 4 ? share.x * share.y + 1e-4 : 1e-3 / (away * away * away + 1e-3);
        if (t == kInert) w = 0.0;
        total += w;
        bool live = t < kLiveEnd, doused = t == kOut || t == kOutWet;
        vec2 g = live ? unpackGradient(packed) : vec2(0.0);
        g *= min(1.0, steepest * inversesqrt(max(dot(g, g), 1e-12)));
        float age = float(int(view.now - t)) * (1.0 / 4096.0) - 0.5 * dot(g, off);
        // Age when it was put out.
        if (doused) age = packed == 0u ? 60.0 : float(packed) * (1.0 / 4096.0);
        o.age += live || doused ? w * age : 0.0;
        o.gradient += w * g;
        o.known += live ? w : 0.0;
        o.out_ += doused ? w : 0.0;
        o.damp += t == kWet ? w : 0.0;
        ahead += t == kWet ? w * unpackAhead(packed) : 0.0;
        soot += doused ? 0.0 : w * float(packed & 0xFFu);
        never += t == kNever ? w : 0.0;
        if (i == 3 && total == 0.0) taps = 29;
    }
    o.none = total == 0.0;
    float inverse = 1.0 / max(total, 1e-6), burnt = o.known + o.out_;
    o.soot = soot / max(total - o.out_, 1e-6) * (1.0 / 255.0);
    if (burnt <= 0.0) {
        o.age = -1e6;
    } else {
        // Wet texels carry no time: see dampen().
        float before = o.out_ > 0.0 ? min(scorch, draw.horizon) : draw.horizon;
        o.age = (o.age - never * before) / (burnt + never);
    }
    o.ahead = o.damp > 0.0 ? ahead / o.damp : 1e3;
    o.age += view.ambientGround.w * (1.0 / 4096.0);
    if (o.known > 0.0) o.gradient /= o.known;
    o.known *= inverse;
    o.out_ *= inverse;
    o.damp *= inverse;
    return o;
}

struct Warmth {
    float kelvin;
    float eaten;  // [0, 1] of the fuel consumed
};

// Samples the heat buffer. A loop: a branch would cost every mesh the loads.
Warmth warmthAt(vec2 uv) {
    vec2 st = uv - 0.5;
    vec2 corner = floor(st);
    ivec2 limit = lastTexel();
    float total = 1e-6, kelvin = 300.0 * total, fuel = total;
    bool hasHeat = (draw.flags & kDrawHeat) != 0u;
    int taps = hasHeat ? 4 : 1, i = 0;
    do {
        ivec2 o2 = ivec2(i & 1, i >> 1);
        ivec2 texel = clamp(ivec2(corner) + o2, ivec2(0), limit);
        uint at = 2u * (draw.heatBase + texelAt(texel));
        uint word = heat[hasHeat ? at : 0u];
        vec2 share = 1.0 - abs(st - corner - vec2(o2));
        float w = hasHeat ? share.x * share.y : 0.0;
        total += w;
        kelvin += w * float(word >> 16u) * (1.0 / 16.0);
        fuel += w * float(word & 0xFFFFu) * (1.0 / float(kFuelFull));
        ++i;
    } while (i < taps);
    return Warmth(kelvin / total, 1.0 - fuel / total);
}

// x: water, [0, 1] of what the surface holds; y: browning by other objects' heat, [0, 1]. Poured
// water has a one-texel edge, filtered over five texels. Five taps detect whether there is an edge.
vec2 wetnessAt(vec2 uv) {
    vec2 middle = floor(uv), off = uv - middle - 0.5;
    ivec2 limit = lastTexel();
    vec2 sum = vec2(0.0);
    float total = 1e-6, least = 1.0, most = 0.0;
    bool hasHeat = draw.maxFilm > 0.0;
    float perGram = 1.5 / max(draw.maxFilm, 1.0);
    int taps = (draw.flags & kDrawWet) != 0u ? 5 : 0;
    for (int i = 0; i < taps; ++i) {
        ivec2 o2 = i < 4 ? ivec2((i & 1) * 4 - 2, (i >> 1) * 4 - 2) : ivec2(0);
        if (i > 4) o2 = ivec2((i - 5) % 5 - 2, (i - 5) / 5 - 2);
        ivec2 texel = clamp(ivec2(middle) + o2, ivec2(0), limit);
        uint index = texelAt(texel);
        uint t = predict[draw.stateBase + index];
        uint word = hasHeat ? heat[2u * (draw.heatBase + index) + 1u] : 0u;
        float film = min(float(word & 0x3FFu) * perGram, 1.0);
        float brown = t < kLiveEnd ? 0.0 : float((word >> 20u) & 0xFFu) * (1.0 / 160.0);
        if (!hasHeat) film = t == kWet || t == kOutWet ? 1.0 : 0.0;
        vec2 x = abs(off - vec2(o2)) * 0.6;
        vec2 tail = max(1.5 - x, 0.0);
        vec2 k = mix(0.5 * tail * tail, 0.75 - x * x, lessThan(x, vec2(0.5)));
        float w = t == kInert ? 0.0 : k.x * k.y;
        least = t == kInert ? least : min(least, film);
        most = t == kInert ? most : max(most, film);
        total += w;
        sum += w * vec2(film, min(brown, 1.0));
        if (i == 4 && most > least + 0.02) {
            taps = 30;
            total = 1e-6;
            sum = vec2(0.0);
        }
    }
    return sum / total;
}

// Over a wet border the age falls to that of the wet side: first fast to that of young char, so
// that most of the texel is brown, then evenly.
float dampen(float age, float damp, float young, float wetAge) {
    if (damp <= 0.0) return age;
    float top = clamp(age, wetAge, young);
    return damp < 0.25 ? mix(max(age, wetAge), top, damp * 4.0)
                       : mix(top, wetAge, (damp - 0.25) / 0.75);
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
    float gleam = 0.012 * s.sheen * (1.0 - nh * nh) * (1.0 - nh * nh);  // graphite veil
    return e * (s.albedo * (0.31831 * nl) + vec3((d * g * fresnel + gleam) * nl));
}

// open: share of ambient light and sun (no shadows); soot: [0, 1]; sootable: visible share of it.
vec3 shade(Skin s, vec3 position, vec3 n, vec3 v, float open, float soot, float sootable) {
    if (dot(n, v) < 0.02) n = normalize(n + v * (0.04 - dot(n, v)));
    // Small triangles: lit per vertex, with the mean light direction.
    vec3 fire = vec3(vPositionFire.w, vRestFire.w, vNormalFire.w);
    fire *= max(0.0, dot(n, vec3(vDetail.zw, vTint.w)) + 0.25) * 0.64;
    bool small = (draw.flags & kDrawVertexLight) != 0u;
    uint count = small ? 0u : min(view.lightCount, kSurfaceLights);
    for (uint i = 0u; i < count; ++i) {
        vec4 at = lights[i].positionRadius;
        vec4 color = lights[i].colorIntensity;
        if (color.w <= 0.0) break;  // strongest first
        vec3 d = at.xyz - view.eye.xyz - position;
        float r2 = dot(d, d);
        float wrapped = max(0.0, dot(n, d) * inversesqrt(max(r2, 1e-8)) + 0.25) * 0.64;
        if (!kBurns && !kCold) soot += plumeSoot(d, lights[i].power, view.up.xyz);
        fire += color.rgb * (color.w * wrapped / (r2 + max(at.w * at.w * 0.25, 0.004)));
    }
    s.albedo = sooted(s.albedo, sootable * saturate(soot));
    s.rough = mix(s.rough, 0.9, sootable * saturate(soot));
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

    fire *= kCandelaPerWatt * view.sunColor.w / kWhiteLuminance;
    // Soft limit: a flame at the surface must not bleach it.
    fire /= 1.0 + 0.4 * view.sunDirection.w * (fire.r + fire.g);
    c += fire * s.albedo * (open * s.occlusion * 0.31831);
    return c;
}

float zigzag(float x) { return abs(fract(x) - 0.5) * 4.0 - 1.0; }

void main() {
    if (kCold && vSootOffset.x > 0.0) discard;
    MaterialAppearance appearance = appearances[min(draw.appearance, kAppearanceRows - 1u)];
    if ((draw.flags & kObjectNoHoles) != 0u) appearance.holeTime = 0.0;
    // The rim uses the host's thickness, within the range of the appearance.
    if (draw.thickness > 0.0)
        appearance.thickness = clamp(draw.thickness, 0.4 * appearance.thickness,
                                     2.0 * appearance.thickness);
    vec3 inPosition = vPositionFire.xyz, inRest = vRestFire.xyz, inTintColor = vTint.rgb;
    vec2 inAtlas = vTexture.xy;

    // Tangent plane: derivatives of atlas and detail coordinates along the surface.
    vec3 normal = normalize(vNormalFire.xyz);
    vec3 px = dFdx(FW_POSITION), py = dFdy(FW_POSITION);
    vec3 toEye = view.forward.w > 0.5 ? normalize(-inPosition) : -view.forward.xyz;
    // At a silhouette a pixel's middle may lie beyond the surface, where differences are unusable.
    float depth = view.forward.w > 0.5 ? dot(inPosition, view.forward.xyz) : 1.0;
    float span = 100.0 * view.eye.w * depth;
    bool known = dot(px, px) + dot(py, py) < span * span;
    px = known ? px : normalize(cross(toEye, normal.zxy + 1e-3));
    py = known ? py : cross(toEye, px);
    vec3 face = cross(px, py);
    face *= dot(face, toEye) < 0.0 ? -1.0 : 1.0;
    // Walls of holes and open borders have no vertex normals.
    bool cut = kBurns && (draw.flags & kDrawCut) != 0u;
    bool wall = (draw.flags & kDrawCut) != 0u && vSootOffset.y < -0.5;
    bool rim = cut && wall && vSootOffset.y > -2.5;
    if (wall) normal = normalize(face);
    bool back = dot(face, normal) < 0.0;
    vec3 r1 = cross(py, normal), r2 = cross(normal, px);
    float det = dot(px, r1);
    float inverse = known && abs(det) > 1e-16 ? 1.0 / det : 0.0;
    r1 *= inverse;
    r2 *= inverse;
    vec2 ux = dFdx(FW_ATLAS), uy = dFdy(FW_ATLAS);
    float leap = dot(ux, ux) + dot(uy, uy);  // texels^2 to the next pixels
    ux = known ? ux : vec2(0.0);
    uy = known ? uy : vec2(0.0);
    vec3 gradU = r1 * ux.x + r2 * uy.x, gradV = r1 * ux.y + r2 * uy.y;  // texels/m
    float facing = max(abs(dot(normal, toEye)), 0.2);
    float pixel = view.eye.w * depth * inversesqrt(facing);

    // Dominant axis of the normal, dithered by zigzags, which hide the seams in wood.
    float inverseScale = inversesqrt(dot(draw.row0.xyz, draw.row0.xyz));
    vec3 ex = vec3(draw.row0.x, draw.row1.x, draw.row2.x) * inverseScale;
    vec3 ey = vec3(draw.row0.y, draw.row1.y, draw.row2.y) * inverseScale;
    vec3 ez = vec3(draw.row0.z, draw.row1.z, draw.row2.z) * inverseScale;
    float da = zigzag(5.0 * (inRest.x + inRest.z) + 0.8 * zigzag(7.3 * inRest.y + 0.2));
    float db = zigzag(4.3 * (inRest.y + 0.7 * inRest.z) + 0.8 * zigzag(9.2 * inRest.x));
    vec3 w = abs(vec3(dot(normal, ex), dot(normal, ey), dot(normal, ez))) +
             0.1 * vec3(da, db, -0.5 * (da + db));
    bool facesX = w.x > w.y && w.x > w.z, facesY = !facesX && w.y > w.z;
    vec2 flatPlace = vec2(facesX ? inRest.z : inRest.x, facesY ? inRest.z : inRest.y);

    bool detailed = (draw.flags & kObjectDetail) != 0u;
    vec2 d = flatPlace;
    vec3 axisX = facesX ? ez : ex, axisY = facesY ? ez : ey;
    if (detailed) {
        d = vDetail.xy;
        vec2 dx = dFdx(FW_DETAIL), dy = dFdy(FW_DETAIL);
        dx = known ? dx : vec2(0.0);
        dy = known ? dy : vec2(0.0);
        axisX = r1 * dx.x + r2 * dy.x;
        axisY = r1 * dx.y + r2 * dy.y;
        axisX /= max(length(axisX), 1e-4);
        axisY /= max(length(axisY), 1e-4);
    }

    vec4 coarse, fine;
    vec2 warp = frontWarp(d, pixel, appearance, coarse, fine);
    vec3 along = axisX * warp.x + axisY * warp.y;
    vec2 shift = vec2(dot(gradU, along), dot(gradV, along));  // texels
    float rate = max(appearance.spreadRate, 1e-5);
    // A long shift could leave the chart: beyond half a texel it is linear.
    vec2 near = clamp(shift, -0.5, 0.5);
    // Without a tangent plane slopes are ignored.
    float perMetre = inverse != 0.0 ? max(length(gradU), 1.0) : 1e9;
    Arrival arrival = Arrival(-1e6, vec2(0.0), 0.0, 0.0, 0.0, 1e3, vSootOffset.x, false);
    Warmth warmth = Warmth(300.0, 0.0);
    vec2 wetness = vec2(0.0);
    if (kBurns) {
        arrival = arrivalAt(inAtlas + near, 2.5 / (rate * draw.timeScale * perMetre),
                      (1.3 * appearance.scorchWidth / rate + 1.5 * appearance.jitter) /
                          draw.timeScale);
        arrival.age -= dot(arrival.gradient, shift - near);
        warmth = warmthAt(inAtlas + near);
        vec2 creeps = vec2(coarse.r + 0.4 * fine.b, coarse.g + 0.4 * fine.r) * 3.0 - 2.0;
        wetness = wetnessAt(inAtlas + clamp(creeps, -1.0, 1.0));
    }

    // A sliver seen edge-on covers samples many texels beyond its chart: no burn state is known
    // there, so adjacent triangles show.
    bool lost = false;
#ifdef FW_MULTISAMPLED
    lost = arrival.none && leap > 16.0;
#endif

    // Pattern of the holes; in wood it follows the rings. Both walls of a solid use the same
    // pattern: mirrored ones would align into symmetric see-through holes. Wood's planks differ
    // anyway.
    bool sheet = (draw.flags & kObjectTwoSided) != 0u;
    vec2 grownAt = sheet ? d : flatPlace;
    grownAt = kHasWood ? inTree(d, plankOf(d, detailed)) * vec2(1.0, 0.3)
                       : vec2(grownAt.x, grownAt.y / appearance.drip);
    vec4 grown = noiseAt(grownAt, kHasWood ? 2.6 : appearance.holeTiles,
                         max(pixel, appearance.blur));
    vec3 color = draw.colorRough.rgb;
    bool cutOut = false;  // transparent image texel; decided below, where no derivatives are needed
    Base fresh;
    if (kImage) {
        vec4 texel = texture(baseImage, vTexture.zw);
        color = texel.rgb;
        cutOut = texel.a < 0.5;
        fresh.factor = vec3(1.0);
        fresh.rough = draw.colorRough.w;
        fresh.delay = (fine.b - 0.5) * 1.2;
        fresh.cavity = 0.45 + 0.55 * saturate(dot(color, vec3(0.9)) + 0.3);
        fresh.height = 0.0;
    } else {
        fresh = freshBase(appearance.base, d, pixel, detailed, color, coarse, fine, grown);
        fresh.rough = clamp(fresh.rough + draw.colorRough.w - 0.7, 0.1, 1.0);
    }

    // Derivatives before any branch, and only of values without buffer reads: lanes outside the
    // triangle read nothing.
    float height = -fresh.height;
    vec2 relief = vec2(dFdx(height), dFdy(height));
    relief = clamp(relief, -pixel, pixel);
    float bubble = bubbleShape(d, pixel, coarse, appearance.base != kBasePaint);
    vec3 swell = r1 * dFdx(bubble) + r2 * dFdy(bubble);
    float delay = clamp(fresh.delay, -1.5, 1.5);
    float later = holeDelay(grown, fine, delay, appearance) + appearance.jitter * delay;
    vec3 laterSlope = r1 * dFdx(later) + r2 * dFdy(later);
    if (cutOut || lost) discard;

    Site site;
    site.d = d;
    site.pixel = pixel;
    vec3 slope = (gradU * arrival.gradient.x + gradV * arrival.gradient.y) * draw.timeScale;
    vec2 flat_ = vec2(dot(slope, axisX), dot(slope, axisY));
    float steep = length(flat_);
    site.slow = clamp(length(slope), 0.25 / rate, 1.6 / rate);  // s/m
    float ahead = 1.3 * max(appearance.scorchWidth, appearance.wiltColor.w) * site.slow +
        1.5 * appearance.jitter;
    // Water halves the heat's path.
    float behind = 2.0 * (arrival.ahead - 0.7) * inversesqrt(max(dot(gradU, gradU), 1.0));  // m
    float wetAge = clamp(-behind * site.slow, -1.2 * ahead, 0.0);
    site.age = dampen(arrival.age * draw.timeScale, arrival.damp, 1.5 * appearance.charTime,
                      wetAge);
    site.ahead = steep > 1e-6 ? flat_ / steep : vec2(0.0, 1.0);
    site.out_ = saturate(arrival.out_ * 1.5 + arrival.damp * 6.0);
    // Glow by the heat buffer: an extinguished texel glows until it has cooled.
    bool thick = (draw.flags & kDrawThick) != 0u;
    float hot = smoothstep(430.0, 620.0, warmth.kelvin);
    if ((draw.flags & kDrawHeat) != 0u) site.out_ = (thick ? 1.0 : site.out_) * (1.0 - hot);
    site.deep = thick ? smoothstep(0.02, 0.5, warmth.eaten) : 0.45;
    site.gain = thick ? clamp(0.5 * (warmth.kelvin - 715.0), -50.0, 120.0) : 0.0;
    site.brown = wetness.y;
    // Water creeps along relief, and dries beside the fire.
    site.water = smoothstep(0.05, 0.85, wetness.x);
    if (arrival.damp > 0.0)
        site.water *= 1.0 - 0.85 * smoothstep(-0.9 * ahead, -0.15 * ahead, site.age) * arrival.damp;
    bool inside = back && (draw.flags & kObjectTwoSided) == 0u;
    site.soot = inside ? 0.8 * smoothstep(-10.0, -0.3, site.age / max(appearance.charTime, 1e-3)) :
        0.0;
    site.keep = inside ? 2.5 : 1.0;
    site.base = color * fresh.factor * inTintColor;
    site.baseRough = fresh.rough;
    site.steep = 1.0;
    site.delay = delay;
    site.cavity = fresh.cavity;
    site.time = view.ambientSky.w;
    site.coarse = coarse;
    site.fine = fine;
    site.grown = grown;
    site.bubbleSlope = vec2(dot(swell, axisX), dot(swell, axisY));

    // The opposite wall's burn makes holes here, too, even before this side catches.
    site.offset = cut ? 0.0 : vSootOffset.y;
    if (!cut && (draw.flags & kDrawPlaced) != 0u) {
        site.age = max(site.age, -1e3);
        site.offset = burnThroughOffset(site.age, vSootOffset.y, appearance.holeTime);
    }
    site.left = cut ? max(vSootOffset.y, 0.0) * draw.timeScale : -1.0;
    site.nearness = draw.nearness;
    // Walls on borders have no rim. Where corners are too far apart to know a hole between them,
    // texels do.
    if (wall && !rim) site.left = (draw.flags & kDrawPerPixelHoles) != 0u ? -1.0 : 1000.0;
    if (rim) {
        // Burnt-through char; the rim's glow fades inwards.
        site.age = max(site.age, appearance.holeTime);
        site.left = saturate(-1.0 - vSootOffset.y) * appearance.thickness * site.slow;
    }
    bool soon = site.offset >= 1e-3 || (cut && site.left >= 0.0 && site.left < appearance.holeTime);
    bool cold =
        !kBurns || appearance.spreadRate <= 0.0 ||
            (site.age < -ahead && !soon && site.brown < 0.01);
    Skin skin;
#if FW_MULTISAMPLED == 2
    int covered = -1;
#endif
    vec3 position = inPosition;
    // Refined faces recede while they burn, by a wall's thickness in its burn time (up to
    // kRefineRecede): they tilt towards the part that caught first.
    float burnt = appearance.holeTime > 0.0 ? site.age / appearance.holeTime : 0.0;
    bool recedes =
        kBurns && (draw.flags & (kDrawPlaced | kDrawCut)) != 0u && burnt > 0.0 && !wall && !inside;
    float fall = recedes ? draw.thickness / appearance.holeTime : 0.0;
    fall *= 1.0 - smoothstep(0.9 * kRefineRecede, 1.1 * kRefineRecede, burnt);
    vec3 leaned = normal - slope * min(fall, 1.5 * inversesqrt(max(dot(slope, slope), 1e-8)));
    vec3 facingNormal = back ? -leaned : leaned;
    float deep = -1.0;
    skin = freshSkin(site, appearance);
    if (inside) skin.occlusion = 0.5;
    if (kBurns && !cold) {
        vec2 uneven = vec2(dot(laterSlope, axisX), dot(laterSlope, axisY)) / site.slow;
        if (appearance.rimWidth < kThinRim && site.left < 0.0)
            site.steep = clamp(length(site.ahead + uneven), 1.0, 4.0);
        float edge = holeEdge(max(site.age, -ahead) - appearance.jitter * delay, site, appearance);
        if (rim) {
            deep = 0.0;
            vec2 bump = fine.rb - 0.5;
            facingNormal = normalize(normal + 0.8 * (axisX * bump.x + axisY * bump.y));
        }
        vec3 ray = vec3(dot(-toEye, axisX), dot(-toEye, axisY), -abs(dot(toEye, normal)));
        vec2 rise = uneven;
        rise = site.ahead + rise * min(1.0, 1.2 * inversesqrt(max(dot(rise, rise), 1e-8)));
        // A wall thinner than a pixel would flicker.
        bool walled = appearance.thickness > pixel;
        if (edge < 0.0) deep = walled ? rimHit(edge, rise, appearance.thickness, ray) : -1.0;
#if FW_MULTISAMPLED == 2
        // Edge distance per pixel, m, limited.
        vec3 farther = axisX * rise.x + axisY * rise.y;
        vec2 perPixel = clamp(vec2(dot(farther, px), dot(farther, py)), -4.0 * pixel, 4.0 * pixel);
        int standing = 0;
        for (uint i = 0u; i < kSamples; ++i) {
            // Positions for 2, 4, 8 and 16 samples start at count - 2.
            vec2 off = vec2(kSamplePlaces[kSamples - 2u + i]) * (1.0 / 16.0);
            float there = edge + dot(perPixel, off);
            bool stands =
                there >= 0.0 || (walled && rimHit(there, rise, appearance.thickness, ray) >= 0.0);
            standing |= stands ? 1 << i : 0;
        }
        if (site.left < 0.0) covered = standing;  // a cut mesh ends at its rim
        if (covered == 0) discard;
        // A pixel covered only by samples lies at the rim.
        if (edge < 0.0 && deep < 0.0) {
            site.age += edge * site.slow;
            edge = 0.0;
        }
#else
        if (edge < 0.0 && deep < 0.0) discard;
#endif
        if (edge < 0.0) {
            vec2 move = ray.xy * deep;
            site.d += move;
            site.age -= site.slow * dot(rise, move);
            site.soot = 0.0;
            site.keep = 1.0;
            vec2 bump = fine.rb - 0.5;
            // The wall faces the hole, away from unburnt material.
            vec3 wall = -(axisX * site.ahead.x + axisY * site.ahead.y);
            facingNormal = normalize(wall +
                                     facingNormal * (0.4 - 1.2 * deep / appearance.thickness) +
                                     0.8 * (axisX * bump.x + axisY * bump.y));
            position -= toEye * deep;
        }
        skin = burningSkin(site, appearance);
        if (deep >= 0.0) {
            skin.slope = vec2(0.0);
            skin.occlusion *= 0.8;
        } else if (inside) {
            skin.occlusion *= 0.7;
        }
    }

    float charred = smoothstep(0.0, max(appearance.charTime, 1e-3), site.age);
    relief *= deep >= 0.0 ? 0.0 : 1.0 - 0.6 * charred;
    vec3 tilt = axisX * clamp(skin.slope.x, -1.4, 1.4) + axisY * clamp(skin.slope.y, -1.4, 1.4);
    tilt += r1 * relief.x + r2 * relief.y;
    tilt -= normal * dot(normal, tilt);
    tilt *= min(1.0, 1.6 * inversesqrt(max(dot(tilt, tilt), 1e-8)));
    vec3 n = normalize(facingNormal + (deep >= 0.0 ? vec3(0.0) : (back ? -tilt : tilt)));

    // Cavities are black with smoke.
    float soot = inside && deep < 0.0 && (kBurns || kCold) ? 0.85 : arrival.soot;
    vec3 linear = shade(skin, position, n, toEye, inside ? 0.5 : 1.0, soot,
                        (1.0 - charred) * (0.6 + 0.5 * coarse.r));
    outColor = vec4(encodeOutput(min(linear, vec3(60000.0)) * view.sunDirection.w, kEncoding), 1.0);
#if FW_MULTISAMPLED == 2
    gl_SampleMask[0] = covered;
#endif
}
