// What a pass is: a name, a shader, what it uses. The backend derives set layouts, barriers, timers
// and labels from it. Pass files hold one `const ComputePass` or `const DrawPass` each.
#pragma once
#include "shared/burn.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace fw::gpu {

// Resources are numbered by their binding (FW_BIND_*), so one list says both. Beyond them, what no
// shader binds:
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

enum class Access : uint8_t {
    read,         // storage buffer, compute
    write,        // storage buffer, compute; also read-modify-write and atomics
    readTexels,   // as read, at texelBinding by texels of four words where the device has so many
                  // of them: a software device reads those faster. At most 4, before any `write`
    indirect,     // arguments of a dispatch or draw
    drawRead,     // storage buffer, vertex and fragment shaders
    drawTexels,   // as drawRead, but as readTexels; after the drawRead of who reads both ways
    drawUniform,  // uniform buffer, vertex and fragment shaders; at most 16 KiB
    drawEach,     // the same, of which a draw sees one record: FW_BIND_VOLUMES only
    each,         // the same for a dispatch, uniform buffer, compute
    vertexInput,  // vertex or index data
    uniformView,  // the view's uniform block, dynamic offset: FW_BIND_VIEW only
    copyRead,
    copyWrite,
};

constexpr bool byTexels(Access access) noexcept {
    return access == Access::readTexels || access == Access::drawTexels;
}

struct Use {
    uint32_t resource;
    Access access;
};
// What a piece of shader text needs (light_uses.h, shield_uses.h), and a pass' own beside it.
template <std::size_t a, std::size_t b>
constexpr std::array<Use, a + b> joined(const Use (&some)[a], const Use (&others)[b]) {
    std::array<Use, a + b> uses{};
    std::copy_n(others, b, std::copy_n(some, a, uses.begin()));
    return uses;
}

// Whether it does something else for each view.
constexpr bool ofViews(std::span<const Use> uses) noexcept {
    return std::any_of(uses.begin(), uses.end(),
                       [](const Use& use) { return resourceOf(use.resource, 1) != use.resource; });
}

struct ComputePass {
    const char* name;    // label, timer
    const char* shader;  // in the embedded table: "arrival.comp"
    std::span<const Use> uses;
    uint32_t pushBytes;                 // <= 128
    const char* texelShader = nullptr;  // where `uses` has texels: instead, if the device has them
    bool profiles = false;              // set 1, binding 0: the fire profiles (sampler2DArray)
};

// So that a pass may read by texels what it writes by words.
constexpr uint32_t texelBinding(uint32_t resource) noexcept { return FW_BIND_COUNT + resource; }

enum class VertexInput : uint8_t {
    none,  // the vertex shader makes its own from gl_VertexIndex and storage buffers
    mesh,  // mesh::RenderVertex: 2 atlas vec2, 3 texture uv vec2, 4 detail vec2, 5 tint RGBA8 as
           // vec4, 6 material (refined: slot) uint, 8 rest position vec3; ShownVertex, or the
           // mesh's: 0 position vec3, 1 normal uint, 7 lead float
};
enum class Cull : uint8_t { none, back, front };  // front faces: counter-clockwise on the screen
// constant: a mix by the blend constant, of all that is there, whatever its depth.
enum class Blend : uint8_t { opaque, premultiplied, additive, depthAlone, constant };

// What becomes of a pass in a target with FW_TARGET_HALF_EFFECTS.
enum class AtHalf : uint8_t {
    same,    // drawn as elsewhere
    soft,    // drawn at half resolution
    depth,   // only there: into the image of half resolution that holds depth, and tiles
    sparks,  // only there: over the picture, of all quads the sparks
    over,    // only there: over the picture
};

// Specialization constants of draw shaders: 0 encoding (FwOutputEncoding), 1 reversed depth (0, 1),
// 2 DrawPass::variant, 3 which part of the quads (kPart...), 4 the target's samples.
// Sets: 0 as `uses` says; 1 binding 0 the object's base colour (sampler2D, white if none), of `book
// flames` the flipbooks, of `volume haze` and `transparency` the colour that the host lends
// (sampler2D); 2 binding 0 the look textures, of `volume` the fire profiles (sampler2DArray), of
// `half composite` depth and tiles of half resolution, whose colour is its set 1 and that of `half
// tiles`; 3, with softShader alone, binding 0 the depth that the host lends (sampler2D or
// sampler2DMS).
struct DrawPass {
    const char* name;
    const char* vertexShader;
    const char* fragmentShader;  // null: with Blend::depthAlone, or where softShader alone draws
    std::span<const Use> uses;   // drawRead, uniformView, indirect; set 0
    VertexInput vertexInput;
    Blend blend;
    bool writeDepth;     // only where the target allows it
    uint32_t pushBytes;  // vertex and fragment, <= 128
    uint32_t variant = 0;
    Cull cull = Cull::none;
    bool strict = false;  // nothing where something stands as near
    bool behind = false;  // its depth is a hair farther, so that what is strict passes it
    // Instead of fragmentShader where the target samples depth; null: not drawn there.
    const char* softShader = nullptr;
    const char* softShaderMultisampled = nullptr;
    // The three where `uses` has texels: instead, if the device has them.
    const char* const* texelShaders = nullptr;
    AtHalf atHalf = AtHalf::same;
    // Instead of vertexShader and fragmentShader in a target of several samples; null: the same.
    const char* multisampledVertex = nullptr;
    const char* multisampledFragment = nullptr;
};

}  // namespace fw::gpu
