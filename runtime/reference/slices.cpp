// Volumetric flames as slices of their lattice: planes across the view, evenly apart, each cut by
// the device into a convex polygon per piece of the lattice. Nothing is marched before. Only where
// light is added as it is, not where it is tone mapped: there many thin slices would be brighter
// than their sum.
#include "reference/methods.h"
#include "reference/volume_slices.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace fw::reference {
namespace {

constexpr float kFewest = 12.0f;  // slices of a flame
constexpr float kApart = 0.5f;    // of VolumeDraw::spacing: sheets are closer than that

}  // namespace

bool showsSlices(uint32_t encoding) noexcept { return encoding == FW_OUTPUT_LINEAR; }

gpu::VolumeCall drawSlices(const gpu::VolumeItem& item, float from, float to) noexcept {
    gpu::SlicesPush draw{};
    const float deep = item.far - item.near;
    draw.clip = item.draw.clip;
    draw.front = item.near;
    draw.slices = uint32_t(std::clamp(std::ceil(deep / (kApart * item.draw.spacing)), kFewest,
                                      float(gpu::kVolumeSlices)));
    draw.spacing = deep / float(draw.slices);
    draw.from = from;
    draw.to = to;
    gpu::VolumeCall call{item.flame, gpu::kFlamePieces * gpu::kSliceVertices, draw.slices};
    static_assert(sizeof draw <= sizeof call.push);
    std::memcpy(call.push.data(), &draw, sizeof draw);
    return call;
}

}  // namespace fw::reference
