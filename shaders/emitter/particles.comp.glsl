// Births and one frame of motion of all emitters' particles. A group handles a part of one
// emitter's ring. A software device executes an `if` body for every particle, so births and
// collisions have loops of their own over the few iterations that have any.
#include "lib/compute.glsl"
#include "shared/particle.h"
FW_READ(COUNTERS) FW_READ(BURN_TILES) FW_READ(EMITTERS) FW_READ(EMITTER_GROUPS)
FW_PUSH(ParticlePush)
#define FW_MOVES
#include "emitter/kept.glsl"

// Loads the emitter data that every particle needs; the rest is loaded where it is used. A software
// device loads each word for each lane.
#define FW_LOAD(member) e.member = emitters[i].member;
ParticleEmitter emitterOf(uint i) {
    ParticleEmitter e;
    FW_LOAD(from.w) FW_LOAD(direction) FW_LOAD(carried.w) FW_LOAD(wind) FW_LOAD(up) FW_LOAD(motion)
    FW_LOAD(turbulence) FW_LOAD(size) FW_LOAD(life) FW_LOAD(heat) FW_LOAD(stuck) FW_LOAD(first)
    FW_LOAD(ring) FW_LOAD(head) FW_LOAD(filled) FW_LOAD(fresh) FW_LOAD(serial) FW_LOAD(age)
    FW_LOAD(apart) FW_LOAD(seed) FW_LOAD(flags) FW_LOAD(steps) FW_LOAD(obstacleCount)
    return e;
}

// Birth on a flaming tile of the emitter's mesh, chosen by power among a few samples. Without a
// sample it is invisible.
Particle bornOnTile(ParticleEmitter e, Particle p, uint seed) {
    uint count = push.burnRow == kNoBurnRow ? 0u : counters[push.burnRow].runCount;
    uint met = 0u;
    float all = 0.0;
    vec4 place = vec4(0.0), normal = vec4(0.0, 1.0, 0.0, 0.0);
    for (uint i = 0u; i < kTileTries && count > 0u; ++i) {
        uint tile = hash32(seed + 101u * (i + 1u)) % count;
        if (met == kTileChoice || burnTiles[tile].object + 1u != e.object) continue;
        ++met;
        vec4 there = burnTiles[tile].normalPower;
        float power = max(there.w, 1e-3);
        all += power;
        if (hashUnit(seed + 57u + i) * all > power) continue;
        normal = there;
        place = burnTiles[tile].positionArea;
    }
    p = particleOnTile(e, p, seed, place.xyz, normalize(normal.xyz + vec3(0.0, 1e-4, 0.0)),
                       place.w);
    p.placeAge.w = met > 0u ? p.placeAge.w : 1e6;
    return p;
}

Particle bornNow(ParticleEmitter e, uint i, uint seed, float lived) {
    FW_LOAD(from) FW_LOAD(place) FW_LOAD(half_) FW_LOAD(carried)
    FW_LOAD(waves0) FW_LOAD(waves1) FW_LOAD(object) FW_LOAD(stuck)
    Particle p = particleBorn(e, seed, lived);
    if (particleSticks(e, seed)) {
        float which = hashUnit(seed + 66u);
        uint k = 0u;
        for (uint one = 0u; one + 1u < uint(e.stuck.y); ++one)
            k += emitters[i].patches[2u * one].w < which ? 1u : 0u;
        p = particleOnPatch(e, p, seed, emitters[i].patches[2u * k].xyz,
                            emitters[i].patches[2u * k + 1u].xyz);
    }
    if (e.object != 0u) p = bornOnTile(e, p, seed);
    return p;
}

// Particles without obstacles need no hit; particles that do not grow need no path length.
bool stops(ParticleEmitter e) { return (e.flags & (kEmitterGround | kEmitterJet)) != 0u; }
bool grows(ParticleEmitter e) { return e.size.y > 0.0; }

// hit: the collision state may have changed.
void keep(ParticleEmitter e, uint at, Particle p, bool hit) {
    ParticleWords kept = particlePacked(p);
    particles[at].placeAge = kept.placeAge;
    particles[at].speed0 = kept.speed0;
    particles[at].speed1 = kept.speed1;
    if (stops(e) && hit) particles[at].hit = kept.hit;
    if (grows(e)) particles[at].path = kept.path;
}

// s of this frame that a particle lives: from its birth, or all of it.
float livedOf(ParticleEmitter e, uint births) {
    return births < e.fresh ? e.age + e.apart * float(births) : e.from.w;
}

struct Flight {  // one particle in one frame
    ParticleTraits traits;
    Particle p;
    uint seed;
    uint at;     // storage place
    bool there;
    float now;   // s, cosmetic
    float dt;    // s of each step
};

Flight flightOf(ParticleEmitter e, uint slot) {
    Flight f;
    uint births = particleBirths(e.head, e.ring, slot);
    f.there = slot < e.ring && births < e.filled;
    f.at = e.first + min(slot, e.ring - 1u);
    f.seed = particleSeed(e.seed, e.serial - 1u - births);
    f.traits = particleTraits(e, f.seed);
    f.p = particleUnpacked(keptAt(f.at, stops(e), grows(e)));
    if (births >= e.fresh) f.p.placeAge.xyz += push.moved.xyz;
    float lived = livedOf(e, births);
    f.now = e.wind.w - lived;
    f.dt = lived / float(max(e.steps, 1u));
    return f;
}

// One step without obstacles. True: it reached the ground.
bool fliesFreely(ParticleEmitter e, inout Flight f) {
    f.p = particleStep(e, f.traits, f.p, f.now, f.dt);
    f.now += f.dt;
    float above = particleAbove(e, f.p);
    float size = particleSize(e, f.traits, f.p.placeAge.w, f.p.speedPath.w, f.traits.own);
    bool lands = particleLands(e, f.p, size, above);
    f.p.placeAge.xyz += e.up.xyz * particleSunk(e, above);
    return lands;
}

// One step with obstacles: those of its jet (of emitter i), and the ground.
void flies(ParticleEmitter e, uint i, inout Flight f) {
    vec3 from = f.p.placeAge.xyz;
    f.p = particleStep(e, f.traits, f.p, f.now, f.dt);
    f.now += f.dt;
    float size = particleSize(e, f.traits, f.p.placeAge.w, f.p.speedPath.w, f.traits.own);
    float reach = f.p.hit.w < 0.0 ? min(0.12 * size, 0.12) : 0.0, least = 2.0;
    vec4 disc = vec4(0.0);
    vec3 normal = e.up.xyz;
    uint k = 0u;
    do {
        vec4 middle = emitters[i].obstacles[2u * k];
        vec3 n = emitters[i].obstacles[2u * k + 1u].xyz;
        float share = particleMeets(from, f.p.placeAge.xyz, middle, n, reach);
        bool first = k < e.obstacleCount && share < least;
        least = first ? share : least;
        disc = first ? middle : disc;
        normal = first ? n : normal;
    } while (++k < e.obstacleCount);
    float above = particleAbove(e, f.p);
    if (least <= 1.0 || particleLands(e, f.p, size, above))
        f.p = particleMet(e, f.traits, f.p, f.seed, from, least, disc, normal, size, above);
    else
        f.p.placeAge.xyz += e.up.xyz * particleSunk(e, above);
}

void main() {
    uvec2 group = groups[gl_WorkGroupID.x];
    ParticleEmitter e = emitterOf(group.x);
    uint turns = (min(e.ring - group.y, kParticleGroup) + 63u) / 64u;
    // Births occupy a range that ends before the ring's head and may wrap around. A thread spawns
    // the particles that it then moves.
    uint end = group.y + turns * 64u;
    uint low = max(e.head - min(e.fresh, e.head), group.y), high = min(e.head, end);
    uint wrapped = max(e.ring - (e.fresh - min(e.fresh, e.head)), group.y), top = min(e.ring, end);
    uint lowTurn = (low - group.y) / 64u, wrappedTurn = (wrapped - group.y) / 64u;
    uint lows = low < high ? (high - group.y + 63u) / 64u - lowTurn : 0u;
    uint tops = wrapped < top ? turns - wrappedTurn : 0u;
    uint own = group.y + gl_LocalInvocationID.x;  // the first of this thread's slots
    for (uint i = 0u; i < lows + tops; ++i) {
        uint turn = i < lows ? lowTurn + i : wrappedTurn + i - lows;
        uint slot = own + turn * 64u;
        uint births = particleBirths(e.head, e.ring, slot);
        if (slot < e.ring && births < e.fresh) {
            uint seed = particleSeed(e.seed, e.serial - 1u - births);
            keep(e, e.first + slot, bornNow(e, group.x, seed, livedOf(e, births)), true);
        }
    }
    memoryBarrier();  // words written above are read as texels below
    // A jet's particles all test obstacles; others only when they reach the ground: a bit per
    // iteration marks those.
    bool jet = e.obstacleCount > 0u;
    uint met = 0u, turn = jet ? turns - 1u : 0u;
    do {
        Flight f = flightOf(e, own + turn * 64u);
        bool stopped = jet;
        uint i = 0u;
        do {
            stopped = fliesFreely(e, f) || stopped;
        } while (++i < e.steps);
        if (f.there && !stopped) keep(e, f.at, f.p, f.p.hit.w >= 0.0);
        met |= f.there && stopped ? 1u << turn : 0u;
    } while (++turn < turns);
    if (jet) met = (1u << turns) - 1u;
    for (; met != 0u; met &= met - 1u) {
        Flight f = flightOf(e, own + uint(findLSB(met)) * 64u);
        uint i = 0u;
        do {
            flies(e, group.x, f);
        } while (++i < e.steps);
        if (f.there) keep(e, f.at, f.p, true);
    }
}
