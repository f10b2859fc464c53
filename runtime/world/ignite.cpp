// The host's ignition, water and dousing: balls become events of texels. And whether a match lights
// anything, and if not, why, in words for a host's log.
#include "core/growth.h"
#include "mesh/bake.h"
#include "world/burn_system.h"
#include "world/geometry.h"
#include "world/recording.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace fw::world {

namespace {

using components::checkLength;
using components::checkLengths;
using components::checkValue;

constexpr float kWholeWorld = 4 * 4e6f;  // m: a search of a quarter of it finds every object

double threeDigits(float metres) noexcept {
    const double step = std::pow(10, std::floor(std::log10(std::max(double(metres), 1e-9))) - 2);
    return std::round(double(metres) / step) * step;
}

float distanceToBox(const float point[3], const mesh::BurnDomain& domain) noexcept {
    float squared = 0;
    for (int i = 0; i < 3; ++i) {
        const float outside =
            std::max({0.0f, domain.boundsLow[i] - point[i], point[i] - domain.boundsHigh[i]});
        squared += outside * outside;
    }
    return std::sqrt(squared);
}

// Whether a ball holds the whole of a box; all in object space, radius along the stretched axes.
bool ballHolds(const float point[3], float radius, const components::Pose& pose,
               const mesh::BurnDomain& domain) noexcept {
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
        const double far = std::max(std::abs(double(domain.boundsLow[i]) - double(point[i])),
                                    std::abs(double(domain.boundsHigh[i]) - double(point[i])));
        sum += far * far * double(pose.stretch[i]) * double(pose.stretch[i]);
    }
    return sum <= double(radius) * double(radius);
}

}  // namespace

// Of the events from `first` on, which a match just added: whether one is of a texel that can burn
// and to which no water is on its way.
bool BurnSystem::lightsSomething(size_t first) const noexcept {
    const auto getsWet = [&](const PendingTexel& match) {
        bool wet = false;
        for (size_t i = 0; i < first && context_.clock.tick <= state_.wetUntil; ++i) {
            const PendingTexel& one = state_.pending[i];
            if (one.object != match.object || one.tick > match.tick ||
                (one.texel != match.texel && one.texel != kAllTexels))
                continue;
            wet = one.kind == FW_WET || (wet && one.kind != FW_DRY);
        }
        return wet;
    };
    constexpr uint32_t kMaxQueried = 64;  // of more texels that can burn one is taken to be dry
    uint32_t asked = 0;
    for (size_t i = first; i < state_.pending.size(); ++i) {
        const PendingTexel& match = state_.pending[i];
        const Object& object = scene_.objectAt(match.object);
        if (match.texel == kAllTexels ? object.texels == 0 : !scene_.canBurn(object, match.texel))
            continue;
        if (++asked > kMaxQueried || !getsWet(match)) return true;
    }
    return false;
}

void BurnSystem::explainMiss(const FwIgnitionDef& def, uint32_t texels,
                             std::span<char> text) noexcept {
    const float* at = def.position;
    char ball[128];
    std::snprintf(ball, sizeof ball,
                  "The ball of " FW_LENGTH " " FW_LENGTH_UNIT " at (" FW_LENGTH ", " FW_LENGTH
                  ", " FW_LENGTH ")",
                  double(def.radius), double(at[0]), double(at[1]), double(at[2]));
    if (texels > 0) {
        std::snprintf(
            text.data(), text.size(),
            "%s lights nothing: none of the %u texels in it can burn. Their material is "
            "noncombustible or too moist, their multiplier is 0, their picture is cut out there, "
            "or "
            "water is on its way to them. Give them a material with a spreadRate above 0, or dry "
            "them (FW_DRY).",
            ball, texels);
        return;
    }
    const Object* nearest = nullptr;
    float metres = INFINITY;
    // First to its box, which is cheap, then to its texels.
    const auto meet = [&](const Object& object) {
        float point[3];
        components::toObject(object.data.pose, at, point);
        const components::Pose& pose = object.data.pose;
        if (!object.skinMoved &&
            metres <= distanceToBox(point, scene_.domainOf(object)) * shortestAxis(pose))
            return;
        const uint32_t texel = scene_.nearestTexel(object, point, 1e18f);
        if (texel == mesh::kNone) return;
        float place[3];
        scene_.texelPosition(object, texel, place);
        const float away = std::sqrt(squaredDistance(place, at));
        if (away < metres) nearest = &object, metres = away;
    };
    if (def.object.index1 != 0) meet(**scene_.objects.find(def.object));
    // Searches that grow until one reaches as far as the nearest: a miss costs no look at all
    // objects. An object whose vertices the host moved is in each search.
    const float first = std::max(def.radius, 1.0f);
    for (float reach = first; def.object.index1 == 0 && reach < kWholeWorld; reach *= 4) {
        for (const uint32_t slot : scene_.objectsNear(at, reach))
            if (const Object& object = scene_.objectAt(slot); !object.skinMoved || reach == first)
                meet(object);
        if (metres <= reach) break;
    }
    if (!nearest)
        std::snprintf(text.data(), text.size(),
                      "%s reaches nothing: the world has no burnable mesh.", ball);
    else
        std::snprintf(text.data(), text.size(),
                      "%s reaches nothing: the nearest burnable mesh, %u, is " FW_LENGTH
                      " " FW_LENGTH_UNIT
                      " away. Move the ball there, or give it a radius of that much.",
                      ball, nearest->id.index1, threeDigits(metres));
}

uint32_t BurnSystem::eventTick(float delay) const {
    const uint64_t tick =
        context_.clock.hostTick() + uint64_t(std::lround(double(delay) * gpu::kTicksPerSecond));
    return uint32_t(std::min<uint64_t>(tick, Clock::kLastTick));
}

void BurnSystem::reservePending(size_t more) {
    if (state_.pending.size() + more > kMaxPending)
        core::refuse("%zu texel events wait and %zu more come; the limit is %zu.",
                     state_.pending.size(), more, kMaxPending);
    core::growTo(state_.pending, state_.pending.size() + more);
}

void BurnSystem::addPending(Object& object, uint32_t kind, uint32_t tick, uint32_t water,
                            std::span<const uint32_t> texels) {
    FW_ASSERT(kind <= FW_EXTINGUISH && water <= gpu::kMaxFilm, "kind %u, %u g/m^2", kind, water);
    reservePending(texels.size());
    object.firstEvent = std::min(object.firstEvent, tick);
    if (kind == FW_WET)
        state_.wetUntil = std::max<uint64_t>(state_.wetUntil, tick + gpu::kStepTicks);
    for (uint32_t texel : texels)
        state_.pending.push_back({object.slot, texel, kind, tick, water, state_.order++});
}

uint32_t BurnSystem::igniteObject(Object& object, const FwIgnitionDef& def, uint32_t tick) {
    const mesh::BurnDomain& domain = scene_.domainOf(object);
    float point[3];
    components::toObject(object.data.pose, def.position, point);
    const components::Pose& pose = object.data.pose;
    const float stretched = std::min({std::abs(pose.stretch[0]), pose.stretch[1], pose.stretch[2]});
    float radius = def.radius / (pose.scale * stretched);
    // A doused band holds only when it is thicker than the longest link across it.
    if (def.kind != FW_IGNITE && def.radius > 0)
        radius = std::max({radius, 1.5f * domain.texelSide, domain.linkMax});
    const uint32_t water =
        def.water > 0 ? std::max(uint32_t(std::lround(def.water)), 1u) : gpu::kMaxFilm;
    const auto addTexels = [&](std::span<const uint32_t> texels) {
        addPending(object, def.kind, tick, water, texels);
        if (def.kind != FW_WET && def.kind != FW_EXTINGUISH) return;
        const float* at = def.position;
        splashes_.push_back({object.slot,
                             {at[0], at[1], at[2]},
                             def.radius,
                             def.kind == FW_WET ? water : components::kPatchDrowned,
                             tick});
    };
    // One event, however many texels it has.
    if (!object.skinMoved && ballHolds(point, radius * stretched, pose, domain)) {
        const uint32_t all[] = {kAllTexels};
        addTexels(all);
        return domain.report.realTexels;
    }
    const float reach = std::max(radius, domain.texelSide);
    const uint32_t nearest = scene_.nearTexel(object, point, reach);
    if (nearest == mesh::kNone) return 0;
    scene_.found.clear();
    if (!object.skinMoved)
        mesh::texelsNear(domain, point, radius, scene_.found);
    else
        for (uint32_t i = 0; i < domain.texelCount(); ++i)
            if (domain.real(i)) scene_.found.push_back(i);
    // The ball itself decides: a centre off the surface reaches a smaller disc.
    std::erase_if(scene_.found, [&](uint32_t texel) {
        float d[3];
        scene_.texelPlace(object, texel, d);
        for (int i = 0; i < 3; ++i) d[i] = (d[i] - point[i]) * pose.stretch[i];
        const float reached = radius * stretched;
        return d[0] * d[0] + d[1] * d[1] + d[2] * d[2] > reached * reached;
    });
    if (scene_.found.empty()) scene_.found.push_back(nearest);
    addTexels(scene_.found);
    return uint32_t(scene_.found.size());
}

uint32_t BurnSystem::ignite(const FwIgnitionDef& def, bool* acts) {
    context_.recorder.mayChange();
    checkValue(def.delay, "FwIgnitionDef::delay", 0.0f, 3600.0f);
    components::checkWhole(def.kind, "FwIgnitionDef::kind", 0, FW_EXTINGUISH);
    checkLengths(def.position, 3, "FwIgnitionDef::position", -1e6f, 1e6f);
    checkLength(def.radius, "FwIgnitionDef::radius", 0.0f, 1e6f);
    checkValue(def.water, "FwIgnitionDef::water", 0.0f, def.kind == FW_WET ? 1023.0f : 0.0f);
    for (uint32_t i = 0; i < 2; ++i)
        if (def.reserved[i] != 0)
            core::refuse("FwIgnitionDef::reserved[%u] is %u; it is zero.", i, def.reserved[i]);
    splashes_.clear();
    const uint32_t tick = eventTick(def.delay);
    const size_t before = state_.pending.size();
    try {
        uint32_t texels = 0;
        if (def.object.index1 != 0)
            texels = igniteObject(*scene_.objects.get(def.object), def, tick);
        else
            for (const uint32_t slot : scene_.objectsNear(def.position, def.radius))
                texels += igniteObject(scene_.objectAt(slot), def, tick);
        recordTexels(before);
        if (acts) *acts = texels > 0 && (def.kind != FW_IGNITE || lightsSomething(before));
        return texels;
    } catch (...) {
        state_.pending.resize(before);
        throw;
    }
}

void BurnSystem::pushTexels(FwBurnableMeshId id, uint32_t kind, std::span<const uint32_t> texels) {
    Object& object = *scene_.objects.get(id);
    components::checkWhole(kind, "kind", 0, FW_EXTINGUISH);
    const mesh::BurnDomain& domain = scene_.domainOf(object);
    const uint32_t count = domain.texelCount();
    for (size_t i = 0; i < texels.size(); ++i)
        if (texels[i] >= count)
            core::refuse("texels[%zu] is %u; the map has %u texels.", i, texels[i], count);
    // Heat steps never look at a texel that no triangle covers: an event would change it for good.
    scene_.found.clear();
    for (const uint32_t texel : texels)
        if (domain.real(texel)) scene_.found.push_back(texel);
    addPending(object, kind, uint32_t(context_.clock.tick), gpu::kMaxFilm, scene_.found);
}

void BurnSystem::checkCommandTick(uint32_t tick) const {
    if (tick < context_.clock.tick || tick > Clock::kLastTick)
        core::failData("A command takes effect at tick %u; it is now %llu.", tick,
                       static_cast<unsigned long long>(context_.clock.tick));
}

// The texel events from `first` on, as commands.
void BurnSystem::recordTexels(size_t first) noexcept {
    if (!context_.recorder.records()) return;
    for (size_t i = first; i < state_.pending.size();) {
        const PendingTexel& event = state_.pending[i];
        const TexelChange change{event.kind, event.tick, event.water};
        if (event.texel == kAllTexels) {
            IgniteObjects command{change, {}};
            while (i < state_.pending.size() && state_.pending[i].texel == kAllTexels &&
                   command.slots.add(state_.pending[i].object))
                ++i;
            context_.recorder.record(command);
            continue;
        }
        IgniteTexels command{event.object, change, {}};
        while (i < state_.pending.size() && state_.pending[i].object == command.slot &&
               state_.pending[i].texel != kAllTexels && command.texels.add(state_.pending[i].texel))
            ++i;
        context_.recorder.record(command);
    }
}

void BurnSystem::apply(const IgniteTexels& command) {
    Object& object = *scene_.objects.get(scene_.objects.findId(command.slot));
    const mesh::BurnDomain& domain = scene_.domainOf(object);
    scene_.found.clear();
    command.texels.each([&](uint32_t texel) {
        if (texel >= domain.texelCount() || !domain.real(texel))
            core::failData("A command changes texel %u of burnable mesh %u.", texel,
                           command.slot + 1);
        scene_.found.push_back(texel);
    });
    addChange(object, command.change, scene_.found);
    context_.recorder.record(command);
}

void BurnSystem::apply(const IgniteObjects& command) {
    constexpr uint32_t all[] = {kAllTexels};
    size_t count = 0;
    command.slots.each([&](uint32_t slot) {
        (void)scene_.objects.get(scene_.objects.findId(slot));
        ++count;
    });
    reservePending(count);
    command.slots.each(
        [&](uint32_t slot) { addChange(scene_.objectAt(slot), command.change, all); });
    context_.recorder.record(command);
}

void BurnSystem::addChange(Object& object, const TexelChange& change,
                           std::span<const uint32_t> texels) {
    checkCommandTick(change.tick);
    if (change.kind > FW_EXTINGUISH || change.water > gpu::kMaxFilm)
        core::failData("A command is of kind %u with %u g/m^2 of water; the limits are %u and %u.",
                       change.kind, change.water, uint32_t(FW_EXTINGUISH), gpu::kMaxFilm);
    if (!texels.empty()) addPending(object, change.kind, change.tick, change.water, texels);
}

void BurnSystem::addPending(PendingTexel event) noexcept {
    FW_ASSERT(state_.pending.size() < state_.pending.capacity(), "%zu events",
              state_.pending.size());
    event.order = state_.order++;
    state_.pending.push_back(event);
}

}  // namespace fw::world
