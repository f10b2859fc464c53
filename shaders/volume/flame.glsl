// The view and the flame of a draw or march.
#include "lib/view.glsl"
#include "shared/volume.h"
FW_UNIFORM(VOLUMES, VolumeFlame, flame)
#define FW_FLAME_NODE(i) flame.nodes[i]
