// Declarations that the stages of the surface pass share.
#include "lib/view.glsl"
#include "surface/plume.glsl"

// Material families of a variant, and whether it can burn (kSurface...). A software device executes
// both sides of every branch, so unused code is compiled out.
layout(constant_id = 2) const uint kVariant = 127u;

FW_UNIFORM(LIGHTS, BurnLight, lights[kSurfaceLights])
layout(push_constant) uniform Push { SurfaceDraw draw; };

// centroid: values at a pixel's middle beside the triangle would extrapolate off the mesh and
// outline burnt triangles.
// M, world, relative to the camera; w: flame light, red.
layout(location = 0) centroid FW_VARYING vec4 vPositionFire;
layout(location = 1) centroid FW_VARYING vec4 vRestFire;  // m, object axes, world scale; w: green
layout(location = 2) centroid FW_VARYING vec4 vNormalFire;  // w: blue
layout(location = 3) centroid FW_VARYING vec4 vTexture;     // xy: texels of the atlas; zw: UV
layout(location = 4) centroid FW_VARYING vec4 vDetail;      // xy: m; zw and ...
layout(location = 5) centroid FW_VARYING vec4 vTint;        // w: ... mean direction to the flames
// Soot of flames below; appearance seconds, see inOffset; with kDrawCut the last word of a cut
// vertex, in s; with kSurfaceCold x: 1 near traces of fire.
layout(location = 6) centroid FW_VARYING vec2 vSootOffset;
#ifdef FW_MULTISAMPLED
// At pixels' middles, which form a grid, so differences between them are safe.
layout(location = 7) FW_VARYING vec3 vMiddle;    // as vPositionFire
layout(location = 8) FW_VARYING vec4 vMiddleUv;  // as vTexture and vDetail: xy
#endif
