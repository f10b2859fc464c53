// Packs charts of any outline: each falls onto the skyline of the earlier ones, tallest first.
#include "core/error.h"
#include "mesh/atlas.h"

#include <cmath>

namespace fw::mesh {
namespace {

constexpr int kEmpty = 0x3FFFFFFF;
constexpr int kTurns = 16;  // orientations tried per chart, over a quarter turn
// Ratio between densities that are tried, and the ratio after kPlaces places.
constexpr double kStep = 1.015, kWideStep = 1.2;
constexpr double kPlaces = 3e8;

struct Piece {
    glm::dvec2 size{0};  // m
    uint32_t chart = 0;
    uint32_t columns = 0;   // texels, with one free texel around
    uint32_t profile = 0;   // into bottoms and tops
    int height = 0;         // texels, likewise
    uint32_t x = 0, y = 0;  // placed here
};

glm::dvec2 turned(glm::dvec2 u, glm::dvec2 cosSin) {
    return {u.x * cosSin.x - u.y * cosSin.y, u.x * cosSin.y + u.y * cosSin.x};
}

// Turns a chart so that its box is smallest and upright, and moves it to the origin. Returns the
// box's size.
glm::dvec2 orient(Surface& surface, std::span<const uint32_t> members) {
    FW_ASSERT(!members.empty());
    glm::dvec2 bestCosSin(1, 0);
    double bestArea = 1e300;
    for (int turn = 0; turn < kTurns; ++turn) {
        const double s = double(turn) / kTurns;  // tangent of the half angle: no libm needed
        const glm::dvec2 cs((1 - s * s) / (1 + s * s), 2 * s / (1 + s * s));
        Extent2 extent;
        for (uint32_t i : members)
            for (const glm::dvec2& u : surface.triangles[i].uv) extent.add(turned(u, cs));
        const glm::dvec2 size = extent.size();
        const double area = size.x * size.y;
        if (area >= bestArea * (1 - 1e-9)) continue;
        bestArea = area;
        bestCosSin = cs;
        if (size.x > size.y) bestCosSin = {-cs.y, cs.x};  // a quarter turn more
    }
    for (uint32_t i : members)
        for (glm::dvec2& u : surface.triangles[i].uv) u = turned(u, bestCosSin);
    const Extent2 extent = extentOf(surface, members);
    for (uint32_t i : members)
        for (glm::dvec2& u : surface.triangles[i].uv) u -= extent.low;
    return extent.size();
}

class Packer {
 public:
    Packer(Surface& surface, uint32_t charts)
        : surface_(surface), groups_(groupByChart(surface, charts)) {
        for (uint32_t c = 0; c < charts; ++c)
            if (!groups_.of(c).empty()) pieces_.push_back({orient(surface, groups_.of(c)), c});
        std::sort(pieces_.begin(), pieces_.end(), [](const Piece& a, const Piece& b) {
            return a.size.y != b.size.y ? a.size.y > b.size.y : a.chart < b.chart;
        });
    }

    [[nodiscard]] size_t pieces() const { return pieces_.size(); }

    // Column outlines of all charts at this density. Returns their texels, borders included.
    double outline(double density) {
        FW_ASSERT(density > 0, "%g texels per m", density);
        bottoms_.clear();
        tops_.clear();
        double cells = 0;
        widest_ = tallest_ = 0;
        for (Piece& piece : pieces_) {
            const uint32_t inner = uint32_t(piece.size.x * density) + 1;
            plainBottoms_.assign(inner, kEmpty);
            plainTops_.assign(inner, -kEmpty);
            for (uint32_t i : groups_.of(piece.chart))
                for (int e = 0; e < 3; ++e)
                    traceEdge(surface_.triangles[i].uv[e] * density,
                              surface_.triangles[i].uv[(e + 1) % 3] * density);
            piece.columns = inner + 2;
            piece.profile = uint32_t(bottoms_.size());
            piece.height = 0;
            for (int c = -1; c <= int(inner); ++c) {  // one texel wider all around; origin at 1, 1
                int bottom = kEmpty, top = -kEmpty;
                for (int n = std::max(0, c - 1); n <= std::min(int(inner) - 1, c + 1); ++n) {
                    bottom = std::min(bottom, plainBottoms_[size_t(n)]);
                    top = std::max(top, plainTops_[size_t(n)] + 2);
                }
                bottoms_.push_back(bottom);
                tops_.push_back(top);
                piece.height = std::max(piece.height, top + 1);
                if (top >= bottom) cells += top - bottom + 1;
            }
            widest_ = std::max(widest_, piece.columns);
            tallest_ = std::max(tallest_, uint32_t(piece.height));
        }
        return cells;
    }

    [[nodiscard]] double longest() const {  // m; pieces stand upright
        return pieces_.empty() ? 0 : pieces_.front().size.y;
    }
    [[nodiscard]] uint32_t widest() const { return widest_ + 2; }
    [[nodiscard]] uint32_t tallest() const { return tallest_ + 2; }

    // Drops all pieces into a strip of this width. Returns the strip's height.
    uint32_t drop(uint32_t width) {
        FW_ASSERT(widest() <= width, "a piece of %u columns, a strip of %u", widest(), width);
        skyline_.assign(width, 1);
        int used = 0;
        for (Piece& piece : pieces_) {
            const int* bottoms = &bottoms_[piece.profile];
            const int* tops = &tops_[piece.profile];
            const int columns = int(piece.columns);
            int bestY = kEmpty, bestX = -1;
            int64_t bestWaste = 0;
            for (int x = 1; x + columns < int(width); ++x) {  // widest() leaves room for one
                int y = 1;
                for (int c = 0; c < columns && y <= bestY; ++c)
                    y = std::max(y, skyline_[size_t(x + c)] - bottoms[c]);
                if (y > bestY) continue;
                int64_t waste = 0;
                for (int c = 0; c < columns; ++c)
                    if (tops[c] >= bottoms[c]) waste += y + bottoms[c] - skyline_[size_t(x + c)];
                if (y == bestY && waste >= bestWaste) continue;
                bestY = y;
                bestX = x;
                bestWaste = waste;
            }
            FW_ASSERT(bestX >= 1 && bestY < kEmpty, "at %d, %d", bestX, bestY);
            piece.x = uint32_t(bestX);
            piece.y = uint32_t(bestY);
            for (int c = 0; c < columns; ++c)
                if (tops[c] >= bottoms[c]) skyline_[size_t(bestX + c)] = bestY + tops[c] + 1;
            used = std::max(used, bestY + piece.height + 1);
        }
        return uint32_t(used);
    }

    void commit(double density) {
        for (const Piece& piece : pieces_)
            for (uint32_t i : groups_.of(piece.chart))
                for (glm::dvec2& u : surface_.triangles[i].uv)
                    u = u * density + glm::dvec2(piece.x + 1, piece.y + 1);
    }

 private:
    // Widens the plain outline by the texels that the segment a-b touches.
    void traceEdge(glm::dvec2 a, glm::dvec2 b) {
        FW_ASSERT(!plainBottoms_.empty() && plainBottoms_.size() == plainTops_.size());
        if (a.x > b.x) std::swap(a, b);
        const int last = int(plainBottoms_.size()) - 1;
        const int c0 = std::clamp(int(std::floor(a.x)), 0, last);
        const int c1 = std::clamp(int(std::floor(b.x)), 0, last);
        const double slope = b.x > a.x ? (b.y - a.y) / (b.x - a.x) : 0;
        for (int c = c0; c <= c1; ++c) {
            const double enter = c == c0 ? a.y : a.y + (c - a.x) * slope;
            const double leave = c == c1 ? b.y : a.y + (c + 1 - a.x) * slope;
            int& bottom = plainBottoms_[size_t(c)];
            int& top = plainTops_[size_t(c)];
            bottom = std::min(bottom, int(std::floor(std::max(0.0, std::min(enter, leave)))));
            top = std::max(top, int(std::floor(std::max(0.0, std::max(enter, leave)))));
        }
    }

    Surface& surface_;
    Groups groups_;
    std::pmr::vector<Piece> pieces_{surface_.memory};
    std::pmr::vector<int> bottoms_{surface_.memory}, tops_{surface_.memory};
    std::pmr::vector<int> plainBottoms_{surface_.memory}, plainTops_{surface_.memory};
    std::pmr::vector<int> skyline_{surface_.memory};
    uint32_t widest_ = 0, tallest_ = 0;
};

}  // namespace

AtlasPlan packCharts(Surface& surface, uint32_t charts, double density, uint32_t maxSide) {
    Packer packer(surface, charts);
    const uint32_t side = maxSide & ~7u;
    const double room = double(side) * side;
    // A chart takes at least nine texels: one and its border.
    const double least = 9.0 * double(packer.pieces());
    // An upper bound first, so that absurd sizes cost no memory.
    density = std::min({density, double(side) / std::sqrt(surface.area),
                        (double(side) - 4) / std::max(packer.longest(), 1e-9)});
    double places = 0;
    for (int attempt = 0; attempt < 100 && least <= room; ++attempt) {
        const double cells = packer.outline(density);
        double over = std::max(
            {cells / room, double(packer.widest()) / side, double(packer.tallest()) / side});
        if (over <= 1) {
            const uint32_t square = uint32_t(std::sqrt(cells * 1.12)) + 4;
            const uint32_t narrow =
                std::min(side, std::max(roundUp8(packer.widest()), roundUp8(square)));
            for (uint32_t width : {narrow, side}) {
                const uint32_t height = roundUp8(packer.drop(width));
                places += double(packer.pieces()) * width;
                over = double(height) / side;
                if (over > 1 && width < side) continue;
                if (over > 1) break;  // both widths may be the same
                packer.commit(density);
                return {.width = width, .height = height, .density = density};
            }
        }
        // Height shrinks with the square of the density, until only borders are left.
        density /= std::clamp(std::sqrt(over), places < kPlaces ? kStep : kWideStep, 2.0);
    }
    core::refuse("The mesh falls into %zu charts; an atlas of %u x %u texels has no room for them.",
                 packer.pieces(), side, side);
}

}  // namespace fw::mesh
