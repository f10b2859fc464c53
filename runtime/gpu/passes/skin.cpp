// Drawn vertices from a vertex buffer that the host lends.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kSkinUses[] = {
    {FW_BIND_SKIN_SOURCES, Access::read},
    {FW_BIND_SKIN_GIVEN, Access::read},
    {FW_BIND_SHOWN, Access::write},
};

}  // namespace

const ComputePass kSkinPass{"skin", "skin.comp", kSkinUses, sizeof(SkinPush)};

}  // namespace fw::gpu
