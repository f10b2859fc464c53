// The tier in which a view shows each volumetric flame: marched with many samples or few, as a
// shared impostor of an atlas, or as an impostor of its own. Size on the screen decides, and at
// most 32 are marched. A flame keeps its tier until it is well beyond the border, then fades pixel
// by pixel.
#pragma once
#include "flamewright/flamewright.h"
#include "shared/volume_draw.h"

#include <array>
#include <cstdint>
#include <span>

namespace fw::lod {

using namespace gpu;  // what shaders share

constexpr uint32_t kTierFrames = 16;  // of the way from one tier to the next
constexpr uint32_t kStepsTurn = 2;    // a frame, from many samples to few
constexpr uint32_t kMarchedHigh = 16, kMarchedFlames = 32;
constexpr float kImpostorInside = 10.0f, kImpostorOutside = 13.0f;  // px across: below, above
constexpr float kAtlasInside = 24.0f, kAtlasOutside = 31.0f;        // an atlas's frames are as fine
// Of a march pixel: detail as fine as this is still sampled. A pixel averages many of them, and
// flame sheets that are not sampled cost light.
constexpr float kFinestDetail = 0.25f;
constexpr uint32_t kHighSteps = 32, kLowSteps = 16, kFewSteps = 12;  // VolumeDraw::mostSteps

struct TierItem {            // a flame that a view shows
    uint32_t key = 0;        // its own, from frame to frame
    uint32_t requested = 0;  // FwFireTier
    float wide = 0;          // px
    float covers = 0;        // of the view, any unit
    // Has an atlas that it can show at once; others show it too, or it would save nothing.
    bool hasAtlas = false, shared = false;
};

struct TierLife {  // of a flame, as long as the view shows it; its place is its impostor's
    uint32_t key = 0;
    bool used = false;
    bool seen = false;              // while a frame's lives are chosen: a flame of it has this one
    uint32_t tier = 0, before = 0;  // FwFireTier
    uint32_t turned = kTierFrames;  // frames since it was `before`
    uint32_t steps = kHighSteps;
    // In [0, 1): pixels' thresholds from which on, and up to which, they show the tier.
    [[nodiscard]] float part() const noexcept { return float(turned) / float(kTierFrames); }
    [[nodiscard]] bool shows(uint32_t as) const noexcept {
        return tier == as || (turned < kTierFrames && before == as);
    }
    [[nodiscard]] bool marchedNow() const noexcept {
        return tier == FW_FIRE_TIER_MARCH_HIGH || tier == FW_FIRE_TIER_MARCH_LOW;
    }
    [[nodiscard]] bool marched() const noexcept {
        return shows(FW_FIRE_TIER_MARCH_HIGH) || shows(FW_FIRE_TIER_MARCH_LOW);
    }
};
using TierLives = std::array<TierLife, kMaxVolumeFlames>;

struct MarchLimits {  // flames of FW_FIRE_TIER_AUTO
    uint32_t high = kMarchedHigh, all = kMarchedFlames;
};

// Whether a flame prefers an atlas to a march or an impostor of its own.
bool wantsAtlas(uint32_t requested, float wide, const TierLife& life) noexcept;
// The life that a flame of this key had in the frame before; kMaxVolumeFlames: none.
uint32_t lifeOf(uint32_t key, const TierLives& lives) noexcept;
// Advances all lives by a frame. places[i]: the life of items[i]. `impostors`: the number of lives
// that have an impostor; a flame beyond them is marched.
void chooseTiers(std::span<const TierItem> items, uint32_t impostors, const MarchLimits& limits,
                 TierLives& lives, std::span<uint32_t> places) noexcept;

}  // namespace fw::lod
