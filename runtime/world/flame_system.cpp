#include "world/flame_system.h"

#include "world/burn_system.h"
#include "world/exchange_system.h"
#include "world/recording.h"
#include "world/shift.h"
#include "world/wind_system.h"

#include <algorithm>

namespace fw::world {
namespace {

using components::VolumetricFire;

void moveState(components::FireState& state, const double (&by)[3]) noexcept {
    for (gpu::vec3* place :
         {&state.bounds.low, &state.bounds.high, &state.tip, &state.light, &state.contact})
        moveBy(*place, by);
}

}  // namespace

FlameSystem::FlameSystem(const WorldContext& context, Scene& scene, const WindSystem& wind,
                         const ExchangeSystem& exchange, BurnSystem& burn)
    : context_(context), scene_(scene), wind_(wind), exchange_(exchange), burn_(burn) {
    if (context_.backend.draws()) reserve(0);
}

void FlameSystem::reserve(uint32_t more) {
    size_t flames = more;
    for (auto [i, fire] : fires_.entries()) flames += fire.data.partCount;
    const size_t room = burning_.reserveFlames(flames);
    const size_t bodies = context_.backend.draws() ? gpu::kMaxBodies : 0;
    const size_t records = std::min<size_t>(room + bodies, gpu::kMaxVolumeFlames);
    if (flames_.size() < records) flames_.resize(records);
    shapes_.reserve(kMaxShapes);
}

// Its state before its first frame: a host lights its scene with it in that frame, too.
void FlameSystem::predictAhead(VolumetricFire& fire) noexcept {
    if (fire.state.lit) return;
    components::FireAir air;
    std::copy_n(context_.def.up, 3, air.up);
    fire.state = burning_.predictAhead(fire, air);
}

// The layer of its profile, with its texels on this side.
uint32_t FlameSystem::profileLayer(const FwVolumetricFireDef& def) {
    if (def.profile.index1 != 0) return profileIds_.get(def.profile).layer;
    if (def.preset >= FW_FIRE_PRESET_COUNT) return 0;  // refused further on
    if (profiles_.size() <= def.preset) profiles_.resize(gpu::kFirePresets);
    if (!profiles_[def.preset]) {
        auto profile = core::Owned<volume::Profile>::make(context_.memory);
        volume::paintDefaultProfile(volume::presetDef(volume::FlamePreset(def.preset)).appearance,
                                    *profile);
        profiles_[def.preset] = std::move(profile);
    }
    return def.preset;
}

FwVolumetricFireId FlameSystem::create(const FwVolumetricFireDef& def) {
    checkRoom(fires_, gpu::kMaxVolumeFlames, "volumetric fires");
    const uint32_t ownSeed = context_.def.seed * 0x9E3779B9u + made_ + 1;
    auto fire = core::Owned<Fire>::make(context_.memory, context_.memory);
    const uint32_t layer = profileLayer(def);
    components::makeVolumetricFire(def, ownSeed, fire->data);
    fire->data.profile = layer;
    predictAhead(fire->data);
    reserve(fire->data.partCount);
    const FwVolumetricFireId id = fires_.create(std::move(fire));
    if (def.profile.index1 != 0) ++profileIds_.get(def.profile).users;
    ++made_;
    return id;
}

void FlameSystem::destroy(FwVolumetricFireId id) {
    const VolumetricFire& fire = fires_.get(id)->data;
    if (fire.ownProfile.index1 != 0) --profileIds_.get(fire.ownProfile).users;
    burning_.drop(fire);
    fires_.destroy(id);
}

void FlameSystem::move(FwVolumetricFireId id, const float position[3]) {
    VolumetricFire& fire = fires_.get(id)->data;
    const bool burns = (fire.flags & FW_FIRE_IGNITES) != 0;
    if (burns) context_.recorder.mayChange();
    components::setFirePosition(fire, position);
    predictAhead(fire);
    if (burns)
        context_.recorder.record(MoveFire{id.index1 - 1, {position[0], position[1], position[2]}});
}

void FlameSystem::setPower(FwVolumetricFireId id, float power) {
    VolumetricFire& fire = fires_.get(id)->data;
    const bool burns = (fire.flags & FW_FIRE_IGNITES) != 0;
    if (burns) context_.recorder.mayChange();
    reserve(components::maxParts(power, fire.diameter));
    components::setFirePower(fire, power);
    predictAhead(fire);
    if (burns) context_.recorder.record(SetFirePower{{id.index1 - 1, power}});
}

void FlameSystem::setPoints(FwVolumetricFireId id, const FwFirePoint* points, uint32_t count) {
    VolumetricFire& fire = fires_.get(id)->data;
    reserve(components::maxParts(fire.power, fire.diameter));
    components::setFirePoints(fire, points, count, "points");
    predictAhead(fire);
}

void FlameSystem::setTrack(FwVolumetricFireId id, const FwFireTrackDef* def) {
    VolumetricFire& fire = fires_.get(id)->data;
    reserve(components::maxParts(fire.power, fire.diameter));
    components::setFireTrack(fire, def);
    predictAhead(fire);
}

void FlameSystem::fillState(FwVolumetricFireId id, FwVolumetricFireState& state) {
    components::fillFireState(fires_.get(id)->data, state);
}

// ---- profiles ---------------------------------------------------------------------------------

FwFireProfileId FlameSystem::createProfile(const FwFireProfileDef& def) {
    checkRoom(profileIds_, gpu::kMaxFireProfiles, "fire profiles");
    auto profile = core::Owned<volume::Profile>::make(context_.memory);
    components::readFireProfile(def, context_.memory, *profile);
    const FwFireProfileId id = profileIds_.create();
    const uint32_t layer = gpu::kFirePresets + id.index1 - 1;
    try {
        if (profiles_.size() <= layer) profiles_.resize(layer + 1);
        context_.backend.setFireProfile(id.index1 - 1, profile->texels);
    } catch (...) {
        profileIds_.destroy(id);
        throw;
    }
    profiles_[layer] = std::move(profile);
    profileIds_.get(id).layer = layer;
    return id;
}

void FlameSystem::destroyProfile(FwFireProfileId id) {
    const uint32_t users = profileIds_.get(id).users;
    if (users > 0)
        core::refuse("Fire profile %u (generation %u) is used by %u fire(s); destroy them first.",
                     id.index1, id.generation, users);
    profileIds_.destroy(id);  // the texels stay until another one takes the layer
}

// ---- questions --------------------------------------------------------------------------------

void FlameSystem::ask(const float point[3], FwFireSample& answer) {
    components::checkLengths(point, 3, "point", -1e6f, 1e6f);
    if (!burning_.now().empty()) listShapes();  // as they stand now
    const components::FireAnswer found =
        components::queryFires(burning_.now(), profiles_, walls(), volume::vecOf(point));
    answer.inside = found.air.inside ? 1 : 0;
    answer.temperature = found.air.kelvin;
    answer.heatFlux = found.air.heatFlux;
    for (int i = 0; i < 3; ++i) answer.gas[i] = found.air.gas[i];
    for (auto [i, fire] : fires_.entries())
        if (&fire.data == found.fire) answer.fire = fires_.idOf(i);
}

void FlameSystem::push(const float centre[3], float radius, FwFireForce& push) {
    components::checkLengths(centre, 3, "centre", -1e6f, 1e6f);
    components::checkLength(radius, "radius", 0.0f, 100.0f);
    if (!burning_.now().empty()) listShapes();
    const volume::FlamePush found =
        components::pushOfFires(burning_.now(), profiles_, walls(), volume::vecOf(centre), radius);
    for (int i = 0; i < 3; ++i) push.force[i] = found.force[i];
    push.ignitionPower = found.ignition;
}

// ---- frames -----------------------------------------------------------------------------------

void FlameSystem::plan(const HostFrame& frame, gpu::FramePlan& plan) noexcept {
    uint32_t count = 0;
    if (fires_.live() > 0) {
        listShapes();
        components::FireAir air;
        std::copy_n(context_.def.up, 3, air.up);
        air.colliders = shapes_;
        burning_.begin();
        for (auto [i, fire] : fires_.entries()) {
            const std::array<float, 3> wind = wind_.at(fire.data.position, context_.clock.tick);
            std::copy_n(wind.data(), 3, fire.data.wind);
            burning_.settle(fire.data, air);
        }
        burning_.advance(air, frame.seconds);
        count = burning_.write(flames_);
    }
    uint32_t bodies = 0;
    // Where flipbooks show flames, or nothing does, there are none.
    if (context_.backend.draws() && context_.def.maxFlames > 0 && flameFlipbooks_[0].index1 == 0)
        bodies = bodies_.write(context_, scene_, wind_, frame.seconds,
                               std::span(flames_).subspan(count));
    FW_ASSERT(count + bodies <= flames_.size(), "%u of %zu flames", count, flames_.size());
    for (gpu::VolumeFlame& flame : std::span(flames_).first(count + bodies))
        flame.record.octaves = std::min(flame.record.octaves, context_.def.volumeOctaves);
    update_ = {flames_.data(), count + bodies, bodies_.records(), bodies};
    if (fires_.live() > 0 || shown_ > 0 || bodies > 0) plan.volumes = &update_;
}

void FlameSystem::commit() noexcept {
    shown_ = update_.count;
    if (fires_.live() == 0) return;
    burning_.commit();
    for (auto [i, fire] : fires_.entries()) fire.data.state = fire.data.nextState;
}

// ---- saves ------------------------------------------------------------------------------------

void FlameSystem::capture(SlottedList<FireSnapshot>& to) const {
    captureSlots(fires_, to, [](const Fire& fire, FireSnapshot& made) {
        static_cast<components::FireControls&>(made) = fire.data;
        made.flags = fire.data.flags & FW_FIRE_IGNITES;
        made.touches = fire.touches;
    });
}

void FlameSystem::checkSnapshot(const SlottedList<FireSnapshot>& from) {
    checkSlots(from, fires_, "volumetric fire", "volumetric fires");
    uint32_t flames = 0;
    for (const Slotted<FireSnapshot>& one : from) {
        const VolumetricFire& fire = (*fires_.at(one.slot))->data;
        checkSame((fire.flags & FW_FIRE_IGNITES) == one.flags, "volumetric fire", one.slot);
        flames += components::maxParts(one.power, fire.diameter);
    }
    reserve(flames);
}

void FlameSystem::restore(const SlottedList<FireSnapshot>& from) noexcept {
    for (const Slotted<FireSnapshot>& one : from) {
        Fire& fire = **fires_.at(one.slot);
        if (!(one == fire.data)) {  // as if it had always burnt so
            burning_.drop(fire.data);
            fire.data.state = {};
            fire.data.points = one.points;
            fire.data.pointCount = one.pointCount;
            components::setFirePosition(fire.data, one.position);
            components::setFirePower(fire.data, one.power);
            predictAhead(fire.data);
        }
        fire.touches = one.touches;
    }
}

void FlameSystem::shiftOrigin(const double (&by)[3]) noexcept {
    for (auto [i, owned] : fires_.entries()) {
        moveState(owned.data.state, by);
        moveState(owned.data.nextState, by);
        for (FireTouch& touch : owned.touches) {
            moveBy(touch.fireAt, by);
            moveBy(touch.objectAt, by);
        }
    }
    burning_.carry(gpu::vec3(float(by[0]), float(by[1]), float(by[2])));
    for (auto [i, collider] : colliders_.entries()) moveBy(collider.picture.eye, by);
}

}  // namespace fw::world
