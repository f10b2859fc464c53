// Ring links: the texels that a texel reads across cuts of the atlas. A walk over the surface by
// one texel step finds them, never the texel's neighbours in the image. A walk that ends between
// texels gets the texel within two links that is nearest to its end.
#include "mesh/texels.h"

#include <cmath>

namespace fw::mesh {
namespace {

constexpr int kWalkSteps = 200;  // triangles crossed by one walk, at most
constexpr int kWeakSteps = 4;    // likewise, once the crossings below are used up
// Crossings of all walks, and the further ones per texel of the atlas. Only meshes with triangles
// hundreds of times smaller than a texel use them up.
constexpr int64_t kWalkBudget = 1 << 25, kWalkPerTexel = 8;
constexpr int kUnlinkedRounds = 64;   // searches for texels that read no other
constexpr int kReaches = 3;           // a chart too small to own a texel is stepped over
constexpr int kLandingSearch = 3;     // texels around a landing place that owns none
constexpr double kStepLimit = 3;      // texel sides: a longer Jacobian step is cut
constexpr double kFoldedSlack = 1.5;  // texel sides: a link longer than 2 steps + this is refused
constexpr double kAimLow = 1, kAimHigh = 1.5;  // texel sides: how far from a texel its aims lie
constexpr double kMissLimit = 1.5;             // texel sides: a link may miss its aim by less

struct Walk {
    uint32_t triangle;
    glm::dvec3 weights;
    bool landed = false, open = false;
    int crossed = 0;  // triangles
};

glm::dvec3 unitOr0(glm::dvec3 v) { return unitOr(v, glm::dvec3(0)); }

// From a point of a triangle along a step in its plane (m), unfolding at every edge by in-plane
// direction: winding does not matter.
Walk walkSurface(const Surface& surface, uint32_t triangle, glm::dvec3 weights, glm::dvec3 step,
                 int limit) {
    Walk walk{triangle, weights};
    glm::dvec3& w = walk.weights;
    int entry = -1;
    for (; walk.crossed < limit; ++walk.crossed) {
        const Triangle& t = surface.triangles[walk.triangle];
        const glm::dvec3 normal =
            glm::cross(t.position[1] - t.position[0], t.position[2] - t.position[0]);
        FW_ASSERT(walk.triangle < surface.triangles.size(), "triangle %u", walk.triangle);
        const double square = glm::dot(normal, normal);
        double change[3], until = 1;
        int exit = -1;  // the corner opposite the edge through which we leave
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 edge = t.position[(k + 2) % 3] - t.position[(k + 1) % 3];
            change[k] = glm::dot(glm::cross(normal, edge), step) / square;
            if (!(change[k] < -1e-15) || (k + 1) % 3 == entry) continue;
            const double when = std::max(0.0, -w[k] / change[k]);
            if (when >= until) continue;
            until = when;
            exit = k;
        }
        for (int k = 0; k < 3; ++k) w[k] += change[k] * until;
        if (exit < 0) {
            w = glm::max(w, glm::dvec3(0));
            w /= w.x + w.y + w.z;
            walk.landed = true;
            return walk;
        }
        const int e = (exit + 1) % 3, a = e, b = (e + 1) % 3;
        step *= 1 - until;
        if (t.neighbour[e] == kNone) {
            walk.open = true;
            return walk;
        }
        const double along = std::clamp(w[b] / std::max(1e-30, w[a] + w[b]), 0.0, 1.0);
        const Triangle& other = surface.triangles[t.neighbour[e]];
        const int f = t.neighbourEdge[e];
        int fa = f, fb = (f + 1) % 3;
        if (other.point[fa] != t.point[a]) std::swap(fa, fb);
        const glm::dvec3 edge = unitOr0(t.position[b] - t.position[a]);
        glm::dvec3 outward = t.position[exit] - t.position[a];
        outward = -unitOr0(outward - edge * glm::dot(outward, edge));
        glm::dvec3 inward = other.position[3 - fa - fb] - other.position[fa];
        inward = unitOr0(inward - edge * glm::dot(inward, edge));
        step = edge * glm::dot(step, edge) + inward * std::max(0.0, glm::dot(step, outward));
        w = glm::dvec3(0);
        w[fa] = 1 - along;
        w[fb] = along;
        walk.triangle = t.neighbour[e];
        entry = f;
    }
    return walk;
}

// Chart borders in the atlas, by the texels that they pass.
class Borders {
 public:
    Borders(const Surface& surface, const TexelGrid& grid)
        : surface_(surface), grid_(grid), near_(grid.count(), 0, grid.memory) {
        for (uint32_t i = 0; i < surface.triangles.size(); ++i)
            for (uint32_t e = 0; e < 3; ++e)
                if (const Triangle& t = surface.triangles[i]; t.neighbour[e] == kNone || t.seam[e])
                    add(t.uv[e], t.uv[(e + 1) % 3], i * 3 + e);
        std::sort(pieces_.begin(), pieces_.end());
        for (const Piece& piece : pieces_)
            grid.around(grid.placeOf(piece.texel), 1,
                        [&](uint32_t texel, glm::ivec2) { near_[texel] = 1; });
    }

    [[nodiscard]] bool near(uint32_t texel) const { return near_[texel] != 0; }

    // Whether the segment between the centres of two neighbouring texels crosses a border.
    [[nodiscard]] bool between(uint32_t i, uint32_t j) const {
        const glm::ivec2 from = grid_.placeOf(i), to = grid_.placeOf(j);
        const glm::dvec2 p = glm::dvec2(from) + 0.5, q = glm::dvec2(to) + 0.5;
        const glm::ivec2 low = glm::min(from, to), high = glm::max(from, to);
        for (int y = low.y; y <= high.y; ++y)
            for (int x = low.x; x <= high.x; ++x)
                if (crossedIn(grid_.at(x, y), p, q)) return true;
        return false;
    }

 private:
    struct Piece {
        uint32_t texel, edge;  // triangle * 3 + its edge; millions of these: no copies
        auto operator<=>(const Piece&) const = default;
    };

    void add(glm::dvec2 a, glm::dvec2 b, uint32_t edge) {
        const int samples = 2 + int(4 * glm::length(b - a));
        uint32_t last = kNone;
        for (int k = 0; k <= samples; ++k) {
            const glm::dvec2 p = a + (b - a) * (double(k) / samples);
            if (!grid_.inside(int(std::floor(p.x)), int(std::floor(p.y)))) continue;
            const uint32_t texel = grid_.at(int(p.x), int(p.y));
            if (texel != last) pieces_.push_back({texel, edge});
            last = texel;
        }
    }

    [[nodiscard]] bool crossedIn(uint32_t texel, glm::dvec2 p, glm::dvec2 q) const {
        auto piece = std::lower_bound(pieces_.begin(), pieces_.end(), texel,
                                      [](const Piece& a, uint32_t b) { return a.texel < b; });
        for (; piece != pieces_.end() && piece->texel == texel; ++piece) {
            const Triangle& t = surface_.triangles[piece->edge / 3];
            const glm::dvec2 from = t.uv[piece->edge % 3], to = t.uv[(piece->edge + 1) % 3];
            const double a = cross2(q - p, from - p), b = cross2(q - p, to - p);
            const glm::dvec2 d = to - from;
            const double c = cross2(d, p - from), e = cross2(d, q - from);
            if (((a > 0) != (b > 0)) && ((c > 0) != (e > 0))) return true;
        }
        return false;
    }

    const Surface& surface_;
    const TexelGrid& grid_;
    std::pmr::vector<Piece> pieces_{grid_.memory};
    std::pmr::vector<uint8_t> near_;
};

struct Linker {
    const Surface& surface;
    TexelGrid& grid;
    BakeReport& report;
    Borders borders{surface, grid};
    std::pmr::vector<uint8_t> looseSlots{grid.memory};  // per record: the step ends in no texel
    std::pmr::vector<uint8_t> dependents{
        grid.memory};  // per texel: slots that name it, at most 255
    int64_t crossingsLeft = kWalkBudget + kWalkPerTexel * int64_t(grid.count());

    void run() {
        eachReal([&](uint32_t texel) { linkOne(texel); });
        dropUnlinked();
        eachReal([&](uint32_t texel) {
            if (isRim(texel)) tighten(texel);
        });
        eachReal([&](uint32_t texel) {
            if (isRim(texel)) answerDependents(texel);
        });
        countDependents();
        eachReal([&](uint32_t texel) {
            if (dependents[texel] == 0) findDependent(texel);
        });
        measure();
    }

    template <class Visit>
    void eachReal(Visit visit) const {
        for (uint32_t texel = 0; texel < grid.count(); ++texel)
            if (grid.real(texel)) visit(texel);
    }
    // Calls visit(other) for the texels that a real texel reads.
    template <class Visit>
    void eachRead(uint32_t texel, Visit visit) const {
        for (int k = 0; k < 8; ++k)
            if (const uint32_t other = grid.ring(texel, k); other != kNone) visit(other);
    }
    [[nodiscard]] bool isRim(uint32_t texel) const {
        return grid.real(texel) && grid.linkRecord[texel] != kNone;
    }
    [[nodiscard]] uint32_t* ringOf(uint32_t rimTexel) const {
        FW_ASSERT(size_t(grid.linkRecord[rimTexel]) * 8 + 7 < grid.links.size(), "record %u",
                  grid.linkRecord[rimTexel]);
        return &grid.links[size_t(grid.linkRecord[rimTexel]) * 8];
    }

    // One texel step in ring direction k, in metres on the texel's own triangle, from the texel's
    // point. The point of a forced texel is off its centre, and the centres around would not lie on
    // all sides of it.
    [[nodiscard]] glm::dvec3 stepOf(uint32_t texel, size_t k) const {
        FW_ASSERT(grid.owner[texel] < grid.shapes.size(), "owner of texel %u", texel);
        const double x = kRingX[k], y = kRingY[k];
        const TexelShape& shape = grid.shapes[grid.owner[texel]];
        if (shape.usable) return shape.alongU * x + shape.alongV * y;
        const Triangle& t = surface.triangles[grid.owner[texel]];  // no Jacobian: an even step
        const glm::dvec3 u = unitOr0(t.position[1] - t.position[0]);
        return (u * x + glm::cross(t.normal, u) * y) * grid.side;
    }

    [[nodiscard]] bool plain(uint32_t i, uint32_t j, size_t k) const {
        if (j == kNone || !grid.real(j) || grid.chart[j] != grid.chart[i]) return false;
        if ((grid.flags[i] | grid.flags[j]) & kTexelForced) return false;
        if (borders.near(i) && borders.between(i, j)) return false;
        // Sheets of a folded chart lie side by side in the image and far apart in space.
        const double length = grid.distance(i, j);
        if (length <= kFoldedSlack * grid.side) return true;
        const double reach =
            std::max(glm::length(stepOf(i, k)), glm::length(stepOf(j, (k + 4) & 7)));
        return length <= 2 * reach + kFoldedSlack * grid.side;
    }

    void linkOne(uint32_t texel) {
        uint32_t ring[8];
        uint8_t loose = 0;
        bool rim = false;
        for (size_t k = 0; k < 8; ++k) {
            ring[k] = grid.inImage(texel, k);
            if (plain(texel, ring[k], k)) continue;
            rim = true;
            bool exact = false;
            ring[k] = across(texel, k, exact);
            if (!exact) loose = uint8_t(loose | 1u << k);
        }
        if (!rim) return;
        FW_ASSERT(looseSlots.size() == grid.links.size() / 8, "%zu records, %zu links",
                  looseSlots.size(), grid.links.size());
        looseSlots.push_back(loose);
        grid.linkRecord[texel] = uint32_t(grid.links.size() / 8);
        grid.flags[texel] |= kTexelRim;
        grid.links.insert(grid.links.end(), ring, ring + 8);
    }

    Walk walkFrom(uint32_t texel, glm::dvec3 step) {
        const Walk walk = walkSurface(surface, grid.owner[texel], grid.weightsOf(texel), step,
                                      crossingsLeft > 0 ? kWalkSteps : kWeakSteps);
        crossingsLeft -= walk.crossed + 1;
        return walk;
    }

    // The texel one step away over the surface, or kNone. `exact`: the step ends in that texel.
    uint32_t across(uint32_t texel, size_t k, bool& exact) {
        glm::dvec3 step = stepOf(texel, k);
        if (const double length = glm::length(step); length > kStepLimit * grid.side)
            step *= kStepLimit * grid.side / length;
        bool open = false;
        for (int reach = 1; reach <= kReaches; ++reach) {
            const Walk walk = walkFrom(texel, step * double(reach));
            open |= walk.open;
            if (!walk.landed) break;
            const uint32_t found = landing(walk, texel, exact);
            exact &= reach == 1;
            if (found == texel) break;
            if (found == kNone) continue;
            const double limit = 2 * reach * glm::length(step) + kFoldedSlack * grid.side;
            if (grid.distance(texel, found) > limit) break;
            return found;
        }
        ++(open ? report.linksOpen : report.linksLost);
        return kNone;
    }

    // The real texel of the landing chart at, or nearest in space to, the landing point.
    [[nodiscard]] uint32_t landing(const Walk& walk, uint32_t self, bool& exact) const {
        const Triangle& t = surface.triangles[walk.triangle];
        const glm::dvec2 uv = uvAt(t, walk.weights);
        const int x = int(std::floor(uv.x)), y = int(std::floor(uv.y));
        exact =
            grid.inside(x, y) && grid.real(grid.at(x, y)) && grid.chart[grid.at(x, y)] == t.chart;
        if (exact) return grid.at(x, y);
        const glm::dvec3 point = positionAt(t, walk.weights) - surface.low;
        uint32_t best = kNone;
        double nearest = 36 * grid.side * grid.side;
        for (int r = 1; r <= kLandingSearch && best == kNone; ++r)
            grid.around({x, y}, r, [&](uint32_t texel, glm::ivec2) {
                if (texel == self || !grid.real(texel) || grid.chart[texel] != t.chart) return;
                const glm::dvec3 d = glm::dvec3(grid.position[texel]) - point;
                if (glm::dot(d, d) >= nearest) return;
                nearest = glm::dot(d, d);
                best = texel;
            });
        return best;
    }

    // A forced texel that reads no other could never burn: it leaves, and a neighbour takes its
    // area. A texel alone on its piece of the surface (a leaf) stays: other objects may light it.
    void dropUnlinked() {
        AreaHeir heir(surface, grid);
        std::pmr::vector<uint32_t> forced(grid.memory);
        for (uint32_t i = 0; i < grid.count(); ++i)
            if (grid.real(i) && (grid.flags[i] & kTexelForced)) forced.push_back(i);
        bool again = true;  // a texel that read only leaving ones leaves in the next round
        for (int round = 0; again && round < kUnlinkedRounds; ++round) {
            again = false;
            for (uint32_t i : forced) {
                if (!grid.real(i)) continue;
                bool linked = false;
                eachRead(i, [&](uint32_t j) { linked |= grid.real(j); });
                if (linked) continue;
                const uint16_t flags = grid.flags[i];
                grid.flags[i] = 0;
                const uint32_t to = heir.onSurface(grid.owner[i]);
                if (to == kNone) {
                    grid.flags[i] = flags;
                    continue;
                }
                grid.area[to] += grid.area[i];
                grid.area[i] = 0;
                grid.owner[i] = grid.chart[i] = kNone;
                again = true;
            }
        }
        for (uint32_t& link : grid.links)
            if (link != kNone && !grid.real(link)) link = kNone;
    }

    // The place that a slot of a texel's ring should lead to: the end of a walk of about one texel
    // side, whatever the texel's shape, so that the ring lies evenly around the texel.
    struct Aim {
        glm::dvec3 point{0};  // m, from Surface::low
        double reach = 0;     // m, a longer link is refused
        bool landed = false;
    };
    [[nodiscard]] Aim aimOf(uint32_t texel, size_t k) {
        glm::dvec3 step = stepOf(texel, k);
        const double length = glm::length(step);
        if (!(length > 0)) return {};
        step *= std::clamp(length, kAimLow * grid.side, kAimHigh * grid.side) / length;
        const Walk walk = walkFrom(texel, step);
        if (!walk.landed) return {};
        return {positionAt(surface.triangles[walk.triangle], walk.weights) - surface.low,
                2 * glm::length(step) + kFoldedSlack * grid.side, true};
    }
    [[nodiscard]] double missOf(const Aim& aim, uint32_t texel) const {
        return glm::length(glm::dvec3(grid.position[texel]) - aim.point);
    }

    // Slots whose step ends in no texel, or in the texel of another slot, take the free texel
    // nearest to their aim. A ring that misses a direction would notice fronts from there late.
    void tighten(uint32_t i) {
        uint32_t* ring = ringOf(i);
        for (size_t k = 0; k < 8; ++k) {
            const bool shared = ring[k] != kNone && std::count(ring, ring + 8, ring[k]) > 1;
            if (!shared && (looseSlots[grid.linkRecord[i]] >> k & 1) == 0) continue;
            const Aim aim = aimOf(i, k);
            if (!aim.landed) continue;
            double least = kMissLimit * grid.side;
            if (ring[k] != kNone && !shared) least = std::min(least, missOf(aim, ring[k]));
            uint32_t best = kNone;
            for (int a = 0; a < 8; ++a)
                for (int b = 0; ring[a] != kNone && b < 8; ++b) {
                    const uint32_t texel = grid.ring(ring[a], b);
                    if (texel == kNone || texel == i || missOf(aim, texel) >= least ||
                        std::find(ring, ring + 8, texel) != ring + 8 ||
                        grid.distance(i, texel) > aim.reach)
                        continue;
                    least = missOf(aim, texel);
                    best = texel;
                }
            if (best != kNone) ring[k] = best;
        }
    }

    // If i reads j and j, a rim texel, does not read i: i takes a spare slot of j, beside the ring
    // neighbour nearest to i.
    void answerDependents(uint32_t i) {
        eachRead(i, [&](uint32_t j) {
            if (!isRim(j)) return;
            uint32_t* ring = ringOf(j);
            if (std::find(ring, ring + 8, i) != ring + 8) return;
            int slot = -1;
            double nearest = 2 * grid.side;
            for (int q = 0; q < 8; ++q) {
                const bool spare = ring[q] == kNone || std::count(ring, ring + 8, ring[q]) > 1;
                for (int beside : {1, 7}) {
                    const uint32_t neighbour = ring[(q + beside) & 7];
                    if (!spare || neighbour == kNone) continue;
                    const double distance = grid.distance(neighbour, i);
                    if (distance >= nearest) continue;
                    nearest = distance;
                    slot = q;
                }
            }
            if (slot >= 0) ring[slot] = i;
        });
    }

    void countDependents() {
        dependents.assign(grid.count(), 0);
        eachReal([&](uint32_t i) {
            eachRead(
                i, [&](uint32_t j) { dependents[j] = uint8_t(std::min(dependents[j] + 1, 255)); });
        });
    }

    // For a texel i that no other reads, where a fire would stay: among the texels that i reads,
    // the slot with the nearest aim takes i instead of a texel that others read too.
    void findDependent(uint32_t i) {
        double least = kMissLimit * grid.side;
        uint32_t* slot = nullptr;
        eachRead(i, [&](uint32_t j) {
            if (!isRim(j)) return;
            uint32_t* ring = ringOf(j);
            for (size_t q = 0; q < 8; ++q) {
                if (ring[q] != kNone && dependents[ring[q]] < 2) continue;
                const Aim aim = aimOf(j, q);
                if (!aim.landed || grid.distance(i, j) > aim.reach) continue;
                const double loss = missOf(aim, i) - (ring[q] == kNone ? 0 : missOf(aim, ring[q]));
                if (loss >= least) continue;
                least = loss;
                slot = &ring[q];
            }
        });
        if (slot == nullptr) return;
        FW_ASSERT(*slot == kNone || dependents[*slot] > 1, "texel %u would lose its only reader",
                  *slot);
        if (*slot != kNone) --dependents[*slot];
        *slot = i;
        ++dependents[i];
    }

    void measure() {
        double shortest = 1e300, longest = 0;
        eachReal([&](uint32_t i) {
            ++report.realTexels;
            report.forcedTexels += (grid.flags[i] & kTexelForced) != 0;
            report.rimTexels += (grid.flags[i] & kTexelRim) != 0;
            report.withoutDependents += dependents[i] == 0;
            eachRead(i, [&](uint32_t j) {
                shortest = std::min(shortest, grid.distance(i, j));
                longest = std::max(longest, grid.distance(i, j));
            });
        });
        FW_ASSERT(shortest >= 0 && longest < 1e12, "links of %g to %g m", shortest, longest);
        grid.linkMax = longest;
        report.linkMin = longest > 0 ? shortest / grid.side : 0;
        report.linkMax = longest / grid.side;
    }
};

}  // namespace

void linkTexels(const Surface& surface, TexelGrid& grid, BakeReport& report) {
    Linker{surface, grid, report}.run();
}

}  // namespace fw::mesh
