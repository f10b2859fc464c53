// The texels that a vertex samples, and the tiles that warm a triangle or an edge.
#include "mesh/refine/coarse.h"

#include <cmath>

namespace fw::mesh {
namespace {

constexpr double kReachCells = 1.5;  // of an edge: it must split before the row beside it moves
constexpr int kCellSearch = 4;       // texels, if none of the four around is of the chart

class Charts {
 public:
    Charts(const Surface& surface, const BurnDomain& domain)
        : domain_(domain), chartOf_(domain.indices.size() / 3, kNone, surface.memory) {
        for (const Triangle& t : surface.triangles) chartOf_[t.source] = t.chart;
    }
    [[nodiscard]] uint32_t of(uint32_t source) const { return chartOf_[source]; }
    [[nodiscard]] bool at(int x, int y, uint32_t chart) const {
        if (x < 0 || y < 0 || x >= int(domain_.width) || y >= int(domain_.height)) return false;
        const uint32_t triangle = domain_.triangleOf[uint32_t(y) * domain_.width + uint32_t(x)];
        return triangle != kNone && chartOf_[triangle] == chart;
    }
    [[nodiscard]] bool inTile(int tileX, int tileY, uint32_t chart) const {
        const int side = int(kTileSide);
        for (int y = tileY * side; y < (tileY + 1) * side; ++y)
            for (int x = tileX * side; x < (tileX + 1) * side; ++x)
                if (at(x, y, chart)) return true;
        return false;
    }

 private:
    const BurnDomain& domain_;
    std::pmr::vector<uint32_t> chartOf_;  // per triangle of the domain
};

glm::dvec2 uvOf(const BurnDomain& domain, const gpu::RefineDraw& d) {
    glm::dvec2 uv(0);
    const double w[3] = {1 - double(d.weight1) - double(d.weight2), double(d.weight1),
                         double(d.weight2)};
    for (uint32_t k = 0; k < 3; ++k) {
        const RenderVertex& v = domain.cornerOf(d.triangle, k);
        uv += w[k] * glm::dvec2(v.atlasUv[0], v.atlasUv[1]);
    }
    return uv;
}

// Bilinear over the chart's own texels; without any, the nearest one.
void sample(const BurnDomain& domain, const Charts& charts, uint32_t slotIndex,
            RefineModel& model) {
    gpu::RefineSlot& slot = model.slots[slotIndex];
    const gpu::RefineDraw& draw = model.draws[slotIndex];
    slot.texel = slot.weights = 0;
    if (draw.triangle == kNone) return;
    FW_ASSERT(draw.triangle < domain.indices.size() / 3, "triangle %u", draw.triangle);
    const uint32_t chart = charts.of(draw.triangle);
    const glm::dvec2 uv = uvOf(domain, draw);
    const int x = std::clamp(int(std::floor(uv.x - 0.5)), 0, int(domain.width) - 2);
    const int y = std::clamp(int(std::floor(uv.y - 0.5)), 0, int(domain.height) - 2);
    const double fx = std::clamp(uv.x - 0.5 - x, 0.0, 1.0);
    const double fy = std::clamp(uv.y - 0.5 - y, 0.0, 1.0);
    double weight[4], sum = 0;
    for (int k = 0; k < 4; ++k) {
        weight[k] = 0;
        if (!charts.at(x + (k & 1), y + (k >> 1), chart)) continue;
        weight[k] = (k & 1 ? fx : 1 - fx) * (k & 2 ? fy : 1 - fy) + 1e-6;
        sum += weight[k];
    }
    uint32_t texel = uint32_t(y) * domain.width + uint32_t(x);
    if (sum > 0) {
        for (int k = 0; k < 4; ++k)
            slot.weights |= uint32_t(weight[k] / sum * 255 + 0.5) << (8 * k);
    } else {
        texel = kNone;
        double least = 1e30;
        for (int v = y - kCellSearch; v <= y + 1 + kCellSearch; ++v)
            for (int u = x - kCellSearch; u <= x + 1 + kCellSearch; ++u) {
                const double d = std::hypot(u + 0.5 - uv.x, v + 0.5 - uv.y);
                if (d >= least || !charts.at(u, v, chart)) continue;
                least = d;
                texel = uint32_t(v) * domain.width + uint32_t(u);
            }
        if (texel == kNone) {
            const float place[3] = {slot.x, slot.y, slot.z};
            texel = nearestTexel(domain, place, 1e6f);
            ++model.farSlots;
        }
        // As one of four whose lower left one has neighbours.
        const uint32_t u = texel % domain.width, v = texel / domain.width;
        const uint32_t left = std::min(u, domain.width - 2), low = std::min(v, domain.height - 2);
        texel = low * domain.width + left;
        slot.weights = 255u << (8 * (u - left + 2 * (v - low)));
    }
    const uint32_t material = domain.cornerOf(draw.triangle, 0).material & 255u;
    slot.texel = (texel & 0xFFFFFFu) | material << 24;
}

// Collects the tiles of each item, then inverts the lists to the items of each tile.
class TileLists {
 public:
    TileLists(const BurnDomain& domain, std::pmr::memory_resource* memory)
        : domain_(domain), start_(1, 0, memory), tiles_(memory) {}
    void add(int tileX, int tileY) {
        if (tileX < 0 || tileY < 0 || tileX >= int(domain_.tilesX) || tileY >= int(domain_.tilesY))
            return;
        const uint32_t tile = uint32_t(tileY) * domain_.tilesX + uint32_t(tileX);
        if (std::find(tiles_.begin() + start_.back(), tiles_.end(), tile) == tiles_.end())
            tiles_.push_back(tile);
    }
    void close() { start_.push_back(uint32_t(tiles_.size())); }
    void invert(RefineModel& model) const {
        FW_ASSERT(start_.size() == model.edges.size() + model.triangles.size() + 1, "%zu items",
                  start_.size() - 1);
        Groups groups = groupBy(domain_.tileCount(), uint32_t(tiles_.size()), model.memory,
                                [&](uint32_t i) { return tiles_[i]; });
        for (uint32_t& entry : groups.items)  // from a place in tiles_ to its item
            entry = uint32_t(std::upper_bound(start_.begin(), start_.end(), entry) -
                             start_.begin() - 1);
        model.tileStart.swap(groups.start);
        model.tileItems.swap(groups.items);
    }

 private:
    const BurnDomain& domain_;
    std::pmr::vector<uint32_t> start_, tiles_;
};

int tileOf(double texels) { return int(std::floor(texels / kTileSide)); }

// Tiles whose middle is within a tile's half diagonal of the triangle.
void trianglesTiles(const glm::dvec2 uv[3], TileLists& lists) {
    const double turn = cross2(uv[1] - uv[0], uv[2] - uv[0]) < 0 ? -1 : 1;
    const glm::dvec2 low = glm::min(glm::min(uv[0], uv[1]), uv[2]);
    const glm::dvec2 high = glm::max(glm::max(uv[0], uv[1]), uv[2]);
    for (int y = tileOf(low.y); y <= tileOf(high.y); ++y)
        for (int x = tileOf(low.x); x <= tileOf(high.x); ++x) {
            const glm::dvec2 middle = glm::dvec2(x + 0.5, y + 0.5) * double(kTileSide);
            bool near = true;
            for (int k = 0; k < 3 && near; ++k) {
                const glm::dvec2 d = uv[(k + 1) % 3] - uv[k];
                const double length = glm::length(d);
                near = length == 0 ||
                       turn * cross2(d, middle - uv[k]) / length > -0.75 * double(kTileSide);
            }
            if (near) lists.add(x, y);
        }
    lists.close();
}

// Tiles along one side, and tiles in reach of it that hold its chart.
void sideTiles(glm::dvec2 a, glm::dvec2 b, double cells, uint32_t chart, const Charts& charts,
               TileLists& lists) {
    FW_ASSERT(cells > 0, "%g cells", cells);
    const glm::dvec2 d = b - a;
    const double length = glm::length(d);
    const int samples = 1 + int(2 * length / kTileSide);
    for (int k = 0; k <= samples; ++k) {
        const glm::dvec2 p = a + d * (double(k) / samples);
        lists.add(tileOf(p.x), tileOf(p.y));
        if (!(length > 0)) continue;
        const glm::dvec2 across = glm::dvec2(-d.y, d.x) / length;
        const double reach = kReachCells * length / cells + 0.5 * double(kTileSide);
        const int rows = 1 + int(reach / kTileSide);
        for (int r = 1; r <= rows; ++r)
            for (const double sign : {-1.0, 1.0}) {
                const glm::dvec2 q = p + across * (sign * reach * r / rows);
                if (charts.inTile(tileOf(q.x), tileOf(q.y), chart))
                    lists.add(tileOf(q.x), tileOf(q.y));
            }
    }
}

}  // namespace

void bakeSamples(const Surface& surface, const CoarseMesh& coarse, const BurnDomain& domain,
                 RefineModel& model) {
    const Charts charts(surface, domain);
    for (uint32_t s = 0; s < model.slots.size(); ++s) sample(domain, charts, s, model);
    const auto cornerUv = [&](uint32_t triangle, uint32_t k) {
        const CoarseTriangle& t = coarse.triangles[triangle];
        return uvAt(surface.triangles[t.source], t.weight[k]);
    };
    TileLists lists(domain, model.memory);
    for (uint32_t e = 0; e < model.edges.size(); ++e) {
        for (uint32_t o = model.ownerStart[e]; o < model.ownerStart[e + 1]; ++o) {
            const uint32_t triangle = model.owners[o] >> 2, side = model.owners[o] & 3;
            sideTiles(cornerUv(triangle, side), cornerUv(triangle, (side + 1) % 3),
                      double(1u << (model.edges[e].flags & 15)),
                      charts.of(model.triangles[triangle].source), charts, lists);
        }
        lists.close();
    }
    for (uint32_t i = 0; i < model.triangles.size(); ++i) {
        const glm::dvec2 uv[3] = {cornerUv(i, 0), cornerUv(i, 1), cornerUv(i, 2)};
        trianglesTiles(uv, lists);
    }
    lists.invert(model);
}

}  // namespace fw::mesh
