// Capacity for vectors that gain a few entries at a time.
#pragma once
#include <algorithm>
#include <cstddef>

namespace fw::core {

// Reserves `count` entries in all, at least doubling the capacity: exact reserves would copy all
// entries with every call. Throws std::bad_alloc.
template <class Vector>
void growTo(Vector& vector, std::size_t count) {
    if (vector.capacity() < count) vector.reserve(std::max(count, vector.capacity() * 2));
}

}  // namespace fw::core
