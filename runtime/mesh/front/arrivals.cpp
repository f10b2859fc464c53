// See arrivals.h. Rounds of time, longer than the simulation's steps: within a round tiles run
// until none was touched, each on the ticks that earlier ones have just written.
#include "mesh/front/arrivals.h"

#include "mesh/part_links.h"
#include "shared/exchange.h"

#include <algorithm>
#include <bit>

namespace fw::mesh {
namespace {

using gpu::kNever;

constexpr uint8_t kListed = 1, kTouched = 2;

void touch(Arrivals& a, uint32_t tile, uint8_t bits) noexcept {
    FW_ASSERT(tile < a.flags.size(), "%u of %zu tiles", tile, a.flags.size());
    FW_ASSERT((a.flags[tile] & kListed) || a.list.size() < a.list.capacity(), "%zu tiles listed",
              a.list.size());
    if (!(a.flags[tile] & kListed)) a.list.push_back(tile);
    a.flags[tile] |= uint8_t(kListed | bits);
}

// Ticks of a round: the time over two links in still air. Shorter rounds run each tile more often;
// longer ones compute more ticks that later ones correct.
uint32_t strideOf(const Arrivals& a) noexcept {
    double slowness = 1e9;  // Q22 ticks per 1/8 position unit
    for (const gpu::BurnMaterial& material : a.materials)
        if (material.flags & 1) slowness = std::min(slowness, double(material.sigma0));
    const double link = double(a.domain->texelSide / a.domain->quantum) * 8 * slowness / 4194304;
    return uint32_t(std::clamp(2 * link, double(gpu::kStepTicks), 1e7));
}

// Lists the round's tiles: touched ones, and those whose next arrival falls into the round.
void findDue(Arrivals& a) noexcept {
    a.due.clear();
    a.next = 0;
    size_t kept = 0;
    for (const uint32_t tile : a.list) {
        const bool runs = (a.flags[tile] & kTouched) || a.wake[tile] <= a.end;
        if (runs) {
            FW_ASSERT(a.due.size() < a.due.capacity(), "%zu tiles due", a.due.size());
            a.due.push_back(tile);
            a.wake[tile] = kNever;
        }
        if (runs || a.wake[tile] == kNever)
            a.flags[tile] = 0;
        else
            a.list[kept++] = tile;
    }
    a.list.resize(kept);
}

// Skips times in which nothing happens.
void nextRound(Arrivals& a) noexcept {
    uint32_t soonest = kNever;
    for (const uint32_t tile : a.list) soonest = std::min(soonest, a.wake[tile]);
    FW_ASSERT(a.stride > 0 && a.stride < gpu::kLiveEnd, "stride %u", a.stride);
    // The forecast ends with the range of ticks.
    a.whole = std::max(soonest, a.end) >= gpu::kLiveEnd - a.stride;
    if (!a.whole) a.end = std::max(a.end + a.stride, soonest);
}

// Touches a tile and the dependents of its changed texels.
void touchDependents(Arrivals& a, uint32_t tile, uint64_t changed) noexcept {
    const auto touched = [&](uint32_t dependent) { touch(a, dependent, kTouched); };
    touched(tile);
    forEachTileBeside(*a.domain, tile, changed, touched);
    for (const uint32_t other : seamDependents(*a.domain, tile, changed)) touched(other);
}

// Lights the texels that the fire of these lanes' texels reaches over gaps.
void crossGaps(Arrivals& a, uint32_t tile, uint64_t lanes) noexcept {
    const BurnDomain& d = *a.domain;
    for (uint32_t block = 0; block < 4; ++block) {
        const uint32_t word = d.partLinks[size_t(tile) * 4 + block];
        if (word == kNone) continue;
        const PartLink link = readPartLink(d, tile, block, word);
        FW_ASSERT(link.to < a.ticks.size(), "texel %u of %zu", link.to, a.ticks.size());
        const uint32_t t = a.ticks[link.from], to = link.to;
        if ((lanes >> link.lane & 1) == 0 || !gpu::isSource(t)) continue;
        const PartPath path = partPath(d, a.materials, link);
        if (path.delay >= gpu::kLiveEnd - t) continue;
        const uint32_t arrives = std::max(gpu::partArrives(t, path.delay), a.now);
        const uint32_t was = a.ticks[to];
        if (!gpu::flames(t, arrives, path.left->flameTicks) ||
            !(gpu::isReceptive(was) || (gpu::isSource(was) && was > a.now && was > arrives)))
            continue;
        a.ticks[to] = arrives;
        const uint32_t other = d.tileOf(to);
        const uint64_t changed = uint64_t(1) << d.laneOf(to);
        touchDependents(a, other, changed);
        crossGaps(a, other, changed);
    }
}

void runTile(Arrivals& a, uint32_t tile) noexcept {
    const FrontArrays arrays(*a.domain, a.ticks.data(), a.slowness, a.materials.data());
    FW_ASSERT(a.end >= a.stride, "round %u to %u", a.end, a.stride);
    uint32_t scratch[kTileLanes];
    const uint32_t floorTick = gpu::windowFloor(a.end - a.stride, a.window);
    const FrontTile result = runFrontTile(arrays, tile, a.end, floorTick, scratch);
    a.wake[tile] = result.wake;
    if (result.changed == 0) {
        if (result.wake != kNever) touch(a, tile, 0);
        return;
    }
    const TileTexels texels = a.domain->texelsOf(tile);
    for (uint64_t rest = result.changed; rest != 0; rest &= rest - 1) {
        const auto lane = uint32_t(std::countr_zero(rest));
        a.ticks[texels[lane]] = scratch[lane];
    }
    touchDependents(a, tile, result.changed);
    if (a.parts) crossGaps(a, tile, result.changed);
}

}  // namespace

uint32_t Arrivals::settled() const noexcept {
    if (whole) return gpu::kLiveEnd;
    // Some tiles of an unfinished round have not run.
    const uint32_t through = end - stride;
    return gpu::windowFloor(through, window);
}

void reserveArrivals(Arrivals& a, const BurnDomain& domain) {
    a.ticks.reserve(domain.texelCount());
    a.wake.reserve(domain.tileCount());
    a.flags.reserve(domain.tileCount());
    a.list.reserve(domain.tileCount());
    a.due.reserve(domain.tileCount());
}

void beginArrivals(Arrivals& a, const ArrivalInput& input) {
    const uint32_t tiles = input.domain->tileCount();
    FW_ASSERT(input.state.size() == input.domain->texelCount(), "%zu of %u texels",
              input.state.size(), input.domain->texelCount());
    FW_ASSERT(input.materials.size() >= a.materials.size(), "%zu materials",
              input.materials.size());
    reserveArrivals(a, *input.domain);
    a.ticks.assign(input.state.begin(), input.state.end());
    a.wake.assign(tiles, kNever);
    a.flags.assign(tiles, 0);
    a.list.clear();
    a.due.clear();
    a.next = 0;
    a.domain = input.domain;
    a.slowness = input.slowness;
    std::copy_n(input.materials.begin(), a.materials.size(), a.materials.begin());
    a.window = input.window;
    a.parts = input.parts && !a.domain->partLinks.empty();
    a.stride = strideOf(a);
    a.now = input.now;
    a.end = input.now + a.stride;
    a.whole = false;
    for (uint32_t tile = 0; tile < tiles; ++tile) touch(a, tile, kTouched);
    for (uint32_t tile = 0; tile < tiles && a.parts; ++tile) crossGaps(a, tile, ~0ull);
    findDue(a);
}

uint32_t runArrivals(Arrivals& a, uint32_t tiles) noexcept {
    FW_ASSERT(a.whole || a.domain, "the forecast has not begun");
    while (tiles > 0 && !a.whole) {
        if (a.next == a.due.size()) {
            findDue(a);
            if (a.due.empty()) {
                nextRound(a);
                continue;
            }
        }
        for (; a.next < a.due.size() && tiles > 0; --tiles) runTile(a, a.due[a.next++]);
    }
    return tiles;
}

}  // namespace fw::mesh
