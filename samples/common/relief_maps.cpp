// See relief_maps.h.
#include "common/relief_maps.h"

#include <algorithm>
#include <cmath>

namespace sample {
namespace {

int wrapped(int at, int size) { return (at % size + size) % size; }

float heightAt(const ReliefHeights& relief, int x, int y) {
    const auto w = static_cast<int>(relief.width), h = static_cast<int>(relief.height);
    x = relief.repeats ? wrapped(x, w) : std::clamp(x, 0, w - 1);
    y = relief.repeats ? wrapped(y, h) : std::clamp(y, 0, h - 1);
    return relief.heights[static_cast<size_t>(y) * relief.width + static_cast<size_t>(x)];
}

// The highest texel of each square block. Most blocks are too low or too far to matter, so the
// search skips them.
struct Blocks {
    int side = 8;  // texels
    int across = 0, down = 0;
    std::vector<float> highest;
};
Blocks groupIntoBlocks(const ReliefHeights& relief) {
    const auto w = static_cast<int>(relief.width), h = static_cast<int>(relief.height);
    Blocks all;
    if (relief.repeats && (w % all.side != 0 || h % all.side != 0))
        all.side = 1;  // fall back to single texels if
                       // blocks do not tile
    all.across = (w + all.side - 1) / all.side;
    all.down = (h + all.side - 1) / all.side;
    all.highest.assign(static_cast<size_t>(all.across) * static_cast<size_t>(all.down), 0.0f);
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            float& highest =
                all.highest[static_cast<size_t>(y / all.side * all.across + x / all.side)];
            highest = std::max(highest, heightAt(relief, x, y));
        }
    return all;
}

// Searches rings of blocks around the texel until farther ones cannot narrow the cone any more.
// Outside a picture that does not tile, nothing is higher than its border.
float coneAt(const ReliefHeights& relief, const Blocks& blocks, glm::vec2 texel, int x, int y) {
    const float own = heightAt(relief, x, y), room = (1 - own) * relief.depth;
    const int side = blocks.side;
    float cone = kWidestCone;
    const auto look = [&](int blockX, int blockY) {
        const int left = blockX * side, top = blockY * side;
        const bool inside =
            blockX >= 0 && blockX < blocks.across && blockY >= 0 && blockY < blocks.down;
        if (!inside && !relief.repeats) return;
        const int there =
            wrapped(blockY, blocks.down) * blocks.across + wrapped(blockX, blocks.across);
        const float highest = (blocks.highest[static_cast<size_t>(there)] - own) * relief.depth;
        const glm::vec2 away(std::max({left - x, x - (left + side - 1), 0}),
                             std::max({top - y, y - (top + side - 1), 0}));
        if (highest <= 0 || glm::length(away * texel) >= cone * highest) return;
        for (int j = top; j < top + side; ++j)
            for (int i = left; i < left + side; ++i) {
                const float higher = (heightAt(relief, i, j) - own) * relief.depth;
                if (higher > 0)
                    cone = std::min(cone, glm::length(glm::vec2(i - x, j - y) * texel) / higher);
            }
    };
    const int column = x / side, row = y / side;
    look(column, row);
    const float least = std::min(texel.x, texel.y);
    for (int r = 1; static_cast<float>((r - 1) * side + 1) * least < cone * room; ++r) {
        for (int k = -r; k <= r; ++k) look(column + k, row - r), look(column + k, row + r);
        for (int k = 1 - r; k < r; ++k) look(column - r, row + k), look(column + r, row + k);
    }
    return cone;
}

// Returns the tangent of the highest obstacle in a direction. `step`: texels between two samples.
float horizonAt(const ReliefHeights& relief, glm::vec2 place, glm::vec2 direction, float step,
                float own) {
    float tangent = 0;
    const float room = (1 - own) * relief.depth;
    for (int k = 1; room > tangent * static_cast<float>(k) * step; ++k) {
        const glm::vec2 there = glm::floor(place + direction * static_cast<float>(k));
        const float height = heightAt(relief, static_cast<int>(there.x), static_cast<int>(there.y));
        tangent = std::max(tangent, (height - own) * relief.depth / (static_cast<float>(k) * step));
        if (static_cast<float>(k) * step > kWidestCone * room)
            break;  // lower obstacles count as level
    }
    return tangent;
}

}  // namespace

std::vector<float> reliefCones(const ReliefHeights& relief) {
    const glm::vec2 texel = relief.metres / glm::vec2(relief.width, relief.height);
    const Blocks blocks = groupIntoBlocks(relief);
    std::vector<float> cones(relief.heights.size());
    for (size_t i = 0; i < cones.size(); ++i)
        cones[i] = coneAt(relief, blocks, texel, static_cast<int>(i % relief.width),
                          static_cast<int>(i / relief.width));
    return cones;
}

ReliefHorizon reliefHorizon(const ReliefHeights& relief) {
    constexpr glm::vec2 kDirections[4] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    const glm::vec2 texel = relief.metres / glm::vec2(relief.width, relief.height);
    ReliefHorizon all;
    all.width = std::max(relief.width / 2, 1u);
    all.height = std::max(relief.height / 2, 1u);
    for (size_t i = 0; i < size_t{all.width} * all.height; ++i) {
        const int x = 2 * static_cast<int>(i % all.width), y = 2 * static_cast<int>(i / all.width);
        const float own = 0.25f * (heightAt(relief, x, y) + heightAt(relief, x + 1, y) +
                                   heightAt(relief, x, y + 1) + heightAt(relief, x + 1, y + 1));
        for (const glm::vec2 direction : kDirections) {
            const float step = glm::length(direction * texel);
            const float t = horizonAt(relief, glm::vec2(x + 1, y + 1), direction, step, own);
            all.texels.push_back(static_cast<uint8_t>(t / (1 + t) * 255.0f + 0.5f));
        }
    }
    return all;
}

}  // namespace sample
