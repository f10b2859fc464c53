// The one place that answers which wind blows where: the world's, and the zones that the host put
// around some of it. Zones count in integers, so that all machines agree; what takes a float gets
// the world's own wind as it was given, and what zones add to it.
#include "components/wind_zone.h"

#include "shared/wind.h"
#include "world/world.h"

#include <algorithm>

namespace fw::world {

using components::WindPlace;
using components::WindZone;
using fire::WindVector;

fire::WindVector World::windAt(const WindPlace& place) const noexcept {
    return components::windIn(windZones_, fire::windUnits(wind_), place);
}

std::array<float, 3> World::windAt(const float place[3]) const noexcept {
    std::array<float, 3> wind{wind_[0], wind_[1], wind_[2]};
    if (windZones_.empty()) return wind;
    const WindVector around = fire::windUnits(wind_), here = windAt(components::windPlace(place));
    for (size_t i = 0; i < 3; ++i) wind[i] += float(here[i] - around[i]) * fire::kWindUnit;
    return wind;
}

void World::windAtPoint(const float point[3], float wind[3]) const {
    components::checkValues(point, 3, "point", -1e6f, 1e6f);
    const std::array<float, 3> here = windAt(point);
    std::copy_n(here.data(), 3, wind);
}

// The middle of its box, at rest.
WindPlace World::windPlaceOf(const components::Pose& pose,
                             const mesh::BurnDomain& domain) noexcept {
    float middle[3], place[3];
    for (int i = 0; i < 3; ++i) middle[i] = 0.5f * (domain.boundsLow[i] + domain.boundsHigh[i]);
    components::toWorld(pose, middle, place);
    return components::windPlace(place);
}

components::DriveInput World::driveInput(const Object& object) const noexcept {
    components::DriveInput drive;
    drive.wind = windZones_.empty() ? fire::windUnits(wind_)
                                    : windAt(windPlaceOf(object.data.pose, domainOf(object)));
    std::copy_n(def_.up, 3, drive.up);
    drive.pace = def_.paceFactor;
    return drive;
}

// What zones add where an object is, as its records hold it.
uint32_t World::zoneWindOf(const Object& object) const noexcept {
    if (windZones_.empty()) return 0;
    const WindVector around = fire::windUnits(wind_);
    WindVector here = windAt(windPlaceOf(object.data.pose, domainOf(object)));
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
    windTurns();
}

// Whoever keeps a wind gets the one that blows now.
void World::windTurns() noexcept {
    sendFieldRules();
    for (uint32_t slot = 0; slot < objects_.slotCount(); ++slot)
        if (auto* owned = objects_.at(slot)) takeZoneWind(**owned);
}

void World::takeZoneWind(Object& object) noexcept {
    const uint32_t wind = zoneWindOf(object);
    if (wind == object.zoneWind) return;
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
    return id;
}

void World::setWindZone(FwWindZoneId id, const FwWindZoneDef& def) {
    mayChange();
    WindZone& zone = windPool_.get(id);
    const WindZone made = components::makeWindZone(def);
    if (!(zone == made)) {
        zone = made;
        listWindZones();
    }
    noteDef(Deed::Kind::windZone, id.index1 - 1, def);
}

void World::destroyWindZone(FwWindZoneId id) {
    windPool_.destroy(id);
    listWindZones();
}

}  // namespace fw::world
