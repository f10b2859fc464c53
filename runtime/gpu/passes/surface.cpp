// Surfaces of burnable meshes, one draw per object and material. Pipelines differ in the features
// that they can draw, not in the result: see kSurface... in shared/appearance.h.
#include "core/assert.h"
#include "gpu/extension.h"

#include <algorithm>
#include <tuple>

namespace fw::gpu {
namespace {

// Draw flags reuse the bits that hold an object's room, which no draw reads; an object's other
// flags stay below.
constexpr uint32_t kObjectsOwn = (1u << kObjectRoomShift) - 1;
static_assert(((kDrawVertexLight | kDrawPlaced | kDrawHeat | kDrawWet | kDrawThick | kDrawCut |
                kDrawPerPixelHoles | kDrawInner) &
               kObjectsOwn) == 0);
static_assert((kObjectSkinned | kObjectDepthFirst | kObjectUnseen | kObjectShownAgain) <=
              kObjectsOwn);

// m. Triangles with shorter edges are lit by flames at their corners.
constexpr float kSmallEdge = 0.03f;

}  // namespace

DrawPassSet surfacePasses(MaterialFamily family, bool image) {
    DrawPassSet passes = 0;
    const auto add = [&](SurfaceState state, Cull cull) {
        passes |= DrawPassSet(1) << surfacePass({family, image, state, cull});
    };
    for (const Cull cull : {Cull::back, Cull::front}) {
        add(SurfaceState::fresh, cull);
        add(SurfaceState::burning, cull);
    }
    add(SurfaceState::cold, Cull::back);
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
    draw.appearance = material.appearance;
    draw.stateBase = object.stateBase;
    draw.size = object.width | object.height << 16;
    draw.flags = object.flags & kObjectsOwn;
    if (edge < kSmallEdge) draw.flags |= kDrawVertexLight;
    draw.places = places;
    const bool heated = (object.flags & kObjectHeat) != 0;
    draw.heatBase = object.heatBase;
    draw.maxFilm = heated ? float(heat.maxFilm) : 0.0f;
    // A thin object that was never doused is as hot as its age says.
    if (heated && (doused || (heat.flags & kHeatThick))) draw.flags |= kDrawHeat;
    if (heated && (heat.flags & kHeatThick)) draw.flags |= kDrawThick;
    if (doused || (heated && warmed)) draw.flags |= kDrawWet;
    return draw;
}

void orderSurfaces(std::span<const DrawItem> items, std::pmr::vector<SurfaceStep>& out) noexcept {
    FW_ASSERT(out.capacity() >= items.size() * kMostSurfaceSteps, "%zu of %zu draws", items.size(),
              out.capacity());
    out.clear();
    for (uint32_t i = 0; i < items.size(); ++i) {
        const DrawItem& item = items[i];
        const auto add = [&](DrawPhase phase, SurfaceState state, Cull cull) {
            out.push_back({phase, surfacePass({item.family, item.image != 0, state, cull}), i});
        };
        if (!item.burns) {
            add(DrawPhase::OpaqueFresh, SurfaceState::fresh, Cull::back);
            add(DrawPhase::OpaqueFresh, SurfaceState::fresh, Cull::front);
        } else if (item.depthFirst) {
            out.push_back({DrawPhase::DepthFirst, extension()->depthPass, i});
            add(DrawPhase::OpaqueOverDepth, SurfaceState::burning, Cull::back);
        } else {
            if (item.coldApart) add(DrawPhase::OpaqueBurning, SurfaceState::cold, Cull::back);
            add(DrawPhase::OpaqueBurning, SurfaceState::burning, Cull::back);
            add(DrawPhase::OpaqueBurning, SurfaceState::burning, Cull::front);
        }
    }
    std::sort(out.begin(), out.end(), [](const SurfaceStep& a, const SurfaceStep& b) {
        return std::tie(a.phase, a.pass, a.item) < std::tie(b.phase, b.pass, b.item);
    });
}

}  // namespace fw::gpu
