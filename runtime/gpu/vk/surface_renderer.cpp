#include "gpu/vk/surface_renderer.h"

#include "gpu/vk/backend_state.h"

#include <algorithm>
#include <cmath>

namespace fw::gpu::vk {
namespace {

bool looksBurnt(const ObjectEntry& object) noexcept {
    return (object.burn.touched || object.burn.warmed) &&
           (object.record.flags & kObjectNoDamage) == 0;
}

// Before anything reached it nothing of it can have crossed.
bool depthFirst(const ObjectEntry& object) noexcept {
    return looksBurnt(object) && (object.record.flags & kObjectDepthFirst) != 0;
}

// How `item`'s material is drawn: whether fire may show on it, and its triangles far from fire
// apart.
void chooseSurface(const BackendState& s, const ObjectEntry& object, DrawItem& item) {
    item.family = s.limits.appearances.familyOf(object.materials[item.material]);
    item.burns = looksBurnt(object);
    item.depthFirst = depthFirst(object);
    item.coldReach = coldReach(s.scene.meshOf(object).texelEdge);
    const bool tells = (object.record.flags & kObjectExtended) == 0 && item.coldReach <= kColdReach;
    item.coldApart = item.burns && tells && !object.burn.charred && !item.depthFirst;
}

SurfaceDraw drawOf(const BackendState& s, const ObjectEntry& object, uint32_t material) {
    const vec4 row = object.record.worldRow0;
    const float scale = std::sqrt(row.x * row.x + row.y * row.y + row.z * row.z);
    return surfaceDraw(object.record, object.materials[material], object.heat[material],
                       s.scene.meshOf(object).edge * scale, object.refine.slots.first(),
                       object.burn.doused, object.burn.warmed);
}

// Of a material whose indices are [first, end) of its mesh's.
DrawItem itemOf(const BackendState& s, uint32_t slot, uint32_t material, uint32_t first,
                uint32_t end) {
    const ObjectEntry& object = s.scene.objects[slot];
    const MeshEntry& mesh = s.scene.meshOf(object);
    DrawItem item{};
    item.object = slot;
    item.material = material;
    item.firstIndex = mesh.indexRange.first() + first;
    item.indexCount = end - first;
    item.vertexOffset = int32_t(mesh.vertexRange.first());
    item.shown = object.shown ? object.shown.first() : kNoneTexel;
    item.insideShown = object.inner && object.shown;
    if (object.inner)
        item.inside =
            item.insideShown ? object.shown.first() + mesh.vertices : mesh.innerVertices.first();
    item.image = object.images[material];
    chooseSurface(s, object, item);
    item.inner = object.refine.inner;
    item.draw = drawOf(s, object, material);
    object.refine.show(item);
    return item;
}

void recordRecords(ObjectEntry& object, uint32_t slot, FrameRecorder& recorder) {
    // Others do not see an object before it is placed.
    if (object.resetDue || (object.recordDirty && !object.live))
        recorder.fillZero(FW_BIND_EXCHANGE_OBJECTS, slot * sizeof(ExchangeObject),
                          sizeof(ExchangeObject));
    if (object.recordDirty)
        recorder.uploadOne(FW_BIND_OBJECTS, uint64_t(slot) * sizeof(BurnObject), object.record);
    if (object.materialsDirty) {
        recorder.uploadOne(FW_BIND_MATERIALS, slot * sizeof object.materials, object.materials);
        if (object.record.flags & kObjectHeat)
            recorder.uploadOne(FW_BIND_HEAT_MATERIALS, slot * sizeof object.heat, object.heat);
    }
    if (object.deforms.recordDirty)
        recorder.uploadOne(FW_BIND_DEFORM_OBJECTS,
                           uint64_t(object.deforms.range.first()) * sizeof(DeformObject),
                           object.deform);
    object.recordDirty = object.materialsDirty = object.deforms.recordDirty = false;
}

}  // namespace

void SurfaceRenderer::recordObjects(BackendState& s, FrameRecorder& recorder) {
    for (const uint32_t i : s.scene.awake) recordRecords(s.scene.objects[i], i, recorder);
    drawItems.clear();
    surfacesDirty = true;
    for (uint32_t i = 0; i < s.scene.objects.size(); ++i) {
        ObjectEntry& object = s.scene.objects[i];
        if (object.resetDue) {
            recordReset(recorder, i, object.record.tileCount);
            recorder.fillZero(FW_BIND_SOURCES, object.sources.first() * sizeof(FireSource),
                              object.sources.units() * sizeof(FireSource));
        }
        object.resetDue = false;
        if (!object.live || (object.record.flags & kObjectHidden)) continue;
        const MeshEntry& mesh = s.scene.meshOf(object);
        for (uint32_t m = 0, first = 0; m < kMaterialsPerObject; first = mesh.materialEnd[m++]) {
            if (mesh.materialEnd[m] == first) continue;
            FW_ASSERT(drawItems.size() < drawItems.capacity(), "%zu draws of %u objects",
                      drawItems.size(), s.scene.liveObjects);
            drawItems.push_back(itemOf(s, i, m, first, mesh.materialEnd[m]));
        }
    }
    s.scene.recordsDirty = false;
}

std::span<DrawItem> SurfaceRenderer::itemsOf(uint32_t object) noexcept {
    const auto first =
        std::lower_bound(drawItems.begin(), drawItems.end(), object,
                         [](const DrawItem& item, uint32_t slot) { return item.object < slot; });
    auto end = first;
    while (end != drawItems.end() && end->object == object) ++end;
    return {first, end};
}

void SurfaceRenderer::update(const BackendState& s, uint32_t object, bool chooses) noexcept {
    surfacesDirty |= chooses;
    for (DrawItem& item : itemsOf(object)) {
        if (chooses) chooseSurface(s, s.scene.objects[object], item);
        item.draw = drawOf(s, s.scene.objects[object], item.material);
    }
}

std::span<const SurfaceStep> SurfaceRenderer::steps() noexcept {
    FW_ASSERT(surfaceSteps.capacity() >= drawItems.size() * kMostSurfaceSteps, "%zu draws",
              drawItems.size());
    if (surfacesDirty) orderSurfaces(drawItems, surfaceSteps);
    surfacesDirty = false;
    return surfaceSteps;
}

void SurfaceRenderer::drop(uint32_t object) noexcept {
    surfacesDirty = true;
    std::erase_if(drawItems, [&](const DrawItem& item) { return item.object == object; });
}

}  // namespace fw::gpu::vk
