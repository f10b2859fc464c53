// Commands as bytes and as they are applied, and hashes of objects in turn.
#include "world/recording.h"

#include "core/hash.h"
#include "world/save.h"
#include "world/world.h"

#include <algorithm>

namespace fw::world {
namespace {

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
        core::failData("The %s has a command of kind %u; the limit is %u.", reader.name(), kind,
                       kCommandKinds - 1);
    makeKind(command, kind, std::make_index_sequence<kCommandKinds>());
    std::visit([&](auto& one) { reader(one); }, command);
}

void readCommand(uint32_t kind, std::span<const std::byte> bytes, Command& command) {
    save::Reader reader(bytes, "packet", std::pmr::null_memory_resource());
    readCommand(kind, reader, command);
    if (reader.left() != 0)
        core::failData("%zu bytes follow a command of the packet.", reader.left());
}

uint64_t hashState(std::span<const uint32_t> ticks, std::span<const gpu::uvec2> heat) noexcept {
    uint64_t hash = core::hashWords(ticks);
    for (const gpu::uvec2& texel : heat) {
        const uint32_t words[2] = {texel.x, texel.y};
        hash = core::hashWords(words, hash);
    }
    return hash;
}

void Recorder::mayChange() const {
    if (network && network->follows && !network->applies)
        core::refuse("The world follows a server's: what burns in it is changed there.");
}

void Recorder::record(const Command& command) noexcept {
    if (log) log->push({clock_.tick, false, command});
    if (timeline) timeline->record(command, clock_.tick);
    if (!network || network->follows) return;
    try {
        network->commands.push_back({clock_.tick, false, command});
    } catch (...) {  // the world has changed: every client needs its whole state again
        network->lost = true;
    }
}

Recording& PersistenceSystem::startRecording(bool follows) {
    recorder_.network = core::Owned<Recording>::make(context_.memory, context_.memory);
    recorder_.network->follows = follows;
    recorder_.network->until = context_.clock.tick;
    return *recorder_.network;
}

void PersistenceSystem::applyLoad(std::span<const std::byte> bytes) {
    const Raised applying(recorder_.network ? &recorder_.network->applies : nullptr);
    load(bytes);
}

// Exactly one of the world and its systems applies each kind.
void PersistenceSystem::apply(const Command& command) {
    const Raised applying(recorder_.network ? &recorder_.network->applies : nullptr);
    std::visit(
        [&](const auto& one) {
            uint32_t owners = 0;
            const auto applyTo = [&](auto& owner) {
                if constexpr (requires { owner.apply(one); }) {
                    owner.apply(one);
                    ++owners;
                }
            };
            applyTo(world_);
            world_.eachSystem(applyTo);
            FW_ASSERT(owners == 1, "%u apply a command of kind %zu", owners, command.index());
        },
        command);
}

double PersistenceSystem::seconds() const noexcept {
    return double(context_.clock.tick) / gpu::kTicksPerSecond +
           double(context_.clock.fraction) / double(uint64_t(1) << Clock::kFractionBits);
}

double PersistenceSystem::secondsTo(uint64_t tick) const noexcept {
    constexpr double kUnit = 1.0 / double(uint64_t(1) << Clock::kFractionBits);
    if (tick <= context_.clock.tick) return 0;
    const uint64_t steps = (tick - context_.clock.tick) / gpu::kStepTicks;
    return double(steps * Clock::kStepUnits - context_.clock.fraction) * kUnit;
}

uint64_t PersistenceSystem::identity() noexcept {
    save::Hasher hasher;
    serializeRules(hasher, context_.def);
    const uint32_t counts[] = {kSaveVersion,
                               scene_.objects.live(),
                               world_.exchange_.occluders().live(),
                               world_.flames_.fires().live(),
                               world_.emitters_.emitters().live(),
                               world_.fields_.fields().live(),
                               world_.wind_.state().zones.live(),
                               world_.rooms_.state().rooms.live(),
                               world_.burn_.state().burns.live()};
    hasher(counts);
    for (auto [slot, object] : scene_.objects.entries()) {
        const uint64_t asset = assetOf(object);
        hasher(slot, asset);
    }
    return hasher.hash();
}

// The objects whose turn it is are read back with a frame that ends there.
void PersistenceSystem::planHashes(const HostFrame& frame) {
    const uint64_t end = frame.end();
    if (frame.time.steps == 0 || end % kHashTicks != 0) return;
    const uint32_t slots = scene_.objects.slotCount(), rounds = hashRounds(slots);
    for (auto slot = uint32_t(end / kHashTicks % rounds); slot < slots; slot += rounds)
        if (scene_.objects.at(slot)) hashed_.push_back(slot);
}

void PersistenceSystem::recordHash(const gpu::ObjectImage& map, const gpu::Readback& readback) {
    const uint64_t end = readback.endTick;
    const uint32_t rounds = hashRounds(scene_.objects.slotCount());
    if (end % kHashTicks != 0 || map.object % rounds != end / kHashTicks % rounds) return;
    // Once, however many frames end there.
    const auto before = std::find_if(
        recorder_.network->hashes.rbegin(), recorder_.network->hashes.rend(),
        [&](const ObjectHash& one) { return one.slot == map.object || one.tick < end; });
    if (before != recorder_.network->hashes.rend() && before->tick == end) return;
    recorder_.network->hashes.push_back({map.object, rounds, end, hashState(map.ticks, map.heat)});
}

}  // namespace fw::world
