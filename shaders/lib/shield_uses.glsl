// Buffers of lib/shield.glsl; include before lib/buffers.glsl. gpu/passes/shield_uses.h binds them.
#define FW_USE_SHIELD
#define FW_USE_STATE readonly
#define FW_USE_HEAT readonly
#define FW_USE_MATERIALS readonly
