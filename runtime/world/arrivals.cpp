// Arrival times: a copy of an object's front runs ahead, a slice each frame, from the state of a
// readback and under the present wind and pose. See mesh/front/arrivals.h.
#include "core/reserved.h"
#include "world/burn_system.h"
#include "world/exchange_system.h"
#include "world/query_system.h"
#include "world/wind_system.h"

#include <algorithm>
#include <cfloat>

namespace fw::world {
namespace {

// Fire slows down in bad air. Converts a tick after `from`, found for good air, to this air if it
// stays; kNever: fire does not burn in it.
uint64_t inAir(uint64_t tick, uint64_t from, uint32_t air) noexcept {
    const uint32_t strength = gpu::airStrength(air);
    if (tick <= from || strength >= gpu::kAirFull) return tick;
    return strength == 0 ? gpu::kNever : from + (tick - from) * gpu::kAirFull / strength;
}

bool answers(const Forecast& forecast, const Query& query) noexcept {
    return forecast.began && forecast.changes >= query.since && forecast.tick >= query.sinceTick;
}

}  // namespace

FwQueryId QuerySystem::requestArrival(FwBurnableMeshId id, const float position[3]) {
    Query query = makeQuery(id, position);
    Object& object = *scene_.objects.get(id);
    if (object.data.flags & core::reserved::kBurning)
        core::refuse("Burnable mesh %u burns by an extension and has no arrivals.", id.index1);
    if (!object.forecast) {
        auto forecast = core::Owned<Forecast>::make(context_.memory, context_.memory);
        mesh::reserveArrivals(forecast->arrivals, scene_.domainOf(object));
        forecasts_.push_back(object.slot);
        object.forecast = std::move(forecast);
    }
    query.isArrival = true;
    const bool waits = std::any_of(
        burn_.state().pending.begin(), burn_.state().pending.end(), [&](const PendingTexel& event) {
            return event.object == object.slot && event.tick <= context_.clock.hostTick();
        });
    query.since = changesOf(object) + (waits ? 1 : 0);
    // A forecast does not see water dry, for one: it is repeated every second.
    if (burn_.isActive(object) && context_.clock.tick > gpu::kTicksPerSecond)
        query.sinceTick = context_.clock.tick - gpu::kTicksPerSecond;
    return queries_.create(query);
}

// Requests the state of objects with questions that no forecast answers.
void QuerySystem::requestForecasts() noexcept {
    for (auto [i, query] : queries_.entries()) {
        if (!query.isArrival) continue;
        const Object& object = *scene_.objects.get(query.object);
        if (object.play.burn1 != 0) continue;  // its burn tells
        Forecast& forecast = *object.forecast;
        const bool comes = forecast.pending && forecast.pendingChanges >= query.since;
        if (forecast.requested || comes || answers(forecast, query)) continue;
        forecast.requested = true;
        ++mapsRequested_;
    }
}

void QuerySystem::beginForecast(Object& object, const gpu::ObjectImage& map,
                                const gpu::Readback& readback) noexcept {
    Forecast& forecast = *object.forecast;
    FW_ASSERT(map.ticks.size() == scene_.domainOf(object).texelCount(), "%zu texels",
              map.ticks.size());
    forecast.pending = false;
    const components::DriveInput drive = wind_.driveInput(object, context_.clock.tick);
    components::Latch latch = object.latch;
    components::resetLatch(object.data, drive, latch);
    const components::Records records =
        components::makeRecords(object.data, scene_.domainOf(object), drive, latch);
    mesh::ArrivalInput input;
    input.domain = &scene_.domainOf(object);
    input.slowness = object.slowness;
    input.materials = records.materials;
    input.window = records.timing.window;
    input.state = map.ticks;
    input.now = readback.endTick;
    input.parts = (exchange_.transfer().flags & FW_WORLD_CONTACT) != 0;
    mesh::beginArrivals(forecast.arrivals, input);  // capacity was reserved
    forecast.began = true;
    forecast.changes = forecast.pendingChanges;
    forecast.tick = readback.endTick;
    forecast.frameIndex = readback.frameIndex;
}

// Slices of all forecasts that are not through, in turn.
void QuerySystem::runForecasts() noexcept {
    uint32_t tiles = context_.def.arrivalTiles;
    for (size_t i = 0, count = forecasts_.size(); i < count && tiles > 0; ++i) {
        const size_t at = (nextForecast_ + i) % count;
        FW_ASSERT(scene_.objectAt(forecasts_[at]).forecast, "slot %u", forecasts_[at]);
        tiles = mesh::runArrivals(scene_.objectAt(forecasts_[at]).forecast->arrivals, tiles);
        if (tiles == 0) nextForecast_ = (at + 1) % count;
    }
}

bool QuerySystem::fetchArrival(FwQueryId id, FwArrivalState& state) {
    const Query& query = openQuery(id, true);
    const Object& object = *scene_.objects.get(query.object);
    const Forecast& forecast = *object.forecast;
    uint64_t tick = gpu::kNever;
    bool comes = false;
    if (object.play.burn1 != 0) {
        const uint32_t recorded =
            (*burn_.state().burns.at(object.play.burn1 - 1))->ticks[query.texel];
        comes = recorded != gpu::kNever;
        if (comes) tick = object.play.tickOf(recorded);
        state.frameIndex = context_.lastFrame;
    } else {
        if (!answers(forecast, query)) return false;
        tick = forecast.arrivals.ticks[query.texel];
        const uint32_t stop = object.counters.stopTick;
        comes = gpu::isSource(uint32_t(tick)) && !(tick > forecast.tick && stop && tick >= stop);
        if (comes ? tick >= forecast.arrivals.settled() : !forecast.arrivals.whole) return false;
        if (comes) {
            tick = inAir(tick, forecast.tick, object.counters.air);
            comes = tick != gpu::kNever;
        }
        state.frameIndex = forecast.frameIndex;
    }
    const uint64_t now = context_.clock.hostTick();
    const double away = (double(tick) - double(now)) / gpu::kTicksPerSecond;
    state.kind = FW_ARRIVAL_NEVER;
    state.seconds = FLT_MAX;
    if (comes) {
        state.kind = tick <= now ? FW_ARRIVAL_PAST : FW_ARRIVAL_AHEAD;
        state.seconds = float(away);
    }
    state.distance = query.distance;
    scene_.texelPosition(object, query.texel, state.position);
    queries_.destroy(id);
    return true;
}

}  // namespace fw::world
