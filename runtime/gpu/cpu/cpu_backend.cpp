// The passes of a simulation step in order, on vectors instead of buffers. Each function is the
// shader of the same name in shaders/burn.
#include "gpu/cpu/cpu_backend.h"

#include "core/error.h"
#include "core/growth.h"
#include "core/hash.h"
#include "flamewright/flamewright_debug.h"
#include "gpu/cpu/cpu_state.h"
#include "gpu/extension.h"
#include "mesh/exchange_tiles.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <numeric>

namespace fw::gpu::cpu {

static_assert(kSwitchDense == FW_DEBUG_DENSE && kSwitchShuffle == FW_DEBUG_SHUFFLE &&
              kSwitchNoSeamWake == FW_DEBUG_NO_SEAM_WAKE &&
              kSwitchWrongDependents == FW_DEBUG_WRONG_DEPENDENTS &&
              kSwitchNoWindWake == FW_DEBUG_NO_WIND_WAKE);

namespace {

class Stopwatch {
 public:
    Stopwatch(CpuBackend::State& state, const char* pass) noexcept
        : state_(state), pass_(pass), start_(std::chrono::steady_clock::now()) {}
    ~Stopwatch() {
        const std::chrono::duration<double, std::milli> took =
            std::chrono::steady_clock::now() - start_;
        state_.addTime(pass_, took.count());
    }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

 private:
    CpuBackend::State& state_;
    const char* pass_;
    std::chrono::steady_clock::time_point start_;
};

}  // namespace

void CpuBackend::State::requestToBurn(uint32_t worldTile) noexcept {
    FW_ASSERT(worldTile < requested.size(), "world tile %u of %zu", worldTile, requested.size());
    if (requested[worldTile] != 0) return;
    FW_ASSERT(requests.size() < requests.capacity(), "%zu tiles request", requests.size());
    requested[worldTile] = 1;
    requests.push_back({0, 0, 0, worldTile});
}

void CpuBackend::State::allocateBurnBudget(uint32_t maxTiles, uint32_t now) noexcept {
    Stopwatch watch(*this, "burn_budget");
    for (uvec4& request : requests) {
        requested[request.w] = 0;
        request.y = tiles[request.w].object;
        request.z = at(request.y).localTileOf(request.w);
        request.x = requestOrder(request.y, request.z, now);
    }
    std::sort(requests.begin(), requests.end(), requestPrecedes);
    for (const uvec4& request : requests) {
        const CpuObject& object = at(request.y);
        const bool limited = object.exchanges();
        // A tile that the host lit meanwhile needs no allocation, and counts.
        if ((tiles[request.w].flag & kTileBurning) == 0 &&
            remainingTiles(uint32_t(burnList.size()) + goneBurning, maxTiles) != 0 &&
            (!limited ||
             remainingTiles(object.counters.burningTiles, object.exchangeObject.maxTiles) != 0))
            burning(request.w);
    }
    requests.clear();
}

void CpuBackend::State::touchDependents(const CpuObject& object, uint32_t local,
                                        uint64_t mask) noexcept {
    const uint32_t base = object.record.worldTileBase;
    const mesh::BurnDomain& domain = *object.domain;
    touch(base + local, kTileTouched);
    mesh::forEachTileBeside(domain, local, mask,
                            [&](uint32_t tile) { touch(base + tile, kTileTouched); });
    if ((switches & kSwitchNoSeamWake) != 0) return;
    for (const uint32_t reader : mesh::seamDependents(domain, local, mask))
        touch(base + ((switches & kSwitchWrongDependents) != 0 ? 0 : reader), kTileTouched);
}

bool CpuBackend::State::setState(CpuObject& object, uint32_t worldTile, uint32_t texel,
                                 uint32_t after, uint32_t end) noexcept {
    FW_ASSERT(texel < object.state.size(), "%u of %zu texels", texel, object.state.size());
    const bool was = isSource(std::exchange(object.state[texel], after)), is = isSource(after);
    FW_ASSERT(!was || is || object.counters.ignited > 0, "no texel of the object burns");
    if (is != was) object.counters.ignited += is ? 1u : ~0u;
    if (is) {
        object.counters.lastIgnition = std::max(object.counters.lastIgnition, end);
        burning(worldTile);
    }
    return is && !was;
}

void CpuBackend::State::changedTexel(CpuObject& object, uint32_t texel, bool burns,
                                     uint32_t now) noexcept {
    if (!object.extended.empty()) {
        extension()->cpu->event(object, texel, burns);
        return;
    }
    const uint32_t worldTile = object.worldTileOf(texel);
    tiles[worldTile].lastChange = now;
    touchDependents(object, object.localTileOf(worldTile), 1ull << object.domain->laneOf(texel));
}

// The bodies of the events pass, on the backend's state.
struct EventPass : PassBody {
    struct Events {
        std::span<const TexelEvent> of;
        const TexelEvent& operator[](uint32_t i) const noexcept {
            FW_ASSERT(i < of.size(), "event %u of %zu", i, of.size());
            return of[i];
        }
    } events;
    struct {
        uint32_t now, count, hotParity;
    } push;

    [[nodiscard]] const HeatMaterial& heatMaterialOf(uint32_t slot, uint32_t texel) const noexcept {
        return backend.at(slot).heatMaterialOf(texel);
    }
    void addEnergy(uint32_t slot, uint32_t low, uint32_t high) noexcept {
        ObjectCounters& counters = objectCounters[slot];
        addWide(counters.energyLow, counters.energyHigh, uint64_t(high) << 32 | low);
    }
    void writeState(uint32_t slot, uint32_t texel, uint32_t worldTile, uint32_t,
                    uint32_t after) noexcept {
        FW_ASSERT(!isSource(after) || after <= push.now + kStepTicks, "%u at %u", after, push.now);
        backend.setState(backend.at(slot), worldTile, texel, after, push.now + kStepTicks);
    }
    void texelChanged(uint32_t slot, uint32_t texel, TexelPlace, bool burns) noexcept {
        backend.changedTexel(backend.at(slot), texel, burns, push.now);
    }
#define FW_PASS_EVENTS
#include "shared/event_pass.h"
};

void CpuBackend::State::applyEvents(const StepPlan& step) noexcept {
    EventPass pass{{*this}, {step.events}, {step.now, uint32_t(step.events.size()), 0}};
    for (uint32_t i = 0; i < pass.push.count; ++i) {
        if (!pass.addressesAll(i))
            pass.applyOne(i);
        else if (i == 0 || !pass.addressesAll(i - 1) ||
                 step.events[i - 1].object != step.events[i].object)
            applyToAll(pass, i);
    }
}

// As for its texels one by one. Events of the host are not limited.
void CpuBackend::State::applyToAll(EventPass& pass, uint32_t first) noexcept {
    CpuObject& object = at(pass.events[first].object);
    const uint32_t stepNow = pass.push.now;
    const mesh::BurnDomain& domain = *object.domain;
    const bool heats = !object.heat.empty();
    // Texels at rest are alike: the next one becomes what the last one became.
    uint32_t knownBefore = 0, knownAfter = 0, knownMaterial = kNoneTexel;
    uvec2 knownHad(0), knownHeat(0);
    for (uint32_t local = 0; local < object.record.tileCount; ++local) {
        const uint32_t worldTile = object.record.worldTileBase + local;
        const mesh::TileTexels texels = domain.texelsOf(local);
        uint64_t changed = 0;
        bool heated = false, burns = false;
        for (uint32_t lane = 0; lane < mesh::kTileLanes; ++lane) {
            const uint32_t texel = texels[lane];
            const uint32_t flags = domain.texels[texel].materialFlags;
            if ((flags & kTexelReal) == 0) continue;
            const uint32_t before = object.state[texel];
            const uvec2 had = heats ? object.heat[texel] : uvec2(0);
            if (before != knownBefore || had != knownHad || (flags & 7) != knownMaterial) {
                bool byFlame = false;
                knownAfter = pass.afterRun(first, texel, knownHeat, byFlame);
                knownBefore = before;
                knownHad = had;
                knownMaterial = flags & 7;
            }
            const uint32_t now = knownAfter;
            if (isRequestPass) {
                burns |= isSource(now) && !isSource(before);
                continue;
            }
            if (heats) {
                object.heat[texel] = knownHeat;
                heated |= now != before || knownHeat != had;
            }
            if (now == before) continue;
            changed |= 1ull << lane;
            if (setState(object, worldTile, texel, now, stepNow + kStepTicks))
                litFrom(object, kLitByHand);
            if (!object.extended.empty()) extension()->cpu->event(object, texel, isSource(now));
        }
        if (heated) hot(worldTile);
        if (burns) burning(worldTile);
        if (changed == 0) continue;
        if (!object.extended.empty()) continue;
        tiles[worldTile].lastChange = stepNow;
        touchDependents(object, local, changed);
    }
}

void CpuBackend::State::wake(const StepPlan& step) noexcept {
    for (const MaterialUpdate& update : step.materials) {
        CpuObject& object = at(update.object);
        std::copy_n(update.materials, kMaterialsPerObject, object.materials.begin());
        object.record.window = update.window;
        object.record.substepShift = update.substepShift;
        if ((switches & kSwitchNoWindWake) != 0 || !object.extended.empty()) continue;
        for (uint32_t local = 0; local < object.record.tileCount; ++local) {
            const uint32_t worldTile = object.record.worldTileBase + local;
            const bool listed = (tiles[worldTile].flag & kTileListed) != 0;
            if (latchReaches(listed, tiles[worldTile].lastChange, step.now, update.window))
                touch(worldTile, kTileTouched);
        }
    }
}

void CpuBackend::State::scheduleTile(const StepPlan& step, uint32_t iteration, uint32_t worldTile,
                                     bool dense) noexcept {
    const CpuObject& object = ownerOf(worldTile);
    TileState& tile = tiles[worldTile];
    FW_ASSERT(listOut.size() < listOut.capacity(), "%zu tiles wait", listOut.size());
    const BurnObject& record = object.record;
    const bool listed = (tile.flag & kTileListed) != 0;
    // A tile of a baked burn is due once the burn goes live.
    if (!runsInIteration(iteration, step.substepShift, record.substepShift) ||
        (step.plays && isPlayingBack(object.counters.playsUntil, step.now))) {
        if (listed) append(listOut, worldTile);
        return;
    }
    if (step.governed) {
        if (stoppedAt(object.counters.stopTick, step.now)) {
            tile.flag &= ~(kTileListed | kTileTouched);
            return;
        }
        if (holdsTile(tile.flag, scheduledBurning, step.rules.maxTiles,
                      object.counters.burningTiles, object.exchangeObject.flags,
                      object.exchangeObject.maxTiles)) {
            if (listed) append(listOut, worldTile);
            return;
        }
    }
    const uint32_t end = iterationEnd(step.now, iteration, step.substepShift, record.substepShift);
    if (dense || (tile.flag & kTileTouched) != 0 || tile.wake <= end) {
        append(runList, worldTile);
        tile.wake = kNever;
        tile.flag &= ~(kTileListed | kTileTouched);
    } else if (tile.wake != kNever) {
        append(listOut, worldTile);
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
            if (!object || !object->live || !object->extended.empty()) continue;
            for (uint32_t local = 0; local < object->record.tileCount; ++local)
                scheduleTile(step, iteration, object->record.worldTileBase + local, true);
        }
    } else {
        for (uint32_t worldTile : list) scheduleTile(step, iteration, worldTile, false);
    }
    list.swap(listOut);  // commits append to `list`
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
        Stopwatch watch(*this, "schedule");
        schedule(step, iteration);
    }
    if (runList.empty()) return;
    runTiles += runList.size();
    {
        Stopwatch watch(*this, "arrival");
        FW_ASSERT(runList.size() <= results.size() && runList.size() * 64 <= scratch.size(),
                  "%zu tiles run, %zu results", runList.size(), results.size());
        uint32_t known = kNoneTexel;  // object of `arrays`
        FrontArrays arrays;
        uint32_t end = 0, floorTick = 0, base = 0;
        for (size_t i = 0; i < runList.size(); ++i) {
            const uint32_t worldTile = runList[i];
            if (tiles[worldTile].object != known) {
                known = tiles[worldTile].object;
                const CpuObject& object = at(known);
                const uint32_t shift = object.record.substepShift;
                arrays = FrontArrays(*object.domain, object.state.data(), object.slowness,
                                     object.materials.data());
                end = iterationEnd(step.now, iteration, step.substepShift, shift);
                floorTick =
                    windowFloor(end - windowTicks(step.substepShift, shift), object.record.window);
                base = object.record.worldTileBase;
            }
            results[i] =
                mesh::runFrontTile(arrays, worldTile - base, end, floorTick, &scratch[i * 64]);
        }
    }
    if (capped) {
        for (size_t i = 0; i < runList.size(); ++i)
            if (results[i].lit != 0 && !mayBurn(runList[i])) requestToBurn(runList[i]);
        allocateBurnBudget(step.rules.maxTiles, step.now);
    }
    Stopwatch watch(*this, "commit");
    for (size_t i = 0; i < runList.size(); ++i) {
        const uint32_t worldTile = runList[i];
        const FrontTile& result = results[i];
        TileState& tile = tiles[worldTile];
        tile.wake = result.wake;
        if (result.lit != 0 && !mayBurn(worldTile)) {  // not allocated: unchanged, and due again
            touch(worldTile, kTileTouched);
            continue;
        }
        if (result.changed == 0) {
            if (result.wake != kNever) touch(worldTile, 0);
            continue;
        }
        CpuObject& object = at(tile.object);
        const uint32_t local = object.localTileOf(worldTile);
        const mesh::TileTexels texels = object.domain->texelsOf(local);
        for (uint64_t rest = result.changed; rest != 0; rest &= rest - 1) {
            const uint32_t lane = uint32_t(std::countr_zero(rest));
            object.state[texels[lane]] = scratch[i * 64 + lane];
        }
        FW_ASSERT((result.lit & ~result.changed) == 0, "tile %u", worldTile);
        const uint32_t end =
            iterationEnd(step.now, iteration, step.substepShift, object.record.substepShift);
        tile.lastChange = end;
        object.counters.lateClamps += result.late;
        if (result.lit != 0) {
            object.addIgnitions(uint32_t(std::popcount(result.lit)), end);
            burning(worldTile);
            if (!object.heat.empty()) hot(worldTile);
        }
        touchDependents(object, local, result.changed);
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
    // All or nothing: capacity first, then sizes. Capacity grows by half: exact growth would copy
    // the tiles of all earlier objects with every new one.
    const auto reserve = [](auto& entries, size_t needed) {
        if (entries.capacity() < needed)
            entries.reserve(std::max(needed, entries.capacity() + entries.capacity() / 2));
    };
    for (auto* entries : {&list, &listOut, &runList, &burnList, &hotList, &hotOut})
        reserve(*entries, total);
    reserve(requests, total);
    reserve(burnTiles, total);
    const auto each = [&](const auto& act) {
        act(requested, total), act(tileHeat, total), act(tileFire, total), act(results, total);
        act(scratch, total * 64), act(tiles, total);
    };
    each(reserve);
    each([](auto& entries, size_t needed) { entries.resize(needed); });
    return uint32_t(first);
}

void CpuBackend::State::releaseTiles(uint32_t first, uint32_t count) noexcept {
    const auto at = std::lower_bound(freeTiles.begin(), freeTiles.end(), first,
                                     [](const Range& r, uint32_t f) { return r.first < f; });
    FW_ASSERT(freeTiles.size() < freeTiles.capacity(), "%zu free ranges", freeTiles.size());
    FW_ASSERT(first + count <= tiles.size(), "tiles %u to %u of %zu", first, first + count,
              tiles.size());
    FW_ASSERT(at == freeTiles.end() || at->count == 0 || first + count <= at->first,
              "a tile is released twice");
    freeTiles.insert(at, {first, count});
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
    std::pmr::vector<ExchangeTile> tiles(state_->memory);
    (void)mesh::exchangeTiles(domain, tiles);
    if (slot >= state_->exchangeTiles.size()) state_->exchangeTiles.resize(slot + 1);
    if (slot >= state_->meshes.size()) state_->meshes.resize(slot + 1, nullptr);
    state_->meshes[slot] = &domain;
    state_->exchangeTiles[slot].swap(tiles);
}

void CpuBackend::destroyMesh(uint32_t slot) noexcept {
    if (slot < state_->meshes.size()) state_->meshes[slot] = nullptr;
}

void CpuBackend::createObject(uint32_t slot, const ObjectInit& init) {
    State& s = *state_;
    FW_ASSERT(!s.find(slot), "object %u exists", slot);
    FW_ASSERT(init.mesh < s.meshes.size() && s.meshes[init.mesh], "mesh %u of %zu", init.mesh,
              s.meshes.size());
    FW_ASSERT(init.materials.size() >= kMaterialsPerObject, "%zu materials", init.materials.size());
    auto object = core::Owned<CpuObject>::make(s.memory, s.memory);
    const mesh::BurnDomain& domain = *s.meshes[init.mesh];
    const uint32_t texels = domain.texelCount();
    FW_ASSERT(texels > 0 && texels % mesh::kTileLanes == 0, "%u texels", texels);
    object->mesh = init.mesh;
    object->domain = &domain;
    object->record = init.record;
    std::copy_n(init.materials.begin(), kMaterialsPerObject, object->materials.begin());
    object->slowness.assign(init.slowness.begin(), init.slowness.end());
    FW_ASSERT(init.slowness.empty() || init.slowness.size() == texels, "%zu of %u texels",
              init.slowness.size(), texels);
    object->state.resize(texels);
    if (!init.heat.empty()) {
        FW_ASSERT(init.heat.size() >= kMaterialsPerObject, "%zu materials", init.heat.size());
        std::copy_n(init.heat.begin(), kMaterialsPerObject, object->heatMaterials.begin());
        object->heat.resize(texels);
    }
    if ((init.record.flags & kObjectExtended) != 0) extension()->cpu->create(*object);
    object->sources.resize(mesh::sourceCells(s.exchangeTiles[init.mesh]));
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
    s.resetObject(*object, slot);
    if (!object->extended.empty()) ++s.extendedObjects;
    s.countObject(*object, true);
    s.countLists();
    s.objects[slot] = std::move(object);
}

void CpuBackend::destroyObject(uint32_t slot) noexcept {
    State& s = *state_;
    const CpuObject* object = s.find(slot);
    if (!object) return;
    const uint32_t first = object->record.worldTileBase, count = object->record.tileCount;
    const auto drop = [&](std::pmr::vector<uint32_t>& entries) {
        return uint32_t(
            std::erase_if(entries, [&](uint32_t tile) { return tile - first < count; }));
    };
    s.goneListed += drop(s.list);
    s.goneBurning += drop(s.burnList);
    s.goneHot += drop(s.hotList);
    std::erase_if(s.burnTiles, [&](const BurnTile& tile) { return tile.object == slot; });
    FW_ASSERT(object->extended.empty() || s.extendedObjects > 0);
    if (!object->extended.empty()) --s.extendedObjects;
    s.releaseTiles(first, count);
    s.countObject(*object, false);
    s.objects[slot] = core::Owned<CpuObject>();
}

void CpuBackend::setObjectPose(uint32_t slot, const vec4 rows[3], const vec4& tint,
                               uint32_t flags) {
    BurnObject& record = state_->at(slot).record;
    record.worldRow0 = rows[0];
    record.worldRow1 = rows[1];
    record.worldRow2 = rows[2];
    record.tint = tint;
    record.flags = flags | kObjectLive;
}

void CpuBackend::setRoom(uint32_t slot, const Room& room) noexcept {
    FW_ASSERT(slot < kMaxRooms, "room %u", slot);
    state_->rooms[slot] = room;
}

ReadbackStore& CpuBackend::State::reserveReadback(const FramePlan& plan) {
    if (waiting == readbacks.size()) {
        std::rotate(readbacks.begin(), readbacks.begin() + std::ptrdiff_t(head), readbacks.end());
        head = 0;
        readbacks.emplace_back(memory);
    }
    ReadbackStore& store = readbacks[(head + waiting) % readbacks.size()];
    store.objects.resize(objects.size());
    store.answers.resize(plan.probes.size());
    reserveImages(store.burnMaps, plan.burnMaps, false);
    reserveImages(store.images, plan.images, true);
    store.lights.clear();
    store.lights.reserve(maxLights);
    store.fields.resize(fields.size());
    store.rooms.reserve(kMaxRooms);
    return store;
}

void CpuBackend::State::runStep(const StepPlan& step) noexcept {
    FW_ASSERT(step.substepShift < 32, "substep shift %u", step.substepShift);
    FW_ASSERT(!step.exchange || step.reduce, "an exchange needs the counts of a reduction");
    FW_ASSERT(!isRequestPass && requests.empty(), "%zu tiles still request", requests.size());
    if (step.exchangeUpdate) placeExchangeObject(*step.exchangeUpdate);
    if (step.occlusionUpdate) setOcclusionPush(*step.occlusionUpdate);
    capped = step.capped;
    const uint32_t most = step.rules.maxTiles;
    if (!step.materials.empty()) {
        Stopwatch watch(*this, "wake");
        wake(step);
    }
    if (!step.events.empty()) {
        Stopwatch watch(*this, "events");
        requestThenBurn(most, step.now, [&] { applyEvents(step); });
    }
    if (step.rooms) {
        Stopwatch watch(*this, "rooms");
        airRooms(step.now);
    }
    if (step.heat) goneHot = 0;
    if (step.heat && !hotList.empty()) {
        Stopwatch watch(*this, "heat");
        requestThenBurn(most, step.now, [&] { heatStep(step.now); });
    }
    goneListed = 0;
    if (!list.empty() || (switches & kSwitchDense) != 0)
        for (uint32_t k = 0; k < 1u << step.substepShift; ++k) iterate(step, k);
    if (extendedObjects != 0) {
        Stopwatch watch(*this, "extension");
        requestThenBurn(most, step.now, [&] { extension()->cpu->step(*this, step.now); });
    }
    if (step.reduce) {
        Stopwatch watch(*this, "reduce");
        reduce(step.now + kStepTicks);
    }
    if (step.exchange) {
        Stopwatch watch(*this, "exchange");
        exchange(step.rules, step.now + kStepTicks);
    }
}

void CpuBackend::State::answerProbes(std::span<const Probe> probes,
                                     std::span<ProbeAnswer> answers) const noexcept {
    FW_ASSERT(probes.size() == answers.size(), "%zu probes, %zu answers", probes.size(),
              answers.size());
    for (size_t i = 0; i < probes.size(); ++i) {
        answers[i] = {kInert, 0, 0, 0};
        const CpuObject* object = find(probes[i].object);
        const uint32_t texel = probes[i].texel;
        if (!object || texel >= object->state.size()) continue;
        answers[i].state = object->state[texel];
        if (object->heat.empty()) continue;
        answers[i].heatX = object->heat[texel].x;
        answers[i].heatY = object->heat[texel].y;
        answers[i].heat = 1;
    }
}

void CpuBackend::State::finishReadback(const FramePlan& plan, ReadbackStore& store) noexcept {
    countFields(store.fields);
    for (size_t i = 0; i < objects.size(); ++i)
        store.objects[i] = objects[i] ? objects[i]->counters : ObjectCounters{};
    answerProbes(plan.probes, store.answers);
    collectImages(store.burnMaps, plan.burnMaps, false);
    collectImages(store.images, plan.images, true);
    findLights(store.lights);
    store.rooms.assign(roomAir.begin(), airs ? roomAir.end() : roomAir.begin());
    Readback& readback = store.readback;
    readback = {};
    readback.frameIndex = plan.frameIndex;
    readback.endTick = plan.endTick;
    readback.objects = store.objects;
    readback.answers = store.answers;
    readback.burnMaps = store.burnMaps.images;
    readback.images = store.images.images;
    readback.lights = store.lights;
    readback.fields = store.fields;
    readback.rooms = store.rooms;
    FW_ASSERT(store.lights.size() <= maxLights, "%zu lights", store.lights.size());
    readback.frontTiles = uint32_t(list.size()) + goneListed;
    readback.runTiles = uint32_t(std::min<uint64_t>(runTiles, 0xFFFFFFFFu));
    readback.burningTiles = reducedBurning;
    readback.hotTiles = uint32_t(hotList.size()) + goneHot;
    readback.receivers = receivers;
    ++waiting;
    FW_ASSERT(waiting <= readbacks.size(), "%zu of %zu readbacks wait", waiting, readbacks.size());
}

void CpuBackend::State::addTime(const char* pass, double milliseconds) noexcept {
    uint32_t at = 0;
    while (at < timesCount && std::strcmp(times[at].name, pass) != 0) ++at;
    FW_ASSERT(at < times.size(), "%s is timed beside %u passes", pass, timesCount);
    if (at == timesCount) {
        times[timesCount++] = {};
        std::snprintf(times[at].name, sizeof times[at].name, "%s", pass);
    }
    times[at].milliseconds += milliseconds;
    ++times[at].count;
}

void CpuBackend::run(const FramePlan& plan) {
    State& s = *state_;
    // Everything that can fail comes first.
    ReadbackStore& store = s.reserveReadback(plan);
    for (const StepPlan& step : plan.steps) {
        if (step.exchangeUpdate) s.reserveExchange(*step.exchangeUpdate);
        if (step.occlusionUpdate) s.reserveOcclusion(*step.occlusionUpdate);
    }

    s.showRestored();
    s.switches = plan.switches;
    s.runTiles = 0;
    s.timesCount = 0;
    for (const StepPlan& step : plan.steps) s.runStep(step);
    if (plan.fields && !plan.fields->runs.empty()) {
        Stopwatch watch(s, "field");
        s.stepFields(*plan.fields);
    }
    s.finishReadback(plan, store);
    for (PassTime& time : s.times) time.frameIndex = plan.frameIndex;
}

const Readback* CpuBackend::nextReadback() {
    State& s = *state_;
    if (s.waiting == 0) return nullptr;
    FW_ASSERT(s.head < s.readbacks.size(), "%zu of %zu readbacks", s.head, s.readbacks.size());
    const Readback* readback = &s.readbacks[s.head].readback;
    s.head = (s.head + 1) % s.readbacks.size();
    --s.waiting;
    return readback;
}

std::span<const PassTime> CpuBackend::passTimes() {
    return {state_->times.data(), state_->timesCount};
}

void CpuBackend::State::countObject(const CpuObject& object, bool comes) noexcept {
    const auto bytesOf = [](const auto&... of) { return ((of.capacity() * sizeof of[0]) + ...); };
    const uint64_t texels = bytesOf(object.state, object.slowness, object.extended, object.heat);
    const uint64_t rest = sizeof object + bytesOf(object.sources);
    counts.texels += comes ? texels : 0 - texels;
    counts.objects += comes ? rest : 0 - rest;
}

void CpuBackend::State::countLists() noexcept {
    counts.exchange =
        neighbours.capacity() * sizeof(uint32_t) + links.capacity() * sizeof(ContactLink);
    uint64_t bytes = 0;
    for (const ReadbackStore& store : readbacks)
        bytes += store.objects.capacity() * sizeof(ObjectCounters) +
                 store.burnMaps.ticks.capacity() * sizeof(uint32_t) +
                 store.burnMaps.heat.capacity() * sizeof(uvec2);
    counts.readbacks = bytes;
    counts.tiles = tiles.size();
    counts.tileCapacity = tiles.capacity();
}

void CpuBackend::memoryRows(std::pmr::vector<MemoryRow>& out) const {
    const CpuCounts& counts = state_->counts;
    out.push_back({"cpu texel states", counts.texels, counts.texels});
    out.push_back({"cpu objects", counts.objects, counts.objects});
    out.push_back({"cpu neighbours and contacts", counts.exchange, counts.exchange});
    out.push_back({"cpu readbacks", counts.readbacks, counts.readbacks});
    const size_t perTile = sizeof(TileState) + 6 * sizeof(uint32_t) + sizeof(uvec4) +
                           sizeof(uint8_t) + sizeof(TileHeat) + sizeof(float) + sizeof(FrontTile) +
                           64 * sizeof(uint32_t) + sizeof(BurnTile);
    out.push_back({"cpu tiles and lists", counts.tiles * perTile, counts.tileCapacity * perTile});
}

std::span<const uint32_t> CpuBackend::state(uint32_t slot) const { return state_->at(slot).state; }

std::span<const uvec2> CpuBackend::heat(uint32_t slot) const { return state_->at(slot).heat; }

void CpuBackend::setTileHeat(uint32_t slot, uint32_t tile, const TileHeat& heat) {
    const uint32_t worldTile = state_->at(slot).record.worldTileBase + tile;
    FW_ASSERT(tile < state_->at(slot).record.tileCount, "tile %u", tile);
    state_->tileHeat[worldTile] = heat;
    state_->hot(worldTile);
}

const ObjectCounters& CpuBackend::counters(uint32_t slot) const {
    return state_->at(slot).counters;
}

}  // namespace fw::gpu::cpu
