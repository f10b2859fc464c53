// Declarations that the stages of the flames' draws share.
#include "lib/view.glsl"
layout(location = 0) centroid FW_VARYING vec2 vPlace;  // x: -1..1, y: 0 foot .. 1 tip
layout(location = 1) flat FW_VARYING vec4 vState;  // opacity, phase, kelvin, length over half width
layout(location = 2) flat FW_VARYING uint vKind;
layout(location = 3) flat FW_VARYING float vWidth;  // m, half width
layout(location = 4) flat FW_VARYING vec2 vSun;     // light direction in the quad's plane
#ifdef FW_FLIPBOOKS
#include "shared/flipbook.h"
layout(location = 5) flat FW_VARYING vec4 vFrames;   // texel of the frame before, of the one after
layout(location = 6) flat FW_VARYING vec4 vMotions;  // the same of their motion
layout(location = 7) flat FW_VARYING vec4 vSizes;    // texels of a frame, of its motion
layout(location = 8) flat FW_VARYING vec2 vBetween;  // blend weight, largest motion
#endif
