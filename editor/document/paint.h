// Painting on a mesh: a brush is a ball in space, so that a stroke goes over the seams of the
// unwrap as over any other place. Works on the texels of the burn map as the plugin baked it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "document/scene.h"

namespace fwedit {

struct Seam {  // an edge at which the unwrap is cut; its other side is another seam
    std::array<float, 2> from{}, to{};  // texels
    Vec3 fromPosition{}, toPosition{};  // m, object space
};

// Where the texels of a mesh's burn map are on it; from the bake, see paintSurfaceOf in burn.h.
struct PaintSurface {
    uint32_t width = 0, height = 0;  // texels
    std::vector<float> positions;    // 3 per texel, m, object space
    std::vector<float> normals;      // 3 per texel, unit
    std::vector<uint8_t> real;       // 1: a texel of the surface
    std::vector<uint32_t> island;    // of the unwrap, from 0; ~0u where not real
    std::vector<uint32_t> piece;     // connected parts of the surface, across seams
    std::vector<uint8_t> material;   // slot
    float spacing = 0;               // m between texels
    uint32_t islands = 0;
    // What is drawn, three corners a triangle: position (m, object space), place (texels).
    std::vector<float> corners;
    std::vector<Seam> seams;
    // Texels by where they are, for the brush; see indexSurface.
    Vec3 low{};
    float cell = 0;  // m
    std::array<uint32_t, 3> cells{};
    std::vector<uint32_t> cellBegin, cellTexels;
};
// Sorts the texels into cells. Without it a brush looks at every texel.
void indexSurface(PaintSurface& surface);

// A layer's values over the burn map, in tiles that undo's steps share.
// Multiplier: 128 is as is, 0 never burns, 255 twice as fast. Moisture: 255 is 100 %. Material: the
// preset + 1, 0: as the mesh has it.
struct PaintImage {
    static constexpr uint32_t kTile = 64;  // px
    using Tile = std::array<uint8_t, kTile * kTile>;
    uint32_t width = 0, height = 0;
    uint8_t empty = 0;                               // value of a tile that is not there
    std::vector<std::shared_ptr<const Tile>> tiles;  // null: all `empty`

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
    float hardness = 0.5f;      // [0, 1]: share of the radius that gets all of it
    bool mirror = false;        // about the object's x = 0
    std::vector<Vec3> path;     // m, object space, on the surface
    std::vector<Vec3> normals;  // as many or none: then thin walls are painted on both sides
    bool operator==(const Stroke&) const = default;
};
enum class FillBy : uint32_t { All, Island, Piece, Material, Slope, Curvature };
struct FillRequest {
    FillBy by = FillBy::All;
    float value = 0;
    Vec3 at{};                           // of Island, Piece: a point on it, m, object space
    uint32_t material = 0;               // slot, of Material
    float slopeLow = 0, slopeHigh = 90;  // degrees from level ground, of Slope
    // 1/m, of Curvature: one over the radius of the bend, > 0 outwards as at edges, < 0 in hollows.
    float curveLow = 5, curveHigh = 10000;
    bool operator==(const FillRequest&) const = default;
};

// Texels [x0, x1) x [y0, y1) that changed; empty: none did.
struct PaintedArea {
    uint32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    [[nodiscard]] bool empty() const { return x0 >= x1 || y0 >= y1; }
};

// A stroke that grows: begin, extend with each move of the brush, end with the image it made. Its
// values do not depend on how many calls the path came in.
class StrokePainter {
 public:
    StrokePainter(const PaintSurface& surface, uint32_t kind, const PaintImage& image,
                  const Stroke& brush);  // brush.path is not used
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
    std::vector<uint8_t> original_;  // of a stroke that smooths
    std::vector<float> cover_;       // of the stroke so far, [0, 1]
};

PaintImage applyStroke(const PaintSurface& surface, uint32_t kind, const PaintImage& image,
                       const Stroke& stroke);
PaintImage applyFill(const PaintSurface& surface, uint32_t kind, const PaintImage& image,
                     const FillRequest& fill, Vec3 up);
// The texel nearest to a point, width * height if there is none.
size_t nearestTexel(const PaintSurface& surface, Vec3 position);

}  // namespace fwedit
