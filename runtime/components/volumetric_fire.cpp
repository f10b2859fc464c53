#include "components/volumetric_fire.h"

#include "components/pose.h"
#include "core/error.h"
#include "core/hash.h"
#include "volume/march.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace fw::components {
namespace {

using gpu::vec3;
using gpu::vec4;

constexpr float kOut = 1e-4f;        // kW below which nothing is left to see
constexpr float kPowerTime = 0.3f;   // s in which a flame follows its power
constexpr float kDriftTime = 0.15f;  // s in which it follows wind and motion
constexpr float kFastest = 30.0f;    // m/s of air against it that still bends it more
constexpr uint32_t kColumn = 8;      // control points of a flame that rises by itself

vec3 vecOf(const float v[3]) noexcept { return {v[0], v[1], v[2]}; }

float hashUnit(uint32_t x) noexcept { return float(core::hash32(x) >> 8) / 16777216.0f; }

void checkWhole(uint32_t value, const char* name, uint32_t most) {
    if (value > most)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "%s is %u; the limits are [0, %u].", name, value,
                   most);
}

// Two directions across `up`.
void across(vec3 up, vec3& x, vec3& z) noexcept {
    const vec3 other = std::abs(up.x) < 0.6f ? vec3(1, 0, 0) : vec3(0, 0, 1);
    z = glm::normalize(glm::cross(other, up));
    x = glm::cross(up, z);
}

// Gas rises at McCaffrey's speed and is carried along by the air: the flame is the way it takes.
void riseOf(vec3 base, vec3 up, vec3 drift, float power, float length, float radius,
            std::array<volume::ControlPoint, kColumn>& out) noexcept {
    const float step = length / float(kColumn - 1);
    vec3 at = base;
    float s = 0.0f;
    for (volume::ControlPoint& point : out) {
        point = {at, radius};
        const float rise = std::max(volume::plumeSpeed(power, s + 0.5f * step), 0.05f);
        at += glm::normalize(up * rise + drift) * step;
        s += step;
    }
}

// No two sines of it meet again, and no two fires share them.
float flickerOf(const VolumetricFire& fire, const FireMotion& motion) noexcept {
    const auto t = float(std::fmod(motion.time, 4096.0));
    const float p = 6.2832f * hashUnit(fire.seed);
    return 1.0f + fire.look.flicker * (0.6f * std::sin(6.2832f * float(motion.scroll.puff)) +
                                       0.25f * std::sin(17.9f * t + 2.3f * p) +
                                       0.15f * std::sin(29.1f * t + 4.1f * p));
}

struct Place {
    vec3 base, up, drift;
};

void writeFlame(const VolumetricFire& fire, const FireMotion& motion, const Place& place,
                const volume::FlameSize& size, const volume::Curve* given, uint32_t seed,
                gpu::VolumeFlame& out) noexcept {
    volume::FlameScroll scroll = motion.scroll;
    scroll.puff += double(hashUnit(seed ^ 0x9E3779B9u));  // small flames do not pulse together
    scroll.puff -= std::floor(scroll.puff);
    gpu::FlameRecord& record = out.record;
    record = volume::describeFlame(fire.look, size, scroll, seed);
    if (fire.flags & FW_FIRE_NO_SMOKE) record.smoke = 0.0f;
    record.profile = fire.preset;
    record.nodeCount = gpu::kFlameNodes;
    const float length = volume::topOf(record);
    volume::FlameNodes nodes;
    if (given) {
        volume::layNodes(*given, length, nodes);
    } else {
        std::array<volume::ControlPoint, kColumn> points;
        riseOf(place.base, place.up, place.drift, size.power, length, 0.5f * size.diameter, points);
        volume::Curve curve;
        curve.set(points, place.up);
        volume::layNodes(curve, length, nodes);
    }
    std::copy(nodes.begin(), nodes.end(), std::begin(out.nodes));
    const volume::Bounds bounds = volume::flameBounds(record, nodes);
    record.low = vec4(bounds.low, record.low.w);
    record.high = vec4(bounds.high, record.high.w);
    // Smoke is lit from where the flame is brightest.
    const size_t at = std::min<size_t>(
        size_t(0.4f * size.height / length * float(gpu::kFlameNodes)), gpu::kFlameNodes - 1);
    record.glow = vec4(vec3(nodes[at].centre), 0.06f * size.diameter * size.diameter);
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
        volume::paintLook(volume::presetDef(volume::FlamePreset(i)).look, profile);
        std::memcpy(all.data() + i * sizeof profile.texels, profile.texels.data(),
                    sizeof profile.texels);
    }
    return all;
}

VolumetricFire makeVolumetricFire(const FwVolumetricFireDef& def, uint32_t ownSeed) {
    constexpr uint32_t kKnown = FW_FIRE_HIDDEN | FW_FIRE_NO_SMOKE | FW_FIRE_NO_LIGHT;
    if (def.flags & ~kKnown)
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "FwVolumetricFireDef::flags is 0x%x; the known flags are 0x%x.", def.flags,
                   kKnown);
    checkWhole(def.preset, "FwVolumetricFireDef::preset", FW_FIRE_PRESET_COUNT - 1);
    checkValue(def.diameter, "FwVolumetricFireDef::diameter", 0.002f, 20.0f);
    checkValue(def.windResponse, "FwVolumetricFireDef::windResponse", 0.0f, 4.0f);
    checkValue(def.turbulence, "FwVolumetricFireDef::turbulence", 0.0f, 3.0f);
    checkValue(def.speed, "FwVolumetricFireDef::speed", 0.0f, 4.0f);
    checkValue(def.density, "FwVolumetricFireDef::density", 0.0f, 10.0f);
    checkValue(def.smoke, "FwVolumetricFireDef::smoke", 0.0f, 10.0f);
    checkValue(def.blue, "FwVolumetricFireDef::blue", 0.0f, 10.0f);
    checkValues(def.tint, 3, "FwVolumetricFireDef::tint", 0.0f, 1.0f);
    checkValue(def.tintWeight, "FwVolumetricFireDef::tintWeight", 0.0f, 1.0f);
    VolumetricFire fire;
    setFirePosition(fire, def.position);
    setFirePower(fire, def.power);
    setFirePoints(fire, def.points, def.pointCount, "FwVolumetricFireDef::points");
    fire.flags = def.flags;
    fire.preset = def.preset;
    fire.seed = def.seed ? def.seed : ownSeed;
    fire.diameter = def.diameter;
    fire.windResponse = def.windResponse;
    fire.userData = def.userData;
    volume::FlameLook& look = fire.look;
    look = volume::presetDef(volume::FlamePreset(def.preset)).look;
    look.turbulence *= def.turbulence;
    look.warp *= def.turbulence;
    look.columns *= def.turbulence;
    look.burn *= def.speed;
    look.thickness *= def.density;
    look.smoke *= def.smoke;
    look.blue *= def.blue;
    if (def.tintWeight > 0) {
        std::copy_n(def.tint, 3, look.tint);
        look.tint[3] = def.tintWeight;
    }
    // Fires that begin together do not pulse together.
    FireMotion& motion = fire.motion;
    motion.base = vecOf(def.position);
    motion.scroll.puff = double(hashUnit(fire.seed));
    fire.next = motion;
    return fire;
}

void setFirePower(VolumetricFire& fire, float power) {
    checkValue(power, "power", 0.0f, 1e5f);
    fire.power = power;
}

void setFirePosition(VolumetricFire& fire, const float position[3]) {
    checkValues(position, 3, "position", -1e6f, 1e6f);
    std::copy_n(position, 3, fire.position);
}

void setFirePoints(VolumetricFire& fire, const FwFirePoint* points, uint32_t count,
                   const char* name) {
    if (count == 1 || count > volume::kMaxControlPoints)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "pointCount is %u; it is 0 or in [2, %u].", count,
                   volume::kMaxControlPoints);
    if (count > 0 && !points) core::fail(FW_ERROR_INVALID_ARGUMENT, "%s is null.", name);
    for (uint32_t i = 0; i < count; ++i) {
        char field[96];
        std::snprintf(field, sizeof field, "%s[%u].position", name, i);
        checkValues(points[i].position, 3, field, -1e6f, 1e6f);
        std::snprintf(field, sizeof field, "%s[%u].radius", name, i);
        checkValue(points[i].radius, field, 0.0f, 100.0f);
    }
    for (uint32_t i = 0; i < count; ++i)
        fire.points[i] = {vecOf(points[i].position), points[i].radius};
    fire.pointCount = count;
}

uint32_t advanceFire(VolumetricFire& fire, const FireAir& air, float seconds,
                     std::span<gpu::VolumeFlame> out) noexcept {
    FireMotion& next = fire.next;
    next = fire.motion;
    FireState& state = fire.nextState;
    state = {};
    const vec3 up = vecOf(air.up);
    const vec3 before = next.base;
    next.base = vecOf(fire.position);
    next.time += double(seconds);
    const bool first = next.power < 0;
    const float follow = 1.0f - std::exp(-seconds / kPowerTime);
    next.power = first ? fire.power : next.power + (fire.power - next.power) * follow;
    vec3 against = vecOf(air.wind) * fire.windResponse;
    if (seconds > 0 && !first) against -= (next.base - before) / seconds;
    const float speed = glm::length(against);
    if (speed > kFastest) against *= kFastest / speed;
    if (!std::isfinite(speed)) against = vec3(0.0f);
    next.drift =
        first ? against
              : next.drift + (against - next.drift) * (1.0f - std::exp(-seconds / kDriftTime));
    if (next.power < kOut && fire.power < kOut) return 0;

    const float power = std::max(next.power, kOut);
    volume::Curve curve;
    const volume::Curve* given = nullptr;
    std::array<volume::Flamelet, volume::kMaxFlamelets> parts;
    uint32_t count = 1;
    if (fire.pointCount) {
        curve.set({fire.points.data(), fire.pointCount}, up);
        given = &curve;
        parts[0] = {0, 0, power, std::max(2 * fire.points[0].radius, 0.002f),
                    std::max(curve.length(), 0.002f)};
        next.base = fire.points[0].position;
    } else {
        count = volume::splitFire(power, fire.diameter, parts);
    }
    volume::FlameSize size{parts[0].power, parts[0].diameter, parts[0].height, 1.0f};
    volume::advanceScroll(next.scroll, fire.look,
                          volume::describeFlame(fire.look, size, next.scroll, fire.seed),
                          double(seconds));

    state.power = next.power;
    state.pulseRate = volume::puffFrequency(parts[0].diameter);
    state.intensity = 1000.0f * power * fire.look.radiant / 12.566f * flickerOf(fire, next);
    vec3 x, z;
    across(up, x, z);
    uint32_t written = 0;
    for (uint32_t i = 0; i < count && written < out.size(); ++i) {
        const volume::Flamelet& part = parts[i];
        size = {part.power, part.diameter, part.height, 1.0f};
        const Place place{next.base + x * part.x + z * part.z, up, next.drift};
        gpu::VolumeFlame& flame = out[written];
        writeFlame(fire, next, place, size, given, fire.seed + 0x632BE5ABu * i, flame);
        const vec3 low(flame.record.low), high(flame.record.high);
        state.bounds.low = written ? glm::min(state.bounds.low, low) : low;
        state.bounds.high = written ? glm::max(state.bounds.high, high) : high;
        state.height = std::max(state.height, part.height);
        const auto nodeAt = [&](float s) {
            const float step = std::max(flame.nodes[1].along.w, 1e-6f);
            return vec3(flame.nodes[size_t(std::clamp(s / step, 0.0f, float(gpu::kFlameNodes - 1)))]
                            .centre);
        };
        if (written == 0) {
            state.tip = nodeAt(part.height);
            state.light = nodeAt(0.4f * part.height);
        }
        ++written;
    }
    state.flames = written;
    return (fire.flags & FW_FIRE_HIDDEN) ? 0 : written;
}

void commitFire(VolumetricFire& fire) noexcept {
    fire.motion = fire.next;
    fire.state = fire.nextState;
}

FwLight fireLight(const VolumetricFire& fire, uint32_t id, uint64_t frameIndex) noexcept {
    FwLight light{};
    for (int i = 0; i < 3; ++i) light.position[i] = fire.state.light[i];
    light.radius = std::max(0.3f * fire.diameter, 0.01f);
    const volume::FlameLook& look = fire.look;
    vec3 color = gpu::sootRadiance(0.5f * (look.core + look.tip));
    color = glm::mix(color, vec3(look.tint[0], look.tint[1], look.tint[2]), look.tint[3]);
    const float luminance = glm::dot(color, vec3(0.2126f, 0.7152f, 0.0722f));
    for (int i = 0; i < 3; ++i) light.color[i] = color[i] / std::max(luminance, 1e-6f);
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
    for (int i = 0; i < 3; ++i) {
        out.boundsLow[i] = state.bounds.low[i];
        out.boundsHigh[i] = state.bounds.high[i];
        out.tip[i] = state.tip[i];
        out.lightPosition[i] = state.light[i];
    }
    out.lightIntensity = state.intensity;
}

}  // namespace fw::components
