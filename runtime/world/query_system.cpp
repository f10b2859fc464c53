#include "world/query_system.h"

#include "components/lights.h"
#include "core/growth.h"
#include "host_limits.h"
#include "mesh/bake.h"
#include "shared/particle.h"
#include "shared/volume_draw.h"
#include "world/burn_system.h"
#include "world/emitter_system.h"
#include "world/exchange_system.h"
#include "world/light_system.h"
#include "world/shift.h"
#include "world/wind_system.h"

#include <algorithm>
#include <cmath>

namespace fw::world {
namespace {

constexpr size_t kMaxBurnMapsPerFrame = 64;

// Whether it needs the state of this frame. One that runs still answers earlier questions.
bool startsForecast(const Object& object) noexcept {
    return object.forecast && object.forecast->requested && !object.forecast->pending &&
           object.forecast->arrivals.whole;
}

}  // namespace

QuerySystem::QuerySystem(const WorldContext& context, Scene& scene, const WindSystem& wind,
                         ExchangeSystem& exchange, FlameSystem& flames,
                         const EmitterSystem& emitters, const LightSystem& lights,
                         const BurnSystem& burn)
    : context_(context),
      scene_(scene),
      wind_(wind),
      exchange_(exchange),
      flames_(flames),
      emitters_(emitters),
      lights_(lights),
      burn_(burn) {
    // Lights of meshes, fires, emitters.
    sources_.reserve(2 * limits::kLights + gpu::kMaxVolumeFlames + gpu::kMaxEmitters);
    probeFrames_.reserve(kFramesInFlight);
    for (uint32_t i = 0; i < kFramesInFlight; ++i) probeFrames_.emplace_back(context.memory);
}

uint32_t QuerySystem::pollEvents(std::span<FwEvent> out) {
    if (const uint64_t dropped = context_.events.takeDropped())
        context_.log.write(FW_LOG_WARNING, "%llu events were dropped; at most %u wait for a poll.",
                           static_cast<unsigned long long>(dropped), EventQueue::kCapacity);
    return context_.events.poll(out);
}

uint32_t QuerySystem::texelAt(FwBurnableMeshId id, const Object& object,
                              const float position[3]) const {
    float point[3];
    components::toObject(object.data.pose, position, point);
    const uint32_t texel = scene_.nearestTexel(object, point, 1e18f);
    if (texel == mesh::kNone)
        core::failData("The mesh of burnable mesh %u has no texel.", id.index1);
    return texel;
}

void QuerySystem::tagPoint(FwBurnableMeshId id, const float position[3], uint32_t tag) {
    components::checkLengths(position, 3, "position", -1e6f, 1e6f);
    const Object& object = *scene_.objects.get(id);
    if (tags_.size() >= kMaxTags)
        core::refuse("%zu tagged points wait; the limit is %u.", tags_.size(), kMaxTags);
    tags_.push_back({id, texelAt(id, object, position), tag});
}

void QuerySystem::untagPoint(FwBurnableMeshId id, uint32_t tag) {
    (void)scene_.objects.get(id);
    std::erase_if(tags_,
                  [&](const Tag& one) { return one.object.index1 == id.index1 && one.tag == tag; });
}

void QuerySystem::objectState(FwBurnableMeshId id, FwObjectState& state) {
    const Object& object = *scene_.objects.get(id);
    state.frameIndex = object.countersFrame;
    if (!object.touched) state.frameIndex = context_.readbackFrame;
    state.texels = object.texels;
    state.ignited = object.lifecycle.maxIgnited;
    state.burning = object.counters.burning;
    state.frontTiles = object.counters.frontTiles;
    state.refinedTriangles = object.counters.refined;
    state.playsBakedBurn = object.play.burn1 != 0 ? 1 : 0;
    state.burntFraction =
        object.texels ? std::min(1.0f, float(object.lifecycle.maxIgnited) / float(object.texels))
                      : 0.0f;
    state.burningArea = scene_.burningAreaOf(object);
    state.power = scene_.powerOf(object);
    if (components::tracksBurntFuel(object.data))
        state.energy = double(object.lifecycle.energy) / 1048576;
}

void QuerySystem::copyStates(std::pmr::vector<StateCopy>& to) {
    to.resize(scene_.objects.slotCount());
    const auto copy = [&](uint32_t slot, const Object& object) {
        StateCopy& one = to[slot];
        one.state = {};
        one.touched = object.touched || object.play.burn1 != 0;
        objectState(object.id, one.state);
    };
    for (uint32_t slot = 0; slot < to.size(); ++slot) {
        StateCopy& one = to[slot];
        const core::Owned<Object>* owned = scene_.objects.at(slot);
        const uint32_t generation = scene_.objects.idOf(slot).generation;
        const bool known = one.live && one.generation == generation;
        one.live = owned != nullptr;
        one.generation = generation;
        if (!owned) continue;
        if (!known || one.touched)
            copy(slot, **owned);
        else
            one.state.frameIndex = context_.readbackFrame;
    }
    for (const auto* changing : {&scene_.touched, &scene_.playing})
        for (const Object* object : *changing)
            if (!to[object->slot].touched) copy(object->slot, *object);
}

void QuerySystem::energyLedger(FwEnergyLedger& ledger) noexcept {
    // Of what flames give off (fluxFrom has the same share), in parts that add up.
    constexpr uint64_t kRadiatedPercent = 33;
    ledger.frameIndex = context_.readbackFrame;
    ledger.objects = scene_.ledgers;
    ledger.fuel = ledger.unburnt = scene_.fuel;
    for (const Object* touched : scene_.touched) {  // the others have all of theirs
        const Object& object = *touched;
        ledger.burningArea += scene_.burningAreaOf(object);
        ledger.power += scene_.powerOf(object);
        if (!components::tracksBurntFuel(object.data)) continue;
        const uint64_t released = object.lifecycle.energy;
        const uint64_t radiated =
            released / 100 * kRadiatedPercent + released % 100 * kRadiatedPercent / 100;
        ledger.unburnt -= released;
        ledger.radiated += radiated;
        ledger.convected += released - radiated;
    }
}

Query QuerySystem::makeQuery(FwBurnableMeshId id, const float position[3]) {
    components::checkLengths(position, 3, "position", -1e6f, 1e6f);
    const Object& object = *scene_.objects.get(id);
    checkRoom(queries_, kMaxQueries, "queries");
    Query query;
    query.object = id;
    query.texel = texelAt(id, object, position);
    float place[3];
    scene_.texelPosition(object, query.texel, place);
    query.distance = std::sqrt(squaredDistance(place, position));
    return query;
}

FwQueryId QuerySystem::requestPoint(FwBurnableMeshId id, const float position[3]) {
    return queries_.create(makeQuery(id, position));
}

FwPointState QuerySystem::pointState(const Object& object, uint32_t texel,
                                     const gpu::ProbeAnswer& answer,
                                     const gpu::Readback& readback) const noexcept {
    FwPointState state{};
    state.frameIndex = readback.frameIndex;
    state.age = -1;
    const uint32_t code = answer.state;
    const gpu::HeatTexel heat = gpu::unpackHeat({answer.heatX, answer.heatY});
    state.fuel = 1;
    if (answer.heat) {
        state.temperature = float(heat.heat) / 16;
        state.fuel = float(heat.fuel) / float(gpu::kFuelFull);
        state.charred = float(heat.charred) / 255;
        state.water = float(heat.film);
    }
    scene_.texelPosition(object, texel, state.position);
    if (gpu::isSource(code)) {
        if (code > readback.endTick) {
            state.kind = FW_POINT_UNBURNT;  // caught, but its tick is still to come
            return state;
        }
        const uint32_t age = readback.endTick - code;
        state.age = float(double(age) / gpu::kTicksPerSecond);
        const uint32_t burns = object.latch.flameTicks[scene_.texelMaterial(object, texel)];
        if (answer.heat) {
            state.kind = heat.phase == gpu::kPhaseBurnt ? FW_POINT_BURNT : FW_POINT_BURNING;
            return state;
        }
        const bool burning = burns == gpu::kNoneTexel || age < burns;
        state.kind = burning ? FW_POINT_BURNING : FW_POINT_BURNT;
        state.fuel =
            burns == gpu::kNoneTexel ? 1 : float(gpu::thinFuel(age, burns)) / gpu::kFuelFull;
        state.charred = 1 - state.fuel;
        return state;
    }
    state.kind = code == gpu::kNever   ? FW_POINT_UNBURNT
                 : code == gpu::kWet   ? FW_POINT_WET
                 : code == gpu::kInert ? FW_POINT_INERT
                                       : FW_POINT_EXTINGUISHED;  // kOut, kOutWet
    if (code == gpu::kInert) state.fuel = 0;
    return state;
}

Query& QuerySystem::openQuery(FwQueryId id, bool isArrival) {
    Query& query = queries_.get(id);
    FW_ASSERT(scene_.objects.find(query.object), "query %u", id.index1);
    if (query.isArrival != isArrival)
        core::refuse("Query %u asks for %s.", id.index1,
                     query.isArrival ? "an arrival; fwWorld_FetchArrival answers it"
                                     : "a point's state; fwWorld_FetchPoint answers it");
    return query;
}

bool QuerySystem::fetchPoint(FwQueryId id, FwPointState& state) {
    const Query& query = openQuery(id, false);
    if (!query.ready) return false;
    state = query.answer;
    queries_.destroy(id);
    return true;
}

// ---- flamewright_debug.h ----------------------------------------------------------------------

void QuerySystem::requestBurnMap(FwBurnableMeshId id) {
    Object& object = *scene_.objects.get(id);
    object.map.ticks.resize(
        scene_.domainOf(object).texelCount());  // so that a readback needs no memory
    if (components::hasHeat(object.data))
        object.map.heat.resize(scene_.domainOf(object).texelCount());
    if (!object.map.requested) ++mapsRequested_;
    object.map.requested = true;
    object.map.ready = false;
}

void QuerySystem::cancelBurnMap(FwBurnableMeshId id) {
    Object& object = *scene_.objects.get(id);
    if (object.map.requested) --mapsRequested_;
    object.map = BurnMapCopy(context_.memory);
}

const BurnMapCopy* QuerySystem::fetchBurnMap(FwBurnableMeshId id) {
    const BurnMapCopy& map = (*scene_.objects.get(id)).map;
    if (!map.ready && !map.requested && !map.pending)
        core::refuse("The burn map of burnable mesh %u was not asked for; request it first.",
                     id.index1);
    return map.ready ? &map : nullptr;
}

const std::pmr::vector<std::byte>* QuerySystem::fetchBurn(FwBurnableMeshId id) {
    const BurnMapCopy* map = fetchBurnMap(id);
    if (!map) return nullptr;
    Object& object = *scene_.objects.get(id);
    const mesh::BurnDomain& domain = scene_.domainOf(object);
    if (std::none_of(map->ticks.begin(), map->ticks.end(), gpu::isSource))
        core::refuse("Nothing of burnable mesh %u has burnt.", id.index1);
    writeBurn(map->ticks, scene_.meshHash(object), domain.width, domain.height, burnBytes_);
    return &burnBytes_;
}

void QuerySystem::plan(std::initializer_list<std::span<const uint32_t>> others,
                       gpu::FramePlan& plan) {
    ProbeFrame& frame = currentProbes();
    frame.frameIndex = 0;
    frame.tags.assign(tags_.begin(), tags_.end());
    frame.points.clear();
    frame.points.reserve(queries_.live());
    for (auto [i, query] : queries_.entries())
        if (!query.asked && !query.isArrival)
            frame.points.push_back({queries_.idOf(i), query.object, query.texel});
    // Jets strike more or less from frame to frame; capacity is that of the emitters' list.
    for (ProbeFrame& one : probeFrames_) one.jets.reserve(emitters_.mostProbes());
    frame.jets.assign(emitters_.probes().begin(), emitters_.probes().end());
    core::growTo(reachedTags_, frame.tags.size());
    core::growTo(probes_, frame.tags.size() + queries_.live() + emitters_.mostProbes());
    probes_.clear();
    const auto add = [&](const auto& asked) {
        for (const auto& one : asked) probes_.push_back({one.object.index1 - 1, one.texel});
    };
    add(frame.tags), add(frame.points), add(frame.jets);
    requestForecasts();
    burnMaps_.clear();
    if (mapsRequested_ > 0)
        for (auto [slot, object] : scene_.objects.entries())
            if (burnMaps_.size() < kMaxBurnMapsPerFrame &&
                (object.map.requested || startsForecast(object)))
                burnMaps_.push_back(slot);  // the others wait for the next frame
    for (const std::span<const uint32_t> slots : others)
        for (const uint32_t slot : slots) {
            if (std::find(burnMaps_.begin(), burnMaps_.end(), slot) != burnMaps_.end()) continue;
            FW_ASSERT(burnMaps_.size() < burnMaps_.capacity(), "%zu burn maps", burnMaps_.size());
            burnMaps_.push_back(slot);
        }
    plan.probes = probes_;
    plan.burnMaps = burnMaps_;
}

// An older frame may have reported the tag already.
void QuerySystem::onTag(const Tag& tag, uint32_t code, const gpu::Readback& readback) noexcept {
    const auto known = std::find(tags_.begin(), tags_.end(), tag);
    if (!gpu::isSource(code) || code > readback.endTick || known == tags_.end()) return;
    FW_ASSERT(reachedTags_.size() < reachedTags_.capacity(), "%zu tags", reachedTags_.size());
    reachedTags_.push_back(tag);
    tags_.erase(known);
    const Object& object = **scene_.objects.find(tag.object);
    float place[3];
    scene_.texelPosition(object, tag.texel, place);
    context_.raise(FW_EVENT_TAG_REACHED, &object, tag.tag, readback.frameIndex, place,
                   float(double(code) / gpu::kTicksPerSecond));
}

void QuerySystem::onReadback(const gpu::Readback& readback) noexcept {
    jetAnswers_ = {};
    reachedTags_.clear();
    const auto known =
        std::ranges::find(probeFrames_, readback.frameIndex, &ProbeFrame::frameIndex);
    if (known == probeFrames_.end()) return;
    known->frameIndex = 0;
    size_t next = 0;
    const auto eachAnswer = [&](auto& probes, const auto& use) {
        for (auto& probe : probes) {
            if (next == readback.answers.size()) return;
            const gpu::ProbeAnswer& answer = readback.answers[next++];
            if (scene_.objects.find(probe.object)) use(probe, answer);
        }
    };
    eachAnswer(known->tags, [&](const Tag& tag, const gpu::ProbeAnswer& answer) {
        onTag(tag, answer.state, readback);
    });
    eachAnswer(known->points, [&](const PointProbe& probe, const gpu::ProbeAnswer& answer) {
        Query* query = queries_.find(probe.query);
        if (!query) return;
        const float distance = query->distance;
        query->answer =
            pointState(**scene_.objects.find(probe.object), probe.texel, answer, readback);
        query->answer.distance = distance;
        query->ready = true;
    });
    eachAnswer(known->jets, [&](JetProbe& probe, const gpu::ProbeAnswer& answer) {
        const gpu::HeatTexel heat = gpu::unpackHeat({answer.heatX, answer.heatY});
        probe.gone = answer.heat != 0 && gpu::gateOpens(gpu::kEventGate, probe.holeTicks, heat,
                                                        answer.state, readback.endTick);
    });
    jetAnswers_ = known->jets;
}

void QuerySystem::commit(const HostFrame& host) noexcept {
    ProbeFrame& frame = currentProbes();
    frame.frameIndex = host.index;
    for (const PointProbe& probe : frame.points)
        if (Query* query = queries_.find(probe.query)) query->asked = true;
    for (uint32_t slot : burnMaps_) {
        Object& object = scene_.objectAt(slot);
        const auto send = [&](bool& requested, bool& pending) {
            if (!requested) return;
            FW_ASSERT(mapsRequested_ > 0, "burnable mesh %u", object.id.index1);
            requested = false;
            pending = true;
            --mapsRequested_;
        };
        send(object.map.requested, object.map.pending);
        if (!startsForecast(object)) continue;
        object.forecast->pendingChanges = changesOf(object);
        send(object.forecast->requested, object.forecast->pending);
    }
}

void QuerySystem::onBurnMap(Object& object, const gpu::ObjectImage& map,
                            const gpu::Readback& readback) noexcept {
    if (object.forecast && object.forecast->pending) beginForecast(object, map, readback);
    BurnMapCopy& copy = object.map;
    if (!copy.pending || copy.ticks.size() != map.ticks.size()) return;
    std::copy(map.ticks.begin(), map.ticks.end(), copy.ticks.begin());
    if (copy.heat.size() == map.heat.size())
        std::copy(map.heat.begin(), map.heat.end(), copy.heat.begin());
    copy.tick = readback.endTick;
    copy.pending = false;
    copy.ready = true;
}

void QuerySystem::forgetObject(const Object& object) noexcept {
    const uint32_t index1 = object.id.index1;
    std::erase_if(tags_, [&](const Tag& tag) { return tag.object.index1 == index1; });
    for (auto [i, query] : queries_.entries())
        if (query.object.index1 == index1) queries_.destroy(queries_.idOf(i));
    std::erase(forecasts_, object.slot);
    if (object.map.requested) --mapsRequested_;
    if (object.forecast && object.forecast->requested) --mapsRequested_;
}

// Requests to earlier frames are made again.
void QuerySystem::restore(std::pmr::vector<Tag>& tags) noexcept {
    tags_.swap(tags);
    for (ProbeFrame& frame : probeFrames_) frame.frameIndex = 0;
    for (auto [i, query] : queries_.entries()) query.asked &= query.ready;
}

void QuerySystem::restoreObject(Object& object) noexcept {
    const auto again = [&](bool& requested, bool& pending) {
        if (!pending) return;
        pending = false;
        if (!requested) ++mapsRequested_;
        requested = true;
    };
    again(object.map.requested, object.map.pending);
    if (!object.forecast) return;
    again(object.forecast->requested, object.forecast->pending);
    object.forecast->began = false;
}

void QuerySystem::reserveSlots() { core::growTo(burnMaps_, scene_.objects.slotCount()); }

void QuerySystem::shiftOrigin(const double (&by)[3]) noexcept {
    for (auto [i, query] : queries_.entries())
        if (query.ready) moveBy(query.answer.position, by);
}

uint64_t QuerySystem::changesOf(const Object& object) const noexcept {
    return object.changes + wind_.changes();
}

}  // namespace fw::world
