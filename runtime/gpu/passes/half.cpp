// The target of half resolution: what is soft of a view is drawn there against the host's depth,
// and laid over the picture at once, along its edges of full resolution.
#include "gpu/passes/draw.h"

namespace fw::gpu {
namespace {

constexpr uint32_t parts(uint32_t all, uint32_t each) { return (all + each - 1) / each; }

}  // namespace

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
