// Packets between a server and its clients: a head with their session, a checksum over the whole
// packet, and a body by kind. Packets that are damaged, cut, of another session or duplicates are
// refused before any of their content is used. The checksum finds damage, not forgery: hosts that
// need authenticity encrypt their packets.
#pragma once
#include "core/stream.h"
#include "flamewright/flamewright.h"

#include <cstdint>
#include <span>
#include <vector>

namespace fw::net {

enum class PacketKind : uint8_t {
    hello,    // client: who is there?
    welcome,  // server: of which world it is
    status,   // client: what came, and what it wants
    stream,   // server: records, and how far it is
    chunk,    // server: a piece of a state
    tiles,    // client: hashes of what it has of an object, for the parts that differ
    count
};

struct PacketHead {
    PacketKind kind = PacketKind::count;
    uint32_t session = 0;   // the server's token; 0: not known yet
    uint32_t client = 0;    // the client's token
    uint32_t sequence = 0;  // from 1 on, of all packets that went this way
};

constexpr uint32_t kPacketVersion = 3;
constexpr size_t kPacketHead = 24;                     // bytes
constexpr size_t kMinPacket = 512, kMaxPacket = 1400;  // that packets have at most

// Begins a packet in `out`, whose room is kept.
core::Writer beginPacket(std::pmr::vector<std::byte>& out, const PacketHead& head);
// Writes the checksum of a complete packet.
void sealPacket(std::span<std::byte> packet) noexcept;
// Throws unless it is a packet; the reader is then behind the head.
PacketHead openPacket(std::span<const std::byte> packet, core::Reader& reader);
// Throws unless all of the packet is read. `body`: what ends here.
void endPacket(const core::Reader& reader, const char* body);

// s without an accepted packet: a packet that seems old then restarts the sequence, since its
// newest number may have been wrong.
constexpr double kMaxSilent = 3;

// The packets of a sequence that have arrived. Those far behind the newest count as arrived.
class SequenceWindow {
 public:
    [[nodiscard]] bool isNew(uint32_t sequence) const noexcept {
        if (sequence > newest_) return sequence - newest_ <= kLeap;
        const uint32_t behind = newest_ - sequence;
        return sequence > 0 && behind < 64 && (seen_ >> behind & 1) == 0;
    }
    [[nodiscard]] bool isNewest(uint32_t sequence) const noexcept { return sequence > newest_; }
    [[nodiscard]] uint32_t newest() const noexcept { return newest_; }
    // Sequences go on from this one, which is new.
    void restartAt(uint32_t sequence) noexcept {
        newest_ = sequence - 1;
        seen_ = 0;
    }
    // Marks a new packet as arrived. True: it is the newest.
    bool take(uint32_t sequence) noexcept {
        if (sequence <= newest_) {
            seen_ |= uint64_t(1) << (newest_ - sequence);
            return false;
        }
        const uint32_t ahead = sequence - newest_;
        seen_ = ahead < 64 ? seen_ << ahead | 1 : 1;
        newest_ = sequence;
        return true;
    }

 private:
    static constexpr uint32_t kLeap = 1u << 16;  // nobody loses so many at once
    uint32_t newest_ = 0;
    uint64_t seen_ = 0;  // bit i: newest_ - i
};

// One side's end of the way to the other side: sequences and traffic.
struct Link {
    uint32_t sent = 0;  // sequence of the last packet to the other side
    SequenceWindow came;
    double silent = 0;  // s since a packet was accepted
    uint64_t bytesOut = 0, bytesIn = 0, packetsOut = 0, packetsIn = 0;
    uint64_t ignored = 0;  // that came again, much too late, or faster than a peer may send
    uint64_t refused = 0;  // damaged, or with an impossible number

    // False: it came again, or much too late; it is counted as ignored.
    bool isFresh(uint32_t sequence) noexcept;
    // Counts a packet whose content was used.
    void accept(uint32_t sequence, size_t bytes) noexcept;
    // Seals a complete packet and copies it to `room`; returns its size.
    uint32_t send(std::span<std::byte> packet, std::span<std::byte> room) noexcept;
    void addTo(FwNetState& state) const noexcept;
};

}  // namespace fw::net
