// A fire emitter as plain data: what the host asked for, checked; what its power makes of the rest;
// and its frames as the device gets them. Counts births, never touches a particle. Looks alone.
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

// What particles are like, all of it known: of the def, or of its power.
struct EmitterLook {
    float diameter = 0.3f;                                  // m, of the fire
    float rate = 30, speed = 1, cone = 0.3f;                // 1/s, m/s, rad
    float size0 = 0.1f, grow = 0, swell = 0;                // m; per m of path; m/s
    float life = 0.7f, dragStream = 0.5f, dragTorn = 0.5f;  // s
    float liftTorn = 11, liftStream = 11;                   // m/s^2
    float eddies = 1, eddyScale = 1, eddyDrift = 1;         // m/s, 1/m, m/s
    float wander = 0, pulse = 0, stretch = 1;               // rad; shares
    float kelvin0 = 1560, kelvin1 = 1330;
    float reach = 1;  // m that particles come, about
};

// Where a jet is stopped: a disc that particles do not pass.
struct JetShield {
    bool met = false;
    float place[3] = {}, normal[3] = {}, radius = 0;  // m
    double until = 0;                                 // s; of one that a ray no longer strikes
};

struct JetHole {
    FwBurnableMeshId object{};  // null: none
    uint32_t texel = 0;
};

// An object without heat of its own under a jet.
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

struct EmitterBooks {
    uint32_t fire = 0, other = 0;  // as ParticleEmitter has them
    uint32_t spark = 0;            // as SparkSource
    bool fireEmits = false;        // books of fire are given, and none of them hides anything
};

// Where it was and how many sparks a second it threw there, at steps of the clock, the last first.
constexpr uint32_t kSparkNotes = 11;
struct SparkHistory {
    std::array<std::array<float, 4>, kSparkNotes> notes{};  // m, 1/s
    int64_t step = 0;                                       // of the last
    bool begun = false;
};

constexpr float kTeleport = 100;  // m/s: what is faster was put there, it did not fly

struct FireEmitter {
    FwFireEmitterDef def{};
    EmitterLook look;
    EmitterBooks books;
    float share = 1;  // of its births: of a mesh, by what burns there
    uint32_t seed = 0;
    uint32_t first = 0, ring = 0;  // particles of the world's
    float position[3] = {}, direction[3] = {0, 1, 0};
    // Of a jet, as it was last swept: in frame `swept` of the world's.
    JetHits hits{};
    uint64_t swept = 0;
    std::array<JetHole, kJetRays> holes{};  // as of the last readback: for what is seen alone
    std::array<JetShield, kJetRays> shields{}, lastShields{};
    uint32_t nextLast = 0;
    uint32_t struck = 0;  // rays that something stopped
    float freeWay = 0;    // m to the nearest of it
    float heated = 0;     // W that reached burnable meshes at the last exchange
    std::array<JetTouch, 8> touches{};
    core::Owned<JetStream> stream;  // of what ignites
    // As of the last frame.
    struct Births {
        float position[3] = {};
        double part = 0;  // of the next birth, [0, 1)
        uint32_t head = 0, filled = 0, serial = 0;
        double last = -1e9;  // s of the last birth
        float vigour = 1;    // of a mesh: how fast its fire rises and for how long, of all burning
        bool placed = false;
        bool warms = false;  // its next frame makes all that would fly by then
        SparkHistory sparks;
    } births, next;
};

// Throw where a value is out of its limits, and then changed nothing.
void makeFireEmitter(const FwFireEmitterDef& def, uint32_t ownSeed, FireEmitter& emitter);
void moveFireEmitter(FireEmitter& emitter, const float position[3], const float* direction);
void setEmitterPower(FireEmitter& emitter, float power);
// Whether something may stop it.
inline bool isSwept(const FwFireEmitterDef& def) noexcept {
    return (def.flags & FW_EMITTER_JET) && !(def.flags & FW_EMITTER_NO_COLLISION);
}
// What ray `i` strikes now; what it struck before still stops what is on its way there.
void takeShield(FireEmitter& emitter, uint32_t i, const JetShield& shield, double now) noexcept;
EmitterLook emitterLook(const FwFireEmitterDef& def);
// Particles that it needs at its power, and s that one of them lasts at most.
uint32_t emitterNeeds(const FireEmitter& emitter);
float emitterLasts(const FireEmitter& emitter);
// Its next frame, of so many seconds, into `next` and the record. False: nothing of it is left to
// show.
bool advanceEmitter(FireEmitter& emitter, const EmitterAir& air, float frame,
                    gpu::ParticleEmitter& record) noexcept;
inline void commitEmitter(FireEmitter& emitter) noexcept { emitter.births = emitter.next; }
FwLight emitterLight(const FireEmitter& emitter, const EmitterAir& air, uint32_t id,
                     uint64_t frameIndex) noexcept;
void fillEmitterState(const FireEmitter& emitter, const EmitterAir& air,
                      FwFireEmitterState& out) noexcept;

}  // namespace fw::components
