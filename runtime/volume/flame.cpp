// A flame's frame: power, drivers, curve, walls, record, bounds, light; and queries.
#include "volume/flame.h"

#include "core/assert.h"
#include "core/hash.h"
#include "shared/volume_march.h"

#include <algorithm>
#include <cmath>

namespace fw::volume {
namespace {

constexpr float kPowerLag = 0.3f;       // s
constexpr float kStefan = 5.67e-8f;     // W/(m^2 K^4)
constexpr float kConvection = 25.0f;    // W/(m^2 K), of flames on small bodies
constexpr float kLumensPerWatt = 0.4f;  // of a flame's radiation, soot of about 1720 K
constexpr float kMinFlux = 1.0f;        // W/m^2; below it walls are not tested
constexpr float kFadePower = 0.02f;     // kW per m of diameter; below it a flame fades

MotionRules rulesOf(const Flame& f, const FlameAir& air) noexcept {
    MotionRules r;
    r.size = f.size;
    r.top = topOf(f.record);
    r.tauStart = f.record.tauStart, r.tauFree = f.record.tauFree;
    r.wind = air.wind;
    r.up = f.def.up;
    r.dispersion = f.def.appearance.dispersion;
    r.puff = f.def.appearance.puff;
    r.burn = f.def.appearance.burn;
    r.pull = air.neighbours.pull * (1.0f + 2.0f * air.neighbours.merged);
    r.seed = f.def.seed;
    return r;
}

float heightOf(const Flame& f, const FlameAir& air) noexcept {
    float height = f.def.height;
    if (!(height > 0.0f))
        height = std::max(flameHeight(f.power, f.def.diameter), 0.5f * f.def.diameter);
    // A dying fire is lower than the law's height for its bed.
    if (f.def.power > 0.0f) height *= std::pow(std::clamp(f.power / f.def.power, 0.0f, 1.0f), 0.2f);
    return std::max({height, air.neighbours.height, 1e-3f});
}

void describe(Flame& f, const FlameAir& air) noexcept {
    f.size.power = f.power;
    f.size.diameter = f.def.diameter;
    f.size.height = heightOf(f, air);
    f.size.pulse = 1.0f;  // the mean; finish() adds the puffing
    f.record = describeFlame(f.def.appearance, f.size, f.scroll, f.def.seed);
    f.record.puff *= f.tracked;  // live curves carry it in their radii
    f.record.profile = f.def.profile;
    FW_ASSERT(f.def.diameter > 0 && f.power >= 0, "%g m, %g kW", double(f.def.diameter),
              double(f.power));
    f.record.air.w = std::clamp(f.power / (kFadePower * f.def.diameter), 0.0f, 1.0f);
}

void updateCurve(Flame& f, const FlameAir& air, const MotionRules& rules) noexcept {
    std::array<ControlPoint, kMaxControlPoints> live, points;
    uint32_t n = motionPoints(f.motion, rules, live);
    if (f.def.driver == FlameDriver::Track && air.track) {
        f.givenCount = sampleTrack(*air.track, f.trackTime, f.given);
        for (uint32_t k = 0; k < f.givenCount; ++k) f.given[k].position += f.def.position;
    }
    FW_ASSERT(f.givenCount <= f.given.size(), "%u points", f.givenCount);
    const std::span<const ControlPoint> other = std::span(f.given).first(f.givenCount);
    n = blendPoints(std::span(live).first(n), other, f.tracked, f.def.up, points);
    Curve curve;
    curve.set(std::span(points).first(n), f.def.up);
    // Up to the highest puff, so that nodes do not slide while the flame puffs.
    placeFlameNodes(curve, rules.top * (1.0f + rules.puff), f.nodes);
    raiseNodes(f.nodes, f.def.up, std::min(f.size.diameter, 0.7f * f.size.height),
               1.0f - f.tracked);
    flattenNodes(air.colliders, f.nodes);
}

// Pink noise: three slow octaves, different for each flame.
float flicker(const Flame& f) noexcept {
    const float t = float(std::fmod(f.age, 512.0)),
                own = 61.0f * float(core::hash32(f.def.seed) & 1023u);
    float sum = 0.0f;
    for (int o = 0; o < 3; ++o)
        sum +=
            gpu::flameNoise(vec3(own, t * (2.0f * float(1 << o)), 9.0f * float(o))) / float(1 << o);
    return sum;
}

const gpu::FlameNode& nodeAt(const Flame& f, float s) noexcept {
    const float step = f.nodes[1].along.w - f.nodes[0].along.w;
    const float k = step > 0.0f ? s / step + 0.5f : 0.0f;
    return f.nodes[size_t(std::clamp(k, 0.0f, float(f.nodes.size() - 1)))];
}

FlameLight lightOf(const Flame& f, vec3 position) noexcept {
    const FlameAppearance& l = f.def.appearance;
    FlameLight light;
    light.position = position;
    light.radius = std::max(0.3f * f.size.height, 0.5f * f.size.diameter);
    light.flux = 1000.0f * f.power * l.radiant * kLumensPerWatt;
    vec3 colour = gpu::flameRadiance(f.record, 0.5f * (l.core + l.tip) + 60.0f);
    if (l.painter == Painter::Burner) colour = vec3(l.tint[0], l.tint[1], l.tint[2]);
    light.colour = colour / std::max(glm::dot(colour, vec3(0.2126f, 0.7152f, 0.0722f)), 1e-6f);
    return light;
}

void shine(Flame& f) noexcept {
    const FlameAppearance& l = f.def.appearance;
    const float pulse = (f.size.pulse - 1.0f) / std::max(l.puff, 1e-3f);  // [-1, 1]
    const float now = 1.0f + l.flicker * (0.6f * pulse + 2.0f * flicker(f));
    f.light = lightOf(f, vec3(nodeAt(f, 0.4f * f.size.height).centre));
    f.light.flux *= std::max(now, 0.0f);
    // Light on the smoke: radiance times m^2, of about the flame's size.
    f.record.glow = vec4(f.light.position, 0.06f * f.size.diameter * f.size.diameter * now);
}

void finish(Flame& f, const FlameAir& air, const MotionRules& rules) noexcept {
    f.size.pulse = glm::mix(motionPulse(f.motion, rules), 1.0f, f.tracked);
    f.record.high.w *= f.size.pulse;
    updateCurve(f, air, rules);
    f.bounds = flameBounds(f.record, f.nodes);
    FW_ASSERT(f.bounds.low.x <= f.bounds.high.x && f.bounds.low.y <= f.bounds.high.y &&
              f.bounds.low.z <= f.bounds.high.z);
    f.record.low = vec4(f.bounds.low, f.record.low.w);
    f.record.high = vec4(f.bounds.high, f.record.high.w);
    shine(f);
}

float clampPower(float power) noexcept {
    return std::isfinite(power) ? std::max(power, 0.0f) : 0.0f;
}

}  // namespace

float topOf(const gpu::FlameRecord& flame) noexcept {
    return flame.high.w * std::max(gpu::kFlameTop, flame.smoke > 0.0f ? flame.smokeTop : 0.0f);
}

Bounds flameBounds(const gpu::FlameRecord& flame, std::span<const gpu::FlameNode> nodes) noexcept {
    Bounds b{vec3(nodes.empty() ? 0.0f : 1e30f), vec3(nodes.empty() ? 0.0f : -1e30f)};
    for (size_t k = 0; k + 1 < nodes.size(); ++k) {
        if (nodes[k].along.w > topOf(flame)) break;
        const gpu::FlameNode &a = nodes[k], &next = nodes[k + 1];
        const vec3 reach(gpu::flameReachAt(flame, a.along.w, next.along.w,
                                           std::max(a.centre.w, next.centre.w),
                                           std::max(a.side.w, next.side.w)));
        for (const vec3 c : {vec3(a.centre), vec3(next.centre)})
            b.low = glm::min(b.low, c - reach), b.high = glm::max(b.high, c + reach);
    }
    return b;
}

FlameLight meanLight(const FlameDef& def) noexcept {
    Flame f;
    f.def = def;
    f.power = clampPower(def.power);
    describe(f, {});
    return lightOf(f, def.position + def.up * (0.4f * f.size.height));
}

void startFlame(Flame& f, const FlameDef& def, const FlameAir& air) noexcept {
    f = {};
    f.def = def;
    f.power = clampPower(def.power);
    f.tracked = def.driver == FlameDriver::Live ? 0.0f : def.weight;
    describe(f, air);
    const MotionRules rules = rulesOf(f, air);
    startMotion(f.motion, rules, def.position);
    finish(f, air, rules);
}

void carryFlame(Flame& f, vec3 by) noexcept {
    carryMotion(f.motion, by);
    f.bounds.low += by, f.bounds.high += by;
    f.light.position += by;
    for (gpu::FlameNode& node : f.nodes) node.centre += vec4(by, 0.0f);
    // A track's points follow the base already; a host's points stay the host's.
    if (f.def.driver == FlameDriver::Live)
        for (uint32_t k = 0; k < f.givenCount; ++k) f.given[k].position += by;
}

void followTeleport(Flame& f, double seconds) noexcept {
    const vec3 by = f.def.position - f.motion.base;
    if (glm::length(by) > kTeleport * float(std::max(seconds, 0.0))) carryFlame(f, by);
}

void advanceFlame(Flame& f, const FlameAir& air, double seconds) noexcept {
    const double dt = std::isfinite(seconds) ? std::clamp(seconds, 0.0, 1.0) : 0.0;
    followTeleport(f, dt);
    f.age += dt;
    f.power += (clampPower(f.def.power) - f.power) * float(1.0 - std::exp(-dt / double(kPowerLag)));
    const bool has =
        (f.def.driver == FlameDriver::Track && air.track && !air.track->times.empty()) ||
        (f.def.driver == FlameDriver::Host && f.givenCount > 0);
    const float step = f.def.blend > 0.0f ? float(dt) / f.def.blend : 1.0f;
    const float aim = has ? f.def.weight : 0.0f;
    f.tracked += std::clamp(aim - f.tracked, -step, step);
    f.trackTime += dt;
    FW_ASSERT(f.tracked >= 0 && f.tracked <= 1, "weight %g", double(f.tracked));
    describe(f, air);
    advanceScroll(f.scroll, f.def.appearance, f.record, dt);
    f.scroll.puff = f.motion.phase;
    describe(f, air);
    const MotionRules rules = rulesOf(f, air);
    advanceMotion(f.motion, rules, f.def.position, air.colliders, dt);
    finish(f, air, rules);
}

FlameAnswer queryFlame(const Flame& f, const Profile& profile, vec3 point,
                       std::span<const Collider> walls) noexcept {
    FlameAnswer a;
    const float height = f.size.height, diameter = f.size.diameter;
    if (f.power <= 0.0f) return a;
    FW_ASSERT(height > 0 && diameter > 0, "%g m high, %g m wide", double(height), double(diameter));
    const auto at = locate(f.nodes, point);
    if (at && at->rho < 3.0f) {
        a.s = at->place.s, a.rho = at->rho;
        const float y = at->place.s / height;  // of the visible height
        const vec2 burns = profile.sample(at->rho, y);
        a.inside = y <= 1.0f && burns.y > 0.05f;
        // Plume around and above: the law's centreline, Gaussian across.
        const float wide = 0.5f * diameter + 0.12f * at->place.s;
        const float off = at->rho * at->place.radius / wide;
        const float share = std::exp(-off * off);
        const float plume = plumeExcess(f.power, std::max(at->place.s, 0.05f * height)) * share;
        // On the mean, gas in the flame is cooler than luminous soot.
        a.kelvin =
            kAmbientKelvin +
            (a.inside ? std::max(0.62f * (1000.0f * burns.x - kAmbientKelvin), plume) : plume);
        a.gas = vec3(nodeAt(f, at->place.s).along) *
                (plumeSpeed(f.power, std::max(at->place.s, 0.02f)) * share);
    } else {
        a.rho = -1.0f;
    }
    // Radiation: four points along the axis, never nearer than half the flame's width.
    const float radiated = 1000.0f * f.power * f.def.appearance.radiant;
    float flux = 0.0f;
    for (int k = 0; k < 4 && !a.inside; ++k) {
        const vec3 from(nodeAt(f, height * (0.1f + 0.2f * float(k))).centre), to = point - from;
        const float near = 0.5f * diameter;
        const float part = 0.25f * radiated / (12.566f * std::max(glm::dot(to, to), near * near));
        const bool hidden =
            part > kMinFlux && std::any_of(walls.begin(), walls.end(), [&](const Collider& wall) {
                return shades(wall, from, point);
            });
        flux += hidden ? 0.0f : part;
    }
    const float emissivity = 1.0f - std::exp(-1.0f * diameter);
    const float hot = a.kelvin * a.kelvin;
    const float within = kConvection * (a.kelvin - kAmbientKelvin) +
                         (a.inside ? emissivity * kStefan * hot * hot : 0.0f);
    a.heatFlux = within + flux;
    return a;
}

FlamePush pushOf(const Flame& f, const Profile& profile, vec3 centre, float radius,
                 std::span<const Collider> walls) noexcept {
    const FlameAnswer a = queryFlame(f, profile, centre, walls);
    const float r = std::max(radius, 0.0f), area = 3.1415927f * r * r;
    const float density = 353.0f / a.kelvin;  // kg/m^3
    FlamePush push;
    push.force = a.gas * (0.5f * density * 0.47f * area * glm::length(a.gas));
    push.ignition = a.heatFlux * (a.inside ? 4.0f * area : area);
    return push;
}

}  // namespace fw::volume
