// A particle field: density by cubic splines between cells, fine structure by tiled noise that the
// motion advects in two phases. Emission uses the volumetric fires' profile; absorption takes sun
// and sky; refraction has a specular surface. Output is premultiplied: colour, and coverage.
#include "field/field_draw.glsl"
#include "shared/volume.h"

layout(constant_id = 0) const uint kEncoding = 0u;
layout(constant_id = 2) const uint kVariant = 0u;  // 0: only emits, 1: absorbs, 2: also refracts
layout(set = 1, binding = 0) uniform sampler2DArray profiles;
layout(set = 2, binding = 0) uniform sampler2DArray appearanceTextures;

layout(location = 0) out vec4 outColor;

#include "lib/colour.glsl"
#include "lib/appearance_noise.glsl"
#ifdef FW_SOFT
#include "lib/soft_depth.glsl"
#endif

const float kPeriod = 0.8;      // s, of the noise's two phases
const float kTile = 44.0;       // cells per tile of noise
const float kFieldWhite = 1.25;  // host units of thin soot at 1600 K
const float kFieldTip = 1370.0;  // K
const vec2 kStretch =
    kVariant == 0u ? vec2(1.15, 0.62) : (kVariant == 1u ? vec2(0.8) : vec2(2.4, 0.42));

struct Shown {
    float density;
    vec2 motion;     // cells per step
    float sun;
    vec2 slope;      // of density, per cell
};

// Cubic B-splines: 16 cells, weights and derivatives.
Shown shownAt(vec2 place) {
    int w = int(vField.y), h = int(vField.z);
    vec2 at = place * vec2(float(w), float(h)) - 0.5;
    vec2 low = floor(at), t = at - low, s = 1.0 - t;
    vec2 wt[4] = vec2[4](s * s * s / 6.0, (t * t * (3.0 * t - 6.0) + 4.0) / 6.0,
                         (s * s * (3.0 * s - 6.0) + 4.0) / 6.0, t * t * t / 6.0);
    vec2 ds[4] = vec2[4](-0.5 * s * s, t * (1.5 * t - 2.0), -s * (1.5 * s - 2.0), 0.5 * t * t);
    bool ring = vField.w != 0u;
    uint columns[4];
    float inside[4];
    FW_UNROLL for (int i = 0; i < 4; ++i) {
        int x = int(low.x) + i - 1;
        inside[i] = ring || (x >= 0 && x < w) ? 1.0 : 0.0;
        x = ring ? (x < 0 ? x + w : (x >= w ? x - w : x)) : clamp(x, 0, w - 1);
        columns[i] = vField.x + uint(clamp(x, 0, w - 1));
    }
    vec4 sum = vec4(0.0);
    vec2 slope = vec2(0.0);
    FW_UNROLL for (int j = 0; j < 4; ++j) {
        int y = int(low.y) + j - 1;
        float rows = y < h ? 1.0 : 0.0;
        uint row = uint(clamp(y, 0, h - 1)) * vField.y;
        vec4 across = vec4(0.0);
        float steep = 0.0;
        FW_UNROLL for (int i = 0; i < 4; ++i) {
            vec4 c = fieldShown(shown[columns[i] + row]);
            c.x *= inside[i] * rows;
            across += wt[i].x * c;
            steep += ds[i].x * c.x;
        }
        sum += wt[j].y * across;
        slope += vec2(wt[j].y * steep, ds[j].y * across.x);
    }
    return Shown(sum.x, sum.yz, sum.w, slope);
}

vec4 carried(vec2 cell, vec2 motion, float phase, float number, float lod) {
    vec2 moved = clamp(motion * ((phase - 0.5) * kPeriod), vec2(-0.25 * kTile), vec2(0.25 * kTile));
    uvec3 of = uvec3(uint(number), uint(vSize.w), 3u);
    vec2 jump = vec2(hash(of), hash(of + 4u));
    return textureLod(appearanceTextures,
                      vec3((cell - moved) * kStretch * (1.0 / kTile) + jump, kLayerNoise), lod);
}

// The field at a fragment, and the light that it has there.
struct Surface {
    Shown f;
    vec4 noise;
    float rough, ridge;  // of the noise
    float edge;          // [0, 1], fades silhouettes and borders
    float facing;        // cosine between `normal` and `toEye`
    vec3 toEye, normal;
};
struct Light {
    vec3 emitted, lit;
    float alpha;
};

bool isRound() { return vField.w != 0u; }

void addFire(Surface s, inout Light out_) {
    float detail = vBody.x, body = vBody.y, strength = vBody.w;
    // Tongues: noise erodes more with height, except a thin tip that still glows; cooler soot
    // would only hide, and a flame would end in a stump.
    float y = vPlace.y * float(vField.z) / (2.6 * vSize.y), high = min(y, 1.0);
    float d = s.f.density * (1.0 + detail * (1.5 * s.rough + 0.6 * s.ridge)) -
              detail * (0.05 + 0.36 * (high - 0.48 * high * high * high));
    d = max(d, 0.0);
    // Dense parts map to the flame's axis, thin ones to its rim.
    float rho = clamp(1.10 - 1.25 * d, 0.02, 1.2);
    vec2 uv = vec2(rho * (1.0 / kProfileReach), y * 0.8 + 0.12);
    vec2 profile = textureLod(profiles, vec3(clamp(uv, 0.01, 0.99), 0.0), 0.0).xy;
    float kelvin =
        1000.0 * profile.x + 260.0 * (min(d, 1.0) - 0.72) - 170.0 * y + 90.0 * detail * s.rough;
    kelvin = max(kelvin, kFieldTip);
    float soot = smoothstep(0.03, 0.62, d) * (0.25 + profile.y);
    float thick = 1.0 - exp(-1.5 * soot * (0.25 + d));
    float share1 = clamp(1.0 - body, 0.0, 1.0) * strength * s.edge;
    out_.emitted += sootRadiance(kelvin) * kFireWhite * vTint.rgb *
                    (kFieldWhite * view.sunColor.w * thick * share1);
    out_.alpha += 0.55 * thick * min(share1, 1.0);
}

void addSmoke(Surface s, inout Light out_) {
    float detail = vBody.x, body = vBody.y, strength = vBody.w;
    float d = max(s.f.density * (1.0 + 1.3 * detail * s.rough) - 0.05 * detail, 0.0);
    float tau = 3.4 * d * d * (isRound() ? max(s.facing, 0.0) * 1.6 : 1.0);
    float share1 = clamp(1.0 - abs(body - 1.0), 0.0, 1.0);
    float cover = (1.0 - exp(-tau * strength)) * s.edge * share1;
    if (isRound()) cover *= step(0.0, s.facing);
    // Billows tilt towards thinner density.
    vec3 up = normalize(cross(s.normal, vAlong));
    vec2 lean =
        -s.f.slope * 2.2 - detail * vec2(s.noise.r - s.noise.b, s.noise.g - s.noise.r) * 0.9;
    vec3 n = normalize(s.normal + vAlong * lean.x + up * lean.y);
    float sky = 0.5 + 0.5 * dot(n, view.up.xyz);
    float through = 0.25 + 0.75 * smoothstep(-0.6, 0.9, dot(n, view.sunDirection.xyz));
    vec3 light = mix(view.ambientGround.rgb, view.ambientSky.rgb, sky) * (0.55 + 0.45 * s.f.sun) +
                 view.sunColor.rgb * (0.42 * s.f.sun * through);
    vec3 grey = vTint.rgb * light * 0.42;
    out_.lit += grey * cover;
    out_.alpha += cover;
}

void addWater(Surface s, inout Light out_) {
    float detail = vBody.x, body = vBody.y, strength = vBody.w;
    float d = max(s.f.density * (1.0 + 1.6 * detail * s.rough), 0.0);
    vec3 up = normalize(cross(s.normal, vAlong));
    // A sheet ends within a cell or two at pools and sources: full slopes there would make rims
    // rows of white highlights.
    vec2 wave = -s.f.slope * (isRound() ? 2.4 : 0.25) - detail * vec2(s.rough, 0.6 * s.ridge) * 1.8;
    vec3 n = normalize(s.normal + vAlong * wave.x + up * wave.y);
    float film = smoothstep(0.10, 0.42, d) * s.edge;
    if (isRound())
        film = smoothstep(0.10, 0.42, d) * step(0.0, s.facing) * smoothstep(0.0, 0.25, s.facing);
    float facingN = clamp(dot(n, s.toEye), 0.0, 1.0);
    float fresnel = 0.03 + 0.97 * pow(1.0 - facingN, 5.0);
    vec3 back = reflect(-s.toEye, n);
    vec3 sky = mix(view.ambientGround.rgb, view.ambientSky.rgb,
                   smoothstep(-0.4, 0.6, dot(back, view.up.xyz)));
    vec3 half_ = normalize(view.sunDirection.xyz + s.toEye);
    float gleam = pow(max(dot(n, half_), 0.0), 60.0);
    // Foam where it breaks.
    float foam = smoothstep(
        0.55, 1.25, 0.55 * min(d, 1.0) + 1.6 * detail * s.ridge + 0.25 * length(s.f.motion));
    vec3 light = view.ambientSky.rgb * 0.8 + view.sunColor.rgb * 0.35;
    vec3 deep = vTint.rgb * vec3(0.10, 0.26, 0.31) * light;
    float share1 = clamp(body - 1.0, 0.0, 1.0) * strength * film;
    float cover = min(share1 * mix(0.42 + 0.2 * d, 0.85, foam), 0.97);
    out_.lit += cover * mix(deep, 0.75 * light, foam * 0.8) +
                share1 * (sky * fresnel + view.sunColor.rgb * (1.6 * gleam));
    out_.alpha += cover;
}

void main() {
    Shown f = shownAt(vPlace);
    vec2 cell = vPlace * vec2(float(vField.y), float(vField.z));
    bool round_ = vField.w != 0u;
    vec3 toEye = normalize(vToEye), normal = normalize(vNormal);
    float facing = dot(normal, toEye);

    // Two phases half a period apart: each is only visible while its displacement is short.
    float turns = vBody.z / kPeriod + hash(uvec3(uint(vSize.w), 1u, 1u));
    float phase = turns - floor(turns), other = fract(turns + 0.5);
    float share = abs(2.0 * phase - 1.0);
    vec2 speed = f.motion * vTint.w;  // cells per second
    float pixel = view.eye.w * (view.forward.w > 0.5 ? dot(vToEye, -view.forward.xyz) : 1.0);
    float lod = min(noiseLod(pixel, 1.0 / (kTile * vSize.x)), 5.0);
    vec4 noise = mix(carried(cell, speed, phase, floor(turns), lod),
                     carried(cell, speed, other, floor(turns + 0.5), lod), share);
    float rough = (noise.r - 0.5) * 1.5 + (noise.b - 0.5) * 0.9;
    float ridge = noise.g - 0.45;

    // Fades silhouettes and borders.
    float edge = 1.0;
    if (round_) {
        edge = smoothstep(0.0, 0.75, abs(facing));
    } else {
        vec2 b = min(vPlace.x, 1.0 - vPlace.x) * vec2(1.0);
        edge = smoothstep(0.0, 0.08, b.x) * smoothstep(0.0, 0.10, 1.0 - vPlace.y);
    }
    Surface s = Surface(f, noise, rough, ridge, edge, facing, toEye, normal);
    Light light = Light(vec3(0.0), vec3(0.0), 0.0);
    if (kVariant <= 1u) addFire(s, light);
    if (kVariant >= 1u) addSmoke(s, light);
    if (kVariant == 2u) addWater(s, light);
    vec3 color = light.emitted, lit = light.lit;
    float alpha = min(light.alpha, 1.0);
#ifdef FW_SOFT
    float soft = smoothstep(0.0, 1.0, gapToScene() / (0.2 * vSize.z));
    color *= soft;
    lit *= soft;
    alpha *= soft;
#endif
    if (alpha < 0.002) discard;
    color *= view.sunDirection.w;
    lit *= view.sunDirection.w;
    if (kEncoding != 0u) {
        // The target blends encoded values: see flames.frag.
        color = encodeOutput(color, kEncoding);
        lit = encodeOutput(lit / alpha, kEncoding) * alpha;
    }
    outColor = vec4(min(color + lit, vec3(60000.0)), alpha);
}
