// Capacity for vectors that gain a few entries at a time.
#pragma once
#include <algorithm>
#include <cstddef>

namespace fw::core {

// Capacity for `count` entries in all; throws std::bad_alloc. At least twice the capacity that
// there was, because a reserve of exactly as many as are needed copies all entries with every call.
template <class Vector>
void growTo(Vector& vector, std::size_t count) {
    if (vector.capacity() < count) vector.reserve(std::max(count, vector.capacity() * 2));
}

}  // namespace fw::core
