// FNV-1a over the input of a bake; the cache key of its result.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace fwimport {

struct ContentHash {
    uint64_t value = 0xcbf29ce484222325ull;
    void add(const void* data, size_t size) {
        const auto* bytes = static_cast<const uint8_t*>(data);
        for (size_t i = 0; i < size; ++i) value = (value ^ bytes[i]) * 0x100000001b3ull;
    }
    template <typename T>
    void add(const std::vector<T>& values) {
        add(values.data(), values.size() * sizeof(T));
    }
    template <typename T>
    void addValue(T item) {
        add(&item, sizeof item);
    }
};

}  // namespace fwimport
