// Particles of one emitter on the CPU by the shader's own code, as the `particles` pass must
// compute them.
#pragma once
#include "components/fire_emitter.h"
#include "shared/particle.h"

#include <vector>

namespace fw::test {

class ParticleReference {
 public:
    explicit ParticleReference(const FwFireEmitterDef& def, uint32_t ownSeed = 1) {
        components::makeFireEmitter(def, ownSeed, emitter);
        emitter.ring = std::max(components::particlesNeeded(emitter), 1u);
        particles.resize(emitter.ring);
    }
    // False if no particle is left.
    bool step(float seconds) {
        air.now += double(seconds);
        const bool any = components::advanceEmitter(emitter, air, seconds, record);
        components::commitEmitter(emitter);
        if (any) move();
        return any;
    }
    [[nodiscard]] uint32_t births(uint32_t slot) const {
        return gpu::particleBirths(record.head, record.ring, slot);
    }
    [[nodiscard]] gpu::ParticleTraits traits(uint32_t slot) const {
        return gpu::particleTraits(
            record, gpu::particleSeed(record.seed, record.serial - 1 - births(slot)));
    }
    [[nodiscard]] bool alive(uint32_t slot) const {
        return births(slot) < record.filled && particles[slot].placeAge.w < traits(slot).all;
    }
    [[nodiscard]] gpu::vec3 place(uint32_t slot) const {
        return gpu::vec3(particles[slot].placeAge);
    }

    components::FireEmitter emitter;
    components::EmitterAir air;
    gpu::ParticleEmitter record{};
    std::vector<gpu::Particle> particles;

 private:
    void move() {
        const gpu::ParticleEmitter& e = record;
        for (uint32_t slot = 0; slot < e.ring; ++slot) {
            const uint32_t ago = births(slot);
            if (ago >= e.filled) continue;
            const uint32_t seed = gpu::particleSeed(e.seed, e.serial - 1 - ago);
            const gpu::ParticleTraits t = gpu::particleTraits(e, seed);
            gpu::Particle& p = particles[slot];
            const bool fresh = ago < e.fresh;
            const float lived = fresh ? e.age + e.apart * float(ago) : e.from.w;
            if (fresh) p = gpu::particleBorn(e, seed, lived);
            if (fresh && gpu::particleSticks(e, seed)) {
                const float which = gpu::hashUnit(seed + 66);
                uint32_t k = 0;
                for (uint32_t i = 0; i + 1 < uint32_t(e.stuck.y); ++i)
                    k += e.patches[2 * i].w < which ? 1 : 0;
                p = gpu::particleOnPatch(e, p, seed, gpu::vec3(e.patches[2 * k]),
                                         gpu::vec3(e.patches[2 * k + 1]));
            }
            const float dt = lived / float(std::max(e.steps, 1u));
            float now = e.wind.w - lived;
            for (uint32_t i = 0; i < e.steps; ++i) {
                const gpu::vec3 from(p.placeAge);
                p = gpu::particleStep(e, t, p, now, dt);
                const float size = gpu::particleSize(e, t, p.placeAge.w, p.speedPath.w, t.own);
                const float reach = p.hit.w < 0 ? std::min(0.12f * size, 0.12f) : 0.0f;
                float least = 2;
                gpu::vec4 disc(0.0f), normal(e.up);
                for (uint32_t k = 0; k < e.obstacleCount; ++k) {
                    const float f =
                        gpu::particleMeets(from, gpu::vec3(p.placeAge), e.obstacles[2 * k],
                                           gpu::vec3(e.obstacles[2 * k + 1]), reach);
                    if (f >= least) continue;
                    least = f;
                    disc = e.obstacles[2 * k];
                    normal = e.obstacles[2 * k + 1];
                }
                const float above = gpu::particleAbove(e, p);
                if (least <= 1 || gpu::particleLands(e, p, size, above))
                    p = gpu::particleMet(e, t, p, seed, from, least, disc, gpu::vec3(normal), size,
                                         above);
                else
                    p.placeAge += gpu::vec4(gpu::vec3(e.up) * gpu::particleSunk(e, above), 0.0f);
                now += dt;
            }
            p = gpu::particleUnpacked(gpu::particlePacked(p));
        }
    }
};

}  // namespace fw::test
