#include "document/burn.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <iterator>
#include <utility>

#include "document/flame_curve.h"
#include "document/world_parts.h"
#include "flamewright/flamewright_debug.h"
#include "import/float_picture.h"
#include "model/baked_map.h"
#include "model/neutral_stage.h"

namespace fwedit {

struct BurnShared {
    struct MaterialKey {
        uint32_t preset;
        float thickness;  // m; 0: the preset's value
        bool ownColors;
        auto operator<=>(const MaterialKey&) const = default;
    };
    std::map<MaterialKey, FwMaterialId> materials;
    std::map<std::pair<const fwimport::DecodedImage*, float>, FwImageId> images;  // and its cut-off
    std::map<std::string, FwMeshId> meshes;                                       // by bake
    std::map<std::string, FwFireProfileId> profiles;
    FwFlipbookId flipbooks[FW_FLIPBOOK_PRESET_COUNT] = {};
};

namespace {

namespace fs = std::filesystem;
using fwimport::ImportedModel;
using fwmodel::ModelSurfaces;

FwMeshDef meshDefOf(const Mesh& mesh, const ImportedModel& model, const ModelSurfaces& surfaces) {
    FwMeshDef def = fwmodel::meshDefOf(model, surfaces);
    def.mapSize = mesh.mapSize;
    def.texelsPerMetre = mesh.texelsPerMetre;
    return def;
}

bool reportStage(const Assets& assets, const std::string& stage, float share) {
    return !assets.progress || assets.progress(stage, share);
}

bool createMesh(FwWorld* world, const std::vector<char>& bake, FwMeshId& id) {
    const FwMeshDef cooked = fwmodel::cookedDefOf(bake);
    return fwWorld_CreateMesh(world, &cooked, &id) == FW_OK;
}

FwMaterialId materialOf(Burn& burn, BurnShared& shared, const BurnShared::MaterialKey& key) {
    FwMaterialId& id = shared.materials[key];
    if (id.index1 != 0) return id;
    FwMaterialDef def = fwmodel::materialDefOf(key.preset, key.ownColors);
    if (key.thickness > 0) def.thickness = key.thickness;
    fwWorld_CreateMaterial(burn.world, &def, &id);
    return id;
}

FwImageId imageOf(Burn& burn, BurnShared& shared, const ImportedModel& model,
                  const fwmodel::SlotPicture& picture) {
    if (picture.image < 0) return {};
    const auto& decoded = model.images[static_cast<size_t>(picture.image)];
    FwImageId& id = shared.images[{&decoded, picture.alphaCutoff}];
    if (id.index1 != 0) return id;
    const FwImageDef def = fwmodel::imageDefOf(model, picture);
    fwWorld_CreateImage(burn.world, &def, &id);
    return id;
}

std::string addMesh(Burn& burn, BurnShared& shared, const Mesh& mesh, const PaintImages& images,
                    const fs::path& folder, Assets& assets) {
    std::string error;
    BurnMesh made;
    made.id = mesh.id;
    made.model = modelOf(mesh, folder, assets, error);
    if (!made.model) return error;
    const auto bake = bakeOf(burn.context, mesh, *made.model, assets, made.bake, error);
    if (!bake) return error;
    FwMeshId& meshId = shared.meshes[made.bake];
    if (meshId.index1 == 0 && !createMesh(burn.world, *bake, meshId)) {
        // An unreadable cached bake is rebuilt.
        assets.bakes.erase(made.bake);
        fwmodel::dropBake(assets.cache, made.bake);
        const auto again = bakeOf(burn.context, mesh, *made.model, assets, made.bake, error);
        if (!again) return error;
        if (!createMesh(burn.world, *again, meshId)) return worldProblem(burn, FW_ERROR_BAD_DATA);
    }
    made.mesh = meshId;
    FwBurnableMeshDef def = burnableDefOf(mesh);
    def.mesh = meshId;
    const ModelSurfaces surfaces = fwmodel::surfacesOf(*made.model);
    made.slots = surfaces.slotCount;
    if (surfaces.twoSided) def.flags |= static_cast<uint32_t>(FW_BURNABLE_TWO_SIDED);
    for (size_t slot = 0; slot < fwmodel::kSlots; ++slot) {
        def.materials[slot] =
            materialOf(burn, shared, {mesh.materials[slot], mesh.thickness, surfaces.ownColors()});
        def.baseColors[slot] = imageOf(burn, shared, *made.model, surfaces.pictures[slot]);
    }
    std::vector<FwPin> pins;
    for (const auto& pin : mesh.pins) {
        FwPin given{};
        std::copy_n(pin.begin(), 3, given.from);
        std::copy_n(pin.begin() + 3, 3, given.to);
        given.radius = pin[6];
        pins.push_back(given);
    }
    def.pins = pins.data();
    def.pinCount = static_cast<uint32_t>(pins.size());
    def.ground = burn.scene.settings.ground;
    const std::vector<uint8_t> multiplier =
        multiplierOf(burn.scene, images, mesh.id, def.multiplierWidth, def.multiplierHeight);
    if (!multiplier.empty()) def.multiplier = multiplier.data();
    const FwResult result = fwWorld_CreateBurnableMesh(burn.world, &def, &made.object);
    if (result < 0) return worldProblem(burn, result);
    burn.meshes.push_back(std::move(made));
    return "";
}

// The points identify a shape that is drawn by points.
std::string shapeKeyOf(const Flame& flame) {
    if (!hasCurve(flame)) return flame.profile;
    std::string key = "#";
    for (const Keys* keys : {&flame.outline, &flame.stops}) {
        for (const Key& at : *keys)
            key += std::to_string(at.time) + ":" + std::to_string(at.value) + " ";
        key += "/";
    }
    return key;
}

FwFireProfileId profileOf(Burn& burn, BurnShared& shared, const Flame& flame,
                          const fs::path& folder) {
    if (!hasShape(flame)) return {};
    const std::string key = shapeKeyOf(flame);
    FwFireProfileId& id = shared.profiles[key];
    if (id.index1 != 0) return id;
    FlameShape shape;
    std::string error;
    if (!shapeOf(flame, folder, shape, error)) {
        burn.report.push_back("The flame shape of \"" + flame.name +
                              "\" is its preset's: " + error);
        return {};
    }
    const FwFireProfileDef def = profileDefOf(shape);
    const FwResult result = fwWorld_CreateFireProfile(burn.world, &def, &id);
    if (result < 0)
        burn.report.push_back("The flame shape of \"" + flame.name +
                              "\" is its preset's: " + worldProblem(burn, result));
    return id;
}

FwFlipbookId flipbookOf(Burn& burn, BurnShared& shared, uint32_t preset) {
    FwFlipbookId& id = shared.flipbooks[preset];
    if (id.index1 != 0) return id;
    FwFlipbookDef def = fwDefaultFlipbookDef();
    def.preset = preset;
    fwWorld_CreateFlipbook(burn.world, &def, &id);
    return id;
}

void assignFlipbooks(Burn& burn, BurnShared& shared, FwFireEmitterDef& def) {
    def.fireFlipbooks[0] = flipbookOf(burn, shared, FW_FLIPBOOK_ROLL);
    def.fireFlipbooks[1] = flipbookOf(burn, shared, FW_FLIPBOOK_PUFF);
    def.smokeFlipbooks[0] = flipbookOf(burn, shared, FW_FLIPBOOK_SMOKE);
    def.sparkFlipbook = flipbookOf(burn, shared, FW_FLIPBOOK_SPARK);
}

void addSource(Burn& burn, BurnShared& shared, const HeatSource& source) {
    BurnPart part;
    part.id = source.id;
    FwResult result = FW_OK;
    if (source.shape == SourceFlamethrower) {
        FwFireEmitterDef def = jetDefOf(burn.scene, source);
        assignFlipbooks(burn, shared, def);
        result = fwWorld_CreateFireEmitter(burn.world, &def, &part.emitter);
    } else if (source.shape == SourcePoint || source.shape == SourceDisc ||
               source.shape == SourceLine) {
        for (const FwVolumetricFireDef& def : sourceFiresOf(burn.scene, source)) {
            FwVolumetricFireId fire{};
            if (result >= 0) result = fwWorld_CreateVolumetricFire(burn.world, &def, &fire);
            if (result >= 0) part.fires.push_back(fire);
        }
    }
    if (result < 0)
        burn.report.push_back("\"" + source.name + "\" is left out: " + worldProblem(burn, result));
    burn.parts.push_back(std::move(part));
}

void addFlame(Burn& burn, BurnShared& shared, const Flame& flame, const fs::path& folder) {
    BurnPart part;
    part.id = flame.id;
    FwVolumetricFireDef def = fireDefOf(burn.scene, flame);
    def.profile = profileOf(burn, shared, flame, folder);
    FwVolumetricFireId fire{};
    const FwResult result = fwWorld_CreateVolumetricFire(burn.world, &def, &fire);
    if (result < 0)
        burn.report.push_back("\"" + flame.name + "\" is left out: " + worldProblem(burn, result));
    else
        part.fires.push_back(fire);
    burn.parts.push_back(std::move(part));
}

void addEmitter(Burn& burn, BurnShared& shared, const Emitter& emitter) {
    BurnPart part;
    part.id = emitter.id;
    FwFireEmitterDef def = emitterDefOf(burn.scene, emitter);
    if (emitter.flipbooks) assignFlipbooks(burn, shared, def);
    for (const BurnMesh& mesh : burn.meshes)
        if (mesh.id == emitter.sticksTo) def.object = mesh.object;
    FwResult result = FW_ERROR_INVALID_ARGUMENT;
    if (emitter.shape != EmitterMesh || def.object.index1 != 0)
        result = fwWorld_CreateFireEmitter(burn.world, &def, &part.emitter);
    if (result < 0)
        burn.report.push_back("\"" + emitter.name + "\" is left out: " +
                              (emitter.shape == EmitterMesh && def.object.index1 == 0
                                   ? "it shows the fire of a mesh and sticks to none"
                                   : worldProblem(burn, result)));
    burn.parts.push_back(std::move(part));
}

void addCollider(Burn& burn, const Collider& collider) {
    BurnPart part;
    part.id = collider.id;
    const FwFireColliderDef def = colliderDefOf(burn.scene, collider);
    FwResult result = fwWorld_AddFireCollider(burn.world, &def, &part.collider);
    if (result >= 0 && collider.shields && collider.shape == ColliderBox) {
        const FwHeatOccluderDef occluderDef = heatOccluderDefOf(burn.scene, collider);
        result = fwWorld_AddHeatOccluder(burn.world, &occluderDef, &part.occluder);
    }
    if (result < 0)
        burn.report.push_back("\"" + collider.name +
                              "\" is left out: " + worldProblem(burn, result));
    burn.parts.push_back(std::move(part));
}

void addWind(Burn& burn, const Wind& wind) {
    if (wind.shape == WindEverywhere || wind.hidden) return;
    BurnPart part;
    part.id = wind.id;
    const FwWindZoneDef def = windZoneDefOf(burn.scene, wind, 0);
    const FwResult result = fwWorld_CreateWindZone(burn.world, &def, &part.zone);
    if (result < 0)
        burn.report.push_back("\"" + wind.name + "\" is left out: " + worldProblem(burn, result));
    burn.parts.push_back(std::move(part));
}

// Returns 0 while it is inactive, otherwise the factor of its keys.
template <typename T>
float factorOf(const T& object, double time) {
    const auto at = static_cast<float>(time);
    if (at < object.start || (object.duration > 0 && at >= object.start + object.duration))
        return 0;
    return std::max(0.0f, valueAt(object.keys, at));
}

bool water(Burn& burn, const HeatSource& source, double time, double delay, std::string& error) {
    const float rate = source.output * factorOf(source, time);
    if (!(rate > 0)) return true;
    const float radius = std::max(source.radius, 0.01f);
    const float area = 3.14159265f * radius * radius;
    // Water on the disc in an eighth of a second. Less than a gram accumulates until it is one.
    const float grams = rate * 1000 * static_cast<float>(kWateringStep) / area;
    const double every = std::max(1.0f, std::ceil(1 / std::max(grams, 1e-6f)));
    const double step = std::round(time / kWateringStep);
    if (every > 1e6 || std::fmod(step, every) != 0) return true;
    FwIgnitionDef def = fwDefaultIgnitionDef();
    def.kind = FW_WET;
    def.radius = radius;
    def.delay = static_cast<float>(std::max(0.0, delay));
    def.water = std::clamp(grams * static_cast<float>(every), 1.0f, 1023.0f);
    const Vec3 from = worldPosition(burn.scene, source.id);
    const Vec3 up = burn.scene.settings.up;
    const float fall = source.shape == SourceRain ? source.length : 0;
    for (float down = 0; down <= fall; down += 1.5f * radius) {
        for (size_t k = 0; k < 3; ++k) def.position[k] = from[k] - down * up[k];
        const FwResult result = fwWorld_Ignite(burn.world, &def, nullptr);
        if (result >= 0) continue;
        error = worldProblem(burn, result);
        return false;
    }
    return true;
}

bool feedSources(Burn& burn, double from, double to, std::string& error) {
    for (const HeatSource& source : burn.scene.sources) {
        if (source.shape == SourceMatch && source.start >= from && source.start < to) {
            FwIgnitionDef def = fwDefaultIgnitionDef();
            const Vec3 at = worldPosition(burn.scene, source.id);
            std::copy(at.begin(), at.end(), def.position);
            def.radius = source.radius;
            def.delay = static_cast<float>(source.start - from);
            const FwResult result = fwWorld_Ignite(burn.world, &def, nullptr);
            if (result < 0) {
                error = "\"" + source.name + "\" lights nothing: " + worldProblem(burn, result);
                return false;
            }
        }
        if (source.shape != SourceRain && source.shape != SourceWater) continue;
        for (double at = std::ceil(from / kWateringStep) * kWateringStep; at < to;
             at += kWateringStep)
            if (!water(burn, source, at, at - from, error)) return false;
    }
    return true;
}

// Applies output by keys and times, where it changed.
void feedParts(Burn& burn, double time) {
    for (BurnPart& part : burn.parts) {
        float factor = 0, power = 0, share = 1;
        if (const HeatSource* source = findIn(burn.scene.sources, part.id)) {
            factor = factorOf(*source, time);
            power = source->output;
            if (!part.fires.empty()) share = 1 / static_cast<float>(part.fires.size());
        } else if (const Flame* flame = findIn(burn.scene.flames, part.id)) {
            factor = factorOf(*flame, time);
            power = flame->power;
        } else if (const Emitter* emitter = findIn(burn.scene.emitters, part.id)) {
            factor = factorOf(*emitter, time);
            power = emitter->power;
        } else if (const Wind* wind = findIn(burn.scene.winds, part.id)) {
            factor = factorOf(*wind, time);
        }
        if (factor == part.lastFactor) continue;
        part.lastFactor = factor;
        if (part.zone.index1 != 0) {
            const FwWindZoneDef def =
                windZoneDefOf(burn.scene, *findIn(burn.scene.winds, part.id), factor);
            fwWorld_SetWindZone(burn.world, part.zone, &def);
        }
        const float now = std::min(kMaxPower, share * power * factor);
        for (const FwVolumetricFireId fire : part.fires)
            fwWorld_SetVolumetricFirePower(burn.world, fire, now);
        if (part.emitter.index1 != 0) fwWorld_SetFireEmitterPower(burn.world, part.emitter, now);
    }
}

// Returns the parts of a scene that a running burn cannot change.
Scene fixedPartOf(const Scene& scene) {
    Scene part;
    part.settings = scene.settings;
    const Settings usual;
    part.settings.duration = usual.duration;
    part.settings.framesPerSecond = usual.framesPerSecond;
    part.settings.wind = usual.wind;
    part.settings.daylight = usual.daylight;
    part.settings.light = usual.light;
    part.settings.sunDirection = usual.sunDirection;
    part.settings.exposure = usual.exposure;
    part.meshes = scene.meshes;
    for (Mesh& mesh : part.meshes) {
        mesh.name.clear();
        mesh.hidden = mesh.locked = false;
        mesh.position = mesh.rotation = {};
        mesh.scale = {1, 1, 1};
    }
    part.layers = scene.layers;
    for (PaintLayer& layer : part.layers) {
        layer.name.clear();
        layer.image.clear();  // a file name, assigned on save
        layer.locked = false;
    }
    return part;
}

template <typename T>
T unnamed(T object) {
    object.name.clear();
    object.hidden = object.locked = false;
    return object;
}

// A match that has ignited cannot move.
bool movesIgnitedMatch(const Burn& burn, const Scene& scene) {
    const auto struck = [&](const HeatSource& source) {
        return source.shape == SourceMatch && static_cast<double>(source.start) < burn.time;
    };
    const auto stands = [&](const HeatSource& source, const Scene& in, const Scene& other) {
        const HeatSource* same = findIn(other.sources, source.id);
        return same && unnamed(*same) == unnamed(source) &&
               worldPosition(in, source.id) == worldPosition(other, source.id);
    };
    for (const HeatSource& source : burn.scene.sources)
        if (struck(source) && !stands(source, burn.scene, scene)) return true;
    for (const HeatSource& source : scene.sources)
        if (struck(source) && !stands(source, scene, burn.scene)) return true;
    return false;
}

// ---- objects whose remaining fields differ are recreated

template <typename T>
T withoutPlacement(T object) {
    object = unnamed(std::move(object));
    object.position = {};
    object.sticksTo = 0;
    return object;
}
template <typename T>
T withoutTimes(T object) {
    object.start = object.duration = 0;
    return object;
}
HeatSource withoutAdjustables(const HeatSource& source) {
    HeatSource rest = withoutTimes(withoutPlacement(source));
    // A jet is created with a fixed capacity.
    if (source.shape == SourceFlamethrower) {
        rest.direction = {};
        return rest;
    }
    rest.output = 0;
    rest.keys.clear();
    return rest;
}
Flame withoutAdjustables(const Flame& flame) {
    Flame rest = withoutTimes(withoutPlacement(flame));
    rest.power = 0;
    rest.keys.clear();
    return rest;
}
Emitter withoutAdjustables(const Emitter& emitter) {
    Emitter rest = withoutTimes(unnamed(emitter));
    rest.position = {};
    return rest;  // its parent mesh provides its fire
}
Collider withoutAdjustables(const Collider& collider) { return unnamed(collider); }
// A zone is always set as a whole.
Wind withoutAdjustables(const Wind& wind) {
    Wind rest;
    rest.shape = wind.shape == WindEverywhere || wind.hidden ? WindEverywhere : WindBox;
    return rest;
}

void hide(const Burn& burn, const BurnPart& part, bool hidden) {
    for (const FwVolumetricFireId fire : part.fires)
        fwWorld_SetVolumetricFireHidden(burn.world, fire, hidden ? 1 : 0);
    if (part.emitter.index1 != 0)
        fwWorld_SetFireEmitterHidden(burn.world, part.emitter, hidden ? 1 : 0);
}

void adjust(const Burn& burn, BurnPart& part, const HeatSource& source) {
    part.lastFactor = -1;
    hide(burn, part, source.hidden);
    if (part.emitter.index1 != 0) {
        const FwFireEmitterDef def = jetDefOf(burn.scene, source);
        fwWorld_MoveFireEmitter(burn.world, part.emitter, def.position, def.direction);
        return;
    }
    const std::vector<FwVolumetricFireDef> defs = sourceFiresOf(burn.scene, source);
    for (size_t i = 0; i < std::min(defs.size(), part.fires.size()); ++i)
        fwWorld_MoveVolumetricFire(burn.world, part.fires[i], defs[i].position);
}
void adjust(const Burn& burn, BurnPart& part, const Flame& flame) {
    part.lastFactor = -1;
    hide(burn, part, flame.hidden);
    const FwVolumetricFireDef def = fireDefOf(burn.scene, flame);
    for (const FwVolumetricFireId fire : part.fires)
        fwWorld_MoveVolumetricFire(burn.world, fire, def.position);
}
void adjust(const Burn& burn, BurnPart& part, const Emitter& emitter) {
    part.lastFactor = -1;
    hide(burn, part, emitter.hidden);
    if (part.emitter.index1 == 0) return;
    const FwFireEmitterDef def = emitterDefOf(burn.scene, emitter);
    fwWorld_MoveFireEmitter(burn.world, part.emitter, def.position, def.direction);
}
void adjust(const Burn&, BurnPart& part, const Wind&) { part.lastFactor = -1; }
void adjust(const Burn& burn, BurnPart& part, const Collider& collider) {
    const FwFireColliderDef def = colliderDefOf(burn.scene, collider);
    if (part.collider.index1 != 0) fwWorld_SetFireCollider(burn.world, part.collider, &def);
    const FwHeatOccluderDef occluder = heatOccluderDefOf(burn.scene, collider);
    if (part.occluder.index1 != 0)
        fwWorld_MoveHeatOccluder(burn.world, part.occluder, occluder.transform);
}

void removePart(const Burn& burn, const BurnPart& part) {
    for (const FwVolumetricFireId fire : part.fires)
        fwWorld_DestroyVolumetricFire(burn.world, fire);
    if (part.emitter.index1 != 0) fwWorld_DestroyFireEmitter(burn.world, part.emitter);
    if (part.collider.index1 != 0) fwWorld_RemoveFireCollider(burn.world, part.collider);
    if (part.occluder.index1 != 0) fwWorld_RemoveHeatOccluder(burn.world, part.occluder);
    if (part.zone.index1 != 0) fwWorld_DestroyWindZone(burn.world, part.zone);
}

// Destroys the shape of a removed flame unless another flame uses it.
void destroyUnusedShape(const Burn& burn, BurnShared& shared, const Flame* flame) {
    if (!flame || !hasShape(*flame)) return;
    const auto shape = shared.profiles.find(shapeKeyOf(*flame));
    if (shape != shared.profiles.end() &&
        fwWorld_DestroyFireProfile(burn.world, shape->second) == FW_OK)
        shared.profiles.erase(shape);
}

}  // namespace

Burn::Burn() = default;
Burn::~Burn() { fwDestroyWorld(world); }

std::shared_ptr<const ImportedModel> modelOf(const Mesh& mesh, const fs::path& folder,
                                             Assets& assets, std::string& error) {
    if (mesh.file.empty()) {
        error = "\"" + mesh.name + "\" has no file";
        return nullptr;
    }
    std::error_code code;
    const fs::path path = fs::absolute(folder / mesh.file, code).lexically_normal();
    const auto changed = fs::last_write_time(path, code);
    // The key has the file's time, so a saved file is read again.
    const std::string key = path.string() + "@" +
                            std::to_string(code ? 0 : changed.time_since_epoch().count()) + "#" +
                            mesh.node;
    if (const auto found = assets.models.find(key); found != assets.models.end())
        return found->second;
    if (!reportStage(assets, "Reading " + path.filename().string(), 0)) {
        error = "stopped";
        return nullptr;
    }
    auto model = std::make_shared<ImportedModel>();
    if (!fwimport::importGltf(path, *model, error, mesh.node)) return nullptr;
    for (const std::string& note : fwmodel::surfacesOf(*model).notes) model->notes.push_back(note);
    return assets.models[key] = model;
}

bool nodePoseOf(const ImportedModel& model, const Mesh& mesh, std::string_view node, Pose& pose,
                std::string& error) {
    std::string why;
    const int32_t index = fwimport::findNode(model.nodes, node, why);
    if (index < 0) {
        error = fs::path(mesh.file).filename().string() + ": " + why;
        return false;
    }
    const auto& values = model.nodes[static_cast<size_t>(index)].pose;
    std::transform(values.begin(), values.end(), pose.begin(),
                   [](double value) { return static_cast<float>(value); });
    return true;
}

NodePoseOf nodePosesOf(const Burn& burn) {
    return [&burn](const Mesh& mesh, std::string_view node, Pose& pose, std::string& error) {
        for (const BurnMesh& made : burn.meshes)
            if (made.id == mesh.id && made.model)
                return nodePoseOf(*made.model, mesh, node, pose, error);
        error = "\"" + mesh.name + "\" is not in the scene yet";
        return false;
    };
}

std::shared_ptr<const std::vector<char>> bakeOf(FwContext* context, const Mesh& mesh,
                                                const ImportedModel& model, Assets& assets,
                                                std::string& key, std::string& error) {
    const ModelSurfaces surfaces = fwmodel::surfacesOf(model);
    const FwMeshDef def = meshDefOf(mesh, model, surfaces);
    key = fwmodel::bakeKeyOf(def);
    if (const auto found = assets.bakes.find(key); found != assets.bakes.end())
        return found->second;
    auto bytes = std::make_shared<std::vector<char>>();
    if (fwmodel::readBake(assets.cache, key, *bytes)) return assets.bakes[key] = bytes;
    if (!reportStage(assets, "Unwrapping " + mesh.name, 0)) {
        error = "stopped";
        return nullptr;
    }
    if (!fwmodel::cookMesh(context, def, *bytes, error)) return nullptr;
    reportStage(assets, "Unwrapping " + mesh.name, 1);
    fwmodel::keepBake(assets.cache, key, *bytes);
    return assets.bakes[key] = bytes;
}

std::string bakeKeyOf(const Mesh& mesh, const ImportedModel& model) {
    const ModelSurfaces surfaces = fwmodel::surfacesOf(model);
    return fwmodel::bakeKeyOf(meshDefOf(mesh, model, surfaces));
}

std::unique_ptr<Burn> createBurn(FwContext* context, const Scene& scene, const PaintImages& images,
                                 const fs::path& folder, Assets& assets, std::string& error) {
    auto burn = std::make_unique<Burn>();
    burn->context = context;
    burn->scene = scene;
    const FwWorldDef def = worldDefOf(scene);
    const FwResult result = fwCreateWorld(context, &def, &burn->world);
    if (result < 0) {
        error = worldProblem(*burn, result);
        return nullptr;
    }
    burn->surfaceOf = [context, folder, &assets](const Mesh& mesh) {
        std::string ignored;
        return paintSurfaceOf(context, mesh, folder, assets, ignored);
    };
    burn->shared = std::make_unique<BurnShared>();
    BurnShared& shared = *burn->shared;
    for (const Mesh& mesh : scene.meshes) {
        const std::string problem = addMesh(*burn, shared, mesh, images, folder, assets);
        if (!problem.empty())
            burn->report.push_back("\"" + mesh.name + "\" is left out: " + problem);
    }
    burn->scene = placedScene(scene, nodePosesOf(*burn), &burn->report);
    const Scene& placed = burn->scene;
    for (const HeatSource& source : placed.sources) addSource(*burn, shared, source);
    for (const Flame& flame : placed.flames) addFlame(*burn, shared, flame, folder);
    for (const Emitter& emitter : placed.emitters) addEmitter(*burn, shared, emitter);
    for (const Collider& collider : placed.colliders) addCollider(*burn, collider);
    for (const Wind& wind : placed.winds) addWind(*burn, wind);
    feedParts(*burn, 0);
    return burn;
}

bool feedBurn(Burn& burn, float deltaTime, std::string& error) {
    const double from = burn.time, to = burn.time + static_cast<double>(deltaTime);
    if (!feedSources(burn, from, to, error)) return false;
    feedParts(burn, from);
    if (!burn.scene.winds.empty()) {
        Vec3 wind = burn.scene.settings.wind;
        for (const Wind& gust : burn.scene.winds)
            for (size_t k = 0; k < 3 && gust.shape == WindEverywhere; ++k)
                wind[k] = std::clamp(wind[k] + gust.velocity[k] * factorOf(gust, from), -kMaxWind,
                                     kMaxWind);
        const FwResult result = fwWorld_SetWind(burn.world, wind.data());
        if (result < 0) {
            error = worldProblem(burn, result);
            return false;
        }
    }
    burn.time = to;
    return true;
}

bool reviseBurn(Burn& burn, const Scene& wanted, const fs::path& folder) {
    const Scene scene = placedScene(wanted, nodePosesOf(burn));
    if (!(fixedPartOf(burn.scene) == fixedPartOf(scene)) || movesIgnitedMatch(burn, scene))
        return false;
    const Scene before = std::exchange(burn.scene, scene);
    for (const BurnMesh& mesh : burn.meshes) {
        const Mesh& object = *findIn(scene.meshes, mesh.id);
        const std::array<float, 16> pose = transformOf(object);
        fwWorld_SetTransform(burn.world, mesh.object, pose.data());
        fwWorld_SetHidden(burn.world, mesh.object, object.hidden ? 1 : 0);
    }
    if (scene.settings.wind != before.settings.wind || scene.winds.empty())
        fwWorld_SetWind(burn.world, scene.settings.wind.data());
    std::vector<BurnPart> old = std::exchange(burn.parts, {});
    // Updates objects that only move, hide or change output. Recreates all others in place.
    const auto follow = [&](const auto& objects, const auto& formerly, auto&& add) {
        for (const auto& object : objects) {
            const auto part = std::find_if(old.begin(), old.end(),
                                           [&](const BurnPart& at) { return at.id == object.id; });
            const auto* former = findIn(formerly, object.id);
            if (part != old.end() && former &&
                withoutAdjustables(*former) == withoutAdjustables(object)) {
                adjust(burn, *part, object);
                burn.parts.push_back(std::move(*part));
            } else {
                if (part != old.end()) removePart(burn, *part);
                add(object);
            }
            if (part != old.end()) old.erase(part);
        }
    };
    BurnShared& shared = *burn.shared;
    follow(scene.sources, before.sources,
           [&](const HeatSource& source) { addSource(burn, shared, source); });
    follow(scene.flames, before.flames, [&](const Flame& flame) {
        destroyUnusedShape(burn, shared, findIn(before.flames, flame.id));
        addFlame(burn, shared, flame, folder);
    });
    follow(scene.emitters, before.emitters,
           [&](const Emitter& emitter) { addEmitter(burn, shared, emitter); });
    follow(scene.colliders, before.colliders,
           [&](const Collider& collider) { addCollider(burn, collider); });
    follow(scene.winds, before.winds, [&](const Wind& wind) { addWind(burn, wind); });
    for (const BurnPart& gone : old) {
        removePart(burn, gone);
        destroyUnusedShape(burn, shared, findIn(before.flames, gone.id));
    }
    return true;
}

namespace {

// Extends `low` and `high` by a placed model's box.
void addBounds(const Mesh& mesh, const ImportedModel& model, Vec3& low, Vec3& high) {
    const std::array<float, 16> m = transformOf(mesh);
    for (uint32_t corner = 0; corner < 8; ++corner) {
        Vec3 p;
        for (size_t k = 0; k < 3; ++k) p[k] = corner >> k & 1 ? model.high[k] : model.low[k];
        for (size_t r = 0; r < 3; ++r) {
            const float at = m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r];
            low[r] = std::min(low[r], at);
            high[r] = std::max(high[r], at);
        }
    }
}

// Returns false if there is no mesh.
bool boundsOf(const Burn& burn, Vec3& low, Vec3& high) {
    bool any = false;
    low = {1e30f, 1e30f, 1e30f};
    high = {-1e30f, -1e30f, -1e30f};
    for (const BurnMesh& mesh : burn.meshes) {
        const Mesh* object = findIn(burn.scene.meshes, mesh.id);
        if (!object || !mesh.model) continue;
        addBounds(*object, *mesh.model, low, high);
        any = true;
    }
    return any;
}

}  // namespace

Backdrop backdropOf(const Burn& burn) {
    Backdrop made;
    glm::vec3 low(-0.5f, 0, -0.5f), high(0.5f, 1, 0.5f);
    Vec3 least, most;
    made.any = boundsOf(burn, least, most);
    for (int c = 0; c < 3 && made.any; ++c) {
        low[c] = least[static_cast<size_t>(c)];
        high[c] = most[static_cast<size_t>(c)];
    }
    for (const BurnMesh& mesh : burn.meshes) {
        const Mesh* object = findIn(burn.scene.meshes, mesh.id);
        if (!object || !mesh.model) continue;
        const std::array<float, 16> values = transformOf(*object);
        glm::mat4 pose;
        std::memcpy(&pose[0][0], values.data(), sizeof pose);
        if (object->hidden) continue;
        const auto first = static_cast<uint32_t>(made.positions.size() / 3);
        const fwmodel::SolidTriangles solid =
            fwmodel::solidTrianglesOf(*mesh.model, fwmodel::surfacesOf(*mesh.model));
        for (size_t i = 0; i + 2 < solid.positions.size(); i += 3) {
            const glm::vec4 at(solid.positions[i], solid.positions[i + 1], solid.positions[i + 2],
                               1);
            const glm::vec3 p(pose * at);
            made.positions.insert(made.positions.end(), {p.x, p.y, p.z});
        }
        for (const uint32_t index : solid.indices) made.indices.push_back(first + index);
    }
    for (const Flame& flame : burn.scene.flames) {
        if (made.any) break;  // flames alone define the size
        const Vec3 place = worldPosition(burn.scene, flame.id);
        const glm::vec3 foot(place[0], place[1], place[2]);
        // Heskestad 1983: 0.235 Q^(2/5) - 1.02 D, m, kW; at least half as high as wide.
        const float tall =
            std::max(0.235f * std::pow(std::max(flame.power, 0.0f), 0.4f) - 1.02f * flame.diameter,
                     0.5f * flame.diameter);
        const float half = 0.5f * flame.diameter;
        low = glm::min(low, foot - glm::vec3(half, 0, half));
        high = glm::max(high, foot + glm::vec3(half, tall, half));
    }
    const glm::vec3 size = high - low;
    made.size = std::max({size.x, size.y, size.z, 0.05f});
    made.middle = {0.5f * (low.x + high.x), std::min(low.y, burn.scene.settings.ground),
                   0.5f * (low.z + high.z)};
    return made;
}

void requestHashes(const Burn& burn) {
    for (const BurnMesh& mesh : burn.meshes) fwDebug_RequestBurnMap(burn.world, mesh.object);
}

FwResult fetchHashes(const Burn& burn, std::vector<std::string>& lines) {
    lines.clear();
    for (const BurnMesh& mesh : burn.meshes) {
        uint64_t count = 0, hash = 0, tick = 0;
        const FwResult result =
            fwDebug_FetchBurnMap(burn.world, mesh.object, nullptr, 0, &count, &hash, &tick);
        if (result != FW_OK) return result;
        char numbers[64];
        std::snprintf(numbers, sizeof numbers, ": %016llx at tick %llu",
                      static_cast<unsigned long long>(hash), static_cast<unsigned long long>(tick));
        lines.push_back(findIn(burn.scene.meshes, mesh.id)->name + numbers);
    }
    return FW_OK;
}

bool runBurn(Burn& burn, double time, std::string& error) {
    const double frame = 1.0 / static_cast<double>(burn.scene.settings.framesPerSecond);
    while (burn.time < time - 1e-6) {
        const auto step = static_cast<float>(std::min(frame, time - burn.time));
        if (!feedBurn(burn, step, error)) return false;
        const FwResult result = fwWorld_Step(burn.world, step);
        if (result < 0) {
            error = worldProblem(burn, result);
            return false;
        }
    }
    return true;
}

FwView viewOf(const Scene& scene, uint32_t width, uint32_t height, double time) {
    const Camera& camera = scene.camera;
    const Settings& settings = scene.settings;
    FwView view = fwDefaultView();
    glm::vec3 up(settings.up[0], settings.up[1], settings.up[2]);
    up = glm::length(up) > 1e-6f ? glm::normalize(up) : glm::vec3(0, 1, 0);
    // Two axes perpendicular to up: yaw 0 looks along -z if up is y.
    const glm::vec3 level = std::abs(up.y) > 0.9f ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0);
    const glm::vec3 side = glm::normalize(glm::cross(up, level)), front = glm::cross(side, up);
    const float yaw = glm::radians(camera.yaw), pitch = glm::radians(camera.pitch);
    const glm::vec3 target(camera.target[0], camera.target[1], camera.target[2]);
    const glm::vec3 eye =
        target +
        camera.distance * (std::cos(pitch) * (std::sin(yaw) * side + std::cos(yaw) * front) +
                           std::sin(pitch) * up);
    const glm::mat4 matrix = glm::lookAtRH(eye, target, up);
    std::memcpy(view.view, &matrix[0][0], sizeof view.view);
    const float near = std::max(0.002f, 0.02f * camera.distance), far = 60 * camera.distance;
    const float aspect = static_cast<float>(width) / static_cast<float>(std::max(1u, height));
    fwmodel::setPerspective(view, glm::radians(camera.fieldOfView), aspect, near, far);

    // cd/m^2; the exposure adapts to the light.
    struct Light {
        float share, exposure;
    };
    static constexpr Light kLights[] = {{0.012f, 1 / 40.0f}, {1, 1 / 40.0f}, {12, 1 / 200.0f}};
    const Light& light = kLights[std::min<uint32_t>(settings.daylight, 2)];
    static constexpr float kSun[3] = {66.0f, 57.2f, 46.2f};
    static constexpr float kSky[3] = {13, 16, 22}, kGround[3] = {9, 8, 7};
    glm::vec3 sun(settings.sunDirection[0], settings.sunDirection[1], settings.sunDirection[2]);
    sun = glm::length(sun) > 1e-6f ? glm::normalize(sun) : up;
    for (int c = 0; c < 3; ++c) {
        view.sunDirection[c] = sun[c];
        view.sunColor[c] = light.share * settings.light * kSun[c];
        view.ambientSky[c] = light.share * settings.light * kSky[c];
        view.ambientGround[c] = light.share * settings.light * kGround[c];
    }
    view.exposure = light.exposure * settings.exposure;
    view.emissionScale = 40;
    view.time = static_cast<float>(time);
    return view;
}

namespace {

bool renderBurn(Burn& burn, FwOffscreenDef& def, std::vector<uint8_t>& rgba, std::string& error) {
    rgba.resize(size_t{def.width} * def.height * 4);
    def.pixels = rgba.data();
    const FwResult result = fwWorld_RenderOffscreen(burn.world, &def);
    if (result < 0) error = worldProblem(burn, result);
    return result >= 0;
}

}  // namespace

bool shootNeutral(Burn& burn, const fwmodel::NeutralCamera& camera, uint32_t width, uint32_t height,
                  std::vector<uint8_t>& rgba, std::string& error) {
    Vec3 low, high;
    if (!boundsOf(burn, low, high)) {
        error = "the scene has no mesh";
        return false;
    }
    FwOffscreenDef def = fwDefaultOffscreenDef();
    def.width = width;
    def.height = height;
    def.view = fwmodel::neutralView(low, high, camera, width, height);
    def.view.time = static_cast<float>(burn.time);
    std::copy(fwmodel::kNeutralBackground.begin(), fwmodel::kNeutralBackground.end(),
              def.background);
    def.background[3] = 1;
    return renderBurn(burn, def, rgba, error);
}

bool shootBurn(Burn& burn, uint32_t width, uint32_t height, std::vector<uint8_t>& rgba,
               std::string& error) {
    FwOffscreenDef def = fwDefaultOffscreenDef();
    def.width = width;
    def.height = height;
    def.view = viewOf(burn.scene, width, height, burn.time);
    static constexpr float kBehind[3][3] = {
        {0.002f, 0.0022f, 0.003f}, {0.02f, 0.021f, 0.025f}, {0.25f, 0.3f, 0.36f}};
    const uint32_t light = std::min<uint32_t>(burn.scene.settings.daylight, 2);
    for (size_t c = 0; c < 3; ++c) def.background[c] = kBehind[light][c];
    def.background[3] = 1;
    return renderBurn(burn, def, rgba, error);
}

bool shapeOf(const Flame& flame, const fs::path& folder, FlameShape& shape, std::string& error) {
    if (hasCurve(flame)) {
        shape = {kShapeWidth, kShapeHeight, texelsOfCurve(curveOf(flame)), {}};
        return true;
    }
    const fs::path file = folder / flame.profile;
    if (file.extension() == ".fwprofile") {
        std::ifstream stream(file, std::ios::binary);
        shape.cooked.assign(std::istreambuf_iterator<char>(stream), {});
        if (shape.cooked.empty()) error = file.string() + " cannot be read";
        return !shape.cooked.empty();
    }
    fwimport::FloatPicture picture;
    if (!fwimport::readPicture(file, picture, error)) return false;
    if (picture.channels < 2) {
        error = file.string() + " has no green channel";
        return false;
    }
    shape.width = picture.width;
    shape.height = picture.height;
    // Integer texels map to [0, 3000] K and [0, 2] of soot. The lowest row is the base.
    const float heat = picture.whole ? 3000.0f : 1.0f, soot = picture.whole ? 2.0f : 1.0f;
    for (uint32_t y = picture.height; y-- > 0;)
        for (uint32_t x = 0; x < picture.width; ++x) {
            shape.texels.push_back(std::clamp(picture.at(x, y, 0) * heat, 0.0f, 3000.0f));
            shape.texels.push_back(std::clamp(picture.at(x, y, 1) * soot, 0.0f, 2.0f));
        }
    return true;
}

FwFireProfileDef profileDefOf(const FlameShape& shape) {
    FwFireProfileDef def = fwDefaultFireProfileDef();
    if (!shape.cooked.empty()) {
        def.cooked = shape.cooked.data();
        def.cookedSize = shape.cooked.size();
    } else {
        def.width = shape.width;
        def.height = shape.height;
        def.texels = shape.texels.data();
    }
    return def;
}

bool sceneBounds(const Scene& scene, const fs::path& folder, Assets& assets, Vec3& low,
                 Vec3& high) {
    bool any = false;
    low = {1e30f, 1e30f, 1e30f};
    high = {-1e30f, -1e30f, -1e30f};
    for (const Mesh& mesh : scene.meshes) {
        std::string ignored;
        const auto model = modelOf(mesh, folder, assets, ignored);
        if (!model) continue;
        any = true;
        addBounds(mesh, *model, low, high);
    }
    return any;
}

std::shared_ptr<const PaintSurface> paintSurfaceOf(FwContext* context, const Mesh& mesh,
                                                   const fs::path& folder, Assets& assets,
                                                   std::string& error) {
    const auto model = modelOf(mesh, folder, assets, error);
    if (!model) return nullptr;
    std::string key;
    const auto bake = bakeOf(context, mesh, *model, assets, key, error);
    if (!bake) return nullptr;
    if (const auto found = assets.surfaces.find(key); found != assets.surfaces.end())
        return found->second;
    auto surface = std::make_shared<PaintSurface>();
    const std::vector<uint8_t> slots = fwmodel::surfacesOf(*model).triangleMaterials;
    if (!surfaceOfBake(context, *bake, *model, slots, *surface, error)) return nullptr;
    return assets.surfaces[key] = surface;
}

}  // namespace fwedit
