// The burn: events of texels on their way to their steps, the steps of a frame, records under
// wind and gravity, baked burns, and the course of each object's fire as readbacks tell it.
#pragma once
#include "host_limits.h"
#include "world/command.h"
#include "world/pending.h"
#include "world/scene.h"

namespace fw::world {

class ExchangeSystem;
class RoomSystem;
class WindSystem;
struct ImageStore;
struct ObjectSnapshot;

struct BurnCounts {  // of tiles, as of the last readback
    uint32_t front = 0, run = 0, burning = 0, hot = 0;
    uint32_t receivers = 0, lateClamps = 0;

    FW_SERIALIZE(front, burning, hot, receivers, lateClamps)
};

struct BurnSnapshot {
    explicit BurnSnapshot(std::pmr::memory_resource* memory) : pending(memory) {}
    uint64_t steps = 0, droppedSteps = 0;
    uint64_t order = 0;         // of the next of `pending`
    bool idle = true;           // nothing burns, and nobody has to hear of who moves
    uint64_t lastStimulus = 0;  // tick
    BurnCounts counts;          // as of the readback
    std::pmr::vector<PendingTexel> pending;

    template <class A>
    void serialize(A& a) {
        a(steps, droppedSteps, order, idle, lastStimulus, counts);
        a.list("events that wait", pending, 32);
    }
};

// As the plan of the next frame finds it. `counts`: as of the last readback.
struct BurnState : BurnSnapshot {
    explicit BurnState(std::pmr::memory_resource* memory)
        : BurnSnapshot(memory), burns("Baked burn", memory), stimuli(memory), frameNotes(memory) {}
    core::HandlePool<FwBurnId, core::Owned<Burn>> burns;
    uint64_t carriesUntil = 0;           // tick: until then burns are carried
    uint64_t wetUntil = 0;               // tick: from then on no FW_WET event waits
    std::pmr::vector<Stimulus> stimuli;  // of frames whose readback is on its way
    std::pmr::vector<InFlightFrame> frameNotes;
    uint64_t planStamp = 0;
    // As of the last readback.
    uint64_t seenStimulus = 0;
    bool seenIdle = true;
    BurnCounts loaded;  // of a save; until the next count
};

class BurnSystem {
 public:
    static constexpr size_t kMaxPending = limits::kPendingEvents;  // texel events that wait

    BurnSystem(const WorldContext& context, Scene& scene, const WindSystem& wind, RoomSystem& rooms,
               ExchangeSystem& exchange);

    // Texels addressed. `acts`: one of them, or of a match one that can burn.
    uint32_t ignite(const FwIgnitionDef& def, bool* acts = nullptr);
    // Why a match that addressed so many texels lights nothing, for people.
    void explainMiss(const FwIgnitionDef& def, uint32_t texels, std::span<char> text) noexcept;
    void transferBurn(FwBurnableMeshId from, FwBurnableMeshId to);
    void pushTexels(FwBurnableMeshId id, uint32_t kind, std::span<const uint32_t> texels);
    FwBurnId createBurn(std::span<const std::byte> bytes);
    void destroyBurn(FwBurnId id);
    void playBurn(FwBurnableMeshId id, FwBurnId burn, float delay, float speed);
    void stopBurn(FwBurnableMeshId id);

    void plan(const HostFrame& frame, gpu::FramePlan& plan);  // throws std::bad_alloc
    // Slots of objects that the planned frame looks at for breaks.
    [[nodiscard]] std::span<const uint32_t> searched() const noexcept { return frame_.breaks; }
    [[nodiscard]] std::span<const Splash> splashes() const noexcept { return splashes_; }
    void clearSplashes() noexcept { splashes_.clear(); }
    void commit(const HostFrame& frame) noexcept;
    void onFrameDone(uint64_t frameIndex) noexcept;  // before anything else of its readback
    void onReadback(const gpu::Readback& readback) noexcept;
    void onBurnMap(Object& object, const gpu::ObjectImage& map,
                   const gpu::Readback& readback) noexcept;
    void settle(const gpu::Readback& readback) noexcept;  // after all else of it
    void checkGone(const Object& object) const;           // throws unless it may be destroyed
    void keepGiven(const Object& from);                   // before it is destroyed; throws
    void forgetObject(const Object& object) noexcept;
    core::Owned<Breaks> makeBreaks(const FwBurnableMeshDef& def, MeshEntry& entry,
                                   std::span<const uint8_t> gone);
    void reserveSlots();  // for an object more; throws std::bad_alloc

    // Commands of another world's.
    void apply(const IgniteTexels& command);
    void apply(const IgniteObjects& command);
    void apply(const PlayBurn& command);
    void apply(const StopBurn& command) { stopBurn(scene_.objects.findId(command.slot)); }
    void apply(const TransferBurn& command) {
        transferBurn(scene_.objects.findId(command.from), scene_.objects.findId(command.to));
    }
    // Saves.
    void capture(BurnSnapshot& to) const;
    void complete(BurnSnapshot& to) const noexcept;  // with the readback of its frame
    void checkCarry(const PendingTexel& event, const Clock& clock);  // throws
    // Throws where this world has other burns.
    void settlePlays(const BurnSnapshot& saved, std::span<ObjectSnapshot> objects,
                     const Clock& clock);
    // After objects are. So many tiles of the save are listed, and hot.
    void restore(BurnSnapshot& from, uint32_t listed, uint32_t hot) noexcept;
    void restoreObject(Object& object) noexcept;
    void restoreBreaks(Object& object, const BreakState* saved, const ImageStore& store,
                       uint32_t now) noexcept;

    [[nodiscard]] const BurnState& state() const noexcept { return state_; }
    // As of the last readback, or by what came since.
    [[nodiscard]] static bool isActive(const Object& object) noexcept {
        return object.lifecycle.active || object.stimuli > 0;
    }
    [[nodiscard]] uint64_t bytes() const noexcept;  // of memory that frames use
    uint32_t igniteObject(Object& object, const FwIgnitionDef& def, uint32_t tick);
    // Piloted ignition under `flux` W/m^2: thick or thin, whichever is sooner.
    [[nodiscard]] uint64_t ticksToCatch(const Object& object, uint32_t material,
                                        double flux) const noexcept;
    // Events that wait for their step.
    void reservePending(size_t more);  // throws
    void addPending(PendingTexel event) noexcept;
    [[nodiscard]] size_t pendingCount() const noexcept { return state_.pending.size(); }
    void dropPending(size_t first) noexcept { state_.pending.resize(first); }

 private:
    static constexpr uint32_t kMaxSteps = limits::kStepsPerFrame;
    static_assert(kMaxSteps == gpu::kMaxFieldRounds);

    struct Frame {  // scratch of one frame; keeps its room between frames
        explicit Frame(std::pmr::memory_resource* given) : memory(given) {}
        std::pmr::memory_resource* memory;
        struct LatchOf {
            Object* object = nullptr;
            components::Latch latch;
            bool due = false;  // an event of this frame addresses it
        };
        struct PlayOf {
            Object* object = nullptr;
            Play play;                   // as it is at the frame's end
            uint32_t lit = mesh::kNone;  // the first texel that catches by it
            uint32_t ended = 0;          // tick at which it went live
        };
        std::pmr::vector<gpu::StepPlan> steps{memory};
        std::pmr::vector<PendingTexel> due{memory};  // by step, object and texel
        std::pmr::vector<gpu::TexelEvent> events{memory};
        std::pmr::vector<gpu::MaterialUpdate> updates{memory};
        std::pmr::vector<LatchOf> latches{
            memory};                  // of touched objects, as they are at the frame's end
        size_t spreadFrom = 0;        // of those, the first whose neighbours are not touched
        bool spreadFound = false;     // touchNear ran, and went through neighbours
        bool waitersTouched = false;  // or through all that waited
        std::pmr::vector<PlayOf> plays{memory};     // of those that play a baked burn
        std::pmr::vector<uint32_t> breaks{memory};  // slots of those looked at for breaks
    };

    // ignite.cpp
    uint32_t eventTick(float delay) const;
    void addPending(Object& object, uint32_t kind, uint32_t tick, uint32_t water,
                    std::span<const uint32_t> texels);
    [[nodiscard]] bool lightsSomething(size_t first) const noexcept;
    void recordTexels(size_t first) noexcept;
    void checkCommandTick(uint32_t tick) const;
    void addChange(Object& object, const TexelChange& change, std::span<const uint32_t> texels);
    // step.cpp
    void listLatches() noexcept;
    gpu::StepPlan planStep(uint32_t now, size_t& nextDue, bool awake);
    [[nodiscard]] uint32_t substepShift() const noexcept;  // of a frame
    void sortDue();
    void planGates(std::span<const PendingTexel> due, size_t firstEvent);
    [[nodiscard]] bool keepsAwake() const noexcept;  // a switch does
    void touchLatched(uint64_t frameIndex) noexcept;
    void stimulateDue(uint64_t frameIndex) noexcept;
    // latch.cpp
    void addLatch(Object& object, const components::Latch& latch) noexcept;
    void addFreshLatch(Object& object, uint32_t now) noexcept;
    void sendRecords(Frame::LatchOf& entry, const components::DriveInput& drive);
    [[nodiscard]] bool needsRecords(const Object& object, uint32_t now) const noexcept;
    void planLatches(uint32_t now, size_t firstEvent, bool placed);
    void touchNear(uint32_t now);
    // burn_system.cpp
    void reserveStimuli();  // throws std::bad_alloc
    Stimulus& stimulusOf(Object& object, uint64_t frameIndex) noexcept;
    void recordIgnition(Object& object, Stimulus& stimulus, uint32_t texel, uint32_t tick) noexcept;
    void commitStimuli(const HostFrame& frame) noexcept;
    void applyCounters(const gpu::Readback& readback) noexcept;
    void applyEnergy(Object& object, uint32_t endTick) noexcept;
    void countFlames(Object& object, const gpu::ObjectCounters& before, uint32_t endTick) noexcept;
    void applyBurntFuel(Object& object, uint32_t endTick) noexcept;
    // carry.cpp
    void waitForTransfers() noexcept;
    void continueBurn(Object& to, const BurnLifecycle& from) noexcept;
    void settlePending() noexcept;  // after a load
    // breaks.cpp
    [[nodiscard]] const mesh::Pieces& piecesOf(const Object& object) noexcept;  // it has breaks
    void planBreaks(uint64_t end) noexcept;
    void commitBreaks(uint64_t frameIndex) noexcept;
    void markBearers(const Object& object) noexcept;
    void findBreaks(Object& object, std::span<const uint32_t> ticks,
                    std::span<const gpu::uvec2> heat, uint32_t now, const uint64_t* tells) noexcept;
    // played.cpp
    void playBurnAt(FwBurnableMeshId id, FwBurnId burn, uint32_t tick, float speed);
    void reservePlays(size_t more);
    void startPlay(Object& object) noexcept;
    void endPlay(Object& object, uint64_t frameIndex, uint32_t tick) noexcept;
    size_t beginPlays(uint64_t end);
    void planPlays(uint32_t now, std::span<const PendingTexel> due);
    void turnPlay(const Object& object) noexcept;
    void commitPlays(uint64_t frameIndex) noexcept;

    const WorldContext& context_;
    Scene& scene_;
    const WindSystem& wind_;
    RoomSystem& rooms_;
    ExchangeSystem& exchange_;
    BurnState state_{context_.memory};
    Frame frame_{context_.memory};
    std::pmr::vector<Splash> splashes_{context_.memory};  // since they were last cleared
    mesh::HoldScratch holds_{context_.memory};  // room for the largest that asks what breaks
};

}  // namespace fw::world
