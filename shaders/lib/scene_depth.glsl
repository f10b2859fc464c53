// The host's depth at a pixel; the first of several samples, as choosing one needs a device
// feature.
#if FW_SOFT == 2
layout(set = 3, binding = 0) uniform sampler2DMS sceneDepth;
#else
layout(set = 3, binding = 0) uniform sampler2D sceneDepth;
#endif
