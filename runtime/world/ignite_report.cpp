// Whether a match lights anything, and if not, why, in words for a host's log.
#include "world/world.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace fw::world {

namespace {

constexpr float kWholeWorld = 4 * 4e6f;  // m: a search of a quarter of it finds every object

// m, between a point and an object's surface: first to its box, which is cheap, then to its texels.
struct Nearest {
    const Object* object = nullptr;
    float metres = 0;

    [[nodiscard]] bool beats(float distance) const noexcept { return object && metres <= distance; }
};

double threeDigits(float metres) noexcept {
    const double step = std::pow(10, std::floor(std::log10(std::max(double(metres), 1e-9))) - 2);
    return std::round(double(metres) / step) * step;
}

float distanceToBox(const float point[3], const mesh::BurnDomain& domain) noexcept {
    float squared = 0;
    for (int i = 0; i < 3; ++i) {
        const float outside =
            std::max({0.0f, domain.boundsLow[i] - point[i], point[i] - domain.boundsHigh[i]});
        squared += outside * outside;
    }
    return std::sqrt(squared);
}

}  // namespace

// Of the events from `first` on, which a match just added: whether one is of a texel that can burn
// and to which no water is on its way.
bool World::lightsSomething(size_t first) const noexcept {
    const auto getsWet = [&](const PendingTexel& match) {
        bool wet = false;
        for (size_t i = 0; i < first && clock_.tick <= wetUntil_; ++i) {
            const PendingTexel& one = pending_[i];
            if (one.object != match.object || one.tick > match.tick ||
                (one.texel != match.texel && one.texel != kAllTexels))
                continue;
            wet = one.kind == FW_WET || (wet && one.kind != FW_DRY);
        }
        return wet;
    };
    constexpr uint32_t kMostAsked = 64;  // of more texels that can burn one is taken to be dry
    uint32_t asked = 0;
    for (size_t i = first; i < pending_.size(); ++i) {
        const PendingTexel& match = pending_[i];
        const Object& object = **objects_.at(match.object);
        if (match.texel == kAllTexels ? object.texels == 0 : !canBurn(object, match.texel))
            continue;
        if (++asked > kMostAsked || !getsWet(match)) return true;
    }
    return false;
}

void World::explainNothingThere(const FwIgnitionDef& def, uint32_t texels,
                                std::span<char> text) noexcept {
    const float* at = def.position;
    char ball[128];
    std::snprintf(ball, sizeof ball,
                  "The ball of " FW_LENGTH " " FW_LENGTH_UNIT " at (" FW_LENGTH ", " FW_LENGTH
                  ", " FW_LENGTH ")",
                  double(def.radius), double(at[0]), double(at[1]), double(at[2]));
    if (texels > 0) {
        std::snprintf(
            text.data(), text.size(),
            "%s lights nothing: none of the %u texels in it can burn. Their material is "
            "noncombustible or too moist, their multiplier is 0, their picture is cut out there, "
            "or "
            "water is on its way to them. Give them a material with a spreadRate above 0, or dry "
            "them (FW_DRY).",
            ball, texels);
        return;
    }
    Nearest nearest;
    const auto meet = [&](const Object& object) {
        float point[3];
        components::toObject(object.data.pose, at, point);
        const components::Pose& pose = object.data.pose;
        const float shortest =
            pose.scale * std::min({std::abs(pose.stretch[0]), pose.stretch[1], pose.stretch[2]});
        if (!object.skinMoved && nearest.beats(distanceToBox(point, domainOf(object)) * shortest))
            return;
        const uint32_t texel = nearestTexel(object, point, 1e18f);
        if (texel == mesh::kNone) return;
        float place[3], squared = 0;
        texelPosition(object, texel, place);
        for (int i = 0; i < 3; ++i) squared += (place[i] - at[i]) * (place[i] - at[i]);
        if (!nearest.beats(std::sqrt(squared))) nearest = {&object, std::sqrt(squared)};
    };
    if (def.object.index1 != 0) meet(**objects_.find(def.object));
    // Searches that grow until one reaches as far as the nearest: a miss costs no look at all
    // objects. An object whose vertices the host moved is in each search.
    const float first = std::max(def.radius, 1.0f);
    for (float reach = first; def.object.index1 == 0 && reach < kWholeWorld; reach *= 4) {
        for (const uint32_t slot : objectsNear(at, reach))
            if (const Object& object = **objects_.at(slot); !object.skinMoved || reach == first)
                meet(object);
        if (nearest.beats(reach)) break;
    }
    if (!nearest.object)
        std::snprintf(text.data(), text.size(),
                      "%s reaches nothing: the world has no burnable mesh.", ball);
    else
        std::snprintf(text.data(), text.size(),
                      "%s reaches nothing: the nearest burnable mesh, %u, is " FW_LENGTH
                      " " FW_LENGTH_UNIT
                      " away. Move the ball there, or give it a radius of that much.",
                      ball, nearest.object->id.index1, threeDigits(nearest.metres));
}

}  // namespace fw::world
