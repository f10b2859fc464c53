#include "components/surroundings.h"

#include "components/lights.h"
#include "volume/appearance.h"

#include "core/assert.h"

#include <algorithm>
#include <cmath>

namespace fw::components {
namespace {

constexpr float kRadiant = 0.3f;      // of a fire's power
constexpr float kConvection = 25.0f;  // W/(m^2 K), of hot gas on a body
constexpr float kMinFlux = 20.0f;     // W/m^2; below it walls are not tested
// Soot of a kJ of wood, g: 0.015 of its fuel at 15 kJ/g. Its cross-section, m^2/g.
constexpr float kSootPerKilojoule = 0.015f / 15.0f, kSmokeArea = 8.7f;
constexpr float kMinSmoke = 1e-5f;  // 1/m
constexpr float kPainFlux = 2500.0f, kPainExcess = 40.0f, kBlindSmoke = 1.0f;
constexpr int kSightParts = 48;

struct InPlume {
    float z = 0;      // m above the base, along the plume
    float share = 0;  // of the axis' excess
};

// A plume leans by wind over rise; it widens by 0.12 of its height.
InPlume inPlume(const FireSource& fire, const SurroundingAir& air, vec3 point) noexcept {
    const vec3 offset = point - fire.base;
    const float z = glm::dot(offset, air.up);
    if (z <= -0.1f * fire.radius || fire.power <= 0) return {};
    const float high = std::max(z, 0.05f * std::max(fire.height, 0.05f));
    const float rise = std::max(volume::plumeSpeed(fire.power, high), 0.3f);
    const vec3 off = offset - air.up * z - air.wind * (std::max(z, 0.0f) / rise);
    const float wide = fire.radius + 0.12f * std::max(z, 0.0f);
    FW_ASSERT(wide > 0, "%g m", double(wide));
    return {high, std::exp(-glm::dot(off, off) / (wide * wide))};
}

float smokeOf(const FireSource& fire, const SurroundingAir& air, vec3 point) noexcept {
    const InPlume at = inPlume(fire, air, point);
    if (at.share < 1e-4f || at.z < 0.5f * fire.height) return 0;  // soot burns inside the flame
    // Soot per second over the flow of gas; the mean of a Gaussian is half its peak.
    const float wide = fire.radius + 0.12f * at.z;
    const float flow =
        0.5f * 3.14159265f * wide * wide * std::max(volume::plumeSpeed(fire.power, at.z), 0.3f);
    return kSmokeArea * kSootPerKilojoule * fire.power / flow * at.share;
}

}  // namespace

FireSource fireSource(vec3 base, float radius, float power, uint32_t id) noexcept {
    FireSource source;
    source.base = base;
    source.radius = std::max(radius, 0.02f);
    source.power = power;
    // A wide, weak fire burns as many small ones.
    const float tall = 0.235f * std::pow(std::max(power, 1e-3f), 0.4f);
    source.height = std::max(volume::flameHeight(power, 2 * source.radius), 0.45f * tall);
    source.id = id;
    return source;
}

float smokeAt(std::span<const FireSource> sources, const SurroundingAir& air, vec3 point) noexcept {
    float smoke = 0;
    for (const FireSource& fire : sources) smoke += smokeOf(fire, air, point);
    return smoke < kMinSmoke ? 0 : smoke;
}

Surroundings surroundingsOf(std::span<const FireSource> sources, const SurroundingAir& air,
                            vec3 point) noexcept {
    Surroundings all;
    for (const FireSource& fire : sources) {
        if (!(fire.power > 0)) continue;
        // The flame is a line from its base to its tip, as wide as its fire.
        const vec3 offset = point - fire.base;
        const float along = std::clamp(glm::dot(offset, air.up), 0.0f, fire.height);
        const vec3 off = offset - air.up * along;
        const float edge = std::max(std::sqrt(glm::dot(off, off)) - fire.radius, 0.0f);
        if (edge < all.nearest) {
            all.nearest = edge;
            all.source = &fire;
        }
        all.smoke += smokeOf(fire, air, point);
        if (fire.exact) continue;
        const InPlume plume = inPlume(fire, air, point);
        const float excess =
            plume.share > 1e-4f ? volume::plumeExcess(fire.power, plume.z) * plume.share : 0.0f;
        all.excess = std::max(all.excess, excess);
        const vec3 middle = fire.base + air.up * (0.4f * fire.height), to = point - middle;
        const float near = std::max(fire.radius, 0.3f * fire.height);
        const float flux =
            kRadiant * 1000.0f * fire.power / (kSphere * std::max(glm::dot(to, to), near * near));
        const bool hidden = flux > kMinFlux &&
                            (std::any_of(air.walls.begin(), air.walls.end(),
                                         [&](const volume::Collider& wall) {
                                             return volume::shades(wall, middle, point);
                                         }) ||
                             isShadedByOcclusion(air.occlusion, &middle.x, &point.x, fire.radius));
        if (!hidden) all.heatFlux += flux;
        all.heatFlux += kConvection * excess;
    }
    all.heatFlux = std::min(all.heatFlux, kMaxHeatFlux);
    if (all.smoke < kMinSmoke) all.smoke = 0;
    return all;
}

float sightThrough(std::span<const FireSource> sources, const SurroundingAir& air, vec3 from,
                   vec3 to) noexcept {
    const vec3 path = to - from;
    const float part = glm::length(path) / float(kSightParts);
    float depth = 0;
    for (int i = 0; i < kSightParts; ++i)
        depth += part * smokeAt(sources, air, from + path * ((float(i) + 0.5f) / kSightParts));
    return std::exp(-depth);
}

float spreadRiskOf(const Surroundings& at) noexcept {
    return std::max({at.heatFlux / kPainFlux, at.excess / kPainExcess, at.smoke / kBlindSmoke});
}

}  // namespace fw::components
