// Buffers that lib/light.glsl needs; include before lib/buffers.glsl. gpu/passes/light_uses.h binds
// them.
#define FW_USE_EXCHANGE_PUSH
#define FW_USE_OBJECTS readonly
#define FW_USE_TILES readonly
#define FW_USE_DEPENDENTS readonly
#define FW_USE_STATE FW_READ_WRITE
#define FW_USE_TILE_STATE FW_READ_WRITE
#define FW_USE_LISTS FW_READ_WRITE
#define FW_USE_COUNTERS FW_READ_WRITE
#define FW_USE_OBJECT_COUNTERS FW_READ_WRITE
#define FW_USE_BURN_LISTS FW_READ_WRITE
#define FW_USE_PREDICT_LISTS FW_READ_WRITE
#define FW_USE_HOT_LISTS FW_READ_WRITE
#define FW_USE_PUBLISHED FW_READ_WRITE
#define FW_USE_EXCHANGE_OBJECTS
#define FW_USE_TEXELS readonly
