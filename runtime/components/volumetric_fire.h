// A volumetric fire as plain data: what the host asked for, what of it moves, and the functions
// that make a frame's flames of it. Looks alone: floats, and nothing decides by them.
#pragma once
#include "flamewright/flamewright.h"
#include "shared/volume_flame.h"
#include "volume/curve.h"
#include "volume/look.h"

#include <array>
#include <cstddef>
#include <memory_resource>
#include <span>
#include <vector>

namespace fw::components {

static_assert(gpu::kFirePresets == FW_FIRE_PRESET_COUNT);

struct FireAir {         // of the world
    float wind[3] = {};  // m/s
    float up[3] = {0, 1, 0};
};

// What time changes. A frame computes the next one from the last and takes it when it is recorded.
struct FireMotion {
    volume::FlameScroll scroll;
    double time = 0;        // s of its own
    float power = -1;       // kW, smoothed; < 0: it takes the def's at once
    gpu::vec3 base{0.0f};   // m, world
    gpu::vec3 drift{0.0f};  // m/s, air against its base, smoothed
};

struct FireState {  // what is told of it, see FwVolumetricFireState
    uint32_t flames = 0;
    float power = 0, height = 0, pulseRate = 0;
    volume::Bounds bounds;
    gpu::vec3 tip{0.0f}, light{0.0f};
    float intensity = 0;  // W/sr
};

struct VolumetricFire {
    volume::FlameLook look;
    uint32_t flags = 0;  // FwVolumetricFireFlags
    uint32_t preset = 0, seed = 0;
    float position[3] = {};         // m, world
    float diameter = 0, power = 0;  // m; kW
    float windResponse = 1;
    std::array<volume::ControlPoint, volume::kMaxControlPoints> points{};
    uint32_t pointCount = 0;
    uint64_t userData = 0;
    FireMotion motion, next;
    FireState state, nextState;
};

void setFirePreset(FwVolumetricFireDef& def, uint32_t preset);
const char* firePresetName(uint32_t preset) noexcept;
// As LookSources::profiles wants them.
std::pmr::vector<std::byte> bakeFireProfiles(std::pmr::memory_resource* memory);

// Throw where a value is out of its limits, and then changed nothing.
VolumetricFire makeVolumetricFire(const FwVolumetricFireDef& def, uint32_t ownSeed);
void setFirePower(VolumetricFire& fire, float power);
void setFirePosition(VolumetricFire& fire, const float position[3]);
void setFirePoints(VolumetricFire& fire, const FwFirePoint* points, uint32_t count,
                   const char* name);

// `seconds` later: fills fire.next and fire.nextState, and writes its flames; how many. Those that
// do not fit are left out.
uint32_t advanceFire(VolumetricFire& fire, const FireAir& air, float seconds,
                     std::span<gpu::VolumeFlame> out) noexcept;
void commitFire(VolumetricFire& fire) noexcept;

FwLight fireLight(const VolumetricFire& fire, uint32_t id, uint64_t frameIndex) noexcept;
void fillFireState(const VolumetricFire& fire, FwVolumetricFireState& state) noexcept;

}  // namespace fw::components
