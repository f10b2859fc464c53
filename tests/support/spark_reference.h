// Sparks of one emitter on the CPU by the shader's own code, as the `sparks` pass must show them.
#pragma once
#include "components/sparks.h"
#include "shared/particle.h"
#include "shared/spark.h"

#include <cmath>
#include <vector>

namespace fw::test {

struct Spark {
    uint32_t slot = 0;
    gpu::SparkSlot now{};
    gpu::SparkKind kind{};
    gpu::SparkLeg leg{};
    gpu::vec3 place{0.0f};
};

class SparkRig {
 public:
    explicit SparkRig(float power, float share = 1) {
        FwFireEmitterDef def{};
        def.stickTime = 6;
        def.direction[1] = 1;
        def.shape = FW_EMITTER_DISC;
        def.flags = FW_EMITTER_GROUND;
        def.ground = 0.5f;
        def.radius = 0.4f;
        def.position[1] = 0.6f;
        def.power = power;
        def.buoyancy = def.windResponse = def.turbulence = 1;
        def.inherit = 0.5f;
        def.sparks = share;
        components::makeFireEmitter(def, 7, emitter);
        emitter.ring = 64;
    }
    bool step(float seconds) {
        air.now += double(seconds);
        gpu::ParticleEmitter particles;
        (void)components::advanceEmitter(emitter, air, seconds, particles);
        const bool any = components::advanceSparks(emitter, air, seconds, record);
        components::commitEmitter(emitter);
        return any;
    }
    // A slope along x with waves along z, for the host's heightfield; no plane.
    static float hill(float x, float z) { return 0.6f * x + 0.4f * std::sin(1.1f * z); }
    void makeHill() {
        emitter.def.flags &= ~uint32_t(FW_EMITTER_GROUND);
        emitter.def.ground = -1e9f;
        record.grid = {-4, -4, gpu::kSparkCellSide, 1};
        for (uint32_t i = 0; i < gpu::kSparkCells * gpu::kSparkCells; ++i) {
            const float x = float(i % gpu::kSparkCells) - 4, z = float(i / gpu::kSparkCells) - 4;
            record.cells[i] = {hill(x, z), hill(x + 1, z), hill(x, z + 1), hill(x + 1, z + 1)};
        }
    }
    // As the pass holds them.
    [[nodiscard]] std::vector<Spark> sparks() const {
        std::vector<Spark> out;
        gpu::SparkBounds bounds{};
        bounds.ground = {record.up.x, record.up.y, record.up.z, record.up.w};
        bounds.grid = record.grid;
        bounds.cells = record.cells;
        for (uint32_t slot = 0; slot < record.slots; ++slot) {
            Spark one;
            one.slot = slot;
            one.now = gpu::sparkSlot(record.seed, slot, record.turn, record.part);
            const float at = gpu::sparkKey(record.keyAge, one.now.age);
            const auto i = uint32_t(at);
            const gpu::vec4 key = glm::mix(record.keys[i], record.keys[i + 1], at - float(i));
            if (gpu::sparkChance(key.w, slot, one.now.seed) <= 0) continue;
            one.kind = gpu::sparkKind(one.now.seed);
            if (one.now.age >= one.kind.life) continue;
            const gpu::vec3 up(record.up), way(record.direction);
            const gpu::vec3 from =
                gpu::vec3(key) +
                gpu::sparkOff(way, record.radius, gpu::vec3(record.half_), one.now.seed);
            one.leg = gpu::sparkLeg(
                one.kind,
                gpu::sparkBorn(record, one.kind, one.now.seed, from, way, gpu::vec3(0.0f)), bounds,
                up, one.now.age);
            one.place = gpu::sparkPlace(one.leg, one.kind, bounds, up, one.now.seed, one.now.age);
            out.push_back(one);
        }
        return out;
    }

    components::FireEmitter emitter;
    components::EmitterAir air;
    gpu::SparkSource record{};
};

}  // namespace fw::test
