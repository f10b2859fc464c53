// Defs: defaults, older and newer hosts, invalid numbers.
#include "abi/abi_support.h"

#include <cstddef>
#include <functional>
#include <limits>

extern "C" int fwTestCallEverything(int* calls);

namespace {

using host::Host;
using host::lastMessage;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

TEST(CInterface, EveryFunctionAcceptsNull) {
    int calls = 0;
    EXPECT_EQ(0, fwTestCallEverything(&calls));
    EXPECT_EQ(158, calls);  // all functions of the three headers
}

TEST(CInterface, VersionAndNames) {
    EXPECT_EQ(FW_VERSION_MAJOR << 22 | FW_VERSION_MINOR << 12 | FW_VERSION_PATCH, fwGetVersion());
    EXPECT_STREQ("FW_ERROR_STALE_ID", fwResultName(FW_ERROR_STALE_ID));
    EXPECT_STREQ("an unknown FwResult", fwResultName(1234));
    for (uint32_t i = 0; i < FW_MATERIAL_PRESET_COUNT; ++i) {
        ASSERT_NE(nullptr, fwMaterialPresetName(i));
        EXPECT_LT(0u, std::strlen(fwMaterialPresetName(i)));
    }
    EXPECT_NE(nullptr, fwMaterialPresetName(99));
}

struct DefCase {
    const char* name;
    uint32_t type, size;
};
const DefCase kDefs[] = {
    {"context", FW_DEF_CONTEXT, sizeof(FwContextDef)},
    {"world", FW_DEF_WORLD, sizeof(FwWorldDef)},
    {"material", FW_DEF_MATERIAL, sizeof(FwMaterialDef)},
    {"image", FW_DEF_IMAGE, sizeof(FwImageDef)},
    {"mesh", FW_DEF_MESH, sizeof(FwMeshDef)},
    {"burnable", FW_DEF_BURNABLE_MESH, sizeof(FwBurnableMeshDef)},
    {"ignition", FW_DEF_IGNITION, sizeof(FwIgnitionDef)},
    {"view", FW_DEF_VIEW, sizeof(FwView)},
    {"offscreen", FW_DEF_OFFSCREEN, sizeof(FwOffscreenDef)},
    {"occluder", FW_DEF_HEAT_OCCLUDER, sizeof(FwHeatOccluderDef)},
    {"wind zone", FW_DEF_WIND_ZONE, sizeof(FwWindZoneDef)},
    {"wind grid", FW_DEF_WIND_GRID, sizeof(FwWindGridDef)},
    {"heat shield", FW_DEF_HEAT_OCCLUSION, sizeof(FwHeatOcclusionDef)},
    {"gusts", FW_DEF_GUSTS, sizeof(FwGustDef)},
    {"timeline", FW_DEF_TIMELINE, sizeof(FwTimelineDef)},
    {"room", FW_DEF_ROOM, sizeof(FwRoomDef)},
    {"fire", FW_DEF_VOLUMETRIC_FIRE, sizeof(FwVolumetricFireDef)},
    {"flipbook", FW_DEF_FLIPBOOK, sizeof(FwFlipbookDef)},
    {"profile", FW_DEF_FIRE_PROFILE, sizeof(FwFireProfileDef)},
    {"budget", FW_DEF_BUDGET, sizeof(FwBudgetDef)},
    {"net", FW_DEF_NET, sizeof(FwNetDef)},
    {"collider", FW_DEF_FIRE_COLLIDER, sizeof(FwFireColliderDef)},
    {"track", FW_DEF_FIRE_TRACK, sizeof(FwFireTrackDef)},
    {"emitter", FW_DEF_FIRE_EMITTER, sizeof(FwFireEmitterDef)},
    {"field", FW_DEF_PARTICLE_FIELD, sizeof(FwParticleFieldDef)},
    {"host", FW_DEF_VULKAN_HOST, sizeof(FwVulkanHost)},
    {"target", FW_DEF_VULKAN_TARGET, sizeof(FwVulkanTargetDef)},
    {"frame", FW_DEF_VULKAN_FRAME, sizeof(FwVulkanFrame)},
    {"vertices", FW_DEF_VULKAN_VERTICES, sizeof(FwVulkanVertices)},
    {"requirements", FW_DEF_VULKAN_REQUIREMENTS, sizeof(FwVulkanRequirements)},
    {"composite", FW_DEF_VULKAN_COMPOSITE, sizeof(FwVulkanComposite)},
};

TEST(InitDef, WritesNothingPastStructSizeAndZeroesUnknownFields) {
    for (const DefCase& def : kDefs) {
        std::vector<unsigned char> whole(def.size);
        fwInitDef(def.type, whole.data(), def.size);
        uint32_t written = 0;
        std::memcpy(&written, whole.data(), 4);
        EXPECT_EQ(def.size, written) << def.name;
        for (uint32_t size = 1; size <= def.size + 64; ++size) {
            std::vector<unsigned char> bytes(size + 16, 0xCD);
            fwInitDef(def.type, bytes.data(), size);
            for (uint32_t i = size; i < size + 16; ++i)
                ASSERT_EQ(0xCD, bytes[i]) << def.name << " of " << size << " at " << i;
            for (uint32_t i = 4; i < size; ++i)
                ASSERT_EQ(i < def.size ? whole[i] : 0, bytes[i])
                    << def.name << " of " << size << " at " << i;
        }
    }
    std::vector<unsigned char> unknown(64, 0xCD);
    fwInitDef(4711, unknown.data(), 32);
    for (uint32_t i = 4; i < 32; ++i) EXPECT_EQ(0, unknown[i]);
    EXPECT_EQ(0xCD, unknown[32]);
    fwInitDef(FW_DEF_WORLD, nullptr, 32);
    fwInitDef(FW_DEF_WORLD, unknown.data(), 0);
    EXPECT_EQ(0xCD, unknown[32]);
}

// Calls `create` with the def at every size of an older host, and with larger sizes.
template <class Def>
void checkSizes(const char* name, Def whole, const std::function<FwResult(const Def*)>& create,
                const std::function<std::string()>& message) {
    // Older hosts: the missing fields take their defaults, which always work in a world.
    for (uint32_t size = 8; size < sizeof(Def); size += uint32_t(alignof(Def))) {
        std::vector<unsigned char> bytes(sizeof(Def) + 64,
                                         0xCD);  // memory that must stay untouched
        std::memcpy(bytes.data(), &whole, size);
        std::memcpy(bytes.data(), &size, 4);
        const FwResult result = create(reinterpret_cast<const Def*>(bytes.data()));
        EXPECT_TRUE(result == FW_OK || result == FW_ERROR_INVALID_ARGUMENT ||
                    result == FW_ERROR_STALE_ID)
            << name << " of " << size << ": " << fwResultName(result) << " " << message();
    }
    for (const uint32_t extra : {8u, 32u, 256u}) {
        std::vector<unsigned char> bytes(sizeof(Def) + 512, 0);
        std::memcpy(bytes.data(), &whole, sizeof(Def));
        const uint32_t size = uint32_t(sizeof(Def)) + extra;
        std::memcpy(bytes.data(), &size, 4);
        EXPECT_EQ(FW_OK, create(reinterpret_cast<const Def*>(bytes.data())))
            << name << ": " << message();
        bytes[size - 1] = 1;
        EXPECT_EQ(FW_ERROR_VERSION, create(reinterpret_cast<const Def*>(bytes.data()))) << name;
        EXPECT_NE(std::string::npos, message().find("structSize")) << message();
    }
    for (const uint32_t size : {0u, 4u, 7u, 13u, 70000u, 0xFFFFFFFFu}) {
        std::vector<unsigned char> bytes(sizeof(Def), 0);
        std::memcpy(bytes.data(), &whole, sizeof(Def));
        std::memcpy(bytes.data(), &size, 4);
        EXPECT_EQ(FW_ERROR_VERSION, create(reinterpret_cast<const Def*>(bytes.data())))
            << name << " of " << size;
    }
}

TEST(StructSizes, ServesOlderHostsAndRefusesUnknownFields) {
    host::SheetWorld w(host::evenMaterial(0.02f, 5));
    const auto worldMessage = [&] { return lastMessage(w.world); };
    const auto contextMessage = [&] { return lastMessage(w.context); };

    checkSizes<FwContextDef>(
        "FwContextDef",
        [&] {
            FwContextDef def = fwDefaultContextDef();
            def.backend = FW_BACKEND_CPU;
            def.callbacks = w.host.callbacks();
            return def;
        }(),
        [&](const FwContextDef* def) {
            uint32_t size = 0, backend = 0;
            std::memcpy(&size, def, 4);
            if (size > 8 && size <= offsetof(FwContextDef, backend)) return FW_OK;
            if (size == 8) return FW_OK;  // such a host could not choose the cpu backend
            (void)backend;
            FwContext* context = nullptr;
            // An incomplete set of callbacks is refused, also from an older host.
            const FwResult result = fwCreateContext(def, &context, nullptr);
            fwDestroyContext(context);
            return result;
        },
        [] { return std::string("structSize"); });
    checkSizes<FwWorldDef>(
        "FwWorldDef", fwDefaultWorldDef(),
        [&](const FwWorldDef* def) {
            FwWorld* world = nullptr;
            const FwResult result = fwCreateWorld(w.context, def, &world);
            fwDestroyWorld(world);
            return result;
        },
        contextMessage);
    checkSizes<FwMaterialDef>(
        "FwMaterialDef", fwDefaultMaterialDef(),
        [&](const FwMaterialDef* def) {
            FwMaterialId id{};
            return fwWorld_CreateMaterial(w.world, def, &id);
        },
        worldMessage);
    const uint32_t pixels[4] = {};
    FwImageDef image = fwDefaultImageDef();
    image.width = image.height = 2;
    image.pixels = pixels;
    checkSizes<FwImageDef>(
        "FwImageDef", image,
        [&](const FwImageDef* def) {
            FwImageId id{};
            return fwWorld_CreateImage(w.world, def, &id);
        },
        worldMessage);
    const host::Sheet small(0.2f, 0.2f);
    checkSizes<FwMeshDef>(
        "FwMeshDef", small.def(32),
        [&](const FwMeshDef* def) {
            FwMeshId id{};
            return fwWorld_CreateMesh(w.world, def, &id);
        },
        worldMessage);
    FwBurnableMeshDef burnable = fwDefaultBurnableMeshDef();
    burnable.mesh = w.mesh;
    burnable.materials[0] = w.materialId;
    checkSizes<FwBurnableMeshDef>(
        "FwBurnableMeshDef", burnable,
        [&](const FwBurnableMeshDef* def) {
            FwBurnableMeshId id{};
            return fwWorld_CreateBurnableMesh(w.world, def, &id);
        },
        worldMessage);
    checkSizes<FwVolumetricFireDef>(
        "FwVolumetricFireDef", fwDefaultVolumetricFireDef(),
        [&](const FwVolumetricFireDef* def) {
            FwVolumetricFireId id{};
            return fwWorld_CreateVolumetricFire(w.world, def, &id);
        },
        worldMessage);
    checkSizes<FwParticleFieldDef>(
        "FwParticleFieldDef", fwDefaultParticleFieldDef(),
        [&](const FwParticleFieldDef* def) {
            FwParticleFieldId id{};
            return fwWorld_CreateParticleField(w.world, def, &id);
        },
        worldMessage);
    checkSizes<FwBudgetDef>(
        "FwBudgetDef", fwDefaultBudgetDef(),
        [&](const FwBudgetDef* def) { return fwWorld_SetBudget(w.world, def); }, worldMessage);
    checkSizes<FwNetDef>(
        "FwNetDef",
        [] {
            FwNetDef def = fwDefaultNetDef();
            def.token = 1;
            return def;
        }(),
        [&](const FwNetDef* def) {
            const FwResult result = fwNet_Serve(w.world, def);
            if (result == FW_OK) (void)fwNet_Leave(w.world);
            return result;
        },
        worldMessage);
    checkSizes<FwFireColliderDef>(
        "FwFireColliderDef", fwDefaultFireColliderDef(),
        [&](const FwFireColliderDef* def) {
            FwFireColliderId id{};
            const FwResult result = fwWorld_AddFireCollider(w.world, def, &id);
            if (result == FW_OK) (void)fwWorld_RemoveFireCollider(w.world, id);
            return result;
        },
        worldMessage);
    FwFlipbookDef book = fwDefaultFlipbookDef();
    book.preset = FW_FLIPBOOK_SPARK;
    checkSizes<FwFlipbookDef>(
        "FwFlipbookDef", book,
        [&](const FwFlipbookDef* def) {
            FwFlipbookId id{};
            const FwResult result = fwWorld_CreateFlipbook(w.world, def, &id);
            if (result == FW_OK) (void)fwWorld_DestroyFlipbook(w.world, id);
            return result;
        },
        worldMessage);
    std::vector<float> texels(2 * 8 * 8, 0.5f);
    FwFireProfileDef profile = fwDefaultFireProfileDef();
    profile.width = profile.height = 8;
    profile.texels = texels.data();
    checkSizes<FwFireProfileDef>(
        "FwFireProfileDef", profile,
        [&](const FwFireProfileDef* def) {
            FwFireProfileId id{};
            const FwResult result = fwWorld_CreateFireProfile(w.world, def, &id);
            if (result == FW_OK) (void)fwWorld_DestroyFireProfile(w.world, id);
            return result;
        },
        worldMessage);
    const FwVolumetricFireDef fireDef = fwDefaultVolumetricFireDef();
    FwVolumetricFireId fireId{};
    ASSERT_EQ(FW_OK, fwWorld_CreateVolumetricFire(w.world, &fireDef, &fireId));
    const float time = 0;
    const FwFirePoint line[2] = {{{0, 0, 0}, 0.1f}, {{0, 1, 0}, 0.1f}};
    FwFireTrackDef track = fwDefaultFireTrackDef();
    track.keyCount = 1;
    track.pointsPerKey = 2;
    track.times = &time;
    track.points = line;
    checkSizes<FwFireTrackDef>(
        "FwFireTrackDef", track,
        [&](const FwFireTrackDef* def) {
            return fwWorld_SetVolumetricFireTrack(w.world, fireId, def);
        },
        worldMessage);
    checkSizes<FwFireEmitterDef>(
        "FwFireEmitterDef", fwDefaultFireEmitterDef(),
        [&](const FwFireEmitterDef* def) {
            FwFireEmitterId id{};
            const FwResult result = fwWorld_CreateFireEmitter(w.world, def, &id);
            if (result == FW_OK) (void)fwWorld_DestroyFireEmitter(w.world, id);
            return result;
        },
        worldMessage);
    const float velocities[24] = {};
    FwWindGridDef grid = fwDefaultWindGridDef();
    grid.velocities = velocities;
    checkSizes<FwWindGridDef>(
        "FwWindGridDef", grid,
        [&](const FwWindGridDef* def) { return fwWorld_SetWindGrid(w.world, def); }, worldMessage);
    checkSizes<FwHeatOcclusionDef>(
        "FwHeatOcclusionDef", fwDefaultHeatOcclusionDef(),
        [&](const FwHeatOcclusionDef* def) { return fwWorld_SetHeatOcclusion(w.world, def); },
        worldMessage);
    checkSizes<FwGustDef>(
        "FwGustDef", fwDefaultGustDef(),
        [&](const FwGustDef* def) { return fwWorld_SetGusts(w.world, def); }, worldMessage);
    checkSizes<FwTimelineDef>(
        "FwTimelineDef", fwDefaultTimelineDef(),
        [&](const FwTimelineDef* def) { return fwWorld_StartTimeline(w.world, def); },
        worldMessage);
    FwIgnitionDef ignition = fwDefaultIgnitionDef();
    ignition.radius = 0.05f;
    checkSizes<FwIgnitionDef>(
        "FwIgnitionDef", ignition,
        [&](const FwIgnitionDef* def) { return fwWorld_Ignite(w.world, def, nullptr); },
        worldMessage);
}

TEST(StructSizes, AnOldHostGetsDefaultsForFieldsItDoesNotKnow) {
    host::SheetWorld w(host::evenMaterial(0.02f, 5));
    FwMaterialDef def;
    std::memset(&def, 0xCD, sizeof def);
    fwInitDef(FW_DEF_MATERIAL, &def, offsetof(FwMaterialDef, baseColor));  // size of an older host
    EXPECT_EQ(0xCD, reinterpret_cast<unsigned char*>(&def.baseColor)[0]);
    FwMaterialId id{};
    EXPECT_EQ(FW_OK, fwWorld_CreateMaterial(w.world, &def, &id)) << lastMessage(w.world);
}

TEST(StructSizes, InfosNeverWritePastTheirSize) {
    host::SheetWorld w(host::evenMaterial(0.02f, 5));
    for (uint32_t size = 8; size <= sizeof(FwMeshInfo) + 32; size += 4) {
        std::vector<unsigned char> bytes(size + 16, 0xCD);
        std::memcpy(bytes.data(), &size, 4);
        ASSERT_EQ(FW_OK, fwWorld_GetMeshInfo(w.world, w.mesh,
                                             reinterpret_cast<FwMeshInfo*>(bytes.data())));
        for (uint32_t i = size; i < size + 16; ++i) ASSERT_EQ(0xCD, bytes[i]);
        for (uint32_t i = sizeof(FwMeshInfo); i < size; ++i) ASSERT_EQ(0, bytes[i]);
        uint32_t kept = 0;
        std::memcpy(&kept, bytes.data(), 4);
        ASSERT_EQ(size, kept);
    }
    FwMeshInfo info{};
    EXPECT_EQ(FW_ERROR_VERSION, fwWorld_GetMeshInfo(w.world, w.mesh, &info));
    EXPECT_NE(std::string::npos, lastMessage(w.world).find("FwMeshInfo::structSize is 0"));
}

// Sets one float of a valid def to bad values. Each value must be refused with the field's name.
template <class Def>
void refuseFloat(const Def& good, float Def::*field, const char* name,
                 const std::function<FwResult(const Def*)>& create,
                 const std::function<std::string()>& message, std::vector<float> bad = {}) {
    bad.insert(bad.end(), {kNan, kInfinity, -kInfinity});
    for (const float value : bad) {
        Def def = good;
        def.*field = value;
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, create(&def)) << name << " = " << value;
        EXPECT_NE(std::string::npos, message().find(name)) << message();
        EXPECT_NE(std::string::npos, message().find(" is ")) << message();
    }
    EXPECT_EQ(FW_OK, create(&good)) << message();
}

TEST(DefValues, EveryFloatOfEveryDefIsChecked) {
    host::SheetWorld w(host::evenMaterial(0.02f, 5));
    const auto worldMessage = [&] { return lastMessage(w.world); };
    const auto contextMessage = [&] { return lastMessage(w.context); };
    const std::function<FwResult(const FwWorldDef*)> makeWorld = [&](const FwWorldDef* def) {
        FwWorld* world = nullptr;
        const FwResult result = fwCreateWorld(w.context, def, &world);
        fwDestroyWorld(world);
        return result;
    };
    refuseFloat<FwWorldDef>(fwDefaultWorldDef(), &FwWorldDef::paceFactor, "paceFactor", makeWorld,
                            contextMessage, {0.0f, 0.05f, -1.0f, 1001.0f});
    FwWorldDef later = fwDefaultWorldDef();
    later.reserved = 1;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, makeWorld(&later));
    EXPECT_NE(std::string::npos, contextMessage().find("FwWorldDef::reserved is 1"));
    for (const uint32_t cell : {0u, 17u}) {
        FwWorldDef coarse = fwDefaultWorldDef();
        coarse.volumePixelSize = cell;
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, makeWorld(&coarse));
        EXPECT_NE(std::string::npos, contextMessage().find("FwWorldDef::volumePixelSize is"));
    }
    for (const uint32_t steps : {5u, 65u}) {
        FwWorldDef few = fwDefaultWorldDef();
        few.rayStepCount = steps;
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, makeWorld(&few));
        EXPECT_NE(std::string::npos, contextMessage().find("FwWorldDef::rayStepCount is"));
    }
    for (const uint32_t octaves : {0u, 5u}) {
        FwWorldDef smooth = fwDefaultWorldDef();
        smooth.volumeOctaves = octaves;
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, makeWorld(&smooth));
        EXPECT_NE(std::string::npos, contextMessage().find("FwWorldDef::volumeOctaves is"));
    }

    const std::function<FwResult(const FwMaterialDef*)> makeMaterial =
        [&](const FwMaterialDef* def) {
            FwMaterialId id{};
            const FwResult result = fwWorld_CreateMaterial(w.world, def, &id);
            if (result == FW_OK) (void)fwWorld_DestroyMaterial(w.world, id);
            return result;
        };
    const FwMaterialDef pine = fwDefaultMaterialDef();
    struct Field {
        float FwMaterialDef::*field;
        const char* name;
        std::vector<float> bad;
    };
    const Field fields[] = {
        {&FwMaterialDef::spreadRate, "spreadRate", {-0.1f, 1.5f}},
        {&FwMaterialDef::windGain, "windGain", {-1.0f, 17.0f}},
        {&FwMaterialDef::upGain, "upGain", {-1.0f, 17.0f}},
        {&FwMaterialDef::headGain, "headGain", {-1.0f, 256.0f}},
        {&FwMaterialDef::backGain, "backGain", {-1.0f, 256.0f}},
        {&FwMaterialDef::driveMax, "driveMax", {-1.0f, 64.0f}},
        {&FwMaterialDef::lengthToBreadth, "lengthToBreadth", {0.0f, 0.5f, 5.0f}},
        {&FwMaterialDef::ceilingGain, "ceilingGain", {-1.0f, 5.0f}},
        {&FwMaterialDef::burnTime, "burnTime", {}},
        {&FwMaterialDef::moisture, "moisture", {-0.1f, 2.5f}},
        {&FwMaterialDef::extinctionMoisture, "extinctionMoisture", {0.0f, -1.0f, 3.0f}},
        {&FwMaterialDef::thickness, "thickness", {-0.1f}},
        {&FwMaterialDef::heatOfCombustion, "heatOfCombustion", {-1.0f}},
        {&FwMaterialDef::burningFlux, "burningFlux", {-1.0f}},
        {&FwMaterialDef::baseRoughness, "baseRoughness", {-0.1f, 1.1f}},
        {&FwMaterialDef::recede, "recede", {-0.1f, 1.1f}},
        {&FwMaterialDef::shrink, "shrink", {-0.1f, 0.6f}},
        {&FwMaterialDef::curl, "curl", {-1.0f, 201.0f}},
    };
    for (const Field& field : fields)
        refuseFloat<FwMaterialDef>(pine, field.field, field.name, makeMaterial, worldMessage,
                                   field.bad);

    const host::Sheet sheet(0.2f, 0.2f);
    const std::function<FwResult(const FwMeshDef*)> makeMesh = [&](const FwMeshDef* def) {
        FwMeshId id{};
        const FwResult result = fwWorld_CreateMesh(w.world, def, &id);
        if (result == FW_OK) (void)fwWorld_DestroyMesh(w.world, id);
        return result;
    };
    refuseFloat<FwMeshDef>(sheet.def(32), &FwMeshDef::texelsPerMetre, "texelsPerMetre", makeMesh,
                           worldMessage, {0.0f, -1.0f, 5000.0f});
    refuseFloat<FwMeshDef>(sheet.def(32), &FwMeshDef::noiseAmplitude, "noiseAmplitude", makeMesh,
                           worldMessage, {-0.1f, 0.6f});
    refuseFloat<FwMeshDef>(sheet.def(32), &FwMeshDef::noiseFeature, "noiseFeature", makeMesh,
                           worldMessage, {0.0f, -1.0f});

    const std::function<FwResult(const FwVolumetricFireDef*)> makeFire =
        [&](const FwVolumetricFireDef* def) {
            FwVolumetricFireId id{};
            const FwResult result = fwWorld_CreateVolumetricFire(w.world, def, &id);
            if (result == FW_OK) (void)fwWorld_DestroyVolumetricFire(w.world, id);
            return result;
        };
    const FwVolumetricFireDef fire = fwDefaultVolumetricFireDef();
    using F = FwVolumetricFireDef;
    refuseFloat<F>(fire, &F::diameter, "diameter", makeFire, worldMessage, {0.0f, 0.001f, 21.0f});
    refuseFloat<F>(fire, &F::power, "power", makeFire, worldMessage, {-1.0f, 2e5f});
    refuseFloat<F>(fire, &F::windResponse, "windResponse", makeFire, worldMessage, {-0.1f, 5.0f});
    refuseFloat<F>(fire, &F::turbulence, "turbulence", makeFire, worldMessage, {-0.1f, 4.0f});
    refuseFloat<F>(fire, &F::speed, "speed", makeFire, worldMessage, {-0.1f, 5.0f});
    refuseFloat<F>(fire, &F::density, "density", makeFire, worldMessage, {-0.1f, 11.0f});
    refuseFloat<F>(fire, &F::smoke, "smoke", makeFire, worldMessage, {-0.1f, 11.0f});
    refuseFloat<F>(fire, &F::blue, "blue", makeFire, worldMessage, {-0.1f, 11.0f});
    refuseFloat<F>(fire, &F::tintWeight, "tintWeight", makeFire, worldMessage, {-0.1f, 1.1f});
    refuseFloat<F>(fire, &F::coreTintWeight, "coreTintWeight", makeFire, worldMessage,
                   {-0.1f, 1.1f});
    refuseFloat<F>(fire, &F::blend, "blend", makeFire, worldMessage, {-0.1f, 61.0f});
    F tiered = fire;
    tiered.tier = 6;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, makeFire(&tiered));
    EXPECT_NE(std::string::npos, worldMessage().find("FwVolumetricFireDef::tier is 6"));
    tiered.tier = FW_FIRE_TIER_IMPOSTOR;
    EXPECT_EQ(FW_OK, makeFire(&tiered));
    for (int i = 0; i < 3; ++i) {
        F def = fire;
        def.position[i] = kInfinity;
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, makeFire(&def));
        EXPECT_NE(std::string::npos, worldMessage().find("position[" + std::to_string(i) + "]"));
        def = fire;
        def.tint[i] = 1.5f;
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, makeFire(&def));
        EXPECT_NE(std::string::npos, worldMessage().find("tint[" + std::to_string(i) + "] is 1.5"));
        def = fire;
        def.coreTint[i] = -0.5f;
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, makeFire(&def));
        EXPECT_NE(std::string::npos,
                  worldMessage().find("coreTint[" + std::to_string(i) + "] is -0.5"));
    }

    const std::function<FwResult(const FwFireEmitterDef*)> makeEmitter =
        [&](const FwFireEmitterDef* def) {
            FwFireEmitterId id{};
            const FwResult result = fwWorld_CreateFireEmitter(w.world, def, &id);
            if (result == FW_OK) (void)fwWorld_DestroyFireEmitter(w.world, id);
            return result;
        };
    const FwFireEmitterDef emitter = fwDefaultFireEmitterDef();
    using E = FwFireEmitterDef;
    const auto refuse = [&](float E::*field, const char* name, std::initializer_list<float> bad) {
        refuseFloat<E>(emitter, field, name, makeEmitter, worldMessage, bad);
    };
    refuse(&E::radius, "radius", {-0.1f, 51.0f});
    refuse(&E::power, "power", {-1.0f, 2e5f});
    refuse(&E::rate, "rate", {-1.0f, 3e5f});
    refuse(&E::speed, "speed", {-1.0f, 201.0f});
    refuse(&E::cone, "cone", {-0.1f, 2.1f});
    refuse(&E::size0, "size0", {-0.1f, 51.0f});
    refuse(&E::size1, "size1", {-0.1f, 51.0f});
    refuse(&E::life, "life", {-0.1f, 61.0f});
    refuse(&E::lifeVariance, "lifeVariance", {-0.1f, 1.1f});
    refuse(&E::drag, "drag", {-0.1f, 61.0f});
    refuse(&E::buoyancy, "buoyancy", {-4.1f, 4.1f});
    refuse(&E::windResponse, "windResponse", {-0.1f, 4.1f});
    refuse(&E::turbulence, "turbulence", {-0.1f, 4.1f});
    refuse(&E::inherit, "inherit", {-0.1f, 1.1f});
    refuse(&E::smoke, "smoke", {-0.1f, 1.1f});
    refuse(&E::smokeLife, "smokeLife", {-0.1f, 20.1f});
    refuse(&E::smokeDensity, "smokeDensity", {-0.1f, 4.1f});
    refuse(&E::sparks, "sparks", {-0.1f, 1.1f});
    refuse(&E::temperature, "temperature", {-1.0f, 2501.0f});
    refuse(&E::ground, "ground", {-2e6f, 2e6f});
    refuse(&E::stick, "stick", {-0.1f, 1.1f});
    refuse(&E::stickTime, "stickTime", {0.1f, 121.0f});
    const std::function<FwResult(const FwParticleFieldDef*)> makeField =
        [&](const FwParticleFieldDef* def) {
            FwParticleFieldId id{};
            const FwResult result = fwWorld_CreateParticleField(w.world, def, &id);
            if (result == FW_OK) (void)fwWorld_DestroyParticleField(w.world, id);
            return result;
        };
    const FwParticleFieldDef field = fwDefaultParticleFieldDef();
    using P = FwParticleFieldDef;
    refuseFloat<P>(field, &P::amount, "amount", makeField, worldMessage, {-0.1f, 4.1f});
    refuseFloat<P>(field, &P::rise, "rise", makeField, worldMessage, {-4.1f, 4.1f});
    refuseFloat<P>(field, &P::spread, "spread", makeField, worldMessage, {-0.1f, 1.1f});
    refuseFloat<P>(field, &P::memory, "memory", makeField, worldMessage, {-0.1f, 1.1f});
    refuseFloat<P>(field, &P::chaos, "chaos", makeField, worldMessage, {-0.1f, 4.1f});
    refuseFloat<P>(field, &P::life, "life", makeField, worldMessage, {0.0f, 2000.0f});
    refuseFloat<P>(field, &P::detail, "detail", makeField, worldMessage, {-0.1f, 1.1f});
    refuseFloat<P>(field, &P::body, "body", makeField, worldMessage, {-0.1f, 2.1f});
    refuseFloat<P>(field, &P::windResponse, "windResponse", makeField, worldMessage, {-1.0f, 5.0f});
    refuseFloat<P>(field, &P::sourceSize, "sourceSize", makeField, worldMessage, {0.0f, 1.1f});
    refuseFloat<P>(field, &P::opacity, "opacity", makeField, worldMessage, {-0.1f, 11.0f});
    for (int i = 0; i < 3; ++i) {
        P def = field;
        def.size[i] = 0;
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, makeField(&def));
        EXPECT_NE(std::string::npos, worldMessage().find("size[" + std::to_string(i) + "] is 0"));
    }

    FwBurnableMeshDef burnable = fwDefaultBurnableMeshDef();
    burnable.mesh = w.mesh;
    burnable.materials[0] = w.materialId;
    const std::function<FwResult(const FwBurnableMeshDef*)> makeBurnable =
        [&](const FwBurnableMeshDef* def) {
            FwBurnableMeshId id{};
            const FwResult result = fwWorld_CreateBurnableMesh(w.world, def, &id);
            if (result == FW_OK) (void)fwWorld_DestroyBurnableMesh(w.world, id);
            return result;
        };
    refuseFloat<FwBurnableMeshDef>(burnable, &FwBurnableMeshDef::moisture, "moisture", makeBurnable,
                                   worldMessage, {-0.1f, 2.5f});
    for (int i = 0; i < 16; ++i) {
        FwBurnableMeshDef def = burnable;
        def.transform[i] = kNan;
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, makeBurnable(&def));
        EXPECT_NE(std::string::npos,
                  lastMessage(w.world).find("transform[" + std::to_string(i) + "] is "))
            << lastMessage(w.world);
    }
    for (int i = 0; i < 3; ++i) {
        FwBurnableMeshDef def = burnable;
        def.tint[i] = kNan;
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, makeBurnable(&def));
        EXPECT_NE(std::string::npos, lastMessage(w.world).find("tint")) << lastMessage(w.world);
    }

    refuseFloat<FwBurnableMeshDef>(burnable, &FwBurnableMeshDef::ground, "ground", makeBurnable,
                                   worldMessage, {2e9f});
    refuseFloat<FwBurnableMeshDef>(burnable, &FwBurnableMeshDef::heatPsi, "heatPsi", makeBurnable,
                                   worldMessage, {-1.0f, 2e8f});
    refuseFloat<FwBurnableMeshDef>(burnable, &FwBurnableMeshDef::heatStep, "heatStep", makeBurnable,
                                   worldMessage, {-1.0f, 2000.0f});
    const auto refusedDeform = [&](const FwBurnableMeshDef& def, const char* what) {
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, makeBurnable(&def)) << what;
        EXPECT_NE(std::string::npos, lastMessage(w.world).find(what)) << lastMessage(w.world);
    };
    FwPin pin{};
    FwBurnableMeshDef shell = burnable;
    shell.flags = FW_BURNABLE_SHELL;
    shell.pinCount = 1;
    refusedDeform(shell, "pins is null");
    shell.pins = &pin;
    EXPECT_EQ(FW_OK, makeBurnable(&shell)) << lastMessage(w.world);
    shell.pinCount = 9;
    refusedDeform(shell, "pinCount is 9");
    shell.pinCount = 1;
    pin.radius = -1;
    refusedDeform(shell, "FwPin::radius");
    pin = {};
    pin.to[1] = kNan;
    refusedDeform(shell, "FwPin::to");
    pin = {};
    pin.reserved = 1;
    refusedDeform(shell, "FwPin::reserved");
    pin = {};
    shell.flags = uint32_t{FW_BURNABLE_SHELL} | uint32_t{FW_BURNABLE_RECEDE};
    refusedDeform(shell, "one is possible");
    for (const auto& [reserved, name] :
         {std::pair{4u, "FW_BURNABLE_PUBLISHED"}, std::pair{64u, "FW_BURNABLE_REFINE_PUBLISHED"},
          std::pair{512u, "FW_BURNABLE_SPRINGS"}, std::pair{8192u, "FW_BURNABLE_DEPTH_PEEL"}}) {
        shell.flags = reserved;
        refusedDeform(shell, name);
        refusedDeform(shell, "Link flamewright_reference instead.");
    }

    FwIgnitionDef ignition = fwDefaultIgnitionDef();
    ignition.radius = 0.05f;
    const std::function<FwResult(const FwIgnitionDef*)> ignite = [&](const FwIgnitionDef* def) {
        return fwWorld_Ignite(w.world, def, nullptr);
    };
    refuseFloat<FwIgnitionDef>(ignition, &FwIgnitionDef::radius, "radius", ignite, worldMessage,
                               {-1.0f});
    refuseFloat<FwIgnitionDef>(ignition, &FwIgnitionDef::delay, "delay", ignite, worldMessage,
                               {-1.0f, 3601.0f});
    for (const float bad : {kNan, kInfinity, -kInfinity, 1e30f}) {
        FwIgnitionDef def = ignition;
        def.position[1] = bad;
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, ignite(&def));
        EXPECT_NE(std::string::npos, lastMessage(w.world).find("position[1]"));
        const float wind[3] = {0, bad, 0};
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_SetWind(w.world, wind));
        EXPECT_NE(std::string::npos, lastMessage(w.world).find("wind[1]"));
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_TagPoint(w.world, w.object, wind, 1));
        FwQueryId query{};
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_RequestPoint(w.world, w.object, wind, &query));
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_Step(w.world, bad));
        EXPECT_NE(std::string::npos, lastMessage(w.world).find("deltaTime is "));
    }
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_Step(w.world, -0.01f));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_Step(w.world, 10.5f));
}

TEST(DefValues, PosesThatAreNotRigidAreRefusedWithTheReason) {
    host::SheetWorld w(host::evenMaterial(0.02f, 5));
    struct Case {
        float columns[9];
        float w15;
        const char* reason;
    };
    const Case cases[] = {
        {{1, 0, 0, 0, 1, 0, 0, 0, 17}, 1, "the largest is at most 16 times the smallest"},
        {{1, 0, 0, 0.01f, 1, 0, 0, 0, 1}, 1, "sheared"},
        {{-1, 0, 0, 0, 1, 0, 0, 0, 1}, 1, "mirrors"},
        {{0, 0, 0, 0, 0, 0, 0, 0, 0}, 1, "scale 0"},
        {{2000, 0, 0, 0, 2000, 0, 0, 0, 2000}, 1, "scale 2000"},
        {{1, 0, 0, 0, 1, 0, 0, 0, 1}, 0.5f, "last row"},
    };
    for (const Case& bad : cases) {
        float m[16] = {};
        for (int c = 0; c < 3; ++c)
            for (int r = 0; r < 3; ++r) m[c * 4 + r] = bad.columns[c * 3 + r];
        m[15] = bad.w15;
        EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_SetTransform(w.world, w.object, m));
        EXPECT_NE(std::string::npos, lastMessage(w.world).find(bad.reason)) << lastMessage(w.world);
    }
    const float good[16] = {0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 5, 6, 7, 1};
    EXPECT_EQ(FW_OK, fwWorld_SetTransform(w.world, w.object, good)) << lastMessage(w.world);
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_SetTransform(w.world, w.object, nullptr));
    EXPECT_EQ("transform is null.\n - While calling fwWorld_SetTransform.", lastMessage(w.world));
}

}  // namespace
