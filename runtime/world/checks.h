// Checks of a host's numbers that the systems of a world share.
#pragma once
#include "core/error.h"

#include <cstdint>

namespace fw::world {

inline void checkFlags(uint32_t flags, uint32_t known, const char* field) {
    if (flags & ~known)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "%s is 0x%x; the known flags are 0x%x.", field, flags,
                   known);
}

inline void checkLimit(uint32_t value, const char* field, uint32_t low, uint32_t high) {
    if (value < low || value > high)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "%s is %u; the limits are [%u, %u].", field, value,
                   low, high);
}

}  // namespace fw::world
