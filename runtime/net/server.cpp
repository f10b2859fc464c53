#include "net/server.h"

#include "components/burnable_mesh.h"

#include <algorithm>

namespace fw::net {
namespace {

constexpr double kCaptureAge = 10;                    // s that a state may be given away for
constexpr size_t kLogMost = size_t(8) * 1024 * 1024;  // bytes that wait for who does not answer
constexpr double kIdentityAge = 0.5;                  // s
constexpr size_t kStreamHead = 18, kRecordHead = 2;   // bytes

}  // namespace

void checkNetDef(const FwNetDef& def) {
    using components::checkValue;
    const auto check = [](uint32_t value, const char* name, uint32_t low, uint32_t high) {
        if (value < low || value > high)
            core::fail(FW_ERROR_INVALID_ARGUMENT, "FwNetDef::%s is %u; the limits are [%u, %u].",
                       name, value, low, high);
    };
    check(def.flags, "flags", 0, 0);
    check(def.reserved, "reserved", 0, 0);
    check(def.token, "token", 1, 0xFFFFFFFFu);
    check(def.packetBytes, "packetBytes", kPacketLeast, kPacketMost);
    check(def.bytesPerSecond, "bytesPerSecond", 4000, 100000000);
    checkValue(def.delay, "FwNetDef::delay", 0.0f, 10.0f);
    checkValue(def.interval, "FwNetDef::interval", 1.0f / 64, 1.0f);
}

Server::Server(const FwNetDef& def, world::World& world, std::pmr::memory_resource* memory)
    : def_(def),
      memory_(memory),
      peers_("Peer", memory),
      journal_(world.keepJournal(false)),
      log_(memory),
      captured_(memory),
      packet_(memory) {
    packet_.reserve(kPacketMost);
    step_ = uint32_t(world.tick() / gpu::kStepTicks);
}

FwPeerId Server::addPeer() {
    if (peers_.live() >= kMostPeers)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "%u peers are there; the limit is %u.", peers_.live(),
                   kMostPeers);
    return peers_.create(memory_);
}

// ---- records ------------------------------------------------------------------------------------

void Server::loseAll() noexcept {
    log_.dropBefore(log_.end());
    capture_ = {};
    captureNoted_ = capturing_ = false;
    for (uint32_t i = 0; i < peers_.slotCount(); ++i)
        if (Peer* peer = peers_.at(i)) {
            peer->chunks.end();
            peer->anew = peer->token != 0;
            peer->streams = false;
        }
}

void Server::push(const Record& record) {
    try {
        log_.push(record);
    } catch (...) {
        loseAll();
    }
}

// What the world noted since.
void Server::drain(world::World& world) {
    const auto now = uint32_t(world.tick() / gpu::kStepTicks);
    if (journal_.lost || journal_.loaded) {
        journal_.lost = journal_.loaded = false;
        loseAll();
    }
    const auto noteCapture = [&] {
        journal_.captured = false;
        captureNoted_ = capturing_;
        if (!capturing_) return;
        record_.kind = RecordKind::capture;
        record_.step = uint32_t(journal_.capturedAt / gpu::kStepTicks);
        record_.tick = ++captures_;
        push(record_);
        noted_.id = 2 * captures_;
        noted_.step = record_.step;
        noted_.record = log_.end();
    };
    for (size_t i = 0; i < journal_.deeds.size(); ++i) {
        if (journal_.captured && i == journal_.capturedBehind) noteCapture();
        record_.kind = RecordKind::deed;
        record_.step = uint32_t(journal_.deeds[i].tick / gpu::kStepTicks);
        record_.deed = journal_.deeds[i].deed;
        push(record_);
    }
    if (journal_.captured) noteCapture();
    journal_.deeds.clear();
    // Hashes of one tick are of one round; those of slots without an object are 0.
    const std::pmr::vector<world::ObjectHash>& hashes = journal_.hashes;
    for (size_t i = 0; i < hashes.size();) {
        record_.kind = RecordKind::hashes;
        record_.step = now;
        record_.tick = hashes[i].tick;
        record_.first = hashes[i].slot;
        record_.stride = hashes[i].stride;
        record_.hashCount = 0;
        record_.hashes.fill(0);
        for (; i < hashes.size() && hashes[i].tick == record_.tick; ++i) {
            const uint32_t at = (hashes[i].slot - record_.first) / record_.stride;
            if (hashes[i].slot < record_.first || at >= record_.hashes.size()) break;
            record_.hashes[at] = hashes[i].hash;
            record_.hashCount = std::max(record_.hashCount, at + 1);
        }
        if (record_.hashCount == 0) break;
        push(record_);
    }
    journal_.hashes.clear();
    step_ = now;
    stepEnd_ = log_.end();
}

void Server::tell(world::World& world, std::span<const std::byte> message) {
    if (message.size() > kMessageMost || message.size() + 64 > def_.packetBytes)
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "The message has %zu bytes; the limit is %u, and FwNetDef::packetBytes less 64.",
                   message.size(), kMessageMost);
    drain(world);
    record_.kind = RecordKind::message;
    record_.step = step_;
    record_.message = message;
    log_.push(record_);
    stepEnd_ = log_.end();
}

// ---- states -------------------------------------------------------------------------------------

void Server::takeCapture(world::World& world) {
    const auto each = [&](const auto& visit) {
        for (uint32_t i = 0; i < peers_.slotCount(); ++i)
            if (Peer* peer = peers_.at(i)) visit(*peer);
    };
    bool wished = false, given = false, stale = false;
    each([&](const Peer& peer) {
        wished |= peer.wish == Wish::state && !peer.chunks.active();
        stale |= peer.wish == Wish::tiles && peer.stale;
        given |= peer.chunks.active() && peer.tilesHead.id == 0;
    });
    if (capturing_ && captureNoted_)
        if (const std::pmr::vector<std::byte>* bytes = world.fetchSave(world::SaveFor::net)) {
            captured_.assign(bytes->begin(), bytes->end());
            capture_ = noted_;
            capture_.size = uint32_t(captured_.size());
            capturedAt_ = now_;
            capturing_ = captureNoted_ = false;
        }
    const bool old = now_ - capturedAt_ > kCaptureAge;
    if (capture_.id != 0 && old && !given) capture_.id = 0;
    if ((wished && capture_.id == 0) || (stale && !given)) {
        if (!capturing_) {
            world.requestSave(world::SaveFor::net);
            capturing_ = true;
            captureNoted_ = false;
        }
        if (!captureNoted_) each([](Peer& peer) { peer.stale = false; });
    }
    if (capture_.id == 0 || old || capturing_) return;
    const size_t room = def_.packetBytes - kPacketHead - kChunkHead;
    each([&](Peer& peer) {
        if (peer.wish != Wish::state || peer.chunks.active()) return;
        peer.tilesHead = {};
        peer.chunks.begin(uint32_t((captured_.size() + room - 1) / room));
    });
}

// Records that nobody needs any more go; who lets too many wait needs a state.
void Server::trim() noexcept {
    if (log_.bytes() > kLogMost) {
        if (capture_.id != 0 || capturing_) capture_.id = 0, capturing_ = captureNoted_ = false;
        for (uint32_t i = 0; i < peers_.slotCount(); ++i)
            if (Peer* peer = peers_.at(i); peer && peer->token != 0) {
                peer->chunks.end();
                if (peer->streams && peer->acknowledged >= log_.end() - 64) continue;
                peer->streams = false;
                peer->anew = true;
            }
    }
    uint32_t needed = log_.end();
    if (capture_.id != 0) needed = std::min(needed, capture_.record);
    if (captureNoted_) needed = std::min(needed, noted_.record);
    for (uint32_t i = 0; i < peers_.slotCount(); ++i) {
        const Peer* peer = peers_.at(i);
        if (peer && peer->streams) needed = std::min(needed, peer->acknowledged);
        if (peer && peer->chunks.active() && peer->tilesHead.id != 0)
            needed = std::min(needed, std::max(peer->tilesHead.record, log_.begin()));
    }
    if (needed > log_.begin()) log_.dropBefore(needed);
}

// ---- packets ------------------------------------------------------------------------------------

void Server::update(world::World& world, float seconds) {
    now_ += double(seconds);
    drain(world);
    if (now_ - identityAt_ > kIdentityAge || identityAt_ < 0) {
        identity_ = world.identity();
        identityAt_ = now_;
    }
    takeCapture(world);
    trim();
    for (uint32_t i = 0; i < peers_.slotCount(); ++i) {
        Peer* peer = peers_.at(i);
        if (!peer || peer->token == 0) continue;
        peer->silent += double(seconds);
        peer->budget = std::min(peer->budget + double(seconds) * def_.bytesPerSecond,
                                std::max(0.25 * def_.bytesPerSecond, 2.0 * def_.packetBytes));
        peer->untilDue -= double(seconds);
        if (peer->untilDue > 1e-4) continue;
        peer->untilDue = std::max(peer->untilDue + double(def_.interval), 0.0);
        peer->due = true;
        if (peer->cursor >= log_.end() || peer->cursor < peer->acknowledged)
            peer->cursor = peer->acknowledged;
    }
}

PacketHead Server::headOf(Peer& peer, PacketKind kind) const noexcept {
    return {kind, def_.token, peer.token, ++peer.sent};
}

// The first of a turn says how far the server is, even without a record.
bool Server::writeStream(Peer& peer) {
    const bool more = peer.streams && peer.cursor < log_.end() && peer.budget > 0;
    if (!peer.due && !more) return false;
    if (!peer.due && peer.cursor == peer.acknowledged) return false;  // of the next turn
    core::Writer writer = beginPacket(packet_, headOf(peer, PacketKind::stream));
    const uint32_t first = peer.streams ? peer.cursor : 0;
    uint16_t count = 0;
    size_t bytes = kPacketHead + kStreamHead;
    if (peer.streams)
        while (first + count < log_.end()) {
            const size_t next = log_.at(first + count).size() + kRecordHead;
            if (bytes + next > def_.packetBytes) break;
            bytes += next;
            ++count;
        }
    writer.number(peer.anew ? peer.loads + 1 : 0);  // a state: whose number it will be
    writer.number(step_);
    writer.number(stepEnd_);
    writer.number(first);
    writer.number(count);
    for (uint32_t i = first; i < first + count; ++i) {
        const std::span<const std::byte> record = log_.at(i);
        writer.number(uint16_t(record.size()));
        packet_.insert(packet_.end(), record.begin(), record.end());
    }
    if (peer.streams) peer.cursor += count;
    peer.due = false;
    return true;
}

bool Server::writeChunks(Peer& peer) {
    if (!peer.chunks.active() || peer.budget <= 0) return false;
    const uint32_t piece = peer.chunks.next(now_);
    if (piece == peer.chunks.count()) return false;
    core::Writer writer = beginPacket(packet_, headOf(peer, PacketKind::chunk));
    const auto each = uint16_t(def_.packetBytes - kPacketHead - kChunkHead);
    const bool tiles = peer.tilesHead.id != 0;
    writeChunk(writer, {tiles ? peer.tilesHead : capture_, piece, each},
               tiles ? peer.tiles : captured_);
    peer.chunks.sent(piece, now_);
    return true;
}

bool Server::write(FwPeerId to, std::span<std::byte> room, uint32_t& size) {
    Peer& peer = peers_.get(to);
    if (room.size() < def_.packetBytes)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "*size is %zu and a packet has up to %u bytes.",
                   room.size(), def_.packetBytes);
    if (peer.token == 0) return false;
    if (peer.welcome) {
        core::Writer writer = beginPacket(packet_, headOf(peer, PacketKind::welcome));
        writer.number(identity_);
        peer.welcome = false;
    } else if (!writeStream(peer) && !writeChunks(peer)) {
        return false;
    }
    sealPacket(packet_);
    std::copy(packet_.begin(), packet_.end(), room.begin());
    size = uint32_t(packet_.size());
    peer.budget -= double(size);
    peer.traffic.bytesOut += size;
    ++peer.traffic.packetsOut;
    return true;
}

void Server::read(world::World& world, FwPeerId from, std::span<const std::byte> packet) {
    Peer& peer = peers_.get(from);
    core::Reader reader(packet, "packet");
    const PacketHead head = openPacket(packet, reader);
    if (head.client == 0 || (peer.token != 0 && head.client != peer.token))
        core::fail(FW_ERROR_BAD_DATA,
                   "The packet is of a client with token 0x%08X; peer %u has 0x%08X. Remove the "
                   "peer if another one came in its place.",
                   head.client, from.index1, peer.token);
    if (!peer.came.isNew(head.sequence)) {
        ++peer.traffic.ignored;
        return;
    }
    if (head.kind == PacketKind::hello) {
        if (reader.left() != 0 || head.session != 0)
            core::fail(FW_ERROR_BAD_DATA, "The packet greets with %zu bytes in session 0x%08X.",
                       reader.left(), head.session);
        peer.token = head.client;
        peer.welcome = true;
    } else if ((head.kind != PacketKind::status && head.kind != PacketKind::tiles) ||
               head.session != def_.token || peer.token == 0) {
        core::fail(FW_ERROR_BAD_DATA,
                   "The packet of kind %u is of session 0x%08X; a server takes a client's, of "
                   "session 0x%08X.",
                   uint32_t(head.kind), head.session, def_.token);
    } else if (head.kind == PacketKind::tiles) {
        readTiles(world, peer, reader);
    } else {
        readStatus(world, peer, reader, head.sequence);
    }
    (void)peer.came.take(head.sequence);
    peer.silent = 0;
    peer.traffic.bytesIn += packet.size();
    ++peer.traffic.packetsIn;
}

void Server::readStatus(world::World& world, Peer& peer, core::Reader& reader, uint32_t sequence) {
    uint16_t wish = 0;
    uint32_t loads = 0, next = 0, step = 0, state = 0, base = 0;
    uint64_t came = 0;
    reader.number(wish), reader.number(loads), reader.number(next), reader.number(step);
    reader.number(state), reader.number(base), reader.number(came);
    if (reader.left() != 0 || wish >= uint16_t(Wish::count))
        core::fail(FW_ERROR_BAD_DATA, "%zu bytes follow a status in the packet, with wish %u.",
                   reader.left(), uint32_t(wish));
    drain(world);
    const uint32_t given = peer.tilesHead.id != 0 ? peer.tilesHead.id : capture_.id;
    if (peer.chunks.active() && state == given && !peer.chunks.acknowledge(base, came))
        core::fail(FW_ERROR_BAD_DATA, "The packet acknowledges piece %u of a state of %u.", base,
                   peer.chunks.count());
    if (!peer.came.isNewest(sequence)) return;  // it knows less
    if (loads != peer.loads) {                  // it has another state, and goes on from there
        peer.loads = loads;
        peer.anew = false;
        peer.cursor = std::min(next, log_.end());
        peer.chunks.end();
    }
    // Of what never was, or is gone: it needs all of it anew.
    peer.anew |= loads > 0 && (next < log_.begin() || next > log_.end());
    peer.streams = loads > 0 && !peer.anew;
    if (peer.streams) peer.acknowledged = next;
    peer.step = step;
    const Wish before = peer.wish;
    peer.wish = Wish(wish);
    if (peer.wish != before) {
        peer.chunks.end();
        peer.stale = peer.wish == Wish::tiles;
    }
}

// It has a save of its own of the tick that the capture is of.
void Server::readTiles(world::World& world, Peer& peer, core::Reader& reader) {
    uint32_t number = 0, slot = 0;
    reader.number(number), reader.number(slot);
    std::array<uint32_t, world::kMostBlocks> hashes{};
    const size_t count = reader.left() / sizeof(uint32_t);
    if (count > hashes.size())
        core::fail(FW_ERROR_BAD_DATA, "The packet has hashes of %zu blocks; the limit is %zu.",
                   count, hashes.size());
    for (size_t i = 0; i < count; ++i) reader.number(hashes[i]);
    if (reader.left() != 0)
        core::fail(FW_ERROR_BAD_DATA, "%zu bytes follow the hashes in the packet.", reader.left());
    if (peer.wish != Wish::tiles || capture_.id != 2 * number || number == 0 ||
        peer.tilesOf == number)
        return;  // not yet, not any more, or they are on their way
    peer.tilesOf = number;
    if (!world.writeBlocks(captured_, slot, std::span(hashes).first(count), peer.tiles)) return;
    peer.tilesHead = capture_;
    peer.tilesHead.id = capture_.id + 1;
    peer.tilesHead.size = uint32_t(peer.tiles.size());
    const size_t room = def_.packetBytes - kPacketHead - kChunkHead;
    peer.chunks.begin(uint32_t((peer.tiles.size() + room - 1) / room));
}

void Server::fillState(world::World& world, FwPeerId id, FwNetState& state) {
    state.role = FW_NET_SERVER;
    state.step = world.tick() / gpu::kStepTicks;
    const auto add = [&](const Peer& peer) {
        ++state.peers;
        addTraffic(peer.traffic, state);
        state.states += peer.loads;
        if (peer.streams) state.records = std::max(state.records, log_.end() - peer.acknowledged);
    };
    if (id.index1 != 0) {
        const Peer& peer = peers_.get(id);
        add(peer);
        state.phase = peer.token == 0 ? FW_NET_CALLING
                      : peer.streams  ? FW_NET_FOLLOWING
                                      : FW_NET_LOADING;
        state.heardStep = peer.step;
        state.behind = float(double(state.step - std::min<uint64_t>(state.step, peer.step)) / 32);
        state.silent = float(peer.silent);
        return;
    }
    for (uint32_t i = 0; i < peers_.slotCount(); ++i)
        if (const Peer* peer = peers_.at(i)) add(*peer);
    state.phase = FW_NET_FOLLOWING;
    state.heardStep = state.step;
}

}  // namespace fw::net
