// Types of passes and of the buffers that they use. A pass is a row of a table: passes.inl
// (compute) or draw_passes.cpp (draws). Layouts, barriers, timers and labels follow from the row
// and from its shaders' declarations.
#pragma once
#include "shared/appearance.h"
#include "shared/body.h"
#include "shared/burn.h"
#include "shared/deform.h"
#include "shared/exchange.h"
#include "shared/field.h"
#include "shared/particle.h"
#include "shared/refine.h"
#include "shared/spark.h"
#include "shared/volume_draw.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace fw::gpu {

// A resource's number is its binding (FW_BIND_*). Behind those come resources that no shader binds.
constexpr uint32_t kMaxViews = 4;  // that a frame is recorded for
// Each view has its own of these.
constexpr std::array<uint32_t, 4> kResourcesOfViews{FW_BIND_FLAMES, FW_BIND_DRAW_ARGS,
                                                    FW_BIND_VOLUME_RAYS, FW_BIND_VOLUME_WORK};
enum Resource : uint32_t {
    kResourceVertices = FW_BIND_VERTICES,
    kResourceIndices = FW_BIND_COUNT,  // uint[]
    kResourceOfViews,                  // those of the second view, of the third, ...
    kResourceCount = kResourceOfViews + (kMaxViews - 1) * uint32_t(kResourcesOfViews.size()),
};

// The resource that a pass uses as `resource` when it runs for view `view`.
constexpr uint32_t resourceOf(uint32_t resource, uint32_t view) noexcept {
    for (uint32_t i = 0; view > 0 && i < kResourcesOfViews.size(); ++i)
        if (kResourcesOfViews[i] == resource)
            return kResourceOfViews + (view - 1) * uint32_t(kResourcesOfViews.size()) + i;
    return resource;
}

// Where a shader reads `resource` as a texel buffer: a pass may write the same buffer by words.
constexpr uint32_t texelBinding(uint32_t resource) noexcept { return FW_BIND_COUNT + resource; }

enum class Access : uint8_t {
    read,        // storage buffer
    write,       // storage buffer; also read-modify-write and atomics
    readTexels,  // storage texel buffer at texelBinding: software devices read four words faster
                 // so. Devices allow 4 a stage
    uniform,     // uniform buffer, at most 16 KiB
    indirect,    // arguments of a dispatch
    copyRead,
    copyWrite,
};

struct Use {
    uint32_t resource;
    Access access;
};

// Uniform buffers of which a dispatch or draw sees one record, by a dynamic offset.
constexpr bool isDynamic(uint32_t resource) noexcept {
    return resource == FW_BIND_VIEW || resource == FW_BIND_VOLUMES;
}

enum class FramePart : uint8_t { none, simulation, prediction, deformation, effects, refinement };
struct ComputePass {
    const char* name;                    // of the shader too, with ".comp" behind it
    uint32_t pushBytes;                  // <= 128
    FramePart begins = FramePart::none;  // a plain pass: the part that one group of it begins
};
struct NoPush {};
// A pass of passes.inl, with the type of its push constants.
template <class Push>
struct ComputePassOf {
    uint32_t number;  // in computePasses()
};
[[nodiscard]] std::span<const ComputePass> computePasses() noexcept;

namespace pass {
enum Number : uint32_t {
#define FW_COMPUTE_PASS(name, Push) number_##name,
#define FW_PLAIN_PASS(name, part) number_##name,
#include "gpu/passes/passes.inl"
#undef FW_COMPUTE_PASS
#undef FW_PLAIN_PASS
    count,
};
#define FW_COMPUTE_PASS(name, Push) inline constexpr ComputePassOf<Push> name{number_##name};
#define FW_PLAIN_PASS(name, part)
#include "gpu/passes/passes.inl"
#undef FW_COMPUTE_PASS
#undef FW_PLAIN_PASS
}  // namespace pass

enum class VertexInput : uint8_t {
    none,  // the vertex shader makes its own from gl_VertexIndex and storage buffers
    mesh,  // mesh::RenderVertex: 2 atlas vec2, 3 texture uv vec2, 4 detail vec2, 5 tint RGBA8 as
           // vec4, 6 material (refined: slot) uint, 8 rest position vec3; ShownVertex, or the
           // mesh's: 0 position vec3, 1 normal uint, 7 burn-through offset float
};
enum class Cull : uint8_t { none, back, front };  // front faces: counter-clockwise on the screen
// constant: a mix of all that is there with the blend constant, whatever its depth.
enum class Blend : uint8_t { opaque, premultiplied, additive, depthAlone, constant };

// How a pass is drawn in a target with FW_TARGET_HALF_EFFECTS.
enum class AtHalf : uint8_t {
    same,    // drawn as elsewhere
    soft,    // drawn at half resolution
    depth,   // only there: into the image of half resolution that holds depth, and tiles
    sparks,  // only there: over the picture, of all quads the sparks
    over,    // only there: over the picture
};

// Which targets have a pass' pipeline.
enum class DrawnIn : uint8_t {
    surfaces,      // targets without FW_TARGET_NO_SURFACES
    flames,        // targets without FW_TARGET_NO_FLAMES
    haze,          // of those with flames: FW_TARGET_HAZE
    transparency,  // FW_TARGET_TRANSPARENCY
};

// Textures that a pass binds in set 1 or 2, binding 0.
enum class Textures : uint8_t {
    none,
    ofItem,       // sampler2D: an object's base colour, white if it has none
    flipbooks,    // sampler2D
    hostColor,    // sampler2D: the host's copy of its target
    appearances,  // sampler2DArray: the appearance textures
    profiles,     // sampler2DArray: the fire profiles
    halfColor,    // sampler2D
    halfDepth,    // sampler2D: depth and tiles of half resolution
};

// Specialization constants of draw shaders: 0 encoding (FwOutputEncoding), 1 reversed depth (0, 1),
// 2 DrawPass::variant, 3 which part of the quads (kPart...), 4 the target's samples.
// Sets: 0 buffers; 1 and 2 textures; 3, with softShader alone, binding 0 the host's depth
// (sampler2D or sampler2DMS).
struct DrawPass {
    const char* name;
    const char* vertexShader;
    const char* fragmentShader;  // null: with Blend::depthAlone, or where softShader alone draws
    VertexInput vertexInput = VertexInput::none;
    Blend blend = Blend::premultiplied;
    bool writeDepth = false;  // only where the target allows it
    uint32_t pushBytes = 0;   // vertex and fragment, <= 128
    uint32_t variant = 0;
    Cull cull = Cull::none;
    bool strict = false;  // nothing where something stands as near
    bool behind = false;  // its depth is slightly farther, so that strict passes draw over it
    // Instead of fragmentShader where the target samples depth; null: not drawn there.
    const char* softShader = nullptr;
    const char* softShaderMultisampled = nullptr;
    // The three where the device has texel buffers, instead; null: the same.
    const char* const* texelShaders = nullptr;
    AtHalf atHalf = AtHalf::same;
    DrawnIn drawnIn = DrawnIn::flames;
    Textures textures1 = Textures::none, textures2 = Textures::appearances;
    // Instead of vertexShader and fragmentShader in a target of several samples; null: the same.
    const char* multisampledVertex = nullptr;
    const char* multisampledFragment = nullptr;
    [[nodiscard]] constexpr bool drawsSurfaces() const noexcept {
        return vertexInput == VertexInput::mesh && fragmentShader;
    }
};

// Fresh: no fire reached the object. Of others, cold triangles are far from all traces of fire.
enum class SurfaceState : uint8_t { fresh, cold, burning };
struct SurfaceKey {
    MaterialFamily family = MaterialFamily::wood;
    bool hasImage = false;
    SurfaceState state = SurfaceState::fresh;
    Cull cull = Cull::back;
    constexpr bool operator==(const SurfaceKey&) const = default;
};

// Draw passes by their number in drawPasses(). Surfaces, by key, lie behind them: surfacePass.
namespace draw {
enum Number : uint32_t {
    flames,
    flipbook_flames,       // where flipbooks show some of the quads
    flipbook_flames_only,  // where they show all but sparks
    volume,
    volume_impostor,
    volume_composite,
    body_composite,
    volume_haze,
    field_emitting,
    field_absorbing,
    field_refracting,
    half_depth,
    half_tiles,
    half_composite,
    half_sparks,
    half_flipbook_sparks,
    transparency,
    count,
};
}  // namespace draw
constexpr uint32_t kSurfacePassCount = 35;
constexpr uint32_t kDrawPassCount = draw::count + kSurfacePassCount;  // without an extension's
[[nodiscard]] std::span<const DrawPass> drawPasses() noexcept;

// The pass that draws surfaces of this key. Some keys share one: an image is all that a fresh
// surface shows, whatever its family.
[[nodiscard]] uint32_t surfacePass(const SurfaceKey& key) noexcept;

// A bit for each draw pass, by its number.
using DrawPassSet = uint64_t;
constexpr uint32_t kMaxDrawPasses = 64;
static_assert(kDrawPassCount <= kMaxDrawPasses);

}  // namespace fw::gpu
