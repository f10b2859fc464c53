#include "net/client.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fw::net {
namespace {

constexpr double kStuckAfter = 3;            // s without a piece of a state
constexpr double kTilesPatience = 6;         // s: then the whole state is asked for
constexpr double kRepairTrust = 20;          // s: who is astray again by then needs all of it
constexpr double kRetryAfter = 1;            // s
constexpr size_t kMarks = 64;                // of how far the server was, that wait for records
constexpr uint64_t kHashAge = 10ull * 4096;  // ticks that a hash waits for its like
constexpr double kLeast = 1e-7;              // s: less is nothing
constexpr double kLate = 0.5;                // s: beyond it a client hurries
constexpr double kCatchUp = 8, kFastest = 1.25, kSlowest = 0.9;  // of real time

}  // namespace

Client::Client(const FwNetDef& def, world::World& world, std::pmr::memory_resource* memory)
    : def_(def),
      memory_(memory),
      journal_(world.keepJournal(true)),
      state_(memory),
      own_(memory),
      ownBlocks_(memory),
      waiting_(memory),
      marks_(memory),
      theirHashes_(memory),
      ourHashes_(memory),
      packet_(memory) {
    packet_.reserve(kPacketMost);
    marks_.reserve(kMarks);
}

// ---- what comes ---------------------------------------------------------------------------------

void Client::read(std::span<const std::byte> packet) {
    core::Reader reader(packet, "packet");
    const PacketHead head = openPacket(packet, reader);
    if (head.client != def_.token || head.session == 0 ||
        (session_ != 0 && head.session != session_))
        core::fail(FW_ERROR_BAD_DATA,
                   "The packet is for token 0x%08X of session 0x%08X; this client has 0x%08X in "
                   "session 0x%08X.",
                   head.client, head.session, def_.token, session_);
    const bool early = session_ == 0 && head.kind != PacketKind::welcome;  // that one comes again
    if (early || !came_.isNew(head.sequence)) {
        ++traffic_.ignored;
        return;
    }
    if (head.kind == PacketKind::welcome) {
        uint64_t identity = 0;
        reader.number(identity);
        if (reader.left() != 0)
            core::fail(FW_ERROR_BAD_DATA, "%zu bytes follow a welcome in the packet.",
                       reader.left());
        session_ = head.session;
        theirs_ = identity;
        welcome_ = true;
    } else if (head.kind == PacketKind::stream) {
        readStream(reader, head.sequence);
    } else if (head.kind == PacketKind::chunk) {
        readPiece(reader);
    } else {
        core::fail(FW_ERROR_BAD_DATA, "The packet is of kind %u, which a client sends.",
                   uint32_t(head.kind));
    }
    (void)came_.take(head.sequence);
    silent_ = 0;
    traffic_.bytesIn += packet.size();
    ++traffic_.packetsIn;
}

void Client::readStream(core::Reader& reader, uint32_t sequence) {
    uint32_t anew = 0, first = 0;
    Reached mark;
    uint16_t count = 0;
    reader.number(anew), reader.number(mark.step), reader.number(mark.records);
    reader.number(first), reader.number(count);
    if (mark.step > world::Clock::kLastTick / gpu::kStepTicks ||
        uint64_t(first) + count > 0xFFFFFFFFu)
        core::fail(FW_ERROR_BAD_DATA, "The packet is of step %u and record %u, which none can be.",
                   mark.step, first);
    // What was sent before the state may be of another past.
    const bool counts = loads_ > 0 && sequence > streamsAfter_;
    // All of it is looked at before any of it counts.
    const std::span<const std::byte> rest = reader.take(reader.left());
    for (const bool keeps : {false, true}) {
        core::Reader records(rest, "packet");
        for (uint32_t i = 0; i < count; ++i) {
            uint16_t size = 0;
            records.number(size);
            const std::span<const std::byte> bytes = records.take(size);
            if (!keeps) {
                readRecord(bytes, record_);
                continue;
            }
            const uint32_t at = first + i - next_;
            if (!counts || first + i < next_ || at >= kAhead) continue;
            if (at >= waiting_.size()) waiting_.resize(at + 1);
            if (waiting_[at].empty()) waiting_[at].assign(bytes.begin(), bytes.end());
        }
        if (records.left() != 0)
            core::fail(FW_ERROR_BAD_DATA, "%zu bytes follow the records of the packet.",
                       records.left());
    }
    while (ready_ < waiting_.size() && !waiting_[ready_].empty()) ++ready_;
    if (loads_ > 0 && anew == loads_ + 1 && wish_ != Wish::state) wish(Wish::state);
    if (!counts || anew != 0) return;
    heard_ = std::max(heard_, mark.step);
    if (mark.step <= reached_) return;
    if (marks_.size() == kMarks) marks_.pop_back();
    marks_.push_back(mark);
    settleMarks();
}

void Client::settleMarks() noexcept {
    for (const Reached& mark : marks_)
        if (mark.records <= next_ + ready_) reached_ = std::max(reached_, mark.step);
    std::erase_if(marks_, [&](const Reached& mark) { return mark.step <= reached_; });
}

void Client::readPiece(core::Reader& reader) {
    ChunkHead head;
    const std::span<const std::byte> piece = readChunk(reader, head);
    const Wish brings = head.state.id % 2 != 0 ? Wish::tiles : Wish::state;
    if (wish_ != brings || !joined_ || retryIn_ > 0) return;
    const uint32_t base = state_.base();
    const uint64_t came = state_.came();
    if (!state_.take(head, piece)) return forgetState();
    if (state_.base() != base || state_.came() != came) stuck_ = 0;
}

// ---- what is done -------------------------------------------------------------------------------

// The server begins it again when the wish comes again.
void Client::forgetState() noexcept {
    state_.forget();
    retryIn_ = kRetryAfter;
    stuck_ = 0;
}

void Client::wish(Wish what) noexcept {
    wish_ = what;
    state_.forget();
    retryIn_ = stuck_ = wishing_ = 0;
    ownNumber_ = 0;
    ownBlocks_.clear();
    tilesDue_ = false;
}

void Client::goAstray(const world::World& world, const char* why, uint32_t slot) {
    if (wish_ != Wish::nothing) return;
    // Where tiles alone did not help, all of it is asked for.
    const bool tiles = slot != kNoSlot && repaired_ > kRepairTrust;
    wish(tiles ? Wish::tiles : Wish::state);
    astraySlot_ = slot;
    ++strays_;
    world.log().write(FW_LOG_WARNING, "%s %s asked for anew.", why,
                      tiles ? "Its tiles are" : "The state is");
}

// The server saved its state where this world is now: what differs is found between two saves.
void Client::takeOwn(world::World& world) {
    if (wish_ != Wish::tiles || ownNumber_ == 0 || !ownBlocks_.empty()) return;
    const std::pmr::vector<std::byte>* bytes = world.fetchSave(world::SaveFor::net);
    if (!bytes) return;
    own_.assign(bytes->begin(), bytes->end());
    ownBlocks_ = world.hashBlocks(own_, astraySlot_);
    if (ownBlocks_.empty()) wish(Wish::state);  // at rest here, and not there
    tilesDue_ = true;
}

void Client::load(world::World& world) {
    const bool tiles = state_.state().id % 2 != 0;
    try {
        if (tiles) {
            std::pmr::vector<std::byte> merged(memory_);
            if (state_.state().id / 2 != ownNumber_)
                core::fail(FW_ERROR_BAD_DATA, "The tiles are of another state.");
            world.mergeBlocks(own_, state_.bytes(), merged);
            world.performLoad(merged);
        } else {
            world.performLoad(state_.bytes());
        }
    } catch (const core::Error& error) {
        world.log().write(FW_LOG_WARNING, "The server's state cannot be taken: %s", error.message);
        if (tiles) return wish(Wish::state);
        forgetState();
        refused_ = true;
        return;
    }
    next_ = state_.state().record;
    reached_ = heard_ = state_.state().step;
    streamsAfter_ = came_.newest();
    ++loads_;
    repairs_ += tiles ? 1 : 0;
    repaired_ = tiles ? 0 : 1e9;
    wish(Wish::nothing);
    refused_ = false;
    waiting_.clear();
    ready_ = 0;
    marks_.clear();
    theirHashes_.clear();
    ourHashes_.clear();
    journal_.loaded = false;
    owed_ = 0;
    due_ = true;
}

// Hashes of the same object at the same tick, whichever of them came first.
void Client::compare(world::World& world) {
    ourHashes_.insert(ourHashes_.end(), journal_.hashes.begin(), journal_.hashes.end());
    journal_.hashes.clear();
    const uint64_t now = world.tick();
    bool alike = true;
    std::erase_if(theirHashes_, [&](const world::ObjectHash& theirs) {
        const auto ours =
            std::find_if(ourHashes_.begin(), ourHashes_.end(), [&](const world::ObjectHash& one) {
                return one.slot == theirs.slot && one.tick == theirs.tick;
            });
        if (ours == ourHashes_.end()) return theirs.tick + kHashAge < now;
        ++compared_;
        if (ours->hash != theirs.hash && alike && wish_ == Wish::nothing) {
            alike = false;
            char why[160];
            std::snprintf(why, sizeof why,
                          "Burnable mesh %u differs from the server's at tick %llu.",
                          theirs.slot + 1, static_cast<unsigned long long>(theirs.tick));
            goAstray(world, why, theirs.slot);
        }
        return true;
    });
    std::erase_if(ourHashes_,
                  [&](const world::ObjectHash& one) { return one.tick + kHashAge < now; });
}

void Client::takeTurn(world::World& world, FwNetTurn& turn) {
    turn.kind = FW_TURN_WAIT;
    if (state_.whole()) load(world);
    if (loads_ == 0) return;
    compare(world);
    takeOwn(world);
    const auto now = uint32_t(world.tick() / gpu::kStepTicks);
    while (ready_ > 0) {
        readRecord(waiting_.front(), record_);
        if (record_.step > now) break;
        if (record_.step < now)
            goAstray(world, "A record of the server's comes too late.", kNoSlot);
        if (record_.kind == RecordKind::deed) {
            try {
                world.perform(record_.deed);
            } catch (const core::Error& error) {
                goAstray(world, error.message, kNoSlot);
            }
        } else if (record_.kind == RecordKind::hashes) {
            for (uint32_t i = 0; i < record_.hashCount; ++i)
                if (record_.hashes[i] != 0)
                    theirHashes_.push_back({record_.first + i * record_.stride, record_.stride,
                                            record_.tick, record_.hashes[i]});
        } else if (record_.kind == RecordKind::capture) {
            if (wish_ == Wish::tiles && ownNumber_ == 0) {
                world.requestSave(world::SaveFor::net);
                ownNumber_ = uint32_t(record_.tick);
                turn.kind = FW_TURN_STEP;  // of no time: a save is of the next frame
            }
        } else {
            turn.kind = FW_TURN_MESSAGE;
            turn.messageSize = uint32_t(record_.message.size());
            std::transform(record_.message.begin(), record_.message.end(), turn.message,
                           [](std::byte b) { return (unsigned char)b; });
        }
        waiting_.pop_front();
        --ready_;
        ++next_;
        if (turn.kind != FW_TURN_WAIT) return;
    }
    // As far as nothing has to be done and no hash is due.
    uint32_t until = std::min(reached_, (now / world::kHashSteps + 1) * world::kHashSteps);
    if (ready_ > 0) until = std::min(until, record_.step);
    until = std::min(until, now + world.mostSteps());
    if (until <= now) {
        owed_ = 0;
        return;
    }
    if (owed_ < kLeast) return;
    const double most = world.secondsTo(uint64_t(until) * gpu::kStepTicks);
    auto seconds = float(std::min(owed_, most));
    if (owed_ >= most && double(seconds) < most)
        seconds = std::nextafter(seconds, std::numeric_limits<float>::infinity());
    owed_ = std::max(owed_ - double(seconds), 0.0);
    journal_.until = uint64_t(until) * gpu::kStepTicks;
    turn.kind = FW_TURN_STEP;
    turn.deltaTime = seconds;
}

void Client::update(world::World& world, float seconds) {
    silent_ += double(seconds);
    retryIn_ = std::max(retryIn_ - double(seconds), 0.0);
    stuck_ += double(seconds);
    wishing_ += double(seconds);
    repaired_ += double(seconds);
    if (wish_ == Wish::state && joined_ && stuck_ > kStuckAfter) forgetState();
    if (wish_ == Wish::tiles && wishing_ > kTilesPatience) wish(Wish::state);
    untilDue_ -= double(seconds);
    if (untilDue_ <= 1e-4) {
        const double interval =
            joined_ ? double(def_.interval) : std::max(0.25, double(def_.interval));
        untilDue_ = std::max(untilDue_ + interval, 0.0);
        due_ = true;
        tilesDue_ = !ownBlocks_.empty() && state_.state().id == 0;
    }
    if (welcome_ && !joined_) {
        welcome_ = false;
        const uint64_t mine = world.identity();
        joined_ = mine == theirs_;
        if (!joined_ && !refused_)
            world.log().write(FW_LOG_WARNING,
                              "The server's world has identity 0x%016llX; this one has 0x%016llX. "
                              "Both are made of the same things, in the same order.",
                              static_cast<unsigned long long>(theirs_),
                              static_cast<unsigned long long>(mine));
        refused_ = !joined_;
        due_ |= joined_;
    }
    if (loads_ == 0) return;
    // Far enough behind what was heard for the next of it to come in time.
    const double late = double(heard_) / 32 - world.seconds() - double(def_.delay);
    const double rate = late > kLate ? std::min(1 + 2 * late, kCatchUp)
                                     : std::clamp(1 + late / 2, kSlowest, kFastest);
    owed_ = std::min(owed_ + double(seconds) * rate, 2.0);
}

bool Client::write(world::World& world, std::span<std::byte> room, uint32_t& size) {
    if (room.size() < def_.packetBytes)
        core::fail(FW_ERROR_INVALID_ARGUMENT, "*size is %zu and a packet has up to %u bytes.",
                   room.size(), def_.packetBytes);
    if (!due_ && !tilesDue_) return false;
    const PacketKind kind = !joined_ ? PacketKind::hello
                            : due_   ? PacketKind::status
                                     : PacketKind::tiles;
    (due_ ? due_ : tilesDue_) = false;
    core::Writer writer = beginPacket(packet_, {kind, joined_ ? session_ : 0, def_.token, ++sent_});
    if (kind == PacketKind::status) {
        writer.number(uint16_t(retryIn_ <= 0 ? wish_ : Wish::nothing));
        writer.number(loads_);
        writer.number(next_ + ready_);
        writer.number(uint32_t(world.tick() / gpu::kStepTicks));
        writer.number(state_.state().id);
        writer.number(state_.base());
        writer.number(state_.came());
    } else if (kind == PacketKind::tiles) {
        writer.number(ownNumber_);
        writer.number(astraySlot_);
        for (const uint32_t hash : ownBlocks_) writer.number(hash);
    }
    sealPacket(packet_);
    std::copy(packet_.begin(), packet_.end(), room.begin());
    size = uint32_t(packet_.size());
    traffic_.bytesOut += size;
    ++traffic_.packetsOut;
    return true;
}

void Client::fillState(world::World& world, FwNetState& state) const {
    state.role = FW_NET_CLIENT;
    state.phase = refused_      ? FW_NET_REFUSED
                  : !joined_    ? FW_NET_CALLING
                  : loads_ == 0 ? FW_NET_LOADING
                                : FW_NET_FOLLOWING;
    state.step = world.tick() / gpu::kStepTicks;
    state.heardStep = heard_;
    state.behind = float(std::max(double(heard_) / 32 - world.seconds(), 0.0));
    state.silent = float(silent_);
    state.records = uint32_t(waiting_.size());
    state.peers = joined_ ? 1 : 0;
    addTraffic(traffic_, state);
    state.states = loads_;
    state.hashes = compared_;
    state.strays = strays_;
    state.repairs = repairs_;
}

}  // namespace fw::net
