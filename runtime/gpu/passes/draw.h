// What the drawing passes need from the looks' side, and what they get to record with.
#pragma once
#include "flamewright/flamewright.h"
#include "gpu/passes/pass.h"
#include "shared/look.h"

#include <cstddef>
#include <span>

namespace fw::gpu {

// Given by the looks: look_table.cpp, look_texture.cpp, view_params.cpp.
std::span<const MaterialLook> materialLooks();  // by FwMaterialPreset
constexpr uint32_t kLookTextureLayers = 3;
// RGBA8 of one mip of one layer; side = 512 >> mip, pixels.size() = side * side * 4. Deterministic.
void fillLookTexture(uint32_t layer, uint32_t mip, std::span<std::byte> pixels);

struct ViewInput {
    const FwView* view = nullptr;
    float viewport[4] = {};      // px: x, y, width, height
    uint32_t now = 0;            // tick of the state that is shown
    float tickFraction = 0;
    float wind[3] = {};          // m/s
    float up[3] = {0, 1, 0};
    float paceFactor = 1;
    uint32_t lightCount = 0, flameCapacity = 0, seed = 0;
};
void fillViewParams(const ViewInput& input, ViewParams& out);

// One object as `surface` draws it. Ranges are in the shared vertex and index planes.
struct DrawItem {
    uint32_t object = 0;  // slot
    uint32_t firstIndex = 0, indexCount = 0;
    int32_t vertexOffset = 0;
    uint32_t image = 0;   // as BurnObject::image
    bool twoSided = false;
};

// Records a draw pass: pipeline, sets and buffers are bound for it as its DrawPass says.
class DrawRecorder {
   public:
    virtual ~DrawRecorder() = default;
    virtual void drawItem(const DrawItem& item, const void* push) = 0;  // DrawPass::pushBytes
    // Non-indexed VkDrawIndirectCommand at `offset` bytes of the resource.
    virtual void drawIndirect(uint32_t resource, uint64_t offset, const void* push) = 0;
};

extern const DrawPass kSurfacePass;
void recordSurface(DrawRecorder& recorder, std::span<const DrawItem> items);
extern const DrawPass kFlamesPass;
void recordFlames(DrawRecorder& recorder);

}  // namespace fw::gpu
