// A volumetric fire as plain data: its checked def and its reported state. Its flames are in
// fire_flames.h. Cosmetic: floats, and no decision of the simulation depends on them.
#pragma once
#include "components/pose.h"
#include "flamewright/flamewright.h"
#include "shared/volume_draw.h"
#include "volume/flame.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory_resource>
#include <span>
#include <vector>

namespace fw::components {

static_assert(gpu::kFirePresets == FW_FIRE_PRESET_COUNT);

struct FireState {      // reported state, see FwVolumetricFireState
    bool lit = false;   // a frame has advanced it
    bool mean = false;  // sums have become means
    uint32_t flames = 0;
    float power = 0, height = 0, pulseRate = 0, contactPower = 0;
    volume::Bounds bounds;
    gpu::vec3 tip{0.0f}, light{0.0f}, colour{1.0f}, contact{0.0f};
    float intensity = 0;  // W/sr
};

struct FireControls {        // that the host turns while it burns
    float position[3] = {};  // m, world
    float power = 0;         // kW
    std::array<volume::ControlPoint, volume::kMaxControlPoints> points{};
    uint32_t pointCount = 0;

    bool operator==(const FireControls& other) const noexcept {
        const auto same = [](const volume::ControlPoint& a, const volume::ControlPoint& b) {
            return a.position == b.position && a.radius == b.radius;
        };
        return std::equal(position, position + 3, other.position) && power == other.power &&
               std::equal(points.begin(), points.begin() + pointCount, other.points.begin(),
                          other.points.begin() + other.pointCount, same);
    }
    template <class A>
    void serialize(A& a) {
        a(position, power, pointCount);
        a.range("volumetric fire's place", position, -1e6, 1e6);
        a.range("volumetric fire's power", power, 0, kMaxPower);
        a.require(pointCount != 1 && pointCount <= points.size(),
                  "number of points of a volumetric fire");
        for (uint32_t i = 0; i < pointCount; ++i) {
            auto& [place, radius] = points[i];
            for (int k = 0; k < 3; ++k) a(place[k]), a.range("fire's point", place[k], -1e6, 1e6);
            a(radius);
            a.range("radius of a fire's point", radius, 0, 100);
        }
    }
};

struct VolumetricFire : FireControls {
    explicit VolumetricFire(std::pmr::memory_resource* memory) : track(memory) {}

    volume::FlameAppearance appearance;
    uint32_t flags = 0;  // FwVolumetricFireFlags
    uint32_t tier = 0;   // FwFireTier
    uint32_t preset = 0, seed = 0;
    uint32_t profile = 0;          // layer
    FwFireProfileId ownProfile{};  // the host's, or null
    float diameter = 0;            // m
    float windResponse = 1, blend = 0.3f;
    float wind[3] = {};   // m/s, at its place
    volume::Track track;  // no keys: none
    float trackWeight = 1;
    uint32_t trackVersion = 0;
    uint64_t userData = 0;
    // Its division into one flame or many small ones. A new division has a new `split`; its flames
    // grow while the flames of the last one die down.
    std::array<volume::Flamelet, volume::kMaxFlamelets> parts{};
    uint32_t partCount = 0, split = 0;
    FireState state, nextState;

    [[nodiscard]] bool tracked() const noexcept { return !track.times.empty(); }
};

void setFirePreset(FwVolumetricFireDef& def, uint32_t preset);
const char* firePresetName(uint32_t preset) noexcept;
// The data of AppearanceSources::profiles.
std::pmr::vector<std::byte> bakeFireProfiles(std::pmr::memory_resource* memory);
// From a host's texels or cooked bytes. Throws core::Error; `profile` is then unchanged.
void readFireProfile(const FwFireProfileDef& def, std::pmr::memory_resource* memory,
                     volume::Profile& profile);

// Throw core::Error if a value is out of its limits, and then change nothing. The caller sets the
// profile's layer.
void makeVolumetricFire(const FwVolumetricFireDef& def, uint32_t ownSeed, VolumetricFire& fire);
uint32_t maxParts(float power, float diameter) noexcept;  // flames that it would divide into
void setFirePower(VolumetricFire& fire, float power);
void setFirePosition(VolumetricFire& fire, const float position[3]);
void setFireTier(VolumetricFire& fire, uint32_t tier, const char* name);
void setFirePoints(VolumetricFire& fire, const FwFirePoint* points, uint32_t count,
                   const char* name);
void setFireTrack(VolumetricFire& fire, const FwFireTrackDef* def);

// One light for all of it.
FwLight fireLight(const VolumetricFire& fire, uint32_t id, uint64_t frameIndex) noexcept;
void fillFireState(const VolumetricFire& fire, FwVolumetricFireState& state) noexcept;

}  // namespace fw::components
