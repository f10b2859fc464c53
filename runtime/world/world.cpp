#include "world/world.h"

#include "components/deform.h"
#include "components/lights.h"
#include "core/growth.h"
#include "core/reserved.h"
#include "flamewright/flamewright_debug.h"
#include "host_limits.h"
#include "world/material.h"
#include "world/shift.h"

#include <algorithm>
#include <cmath>

namespace fw::world {
namespace {

using components::checkLengths;
using components::checkValue;
using components::checkValues;
using components::checkWhole;

constexpr double kFarthestOrigin = 1e9;  // m that all places may move in all

FwWorldDef checkedDef(const FwWorldDef& given) {
    FwWorldDef def = given;
    components::checkFlags(def.flags, "FwWorldDef::flags", kWorldFlags);
    checkValue(def.spreadChance, "FwWorldDef::spreadChance", 0.0f, 1.0f);
    checkValue(def.timeToLive, "FwWorldDef::timeToLive", 0.0f, 1e6f);
    checkValues(def.up, 3, "FwWorldDef::up", -1.001f, 1.001f);
    const float length =
        std::sqrt(def.up[0] * def.up[0] + def.up[1] * def.up[1] + def.up[2] * def.up[2]);
    if (std::fabs(length - 1.0f) > 1e-3f)
        core::refuse("FwWorldDef::up has length %g; it is a unit vector within 0.001.",
                     double(length));
    for (float& value : def.up) value /= length;
    checkValue(def.paceFactor, "FwWorldDef::paceFactor", 0.1f, 1000.0f);
    checkLengths(def.wind, 3, "FwWorldDef::wind", -fire::kMaxWind, fire::kMaxWind);
    checkWhole(def.reserved, "FwWorldDef::reserved", 0, 0);
    checkWhole(def.maxStepsPerFrame, "FwWorldDef::maxStepsPerFrame", 1, 64);
    checkWhole(def.maxLights, "FwWorldDef::maxLights", 0, limits::kLights);
    checkWhole(def.maxRefinedTriangles, "FwWorldDef::maxRefinedTriangles", 1000, 16000000);
    checkWhole(def.volumePixelSize, "FwWorldDef::volumePixelSize", 1, 16);
    checkWhole(def.rayStepCount, "FwWorldDef::rayStepCount", 6, 64);
    checkWhole(def.volumeOctaves, "FwWorldDef::volumeOctaves", 1, gpu::kFlameOctaves);
    checkWhole(def.reserved1, "FwWorldDef::reserved1", 0, 0);
    checkWhole(def.reserved2, "FwWorldDef::reserved2", 0, 0);
    checkWhole(def.reserved3, "FwWorldDef::reserved3", 0, 0);
    checkWhole(def.maxFlames, "FwWorldDef::maxFlames", 0, 65536);
    checkWhole(def.maxParticles, "FwWorldDef::maxParticles", 0, 1u << 20);
    checkWhole(def.arrivalTiles, "FwWorldDef::arrivalTiles", 1, 1u << 20);
    return def;
}

}  // namespace

void checkWorldDef(const FwWorldDef& def) { (void)checkedDef(def); }

// The records that the backend needs to create an object. It points into them.
struct World::ObjectRecords {
    gpu::ObjectInit init;
    components::Records records;
    std::array<gpu::HeatMaterial, gpu::kMaterialsPerObject> heat;
    gpu::DeformObject deform{};
};

World::World(const FwWorldDef& def, gpu::Backend& backend, const core::Log& log,
             std::pmr::memory_resource* memory)
    : events_(memory),
      context_{memory, backend, log, checkedDef(def), events_, recorder_, {}, {}},
      recorder_(context_.clock),
      scene_(context_),
      wind_(context_, scene_),
      rooms_(context_, scene_),
      fields_(context_, scene_, wind_, burn_),
      flames_(context_, scene_, wind_, exchange_, burn_),
      emitters_(context_, scene_, wind_, exchange_, flames_, burn_),
      lights_(context_, scene_, flames_, emitters_),
      exchange_(context_, scene_, wind_),
      burn_(context_, scene_, wind_, rooms_, exchange_),
      queries_(context_, scene_, wind_, exchange_, flames_, emitters_, lights_, burn_),
      budget_(context_),
      persistence_(*this) {
    exchange_.setFlags(context_.def.flags);
}

// ---- burnable meshes --------------------------------------------------------------------------

FwBurnableMeshId World::createBurnableMesh(const FwBurnableMeshDef& given) {
    (void)scene_.meshes.get(given.mesh);
    const FwBurnableMeshDef def =
        components::applyWorldFlags(given, exchange_.transfer().objectFlags);
    core::Owned<Object> owned = core::Owned<Object>::make(context_.memory, context_.memory);
    Object& object = *owned;
    object.data = components::makeBurnableMesh(def);
    components::checkDeform(def);
    const bool named =
        std::ranges::any_of(def.materials, [](FwMaterialId id) { return id.index1 != 0; });
    for (uint32_t i = 0; i < gpu::kMaterialsPerObject; ++i)
        if (!named)
            components::setMaterial(object.data, i, presetDef(FW_MATERIAL_PINE));
        else if (def.materials[i].index1 != 0)
            components::setMaterial(object.data, i, scene_.materials.get(def.materials[i]));
    for (uint32_t i = 0; i < gpu::kMaterialsPerObject; ++i) {
        const FwImageId image = def.baseColors[i].index1 ? def.baseColors[i] : def.baseColor;
        if (image.index1 != 0) object.data.imagesPlus1[i] = scene_.images.get(image).slot + 1;
    }

    const uint32_t meshSlot = scene_.shapedSlot(def.mesh.index1 - 1, object.data.shape);
    try {
        return createOn(meshSlot, def, std::move(owned));
    } catch (...) {
        scene_.releaseShape(meshSlot);
        throw;
    }
}

// `gone`: texels that pictures cut out.
void World::countObjectFuel(Object& object, const MeshEntry& mesh,
                            std::span<const uint8_t> gone) const {
    if (!components::tracksBurntFuel(object.data)) return;
    const mesh::BurnDomain& domain = *mesh.domain;
    std::array<uint32_t, gpu::kMaterialsPerObject> texelsOf = mesh.texelsOf;
    for (uint32_t i = 0; i < gone.size(); ++i)
        if (gone[i]) --texelsOf[domain.texels[i].materialFlags & (gpu::kMaterialsPerObject - 1)];
    object.fuel = components::fuelOf(object.data, domain, texelsOf, context_.def.paceFactor);
}

// The records of a new object, as they are under the wind and in the room where it stands.
void World::makeRecords(Object& object, MeshEntry& mesh, const FwBurnableMeshDef& def,
                        ObjectRecords& made) {
    const mesh::BurnDomain& domain = *mesh.domain;
    const components::DriveInput drive = wind_.driveInput(object, context_.clock.tick);
    components::resetLatch(object.data, drive, object.latch);
    made.records = components::makeRecords(object.data, domain, drive, object.latch);
    const components::Records& records = made.records;
    gpu::ObjectInit& init = made.init;
    init.mesh = object.data.meshSlot;
    object.zoneWind = wind_.localWindOf(object, context_.clock.tick);
    init.record = components::makeObject(object.data, domain, records);
    init.record.zoneWind = object.zoneWind;
    object.room1 = rooms_.roomOf(object);
    init.record.flags |= object.room1 << gpu::kObjectRoomShift;
    init.materials = records.materials;
    init.slowness = object.slowness;
    std::copy(object.data.imagesPlus1.begin(), object.data.imagesPlus1.end(), init.images);
    if (components::hasHeat(object.data)) {
        made.heat = components::makeHeatMaterials(object.data, domain, context_.def.paceFactor);
        init.heat = made.heat;
    }
    std::copy_n(object.data.shape, 3, init.shape);
    if (def.flags & (FW_BURNABLE_REFINE | core::reserved::kRefinement)) {
        scene_.refineMesh(mesh, init.mesh, def, object.data);
        init.refine = true;
        init.refineDepth = def.refineDepth;
        init.refinePixelsPerEdge = def.refinePixelsPerEdge;
        init.refineExtended = (def.flags & core::reserved::kRefinement) != 0;
        init.boundary = scene_.boundaryOf(def, object.data);
    }
    init.inner = scene_.innerSkin(mesh, init.mesh, object.data);
    if (components::deforms(object.data) || (object.data.flags & FW_BURNABLE_SKINNED)) {
        if (!mesh.deform) {
            auto model = core::Owned<mesh::DeformModel>::make(context_.memory, context_.memory);
            *model = mesh::makeDeformModel(domain, context_.memory);
            mesh.deform = std::move(model);
        }
        made.deform = components::makeDeform(def, object.data, records);
        if (init.inner) made.deform.wall = mesh.innerWall;
        init.deformModel = mesh.deform.get();
        init.deform = &made.deform;
    }
}

FwBurnableMeshId World::createOn(uint32_t meshSlot, const FwBurnableMeshDef& def,
                                 core::Owned<Object> owned) {
    ++scene_.geometryVersion;
    Object& object = *owned;
    MeshEntry& mesh = *scene_.meshes.at(meshSlot);
    object.data.meshSlot = meshSlot;
    const std::span<const uint8_t> gone = scene_.goneOf(def, mesh);
    object.slowness = components::makeSlowness(def, *mesh.domain, gone, context_.memory);
    for (uint32_t i = 0; i < mesh.domain->texelCount(); ++i)
        object.texels += scene_.canBurn(object, i) ? 1u : 0u;
    countObjectFuel(object, mesh, gone);
    const uint32_t burnable = object.texels;
    ObjectRecords made;
    makeRecords(object, mesh, def, made);

    checkValue(def.spreadChance, "FwBurnableMeshDef::spreadChance", 0.0f, 1.0f);
    checkValue(def.timeToLive, "FwBurnableMeshDef::timeToLive", 0.0f, 1e6f);
    object.governance = {def.spreadChance, def.maxHops, def.maxBurningTiles, def.timeToLive};
    object.firstFrame = context_.lastFrame + 1;
    object.breaks = burn_.makeBreaks(def, mesh, gone);
    const FwBurnableMeshId id = scene_.objects.create(std::move(owned));
    object.id = id;
    object.slot = id.index1 - 1;
    try {
        eachSystem([](auto& system) {
            if constexpr (requires { system.reserveSlots(); }) system.reserveSlots();
        });
        scene_.placeNow(object);
        context_.backend.createObject(object.slot, made.init);
    } catch (...) {
        scene_.places.remove(object.slot);
        scene_.objects.destroy(id);
        throw;
    }
    object.latch.sent = true;  // it was created with these records
    ++mesh.users;
    scene_.markMoved(object);
    exchange_.addObject(object);
    wind_.addObject(object);
    scene_.texels += burnable;
    scene_.countFuel(object, true);
    scene_.countImages(object.data, true);
    object.memoryBytes = sizeof(Object) + object.slowness.capacity() * sizeof(uint16_t) +
                         (object.skin.capacity() + object.skinNormals.capacity()) * sizeof(float);
    memoryCounts_.objects += object.memoryBytes;
    countMemory();
    return id;
}

void World::destroyBurnableMesh(FwBurnableMeshId id) {
    Object& object = *scene_.objects.get(id);
    burn_.checkGone(object);
    burn_.keepGiven(object);
    ++scene_.geometryVersion;
    const uint32_t slot = object.slot;
    const uint32_t meshSlot = object.data.meshSlot;
    eachSystem([&](auto& system) {
        if constexpr (requires { system.forgetObject(object); }) system.forgetObject(object);
    });
    scene_.removeObject(object);
    memoryCounts_.objects -= object.memoryBytes;
    context_.backend.destroyObject(slot);
    scene_.objects.destroy(id);
    scene_.releaseShape(meshSlot);
}

void World::setTransform(FwBurnableMeshId id, const float transform[16]) {
    recorder_.mayChange();
    Object& object = *scene_.objects.get(id);
    scene_.places.reserveMoves(1);
    const components::Pose before = object.data.pose;
    components::poseOnShape(object.data, components::makePose(transform, "transform"), "transform");
    scene_.placeNow(object);
    object.sleepsUnder = 0;
    if (!(object.data.pose == before)) {
        ++scene_.geometryVersion;
        ++object.changes;
    }
    scene_.markMoved(object);
    wind_.updateObject(object);
    if (const uint32_t room1 = rooms_.roomOf(object); room1 != object.room1) {
        object.room1 = room1;
        rooms_.stir();
    }
    scene_.sendPose(object);
    recorder_.record(SetPose{{object.slot, Transform(transform)}});
}

void World::setVertexPositions(FwBurnableMeshId id, const float* positions, const float* normals,
                               uint32_t count) {
    ++scene_.geometryVersion;
    Object& object = scene_.objectAt(scene_.skinnedSlot(id, count));
    const unsigned values = count * 3;
    checkLengths(positions, values, "positions", -1e6f, 1e6f);
    if (normals) checkValues(normals, values, "normals", -1e6f, 1e6f);
    object.skin.resize(values);
    object.skinNormals.resize(normals ? values : 0);
    const float* shape = object.data.shape;
    for (unsigned i = 0; i < values; ++i) object.skin[i] = positions[i] * shape[i % 3];
    for (unsigned i = 0; normals && i < values; i += 3) {
        float sum = 0;
        for (unsigned k = 0; k < 3; ++k) {
            object.skinNormals[i + k] = normals[i + k] / shape[k];
            sum += object.skinNormals[i + k] * object.skinNormals[i + k];
        }
        const float scale = sum > 0 ? 1 / std::sqrt(sum) : 0;
        for (unsigned k = 0; k < 3; ++k) object.skinNormals[i + k] *= scale;
    }
    scene_.places.reserveMoves(1);
    object.skinMoved = true;
    scene_.placeNow(object);
    context_.backend.setVertices(object.slot, object.skin, object.skinNormals);
}

// ---- frames -----------------------------------------------------------------------------------

void World::checkFrame(uint64_t frameIndex, float deltaTime) const {
    components::checkValue(deltaTime, "deltaTime", 0.0f, 10.0f);
    if (frameIndex <= context_.lastFrame)
        core::refuse("frameIndex is %llu and the last frame was %llu; it grows.",
                     static_cast<unsigned long long>(frameIndex),
                     static_cast<unsigned long long>(context_.lastFrame));
    if (deltaTime > 0 && context_.clock.tick >= Clock::kLastTick)
        core::refuse(
            "The world has simulated %llu s, which is the limit; create a new one. With "
            "deltaTime 0 it can still be drawn and asked.",
            static_cast<unsigned long long>(Clock::kLastTick / 4096));
    persistence_.checkFrame(deltaTime);
}

void World::advance(uint64_t frameIndex, float deltaTime) {
    checkFrame(frameIndex, deltaTime);
    collectReadbacks();
    const HostFrame frame{
        frameIndex, deltaTime, context_.clock.tick,
        fw::world::advance(context_.clock, deltaTime, context_.def.maxStepsPerFrame)};
    gpu::FramePlan plan;
    this->plan(frame, plan);
    context_.backend.run(plan);
    commit(frame);
    collect();
    queries_.runForecasts();
}

// If it throws, the world is as it was.
void World::plan(const HostFrame& frame, gpu::FramePlan& plan) {
    plan.frameIndex = frame.index;
    plan.switches = context_.switches;
    plan.endTick = uint32_t(frame.end());
    plan.tickFraction = float(double(frame.time.after.fraction) / double(Clock::kStepUnits));
    wind_.plan(plan);
    emitters_.beginFrame();
    const size_t waiting = burn_.pendingCount();
    try {
        actOnObjects(frame.end());
        burn_.plan(frame, plan);
        persistence_.plan(frame, plan);
        emitters_.listProbes();
        queries_.plan({persistence_.hashed(), burn_.searched()}, plan);
    } catch (...) {
        burn_.dropPending(waiting);
        throw;
    }
    flames_.plan(frame, plan);
    emitters_.plan(frame, plan);
    fields_.plan(frame, plan);
    budget_.plan(plan);
}

// A frame that fails leaves times of contact behind that the next one finds, no more.
void World::actOnObjects(uint64_t end) {
    const uint64_t first =
        (context_.clock.tick + gpu::kExchangeTicks - 1) / gpu::kExchangeTicks * gpu::kExchangeTicks;
    if (first < end) emitters_.beginExchanges(uint32_t(first));
    for (uint64_t now = first; now < end; now += gpu::kExchangeTicks) {
        flames_.igniteObjects(uint32_t(now));
        emitters_.heatObjects(uint32_t(now));
        burn_.clearSplashes();
        fields_.wetObjects(uint32_t(now));
        emitters_.wetPatches(burn_.splashes(), false);
    }
}

void World::commit(const HostFrame& frame) {
    burn_.commit(frame);
    queries_.commit(frame);
    flames_.commit();
    fields_.commit(frame);
    if (frame.begin < Clock::kWarnTick && frame.end() >= Clock::kWarnTick)
        context_.log.write(FW_LOG_WARNING, "A world has a day left: it simulates at most %llu s.",
                           static_cast<unsigned long long>(Clock::kLastTick / 4096));
    context_.clock = frame.time.after;
    context_.lastFrame = frame.index;
    ++context_.frames;
    countMemory();
    emitters_.commit(frame);
    lights_.commit(frame);
    persistence_.commit(frame);
}

void World::collect() noexcept {
    try {
        collectReadbacks();
    } catch (...) {  // the next frame tries again, and may say so
    }
}

void World::collectReadbacks() {
    while (const gpu::Readback* readback = context_.backend.nextReadback())
        if (readback->frameIndex > context_.loadedFrame) applyReadback(*readback);
}

void World::applyReadback(const gpu::Readback& readback) {
    burn_.onFrameDone(readback.frameIndex);
    context_.readbackFrame = readback.frameIndex;
    context_.origin.forgetBefore(readback.frameIndex);
    context_.readbackTick = readback.endTick;
    budget_.onReadback(readback);
    burn_.onReadback(readback);
    queries_.onReadback(readback);
    emitters_.onProbes(queries_.jetAnswers());
    persistence_.forgetTags(queries_.reachedTags(), readback.frameIndex);
    lights_.onReadback(readback);
    fields_.onReadback(readback);
    const BurnCounts& counts = burn_.state().counts;
    rooms_.onReadback(readback, counts.hot != 0 || counts.burning != 0);
    for (const gpu::ObjectImage& map : readback.burnMaps) {
        auto* owned = scene_.objects.findSlot(map.object);
        if (!owned || (*owned)->firstFrame > readback.frameIndex) continue;
        persistence_.onBurnMap(map, readback);
        burn_.onBurnMap(**owned, map, readback);
        queries_.onBurnMap(**owned, map, readback);
    }
    burn_.settle(readback);
    persistence_.completeSaves(readback);
}

// ---- figures ----------------------------------------------------------------------------------

void World::countMemory() noexcept {
    memoryCounts_.frames = burn_.bytes();
    memoryCounts_.neighbours = exchange_.neighbourBytes() + scene_.places.bytes();
    memoryCounts_.contacts = exchange_.contactBytes();
}

void World::memoryRows(std::pmr::vector<gpu::MemoryRow>& out) const {
    const auto row = [&](const char* name, uint64_t bytes) { out.push_back({name, bytes, bytes}); };
    row("world objects", memoryCounts_.objects);
    row("world frames", memoryCounts_.frames);
    row("world neighbours", memoryCounts_.neighbours);
    row("world contacts", memoryCounts_.contacts);
}

void World::stats(FwWorldStats& stats) noexcept {
    const BurnState& burn = burn_.state();
    stats.steps = burn.steps;
    stats.tick = context_.clock.tick;
    stats.readbackFrame = context_.readbackFrame;
    stats.objects = scene_.objects.live();
    stats.meshes = scene_.meshes.live() - scene_.shapes;
    stats.materials = scene_.materials.live();
    stats.frontTiles = burn.counts.front;
    stats.runTiles = burn.counts.run;
    stats.burningTiles = burn.counts.burning;
    stats.hotTiles = burn.counts.hot;
    stats.flames = context_.backend.quadsShown();
    stats.lateClamps = burn.counts.lateClamps;
    stats.droppedSteps = uint32_t(burn.droppedSteps);
    for (const Object* object : scene_.touched) {
        stats.burningObjects += object->counters.burning > 0 ? 1u : 0u;
        stats.refinedTriangles += object->counters.refined;
    }
    stats.texels = scene_.texels;
}

void World::setSwitches(uint32_t switches) {
    constexpr uint32_t kKnown = FW_DEBUG_DENSE | FW_DEBUG_SHUFFLE | FW_DEBUG_NO_SEAM_WAKE |
                                FW_DEBUG_WRONG_DEPENDENTS | FW_DEBUG_NO_WIND_WAKE |
                                FW_DEBUG_NEVER_IDLE | FW_DEBUG_REFINE_FULL |
                                FW_DEBUG_SELF_INTERSECTION | core::reserved::kSwitchNoDepth;
    core::reserved::checkSwitches(switches);
    if (switches & ~kKnown)
        core::refuse("switches is 0x%x; the known switches are 0x%x.", switches, kKnown);
    context_.switches = switches;
}

// ---- the origin -------------------------------------------------------------------------------

void World::shiftOrigin(const float offset[3], float applied[3]) {
    recorder_.mayChange();
    checkLengths(offset, 3, "offset", -2e6f, 2e6f);
    double by[3];
    for (int i = 0; i < 3; ++i) {
        by[i] = std::round(double(offset[i]));
        if (!(std::abs(context_.origin.moved[i] + by[i]) <= kFarthestOrigin))
            core::refuse("offset[%d] is " FW_LENGTH " " FW_LENGTH_UNIT
                         " and all places have moved by " FW_LENGTH " " FW_LENGTH_UNIT
                         " already; the limit is +-" FW_LENGTH " " FW_LENGTH_UNIT " in all.",
                         i, by[i], context_.origin.moved[i], kFarthestOrigin);
    }
    float whole[3];
    for (int i = 0; i < 3; ++i) whole[i] = float(by[i]);
    const auto check = [&](const auto& place, const char* name, uint32_t slot) {
        checkMoved(place, by, name, slot);
    };
    eachSystem([&](auto& system) {
        if constexpr (requires { system.eachPlace(check); }) system.eachPlace(check);
    });
    scene_.places.reserveMoves(scene_.objects.live());
    std::pmr::vector<Seen> seen = exchange_.recordedSeen();
    shiftBy(by);
    exchange_.restoreSeen(seen);
    if (applied) std::copy_n(whole, 3, applied);
    recorder_.record(ShiftOrigin{{int32_t(by[0]), int32_t(by[1]), int32_t(by[2])}});
}

void World::apply(const ShiftOrigin& command) {
    float offset[3];
    std::copy_n(command.metres, 3, offset);
    shiftOrigin(offset, nullptr);
}

void World::shiftBy(const double (&by)[3]) noexcept {
    if (by[0] == 0 && by[1] == 0 && by[2] == 0) return;
    context_.origin.add(by, context_.lastFrame);
    context_.backend.moveWorld(by);
    const auto move = [&](auto& place, const char*, uint32_t) { moveBy(place, by); };
    eachSystem([&](auto& system) {
        if constexpr (requires { system.eachPlace(move); }) system.eachPlace(move);
        if constexpr (requires { system.shiftOrigin(by); }) system.shiftOrigin(by);
    });
    events_.move(by);
}

}  // namespace fw::world
