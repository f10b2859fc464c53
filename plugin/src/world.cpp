// fwCreateWorld and everything that takes a world but no Vulkan.
#include "calls.h"

#include <algorithm>

using namespace fw;
using edge::answerAtOnce;
using edge::call;
using edge::callFor;
using edge::checkPointer;
using edge::create;
using edge::fetch;
using edge::fill;
using edge::InMetres;
using edge::list;
using edge::onContext;
using edge::onWorld;
using edge::Place;

namespace {

FwResult ask(const char* function, FwWorld* world,
             FwQueryId (world::QuerySystem::*request)(FwBurnableMeshId, const float*),
             FwBurnableMeshId id, const float* position, FwQueryId* query) {
    return onWorld(function, world, [&](world::World& w) {
        checkPointer(query, "query");
        *query = {};
        const FwQueryId made = edge::invoke(*world, request, id, Place{position, "position"});
        try {
            answerAtOnce(world);
        } catch (...) {
            w.queries().cancel(made);
            throw;
        }
        *query = made;
    });
}

void freeWorld(FwWorld* world) noexcept {
    FwContext* context = world->context;
    world->server.reset();
    world->client.reset();
    world->world.reset();
    if (world->backend) context->device->destroyBackend(world->backend);
    std::pmr::polymorphic_allocator<>(&context->memory).delete_object(world);
}

}  // namespace

extern "C" {

FwResult FW_CALL fwCreateWorld(FwContext* context, const FwWorldDef* given, FwWorld** out) {
    if (out) *out = nullptr;
    edge::Unit unit;
    const auto make = [&](FwContext& c) {
        checkPointer(out, "world");
        FwWorldDef def = edge::readDef(given);
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
    };
    return onContext(__func__, context, make, unit);
}

FwResult FW_CALL fwWorld_ConvertDef(FwWorld* world, uint32_t defType, void* def) {
    return onWorld(__func__, world, [&](world::World&) {
        checkPointer(def, "def");
        const edge::DefRow* row = edge::findDef(defType);
        if (!row) core::refuse("defType is %u, which is no FwDefType.", defType);
        if (row->fromMetres) row->fromMetres(world->unit, def);
    });
}

void FW_CALL fwDestroyWorld(FwWorld* world) {
    if (!world) return;
    FwContext* context = world->context;
    {
        const std::lock_guard lock(context->mutex);
        std::erase(context->worlds, world);
        std::erase_if(context->deferred, [&](const auto& one) { return one.world == world; });
    }
    freeWorld(world);
}

size_t FW_CALL fwWorld_GetLastMessage(FwWorld* world, char* text, size_t capacity) {
    return world ? world->message.copy(text, capacity) : 0;
}

FwResult FW_CALL fwWorld_SetWind(FwWorld* world, const float wind[3]) {
    return call(__func__, world, &world::WindSystem::set, Place{wind, "wind"});
}

FwResult FW_CALL fwWorld_SetFlags(FwWorld* world, uint32_t flags) {
    return call(__func__, world, &world::ExchangeSystem::setFlags, flags);
}

FwResult FW_CALL fwWorld_MoveHeatOccluder(FwWorld* world, FwHeatOccluderId id,
                                          const float transform[16]) {
    return onWorld(__func__, world, [&](world::World& w) {
        checkPointer(transform, "transform");
        const edge::TransformInMetres pose(world->unit, world->unit, transform);
        w.exchange().moveHeatOccluder(id, pose.matrix);
    });
}

FwResult FW_CALL fwWorld_SetHeatOcclusion(FwWorld* world, const FwHeatOcclusionDef* given) {
    return onWorld(__func__, world, [&](world::World& w) {
        if (given)
            w.exchange().setHeatOcclusion(InMetres(*world, given), float(world->unit.perMetre()));
        else
            w.exchange().setHeatOcclusion({});
    });
}

FwResult FW_CALL fwWorld_SetWindZone(FwWorld* world, FwWindZoneId id, const FwWindZoneDef* given) {
    return onWorld(__func__, world,
                   [&](world::World& w) { w.wind().setZone(id, InMetres(*world, given)); });
}

FwResult FW_CALL fwWorld_SetWindGrid(FwWorld* world, const FwWindGridDef* given) {
    return onWorld(__func__, world, [&](world::World& w) {
        if (given)
            w.wind().setGrid(InMetres(*world, given));
        else
            w.wind().setGrid({});
    });
}

FwResult FW_CALL fwWorld_SetGusts(FwWorld* world, const FwGustDef* given) {
    return call(__func__, world, &world::WindSystem::setGusts, given);
}

FwResult FW_CALL fwWorld_GetWindAt(FwWorld* world, const float point[3], float wind[3]) {
    return onWorld(__func__, world, [&](world::World& w) {
        checkPointer(point, "point");
        checkPointer(wind, "wind");
        w.wind().atPoint(edge::Metres(world->unit, point), wind);
        edge::fromMetres3(world->unit, wind);
    });
}

FwResult FW_CALL fwWorld_SetRoom(FwWorld* world, FwRoomId id, const FwRoomDef* given) {
    return onWorld(__func__, world,
                   [&](world::World& w) { w.rooms().set(id, InMetres(*world, given)); });
}

FwResult FW_CALL fwWorld_GetRoomState(FwWorld* world, FwRoomId id, FwRoomState* state) {
    return fill(__func__, world, state, &world::RoomSystem::fillState, id);
}

// ---- calls that kinds of objects have in common ---------------------------------------------

#define FW_KIND(KIND, Name, System, destroyFunction, destroy)                     \
    FwResult FW_CALL fwWorld_##destroyFunction(FwWorld* world, Fw##Name##Id id) { \
        return call(__func__, world, &world::System::destroy, id);                \
    }
#define FW_KIND_OF_DEF(KIND, Name, System, createFunction, make, destroyFunction, destroy) \
    FwResult FW_CALL fwWorld_##createFunction(FwWorld* world, const Fw##Name##Def* given,  \
                                              Fw##Name##Id* id) {                          \
        return create(__func__, world, id, &world::System::make, given);                   \
    }                                                                                      \
    FW_KIND(KIND, Name, System, destroyFunction, destroy)
#include "kinds.inl"

#define FW_SHOWN(Name, System)                                                                     \
    FwResult FW_CALL fwWorld_Set##Name##Hidden(FwWorld* world, Fw##Name##Id id, uint32_t hidden) { \
        return call(__func__, world, &world::System::setHidden, id, hidden != 0);                  \
    }                                                                                              \
    FwResult FW_CALL fwWorld_Get##Name##State(FwWorld* world, Fw##Name##Id id,                     \
                                              Fw##Name##State* state) {                            \
        return fill(__func__, world, state, &world::System::fillState, id);                        \
    }
FW_SHOWN(VolumetricFire, FlameSystem)
FW_SHOWN(FireEmitter, EmitterSystem)
FW_SHOWN(ParticleField, FieldSystem)
#undef FW_SHOWN

// ---- meshes ----------------------------------------------------------------

FwResult FW_CALL fwWorld_CreateMesh(FwWorld* world, const FwMeshDef* given, FwMeshId* id) {
    if (!world) return FW_ERROR_INVALID_ARGUMENT;
    edge::Unit unit = world->unit;
    const auto make = [&](world::World& w) {
        checkPointer(id, "id");
        *id = {};
        unit = edge::checkedUnit(edge::readDef(given).metersPerUnit, "FwMeshDef::metersPerUnit",
                                 world->unit);
        const FwMeshId made = w.scene().createMesh(InMetres(*world, given, unit));
        try {
            edge::setUnit(*world, world->meshUnits, made.index1, unit);
        } catch (...) {
            w.scene().destroyMesh(made);
            throw;
        }
        *id = made;
    };
    return onWorld(__func__, world, make, &unit);
}

FwResult FW_CALL fwWorld_GetMeshInfo(FwWorld* world, FwMeshId id, FwMeshInfo* info) {
    return onWorld(__func__, world, [&](world::World& w) {
        const uint32_t size = edge::checkInfo(info);
        FwMeshInfo filled{};
        w.scene().meshInfo(id, filled);
        edge::fromMetres(edge::meshUnit(*world, id), filled);
        edge::writeInfo(info, size, filled);
    });
}

// ---- burnable meshes --------------------------------------------------------------------------

FwResult FW_CALL fwWorld_CreateBurnableMesh(FwWorld* world, const FwBurnableMeshDef* given,
                                            FwBurnableMeshId* id) {
    return onWorld(__func__, world, [&](world::World& w) {
        checkPointer(id, "id");
        *id = {};
        const edge::Unit unit = edge::meshUnit(*world, edge::readDef(given).mesh);
        InMetres def(*world, given, unit);
        edge::scaleAxes(unit, world->unit, def->transform);
        const FwBurnableMeshId made = w.createBurnableMesh(def);
        try {
            edge::setUnit(*world, world->objectUnits, made.index1, unit);
        } catch (...) {
            w.destroyBurnableMesh(made);
            throw;
        }
        *id = made;
    });
}

FwResult FW_CALL fwWorld_SetTransform(FwWorld* world, FwBurnableMeshId id,
                                      const float transform[16]) {
    return onWorld(__func__, world, [&](world::World& w) {
        checkPointer(transform, "transform");
        const edge::TransformInMetres pose(edge::objectUnit(*world, id), world->unit, transform);
        w.setTransform(id, pose.matrix);
    });
}

FwResult FW_CALL fwWorld_SetVertexPositions(FwWorld* world, FwBurnableMeshId id,
                                            const float* positions, const float* normals,
                                            uint32_t vertexCount) {
    return onWorld(__func__, world, [&](world::World& w) {
        checkPointer(positions, "positions");
        (void)w.scene().skinnedSlot(id, vertexCount);
        edge::MetreArrays arrays(edge::objectUnit(*world, id), &world->context->memory);
        const uint64_t count = uint64_t(vertexCount) * 3;
        w.setVertexPositions(id, arrays(positions, count, count), normals, vertexCount);
    });
}

FwResult FW_CALL fwWorld_SetHidden(FwWorld* world, FwBurnableMeshId id, uint32_t hidden) {
    return call(__func__, world, &world::Scene::setHidden, id, hidden != 0);
}

// ---- volumetric fires -------------------------------------------------------------------------

FwResult FW_CALL fwWorld_MoveVolumetricFire(FwWorld* world, FwVolumetricFireId id,
                                            const float position[3]) {
    return call(__func__, world, &world::FlameSystem::move, id, Place{position, "position"});
}

FwResult FW_CALL fwWorld_SetVolumetricFirePower(FwWorld* world, FwVolumetricFireId id,
                                                float power) {
    return call(__func__, world, &world::FlameSystem::setPower, id, power);
}

FwResult FW_CALL fwWorld_SetVolumetricFirePoints(FwWorld* world, FwVolumetricFireId id,
                                                 const FwFirePoint* points, uint32_t pointCount) {
    return onWorld(__func__, world, [&](world::World& w) {
        edge::MetreArrays arrays(world->unit, &world->context->memory);
        w.flames().setPoints(id, arrays(points, pointCount, 32), pointCount);
    });
}

FwResult FW_CALL fwWorld_SetVolumetricFireTier(FwWorld* world, FwVolumetricFireId id,
                                               uint32_t tier) {
    return call(__func__, world, &world::FlameSystem::setTier, id, tier);
}

FwResult FW_CALL fwWorld_SetVolumetricFireTrack(FwWorld* world, FwVolumetricFireId id,
                                                const FwFireTrackDef* given) {
    return onWorld(__func__, world, [&](world::World& w) {
        if (given) {
            const InMetres def(*world, given);
            w.flames().setTrack(id, &static_cast<const FwFireTrackDef&>(def));
        } else {
            w.flames().setTrack(id, nullptr);
        }
    });
}

FwResult FW_CALL fwWorld_MoveFireEmitter(FwWorld* world, FwFireEmitterId id,
                                         const float position[3], const float* direction) {
    return call(__func__, world, &world::EmitterSystem::move, id, Place{position, "position"},
                direction);
}

FwResult FW_CALL fwWorld_SetFireEmitterPower(FwWorld* world, FwFireEmitterId id, float power) {
    return call(__func__, world, &world::EmitterSystem::setPower, id, power);
}

FwResult FW_CALL fwWorld_SetFlameFlipbooks(FwWorld* world, FwFlipbookId fire, FwFlipbookId smoke) {
    return call(__func__, world, &world::FlameSystem::setFlipbooks, fire, smoke);
}

FwResult FW_CALL fwWorld_AddFireCollider(FwWorld* world, const FwFireColliderDef* given,
                                         FwFireColliderId* id) {
    return create(__func__, world, id, &world::FlameSystem::addCollider, given,
                  edge::UnitsPerMetre{});
}

FwResult FW_CALL fwWorld_SetFireCollider(FwWorld* world, FwFireColliderId id,
                                         const FwFireColliderDef* given) {
    return call(__func__, world, &world::FlameSystem::setCollider, id, given,
                edge::UnitsPerMetre{});
}

FwResult FW_CALL fwWorld_SampleVolumetricFires(FwWorld* world, const float point[3],
                                               FwFireSample* sample) {
    return fill(__func__, world, sample, &world::FlameSystem::ask, Place{point, "point"});
}

FwResult FW_CALL fwWorld_GetVolumetricFireForce(FwWorld* world, const float centre[3], float radius,
                                                FwFireForce* force) {
    return fill(__func__, world, force, &world::FlameSystem::push, Place{centre, "centre"},
                edge::Length{radius});
}

FwResult FW_CALL fwWorld_MoveParticleField(FwWorld* world, FwParticleFieldId id,
                                           const float position[3], const float rotation[4]) {
    return call(__func__, world, &world::FieldSystem::move, id, Place{position, "position"},
                rotation);
}

FwResult FW_CALL fwWorld_SetParticleFieldAmount(FwWorld* world, FwParticleFieldId id,
                                                float amount) {
    return call(__func__, world, &world::FieldSystem::setAmount, id, amount);
}

FwResult FW_CALL fwWorld_PaintParticleField(FwWorld* world, FwParticleFieldId id,
                                            const uint8_t* paint, const uint8_t* walls) {
    return call(__func__, world, &world::FieldSystem::paint, id, paint, walls);
}

FwResult FW_CALL fwWorld_Ignite(FwWorld* world, const FwIgnitionDef* given, uint32_t* texels) {
    return onWorld(__func__, world, [&](world::World& w) {
        const FwIgnitionDef def = edge::readDef(given, world->unit);
        bool acts = false;
        const uint32_t count = w.burn().ignite(def, &acts);
        w.emitters().wetPatches(w.burn().splashes(), true);  // fuel that sticks to objects
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
    return onWorld(__func__, world, [&](world::World& w) {
        world->newestFrame = w.lastFrame() + 1;
        edge::destroyDoomed(*world);
        world->context->device->step(*world->backend, w, deltaTime);
        edge::publish(*world);
    });
}

FwResult FW_CALL fwWorld_RenderOffscreen(FwWorld* world, const FwOffscreenDef* given) {
    return onWorld(__func__, world, [&](world::World&) {
        FwOffscreenDef def = edge::readDef(given);
        def.view = edge::readDef(&def.view, {}, "FwOffscreenDef::view");
        if (def.width < 1 || def.width > 8192 || def.height < 1 || def.height > 8192)
            core::refuse("FwOffscreenDef is %u x %u pixels; the limits are [1, 8192].", def.width,
                         def.height);
        checkPointer(def.pixels, "FwOffscreenDef::pixels");
        components::checkValues(def.background, 4, "FwOffscreenDef::background", 0.0f, 1e6f);
        edge::validatedView(world->unit, def.view, "FwOffscreenDef::view");
        if (world->world->shifted())
            world->context->device->step(*world->backend, *world->world, 0.0f);
        world->context->device->renderOffscreen(*world->backend, def);
    });
}

// ---- what a game asks -------------------------------------------------------------------------

uint32_t FW_CALL fwWorld_PollEvents(FwWorld* world, FwEvent* events, uint32_t capacity) {
    return list(__func__, world, events, capacity, "events", &world::QuerySystem::pollEvents);
}

FwResult FW_CALL fwWorld_TagPoint(FwWorld* world, FwBurnableMeshId id, const float position[3],
                                  uint32_t tag) {
    return call(__func__, world, &world::QuerySystem::tagPoint, id, Place{position, "position"},
                tag);
}

FwResult FW_CALL fwWorld_GetObjectState(FwWorld* world, FwBurnableMeshId id, FwObjectState* state) {
    return fill(__func__, world, state, &world::QuerySystem::objectState, id);
}

FwResult FW_CALL fwWorld_RequestPoint(FwWorld* world, FwBurnableMeshId id, const float position[3],
                                      FwQueryId* query) {
    return ask(__func__, world, &world::QuerySystem::requestPoint, id, position, query);
}

FwResult FW_CALL fwWorld_FetchPoint(FwWorld* world, FwQueryId query, FwPointState* state) {
    return fill(__func__, world, state, &world::QuerySystem::fetchPoint, query);
}

FwResult FW_CALL fwWorld_RequestArrival(FwWorld* world, FwBurnableMeshId id,
                                        const float position[3], FwQueryId* query) {
    return ask(__func__, world, &world::QuerySystem::requestArrival, id, position, query);
}

FwResult FW_CALL fwWorld_TransferBurn(FwWorld* world, FwBurnableMeshId from, FwBurnableMeshId to) {
    return call(__func__, world, &world::BurnSystem::transferBurn, from, to);
}

FwResult FW_CALL fwWorld_ShiftOrigin(FwWorld* world, const float* offset, float* applied) {
    return onWorld(__func__, world, [&](world::World& w) {
        checkPointer(offset, "offset");
        w.shiftOrigin(edge::Metres(world->unit, offset), applied);
        if (applied) edge::fromMetres3(world->unit, applied);
    });
}

FwResult FW_CALL fwWorld_GetOrigin(FwWorld* world, double* origin) {
    return onWorld(__func__, world, [&](world::World& w) {
        checkPointer(origin, "origin");
        w.origin(origin);
        edge::fromMetres3(world->unit, origin);
    });
}

FwResult FW_CALL fwWorld_CancelQuery(FwWorld* world, FwQueryId query) {
    return call(__func__, world, &world::QuerySystem::cancel, query);
}

FwResult FW_CALL fwWorld_CancelSave(FwWorld* world) {
    return call(__func__, world, &world::PersistenceSystem::cancelSave);
}

FwResult FW_CALL fwWorld_CancelBurn(FwWorld* world, FwBurnableMeshId id) {
    return call(__func__, world, &world::QuerySystem::cancelBurnMap, id);
}

FwResult FW_CALL fwWorld_UntagPoint(FwWorld* world, FwBurnableMeshId id, uint32_t tag) {
    return call(__func__, world, &world::QuerySystem::untagPoint, id, tag);
}

FwResult FW_CALL fwWorld_FetchArrival(FwWorld* world, FwQueryId query, FwArrivalState* state) {
    return fill(__func__, world, state, &world::QuerySystem::fetchArrival, query);
}

uint32_t FW_CALL fwWorld_GetLights(FwWorld* world, FwLight* lights, uint32_t capacity) {
    return list(__func__, world, lights, capacity, "lights", &world::LightSystem::gather);
}

FwResult FW_CALL fwWorld_SampleSurroundings(FwWorld* world, const float point[3],
                                            FwSurroundings* surroundings) {
    return fill(__func__, world, surroundings, &world::QuerySystem::querySurroundings,
                Place{point, "point"});
}

FwResult FW_CALL fwWorld_SampleVisibility(FwWorld* world, const float from[3], const float to[3],
                                          float* seen) {
    return callFor(__func__, world, seen, "seen", &world::QuerySystem::querySight,
                   Place{from, "from"}, Place{to, "to"});
}

FwResult FW_CALL fwWorld_MakeSafetyMask(FwWorld* world, const float corner[3],
                                        const float columnStep[3], const float rowStep[3],
                                        uint32_t columns, uint32_t rows, uint8_t* mask) {
    return onWorld(__func__, world, [&](world::World&) {
        checkPointer(mask, "mask");
        edge::invoke(*world, &world::QuerySystem::makeSafetyMask, Place{corner, "corner"},
                     Place{columnStep, "columnStep"}, Place{rowStep, "rowStep"}, columns, rows,
                     mask);
    });
}

FwResult FW_CALL fwWorld_GetStats(FwWorld* world, FwWorldStats* stats) {
    return fill(__func__, world, stats, &world::World::stats);
}

FwResult FW_CALL fwWorld_GetEnergyLedger(FwWorld* world, FwEnergyLedger* ledger) {
    return fill(__func__, world, ledger, &world::QuerySystem::energyLedger);
}

FwResult FW_CALL fwWorld_SetBudget(FwWorld* world, const FwBudgetDef* def) {
    return call(__func__, world, &world::BudgetSystem::set, def);
}

FwResult FW_CALL fwWorld_GetBudgetState(FwWorld* world, FwBudgetState* state) {
    return fill(__func__, world, state, &world::BudgetSystem::fillState);
}

FwResult FW_CALL fwWorld_RequestSave(FwWorld* world) {
    return call(__func__, world, &world::PersistenceSystem::requestSave, world::SaveFor::host);
}

FwResult FW_CALL fwWorld_FetchSave(FwWorld* world, void* buffer, uint64_t* size) {
    return fetch(__func__, world, "save", buffer, size, &world::PersistenceSystem::fetchSave,
                 world::SaveFor::host);
}

FwResult FW_CALL fwWorld_Load(FwWorld* world, const void* bytes, uint64_t size) {
    return onWorld(__func__, world, [&](world::World& w) {
        checkPointer(bytes, "bytes");
        w.persistence().load({static_cast<const std::byte*>(bytes), size_t(size)});
        edge::publish(*world);
    });
}

FwResult FW_CALL fwWorld_RequestBurn(FwWorld* world, FwBurnableMeshId id) {
    return onWorld(__func__, world, [&](world::World& w) {
        w.queries().requestBurnMap(id);
        answerAtOnce(world);
    });
}

FwResult FW_CALL fwWorld_FetchBurn(FwWorld* world, FwBurnableMeshId id, void* buffer,
                                   uint64_t* size) {
    return fetch(__func__, world, "baked burn", buffer, size, &world::QuerySystem::fetchBurn, id);
}

FwResult FW_CALL fwWorld_CreateBurn(FwWorld* world, const void* bytes, uint64_t size,
                                    FwBurnId* id) {
    return create(__func__, world, id, &world::BurnSystem::createBurn, edge::Bytes{bytes, size});
}

FwResult FW_CALL fwWorld_PlayBurn(FwWorld* world, FwBurnableMeshId id, FwBurnId burn, float delay,
                                  float speed) {
    return call(__func__, world, &world::BurnSystem::playBurn, id, burn, delay, speed);
}

FwResult FW_CALL fwWorld_StopBurn(FwWorld* world, FwBurnableMeshId id) {
    return call(__func__, world, &world::BurnSystem::stopBurn, id);
}

FwResult FW_CALL fwWorld_StartCommandLog(FwWorld* world) {
    return call(__func__, world, &world::PersistenceSystem::startLog);
}

FwResult FW_CALL fwWorld_StopCommandLog(FwWorld* world) {
    return call(__func__, world, &world::PersistenceSystem::stopLog);
}

FwResult FW_CALL fwWorld_FetchCommandLog(FwWorld* world, void* buffer, uint64_t* size) {
    return onWorld(__func__, world, [&](world::World& w) {
        checkPointer(size, "size");
        edge::giveBytes(w.persistence().fetchLog(), "log", buffer, *size);
    });
}

FwResult FW_CALL fwWorld_OpenCommandLog(FwWorld* world, const void* bytes, uint64_t size) {
    return onWorld(__func__, world, [&](world::World& w) {
        if (size > 0) checkPointer(bytes, "bytes");
        w.persistence().openLog({static_cast<const std::byte*>(bytes), size_t(size)});
    });
}

FwResult FW_CALL fwWorld_PlayCommandLog(FwWorld* world, uint64_t untilTick, float* seconds) {
    return callFor(__func__, world, seconds, "seconds", &world::PersistenceSystem::playLog,
                   untilTick);
}

FwResult FW_CALL fwWorld_StartTimeline(FwWorld* world, const FwTimelineDef* given) {
    return call(__func__, world, &world::PersistenceSystem::startTimeline, given);
}

FwResult FW_CALL fwWorld_StopTimeline(FwWorld* world) {
    return call(__func__, world, &world::PersistenceSystem::stopTimeline);
}

FwResult FW_CALL fwWorld_Seek(FwWorld* world, uint64_t untilTick, float* seconds) {
    return onWorld(__func__, world, [&](world::World& w) {
        checkPointer(seconds, "seconds");
        return w.persistence().seek(untilTick, *seconds) ? FW_OK : FW_NOT_READY;
    });
}

FwResult FW_CALL fwWorld_GetTimelineState(FwWorld* world, FwTimelineState* state) {
    return fill(__func__, world, state, &world::PersistenceSystem::timelineState);
}

}  // extern "C"
