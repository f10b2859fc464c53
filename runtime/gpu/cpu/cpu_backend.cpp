// The passes of a simulation step in order, on vectors instead of buffers. Each function is the
// shader of the same name in shaders/burn.
#include "gpu/cpu/cpu_backend.h"

#include "core/error.h"
#include "core/growth.h"
#include "core/hash.h"
#include "flamewright/flamewright_debug.h"
#include "gpu/cpu/cpu_state.h"
#include "mesh/remote_tiles.h"
#include "shared/grant.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdio>
#include <numeric>

namespace fw::gpu::cpu {

static_assert(kSwitchDense == FW_DEBUG_DENSE && kSwitchShuffle == FW_DEBUG_SHUFFLE &&
              kSwitchNoSeamWake == FW_DEBUG_NO_SEAM_WAKE &&
              kSwitchWrongReaders == FW_DEBUG_WRONG_READERS &&
              kSwitchNoWindWake == FW_DEBUG_NO_WIND_WAKE);

namespace {

constexpr const char* kTimerNames[kTimerCount] = {"wake",      "events",  "rooms",    "heat",
                                                  "schedule",  "arrival", "grant",    "commit",
                                                  "published", "reduce",  "exchange", "field"};

class Stopwatch {
 public:
    Stopwatch(CpuBackend::State& state, Timer timer) noexcept
        : state_(state), timer_(timer), start_(std::chrono::steady_clock::now()) {}
    ~Stopwatch() {
        const auto end = std::chrono::steady_clock::now();
        state_.milliseconds[timer_] +=
            std::chrono::duration<double, std::milli>(end - start_).count();
        ++state_.timed[timer_];
    }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

 private:
    CpuBackend::State& state_;
    Timer timer_;
    std::chrono::steady_clock::time_point start_;
};

}  // namespace

CpuBackend::State::State(std::pmr::memory_resource* memory_, uint32_t maxLights_)
    : memory(memory_),
      maxLights(maxLights_),
      meshes(memory_),
      objects(memory_),
      tiles(memory_),
      list(memory_),
      listOut(memory_),
      runList(memory_),
      burnList(memory_),
      hotList(memory_),
      hotOut(memory_),
      asks(memory_),
      asked(memory_),
      tileHeat(memory_),
      tileFire(memory_),
      results(memory_),
      scratch(memory_),
      burnTiles(memory_),
      freeTiles(memory_),
      readbacks(memory_) {}

FrontPlanes CpuBackend::State::planes(const CpuObject& object) const noexcept {
    const mesh::BurnDomain& domain = *object.domain;
    FrontPlanes planes;
    planes.state = object.state.data();
    planes.texels = domain.texels.data();
    planes.normals = domain.normals.data();
    planes.slowness = object.slowness.empty() ? domain.slowness.data() : object.slowness.data();
    planes.links = domain.links.data();
    planes.tiles = domain.tiles.data();
    planes.materials = object.materials.data();
    planes.width = domain.width;
    planes.tilesX = domain.tilesX;
    return planes;
}

void CpuBackend::State::touch(uint32_t worldTile, uint32_t bits) noexcept {
    uint32_t& flag = tiles[worldTile].flag;
    if ((flag & kTileListed) == 0) list.push_back(worldTile);
    flag |= kTileListed | bits;
}

void CpuBackend::State::burning(uint32_t worldTile) noexcept {
    uint32_t& flag = tiles[worldTile].flag;
    if ((flag & kTileBurning) == 0) {
        burnList.push_back(worldTile);
        ++objects[tiles[worldTile].object]->counters.burningTiles;
    }
    flag |= kTileBurning;
}

void CpuBackend::State::askToBurn(uint32_t worldTile) noexcept {
    if (asked[worldTile] != 0) return;
    asked[worldTile] = 1;
    asks.push_back({0, 0, 0, worldTile});
}

void CpuBackend::State::grant(uint32_t tilesMost, uint32_t now) noexcept {
    Stopwatch watch(*this, kTimerGrant);
    for (uvec4& ask : asks) {
        asked[ask.w] = 0;
        ask.y = tiles[ask.w].object;
        ask.z = ask.w - objects[ask.y]->record.worldTileBase;
        ask.x = askOrder(ask.y, ask.z, now);
    }
    std::sort(asks.begin(), asks.end(), asksBefore);
    for (const uvec4& ask : asks) {
        const CpuObject& object = *objects[ask.y];
        const bool limited = (object.remote.flags & kRemoteLive) != 0;
        // What the host lit meanwhile burns without leave, and counts.
        if ((tiles[ask.w].flag & kTileBurning) == 0 &&
            roomFor(uint32_t(burnList.size()) + goneBurning, tilesMost) != 0 &&
            (!limited || roomFor(object.counters.burningTiles, object.remote.tilesMost) != 0))
            burning(ask.w);
    }
    asks.clear();
}

void CpuBackend::State::touchReaders(const CpuObject& object, uint32_t local,
                                     uint64_t mask) noexcept {
    const uint32_t base = object.record.worldTileBase;
    const mesh::BurnDomain& domain = *object.domain;
    touch(base + local, kTileTouched);
    mesh::forEachTileBeside(domain, local, mask,
                            [&](uint32_t tile) { touch(base + tile, kTileTouched); });
    if ((switches & kSwitchNoSeamWake) != 0) return;
    for (const uint32_t reader : mesh::seamReaders(domain, local, mask))
        touch(base + ((switches & kSwitchWrongReaders) != 0 ? 0 : reader), kTileTouched);
}

// As events.comp has it.
void CpuBackend::State::carryTexel(const TexelEvent& event, uint32_t now) noexcept {
    CpuObject& object = *objects[event.object];
    const CpuObject& from = *objects[(event.kind >> kEventKindBits) - 1];
    uint32_t& state = object.state[event.texel];
    const uint32_t before = state;
    uint32_t after = from.state[event.tick];
    if (asksOnly || !carries(after, before)) return;
    const uint32_t x = event.texel % object.domain->width, y = event.texel / object.domain->width;
    const uint32_t local = (y >> 3) * object.domain->tilesX + (x >> 3);
    const uint32_t worldTile = object.record.worldTileBase + local;
    if (!object.heat.empty()) {
        const HeatMaterial& m =
            object.heatMaterials[object.domain->texels[event.texel].materialFlags & 7];
        const HeatTexel has = heatCarried(unpackHeat(from.heat[event.tick]), m);
        after = wetState(after, heatClosed(has, m));
        const uvec2 had = object.heat[event.texel], packed = packHeat(has);
        if (packed == had && after == before) return;
        // Fuel that burnt on the other mesh counts as its own loss, of which its room has had its
        // share.
        const uint64_t lost =
            uint64_t(int64_t(unpackHeat(had).fuel) - int64_t(has.fuel)) * m.energy;
        ObjectCounters& c = object.counters;
        const uint64_t energy = (uint64_t(c.energyHigh) << 32 | c.energyLow) + lost;
        const uint64_t drawn = (uint64_t(c.drawnHigh) << 32 | c.drawnLow) + lost;
        c.energyLow = uint32_t(energy);
        c.energyHigh = uint32_t(energy >> 32);
        c.drawnLow = uint32_t(drawn);
        c.drawnHigh = uint32_t(drawn >> 32);
        object.heat[event.texel] = packed;
        hot(worldTile);
    }
    if (after == before) return;
    state = after;
    if (isSource(after) != isSource(before)) object.counters.ignited += isSource(after) ? 1u : ~0u;
    if (isSource(after)) {
        object.counters.lastIgnition = std::max(object.counters.lastIgnition, now + kStepTicks);
        burning(worldTile);
        object.counters.litBy = std::max(object.counters.litBy, from.counters.litBy);
        object.counters.litTick = std::max(object.counters.litTick, from.counters.litTick);
        object.counters.stopTick = std::max(object.counters.stopTick, from.counters.stopTick);
    }
    tiles[worldTile].lastChange = now;
    touchReaders(object, local, 1ull << ((y & 7) * 8 + (x & 7)));
}

// How many events from `first` on are of the same object and texel, all texels being one.
size_t CpuBackend::State::runOf(std::span<const TexelEvent> events, size_t first) noexcept {
    size_t end = first;
    while (end < events.size() && events[end].object == events[first].object &&
           events[end].texel == events[first].texel && eventKind(events[end].kind) != kEventGate &&
           eventKind(events[end].kind) != kEventPlays && eventKind(events[end].kind) != kEventCarry)
        ++end;
    return end - first;
}

// Returns the texel state after a run of events; in `heated` what of its heat.
uint32_t CpuBackend::State::afterEvents(const CpuObject& object, uint32_t texel,
                                        std::span<const TexelEvent> batch,
                                        std::span<const TexelEvent> run, uint32_t now,
                                        HeatTexel& heated, bool& byFlame) const noexcept {
    if (!object.heat.empty()) return heatEvents(object, texel, batch, run, now, heated, byFlame);
    uint32_t after = object.state[texel];
    for (const TexelEvent& event : run)
        after = applyEvent(after, playedKind(event.kind, object.counters.playsUntil, now),
                           event.tick, now);
    return after;
}

void CpuBackend::State::applyEvents(const StepPlan& step) noexcept {
    for (size_t i = 0; i < step.events.size();) {
        const TexelEvent& first = step.events[i];
        if (eventKind(first.kind) == kEventGate) break;  // the rest are
        CpuObject& object = *objects[first.object];
        if (eventKind(first.kind) == kEventCarry) {
            carryTexel(first, step.now);
            ++i;
            continue;
        }
        if (eventKind(first.kind) == kEventPlays) {
            if (first.tick == kNever)
                object.counters.playsUntil = kNever;
            else
                disturb(object, first.tick);
            ++i;
            continue;
        }
        const auto run = step.events.subspan(i, runOf(step.events, i));
        i += run.size();
        if (first.texel == kNoneTexel) {
            applyToAll(object, run, step);
            continue;
        }
        uint32_t& texel = object.state[first.texel];
        const uint32_t before = texel;
        HeatTexel heated{};
        bool byFlame = false;  // lit by heat that came; what the host lights needs no leave
        const uint32_t now =
            afterEvents(object, first.texel, step.events, run, step.now, heated, byFlame);
        const uint32_t x = first.texel % object.domain->width;
        const uint32_t y = first.texel / object.domain->width;
        const uint32_t local = (y >> 3) * object.domain->tilesX + (x >> 3);
        const uint32_t worldTile = object.record.worldTileBase + local;
        const bool lights = isSource(now) && !isSource(before);
        if (asksOnly) {
            if (lights && byFlame)
                askToBurn(worldTile);
            else if (lights)
                burning(worldTile);
            continue;
        }
        if (lights && byFlame && !mayBurn(worldTile)) continue;
        if (!object.heat.empty()) {
            const uvec2 had = object.heat[first.texel];
            object.heat[first.texel] = packHeat(heated);
            if (now != before || object.heat[first.texel] != had) hot(worldTile);
        }
        if (now == before) continue;
        texel = now;
        if (isSource(now) != isSource(before)) object.counters.ignited += isSource(now) ? 1u : ~0u;
        if (isSource(now)) {
            object.counters.lastIgnition =
                std::max(object.counters.lastIgnition, step.now + kStepTicks);
            burning(worldTile);
            if (!isSource(before)) litFrom(object, kLitByHand);
        }
        if (!object.published.empty()) {
            publishedEvent(object, first.texel, isSource(now));
            continue;
        }
        tiles[worldTile].lastChange = step.now;
        touchReaders(object, local, 1ull << ((y & 7) * 8 + (x & 7)));
    }
}

// As for its texels one by one. The host's own events: none needs leave to burn.
void CpuBackend::State::applyToAll(CpuObject& object, std::span<const TexelEvent> run,
                                   const StepPlan& step) noexcept {
    const mesh::BurnDomain& domain = *object.domain;
    const bool heats = !object.heat.empty();
    // Texels at rest are alike: what the last one became is what the next one does.
    uint32_t knownBefore = 0, knownAfter = 0, knownMaterial = kNoneTexel;
    uvec2 knownHad(0), knownHeat(0);
    for (uint32_t local = 0; local < object.record.tileCount; ++local) {
        const uint32_t worldTile = object.record.worldTileBase + local;
        const uint32_t corner =
            (local / domain.tilesX) * 8 * domain.width + (local % domain.tilesX) * 8;
        uint64_t changed = 0;
        bool heated = false, burns = false;
        for (uint32_t lane = 0; lane < 64; ++lane) {
            const uint32_t texel = corner + (lane >> 3) * domain.width + (lane & 7);
            const uint32_t flags = domain.texels[texel].materialFlags;
            if ((flags & kTexelReal) == 0) continue;
            const uint32_t before = object.state[texel];
            const uvec2 had = heats ? object.heat[texel] : uvec2(0);
            if (before != knownBefore || had != knownHad || (flags & 7) != knownMaterial) {
                HeatTexel x{};
                bool byFlame = false;
                knownAfter = afterEvents(object, texel, step.events, run, step.now, x, byFlame);
                knownHeat = heats ? packHeat(x) : uvec2(0);
                knownBefore = before;
                knownHad = had;
                knownMaterial = flags & 7;
            }
            const uint32_t now = knownAfter;
            if (asksOnly) {
                burns |= isSource(now) && !isSource(before);
                continue;
            }
            if (heats) {
                object.heat[texel] = knownHeat;
                heated |= now != before || knownHeat != had;
            }
            if (now == before) continue;
            object.state[texel] = now;
            changed |= 1ull << lane;
            if (isSource(now) != isSource(before))
                object.counters.ignited += isSource(now) ? 1u : ~0u;
            burns |= isSource(now);
            if (isSource(now) && !isSource(before)) litFrom(object, kLitByHand);
            if (!object.published.empty()) publishedEvent(object, texel, isSource(now));
        }
        if (heated) hot(worldTile);
        if (burns) burning(worldTile);
        if (changed == 0) continue;
        if (burns)
            object.counters.lastIgnition =
                std::max(object.counters.lastIgnition, step.now + kStepTicks);
        if (!object.published.empty()) continue;
        tiles[worldTile].lastChange = step.now;
        touchReaders(object, local, changed);
    }
}

void CpuBackend::State::wake(const StepPlan& step) noexcept {
    for (const MaterialUpdate& update : step.materials) {
        CpuObject& object = *objects[update.object];
        std::copy_n(update.materials, kMaterialsPerObject, object.materials.begin());
        object.record.window = update.window;
        object.record.substepShift = update.substepShift;
        if ((switches & kSwitchNoWindWake) != 0 || !object.published.empty()) continue;
        for (uint32_t local = 0; local < object.record.tileCount; ++local) {
            const uint32_t worldTile = object.record.worldTileBase + local;
            const bool listed = (tiles[worldTile].flag & kTileListed) != 0;
            if (latchTouches(listed, tiles[worldTile].lastChange, step.now, update.window))
                touch(worldTile, kTileTouched);
        }
    }
}

void CpuBackend::State::scheduleTile(const StepPlan& step, uint32_t iteration, uint32_t worldTile,
                                     bool dense) noexcept {
    TileState& tile = tiles[worldTile];
    const BurnObject& record = objects[tile.object]->record;
    if (!takesPart(iteration, step.substepShift, record.substepShift)) {
        if ((tile.flag & kTileListed) != 0) listOut.push_back(worldTile);
        return;
    }
    if (step.plays && playsAt(objects[tile.object]->counters.playsUntil, step.now)) {
        if ((tile.flag & kTileListed) != 0) listOut.push_back(worldTile);  // due when it goes live
        return;
    }
    if (step.governed) {
        const CpuObject& object = *objects[tile.object];
        const bool listed = (tile.flag & kTileListed) != 0;
        if (stoppedAt(object.counters.stopTick, step.now)) {
            tile.flag &= ~(kTileListed | kTileTouched);
            return;
        }
        if (holdsTile(tile.flag, scheduledBurning, step.rules.tilesMost,
                      object.counters.burningTiles, object.remote.flags, object.remote.tilesMost)) {
            if (listed) listOut.push_back(worldTile);
            return;
        }
    }
    const uint32_t end = iterationEnd(step.now, iteration, step.substepShift, record.substepShift);
    if (dense || (tile.flag & kTileTouched) != 0 || tile.wake <= end) {
        runList.push_back(worldTile);
        tile.wake = kNever;
        tile.flag &= ~(kTileListed | kTileTouched);
    } else if (tile.wake != kNever) {
        listOut.push_back(worldTile);
    } else {
        tile.flag &= ~kTileListed;
    }
}

void CpuBackend::State::schedule(const StepPlan& step, uint32_t iteration) noexcept {
    runList.clear();
    listOut.clear();
    scheduledBurning = uint32_t(burnList.size()) + goneBurning;
    if ((switches & kSwitchDense) != 0) {
        for (const core::Owned<CpuObject>& object : objects) {
            if (!object || !object->live || !object->published.empty()) continue;
            for (uint32_t local = 0; local < object->record.tileCount; ++local)
                scheduleTile(step, iteration, object->record.worldTileBase + local, true);
        }
    } else {
        for (uint32_t worldTile : list) scheduleTile(step, iteration, worldTile, false);
    }
    list.swap(listOut);  // from here on `list` is the one that commits append to
    if ((switches & kSwitchShuffle) != 0) {
        shuffle(list);
        shuffle(runList);
    }
}

void CpuBackend::State::shuffle(std::pmr::vector<uint32_t>& entries) noexcept {
    for (size_t i = entries.size(); i > 1; --i)
        std::swap(entries[i - 1], entries[core::hash32(random++) % i]);
}

void CpuBackend::State::iterate(const StepPlan& step, uint32_t iteration) noexcept {
    {
        Stopwatch watch(*this, kTimerSchedule);
        schedule(step, iteration);
    }
    if (runList.empty()) return;
    runTiles += runList.size();
    {
        Stopwatch watch(*this, kTimerArrival);
        uint32_t known = kNoneTexel;  // object whose planes are at hand
        FrontPlanes at;
        uint32_t end = 0, floorTick = 0, base = 0;
        for (size_t i = 0; i < runList.size(); ++i) {
            const uint32_t worldTile = runList[i];
            if (tiles[worldTile].object != known) {
                known = tiles[worldTile].object;
                const CpuObject& object = *objects[known];
                const uint32_t shift = object.record.substepShift;
                at = planes(object);
                end = iterationEnd(step.now, iteration, step.substepShift, shift);
                floorTick =
                    frontFloor(end - windowTicks(step.substepShift, shift), object.record.window);
                base = object.record.worldTileBase;
            }
            results[i] = mesh::runFrontTile(at, worldTile - base, end, floorTick, &scratch[i * 64]);
        }
    }
    if (capped) {
        for (size_t i = 0; i < runList.size(); ++i)
            if (results[i].lit != 0 && !mayBurn(runList[i])) askToBurn(runList[i]);
        grant(step.rules.tilesMost, step.now);
    }
    Stopwatch watch(*this, kTimerCommit);
    for (size_t i = 0; i < runList.size(); ++i) {
        const uint32_t worldTile = runList[i];
        const FrontTile& result = results[i];
        TileState& tile = tiles[worldTile];
        tile.wake = result.wake;
        if (result.lit != 0 && !mayBurn(worldTile)) {  // left as it was, and due again
            touch(worldTile, kTileTouched);
            continue;
        }
        if (result.changed == 0) {
            if (result.wake != kNever) touch(worldTile, 0);
            continue;
        }
        CpuObject& object = *objects[tile.object];
        const uint32_t local = worldTile - object.record.worldTileBase;
        const uint32_t corner = (local / object.domain->tilesX) * 8 * object.domain->width +
                                (local % object.domain->tilesX) * 8;
        for (uint64_t rest = result.changed; rest != 0; rest &= rest - 1) {
            const uint32_t lane = uint32_t(std::countr_zero(rest));
            object.state[corner + (lane >> 3) * object.domain->width + (lane & 7)] =
                scratch[i * 64 + lane];
        }
        const uint32_t end =
            iterationEnd(step.now, iteration, step.substepShift, object.record.substepShift);
        tile.lastChange = end;
        object.counters.lateClamps += result.late;
        if (result.lit != 0) {
            object.counters.ignited += uint32_t(std::popcount(result.lit));
            object.counters.lastIgnition = std::max(object.counters.lastIgnition, end);
            burning(worldTile);
            if (!object.heat.empty()) hot(worldTile);
        }
        touchReaders(object, local, result.changed);
    }
}

uint32_t CpuBackend::State::allocateTiles(uint32_t count) {
    for (Range& range : freeTiles) {
        if (range.count < count) continue;
        const uint32_t first = range.first;
        range.first += count;
        range.count -= count;
        return first;
    }
    const size_t first = tiles.size();
    const size_t total = first + count;
    if (total > 0x7FFFFFFFu)
        core::fail(FW_ERROR_OUT_OF_MEMORY, "The world has %zu tiles; the limit is %u.", total,
                   0x7FFFFFFFu);
    // All or nothing: room first, then the size that says so. Half as much again, or the thousandth
    // object would copy what the others have a thousandth time.
    const auto findRoom = [](auto& entries, size_t needed) {
        if (entries.capacity() < needed)
            entries.reserve(std::max(needed, entries.capacity() + entries.capacity() / 2));
    };
    for (auto* entries : {&list, &listOut, &runList, &burnList, &hotList, &hotOut})
        findRoom(*entries, total);
    findRoom(asks, total);
    findRoom(asked, total);
    findRoom(tileHeat, total);
    findRoom(tileFire, total);
    findRoom(burnTiles, total);
    findRoom(results, total);
    findRoom(scratch, total * 64);
    findRoom(tiles, total);
    results.resize(total);
    scratch.resize(total * 64);
    tiles.resize(total);
    tileHeat.resize(total);
    tileFire.resize(total);
    asked.resize(total);
    return uint32_t(first);
}

void CpuBackend::State::releaseTiles(uint32_t first, uint32_t count) noexcept {
    const auto at = std::lower_bound(freeTiles.begin(), freeTiles.end(), first,
                                     [](const Range& r, uint32_t f) { return r.first < f; });
    freeTiles.insert(at, {first, count});  // room was reserved with the object
    size_t kept = 0;
    for (size_t i = 0; i < freeTiles.size(); ++i) {
        if (freeTiles[i].count == 0) continue;
        if (kept > 0 && freeTiles[kept - 1].first + freeTiles[kept - 1].count == freeTiles[i].first)
            freeTiles[kept - 1].count += freeTiles[i].count;
        else
            freeTiles[kept++] = freeTiles[i];
    }
    freeTiles.resize(kept);
}

CpuBackend::CpuBackend(std::pmr::memory_resource* memory, uint32_t maxLights)
    : state_(core::Owned<State>::make(memory, memory, maxLights)) {}

CpuBackend::~CpuBackend() = default;

void CpuBackend::createMesh(uint32_t slot, const mesh::BurnDomain& domain) {
    std::pmr::vector<RemoteTile> tiles(state_->memory);
    (void)mesh::remoteTiles(domain, tiles);
    if (slot >= state_->remoteTiles.size()) state_->remoteTiles.resize(slot + 1);
    if (slot >= state_->meshes.size()) state_->meshes.resize(slot + 1, nullptr);
    state_->meshes[slot] = &domain;
    state_->remoteTiles[slot].swap(tiles);
}

void CpuBackend::destroyMesh(uint32_t slot) noexcept {
    if (slot < state_->meshes.size()) state_->meshes[slot] = nullptr;
}

void CpuBackend::createObject(uint32_t slot, const ObjectInit& init) {
    State& s = *state_;
    auto object = core::Owned<CpuObject>::make(s.memory, s.memory);
    const mesh::BurnDomain& domain = *s.meshes[init.mesh];
    const uint32_t texels = domain.texelCount();
    object->mesh = init.mesh;
    object->domain = &domain;
    object->record = init.record;
    std::copy_n(init.materials.begin(), kMaterialsPerObject, object->materials.begin());
    object->slowness.assign(init.slowness.begin(), init.slowness.end());
    object->state.resize(texels);
    if (!init.heat.empty()) {
        std::copy_n(init.heat.begin(), kMaterialsPerObject, object->heatMaterials.begin());
        object->heat.resize(texels);
    }
    if ((init.record.flags & kObjectPublished) != 0) createPublished(*object);
    object->sources.resize(mesh::sourceCells(domain));
    if (slot >= s.objects.size()) s.objects.resize(slot + 1);
    core::growTo(s.freeTiles, s.objects.size() + s.freeTiles.size() + 1);
    const uint32_t first = s.allocateTiles(domain.tileCount());
    object->record.worldTileBase = first;
    object->record.width = domain.width;
    object->record.height = domain.height;
    object->record.tilesX = domain.tilesX;
    object->record.tileCount = domain.tileCount();
    object->record.flags |= kObjectLive;
    object->live = true;
    s.rest(*object, slot);
    if (!object->published.empty()) ++s.publishedObjects;
    s.counts.add(*object);
    s.countLists();
    s.objects[slot] = std::move(object);
}

void CpuBackend::destroyObject(uint32_t slot) noexcept {
    State& s = *state_;
    if (slot >= s.objects.size() || !s.objects[slot]) return;
    const uint32_t first = s.objects[slot]->record.worldTileBase;
    const uint32_t count = s.objects[slot]->record.tileCount;
    const auto drop = [&](std::pmr::vector<uint32_t>& entries) {
        return uint32_t(
            std::erase_if(entries, [&](uint32_t tile) { return tile - first < count; }));
    };
    s.goneListed += drop(s.list);
    s.goneBurning += drop(s.burnList);
    s.goneHot += drop(s.hotList);
    std::erase_if(s.burnTiles, [&](const BurnTile& tile) { return tile.object == slot; });
    if (!s.objects[slot]->published.empty()) --s.publishedObjects;
    s.releaseTiles(first, count);
    s.counts.remove(*s.objects[slot]);
    s.objects[slot] = core::Owned<CpuObject>();
}

void CpuBackend::setObjectPose(uint32_t slot, const vec4 rows[3], const vec4& tint,
                               uint32_t flags) {
    BurnObject& record = state_->objects[slot]->record;
    record.worldRow0 = rows[0];
    record.worldRow1 = rows[1];
    record.worldRow2 = rows[2];
    record.tint = tint;
    record.flags = flags | kObjectLive;
}

void CpuBackend::setRoom(uint32_t slot, const Room& room) noexcept { state_->rooms[slot] = room; }

void CpuBackend::run(const FramePlan& plan) {
    State& s = *state_;
    // Everything that can fail comes first.
    if (s.waiting == s.readbacks.size()) {
        std::rotate(s.readbacks.begin(), s.readbacks.begin() + std::ptrdiff_t(s.head),
                    s.readbacks.end());
        s.head = 0;
        s.readbacks.emplace_back(s.memory);
    }
    ReadbackStore& store = s.readbacks[(s.head + s.waiting) % s.readbacks.size()];
    size_t words = 0, heatTexels = 0;
    for (uint32_t slot : plan.burnMaps) {
        if (slot >= s.objects.size() || !s.objects[slot]) continue;
        words += s.objects[slot]->state.size();
        heatTexels += s.objects[slot]->heat.size();
    }
    store.objects.resize(s.objects.size());
    store.answers.resize(plan.probes.size());
    store.mapTicks.resize(words);
    store.mapHeat.resize(heatTexels);
    store.maps.clear();
    store.maps.reserve(plan.burnMaps.size());
    s.reserveImages(store, plan.images);
    store.lights.clear();
    store.lights.reserve(s.maxLights);
    store.fields.resize(s.fields.size());
    store.rooms.reserve(kMaxRooms);

    for (const StepPlan& step : plan.steps) {
        if (step.remote) s.reserveRemote(*step.remote);
        if (step.shield) s.reserveShield(*step.shield);
    }

    s.showRestored();
    s.switches = plan.switches;
    s.runTiles = 0;
    s.milliseconds.fill(0);
    s.timed.fill(0);
    for (const StepPlan& step : plan.steps) {
        if (step.remote) s.placeRemote(*step.remote);
        if (step.shield) s.placeShield(*step.shield);
        s.capped = step.capped;
        const uint32_t most = step.rules.tilesMost;
        if (!step.materials.empty()) {
            Stopwatch watch(s, kTimerWake);
            s.wake(step);
        }
        if (!step.events.empty()) {
            Stopwatch watch(s, kTimerEvents);
            s.askThen(most, step.now, [&] { s.applyEvents(step); });
        }
        if (step.rooms) {
            Stopwatch watch(s, kTimerRooms);
            s.airRooms(step.now);
        }
        if (step.heat) s.goneHot = 0;
        if (step.heat && !s.hotList.empty()) {
            Stopwatch watch(s, kTimerHeat);
            if (s.capped) s.askHeat(step.now), s.grant(most, step.now);
            s.heatStep(step.now);
        }
        s.goneListed = 0;
        if (!s.list.empty() || (s.switches & kSwitchDense) != 0)
            for (uint32_t k = 0; k < 1u << step.substepShift; ++k) s.iterate(step, k);
        if (s.publishedObjects != 0) {
            Stopwatch watch(s, kTimerPublished);
            s.askThen(most, step.now, [&] { s.publishedStep(step.now); });
        }
        if (step.reduce) {
            Stopwatch watch(s, kTimerReduce);
            s.reduce(step.now + kStepTicks);
        }
        if (step.exchange) {
            Stopwatch watch(s, kTimerExchange);
            s.exchange(step.rules, step.now + kStepTicks);
        }
    }

    if (plan.fields && !plan.fields->runs.empty()) {
        Stopwatch watch(s, kTimerField);
        s.stepFields(*plan.fields);
    }
    s.countFields(store.fields);
    for (size_t i = 0; i < s.objects.size(); ++i)
        store.objects[i] = s.objects[i] ? s.objects[i]->counters : ObjectCounters{};
    for (size_t i = 0; i < plan.probes.size(); ++i) {
        const Probe& probe = plan.probes[i];
        const bool known = probe.object < s.objects.size() && s.objects[probe.object] &&
                           probe.texel < s.objects[probe.object]->state.size();
        ProbeAnswer& answer = store.answers[i];
        answer = {kInert, 0, 0, 0};
        if (!known) continue;
        const CpuObject& object = *s.objects[probe.object];
        answer.state = object.state[probe.texel];
        if (object.heat.empty()) continue;
        answer.heatX = object.heat[probe.texel].x;
        answer.heatY = object.heat[probe.texel].y;
        answer.heat = 1;
    }
    size_t at = 0, heatAt = 0;
    for (uint32_t slot : plan.burnMaps) {
        if (slot >= s.objects.size() || !s.objects[slot]) continue;
        const std::pmr::vector<uint32_t>& ticks = s.objects[slot]->state;
        std::copy(ticks.begin(), ticks.end(), store.mapTicks.begin() + std::ptrdiff_t(at));
        store.maps.push_back({slot, {store.mapTicks.data() + at, ticks.size()}, {}});
        at += ticks.size();
        const std::pmr::vector<uvec2>& heat = s.objects[slot]->heat;
        std::copy(heat.begin(), heat.end(), store.mapHeat.begin() + std::ptrdiff_t(heatAt));
        store.maps.back().heat = {store.mapHeat.data() + heatAt, heat.size()};
        heatAt += heat.size();
    }
    s.takeImages(store, plan.images);
    s.findLights(store.lights);
    store.readback = {};
    store.readback.frameIndex = plan.frameIndex;
    store.readback.endTick = plan.endTick;
    store.readback.objects = store.objects;
    store.readback.answers = store.answers;
    store.readback.burnMaps = store.maps;
    store.readback.images = store.images;
    store.readback.lights = store.lights;
    store.readback.fields = store.fields;
    store.rooms.assign(s.roomAir.begin(), s.airs ? s.roomAir.end() : s.roomAir.begin());
    store.readback.rooms = store.rooms;
    store.readback.frontTiles = uint32_t(s.list.size()) + s.goneListed;
    store.readback.runTiles = uint32_t(std::min<uint64_t>(s.runTiles, 0xFFFFFFFFu));
    store.readback.burningTiles = s.reducedBurning;
    store.readback.hotTiles = uint32_t(s.hotList.size()) + s.goneHot;
    store.readback.receivers = s.receivers;
    ++s.waiting;

    s.timesCount = 0;
    for (uint32_t t = 0; t < kTimerCount; ++t) {
        if (s.timed[t] == 0) continue;
        PassTime& time = s.times[s.timesCount++];
        std::snprintf(time.name, sizeof time.name, "%s", kTimerNames[t]);
        time.milliseconds = s.milliseconds[t];
        time.frameIndex = plan.frameIndex;
        time.count = s.timed[t];
    }
}

const Readback* CpuBackend::nextReadback() {
    State& s = *state_;
    if (s.waiting == 0) return nullptr;
    const Readback* readback = &s.readbacks[s.head].readback;
    s.head = (s.head + 1) % s.readbacks.size();
    --s.waiting;
    return readback;
}

std::span<const PassTime> CpuBackend::passTimes() {
    return {state_->times.data(), state_->timesCount};
}

namespace {

uint64_t stateBytes(const CpuObject& object) noexcept {
    return object.state.size() * sizeof(uint32_t) + object.slowness.size() * sizeof(uint16_t) +
           object.published.size() * sizeof(float) + object.heat.size() * sizeof(uvec2);
}
uint64_t stateCapacity(const CpuObject& object) noexcept {
    return object.state.capacity() * sizeof(uint32_t) +
           object.slowness.capacity() * sizeof(uint16_t) +
           object.published.capacity() * sizeof(float) + object.heat.capacity() * sizeof(uvec2);
}
uint64_t objectBytes(const CpuObject& object) noexcept {
    return sizeof(CpuObject) + object.sources.capacity() * sizeof(FireSource);
}

}  // namespace

void CpuCounts::add(const CpuObject& object) noexcept {
    this->stateBytes += cpu::stateBytes(object);
    this->stateCapacity += cpu::stateCapacity(object);
    objects += objectBytes(object);
}

void CpuCounts::remove(const CpuObject& object) noexcept {
    this->stateBytes -= cpu::stateBytes(object);
    this->stateCapacity -= cpu::stateCapacity(object);
    objects -= objectBytes(object);
}

void CpuBackend::State::countLists() noexcept {
    counts.exchange =
        neighbours.capacity() * sizeof(uint32_t) + links.capacity() * sizeof(ContactLink);
    uint64_t bytes = 0;
    for (const ReadbackStore& store : readbacks)
        bytes += store.objects.capacity() * sizeof(ObjectCounters) +
                 store.mapTicks.capacity() * sizeof(uint32_t) +
                 store.mapHeat.capacity() * sizeof(uvec2);
    counts.readbacks = bytes;
    counts.tiles = tiles.size();
    counts.tileCapacity = tiles.capacity();
}

void CpuBackend::memoryRows(std::pmr::vector<MemoryRow>& out) const {
    const CpuCounts& counts = state_->counts;
    out.push_back({"cpu texel states", counts.stateBytes, counts.stateCapacity});
    out.push_back({"cpu objects", counts.objects, counts.objects});
    out.push_back({"cpu neighbours and contacts", counts.exchange, counts.exchange});
    out.push_back({"cpu readbacks", counts.readbacks, counts.readbacks});
    const size_t perTile = sizeof(TileState) + 6 * sizeof(uint32_t) + sizeof(uvec4) +
                           sizeof(uint8_t) + sizeof(TileHeat) + sizeof(float) + sizeof(FrontTile) +
                           64 * sizeof(uint32_t) + sizeof(BurnTile);
    out.push_back({"cpu tiles and lists", counts.tiles * perTile, counts.tileCapacity * perTile});
}

std::span<const uint32_t> CpuBackend::state(uint32_t slot) const {
    return state_->objects[slot]->state;
}

std::span<const uvec2> CpuBackend::heat(uint32_t slot) const { return state_->objects[slot]->heat; }

void CpuBackend::setTileHeat(uint32_t slot, uint32_t tile, const TileHeat& heat) {
    const uint32_t worldTile = state_->objects[slot]->record.worldTileBase + tile;
    state_->tileHeat[worldTile] = heat;
    state_->hot(worldTile);
}

const ObjectCounters& CpuBackend::counters(uint32_t slot) const {
    return state_->objects[slot]->counters;
}

}  // namespace fw::gpu::cpu
