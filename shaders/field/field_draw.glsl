// Declarations that the stages of field_draw share.
#include "lib/view.glsl"
#include "shared/field.h"
FW_READ(FIELD_SHOWN)
layout(location = 0) centroid FW_VARYING vec2 vPlace;   // over the field, [0, 1]
layout(location = 1) centroid FW_VARYING vec3 vNormal;  // of the body
layout(location = 2) centroid FW_VARYING vec3 vToEye;   // m
layout(location = 3) centroid FW_VARYING vec3 vAlong;   // direction of the field's x
layout(location = 4) flat FW_VARYING vec4 vBody;    // detail, body, time s, opacity
layout(location = 5) flat FW_VARYING vec4 vTint;    // w: steps per second
layout(location = 6) flat FW_VARYING uvec4 vField;  // first cell, width, height, 1: spheroid
layout(location = 7) flat FW_VARYING vec4 vSize;  // m per cell; cells of mean height; depth m; seed
