// Other threads than the stepping one may destroy objects later and read the results of a step.
#include "abi/abi_support.h"

#include "flamewright/flamewright.hpp"

#include <cfloat>
#include <set>
#include <string>

namespace {

using host::created;
using host::Host;
using host::lastMessage;
using host::SheetWorld;

FwObjectState stateOf(FwWorld* world, FwBurnableMeshId id, FwResult want = FW_OK) {
    FwObjectState state{};
    state.structSize = sizeof state;
    EXPECT_EQ(want, fwWorld_GetObjectState(world, id, &state)) << lastMessage(world);
    return state;
}

TEST(Deferred, DestroysTheWorldWhenItsFrameCompletes) {
    Host host;
    FwContext* context = host::createCpuContext(host);
    const FwWorldDef def = fwDefaultWorldDef();
    FwWorld *first = nullptr, *second = nullptr;
    ASSERT_EQ(FW_OK, fwCreateWorld(context, &def, &first));
    const int64_t oneWorld = host.bytes;
    ASSERT_EQ(FW_OK, fwCreateWorld(context, &def, &second));
    for (int i = 0; i < 3; ++i) ASSERT_EQ(FW_OK, fwWorld_Step(second, 1.0f / 32));
    ASSERT_EQ(FW_OK, fwWorld_DestroyAfterFrame(second, 0)) << lastMessage(second);  // frame 3
    EXPECT_EQ(1u, fwContext_Collect(context, 2));
    EXPECT_LT(oneWorld, host.bytes) << "its last frame may still run";
    EXPECT_EQ(0u, fwContext_Collect(context, 3));
    EXPECT_LE(host.bytes, oneWorld + 4096) << "the world is gone";
    // The last call counts; a world that is destroyed at once waits for nothing.
    ASSERT_EQ(FW_OK, fwWorld_DestroyAfterFrame(first, 5));
    ASSERT_EQ(FW_OK, fwWorld_DestroyAfterFrame(first, 9));
    EXPECT_EQ(1u, fwContext_Collect(context, 8));
    fwDestroyWorld(first);
    EXPECT_EQ(0u, fwContext_Collect(context, 8));
    ASSERT_EQ(FW_OK, fwCreateWorld(context, &def, &first));
    ASSERT_EQ(FW_OK, fwWorld_DestroyAfterFrame(first, UINT64_MAX));
    fwDestroyContext(context);  // with a deferred destroy pending
    EXPECT_EQ(0, host.blocks);
}

TEST(Deferred, DestroysObjectsBeforeTheNextStepInAnyOrder) {
    SheetWorld w(host::evenMaterial(0.05f, 5));
    const FwBurnableMeshId other = w.add(8);
    ASSERT_EQ(FW_OK, fw::destroyLater(w.world, w.mesh));  // both objects still use it
    ASSERT_EQ(FW_OK, fw::destroyLater(w.world, w.object));
    EXPECT_EQ(FW_OK, fwWorld_SetHidden(w.world, w.object, 0)) << "nothing is destroyed yet";
    ASSERT_EQ(FW_OK, fwWorld_Step(w.world, 0));
    (void)stateOf(w.world, w.object, FW_ERROR_STALE_ID);
    FwMeshInfo info{};
    info.structSize = sizeof info;
    EXPECT_EQ(FW_OK, fwWorld_GetMeshInfo(w.world, w.mesh, &info)) << "one object is left";
    ASSERT_EQ(FW_OK, fw::destroyLater(w.world, other));
    ASSERT_EQ(FW_OK, fwWorld_Step(w.world, 0));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_GetMeshInfo(w.world, w.mesh, &info));
    // A stale id is reported in the log and stops nothing.
    const FwMaterialDef materialDef = fwDefaultMaterialDef();
    const FwMaterialId extra = created(fwWorld_CreateMaterial, w.world, materialDef);
    const size_t warnings = w.host.warnings.size();
    ASSERT_EQ(FW_OK, fw::destroyLater(w.world, w.mesh));
    ASSERT_EQ(FW_OK, fw::destroyLater(w.world, extra));
    ASSERT_EQ(FW_OK, fwWorld_Step(w.world, 0));
    ASSERT_EQ(warnings + 1, w.host.warnings.size());
    EXPECT_NE(std::string::npos, w.host.warnings.back().find("fwWorld_DestroyLater: Mesh 1"));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_DestroyMaterial(w.world, extra));
}

TEST(Deferred, DestroysEveryKindOfObject) {
    SheetWorld w(host::evenMaterial(0.05f, 5));
    const std::vector<float> texels(2 * 8 * 8, 0.5f);
    FwFireProfileDef profileDef = fwDefaultFireProfileDef();
    profileDef.width = profileDef.height = 8;
    profileDef.texels = texels.data();
    const FwFireProfileId profile = created(fwWorld_CreateFireProfile, w.world, profileDef);
    FwVolumetricFireDef fireDef = fwDefaultVolumetricFireDef();
    fireDef.profile = profile;
    const FwVolumetricFireId fire = created(fwWorld_CreateVolumetricFire, w.world, fireDef);
    const FwFireEmitterDef emitterDef = fwDefaultFireEmitterDef();
    const FwFireEmitterId emitter = created(fwWorld_CreateFireEmitter, w.world, emitterDef);
    const FwParticleFieldDef fieldDef = fwDefaultParticleFieldDef();
    const FwParticleFieldId field = created(fwWorld_CreateParticleField, w.world, fieldDef);
    const FwWindZoneDef zoneDef = fwDefaultWindZoneDef();
    const FwWindZoneId zone = created(fwWorld_CreateWindZone, w.world, zoneDef);
    const FwRoomDef roomDef = fwDefaultRoomDef();
    const FwRoomId room = created(fwWorld_CreateRoom, w.world, roomDef);
    const FwHeatOccluderDef occluderDef = fwDefaultHeatOccluderDef();
    const FwHeatOccluderId occluder = created(fwWorld_AddHeatOccluder, w.world, occluderDef);
    const FwFireColliderDef colliderDef = fwDefaultFireColliderDef();
    const FwFireColliderId collider = created(fwWorld_AddFireCollider, w.world, colliderDef);
    const uint32_t pixels[4] = {};
    FwImageDef imageDef = fwDefaultImageDef();
    imageDef.width = imageDef.height = 2;
    imageDef.pixels = pixels;
    const FwImageId image = created(fwWorld_CreateImage, w.world, imageDef);
    FwBurnableMeshDef shows = fwDefaultBurnableMeshDef();
    shows.mesh = w.mesh;
    shows.baseColor = image;
    const FwBurnableMeshId object = created(fwWorld_CreateBurnableMesh, w.world, shows);

    const auto later = [&](auto id) {
        EXPECT_EQ(FW_OK, fw::destroyLater(w.world, id)) << lastMessage(w.world);
    };
    later(profile);  // before the fire that uses it
    later(image);    // before the object that shows it
    later(fire);
    later(emitter);
    later(field);
    later(zone);
    later(room);
    later(occluder);
    later(collider);
    later(object);
    later(w.materialId);
    ASSERT_EQ(FW_OK, fwWorld_Step(w.world, 1.0f / 32)) << lastMessage(w.world);
    EXPECT_TRUE(w.host.warnings.empty());
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_DestroyFireProfile(w.world, profile));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_DestroyImage(w.world, image));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_DestroyVolumetricFire(w.world, fire));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_DestroyFireEmitter(w.world, emitter));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_DestroyParticleField(w.world, field));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_DestroyWindZone(w.world, zone));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_DestroyRoom(w.world, room));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_RemoveHeatOccluder(w.world, occluder));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_RemoveFireCollider(w.world, collider));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_DestroyBurnableMesh(w.world, object));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_DestroyMaterial(w.world, w.materialId));
}

TEST(Deferred, RefusesInvalidIds) {
    SheetWorld w(host::evenMaterial(0.05f, 5));
    const FwObjectRef kind{99, 1, 1, 0}, reserved{FW_OBJECT_MESH, 1, 1, 7},
        null{FW_OBJECT_MESH, 0, 0, 0};
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_DestroyLater(w.world, &kind));
    EXPECT_NE(std::string::npos, lastMessage(w.world).find("FwObjectRef::kind is 99"));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_DestroyLater(w.world, &reserved));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_DestroyLater(w.world, &null));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_DestroyLater(w.world, nullptr));
}

TEST(Snapshot, HoldsStatesAndLightsOfTheLastStep) {
    SheetWorld w(host::evenMaterial(0.05f, 5));
    const FwBurnableMeshId calm = w.add(8), gone = w.add(9);
    FwObjectState read{};
    read.structSize = sizeof read;
    std::vector<FwLight> lights(16), direct(16);
    auto count = uint32_t(lights.size());
    EXPECT_EQ(FW_NOT_READY, fwWorld_ReadObjectState(w.world, w.object, &read));
    EXPECT_EQ(FW_NOT_READY, fwWorld_ReadLights(w.world, lights.data(), &count));
    EXPECT_EQ(0u, count);
    w.ball(FW_IGNITE, 0.3f, 0, 0.1f, 0.05f);
    w.run(1);
    for (const FwBurnableMeshId id : {w.object, calm, gone}) {
        const FwObjectState state = stateOf(w.world, id);
        ASSERT_EQ(FW_OK, fwWorld_ReadObjectState(w.world, id, &read)) << lastMessage(w.world);
        EXPECT_EQ(0, std::memcmp(&state, &read, sizeof read)) << "object " << id.index1;
    }
    EXPECT_LT(0u, stateOf(w.world, w.object).burning);
    count = uint32_t(lights.size());
    ASSERT_EQ(FW_OK, fwWorld_ReadLights(w.world, lights.data(), &count));
    ASSERT_LT(0u, count);
    ASSERT_EQ(count, fwWorld_GetLights(w.world, direct.data(), uint32_t(direct.size())));
    EXPECT_EQ(0, std::memcmp(lights.data(), direct.data(), count * sizeof(FwLight)));

    // Created and destroyed objects appear with the next step.
    const FwBurnableMeshId fresh = w.add(10);
    EXPECT_EQ(FW_NOT_READY, fwWorld_ReadObjectState(w.world, fresh, &read));
    ASSERT_EQ(FW_OK, fwWorld_DestroyBurnableMesh(w.world, gone));
    EXPECT_EQ(FW_OK, fwWorld_ReadObjectState(w.world, gone, &read));
    const FwBurnableMeshId again = w.add(11);  // takes the same slot
    EXPECT_EQ(gone.index1, again.index1);
    EXPECT_EQ(FW_NOT_READY, fwWorld_ReadObjectState(w.world, again, &read));
    w.run(0.25);
    EXPECT_EQ(FW_OK, fwWorld_ReadObjectState(w.world, fresh, &read));
    EXPECT_EQ(FW_OK, fwWorld_ReadObjectState(w.world, again, &read));
    EXPECT_EQ(0u, read.burning);
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_ReadObjectState(w.world, gone, &read));
    EXPECT_NE(std::string::npos, lastMessage(w.world).find("is already destroyed"));
}

TEST(MemoryReport, CpuRowsFollowCreationAndDestruction) {
    SheetWorld w(host::evenMaterial(0.05f, 5));
    const auto states = [&] {
        FwMemoryRow rows[16];
        const uint32_t count = fwContext_GetMemoryReport(w.context, rows, 16);
        EXPECT_LE(count, 16u);
        std::set<std::string> names;
        for (uint32_t i = 0; i < count; ++i) EXPECT_TRUE(names.insert(rows[i].name).second);
        for (const char* name : {"cpu objects", "cpu tiles and lists", "world objects",
                                 "world neighbours", "world frames"})
            EXPECT_TRUE(names.contains(name)) << name;
        EXPECT_STREQ("cpu texel states", rows[0].name);
        return rows[0].bytes;
    };
    const uint64_t one = states();
    EXPECT_LT(0u, one);
    const FwBurnableMeshId second = w.add(8);
    EXPECT_EQ(2 * one, states());
    ASSERT_EQ(FW_OK, fwWorld_DestroyBurnableMesh(w.world, second));
    EXPECT_EQ(one, states());
}

}  // namespace
