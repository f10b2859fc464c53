// A volumetric flame that is drawn as slices of its lattice.
#ifndef FW_REFERENCE_SLICES_PUSH_H
#define FW_REFERENCE_SLICES_PUSH_H
#include "shared/volume_draw.h"

FW_SHARED_BEGIN

// Push constants of a flame that is drawn as slices of its lattice.
struct SlicesPush {
    vec4 clip;      // as VolumeDraw's
    float front;    // m along the view, near distance of the nearest slice
    float spacing;  // m along the view, per slice
    uint slices;    // [1, kVolumeSlices]
    float from;
    float to;  // see passesDither
    uint reserved0;
    uint reserved1;
    uint reserved2;
};
FW_SIZE(SlicesPush, 48)
FW_CONST uint kVolumeSlices = 96u;  // per flame, at most

FW_SHARED_END
#endif
