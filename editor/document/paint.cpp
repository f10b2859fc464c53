// See paint.h.
#include "document/paint.h"

#include <algorithm>
#include <cmath>

namespace fwedit {
namespace {

Vec3 minus(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

Vec3 at3(const std::vector<float>& list, size_t i) {
    return {list[i * 3], list[i * 3 + 1], list[i * 3 + 2]};
}

float distanceToSegment(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 ab = minus(b, a), ap = minus(p, a);
    const float square = dot(ab, ab);
    const float t = square > 0 ? std::clamp(dot(ap, ab) / square, 0.0f, 1.0f) : 0.0f;
    const Vec3 off = {ap[0] - t * ab[0], ap[1] - t * ab[1], ap[2] - t * ab[2]};
    return std::sqrt(dot(off, off));
}

// Calls `visit(texel)` for every surface texel within the box, and possibly for some outside.
template <typename Visit>
void forTexelsWithin(const PaintSurface& surface, const Vec3& low, const Vec3& high,
                     Visit&& visit) {
    if (surface.cellBegin.empty()) {
        for (size_t i = 0; i < surface.real.size(); ++i)
            if (surface.real[i]) visit(i);
        return;
    }
    std::array<uint32_t, 3> from{}, to{};
    for (size_t k = 0; k < 3; ++k) {
        const float last = static_cast<float>(surface.cells[k] - 1);
        const float a = std::floor((low[k] - surface.low[k]) / surface.cell);
        const float b = std::floor((high[k] - surface.low[k]) / surface.cell);
        if (!(b >= 0) || !(a <= last)) return;
        from[k] = static_cast<uint32_t>(std::max(a, 0.0f));
        to[k] = static_cast<uint32_t>(std::min(b, last));
    }
    for (uint32_t z = from[2]; z <= to[2]; ++z)
        for (uint32_t y = from[1]; y <= to[1]; ++y) {
            const size_t row = (size_t{z} * surface.cells[1] + y) * surface.cells[0];
            for (uint32_t i = surface.cellBegin[row + from[0]];
                 i < surface.cellBegin[row + to[0] + 1]; ++i)
                visit(surface.cellTexels[i]);
        }
}

uint8_t bytes(uint32_t kind, float value) {
    switch (kind) {
        case PaintMultiplier:
            return static_cast<uint8_t>(std::clamp(std::lround(value * 128), 0l, 255l));
        case PaintMoisture:
            return static_cast<uint8_t>(std::clamp(std::lround(value * 255), 0l, 255l));
        default:
            return static_cast<uint8_t>(std::clamp(std::lround(value) + 1, 0l, 14l));
    }
}

uint8_t blended(uint32_t kind, uint8_t before, float target, float share) {
    if (kind == PaintMaterial) return share >= 0.5f ? static_cast<uint8_t>(target) : before;
    const float from = static_cast<float>(before);
    return static_cast<uint8_t>(std::lround(from + (target - from) * share));
}

}  // namespace

uint8_t emptyValue(uint32_t kind) { return kind == PaintMultiplier ? 128 : 0; }

void indexSurface(PaintSurface& surface) {
    Vec3 low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};
    size_t count = 0;
    for (size_t i = 0; i < surface.real.size(); ++i) {
        if (!surface.real[i]) continue;
        ++count;
        for (size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], surface.positions[i * 3 + k]);
            high[k] = std::max(high[k], surface.positions[i * 3 + k]);
        }
    }
    surface.cellBegin.clear();
    surface.cellTexels.clear();
    if (count == 0) return;
    float longest = 0;
    for (size_t k = 0; k < 3; ++k) longest = std::max(longest, high[k] - low[k]);
    surface.low = low;
    surface.cell = std::max({8 * surface.spacing, longest / 128, 1e-6f});
    size_t cells = 1;
    for (size_t k = 0; k < 3; ++k) {
        surface.cells[k] = static_cast<uint32_t>((high[k] - low[k]) / surface.cell) + 1;
        cells *= surface.cells[k];
    }
    const auto cellOf = [&](size_t texel) {
        size_t at = 0;
        for (size_t k = 3; k-- > 0;) {
            const float along = (surface.positions[texel * 3 + k] - low[k]) / surface.cell;
            at = at * surface.cells[k] +
                 std::min(static_cast<uint32_t>(along), surface.cells[k] - 1);
        }
        return at;
    };
    surface.cellBegin.assign(cells + 1, 0);
    for (size_t i = 0; i < surface.real.size(); ++i)
        if (surface.real[i]) ++surface.cellBegin[cellOf(i) + 1];
    for (size_t i = 0; i < cells; ++i) surface.cellBegin[i + 1] += surface.cellBegin[i];
    std::vector<uint32_t> next(surface.cellBegin.begin(), surface.cellBegin.end() - 1);
    surface.cellTexels.resize(count);
    for (size_t i = 0; i < surface.real.size(); ++i)
        if (surface.real[i]) surface.cellTexels[next[cellOf(i)]++] = static_cast<uint32_t>(i);
}

uint8_t PaintImage::at(uint32_t x, uint32_t y) const {
    const uint32_t across = (width + kTile - 1) / kTile;
    const auto& tile = tiles[size_t{y / kTile} * across + x / kTile];
    return tile ? (*tile)[(y % kTile) * kTile + x % kTile] : empty;
}

std::vector<uint8_t> PaintImage::flat() const {
    std::vector<uint8_t> values(size_t{width} * height, empty);
    const uint32_t across = (width + kTile - 1) / kTile;
    for (size_t i = 0; i < tiles.size(); ++i) {
        if (!tiles[i]) continue;
        const uint32_t x0 = static_cast<uint32_t>(i % across) * kTile;
        const uint32_t y0 = static_cast<uint32_t>(i / across) * kTile;
        for (uint32_t y = y0; y < std::min(y0 + kTile, height); ++y)
            std::copy_n(tiles[i]->begin() + (y - y0) * kTile, std::min(kTile, width - x0),
                        values.begin() + static_cast<std::ptrdiff_t>(size_t{y} * width + x0));
    }
    return values;
}

bool PaintImage::operator==(const PaintImage& other) const {
    if (width != other.width || height != other.height || empty != other.empty ||
        tiles.size() != other.tiles.size())
        return false;
    for (size_t i = 0; i < tiles.size(); ++i) {
        if (tiles[i] == other.tiles[i]) continue;
        if (!tiles[i] || !other.tiles[i] || *tiles[i] != *other.tiles[i]) return false;
    }
    return true;
}

PaintImage makePaintImage(uint32_t kind, uint32_t width, uint32_t height) {
    PaintImage image;
    image.width = width;
    image.height = height;
    image.empty = emptyValue(kind);
    constexpr uint32_t tile = PaintImage::kTile;
    image.tiles.resize(size_t{(width + tile - 1) / tile} * ((height + tile - 1) / tile));
    return image;
}

namespace {

// Unchanged tiles stay shared with `before`.
PaintImage tiled(PaintImage before, std::span<const uint8_t> values) {
    constexpr uint32_t side = PaintImage::kTile;
    const uint32_t across = (before.width + side - 1) / side;
    for (size_t i = 0; i < before.tiles.size(); ++i) {
        const uint32_t x0 = static_cast<uint32_t>(i % across) * side;
        const uint32_t y0 = static_cast<uint32_t>(i / across) * side;
        PaintImage::Tile tile;
        tile.fill(before.empty);
        for (uint32_t y = y0; y < std::min(y0 + side, before.height); ++y)
            std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(size_t{y} * before.width + x0),
                        std::min(side, before.width - x0), tile.begin() + (y - y0) * side);
        const bool blank = std::all_of(tile.begin(), tile.end(),
                                       [&](uint8_t value) { return value == before.empty; });
        if (blank)
            before.tiles[i] = nullptr;
        else if (!before.tiles[i] || *before.tiles[i] != tile)
            before.tiles[i] = std::make_shared<const PaintImage::Tile>(tile);
    }
    return before;
}

}  // namespace

PaintImage paintImageOf(uint32_t kind, uint32_t width, uint32_t height,
                        std::span<const uint8_t> values) {
    return tiled(makePaintImage(kind, width, height), values);
}

PaintImage resizedPaint(const PaintImage& image, uint32_t kind, uint32_t width, uint32_t height) {
    if (image.width == 0) return makePaintImage(kind, width, height);
    std::vector<uint8_t> values(size_t{width} * height);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x)
            values[size_t{y} * width + x] =
                image.at(static_cast<uint32_t>(uint64_t{x} * image.width / width),
                         static_cast<uint32_t>(uint64_t{y} * image.height / height));
    return paintImageOf(kind, width, height, values);
}

StrokePainter::StrokePainter(const PaintSurface& surface, uint32_t kind, const PaintImage& image,
                             const Stroke& brush)
    : surface_(surface),
      kind_(kind),
      before_(image.width == surface.width && image.height == surface.height
                  ? image
                  : resizedPaint(image, kind, surface.width, surface.height)),
      brush_(brush),
      values_(before_.flat()),
      cover_(values_.size(), 0.0f) {
    brush_.path.clear();
    brush_.normals.clear();
    if (brush_.mode == BrushMode::Smooth) original_ = values_;
}

// Mean of the values before the stroke, around a texel on the surface, across seams.
uint8_t StrokePainter::smoothed(size_t texel) const {
    const Vec3 p = at3(surface_.positions, texel), n = at3(surface_.normals, texel);
    const float reach = std::max(0.25f * brush_.size, 2.5f * surface_.spacing);
    float sum = 0, weights = 0;
    std::array<float, 16> votes{};
    const Vec3 low = {p[0] - reach, p[1] - reach, p[2] - reach};
    const Vec3 high = {p[0] + reach, p[1] + reach, p[2] + reach};
    forTexelsWithin(surface_, low, high, [&](size_t other) {
        const Vec3 off = minus(at3(surface_.positions, other), p);
        const float far = std::sqrt(dot(off, off));
        if (far >= reach || dot(at3(surface_.normals, other), n) < -0.2f) return;
        const float weight = 1 - far / reach;
        sum += weight * static_cast<float>(original_[other]);
        weights += weight;
        votes[std::min<size_t>(original_[other], 15)] += weight;
    });
    if (weights <= 0) return original_[texel];
    if (kind_ == PaintMaterial)
        return static_cast<uint8_t>(std::max_element(votes.begin(), votes.end()) - votes.begin());
    return static_cast<uint8_t>(std::lround(sum / weights));
}

void StrokePainter::sweep(const Vec3& from, const Vec3& to, const Vec3* fromNormal,
                          const Vec3* toNormal, PaintedArea& area) {
    const float size = std::max(brush_.size, 0.6f * surface_.spacing);
    Vec3 low, high;
    for (size_t k = 0; k < 3; ++k) {
        low[k] = std::min(from[k], to[k]) - size;
        high[k] = std::max(from[k], to[k]) + size;
    }
    const float target = brush_.mode == BrushMode::Erase
                             ? static_cast<float>(emptyValue(kind_))
                             : static_cast<float>(bytes(kind_, brush_.value));
    forTexelsWithin(surface_, low, high, [&](size_t texel) {
        const float distance = distanceToSegment(at3(surface_.positions, texel), from, to);
        if (distance >= size) return;
        if (toNormal) {
            const Vec3 normal = at3(surface_.normals, texel);
            if (dot(normal, *toNormal) <= -0.1f && dot(normal, *fromNormal) <= -0.1f) return;
        }
        const float rim = size * brush_.hardness;
        float cover = 1;
        if (distance > rim) {
            const float t = 1 - (distance - rim) / (size - rim);
            cover = t * t * (3 - 2 * t);
        }
        if (cover <= cover_[texel]) return;
        cover_[texel] = cover;
        const auto x = static_cast<uint32_t>(texel % surface_.width);
        const auto y = static_cast<uint32_t>(texel / surface_.width);
        const float aim =
            brush_.mode == BrushMode::Smooth ? static_cast<float>(smoothed(texel)) : target;
        const uint8_t value = blended(kind_, before_.at(x, y), aim, cover * brush_.strength);
        if (value == values_[texel]) return;
        values_[texel] = value;
        if (area.empty()) area = {x, y, x + 1, y + 1};
        area = {std::min(area.x0, x), std::min(area.y0, y), std::max(area.x1, x + 1),
                std::max(area.y1, y + 1)};
    });
}

PaintedArea StrokePainter::extend(Vec3 position, const Vec3* normal) {
    PaintedArea area;
    const Vec3 from = brush_.path.empty() ? position : brush_.path.back();
    const Vec3 to = position;
    const Vec3 toNormal = normal ? *normal : Vec3{};
    const Vec3 fromNormal = brush_.normals.empty() ? toNormal : brush_.normals.back();
    sweep(from, to, normal ? &fromNormal : nullptr, normal ? &toNormal : nullptr, area);
    if (brush_.mirror) {
        const auto mirrored = [](Vec3 v) { return Vec3{-v[0], v[1], v[2]}; };
        const Vec3 a = mirrored(fromNormal), b = mirrored(toNormal);
        sweep(mirrored(from), mirrored(to), normal ? &a : nullptr, normal ? &b : nullptr, area);
    }
    brush_.path = {position};
    if (normal) brush_.normals = {*normal};
    return area;
}

PaintImage StrokePainter::image() const { return tiled(before_, values_); }

PaintImage applyStroke(const PaintSurface& surface, uint32_t kind, const PaintImage& image,
                       const Stroke& stroke) {
    StrokePainter painter(surface, kind, image, stroke);
    for (size_t i = 0; i < stroke.path.size(); ++i)
        painter.extend(stroke.path[i], stroke.normals.empty() ? nullptr : &stroke.normals[i]);
    return painter.image();
}

size_t nearestTexel(const PaintSurface& surface, Vec3 position) {
    size_t best = surface.real.size();
    float nearest = 1e30f;
    for (size_t i = 0; i < surface.real.size(); ++i) {
        if (!surface.real[i]) continue;
        const Vec3 off = minus(at3(surface.positions, i), position);
        const float square = dot(off, off);
        if (square < nearest) {
            nearest = square;
            best = i;
        }
    }
    return best;
}

namespace {

// Change of the normals around a texel per distance. At sharp edges the bend is limited by the
// texel spacing.
float curvatureAt(const PaintSurface& surface, size_t texel) {
    const Vec3 p = at3(surface.positions, texel), n = at3(surface.normals, texel);
    const float reach = 3 * surface.spacing;
    float sum = 0, count = 0;
    const Vec3 low = {p[0] - reach, p[1] - reach, p[2] - reach};
    const Vec3 high = {p[0] + reach, p[1] + reach, p[2] + reach};
    forTexelsWithin(surface, low, high, [&](size_t other) {
        const Vec3 offset = minus(at3(surface.positions, other), p);
        const float square = dot(offset, offset);
        const Vec3 normal = at3(surface.normals, other);
        // The back of a thin wall is not a bend of its front.
        if (square > reach * reach || square < 1e-12f || dot(normal, n) < -0.5f) return;
        sum += dot(minus(normal, n), offset) / square;
        ++count;
    });
    return count > 0 ? sum / count : 0;
}

}  // namespace

PaintImage applyFill(const PaintSurface& surface, uint32_t kind, const PaintImage& image,
                     const FillRequest& fill, Vec3 up) {
    PaintImage before = image.width == surface.width && image.height == surface.height
                            ? image
                            : resizedPaint(image, kind, surface.width, surface.height);
    std::vector<uint8_t> values = before.flat();
    const size_t seed =
        fill.by == FillBy::Island || fill.by == FillBy::Piece ? nearestTexel(surface, fill.at) : 0;
    const float length = std::sqrt(dot(up, up));
    const float low = std::cos(fill.slopeHigh * 0.017453292f);
    const float high = std::cos(fill.slopeLow * 0.017453292f);
    for (size_t i = 0; i < values.size(); ++i) {
        if (!surface.real[i]) continue;
        bool takes = true;
        switch (fill.by) {
            case FillBy::All:
                break;
            case FillBy::Island:
                takes = seed < values.size() && surface.island[i] == surface.island[seed];
                break;
            case FillBy::Piece:
                takes = seed < values.size() && surface.piece[i] == surface.piece[seed];
                break;
            case FillBy::Material:
                takes = surface.material[i] == fill.material;
                break;
            case FillBy::Slope: {
                const float level = dot(at3(surface.normals, i), up) / (length > 0 ? length : 1);
                takes = level >= low - 1e-5f && level <= high + 1e-5f;
                break;
            }
            case FillBy::Curvature: {
                const float bend = curvatureAt(surface, i);
                takes = bend >= fill.curveLow && bend <= fill.curveHigh;
                break;
            }
        }
        if (takes) values[i] = bytes(kind, fill.value);
    }
    return tiled(std::move(before), values);
}

}  // namespace fwedit
