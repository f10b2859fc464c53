// Stored particles. A shader that moves them defines FW_MOVES. A software device reads two texels
// per particle faster than eight words, and writes words faster than texels.
#if defined(FW_MOVES)
FW_COHERENT(PARTICLES)
#elif !defined(FW_TEXELS)
FW_READ(PARTICLES)
#endif
#ifdef FW_TEXELS
#ifdef FW_MOVES
FW_TEXEL_BUFFER(PARTICLES, coherent readonly, particlesIn)
#else
FW_TEXEL_BUFFER(PARTICLES, readonly, particlesIn)
#endif
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
