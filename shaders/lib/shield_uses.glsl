// Buffers that lib/shield.glsl needs: included before lib/buffers.glsl, beside what a pass has of its own.
// gpu/passes/shield_uses.h binds them.
#define FW_USE_SHIELD
#define FW_USE_STATE readonly
#define FW_USE_HEAT readonly
#define FW_USE_MATERIALS readonly
