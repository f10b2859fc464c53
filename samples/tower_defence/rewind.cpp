// See rewind.h.
#include "rewind.h"

#include <chrono>
#include <utility>

namespace tower {

namespace {

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

}  // namespace

void Rewind::remember() {
    if (isPending_) {
        const double began = now();
        uint64_t size = 0;
        FwResult result = fwWorld_FetchSave(world_, nullptr, &size);
        if (result == FW_NOT_READY) return;
        checkFire(world_, result, "fwWorld_FetchSave");
        pending_.world.resize(size);
        result = fwWorld_FetchSave(world_, pending_.world.data(), &size);
        checkFire(world_, result, "fwWorld_FetchSave");
        snapshots_.push_back(std::move(pending_));
        isPending_ = false;
        fetchSeconds = now() - began;
        // Keep the latest snapshot that is old enough. Older ones are unreachable.
        const int32_t latest = siege_.state().tick - kBack;
        while (snapshots_.size() > 1 && snapshots_[1].state.tick <= latest) snapshots_.pop_front();
    }
    const int32_t tick = siege_.state().tick;
    if (!snapshots_.empty() && tick - snapshots_.back().state.tick < kEvery) return;
    pending_ = siege_.snapshot();
    checkFire(world_, fwWorld_RequestSave(world_), "fwWorld_RequestSave");
    isPending_ = true;
}

bool Rewind::goBack() {
    if (snapshots_.empty()) return false;
    const int32_t latest = siege_.state().tick - kBack;
    while (snapshots_.size() > 1 && snapshots_.back().state.tick > latest) snapshots_.pop_back();
    const double began = now();
    siege_.restore(snapshots_.back());
    loadSeconds = now() - began;
    isPending_ = false;
    return true;
}

size_t Rewind::bytes() const {
    size_t sum = 0;
    for (const Siege::Snapshot& snapshot : snapshots_) sum += snapshot.world.size();
    return sum;
}

}  // namespace tower
