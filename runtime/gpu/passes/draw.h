// Inputs of the draw passes: where appearance comes from, and the items that a view draws.
#pragma once
#include "core/assert.h"
#include "flamewright/flamewright.h"
#include "gpu/passes/pass.h"
#include "lod/volumes.h"
#include "shared/appearance.h"
#include "shared/field.h"
#include "shared/half.h"
#include "shared/heat.h"
#include "shared/volume_draw.h"

#include <array>
#include <cstddef>
#include <memory_resource>
#include <span>
#include <vector>

namespace fw::gpu {

using namespace lod;

struct ViewInput {  // of ViewParams
    const FwView* view = nullptr;
    float viewport[4] = {};  // px: x, y, width, height
    uint32_t now = 0;        // tick of the state that is shown
    float tickFraction = 0;
    float wind[3] = {};  // m/s
    float up[3] = {0, 1, 0};
    float paceFactor = 1;
    uint32_t lightCount = 0, flameCapacity = 0, seed = 0;
    float lastLight = 1;  // share of its own fires that the last light shines for
    float quadShare = 1;  // of flames' quads and particles that show
    bool bodies = false;  // bodies of fire show, so flame quads of their objects do not
};
// The host's view as the uniform block that shaders read.
[[nodiscard]] ViewParams makeViewParams(const ViewInput& input) noexcept;

// Given by the layer above, which knows how things look.
constexpr uint32_t kAppearanceTextureLayers = 3;
struct AppearanceSources {
    std::span<const MaterialAppearance> table;  // by FwMaterialPreset. Copied
    std::span<const MaterialFamily> families;   // by FwMaterialPreset; static
    // RGBA8, 512^2, layer by layer, each with its 10 mips, largest first. Copied.
    std::span<const std::byte> textures;
    // R16G16_SFLOAT, kProfileWidth x kProfileHeight, kFirePresets layers. Copied.
    std::span<const std::byte> profiles;

    [[nodiscard]] MaterialFamily familyOf(const BurnMaterial& material) const noexcept {
        return material.appearance < families.size() ? families[material.appearance]
                                                     : MaterialFamily::wood;
    }
};

// One material of one object as `surface` draws it. Ranges are in the shared vertex and index
// buffers.
struct DrawItem {
    uint32_t object = 0;  // slot
    uint32_t material = 0;
    uint32_t firstIndex = 0, indexCount = 0;
    int32_t vertexOffset = 0;
    uint32_t shown = kNoneTexel;  // first of its own shown vertices; kNoneTexel: the mesh's
    uint32_t inside =
        kNoneTexel;            // first of its mesh's vertices on the inner skin; kNoneTexel: none
    bool insideShown = false;  // of its own shown vertices there
    uint32_t image = 0;        // base-colour image slot + 1, 0: none
    MaterialFamily family = MaterialFamily::wood;
    bool burns = false;      // fire may show on it
    bool coldApart = false;  // its triangles where nothing shows are drawn as SurfaceState::cold
    float coldReach = 0;     // texels, of those
    bool refined = false;    // its triangles are in the refinement's buffers
    bool cut = false;        // and some of them are cut
    bool perPixelHoles = false;  // the cut along open edges is too coarse: texels show the holes
    uint32_t inner = 0;          // from a vertex's place to that on the inner skin; 0: has none
    bool consumed = false;       // those burnt through are left out, whole: nothing is cut
    bool depthFirst = false;     // drawn after the others, behind its own nearest depth
    SurfaceDraw draw{};
};

// The order of a view's draws. Surfaces of DepthFirst come after the other surfaces: where a back
// face is nearest they show what was drawn before. Haze bends solid surfaces alone. Fields,
// flames and volumes are soft: in a target of half resolution they are drawn there, and come over
// the picture with HalfResolutionComposite, with sparks after them.
enum class DrawPhase : uint8_t {
    OpaqueFresh,
    OpaqueBurning,
    DepthFirst,
    OpaqueOverDepth,
    Distortion,
    Fields,
    Flames,
    Volumes,
    HalfResolutionComposite,
    Sparks,
    Transparency,
    Count,
};

struct SurfaceStep {  // a draw of an item
    DrawPhase phase{};
    uint32_t pass = 0;  // of drawPasses()
    uint32_t item = 0;
};
// All draws of `items`, by phase, pass and item. `out` has room for kMostSurfaceSteps of each.
constexpr uint32_t kMostSurfaceSteps = 3;
void orderSurfaces(std::span<const DrawItem> items, std::pmr::vector<SurfaceStep>& out) noexcept;
// Every pass that may draw such a material, whatever becomes of it.
[[nodiscard]] DrawPassSet surfacePasses(MaterialFamily family, bool image);
// `edge`: m, mean edge of the object's triangles.
// `places`: of the object's vertices among the refined ones.
// `doused`: something wetted it or put it out, some day. `warmed`: others' fires sent heat to it.
SurfaceDraw surfaceDraw(const BurnObject& object, const BurnMaterial& material,
                        const HeatMaterial& heat, float edge, uint32_t places, bool doused,
                        bool warmed);
struct FieldItem {      // a particle field that a view may show
    uint32_t draw = 0;  // its record
    draw::Number pass{};
    uint32_t vertices = 0;
    float depth = 0;  // m
};
// Volumetric flames of all kinds as a view draws them, farthest first: runs of neighbours that one
// pass draws, each run behind the last one of its pass.
struct VolumeRun {
    draw::Number pass{};
    uint32_t first = 0, count = 0;
};
struct VolumeOrder {
    std::array<VolumeRun, 3 * kMaxVolumeFlames> runs;  // a flame that turns may be in three
    uint32_t count = 0;
    // The next flame is `index` of its pass.
    void add(draw::Number pass, uint32_t index) noexcept {
        if (count > 0 && runs[count - 1].pass == pass) {
            ++runs[count - 1].count;
            return;
        }
        FW_ASSERT(count < runs.size(), "%u runs", count);
        runs[count++] = {pass, index, 1};
    }
};

}  // namespace fw::gpu
