// The host's commands and all that keep them: the command log, which a world that loaded an earlier
// save applies again; the timeline, to any tick of which the world can go back; and the network's
// recording, with hashes of objects at fixed steps, while a server or a client (net/) asks for it.
#pragma once
#include "core/owned.h"
#include "world/clock.h"
#include "world/command.h"

#include <cstddef>

namespace fw::world {

constexpr uint32_t kHashSteps = 8;    // an object's turn is at multiples of these
constexpr uint32_t kHashRounds = 16;  // each has its turn once in so many; in more, if it is more
constexpr uint32_t kMaxHashes = 64;   // of a round than these
constexpr uint32_t kHashTicks = kHashSteps * gpu::kStepTicks;

constexpr uint32_t kMaxBlocks = 100;  // of tiles, of an object: each has a hash

constexpr uint32_t hashRounds(uint32_t slots) noexcept {
    const uint32_t needed = (slots + kMaxHashes - 1) / kMaxHashes;
    return needed > kHashRounds ? needed : kHashRounds;
}

// Of an object's whole state: its ticks, and its heat where it has some.
uint64_t hashState(std::span<const uint32_t> ticks, std::span<const gpu::uvec2> heat) noexcept;

struct ObjectHash {
    uint32_t slot = 0, stride = 1;  // the next of its round is so many slots on
    uint64_t tick = 0, hash = 0;
};

struct LogEntry {
    uint64_t tick = 0;  // of the step that it came before
    bool save = false;  // a save was taken here: it has the commands of this tick before it
    Command command;    // else
};

struct Recording {
    explicit Recording(std::pmr::memory_resource* memory) : commands(memory), hashes(memory) {}
    std::pmr::vector<LogEntry> commands;
    std::pmr::vector<ObjectHash> hashes;
    bool follows = false;     // another machine's commands alone count
    bool applies = false;     // one of them is being applied
    bool lost = false;        // memory ended, and with it the order of commands
    bool loaded = false;      // another past since
    uint64_t capturedAt = 0;  // tick of the last capture, and commands before it that wait here
    size_t capturedBehind = 0;
    bool captured = false;
    uint64_t until = 0;  // with `follows`: the tick that frames may come to
};

struct CommandLog {
    explicit CommandLog(std::pmr::memory_resource* memory) : entries(memory), bytes(memory) {}
    std::pmr::vector<LogEntry> entries;  // by tick
    std::pmr::vector<std::byte> bytes;   // as of the last fetch
    bool lost = false;                   // memory ended, and with it what came then
    void push(const LogEntry& entry) noexcept;
};

// The whole file: a header, and what it sums up. `identity`: of its world
// (PersistenceSystem::identity).
void writeLog(std::span<const LogEntry> entries, uint64_t identity,
              std::pmr::vector<std::byte>& out);
// Throws FW_ERROR_BAD_DATA unless writeLog wrote the bytes for such a world.
void readLog(std::span<const std::byte> bytes, uint64_t identity,
             std::pmr::vector<LogEntry>& entries);

// The entries from the first that a world at `tick` has not applied yet. `loaded`: it is as a save
// of that tick was.
[[nodiscard]] std::span<const LogEntry> fromTick(std::span<const LogEntry> entries, uint64_t tick,
                                                 bool loaded) noexcept;

struct Keyframe {
    uint64_t tick = 0;
    size_t commands = 0;  // of the timeline's, that are in its save
    std::pmr::vector<std::byte> save;
};

struct Timeline {
    explicit Timeline(std::pmr::memory_resource* memory) : keyframes(memory), commands(memory) {}
    std::pmr::vector<Keyframe> keyframes;  // by tick
    CommandLog commands;                   // from the first keyframe on
    size_t applied = 0;                    // of these, that are in the world as it is
    size_t captured = 0;                   // that are in the keyframe under way
    uint64_t most = 0;                     // bytes
    uint64_t apart = 0, farthest = 0;      // ticks from one keyframe to the next: now, and at most
    uint64_t end = 0;                      // tick that the burn has come to
    uint64_t granted = 0;                  // tick that it may be played to again
    bool seeks = false;                    // commands are the timeline's own

    [[nodiscard]] uint64_t bytes() const noexcept;
    // Removes keyframes until the rest fits: every second one while those left are near enough to
    // each other, then the oldest. The last one stays.
    void fit() noexcept;
    // A command in the past makes another future.
    void record(const Command& command, uint64_t now) noexcept;
    // Another future begins: `now` is the burn's end.
    void forget(uint64_t now) noexcept;
    // Another past altogether.
    void restart(uint64_t now) noexcept;
};

// Keeps a flag true while it lives. Null: there is none.
class Raised {
 public:
    explicit Raised(bool* flag) noexcept : flag_(flag) { set(true); }
    ~Raised() { set(false); }
    Raised(const Raised&) = delete;
    Raised& operator=(const Raised&) = delete;

 private:
    void set(bool value) noexcept {
        if (flag_) *flag_ = value;
    }
    bool* flag_;
};

class Recorder {
 public:
    explicit Recorder(const Clock& clock) : clock_(clock) {}

    void mayChange() const;  // throws where another machine's commands alone count
    [[nodiscard]] bool records() const noexcept { return network || log || timeline; }
    void record(const Command& command) noexcept;

    // Null: nobody asks for it.
    core::Owned<Recording> network;
    core::Owned<CommandLog> log;
    core::Owned<Timeline> timeline;

 private:
    const Clock& clock_;
};

}  // namespace fw::world
