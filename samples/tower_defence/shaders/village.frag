// Models, the pond, and the land with its relief as bumps only.
#version 450
#extension GL_GOOGLE_include_directive : require
#include "village_surface.glsl"
