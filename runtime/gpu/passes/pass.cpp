#include "gpu/passes/pass.h"

#include "core/assert.h"
#include "gpu/extension.h"
#include "shared/half.h"
#include "shared/volume_haze.h"

#include <algorithm>
#include <type_traits>

namespace fw::gpu {
namespace {

template <class Push>
constexpr uint32_t pushBytesOf() {
    return std::is_empty_v<Push> ? 0 : uint32_t(sizeof(Push));
}

constexpr ComputePass kComputePasses[] = {
#define FW_COMPUTE_PASS(name, Push) {#name, pushBytesOf<Push>()},
#define FW_PLAIN_PASS(name, part) {#name, 0, FramePart::part},
#include "gpu/passes/passes.inl"
#undef FW_COMPUTE_PASS
#undef FW_PLAIN_PASS
};

// The fragment shaders of a soft pass: without the host's depth, against it, and against one of
// several samples.
#define FW_SOFT_SHADERS(name) \
    { name ".frag", name "_soft.frag", name "_soft_ms.frag" }
constexpr const char* kCompositeTexelShaders[] = FW_SOFT_SHADERS("volume_composite_texels");
constexpr const char* kBodyTexelShaders[] = {"body_composite_texels.frag",
                                             "volume_composite_texels_soft.frag",
                                             "volume_composite_texels_soft_ms.frag"};
constexpr const char* kImpostorTexelShaders[] = FW_SOFT_SHADERS("volume_impostor_texels");

struct SoftShaders {
    const char* fragment;
    const char* soft;
    const char* multisampled;
};
// A pass that blends effects, drawn at half resolution where the target asks for it.
constexpr DrawPass softPass(const char* name, const char* vertex, SoftShaders shaders,
                            uint32_t pushBytes = 0, Textures textures1 = Textures::none,
                            Textures textures2 = Textures::appearances) {
    return {.name = name,
            .vertexShader = vertex,
            .fragmentShader = shaders.fragment,
            .pushBytes = pushBytes,
            .softShader = shaders.soft,
            .softShaderMultisampled = shaders.multisampled,
            .atHalf = AtHalf::soft,
            .textures1 = textures1,
            .textures2 = textures2};
}
#define FW_SOFT_PASS(name, ...) softPass(name, name ".vert", FW_SOFT_SHADERS(name), __VA_ARGS__)

// Surface pipelines, in the order in which they draw within a phase.
constexpr auto kSurfaceKeys = [] {
    using F = MaterialFamily;
    std::array<SurfaceKey, kSurfacePassCount> rows{};
    size_t count = 0;
    // Front faces first: the depth test then drops the inside, which only holes show.
    const auto addFresh = [&](SurfaceState state, Cull cull) {
        for (const F family : {F::wood, F::plant, F::paint, F::hide})
            rows[count++] = {family, false, state, cull};
        rows[count++] = {F::wood, true, state, cull};
    };
    addFresh(SurfaceState::fresh, Cull::back);
    addFresh(SurfaceState::fresh, Cull::front);
    addFresh(SurfaceState::cold, Cull::back);
    for (const Cull cull : {Cull::back, Cull::front})
        for (const bool image : {false, true})
            for (const F family : {F::wood, F::paint, F::sheet, F::plant, F::hide})
                rows[count++] = {family, image, SurfaceState::burning, cull};
    return rows;
}();

constexpr uint32_t featuresOf(MaterialFamily family) {
    switch (family) {
        case MaterialFamily::wood:
            return kSurfaceWood;
        case MaterialFamily::paint:
            return kSurfaceWood | kSurfacePaint;
        case MaterialFamily::sheet:
            return kSurfaceSheet;
        case MaterialFamily::plant:
            return kSurfacePlant;
        case MaterialFamily::hide:
            return kSurfaceSheet | kSurfaceHide;
    }
    return 0;
}

constexpr DrawPass surfaceOf(const SurfaceKey& row) {
    const bool burns = row.state == SurfaceState::burning;
    // Without fire an image is all that a material shows.
    const uint32_t features = (burns || !row.hasImage ? featuresOf(row.family) : 0) |
                              (row.hasImage ? kSurfaceImage : 0) | (burns ? kSurfaceBurns : 0) |
                              (row.state == SurfaceState::cold ? kSurfaceCold : 0);
    return {.name = "surface",
            .vertexShader = "surface.vert",
            .fragmentShader = "surface.frag",
            .vertexInput = VertexInput::mesh,
            .blend = Blend::opaque,
            .writeDepth = true,
            .pushBytes = sizeof(SurfaceDraw),
            .variant = features,
            .cull = row.cull,
            .strict = burns,  // not drawn over cold triangles
            .drawnIn = DrawnIn::surfaces,
            .textures1 = Textures::ofItem,
            .multisampledVertex = "surface_ms.vert",
            .multisampledFragment = burns ? "surface_ms_holes.frag" : "surface_ms.frag"};
}

constexpr DrawPass flipbookFlames(bool only) {
    DrawPass pass = FW_SOFT_PASS("flipbook_flames", 0, Textures::flipbooks);
    pass.variant = only ? 1 : 0;
    return pass;
}

// The sparks of `pass` alone, over the effects of half resolution.
constexpr DrawPass halfSparks(DrawPass pass) {
    pass.name = "half_sparks";
    pass.fragmentShader = nullptr;
    pass.atHalf = AtHalf::sparks;
    return pass;
}

// Fields that emit alone, that absorb and that refract differ, so that none pays for another.
constexpr DrawPass field(uint32_t variant) {
    DrawPass pass = FW_SOFT_PASS("field_draw", 0, Textures::profiles);
    pass.variant = variant;
    return pass;
}

constexpr DrawPass intoHalf(const char* name, const char* shader, const char* multisampled) {
    return {.name = name,
            .vertexShader = "half_all.vert",
            .fragmentShader = nullptr,
            .blend = Blend::opaque,
            .pushBytes = sizeof(HalfPush),
            .softShader = shader,
            .softShaderMultisampled = multisampled,
            .atHalf = AtHalf::depth};
}

constexpr auto kDrawPasses = [] {
    std::array<DrawPass, kDrawPassCount> passes{};
    passes[draw::flames] = FW_SOFT_PASS("flames", 0);
    passes[draw::flipbook_flames] = flipbookFlames(false);
    passes[draw::flipbook_flames_only] = flipbookFlames(true);
    passes[draw::volume] =
        FW_SOFT_PASS("volume", sizeof(VolumeDraw), Textures::none, Textures::profiles);
    passes[draw::volume_impostor] = FW_SOFT_PASS("volume_impostor", sizeof(VolumeImpostor));
    passes[draw::volume_impostor].texelShaders = kImpostorTexelShaders;
    passes[draw::volume_composite] = FW_SOFT_PASS("volume_composite", sizeof(CompositePush));
    passes[draw::volume_composite].texelShaders = kCompositeTexelShaders;
    passes[draw::body_composite] = passes[draw::volume_composite];
    passes[draw::body_composite].name = "body_composite";
    passes[draw::body_composite].fragmentShader = "body_composite.frag";
    passes[draw::body_composite].texelShaders = kBodyTexelShaders;
    passes[draw::volume_haze] = {.name = "volume_haze",
                                 .vertexShader = "volume_haze.vert",
                                 .fragmentShader = nullptr,
                                 .pushBytes = sizeof(HazePush),
                                 .softShader = "volume_haze_soft.frag",
                                 .softShaderMultisampled = "volume_haze_soft_ms.frag",
                                 .drawnIn = DrawnIn::haze,
                                 .textures1 = Textures::hostColor,
                                 .textures2 = Textures::profiles};
    passes[draw::field_emitting] = field(0);
    passes[draw::field_absorbing] = field(1);
    passes[draw::field_refracting] = field(2);
    // Soft effects are drawn at half resolution against the host's depth, then composited over the
    // picture along its full-resolution edges.
    passes[draw::half_depth] = intoHalf("half_depth", "half_depth.frag", "half_depth_ms.frag");
    passes[draw::half_tiles] = intoHalf("half_tiles", "half_tiles.frag", "half_tiles.frag");
    passes[draw::half_tiles].textures1 = Textures::halfColor;
    passes[draw::half_composite] = {.name = "half_composite",
                                    .vertexShader = "half_composite.vert",
                                    .fragmentShader = nullptr,
                                    .pushBytes = sizeof(HalfPush),
                                    .softShader = "half_composite.frag",
                                    .softShaderMultisampled = "half_composite_ms.frag",
                                    .atHalf = AtHalf::over,
                                    .textures1 = Textures::halfColor,
                                    .textures2 = Textures::halfDepth};
    passes[draw::half_sparks] = halfSparks(passes[draw::flames]);
    passes[draw::half_flipbook_sparks] = halfSparks(passes[draw::flipbook_flames_only]);
    // The host's picture over ours, by how transparent the host has all of ours together: exact
    // whatever lies over what, and no other pass knows of it.
    passes[draw::transparency] = {.name = "transparency",
                                  .vertexShader = "half_all.vert",
                                  .fragmentShader = "transparency.frag",
                                  .blend = Blend::constant,
                                  .softShader = "transparency.frag",
                                  .softShaderMultisampled = "transparency.frag",
                                  .drawnIn = DrawnIn::transparency,
                                  .textures1 = Textures::hostColor,
                                  .textures2 = Textures::none};
    for (uint32_t i = 0; i < kSurfacePassCount; ++i)
        passes[draw::count + i] = surfaceOf(kSurfaceKeys[i]);
    return passes;
}();

constexpr uint32_t kMaxComputePasses = 80;

// The rows of the library, then those of an extension.
template <class Row, uint32_t kMax>
class Table {
 public:
    Table(std::span<const Row> own, std::span<const Row> more) {
        FW_ASSERT(own.size() + more.size() <= kMax, "%zu and %zu passes", own.size(), more.size());
        const auto end = std::copy(own.begin(), own.end(), rows_.begin());
        count_ = size_t(std::copy(more.begin(), more.end(), end) - rows_.begin());
    }
    [[nodiscard]] std::span<const Row> rows() const noexcept { return {rows_.data(), count_}; }

 private:
    std::array<Row, kMax> rows_{};
    size_t count_ = 0;
};

}  // namespace

std::span<const ComputePass> computePasses() noexcept {
    static const auto passes = Table<ComputePass, kMaxComputePasses>(
        kComputePasses, extension() ? extension()->computePasses : std::span<const ComputePass>());
    return passes.rows();
}

std::span<const DrawPass> drawPasses() noexcept {
    static const auto passes = Table<DrawPass, kMaxDrawPasses>(
        kDrawPasses, extension() ? extension()->drawPasses : std::span<const DrawPass>());
    return passes.rows();
}

uint32_t surfacePass(const SurfaceKey& key) noexcept {
    SurfaceKey drawn = key;
    if (key.state != SurfaceState::burning) {
        if (key.hasImage) drawn.family = MaterialFamily::wood;
        if (drawn.family == MaterialFamily::sheet) drawn.family = MaterialFamily::hide;
    }
    const auto row = std::find(kSurfaceKeys.begin(), kSurfaceKeys.end(), drawn);
    FW_ASSERT(row != kSurfaceKeys.end(), "no pass draws family %d", int(drawn.family));
    return draw::count + uint32_t(row - kSurfaceKeys.begin());
}

}  // namespace fw::gpu
