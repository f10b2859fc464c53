// See jet.h. The numbers are a flamethrower's: thickened fuel at 12 m/s that tears up after a
// third of its life, then rises as flame and ends as smoke.
#include "jet.h"

#include <algorithm>
#include <cmath>

#include "village/village_math.h"

namespace tower {

namespace {

constexpr float kSpeed = 12.0f;     // m/s
constexpr float kRate = 150.0f;     // bodies/s
constexpr float kLife = 1.05f;      // s
constexpr float kSmokeLife = 2.1f;  // lives
constexpr float kSpread = 0.055f;   // rad
constexpr float kGravity = 2.5f;    // m/s^2 while it is liquid
constexpr float kBuoyancy = 9.0f;   // m/s^2 once it is torn

float stepUp(float a, float b, float x) { return village::smoothStep(a, b, x); }

glm::vec3 turbulence(glm::vec3 p, float time, uint32_t seed) {
    auto n = [&](float x, float y, uint32_t s) { return village::noise(x, y, seed + s); };
    const float k = 1.15f;  // 1/m
    return {n(p.y * k + time, p.z * k, 11) + n(p.x * k, time * 1.7f, 12),
            n(p.z * k + time, p.x * k, 13), n(p.x * k + time, p.y * k, 14)};
}

}  // namespace

float Jet::random(uint32_t id, uint32_t what) const {
    return village::random01(int(id), int(what), seed_);
}

void Jet::advance(float dt, glm::vec3 nozzle, glm::vec3 direction, glm::vec3 wind, bool open) {
    for (Body& b : bodies_) {
        const float a = b.age / b.life;
        const float torn = b.touched ? 1.0f : stepUp(0.15f, 0.6f, a);
        const float drag = 1.0f / village::mix(1.5f, 0.44f, torn);
        const float rise = a > 1 ? 0.4f * kBuoyancy : kBuoyancy;
        b.velocity += dt * glm::vec3(0, village::mix(-kGravity, rise, torn), 0);
        b.velocity += (wind - b.velocity) * (1 - std::exp(-drag * dt));
        const glm::vec3 swirl = turbulence(b.place, time_, seed_) *
                                (2.6f * stepUp(0.08f, 0.7f, a) * (a > 1 ? 0.55f : 1.0f));
        const glm::vec3 move = (b.velocity + swirl) * dt;
        b.place += move;
        b.path += glm::length(move);
        b.age += dt;
    }
    std::erase_if(
        bodies_, [](const Body& b) { return b.age > b.life * (b.smokes ? 1 + kSmokeLife : 1.0f); });
    if (open) {
        const glm::vec3 side = glm::normalize(glm::cross(direction, glm::vec3(0, 1, 0)));
        const glm::vec3 up = glm::cross(side, direction);
        debt_ += kRate * dt;
        const float first = debt_ - std::floor(debt_);
        for (int n = int(debt_); n > 0; --n) {
            const uint32_t id = nextId_++;
            const float late = (float(n) - 1 + first) / kRate;  // s since it left the nozzle
            const float when = time_ + dt - late;
            const float turn = 6.2832f * random(id, 1);
            const float off = kSpread * std::sqrt(-2 * std::log(1e-4f + 0.9999f * random(id, 2)));
            const float sway = 0.05f * village::noise(when * 3.1f, 0, seed_ + 5);
            const float pulse = 1 + 0.12f * village::noise(when * 6, 1, seed_ + 6);
            const glm::vec3 way = glm::normalize(direction + side * (off * std::cos(turn) + sway) +
                                                 up * (off * std::sin(turn)));
            Body b;
            b.id = id;
            b.velocity = way * (kSpeed * pulse);
            b.place = nozzle + b.velocity * late;
            b.path = kSpeed * late;
            b.age = late;
            const float f = random(id, 3);
            b.life = kLife * (0.72f + 0.34f * f + 0.34f * f * f * f * f);
            b.smokes = random(id, 4) < 0.30f;
            bodies_.push_back(b);
        }
        debt_ = first;
    }
    time_ += dt;
}

void Jet::splash(size_t body, glm::vec3 normal) {
    Body& b = bodies_[body];
    if (b.touched) return;
    const float into = glm::dot(b.velocity, normal);
    if (into >= 0) return;
    const glm::vec3 along = b.velocity - normal * into;
    const float turn = 6.2832f * random(b.id, 7);
    const glm::vec3 kick{std::cos(turn), 0.2f, std::sin(turn)};
    b.velocity = along * 0.35f + kick * (1.0f + 1.6f * random(b.id, 8)) + normal * 0.4f;
    b.touched = true;
}

const std::vector<JetParticle>& Jet::billboards(glm::vec3 forward) {
    billboards_.clear();
    for (const Body& b : bodies_) {
        const float a = b.age / b.life;
        JetParticle p;
        p.place = b.place;
        p.size = (0.14f + 0.165f * b.path + 0.30f * b.age) * (0.8f + 0.45f * random(b.id, 9));
        p.size = std::min(p.size, 1.6f) * (a > 1 ? 1 + 0.35f * (a - 1) : 1.0f);
        const float speed = glm::length(b.velocity);
        p.axis = speed > 0.01f ? b.velocity / speed : glm::vec3(0, 1, 0);
        p.stretch = b.touched ? 1.0f : 1 + 4 * std::exp(-5.5f * a);
        p.age = a;
        p.temperature = village::mix(1650, 1400, stepUp(0.3f, 1, a)) +
                        150 * (1 - stepUp(0, 0.3f, a)) -
                        140 * random(b.id, 10) * stepUp(0.15f, 0.7f, a);
        p.seed = random(b.id, 11);
        const float ends = 0.62f + 0.18f * random(b.id, 12);
        const float fire =
            village::mix(0.45f, 1, stepUp(0, 0.1f, a)) * (1 - stepUp(ends, 0.98f, a));
        const float left = std::max(0.0f, (1 + kSmokeLife - a) / kSmokeLife);
        const float smoke =
            b.smokes ? 0.45f * stepUp(0.65f, 1.05f, a) * std::pow(left, 1.3f) : 0.0f;
        p.opacity = a < ends ? fire : std::max(fire, smoke);
        // A body that is only smoke says so by an age beyond one.
        if (smoke > fire) p.age = std::max(p.age, 1.001f);
        if (p.opacity > 0.01f) billboards_.push_back(p);
    }
    std::stable_sort(billboards_.begin(), billboards_.end(),
                     [&](const JetParticle& x, const JetParticle& y) {
                         return glm::dot(x.place, forward) > glm::dot(y.place, forward);
                     });
    return billboards_;
}

}  // namespace tower
