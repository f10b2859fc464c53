// Runs of particle fields by units of eight strips, as the pass takes them: groups of kFieldUnits,
// each with units of whole fields. Not the recording of it.
#pragma once
#include "gpu/backend.h"
#include "shared/field.h"

namespace fw::gpu {

// Units of a field this wide.
constexpr uint32_t fieldUnitsOf(uint32_t width) noexcept { return (width + 31) / 32; }

// Hands over those of `runs`, in order; returns how many groups they are. widthOf: of a field's
// slot, in cells.
template <typename WidthOf, typename Put>
uint32_t fieldUnits(std::span<const FieldRun> runs, const WidthOf& widthOf, const Put& put) {
    constexpr uint32_t kIdle = 0xFFu << 16;
    uint32_t units = 0;
    const auto fill = [&](uint32_t free) {
        for (units += free; free > 0; --free) put(FieldRun{runs[0].field | kIdle, runs[0].step});
    };
    for (const FieldRun& run : runs) {
        const uint32_t count = fieldUnitsOf(widthOf(run.field)), in = units % kFieldUnits;
        if (in + count > kFieldUnits) fill(kFieldUnits - in);
        for (uint32_t i = 0; i < count; ++i) put(FieldRun{run.field | i << 16, run.step});
        units += count;
    }
    fill((kFieldUnits - units % kFieldUnits) % kFieldUnits);
    return units / kFieldUnits;
}

}  // namespace fw::gpu
