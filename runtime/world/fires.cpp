// Volumetric fires: ids, what the host changes, and the flames that they are in a frame. Looks
// alone; the same on every backend.
#include "world/world.h"

#include <algorithm>

namespace fw::world {

FwVolumetricFireId World::createVolumetricFire(const FwVolumetricFireDef& def) {
    if (fires_.live() >= gpu::kMaxVolumeFlames)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "%u volumetric fires are there; the limit is %u.",
                   fires_.live(), gpu::kMaxVolumeFlames);
    const uint32_t ownSeed = def_.seed * 0x9E3779B9u + ++firesMade_;
    const components::VolumetricFire fire = components::makeVolumetricFire(def, ownSeed);
    // A warmed-up frame finds its room.
    const size_t most =
        std::min<size_t>(size_t(fires_.live() + 1) * volume::kMaxFlamelets, gpu::kMaxVolumeFlames);
    if (fireFlames_.size() < most) fireFlames_.resize(most);
    return fires_.create(fire);
}

void World::destroyVolumetricFire(FwVolumetricFireId id) { fires_.destroy(id); }

void World::moveVolumetricFire(FwVolumetricFireId id, const float position[3]) {
    components::setFirePosition(fires_.get(id), position);
}

void World::setVolumetricFirePower(FwVolumetricFireId id, float power) {
    components::setFirePower(fires_.get(id), power);
}

void World::setVolumetricFirePoints(FwVolumetricFireId id, const FwFirePoint* points,
                                    uint32_t count) {
    components::setFirePoints(fires_.get(id), points, count, "points");
}

void World::setVolumetricFireHidden(FwVolumetricFireId id, bool hidden) {
    uint32_t& flags = fires_.get(id).flags;
    flags = (flags & ~uint32_t(FW_FIRE_HIDDEN)) | (hidden ? uint32_t(FW_FIRE_HIDDEN) : 0u);
}

void World::volumetricFireState(FwVolumetricFireId id, FwVolumetricFireState& state) {
    components::fillFireState(fires_.get(id), state);
}

void World::planFires(float seconds) noexcept {
    components::FireAir air;
    std::copy_n(wind_, 3, air.wind);
    std::copy_n(def_.up, 3, air.up);
    uint32_t count = 0;
    for (uint32_t i = 0; i < fires_.slotCount(); ++i)
        if (components::VolumetricFire* fire = fires_.at(i))
            count +=
                components::advanceFire(*fire, air, seconds, std::span(fireFlames_).subspan(count));
    frame_.volumes = {fireFlames_.data(), count};
    frame_.volumesDue = fires_.live() > 0 || flamesShown_ > 0;
}

void World::commitFires() noexcept {
    for (uint32_t i = 0; i < fires_.slotCount(); ++i)
        if (components::VolumetricFire* fire = fires_.at(i)) components::commitFire(*fire);
    flamesShown_ = frame_.volumes.count;
}

uint32_t World::lights(std::span<FwLight> out) const noexcept {
    size_t count = std::min(out.size(), lights_.size());
    std::copy_n(lights_.begin(), count, out.begin());
    const size_t most = std::min<size_t>(out.size(), def_.maxLights);
    // The strongest of both kinds, strongest first.
    for (uint32_t i = 0; i < fires_.slotCount(); ++i) {
        const components::VolumetricFire* fire = fires_.at(i);
        if (!fire || fire->state.flames == 0 || (fire->flags & (FW_FIRE_HIDDEN | FW_FIRE_NO_LIGHT)))
            continue;
        const auto weaker =
            std::find_if(out.begin(), out.begin() + std::ptrdiff_t(count),
                         [&](const FwLight& l) { return l.intensity < fire->state.intensity; });
        if (weaker == out.begin() + std::ptrdiff_t(most)) continue;
        const size_t kept = std::min(count + 1, most);
        std::move_backward(weaker, out.begin() + std::ptrdiff_t(kept - 1),
                           out.begin() + std::ptrdiff_t(kept));
        *weaker = components::fireLight(*fire, 0x80000000u | i, lastFrame_);
        count = kept;
    }
    return uint32_t(count);
}

}  // namespace fw::world
