#include "components/fire_emitter.h"

#include "components/lights.h"
#include "components/pose.h"
#include "core/assert.h"
#include "core/error.h"
#include "shared/particle.h"

#include <algorithm>
#include <cmath>

namespace fw::components {
namespace {

using gpu::vec3;
using gpu::vec4;

constexpr float kAtOnce = 20.5f;  // particles that cover a fire at the sizes below
// Lift of flames, m/s^2, and the speed at which drag balances it, of the fire's rise. With both,
// flames reach as high as a volumetric fire's. A flame's drag follows from them.
constexpr float kFireLift = 11.45f, kFireSpeed = 0.78f;
constexpr float kStuckRates = 1.2f;  // most births from stuck fuel, of the stream's births

float length3(const float v[3]) noexcept {
    return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

void readDirection(const float given[3], const char* name, float (&out)[3]) {
    checkValues(given, 3, name, -1e6f, 1e6f);
    const float length = length3(given);
    if (!(length > 1e-6f))
        core::refuse("%s has length %g; it is at least 1e-6.", name, double(length));
    for (int i = 0; i < 3; ++i) out[i] = given[i] / length;
}

float orElse(float given, float own) noexcept { return given > 0 ? given : own; }

// A sum of slow waves without a common period, in [-1, 1].
float wave(double t, double phase) noexcept {
    return float(0.5 * std::sin(t + phase) + 0.3 * std::sin(2.27 * t + 2.1 * phase) +
                 0.2 * std::sin(4.13 * t + 5.3 * phase));
}

vec4 with(const float v[3], float w) noexcept { return {v[0], v[1], v[2], w}; }

// Factor on speed and life of flames at a share of the power (Heskestad: height scales with its
// 0.4th power). Without it, flames at low power would float far above the fire. Follows the power
// slowly, so that no existing particle gets younger.
float flameScaleOf(float share, float before, bool first, float seconds) noexcept {
    constexpr float kLeast = 0.25f, kPerSecond = 0.6f;
    const float target = std::max(std::pow(share, 0.2f), kLeast);
    const float step = kPerSecond * seconds;
    return first ? target : std::clamp(target, before - step, before + step);
}

}  // namespace

EmitterAppearance emitterAppearance(const FwFireEmitterDef& def) {
    EmitterAppearance appearance;
    const float power = std::max(def.power, 0.01f);
    const bool jet = (def.flags & FW_EMITTER_JET) != 0;
    if (jet) {
        // Tuned for 2 MW, and scaled to other powers.
        const float scale = float(std::sqrt(std::sqrt(double(power / 2000.0f))));
        appearance.diameter = 0.2f * scale;
        appearance.rate = orElse(def.rate, 160);
        appearance.speed = orElse(def.speed, 12 * std::sqrt(scale));
        appearance.cone = orElse(def.cone, 0.055f);
        appearance.life = orElse(def.life, 1.05f * std::sqrt(scale));
        appearance.dragStream = orElse(def.drag, 1.5f);
        appearance.dragTorn = 0.3f * appearance.dragStream;
        appearance.liftTorn = 11 * def.buoyancy;
        appearance.liftStream = -2.5f;
        appearance.reach = 0.62f * appearance.speed * appearance.life;
        appearance.size0 = orElse(def.size0, 0.14f * scale);
        const float size1 = std::max(orElse(def.size1, 1.75f * scale), appearance.size0);
        appearance.swell = 0.17f * (size1 - appearance.size0) / appearance.life;
        appearance.grow = 0.83f * (size1 - appearance.size0) / std::max(appearance.reach, 0.1f);
        appearance.eddies = 1.9f * std::sqrt(scale) * def.turbulence;
        appearance.eddyScale = 1.5f / scale;
        appearance.eddyDrift = 0.55f * appearance.speed;
        appearance.wander = 0.05f * def.turbulence;
        appearance.pulse = 0.12f * def.turbulence;
        appearance.stretch = 5;
    } else {
        // A pool fire: its diameter from its power or from the def (Heskestad, McCaffrey).
        const float own = std::pow(power / 1110.0f, 0.4f);
        appearance.diameter =
            std::max(def.shape == FW_EMITTER_DISC ? 2 * def.radius : 0.6f * own, 0.02f);
        const float tall = 0.235f * std::pow(power, 0.4f);
        const float height = std::max(tall - 1.02f * appearance.diameter, 0.35f * tall);
        const float rise = 1.93f * std::pow(power, 0.2f);
        appearance.liftTorn = appearance.liftStream = kFireLift * def.buoyancy;
        appearance.dragStream = appearance.dragTorn =
            orElse(def.drag, kFireSpeed * rise / kFireLift);
        appearance.speed = orElse(def.speed, 0.22f * rise);
        appearance.cone = orElse(def.cone, 0.30f);
        const float life = std::clamp(1.6f * height / (0.6f * rise), 0.25f, 3.0f);
        const float rate = 50 + 10 * std::sqrt(power / 100);
        appearance.life = orElse(def.life, life);
        appearance.rate = orElse(def.rate, rate);
        // A larger fire has more particles, each smaller for its size. All together they cover as
        // much, and shine as much, as a volumetric fire of the same power.
        const float fine = std::sqrt(kAtOnce / (rate * life));
        appearance.size0 = orElse(def.size0, fine * (0.26f * appearance.diameter + 0.04f * tall));
        const float size1 = orElse(def.size1, fine * (0.26f * appearance.diameter + 0.12f * tall));
        appearance.swell = std::max(size1 - appearance.size0, 0.0f) / appearance.life;
        appearance.eddies = 0.16f * rise * def.turbulence;
        appearance.eddyScale = 1.6f / std::max(0.45f * tall, 0.03f);
        appearance.eddyDrift = 0.5f * rise;
        appearance.stretch = 2.2f;
        appearance.kelvin0 = 1522;
        appearance.kelvin1 = 1302;
        appearance.reach = height;
    }
    if (def.temperature > 0) {
        appearance.kelvin1 += def.temperature - appearance.kelvin0;
        appearance.kelvin0 = def.temperature;
    }
    return appearance;
}

void makeFireEmitter(const FwFireEmitterDef& def, uint32_t ownSeed, FireEmitter& emitter) {
    constexpr uint32_t kKnown = FW_EMITTER_HIDDEN | FW_EMITTER_NO_SMOKE | FW_EMITTER_NO_LIGHT |
                                FW_EMITTER_GROUND | FW_EMITTER_JET | FW_EMITTER_IGNITES |
                                FW_EMITTER_NO_COLLISION;
    checkFlags(def.flags, "FwFireEmitterDef::flags", kKnown);
    checkWhole(def.shape, "FwFireEmitterDef::shape", 0, FW_EMITTER_MESH);
    checkWhole(def.reserved, "FwFireEmitterDef::reserved", 0, 0);
    checkWhole(def.maxParticles, "FwFireEmitterDef::maxParticles", 0, 1u << 20);
    checkLengths(def.position, 3, "FwFireEmitterDef::position", -1e6f, 1e6f);
    float direction[3];
    readDirection(def.direction, "FwFireEmitterDef::direction", direction);
    checkLengths(def.extent, 3, "FwFireEmitterDef::extent", -100.0f, 100.0f);
    checkLength(def.radius, "FwFireEmitterDef::radius", 0.0f, 50.0f);
    checkValue(def.power, "FwFireEmitterDef::power", 0.0f, kMaxPower);
    checkValue(def.rate, "FwFireEmitterDef::rate", 0.0f, 200000.0f);
    checkLength(def.speed, "FwFireEmitterDef::speed", 0.0f, 200.0f);
    checkValue(def.cone, "FwFireEmitterDef::cone", 0.0f, 2.0f);
    checkLength(def.size0, "FwFireEmitterDef::size0", 0.0f, 50.0f);
    checkLength(def.size1, "FwFireEmitterDef::size1", 0.0f, 50.0f);
    checkValue(def.life, "FwFireEmitterDef::life", 0.0f, 60.0f);
    checkValue(def.lifeVariance, "FwFireEmitterDef::lifeVariance", 0.0f, 1.0f);
    checkValue(def.drag, "FwFireEmitterDef::drag", 0.0f, 60.0f);
    checkValue(def.buoyancy, "FwFireEmitterDef::buoyancy", -4.0f, 4.0f);
    checkValue(def.windResponse, "FwFireEmitterDef::windResponse", 0.0f, 4.0f);
    checkValue(def.turbulence, "FwFireEmitterDef::turbulence", 0.0f, 4.0f);
    checkValue(def.inherit, "FwFireEmitterDef::inherit", 0.0f, 1.0f);
    checkValue(def.smoke, "FwFireEmitterDef::smoke", 0.0f, 1.0f);
    checkValue(def.smokeLife, "FwFireEmitterDef::smokeLife", 0.0f, 20.0f);
    checkValue(def.smokeDensity, "FwFireEmitterDef::smokeDensity", 0.0f, 4.0f);
    checkValue(def.sparks, "FwFireEmitterDef::sparks", 0.0f, 1.0f);
    checkValue(def.temperature, "FwFireEmitterDef::temperature", 0.0f, 2500.0f);
    checkLength(def.ground, "FwFireEmitterDef::ground", -1e6f, 1e6f);
    checkLength(def.behind, "FwFireEmitterDef::behind", 0.0f, 10.0f);
    checkValue(def.heat, "FwFireEmitterDef::heat", 0.0f, 1.0f);
    checkValue(def.stick, "FwFireEmitterDef::stick", 0.0f, 1.0f);
    checkValue(def.stickTime, "FwFireEmitterDef::stickTime", 0.125f, 120.0f);
    if (def.shape == FW_EMITTER_MESH && (def.flags & FW_EMITTER_JET))
        core::refuse(
            "FwFireEmitterDef::shape is FW_EMITTER_MESH and FwFireEmitterDef::flags is "
            "0x%x; FW_EMITTER_JET goes with the other shapes.",
            def.flags);
    if ((def.flags & FW_EMITTER_IGNITES) && !isSwept(def))
        core::refuse(
            "FwFireEmitterDef::flags is 0x%x; FW_EMITTER_IGNITES goes with FW_EMITTER_JET and "
            "without FW_EMITTER_NO_COLLISION.",
            def.flags);
    if (def.stick > 0 && !(def.flags & FW_EMITTER_IGNITES))
        core::refuse(
            "FwFireEmitterDef::stick is %g and FwFireEmitterDef::flags is 0x%x; fuel sticks "
            "with FW_EMITTER_IGNITES alone.",
            double(def.stick), def.flags);
    emitter.def = def;
    emitter.seed = def.seed ? def.seed : ownSeed;
    std::copy_n(def.position, 3, emitter.position);
    std::copy_n(direction, 3, emitter.direction);
    emitter.appearance = emitterAppearance(def);
}

void moveFireEmitter(FireEmitter& emitter, const float position[3], const float* direction) {
    checkLengths(position, 3, "position", -1e6f, 1e6f);
    float turned[3];
    std::copy_n(emitter.direction, 3, turned);
    if (direction) readDirection(direction, "direction", turned);
    std::copy_n(position, 3, emitter.position);
    std::copy_n(turned, 3, emitter.direction);
}

void setEmitterPower(FireEmitter& emitter, float power) {
    checkValue(power, "power", 0.0f, kMaxPower);
    emitter.def.power = power;
    if (power > 0)
        emitter.appearance = emitterAppearance(emitter.def);  // at 0, flying particles keep theirs
}

void setJetObstacle(FireEmitter& emitter, uint32_t i, const JetObstacle& obstacle,
                    double now) noexcept {
    FW_ASSERT(i < kJetRays, "ray %u", i);
    JetObstacle& has = emitter.obstacles[i];
    float apart = 0;
    for (int k = 0; k < 3; ++k)
        apart += (has.place[k] - obstacle.place[k]) * (has.place[k] - obstacle.place[k]);
    if (has.met && (!obstacle.met || apart > 0.16f)) {
        JetObstacle& last = emitter.lastObstacles[emitter.nextLast++ % kJetRays];
        last = has;
        last.until = now + 0.8;
    }
    has = obstacle;
}

float longestParticleLife(const FireEmitter& emitter) {
    const FwFireEmitterDef& def = emitter.def;
    FW_ASSERT(emitter.appearance.life > 0, "%g s", double(emitter.appearance.life));
    const float fire = emitter.appearance.life * (1 + 1.55f * def.lifeVariance);
    const bool smokes = def.smoke > 0 && !(def.flags & FW_EMITTER_NO_SMOKE);
    return fire * (smokes ? 1 + def.smokeLife : 1.0f);
}

uint32_t particlesNeeded(const FireEmitter& emitter) {
    if (emitter.def.maxParticles) return emitter.def.maxParticles;
    const float stuck = emitter.def.stick > 0 ? kStuckRates : 0.0f;
    const double needed =
        double(emitter.appearance.rate) * double(1 + stuck) * double(longestParticleLife(emitter)) +
        4;
    return uint32_t(std::min(needed, 4e9));
}

namespace {

// Writes the patches of stuck fuel to the record. Returns their births per second.
float stuckBirths(const FireEmitter& emitter, gpu::ParticleEmitter& record) noexcept {
    record = {};
    if (!emitter.stream) return 0;
    float births[kJetPatches] = {}, sum = 0;
    uint32_t count = 0;
    for (const JetPatch& patch : emitter.stream->patches) {
        if (patch.left == 0 || patch.power == 0) continue;
        const float watts = float(double(patch.power) * 1e-9);
        FW_ASSERT(count < kJetPatches, "patch %u", count);
        births[count] = 22 * std::clamp(std::sqrt(watts / 20000), 0.15f, 1.5f);
        sum += births[count];
        record.patches[2 * count] = with(patch.place, sum);
        record.patches[2 * count + 1] = with(patch.normal, 0);
        ++count;
    }
    if (count == 0) return 0;
    for (uint32_t i = 0; i < count; ++i) record.patches[2 * i].w /= sum;
    record.stuck.y = float(count);
    return std::min(sum, kStuckRates * emitter.appearance.rate);
}

struct FrameOfEmitter {
    float seconds = 0;      // s
    float from[3] = {};     // m, place at the frame's start
    float carried[3] = {};  // m/s, inherited speed
    double rate = 0;        // 1/s
    float stuckRate = 0;    // 1/s
    uint32_t fresh = 0;     // births
    bool burns = false;     // births go on
};

// The emitter's path in the frame.
FrameOfEmitter followEmitter(FireEmitter& emitter, float frame) noexcept {
    const FwFireEmitterDef& def = emitter.def;
    FireEmitter::Births& births = emitter.next;
    FrameOfEmitter f;
    f.seconds = births.warms ? std::max(frame, longestParticleLife(emitter)) : frame;
    births.warms = false;
    if (!births.placed) std::copy_n(emitter.position, 3, births.position);
    float moved[3];
    for (int i = 0; i < 3; ++i) {
        f.from[i] = births.position[i];
        moved[i] = emitter.position[i] - f.from[i];
    }
    const bool flew = f.seconds > 0 && length3(moved) <= kTeleport * f.seconds;
    const float carry = flew && def.shape != FW_EMITTER_MESH ? def.inherit / f.seconds : 0;
    for (int i = 0; i < 3; ++i) f.carried[i] = moved[i] * carry;
    if (!flew) std::copy_n(emitter.position, 3, f.from);
    std::copy_n(emitter.position, 3, births.position);
    births.placed = true;
    return f;
}

// Births of the frame into `next` and `f`.
void countBirths(FireEmitter& emitter, double now, FrameOfEmitter& f) noexcept {
    const FwFireEmitterDef& def = emitter.def;
    FireEmitter::Births& births = emitter.next;
    FW_ASSERT(emitter.ring > 0 && births.filled <= emitter.ring, "%u of %u particles",
              births.filled, emitter.ring);
    const bool flows = def.power > 0 && emitter.share > 0;
    f.burns = flows || f.stuckRate > 0;
    if (def.shape == FW_EMITTER_MESH && flows)
        births.vigour = flameScaleOf(emitter.share, births.vigour, births.filled == 0, f.seconds);
    // Shorter lives and as many more births keep the same number of particles.
    const double stream =
        flows ? double(emitter.appearance.rate) * double(emitter.share / births.vigour) : 0.0;
    f.rate = std::max(stream + double(f.stuckRate), 1e-3);
    if (f.burns) {
        const double sum = births.part + f.rate * double(f.seconds), whole = std::floor(sum);
        births.part = sum - whole;
        f.fresh = uint32_t(std::min(whole, double(emitter.ring)));
    }
    FW_ASSERT(births.part >= 0 && births.part < 1, "part %g", births.part);
    births.head = (births.head + f.fresh) % emitter.ring;
    births.filled = std::min(births.filled + f.fresh, emitter.ring);
    births.serial += f.fresh;
    if (f.fresh > 0) births.last = now;
    if (births.filled > 0 && now - births.last > double(longestParticleLife(emitter)) + 0.1)
        births.filled = 0;
}

// The discs that stop a jet.
void writeObstacles(const FireEmitter& emitter, double now, gpu::ParticleEmitter& record) noexcept {
    const auto add = [&](const JetObstacle& obstacle) {
        FW_ASSERT(2 * record.obstacleCount + 1 < std::size(record.obstacles), "%u discs",
                  record.obstacleCount);
        record.obstacles[2 * record.obstacleCount] = with(obstacle.place, obstacle.radius);
        record.obstacles[2 * record.obstacleCount + 1] = with(obstacle.normal, 0);
        ++record.obstacleCount;
    };
    for (const JetObstacle& obstacle : emitter.obstacles)
        if (obstacle.met) add(obstacle);
    for (const JetObstacle& obstacle : emitter.lastObstacles)
        if (obstacle.met && obstacle.until > now) add(obstacle);
}

}  // namespace

bool advanceEmitter(FireEmitter& emitter, const EmitterAir& air, float frame,
                    gpu::ParticleEmitter& record) noexcept {
    const FwFireEmitterDef& def = emitter.def;
    const EmitterAppearance& appearance = emitter.appearance;
    FireEmitter::Births& births = emitter.next;
    births = emitter.births;
    FrameOfEmitter f = followEmitter(emitter, frame);
    f.stuckRate = stuckBirths(emitter, record);
    countBirths(emitter, air.now, f);
    if (births.filled == 0) return false;

    FW_ASSERT(births.filled <= emitter.ring && births.head < emitter.ring && births.vigour > 0,
              "%u of %u particles", births.filled, emitter.ring);
    const bool onMesh = def.shape == FW_EMITTER_MESH;
    const bool smokes = !(def.flags & FW_EMITTER_NO_SMOKE);
    const float vigour = births.vigour, seconds = f.seconds;
    const double rate = f.rate;
    const float wind[3] = {air.wind[0] * def.windResponse, air.wind[1] * def.windResponse,
                           air.wind[2] * def.windResponse};
    const float none[3] = {};
    record.stuck.x = f.stuckRate / float(rate);
    record.from = with(f.from, seconds);
    // Quads born at a disc's edge reach to the edge, not beyond.
    const float disc = std::max(def.radius - 0.4f * appearance.size0, 0.5f * def.radius);
    record.place =
        with(emitter.position, def.shape == FW_EMITTER_DISC   ? disc
                               : (def.flags & FW_EMITTER_JET) ? 0.1f * appearance.size0
                                                              : 0.2f * appearance.diameter);
    if (onMesh) record.place = record.from = vec4(0, 0, 0, 0);  // the device has its tiles
    record.from.w = seconds;
    record.object = onMesh ? def.object.index1 : 0;
    record.direction = with(emitter.direction, appearance.cone);
    record.half_ = with(def.shape == FW_EMITTER_LINE ? def.extent : none, appearance.speed);
    record.carried = with(f.carried, def.ground);
    // The clock wraps: the sum over many ages hides it.
    record.wind = with(wind, float(std::fmod(air.now, 1024.0)));
    record.up = with(air.up, appearance.pulse);
    record.motion = {vigour * appearance.dragStream, vigour * appearance.dragTorn,
                     appearance.liftTorn, appearance.liftStream};
    record.turbulence = {appearance.eddies, appearance.eddyScale, appearance.eddyDrift,
                         appearance.wander};
    record.size = {appearance.size0, appearance.grow, appearance.swell, appearance.stretch};
    // Smoke lasts as long at any vigour; more puffs are thinner.
    record.life = {vigour * appearance.life, def.lifeVariance, def.smokeLife / vigour,
                   smokes ? def.smoke : 0.0f};
    record.heat = {appearance.kelvin0, appearance.kelvin1, vigour * def.smokeDensity, 0};
    record.first = emitter.first;
    record.ring = emitter.ring;
    record.head = births.head;
    record.filled = births.filled;
    record.fresh = f.fresh;
    record.serial = births.serial;
    record.apart = float(1.0 / rate);
    record.age = f.burns ? float(births.part / rate) : 0.0f;
    record.seed = emitter.seed;
    record.fireFlipbooks = emitter.flipbooks.fire;
    record.smokeFlipbooks = emitter.flipbooks.other;
    record.flags = ((def.flags & FW_EMITTER_HIDDEN) ? gpu::kEmitterHidden : 0u) |
                   ((def.flags & FW_EMITTER_GROUND) ? gpu::kEmitterGround : 0u) |
                   ((def.flags & FW_EMITTER_JET) ? gpu::kEmitterJet : 0u) |
                   (emitter.flipbooks.fireEmits ? gpu::kEmitterEmits : 0u);
    if (isSwept(def)) writeObstacles(emitter, air.now, record);
    // Waves of the stream at the frame's start and now: births lie between.
    const double phase = double(emitter.seed & 1023u) * 0.137;
    const auto waves = [&](double t) {
        return vec4(appearance.wander * wave(9 * t, phase),
                    appearance.wander * wave(9 * t, phase + 3.3),
                    appearance.pulse * wave(23 * t, phase + 1.7), 0);
    };
    record.waves0 = waves(air.now - double(seconds));
    record.waves1 = waves(air.now);
    record.steps =
        std::min(uint32_t(std::ceil(seconds / gpu::kMaxParticleStep)), gpu::kMaxParticleSteps);
    return true;
}

FwLight emitterLight(const FireEmitter& emitter, const EmitterAir& air, uint32_t id,
                     uint64_t frameIndex) noexcept {
    const EmitterAppearance& appearance = emitter.appearance;
    FwLight light{};
    const bool jet = (emitter.def.flags & FW_EMITTER_JET) != 0;
    // The middle of the flames, and a later part of a jet.
    const float along = jet ? 0.6f * appearance.reach : 0.15f * appearance.reach;
    for (int i = 0; i < 3; ++i)
        light.position[i] = emitter.position[i] + emitter.direction[i] * along +
                            (jet ? 0.0f : air.up[i] * 0.35f * appearance.reach);
    light.color[0] = 1.717f;
    light.color[1] = 0.858f;
    light.color[2] = 0.292f;
    light.radius = std::max(0.5f * appearance.diameter, 0.25f * appearance.reach);
    const double phase = double(emitter.seed & 1023u) * 0.137;
    // The light fades with the last particles.
    const double since = air.now - emitter.births.last - 0.1;
    const auto left = float(std::clamp(1.0 - since / double(appearance.life), 0.0, 1.0));
    light.power = 1000.0f * emitter.def.power;
    const float shines = flicker(air.now, phase);
    light.intensity = light.power * (kLightShare / kSphere) * shines * left;
    // A jet without power shines from its stuck fuel.
    if (emitter.stream && !(emitter.def.power > 0)) {
        double sum = 0, at[3] = {};
        for (const JetPatch& patch : emitter.stream->patches) {
            const double watts = patch.left > 0 ? double(patch.power) * 1e-9 : 0;
            sum += watts;
            for (int i = 0; i < 3; ++i)
                at[i] += watts * double(patch.place[i] + 0.3f * air.up[i] + 0.2f * patch.normal[i]);
        }
        if (sum > 0) {
            for (int i = 0; i < 3; ++i) light.position[i] = float(at[i] / sum);
            light.power = float(sum);
            light.intensity = light.power * (kLightShare / kSphere) * shines;
        }
    }
    light.id = id;
    light.frameIndex = frameIndex;
    return light;
}

void fillEmitterState(const FireEmitter& emitter, const EmitterAir& air,
                      FwFireEmitterState& out) noexcept {
    const EmitterAppearance& appearance = emitter.appearance;
    const FwLight light = emitterLight(emitter, air, 0, 0);
    out.particles = emitter.births.filled;
    out.capacity = emitter.ring;
    out.userData = emitter.def.userData;
    out.power = emitter.def.power;
    out.rate = appearance.rate;
    out.life = appearance.life;
    out.speed = appearance.speed;
    out.reach = appearance.reach;
    out.blockedRays = isSwept(emitter.def) ? emitter.blockedRays : 0;
    out.clearDistance =
        isSwept(emitter.def) && emitter.blockedRays > 0 ? emitter.clearDistance : appearance.reach;
    out.heated = emitter.heated;
    if (emitter.stream) {
        double fuel = 0, power = 0;
        for (const JetPatch& patch : emitter.stream->patches) {
            fuel += double(patch.fuel);
            power += double(patch.power);
            out.stuckPatches += patch.left > 0 ? 1u : 0u;
        }
        out.stuckFuel = float(fuel / double(kPatchUnitsPerJoule) * 1e-3);
        out.stuckPower = float(power * 1e-12);
    }
    out.lightIntensity = emitter.births.filled > 0 ? light.intensity : 0.0f;
    for (int i = 0; i < 3; ++i) out.lightPosition[i] = light.position[i];
}

}  // namespace fw::components
