// A state on its way, piece by piece: what is lost is sent again, what comes twice is known.
#pragma once
#include "net/packet.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace fw::net {

constexpr uint32_t kChunkWindow = 64;               // pieces on their way at most
constexpr uint32_t kMaxState = 256u * 1024 * 1024;  // bytes of a state
constexpr size_t kMinChunk = 256;                   // bytes of a piece

// The request of a client.
enum class Request : uint16_t { nothing, state, tiles, count };

struct StateHead {        // of a state
    uint32_t id = 0;      // twice the number of the capture; and 1: tiles of it. 0: none
    uint32_t step = 0;    // it is of this step's start
    uint32_t record = 0;  // the first record behind it
    uint32_t size = 0;    // bytes
};
struct ChunkHead {
    StateHead state;
    uint32_t index = 0;
    uint16_t bytes = 0;  // of each piece but the last
};
constexpr size_t kChunkHead = 22;  // bytes

void writeChunk(core::Writer& writer, const ChunkHead& head, std::span<const std::byte> state);
// Throws where it can be none.
std::span<const std::byte> readChunk(core::Reader& reader, ChunkHead& head);

// The sender's side: which piece is next.
class ChunkSender {
 public:
    void begin(uint32_t count) noexcept;
    [[nodiscard]] bool active() const noexcept { return count_ != 0; }
    void end() noexcept { count_ = 0; }
    // May the other side have all before `base`, and those behind it that have a bit? Only pieces
    // that were sent can have come.
    [[nodiscard]] bool canHave(uint32_t base, uint64_t came) const noexcept;
    // canHave. Packets before number `answered` came or are lost: pieces in them that did not come
    // are due again.
    void acknowledge(uint32_t base, uint64_t came, uint32_t answered) noexcept;
    // A piece to send at `now` s; count: none is due. One that was sent is due again `after` s.
    [[nodiscard]] uint32_t next(double now, double after) const noexcept;
    void sent(uint32_t piece, double now, uint32_t packet) noexcept {
        sentAt_[piece % kChunkWindow] = now;
        sentIn_[piece % kChunkWindow] = packet;
        if (piece >= sentEnd_) sentEnd_ = piece + 1;
    }
    [[nodiscard]] bool allSent() const noexcept { return sentEnd_ == count_; }
    [[nodiscard]] uint32_t base() const noexcept { return base_; }
    [[nodiscard]] uint32_t count() const noexcept { return count_; }
    [[nodiscard]] uint32_t sentEnd() const noexcept { return sentEnd_; }

 private:
    uint32_t count_ = 0, base_ = 0, sentEnd_ = 0;
    uint64_t came_ = 0;  // bit i: base_ + i
    std::array<double, kChunkWindow> sentAt_{};
    std::array<uint32_t, kChunkWindow> sentIn_{};  // number of the packet
};

// The receiver's side.
class ChunkReceiver {
 public:
    explicit ChunkReceiver(std::pmr::memory_resource* memory) : bytes_(memory) {}
    void forget() noexcept;
    // False: it is none of the state that the others are of. A piece of another state counts only
    // in the `newest` packet: the sender is at one state at a time.
    bool take(const ChunkHead& head, std::span<const std::byte> piece, bool newest);
    [[nodiscard]] const StateHead& state() const noexcept { return state_; }
    [[nodiscard]] bool whole() const noexcept { return state_.id != 0 && base_ == count_; }
    [[nodiscard]] uint32_t base() const noexcept { return base_; }
    [[nodiscard]] uint64_t came() const noexcept { return came_; }
    [[nodiscard]] std::span<const std::byte> bytes() const noexcept { return bytes_; }

 private:
    StateHead state_;
    uint32_t count_ = 0, base_ = 0;
    uint16_t chunkBytes_ = 0;
    uint64_t came_ = 0;  // bit i: base_ + i
    std::pmr::vector<std::byte> bytes_;
};

}  // namespace fw::net
