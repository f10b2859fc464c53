// Particles of all emitters: births and one frame of motion. A group works on a part of one
// emitter's ring. A software device runs what stands in a loop at least once in a group, what stands
// in an `if` for every particle: so births have a loop of their own, over the few turns that have
// any.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_COUNTERS readonly
#define FW_USE_BURN_TILES readonly
#include "lib/buffers.glsl"
#include "shared/burn.h"
#include "shared/particle.h"
layout(std430, set = 0, binding = FW_BIND_EMITTERS) readonly buffer EmittersBuffer {
    ParticleEmitter emitters[];
};
layout(std430, set = 0, binding = FW_BIND_EMITTER_GROUPS) readonly buffer GroupsBuffer {
    uvec2 groups[];  // emitter, first slot of its ring
};
layout(std430, set = 0, binding = FW_BIND_PARTICLES) buffer ParticlesBuffer {
    ParticleWords particles[];
};
layout(push_constant) uniform Push { ParticlePush push; };

// Of an emitter's record what every particle needs. A software device loads each word for each lane:
// the rest is read where it is needed, and there alone.
ParticleEmitter emitterOf(uint i) {
    ParticleEmitter e;
    e.from.w = emitters[i].from.w;
    e.direction = emitters[i].direction;
    e.carried.w = emitters[i].carried.w;
    e.wind = emitters[i].wind;
    e.up = emitters[i].up;
    e.motion = emitters[i].motion;
    e.turbulence = emitters[i].turbulence;
    e.size = emitters[i].size;
    e.life = emitters[i].life;
    e.heat = emitters[i].heat;
    e.first = emitters[i].first;
    e.ring = emitters[i].ring;
    e.head = emitters[i].head;
    e.filled = emitters[i].filled;
    e.fresh = emitters[i].fresh;
    e.serial = emitters[i].serial;
    e.age = emitters[i].age;
    e.apart = emitters[i].apart;
    e.seed = emitters[i].seed;
    e.flags = emitters[i].flags;
    e.steps = emitters[i].steps;
    e.shieldCount = emitters[i].shieldCount;
    return e;
}

// A birth on a flaming tile of the emitter's mesh, each as likely as it has power: of a few that it
// meets. None met: it is never seen.
Particle bornOnTile(ParticleEmitter e, Particle p, uint seed) {
    uint count = push.burnRow == kNoBurnRow ? 0u : counters[push.burnRow].runCount;
    uint met = 0u;
    float all = 0.0;
    vec4 place = vec4(0.0), normal = vec4(0.0, 1.0, 0.0, 0.0);
    for (uint i = 0u; i < kTileTries && count > 0u; ++i) {
        uint tile = particleBits(seed + 101u * (i + 1u)) % count;
        if (met == kTileChoice || burnTiles[tile].object + 1u != e.object) continue;
        ++met;
        vec4 there = burnTiles[tile].normalPower;
        float power = max(there.w, 1e-3);
        all += power;
        if (particleHash(seed + 57u + i) * all > power) continue;
        normal = there;
        place = burnTiles[tile].positionArea;
    }
    p = particleOnTile(e, p, seed, place.xyz, normalize(normal.xyz + vec3(0.0, 1e-4, 0.0)),
                       place.w);
    p.placeAge.w = met > 0u ? p.placeAge.w : 1e6;
    return p;
}

Particle bornNow(ParticleEmitter e, uint i, uint seed, float lived) {
    e.from = emitters[i].from;
    e.place = emitters[i].place;
    e.half_ = emitters[i].half_;
    e.carried = emitters[i].carried;
    e.waves0 = emitters[i].waves0;
    e.waves1 = emitters[i].waves1;
    e.object = emitters[i].object;
    e.stuck = emitters[i].stuck;
    Particle p = particleBorn(e, seed, lived);
    if (particleSticks(e, seed)) {
        float which = particleHash(seed + 66u);
        uint k = 0u;
        for (uint one = 0u; one + 1u < uint(e.stuck.y); ++one)
            k += emitters[i].patches[2u * one].w < which ? 1u : 0u;
        p = particleOnPatch(e, p, seed, emitters[i].patches[2u * k].xyz,
                            emitters[i].patches[2u * k + 1u].xyz);
    }
    if (e.object != 0u) p = bornOnTile(e, p, seed);
    return p;
}

void keep(uint at, Particle p, bool stops, bool grows) {
    ParticleWords kept = particlePacked(p);
    particles[at].placeAge = kept.placeAge;
    particles[at].speed0 = kept.speed0;
    particles[at].speed1 = kept.speed1;
    if (stops) particles[at].hit = kept.hit;
    if (grows) particles[at].path = kept.path;
}

// s before the frame's end that a fresh one is born, and that any other moves.
float livedOf(ParticleEmitter e, uint births) {
    return births < e.fresh ? e.age + e.apart * float(births) : e.from.w;
}

void main() {
    uvec2 group = groups[gl_WorkGroupID.x];
    ParticleEmitter e = emitterOf(group.x);
    uint turns = (min(e.ring - group.y, kParticleGroup) + 63u) / 64u;
    // What nothing stops has no hit, what does not grow on its way needs none of it.
    bool stops = (e.flags & (kEmitterGround | kEmitterJet)) != 0u, grows = e.size.y > 0.0;
    // Births lie in a row that ends before the ring's head and may begin at its end. Turns with any:
    // a thread gives birth to those that it then moves.
    uint end = group.y + turns * 64u;
    uint low = max(e.head - min(e.fresh, e.head), group.y), high = min(e.head, end);
    uint wrapped = max(e.ring - (e.fresh - min(e.fresh, e.head)), group.y), top = min(e.ring, end);
    uint lowTurn = (low - group.y) / 64u, wrappedTurn = (wrapped - group.y) / 64u;
    uint lows = low < high ? (high - group.y + 63u) / 64u - lowTurn : 0u;
    uint tops = wrapped < top ? turns - wrappedTurn : 0u;
    for (uint i = 0u; i < lows + tops; ++i) {
        uint turn = i < lows ? lowTurn + i : wrappedTurn + i - lows;
        uint slot = group.y + turn * 64u + gl_LocalInvocationID.x;
        uint births = particleBirths(e.head, e.ring, slot);
        if (slot < e.ring && births < e.fresh) {
            uint seed = particleSeed(e.seed, e.serial - 1u - births);
            keep(e.first + slot, bornNow(e, group.x, seed, livedOf(e, births)), stops, grows);
        }
    }
    for (uint turn = 0u; turn < turns; ++turn) {
        uint slot = group.y + turn * 64u + gl_LocalInvocationID.x;
        uint births = particleBirths(e.head, e.ring, slot);
        bool there = slot < e.ring && births < e.filled;
        uint at = e.first + min(slot, e.ring - 1u);
        uint seed = particleSeed(e.seed, e.serial - 1u - births);
        ParticleTraits t = particleTraits(e, seed);
        ParticleWords kept;
        kept.placeAge = particles[at].placeAge;
        kept.speed0 = particles[at].speed0;
        kept.speed1 = particles[at].speed1;
        kept.hit = stops ? particles[at].hit : kNoHit << 16u;
        kept.path = grows ? particles[at].path : 0.0;
        Particle p = particleUnpacked(kept);
        float lived = livedOf(e, births);
        float dt = lived / float(max(e.steps, 1u)), now = e.wind.w - lived;
        for (uint i = 0u; i < e.steps; ++i) {
            vec3 from = p.placeAge.xyz;
            p = particleStep(e, t, p, now, dt);
            float size = particleSize(e, t, p.placeAge.w, p.speedPath.w, t.own), least = 2.0;
            float reach = p.hit.w < 0.0 ? min(0.12 * size, 0.12) : 0.0;
            vec4 disc = vec4(0.0);
            vec3 normal = e.up.xyz;
            for (uint k = 0u; k < e.shieldCount; ++k) {
                vec4 middle = emitters[group.x].shields[2u * k];
                vec3 n = emitters[group.x].shields[2u * k + 1u].xyz;
                float f = particleMeets(from, p.placeAge.xyz, middle, n, reach);
                bool first = f < least;
                least = first ? f : least;
                disc = first ? middle : disc;
                normal = first ? n : normal;
            }
            float above = particleAbove(e, p);
            if (least <= 1.0 || particleLands(e, p, size, above))
                p = particleMet(e, t, p, seed, from, least, disc, normal, size, above);
            else
                p.placeAge.xyz += e.up.xyz * particleSunk(e, above);
            now += dt;
        }
        if (there) keep(at, p, stops, grows);
    }
}
