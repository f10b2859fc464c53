// March of a volumetric flame's rays, one per march pixel of a few pixels, stored slab by slab: a
// slab's contribution does not depend on the scene, whose depth is known later per pixel and
// selects slabs. A workgroup is a tile listed by volume_probe. FW_SMOKE (volume_smoke): with smoke,
// which would cost a sixth of the march on devices that do not skip branches.
#include "volume/flame.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
FW_READ_WRITE(VOLUME_RAYS)
layout(set = 1, binding = 0) uniform sampler2DArray profiles;
layout(push_constant) uniform Push { MarchPush march; };

#include "lib/colour.glsl"
#include "volume/ray.glsl"

FlameRay fresh() { return FlameRay(vec3(0.0), vec3(1.0)); }
#include "volume/slab_write.glsl"

void main() {
    FlameRecord f = flame.record;
    uint zero = gl_GlobalInvocationID.x >> 31u;
    addZero(f, zero);
    uint tiles = march.pixels / (kMarchTileSide * kMarchTileSide);
    uint tile = listedTile();
    uint slabs = march.slabs | zero, turns = march.turns | zero;
    uint all = slabs * turns;
    // Lanes of a quarter, or half, of the tile run the same number of iterations.
    uint lane = gl_LocalInvocationIndex;
    uvec2 in_ = uvec2((lane & 3u) | ((lane >> 2u) & 4u), ((lane >> 2u) & 3u) | ((lane >> 3u) & 4u));
    uint quarter = marchQuarter(in_.x / kMarchQuarterSide, in_.y / kMarchQuarterSide);
    // Samples from `begin` to `end` along the view.
    uint begin = all - rays[march.tiles + (kMarchQuarterBegins + quarter) * tiles + tile];
    uint end = max(rays[march.tiles + (kMarchQuarterEnds + quarter) * tiles + tile], 1u) - 1u;
    bool burns = begin < end;
    begin = burns ? begin : all / 2u;
    end = burns ? end : begin + 1u;

    uint closer = burns ? sampleRefinement(end - begin, march.least) : 1u;
    // Finer samples start and end closer to the probe's range.
    begin = begin * closer + (begin > 0u ? closer / 2u : 0u);
    end = end * closer - (end < all ? closer / 2u : 0u);
    all *= closer;
    turns *= closer;

    uint row = quotient22(tile, march.tilesX);
    uvec2 place = uvec2(tile - row * march.tilesX, row) * kMarchTileSide + in_;
    uint pixel = place.y * (march.tilesX * kMarchTileSide) + place.x;
    place += uvec2(march.originX, march.originY);
    vec2 at_ = vec2(place) + (march.perPixel > 1u ? marchRayShift(place.x, place.y) : vec2(0.0));
    ViewRay ray = viewRay(march.rayO.xyz + at_.x * march.rayX.xyz + at_.y * march.rayY.xyz);
    vec3 from = ray.from, direction = ray.direction;
    float perDepth = ray.perDepth;
    vec3 white = flameWhite(f, view.sunColor.w);
    f.air.rgb = flameAir(view.ambientSky.rgb, view.ambientGround.rgb, white);
    float phase = marchSamplePhase(place.x, place.y);
    float footprint = march.rayX.w * ray.perMetre;
    float stride = march.rayY.w * perDepth, first = march.rayO.w * perDepth;
    float size = 0.35 * stride;  // equal for all, or a change of the spacing would show
    stride /= float(closer);
    // As many knots per metre as over the whole flame.
    uint intervals =
        min(quotient22(march.intervals * (end - begin), all) + 2u, march.intervals | zero);
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
    uint encoding = march.encoding | zero, last = quotient22(end - 1u, turns), bits = 0u;
    FlameRay one = smoke.front;
    vec3 scattered = one.radiance;
    vec4 before = vec4(0.0);
    uint s = quotient22(begin, turns), k = begin;
    if (s > 0u) {
        before = flameShown(one, scattered, lit, encoding);
        for (uint i = 1u; i < s; ++i) nothing(i, pixel, 1.0 - before.a);
        bits =
            shows(keep(vec4(0.0), before, 0u, pixel, vec3(1.0, 0.5, 0.25 + 1.0 / 12.0))) ? 1u : 0u;
    }
    float length_ = burns ? stride : 0.0;
    // Every loop has the same length for all lanes of a quarter: divergent loops are slow on a
    // software device.
    do {
        uint to = min((s + 1u) * turns, end);
        vec3 where_ = vec3(0.0);
        do {
            float t = first + stride * (float(k) + phase);
            FlameMedium m = rayMedium(f, tube, t, max(size, footprint * t));
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
        bits |= shows(keep(before, shown, s, pixel, where_)) ? 1u << s : 0u;
        before = shown;
        s += 1u;
    } while (s <= last);
    if (s < slabs) {
        for (uint i = s; i + 1u < slabs; ++i) nothing(i, pixel, 1.0 - before.a);
        scattered += one.through * smoke.back.radiance;
        vec4 shown = flameShown(flameBehind(one, smoke.back), scattered, lit, encoding);
        bits |= shows(keep(before, shown, slabs - 1u, pixel, vec3(1.0, 0.5, 0.25 + 1.0 / 12.0)))
                    ? 1u << (slabs - 1u) : 0u;
    }

    markTile(tile, in_, bits);
}
