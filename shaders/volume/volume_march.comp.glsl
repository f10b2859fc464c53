#version 450
// A volumetric flame's rays in cells of a few pixels, each of them once and whole, and kept slab by
// slab: what a slab adds does not depend on the scene, so the scene's depth, which is known later
// and for each pixel, chooses among slabs. A workgroup is a tile that volume_probe listed.
// FW_SMOKE: volume_smoke, for flames that smoke. A device that does not skip branches would pay for
// a sixth of that march where none does.
#extension GL_GOOGLE_include_directive : require
#include "shared/burn.h"
#include "shared/look.h"
#include "shared/volume_flame.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = FW_BIND_VIEW, std140) uniform View { ViewParams view; };
layout(set = 0, binding = FW_BIND_VOLUMES, std140) uniform Volume { VolumeFlame flame; };
layout(set = 0, binding = FW_BIND_VOLUME_RAYS, std430) buffer Rays { uint rays[]; };
layout(set = 1, binding = 0) uniform sampler2DArray profiles;
layout(push_constant) uniform Push { VolumeMarch march; };

#define FW_FLAME_NODE(i) flame.nodes[i]
#include "lib/colour.glsl"
#include "volume/ray.glsl"

FlameRay fresh() { return FlameRay(vec3(0.0), vec3(1.0)); }

// Keeps what slab `s` adds to what is shown without it and those behind it; `where`: light, and
// its first and second moment over the slab. What is shown of any number of nearest slabs is then
// exactly what one ray to there would show; and how much of them those before it let through, which
// is what a cell weighs beside its neighbours.
vec4 keep(vec4 before, vec4 shown, uint s, uint cell, vec3 where_) {
    float left = 1.0 / max(1.0 - before.a, 1e-4);
    vec4 color = max((shown - before) * left, 0.0);
    float middle = where_.y / max(where_.x, 1e-20);
    // As wide as something even with that spread.
    float half_ = sqrt(3.0 * max(where_.z / max(where_.x, 1e-20) - middle * middle, 1e-4));
    half_ = min(half_, min(middle, 1.0 - middle));  // in the slab, about the same middle
    vec2 reach = vec2(middle - half_, middle + half_);
    uint at = march.samples + kVolumeCellWords * (march.cells * s + cell);
    rays[at] = packHalf2x16(color.rg);
    rays[at + 1u] = packHalf2x16(color.ba);
    rays[at + 2u] = volumeLies(reach, 1.0 - before.a);
    return color;
}

void nothing(uint s, uint cell, float through) {
    uint at = march.samples + kVolumeCellWords * (march.cells * s + cell);
    rays[at] = rays[at + 1u] = 0u;
    rays[at + 2u] = volumeLies(vec2(0.0, 1.0), through);
}

bool shows(vec4 color) { return max(max(color.r, color.g), max(color.b, color.a)) > 1e-4; }

void main() {
    FlameRecord f = flame.record;
    // Zero. A software device compiles a shader anew, in milliseconds a dispatch, for each set of
    // constants that alone decide its branches.
    uint zero = gl_GlobalInvocationID.x >> 31u;
    f.octaves |= zero;
    f.tint.w += float(zero);
    f.smoke += float(zero);
    f.puff += float(zero);
    uint tiles = march.cells / (kVolumeTile * kVolumeTile);
    uint tile = rays[march.tiles + kVolumeList * tiles + gl_WorkGroupID.x];
    uint slabs = march.slabs | zero, turns = march.turns | zero;
    uint all = slabs * turns;
    // Those that go together are a quarter of the tile, or half of one: they turn as often.
    uint lane = gl_LocalInvocationIndex;
    uvec2 in_ = uvec2((lane & 3u) | ((lane >> 2u) & 4u), ((lane >> 2u) & 3u) | ((lane >> 3u) & 4u));
    uint quarter = volumeQuarter(in_.x / kVolumeQuarter, in_.y / kVolumeQuarter);
    // Of all samples along the view those from `begin` to `end`.
    uint begin = all - rays[march.tiles + (kVolumeBegins + quarter) * tiles + tile];
    uint end = max(rays[march.tiles + (kVolumeEnds + quarter) * tiles + tile], 1u) - 1u;
    bool burns = begin < end;
    begin = burns ? begin : all / 2u;
    end = burns ? end : begin + 1u;

    uint closer = burns ? volumeCloser(end - begin, march.least) : 1u;
    // Closer samples begin and end closer to what the probe has seen.
    begin = begin * closer + (begin > 0u ? closer / 2u : 0u);
    end = end * closer - (end < all ? closer / 2u : 0u);
    all *= closer;
    turns *= closer;

    uint row = volumeQuotient(tile, march.tilesX);
    uvec2 place = uvec2(tile - row * march.tilesX, row) * kVolumeTile + in_;
    uint cell = place.y * (march.tilesX * kVolumeTile) + place.x;
    place += uvec2(march.originX, march.originY);
    vec2 at_ = vec2(place) + (march.perPixel > 1u ? volumeShift(place.x, place.y) : vec2(0.0));
    vec3 ray = march.rayO.xyz + at_.x * march.rayX.xyz + at_.y * march.rayY.xyz;
    bool perspective = view.forward.w > 0.5;
    vec3 from = view.eye.xyz + (perspective ? vec3(0.0) : ray);
    vec3 along = perspective ? ray : view.forward.xyz;
    float perDepth = length(along);  // m along the ray per m along the view
    vec3 direction = along / perDepth;
    vec3 white = flameWhite(f, view.sunColor.w);
    f.air.rgb = flameAir(view.ambientSky.rgb, view.ambientGround.rgb, white);
    float phase = volumePhase(place.x, place.y);
    float pixel = march.rayX.w * (perspective ? 1.0 / perDepth : 0.0);
    float stride = march.rayY.w * perDepth, first = march.rayO.w * perDepth;
    float size = 0.35 * stride;  // of all alike, or it would be seen where they get closer
    stride /= float(closer);
    // The curve is looked up as often as it is over the whole of the flame.
    uint intervals = min(volumeQuotient(march.intervals * (end - begin), all) + 2u, march.intervals | zero);
    RayTube tube = rayTube(f, first + stride * vec4(float(begin), float(end), 0.0, 0.0), from,
                           direction, intervals);

    FlameSmokeRay smoke = FlameSmokeRay(fresh(), fresh());
#ifdef FW_SMOKE
    {
        FlameSun sun = raySun(direction, white);
        vec2 span = flameSpans(f, from, direction).zw;
        float step_ = max(span.y - span.x, 0.0) / float(kFlameSmokeSteps);
        float middle = first + 0.5 * stride * float(all);
        uint k = 0u, count = kFlameSmokeSteps | zero;
        do {
            float t = span.x + step_ * (float(k) + phase);
            vec3 x = from + direction * t;
            smoke = flameSmokeStep(f, smoke, flamePlaceNear(tube.pieces, x), x, sun, t > middle,
                                   span.x < span.y ? step_ : 0.0);
            k += 1u;
        } while (k < count);
    }
#endif

    vec3 lit = white * view.sunDirection.w;
    uint encoding = march.encoding | zero, last = volumeQuotient(end - 1u, turns), bits = 0u;
    FlameRay one = smoke.front;
    vec3 scattered = one.radiance;
    vec4 before = vec4(0.0);
    uint s = volumeQuotient(begin, turns), k = begin;
    if (s > 0u) {
        before = flameShown(one, scattered, lit, encoding);
        for (uint i = 1u; i < s; ++i) nothing(i, cell, 1.0 - before.a);
        bits = shows(keep(vec4(0.0), before, 0u, cell, vec3(1.0, 0.5, 0.25 + 1.0 / 12.0))) ? 1u : 0u;
    }
    float length_ = burns ? stride : 0.0;
    // Every loop turns as often for all of a quarter: those that end apart end late on a software device.
    do {
        uint to = min((s + 1u) * turns, end);
        vec3 where_ = vec3(0.0);
        do {
            float t = first + stride * (float(k) + phase);
            FlameMedium m = rayMedium(f, tube, t, max(size, pixel * t));
            float dark = one.through.g, bright = one.radiance.r;
            one = flameStep(one, m, vec3(0.0), length_);
            float w = dark - one.through.g + one.radiance.r - bright;
            float at = (float(k - s * turns) + phase) / float(turns);
            where_ += w * vec3(1.0, at, at * at + 1.0 / (12.0 * float(turns * turns)));
            k += 1u;
        } while (k < to);
        FlameRay now = one;
        vec3 grey = scattered;
        if (s + 1u == slabs) {
            grey += now.through * smoke.back.radiance;
            now = flameBehind(now, smoke.back);
        }
        vec4 shown = flameShown(now, grey, lit, encoding);
        bits |= shows(keep(before, shown, s, cell, where_)) ? 1u << s : 0u;
        before = shown;
        s += 1u;
    } while (s <= last);
    if (s < slabs) {
        for (uint i = s; i + 1u < slabs; ++i) nothing(i, cell, 1.0 - before.a);
        scattered += one.through * smoke.back.radiance;
        vec4 shown = flameShown(flameBehind(one, smoke.back), scattered, lit, encoding);
        bits |= shows(keep(before, shown, slabs - 1u, cell, vec3(1.0, 0.5, 0.25 + 1.0 / 12.0)))
                    ? 1u << (slabs - 1u) : 0u;
    }

    // In the tile; in its first and last column, first and last row.
    uint edges = (in_.x == 0u ? 1u : 0u) | (in_.x == kVolumeTile - 1u ? 2u : 0u) |
                 (in_.y == 0u ? 4u : 0u) | (in_.y == kVolumeTile - 1u ? 8u : 0u);
    if (bits != 0u) atomicOr(rays[march.tiles + tile], bits | (edges << kVolumeSlabs));
}
