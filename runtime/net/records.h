// Records that a server sends its clients in order: commands, hashes of objects, messages of the
// host, and the places of saved states, each with the step before which it belongs. A client that
// gets a whole state instead is sent runs of records as skipped, but every message.
#pragma once
#include "net/packet.h"
#include "world/recording.h"

#include <array>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

namespace fw::net {

constexpr uint32_t kMaxMessage = 1024;  // bytes of a host's message
static_assert(kMaxMessage == sizeof FwNetAction::message);

// Of a packet of records: the server says that its rate cannot carry its changes.
constexpr uint16_t kStreamOverloaded = 1;
constexpr uint16_t kStreamFlags = kStreamOverloaded;  // all of them

struct StreamHead {         // of a packet of records
    uint32_t outdated = 0;  // the client's state, if the records do not go on from it; or 0
    uint32_t step = 0;      // of the server's world
    uint32_t records = 0;   // before that step
    uint32_t first = 0;     // number of the packet's first record
    uint16_t count = 0, flags = 0;
};
template <class Stream, class Head>
void visitStreamHead(Stream& stream, Head& head) {
    stream.numbers(head.outdated, head.step, head.records, head.first, head.count, head.flags);
}

// Runs of records that a client has behind a gap, at most so many in a status.
constexpr size_t kMaxRuns = 64;
struct RecordRun {
    uint32_t first = 0, end = 0;
};
struct RecordRuns {
    std::array<RecordRun, kMaxRuns> list;
    uint16_t count = 0;
    // The record, or the first behind the run that it is in.
    [[nodiscard]] uint32_t pastRun(uint32_t record) const noexcept;
};

struct Status {             // of a client
    uint16_t request = 0;   // Request
    uint32_t loaded = 0;    // id of the state that it loaded last; 0: none
    uint32_t next = 0;      // it has all records before this one
    uint32_t step = 0;      // of its world
    uint32_t answered = 0;  // sequence of the newest packet that it has
    // The part of a state that the client has: the id, all pieces before `base`, and those of
    // the bits behind it.
    uint32_t state = 0, base = 0;
    uint64_t came = 0;
    RecordRuns runs;  // of records that it has behind `next`
};
// Runs are gaps and lengths of 16 bits. A Reader throws where they can be none.
template <class Stream, class S>
void visitStatus(Stream& stream, S& s) {
    stream.numbers(s.request, s.loaded, s.next, s.step, s.answered, s.state, s.base, s.came,
                   s.runs.count);
    if constexpr (Stream::kReads)
        if (s.runs.count > kMaxRuns || stream.left() != s.runs.count * 2 * sizeof(uint16_t))
            core::failData(
                "The packet's status has %u runs of records in %zu bytes; a status has "
                "at most %u, of 4 bytes each.",
                uint32_t(s.runs.count), stream.left(), uint32_t(kMaxRuns));
    uint32_t at = s.next;
    for (uint16_t i = 0; i < s.runs.count; ++i) {
        auto& run = s.runs.list[i];
        auto gap = uint16_t(run.first - at), length = uint16_t(run.end - run.first);
        stream.numbers(gap, length);
        if (gap == 0 || length == 0 || uint64_t(at) + gap + length > 0xFFFFFFFFu)
            core::failData("The packet's status has a run of %u records, %u behind record %u.",
                           uint32_t(length), uint32_t(gap), at);
        run = {at + gap, at + gap + length};
        at = run.end;
    }
}

enum class RecordKind : uint8_t {
    command,
    hashes,
    message,
    capture,  // the server saved its state here, as number `tick`
    skipped,  // `tick` records from this one on are not sent: a state stands for them
    count
};

struct Record {
    RecordKind kind = RecordKind::count;
    uint32_t step = 0;
    world::Command command;
    // Of one round, which a tick names: slots `first`, `first` + `stride` and so on.
    uint64_t tick = 0;
    uint32_t first = 0, stride = 1;
    std::array<uint64_t, world::kMaxHashes> hashes{};
    uint32_t hashCount = 0;
    std::span<const std::byte> message;
};

void writeRecord(const Record& record, std::pmr::vector<std::byte>& out);
// Throws unless writeRecord wrote the bytes. A message of the record points into them.
void readRecord(std::span<const std::byte> bytes, Record& record);

// Records by their number since the beginning: those from begin() on, and of those before it the
// messages that some client still needs.
class RecordLog {
 public:
    explicit RecordLog(std::pmr::memory_resource* memory)
        : marks_(memory), bytes_(memory), kept_(memory) {}
    [[nodiscard]] uint32_t begin() const noexcept { return first_; }
    [[nodiscard]] uint32_t end() const noexcept { return first_ + uint32_t(marks_.size() - gone_); }
    [[nodiscard]] std::span<const std::byte> at(uint32_t record) const noexcept {
        const size_t i = record - first_ + gone_;
        const size_t from = i == 0 ? 0 : marks_[i - 1].end;
        return std::span(bytes_).subspan(from, marks_[i].end - from);
    }
    [[nodiscard]] bool isMessage(uint32_t record) const noexcept {
        return at(record)[0] == std::byte(RecordKind::message);
    }
    // When it was pushed, s.
    [[nodiscard]] double pushedAt(uint32_t record) const noexcept {
        return marks_[record - first_ + gone_].at;
    }
    // Of records from this one on; `record` in [begin, end].
    [[nodiscard]] size_t bytesFrom(uint32_t record) const noexcept {
        return bytes_.size() - markBefore(record).end;
    }
    // Of those, the bytes that are no messages, for which a state can stand.
    [[nodiscard]] size_t skippableFrom(uint32_t record) const noexcept {
        return marks_.empty() ? 0 : marks_.back().skippable - markBefore(record).skippable;
    }
    [[nodiscard]] size_t bytes() const noexcept { return bytesFrom(first_); }
    [[nodiscard]] size_t keptBytes() const noexcept { return keptBytes_; }
    // The first record that at most `most` bytes follow.
    [[nodiscard]] uint32_t recordBeforeLast(size_t most) const noexcept;

    void push(const Record& record, double now);  // unchanged when it throws
    // Messages from `messagesFrom` on are kept; where memory for that ends it throws, with those
    // before the one at fault dropped.
    void dropBefore(uint32_t record, uint32_t messagesFrom);
    void dropMessagesBefore(uint32_t record) noexcept;
    // Of the oldest message that is kept behind begin().
    uint32_t dropOldestMessage() noexcept;

    struct Entry {
        std::span<const std::byte> bytes;  // empty: `count` records are skipped
        uint32_t count = 1;
    };
    // The message to send at `record`, in [0, end): records before `skipsBefore` are skipped unless
    // they are messages, and those that are gone are skipped in any case.
    [[nodiscard]] Entry entryAt(uint32_t record, uint32_t skipsBefore) const noexcept;

 private:
    struct Mark {
        size_t end = 0, skippable = 0;  // bytes up to the end of a record, and those of no message
        double at = 0;                  // s
    };
    struct Kept {
        uint32_t record = 0;
        std::pmr::vector<std::byte> bytes;
    };
    [[nodiscard]] Mark markBefore(uint32_t record) const noexcept {
        const size_t i = record - first_ + gone_;
        return i == 0 ? Mark{} : marks_[i - 1];
    }

    uint32_t first_ = 0;  // number of the first that is kept
    size_t gone_ = 0;     // entries before it that still lie here
    std::pmr::vector<Mark> marks_;
    std::pmr::vector<std::byte> bytes_;
    std::pmr::deque<Kept> kept_;  // messages before first_
    size_t keptBytes_ = 0;
};

}  // namespace fw::net
