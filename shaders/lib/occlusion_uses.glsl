// Buffers of lib/occlusion.glsl; include before lib/buffers.glsl. gpu/passes/occlusion_uses.h binds them.
#define FW_USE_HEAT_OCCLUSION
#define FW_USE_STATE readonly
#define FW_USE_HEAT readonly
#define FW_USE_MATERIALS readonly
