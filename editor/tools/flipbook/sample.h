// Texels of a flipbook as the device samples them, for pictures of a baked one and for tests.
#pragma once
#include "flipbook/flipbook.h"

namespace fw::flipbook {

using gpu::vec2;
using gpu::vec4;

// Bilinear like a sampler, zero beyond the borders.
vec4 frameAt(const Flipbook& book, uint32_t frame, vec2 uv) noexcept;
vec2 motionAt(const Flipbook& book, uint32_t frame, vec2 uv) noexcept;  // uv per frame
// A texel between two frames (shared/flipbook.h). time: see flipbookPlaceAt.
vec4 sampleFlipbook(const Flipbook& book, float time, vec2 uv) noexcept;

}  // namespace fw::flipbook
