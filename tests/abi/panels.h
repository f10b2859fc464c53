// Sheets that lie where they are put, in a world of the cpu backend: what the tests of fire from
// object to object burn.
#pragma once
#include "abi/abi_support.h"

#include <algorithm>

namespace host {

// Sheets of 0.4 x 0.2 m that lie flat, where they are put.
struct Panels {
    // given: a context, which becomes ours; null: of the cpu backend.
    explicit Panels(const FwWorldDef& def, float burnTime = 20, float texelsPerMetre = 64,
                    FwContext* given = nullptr)
        : sheet(0.4f, 0.2f) {
        context = given ? given : createCpuContext(host);
        EXPECT_EQ(FW_OK, fwCreateWorld(context, &def, &world)) << lastMessage(context);
        const FwMeshDef meshDef = sheet.def(texelsPerMetre);
        EXPECT_EQ(FW_OK, fwWorld_CreateMesh(world, &meshDef, &mesh)) << lastMessage(world);
        const FwMaterialDef even = evenMaterial(0.02f, burnTime);
        EXPECT_EQ(FW_OK, fwWorld_CreateMaterial(world, &even, &material));
    }
    ~Panels() { fwDestroyContext(context); }
    Panels(const Panels&) = delete;
    Panels& operator=(const Panels&) = delete;

    FwBurnableMeshDef def(float x, float y, float z) const {
        FwBurnableMeshDef made = fwDefaultBurnableMeshDef();
        made.mesh = mesh;
        made.materials[0] = material;
        // Without temperatures: fire comes by contact and embers alone.
        made.flags = FW_BURNABLE_LITE | FW_BURNABLE_TWO_SIDED;
        made.transform[12] = x;
        made.transform[13] = y;
        made.transform[14] = z;
        return made;
    }
    FwBurnableMeshId add(const FwBurnableMeshDef& made) {
        FwBurnableMeshId id{};
        EXPECT_EQ(FW_OK, fwWorld_CreateBurnableMesh(world, &made, &id)) << lastMessage(world);
        ids.push_back(id);
        return id;
    }
    FwBurnableMeshId add(float x, float y, float z) { return add(def(x, y, z)); }
    void ignite(FwBurnableMeshId id, float x, float y, float z, float radius = 0.02f) {
        FwIgnitionDef ball = fwDefaultIgnitionDef();
        ball.object = id;
        ball.position[0] = x;
        ball.position[1] = y;
        ball.position[2] = z;
        ball.radius = radius;
        uint32_t texels = 0;
        EXPECT_EQ(FW_OK, fwWorld_Ignite(world, &ball, &texels)) << lastMessage(world);
        EXPECT_LT(0u, texels);
    }
    void run(double seconds, float deltaTime = 1.0f / 32.0f) {
        for (double t = 0; t < seconds - 1e-9; t += double(deltaTime)) {
            ASSERT_EQ(FW_OK, fwWorld_Step(world, deltaTime)) << lastMessage(world);
            std::vector<FwEvent> some(256);
            some.resize(fwWorld_PollEvents(world, some.data(), 256));
            events.insert(events.end(), some.begin(), some.end());
        }
    }
    FwObjectState state(FwBurnableMeshId id) {
        FwObjectState made{};
        made.structSize = sizeof made;
        EXPECT_EQ(FW_OK, fwWorld_GetObjectState(world, id, &made)) << lastMessage(world);
        return made;
    }
    uint32_t lit(size_t i) { return state(ids[i]).ignited; }
    uint32_t alight() {  // objects that ever caught
        uint32_t count = 0;
        for (size_t i = 0; i < ids.size(); ++i) count += lit(i) > 0 ? 1 : 0;
        return count;
    }
    uint64_t hash() {
        uint64_t all = 0;
        for (const FwBurnableMeshId id : ids) {
            EXPECT_EQ(FW_OK, fwDebug_RequestBurnMap(world, id)) << lastMessage(world);
            uint64_t one = 0;
            EXPECT_EQ(FW_OK, fwDebug_FetchBurnMap(world, id, nullptr, 0, nullptr, &one, nullptr))
                << lastMessage(world);
            all = all * 0x9E3779B97F4A7C15ull + one;
        }
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

    Host host;
    Sheet sheet;
    FwContext* context = nullptr;
    FwWorld* world = nullptr;
    FwMeshId mesh{};
    FwMaterialId material{};
    std::vector<FwBurnableMeshId> ids;
    std::vector<FwEvent> events;
};

inline FwWorldDef worldDef(uint32_t flags) {
    FwWorldDef def = fwDefaultWorldDef();
    def.flags = flags;
    def.maxStepsPerFrame = 64;
    return def;
}

}  // namespace host
