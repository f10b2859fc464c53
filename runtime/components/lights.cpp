#include "components/lights.h"

#include "core/assert.h"
#include "host_limits.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fw::components {
namespace {

constexpr float kKeptGain = 1.6f;   // above the largest ratio of two flickers (1.22 / 0.78)
constexpr float kFollow = 0.1f;     // s
constexpr float kFaintest = 0.01f;  // of all light; a fading light below it ends
constexpr float kReach = 8;         // radii (and 2 m) within which a fire moves its light

float squareDistance(const FwLight& a, const FwLight& b) noexcept {
    float sum = 0;
    for (int i = 0; i < 3; ++i) {
        const float d = a.position[i] - b.position[i];
        sum += d * d;
    }
    return sum;
}

// Adds `other` to `light`.
void join(FwLight& light, const FwLight& other) noexcept {
    const float both = light.intensity + other.intensity;
    const float share = both > 0 ? other.intensity / both : 0.0f;
    const float distance = std::sqrt(squareDistance(light, other));
    FW_ASSERT(share >= 0 && share <= 1, "share %g", double(share));
    for (int i = 0; i < 3; ++i) light.color[i] += share * (other.color[i] - light.color[i]);
    if (distance < kReach * light.radius + 2) {
        for (int i = 0; i < 3; ++i)
            light.position[i] += share * (other.position[i] - light.position[i]);
        const float spread = distance * std::sqrt(share * (1 - share));
        const float mean =
            (1 - share) * light.radius * light.radius + share * other.radius * other.radius;
        light.radius = std::sqrt(mean + spread * spread);
    }
    light.intensity = both;
    light.power += other.power;
}

const FwLight* findLight(std::span<const FwLight> lights, uint32_t id) noexcept {
    const auto at = std::ranges::find(lights, id, &FwLight::id);
    return at == lights.end() ? nullptr : &*at;
}

}  // namespace

float flicker(double now, double phase) noexcept {
    return static_cast<float>(1.0 + 0.10 * std::sin(11.3 * now + phase) +
                              0.07 * std::sin(17.9 * now + 2.3 * phase) +
                              0.05 * std::sin(29.1 * now + 4.1 * phase));
}

double flickerPhase(uint32_t id) noexcept {
    const uint32_t mixed = (id ^ id >> 15) * 0x2C1B3C6Du;
    return double(mixed >> 8) * (6.2831853 / 16777216.0);
}

uint32_t gatherLights(std::span<const FwLight> sources, std::span<const uint32_t> kept,
                      uint32_t most, std::span<FwLight> out, std::pmr::vector<uint8_t>& taken) {
    most = std::min({most, limits::kLights, uint32_t(out.size())});
    taken.assign(sources.size(), 0);
    uint32_t count = 0;
    std::array<const FwLight*, limits::kLights> chosen;
    // One by one: a source beside a chosen one scores less, or one corner would take all lights.
    while (count < most && count < sources.size()) {
        size_t best = sources.size();
        float bestScore = -1;
        for (size_t i = 0; i < sources.size(); ++i) {
            if (taken[i]) continue;
            float score = sources[i].intensity;
            if (sources.size() > most) {
                if (std::find(kept.begin(), kept.end(), sources[i].id) != kept.end())
                    score *= kKeptGain;
                for (uint32_t k = 0; k < count; ++k) {
                    const float side = 4 * chosen[k]->radius + 1;
                    const float d2 = squareDistance(*chosen[k], sources[i]) / (side * side);
                    score *= std::clamp(std::sqrt(d2), 0.05f, 1.0f);
                }
            }
            if (score <= bestScore) continue;
            bestScore = score;
            best = i;
        }
        FW_ASSERT(best < sources.size(), "no source scores above -1");
        taken[best] = 1;
        chosen[count] = &sources[best];
        out[count++] = sources[best];
    }
    if (count == 0) return 0;
    for (size_t i = 0; i < sources.size(); ++i) {
        if (taken[i]) continue;
        uint32_t nearest = 0;
        for (uint32_t k = 1; k < count; ++k)
            if (squareDistance(*chosen[k], sources[i]) <
                squareDistance(*chosen[nearest], sources[i]))
                nearest = k;
        join(out[nearest], sources[i]);
    }
    std::sort(out.begin(), out.begin() + count, [](const FwLight& a, const FwLight& b) {
        return a.intensity != b.intensity ? a.intensity > b.intensity : a.id < b.id;
    });
    return count;
}

void followLights(std::pmr::vector<FwLight>& shown, std::span<const FwLight> known, float seconds,
                  uint32_t most) {
    FW_ASSERT(seconds >= 0, "%g s", double(seconds));
    const float share = 1 - std::exp(-seconds / kFollow);
    float all = 0;
    for (const FwLight& light : known) all += light.intensity;
    for (FwLight& light : shown) {
        const FwLight* to = findLight(known, light.id);
        if (!to) {
            light.intensity *= 1 - share;
            light.power *= 1 - share;
            continue;
        }
        light.frameIndex = to->frameIndex;
        light.intensity += share * (to->intensity - light.intensity);
        light.power += share * (to->power - light.power);
        light.radius += share * (to->radius - light.radius);
        for (int i = 0; i < 3; ++i) {
            light.color[i] += share * (to->color[i] - light.color[i]);
            light.position[i] += share * (to->position[i] - light.position[i]);
        }
    }
    const size_t before = shown.size();
    for (const FwLight& light : known) {
        if (findLight({shown.data(), before}, light.id)) continue;
        FwLight& fresh = shown.emplace_back(light);
        fresh.intensity *= share;
        fresh.power *= share;
    }
    // Fading lights end: the faint ones, then those beyond the limit.
    for (size_t i = shown.size(); i-- > 0;) {
        const bool faint = shown[i].intensity <= kFaintest * all || known.empty();
        if (findLight(known, shown[i].id) || (!faint && shown.size() <= most)) continue;
        const FwLight gone = shown[i];
        shown.erase(shown.begin() + std::ptrdiff_t(i));
        if (shown.empty()) continue;
        FwLight& nearest = *std::ranges::min_element(
            shown, {}, [&](const FwLight& light) { return squareDistance(light, gone); });
        nearest.intensity += gone.intensity;
        nearest.power += gone.power;
    }
}

}  // namespace fw::components
