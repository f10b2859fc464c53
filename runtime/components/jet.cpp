#include "components/jet.h"

#include "components/fire_emitter.h"
#include "core/assert.h"
#include "shared/exchange.h"

#include <algorithm>
#include <cmath>

namespace fw::components {
namespace {

uint64_t whole(float value, float unit) noexcept {
    return uint64_t(std::lround(std::clamp(double(value) * double(unit), 0.0, 1e9)));
}

}  // namespace

JetFlight jetFlight(const EmitterAppearance& appearance) noexcept {
    constexpr uint64_t kSubsteps = gpu::kExchangeSteps;
    const uint64_t life = std::max<uint64_t>(whole(appearance.life, gpu::kTicksPerSecond), 1);
    const uint64_t stream = whole(appearance.dragStream, gpu::kTicksPerSecond);
    const uint64_t torn = std::min(whole(appearance.dragTorn, gpu::kTicksPerSecond), stream);
    uint64_t speed = whole(appearance.speed, 1000) << 8, way = 0;  // mm/s, mm: Q8
    JetFlight flight{};
    for (uint64_t i = 0; i < kJetParcels * kSubsteps; ++i) {
        // As shared/particle.h: smoothstep(0.15, 0.6, age in lives) of it is torn.
        const uint64_t age = std::min<uint64_t>((2 * i + 1) * gpu::kStepTicks * 128 / life, 256);
        const uint64_t x = age > 38 ? std::min<uint64_t>((age - 38) * 256 / 116, 256) : 0;
        const uint64_t part = (x * x * (768 - 2 * x)) >> 16;
        const uint64_t drag = std::max<uint64_t>(stream - ((stream - torn) * part >> 8), 1);
        speed = speed * drag / (drag + gpu::kStepTicks);
        way += speed * gpu::kStepTicks / gpu::kTicksPerSecond;
        FW_ASSERT(way >> 8 <= 0xFFFFFFFFu, "%llu mm", static_cast<unsigned long long>(way >> 8));
        if ((i + 1) % kSubsteps == 0) flight[(i + 1) / kSubsteps] = uint32_t(way >> 8);
    }
    return flight;
}

uint32_t jetArrival(const JetFlight& flight, uint32_t exchange, uint32_t millimetres) noexcept {
    FW_ASSERT(exchange < kJetParcels, "exchange %u", exchange);
    const uint32_t first = flight[exchange], length = flight[exchange + 1] - first;
    const uint32_t part = std::min(millimetres - std::min(millimetres, first), length);
    const uint64_t within =
        length > 0 ? uint64_t(part) * (gpu::kExchangeTicks - 1) / length : uint64_t(0);
    return exchange * gpu::kExchangeTicks + uint32_t(within);
}

uint64_t burnPatch(JetPatch& patch, uint32_t now) noexcept {
    patch.power = 0;
    if (patch.left == 0) return 0;
    if (patch.water > 0 && now >= patch.waterAt) {
        patch.fuel -= std::min(patch.fuel, patch.water);
        patch.water = 0;
    }
    FW_ASSERT(patch.fuel <= kMaxPatch, "%llu of fuel", static_cast<unsigned long long>(patch.fuel));
    patch.power = patch.fuel / patch.left;
    patch.fuel -= patch.power;
    --patch.left;
    if (patch.fuel == 0) patch.left = 0;
    if (patch.left == 0) patch.water = 0;
    return patch.power;
}

uint64_t feedPatch(JetPatch& patch, uint64_t fuel, uint32_t exchanges) noexcept {
    FW_ASSERT(exchanges > 0, "%u exchanges", exchanges);
    const uint64_t takes = std::min(fuel, kMaxPatch - std::min(patch.fuel, kMaxPatch));
    if (takes == 0) return fuel;
    patch.fuel += takes;
    patch.left = exchanges;
    return fuel - takes;
}

void wetPatch(JetPatch& patch, uint32_t grams, uint32_t tick) noexcept {
    // A patch has 0.2 m^2; in integers: grams * J * units / 5.
    constexpr uint64_t kOfGram = kPatchJoulesPerGram * kPatchUnitsPerJoule / 5;
    const uint64_t most = kMaxPatch / kOfGram;
    const uint64_t takes = grams < most ? grams * kOfGram : kMaxPatch;
    patch.waterAt = patch.water > 0 ? std::min(patch.waterAt, tick) : tick;
    patch.water = std::min(patch.water + takes, kMaxPatch);
}

uint64_t updateJetShare(uint64_t power, std::span<const uint64_t> areas,
                        std::span<uint32_t> flux) noexcept {
    FW_ASSERT(areas.size() <= flux.size(), "%zu areas, %zu fluxes", areas.size(), flux.size());
    uint64_t all = 0;
    for (const uint64_t area : areas) all += area;
    if (all == 0) return power;
    const auto even = uint32_t(std::min<uint64_t>(power / all, gpu::kMaxFlux));
    uint64_t left = power - even * all;
    for (size_t i = 0; i < areas.size(); ++i) {
        const bool more = even < gpu::kMaxFlux && areas[i] <= left;
        flux[i] = even + (more ? 1u : 0u);
        left -= more ? areas[i] : 0;
    }
    return left;
}

}  // namespace fw::components
