// Volumetric fires ignite burnable meshes that are within the flame for as long as their material
// takes to catch. That depends on the host's numbers alone, not on the flames that are drawn: it is
// the same on every backend.
#include "fire/heat.h"
#include "shared/exchange.h"
#include "world/burn_system.h"
#include "world/flame_system.h"
#include "world/geometry.h"
#include "world/wind_system.h"

#include <algorithm>
#include <cmath>

namespace fw::world {
namespace {

using components::VolumetricFire;

constexpr double kFlux = 35000;        // W/m^2 that a flame gives to what it covers
constexpr uint64_t kAgain = 3 * 4096;  // ticks until what it covers is lit once more
constexpr uint32_t kAxisBalls = 4;     // along a flame
constexpr float kMinReach = 0.02f;     // m, of a ball

struct Ball {
    float place[3], radius;
};

// Sums, products and roots of single numbers: every machine rounds them alike.
uint32_t ballsOf(const VolumetricFire& fire, const float up[3], const float wind[3],
                 std::array<Ball, volume::kMaxControlPoints>& out) noexcept {
    if (fire.pointCount > 0) {
        for (uint32_t i = 0; i < fire.pointCount; ++i) {
            const volume::ControlPoint& p = fire.points[i];
            out[i] = {{p.position.x, p.position.y, p.position.z}, std::max(p.radius, kMinReach)};
        }
        return fire.pointCount;
    }
    const uint32_t scale = gpu::power04(uint32_t(fire.power * 1000.0f));  // of its W, Q8
    const float height =
        float(gpu::flameHeight(scale, uint32_t(fire.diameter * 1000.0f))) / 1000.0f;
    // 1.93 m/s of gas at 1 kW, whose W^0.4 is 15.85.
    const float rise = 1.93f * std::sqrt(float(scale) / (256.0f * 15.85f));
    float along[3], length = 0;
    for (int i = 0; i < 3; ++i) {
        along[i] = up[i] * std::max(rise, 0.05f) + wind[i] * fire.windResponse;
        length += along[i] * along[i];
    }
    length = std::max(std::sqrt(length), 1e-3f);
    const float radius = std::max({0.5f * fire.diameter, 0.125f * height, kMinReach});
    for (uint32_t k = 0; k < kAxisBalls; ++k) {
        const float at = height * (float(k) + 0.5f) / float(kAxisBalls);
        for (int i = 0; i < 3; ++i) out[k].place[i] = fire.position[i] + along[i] / length * at;
        out[k].radius = radius;
    }
    return kAxisBalls;
}

}  // namespace

uint64_t BurnSystem::ticksToCatch(const Object& object, uint32_t material,
                                  double flux) const noexcept {
    const FwMaterialDef& m = object.data.materials[material];
    const double rise = std::max(double(m.ignitionTemperature - fire::kAmbient), 1.0) / flux;
    const double store = double(m.density) * double(m.specificHeat);
    const double thick = 0.785398 * double(m.conductivity) * store * rise * rise;
    const double thin = store * double(m.thickness) * rise;
    double seconds = m.thickness > 0 ? std::min(thick, thin) : thick;
    seconds *=
        (1.0 + 2.0 * double(m.moisture + object.data.moisture)) / double(context_.def.paceFactor);
    return uint64_t(std::clamp(seconds, 0.0, 3600.0) * double(gpu::kTicksPerSecond));
}

void FlameSystem::forgetObject(const Object& object) noexcept {
    for (auto [i, fire] : fires_.entries()) forgetIn(fire.touches, object.id);
}

void FlameSystem::igniteObjects(uint32_t now) {
    for (auto [i, fire] : fires_.entries())
        if (fire.data.flags & FW_FIRE_IGNITES) {
            beginTouches(fire.touches);
            if (fire.data.power > 0) igniteObjects(fire, now);
            endTouches(fire.touches);
        }
}

void FlameSystem::igniteObjects(Fire& fire, uint32_t now) {
    std::array<Ball, volume::kMaxControlPoints> balls;
    const uint32_t count =
        ballsOf(fire.data, context_.def.up, wind_.at(fire.data.position, now).data(), balls);
    float span = 0;  // from the first ball's middle, around all of them
    for (uint32_t k = 0; k < count; ++k) {
        const float away = std::sqrt(squaredDistance(balls[k].place, balls[0].place));
        span = std::max(span, 1.001f * away + balls[k].radius);
    }
    for (const uint32_t slot : scene_.objectsNear(balls[0].place, span)) {
        Object& object = scene_.objectAt(slot);
        if (object.texels == 0) continue;
        const components::Pose& pose = object.data.pose;
        const float shrink = shortestAxis(pose);
        uint32_t texel = mesh::kNone;
        float radius = 0;
        for (uint32_t k = 0; k < count && texel == mesh::kNone; ++k) {
            float point[3];
            components::toObject(pose, balls[k].place, point);
            radius = balls[k].radius;
            texel = scene_.nearTexel(object, point, radius / shrink);
        }
        if (texel == mesh::kNone) continue;
        const uint32_t material = scene_.texelMaterial(object, texel);
        if (!components::burns(object.data, material)) continue;
        FireTouch* touch = touchOf(fire.touches, object.id);
        if (!touch) continue;  // its flame is among more than it can mind
        touch->seen = true;
        const float far = 0.25f * radius * radius;
        float stands[3];
        for (int i = 0; i < 3; ++i) stands[i] = float(pose.translation[i]);
        if (touch->object.index1 == 0 || squaredDistance(touch->fireAt, balls[0].place) > far ||
            squaredDistance(touch->objectAt, stands) > far) {
            touch->object = object.id;
            touch->since = now;
            touch->lit = false;
            std::copy_n(balls[0].place, 3, touch->fireAt);
            std::copy_n(stands, 3, touch->objectAt);
        }
        uint64_t wait = burn_.ticksToCatch(object, material, kFlux);
        if (touch->lit) wait = std::max(wait, kAgain);
        if (now - touch->since < wait) continue;
        FwIgnitionDef def{};
        def.kind = FW_IGNITE;
        for (uint32_t k = 0; k < count; ++k) {
            std::copy_n(balls[k].place, 3, def.position);
            def.radius = balls[k].radius;
            (void)burn_.igniteObject(object, def, now);
        }
        touch->lit = true;
        touch->since = now;
    }
}

}  // namespace fw::world
