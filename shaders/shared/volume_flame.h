// A volumetric flame in its buffer, as a draw reads it.
#ifndef FW_SHARED_VOLUME_FLAME_H
#define FW_SHARED_VOLUME_FLAME_H
#include "shared/volume.h"
#include "shared/volume_draw.h"

FW_SHARED_BEGIN

struct VolumeFlame {
    FlameRecord record;
    FlameNode nodes[kFlameNodes];
};
FW_SIZE(VolumeFlame, kVolumeFlameBytes)

FW_SHARED_END
#endif
