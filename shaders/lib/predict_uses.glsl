// Buffers of every pass of prediction: included before lib/buffers.glsl, beside what a pass has of its own.
#define FW_USE_PUSH
#define FW_USE_OBJECTS readonly
#define FW_USE_OBJECT_QUADS
#define FW_USE_STATE readonly
#define FW_USE_GRADIENT FW_READ_WRITE
