// The bake's texel grid while the bake fills it: owner, place and links of each texel. Internal to
// runtime/mesh.
#pragma once
#include "mesh/atlas.h"

namespace fw::mesh {

constexpr double kLongestLink = 8000;  // units; below the front's limit of 8191

struct TexelGrid {
    explicit TexelGrid(std::pmr::memory_resource* of) : memory(of) {}

    std::pmr::memory_resource* memory;
    uint32_t width = 0, height = 0;
    double side = 0;  // m, nominal texel

    std::pmr::vector<uint32_t> owner{memory};       // triangle, or kNone
    std::pmr::vector<uint32_t> chart{memory};       // or kNone
    std::pmr::vector<glm::vec3> position{memory};   // m, from Surface::low
    std::pmr::vector<glm::vec2> weights{memory};    // of the owner's corners 0 and 1
    std::pmr::vector<double> area{memory};          // m^2
    std::pmr::vector<uint16_t> flags{memory};       // TexelFlag; only texels with kTexelReal count
    std::pmr::vector<TexelShape> shapes{memory};    // per triangle
    std::pmr::vector<uint32_t> linkRecord{memory};  // per texel: record in links, or kNone
    std::pmr::vector<uint32_t> links{memory};       // 8 per record, raster order
    double linkMax = 0;                             // m, longest link of all, set by linkTexels

    [[nodiscard]] uint32_t count() const { return width * height; }
    [[nodiscard]] bool inside(int x, int y) const {
        return x >= 0 && y >= 0 && x < int(width) && y < int(height);
    }
    [[nodiscard]] uint32_t at(int x, int y) const {
        FW_ASSERT(inside(x, y), "texel (%d, %d) of %u x %u", x, y, width, height);
        return uint32_t(y) * width + uint32_t(x);
    }
    [[nodiscard]] glm::ivec2 placeOf(uint32_t texel) const {
        return {int(texel % width), int(texel / width)};
    }
    // The k-th texel around another in the image, or kNone.
    [[nodiscard]] uint32_t inImage(uint32_t texel, size_t k) const {
        const glm::ivec2 at = placeOf(texel) + glm::ivec2(kRingX[k], kRingY[k]);
        return inside(at.x, at.y) ? this->at(at.x, at.y) : kNone;
    }
    // Calls visit(texel, place) for the texels of the image at most `reach` from a place.
    template <class Visit>
    void around(glm::ivec2 middle, int reach, Visit visit) const {
        for (int y = middle.y - reach; y <= middle.y + reach; ++y)
            for (int x = middle.x - reach; x <= middle.x + reach; ++x)
                if (inside(x, y)) visit(at(x, y), glm::ivec2(x, y));
    }
    [[nodiscard]] bool real(uint32_t texel) const {
        FW_ASSERT(texel < flags.size(), "%u of %zu texels", texel, flags.size());
        return (flags[texel] & kTexelReal) != 0;
    }
    [[nodiscard]] glm::dvec3 weightsOf(uint32_t texel) const {
        FW_ASSERT(owner[texel] != kNone, "texel %u has no owner", texel);
        const glm::dvec2 w(weights[texel]);
        return {w.x, w.y, 1 - w.x - w.y};
    }
    [[nodiscard]] uint32_t ring(uint32_t texel, int k) const {
        FW_ASSERT(texel < linkRecord.size() && k >= 0 && k < 8, "texel %u, slot %d", texel, k);
        if (linkRecord[texel] != kNone) return links[size_t(linkRecord[texel]) * 8 + size_t(k)];
        return uint32_t(int(texel) + kRingY[size_t(k)] * int(width) + kRingX[size_t(k)]);
    }
    [[nodiscard]] double distance(uint32_t a, uint32_t b) const {
        FW_ASSERT(a < position.size() && b < position.size(), "texels %u and %u", a, b);
        return double(glm::length(position[a] - position[b]));
    }
};

// Texels, their owners, places and areas. Every part of the surface's area goes to some texel.
TexelGrid rasterise(const Surface& surface, const AtlasPlan& plan, BakeReport& report);
// Finds a texel for area whose chart has none: a texel nearby on the surface of triangle `from`, or
// (anywhere) the texel nearest to texel `hint` in the image. kNone if there is none.
class AreaHeir {
 public:
    AreaHeir(const Surface& surface, const TexelGrid& grid);
    uint32_t onSurface(uint32_t from);
    uint32_t anywhere(uint32_t from, uint32_t hint);

 private:
    const Surface& surface_;
    const TexelGrid& grid_;
    // By triangle: a texel of it; the last search that visited it.
    std::pmr::vector<uint32_t> texelOf_, visited_;
    std::pmr::vector<uint32_t> queue_{grid_.memory};
    uint32_t stamp_ = 0;
    // Limits the triangles that all searches visit; at 0 onSurface finds nothing. Where only few
    // triangles have texels, every search would cross the whole surface.
    uint32_t visitsLeft_ = 1u << 22;
};
// Link records of all texels whose ring differs from the image around them.
void linkTexels(const Surface& surface, TexelGrid& grid, BakeReport& report);
void bakeThickness(const Surface& surface, const TexelGrid& grid,
                   std::pmr::vector<uint16_t>& thickness);
void bakeSlowness(const BakeInput& input, const TexelGrid& grid, glm::dvec3 low, double extent,
                  std::pmr::vector<uint16_t>& slowness);
void buildTiles(const TexelGrid& grid, BurnDomain& domain);
void buildDrawn(const BakeInput& input, const Surface& surface, BurnDomain& domain);
// Bounds of every tile's real texels, for queries.
void buildTileBounds(BurnDomain& domain);
void buildFlameCells(BurnDomain& domain);
// Links parts that share no edge but come near each other: a roof on its walls, a cart's wheel.
void linkParts(BurnDomain& domain);
inline float floatAtLeast(double value) {
    const float near = float(value);
    return double(near) < value ? std::nextafter(near, 1e30f) : near;
}
// Signed 11:11:10; 1023, 1023, 511 are 1.
uint32_t packNormal(glm::dvec3 normal);
inline glm::dvec3 unpackNormal(uint32_t packed) {
    return {double(int(packed << 21) >> 21) / 1023, double(int(packed << 10) >> 21) / 1023,
            double(int(packed) >> 22) / 511};
}

}  // namespace fw::mesh
