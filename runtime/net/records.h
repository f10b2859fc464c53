// What a server tells its clients in order, none left out: deeds, hashes of objects, the host's own
// messages, where a state was saved; each with the step before which it belongs.
#pragma once
#include "core/stream.h"
#include "world/journal.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace fw::net {

constexpr uint32_t kMessageMost = 1024;  // bytes of a host's message
static_assert(kMessageMost == sizeof FwNetTurn::message);

enum class RecordKind : uint8_t {
    deed,
    hashes,
    message,
    capture,  // the server saved its state here, as number `tick`
    count
};

struct Record {
    RecordKind kind = RecordKind::count;
    uint32_t step = 0;
    world::Deed deed;
    // Of one round, which a tick names: slots `first`, `first` + `stride` and so on.
    uint64_t tick = 0;
    uint32_t first = 0, stride = 1;
    std::array<uint64_t, world::kMostHashes> hashes{};
    uint32_t hashCount = 0;
    std::span<const std::byte> message;
};

void writeRecord(const Record& record, std::pmr::vector<std::byte>& out);
// Throws where the bytes are none of writeRecord's; a message lies in them.
void readRecord(std::span<const std::byte> bytes, Record& record);

// Those that some client still needs, by their number since the beginning.
class RecordLog {
 public:
    explicit RecordLog(std::pmr::memory_resource* memory) : ends_(memory), bytes_(memory) {}
    [[nodiscard]] uint32_t begin() const noexcept { return first_; }
    [[nodiscard]] uint32_t end() const noexcept { return first_ + uint32_t(ends_.size() - gone_); }
    [[nodiscard]] std::span<const std::byte> at(uint32_t record) const noexcept {
        const size_t i = record - first_ + gone_;
        const size_t from = i == 0 ? 0 : ends_[i - 1];
        return std::span(bytes_).subspan(from, ends_[i] - from);
    }
    [[nodiscard]] size_t bytes() const noexcept {
        return bytes_.size() - (gone_ == 0 ? 0 : ends_[gone_ - 1]);
    }
    void push(const Record& record);            // unchanged when it throws
    void dropBefore(uint32_t record) noexcept;  // in [begin, end]

 private:
    uint32_t first_ = 0;  // number of the first that is kept
    size_t gone_ = 0;     // entries before it that still lie here
    std::pmr::vector<size_t> ends_;
    std::pmr::vector<std::byte> bytes_;
};

}  // namespace fw::net
