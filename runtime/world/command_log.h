// The commands of a host, in order, as bytes in a file, which a world that loaded an earlier save
// applies again.
#pragma once
#include "world/recording.h"

#include <cstddef>

namespace fw::world {

struct LogEntry {
    uint64_t tick = 0;  // of the step that it came before
    bool save = false;  // a save was taken here: it has the commands of this tick before it
    Command command;    // else
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

}  // namespace fw::world
