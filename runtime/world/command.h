// Commands: the host's calls that change what burns, as values. A command log, a timeline and a
// network carry them; PersistenceSystem::apply makes each of them again. Creating and destroying is
// no command: every host does that by itself. Things are named by slot.
#pragma once
#include "components/heat_occlusion.h"
#include "components/room.h"
#include "components/wind_grid.h"
#include "save/archive.h"

#include <algorithm>
#include <variant>

namespace fw::world {

struct SetWind {
    float wind[3] = {};  // m/s

    FW_SERIALIZE(wind)
};

struct SetFlags {
    uint32_t flags = 0;  // FwWorldFlags

    FW_SERIALIZE(flags)
};

// Ascending numbers as runs of consecutive ones.
struct Runs {
    static constexpr uint32_t kMost = 8;
    struct Run {
        uint32_t first = 0;
        uint16_t count = 0;

        FW_SERIALIZE(first, count)
    };
    uint16_t count = 0;
    std::array<Run, kMost> runs{};

    // False: there is no run left for it.
    bool add(uint32_t value) noexcept {
        if (count > 0) {
            Run& last = runs[count - 1u];
            if (value == uint64_t(last.first) + last.count && last.count < 0xFFFF) {
                ++last.count;
                return true;
            }
        }
        FW_ASSERT(count <= kMost, "%u runs", count);
        if (count == kMost) return false;
        runs[count++] = {value, 1};
        return true;
    }
    template <class Visit>
    void each(const Visit& visit) const {
        for (uint32_t i = 0; i < count; ++i)
            for (uint32_t k = 0; k < runs[i].count; ++k) visit(runs[i].first + k);
    }
    template <class A>
    void serialize(A& a) {
        a(count);
        a.require(count <= kMost, "number of runs");
        for (uint32_t i = 0; i < count; ++i) a(runs[i]);
    }
};

struct TexelChange {     // that an ignition, water or a puff brings
    uint32_t kind = 0;   // FwIgnitionKind
    uint32_t tick = 0;   // at which it takes effect
    uint32_t water = 0;  // g/m^2

    FW_SERIALIZE(kind, tick, water)
};

// The place that a host lights is resolved to texels before it is recorded: no floating point
// decides what a command changes.
struct IgniteTexels {
    uint32_t slot = 0;
    TexelChange change;
    Runs texels;

    FW_SERIALIZE(slot, change, texels)
};

struct IgniteObjects {  // all of their texels
    TexelChange change;
    Runs slots;

    FW_SERIALIZE(change, slots)
};

struct WetPatch {  // of a jet's fuel that sticks
    uint32_t emitter = 0, patch = 0;
    uint32_t grams = 0;  // per m^2; components::kPatchDrowned: all that it takes
    uint32_t tick = 0;

    FW_SERIALIZE(emitter, patch, grams, tick)
};

struct Transform {  // an affine matrix without its last row, in columns
    float columns[12] = {};

    Transform() = default;
    explicit Transform(const float matrix[16]) noexcept {
        for (int c = 0; c < 4; ++c) std::copy_n(matrix + 4 * c, 3, columns + 3 * c);
    }
    [[nodiscard]] std::array<float, 16> matrix() const noexcept {
        std::array<float, 16> all{};
        for (int c = 0; c < 4; ++c) std::copy_n(columns + 3 * c, 3, all.data() + 4 * c);
        all[15] = 1;
        return all;
    }
    FW_SERIALIZE(columns)
};

struct SlotTransform {
    uint32_t slot = 0;
    Transform transform;

    FW_SERIALIZE(slot, transform)
};
struct SetPose : SlotTransform {};
struct MoveHeatOccluder : SlotTransform {};

struct SlotNumber {
    uint32_t slot = 0;
    float value = 0;

    FW_SERIALIZE(slot, value)
};
struct SetFirePower : SlotNumber {};     // kW
struct SetEmitterPower : SlotNumber {};  // kW
struct SetFieldAmount : SlotNumber {};

struct MoveFire {
    uint32_t slot = 0;
    float position[3] = {};

    FW_SERIALIZE(slot, position)
};

template <size_t kNumbers>
struct MoveAndTurn {
    uint32_t slot = 0;
    bool turns = false;  // else it keeps its direction
    float position[3] = {}, direction[kNumbers] = {};

    MoveAndTurn() = default;
    MoveAndTurn(uint32_t slotOf, const float* to, const float* along)  // null: not turned
        : slot(slotOf), turns(along != nullptr) {
        std::copy_n(to, 3, position);
        if (along) std::copy_n(along, kNumbers, direction);
    }
    template <class A>
    void serialize(A& a) {
        a(slot, turns, position);
        if (turns) a(direction);
    }
};
using MoveEmitter = MoveAndTurn<3>;
using MoveField = MoveAndTurn<4>;  // direction: a quaternion

struct SetWindZone {
    uint32_t slot = 0;
    components::WindZone zone;

    FW_SERIALIZE(slot, zone)
};

struct SetRoom {
    uint32_t slot = 0;
    bool refills = false;
    components::Room room;

    FW_SERIALIZE(slot, refills, room)
};

struct PlayBurn {
    uint32_t slot = 0;
    uint32_t burn1 = 0;  // slot + 1
    uint32_t tick = 0;   // of the first ignition
    float speed = 0;

    FW_SERIALIZE(slot, burn1, tick, speed)
};

struct StopBurn {
    uint32_t slot = 0;

    FW_SERIALIZE(slot)
};

struct SetWindGrid {  // calm, until SetWindPoints follow
    components::WindGridShape shape;

    FW_SERIALIZE(shape)
};

struct SetWindPoints {
    static constexpr uint32_t kCount = 8;
    uint32_t first = 0;
    std::array<components::WindPoint, kCount> values{};

    template <class A>
    void serialize(A& a) {
        a(first, values);
        for (const components::WindPoint& point : values)
            for (const int16_t units : point)
                a.require(units >= -fire::kMaxWindUnits && units <= fire::kMaxWindUnits,
                          "wind at a grid point");
    }
};

// Records a large state in parts of type Part, those alone that differ from `before`, which is all
// zeros where `stays` is false: Part::kCount values each, in the member `values`.
template <class Part, class Recorder, class Values>
void recordParts(Recorder& recorder, const Values& values, const Values& before, bool stays) {
    for (uint32_t first = 0; first < values.size(); first += Part::kCount) {
        Part part{first};
        const auto count = std::min<size_t>(Part::kCount, values.size() - first);
        std::copy_n(values.begin() + first, count, part.values.begin());
        const auto begin = part.values.begin(), end = begin + ptrdiff_t(count);
        const bool same = stays ? std::equal(begin, end, before.begin() + first)
                                : std::all_of(begin, end, [](const auto& value) {
                                      return value == std::remove_cvref_t<decltype(value)>{};
                                  });
        if (!same) recorder.record(part);
    }
}

struct SetGusts {
    int64_t strength = 0, size = 0;  // as in components::Gusts

    FW_SERIALIZE(strength, size)
};

struct SetHeatOcclusion {  // empty, until SetOcclusionCells and AddOcclusionObject follow
    components::OcclusionGridShape shape;

    FW_SERIALIZE(shape)
};

struct SetOcclusionCells {
    static constexpr uint32_t kCount = 12;  // of 32 cells each
    uint32_t first = 0;                     // word
    std::array<uint32_t, kCount> values{};

    FW_SERIALIZE(first, values)
};

struct AddOcclusionObject {
    uint32_t object1 = 0;  // slot + 1; 0: none
    bool last = false;     // the objects added so far fill their cells

    FW_SERIALIZE(object1, last)
};

struct ShiftOrigin {
    int32_t metres[3] = {};

    FW_SERIALIZE(metres)
};

struct TransferBurn {
    uint32_t to = 0, from = 0;

    FW_SERIALIZE(to, from)
};

// In files and packets a command is its place in this list, then its fields.
using Command = std::variant<SetWind, SetFlags, IgniteTexels, IgniteObjects, WetPatch, SetPose,
                             MoveHeatOccluder, MoveFire, SetFirePower, MoveEmitter, SetEmitterPower,
                             MoveField, SetFieldAmount, SetWindZone, SetRoom, PlayBurn, StopBurn,
                             SetWindGrid, SetWindPoints, SetGusts, SetHeatOcclusion,
                             SetOcclusionCells, AddOcclusionObject, ShiftOrigin, TransferBurn>;
constexpr uint32_t kCommandKinds = std::variant_size_v<Command>;

// The fields alone; the kind is the caller's to write.
void writeCommand(const Command& command, std::pmr::vector<std::byte>& out);
// Throw unless `kind` is one and the bytes have its fields; the second: of a packet, all of them.
void readCommand(uint32_t kind, save::Reader& reader, Command& command);
void readCommand(uint32_t kind, std::span<const std::byte> bytes, Command& command);

}  // namespace fw::world
