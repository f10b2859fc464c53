// The budget governor: detail falls while a frame costs more than the host gives, and rises while
// there is room. It predicts before it acts, so that it settles instead of hunting: what a level
// saves is learned as it is left, for as long as the load stays what it was.
#pragma once
#include "gpu/backend.h"
#include "world/context.h"

#include <array>
#include <cstdint>

namespace fw::world {

struct FrameCost {
    float gpu = 0, cpu = 0;  // ms of a frame; a limit of 0: none
    double bytes = 0;        // of device memory that follows detail
};

constexpr uint32_t kDetailLevels = 8;       // 0: all there is
constexpr uint32_t kDetailOverFrames = 4;   // in a row, before detail falls: one hitch is none
constexpr uint32_t kDetailRoomFrames = 10;  // in a row, before it rises
constexpr uint32_t kDetailWait = 20;        // frames until a change shows in what is measured: a
                                      // readback, and the way from one tier of a flame to the next
constexpr float kDetailGuess = 1.25f;  // what a level saves, before anything is learned
constexpr float kDetailRoom = 0.9f;    // of the budget, that a higher level is thought to keep to

[[nodiscard]] gpu::Detail detailOf(uint32_t level) noexcept;

struct Governor {
    uint32_t level = 0;
    FrameCost cost;               // ms, smooth
    uint32_t over = 0, room = 0;  // frames in a row
    uint32_t wait = 0;            // frames until what is measured is of `level`
    uint32_t seen = 0;            // frames of this level, up to kDetailOverFrames
    float overSum = 0;            // of the shares of frames in `over`
    uint32_t levelBefore = 0;     // the change whose outcome is not in yet; `level`: none
    float shareBefore = 0;        // of the budget, before it
    float learnedAt = 0;          // of the budget, as something was last learned or forgotten
    float guess = kDetailGuess;   // what a level saves of which nothing is known: as the last one
    std::array<float, kDetailLevels> saves{};  // cost above a level / at the level; 0: not known
};

// One frame of which `spent` was measured. Without a limit all detail comes back.
void govern(const FrameCost& limit, const FrameCost& spent, Governor& governor) noexcept;

// The host's budget, and what a world's frames cost of it.
class BudgetSystem {
 public:
    explicit BudgetSystem(const WorldContext& context) : context_(context) {}

    void set(const FwBudgetDef& def);
    void fillState(FwBudgetState& state) const noexcept;
    // ms that the host's thread was in a call of the frame that is about to be, or is.
    void spend(float milliseconds) noexcept { spent_.cpu += milliseconds; }

    void plan(gpu::FramePlan& plan) noexcept;
    void onReadback(const gpu::Readback& readback) noexcept {
        if (readback.milliseconds >= 0 && !measured_) spent_.gpu = readback.milliseconds;
    }

 private:
    const WorldContext& context_;
    FrameCost budget_, spent_;  // gpu: as of the last readback
    Governor governor_;
    bool measured_ = false;  // the host reports spent_.gpu
};

}  // namespace fw::world
