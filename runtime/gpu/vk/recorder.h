// The open frame's command buffer: dispatches, copies and draws by resource and pass, with their
// barriers, timers and labels. Knows no order: that is frame.cpp's.
#pragma once
#include "core/assert.h"
#include "gpu/passes/draw.h"
#include "gpu/vk/barriers.h"
#include "gpu/vk/descriptors.h"
#include "gpu/vk/frame_ring.h"

#include <cstring>

namespace fw::gpu::vk {

struct BackendState;

constexpr uint32_t kMaxGroups = 65535;  // of a dispatch at the floor; shaders stride over the rest
// Groups of 64 that hold so many.
constexpr uint32_t groupsOf(uint32_t items) noexcept { return (items + 63) / 64; }

// Volumetric flames: all, with the groups of the probe; or those with and without smoke, with the
// groups that the probe listed. Bodies of fire: with a thread for each flame, or for each tile, or
// with the groups that were listed.
enum class VolumesOf : uint8_t { all, clear, smoke, bodyFlames, bodyTiles, bodies };

// Groups of three words in a row of the counters.
enum class RowPart : uint64_t {
    work = offsetof(IterationCounters, workX),
    rim = offsetof(IterationCounters, rimX),
    run = offsetof(IterationCounters, runX),
    list = offsetof(IterationCounters, listX),
};

struct Staged {  // in the frame's upload buffer
    uint64_t at = 0, bytes = 0;
    uint32_t count = 0;
};

constexpr uint64_t kUploadAlignment = 16;  // bytes
constexpr uint64_t uploaded(uint64_t bytes) noexcept { return alignUp(bytes, kUploadAlignment); }

class FrameRecorder {
 public:
    // Passes use the resources of view `view`, and the parameters at `viewOffset` (pushView).
    FrameRecorder(BackendState& state, FrameInFlight& slot, uint32_t view = 0,
                  uint32_t viewOffset = 0)
        : s_(state), slot_(slot), view_(view), viewOffset_(viewOffset) {}

    // At most kMaxGroups in a row.
    template <class Push>
    void dispatch(ComputePassOf<Push> pass, const Push& push, uint32_t groups, uint32_t rows = 1) {
        dispatchGroups(pass.number, &push, groups, rows);
    }
    // A group for each 64 items, at least one.
    template <class Push>
    void dispatchItems(ComputePassOf<Push> pass, const Push& push, uint32_t items) {
        dispatchGroups(pass.number, &push, std::max(groupsOf(items), 1u), 1);
    }
    // Groups from a part of a row of the counters.
    template <class Push>
    void dispatchRow(ComputePassOf<Push> pass, const Push& push, uint32_t row, RowPart part) {
        dispatchAt(pass.number, &push, FW_BIND_COUNTERS,
                   row * sizeof(IterationCounters) + uint64_t(part));
    }
    // Groups from three words of a resource, at `at` bytes.
    template <class Push>
    void dispatchIndirect(ComputePassOf<Push> pass, const Push& push, uint32_t resource,
                          uint64_t at) {
        dispatchAt(pass.number, &push, resource, at);
    }
    // All flames without barriers between them: none reads what another writes.
    void dispatchVolumes(ComputePassOf<MarchPush> pass, std::span<const MarchedVolume> volumes,
                         VolumesOf which);

    // Linear writes into the frame's upload buffer. Piece by piece: beginStaged, append any number
    // of times, endStaged.
    [[nodiscard]] Staged beginStaged() const noexcept { return {slot_.uploadUsed}; }
    template <class T>
    void append(Staged& staged, std::span<const T> data) noexcept {
        FW_ASSERT(slot_.uploadUsed + data.size_bytes() <= slot_.upload.size,
                  "%zu bytes behind %llu; the frame's needs are counted before", data.size_bytes(),
                  (unsigned long long)slot_.uploadUsed);
        if (!data.empty())
            std::memcpy(slot_.upload.mapped + slot_.uploadUsed, data.data(), data.size_bytes());
        slot_.uploadUsed += data.size_bytes();
        staged.bytes += data.size_bytes();
        staged.count += uint32_t(data.size());
    }
    template <class T>
    void appendOne(Staged& staged, const T& one) noexcept {
        append(staged, std::span<const T>(&one, 1));
    }
    void endStaged() noexcept { slot_.uploadUsed = uploaded(slot_.uploadUsed); }
    template <class T>
    Staged stage(std::span<const T> data) noexcept {
        Staged staged = beginStaged();
        append(staged, data);
        endStaged();
        return staged;
    }

    void copyIn(const Staged& staged, uint32_t resource, uint64_t at = 0);
    // Staged elements to byte `at` of a resource.
    template <class T>
    void upload(uint32_t resource, uint64_t at, std::span<const T> data) {
        if (!data.empty()) copyIn(stage(data), resource, at);
    }
    template <class T>
    void uploadOne(uint32_t resource, uint64_t at, const T& one) {
        upload(resource, at, std::span<const T>(&one, 1));
    }
    struct Place {  // byte `at` of a resource
        uint32_t resource = 0;
        uint64_t at = 0;
    };
    void copyBetween(const Place& from, const Place& to, uint64_t bytes);
    void copyOut(uint32_t resource, uint64_t from, uint64_t readbackAt, uint64_t bytes);
    void fillZero(uint32_t resource, uint64_t at, uint64_t bytes);

 private:
    void barrier(std::span<const Use> uses);
    void copy(std::span<const Use> uses, VkBuffer from, VkBuffer to, const VkBufferCopy& region);
    [[nodiscard]] VkBuffer buffer(uint32_t resource) const;
    // Barrier, timer, pipeline. `arguments`: the resource that a dispatch takes its groups from, or
    // kNoResource.
    static constexpr uint32_t kNoResource = ~0u;
    const PassObjects& begin(uint32_t pass, uint32_t arguments);
    void bind(uint32_t pass, const void* push, uint32_t arguments);
    void end();
    void dispatchGroups(uint32_t pass, const void* push, uint32_t groups, uint32_t rows);
    void dispatchAt(uint32_t pass, const void* push, uint32_t resource, uint64_t at);

    BackendState& s_;
    FrameInFlight& slot_;
    uint32_t view_, viewOffset_;
};

}  // namespace fw::gpu::vk
