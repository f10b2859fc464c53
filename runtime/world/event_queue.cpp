#include "world/event_queue.h"

#include <algorithm>

namespace fw::world {

void EventQueue::push(const FwEvent& event) noexcept {
    if (pushed_ - polled_ == kCapacity) {
        ++polled_;
        ++dropped_;
    }
    ring_[pushed_++ % kCapacity] = event;
}

uint32_t EventQueue::poll(std::span<FwEvent> out) noexcept {
    const auto given = uint32_t(std::min<uint64_t>(pushed_ - polled_, out.size()));
    for (uint32_t i = 0; i < given; ++i) out[i] = at(polled_++);
    return given;
}

uint64_t EventQueue::takeDropped() noexcept {
    const uint64_t dropped = dropped_;
    dropped_ = 0;
    return dropped;
}

}  // namespace fw::world
