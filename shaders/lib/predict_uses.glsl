// Buffers of the prediction passes: include before lib/buffers.glsl.
#define FW_USE_PUSH
#define FW_USE_OBJECTS readonly
#define FW_USE_OBJECT_QUADS
#define FW_USE_STATE readonly
#define FW_USE_GRADIENT FW_READ_WRITE
