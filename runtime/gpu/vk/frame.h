// The passes of a frame, in order. Each function records one part of it; ARCHITECTURE.md has the
// same passes in the same order, and a test compares the two with passes.inl.
#pragma once
#include "gpu/backend.h"
#include "gpu/vk/recorder.h"

namespace fw::gpu::vk {

struct BackendState;

// Where the lists are that live on between steps and frames.
struct FrameLists {
    uint32_t row = kRowIteration;  // counters row of the front list
    uint32_t parity = 0;           // 0: the first of the two lists
    uint32_t burnParity = 0;
    uint32_t predictParity = 0;
    uint32_t hotParity = 0;
};

// How often frames walked through each list.
struct ListWalks {
    uint64_t front = 0, burn = 0, predict = 0, hot = 0;
};

struct DeformGroups {  // of kDeformGroup particles or vertices
    uint32_t nodes = 0, sheets = 0, extended = 0, vertices = 0;
    uint32_t inner = 0;  // of vertices with an inner skin
    [[nodiscard]] uint32_t all() const noexcept {
        return nodes + sheets + extended + vertices + inner;
    }
};

// Groups of 64 of the objects that deform in this frame, in this order: nodes of all, of sheets and
// of those that an extension moves; drawn vertices of all.
struct DeformRecord {
    DeformPush push{};
    Staged groups;
    DeformGroups count;
    uint32_t steps = 0;    // of particles with a solver
    uint32_t bendSet = 0;  // of the first: which bending constraints it takes
    bool begins = false;   // some sheet did not move in the frame before
};

struct ExtendedStep {  // one object whose texels an extension burns
    uint32_t object = 0, groups = 0, parity = 0;
};

// A planned step without the passes that have nothing to do; `rules` lack the places of lists.
struct StepRecord : StepPlan {
    uint32_t switches = 0;
    bool iterate = true;    // false: the front is known to be empty
    Staged staged;          // the events
    uint32_t allTiles = 0;  // of the largest object that one addresses as a whole; 0: none does
    Staged wakeGroups;      // of latches; with the dense switch: of all objects
    uint32_t objectSlots = 0;
    std::span<const ExtendedStep> extended;
    uint32_t links = 0;  // contacts
    bool parts = false;  // some mesh has parts that touch
};

// Runs in their buffer: `masked` fields, then the groups of each round of steps.
struct FieldsRecord {
    Staged runs;
    uint32_t masked = 0, rounds = 0;
    std::array<uint32_t, kMaxFieldRounds> groups{};
};

// Whether an event concerns all texels of its object.
[[nodiscard]] bool addressesAll(const TexelEvent& event) noexcept;

// Inputs of a frame's march of volumetric flames, for one view. The last `impostors` of `volumes`
// are impostors; the words from `first` to `end` hold the tiles' history.
struct MarchRecord {
    std::span<const MarchedVolume> volumes;
    uint32_t first = 0, end = 0, impostors = 0;
};

// A part of all tiles, which passes that need not look at all of them in each frame take in turn.
struct TileShare {
    uint32_t first = 0, count = 0;
    uint32_t ticks = 0;  // since the pass last came to them
};

// `turn`: levels are chosen; else the triangles listed last time are placed again. `cuts`, `fresh`:
// some object is.
struct RefineRecord {
    RefinePush push{};
    bool turn = false, cuts = false, fresh = false;
};

// Changes since the last frame: objects, fields, vertices that the host moves.
void recordReset(FrameRecorder& r, uint32_t object, uint32_t tiles);
void recordRestore(FrameRecorder& r, const FrameLists& lists, uint32_t object, uint32_t tiles);
// BurnTiles of the burn list as it is: see kSwitchDisplayOnly.
void recordShownTiles(FrameRecorder& r, const FrameLists& lists, uint32_t tick);
void recordFields(FrameRecorder& r, const FieldsRecord& fields);
void recordSkin(FrameRecorder& r, const SkinPush& push);

// Makes counters row kRowIteration the front list's and zeroes the `iterations` rows after it.
void recordCounters(FrameRecorder& r, FrameLists& lists, uint32_t iterations);
// One step.
void recordSimulation(FrameRecorder& r, FrameLists& lists, const StepRecord& step);
// The next ring predicts this object from its simulated state; its kObjectShownAgain is set.
void recordPredictRestart(FrameRecorder& r, const FrameLists& lists, uint32_t object,
                          uint32_t tiles);
// One ring further. `seen`: some view may show predictions; else only what burns and what was put
// out is passed on.
void recordPrediction(FrameRecorder& r, FrameLists& lists, uint32_t endTick, bool seen);
void recordSupport(FrameRecorder& r, uint32_t endTick, const TileShare& share);
void recordDeformation(FrameRecorder& r, const DeformRecord& deform);
void recordProbes(FrameRecorder& r, const Staged& probes);
// Lights once a frame; flames, particles and marches of each view. Without a view lights alone.
void recordEffects(BackendState& s, FrameInFlight& slot);
// After the steps. The work buffer holds its lists, and zero before them.
void recordRefinement(FrameRecorder& r, const FrameLists& lists, const RefineRecord& refine);
// recordReadback ends the frame.

}  // namespace fw::gpu::vk
