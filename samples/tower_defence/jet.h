// The flamethrower's visible jet: particles on the CPU, drawn as billboards by the renderer.
// A pure function of time and seed while it is on; it also says where it touches things.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace tower {

// One billboard; the renderer reads it as it is (three vec4).
struct JetParticle {
    glm::vec3 place;        // m
    float size = 0;         // m, across
    glm::vec3 axis;         // unit, along the motion
    float stretch = 1;      // length over width
    float age = 0;          // 0 born .. 1 burnt out .. beyond: smoke
    float temperature = 0;  // K
    float opacity = 0;      // [0, 1]
    float seed = 0;         // [0, 1]
};

class Jet {
 public:
    explicit Jet(uint32_t seed) : seed_(seed) {}

    // nozzle and direction are of the whole step; open says whether fuel flows.
    void advance(float deltaTime, glm::vec3 nozzle, glm::vec3 direction, glm::vec3 wind, bool open);
    // Sorted back to front for an eye that looks along forward.
    const std::vector<JetParticle>& billboards(glm::vec3 forward);

    struct Body {
        glm::vec3 place, velocity;  // m, m/s
        float age = 0, life = 1;    // s
        float path = 0;             // m flown
        uint32_t id = 0;
        bool touched = false;  // has met the ground or an object
        bool smokes = false;
    };
    const std::vector<Body>& bodies() const { return bodies_; }
    // A body that met something spreads along it and does not go on.
    void splash(size_t body, glm::vec3 normal);
    bool burning() const { return !bodies_.empty(); }

 private:
    float random(uint32_t id, uint32_t what) const;

    uint32_t seed_, nextId_ = 0;
    float time_ = 0, debt_ = 0;  // s, bodies owed
    std::vector<Body> bodies_;
    std::vector<JetParticle> billboards_;
};

}  // namespace tower
