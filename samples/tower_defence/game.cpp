// See game.h.
#include "game.h"

#include <algorithm>
#include <cmath>

namespace tower {

using village::Kit;
using village::Vec2;
using village::Vec3;

namespace {

constexpr float kRange = 8.6f;     // m, of the flamethrower
constexpr float kTurnRate = 2.0f;  // rad/s
constexpr float kRunFor = 1.6f;    // s, that a burning straw man keeps running
constexpr float kFallFor = 0.7f;   // s

glm::vec3 toGlm(Vec3 v) { return {v.x, v.y, v.z}; }

float marchingSpeed(Kit kind) {  // m/s
    switch (kind) {
        case Kit::kYuleGoat:
            return 1.9f;
        case Kit::kLogKnight:
            return 0.8f;
        case Kit::kWickerGiant:
            return 0.6f;
        default:
            return 1.45f;
    }
}

// What the gunner would rather burn; logs hardly catch.
float appetite(Kit kind) {
    switch (kind) {
        case Kit::kStrawMan:
            return 1.0f;
        case Kit::kYuleGoat:
            return 0.8f;
        default:
            return 0.2f;
    }
}

float turnTowards(float from, float to, float most) {
    const float d = std::remainder(to - from, 2 * village::kPi);
    return from + std::clamp(d, -most, most);
}

}  // namespace

Game::Game(const village::Scene& scene, FireVillage& fires, uint32_t seed, glm::vec3 wind)
    : fires_(fires), jet_(seed * 977 + 5), steadyWind_(wind), wind_(wind) {
    for (size_t i = 0; i < scene.instances.size(); ++i) {
        const village::Instance& instance = scene.instances[i];
        Placed placed;
        placed.model = instance.model;
        placed.frame = instance.frame;
        placed.tint = instance.tint;
        placed.moves = instance.roadMetres >= 0;
        placed.moves |= Kit(instance.model) == Kit::kFlamethrower;
        if (placed.moves && instance.roadMetres < 0 && turret_ == ~size_t{0}) {
            turret_ = i;
            yaw_ = std::atan2(instance.frame.z.x, instance.frame.z.z);
        }
        placed_.push_back(placed);
        if (instance.roadMetres < 0) continue;
        Marcher m;
        m.instance = i;
        m.kind = Kit(instance.model);
        m.along = instance.roadMetres;
        m.side = instance.roadSide;
        m.size = village::length(instance.frame.y);
        m.speed = marchingSpeed(m.kind) * (0.93f + 0.14f * village::random01(int(i), 1, seed));
        m.phase = 6.2832f * village::random01(int(i), 2, seed);
        marchers_.push_back(m);
    }
}

uint32_t Game::felled() const {
    return uint32_t(std::count_if(marchers_.begin(), marchers_.end(),
                                  [](const Marcher& m) { return m.down >= 1; }));
}

village::Frame Game::marcherFrame(const Marcher& m) const {
    village::Frame f = village::marchFrame(m.along, m.side, m.size);
    const float going = 1 - m.down;
    f.origin.y += 0.09f * std::fabs(std::sin(m.phase)) * going;
    return f * village::rotateZ(0.07f * std::sin(m.phase) * going) *
           village::rotateX(0.06f * going + 1.45f * m.down * m.down);
}

void Game::marchOn(float dt) {
    for (Marcher& m : marchers_) {
        const size_t thing = fires_.thingOf(m.instance);
        float pace = 1;
        if (m.alight >= 0) {
            m.alight += dt;
            const bool falls = m.kind == Kit::kStrawMan || m.kind == Kit::kYuleGoat;
            pace = m.alight < kRunFor ? 1.5f : 0;
            if (!falls) pace = 1;
            if (falls && m.alight >= kRunFor) m.down = std::min(1.0f, m.down + dt / kFallFor);
            // Panic: it no longer keeps to its file.
            m.side += dt * pace * 0.8f * std::sin(2.3f * m.alight + m.phase);
            m.side = std::clamp(m.side, -1.3f, 1.3f);
        } else if (thing != FireVillage::kNone && fires_.things[thing].lit) {
            m.alight = 0;  // a neighbour lit it
        }
        m.along = std::min(m.along + dt * pace * m.speed, village::roadLength() - 0.5f);
        m.phase += dt * pace * m.speed * 4.2f / m.size;
        const village::Frame frame = marcherFrame(m);
        placed_[m.instance].frame = frame;
        if (thing != FireVillage::kNone && m.down < 1) fires_.move(thing, frame);
    }
}

const Marcher* Game::target() const {
    const Vec2 place = village::kFlamethrowerPlace;
    const Marcher* best = nullptr;
    float most = 0;
    for (const Marcher& m : marchers_) {
        if (m.alight >= 0) continue;
        const Vec3 at = placed_[m.instance].frame.origin;
        const float away = village::length(Vec2{at.x, at.z} - place);
        if (away > kRange || away < 1.5f) continue;
        // The first in the file counts most, as in every tower defence.
        const float worth = appetite(m.kind) * (1 + 0.01f * m.along);
        if (worth > most) {
            most = worth;
            best = &m;
        }
    }
    return best;
}

void Game::aim(float dt) {
    Placed& turret = placed_[turret_];
    const Marcher* m = target();
    hold_ -= dt;
    bool onTarget = false;
    if (m) {
        const Vec3 at = placed_[m->instance].frame.origin;
        const Vec3 from = turret.frame.point(village::kNozzle);
        // Leads by the flight time, and aims into the wind's teeth by half of what it will do.
        const float flight = village::length(at - from) / 11.0f;
        Vec2 way;
        village::roadPoint(m->along, &way);
        const Vec3 lead{way.x * m->speed * flight - 0.25f * wind_.x * flight * flight, 1.0f,
                        way.y * m->speed * flight - 0.25f * wind_.z * flight * flight};
        const Vec3 to = at + lead - turret.frame.origin;
        const float wanted = std::atan2(to.x, to.z);
        yaw_ = turnTowards(yaw_, wanted, kTurnRate * dt);
        const float flat = std::max(1.0f, std::sqrt(to.x * to.x + to.z * to.z) - 2.5f);
        pitch_ = std::clamp(std::atan2(at.y + lead.y - from.y, flat) + 0.02f * flat, -0.5f, 0.3f);
        onTarget = std::fabs(std::remainder(wanted - yaw_, 2 * village::kPi)) < 0.12f;
    }
    if (onTarget) hold_ = 0.35f;
    open_ = hold_ > 0;
    turret.frame =
        village::translate(turret.frame.origin.x, turret.frame.origin.y, turret.frame.origin.z) *
        village::rotateY(yaw_);
    const glm::vec3 nozzle = toGlm(turret.frame.point(village::kNozzle));
    const glm::vec3 direction(std::sin(yaw_) * std::cos(pitch_), std::sin(pitch_),
                              std::cos(yaw_) * std::cos(pitch_));
    jet_.advance(dt, nozzle, direction, wind_, open_);
}

void Game::catchFire(Marcher& m, glm::vec3 place) {
    const size_t thing = fires_.thingOf(m.instance);
    if (thing != FireVillage::kNone && fires_.ignite(thing, place, 0.35f) && m.alight < 0)
        m.alight = 0;
}

// The jet's bodies meet the ground and whatever stands in their way; burning ones light it.
void Game::touch() {
    constexpr float kRest = 0.12f;  // s between two tries at one thing
    for (size_t i = 0; i < jet_.bodies().size(); ++i) {
        const Jet::Body& body = jet_.bodies()[i];
        if (body.age > body.life || body.path < 0.8f) continue;
        const glm::vec3 p = body.place;
        const float ground = village::groundHeight({p.x, p.z});
        if (p.y < ground + 0.1f) jet_.splash(i, {0, 1, 0});
        for (size_t t = 0; t < fires_.things.size(); ++t) {
            Thing& thing = fires_.things[t];
            const glm::vec3 away = p - toGlm(thing.frame.origin);
            if (thing.rest > 0 || glm::dot(away, away) > 25.0f) continue;
            const Vec3 d{away.x, away.y, away.z};
            const float scale2 = village::dot(thing.frame.x, thing.frame.x);
            const Vec3 local{village::dot(d, thing.frame.x) / scale2,
                             village::dot(d, thing.frame.y) / scale2,
                             village::dot(d, thing.frame.z) / scale2};
            constexpr float kSkin = 0.2f;  // m
            if (local.x < thing.low.x - kSkin || local.x > thing.high.x + kSkin ||
                local.y < thing.low.y - kSkin || local.y > thing.high.y + kSkin ||
                local.z < thing.low.z - kSkin || local.z > thing.high.z + kSkin)
                continue;
            thing.rest = kRest;
            const auto marcher =
                std::find_if(marchers_.begin(), marchers_.end(),
                             [&](const Marcher& m) { return m.instance == thing.instance; });
            if (marcher != marchers_.end()) {
                catchFire(*marcher, p);
            } else if (fires_.ignite(t, p, 0.4f)) {
                jet_.splash(i, glm::normalize(glm::vec3(away.x, 0.3f, away.z)));
            }
        }
    }
}

std::vector<PointLight> Game::jetLights(float scale) const {
    // Three thirds of the jet, each a light where its bodies are.
    std::vector<PointLight> lights;
    for (int third = 0; third < 3; ++third) {
        glm::vec3 sum(0);
        float count = 0;
        for (const Jet::Body& b : jet_.bodies()) {
            const float a = b.age / b.life;
            if (a >= 1 || int(a * 3) != third) continue;
            sum += b.place;
            ++count;
        }
        if (count < 3) continue;
        PointLight light;
        light.place = sum / count + glm::vec3(0, 0.35f, 0);
        light.color = glm::vec3(1.0f, 0.40f, 0.095f) * (scale * count / 40.0f);
        light.reach = 11;
        lights.push_back(light);
    }
    return lights;
}

void Game::advance(float dt) {
    time_ += dt;
    const float gust = 1 + 0.25f * std::sin(0.9f * time_) + 0.12f * std::sin(2.7f * time_ + 1);
    wind_ = steadyWind_ * gust;
    marchOn(dt);
    aim(dt);
    touch();
    fires_.advance(dt, wind_);
    for (const Thing& thing : fires_.things) placed_[thing.instance].drawn = !thing.lit;
}

}  // namespace tower
