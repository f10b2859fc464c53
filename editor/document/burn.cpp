// See burn.h.
#include "document/burn.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <iterator>

#include "document/flame_curve.h"
#include "document/world_parts.h"
#include "import/content_hash.h"
#include "import/float_picture.h"

namespace fwedit {
namespace {

namespace fs = std::filesystem;
using fwimport::ImportedModel;

// What the plugin's mesh is made of: materials of the file in its eight slots, and colours.
struct Surfaces {
    std::vector<uint8_t> triangleMaterials;
    std::array<int32_t, 8> images;  // of the model by slot, -1: none
    std::vector<uint32_t> colors;   // empty: the material's own
};

Surfaces surfacesOf(const ImportedModel& model) {
    Surfaces result;
    result.images.fill(-1);
    bool own = model.hasColors || !model.images.empty();
    for (size_t i = 0; i < model.materials.size(); ++i) {
        const fwimport::ImportedMaterial& material = model.materials[i];
        int32_t& image = result.images[std::min<size_t>(i, 7)];
        if (image < 0) image = material.image;
        const auto& color = material.baseColor;
        own = own || color[0] != color[1] || color[1] != color[2];
    }
    for (const uint32_t material : model.triangleMaterials)
        result.triangleMaterials.push_back(static_cast<uint8_t>(std::min<uint32_t>(material, 7)));
    if (!own) return result;
    result.colors = model.colors;
    result.colors.resize(model.vertexCount(), 0xffffffffu);
    std::vector<bool> done(model.vertexCount(), false);
    for (size_t i = 0; i < model.indices.size(); ++i) {
        const uint32_t vertex = model.indices[i];
        if (done[vertex]) continue;
        done[vertex] = true;
        const auto& factor = model.materials[model.triangleMaterials[i / 3]].baseColor;
        uint32_t packed = 0xff000000u;
        for (uint32_t c = 0; c < 3; ++c) {
            const auto before = static_cast<float>(result.colors[vertex] >> (8 * c) & 255);
            packed |=
                static_cast<uint32_t>(std::lround(std::clamp(factor[c] * before, 0.0f, 255.0f)))
                << (8 * c);
        }
        result.colors[vertex] = packed;
    }
    return result;
}

FwMeshDef meshDefOf(const Mesh& mesh, const ImportedModel& model, const Surfaces& surfaces) {
    FwMeshDef def = fwDefaultMeshDef();
    def.positions = model.positions.data();
    def.normals = model.hasNormals ? model.normals.data() : nullptr;
    def.uvs = model.hasUvs || !model.images.empty() ? model.uvs.data() : nullptr;
    def.colors = surfaces.colors.empty() ? nullptr : surfaces.colors.data();
    def.indices = model.indices.data();
    def.triangleMaterials = surfaces.triangleMaterials.data();
    def.vertexCount = static_cast<uint32_t>(model.vertexCount());
    def.indexCount = static_cast<uint32_t>(model.indices.size());
    def.mapSize = mesh.mapSize;
    def.texelsPerMetre = mesh.texelsPerMetre;
    return def;
}

std::string bakeKey(const FwMeshDef& def, const Surfaces& surfaces, const ImportedModel& model) {
    fwimport::ContentHash hash;
    hash.addValue(fwGetVersion());
    hash.addValue(def.mapSize);
    hash.addValue(def.texelsPerMetre);
    hash.add(model.positions);
    if (def.normals) hash.add(model.normals);
    if (def.uvs) hash.add(model.uvs);
    hash.add(surfaces.colors);
    hash.add(model.indices);
    hash.add(surfaces.triangleMaterials);
    char name[40];
    std::snprintf(name, sizeof name, "%016llx", static_cast<unsigned long long>(hash.value));
    return name;
}

std::string contextMessage(FwContext* context) {
    char text[1024] = "";
    fwContext_GetLastMessage(context, text, sizeof text);
    return text;
}

bool goOn(const Assets& assets, const std::string& stage, float share) {
    return !assets.progress || assets.progress(stage, share);
}

bool createMesh(FwWorld* world, const std::vector<char>& bake, FwMeshId& id) {
    FwMeshDef cooked = fwDefaultMeshDef();
    cooked.cooked = bake.data();
    cooked.cookedSize = bake.size();
    return fwWorld_CreateMesh(world, &cooked, &id) == FW_OK;
}

// Materials and pictures that objects of one burn share.
struct Shared {
    std::map<std::pair<uint32_t, float>, FwMaterialId> materials;
    std::map<const fwimport::DecodedImage*, FwImageId> images;
    std::map<std::string, FwMeshId> meshes;  // by bake
    std::map<std::string, FwFireProfileId> profiles;
    FwFlipbookId books[FW_FLIPBOOK_PRESET_COUNT] = {};
};

FwMaterialId materialOf(Burn& burn, Shared& shared, uint32_t preset, float thickness) {
    if (preset == FW_MATERIAL_NONCOMBUSTIBLE) return {};
    FwMaterialId& id = shared.materials[{preset, thickness}];
    if (id.index1 != 0) return id;
    FwMaterialDef def = fwDefaultMaterialDef();
    fwInitMaterialPreset(&def, preset);
    if (thickness > 0) def.thickness = thickness;
    fwWorld_CreateMaterial(burn.world, &def, &id);
    return id;
}

std::string addMesh(Burn& burn, Shared& shared, const Mesh& mesh, const PaintImages& images,
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
        // A bake on the disk that cannot be read is made again.
        assets.bakes.erase(made.bake);
        std::error_code ignored;
        if (!assets.cache.empty()) fs::remove(assets.cache / (made.bake + ".fwburn"), ignored);
        const auto again = bakeOf(burn.context, mesh, *made.model, assets, made.bake, error);
        if (!again) return error;
        if (!createMesh(burn.world, *again, meshId)) return worldProblem(burn, FW_ERROR_BAD_DATA);
    }
    made.mesh = meshId;
    FwBurnableMeshDef def = burnableDefOf(mesh);
    def.mesh = meshId;
    const Surfaces surfaces = surfacesOf(*made.model);
    for (size_t slot = 0; slot < 8; ++slot) {
        def.materials[slot] = materialOf(burn, shared, mesh.materials[slot], mesh.thickness);
        if (surfaces.images[slot] < 0) continue;
        const auto& decoded = made.model->images[static_cast<size_t>(surfaces.images[slot])];
        FwImageId& image = shared.images[&decoded];
        if (image.index1 == 0) {
            FwImageDef imageDef = fwDefaultImageDef();
            imageDef.width = decoded.width;
            imageDef.height = decoded.height;
            imageDef.pixels = decoded.rgba.data();
            fwWorld_CreateImage(burn.world, &imageDef, &image);
        }
        def.baseColors[slot] = image;
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

FwFireProfileId profileOf(Burn& burn, Shared& shared, const Flame& flame, const fs::path& folder) {
    if (!hasShape(flame)) return {};
    // What is drawn by points is of that flame alone.
    const std::string key = hasCurve(flame) ? "#" + std::to_string(flame.id) : flame.profile;
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

FwFlipbookId bookOf(Burn& burn, Shared& shared, uint32_t preset) {
    FwFlipbookId& id = shared.books[preset];
    if (id.index1 != 0) return id;
    FwFlipbookDef def = fwDefaultFlipbookDef();
    def.preset = preset;
    fwWorld_CreateFlipbook(burn.world, &def, &id);
    return id;
}

void giveBooks(Burn& burn, Shared& shared, FwFireEmitterDef& def) {
    def.fireBooks[0] = bookOf(burn, shared, FW_FLIPBOOK_ROLL);
    def.fireBooks[1] = bookOf(burn, shared, FW_FLIPBOOK_PUFF);
    def.smokeBooks[0] = bookOf(burn, shared, FW_FLIPBOOK_SMOKE);
    def.sparkBook = bookOf(burn, shared, FW_FLIPBOOK_SPARK);
}

void addSource(Burn& burn, Shared& shared, const HeatSource& source) {
    BurnPart part;
    part.id = source.id;
    FwResult result = FW_OK;
    if (source.shape == SourceFlamethrower) {
        FwFireEmitterDef def = jetDefOf(burn.scene, source);
        giveBooks(burn, shared, def);
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

void addFlame(Burn& burn, Shared& shared, const Flame& flame, const fs::path& folder) {
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

void addEmitter(Burn& burn, Shared& shared, const Emitter& emitter) {
    BurnPart part;
    part.id = emitter.id;
    FwFireEmitterDef def = emitterDefOf(burn.scene, emitter);
    if (emitter.books) giveBooks(burn, shared, def);
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
    FwFireColliderId id{};
    const FwFireColliderDef def = colliderDefOf(burn.scene, collider);
    FwResult result = fwWorld_AddFireCollider(burn.world, &def, &id);
    if (result >= 0 && collider.shields && collider.shape == ColliderBox) {
        FwBlockerId blocker{};
        const FwBlockerDef blockerDef = blockerDefOf(burn.scene, collider);
        result = fwWorld_AddBlocker(burn.world, &blockerDef, &blocker);
    }
    if (result < 0)
        burn.report.push_back("\"" + collider.name +
                              "\" is left out: " + worldProblem(burn, result));
}

// 0 while it does not work, else the factor of its keys.
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
    // What falls on the disc in an eighth of a second; less than a gram waits until it is one.
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

// Output by keys and times; told to the plugin where it changed.
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
        }
        if (factor == part.lastFactor) continue;
        part.lastFactor = factor;
        const float now = std::min(kMostPower, share * power * factor);
        for (const FwVolumetricFireId fire : part.fires)
            fwWorld_SetVolumetricFirePower(burn.world, fire, now);
        if (part.emitter.index1 != 0) fwWorld_SetFireEmitterPower(burn.world, part.emitter, now);
    }
}

}  // namespace

Burn::~Burn() { fwDestroyWorld(world); }

std::shared_ptr<const ImportedModel> modelOf(const Mesh& mesh, const fs::path& folder,
                                             Assets& assets, std::string& error) {
    if (mesh.file.empty()) {
        error = "\"" + mesh.name + "\" names no file";
        return nullptr;
    }
    std::error_code code;
    const fs::path path = fs::absolute(folder / mesh.file, code).lexically_normal();
    const auto changed = fs::last_write_time(path, code);
    // A file that was saved anew is read anew.
    const std::string key =
        path.string() + "@" + std::to_string(code ? 0 : changed.time_since_epoch().count());
    if (const auto found = assets.models.find(key); found != assets.models.end())
        return found->second;
    if (!goOn(assets, "Reading " + path.filename().string(), 0)) {
        error = "stopped";
        return nullptr;
    }
    auto model = std::make_shared<ImportedModel>();
    if (!fwimport::importGltf(path, *model, error)) return nullptr;
    return assets.models[key] = model;
}

std::shared_ptr<const std::vector<char>> bakeOf(FwContext* context, const Mesh& mesh,
                                                const ImportedModel& model, Assets& assets,
                                                std::string& key, std::string& error) {
    const Surfaces surfaces = surfacesOf(model);
    const FwMeshDef def = meshDefOf(mesh, model, surfaces);
    key = bakeKey(def, surfaces, model);
    if (const auto found = assets.bakes.find(key); found != assets.bakes.end())
        return found->second;
    const fs::path file = assets.cache.empty() ? fs::path() : assets.cache / (key + ".fwburn");
    auto bytes = std::make_shared<std::vector<char>>();
    if (!file.empty()) {
        std::ifstream stream(file, std::ios::binary);
        bytes->assign(std::istreambuf_iterator<char>(stream), {});
        if (!bytes->empty()) return assets.bakes[key] = bytes;
    }
    if (!goOn(assets, "Unwrapping " + mesh.name, 0)) {
        error = "stopped";
        return nullptr;
    }
    uint64_t size = 0;
    if (fwCookMesh(context, &def, nullptr, &size) < 0) {
        error = contextMessage(context);
        return nullptr;
    }
    bytes->resize(size);
    if (fwCookMesh(context, &def, bytes->data(), &size) < 0) {
        error = contextMessage(context);
        return nullptr;
    }
    goOn(assets, "Unwrapping " + mesh.name, 1);
    if (!file.empty()) {
        std::error_code ignored;
        fs::create_directories(assets.cache, ignored);
        const fs::path fresh = file.string() + ".new";
        std::ofstream stream(fresh, std::ios::binary);
        stream.write(bytes->data(), static_cast<std::streamsize>(bytes->size()));
        stream.close();
        if (stream) fs::rename(fresh, file, ignored);
    }
    return assets.bakes[key] = bytes;
}

std::string bakeKeyOf(const Mesh& mesh, const ImportedModel& model) {
    const Surfaces surfaces = surfacesOf(model);
    return bakeKey(meshDefOf(mesh, model, surfaces), surfaces, model);
}

std::array<int32_t, 8> baseColorsOf(const ImportedModel& model) { return surfacesOf(model).images; }

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
    Shared shared;
    for (const Mesh& mesh : scene.meshes) {
        const std::string problem = addMesh(*burn, shared, mesh, images, folder, assets);
        if (!problem.empty())
            burn->report.push_back("\"" + mesh.name + "\" is left out: " + problem);
    }
    for (const HeatSource& source : scene.sources) addSource(*burn, shared, source);
    for (const Flame& flame : scene.flames) addFlame(*burn, shared, flame, folder);
    for (const Emitter& emitter : scene.emitters) addEmitter(*burn, shared, emitter);
    for (const Collider& collider : scene.colliders) addCollider(*burn, collider);
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
            for (size_t k = 0; k < 3; ++k)
                wind[k] = std::clamp(wind[k] + gust.velocity[k] * factorOf(gust, from), -kMostWind,
                                     kMostWind);
        const FwResult result = fwWorld_SetWind(burn.world, wind.data());
        if (result < 0) {
            error = worldProblem(burn, result);
            return false;
        }
    }
    burn.time = to;
    return true;
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
    // Two axes across up: yaw 0 looks along -z in a world whose up is y.
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
    const float scale = 1.0f / std::tan(0.5f * glm::radians(camera.fieldOfView));
    const float aspect = static_cast<float>(width) / static_cast<float>(std::max(1u, height));
    std::fill(std::begin(view.projection), std::end(view.projection), 0.0f);
    view.projection[0] = scale / aspect;
    view.projection[5] = -scale;
    view.projection[10] = far / (near - far);
    view.projection[11] = -1;
    view.projection[14] = near * far / (near - far);

    // cd/m^2; a camera's exposure goes with the light.
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
    rgba.resize(size_t{width} * height * 4);
    def.pixels = rgba.data();
    const FwResult result = fwWorld_RenderOffscreen(burn.world, &def);
    if (result < 0) error = worldProblem(burn, result);
    return result >= 0;
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
    // Whole numbers span 0 to 3000 K and 0 to 2 of soot; the picture's lowest row is the base.
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
        const std::array<float, 16> m = transformOf(mesh);
        for (uint32_t corner = 0; corner < 8; ++corner) {
            Vec3 p;
            for (size_t k = 0; k < 3; ++k) p[k] = corner >> k & 1 ? model->high[k] : model->low[k];
            for (size_t r = 0; r < 3; ++r) {
                const float at = m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r];
                low[r] = std::min(low[r], at);
                high[r] = std::max(high[r], at);
            }
        }
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
    const std::vector<uint8_t> slots = surfacesOf(*model).triangleMaterials;
    if (!surfaceOfBake(context, *bake, *model, slots, *surface, error)) return nullptr;
    return assets.surfaces[key] = surface;
}

}  // namespace fwedit
