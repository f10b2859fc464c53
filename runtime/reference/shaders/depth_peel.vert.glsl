// Depth pre-pass of an object's mesh, both sides; see surface.vert.
#include "lib/view.glsl"
layout(push_constant) uniform Push { SurfaceDraw draw; };

layout(location = 0) in vec3 inPosition;  // m, object space, as displayed

#include "surface/place.glsl"

void main() { gl_Position = clipPlace(fromEye(inPosition)); }
