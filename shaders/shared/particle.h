// Particles of fire emitters: what an emitter tells of a frame, how one of its particles is born,
// moves, ages from fire to smoke and is shown. Sparks are in spark.h. Looks alone. SI units,
// kelvin. GLSL too, and laid out by hand.
// clang-format off
#ifndef FW_SHARED_PARTICLE_H
#define FW_SHARED_PARTICLE_H
#include "shared/types.h"

#ifdef __cplusplus
#include <cmath>
#endif

FW_SHARED_BEGIN
#ifdef __cplusplus
using glm::clamp;
using glm::cross;
using glm::dot;
using std::floor;
using glm::length;
using glm::max;
using glm::min;
using glm::mix;
using glm::normalize;
using glm::smoothstep;
using std::cos;
using std::exp;
using std::sin;
using std::sqrt;
#endif

// An emitter's particles are a ring: the k-th that it ever spawns lies k mod `ring` after `first`,
// so nothing is allotted, listed or given back, and every device makes the same ones.
FW_SHARED_CONST uint kParticleGroup = 1024u;  // slots of a ring that a group of 64 threads works on
FW_SHARED_CONST uint kMaxEmitters = 256u;
FW_SHARED_CONST float kMostParticleStep = 0.0334f;  // s; longer frames take several
FW_SHARED_CONST uint kMostParticleSteps = 32u;

FW_SHARED_CONST float kEddyField = 4096.0f;  // m: of a world whose origin moves eddies go along, modulo this
FW_SHARED_CONST uint kNoBurnRow = 0xFFFFFFFFu;
FW_SHARED_CONST uint kTileTries = 32u;  // tiles that a birth looks at, at most, and
FW_SHARED_CONST uint kTileChoice = 6u;  // of its mesh among them, from which it chooses by power

// ParticleEmitter::flags
FW_SHARED_CONST uint kEmitterHidden = 1u;
FW_SHARED_CONST uint kEmitterGround = 2u;  // they come to rest on `carried.w`
FW_SHARED_CONST uint kEmitterJet = 4u;     // a stream of liquid that tears into flame
FW_SHARED_CONST uint kEmitterEmits = 8u;   // books show its fire, and none of them hides anything

struct ParticleEmitter {  // one frame of one emitter
    vec4 from;       // m, world: where it was at the last frame's end; w: s, of this frame
    vec4 place;      // m: where it is now; w: m, radius of its disc
    vec4 direction;  // unit; w: rad, sigma of its cone
    vec4 half_;      // m: from the middle of its line to an end; w: m/s, speed
    vec4 carried;    // m/s that particles get from its motion; w: m along up, the ground
    vec4 wind;       // m/s; w: s, cosmetic time
    vec4 up;         // unit; w: 1/s, how far birth speeds waver (pulses)
    vec4 motion;     // s drag as a stream, s drag when torn, m/s^2 up when torn, m/s^2 as a stream
    vec4 turbulence; // m/s, 1/m, m/s that eddies travel along `direction`, rad wander of a stream
    vec4 size;       // m width at birth, m per m of path, m per s, length over width at birth
    vec4 life;       // s, its variance, smoke's life in fire's, share that leave smoke
    vec4 heat;       // K at birth, K at the end, how thick smoke is, m along x that eddies moved
    uint first;      // particle
    uint ring;       // of them, at most
    uint head;       // of the next one that will be born, in the ring
    uint filled;     // born so far, at most `ring`
    uint fresh;      // of those, born in this frame, the newest ones
    uint serial;     // of the next one
    float age;       // s, of the newest at the frame's end
    float apart;     // s from one birth to the next
    uint seed;
    uint flags;
    uint steps;      // of this frame
    uint shieldCount;
    uint books;      // that show fire, and
    uint otherBooks; // smoke (two): bytes, book + 1; 0: there are no more
    uint object;     // slot + 1 of the burning mesh whose flaming tiles it is born on; 0: of none
    uint reserved0;
    vec4 waves0;     // rad, rad, share: how a stream swings and pulses, at the frame's start
    vec4 waves1;     // and at its end
    vec4 stuck;       // share of births that are of fuel that sticks somewhere; its places; m along y and z
                      // that eddies moved
    vec4 shields[64]; // m, world, and radius; unit normal: what stops a jet
    vec4 patches[32]; // m, world, and the share of it and all before; unit normal: where fuel sticks
};
FW_SHARED_SIZE(ParticleEmitter, 1840)

struct Particle {
    vec4 placeAge;   // m, world; s, < 0: rests no more
    vec4 speedPath;  // m/s; m it has come
    vec4 hit;        // unit normal of what it struck; s since then, < 0: nothing yet
};

struct ParticleWords {  // one as it is kept: each word is a load and a store of a frame
    vec4 placeAge;
    uint speed0;  // 21 bits a part, in 1/4096 m/s
    uint speed1;
    uint hit;     // octahedron 8 + 8 bits; 1/1024 s, kNoHit: nothing yet
    float path;   // where the emitter's particles grow with it
};
FW_SHARED_SIZE(ParticleWords, 32)
FW_SHARED_CONST uint kNoHit = 0xFFFFu;

struct ParticlePush {
    uint quads;      // that may be shown
    uint firstQuad;  // of them
    uint lights;     // that may be shown behind those, of what emits alone
    uint burnRow;    // counters row that says how many burning tiles there are; kNoBurnRow: none
    vec4 moved;      // m that all places moved since the last time: those that fly go along
};
FW_SHARED_SIZE(ParticlePush, 32)

FW_SHARED_FN float particleUnit(float x) { return clamp(x, 0.0f, 1.0f); }
FW_SHARED_FN uint particleBits(uint x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ (x >> 16);
}
FW_SHARED_FN float particleHash(uint x) {
    return float(particleBits(x) >> 8) * (1.0f / 16777216.0f);
}
// Sigma 1, at most 3.
FW_SHARED_FN float particleGauss(uint x) {
    uint a = particleBits(x), b = particleBits(x + 0x9e3779b9u);
    return (float(a & 0xFFFFu) + float(a >> 16) + float(b & 0xFFFFu) - 98302.5f) *
           (2.0f / 65535.0f);
}

FW_SHARED_FN uint particleSpeedBits(float v) {
    return uint(int(clamp(v, -255.0f, 255.0f) * 4096.0f + (v < 0.0f ? -0.5f : 0.5f))) & 0x1FFFFFu;
}
FW_SHARED_FN float particleSpeedOf(uint bits) {
    return float(int(bits << 11) >> 11) * (1.0f / 4096.0f);
}
FW_SHARED_FN uint particleHitBits(vec4 hit) {
    if (hit.w < 0.0f) return kNoHit << 16;
    vec3 n = vec3(hit.x, hit.y, hit.z);
    float sum = (n.x < 0.0f ? -n.x : n.x) + (n.y < 0.0f ? -n.y : n.y) + (n.z < 0.0f ? -n.z : n.z);
    n = n / max(sum, 1e-6f);
    float x = n.x, y = n.y;
    if (n.z < 0.0f) {  // the lower half is folded out
        x = (1.0f - (n.y < 0.0f ? -n.y : n.y)) * (n.x < 0.0f ? -1.0f : 1.0f);
        y = (1.0f - (n.x < 0.0f ? -n.x : n.x)) * (n.y < 0.0f ? -1.0f : 1.0f);
    }
    return uint(x * 127.0f + 127.5f) | uint(y * 127.0f + 127.5f) << 8 |
           uint(min(hit.w * 1024.0f + 0.5f, 65534.0f)) << 16;
}
FW_SHARED_FN vec4 particleHitOf(uint bits) {
    uint since = bits >> 16;
    float x = float(bits & 0xFFu) * (1.0f / 127.0f) - 1.0f;
    float y = float(bits >> 8 & 0xFFu) * (1.0f / 127.0f) - 1.0f;
    float u = x < 0.0f ? -x : x, v = y < 0.0f ? -y : y, z = 1.0f - u - v;
    float fold = max(-z, 0.0f);
    x += x < 0.0f ? fold : -fold;
    y += y < 0.0f ? fold : -fold;
    vec3 n = normalize(vec3(x, y, z));
    return since == kNoHit ? vec4(0.0f, 0.0f, 0.0f, -1.0f)
                           : vec4(n, float(since) * (1.0f / 1024.0f));
}
FW_SHARED_FN ParticleWords particlePacked(Particle p) {
    ParticleWords w;
    uint x = particleSpeedBits(p.speedPath.x), y = particleSpeedBits(p.speedPath.y);
    uint z = particleSpeedBits(p.speedPath.z);
    w.placeAge = p.placeAge;
    w.speed0 = x | y << 21;
    w.speed1 = y >> 11 | z << 10;
    w.hit = particleHitBits(p.hit);
    w.path = p.speedPath.w;
    return w;
}
FW_SHARED_FN Particle particleUnpacked(ParticleWords w) {
    Particle p;
    p.placeAge = w.placeAge;
    p.speedPath = vec4(particleSpeedOf(w.speed0 & 0x1FFFFFu),
                       particleSpeedOf((w.speed0 >> 21 | w.speed1 << 11) & 0x1FFFFFu),
                       particleSpeedOf(w.speed1 >> 10), w.path);
    p.hit = particleHitOf(w.hit);
    return p;
}

// How many births ago slot `i` of the ring got its particle: 0 the newest. None: >= filled.
FW_SHARED_FN uint particleBirths(uint head, uint ring, uint i) {
    return i < head ? head - 1u - i : head + ring - 1u - i;
}
FW_SHARED_FN uint particleSeed(uint seed, uint serial) {
    return particleBits(serial * 747796405u + seed * 2891336453u);
}

// Which of so many books in the bytes of a word, one behind the other: + 1; 0: there are none.
FW_SHARED_FN uint particleBook(uint bytes, uint most, uint seed) {
    uint count = 0u;
    for (uint i = 0u; i < most; ++i) count += (bytes >> (8u * i) & 0xFFu) != 0u ? 1u : 0u;
    uint one = count > 0u ? particleBits(seed + 31u) % count : 0u;
    return bytes >> (8u * one) & (count > 0u ? 0xFFu : 0u);
}

// What a particle is by its seed alone.
struct ParticleTraits {
    float life;     // s of fire
    float all;      // s, with its smoke
    float smoke;    // how thick its smoke is; 0: it leaves none
    float own;      // [0, 1)
    float other;    // [0, 1)
};
FW_SHARED_FN ParticleTraits particleTraits(ParticleEmitter e, uint seed) {
    ParticleTraits t;
    float f = particleHash(seed + 4u), f2 = f * f;
    // A few live long.
    t.life = e.life.x * (1.0f + e.life.y * (1.2f * f + 1.2f * f2 * f2 - 0.85f));
    t.own = particleHash(seed + 5u);
    t.other = particleHash(seed + 8u);
    float keep = e.life.w;
    t.smoke = particleUnit((keep - t.other) * 20.0f) * e.heat.z;
    t.all = t.smoke > 0.0f ? t.life * (1.0f + e.life.z) : t.life;
    return t;
}

FW_SHARED_FN vec3 particleAcross(vec3 d) {
    return normalize(cross(d, (d.y < 0.9f && d.y > -0.9f) ? vec3(0.0f, 1.0f, 0.0f)
                                                          : vec3(1.0f, 0.0f, 0.0f)));
}
// As it is at its birth, `age` s before the frame's end.
FW_SHARED_FN Particle particleBorn(ParticleEmitter e, uint seed, float age) {
    float back = e.from.w > 0.0f ? particleUnit(age / e.from.w) : 0.0f;
    vec3 d = vec3(e.direction.x, e.direction.y, e.direction.z);
    vec3 r = particleAcross(d), u = cross(r, d);
    vec4 waves = mix(e.waves1, e.waves0, back);
    float a = particleGauss(seed + 1u) * e.direction.w + waves.x;
    float b = particleGauss(seed + 2u) * e.direction.w + waves.y;
    float disc = e.place.w * sqrt(particleHash(seed + 6u));
    float turn = 6.2831853f * particleHash(seed + 7u);
    float along = 2.0f * particleHash(seed + 9u) - 1.0f;
    vec3 at = mix(vec3(e.place.x, e.place.y, e.place.z), vec3(e.from.x, e.from.y, e.from.z), back);
    at += (r * cos(turn) + u * sin(turn)) * disc + vec3(e.half_.x, e.half_.y, e.half_.z) * along;
    float pulse = 1.0f + waves.z + 0.08f * particleGauss(seed + 3u);
    vec3 v = normalize(d + r * a + u * b) * (e.half_.w * pulse);
    Particle p;
    p.placeAge = vec4(at, 0.0f);
    p.speedPath = vec4(v + vec3(e.carried.x, e.carried.y, e.carried.z), 0.0f);
    p.hit = vec4(0.0f, 0.0f, 0.0f, -1.0f);
    return p;
}

// Moves it to a flaming tile: anywhere on its `area` m^2 about `at`, off its surface at first.
FW_SHARED_FN Particle particleOnTile(ParticleEmitter e, Particle p, uint seed, vec3 at, vec3 n,
                                     float area) {
    vec3 r = particleAcross(n), u = cross(r, n);
    float turn = 6.2831853f * particleHash(seed + 41u);
    float away = 0.8f * sqrt(area * particleHash(seed + 42u));
    vec3 moved = at + (r * cos(turn) + u * sin(turn)) * away + n * (0.1f * e.size.x);
    vec3 v = n * (0.6f * e.half_.w);
    p.placeAge = p.placeAge + vec4(moved, 0.0f);
    p.speedPath = p.speedPath + vec4(v, 0.0f);
    return p;
}

FW_SHARED_FN bool particleSticks(ParticleEmitter e, uint seed) {
    return particleHash(seed + 61u) < e.stuck.x;
}
// Moves it to fuel that sticks at `at` on a surface with normal `n`: as a splash that has just been.
FW_SHARED_FN Particle particleOnPatch(ParticleEmitter e, Particle p, uint seed, vec3 at, vec3 n) {
    vec3 r = particleAcross(n), u = cross(r, n), up = vec3(e.up.x, e.up.y, e.up.z);
    float turn = 6.2831853f * particleHash(seed + 62u);
    float away = 0.25f * sqrt(particleHash(seed + 63u));
    p.placeAge = vec4(at + (r * cos(turn) + u * sin(turn)) * away + n * 0.08f, 0.2f * e.life.x);
    p.speedPath = vec4(n * 0.25f + (up - n * dot(up, n)) * 0.5f + r * (0.2f * particleGauss(seed + 64u)) +
                           up * (0.5f + 0.5f * particleHash(seed + 65u)),
                       0.9f);
    p.hit = vec4(n, 0.0f);
    return p;
}

// A sine to 0.1 %, of a few instructions where a software device has none.
FW_SHARED_FN float particleSine(float angle) {
    float x = angle * 0.15915494f;
    x -= floor(x + 0.5f);
    float y = x * (8.0f - 16.0f * (x < 0.0f ? -x : x));
    return y * (0.775f + 0.225f * (y < 0.0f ? -y : y));
}
// A field without divergence: waves along which nothing flows. About 1 in the mean square.
FW_SHARED_FN vec3 particleEddies(vec3 x) {
    vec3 v = vec3(-0.62f, 0.0f, 0.78f) * particleSine(1.31f * x.x + 2.4f * x.y + 1.04f * x.z);
    v += vec3(0.51f, 0.86f, 0.0f) * particleSine(-2.2f * x.x + 1.305f * x.y + 0.9f * x.z + 1.3f);
    v += vec3(0.0f, -0.55f, 0.835f) * particleSine(1.7f * x.x + 2.05f * x.y + 1.35f * x.z + 4.1f);
    v += vec3(0.8f, 0.0f, -0.6f) * particleSine(2.52f * x.x - 1.6f * x.y + 3.36f * x.z + 2.2f);
    v += vec3(-0.707f, 0.707f, 0.0f) * particleSine(3.1f * x.x + 3.1f * x.y - 2.7f * x.z + 5.0f);
    return v * 0.63f;
}

FW_SHARED_FN float particleSize(ParticleEmitter e, ParticleTraits t, float age, float path,
                                float own) {
    float a = age / t.life;
    float s = e.size.x + (e.size.y * path + e.size.z * age) *
                             mix(1.0f, 0.8f + 0.45f * own, particleUnit(a * 3.0f));
    return s * (1.0f + 0.5f * particleUnit((a - 1.0f) / 2.0f));
}

// `dt` later, at most kMostParticleStep; `now`: s, cosmetic.
FW_SHARED_FN Particle particleStep(ParticleEmitter e, ParticleTraits t, Particle p, float now,
                                   float dt) {
    float a = p.placeAge.w / t.life, torn = smoothstep(0.15f, 0.6f, a);
    vec3 up = vec3(e.up.x, e.up.y, e.up.z), v = vec3(p.speedPath.x, p.speedPath.y, p.speedPath.z);
    vec3 at = vec3(p.placeAge.x, p.placeAge.y, p.placeAge.z);
    vec3 wind = vec3(e.wind.x, e.wind.y, e.wind.z), n = vec3(p.hit.x, p.hit.y, p.hit.z);
    float tau = mix(e.motion.x, e.motion.y, torn) * (0.7f + 0.6f * t.own);
    tau = a > 1.0f ? 0.5f : tau;
    float lift = mix(e.motion.w, e.motion.z, torn) * (a > 1.0f ? 0.4f : 1.0f);
    vec3 push = up * lift;
    float struck = p.hit.w >= 0.0f ? 1.0f : 0.0f;
    // Along what it struck: pressed flat, drawn out, and rising as a wall lets it.
    float flat_ = dot(up, n) > 0.5f ? smoothstep(0.1f, 0.5f, p.hit.w) * 1.2f : 0.0f;
    vec3 along = (up - n * dot(up, n)) * (e.motion.z * 0.8f) + n * (e.motion.z * flat_);
    push = mix(push, along, struck);
    tau = mix(tau, 0.30f + 0.25f * t.own, struck);
    float keep = exp(-dt / max(tau, 0.02f));
    vec3 settled = wind + push * tau;
    vec3 next = settled + (v - settled) * keep;
    float amp = e.turbulence.x * smoothstep(0.08f, 0.7f, a) * (a > 1.0f ? 0.55f : 1.0f);
    vec3 d = vec3(e.direction.x, e.direction.y, e.direction.z);
    vec3 field = at - vec3(e.heat.w, e.stuck.z, e.stuck.w);
    vec3 c = particleEddies((field - d * (e.turbulence.z * now)) * e.turbulence.y);
    c -= n * (min(0.0f, dot(c, n)) * struck);
    next -= n * (min(0.0f, dot(next, n)) * struck);
    vec3 moved = ((v + next) * 0.5f + c * amp) * dt;
    p.placeAge = vec4(at + moved, p.placeAge.w + dt);
    p.speedPath = vec4(next, p.speedPath.w + length(moved));
    p.hit.w = p.hit.w >= 0.0f ? p.hit.w + dt : p.hit.w;
    return p;
}

FW_SHARED_CONST float kSplashOff = 0.35f;  // m that it is off what it struck, at most
// It met a surface at `c` with unit normal `n`: what went along it goes on, the rest turns into a
// sheet that prefers the way it came and up.
FW_SHARED_FN Particle particleSplash(ParticleEmitter e, ParticleTraits t, Particle p, uint seed,
                                     vec3 c, vec3 n, float size) {
    vec3 v = vec3(p.speedPath.x, p.speedPath.y, p.speedPath.z);
    vec3 up = vec3(e.up.x, e.up.y, e.up.z);
    float into = max(-dot(v, n), 0.0f);
    vec3 along = v + n * into;
    vec3 r = particleAcross(n), s = cross(r, n);
    float turn = 6.2831853f * particleHash(seed + 71u);
    vec3 side = r * cos(turn) + s * sin(turn) + (up - n * dot(up, n)) * 0.35f + along * 0.06f;
    side = side / max(length(side), 1e-4f);
    bool first = p.hit.w < 0.0f;
    float out_ = min(into * (0.25f + 0.65f * sqrt(t.other)) +
                     0.28f * length(along) * (0.3f + t.other), 4.5f);
    vec3 sheet = along * 0.75f + side * out_ + n * (into * (0.03f + 0.10f * t.own));
    v = first ? sheet : along + n * 0.2f;
    float off = min(0.30f * size, kSplashOff);
    float age = first ? clamp(p.placeAge.w, 0.22f * t.life, max(0.38f * t.life, 0.0f))
                      : p.placeAge.w;
    p.placeAge = vec4(c + n * off, p.placeAge.w > t.life ? p.placeAge.w : age);
    p.speedPath = vec4(v, p.speedPath.w + (first ? 0.5f : 0.0f));
    p.hit = vec4(n, first ? 0.0f : p.hit.w);
    return p;
}

// Where on its way of a step it meets a disc, [0, 1]; 2: nowhere.
FW_SHARED_FN float particleMeets(vec3 from, vec3 to, vec4 disc, vec3 n, float reach) {
    vec3 c = vec3(disc.x, disc.y, disc.z);
    float a = dot(from - c, n) - reach, b = dot(to - c, n) - reach;
    float f = a > 0.0f ? a / max(a - b, 1e-6f) : 0.0f;
    vec3 d = from + (to - from) * f - c;
    d -= n * dot(d, n);
    return b < 0.0f && a > b && a > -0.4f && dot(d, d) < disc.w * disc.w ? f : 2.0f;
}

// m that it is above the ground of its emitter.
FW_SHARED_FN float particleAbove(ParticleEmitter e, Particle p) {
    return dot(vec3(p.placeAge.x, p.placeAge.y, p.placeAge.z), vec3(e.up.x, e.up.y, e.up.z)) -
           e.carried.w;
}
FW_SHARED_FN bool particleLands(ParticleEmitter e, Particle p, float size, float above) {
    return (e.flags & kEmitterGround) != 0u && above < min(0.12f * size, 0.12f) &&
           dot(vec3(p.speedPath.x, p.speedPath.y, p.speedPath.z),
               vec3(e.up.x, e.up.y, e.up.z)) < 0.0f;
}
// m that it would be in the ground.
FW_SHARED_FN float particleSunk(ParticleEmitter e, float above) {
    return (e.flags & kEmitterGround) != 0u ? max(-above, 0.0f) : 0.0f;
}
// In a step from `from` it met one of its jet's shields (at `share` of the step, at `disc` with
// normal `n`) or, where share > 1, the ground.
FW_SHARED_FN Particle particleMet(ParticleEmitter e, ParticleTraits t, Particle p, uint seed,
                                  vec3 from, float share, vec4 disc, vec3 n, float size,
                                  float above) {
    vec3 up = vec3(e.up.x, e.up.y, e.up.z), at = vec3(p.placeAge.x, p.placeAge.y, p.placeAge.z);
    vec3 c = at - up * above, normal = up;
    if (share <= 1.0f) {
        vec3 d = from + (at - from) * share, middle = vec3(disc.x, disc.y, disc.z);
        c = d - n * dot(d - middle, n);
        normal = n;
    }
    return particleSplash(e, t, p, seed, c, normal, size);
}

// ---- how it is shown, over a = age in lives -------------------------------------------------------

FW_SHARED_FN float particleKelvin(ParticleEmitter e, float a, float own) {
    float root = 1.0f - smoothstep(0.0f, 0.30f, a);  // white hot, well mixed near the nozzle
    return mix(e.heat.x, e.heat.y, smoothstep(0.30f, 1.0f, a)) + 60.0f * root -
           120.0f * own * smoothstep(0.15f, 0.7f, a);
}
FW_SHARED_FN float particleFire(float a, float own) {
    return mix(0.45f, 1.0f, smoothstep(0.0f, 0.10f, a)) *
           (1.0f - smoothstep(0.62f + 0.18f * own, 0.98f, a));
}
FW_SHARED_FN float particleQuarter(float x) { return x * sqrt(sqrt(x)); }  // x^1.25
FW_SHARED_FN float particleSmoke(ParticleEmitter e, float a) {
    return smoothstep(0.65f, 1.05f, a) *
           particleQuarter(particleUnit((1.0f + e.life.z - a) / max(e.life.z, 0.01f)));
}
FW_SHARED_CONST float kPuffReach = 0.55f;  // of its particle's size, from its middle
// m that a puff keeps off the wall that its particle struck: what reached into it would end at a
// straight line. (The ground is one to be asked for its height.) It comes off as it begins to show.
FW_SHARED_FN float particleOffWall(Particle p, vec3 up, float size, float a) {
    float upright = dot(vec3(p.hit.x, p.hit.y, p.hit.z), up);
    float wall = p.hit.w >= 0.0f ? 1.0f - upright * upright : 0.0f;
    return wall * smoothstep(0.5f, 0.8f, a) * max(kPuffReach * size - kSplashOff * 0.5f, 0.0f);
}
// Length over width, and how far the quad follows the way it flies (1) or its own turn (0).
// `across`: m/s on the screen.
FW_SHARED_FN float particleStretch(ParticleEmitter e, float a, float across, float hit) {
    float k = particleUnit(across / max(e.half_.w, 0.1f));
    return hit >= 0.0f ? 1.0f + 0.7f * particleUnit(across / 5.0f) * exp(-hit * 3.0f)
                       : 1.0f + (e.size.w - 1.0f) * k * exp(-a * 5.5f);
}
FW_SHARED_FN float particleFollows(ParticleEmitter e, float a, float across, float hit) {
    float k = particleUnit(across / max(e.half_.w, 0.1f));
    return (hit >= 0.0f ? 1.0f - smoothstep(0.2f, 0.6f, hit)
                        : 1.0f - 0.85f * smoothstep(0.25f, 0.65f, a)) *
           smoothstep(0.02f, 0.12f, k);
}

FW_SHARED_END
#endif
