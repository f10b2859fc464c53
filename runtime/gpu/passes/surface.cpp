// Burnable meshes as they look now, one draw per object and material. Variants differ in what they
// can draw, not in how it looks: see kSurface... in shared/look.h.
#include "gpu/passes/frame_graph.h"

namespace fw::gpu {
namespace {

constexpr Use kSurfaceUses[] = {
    {FW_BIND_PREDICT, Access::drawRead},
    {FW_BIND_GRADIENT, Access::drawRead},
    {FW_BIND_LIGHTS, Access::drawUniform},
    {FW_BIND_LOOKS, Access::drawUniform},
    {FW_BIND_VIEW, Access::uniformView},
    {FW_BIND_REFINE_VERTICES, Access::drawRead},
    {FW_BIND_REFINE_INDICES, Access::vertexInput},
    {FW_BIND_REFINE_DRAWS, Access::indirect},
    {FW_BIND_HEAT, Access::drawRead},
    {FW_BIND_REFINE_CUTS, Access::vertexInput},
    {FW_BIND_REFINE_CUT_DRAWS, Access::indirect},
    {FW_BIND_TILE_STATE, Access::drawRead},
};

constexpr DrawPass variant(uint32_t features, Cull cull) {
    const bool burns = (features & kSurfaceBurns) != 0;
    DrawPass pass{"surface",         "surface.vert", "surface.frag", kSurfaceUses,
                  VertexInput::mesh, Blend::opaque,  true,           sizeof(SurfaceDraw),
                  features,          cull,           burns};
    pass.multisampledVertex = "surface_ms.vert";
    pass.multisampledFragment = burns ? "surface_ms_holes.frag" : "surface_ms.frag";
    return pass;
}
// All is drawn in two goes, so that the depth test drops the inside, which only holes show. Where
// the host's faces turn the other way the goes swap, and the picture is the same. Of what burns,
// the triangles without a trace of it come before, by cheaper variants; what burns is strict, and
// so not drawn over those.
constexpr uint32_t kFresh = 5, kBurning = 10;
constexpr uint32_t kFirstCold = 2 * kFresh, kFirstBurning = 3 * kFresh;
static_assert(kFirstBurning + 2 * kBurning == kSurfaceVariants);
// Flags of draws stand where an object has the room that it is in, for which no draw asks; an
// object's other flags stay below.
constexpr uint32_t kObjectsOwn = (1u << kObjectRoomShift) - 1;
static_assert(((kDrawVertexLight | kDrawPlaced | kDrawHeat | kDrawWet | kDrawThick | kDrawCut |
                kDrawTold | kDrawInner) &
               kObjectsOwn) == 0);
static_assert((kObjectSkinned | kObjectZPass | kObjectUnseen | kObjectShownAgain) <= kObjectsOwn);

constexpr uint32_t kPaint = kSurfaceWood | kSurfacePaint;
constexpr uint32_t kHide = kSurfaceSheet | kSurfaceHide;

// m. Triangles with shorter edges are lit by flames at their corners.
constexpr float kSmallEdge = 0.03f;

// What a preset's look needs of a variant; stone needs nothing.
uint32_t familyOf(uint32_t look) {
    switch (look) {
        case FW_MATERIAL_PINE:
        case FW_MATERIAL_PLYWOOD:
            return kSurfaceWood;
        case FW_MATERIAL_PAINTED_WOOD:
            return kPaint;
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
    variant(kSurfaceWood, Cull::back),
    variant(kSurfacePlant, Cull::back),
    variant(kPaint, Cull::back),
    variant(kHide, Cull::back),
    variant(kSurfaceImage, Cull::back),
    variant(kSurfaceWood, Cull::front),
    variant(kSurfacePlant, Cull::front),
    variant(kPaint, Cull::front),
    variant(kHide, Cull::front),
    variant(kSurfaceImage, Cull::front),
    variant(kSurfaceWood | kSurfaceCold, Cull::back),
    variant(kSurfacePlant | kSurfaceCold, Cull::back),
    variant(kPaint | kSurfaceCold, Cull::back),
    variant(kHide | kSurfaceCold, Cull::back),
    variant(kSurfaceImage | kSurfaceCold, Cull::back),
    variant(kSurfaceWood | kSurfaceBurns, Cull::back),
    variant(kPaint | kSurfaceBurns, Cull::back),
    variant(kSurfaceSheet | kSurfaceBurns, Cull::back),
    variant(kSurfacePlant | kSurfaceBurns, Cull::back),
    variant(kHide | kSurfaceBurns, Cull::back),
    variant(kSurfaceWood | kSurfaceImage | kSurfaceBurns, Cull::back),
    variant(kPaint | kSurfaceImage | kSurfaceBurns, Cull::back),
    variant(kSurfaceSheet | kSurfaceImage | kSurfaceBurns, Cull::back),
    variant(kSurfacePlant | kSurfaceImage | kSurfaceBurns, Cull::back),
    variant(kHide | kSurfaceImage | kSurfaceBurns, Cull::back),
    variant(kSurfaceWood | kSurfaceBurns, Cull::front),
    variant(kPaint | kSurfaceBurns, Cull::front),
    variant(kSurfaceSheet | kSurfaceBurns, Cull::front),
    variant(kSurfacePlant | kSurfaceBurns, Cull::front),
    variant(kHide | kSurfaceBurns, Cull::front),
    variant(kSurfaceWood | kSurfaceImage | kSurfaceBurns, Cull::front),
    variant(kPaint | kSurfaceImage | kSurfaceBurns, Cull::front),
    variant(kSurfaceSheet | kSurfaceImage | kSurfaceBurns, Cull::front),
    variant(kSurfacePlant | kSurfaceImage | kSurfaceBurns, Cull::front),
    variant(kHide | kSurfaceImage | kSurfaceBurns, Cull::front),
};

uint32_t surfaceVariant(const BurnMaterial& material, bool image, bool touched) {
    // Without fire an image is all that a material shows.
    uint32_t needs = touched ? kSurfaceBurns : 0;
    if (touched || !image) needs |= familyOf(material.look);
    if (image) needs |= kSurfaceImage;
    uint32_t i = touched ? kFirstBurning : 0;
    while ((needs & ~kSurfacePasses[i].variant) != 0) ++i;
    return i;
}

uint64_t surfacePasses(const BurnMaterial& material, bool image) {
    const uint32_t fresh = surfaceVariant(material, image, false);
    const uint32_t burning = surfaceVariant(material, image, true);
    uint64_t passes = 0;
    for (const uint32_t pass :
         {fresh, fresh + kFresh, fresh + kFirstCold, burning, burning + kBurning})
        passes |= uint64_t(1) << pass;
    return passes;
}

SurfaceDraw surfaceDraw(const BurnObject& object, const BurnMaterial& material,
                        const HeatMaterial& heat, float edge, uint32_t places, bool doused,
                        bool warmed) {
    SurfaceDraw draw{};
    draw.row0 = object.worldRow0;
    draw.row1 = object.worldRow1;
    draw.row2 = object.worldRow2;
    draw.colorRough = material.baseColor;
    draw.colorRough.w = material.roughness;
    draw.tintR = object.tint.x;
    draw.tintG = object.tint.y;
    draw.tintB = object.tint.z;
    draw.timeScale = material.timeScale;
    draw.thickness = material.thickness;
    draw.horizon = float(object.horizon) / float(kTicksPerSecond);
    draw.look = material.look;
    draw.stateBase = object.stateBase;
    draw.size = object.width | object.height << 16;
    draw.flags = object.flags & kObjectsOwn;
    if (edge < kSmallEdge) draw.flags |= kDrawVertexLight;
    draw.places = places;
    const bool heated = (object.flags & kObjectHeat) != 0;
    draw.heatBase = object.heatBase;
    draw.filmMost = heated ? float(heat.filmMost) : 0.0f;
    // What is thin and never doused is as hot as its age says.
    if (heated && (doused || (heat.flags & kHeatThick))) draw.flags |= kDrawHeat;
    if (heated && (heat.flags & kHeatThick)) draw.flags |= kDrawThick;
    if (doused || (heated && warmed)) draw.flags |= kDrawWet;
    return draw;
}

// Whether pass `variant` draws an item. After the Z-pass only what faces the eye is drawn.
static bool drawnBy(uint32_t variant, const DrawItem& item, bool zPass) {
    if (item.zPass != zPass) return false;
    if (variant < kFirstCold) return item.variant == variant % kFresh;
    if (variant >= kFirstBurning)
        return item.variant == variant || (item.variant + kBurning == variant && !zPass);
    return item.variant >= kFirstBurning && item.coldVariant == variant - kFirstCold;
}

bool surfaceDraws(uint32_t variant, std::span<const DrawItem> items, bool zPass) {
    for (const DrawItem& item : items) {
        if (drawnBy(variant, item, zPass)) return true;
    }
    return false;
}

void recordSurface(DrawRecorder& recorder, uint32_t variant, std::span<const DrawItem> items,
                   bool zPass, bool turned) {
    const bool burning = variant >= kFirstBurning, cold = !burning && variant >= kFirstCold;
    const bool behind = burning ? variant >= kFirstBurning + kBurning : variant >= kFresh && !cold;
    for (const DrawItem& item : items) {
        if (!drawnBy(variant, item, zPass)) continue;
        SurfaceDraw draw = item.draw;
        if (!burning) draw.nearness = item.coldReach;
        if (burning && ((item.cut && !item.told) || (item.refined && item.consumed)))
            draw.flags |= kDrawCut;
        if (item.refined) {
            draw.flags |= kDrawPlaced;
            // What turns its back is seen from inside.
            draw.inner = item.inner;
            if (behind != turned && item.inner != 0) draw.flags |= kDrawInner;
        }
        if (burning && !item.refined && behind != turned && item.inside != kNoneTexel)
            recorder.drawInside(item, &draw);
        else
            recorder.drawItem(item, &draw);
        if (!item.cut || cold) continue;
        draw.flags = (draw.flags & ~kDrawPlaced) | kDrawCut | (item.told ? kDrawTold : 0);
        recorder.drawCut(item, &draw);
    }
}

}  // namespace fw::gpu
