#include "gpu/passes/blend_order.h"

#include "shared/look.h"

namespace fw::gpu {

uint32_t fewQuads(bool software) noexcept { return software ? 1024 : kMaxFewQuads; }

}  // namespace fw::gpu
