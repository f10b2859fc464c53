// See fire_village.h.
#include "fire_village.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "rays.h"

namespace tower {

using village::Kit;
using village::Material;
using village::Vec3;

namespace {

glm::vec3 toGlm(Vec3 v) { return {v.x, v.y, v.z}; }
Vec3 fromGlm(glm::vec3 v) { return {v.x, v.y, v.z}; }

// The frame's axes are orthogonal and of one length.
Vec3 toModel(const village::Frame& f, Vec3 world) {
    const Vec3 d = world - f.origin;
    const float scale2 = village::dot(f.x, f.x);
    return {village::dot(d, f.x) / scale2, village::dot(d, f.y) / scale2,
            village::dot(d, f.z) / scale2};
}

void toMatrix(const village::Frame& f, float* m) {
    const Vec3 columns[4] = {f.x, f.y, f.z, f.origin};
    for (int c = 0; c < 4; ++c) {
        m[c * 4 + 0] = columns[c].x;
        m[c * 4 + 1] = columns[c].y;
        m[c * 4 + 2] = columns[c].z;
        m[c * 4 + 3] = c == 3 ? 1.0f : 0.0f;
    }
}

// The burn materials are the library's triangle materials; what stands beyond the eighth cannot
// burn and joins the stone.
uint8_t triangleMaterial(Material m) {
    return uint8_t(m) < 8 ? uint8_t(m) : uint8_t(Material::kStone);
}

// One mesh def's arrays; they must live while the def is used.
struct MeshArrays {
    std::vector<float> positions, normals, uvs, details;
    std::vector<uint32_t> colors;
    std::vector<uint8_t> materials;
    FwMeshDef def;
};

void fillMesh(MeshArrays& arrays, const village::Model& model, const PaintedModel& painted) {
    for (size_t i = 0; i < model.vertices.size(); ++i) {
        const village::Vertex& v = model.vertices[i];
        arrays.positions.insert(arrays.positions.end(), {v.position.x, v.position.y, v.position.z});
        arrays.normals.insert(arrays.normals.end(), {v.normal.x, v.normal.y, v.normal.z});
        arrays.uvs.insert(arrays.uvs.end(), {v.uv.x, v.uv.y});
        arrays.details.insert(arrays.details.end(),
                              {v.uv.x * model.atlasSide, v.uv.y * model.atlasSide});
        // What the sky does not reach is darker, as in the host's own drawing.
        const uint32_t open = uint32_t(255 * std::min(1.0f, 0.35f + 0.65f * painted.openSky[i]));
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

}  // namespace

// Blades, cloth and roofs that burn through show their backs; closed lumps never do.
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

FireVillage::FireVillage(sample::FireHost& fire, const village::Scene& scene,
                         const PaintedVillage& painted, uint32_t seed)
    : fire_(fire), meshes_(scene.models.size()), images_(scene.models.size()), seed_(seed) {
    // The bake is the slow part and may run on any thread: cook first, create from the cooked.
    std::vector<std::vector<uint8_t>> cooked(scene.models.size());
    std::vector<std::string> troubles(scene.models.size());
    inParallel(int(scene.models.size()), [&](int i) {
        if (!canBurn(i)) return;
        const size_t m = size_t(i);
        MeshArrays arrays;
        fillMesh(arrays, scene.models[m], painted.models[m]);
        uint64_t size = 0;
        FwResult result = fwCookMesh(fire_.context, &arrays.def, nullptr, &size);
        cooked[m].resize(size);
        if (result == FW_OK)
            result = fwCookMesh(fire_.context, &arrays.def, cooked[m].data(), &size);
        if (result != FW_OK) troubles[m] = fwResultName(result);
    });
    for (size_t m = 0; m < cooked.size(); ++m)
        if (!troubles[m].empty())
            throw sample::Failure("fwCookMesh of \"" + scene.models[m].name + "\": " + troubles[m]);
    makeMaterials();
    for (size_t m = 0; m < scene.models.size(); ++m)
        if (canBurn(int(m))) makeModel(m, scene.models[m], painted.models[m], cooked[m]);
    makeThings(scene);
}

void FireVillage::makeMaterials() {
    auto make = [&](Material slot, uint32_t preset, float spread, float burning, float moisture,
                    uint32_t look) {
        FwMaterialDef def = fwDefaultMaterialDef();
        fire_.check(fwInitMaterialPreset(&def, preset), "fwInitMaterialPreset");
        def.spreadRate *= spread;
        def.moisture += moisture;
        def.burnTime *= burning;
        def.look = look;
        fire_.check(fwWorld_CreateMaterial(fire_.world, &def, &materials_[size_t(slot)]),
                    "fwWorld_CreateMaterial");
    };
    make(Material::kWood, FW_MATERIAL_PINE, 1.0f, 1.0f, 0, FW_MATERIAL_PINE);
    make(Material::kPaint, FW_MATERIAL_PAINTED_WOOD, 1.0f, 1.0f, 0, FW_MATERIAL_PAINTED_WOOD);
    make(Material::kThatch, FW_MATERIAL_THATCH, 1.0f, 1.7f, 0, FW_MATERIAL_THATCH);
    // Loose where thatch is bound. Leather's look has next to no ash: a burnt enemy must be black.
    make(Material::kStraw, FW_MATERIAL_THATCH, 3.0f, 1.0f, 0, FW_MATERIAL_LEATHER);
    make(Material::kLeaf, FW_MATERIAL_DRY_LEAF, 0.6f, 2.0f, 0.02f, FW_MATERIAL_DRY_LEAF);
    make(Material::kCloth, FW_MATERIAL_COTTON, 1.0f, 1.0f, 0, FW_MATERIAL_COTTON);
    // Stone and metal keep the null material, which cannot burn.
}

void FireVillage::makeModel(size_t model, const village::Model& source, const PaintedModel& painted,
                            const std::vector<uint8_t>& cooked) {
    FwMeshDef def = fwDefaultMeshDef();
    def.cooked = cooked.data();
    def.cookedSize = cooked.size();
    fire_.check(fwWorld_CreateMesh(fire_.world, &def, &meshes_[model]),
                ("fwWorld_CreateMesh of \"" + source.name + "\"").c_str());
    // The painting holds square roots; the library wants sRGB.
    uint8_t sRgb[256];
    for (int i = 0; i < 256; ++i) {
        const float c = float(i * i) / (255.0f * 255.0f);
        const float s = c < 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1 / 2.4f) - 0.055f;
        sRgb[i] = uint8_t(255 * s + 0.5f);
    }
    std::vector<uint8_t> pixels = painted.painting.color;
    for (size_t i = 0; i < pixels.size(); ++i) pixels[i] = i % 4 == 3 ? 255 : sRgb[pixels[i]];
    FwImageDef image = fwDefaultImageDef();
    image.width = painted.painting.width;
    image.height = painted.painting.height;
    image.pixels = pixels.data();
    fire_.check(fwWorld_CreateImage(fire_.world, &image, &images_[model]), "fwWorld_CreateImage");
}

void FireVillage::makeThings(const village::Scene& scene) {
    thingOf_.assign(scene.instances.size(), kNone);
    for (size_t i = 0; i < scene.instances.size(); ++i) {
        const village::Instance& instance = scene.instances[i];
        if (!canBurn(instance.model)) continue;
        const village::Model& model = scene.models[size_t(instance.model)];
        Thing thing;
        thing.instance = i;
        thing.frame = instance.frame;
        thing.low = model.low;
        thing.high = model.high;
        thing.moves = instance.roadMetres >= 0;
        FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
        // Until it catches, the host draws it: with its shadows, and for less.
        def.flags = FW_BURNABLE_HIDDEN;
        if (hasOpenSheets(instance.model)) def.flags |= FW_BURNABLE_TWO_SIDED;
        // Enemies end as black figures, not as nothing: the player must see what was felled.
        if (instance.roadMetres >= 0) def.flags |= FW_BURNABLE_NO_HOLES;
        def.mesh = meshes_[size_t(instance.model)];
        std::memcpy(def.materials, materials_, sizeof def.materials);
        def.baseColor = images_[size_t(instance.model)];
        toMatrix(instance.frame, def.transform);
        const float tint[3] = {instance.tint.x, instance.tint.y, instance.tint.z};
        std::memcpy(def.tint, tint, sizeof tint);
        def.userData = things.size();
        fire_.check(fwWorld_CreateBurnableMesh(fire_.world, &def, &thing.id),
                    "fwWorld_CreateBurnableMesh");
        thingOf_[i] = things.size();
        things.push_back(thing);
    }
}

bool FireVillage::ignite(size_t index, glm::vec3 place, float radius) {
    Thing& thing = things[index];
    FwIgnitionDef def = fwDefaultIgnitionDef();
    def.kind = FW_IGNITE;
    def.object = thing.id;
    for (int k = 0; k < 3; ++k) def.position[k] = place[k];
    def.radius = radius;
    uint32_t texels = 0;
    fire_.check(fwWorld_Ignite(fire_.world, &def, &texels), "fwWorld_Ignite");
    if (texels == 0) return false;
    if (!thing.lit) {
        thing.lit = true;
        ++caught_;
        thing.origin = toGlm(toModel(thing.frame, fromGlm(place)));
        fire_.check(fwWorld_SetHidden(fire_.world, thing.id, 0), "fwWorld_SetHidden");
    }
    return true;
}

void FireVillage::move(size_t index, const village::Frame& frame) {
    Thing& thing = things[index];
    thing.frame = frame;
    float transform[16];
    toMatrix(frame, transform);
    fire_.check(fwWorld_SetTransform(fire_.world, thing.id, transform), "fwWorld_SetTransform");
}

glm::vec3 FireVillage::fireCentre(const Thing& thing) const {
    // From where it caught towards its middle as the fire takes hold.
    const glm::vec3 middle = 0.5f * toGlm(thing.low + thing.high);
    const float share = std::min(1.0f, 1.5f * thing.state.burntFraction);
    return toGlm(thing.frame.point(fromGlm(glm::mix(thing.origin, middle, share))));
}

void FireVillage::pollEvents() {
    FwEvent events[64];
    while (const uint32_t count = fwWorld_PollEvents(fire_.world, events, 64)) {
        for (uint32_t i = 0; i < count; ++i) {
            if (events[i].type == FW_EVENT_BURNT_OUT && events[i].userData < things.size())
                things[size_t(events[i].userData)].over = true;
        }
    }
}

// A game's rule, not physics: a fire radiates a third of its power evenly, the wind carries
// more of it downwind, and a neighbour that has taken up enough catches where it is nearest.
void FireVillage::heatNeighbours(float deltaTime, glm::vec3 wind) {
    constexpr float kReach = 5.0f;         // m
    constexpr float kCriticalFlux = 4.0f;  // kW/m^2; less never lights anything
    constexpr float kDose = 22.0f;         // kJ/m^2 beyond that
    for (const Thing& source : things) {
        if (!source.lit || source.over || source.state.power <= 0) continue;
        const glm::vec3 centre = fireCentre(source);
        const float size = std::sqrt(source.state.burningArea / 3.1416f);
        for (size_t i = 0; i < things.size(); ++i) {
            Thing& other = things[i];
            if (other.lit || &other == &source) continue;
            const Vec3 local = toModel(other.frame, fromGlm(centre));
            const Vec3 nearest = village::minimum(village::maximum(local, other.low), other.high);
            const glm::vec3 place = toGlm(other.frame.point(nearest));
            const glm::vec3 way = place - centre;
            const float away = glm::length(way);
            const float gap = std::max(0.35f, away - std::min(size, 1.5f));
            if (gap > kReach) continue;
            const float downwind = glm::dot(way, wind) / std::max(0.1f, away);
            const float flux = 0.33e-3f * source.state.power / (4 * 3.1416f * gap * gap) *
                               std::clamp(1 + 0.25f * downwind, 0.3f, 3.0f);
            other.dose += deltaTime * std::max(0.0f, flux - kCriticalFlux);
            if (other.dose > kDose && !ignite(i, place, 0.45f))
                other.dose = 0.7f * kDose;  // a corner of its box; try again a little later
        }
    }
}

// Burning straw flies: a quarter of a second apart, each strong fire may throw a brand downwind.
// How far and whether is a hash of thing and moment, so that a seed tells one story.
void FireVillage::throwBrands(uint32_t slot, glm::vec3 wind) {
    constexpr float kPerMegawatt = 0.30f;  // brands in a quarter of a second
    const float speed = std::sqrt(wind.x * wind.x + wind.z * wind.z);
    if (speed < 0.5f) return;
    const glm::vec3 downwind(wind.x / speed, 0, wind.z / speed);
    const glm::vec3 across(-downwind.z, 0, downwind.x);
    for (size_t i = 0; i < things.size(); ++i) {
        if (!things[i].lit || things[i].over) continue;
        auto random = [&](uint32_t what) {
            return village::random01(int(i * 8 + what), int(slot), seed_ + 33);
        };
        const float megawatts = std::min(1.5f, 1e-6f * things[i].state.power);
        if (random(0) > kPerMegawatt * megawatts) continue;
        const float far = (0.4f + 0.9f * random(1)) * (1.0f + speed);
        landBrand(fireCentre(things[i]) + downwind * far + across * (1.6f * random(2) - 0.8f));
    }
}

// The front follows one surface; an arm, a hat or a rail is another. Flames lick from part to part:
// a few small touches within a reach that grows from where the thing first caught, upwards mostly.
void FireVillage::lickOtherParts(uint32_t slot) {
    constexpr float kGrowth = 0.16f;  // m in a quarter of a second
    constexpr uint32_t kTouches = 3;
    for (size_t i = 0; i < things.size(); ++i) {
        Thing& thing = things[i];
        if (!thing.lit || thing.over) continue;
        thing.reach += kGrowth;
        const Vec3 size = thing.high - thing.low;
        if (thing.reach > village::length(size)) continue;
        for (uint32_t k = 0; k < kTouches; ++k) {
            auto random = [&](uint32_t what) {
                return village::random01(int(i * 16 + k * 4 + what), int(slot), seed_ + 71);
            };
            const float high = random(0) * 1.5f - 0.5f, turn = 6.2832f * random(1);
            const float flat = thing.reach * (0.4f + 0.6f * random(2));
            Vec3 p = fromGlm(thing.origin) +
                     Vec3{flat * std::cos(turn), thing.reach * high, flat * std::sin(turn)};
            p = village::minimum(village::maximum(p, thing.low), thing.high);
            ignite(i, toGlm(thing.frame.point(p)), 0.22f);
        }
    }
}

// Comes down on whatever stands at the place and is not alight yet.
void FireVillage::landBrand(glm::vec3 place) {
    constexpr float kStep = 0.4f, kBall = 0.35f;  // m
    for (size_t i = 0; i < things.size(); ++i) {
        const Thing& thing = things[i];
        const Vec3 local = toModel(thing.frame, fromGlm(place));
        if (thing.lit || local.x < thing.low.x || local.x > thing.high.x || local.z < thing.low.z ||
            local.z > thing.high.z)
            continue;
        for (float y = thing.high.y; y > 0; y -= kStep)
            if (ignite(i, toGlm(thing.frame.point({local.x, y, local.z})), kBall)) return;
    }
}

void FireVillage::advance(float deltaTime, glm::vec3 wind) {
    constexpr float kSlot = 0.25f;  // s
    const uint32_t slot = uint32_t(time_ / kSlot);
    time_ += deltaTime;
    pollEvents();
    burning_ = 0;
    for (Thing& thing : things) {
        thing.rest = std::max(0.0f, thing.rest - deltaTime);
        if (!thing.lit || thing.over) continue;
        thing.state.structSize = sizeof thing.state;
        fire_.check(fwWorld_GetObjectState(fire_.world, thing.id, &thing.state),
                    "fwWorld_GetObjectState");
        burning_ += thing.state.burning > 0;
    }
    heatNeighbours(deltaTime, wind);
    if (uint32_t(time_ / kSlot) == slot) return;
    lickOtherParts(slot);
    throwBrands(slot, wind);
}

std::span<const PointLight> FireVillage::lights(float scale) {
    FwLight reported[16];
    const uint32_t count = fwWorld_GetLights(fire_.world, reported, 16);
    lights_.clear();
    for (uint32_t i = 0; i < std::min(count, 16u); ++i) {
        const FwLight& from = reported[i];
        PointLight light;
        // A little above the fuel: that is where the flame is, and roofs must not shade it.
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
