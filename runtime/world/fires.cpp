// Volumetric fires: ids, what the host changes and asks, and the flames that they are in a frame.
// Looks alone; the same on every backend. What they light: fire_touch.cpp.
#include "world/world.h"

#include <algorithm>

namespace fw::world {
namespace {

using components::VolumetricFire;

}  // namespace

// A warmed-up frame finds its room.
void World::findFireRoom(uint32_t more) {
    size_t flames = more;
    for (uint32_t i = 0; i < fires_.slotCount(); ++i)
        if (const auto* fire = fires_.at(i)) flames += (*fire)->data.partCount;
    const size_t room = burning_.findRoom(flames);
    if (fireFlames_.size() < room) fireFlames_.resize(room);
    fireShapes_.reserve(kMaxFireShapes);
}

// What is told of it before its first frame: a host lights its scene with it in that frame, too.
void World::foresee(VolumetricFire& fire) noexcept {
    if (fire.state.lit) return;
    components::FireAir air;
    std::copy_n(def_.up, 3, air.up);
    fire.state = burning_.foresee(fire, air);
}

// The layer of its profile, with its texels on this side.
uint32_t World::profileLayer(const FwVolumetricFireDef& def) {
    if (def.profile.index1 != 0) return fireProfiles_.get(def.profile).layer;
    if (def.preset >= FW_FIRE_PRESET_COUNT) return 0;  // refused further on
    if (profiles_.size() <= def.preset) profiles_.resize(gpu::kFirePresets);
    if (!profiles_[def.preset]) {
        auto profile = core::Owned<volume::Profile>::make(memory_);
        volume::paintLook(volume::presetDef(volume::FlamePreset(def.preset)).look, *profile);
        profiles_[def.preset] = std::move(profile);
    }
    return def.preset;
}

FwVolumetricFireId World::createVolumetricFire(const FwVolumetricFireDef& def) {
    if (fires_.live() >= gpu::kMaxVolumeFlames)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "%u volumetric fires are there; the limit is %u.",
                   fires_.live(), gpu::kMaxVolumeFlames);
    const uint32_t ownSeed = def_.seed * 0x9E3779B9u + firesMade_ + 1;
    auto fire = core::Owned<Fire>::make(memory_, memory_);
    const uint32_t layer = profileLayer(def);
    components::makeVolumetricFire(def, ownSeed, fire->data);
    fire->data.profile = layer;
    foresee(fire->data);
    const FwVolumetricFireId id = fires_.create(std::move(fire));
    try {
        findFireRoom(0);
    } catch (...) {
        fires_.destroy(id);
        throw;
    }
    if (def.profile.index1 != 0) ++fireProfiles_.get(def.profile).users;
    ++firesMade_;
    return id;
}

void World::destroyVolumetricFire(FwVolumetricFireId id) {
    const VolumetricFire& fire = fires_.get(id)->data;
    if (fire.ownProfile.index1 != 0) --fireProfiles_.get(fire.ownProfile).users;
    burning_.drop(fire);
    fires_.destroy(id);
}

void World::moveVolumetricFire(FwVolumetricFireId id, const float position[3]) {
    VolumetricFire& fire = fires_.get(id)->data;
    const bool burns = (fire.flags & FW_FIRE_IGNITES) != 0;
    if (burns) mayChange();
    components::setFirePosition(fire, position);
    foresee(fire);
    if (burns) record(MoveFire{id.index1 - 1, {position[0], position[1], position[2]}});
}

void World::setVolumetricFirePower(FwVolumetricFireId id, float power) {
    VolumetricFire& fire = fires_.get(id)->data;
    const bool burns = (fire.flags & FW_FIRE_IGNITES) != 0;
    if (burns) mayChange();
    findFireRoom(components::mostParts(power, fire.diameter));
    components::setFirePower(fire, power);
    foresee(fire);
    if (burns) record(SetFirePower{id.index1 - 1, power});
}

void World::setVolumetricFirePoints(FwVolumetricFireId id, const FwFirePoint* points,
                                    uint32_t count) {
    VolumetricFire& fire = fires_.get(id)->data;
    findFireRoom(components::mostParts(fire.power, fire.diameter));
    components::setFirePoints(fire, points, count, "points");
    foresee(fire);
}

void World::setVolumetricFireTrack(FwVolumetricFireId id, const FwFireTrackDef* def) {
    VolumetricFire& fire = fires_.get(id)->data;
    findFireRoom(components::mostParts(fire.power, fire.diameter));
    components::setFireTrack(fire, def);
    foresee(fire);
}

void World::setVolumetricFireHidden(FwVolumetricFireId id, bool hidden) {
    uint32_t& flags = fires_.get(id)->data.flags;
    flags = (flags & ~uint32_t(FW_FIRE_HIDDEN)) | (hidden ? uint32_t(FW_FIRE_HIDDEN) : 0u);
}

void World::setVolumetricFireTier(FwVolumetricFireId id, uint32_t tier) {
    VolumetricFire& fire = fires_.get(id)->data;
    components::setFireTier(fire, tier, "tier");
}

void World::volumetricFireState(FwVolumetricFireId id, FwVolumetricFireState& state) {
    components::fillFireState(fires_.get(id)->data, state);
}

// ---- profiles ---------------------------------------------------------------------------------

FwFireProfileId World::createFireProfile(const FwFireProfileDef& def) {
    if (fireProfiles_.live() >= gpu::kMaxFireProfiles)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "%u fire profiles are there; the limit is %u.",
                   fireProfiles_.live(), gpu::kMaxFireProfiles);
    auto profile = core::Owned<volume::Profile>::make(memory_);
    components::readFireProfile(def, memory_, *profile);
    const FwFireProfileId id = fireProfiles_.create();
    const uint32_t layer = gpu::kFirePresets + id.index1 - 1;
    try {
        if (profiles_.size() <= layer) profiles_.resize(layer + 1);
        backend_.setFireProfile(id.index1 - 1, profile->texels);
    } catch (...) {
        fireProfiles_.destroy(id);
        throw;
    }
    profiles_[layer] = std::move(profile);
    fireProfiles_.get(id).layer = layer;
    return id;
}

void World::destroyFireProfile(FwFireProfileId id) {
    const uint32_t users = fireProfiles_.get(id).users;
    if (users > 0)
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "Fire profile %u (generation %u) is used by %u fire(s); destroy them first.",
                   id.index1, id.generation, users);
    fireProfiles_.destroy(id);  // the texels stay until another one takes the layer
}

// ---- questions --------------------------------------------------------------------------------

void World::askVolumetricFires(const float point[3], FwFireAnswer& answer) {
    components::checkLengths(point, 3, "point", -1e6f, 1e6f);
    if (!burning_.now().empty()) listFireColliders();  // as they stand now
    const components::FireAnswer found =
        components::askFires(burning_.now(), profiles_, walls(), volume::vecOf(point));
    answer.inside = found.air.inside ? 1 : 0;
    answer.temperature = found.air.kelvin;
    answer.heatFlux = found.air.heatFlux;
    for (int i = 0; i < 3; ++i) answer.gas[i] = found.air.gas[i];
    for (uint32_t i = 0; found.fire && i < fires_.slotCount(); ++i)
        if (const auto* fire = fires_.at(i); fire && &(*fire)->data == found.fire)
            answer.fire = fires_.idOf(i);
}

void World::volumetricFirePush(const float centre[3], float radius, FwFirePush& push) {
    components::checkLengths(centre, 3, "centre", -1e6f, 1e6f);
    components::checkLength(radius, "radius", 0.0f, 100.0f);
    if (!burning_.now().empty()) listFireColliders();
    const volume::FlamePush found =
        components::pushOfFires(burning_.now(), profiles_, walls(), volume::vecOf(centre), radius);
    for (int i = 0; i < 3; ++i) push.force[i] = found.force[i];
    push.ignitionPower = found.ignition;
}

// ---- frames -----------------------------------------------------------------------------------

void World::planFires(float seconds) noexcept {
    uint32_t count = 0;
    if (fires_.live() > 0) {
        listFireColliders();
        components::FireAir air;
        std::copy_n(def_.up, 3, air.up);
        air.colliders = fireShapes_;
        burning_.begin();
        for (uint32_t i = 0; i < fires_.slotCount(); ++i)
            if (auto* fire = fires_.at(i)) {
                const std::array<float, 3> wind = windAt((*fire)->data.position, clock_.tick);
                std::copy_n(wind.data(), 3, (*fire)->data.wind);
                burning_.settle((*fire)->data, air);
            }
        burning_.advance(air, seconds);
        count = burning_.write(fireFlames_);
        for (uint32_t i = 0; i < count; ++i) {
            uint32_t& octaves = fireFlames_[i].record.octaves;
            octaves = std::min(octaves, def_.volumeOctaves);
        }
    }
    frame_.volumes = {fireFlames_.data(), count};
    frame_.volumesDue = fires_.live() > 0 || flamesShown_ > 0;
}

void World::commitFires() noexcept {
    flamesShown_ = frame_.volumes.count;
    if (fires_.live() == 0) return;
    burning_.commit();
    for (uint32_t i = 0; i < fires_.slotCount(); ++i)
        if (auto* fire = fires_.at(i)) (*fire)->data.state = (*fire)->data.nextState;
}

}  // namespace fw::world
