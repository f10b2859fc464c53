// A frame of a world on its way to commands: what it needs, and linear writes into its upload
// buffer. Internal to vk_record.cpp and the files that help it.
#pragma once
#include "gpu/vk/world_state.h"

#include <cstring>
#include <functional>

namespace fw::gpu::vk {

constexpr uint64_t kUploadAlignment = 16;  // bytes

constexpr uint64_t uploaded(uint64_t bytes) noexcept { return alignUp(bytes, kUploadAlignment); }

// Linear writes into the frame's upload buffer.
class UploadWriter {
 public:
    explicit UploadWriter(FrameInFlight& slot) : slot_(slot) {}
    template <class T>
    Staged write(std::span<const T> data) {
        Staged staged = begin();
        append(staged, data);
        end();
        return staged;
    }
    // Piece by piece: begin, append any number of times, end.
    [[nodiscard]] Staged begin() const { return {slot_.uploadUsed, 0}; }
    template <class T>
    void append(Staged& staged, std::span<const T> data) {
        if (!data.empty())
            std::memcpy(slot_.upload.mapped + slot_.uploadUsed, data.data(), data.size_bytes());
        slot_.uploadUsed += data.size_bytes();
        staged.count += uint32_t(data.size());
    }
    void end() { slot_.uploadUsed = uploaded(slot_.uploadUsed); }

 private:
    FrameInFlight& slot_;
};

// 64 tiles of an object, or kDeformGroup nodes or vertices of a deformer.
struct WakeGroup {
    uint32_t object, firstTile;
};

inline uint32_t appendWakeGroups(const ObjectEntry& object) noexcept {
    return (object.record.tileCount + 63) / 64;
}

inline bool changesState(const StepPlan& step) noexcept {
    return !step.events.empty() || !step.materials.empty();
}

// What a plan asks of its frame: how much room, and which passes have anything to do.
struct FrameNeeds {
    bool dense = false, never = false;    // debug switches: every tile; never idle
    uint64_t uploadBytes = 0;             // at most
    uint64_t iterations = 0;              // of all steps
    uint32_t events = 0, wakeGroups = 0;  // of the largest step
    uint32_t neighbours = 0, links = 0;   // of the largest remote update
    uint32_t occlusionWords = 0;          // of the largest shield
    bool placing = false;                 // there is one
    bool exchanges = false;               // fire may come from other objects
    bool airs = false;                    // rooms have a step
    bool stimulus = false;                // an event or a latch
    bool rebuildsPrediction = false;      // the first step wakes what forgets
    bool burning = false, predicting = false, publishedRuns = false, heating = false;
    bool appears = false;                 // an object comes into view
    bool falling = false;                 // burnt pieces may lose their hold
    DeformGroups deform;                  // what deforms
    bool sheetsBegin = false;             // some sheet did not move in the frame before
    uint32_t fieldRuns = 0;               // steps and new masks
    bool fieldsShow = false;              // or showed until now
    bool skins = false;                   // a host moved vertices
    bool readback = false, work = false;  // no work: nothing is recorded
};

// vk_needs.cpp
// Also marks what objects `forget`, and fills `published`; throws where a limit is exceeded.
[[nodiscard]] FrameNeeds needsOf(VkBackend::State& s, const FramePlan& plan);
// All that may fail: buffers of the size that the frame needs, and sets that name them.
[[nodiscard]] FrameInFlight& makeRoom(VkBackend::State& s, const FramePlan& plan,
                                      const FrameNeeds& needs);

// vk_record.cpp
void recordRegions(const Table& vk, VkBackend::State& s, const PendingUpload& upload);

// vk_seen.cpp
// Which objects come into view or leave it with the frame: marks those, and what they need.
void addSeenNeeds(VkBackend::State& s, FrameNeeds& needs);
// Whether a frame's predictions are due: with all detail, always.
[[nodiscard]] bool predictsNow(const VkBackend::State& s, const FrameNeeds& needs,
                               uint32_t endTick) noexcept;
// Arrival ahead of the front: what no view shows is not predicted.
void recordPredictions(VkBackend::State& s, const FramePlan& plan, FrameRecorder& recorder,
                       UploadWriter& writer);

// vk_restore.cpp
void recordMovedTiles(VkBackend::State& s, FrameRecorder& recorder);
void recordRestores(VkBackend::State& s, FrameRecorder& recorder);
// Where the images of a frame will lie; throws.
void allocateImages(VkBackend::State& s, std::span<const uint32_t> slots, ReadbackLayout& layout,
                    const std::function<uint64_t(uint64_t)>& place);
void recordImages(VkBackend::State& s, FrameRecorder& recorder);
// Of a readback buffer; throws std::bad_alloc.
[[nodiscard]] std::span<const ObjectImage> giveImages(VkBackend::State& s, const std::byte* from);

// vk_deform.cpp
// What object `slot` needs to deform or to be skinned in this frame; marks if it does.
void addDeformNeeds(VkBackend::State& s, uint32_t slot, uint64_t endTick, FrameNeeds& needs);
// Vertices as hosts have moved them.
void recordSkins(VkBackend::State& s, FrameRecorder& recorder, UploadWriter& writer);
// What deforms in this frame, in the order of DeformRecord.
[[nodiscard]] Staged writeDeformGroups(VkBackend::State& s, UploadWriter& writer);

// vk_refine.cpp
// How far the last frame that refined an object has brought what draws show of it.
void showRefined(const RefineUse& use, DrawItem& item) noexcept;

// vk_field.cpp
void addFieldNeeds(const VkBackend::State& s, const FramePlan& plan, FrameNeeds& needs);
void recordFieldSteps(VkBackend::State& s, const FramePlan& plan, FrameRecorder& recorder,
                      UploadWriter& writer);

// vk_volume.cpp
// The flames of the frame, as they are drawn until the next ones come.
void recordVolumes(VkBackend::State& s, const VolumeUpdate& update, FrameRecorder& recorder,
                   UploadWriter& writer);

// vk_emitters.cpp
void recordEmitters(VkBackend::State& s, const EmitterUpdate& update, FrameRecorder& recorder,
                    UploadWriter& writer);

}  // namespace fw::gpu::vk
