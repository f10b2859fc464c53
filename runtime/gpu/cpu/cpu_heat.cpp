// Temperature, fuel and water on the CPU, as heat.comp and the heat part of events.comp. The maths
// is shared/heat.h; the lists of tiles are kept here.
#include "gpu/cpu/cpu_state.h"

#include <algorithm>

namespace fw::gpu::cpu {

void createHeat(CpuObject& object) {
    const mesh::BurnDomain& domain = *object.domain;
    FW_ASSERT(
        object.heat.size() == domain.texelCount() && object.state.size() == object.heat.size(),
        "%zu and %zu of %u texels", object.heat.size(), object.state.size(), domain.texelCount());
    for (uint32_t i = 0; i < domain.texelCount(); ++i) {
        const HeatMaterial& m = object.heatMaterialOf(i);
        const HeatTexel x = unheatedTexel(m, object.state[i] != kInert);
        object.heat[i] = packHeat(x);
        object.state[i] = wetState(object.state[i], isBarrierByWater(x, m));
    }
}

uint32_t CpuBackend::State::heatTurnOf(uint32_t worldTile, uint32_t now) const noexcept {
    const TileState& tile = tiles[worldTile];
    const uint32_t local = at(tile.object).localTileOf(worldTile);
    return workDue((tile.flag & kTileWarm) != 0, tile.object, local, tileHeat[worldTile].flux, now);
}

uint32_t CpuBackend::State::heatTexel(const CpuObject& object, uint32_t texel, uint32_t work,
                                      const TileHeat& comes, uint32_t now, HeatTexel& x,
                                      uint32_t& units) const noexcept {
    const uint32_t kind = object.domain->texels[texel].materialFlags & 7;
    const HeatMaterial& m = object.heatMaterialOf(texel);
    const uint32_t before = object.state[texel], chance = heatChance(texel, hash32(now));
    if (work == kWorkColdWater) return dryColdWater(x, m, before, chance);
    const HeatMaterial waited = heatMaterialOver(m, work == kWorkWarm, comes.flux);
    return heatTexelStep(x, materialInAir(waited, airStrength(object.counters.air)), before, now,
                         comes.flux, comes.pilot != 0, object.materials[kind].air, chance, units);
}

void CpuBackend::State::heatTile(uint32_t worldTile, uint32_t turn, uint32_t now) noexcept {
    TileState& tile = tiles[worldTile];
    CpuObject& object = at(tile.object);
    const mesh::BurnDomain& domain = *object.domain;
    const uint32_t local = object.localTileOf(worldTile);
    FW_ASSERT(object.heat.size() == object.state.size(), "object %u has no heat", tile.object);
    const mesh::TileTexels texels = domain.texelsOf(local);
    const TileHeat comes = tileHeat[worldTile];
    const bool held = !mayBurn(worldTile);
    if (isRequestPass && !held) return;
    const uint32_t ambient = object.heatMaterials[0].ambient;
    uint64_t energy = 0, changed = 0;
    uint32_t lit = 0, gone = 0, left = workOfFlux(comes.flux);
    float watts = 0;
    for (uint32_t lane = 0; lane < mesh::kTileLanes; ++lane) {
        const uint32_t texel = texels[lane];
        const uint32_t kind = domain.texels[texel].materialFlags;
        if ((kind & kTexelReal) == 0) continue;
        const uint32_t before = object.state[texel];
        HeatTexel x = unpackHeat(object.heat[texel]);
        const uint32_t work = workThisStep(workOfTexel(x, before, comes.flux, ambient), turn);
        if ((work & turn) == 0) {
            left |= work;
            continue;
        }
        uint32_t units = 0;
        const uint32_t after = heatTexel(object, texel, work, comes, now, x, units);
        if (held && isSource(after) && !isSource(before)) {  // unchanged, and due again
            left |= kWorkAlways;
            if (isRequestPass) requestToBurn(worldTile);
            continue;
        }
        if (isRequestPass) continue;
        energy += uint64_t(units) * object.heatMaterials[kind & 7].energy;
        watts += float(units) * object.heatMaterials[kind & 7].watts;
        object.heat[texel] = packHeat(x);
        left |= workOfTexel(x, after, comes.flux, ambient);
        if (after == before) continue;
        object.state[texel] = after;
        changed |= 1ull << lane;
        lit += isSource(after) && !isSource(before) ? 1 : 0;
        gone += isSource(before) && !isSource(after) ? 1 : 0;
    }
    if (isRequestPass) return;
    if (left != 0) {
        const bool warm = (left & kWorkAlways) != 0;
        tile.flag = warm ? tile.flag | kTileWarm : tile.flag & ~kTileWarm;
        FW_ASSERT((tile.flag & kTileHot) != 0, "tile %u is not hot", worldTile);
        append(hotOut, worldTile);
    } else {
        tile.flag &= ~(kTileHot | kTileWarm);
    }
    tileFire[worldTile] = watts;
    addWide(object.counters.energyLow, object.counters.energyHigh, energy);
    if (changed == 0) return;
    FW_ASSERT(object.counters.ignited + lit >= gone, "%u ignited, %u more, %u gone",
              object.counters.ignited, lit, gone);
    object.counters.ignited += lit - gone;
    if (lit != 0) {
        object.counters.lastIgnition = std::max(object.counters.lastIgnition, now + kStepTicks);
        disturb(object, now + kStepTicks);
        burning(worldTile);
    }
    tile.lastChange = now;
    touchDependents(object, local, changed);
}

// As rooms.comp: the air that fires used of their rooms, and how they burn in the rest.
void CpuBackend::State::airRooms(uint32_t now) noexcept {
    airs = true;
    std::array<uint32_t, kMaxRooms> ofRoom{};  // J since the last step
    const auto roomOf = [](const core::Owned<CpuObject>& object) {
        return object ? object->record.flags >> kObjectRoomShift & 0xFF : 0u;  // plus 1
    };
    for (core::Owned<CpuObject>& object : objects) {
        const uint32_t room = roomOf(object);
        if (room == 0) continue;
        ObjectCounters& c = object->counters;
        FW_ASSERT(room <= kMaxRooms, "room %u", room - 1);
        if ((c.air & kAirKnown) == 0) {  // new in the room: its earlier energy does not count
            c.drawnLow = c.energyLow;
            c.drawnHigh = c.energyHigh;
        }
        ofRoom[room - 1] += takeWholeJoules(c.energyLow, c.energyHigh, c.drawnLow, c.drawnHigh);
    }
    for (uint32_t i = 0; i < kMaxRooms; ++i) stepRoomAir(roomAir[i], rooms[i], ofRoom[i], now);
    for (core::Owned<CpuObject>& object : objects) {
        if (!object) continue;
        const uint32_t room = roomOf(object);
        object->counters.air =
            room != 0 ? burnStrengthOfOxygen(roomAir[room - 1].oxygen) | kAirKnown : 0;
    }
}

void CpuBackend::State::heatStep(uint32_t now) noexcept {
    if ((switches & kSwitchShuffle) != 0) shuffle(hotList);
    hotOut.clear();
    for (uint32_t worldTile : hotList) {
        const uint32_t turn = heatTurnOf(worldTile, now);
        if (turn == 0)
            append(hotOut, worldTile);  // sleeps on
        else
            heatTile(worldTile, turn, now);
    }
    if (!isRequestPass) hotList.swap(hotOut);
}

}  // namespace fw::gpu::cpu
