// Noise is gradient noise on an integer hash; char blocks are columns of random width, split at
// random, because regular cells read as masonry. Not used for anything authoritative.
#include "components/look_textures.h"

#include "shared/look.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fw::components {
namespace {

constexpr int kSide = static_cast<int>(kLookTextureSide);
constexpr int kColumns = 8;

struct Texel {
    float c[4] = {};
};
using Plane = std::pmr::vector<Texel>;

uint32_t mixBits(uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ (x >> 16);
}

// Random number in [0, 1) of a lattice point.
float random(int x, int y, int seed) {
    const uint32_t h = static_cast<uint32_t>(x) * 73856093u ^ static_cast<uint32_t>(y) * 19349663u ^
                       static_cast<uint32_t>(seed) * 83492791u;
    return static_cast<float>(mixBits(h) >> 8) * (1.0f / 16777216.0f);
}

int wrap(int value, int period) { return ((value % period) + period) % period; }
float lerp(float a, float b, float t) { return a + (b - a) * t; }
float clamp01(float x) { return std::clamp(x, 0.0f, 1.0f); }
float smooth(float low, float high, float x) {
    const float t = clamp01((x - low) / (high - low));
    return t * t * (3.0f - 2.0f * t);
}

float cornerGradient(int x, int y, int period, int seed, float dx, float dy) {
    // Sixteen directions: as good as any angle here and free of sines.
    static constexpr std::array<float, 16> kCos{
        1.0f,  0.9239f,  0.7071f,  0.3827f,  0.0f, -0.3827f, -0.7071f, -0.9239f,
        -1.0f, -0.9239f, -0.7071f, -0.3827f, 0.0f, 0.3827f,  0.7071f,  0.9239f};
    const auto a = static_cast<size_t>(random(wrap(x, period), wrap(y, period), seed) * 16.0f);
    return kCos[a] * dx + kCos[(a + 12) & 15] * dy;
}

float gradientNoise(float x, float y, int period, int seed) {
    const float fx0 = std::floor(x), fy0 = std::floor(y);
    const int ix = static_cast<int>(fx0), iy = static_cast<int>(fy0);
    const float fx = x - fx0, fy = y - fy0;
    const float u = fx * fx * fx * (fx * (fx * 6.0f - 15.0f) + 10.0f);
    const float v = fy * fy * fy * (fy * (fy * 6.0f - 15.0f) + 10.0f);
    return lerp(lerp(cornerGradient(ix, iy, period, seed, fx, fy),
                     cornerGradient(ix + 1, iy, period, seed, fx - 1.0f, fy), u),
                lerp(cornerGradient(ix, iy + 1, period, seed, fx, fy - 1.0f),
                     cornerGradient(ix + 1, iy + 1, period, seed, fx - 1.0f, fy - 1.0f), u),
                v);
}

float fractalNoise(float u, float v, int period, int octaves, int seed, bool ridged) {
    float amplitude = 1.0f, sum = 0.0f, weight = 0.0f;
    for (int i = 0; i < octaves; ++i) {
        const float p = gradientNoise(u * static_cast<float>(period),
                                      v * static_cast<float>(period), period, seed + i);
        sum += amplitude * (ridged ? 1.0f - 2.2f * std::fabs(p) : p * 1.4f);
        weight += amplitude;
        amplitude *= 0.55f;
        period *= 2;
    }
    return ridged ? sum / weight : 0.5f + sum / weight;
}

struct Cell {
    float border = 0, id = 0;
};

// Voronoi cells: distance to the nearest border in cell sizes, and a random number per cell.
Cell voronoi(float u, float v, int n, float spread, int seed, bool border) {
    const float x = u * static_cast<float>(n), y = v * static_cast<float>(n);
    const int ix = static_cast<int>(std::floor(x)), iy = static_cast<int>(std::floor(y));
    const auto offset = [&](int i, int j, float& dx, float& dy) {
        const int a = wrap(i, n), b = wrap(j, n);
        dx = static_cast<float>(i) + 0.5f + spread * (random(a, b, seed) - 0.5f) - x;
        dy = static_cast<float>(j) + 0.5f + spread * (random(a, b, seed + 9) - 0.5f) - y;
    };
    float best = 1e9f, nearX = 0, nearY = 0;
    int cellX = ix, cellY = iy;
    for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) {
            float dx, dy;
            offset(ix + i, iy + j, dx, dy);
            if (dx * dx + dy * dy < best) {
                best = dx * dx + dy * dy;
                nearX = dx;
                nearY = dy;
                cellX = ix + i;
                cellY = iy + j;
            }
        }
    }
    Cell cell{1e9f, random(wrap(cellX, n), wrap(cellY, n), seed + 33)};
    for (int j = -2; border && j <= 2; ++j) {
        for (int i = -2; i <= 2; ++i) {
            if (i == 0 && j == 0) continue;
            float dx, dy;
            offset(cellX + i, cellY + j, dx, dy);
            const float ex = dx - nearX, ey = dy - nearY;
            const float length = std::sqrt(ex * ex + ey * ey);
            if (length < 1e-3f) continue;
            const float d = 0.5f * ((nearX + dx) * ex + (nearY + dy) * ey) / length;
            cell.border = std::min(cell.border, d);
        }
    }
    return cell;
}

struct Block {
    float crack = 0;   // distance to the nearest crack over that crack's strength, [0, 1]
    float inside = 0;  // distance to the nearest side, in column widths
    float id = 0;
};

// Charred wood: columns with wandering sides, each split by tilted cracks of random strength.
Block charBlock(float u, float v) {
    const auto side = [&](int i) {
        const int a = wrap(i, kColumns);
        return static_cast<float>(i) + 0.8f * (random(a, 1, 201) - 0.5f) +
               0.3f * (fractalNoise(u, v, 4, 2, 210 + a, false) - 0.5f);
    };
    const float x = u * kColumns;
    int i = static_cast<int>(std::floor(x)) - 1;
    float left = side(i), right = side(i + 1);
    while (right <= x) {
        ++i;
        left = right;
        right = side(i + 1);
    }
    const int column = wrap(i, kColumns);
    const auto sideStrength = [&](int q) {
        const int part = (static_cast<int>(std::floor(v * 9.0f + 3.0f * random(q, 8, 2))) + 9) % 9;
        return (0.15f + random(q, part, 202)) * (0.5f + 0.5f * random(q, 2, 209));
    };
    const float l = x - left, r = right - x, across = l / (l + r);
    Block block;
    block.crack = std::min(l / sideStrength(column), r / sideStrength((column + 1) % kColumns));
    block.inside = std::min(l, r);

    const int splits = 5 + static_cast<int>(random(column, 5, 203) * 4.0f);
    const float wander = 0.28f * (fractalNoise(u, v, 6, 2, 240, false) - 0.5f);
    const auto split = [&](int j) {
        const int b = wrap(j, splits);
        return static_cast<float>(j) + 0.85f * (random(column, b, 204) - 0.5f) +
               0.7f * (random(column, b, 205) - 0.5f) * (across - 0.5f) + wander;
    };
    const float y = v * static_cast<float>(splits);
    int j = static_cast<int>(std::floor(y)) - 1;
    while (split(j + 1) <= y) ++j;
    const int row = wrap(j, splits);
    const float scale = static_cast<float>(kColumns) / static_cast<float>(splits);
    const float below = (y - split(j)) * scale, above = (split(j + 1) - y) * scale;
    const float strengthBelow = 0.25f + 1.15f * random(column, row, 206);
    const float strengthAbove = 0.25f + 1.15f * random(column, (row + 1) % splits, 206);
    block.crack = clamp01(std::min({block.crack, below / strengthBelow, above / strengthAbove}));
    block.inside = std::min({block.inside, below, above});
    block.id = random(column, row, 207);
    return block;
}

void bakeNoise(Plane& plane) {
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            const float u = (static_cast<float>(x) + 0.5f) / kSide;
            const float v = (static_cast<float>(y) + 0.5f) / kSide;
            plane[static_cast<size_t>(y * kSide + x)] = {
                {clamp01(fractalNoise(u, v, 5, 5, 1, false)),
                 clamp01(fractalNoise(u, v, 8, 4, 21, true)),
                 clamp01(fractalNoise(u, v, 17, 4, 41, false)),
                 voronoi(u, v, 14, 0.9f, 61, false).id}};
        }
    }
}

void bakeChar(Plane& plane) {
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            const float u = (static_cast<float>(x) + 0.5f) / kSide;
            const float v = (static_cast<float>(y) + 0.5f) / kSide;
            const float wu = u + 0.012f * (fractalNoise(u, v, 8, 3, 81, false) - 0.5f);
            const float wv = v + 0.012f * (fractalNoise(u, v, 8, 3, 91, false) - 0.5f);
            const Block block = charBlock(wu, wv);
            plane[static_cast<size_t>(y * kSide + x)] = {
                {block.crack, clamp01(voronoi(wu, wv, 20, 0.85f, 72, true).border), block.id,
                 clamp01(1.0f - std::exp(-block.inside / 0.09f))}};
        }
    }
}

// Slopes of what is carved into char, so that a normal costs no sample of its own: those of cracks
// take the place of the blocks' numbers and heights in `charred`.
void bakeRelief(const Plane& noise, Plane& charred, Plane& plane) {
    const auto at = [](const Plane& p, int x, int y) -> const Texel& {
        return p[static_cast<size_t>((y & (kSide - 1)) * kSide + (x & (kSide - 1)))];
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
    const auto pack = [](float slope, float range) { return clamp01(0.5f + 0.5f * slope / range); };
    constexpr float kPerCell = 0.5f * kSide / kColumns, kPerTile = 0.5f * kSide;
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            plane[static_cast<size_t>(y * kSide + x)] = {
                {pack((wrinkle(x + 1, y) - wrinkle(x - 1, y)) * kPerTile, gpu::kCrumpleSlopeRange),
                 pack((wrinkle(x, y + 1) - wrinkle(x, y - 1)) * kPerTile, gpu::kCrumpleSlopeRange),
                 pack((crackDepth(x + 1, y) - crackDepth(x - 1, y)) * kPerCell,
                      gpu::kCrackSlopeRange),
                 pack((crackDepth(x, y + 1) - crackDepth(x, y - 1)) * kPerCell,
                      gpu::kCrackSlopeRange)}};
        }
    }
    for (size_t i = 0; i < plane.size(); ++i) {
        charred[i].c[2] = plane[i].c[2];
        charred[i].c[3] = plane[i].c[3];
    }
}

void store(Plane& plane, std::byte* out) {
    for (int side = kSide;; side /= 2) {
        for (int i = 0; i < side * side; ++i) {
            for (const float value : plane[static_cast<size_t>(i)].c) {
                *out++ = static_cast<std::byte>(static_cast<uint8_t>(value * 255.0f + 0.5f));
            }
        }
        if (side == 1) return;
        const int half = side / 2;  // in place: a texel is read before its place is written
        for (int y = 0; y < half; ++y) {
            for (int x = 0; x < half; ++x) {
                Texel sum;
                for (int k = 0; k < 4; ++k) {
                    const size_t from = static_cast<size_t>((2 * y + k / 2) * side + 2 * x + k % 2);
                    for (int c = 0; c < 4; ++c) sum.c[c] += 0.25f * plane[from].c[c];
                }
                plane[static_cast<size_t>(y * half + x)] = sum;
            }
        }
    }
}

}  // namespace

size_t lookTextureOffset(uint32_t layer, uint32_t mip) noexcept {
    size_t chain = 0, before = 0;
    for (uint32_t i = 0; i < kLookTextureMips; ++i) {
        const size_t bytes = size_t{kLookTextureSide >> i} * (kLookTextureSide >> i) * 4;
        chain += bytes;
        if (i < mip) before += bytes;
    }
    return layer * chain + before;
}

std::pmr::vector<std::byte> bakeLookTextures(std::pmr::memory_resource* memory) {
    std::pmr::vector<std::byte> bytes(lookTextureOffset(kLookTextureLayers, 0), memory);
    constexpr size_t kTexels = size_t{kSide} * kSide;
    Plane noise(kTexels, memory), charred(kTexels, memory), relief(kTexels, memory);
    bakeNoise(noise);
    bakeChar(charred);
    bakeRelief(noise, charred, relief);
    store(noise, bytes.data() + lookTextureOffset(0, 0));
    store(charred, bytes.data() + lookTextureOffset(1, 0));
    store(relief, bytes.data() + lookTextureOffset(2, 0));
    return bytes;
}

}  // namespace fw::components
