// A burning surface as a pure function of time since ignition, appearance and tiling noise. Lengths
// m, times appearance seconds, temperatures K, emission cd/m^2. Needs lib/appearance_noise.glsl,
// lib/colour.glsl and the families of surface.frag. Layer order matters: heat, char, film, ash,
// glow, rim, soot, water.

const float kThinRim = 0.007;  // m, rimWidth below which the glow is a line

struct Site {     // one point of the surface
    vec2 d;       // m, detail coordinates, y along the grain
    float pixel;  // m per pixel
    float age;    // since ignition; negative: predicted
    float slow;   // s/m, slope of the ignition time
    float offset;  // s, burn-through offset: holes come earlier by it
    float left;   // s to the hole of a cut mesh; negative: from noise
    float nearness;  // as SurfaceDraw's
    float steep;  // m/m, at least 1: decrease of the distance to the hole along the surface
    vec2 ahead;   // unit, towards fresh material, in detail space
    float out_;   // [0, 1] extinguished and cold
    float deep;   // [0, 1] depth of char
    float gain;   // K of additional glow
    float brown;  // [0, 1] browning by other objects' heat
    float water;  // [0, 1] soaked
    float soot;   // [0, 1]
    float keep;   // duration factor of the glow: hollows keep heat
    vec3 base;    // fresh albedo
    float baseRough;
    float delay;       // [-1, 1] of a strand, vein or thread
    float cavity;      // 1 exposed .. 0 hidden, of the unburnt detail: survives charring
    float time;        // s, for flicker only
    vec4 coarse;       // noise at 4 tiles per metre
    vec4 fine;         // at 17
    vec4 grown;        // of the hole pattern
    vec2 bubbleSlope;  // per m, of bubbleShape
};

struct Skin {  // shading input
    vec3 albedo;
    float rough;
    float f0;
    vec3 emission;  // cd/m^2
    float occlusion;
    float edge;  // m to the rim of a hole
    float sheen;
    vec2 slope;  // d depth / d detail coordinate
};

// Displaces the lookup of the ignition time, so raggedness does not depend on speed. Also returns
// its two noise samples, which the unburnt detail uses.
vec2 frontWarp(vec2 d, float pixel, MaterialAppearance m, out vec4 coarse, out vec4 fine) {
    pixel = max(pixel, m.blur);
    coarse = noiseAt(d, 4.0, pixel);
    fine = noiseAt(d, 17.0, pixel);
    return 2.0 * m.warpLarge * (vec2(coarse.r, coarse.g * 0.5 + 0.25) - 0.5) +
           2.0 * m.warpSmall * (vec2(fine.b, fine.r) - 0.5);
}

float limitGlow(float kelvin, Site s) {
    return mix(kelvin + s.gain, 300.0 + 0.45 * (kelvin - 300.0), s.out_);
}

// Delay of a hole by noise and unburnt detail, s.
float holeDelay(vec4 grown, vec4 fine, float delay, MaterialAppearance m) {
    float n = (grown.r - 0.5) * 1.8 + m.holeFine * ((grown.a - 0.5) * 0.8 + (fine.r - 0.5) * 0.8);
    n = n < 0.0 ? n : 0.45 * n;  // short upper tail: fewer floating islands
    return m.holeVariation * n + 1.5 * m.jitter * delay;
}

// Burn-through offset, s, by the opposite wall, lit `other` s ago; as burnThroughTime: when one
// wall has burnt through, or where both fronts meet.
float burnThroughOffset(float a, float other, float through) {
    if (other <= -0.999 * through) return 0.0;
    float both = max(0.5 * (through - a - other), -min(a, other));
    return max(through - a - min(through - max(a, other), both), 0.0);
}

// Distance to the rim of the hole, m; negative: gone.
float holeEdge(float a, Site s, MaterialAppearance m) {
    if (m.holeTime <= 0.0) return 1.0;
    // A cut rim is smooth: its glow gets patches. Far away it is as wide as the noise makes other
    // rims.
    if (s.left >= 0.0)
        return s.left / s.slow * mix(0.5, 1.0, s.nearness) +
               0.5 * m.rimWidth * s.nearness * smoothstep(0.42, 0.62, s.fine.r);
    return (m.holeTime + holeDelay(s.grown, s.fine, s.delay, m) - s.offset - a) / s.slow;
}

// x: 0 block .. 1 crack; y: m to the crack; z: random per block; w: pillow. c: texel of the char
// layer.
vec4 charCracks(float a, Site s, MaterialAppearance m, vec4 c) {
    float random = s.coarse.a;
    float open1 = smoothstep(m.charTime * 0.6, m.crackTime, a - m.crackTime * 0.15 * random);
    float open2 = smoothstep(m.crackTime * 0.6, m.crackTime * 2.2, a);
    float deep = 0.7 + 0.8 * s.deep;  // deeper char cracks wider
    float w1 = m.crackWidth * deep * open1, w2 = m.crackWidth * deep * 0.45 * open2;
    float d1 = mix(c.r, c.g, m.isotropic) * m.cellX;
    float d2 = mix(c.g, c.r, m.isotropic) * m.cellX * 0.4;
    // Widened to a pixel with constant area; otherwise wood looks like lava from two metres.
    float k1 = open1 * (1.0 - smoothstep(0.25 * w1, w1 + s.pixel, d1)) * (w1 + 1e-5) /
               (w1 + 0.6 * s.pixel + 1e-5);
    float k2 = 0.7 * open2 * (1.0 - smoothstep(0.2 * w2, w2 + s.pixel, d2)) * (w2 + 1e-5) /
               (w2 + 0.6 * s.pixel + 1e-5);
    float pillow = saturate(1.8 * c.r);
    return vec4(max(k1, k2), min(d1, d2 + 0.3 * m.cellX), random, pillow * (2.0 - pillow));
}

// Paint film: 1 intact .. 0 peeled off in flakes.
float paintFilm(float a, vec4 flakes, MaterialAppearance m) {
    float left = 1.0 - 1.15 * smoothstep(-0.25 * m.charTime, 1.6 * m.charTime, a);
    return smoothstep(-0.03, 0.03, left - (0.55 * flakes.r + 0.45 * flakes.a));
}

// Blisters of paint and bubbles of plastic, [0, 1].
float bubbleShape(vec2 d, float pixel, vec4 coarse, bool molten) {
    if (!kBurns || !(kHasPaint || kHasHide)) return 0.0;
    vec4 cells = appearanceLayer(d * 2.8, kLayerChar, noiseLod(pixel, 2.8));
    float u = molten ? smoothstep(0.47, 0.68, coarse.r) : saturate(cells.g * 2.2) *
                           smoothstep(0.38, 0.60, coarse.r + 0.25 * (coarse.a - 0.5));
    return u * (2.0 - u);
}

// About albedo^(1 + k), k in [0, 1]: exact at both ends.
vec3 soaked(vec3 albedo, float k) {
    vec3 root = sqrt(albedo);  // the power 1/2 lies between the chords
    return albedo * (k < 0.5 ? mix(vec3(1.0), root, 2.0 * k) : mix(root, albedo, 2.0 * k - 1.0));
}

// Gloss of a water film: porous material shines only under standing water.
float wetShine(Site s, MaterialAppearance m) {
    return mix(m.wetGloss, max(m.wetGloss, 0.7), smoothstep(0.75, 1.0, s.water));
}

// Soot hides colour but not relief.
vec3 sooted(vec3 albedo, float soot) {
    return albedo * mix(vec3(1.0), vec3(0.07, 0.065, 0.06), soot);
}

Skin burningSkin(Site s, MaterialAppearance m) {
    Skin o;
    float a = s.age - m.jitter * s.delay;
    float x = a / s.slow;
    vec4 nA = s.fine, nB = s.coarse;
    float edge = holeEdge(a, s, m);
    float c = smoothstep(0.0, m.charTime, a + m.charTime * 0.5 * (nA.r - 0.5));
    float far = 1.0 / (1.0 + s.pixel * s.pixel / (0.0022 * 0.0022));  // relief fades into occlusion
    vec4 k = vec4(0.0, 1.0, 0.5, 0.5);
    o.slope = vec2(0.0);
    if ((kHasWood || kHasHide) && m.crackDepth > 0.0 && c > 0.0) {
        vec2 uv = s.d / vec2(m.cellX, m.cellY) / 8.0 + (vec2(nA.r, nA.b) - 0.5) * 0.04;
        float lod = noiseLod(s.pixel, 1.0 / (8.0 * m.cellX));
        vec4 texel = appearanceLayer(uv, kLayerChar, lod);
        k = charCracks(a, s, m, texel);
        float open = smoothstep(m.charTime * 0.6, m.crackTime, a);
        vec2 slope = texel.ba * 2.0 - 1.0;
        o.slope += slope * (kCrackSlopeRange * m.crackDepth * far * open * (0.5 + 1.2 * s.deep)) /
                   vec2(m.cellX, m.cellY);
    }
    if ((kHasSheet || kHasPlant || kHasHide) && m.crumple > 0.0 && c > 0.0) {
        float lod = noiseLod(s.pixel, 13.0);
        vec2 slope = appearanceLayer(s.d * 13.0, kLayerRelief, lod).rg * 2.0 - 1.0;
        o.slope += slope * (kCrumpleSlopeRange * 13.0 * 0.5 * m.crumple * c);
    }

    if (kHasHide && m.crumple > 0.0 && x > -1.3 * m.scorchWidth) {  // leather puckers as it shrinks
        vec2 fold = appearanceLayer(s.d * 3.1, kLayerRelief, noiseLod(s.pixel, 3.1)).rg * 2.0 - 1.0;
        // Within the area that is drawn as burning: 1.3 scorchWidth.
        float drawn = smoothstep(-1.3 * m.scorchWidth, -0.3 * m.scorchWidth, x) * (1.0 - 0.5 * c);
        o.slope += fold * (kCrumpleSlopeRange * 3.1 * 4.0 * m.crumple * drawn);
        float u = (x + 0.6 * m.scorchWidth) / (0.5 * m.scorchWidth);  // and curls along the fire
        o.slope -= s.ahead * (1.6 * u * exp(-u * u) * (0.3 + 1.4 * nB.r) *
                              smoothstep(-1.3 * m.scorchWidth, -0.8 * m.scorchWidth, x));
    }

    // Heating: first browning, then absorption; absorption alone turns blue paint green.
    float pre = smoothstep(-m.scorchWidth, 0.0, x + m.scorchWidth * 0.35 * (nB.r - 0.5));
    pre = max(pre, min(s.brown * (0.75 + 0.5 * nB.r), 1.0));
    float q = m.scorchGain * (pre * pre * 0.75 + 1.1 * smoothstep(0.0, 0.5 * m.charTime, a));
    vec3 heated = s.base;
    float wilt = m.wiltColor.w;
    if (wilt > 0.0) {
        heated = mix(heated, m.wiltColor.rgb * (0.4 + 0.8 * s.cavity),
                     0.85 * smoothstep(-wilt, -0.3 * wilt, x + wilt * 0.5 * (nB.r - 0.5)));
    }
    heated = mix(heated, vec3(1.3, 0.92, 0.55) * dot(heated, vec3(0.35, 0.5, 0.15)), 0.75 * pre);
    vec3 albedo = heated * exp(-q * vec3(0.85, 1.4, 2.0));
    float rough = mix(s.baseRough, 0.8, pre * (1.0 - m.melt));

    // Char keeps the relief of the unburnt material.
    vec3 charred =
        m.charColor.rgb * ((0.65 + 0.7 * nA.b) * (0.85 + 0.3 * k.z) * (0.35 + 0.85 * s.cavity) *
                           (0.75 + 0.6 * (nB.r - 0.3)) * (1.25 - 0.5 * s.deep));
    albedo = mix(albedo, charred, c);
    rough = mix(rough, m.charColor.w + 0.25 * (nA.g - 0.5) + 0.2 * (k.z - 0.5), c);
    float f0 = mix(0.04, 0.05, c);

    float film = m.ashColor.w;
    if (kHasPaint && film > 0.0) {
        float left = paintFilm(a, nA, m) * smoothstep(-0.6 * m.scorchWidth, 0.0, x);
        albedo = mix(albedo, vec3(0.022, 0.02, 0.02) + 0.10 * s.base * (1.0 - c), left);
        rough = mix(rough, 0.35, left);
        k = mix(k, vec4(0.0, 1.0, k.z, 0.8), left);
        o.slope *= 1.0 - left;
        c *= 1.0 - left;
    }
    if ((kHasPaint || kHasHide) && m.blister > 0.0) {
        float swell = smoothstep(-m.scorchWidth * 0.9, -m.scorchWidth * 0.1, x);
        float burst = 1.0 - smoothstep(m.charTime * 0.3, m.charTime * 1.2, a);
        o.slope -= s.bubbleSlope * (m.blister * swell * mix(burst, 1.0, m.melt));
    }

    // Ash follows the glow, on exposed tops, not in cracks.
    float nearCrack = m.crackDepth > 0.0 ? 0.55 * exp(-k.y / (2.2 * m.crackWidth)) - 0.1 : 0.0;
    float spread = 1.1 * (nB.g - 0.45) - 1.2 * (nB.r - 0.5) + 0.5 * (nA.r - 0.5) +
                   0.2 * (k.z - 0.5) + nearCrack;
    float ash = m.ashMax * smoothstep(m.ashStart, m.ashEnd, a + (m.ashEnd - m.ashStart) * spread);
    ash *= smoothstep(0.5 * m.ashStart, 1.3 * m.ashStart, a);
    ash *= (1.0 - k.x) * (0.3 + 0.7 * smoothstep(0.2, 0.7, s.cavity)) *
           smoothstep(0.15, 0.6, 0.35 * k.w + 0.65 * nA.b + 0.4 * (nA.g - 0.4));
    albedo = mix(albedo, m.ashColor.rgb * ((0.75 + 0.5 * nA.b) * (0.2 + 0.9 * s.cavity)), ash);
    rough = mix(rough, 0.97, ash);

    // Glow: noise on temperature, not on brightness; long-lived in cracks only.
    float breath = 45.0 * sin(s.time * 2.1 + 40.0 * nB.b + 6.28 * k.z) * nA.r;
    float dT = m.glowVariation * ((nB.b - 0.5) * 1.6 + (nA.b - 0.5) * 1.2 + (nA.r - 0.5) * 1.5 +
                                  0.4 * (k.z - 0.5)) +
               breath;
    float face = 300.0 + (m.faceKelvin - 300.0) * smoothstep(0.0, m.facePeak, a) *
                             exp(-max(0.0, a - m.facePeak) / (m.faceDecay * s.keep));
    vec3 emission = emberRadiance(limitGlow(face + dT, s)) *
                    (0.9 * (1.0 - 0.9 * ash) * smoothstep(0.0, 0.4, c));
    if ((kHasWood || kHasHide) && m.crackDepth > 0.0 && c > 0.0) {
        float life = m.crackLife * s.keep * (0.55 + 2.2 * nB.r * nB.r + 0.4 * k.z);
        float crack = 300.0 + (m.crackKelvin - 300.0) *
                                  smoothstep(0.3 * m.facePeak, 2.0 * m.facePeak, a) *
                                  exp(-a * a / (life * life));
        crack += dT - 0.8 * m.glowVariation * (nA.r - 0.5);
        float wall = exp(-k.y / (1.6 * m.crackWidth + 1e-5)) * c;
        emission += emberRadiance(limitGlow(crack, s)) * (k.x * 0.95 + 0.10 * wall * (1.0 - ash));
    }
    if ((kHasSheet || kHasPlant) && m.wormKelvin > 0.0) {
        float level = fract(s.age * 0.13);
        float off = (nA.r - 0.32 - 0.36 * level) / 0.008;
        float worm = exp(-off * off) * smoothstep(0.5, 0.62, nB.r) *
                     smoothstep(m.charTime, m.charTime * 1.5, a) * 4.0 * level * (1.0 - level);
        emission += emberRadiance(limitGlow(m.wormKelvin + 0.5 * dT, s)) * worm;
    }
    if (m.holeTime > 0.0) {
        float e = max(edge, 0.0) / s.steep;
        if (m.rimKelvin > 0.0) {
            // A line thinner than a pixel keeps its energy; on thin material it is two pixels wide
            // to avoid dots.
            float least = m.rimWidth < kThinRim ? 1.5 * s.pixel : 0.5 * s.pixel;
            float wide = 0.35 * m.rimWidth / (0.35 * m.rimWidth + least);
            // The rim of a hole that stopped growing dies down.
            float old = max(0.0, a - 1.1 * m.holeTime) / (3.0 * m.faceDecay);
            old *= s.left < 0.0 ? 0.0 : s.nearness;
            float rim = 300.0 + (m.rimKelvin - 300.0) * exp(-e * wide / m.rimWidth - old) +
                        (kHasSheet ? 0.3 : 0.8) * dT;
            emission += emberRadiance(limitGlow(rim, s)) * (0.9 * (1.0 - 0.6 * ash) * wide);
            albedo = mix(albedo, m.charColor.rgb * 0.7, 0.9 * exp(-e / (2.5 * m.rimWidth)));
        }
        float t = saturate(1.0 - e / (0.9 * m.thickness));
        // Rounded towards the rim, or a bead of molten material; thin material curls.
        float bead = m.lip * 2.0 * e / (2.5e-3 * 2.5e-3) * exp(-e * e / (2.5e-3 * 2.5e-3));
        o.slope += s.ahead * (bead - 1.1 * t * (1.0 - m.melt) -
                              m.curl * exp(-e / (6.0 * m.rimWidth + 1e-4)) * c);
    }
    rough = mix(rough, 0.16 + 0.3 * c, m.melt * smoothstep(-0.7 * m.scorchWidth, 0.0, x));

    float soot = saturate(s.soot * (0.7 + 0.6 * nB.r)) * (1.0 - ash);
    albedo = sooted(albedo, soot);
    rough = mix(rough, 0.9, soot);

    // Water darkens porous material; char only gets gloss.
    albedo = soaked(albedo, m.wetDark * s.water * (1.0 - 0.85 * c));
    albedo *= 1.0 - 0.25 * min(m.wetDark, 1.0) * s.water * (1.0 - c);
    rough = mix(rough, 0.16, s.water * mix(wetShine(s, m), 0.85, c));

    o.albedo = albedo;
    o.rough = clamp(rough, 0.08, 1.0);
    o.f0 = mix(f0, 0.03, s.water);
    o.emission = emission;
    o.occlusion = (1.0 - (0.6 + 0.35 * s.deep) * k.x) * (1.0 - 0.25 * c * (1.0 - k.w));
    o.edge = edge;
    o.sheen = m.sheen * c * (1.0 - ash);
    return o;
}

// Surface without fire nearby: burningSkin's result at low cost.
Skin freshSkin(Site s, MaterialAppearance m) {
    Skin o;
    o.albedo = soaked(s.base, m.wetDark * s.water) * (1.0 - 0.25 * min(m.wetDark, 1.0) * s.water);
    o.rough = clamp(mix(s.baseRough, 0.16, s.water * wetShine(s, m)), 0.08, 1.0);
    o.f0 = mix(0.04, 0.03, s.water);
    o.emission = vec3(0.0);
    o.occlusion = 1.0;
    o.edge = 1.0;
    o.sheen = 0.0;
    o.slope = vec2(0.0);
    return o;
}

// Wall of a hole in a thin shell: distance along the view ray, m; negative: the ray passes through.
// ray: in the tangent frame, z < 0 inwards; rise: gradient of the edge distance along the surface,
// per m. The edge is extrapolated linearly; a rounded wall makes the intersection a quadratic.
float rimHit(float edge, vec2 rise, float thickness, vec3 ray) {
    // At grazing angles the extrapolation fails: outlines of burnt parts would remain.
    if (edge < -0.8 * thickness) return -1.0;
    float length_ = thickness / max(-ray.z, 0.3), bulge = 0.35 * thickness;
    float a = 4.0 * bulge / (length_ * length_), b = dot(rise, ray.xy) + a * length_;
    float c = edge - bulge, square = b * b + 4.0 * a * c;
    if (square <= 0.0 || b <= 0.0) return -1.0;
    float t = -2.0 * c / (b + sqrt(square));
    return t < length_ ? t : -1.0;
}
