// What the host polls: a ring of a fixed size. Full: the oldest go, and are counted.
#pragma once
#include "core/assert.h"
#include "flamewright/flamewright.h"

#include <cstdint>
#include <memory_resource>
#include <mutex>
#include <span>
#include <vector>

namespace fw::world {

// One thread pushes, saves and clears; any other may poll meanwhile.
class EventQueue {
 public:
    static constexpr uint32_t kCapacity = 4096;

    explicit EventQueue(std::pmr::memory_resource* memory) : ring_(kCapacity, memory) {}

    void push(const FwEvent& event) noexcept;
    uint32_t poll(std::span<FwEvent> out) noexcept;
    void clear() noexcept;
    // Events with a place are raised so many m further on.
    void move(const double (&by)[3]) noexcept;
    // Events lost since the last call.
    uint64_t takeDropped() noexcept;

    // Events are numbered as they come. The next to be polled, and one past the last.
    [[nodiscard]] uint64_t next() const noexcept;
    [[nodiscard]] uint64_t end() const noexcept { return pushed_; }
    // The first that is still in the ring, be it polled or not, and one from there on.
    [[nodiscard]] uint64_t oldest() const noexcept {
        return pushed_ > kCapacity ? pushed_ - kCapacity : 0;
    }
    [[nodiscard]] const FwEvent& at(uint64_t number) const noexcept {
        FW_ASSERT(number < pushed_ && number >= oldest(), "event %zu", size_t(number));
        return ring_[number % kCapacity];
    }

 private:
    mutable std::mutex mutex_;
    std::pmr::vector<FwEvent> ring_;
    uint64_t polled_ = 0, pushed_ = 0, dropped_ = 0;
};

}  // namespace fw::world
