// Burnable meshes as they look now, one draw per object. Variants differ in what they can draw, not
// in how it looks: see kSurface... in shared/look.h.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kUses[] = {
    {FW_BIND_OBJECTS, Access::drawRead}, {FW_BIND_MATERIALS, Access::drawRead},
    {FW_BIND_PREDICT, Access::drawRead}, {FW_BIND_GRADIENT, Access::drawRead},
    {FW_BIND_LIGHTS, Access::drawRead},  {FW_BIND_LOOKS, Access::drawRead},
    {FW_BIND_VIEW, Access::uniformView},
};

struct SurfacePush {
    uint32_t object;
};

constexpr DrawPass variant(uint32_t features, Cull cull = Cull::none) {
    return {"surface",     "surface.vert", "surface.frag",      kUses,    VertexInput::mesh,
            Blend::opaque, true,           sizeof(SurfacePush), features, cull};
}
// Objects that burn are drawn in two goes, so that the depth test drops the inside, which only
// holes show. Where the host's faces turn the other way the goes swap, and the picture is the same.
constexpr uint32_t kFresh = 4, kBurning = 5;
static_assert(kFresh + 2 * kBurning == kSurfaceVariants);

constexpr uint32_t kAll = kSurfaceWood | kSurfaceSheet | kSurfacePlant | kSurfaceHide;

// What a preset's look needs of a variant; stone needs nothing.
uint32_t familyOf(uint32_t look) {
    switch (look) {
        case FW_MATERIAL_PINE:
        case FW_MATERIAL_PAINTED_WOOD:
        case FW_MATERIAL_PLYWOOD:
            return kSurfaceWood;
        case FW_MATERIAL_NEWSPAPER:
        case FW_MATERIAL_PAPER:
        case FW_MATERIAL_COTTON:
            return kSurfaceSheet;
        case FW_MATERIAL_POLYESTER:
            return kSurfaceSheet | kSurfaceHide;
        case FW_MATERIAL_DRY_LEAF:
        case FW_MATERIAL_GREEN_LEAF:
        case FW_MATERIAL_THATCH:
        case FW_MATERIAL_DRY_GRASS:
            return kSurfacePlant;
        case FW_MATERIAL_LEATHER:
        case FW_MATERIAL_PLASTIC:
            return kSurfaceHide;
        default:
            return 0;
    }
}

}  // namespace

// Cheapest first: an object is drawn by the first that has all it needs.
const DrawPass kSurfacePasses[kSurfaceVariants] = {
    variant(kSurfaceWood),
    variant(kSurfacePlant),
    variant(kSurfaceWood | kSurfacePlant),
    variant(kAll),
    variant(kSurfaceWood | kSurfaceBurns, Cull::back),
    variant(kSurfaceSheet | kSurfaceBurns, Cull::back),
    variant(kSurfacePlant | kSurfaceBurns, Cull::back),
    variant(kSurfaceWood | kSurfacePlant | kSurfaceBurns, Cull::back),
    variant(kAll | kSurfaceBurns, Cull::back),
    variant(kSurfaceWood | kSurfaceBurns, Cull::front),
    variant(kSurfaceSheet | kSurfaceBurns, Cull::front),
    variant(kSurfacePlant | kSurfaceBurns, Cull::front),
    variant(kSurfaceWood | kSurfacePlant | kSurfaceBurns, Cull::front),
    variant(kAll | kSurfaceBurns, Cull::front),
};

uint32_t surfaceVariant(std::span<const BurnMaterial> materials, bool touched) {
    uint32_t needs = touched ? kSurfaceBurns : 0;
    for (const BurnMaterial& material : materials) needs |= familyOf(material.look);
    uint32_t i = 0;
    while ((needs & ~kSurfacePasses[i].variant) != 0) ++i;
    return i;
}

// Whether an item whose variant is `given` is drawn by pass `variant`.
static bool drawnBy(uint32_t variant, uint32_t given) {
    return given == variant || (given >= kFresh && given + kBurning == variant);
}

bool surfaceDraws(uint32_t variant, std::span<const DrawItem> items) {
    for (const DrawItem& item : items) {
        if (drawnBy(variant, item.variant)) return true;
    }
    return false;
}

void recordSurface(DrawRecorder& recorder, uint32_t variant, std::span<const DrawItem> items) {
    for (const DrawItem& item : items) {
        if (!drawnBy(variant, item.variant)) continue;
        const SurfacePush push{item.object};
        recorder.drawItem(item, &push);
    }
}

}  // namespace fw::gpu
