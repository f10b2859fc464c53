#include "world/light_system.h"

#include "components/lights.h"
#include "host_limits.h"
#include "shared/particle.h"
#include "world/emitter_system.h"
#include "world/flame_system.h"
#include "world/shift.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fw::world {

LightSystem::LightSystem(const WorldContext& context, Scene& scene, const FlameSystem& flames,
                         const EmitterSystem& emitters)
    : context_(context), scene_(scene), flames_(flames), emitters_(emitters) {
    state_.lights.reserve(limits::kLights);
    state_.before.reserve(limits::kLights);
    state_.shown.reserve(2 * limits::kLights);
    kept_.reserve(limits::kLights);
    // Of meshes, of fires, of emitters.
    sources_.reserve(2 * limits::kLights + gpu::kMaxVolumeFlames + gpu::kMaxEmitters);
    taken_.reserve(sources_.capacity());
}

void LightSystem::onReadback(const gpu::Readback& readback) noexcept {
    state_.before.swap(state_.lights);
    state_.lights.clear();
    uint64_t taken = 0;  // bits of state_.before, at most 64
    for (const gpu::BurnLight& given : readback.lights) {
        if (state_.lights.size() ==
            std::min<size_t>(context_.def.maxLights, state_.lights.capacity()))
            break;
        FwLight light{};
        for (int i = 0; i < 3; ++i) {
            light.position[i] = given.positionRadius[i];
            light.color[i] = given.colorIntensity[i];
        }
        context_.origin.movePlace(light.position, readback.frameIndex);
        light.radius = given.positionRadius.w;
        light.intensity = given.power * (components::kLightShare / components::kSphere);
        light.power = given.release;
        light.frameIndex = readback.frameIndex;
        // The nearest old light within reach is the same fire.
        size_t best = state_.before.size();
        float bestDistance = 4 * (light.radius + 0.25f) * (light.radius + 0.25f);
        for (size_t i = 0; i < state_.before.size(); ++i) {
            if (taken >> i & 1) continue;
            float distance = 0;
            for (int k = 0; k < 3; ++k) {
                const float d = state_.before[i].position[k] - light.position[k];
                distance += d * d;
            }
            if (distance < bestDistance) {
                bestDistance = distance;
                best = i;
            }
        }
        if (best < state_.before.size()) {
            taken |= uint64_t(1) << best;
            light.id = state_.before[best].id;
        } else {
            light.id = state_.next++;
            if (state_.next == 0) state_.next = 1;
        }
        state_.lights.push_back(light);
    }
    if (state_.due) state_.shown.assign(state_.lights.begin(), state_.lights.end());
    state_.due = false;
}

// One light for each burning mesh, in its middle.
void LightSystem::showSaved() noexcept {
    state_.lights.clear();
    for (const Object* object : scene_.touched) {
        if (object->counters.burning == 0 || state_.lights.size() == context_.def.maxLights)
            continue;
        const mesh::BurnDomain& domain = scene_.domainOf(*object);
        float middle[3];
        for (int i = 0; i < 3; ++i) middle[i] = 0.5f * (domain.boundsLow[i] + domain.boundsHigh[i]);
        FwLight light{};
        components::toWorld(object->data.pose, middle, light.position);
        light.color[0] = 1.717f, light.color[1] = 0.858f, light.color[2] = 0.292f;
        light.radius = std::sqrt(scene_.burningAreaOf(*object) / 3.14159265f);
        light.power = scene_.powerOf(*object);
        light.intensity = light.power * (components::kLightShare / components::kSphere);
        light.id = state_.next++;
        if (state_.next == 0) state_.next = 1;
        light.frameIndex = context_.lastFrame;
        state_.lights.push_back(light);
    }
    state_.shown.assign(state_.lights.begin(),
                        state_.lights.end());  // capacity was reserved at the start
    state_.due = true;
}

// Once a frame: meshes' lights come with readbacks, a few times a second.
void LightSystem::commit(float seconds) {
    components::followLights(state_.shown, state_.lights, seconds, context_.def.maxLights);
    // Lights that were chosen among more than maxLights stay chosen.
    std::array<FwLight, limits::kLights> gathered;
    const uint32_t count = gather({gathered.data(), context_.def.maxLights});
    kept_.clear();
    for (uint32_t i = 0; i < count; ++i) kept_.push_back(gathered[i].id);
}

uint32_t LightSystem::gather(std::span<FwLight> out) {
    sources_.clear();
    for (FwLight light : state_.shown) {
        light.intensity *=
            components::flicker(emitters_.state().time, components::flickerPhase(light.id));
        sources_.push_back(light);
    }
    for (auto [i, entry] : flames_.state().fires.entries()) {
        const components::VolumetricFire& fire = entry.data;
        if (fire.state.flames == 0 || (fire.flags & (FW_FIRE_HIDDEN | FW_FIRE_NO_LIGHT))) continue;
        sources_.push_back(components::fireLight(fire, 0x80000000u | i, context_.lastFrame));
    }
    for (uint32_t i = 0; i < emitters_.state().emitters.slotCount(); ++i) {
        const components::FireEmitter* emitter = emitters_.state().emitters.at(i);
        // A mesh that burns shines by itself.
        if (!emitter || emitter->births.filled == 0 || emitter->def.shape == FW_EMITTER_MESH ||
            (emitter->def.flags & (FW_EMITTER_HIDDEN | FW_EMITTER_NO_LIGHT)))
            continue;
        sources_.push_back(components::emitterLight(*emitter, emitters_.airOf(*emitter, 0),
                                                    0x40000000u | i, context_.lastFrame));
    }
    return components::gatherLights(sources_, kept_, context_.def.maxLights, out, taken_);
}

void LightSystem::shiftOrigin(const double (&by)[3]) noexcept {
    for (auto* lights : {&state_.lights, &state_.before, &state_.shown})
        for (FwLight& light : *lights) moveBy(light.position, by);
}

}  // namespace fw::world
