// Volumetric flames as slices of their lattice: planes across the view, evenly apart, each cut by
// the device into a convex polygon per piece of the lattice. Nothing is marched before. Only where
// light is added as it is, not where it is tone mapped: there many thin slices would be brighter
// than their sum.
#include "lod/volumes.h"
#include "shared/volume_slices.h"

#include <algorithm>
#include <cmath>

namespace fw::lod {
namespace {

constexpr float kFewest = 12.0f;  // slices of a flame
constexpr float kApart = 0.5f;    // of VolumeDraw::spacing: sheets are closer than that

}  // namespace

bool slicesShow(uint32_t encoding) noexcept { return encoding == 0; }  // FW_OUTPUT_LINEAR

SlicedVolume makeSlicedVolume(const VolumeItem& item) noexcept {
    SlicedVolume out;
    out.flame = item.flame;
    SlicesPush& draw = out.draw;
    const float deep = item.far - item.near;
    draw.clip = item.draw.clip;
    draw.front = item.near;
    draw.slices = uint32_t(
        std::clamp(std::ceil(deep / (kApart * item.draw.spacing)), kFewest, float(kVolumeSlices)));
    draw.spacing = deep / float(draw.slices);
    draw.to = 1.0f;
    return out;
}

}  // namespace fw::lod
