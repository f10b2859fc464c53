// CPU memory through the host's callbacks, as a std::pmr resource, with a count of bytes.
// One per context. Thread-safe if the host's callbacks are (the defaults are).
#pragma once
#include "flamewright/flamewright.h"

#include <atomic>
#include <cstddef>
#include <memory_resource>

namespace fw::core {

class Memory final : public std::pmr::memory_resource {
 public:
    explicit Memory(const FwCallbacks& callbacks) noexcept : callbacks_(callbacks) {}
    Memory(const Memory&) = delete;
    Memory& operator=(const Memory&) = delete;

    // Bytes allocated now.
    [[nodiscard]] size_t bytes() const noexcept { return bytes_.load(std::memory_order_relaxed); }

 private:
    void* do_allocate(size_t size, size_t alignment) override;  // throws std::bad_alloc
    void do_deallocate(void* memory, size_t size, size_t alignment) override;
    bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override {
        return this == &other;
    }

    FwCallbacks callbacks_;
    std::atomic<size_t> bytes_{0};
};

}  // namespace fw::core
