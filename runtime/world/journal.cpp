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

Journal& PersistenceSystem::keepJournal(bool follows) {
    journal_ = core::Owned<Journal>::make(world_.context_.memory, world_.context_.memory);
    journal_->follows = follows;
    journal_->until = world_.context_.clock.tick;
    return *journal_;
}

void PersistenceSystem::mayChange() const {
    if (journal_ && journal_->follows && !journal_->performs)
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "The world follows a server's: what burns in it is changed there.");
}

void PersistenceSystem::note(const Deed& deed) noexcept {
    if (noted_) noted_->push({world_.context_.clock.tick, false, deed});
    noteInTimeline(deed);
    if (!journal_ || journal_->follows) return;
    try {
        journal_->deeds.push_back({world_.context_.clock.tick, deed});
    } catch (...) {  // what is done is done: all others are told anew
        journal_->lost = true;
    }
}

void PersistenceSystem::noteSaveInLog() noexcept {
    if (noted_) noted_->push({world_.context_.clock.tick, true, {}});
}

void PersistenceSystem::noteMove(Deed::Kind kind, uint32_t slot, const float* numbers, size_t count,
                                 uint32_t word) noexcept {
    if (!notes()) return;
    Deed deed;
    deed.kind = kind;
    deed.slot = slot;
    deed.word = word;
    std::copy_n(numbers, count, deed.numbers.begin());
    note(deed);
}

void PersistenceSystem::notePose(Deed::Kind kind, uint32_t slot,
                                 const float transform[16]) noexcept {
    float columns[12];
    for (int c = 0; c < 4; ++c) std::copy_n(transform + 4 * c, 3, columns + 3 * c);
    noteMove(kind, slot, columns, 12);
}

void PersistenceSystem::performLoad(std::span<const std::byte> bytes) {
    const Performing performing(journal_.get());
    load(bytes);
}

void PersistenceSystem::perform(const Deed& deed) {
    const Performing performing(journal_.get());
    const float* numbers = deed.numbers.data();
    float transform[16] = {};
    for (int c = 0; c < 4; ++c) std::copy_n(numbers + 3 * c, 3, transform + 4 * c);
    transform[15] = 1;
    switch (deed.kind) {
        case Deed::Kind::wind:
            return world_.wind_.set(numbers);
        case Deed::Kind::flags:
            return world_.exchange_.setFlags(deed.word);
        case Deed::Kind::pose:
            return world_.setTransform(idAt(world_.scene_.objects, deed.slot), transform);
        case Deed::Kind::moveBlocker:
            return world_.exchange_.moveBlocker(idAt(world_.exchange_.state_.blockers, deed.slot),
                                                transform);
        case Deed::Kind::moveFire:
            return world_.flames_.move(idAt(world_.flames_.state_.fires, deed.slot), numbers);
        case Deed::Kind::firePower:
            return world_.flames_.setPower(idAt(world_.flames_.state_.fires, deed.slot),
                                           numbers[0]);
        case Deed::Kind::moveEmitter:
            return world_.emitters_.move(idAt(world_.emitters_.state_.emitters, deed.slot), numbers,
                                         deed.word != 0 ? numbers + 3 : nullptr);
        case Deed::Kind::emitterPower:
            return world_.emitters_.setPower(idAt(world_.emitters_.state_.emitters, deed.slot),
                                             numbers[0]);
        case Deed::Kind::moveField:
            return world_.fields_.move(idAt(world_.fields_.state_.fields, deed.slot), numbers,
                                       deed.word != 0 ? numbers + 3 : nullptr);
        case Deed::Kind::fieldAmount:
            return world_.fields_.setAmount(idAt(world_.fields_.state_.fields, deed.slot),
                                            numbers[0]);
        case Deed::Kind::windZone:
            return world_.wind_.setZone(idAt(world_.wind_.state_.zones, deed.slot),
                                        windZoneDefOf(deed));
        case Deed::Kind::room:
            return world_.rooms_.set(idAt(world_.rooms_.state_.rooms, deed.slot), roomDefOf(deed));
        case Deed::Kind::playBurn:
            if (deed.tick < world_.context_.clock.tick || deed.tick > Clock::kLastTick) break;
            return world_.burn_.playBurnAt(idAt(world_.scene_.objects, deed.slot),
                                           idAt(world_.burn_.state_.burns, deed.word - 1),
                                           deed.tick, numbers[0]);
        case Deed::Kind::stopBurn:
            return world_.burn_.stopBurn(idAt(world_.scene_.objects, deed.slot));
        case Deed::Kind::windGrid:
            return world_.wind_.applyGridCommand(deed);
        case Deed::Kind::windPoints:
            return world_.wind_.applyPointsCommand(deed);
        case Deed::Kind::heatShield:
            return world_.exchange_.applyShieldCommand(deed);
        case Deed::Kind::shieldCells:
            return world_.exchange_.applyShieldCells(deed);
        case Deed::Kind::shieldObject:
            return world_.exchange_.applyShieldObject(deed);
        case Deed::Kind::transferBurn:
            return world_.burn_.transferBurn(idAt(world_.scene_.objects, deed.word - 1),
                                             idAt(world_.scene_.objects, deed.slot));
        case Deed::Kind::shiftOrigin:
            return world_.shiftOrigin(numbers, nullptr);
        case Deed::Kind::gusts: {
            FwGustDef def{};
            def.structSize = sizeof def;
            def.strength = numbers[0];
            def.size = numbers[1];
            return world_.wind_.setGusts(def);
        }
        case Deed::Kind::ignite: {
            if (deed.tick < world_.context_.clock.tick || deed.tick > Clock::kLastTick) break;
            FwIgnitionDef def{};
            def.structSize = sizeof def;
            def.kind = deed.word;
            if (deed.slot != 0) def.object = idAt(world_.scene_.objects, deed.slot - 1);
            std::copy_n(numbers, 3, def.position);
            def.radius = numbers[3];
            def.water = numbers[4];
            (void)world_.burn_.igniteAt(def, deed.tick);
            return;
        }
        case Deed::Kind::count:
            break;
    }
    core::fail(FW_ERROR_BAD_DATA, "A deed of kind %u at tick %u is none.", uint32_t(deed.kind),
               deed.tick);
}

double PersistenceSystem::seconds() const noexcept {
    return double(world_.context_.clock.tick) / gpu::kTicksPerSecond +
           double(world_.context_.clock.fraction) / double(uint64_t(1) << Clock::kFractionBits);
}

double PersistenceSystem::secondsTo(uint64_t tick) const noexcept {
    constexpr double kUnit = 1.0 / double(uint64_t(1) << Clock::kFractionBits);
    if (tick <= world_.context_.clock.tick) return 0;
    const uint64_t steps = (tick - world_.context_.clock.tick) / gpu::kStepTicks;
    return double(steps * Clock::kStepUnits - world_.context_.clock.fraction) * kUnit;
}

uint64_t PersistenceSystem::identity() noexcept {
    const float rules[] = {world_.context_.def.paceFactor,   world_.context_.def.up[0],
                           world_.context_.def.up[1],        world_.context_.def.up[2],
                           world_.context_.def.spreadChance, world_.context_.def.timeToLive};
    uint64_t hash = core::hashBytes(std::as_bytes(std::span(rules)));
    const uint32_t counts[] = {kSaveVersion,
                               world_.context_.def.seed,
                               world_.context_.def.maxHops,
                               world_.context_.def.maxBurningTiles,
                               world_.scene_.objects.live(),
                               world_.exchange_.state_.blockers.live(),
                               world_.flames_.state_.fires.live(),
                               world_.emitters_.state_.emitters.live(),
                               world_.fields_.state_.fields.live(),
                               world_.wind_.state_.zones.live(),
                               world_.rooms_.state_.rooms.live(),
                               world_.burn_.state_.burns.live()};
    hash = core::hashWords(counts, hash);
    for (uint32_t i = 0; i < world_.scene_.objects.slotCount(); ++i)
        if (const auto* object = world_.scene_.objects.at(i)) {
            const uint64_t asset = assetOf(**object);
            const uint32_t words[] = {i, uint32_t(asset), uint32_t(asset >> 32)};
            hash = core::hashWords(words, hash);
        }
    return hash;
}

// The objects whose turn it is are read back with a frame that ends there.
void PersistenceSystem::planHashes(const ClockAdvance& time) {
    const uint64_t end = time.after.tick;
    if (time.steps == 0 || end % kHashTicks != 0) return;
    const uint32_t slots = world_.scene_.objects.slotCount(), rounds = hashRounds(slots);
    for (auto slot = uint32_t(end / kHashTicks % rounds); slot < slots; slot += rounds)
        if (world_.scene_.objects.at(slot) &&
            std::find(world_.queries_.burnMaps_.begin(), world_.queries_.burnMaps_.end(), slot) ==
                world_.queries_.burnMaps_.end())
            world_.queries_.burnMaps_.push_back(slot);
}

void PersistenceSystem::noteHash(const gpu::BurnMap& map, const gpu::Readback& readback) {
    const uint64_t end = readback.endTick;
    const uint32_t rounds = hashRounds(world_.scene_.objects.slotCount());
    if (end % kHashTicks != 0 || map.object % rounds != end / kHashTicks % rounds) return;
    // Once, however many frames end there.
    const auto before = std::find_if(
        journal_->hashes.rbegin(), journal_->hashes.rend(),
        [&](const ObjectHash& one) { return one.slot == map.object || one.tick < end; });
    if (before != journal_->hashes.rend() && before->tick == end) return;
    journal_->hashes.push_back({map.object, rounds, end, hashState(map.ticks, map.heat)});
}

}  // namespace fw::world
