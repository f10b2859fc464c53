#include "world/recording.h"

#include "core/hash.h"
#include "core/stream.h"
#include "world/world.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fw::world {
namespace {

constexpr char kMagic[] = "FWLG";
constexpr uint32_t kLogVersion = 2;
constexpr size_t kHeadBytes = 24;  // magic, version, identity, checksum of the rest
constexpr uint16_t kSaveEntry = 0xFFFF;
constexpr size_t kMinEntry = sizeof(uint32_t) + sizeof(uint16_t);

}  // namespace

void CommandLog::push(const LogEntry& entry) noexcept {
    try {
        entries.push_back(entry);
    } catch (...) {
        lost = true;
    }
}

void writeLog(std::span<const LogEntry> entries, uint64_t identity,
              std::pmr::vector<std::byte>& out) {
    out.clear();
    core::Writer writer(out);
    save::writeHead(writer, kMagic, kLogVersion);
    writer.number(identity);
    writer.number(uint64_t(0));  // the checksum's place
    writer.number(uint32_t(entries.size()));
    for (const LogEntry& entry : entries) {
        writer.number(uint32_t(entry.tick));
        writer.number(entry.save ? kSaveEntry : uint16_t(entry.command.index()));
        if (!entry.save) writeCommand(entry.command, out);
    }
    writer.numberAt(kHeadBytes - sizeof(uint64_t),
                    core::hashBytes(std::span(out).subspan(kHeadBytes)));
}

void readLog(std::span<const std::byte> bytes, uint64_t identity,
             std::pmr::vector<LogEntry>& entries) {
    save::Reader reader(bytes, "log", entries.get_allocator().resource());
    uint64_t world = 0, sum = 0;
    save::readHead(reader, kMagic, kLogVersion);
    reader.number(world);
    reader.number(sum);
    if (sum != core::hashBytes(bytes.subspan(kHeadBytes)))
        core::failData("The log is damaged or cut: its checksum is not right.");
    if (world != identity)
        core::failData(
            "The log is of a world with other rules, objects or meshes than this one's.");
    const uint32_t count = reader.count("entries", kMinEntry);
    entries.clear();
    entries.reserve(count);
    for (uint32_t i = 0; i < count; ++i) {
        LogEntry entry;
        uint32_t tick = 0;
        uint16_t kind = 0;
        reader.number(tick);
        reader.number(kind);
        entry.tick = tick;
        if (tick % gpu::kStepTicks != 0 || (i > 0 && entry.tick < entries.back().tick))
            core::failData("Entry %u of the log is at tick %u.", i, tick);
        entry.save = kind == kSaveEntry;
        if (!entry.save) readCommand(kind, reader, entry.command);
        entries.push_back(entry);
    }
    if (reader.left() != 0) core::failData("%zu bytes follow the log.", reader.left());
}

std::span<const LogEntry> fromTick(std::span<const LogEntry> entries, uint64_t tick,
                                   bool loaded) noexcept {
    auto at = std::lower_bound(entries.begin(), entries.end(), tick,
                               [](const LogEntry& entry, uint64_t t) { return entry.tick < t; });
    if (loaded) {
        const auto end = std::find_if(at, entries.end(),
                                      [&](const LogEntry& entry) { return entry.tick != tick; });
        const auto save = std::find_if(at, end, [](const LogEntry& entry) { return entry.save; });
        if (save != end) at = save;
    }
    return entries.subspan(size_t(at - entries.begin()));
}

void PersistenceSystem::startLog() {
    recorder_.log = core::Owned<CommandLog>::make(context_.memory, context_.memory);
}

void PersistenceSystem::stopLog() noexcept { recorder_.log = {}; }

const std::pmr::vector<std::byte>& PersistenceSystem::fetchLog() {
    if (!recorder_.log) core::refuse("The world records no log; fwWorld_StartCommandLog first.");
    if (recorder_.log->lost)
        core::fail(FW_ERROR_OUT_OF_MEMORY,
                   "Memory ended while the log was recorded; it has a gap.");
    writeLog(recorder_.log->entries, identity(), recorder_.log->bytes);
    return recorder_.log->bytes;
}

void PersistenceSystem::openLog(std::span<const std::byte> bytes) {
    if (bytes.empty()) {
        playedLog_ = {};
        return;
    }
    auto log = core::Owned<CommandLog>::make(context_.memory, context_.memory);
    readLog(bytes, identity(), log->entries);
    playedLog_ = std::move(log);
}

float PersistenceSystem::playLog(uint64_t untilTick) {
    if (!playedLog_) core::refuse("There is no log to play; fwWorld_OpenCommandLog first.");
    recorder_.mayChange();
    std::span<const LogEntry> ahead = fromTick(playedLog_->entries, context_.clock.tick,
                                               context_.loadedTick == context_.clock.tick);
    uint64_t until = untilTick - untilTick % gpu::kStepTicks;
    if (until <= context_.clock.tick) return 0;
    ahead = ahead.subspan(applyUntilNow(ahead, "log"));
    if (!ahead.empty()) until = std::min(until, ahead.front().tick);
    until = std::min(until, context_.clock.tick + uint64_t(world_.mostSteps()) * gpu::kStepTicks);
    return secondsUpTo(until);
}

// Applies the entries up to the present, and returns how many these are. One that is refused is
// left out.
size_t PersistenceSystem::applyUntilNow(std::span<const LogEntry> entries, const char* name) {
    size_t count = 0;
    for (; count < entries.size() && entries[count].tick <= context_.clock.tick; ++count) {
        if (entries[count].save) continue;
        try {
            apply(entries[count].command);
        } catch (const core::Error& error) {
            context_.log.write(FW_LOG_WARNING, "A command of the %s at tick %llu is refused: %s",
                               name, static_cast<unsigned long long>(context_.clock.tick),
                               error.message);
        }
    }
    return count;
}

// The next call would find the step still ahead.
float PersistenceSystem::secondsUpTo(uint64_t tick) const noexcept {
    const double exact = secondsTo(tick);
    const auto seconds = float(exact);
    return double(seconds) < exact ? std::nextafter(seconds, std::numeric_limits<float>::infinity())
                                   : seconds;
}

}  // namespace fw::world
