// Saves as bytes: one description of every record for both directions, and the planes of an object.
#include "core/hash.h"
#include "core/stream.h"
#include "save/plane.h"
#include "shared/heat.h"
#include "world/save.h"

#include <algorithm>
#include <bit>

namespace fw::world {
namespace {

using core::Reader;
using core::Writer;
using save::PlaneMask;

constexpr uint32_t kMagic = 0x56535746u;  // "FWSV"
constexpr size_t kHeaderBytes = 24;
constexpr const char* kWhat = "save";
constexpr uint32_t kMostWindPlane =
    2 * uint32_t(fire::kMostWindUnits);  // see WindGrid's plane of an axis

// FNV-1a over 8 bytes at a time, the last few one by one: a save has many.
uint64_t checksum(std::span<const std::byte> bytes) noexcept {
    uint64_t hash = core::kFnvOffset;
    size_t at = 0;
    for (; at + 8 <= bytes.size(); at += 8) {
        uint64_t word = 0;
        for (size_t k = 0; k < 8; ++k) word |= uint64_t(bytes[at + k]) << (8 * k);
        hash = (hash ^ word) * core::kFnvPrime;
        hash ^= hash >> 29;
    }
    for (; at < bytes.size(); ++at) hash = (hash ^ uint64_t(bytes[at])) * core::kFnvPrime;
    return hash;
}

// ---- records: `s` is a Writer and T const, or a Reader -----------------------------------------

template <typename S, typename T>
concept Is = std::is_same_v<std::remove_const_t<S>, T>;

template <typename S, Is<components::Pose> T>
void put(S& s, T& value);
template <typename S, Is<fire::WindFilter> T>
void put(S& s, T& value);
template <typename S, Is<SavedTouch> T>
void put(S& s, T& value);
template <typename S, Is<components::JetGate> T>
void put(S& s, T& value);
template <typename S, Is<components::JetHit> T>
void put(S& s, T& value);
template <typename S, Is<components::JetRay> T>
void put(S& s, T& value);
template <typename S, Is<components::JetParcel> T>
void put(S& s, T& value);
template <typename S, Is<components::JetPatch> T>
void put(S& s, T& value);
template <typename S, Is<PendingTexel> T>
void put(S& s, T& value);
template <typename S, Is<SavedTag> T>
void put(S& s, T& value);
template <typename S, Is<SavedPair> T>
void put(S& s, T& value);
template <typename S, Is<Seen> T>
void put(S& s, T& value);
template <typename S, Is<SavedStats> T>
void put(S& s, T& value);
template <typename S, Is<SavedEvent> T>
void put(S& s, T& value);
template <typename S, Is<SavedBreaks> T>
void put(S& s, T& value);
template <typename S, Is<SavedBlocker> T>
void put(S& s, T& value);
template <typename S, Is<gpu::Blocker> T>
void put(S& s, T& value);
template <typename S, Is<SavedWindZone> T>
void put(S& s, T& value);
template <typename S, Is<components::WindGrid> T>
void put(S& s, T& value);
template <typename S, Is<components::HeatShield> T>
void put(S& s, T& value);
template <typename S, Is<components::Gusts> T>
void put(S& s, T& value);
template <typename S, Is<SavedRoom> T>
void put(S& s, T& value);
template <typename S, Is<SavedFire> T>
void put(S& s, T& value);
template <typename S, Is<Story> T>
void put(S& s, T& value);
template <typename S, Is<SavedObject> T>
void put(S& s, T& value);
template <typename S, Is<SavedEmitter> T>
void put(S& s, T& value);
template <typename S, Is<SavedField> T>
void put(S& s, T& value);

template <typename S, typename T>
requires std::is_arithmetic_v<std::remove_const_t<T>>
void put(S& s, T& value) { s.number(value); }

template <typename S, typename T, size_t N>
void put(S& s, T (&values)[N]) {
    for (auto& value : values) put(s, value);
}
template <typename S, typename T, size_t N>
void put(S& s, std::array<T, N>& values) {
    for (auto& value : values) put(s, value);
}
template <typename S, typename T, size_t N>
void put(S& s, const std::array<T, N>& values) {
    for (auto& value : values) put(s, value);
}

template <typename S, typename... T>
void all(S& s, T&... values) {
    (put(s, values), ...);
}

// Structs of words alone, as backends share them.
template <typename S, typename T>
void putWords(S& s, T& value) {
    using Words = std::array<uint32_t, sizeof(T) / sizeof(uint32_t)>;
    static_assert(sizeof(Words) == sizeof(T) && std::is_trivially_copyable_v<T>);
    auto words = std::bit_cast<Words>(value);
    for (uint32_t& word : words) s.number(word);
    if constexpr (S::kReads) value = std::bit_cast<T>(words);
}

template <typename S, Is<components::Pose> T>
void put(S& s, T& p) {
    all(s, p.rotation, p.scale, p.stretch, p.translation);
}
template <typename S, Is<fire::WindFilter> T>
void put(S& s, T& f) {
    all(s, f.value, f.latched);
}
template <typename S, Is<SavedTouch> T>
void put(S& s, T& t) {
    all(s, t.object1);
    if (t.object1 != 0) all(s, t.since, t.fireAt, t.objectAt, t.flag);
}
template <typename S, Is<components::JetGate> T>
void put(S& s, T& g) {
    all(s, g.object, g.texel, g.holeTicks, g.distance);
}
template <typename S, Is<components::JetHit> T>
void put(S& s, T& h) {
    all(s, h.met, h.distance, h.place, h.normal, h.object.index1, h.texel);
}
template <typename S, Is<components::JetRay> T>
void put(S& s, T& r) {
    all(s, r.way, r.hit, r.spent, r.gates, r.passed, r.gateCount);
    if constexpr (S::kReads)
        if (r.gateCount > components::kJetGates)
            core::fail(FW_ERROR_BAD_DATA, "A ray of the save has passed %u holes; the limit is %u.",
                       r.gateCount, components::kJetGates);
}
template <typename S, Is<components::JetParcel> T>
void put(S& s, T& p) {
    all(s, p.launched, p.power, p.sticks, p.from, p.wide, p.most, p.flight, p.rays);
}
template <typename S, Is<components::JetPatch> T>
void put(S& s, T& p) {
    all(s, p.left);
    if (p.left == 0) return;
    all(s, p.object.index1, p.texel, p.fuel, p.power, p.water, p.waterAt, p.place, p.normal);
}
template <typename S, Is<PendingTexel> T>
void put(S& s, T& p) {
    all(s, p.object, p.texel, p.kind, p.tick, p.water, p.order, p.gateCount, p.shut);
    if constexpr (S::kReads)
        if (p.gateCount > components::kJetGates)
            core::fail(FW_ERROR_BAD_DATA,
                       "An event of the save waits for %u holes; the limit is %u.", p.gateCount,
                       components::kJetGates);
    for (uint32_t i = 0; i < p.gateCount; ++i) put(s, p.gates[i]);
}
template <typename S, Is<SavedTag> T>
void put(S& s, T& t) {
    all(s, t.object, t.texel, t.tag);
}
template <typename S, Is<SavedPair> T>
void put(S& s, T& p) {
    all(s, p.slots, p.since);
}
template <typename S, Is<Seen> T>
void put(S& s, T& seen) {
    all(s, seen.slots, seen.part);
}
template <typename S, Is<SavedStats> T>
void put(S& s, T& t) {
    all(s, t.frontTiles, t.burningTiles, t.hotTiles, t.receivers, t.lateClamps);
}
template <typename S, Is<SavedBlocker> T>
void put(S& s, T& b) {
    all(s, b.slot, b.pose, b.halfSize);
}
template <typename S, Is<gpu::Blocker> T>
void put(S& s, T& b) {
    putWords(s, b);
}
template <typename S, Is<SavedWindZone> T>
void put(S& s, T& z) {
    all(s, z.slot, z.zone.shape, z.zone.flow, z.zone.blend, z.zone.priority, z.zone.middle,
        z.zone.axis, z.zone.size, z.zone.speed, z.zone.fades);
}
// Its points as three planes, one of each axis; what is negative is odd.
template <typename S, Is<components::WindGrid> T>
void put(S& s, T& g) {
    all(s, g.shape.blend, g.shape.counts, g.shape.origin, g.shape.cell, g.shape.fade);
    if constexpr (S::kReads) {
        if (!components::plausible(g.shape))
            core::fail(FW_ERROR_BAD_DATA, "The save has a grid of wind that none can be.");
        g.points.assign(g.shape.points(), {});
    }
    if (g.points.empty()) return;
    std::pmr::vector<uint32_t> plane(g.points.size(), g.points.get_allocator());
    for (size_t axis = 0; axis < 3; ++axis) {
        if constexpr (S::kReads) {
            const uint32_t size = s.count("bytes of a grid of wind", 1);
            bool fine = save::readPlane(s.take(size), g.shape.counts[0], {}, plane);
            for (size_t i = 0; i < plane.size(); ++i) {
                fine = fine && plane[i] <= kMostWindPlane;
                g.points[i][axis] =
                    int16_t(plane[i] & 1u ? -int32_t(plane[i] / 2) - 1 : int32_t(plane[i] / 2));
            }
            if (!fine) core::fail(FW_ERROR_BAD_DATA, "The save's grid of wind is damaged.");
        } else {
            for (size_t i = 0; i < plane.size(); ++i) {
                const int32_t units = g.points[i][axis];
                plane[i] = units < 0 ? uint32_t(-units - 1) * 2 + 1 : uint32_t(units) * 2;
            }
            std::pmr::vector<std::byte> bytes(s.bytes().get_allocator());
            save::writePlane(plane, g.shape.counts[0], {}, bytes);
            s.number(uint32_t(bytes.size()));
            s.bytes().insert(s.bytes().end(), bytes.begin(), bytes.end());
        }
    }
}
// A plane of whole numbers in rows of `width`, after how many bytes it takes.
template <typename S, class Values>
void putPlane(S& s, Values& values, uint32_t width) {
    if constexpr (S::kReads) {
        const uint32_t size = s.count("bytes of a heat shield", 1);
        if (!save::readPlane(s.take(size), width, {}, values))
            core::fail(FW_ERROR_BAD_DATA, "The save's heat shield is damaged.");
    } else {
        std::pmr::vector<std::byte> bytes(s.bytes().get_allocator());
        save::writePlane(values, width, {}, bytes);
        s.number(uint32_t(bytes.size()));
        s.bytes().insert(s.bytes().end(), bytes.begin(), bytes.end());
    }
}
// The host's cells as words; of those that objects fill, how far each is behind the one before, and
// whose it is.
template <typename S, Is<components::HeatShield> T>
void put(S& s, T& g) {
    all(s, g.shape.counts, g.shape.origin, g.shape.cell);
    const auto absurd = [] {
        core::fail(FW_ERROR_BAD_DATA, "The save has a heat shield that none can be.");
    };
    if constexpr (S::kReads) {
        if (!components::plausible(g.shape)) absurd();
        g.solid.assign(g.shape.words(), 0);
    }
    if (g.shape.cells() == 0) return;
    putPlane(s, g.solid, (g.shape.counts[0] + 31) / 32);
    if constexpr (S::kReads)
        if (const uint32_t over = g.shape.cells() % 32; over != 0 && g.solid.back() >> over != 0)
            absurd();
    uint32_t count = uint32_t(g.baked.size());
    s.number(count);
    if constexpr (S::kReads) {
        if (count > gpu::kShieldBaked) absurd();
        g.baked.assign(count, {});
    }
    if (count == 0) return;
    std::pmr::vector<uint32_t> plane(count, g.solid.get_allocator());
    for (uint32_t of = 0; of < 3; ++of) {
        if constexpr (!S::kReads)
            for (uint32_t i = 0; i < count; ++i)
                plane[i] = of == 0   ? g.baked[i].cell - (i != 0 ? g.baked[i - 1].cell : 0)
                           : of == 1 ? g.baked[i].what
                                     : g.baked[i].texel;
        putPlane(s, plane, count);
        if constexpr (S::kReads)
            for (uint32_t i = 0; i < count; ++i) {
                if (of == 0) {
                    const uint64_t before = i != 0 ? g.baked[i - 1].cell : 0;
                    if (before + plane[i] >= g.shape.cells() || (i != 0 && plane[i] == 0)) absurd();
                    g.baked[i].cell = uint32_t(before + plane[i]);
                } else {
                    (of == 1 ? g.baked[i].what : g.baked[i].texel) = plane[i];
                }
            }
    }
}
template <typename S, Is<components::Gusts> T>
void put(S& s, T& g) {
    all(s, g.strength, g.size, g.drift, g.since);
}
template <typename S, Is<SavedRoom> T>
void put(S& s, T& r) {
    all(s, r.slot, r.room.middle, r.room.half, r.room.axes, r.room.volume, r.room.vent,
        r.room.oxygen, r.oxygen, r.power, r.flash, r.drawn, r.stirs);
}
template <typename S, Is<SavedFire> T>
void put(S& s, T& f) {
    all(s, f.slot, f.flags, f.position, f.power, f.touches, f.pointCount);
    if constexpr (S::kReads)
        if (f.pointCount == 1 || f.pointCount > volume::kMaxControlPoints)
            core::fail(FW_ERROR_BAD_DATA,
                       "Volumetric fire %u of the save has %u points; it has 0 or [2, %u].",
                       f.slot + 1, f.pointCount, volume::kMaxControlPoints);
    for (uint32_t i = 0; i < f.pointCount; ++i)
        all(s, f.points[i].position.x, f.points[i].position.y, f.points[i].position.z,
            f.points[i].radius);
}
template <typename S, Is<Story> T>
void put(S& s, T& o) {
    all(s, o.active, o.sawFire, o.ignitionKnown, o.lastStimulus, o.lastDouse, o.douseCause,
        o.flames, o.wentOut, o.halvedUntil, o.outCause, o.lastBurning, o.firstIgnition,
        o.ignitionPoint, o.litTold, o.spotsTold, o.mostIgnited, o.clampsTold, o.energy, o.heatSteps,
        o.power);
}
template <typename S, Is<SavedEvent> T>
void put(S& s, T& e) {
    all(s, e.type, e.tag, e.object1, e.other1, e.position, e.value);
}
// Bytes that are looked into elsewhere.
template <typename S, typename T>
void putBytes(S& s, T& bytes, const char* name) {
    if constexpr (S::kReads) {
        const uint32_t size = s.count(name, 1);
        bytes = s.take(size);
    } else {
        s.number(uint32_t(bytes.size()));
        s.bytes().insert(s.bytes().end(), bytes.begin(), bytes.end());
    }
}
template <typename S, Is<SavedBreaks> T>
void put(S& s, T& b) {
    all(s, b.share, b.area, b.shareTold, b.waits);
    putBytes(s, b.lost, "bytes of what is about to break");
}
template <typename S, Is<SavedObject> T>
void put(S& s, T& o) {
    all(s, o.slot, o.asset, o.pose, o.firstEvent, o.play.burn1, o.zoneWind, o.placed, o.due);
    if (o.play.burn1 != 0) all(s, o.burnHash, o.play.first, o.play.rate, o.play.began, o.play.ends);
    if (o.placed && o.due) putWords(s, o.remote);
    if (o.placed && !o.due) put(s, o.remote.high.w);
    all(s, o.touched, o.carried);
    if (!o.touched) {
        put(s, o.air);
        return;
    }
    all(s, o.filters, o.latched, o.story);
    putWords(s, o.counters);
    all(s, o.asksBreaks);
    if (o.asksBreaks) put(s, o.breaks);
    putBytes(s, o.planes, "bytes of an object's planes");
}

// A list: its length and its entries, each of them `bytesEach` bytes or more.
template <typename S, typename List>
void list(S& s, List& entries, const char* name, size_t bytesEach) {
    if constexpr (S::kReads) {
        const uint32_t count = s.count(name, bytesEach);
        entries.clear();
        entries.reserve(count);
        for (uint32_t i = 0; i < count; ++i) put(s, entries.emplace_back());
    } else {
        s.number(uint32_t(entries.size()));
        for (auto& entry : entries) put(s, entry);
    }
}

template <typename S, Is<SavedEmitter> T>
void put(S& s, T& e) {
    all(s, e.slot, e.flags, e.position, e.direction, e.power, e.touches, e.streams);
    if (!e.streams) return;
    all(s, e.kept, e.patches, e.patchedAt);
    list(s, e.parcels, "parcels of a jet", 16);
    const size_t rays = e.parcels.size() * components::kJetRays;
    if constexpr (S::kReads) {
        e.places.resize(e.parcels.size());
        e.swept.resize(rays);
    }
    for (size_t i = 0; i < e.parcels.size(); ++i) {
        put(s, e.places[i]);
        if constexpr (S::kReads)
            if (e.places[i] >= components::kJetParcels)
                core::fail(FW_ERROR_BAD_DATA,
                           "A parcel of the save has place %u; there are %u of them.", e.places[i],
                           components::kJetParcels);
    }
    for (size_t i = 0; i < rays; ++i) {
        bool swept = e.swept[i] != 0;
        put(s, swept);
        if constexpr (S::kReads) e.swept[i] = swept ? 1 : 0;
    }
}
template <typename S, Is<SavedField> T>
void put(S& s, T& f) {
    all(s, f.slot, f.width, f.height, f.began, f.position, f.rotation, f.amount, f.wets);
    if (!f.wets) return;
    all(s, f.step, f.emitted, f.died, f.left);
    if constexpr (S::kReads) {
        if (f.width - 1 > 255 || f.height - 1 > 255)
            core::fail(FW_ERROR_BAD_DATA,
                       "A particle field of the save has %u x %u cells; the limits are [1, 256].",
                       f.width, f.height);
        f.cells.resize(size_t(f.width) * f.height);
        const uint32_t size = s.count("bytes of a field's cells", 1);
        if (!save::readPlane(s.take(size), f.width, {}, f.cells))
            core::fail(FW_ERROR_BAD_DATA, "The cells of particle field %u in the save are damaged.",
                       f.slot + 1);
    } else {
        std::pmr::vector<std::byte> cells(s.bytes().get_allocator());
        save::writePlane(f.cells, f.width, {}, cells);
        s.number(uint32_t(cells.size()));
        s.bytes().insert(s.bytes().end(), cells.begin(), cells.end());
    }
}

template <typename S, Is<SavedWorld> T>
void put(S& s, T& w) {
    all(s, w.pace, w.up, w.spreadChance, w.timeToLive, w.seed, w.maxHops, w.maxBurningTiles);
    all(s, w.clock.tick, w.clock.fraction, w.steps, w.droppedSteps, w.order, w.wind, w.flags,
        w.warms, w.blockersDue, w.fades, w.idle, w.lastStimulus, w.gustsShown, w.roomsStirred,
        w.stats);
    list(s, w.objects, "burnable meshes", 64);
    list(s, w.pending, "events that wait", 32);
    list(s, w.tags, "tags", 12);
    list(s, w.pairs, "pairs that touch", 12);
    list(s, w.seen, "pairs whose sight is known", 12);
    list(s, w.blockers, "blockers", 64);
    list(s, w.latchedBlockers, "latched blockers", 64);
    put(s, w.windGrid);
    put(s, w.heatShield);
    put(s, w.gusts);
    put(s, w.origin);
    list(s, w.windZones, "wind zones", 108);
    list(s, w.rooms, "rooms", 164);
    list(s, w.fires, "volumetric fires", 28);
    list(s, w.emitters, "fire emitters", 36);
    list(s, w.fields, "particle fields", 53);
    list(s, w.events, "events", 32);
}

// ---- planes ------------------------------------------------------------------------------------

// A texel's code as a small number: 5 is a source, whose tick is in another plane.
constexpr uint32_t kClassSource = 5;
constexpr uint32_t kClassCodes[kClassSource] = {gpu::kNever, gpu::kInert, gpu::kWet, gpu::kOut,
                                                gpu::kOutWet};
uint32_t classOf(uint32_t code) noexcept {
    if (gpu::isSource(code)) return kClassSource;
    uint32_t found = 0;
    while (found + 1 < kClassSource && kClassCodes[found] != code) ++found;
    return found;
}

// Fields of a packed HeatTexel, by word and bits.
struct HeatField {
    uint32_t word, shift, bits;
};
constexpr HeatField kHeatFields[] = {{0, 0, 16}, {0, 16, 16}, {1, 0, 10}, {1, 10, 2},
                                     {1, 12, 8}, {1, 20, 8},  {1, 28, 2}, {1, 30, 2}};

constexpr uint32_t kKeptBits[] = {gpu::kTileListed, gpu::kTileBurning, gpu::kTileHot,
                                  gpu::kTileWarm};

void markReal(const mesh::BurnDomain& domain, PlaneScratch& scratch) {
    scratch.real.resize(domain.texelCount());
    for (uint32_t i = 0; i < domain.texelCount(); ++i) scratch.real[i] = domain.real(i) ? 1 : 0;
}

// One plane: its size and its bytes.
void plane(std::span<const uint32_t> values, uint32_t width, PlaneMask mask,
           std::pmr::vector<std::byte>& out) {
    const size_t at = out.size();
    Writer(out).number(uint32_t(0));
    save::writePlane(values, width, mask, out);
    const auto size = uint32_t(out.size() - at - sizeof(uint32_t));
    for (size_t k = 0; k < sizeof size; ++k) out[at + k] = std::byte(size >> (8 * k));
}

void readOne(Reader& from, uint32_t width, PlaneMask mask, std::span<uint32_t> values,
             uint32_t most, const char* name) {
    const uint32_t size = from.count("bytes of a plane", 1);
    std::fill(values.begin(), values.end(), 0u);
    if (!save::readPlane(from.take(size), width, mask, values))
        core::fail(FW_ERROR_BAD_DATA, "The plane \"%s\" of the save is damaged.", name);
    for (const uint32_t value : values)
        if (value > most)
            core::fail(FW_ERROR_BAD_DATA, "The plane \"%s\" of the save holds %u; the limit is %u.",
                       name, value, most);
}

}  // namespace

void writeImage(const gpu::ObjectImage& image, const mesh::BurnDomain& domain, uint32_t tick,
                uint32_t windowMost, PlaneScratch& scratch, std::pmr::vector<std::byte>& out) {
    const uint32_t width = domain.width;
    markReal(domain, scratch);
    const size_t texels = image.ticks.size();
    scratch.values.resize(std::max<size_t>(texels, image.tiles.size()));
    scratch.sources.resize(texels);
    const std::span<uint32_t> values = std::span(scratch.values).first(texels);
    for (size_t i = 0; i < texels; ++i) {
        values[i] = classOf(image.ticks[i]);
        scratch.sources[i] = scratch.real[i] != 0 && values[i] == kClassSource ? 1 : 0;
    }
    plane(values, width, scratch.real, out);
    plane(image.ticks, width, scratch.sources, out);
    Writer(out).number(!image.heat.empty());
    for (const HeatField& field : kHeatFields) {
        if (image.heat.empty()) break;
        for (size_t i = 0; i < texels; ++i) {
            const uint32_t word = field.word == 0 ? image.heat[i].x : image.heat[i].y;
            values[i] = (word >> field.shift) & ((1u << field.bits) - 1);
        }
        plane(values, width, scratch.real, out);
    }
    const size_t tiles = image.tiles.size();
    const std::span<uint32_t> perTile = std::span(scratch.values).first(tiles);
    for (size_t i = 0; i < tiles; ++i) {
        perTile[i] = 0;
        for (uint32_t bit = 0; bit < std::size(kKeptBits); ++bit)
            perTile[i] |= (image.tiles[i].flag & kKeptBits[bit]) != 0 ? 1u << bit : 0u;
    }
    plane(perTile, domain.tilesX, {}, out);
    // Beyond the window nobody asks how long ago it was.
    for (size_t i = 0; i < tiles; ++i) {
        const uint32_t changed = image.tiles[i].lastChange;
        const uint32_t age = tick - changed;
        perTile[i] = changed == gpu::kFarPast ? windowMost + 1 : std::min(age, windowMost);
    }
    plane(perTile, domain.tilesX, {}, out);
    for (size_t i = 0; i < tiles; ++i) perTile[i] = image.tileHeat[i].flux;
    plane(perTile, domain.tilesX, {}, out);
    for (size_t i = 0; i < tiles; ++i) perTile[i] = image.tileHeat[i].pilot;
    plane(perTile, domain.tilesX, {}, out);
}

void readImage(std::span<const std::byte> planes, const mesh::BurnDomain& domain, uint32_t tick,
               uint32_t windowMost, std::span<const gpu::HeatMaterial> heat, PlaneScratch& scratch,
               ImageStore& store) {
    const uint32_t width = domain.width, texels = domain.texelCount(), tiles = domain.tileCount();
    Reader from(planes, kWhat);
    markReal(domain, scratch);
    scratch.values.resize(std::max(texels, tiles));
    scratch.sources.resize(texels);
    const std::span<uint32_t> values = std::span(scratch.values).first(texels);
    readOne(from, width, scratch.real, values, kClassSource, "states");
    store.ticks.resize(texels);
    for (uint32_t i = 0; i < texels; ++i) {
        const bool real = scratch.real[i] != 0;
        scratch.sources[i] = real && values[i] == kClassSource ? 1 : 0;
        store.ticks[i] = real && values[i] < kClassSource ? kClassCodes[values[i]] : gpu::kInert;
    }
    readOne(from, width, scratch.sources, values, gpu::kLiveEnd - 1, "ignition ticks");
    for (uint32_t i = 0; i < texels; ++i)
        if (scratch.sources[i] != 0) store.ticks[i] = values[i];
    bool heated = false;
    from.number(heated);
    if (heated == heat.empty())
        core::fail(FW_ERROR_BAD_DATA, "The save has %s heat for an object that has %s.",
                   heated ? "some" : "no", heated ? "none" : "some");
    store.heat.assign(heated ? texels : 0, gpu::uvec2(0, 0));
    for (const HeatField& field : kHeatFields) {
        if (!heated) break;
        readOne(from, width, scratch.real, values, (1u << field.bits) - 1, "heat");
        for (uint32_t i = 0; i < texels; ++i)
            (field.word == 0 ? store.heat[i].x : store.heat[i].y) |= values[i] << field.shift;
    }
    for (uint32_t i = 0; heated && i < texels; ++i)
        if (scratch.real[i] == 0)
            store.heat[i] =
                gpu::packHeat(gpu::heatRests(heat[domain.texels[i].materialFlags & 7], false));
    store.tiles.assign(tiles, gpu::TileState{gpu::kNever, 0, gpu::kFarPast, 0});
    store.tileHeat.assign(tiles, gpu::TileHeat{});
    const std::span<uint32_t> perTile = std::span(scratch.values).first(tiles);
    readOne(from, domain.tilesX, {}, perTile, 15, "tiles");
    for (uint32_t i = 0; i < tiles; ++i)
        for (uint32_t bit = 0; bit < std::size(kKeptBits); ++bit)
            if ((perTile[i] >> bit & 1) != 0) store.tiles[i].flag |= kKeptBits[bit];
    readOne(from, domain.tilesX, {}, perTile, windowMost + 1, "ages of tiles");
    for (uint32_t i = 0; i < tiles; ++i)
        if (perTile[i] <= windowMost) store.tiles[i].lastChange = tick - perTile[i];
    readOne(from, domain.tilesX, {}, perTile, 0xFFFFFFFFu, "flux to tiles");
    for (uint32_t i = 0; i < tiles; ++i) store.tileHeat[i].flux = perTile[i];
    readOne(from, domain.tilesX, {}, perTile, 1, "flames near tiles");
    for (uint32_t i = 0; i < tiles; ++i) store.tileHeat[i].pilot = perTile[i];
    if (from.left() != 0)
        core::fail(FW_ERROR_BAD_DATA, "%zu bytes follow an object's planes in the save.",
                   from.left());
}

void writeSaved(const SavedWorld& saved, std::pmr::vector<std::byte>& out) {
    out.assign(kHeaderBytes, std::byte(0));
    Writer writer(out);
    put(writer, saved);
    std::pmr::vector<std::byte> head(out.get_allocator());
    Writer header(head);
    header.number(kMagic);
    header.number(kSaveVersion);
    header.number(uint64_t(out.size() - kHeaderBytes));
    header.number(checksum(std::span(out).subspan(kHeaderBytes)));
    std::copy(head.begin(), head.end(), out.begin());
}

void readSaved(std::span<const std::byte> bytes, SavedWorld& saved) {
    if (bytes.size() < kHeaderBytes)
        core::fail(FW_ERROR_BAD_DATA, "The save has %zu bytes; its header alone has %zu.",
                   bytes.size(), kHeaderBytes);
    Reader header(bytes.first(kHeaderBytes), kWhat);
    uint32_t magic = 0, version = 0;
    uint64_t size = 0, told = 0;
    all(header, magic, version, size, told);
    if (magic != kMagic)
        core::fail(FW_ERROR_BAD_DATA, "The save begins with 0x%08X; 0x%08X (\"FWSV\") is expected.",
                   magic, kMagic);
    if (version != kSaveVersion)
        core::fail(FW_ERROR_BAD_DATA,
                   "The save has format version %u; this library reads version %u alone. %s",
                   version, kSaveVersion,
                   version < kSaveVersion ? "Load it with the older library that wrote it."
                                          : "Load it with the newer library that wrote it.");
    const auto content = bytes.subspan(kHeaderBytes);
    if (size != content.size())
        core::fail(FW_ERROR_BAD_DATA, "The save has %zu bytes of content; its header says %llu.",
                   content.size(), static_cast<unsigned long long>(size));
    const uint64_t found = checksum(content);
    if (found != told)
        core::fail(FW_ERROR_BAD_DATA,
                   "The save's checksum is 0x%016llX; its header says 0x%016llX.",
                   static_cast<unsigned long long>(found), static_cast<unsigned long long>(told));
    Reader reader(content, kWhat);
    put(reader, saved);
    if (reader.left() != 0)
        core::fail(FW_ERROR_BAD_DATA, "%zu bytes follow the content of the save.", reader.left());
    for (const SavedWindZone& one : saved.windZones) saved.zones.push_back(one.zone);
    components::sortWindZones(saved.zones);
}

}  // namespace fw::world
