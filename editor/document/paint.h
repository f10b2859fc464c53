// Painting on a mesh. The brush is a ball in space, so a stroke crosses the seams of the unwrap.
// Works on the texels of the baked burn map.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "document/scene.h"

namespace fwedit {

struct Seam {  // an edge where the unwrap is cut; its other side is a separate seam
    std::array<float, 2> from{}, to{};  // texels
    Vec3 fromPosition{}, toPosition{};  // m, object space
};

// Surface positions of the burn map's texels; from the bake, see paintSurfaceOf in burn.h.
struct PaintSurface {
    uint32_t width = 0, height = 0;  // texels
    std::vector<float> positions;    // 3 per texel, m, object space
    std::vector<float> normals;      // 3 per texel, unit
    std::vector<uint8_t> real;       // 1: a texel of the surface
    std::vector<uint32_t> island;    // island of the unwrap, from 0; ~0u: no surface
    std::vector<uint32_t> piece;     // connected parts of the surface, across seams
    std::vector<uint8_t> material;   // slot
    float spacing = 0;               // m between texels
    uint32_t islands = 0;
    // Drawn geometry, three corners per triangle: position (m, object space), burn map position
    // (texels).
    std::vector<float> corners;
    std::vector<Seam> seams;
    // Spatial index of the texels for the brush; see indexSurface.
    Vec3 low{};
    float cell = 0;  // m
    std::array<uint32_t, 3> cells{};
    std::vector<uint32_t> cellBegin, cellTexels;
};
// Sorts the texels into grid cells. Without it, a brush visits every texel.
void indexSurface(PaintSurface& surface);

// Values of a layer over the burn map, in tiles that undo steps share. Multiplier: 128 neutral, 0
// never burns, 255 twice as fast. Moisture: 255 is 100 %. Material: preset + 1; 0: the mesh's
// material.
struct PaintImage {
    static constexpr uint32_t kTile = 64;  // px
    using Tile = std::array<uint8_t, kTile * kTile>;
    uint32_t width = 0, height = 0;
    uint8_t empty = 0;                               // value of a missing tile
    std::vector<std::shared_ptr<const Tile>> tiles;  // null: the whole tile is `empty`

    [[nodiscard]] uint8_t at(uint32_t x, uint32_t y) const;
    [[nodiscard]] std::vector<uint8_t> flat() const;
    bool operator==(const PaintImage&) const;
};
PaintImage makePaintImage(uint32_t kind, uint32_t width, uint32_t height);
PaintImage paintImageOf(uint32_t kind, uint32_t width, uint32_t height,
                        std::span<const uint8_t> values);
PaintImage resizedPaint(const PaintImage& image, uint32_t kind, uint32_t width, uint32_t height);
uint8_t emptyValue(uint32_t kind);

enum class BrushMode : uint32_t { Paint, Erase, Smooth };
struct Stroke {
    BrushMode mode = BrushMode::Paint;
    float size = 0.05f;         // m, radius, object space
    float value = 0;            // multiplier 0..2, moisture 0..1, material preset
    float strength = 1;         // [0, 1]
    float hardness = 0.5f;      // [0, 1]: share of the radius with full strength
    bool mirror = false;        // mirrored at the object's x = 0
    std::vector<Vec3> path;     // m, object space, on the surface
    std::vector<Vec3> normals;  // one per point of the path, or none: thin walls are then painted
                                // on both sides
    bool operator==(const Stroke&) const = default;
};
enum class FillBy : uint32_t { All, Island, Piece, Material, Slope, Curvature };
struct FillRequest {
    FillBy by = FillBy::All;
    float value = 0;
    Vec3 at{};                           // for Island, Piece: a point on it, m, object space
    uint32_t material = 0;               // slot, for Material
    float slopeLow = 0, slopeHigh = 90;  // degrees from horizontal, for Slope
    // 1/m, for Curvature: inverse bend radius, > 0 convex as at edges, < 0 concave.
    float curveLow = 5, curveHigh = 10000;
    bool operator==(const FillRequest&) const = default;
};

// Range of changed texels [x0, x1) x [y0, y1); empty: none.
struct PaintedArea {
    uint32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    [[nodiscard]] bool empty() const { return x0 >= x1 || y0 >= y1; }
};

// An incremental stroke: begin, extend with each brush move, end with the resulting image. The
// result does not depend on the number of calls.
class StrokePainter {
 public:
    StrokePainter(const PaintSurface& surface, uint32_t kind, const PaintImage& image,
                  const Stroke& brush);  // brush.path is ignored
    PaintedArea extend(Vec3 position, const Vec3* normal = nullptr);
    [[nodiscard]] PaintImage image() const;
    [[nodiscard]] std::span<const uint8_t> values() const { return values_; }  // width x height

 private:
    void sweep(const Vec3& from, const Vec3& to, const Vec3* fromNormal, const Vec3* toNormal,
               PaintedArea& area);
    [[nodiscard]] uint8_t smoothed(size_t texel) const;
    const PaintSurface& surface_;
    uint32_t kind_;
    PaintImage before_;
    Stroke brush_;
    std::vector<uint8_t> values_;
    std::vector<uint8_t> original_;  // for a smoothing stroke
    std::vector<float> cover_;       // coverage of the stroke so far, [0, 1]
};

PaintImage applyStroke(const PaintSurface& surface, uint32_t kind, const PaintImage& image,
                       const Stroke& stroke);
PaintImage applyFill(const PaintSurface& surface, uint32_t kind, const PaintImage& image,
                     const FillRequest& fill, Vec3 up);
// Returns the texel nearest to a point; width * height if there is none.
size_t nearestTexel(const PaintSurface& surface, Vec3 position);

}  // namespace fwedit
