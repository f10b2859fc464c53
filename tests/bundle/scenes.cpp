#include "bundle/scenes.h"

#include "bundle/shapes.h"
#include "common/yard.h"
#include "support/views.h"

#include <flamewright/flamewright_debug.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>

namespace fw::bundle {
namespace {

constexpr uint32_t kEveryTransfer =
    FW_WORLD_RADIATION | FW_WORLD_PLUME | FW_WORLD_CONTACT | FW_WORLD_EMBERS;

FwWorldDef worldDef(float pace, uint32_t flags) {
    FwWorldDef def = fwDefaultWorldDef();
    def.paceFactor = pace;
    def.flags = flags;
    return def;
}

FwMeshId addMesh(FwWorld* world, const Shape& shape, uint32_t mapSize, float texelsPerMetre) {
    FwMeshDef def = shape.def();
    def.mapSize = mapSize;
    def.texelsPerMetre = texelsPerMetre;
    FwMeshId id{};
    check(fwWorld_CreateMesh(world, &def, &id), world);
    return id;
}

void put(FwBurnableMeshDef& def, float x, float y, float z) {
    def.transform[12] = x, def.transform[13] = y, def.transform[14] = z;
}

// ---- scenes whose burn every machine must agree on --------------------------------------------

// Twelve crates that ignite each other in gusts. The wind turns, and water falls on one.
std::unique_ptr<Scene> makeCrates(uint32_t backend) {
    FwWorldDef def = worldDef(60, kEveryTransfer);
    def.wind[0] = 2, def.wind[2] = 0.5f;
    auto scene = std::make_unique<Scene>(backend, def);
    Scene* s = scene.get();
    FwGustDef gusts = fwDefaultGustDef();
    gusts.strength = 0.5f, gusts.size = 4;
    check(fwWorld_SetGusts(s->world, &gusts), s->world);
    const Yard yard = makeYard(s->world, 12);
    s->objects = yard.crates;
    for (const uint32_t crate : {0u, 1u, 5u}) lightCrate(s->world, yard, crate);
    s->commands = [s](uint32_t frame) {
        const float turned[3] = {-1, 0, 2};
        if (frame == 56) check(fwWorld_SetWind(s->world, turned), s->world);
        if (frame == 72) s->ball(FW_WET, 0.9f, 0.25f, 0.9f, 0.4f);
        if (frame == 100) s->ball(FW_IGNITE, 2.7f, 0.1f, 1.8f, 0.3f);
    };
    return scene;
}

// A jet with sticking fuel at the first of two houses in rooms, a burner under the eaves of the
// second, an occluder box between them, and a curtain of water.
std::unique_ptr<Scene> makeHouses(uint32_t backend) {
    FwWorldDef def = worldDef(20, kEveryTransfer);
    def.wind[0] = 1.5f;
    auto scene = std::make_unique<Scene>(backend, def);
    Scene* s = scene.get();
    FwBurnableMeshDef house = fwDefaultBurnableMeshDef();
    house.materials[0] = s->addMaterial(FW_MATERIAL_PINE);
    house.materials[1] = s->addMaterial(FW_MATERIAL_THATCH);
    const FwMeshId mesh = addMesh(s->world, makeHouse(), 256, 10);
    for (const float x : {0.0f, 6.5f}) {
        put(house, x, 0, 0);
        (void)s->addObject(mesh, house);
        FwRoomDef room = fwDefaultRoomDef();
        room.position[0] = x, room.position[1] = 1.25f;
        FwRoomId id{};
        check(fwWorld_CreateRoom(s->world, &room, &id), s->world);
    }
    FwFireEmitterDef jet = fwDefaultFireEmitterDef();
    jet.flags = FW_EMITTER_JET | FW_EMITTER_IGNITES;
    jet.power = 600, jet.stick = 0.5f;
    jet.position[1] = 1.2f, jet.position[2] = 6;
    jet.direction[1] = 0, jet.direction[2] = -1;
    FwFireEmitterId emitter{};
    check(fwWorld_CreateFireEmitter(s->world, &jet, &emitter), s->world);
    FwVolumetricFireDef burner = fwDefaultVolumetricFireDef();
    burner.flags = FW_FIRE_IGNITES;
    burner.power = 400, burner.diameter = 0.8f;
    burner.position[0] = 8.6f, burner.position[1] = 0.6f;
    FwVolumetricFireId fire{};
    check(fwWorld_CreateVolumetricFire(s->world, &burner, &fire), s->world);
    FwHeatOccluderDef wall = fwDefaultHeatOccluderDef();
    wall.transform[12] = 3.2f, wall.transform[13] = 1;
    wall.halfSize[0] = 0.05f, wall.halfSize[1] = 1, wall.halfSize[2] = 2.5f;
    FwHeatOccluderId occluder{};
    check(fwWorld_AddHeatOccluder(s->world, &wall, &occluder), s->world);
    FwParticleFieldDef water = fwDefaultParticleFieldDef();
    check(fwInitFieldPreset(&water, FW_FIELD_WATER), s->world);
    water.flags = FW_FIELD_WETS;
    water.position[0] = 1, water.position[1] = 0.2f, water.position[2] = 2.5f;
    water.size[0] = 1.5f, water.size[1] = 2;
    FwParticleFieldId field{};
    check(fwWorld_CreateParticleField(s->world, &water, &field), s->world);
    s->commands = [s, emitter](uint32_t frame) {
        const float nozzle[3] = {0, 1.2f, 6};
        const float aim[3] = {float(frame % 32) / 32 - 0.5f, 0.25f * float(frame % 5) / 4, -4};
        check(fwWorld_MoveFireEmitter(s->world, emitter, nozzle, aim), s->world);
        if (frame == 64) check(fwWorld_SetFireEmitterPower(s->world, emitter, 0), s->world);
    };
    return scene;
}

// An animal without UVs that walks while it burns and is put out and lit again. Its burn goes to a
// coarser mesh. A cloth hangs behind it.
std::unique_ptr<Scene> makeWalk(uint32_t backend) {
    auto scene = std::make_unique<Scene>(backend, worldDef(16, kEveryTransfer));
    Scene* s = scene.get();
    FwBurnableMeshDef leather = fwDefaultBurnableMeshDef();
    leather.materials[0] = s->addMaterial(FW_MATERIAL_LEATHER);
    const FwBurnableMeshId fine = s->addObject(addMesh(s->world, makeAnimal(24), 256, 96), leather);
    const FwBurnableMeshId coarse =
        s->addObject(addMesh(s->world, makeAnimal(12), 128, 64), leather);
    FwBurnableMeshDef cloth = fwDefaultBurnableMeshDef();
    cloth.flags = FW_BURNABLE_SHELL;
    cloth.materials[0] = s->addMaterial(FW_MATERIAL_COTTON);
    put(cloth, 0.2f, 0, -0.55f);
    const FwPin pin = {{-0.6f, 1.2f, 0}, {0.6f, 1.2f, 0}, 0.05f, 0};
    cloth.pins = &pin;
    cloth.pinCount = 1;
    (void)s->addObject(addMesh(s->world, makeSheet(1.2f, 1.2f, 16), 128, 96), cloth);
    s->ball(FW_IGNITE, 0, 0.3f, 0.5f, 0.15f);
    s->ball(FW_IGNITE, 0.3f, 0.2f, -0.55f, 0.1f);
    s->commands = [s, fine, coarse](uint32_t frame) {
        float at[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
        at[12] = 0.01f * float(frame % 40);
        check(fwWorld_SetTransform(s->world, fine, at), s->world);
        if (frame == 40) s->ball(FW_EXTINGUISH, 0, 0.4f, 0.3f, 0.5f);
        if (frame == 48) s->ball(FW_IGNITE, 0.1f, 0.8f, 0, 0.3f);
        if (frame == 100) check(fwWorld_TransferBurn(s->world, fine, coarse), s->world);
    };
    return scene;
}

struct HashedScene {
    const char* name;
    std::unique_ptr<Scene> (*make)(uint32_t backend);
};
constexpr HashedScene kHashedScenes[] = {
    {"crates", makeCrates}, {"houses", makeHouses}, {"walk", makeWalk}};
constexpr uint32_t kHashedFrames = 128, kFramesPerHash = 32;
constexpr float kHashedFrameTime = 0.125f;  // s: four steps

// ---- scenes whose passes are timed ------------------------------------------------------------

std::unique_ptr<Scene> makeTimed(FwWorldDef def) {
    def.maxStepsPerFrame = 64;
    return std::make_unique<Scene>(FW_BACKEND_VULKAN, def);
}

// Places a house of the i-th plot: five on each side of a street along z.
void putHouse(FwBurnableMeshDef& def, uint32_t i) {
    const float across = 5.0f + 7.0f * float(i % 10 / 2), along = -7.5f * float(i / 10);
    put(def, i % 2 ? across : -across, 0, along);
    const float shade = 0.8f + 0.05f * float(i * 7 % 5);
    std::fill_n(def.tint, 3, shade);
}

void addHouses(Scene& s, uint32_t count, uint32_t flags) {
    FwBurnableMeshDef house = fwDefaultBurnableMeshDef();
    house.flags = flags;
    house.materials[0] = s.addMaterial(FW_MATERIAL_PINE);
    house.materials[1] = s.addMaterial(FW_MATERIAL_THATCH);
    const FwMeshId mesh = addMesh(s.world, makeHouse(), 256, 12);
    for (uint32_t i = 0; i < count; ++i) {
        putHouse(house, i);
        (void)s.addObject(mesh, house);
        const float x = house.transform[12], z = house.transform[14];
        s.ball(FW_IGNITE, x + (i % 2 ? -2.2f : 2.2f), 2.2f, z + 1 - float(i % 3), 0.4f);
        s.ball(FW_IGNITE, x, 0.3f, z + 2.5f, 0.4f);
    }
}

void addFlame(const Scene& s, uint32_t preset, float x, float y, float z, float power,
              float diameter) {
    FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
    check(fwInitFirePreset(&def, preset), s.world);
    def.position[0] = x, def.position[1] = y, def.position[2] = z;
    if (power > 0) def.power = power, def.diameter = diameter;
    FwVolumetricFireId id{};
    check(fwWorld_CreateVolumetricFire(s.world, &def, &id), s.world);
}

std::unique_ptr<Scene> makeSiege() {
    auto scene = makeTimed(worldDef(14, kEveryTransfer));
    Scene* s = scene.get();
    addHouses(*s, 20, 0);
    for (uint32_t i = 0; i < 8; ++i)
        addFlame(*s, FW_FIRE_BONFIRE, i % 2 ? 1.2f : -1.2f, 0, 6.5f - 3.2f * float(i / 2), 250,
                 0.9f);
    std::vector<FwFireEmitterId> jets(10);
    for (uint32_t i = 0; i < jets.size(); ++i) {
        FwFireEmitterDef jet = fwDefaultFireEmitterDef();
        jet.flags = FW_EMITTER_JET | FW_EMITTER_IGNITES | FW_EMITTER_GROUND;
        jet.power = 700;
        jet.position[0] = 4.2f * float(i) - 19;
        jet.position[1] = 1.4f, jet.position[2] = 11;
        check(fwWorld_CreateFireEmitter(s->world, &jet, &jets[i]), s->world);
    }
    s->commands = [s, jets](uint32_t frame) {
        for (uint32_t i = 0; i < jets.size(); ++i) {
            const uint32_t turn = (frame + 5 * i) % 40;
            const float sweep = 0.04f * float(turn < 20 ? turn : 40 - turn) - 0.4f;
            const float nozzle[3] = {4.2f * float(i) - 19, 1.4f, 11}, aim[3] = {sweep, 0.12f, -1};
            check(fwWorld_MoveFireEmitter(s->world, jets[i], nozzle, aim), s->world);
        }
    };
    const float eye[3] = {9, 9.5f, 22}, target[3] = {0, 1.2f, -1};
    std::copy_n(eye, 3, s->eye);
    std::copy_n(target, 3, s->target);
    return scene;
}

std::unique_ptr<Scene> makeStreet() {
    FwWorldDef def = worldDef(20, 0);
    def.maxRefinedTriangles = 60000;
    auto scene = makeTimed(def);
    addHouses(*scene, 100, FW_BURNABLE_LITE | FW_BURNABLE_REFINE);
    const float eye[3] = {0, 4.8f, 12}, target[3] = {0, 2.2f, -8};
    std::copy_n(eye, 3, scene->eye);
    std::copy_n(target, 3, scene->target);
    scene->zoom = 1.8f;
    return scene;
}

std::unique_ptr<Scene> makeManyCrates() {
    auto scene = makeTimed(worldDef(10, 0));
    const Yard yard = makeYard(scene->world, 300);
    for (uint32_t i = 0; i < yard.crates.size(); ++i) lightCrate(scene->world, yard, i);
    scene->objects = yard.crates;
    const float eye[3] = {7.6f, 4.6f, 20}, target[3] = {7.6f, 0.2f, 10};
    std::copy_n(eye, 3, scene->eye);
    std::copy_n(target, 3, scene->target);
    return scene;
}

std::unique_ptr<Scene> makeFlames() {
    auto scene = makeTimed(worldDef(1, 0));
    for (uint32_t i = 0; i < 256; ++i)
        addFlame(*scene, i % 4 == 3 ? FW_FIRE_TORCH : FW_FIRE_CAMP, 1.6f * (float(i % 16) - 7.5f),
                 0, -1.8f * float(i / 16), 0, 0);
    const float eye[3] = {0, 4.5f, 9}, target[3] = {0, 0.6f, -8};
    std::copy_n(eye, 3, scene->eye);
    std::copy_n(target, 3, scene->target);
    return scene;
}

std::unique_ptr<Scene> makeParticles() {
    FwWorldDef def = worldDef(1, 0);
    def.maxParticles = 100000;
    auto scene = makeTimed(def);
    for (uint32_t i = 0; i < 10; ++i) {
        FwFireEmitterDef fire = fwDefaultFireEmitterDef();
        fire.shape = FW_EMITTER_DISC;
        fire.radius = 0.7f, fire.life = 1, fire.lifeVariance = 0, fire.power = 400;
        fire.maxParticles = 10000, fire.rate = 10000;  // all alive, always
        fire.size0 = 0.12f, fire.size1 = 0.3f, fire.speed = 2.5f;
        fire.position[0] = 2.6f * (float(i % 5) - 2), fire.position[2] = -4.0f * float(i / 5);
        FwFireEmitterId id{};
        check(fwWorld_CreateFireEmitter(scene->world, &fire, &id), scene->world);
    }
    const float eye[3] = {0, 3, 14}, target[3] = {0, 2.2f, 0};
    std::copy_n(eye, 3, scene->eye);
    std::copy_n(target, 3, scene->target);
    return scene;
}

std::unique_ptr<Scene> makeBunny() {
    auto scene = makeTimed(worldDef(8, 0));
    FwBurnableMeshDef animal = fwDefaultBurnableMeshDef();
    animal.flags = FW_BURNABLE_RECEDE;
    animal.materials[0] = scene->addMaterial(FW_MATERIAL_PINE);
    (void)scene->addObject(addMesh(scene->world, makeAnimal(72), 1024, 400), animal);
    scene->ball(FW_IGNITE, 0, 0.25f, 0.5f, 0.12f);
    scene->ball(FW_IGNITE, 0.3f, 0.3f, 0.1f, 0.1f);
    const float eye[3] = {-0.7f, 0.85f, 1.9f}, target[3] = {0, 0.5f, 0};
    std::copy_n(eye, 3, scene->eye);
    std::copy_n(target, 3, scene->target);
    return scene;
}

constexpr TimedScene kTimedScenes[] = {
    {"siege", "10 flamethrowers, 20 burning houses, 8 volumetric flames", makeSiege, 5},
    {"houses100", "100 burning houses, refined", makeStreet, 5},
    {"crates300", "300 burning crates", makeManyCrates, 4},
    {"flames256", "256 volumetric flames", makeFlames, 1},
    {"particles100k", "100,000 particles", makeParticles, 1.5f},
    {"bunny", "an animal of 62,208 triangles, burn map of 1024 x 1024", makeBunny, 8},
};

}  // namespace

Scene::Scene(uint32_t backend, const FwWorldDef& def) {
    FwContextDef contextDef = fwDefaultContextDef();
    contextDef.backend = backend;
    FwErrorInfo error{};
    if (fwCreateContext(&contextDef, &context, &error) != FW_OK)
        throw std::runtime_error(error.message);
    if (fwCreateWorld(context, &def, &world) != FW_OK) {
        char why[512] = "";
        fwContext_GetLastMessage(context, why, sizeof why);
        fwDestroyContext(context);
        throw std::runtime_error(why);
    }
}

Scene::~Scene() {
    fwDestroyWorld(world);
    fwDestroyContext(context);
}

void Scene::advance(float seconds) {
    commands(frame_++);
    time_ += seconds;
    check(fwWorld_Step(world, seconds), world);
}

uint64_t Scene::burnHash() {
    for (const FwBurnableMeshId id : objects) check(fwDebug_RequestBurnMap(world, id), world);
    check(fwWorld_Step(world, 0), world);  // a device's frame that brings them
    uint64_t all = 0;
    for (const FwBurnableMeshId id : objects) {
        uint64_t one = 0;
        const FwResult got = fwDebug_FetchBurnMap(world, id, nullptr, 0, nullptr, &one, nullptr);
        if (got == FW_NOT_READY) throw std::runtime_error("a burn map did not arrive");
        check(got, world);
        all = all * 0x9E3779B97F4A7C15ull + one;
    }
    return all;
}

uint32_t Scene::ignitedTexels() const {
    uint32_t sum = 0;
    for (const FwBurnableMeshId id : objects) {
        FwObjectState state{};
        state.structSize = sizeof state;
        check(fwWorld_GetObjectState(world, id, &state), world);
        sum += state.ignited;
    }
    return sum;
}

FwView Scene::view(float aspect) const {
    FwView out = test::viewAt(glm::make_vec3(eye), glm::make_vec3(target), aspect, zoom);
    // Dusk, in which fire shows and what burns is still seen.
    const auto dim = [](float(&light)[3], float factor) {
        for (float& channel : light) channel *= factor;
    };
    dim(out.sunColor, 0.15f);
    dim(out.ambientSky, 0.5f);
    dim(out.ambientGround, 0.5f);
    out.time = time_;
    return out;
}

FwMaterialId Scene::addMaterial(uint32_t preset) const {
    FwMaterialDef def = fwDefaultMaterialDef();
    check(fwInitMaterialPreset(&def, preset), world);
    FwMaterialId id{};
    check(fwWorld_CreateMaterial(world, &def, &id), world);
    return id;
}

FwBurnableMeshId Scene::addObject(FwMeshId mesh, FwBurnableMeshDef def) {
    def.mesh = mesh;
    check(fwWorld_CreateBurnableMesh(world, &def, &objects.emplace_back()), world);
    return objects.back();
}

void Scene::ball(uint32_t kind, float x, float y, float z, float radius) const {
    FwIgnitionDef def = fwDefaultIgnitionDef();
    def.kind = kind;
    def.position[0] = x, def.position[1] = y, def.position[2] = z;
    def.radius = radius;
    const FwResult result = fwWorld_Ignite(world, &def, nullptr);
    if (result == FW_NOTHING_THERE) throw std::runtime_error("a ball of a scene meets nothing");
    check(result, world);
}

std::vector<BurnHash> burnHashes(uint32_t backend, std::string& device) {
    std::vector<BurnHash> out;
    for (const HashedScene& hashed : kHashedScenes) {
        const std::unique_ptr<Scene> scene = hashed.make(backend);
        FwContextInfo info{};
        info.structSize = sizeof info;
        if (fwContext_GetInfo(scene->context, &info) == FW_OK) device = info.deviceName;
        for (uint32_t frame = 1; frame <= kHashedFrames; ++frame) {
            scene->advance(kHashedFrameTime);
            if (frame % kFramesPerHash != 0) continue;
            const uint64_t hash = scene->burnHash();  // its frame also brings the states up to date
            out.push_back(
                {hashed.name, double(kHashedFrameTime) * frame, scene->ignitedTexels(), hash});
        }
    }
    return out;
}

std::span<const TimedScene> timedScenes() { return kTimedScenes; }

}  // namespace fw::bundle
