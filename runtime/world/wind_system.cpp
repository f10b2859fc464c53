#include "world/wind_system.h"

#include "host_limits.h"
#include "shared/burn.h"
#include "world/geometry.h"
#include "world/recording.h"
#include "world/shift.h"

#include <algorithm>
#include <utility>

namespace fw::world {

using components::WindPlace;
using components::WindZone;
using fire::WindVector;

namespace {

// m/s: what blows everywhere, and what `here` has more of.
std::array<float, 3> withMore(const float (&wind)[3], const WindVector& here) noexcept {
    const WindVector around = fire::windUnits(wind);
    std::array<float, 3> sum;
    for (size_t i = 0; i < 3; ++i) sum[i] = wind[i] + float(here[i] - around[i]) * fire::kWindUnit;
    return sum;
}

}  // namespace

WindVector windOf(const WindFields& winds, const components::Gusts& gusts,
                  std::span<const WindZone> zones, uint32_t seed, const WindPlace& place,
                  uint64_t tick) noexcept {
    const WindVector around = fire::windUnits(winds.wind);
    const WindVector on = components::windOnGrid(winds.grid, around, place);
    return components::windIn(zones, components::gustOf(gusts, seed, around, on, place, tick),
                              place);
}

WindSystem::WindSystem(const WorldContext& context, Scene& scene)
    : context_(context), scene_(scene) {
    std::copy_n(context.def.wind, 3, state_.wind);
}

bool WindSystem::isUniform() const noexcept {
    return state_.ordered.empty() && state_.grid.points.empty() && !hasGusts();
}

WindVector WindSystem::at(const WindPlace& place, uint64_t tick) const noexcept {
    if (isUniform()) return fire::windUnits(state_.wind);
    return windOf(state_, state_.gusts, state_.ordered, context_.def.seed, place, tick);
}

std::array<float, 3> WindSystem::at(const float place[3], uint64_t tick) const noexcept {
    if (isUniform()) return {state_.wind[0], state_.wind[1], state_.wind[2]};
    return withMore(state_.wind, at(components::windPlace(place), tick));
}

std::array<float, 3> WindSystem::steadyAt(const float place[3]) const noexcept {
    return withMore(state_.wind,
                    windOf(state_, {}, state_.ordered, 0, components::windPlace(place), 0));
}

void WindSystem::atPoint(const float point[3], float wind[3]) const {
    components::checkLengths(point, 3, "point", -1e6f, 1e6f);
    const std::array<float, 3> here = at(point, context_.clock.tick);
    std::copy_n(here.data(), 3, wind);
}

WindPlace windPlaceOf(const components::Pose& pose, const mesh::BurnDomain& domain) noexcept {
    float middle[3];
    double place[3];
    middleOf(domain, middle);
    components::toWorld(pose, middle, place);
    return components::windPlace(place);
}

components::DriveInput WindSystem::driveInput(const Object& object, uint64_t tick) const noexcept {
    components::DriveInput drive;
    drive.wind = isUniform() ? fire::windUnits(state_.wind)
                             : at(windPlaceOf(object.data.pose, scene_.domainOf(object)), tick);
    std::copy_n(context_.def.up, 3, drive.up);
    drive.pace = context_.def.paceFactor;
    return drive;
}

uint32_t WindSystem::localWindOf(const Object& object, uint64_t tick) const noexcept {
    if (isUniform()) return 0;
    const WindVector around = fire::windUnits(state_.wind);
    WindVector here = at(windPlaceOf(object.data.pose, scene_.domainOf(object)), tick);
    for (size_t i = 0; i < 3; ++i) here[i] -= around[i];
    return components::packWind(here);
}

void WindSystem::sortZones() noexcept {
    FW_ASSERT(state_.zones.live() <= state_.ordered.capacity(), "%u zones", state_.zones.live());
    state_.ordered.clear();
    for (auto [i, zone] : state_.zones.entries()) state_.ordered.push_back(zone);
    components::sortWindZones(state_.ordered);
    ++state_.changes;
}

// Objects where a zone was, or is now, get the wind that blows there now.
void WindSystem::updateObjectsIn(const WindZone& zone) noexcept {
    if (state_.due || hasGusts()) {  // all do, and at another time
        updateObjects();
        return;
    }
    state_.gustsShown = context_.clock.tick;
    ++state_.updates;
    const int64_t reach = zone.size[0] + zone.size[1] + zone.size[2] + 1;  // whatever its shape
    for (const uint32_t slot : scene_.objectsNear(cubeAround(zone.middle, reach), 0))
        updateObject(scene_.objectAt(slot));
}

void WindSystem::updateObjects() noexcept {
    state_.due = false;
    state_.gustsShown = context_.clock.tick;
    ++state_.updates;
    if (isUniform() && !state_.kept) return;
    state_.kept = !isUniform();
    for (auto [slot, owned] : scene_.objects.entries()) updateObject(owned);
}

void WindSystem::updateObject(Object& object) noexcept {
    const uint32_t wind = localWindOf(object, context_.clock.tick);
    // In gusts others hear of it with each exchange; after the last one, once more.
    const bool heard =
        hasGusts() || object.exchangeVersion == 0 || int(wind) == object.exchangeObject.high.w;
    if (wind == object.zoneWind && heard) return;
    state_.kept |= wind != 0;
    object.zoneWind = wind;
    context_.backend.setObjectWind(object.slot, wind);
    scene_.markMoved(object);
}

FwWindZoneId WindSystem::createZone(const FwWindZoneDef& def) {
    checkRoom(state_.zones, limits::kWindZones, "wind zones");
    const WindZone zone = components::makeWindZone(def);
    state_.ordered.reserve(state_.zones.live() + 1);
    const FwWindZoneId id = state_.zones.create(zone);
    sortZones();
    updateObjectsIn(zone);
    return id;
}

void WindSystem::setZone(FwWindZoneId id, const WindZone& made) {
    context_.recorder.mayChange();
    WindZone& zone = state_.zones.get(id);
    if (!(zone == made)) {
        const WindZone before = std::exchange(zone, made);
        sortZones();
        updateObjectsIn(before);
        updateObjectsIn(made);
    }
    context_.recorder.record(SetWindZone{id.index1 - 1, made});
}

// Parts of a grid may have come one by one, and gusts go on.
void WindSystem::plan(gpu::FramePlan& plan) noexcept {
    constexpr uint64_t kQuarter = fire::kWindLatchTicks;
    if (state_.due ||
        (hasGusts() && context_.clock.tick / kQuarter != state_.gustsShown / kQuarter))
        updateObjects();
    std::copy_n(state_.wind, 3, plan.wind);
}

void WindSystem::setGusts(const FwGustDef& def) {
    const components::Gusts gusts = components::makeGusts(def, state_.gusts);
    apply(SetGusts{gusts.strength, gusts.size});
}

void WindSystem::apply(const SetGusts& command) {
    context_.recorder.mayChange();
    components::Gusts gusts = state_.gusts;
    gusts.strength = command.strength;
    gusts.size = command.size;
    if (!components::plausible(gusts, context_.clock.tick))
        core::failData("A command's gusts are out of their limits.");
    if (!(gusts == state_.gusts)) ++state_.changes;
    state_.gusts = gusts;
    updateObjects();
    context_.recorder.record(command);
}

// The grid's shape is recorded with calm on it, then the points that differ.
void WindSystem::setGrid(const FwWindGridDef& def) {
    context_.recorder.mayChange();
    components::WindGrid grid(context_.memory);
    if (def.structSize != 0) {
        grid.shape = components::makeWindGridShape(def);
        components::readWindPoints(def, grid.points);
    }
    const bool stays = grid.shape == state_.grid.shape;
    if (!stays) context_.recorder.record(SetWindGrid{grid.shape});
    recordParts<SetWindPoints>(context_.recorder, grid.points, state_.grid.points, stays);
    state_.grid.shape = grid.shape;
    state_.grid.points.swap(grid.points);
    ++state_.changes;
    updateObjects();
}

void WindSystem::apply(const SetWindGrid& command) {
    context_.recorder.mayChange();
    std::pmr::vector<components::WindPoint> calm(command.shape.points(), context_.memory);
    state_.grid.points.swap(calm);
    state_.grid.shape = command.shape;
    ++state_.changes;
    state_.due = true;
    context_.recorder.record(command);
}

void WindSystem::apply(const SetWindPoints& command) {
    context_.recorder.mayChange();
    const size_t points = state_.grid.points.size();
    if (command.first >= points)
        core::failData("A command is of point %u of the wind grid, which has %zu.", command.first,
                       points);
    std::copy_n(command.values.begin(), std::min<size_t>(command.kCount, points - command.first),
                state_.grid.points.begin() + std::ptrdiff_t(command.first));
    ++state_.changes;
    state_.due = true;
    context_.recorder.record(command);
}

void WindSystem::destroyZone(FwWindZoneId id) {
    const WindZone before = state_.zones.get(id);
    state_.zones.destroy(id);
    sortZones();
    updateObjectsIn(before);
}

void WindSystem::set(const float wind[3]) {
    context_.recorder.mayChange();
    components::checkLengths(wind, 3, "wind", -fire::kMaxWind, fire::kMaxWind);
    if (!std::equal(state_.wind, state_.wind + 3, wind)) ++state_.changes;
    components::windChanges(state_.gusts, fire::windUnits(state_.wind), context_.clock.tick);
    std::copy_n(wind, 3, state_.wind);
    updateObjects();
    context_.recorder.record(SetWind{{wind[0], wind[1], wind[2]}});
}

void WindSystem::addObject(const Object& object) noexcept { state_.kept |= object.zoneWind != 0; }

void WindSystem::capture(WindSnapshot& to) const {
    static_cast<WindFields&>(to) = state_;
    captureSlots(state_.zones, to.zones);
}

void WindSystem::restore(WindSnapshot& from) noexcept {
    std::copy_n(from.wind, 3, state_.wind);
    state_.grid.shape = from.grid.shape;
    state_.grid.points.swap(from.grid.points);
    state_.gusts = from.gusts;
    for (const auto& zone : from.zones) *state_.zones.at(zone.slot) = zone;
    sortZones();
    state_.kept = true;  // objects find theirs, one by one
    updateObjects();
    state_.gustsShown = from.gustsShown;
    ++state_.changes;
}

void WindSystem::shiftOrigin(const double (&by)[3]) noexcept {
    for (WindZone& zone : state_.ordered) moveBy(zone.middle, by);
    components::moveGusts(state_.gusts, by);
}

}  // namespace fw::world
