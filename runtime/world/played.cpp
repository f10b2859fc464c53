#include "world/played.h"

#include "core/growth.h"
#include "core/hash.h"
#include "core/reserved.h"
#include "core/stream.h"
#include "save/plane.h"
#include "world/burn_system.h"
#include "world/recording.h"
#include "world/saved_object.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace fw::world {
namespace {

constexpr char kBurnMagic[] = "FWBB";
constexpr uint32_t kBurnVersion = 1;
constexpr size_t kBurnHead = 16;           // magic, version, checksum of the rest
constexpr uint32_t kMaxBurnSide = 4096;    // texels, as of a map
constexpr float kSlowestPlay = 1.0f / 16;  // speeds
constexpr float kFastestPlay = 16;

uint32_t playRate(float speed) noexcept { return uint32_t(std::lround(speed * float(kPlayRate))); }

// The most texels that catch in `steps` steps, wherever those begin.
uint32_t maxAtOnce(const Burn& burn, const Play& play, uint32_t steps) noexcept {
    const uint64_t span = uint64_t(steps) * gpu::kStepTicks;
    uint32_t most = 0;
    for (auto from = burn.order.begin(), at = from; at != burn.order.end(); ++at) {
        const uint64_t tick = play.tickOf(burn.ticks[*at]);
        while (play.tickOf(burn.ticks[*from]) + span < tick) ++from;
        most = std::max(most, uint32_t(at - from) + 1);
    }
    return most;
}

// The texels that catch from a tick on.
auto catchFrom(const Burn& burn, const Play& play, uint64_t tick) noexcept {
    return std::partition_point(burn.order.begin(), burn.order.end(), [&](uint32_t texel) {
        return play.tickOf(burn.ticks[texel]) < tick;
    });
}

}  // namespace

void writeBurn(std::span<const uint32_t> state, uint64_t mesh, uint32_t width, uint32_t height,
               std::pmr::vector<std::byte>& out) {
    uint32_t first = gpu::kNever;
    for (const uint32_t t : state)
        if (gpu::isSource(t)) first = std::min(first, t);
    std::pmr::vector<uint32_t> plane(out.get_allocator());
    plane.reserve(state.size());
    for (const uint32_t t : state) plane.push_back(gpu::isSource(t) ? t - first + 1 : 0);
    out.clear();
    core::Writer writer(out);
    save::writeHead(writer, kBurnMagic, kBurnVersion);
    writer.number(uint64_t(0));  // the checksum's place
    writer.number(mesh);
    writer.number(width);
    writer.number(height);
    save::writePlane(plane, width, {}, out);
    writer.numberAt(kBurnHead - sizeof(uint64_t),
                    core::hashBytes(std::span(out).subspan(kBurnHead)));
}

void readBurn(std::span<const std::byte> bytes, Burn& burn) {
    core::Reader reader(bytes, "baked burn");
    save::readHead(reader, kBurnMagic, kBurnVersion);
    reader.number(burn.hash);
    if (burn.hash != core::hashBytes(bytes.subspan(kBurnHead)))
        core::failData("The baked burn is damaged or cut: its checksum is not right.");
    reader.number(burn.mesh);
    reader.number(burn.width);
    reader.number(burn.height);
    for (const uint32_t side : {burn.width, burn.height})
        if (side == 0 || side > kMaxBurnSide || side % 8 != 0)
            core::failData(
                "The baked burn is of %u x %u texels; sides are multiples of 8, at most %u.",
                burn.width, burn.height, kMaxBurnSide);
    burn.ticks.assign(size_t(burn.width) * burn.height, 0);
    if (!save::readPlane(reader.take(reader.left()), burn.width, {}, burn.ticks))
        core::failData("The baked burn's plane of ticks is none.");
    burn.order.clear();
    for (uint32_t i = 0; i < burn.ticks.size(); ++i) {
        const bool lit = burn.ticks[i] != 0;
        if (lit) burn.order.push_back(i);
        burn.ticks[i] = lit ? burn.ticks[i] - 1 : gpu::kNever;
    }
    std::sort(burn.order.begin(), burn.order.end(), [&](uint32_t a, uint32_t b) {
        return std::tie(burn.ticks[a], a) < std::tie(burn.ticks[b], b);
    });
}

// ---- the system ---------------------------------------------------------------------------------

FwBurnId BurnSystem::createBurn(std::span<const std::byte> bytes) {
    auto burn = core::Owned<Burn>::make(context_.memory, context_.memory);
    readBurn(bytes, *burn);
    return state_.burns.create(std::move(burn));
}

void BurnSystem::destroyBurn(FwBurnId id) {
    (void)state_.burns.get(id);
    for (const Object* object : scene_.playing)
        if (object->play.burn1 == id.index1)
            core::refuse("Baked burn %u is played by burnable mesh %u.", id.index1,
                         object->id.index1);
    state_.burns.destroy(id);
}

void BurnSystem::playBurn(FwBurnableMeshId id, FwBurnId burn, float delay, float speed) {
    context_.recorder.mayChange();
    components::checkValue(delay, "delay", 0.0f, 3600.0f);
    playBurnAt(id, burn, eventTick(delay), speed);
}

void BurnSystem::apply(const PlayBurn& command) {
    checkCommandTick(command.tick);
    playBurnAt(scene_.objects.findId(command.slot), state_.burns.findId(command.burn1 - 1),
               command.tick, command.speed);
}

void BurnSystem::playBurnAt(FwBurnableMeshId id, FwBurnId burnId, uint32_t tick, float speed) {
    Object& object = *scene_.objects.get(id);
    const Burn& burn = *state_.burns.get(burnId);
    components::checkValue(speed, "speed", kSlowestPlay, kFastestPlay);
    if (object.data.flags & core::reserved::kBurning)
        core::refuse("Burnable mesh %u burns by an extension; it plays no baked burn.", id.index1);
    const uint64_t mesh = scene_.meshHash(object);
    if (burn.mesh != mesh || burn.ticks.size() != scene_.domainOf(object).texelCount())
        core::refuse(
            "Baked burn %u is of a mesh of hash %016llx; burnable mesh %u has one of "
            "%016llx.",
            burnId.index1, static_cast<unsigned long long>(burn.mesh), id.index1,
            static_cast<unsigned long long>(mesh));
    Play play;
    play.burn1 = burnId.index1;
    // Its first texel catches in the step after the one that starts it in the backend.
    play.first = std::max(tick, uint32_t(context_.clock.tick) + gpu::kStepTicks);
    play.rate = playRate(speed);
    play.most = maxAtOnce(burn, play, context_.def.maxStepsPerFrame);
    core::growTo(scene_.playing, scene_.playing.size() + 1);
    reservePlays(play.most);
    if (object.play.burn1 == 0) startPlay(object);
    object.play = play;
    object.firstEvent = std::min(object.firstEvent, play.first);
    ++object.changes;
    context_.recorder.record(PlayBurn{object.slot, burnId.index1, tick, speed});
}

void BurnSystem::stopBurn(FwBurnableMeshId id) {
    context_.recorder.mayChange();
    Object& object = *scene_.objects.get(id);
    object.play.ends = object.play.burn1 != 0;
    context_.recorder.record(StopBurn{object.slot});
}

// ---- a frame ------------------------------------------------------------------------------------

// Reserves the most events that all that play make in a frame, and `more`.
void BurnSystem::reservePlays(size_t more) {
    core::growTo(frame_.plays, scene_.playing.size() + 1);
    size_t events = state_.pending.size() + more;
    for (const Object* object : scene_.playing) events += object->play.most;
    core::growTo(frame_.events, events + 2 * (scene_.playing.size() + 1));
}

void BurnSystem::startPlay(Object& object) noexcept {
    FW_ASSERT(scene_.playing.size() < scene_.playing.capacity(), "%zu objects",
              scene_.playing.size());
    scene_.playing.insert(
        std::lower_bound(scene_.playing.begin(), scene_.playing.end(), &object,
                         [](const Object* a, const Object* b) { return a->slot < b->slot; }),
        &object);
}

void BurnSystem::endPlay(Object& object, uint64_t frameIndex, uint32_t tick) noexcept {
    object.play = {};
    ++object.changes;
    std::erase(scene_.playing, &object);
    float place[3];
    for (int i = 0; i < 3; ++i) place[i] = float(object.data.pose.translation[i]);
    context_.raise(FW_EVENT_WENT_LIVE, &object, 0, frameIndex, place,
                   float(double(tick) / gpu::kTicksPerSecond));
}

// Lists the objects that play. Returns the most events that they make up to a tick.
size_t BurnSystem::beginPlays(uint64_t end) {
    frame_.plays.clear();
    size_t events = 0;
    for (Object* object : scene_.playing) {
        const Play& play = object->play;
        FW_ASSERT(play.burn1 != 0 && play.rate > 0, "burn %u, rate %u", play.burn1, play.rate);
        frame_.plays.push_back({object, play});
        const Burn& burn = **state_.burns.at(play.burn1 - 1);
        const auto last = catchFrom(burn, play, end);
        events += size_t(last - catchFrom(burn, play, context_.clock.tick));
        if (play.began == 0 || play.ends || last == burn.order.end()) events += 2;
    }
    return events;
}

// Adds the events of a step. `due`: all other events of that step, by object.
void BurnSystem::planPlays(uint32_t now, std::span<const PendingTexel> due) {
    const uint32_t end = now + gpu::kStepTicks;
    for (Frame::PlayOf& entry : frame_.plays) {
        Play& play = entry.play;
        if (play.burn1 == 0) continue;
        const uint32_t slot = entry.object->slot;
        const bool disturbed = std::ranges::binary_search(due, slot, {}, &PendingTexel::object);
        const auto push = [&](uint32_t texel, uint32_t kind, uint32_t tick) {
            frame_.events.push_back({slot, texel, kind, tick});
        };
        bool ends = play.ends || disturbed;
        if (play.began == 0 && !ends) {
            push(gpu::kNoneTexel, gpu::kEventPlaybackSpan, gpu::kNever);
            play.began = end;
        } else if (play.began != 0) {
            const Burn& burn = **state_.burns.at(play.burn1 - 1);
            const auto next = catchFrom(burn, play, end);
            // Where others have an event, too, none of ours is beside it: a texel's are in order.
            if (!disturbed)
                for (auto at = catchFrom(burn, play, now); at != next; ++at) {
                    if (entry.lit == mesh::kNone) entry.lit = *at;
                    push(*at, gpu::kEventPlayback, uint32_t(play.tickOf(burn.ticks[*at])));
                }
            ends |= next == burn.order.end();
        }
        if (!ends) continue;
        push(gpu::kNoneTexel, gpu::kEventPlaybackSpan,
             end);  // of a burn that it played before, too
        play = {};
        entry.ended = end;
    }
}

// Its wind or pose turned in a step: it plays in the next, and is live from then on.
void BurnSystem::turnPlay(const Object& object) noexcept {
    for (Frame::PlayOf& entry : frame_.plays)
        if (entry.object == &object && entry.play.began != 0) entry.play.ends = true;
}

void BurnSystem::settlePlays(const BurnSnapshot& saved, std::span<ObjectSnapshot> objects,
                             const Clock& clock) {
    size_t events = saved.pending.size(), count = 0;
    for (ObjectSnapshot& object : objects) {
        Play& play = object.play;
        if (play.burn1 == 0) continue;
        const core::Owned<Burn>* burn = state_.burns.findSlot(play.burn1 - 1);
        if (!burn || (*burn)->hash != object.burnHash ||
            (*burn)->mesh != scene_.meshHash(scene_.objectAt(object.slot)))
            core::failData(
                "Burnable mesh %u of the save plays baked burn %u, which is none or another "
                "one here.",
                object.slot + 1, play.burn1);
        if (play.rate < playRate(kSlowestPlay) || play.rate > playRate(kFastestPlay) ||
            play.first > Clock::kLastTick || play.began > clock.tick)
            core::failData("Burnable mesh %u of the save plays a baked burn as none can be.",
                           object.slot + 1);
        play.most = maxAtOnce(**burn, play, context_.def.maxStepsPerFrame);
        events += play.most + 2;
        ++count;
    }
    frame_.plays.reserve(count);
    frame_.events.reserve(events);
}

void BurnSystem::commitPlays(uint64_t frameIndex) noexcept {
    for (const Frame::PlayOf& entry : frame_.plays) {
        Object& object = *entry.object;
        if (object.play.began == 0 && entry.play.began != 0) {
            Stimulus& stimulus = stimulusOf(object, frameIndex);
            stimulus.starts = true;
            stimulus.latest = std::max<uint64_t>(stimulus.latest, entry.play.began);
        }
        if (entry.lit != mesh::kNone) {
            const Burn& burn = **state_.burns.at(object.play.burn1 - 1);
            recordIgnition(object, stimulusOf(object, frameIndex), entry.lit,
                           uint32_t(object.play.tickOf(burn.ticks[entry.lit])));
        }
        object.play = entry.play;
        if (object.play.burn1 == 0) endPlay(object, frameIndex, entry.ended);
    }
}

}  // namespace fw::world
