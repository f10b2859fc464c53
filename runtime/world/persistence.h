// Saves, the log of commands, the timeline, and the state that a network shares. It reads and
// writes the states of all systems.
#pragma once
#include "components/fire_emitter.h"
#include "world/recording.h"
#include "world/scene.h"

#include <array>
#include <span>

namespace fw::world {

class World;
struct Save;
struct BurnRecords;
struct ImageStore;
struct ObjectSnapshot;
struct RestoredObjects;
struct Snapshot;
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

    // recording.cpp
    Recording& startRecording(bool follows);
    void stopRecording() noexcept { recorder_.network = {}; }
    // command_log.cpp
    void startLog();
    void stopLog() noexcept;
    const std::pmr::vector<std::byte>& fetchLog();  // until the next call
    void openLog(std::span<const std::byte> bytes);
    // Applies the commands before the next step; s that the world may go then. 0: `untilTick` is
    // there.
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
    // Another world's command, before this one's next step. Throws unless this world can apply it.
    void apply(const Command& command);
    void applyLoad(std::span<const std::byte> bytes);  // of its save
    [[nodiscard]] double seconds() const noexcept;     // since its beginning
    // s from the present to the beginning of a later tick.
    [[nodiscard]] double secondsTo(uint64_t tick) const noexcept;
    // As that, rounded up.
    [[nodiscard]] float secondsUpTo(uint64_t tick) const noexcept;
    // Of the rules, and of all that a save has to find here: worlds of one identity can follow
    // each other.
    [[nodiscard]] uint64_t identity() noexcept;

    void checkFrame(float deltaTime) const;
    void plan(const HostFrame& frame, gpu::FramePlan& plan);  // throws std::bad_alloc
    void commit(const HostFrame& frame) noexcept;
    void onBurnMap(const gpu::ObjectImage& map, const gpu::Readback& readback);
    void completeSaves(const gpu::Readback& readback) noexcept;
    void forgetTags(std::span<const Tag> reached, uint64_t frameIndex) noexcept;
    [[nodiscard]] std::span<const uint32_t> hashed() const noexcept { return hashed_; }

 private:
    [[nodiscard]] uint64_t assetOf(const Object& object) noexcept;
    [[nodiscard]] uint32_t windowOf(const Object& object) noexcept;
    void planSave();
    [[nodiscard]] uint32_t
    explainUnsavable() noexcept;  // a burning object's slot + 1; 0: there is none
    // timeline.cpp
    void planTimeline(uint64_t after) noexcept;
    void commitTimeline(uint64_t before) noexcept;
    void commitSave(uint64_t frameIndex) noexcept;
    void keepKeyframe() noexcept;
    void capture(Snapshot& to);
    void captureObject(Object& object, ObjectSnapshot& to) noexcept;
    void completeSave(Save& save, const gpu::Readback& readback);
    void captureEvents(Save& save);
    void planHashes(const HostFrame& frame);
    void recordHash(const gpu::ObjectImage& map, const gpu::Readback& readback);
    // Throws unless the snapshot fits this world, whose ids it then has.
    void checkSnapshot(Snapshot& snapshot);
    // Its latch, too, as it was.
    BurnRecords recordsOf(const Snapshot& snapshot, const ObjectSnapshot& from,
                          components::Latch& latch);
    bool readObject(std::span<const std::byte> save, uint32_t slot, Snapshot& snapshot,
                    ImageStore& store);
    size_t applyUntilNow(std::span<const LogEntry> entries, const char* name);
    void readObjects(const Snapshot& snapshot, RestoredObjects& out);
    void restore(Snapshot& snapshot, const RestoredObjects& objects) noexcept;
    void restoreObject(const ObjectSnapshot& from, const components::Latch& latch,
                       Object& object) noexcept;
    void restoreBreaks(const Snapshot& snapshot, const RestoredObjects& objects) noexcept;
    void restoreRecords() noexcept;  // saves, the timeline and the network: of another past

    World& world_;
    WorldContext& context_;
    Scene& scene_;
    Recorder& recorder_;
    std::array<core::Owned<Save>, size_t(SaveFor::count)> saves_;  // once one was asked for
    core::Owned<CommandLog> playedLog_;                            // null: none
    // Of a frame: slots of objects that a save takes, and of those whose hash is due.
    std::pmr::vector<uint32_t> images_, hashed_;
};

}  // namespace fw::world
