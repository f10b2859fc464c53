// A ring of snapshots of game and world, to go back ten seconds.
#pragma once

#include <cstdint>
#include <deque>

#include "siege.h"

namespace tower {

class Rewind {
 public:
    static constexpr int32_t kBack = 10 * game::kTicksPerSecond;  // ticks
    static constexpr int32_t kEvery = 2 * game::kTicksPerSecond;  // ticks between two snapshots

    Rewind(FwWorld* world, Siege& siege) : world_(world), siege_(siege) {}

    // Takes snapshots. Call it once per frame, between the siege's advance and the world's step.
    void remember();
    // Restores the latest snapshot that is at least ten seconds old, or else the oldest. Returns
    // false if there is none.
    bool goBack();

    // Cost of the last fetch and load: s on the calling thread.
    double fetchSeconds = 0, loadSeconds = 0;
    size_t bytes() const;
    size_t snapshotCount() const { return snapshots_.size(); }

 private:
    FwWorld* world_;
    Siege& siege_;
    std::deque<Siege::Snapshot> snapshots_;
    Siege::Snapshot pending_;  // a snapshot whose save is not ready yet
    bool isPending_ = false;
};

}  // namespace tower
