// Defaults of every def, and functions without a context.
#include "components/particle_field.h"
#include "components/volumetric_fire.h"
#include "edge.h"
#include "flamewright/flamewright.h"
#include "units.h"
#include "vulkan_defs.h"
#include "world/material.h"

#include <algorithm>

namespace fw::edge {
namespace {

void identity(float (&matrix)[16]) noexcept {
    for (int i = 0; i < 16; ++i) matrix[i] = i % 5 == 0 ? 1.0f : 0.0f;
}

void set(float (&out)[3], float x, float y, float z) noexcept {
    out[0] = x;
    out[1] = y;
    out[2] = z;
}

void defaults(FwContextDef& def) noexcept {
    def.abiVersion = FW_ABI_VERSION;
    def.backend = FW_BACKEND_VULKAN;
}

void defaults(FwWorldDef& def) noexcept {
    set(def.up, 0, 1, 0);
    def.paceFactor = 1;
    def.seed = 1;
    def.maxStepsPerFrame = 8;
    def.maxLights = 16;
    def.maxFlames = 4096;
    def.maxRefinedTriangles = 400000;
    def.spreadChance = 1;
    def.volumePixelSize = 2;
    def.rayStepCount = 64;
    def.maxParticles = 16384;
    def.arrivalTiles = 1024;
    def.volumeOctaves = 4;
    def.metersPerUnit = 1;
}

void defaults(FwMaterialDef& def) noexcept { def = world::presetDef(FW_MATERIAL_PINE); }

void defaults(FwImageDef&) noexcept {}

void defaults(FwMeshDef& def) noexcept {
    def.indexSize = 4;
    def.mapSize = 512;
    def.texelsPerMetre = 128;
    def.noiseAmplitude = 0.15f;
    def.noiseFeature = 0.012f;
    def.noiseSeed = 1;
}

void defaults(FwBurnableMeshDef& def) noexcept {
    def.ground = -1e9f;
    identity(def.transform);
    def.refineDepth = 5;
    def.refinePixelsPerEdge = 8;
    set(def.tint, 1, 1, 1);
    def.spreadChance = 1;
}

void defaults(FwNetDef& def) noexcept {
    def.packetBytes = 1200;
    def.bytesPerSecond = 1u << 18;
    def.interval = 1.0f / 16;
    def.delay = 0.15f;
}

void defaults(FwHeatOccluderDef& def) noexcept {
    identity(def.transform);
    set(def.halfSize, 0.5f, 0.5f, 0.5f);
}

void defaults(FwHeatOcclusionDef& def) noexcept {
    def.counts[0] = def.counts[1] = def.counts[2] = 1;
    def.cellSize = 0.25f;
}

void defaults(FwWindZoneDef& def) noexcept {
    set(def.axis, 1, 0, 0);
    set(def.size, 1, 1, 1);
    def.speed = 5;
    def.falloff = 0.5f;
}

void defaults(FwWindGridDef& def) noexcept {
    def.blend = FW_WIND_REPLACE;
    def.counts[0] = def.counts[1] = def.counts[2] = 2;
    def.cellSize = 1;
}

void defaults(FwGustDef& def) noexcept { def.size = 12; }
void defaults(FwTimelineDef& def) noexcept {
    def.interval = 2;
    def.maxInterval = 32;
    def.bytes = uint64_t(64) << 20;
}

void defaults(FwRoomDef& def) noexcept {
    def.rotation[3] = 1;
    set(def.halfSize, 2, 1.25f, 2.5f);
    def.vent = 0.01f;
    def.oxygen = 0.2095f;
}

void defaults(FwVolumetricFireDef& def) noexcept {
    def.diameter = 0.6f;
    def.power = 60;
    def.windResponse = def.turbulence = def.speed = def.density = def.smoke = def.blue = 1;
    set(def.tint, 1, 1, 1);
    set(def.coreTint, 1, 1, 1);
    def.blend = 0.3f;
}

void defaults(FwParticleFieldDef& def) noexcept {
    set(def.size, 1, 1, 1);
    def.rotation[3] = 1;
    def.width = def.height = 64;
    def.stepRate = 24;
    def.open = FW_FIELD_OPEN_LEFT | FW_FIELD_OPEN_RIGHT | FW_FIELD_OPEN_TOP;
    components::setFieldPreset(def, FW_FIELD_FIRE);
    def.windResponse = 0.12f;
    def.sourceAt[0] = 0.5f;
    def.sourceAt[1] = 0.2f;
    set(def.tint, 1, 1, 1);
    def.opacity = 1;
}

void defaults(FwFireProfileDef&) noexcept {}

void defaults(FwFlipbookDef&) noexcept {}

void defaults(FwFireTrackDef& def) noexcept { def.weight = 1; }

void defaults(FwFireColliderDef& def) noexcept {
    def.normal[1] = 1;
    set(def.halfSize, 0.5f, 0.5f, 0.5f);
    def.rotation[3] = 1;
    def.radius = 0.5f;
    def.cellSize = 1;
    identity(def.view);
    identity(def.projection);
}

void defaults(FwBudgetDef& def) noexcept { def.measuredMilliseconds = -1; }

void defaults(FwFireEmitterDef& def) noexcept {
    set(def.direction, 0, 1, 0);
    def.power = 60;
    def.lifeVariance = 0.33f;
    def.buoyancy = def.windResponse = def.turbulence = def.smokeDensity = 1;
    def.inherit = 0.5f;
    def.smoke = 0.32f;
    def.smokeLife = 2.2f;
    def.sparks = 0.04f;
    def.behind = 0.5f;
    def.heat = 0.35f;
    def.stickTime = 6;
}

void defaults(FwIgnitionDef& def) noexcept { def.kind = FW_IGNITE; }

void defaults(FwView& def) noexcept {
    def.structSize = sizeof def;
    identity(def.view);
    identity(def.projection);
    set(def.sunDirection, 0.40824829f, 0.81649658f, 0.40824829f);
    set(def.sunColor, 3.0f, 2.9f, 2.7f);
    set(def.ambientSky, 0.35f, 0.42f, 0.55f);
    set(def.ambientGround, 0.14f, 0.12f, 0.10f);
    def.exposure = 1;
    def.haze = 1;
    def.emissionScale = 1;
}

void defaults(FwOffscreenDef& def) noexcept {
    def.width = 1280;
    def.height = 720;
    defaults(def.view);
    def.background[3] = 1;
}

// Calls body.template operator()<Def>() for the def of that type. False: unknown type.
template <class Body>
bool visitDef(uint32_t type, Body body) {
    switch (type) {
        case FW_DEF_CONTEXT:
            body.template operator()<FwContextDef>();
            return true;
        case FW_DEF_WORLD:
            body.template operator()<FwWorldDef>();
            return true;
        case FW_DEF_MATERIAL:
            body.template operator()<FwMaterialDef>();
            return true;
        case FW_DEF_IMAGE:
            body.template operator()<FwImageDef>();
            return true;
        case FW_DEF_MESH:
            body.template operator()<FwMeshDef>();
            return true;
        case FW_DEF_BURNABLE_MESH:
            body.template operator()<FwBurnableMeshDef>();
            return true;
        case FW_DEF_IGNITION:
            body.template operator()<FwIgnitionDef>();
            return true;
        case FW_DEF_VIEW:
            body.template operator()<FwView>();
            return true;
        case FW_DEF_OFFSCREEN:
            body.template operator()<FwOffscreenDef>();
            return true;
        case FW_DEF_HEAT_OCCLUDER:
            body.template operator()<FwHeatOccluderDef>();
            return true;
        case FW_DEF_VOLUMETRIC_FIRE:
            body.template operator()<FwVolumetricFireDef>();
            return true;
        case FW_DEF_FIRE_PROFILE:
            body.template operator()<FwFireProfileDef>();
            return true;
        case FW_DEF_FLIPBOOK:
            body.template operator()<FwFlipbookDef>();
            return true;
        case FW_DEF_BUDGET:
            body.template operator()<FwBudgetDef>();
            return true;
        case FW_DEF_NET:
            body.template operator()<FwNetDef>();
            return true;
        case FW_DEF_WIND_ZONE:
            body.template operator()<FwWindZoneDef>();
            return true;
        case FW_DEF_HEAT_OCCLUSION:
            body.template operator()<FwHeatOcclusionDef>();
            return true;
        case FW_DEF_WIND_GRID:
            body.template operator()<FwWindGridDef>();
            return true;
        case FW_DEF_GUSTS:
            body.template operator()<FwGustDef>();
            return true;
        case FW_DEF_TIMELINE:
            body.template operator()<FwTimelineDef>();
            return true;
        case FW_DEF_ROOM:
            body.template operator()<FwRoomDef>();
            return true;
        case FW_DEF_FIRE_COLLIDER:
            body.template operator()<FwFireColliderDef>();
            return true;
        case FW_DEF_FIRE_TRACK:
            body.template operator()<FwFireTrackDef>();
            return true;
        case FW_DEF_FIRE_EMITTER:
            body.template operator()<FwFireEmitterDef>();
            return true;
        case FW_DEF_PARTICLE_FIELD:
            body.template operator()<FwParticleFieldDef>();
            return true;
        default:
            return false;
    }
}

}  // namespace

size_t defSize(uint32_t type) noexcept {
    size_t size = 0;
    const bool known = visitDef(type, [&]<class Def>() { size = sizeof(Def); });
    return known ? size : vulkanDefSize(type);
}

bool writeDefaults(uint32_t type, void* def) noexcept {
    return visitDef(type,
                    [&]<class Def>() { writeDef<Def>(def, [](Def& one) { defaults(one); }); }) ||
           writeVulkanDefaults(type, def);
}

Unit checkedUnit(float metersPerUnit, const char* field, const Unit& otherwise) {
    if (metersPerUnit == 0) return otherwise;
    if (!(metersPerUnit >= 1e-4f && metersPerUnit <= 1e3f))
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "%s is %g; the limits are [0.0001, 1000] m. Centimetres are 0.01.", field,
                   double(metersPerUnit));
    return Unit::of(metersPerUnit);
}

void defFromMetres(uint32_t type, const Unit& unit, void* def) {
    const bool known = visitDef(type, [&]<class Def>() {
        Def filled = readDef<Def>(static_cast<Def*>(def), type, "def");
        uint32_t size = 0;
        std::memcpy(&size, def, sizeof size);
        fromMetres(unit, filled);
        writeInfo(static_cast<Def*>(def), size, filled);
    });
    if (!known && vulkanDefSize(type) == 0)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "defType is %u, which is no FwDefType.", type);
}

}  // namespace fw::edge

using namespace fw;

extern "C" {

void FW_CALL fwInitDef(uint32_t defType, void* def, uint32_t structSize) {
    if (!def || structSize == 0 || structSize > edge::kLargestStruct) return;
    alignas(16) unsigned char known[sizeof(FwOffscreenDef) + sizeof(FwMaterialDef) + 256];
    const size_t size = edge::defSize(defType);
    std::memset(def, 0, structSize);
    if (size > 0 && size <= sizeof known && edge::writeDefaults(defType, known))
        std::memcpy(def, known, std::min<size_t>(size, structSize));
    std::memcpy(def, &structSize, std::min<size_t>(sizeof structSize, structSize));
}

FwResult FW_CALL fwInitMaterialPreset(FwMaterialDef* def, uint32_t preset) {
    // Without a context there is no log or last message.
    const auto nobody = [](FwResult, const char*) {};
    return edge::guard("fwInitMaterialPreset", nobody, [&] {
        if (preset >= FW_MATERIAL_PRESET_COUNT)
            core::fail(FW_ERROR_INVALID_ARGUMENT, "preset is %u; the limit is %u.", preset,
                       uint32_t(FW_MATERIAL_PRESET_COUNT) - 1);
        const uint32_t size = edge::checkInfo(def, "FwMaterialDef");
        edge::writeInfo(def, size, world::presetDef(preset));
        return FW_OK;
    });
}

FwResult FW_CALL fwInitFirePreset(FwVolumetricFireDef* def, uint32_t preset) {
    const auto nobody = [](FwResult, const char*) {};
    return edge::guard("fwInitFirePreset", nobody, [&] {
        if (preset >= FW_FIRE_PRESET_COUNT)
            core::fail(FW_ERROR_INVALID_ARGUMENT, "preset is %u; the limit is %u.", preset,
                       uint32_t(FW_FIRE_PRESET_COUNT) - 1);
        const uint32_t size = edge::checkInfo(def, "FwVolumetricFireDef");
        FwVolumetricFireDef filled =
            edge::readDef(def, FW_DEF_VOLUMETRIC_FIRE, "FwVolumetricFireDef");
        components::setFirePreset(filled, preset);
        edge::writeInfo(def, size, filled);
        return FW_OK;
    });
}

FwResult FW_CALL fwInitFieldPreset(FwParticleFieldDef* def, uint32_t preset) {
    const auto nobody = [](FwResult, const char*) {};
    return edge::guard("fwInitFieldPreset", nobody, [&] {
        if (preset >= FW_FIELD_PRESET_COUNT)
            core::fail(FW_ERROR_INVALID_ARGUMENT, "preset is %u; the limit is %u.", preset,
                       uint32_t(FW_FIELD_PRESET_COUNT) - 1);
        const uint32_t size = edge::checkInfo(def, "FwParticleFieldDef");
        FwParticleFieldDef filled = edge::readDef(def, FW_DEF_PARTICLE_FIELD, "FwParticleFieldDef");
        components::setFieldPreset(filled, preset);
        edge::writeInfo(def, size, filled);
        return FW_OK;
    });
}

const char* FW_CALL fwFieldPresetName(uint32_t preset) {
    return components::fieldPresetName(preset);
}

const char* FW_CALL fwFirePresetName(uint32_t preset) { return components::firePresetName(preset); }

const char* FW_CALL fwMaterialPresetName(uint32_t preset) { return world::presetName(preset); }

uint32_t FW_CALL fwGetVersion(void) {
    return FW_VERSION_MAJOR << 22 | FW_VERSION_MINOR << 12 | FW_VERSION_PATCH;
}

const char* FW_CALL fwResultName(int32_t result) {
    switch (result) {
        case FW_NOTHING_THERE:
            return "FW_NOTHING_THERE";
        case FW_NOT_READY:
            return "FW_NOT_READY";
        case FW_OK:
            return "FW_OK";
        case FW_ERROR_INVALID_ARGUMENT:
            return "FW_ERROR_INVALID_ARGUMENT";
        case FW_ERROR_STALE_ID:
            return "FW_ERROR_STALE_ID";
        case FW_ERROR_VERSION:
            return "FW_ERROR_VERSION";
        case FW_ERROR_OUT_OF_MEMORY:
            return "FW_ERROR_OUT_OF_MEMORY";
        case FW_ERROR_UNSUPPORTED_DEVICE:
            return "FW_ERROR_UNSUPPORTED_DEVICE";
        case FW_ERROR_DEVICE_LOST:
            return "FW_ERROR_DEVICE_LOST";
        case FW_ERROR_BAD_DATA:
            return "FW_ERROR_BAD_DATA";
        case FW_ERROR_WRONG_BACKEND:
            return "FW_ERROR_WRONG_BACKEND";
        case FW_ERROR_INTERNAL:
            return "FW_ERROR_INTERNAL";
        default:
            return "an unknown FwResult";
    }
}

}  // extern "C"
