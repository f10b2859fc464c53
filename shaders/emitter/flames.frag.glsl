// A tongue of flame, puff of smoke, fireball or spark. Tongue: a profile sampled at a displaced
// height (zero-mean noise that scrolls upwards and narrows with height); soot glows in thin sheets
// where the noise is zero. Fireball: noise advected by two vortices, eroded with age. Output is
// premultiplied: colour, and coverage.
#include "emitter/flames.glsl"

layout(constant_id = 0) const uint kEncoding = 0u;
layout(set = 2, binding = 0) uniform sampler2DArray appearanceTextures;

#ifdef FW_FLIPBOOKS
// If flipbooks show all but sparks, the noise is compiled out: a software device would sample it
// for every quad.
layout(constant_id = 2) const uint kOnlyFlipbooks = 0u;
layout(set = 1, binding = 0) uniform sampler2D flipbookTexture;

// Reads up to half a texel beyond a border, into the empty texel between frames.
vec4 flipbookTexel(vec2 at, vec2 uv) {
    vec2 p = clamp(uv * vSizes.xy, vec2(-0.5), vSizes.xy + 0.5);
    return textureLod(flipbookTexture, (at + p) / vec2(textureSize(flipbookTexture, 0)), 0.0);
}
vec2 flipbookMotionAt(vec2 at, vec2 uv) {
    vec2 p = clamp(uv * vSizes.zw, vec2(0.5), vSizes.zw - 0.5);
    vec2 size = vec2(textureSize(flipbookTexture, 0));
    return decodeFlipbookMotion(textureLod(flipbookTexture, (at + p) / size, 0.0).rg, vBetween.y);
}
vec4 sampleFlipbook(vec2 uv) {
    vec2 before = flipbookUvBefore(uv, flipbookMotionAt(vMotions.xy, uv), vBetween.x);
    vec2 after = flipbookUvAfter(uv, flipbookMotionAt(vMotions.zw, uv), vBetween.x);
    return mixFlipbookTexels(flipbookTexel(vFrames.xy, before), flipbookTexel(vFrames.zw, after),
                             vBetween.x);
}
// K between the coldest and the hottest texel, around the quad's temperature.
const float kFlipbookSpan = 600.0;
const float kFlipbookHides = 1.05;  // coverage relative to brightness, matching volumes
#else
const uint kOnlyFlipbooks = 0u;
#endif

layout(location = 0) out vec4 outColor;

#include "lib/colour.glsl"
#include "lib/appearance_noise.glsl"

const float kFlameWhite = 2.4;  // host units of thin soot at 1600 K
const float kNoiseBall = 0.9;   // of that: a jet of noise is as bright as one of flipbooks
const float kSunStep = 0.18;    // of a puff's radius, towards the light
const float kSmokeRolls = 0.5;  // of a fireball's life: age of the roll in smoke
const vec2 kAcross = vec2(0.6, 0.8);  // rotation between octaves: cosine, sine

// A fireball's soot at a temperature: share that has not burnt away, and its coverage. Cooling soot
// burns or becomes smoke, which has its own quads. Without this its rest would be dark red outlines
// on sunlit ground.
float sootLeft(float kelvin) { return smoothstep(1120.0, 1400.0, kelvin); }
float sootHides(float kelvin) { return 0.85 * smoothstep(1180.0, 1500.0, kelvin); }

#ifdef FW_SOFT
#include "lib/soft_depth.glsl"
#endif

// Rotates p about c by twice atan(h).
vec2 rolled(vec2 p, vec2 c, float h) {
    vec2 d = p - c;
    float k = 2.0 / (1.0 + h * h);
    return c + d + k * h * (vec2(d.y, -d.x) - h * d);
}

struct Roll {
    vec3 left, right;  // position of a vortex, and how far it has rotated
};
vec2 rolledUp(vec2 p, Roll roll) {
    vec2 fromLeft = p - roll.left.xy, fromRight = p - roll.right.xy;
    p = rolled(p, roll.left.xy, roll.left.z * exp2(-6.0 * dot(fromLeft, fromLeft)));
    return rolled(p, roll.right.xy, roll.right.z * exp2(-6.0 * dot(fromRight, fromRight)));
}

// by: cosine, sine.
vec2 rotate(vec2 p, vec2 by) {
    return vec2(p.x * by.x - p.y * by.y, p.x * by.y + p.y * by.x);
}

void main() {
    uint what = vKind & 3u, named = (vKind >> kQuadSeed & 0xFFFFu) << 1u | (vKind & 1u);
    bool tongue = what == kQuadTongue, smoke = what == kQuadSmoke, spark = what == kQuadSpark;
    float opacity = vState.x, phase = vState.y, aspect = vState.w;
    float x = vPlace.x, y = vPlace.y;
    vec2 seed = vec2(hash(uvec3(named, 1u, 5u)), hash(uvec3(named, 2u, 5u)));
    vec2 c = vec2(x, 2.0 * y - 1.0);
    float r = length(c);

    // Shared samples for all branches: software devices execute every branch. A fireball rolls up
    // about two rising vortices; smoke keeps that shape.
    float rolls = smoke ? kSmokeRolls : phase;
    Roll roll;
    roll.left = vec3(-0.30 - 0.20 * seed.y, 0.05 + 0.4 * rolls - 0.5 * seed.y, 0.25 + rolls);
    roll.right = vec3(0.45 - 0.20 * seed.y, -0.25 + 0.4 * rolls + 0.4 * seed.y,
                      -(0.25 + rolls) * (1.2 - seed.y));
    float mirror = seed.x < 0.5 ? -1.0 : 1.0;
    vec2 m = rolledUp(vec2(mirror * c.x, c.y), roll);
    float squeeze = 1.0 - 0.5 * y;
    // Each puff has its own orientation.
    vec2 rotation = normalize(seed - 0.5 + vec2(1e-4, 0.0));
    vec2 p = tongue  ? vec2(x / squeeze * 0.15, y * aspect * 0.15 * 0.45)
             : smoke ? rotate(m, rotation) * 0.15
                     : m * vec2(0.115, 0.085);
    p += seed;
    float slow = tongue ? 0.16 : smoke ? 0.2 : 0.03, fast = tongue || smoke ? 0.30 : 0.08;
    float lod = smoke ? 3.0 : tongue ? 1.0 : 2.0;
    vec4 n1 = vec4(0.5), n2 = vec4(0.5);
    // Smoke also samples one step towards its light; differences between pixels would show texel
    // grain.
    vec2 ahead = kSunStep * vSun, scroll = vec2(0.0, slow * phase);
    float aheadNoise = 0.5;
    if (kOnlyFlipbooks == 0u) {
        n1 = textureLod(appearanceTextures, vec3(p - scroll, kLayerNoise), lod);
        vec2 sunward =
            rotate(rolledUp(vec2(mirror, 1.0) * (c + ahead), roll), rotation) * 0.15 + seed;
        aheadNoise = textureLod(appearanceTextures, vec3(sunward - scroll, kLayerNoise), lod).r;
    }
    float bend = tongue ? 0.06 * y : smoke ? 0.15 : 0.10;
    vec2 scale = tongue ? vec2(1.7, 1.5) : smoke ? vec2(2.1) : vec2(2.3, 1.9);
    // Rotated octaves hide the noise lattice in smoke.
    vec2 q =
        (smoke ? rotate(p, kAcross) : p) * scale + (n1.rb - 0.5) * bend - vec2(0.0, fast * phase);
    if (kOnlyFlipbooks == 0u)
        n2 = textureLod(appearanceTextures, vec3(q, kLayerNoise),
                        lod - (tongue || smoke ? 0.0 : 1.0));

    vec3 color;
    float alpha;
    // Tongue: two octaves; the finer one is faster, so shapes change instead of only moving.
    float turbulence = (n1.r - 0.5) * 1.9 + (n2.r - 0.5) * 1.0 + (n2.g - 0.45) * 0.55;
    // Soot glows in folded sheets.
    float sheet =
        (n2.r - 0.5) + (tongue ? 0.6 : 0.7) * (n2.b - 0.5) + (tongue ? 0.0 : 0.25) * (n1.b - 0.5);
    float fold = exp2(sheet * sheet * (tongue ? -120.0 : -103.0));
    float kelvin, soot, hides, white = kFlameWhite * (tongue ? 1.0 : kNoiseBall);
    if (tongue) {
        float yy = max(y - 0.62 * sqrt(y) * turbulence, 0.45 * y);
        float xx = abs(x + 0.5 * y * (n1.b - 0.5)) * (1.0 + 0.15 * turbulence * y);
        float narrow = sqrt(max(1.0 - yy, 0.0));
        float halfWidth = 0.78 * narrow * sqrt(narrow) * (0.55 + 0.45 * smoothstep(0.0, 0.25, yy));
        float inside = halfWidth - xx;
        soot = smoothstep(0.0, 0.10 + 0.22 * y, inside);
        soot *= smoothstep(0.0, 0.34, y - 0.10 * x * x + 0.10 * (n2.r - 0.5)) *
                (1.0 - smoothstep(0.90, 1.0, y)) * (1.0 - smoothstep(0.60, 0.98, abs(x)));
        soot *= mix(1.0, 0.30 + 1.05 * fold, smoothstep(0.10, 0.5, y));
        float core = saturate(inside / 0.6);
        kelvin = vState.z - 330.0 * smoothstep(0.05, 1.0, yy) + 90.0 * (core - 0.4) -
                 110.0 * (n2.g - 0.45) - 60.0 * (1.0 - smoothstep(0.0, 0.2, y));
        hides = 0.75;
    } else {
        // A ball breaks into rags with age, hot inside and dark in its folds. Old edges are soft
        // and folds fade, or the remains would be lines.
        float late = smoothstep(0.45, 0.95, phase);
        float torn = 2.1 * (n1.r - 0.5) + 1.1 * (n2.r - 0.5) + 0.5 * (n2.g - 0.45);
        float deep = 0.92 - r * 1.05 + torn, least = mix(0.0, 0.72, phase);
        soot = smoothstep(0.0, 0.24 + 0.26 * late, deep - least) *
               (1.0 - smoothstep(0.62, 0.97, r)) *
               mix(1.0, 0.28 + 1.0 * fold, smoothstep(0.05, 0.40, phase) * (1.0 - 0.6 * late));
        kelvin = vState.z + 260.0 * (saturate((deep - least) * 0.9) - 0.35) + 90.0 * fold -
                 260.0 * (n2.g - 0.45) - 150.0 * (phase - 0.35);
        soot *= sootLeft(kelvin);
        hides = sootHides(kelvin);
    }
#ifdef FW_FLIPBOOKS
    bool byFlipbook = kOnlyFlipbooks != 0u || (vKind >> kQuadFlipbookShift & 0xFFu) != 0u;
    vec2 uv = vec2(0.5 * ((vKind >> kQuadSeed & 1u) != 0u ? -x : x) + 0.5, y);
    vec4 frame = sampleFlipbook(uv);
    if (byFlipbook) {
        soot = frame.y;
        kelvin = vState.z + kFlipbookSpan * (frame.x - 0.5);
        white = kFlameWhite;
        soot *= sootLeft(kelvin);
        hides = kFlipbookHides * sootHides(kelvin) * frame.z / max(frame.y, 1e-4);
    }
#endif
    vec3 glow = sootRadiance(spark ? vState.z : kelvin);
    color = glow * (tongue ? vec3(1.0) : kFireWhite) * (white * view.sunColor.w * soot * opacity);
    alpha = saturate(soot * hides) * opacity;
    // Smoke: separate billows; thin smoke is eroded more.
    float deep = 1.0 - 1.1 * r + 2.0 * (n1.r - 0.5) + 0.9 * (n2.r - 0.5) -
                 mix(0.4, 0.0, saturate(3.0 * opacity));
    if (smoke) {
        float body = smoothstep(0.0, 0.85, deep) * (1.0 - smoothstep(0.65, 1.0, r));
        alpha = body * opacity;
        // Thinner towards the light: it faces the light.
        float billow = 0.9 * (1.1 * (length(c + ahead) - r) + 6.0 * (n1.r - aheadNoise));
#ifdef FW_FLIPBOOKS
        if (byFlipbook) {
            alpha = frame.z * opacity;
            vec2 sun = vec2((vKind >> kQuadSeed & 1u) != 0u ? -vSun.x : vSun.x, vSun.y);
            billow = 1.6 * (frame.w - flipbookTexel(vFrames.xy, uv + 0.09 * sun).w);
        }
#endif
        // Crests catch sun and sky, hollows the fire below.
        float crest = saturate(0.45 + 0.9 * billow + 0.25 * c.y);
        vec3 lit = mix(view.ambientGround.rgb, view.ambientSky.rgb, 0.3 + 0.6 * crest) * 0.9 +
                   view.sunColor.rgb * (0.45 * crest * crest);
        vec3 fire = vec3(1.0, 0.38, 0.10) *
                    (0.35 * view.sunColor.w * vState.z * vState.z * (1.0 - crest));
        color = (lit * 0.17 + fire) * alpha;
    }
    if (spark) {
        float body = saturate(1.6 * (1.0 - r * r)) * opacity;
#ifdef FW_FLIPBOOKS
        if ((vKind >> kQuadFlipbookShift & 0xFFu) != 0u) body = frame.y * opacity;
#endif
        // Compressed: the true radiance falls a thousandfold during the flight.
        color =
            glow * (inversesqrt(max(glow.g * 2.5, 1e-4)) * kFlameWhite * view.sunColor.w * body);
        alpha = 0.0;
    }
#ifdef FW_SOFT
    // A tongue is as deep as wide, a puff twice so. Half of a tongue extends in front of its quad,
    // so thin objects do not cut it.
    float gap = gapToScene();
    float soft = smoke ? smoothstep(0.0, 0.9 * vWidth, gap)
                       : smoothstep(-0.35 * vWidth, 0.35 * vWidth, gap);
    color *= soft;
    alpha *= soft;
#endif
    bool emits = spark || (vKind & kQuadEmits) != 0u;  // and hides nothing
    if (alpha < 0.002 && !emits) discard;
    color *= view.sunDirection.w;
    if (kEncoding != 0u) {
        // The target blends encoded values. Smoke is a coloured medium. Flame adds light, and a
        // thin one must turn red, not grey. Saturated light hides what is behind it, or overlapping
        // flames would sum up to white.
        float whole = smoke ? max(alpha, 1e-6) : 1.0;
        color = encodeOutput(color / whole, kEncoding) * whole;
        float brightest = max(max(color.r, color.g), color.b);
        alpha = smoke || emits ? alpha : max(alpha, brightest * brightest * brightest);
    }
    outColor = vec4(min(color, vec3(60000.0)), alpha);
}
