#include "net/client.h"

#include "core/assert.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fw::net {
namespace {

constexpr double kStuckAfter = 20;       // s without a piece of a state that has begun
constexpr uint32_t kContradictions = 8;  // newest packets in a row
constexpr double kTilesPatience = 6;     // s: then the whole state is asked for
constexpr double kRepairTrust = 20;      // s: a client that is wrong again by then needs all of it
constexpr double kRetryAfter = 1;        // s
constexpr size_t kMarks = 64;            // of how far the server was, that wait for records
constexpr uint64_t kHashAge = 10ull * 4096;  // ticks that a hash waits for its like
constexpr double kLeast = 1e-7;              // s: less is nothing
constexpr double kLate = 0.5;                // s: beyond it a client hurries
constexpr double kCatchUp = 8, kFastest = 1.25, kSlowest = 0.9;  // of real time

}  // namespace

Client::Client(const FwNetDef& def, world::World& world, std::pmr::memory_resource* memory)
    : def_(def), memory_(memory), recording_(world.persistence().startRecording(true)) {
    packet_.reserve(kMaxPacket);
    marks_.reserve(kMarks);
    FW_ASSERT(def.packetBytes >= kMinPacket && def.packetBytes <= kMaxPacket, "%u bytes",
              def.packetBytes);
}

// ---- what comes ---------------------------------------------------------------------------------

void Client::read(std::span<const std::byte> packet) {
    try {
        readPacket(packet);
    } catch (const core::Error&) {
        ++link_.refused;
        throw;
    }
}

void Client::readPacket(std::span<const std::byte> packet) {
    core::Reader reader(packet, "packet");
    const PacketHead head = openPacket(packet, reader);
    const bool welcomesAgain = head.kind == PacketKind::welcome && loads_ == 0;
    if (head.client != def_.token || head.session == 0 ||
        (session_ != 0 && head.session != session_ && !welcomesAgain))
        core::failData(
            "The packet is for token 0x%08X of session 0x%08X; this client has 0x%08X in "
            "session 0x%08X.",
            head.client, head.session, def_.token, session_);
    const bool early = session_ == 0 && head.kind != PacketKind::welcome;  // that one comes again
    if (early) ++link_.ignored;
    if (early || !link_.isFresh(head.sequence)) return;
    const bool newest = link_.came.isNewest(head.sequence);
    if (head.kind == PacketKind::welcome) {
        uint64_t identity = 0;
        reader.number(identity);
        endPacket(reader, "a welcome");
        session_ = head.session;
        theirs_ = identity;
        welcome_ = true;
    } else if (head.kind == PacketKind::stream) {
        readStream(reader, newest);
    } else if (head.kind == PacketKind::chunk) {
        readPiece(reader, newest);
    } else {
        core::failData("The packet is of kind %u, which a client sends.", uint32_t(head.kind));
    }
    link_.accept(head.sequence, packet.size());
}

// Newer packets say no less than older ones did; where they keep doing so, an older one was wrong.
void Client::checkProgress(const Reached& mark) {
    if (mark.step >= heard_ && mark.records >= received_) {
        contradictions_ = 0;
        return;
    }
    if (++contradictions_ >= kContradictions && requested_ != Request::state) {
        contradictions_ = 0;
        ask(Request::state);
    }
    core::failData(
        "The packet says that the server is at step %u with %u records; another one said "
        "step %u and %u.",
        mark.step, mark.records, heard_, received_);
}

void Client::readStream(core::Reader& reader, bool newest) {
    StreamHead head;
    visitStreamHead(reader, head);
    const uint32_t outdated = head.outdated;
    const Reached mark{head.step, head.records};
    if (mark.step > world::Clock::kLastTick / gpu::kStepTicks || head.flags > kStreamFlags)
        core::failData("The packet is of step %u and has flags 0x%04X.", mark.step,
                       uint32_t(head.flags));
    const bool counts = loads_ > 0 && (outdated == 0 || outdated == loaded_);
    const uint32_t before = received_;
    // All of it is looked at before any of it counts.
    const std::span<const std::byte> rest = reader.take(reader.left());
    for (const bool keeps : {false, true}) {
        if (keeps && newest && counts && outdated == 0) checkProgress(mark);
        core::Reader records(rest, "packet");
        uint64_t at = head.first;
        uint32_t step = 0;
        for (uint32_t i = 0; i < head.count; ++i) {
            uint16_t size = 0;
            records.number(size);
            const std::span<const std::byte> bytes = records.take(size);
            readRecord(bytes, record_);
            const bool skipped = record_.kind == RecordKind::skipped;
            const bool hashes = record_.kind == RecordKind::hashes;
            const auto record = uint32_t(at);
            at += skipped ? record_.tick : 1;
            if (keeps) {
                if (counts) keep(record, bytes);
                continue;
            }
            if (at > mark.records)
                core::failData("The packet has record %llu; the server has %u.",
                               static_cast<unsigned long long>(at - 1), mark.records);
            if (skipped || outdated != 0) continue;
            if (record_.step < step || record_.step > mark.step ||
                (hashes && record_.tick / gpu::kStepTicks > mark.step))
                core::failData(
                    "The packet has a record of step %u behind one of step %u, and the "
                    "server is at step %u.",
                    record_.step, step, mark.step);
            step = record_.step;
        }
        endPacket(records, "the records");
    }
    countReceived(before);
    if (!counts) return;
    if (newest) overloaded_ = (head.flags & kStreamOverloaded) != 0;
    // Until the state is there the world burns on without the changes that are left out.
    if (outdated != 0 && requested_ != Request::state) ask(Request::state);
    // Messages from before the state was saved may be of another past.
    if (mark.records < loadedAt_) return;
    heard_ = std::max(heard_, mark.step);
    if (mark.step <= reached_) return;
    if (marks_.size() == kMarks) marks_.pop_back();
    FW_ASSERT(marks_.size() < kMarks, "%zu marks", marks_.size());
    marks_.push_back(mark);
    for (const Reached& one : marks_)
        if (one.records <= received_) reached_ = std::max(reached_, one.step);
    std::erase_if(marks_, [&](const Reached& one) { return one.step <= reached_; });
}

// A record, or a run of skipped ones, in record_.
void Client::keep(uint32_t record, std::span<const std::byte> bytes) {
    const bool skipped = record_.kind == RecordKind::skipped;
    const uint32_t count = skipped ? uint32_t(record_.tick) : 1;
    FW_ASSERT(count > 0, "record %u", record);
    if (record + count <= next_) return;
    if (waiting_.size() >= kMaxWaiting && record > received_) return;
    Waiting waiting{count, std::pmr::vector<std::byte>(memory_)};
    if (!skipped) waiting.bytes.assign(bytes.begin(), bytes.end());
    auto at = waiting_.find(record);
    // A run goes on behind the records of it that came before.
    for (; skipped && at != waiting_.end() && !at->second.bytes.empty();
         at = waiting_.find(record)) {
        if (--waiting.count == 0) return;
        ++record;
    }
    if (at == waiting_.end())
        waiting_.emplace(record, std::move(waiting));
    else if (skipped)
        at->second.count = std::max(at->second.count, waiting.count);
    else
        return;
    if (record <= received_) received_ = std::max(received_, record + waiting.count);
}

// Entries before `from` do not reach beyond what has been received.
void Client::countReceived(uint32_t from) noexcept {
    for (auto at = waiting_.lower_bound(from); at != waiting_.end() && at->first <= received_; ++at)
        received_ = std::max(received_, at->first + at->second.count);
}

// The records that wait behind a gap, so that they are not sent again.
RecordRuns Client::runs() const noexcept {
    RecordRuns runs;
    uint32_t end = received_;
    for (auto at = waiting_.upper_bound(received_);
         at != waiting_.end() && runs.count < kMaxRuns;) {
        const uint32_t first = at->first;
        uint32_t last = first + at->second.count;
        for (++at; at != waiting_.end() && at->first <= last; ++at)
            last = std::max(last, at->first + at->second.count);
        if (first - end > 0xFFFF || last - first > 0xFFFF) break;
        runs.list[runs.count++] = {first, last};
        end = last;
    }
    return runs;
}

// The record to be done next, or the run of skipped ones that it is in; next_ < received_.
const Client::Waiting& Client::front(uint32_t& end) const noexcept {
    FW_ASSERT(next_ < received_ && !waiting_.empty(), "record %u of %u", next_, received_);
    auto at = waiting_.find(next_);
    if (at == waiting_.end())
        for (at = waiting_.begin(); at->first + at->second.count <= next_;) ++at;
    end = at->first + at->second.count;
    return at->second;
}

void Client::advance(uint32_t record) noexcept {
    next_ = record;
    for (auto at = waiting_.begin(); at != waiting_.end() && at->first < next_;)
        at = at->first + at->second.count <= next_ ? waiting_.erase(at) : std::next(at);
}

void Client::readPiece(core::Reader& reader, bool newest) {
    ChunkHead head;
    const std::span<const std::byte> piece = readChunk(reader, head);
    const Request brings = head.state.id % 2 != 0 ? Request::tiles : Request::state;
    if (requested_ != brings || !joined_ || retryIn_ > 0) return;
    if (!state_.take(head, piece, newest)) return forgetState();
    stuck_ = 0;
}

// ---- what is done -------------------------------------------------------------------------------

// The server begins it again when it is asked for again.
void Client::forgetState() noexcept {
    state_.forget();
    retryIn_ = kRetryAfter;
    stuck_ = 0;
}

void Client::ask(Request what) noexcept {
    requested_ = what;
    state_.forget();
    retryIn_ = stuck_ = asking_ = 0;
    ownNumber_ = 0;
    ownBlocks_.clear();
    tilesDue_ = false;
}

void Client::askAgain(const world::World& world, const char* why, uint32_t slot) {
    if (requested_ != Request::nothing) return;
    // Where tiles alone did not help, all of it is asked for.
    const bool tiles = slot != kNoSlot && repaired_ > kRepairTrust;
    ask(tiles ? Request::tiles : Request::state);
    wrongSlot_ = slot;
    ++desyncs_;
    world.log().write(FW_LOG_WARNING, "%s The client asks for %s.", why,
                      tiles ? "the tiles that differ" : "the server's state");
}

// The server saved its state where this world is now: what differs is found between two saves.
void Client::loadOwnState(world::World& world) {
    if (requested_ != Request::tiles || ownNumber_ == 0 || !ownBlocks_.empty()) return;
    try {
        const std::pmr::vector<std::byte>* bytes =
            world.persistence().fetchSave(world::SaveFor::net);
        if (!bytes) return;
        own_.assign(bytes->begin(), bytes->end());
        ownBlocks_ = world.persistence().hashBlocks(own_, wrongSlot_);
    } catch (const core::Error& error) {
        world.log().write(FW_LOG_WARNING, "The client's own state cannot be compared: %s",
                          error.message);
    }
    if (ownBlocks_.empty()) ask(Request::state);  // at rest here, and not there
    tilesDue_ = true;
}

// Messages behind the record that a state is of come with that state's records.
bool Client::holdsMessages() const noexcept {
    if (requested_ == Request::state)
        return state_.state().id == 0 || next_ >= state_.state().record;
    return requested_ == Request::tiles && ownNumber_ != 0 && next_ >= ownRecord_;
}

void Client::handMessage(FwNetAction& turn) noexcept {
    FW_ASSERT(record_.message.size() <= sizeof turn.message, "%zu bytes", record_.message.size());
    turn.kind = FW_NET_ACTION_MESSAGE;
    turn.messageSize = uint32_t(record_.message.size());
    std::transform(record_.message.begin(), record_.message.end(), turn.message,
                   [](std::byte b) { return (unsigned char)b; });
    messagesEnd_ = next_ + 1;
}

bool Client::reachState(const world::World& world, FwNetAction& turn) {
    const StateHead& state = state_.state();
    if (loads_ == 0 || state.id % 2 != 0) return true;
    if (state.record < messagesEnd_) {
        world.log().write(FW_LOG_WARNING,
                          "The server's state is older than a message that was handed on. The "
                          "client asks for a newer one.");
        forgetState();
        return false;
    }
    while (next_ < state.record && next_ < received_) {
        uint32_t end = 0;
        const Waiting& waiting = front(end);
        if (!waiting.bytes.empty()) {
            readRecord(waiting.bytes, record_);
            if (record_.kind == RecordKind::message) handMessage(turn);
        }
        advance(std::min(end, state.record));
        if (turn.kind == FW_NET_ACTION_MESSAGE) return false;
    }
    return next_ >= state.record;
}

void Client::load(world::World& world) {
    const StateHead head = state_.state();
    const bool tiles = head.id % 2 != 0;
    try {
        if (tiles) {
            std::pmr::vector<std::byte> merged(memory_);
            if (head.id / 2 != ownNumber_ || head.record != ownRecord_)
                core::failData("The tiles are of another state.");
            world.persistence().mergeBlocks(own_, state_.bytes(), merged);
            world.persistence().applyLoad(merged);
        } else {
            world.persistence().applyLoad(state_.bytes());
        }
    } catch (const core::Error& error) {
        world.log().write(FW_LOG_WARNING, "The server's state cannot be taken: %s", error.message);
        if (tiles) return ask(Request::state);
        forgetState();
        refused_ = true;
        return;
    }
    ++loads_;
    loaded_ = head.id;
    loadedAt_ = received_ = head.record;
    advance(head.record);
    countReceived(0);
    reached_ = heard_ = head.step;
    contradictions_ = 0;
    repairs_ += tiles ? 1 : 0;
    repaired_ = tiles ? 0 : 1e9;
    ask(Request::nothing);
    refused_ = false;
    marks_.clear();
    theirHashes_.clear();
    ourHashes_.clear();
    recording_.loaded = false;
    owed_ = 0;
    due_ = true;
}

// Hashes of the same object at the same tick, whichever of them came first.
void Client::compare(world::World& world) {
    ourHashes_.insert(ourHashes_.end(), recording_.hashes.begin(), recording_.hashes.end());
    recording_.hashes.clear();
    const uint64_t now = world.tick();
    bool alike = true;
    std::erase_if(theirHashes_, [&](const world::ObjectHash& theirs) {
        const auto ours =
            std::find_if(ourHashes_.begin(), ourHashes_.end(), [&](const world::ObjectHash& one) {
                return one.slot == theirs.slot && one.tick == theirs.tick;
            });
        if (ours == ourHashes_.end()) return theirs.tick + kHashAge < now;
        ++compared_;
        if (ours->hash != theirs.hash && alike && requested_ == Request::nothing) {
            alike = false;
            char why[160];
            std::snprintf(why, sizeof why,
                          "Burnable mesh %u differs from the server's at tick %llu.",
                          theirs.slot + 1, static_cast<unsigned long long>(theirs.tick));
            askAgain(world, why, theirs.slot);
        }
        return true;
    });
    std::erase_if(ourHashes_,
                  [&](const world::ObjectHash& one) { return one.tick + kHashAge < now; });
}

void Client::takeTurn(world::World& world, FwNetAction& turn) {
    turn.kind = FW_NET_ACTION_WAIT;
    if (state_.whole() && reachState(world, turn)) load(world);
    if (loads_ == 0 || turn.kind != FW_NET_ACTION_WAIT) return;
    compare(world);
    loadOwnState(world);
    const auto now = uint32_t(world.tick() / gpu::kStepTicks);
    while (next_ < received_) {
        uint32_t end = 0;
        const Waiting& waiting = front(end);
        if (waiting.bytes.empty()) {  // the server has a state instead
            advance(end);
            if (requested_ != Request::state) ask(Request::state);
            continue;
        }
        readRecord(waiting.bytes, record_);
        if (record_.step > now) break;
        if (record_.kind == RecordKind::message && holdsMessages()) break;
        if (record_.step < now)
            askAgain(world, "A record of the server's comes too late.", kNoSlot);
        if (record_.kind == RecordKind::command) {
            try {
                world.persistence().apply(record_.command);
            } catch (const core::Error& error) {
                askAgain(world, error.message, kNoSlot);
            }
        } else if (record_.kind == RecordKind::hashes) {
            for (uint32_t i = 0; i < record_.hashCount; ++i)
                if (record_.hashes[i] != 0)
                    theirHashes_.push_back({record_.first + i * record_.stride, record_.stride,
                                            record_.tick, record_.hashes[i]});
        } else if (record_.kind == RecordKind::capture) {
            if (requested_ == Request::tiles && ownNumber_ == 0) {
                world.persistence().requestSave(world::SaveFor::net);
                ownNumber_ = uint32_t(record_.tick);
                ownRecord_ = end;
                turn.kind = FW_NET_ACTION_STEP;  // of no time: a save is of the next frame
            }
        } else {
            handMessage(turn);
        }
        advance(end);
        if (turn.kind != FW_NET_ACTION_WAIT) return;
    }
    // As far as nothing has to be done and no hash is due.
    uint32_t until = std::min(reached_, (now / world::kHashSteps + 1) * world::kHashSteps);
    // Messages that are held come with the state: the world burns on meanwhile.
    if (next_ < received_ && record_.step > now) until = std::min(until, record_.step);
    until = std::min(until, now + world.mostSteps());
    if (until <= now) {
        owed_ = 0;
        return;
    }
    if (owed_ < kLeast) return;
    const double most = world.persistence().secondsTo(uint64_t(until) * gpu::kStepTicks);
    auto seconds = float(std::min(owed_, most));
    if (owed_ >= most && double(seconds) < most)
        seconds = std::nextafter(seconds, std::numeric_limits<float>::infinity());
    owed_ = std::max(owed_ - double(seconds), 0.0);
    recording_.until = uint64_t(until) * gpu::kStepTicks;
    turn.kind = FW_NET_ACTION_STEP;
    turn.deltaTime = seconds;
}

void Client::update(world::World& world, float seconds) {
    FW_ASSERT(seconds >= 0, "%g s", double(seconds));
    link_.silent += double(seconds);
    retryIn_ = std::max(retryIn_ - double(seconds), 0.0);
    stuck_ += double(seconds);
    asking_ += double(seconds);
    repaired_ += double(seconds);
    const bool takes = state_.state().id != 0 && !state_.whole();
    if (requested_ == Request::state && takes && stuck_ > kStuckAfter) forgetState();
    // A welcome of a session that nobody is in has no packets after it.
    if (joined_ && loads_ == 0 && link_.silent > kMaxSilent) joined_ = false;
    if (requested_ == Request::tiles && asking_ > kTilesPatience) ask(Request::state);
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
        const uint64_t mine = world.persistence().identity();
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
    const double late = double(heard_) / 32 - world.persistence().seconds() - double(def_.delay);
    const double rate = late > kLate ? std::min(1 + 2 * late, kCatchUp)
                                     : std::clamp(1 + late / 2, kSlowest, kFastest);
    owed_ = std::min(owed_ + double(seconds) * rate, 2.0);
}

bool Client::write(world::World& world, std::span<std::byte> room, uint32_t& size) {
    if (room.size() < def_.packetBytes)
        core::refuse("*size is %zu and a packet has up to %u bytes.", room.size(),
                     def_.packetBytes);
    if (!due_ && !tilesDue_) return false;
    const PacketKind kind = !joined_ ? PacketKind::hello
                            : due_   ? PacketKind::status
                                     : PacketKind::tiles;
    (due_ ? due_ : tilesDue_) = false;
    core::Writer writer =
        beginPacket(packet_, {kind, joined_ ? session_ : 0, def_.token, ++link_.sent});
    if (kind == PacketKind::status) {
        const Request request = retryIn_ <= 0 ? requested_ : Request::nothing;
        Status status{uint16_t(request),
                      loaded_,
                      received_,
                      uint32_t(world.tick() / gpu::kStepTicks),
                      link_.came.newest(),
                      state_.state().id,
                      state_.base(),
                      state_.came(),
                      runs()};
        visitStatus(writer, status);
    } else if (kind == PacketKind::tiles) {
        writer.numbers(ownNumber_, wrongSlot_);
        for (const uint32_t hash : ownBlocks_) writer.number(hash);
    }
    FW_ASSERT(packet_.size() <= def_.packetBytes, "%zu bytes", packet_.size());
    size = link_.send(packet_, room);
    return true;
}

void Client::fillState(world::World& world, FwNetState& state) const {
    state.role = FW_NET_CLIENT;
    state.phase = refused_      ? FW_NET_REFUSED
                  : !joined_    ? FW_NET_CALLING
                  : loads_ == 0 ? FW_NET_LOADING
                                : FW_NET_FOLLOWING;
    state.step = world.tick() / gpu::kStepTicks;
    state.newestKnownStep = heard_;
    state.behind = float(std::max(double(heard_) / 32 - world.persistence().seconds(), 0.0));
    state.silent = float(link_.silent);
    state.records = uint32_t(waiting_.size());
    state.peers = joined_ ? 1 : 0;
    link_.addTo(state);
    state.states = loads_;
    state.hashes = compared_;
    state.desyncs = desyncs_;
    state.repairs = repairs_;
    state.overloaded = overloaded_ ? 1 : 0;
}

}  // namespace fw::net
