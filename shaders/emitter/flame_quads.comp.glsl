// Burning tiles to flame and smoke quads. A quad is a function of its world tile, of time and of
// ignition ticks: nothing is stored, and nothing pops. Each of a tile's slots shows one short life
// after another, fixed by the state at its birth.
#include "lib/compute.glsl"
#include "lib/view.glsl"
#include "shared/particle.h"
FW_READ(OBJECTS) FW_READ(MATERIALS) FW_READ(TEXELS) FW_READ(NORMALS) FW_READ(STATE)
FW_READ(COUNTERS) FW_READ(TILE_STATE) FW_READ(BURN_TILES) FW_READ(APPEARANCES) FW_READ(CLUSTERS)
FW_READ(BODY_OF)
FW_READ_WRITE(DRAW_ARGS) FW_WRITE(FLAMES) FW_PUSH(StepPush)
#include "emitter/clusters.glsl"
#include "emitter/flipbooks.glsl"
#include "lib/tile.glsl"
#include "lib/turn.glsl"
#include "lib/skin.glsl"

const float kMinPixels = 20.0;  // of a flame's height
const float kMaxMerged = 1.6;    // height factor of merged flames
const float kMaxClear = 0.9;     // half widths, see clearance

// Offset towards the camera, in half widths, beyond that of every quad (flames.vert): a quad faces
// the camera and its wall does not, so one side would intersect the wall. Quads on walls facing
// away are offset behind them, or they would show through thin walls. Sheets need none.
vec3 clearance(BurnObject object, vec3 place, vec3 normal) {
    vec3 toEye = view.forward.w > 0.5 ? normalize(view.eye.xyz - place) : -view.forward.xyz;
    float facing = dot(normal, toEye);
    if ((object.flags & kObjectTwoSided) != 0u) return vec3(0.0);
    float slant = sqrt(max(1.0 - facing * facing, 0.0)) / max(abs(facing), 0.2);
    float before = clamp(slant - 0.15, kQuadNearer, kMaxClear);
    return toEye * (mix(-before, before, smoothstep(-0.3, 0.0, facing)) - kQuadNearer);
}

void emit(FlameQuad quad) {
    uint slot = atomicAdd(drawArgs[kFlameTileQuads], 1u);
    if (slot < min(view.flameCapacity, kFlameCapacity)) flameQuad[slot] = quad;
}

struct Foot {
    uint texel, material;
    float age;   // ticks at birth
    float left;  // ticks of flame it has left now
    bool found;
};

// A texel of the tile that flamed at a birth `ago` ticks back: the youngest of the first few found,
// so that fire stands along the front. Later ignitions do not change the choice.
Foot footOf(BurnTile tile, uint seed, float ago) {
    BurnObject object = objects[tile.object];
    uint corner = texelOf(tile.object, tile.tile, 0u);
    Foot foot;
    foot.found = false;
    foot.age = 1e30;
    uint met = 0u, start = seed & 63u, stride = (seed >> 6u & 63u) | 1u;
    for (uint i = 0u; i < 64u && met < 4u; ++i) {
        uint lane = start + i * stride & 63u;
        uint texel = corner + (lane >> 3u) * object.width + (lane & 7u);
        uint t = state[object.stateBase + texel];
        if (!isSource(t) || t > view.now) continue;
        float age = float(view.now - t) + view.ambientGround.w;
        if (age < ago) continue;  // it caught later
        uint material =
            tile.object * kMaterialsPerObject + (texels[object.texelBase + texel].y >> 16u & 7u);
        float lasts = flameLasts(materials[material], object.flags);
        if (age >= lasts || age - ago >= 0.8 * lasts) continue;
        ++met;
        if (age - ago < foot.age) {
            foot.found = true;
            foot.age = age - ago;
            foot.left = (lasts - age) / min(0.3 * lasts, 1400.0);
            foot.texel = texel;
            foot.material = material;
        }
    }
    return foot;
}

void main() {
    uint count = counters[kRowBurn + push.burnParity].runCount;
    float share = min(1.0, float(view.flameCapacity) * 12.0 / float(max(clusters[0], 1u)));
    float time = view.ambientSky.w;
    vec3 up = view.up.xyz;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * 64u) {
        BurnTile tile = burnTiles[i];
        if (!burnTileAlive(tile.object, tile.tile)) continue;
        vec3 wind = view.wind.xyz + 0.001 * vec3(unpackWind(objects[tile.object].zoneWind));
        vec3 drift = wind - up * dot(wind, up);
        uint seed = hash32(hash32(tile.object * 7919u + view.seed) ^ tile.tile);
        // Jittered cluster lookups hide their borders in the heights.
        vec3 jitter = vec3(hashUnit(seed), hashUnit(seed + 1u), hashUnit(seed + 2u)) - 0.5;
        float side = lightClusterSide(tile.object), large = flameClusterSide(tile.object);
        vec3 beside = lightPlaceOf(tile, side) + 0.8 * jitter * side;
        vec3 above = flamePlaceOf(tile, large) + 0.8 * jitter * large;
        float fade = flameFade(tile);
        vec2 own = vec2(tile.normalPower.w, tile.positionArea.w) * fade;
        vec2 near = max(clusterFire(clusterKey(ivec3(floor(beside / side)), side)), own);
        vec2 around = max(clusterFire(clusterKey(ivec3(floor(above / large)), large)), near);
        float likely = flameLength(near, around);
        // Merges flames below kMinPixels: fewer and larger.
        vec3 toTile = tile.positionArea.xyz - view.eye.xyz;
        float pixel =
            view.eye.w * (view.forward.w > 0.5 ? max(dot(toTile, view.forward.xyz), 0.0) : 1.0);
        likely *= clamp(kMinPixels * pixel / max(likely, 1e-3), 1.0, kMaxMerged);
        float young = flameFade(materials[tile.object * kMaterialsPerObject], float(tile.age), 0.2);
        float quads =
            flameQuads(tile.positionArea.w * young, flameHalfWidth(likely, own.y)) * share;
        // A front thinner than its flames still has a row of them.
        quads *= clamp(0.7 * likely * side / near.y, 1.0, 4.0);
        // A falling tile has no flames.
        uint worldTile = objects[tile.object].worldTileBase + tile.tile;
        if ((tileState[worldTile].flag & kTileFalling) != 0u) quads = 0.0;
        // Lifetimes are independent of the fire, so that changes do not shake all quads.
        float scale = sqrt(clamp(6.0 * tileSide(tile.object), 0.05, 3.0));

        bool ofBody = bodyOf[tile.object] != 0u;
        for (uint k = 0u; k < 4u; ++k) {
            bool smoke = k == 3u;
            MaterialAppearance mainAppearance =
                appearances[materials[tile.object * kMaterialsPerObject].appearance];
            float odds = smoke ? min(0.10 * quads * mainAppearance.smoke, 0.5) :
                min(quads / 3.0, 1.0);
            if (ofBody && !smoke && (push.switches & kSwitchBodies) != 0u) continue;
            odds *= view.quads.x;  // a tile may request more quads than it has slots
            uint s = hash32(seed + (k + 1u) * 0x9e3779b9u);
            float period =
                (smoke ? 0.7 + 1.4 * scale : 0.32 + 0.5 * scale) * (0.8 + 0.4 * hashUnit(s));
            float life = time / period + hashUnit(s + 1u) * 16.0;
            float generation = floor(life), a = life - generation;
            uint g = hash32(s + uint(generation) * 2654435761u);
            float chance = odds - hashUnit(g + 4u);
            if (chance <= 0.0) continue;
            Foot foot = footOf(tile, hash32(g + 5u), a * period * 4096.0);
            if (!foot.found) continue;
            float vigour = flameFade(materials[foot.material], foot.age, 0.2);
            // Young texels first: a line of fire with embers behind it.
            float strength = smoothstep(0.0, 0.4 * odds, chance) * saturate(1.8 * (vigour - 0.07)) *
                             smoothstep(0.0, 1.0, foot.left);
            if (strength < 0.02) continue;
            BurnObject object = objects[tile.object];
            MaterialAppearance appearance = appearances[materials[foot.material].appearance];
            vec3 rest = restOf(tile.object, texels[object.texelBase + foot.texel]);
            vec3 n = vec3(decodeNormal(normals[object.texelBase + foot.texel]));
            moveWithSkin(tile.object, foot.texel, rest, n);
            vec3 place = inWorld(tile.object, rest);
            vec3 normal = normalize(turnNormal(object.worldRow0.xyz, object.worldRow1.xyz,
                                               object.worldRow2.xyz, n) + up * 1e-4);
            vec3 right = particleAcross(normal + up * 1e-4), ahead = cross(normal, right);
            float r1 = hashUnit(g), r2 = hashUnit(g + 1u), r3 = hashUnit(g + 2u),
                  r4 = hashUnit(g + 3u);
            float len = 0.85 * likely * (appearance.flame > 0.0 ? appearance.flame : 1.0);
            FlameQuad quad;
            float rise = 1.0 + 2.5 * sqrt(len);  // m/s
            if (!smoke) {
                float grown = 0.4 + 0.6 * smoothstep(0.0, 0.45, a);
                float tall = len * (0.55 + 0.75 * r3 * r3) * grown * (0.35 + 0.65 * strength);
                vec3 axis = normalize(up * rise + drift + normal * (0.16 * rise) +
                                      (right * (r4 - 0.5) + ahead * (r1 - 0.5)) * (0.35 * rise));
                // Tongues overlap kFlameCover times: fewer of them leave gaps smaller than their
                // share.
                float halfWidth = flameHalfWidth(len, own.y) * sqrt(view.quads.y) *
                                  (0.8 + 0.5 * r2) * (0.5 + 0.5 * strength);
                float loose = smoothstep(0.55, 1.0, a);
                vec3 stands = normal * 0.15 + clearance(object, place, normal);
                quad.baseHeight = vec4(place + stands * halfWidth - axis * (0.06 * tall) +
                                           axis * (0.10 * tall * loose * loose), tall);
                quad.axisWidth = vec4(axis, halfWidth * (1.0 - 0.35 * loose));
                quad.opacity = saturate(1.6 * strength) * smoothstep(0.0, 0.22, a) *
                               (1.0 - smoothstep(0.62, 1.0, a));
                quad.phase = a * period * rise * 0.5 / max(len, 0.05) + 7.0 * r4;
                quad.kelvin = 1570.0 + 90.0 * r3;
            } else {
                float age = a * period;
                float size = (0.30 + 0.55 * a + 0.15 * r3) * len + 0.04;
                vec3 at = place + up * (len * (0.75 + 0.2 * r4) + 0.55 * rise * age) +
                          drift * (0.75 * age) + right * ((r2 - 0.5) * 0.5 * len * a);
                quad.baseHeight = vec4(at - up * size, 2.0 * size);
                quad.axisWidth = vec4(up, size);
                quad.opacity = strength * 0.42 * min(appearance.smoke, 1.6) *
                               smoothstep(0.0, 0.30, a) *
                               (1.0 - smoothstep(0.35, 1.0, a));
                quad.phase = 0.10 * age + 5.0 * r4;
                // Lit by the fire below from birth.
                quad.kelvin = 1.0 - a;
            }
            quad.kind = (g & 0xFFFFu) << kQuadSeed | (smoke ? kQuadSmoke : kQuadTongue) |
                        (ofBody && !smoke ? kQuadOfBody : 0u);
            // The world's flipbooks of fire and smoke. A looping flame fills a part of its frame,
            // its foot at 1/20.
            uint flipbook = push.count >> (smoke ? 8u : 0u) & 0xFFu;
            if (showByFlipbook(quad, flipbook, a, a * period, r4) && !smoke) {
                quad.axisWidth.w *= 2.4;
                quad.baseHeight.xyz -= quad.axisWidth.xyz * (0.07 * quad.baseHeight.w);
                quad.baseHeight.w *= 1.45;
            }
            if (quad.opacity > 0.004) emit(quad);
        }
    }
}
