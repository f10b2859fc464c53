// The needs of a frame's plan: how much space, and which passes have anything to do. Internal to
// the files that record a frame.
#pragma once
#include "gpu/vk/backend_state.h"

namespace fw::gpu::vk {

// 64 tiles of an object, or kDeformGroup particles or vertices of a deformer.
struct WakeGroup {
    uint32_t object, firstTile;
};

inline uint32_t wakeGroupsOf(const ObjectEntry& object) noexcept {
    return (object.record.tileCount + 63) / 64;
}

inline bool changesState(const StepPlan& step) noexcept {
    return !step.events.empty() || !step.materials.empty();
}

struct FrameNeeds {
    bool dense = false, never = false;    // debug switches: every tile; never idle
    uint64_t uploadBytes = 0;             // at most
    uint64_t iterations = 0;              // of all steps
    uint32_t events = 0, wakeGroups = 0;  // of the largest step
    uint32_t neighbours = 0, links = 0;   // of the largest exchange update
    uint32_t occlusionWords = 0;          // of the largest heat-occlusion grid
    bool placing = false;                 // there is one
    bool exchanges = false;               // fire may come from other objects
    bool airs = false;                    // rooms have a step
    bool stimulus = false;                // an event or a latch
    bool rebuildsPrediction = false;      // the first step wakes objects that forget
    bool burning = false, predicting = false, extensionRuns = false, heating = false;
    bool appears = false;  // an object comes into view
    bool falling = false;  // burnt pieces may lose their hold
    DeformGroups deform;
    bool sheetsBegin = false;             // some sheet did not move in the frame before
    uint32_t fieldRuns = 0;               // steps and new masks
    bool fieldsShow = false;              // or showed until now
    bool skins = false;                   // a host moved vertices
    bool readback = false, work = false;  // no work: nothing is recorded
};

// Also marks which objects `forget`, and fills `extended`. Throws where a limit is exceeded.
[[nodiscard]] FrameNeeds needsOf(BackendState& s, const FramePlan& plan);
// Everything that may fail: buffers of the size that the frame needs, and sets that name them.
[[nodiscard]] FrameInFlight& makeRoom(BackendState& s, const FramePlan& plan,
                                      const FrameNeeds& needs);

}  // namespace fw::gpu::vk
