// Burnable meshes as they look now, one draw per object.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kUses[] = {
    {FW_BIND_OBJECTS, Access::drawRead},  {FW_BIND_MATERIALS, Access::drawRead},
    {FW_BIND_PREDICT, Access::drawRead},  {FW_BIND_GRADIENT, Access::drawRead},
    {FW_BIND_LIGHTS, Access::drawRead},   {FW_BIND_LOOKS, Access::drawRead},
    {FW_BIND_VIEW, Access::uniformView},
};

struct SurfacePush {
    uint32_t object;
};

}  // namespace

const DrawPass kSurfacePass{
    "surface", "surface.vert", "surface.frag", kUses, VertexInput::mesh, Blend::opaque,
    true,      sizeof(SurfacePush)};

void recordSurface(DrawRecorder& recorder, std::span<const DrawItem> items) {
    for (const DrawItem& item : items) {
        const SurfacePush push{item.object};
        recorder.drawItem(item, &push);
    }
}

}  // namespace fw::gpu
