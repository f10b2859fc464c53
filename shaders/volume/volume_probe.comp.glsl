// Finds the visible parts of a volumetric flame before the march: rays a few march pixels apart,
// with a margin around what they meet. Lists the tiles to march, each with its range of samples.
#include "volume/flame.glsl"

layout(local_size_x = 64) in;
FW_READ_WRITE(VOLUME_RAYS) FW_READ_WRITE(VOLUME_WORK)
layout(set = 1, binding = 0) uniform sampler2DArray profiles;
layout(push_constant) uniform Push { MarchPush march; };

#include "lib/colour.glsl"
#include "volume/ray.glsl"

// Margin in rho and y for detail between two rays.
const float kNearly = 0.08;

void main() {
    FlameRecord f = flame.record;
    uint zero = gl_GlobalInvocationID.x >> 31u;
    addZero(f, zero);
    uint tilesY = march.pixels / (kMarchTileSide * kMarchTileSide * march.tilesX);
    uint blocksX = probeBlockCount(march.tilesX, march.apart);
    uint lane = gl_LocalInvocationIndex;
    uvec2 in_ =
        uvec2((lane & 3u) | ((lane >> 1u) & 4u), ((lane >> 2u) & 1u) | ((lane >> 4u) << 1u));
    uint row = quotient22(gl_WorkGroupID.x, blocksX);
    uvec2 probe = uvec2(gl_WorkGroupID.x - row * blocksX, row) * 8u + in_;
    vec2 place =
        vec2(march.originX, march.originY) + float(march.apart) * (vec2(probe) + 0.5) - 0.5;
    ViewRay ray = viewRay(march.rayO.xyz + place.x * march.rayX.xyz + place.y * march.rayY.xyz);
    vec3 from = ray.from, direction = ray.direction;
    float perDepth = ray.perDepth;

    vec4 spans = flameSpans(f, from, direction);
    RayTube tube = rayTube(f, spans, from, direction, march.intervals | zero);
    float stride = march.rayY.w * perDepth, first = march.rayO.w * perDepth;
    float most = float(march.turns * march.slabs);
    bool burns = spans.x < spans.y && tube.chord.first < tube.chord.last;
    vec2 ends = tube.chord.from + tube.chord.gap * vec2(tube.chord.first, tube.chord.last);
    float k = clamp(floor((ends.x - first) / stride), 0.0, most);
    float last = burns ? clamp(ceil((ends.y - first) / stride), 0.0, most) : 0.0;
    float pixel = march.rayX.w * ray.perMetre;
    float nearest = 1e9, farthest = -1.0;
    while (k < last) {
        float t = first + stride * (k + 0.5);
        FlamePlace at =
            flameAlong(tube.first, tube.delta, (t - tube.chord.from) / max(tube.chord.gap, 1e-9));
        FlameLookup lookup = flameLookup(f, at, max(0.35 * stride, pixel * t));
        // Here, and slightly closer to the axis and the base.
        vec2 scale = 1.0 / vec2(kProfileReach, 1.0), here = vec2(lookup.rho, lookup.y);
        vec2 low = 0.5 / vec2(float(kProfileWidth), float(kProfileHeight));
        vec3 there = vec3(clamp(here * scale, low, 1.0 - low), float(f.profile));
        vec2 seen = textureLod(profiles, there, 0.0).xy;
        there.xy = clamp((here - kNearly) * scale, low, 1.0 - low);
        seen = max(seen, textureLod(profiles, there, 0.0).xy);
        bool shows = (seen.y > lookup.erode - 0.02 && seen.y > 0.004) ||
                     (seen.x > 0.0 && f.blue > 0.0 && lookup.y < f.blueHeight + kNearly);
        shows = shows && k < last && lookup.y < 1.0 + kNearly &&
            lookup.rho < kProfileReach + kNearly;
        nearest = shows ? min(nearest, k) : nearest;
        farthest = shows ? k : farthest;
        k += 1.0;
    }
    // Smoke counts by its plume, without billows.
    bool smokes = false;
    if (f.smoke > 0.0) {
        k = 0.0;
        do {
            vec3 x = from + direction * mix(spans.z, spans.w, 0.125 * (k + 0.5));
            FlamePlace at = flamePlaceNear(tube.pieces, x);
            float y = at.s / f.high.w;
            float wide = flamePlumeWide(f, at.s);
            smokes = smokes || (spans.z < spans.w && y > 0.6 && y < f.smokeTop &&
                                dot(at.p, at.p) < 3.2 * wide * wide);
            k += 1.0;
        } while (k < 8.0);
    }

    uvec2 at = probe * march.apart;
    ivec2 quarters = 2 * ivec2(march.tilesX, tilesY);
    bool fire = farthest >= 0.0;
    uint end = 1u + (fire ? uint(min(farthest + 2.0, most)) : 0u);
    uint begin = fire ? uint(most - max(nearest - 1.0, 0.0)) : 0u;
    uint tiles = march.pixels / (kMarchTileSide * kMarchTileSide);
    if (all(lessThan(at, kMarchQuarterSide * uvec2(quarters))) && (fire || smokes)) {
        // Its own quarter tile and the eight around it.
        for (uint j = 0u; j < 9u; ++j) {
            ivec2 it = ivec2(at / kMarchQuarterSide) + ivec2(j % 3u, j / 3u) - 1;
            if (any(lessThan(it, ivec2(0))) || any(greaterThanEqual(it, quarters))) continue;
            uint t = uint(it.y / 2) * march.tilesX + uint(it.x / 2);
            uint quarter = marchQuarter(uint(it.x), uint(it.y));
            atomicMax(rays[march.tiles + (kMarchQuarterBegins + quarter) * tiles + t], begin);
            atomicMax(rays[march.tiles + (kMarchQuarterEnds + quarter) * tiles + t], end);
            if (atomicOr(rays[march.tiles + kMarchTileListed * tiles + t], 1u) == 0u) {
                uint place_ = atomicAdd(work[march.flame].groups, 1u);
                rays[march.tiles + kMarchTileList * tiles + place_] = t;
                atomicAdd(work[march.flame].vertices, 6u * march.slabs);
                work[march.flame].groupsY = work[march.flame].groupsZ = 1u;
                work[march.flame].instances = 1u;
            }
        }
    }
}
