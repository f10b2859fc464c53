// Frames in flight: the host's pacing, and the resources that each frame in flight owns (staging,
// readback, queries). Decoupled from the host's slots. Never waits.
#pragma once
#include "core/assert.h"
#include "flamewright/flamewright_vulkan.h"
#include "gpu/passes/pass.h"
#include "gpu/vk/memory.h"
#include "gpu/vk/timers.h"
#include "host_limits.h"

#include <array>
#include <span>

namespace fw::gpu::vk {

struct ObjectAt {  // an object's state in a readback: its texels, and its tiles if there are any
    uint32_t object = 0, texels = 0, tiles = 0;
    uint64_t ticksAt = 0, heatAt = 0, tilesAt = 0, tileHeatAt = 0;  // bytes
    bool heat = false;
};

struct ReadbackLayout {  // where the pieces of a frame's readback lie
    struct Piece {
        uint64_t at = 0, bytes = 0;
    };
    Piece counters, objects, answers, lights, flames, bias, fields, rooms;
    uint32_t firstRow = 0,
             rows = 0;  // counters rows: the first iteration's, and the list's at the end
    uint32_t burnParity = 0, predictParity = 0, hotParity = 0;  // as the frame leaves them
    static constexpr uint32_t kMaxMaps = 64;
    std::array<ObjectAt, kMaxMaps> maps{};
    uint32_t mapCount = 0;
    bool hasBias = false;    // of refinement
    bool hasQuads = false;   // a view's were made
    bool hasImages = false;  // where they are is the world's: one frame's at a time
    [[nodiscard]] std::span<const ObjectAt> burnMaps() const noexcept {
        return std::span(maps).first(mapCount);
    }
};

struct FrameInFlight {
    uint64_t frameIndex = 0;  // 0: never used
    Buffer upload;            // linear, from 0 each frame
    uint64_t uploadUsed = 0;
    Buffer readback;
    bool readbackPending = false;
    ReadbackLayout layout;
    uint32_t views = 0;  // used of its part of the view ring
    FrameTimers timers;
    // Sets for the depth and the colour that hosts give: made together when the first is needed,
    // rewritten for each use in a frame.
    static constexpr uint32_t kHostDraws = 16;
    static constexpr uint32_t kHostSets = 2 * kHostDraws;
    VkDescriptorPool hostPool = VK_NULL_HANDLE;
    std::array<VkDescriptorSet, kHostSets> hostSets{};
    uint32_t hostSetCount = 0;  // used
};

class FrameRing {
 public:
    static constexpr uint32_t kMaxInFlight = limits::kFramesInFlight;
    static constexpr uint32_t kMaxDrawn = limits::kDrawnViews;
    static constexpr uint32_t kMaxViews = kMaxDrawn + gpu::kMaxViews;  // and recorded for

    explicit FrameRing(Device& device) : device_(device) {}

    // Checks the host's pacing, which says which frames are complete. `outside`: RecordOutside,
    // whose index must be new. Throws and then learnt nothing.
    void pace(const FwVulkanFrame& frame, bool outside);
    // The frame's slot: the one it has, or one that the GPU is done with. Throws when the host is
    // more than kMaxInFlight frames ahead.
    FrameInFlight& slotFor(uint64_t frameIndex);
    [[nodiscard]] uint64_t completed() const noexcept { return completed_; }
    [[nodiscard]] uint64_t newest() const noexcept { return newest_; }
    // The outside part of the newest frame came to nothing: its index may come again.
    void undoOutside() noexcept { newestOutside_ = previousOutside_; }
    void completeAll() noexcept { completed_ = newest_; }  // own device, after its wait
    [[nodiscard]] uint32_t indexOf(const FrameInFlight& slot) const noexcept {
        FW_ASSERT(&slot >= slots_.data() && &slot < slots_.data() + slots_.size());
        return uint32_t(&slot - slots_.data());
    }
    std::array<FrameInFlight, kMaxInFlight>& slots() noexcept { return slots_; }

 private:
    Device& device_;
    std::array<FrameInFlight, kMaxInFlight> slots_{};
    std::array<uint64_t, 64> hostSlots_{};  // slot pacing: newest frame of each host slot
    uint64_t completed_ = 0, newest_ = 0, newestOutside_ = 0, previousOutside_ = 0;
};

}  // namespace fw::gpu::vk
