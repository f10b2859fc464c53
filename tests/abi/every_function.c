/* The public headers in plain C, and every function of them called with nothing: none may crash,
 * all that return a result must refuse. Returns how many functions refused wrongly; the number of
 * calls made goes to *calls. */
#include "flamewright/flamewright.h"
#include "flamewright/flamewright_debug.h"
#include "flamewright/flamewright_vulkan.h"

int fwTestCallEverything(int* calls);

int fwTestCallEverything(int* calls) {
    int wrong = 0;
    *calls = 0;
#define REFUSES(call) (++*calls, wrong += (call) < 0 ? 0 : 1)
#define IS_ZERO(call) (++*calls, wrong += (call) == 0 ? 0 : 1)
#define RUNS(call) (++*calls, (void)(call))
    const FwMaterialId material = {0, 0};
    const FwImageId image = {0, 0};
    const FwMeshId mesh = {0, 0};
    const FwBurnableMeshId object = {0, 0};
    const FwTargetId target = {0, 0};
    const FwQueryId query = {0, 0};
    const FwBlockerId blocker = {0, 0};
    const FwVolumetricFireId fire = {0, 0};
    const FwFireEmitterId emitter = {0, 0};
    const FwFireProfileId profile = {0, 0};
    const FwFlipbookId book = {0, 0};
    const FwFireColliderId collider = {0, 0};
    const FwParticleFieldId field = {0, 0};
    const FwPeerId peer = {0, 0};
    const FwWindZoneId zone = {0, 0};
    const FwRoomId room = {0, 0};

    RUNS(fwResultName(FW_OK));
    RUNS(fwGetVersion());
    RUNS(fwInitDef(FW_DEF_WORLD, NULL, 64));
    REFUSES(fwCreateContext(NULL, NULL, NULL));
    RUNS(fwDestroyContext(NULL));
    REFUSES(fwContext_GetInfo(NULL, NULL));
    IS_ZERO(fwContext_GetLastMessage(NULL, NULL, 0));
    REFUSES(fwContext_Prepare(NULL));
    IS_ZERO(fwContext_GetMemoryReport(NULL, NULL, 0));
    REFUSES(fwCreateWorld(NULL, NULL, NULL));
    RUNS(fwDestroyWorld(NULL));
    IS_ZERO(fwWorld_GetLastMessage(NULL, NULL, 0));
    REFUSES(fwWorld_SetWind(NULL, NULL));
    REFUSES(fwWorld_SetFlags(NULL, 0));
    REFUSES(fwWorld_AddBlocker(NULL, NULL, NULL));
    REFUSES(fwWorld_MoveBlocker(NULL, blocker, NULL));
    REFUSES(fwWorld_RemoveBlocker(NULL, blocker));
    REFUSES(fwWorld_CreateWindZone(NULL, NULL, NULL));
    REFUSES(fwWorld_SetWindZone(NULL, zone, NULL));
    REFUSES(fwWorld_DestroyWindZone(NULL, zone));
    REFUSES(fwWorld_GetWindAt(NULL, NULL, NULL));
    REFUSES(fwWorld_CreateRoom(NULL, NULL, NULL));
    REFUSES(fwWorld_SetRoom(NULL, room, NULL));
    REFUSES(fwWorld_DestroyRoom(NULL, room));
    REFUSES(fwWorld_GetRoomState(NULL, room, NULL));
    REFUSES(fwWorld_GetEnergyBook(NULL, NULL));
    REFUSES(fwInitMaterialPreset(NULL, 0));
    RUNS(fwMaterialPresetName(0));
    REFUSES(fwWorld_CreateMaterial(NULL, NULL, NULL));
    REFUSES(fwWorld_DestroyMaterial(NULL, material));
    REFUSES(fwWorld_CreateImage(NULL, NULL, NULL));
    REFUSES(fwWorld_DestroyImage(NULL, image));
    REFUSES(fwWorld_CreateMesh(NULL, NULL, NULL));
    REFUSES(fwWorld_DestroyMesh(NULL, mesh));
    REFUSES(fwWorld_GetMeshInfo(NULL, mesh, NULL));
    REFUSES(fwCookMesh(NULL, NULL, NULL, NULL));
    REFUSES(fwWorld_CreateBurnableMesh(NULL, NULL, NULL));
    REFUSES(fwWorld_DestroyBurnableMesh(NULL, object));
    REFUSES(fwWorld_SetTransform(NULL, object, NULL));
    REFUSES(fwWorld_SetHidden(NULL, object, 1));
    REFUSES(fwInitFirePreset(NULL, 0));
    RUNS(fwFirePresetName(0));
    REFUSES(fwWorld_CreateVolumetricFire(NULL, NULL, NULL));
    REFUSES(fwWorld_DestroyVolumetricFire(NULL, fire));
    REFUSES(fwWorld_MoveVolumetricFire(NULL, fire, NULL));
    REFUSES(fwWorld_SetVolumetricFirePower(NULL, fire, 0.0f));
    REFUSES(fwWorld_SetVolumetricFirePoints(NULL, fire, NULL, 0));
    REFUSES(fwWorld_SetVolumetricFireHidden(NULL, fire, 1));
    REFUSES(fwWorld_SetVolumetricFireTier(NULL, fire, FW_FIRE_TIER_AUTO));
    REFUSES(fwWorld_GetVolumetricFireState(NULL, fire, NULL));
    REFUSES(fwWorld_SetVolumetricFireTrack(NULL, fire, NULL));
    REFUSES(fwWorld_CreateFireEmitter(NULL, NULL, NULL));
    REFUSES(fwWorld_DestroyFireEmitter(NULL, emitter));
    REFUSES(fwWorld_MoveFireEmitter(NULL, emitter, NULL, NULL));
    REFUSES(fwWorld_SetFireEmitterPower(NULL, emitter, 0.0f));
    REFUSES(fwWorld_SetFireEmitterHidden(NULL, emitter, 1));
    REFUSES(fwWorld_GetFireEmitterState(NULL, emitter, NULL));
    REFUSES(fwWorld_CreateFireProfile(NULL, NULL, NULL));
    REFUSES(fwWorld_DestroyFireProfile(NULL, profile));
    REFUSES(fwWorld_CreateFlipbook(NULL, NULL, NULL));
    REFUSES(fwWorld_DestroyFlipbook(NULL, book));
    REFUSES(fwWorld_SetFlameFlipbooks(NULL, book, book));
    REFUSES(fwCookFireProfile(NULL, NULL, NULL, NULL));
    REFUSES(fwWorld_AddFireCollider(NULL, NULL, NULL));
    REFUSES(fwWorld_SetFireCollider(NULL, collider, NULL));
    REFUSES(fwWorld_RemoveFireCollider(NULL, collider));
    REFUSES(fwWorld_AskVolumetricFires(NULL, NULL, NULL));
    REFUSES(fwWorld_GetVolumetricFirePush(NULL, NULL, 0.0f, NULL));
    REFUSES(fwWorld_SetBudget(NULL, NULL));
    REFUSES(fwWorld_GetBudgetState(NULL, NULL));
    REFUSES(fwWorld_AskSurroundings(NULL, NULL, NULL));
    REFUSES(fwWorld_AskSight(NULL, NULL, NULL, NULL));
    REFUSES(fwWorld_MakeSafetyMask(NULL, NULL, NULL, NULL, 1, 1, NULL));
    REFUSES(fwInitFieldPreset(NULL, 0));
    RUNS(fwFieldPresetName(0));
    REFUSES(fwWorld_CreateParticleField(NULL, NULL, NULL));
    REFUSES(fwWorld_DestroyParticleField(NULL, field));
    REFUSES(fwWorld_MoveParticleField(NULL, field, NULL, NULL));
    REFUSES(fwWorld_SetParticleFieldAmount(NULL, field, 0.0f));
    REFUSES(fwWorld_SetParticleFieldHidden(NULL, field, 1));
    REFUSES(fwWorld_PaintParticleField(NULL, field, NULL, NULL));
    REFUSES(fwWorld_GetParticleFieldState(NULL, field, NULL));
    REFUSES(fwWorld_Ignite(NULL, NULL, NULL));
    REFUSES(fwWorld_Step(NULL, 0.0f));
    REFUSES(fwWorld_RenderOffscreen(NULL, NULL));
    IS_ZERO(fwWorld_PollEvents(NULL, NULL, 0));
    REFUSES(fwWorld_TagPoint(NULL, object, NULL, 0));
    REFUSES(fwWorld_GetObjectState(NULL, object, NULL));
    REFUSES(fwWorld_RequestPoint(NULL, object, NULL, NULL));
    REFUSES(fwWorld_FetchPoint(NULL, query, NULL));
    REFUSES(fwWorld_RequestArrival(NULL, object, NULL, NULL));
    REFUSES(fwWorld_FetchArrival(NULL, query, NULL));
    IS_ZERO(fwWorld_GetLights(NULL, NULL, 0));
    REFUSES(fwWorld_RequestSave(NULL));
    REFUSES(fwWorld_FetchSave(NULL, NULL, NULL));
    REFUSES(fwWorld_Load(NULL, NULL, 0));
    REFUSES(fwWorld_StartLog(NULL));
    REFUSES(fwWorld_StopLog(NULL));
    REFUSES(fwWorld_FetchLog(NULL, NULL, NULL));
    REFUSES(fwWorld_OpenLog(NULL, NULL, 0));
    REFUSES(fwWorld_PlayLog(NULL, 0, NULL));
    REFUSES(fwNet_Serve(NULL, NULL));
    REFUSES(fwNet_Join(NULL, NULL));
    REFUSES(fwNet_Leave(NULL));
    REFUSES(fwNet_AddPeer(NULL, NULL));
    REFUSES(fwNet_RemovePeer(NULL, peer));
    REFUSES(fwNet_Update(NULL, 0.0f));
    REFUSES(fwNet_Write(NULL, peer, NULL, NULL));
    REFUSES(fwNet_Read(NULL, peer, NULL, 0));
    REFUSES(fwNet_Tell(NULL, NULL, 0));
    REFUSES(fwNet_TakeTurn(NULL, NULL));
    REFUSES(fwNet_GetState(NULL, peer, NULL));
    REFUSES(fwWorld_GetStats(NULL, NULL));

    REFUSES(fwQueryVulkanWishes(NULL));
    REFUSES(fwContext_RegisterTarget(NULL, NULL, NULL));
    REFUSES(fwContext_UnregisterTarget(NULL, target));
    REFUSES(fwWorld_RecordOutside(NULL, NULL, NULL));
    REFUSES(fwWorld_RecordInside(NULL, NULL, target, NULL, NULL));
    REFUSES(fwWorld_RecordComposite(NULL, NULL, target, NULL, NULL));
    RUNS((fwContext_NotifyDeviceLost(NULL), 0));

    IS_ZERO(fwDebug_GetPassTimes(NULL, NULL, 0));
    REFUSES(fwDebug_RequestBurnMap(NULL, object));
    REFUSES(fwDebug_FetchBurnMap(NULL, object, NULL, 0, NULL, NULL, NULL));
    REFUSES(fwDebug_SetSwitches(NULL, 0));
    REFUSES(fwDebug_PushTexels(NULL, object, 0, NULL, 0));
    REFUSES(fwDebug_GetTexelPositions(NULL, mesh, NULL, NULL, 0, NULL));
    REFUSES(fwDebug_GetUnwrap(NULL, mesh, NULL, 0, NULL));

    /* Every inline default, in C. */
    wrong += fwDefaultContextDef().abiVersion == FW_ABI_VERSION ? 0 : 1;
    wrong += fwDefaultWorldDef().structSize == sizeof(FwWorldDef) ? 0 : 1;
    wrong += fwDefaultMaterialDef().structSize == sizeof(FwMaterialDef) ? 0 : 1;
    wrong += fwDefaultImageDef().structSize == sizeof(FwImageDef) ? 0 : 1;
    wrong += fwDefaultMeshDef().structSize == sizeof(FwMeshDef) ? 0 : 1;
    wrong += fwDefaultBurnableMeshDef().structSize == sizeof(FwBurnableMeshDef) ? 0 : 1;
    wrong += fwDefaultIgnitionDef().structSize == sizeof(FwIgnitionDef) ? 0 : 1;
    wrong += fwDefaultView().structSize == sizeof(FwView) ? 0 : 1;
    wrong += fwDefaultBlockerDef().structSize == sizeof(FwBlockerDef) ? 0 : 1;
    wrong += fwDefaultVolumetricFireDef().structSize == sizeof(FwVolumetricFireDef) ? 0 : 1;
    wrong += fwDefaultFireEmitterDef().structSize == sizeof(FwFireEmitterDef) ? 0 : 1;
    wrong += fwDefaultFlipbookDef().structSize == sizeof(FwFlipbookDef) ? 0 : 1;
    wrong += fwDefaultFireProfileDef().structSize == sizeof(FwFireProfileDef) ? 0 : 1;
    wrong += fwDefaultBudgetDef().structSize == sizeof(FwBudgetDef) ? 0 : 1;
    wrong += fwDefaultNetDef().structSize == sizeof(FwNetDef) ? 0 : 1;
    wrong += fwDefaultFireColliderDef().structSize == sizeof(FwFireColliderDef) ? 0 : 1;
    wrong += fwDefaultFireTrackDef().structSize == sizeof(FwFireTrackDef) ? 0 : 1;
    wrong += fwDefaultParticleFieldDef().structSize == sizeof(FwParticleFieldDef) ? 0 : 1;
    wrong += fwDefaultOffscreenDef().structSize == sizeof(FwOffscreenDef) ? 0 : 1;
    wrong += fwDefaultVulkanHost().structSize == sizeof(FwVulkanHost) ? 0 : 1;
    wrong += fwDefaultVulkanTargetDef().structSize == sizeof(FwVulkanTargetDef) ? 0 : 1;
    wrong += fwDefaultVulkanFrame().structSize == sizeof(FwVulkanFrame) ? 0 : 1;
    wrong += fwDefaultVulkanComposite().structSize == sizeof(FwVulkanComposite) ? 0 : 1;
    return wrong;
}
