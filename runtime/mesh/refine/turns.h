// When a refined object has its next turn: when what it shows may have changed by so much that it
// shows. Between turns it is drawn as it was placed. Cosmetic.
#pragma once
#include "shared/burn.h"

#include <algorithm>
#include <cmath>

namespace fw::mesh {

struct RefineTurn {
    double since = 0;         // ticks, since the last one
    float away = 0;           // m, >= 0, from the eye to its bounds
    float moved = 0;          // m, that the eye has moved since
    bool perspective = true;  // false: distance makes nothing smaller
    float pixels = 0;         // of 1 m, in perspective at 1 m from the eye
    double speed = 0;         // m per tick, at which fire runs in still air; 0: nothing burns
};

constexpr double kTurnPixels = 0.5;  // that a front may have run
constexpr float kTurnEye = 0.02f;    // of its distance, that the eye may have moved
constexpr double kTurnTicks =
    gpu::kTicksPerSecond / 15.0;  // at the latest: levels are on their way

inline bool refineDue(const RefineTurn& turn) noexcept {
    const float away = std::max(turn.away, 0.01f);
    if (turn.perspective && turn.moved > kTurnEye * away) return true;
    const double run = turn.speed * double(turn.pixels) / double(turn.perspective ? away : 1.0f);
    return turn.since >= std::min(kTurnTicks, kTurnPixels / std::max(run, 1e-9));
}

}  // namespace fw::mesh
