// Bakes the village's procedural surfaces into images and its ambient occlusion into vertices, at
// start-up on all cores. CPU only; the renderer uploads the result.
#pragma once

#include <cstdint>
#include <vector>

#include "village/layout.h"

namespace tower {

struct Painting {
    uint32_t width = 0, height = 0;  // texels
    std::vector<uint8_t> color;      // RGBA8, square roots of linear colours; for alpha see
                                     // PaintedModel and PaintedVillage
    std::vector<uint8_t> relief;     // RGBA8: slope along u, slope along v, roughness, see below
};

struct PaintedModel {
    // color.a: heat of the coals, (heat + 0.4) / 1.7; relief.a: metalness
    Painting painting;
    std::vector<float> openSky;  // one per vertex, [0.22, 1]
};

struct PaintedVillage {
    std::vector<PaintedModel> models;  // as Scene::models
    // color.a: open sky; relief.a: height; on the road image 0 off the road and at least 0.25 on it
    Painting ground, road;
    // image coordinates: (uv - low) / (high - low), because a lone chart need not fill its atlas
    village::Vec2 groundLow, groundHigh, roadLow, roadHigh;
};

// Slopes of the relief are within +-kReliefRange; 0.5 is level.
constexpr float kReliefRange = 1.5f;

// m from the lowest to the highest point of the relief. Must match shaders/village_surface.glsl.
constexpr float kRoadRelief = 0.045f, kGroundRelief = 0.16f;

PaintedVillage paintVillage(const village::Scene& scene);

}  // namespace tower
