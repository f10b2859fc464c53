// Saves, the log of commands, the timeline, and the state that a network shares. It reads and writes
// the states of all systems.
#pragma once
#include "components/fire_emitter.h"
#include "world/deed_log.h"
#include "world/journal.h"
#include "world/scene.h"
#include "world/timeline.h"

#include <array>
#include <span>

namespace fw::world {

class World;
struct Save;
struct SavedEmitter;
struct SavedObject;
struct SavedRecords;
struct SavedWorld;
struct ImageStore;
struct PlaneScratch;
struct Tag;

enum class SaveFor : uint8_t { host, net, timeline, count };  // each has a save of its own

class PersistenceSystem {
 public:
    explicit PersistenceSystem(World& world);
    ~PersistenceSystem();
    PersistenceSystem(const PersistenceSystem&) = delete;
    PersistenceSystem& operator=(const PersistenceSystem&) = delete;

    // save.cpp. A save comes with the readback of the next frame; load is at once, or throws and
    // has changed nothing.
    void requestSave(SaveFor who = SaveFor::host);
    const std::pmr::vector<std::byte>* fetchSave(SaveFor who = SaveFor::host);  // null: not ready
    void cancelSave() noexcept;
    void load(std::span<const std::byte> bytes);

    // journal.cpp
    Journal& keepJournal(bool follows);  // from here on
    void dropJournal() noexcept { journal_ = {}; }
    // deed_log.cpp
    void startLog();
    void stopLog() noexcept;
    const std::pmr::vector<std::byte>& fetchLog();  // until the next call
    void openLog(std::span<const std::byte> bytes);
    // Does what comes before the next step; s that the world may go then. 0: `untilTick` is there.
    float playLog(uint64_t untilTick);
    // timeline.cpp
    void startTimeline(const FwTimelineDef& def);
    void stopTimeline() noexcept;
    // One piece of the way to a tick: `seconds` that the world may go then; 0: it is there. False:
    // nothing to begin from is there yet.
    bool seek(uint64_t untilTick, float& seconds);
    void timelineState(FwTimelineState& state);
    // save_tiles.cpp. Of an object in a save, a hash for each block of its tiles; none: it is at
    // rest there. The blocks whose hashes are not `theirs`, of a save of the same tick: as bytes
    // (false: the object is at rest), and put into that other save.
    std::pmr::vector<uint32_t> hashBlocks(std::span<const std::byte> save, uint32_t slot);
    bool writeBlocks(std::span<const std::byte> save, uint32_t slot,
                     std::span<const uint32_t> theirs, std::pmr::vector<std::byte>& out);
    void mergeBlocks(std::span<const std::byte> save, std::span<const std::byte> theirs,
                     std::pmr::vector<std::byte>& out);
    // Another world's deed, before this one's next step. Throws where it is none for this world.
    void perform(const Deed& deed);
    void performLoad(std::span<const std::byte> bytes);  // of its save
    [[nodiscard]] double seconds() const noexcept;       // since its beginning
    // s from the present to the beginning of a later tick.
    [[nodiscard]] double secondsTo(uint64_t tick) const noexcept;
    // As that, rounded up.
    [[nodiscard]] float secondsUpTo(uint64_t tick) const noexcept;
    // Of the rules, and of all that a save has to find here: worlds of one identity can follow
    // each other.
    [[nodiscard]] uint64_t identity() noexcept;

    // For the systems, whose calls of the host's are recorded.
    void mayChange() const;  // throws where another machine's commands alone count
    [[nodiscard]] bool notes() const noexcept { return journal_ || noted_ || timeline_; }
    void note(const Deed& deed) noexcept;
    void noteMove(Deed::Kind kind, uint32_t slot, const float* numbers, size_t count,
                  uint32_t word = 0) noexcept;
    template <class Def>
    void noteDef(Deed::Kind kind, uint32_t slot, const Def& def) noexcept {
        if (!notes()) return;
        Deed deed = deedOf(def);
        deed.kind = kind;
        deed.slot = slot;
        note(deed);
    }
    void notePose(Deed::Kind kind, uint32_t slot, const float transform[16]) noexcept;

    // A frame: its end is `time.after`.
    void checkFrame(float deltaTime) const;
    void plan(const ClockAdvance& time);
    void fillPlan(gpu::FramePlan& plan) const noexcept { plan.images = images_; }
    void commitTimeline(uint64_t before) noexcept;
    void commitSave(uint64_t frameIndex) noexcept;
    void onBurnMap(const gpu::BurnMap& map, const gpu::Readback& readback);
    void takeSaves(const gpu::Readback& readback) noexcept;
    void forgetTag(const Tag& tag, uint64_t frameIndex) noexcept;  // that an event reported

 private:
    [[nodiscard]] uint64_t assetOf(const Object& object) noexcept;
    [[nodiscard]] uint32_t windowOf(const Object& object) noexcept;
    void planSave();
    [[nodiscard]] uint32_t unsavable() noexcept;  // a burning object's slot + 1; 0: there is none
    // timeline.cpp
    void planTimeline(uint64_t after) noexcept;
    void keepMoment() noexcept;
    void noteInTimeline(const Deed& deed) noexcept;
    void noteSaved(SavedWorld& to);
    void noteObject(Object& object, SavedObject& saved) noexcept;
    void noteEmitter(uint32_t slot, const components::FireEmitter& emitter,
                     std::pmr::vector<SavedEmitter>& to) const;
    void takeSave(Save& save, const gpu::Readback& readback);
    void noteEvents(Save& save);
    static void forgetTag(Save& save, const Tag& tag, uint64_t frameIndex) noexcept;
    void planHashes(const ClockAdvance& time);
    void noteSaveInLog() noexcept;
    void noteHash(const gpu::BurnMap& map, const gpu::Readback& readback);
    void checkSaved(const SavedWorld& saved);  // throws
    // Its latch, too, as it was.
    SavedRecords recordsOf(const SavedWorld& saved, const SavedObject& from,
                           components::Latch& latch);
    bool readObject(std::span<const std::byte> save, uint32_t slot, SavedWorld& saved,
                    ImageStore& store, PlaneScratch& scratch);
    void applySaved(const SavedWorld& saved, std::span<const components::Latch> latches) noexcept;
    void applyObject(const SavedObject& from, const components::Latch& latch,
                     Object& object) noexcept;
    void applyEmitter(const SavedEmitter& from, components::FireEmitter& emitter) noexcept;

    World& world_;
    std::array<core::Owned<Save>, size_t(SaveFor::count)> saves_;  // once one was asked for
    core::Owned<Journal> journal_;                                 // null: nobody asks
    core::Owned<DeedLog> noted_, played_;                          // null: none
    core::Owned<Timeline> timeline_;                               // null: none is kept
    std::pmr::vector<uint32_t> images_;  // of a frame: slots of objects that a save takes
};

}  // namespace fw::world
