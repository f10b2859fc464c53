// Placement of all objects of the village.
#pragma once

#include <vector>

#include "ground.h"
#include "kit.h"
#include "model.h"

namespace village {

// Scene::models holds the kit in the order of Kit, then these.
constexpr int kJettyModel = int(Kit::kCount);
constexpr int kShoreModel = kJettyModel + 1;

struct Scene {
    std::vector<Model> models;
    Model terrain, road, water;
    std::vector<Instance> instances;
};

// The seed varies trees, tufts and rotations. Houses, towers and fences have fixed places.
Scene makeVillage(uint32_t seed);

// Returns the frame of an enemy on the road, facing along it.
Frame marchFrame(float along, float side, float size);

// The flamethrower's nozzle in its model's space, and the tower's position.
constexpr Vec3 kNozzle{0, 2.72f, 2.55f};  // m
constexpr Vec2 kFlamethrowerPlace{0.9f, 4.4f};

}  // namespace village
