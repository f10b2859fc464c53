// Declarations that the stages of volume_impostor share.
#include "shared/burn.h"
#include "shared/volume_draw.h"
layout(push_constant) uniform Push { VolumeImpostor draw; };
layout(location = 0) centroid FW_VARYING vec2 vPixel;
layout(location = 1) flat FW_VARYING vec2 vSlab;   // m along the view: near distance; 1/m: depth
layout(location = 2) flat FW_VARYING ivec4 vTaps;  // march pixels around a pixel, then all
layout(location = 3) flat FW_VARYING vec2 vHalf;   // march pixels, half the averaged square
layout(location = 4) flat FW_VARYING vec2 vShows;
layout(location = 5) centroid FW_VARYING vec2 vBase;  // as volume_composite's
