// Bakes the village's procedural looks into pictures and its occlusion into vertices, at start-up
// and on all cores. CPU only; the renderer uploads what comes out.
#pragma once

#include <cstdint>
#include <vector>

#include "village/layout.h"

namespace tower {

struct Painting {
    uint32_t width = 0, height = 0;  // texels
    std::vector<uint8_t> color;      // RGBA8, square roots of linear colours; alpha: see below
    std::vector<uint8_t> relief;     // RGBA8: slope along u, slope along v, roughness, see below
};

struct PaintedModel {
    // color.a: the coals' heat, (heat + 0.4) / 1.7; relief.a: metalness
    Painting painting;
    std::vector<float> openSky;  // one per vertex, [0.22, 1]
};

struct PaintedVillage {
    std::vector<PaintedModel> models;  // as Scene::models
    // color.a: open sky; relief.a: height; of the road 0 where it is not, from 0.25 on where it is
    Painting ground, road;
    // uv to picture: (uv - low) / (high - low), because a lone chart need not fill its atlas
    village::Vec2 groundLow, groundHigh, roadLow, roadHigh;
};

// relief's slopes are within +-kReliefRange, 0.5 is level.
constexpr float kReliefRange = 1.5f;

// m from the lowest of their relief to the highest. As in shaders/village_surface.glsl.
constexpr float kRoadRelief = 0.045f, kGroundRelief = 0.16f;

PaintedVillage paintVillage(const village::Scene& scene);

}  // namespace tower
