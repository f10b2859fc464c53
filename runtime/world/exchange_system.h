// Heat between objects: poses become integers at fixed ticks, neighbours and contacts are found
// where something moved, and the backend gets all of it with the step that begins there. Besides,
// what stands between: occluders and the heat-occlusion grid.
#pragma once
#include "components/exchange_object.h"
#include "components/heat_occlusion.h"
#include "world/command.h"
#include "world/neighbours.h"
#include "world/scene.h"
#include "world/slotted.h"

namespace fw::world {

class WindSystem;

constexpr uint32_t kHeatTransferModes =
    FW_WORLD_RADIATION | FW_WORLD_PLUME | FW_WORLD_CONTACT | FW_WORLD_EMBERS;
constexpr uint32_t kWorldFlags =
    kHeatTransferModes | FW_WORLD_NO_SPREAD | FW_WORLD_NO_DAMAGE | FW_WORLD_NO_HOLES;

struct HeatOccluderEntry {
    components::Pose pose;
    float halfSize[3] = {};

    template <class A>
    void serialize(A& a) {
        a(pose, halfSize);
        a.range("occluder's place", pose.translation, -1e6, 1e6);
        a.range("occluder's half size", halfSize, 0, 30);
    }
};

// Contacts of two objects as of the last search.
struct PairContacts {
    uint32_t slots[2] = {}, versions[2] = {};
    FwBurnableMeshId ids[2] = {};
    uint32_t since = 0;  // tick, while they touch
    bool touches = false;
    uint64_t stamp = 0;  // TransferState::contactStamp of the last search that found them near

    template <class A>
    void serialize(A& a) {
        for (uint32_t& slot : slots) a.object("a contact", slot);
        a(since);
    }
};

// An object whose box is near enough to touch.
struct CloseObject {
    uint32_t slot = 0xFFFFFFFFu;
    uint32_t pair = 0;  // of TransferState::pairs
};

// The host's answer: how much of slots[0] a fire of slots[1] sees.
struct Seen {
    uint32_t slots[2] = {};
    uint32_t part = 255;  // of 255

    template <class A>
    void serialize(A& a) {
        for (uint32_t& slot : slots) a.object("a line of sight", slot);
        a(part);
        a.range("visible share", part, 0, 255);
    }
};

struct ExchangeSnapshot {
    explicit ExchangeSnapshot(std::pmr::memory_resource* memory)
        : pairs(memory),
          seen(memory),
          occluders(memory),
          latchedOccluders(memory),
          heatOcclusion(memory) {}
    uint32_t flags = 0;  // FwWorldFlags
    bool warms = false, occludersDue = false;
    uint64_t fades = 0;                    // tick
    std::pmr::vector<PairContacts> pairs;  // that touch
    std::pmr::vector<Seen> seen;
    SlottedList<HeatOccluderEntry> occluders;
    std::pmr::vector<gpu::HeatOccluder> latchedOccluders;
    components::HeatOcclusion heatOcclusion;

    template <class A>
    void serialize(A& a) {
        a(flags, warms, occludersDue, fades);
        a.list("pairs that touch", pairs, 12);
        a.list("pairs whose sight is known", seen, 12);
        a.list("occluders", occluders, 64);
        a.list("latched occluders", latchedOccluders, 64);
        a(heatOcclusion);
    }
};

// Neighbours and contacts of latched objects. Kept across frames, so that a frame searches only for
// what moved. A frame that fails leaves it stale at worst: the next one sends it again.
struct TransferState {
    explicit TransferState(std::pmr::memory_resource* given) : memory(given) {}
    std::pmr::memory_resource* memory;
    [[nodiscard]] static gpu::ContactLink noLink() noexcept {
        gpu::ContactLink link{};
        link.object = gpu::kNoneTexel;
        return link;
    }
    uint32_t flags = 0;        // FwWorldFlags: heat-transfer modes
    uint32_t objectFlags = 0;  // FwWorldFlags that objects are created under
    components::Governance governance;
    uint32_t governedObjects = 0;  // that limit their fire
    uint32_t cappedObjects = 0;    // and the number of their burning tiles
    [[nodiscard]] bool governed() const noexcept {
        return governedObjects != 0 || components::governs(governance);
    }
    bool unsent = false;  // the backend does not know the latest
    bool occludersDue = false;
    bool warms = false;             // radiation or plumes were on at some time
    uint64_t fades = 0;             // tick until which heat received from switched-off modes fades
    SlotSet unsentSlots{memory};    // of records that the backend lacks
    uint32_t version = 0;           // of the last latched object
    Neighbours neighbours{memory};  // of latched boxes
    std::pmr::vector<Seen> loadedSeen{memory};  // kept by slots until the lists are rebuilt
    bool rebuild = false;                       // all but `pairs` is stale
    // Placed objects that no event touched, and some that one did since.
    SlotSet waiting{memory};
    bool spreadKnown = false;  // all neighbours of touched objects are touched, but for changed()
    // Objects latched since their contacts were found, and since the host was asked what they see.
    SlotSet contactsDue{memory}, seenDue{memory};
    ListPool<CloseObject> close{memory, {}};  // by the other's slot
    std::pmr::vector<PairContacts> pairs{memory};
    ListPool<gpu::ContactLink> links{memory, noLink()};  // of the target's slot, by texel
    uint64_t contactStamp = 0;
    mesh::Contacts contacts{memory};                                   // scratch
    std::pmr::vector<gpu::ContactLink> fresh{memory}, merged{memory};  // scratch
    std::pmr::vector<gpu::HeatOccluder> occluders{memory};             // latched
};

struct HeatOcclusionState {
    explicit HeatOcclusionState(std::pmr::memory_resource* memory)
        : grid(memory), commandSlots(memory), words(memory), fallen(memory) {}
    components::HeatOcclusion grid;
    std::pmr::vector<uint32_t> commandSlots;  // that commands of one grid named so far
    std::pmr::vector<uint32_t> words;         // as the backend gets it
    std::pmr::vector<uint8_t> fallen;         // scratch
    gpu::OcclusionUpdate update;
    bool unpacked = false;  // `words` are of another grid
    bool unsent = false;    // the backend does not know the latest
};

// The arrays that a ExchangeUpdate of a frame points to.
struct ExchangeTables {
    explicit ExchangeTables(std::pmr::memory_resource* given) : memory(given) {}
    std::pmr::memory_resource* memory;
    std::pmr::vector<gpu::ExchangeUpdate::Placed> objects{memory};
    std::pmr::vector<gpu::ExchangeUpdate::Range> neighbourRanges{memory}, linkRanges{memory};
    // Copies, where the lists change again in the same frame.
    std::pmr::vector<uint32_t> neighbours{memory};
    std::pmr::vector<gpu::ContactLink> links{memory};
    std::pmr::vector<gpu::HeatOccluder> occluders{memory};
    gpu::ExchangeUpdate update;
};

using HeatOccluders = core::HandlePool<FwHeatOccluderId, HeatOccluderEntry>;

class ExchangeSystem {
 public:
    ExchangeSystem(const WorldContext& context, Scene& scene, const WindSystem& wind);

    void setFlags(uint32_t given);
    // Of structSize 0: removes it. unitsPerMetre: of the def's function.
    void setHeatOcclusion(const FwHeatOcclusionDef& def, float unitsPerMetre = 1);
    FwHeatOccluderId addHeatOccluder(const FwHeatOccluderDef& def);
    void moveHeatOccluder(FwHeatOccluderId id, const float transform[16]);
    void removeHeatOccluder(FwHeatOccluderId id);

    void beginFrame() noexcept;
    // awake: the step will run.
    void plan(gpu::StepPlan& step, uint32_t now, bool awake);
    // After the frame touched all objects that fire may reach. `spreadFound`: those next to touched
    // ones; `waitersTouched`: all that waited.
    void commit(bool spreadFound, bool waitersTouched) noexcept;
    void onCounters(Object& object, const gpu::Readback& readback) noexcept;
    void addObject(const Object& object) noexcept;
    void forgetObject(const Object& object) noexcept;  // that goes
    void forgetSpread() noexcept { transfer_.spreadKnown = false; }
    void reserveSlots();  // throws std::bad_alloc
    // visit(place, name, slot) for all that a shift of the origin moves and may refuse.
    template <class Visit>
    void eachPlace(const Visit& visit) {
        for (auto [i, occluder] : occluders_.entries())
            visit(occluder.pose.translation, "occluder", i);
        if (heatOcclusion_.grid.shape.cells() != 0)
            visit(heatOcclusion_.grid.shape.origin, "heat-occlusion grid", 0u);
    }
    // Throws std::bad_alloc; then nothing has changed.
    [[nodiscard]] std::pmr::vector<Seen> recordedSeen() const;
    void shiftOrigin(const double (&by)[3]) noexcept;  // all else
    // After a shift that had the lists of neighbours rebuilt.
    void restoreSeen(std::pmr::vector<Seen>& seen) noexcept {
        if (transfer_.rebuild) transfer_.loadedSeen.swap(seen);
    }

    void apply(const SetFlags& command) { setFlags(command.flags); }
    void apply(const MoveHeatOccluder& command) {
        moveHeatOccluder(occluders_.findId(command.slot), command.transform.matrix().data());
    }
    void apply(const SetHeatOcclusion& command);
    void apply(const SetOcclusionCells& command);
    void apply(const AddOcclusionObject& command);
    void capture(ExchangeSnapshot& to) const;
    // Throws unless restore takes it; then it needs no memory.
    void checkSnapshot(const ExchangeSnapshot& from);
    void restore(ExchangeSnapshot& from) noexcept;  // before objects are
    void restoreObject(Object& object, bool placed) noexcept;

    [[nodiscard]] const TransferState& transfer() const noexcept { return transfer_; }
    [[nodiscard]] const HeatOccluders& occluders() const noexcept { return occluders_; }
    [[nodiscard]] const components::HeatOcclusion& occlusionGrid() const noexcept {
        return heatOcclusion_.grid;
    }
    [[nodiscard]] bool isOn() const noexcept {
        return transfer_.flags != 0 || transfer_.governed() ||
               context_.clock.tick < transfer_.fades;
    }
    [[nodiscard]] uint64_t pairsExamined() const noexcept {
        return transfer_.neighbours.examined();
    }
    [[nodiscard]] components::OcclusionView occlusionView();
    [[nodiscard]] uint64_t neighbourBytes() const noexcept;
    [[nodiscard]] uint64_t contactBytes() const noexcept;

 private:
    // exchange_system.cpp
    void latchPoses(uint32_t now);
    [[nodiscard]] gpu::ExchangeObject recordOf(const Object& object) const noexcept;
    void updateReach(Object& object) noexcept;
    void updateWind(Object& object, int wind) noexcept;
    void markUnsent(Object& object) noexcept;  // its record
    void rebuild();
    void keepPlanned();
    void queryVisibility();
    uint32_t seenPart(const Object& from, const Object& to) const;
    void findLinks(uint32_t now);
    void linkClose(Object& object, uint32_t now);
    void addLinkLists();
    [[nodiscard]] uint32_t closeIndex(uint32_t slot, uint32_t other) const noexcept;
    void addClose(uint32_t pair);
    uint32_t closePair(uint32_t a, uint32_t b);
    void dropPair(uint32_t pair) noexcept;
    void dropLinks(uint32_t to, uint32_t from) noexcept;
    gpu::ExchangePush rules() const noexcept;
    void addLinks(const Object& to, const Object& from, std::span<const mesh::Contact> contacts,
                  uint32_t since);
    void countGoverned(const Object& object, bool more) noexcept;
    void recordSeen(std::pmr::vector<Seen>& to) const;
    void restoreSeen();
    // heat_occlusion.cpp
    components::OcclusionObject occlusionObjectOf(uint32_t slot) noexcept;
    void bakeHeatOcclusion(const components::OcclusionGridShape& shape,
                           std::pmr::vector<uint32_t>& slots,
                           std::pmr::vector<components::OcclusionCell>& baked);
    void uploadOcclusion(const components::HeatOcclusion& made,
                         std::span<const uint32_t> slots) noexcept;
    void adoptOcclusion(components::HeatOcclusion& made) noexcept;  // takes its cells
    void occlusionChanged() noexcept;
    void removeOccluderCells(uint32_t slot) noexcept;
    void packHeatOcclusion();
    void planOcclusion(gpu::StepPlan& step, bool awake);

    [[nodiscard]] std::array<SlotSet*, 4> slotSets() noexcept {
        return {&transfer_.unsentSlots, &transfer_.waiting, &transfer_.contactsDue,
                &transfer_.seenDue};
    }

    const WorldContext& context_;
    Scene& scene_;
    const WindSystem& wind_;
    TransferState transfer_{context_.memory};
    HeatOccluders occluders_{"HeatOccluder", context_.memory};
    HeatOcclusionState heatOcclusion_{context_.memory};
    // Of a frame: tables of its updates, of which `used` are planned.
    struct Frame {
        explicit Frame(std::pmr::memory_resource* memory) : tables(memory) {}
        std::pmr::vector<core::Owned<ExchangeTables>> tables;
        size_t used = 0;
        bool latched = false, flushed = false, occlusionSent = false;
    };
    Frame frame_{context_.memory};
};

}  // namespace fw::world
