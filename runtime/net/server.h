// The server's side of a shared burn: its world is the truth. What its host does to it becomes
// records, which every client gets all of, in order, with the step that each came before; who
// comes late or has gone astray gets the whole state. It moves no packet itself and knows no clock
// but what the host says has passed.
#pragma once
#include "core/handle_pool.h"
#include "net/packet.h"
#include "net/records.h"
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
    // A state is wished, which a frame of the world's brings, be it of no time.
    [[nodiscard]] bool awaitsFrame() const noexcept { return capturing_ && !captureNoted_; }
    // False: nothing is due.
    bool write(FwPeerId to, std::span<std::byte> room, uint32_t& size);
    void read(world::World& world, FwPeerId from, std::span<const std::byte> packet);
    void tell(world::World& world, std::span<const std::byte> message);
    void fillState(world::World& world, FwPeerId peer, FwNetState& state);

 private:
    static constexpr uint32_t kMostPeers = 256;
    struct Peer {
        explicit Peer(std::pmr::memory_resource* memory) : tiles(memory) {}
        uint32_t token = 0;  // its own; 0: it has not spoken
        SequenceWindow came;
        uint32_t sent = 0;                      // sequence of the last packet to it
        bool welcome = false;                   // it is due one
        bool streams = false;                   // it has a state that records go on from
        bool anew = false;                      // it needs one, as the server knows
        Wish wish = Wish::nothing;              // what it needs, as it says
        bool due = false;                       // packets, in this turn
        uint32_t loads = 0;                     // states it has taken
        uint32_t acknowledged = 0, cursor = 0;  // records
        uint32_t step = 0;                      // that it has come to
        double budget = 0;                      // bytes
        double untilDue = 0;                    // s
        double silent = 0;                      // s
        bool stale = false;   // its tiles are to be of a capture that is still to come
        ChunkSender chunks;   // of the capture, or of its tiles
        StateHead tilesHead;  // 0: of the capture
        std::pmr::vector<std::byte> tiles;
        uint32_t tilesOf = 0;  // number of the capture that it got tiles of
        Traffic traffic;
    };

    void drain(world::World& world);
    void push(const Record& record);
    void loseAll() noexcept;
    void takeCapture(world::World& world);
    void readStatus(world::World& world, Peer& peer, core::Reader& reader, uint32_t sequence);
    void readTiles(world::World& world, Peer& peer, core::Reader& reader);
    void trim() noexcept;
    bool writeStream(Peer& peer);
    bool writeChunks(Peer& peer);
    [[nodiscard]] PacketHead headOf(Peer& peer, PacketKind kind) const noexcept;

    FwNetDef def_;
    std::pmr::memory_resource* memory_;
    core::HandlePool<FwPeerId, Peer> peers_;
    world::Journal& journal_;
    RecordLog log_;
    uint32_t step_ = 0, stepEnd_ = 0;  // how far it is, and the records that are before that
    double now_ = 0;                   // s
    uint64_t identity_ = 0;
    double identityAt_ = -1;
    // The state that is given to who needs one.
    StateHead capture_;
    std::pmr::vector<std::byte> captured_;
    double capturedAt_ = 0;
    bool capturing_ = false;     // one is on its way
    bool captureNoted_ = false;  // it is of what is in `noted_`
    StateHead noted_;
    uint32_t captures_ = 0;               // noted so far
    std::pmr::vector<std::byte> packet_;  // scratch
    Record record_;                       // scratch
};

}  // namespace fw::net
