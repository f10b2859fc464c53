// When will fire be there? The front of an object that was asked about runs ahead of itself, a
// slice a frame, on the state of a readback, under the wind and pose of now. See
// mesh/front/arrivals.h.
#include "world/world.h"

#include <algorithm>
#include <cfloat>

namespace fw::world {
namespace {

// In bad air fire's time passes slower: ticks told from `from` on for good air as they are in this
// one, if it stays; kNever: fire does not burn in it.
uint64_t inAir(uint64_t tick, uint64_t from, uint32_t air) noexcept {
    const uint32_t strength = gpu::airStrength(air);
    if (tick <= from || strength >= gpu::kAirFull) return tick;
    return strength == 0 ? gpu::kNever : from + (tick - from) * gpu::kAirFull / strength;
}

bool answers(const Forecast& forecast, const Query& query) noexcept {
    return forecast.told && forecast.changes >= query.since && forecast.tick >= query.sinceTick;
}

}  // namespace

FwQueryId World::requestArrival(FwBurnableMeshId id, const float position[3]) {
    Query query = makeQuery(id, position);
    Object& object = *objects_.get(id);
    if (object.data.flags & FW_BURNABLE_PUBLISHED)
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "Burnable mesh %u burns as published, without arrivals to tell.", id.index1);
    if (!object.forecast) {
        auto forecast = core::Owned<Forecast>::make(memory_, memory_);
        mesh::reserveArrivals(forecast->arrivals, domainOf(object));
        forecasts_.push_back(object.slot);
        object.forecast = std::move(forecast);
    }
    query.isArrival = true;
    const bool waits =
        std::any_of(pending_.begin(), pending_.end(), [&](const PendingTexel& event) {
            return event.object == object.slot && event.tick <= clock_.hostTick();
        });
    query.since = changesOf(object) + (waits ? 1 : 0);
    // What the front cannot know of, water that dries above all, is looked at anew every second.
    if (isActive(object) && clock_.tick > gpu::kTicksPerSecond)
        query.sinceTick = clock_.tick - gpu::kTicksPerSecond;
    return queries_.create(query);
}

// Whose answer is neither there nor on its way.
void World::wishForecasts() noexcept {
    for (uint32_t i = 0; i < queries_.slotCount(); ++i) {
        const Query* query = queries_.at(i);
        if (!query || !query->isArrival) continue;
        const Object& object = *objects_.get(query->object);
        if (object.play.burn1 != 0) continue;  // its burn tells
        Forecast& forecast = *object.forecast;
        const bool comes = forecast.pending && forecast.pendingChanges >= query->since;
        if (forecast.wished || comes || answers(forecast, *query)) continue;
        forecast.wished = true;
        ++mapsWished_;
    }
}

void World::takeForecast(Object& object, const gpu::BurnMap& map,
                         const gpu::Readback& readback) noexcept {
    Forecast& forecast = *object.forecast;
    forecast.pending = false;
    const components::DriveInput drive = driveInput(object, clock_.tick);
    components::Latch latch = object.latch;
    components::resetLatch(object.data, drive, latch);
    const components::Records records =
        components::makeRecords(object.data, domainOf(object), drive, latch);
    mesh::ArrivalInput input;
    input.domain = &domainOf(object);
    input.slowness = object.slowness;
    input.materials = records.materials;
    input.window = records.timing.window;
    input.state = map.ticks;
    input.now = readback.endTick;
    input.parts = (remote_.flags & FW_WORLD_CONTACT) != 0;
    mesh::beginArrivals(forecast.arrivals, input);  // its room is there
    forecast.told = true;
    forecast.changes = forecast.pendingChanges;
    forecast.tick = readback.endTick;
    forecast.frameIndex = readback.frameIndex;
}

// Slices of all forecasts that are not through, in turn.
void World::runForecasts() noexcept {
    uint32_t tiles = def_.arrivalTiles;
    for (size_t i = 0, count = forecasts_.size(); i < count && tiles > 0; ++i) {
        const size_t at = (nextForecast_ + i) % count;
        tiles = mesh::runArrivals((*objects_.at(forecasts_[at]))->forecast->arrivals, tiles);
        if (tiles == 0) nextForecast_ = (at + 1) % count;
    }
}

bool World::fetchArrival(FwQueryId id, FwArrivalState& state) {
    const Query& query = openQuery(id, true);
    const Object& object = *objects_.get(query.object);
    const Forecast& forecast = *object.forecast;
    uint64_t tick = gpu::kNever;
    bool comes = false;
    if (object.play.burn1 != 0) {
        const uint32_t recorded = (*burns_.at(object.play.burn1 - 1))->ticks[query.texel];
        comes = recorded != gpu::kNever;
        if (comes) tick = object.play.tickOf(recorded);
        state.frameIndex = lastFrame_;
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
    const uint64_t now = clock_.hostTick();
    const double away = (double(tick) - double(now)) / gpu::kTicksPerSecond;
    state.kind = FW_ARRIVAL_NEVER;
    state.seconds = FLT_MAX;
    if (comes) {
        state.kind = tick <= now ? FW_ARRIVAL_PAST : FW_ARRIVAL_AHEAD;
        state.seconds = float(away);
    }
    state.distance = query.distance;
    texelPosition(object, query.texel, state.position);
    queries_.destroy(id);
    return true;
}

}  // namespace fw::world
