// Ground and road with a parallax relief.
#version 450
#extension GL_GOOGLE_include_directive : require
#define FW_LAND
#include "village_surface.glsl"
