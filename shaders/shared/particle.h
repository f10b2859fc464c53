// Particles of fire emitters: emitter record of a frame, birth, motion, ageing from fire to smoke,
// and display. Sparks are in spark.h. Cosmetic. SI units, kelvin.
// clang-format off
#ifndef FW_SHARED_PARTICLE_H
#define FW_SHARED_PARTICLE_H
#include "shared/types.h"


FW_SHARED_BEGIN

// An emitter's particles form a ring: the k-th spawned particle lies at k mod `ring` after `first`.
// Nothing is allocated or freed, and every device makes the same particles.
FW_CONST uint kParticleGroup = 1024u;  // ring slots that a group of 64 threads handles
FW_CONST uint kMaxEmitters = 256u;
FW_CONST float kMaxParticleStep = 0.0334f;  // s; longer frames take several steps
FW_CONST uint kMaxParticleSteps = 32u;

// m: when the world's origin shifts, eddies shift along, modulo this.
FW_CONST float kEddyField = 4096.0f;
FW_CONST uint kNoBurnRow = 0xFFFFFFFFu;
FW_CONST uint kTileTries = 32u;  // tiles that a birth samples, at most, and
FW_CONST uint kTileChoice = 6u;  // of its mesh among them, chosen by power

// ParticleEmitter::flags
FW_CONST uint kEmitterHidden = 1u;
FW_CONST uint kEmitterGround = 2u;  // particles land on `carried.w`
FW_CONST uint kEmitterJet = 4u;     // a stream of liquid that breaks up into flame
FW_CONST uint kEmitterEmits = 8u;   // flipbooks show its fire and hide nothing

struct ParticleEmitter {  // one emitter in one frame
    vec4 from;       // m, world: position at the last frame's end; w: s, length of this frame
    vec4 place;      // m: position now; w: m, radius of its disc
    vec4 direction;  // unit; w: rad, sigma of its cone
    vec4 half_;      // m: from the middle of its line to an end; w: m/s, speed
    vec4 carried;    // m/s that particles inherit from its motion; w: m along up, the ground
    vec4 wind;       // m/s; w: s, cosmetic time
    vec4 up;         // unit; w: 1/s, rate at which birth speeds pulse
    vec4 motion;     // s drag as a stream, s drag when torn, m/s^2 up when torn, m/s^2 as a stream
    vec4 turbulence; // m/s, 1/m, m/s that eddies travel along `direction`, rad wander of a stream
    vec4 size;       // m width at birth, m per m of path, m per s, length over width at birth
    vec4 life;       // s, its variance, smoke's life as a share of fire's, share that leaves smoke
    vec4 heat;  // K at birth, K at the end, density of smoke, m along x by which eddies shifted
    uint first;      // first particle
    uint ring;       // capacity
    uint head;       // ring slot of the next birth
    uint filled;     // births so far, at most `ring`
    uint fresh;      // births of this frame, the newest
    uint serial;     // serial number of the next birth
    float age;       // s, of the newest at the frame's end
    float apart;     // s between births
    uint seed;
    uint flags;
    uint steps;      // of this frame
    uint obstacleCount;
    uint fireFlipbooks;  // flipbooks of fire: one byte each, + 1; 0: end
    uint smokeFlipbooks; // flipbooks of smoke (two), the same
    uint object;     // slot + 1 of the burning mesh whose flaming tiles spawn it; 0: none
    uint reserved0;
    vec4 waves0;     // rad, rad, share: swing and pulse of a stream at the frame's start
    vec4 waves1;     // and at its end
    vec4 stuck;  // share of births from fuel that sticks to surfaces; number of patches; m along y
                 // and z by which eddies shifted
    vec4 obstacles[64]; // m, world, and radius; unit normal: obstacles of a jet
    vec4 patches[32]; // m, world, and cumulative share; unit normal: where fuel sticks
};
FW_SIZE(ParticleEmitter, 1840)

struct Particle {
    vec4 placeAge;   // m, world; s, < 0: no longer at rest
    vec4 speedPath;  // m/s; m, path length
    vec4 hit;        // unit normal of the surface it hit; s since then, < 0: none
};

struct ParticleWords {  // packed: each word costs a load and a store per frame
    vec4 placeAge;
    uint speed0;  // 21 bits a part, in 1/4096 m/s
    uint speed1;
    uint hit;     // octahedron 8 + 8 bits; 1/1024 s, kNoHit: none
    float path;   // m; if the emitter's particles grow with it
};
FW_SIZE(ParticleWords, 32)
FW_CONST uint kNoHit = 0xFFFFu;

struct ParticlePush {
    uint quads;      // visible, at most
    uint firstQuad;  // first of them
    uint lights;     // emissive quads behind those, at most
    uint burnRow;    // counters row with the number of burning tiles; kNoBurnRow: none
    vec4 moved;      // m by which all positions shifted since the last frame
};
FW_SIZE(ParticlePush, 32)

// Standard deviation 1, at most 3.
FW_FN float particleGauss(uint x) {
    uint a = hash32(x), b = hash32(x + 0x9e3779b9u);
    return (float(a & 0xFFFFu) + float(a >> 16) + float(b & 0xFFFFu) - 98302.5f) *
           (2.0f / 65535.0f);
}

FW_FN uint particleSpeedBits(float v) {
    return uint(int(clamp(v, -255.0f, 255.0f) * 4096.0f + (v < 0.0f ? -0.5f : 0.5f))) & 0x1FFFFFu;
}
FW_FN float particleSpeedOf(uint bits) { return float(int(bits << 11) >> 11) * (1.0f / 4096.0f); }
FW_FN uint particleHitBits(vec4 hit) {
    if (hit.w < 0.0f) return kNoHit << 16;
    vec3 n = vec3(hit);
    float sum = (n.x < 0.0f ? -n.x : n.x) + (n.y < 0.0f ? -n.y : n.y) + (n.z < 0.0f ? -n.z : n.z);
    n = n / max(sum, 1e-6f);
    float x = n.x, y = n.y;
    if (n.z < 0.0f) {  // fold the lower half outwards
        x = (1.0f - (n.y < 0.0f ? -n.y : n.y)) * (n.x < 0.0f ? -1.0f : 1.0f);
        y = (1.0f - (n.x < 0.0f ? -n.x : n.x)) * (n.y < 0.0f ? -1.0f : 1.0f);
    }
    return uint(x * 127.0f + 127.5f) | uint(y * 127.0f + 127.5f) << 8 |
           uint(min(hit.w * 1024.0f + 0.5f, 65534.0f)) << 16;
}
FW_FN vec4 particleHitOf(uint bits) {
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
FW_FN ParticleWords particlePacked(Particle p) {
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
FW_FN Particle particleUnpacked(ParticleWords w) {
    Particle p;
    p.placeAge = w.placeAge;
    p.speedPath = vec4(particleSpeedOf(w.speed0 & 0x1FFFFFu),
                       particleSpeedOf((w.speed0 >> 21 | w.speed1 << 11) & 0x1FFFFFu),
                       particleSpeedOf(w.speed1 >> 10), w.path);
    p.hit = particleHitOf(w.hit);
    return p;
}

// Age of ring slot i in births: 0 is the newest. None: >= filled.
FW_FN uint particleBirths(uint head, uint ring, uint i) {
    return i < head ? head - 1u - i : head + ring - 1u - i;
}
FW_FN uint particleSeed(uint seed, uint serial) {
    return hash32(serial * 747796405u + seed * 2891336453u);
}

// Flipbook of a particle, + 1, from up to `most` bytes of a word; 0: none.
FW_FN uint particleFlipbook(uint bytes, uint most, uint seed) {
    uint count = 0u;
    for (uint i = 0u; i < most; ++i) count += (bytes >> (8u * i) & 0xFFu) != 0u ? 1u : 0u;
    uint one = count > 0u ? hash32(seed + 31u) % count : 0u;
    return bytes >> (8u * one) & (count > 0u ? 0xFFu : 0u);
}

// Properties that follow from the seed alone.
struct ParticleTraits {
    float life;     // s of fire
    float all;      // s, including smoke
    float smoke;    // density of its smoke; 0: none
    float own;      // [0, 1)
    float other;    // [0, 1)
};
FW_FN ParticleTraits particleTraits(ParticleEmitter e, uint seed) {
    ParticleTraits t;
    float f = hashUnit(seed + 4u), f2 = f * f;
    t.life = e.life.x * (1.0f + e.life.y * (1.2f * f + 1.2f * f2 * f2 - 0.85f));
    t.own = hashUnit(seed + 5u);
    t.other = hashUnit(seed + 8u);
    float keep = e.life.w;
    t.smoke = saturate((keep - t.other) * 20.0f) * e.heat.z;
    t.all = t.smoke > 0.0f ? t.life * (1.0f + e.life.z) : t.life;
    return t;
}

FW_FN vec3 particleAcross(vec3 d) {
    return normalize(
        cross(d, (d.y < 0.9f && d.y > -0.9f) ? vec3(0.0f, 1.0f, 0.0f) : vec3(1.0f, 0.0f, 0.0f)));
}
// Point of a disc of radius `away` about n, at angle `turn`.
FW_FN vec3 particleDisc(vec3 n, float turn, float away) {
    vec3 r = particleAcross(n), u = cross(r, n);
    return (r * cos(turn) + u * sin(turn)) * away;
}
// State at birth, `age` s before the frame's end.
FW_FN Particle particleBorn(ParticleEmitter e, uint seed, float age) {
    float back = e.from.w > 0.0f ? saturate(age / e.from.w) : 0.0f;
    vec3 d = vec3(e.direction);
    vec3 r = particleAcross(d), u = cross(r, d);
    vec4 waves = mix(e.waves1, e.waves0, back);
    float a = particleGauss(seed + 1u) * e.direction.w + waves.x;
    float b = particleGauss(seed + 2u) * e.direction.w + waves.y;
    float disc = e.place.w * sqrt(hashUnit(seed + 6u));
    float turn = 6.2831853f * hashUnit(seed + 7u);
    float along = 2.0f * hashUnit(seed + 9u) - 1.0f;
    vec3 at = mix(vec3(e.place), vec3(e.from), back);
    at += particleDisc(d, turn, disc) + vec3(e.half_) * along;
    float pulse = 1.0f + waves.z + 0.08f * particleGauss(seed + 3u);
    vec3 v = normalize(d + r * a + u * b) * (e.half_.w * pulse);
    Particle p;
    p.placeAge = vec4(at, 0.0f);
    p.speedPath = vec4(v + vec3(e.carried), 0.0f);
    p.hit = vec4(0.0f, 0.0f, 0.0f, -1.0f);
    return p;
}

// Moves it to a flaming tile of `area` m^2 around `at`.
FW_FN Particle particleOnTile(ParticleEmitter e, Particle p, uint seed, vec3 at, vec3 n,
                              float area) {
    float turn = 6.2831853f * hashUnit(seed + 41u);
    float away = 0.8f * sqrt(area * hashUnit(seed + 42u));
    p.placeAge = p.placeAge + vec4(at + particleDisc(n, turn, away) + n * (0.1f * e.size.x), 0.0f);
    vec3 v = n * (0.6f * e.half_.w);
    p.speedPath = p.speedPath + vec4(v, 0.0f);
    return p;
}

FW_FN bool particleSticks(ParticleEmitter e, uint seed) { return hashUnit(seed + 61u) < e.stuck.x; }
// Moves it to fuel that sticks at `at` on a surface with normal n, as a splash that has just
// happened.
FW_FN Particle particleOnPatch(ParticleEmitter e, Particle p, uint seed, vec3 at, vec3 n) {
    vec3 r = particleAcross(n), up = vec3(e.up);
    float turn = 6.2831853f * hashUnit(seed + 62u), away = 0.25f * sqrt(hashUnit(seed + 63u));
    vec3 off = particleDisc(n, turn, away);
    p.placeAge = vec4(at + off + n * 0.08f, 0.2f * e.life.x);
    p.speedPath =
        vec4(n * 0.25f + (up - n * dot(up, n)) * 0.5f + r * (0.2f * particleGauss(seed + 64u)) +
                 up * (0.5f + 0.5f * hashUnit(seed + 65u)),
             0.9f);
    p.hit = vec4(n, 0.0f);
    return p;
}

// Sine to 0.1 %: software devices have no instruction for it.
FW_FN float particleSine(float angle) {
    float x = angle * 0.15915494f;
    x -= floor(x + 0.5f);
    float y = x * (8.0f - 16.0f * (x < 0.0f ? -x : x));
    return y * (0.775f + 0.225f * (y < 0.0f ? -y : y));
}
// Divergence-free field of shear waves. Mean square about 1.
FW_FN vec3 particleEddies(vec3 x) {
    vec3 v = vec3(-0.62f, 0.0f, 0.78f) * particleSine(1.31f * x.x + 2.4f * x.y + 1.04f * x.z);
    v += vec3(0.51f, 0.86f, 0.0f) * particleSine(-2.2f * x.x + 1.305f * x.y + 0.9f * x.z + 1.3f);
    v += vec3(0.0f, -0.55f, 0.835f) * particleSine(1.7f * x.x + 2.05f * x.y + 1.35f * x.z + 4.1f);
    v += vec3(0.8f, 0.0f, -0.6f) * particleSine(2.52f * x.x - 1.6f * x.y + 3.36f * x.z + 2.2f);
    v += vec3(-0.707f, 0.707f, 0.0f) * particleSine(3.1f * x.x + 3.1f * x.y - 2.7f * x.z + 5.0f);
    return v * 0.63f;
}

FW_FN float particleSize(ParticleEmitter e, ParticleTraits t, float age, float path, float own) {
    float a = age / t.life;
    float s = e.size.x + (e.size.y * path + e.size.z * age) *
                             mix(1.0f, 0.8f + 0.45f * own, saturate(a * 3.0f));
    return s * (1.0f + 0.5f * saturate((a - 1.0f) / 2.0f));
}

// State `dt` later, at most kMaxParticleStep. now: s, cosmetic.
FW_FN Particle particleStep(ParticleEmitter e, ParticleTraits t, Particle p, float now, float dt) {
    float a = p.placeAge.w / t.life, torn = smoothstep(0.15f, 0.6f, a);
    vec3 up = vec3(e.up), v = vec3(p.speedPath), at = vec3(p.placeAge);
    vec3 wind = vec3(e.wind), n = vec3(p.hit);
    float tau = mix(e.motion.x, e.motion.y, torn) * (0.7f + 0.6f * t.own);
    tau = a > 1.0f ? 0.5f : tau;
    float lift = mix(e.motion.w, e.motion.z, torn) * (a > 1.0f ? 0.4f : 1.0f);
    vec3 push = up * lift;
    float struck = p.hit.w >= 0.0f ? 1.0f : 0.0f;
    // Along the surface it hit: pressed flat, stretched, and rising along a wall.
    float flat_ = dot(up, n) > 0.5f ? smoothstep(0.1f, 0.5f, p.hit.w) * 1.2f : 0.0f;
    vec3 along = (up - n * dot(up, n)) * (e.motion.z * 0.8f) + n * (e.motion.z * flat_);
    push = mix(push, along, struck);
    tau = mix(tau, 0.30f + 0.25f * t.own, struck);
    float keep = exp(-dt / max(tau, 0.02f));
    vec3 settled = wind + push * tau;
    vec3 next = settled + (v - settled) * keep;
    float amp = e.turbulence.x * smoothstep(0.08f, 0.7f, a) * (a > 1.0f ? 0.55f : 1.0f);
    vec3 d = vec3(e.direction);
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

FW_CONST float kSplashOff = 0.35f;  // m off the surface it hit, at most
// Collision at c with a surface of unit normal n: the tangential part continues, the rest turns
// into a sheet that prefers the direction of arrival and up.
FW_FN Particle particleSplash(ParticleEmitter e, ParticleTraits t, Particle p, uint seed, vec3 c,
                              vec3 n, float size) {
    vec3 v = vec3(p.speedPath), up = vec3(e.up);
    float into = max(-dot(v, n), 0.0f);
    vec3 along = v + n * into;
    vec3 r = particleAcross(n), s = cross(r, n);
    float turn = 6.2831853f * hashUnit(seed + 71u);
    vec3 side = r * cos(turn) + s * sin(turn) + (up - n * dot(up, n)) * 0.35f + along * 0.06f;
    side = side / max(length(side), 1e-4f);
    bool first = p.hit.w < 0.0f;
    float out_ = min(
        into * (0.25f + 0.65f * sqrt(t.other)) + 0.28f * length(along) * (0.3f + t.other), 4.5f);
    vec3 sheet = along * 0.75f + side * out_ + n * (into * (0.03f + 0.10f * t.own));
    v = first ? sheet : along + n * 0.2f;
    float off = min(0.30f * size, kSplashOff);
    float age =
        first ? clamp(p.placeAge.w, 0.22f * t.life, max(0.38f * t.life, 0.0f)) : p.placeAge.w;
    p.placeAge = vec4(c + n * off, p.placeAge.w > t.life ? p.placeAge.w : age);
    p.speedPath = vec4(v, p.speedPath.w + (first ? 0.5f : 0.0f));
    p.hit = vec4(n, first ? 0.0f : p.hit.w);
    return p;
}

// Where on a step's path it hits a disc, [0, 1]; 2: nowhere.
FW_FN float particleMeets(vec3 from, vec3 to, vec4 disc, vec3 n, float reach) {
    vec3 c = vec3(disc);
    float a = dot(from - c, n) - reach, b = dot(to - c, n) - reach;
    float f = a > 0.0f ? a / max(a - b, 1e-6f) : 0.0f;
    vec3 d = from + (to - from) * f - c;
    d -= n * dot(d, n);
    return b < 0.0f && a > b && a > -0.4f && dot(d, d) < disc.w * disc.w ? f : 2.0f;
}

// m above the emitter's ground.
FW_FN float particleAbove(ParticleEmitter e, Particle p) {
    return dot(vec3(p.placeAge), vec3(e.up)) - e.carried.w;
}
FW_FN bool particleLands(ParticleEmitter e, Particle p, float size, float above) {
    return (e.flags & kEmitterGround) != 0u && above < min(0.12f * size, 0.12f) &&
           dot(vec3(p.speedPath), vec3(e.up)) < 0.0f;
}
// m below the ground.
FW_FN float particleSunk(ParticleEmitter e, float above) {
    return (e.flags & kEmitterGround) != 0u ? max(-above, 0.0f) : 0.0f;
}
// Collision in a step from `from`: with an obstacle of its jet (at `share` of the step, at `disc`
// with normal n) or, if share > 1, with the ground.
FW_FN Particle particleMet(ParticleEmitter e, ParticleTraits t, Particle p, uint seed, vec3 from,
                           float share, vec4 disc, vec3 n, float size, float above) {
    vec3 up = vec3(e.up), at = vec3(p.placeAge);
    vec3 c = at - up * above, normal = up;
    if (share <= 1.0f) {
        vec3 d = from + (at - from) * share, middle = vec3(disc);
        c = d - n * dot(d - middle, n);
        normal = n;
    }
    return particleSplash(e, t, p, seed, c, normal, size);
}

// ---- display, over a = age in lives

FW_FN float particleKelvin(ParticleEmitter e, float a, float own) {
    float root = 1.0f - smoothstep(0.0f, 0.30f, a);  // white hot, well mixed near the nozzle
    return mix(e.heat.x, e.heat.y, smoothstep(0.30f, 1.0f, a)) + 60.0f * root -
           120.0f * own * smoothstep(0.15f, 0.7f, a);
}
FW_FN float particleFire(float a, float own) {
    return mix(0.45f, 1.0f, smoothstep(0.0f, 0.10f, a)) *
           (1.0f - smoothstep(0.62f + 0.18f * own, 0.98f, a));
}
FW_FN float particleQuarter(float x) { return x * sqrt(sqrt(x)); }  // x^1.25
FW_FN float particleSmoke(ParticleEmitter e, float a) {
    return smoothstep(0.65f, 1.05f, a) *
           particleQuarter(saturate((1.0f + e.life.z - a) / max(e.life.z, 0.01f)));
}
FW_CONST float kPuffReach = 0.55f;  // of its particle's size, from its middle
// m by which a puff keeps off the wall that its particle hit: inside the wall it would end in a
// straight line. It detaches as it begins to show. (The ground is handled by its height.)
FW_FN float particleOffWall(Particle p, vec3 up, float size, float a) {
    float upright = dot(vec3(p.hit), up);
    float wall = p.hit.w >= 0.0f ? 1.0f - upright * upright : 0.0f;
    return wall * smoothstep(0.5f, 0.8f, a) * max(kPuffReach * size - kSplashOff * 0.5f, 0.0f);
}
// Length over width, and how far the quad follows the flight direction (1) or its own rotation (0).
// across: m/s on the screen.
FW_FN float particleStretch(ParticleEmitter e, float a, float across, float hit) {
    float k = saturate(across / max(e.half_.w, 0.1f));
    return hit >= 0.0f ? 1.0f + 0.7f * saturate(across / 5.0f) * exp(-hit * 3.0f)
                       : 1.0f + (e.size.w - 1.0f) * k * exp(-a * 5.5f);
}
FW_FN float particleFollows(ParticleEmitter e, float a, float across, float hit) {
    float k = saturate(across / max(e.half_.w, 0.1f));
    return (hit >= 0.0f ? 1.0f - smoothstep(0.2f, 0.6f, hit)
                        : 1.0f - 0.85f * smoothstep(0.25f, 0.65f, a)) *
           smoothstep(0.02f, 0.12f, k);
}

FW_SHARED_END
#endif
