// Particle fields on the device: their places in the buffers, and a frame's steps of them.
#pragma once
#include "gpu/passes/draw.h"
#include "gpu/vk/frame.h"
#include "gpu/vk/world_buffers.h"

namespace fw::gpu::vk {

struct BackendState;
struct FrameNeeds;

struct FieldEntry {
    bool live = false;
    bool recordDirty = false, masksDue = false, fresh = false;  // for the next frame
    FieldRules rules{};
    uint32_t steps = 0;  // that it has run
    BufferRange cells;
};

struct FieldRenderer {
    explicit FieldRenderer(std::pmr::memory_resource* pmr) : fields(pmr), fieldDraws(pmr) {}
    void addNeeds(const FramePlan& plan, FrameNeeds& needs) const;
    void record(const FramePlan& plan, FrameRecorder& recorder);
    // The fields that the view that was last pushed shows, farthest first; returns their number.
    uint32_t order(const BackendState& s, std::array<FieldItem, kMaxFields>& out) const noexcept;

    std::pmr::vector<FieldEntry> fields;
    std::pmr::vector<FieldDraw> fieldDraws;  // that draws show, as their buffer has them
    bool fieldsDirty = false;                // one of them has something for the next frame
};

}  // namespace fw::gpu::vk
