// Surroundings of a point: how hot, how smoky, how far from fire. Volumetric fires answer for
// themselves; burning meshes and streams count as fires at the places of their lights.
#include "components/surroundings.h"
#include "components/pose.h"
#include "fire/heat.h"
#include "world/emitter_system.h"
#include "world/exchange_system.h"
#include "world/flame_system.h"
#include "world/light_system.h"
#include "world/query_system.h"
#include "world/wind_system.h"

#include <algorithm>
#include <cmath>

namespace fw::world {
namespace {

constexpr uint32_t kMaxMaskSide = 4096;

}  // namespace

components::SurroundingAir QuerySystem::listSources() {
    components::SurroundingAir air;
    air.up = volume::vecOf(context_.def.up);
    air.wind = volume::vecOf(wind_.state().wind);
    flames_.reserve(0);
    flames_.listShapes();  // as they stand now
    air.walls = flames_.walls();
    air.occlusion = exchange_.occlusionView();
    sources_.clear();
    // A light stands a quarter of its flame above what burns (lights.comp).
    const auto add = [&](const FwLight& light) {
        components::FireSource source = components::fireSource(
            volume::vecOf(light.position), light.radius, 0.001f * light.power, light.id);
        source.base = source.base - air.up * (0.25f * source.height);
        sources_.push_back(source);
    };
    for (const FwLight& light : lights_.shown()) add(light);
    for (auto [i, entry] : flames_.fires().entries()) {
        if (entry.data.state.flames == 0) continue;
        const components::VolumetricFire& fire = entry.data;
        components::FireSource source = components::fireSource(
            volume::vecOf(fire.position), 0.5f * fire.diameter, fire.state.power, 0x80000000u | i);
        source.exact = true;
        sources_.push_back(source);
    }
    for (auto [i, emitter] : emitters_.emitters().entries()) {
        if (emitter.births.filled == 0 || emitter.def.shape == FW_EMITTER_MESH) continue;
        add(components::emitterLight(emitter, emitters_.airOf(emitter, 0), 0x40000000u | i,
                                     context_.lastFrame));
    }
    return air;
}

components::Surroundings QuerySystem::surroundingsAt(const components::SurroundingAir& air,
                                                     components::vec3 point) const noexcept {
    components::SurroundingAir here = air;
    const float place[3] = {point.x, point.y, point.z};
    here.wind = volume::vecOf(wind_.at(place, context_.clock.tick).data());
    components::Surroundings at = components::surroundingsOf(sources_, here, point);
    if (flames_.burning().now().empty()) return at;
    const components::FireAnswer fires =
        components::queryFires(flames_.burning().now(), flames_.profiles(), air.walls, point);
    at.excess = std::max(at.excess, fires.air.kelvin - fire::kAmbient);
    at.heatFlux = std::min(at.heatFlux + fires.air.heatFlux, components::kMaxHeatFlux);
    return at;
}

void QuerySystem::querySurroundings(const float point[3], FwSurroundings& out) {
    components::checkLengths(point, 3, "point", -1e6f, 1e6f);
    const components::Surroundings at = surroundingsAt(listSources(), volume::vecOf(point));
    out.heatFlux = at.heatFlux;
    out.temperature = fire::kAmbient + at.excess;
    out.smoke = at.smoke;
    out.danger = components::spreadRiskOf(at);
    out.nearest = at.nearest;
    if (!at.source) return;
    for (int i = 0; i < 3; ++i) out.nearestPosition[i] = at.source->base[i];
    out.nearestPower = 1000 * at.source->power;
    out.nearestLight = at.source->id;
}

float QuerySystem::querySight(const float from[3], const float to[3]) {
    components::checkLengths(from, 3, "from", -1e6f, 1e6f);
    components::checkLengths(to, 3, "to", -1e6f, 1e6f);
    const components::SurroundingAir air = listSources();
    return components::sightThrough(sources_, air, volume::vecOf(from), volume::vecOf(to));
}

void QuerySystem::makeSafetyMask(const float corner[3], const float columnStep[3],
                                 const float rowStep[3], uint32_t columns, uint32_t rows,
                                 uint8_t* mask) {
    components::checkLengths(corner, 3, "corner", -1e6f, 1e6f);
    components::checkLengths(columnStep, 3, "columnStep", -1e4f, 1e4f);
    components::checkLengths(rowStep, 3, "rowStep", -1e4f, 1e4f);
    if (columns < 1 || columns > kMaxMaskSide || rows < 1 || rows > kMaxMaskSide)
        core::refuse("The mask has %u columns and %u rows; the limits are [1, %u] each.", columns,
                     rows, kMaxMaskSide);
    const components::SurroundingAir air = listSources();
    for (uint32_t row = 0; row < rows; ++row)
        for (uint32_t column = 0; column < columns; ++column) {
            const components::vec3 point = volume::vecOf(corner) +
                                           volume::vecOf(columnStep) * float(column) +
                                           volume::vecOf(rowStep) * float(row);
            const float danger = components::spreadRiskOf(surroundingsAt(air, point));
            mask[size_t{row} * columns + column] =
                static_cast<uint8_t>(std::min(127.0f * danger, 255.0f));
        }
}

}  // namespace fw::world
