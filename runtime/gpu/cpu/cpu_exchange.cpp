// Heat and fire between objects, every fourth step after `reduce`: the passes of shaders/exchange,
// on vectors.
#include "core/error.h"
#include "core/growth.h"
#include "core/hash.h"
#include "gpu/cpu/cpu_state.h"
#include "gpu/extension.h"
#include "mesh/exchange_tiles.h"
#include "mesh/part_links.h"

#include <algorithm>
#include <array>
#include <bit>

namespace fw::gpu::cpu {
namespace {

ivec3 upOf(const ExchangePush& rules) noexcept { return {rules.upX, rules.upY, rules.upZ}; }

uint32_t powerOf(const ExchangeObject& object, uint32_t material) noexcept {
    return (material < 4 ? object.power0 : object.power1)[int(material & 3)];
}

}  // namespace

void CpuBackend::State::reserveExchange(const ExchangeUpdate& update) {
    core::growTo(neighbours, update.neighbours.size());
    core::growTo(links, update.links.size());
    occluders.reserve(update.occluders.size());
}

namespace {

template <class T>
void copyRanges(std::span<const T> from, std::span<const ExchangeUpdate::Range> ranges,
                std::pmr::vector<T>& to) noexcept {
    FW_ASSERT(from.size() <= to.capacity(), "%zu of %zu entries", from.size(), to.capacity());
    const size_t known = std::min(to.size(), from.size());
    to.resize(known);
    to.insert(to.end(), from.begin() + std::ptrdiff_t(known), from.end());
    for (const ExchangeUpdate::Range& range : ranges)
        if (range.first < known)
            std::copy_n(from.begin() + range.first,
                        std::min<size_t>(range.count, known - range.first),
                        to.begin() + range.first);
}

}  // namespace

void CpuBackend::State::placeExchangeObject(const ExchangeUpdate& update) noexcept {
    FW_ASSERT(update.occluders.size() <= occluders.capacity(), "%zu of %zu occluders",
              update.occluders.size(), occluders.capacity());
    for (const ExchangeUpdate::Placed& placed : update.objects)
        if (CpuObject* object = find(placed.object)) object->remote = placed.record;
    copyRanges(update.neighbours, update.neighbourRanges, neighbours);
    copyRanges(update.links, update.linkRanges, links);
    occluders.assign(update.occluders.begin(), update.occluders.end());
}

void CpuBackend::State::reserveOcclusion(const OcclusionUpdate& update) {
    occlusionCells.reserve(update.words.size());
}

void CpuBackend::State::setOcclusionPush(const OcclusionUpdate& update) noexcept {
    FW_ASSERT(update.words.size() <= occlusionCells.capacity(), "%zu of %zu words",
              update.words.size(), occlusionCells.capacity());
    occlusionCells.assign(update.words.begin(), update.words.end());
    shield = update;
    shield.words = occlusionCells;
}

// As shaders/lib/occlusion.glsl.
bool CpuBackend::State::isOccluderStanding(uint32_t what, uint32_t texel,
                                           uint32_t now) const noexcept {
    if ((what & kOcclusionPermanent) != 0) return true;
    const CpuObject* found = find(what & kOcclusionSlotMask);
    if (!found) return true;
    const CpuObject& object = *found;
    FW_ASSERT(texel < object.state.size(), "%u of %zu texels", texel, object.state.size());
    const uint32_t holes = object.materials[what >> 24 & 7].holeTicks, t = object.state[texel];
    if (!isSource(t) || t > now || now - t < holes) return true;
    return !object.heat.empty() &&
           !gateOpens(kEventGate, holes, unpackHeat(object.heat[texel]), t, now);
}

bool CpuBackend::State::isOccluded(const OcclusionEnds& ends, const ivec3& a, const ivec3& b,
                                   const ExchangePush& rules) const noexcept {
    const uint32_t words = occlusionWords(rules.occlusionCounts), side = rules.occlusionCell;
    for (OcclusionWalk w = beginOcclusionWalk(rules, a, b); w.within; stepOcclusionWalk(w, side)) {
        const uint32_t at = w.cell >> 5, bit = 1u << (w.cell & 31);
        FW_ASSERT(words + 2 * at + 1 < occlusionCells.size(), "word %u of %zu", at,
                  occlusionCells.size());
        if ((occlusionCells[at] & bit) == 0) continue;
        const uint32_t baked = occlusionCells[words + 2 * at];
        if ((baked & bit) == 0) {
            if (!isNearWalkEnd(w, ends, kNoneTexel, side)) return true;
            continue;
        }
        const uint32_t before = uint32_t(std::popcount(baked & (bit - 1)));
        const uint32_t i = 3 * words + 2 * (occlusionCells[words + 2 * at + 1] + before);
        FW_ASSERT(i + 1 < occlusionCells.size(), "word %u of %zu", i, occlusionCells.size());
        const uint32_t what = occlusionCells[i];
        if (!isNearWalkEnd(w, ends, what & kOcclusionSlotMask, side) &&
            isOccluderStanding(what, occlusionCells[i + 1], rules.now))
            return true;
    }
    return false;
}

void CpuBackend::State::litFrom(CpuObject& object, uint32_t by) noexcept {
    if (object.counters.litTick == 0) object.counters.litBy = std::max(object.counters.litBy, by);
}

void CpuBackend::State::disturb(CpuObject& object, uint32_t end) noexcept {
    object.counters.playsUntil = std::min(object.counters.playsUntil, end);
}

void CpuBackend::State::exchange(const ExchangePush& given, uint32_t now) noexcept {
    ExchangePush rules = given;
    rules.now = now;
    gpu::setOcclusionPush(shield, rules);
    sumSources();
    settleSources(rules);
    if (rules.warms != 0) warmAll(rules);
    if ((rules.flags & kExchangeEmbers) != 0) emberPaths(rules);
    requestThenBurn(rules.maxTiles, rules.now, [&] {
        if ((rules.flags & kExchangeContact) != 0) {
            contacts(rules);
            parts(rules);
        }
        if ((rules.flags & kExchangeEmbers) != 0) embers(rules);
    });
}

void CpuBackend::State::sumSources() noexcept {
    for (core::Owned<CpuObject>& object : objects)
        if (object && object->gives) {
            std::fill(object->sources.begin(), object->sources.end(), FireSource{});
            object->gives = false;
        }
    for (const BurnTile& burning : burnTiles) {
        CpuObject& object = at(burning.object);
        if (!object.exchanges()) continue;
        const ExchangeTile& tile = remoteTileOf(object, burning.tile);
        FW_ASSERT(tileCell(tile) < object.sources.size(), "source %u of %zu", tileCell(tile),
                  object.sources.size());
        FireSource& source = object.sources[tileCell(tile)];
        object.gives = true;
        const ivec3 middle = tileMiddle(tile);
        source.power += burning.texels * powerOf(object.remote, tileMaterial(tile));
        source.texels += burning.texels;
        source.tiles += 1;
        source.sumX += uint32_t(middle.x) >> 2;
        source.sumY += uint32_t(middle.y) >> 2;
        source.sumZ += uint32_t(middle.z) >> 2;
    }
}

void CpuBackend::State::settleSources(const ExchangePush& rules) noexcept {
    const auto burningTiles = uint32_t(burnTiles.size());
    for (uint32_t slot = 0; slot < objects.size(); ++slot) {
        if (!exchanging(slot)) continue;
        CpuObject& object = at(slot);
        ObjectCounters& c = object.counters;
        recordFire(c, object.remote, rules);
        c.held = heldBits(burningTiles, rules.maxTiles, c.burningTiles, object.remote.maxTiles,
                          c.stopTick, rules.now);
        if (c.burning == 0) continue;
        const uint32_t hops = hopsOf(c.litBy);
        const bool gives = mayTransfer(object.remote, hops, rules.hopsMost);
        if (gives && (rules.flags & (kExchangeRadiation | kExchangePlume)) != 0)
            for (uint32_t n = 0; n < object.remote.neighbourCount; ++n) {
                CpuObject* other = find(neighbourOf(object, n) & 0xFFFFFFu);
                if (!other) continue;
                other->counters.until =
                    std::max(other->counters.until, rules.now + kExchangeRounds * kExchangeTicks);
            }
        for (uint32_t cell = 0; cell < object.sources.size(); ++cell) {
            FireSource& source = object.sources[cell];
            if (!gives) {
                source.watts = 0;
                continue;
            }
            source.power = mulShift(source.power, airStrength(c.air), 8);
            settleSource(source, object.remote);
            source.object = slot;
            source.hops = hops;
            source.ember = 0;
            if ((rules.flags & kExchangeEmbers) != 0 && source.watts != 0)
                source.ember =
                    emberOf(rules.seed, slot, cell, rules.now, source.power, rules.brands);
        }
    }
}

bool CpuBackend::State::light(uint32_t slot, uint32_t texel, uint32_t tick, uint32_t by,
                              uint32_t now) noexcept {
    CpuObject& object = at(slot);
    if (texel >= object.state.size()) return false;
    const uint32_t before = object.state[texel];
    if (before != tick && !isReceptive(before)) return false;
    const uint32_t worldTile = object.worldTileOf(texel);
    if (!mayCatch(object.counters.held, tiles[worldTile].flag)) return false;
    if (isRequestPass && !mayBurn(worldTile)) requestToBurn(worldTile);
    if (isRequestPass || !mayBurn(worldTile)) return false;
    litFrom(object, by);
    if (before == tick) return true;  // two flames lit it
    setState(object, worldTile, texel, tick, now);
    if (!object.heat.empty()) hot(worldTile);
    disturb(object, now);
    if (!object.extended.empty()) {
        extension()->cpu->event(object, texel, true);
        return true;
    }
    changedTexel(object, texel, now);
    return true;
}

void CpuBackend::State::warmAll(const ExchangePush& rules) noexcept {
    receivers = 0;
    const uint32_t turn = rules.now / kExchangeTicks % kExchangeRounds;
    for (uint32_t slot = 0; slot < objects.size(); ++slot) {
        if (!exchanging(slot)) continue;
        CpuObject& object = at(slot);
        if (object.counters.until < rules.now || object.heat.empty()) continue;
        ++receivers;
        object.counters.held |= kHeldWarm;
        gatherSources(slot, rules);
        for (uint32_t local = turn; local < object.record.tileCount; local += kExchangeRounds)
            warmTile(slot, local, rules);
    }
}

void CpuBackend::State::gatherSources(uint32_t slot, const ExchangePush& rules) noexcept {
    const CpuObject& object = at(slot);
    const ivec3 middle = boxMiddle(object.remote);
    // Counts the sources of weight [low, high) by its highest bit, or lists them.
    std::array<uint32_t, 32> bits{};
    const auto pass = [&](uint32_t low, uint32_t high, bool takes) {
        uint32_t count = 0;
        for (uint32_t n = 0; n < object.remote.neighbourCount; ++n) {
            const uint32_t entry = neighbourOf(object, n);
            const uint32_t slotOf = entry & 0xFFFFFFu;
            if (entry >> 24 == 0 || !exchanging(slotOf)) continue;
            const CpuObject& from = at(slotOf);
            if (from.counters.burning == 0 ||
                !mayTransfer(from.remote, hopsOf(from.counters.litBy), rules.hopsMost) ||
                !mayReach(rules.seed, slotOf, slot, from.counters.litTick,
                          multiplyChances(rules.chance, from.remote.chance)))
                continue;
            for (const FireSource& source : from.sources) {
                const uint32_t weight = sourceWeight(source, middle);
                if (weight < low || weight >= high) continue;
                if (!takes) ++bits[highestBit(weight)];
                if (takes && warmCount < kSourcesPerReceiver)
                    warms[warmCount++] = {&source, entry >> 24};
                ++count;
            }
        }
        return count;
    };
    // The least power of two with at most kSourcesPerReceiver weights at or above it.
    uint32_t least = 0;
    for (uint32_t count = pass(1, kNoneTexel, false); count > kSourcesPerReceiver; ++least)
        count -= bits[least];
    FW_ASSERT(least < 32, "2^%u", least);
    const uint32_t low = 1u << least;
    warmCount = 0;
    pass(low, kNoneTexel, true);
    if (low > 1) pass(low / 2, low, true);
}

void CpuBackend::State::warmTile(uint32_t slot, uint32_t local,
                                 const ExchangePush& rules) noexcept {
    CpuObject& object = at(slot);
    const ExchangeTile& tile = remoteTileOf(object, local);
    if (tile.texels == 0) return;
    const uint32_t worldTile = object.record.worldTileBase + local;
    const ivec3 up = upOf(rules);
    const ivec3 at = toWorldMm(object.remote, tileMiddle(tile));
    const ivec3 normal = turnToWorld(object.remote, decodeNormal(tile.normal));
    const bool both = (object.remote.flags & kExchangeTwoSided) != 0;
    const bool may = mayCatch(object.counters.held, tiles[worldTile].flag);
    uint32_t flux = 0, pilot = 0, strongest = 0, by = 0;
    for (uint32_t i = 0; may && i < warmCount; ++i) {
        const FireSource& source = *warms[i].source;
        const Received got =
            receivedFrom(source, rules.flags, rules.ambient, up, at, normal, both, warms[i].seen);
        if ((got.flux | got.pilot) == 0) continue;
        const ivec3 flame = alongFlame(source, up, 4);
        if (std::any_of(occluders.begin(), occluders.end(),
                        [&](const HeatOccluder& b) { return occluderBlocks(b, flame, at); }))
            continue;
        if (rules.occlusionCell != 0 &&
            isOccluded(flameOcclusionEnds(source, flame, slot, at, normal, rules.occlusionCell),
                       flame, at, rules))
            continue;
        flux = std::min(flux + got.flux, kMaxFlux);
        pilot |= got.pilot;
        const uint32_t key = litBy(source.hops, source.object);
        if (got.flux > strongest || (got.flux == strongest && key > by)) {
            strongest = got.flux;
            by = key;
        }
    }
    if (workOfFlux(flux) == kWorkAlways) disturb(object, rules.now);
    if (flux != 0) litFrom(object, by);
    TileHeat& comes = tileHeat[worldTile];
    if (comes.flux == flux && comes.pilot == pilot) return;
    comes = {flux, pilot};
    heatComes(worldTile, flux);
}

void CpuBackend::State::contacts(const ExchangePush& rules) noexcept {
    for (size_t i = 0; i < links.size();) {
        const uint32_t slot = links[i].object, texel = links[i].texel;
        if (slot == kNoneTexel) {  // between two objects' links
            ++i;
            continue;
        }
        uint32_t best = kNever, by = 0;
        for (; i < links.size() && links[i].object == slot && links[i].texel == texel; ++i) {
            const ContactLink& link = links[i];
            if (!exchanging(link.fromObject)) continue;
            const CpuObject& from = at(link.fromObject);
            const uint32_t hops = hopsOf(from.counters.litBy);
            if (from.counters.burning == 0 || !mayTransfer(from.remote, hops, rules.hopsMost))
                continue;
            FW_ASSERT(link.fromTexel < from.state.size(), "%u of %zu texels", link.fromTexel,
                      from.state.size());
            const uint32_t material =
                from.domain->texels[link.fromTexel].materialFlags & (kMaterialsPerObject - 1);
            const uint32_t tick =
                contactTick(from.state[link.fromTexel], from.materials[material].flameTicks,
                            link.delay, link.since, rules.now);
            if (tick == kNever ||
                !mayReach(rules.seed, link.fromObject, slot, from.counters.litTick,
                          multiplyChances(rules.chance, from.remote.chance)))
                continue;
            const uint32_t key = litBy(hops, link.fromObject);
            if (tick < best || (tick == best && key > by)) by = key;
            best = std::min(best, tick);
        }
        if (best == kNever || !exchanging(slot)) continue;
        light(slot, texel, best, by, rules.now);
    }
}

void CpuBackend::State::parts(const ExchangePush& rules) noexcept {
    for (const BurnTile& burning : burnTiles) {
        const CpuObject& object = at(burning.object);
        if (!object.exchanges() || object.domain->partLinks.empty()) continue;
        const uvec4 words = remoteTileOf(object, burning.tile).parts;
        for (uint32_t block = 0; block < 4; ++block) {
            const uint32_t word = words[int(block)];
            if (word == kNoneTexel) continue;
            const mesh::PartLink link =
                mesh::readPartLink(*object.domain, burning.tile, block, word);
            const mesh::PartPath way = mesh::partPath(*object.domain, object.materials, link);
            if (partCrossed(object.state[link.from], way.left->flameTicks, way.delay, rules.now))
                light(burning.object, link.to, rules.now, 0, rules.now);
        }
    }
}

// The object below a place with the highest top, and its tile there.
CpuBackend::State::Landing CpuBackend::State::landsOn(const ivec3& place,
                                                      uint32_t axis) const noexcept {
    Landing landing;
    int top = kNoTop;
    for (uint32_t slot = 0; slot < objects.size(); ++slot) {
        const CpuObject* object = exchanging(slot);
        if (!object) continue;
        const int here = topBelow(object->remote, place, axis);
        if (here > top) {
            top = here;
            landing.object = slot;
        }
    }
    if (landing.object == kNoneTexel) return landing;
    const CpuObject& object = at(landing.object);
    const std::pmr::vector<ExchangeTile>& its = exchangeTiles[object.mesh];
    uint32_t least = kMisses;
    for (uint32_t i = 0; i < its.size(); ++i) {
        const uint32_t miss = landingMiss(object.remote, its[i], place, top, axis);
        if (miss < least) {
            least = miss;
            landing.tile = i;
        }
    }
    return landing;
}

// Calls each(source, ember, landing). A landing without a tile is on no object.
template <class Each>
void CpuBackend::State::eachEmber(const ExchangePush& rules, Each&& each) noexcept {
    const ivec3 up = upOf(rules), wind(rules.windX, rules.windY, rules.windZ);
    const auto slots = uint32_t(objects.size());
    const bool shuffles = (switches & kSwitchShuffle) != 0 && slots != 0;
    const uint32_t first = shuffles ? core::hash32(random++) % slots : 0;
    for (uint32_t i = 0; i < slots; ++i) {
        const uint32_t slot = i < slots - first ? first + i : first + i - slots;
        if (!exchanging(slot)) continue;
        CpuObject& from = at(slot);
        if (from.counters.burning == 0) continue;
        const ivec3 blows = wind + unpackWind(uint32_t(from.remote.high.w));
        for (FireSource& source : from.sources) {
            if (source.watts == 0 || source.ember == 0) continue;
            const Ember ember = flyingEmber(source, source.ember, up, blows);
            each(source, ember, landsOn(ember.landing, upAxis(up)));
        }
    }
}

// Removes embers whose path an occluder or the shield crosses.
void CpuBackend::State::emberPaths(const ExchangePush& rules) noexcept {
    const auto stopped = [&](const FireSource& source, const Ember& ember, const Landing& to) {
        if (to.tile == kNoneTexel) return true;
        const CpuObject& object = at(to.object);
        const ivec3 flame = alongFlame(source, upOf(rules), 8);
        const ivec3 place = toWorldMm(object.remote, tileMiddle(remoteTileOf(object, to.tile)));
        for (const HeatOccluder& occluder : occluders)
            if (occluderBlocks(occluder, flame, ember.landing) ||
                occluderBlocks(occluder, ember.landing, place))
                return true;
        if (rules.occlusionCell == 0) return false;
        const OcclusionEnds ends = emberOcclusionEnds(source, to.object, rules.occlusionCell);
        return isOccluded(ends, flame, ember.landing, rules) ||
               isOccluded(ends, ember.landing, place, rules);
    };
    eachEmber(rules, [&](FireSource& source, const Ember& ember, const Landing& to) {
        if (stopped(source, ember, to)) source.ember = 0;
    });
}

void CpuBackend::State::embers(const ExchangePush& rules) noexcept {
    eachEmber(rules, [&](const FireSource& source, const Ember& ember, const Landing& to) {
        if (to.tile != kNoneTexel) landEmber(source, ember, to, upAxis(upOf(rules)), rules);
    });
}

void CpuBackend::State::landEmber(const FireSource& source, const Ember& ember, const Landing& to,
                                  uint32_t axis, const ExchangePush& rules) noexcept {
    const uint32_t target = to.object, tile = to.tile;
    CpuObject& object = at(target);
    const uint32_t chance =
        multiplyChances(emberLights(ember.energy, object.remote.catches),
                        multiplyChances(rules.chance, at(source.object).remote.chance));
    if (!drawn(hash32(source.ember + 7u), chance)) return;
    const uint32_t lane = nearestLane(object, tile, ember.landing, axis);
    if (lane == kNoneTexel) return;
    const mesh::TileTexels texels = object.domain->texelsOf(tile);
    uint32_t lit = 0;
    for (uint32_t other = 0; other < mesh::kTileLanes; ++other) {
        if (!besideLane(lane, other)) continue;
        const uint32_t texel = texels[other];
        if (light(target, texel, rules.now, litBy(source.hops, source.object), rules.now)) {
            lit = 1;
            object.counters.spotTexel = std::max(object.counters.spotTexel, kSpotFresh | texel);
        }
    }
    object.counters.spots += lit;
}

uint32_t CpuBackend::State::nearestLane(const CpuObject& object, uint32_t tile, const ivec3& at,
                                        uint32_t axis) noexcept {
    const mesh::BurnDomain& domain = *object.domain;
    const mesh::TileTexels texels = domain.texelsOf(tile);
    uint32_t nearest = kNoneTexel, found = kNoneTexel;
    for (uint32_t lane = 0; lane < mesh::kTileLanes; ++lane) {
        const uint32_t texel = texels[lane];
        if (object.state[texel] == kInert) continue;
        const uint32_t beside = besidePlace(object.remote, domain.texels[texel].units(), at, axis);
        if (beside < nearest) {
            nearest = beside;
            found = lane;
        }
    }
    return found;
}

}  // namespace fw::gpu::cpu
