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
#include "world/persistence.h"
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
                         ExchangeSystem& exchange, FlameSystem& flames, EmitterSystem& emitters,
                         const LightSystem& lights, const BurnSystem& burn)
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
        core::fail(FW_ERROR_BAD_DATA, "The mesh of burnable mesh %u has no texel.", id.index1);
    return texel;
}

void QuerySystem::tagPoint(FwBurnableMeshId id, const float position[3], uint32_t tag) {
    components::checkLengths(position, 3, "position", -1e6f, 1e6f);
    const Object& object = *scene_.objects.get(id);
    if (state_.tags.size() >= kMaxTags)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "%zu tagged points wait; the limit is %u.",
                   state_.tags.size(), kMaxTags);
    state_.tags.push_back({id, texelAt(id, object, position), tag});
}

void QuerySystem::untagPoint(FwBurnableMeshId id, uint32_t tag) {
    (void)scene_.objects.get(id);
    std::erase_if(state_.tags,
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
    for (const Object* object : scene_.touched)
        if (!to[object->slot].touched) copy(object->slot, *object);
    for (const Object* object : scene_.playing)
        if (!to[object->slot].touched) copy(object->slot, *object);
}

void QuerySystem::energyLedger(FwEnergyLedger& book) noexcept {
    // Of what flames give off (fluxFrom has the same share), in parts that add up.
    constexpr uint64_t kRadiatedPercent = 33;
    book.frameIndex = context_.readbackFrame;
    book.objects = scene_.ledgers;
    book.fuel = book.unburnt = scene_.fuel;
    for (const Object* touched : scene_.touched) {  // the others have all of theirs
        const Object& object = *touched;
        book.burningArea += scene_.burningAreaOf(object);
        book.power += scene_.powerOf(object);
        if (!components::tracksBurntFuel(object.data)) continue;
        const uint64_t released = object.lifecycle.energy;
        const uint64_t radiated =
            released / 100 * kRadiatedPercent + released % 100 * kRadiatedPercent / 100;
        book.unburnt -= released;
        book.radiated += radiated;
        book.convected += released - radiated;
    }
}

Query QuerySystem::makeQuery(FwBurnableMeshId id, const float position[3]) {
    components::checkLengths(position, 3, "position", -1e6f, 1e6f);
    const Object& object = *scene_.objects.get(id);
    if (state_.queries.live() >= kMaxQueries)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "%u queries are open; the limit is %u.",
                   state_.queries.live(), kMaxQueries);
    Query query;
    query.object = id;
    query.texel = texelAt(id, object, position);
    float place[3];
    scene_.texelPosition(object, query.texel, place);
    float sum = 0;
    for (int i = 0; i < 3; ++i) sum += (place[i] - position[i]) * (place[i] - position[i]);
    query.distance = std::sqrt(sum);
    return query;
}

FwQueryId QuerySystem::requestPoint(FwBurnableMeshId id, const float position[3]) {
    return state_.queries.create(makeQuery(id, position));
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
    switch (code) {
        case gpu::kNever:
            state.kind = FW_POINT_UNBURNT;
            break;
        case gpu::kWet:
            state.kind = FW_POINT_WET;
            break;
        case gpu::kInert:
            state.kind = FW_POINT_INERT;
            state.fuel = 0;
            break;
        default:
            state.kind = FW_POINT_EXTINGUISHED;
            break;  // kOut, kOutWet
    }
    return state;
}

Query& QuerySystem::openQuery(FwQueryId id, bool isArrival) {
    Query& query = state_.queries.get(id);
    if (query.isArrival != isArrival)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "Query %u asks for %s.", id.index1,
                   query.isArrival ? "an arrival; fwWorld_FetchArrival answers it"
                                   : "a point's state; fwWorld_FetchPoint answers it");
    return query;
}

bool QuerySystem::fetchPoint(FwQueryId id, FwPointState& state) {
    const Query& query = openQuery(id, false);
    if (!query.ready) return false;
    state = query.answer;
    state_.queries.destroy(id);
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
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "The burn map of burnable mesh %u was not asked for; request it first.",
                   id.index1);
    return map.ready ? &map : nullptr;
}

void QuerySystem::plan() {
    ProbeFrame& known = currentProbes();
    probes_.clear();
    known.frameIndex = 0;
    known.refs.clear();
    const size_t most = state_.tags.size() + state_.queries.live();  // those of jets have room
    probes_.reserve(most);
    known.refs.reserve(most);
    for (const Tag& tag : state_.tags) {
        probes_.push_back({tag.object.index1 - 1, tag.texel});
        known.refs.push_back({true, tag.object, tag.texel, tag.tag, {}, 0, 0, 0});
    }
    for (auto [i, query] : state_.queries.entries()) {
        if (query.asked || query.isArrival) continue;
        probes_.push_back({query.object.index1 - 1, query.texel});
        known.refs.push_back(
            {false, query.object, query.texel, 0, state_.queries.idOf(i), 0, 0, 0});
    }
    requestForecasts();
    emitters_.probeJets();
    burnMaps_.clear();
    for (uint32_t i = 0; mapsRequested_ > 0 && i < scene_.objects.slotCount(); ++i)
        if (auto* object = scene_.objects.at(i);
            object && burnMaps_.size() < kMaxBurnMapsPerFrame &&
            ((*object)->map.requested || startsForecast(**object)))
            burnMaps_.push_back(i);  // the others wait for the next frame
}

void QuerySystem::onReadback(const gpu::Readback& readback) noexcept {
    const auto known = std::find_if(
        probeFrames_.begin(), probeFrames_.end(),
        [&](const ProbeFrame& frame) { return frame.frameIndex == readback.frameIndex; });
    if (known == probeFrames_.end()) return;
    const size_t count = std::min(known->refs.size(), readback.answers.size());
    for (size_t i = 0; i < count; ++i) {
        const ProbeRef& ref = known->refs[i];
        auto* owned = scene_.objects.find(ref.object);
        if (!owned) continue;
        const Object& object = **owned;
        const uint32_t code = readback.answers[i].state;
        if (ref.jet > 0) {
            const gpu::ProbeAnswer& answer = readback.answers[i];
            const gpu::HeatTexel x = gpu::unpackHeat({answer.heatX, answer.heatY});
            const bool gone = answer.heat != 0 && gpu::gateOpens(gpu::kEventGate, ref.holeTicks, x,
                                                                 code, readback.endTick);
            emitters_.onHole(ref.jet - 1, ref.ray,
                             {gone ? ref.object : FwBurnableMeshId{}, ref.texel});
        } else if (ref.isTag) {
            if (!gpu::isSource(code) || code > readback.endTick) continue;
            const auto tag =
                std::find_if(state_.tags.begin(), state_.tags.end(), [&](const Tag& t) {
                    return t.object.index1 == ref.object.index1 &&
                           t.object.generation == ref.object.generation && t.texel == ref.texel &&
                           t.tag == ref.tag;
                });
            if (tag == state_.tags.end()) continue;  // an older frame said so already
            context_.recorder.forgetTag(*tag, readback.frameIndex);
            state_.tags.erase(tag);
            float place[3];
            scene_.texelPosition(object, ref.texel, place);
            context_.raise(FW_EVENT_TAG_REACHED, &object, ref.tag, readback.frameIndex, place,
                           float(double(code) / gpu::kTicksPerSecond));
        } else if (Query* query = state_.queries.find(ref.query)) {
            const float distance = query->distance;
            query->answer = pointState(object, ref.texel, readback.answers[i], readback);
            query->answer.distance = distance;
            query->ready = true;
        }
    }
    known->frameIndex = 0;
}

void QuerySystem::commit(uint64_t frameIndex) noexcept {
    ProbeFrame& known = currentProbes();
    known.frameIndex = frameIndex;
    for (const ProbeRef& ref : known.refs)
        if (!ref.isTag)
            if (Query* query = state_.queries.find(ref.query)) query->asked = true;
    for (uint32_t slot : burnMaps_) {
        Object& object = scene_.objectAt(slot);
        const auto send = [&](bool& requested, bool& pending) {
            if (!requested) return;
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

void QuerySystem::onBurnMap(Object& object, const gpu::BurnMap& map,
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

void QuerySystem::fillPlan(gpu::FramePlan& plan) const noexcept {
    plan.probes = probes_;
    plan.burnMaps = burnMaps_;
}

void QuerySystem::addBurnMap(uint32_t slot) noexcept {
    if (std::find(burnMaps_.begin(), burnMaps_.end(), slot) == burnMaps_.end())
        burnMaps_.push_back(slot);
}

void QuerySystem::reserveJetProbes(size_t rays) {
    for (ProbeFrame& frame : probeFrames_) frame.refs.reserve(rays);
    probes_.reserve(rays);
}

void QuerySystem::addJetProbe(const components::JetHit& hit, uint32_t slot, uint32_t ray,
                              uint32_t holeTicks) noexcept {
    probes_.push_back({hit.object.index1 - 1, hit.texel});
    ProbeRef ref;
    ref.object = hit.object;
    ref.texel = hit.texel;
    ref.jet = slot + 1;
    ref.ray = ray;
    ref.holeTicks = holeTicks;
    currentProbes().refs.push_back(ref);
}

// Answers on their way would be another jet's in the slot.
void QuerySystem::forgetJet(FwFireEmitterId id) noexcept {
    for (ProbeFrame& frame : probeFrames_)
        for (ProbeRef& ref : frame.refs)
            if (ref.jet == id.index1) ref.object = {};
}

void QuerySystem::forgetObject(const Object& object) noexcept {
    const uint32_t index1 = object.id.index1;
    std::erase_if(state_.tags, [&](const Tag& tag) { return tag.object.index1 == index1; });
    for (auto [i, query] : state_.queries.entries())
        if (query.object.index1 == index1) state_.queries.destroy(state_.queries.idOf(i));
    std::erase(forecasts_, object.slot);
    if (object.map.requested) --mapsRequested_;
    if (object.forecast && object.forecast->requested) --mapsRequested_;
}

void QuerySystem::reserveSlots() { core::growTo(burnMaps_, scene_.objects.slotCount()); }

void QuerySystem::shiftOrigin(const double (&by)[3]) noexcept {
    for (auto [i, query] : state_.queries.entries())
        if (query.ready) moveBy(query.answer.position, by);
}

uint64_t QuerySystem::changesOf(const Object& object) const noexcept {
    return object.changes + wind_.changes();
}

}  // namespace fw::world
