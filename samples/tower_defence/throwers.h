// More flamethrower towers, along the road in both directions: jets of the library's own, which
// walls stop and which light what they strike. Each aims at the enemy that is nearest to it.
#pragma once

#include <span>
#include <vector>

#include "common/fire_host.h"
#include "renderer.h"

namespace tower {

// Puts plinths and turrets into the scene, before it is painted. Returns the turrets' instances.
std::vector<size_t> placeThrowers(village::Scene& scene, uint32_t count);

class Throwers {
 public:
    // power: kW of each; 0: they stand there and do not fire.
    Throwers(sample::FireHost& fire, const village::Scene& scene, std::vector<size_t> turrets,
             float power);
    // Turns the turrets among `placed`, and their jets with them.
    void advance(float deltaTime, std::span<Placed> placed);
    // Where they burn, for the renderer.
    void addLights(float scale, std::vector<PointLight>& lights) const;

 private:
    struct Thrower {
        size_t instance = 0;
        FwFireEmitterId jet{};
        float yaw = 0;  // rad
        glm::vec3 middle{0};
    };
    sample::FireHost& fire_;
    std::vector<Thrower> throwers_;
    std::vector<size_t> enemies_;  // instances
    float power_ = 0, time_ = 0;   // kW, s
};

}  // namespace tower
