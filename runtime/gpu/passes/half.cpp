// The target of half resolution: what is soft of a view is drawn there against the host's depth,
// and laid over the picture at once, along its edges of full resolution.
#include "gpu/passes/draw.h"

namespace fw::gpu {
namespace {

constexpr DrawPass halfPass(const char* name, const char* shader, const char* multisampled) {
    return {.name = name,
            .vertexShader = "half_all.vert",
            .fragmentShader = nullptr,
            .uses = {},
            .vertexInput = VertexInput::none,
            .blend = Blend::opaque,
            .writeDepth = false,
            .pushBytes = sizeof(HalfPush),
            .softShader = shader,
            .softShaderMultisampled = multisampled,
            .atHalf = AtHalf::depth};
}

constexpr uint32_t parts(uint32_t all, uint32_t each) { return (all + each - 1) / each; }

}  // namespace

const DrawPass kHalfDepthPass = halfPass("half depth", "half_depth.frag", "half_depth_ms.frag");
const DrawPass kHalfTilesPass = halfPass("half tiles", "half_tiles.frag", "half_tiles.frag");
const DrawPass kHalfCompositePass{.name = "half composite",
                                  .vertexShader = "half_composite.vert",
                                  .fragmentShader = nullptr,
                                  .uses = {},
                                  .vertexInput = VertexInput::none,
                                  .blend = Blend::premultiplied,
                                  .writeDepth = false,
                                  .pushBytes = sizeof(HalfPush),
                                  .softShader = "half_composite.frag",
                                  .softShaderMultisampled = "half_composite_ms.frag",
                                  .atHalf = AtHalf::over};

HalfPush halfPush(const ViewParams& view, int left, int top, uint32_t width, uint32_t height) {
    HalfPush push{};
    push.clip = volumeClip(view);
    push.left = left;
    push.top = top;
    push.width = width;
    push.height = height;
    push.texelsX = parts(width, 2);
    push.texelsY = parts(height, 2);
    push.tilesX = parts(push.texelsX, kHalfTile);
    push.tilesY = parts(push.texelsY, kHalfTile);
    return push;
}

}  // namespace fw::gpu
