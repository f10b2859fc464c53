// Volumetric flames of the frame's view before it is drawn: each ray once for a cell of a few
// pixels, kept in slabs, of the tiles that volume_probe finds worth it. Memory is bounded: what
// does not fit is marched in larger cells.
#include "gpu/passes/frame_graph.h"

#include <algorithm>
#include <cmath>

namespace fw::gpu {
namespace {

constexpr Use kUses[] = {
    {FW_BIND_VIEW, Access::uniformView},
    {FW_BIND_VOLUMES, Access::each},
    {FW_BIND_VOLUME_WORK, Access::indirect},
    {FW_BIND_VOLUME_RAYS, Access::write},
};

constexpr float kMostCell = 64.0f;          // px
constexpr uint64_t kMostWords = 16u << 20;  // 64 MiB

static_assert(kVolumeSlabs + 4 <= 32, "flags of a tile are a word");

uint32_t wordsOfTile(uint32_t slabs) {
    return kVolumeTileWords + kVolumeTile * kVolumeTile * kVolumeCellWords * slabs;
}

struct Tiles {
    uint32_t originX, originY, x, y;
};

// That cover a part of the view.
Tiles tilesOf(const vec4& rect, vec2 size, float cell) {
    const auto first = [&](float ndc, float pixels) {
        return uint32_t(std::max(std::floor((0.5f * ndc + 0.5f) * pixels / cell), 0.0f));
    };
    const auto tiles = [&](float ndc, float pixels, uint32_t from) {
        const float end = std::ceil((0.5f * ndc + 0.5f) * pixels / cell);
        return uint32_t(std::max(std::ceil((end - float(from)) / float(kVolumeTile)), 1.0f));
    };
    const uint32_t x = first(rect.x, size.x), y = first(rect.y, size.y);
    return {x, y, tiles(rect.z, size.x, x), tiles(rect.w, size.y, y)};
}

uint64_t tilesOfAll(std::span<const VolumeItem> items, vec2 size, float cell) {
    uint64_t sum = 0;
    for (const VolumeItem& item : items) {
        const Tiles tiles = tilesOf(item.draw.rect, size, cell);
        sum += uint64_t(tiles.x) * tiles.y;
    }
    return sum;
}

}  // namespace

const ComputePass kVolumeMarchPass{
    "volume march", "volume_march.comp", kUses, sizeof(VolumeMarch), nullptr, true};

uint32_t volumeRayWords(const VolumeScreen& screen) {
    const float tile = float(screen.cell * kVolumeTile);
    const auto tiles = [&](float pixels) {
        return uint64_t(std::clamp(std::ceil(pixels / tile), 0.0f, 4096.0f)) + 1;
    };
    return uint32_t(
        std::min(tiles(screen.size.x) * tiles(screen.size.y) * 3 / 2 * wordsOfTile(screen.slabs),
                 kMostWords));
}

uint32_t layVolumes(std::span<const VolumeItem> items, const VolumeScreen& screen, float perPixel,
                    uint32_t words, std::span<MarchedVolume> out) {
    auto cell = float(screen.cell);
    uint64_t all = 0;
    for (;; cell += 1.0f) {
        if (cell > kMostCell) return 0;
        all = tilesOfAll(items, screen.size, cell);
        if (all * wordsOfTile(screen.slabs) <= words) break;
    }
    const vec2 perCell = vec2(2.0f * cell) / screen.size;  // of the view's [-1, 1]
    const auto first = uint32_t(all * kVolumeTileWords);
    uint32_t known = 0, samples = first;
    for (size_t i = 0; i < items.size(); ++i) {
        const VolumeDraw& draw = items[i].draw;
        const bool perspective = draw.clip.z > 0.0f;
        const Tiles tiles = tilesOf(draw.rect, screen.size, cell);
        const uint32_t count = tiles.x * tiles.y;
        MarchedVolume& one = out[i];
        one.flame = items[i].flame;
        VolumeMarch& march = one.march;
        march.rayX = vec4(perCell.x * vec3(draw.rayX), perPixel * cell);
        march.turns = uint32_t(std::clamp(
            std::ceil(draw.deep / draw.spacing), 1.0f,
            std::max(
                std::floor(float(std::min(2 * draw.mostSteps, screen.steps)) / float(draw.slabs)),
                1.0f)));
        march.rayY = vec4(perCell.y * vec3(draw.rayY), draw.deep / float(march.turns));
        march.rayO = vec4(vec3(draw.rayO) + (0.5f * perCell.x - 1.0f) * vec3(draw.rayX) +
                              (0.5f * perCell.y - 1.0f) * vec3(draw.rayY),
                          draw.front);
        march.slabs = draw.slabs;
        march.intervals = draw.intervals;
        march.originX = tiles.originX;
        march.originY = tiles.originY;
        march.tilesX = tiles.x;
        march.cells = count * kVolumeTile * kVolumeTile;
        march.tiles = known;
        march.samples = samples;
        march.encoding = screen.encoding;
        march.flame = one.flame;
        // Flames of few cells are probed more closely, or rays go past them.
        const float away = perspective ? draw.front + 0.5f * draw.deep * float(draw.slabs) : 1.0f;
        const float wide = draw.wide / std::max(glm::length(vec3(march.rayX)) * away, 1e-9f);
        march.apart = wide < 8.0f ? 1 : wide < 20.0f ? 2 : 4;
        VolumeComposite& composite = one.composite;
        composite.place =
            vec4(perCell * vec2(float(tiles.originX), float(tiles.originY)) - vec2(1.0f), perCell);
        composite.clip = draw.clip;
        composite.front = draw.front;
        composite.deep = draw.deep;
        composite.slabs = draw.slabs;
        composite.tilesX = tiles.x;
        composite.tilesY = tiles.y;
        composite.flags = known;
        composite.samples = samples;
        known += count * kVolumeTileWords;
        samples += march.cells * kVolumeCellWords * draw.slabs;
    }
    return first;
}

}  // namespace fw::gpu
