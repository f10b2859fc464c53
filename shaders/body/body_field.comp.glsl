// The gas of a body's flames at the nodes of a tile, slab by slab. A flame's gas along a ray is a
// bell; a slab keeps the bells' sum by its moments. Eight half floats per node and slab: ln of the
// gas at the middle; share of it that this slab shows; the middle, m along the view from the slab's;
// its spread, m along the ray; means over the flames: m above their feet; that in their heights; m
// by which they are drawn, along the two axes across up.
#define FW_THREADS 16
#include "lib/compute.glsl"
#include "body/body.glsl"
FW_READ_WRITE(VOLUME_RAYS) FW_PUSH(MarchPush)
#include "lib/colour.glsl"
layout(set = 1, binding = 0) uniform sampler2DArray profiles;
#include "volume/ray.glsl"

vec4 wordsAt(uint cell, uint word) {
    uint at = push.flames + cell * kBodyFlameWords + word;
    return uintBitsToFloat(uvec4(rays[at], rays[at + 1u], rays[at + 2u], rays[at + 3u]));
}

struct Sums {  // of a slab: see above
    float mass, first, second, own, gas, above, heights;
    vec2 draw;
};

void main() {
    uint node = gl_LocalInvocationIndex, tiles = push.pixels / (kMarchTileSide * kMarchTileSide);
    uint tile = rays[push.tiles + kMarchTileList * tiles + gl_WorkGroupID.x];
    if (node >= kBodyNodes) return;
    uint row = quotient22(tile, push.tilesX);
    vec2 place = vec2(push.originX, push.originY) - 0.5 +
                 vec2(tile - row * push.tilesX, row) * float(kMarchTileSide) +
                 4.0 * vec2(node % 3u, node / 3u);
    ViewRay ray = viewRay(push.rayO.xyz + place.x * push.rayX.xyz + place.y * push.rayY.xyz);
    vec3 up = view.up.xyz, o = ray.from, d = ray.direction;
    float du = dot(d, up), deep = push.rayY.w * float(push.turns), perSlab = 1.0 / deep;
    vec3 across = acrossAxis(), ahead = cross(across, up), dl = d - up * du, wind = flame.record.air.rgb;
    float apart = 4.0 * push.rayX.w * ray.perMetre;  // m between nodes, per m
    Sums sums[kVolumeSlabs];
    FW_UNROLL
    for (uint k = 0u; k < kVolumeSlabs; ++k)
        sums[k] = Sums(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, vec2(0.0));
    for (uint w = 0u; w < kBodyMaskWords; ++w) {
        uint mask = rays[push.tiles + (kMarchBodyMask + w) * tiles + tile];
        while (mask != 0u) {
            uint cell = w * 32u + uint(findLSB(mask));
            mask &= mask - 1u;
            vec4 footRadius = wordsAt(cell, 0u), normalHeight = wordsAt(cell, 4u);
            vec4 drawStrength = wordsAt(cell, 8u);
            float share = uintBitsToFloat(rays[push.flames + cell * kBodyFlameWords + 12u]);
            float r = footRadius.w, h = normalHeight.w;
            vec3 n = normalHeight.xyz, from = o - footRadius.xyz, flat_ = acrossUp(n);
            float flat2 = max(dot(flat_, flat_), 1e-6), perFlat = inversesqrt(flat2);
            // Where the ray passes the flame, roughly, then where it meets most gas.
            float s0 = dot(from, up);
            vec3 l0 = from - up * s0;
            float k = 0.2 * r * r / (h * h);
            float t = -(dot(l0, dl) + k * (s0 - 0.5 * h) * du) / (dot(dl, dl) + k * du * du);
            float s = clamp(s0 + t * du, 0.0, kBodyTop * h), y = s / h;
            // A film thinner than the nodes are apart would be steps.
            float least = 0.9 * apart * max(t, 0.0);
            float wide = max(r * (1.0 + kBodyWiden * y), least);
            float thick = clamp(r * min(0.22 + 1.3 * y, 1.0), min(least, wide), wide);
            vec3 l = l0 - wind * bodyLag(s, h) - drawStrength.xyz * bodyEase(y) -
                     flat_ * (0.5 * thick + 0.1 * s);
            float flatter = (wide / thick - 1.0) * perFlat;
            vec3 lm = l + flat_ * (dot(l, flat_) * flatter);
            vec3 dm = dl + flat_ * (dot(dl, flat_) * flatter);
            float dd = dot(dm, dm) + 1e-4;
            t = -(dot(lm, dm) + kBodyFoot * wide * wide * du / (2.0 * kBodyNarrow * h)) / dd;
            float slope = abs(du) > 1e-3 ? 1.0 / du : 1e3;
            vec2 ends = (vec2(-0.1 * r, kBodyTop * h) - s0) * slope;
            t = abs(du) > 1e-3 ? clamp(t, min(ends.x, ends.y), max(ends.x, ends.y)) : t;
            s = s0 + t * du + 0.1 * r;
            y = max(s, 0.0) / h;
            vec3 off = lm + t * dm;
            float u = drawStrength.w + kBodyFoot * (1.0 - y) -
                      kBodyNarrow * dot(off, off) / (wide * wide);
            float below = min(s, 0.0) / (0.35 * r);
            float behind = min(dot(from + d * t, n), 0.0) / (0.6 * r);
            u -= 4.0 * below * below + 6.0 * behind * behind * max(1.0 - 2.0 * y, 0.0);
            float gas = flameExp2(1.442695 * min(u, 8.0));
            float spread2 = 1.0 / (2.0 * kBodyNarrow * dd / (wide * wide) +
                                   kBodyFoot * kBodyFoot * du * du / (h * h));
            float mass = share * max(gas - kBodyCut, 0.0) * sqrt(spread2);
            // Means count by a smaller power of the gas: feet have most, and would hide what rises
            // past them.
            gas = share * sqrt(gas);
            vec2 draw = vec2(dot(drawStrength.xyz, across), dot(drawStrength.xyz, ahead));
            float depth = t / ray.perDepth - push.rayO.w;
            FW_UNROLL
            for (uint k = 0u; k < kVolumeSlabs; ++k) {
                float along = depth - deep * (float(k) + 0.5), away = abs(along) * perSlab;
                bool beyond = (k == 0u && along < 0.0) || (k + 1u == push.slabs && along > 0.0);
                float all = beyond ? 1.0 : 1.0 - smoothstep(1.0, 1.5, away);
                float m = all * mass, g = all * gas;
                sums[k].mass += m;
                sums[k].first += m * along;
                sums[k].second += m * (spread2 + along * along);
                sums[k].own += (beyond ? 1.0 : max(1.0 - away, 0.0)) * mass;
                sums[k].gas += g;
                sums[k].above += g * max(s, 0.0);
                sums[k].heights += g * y;
                sums[k].draw += g * draw;
            }
        }
    }
    uint at = push.flames + kBodyWords + (tile * push.slabs * kBodyNodes + node) * kBodyNodeWords;
    FW_UNROLL
    for (uint k = 0u; k < kVolumeSlabs; ++k) {
        float per = 1.0 / max(sums[k].mass, 1e-9), mean = sums[k].first * per;
        float spread = sqrt(max(sums[k].second * per - mean * mean, 1e-6));
        float u = log(max(sums[k].mass / spread, 0.0498)), perGas = 1.0 / max(sums[k].gas, 1e-6);
        if (k < push.slabs) {
            rays[at] = packHalf2x16(vec2(u, min(sums[k].own * per, 1.0)));
            rays[at + 1u] = packHalf2x16(vec2(mean, spread));
            rays[at + 2u] = packHalf2x16(vec2(sums[k].above, sums[k].heights) * perGas);
            rays[at + 3u] = packHalf2x16(sums[k].draw * perGas);
        }
        at += kBodyNodes * kBodyNodeWords;
    }
}
