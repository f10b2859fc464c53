// March pixels as a draw reads them: four words each, one texel where the device has texel buffers.
#ifdef FW_TEXELS
layout(rgba32ui, set = 0, binding = FW_BIND_COUNT + FW_BIND_VOLUME_RAYS) readonly uniform uimageBuffer cells;
uvec4 cellAt(uint word) { return imageLoad(cells, int(word / kMarchPixelWords)); }
#else
layout(set = 0, binding = FW_BIND_VOLUME_RAYS, std430) readonly buffer Rays { uint rays[]; };
uvec4 cellAt(uint word) { return uvec4(rays[word], rays[word + 1u], rays[word + 2u], 0u); }
#endif

vec4 cellColor(uvec4 cell) { return vec4(unpackHalf2x16(cell.x), unpackHalf2x16(cell.y)); }
