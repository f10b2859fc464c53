// Gradient noise on an integer hash; char blocks are columns of random width, split at random,
// because regular cells look like masonry. Cosmetic.
#include "components/appearance_textures.h"

#include "core/assert.h"
#include "core/hash.h"
#include "shared/appearance.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fw::components {
namespace {

constexpr int kSide = int(kAppearanceTextureSide);
constexpr int kColumns = 8;

struct Texel {
    float c[4] = {};
};
using Plane = std::pmr::vector<Texel>;

// Random number in [0, 1) of a lattice point.
float random(int x, int y, int seed) {
    const uint32_t h =
        uint32_t(x) * 73856093u ^ uint32_t(y) * 19349663u ^ uint32_t(seed) * 83492791u;
    return float(core::hash32(h) >> 8) * (1.0f / 16777216.0f);
}

int wrap(int value, int period) { return ((value % period) + period) % period; }
float lerp(float a, float b, float t) { return a + (b - a) * t; }
float clamp01(float x) { return std::clamp(x, 0.0f, 1.0f); }
float smooth(float low, float high, float x) {
    const float t = clamp01((x - low) / (high - low));
    return t * t * (3.0f - 2.0f * t);
}

// Sixteen directions: as good as any angle here and free of sines.
constexpr std::array<float, 16> kCos{1.0f,     0.9239f,  0.7071f, 0.3827f,  0.0f,     -0.3827f,
                                     -0.7071f, -0.9239f, -1.0f,   -0.9239f, -0.7071f, -0.3827f,
                                     0.0f,     0.3827f,  0.7071f, 0.9239f};

// Wraps a number within one period of [0, period), without a division, which would dominate the
// cost.
int wrapNear(int value, int period) {
    return value < 0 ? value + period : value >= period ? value - period : value;
}

// Fractal noise over [0, 1)^2, tiling. Each octave has a lattice twice as fine as the octave before
// it.
class Noise {
 public:
    Noise(int period, int octaves, int seed, bool ridged, std::pmr::memory_resource* memory)
        : period_(period), octaves_(octaves), ridged_(ridged), directions_(memory) {
        for (int i = 0; i < octaves; ++i, period *= 2)
            for (int y = 0; y < period; ++y)
                for (int x = 0; x < period; ++x)
                    directions_.push_back(uint8_t(random(x, y, seed + i) * 16.0f));
    }
    float at(float u, float v) const {
        float amplitude = 1.0f, sum = 0.0f, weight = 0.0f;
        const uint8_t* lattice = directions_.data();
        for (int i = 0, period = period_; i < octaves_; ++i) {
            const float p = gradientNoise(u * float(period), v * float(period), period, lattice);
            sum += amplitude * (ridged_ ? 1.0f - 2.2f * std::fabs(p) : p * 1.4f);
            weight += amplitude;
            amplitude *= 0.55f;
            lattice += period * period;
            period *= 2;
        }
        return ridged_ ? sum / weight : 0.5f + sum / weight;
    }

 private:
    static float gradientNoise(float x, float y, int period, const uint8_t* lattice) {
        const float fx0 = std::floor(x), fy0 = std::floor(y);
        const int left = wrapNear(int(fx0), period);
        const int right = wrapNear(left + 1, period);
        const int below = wrapNear(int(fy0), period);
        const int above = wrapNear(below + 1, period);
        const float fx = x - fx0, fy = y - fy0;
        const float u = fx * fx * fx * (fx * (fx * 6.0f - 15.0f) + 10.0f);
        const float v = fy * fy * fy * (fy * (fy * 6.0f - 15.0f) + 10.0f);
        const auto corner = [&](int column, int row, float dx, float dy) {
            const size_t a = lattice[row * period + column];
            return kCos[a] * dx + kCos[(a + 12) & 15] * dy;
        };
        return lerp(
            lerp(corner(left, below, fx, fy), corner(right, below, fx - 1.0f, fy), u),
            lerp(corner(left, above, fx, fy - 1.0f), corner(right, above, fx - 1.0f, fy - 1.0f), u),
            v);
    }

    int period_, octaves_;
    bool ridged_;
    std::pmr::vector<uint8_t> directions_;  // octave by octave, row by row
};

// Voronoi cells over [0, 1)^2, tiling, n on a side.
class Voronoi {
 public:
    Voronoi(int n, float spread, int seed, std::pmr::memory_resource* memory)
        : n_(n), seed_(seed), offsets_(memory) {
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x)
                offsets_.push_back({spread * (random(x, y, seed) - 0.5f),
                                    spread * (random(x, y, seed + 9) - 0.5f)});
    }
    struct Cell {
        float dx = 0, dy = 0;  // from the given place to the cell's point
        int x = 0, y = 0;
    };
    Cell nearest(float u, float v) const {
        const float x = u * float(n_), y = v * float(n_);
        const int ix = int(std::floor(x)), iy = int(std::floor(y));
        float best = 1e9f;
        Cell cell;
        for (int j = iy - 1; j <= iy + 1; ++j)
            for (int i = ix - 1; i <= ix + 1; ++i) {
                float dx, dy;
                toPoint(i, j, x, y, dx, dy);
                if (dx * dx + dy * dy < best) {
                    best = dx * dx + dy * dy;
                    cell = {dx, dy, i, j};
                }
            }
        return cell;
    }
    // Random number of the nearest cell.
    float id(float u, float v) const {
        const Cell cell = nearest(u, v);
        return random(wrapNear(cell.x, n_), wrapNear(cell.y, n_), seed_ + 33);
    }
    // Distance to the nearest border, in cell sizes.
    float border(float u, float v) const {
        const float x = u * float(n_), y = v * float(n_);
        const Cell cell = nearest(u, v);
        float least = 1e9f;
        for (int j = -2; j <= 2; ++j)
            for (int i = -2; i <= 2; ++i) {
                if (i == 0 && j == 0) continue;
                float dx, dy;
                toPoint(cell.x + i, cell.y + j, x, y, dx, dy);
                const float ex = dx - cell.dx, ey = dy - cell.dy;
                const float length = std::sqrt(ex * ex + ey * ey);
                if (length < 1e-3f) continue;
                least =
                    std::min(least, 0.5f * ((cell.dx + dx) * ex + (cell.dy + dy) * ey) / length);
            }
        return least;
    }

 private:
    void toPoint(int i, int j, float x, float y, float& dx, float& dy) const {
        const std::array<float, 2>& offset =
            offsets_[size_t(wrapNear(j, n_) * n_ + wrapNear(i, n_))];
        dx = float(i) + 0.5f + offset[0] - x;
        dy = float(j) + 0.5f + offset[1] - y;
    }

    int n_, seed_;
    std::pmr::vector<std::array<float, 2>> offsets_;
};

struct Block {
    float crack = 0;   // distance to the nearest crack over that crack's strength, [0, 1]
    float inside = 0;  // distance to the nearest side, in column widths
    float id = 0;
};

struct CharNoise {
    explicit CharNoise(std::pmr::memory_resource* memory)
        : splits(6, 2, 240, false, memory), sides(memory) {
        for (int i = 0; i < kColumns; ++i) sides.emplace_back(4, 2, 210 + i, false, memory);
    }
    Noise splits;
    std::pmr::vector<Noise> sides;  // by column
};

// Charred wood: columns with wandering sides, each split by tilted cracks of random strength.
Block charBlock(const CharNoise& noise, float u, float v) {
    const auto side = [&](int i) {
        const int a = wrap(i, kColumns);
        return float(i) + 0.8f * (random(a, 1, 201) - 0.5f) +
               0.3f * (noise.sides[size_t(a)].at(u, v) - 0.5f);
    };
    const float x = u * kColumns;
    int i = int(std::floor(x)) - 1;
    float left = side(i), right = side(i + 1);
    while (right <= x) {
        ++i;
        left = right;
        right = side(i + 1);
    }
    const int column = wrap(i, kColumns);
    const auto sideStrength = [&](int q) {
        const int part = (int(std::floor(v * 9.0f + 3.0f * random(q, 8, 2))) + 9) % 9;
        return (0.15f + random(q, part, 202)) * (0.5f + 0.5f * random(q, 2, 209));
    };
    const float l = x - left, r = right - x, across = l / (l + r);
    Block block;
    block.crack = std::min(l / sideStrength(column), r / sideStrength((column + 1) % kColumns));
    block.inside = std::min(l, r);

    const int splits = 5 + int(random(column, 5, 203) * 4.0f);
    const float wander = 0.28f * (noise.splits.at(u, v) - 0.5f);
    const auto split = [&](int j) {
        const int b = wrap(j, splits);
        return float(j) + 0.85f * (random(column, b, 204) - 0.5f) +
               0.7f * (random(column, b, 205) - 0.5f) * (across - 0.5f) + wander;
    };
    const float y = v * float(splits);
    int j = int(std::floor(y)) - 1;
    while (split(j + 1) <= y) ++j;
    const int row = wrap(j, splits);
    const float scale = float(kColumns) / float(splits);
    const float below = (y - split(j)) * scale, above = (split(j + 1) - y) * scale;
    const float strengthBelow = 0.25f + 1.15f * random(column, row, 206);
    const float strengthAbove = 0.25f + 1.15f * random(column, (row + 1) % splits, 206);
    block.crack = clamp01(std::min({block.crack, below / strengthBelow, above / strengthAbove}));
    block.inside = std::min({block.inside, below, above});
    block.id = random(column, row, 207);
    return block;
}

// Fills a plane with paint(x, y).
template <class Paint>
void paintTexels(Plane& plane, const Paint& paint) {
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) plane[size_t(y * kSide + x)] = paint(x, y);
}
float middleOf(int texel) { return (float(texel) + 0.5f) / kSide; }

void bakeNoise(Plane& plane, std::pmr::memory_resource* memory) {
    const Noise broad(5, 5, 1, false, memory), ridges(8, 4, 21, true, memory),
        fine(17, 4, 41, false, memory);
    const Voronoi cells(14, 0.9f, 61, memory);
    paintTexels(plane, [&](int x, int y) -> Texel {
        const float u = middleOf(x), v = middleOf(y);
        return {{clamp01(broad.at(u, v)), clamp01(ridges.at(u, v)), clamp01(fine.at(u, v)),
                 cells.id(u, v)}};
    });
}

void bakeChar(Plane& plane, std::pmr::memory_resource* memory) {
    const Noise aside(8, 3, 81, false, memory), along(8, 3, 91, false, memory);
    const CharNoise noise(memory);
    const Voronoi cells(20, 0.85f, 72, memory);
    paintTexels(plane, [&](int x, int y) -> Texel {
        const float u = middleOf(x), v = middleOf(y);
        const float wu = u + 0.012f * (aside.at(u, v) - 0.5f);
        const float wv = v + 0.012f * (along.at(u, v) - 0.5f);
        const Block block = charBlock(noise, wu, wv);
        return {{block.crack, clamp01(cells.border(wu, wv)), block.id,
                 clamp01(1.0f - std::exp(-block.inside / 0.09f))}};
    });
}

// Slopes of the relief of char, so that a normal needs no further sample. The cracks' slopes
// replace the blocks' numbers and heights in `charred`.
void bakeRelief(const Plane& noise, Plane& charred, Plane& plane) {
    const auto at = [](const Plane& p, int x, int y) -> const Texel& {
        return p[size_t((y & (kSide - 1)) * kSide + (x & (kSide - 1)))];
    };
    constexpr float kWidth = 0.11f;  // of an open crack, in cells
    const auto crackDepth = [&](int x, int y) {
        const Texel& t = at(charred, x, y);
        const float wide = 1.0f - smooth(0.25f * kWidth, 1.3f * kWidth, t.c[0]);
        const float fine = 0.25f * (1.0f - smooth(0.05f, 0.25f, t.c[1]));
        return 0.75f * std::max(wide, fine) + 0.42f * (1.0f - t.c[3]);
    };
    const auto wrinkle = [&](int x, int y) {
        return 1.4f * at(noise, x, y).c[0] + 0.8f * at(noise, x, y).c[1];
    };
    // Of a height, along x and y.
    const auto slopes = [](const auto& height, int x, int y, float scale, float range) {
        const auto pack = [&](float rise) { return clamp01(0.5f + 0.5f * (rise * scale) / range); };
        return std::array{pack(height(x + 1, y) - height(x - 1, y)),
                          pack(height(x, y + 1) - height(x, y - 1))};
    };
    paintTexels(plane, [&](int x, int y) -> Texel {
        const auto [a, b] = slopes(wrinkle, x, y, 0.5f * kSide, gpu::kCrumpleSlopeRange);
        const auto [c, d] =
            slopes(crackDepth, x, y, 0.5f * kSide / kColumns, gpu::kCrackSlopeRange);
        return {{a, b, c, d}};
    });
    for (size_t i = 0; i < plane.size(); ++i) {
        charred[i].c[2] = plane[i].c[2];
        charred[i].c[3] = plane[i].c[3];
    }
}

void store(Plane& plane, std::byte* out) {
    for (int side = kSide;; side /= 2) {
        for (int i = 0; i < side * side; ++i)
            for (const float value : plane[size_t(i)].c)
                *out++ = std::byte(uint8_t(value * 255.0f + 0.5f));
        if (side == 1) return;
        const int half = side / 2;  // in place: every texel is read before it is overwritten
        for (int y = 0; y < half; ++y)
            for (int x = 0; x < half; ++x) {
                Texel sum;
                for (int k = 0; k < 4; ++k) {
                    const size_t from = size_t((2 * y + k / 2) * side + 2 * x + k % 2);
                    for (int c = 0; c < 4; ++c) sum.c[c] += 0.25f * plane[from].c[c];
                }
                plane[size_t(y * half + x)] = sum;
            }
    }
}

}  // namespace

size_t appearanceTextureOffset(uint32_t layer, uint32_t mip) noexcept {
    FW_ASSERT(layer <= kAppearanceTextureLayers && mip < kAppearanceTextureMips, "layer %u, mip %u",
              layer, mip);
    size_t chain = 0, before = 0;
    for (uint32_t i = 0; i < kAppearanceTextureMips; ++i) {
        const size_t bytes =
            size_t{kAppearanceTextureSide >> i} * (kAppearanceTextureSide >> i) * 4;
        chain += bytes;
        if (i < mip) before += bytes;
    }
    return layer * chain + before;
}

std::pmr::vector<std::byte> bakeAppearanceTextures(std::pmr::memory_resource* memory) {
    std::pmr::vector<std::byte> bytes(appearanceTextureOffset(kAppearanceTextureLayers, 0), memory);
    constexpr size_t kTexels = size_t{kSide} * kSide;
    Plane noise(kTexels, memory), charred(kTexels, memory), relief(kTexels, memory);
    bakeNoise(noise, memory);
    bakeChar(charred, memory);
    bakeRelief(noise, charred, relief);
    store(noise, bytes.data() + appearanceTextureOffset(0, 0));
    store(charred, bytes.data() + appearanceTextureOffset(1, 0));
    store(relief, bytes.data() + appearanceTextureOffset(2, 0));
    return bytes;
}

}  // namespace fw::components
