#include "components/fire_flames.h"

#include "core/assert.h"

#include <algorithm>
#include <cmath>

namespace fw::components {
namespace {

using gpu::vec3;
using gpu::vec4;

constexpr float kOut = 1e-4f;              // kW; a flame below it is invisible
constexpr size_t kNearColliders = 16;      // most colliders of one flame
constexpr float kMaxFlux = 200000.0f;      // W/m^2
constexpr float kLumensPerWatt = 0.4f;     // of FlameLight::flux
constexpr float kFullCircle = 12.566371f;  // sr of a sphere

// Two directions across `up`.
void across(vec3 up, vec3& x, vec3& z) noexcept {
    const vec3 other = std::abs(up.x) < 0.6f ? vec3(1, 0, 0) : vec3(0, 0, 1);
    z = glm::normalize(glm::cross(other, up));
    x = glm::cross(up, z);
}

float aloneHeight(float power, float diameter) noexcept {
    return std::max(volume::flameHeight(power, diameter), 0.5f * diameter);
}

struct Near {
    std::array<volume::Collider, kNearColliders> list;
    size_t count = 0;
};

// Collects colliders that may be within the flame's bounds. Height fields and depth pictures have
// no distance to test: they are always near.
void findNear(const FireFlame& f, std::span<const volume::Collider> all, float seconds,
              Near& near) noexcept {
    near.count = 0;
    if (f.fire->flags & FW_FIRE_NO_COLLISION) return;
    const volume::Bounds& b = f.flame.bounds;
    const vec3 middle = 0.5f * (b.low + b.high);
    const float reach = glm::length(0.5f * (b.high - b.low)) + 0.2f + f.flame.size.diameter +
                        glm::length(f.flame.motion.base - f.flame.def.position) + 10.0f * seconds;
    for (const volume::Collider& c : all) {
        if (near.count == near.list.size()) return;
        const bool bounded =
            c.kind != volume::ColliderKind::HeightField && c.kind != volume::ColliderKind::Depth;
        if (bounded && volume::surfaceOf(c, middle).distance > reach) continue;
        near.list[near.count++] = c;
    }
}

// Adds a flame to a fire's state, whose light and colour are sums until takeMeans.
void addFlame(FireState& s, float power, float diameter, float height, vec3 tip,
              const volume::FlameLight& light) noexcept {
    const float weight = std::max(light.flux, 1e-12f);
    if (s.flames == 0) s.light = s.colour = vec3(0.0f);
    if (height > s.height || s.flames == 0) {
        s.height = height;
        s.tip = tip;
        s.pulseRate = volume::puffFrequency(diameter);
    }
    ++s.flames;
    s.power += power;
    s.light += weight * light.position;
    s.colour += weight * light.colour;
    s.intensity += weight;
}

void takeMeans(FireState& s) noexcept {
    FW_ASSERT(s.flames > 0 && s.intensity > 0);
    s.light /= s.intensity;
    s.colour /= s.intensity;
    s.intensity /= kLumensPerWatt * kFullCircle;
}

const gpu::FlameNode& nodeAt(const volume::Flame& f, float s) noexcept {
    FW_ASSERT(f.nodes.size() >= 2, "%zu nodes", f.nodes.size());
    const float step = std::max(f.nodes[1].along.w - f.nodes[0].along.w, 1e-6f);
    return f.nodes[size_t(std::clamp(s / step + 0.5f, 0.0f, float(f.nodes.size() - 1)))];
}

}  // namespace

size_t FireFlames::reserveFlames(size_t more) {
    const size_t wanted = std::min<size_t>(now_.size() + more, gpu::kMaxVolumeFlames);
    size_t room = now_.capacity();
    if (room < wanted)
        room = std::min<size_t>(std::max(wanted, room + room / 2), gpu::kMaxVolumeFlames);
    now_.reserve(room);
    next_.reserve(room);
    others_.reserve(room);
    met_.reserve(room);
    FW_ASSERT(room >= wanted && room <= gpu::kMaxVolumeFlames, "%zu of %zu flames", room, wanted);
    return room;
}

void FireFlames::drop(const VolumetricFire& fire) noexcept {
    std::erase_if(now_, [&](const FireFlame& f) { return f.fire == &fire; });
}

void FireFlames::carry(vec3 by) noexcept {
    for (FireFlame& f : now_) {
        volume::carryFlame(f.flame, by);
        f.flame.def.position += by;
        f.stood += by;
    }
}

// Sets a flame's def from its fire.
void FireFlames::place(FireFlame& f, const FireAir& air) const noexcept {
    const VolumetricFire& fire = *f.fire;
    FW_ASSERT(f.part < fire.parts.size(), "part %u", f.part);
    const volume::Flamelet& part = fire.parts[f.part];
    volume::Flame& flame = f.flame;
    volume::FlameDef& def = flame.def;
    vec3 x, z;
    def.up = volume::vecOf(air.up);
    across(def.up, x, z);
    f.stood = volume::vecOf(fire.position);
    def.position = f.stood + x * part.x + z * part.z;
    def.power = part.power;
    def.diameter = part.diameter;
    def.appearance = fire.appearance;
    def.blend = fire.blend;
    def.profile = fire.profile;
    def.weight = 1.0f;
    def.driver = volume::FlameDriver::Live;
    if (fire.tracked()) {
        def.driver = volume::FlameDriver::Track;
        def.weight = fire.trackWeight;
        if (f.trackVersion != fire.trackVersion) flame.trackTime = double(fire.track.times[0]);
    } else if (fire.pointCount > 0) {
        def.driver = volume::FlameDriver::Host;
        def.position = fire.points[0].position;
        def.diameter = std::max(2 * fire.points[0].radius, 0.002f);
    }
    f.trackVersion = fire.trackVersion;
}

FireState FireFlames::predictAhead(VolumetricFire& fire, const FireAir& air) const noexcept {
    FireState s;
    FireFlame f;
    f.fire = &fire;
    FW_ASSERT(fire.partCount <= fire.parts.size(), "%u parts", fire.partCount);
    for (; f.part < fire.partCount && fire.power > 0; ++f.part) {
        place(f, air);
        volume::FlameDef& def = f.flame.def;
        std::array<volume::ControlPoint, volume::kMaxControlPoints> points = fire.points;
        uint32_t count = fire.pointCount;
        if (fire.tracked()) {
            count = volume::sampleTrack(fire.track, double(fire.track.times[0]), points);
            for (uint32_t k = 0; k < count; ++k) points[k].position += def.position;
        }
        volume::Curve line;
        if (count > 0) {
            line.set(std::span(points).first(count), def.up);
            def.height = std::clamp(line.length(), 1e-3f, 200.0f);
        }
        volume::FlameLight light = volume::meanLight(def);
        const float height = count > 0 ? def.height : aloneHeight(def.power, def.diameter);
        if (count > 0) light.position = line.at(0.4f * height).position;
        addFlame(s, def.power, def.diameter, height,
                 count > 0 ? line.at(height).position : def.position + def.up * height, light);
    }
    if (s.flames == 0) return s;
    takeMeans(s);
    s.bounds = {s.light, s.light};
    return s;
}

void FireFlames::settle(VolumetricFire& fire, const FireAir& air) noexcept {
    fire.nextState = {};
    fire.nextState.lit = true;
    FW_ASSERT(fire.partCount <= 32, "%u parts", fire.partCount);
    uint32_t there = 0;  // bit per part
    for (FireFlame& f : next_) {
        if (f.fire != &fire) continue;
        if (f.split != fire.split) {
            f.flame.def.power = 0;
            f.flame.def.position += volume::vecOf(fire.position) - f.stood;
            f.stood = volume::vecOf(fire.position);
            continue;
        }
        there |= 1u << f.part;
        place(f, air);
    }
    if (fire.power <= 0) return;
    for (uint32_t i = 0; i < fire.partCount; ++i) {
        if (((there >> i) & 1u) || next_.size() == next_.capacity() ||
            next_.size() >= gpu::kMaxVolumeFlames)
            continue;
        FireFlame& f = next_.emplace_back();
        f.fire = &fire;
        f.key = ++lastKey_;
        f.part = i;
        f.split = fire.split;
        f.flame.def.seed = fire.seed + 0x632BE5ABu * i;
        place(f, air);
        const volume::FlameDef wanted = f.flame.def;
        volume::FlameDef first = wanted;
        if (fire.state.lit) first.power = 0;  // it grows; a new fire starts at full height
        volume::FlameAir still;
        still.wind = volume::vecOf(fire.wind) * fire.windResponse;
        volume::startFlame(f.flame, first, still);
        f.flame.def = wanted;
        if (fire.tracked()) f.flame.trackTime = double(fire.track.times[0]);
    }
}

void FireFlames::advance(const FireAir& air, float seconds) noexcept {
    FW_ASSERT(seconds >= 0, "%g s", double(seconds));
    const vec3 up = volume::vecOf(air.up);
    others_.clear();
    for (FireFlame& f : next_) {
        volume::Flame& flame = f.flame;
        volume::followTeleport(flame, double(seconds));  // before the search for colliders
        const bool led = flame.def.driver == volume::FlameDriver::Host;
        if (led) {
            flame.given = f.fire->points;
            flame.givenCount = f.fire->pointCount;
        }
        const float alone = aloneHeight(flame.power, flame.def.diameter);
        flame.def.height = 0;
        if (flame.givenCount > 0 && flame.tracked > 0) {  // its height is its line's length
            volume::Curve line;
            line.set(std::span(flame.given).first(flame.givenCount), up);
            flame.def.height =
                std::clamp(glm::mix(alone, line.length(), flame.tracked), 1e-3f, 200.0f);
        }
        FW_ASSERT(others_.size() < others_.capacity(), "%zu flames", others_.size());
        others_.push_back(
            {flame.def.position, flame.power * (1.0f - flame.tracked), flame.def.diameter, alone});
    }
    FW_ASSERT(others_.size() <= met_.capacity(), "%zu of %zu flames", others_.size(),
              met_.capacity());
    met_.resize(others_.size());
    volume::updateNeighbours(others_, up, met_);
    for (size_t i = 0; i < next_.size(); ++i) {
        FireFlame& f = next_[i];
        Near near;
        findNear(f, air.colliders, seconds, near);
        volume::FlameAir around;
        around.wind = volume::vecOf(f.fire->wind) * f.fire->windResponse;
        around.neighbours = met_[i];
        around.neighbours.height *= 1.0f - f.flame.tracked;
        around.colliders = {near.list.data(), near.count};
        if (f.fire->tracked()) around.track = &f.fire->track;
        volume::advanceFlame(f.flame, around, double(seconds));
    }
    std::erase_if(
        next_, [](const FireFlame& f) { return f.flame.power < kOut && f.flame.def.power < kOut; });
    sumStates();
}

void FireFlames::sumStates() noexcept {
    for (const FireFlame& f : next_) {
        FireState& s = f.fire->nextState;
        const volume::Flame& flame = f.flame;
        if (s.flames == 0) s.bounds = flame.bounds;
        s.bounds.low = glm::min(s.bounds.low, flame.bounds.low);
        s.bounds.high = glm::max(s.bounds.high, flame.bounds.high);
        const float height = flame.size.height;
        addFlame(s, flame.power, flame.size.diameter, height, vec3(nodeAt(flame, height).centre),
                 flame.light);
        s.contactPower += flame.motion.contactPower;
        s.contact += flame.motion.contactPower * flame.motion.contact;
    }
    for (const FireFlame& f : next_) {
        FireState& s = f.fire->nextState;
        if (s.mean) continue;
        s.mean = true;
        takeMeans(s);
        if (s.contactPower > 0) s.contact /= s.contactPower;
    }
}

uint32_t FireFlames::write(std::span<gpu::VolumeFlame> out) const noexcept {
    uint32_t count = 0;
    for (const FireFlame& f : next_) {
        if ((f.fire->flags & FW_FIRE_HIDDEN) || count == out.size()) continue;
        out[count].record = f.flame.record;
        out[count].record.key = f.key;
        out[count].record.tier = f.fire->tier;
        std::copy(f.flame.nodes.begin(), f.flame.nodes.end(), std::begin(out[count].nodes));
        ++count;
    }
    return count;
}

FireAnswer queryFires(std::span<const FireFlame> flames,
                      std::span<const core::Owned<volume::Profile>> profiles,
                      std::span<const volume::Collider> walls, vec3 point) noexcept {
    FireAnswer all;
    float most = 0;
    for (const FireFlame& f : flames) {
        FW_ASSERT(f.fire->profile < profiles.size(), "profile %u of %zu", f.fire->profile,
                  profiles.size());
        const volume::FlameAnswer a =
            volume::queryFlame(f.flame, *profiles[f.fire->profile], point, walls);
        all.air.inside |= a.inside;
        all.air.kelvin = std::max(all.air.kelvin, a.kelvin);
        all.air.heatFlux = std::min(all.air.heatFlux + a.heatFlux, kMaxFlux);
        all.air.gas += a.gas;
        if (a.heatFlux > most) {
            most = a.heatFlux;
            all.fire = f.fire;
        }
    }
    return all;
}

volume::FlamePush pushOfFires(std::span<const FireFlame> flames,
                              std::span<const core::Owned<volume::Profile>> profiles,
                              std::span<const volume::Collider> walls, vec3 centre,
                              float radius) noexcept {
    volume::FlamePush all;
    for (const FireFlame& f : flames) {
        const volume::FlamePush p =
            volume::pushOf(f.flame, *profiles[f.fire->profile], centre, radius, walls);
        all.force += p.force;
        all.ignition += p.ignition;
    }
    return all;
}

}  // namespace fw::components
