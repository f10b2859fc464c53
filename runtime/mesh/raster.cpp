// Texels from triangles: the triangle that holds a texel's centre owns the texel; parts too thin
// for a centre are forced. Clipping gives exact areas, whichever triangle owns the texel.
#include "mesh/texels.h"

#include <cmath>

namespace fw::mesh {
namespace {

struct Part {  // a piece of a triangle in a texel that its chart does not own
    uint32_t texel, triangle;
    double area;  // m^2
};

// Tells texels wholly in or out of a triangle from those that must be clipped.
class TriangleSides {
 public:
    explicit TriangleSides(const Triangle& t) {
        const double sign = uvArea(t) < 0 ? -1 : 1;
        for (int e = 0; e < 3; ++e) {
            const glm::dvec2 d = (t.uv[(e + 1) % 3] - t.uv[e]) * sign;
            side_[e] = {-d.y, d.x, cross2(d, -t.uv[e])};
            reach_[e] = 0.5 * (std::abs(d.x) + std::abs(d.y));
        }
    }
    // -1: the texel at x, y is outside, 1: inside, 0: neither is certain.
    [[nodiscard]] int classify(int x, int y) const {
        bool inside = true;
        for (int e = 0; e < 3; ++e) {
            const double middle = side_[e].x * (x + 0.5) + side_[e].y * (y + 0.5) + side_[e].z;
            if (middle < -reach_[e] - kSlack) return -1;
            inside &= middle > reach_[e] + kSlack;
        }
        return inside ? 1 : 0;
    }

 private:
    static constexpr double kSlack = 1e-9;  // texels^2, above the rounding
    glm::dvec3 side_[3];
    double reach_[3];
};

// Area in texels^2 of a triangle within the texel at x, y.
double clippedArea(const Triangle& t, int x, int y) {
    glm::dvec2 from[12], to[12];
    int count = 3;
    for (int k = 0; k < 3; ++k) from[k] = t.uv[k] - glm::dvec2(x, y);
    for (int edge = 0; edge < 4 && count > 0; ++edge) {
        const auto inside = [edge](glm::dvec2 p) {
            return edge == 0 ? p.x : edge == 1 ? 1 - p.x : edge == 2 ? p.y : 1 - p.y;
        };
        int kept = 0;
        for (int i = 0; i < count; ++i) {
            const glm::dvec2 p = from[i], q = from[(i + 1) % count];
            const double a = inside(p), b = inside(q);
            if (a >= 0) to[kept++] = p;
            if ((a > 0) != (b > 0) && a != b) to[kept++] = p + (q - p) * (a / (a - b));
        }
        count = kept;
        FW_ASSERT(count <= 12, "%d corners", count);
        std::copy(to, to + count, from);
    }
    double sum = 0;
    for (int i = 0; i < count; ++i) sum += cross2(from[i], from[(i + 1) % count]);
    return std::abs(sum) / 2;
}

// Weights of the point of the triangle closest, in the atlas, to a point outside it.
glm::dvec3 closestWeights(const Triangle& t, glm::dvec2 p) {
    glm::dvec3 weights(1, 0, 0);
    if (weightsAt(t, p, weights) && weights.x >= 0 && weights.y >= 0 && weights.z >= 0)
        return weights;
    double nearest = 1e300;
    for (int e = 0; e < 3; ++e) {
        const glm::dvec2 a = t.uv[e], d = t.uv[(e + 1) % 3] - a;
        const double dd = glm::dot(d, d);
        const double s = dd > 0 ? std::clamp(glm::dot(p - a, d) / dd, 0.0, 1.0) : 0;
        const double distance = glm::length(a + d * s - p);
        if (distance >= nearest) continue;
        nearest = distance;
        weights = glm::dvec3(0);
        weights[e] = 1 - s;
        weights[(e + 1) % 3] = s;
    }
    return weights;
}

struct Rasteriser {
    const Surface& surface;
    TexelGrid& grid;
    BakeReport& report;
    std::pmr::vector<Part> parts{grid.memory};

    void run() {
        ownTexels();
        measureAreas();
        forceTexels();
        giveParts();
        placeTexels();
    }

    void ownTexels() {
        for (uint32_t i = 0; i < surface.triangles.size(); ++i) {
            const Triangle& t = surface.triangles[i];
            eachTouched(t, grid.width, grid.height, [&](int x, int y) {
                glm::dvec3 w;
                if (!weightsAt(t, {x + 0.5, y + 0.5}, w)) return;
                if (std::min({w.x, w.y, w.z}) < -1e-9) return;
                const uint32_t texel = grid.at(x, y);
                if (grid.owner[texel] == kNone)
                    own(texel, i, w);
                else if (std::min({w.x, w.y, w.z}) > 1e-6)
                    ++report.overlaps;
            });
        }
    }

    void own(uint32_t texel, uint32_t triangle, glm::dvec3 weights) {
        FW_ASSERT(texel < grid.count() && triangle < surface.triangles.size(), "texel %u, %u",
                  texel, triangle);
        grid.owner[texel] = triangle;
        grid.chart[texel] = surface.triangles[triangle].chart;
        grid.weights[texel] = glm::vec2(float(weights.x), float(weights.y));
        grid.flags[texel] = kTexelReal;
    }

    void measureAreas() {
        for (uint32_t i = 0; i < surface.triangles.size(); ++i) {
            const Triangle& t = surface.triangles[i];
            const double flat = std::abs(uvArea(t));
            if (flat < 1e-9) {  // no area in the atlas: all of it is one part, at its first corner
                const glm::dvec2 at = t.uv[0];
                const int x = std::clamp(int(at.x), 0, int(grid.width) - 1);
                const int y = std::clamp(int(at.y), 0, int(grid.height) - 1);
                parts.push_back({grid.at(x, y), i, t.area});
                continue;
            }
            const TriangleSides sides(t);
            eachTouched(t, grid.width, grid.height, [&](int x, int y) {
                const int place = sides.classify(x, y);
                if (place < 0) return;
                const double area = (place > 0 ? 1 : clippedArea(t, x, y)) * (t.area / flat);
                if (!(area > 0)) return;
                const uint32_t texel = grid.at(x, y);
                if (grid.chart[texel] == t.chart)
                    grid.area[texel] += area;
                else
                    parts.push_back({texel, i, area});
            });
        }
        std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
            if (a.texel != b.texel) return a.texel < b.texel;
            return a.area != b.area ? a.area > b.area : a.triangle < b.triangle;
        });
    }

    // A part whose chart owns no texel beside it would not burn: it gets its texel. All parts are
    // decided from the same state, so that their order does not matter.
    void forceTexels() {
        std::pmr::vector<Part> forced(grid.memory);
        for (const Part& part : parts) {
            if (grid.owner[part.texel] != kNone) continue;
            if (!forced.empty() && forced.back().texel == part.texel) continue;
            bool beside = false;
            for (size_t k = 0; k < 8; k += 2)
                if (const uint32_t texel = grid.inImage(part.texel, k); texel != kNone)
                    beside |= grid.chart[texel] == surface.triangles[part.triangle].chart;
            if (!beside) forced.push_back(part);
        }
        for (const Part& part : forced) {
            const glm::dvec2 middle = glm::dvec2(grid.placeOf(part.texel)) + 0.5;
            own(part.texel, part.triangle,
                closestWeights(surface.triangles[part.triangle], middle));
            grid.flags[part.texel] |= kTexelForced;
        }
    }

    void giveParts() {
        std::pmr::vector<uint32_t> heirOf(surface.chartCount, kNone, grid.memory);
        AreaHeir heir(surface, grid);
        for (const Part& part : parts) {
            const uint32_t chart = surface.triangles[part.triangle].chart;
            FW_ASSERT(chart < heirOf.size(), "chart %u of %zu", chart, heirOf.size());
            const glm::ivec2 middle = grid.placeOf(part.texel);
            uint32_t best = kNone;
            int nearest = 1 << 30;
            grid.around(middle, 3, [&](uint32_t texel, glm::ivec2 at) {
                const glm::ivec2 d = at - middle;
                const int square = d.x * d.x + d.y * d.y;
                if (grid.chart[texel] != chart || square >= nearest) return;
                nearest = square;
                best = texel;
            });
            if (best == kNone) {
                if (heirOf[chart] == kNone)
                    heirOf[chart] = heir.anywhere(part.triangle, part.texel);
                best = heirOf[chart];
            }
            if (best != kNone) grid.area[best] += part.area;
        }
    }

    void placeTexels() {
        for (uint32_t texel = 0; texel < grid.count(); ++texel)
            if (grid.owner[texel] != kNone)
                grid.position[texel] = glm::vec3(
                    positionAt(surface.triangles[grid.owner[texel]], grid.weightsOf(texel)) -
                    surface.low);
    }
};

}  // namespace

AreaHeir::AreaHeir(const Surface& surface, const TexelGrid& grid)
    : surface_(surface),
      grid_(grid),
      texelOf_(surface.triangles.size(), kNone, grid.memory),
      visited_(surface.triangles.size(), 0, grid.memory) {
    for (uint32_t texel = 0; texel < grid.count(); ++texel)
        if (grid.owner[texel] != kNone) texelOf_[grid.owner[texel]] = texel;
}

uint32_t AreaHeir::onSurface(uint32_t from) {
    FW_ASSERT(from < visited_.size(), "triangle %u of %zu", from, visited_.size());
    ++stamp_;
    queue_.assign(1, from);
    visited_[from] = stamp_;
    for (size_t head = 0; head < queue_.size() && visitsLeft_ > 0; ++head, --visitsLeft_) {
        const uint32_t texel = texelOf_[queue_[head]];
        if (texel != kNone && grid_.real(texel)) return texel;
        for (uint32_t n : surface_.triangles[queue_[head]].neighbour)
            if (n != kNone && visited_[n] != stamp_) {
                visited_[n] = stamp_;
                queue_.push_back(n);
            }
    }
    return kNone;
}

uint32_t AreaHeir::anywhere(uint32_t from, uint32_t hint) {
    const uint32_t near = onSurface(from);
    if (near != kNone) return near;
    // No texel on this piece of the surface: the nearest in the image, by rings of growing size.
    const int x = int(hint % grid_.width), y = int(hint / grid_.width);
    for (int r = 0; r < int(std::max(grid_.width, grid_.height)); ++r)
        for (int dy = -r; dy <= r; ++dy)
            for (int dx = -r; dx <= r; dx += std::abs(dy) == r ? 1 : std::max(1, 2 * r)) {
                if (!grid_.inside(x + dx, y + dy)) continue;
                const uint32_t texel = grid_.at(x + dx, y + dy);
                if (grid_.real(texel)) return texel;
            }
    return kNone;
}

TexelGrid rasterise(const Surface& surface, const AtlasPlan& plan, BakeReport& report) {
    FW_ASSERT(plan.density > 0 && plan.width % kTileSide == 0 && plan.height % kTileSide == 0,
              "%u x %u texels at %g per m", plan.width, plan.height, plan.density);
    TexelGrid grid(surface.memory);
    grid.width = plan.width;
    grid.height = plan.height;
    grid.side = 1 / plan.density;
    const uint32_t count = grid.count();
    for (auto* texels : {&grid.owner, &grid.chart, &grid.linkRecord}) texels->assign(count, kNone);
    grid.position.assign(count, glm::vec3(0));
    grid.weights.assign(count, glm::vec2(0));
    grid.area.assign(count, 0);
    grid.flags.assign(count, 0);
    grid.shapes.reserve(surface.triangles.size());
    for (const Triangle& t : surface.triangles) grid.shapes.push_back(texelShape(t));
    Rasteriser{surface, grid, report}.run();
    return grid;
}

}  // namespace fw::mesh
