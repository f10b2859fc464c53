// All passes, and the order in which a frame records them.
#pragma once
#include "gpu/passes/draw.h"
#include "gpu/passes/pass.h"
#include "shared/arp.h"
#include "shared/deform.h"
#include "shared/exchange.h"
#include "shared/field.h"
#include "shared/field_draw.h"

#include <array>
#include <cstddef>
#include <span>

namespace fw::gpu {

namespace vk {
class FrameRecorder;
}

struct ParticlePush;  // shared/particle.h
struct SparkPush;     // shared/spark.h

extern const ComputePass kResetPass, kRestorePass, kEventsPass, kEventsAllPass, kHeatPass,
    kWakePass, kSchedulePass, kGatherPass, kArrivalPass, kArrivalRimPass, kGrantPass, kCommitPass,
    kPublishedPass, kReduceClearPass, kReduceFrontPass, kReducePass, kFireCellsPass,
    kFireSourcesPass, kReceiversPass, kExchangePass, kExchangeShieldPass, kContactsPass, kPartsPass,
    kEmberWaysPass, kEmbersPass, kPredictAnewPass, kPredictStatesPass, kPredictGatherPass,
    kPredictPass, kPredictRimPass, kPredictCommitPass, kSupportPass, kProbePass, kLightsPass,
    kFlameQuadsPass, kFlameSortPass, kRefineHeatPass, kRefineLevelsPass, kRefineScanPass,
    kRefineEmitPass, kRefinePlacePass, kRefineCutPass, kRefinePublishedPass, kRecedePass, kTiesPass,
    kSoftPass, kSpringsPass, kDrapePass, kInnerPass, kSkinPass, kSootPass, kVolumeProbePass,
    kVolumeMarchPass, kVolumeSmokePass, kParticlesPass, kParticleQuadsPass, kSparksPass, kFieldPass,
    kFieldMaskPass, kFieldShowPass, kRoomsPass;

// Their place in these tables is their number for pipelines and descriptor sets.
std::span<const ComputePass* const> computePasses();
std::span<const DrawPass* const> drawPasses();
struct DrawStep {
    uint32_t pass;  // of drawPasses
    bool afterZ;    // its items are those after the Z-pass
};
std::span<const DrawStep> drawSteps();  // in the order of drawing
size_t passNumber(const ComputePass& pass);

// Where the lists are that live on between steps and frames.
struct FrameLists {
    uint32_t row = kRowIteration;  // counters row of the front list
    uint32_t parity = 0;           // 0: it is list A
    uint32_t burnParity = 0;
    uint32_t predictParity = 0;
    uint32_t hotParity = 0;
};

struct Staged {  // in the frame's upload buffer
    uint64_t at = 0;
    uint32_t count = 0;
};

// Groups of 64 of the objects that deform in this frame, in this order: nodes of all, of sheets and
// of springs; drawn vertices of all.
struct DeformRecord {
    DeformPush push{};
    Staged groups;
    uint32_t nodeGroups = 0, sheetGroups = 0, springGroups = 0, vertexGroups = 0;
    uint32_t innerGroups = 0;  // of vertices with an inner skin
    uint32_t steps = 0;        // of sheets and springs
    uint32_t way = 0;          // of the first: which arms it minds
    bool begins = false;       // some sheet did not move in the frame before
};

struct PublishedStep {  // one object in as-published mode
    uint32_t object = 0, groups = 0, parity = 0;
};
uint32_t publishedGroups(const BurnObject& object);

[[nodiscard]] bool addressesAll(const TexelEvent& event) noexcept;  // texels of its object

struct StepRecord {
    uint32_t now = 0, stepShift = 0, switches = 0;
    bool iterate = true;  // false: the front is known to be empty
    bool reduce = false;
    bool heat = false;
    bool rooms = false;  // their air, before heat
    Staged events;
    std::span<const TexelEvent> eventList;  // the same
    uint32_t allTiles = 0;  // of the largest object that one addresses as a whole; 0: none does
    Staged wakeGroups;      // of latches; with the dense switch: of all objects
    uint32_t objectSlots = 0;
    std::span<const PublishedStep> published;
    bool governed = false, capped = false, plays = false;
    bool exchange = false;
    ExchangePush rules{};  // of the exchange, but for what the lists say
    uint32_t links = 0;    // contacts
    bool parts = false;    // some mesh has parts that touch
};

// Makes counters row kRowIteration the front list's and zeroes the `iterations` rows after it.
void recordCounters(vk::FrameRecorder& recorder, FrameLists& lists, uint32_t iterations);
void recordStep(vk::FrameRecorder& recorder, FrameLists& lists, const StepRecord& step);
// One ring further. `seen`: some view may show what is predicted; else only what burns and what was
// put out is passed on.
void recordPredict(vk::FrameRecorder& recorder, FrameLists& lists, uint32_t endTick, bool seen);
// The next ring predicts this object from its simulated state; its kObjectShownAgain is set.
void recordPredictAnew(vk::FrameRecorder& recorder, const FrameLists& lists, uint32_t object,
                       uint32_t tiles);
// Tiles `first` .. + `count` of all; `ticks` since they last came to it.
void recordSupport(vk::FrameRecorder& recorder, uint32_t endTick, uint32_t ticks, uint32_t first,
                   uint32_t count);
// After the lights; tiles and ticks as recordSupport's.
void recordSoot(vk::FrameRecorder& recorder, uint32_t ticks, uint32_t first, uint32_t count);
void recordSkin(vk::FrameRecorder& recorder, const SkinPush& push);
void recordDeform(vk::FrameRecorder& recorder, const DeformRecord& deform);
void recordProbes(vk::FrameRecorder& recorder, const Staged& probes);
void recordReset(vk::FrameRecorder& recorder, uint32_t object, uint32_t tiles);
// Runs in their plane: `masked` fields, then the groups of each round of steps.
struct FieldsRecord {
    Staged runs;
    uint32_t masked = 0, rounds = 0;
    std::array<uint32_t, kMaxFieldRounds> groups{};
};
void recordFields(vk::FrameRecorder& recorder, const FieldsRecord& fields);
// Of the first `fields` records that are drawn.
void recordFieldShow(vk::FrameRecorder& recorder, uint32_t fields);

constexpr uint32_t kFieldVariants = 3;
extern const DrawPass kFieldDrawPasses[kFieldVariants];
struct FieldItem {      // a particle field that a view may show
    uint32_t draw = 0;  // its record
    uint32_t variant = 0, vertices = 0;
    float depth = 0;  // m
};
// False: the view does not show it.
bool fieldDrawn(const ViewParams& view, const FieldDraw& field, FieldItem& out);
void sortFields(std::span<FieldItem> items) noexcept;  // farthest first
struct DrawList {                                      // what a view may show
    std::span<const DrawItem> surfaces;
    bool flames = false;      // something burns
    bool books = false;       // flipbooks show some of it
    bool pagesAlone = false;  // and all of it but sparks
    std::span<const VolumeItem> volumes;
    std::span<const MarchedVolume> marched;  // instead of them
    std::span<const FieldItem> fields;
    bool turned = false;  // counter-clockwise triangles turn their backs to it
    std::span<const VolumeCard> cards{};
    std::span<const SlicedVolume> sliced{};
    std::span<const VolumeRun> volumeRuns{};  // of these four
    std::span<const HazedVolume> hazes{};
    bool half = false;         // what is soft was drawn at half resolution
    bool transparent = false;  // the host's picture shows through all of it
};
// False: it would draw nothing, do not bind it.
bool drawStepDraws(const DrawStep& step, const DrawList& list);
void recordDrawStep(const DrawStep& step, DrawRecorder& recorder, const DrawList& list);
void recordVolumeRun(const VolumeRun& run, DrawRecorder& recorder, const DrawList& list);
size_t passNumber(const DrawPass& pass);
void recordLights(vk::FrameRecorder& recorder, const FrameLists& lists, uint32_t endTick);
// For the frame's view, after the lights: quads of burning meshes' flames.
// `books`: that show them, byte 0 fire's + 1, byte 1 smoke's + 1.
void recordFlameQuads(vk::FrameRecorder& recorder, const FrameLists& lists, uint32_t endTick,
                      uint32_t books);

// Of emitters' particles, which move once a frame.
void recordParticles(vk::FrameRecorder& recorder, const ParticlePush& push, uint32_t groups);
// Before the quads of a view of which burning meshes have none.
void recordNoQuads(vk::FrameRecorder& recorder);
void recordParticleQuads(vk::FrameRecorder& recorder, const ParticlePush& push, uint32_t groups);
void recordSparks(vk::FrameRecorder& recorder, const SparkPush& push, uint32_t sources);
// The order of all quads.
void recordFlameSort(vk::FrameRecorder& recorder, const SortPush& push);

// For the frame's view: what is known of tiles are words from `first` to `end`. The last `cards` of
// `volumes` are cards'.
void recordVolumeMarch(vk::FrameRecorder& recorder, std::span<const MarchedVolume> volumes,
                       uint32_t first, uint32_t end, uint32_t cards);

// After the steps. The work plane holds its lists, and zero before them. `lists`: see FrameLists.
// `cuts`, `fresh`: some object is. Without `turn` what was listed last time is placed again.
void recordRefine(vk::FrameRecorder& recorder, const FrameLists& lists, const RefinePush& push,
                  bool turn, bool cuts, bool fresh);

// The published scheme's, after the steps: groups of vertices,
// then of listed triangles.
void recordRefinePublished(vk::FrameRecorder& recorder, const ArpPush& push, uint32_t placeGroups,
                           uint32_t nameGroups);

}  // namespace fw::gpu
