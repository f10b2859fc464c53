// The host's picture over ours, by how transparent the host has all of ours together: exact
// whatever lies over what, and no other pass knows of it.
#include "gpu/passes/draw.h"

namespace fw::gpu {

const DrawPass kTransparencyPass{.name = "transparency",
                                 .vertexShader = "half_all.vert",
                                 .fragmentShader = "transparency.frag",
                                 .uses = {},
                                 .vertexInput = VertexInput::none,
                                 .blend = Blend::constant,
                                 .writeDepth = false,
                                 .pushBytes = 0,
                                 .softShader = "transparency.frag",
                                 .softShaderMultisampled = "transparency.frag"};

}  // namespace fw::gpu
