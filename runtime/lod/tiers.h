// As what a view shows each volumetric flame: marched with many samples or few, from a book, or as
// a card. It is chosen by size on the screen, and 32 are marched at most; a flame keeps what it has
// until it is well beyond the border, and goes over pixel by pixel.
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
constexpr float kAtlasInside = 24.0f, kAtlasOutside = 31.0f;        // a book's pages are as fine
// Of a cell: detail as fine as this is still sampled. What a pixel averages is many cells, and to
// leave sheets out costs light where to sample them costs none.
constexpr float kFinestDetail = 0.25f;
constexpr uint32_t kHighSteps = 32, kLowSteps = 16, kFewSteps = 12;  // VolumeDraw::mostSteps

struct TierItem {        // a flame that a view shows
    uint32_t key = 0;    // its own, from frame to frame
    uint32_t asked = 0;  // FwFireTier
    float wide = 0;      // px
    float covers = 0;    // of the view, any unit
    // Has a book that it can show at once; others show it too, or it would save nothing.
    bool booked = false, shared = false;
};

struct TierLife {  // of a flame, as long as the view shows it; its place is its card's
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

// Whether a flame would rather show a book than be marched or have a card of its own, by what it is
// now.
bool wantsAtlas(uint32_t asked, float wide, const TierLife& life) noexcept;
// The life that a flame of this key had in the frame before; kMaxVolumeFlames: none.
uint32_t lifeOf(uint32_t key, const TierLives& lives) noexcept;
// One frame on. places[i]: the life of items[i]. `cards`: how many places have one; a flame beyond
// them is marched.
void chooseTiers(std::span<const TierItem> items, uint32_t cards, const MarchLimits& limits,
                 TierLives& lives, std::span<uint32_t> places) noexcept;

}  // namespace fw::lod
