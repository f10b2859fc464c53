#include "net/packet.h"

#include "core/hash.h"

#include <algorithm>

namespace fw::net {
namespace {

constexpr uint32_t kMagic = 0x504E5746u;  // "FWNP"
constexpr size_t kSumAt = 8;              // behind magic, version and kind

// Of all bytes but the sum's own.
uint32_t sumOf(std::span<const std::byte> packet) noexcept {
    const uint64_t head = core::hashBytes(packet.first(kSumAt));
    const uint64_t hash = core::hashBytes(packet.subspan(kSumAt + sizeof(uint32_t)), head);
    return uint32_t(hash) ^ uint32_t(hash >> 32);
}

}  // namespace

core::Writer beginPacket(std::pmr::vector<std::byte>& out, const PacketHead& head) {
    out.clear();
    core::Writer writer(out);
    writer.numbers(kMagic, uint16_t(kPacketVersion), uint16_t(head.kind), uint32_t(0), head.session,
                   head.client, head.sequence);
    return writer;
}

void sealPacket(std::span<std::byte> packet) noexcept {
    const uint32_t sum = sumOf(packet);
    for (size_t k = 0; k < sizeof sum; ++k) packet[kSumAt + k] = std::byte(sum >> (8 * k));
}

PacketHead openPacket(std::span<const std::byte> packet, core::Reader& reader) {
    if (packet.size() < kPacketHead || packet.size() > kMaxPacket)
        core::failData("The packet has %zu bytes; the limits are [%zu, %zu].", packet.size(),
                       kPacketHead, kMaxPacket);
    uint32_t magic = 0, sum = 0;
    uint16_t version = 0, kind = 0;
    PacketHead head;
    reader.numbers(magic, version, kind, sum, head.session, head.client, head.sequence);
    if (magic != kMagic)
        core::failData("The packet begins with 0x%08X; 0x%08X (\"FWNP\") is expected.", magic,
                       kMagic);
    if (version != kPacketVersion)
        core::fail(FW_ERROR_VERSION,
                   "The packet has version %u; this library has version %u. Both sides need the "
                   "same library.",
                   uint32_t(version), kPacketVersion);
    const uint32_t found = sumOf(packet);
    if (sum != found)
        core::failData("The packet's checksum is 0x%08X; its head says 0x%08X.", found, sum);
    if (kind >= uint16_t(PacketKind::count))
        core::failData("The packet is of kind %u; the limit is %u.", uint32_t(kind),
                       uint32_t(PacketKind::count) - 1);
    head.kind = PacketKind(kind);
    return head;
}

void endPacket(const core::Reader& reader, const char* body) {
    if (reader.left() != 0)
        core::failData("%zu bytes follow %s of the packet.", reader.left(), body);
}

bool Link::isFresh(uint32_t sequence) noexcept {
    if (!came.isNew(sequence) && silent > kMaxSilent && sequence > 0) came.restartAt(sequence);
    if (came.isNew(sequence)) return true;
    ++ignored;
    return false;
}

void Link::accept(uint32_t sequence, size_t bytes) noexcept {
    (void)came.take(sequence);
    silent = 0;
    bytesIn += bytes;
    ++packetsIn;
}

uint32_t Link::send(std::span<std::byte> packet, std::span<std::byte> room) noexcept {
    FW_ASSERT(packet.size() >= kPacketHead && packet.size() <= room.size(), "%zu of %zu bytes",
              packet.size(), room.size());
    sealPacket(packet);
    std::copy(packet.begin(), packet.end(), room.begin());
    bytesOut += packet.size();
    ++packetsOut;
    return uint32_t(packet.size());
}

void Link::addTo(FwNetState& state) const noexcept {
    state.bytesOut += bytesOut;
    state.bytesIn += bytesIn;
    state.packetsOut += packetsOut;
    state.packetsIn += packetsIn;
    state.packetsIgnored += ignored;
    state.packetsRefused += refused;
}

}  // namespace fw::net
