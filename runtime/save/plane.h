// Lossless compression of a plane of whole numbers that vary smoothly where they vary, and are
// constant over wide parts: arrival ticks, temperatures, char. A predictor of its neighbours, and
// what it misses by as bits of an adaptive range coder (Martin 1979, with the carries of LZMA).
// Integers alone: the same bytes on every machine.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace fw::save {

// Which cells have a value: the others are neither written nor read, and predict nothing. All of
// them where it is empty; else one byte per cell, 0: none.
using PlaneMask = std::span<const uint8_t>;

// Appends to `out`, whole bytes. Rows of `width`.
void writePlane(std::span<const uint32_t> values, uint32_t width, PlaneMask mask,
                std::pmr::vector<std::byte>& out);
// From the whole of `bytes`; cells outside of the mask stay. False: it is none of writePlane's.
[[nodiscard]] bool readPlane(std::span<const std::byte> bytes, uint32_t width, PlaneMask mask,
                             std::span<uint32_t> values);

}  // namespace fw::save
