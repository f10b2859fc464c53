// Sparks and embers of fire emitters. Each is a function of the clock, its number and its source's
// record. Nothing is stored per spark, so any moment can be shown without those before it.
// Cosmetic. SI units, kelvin.
// clang-format off
#ifndef FW_SHARED_SPARK_H
#define FW_SHARED_SPARK_H
#include "shared/particle.h"

FW_SHARED_BEGIN

// A slot emits one spark after another, each within a cycle of this length.
FW_CONST float kSparkTurn = 2.5f;     // s
FW_CONST uint kSparkKeys = 12u;       // of a source's path: one cycle, and the running step
FW_CONST float kSparkKeyStep = 0.25f; // s
FW_CONST uint kMaxSparks = 2048u;    // slots of a source
FW_CONST uint kTileSparks = 8u;       // slots of a burning tile
FW_CONST uint kMaxTileSparks = 1024u; // quads of all burning tiles of a source
FW_CONST uint kSparkGroups = 4u;      // of 64 threads, per source
FW_CONST uint kSparkLegs = 3u;        // a flight and two bounces
FW_CONST uint kSparkAppearances = 8u;       // collision samples per leg
FW_CONST uint kSparkHalvings = 8u;    // bisections of a hit
FW_CONST float kSparkShutter = 0.02f; // s of motion shown as a streak
FW_CONST float kSparkClear = 0.005f;  // m: least distance to surfaces
// M that a spark may be inside a wall between two samples.
FW_CONST float kSparkBehind = 6.0f;
FW_CONST float kSparkPlume = 1.7f;    // in drag times: how long the plume lifts a spark

// SparkSource::flags
FW_CONST uint kSparkGround = 1u;
FW_CONST uint kSparkWall = 2u;

struct SparkSource {  // one frame of an emitter
    vec4 keys[12];    // m, world: past positions, now first, then at the clock's steps; w: sparks a
                    // second at that time; of burning tiles, per kW
    vec4 direction;   // unit; w: rad, sigma of its cone
    vec4 half_;       // m: from the middle of its line to an end; w: m/s
    vec4 up;          // unit; w: m along up, the ground
    vec4 wind;        // m/s; w: m/s up in its plume
    vec4 wall;        // m, world: a disc that stops sparks, and its radius
    vec4 wallNormal;  // unit; w: share of its motion that sparks inherit
    float radius;     // m, of its disc
    float part;       // of the running cycle, [0, 1)
    float keyAge;     // s since keys[1]
    float kelvin;     // of a spark at birth
    uint turn;
    uint seed;
    uint slots;
    uint flags;
    uint flipbook;   // + 1; 0: none
    uint object;      // slot + 1 of the burning mesh whose tiles emit sparks; 0: the source itself
    uint reserved0; uint reserved1;
    vec4 grid;        // m: x and z where its cells begin, side of one; w: 1: has cells
    vec4 cells[64];   // m: heights of the host's field at the corners of each cell, rows along x:
                     // two at its z, two at the next
};
FW_SIZE(SparkSource, 1376)
FW_CONST uint kSparkSourceQuads = 86u;  // size of SparkSource in quads
FW_CONST uint kSparkCellQuad = 22u;     // quad where its cells begin
FW_CONST uint kSparkCells = 8u;         // of a row
FW_CONST float kSparkCellSide = 1.0f;   // m

struct SparkPush {
    uint quads;      // visible, at most; all emissive (kFlameEmissiveQuads)
    uint firstQuad;  // first of them
    uint burnRow;    // as ParticlePush
    uint reserved;
};
FW_SIZE(SparkPush, 16)

struct SparkSlot {  // current spark of a slot
    uint seed;
    float age;      // s
};
FW_FN SparkSlot sparkSlot(uint seed, uint slot, uint turn, float part) {
    uint own = particleSeed(seed, slot);
    float x = part + hashUnit(own);
    SparkSlot s;
    s.age = (x >= 1.0f ? x - 1.0f : x) * kSparkTurn;
    s.seed = hash32(own + (turn + (x >= 1.0f ? 1u : 0u)) * 2654435761u);
    return s;
}
// Chance that a slot has a spark now, > 0: it has. The first slots always have one, up to the
// rate's integral part; the next has the remaining probability: the mean is exactly the rate.
FW_FN float sparkChance(float rate, uint slot, uint seed) {
    return rate * kSparkTurn - float(slot) - hashUnit(seed + 1u);
}
// Position in the keys `age` s ago: integral part and fraction.
FW_FN float sparkKey(float keyAge, float age) {
    return min(age < keyAge ? age / max(keyAge, 1e-4f) : 1.0f + (age - keyAge) / kSparkKeyStep,
               float(kSparkKeys) - 1.001f);
}

struct SparkKind {  // follows from the seed alone
    float life;     // s
    float width;    // m
    float tau;      // s of drag
    float fall;     // m/s^2 down; < 0: rises
    float ember;    // 1: a glowing flake, slow and long-lived
};
FW_FN SparkKind sparkKind(uint seed) {
    SparkKind s;
    float own = hashUnit(seed + 2u), other = hashUnit(seed + 3u);
    s.ember = hashUnit(seed + 4u) < 0.25f ? 1.0f : 0.0f;
    s.life = mix(0.5f + 1.1f * own * own, 1.3f + 1.15f * own, s.ember);
    s.width = mix(0.004f + 0.004f * other, 0.007f + 0.006f * other, s.ember);
    s.tau = 0.35f + 0.6f * own;
    s.fall = mix(5.0f * other - 1.2f, 2.0f + 4.0f * other, s.ember);
    return s;
}

struct SparkLeg {  // flight from one collision to the next
    vec3 from;     // m
    vec3 speed;    // m/s
    vec3 settled;  // m/s: terminal velocity
    float plume;   // m/s up that the plume still gives
    float began;   // s of its age
    float ends;
};
// Position `t` s into the leg. Drag is linear and the plume decays: both are exponentials.
FW_FN vec3 sparkArc(SparkLeg leg, vec3 up, float tau, float t) {
    float slow = tau * kSparkPlume;
    vec3 carried = up * (leg.plume / (1.0f - 1.0f / kSparkPlume));
    return leg.from + leg.settled * t +
           (leg.speed - leg.settled - carried) * (tau * (1.0f - exp(-t / tau))) +
           carried * (slow * (1.0f - exp(-t / slow)));
}
FW_FN vec3 sparkArcSpeed(SparkLeg leg, vec3 up, float tau, float t) {
    vec3 carried = up * (leg.plume / (1.0f - 1.0f / kSparkPlume));
    return leg.settled + (leg.speed - leg.settled - carried) * exp(-t / tau) +
           carried * exp(-t / (tau * kSparkPlume));
}

// Collision geometry of a source.
struct SparkBounds {
    vec4 ground;  // unit normal, m along it
    vec4 wall;    // m, middle of the disc, and its radius; 0: none
    vec3 normal;
    vec4 grid;    // as the source's
#ifdef __cplusplus
    const vec4* cells = nullptr;
#else
    uint source;
#endif
};
#ifdef __cplusplus
FW_FN vec4 sparkCell(SparkBounds b, uint i) { return b.cells ? b.cells[i] : vec4(0.0f); }
#else
vec4 sparkCell(SparkBounds b, uint i);  // defined by the includer
#endif
// Nearest ground, plane or height field: unit normal; w: m above it.
FW_FN vec4 sparkGround(SparkBounds b, vec3 p) {
    float above = dot(p, vec3(b.ground)) - b.ground.w;
    float side = max(b.grid.z, 1e-3f), most = float(kSparkCells) - 1e-3f;
    float x = clamp((p.x - b.grid.x) / side, 0.0f, most),
          z = clamp((p.z - b.grid.y) / side, 0.0f, most);
    vec4 cell = sparkCell(b, uint(z) * kSparkCells + uint(x));
    x -= floor(x);
    z -= floor(z);
    float here = mix(cell.x, cell.y, x), next = mix(cell.z, cell.w, x);
    vec3 n = normalize(vec3(mix(cell.x - cell.y, cell.z - cell.w, z), side, here - next));
    float over = (p.y - mix(here, next, z)) * n.y;
    return b.grid.w > 0.5f && over < above ? vec4(n, over)
                                           : vec4(b.ground.x, b.ground.y, b.ground.z, above);
}
FW_FN float sparkBefore(SparkBounds b, vec3 p) {
    vec3 d = p - vec3(b.wall);
    float before = dot(d, b.normal);
    vec3 aside = d - b.normal * before;
    // Far behind the disc: it took another path.
    return dot(aside, aside) < b.wall.w * b.wall.w && before > -kSparkBehind ? before : 1e9f;
}
FW_FN float sparkClearance(SparkBounds b, vec3 p) {
    return min(sparkGround(b, p).w, sparkBefore(b, p));
}

// s into the leg until a collision; `most`: none. Sampled at the same places for any moment shown,
// so a bounce stays in place; densely at first, while it is fast.
FW_FN float sparkMeets(SparkLeg leg, SparkBounds b, vec3 up, float tau, float most) {
    float low = most, high = most;
    bool met = false;
    for (uint i = 0u; i < kSparkAppearances; ++i) {
        float before = float(i) / float(kSparkAppearances);
        float t = float(i + 1u) / float(kSparkAppearances);
        before *= before * most;
        t *= t * most;
        bool meets = !met && sparkClearance(b, sparkArc(leg, up, tau, t)) < kSparkClear;
        low = meets ? before : low;
        high = meets ? t : high;
        met = met || meets;
    }
    for (uint i = 0u; i < kSparkHalvings; ++i) {
        float t = 0.5f * (low + high);
        bool inside = sparkClearance(b, sparkArc(leg, up, tau, t)) < kSparkClear;
        low = inside ? low : t;
        high = inside ? t : high;
    }
    return met ? min(low, most * 0.9999f) : most;
}

// Leg of the flight at `age`. After its last collision a spark lies still.
FW_FN SparkLeg sparkLeg(SparkKind kind, SparkLeg born, SparkBounds b, vec3 up, float age) {
    SparkLeg leg = born;
    leg.ends = kind.life;
    for (uint i = 0u; i < kSparkLegs; ++i) {
        float left = kind.life - leg.began;
        float met = sparkMeets(leg, b, up, kind.tau, left);
        bool on = met < left && age >= leg.began + met;
        vec3 at = sparkArc(leg, up, kind.tau, met), v = sparkArcSpeed(leg, up, kind.tau, met);
        vec4 ground = sparkGround(b, at);
        vec3 n = sparkBefore(b, at) < ground.w ? b.normal : vec3(ground);
        float into = min(dot(v, n), 0.0f);
        vec3 bounced = (v - n * into) * 0.55f - n * (into * 0.38f);
        bool rests = i + 1u == kSparkLegs || -into < 0.4f;
        if (on) {
            leg.from = at;
            leg.began = leg.began + met;
            leg.plume = 0.0f;
            leg.speed = rests ? vec3(0.0f) : bounced;
            if (rests) leg.settled = vec3(0.0f);
        } else {
            leg.ends = min(leg.ends, leg.began + met);
        }
    }
    return leg;
}

// Position at `age`, m, within its leg. Eddies shake it without pushing it into surfaces.
FW_FN vec3 sparkPlace(SparkLeg leg, SparkKind kind, SparkBounds b, vec3 up, uint seed, float age) {
    float t = clamp(age, leg.began, leg.ends) - leg.began;
    vec3 p = sparkArc(leg, up, kind.tau, t);
    float clear = sparkClearance(b, p), turns = 6.0f + 8.0f * hashUnit(seed + 5u);
    float first = 6.2831853f * hashUnit(seed + 6u), second = 6.2831853f * hashUnit(seed + 7u);
    float shaken = 0.09f * smoothstep(0.0f, 0.7f, age) * saturate((clear - kSparkClear) * 4.0f);
    vec3 across = particleAcross(up), aside = cross(across, up);
    p += (across * sin(turns * age + first) + aside * cos(0.83f * turns * age + second) +
          up * (0.6f * sin(1.31f * turns * age + second))) * shaken;
    // Removes the error of sampling and bisection.
    vec4 ground = sparkGround(b, p);
    return p + vec3(ground) * max(kSparkClear - ground.w, 0.0f);
}

// Leg at birth, at `at`, from a source that moves at `carried`.
FW_FN SparkLeg sparkBorn(SparkSource s, SparkKind kind, uint seed, vec3 at, vec3 direction,
                         vec3 carried) {
    vec3 up = vec3(s.up), wind = vec3(s.wind);
    vec3 r = particleAcross(direction), u = cross(r, direction);
    float a = particleGauss(seed + 8u) * s.direction.w,
          b = particleGauss(seed + 9u) * s.direction.w;
    vec3 thrown =
        vec3(particleGauss(seed + 10u), particleGauss(seed + 11u), particleGauss(seed + 12u));
    SparkLeg leg;
    leg.from = at;
    leg.speed =
        normalize(direction + r * a + u * b) * s.half_.w * (0.7f + 0.6f * hashUnit(seed + 13u)) +
        thrown * (0.22f * s.half_.w + 0.4f) + carried;
    leg.settled = wind - up * (kind.fall * kind.tau);
    leg.plume = s.wind.w * (0.5f + 0.7f * hashUnit(seed + 14u)) * mix(1.0f, 0.8f, kind.ember);
    leg.began = 0.0f;
    leg.ends = kind.life;
    return leg;
}
// Offset on the source from its middle, m.
FW_FN vec3 sparkOff(vec3 direction, float radius, vec3 half_, uint seed) {
    float disc = radius * sqrt(hashUnit(seed + 15u)), turn = 6.2831853f * hashUnit(seed + 16u);
    return particleDisc(direction, turn, disc) + half_ * (2.0f * hashUnit(seed + 17u) - 1.0f);
}

// K, and opacity, at `a` of its life.
FW_FN float sparkKelvin(float kelvin, SparkKind kind, uint seed, float a) {
    float gust = sin(19.0f * a * kind.life + 6.2831853f * hashUnit(seed + 18u));
    return mix(kelvin - 650.0f * a, kelvin - 330.0f - 480.0f * a + 60.0f * gust, kind.ember);
}
FW_FN float sparkFades(float a) { return 1.0f - smoothstep(0.6f, 1.0f, a); }

FW_SHARED_END
#endif
