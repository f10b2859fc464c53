// The one place that answers which wind blows where: the world's, that of the host's grid in its
// place or beside it, both as gusts have them, and the zones that the host put around some of it.
// All but the first count in integers, so that all machines agree; what takes a float gets the
// world's own wind as it was given, and what the others add to it.
#include "components/wind_grid.h"

#include "shared/wind.h"
#include "world/world.h"

#include <algorithm>

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

WindVector windOf(const Winds& winds, const WindPlace& place, uint64_t tick) noexcept {
    const WindVector on = components::windOnGrid(winds.grid, winds.around, place);
    return components::windIn(
        winds.zones, components::gustOf(winds.gusts, winds.seed, winds.around, on, place, tick),
        place);
}

Winds World::winds() const noexcept {
    return {fire::windUnits(wind_), windGrid_, gusts_, windZones_, def_.seed};
}

// Nothing but the world's own wind blows anywhere.
bool World::evenWind() const noexcept {
    return windZones_.empty() && windGrid_.points.empty() && !gusty();
}

WindVector World::windAt(const WindPlace& place, uint64_t tick) const noexcept {
    return evenWind() ? fire::windUnits(wind_) : windOf(winds(), place, tick);
}

std::array<float, 3> World::windAt(const float place[3], uint64_t tick) const noexcept {
    if (evenWind()) return {wind_[0], wind_[1], wind_[2]};
    return withMore(wind_, windAt(components::windPlace(place), tick));
}

std::array<float, 3> World::steadyWindAt(const float place[3]) const noexcept {
    const components::Gusts none;
    return withMore(wind_, windOf({fire::windUnits(wind_), windGrid_, none, windZones_, 0},
                                  components::windPlace(place), 0));
}

void World::windAtPoint(const float point[3], float wind[3]) const {
    components::checkLengths(point, 3, "point", -1e6f, 1e6f);
    const std::array<float, 3> here = windAt(point, clock_.tick);
    std::copy_n(here.data(), 3, wind);
}

// The middle of its box, at rest.
WindPlace World::windPlaceOf(const components::Pose& pose,
                             const mesh::BurnDomain& domain) noexcept {
    float middle[3];
    double place[3];
    for (int i = 0; i < 3; ++i) middle[i] = 0.5f * (domain.boundsLow[i] + domain.boundsHigh[i]);
    components::toWorld(pose, middle, place);
    return components::windPlace(place);
}

components::DriveInput World::driveInput(const Object& object, uint64_t tick) const noexcept {
    components::DriveInput drive;
    drive.wind = evenWind() ? fire::windUnits(wind_)
                            : windAt(windPlaceOf(object.data.pose, domainOf(object)), tick);
    std::copy_n(def_.up, 3, drive.up);
    drive.pace = def_.paceFactor;
    return drive;
}

// What blows where an object is beside the world's wind, as its records hold it.
uint32_t World::zoneWindOf(const Object& object, uint64_t tick) const noexcept {
    if (evenWind()) return 0;
    const WindVector around = fire::windUnits(wind_);
    WindVector here = windAt(windPlaceOf(object.data.pose, domainOf(object)), tick);
    for (size_t i = 0; i < 3; ++i) here[i] -= around[i];
    return components::packWind(here);
}

// Zones in the order in which they count.
void World::listWindZones() noexcept {
    windZones_.clear();  // room for all was found at their creation
    for (uint32_t i = 0; i < windPool_.slotCount(); ++i)
        if (const WindZone* zone = windPool_.at(i)) windZones_.push_back(*zone);
    components::sortWindZones(windZones_);
    ++driveChanges_;
}

// Objects where a zone was, or is now, get the wind that blows there now.
void World::zoneTurns(const WindZone& zone) noexcept {
    if (windDue_ || gusty()) {  // all do, and at another time
        windTurns();
        return;
    }
    gustsShown_ = clock_.tick;
    sendFieldRules();
    constexpr int64_t kFarthest = 2000000000;
    const int64_t reach = zone.size[0] + zone.size[1] + zone.size[2] + 1;  // whatever its shape
    mesh::Box box;
    for (size_t i = 0; i < 3; ++i) {
        box.low[i] = int(std::clamp(zone.middle[i] - reach, -kFarthest, kFarthest));
        box.high[i] = int(std::clamp(zone.middle[i] + reach, -kFarthest, kFarthest));
    }
    for (const uint32_t slot : objectsNear(box, 0)) takeZoneWind(**objects_.at(slot));
}

// Whoever keeps a wind gets the one that blows now.
void World::windTurns() noexcept {
    windDue_ = false;
    gustsShown_ = clock_.tick;
    sendFieldRules();
    if (evenWind() && !windKept_) return;
    windKept_ = !evenWind();
    for (uint32_t slot = 0; slot < objects_.slotCount(); ++slot)
        if (auto* owned = objects_.at(slot)) takeZoneWind(**owned);
}

void World::takeZoneWind(Object& object) noexcept {
    const uint32_t wind = zoneWindOf(object, clock_.tick);
    // In gusts others hear of it with each exchange; after the last one, once more.
    const bool heard = gusty() || object.remoteVersion == 0 || int(wind) == object.remote.high.w;
    if (wind == object.zoneWind && heard) return;
    windKept_ |= wind != 0;
    object.zoneWind = wind;
    backend_.setObjectWind(object.slot, wind);
    if (object.remoteDue) return;  // at most once each: room was found at its creation
    object.remoteDue = true;
    remote_.due.push_back(object.slot);
}

FwWindZoneId World::createWindZone(const FwWindZoneDef& def) {
    if (windPool_.live() >= components::kMaxWindZones)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "%u wind zones are there; the limit is %u.",
                   windPool_.live(), components::kMaxWindZones);
    const WindZone zone = components::makeWindZone(def);
    windZones_.reserve(windPool_.live() + 1);
    const FwWindZoneId id = windPool_.create(zone);
    listWindZones();
    zoneTurns(zone);
    return id;
}

void World::setWindZone(FwWindZoneId id, const WindZone& made) {
    mayChange();
    WindZone& zone = windPool_.get(id);
    if (!(zone == made)) {
        const WindZone before = std::exchange(zone, made);
        listWindZones();
        zoneTurns(before);
        zoneTurns(made);
    }
    record(SetWindZone{id.index1 - 1, made});
}

// Before a frame: parts of a grid may have come one by one, and gusts go on.
void World::settleWind() noexcept {
    constexpr uint64_t kQuarter = fire::kWindLatchTicks;
    if (windDue_ || (gusty() && clock_.tick / kQuarter != gustsShown_ / kQuarter)) windTurns();
}

void World::setGusts(const FwGustDef& def) {
    const components::Gusts gusts = components::makeGusts(def, gusts_);
    applyGusts({gusts.strength, gusts.size});
}

void World::applyGusts(const SetGusts& command) {
    mayChange();
    components::Gusts gusts = gusts_;
    gusts.strength = command.strength;
    gusts.size = command.size;
    if (!components::plausible(gusts, clock_.tick))
        core::fail(FW_ERROR_BAD_DATA, "A command's gusts are out of their limits.");
    if (!(gusts == gusts_)) ++driveChanges_;
    gusts_ = gusts;
    windTurns();
    record(command);
}

// The grid's shape is recorded with calm on it, then the points that differ.
void World::setWindGrid(const FwWindGridDef& def) {
    mayChange();
    components::WindGrid grid(memory_);
    if (def.structSize != 0) {
        grid.shape = components::makeWindGridShape(def);
        components::readWindPoints(def, grid.points);
    }
    const bool stays = grid.shape == windGrid_.shape;
    if (!stays) record(SetWindGrid{grid.shape});
    for (uint32_t first = 0; first < grid.points.size(); first += SetWindPoints::kPoints) {
        SetWindPoints command{first};
        bool differs = false;
        for (uint32_t k = 0; k < command.kPoints && first + k < grid.points.size(); ++k) {
            command.points[k] = grid.points[first + k];
            differs |= command.points[k] !=
                       (stays ? windGrid_.points[first + k] : components::WindPoint{});
        }
        if (differs) record(command);
    }
    windGrid_.shape = grid.shape;
    windGrid_.points.swap(grid.points);
    ++driveChanges_;
    windTurns();
}

void World::applyWindGrid(const SetWindGrid& command) {
    mayChange();
    std::pmr::vector<components::WindPoint> calm(command.shape.points(), memory_);
    windGrid_.points.swap(calm);
    windGrid_.shape = command.shape;
    ++driveChanges_;
    windDue_ = true;
    record(command);
}

void World::applyWindPoints(const SetWindPoints& command) {
    mayChange();
    const size_t points = windGrid_.points.size();
    if (command.first >= points)
        core::fail(FW_ERROR_BAD_DATA, "A command is of point %u of the wind grid, which has %zu.",
                   command.first, points);
    std::copy_n(command.points.begin(), std::min<size_t>(command.kPoints, points - command.first),
                windGrid_.points.begin() + std::ptrdiff_t(command.first));
    ++driveChanges_;
    windDue_ = true;
    record(command);
}

void World::destroyWindZone(FwWindZoneId id) {
    const WindZone before = windPool_.get(id);
    windPool_.destroy(id);
    listWindZones();
    zoneTurns(before);
}

}  // namespace fw::world
