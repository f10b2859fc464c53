// Volumetric flames: records, coordinates along a curve, noise, emission and absorption at a point.
// The includer runs the march and samples the profile between flameLookup and flameMedium. Lengths
// m, times s, temperatures K.
// clang-format off
#ifndef FW_SHARED_VOLUME_H
#define FW_SHARED_VOLUME_H
#include "shared/black_body.h"
#include "shared/volume_draw.h"
#ifdef __cplusplus
#include <bit>
#endif


FW_SHARED_BEGIN
#ifdef __cplusplus
using glm::unpackUnorm4x8;
inline float intBitsToFloat(int x) { return std::bit_cast<float>(x); }
#endif

FW_CONST uint kFlameNodes = 24u;          // per curve
FW_CONST uint kFlameOctaves = 4u;         // per flame, at most
FW_CONST uint kProfileWidth = 64u;        // texels over rho in [0, kProfileReach]
FW_CONST uint kProfileHeight = 128u;      // texels over y in [0, 1]
FW_CONST float kProfileReach = 1.25f;     // rho at the profile's right edge
FW_CONST float kFlameReach = 1.2f;  // |p| over the tube's radius beyond which nothing burns
FW_CONST float kFlameTop = 2.6f;          // y beyond which nothing burns
FW_CONST float kFlameWrap = 4096.0f;  // noise cells after which noise repeats along a flame
// E|flameNoise|, which removes the bias of ridged noise.
FW_CONST float kFlameMeanAbs = 0.177f;
FW_CONST float kFlamePuffLag = 1.6f;      // a bulge travels slower than the gas

struct FlameNode {        // point of a curve, evenly spaced
    vec4 centre;          // xyz m, world; w: m, radius of the tube
    vec4 along;           // xyz unit: normal of the bisector plane; w: m from the base
    // Xyz unit, of the rotation-minimising frame; w: >= 1, widening of the tube by a wall.
    vec4 side;
    vec4 squeeze;         // xyz: unit, flattening direction of a wall; w: [0, 0.9] strength
};
FW_SIZE(FlameNode, 64)

struct FlameRecord {      // one flame in one frame
    vec4 low;             // xyz m, world: bounds of all its visible parts; w: m, diameter
    vec4 high;  // w: m, height of the profile; the visible flame is higher, see heightFactor
    vec4 scroll;          // noise cells that each octave has risen, [0, kFlameWrap)
    vec4 place;           // xyz: noise cells, offset in the noise; w: [0, 1) phase of the puffing
    vec4 tint;            // rgb linear; w: weight, 0 is black body
    vec4 glow;            // xyz m, world: point that lights the smoke; w: strength, radiance m^2

    vec4 air;             // rgb: ambient light that smoke scatters; w: [0, 1] density, fades flames

    float warpScroll; float columnScroll; float smokeScroll; // cells, as scroll
    float speed;          // m/s, of gas at half height

    float tauStart;       // m, distance of the speed's virtual origin below the base
    float tauFree;        // m, height from which the speed is constant
    float lambda;         // m, wavelength of turbulence
    float lambdaWarp;     // m, of rolling eddies

    float lambdaColumn;   // m, wavelength of the slow field that varies the height of tongues
    float stretch;        // 1 isotropic; more: stretched along the flame
    float turbulence;     // amplitude of the height's displacement
    float radial;         // amplitude of the radius' displacement

    float warp;           // amplitude of eddies, in diameters
    float columns;        // amplitude of columns
    float ridge;          // 0 signed noise, 1 ridged
    float converge;       // lean of tongues towards the axis

    float puff;           // amplitude of a travelling bulge; 0 if the curve's radii contain it
    float soot;           // 1/m, absorption where the profile is 1
    float blue;           // radiance per diameter, of soot-free gas
    float blueHeight;     // of y

    float erode;          // thinning with height
    float filament;       // [0, 1] share of the soot in sheets
    float filamentWidth; float filamentBase;

    float filamentHeight; // y at which sheets are complete
    float tipFill;        // one-sided filling of sheets at the top
    float smoke;          // 1/m
    float smokeTop;       // y at which smoke ends

    float smokeAlbedo;
    uint tintCore;        // rgb of the hottest under a tint: roots of linear, 8 bits each
    float tintLow; float tintHigh; // K

    uint key;             // of the flame, constant over frames
    uint tier;            // FwFireTier
    uint profile;         // layer
    uint octaves;         // [1, 4]
};
FW_SIZE(FlameRecord, 256)

struct VolumeFlame {   // as a draw reads it
    FlameRecord record;
    FlameNode nodes[kFlameNodes];
};
FW_SIZE(VolumeFlame, kVolumeFlameBytes)

struct FlamePlace {       // a point in a curve's coordinates
    vec2 p;               // m off the axis, along side and cross(along, side)
    float s;              // m along
    float radius;         // m of the tube there
};

struct FlameLookup {      // where to sample the profile, and how to use the sample
    float rho; float y;
    float erode; float sheet; float guard;
    float lit;            // 0: nothing here, do not sample
};

struct FlameMedium {
    float soot;           // 1/m
    float smoke;          // 1/m
    float smokeShade;     // [0, 1], 1 on the crests of its billows
    vec3 emission;        // radiance per m
};

struct FlameRay {
    vec3 radiance;
    vec3 through;         // transmittance
};

// 2^x within 1e-4, x clamped to [-60, 60]: four times faster than devices' own.
FW_FN float flameExp2(float x) {
    float whole = floor(clamp(x, -60.0f, 60.0f));
    float f = clamp(x, -60.0f, 60.0f) - whole;
    float part = 1.0f + f * (0.6955568f + f * (0.2261735f + f * 0.0782697f));
    return part * intBitsToFloat((int(whole) + 127) << 23);
}

// ---- noise: gradient noise, mean 0, rms 0.220, |n| < 1; repeats along y after kFlameWrap cells

// One multiplication per corner: noise dominates the cost of a flame.
FW_FN uint flameCorner(uint h) {
    h = (h ^ (h >> 15)) * 0x2C1B3C6Du;
    return h ^ (h >> 13);
}

// Contribution of a corner at distance f. Its gradient is uniform in a cube of half side 2^31.
FW_FN float flameCornerDot(uint key, vec3 f) {
    uint h = flameCorner(key);
    return float(int(h)) * f.x + float(int(h << 11)) * f.y + float(int(h << 21)) * f.z;
}

// Cell of a noise position: offsets from both corners, weights, hashes of corners.
struct FlameLattice {
    vec3 f; vec3 g; vec3 u;
    uint i; uint i1; uint j; uint j1; uint k; uint k1;
};
FW_FN FlameLattice flameLattice(vec3 x) {
    FlameLattice l;
    vec3 cell = floor(x);
    l.f = x - cell;
    l.g = l.f - vec3(1.0f);
    l.u = l.f * l.f * l.f * (l.f * (l.f * 6.0f - vec3(15.0f)) + vec3(10.0f));
    int y = int(cell.y);
    l.i = uint(int(cell.x)) * 0x9E3779B1u; l.i1 = l.i + 0x9E3779B1u;
    l.j = uint(y & 4095) * 0x85EBCA77u; l.j1 = uint((y + 1) & 4095) * 0x85EBCA77u;
    l.k = uint(int(cell.z)) * 0xC2B2AE3Du; l.k1 = l.k + 0xC2B2AE3Du;
    return l;
}
FW_FN float flameNoise(vec3 x) {
    FlameLattice l = flameLattice(x);
    vec3 f = l.f, g = l.g, u = l.u;
    uint k = l.k, k1 = l.k1;
    uint ij = l.i ^ l.j; uint i1j = l.i1 ^ l.j; uint ij1 = l.i ^ l.j1; uint i1j1 = l.i1 ^ l.j1;
    float a = flameCornerDot(ij ^ k, f);
    float b = flameCornerDot(i1j ^ k, vec3(g.x, f.y, f.z));
    float c = flameCornerDot(ij1 ^ k, vec3(f.x, g.y, f.z));
    float d = flameCornerDot(i1j1 ^ k, vec3(g.x, g.y, f.z));
    float e = flameCornerDot(ij ^ k1, vec3(f.x, f.y, g.z));
    float m = flameCornerDot(i1j ^ k1, vec3(g.x, f.y, g.z));
    float n = flameCornerDot(ij1 ^ k1, vec3(f.x, g.y, g.z));
    float o = flameCornerDot(i1j1 ^ k1, g);
    a += u.x * (b - a); c += u.x * (d - c); e += u.x * (m - e); n += u.x * (o - n);
    a += u.y * (c - a); e += u.y * (n - e);
    return (1.15f / 2147483648.0f) * (a + u.z * (e - a));
}

FW_FN vec3 flameCornerSlope(uint h) {
    return vec3(float(int(h)), float(int(h << 11)), float(int(h << 21)));
}

// Slopes of two noises on one lattice, scaled by 2^31 / 1.15: contribution of a corner. w: its
// weight, dw: slope of the weight.
FW_FN void flameCornerCurl(uint key, vec3 f, float w, vec3 dw, FW_INOUT(vec3) first,
                           FW_INOUT(vec3) second) {
    uint h = flameCorner(key);
    vec3 g = flameCornerSlope(h);
    first += w * g + dot(g, f) * dw;
    g = flameCornerSlope(h * 0x297A2D39u);
    second += w * g + dot(g, f) * dw;
}

// Slopes of two noises at once, per cell.
FW_FN void flameSlopes(vec3 x, FW_INOUT(vec3) first, FW_INOUT(vec3) second) {
    FlameLattice l = flameLattice(x);
    vec3 f = l.f, g = l.g, u = l.u;
    vec3 v = vec3(1.0f) - u;
    vec3 d = 30.0f * f * f * (f * (f - vec3(2.0f)) + vec3(1.0f));
    uint i = l.i, i1 = l.i1, j = l.j, j1 = l.j1, k = l.k, k1 = l.k1;
    // Products of two weights, named by the remaining axis.
    vec4 byX = vec4(v.y * v.z, u.y * v.z, v.y * u.z, u.y * u.z);
    vec4 byY = vec4(v.x * v.z, u.x * v.z, v.x * u.z, u.x * u.z);
    vec4 byZ = vec4(v.x * v.y, u.x * v.y, v.x * u.y, u.x * u.y);
    vec4 dx = d.x * byX; vec4 dy = d.y * byY; vec4 dz = d.z * byZ;
    vec3 a = vec3(0.0f); vec3 b = vec3(0.0f);
    flameCornerCurl(i ^ j ^ k, f, v.x * byX.x, vec3(-dx.x, -dy.x, -dz.x), a, b);
    flameCornerCurl(i1 ^ j ^ k, vec3(g.x, f.y, f.z), u.x * byX.x, vec3(dx.x, -dy.y, -dz.y), a, b);
    flameCornerCurl(i ^ j1 ^ k, vec3(f.x, g.y, f.z), v.x * byX.y, vec3(-dx.y, dy.x, -dz.z), a, b);
    flameCornerCurl(i1 ^ j1 ^ k, vec3(g.x, g.y, f.z), u.x * byX.y, vec3(dx.y, dy.y, -dz.w), a, b);
    flameCornerCurl(i ^ j ^ k1, vec3(f.x, f.y, g.z), v.x * byX.z, vec3(-dx.z, -dy.z, dz.x), a, b);
    flameCornerCurl(i1 ^ j ^ k1, vec3(g.x, f.y, g.z), u.x * byX.z, vec3(dx.z, -dy.w, dz.y), a, b);
    flameCornerCurl(i ^ j1 ^ k1, vec3(f.x, g.y, g.z), v.x * byX.w, vec3(-dx.w, dy.z, dz.z), a, b);
    flameCornerCurl(i1 ^ j1 ^ k1, g, u.x * byX.w, vec3(dx.w, dy.w, dz.w), a, b);
    first = (1.15f / 2147483648.0f) * a;
    second = (1.15f / 2147483648.0f) * b;
}

// Divergence-free eddies, limited so that none carries fire far from the flame.
FW_FN vec3 flameCurl(vec3 x) {
    vec3 a; vec3 b;
    flameSlopes(x, a, b);
    vec3 w = cross(a, b);
    return w / (1.0f + 0.6f * length(w));
}

// ---- rise

// Residence time from the base to s: McCaffrey's speed 6.84 sqrt(s), then constant. A function of
// tau - t moves with the gas and stretches with it.
FW_FN float flameTau(float s, float tauStart, float tauFree) {
    float a = clamp(s, 0.0f, tauFree);
    return (2.0f / 6.84f) * (sqrt(a + tauStart) - sqrt(tauStart)) +
           max(s - tauFree, 0.0f) / (6.84f * sqrt(tauFree + tauStart));
}

// ---- curve

FW_FN float flamePlane(vec3 x, FlameNode node) {
    return dot(x - vec3(node.centre), vec3(node.along));
}

// Coordinates of a point between the bisector planes of two nodes: da >= 0 in front of the first,
// db < 0 before the second. Continuous across segments.
FW_FN FlamePlace flamePlaceAt(vec3 x, FlameNode a, FlameNode b, float da, float db) {
    float w = da / max(da - db, 1e-9f);
    vec4 centre = mix(a.centre, b.centre, w);
    vec3 off = x - vec3(centre);
    vec3 side = mix(vec3(a.side), vec3(b.side), w);
    vec3 along = mix(vec3(a.along), vec3(b.along), w);
    vec3 flat_ = mix(vec3(a.squeeze), vec3(b.squeeze), w);
    float squeeze = mix(a.squeeze.w, b.squeeze.w, w);
    off += flat_ * (dot(off, flat_) * squeeze / (1.0f - squeeze));
    FlamePlace place;
    place.p = vec2(dot(off, side), dot(off, cross(along, side))) / mix(a.side.w, b.side.w, w);
    place.s = mix(a.along.w, b.along.w, w);
    place.radius = centre.w / mix(a.side.w, b.side.w, w);
    return place;
}

// ---- appearance

// Noise of hot gas that left p, m across the flame, and is z m along the pattern that rises with it:
// rolling eddies, and the slow field that varies the height of tongues.
FW_FN vec3 flameEddy(FlameRecord f, vec2 p, float z) {
    return flameCurl(vec3(p.x / f.lambdaWarp + f.place.x,
                          z / f.lambdaWarp + f.place.y - f.warpScroll,
                          p.y / f.lambdaWarp + f.place.z));
}
FW_FN float flameColumn(FlameRecord f, vec2 p, float z) {
    return flameNoise(vec3(p.x / f.lambdaColumn + f.place.y,
                           0.35f * z / f.lambdaColumn + f.place.z - f.columnScroll,
                           p.y / f.lambdaColumn + f.place.x));
}

struct FlameTurbulence { float rough; float sheet; };
// Unbiased turbulence, half signed, half ridged, and the noise whose zeros are sheets; smaller eddies
// move at their own speeds. lambda: footprints of a sample in half a wavelength.
FW_FN FlameTurbulence flameTurbulence(FlameRecord f, vec2 p, float z, float lambda) {
    vec3 x = vec3(p.x / f.lambda + f.place.z, z / f.lambda + f.place.x, p.y / f.lambda + f.place.y);
    FlameTurbulence noise;
    noise.rough = 0.0f; noise.sheet = 0.0f;
    float weight = 1.0f;
    vec4 scroll = f.scroll;
    uint o = 0u;
    do {  // all lanes run the same number of iterations
        float fade = o == 0u ? 1.0f : clamp(lambda - 0.5f, 0.0f, 1.0f);
        float n = flameNoise(x - vec3(0.0f, scroll.x, 0.0f));
        noise.rough += weight * fade * (f.ridge * (2.2f * kFlameMeanAbs) +
                                        (1.3f - 1.3f * f.ridge) * n - (2.2f * f.ridge) * abs(n));
        noise.sheet += weight * fade * n * (o == 0u ? 1.0f : 0.6f);
        weight *= 0.5f; lambda *= 0.5f;
        x = vec3(2.03f * x.x + 11.3f, 2.0f * x.y + 7.7f, 2.03f * x.z + 5.1f);
        scroll = vec4(scroll.y, scroll.z, scroll.w, 0.0f);
        o += 1u;
    } while (o < f.octaves);
    return noise;
}

// Soot lies in sheets where the advected noise is 0, the crests of the displacement. thin: a sample's
// footprint, in wavelengths; tip: of the flame.
FW_FN float flameFilament(FlameRecord f, float sheet, float thin, float tip) {
    float width = sqrt(f.filamentWidth * f.filamentWidth + thin * thin);
    float filament =
        f.filamentWidth / width * flameExp2(-1.442695f * sheet * sheet / (width * width));
    return sheet > 0.0f ? max(filament, f.tipFill * smoothstep(0.3f, 0.9f, tip)) : filament;
}

// size: m, footprint of the sample (the larger of step and pixel); finer detail fades.
FW_FN FlameLookup flameLookup(FlameRecord f, FlamePlace at, float size) {
    FlameLookup lookup;
    lookup.lit = 0.0f; lookup.rho = 2.0f; lookup.y = 2.0f;
    lookup.erode = 0.0f; lookup.sheet = 1.0f; lookup.guard = 0.0f;
    float diameter = f.low.w;
    float y = at.s / f.high.w;
    float tau = flameTau(at.s, f.tauStart, f.tauFree);
    float turn = f.place.w - kFlamePuffLag * 1.5f * tau / sqrt(diameter);
    turn -= floor(turn) + 0.5f;
    float swell = 8.0f * turn * (2.0f * abs(turn) - 1.0f);  // a sine, nearly
    float radius = at.radius * (1.0f + f.puff * smoothstep(0.0f, 0.5f, y) * swell);
    float rim = length(at.p) / max(radius, 1e-6f);
    if (y < 0.0f || y > kFlameTop || rim > kFlameReach || radius < 1e-5f) return lookup;
    float rise = smoothstep(0.0f, 1.0f, y);
    float grow = smoothstep(0.02f, 0.9f, y);
    float z = f.speed * tau / f.stretch;

    // Gas flows in over the base: tongues lean inward.
    float narrow = 1.0f - 0.6f * f.converge * rise;
    vec2 p = at.p / narrow;
    vec3 eddy = flameEddy(f, p, z);
    p += vec2(eddy.x, eddy.z) * (f.warp * diameter * grow);
    float yw = y + eddy.y * (0.5f * f.warp * grow);
    // Tongues of unequal height, changing slowly.
    float column = flameColumn(f, p, z);
    yw /= max(0.25f, 1.0f + f.columns * (column + 0.10f));
    FlameTurbulence noise = flameTurbulence(f, p, z, f.lambda * narrow / (2.0f * size));
    float rough = noise.rough;
    // The foot stays lit for any noise.
    lookup.y = max(yw - f.turbulence * sqrt(y) * rough, 0.5f * y * (1.0f - grow));
    lookup.rho = length(p) * narrow / radius *
        (1.0f - f.radial * rough * smoothstep(0.0f, 0.4f, y));
    lookup.erode = f.erode * smoothstep(0.2f, 1.2f, y);
    float filament = flameFilament(f, noise.sheet, 0.7f * size / (f.lambda * narrow), y);
    lookup.sheet = mix(1.0f, f.filamentBase + (1.6f - f.filamentBase) * filament,
                     f.filament * smoothstep(0.0f, f.filamentHeight, y));
    // Prevents islands beside the foot and an edge at the tube's end.
    lookup.guard = (1.0f - smoothstep(0.0f, 0.30f, rim - mix(0.90f, 0.75f, rise))) *
                 (1.0f - smoothstep(kFlameTop - 0.3f, kFlameTop, y));
    lookup.lit = lookup.y < 1.0f && lookup.rho < kProfileReach && lookup.guard > 0.0f ? 1.0f : 0.0f;
    return lookup;
}

FW_FN vec3 flameRadiance(FlameRecord f, float kelvin) {
    vec3 radiance =
        sootColour(kelvin, flameExp2(34981.0f * (1.0f / 1600.0f) - 34981.0f / max(kelvin, 400.0f)));
    if (f.tint.w > 0.0f) {  // coloured fire keeps the luminance
        float luminance = dot(radiance, vec3(0.2126f, 0.7152f, 0.0722f));
        float hot = smoothstep(f.tintLow, f.tintHigh, kelvin);
        vec3 core = vec3(unpackUnorm4x8(f.tintCore));
        radiance =
            mix(radiance, 1.1f * luminance * mix(vec3(f.tint), core * core, hot * hot), f.tint.w);
    }
    return radiance;
}

// profile: sample of the fire profile at lookup.rho, lookup.y: x in 1000 K, 0 without hot gas; y
// soot.
FW_FN FlameMedium flameMedium(FlameRecord f, FlameLookup lookup, vec2 profile) {
    FlameMedium m;
    float soot = max(0.0f, profile.y - lookup.erode) / (1.0f - lookup.erode) * lookup.sheet *
        lookup.guard;
    m.soot = f.soot * f.air.w * soot;
    m.smoke = 0.0f; m.smokeShade = 0.5f;
    m.emission = m.soot * flameRadiance(f, 1000.0f * profile.x);
    float foot = smoothstep(0.0f, 0.02f, lookup.y) *
                 (1.0f - smoothstep(0.3f * f.blueHeight, f.blueHeight, lookup.y));
    float gas = clamp(profile.x, 0.0f, 1.0f) * foot * lookup.guard *
        (1.0f - 0.8f * min(soot, 1.0f));
    m.emission +=
        f.blue * f.air.w / f.low.w * gas * mix(vec3(0.02f, 0.10f, 1.0f), vec3(f.tint), f.tint.w);
    return m;
}

// Half width of the plume above a flame, m.
FW_FN float flamePlumeWide(FlameRecord f, float s) {
    return 0.45f * f.low.w + 0.16f * max(s - 0.6f * f.high.w, 0.0f);
}

// Smoke above a flame: billows in a widening plume. x: 1/m; y: [0, 1], how bright it appears in
// light.
FW_FN vec2 flameSmoke(FlameRecord f, FlamePlace at) {
    float y = at.s / f.high.w;
    if (f.smoke <= 0.0f || y < 0.6f || y > f.smokeTop) return vec2(0.0f, 0.5f);
    float diameter = f.low.w;
    float wide = flamePlumeWide(f, at.s);
    float body = exp(-1.2f * dot(at.p, at.p) / (wide * wide));
    if (body < 0.01f) return vec2(0.0f, 0.5f);
    float scale = 0.55f * diameter * (0.7f + 0.35f * y);  // lateral only: along, it would shear
    vec3 x = vec3(at.p.x / scale + f.place.x,
                  f.speed * flameTau(at.s, f.tauStart, f.tauFree) / (0.75f * diameter) -
                      f.smokeScroll + f.place.y,
                  at.p.y / scale + f.place.z);
    float billow = -0.5f * 1.875f; float weight = 2.0f;
    uint o = 0u;
    do {
        billow += weight * abs(flameNoise(x));
        weight *= 0.5f;
        x = vec3(2.1f * x.x + 3.1f, 2.0f * x.y, 2.1f * x.z + 9.2f);
        o += 1u;
    } while (o < max(f.octaves, 3u));
    billow += weight * kFlameMeanAbs;  // mean of the omitted octave
    float density =
        smoothstep(0.05f, 1.0f, 1.15f * body + 0.55f * billow - 0.25f * (1.0f - body) - 0.12f);
    density *= smoothstep(0.6f, 1.7f, y) * (1.0f - smoothstep(0.7f * f.smokeTop, f.smokeTop, y));
    density *= smoothstep(0.01f, 0.06f, body);
    float thin = 0.45f * diameter / wide;
    return vec2(f.smoke * density * thin * thin, clamp(0.5f + 0.8f * billow, 0.0f, 1.0f));
}

// Largest distance from the axis, m, of anything visible between two places along, in a tube of
// `radius`, widened by `widened`.
FW_FN float flameReachAt(FlameRecord f, float s0, float s1, float radius, float widened) {
    float reach = kFlameReach * (1.0f + f.puff) * radius;
    if (f.smoke <= 0.0f || s1 < 0.6f * f.high.w || s0 > f.smokeTop * f.high.w) return reach;
    return max(reach, widened * 1.96f * flamePlumeWide(f, s1));
}

struct FlameSun {         // sunlight for a ray's smoke
    vec3 light;           // scattered towards the camera by smoke in the open
    // Unit, towards the sun, in the frame of the curve's end: along side, across it, along.
    vec3 to;
};

// Smoke scatters forwards: Henyey-Greenstein phase function relative to isotropic scattering.
FW_CONST float kSmokeForward = 0.4f;
FW_FN FlameSun flameSun(FlameNode end, vec3 toSun, vec3 direction, vec3 light) {
    float g = kSmokeForward, q = 1.0f + g * g - 2.0f * g * dot(direction, toSun);
    vec3 side = vec3(end.side), along = vec3(end.along);
    FlameSun sun;
    sun.light = light * ((1.0f - g * g) / (q * sqrt(q)));
    sun.to = vec3(dot(toSun, side), dot(toSun, cross(along, side)), dot(toSun, along));
    return sun;
}

// erfc(x), x >= 0, within 2.5e-5: Abramowitz and Stegun, 7.1.25.
FW_FN float flameErfc(float x) {
    float t = 1.0f / (1.0f + 0.47047f * x);
    return t * (0.3480242f - t * (0.0958798f - t * 0.7478556f)) * exp(-x * x);
}

// Optical depth of smoke towards the sun. The plume's body casts the shadow, not its billows: a
// bell across the axis, whose integral is known in closed form. Width and density are those of the
// position.
FW_CONST float kSmokeBell = 2.4f;  // of its density: the body's own, reduced by billows
FW_FN float flameSmokeDepth(FlameRecord f, FlamePlace at, vec3 to) {
    float y = at.s / f.high.w;
    if (f.smoke <= 0.0f || y < 0.6f || y > f.smokeTop) return 0.0f;
    float wide = flamePlumeWide(f, at.s);
    float thin = 0.45f * f.low.w / wide;
    float most = 0.85f * f.smoke * f.air.w * thin * thin * smoothstep(0.6f, 1.7f, y) *
                 (1.0f - smoothstep(0.7f * f.smokeTop, f.smokeTop, y));
    // Limits the path straight up: smoke thins out.
    float flat2 = max(to.x * to.x + to.y * to.y, 0.08f);
    float towards = at.p.x * to.x + at.p.y * to.y;
    float a = kSmokeBell / (wide * wide);
    float beside = exp(-a * max(dot(at.p, at.p) - towards * towards / flat2, 0.0f));
    float x = sqrt(a / flat2) * towards;
    float ahead = x < 0.0f ? 2.0f - flameErfc(-x) : flameErfc(x);
    return most * beside * 0.8862269f * ahead / sqrt(a * flat2);
}

// Light scattered by smoke towards the camera per unit of density: from the flame below, ambient
// and sun. Multiple scattering reaches deeper than direct sun. Fresh smoke is finer than the
// wavelength and scatters blue more: the flame's deep orange turns brown.
FW_CONST vec3 kSmokeAside = vec3(1.0f, 1.4f, 1.9f);
FW_FN vec3 flameSmokeLight(FlameRecord f, float distance2, float shade, vec3 sun, float depth) {
    vec3 fire = kSmokeAside * flameRadiance(f, 0.5f * (f.tintLow + f.tintHigh)) *
                (f.glow.w / (distance2 + 0.3f * f.low.w * f.low.w));
    vec3 day = sun * (0.8f * exp(-depth) + 0.2f * exp(-0.2f * depth));
    return f.smokeAlbedo *
           (fire * mix(1.25f, 0.5f, shade) + (vec3(f.air) + day) * mix(0.7f, 1.1f, shade));
}

FW_CONST vec3 kFlameAbsorb = vec3(0.9f, 1.125f, 1.35f);  // soot absorbs more blue

// One step of emission and absorption, exact for a constant medium: thick flame reddens. incoming:
// light that smoke scatters towards the camera.
FW_FN FlameRay flameStep(FlameRay ray, FlameMedium m, vec3 incoming, float d) {
    // One exponential; the three channels are its powers.
    float e = flameExp2(-1.442695f * 0.225f * m.soot * d);
    float e2 = e * e;
    vec3 pass = vec3(e2 * e2, e2 * e2 * e, e2 * e2 * e2) * flameExp2(-1.442695f * m.smoke * d);
    vec3 k = m.soot * kFlameAbsorb + vec3(m.smoke);
    vec3 x = k * d;
    // (1 - exp(-x)) / k; series for small x.
    vec3 thickness = d * (vec3(1.0f) - x * (vec3(0.5f) - x * (1.0f / 6.0f)));
    vec3 thick = (vec3(1.0f) - pass) / max(k, vec3(1e-6f));
    thickness = vec3(x.x < 0.05f ? thickness.x : thick.x, x.y < 0.05f ? thickness.y : thick.y,
                     x.z < 0.05f ? thickness.z : thick.z);
    ray.radiance += ray.through * (m.emission + m.smoke * incoming) * thickness;
    ray.through *= pass;
    return ray;
}
FW_SHARED_END
#endif
