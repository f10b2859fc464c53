// Deeds as they are noted and done again, and hashes of objects in turn.
#include "world/journal.h"

#include "core/hash.h"
#include "world/save.h"
#include "world/world.h"

#include <algorithm>

namespace fw::world {
namespace {

// The id of what is in a slot; of what is not there an id that every call refuses.
template <class Pool>
auto idAt(const Pool& pool, uint32_t slot) {
    return slot < pool.slotCount() ? pool.idOf(slot) : decltype(pool.idOf(0)){slot + 1, 0};
}

struct Performing {
    explicit Performing(Journal* given) : journal(given) {
        if (journal) journal->performs = true;
    }
    ~Performing() {
        if (journal) journal->performs = false;
    }
    Performing(const Performing&) = delete;
    Performing& operator=(const Performing&) = delete;
    Journal* journal;
};

// A def's fields into a deed: whole numbers into its word, by bits, floats into its numbers.
struct DeedWriter {
    Deed deed;
    uint32_t shift = 0;
    size_t count = 0;
    void bits(uint32_t value, uint32_t width) {
        deed.word |= value << shift;
        shift += width;
    }
    void number(float value) { deed.numbers[count++] = value; }
};
// And out of it again.
struct DeedReader {
    const Deed& deed;
    uint32_t shift = 0;
    size_t count = 0;
    void bits(uint32_t& value, uint32_t width) {
        value = uint32_t(uint64_t(deed.word) >> shift & ((uint64_t(1) << width) - 1));
        shift += width;
    }
    void number(float& value) { value = deed.numbers[count++]; }
};

// Of both ways, what a deed has of a def. `priority` is not negative in it.
template <class Way, class Def, class Priority>
void putZone(Way& way, Def& def, Priority& priority) {
    way.bits(def.shape, 4);
    way.bits(def.flow, 4);
    way.bits(def.blend, 8);
    way.bits(priority, 16);
    for (auto& value : def.position) way.number(value);
    for (auto& value : def.axis) way.number(value);
    for (auto& value : def.size) way.number(value);
    way.number(def.speed);
    way.number(def.falloff);
}
constexpr int32_t kPriorityZero = 0x8000;

template <class Way, class Def>
void putRoom(Way& way, Def& def) {
    way.bits(def.flags, 32);
    for (auto& value : def.position) way.number(value);
    for (auto& value : def.rotation) way.number(value);
    for (auto& value : def.halfSize) way.number(value);
    way.number(def.volume);
    way.number(def.vent);
    way.number(def.oxygen);
}

template <class Way, class Def>
void putGrid(Way& way, Def& def) {
    way.bits(def.blend, 8);
    for (auto& count : def.counts) way.bits(count, 8);
    for (auto& value : def.origin) way.number(value);
    way.number(def.cellSize);
    way.number(def.fade);
}

template <class Way, class Def>
void putShield(Way& way, Def& def) {
    for (auto& count : def.counts) way.bits(count, 9);
    for (auto& value : def.origin) way.number(value);
    way.number(def.cellSize);
}

}  // namespace

Deed deedOf(const FwWindZoneDef& def) noexcept {
    DeedWriter writer;
    const auto priority = uint32_t(def.priority + kPriorityZero);
    putZone(writer, def, priority);
    return writer.deed;
}

FwWindZoneDef windZoneDefOf(const Deed& deed) noexcept {
    FwWindZoneDef def{};
    def.structSize = sizeof def;
    DeedReader reader{deed};
    uint32_t priority = 0;
    putZone(reader, def, priority);
    def.priority = int32_t(priority) - kPriorityZero;
    return def;
}

Deed deedOf(const FwRoomDef& def) noexcept {
    DeedWriter writer;
    putRoom(writer, def);
    return writer.deed;
}

FwRoomDef roomDefOf(const Deed& deed) noexcept {
    FwRoomDef def{};
    def.structSize = sizeof def;
    DeedReader reader{deed};
    putRoom(reader, def);
    return def;
}

Deed deedOf(const FwWindGridDef& def) noexcept {
    DeedWriter writer;
    putGrid(writer, def);
    return writer.deed;
}

FwWindGridDef windGridDefOf(const Deed& deed) noexcept {
    FwWindGridDef def{};
    def.structSize = sizeof def;
    DeedReader reader{deed};
    putGrid(reader, def);
    return def;
}

Deed deedOf(const FwHeatShieldDef& def) noexcept {
    DeedWriter writer;
    putShield(writer, def);
    return writer.deed;
}

FwHeatShieldDef heatShieldDefOf(const Deed& deed) noexcept {
    FwHeatShieldDef def{};
    def.structSize = sizeof def;
    DeedReader reader{deed};
    putShield(reader, def);
    return def;
}

uint64_t hashState(std::span<const uint32_t> ticks, std::span<const gpu::uvec2> heat) noexcept {
    uint64_t hash = core::hashWords(ticks);
    for (const gpu::uvec2& texel : heat) {
        const uint32_t words[2] = {texel.x, texel.y};
        hash = core::hashWords(words, hash);
    }
    return hash;
}

Journal& World::keepJournal(bool follows) {
    journal_ = core::Owned<Journal>::make(memory_, memory_);
    journal_->follows = follows;
    journal_->until = clock_.tick;
    return *journal_;
}

void World::mayChange() const {
    if (journal_ && journal_->follows && !journal_->performs)
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "The world follows a server's: what burns in it is changed there.");
}

void World::note(const Deed& deed) noexcept {
    if (noted_) noted_->push({clock_.tick, false, deed});
    noteInTimeline(deed);
    if (!journal_ || journal_->follows) return;
    try {
        journal_->deeds.push_back({clock_.tick, deed});
    } catch (...) {  // what is done is done: all others are told anew
        journal_->lost = true;
    }
}

void World::noteSaveInLog() noexcept {
    if (noted_) noted_->push({clock_.tick, true, {}});
}

void World::noteMove(Deed::Kind kind, uint32_t slot, const float* numbers, size_t count,
                     uint32_t word) noexcept {
    if (!notes()) return;
    Deed deed;
    deed.kind = kind;
    deed.slot = slot;
    deed.word = word;
    std::copy_n(numbers, count, deed.numbers.begin());
    note(deed);
}

void World::notePose(Deed::Kind kind, uint32_t slot, const float transform[16]) noexcept {
    float columns[12];
    for (int c = 0; c < 4; ++c) std::copy_n(transform + 4 * c, 3, columns + 3 * c);
    noteMove(kind, slot, columns, 12);
}

void World::performLoad(std::span<const std::byte> bytes) {
    const Performing performing(journal_.get());
    load(bytes);
}

void World::perform(const Deed& deed) {
    const Performing performing(journal_.get());
    const float* numbers = deed.numbers.data();
    float transform[16] = {};
    for (int c = 0; c < 4; ++c) std::copy_n(numbers + 3 * c, 3, transform + 4 * c);
    transform[15] = 1;
    switch (deed.kind) {
        case Deed::Kind::wind:
            return setWind(numbers);
        case Deed::Kind::flags:
            return setFlags(deed.word);
        case Deed::Kind::pose:
            return setTransform(idAt(objects_, deed.slot), transform);
        case Deed::Kind::moveBlocker:
            return moveBlocker(idAt(blockers_, deed.slot), transform);
        case Deed::Kind::moveFire:
            return moveVolumetricFire(idAt(fires_, deed.slot), numbers);
        case Deed::Kind::firePower:
            return setVolumetricFirePower(idAt(fires_, deed.slot), numbers[0]);
        case Deed::Kind::moveEmitter:
            return moveFireEmitter(idAt(emitters_, deed.slot), numbers,
                                   deed.word != 0 ? numbers + 3 : nullptr);
        case Deed::Kind::emitterPower:
            return setFireEmitterPower(idAt(emitters_, deed.slot), numbers[0]);
        case Deed::Kind::moveField:
            return moveParticleField(idAt(fields_, deed.slot), numbers,
                                     deed.word != 0 ? numbers + 3 : nullptr);
        case Deed::Kind::fieldAmount:
            return setParticleFieldAmount(idAt(fields_, deed.slot), numbers[0]);
        case Deed::Kind::windZone:
            return setWindZone(idAt(windPool_, deed.slot), windZoneDefOf(deed));
        case Deed::Kind::room:
            return setRoom(idAt(rooms_, deed.slot), roomDefOf(deed));
        case Deed::Kind::playBurn:
            if (deed.tick < clock_.tick || deed.tick > Clock::kLastTick) break;
            return playBurnAt(idAt(objects_, deed.slot), idAt(burns_, deed.word - 1), deed.tick,
                              numbers[0]);
        case Deed::Kind::stopBurn:
            return stopBurn(idAt(objects_, deed.slot));
        case Deed::Kind::windGrid:
            return takeWindGrid(deed);
        case Deed::Kind::windPoints:
            return takeWindPoints(deed);
        case Deed::Kind::heatShield:
            return takeShield(deed);
        case Deed::Kind::shieldCells:
            return takeShieldCells(deed);
        case Deed::Kind::shieldObject:
            return takeShieldObject(deed);
        case Deed::Kind::transferBurn:
            return transferBurn(idAt(objects_, deed.word - 1), idAt(objects_, deed.slot));
        case Deed::Kind::shiftOrigin:
            return shiftOrigin(numbers, nullptr);
        case Deed::Kind::gusts: {
            FwGustDef def{};
            def.structSize = sizeof def;
            def.strength = numbers[0];
            def.size = numbers[1];
            return setGusts(def);
        }
        case Deed::Kind::ignite: {
            if (deed.tick < clock_.tick || deed.tick > Clock::kLastTick) break;
            FwIgnitionDef def{};
            def.structSize = sizeof def;
            def.kind = deed.word;
            if (deed.slot != 0) def.object = idAt(objects_, deed.slot - 1);
            std::copy_n(numbers, 3, def.position);
            def.radius = numbers[3];
            def.water = numbers[4];
            (void)igniteAt(def, deed.tick);
            return;
        }
        case Deed::Kind::count:
            break;
    }
    core::fail(FW_ERROR_BAD_DATA, "A deed of kind %u at tick %u is none.", uint32_t(deed.kind),
               deed.tick);
}

double World::seconds() const noexcept {
    return double(clock_.tick) / gpu::kTicksPerSecond +
           double(clock_.fraction) / double(uint64_t(1) << Clock::kFractionBits);
}

double World::secondsTo(uint64_t tick) const noexcept {
    constexpr double kUnit = 1.0 / double(uint64_t(1) << Clock::kFractionBits);
    if (tick <= clock_.tick) return 0;
    const uint64_t steps = (tick - clock_.tick) / gpu::kStepTicks;
    return double(steps * Clock::kStepUnits - clock_.fraction) * kUnit;
}

uint64_t World::identity() noexcept {
    const float rules[] = {def_.paceFactor, def_.up[0],        def_.up[1],
                           def_.up[2],      def_.spreadChance, def_.timeToLive};
    uint64_t hash = core::hashBytes(std::as_bytes(std::span(rules)));
    const uint32_t counts[] = {kSaveVersion,         def_.seed,        def_.maxHops,
                               def_.maxBurningTiles, objects_.live(),  blockers_.live(),
                               fires_.live(),        emitters_.live(), fields_.live(),
                               windPool_.live(),     rooms_.live(),    burns_.live()};
    hash = core::hashWords(counts, hash);
    for (uint32_t i = 0; i < objects_.slotCount(); ++i)
        if (const auto* object = objects_.at(i)) {
            const uint64_t asset = assetOf(**object);
            const uint32_t words[] = {i, uint32_t(asset), uint32_t(asset >> 32)};
            hash = core::hashWords(words, hash);
        }
    return hash;
}

// The objects whose turn it is are read back with a frame that ends there.
void World::planHashes(const ClockAdvance& time) {
    const uint64_t end = time.after.tick;
    if (time.steps == 0 || end % kHashTicks != 0) return;
    const uint32_t slots = objects_.slotCount(), rounds = hashRounds(slots);
    for (auto slot = uint32_t(end / kHashTicks % rounds); slot < slots; slot += rounds)
        if (objects_.at(slot) && std::find(frame_.burnMaps.begin(), frame_.burnMaps.end(), slot) ==
                                     frame_.burnMaps.end())
            frame_.burnMaps.push_back(slot);
}

void World::noteHash(const gpu::BurnMap& map, const gpu::Readback& readback) {
    const uint64_t end = readback.endTick;
    const uint32_t rounds = hashRounds(objects_.slotCount());
    if (end % kHashTicks != 0 || map.object % rounds != end / kHashTicks % rounds) return;
    // Once, however many frames end there.
    const auto before = std::find_if(
        journal_->hashes.rbegin(), journal_->hashes.rend(),
        [&](const ObjectHash& one) { return one.slot == map.object || one.tick < end; });
    if (before != journal_->hashes.rend() && before->tick == end) return;
    journal_->hashes.push_back({map.object, rounds, end, hashState(map.ticks, map.heat)});
}

}  // namespace fw::world
