#version 450
// Depth pre-pass of an object's mesh, both sides; see surface.vert.
#extension GL_GOOGLE_include_directive : require
#include "shared/burn.h"
#include "shared/look.h"

layout(set = 0, binding = FW_BIND_VIEW, std140) uniform View { ViewParams view; };
layout(push_constant) uniform Push { SurfaceDraw draw; };

layout(location = 0) in vec3 inPosition;  // m, object space, as displayed

#include "surface/place.glsl"

void main() { gl_Position = clipPlace(fromEye(inPosition)); }
