// The frame's view.
#include "lib/buffers.glsl"
#include "shared/burn.h"
#include "shared/appearance.h"
FW_UNIFORM(VIEW, ViewParams, view)
