// The game's own rules: enemies march, the tower aims and fires, flames light what they touch.
// Deterministic for a seed and a fixed frame time; knows the fire only through FireVillage.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "fire_village.h"
#include "jet.h"

namespace tower {

struct Marcher {
    size_t instance = 0;
    village::Kit kind = village::Kit::kStrawMan;
    float along = 0, side = 0;  // m on the road
    float size = 1, speed = 1;  // m/s
    float phase = 0;            // of its step
    float alight = -1;          // s since it caught; < 0: not yet
    float down = 0;             // 0 upright .. 1 fallen
};

class Game {
 public:
    Game(const village::Scene& scene, FireVillage& fires, uint32_t seed, glm::vec3 wind);

    void advance(float deltaTime);

    std::span<const Placed> placed() const { return placed_; }
    std::span<Placed> placed() { return placed_; }
    const std::vector<JetParticle>& flames(glm::vec3 forward) { return jet_.billboards(forward); }
    glm::vec3 wind() const { return wind_; }
    // The jet as lights for the renderer; empty while it is shut.
    std::vector<PointLight> jetLights(float scale) const;
    uint32_t felled() const;

 private:
    void marchOn(float deltaTime);
    void aim(float deltaTime);
    void touch();
    village::Frame marcherFrame(const Marcher& m) const;
    const Marcher* target() const;
    void catchFire(Marcher& m, glm::vec3 place);

    FireVillage& fires_;
    std::vector<Placed> placed_;
    std::vector<Marcher> marchers_;
    Jet jet_;
    size_t turret_ = ~size_t{0};  // into placed_: the first one
    float yaw_ = 0, pitch_ = 0;   // rad
    float hold_ = 0;              // s the valve stays open
    bool open_ = false;
    float time_ = 0;
    glm::vec3 steadyWind_, wind_;
};

}  // namespace tower
