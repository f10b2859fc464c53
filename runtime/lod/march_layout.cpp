// The layout of a view's march: each ray covers a march pixel of a few pixels, or of a part of one
// where the flame is small. Rays of a flame are kept in slabs, of the tiles that volume_probe finds
// worth it. Memory is bounded: if not all fits, the flames that take most of it get larger march
// pixels.
#include "core/assert.h"
#include "lod/tiers.h"
#include "lod/volumes.h"
#include "shared/body.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fw::lod {
namespace {

constexpr float kMaxCell = 64.0f;     // px
constexpr uint32_t kMaxPerPixel = 8;  // cells a side: a tile
// A flame is at least so many march pixels wide. If sheets and tongues fell between rays, its light
// would depend on where rays are.
constexpr float kCellsAcross = 16.0f;
constexpr float kAllDetail = 96.0f;  // px across a flame from which its samples are as it says
// Cells across one from which those around a cell are narrower than a quarter of a step: layers of
// samples would show as bands.
constexpr float kNoLayers = 100.0f;
// Samples that a ray takes closer together rather than fewer, of a flame of that many cells; of
// smaller ones, whose rays are fewer, up to so many times as many; of one that is to be as good as
// can be so many for a cell, up to that: where it is small they are close already.
constexpr float kMinSamples = 20.0f, kLeastInSmall = 1.6f;
constexpr float kMinPerCell = 0.5f, kMinSamplesHigh = 48.0f;
constexpr float kMinSpacing = 0.5f;  // of small and of large ones, of what they say
constexpr float kSamplesPerStep = 2.75f;
constexpr uint64_t kMaxWords = 16u << 20;  // 64 MiB
constexpr uint64_t kMinTiles = 2048;       // of small flames, however small the screen
constexpr uint64_t kHalfScreens = 5;       // whose tiles there is room for: plumes overlap
// Where room is short: times as large as those of fire are smoke's cells at least, and so many
// tiles of fire are worth one of smoke.
constexpr float kSmokeCells = 4.0f;
constexpr float kSmokeTiles = 4.0f;
constexpr uint64_t kFewTiles = 32;  // of a flame, which keeps its cells as long as others have more

// Of a body's cells: fire around a curved surface is flatter than the surface.
constexpr float kNearer = 0.3f;

static_assert(kVolumeSlabs + 4 <= 32, "flags of a tile are a word");

uint32_t wordsOfTile(uint32_t slabs) {
    return kMarchTileWords + kMarchTileSide * kMarchTileSide * kMarchPixelWords * slabs;
}

// Of a tile of a body.
uint32_t nodeWords(uint32_t slabs) { return kBodyNodes * kBodyNodeWords * slabs; }

struct Tiles {
    uint32_t originX, originY, x, y;
};

// That cover a part of the view, from a whole pixel on.
Tiles tilesOf(const vec4& rect, vec2 size, float cell) {
    const float whole = std::max(cell, 1.0f);  // px
    const auto first = [&](float ndc, float pixels) {
        const float at = std::max(std::floor((0.5f * ndc + 0.5f) * pixels / whole), 0.0f);
        return uint32_t(at * (whole / cell));
    };
    const auto tiles = [&](float ndc, float pixels, uint32_t from) {
        const float end = std::ceil((0.5f * ndc + 0.5f) * pixels / whole) * (whole / cell);
        return uint32_t(std::max(std::ceil((end - float(from)) / float(kMarchTileSide)), 1.0f));
    };
    const uint32_t x = first(rect.x, size.x), y = first(rect.y, size.y);
    return {x, y, tiles(rect.z, size.x, x), tiles(rect.w, size.y, y)};
}

// m along the view to where a pixel of it is as wide as VolumeDraw::rayX says.
float awayOf(const VolumeDraw& draw) {
    const bool perspective = draw.clip.z > 0.0f;
    return perspective ? draw.front + 0.5f * draw.deep * float(draw.slabs) : 1.0f;
}

// px, of a flame's cells.
float cellOf(const VolumeDraw& draw, const VolumeScreen& screen) {
    const float wanted = volumeWide(draw, screen) / kCellsAcross;
    const auto most = float(screen.cell);
    if (wanted >= most) return most;
    float cell = 1.0f;
    while (cell > wanted && cell * float(kMaxPerPixel) > 1.0f) cell *= 0.5f;
    return cell;
}

// m between samples. Where sheets are closer than samples thick flame is too dark; a small one,
// which costs little, gets up to twice as many, and so does one around the camera or near it.
float spacingOf(const VolumeDraw& draw, const VolumeScreen& screen) {
    const float wide = volumeWide(draw, screen);
    const float few = std::min(wide / kAllDetail, kNoLayers * cellOf(draw, screen) / wide);
    return draw.spacing * std::clamp(few, kMinSpacing, 1.0f);
}

// Samples of a ray: of those with few steps as many as show the light of those with many.
uint32_t maxSamples(const VolumeDraw& draw, const VolumeScreen& screen) {
    return std::min(uint32_t(kSamplesPerStep * float(draw.mostSteps)), screen.steps);
}

// Of a slab.
uint32_t turnsOf(const VolumeDraw& draw, const VolumeScreen& screen) {
    const float spacing = spacingOf(draw, screen);
    const uint32_t most = maxSamples(draw, screen) / draw.slabs;
    return uint32_t(std::clamp(std::ceil(draw.deep / spacing), 1.0f, std::max(float(most), 1.0f)));
}

// MarchPush::least: of those with few steps no more than three quarters of what they may take.
uint32_t minSamples(const VolumeItem& item, const VolumeScreen& screen, float cells) {
    float least = kMinSamples * std::clamp(kNoLayers / cells, 1.0f, kLeastInSmall);
    if (item.highQuality) least = std::max(least, std::min(kMinPerCell * cells, kMinSamplesHigh));
    return std::min(uint32_t(least), 3 * maxSamples(item.draw, screen) / 4);
}

float coarser(float cell) { return cell < 1.0f ? 2.0f * cell : cell + 1.0f; }

struct Part {  // of the view, for a flame
    uint32_t item = 0;
    bool window = false;
    bool smoke = false;  // most of it
    vec4 rect{};
    float cell = 0;  // px
    Tiles tiles{};
    [[nodiscard]] uint64_t count() const { return uint64_t(tiles.x) * tiles.y; }
    // Cells of the part of the largest become larger first: of those with many tiles that of small
    // cells, so that near flames do not show their cells before far ones. 0: they cannot.
    [[nodiscard]] float weight() const {
        if (coarser(cell) > kMaxCell) return 0.0f;
        const auto n = float(count());
        const float size = count() <= kFewTiles ? n / kMaxCell : n / std::max(cell, 1.0f);
        return smoke ? kSmokeTiles * size : size;
    }
};

// The parts of all flames, which together take no more than so many tiles. Small flames keep their
// march pixels: they need few, and would be lost in larger ones.
class Layout {
 public:
    Layout(std::span<const VolumeItem> items, const VolumeScreen& screen)
        : items_(items), screen_(screen) {}
    // False: they do not fit.
    bool fit(uint64_t room) {
        for (size_t i = 0; i < items_.size(); ++i)
            add(uint32_t(i), false, items_[i].draw.rect, cellOf(items_[i].draw, screen_));
        if (all_ > room) yieldRoomOfSmoke();
        while (all_ > room) {
            Part& most = *std::max_element(
                parts_.begin(), parts_.begin() + ptrdiff_t(count_),
                [](const Part& a, const Part& b) { return a.weight() < b.weight(); });
            if (most.weight() == 0.0f) return false;
            place(most, coarser(most.cell));
        }
        return true;
    }
    [[nodiscard]] std::span<const Part> parts() const { return {parts_.data(), count_}; }
    [[nodiscard]] uint64_t tiles() const { return all_; }

 private:
    void place(Part& part, float cell) {
        all_ -= part.count();
        part.cell = cell;
        part.tiles = tilesOf(part.rect, screen_.size, cell);
        all_ += part.count();
    }
    void add(uint32_t item, bool window, const vec4& rect, float cell) {
        FW_ASSERT(count_ < parts_.size(), "%zu parts", count_);
        Part& part = parts_[count_++];
        part = {item, window, false, rect, cell, {}};
        place(part, cell);
    }
    void yieldRoomOfSmoke() {
        count_ = 0, all_ = 0;
        for (size_t i = 0; i < items_.size(); ++i) {
            const VolumeItem& item = items_[i];
            const float cell = cellOf(item.draw, screen_);
            add(uint32_t(i), false, item.draw.rect, cell);
            if (!item.smokes) continue;
            Part& whole = parts_[count_ - 1];
            const bool seen = item.burns.x < item.burns.z && item.burns.y < item.burns.w;
            const Tiles fire = tilesOf(item.burns, screen_.size, cell);
            // A window nearly as large as the flame would save nothing.
            if (seen && 3 * whole.count() < 4 * uint64_t(fire.x) * fire.y) continue;
            whole.smoke = true;
            place(whole, std::max(kSmokeCells * cell, 1.0f));
            if (seen) add(uint32_t(i), true, item.burns, cell);
        }
    }

    std::span<const VolumeItem> items_;
    const VolumeScreen& screen_;
    std::array<Part, 2 * kMaxVolumeFlames> parts_;  // a flame's window behind the flame
    size_t count_ = 0;
    uint64_t all_ = 0;  // tiles
};

}  // namespace

float volumeWide(const VolumeDraw& draw, const VolumeScreen& screen) noexcept {
    const float pixel = 2.0f / screen.size.x * glm::length(vec3(draw.rayX)) * awayOf(draw);
    return draw.wide / std::max(pixel, 1e-9f);
}

void volumeRays(const VolumeScreen& screen, VolumeDraw& draw) noexcept {
    const float cell = cellOf(draw, screen);
    draw.perPixel = cell <= 1.0f ? std::max(uint32_t(1.0f / cell), 2u) : 1;
    draw.spacing = spacingOf(draw, screen);
    draw.mostSteps = maxSamples(draw, screen);
    if (draw.perPixel == 1) return;
    // Of a pixel that is flame in part slabs would show less light than it has.
    draw.deep *= float(draw.slabs);
    draw.slabs = 1;
}

uint32_t volumeRayWords(const VolumeScreen& screen) {
    const float tile = float(screen.cell * kMarchTileSide);
    const auto tiles = [&](float pixels) {
        return uint64_t(std::clamp(std::ceil(pixels / tile), 0.0f, 4096.0f)) + 1;
    };
    const uint64_t all = std::max<uint64_t>(
        tiles(screen.size.x) * tiles(screen.size.y) * kHalfScreens / 2, kMinTiles);
    return uint32_t(std::min(all * wordsOfTile(screen.slabs), kMaxWords));
}

VolumeAllocation allocateVolumes(std::span<const VolumeItem> items, const VolumeScreen& screen,
                                 float perPixel, uint32_t words, std::span<MarchedVolume> out,
                                 uint32_t first) {
    Layout layout(items, screen);
    uint32_t bodies = 0;
    for (const VolumeItem& item : items) bodies += item.body1 != 0 ? 1 : 0;
    const uint64_t taken = first + uint64_t(bodies) * kBodyWords;
    const uint32_t tileWords =
        wordsOfTile(screen.slabs) + (bodies > 0 ? nodeWords(screen.slabs) : 0);
    const uint64_t room = words > taken ? (words - taken) / tileWords : 0;
    if (!layout.fit(room)) return {};
    VolumeAllocation placed;
    placed.end = first + uint32_t(layout.tiles() * kMarchTileWords);
    uint32_t known = first, samples = placed.end;
    for (const Part& part : layout.parts()) {
        const VolumeItem& item = items[part.item];
        const VolumeDraw& draw = item.draw;
        const float cell = part.cell;
        const vec2 perCell = vec2(2.0f * cell) / screen.size;  // of the view's [-1, 1]
        const Tiles& tiles = part.tiles;
        const uint32_t count = tiles.x * tiles.y;
        FW_ASSERT(placed.count < out.size(), "%u of %zu flames", placed.count, out.size());
        MarchedVolume& one = out[placed.count++];
        one.flame = item.flame;
        one.window = part.window;
        one.smokes = item.smokes;
        MarchPush& march = one.march;
        march.rayX = vec4(perCell.x * vec3(draw.rayX), perPixel * cell * kFinestDetail);
        march.turns = turnsOf(draw, screen);
        march.rayY = vec4(perCell.y * vec3(draw.rayY), draw.deep / float(march.turns));
        march.rayO = vec4(vec3(draw.rayO) + (0.5f * perCell.x - 1.0f) * vec3(draw.rayX) +
                              (0.5f * perCell.y - 1.0f) * vec3(draw.rayY),
                          draw.front);
        march.slabs = draw.slabs;
        march.intervals = draw.intervals;
        march.originX = tiles.originX;
        march.originY = tiles.originY;
        march.tilesX = tiles.x;
        march.pixels = count * kMarchTileSide * kMarchTileSide;
        march.tiles = known;
        march.samples = samples;
        march.encoding = screen.encoding;
        march.flame = one.flame;
        // Flames of few cells are probed more closely, or rays go past them.
        const float wide = volumeWide(draw, screen) / cell;
        march.apart = wide < 8.0f ? 1 : wide < 48.0f ? 2 : 4;
        march.least = minSamples(item, screen, wide);
        march.perPixel = cell < 1.0f ? uint32_t(1.0f / cell) : 0;
        CompositePush& composite = one.composite;
        composite.place =
            vec4(perCell * vec2(float(tiles.originX), float(tiles.originY)) - vec2(1.0f), perCell);
        composite.clip = draw.clip;
        composite.base = draw.base;
        composite.front = draw.front;
        composite.deep = draw.deep;
        composite.slabs = draw.slabs;
        composite.tilesX = tiles.x;
        composite.tilesY = tiles.y;
        composite.flags = known;
        composite.samples = samples;
        composite.perPixel = march.perPixel;
        composite.from = 0.0f;
        composite.to = 1.0f;
        composite.window = vec4(0.0f);
        if (part.window) {
            // Of the whole flame's cells, which end where these begin.
            CompositePush& whole = out[placed.count - 2].composite;
            const vec2 low = vec2(composite.place), size(tiles.x, tiles.y);
            const vec2 high = low + perCell * float(kMarchTileSide) * size;
            const vec2 from(whole.place), per(whole.place.z, whole.place.w);
            whole.window = vec4((low - from) / per, (high - from) / per);
        }
        known += count * kMarchTileWords;
        samples += march.pixels * kMarchPixelWords * draw.slabs;
        one.body = item.body1 != 0;
        if (one.body) {
            march.body = item.body1 - 1;
            composite.nearer = kNearer * draw.wide;
            march.flames = samples;
            samples += kBodyWords + count * nodeWords(draw.slabs);
        }
    }
    FW_ASSERT(samples <= words, "word %u of %u", samples, words);
    return placed;
}

}  // namespace fw::lod
