// Readbacks that are due, oldest first, and the last one as the world receives it.
#pragma once
#include "gpu/backend.h"
#include "gpu/vk/frame_ring.h"
#include "gpu/vk/recorder.h"

namespace fw::gpu::vk {

struct BackendState;

struct PendingReadback {  // in the order of frames
    uint64_t ringFrame = 0;
    int32_t slot = -1;         // -1: nothing was simulated, the last figures hold
    int32_t effectsSlot = -1;  // of a frame that recorded effects alone, whose passes took time
    uint64_t frameIndex = 0;
    uint32_t endTick = 0;
};

struct ReadbackResults {
    explicit ReadbackResults(std::pmr::memory_resource* pmr) : memory(pmr) {}
    void push(const PendingReadback& one) noexcept;

    std::pmr::memory_resource* memory;
    std::array<PendingReadback, FrameRing::kMaxInFlight * 4> pending{};
    uint32_t pendingFirst = 0, pendingCount = 0;
    Readback given;
    std::pmr::vector<ObjectCounters> givenObjects{memory};
    std::pmr::vector<ProbeAnswer> givenAnswers{memory};
    std::pmr::vector<ObjectImage> givenMaps{memory};
    std::pmr::vector<BurnLight> givenLights{memory};
    std::pmr::vector<FieldCounters> givenFields{memory};
    std::pmr::vector<RoomAir> givenRooms{memory};  // empty: no step had any yet
    std::pmr::vector<PassTime> times{memory};
    float pictureTime = 0;  // ms of a picture on our own device that no frame has counted
    std::pmr::vector<ObjectAt> imageLayout{memory};  // of the last frame that took images
    uint64_t imagesFrame = 0;                        // ring frame, of that
    std::pmr::vector<ObjectImage> givenImages{memory};
};

// Where the pieces of the frame's readback will lie; `bytes`: all of it. May throw.
[[nodiscard]] ReadbackLayout layoutReadback(BackendState& s, const FramePlan& plan,
                                            uint64_t iterations, bool airs, uint64_t& bytes);
// The end of a frame's recording: copies the pieces of its layout.
void recordReadback(BackendState& s, FrameInFlight& slot);
// Applies the counters that a view wrote.
void applyShown(BackendState& s, const ReadbackLayout& layout, const std::byte* from) noexcept;

}  // namespace fw::gpu::vk
