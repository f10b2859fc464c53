#include "lod/tiers.h"

#include "core/assert.h"

#include <algorithm>

namespace fw::lod {
namespace {

constexpr float kKeeps = 1.25f;  // a flame that is marched already counts as so many times as large

bool marches(uint32_t tier) noexcept {
    return tier == FW_FIRE_TIER_MARCH_HIGH || tier == FW_FIRE_TIER_MARCH_LOW;
}

// The one that it has, or a place for a new one.
uint32_t placeOf(uint32_t key, TierLives& lives) noexcept {
    const uint32_t had = lifeOf(key, lives);
    if (had < kMaxVolumeFlames) return had;
    const auto at = std::ranges::find(lives, false, &TierLife::used);
    if (at != lives.end()) *at = {.key = key};
    return uint32_t(at - lives.begin());
}

}  // namespace

uint32_t lifeOf(uint32_t key, const TierLives& lives) noexcept {
    const auto at = std::ranges::find_if(
        lives, [key](const TierLife& life) { return life.used && !life.seen && life.key == key; });
    return uint32_t(at - lives.begin());
}

bool wantsAtlas(uint32_t requested, float wide, const TierLife& life) noexcept {
    if (requested == FW_FIRE_TIER_SHARED_IMPOSTOR || life.shows(FW_FIRE_TIER_SHARED_IMPOSTOR))
        return true;
    if (requested != FW_FIRE_TIER_AUTO || wide < kImpostorInside) return false;
    return wide < kAtlasInside || life.tier == FW_FIRE_TIER_IMPOSTOR;
}

void chooseTiers(std::span<const TierItem> items, uint32_t impostors, const MarchLimits& limits,
                 TierLives& lives, std::span<uint32_t> places) noexcept {
    FW_ASSERT(items.size() <= kMaxVolumeFlames && places.size() >= items.size(), "%zu flames",
              items.size());
    // Flames that stay come first: a new one takes no place from them.
    for (const bool stays : {true, false}) {
        for (size_t i = 0; i < items.size(); ++i) {
            if (!stays && places[i] < kMaxVolumeFlames) continue;
            const uint32_t at = placeOf(items[i].key, lives);
            places[i] = kMaxVolumeFlames;
            if (at == kMaxVolumeFlames || lives[at].used != stays) continue;
            places[i] = at;
            lives[at].seen = true;
            if (!stays) lives[at].used = true;
        }
        if (stays)
            for (TierLife& life : lives) life.used = life.used && life.seen;
    }
    for (TierLife& life : lives) life.seen = false;

    std::array<uint32_t, kMaxVolumeFlames> order;
    std::array<float, kMaxVolumeFlames> weight;
    uint32_t count = 0;
    for (uint32_t i = 0; i < items.size(); ++i) {
        if (places[i] == kMaxVolumeFlames) continue;
        const TierLife& life = lives[places[i]];
        weight[i] = items[i].covers * (marches(life.tier) ? kKeeps : 1.0f);
        order[count++] = i;
    }
    std::sort(order.begin(), order.begin() + count, [&](uint32_t a, uint32_t b) {
        return weight[a] != weight[b] ? weight[a] > weight[b] : items[a].key < items[b].key;
    });
    uint32_t rank = 0;  // among those that are too large for an impostor
    for (uint32_t k = 0; k < count; ++k) {
        const TierItem& item = items[order[k]];
        const uint32_t place = places[order[k]];
        TierLife& life = lives[place];
        const float border =
            life.tier == FW_FIRE_TIER_IMPOSTOR ? kImpostorOutside : kImpostorInside;
        uint32_t tier = item.requested;
        uint32_t steps = kHighSteps;
        if (tier == FW_FIRE_TIER_AUTO) {
            const bool hadAtlas = life.tier == FW_FIRE_TIER_SHARED_IMPOSTOR;
            const bool atlas = item.hasAtlas && (item.shared || hadAtlas);
            if (item.wide < border) {
                tier = FW_FIRE_TIER_IMPOSTOR;
            } else if (rank >= limits.all) {
                tier = atlas ? FW_FIRE_TIER_SHARED_IMPOSTOR : FW_FIRE_TIER_IMPOSTOR;
            } else if (atlas && item.wide < (hadAtlas ? kAtlasOutside : kAtlasInside)) {
                tier = FW_FIRE_TIER_SHARED_IMPOSTOR;
            } else {
                tier = rank < limits.high ? FW_FIRE_TIER_MARCH_HIGH : FW_FIRE_TIER_MARCH_LOW;
                ++rank;
            }
        }
        if (tier == FW_FIRE_TIER_SHARED_IMPOSTOR && !item.hasAtlas) tier = FW_FIRE_TIER_IMPOSTOR;
        if (tier == FW_FIRE_TIER_IMPOSTOR && place >= impostors) tier = FW_FIRE_TIER_MARCH_LOW;
        if (tier == FW_FIRE_TIER_MARCH_LOW) steps = kLowSteps;
        if (life.tier == 0) {
            life.tier = life.before = tier;
            life.steps = steps;
            continue;
        }
        if (life.turned < kTierFrames) {
            ++life.turned;
        } else if (marches(tier) && marches(life.tier)) {
            life.tier = tier;  // its samples become more or fewer
        } else if (tier != life.tier) {
            life.before = life.tier;
            life.tier = tier;
            life.turned = 1;
        }
        if (marches(life.tier)) {
            const uint32_t wanted = life.tier == FW_FIRE_TIER_MARCH_LOW ? kLowSteps : kHighSteps;
            life.steps = wanted > life.steps ? std::min(life.steps + kStepsTurn, wanted)
                                             : std::max(life.steps - kStepsTurn, wanted);
        }
    }
}

}  // namespace fw::lod
