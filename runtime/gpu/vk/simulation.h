// The simulation's lists on the device, as the frames recorded so far leave them, and the recording
// of a frame's steps and predictions.
#pragma once
#include "gpu/vk/frame.h"

namespace fw::gpu::vk {

struct BackendState;
struct FrameNeeds;

struct SimulationState {
    explicit SimulationState(std::pmr::memory_resource* pmr) : extended(pmr) {}
    // Whose soot is due; count 0: none is. Of `tiles` in all; `looked`: some view may show it.
    TileShare sootShare(uint32_t tiles, uint32_t endTick, bool looked) noexcept;
    void setAllEmpty(bool empty) noexcept {
        frontEmpty = burnEmpty = predictEmpty = hotEmpty = empty;
    }

    FrameLists lists;
    ListWalks walks;
    uint64_t lastStimulus = 0;  // ring frame that last brought the front something new
    uint64_t seenFrame = 0;     // ring frame whose view last showed some object
    // Known from a readback. While a tile is hot, its front may move again.
    bool frontEmpty = true, burnEmpty = true, predictEmpty = true, hotEmpty = true;
    uint32_t supportUntil = 0;             // tick until which burnt pieces may still fall
    uint32_t supportFirst = 0;             // tile that the next `support` begins at
    uint32_t sootFirst = 0, sootTick = 0;  // as supportFirst; tick of the last pass
    uint32_t predictTick = 0;              // of the last round of predictions
    uint32_t shownTick = 0;                // tick of the state that draws show
    uint32_t links = 0, occluders = 0;     // of the last exchange update
    OcclusionUpdate occlusion;             // the last one's place, without its words
    float wind[3] = {};
    float tickFraction = 0;
    std::pmr::vector<ExtendedStep> extended;  // of the frame
    bool tilesMoved = false;  // BurnTiles stand where they were before all places moved
};

void recordSteps(BackendState& s, const FramePlan& plan, const FrameNeeds& needs,
                 FrameRecorder& recorder);
// Whether a frame's predictions are due: with all detail, always.
[[nodiscard]] bool predictsNow(const BackendState& s, const FrameNeeds& needs,
                               uint32_t endTick) noexcept;
// Arrival ahead of the front, of the objects that some view shows.
void recordPredictions(BackendState& s, const FramePlan& plan, FrameRecorder& recorder);
// Burnt pieces that lost their hold.
void recordFalling(BackendState& s, const FramePlan& plan, bool burning, FrameRecorder& recorder);
// Once a dousing is over, its object's predictions begin again with its state.
void recordForgetting(BackendState& s, FrameRecorder& recorder);

// visibility.cpp
// Marks the objects that a view of `height` px shows in ring frame `frame`.
void markVisible(BackendState& s, const FwView& view, float height, uint64_t frame) noexcept;
// Which objects come into view or leave it with the frame: marks those, and what they need.
void addSeenNeeds(BackendState& s, FrameNeeds& needs);
// Whether what a view showed in ring frame `seenFrame` is still predicted in `frame`.
[[nodiscard]] bool shownLately(uint64_t seenFrame, uint64_t frame) noexcept;

}  // namespace fw::gpu::vk
