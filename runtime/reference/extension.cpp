// The extension of the library that these methods are.
#include "core/error.h"
#include "core/reserved.h"
#include "embedded_reference_shaders.h"
#include "reference/methods.h"
#include "reference/pattern_frame.h"
#include "reference/published.h"
#include "reference/volume_slices.h"

#include <array>

namespace fw {
namespace {

using reference::DrawNumber;

// Walls that have crossed: the nearest depth of an object from both sides first, then only what
// faces the camera and is not behind it.
constexpr gpu::DrawPass kDepthPeelPass{.name = "depth_peel",
                                       .vertexShader = "depth_peel.vert",
                                       .fragmentShader = nullptr,
                                       .vertexInput = gpu::VertexInput::mesh,
                                       .blend = gpu::Blend::depthAlone,
                                       .writeDepth = true,
                                       .pushBytes = sizeof(gpu::SurfaceDraw),
                                       .behind = true,
                                       .drawnIn = gpu::DrawnIn::surfaces};
constexpr gpu::DrawPass kSlicesPass{.name = "volume_slices",
                                    .vertexShader = "volume_slices.vert",
                                    .fragmentShader = "volume_slices.frag",
                                    .pushBytes = sizeof(gpu::SlicesPush),
                                    .softShader = "volume_slices_soft.frag",
                                    .softShaderMultisampled = "volume_slices_soft_ms.frag",
                                    .atHalf = gpu::AtHalf::soft,
                                    .textures2 = gpu::Textures::profiles};
constexpr std::array kDrawPasses{kDepthPeelPass, kSlicesPass};  // by DrawNumber

constexpr std::array<gpu::ComputePass, 3> kComputePasses{{
    // by ComputeNumber
    {"springs", sizeof(gpu::DeformPush)},
    {"refine_pattern", sizeof(gpu::PatternPush)},
    {"published", sizeof(gpu::StepPush)},
}};

void createObject(gpu::vk::BackendState& s, gpu::vk::ObjectEntry& fresh,
                  const gpu::ObjectInit& init, uint64_t last) {
    if (init.deform && (init.deform->flags & gpu::kDeformExtended))
        reference::createSprings(s, fresh, init, last);
    if (init.refineExtended) reference::createPattern(s, fresh, init, last);
    const uint32_t tiles = s.scene.meshes[init.mesh].tiles;
    if (init.record.flags & gpu::kObjectExtended)
        fresh.extensionTiles = s.buffers.allocate(gpu::vk::kPoolExtensionTiles, tiles, last);
}

uint32_t publishedGroups(const gpu::BurnObject& object) noexcept {
    const uint32_t rows = (object.height + gpu::kPublishedBlockY - 1) / gpu::kPublishedBlockY;
    return gpu::vk::groupsOf(object.width / gpu::kPublishedBlockX * rows);
}

constexpr gpu::cpu::CpuMethods kCpu{
    .create = reference::createPublished,
    .event = reference::publishedEvent,
    .step = reference::publishedStep,
};

constexpr gpu::vk::VkMethods kVulkan{
    .createObject = createObject,
    .stepGroups = publishedGroups,
    .destroyObject = reference::dropPattern,
    .destroyMesh = reference::dropPatternModels,
    .refineOptions = reference::patternOptions,
    .createRefinement = reference::createPatternModel,
    .startBoundary = reference::startPatternBoundary,
    .planRefinement = reference::planPatterns,
    .recordRefinement = reference::recordPatterns,
    .refinedCount = reference::listedCount,
};

}  // namespace

const gpu::Extension* gpu::extension() noexcept {
    static const Extension extension{
        .shaders = embeddedReferenceShaders(),
        .computePasses = kComputePasses,
        .drawPasses = kDrawPasses,
        .showsVolumes = reference::showsSlices,
        .volumePass = numberOf(DrawNumber::kVolumeSlices),
        .volumeCall = reference::drawSlices,
        .depthPass = numberOf(DrawNumber::kDepthPeel),
        .deformPass = reference::passOf<gpu::DeformPush>(reference::kSprings),
        .stepPass = reference::passOf<gpu::StepPush>(reference::kPublished),
        .vulkan = &kVulkan,
        .cpu = &kCpu,
    };
    return &extension;
}

// All of them are implemented.
void core::reserved::checkBurnable(uint32_t flags) {
    if ((flags & kDepth) && !(flags & (FW_BURNABLE_RECEDE | kSolver)))
        core::fail(
            FW_ERROR_INVALID_ARGUMENT,
            "FwBurnableMeshDef::flags is 0x%x; FW_BURNABLE_DEPTH_PEEL needs SPRINGS or RECEDE.",
            flags);
}
void core::reserved::checkField(uint32_t /*flags*/) {}
void core::reserved::checkFireTier(uint32_t /*tier*/, const char* /*field*/) {}
void core::reserved::checkSwitches(uint32_t /*switches*/) {}

}  // namespace fw
