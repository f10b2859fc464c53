#include "world/light_system.h"

#include "components/lights.h"
#include "host_limits.h"
#include "shared/particle.h"
#include "world/emitter_system.h"
#include "world/flame_system.h"
#include "world/geometry.h"
#include "world/shift.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fw::world {

LightSystem::LightSystem(const WorldContext& context, Scene& scene, const FlameSystem& flames,
                         const EmitterSystem& emitters)
    : context_(context), scene_(scene), flames_(flames), emitters_(emitters) {
    lights_.reserve(limits::kLights);
    before_.reserve(limits::kLights);
    shown_.reserve(2 * limits::kLights);
    kept_.reserve(limits::kLights);
    // Of meshes, of fires, of emitters.
    sources_.reserve(2 * limits::kLights + gpu::kMaxVolumeFlames + gpu::kMaxEmitters);
    taken_.reserve(sources_.capacity());
}

uint32_t LightSystem::nextId() noexcept {
    const uint32_t id = next_++;
    if (next_ == 0) next_ = 1;
    return id;
}

void LightSystem::onReadback(const gpu::Readback& readback) noexcept {
    before_.swap(lights_);
    lights_.clear();
    uint64_t taken = 0;  // bits of before_, at most 64
    for (const gpu::BurnLight& given : readback.lights) {
        if (lights_.size() == std::min<size_t>(context_.def.maxLights, lights_.capacity())) break;
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
        size_t best = before_.size();
        float bestDistance = 4 * (light.radius + 0.25f) * (light.radius + 0.25f);
        for (size_t i = 0; i < before_.size(); ++i) {
            if (taken >> i & 1) continue;
            const float distance = squaredDistance(before_[i].position, light.position);
            if (distance < bestDistance) {
                bestDistance = distance;
                best = i;
            }
        }
        FW_ASSERT(before_.size() <= 64 && lights_.size() < lights_.capacity(), "%zu lights",
                  lights_.size());
        if (best < before_.size()) {
            taken |= uint64_t(1) << best;
            light.id = before_[best].id;
        } else {
            light.id = nextId();
        }
        lights_.push_back(light);
    }
    if (due_) shown_.assign(lights_.begin(), lights_.end());
    due_ = false;
}

// One light for each burning mesh, in its middle.
void LightSystem::showSaved() noexcept {
    lights_.clear();
    for (const Object* object : scene_.touched) {
        if (object->counters.burning == 0 || lights_.size() == context_.def.maxLights) continue;
        const mesh::BurnDomain& domain = scene_.domainOf(*object);
        float middle[3];
        middleOf(domain, middle);
        FwLight light{};
        components::toWorld(object->data.pose, middle, light.position);
        light.color[0] = 1.717f, light.color[1] = 0.858f, light.color[2] = 0.292f;
        light.radius = std::sqrt(scene_.burningAreaOf(*object) / 3.14159265f);
        light.power = scene_.powerOf(*object);
        light.intensity = light.power * (components::kLightShare / components::kSphere);
        light.id = nextId();
        light.frameIndex = context_.lastFrame;
        lights_.push_back(light);
    }
    shown_.assign(lights_.begin(),
                  lights_.end());  // capacity was reserved at the start
    due_ = true;
}

// Once a frame: meshes' lights come with readbacks, a few times a second.
void LightSystem::commit(const HostFrame& frame) {
    components::followLights(shown_, lights_, frame.seconds, context_.def.maxLights);
    // Lights that were chosen among more than maxLights stay chosen.
    std::array<FwLight, limits::kLights> gathered;
    const uint32_t count = gather({gathered.data(), context_.def.maxLights});
    kept_.clear();
    for (uint32_t i = 0; i < count; ++i) kept_.push_back(gathered[i].id);
}

uint32_t LightSystem::gather(std::span<FwLight> out) {
    sources_.clear();
    for (FwLight light : shown_) {
        light.intensity *=
            components::flicker(emitters_.time(), components::flickerPhase(light.id));
        sources_.push_back(light);
    }
    for (auto [i, entry] : flames_.fires().entries()) {
        const components::VolumetricFire& fire = entry.data;
        if (fire.state.flames == 0 || (fire.flags & (FW_FIRE_HIDDEN | FW_FIRE_NO_LIGHT))) continue;
        sources_.push_back(components::fireLight(fire, 0x80000000u | i, context_.lastFrame));
    }
    for (auto [i, emitter] : emitters_.emitters().entries()) {
        // A mesh that burns shines by itself.
        if (emitter.births.filled == 0 || emitter.def.shape == FW_EMITTER_MESH ||
            (emitter.def.flags & (FW_EMITTER_HIDDEN | FW_EMITTER_NO_LIGHT)))
            continue;
        sources_.push_back(components::emitterLight(emitter, emitters_.airOf(emitter, 0),
                                                    0x40000000u | i, context_.lastFrame));
    }
    return components::gatherLights(sources_, kept_, context_.def.maxLights, out, taken_);
}

void LightSystem::shiftOrigin(const double (&by)[3]) noexcept {
    for (auto* lights : {&lights_, &before_, &shown_})
        for (FwLight& light : *lights) moveBy(light.position, by);
}

}  // namespace fw::world
