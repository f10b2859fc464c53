// The host's depth at a pixel; of several samples the first, for a choice of one needs a feature.
#ifndef FW_LIB_SCENE_DEPTH_GLSL
#define FW_LIB_SCENE_DEPTH_GLSL
#if FW_SOFT == 2
layout(set = 3, binding = 0) uniform sampler2DMS sceneDepth;
#else
layout(set = 3, binding = 0) uniform sampler2D sceneDepth;
#endif
#endif
