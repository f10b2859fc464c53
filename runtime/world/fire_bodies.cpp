#include "world/fire_bodies.h"

#include "world/geometry.h"
#include "world/wind_system.h"

#include <algorithm>
#include <cmath>

namespace fw::world {
namespace {

using gpu::vec3;

constexpr float kMeanCells = 1.5f;  // whose power raises a flame
constexpr float kMostCells = 8.0f;

// m, of one flame of the body, at the power of a point.
float heightOf(float watts) noexcept {
    return gpu::kBodyAlone * volume::flameHeight(watts * 1e-3f, 0);
}

gpu::FlameRecord lookOf(float side, float height, uint32_t seed) noexcept {
    gpu::FlameRecord r{};
    r.low.w = 2.2f * side;
    r.high.w = height;
    for (int i = 0; i < 3; ++i) r.place[i] = float(core::hash32(seed * 4 + uint32_t(i)) >> 24);
    r.air.w = 1;
    r.speed = 6.84f * std::sqrt(0.58f * height);
    r.tauStart = 0.04f * height, r.tauFree = height;
    r.lambda = 0.28f * height, r.lambdaWarp = 0.6f * height, r.lambdaColumn = 0.5f * height;
    r.stretch = 3, r.turbulence = 1.3f, r.warp = 0.42f, r.columns = 2.6f, r.ridge = 0.5f;
    r.soot = 3.2f / height, r.blue = 0.115f / height;
    r.erode = 0.4f, r.filament = 1, r.filamentWidth = 0.12f, r.filamentBase = 0.12f;
    r.tipFill = 0.45f;
    r.tintHigh = 1740, r.tintLow = 1330;
    r.octaves = 3;
    return r;
}

}  // namespace

uint32_t FireBodies::write(const WorldContext& context, const Scene& scene, const WindSystem& wind,
                           float seconds, std::span<gpu::VolumeFlame> out) noexcept {
    for (uint32_t i = 0; i < count_; ++i) bodies_[i].burns = false;
    uint32_t written = 0;
    const auto room = uint32_t(std::min<size_t>(out.size(), gpu::kMaxBodies));
    for (const Object* object : scene.touched) {
        if (object->counters.burning == 0 || written == room) continue;
        Body* body = std::find_if(bodies_.begin(), bodies_.begin() + count_,
                                  [&](const Body& one) { return same(one.object, object->id); });
        if (body == bodies_.begin() + count_) {
            if (count_ == bodies_.size()) continue;
            *body = {object->id, {}, true};
            ++count_;
        }
        body->burns = true;
        const mesh::BurnDomain& domain = scene.domainOf(*object);
        const components::Pose& pose = object->data.pose;
        const float side = domain.flameCellSide * pose.scale;
        const float perArea =
            std::max(components::powerPerArea(object->data,
                                              scene.meshes.at(object->data.meshSlot)->texelsOf),
                     1e3f);
        const float texel = domain.texelSide * pose.scale;
        const float all = perArea * texel * texel * float(object->counters.burning);
        const float cell = perArea * side * side;
        const float height = std::max(heightOf(kMeanCells * cell), 0.5f * side);
        gpu::VolumeFlame& flame = out[written];
        flame.record = lookOf(side, height, object->id.index1);
        gpu::FlameRecord& record = flame.record;
        // Where its flames may be.
        const float rises =
            gpu::kBodyTop * std::max(heightOf(std::min(all, kMostCells * cell)), 0.3f * side);
        float middle[3];
        middleOf(domain, middle);
        float place[3];
        components::toWorld(pose, middle, place);
        const std::array<float, 3> blows = wind.at(place, context.clock.tick);
        vec3 up(context.def.up[0], context.def.up[1], context.def.up[2]);
        vec3 air(blows[0], blows[1], blows[2]);
        air -= up * glm::dot(air, up);
        vec3 low(1e30f), high(-1e30f);
        for (int k = 0; k < 8; ++k) {
            float corner[3], at[3];
            for (int i = 0; i < 3; ++i)
                corner[i] = (k >> i & 1) != 0 ? domain.boundsHigh[i] : domain.boundsLow[i];
            components::toWorld(pose, corner, at);
            low = glm::min(low, vec3(at[0], at[1], at[2]));
            high = glm::max(high, vec3(at[0], at[1], at[2]));
        }
        const vec3 aside(1.2f * side + 0.15f * rises);
        const float lag = 0.22f * rises / std::sqrt(rises + 0.3f * height);
        const vec3 end = up * rises + air * lag;
        const vec3 from = low - aside, to = high + aside;
        record.low = gpu::vec4(glm::min(from, from + end), record.low.w);
        record.high = gpu::vec4(glm::max(to, to + end), record.high.w);
        record.air = gpu::vec4(air, 1);
        record.glow = gpu::vec4(place[0], place[1], place[2], 0);
        record.key = 0x80000000u | (object->id.index1 << 8 ^ object->id.generation);
        volume::advanceScroll(body->scroll, {}, record, double(seconds));
        for (int o = 0; o < 4; ++o) record.scroll[o] = float(body->scroll.octaves[size_t(o)]);
        record.warpScroll = float(body->scroll.warp);
        record.columnScroll = float(body->scroll.column);
        gpu::FlameBody& shown = records_[written++];
        shown = {};
        shown.low = gpu::vec4(domain.boundsLow[0], domain.boundsLow[1], domain.boundsLow[2],
                              domain.flameCellSide);
        shown.object = object->slot;
        shown.cells = domain.flameCellCount;
    }
    const auto end = std::remove_if(bodies_.begin(), bodies_.begin() + count_,
                                    [](const Body& one) { return !one.burns; });
    count_ = uint32_t(end - bodies_.begin());
    return written;
}

}  // namespace fw::world
