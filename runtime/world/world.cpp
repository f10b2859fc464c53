// Ids and what stands behind them: materials, images, meshes, objects; ball events to texels.
#include "world/world.h"

#include "components/deform.h"
#include "components/lights.h"
#include "components/look_table.h"
#include "core/growth.h"
#include "mesh/bake.h"
#include "mesh/shaped.h"
#include "shared/spark.h"
#include "world/material.h"
#include "world/mesh_input.h"
#include "world/save.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace fw::world {
namespace {

using components::checkLength;
using components::checkLengths;
using components::checkValue;
using components::checkValues;

void checkFlags(uint32_t flags, uint32_t known, const char* field) {
    if (flags & ~known)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "%s is 0x%x; the known flags are 0x%x.", field, flags,
                   known);
}

void checkLimit(uint32_t value, const char* field, uint32_t low, uint32_t high) {
    if (value < low || value > high)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "%s is %u; the limits are [%u, %u].", field, value,
                   low, high);
}

FwWorldDef checkedDef(const FwWorldDef& given) {
    FwWorldDef def = given;
    checkFlags(def.flags, kWorldFlags, "FwWorldDef::flags");
    checkValue(def.spreadChance, "FwWorldDef::spreadChance", 0.0f, 1.0f);
    checkValue(def.timeToLive, "FwWorldDef::timeToLive", 0.0f, 1e6f);
    checkValues(def.up, 3, "FwWorldDef::up", -1.001f, 1.001f);
    const float length =
        std::sqrt(def.up[0] * def.up[0] + def.up[1] * def.up[1] + def.up[2] * def.up[2]);
    if (std::fabs(length - 1.0f) > 1e-3f)
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "FwWorldDef::up has length %g; it is a unit vector within 0.001.",
                   double(length));
    for (float& value : def.up) value /= length;
    checkValue(def.paceFactor, "FwWorldDef::paceFactor", 0.1f, 1000.0f);
    checkLengths(def.wind, 3, "FwWorldDef::wind", -fire::kMostWind, fire::kMostWind);
    checkLimit(def.reserved, "FwWorldDef::reserved", 0, 0);
    checkLimit(def.maxStepsPerFrame, "FwWorldDef::maxStepsPerFrame", 1, 64);
    checkLimit(def.maxLights, "FwWorldDef::maxLights", 0, components::kMostLights);
    checkLimit(def.maxRefinedTriangles, "FwWorldDef::maxRefinedTriangles", 1000, 16000000);
    checkLimit(def.volumeCell, "FwWorldDef::volumeCell", 1, 16);
    checkLimit(def.volumeSteps, "FwWorldDef::volumeSteps", 6, 64);
    checkLimit(def.volumeOctaves, "FwWorldDef::volumeOctaves", 1, gpu::kFlameOctaves);
    checkLimit(def.reserved1, "FwWorldDef::reserved1", 0, 0);
    checkLimit(def.reserved2, "FwWorldDef::reserved2", 0, 0);
    checkLimit(def.reserved3, "FwWorldDef::reserved3", 0, 0);
    checkLimit(def.maxFlames, "FwWorldDef::maxFlames", 0, 65536);
    checkLimit(def.maxParticles, "FwWorldDef::maxParticles", 0, 1u << 20);
    checkLimit(def.arrivalTiles, "FwWorldDef::arrivalTiles", 1, 1u << 20);
    return def;
}

constexpr double kFarthest = 2.0e9;  // mm

// Whole mm around points of the world, where the same place may come out otherwise in another sum.
mesh::Box boxAround(const double (&low)[3], const double (&high)[3]) noexcept {
    mesh::Box box;
    for (int i = 0; i < 3; ++i) {
        const double loose = 2 + 1e-6 * std::max(std::abs(low[i]), std::abs(high[i]));
        box.low[i] = int(std::clamp(std::floor(low[i] - loose), -kFarthest, kFarthest));
        box.high[i] = int(std::clamp(std::ceil(high[i] + loose), -kFarthest, kFarthest));
    }
    return box;
}

// Whether a ball holds the whole of a box; all in object space, radius along the stretched axes.
bool ballHolds(const float point[3], float radius, const components::Pose& pose,
               const mesh::BurnDomain& domain) noexcept {
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
        const double far = std::max(std::abs(double(domain.boundsLow[i]) - double(point[i])),
                                    std::abs(double(domain.boundsHigh[i]) - double(point[i])));
        sum += far * far * double(pose.stretch[i]) * double(pose.stretch[i]);
    }
    return sum <= double(radius) * double(radius);
}

bool nearBounds(const float point[3], const mesh::BurnDomain& domain, float reach) {
    // Squared distance to the bounds, so that far objects cost nothing.
    float sum = 0;
    for (int i = 0; i < 3; ++i) {
        const float below = domain.boundsLow[i] - point[i];
        const float above = point[i] - domain.boundsHigh[i];
        const float outside = std::max(0.0f, std::max(below, above));
        sum += outside * outside;
    }
    return sum <= reach * reach;
}

}  // namespace

void checkWorldDef(const FwWorldDef& def) { (void)checkedDef(def); }

World::World(const FwWorldDef& def, gpu::Backend& backend, const core::Log& log,
             std::pmr::memory_resource* memory)
    : memory_(memory),
      backend_(backend),
      log_(log),
      def_(checkedDef(def)),
      materials_("Material", memory),
      images_("Image", memory),
      meshes_("Mesh", memory),
      objects_("Burnable mesh", memory),
      queries_("Query", memory),
      blockers_("Blocker", memory),
      windPool_("Wind zone", memory),
      burns_("Baked burn", memory),
      windZones_(memory),
      windGrid_(memory),
      shield_(memory),
      rooms_("Room", memory),
      fires_("Volumetric fire", memory),
      fields_("Particle field", memory),
      fireProfiles_("Fire profile", memory),
      flipbooks_("Flipbook", memory),
      fireColliders_("Fire collider", memory),
      profiles_(memory),
      fireShapes_(memory),
      burning_(memory),
      fireFlames_(memory),
      emitters_("Fire emitter", memory),
      emitterRecords_(memory),
      emitterGroups_(memory),
      emitterRings_(memory),
      sparkSources_(memory),
      remote_(memory),
      places_(memory),
      nearSlots_(memory),
      imageUsers_(memory),
      touched_(memory),
      playing_(memory),
      burnBytes_(memory),
      forecasts_(memory),
      tags_(memory),
      pending_(memory),
      found_(memory),
      holds_(memory),
      jetAreas_(memory),
      jetFlux_(memory),
      jetSlots_(memory),
      events_(memory),
      probeFrames_(memory),
      frame_(memory),
      stimuli_(memory),
      frameNotes_(memory),
      lights_(memory),
      lightsBefore_(memory),
      shownLights_(memory),
      keptLights_(memory),
      lightSources_(memory),
      lightTaken_(memory),
      sources_(memory) {
    std::copy_n(def_.wind, 3, wind_);
    setFlags(def_.flags);
    remote_.governance = {def_.spreadChance, def_.maxHops, def_.maxBurningTiles, def_.timeToLive};
    remote_.capped = components::caps(remote_.governance);
    remote_.governed = components::governs(remote_.governance);
    frame_.steps.reserve(kMaxSteps);
    lights_.reserve(components::kMostLights);
    lightsBefore_.reserve(components::kMostLights);
    shownLights_.reserve(2 * components::kMostLights);
    keptLights_.reserve(components::kMostLights);
    // Of meshes, of fires, of emitters.
    lightSources_.reserve(2 * components::kMostLights + gpu::kMaxVolumeFlames + gpu::kMaxEmitters);
    lightTaken_.reserve(lightSources_.capacity());
    sources_.reserve(lightSources_.capacity());
    probeFrames_.reserve(kFramesInFlight);
    for (uint32_t i = 0; i < kFramesInFlight; ++i) probeFrames_.emplace_back(memory);
}

World::~World() {
    // The backend still holds what the ids stand for; it goes in the order objects, meshes, images.
    for (uint32_t i = 0; i < objects_.slotCount(); ++i)
        if (objects_.at(i)) backend_.destroyObject(i);
    for (uint32_t i = 0; i < meshes_.slotCount(); ++i)
        if (meshes_.at(i)) backend_.destroyMesh(i);
    for (uint32_t i = 0; i < images_.slotCount(); ++i)
        if (const ImageEntry* image = images_.at(i)) backend_.destroyImage(image->slot);
}

void World::setWind(const float wind[3]) {
    mayChange();
    checkLengths(wind, 3, "wind", -fire::kMostWind, fire::kMostWind);
    if (!std::equal(wind_, wind_ + 3, wind)) ++driveChanges_;
    components::windChanges(gusts_, fire::windUnits(wind_), clock_.tick);
    std::copy_n(wind, 3, wind_);
    windTurns();
    record(SetWind{{wind[0], wind[1], wind[2]}});
}

// ---- materials and images ---------------------------------------------------------------------

FwMaterialId World::createMaterial(const FwMaterialDef& def) {
    fire::checkMaterial(def);
    return materials_.create(def);
}

FwImageId World::createImage(const FwImageDef& def) {
    checkFlags(def.flags, 0, "FwImageDef::flags");
    checkLimit(def.width, "FwImageDef::width", 1, 8192);
    checkLimit(def.height, "FwImageDef::height", 1, 8192);
    if (!def.pixels) core::fail(FW_ERROR_INVALID_ARGUMENT, "FwImageDef::pixels is null.");
    checkValue(def.alphaCutoff, "FwImageDef::alphaCutoff", 0.0f, 1.0f);
    checkValue(def.reserved, "FwImageDef::reserved", 0.0f, 0.0f);
    uint32_t slot = 0;
    while (slot < imageUsers_.size() && imageUsers_[slot] != 0) ++slot;
    if (slot == imageUsers_.size()) imageUsers_.push_back(0);
    const size_t bytes = size_t(def.width) * def.height * 4;
    ImageEntry entry{slot, components::makeCutOut(def, memory_)};
    backend_.createImage(slot, def.width, def.height,
                         {static_cast<const std::byte*>(def.pixels), bytes}, def.alphaCutoff);
    try {
        const FwImageId id = images_.create(std::move(entry));
        imageUsers_[slot] = 1;
        return id;
    } catch (...) {
        backend_.destroyImage(slot);
        throw;
    }
}

bool World::showsImage(FwImageId id) { return imageUsers_[images_.get(id).slot] > 1; }

void World::destroyImage(FwImageId id) {
    const uint32_t slot = images_.get(id).slot;
    backend_.destroyImage(slot);
    images_.destroy(id);
    --imageUsers_[slot];  // not given out again while an object still names it
}

void World::countImages(const components::BurnableMesh& object, bool more) noexcept {
    for (const uint32_t plus1 : object.imagesPlus1)
        if (plus1 != 0) imageUsers_[plus1 - 1] += more ? 1u : ~0u;
}

void World::countFuel(const Object& object, bool more) noexcept {
    if (!components::keepsBook(object.data)) return;
    ledgers_ += more ? 1u : ~0u;
    fuel_ += more ? object.fuel.energy : 0 - object.fuel.energy;
}

// ---- meshes -----------------------------------------------------------------------------------

FwMeshId World::createMesh(const FwMeshDef& def) {
    return createEntry(makeEntry(makeDomain(def, memory_)));
}

MeshEntry World::makeEntry(core::Owned<mesh::BurnDomain> domain) const {
    MeshEntry entry;
    entry.domain = std::move(domain);
    for (const mesh::TexelPosition& texel : entry.domain->texels)
        if (texel.materialFlags & mesh::kTexelReal)
            ++entry.texelsOf[texel.materialFlags & 0xFF & (gpu::kMaterialsPerObject - 1)];
    return entry;
}

FwMeshId World::createEntry(MeshEntry entry) {
    const mesh::BurnDomain& domain = *entry.domain;
    const FwMeshId id = meshes_.create(std::move(entry));
    try {
        backend_.createMesh(id.index1 - 1, domain);
    } catch (...) {
        meshes_.destroy(id);
        throw;
    }
    return id;
}

uint32_t World::shapedSlot(uint32_t slot, const float shape[3]) {
    if (shape[0] == 1 && shape[1] == 1 && shape[2] == 1) return slot;
    for (uint32_t i = 0; i < meshes_.slotCount(); ++i) {
        const MeshEntry* entry = meshes_.at(i);
        if (!entry || entry->parentPlus1 != slot + 1) continue;
        float most = 0;
        for (int k = 0; k < 3; ++k) most = std::max(most, std::abs(entry->shape[k] / shape[k] - 1));
        if (most <= 1e-4f) return i;
    }
    MeshEntry entry = makeEntry(core::Owned<mesh::BurnDomain>::make(
        memory_, mesh::shaped(*meshes_.at(slot)->domain, shape, memory_)));
    entry.parentPlus1 = slot + 1;
    std::copy_n(shape, 3, entry.shape);
    const uint32_t made = createEntry(std::move(entry)).index1 - 1;
    ++meshes_.at(slot)->users;
    ++shapes_;
    return made;
}

// What no object uses goes; a mesh of the host's stays.
void World::releaseShape(uint32_t slot) noexcept {
    const MeshEntry& entry = *meshes_.at(slot);
    if (entry.users > 0 || entry.parentPlus1 == 0) return;
    --meshes_.at(entry.parentPlus1 - 1)->users;
    --shapes_;
    backend_.destroyMesh(slot);
    meshes_.destroy(meshes_.idOf(slot));
}

void World::destroyMesh(FwMeshId id) {
    MeshEntry& entry = meshes_.get(id);
    if (entry.users > 0)
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "Mesh %u (generation %u) is used by %u burnable mesh(es); destroy them first.",
                   id.index1, id.generation, entry.users);
    backend_.destroyMesh(id.index1 - 1);
    meshes_.destroy(id);
}

void World::meshInfo(FwMeshId id, FwMeshInfo& info) {
    const mesh::BurnDomain& domain = *meshes_.get(id).domain;
    const mesh::BakeReport& report = domain.report;
    info.mapWidth = domain.width;
    info.mapHeight = domain.height;
    info.texels = report.realTexels;
    info.charts = report.charts;
    info.vertices = uint32_t(domain.vertices.size());
    info.triangles = uint32_t(domain.indices.size() / 3);
    info.degenerateTriangles = report.degenerate;
    info.openEdges = report.openEdges;
    info.nonManifoldEdges = report.nonManifoldEdges;
    info.usedOwnUvs = report.usedOwnUv;
    info.area = float(report.meshArea);
    info.texelArea = float(report.texelArea);
    std::copy_n(domain.boundsLow, 3, info.boundsLow);
    std::copy_n(domain.boundsHigh, 3, info.boundsHigh);
    info.texelsPerMetre = domain.texelSide > 0 ? 1.0f / domain.texelSide : 0.0f;
    info.bakeMilliseconds = float(report.milliseconds);
}

// ---- burnable meshes --------------------------------------------------------------------------

FwBurnableMeshId World::createBurnableMesh(const FwBurnableMeshDef& given) {
    (void)meshes_.get(given.mesh);
    const FwBurnableMeshDef def = components::underSwitches(given, remote_.objectFlags);
    core::Owned<Object> owned = core::Owned<Object>::make(memory_, memory_);
    Object& object = *owned;
    object.data = components::makeBurnableMesh(def);
    components::checkDeform(def);
    const bool named =
        std::ranges::any_of(def.materials, [](FwMaterialId id) { return id.index1 != 0; });
    for (uint32_t i = 0; i < gpu::kMaterialsPerObject; ++i)
        if (!named)
            components::setMaterial(object.data, i, presetDef(FW_MATERIAL_PINE));
        else if (def.materials[i].index1 != 0)
            components::setMaterial(object.data, i, materials_.get(def.materials[i]));
    for (uint32_t i = 0; i < gpu::kMaterialsPerObject; ++i) {
        const FwImageId image = def.baseColors[i].index1 ? def.baseColors[i] : def.baseColor;
        if (image.index1 != 0) object.data.imagesPlus1[i] = images_.get(image).slot + 1;
    }

    const uint32_t meshSlot = shapedSlot(def.mesh.index1 - 1, object.data.shape);
    try {
        return createOn(meshSlot, def, std::move(owned));
    } catch (...) {
        releaseShape(meshSlot);
        throw;
    }
}

std::span<const uint8_t> World::goneOf(const FwBurnableMeshDef& def, MeshEntry& mesh) {
    std::array<const components::CutOut*, gpu::kMaterialsPerObject> pictures{};
    std::array<FwImageId, gpu::kMaterialsPerObject> images{};
    bool any = false;
    for (uint32_t i = 0; i < gpu::kMaterialsPerObject; ++i) {
        const FwImageId image = def.baseColors[i].index1 ? def.baseColors[i] : def.baseColor;
        if (image.index1 == 0) continue;
        const components::CutOut& cutOut = images_.get(image).cutOut;
        if (cutOut.width == 0) continue;
        pictures[i] = &cutOut;
        images[i] = image;
        any = true;
    }
    if (!any) return {};
    const auto same = [](const FwImageId& a, const FwImageId& b) {
        return a.index1 == b.index1 && a.generation == b.generation;
    };
    if (!mesh.gone || !std::equal(images.begin(), images.end(), mesh.gone->images.begin(), same)) {
        auto gone = core::Owned<GoneTexels>::make(memory_, memory_);
        gone->images = images;
        gone->texels = components::makeGone(*mesh.domain, pictures, memory_);
        mesh.gone = std::move(gone);
    }
    return mesh.gone->texels;
}

FwBurnableMeshId World::createOn(uint32_t meshSlot, const FwBurnableMeshDef& def,
                                 core::Owned<Object> owned) {
    ++geometry_;
    Object& object = *owned;
    MeshEntry& mesh = *meshes_.at(meshSlot);
    object.data.meshSlot = meshSlot;
    const mesh::BurnDomain& domain = *mesh.domain;
    const std::span<const uint8_t> gone = goneOf(def, mesh);
    object.slowness = components::makeSlowness(def, domain, gone, memory_);
    for (uint32_t i = 0; i < domain.texelCount(); ++i)
        object.texels += canBurn(object, i) ? 1u : 0u;

    const components::DriveInput drive = driveInput(object, clock_.tick);
    components::resetLatch(object.data, drive, object.latch);
    const components::Records records =
        components::makeRecords(object.data, domain, drive, object.latch);
    gpu::ObjectInit init;
    init.mesh = object.data.meshSlot;
    object.zoneWind = zoneWindOf(object, clock_.tick);
    init.record = components::makeObject(object.data, domain, records);
    init.record.zoneWind = object.zoneWind;
    object.room1 = roomOf(object);
    init.record.flags |= object.room1 << gpu::kObjectRoomShift;
    init.materials = records.materials;
    init.slowness = object.slowness;
    std::copy(object.data.imagesPlus1.begin(), object.data.imagesPlus1.end(), init.images);
    std::array<gpu::HeatMaterial, gpu::kMaterialsPerObject> heat;
    if (components::keepsBook(object.data)) {
        std::array<uint32_t, gpu::kMaterialsPerObject> texelsOf = mesh.texelsOf;
        for (uint32_t i = 0; i < gone.size(); ++i)
            if (gone[i])
                --texelsOf[domain.texels[i].materialFlags & (gpu::kMaterialsPerObject - 1)];
        object.fuel = components::fuelOf(object.data, domain, texelsOf, def_.paceFactor);
    }
    if (components::hasHeat(object.data)) {
        heat = components::makeHeatMaterials(object.data, domain, def_.paceFactor);
        init.heat = heat;
    }
    std::copy_n(object.data.shape, 3, init.shape);
    if (def.flags & (FW_BURNABLE_REFINE | FW_BURNABLE_REFINE_PUBLISHED)) {
        refineMesh(mesh, init.mesh, def, object.data);
        init.refine = true;
        init.refineDepth = def.refineDepth;
        init.refinePixelsPerEdge = def.refinePixelsPerEdge;
        if (def.flags & FW_BURNABLE_REFINE_PUBLISHED) {
            init.arpModel = mesh.arps[def.refineDepth].get();
            init.arp = arpSettings(def, *init.arpModel, object.data);
        }
    }
    init.inner = innerSkin(mesh, init.mesh, object.data);
    gpu::DeformObject deform{};
    if (components::deforms(object.data) || (object.data.flags & FW_BURNABLE_SKINNED)) {
        if (!mesh.deform) {
            auto model = core::Owned<mesh::DeformModel>::make(memory_, memory_);
            *model = mesh::makeDeformModel(domain, memory_);
            mesh.deform = std::move(model);
        }
        deform = components::makeDeform(def, object.data, records);
        if (init.inner) deform.wall = mesh.innerWall;
        init.deformModel = mesh.deform.get();
        init.deform = &deform;
    }

    checkValue(def.spreadChance, "FwBurnableMeshDef::spreadChance", 0.0f, 1.0f);
    checkValue(def.timeToLive, "FwBurnableMeshDef::timeToLive", 0.0f, 1e6f);
    object.governance = {def.spreadChance, def.maxHops, def.maxBurningTiles, def.timeToLive};
    object.remoteDue = true;
    object.firstFrame = lastFrame_ + 1;
    object.breaks = makeBreaks(def, mesh, gone);
    const uint32_t burnable = object.texels;
    const FwBurnableMeshId id = objects_.create(std::move(owned));
    object.id = id;
    object.slot = id.index1 - 1;
    try {
        // So that a warmed-up frame finds its room: one latch and update per object.
        const size_t slots = objects_.slotCount();
        core::growTo(frame_.latches, slots);
        core::growTo(frame_.updates, slots);
        core::growTo(touched_, slots);
        for (auto* perObject :
             {&frame_.burnMaps, &frame_.breaks, &jetSlots_, &nearSlots_, &remote_.due,
              &remote_.unsentSlots, &remote_.waiting, &remote_.contactsDue, &remote_.seenDue})
            core::growTo(*perObject, slots);
        placeNow(object);
        backend_.createObject(object.slot, init);
    } catch (...) {
        places_.remove(object.slot);
        objects_.destroy(id);
        throw;
    }
    object.latch.sent = true;  // it was created with these records
    ++mesh.users;
    remote_.due.push_back(object.slot);  // room was found above
    countGoverned(object, true);
    texels_ += burnable;
    countFuel(object, true);
    object.memoryBytes = sizeof(Object) + object.slowness.capacity() * sizeof(uint16_t) +
                         (object.skin.capacity() + object.skinNormals.capacity()) * sizeof(float);
    memoryCounts_.objects += object.memoryBytes;
    countMemory();
    windKept_ |= object.zoneWind != 0;
    countImages(object.data, true);
    return id;
}

// Once per mesh and depth. The walls and their holes are those of the materials of the first who
// asks.
void World::refineMesh(MeshEntry& mesh, uint32_t slot, const FwBurnableMeshDef& def,
                       const components::BurnableMesh& object) {
    const bool published = (def.flags & FW_BURNABLE_REFINE_PUBLISHED) != 0;
    const uint32_t bit = 1u << (def.refineDepth + (published ? 16 : 0));
    if (mesh.refinements & bit) return;
    mesh::RefineOptions options;
    if (published) options = mesh::arpOptions(def.refineDepth);
    options.depth = def.refineDepth;
    float wall = 0;
    for (uint32_t i = 0; i < gpu::kMaterialsPerObject; ++i)
        if (components::burns(object, i)) wall = std::max(wall, object.materials[i].thickness);
    if (wall > 0) options.wall = std::clamp(wall, 1e-4f, 0.5f);
    std::array<mesh::RefineHoles, gpu::kMaterialsPerObject> holes;
    for (uint32_t i = 0; i < gpu::kMaterialsPerObject; ++i)
        if (components::burns(object, i))
            holes[i] = components::holesOf(components::materialLook(object.materials[i].look));
    const mesh::RefineModel model = mesh::bakeRefine(*mesh.domain, options, memory_);
    core::Owned<mesh::ArpModel> arp;
    if (published) {
        arp = core::Owned<mesh::ArpModel>::make(memory_, memory_);
        *arp = mesh::makeArpModel(*mesh.domain, model, def.refineDepth, memory_);
    }
    backend_.createRefinement(slot, def.refineDepth, published, *mesh.domain, model, holes);
    if (published) mesh.arps[def.refineDepth] = std::move(arp);
    mesh.refinements |= bit;
}

// Whether an object is drawn on its mesh's inner skin from inside, which is made for the first who
// is: as thick as its walls. What is cut has places of its own, so has what moves its vertices but
// for what recedes, and what never opens has nothing to look through.
bool World::innerSkin(MeshEntry& mesh, uint32_t slot, const components::BurnableMesh& object) {
    constexpr uint32_t kOthers = FW_BURNABLE_TWO_SIDED | FW_BURNABLE_NO_HOLES |
                                 FW_BURNABLE_NO_DAMAGE | FW_BURNABLE_SKINNED | FW_BURNABLE_REFINE |
                                 FW_BURNABLE_REFINE_PUBLISHED | FW_BURNABLE_Z_PASS;
    const bool moves = components::deforms(object) && (object.flags & FW_BURNABLE_RECEDE) == 0;
    if ((object.flags & kOthers) != 0 || moves || !backend_.draws()) return false;
    if (mesh.innerSkin == InnerSkin::unknown) {
        float wall = 0;
        for (uint32_t i = 0; i < gpu::kMaterialsPerObject; ++i)
            if (components::burns(object, i) &&
                components::materialLook(object.materials[i].look).holeTime > 0)
                wall = std::max(wall, object.materials[i].thickness);
        if (!(wall > 0)) return false;
        wall = std::clamp(wall, 1e-4f, 0.5f);
        const std::pmr::vector<glm::vec3> places = mesh::innerSkin(*mesh.domain, wall, memory_);
        mesh.innerWall = wall;
        if (!places.empty()) backend_.createInnerSkin(slot, *mesh.domain, places);
        mesh.innerSkin = places.empty() ? InnerSkin::none : InnerSkin::there;
    }
    return mesh.innerSkin == InnerSkin::there;
}

// The boundary keeps up with the head of a fire that climbs.
mesh::ArpSettings World::arpSettings(const FwBurnableMeshDef& def, const mesh::ArpModel& model,
                                     const components::BurnableMesh& object) const {
    float speed = 0;
    for (uint32_t i = 0; i < gpu::kMaterialsPerObject; ++i) {
        if (!components::burns(object, i)) continue;
        const FwMaterialDef& m = object.materials[i];
        speed = std::max(speed, m.spreadRate * (1 + m.headGain * std::min(m.upGain, m.driveMax)));
    }
    return mesh::arpSettings(model, def.heatPsi, def.heatStep,
                             speed * def_.paceFactor / object.pose.scale);
}

void World::destroyBurnableMesh(FwBurnableMeshId id) {
    Object& object = *objects_.get(id);
    if (gives(object.slot))
        core::fail(
            FW_ERROR_INVALID_ARGUMENT,
            "Burnable mesh %u gives its burn to another one with the next step; destroy it after "
            "that.",
            id.index1);
    keepGiven(object);
    ++geometry_;
    const uint32_t slot = object.slot;
    countImages(object.data, false);
    const uint32_t meshSlot = object.data.meshSlot;
    --meshes_.at(meshSlot)->users;
    std::erase_if(pending_, [&](const PendingTexel& p) {
        bool there = p.object == slot;
        for (uint32_t g = 0; g < p.gateCount; ++g) there |= p.gates[g].object == slot;
        return there;
    });
    forgetGates(slot);
    std::erase_if(tags_, [&](const Tag& tag) { return tag.object.index1 == id.index1; });
    for (uint32_t i = 0; i < queries_.slotCount(); ++i)
        if (const Query* query = queries_.at(i); query && query->object.index1 == id.index1)
            queries_.destroy(queries_.idOf(i));
    std::erase(touched_, &object);
    std::erase(playing_, &object);
    std::erase(forecasts_, slot);
    places_.remove(slot);
    forgetRemote(object);
    std::erase_if(stimuli_, [&](const Stimulus& one) { return one.slot == slot; });
    forgetTouches(id);
    countGoverned(object, false);
    dropFromShield(slot);
    texels_ -= object.texels;
    countFuel(object, false);
    memoryCounts_.objects -= object.memoryBytes;
    if (object.map.wished) --mapsWished_;
    if (object.forecast && object.forecast->wished) --mapsWished_;
    backend_.destroyObject(slot);
    objects_.destroy(id);
    releaseShape(meshSlot);
}

void World::sendPose(const Object& object) noexcept {
    gpu::vec4 rows[3];
    components::poseRows(object.data.pose, rows);
    backend_.setObjectPose(object.slot, rows, components::objectTint(object.data, domainOf(object)),
                           components::objectFlags(object.data, domainOf(object)) |
                               object.room1 << gpu::kObjectRoomShift);
}

void World::setTransform(FwBurnableMeshId id, const float transform[16]) {
    mayChange();
    Object& object = *objects_.get(id);
    places_.reserveMoves(1);
    const components::Pose before = object.data.pose;
    components::poseOnShape(object.data, components::makePose(transform, "transform"), "transform");
    placeNow(object);
    object.restsUnder = 0;
    if (!(object.data.pose == before)) {
        ++geometry_;
        ++object.changes;
    }
    if (!object.remoteDue) {  // at most once each: room was found at its creation
        object.remoteDue = true;
        remote_.due.push_back(object.slot);
    }
    takeZoneWind(object);
    if (const uint32_t room1 = roomOf(object); room1 != object.room1) {
        object.room1 = room1;
        stirRooms();
    }
    sendPose(object);
    record(SetPose{object.slot, Transform(transform)});
}

uint32_t World::skinnedSlot(FwBurnableMeshId id, uint32_t vertexCount) {
    const Object& object = *objects_.get(id);
    if (!(object.data.flags & FW_BURNABLE_SKINNED))
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "Burnable mesh %u was created without FW_BURNABLE_SKINNED.", id.index1);
    const uint32_t vertices = domainOf(object).report.vertices;
    if (vertexCount != vertices)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "vertexCount is %u; the mesh has %u vertices.",
                   vertexCount, vertices);
    return object.slot;
}

void World::setVertexPositions(FwBurnableMeshId id, const float* positions, const float* normals,
                               uint32_t count) {
    ++geometry_;
    Object& object = **objects_.at(skinnedSlot(id, count));
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
    places_.reserveMoves(1);
    object.skinMoved = true;
    placeNow(object);
    backend_.setVertices(object.slot, object.skin, object.skinNormals);
}

void World::setHidden(FwBurnableMeshId id, bool hidden) {
    Object& object = *objects_.get(id);
    object.data.flags = (object.data.flags & ~uint32_t(FW_BURNABLE_HIDDEN)) |
                        (hidden ? uint32_t(FW_BURNABLE_HIDDEN) : 0u);
    sendPose(object);
}

void World::countMemory() noexcept {
    memoryCounts_.frames = frame_.latches.capacity() * sizeof(Frame::LatchOf) +
                           frame_.updates.capacity() * sizeof(gpu::MaterialUpdate) +
                           frame_.due.capacity() * sizeof(Frame::Due) +
                           frame_.events.capacity() * sizeof(gpu::TexelEvent) +
                           pending_.capacity() * sizeof(PendingTexel);
    uint64_t near = remote_.neighbours.bytes() + places_.bytes();
    for (const auto& tables : frame_.remote)
        near += tables->objects.capacity() * sizeof(gpu::RemoteUpdate::Placed) +
                tables->neighbours.capacity() * sizeof(uint32_t);
    memoryCounts_.neighbours = near;
    memoryCounts_.contacts = remote_.links.bytes() + remote_.close.bytes() +
                             remote_.pairs.capacity() * sizeof(PairContacts);
}

void World::memoryRows(std::pmr::vector<gpu::MemoryRow>& out) const {
    const auto row = [&](const char* name, uint64_t bytes) { out.push_back({name, bytes, bytes}); };
    row("world objects", memoryCounts_.objects);
    row("world frames", memoryCounts_.frames);
    row("world neighbours", memoryCounts_.neighbours);
    row("world contacts", memoryCounts_.contacts);
}

// ---- ball events -> texels --------------------------------------------------------------------

uint32_t World::eventTick(float delay) const {
    const uint64_t tick =
        clock_.hostTick() + uint64_t(std::lround(double(delay) * gpu::kTicksPerSecond));
    return uint32_t(std::min<uint64_t>(tick, Clock::kLastTick));
}

void World::findPendingRoom(size_t more) {
    if (pending_.size() + more > kMaxPending)
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "%zu texel events wait and %zu more come; the limit is %zu.", pending_.size(),
                   more, kMaxPending);
    core::growTo(pending_, pending_.size() + more);
}

void World::placeNow(const Object& object) {
    const mesh::BurnDomain& domain = domainOf(object);
    const components::Pose& pose = object.data.pose;
    double low[3], high[3];
    // The host has moved its vertices: they may be anywhere.
    for (int i = 0; i < 3; ++i) low[i] = -(high[i] = object.skinMoved ? kFarthest : -kFarthest);
    float longest = 0, shortest = components::kMostStretch;
    for (const float stretch : pose.stretch) {
        longest = std::max(longest, std::abs(stretch));
        shortest = std::min(shortest, std::abs(stretch));
    }
    // Beyond the box: as far as a ball reaches at least that touches none of its texels.
    const double around = 1000.0 * double(pose.scale) * double(longest) *
                          std::max(4.0 * double(domain.texelSide), double(domain.linkMax));
    for (uint32_t corner = 0; corner < 8 && !object.skinMoved; ++corner) {
        float point[3], at[3];
        for (uint32_t i = 0; i < 3; ++i)
            point[i] = (corner >> i & 1 ? domain.boundsHigh : domain.boundsLow)[i];
        components::toWorld(pose, point, at);
        for (int i = 0; i < 3; ++i) {
            low[i] = std::min(low[i], 1000.0 * double(at[i]) - around);
            high[i] = std::max(high[i], 1000.0 * double(at[i]) + around);
        }
    }
    // Balls are as wide as along the shortest axis, in object space. Rare: a scale per axis that an
    // object was made with is its shape's.
    if (longest > 1.001f * shortest)
        for (int i = 0; i < 3; ++i) low[i] = -(high[i] = kFarthest);
    places_.place(object.slot, boxAround(low, high), 0);
}

std::span<const uint32_t> World::objectsNear(const mesh::Box& box, float margin) noexcept {
    nearSlots_.clear();  // room was found with each object
    const double most = std::ceil(1000.0 * std::max(double(margin), 0.0)) + 2;
    places_.each(box, uint32_t(std::min(most, 2 * kFarthest)),
                 [&](uint32_t slot) { nearSlots_.push_back(slot); });
    std::sort(nearSlots_.begin(), nearSlots_.end());
    return nearSlots_;
}

std::span<const uint32_t> World::objectsNear(const float point[3], float margin) noexcept {
    double at[3];
    for (int i = 0; i < 3; ++i) at[i] = 1000.0 * double(point[i]);
    return objectsNear(boxAround(at, at), margin);
}

void World::addPending(Object& object, uint32_t kind, uint32_t tick, uint32_t water,
                       std::span<const uint32_t> texels) {
    findPendingRoom(texels.size());
    object.firstEvent = std::min(object.firstEvent, tick);
    if (kind == FW_WET) wetUntil_ = std::max<uint64_t>(wetUntil_, tick + gpu::kStepTicks);
    for (uint32_t texel : texels)
        pending_.push_back({object.slot, texel, kind, tick, water, order_++});
}

uint32_t World::nearTexel(const Object& object, const float point[3], float reach) const noexcept {
    if (!object.skinMoved && !nearBounds(point, domainOf(object), reach)) return mesh::kNone;
    return nearestTexel(object, point, reach);
}

bool World::canBurn(const Object& object, uint32_t texel) const noexcept {
    const mesh::BurnDomain& domain = domainOf(object);
    return (object.slowness.empty() ? domain.slowness : object.slowness)[texel] != 0 &&
           components::burns(object.data, texelMaterial(object, texel));
}

uint32_t World::igniteObject(Object& object, const FwIgnitionDef& def, uint32_t tick) {
    const mesh::BurnDomain& domain = domainOf(object);
    float point[3];
    components::toObject(object.data.pose, def.position, point);
    const components::Pose& pose = object.data.pose;
    const float stretched = std::min({std::abs(pose.stretch[0]), pose.stretch[1], pose.stretch[2]});
    float radius = def.radius / (pose.scale * stretched);
    // A doused band holds only when it is thicker than the longest link across it.
    if (def.kind != FW_IGNITE && def.radius > 0)
        radius = std::max({radius, 1.5f * domain.texelSide, domain.linkMax});
    const uint32_t water =
        def.water > 0 ? std::max(uint32_t(std::lround(def.water)), 1u) : gpu::kFilmMost;
    const auto wet = [&] {
        if (def.kind == FW_WET || def.kind == FW_EXTINGUISH)
            wetPatches(object, def, def.kind == FW_WET ? water : components::kPatchDrowned, tick);
    };
    // As one operation, whatever it has of texels.
    if (!object.skinMoved && ballHolds(point, radius * stretched, pose, domain)) {
        const uint32_t all[] = {kAllTexels};
        addPending(object, def.kind, tick, water, all);
        wet();
        return domain.report.realTexels;
    }
    const float reach = std::max(radius, domain.texelSide);
    const uint32_t nearest = nearTexel(object, point, reach);
    if (nearest == mesh::kNone) return 0;
    found_.clear();
    if (!object.skinMoved)
        mesh::texelsNear(domain, point, radius, found_);
    else
        for (uint32_t i = 0; i < domain.texelCount(); ++i)
            if (domain.real(i)) found_.push_back(i);
    // The ball itself decides: a centre off the surface reaches a smaller disc.
    std::erase_if(found_, [&](uint32_t texel) {
        float d[3];
        texelPlace(object, texel, d);
        for (int i = 0; i < 3; ++i) d[i] = (d[i] - point[i]) * pose.stretch[i];
        const float reached = radius * stretched;
        return d[0] * d[0] + d[1] * d[1] + d[2] * d[2] > reached * reached;
    });
    if (found_.empty()) found_.push_back(nearest);
    addPending(object, def.kind, tick, water, found_);
    wet();
    return uint32_t(found_.size());
}

uint32_t World::ignite(const FwIgnitionDef& def, bool* acts) {
    mayChange();
    checkValue(def.delay, "FwIgnitionDef::delay", 0.0f, 3600.0f);
    const size_t before = pending_.size();
    const uint32_t texels = igniteAt(def, eventTick(def.delay));
    if (acts) *acts = texels > 0 && (def.kind != FW_IGNITE || lightsSomething(before));
    return texels;
}

uint32_t World::igniteAt(const FwIgnitionDef& def, uint32_t tick) {
    checkLimit(def.kind, "FwIgnitionDef::kind", 0, FW_EXTINGUISH);
    checkLengths(def.position, 3, "FwIgnitionDef::position", -1e6f, 1e6f);
    checkLength(def.radius, "FwIgnitionDef::radius", 0.0f, 1e6f);
    checkValue(def.water, "FwIgnitionDef::water", 0.0f, def.kind == FW_WET ? 1023.0f : 0.0f);
    for (uint32_t i = 0; i < 2; ++i)
        if (def.reserved[i] != 0)
            core::fail(FW_ERROR_INVALID_ARGUMENT, "FwIgnitionDef::reserved[%u] is %u; it is zero.",
                       i, def.reserved[i]);
    const size_t before = pending_.size();
    try {
        uint32_t texels = 0;
        if (def.object.index1 != 0)
            texels = igniteObject(*objects_.get(def.object), def, tick);
        else
            for (const uint32_t slot : objectsNear(def.position, def.radius))
                texels += igniteObject(**objects_.at(slot), def, tick);
        recordTexels(before);
        return texels;
    } catch (...) {
        pending_.resize(before);
        throw;
    }
}

void World::pushTexels(FwBurnableMeshId id, uint32_t kind, std::span<const uint32_t> texels) {
    Object& object = *objects_.get(id);
    checkLimit(kind, "kind", 0, FW_EXTINGUISH);
    const mesh::BurnDomain& domain = domainOf(object);
    const uint32_t count = domain.texelCount();
    for (size_t i = 0; i < texels.size(); ++i)
        if (texels[i] >= count)
            core::fail(FW_ERROR_INVALID_ARGUMENT, "texels[%zu] is %u; the map has %u texels.", i,
                       texels[i], count);
    // Heat steps never look at a texel that no triangle covers: an event would change it for good.
    found_.clear();
    for (const uint32_t texel : texels)
        if (domain.real(texel)) found_.push_back(texel);
    addPending(object, kind, uint32_t(clock_.tick), gpu::kFilmMost, found_);
}

}  // namespace fw::world
