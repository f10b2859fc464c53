// Heat and fire between objects, every fourth step after `reduce`. The bodies of the passes are
// those of the shaders: shared/exchange_pass.h.
#include "core/growth.h"
#include "core/hash.h"
#include "gpu/cpu/cpu_state.h"
#include "gpu/extension.h"
#include "mesh/exchange_tiles.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace fw::gpu::cpu {
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
        if (CpuObject* object = find(placed.object)) object->exchangeObject = placed.record;
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
    occlusion = update;
    occlusion.words = occlusionCells;
}

void CpuBackend::State::litFrom(CpuObject& object, uint32_t by) noexcept {
    if (object.counters.litTick == 0) object.counters.litBy = std::max(object.counters.litBy, by);
}

void CpuBackend::State::disturb(CpuObject& object, uint32_t end) noexcept {
    object.counters.playsUntil = std::min(object.counters.playsUntil, end);
}

namespace {

const ExchangeObject kNoExchange{};

// The bodies of the passes, on the backend's state.
struct ExchangePass : PassBody {
    ExchangePush push;

    struct ExchangeObjects {
        const CpuBackend::State& backend;
        const ExchangeObject& operator[](uint32_t slot) const noexcept {
            const CpuObject* object = backend.find(slot);
            return object ? object->exchangeObject : kNoExchange;
        }
    } exchangeObjects{backend};
    struct Objects {
        const CpuBackend::State& backend;
        const BurnObject& operator[](uint32_t slot) const noexcept {
            return backend.at(slot).record;
        }
    } objects{backend};
    std::pmr::vector<BurnTile>& burnTiles = backend.burnTiles;
    std::pmr::vector<TileState>& tileState = backend.tiles;
    std::pmr::vector<TileHeat>& tileHeat = backend.tileHeat;
    std::pmr::vector<uint32_t>& neighbours = backend.neighbours;
    std::pmr::vector<ContactLink>& contacts = backend.links;
    std::pmr::vector<HeatOccluder>& occluders = backend.occluders;
    std::pmr::vector<uint32_t>& occlusion = backend.occlusionCells;

    [[nodiscard]] ivec3 positionOf(uint32_t slot, uint32_t texel) const noexcept {
        const CpuObject& object = backend.at(slot);
        FW_ASSERT(texel < object.state.size(), "texel %u of %zu", texel, object.state.size());
        return object.domain->texels[texel].units();
    }
    [[nodiscard]] const BurnMaterial& materialOf(uint32_t slot, uint32_t texel) const noexcept {
        const CpuObject& object = backend.at(slot);
        FW_ASSERT(texel < object.state.size(), "texel %u of %zu", texel, object.state.size());
        return object
            .materials[object.domain->texels[texel].materialFlags & (kMaterialsPerObject - 1)];
    }
    [[nodiscard]] uint32_t holeTicksOf(uint32_t slot, uint32_t kind) const noexcept {
        const CpuObject* object = backend.find(slot);
        return object ? object->materials[kind].holeTicks : kNoneTexel;
    }
    [[nodiscard]] uint32_t texelOf(uint32_t slot, uint32_t tile, uint32_t lane) const noexcept {
        return backend.at(slot).domain->texelsOf(tile)[lane];
    }
    [[nodiscard]] const ExchangeTile& exchangeTileOf(uint32_t slot, uint32_t tile) const noexcept {
        return backend.exchangeTileOf(backend.at(slot), tile);
    }
    [[nodiscard]] uint32_t neighbourOf(uint32_t slot, uint32_t n) const noexcept {
        FW_ASSERT(exchangeObjects[slot].neighbourFirst + n < neighbours.size(), "neighbour %u", n);
        return neighbours[exchangeObjects[slot].neighbourFirst + n];
    }
    [[nodiscard]] uint32_t sourceCountOf(uint32_t slot) const noexcept {
        return uint32_t(backend.at(slot).sources.size());
    }
    FireSource& sourceOf(uint32_t slot, uint32_t cell) noexcept {
        std::pmr::vector<FireSource>& sources = backend.at(slot).sources;
        FW_ASSERT(cell < sources.size(), "source %u of %zu", cell, sources.size());
        return sources[cell];
    }
    static uint32_t firstSourceOf(uint32_t) noexcept { return 0; }
    FireSource& sourceAt(uint32_t slot, uint32_t cell) noexcept { return sourceOf(slot, cell); }
    [[nodiscard]] uint32_t burningTilesOfWorld() const noexcept {
        return uint32_t(burnTiles.size());
    }
    [[nodiscard]] uint32_t receiverCountOf(uint32_t) const noexcept { return backend.warmCount; }
    [[nodiscard]] uint32_t receiverEntryOf(uint32_t, uint32_t i) const noexcept {
        FW_ASSERT(i < backend.warmCount, "source %u of %u", i, backend.warmCount);
        return backend.warms[i].seen << 24;
    }
    [[nodiscard]] const FireSource& receiverSourceOf(uint32_t, uint32_t i) const noexcept {
        FW_ASSERT(i < backend.warmCount, "source %u of %u", i, backend.warmCount);
        return *backend.warms[i].source;
    }
    void hotList(uint32_t, uint32_t worldTile, uint32_t bits) noexcept {
        backend.enlist(backend.hotList, worldTile, kTileHot, bits);
    }
    void listSource(uint32_t, uint32_t place, uint32_t from, uint32_t cell,
                    uint32_t entry) noexcept {
        if (place < kSourcesPerReceiver)
            backend.warms[place] = {&sourceOf(from, cell), entry >> 24};
    }
    void texelChanged(uint32_t slot, uint32_t texel, TexelPlace, bool burns) noexcept {
        backend.changedTexel(backend.at(slot), texel, burns, push.now);
    }
    static int bitCount(uint32_t bits) noexcept { return std::popcount(bits); }

#define FW_PASS_FIRE_CELLS
#define FW_PASS_FIRE_SOURCES
#define FW_PASS_OCCLUSION
#define FW_PASS_EXCHANGE
#define FW_PASS_GIVES
#define FW_PASS_RECEIVERS
#define FW_PASS_LIGHT
#define FW_PASS_CONTACTS
#define FW_PASS_PARTS
#define FW_PASS_EMBERS
#define FW_PASS_EMBER_PATHS
#define FW_PASS_EMBER_LANDINGS
#include "shared/exchange_pass.h"
};

}  // namespace

// Calls each(source) for the sources that send an ember.
template <class Each>
void CpuBackend::State::eachEmber(Each&& each) noexcept {
    const auto slots = uint32_t(objects.size());
    const bool shuffles = (switches & kSwitchShuffle) != 0 && slots != 0;
    const uint32_t first = shuffles ? core::hash32(random++) % slots : 0;
    for (uint32_t i = 0; i < slots; ++i) {
        CpuObject* from = exchanging(i < slots - first ? first + i : first + i - slots);
        if (!from || from->counters.burning == 0) continue;
        for (FireSource& source : from->sources)
            if (source.watts != 0 && source.ember != 0) each(source);
    }
}

void CpuBackend::State::exchange(const ExchangePush& given, uint32_t now) noexcept {
    ExchangePass pass{{*this}, given};
    pass.push.now = now;
    pass.push.count = uint32_t(objects.size());
    pass.push.occluders = uint32_t(occluders.size());
    gpu::setOcclusionPush(occlusion, pass.push);
    const ExchangePush& rules = pass.push;
    for (core::Owned<CpuObject>& object : objects)
        if (object && std::exchange(object->gives, false))
            std::fill(object->sources.begin(), object->sources.end(), FireSource{});
    for (uint32_t i = 0; i < burnTiles.size(); ++i) {
        pass.sumTile(i);
        at(burnTiles[i].object).gives = true;
    }
    for (uint32_t slot = 0; slot < objects.size(); ++slot) pass.settleObject(slot);
    if (rules.warms != 0) {
        receivers = 0;
        const uint32_t turn = now / kExchangeTicks % kExchangeRounds;
        for (uint32_t slot = 0; slot < objects.size(); ++slot) {
            CpuObject* object = exchanging(slot);
            if (!object || object->counters.until < now || object->heat.empty()) continue;
            ++receivers;
            object->counters.held |= kHeldWarm;
            warmCount = pass.gatherSources(slot);
            for (uint32_t local = turn; local < object->record.tileCount; local += kExchangeRounds)
                pass.warmTile(slot, local);
        }
    }
    if ((rules.flags & kExchangeEmbers) != 0)
        eachEmber([&](FireSource& source) {
            if (pass.isEmberStopped(source)) source.ember = 0;
        });
    requestThenBurn(rules.maxTiles, now, [&] {
        if ((rules.flags & kExchangeContact) != 0) {
            pass.push.count = uint32_t(links.size());
            for (uint32_t i = 0; i < links.size(); ++i) pass.lightContact(i);
            for (uint32_t i = 0; i < burnTiles.size(); ++i) pass.lightParts(i);
            pass.push.count = uint32_t(objects.size());
        }
        if ((rules.flags & kExchangeEmbers) != 0)
            eachEmber([&](const FireSource& source) { pass.landEmber(source); });
    });
}

}  // namespace fw::gpu::cpu
