// fwCreateWorld and everything that takes a world but no Vulkan.
#include "objects.h"

#include <algorithm>

using namespace fw;
using edge::answerAtOnce;
using edge::checkPointer;
using edge::InMetres;
using edge::Metres;
using edge::onContext;
using edge::onWorld;
using edge::systemOf;

namespace {

FwResult ask(const char* function, FwWorld* world,
             FwQueryId (world::QuerySystem::*request)(FwBurnableMeshId, const float*),
             FwBurnableMeshId id, const float* position, FwQueryId* query) {
    return onWorld(function, world, [&](world::World& w) {
        checkPointer(position, "position");
        checkPointer(query, "query");
        *query = {};
        const FwQueryId made = (w.queries().*request)(id, Metres(world->unit, position));
        try {
            answerAtOnce(world);
        } catch (...) {
            w.queries().cancel(made);
            throw;
        }
        *query = made;
        return FW_OK;
    });
}

// Fills a struct of the caller's by a member of a system; `what`: the id whose state it is, if any.
template <class Info, class System, class Function, class... What>
FwResult fill(const char* function, FwWorld* world, Info* info, const char* name,
              Function System::*member, What... what) {
    return onWorld(function, world, [&](world::World& w) {
        const uint32_t size = edge::checkInfo(info, name);
        Info filled{};
        (systemOf<System>(w).*member)(what..., filled);
        edge::fromMetres(world->unit, filled);
        edge::writeInfo(info, size, filled);
        return FW_OK;
    });
}

template <class State>
FwResult answer(const char* function, FwWorld* world,
                bool (world::QuerySystem::*fetch)(FwQueryId, State&), FwQueryId query, State* state,
                const char* name) {
    return onWorld(function, world, [&](world::World& w) {
        const uint32_t size = edge::checkInfo(state, name);
        State filled{};
        if (!(w.queries().*fetch)(query, filled)) return FW_NOT_READY;
        edge::fromMetres(world->unit, filled);
        edge::writeInfo(state, size, filled);
        return FW_OK;
    });
}

// *size: room in `buffer`, then what there is; buffer null: the host asks for the size.
void giveBytes(std::span<const std::byte> bytes, const char* what, void* buffer, uint64_t& size) {
    const uint64_t room = size;
    size = bytes.size();
    if (!buffer) return;
    if (room < bytes.size())
        core::fail(FW_ERROR_INVALID_ARGUMENT, "*size is %llu and the %s has %zu bytes.",
                   static_cast<unsigned long long>(room), what, bytes.size());
    std::memcpy(buffer, bytes.data(), bytes.size());
}

void freeWorld(FwWorld* world) noexcept {
    FwContext* context = world->context;
    world->server.reset();
    world->client.reset();
    world->world.reset();
    if (world->backend) context->device->destroyBackend(world->backend);
    std::pmr::polymorphic_allocator<>(&context->memory).delete_object(world);
}

template <class System, class Id, class Def>
FwResult createOf(const char* function, FwWorld* world, Id (System::*create)(const Def&),
                  const Def* given, FwDefType type, const char* name, Id* id) {
    return onWorld(function, world, [&](world::World& w) {
        checkPointer(id, "id");
        *id = {};
        *id = (systemOf<System>(w).*create)(InMetres<Def>(*world, given, type, name));
        return FW_OK;
    });
}

template <class System, class Id>
FwResult destroyOf(const char* function, FwWorld* world, void (System::*destroy)(Id), Id id) {
    return onWorld(function, world, [&](world::World& w) {
        (systemOf<System>(w).*destroy)(id);
        return FW_OK;
    });
}

}  // namespace

extern "C" {

FwResult FW_CALL fwCreateWorld(FwContext* context, const FwWorldDef* given, FwWorld** out) {
    if (out) *out = nullptr;
    edge::Unit unit;
    const auto create = [&](FwContext& c) {
        checkPointer(out, "world");
        FwWorldDef def = edge::readDef(given, FW_DEF_WORLD, "FwWorldDef");
        unit = edge::checkedUnit(def.metersPerUnit, "FwWorldDef::metersPerUnit", {});
        edge::toMetres(unit, def);
        world::checkWorldDef(def);
        FwWorld* handle =
            std::pmr::polymorphic_allocator<>(&c.memory).new_object<FwWorld>(context, unit);
        try {
            handle->backend = c.device->createBackend(def);
            handle->world.emplace(def, *handle->backend, c.log, &c.memory);
            const std::lock_guard lock(c.mutex);
            c.worlds.push_back(handle);
        } catch (...) {
            freeWorld(handle);
            throw;
        }
        *out = handle;
        return FW_OK;
    };
    return onContext("fwCreateWorld", context, create, unit);
}

FwResult FW_CALL fwWorld_ConvertDef(FwWorld* world, uint32_t defType, void* def) {
    return onWorld("fwWorld_ConvertDef", world, [&](world::World&) {
        checkPointer(def, "def");
        edge::defFromMetres(defType, world->unit, def);
        return FW_OK;
    });
}

void FW_CALL fwDestroyWorld(FwWorld* world) {
    if (!world) return;
    FwContext* context = world->context;
    {
        const std::lock_guard lock(context->mutex);
        std::erase(context->worlds, world);
        std::erase_if(context->deferredWorlds, [&](const auto& one) { return one.what == world; });
    }
    freeWorld(world);
}

size_t FW_CALL fwWorld_GetLastMessage(FwWorld* world, char* text, size_t capacity) {
    return world ? world->message.copy(text, capacity) : 0;
}

FwResult FW_CALL fwWorld_SetWind(FwWorld* world, const float wind[3]) {
    return onWorld("fwWorld_SetWind", world, [&](world::World& w) {
        checkPointer(wind, "wind");
        w.wind().set(Metres(world->unit, wind));
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_SetFlags(FwWorld* world, uint32_t flags) {
    return onWorld("fwWorld_SetFlags", world, [&](world::World& w) {
        w.exchange().setFlags(flags);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_AddHeatOccluder(FwWorld* world, const FwHeatOccluderDef* given,
                                         FwHeatOccluderId* id) {
    return onWorld("fwWorld_AddHeatOccluder", world, [&](world::World& w) {
        checkPointer(id, "id");
        *id = {};
        *id = w.exchange().addHeatOccluder(
            InMetres(*world, given, FW_DEF_HEAT_OCCLUDER, "FwHeatOccluderDef"));
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_MoveHeatOccluder(FwWorld* world, FwHeatOccluderId id,
                                          const float transform[16]) {
    return onWorld("fwWorld_MoveHeatOccluder", world, [&](world::World& w) {
        checkPointer(transform, "transform");
        const edge::TransformInMetres pose(world->unit, world->unit, transform);
        w.exchange().moveHeatOccluder(id, pose.matrix);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_RemoveHeatOccluder(FwWorld* world, FwHeatOccluderId id) {
    return destroyOf("fwWorld_RemoveHeatOccluder", world,
                     &world::ExchangeSystem::removeHeatOccluder, id);
}

FwResult FW_CALL fwWorld_SetHeatOcclusion(FwWorld* world, const FwHeatOcclusionDef* given) {
    return onWorld("fwWorld_SetHeatOcclusion", world, [&](world::World& w) {
        if (given)
            w.exchange().setHeatOcclusion(edge::OcclusionInMetres(*world, given));
        else
            w.exchange().setHeatOcclusion({});
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_CreateWindZone(FwWorld* world, const FwWindZoneDef* given,
                                        FwWindZoneId* id) {
    return createOf("fwWorld_CreateWindZone", world, &world::WindSystem::createZone, given,
                    FW_DEF_WIND_ZONE, "FwWindZoneDef", id);
}

FwResult FW_CALL fwWorld_SetWindZone(FwWorld* world, FwWindZoneId id, const FwWindZoneDef* given) {
    return onWorld("fwWorld_SetWindZone", world, [&](world::World& w) {
        w.wind().setZone(id, InMetres(*world, given, FW_DEF_WIND_ZONE, "FwWindZoneDef"));
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_DestroyWindZone(FwWorld* world, FwWindZoneId id) {
    return destroyOf("fwWorld_DestroyWindZone", world, &world::WindSystem::destroyZone, id);
}

FwResult FW_CALL fwWorld_SetWindGrid(FwWorld* world, const FwWindGridDef* given) {
    return onWorld("fwWorld_SetWindGrid", world, [&](world::World& w) {
        if (given)
            w.wind().setGrid(InMetres(*world, given, FW_DEF_WIND_GRID, "FwWindGridDef"));
        else
            w.wind().setGrid({});
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_SetGusts(FwWorld* world, const FwGustDef* given) {
    return onWorld("fwWorld_SetGusts", world, [&](world::World& w) {
        w.wind().setGusts(InMetres(*world, given, FW_DEF_GUSTS, "FwGustDef"));
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_GetWindAt(FwWorld* world, const float point[3], float wind[3]) {
    return onWorld("fwWorld_GetWindAt", world, [&](world::World& w) {
        checkPointer(point, "point");
        checkPointer(wind, "wind");
        w.wind().atPoint(Metres(world->unit, point), wind);
        edge::fromMetres3(world->unit, wind);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_CreateRoom(FwWorld* world, const FwRoomDef* given, FwRoomId* id) {
    return createOf("fwWorld_CreateRoom", world, &world::RoomSystem::create, given, FW_DEF_ROOM,
                    "FwRoomDef", id);
}

FwResult FW_CALL fwWorld_SetRoom(FwWorld* world, FwRoomId id, const FwRoomDef* given) {
    return onWorld("fwWorld_SetRoom", world, [&](world::World& w) {
        w.rooms().set(id, InMetres(*world, given, FW_DEF_ROOM, "FwRoomDef"));
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_DestroyRoom(FwWorld* world, FwRoomId id) {
    return destroyOf("fwWorld_DestroyRoom", world, &world::RoomSystem::destroy, id);
}

FwResult FW_CALL fwWorld_GetRoomState(FwWorld* world, FwRoomId id, FwRoomState* state) {
    return fill("fwWorld_GetRoomState", world, state, "FwRoomState", &world::RoomSystem::fillState,
                id);
}

// ---- materials, images, meshes ----------------------------------------------------------------

FwResult FW_CALL fwWorld_CreateMaterial(FwWorld* world, const FwMaterialDef* given,
                                        FwMaterialId* id) {
    return createOf("fwWorld_CreateMaterial", world, &world::Scene::createMaterial, given,
                    FW_DEF_MATERIAL, "FwMaterialDef", id);
}

FwResult FW_CALL fwWorld_DestroyMaterial(FwWorld* world, FwMaterialId id) {
    return destroyOf("fwWorld_DestroyMaterial", world, &world::Scene::destroyMaterial, id);
}

FwResult FW_CALL fwWorld_CreateImage(FwWorld* world, const FwImageDef* given, FwImageId* id) {
    return createOf("fwWorld_CreateImage", world, &world::Scene::createImage, given, FW_DEF_IMAGE,
                    "FwImageDef", id);
}

FwResult FW_CALL fwWorld_DestroyImage(FwWorld* world, FwImageId id) {
    return destroyOf("fwWorld_DestroyImage", world, &world::Scene::destroyImage, id);
}

FwResult FW_CALL fwWorld_CreateMesh(FwWorld* world, const FwMeshDef* given, FwMeshId* id) {
    if (!world) return FW_ERROR_INVALID_ARGUMENT;
    edge::Unit unit = world->unit;
    const auto create = [&](world::World& w) {
        checkPointer(id, "id");
        *id = {};
        unit = edge::checkedUnit(edge::readDef(given, FW_DEF_MESH, "FwMeshDef").metersPerUnit,
                                 "FwMeshDef::metersPerUnit", world->unit);
        const FwMeshId made =
            w.scene().createMesh(InMetres(*world, given, FW_DEF_MESH, "FwMeshDef", unit));
        try {
            edge::setUnit(*world, world->meshUnits, made.index1, unit);
        } catch (...) {
            w.scene().destroyMesh(made);
            throw;
        }
        *id = made;
        return FW_OK;
    };
    return onWorld("fwWorld_CreateMesh", world, create, &unit);
}

FwResult FW_CALL fwWorld_DestroyMesh(FwWorld* world, FwMeshId id) {
    return destroyOf("fwWorld_DestroyMesh", world, &world::Scene::destroyMesh, id);
}

FwResult FW_CALL fwWorld_GetMeshInfo(FwWorld* world, FwMeshId id, FwMeshInfo* info) {
    return onWorld("fwWorld_GetMeshInfo", world, [&](world::World& w) {
        const uint32_t size = edge::checkInfo(info, "FwMeshInfo");
        FwMeshInfo filled{};
        w.scene().meshInfo(id, filled);
        edge::fromMetres(edge::meshUnit(*world, id), filled);
        edge::writeInfo(info, size, filled);
        return FW_OK;
    });
}

// ---- burnable meshes --------------------------------------------------------------------------

FwResult FW_CALL fwWorld_CreateBurnableMesh(FwWorld* world, const FwBurnableMeshDef* given,
                                            FwBurnableMeshId* id) {
    return onWorld("fwWorld_CreateBurnableMesh", world, [&](world::World& w) {
        checkPointer(id, "id");
        *id = {};
        constexpr const char* kName = "FwBurnableMeshDef";
        const FwMeshId mesh = edge::readDef(given, FW_DEF_BURNABLE_MESH, kName).mesh;
        const edge::Unit unit = edge::meshUnit(*world, mesh);
        InMetres def(*world, given, FW_DEF_BURNABLE_MESH, kName, unit);
        edge::scaleAxes(unit, world->unit, def->transform);
        const FwBurnableMeshId made = w.createBurnableMesh(def);
        try {
            edge::setUnit(*world, world->objectUnits, made.index1, unit);
        } catch (...) {
            w.destroyBurnableMesh(made);
            throw;
        }
        *id = made;
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_DestroyBurnableMesh(FwWorld* world, FwBurnableMeshId id) {
    return destroyOf("fwWorld_DestroyBurnableMesh", world, &world::World::destroyBurnableMesh, id);
}

FwResult FW_CALL fwWorld_SetTransform(FwWorld* world, FwBurnableMeshId id,
                                      const float transform[16]) {
    return onWorld("fwWorld_SetTransform", world, [&](world::World& w) {
        checkPointer(transform, "transform");
        const edge::TransformInMetres pose(edge::objectUnit(*world, id), world->unit, transform);
        w.setTransform(id, pose.matrix);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_SetVertexPositions(FwWorld* world, FwBurnableMeshId id,
                                            const float* positions, const float* normals,
                                            uint32_t vertexCount) {
    return onWorld("fwWorld_SetVertexPositions", world, [&](world::World& w) {
        checkPointer(positions, "positions");
        (void)w.scene().skinnedSlot(id, vertexCount);
        edge::MetreArrays arrays(edge::objectUnit(*world, id), &world->context->memory);
        const uint64_t count = uint64_t(vertexCount) * 3;
        w.setVertexPositions(id, arrays(positions, count, count), normals, vertexCount);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_SetHidden(FwWorld* world, FwBurnableMeshId id, uint32_t hidden) {
    return onWorld("fwWorld_SetHidden", world, [&](world::World& w) {
        w.scene().setHidden(id, hidden != 0);
        return FW_OK;
    });
}

// ---- volumetric fires -------------------------------------------------------------------------

FwResult FW_CALL fwWorld_CreateVolumetricFire(FwWorld* world, const FwVolumetricFireDef* given,
                                              FwVolumetricFireId* id) {
    return createOf("fwWorld_CreateVolumetricFire", world, &world::FlameSystem::create, given,
                    FW_DEF_VOLUMETRIC_FIRE, "FwVolumetricFireDef", id);
}

FwResult FW_CALL fwWorld_DestroyVolumetricFire(FwWorld* world, FwVolumetricFireId id) {
    return destroyOf("fwWorld_DestroyVolumetricFire", world, &world::FlameSystem::destroy, id);
}

FwResult FW_CALL fwWorld_MoveVolumetricFire(FwWorld* world, FwVolumetricFireId id,
                                            const float position[3]) {
    return onWorld("fwWorld_MoveVolumetricFire", world, [&](world::World& w) {
        checkPointer(position, "position");
        w.flames().move(id, Metres(world->unit, position));
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_SetVolumetricFirePower(FwWorld* world, FwVolumetricFireId id,
                                                float power) {
    return onWorld("fwWorld_SetVolumetricFirePower", world, [&](world::World& w) {
        w.flames().setPower(id, power);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_SetVolumetricFirePoints(FwWorld* world, FwVolumetricFireId id,
                                                 const FwFirePoint* points, uint32_t pointCount) {
    return onWorld("fwWorld_SetVolumetricFirePoints", world, [&](world::World& w) {
        edge::MetreArrays arrays(world->unit, &world->context->memory);
        w.flames().setPoints(id, arrays(points, pointCount, 32), pointCount);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_SetVolumetricFireHidden(FwWorld* world, FwVolumetricFireId id,
                                                 uint32_t hidden) {
    return onWorld("fwWorld_SetVolumetricFireHidden", world, [&](world::World& w) {
        w.flames().setHidden(id, hidden != 0);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_SetVolumetricFireTier(FwWorld* world, FwVolumetricFireId id,
                                               uint32_t tier) {
    return onWorld("fwWorld_SetVolumetricFireTier", world, [&](world::World& w) {
        w.flames().setTier(id, tier);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_GetVolumetricFireState(FwWorld* world, FwVolumetricFireId id,
                                                FwVolumetricFireState* state) {
    return fill("fwWorld_GetVolumetricFireState", world, state, "FwVolumetricFireState",
                &world::FlameSystem::fillState, id);
}

FwResult FW_CALL fwWorld_SetVolumetricFireTrack(FwWorld* world, FwVolumetricFireId id,
                                                const FwFireTrackDef* given) {
    return onWorld("fwWorld_SetVolumetricFireTrack", world, [&](world::World& w) {
        if (given) {
            const InMetres def(*world, given, FW_DEF_FIRE_TRACK, "FwFireTrackDef");
            w.flames().setTrack(id, &static_cast<const FwFireTrackDef&>(def));
        } else {
            w.flames().setTrack(id, nullptr);
        }
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_CreateFireEmitter(FwWorld* world, const FwFireEmitterDef* given,
                                           FwFireEmitterId* id) {
    return createOf("fwWorld_CreateFireEmitter", world, &world::EmitterSystem::create, given,
                    FW_DEF_FIRE_EMITTER, "FwFireEmitterDef", id);
}

FwResult FW_CALL fwWorld_DestroyFireEmitter(FwWorld* world, FwFireEmitterId id) {
    return destroyOf("fwWorld_DestroyFireEmitter", world, &world::EmitterSystem::destroy, id);
}

FwResult FW_CALL fwWorld_MoveFireEmitter(FwWorld* world, FwFireEmitterId id,
                                         const float position[3], const float* direction) {
    return onWorld("fwWorld_MoveFireEmitter", world, [&](world::World& w) {
        checkPointer(position, "position");
        w.emitters().move(id, Metres(world->unit, position), direction);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_SetFireEmitterPower(FwWorld* world, FwFireEmitterId id, float power) {
    return onWorld("fwWorld_SetFireEmitterPower", world, [&](world::World& w) {
        w.emitters().setPower(id, power);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_SetFireEmitterHidden(FwWorld* world, FwFireEmitterId id, uint32_t hidden) {
    return onWorld("fwWorld_SetFireEmitterHidden", world, [&](world::World& w) {
        w.emitters().setHidden(id, hidden != 0);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_GetFireEmitterState(FwWorld* world, FwFireEmitterId id,
                                             FwFireEmitterState* state) {
    return fill("fwWorld_GetFireEmitterState", world, state, "FwFireEmitterState",
                &world::EmitterSystem::fillState, id);
}

FwResult FW_CALL fwWorld_CreateFireProfile(FwWorld* world, const FwFireProfileDef* given,
                                           FwFireProfileId* id) {
    return createOf("fwWorld_CreateFireProfile", world, &world::FlameSystem::createProfile, given,
                    FW_DEF_FIRE_PROFILE, "FwFireProfileDef", id);
}

FwResult FW_CALL fwWorld_DestroyFireProfile(FwWorld* world, FwFireProfileId id) {
    return destroyOf("fwWorld_DestroyFireProfile", world, &world::FlameSystem::destroyProfile, id);
}

FwResult FW_CALL fwWorld_CreateFlipbook(FwWorld* world, const FwFlipbookDef* given,
                                        FwFlipbookId* id) {
    return createOf("fwWorld_CreateFlipbook", world, &world::FlameSystem::createFlipbook, given,
                    FW_DEF_FLIPBOOK, "FwFlipbookDef", id);
}

FwResult FW_CALL fwWorld_DestroyFlipbook(FwWorld* world, FwFlipbookId id) {
    return destroyOf("fwWorld_DestroyFlipbook", world, &world::FlameSystem::destroyFlipbook, id);
}

FwResult FW_CALL fwWorld_SetFlameFlipbooks(FwWorld* world, FwFlipbookId fire, FwFlipbookId smoke) {
    return onWorld("fwWorld_SetFlameFlipbooks", world, [&](world::World& w) {
        w.flames().setFlipbooks(fire, smoke);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_AddFireCollider(FwWorld* world, const FwFireColliderDef* given,
                                         FwFireColliderId* id) {
    return onWorld("fwWorld_AddFireCollider", world, [&](world::World& w) {
        checkPointer(id, "id");
        *id = {};
        const InMetres def(*world, given, FW_DEF_FIRE_COLLIDER, "FwFireColliderDef");
        *id = w.flames().addCollider(def, float(world->unit.perMetre()));
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_SetFireCollider(FwWorld* world, FwFireColliderId id,
                                         const FwFireColliderDef* given) {
    return onWorld("fwWorld_SetFireCollider", world, [&](world::World& w) {
        const InMetres def(*world, given, FW_DEF_FIRE_COLLIDER, "FwFireColliderDef");
        w.flames().setCollider(id, def, float(world->unit.perMetre()));
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_RemoveFireCollider(FwWorld* world, FwFireColliderId id) {
    return destroyOf("fwWorld_RemoveFireCollider", world, &world::FlameSystem::removeCollider, id);
}

FwResult FW_CALL fwWorld_SampleVolumetricFires(FwWorld* world, const float point[3],
                                               FwFireSample* sample) {
    return onWorld("fwWorld_SampleVolumetricFires", world, [&](world::World& w) {
        checkPointer(point, "point");
        const uint32_t size = edge::checkInfo(sample, "FwFireSample");
        FwFireSample filled{};
        w.flames().ask(Metres(world->unit, point), filled);
        edge::fromMetres(world->unit, filled);
        edge::writeInfo(sample, size, filled);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_GetVolumetricFireForce(FwWorld* world, const float centre[3], float radius,
                                                FwFireForce* force) {
    return onWorld("fwWorld_GetVolumetricFireForce", world, [&](world::World& w) {
        checkPointer(centre, "centre");
        const uint32_t size = edge::checkInfo(force, "FwFireForce");
        FwFireForce filled{};
        const edge::Scale metres(world->unit);
        metres(radius);
        w.flames().push(Metres(world->unit, centre), radius, filled);
        edge::writeInfo(force, size, filled);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_CreateParticleField(FwWorld* world, const FwParticleFieldDef* given,
                                             FwParticleFieldId* id) {
    return createOf("fwWorld_CreateParticleField", world, &world::FieldSystem::create, given,
                    FW_DEF_PARTICLE_FIELD, "FwParticleFieldDef", id);
}

FwResult FW_CALL fwWorld_DestroyParticleField(FwWorld* world, FwParticleFieldId id) {
    return destroyOf("fwWorld_DestroyParticleField", world, &world::FieldSystem::destroy, id);
}

FwResult FW_CALL fwWorld_MoveParticleField(FwWorld* world, FwParticleFieldId id,
                                           const float position[3], const float rotation[4]) {
    return onWorld("fwWorld_MoveParticleField", world, [&](world::World& w) {
        checkPointer(position, "position");
        w.fields().move(id, Metres(world->unit, position), rotation);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_SetParticleFieldAmount(FwWorld* world, FwParticleFieldId id,
                                                float amount) {
    return onWorld("fwWorld_SetParticleFieldAmount", world, [&](world::World& w) {
        w.fields().setAmount(id, amount);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_SetParticleFieldHidden(FwWorld* world, FwParticleFieldId id,
                                                uint32_t hidden) {
    return onWorld("fwWorld_SetParticleFieldHidden", world, [&](world::World& w) {
        w.fields().setHidden(id, hidden != 0);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_PaintParticleField(FwWorld* world, FwParticleFieldId id,
                                            const uint8_t* paint, const uint8_t* walls) {
    return onWorld("fwWorld_PaintParticleField", world, [&](world::World& w) {
        w.fields().paint(id, paint, walls);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_GetParticleFieldState(FwWorld* world, FwParticleFieldId id,
                                               FwParticleFieldState* state) {
    return fill("fwWorld_GetParticleFieldState", world, state, "FwParticleFieldState",
                &world::FieldSystem::fillState, id);
}

FwResult FW_CALL fwWorld_Ignite(FwWorld* world, const FwIgnitionDef* given, uint32_t* texels) {
    return onWorld("fwWorld_Ignite", world, [&](world::World& w) {
        const FwIgnitionDef def =
            edge::readDef(world->unit, given, FW_DEF_IGNITION, "FwIgnitionDef");
        bool acts = false;
        const uint32_t count = w.burn().ignite(def, &acts);
        if (texels) *texels = count;
        if (acts) return FW_OK;
        // Water that meets nothing is a jet's ordinary day; a match that lights nothing is a
        // surprise.
        if (def.kind == FW_IGNITE) {
            char reason[sizeof FwErrorInfo::message];
            w.burn().explainMiss(def, count, reason);
            char text[sizeof FwErrorInfo::message];
            edge::composeMessage(text, reason, "fwWorld_Ignite", world->unit);
            world->message.set(text);
            world->context->log.write(FW_LOG_INFO, "%s", text);
        }
        return FW_NOTHING_THERE;
    });
}

// ---- running ----------------------------------------------------------------------------------

FwResult FW_CALL fwWorld_Step(FwWorld* world, float deltaTime) {
    return onWorld("fwWorld_Step", world, [&](world::World& w) {
        world->newestFrame = w.lastFrame() + 1;
        edge::destroyDoomed(*world);
        world->context->device->step(*world->backend, w, deltaTime);
        edge::publish(*world);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_RenderOffscreen(FwWorld* world, const FwOffscreenDef* given) {
    return onWorld("fwWorld_RenderOffscreen", world, [&](world::World&) {
        FwOffscreenDef def = edge::readDef(given, FW_DEF_OFFSCREEN, "FwOffscreenDef");
        def.view = edge::readDef(&def.view, FW_DEF_VIEW, "FwOffscreenDef::view");
        if (def.width < 1 || def.width > 8192 || def.height < 1 || def.height > 8192)
            core::fail(FW_ERROR_INVALID_ARGUMENT,
                       "FwOffscreenDef is %u x %u pixels; the limits are [1, 8192].", def.width,
                       def.height);
        checkPointer(def.pixels, "FwOffscreenDef::pixels");
        components::checkValues(def.background, 4, "FwOffscreenDef::background", 0.0f, 1e6f);
        edge::validatedView(world->unit, def.view, "FwOffscreenDef::view");
        if (world->world->shifted())
            world->context->device->step(*world->backend, *world->world, 0.0f);
        world->context->device->renderOffscreen(*world->backend, def);
        return FW_OK;
    });
}

// ---- what a game asks -------------------------------------------------------------------------

uint32_t FW_CALL fwWorld_PollEvents(FwWorld* world, FwEvent* events, uint32_t capacity) {
    uint32_t count = 0;
    (void)onWorld("fwWorld_PollEvents", world, [&](world::World& w) {
        if (capacity > 0) checkPointer(events, "events");
        count = w.queries().pollEvents({events, capacity});
        for (uint32_t i = 0; i < count; ++i) edge::fromMetres(world->unit, events[i]);
        return FW_OK;
    });
    return count;
}

FwResult FW_CALL fwWorld_TagPoint(FwWorld* world, FwBurnableMeshId id, const float position[3],
                                  uint32_t tag) {
    return onWorld("fwWorld_TagPoint", world, [&](world::World& w) {
        checkPointer(position, "position");
        w.queries().tagPoint(id, Metres(world->unit, position), tag);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_GetObjectState(FwWorld* world, FwBurnableMeshId id, FwObjectState* state) {
    return fill("fwWorld_GetObjectState", world, state, "FwObjectState",
                &world::QuerySystem::objectState, id);
}

FwResult FW_CALL fwWorld_RequestPoint(FwWorld* world, FwBurnableMeshId id, const float position[3],
                                      FwQueryId* query) {
    return ask("fwWorld_RequestPoint", world, &world::QuerySystem::requestPoint, id, position,
               query);
}

FwResult FW_CALL fwWorld_FetchPoint(FwWorld* world, FwQueryId query, FwPointState* state) {
    return answer("fwWorld_FetchPoint", world, &world::QuerySystem::fetchPoint, query, state,
                  "FwPointState");
}

FwResult FW_CALL fwWorld_RequestArrival(FwWorld* world, FwBurnableMeshId id,
                                        const float position[3], FwQueryId* query) {
    return ask("fwWorld_RequestArrival", world, &world::QuerySystem::requestArrival, id, position,
               query);
}

FwResult FW_CALL fwWorld_TransferBurn(FwWorld* world, FwBurnableMeshId from, FwBurnableMeshId to) {
    return onWorld("fwWorld_TransferBurn", world, [&](world::World& w) {
        w.burn().transferBurn(from, to);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_ShiftOrigin(FwWorld* world, const float* offset, float* applied) {
    return onWorld("fwWorld_ShiftOrigin", world, [&](world::World& w) {
        checkPointer(offset, "offset");
        w.shiftOrigin(Metres(world->unit, offset), applied);
        if (applied) edge::fromMetres3(world->unit, applied);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_GetOrigin(FwWorld* world, double* origin) {
    return onWorld("fwWorld_GetOrigin", world, [&](world::World& w) {
        checkPointer(origin, "origin");
        w.origin(origin);
        edge::fromMetres3(world->unit, origin);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_CancelQuery(FwWorld* world, FwQueryId query) {
    return destroyOf("fwWorld_CancelQuery", world, &world::QuerySystem::cancel, query);
}

FwResult FW_CALL fwWorld_CancelSave(FwWorld* world) {
    return onWorld("fwWorld_CancelSave", world, [&](world::World& w) {
        w.persistence().cancelSave();
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_CancelBurn(FwWorld* world, FwBurnableMeshId id) {
    return destroyOf("fwWorld_CancelBurn", world, &world::QuerySystem::cancelBurnMap, id);
}

FwResult FW_CALL fwWorld_UntagPoint(FwWorld* world, FwBurnableMeshId id, uint32_t tag) {
    return onWorld("fwWorld_UntagPoint", world, [&](world::World& w) {
        w.queries().untagPoint(id, tag);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_FetchArrival(FwWorld* world, FwQueryId query, FwArrivalState* state) {
    return answer("fwWorld_FetchArrival", world, &world::QuerySystem::fetchArrival, query, state,
                  "FwArrivalState");
}

uint32_t FW_CALL fwWorld_GetLights(FwWorld* world, FwLight* lights, uint32_t capacity) {
    uint32_t count = 0;
    (void)onWorld("fwWorld_GetLights", world, [&](world::World& w) {
        if (capacity > 0) checkPointer(lights, "lights");
        count = w.lights().gather({lights, capacity});
        for (uint32_t i = 0; i < count; ++i) edge::fromMetres(world->unit, lights[i]);
        return FW_OK;
    });
    return count;
}

FwResult FW_CALL fwWorld_SampleSurroundings(FwWorld* world, const float point[3],
                                            FwSurroundings* surroundings) {
    return onWorld("fwWorld_SampleSurroundings", world, [&](world::World& w) {
        checkPointer(point, "point");
        const uint32_t size = edge::checkInfo(surroundings, "FwSurroundings");
        FwSurroundings filled{};
        w.queries().querySurroundings(Metres(world->unit, point), filled);
        edge::fromMetres(world->unit, filled);
        edge::writeInfo(surroundings, size, filled);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_SampleVisibility(FwWorld* world, const float from[3], const float to[3],
                                          float* seen) {
    return onWorld("fwWorld_SampleVisibility", world, [&](world::World& w) {
        checkPointer(from, "from");
        checkPointer(to, "to");
        checkPointer(seen, "seen");
        *seen = w.queries().querySight(Metres(world->unit, from), Metres(world->unit, to));
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_MakeSafetyMask(FwWorld* world, const float corner[3],
                                        const float columnStep[3], const float rowStep[3],
                                        uint32_t columns, uint32_t rows, uint8_t* mask) {
    return onWorld("fwWorld_MakeSafetyMask", world, [&](world::World& w) {
        checkPointer(corner, "corner");
        checkPointer(columnStep, "columnStep");
        checkPointer(rowStep, "rowStep");
        checkPointer(mask, "mask");
        w.queries().makeSafetyMask(Metres(world->unit, corner), Metres(world->unit, columnStep),
                                   Metres(world->unit, rowStep), columns, rows, mask);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_GetStats(FwWorld* world, FwWorldStats* stats) {
    return fill("fwWorld_GetStats", world, stats, "FwWorldStats", &world::World::stats);
}

FwResult FW_CALL fwWorld_GetEnergyLedger(FwWorld* world, FwEnergyLedger* ledger) {
    return fill("fwWorld_GetEnergyLedger", world, ledger, "FwEnergyLedger",
                &world::QuerySystem::energyLedger);
}

FwResult FW_CALL fwWorld_SetBudget(FwWorld* world, const FwBudgetDef* def) {
    return onWorld("fwWorld_SetBudget", world, [&](world::World& w) {
        w.budget().set(edge::readDef(def, FW_DEF_BUDGET, "FwBudgetDef"));
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_GetBudgetState(FwWorld* world, FwBudgetState* state) {
    return fill("fwWorld_GetBudgetState", world, state, "FwBudgetState",
                &world::BudgetSystem::fillState);
}

FwResult FW_CALL fwWorld_RequestSave(FwWorld* world) {
    return onWorld("fwWorld_RequestSave", world, [&](world::World& w) {
        w.persistence().requestSave();
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_FetchSave(FwWorld* world, void* buffer, uint64_t* size) {
    return onWorld("fwWorld_FetchSave", world, [&](world::World& w) {
        checkPointer(size, "size");
        const std::pmr::vector<std::byte>* bytes = w.persistence().fetchSave();
        if (!bytes) return FW_NOT_READY;
        giveBytes(*bytes, "save", buffer, *size);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_Load(FwWorld* world, const void* bytes, uint64_t size) {
    return onWorld("fwWorld_Load", world, [&](world::World& w) {
        checkPointer(bytes, "bytes");
        w.persistence().load({static_cast<const std::byte*>(bytes), size_t(size)});
        edge::publish(*world);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_RequestBurn(FwWorld* world, FwBurnableMeshId id) {
    return onWorld("fwWorld_RequestBurn", world, [&](world::World& w) {
        w.queries().requestBurnMap(id);
        answerAtOnce(world);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_FetchBurn(FwWorld* world, FwBurnableMeshId id, void* buffer,
                                   uint64_t* size) {
    return onWorld("fwWorld_FetchBurn", world, [&](world::World& w) {
        checkPointer(size, "size");
        const std::pmr::vector<std::byte>* bytes = w.burn().fetchBurn(id);
        if (!bytes) return FW_NOT_READY;
        giveBytes(*bytes, "baked burn", buffer, *size);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_CreateBurn(FwWorld* world, const void* bytes, uint64_t size,
                                    FwBurnId* id) {
    return onWorld("fwWorld_CreateBurn", world, [&](world::World& w) {
        checkPointer(id, "id");
        *id = {};
        checkPointer(bytes, "bytes");
        *id = w.burn().createBurn({static_cast<const std::byte*>(bytes), size_t(size)});
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_DestroyBurn(FwWorld* world, FwBurnId id) {
    return destroyOf("fwWorld_DestroyBurn", world, &world::BurnSystem::destroyBurn, id);
}

FwResult FW_CALL fwWorld_PlayBurn(FwWorld* world, FwBurnableMeshId id, FwBurnId burn, float delay,
                                  float speed) {
    return onWorld("fwWorld_PlayBurn", world, [&](world::World& w) {
        w.burn().playBurn(id, burn, delay, speed);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_StopBurn(FwWorld* world, FwBurnableMeshId id) {
    return onWorld("fwWorld_StopBurn", world, [&](world::World& w) {
        w.burn().stopBurn(id);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_StartCommandLog(FwWorld* world) {
    return onWorld("fwWorld_StartCommandLog", world, [&](world::World& w) {
        w.persistence().startLog();
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_StopCommandLog(FwWorld* world) {
    return onWorld("fwWorld_StopCommandLog", world, [&](world::World& w) {
        w.persistence().stopLog();
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_FetchCommandLog(FwWorld* world, void* buffer, uint64_t* size) {
    return onWorld("fwWorld_FetchCommandLog", world, [&](world::World& w) {
        checkPointer(size, "size");
        giveBytes(w.persistence().fetchLog(), "log", buffer, *size);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_OpenCommandLog(FwWorld* world, const void* bytes, uint64_t size) {
    return onWorld("fwWorld_OpenCommandLog", world, [&](world::World& w) {
        if (size > 0) checkPointer(bytes, "bytes");
        w.persistence().openLog({static_cast<const std::byte*>(bytes), size_t(size)});
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_PlayCommandLog(FwWorld* world, uint64_t untilTick, float* seconds) {
    return onWorld("fwWorld_PlayCommandLog", world, [&](world::World& w) {
        checkPointer(seconds, "seconds");
        *seconds = w.persistence().playLog(untilTick);
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_StartTimeline(FwWorld* world, const FwTimelineDef* given) {
    return onWorld("fwWorld_StartTimeline", world, [&](world::World& w) {
        w.persistence().startTimeline(edge::readDef(given, FW_DEF_TIMELINE, "FwTimelineDef"));
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_StopTimeline(FwWorld* world) {
    return onWorld("fwWorld_StopTimeline", world, [&](world::World& w) {
        w.persistence().stopTimeline();
        return FW_OK;
    });
}

FwResult FW_CALL fwWorld_Seek(FwWorld* world, uint64_t untilTick, float* seconds) {
    return onWorld("fwWorld_Seek", world, [&](world::World& w) {
        checkPointer(seconds, "seconds");
        return w.persistence().seek(untilTick, *seconds) ? FW_OK : FW_NOT_READY;
    });
}

FwResult FW_CALL fwWorld_GetTimelineState(FwWorld* world, FwTimelineState* state) {
    return fill("fwWorld_GetTimelineState", world, state, "FwTimelineState",
                &world::PersistenceSystem::timelineState);
}

}  // extern "C"
