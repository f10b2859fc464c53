// Particles to quads of the frame's view. A group handles a part of one emitter's ring.
#include "lib/compute.glsl"
#include "lib/view.glsl"
#include "shared/particle.h"
FW_READ(EMITTERS) FW_READ(EMITTER_GROUPS) FW_READ_WRITE(DRAW_ARGS) FW_WRITE(FLAMES)
FW_PUSH(ParticlePush)
#include "emitter/flipbooks.glsl"
#include "emitter/kept.glsl"

const float kNearFade = 0.3;  // m before the camera

// Loads the emitter data for display only: a software device loads each word for each lane.
#define FW_LOAD(member) e.member = emitters[i].member;
ParticleEmitter emitterOf(uint i) {
    ParticleEmitter e;
    FW_LOAD(carried.w) FW_LOAD(half_.w) FW_LOAD(up) FW_LOAD(size) FW_LOAD(life) FW_LOAD(heat)
    FW_LOAD(first) FW_LOAD(ring) FW_LOAD(head) FW_LOAD(filled) FW_LOAD(serial) FW_LOAD(seed)
    FW_LOAD(flags) FW_LOAD(fireFlipbooks) FW_LOAD(smokeFlipbooks)
    return e;
}

// Writes a quad of fire, of smoke, both or none.
void makeQuads(ParticleEmitter e, ParticleTraits t, Particle p, uint seed) {
    bool perspective = view.forward.w > 0.5;
    float age = p.placeAge.w, a = age / t.life;
    float shows = shownShare(view.quads.x, hashUnit(seed + 311u));
    float size = particleSize(e, t, age, p.speedPath.w, t.own) * view.quads.y;
    vec3 place = p.placeAge.xyz, v = p.speedPath.xyz;
    vec3 toEye = view.eye.xyz - place;
    float far = perspective ? dot(-toEye, view.forward.xyz) : 1e3;
    toEye = perspective ? toEye / max(length(toEye), 1e-3) : -view.forward.xyz;
    vec3 right = cross(view.up.xyz, toEye);
    right = dot(right, right) > 1e-4 ? normalize(right) : vec3(1.0, 0.0, 0.0);
    vec3 above = cross(toEye, right);
    vec2 across = vec2(dot(v, right), dot(v, above));
    float speed = length(across);
    vec2 heading = speed > 1e-3 ? across / speed : vec2(0.0, 1.0);
    float follows = particleFollows(e, a, speed, p.hit.w);
    float stretch = particleStretch(e, a, speed, p.hit.w);
    // Blend of its own rotation and that of its path.
    float spin = 2.0 * t.own - 1.0;
    float own = 1.6 * spin + 2.2 * (t.other - 0.5) * age;
    float turned = mix(own, 0.5 * spin * smoothstep(0.1, 0.4, a), follows);
    vec2 axis = heading * cos(turned) + vec2(heading.y, -heading.x) * sin(turned);
    // Fades close to the camera, and when it would fill the view.
    float near = smoothstep(kNearFade, kNearFade + 0.8, far) *
                 (1.0 - smoothstep(0.5, 1.0, size / max(far, 1e-3)));
    near *= shows;
    bool drawn = near > 0.0;

    FlameQuad quad;
    vec3 along = right * axis.x + above * axis.y;
    // A fire's foot is at its birth place; nothing reaches into the ground.
    bool jet = (e.flags & kEmitterJet) != 0u;
    place += e.up.xyz * (jet ? 0.0 : 0.35 * size * (1.0 - smoothstep(0.0, 0.5, a)));
    float height = dot(place, e.up.xyz) - e.carried.w;
    float root = sqrt(sqrt(stretch));
    float tall = size * root * root * root, wide = 0.5 * size / root;
    float upright = abs(dot(along, e.up.xyz));
    float low = mix(0.7 * wide, 0.42 * tall, upright);
    place += e.up.xyz * ((e.flags & kEmitterGround) != 0u ? max(0.0, low - height) : 0.0);
    float opacity = particleFire(a, t.own) * near;
    quad.axisWidth = vec4(along, wide);
    quad.baseHeight = vec4(place - along * (0.5 * tall), tall);
    quad.opacity = opacity;
    // An unbroken ball has no shape yet.
    quad.phase = min(0.10 + max(a, 0.0) * (0.75 + 0.3 * t.other), 0.98);
    quad.kelvin = particleKelvin(e, a, t.own);
    quad.kind = (seed & 0xFFFFu) << kQuadSeed | kQuadFire;
    // A flipbook, too, begins as a shapeless ball.
    float shown = 0.12 + max(a, 0.0) * (0.75 + 0.25 * t.other);
    showByFlipbook(quad, particleFlipbook(e.fireFlipbooks, 3u, seed), shown, age, t.own);
    bool fire = drawn && opacity > 0.004 && a < 1.0;
    FlameQuad smoke;
    float lit = clamp(1.25 - a, 0.0, 1.0);
    smoke.axisWidth = vec4(view.up.xyz, 0.62 * size);
    // Leaves walls and stays above the ground as it grows: inside them it would end in a straight
    // line.
    place += p.hit.xyz * particleOffWall(p, e.up.xyz, size, a);
    float sunk = kPuffReach * size - (dot(place, e.up.xyz) - e.carried.w);
    place += e.up.xyz * ((e.flags & kEmitterGround) != 0u ? max(0.0, sunk) : 0.0);
    smoke.baseHeight = vec4(place - view.up.xyz * (0.62 * size), 1.24 * size);
    smoke.opacity = particleSmoke(e, a) * t.smoke * near;
    smoke.phase = 0.10 * age + 5.0 * t.other;
    smoke.kelvin = lit;
    smoke.kind = (seed & 0xFFFFu) << kQuadSeed | kQuadSmoke;
    showByFlipbook(smoke, particleFlipbook(e.smokeFlipbooks, 2u, seed),
                   (a - 0.65) / max(0.35 + e.life.z, 0.1), age, t.other);
    bool smokes = drawn && smoke.opacity > 0.004 && t.smoke > 0.0;

    // Emissive quads have separate places: they are not sorted.
    if (fire && (e.flags & kEmitterEmits) != 0u) {
        uint light = atomicAdd(drawArgs[kFlameEmissiveQuads], 1u);
        quad.kind |= kQuadEmits;
        if (light < push.lights) flameQuad[push.firstQuad + push.quads + light] = quad;
        fire = false;
    }
    uint count = (fire ? 1u : 0u) + (smokes ? 1u : 0u);
    uint first = 0u;
    if (count > 0u) first = atomicAdd(drawArgs[kFlameParticleQuads], count);
    if (fire && first < push.quads) flameQuad[push.firstQuad + first] = quad;
    if (fire) ++first;
    if (smokes && first < push.quads) flameQuad[push.firstQuad + first] = smoke;
}

void main() {
    uvec2 group = groups[gl_WorkGroupID.x];
    ParticleEmitter e = emitterOf(group.x);
    if ((e.flags & kEmitterHidden) != 0u) return;
    bool stops = (e.flags & (kEmitterGround | kEmitterJet)) != 0u, grows = e.size.y > 0.0;
    uint turns = (min(e.ring - group.y, kParticleGroup) + 63u) / 64u;
    // Tests at its end: see lib/compute.glsl.
    uint turn = 0u;
    do {
        uint slot = group.y + turn * 64u + gl_LocalInvocationID.x;
        uint births = particleBirths(e.head, e.ring, slot);
        uint seed = particleSeed(e.seed, e.serial - 1u - births);
        ParticleTraits t = particleTraits(e, seed);
        Particle p = particleUnpacked(keptAt(e.first + min(slot, e.ring - 1u), stops, grows));
        if (slot < e.ring && births < e.filled && p.placeAge.w < t.all) makeQuads(e, t, p, seed);
    } while (++turn < turns);
}
