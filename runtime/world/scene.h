// The tables that the systems of a world share: materials, images, meshes and burnable meshes, and
// which of these are near a place.
#pragma once
#include "core/handle_pool.h"
#include "world/box_grid.h"
#include "world/context.h"
#include "world/object.h"

#include <algorithm>
#include <array>
#include <span>

namespace fw::world {

// A cube in whole mm, as far as integers hold.
template <class Whole>
mesh::Box cubeAround(const std::array<Whole, 3>& middle, int64_t reach) noexcept {
    constexpr int64_t kFarthest = 2000000000;
    mesh::Box box;
    for (size_t i = 0; i < 3; ++i) {
        box.low[i] = int(std::clamp(middle[i] - reach, -kFarthest, kFarthest));
        box.high[i] = int(std::clamp(middle[i] + reach, -kFarthest, kFarthest));
    }
    return box;
}

class Scene {
 public:
    explicit Scene(const WorldContext& context);
    ~Scene();
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    FwMaterialId createMaterial(const FwMaterialDef& def);
    void destroyMaterial(FwMaterialId id) { materials.destroy(id); }
    FwImageId createImage(const FwImageDef& def);
    void destroyImage(FwImageId id);
    [[nodiscard]] bool showsImage(FwImageId id);  // some object does
    FwMeshId createMesh(const FwMeshDef& def);
    void destroyMesh(FwMeshId id);
    void meshInfo(FwMeshId id, FwMeshInfo& info);
    const mesh::BurnDomain& domain(FwMeshId id) { return *meshes.get(id).domain; }
    const mesh::BurnDomain& objectDomain(FwBurnableMeshId id) { return domainOf(*objects.get(id)); }
    // Its backend slot; throws unless it is skinned and has so many vertices.
    uint32_t skinnedSlot(FwBurnableMeshId id, uint32_t vertexCount);
    void setHidden(FwBurnableMeshId id, bool hidden);

    // Of a slot that has one.
    [[nodiscard]] Object& objectAt(uint32_t slot) const noexcept {
        FW_ASSERT(objects.findSlot(slot), "no burnable mesh in slot %u", slot);
        return **objects.at(slot);
    }
    [[nodiscard]] const mesh::BurnDomain& domainOf(const Object& object) const noexcept;
    [[nodiscard]] bool canBurn(const Object& object, uint32_t texel) const noexcept;
    uint32_t texelMaterial(const Object& object, uint32_t texel) const noexcept;
    void texelPosition(const Object& object, uint32_t texel, float (&out)[3]) const noexcept;
    // Where a texel is, m, object space: at rest, or on the vertices that the host moved.
    void texelPlace(const Object& object, uint32_t texel, float (&out)[3]) const noexcept;
    // Nearest texel within `reach` m of a point in object space, or kNone.
    uint32_t nearestTexel(const Object& object, const float point[3], float reach) const noexcept;
    // The same, at no cost for what is far away.
    uint32_t nearTexel(const Object& object, const float point[3], float reach) const noexcept;
    [[nodiscard]] float burningAreaOf(const Object& object) const noexcept;  // m^2
    [[nodiscard]] float powerOf(const Object& object) const noexcept;        // W
    [[nodiscard]] uint64_t meshHash(const Object& object) noexcept;

    // Boxes of objects as their poses are now, for what asks who is somewhere.
    void placeNow(const Object& object);  // throws std::bad_alloc
    // Slots of the objects that come within `margin` m of a box, in order; until the next call.
    std::span<const uint32_t> objectsNear(const mesh::Box& box, float margin) noexcept;
    std::span<const uint32_t> objectsNear(const float point[3], float margin) noexcept;
    void sendPose(const Object& object) noexcept;
    void markMoved(Object& object) noexcept;  // capacity was reserved with each object

    // Slot of the mesh in this shape: itself, one that is there, or a new one.
    uint32_t shapedSlot(uint32_t slot, const float shape[3]);
    void releaseShape(uint32_t slot) noexcept;
    // As components::makeCutOutMask. Stands until the mesh's next object with other pictures is
    // made.
    std::span<const uint8_t> goneOf(const FwBurnableMeshDef& def, MeshEntry& mesh);
    bool innerSkin(MeshEntry& mesh, uint32_t slot, const components::BurnableMesh& object);
    void refineMesh(MeshEntry& mesh, uint32_t slot, const FwBurnableMeshDef& def,
                    const components::BurnableMesh& object);
    gpu::HeatBoundary boundaryOf(const FwBurnableMeshDef& def,
                                 const components::BurnableMesh& object) const;
    void countImages(const components::BurnableMesh& object, bool more) noexcept;
    void countFuel(const Object& object, bool more) noexcept;
    void removeObject(const Object& object) noexcept;  // that goes
    void reserveSlots();                               // for an object more; throws std::bad_alloc
    // visit(place, name, slot) for all that a shift of the origin moves and may refuse.
    template <class Visit>
    void eachPlace(const Visit& visit) {
        for (auto [i, object] : objects.entries())
            visit(object.data.pose.translation, "burnable mesh", i);
    }
    void shiftOrigin(const double (&by)[3]) noexcept;  // all else

    core::HandlePool<FwMaterialId, FwMaterialDef> materials;
    core::HandlePool<FwImageId, ImageEntry> images;
    core::HandlePool<FwMeshId, MeshEntry> meshes;
    core::HandlePool<FwBurnableMeshId, core::Owned<Object>> objects;
    BoxGrid places;                     // of all objects, as their poses are now
    std::pmr::vector<Object*> touched;  // in slot order: idle objects cost a frame nothing
    std::pmr::vector<Object*> playing;  // baked burns, in slot order
    std::pmr::vector<uint32_t> moved;   // slots to latch at the next exchange
    std::pmr::vector<uint32_t> found;   // scratch of ball queries
    uint64_t geometryVersion = 1;       // grows whenever what may stop a jet moves
    uint64_t texels = 0;                // of all objects, that can burn
    uint64_t fuel = 0;                  // of all objects when they were made
    uint32_t ledgers = 0;               // objects that keep account of theirs
    uint32_t shapes = 0;                // entries of `meshes` that are shapes

 private:
    MeshEntry makeEntry(core::Owned<mesh::BurnDomain> domain) const;
    FwMeshId createEntry(MeshEntry entry);

    const WorldContext& context_;
    std::pmr::vector<uint32_t> nearSlots_;   // scratch of objectsNear
    std::pmr::vector<uint32_t> imageUsers_;  // by backend slot: objects + 1 for a live id; 0: free
};

}  // namespace fw::world
