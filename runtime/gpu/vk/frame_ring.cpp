#include "gpu/vk/frame_ring.h"

#include "core/error.h"

#include <algorithm>

namespace fw::gpu::vk {

void FrameRing::pace(const FwVulkanFrame& frame, bool outside) {
    using ull = unsigned long long;
    if (!frame.commandBuffer) core::refuse("FwVulkanFrame::commandBuffer is null.");
    const uint32_t known = FW_FRAME_SECONDARY | FW_FRAME_SLOT_PACING;
    if (frame.flags & ~known)
        core::refuse("FwVulkanFrame::flags is 0x%x; 0x%x is known.", frame.flags, known);
    if (frame.frameIndex == 0) core::refuse("FwVulkanFrame::frameIndex is 0; frames count from 1.");
    if (outside && frame.frameIndex <= newestOutside_)
        core::refuse("FwVulkanFrame::frameIndex is %llu; it was %llu already, and grows by one.",
                     ull(frame.frameIndex), ull(newestOutside_));
    if (frame.frameIndex < newest_)
        core::refuse("FwVulkanFrame::frameIndex is %llu; it was %llu already, and never falls.",
                     ull(frame.frameIndex), ull(newest_));
    uint64_t completed = completed_;
    if (frame.flags & FW_FRAME_SLOT_PACING) {
        if (frame.framesInFlight == 0 || frame.framesInFlight > kMaxInFlight)
            core::refuse("FwVulkanFrame::framesInFlight is %u; the range is [1, %u].",
                         frame.framesInFlight, kMaxInFlight);
        if (frame.frameSlot >= frame.framesInFlight)
            core::refuse("FwVulkanFrame::frameSlot is %u of %u in flight.", frame.frameSlot,
                         frame.framesInFlight);
        // The slot is free again: the frame last recorded with it is done, and all before.
        if (hostSlots_[frame.frameSlot] < frame.frameIndex)
            completed = std::max(completed, hostSlots_[frame.frameSlot]);
        hostSlots_[frame.frameSlot] = frame.frameIndex;
    } else {
        if (frame.completedFrameIndex >= frame.frameIndex)
            core::refuse(
                "FwVulkanFrame::completedFrameIndex is %llu; it must be below frameIndex "
                "%llu.",
                ull(frame.completedFrameIndex), ull(frame.frameIndex));
        if (frame.completedFrameIndex < completed_)
            core::refuse(
                "FwVulkanFrame::completedFrameIndex is %llu; it was %llu already, and "
                "never falls.",
                ull(frame.completedFrameIndex), ull(completed_));
        completed = frame.completedFrameIndex;
    }
    completed_ = completed;
    newest_ = frame.frameIndex;
    if (outside) {
        previousOutside_ = newestOutside_;
        newestOutside_ = frame.frameIndex;
    }
}

FrameInFlight& FrameRing::slotFor(uint64_t frameIndex) {
    for (FrameInFlight& slot : slots_) {
        if (slot.frameIndex == frameIndex) return slot;
    }
    // A used slot before a fresh one, so that rings stay as small as the host's; one whose readback
    // nobody has fetched yet only if there is no other.
    const auto cost = [](const FrameInFlight& slot) {
        return slot.readbackPending ? 2 : slot.frameIndex == 0 ? 1 : 0;
    };
    FrameInFlight* best = nullptr;
    for (FrameInFlight& slot : slots_) {
        if (slot.frameIndex > completed_) continue;
        if (!best || cost(slot) < cost(*best)) best = &slot;
    }
    if (!best)
        core::refuse(
            "FwVulkanFrame::frameIndex is %llu with %llu complete; at most %u frames may "
            "be in flight.",
            (unsigned long long)frameIndex, (unsigned long long)completed_, kMaxInFlight);
    best->timers.create(device_);
    best->timers.forget();
    best->frameIndex = frameIndex;
    best->uploadUsed = 0;
    best->views = 0;
    best->hostSetCount = 0;
    best->readbackPending = false;
    return *best;
}

}  // namespace fw::gpu::vk
