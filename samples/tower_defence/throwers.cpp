// See throwers.h.
#include "throwers.h"

#include <algorithm>
#include <cmath>

#include "village/ground.h"
#include "village/layout.h"

namespace tower {

namespace {

using village::Kit;
using village::Vec2;
using village::Vec3;

constexpr float kBeside = 4.4f;                     // m from the middle of the road
constexpr float kTurnRate = 2.0f;                   // rad/s
constexpr uint32_t kParticles = 100;                // of each
constexpr float kNearest = 3.6f, kFarthest = 9.5f;  // m, of what it fires at

// Does something stand there already? With room for a plinth.
bool overlaps(const village::Scene& scene, Vec2 place) {
    constexpr float kRoom = 1.5f;  // m
    return std::any_of(scene.instances.begin(), scene.instances.end(), [&](const auto& other) {
        if (other.roadMetres >= 0) return false;
        const village::Frame& f = other.frame;
        const village::Model& model = scene.models[size_t(other.model)];
        const Vec3 d{place.x - f.origin.x, 0, place.y - f.origin.z};
        const float scale2 = village::dot(f.x, f.x), room = kRoom / std::sqrt(scale2);
        const float x = village::dot(d, f.x) / scale2, z = village::dot(d, f.z) / scale2;
        return x > model.low.x - room && x < model.high.x + room && z > model.low.z - room &&
               z < model.high.z + room;
    });
}

}  // namespace

std::vector<size_t> placeThrowers(village::Scene& scene, uint32_t count) {
    std::vector<size_t> turrets;
    const float length = village::roadLength();
    for (uint32_t i = 0; i < count; ++i) {
        const float share = (float(i) + 0.5f) / float(count);
        Vec2 place, way;
        float side = i % 2 ? 1.0f : -1.0f;
        for (int tries = 0; tries < 24; ++tries) {
            const Vec2 at = village::roadPoint(length * share + 0.35f * float(tries), &way);
            const float away = side * (kBeside + 0.25f * float(tries / 2));
            place = {at.x - way.y * away, at.y + way.x * away};
            if (!overlaps(scene, place)) break;
            side = -side;
        }
        const float yaw = std::atan2(side * way.y, -side * way.x);
        for (const Kit kit : {Kit::kFlamePlinth, Kit::kFlamethrower}) {
            village::Instance tower;
            tower.model = int(kit);
            tower.frame = village::translate(place.x, village::groundHeight(place), place.y) *
                          village::rotateY(yaw);
            tower.seed = 1000 + i;
            scene.instances.push_back(tower);
        }
        turrets.push_back(scene.instances.size() - 1);
    }
    return turrets;
}

Throwers::Throwers(sample::FireHost& fire, const village::Scene& scene, std::vector<size_t> turrets,
                   float power)
    : fire_(fire), power_(power) {
    for (size_t i = 0; i < scene.instances.size(); ++i)
        if (scene.instances[i].roadMetres >= 0) enemies_.push_back(i);
    for (const size_t instance : turrets) {
        Thrower thrower;
        thrower.instance = instance;
        const village::Frame& frame = scene.instances[instance].frame;
        thrower.yaw = std::atan2(frame.z.x, frame.z.z);
        const Vec3 nozzle = frame.point(village::kNozzle);
        FwFireEmitterDef def = fwDefaultFireEmitterDef();
        def.flags = FW_EMITTER_JET | FW_EMITTER_IGNITES | FW_EMITTER_GROUND;
        def.power = std::max(power, 1.0f);
        def.maxParticles = kParticles;
        def.rate = 85;
        def.smokeLife = 1.2f;
        def.behind = 0.3f;
        def.ground = village::groundHeight({nozzle.x, nozzle.z});
        const float place[3] = {nozzle.x, nozzle.y, nozzle.z};
        std::copy_n(place, 3, def.position);
        fire_.check(fwWorld_CreateFireEmitter(fire_.world, &def, &thrower.jet),
                    "fwWorld_CreateFireEmitter");
        fire_.check(fwWorld_SetFireEmitterPower(fire_.world, thrower.jet, power),
                    "fwWorld_SetFireEmitterPower");
        throwers_.push_back(thrower);
    }
}

void Throwers::advance(float deltaTime, std::span<Placed> placed) {
    time_ += deltaTime;
    for (Thrower& thrower : throwers_) {
        Placed& turret = placed[thrower.instance];
        const Vec3 from = turret.frame.origin;
        float nearest = kFarthest, wanted = thrower.yaw, falls = -1.6f;
        for (const size_t i : enemies_) {
            const Vec3 to = placed[i].frame.origin - from;
            const float far = std::sqrt(to.x * to.x + to.z * to.z);
            if (far < kNearest || far >= nearest) continue;
            nearest = far;
            wanted = std::atan2(to.x, to.z);
            falls = to.y + 0.9f - village::kNozzle.y;
        }
        const float turn = std::remainder(wanted - thrower.yaw, 2 * village::kPi);
        thrower.yaw += std::clamp(turn, -kTurnRate * deltaTime, kTurnRate * deltaTime);
        turret.frame = village::translate(from.x, from.y, from.z) * village::rotateY(thrower.yaw);
        const Vec3 nozzle = turret.frame.point(village::kNozzle);
        const float flat = std::max(nearest - village::kNozzle.z, 1.5f);
        const float pitch = std::clamp(std::atan2(falls, flat) + 0.02f * flat, -0.6f, 0.1f);
        const float position[3] = {nozzle.x, nozzle.y, nozzle.z};
        const float direction[3] = {std::sin(thrower.yaw) * std::cos(pitch), std::sin(pitch),
                                    std::cos(thrower.yaw) * std::cos(pitch)};
        thrower.middle = glm::vec3(nozzle.x, nozzle.y, nozzle.z) +
                         4.0f * glm::vec3(direction[0], direction[1], direction[2]);
        fire_.check(fwWorld_MoveFireEmitter(fire_.world, thrower.jet, position, direction),
                    "fwWorld_MoveFireEmitter");
    }
}

void Throwers::addLights(float scale, std::vector<PointLight>& lights) const {
    for (const Thrower& thrower : throwers_) {
        if (!(power_ > 0)) continue;
        PointLight light;
        light.place = thrower.middle;
        light.color = glm::vec3(1.0f, 0.40f, 0.095f) * scale;
        light.reach = 9;
        lights.push_back(light);
    }
}

}  // namespace tower
