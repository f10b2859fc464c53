// The server's side of a shared burn: its world is authoritative. Its host's commands become
// records, which every client gets in order, each with its step. A client that joins late, falls
// too far behind or diverges gets the whole state. The host moves the packets and gives the time.
// The server checks every number of a packet against what it sent before it uses any of them.
#pragma once
#include "core/handle_pool.h"
#include "net/packet.h"
#include "net/protocol.h"
#include "net/records.h"
#include "net/round_trip.h"
#include "net/transfer.h"
#include "world/world.h"

namespace fw::net {

void checkNetDef(const FwNetDef& def);  // throws

class Server {
 public:
    Server(const FwNetDef& def, world::World& world, std::pmr::memory_resource* memory);

    FwPeerId addPeer();
    void removePeer(FwPeerId id) { peers_.destroy(id); }
    void update(world::World& world, float seconds);
    // A save is requested; the next frame of the world takes it, even one of deltaTime 0.
    [[nodiscard]] bool awaitsFrame() const noexcept { return capturing_ && !captureRequested_; }
    // False: nothing is due.
    bool write(FwPeerId to, std::span<std::byte> room, uint32_t& size);
    void read(world::World& world, FwPeerId from, std::span<const std::byte> packet);
    void sendMessage(world::World& world, std::span<const std::byte> message);
    void fillState(world::World& world, FwPeerId peer, FwNetState& state);

 private:
    struct Given {  // a state or tiles that a peer was sent
        uint32_t id = 0, record = 0;
        bool whole = false;  // every piece was sent at least once
    };
    struct Peer {
        explicit Peer(std::pmr::memory_resource* memory) : tiles(memory) {}
        uint32_t token = 0;  // its own; 0: it has not spoken
        PeerPhase phase = PeerPhase::calling;
        Link link;
        bool welcome = false;    // it is due one
        bool due = false;        // packets, in this turn
        bool skips = false;      // it fell: of records before its next state it gets messages alone
        bool pieceNext = false;  // where both are due, records and pieces alternate
        bool overloaded = false;      // the rate cannot carry the changes
        uint32_t loaded = 0;          // id of the state that it has
        std::array<Given, 16> given;  // newest last
        uint32_t states = 0;          // that it has loaded
        uint32_t resyncs = 0;         // states because it was too far behind
        uint64_t messagesLost = 0;
        // Records: acknowledged <= cursor <= sentEnd, the end of those that were ever sent to it.
        uint32_t acknowledged = 0, cursor = 0, sentEnd = 0;
        RecordRuns runs;      // of records that it has behind these
        uint32_t sentIn = 0;  // number of the last packet with records
        double resendAt = 0;  // s: then records without an answer count as lost
        double resentAt = 0;  // s
        RoundTrip trip;
        uint32_t step = 0;         // that it has come to
        double budget = 0;         // bytes
        double untilDue = 0;       // s
        double packets = 0;        // that it may send at once
        uint32_t requestedAt = 0;  // the state that it waits for is not before this record
        uint32_t capture = 0;      // number of the capture that it takes or compares with
        uint32_t compared = 0;     // number of the capture that its hashes were compared with
        double captures = 0;       // saves that the server makes for its sake at once
        double fellAt = -1e9;      // s
        double reportedAt = -1e9;  // s: when the log last said that its rate is too low
        ChunkSender chunks;        // of the state or of its tiles
        StateHead head;
        std::pmr::vector<std::byte> tiles;
    };
    struct Capture {
        StateHead head;
        std::pmr::vector<std::byte> bytes;
        double at = 0;  // s
        [[nodiscard]] uint32_t number() const noexcept { return head.id / 2; }
    };

    void drain(world::World& world);
    void append(const Record& record);  // may throw
    void push(const Record& record);
    [[nodiscard]] uint32_t neededFrom(bool messagesAlone) noexcept;
    void dropLog(uint32_t record) noexcept;
    void discardAll() noexcept;
    void trim(const world::World& world) noexcept;
    void move(Peer& peer, PeerEvent event) noexcept;
    void fall(Peer& peer) noexcept;
    [[nodiscard]] double backlogOf(const Peer& peer) const noexcept;
    void watchBacklog(const world::World& world, Peer& peer, uint32_t name) noexcept;
    [[nodiscard]] Capture* captureOf(uint32_t number) noexcept;
    void endCapture() noexcept;
    template <class Part>
    void tryCapture(const world::World& world, const Part& part) noexcept;
    void fetchCapture(world::World& world);
    void dropCaptures() noexcept;
    void collectCaptures(world::World& world);
    void begin(Peer& peer, const StateHead& head, size_t bytes);
    [[nodiscard]] double maxBudget() const noexcept;
    [[nodiscard]] bool hasSpareRate(const Peer& peer) const noexcept;
    [[nodiscard]] PacketHead headOf(Peer& peer, PacketKind kind) noexcept;
    [[nodiscard]] uint32_t streamEnd(const Peer& peer) const noexcept;
    bool writeStream(Peer& peer, bool pieceDue);
    bool writePiece(Peer& peer, uint32_t piece);
    void readPacket(world::World& world, Peer& peer, uint32_t name,
                    std::span<const std::byte> packet);
    [[nodiscard]] static const Given* givenOf(const Peer& peer, uint32_t id) noexcept;
    void checkStatus(const Peer& peer, const Status& status, bool newest) const;
    void readStatus(world::World& world, Peer& peer, core::Reader& reader, bool newest);
    void readTiles(world::World& world, Peer& peer, core::Reader& reader);

    FwNetDef def_;
    std::pmr::memory_resource* memory_;
    core::HandlePool<FwPeerId, Peer> peers_{"Peer", memory_};
    world::Recording& recording_;
    RecordLog log_{memory_};
    uint32_t step_ = 0, stepEnd_ = 0;  // how far it is, and the records that are before that
    double now_ = 0;                   // s
    uint64_t identity_ = 0;
    double identityAt_ = -1;
    uint64_t pushed_ = 0, pushedBefore_ = 0;  // bytes of records
    double changeRate_ = 0, changeRateAt_ = 0;
    std::pmr::vector<Capture> captures_{memory_};  // oldest first
    size_t stateBytes_ = 0;                        // of the newest
    bool capturing_ = false;                       // one is on its way
    bool captureRequested_ = false;                // it is of what is in `recorded_`
    double captureFailedAt_ = -1e9;                // s
    StateHead recorded_;
    uint32_t captureCount_ = 0;                    // noted so far
    std::pmr::vector<std::byte> packet_{memory_};  // scratch
    Record record_;                                // scratch
};

}  // namespace fw::net
