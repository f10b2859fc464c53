// Volumetric flames as impostors: a flame is marched into pixels that are a part of its diameter
// wide, whatever its size on the screen. Some frames then show this picture, which faces the
// camera, at the flame's present place and size.
#include "core/assert.h"
#include "lod/tiers.h"
#include "lod/volumes.h"

#include <algorithm>
#include <cmath>

namespace fw::lod {
namespace {

constexpr float kImpostorPixels = 24.0f;  // of a flame's diameter, where its smoke leaves as many
constexpr float kGrows = 1.15f;           // cells, until they are few enough

// m per unit of the view at so many m along it.
vec2 metresAt(const VolumeDraw& draw, float depth) {
    const float away = draw.clip.z > 0.0f ? depth : 1.0f;
    return away * vec2(glm::length(vec3(draw.rayX)), glm::length(vec3(draw.rayY)));
}

// x, y of the view; m along it.
vec3 placeOf(const ViewParams& view, vec3 point) {
    const vec3 from = point - vec3(view.eye);
    const vec4 clip = from.x * view.clip0 + from.y * view.clip1 + from.z * view.clip2 + view.clip3;
    return {clip.x / clip.w, clip.y / clip.w, glm::dot(from, vec3(view.forward))};
}

}  // namespace

bool impostorFits(const VolumeItem& item) noexcept {
    return item.whole.x < item.whole.z && item.whole.y < item.whole.w && item.draw.front > 0.0f;
}

void placeImpostor(const ViewParams& view, const VolumeItem& item, const VolumeScreen& screen,
                   uint32_t slot, ImpostorShape& impostor, MarchedVolume& out) noexcept {
    const VolumeDraw& draw = item.draw;
    const vec3 at = placeOf(view, item.middle);
    const vec2 metres = metresAt(draw, at.z);
    const vec2 size = metres * vec2(item.whole.z - item.whole.x, item.whole.w - item.whole.y);
    FW_ASSERT(draw.wide > 0.0f && draw.spacing > 0.0f, "a flame %g m wide", double(draw.wide));
    float cell = draw.wide / kImpostorPixels;
    const auto tiles = [&](float length) {
        return std::max(std::ceil(length / (cell * float(kMarchTileSide))), 1.0f);
    };
    while (tiles(size.x) * tiles(size.y) > float(kMaxImpostorTiles)) cell *= kGrows;
    impostor.there = true;
    impostor.middle = item.middle - item.base;
    impostor.direction = glm::normalize(item.middle - vec3(view.eye));
    impostor.low = metres * (vec2(item.whole) - vec2(at));
    impostor.cell = cell;
    impostor.tilesX = uint32_t(tiles(size.x));
    impostor.tilesY = uint32_t(tiles(size.y));
    impostor.encoding = screen.encoding;

    const vec2 perCell = cell / metres;
    out.flame = item.flame;
    out.smokes = item.smokes;
    out.march = {};
    out.composite = {};
    MarchPush& march = out.march;
    march.rayX = vec4(perCell.x * vec3(draw.rayX), 0.0f);
    march.rayX.w = kFinestDetail * glm::length(vec3(march.rayX));
    march.turns = uint32_t(std::clamp(
        std::ceil(2.0f * draw.deep * float(draw.slabs) / draw.spacing), 1.0f, float(screen.steps)));
    march.rayY =
        vec4(perCell.y * vec3(draw.rayY), draw.deep * float(draw.slabs) / float(march.turns));
    march.rayO = vec4(vec3(draw.rayO) + (item.whole.x + 0.5f * perCell.x) * vec3(draw.rayX) +
                          (item.whole.y + 0.5f * perCell.y) * vec3(draw.rayY),
                      draw.front);
    march.slabs = 1;
    march.intervals = draw.intervals;
    march.tilesX = impostor.tilesX;
    march.pixels = impostor.tilesX * impostor.tilesY * kMarchTileSide * kMarchTileSide;
    march.tiles = slot * kImpostorWords;
    march.samples = march.tiles + kMaxImpostorTiles * kMarchTileWords;
    march.encoding = screen.encoding;
    march.apart = 2;
    march.least = 0;
    march.perPixel = kMarchTileSide;  // rays go where the mean of many is the flame
    out.composite.tilesX = impostor.tilesX;
    out.composite.tilesY = impostor.tilesY;
}

bool showImpostor(const ViewParams& view, const VolumeItem& item, const VolumeScreen& screen,
                  uint32_t slot, const ImpostorShape& impostor, VolumeImpostor& out) noexcept {
    const VolumeDraw& draw = item.draw;
    const vec3 at = placeOf(view, item.base + impostor.middle);
    if (draw.clip.z > 0.0f && !(at.z > 1e-3f)) return false;
    const vec2 perMetre = 1.0f / metresAt(draw, at.z);
    const vec2 perCell = impostor.cell * perMetre;
    out = {};
    out.place = vec4(vec2(at) + impostor.low * perMetre, perCell.x, 0.0f);
    out.upY = perCell.y;
    out.clip = draw.clip;
    out.front = draw.front;
    out.deep = draw.deep * float(draw.slabs);
    out.base = draw.base;
    out.perX = 2.0f / (screen.size.x * perCell.x);
    out.perY = 2.0f / (screen.size.y * perCell.y);
    out.tilesX = impostor.tilesX;
    out.tilesY = impostor.tilesY;
    out.samples = slot * kImpostorWords + kMaxImpostorTiles * kMarchTileWords;
    out.to = 1.0f;
    return true;
}

}  // namespace fw::lod
