// Commands as they are recorded and applied, and hashes of objects in turn.
#include "world/recording.h"

#include "core/hash.h"
#include "world/save.h"
#include "world/world.h"

#include <algorithm>

namespace fw::world {
namespace {

// The id of the thing in a slot; of an empty slot an id that every call refuses.
template <class Pool>
auto idAt(const Pool& pool, uint32_t slot) {
    return slot < pool.slotCount() ? pool.idOf(slot) : decltype(pool.idOf(0)){slot + 1, 0};
}

struct Applying {
    explicit Applying(Recording* given) : recording(given) {
        if (recording) recording->applies = true;
    }
    ~Applying() {
        if (recording) recording->applies = false;
    }
    Applying(const Applying&) = delete;
    Applying& operator=(const Applying&) = delete;
    Recording* recording;
};

template <class... T>
struct Overloaded : T... {
    using T::operator()...;
};

template <size_t... I>
void makeKind(Command& command, uint32_t kind, std::index_sequence<I...>) {
    ((kind == I ? void(command.emplace<I>()) : void()), ...);
}

}  // namespace

void writeCommand(const Command& command, std::pmr::vector<std::byte>& out) {
    save::Writer writer(out);
    std::visit([&](const auto& one) { writer(one); }, command);
}

void readCommand(uint32_t kind, save::Reader& reader, Command& command) {
    if (kind >= kCommandKinds)
        core::fail(FW_ERROR_BAD_DATA, "The %s has a command of kind %u; the limit is %u.",
                   reader.name(), kind, kCommandKinds - 1);
    makeKind(command, kind, std::make_index_sequence<kCommandKinds>());
    std::visit([&](auto& one) { reader(one); }, command);
}

void readCommand(uint32_t kind, std::span<const std::byte> bytes, Command& command) {
    save::Reader reader(bytes, "packet", std::pmr::null_memory_resource());
    readCommand(kind, reader, command);
    if (reader.left() != 0)
        core::fail(FW_ERROR_BAD_DATA, "%zu bytes follow a command of the packet.", reader.left());
}

uint64_t hashState(std::span<const uint32_t> ticks, std::span<const gpu::uvec2> heat) noexcept {
    uint64_t hash = core::hashWords(ticks);
    for (const gpu::uvec2& texel : heat) {
        const uint32_t words[2] = {texel.x, texel.y};
        hash = core::hashWords(words, hash);
    }
    return hash;
}

Recording& World::startRecording(bool follows) {
    recording_ = core::Owned<Recording>::make(memory_, memory_);
    recording_->follows = follows;
    recording_->until = clock_.tick;
    return *recording_;
}

void World::mayChange() const {
    if (recording_ && recording_->follows && !recording_->applies)
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "The world follows a server's: what burns in it is changed there.");
}

void World::record(const Command& command) noexcept {
    if (commandLog_) commandLog_->push({clock_.tick, false, command});
    recordInTimeline(command);
    if (!recording_ || recording_->follows) return;
    try {
        recording_->commands.push_back({clock_.tick, command});
    } catch (...) {  // the world has changed: every client needs its whole state again
        recording_->lost = true;
    }
}

void World::recordSave() noexcept {
    if (commandLog_) commandLog_->push({clock_.tick, true, {}});
}

void World::applyLoad(std::span<const std::byte> bytes) {
    const Applying applying(recording_.get());
    load(bytes);
}

void World::checkCommandTick(uint32_t tick) const {
    if (tick < clock_.tick || tick > Clock::kLastTick)
        core::fail(FW_ERROR_BAD_DATA, "A command takes effect at tick %u; it is now %llu.", tick,
                   static_cast<unsigned long long>(clock_.tick));
}

// The texel events from `first` on, as commands.
void World::recordTexels(size_t first) noexcept {
    if (!records()) return;
    for (size_t i = first; i < pending_.size();) {
        const PendingTexel& event = pending_[i];
        const TexelChange change{event.kind, event.tick, event.water};
        if (event.texel == kAllTexels) {
            IgniteObjects command{change, {}};
            while (i < pending_.size() && pending_[i].texel == kAllTexels &&
                   command.slots.add(pending_[i].object))
                ++i;
            record(command);
            continue;
        }
        IgniteTexels command{event.object, change, {}};
        while (i < pending_.size() && pending_[i].object == command.slot &&
               pending_[i].texel != kAllTexels && command.texels.add(pending_[i].texel))
            ++i;
        record(command);
    }
}

void World::igniteTexels(const IgniteTexels& command) {
    Object& object = *objects_.get(idAt(objects_, command.slot));
    const mesh::BurnDomain& domain = domainOf(object);
    found_.clear();
    command.texels.each([&](uint32_t texel) {
        if (texel >= domain.texelCount() || !domain.real(texel))
            core::fail(FW_ERROR_BAD_DATA, "A command changes texel %u of burnable mesh %u.", texel,
                       command.slot + 1);
        found_.push_back(texel);
    });
    addChange(object, command.change, found_);
    record(command);
}

void World::igniteObjects(const IgniteObjects& command) {
    constexpr uint32_t all[] = {kAllTexels};
    size_t count = 0;
    command.slots.each([&](uint32_t slot) {
        (void)objects_.get(idAt(objects_, slot));
        ++count;
    });
    findPendingRoom(count);
    command.slots.each([&](uint32_t slot) { addChange(**objects_.at(slot), command.change, all); });
    record(command);
}

void World::addChange(Object& object, const TexelChange& change, std::span<const uint32_t> texels) {
    checkCommandTick(change.tick);
    if (change.kind > FW_EXTINGUISH || change.water > gpu::kFilmMost)
        core::fail(FW_ERROR_BAD_DATA,
                   "A command is of kind %u with %u g/m^2 of water; the limits are %u and %u.",
                   change.kind, change.water, uint32_t(FW_EXTINGUISH), gpu::kFilmMost);
    if (!texels.empty()) addPending(object, change.kind, change.tick, change.water, texels);
}

void World::apply(const Command& command) {
    const Applying applying(recording_.get());
    const Overloaded call{
        [&](const SetWind& c) { setWind(c.wind); },
        [&](const SetFlags& c) { setFlags(c.flags); },
        [&](const IgniteTexels& c) { igniteTexels(c); },
        [&](const IgniteObjects& c) { igniteObjects(c); },
        [&](const WetPatch& c) {
            components::FireEmitter& emitter = emitters_.get(idAt(emitters_, c.emitter));
            if (!emitter.stream || c.patch >= components::kJetPatches)
                core::fail(FW_ERROR_BAD_DATA, "A command wets patch %u of fire emitter %u.",
                           c.patch, c.emitter + 1);
            components::wetPatch(emitter.stream->patches[c.patch], c.grams, c.tick);
            components::wetPatch(emitter.stream->before[c.patch], c.grams, c.tick);
            record(c);
        },
        [&](const SetPose& c) {
            setTransform(idAt(objects_, c.slot), c.transform.matrix().data());
        },
        [&](const MoveBlocker& c) {
            moveBlocker(idAt(blockers_, c.slot), c.transform.matrix().data());
        },
        [&](const MoveFire& c) { moveVolumetricFire(idAt(fires_, c.slot), c.position); },
        [&](const SetFirePower& c) { setVolumetricFirePower(idAt(fires_, c.slot), c.power); },
        [&](const MoveEmitter& c) {
            moveFireEmitter(idAt(emitters_, c.slot), c.position, c.turns ? c.direction : nullptr);
        },
        [&](const SetEmitterPower& c) { setFireEmitterPower(idAt(emitters_, c.slot), c.power); },
        [&](const MoveField& c) {
            moveParticleField(idAt(fields_, c.slot), c.position, c.turns ? c.rotation : nullptr);
        },
        [&](const SetFieldAmount& c) { setParticleFieldAmount(idAt(fields_, c.slot), c.amount); },
        [&](const SetWindZone& c) { setWindZone(idAt(windPool_, c.slot), c.zone); },
        [&](const SetRoom& c) { setRoom(idAt(rooms_, c.slot), c.room, c.refills); },
        [&](const PlayBurn& c) {
            checkCommandTick(c.tick);
            playBurnAt(idAt(objects_, c.slot), idAt(burns_, c.burn1 - 1), c.tick, c.speed);
        },
        [&](const StopBurn& c) { stopBurn(idAt(objects_, c.slot)); },
        [&](const SetWindGrid& c) { applyWindGrid(c); },
        [&](const SetWindPoints& c) { applyWindPoints(c); },
        [&](const SetGusts& c) { applyGusts(c); },
        [&](const SetHeatShield& c) { applyShield(c); },
        [&](const SetShieldCells& c) { applyShieldCells(c); },
        [&](const AddShieldObject& c) { applyShieldObject(c); },
        [&](const ShiftOrigin& c) {
            const float offset[] = {float(c.metres[0]), float(c.metres[1]), float(c.metres[2])};
            shiftOrigin(offset, nullptr);
        },
        [&](const TransferBurn& c) { transferBurn(idAt(objects_, c.from), idAt(objects_, c.to)); },
    };
    std::visit(call, command);
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
    save::Hasher hasher;
    serializeRules(hasher, def_);
    const uint32_t counts[] = {kSaveVersion,     objects_.live(),  blockers_.live(),
                               fires_.live(),    emitters_.live(), fields_.live(),
                               windPool_.live(), rooms_.live(),    burns_.live()};
    hasher(counts);
    for (uint32_t i = 0; i < objects_.slotCount(); ++i)
        if (const auto* object = objects_.at(i)) {
            const uint64_t asset = assetOf(**object);
            hasher(i, asset);
        }
    return hasher.hash();
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

void World::recordHash(const gpu::BurnMap& map, const gpu::Readback& readback) {
    const uint64_t end = readback.endTick;
    const uint32_t rounds = hashRounds(objects_.slotCount());
    if (end % kHashTicks != 0 || map.object % rounds != end / kHashTicks % rounds) return;
    // Once, however many frames end there.
    const auto before = std::find_if(
        recording_->hashes.rbegin(), recording_->hashes.rend(),
        [&](const ObjectHash& one) { return one.slot == map.object || one.tick < end; });
    if (before != recording_->hashes.rend() && before->tick == end) return;
    recording_->hashes.push_back({map.object, rounds, end, hashState(map.ticks, map.heat)});
}

}  // namespace fw::world
