// A client's side of a shared burn: it does what the server's host did, before the same steps, and
// goes no further than it has heard of. Hashes of objects tell whether both burn alike; if not, or
// if it has no state yet, it asks for one.
#pragma once
#include "net/packet.h"
#include "net/records.h"
#include "net/transfer.h"
#include "world/world.h"

#include <deque>

namespace fw::net {

class Client {
 public:
    Client(const FwNetDef& def, world::World& world, std::pmr::memory_resource* memory);

    void update(world::World& world, float seconds);
    bool write(world::World& world, std::span<std::byte> room, uint32_t& size);
    void read(std::span<const std::byte> packet);
    // What to do next; see fwNet_TakeTurn.
    void takeTurn(world::World& world, FwNetTurn& turn);
    void fillState(world::World& world, FwNetState& state) const;

 private:
    static constexpr uint32_t kNoSlot = 0xFFFFFFFFu;
    static constexpr uint32_t kAhead = 1u << 14;  // records that may wait

    using Bytes = std::pmr::vector<std::byte>;
    struct Reached {  // the server, when it had so many records
        uint32_t step = 0, records = 0;
    };

    void readStream(core::Reader& reader, uint32_t sequence);
    void readPiece(core::Reader& reader);
    void load(world::World& world);
    void wish(Wish what) noexcept;
    void takeOwn(world::World& world);
    void forgetState() noexcept;
    void compare(world::World& world);
    // slot: of the object that differs; kNoSlot: more than one may.
    void goAstray(const world::World& world, const char* why, uint32_t slot);
    void settleMarks() noexcept;

    FwNetDef def_;
    std::pmr::memory_resource* memory_;
    world::Journal& journal_;
    uint32_t session_ = 0, sent_ = 0;
    SequenceWindow came_;
    bool welcome_ = false;  // the server told what its world is
    bool refused_ = false;  // and it is another one
    bool joined_ = false;   // it is this one
    uint64_t theirs_ = 0;   // the server's identity
    Wish wish_ = Wish::state;
    uint32_t loads_ = 0;
    uint32_t streamsAfter_ = 0;  // sequence
    ChunkReceiver state_;
    // For tiles: the object, and this world's own save of where the server saved its.
    uint32_t astraySlot_ = 0;
    uint32_t ownNumber_ = 0;  // of the server's capture; 0: there is none yet
    std::pmr::vector<std::byte> own_;
    std::pmr::vector<uint32_t> ownBlocks_;
    bool tilesDue_ = false;
    double wishing_ = 0, repaired_ = 1e9;  // s since then
    uint32_t repairs_ = 0;
    double stuck_ = 0;                // s since a piece of it came
    double retryIn_ = 0;              // s until a state is asked for again
    uint32_t next_ = 0;               // record to be done next
    std::pmr::deque<Bytes> waiting_;  // from next_ on; empty: it did not come yet
    uint32_t ready_ = 0;              // of those, that came without a gap
    std::pmr::vector<Reached> marks_;
    uint32_t reached_ = 0;  // steps below it have all their records here
    uint32_t heard_ = 0;    // step of the server's that it told last
    double owed_ = 0;       // s that the world is to be moved on
    double untilDue_ = 0;   // s
    double silent_ = 0;     // s
    bool due_ = true;
    std::pmr::vector<world::ObjectHash> theirHashes_, ourHashes_;
    uint64_t compared_ = 0;
    uint32_t strays_ = 0;
    Traffic traffic_;
    std::pmr::vector<std::byte> packet_;  // scratch
    Record record_;                       // scratch
};

}  // namespace fw::net
