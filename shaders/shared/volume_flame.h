// A volumetric flame as it lies in its plane, and as a draw sees it.
// GLSL too, and laid out by hand.
// clang-format off
#ifndef FW_SHARED_VOLUME_FLAME_H
#define FW_SHARED_VOLUME_FLAME_H
#include "shared/volume.h"
#include "shared/volume_draw.h"

FW_SHARED_BEGIN

struct VolumeFlame {
    FlameRecord record;
    FlameNode nodes[kFlameNodes];
};
FW_SHARED_SIZE(VolumeFlame, kVolumeFlameBytes)

FW_SHARED_END
#endif
