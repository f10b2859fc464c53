// Materials, images, meshes, and where burnable meshes are.
#include "world/scene.h"

#include "components/appearance_table.h"
#include "components/deform.h"
#include "core/growth.h"
#include "core/reserved.h"
#include "mesh/bake.h"
#include "world/geometry.h"
#include "world/material.h"
#include "world/mesh_input.h"
#include "world/shift.h"

#include <algorithm>
#include <cmath>

namespace fw::world {
namespace {

using components::checkLengths;
using components::checkValue;
using components::checkValues;

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

}  // namespace

Scene::Scene(const WorldContext& context)
    : materials("Material", context.memory),
      images("Image", context.memory),
      meshes("Mesh", context.memory),
      objects("Burnable mesh", context.memory),
      places(context.memory),
      touched(context.memory),
      playing(context.memory),
      moved(context.memory),
      found(context.memory),
      context_(context),
      nearSlots_(context.memory),
      imageUsers_(context.memory) {}

Scene::~Scene() {
    // The backend still holds what the ids stand for; it goes in the order objects, meshes, images.
    for (auto [i, object] : objects.entries()) context_.backend.destroyObject(i);
    for (auto [i, mesh] : meshes.entries()) context_.backend.destroyMesh(i);
    for (auto [i, image] : images.entries()) context_.backend.destroyImage(image.slot);
}

FwMaterialId Scene::createMaterial(const FwMaterialDef& def) {
    fire::checkMaterial(def);
    return materials.create(def);
}

FwImageId Scene::createImage(const FwImageDef& def) {
    components::checkFlags(def.flags, "FwImageDef::flags", 0);
    components::checkWhole(def.width, "FwImageDef::width", 1, 8192);
    components::checkWhole(def.height, "FwImageDef::height", 1, 8192);
    if (!def.pixels) core::refuse("FwImageDef::pixels is null.");
    checkValue(def.alphaCutoff, "FwImageDef::alphaCutoff", 0.0f, 1.0f);
    checkValue(def.reserved, "FwImageDef::reserved", 0.0f, 0.0f);
    uint32_t slot = 0;
    while (slot < imageUsers_.size() && imageUsers_[slot] != 0) ++slot;
    if (slot == imageUsers_.size()) imageUsers_.push_back(0);
    const size_t bytes = size_t(def.width) * def.height * 4;
    ImageEntry entry{slot, components::makeCutOut(def, context_.memory)};
    context_.backend.createImage(slot, def.width, def.height,
                                 {static_cast<const std::byte*>(def.pixels), bytes},
                                 def.alphaCutoff);
    try {
        const FwImageId id = images.create(std::move(entry));
        imageUsers_[slot] = 1;
        return id;
    } catch (...) {
        context_.backend.destroyImage(slot);
        throw;
    }
}

bool Scene::showsImage(FwImageId id) { return imageUsers_[images.get(id).slot] > 1; }

void Scene::destroyImage(FwImageId id) {
    const uint32_t slot = images.get(id).slot;
    context_.backend.destroyImage(slot);
    images.destroy(id);
    FW_ASSERT(imageUsers_[slot] > 0, "image %u", slot);
    --imageUsers_[slot];  // not given out again while an object still names it
}

void Scene::countImages(const components::BurnableMesh& object, bool more) noexcept {
    for (const uint32_t plus1 : object.imagesPlus1)
        if (plus1 != 0) {
            FW_ASSERT(plus1 <= imageUsers_.size() && (more || imageUsers_[plus1 - 1] > 0),
                      "image %u", plus1 - 1);
            imageUsers_[plus1 - 1] += more ? 1u : ~0u;
        }
}

void Scene::countFuel(const Object& object, bool more) noexcept {
    if (!components::tracksBurntFuel(object.data)) return;
    ledgers += more ? 1u : ~0u;
    fuel += more ? object.fuel.energy : 0 - object.fuel.energy;
}

FwMeshId Scene::createMesh(const FwMeshDef& def) {
    return createEntry(makeEntry(makeDomain(def, context_.memory)));
}

MeshEntry Scene::makeEntry(core::Owned<mesh::BurnDomain> domain) const {
    MeshEntry entry;
    entry.domain = std::move(domain);
    for (const mesh::TexelPosition& texel : entry.domain->texels)
        if (texel.materialFlags & mesh::kTexelReal)
            ++entry.texelsOf[texel.materialFlags & 0xFF & (gpu::kMaterialsPerObject - 1)];
    return entry;
}

FwMeshId Scene::createEntry(MeshEntry entry) {
    const mesh::BurnDomain& domain = *entry.domain;
    const FwMeshId id = meshes.create(std::move(entry));
    try {
        context_.backend.createMesh(id.index1 - 1, domain);
    } catch (...) {
        meshes.destroy(id);
        throw;
    }
    return id;
}

uint32_t Scene::shapedSlot(uint32_t slot, const float shape[3]) {
    if (shape[0] == 1 && shape[1] == 1 && shape[2] == 1) return slot;
    for (auto [i, entry] : meshes.entries()) {
        if (entry.parentPlus1 != slot + 1) continue;
        if (std::equal(shape, shape + 3, entry.shape,
                       [](float a, float b) { return std::abs(b / a - 1) <= 1e-4f; }))
            return i;
    }
    MeshEntry entry = makeEntry(core::Owned<mesh::BurnDomain>::make(
        context_.memory, mesh::shaped(*meshes.at(slot)->domain, shape, context_.memory)));
    entry.parentPlus1 = slot + 1;
    std::copy_n(shape, 3, entry.shape);
    const uint32_t made = createEntry(std::move(entry)).index1 - 1;
    ++meshes.at(slot)->users;
    ++shapes;
    return made;
}

// Destroys the shape if no object uses it; a mesh of the host's stays.
void Scene::releaseShape(uint32_t slot) noexcept {
    const MeshEntry& entry = *meshes.at(slot);
    if (entry.users > 0 || entry.parentPlus1 == 0) return;
    --meshes.at(entry.parentPlus1 - 1)->users;
    --shapes;
    context_.backend.destroyMesh(slot);
    meshes.destroy(meshes.idOf(slot));
}

void Scene::destroyMesh(FwMeshId id) {
    MeshEntry& entry = meshes.get(id);
    if (entry.users > 0)
        core::refuse("Mesh %u (generation %u) is used by %u burnable mesh(es); destroy them first.",
                     id.index1, id.generation, entry.users);
    context_.backend.destroyMesh(id.index1 - 1);
    meshes.destroy(id);
}

void Scene::meshInfo(FwMeshId id, FwMeshInfo& info) {
    const mesh::BurnDomain& domain = *meshes.get(id).domain;
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

std::span<const uint8_t> Scene::goneOf(const FwBurnableMeshDef& def, MeshEntry& mesh) {
    std::array<const components::CutOut*, gpu::kMaterialsPerObject> pictures{};
    std::array<FwImageId, gpu::kMaterialsPerObject> shown{};
    bool any = false;
    for (uint32_t i = 0; i < gpu::kMaterialsPerObject; ++i) {
        const FwImageId image = def.baseColors[i].index1 ? def.baseColors[i] : def.baseColor;
        if (image.index1 == 0) continue;
        const components::CutOut& cutOut = images.get(image).cutOut;
        if (cutOut.width == 0) continue;
        pictures[i] = &cutOut;
        shown[i] = image;
        any = true;
    }
    if (!any) return {};
    if (!mesh.gone || !std::ranges::equal(shown, mesh.gone->images, same<FwImageId>)) {
        auto gone = core::Owned<GoneTexels>::make(context_.memory, context_.memory);
        gone->images = shown;
        gone->texels = components::makeCutOutMask(*mesh.domain, pictures, context_.memory);
        mesh.gone = std::move(gone);
    }
    return mesh.gone->texels;
}

// Once per mesh and depth. The walls and their holes are those of the materials of the first who
// asks.
void Scene::refineMesh(MeshEntry& mesh, uint32_t slot, const FwBurnableMeshDef& def,
                       const components::BurnableMesh& object) {
    const bool extended = (def.flags & core::reserved::kRefinement) != 0;
    const uint32_t bit = 1u << (def.refineDepth + (extended ? 16 : 0));
    if (mesh.refinements & bit) return;
    mesh::RefineOptions options;
    if (extended) options = context_.backend.extendedRefineOptions(def.refineDepth);
    options.depth = def.refineDepth;
    float wall = 0;
    std::array<mesh::RefineHoles, gpu::kMaterialsPerObject> holes;
    for (uint32_t i = 0; i < gpu::kMaterialsPerObject; ++i) {
        if (!components::burns(object, i)) continue;
        wall = std::max(wall, object.materials[i].thickness);
        holes[i] =
            components::holesOf(components::materialAppearance(object.materials[i].appearance));
    }
    if (wall > 0) options.wall = std::clamp(wall, 1e-4f, 0.5f);
    const mesh::RefineModel model = mesh::bakeRefine(*mesh.domain, options, context_.memory);
    context_.backend.createRefinement(slot, def.refineDepth, extended, *mesh.domain, model, holes);
    mesh.refinements |= bit;
}

// Whether an object is drawn on its mesh's inner skin from inside, which is made for the first who
// is: as thick as its walls. What is cut has places of its own, so has what moves its vertices but
// for what recedes, and what never opens has nothing to look through.
bool Scene::innerSkin(MeshEntry& mesh, uint32_t slot, const components::BurnableMesh& object) {
    constexpr uint32_t kOthers = FW_BURNABLE_TWO_SIDED | FW_BURNABLE_NO_HOLES |
                                 FW_BURNABLE_NO_DAMAGE | FW_BURNABLE_SKINNED | FW_BURNABLE_REFINE |
                                 core::reserved::kRefinement | core::reserved::kDepth;
    const bool moves = components::deforms(object) && (object.flags & FW_BURNABLE_RECEDE) == 0;
    if ((object.flags & kOthers) != 0 || moves || !context_.backend.draws()) return false;
    if (mesh.innerSkin == InnerSkin::unknown) {
        float wall = 0;
        for (uint32_t i = 0; i < gpu::kMaterialsPerObject; ++i)
            if (components::burns(object, i) &&
                components::materialAppearance(object.materials[i].appearance).holeTime > 0)
                wall = std::max(wall, object.materials[i].thickness);
        if (!(wall > 0)) return false;
        wall = std::clamp(wall, 1e-4f, 0.5f);
        const std::pmr::vector<glm::vec3> inner =
            mesh::innerSkin(*mesh.domain, wall, context_.memory);
        mesh.innerWall = wall;
        if (!inner.empty()) context_.backend.createInnerSkin(slot, *mesh.domain, inner);
        mesh.innerSkin = inner.empty() ? InnerSkin::none : InnerSkin::there;
    }
    return mesh.innerSkin == InnerSkin::there;
}

// The boundary keeps up with the head of a fire that climbs.
gpu::HeatBoundary Scene::boundaryOf(const FwBurnableMeshDef& def,
                                    const components::BurnableMesh& object) const {
    float speed = 0;
    for (uint32_t i = 0; i < gpu::kMaterialsPerObject; ++i) {
        if (!components::burns(object, i)) continue;
        const FwMaterialDef& m = object.materials[i];
        speed = std::max(speed, m.spreadRate * (1 + m.headGain * std::min(m.upGain, m.driveMax)));
    }
    return {def.heatPsi, def.heatStep, speed * context_.def.paceFactor / object.pose.scale};
}

uint32_t Scene::skinnedSlot(FwBurnableMeshId id, uint32_t vertexCount) {
    const Object& object = *objects.get(id);
    if (!(object.data.flags & FW_BURNABLE_SKINNED))
        core::refuse("Burnable mesh %u was created without FW_BURNABLE_SKINNED.", id.index1);
    const uint32_t vertices = domainOf(object).report.vertices;
    if (vertexCount != vertices)
        core::refuse("vertexCount is %u; the mesh has %u vertices.", vertexCount, vertices);
    return object.slot;
}

void Scene::setHidden(FwBurnableMeshId id, bool hidden) {
    Object& object = *objects.get(id);
    setFlag(object.data.flags, FW_BURNABLE_HIDDEN, hidden);
    sendPose(object);
}

void Scene::sendPose(const Object& object) noexcept {
    gpu::vec4 rows[3];
    components::poseRows(object.data.pose, rows);
    context_.backend.setObjectPose(object.slot, rows,
                                   components::objectTint(object.data, domainOf(object)),
                                   components::objectFlags(object.data, domainOf(object)) |
                                       object.room1 << gpu::kObjectRoomShift);
}

void Scene::markMoved(Object& object) noexcept {
    if (object.exchangeDue) return;
    FW_ASSERT(moved.size() < moved.capacity(), "%zu objects moved", moved.size());
    object.exchangeDue = true;
    moved.push_back(object.slot);
}

void Scene::placeNow(const Object& object) {
    const mesh::BurnDomain& domain = domainOf(object);
    const components::Pose& pose = object.data.pose;
    double low[3], high[3];
    // The host has moved its vertices: they may be anywhere.
    for (int i = 0; i < 3; ++i) low[i] = -(high[i] = object.skinMoved ? kFarthest : -kFarthest);
    float longest = 0, shortest = components::kMaxStretch;
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
    places.place(object.slot, boxAround(low, high), 0);
}

std::span<const uint32_t> Scene::objectsNear(const mesh::Box& box, float margin) noexcept {
    nearSlots_.clear();  // capacity was reserved with each object
    const double most = std::ceil(1000.0 * std::max(double(margin), 0.0)) + 2;
    places.each(box, uint32_t(std::min(most, 2 * kFarthest)),
                [&](uint32_t slot) { nearSlots_.push_back(slot); });
    FW_ASSERT(nearSlots_.size() <= objects.live(), "%zu of %u objects", nearSlots_.size(),
              objects.live());
    std::sort(nearSlots_.begin(), nearSlots_.end());
    return nearSlots_;
}

std::span<const uint32_t> Scene::objectsNear(const float point[3], float margin) noexcept {
    double at[3];
    for (int i = 0; i < 3; ++i) at[i] = 1000.0 * double(point[i]);
    return objectsNear(boxAround(at, at), margin);
}

bool Scene::canBurn(const Object& object, uint32_t texel) const noexcept {
    const mesh::BurnDomain& domain = domainOf(object);
    return (object.slowness.empty() ? domain.slowness : object.slowness)[texel] != 0 &&
           components::burns(object.data, texelMaterial(object, texel));
}

uint32_t Scene::nearTexel(const Object& object, const float point[3], float reach) const noexcept {
    const mesh::BurnDomain& domain = domainOf(object);
    float inside[3];
    for (int i = 0; i < 3; ++i)
        inside[i] = std::clamp(point[i], domain.boundsLow[i], domain.boundsHigh[i]);
    const bool isFar = squaredDistance(inside, point) > reach * reach;
    return isFar && !object.skinMoved ? mesh::kNone : nearestTexel(object, point, reach);
}

const mesh::BurnDomain& Scene::domainOf(const Object& object) const noexcept {
    FW_ASSERT(meshes.findSlot(object.data.meshSlot), "no mesh in slot %u", object.data.meshSlot);
    return *meshes.at(object.data.meshSlot)->domain;
}

uint32_t Scene::texelMaterial(const Object& object, uint32_t texel) const noexcept {
    FW_ASSERT(texel < domainOf(object).texels.size(), "texel %u", texel);
    return domainOf(object).texels[texel].materialFlags & (gpu::kMaterialsPerObject - 1);
}

void Scene::texelPosition(const Object& object, uint32_t texel, float (&out)[3]) const noexcept {
    float place[3];
    texelPlace(object, texel, place);
    components::toWorld(object.data.pose, place, out);
}

void Scene::texelPlace(const Object& object, uint32_t texel, float (&out)[3]) const noexcept {
    const mesh::BurnDomain& domain = domainOf(object);
    restPlace(domain, texel, out);
    if (!object.skinMoved || domain.triangleOf[texel] == mesh::kNone) return;
    float weights[3];
    mesh::texelWeights(domain, texel, weights);
    std::fill_n(out, 3, 0.0f);
    for (size_t k = 0; k < 3; ++k) {
        const uint32_t vertex = domain.indices[size_t(domain.triangleOf[texel]) * 3 + k];
        FW_ASSERT(size_t(domain.sources[vertex]) * 3 + 2 < object.skin.size(), "vertex %u", vertex);
        const float* at = &object.skin[size_t(domain.sources[vertex]) * 3];
        for (int i = 0; i < 3; ++i) out[i] += weights[k] * at[i];
    }
}

uint32_t Scene::nearestTexel(const Object& object, const float point[3],
                             float reach) const noexcept {
    const mesh::BurnDomain& domain = domainOf(object);
    if (!object.skinMoved) return mesh::nearestTexel(domain, point, reach);
    uint32_t nearest = mesh::kNone;
    float least = reach * reach;
    for (uint32_t i = 0; i < domain.texelCount(); ++i) {
        if (!domain.real(i)) continue;
        float place[3];
        texelPlace(object, i, place);
        const float sum = squaredDistance(place, point);
        if (sum > least || (sum == least && nearest != mesh::kNone)) continue;
        least = sum;
        nearest = i;
    }
    return nearest;
}

float Scene::burningAreaOf(const Object& object) const noexcept {
    const auto& report = meshes.at(object.data.meshSlot)->domain->report;
    const float scale = object.data.pose.scale;
    const float texelArea =
        report.realTexels ? float(report.texelArea) / float(report.realTexels) : 0.0f;
    return float(object.counters.burning) * texelArea * scale * scale;
}

float Scene::powerOf(const Object& object) const noexcept {
    if (components::hasHeat(object.data)) return object.lifecycle.power;
    return burningAreaOf(object) *
           components::powerPerArea(object.data, meshes.at(object.data.meshSlot)->texelsOf);
}

void Scene::reserveSlots() {
    for (auto* slots : {&nearSlots_, &moved}) core::growTo(*slots, objects.slotCount());
    core::growTo(touched, objects.slotCount());
}

void Scene::shiftOrigin(const double (&by)[3]) noexcept {
    for (auto [i, object] : objects.entries()) {
        movePast(object.latch.pose.translation, by);
        sendPose(object);
        placeNow(object);
    }
}

void Scene::removeObject(const Object& object) noexcept {
    countImages(object.data, false);
    FW_ASSERT(meshes.at(object.data.meshSlot)->users > 0 && texels >= object.texels, "mesh %u",
              object.data.meshSlot);
    --meshes.at(object.data.meshSlot)->users;
    std::erase(touched, &object);
    std::erase(playing, &object);
    if (object.exchangeDue) std::erase(moved, object.slot);
    places.remove(object.slot);
    texels -= object.texels;
    countFuel(object, false);
}

}  // namespace fw::world
