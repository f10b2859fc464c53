// Gas particles of a curve. Speeds are McCaffrey's; leaning, straying and touching are on top.
#include "volume/motion.h"

#include "core/assert.h"
#include "core/hash.h"

#include <algorithm>
#include <cmath>

namespace fw::volume {
namespace {

constexpr float kStrayTime = 0.12f;  // s
constexpr float kTwoPi = 6.2831853f;
constexpr float kMargin = 0.05f;  // distance of gas from a surface, of the diameter
constexpr float kJet = 0.75f;     // share of its speed that gas keeps along a wall

float unitHash(uint32_t x) noexcept { return float(core::hash32(x) >> 8) / 16777216.0f; }

float speedAt(const MotionRules& r, float risen) noexcept {
    return 6.84f * std::sqrt(std::clamp(risen, 0.0f, r.tauFree) + r.tauStart);
}

// s from the base to the top.
float lifeOf(const MotionRules& r) noexcept {
    return std::max(1.15f * gpu::flameTau(r.top, r.tauStart, r.tauFree), 16.0f * kMotionStep);
}

// Time constant of gas following the wind: they mix across the fire's width.
float dragTime(const MotionRules& r) noexcept {
    return std::max(0.15f * std::sqrt(r.size.diameter), 0.02f);
}

// Wind cools and slows rising gas.
float windLift(const MotionRules& r, float wind) noexcept {
    const float fuel = r.size.power / (15000.0f * 0.785f * r.size.diameter);  // kg/(m s), m'' D
    const float scale = std::cbrt(9.81f * std::max(fuel, 1e-6f) / 1.2f);
    return 1.0f / (1.0f + 0.06f * wind / scale);
}

CurveParticle born(const FlameMotion& m, const MotionRules& r, uint32_t number) noexcept {
    CurveParticle p;
    p.position = m.base;
    p.velocity = r.up * speedAt(r, 0.0f) + 0.5f * m.baseVelocity;
    p.bulge = float(std::sin(double(kTwoPi) * m.phase));
    p.number = number;
    return p;
}

void collide(CurveParticle& p, const MotionRules& r, std::span<const Collider> colliders) noexcept {
    p.touches = false;
    const float margin = kMargin * r.size.diameter;
    const Surface s = nearestSurface(colliders, p.position);
    if (s.distance >= margin) return;
    p.position += s.normal * (margin - s.distance);
    const float into = glm::dot(p.velocity, s.normal);
    if (into >= 0.0f) return;
    const float speed = glm::length(p.velocity);
    vec3 slide = p.velocity - s.normal * into;
    float l = glm::length(slide);
    if (l < 0.05f * speed) {  // head on: particles turn aside, neighbours in similar directions
        const float a = kTwoPi * (unitHash(r.seed) + 0.06f * float(p.number));
        const vec3 u = anyNormalTo(s.normal);
        slide += 0.05f * speed * (std::cos(a) * u + std::sin(a) * glm::cross(s.normal, u));
        l = glm::length(slide);
    }
    p.velocity = slide * (std::max(l, kJet * speed) / std::max(l, 1e-6f));
    p.stray -= s.normal * std::min(glm::dot(p.stray, s.normal), 0.0f);
    p.touches = true;
}

void step(FlameMotion& m, const MotionRules& r, std::span<const Collider> colliders,
          float dt) noexcept {
    const vec3 acrossWind = r.wind - r.up * glm::dot(r.wind, r.up);
    const float lift = windLift(r, glm::length(acrossWind));
    const float lean = 1.0f - std::exp(-dt / dragTime(r)),
                stray = 1.0f - std::exp(-dt / kStrayTime);
    const float cooling = std::max(r.size.height, 1e-3f) / std::max(speedAt(r, r.tauFree), 0.1f);
    const float most = speedAt(r, r.tauFree);
    for (uint32_t k = 0; k < m.count; ++k) {
        CurveParticle& p = m.particles[k];
        const float rise = glm::dot(p.velocity, r.up);
        vec3 across = p.velocity - r.up * rise;
        // Half the square of 6.84: the acceleration of 6.84 sqrt(z).
        const float faster = std::min(rise + 23.4f * lift * dt, std::max(most, rise));
        if (!p.touches) across += (acrossWind - across) * lean;
        p.velocity = r.up * faster + across;
        // Hot, fast gas strays most; particles close behind stray similarly.
        const float heat = std::exp(-0.5f * p.age / std::max(cooling, 1e-3f));
        const float place = 0.35f * float(p.number & 0xFFFFu), when = p.age / (2.0f * kStrayTime);
        const float seed = 97.0f * unitHash(r.seed);
        const float a = gpu::flameNoise(vec3(place, when, seed)),
                    b = gpu::flameNoise(vec3(place + 57.7f, when, seed));
        const vec3 u = anyNormalTo(r.up);
        const vec3 aim =
            (r.dispersion * heat * std::abs(faster)) * (a * u + b * glm::cross(r.up, u));
        p.stray += (aim - p.stray) * stray;
        const vec3 before = p.position;
        p.position += (p.velocity + p.stray + r.pull) * dt;
        p.age += dt;
        collide(p, r, colliders);
        p.risen += glm::length(p.position - before);
    }
}

// Gas reaches a wall in puffs: reports the mean over one puff, 0 from one puff after the last touch
// on. `passed`: puffs since the last call.
void meanContact(FlameMotion& m, float power, float passed) noexcept {
    FW_ASSERT(m.phase >= 0 && m.phase < 1, "phase %g", m.phase);
    const int end = int(m.phase * double(kPulseParts));
    const int parts = std::min(int(passed * float(kPulseParts)) + 1, int(kPulseParts));
    for (int k = 0; k < parts; ++k)
        m.contacts[size_t(end - k + int(kPulseParts)) % kPulseParts] = power;
    float sum = 0.0f;
    for (const float part : m.contacts) sum += part;
    m.contactPower = sum / float(kPulseParts);
    FW_ASSERT(power >= 0 && sum >= 0, "%g kW", double(power));
}

void spawn(FlameMotion& m, const MotionRules& r, float age) noexcept {
    const uint32_t room = kMotionParticles - 1;
    FW_ASSERT(m.count <= kMotionParticles, "%u particles", m.count);
    m.count = std::min(m.count, room);
    std::copy_backward(m.particles.begin(), m.particles.begin() + m.count,
                       m.particles.begin() + m.count + 1);
    m.particles[0] = born(m, r, m.spawned++);
    m.particles[0].age = age;
    ++m.count;
}

}  // namespace

void startMotion(FlameMotion& m, const MotionRules& r, vec3 base) noexcept {
    m = {};
    m.base = base;
    m.radius = 0.5f * r.size.diameter;
    m.phase = double(unitHash(r.seed ^ 0x9e3779b9u));
    const double warm = 2.0 * double(lifeOf(r));
    for (double t = 0.0; t < warm; t += double(kMotionStep))
        advanceMotion(m, r, base, {}, double(kMotionStep));
}

void carryMotion(FlameMotion& m, vec3 by) noexcept {
    m.base += by;
    for (uint32_t k = 0; k < m.count; ++k) m.particles[k].position += by;
    m.contact += by;
}

void advanceMotion(FlameMotion& m, const MotionRules& r, vec3 base,
                   std::span<const Collider> colliders, double seconds) noexcept {
    const double dt = double(kMotionStep);
    FW_ASSERT(r.burn > 0 && r.size.diameter > 0, "burn %g, %g m", double(r.burn),
              double(r.size.diameter));
    m.leftover = std::min(m.leftover + std::max(seconds, 0.0) * double(r.burn),
                          dt * (kMaxMotionSteps + 0.5));
    const uint32_t steps = uint32_t(m.leftover / dt);
    const vec3 from = m.base;
    if (seconds > 0.0) {
        const vec3 speed = (base - from) / float(seconds);
        m.baseVelocity = glm::length(speed) <= kTeleport ? speed : vec3(0.0f);
    }
    FW_ASSERT(steps <= kMaxMotionSteps, "%u steps", steps);
    const float life = lifeOf(r);
    const double interval = double(life / float(kMotionPieces));
    for (uint32_t k = 0; k < steps; ++k) {
        m.base = glm::mix(from, base, float(k + 1) / float(steps));
        m.phase += double(puffFrequency(r.size.diameter)) * dt / double(r.burn);
        m.phase -= std::floor(m.phase);
        step(m, r, colliders, kMotionStep);
        m.sinceSpawn += dt;
        if (m.sinceSpawn >= interval) {
            m.sinceSpawn = std::min(m.sinceSpawn - interval, interval);
            spawn(m, r, 0.0f);
        }
        while (m.count > 1 && m.particles[m.count - 2].age > life) --m.count;
    }
    m.leftover -= dt * steps;
    if (steps > 0) {
        uint32_t below = 0, touching = 0;
        vec3 place(0.0f), normal(0.0f);
        for (uint32_t k = 0; k < m.count; ++k) {
            const CurveParticle& p = m.particles[k];
            if (p.risen > r.size.height) continue;
            ++below;
            if (!p.touches) continue;
            ++touching;
            place += p.position;
            normal += nearestSurface(colliders, p.position).normal;
        }
        const float now = below > 0 ? r.size.power * float(touching) / float(below) : 0.0f;
        const float passed = puffFrequency(r.size.diameter) * kMotionStep / r.burn * float(steps);
        if (touching > 0) {
            const float l = glm::length(normal);
            const float fresh = m.contactPower > 0.0f ? std::min(3.0f * passed, 1.0f) : 1.0f;
            m.contact = glm::mix(m.contact, place / float(touching), fresh);
            m.contactNormal = l > 1e-6f ? normal / l : r.up;
        }
        meanContact(m, now, passed);
    }
    m.base = base;
    m.radius = 0.5f * r.size.diameter;
}

uint32_t motionPoints(const FlameMotion& m, const MotionRules& r,
                      std::array<ControlPoint, kMaxControlPoints>& points) noexcept {
    const float interval = lifeOf(r) / float(kMotionPieces);
    points[0] = {m.base, m.radius};
    FW_ASSERT(interval > 0, "%g s", double(interval));
    uint32_t older = 0;
    for (uint32_t k = 1; k <= kMotionPieces; ++k) {
        // The place at that age, between a younger and an older particle.
        const float age = interval * float(k);
        while (older < m.count && m.particles[older].age < age) ++older;
        CurveParticle young;
        young.position = m.base;
        if (older > 0) young = m.particles[older - 1];
        CurveParticle at = young;
        if (older < m.count) {
            const CurveParticle& old = m.particles[older];
            const float w = (age - young.age) / std::max(old.age - young.age, 1e-6f);
            at.position = glm::mix(young.position, old.position, w);
            at.risen = glm::mix(young.risen, old.risen, w);
            at.bulge = older > 0 ? glm::mix(young.bulge, old.bulge, w) : old.bulge;
        } else {
            const float more = age - young.age;
            const vec3 velocity = older > 0 ? young.velocity : r.up * speedAt(r, 0.0f);
            at.position += velocity * more;
            at.risen += glm::length(velocity) * more;
        }
        const float seen = std::max(r.size.height, 1e-3f);
        const float swell = 1.0f + r.puff * at.bulge * glm::smoothstep(0.0f, 0.3f, at.risen / seen);
        points[k] = {at.position,
                     m.radius * swell + r.entrainment * std::max(at.risen - seen, 0.0f)};
    }
    return kMotionPieces + 1;
}

float motionPulse(const FlameMotion& m, const MotionRules& r) noexcept {
    return 1.0f + r.puff * float(std::sin(double(kTwoPi) * m.phase - 1.2));
}

}  // namespace fw::volume
