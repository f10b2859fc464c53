// See outline.h.
#include "viewport/outline.h"

#include <algorithm>
#include <cmath>

namespace fwview {
namespace {

struct Mask {
    uint32_t width, height;
    std::vector<uint8_t> cells;
    bool at(uint32_t x, uint32_t y) const {
        return x < width && y < height && cells[size_t{y} * width + x];
    }
};

// Fills rows between the edges. Thin triangles still fill the cells of their corners.
void fill(Mask& mask, glm::vec2 a, glm::vec2 b, glm::vec2 c) {
    const float low = std::max(0.0f, std::floor(std::min({a.y, b.y, c.y})));
    const float high = std::min(float(mask.height) - 1, std::max({a.y, b.y, c.y}));
    for (float y = low; y <= high; ++y) {
        const float middle = y + 0.5f;
        float from = 1e9f, to = -1e9f;
        const glm::vec2 corners[4] = {a, b, c, a};
        for (int i = 0; i < 3; ++i) {
            const glm::vec2 p = corners[i], q = corners[i + 1];
            if ((p.y <= middle) == (q.y <= middle)) continue;
            const float x = p.x + (middle - p.y) / (q.y - p.y) * (q.x - p.x);
            from = std::min(from, x);
            to = std::max(to, x);
        }
        if (from > to) continue;
        const auto x0 = uint32_t(std::clamp(from, 0.0f, float(mask.width)));
        const auto x1 = uint32_t(std::clamp(std::ceil(to), 0.0f, float(mask.width)));
        std::fill(mask.cells.begin() + long(size_t(y) * mask.width + x0),
                  mask.cells.begin() + long(size_t(y) * mask.width + x1), uint8_t{1});
    }
}

}  // namespace

void findOutline(std::span<const glm::vec2> corners, uint32_t width, uint32_t height,
                 std::vector<glm::vec2>& lines) {
    Mask mask{width, height, std::vector<uint8_t>(size_t{width} * height)};
    for (size_t i = 0; i + 2 < corners.size(); i += 3)
        fill(mask, corners[i], corners[i + 1], corners[i + 2]);
    lines.clear();
    const glm::vec2 unit(1.0f / float(width), 1.0f / float(height));
    // Marching squares over the cell centres.
    for (uint32_t y = 0; y + 1 < height; ++y) {
        for (uint32_t x = 0; x + 1 < width; ++x) {
            const uint32_t kind = uint32_t(mask.at(x, y)) | uint32_t(mask.at(x + 1, y)) << 1 |
                                  uint32_t(mask.at(x + 1, y + 1)) << 2 |
                                  uint32_t(mask.at(x, y + 1)) << 3;
            if (kind == 0 || kind == 15) continue;
            const glm::vec2 at(float(x) + 0.5f, float(y) + 0.5f);
            const glm::vec2 sides[4] = {at + glm::vec2(0.5f, 0), at + glm::vec2(1, 0.5f),
                                        at + glm::vec2(0.5f, 1), at + glm::vec2(0, 0.5f)};
            glm::vec2 ends[4];
            uint32_t count = 0;
            for (uint32_t side = 0; side < 4; ++side)
                if ((kind >> side & 1) != (kind >> (side + 1) % 4 & 1)) ends[count++] = sides[side];
            for (uint32_t i = 0; i + 1 < count; i += 2) {
                lines.push_back(ends[i] * unit);
                lines.push_back(ends[i + 1] * unit);
            }
        }
    }
}

}  // namespace fwview
