// Particles of all emitters: births, one frame of motion, and the quads that show them to the
// frame's view. A group works on a part of one emitter's ring.
#version 450
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define FW_USE_COUNTERS readonly
#define FW_USE_BURN_TILES readonly
#include "lib/buffers.glsl"
#include "shared/book.h"
#include "shared/burn.h"
#include "shared/look.h"
#include "shared/particle.h"
layout(std430, set = 0, binding = FW_BIND_EMITTERS) readonly buffer EmittersBuffer {
    ParticleEmitter emitters[];
};
layout(std430, set = 0, binding = FW_BIND_EMITTER_GROUPS) readonly buffer GroupsBuffer {
    uvec2 groups[];  // emitter, first slot of its ring
};
layout(std430, set = 0, binding = FW_BIND_PARTICLES) buffer ParticlesBuffer {
    Particle particles[];
};
layout(std430, set = 0, binding = FW_BIND_FLAMES) writeonly buffer FlamesBuffer {
    FlameQuad flameQuad[];
};
layout(std430, set = 0, binding = FW_BIND_DRAW_ARGS) buffer ArgsBuffer { uint drawArgs[]; };
layout(std430, set = 0, binding = FW_BIND_BOOKS) readonly buffer BooksBuffer { uint books[]; };
layout(set = 0, binding = FW_BIND_VIEW, std140) uniform View { ViewParams view; };
layout(push_constant) uniform Push { ParticlePush push; };

const float kNearFade = 0.3;  // m before the eye

// All but its shields: those are looked at one by one.
ParticleEmitter emitterOf(uint i) {
    ParticleEmitter e;
    e.from = emitters[i].from;
    e.place = emitters[i].place;
    e.direction = emitters[i].direction;
    e.half_ = emitters[i].half_;
    e.carried = emitters[i].carried;
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
    e.books = emitters[i].books;
    e.otherBooks = emitters[i].otherBooks;
    e.object = emitters[i].object;
    e.waves0 = emitters[i].waves0;
    e.waves1 = emitters[i].waves1;
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

// What shows a quad by `book` (+ 1; 0: nothing does, and its phase is its own).
void show(inout FlameQuad quad, uint book, float life, float age, float own) {
    if (book == 0u) return;
    uint at = (book - 1u) * kBookRecordWords;
    bool loops = (books[at + 6u] & kBookLoops) != 0u;
    quad.phase = bookTime(loops, uintBitsToFloat(books[at + 8u]), life, age, own);
    quad.kind |= book << kQuadBook;
}

void main() {
    uvec2 group = groups[gl_WorkGroupID.x];
    ParticleEmitter e = emitterOf(group.x);
    uint steps = push.still == 0u ? e.steps : 0u;
    bool perspective = view.forward.w > 0.5;
    for (uint turn = 0u; turn < kParticleGroup / 64u; ++turn) {
        uint slot = group.y + turn * 64u + gl_LocalInvocationID.x;
        uint births = particleBirths(e.head, e.ring, slot);
        bool there = slot < e.ring && births < e.filled;
        uint at = e.first + min(slot, e.ring - 1u);
        uint seed = particleSeed(e.seed, e.serial - 1u - births);
        ParticleTraits t = particleTraits(e, seed);
        Particle p = particles[at];
        bool fresh = births < e.fresh && push.still == 0u;
        float lived = fresh ? e.age + e.apart * float(births) : e.from.w;
        Particle born = particleBorn(e, seed, lived);
        if (fresh && e.object != 0u) born = bornOnTile(e, born, seed);
        p.placeAge = fresh ? born.placeAge : p.placeAge;
        p.speedPath = fresh ? born.speedPath : p.speedPath;
        p.hit = fresh ? born.hit : p.hit;
        float dt = lived / float(max(steps, 1u)), now = e.wind.w - lived;
        for (uint i = 0u; i < steps; ++i) {
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
            p = particleStops(e, t, p, seed, from, least, disc, normal);
            now += dt;
        }
        if (there) particles[at] = p;

        float age = p.placeAge.w, a = age / t.life;
        float size = particleSize(e, t, age, p.speedPath.w, t.own);
        vec3 place = p.placeAge.xyz, v = p.speedPath.xyz;
        vec3 toEye = view.eye.xyz - place;
        float far = perspective ? dot(-toEye, view.forward.xyz) : 1e3;
        toEye = perspective ? toEye / max(length(toEye), 1e-3) : -view.forward.xyz;
        vec3 right = cross(view.up.xyz, toEye);
        right = dot(right, right) > 1e-4 ? normalize(right) : vec3(1.0, 0.0, 0.0);
        vec3 above = cross(toEye, right);
        vec2 across = vec2(dot(v, right), dot(v, above));
        float speed = length(across);
        vec2 way = speed > 1e-3 ? across / speed : vec2(0.0, 1.0);
        float follows = particleFollows(e, a, speed, p.hit.w);
        float stretch = particleStretch(e, a, speed, p.hit.w);
        // Its own turn, or that of its way with some of it.
        float spin = 2.0 * t.own - 1.0;
        float own = 1.6 * spin + 2.2 * (t.other - 0.5) * age;
        float turned = mix(own, 0.5 * spin * smoothstep(0.1, 0.4, a), follows);
        vec2 axis = way * cos(turned) + vec2(way.y, -way.x) * sin(turned);
        // Close to the eye it fades, and so does what would fill the view.
        float near = smoothstep(kNearFade, kNearFade + 0.8, far) *
                     (1.0 - smoothstep(0.5, 1.0, size / max(far, 1e-3)));
        bool drawn = there && age < t.all && near > 0.0 && push.quads != 0u &&
                     (e.flags & kEmitterHidden) == 0u;
        bool spark = t.spark > 0.5;

        FlameQuad quad;
        vec3 along = right * axis.x + above * axis.y;
        // A fire's foot is where it is born; nothing reaches into the ground.
        bool jet = (e.flags & kEmitterJet) != 0u;
        place += e.up.xyz * (jet || spark ? 0.0 : 0.35 * size * (1.0 - smoothstep(0.0, 0.5, a)));
        float height = dot(place, e.up.xyz) - e.carried.w;
        float root = sqrt(sqrt(stretch));
        float tall = size * root * root * root, wide = 0.5 * size / root;
        float upright = abs(dot(along, e.up.xyz));
        float low = mix(0.7 * wide, 0.42 * tall, upright);
        place += e.up.xyz * ((e.flags & kEmitterGround) != 0u && !spark ? max(0.0, low - height)
                                                                         : 0.0);
        float opacity = particleFire(a, t.own) * near;
        if (spark) {
            // A streak of a fiftieth of a second; what is too thin for a pixel is dimmer instead.
            float pixel = view.eye.w * max(far, 0.05);
            float thick = 0.004 + 0.004 * t.other;
            // A book's streak fills a third of its page.
            if ((e.otherBooks >> 16u & 0xFFu) != 0u) thick *= 3.0;
            along = speed > 1e-3 ? v / max(length(v), 1e-3) : above;
            wide = max(thick, 0.7 * pixel);
            tall = length(v) * 0.02 + 2.0 * wide;
            opacity = thick / wide * (1.0 - smoothstep(0.6, 1.0, a)) * near;
        }
        quad.axisWidth = vec4(along, wide);
        quad.baseHeight = vec4(place - along * (0.5 * tall), tall);
        quad.opacity = opacity;
        // What is whole has no shape yet.
        quad.phase = min(0.10 + max(a, 0.0) * (0.75 + 0.3 * t.other), 0.98);
        quad.kelvin = spark ? 1850.0 - 650.0 * a : particleKelvin(e, a, t.own);
        quad.kind = (seed & 0xFFFFu) << 2u | (spark ? kQuadSpark : kQuadFire);
        uint book = spark ? e.otherBooks >> 16u & 0xFFu : particleBook(e.books, 3u, seed);
        // A book begins as a ball without shape too.
        float shown = spark ? a : 0.12 + max(a, 0.0) * (0.75 + 0.25 * t.other);
        show(quad, book, shown, age, t.own);
        bool fire = drawn && opacity > 0.004 && a < 1.0;
        FlameQuad smoke;
        float lit = clamp(1.25 - a, 0.0, 1.0);
        smoke.axisWidth = vec4(view.up.xyz, 0.62 * size);
        smoke.baseHeight = vec4(place - view.up.xyz * (0.62 * size), 1.24 * size);
        smoke.opacity = particleSmoke(e, a) * t.smoke * near;
        smoke.phase = 0.10 * age + 5.0 * t.other;
        smoke.kelvin = lit;
        smoke.kind = (seed & 0xFFFFu) << 2u | kQuadSmoke;
        show(smoke, particleBook(e.otherBooks & 0xFFFFu, 2u, seed),
             (a - 0.65) / max(0.35 + e.life.z, 0.1), age, t.other);
        bool smokes = drawn && smoke.opacity > 0.004 && t.smoke > 0.0;

        uint count = (fire ? 1u : 0u) + (smokes ? 1u : 0u);
        uint first = 0u;
        if (count > 0u) first = atomicAdd(drawArgs[kFlameParticles], count);
        if (fire && first < push.quads) flameQuad[push.firstQuad + first] = quad;
        if (fire) ++first;
        if (smokes && first < push.quads) flameQuad[push.firstQuad + first] = smoke;
    }
}
