// Defaults of every def, and functions without a context.
#include "components/particle_field.h"
#include "components/volumetric_fire.h"
#include "edge.h"
#include "flamewright/flamewright.h"
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

template <class Def>
void defaults(Def&) noexcept {}  // zeros

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

template <class Def>
void fromMetresOf(const Unit& unit, void* def) {
    const auto given = static_cast<Def*>(def);
    Def filled = readDef<Def>(given, {}, "def");
    fromMetres(unit, filled);
    writeInfo(given, checkInfo(given), filled);
}

constexpr DefRow kDefs[] = {
#define FW_INFO(T, ...)
#define FW_DEF(T, number, ...) {number, sizeof(T), &writeDefaultsOf<T, defaults>, &fromMetresOf<T>},
#include "structs.inl"
#undef FW_DEF
#undef FW_INFO
};

}  // namespace

const DefRow* findDef(uint32_t type) noexcept {
    for (const std::span<const DefRow> rows : {std::span<const DefRow>(kDefs), vulkanDefRows()})
        for (const DefRow& row : rows)
            if (row.type == type) return &row;
    return nullptr;
}

Unit checkedUnit(float metersPerUnit, const char* field, const Unit& otherwise) {
    if (metersPerUnit == 0) return otherwise;
    if (!(metersPerUnit >= 1e-4f && metersPerUnit <= 1e3f))
        core::refuse("%s is %g; the limits are [0.0001, 1000] m. Centimetres are 0.01.", field,
                     double(metersPerUnit));
    return Unit::of(metersPerUnit);
}

}  // namespace fw::edge

using namespace fw;

namespace {

template <class Def, class Make>
FwResult initPreset(const char* function, Def* def, uint32_t preset, uint32_t count,
                    const Make& make) noexcept {
    return edge::guardAlone(function, [&] {
        if (preset >= count) core::refuse("preset is %u; the limit is %u.", preset, count - 1);
        const uint32_t size = edge::checkInfo(def);
        edge::writeInfo(def, size, make());
    });
}

}  // namespace

extern "C" {

void FW_CALL fwInitDef(uint32_t defType, void* def, uint32_t structSize) {
    if (!def || structSize == 0 || structSize > edge::kLargestStruct) return;
    alignas(16) unsigned char known[sizeof(FwOffscreenDef) + sizeof(FwMaterialDef) + 256];
    const edge::DefRow* row = edge::findDef(defType);
    std::memset(def, 0, structSize);
    if (row && row->size <= sizeof known) {
        row->writeDefaults(known);
        std::memcpy(def, known, std::min<size_t>(row->size, structSize));
    }
    std::memcpy(def, &structSize, std::min<size_t>(sizeof structSize, structSize));
}

FwResult FW_CALL fwInitMaterialPreset(FwMaterialDef* def, uint32_t preset) {
    return initPreset(__func__, def, preset, FW_MATERIAL_PRESET_COUNT,
                      [&] { return world::presetDef(preset); });
}

FwResult FW_CALL fwInitFirePreset(FwVolumetricFireDef* def, uint32_t preset) {
    return initPreset(__func__, def, preset, FW_FIRE_PRESET_COUNT, [&] {
        FwVolumetricFireDef filled = edge::readDef(def);
        components::setFirePreset(filled, preset);
        return filled;
    });
}

FwResult FW_CALL fwInitFieldPreset(FwParticleFieldDef* def, uint32_t preset) {
    return initPreset(__func__, def, preset, FW_FIELD_PRESET_COUNT, [&] {
        FwParticleFieldDef filled = edge::readDef(def);
        components::setFieldPreset(filled, preset);
        return filled;
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
    static constexpr struct {
        int32_t result;
        const char* name;
    } kNames[] = {
#define FW_NAMED(result) {result, #result}
        FW_NAMED(FW_NOTHING_THERE),
        FW_NAMED(FW_NOT_READY),
        FW_NAMED(FW_OK),
        FW_NAMED(FW_ERROR_INVALID_ARGUMENT),
        FW_NAMED(FW_ERROR_STALE_ID),
        FW_NAMED(FW_ERROR_VERSION),
        FW_NAMED(FW_ERROR_OUT_OF_MEMORY),
        FW_NAMED(FW_ERROR_UNSUPPORTED_DEVICE),
        FW_NAMED(FW_ERROR_DEVICE_LOST),
        FW_NAMED(FW_ERROR_BAD_DATA),
        FW_NAMED(FW_ERROR_WRONG_BACKEND),
        FW_NAMED(FW_ERROR_INTERNAL),
#undef FW_NAMED
    };
    for (const auto& row : kNames)
        if (row.result == result) return row.name;
    return "an unknown FwResult";
}

}  // extern "C"
