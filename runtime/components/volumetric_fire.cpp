#include "components/volumetric_fire.h"

#include "components/pose.h"
#include "core/assert.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/reserved.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace fw::components {
namespace {

using gpu::vec3;

void checkPoint(const FwFirePoint& point, const char* name, uint32_t index) {
    char field[96];
    std::snprintf(field, sizeof field, "%s[%u].position", name, index);
    checkLengths(point.position, 3, field, -1e6f, 1e6f);
    std::snprintf(field, sizeof field, "%s[%u].radius", name, index);
    checkLength(point.radius, field, 0.0f, 100.0f);
}

// Divides the fire into one flame or many. Small changes of power keep the division, so that flames
// keep their places.
void splitAgain(VolumetricFire& fire) noexcept {
    std::array<volume::Flamelet, volume::kMaxFlamelets> parts;
    uint32_t count = 1;
    const bool led = fire.pointCount > 0 || fire.tracked();
    if (led)
        parts[0] = {0, 0, fire.power, fire.diameter, 0};
    else
        count = volume::splitFire(fire.power, fire.diameter, parts);
    FW_ASSERT(count >= 1 && count <= parts.size() && fire.diameter > 0, "%u parts of %g m", count,
              double(fire.diameter));
    const uint32_t before = fire.partCount;
    const float tall = volume::flameHeight(fire.power, fire.diameter) / fire.diameter;
    bool keep = before > 0 && !led;
    if (fire.power > 0 && keep) {
        if (before == 1)
            keep = count == 1 || tall > 0.4f;
        else if (count == 1)
            keep = tall < 0.6f;
        else
            keep = 3 * count < 4 * before && 4 * count > 3 * before;
    }
    if (led && before == 1) keep = true;
    if (!keep) {
        fire.parts = parts;
        fire.partCount = count;
        ++fire.split;
        return;
    }
    FW_ASSERT(before >= 1 && before <= fire.parts.size(), "%u parts", before);
    for (uint32_t i = 0; i < before; ++i) fire.parts[i].power = fire.power / float(before);
    if (before == 1) fire.parts[0].diameter = fire.diameter;
}

}  // namespace

void setFirePreset(FwVolumetricFireDef& def, uint32_t preset) {
    const volume::FlamePresetDef from = volume::presetDef(volume::FlamePreset(preset));
    def.preset = preset;
    def.power = from.power;
    def.diameter = from.diameter;
}

const char* firePresetName(uint32_t preset) noexcept {
    return volume::presetName(volume::FlamePreset(preset));
}

std::pmr::vector<std::byte> bakeFireProfiles(std::pmr::memory_resource* memory) {
    std::pmr::vector<std::byte> all(memory);
    volume::Profile profile;
    all.resize(gpu::kFirePresets * sizeof profile.texels);
    for (uint32_t i = 0; i < gpu::kFirePresets; ++i) {
        volume::paintDefaultProfile(volume::presetDef(volume::FlamePreset(i)).appearance, profile);
        std::memcpy(all.data() + i * sizeof profile.texels, profile.texels.data(),
                    sizeof profile.texels);
    }
    return all;
}

void readFireProfile(const FwFireProfileDef& def, std::pmr::memory_resource* memory,
                     volume::Profile& profile) {
    checkWhole(def.flags, "FwFireProfileDef::flags", 0, 0);
    if (def.cooked) {
        if (def.cookedSize > SIZE_MAX)
            core::refuse("FwFireProfileDef::cookedSize is %llu.",
                         static_cast<unsigned long long>(def.cookedSize));
        volume::readProfile({static_cast<const std::byte*>(def.cooked), size_t(def.cookedSize)},
                            profile);
        return;
    }
    checkWhole(def.width, "FwFireProfileDef::width", volume::kMinProfileSide,
               volume::kMaxProfileSide);
    checkWhole(def.height, "FwFireProfileDef::height", volume::kMinProfileSide,
               volume::kMaxProfileSide);
    if (!def.texels)
        core::refuse("FwFireProfileDef::texels is null, and so is FwFireProfileDef::cooked.");
    const size_t count = size_t(def.width) * def.height;
    std::pmr::vector<float> planes(2 * count, memory);
    for (size_t i = 0; i < count; ++i) {
        planes[i] = def.texels[2 * i];
        planes[count + i] = def.texels[2 * i + 1];
    }
    const std::span<const float> both(planes);
    volume::paintProfile(both.first(count), both.subspan(count), def.width, def.height, profile);
}

void makeVolumetricFire(const FwVolumetricFireDef& def, uint32_t ownSeed, VolumetricFire& fire) {
    constexpr uint32_t kKnown = FW_FIRE_HIDDEN | FW_FIRE_NO_SMOKE | FW_FIRE_NO_LIGHT |
                                FW_FIRE_NO_COLLISION | FW_FIRE_IGNITES;
    checkFlags(def.flags, "FwVolumetricFireDef::flags", kKnown);
    checkWhole(def.preset, "FwVolumetricFireDef::preset", 0, FW_FIRE_PRESET_COUNT - 1);
    checkLength(def.diameter, "FwVolumetricFireDef::diameter", 0.002f, 20.0f);
    checkValue(def.windResponse, "FwVolumetricFireDef::windResponse", 0.0f, 4.0f);
    checkValue(def.turbulence, "FwVolumetricFireDef::turbulence", 0.0f, 3.0f);
    checkValue(def.speed, "FwVolumetricFireDef::speed", 0.0f, 4.0f);
    checkValue(def.density, "FwVolumetricFireDef::density", 0.0f, 10.0f);
    checkValue(def.smoke, "FwVolumetricFireDef::smoke", 0.0f, 10.0f);
    checkValue(def.blue, "FwVolumetricFireDef::blue", 0.0f, 10.0f);
    checkValues(def.tint, 3, "FwVolumetricFireDef::tint", 0.0f, 1.0f);
    checkValue(def.tintWeight, "FwVolumetricFireDef::tintWeight", 0.0f, 1.0f);
    checkValues(def.coreTint, 3, "FwVolumetricFireDef::coreTint", 0.0f, 1.0f);
    checkValue(def.coreTintWeight, "FwVolumetricFireDef::coreTintWeight", 0.0f, 1.0f);
    checkValue(def.blend, "FwVolumetricFireDef::blend", 0.0f, 60.0f);
    fire.diameter = def.diameter;
    setFirePosition(fire, def.position);
    setFirePower(fire, def.power);
    setFireTier(fire, def.tier, "FwVolumetricFireDef::tier");
    setFirePoints(fire, def.points, def.pointCount, "FwVolumetricFireDef::points");
    fire.flags = def.flags;
    fire.preset = fire.profile = def.preset;
    fire.ownProfile = def.profile;
    fire.seed = def.seed ? def.seed : ownSeed;
    fire.windResponse = def.windResponse;
    fire.blend = def.blend;
    fire.userData = def.userData;
    volume::FlameAppearance& appearance = fire.appearance;
    appearance = volume::presetDef(volume::FlamePreset(def.preset)).appearance;
    appearance.turbulence *= def.turbulence;
    appearance.warp *= def.turbulence;
    appearance.columns *= def.turbulence;
    appearance.burn *= def.speed;
    appearance.thickness *= def.density;
    appearance.smoke *= def.smoke;
    appearance.blue *= def.blue;
    if (def.flags & FW_FIRE_NO_SMOKE) appearance.smoke = 0;
    if (appearance.smoke <= 0) appearance.smokeTop = 1;
    if (def.tintWeight > 0) {
        std::copy_n(def.tint, 3, appearance.tint);
        appearance.tint[3] = def.tintWeight;
    }
    std::copy_n(def.coreTint, 3, appearance.coreTint);
    appearance.coreTint[3] = def.coreTintWeight;
}

uint32_t maxParts(float power, float diameter) noexcept {
    std::array<volume::Flamelet, volume::kMaxFlamelets> parts;
    return power > 0 && power <= kMaxPower ? volume::splitFire(power, diameter, parts) : 1;
}

void setFirePower(VolumetricFire& fire, float power) {
    checkValue(power, "power", 0.0f, kMaxPower);
    fire.power = power;
    splitAgain(fire);
}

void setFirePosition(VolumetricFire& fire, const float position[3]) {
    checkLengths(position, 3, "position", -1e6f, 1e6f);
    std::copy_n(position, 3, fire.position);
}

void setFireTier(VolumetricFire& fire, uint32_t tier, const char* name) {
    checkWhole(tier, name, 0, FW_FIRE_TIER_SHARED_IMPOSTOR);
    core::reserved::checkFireTier(tier, name);
    fire.tier = tier;
}

void setFirePoints(VolumetricFire& fire, const FwFirePoint* points, uint32_t count,
                   const char* name) {
    if (count == 1 || count > volume::kMaxControlPoints)
        core::refuse("pointCount is %u; it is 0 or in [2, %u].", count, volume::kMaxControlPoints);
    if (count > 0 && !points) core::refuse("%s is null.", name);
    for (uint32_t i = 0; i < count; ++i) checkPoint(points[i], name, i);
    for (uint32_t i = 0; i < count; ++i)
        fire.points[i] = {volume::vecOf(points[i].position), points[i].radius};
    fire.pointCount = count;
    splitAgain(fire);
}

void setFireTrack(VolumetricFire& fire, const FwFireTrackDef* def) {
    volume::Track track(fire.track.times.get_allocator().resource());
    if (def) {
        checkWhole(def->flags, "FwFireTrackDef::flags", 0, FW_FIRE_TRACK_LOOP);
        checkWhole(def->reserved, "FwFireTrackDef::reserved", 0, 0);
        checkWhole(def->keyCount, "FwFireTrackDef::keyCount", 1, 4096);
        checkWhole(def->pointsPerKey, "FwFireTrackDef::pointsPerKey", 2, volume::kMaxControlPoints);
        checkValue(def->weight, "FwFireTrackDef::weight", 0.0f, 1.0f);
        if (!def->times) core::refuse("FwFireTrackDef::times is null.");
        if (!def->points) core::refuse("FwFireTrackDef::points is null.");
        const uint32_t count = def->keyCount * def->pointsPerKey;
        std::pmr::vector<volume::ControlPoint> points(track.points.get_allocator());
        points.reserve(count);
        for (uint32_t i = 0; i < count; ++i) {
            checkPoint(def->points[i], "FwFireTrackDef::points", i);
            points.push_back({volume::vecOf(def->points[i].position), def->points[i].radius});
        }
        volume::setTrack(track, {def->times, def->keyCount}, points, def->pointsPerKey,
                         (def->flags & FW_FIRE_TRACK_LOOP) != 0);
    }
    fire.track = std::move(track);
    fire.trackWeight = def ? def->weight : 1.0f;
    ++fire.trackVersion;
    splitAgain(fire);
}

FwLight fireLight(const VolumetricFire& fire, uint32_t id, uint64_t frameIndex) noexcept {
    FW_ASSERT(fire.diameter > 0, "%g m", double(fire.diameter));
    FwLight light{};
    for (int i = 0; i < 3; ++i) {
        light.position[i] = fire.state.light[i];
        light.color[i] = fire.state.colour[i];
    }
    light.radius = std::max(0.3f * fire.diameter, 0.01f);
    light.intensity = fire.state.intensity;
    light.power = 1000.0f * fire.state.power;
    light.id = id;
    light.frameIndex = frameIndex;
    return light;
}

void fillFireState(const VolumetricFire& fire, FwVolumetricFireState& out) noexcept {
    const FireState& state = fire.state;
    out.flames = state.flames;
    out.userData = fire.userData;
    out.power = state.power;
    out.height = state.height;
    out.pulseRate = state.pulseRate;
    out.contactPower = state.contactPower;
    for (int i = 0; i < 3; ++i) {
        out.boundsLow[i] = state.bounds.low[i];
        out.boundsHigh[i] = state.bounds.high[i];
        out.tip[i] = state.tip[i];
        out.lightPosition[i] = state.light[i];
        out.contact[i] = state.contact[i];
    }
    out.lightIntensity = state.intensity;
}

}  // namespace fw::components
