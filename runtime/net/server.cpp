#include "net/server.h"

#include "components/burnable_mesh.h"
#include "host_limits.h"

#include "core/assert.h"

#include <algorithm>

namespace fw::net {
namespace {

constexpr double kCaptureAge = 10;  // s that a state may be given to a client that joins
// Saves for the sake of one peer: so many at once, then one each so many seconds.
constexpr double kCapturesAtOnce = 3, kCaptureEvery = 5;
constexpr double kCaptureRetry = 1;                   // s after a save that failed
constexpr size_t kMaxCaptures = 4;                    // at a time
constexpr size_t kMaxLog = size_t(8) * 1024 * 1024;   // bytes of records
constexpr size_t kMaxKept = size_t(4) * 1024 * 1024;  // bytes of messages before these
constexpr double kIdentityAge = 0.5;                  // s
constexpr size_t kStreamHead = 20, kRecordHead = 2;   // bytes
constexpr size_t kHashHead = 22, kSkipBytes = 14;  // bytes of a record of hashes, of skipped ones
constexpr double kChunkAgain = 0.25;               // s, where the rate has room to spare
// A peer whose oldest unanswered record is this old, and so many timeouts, is behind (s); where a
// state is less to send than what waits, it gets that.
constexpr double kBehind = 3, kBehindTimeouts = 3, kFallen = 5, kFallenTimeouts = 4;
constexpr size_t kMinFallen = 16 * 1024;  // bytes
constexpr double kFallEvery = 10;         // s
constexpr uint32_t kReordered = 3;        // packets by which one may overtake another
constexpr double kReportEvery = 30;       // s between two log lines about the same peer's rate
constexpr double kPacketsPerSecond = 512, kMaxPackets = 8192;  // from one peer

}  // namespace

void checkNetDef(const FwNetDef& def) {
    using components::checkValue, components::checkWhole;
    checkWhole(def.flags, "FwNetDef::flags", 0, 0);
    checkWhole(def.reserved, "FwNetDef::reserved", 0, 0);
    checkWhole(def.token, "FwNetDef::token", 1, 0xFFFFFFFFu);
    checkWhole(def.packetBytes, "FwNetDef::packetBytes", kMinPacket, kMaxPacket);
    checkWhole(def.bytesPerSecond, "FwNetDef::bytesPerSecond", 4000, 100000000);
    checkValue(def.delay, "FwNetDef::delay", 0.0f, 10.0f);
    checkValue(def.interval, "FwNetDef::interval", 1.0f / 64, 1.0f);
}

Server::Server(const FwNetDef& def, world::World& world, std::pmr::memory_resource* memory)
    : def_(def), memory_(memory), recording_(world.persistence().startRecording(false)) {
    packet_.reserve(kMaxPacket);
    captures_.reserve(kMaxCaptures + 1);
    step_ = uint32_t(world.tick() / gpu::kStepTicks);
}

FwPeerId Server::addPeer() {
    if (peers_.live() >= limits::kPeers)
        core::refuse("%u peers are there; the limit is %u.", peers_.live(), limits::kPeers);
    const FwPeerId id = peers_.create(memory_);
    peers_.get(id).packets = kMaxPackets;
    peers_.get(id).captures = kCapturesAtOnce;
    return id;
}

// ---- phases -------------------------------------------------------------------------------------

// The event is one that the phase has: packets are checked before.
void Server::move(Peer& peer, PeerEvent event) noexcept {
    const PeerPhase next = phaseAfter(peer.phase, event);
    if (next == peer.phase || next == kRefused) return;
    peer.phase = next;
    const PeerRule& rule = ruleOf(next);
    if (!rule.takes) {
        peer.chunks.end();
        peer.head = {};
        peer.tiles.clear();
        peer.capture = 0;
    }
    if (rule.waits) peer.requestedAt = peer.acknowledged;
}

// The records do not go on from its state: messages alone are sent until it has another one.
void Server::fall(Peer& peer) noexcept {
    if (ruleOf(peer.phase).hasState) peer.skips = true;
    move(peer, PeerEvent::falls);
    peer.fellAt = now_;
}

// ---- records ------------------------------------------------------------------------------------

void Server::endCapture() noexcept {
    capturing_ = captureRequested_ = false;
    for (auto [slot, peer] : peers_.entries())
        if (peer.phase == PeerPhase::waitsForTiles) peer.capture = 0;
}

// Records from this one on may still be needed, or messages alone.
uint32_t Server::neededFrom(bool messagesAlone) noexcept {
    uint32_t from = log_.end();
    for (auto [slot, peer] : peers_.entries()) {
        if (ruleOf(peer.phase).hasState && (messagesAlone || !peer.skips))
            from = std::min(from, peer.acknowledged);
        if (ruleOf(peer.phase).takes) from = std::min(from, peer.head.record);
    }
    for (const Capture& capture : captures_) from = std::min(from, capture.head.record);
    return captureRequested_ ? std::min(from, recorded_.record) : from;
}

void Server::dropLog(uint32_t record) noexcept {
    try {
        log_.dropBefore(record, neededFrom(true));
    } catch (...) {
        for (auto [slot, peer] : peers_.entries())
            if (ruleOf(peer.phase).hasState) ++peer.messagesLost;
        log_.dropBefore(record, log_.end());  // which needs no memory
    }
}

void Server::discardAll() noexcept {
    for (auto [slot, peer] : peers_.entries()) fall(peer);
    endCapture();
    captures_.clear();
    dropLog(log_.end());
}

void Server::append(const Record& record) {
    log_.push(record, now_);
    pushed_ += log_.at(log_.end() - 1).size();
}

void Server::push(const Record& record) {
    try {
        append(record);
    } catch (...) {
        discardAll();
    }
}

// Makes records of what the world recorded since the last call.
void Server::drain(world::World& world) {
    const auto now = uint32_t(world.tick() / gpu::kStepTicks);
    if (recording_.lost || recording_.loaded) {
        recording_.lost = recording_.loaded = false;
        discardAll();
    }
    const auto recordCapture = [&] {
        recording_.captured = false;
        captureRequested_ = capturing_;
        if (!capturing_) return;
        record_.kind = RecordKind::capture;
        record_.step = uint32_t(recording_.capturedAt / gpu::kStepTicks);
        record_.tick = ++captureCount_;
        push(record_);
        recorded_.id = 2 * captureCount_;
        recorded_.step = record_.step;
        recorded_.record = log_.end();
        for (auto [slot, peer] : peers_.entries())
            if (peer.phase == PeerPhase::waitsForTiles && peer.capture == 0)
                peer.capture = captureCount_;
    };
    for (size_t i = 0; i < recording_.commands.size(); ++i) {
        if (recording_.captured && i == recording_.capturedBehind) recordCapture();
        record_.kind = RecordKind::command;
        record_.step = uint32_t(recording_.commands[i].tick / gpu::kStepTicks);
        record_.command = recording_.commands[i].command;
        push(record_);
    }
    if (recording_.captured) recordCapture();
    recording_.commands.clear();
    // Hashes of one tick are of one round; those of slots without an object are 0. A record is no
    // longer than a packet.
    const std::pmr::vector<world::ObjectHash>& hashes = recording_.hashes;
    const size_t room = def_.packetBytes - kPacketHead - kStreamHead - kRecordHead - kHashHead;
    const size_t most = std::min(record_.hashes.size(), room / sizeof(uint64_t));
    FW_ASSERT(most > 0, "%u bytes", def_.packetBytes);
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
            if (hashes[i].slot < record_.first || at >= most) break;
            record_.hashes[at] = hashes[i].hash;
            record_.hashCount = std::max(record_.hashCount, at + 1);
        }
        if (record_.hashCount == 0) break;
        push(record_);
    }
    recording_.hashes.clear();
    step_ = now;
    stepEnd_ = log_.end();
}

void Server::sendMessage(world::World& world, std::span<const std::byte> message) {
    if (message.size() > kMaxMessage || message.size() + 64 > def_.packetBytes)
        core::refuse(
            "The message has %zu bytes; the limit is %u, and FwNetDef::packetBytes less 64.",
            message.size(), kMaxMessage);
    drain(world);
    record_.kind = RecordKind::message;
    record_.step = step_;
    record_.message = message;
    append(record_);
    stepEnd_ = log_.end();
}

// Drops the records that nobody needs any more. Where too many wait, those go as well, and the
// peers that have not got them need a state.
void Server::trim(const world::World& world) noexcept {
    uint32_t needed = neededFrom(false);
    if (log_.bytes() > kMaxLog) needed = std::max(needed, log_.recordBeforeLast(kMaxLog / 2));
    dropLog(std::max(needed, log_.begin()));
    for (auto [slot, peer] : peers_.entries())
        if (ruleOf(peer.phase).hasState && !peer.skips && peer.acknowledged < log_.begin()) {
            fall(peer);
            ++peer.resyncs;
        }
    log_.dropMessagesBefore(neededFrom(true));
    while (log_.keptBytes() > kMaxKept) {
        const uint32_t lost = log_.dropOldestMessage();
        for (auto [slot, peer] : peers_.entries()) {
            if (!ruleOf(peer.phase).hasState || peer.acknowledged > lost) continue;
            if (peer.messagesLost++ == 0)
                world.log().write(FW_LOG_WARNING,
                                  "Peer %u has not answered for %.1f s: of messages that wait, the "
                                  "server keeps %zu bytes, and this peer misses the others. Remove "
                                  "it, or send it what it missed in another way.",
                                  slot + 1, peer.link.silent, kMaxKept);
        }
    }
}

// Age of the oldest record that a peer has not got.
double Server::backlogOf(const Peer& peer) const noexcept {
    const uint32_t record = std::max(peer.acknowledged, log_.begin());
    if (!ruleOf(peer.phase).hasState || record >= log_.end()) return 0;
    return now_ - log_.pushedAt(record);
}

void Server::watchBacklog(const world::World& world, Peer& peer, uint32_t name) noexcept {
    const double backlog = backlogOf(peer), timeout = peer.trip.timeout();
    const double behind = kBehind + kBehindTimeouts * timeout;
    if (!peer.skips && backlog < behind / 2) peer.overloaded = false;
    if (!ruleOf(peer.phase).hasState || peer.skips || backlog < behind) return;
    const size_t bytes = log_.bytesFrom(peer.acknowledged);
    const bool silent = peer.link.silent > behind;
    if (!peer.overloaded && !silent) {
        peer.overloaded = true;
        if (now_ - peer.reportedAt < kReportEvery) return;
        peer.reportedAt = now_;
        world.log().write(
            FW_LOG_WARNING,
            "Peer %u is %.1f s behind and %zu bytes wait for it: its rate cannot carry "
            "the changes, which took %.0f bytes/s in the last seconds; "
            "FwNetDef::bytesPerSecond is %u. Change less, or raise the rate.",
            name, backlog, bytes, changeRate_, def_.bytesPerSecond);
    }
    const size_t least = std::max(kMinFallen, std::min(2 * stateBytes_, kMaxLog / 4));
    if (backlog < kFallen + kFallenTimeouts * timeout || now_ - peer.fellAt < kFallEvery ||
        log_.skippableFrom(peer.acknowledged) < least)
        return;
    fall(peer);
    ++peer.resyncs;
}

// ---- states -------------------------------------------------------------------------------------

Server::Capture* Server::captureOf(uint32_t number) noexcept {
    const auto at = std::ranges::find(captures_, number, &Capture::number);
    return at == captures_.end() ? nullptr : &*at;
}

template <class Part>
void Server::tryCapture(const world::World& world, const Part& part) noexcept {
    const auto fail = [&](const char* why) {
        endCapture();
        captureFailedAt_ = now_;
        world.log().write(FW_LOG_WARNING, "Peers wait for the state, which cannot be saved: %s",
                          why);
    };
    try {
        part();
    } catch (const core::Error& error) {
        fail(error.message);
    } catch (const std::bad_alloc&) {
        fail("Memory does not suffice.");
    }
}

void Server::fetchCapture(world::World& world) {
    if (!capturing_ || !captureRequested_) return;
    tryCapture(world, [&] {
        const std::pmr::vector<std::byte>* bytes =
            world.persistence().fetchSave(world::SaveFor::net);
        if (!bytes) return;
        if (bytes->size() > kMaxState)
            core::fail(FW_ERROR_OUT_OF_MEMORY, "The state has %zu bytes; the limit is %u.",
                       bytes->size(), kMaxState);
        FW_ASSERT(captures_.size() < captures_.capacity(), "%zu captures", captures_.size());
        captures_.push_back({recorded_, {bytes->begin(), bytes->end(), memory_}, now_});
        captures_.back().head.size = uint32_t(bytes->size());
        stateBytes_ = bytes->size();
        capturing_ = captureRequested_ = false;
    });
}

// Keeps those that a peer takes, and the newest as long as it may be given away.
void Server::dropCaptures() noexcept {
    while (captures_.size() > kMaxCaptures) {
        const uint32_t number = captures_.front().number();
        for (auto [slot, peer] : peers_.entries()) {
            if (peer.capture != number) continue;
            peer.capture = 0;
            if (peer.phase != PeerPhase::waitsForTiles) move(peer, PeerEvent::falls);
        }
        captures_.erase(captures_.begin());
    }
    const uint32_t newest = captures_.empty() ? 0 : captures_.back().number();
    std::erase_if(captures_, [&](const Capture& capture) {
        bool kept = capture.number() == newest && now_ - capture.at <= kCaptureAge;
        for (auto [slot, peer] : peers_.entries()) kept |= peer.capture == capture.number();
        return !kept;
    });
}

// Gives states to the peers that wait for one, and has the world save where there is none for them.
void Server::collectCaptures(world::World& world) {
    fetchCapture(world);
    dropCaptures();
    bool needed = false;
    for (auto [slot, peer] : peers_.entries()) {
        if (!ruleOf(peer.phase).waits || peer.capture != 0) continue;
        const uint32_t least = peer.skips ? peer.sentEnd : peer.requestedAt;
        const auto fits = [&, &taker = peer](const Capture& capture) {
            return taker.loaded == 0 ? now_ - capture.at <= kCaptureAge
                                     : capture.head.record >= least;
        };
        const auto newest = std::find_if(captures_.rbegin(), captures_.rend(), fits);
        if (peer.phase == PeerPhase::waitsForTiles || newest == captures_.rend()) {
            needed |= peer.captures >= 1;
            continue;
        }
        begin(peer, newest->head, newest->bytes.size());
        peer.capture = newest->number();
    }
    if (!needed || capturing_ || now_ - captureFailedAt_ < kCaptureRetry) return;
    tryCapture(world, [&] {
        world.persistence().requestSave(world::SaveFor::net);
        capturing_ = true;
    });
    for (auto [slot, peer] : peers_.entries())
        if (ruleOf(peer.phase).waits && peer.capture == 0)
            peer.captures = std::max(peer.captures - 1, 0.0);
}

void Server::begin(Peer& peer, const StateHead& head, size_t bytes) {
    FW_ASSERT(bytes > 0 && head.id != 0, "%zu bytes of state %u", bytes, head.id);
    move(peer, PeerEvent::begins);
    peer.head = head;
    const size_t room = def_.packetBytes - kPacketHead - kChunkHead;
    peer.chunks.begin(uint32_t((bytes + room - 1) / room));
    for (const Given& given : peer.given)
        if (given.id == head.id) return;
    std::rotate(peer.given.begin(), peer.given.begin() + 1, peer.given.end());
    peer.given.back() = {head.id, head.record, false};
}

// ---- packets ------------------------------------------------------------------------------------

double Server::maxBudget() const noexcept {
    return std::max(0.25 * def_.bytesPerSecond, 2.0 * def_.packetBytes);
}

// Then what has no answer yet may be sent again before it counts as lost.
bool Server::hasSpareRate(const Peer& peer) const noexcept { return peer.budget > maxBudget() / 2; }

void Server::update(world::World& world, float seconds) {
    FW_ASSERT(seconds >= 0, "%g s", double(seconds));
    const auto passed = double(seconds);
    now_ += passed;
    drain(world);
    if (now_ - identityAt_ > kIdentityAge || identityAt_ < 0) {
        identity_ = world.persistence().identity();
        identityAt_ = now_;
    }
    if (now_ - changeRateAt_ >= 1) {
        const double rate = double(pushed_ - pushedBefore_) / (now_ - changeRateAt_);
        changeRate_ += (rate - changeRate_) / 2;
        pushedBefore_ = pushed_;
        changeRateAt_ = now_;
    }
    collectCaptures(world);
    trim(world);
    for (auto [slot, peer] : peers_.entries()) {
        peer.packets = std::min(peer.packets + passed * kPacketsPerSecond, kMaxPackets);
        peer.captures = std::min(peer.captures + passed / kCaptureEvery, kCapturesAtOnce);
        if (peer.token == 0) continue;
        peer.link.silent += passed;
        peer.budget = std::min(peer.budget + passed * def_.bytesPerSecond, maxBudget());
        watchBacklog(world, peer, slot + 1);
        peer.untilDue -= passed;
        if (peer.untilDue > 1e-4) continue;
        peer.untilDue = std::max(peer.untilDue + double(def_.interval), 0.0);
        peer.due = true;
        const double spare = std::max(double(def_.interval), peer.trip.seconds() / 4) - 1e-4;
        if (now_ >= peer.resendAt ||
            (peer.cursor >= streamEnd(peer) && hasSpareRate(peer) && now_ - peer.resentAt >= spare))
            peer.cursor = peer.acknowledged;
    }
}

PacketHead Server::headOf(Peer& peer, PacketKind kind) noexcept {
    peer.trip.sent(++peer.link.sent, now_);
    return {kind, def_.token, peer.token, peer.link.sent};
}

// Of a peer that fell, records behind its next state come with that.
uint32_t Server::streamEnd(const Peer& peer) const noexcept {
    if (!peer.skips) return log_.end();
    if (ruleOf(peer.phase).takes) return std::min(peer.head.record, log_.end());
    return captureRequested_ ? recorded_.record : log_.end();
}

// The first of a turn says how far the server is, even without a record.
bool Server::writeStream(Peer& peer, bool pieceDue) {
    const PeerRule& rule = ruleOf(peer.phase);
    const uint32_t end = streamEnd(peer);
    const uint32_t skipsBefore = peer.skips ? end : 0;
    peer.cursor = peer.runs.pastRun(peer.cursor);
    const bool records =
        rule.hasState && peer.budget > 0 && peer.cursor < end && !(pieceDue && peer.pieceNext);
    if (!peer.due && !records) return false;
    if (!peer.due && !pieceDue && peer.cursor == peer.acknowledged)
        return false;  // of the next turn
    core::Writer writer = beginPacket(packet_, headOf(peer, PacketKind::stream));
    const bool outdated = rule.hasState && rule.shown != FW_NET_FOLLOWING;
    StreamHead head{
        outdated ? peer.loaded : 0,      step_, stepEnd_,
        rule.hasState ? peer.cursor : 0, 0,     uint16_t(peer.overloaded ? kStreamOverloaded : 0)};
    visitStreamHead(writer, head);
    const size_t countAt = packet_.size() - 2 * sizeof(uint16_t);
    if (records && peer.cursor == peer.acknowledged) {
        peer.resendAt = now_ + peer.trip.timeout();
        peer.resentAt = now_;
    }
    while (records && peer.cursor < end && peer.runs.pastRun(peer.cursor) == peer.cursor) {
        const RecordLog::Entry entry = log_.entryAt(peer.cursor, skipsBefore);
        const bool skips = entry.bytes.empty();
        const size_t size = skips ? kSkipBytes : entry.bytes.size();
        if (packet_.size() + kRecordHead + size > def_.packetBytes) break;
        writer.number(uint16_t(size));
        if (skips) {
            Record skipped;
            skipped.kind = RecordKind::skipped;
            skipped.tick = std::min(entry.count, end - peer.cursor);
            writeRecord(skipped, packet_);
            peer.cursor += uint32_t(skipped.tick);
        } else {
            packet_.insert(packet_.end(), entry.bytes.begin(), entry.bytes.end());
            ++peer.cursor;
        }
        ++head.count;
    }
    writer.numberAt(countAt, head.count);
    FW_ASSERT(peer.acknowledged <= peer.cursor, "record %u of %u", peer.cursor, peer.acknowledged);
    peer.sentEnd = std::max(peer.sentEnd, peer.cursor);
    if (head.count > 0) {
        peer.pieceNext = true;
        peer.sentIn = peer.link.sent;
    }
    peer.due = false;
    return true;
}

bool Server::writePiece(Peer& peer, uint32_t piece) {
    if (piece == peer.chunks.count()) return false;
    FW_ASSERT(piece < peer.chunks.count(), "piece %u of %u", piece, peer.chunks.count());
    const Capture* capture = captureOf(peer.capture);
    const bool tiles = peer.phase == PeerPhase::loadsTiles;
    if (!tiles && !capture) return false;
    core::Writer writer = beginPacket(packet_, headOf(peer, PacketKind::chunk));
    const auto each = uint16_t(def_.packetBytes - kPacketHead - kChunkHead);
    writeChunk(writer, {peer.head, piece, each}, tiles ? peer.tiles : capture->bytes);
    peer.chunks.sent(piece, now_, peer.link.sent);
    for (Given& given : peer.given)
        if (given.id == peer.head.id) given.whole |= peer.chunks.allSent();
    peer.pieceNext = false;
    return true;
}

bool Server::write(FwPeerId to, std::span<std::byte> room, uint32_t& size) {
    Peer& peer = peers_.get(to);
    if (room.size() < def_.packetBytes)
        core::refuse("*size is %zu and a packet has up to %u bytes.", room.size(),
                     def_.packetBytes);
    if (peer.token == 0) return false;
    if (peer.welcome) {
        core::Writer writer = beginPacket(packet_, headOf(peer, PacketKind::welcome));
        writer.number(identity_);
        peer.welcome = false;
    } else {
        const double timeout = peer.trip.timeout();
        const double again =
            hasSpareRate(peer) ? std::min(timeout, std::max(kChunkAgain, timeout / 4)) : timeout;
        const bool pieces = peer.chunks.active() && peer.budget > 0;
        const uint32_t piece = pieces ? peer.chunks.next(now_, again) : peer.chunks.count();
        if (!writeStream(peer, piece != peer.chunks.count()) && !writePiece(peer, piece))
            return false;
    }
    FW_ASSERT(packet_.size() <= def_.packetBytes, "%zu bytes", packet_.size());
    size = peer.link.send(packet_, room);
    peer.budget -= double(size);
    return true;
}

void Server::read(world::World& world, FwPeerId from, std::span<const std::byte> packet) {
    Peer& peer = peers_.get(from);
    if (peer.packets < 1) {
        ++peer.link.ignored;
        return;
    }
    peer.packets -= 1;
    try {
        readPacket(world, peer, from.index1, packet);
    } catch (const core::Error& error) {
        const uint64_t refused = ++peer.link.refused;
        if ((refused & (refused - 1)) == 0)  // the 1st, 2nd, 4th, 8th...
            world.log().write(FW_LOG_WARNING, "Packet %llu of peer %u is refused: %s",
                              static_cast<unsigned long long>(refused), from.index1, error.message);
        throw;
    }
}

void Server::readPacket(world::World& world, Peer& peer, uint32_t name,
                        std::span<const std::byte> packet) {
    core::Reader reader(packet, "packet");
    const PacketHead head = openPacket(packet, reader);
    // Until a status has come, a greeting may have been of another token that nobody has.
    const bool greetsAgain = head.kind == PacketKind::hello && peer.phase == PeerPhase::joining;
    if (head.client == 0 || (peer.token != 0 && head.client != peer.token && !greetsAgain))
        core::failData(
            "The packet is of a client with token 0x%08X; peer %u has 0x%08X. Remove the "
            "peer if another one came in its place.",
            head.client, name, peer.token);
    if (!peer.link.isFresh(head.sequence)) return;
    if (head.kind == PacketKind::hello) {
        if (reader.left() != 0 || head.session != 0)
            core::failData("The packet greets with %zu bytes in session 0x%08X.", reader.left(),
                           head.session);
        peer.token = head.client;
        peer.welcome = true;
        move(peer, PeerEvent::greets);
    } else if ((head.kind != PacketKind::status && head.kind != PacketKind::tiles) ||
               head.session != def_.token || peer.token == 0) {
        core::failData(
            "The packet of kind %u is of session 0x%08X; a server takes a client's, of "
            "session 0x%08X.",
            uint32_t(head.kind), head.session, def_.token);
    } else if (head.kind == PacketKind::tiles) {
        readTiles(world, peer, reader);
    } else {
        readStatus(world, peer, reader, peer.link.came.isNewest(head.sequence));
    }
    peer.link.accept(head.sequence, packet.size());
}

const Server::Given* Server::givenOf(const Peer& peer, uint32_t id) noexcept {
    for (const Given& given : peer.given)
        if (given.whole && given.id == id) return &given;  // only one that was sent is whole
    return nullptr;
}

// Every number against what the server knows. An older packet may say less than is known by now.
void Server::checkStatus(const Peer& peer, const Status& status, bool newest) const {
    const auto check = [](const char* name, uint32_t value, uint32_t low, uint32_t high) {
        if (value < low || value > high)
            core::failData("The packet's status has %s %u; by what was sent it is in [%u, %u].",
                           name, value, low, high);
    };
    check("request", status.request, 0, uint32_t(Request::count) - 1);
    check("newest packet", status.answered, 0, peer.link.sent);
    uint32_t newestGiven = 0;
    for (const Given& given : peer.given) newestGiven = std::max(newestGiven, given.id);
    check("a state of number", status.state, 0, newestGiven);
    const bool taking = peer.chunks.active() && status.state == peer.head.id;
    if (status.state == 0 ? status.base != 0 || status.came != 0
                          : taking && !peer.chunks.canHave(status.base, status.came))
        core::failData(
            "The packet's status has the pieces before %u, and 0x%016llX behind them, of "
            "state %u, of which %u were sent.",
            status.base, static_cast<unsigned long long>(status.came), status.state,
            taking ? peer.chunks.sentEnd() : 0);
    const Given* given = givenOf(peer, status.loaded);
    const bool same = status.loaded == peer.loaded;
    const bool older = !newest && status.loaded < peer.loaded;
    if (!same && !given && !older)
        core::failData("The packet's status has loaded state %u, which was not sent.",
                       status.loaded);
    uint32_t low = 0, high = peer.sentEnd;
    if (newest && same) low = peer.acknowledged;
    if (!same && given) {
        low = given->record;
        high = std::max(high, low);
    }
    if (status.loaded == 0) high = 0;
    check("the next record", status.next, low, high);
    if (status.runs.count > 0)
        check("records up to", status.runs.list[status.runs.count - 1u].end, 0,
              status.loaded == 0 ? 0 : high);
    // A client goes no further than the server said, unless the server's world went back. One that
    // asks for a state may have gone wrong in this as well.
    if (status.loaded != 0 && newest && !(peer.skips && same) &&
        Request(status.request) != Request::state)
        check("step", status.step, 0, step_);
    if (newest &&
        phaseAfter(same ? peer.phase : PeerPhase::follows, eventOf(status.request)) == kRefused)
        core::failData("The packet's status has request %u of a peer that is %s.",
                       uint32_t(status.request), ruleOf(peer.phase).name);
}

void Server::readStatus(world::World& world, Peer& peer, core::Reader& reader, bool newest) {
    Status status;
    visitStatus(reader, status);
    endPacket(reader, "a status");
    drain(world);
    checkStatus(peer, status, newest);
    peer.trip.answered(status.answered, now_);
    // Packets before this one came, or they are lost.
    const uint32_t settled = std::max(status.answered, kReordered) - kReordered;
    if (status.state != 0 && peer.chunks.active() && status.state == peer.head.id)
        peer.chunks.acknowledge(status.base, status.came, settled);
    if (!newest) return;
    if (status.loaded != peer.loaded) {
        move(peer, PeerEvent::loads);
        peer.loaded = status.loaded;
        ++peer.states;
        peer.skips = false;
        peer.acknowledged = peer.cursor = status.next;
        peer.sentEnd = std::max(peer.sentEnd, peer.cursor);
        if (peer.acknowledged < log_.begin()) fall(peer);
    } else if (status.next > peer.acknowledged) {
        peer.acknowledged = status.next;
        peer.cursor = std::max(peer.cursor, peer.acknowledged);
        peer.resendAt = now_ + peer.trip.timeout();
    }
    peer.runs = status.runs;
    if (peer.sentIn < settled) peer.cursor = peer.acknowledged;
    peer.step = status.step;
    // It has forgotten what it had of the state, and begins again.
    const bool forgot = Request(status.request) == Request::state && status.state == 0 &&
                        peer.chunks.base() > 0 && peer.phase != PeerPhase::loadsTiles;
    if (peer.chunks.active() && forgot) move(peer, PeerEvent::falls);
    move(peer, eventOf(status.request));
}

// It has a save of its own of the tick that the capture is of.
void Server::readTiles(world::World& world, Peer& peer, core::Reader& reader) {
    uint32_t number = 0, slot = 0;
    reader.numbers(number, slot);
    std::array<uint32_t, world::kMaxBlocks> hashes{};
    const size_t count = reader.left() / sizeof(uint32_t);
    if (count > hashes.size())
        core::failData("The packet has hashes of %zu blocks; the limit is %zu.", count,
                       hashes.size());
    for (size_t i = 0; i < count; ++i) reader.number(hashes[i]);
    endPacket(reader, "the hashes");
    if (number == 0 || number > captureCount_)
        core::failData("The packet has hashes of state %u; there were %u.", number, captureCount_);
    if (!ruleOf(peer.phase).hasState)
        core::failData("The packet has hashes of a peer that is %s.", ruleOf(peer.phase).name);
    const Capture* capture = captureOf(number);
    if (peer.phase != PeerPhase::waitsForTiles || peer.capture != number || !capture ||
        peer.compared == number)
        return;  // not yet, not any more, or they are on their way
    peer.compared = number;
    try {
        if (!world.persistence().writeBlocks(capture->bytes, slot, std::span(hashes).first(count),
                                             peer.tiles))
            return;
    } catch (const core::Error&) {  // of objects that are gone: the client asks for the state next
        return;
    }
    StateHead head = capture->head;
    head.id += 1;
    head.size = uint32_t(peer.tiles.size());
    begin(peer, head, peer.tiles.size());
    peer.capture = 0;
}

void Server::fillState(world::World& world, FwPeerId id, FwNetState& state) {
    state.role = FW_NET_SERVER;
    state.step = world.tick() / gpu::kStepTicks;
    state.changeRate = float(changeRate_);
    const auto add = [&](const Peer& peer) {
        ++state.peers;
        peer.link.addTo(state);
        state.states += peer.states;
        state.resyncs += peer.resyncs;
        state.messagesLost += peer.messagesLost;
        state.overloaded += peer.overloaded ? 1 : 0;
        state.backlog = std::max(state.backlog, float(backlogOf(peer)));
        if (ruleOf(peer.phase).hasState)
            state.records = std::max(state.records, log_.end() - peer.acknowledged);
    };
    if (id.index1 != 0) {
        const Peer& peer = peers_.get(id);
        add(peer);
        state.phase = ruleOf(peer.phase).shown;
        state.newestKnownStep = peer.step;
        state.behind = float(double(state.step - std::min<uint64_t>(state.step, peer.step)) / 32);
        state.silent = float(peer.link.silent);
        state.roundTrip = float(peer.trip.seconds());
        return;
    }
    for (auto [slot, peer] : peers_.entries()) add(peer);
    state.phase = FW_NET_FOLLOWING;
    state.newestKnownStep = state.step;
}

}  // namespace fw::net
