// The lights of a world: burning meshes' as the device clustered them, with ids that stay, and
// those of volumetric fires and emitters, gathered to as many as the host wants. No watt is lost.
#include "components/lights.h"
#include "world/world.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fw::world {

void World::takeLights(const gpu::Readback& readback) noexcept {
    lightsBefore_.swap(lights_);
    lights_.clear();
    uint64_t taken = 0;  // bits of lightsBefore_, at most 64
    for (const gpu::BurnLight& given : readback.lights) {
        if (lights_.size() == std::min<size_t>(def_.maxLights, lights_.capacity())) break;
        FwLight light{};
        for (int i = 0; i < 3; ++i) {
            light.position[i] = given.positionRadius[i];
            light.color[i] = given.colorIntensity[i];
        }
        movePlace(light.position, readback.frameIndex);
        light.radius = given.positionRadius.w;
        light.intensity = given.power * (components::kLightShare / components::kSphere);
        light.power = given.release;
        light.frameIndex = readback.frameIndex;
        // The nearest old light within reach is the same fire.
        size_t best = lightsBefore_.size();
        float bestDistance = 4 * (light.radius + 0.25f) * (light.radius + 0.25f);
        for (size_t i = 0; i < lightsBefore_.size(); ++i) {
            if (taken >> i & 1) continue;
            float distance = 0;
            for (int k = 0; k < 3; ++k) {
                const float d = lightsBefore_[i].position[k] - light.position[k];
                distance += d * d;
            }
            if (distance < bestDistance) {
                bestDistance = distance;
                best = i;
            }
        }
        if (best < lightsBefore_.size()) {
            taken |= uint64_t(1) << best;
            light.id = lightsBefore_[best].id;
        } else {
            light.id = nextLight_++;
            if (nextLight_ == 0) nextLight_ = 1;
        }
        lights_.push_back(light);
    }
    if (lightsDue_) shownLights_.assign(lights_.begin(), lights_.end());
    lightsDue_ = false;
}

// One for each mesh that burns, in its middle.
void World::showSavedLights() noexcept {
    lights_.clear();
    for (const Object* object : touched_) {
        if (object->counters.burning == 0 || lights_.size() == def_.maxLights) continue;
        const mesh::BurnDomain& domain = domainOf(*object);
        float middle[3];
        for (int i = 0; i < 3; ++i) middle[i] = 0.5f * (domain.boundsLow[i] + domain.boundsHigh[i]);
        FwLight light{};
        components::toWorld(object->data.pose, middle, light.position);
        light.color[0] = 1.717f, light.color[1] = 0.858f, light.color[2] = 0.292f;
        light.radius = std::sqrt(burningAreaOf(*object) / 3.14159265f);
        light.power = powerOf(*object);
        light.intensity = light.power * (components::kLightShare / components::kSphere);
        light.id = nextLight_++;
        if (nextLight_ == 0) nextLight_ = 1;
        light.frameIndex = lastFrame_;
        lights_.push_back(light);
    }
    shownLights_.assign(lights_.begin(), lights_.end());  // room for more was found at the start
    lightsDue_ = true;
}

// Once a frame: meshes' lights come with readbacks, a few times a second.
void World::followLights(float seconds) {
    components::followLights(shownLights_, lights_, seconds, def_.maxLights);
    // Who is chosen among more than there is room for stays chosen.
    std::array<FwLight, components::kMostLights> gathered;
    const uint32_t count = lights({gathered.data(), def_.maxLights});
    keptLights_.clear();
    for (uint32_t i = 0; i < count; ++i) keptLights_.push_back(gathered[i].id);
}

uint32_t World::lights(std::span<FwLight> out) {
    lightSources_.clear();
    for (FwLight light : shownLights_) {
        light.intensity *= components::flicker(emitterTime_, components::flickerPhase(light.id));
        lightSources_.push_back(light);
    }
    for (uint32_t i = 0; i < fires_.slotCount(); ++i) {
        const auto* entry = fires_.at(i);
        if (!entry) continue;
        const components::VolumetricFire& fire = (*entry)->data;
        if (fire.state.flames == 0 || (fire.flags & (FW_FIRE_HIDDEN | FW_FIRE_NO_LIGHT))) continue;
        lightSources_.push_back(components::fireLight(fire, 0x80000000u | i, lastFrame_));
    }
    for (uint32_t i = 0; i < emitters_.slotCount(); ++i) {
        const components::FireEmitter* emitter = emitters_.at(i);
        // A mesh that burns shines by itself.
        if (!emitter || emitter->births.filled == 0 || emitter->def.shape == FW_EMITTER_MESH ||
            (emitter->def.flags & (FW_EMITTER_HIDDEN | FW_EMITTER_NO_LIGHT)))
            continue;
        lightSources_.push_back(components::emitterLight(*emitter, emitterAir(*emitter, 0),
                                                         0x40000000u | i, lastFrame_));
    }
    return components::gatherLights(lightSources_, keptLights_, def_.maxLights, out, lightTaken_);
}

}  // namespace fw::world
