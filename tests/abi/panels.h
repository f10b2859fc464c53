// Sheets at chosen places in a cpu world, for the tests of fire spread between objects.
#pragma once
#include "abi/abi_support.h"

#include <algorithm>

namespace host {

// Flat sheets of 0.4 x 0.2 m.
struct Panels : HostedWorld {
    // given: a context that this object then owns; null: a cpu context.
    explicit Panels(const FwWorldDef& worldDef, float burnTime = 20, float texelsPerMetre = 64,
                    FwContext* given = nullptr)
        : HostedWorld(FW_BACKEND_CPU, worldDef, given),
          sheet(0.4f, 0.2f),
          mesh(created(fwWorld_CreateMesh, world, sheet.def(texelsPerMetre))),
          material(created(fwWorld_CreateMaterial, world, evenMaterial(0.02f, burnTime))) {}

    FwBurnableMeshDef def(float x, float y, float z) const {
        FwBurnableMeshDef made = fwDefaultBurnableMeshDef();
        made.mesh = mesh;
        made.materials[0] = material;
        // Without temperatures: fire spreads by contact and embers only.
        made.flags = FW_BURNABLE_LITE | FW_BURNABLE_TWO_SIDED;
        made.transform[12] = x;
        made.transform[13] = y;
        made.transform[14] = z;
        return made;
    }
    FwBurnableMeshId add(const FwBurnableMeshDef& made) {
        const FwBurnableMeshId id = created(fwWorld_CreateBurnableMesh, world, made);
        ids.push_back(id);
        return id;
    }
    FwBurnableMeshId add(float x, float y, float z) { return add(def(x, y, z)); }
    void run(double seconds, float deltaTime = 1.0f / 32.0f) {
        for (double t = 0; t < seconds - 1e-9; t += double(deltaTime)) {
            ASSERT_EQ(FW_OK, fwWorld_Step(world, deltaTime)) << lastMessage(world);
            const std::vector<FwEvent> some = poll();
            events.insert(events.end(), some.begin(), some.end());
        }
    }
    uint32_t lit(size_t i) { return state(ids[i]).ignited; }
    uint32_t alight() {  // objects that ever caught
        uint32_t count = 0;
        for (size_t i = 0; i < ids.size(); ++i) count += lit(i) > 0 ? 1 : 0;
        return count;
    }
    uint64_t hash() {
        uint64_t all = 0;
        for (const FwBurnableMeshId id : ids)
            all = all * 0x9E3779B97F4A7C15ull + HostedWorld::hash(id);
        return all;
    }
    size_t heard(uint32_t type) const {
        return size_t(std::count_if(events.begin(), events.end(),
                                    [&](const FwEvent& event) { return event.type == type; }));
    }
    const FwEvent* event(uint32_t type) const {
        for (const FwEvent& one : events)
            if (one.type == type) return &one;
        return nullptr;
    }

    Sheet sheet;
    FwMeshId mesh{};
    FwMaterialId material{};
    std::vector<FwBurnableMeshId> ids;
    std::vector<FwEvent> events;
};

}  // namespace host
