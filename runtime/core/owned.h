// One object in pmr memory with a stable address: a unique pointer that knows its resource.
#pragma once
#include "core/assert.h"

#include <memory_resource>
#include <utility>

namespace fw::core {

template <class T>
class Owned {
 public:
    Owned() = default;
    template <class... Arguments>
    static Owned make(std::pmr::memory_resource* memory, Arguments&&... arguments) {
        Owned owned;
        owned.value_ = std::pmr::polymorphic_allocator<>(memory).new_object<T>(
            std::forward<Arguments>(arguments)...);
        owned.memory_ = memory;
        return owned;
    }
    Owned(Owned&& other) noexcept
        : value_(std::exchange(other.value_, nullptr)), memory_(other.memory_) {}
    Owned& operator=(Owned&& other) noexcept {
        std::swap(value_, other.value_);
        std::swap(memory_, other.memory_);
        return *this;
    }
    ~Owned() {
        if (value_) std::pmr::polymorphic_allocator<>(memory_).delete_object(value_);
    }

    [[nodiscard]] T* get() const noexcept { return value_; }
    T& operator*() const noexcept {
        FW_ASSERT(value_);
        return *value_;
    }
    T* operator->() const noexcept {
        FW_ASSERT(value_);
        return value_;
    }
    explicit operator bool() const noexcept { return value_ != nullptr; }

 private:
    T* value_ = nullptr;
    std::pmr::memory_resource* memory_ = nullptr;
};

}  // namespace fw::core
