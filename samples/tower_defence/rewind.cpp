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
    if (waits_) {
        const double began = now();
        uint64_t size = 0;
        FwResult result = fwWorld_FetchSave(world_, nullptr, &size);
        if (result == FW_NOT_READY) return;
        checkFire(world_, result, "fwWorld_FetchSave");
        wished_.world.resize(size);
        result = fwWorld_FetchSave(world_, wished_.world.data(), &size);
        checkFire(world_, result, "fwWorld_FetchSave");
        moments_.push_back(std::move(wished_));
        waits_ = false;
        fetchSeconds = now() - began;
        // The youngest that is old enough stays; what is older is never asked for.
        const int32_t latest = siege_.state().tick - kBack;
        while (moments_.size() > 1 && moments_[1].state.tick <= latest) moments_.pop_front();
    }
    const int32_t tick = siege_.state().tick;
    if (!moments_.empty() && tick - moments_.back().state.tick < kEvery) return;
    wished_ = siege_.moment();
    checkFire(world_, fwWorld_RequestSave(world_), "fwWorld_RequestSave");
    waits_ = true;
}

bool Rewind::goBack() {
    if (moments_.empty()) return false;
    const int32_t latest = siege_.state().tick - kBack;
    while (moments_.size() > 1 && moments_.back().state.tick > latest) moments_.pop_back();
    const double began = now();
    siege_.comeBack(moments_.back());
    loadSeconds = now() - began;
    waits_ = false;
    return true;
}

size_t Rewind::bytes() const {
    size_t sum = 0;
    for (const Siege::Moment& moment : moments_) sum += moment.world.size();
    return sum;
}

}  // namespace tower
