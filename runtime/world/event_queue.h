// What the host polls: a ring of a fixed size. Full: the oldest go, and are counted.
#pragma once
#include "flamewright/flamewright.h"

#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace fw::world {

class EventQueue {
 public:
    static constexpr uint32_t kCapacity = 4096;

    explicit EventQueue(std::pmr::memory_resource* memory) : ring_(kCapacity, memory) {}

    void push(const FwEvent& event) noexcept;
    uint32_t poll(std::span<FwEvent> out) noexcept;
    void clear() noexcept { count_ = 0; }
    // Events lost since the last call.
    uint64_t takeDropped() noexcept;

 private:
    std::pmr::vector<FwEvent> ring_;
    uint32_t first_ = 0, count_ = 0;
    uint64_t dropped_ = 0;
};

}  // namespace fw::world
