// Declarations that the stages of volume_composite share.
#include "shared/burn.h"
#include "shared/volume_draw.h"
layout(push_constant) uniform Push { CompositePush draw; };
layout(location = 0) centroid FW_VARYING vec2 vPixel;  // of the flame, from the middle of its first
layout(location = 1) flat FW_VARYING uint vWords;      // first of the slab
layout(location = 2) flat FW_VARYING vec2 vSlab;  // m along the view: near distance; 1/m: depth
layout(location = 3) flat FW_VARYING ivec4 vPixels;    // first and last valid
layout(location = 4) flat FW_VARYING uint vPerPixel;
layout(location = 5) flat FW_VARYING vec2 vShows;
// Clip z / w of the plane through the base; VolumeDraw::base.w.
layout(location = 6) centroid FW_VARYING vec2 vBase;
