// A fire emitter as plain data: its checked def, the particle parameters that follow from its
// power, and its record per frame for the device. Counts births, touches no particle. Cosmetic.
#pragma once
#include "components/jet.h"
#include "core/owned.h"
#include "flamewright/flamewright.h"

#include <array>
#include <cstdint>

namespace fw::gpu {
struct ParticleEmitter;  // shared/particle.h
}

namespace fw::components {

// Parameters of the particles, from the def or else from its power.
struct EmitterAppearance {
    float diameter = 0.3f;                                  // m, of the fire
    float rate = 30, speed = 1, cone = 0.3f;                // 1/s, m/s, rad
    float size0 = 0.1f, grow = 0, swell = 0;                // m; per m of path; m/s
    float life = 0.7f, dragStream = 0.5f, dragTorn = 0.5f;  // s
    float liftTorn = 11, liftStream = 11;                   // m/s^2
    float eddies = 1, eddyScale = 1, eddyDrift = 1;         // m/s, 1/m, m/s
    float wander = 0, pulse = 0, stretch = 1;               // rad; shares
    float kelvin0 = 1560, kelvin1 = 1330;
    float reach = 1;  // m, about how far particles fly
};

// A disc that a jet's particles do not pass.
struct JetObstacle {
    bool met = false;
    float place[3] = {}, normal[3] = {}, radius = 0;  // m
    double until = 0;                                 // s; end of a disc that no ray strikes now
};

struct JetHole {
    FwBurnableMeshId object{};  // null: none
    uint32_t texel = 0;
};

// An object without its own heat under a jet.
struct JetTouch {
    FwBurnableMeshId object{};
    uint64_t since = 0;  // tick
    bool seen = false;   // in this exchange

    template <class A>
    void serialize(A& a) {
        a.object("a jet", object);
        if (object.index1 != 0) a(since, seen);
    }
};

struct EmitterAir {
    float wind[3] = {}, up[3] = {0, 1, 0};
    double now = 0;  // s
};

struct EmitterFlipbooks {
    uint32_t fire = 0, other = 0;  // see ParticleEmitter
    uint32_t spark = 0;            // see SparkSource
    bool fireEmits = false;        // has flipbooks of fire, and none of them absorbs light
};

// Places and spark rates of the emitter at steps of the clock, latest first.
constexpr uint32_t kSparkNotes = 11;
struct SparkHistory {
    std::array<std::array<float, 4>, kSparkNotes> notes{};  // m, 1/s
    int64_t step = 0;                                       // of notes[0]
    bool begun = false;
};

constexpr float kTeleport = 100;  // m/s; a faster move is a teleport

struct FireEmitter {
    FwFireEmitterDef def{};
    EmitterAppearance appearance;
    EmitterFlipbooks flipbooks;
    float share = 1;  // of its births; on a mesh, the burning share of it
    uint32_t seed = 0;
    uint32_t first = 0, ring = 0;  // its range of the world's particles
    float position[3] = {}, direction[3] = {0, 1, 0};
    // Of a jet, as of its last sweep.
    JetHits hits{};
    uint64_t swept = 0;                     // the world's frame of that sweep
    std::array<JetHole, kJetRays> holes{};  // as of the last readback; cosmetic
    std::array<JetObstacle, kJetRays> obstacles{}, lastObstacles{};
    uint32_t nextLast = 0;
    uint32_t blockedRays = 0;  // rays that an obstacle stopped
    float clearDistance = 0;   // m to the nearest obstacle
    float heated = 0;          // W that reached burnable meshes at the last exchange
    std::array<JetTouch, 8> touches{};
    core::Owned<JetStream> stream;  // of an emitter that ignites
    // As of the last frame.
    struct Births {
        float position[3] = {};
        double part = 0;  // of the next birth, [0, 1)
        uint32_t head = 0, filled = 0, serial = 0;
        double last = -1e9;  // s of the last birth
        float vigour = 1;    // on a mesh: factor on flames' speed and life, 1 if all of it burns
        bool placed = false;
        bool warms = false;  // the next frame makes all particles that would fly by then
        SparkHistory sparks;
    } births, next;
};

// Throw core::Error if a value is out of its limits, and then change nothing.
void makeFireEmitter(const FwFireEmitterDef& def, uint32_t ownSeed, FireEmitter& emitter);
void moveFireEmitter(FireEmitter& emitter, const float position[3], const float* direction);
void setEmitterPower(FireEmitter& emitter, float power);
// Whether obstacles may stop it.
inline bool isSwept(const FwFireEmitterDef& def) noexcept {
    return (def.flags & FW_EMITTER_JET) && !(def.flags & FW_EMITTER_NO_COLLISION);
}
// Sets the disc that ray `i` strikes; the disc before it still stops particles on their way there.
void setJetObstacle(FireEmitter& emitter, uint32_t i, const JetObstacle& obstacle,
                    double now) noexcept;
EmitterAppearance emitterAppearance(const FwFireEmitterDef& def);
// Particles that the emitter needs at its power; s that a particle lasts at most.
uint32_t particlesNeeded(const FireEmitter& emitter);
float longestParticleLife(const FireEmitter& emitter);
// Computes the next frame, of `frame` seconds, into `next` and the record. False: no particle is
// left.
bool advanceEmitter(FireEmitter& emitter, const EmitterAir& air, float frame,
                    gpu::ParticleEmitter& record) noexcept;
inline void commitEmitter(FireEmitter& emitter) noexcept { emitter.births = emitter.next; }
FwLight emitterLight(const FireEmitter& emitter, const EmitterAir& air, uint32_t id,
                     uint64_t frameIndex) noexcept;
void fillEmitterState(const FireEmitter& emitter, const EmitterAir& air,
                      FwFireEmitterState& out) noexcept;

}  // namespace fw::components
