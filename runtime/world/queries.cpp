// What a game asks: states, points, tags, lights, figures. Answers are of the last readback.
#include "world/world.h"

#include "mesh/bake.h"

#include <algorithm>
#include <cmath>

namespace fw::world {

const mesh::BurnDomain& World::domainOf(const Object& object) const noexcept {
    return *meshes_.at(object.data.meshSlot)->domain;
}

void World::texelPosition(const Object& object, uint32_t texel, float (&out)[3]) const noexcept {
    float place[3];
    texelPlace(object, texel, place);
    components::toWorld(object.data.pose, place, out);
}

void World::texelPlace(const Object& object, uint32_t texel, float (&out)[3]) const noexcept {
    const mesh::BurnDomain& domain = domainOf(object);
    const mesh::TexelPosition& p = domain.texels[texel];
    const uint16_t units[3] = {p.x, p.y, p.z};
    for (int i = 0; i < 3; ++i) out[i] = domain.origin[i] + domain.quantum * float(units[i]);
    if (!object.skinMoved || domain.triangleOf[texel] == mesh::kNone) return;
    float weights[3];
    mesh::texelWeights(domain, texel, weights);
    std::fill_n(out, 3, 0.0f);
    for (size_t k = 0; k < 3; ++k) {
        const uint32_t vertex = domain.indices[size_t(domain.triangleOf[texel]) * 3 + k];
        const float* at = &object.skin[size_t(domain.sources[vertex]) * 3];
        for (int i = 0; i < 3; ++i) out[i] += weights[k] * at[i];
    }
}

uint32_t World::nearestTexel(const Object& object, const float point[3],
                             float reach) const noexcept {
    const mesh::BurnDomain& domain = domainOf(object);
    if (!object.skinMoved) return mesh::nearestTexel(domain, point, reach);
    uint32_t nearest = mesh::kNone;
    float least = reach * reach;
    for (uint32_t i = 0; i < domain.texelCount(); ++i) {
        if (!domain.real(i)) continue;
        float place[3], sum = 0;
        texelPlace(object, i, place);
        for (int k = 0; k < 3; ++k) sum += (place[k] - point[k]) * (place[k] - point[k]);
        if (sum > least || (sum == least && nearest != mesh::kNone)) continue;
        least = sum;
        nearest = i;
    }
    return nearest;
}

uint32_t World::texelMaterial(const Object& object, uint32_t texel) const noexcept {
    return domainOf(object).texels[texel].materialFlags & (gpu::kMaterialsPerObject - 1);
}

uint32_t World::pollEvents(std::span<FwEvent> out) {
    if (const uint64_t dropped = events_.takeDropped())
        log_.write(FW_LOG_WARNING, "%llu events were dropped; at most %u wait for a poll.",
                   static_cast<unsigned long long>(dropped), EventQueue::kCapacity);
    return events_.poll(out);
}

void World::tagPoint(FwBurnableMeshId id, const float position[3], uint32_t tag) {
    components::checkLengths(position, 3, "position", -1e6f, 1e6f);
    const Object& object = *objects_.get(id);
    if (tags_.size() >= kMaxTags)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "%zu tagged points wait; the limit is %u.",
                   tags_.size(), kMaxTags);
    float point[3];
    components::toObject(object.data.pose, position, point);
    const uint32_t texel = nearestTexel(object, point, 1e18f);
    if (texel == mesh::kNone)
        core::fail(FW_ERROR_BAD_DATA, "The mesh of burnable mesh %u has no texel.", id.index1);
    tags_.push_back({id, texel, tag});
}

void World::untagPoint(FwBurnableMeshId id, uint32_t tag) {
    (void)objects_.get(id);
    std::erase_if(tags_,
                  [&](const Tag& one) { return one.object.index1 == id.index1 && one.tag == tag; });
}

float World::burningAreaOf(const Object& object) noexcept {
    const auto& report = meshes_.at(object.data.meshSlot)->domain->report;
    const float scale = object.data.pose.scale;
    const float texelArea =
        report.realTexels ? float(report.texelArea) / float(report.realTexels) : 0.0f;
    return float(object.counters.burning) * texelArea * scale * scale;
}

float World::powerOf(const Object& object) noexcept {
    if (components::hasHeat(object.data)) return object.story.power;
    return burningAreaOf(object) *
           components::powerPerArea(object.data, meshes_.at(object.data.meshSlot)->texelsOf);
}

void World::objectState(FwBurnableMeshId id, FwObjectState& state) {
    const Object& object = *objects_.get(id);
    state.frameIndex = object.countersFrame;
    if (!object.touched) state.frameIndex = readbackFrame_;
    state.texels = object.texels;
    state.ignited = object.story.mostIgnited;
    state.burning = object.counters.burning;
    state.frontTiles = object.counters.frontTiles;
    state.refinedTriangles = object.counters.refined;
    state.plays = object.play.burn1 != 0 ? 1 : 0;
    state.burntFraction =
        object.texels ? std::min(1.0f, float(object.story.mostIgnited) / float(object.texels))
                      : 0.0f;
    state.burningArea = burningAreaOf(object);
    state.power = powerOf(object);
    if (components::keepsBook(object.data)) state.energy = double(object.story.energy) / 1048576;
}

void World::copyStates(std::pmr::vector<StateCopy>& to) {
    to.resize(objects_.slotCount());
    const auto copy = [&](uint32_t slot, const Object& object) {
        StateCopy& one = to[slot];
        one.state = {};
        one.touched = object.touched || object.play.burn1 != 0;
        objectState(object.id, one.state);
    };
    for (uint32_t slot = 0; slot < to.size(); ++slot) {
        StateCopy& one = to[slot];
        const core::Owned<Object>* owned = objects_.at(slot);
        const uint32_t generation = objects_.idOf(slot).generation;
        const bool known = one.live && one.generation == generation;
        one.live = owned != nullptr;
        one.generation = generation;
        if (!owned) continue;
        if (!known || one.touched)
            copy(slot, **owned);
        else
            one.state.frameIndex = readbackFrame_;
    }
    for (const Object* object : touched_)
        if (!to[object->slot].touched) copy(object->slot, *object);
    for (const Object* object : playing_)
        if (!to[object->slot].touched) copy(object->slot, *object);
}

void World::energyBook(FwEnergyBook& book) noexcept {
    // Of what flames give off (fluxFrom has the same share), in parts that add up.
    constexpr uint64_t kRadiatedPercent = 33;
    book.frameIndex = readbackFrame_;
    book.objects = ledgers_;
    book.fuel = book.unburnt = fuel_;
    for (const Object* touched : touched_) {  // the others have all of theirs
        const Object& object = *touched;
        book.burningArea += burningAreaOf(object);
        book.power += powerOf(object);
        if (!components::keepsBook(object.data)) continue;
        const uint64_t released = object.story.energy;
        const uint64_t radiated =
            released / 100 * kRadiatedPercent + released % 100 * kRadiatedPercent / 100;
        book.unburnt -= released;
        book.radiated += radiated;
        book.convected += released - radiated;
    }
}

Query World::makeQuery(FwBurnableMeshId id, const float position[3]) {
    components::checkLengths(position, 3, "position", -1e6f, 1e6f);
    const Object& object = *objects_.get(id);
    if (queries_.live() >= kMaxQueries)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "%u queries are open; the limit is %u.",
                   queries_.live(), kMaxQueries);
    float point[3];
    components::toObject(object.data.pose, position, point);
    Query query;
    query.object = id;
    query.texel = nearestTexel(object, point, 1e18f);
    if (query.texel == mesh::kNone)
        core::fail(FW_ERROR_BAD_DATA, "The mesh of burnable mesh %u has no texel.", id.index1);
    float place[3];
    texelPosition(object, query.texel, place);
    float sum = 0;
    for (int i = 0; i < 3; ++i) sum += (place[i] - position[i]) * (place[i] - position[i]);
    query.distance = std::sqrt(sum);
    return query;
}

FwQueryId World::requestPoint(FwBurnableMeshId id, const float position[3]) {
    return queries_.create(makeQuery(id, position));
}

FwPointState World::pointState(const Object& object, uint32_t texel, const gpu::ProbeAnswer& answer,
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
    texelPosition(object, texel, state.position);
    if (gpu::isSource(code)) {
        if (code > readback.endTick) {
            state.kind = FW_POINT_UNBURNT;  // caught, but its tick is still to come
            return state;
        }
        const uint32_t age = readback.endTick - code;
        state.age = float(double(age) / gpu::kTicksPerSecond);
        const uint32_t burns = object.latch.flameTicks[texelMaterial(object, texel)];
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

Query& World::openQuery(FwQueryId id, bool isArrival) {
    Query& query = queries_.get(id);
    if (query.isArrival != isArrival)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "Query %u asks for %s.", id.index1,
                   query.isArrival ? "an arrival; fwWorld_FetchArrival answers it"
                                   : "a point's state; fwWorld_FetchPoint answers it");
    return query;
}

bool World::fetchPoint(FwQueryId id, FwPointState& state) {
    const Query& query = openQuery(id, false);
    if (!query.ready) return false;
    state = query.answer;
    queries_.destroy(id);
    return true;
}

void World::stats(FwWorldStats& stats) noexcept {
    stats.steps = steps_;
    stats.tick = clock_.tick;
    stats.readbackFrame = readbackFrame_;
    stats.objects = objects_.live();
    stats.meshes = meshes_.live() - shapes_;
    stats.materials = materials_.live();
    stats.frontTiles = frontTiles_;
    stats.runTiles = runTiles_;
    stats.burningTiles = burningTiles_;
    stats.hotTiles = hotTiles_;
    stats.flames = backend_.quadsShown();
    stats.lateClamps = lateClamps_;
    stats.droppedSteps = uint32_t(droppedSteps_);
    for (const Object* object : touched_) {
        stats.burningObjects += object->counters.burning > 0 ? 1u : 0u;
        stats.refinedTriangles += object->counters.refined;
    }
    stats.texels = texels_;
}

void World::setBudget(const FwBudgetDef& def) {
    components::checkValue(def.gpuMilliseconds, "FwBudgetDef::gpuMilliseconds", 0.0f, 1000.0f);
    components::checkValue(def.cpuMilliseconds, "FwBudgetDef::cpuMilliseconds", 0.0f, 1000.0f);
    components::checkValue(def.measuredMilliseconds, "FwBudgetDef::measuredMilliseconds", -1e5f,
                           1e5f);
    budget_ = {def.gpuMilliseconds, def.cpuMilliseconds, double(def.bytes)};
    budgetMeasured_ = def.measuredMilliseconds >= 0;
    if (budgetMeasured_) spent_.gpu = def.measuredMilliseconds;
}

void World::budgetState(FwBudgetState& state) const noexcept {
    const gpu::Detail detail = detailOf(governor_.level);
    state.level = governor_.level;
    state.levels = kDetailLevels;
    state.marchedFires = detail.marched;
    state.volumeSteps = std::min(detail.volumeSteps, def_.volumeSteps);
    state.refinedTriangles = uint32_t(detail.triangles * float(def_.maxRefinedTriangles));
    state.gpuMilliseconds = governor_.cost.gpu;
    state.cpuMilliseconds = governor_.cost.cpu;
    state.quads = detail.quads;
    state.lights = gpu::lightsOf(detail, def_.maxLights);
    state.bytes = backend_.detailBytes();
}

// ---- flamewright_debug.h ----------------------------------------------------------------------

void World::requestBurnMap(FwBurnableMeshId id) {
    Object& object = *objects_.get(id);
    object.map.ticks.resize(domainOf(object).texelCount());  // so that a readback needs no memory
    if (components::hasHeat(object.data)) object.map.heat.resize(domainOf(object).texelCount());
    if (!object.map.wished) ++mapsWished_;
    object.map.wished = true;
    object.map.ready = false;
}

void World::cancelBurnMap(FwBurnableMeshId id) {
    Object& object = *objects_.get(id);
    if (object.map.wished) --mapsWished_;
    object.map = BurnMapCopy(memory_);
}

const BurnMapCopy* World::fetchBurnMap(FwBurnableMeshId id) {
    const BurnMapCopy& map = (*objects_.get(id)).map;
    if (!map.ready && !map.wished && !map.pending)
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "The burn map of burnable mesh %u was not asked for; request it first.",
                   id.index1);
    return map.ready ? &map : nullptr;
}

void World::setSwitches(uint32_t switches) {
    constexpr uint32_t kKnown = FW_DEBUG_DENSE | FW_DEBUG_SHUFFLE | FW_DEBUG_NO_SEAM_WAKE |
                                FW_DEBUG_WRONG_READERS | FW_DEBUG_NO_WIND_WAKE |
                                FW_DEBUG_NEVER_IDLE | FW_DEBUG_REFINE_FULL | FW_DEBUG_CROSSING |
                                FW_DEBUG_NO_Z_PASS;
    if (switches & ~kKnown)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "switches is 0x%x; the known switches are 0x%x.",
                   switches, kKnown);
    switches_ = switches;
}

}  // namespace fw::world
