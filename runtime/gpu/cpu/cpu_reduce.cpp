// The burning tiles: counts per object, BurnTiles and the strongest lights. The counts are integers
// and equal a device's; places and powers are cosmetic.
#include "gpu/cpu/cpu_state.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace fw::gpu::cpu {
namespace {

constexpr float kClusterSize = 1.0f;    // m: tiles of one object within a cell make one light
constexpr uint32_t kLightSlots = 1024;  // open hash; a key without a free slot joins the last one

struct Cell {
    uint64_t key = 0;
    uint32_t id = 0;
    float power = 0, area = 0;  // W, m^2
    float seen = 0;             // W of its own tiles
    float position[3] = {};     // weighted by `seen`
};

uint64_t cellKey(const BurnTile& tile) {
    uint64_t key = tile.object;
    for (int i = 0; i < 3; ++i)
        key = key * 0x9E3779B97F4A7C15ull +
              uint64_t(int64_t(std::floor(tile.positionArea[i] / kClusterSize)) + (1 << 20));
    return key | 1;
}

}  // namespace

// Sums the burning texels of a tile: place, normal, age and power. `fire`: W that its thick fuel
// gives off; `nominal`: each burning texel gives off its material's power instead.
BurnTile CpuBackend::State::burnTileOf(uint32_t worldTile, uint32_t now, bool nominal,
                                       float fire) const noexcept {
    const CpuObject& object = ownerOf(worldTile);
    const mesh::BurnDomain& domain = *object.domain;
    const uint32_t local = object.localTileOf(worldTile);
    const mesh::TileTexels texels = domain.texelsOf(local);
    uint32_t count = 0, age = 0, position[3] = {};
    int normal[3] = {};
    const bool heats = !object.heat.empty();
    float power = heats ? fire : 0;
    const float strength = float(airStrength(object.counters.air)) / float(kAirFull);
    for (uint32_t lane = 0; lane < mesh::kTileLanes; ++lane) {
        const uint32_t texel = texels[lane];
        const uint32_t t = object.state[texel];
        if (!isSource(t)) continue;
        const mesh::TexelPosition& at = domain.texels[texel];
        const BurnMaterial& material = object.materials[at.materialFlags & 7];
        const uint32_t phase = heats ? object.heat[texel].y >> 30 : kPhaseFresh;
        const bool burns =
            heats ? t <= now && phase != kPhaseBurnt : flames(t, now, material.flameTicks);
        if (!burns) continue;
        ++count;
        age += std::min(now - t, 0xFFFFFFu) >> 2;
        position[0] += at.x;
        position[1] += at.y;
        position[2] += at.z;
        const ivec3 n = decodeNormal(domain.normals[texel]);
        for (int i = 0; i < 3; ++i) normal[i] += n[i];
        if (nominal || phase != kPhaseBurning || material.burnTicks == material.flameTicks)
            power += material.powerPerArea * object.record.tint.w * strength;
    }
    BurnTile tile{};
    tile.object = tiles[worldTile].object;
    tile.tile = local;
    tile.texels = count;
    if (count == 0) return tile;
    FW_ASSERT(count <= mesh::kTileLanes, "%u texels", count);
    const float inverse = 1.0f / float(count);
    const BurnObject& record = object.record;
    vec4 rest(0, 0, 0, 1);
    for (int i = 0; i < 3; ++i)
        rest[i] = record.originQuantum[i] + record.originQuantum.w * inverse * float(position[i]);
    const vec4 direction = {float(normal[0]), float(normal[1]), float(normal[2]), 0.0f};
    const vec3 world(glm::dot(record.worldRow0, direction), glm::dot(record.worldRow1, direction),
                     glm::dot(record.worldRow2, direction));
    const float size = glm::length(world);
    tile.positionArea = {glm::dot(record.worldRow0, rest), glm::dot(record.worldRow1, rest),
                         glm::dot(record.worldRow2, rest), float(count) * record.tint.w};
    tile.normalPower = vec4(size > 0 ? world / size : vec3(0), power);
    tile.age = (age / count) << 2;
    return tile;
}

void CpuBackend::State::reduce(uint32_t now) noexcept {
    for (core::Owned<CpuObject>& object : objects) {
        if (!object) continue;
        object->counters.burning = object->counters.burningTiles = object->counters.frontTiles = 0;
    }
    for (uint32_t worldTile : list) ++ownerOf(worldTile).counters.frontTiles;

    burnTiles.clear();
    goneBurning = 0;
    size_t kept = 0;
    for (uint32_t worldTile : burnList) {
        const BurnTile tile = burnTileOf(worldTile, now, false, tileFire[worldTile]);
        if (tile.texels == 0) {
            tiles[worldTile].flag &= ~kTileBurning;
            continue;
        }
        burnList[kept++] = worldTile;
        FW_ASSERT(burnTiles.size() < burnTiles.capacity(), "%zu burning tiles", burnTiles.size());
        CpuObject& object = at(tile.object);
        object.counters.burning += tile.texels;
        ++object.counters.burningTiles;
        FW_ASSERT(tile.texels <= object.counters.ignited, "%u of %u burn", tile.texels,
                  object.counters.ignited);
        burnTiles.push_back(tile);
    }
    burnList.resize(kept);
    reducedBurning = uint32_t(kept);
}

void CpuBackend::State::findLights(std::pmr::vector<BurnLight>& out) noexcept {
    if (maxLights == 0 || burnTiles.empty()) return;
    std::array<Cell, kLightSlots> cells{};
    for (const BurnTile& tile : burnTiles) {
        const uint64_t key = cellKey(tile);
        uint32_t at = uint32_t(key >> 32) % kLightSlots;
        for (uint32_t tries = 0; cells[at].key != 0 && cells[at].key != key && tries < 32; ++tries)
            at = (at + 1) % kLightSlots;
        Cell& cell = cells[at];
        if (cell.key == 0) {
            cell.key = key;
            cell.id = uint32_t(key ^ key >> 32) | 1u;
        }
        const float power = std::max(tile.normalPower.w, 1e-6f);
        cell.power += power;
        cell.seen += power;
        cell.area += tile.positionArea.w;
        for (int i = 0; i < 3; ++i) cell.position[i] += power * tile.positionArea[i];
    }
    const auto end =
        std::partition(cells.begin(), cells.end(), [](const Cell& cell) { return cell.key != 0; });
    const size_t count = std::min<size_t>(size_t(end - cells.begin()), maxLights);
    std::partial_sort(cells.begin(), cells.begin() + std::ptrdiff_t(count), end,
                      [](const Cell& a, const Cell& b) {
                          return a.power != b.power ? a.power > b.power : a.key < b.key;
                      });
    // The nearest chosen light takes the power of the others: no watt is lost.
    for (auto cell = cells.begin() + std::ptrdiff_t(count); cell != end; ++cell) {
        size_t nearest = 0;
        float least = 0;
        for (size_t i = 0; i < count; ++i) {
            float distance = 0;
            for (int k = 0; k < 3; ++k) {
                const float d =
                    cells[i].position[k] / cells[i].seen - cell->position[k] / cell->seen;
                distance += d * d;
            }
            if (i > 0 && distance >= least) continue;
            nearest = i;
            least = distance;
        }
        cells[nearest].power += cell->power;
    }
    for (size_t i = 0; i < count; ++i) {
        const Cell& cell = cells[i];
        BurnLight light{};
        // As lights.comp, without its flicker and its old embers: 30 % of the power leaves as
        // light and heat; colour of a sooty flame, luminance 1.
        light.positionRadius = {cell.position[0] / cell.seen, cell.position[1] / cell.seen,
                                cell.position[2] / cell.seen, std::sqrt(cell.area / 3.14159265f)};
        light.colorIntensity = {1.717f, 0.858f, 0.292f, cell.power * 0.3f / 12.566f};
        light.power = light.release = cell.power;
        light.id = cell.id;
        FW_ASSERT(out.size() < out.capacity(), "%zu lights", out.size());
        out.push_back(light);
    }
}

}  // namespace fw::gpu::cpu
