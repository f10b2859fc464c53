#include "world/event_queue.h"

#include <algorithm>

namespace fw::world {

void EventQueue::push(const FwEvent& event) noexcept {
    const std::lock_guard lock(mutex_);
    FW_ASSERT(pushed_ - polled_ <= kCapacity, "%zu events", size_t(pushed_ - polled_));
    if (pushed_ - polled_ == kCapacity) {
        ++polled_;
        ++dropped_;
    }
    ring_[pushed_++ % kCapacity] = event;
}

uint32_t EventQueue::poll(std::span<FwEvent> out) noexcept {
    const std::lock_guard lock(mutex_);
    const auto given = uint32_t(std::min<uint64_t>(pushed_ - polled_, out.size()));
    for (uint32_t i = 0; i < given; ++i) out[i] = at(polled_++);
    return given;
}

void EventQueue::move(const double (&by)[3]) noexcept {
    const std::lock_guard lock(mutex_);
    for (uint64_t number = oldest(); number < pushed_; ++number) {
        FwEvent& event = ring_[number % kCapacity];
        for (int i = 0; event.type != FW_EVENT_TIME_DROPPED && i < 3; ++i)
            event.position[i] = float(double(event.position[i]) + by[i]);
    }
}

void EventQueue::clear() noexcept {
    const std::lock_guard lock(mutex_);
    polled_ = pushed_;
}

uint64_t EventQueue::next() const noexcept {
    const std::lock_guard lock(mutex_);
    return polled_;
}

uint64_t EventQueue::takeDropped() noexcept {
    const std::lock_guard lock(mutex_);
    const uint64_t dropped = dropped_;
    dropped_ = 0;
    return dropped;
}

}  // namespace fw::world
