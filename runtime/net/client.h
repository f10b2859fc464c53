// A client's side of a shared burn: it applies the server's commands before the same steps, and
// goes no further than the last step that the server reported. Hashes of objects show whether both
// burn alike. If they differ, or if the client has no state, it asks for one. Messages of the
// server's host are handed on in order and once each, even where a state replaces the records
// between them.
#pragma once
#include "net/packet.h"
#include "net/records.h"
#include "net/transfer.h"
#include "world/world.h"

#include <map>

namespace fw::net {

class Client {
 public:
    Client(const FwNetDef& def, world::World& world, std::pmr::memory_resource* memory);

    void update(world::World& world, float seconds);
    bool write(world::World& world, std::span<std::byte> room, uint32_t& size);
    void read(std::span<const std::byte> packet);
    // The next action of the host; see fwNet_NextAction.
    void takeTurn(world::World& world, FwNetAction& turn);
    void fillState(world::World& world, FwNetState& state) const;

 private:
    static constexpr uint32_t kNoSlot = 0xFFFFFFFFu;
    static constexpr size_t kMaxWaiting = 1u << 14;  // records that may wait for those before them

    struct Waiting {  // one record, or a run of skipped ones
        uint32_t count = 1;
        std::pmr::vector<std::byte> bytes;
    };
    struct Reached {  // the server, when it had so many records
        uint32_t step = 0, records = 0;
    };

    void readPacket(std::span<const std::byte> packet);
    void readStream(core::Reader& reader, bool newest);
    void readPiece(core::Reader& reader, bool newest);
    void checkProgress(const Reached& mark);
    void keep(uint32_t record, std::span<const std::byte> bytes);
    void countReceived(uint32_t from) noexcept;
    [[nodiscard]] RecordRuns runs() const noexcept;
    [[nodiscard]] const Waiting& front(uint32_t& end) const noexcept;
    void advance(uint32_t record) noexcept;
    void load(world::World& world);
    void ask(Request what) noexcept;
    void loadOwnState(world::World& world);
    void forgetState() noexcept;
    void compare(world::World& world);
    // slot: of the object that differs; kNoSlot: more than one may.
    void askAgain(const world::World& world, const char* why, uint32_t slot);
    void handMessage(FwNetAction& turn) noexcept;
    [[nodiscard]] bool holdsMessages() const noexcept;
    // Hands on the messages before the state that came. True: they are all handed on.
    bool reachState(const world::World& world, FwNetAction& turn);

    FwNetDef def_;
    std::pmr::memory_resource* memory_;
    world::Recording& recording_;
    uint32_t session_ = 0;
    Link link_;
    bool welcome_ = false;  // the server sent the identity of its world
    bool refused_ = false;  // and it is another one
    bool joined_ = false;   // it is this one
    uint64_t theirs_ = 0;   // the server's identity
    Request requested_ = Request::state;
    uint32_t loads_ = 0;     // states and tiles so far
    uint32_t loaded_ = 0;    // id of the last of them
    uint32_t loadedAt_ = 0;  // its record
    ChunkReceiver state_{memory_};
    // For tiles: the object, and this world's own save of where the server saved its.
    uint32_t wrongSlot_ = 0;
    uint32_t ownNumber_ = 0;  // of the server's capture; 0: there is none yet
    uint32_t ownRecord_ = 0;  // the first behind it
    std::pmr::vector<std::byte> own_{memory_};
    std::pmr::vector<uint32_t> ownBlocks_{memory_};
    bool tilesDue_ = false;
    double asking_ = 0, repaired_ = 1e9;  // s since then
    uint32_t repairs_ = 0;
    double stuck_ = 0;          // s since a piece of it came
    double retryIn_ = 0;        // s until a state is asked for again
    uint32_t next_ = 0;         // record to be applied next
    uint32_t received_ = 0;     // the records before it are applied or wait
    uint32_t messagesEnd_ = 0;  // behind the last message that was handed on
    std::pmr::map<uint32_t, Waiting> waiting_{memory_};  // by record
    uint32_t contradictions_ = 0;  // newest packets, in a row, against what others said
    bool overloaded_ = false;      // the server says that its rate cannot carry the changes
    std::pmr::vector<Reached> marks_{memory_};
    uint32_t reached_ = 0;  // steps below it have all their records here
    uint32_t heard_ = 0;    // the last step that the server reported
    double owed_ = 0;       // s that the world is to be moved on
    double untilDue_ = 0;   // s
    bool due_ = true;
    std::pmr::vector<world::ObjectHash> theirHashes_{memory_}, ourHashes_{memory_};
    uint64_t compared_ = 0;
    uint32_t desyncs_ = 0;
    std::pmr::vector<std::byte> packet_{memory_};  // scratch
    Record record_;                                // scratch
};

}  // namespace fw::net
