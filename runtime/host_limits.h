// The limits that a host can meet, in one place, with their units. plugin/docs/limits.md is
// generated from this table (tests/unit/limits_test.cpp compares the two).
// Not named limits.h, which would hide the C header of that name.
#pragma once
#include "shared/burn.h"
#include "shared/deform.h"
#include "shared/exchange.h"
#include "shared/field.h"
#include "shared/flipbook.h"
#include "shared/particle.h"
#include "shared/refine.h"
#include "shared/room.h"
#include "shared/volume_draw.h"

#include <cstdint>

namespace fw::limits {

#define FW_LIMIT(group, name, value, unit, meaning) inline constexpr uint32_t name = value;
#include "host_limits.inl"
#undef FW_LIMIT

struct Row {
    const char* group;
    uint32_t value;
    const char* unit;
    const char* meaning;
};
inline constexpr Row kRows[] = {
#define FW_LIMIT(group, name, value, unit, meaning) {group, name, unit, meaning},
#include "host_limits.inl"
#undef FW_LIMIT
};

}  // namespace fw::limits
