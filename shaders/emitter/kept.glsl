// Stored particles. A shader that moves them defines FW_MOVES. A software device reads two texels
// per particle faster than eight words, and writes words faster than texels.
#ifdef FW_MOVES
#define FW_KEPT_ACCESS coherent
#define FW_KEPT_TEXELS coherent readonly
#else
#define FW_KEPT_ACCESS readonly
#define FW_KEPT_TEXELS readonly
#endif
#if defined(FW_MOVES) || !defined(FW_TEXELS)
layout(std430, set = 0, binding = FW_BIND_PARTICLES) FW_KEPT_ACCESS buffer ParticlesBuffer {
    ParticleWords particles[];
};
#endif
#ifdef FW_TEXELS
layout(rgba32ui, set = 0, binding = FW_BIND_COUNT + FW_BIND_PARTICLES)
    FW_KEPT_TEXELS uniform uimageBuffer particlesIn;
#endif

// Loads a particle; stops, grows: whether its emitter uses hits and path lengths.
ParticleWords keptAt(uint at, bool stops, bool grows) {
    ParticleWords kept;
#ifdef FW_TEXELS
    uvec4 facts = imageLoad(particlesIn, int(2u * at + 1u));
    kept.placeAge = uintBitsToFloat(imageLoad(particlesIn, int(2u * at)));
    kept.speed0 = facts.x;
    kept.speed1 = facts.y;
    kept.hit = stops ? facts.z : kNoHit << 16u;
    kept.path = grows ? uintBitsToFloat(facts.w) : 0.0;
#else
    kept.placeAge = particles[at].placeAge;
    kept.speed0 = particles[at].speed0;
    kept.speed1 = particles[at].speed1;
    kept.hit = stops ? particles[at].hit : kNoHit << 16u;
    kept.path = grows ? particles[at].path : 0.0;
#endif
    return kept;
}
