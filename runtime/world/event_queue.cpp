#include "world/event_queue.h"

#include <algorithm>

namespace fw::world {

void EventQueue::push(const FwEvent& event) noexcept {
    if (count_ == kCapacity) {
        first_ = (first_ + 1) % kCapacity;
        --count_;
        ++dropped_;
    }
    ring_[(first_ + count_) % kCapacity] = event;
    ++count_;
}

uint32_t EventQueue::poll(std::span<FwEvent> out) noexcept {
    const uint32_t given = std::min(count_, uint32_t(std::min<size_t>(out.size(), kCapacity)));
    for (uint32_t i = 0; i < given; ++i) out[i] = ring_[(first_ + i) % kCapacity];
    first_ = (first_ + given) % kCapacity;
    count_ -= given;
    return given;
}

uint64_t EventQueue::takeDropped() noexcept {
    const uint64_t dropped = dropped_;
    dropped_ = 0;
    return dropped;
}

}  // namespace fw::world
