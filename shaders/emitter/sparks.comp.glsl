// Sparks and embers of all sources to quads of the frame's view: from a source's slots, or from
// slots of burning tiles. No state is stored: see shared/spark.h.
#include "lib/compute.glsl"
#include "lib/view.glsl"
#include "shared/flipbook.h"
#include "shared/spark.h"
FW_READ(COUNTERS) FW_READ(BURN_TILES) FW_READ(SPARKS) FW_READ_WRITE(DRAW_ARGS) FW_WRITE(FLAMES)
FW_PUSH(SparkPush)

#ifdef FW_TEXELS
FW_TEXEL_BUFFER(SPARKS, readonly, sourcesIn)
vec4 sparkCell(SparkBounds b, uint i) {
    return uintBitsToFloat(
        imageLoad(sourcesIn, int(b.source * kSparkSourceQuads + kSparkCellQuad + i)));
}
#else
vec4 sparkCell(SparkBounds b, uint i) { return sources[b.source].cells[i]; }
#endif

const float kNearFade = 0.3;  // m before the camera

// Loads a source's data without its path and obstacles.
#define FW_LOAD(member) s.member = sources[i].member;
SparkSource sourceOf(uint i) {
    SparkSource s;
    FW_LOAD(direction) FW_LOAD(half_) FW_LOAD(up) FW_LOAD(wind) FW_LOAD(wallNormal.w)
    FW_LOAD(radius) FW_LOAD(part) FW_LOAD(keyAge) FW_LOAD(kelvin) FW_LOAD(turn) FW_LOAD(seed)
    FW_LOAD(slots) FW_LOAD(flags) FW_LOAD(flipbook) FW_LOAD(object)
    return s;
}
SparkBounds boundsOf(SparkSource s, uint i) {
    SparkBounds b;
    b.ground = vec4(s.up.xyz, (s.flags & kSparkGround) != 0u ? s.up.w : -1e9);
    b.wall = (s.flags & kSparkWall) != 0u ? sources[i].wall : vec4(0.0);
    b.normal = sources[i].wallNormal.xyz;
    b.grid = sources[i].grid;
    b.source = i;
    return b;
}

void show(SparkSource s, SparkBounds bounds, SparkSlot slot, vec3 at, vec3 direction, vec3 carried,
          float strength) {
    SparkKind kind = sparkKind(slot.seed);
    SparkLeg leg = sparkLeg(kind, sparkBorn(s, kind, slot.seed, at, direction, carried), bounds,
                            s.up.xyz, slot.age);
    vec3 place = sparkPlace(leg, kind, bounds, s.up.xyz, slot.seed, slot.age);
    vec3 before = sparkPlace(leg, kind, bounds, s.up.xyz, slot.seed, slot.age - kSparkShutter);
    float a = slot.age / kind.life;
    vec3 toEye = view.eye.xyz - place, streak = place - before;
    float far = view.forward.w > 0.5 ? dot(-toEye, view.forward.xyz) : 1e3;
    // A flipbook's streak fills a third of its frame.
    float wide = kind.width * (s.flipbook != 0u ? 3.0 : 1.0);
    float length_ = length(streak);
    FlameQuad quad;
    vec3 along = length_ > 1e-4 ? streak / length_ : view.up.xyz;
    float tall = length_ + 2.0 * wide;
    quad.axisWidth = vec4(along, wide);
    quad.baseHeight = vec4(place + along * (wide - tall), tall);
    quad.opacity = sparkFades(a) * strength * smoothstep(kNearFade, kNearFade + 0.8, far) *
                   shownShare(view.quads.x, float(slot.seed >> 8u) / 16777216.0);
    quad.phase = s.flipbook != 0u ? flipbookTime(false, 1.0, a, slot.age, 0.0) : min(a, 0.98);
    quad.kelvin = sparkKelvin(s.kelvin, kind, slot.seed, a);
    quad.kind = (slot.seed & 0xFFFFu) << kQuadSeed | s.flipbook << kQuadFlipbookShift | kQuadSpark;
    // Hides sparks that would be wide on the screen.
    if (a >= 1.0 || quad.opacity <= 0.004 || wide > 0.03 * far) return;
    uint first = atomicAdd(drawArgs[kFlameEmissiveQuads], 1u);
    if (first < push.quads) flameQuad[push.firstQuad + first] = quad;
}

void showOwn(SparkSource s, SparkBounds bounds, uint source, uint slot) {
    SparkSlot now = sparkSlot(s.seed, slot, s.turn, s.part);
    float at = sparkKey(s.keyAge, now.age);
    uint i = uint(at), moved = max(i, 1u);
    vec4 key = mix(sources[source].keys[i], sources[source].keys[i + 1u], at - float(i));
    if (sparkChance(key.w, slot, now.seed) <= 0.0) return;
    vec3 carried = (sources[source].keys[moved].xyz -
                    sources[source].keys[min(moved + 1u, kSparkKeys - 1u)].xyz) *
                   (s.wallNormal.w / kSparkKeyStep);
    show(s, bounds, now, key.xyz + sparkOff(s.direction.xyz, s.radius, s.half_.xyz, now.seed),
         s.direction.xyz, carried, 1.0);
}

// Uses the tile's current power: sparks fade in and out with it.
void showOfTile(SparkSource s, SparkBounds bounds, float rate, BurnTile tile) {
    uint seed = particleSeed(s.seed + tile.tile, tile.object);
    float mean = rate * tile.normalPower.w * 1e-3;
    uint slots = min(uint(ceil(mean * kSparkTurn)), kTileSparks);
    vec3 normal = normalize(tile.normalPower.xyz + s.up.xyz * 1e-3);
    for (uint k = 0u; k < slots; ++k) {
        SparkSlot now = sparkSlot(seed, k, s.turn, s.part);
        float chance = sparkChance(mean, k, now.seed);
        float fades = 0.2 * min(mean * kSparkTurn, 1.0);
        vec3 at = tile.positionArea.xyz + normal * 0.01 +
                  sparkOff(normal, 0.8 * sqrt(tile.positionArea.w), vec3(0.0), now.seed);
        if (chance > 0.0)
            show(s, bounds, now, at, normalize(normal * 0.6 + s.up.xyz), vec3(0.0),
                 clamp(chance / fades, 0.0, 1.0));
    }
}

void main() {
    uint source = gl_WorkGroupID.x / kSparkGroups;
    uint first = gl_WorkGroupID.x % kSparkGroups * 64u + gl_LocalInvocationID.x;
    SparkSource s = sourceOf(source);
    SparkBounds bounds = boundsOf(s, source);
    uint count = push.burnRow == kNoBurnRow ? 0u : counters[push.burnRow].runCount;
    if (s.object == 0u) {
        for (uint slot = first; slot < s.slots; slot += kSparkGroups * 64u)
            showOwn(s, bounds, source, slot);
    } else {
        for (uint i = first; i < count; i += kSparkGroups * 64u)
            if (burnTiles[i].object + 1u == s.object)
                showOfTile(s, bounds, sources[source].keys[0].w, burnTiles[i]);
    }
}
