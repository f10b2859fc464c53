// Decides when a refined object is placed again: once its picture may have changed visibly. Until
// then it is drawn as last placed. Cosmetic.
#pragma once
#include "core/assert.h"
#include "shared/burn.h"

#include <algorithm>
#include <cmath>

namespace fw::mesh {

struct RefineTurn {
    double since = 0;         // ticks since the last turn
    float away = 0;           // m, >= 0, from the camera to the object's bounds
    float moved = 0;          // m that the camera moved since
    bool perspective = true;  // false: an orthographic view
    float pixels = 0;         // size of 1 m, in perspective at 1 m from the camera
    double speed = 0;         // m per tick of the front in still air; 0: nothing burns
};

constexpr double kTurnPixels = 0.5;  // largest run of a front between turns
constexpr float kTurnEye = 0.02f;    // largest move of the camera, of its distance
constexpr double kTurnTicks = gpu::kTicksPerSecond / 15.0;  // at the latest: levels are morphing

inline bool refineDue(const RefineTurn& turn) noexcept {
    FW_ASSERT(turn.away >= 0 && turn.since >= 0, "%g m, %g ticks", double(turn.away), turn.since);
    const float away = std::max(turn.away, 0.01f);
    if (turn.perspective && turn.moved > kTurnEye * away) return true;
    const double run = turn.speed * double(turn.pixels) / double(turn.perspective ? away : 1.0f);
    return turn.since >= std::min(kTurnTicks, kTurnPixels / std::max(run, 1e-9));
}

}  // namespace fw::mesh
