// Models, the pond, and the land with a bump-mapped relief.
#version 450
#extension GL_GOOGLE_include_directive : require
#include "village_surface.glsl"
