// What the published model does about walls that have crossed: the depth of an object from both
// sides first, nearest wins; then only what faces the eye and is not behind that. Where a back
// face is nearest nothing of the object is drawn, and what was drawn before shows.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kZPassUses[] = {{FW_BIND_VIEW, Access::uniformView}};

}  // namespace

const DrawPass kZPass{.name = "z pass",
                      .vertexShader = "z_pass.vert",
                      .fragmentShader = nullptr,
                      .uses = kZPassUses,
                      .vertexInput = VertexInput::mesh,
                      .blend = Blend::depthAlone,
                      .writeDepth = true,
                      .pushBytes = sizeof(SurfaceDraw),
                      .behind = true};

bool zPassDraws(std::span<const DrawItem> items) {
    for (const DrawItem& item : items)
        if (item.zPass) return true;
    return false;
}

void recordZPass(DrawRecorder& recorder, std::span<const DrawItem> items) {
    for (const DrawItem& item : items)
        if (item.zPass) recorder.drawItem(item, &item.draw);
}

}  // namespace fw::gpu
