// March pixels as a draw reads them: four words each, one texel where the device has texel buffers.
#include "lib/buffers.glsl"
#ifdef FW_TEXELS
FW_TEXEL_BUFFER(VOLUME_RAYS, readonly, cells)
uvec4 cellAt(uint word) { return imageLoad(cells, int(word / kMarchPixelWords)); }
#else
FW_READ(VOLUME_RAYS)
uvec4 cellAt(uint word) { return uvec4(rays[word], rays[word + 1u], rays[word + 2u], 0u); }
#endif

vec4 cellColor(uvec4 cell) { return vec4(unpackHalf2x16(cell.x), unpackHalf2x16(cell.y)); }
