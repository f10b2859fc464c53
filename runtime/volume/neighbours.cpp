// Leaning together and merging.
#include "volume/neighbours.h"

#include "core/assert.h"
#include "volume/appearance.h"

#include <algorithm>
#include <cmath>

namespace fw::volume {

float inflow(float power, float diameter, float distance) noexcept {
    const float plume = 1.93f * std::pow(std::max(power, 0.0f), 0.2f), half = 0.5f * diameter;
    return std::min(0.12f * plume * half / std::max({distance, half, 1e-3f}), 0.3f * plume);
}

void updateNeighbours(std::span<const NeighbourFlame> flames, vec3 up,
                      std::span<Neighbourhood> out) noexcept {
    FW_ASSERT(flames.size() == out.size(), "%zu flames, %zu answers", flames.size(), out.size());
    const size_t n = flames.size();
    // 1 for flames much taller than their gap, 0 for flames that do not span it.
    const auto overlap = [](const NeighbourFlame& a, const NeighbourFlame& b, float distance) {
        const float gap = std::max(distance - 0.5f * (a.diameter + b.diameter), 0.0f);
        const float tall = std::min(a.height, b.height);
        return tall > 0.0f ? glm::smoothstep(0.0f, 1.0f, 1.5f * (tall - gap) / tall) : 0.0f;
    };
    for (size_t k = 0; k < n; ++k) out[k] = {vec3(0.0f), flames[k].height, 0.0f};
    for (size_t a = 0; a < n; ++a) {
        const NeighbourFlame& fa = flames[a];
        // Heat and burning area of the flame and the flames that it merges with.
        float power = fa.power, area = fa.diameter * fa.diameter, most = 0.0f;
        for (size_t b = 0; b < n; ++b) {
            if (b == a) continue;
            const NeighbourFlame& fb = flames[b];
            vec3 to = fb.base - fa.base;
            to -= up * glm::dot(to, up);
            const float distance = glm::length(to);
            const float reach = 2.0f * std::max(fb.height, fb.diameter);
            if (!(distance < reach) || !(fb.power > 0.0f)) continue;
            const float fade = 1.0f - glm::smoothstep(0.7f * reach, reach, distance);
            if (distance > 1e-4f)
                out[a].pull += to / distance * (fade * inflow(fb.power, fb.diameter, distance));
            const float o = overlap(fa, fb, distance);
            power += o * fb.power, area += o * fb.diameter * fb.diameter;
            most = std::max(most, o);
        }
        out[a].merged = most;
        const float together = flameHeight(power, std::sqrt(area));
        out[a].height = std::max(glm::mix(fa.height, together, most), fa.height);
        const float limit = 0.3f * 1.93f * std::pow(std::max(fa.power, 1e-6f), 0.2f);
        const float l = glm::length(out[a].pull);
        if (l > limit) out[a].pull *= limit / l;
    }
}

}  // namespace fw::volume
