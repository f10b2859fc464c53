// Rewinding: a ring of moments of game and world, so that ten seconds can be had back.
#pragma once

#include <cstdint>
#include <deque>

#include "siege.h"

namespace tower {

class Rewind {
 public:
    static constexpr int32_t kBack = 10 * game::kTicksPerSecond;  // ticks
    static constexpr int32_t kEvery = 2 * game::kTicksPerSecond;  // ticks between two moments

    Rewind(FwWorld* world, Siege& siege) : world_(world), siege_(siege) {}

    // Once a frame, between the siege's advance and the recording of the world's step.
    void remember();
    // To the youngest moment that is ten seconds old, or else the oldest there is. False: none.
    bool goBack();

    // What it costs, the last time: s of the calling thread, and bytes.
    double fetchSeconds = 0, loadSeconds = 0;
    size_t bytes() const;
    size_t moments() const { return moments_.size(); }

 private:
    FwWorld* world_;
    Siege& siege_;
    std::deque<Siege::Moment> moments_;
    Siege::Moment wished_;  // its bytes are on their way
    bool waits_ = false;
};

}  // namespace tower
