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

Recording& PersistenceSystem::startRecording(bool follows) {
    recording_ = core::Owned<Recording>::make(world_.context_.memory, world_.context_.memory);
    recording_->follows = follows;
    recording_->until = world_.context_.clock.tick;
    return *recording_;
}

void PersistenceSystem::mayChange() const {
    if (recording_ && recording_->follows && !recording_->applies)
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "The world follows a server's: what burns in it is changed there.");
}

void PersistenceSystem::record(const Command& command) noexcept {
    if (commandLog_) commandLog_->push({world_.context_.clock.tick, false, command});
    recordInTimeline(command);
    if (!recording_ || recording_->follows) return;
    try {
        recording_->commands.push_back({world_.context_.clock.tick, command});
    } catch (...) {  // the world has changed: every client needs its whole state again
        recording_->lost = true;
    }
}

void PersistenceSystem::recordSave() noexcept {
    if (commandLog_) commandLog_->push({world_.context_.clock.tick, true, {}});
}

void PersistenceSystem::applyLoad(std::span<const std::byte> bytes) {
    const Applying applying(recording_.get());
    load(bytes);
}

void BurnSystem::checkCommandTick(uint32_t tick) const {
    if (tick < context_.clock.tick || tick > Clock::kLastTick)
        core::fail(FW_ERROR_BAD_DATA, "A command takes effect at tick %u; it is now %llu.", tick,
                   static_cast<unsigned long long>(context_.clock.tick));
}

// The texel events from `first` on, as commands.
void BurnSystem::recordTexels(size_t first) noexcept {
    if (!context_.recorder.records()) return;
    for (size_t i = first; i < state_.pending.size();) {
        const PendingTexel& event = state_.pending[i];
        const TexelChange change{event.kind, event.tick, event.water};
        if (event.texel == kAllTexels) {
            IgniteObjects command{change, {}};
            while (i < state_.pending.size() && state_.pending[i].texel == kAllTexels &&
                   command.slots.add(state_.pending[i].object))
                ++i;
            context_.recorder.record(command);
            continue;
        }
        IgniteTexels command{event.object, change, {}};
        while (i < state_.pending.size() && state_.pending[i].object == command.slot &&
               state_.pending[i].texel != kAllTexels && command.texels.add(state_.pending[i].texel))
            ++i;
        context_.recorder.record(command);
    }
}

void BurnSystem::igniteTexels(const IgniteTexels& command) {
    Object& object = *scene_.objects.get(idAt(scene_.objects, command.slot));
    const mesh::BurnDomain& domain = scene_.domainOf(object);
    scene_.found.clear();
    command.texels.each([&](uint32_t texel) {
        if (texel >= domain.texelCount() || !domain.real(texel))
            core::fail(FW_ERROR_BAD_DATA, "A command changes texel %u of burnable mesh %u.", texel,
                       command.slot + 1);
        scene_.found.push_back(texel);
    });
    addChange(object, command.change, scene_.found);
    context_.recorder.record(command);
}

void BurnSystem::igniteObjects(const IgniteObjects& command) {
    constexpr uint32_t all[] = {kAllTexels};
    size_t count = 0;
    command.slots.each([&](uint32_t slot) {
        (void)scene_.objects.get(idAt(scene_.objects, slot));
        ++count;
    });
    reservePending(count);
    command.slots.each(
        [&](uint32_t slot) { addChange(scene_.objectAt(slot), command.change, all); });
    context_.recorder.record(command);
}

void BurnSystem::addChange(Object& object, const TexelChange& change,
                           std::span<const uint32_t> texels) {
    checkCommandTick(change.tick);
    if (change.kind > FW_EXTINGUISH || change.water > gpu::kMaxFilm)
        core::fail(FW_ERROR_BAD_DATA,
                   "A command is of kind %u with %u g/m^2 of water; the limits are %u and %u.",
                   change.kind, change.water, uint32_t(FW_EXTINGUISH), gpu::kMaxFilm);
    if (!texels.empty()) addPending(object, change.kind, change.tick, change.water, texels);
}

void PersistenceSystem::apply(const Command& command) {
    const Applying applying(recording_.get());
    const Overloaded call{
        [&](const SetWind& c) { world_.wind_.set(c.wind); },
        [&](const SetFlags& c) { world_.exchange_.setFlags(c.flags); },
        [&](const IgniteTexels& c) { world_.burn_.igniteTexels(c); },
        [&](const IgniteObjects& c) { world_.burn_.igniteObjects(c); },
        [&](const WetPatch& c) {
            components::FireEmitter& emitter = world_.emitters_.state_.emitters.get(
                idAt(world_.emitters_.state_.emitters, c.emitter));
            if (!emitter.stream || c.patch >= components::kJetPatches)
                core::fail(FW_ERROR_BAD_DATA, "A command wets patch %u of fire emitter %u.",
                           c.patch, c.emitter + 1);
            components::wetPatch(emitter.stream->patches[c.patch], c.grams, c.tick);
            components::wetPatch(emitter.stream->before[c.patch], c.grams, c.tick);
            record(c);
        },
        [&](const SetPose& c) {
            world_.setTransform(idAt(world_.scene_.objects, c.slot), c.transform.matrix().data());
        },
        [&](const MoveHeatOccluder& c) {
            world_.exchange_.moveHeatOccluder(idAt(world_.exchange_.state_.occluders, c.slot),
                                              c.transform.matrix().data());
        },
        [&](const MoveFire& c) {
            world_.flames_.move(idAt(world_.flames_.state_.fires, c.slot), c.position);
        },
        [&](const SetFirePower& c) {
            world_.flames_.setPower(idAt(world_.flames_.state_.fires, c.slot), c.power);
        },
        [&](const MoveEmitter& c) {
            world_.emitters_.move(idAt(world_.emitters_.state_.emitters, c.slot), c.position,
                                  c.turns ? c.direction : nullptr);
        },
        [&](const SetEmitterPower& c) {
            world_.emitters_.setPower(idAt(world_.emitters_.state_.emitters, c.slot), c.power);
        },
        [&](const MoveField& c) {
            world_.fields_.move(idAt(world_.fields_.state_.fields, c.slot), c.position,
                                c.turns ? c.rotation : nullptr);
        },
        [&](const SetFieldAmount& c) {
            world_.fields_.setAmount(idAt(world_.fields_.state_.fields, c.slot), c.amount);
        },
        [&](const SetWindZone& c) {
            world_.wind_.setZone(idAt(world_.wind_.state_.zones, c.slot), c.zone);
        },
        [&](const SetRoom& c) {
            world_.rooms_.set(idAt(world_.rooms_.state_.rooms, c.slot), c.room, c.refills);
        },
        [&](const PlayBurn& c) {
            world_.burn_.checkCommandTick(c.tick);
            world_.burn_.playBurnAt(idAt(world_.scene_.objects, c.slot),
                                    idAt(world_.burn_.state_.burns, c.burn1 - 1), c.tick, c.speed);
        },
        [&](const StopBurn& c) { world_.burn_.stopBurn(idAt(world_.scene_.objects, c.slot)); },
        [&](const SetWindGrid& c) { world_.wind_.applyGrid(c); },
        [&](const SetWindPoints& c) { world_.wind_.applyPoints(c); },
        [&](const SetGusts& c) { world_.wind_.applyGusts(c); },
        [&](const SetHeatShield& c) { world_.exchange_.applyShield(c); },
        [&](const SetShieldCells& c) { world_.exchange_.applyShieldCells(c); },
        [&](const AddShieldObject& c) { world_.exchange_.applyShieldObject(c); },
        [&](const ShiftOrigin& c) {
            const float offset[] = {float(c.metres[0]), float(c.metres[1]), float(c.metres[2])};
            world_.shiftOrigin(offset, nullptr);
        },
        [&](const TransferBurn& c) {
            world_.burn_.transferBurn(idAt(world_.scene_.objects, c.from),
                                      idAt(world_.scene_.objects, c.to));
        },
    };
    std::visit(call, command);
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
    save::Hasher hasher;
    serializeRules(hasher, world_.context_.def);
    const uint32_t counts[] = {kSaveVersion,
                               world_.scene_.objects.live(),
                               world_.exchange_.state_.occluders.live(),
                               world_.flames_.state_.fires.live(),
                               world_.emitters_.state_.emitters.live(),
                               world_.fields_.state_.fields.live(),
                               world_.wind_.state_.zones.live(),
                               world_.rooms_.state_.rooms.live(),
                               world_.burn_.state_.burns.live()};
    hasher(counts);
    for (uint32_t i = 0; i < world_.scene_.objects.slotCount(); ++i)
        if (const auto* object = world_.scene_.objects.at(i)) {
            const uint64_t asset = assetOf(**object);
            hasher(i, asset);
        }
    return hasher.hash();
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

void PersistenceSystem::recordHash(const gpu::BurnMap& map, const gpu::Readback& readback) {
    const uint64_t end = readback.endTick;
    const uint32_t rounds = hashRounds(world_.scene_.objects.slotCount());
    if (end % kHashTicks != 0 || map.object % rounds != end / kHashTicks % rounds) return;
    // Once, however many frames end there.
    const auto before = std::find_if(
        recording_->hashes.rbegin(), recording_->hashes.rend(),
        [&](const ObjectHash& one) { return one.slot == map.object || one.tick < end; });
    if (before != recording_->hashes.rend() && before->tick == end) return;
    recording_->hashes.push_back({map.object, rounds, end, hashState(map.ticks, map.heat)});
}

}  // namespace fw::world
