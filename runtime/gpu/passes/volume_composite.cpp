// Marched volumetric flames in the host's pass: a draw each, farthest first, of the tiles that show
// anything.
#include "gpu/passes/draw.h"

#include <cstddef>

namespace fw::gpu {
namespace {

constexpr Use kVolumeCompositeUses[] = {{FW_BIND_VOLUME_RAYS, Access::drawRead},
                                        {FW_BIND_VOLUME_RAYS, Access::drawTexels},
                                        {FW_BIND_VOLUME_WORK, Access::indirect}};

constexpr const char* kCompositeTexelShaders[] = {"volume_composite_texels.frag",
                                                  "volume_composite_texels_soft.frag",
                                                  "volume_composite_texels_soft_ms.frag"};

}  // namespace

const DrawPass kVolumeCompositePass{.name = "volume composite",
                                    .vertexShader = "volume_composite.vert",
                                    .fragmentShader = "volume_composite.frag",
                                    .uses = kVolumeCompositeUses,
                                    .vertexInput = VertexInput::none,
                                    .blend = Blend::premultiplied,
                                    .writeDepth = false,
                                    .pushBytes = sizeof(VolumeComposite),
                                    .softShader = "volume_composite_soft.frag",
                                    .softShaderMultisampled = "volume_composite_soft_ms.frag",
                                    .texelShaders = kCompositeTexelShaders,
                                    .atHalf = AtHalf::soft};

void recordVolumeComposite(DrawRecorder& recorder, std::span<const MarchedVolume> volumes) {
    for (const MarchedVolume& one : volumes)
        recorder.drawListed(FW_BIND_VOLUME_WORK,
                            one.march.flame * sizeof(VolumeWork) + offsetof(VolumeWork, vertices),
                            &one.composite);
}

}  // namespace fw::gpu
