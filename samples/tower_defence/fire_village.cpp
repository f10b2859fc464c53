#include "fire_village.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "battlefield.h"
#include "common/options.h"
#include "game/rules.h"
#include "placed.h"
#include "rays.h"

namespace tower {

using village::Kit;
using village::Material;
using village::Vec3;

namespace {

constexpr float kRoofIsGone = 0.2f;  // share of a house's surface
constexpr float kPartFalls = 1.5f;   // m^2

void toMatrix(const village::Frame& f, float* m) {
    const Vec3 columns[4] = {f.x, f.y, f.z, f.origin};
    for (int c = 0; c < 4; ++c) {
        m[c * 4 + 0] = columns[c].x;
        m[c * 4 + 1] = columns[c].y;
        m[c * 4 + 2] = columns[c].z;
        m[c * 4 + 3] = c == 3 ? 1.0f : 0.0f;
    }
}

// Materials of the village are the library's triangle materials. A mesh has eight; later ones count
// as stone.
uint8_t triangleMaterial(Material m) {
    return uint8_t(m) < 8 ? uint8_t(m) : uint8_t(Material::kStone);
}

// Arrays of a mesh def. They must outlive the def's use.
struct MeshArrays {
    std::vector<float> positions, normals, uvs, details;
    std::vector<uint32_t> colors;
    std::vector<uint8_t> materials;
    FwMeshDef def;
};

void fillMesh(MeshArrays& arrays, const village::Model& model, const PaintedModel* painted) {
    for (size_t i = 0; i < model.vertices.size(); ++i) {
        const village::Vertex& v = model.vertices[i];
        arrays.positions.insert(arrays.positions.end(), {v.position.x, v.position.y, v.position.z});
        arrays.normals.insert(arrays.normals.end(), {v.normal.x, v.normal.y, v.normal.z});
        arrays.uvs.insert(arrays.uvs.end(), {v.uv.x, v.uv.y});
        arrays.details.insert(arrays.details.end(),
                              {v.uv.x * model.atlasSide, v.uv.y * model.atlasSide});
        // Vertices that see less sky are darker, as in the host's own shading.
        const uint32_t open =
            uint32_t(255 * std::min(1.0f, 0.35f + 0.65f * (painted ? painted->openSky[i] : 1.0f)));
        arrays.colors.push_back(0xff000000u | open << 16 | open << 8 | open);
    }
    for (Material m : model.materials) arrays.materials.push_back(triangleMaterial(m));
    FwMeshDef& def = arrays.def;
    def = fwDefaultMeshDef();
    def.flags = FW_MESH_TRUST_UVS;
    def.positions = arrays.positions.data();
    def.normals = arrays.normals.data();
    def.uvs = arrays.uvs.data();
    def.details = arrays.details.data();
    def.colors = arrays.colors.data();
    def.indices = model.indices.data();
    def.triangleMaterials = arrays.materials.data();
    def.vertexCount = uint32_t(model.vertices.size());
    def.indexCount = uint32_t(model.indices.size());
    def.indexSize = 4;
    def.mapSize = uint32_t(model.burnTexels);
    def.texelsPerMetre = float(model.burnTexels) / model.atlasSide;
    def.noiseAmplitude = 0.35f;
    def.noiseFeature = 0.12f;
}

// Returns wooden corners that are far apart, the highest first.
std::vector<glm::vec3> beamsOf(const village::Model& model) {
    std::vector<glm::vec3> corners, chosen;
    for (size_t i = 0; i < model.indices.size(); ++i) {
        const Material material = model.materials[i / 3];
        if (material == Material::kWood || material == Material::kPaint)
            corners.push_back(toGlm(model.vertices[model.indices[i]].position));
    }
    std::vector<float> away(corners.size(), 1e9f);  // m^2, to the nearest chosen corner
    for (int k = 0; k < game::kBeams && !corners.empty(); ++k) {
        const auto far = std::max_element(away.begin(), away.end()) - away.begin();
        chosen.push_back(corners[size_t(far)]);
        for (size_t i = 0; i < corners.size(); ++i) {
            const glm::vec3 off = corners[i] - chosen.back();
            away[i] = std::min(away[i], glm::dot(off, off));
        }
    }
    std::stable_sort(chosen.begin(), chosen.end(),
                     [](const glm::vec3& a, const glm::vec3& b) { return a.y > b.y; });
    return chosen;
}

}  // namespace

// Blades, cloth and burnt roofs show their back faces; closed shapes never do.
static bool hasOpenSheets(int model) {
    switch (Kit(model)) {
        case Kit::kRailFence:
        case Kit::kBrokenRail:
        case Kit::kOak:
        case Kit::kPoplar:
        case Kit::kDeadTree:
        case Kit::kAutumnOak:
        case Kit::kBush:
        case Kit::kRoundBale:
        case Kit::kHayrick:
        case Kit::kBales:
        case Kit::kBarrel:
        case Kit::kCrate:
        case Kit::kWoodpile:
        case Kit::kLogKnight:
            return false;
        default:
            return true;
    }
}

bool canBurn(int model) {
    switch (Kit(model)) {
        case Kit::kFlowers:
        case Kit::kReeds:
        case Kit::kBrazier:
        case Kit::kFarOak:
        case Kit::kFarPine:
        case Kit::kFarAutumnOak:
        case Kit::kFlamethrower:
        case Kit::kFlamePlinth:
        case Kit::kEmberMortar:
        case Kit::kWaterCannon:
        case Kit::kWindFan:
            return false;
        default:
            return model < int(Kit::kCount);
    }
}

void checkFire(FwWorld* world, FwResult result, const char* what) {
    if (result == FW_OK || result == FW_NOTHING_THERE) return;
    char text[1024] = "";
    fwWorld_GetLastMessage(world, text, sizeof text);
    throw sample::Failure(std::string(what) + ": " + (text[0] ? text : fwResultName(result)));
}

FireVillage::FireVillage(FwContext* context, FwWorld* world, const village::Scene& scene,
                         const PaintedVillage* painted)
    : context_(context),
      world_(world),
      meshes_(scene.models.size()),
      images_(scene.models.size()),
      beams_(scene.models.size()),
      instances_(scene.instances) {
    // Baking is slow and may run on any thread, so cook all meshes in parallel, then create them.
    std::vector<std::vector<uint8_t>> cooked(scene.models.size());
    std::vector<std::string> troubles(scene.models.size());
    inParallel(int(scene.models.size()), [&](int i) {
        if (!canBurn(i)) return;
        const size_t m = size_t(i);
        MeshArrays arrays;
        fillMesh(arrays, scene.models[m], painted ? &painted->models[m] : nullptr);
        uint64_t size = 0;
        FwResult result = fwCookMesh(context_, &arrays.def, nullptr, &size);
        cooked[m].resize(size);
        if (result == FW_OK) result = fwCookMesh(context_, &arrays.def, cooked[m].data(), &size);
        if (result != FW_OK) troubles[m] = fwResultName(result);
    });
    for (size_t m = 0; m < cooked.size(); ++m)
        if (!troubles[m].empty())
            throw sample::Failure("fwCookMesh of \"" + scene.models[m].name + "\": " + troubles[m]);
    makeMaterials();
    for (size_t m = 0; m < scene.models.size(); ++m)
        if (canBurn(int(m)))
            makeModel(m, scene.models[m], painted ? &painted->models[m] : nullptr, cooked[m]);
    makeThings(scene);
}

void FireVillage::makeMaterials() {
    auto make = [&](Material slot, uint32_t preset, float spread, float burning, float moisture,
                    uint32_t look) {
        FwMaterialDef def = fwDefaultMaterialDef();
        check(fwInitMaterialPreset(&def, preset), "fwInitMaterialPreset");
        def.spreadRate *= spread;
        def.moisture += moisture;
        def.burnTime *= burning;
        def.appearance = look;
        check(fwWorld_CreateMaterial(world_, &def, &materials_[size_t(slot)]),
              "fwWorld_CreateMaterial");
    };
    make(Material::kWood, FW_MATERIAL_PINE, 1.0f, 1.0f, 0, FW_MATERIAL_PINE);
    make(Material::kPaint, FW_MATERIAL_PAINTED_WOOD, 1.0f, 1.0f, 0, FW_MATERIAL_PAINTED_WOOD);
    make(Material::kThatch, FW_MATERIAL_THATCH, 1.0f, 1.7f, 0, FW_MATERIAL_THATCH);
    // Looser than bound thatch. Leather leaves almost no ash, so burnt enemies look black.
    make(Material::kStraw, FW_MATERIAL_THATCH, 3.0f, 1.0f, 0, FW_MATERIAL_LEATHER);
    make(Material::kLeaf, FW_MATERIAL_DRY_LEAF, 0.6f, 2.0f, 0.02f, FW_MATERIAL_DRY_LEAF);
    make(Material::kCloth, FW_MATERIAL_COTTON, 1.0f, 1.0f, 0, FW_MATERIAL_COTTON);
    // Stone and metal keep the null material, which cannot burn.
}

void FireVillage::makeModel(size_t model, const village::Model& source, const PaintedModel* painted,
                            const std::vector<uint8_t>& cooked) {
    FwMeshDef def = fwDefaultMeshDef();
    def.cooked = cooked.data();
    def.cookedSize = cooked.size();
    check(fwWorld_CreateMesh(world_, &def, &meshes_[model]),
          ("fwWorld_CreateMesh of \"" + source.name + "\"").c_str());
    beams_[model] = beamsOf(source);
    if (!painted) return;
    // The painting stores square roots; the library expects sRGB.
    uint8_t sRgb[256];
    for (int i = 0; i < 256; ++i) {
        const float c = float(i * i) / (255.0f * 255.0f);
        const float s = c < 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1 / 2.4f) - 0.055f;
        sRgb[i] = uint8_t(255 * s + 0.5f);
    }
    std::vector<uint8_t> pixels = painted->painting.color;
    for (size_t i = 0; i < pixels.size(); ++i) pixels[i] = i % 4 == 3 ? 255 : sRgb[pixels[i]];
    FwImageDef image = fwDefaultImageDef();
    image.width = painted->painting.width;
    image.height = painted->painting.height;
    image.pixels = pixels.data();
    check(fwWorld_CreateImage(world_, &image, &images_[model]), "fwWorld_CreateImage");
}

void FireVillage::createObject(Thing& thing) {
    const village::Instance& instance = instances_[thing.instance];
    FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
    // The host draws an object until it ignites, with shadows and at lower cost. LITE: burnt areas
    // cost nothing, so a burning village runs in real time. Only houses store heat, which their
    // rooms need for flashover.
    def.flags = FW_BURNABLE_HIDDEN;
    if (isHouse(instance.model)) {
        def.breakShare = kRoofIsGone;
        def.breakArea = kPartFalls;
    } else {
        def.flags |= FW_BURNABLE_LITE;
    }
    if (hasOpenSheets(instance.model)) def.flags |= FW_BURNABLE_TWO_SIDED;
    // Enemies end as black figures instead of vanishing, so that the player sees the kills.
    if (instance.roadMetres >= 0) def.flags |= FW_BURNABLE_NO_HOLES;
    def.mesh = meshes_[size_t(instance.model)];
    std::memcpy(def.materials, materials_, sizeof def.materials);
    def.baseColor = images_[size_t(instance.model)];
    toMatrix(thing.frame, def.transform);
    const float tint[3] = {instance.tint.x, instance.tint.y, instance.tint.z};
    std::memcpy(def.tint, tint, sizeof tint);
    def.userData = size_t(&thing - things.data());
    check(fwWorld_CreateBurnableMesh(world_, &def, &thing.id), "fwWorld_CreateBurnableMesh");
}

void FireVillage::makeThings(const village::Scene& scene) {
    thingOf_.assign(scene.instances.size(), kNone);
    for (size_t i = 0; i < scene.instances.size(); ++i) {
        const village::Instance& instance = scene.instances[i];
        if (!canBurn(instance.model)) continue;
        const village::Model& model = scene.models[size_t(instance.model)];
        thingOf_[i] = things.size();
        Thing& thing = things.emplace_back();
        thing.instance = i;
        thing.frame = instance.frame;
        thing.low = model.low;
        thing.high = model.high;
        createObject(thing);
    }
}

void FireVillage::touch(uint32_t kind, glm::vec3 place, float radius, float water) {
    FwIgnitionDef def = fwDefaultIgnitionDef();
    def.kind = kind;
    for (int k = 0; k < 3; ++k) def.position[k] = place[k];
    def.radius = radius;
    def.water = water;
    check(fwWorld_Ignite(world_, &def, nullptr), "fwWorld_Ignite");
}

void FireVillage::ignite(glm::vec3 place, float radius) { touch(FW_IGNITE, place, radius, 0); }

void FireVillage::wet(glm::vec3 place, float radius, float water) {
    touch(FW_WET, place, radius, water);
}

void FireVillage::dropBeam(size_t index, size_t beam) {
    const Thing& thing = things[index];
    const auto& places = beams_[size_t(instances_[thing.instance].model)];
    if (beam >= places.size()) return;
    const glm::vec3 at = places[beam];
    ignite(toGlm(thing.frame.point({at.x, at.y, at.z})), 0.001f * float(game::kBeamBurns));
}

void FireVillage::move(size_t index, const village::Frame& frame) {
    Thing& thing = things[index];
    thing.frame = frame;
    float transform[16];
    toMatrix(frame, transform);
    check(fwWorld_SetTransform(world_, thing.id, transform), "fwWorld_SetTransform");
}

void FireVillage::replace(size_t index) {
    Thing& thing = things[index];
    check(fwWorld_DestroyBurnableMesh(world_, thing.id), "fwWorld_DestroyBurnableMesh");
    thing.lit = thing.over = thing.broken = false;
    thing.state = {};
    createObject(thing);
}

void FireVillage::observe() {
    FwEvent events[64];
    broke_ = 0;
    while (const uint32_t count = fwWorld_PollEvents(world_, events, 64)) {
        for (const FwEvent& event : std::span(events, count)) {
            if (event.userData >= things.size()) continue;
            Thing& thing = things[size_t(event.userData)];
            if (std::memcmp(&thing.id, &event.object, sizeof thing.id) != 0)
                continue;  // an event of a replaced object
            if (event.type == FW_EVENT_IGNITED && !thing.lit) {
                thing.lit = true;
                ++caught_;
                check(fwWorld_SetHidden(world_, thing.id, 0), "fwWorld_SetHidden");
            }
            if (event.type == FW_EVENT_IGNITED) thing.over = false;
            if (event.type == FW_EVENT_BURNT_OUT || event.type == FW_EVENT_EXTINGUISHED)
                thing.over = true;
            if (event.type == FW_EVENT_STRUCTURE_BROKE && !thing.broken) {
                thing.broken = true;
                ++broke_;
            }
        }
    }
    look();
}

void FireVillage::look() {
    burning_ = 0;
    for (Thing& thing : things) {
        if (!thing.lit) continue;
        thing.state.structSize = sizeof thing.state;
        check(fwWorld_GetObjectState(world_, thing.id, &thing.state), "fwWorld_GetObjectState");
        burning_ += thing.state.burning > 0;
    }
}

std::vector<uint8_t> FireVillage::flags() const {
    std::vector<uint8_t> flags;
    for (const Thing& thing : things)
        flags.push_back(uint8_t(thing.lit | thing.over << 1 | thing.broken << 2));
    return flags;
}

void FireVillage::restore(std::span<const uint8_t> flags) {
    for (size_t i = 0; i < things.size(); ++i) {
        Thing& thing = things[i];
        thing.lit = flags[i] & 1;
        thing.over = flags[i] >> 1 & 1;
        thing.broken = flags[i] >> 2;
        thing.state = {};
        check(fwWorld_SetHidden(world_, thing.id, !thing.lit), "fwWorld_SetHidden");
    }
    caught_ = uint32_t(
        std::count_if(things.begin(), things.end(), [](const Thing& thing) { return thing.lit; }));
    look();  // events of that frame stay in the world until the game's next step
}

std::span<const PointLight> FireVillage::lights(float scale) {
    FwLight reported[16];
    const uint32_t count = fwWorld_GetLights(world_, reported, 16);
    lights_.clear();
    for (uint32_t i = 0; i < std::min(count, 16u); ++i) {
        const FwLight& from = reported[i];
        PointLight light;
        // A little above the fuel, at the flame's centre, so that roofs do not shade it.
        light.place = {from.position[0], from.position[1] + 0.6f + 0.5f * from.radius,
                       from.position[2]};
        light.color =
            glm::vec3(from.color[0], from.color[1], from.color[2]) * (from.intensity * scale);
        light.size = std::max(0.5f, from.radius);
        const float strength = light.color.r + light.color.g + light.color.b;
        light.reach = std::clamp(2.8f * std::sqrt(strength), 2.5f, 15.0f);
        if (strength > 1e-3f) lights_.push_back(light);
    }
    return lights_;
}

}  // namespace tower
