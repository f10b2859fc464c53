// The frame's view.
#include "lib/buffers.glsl"
#include "shared/burn.h"
#include "shared/look.h"
FW_UNIFORM(VIEW, ViewParams, view)
