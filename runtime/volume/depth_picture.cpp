// Depths to patches, and the search for the nearest patch around a point.
#include "volume/depth_picture.h"

#include "core/assert.h"
#include "core/error.h"

#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cmath>

namespace fw::volume {
namespace {

constexpr float kFarthest = 1e5f;  // m, largest clip w of a surface
constexpr float kGrazing = 0.03f;  // cosine to the camera; below it the slope is unknown
// Thickness of surfaces, of the reach: a point further behind is not inside.
constexpr float kThick = 0.1f;
// Distances in texels of the search around the point's own texel, eight texels a ring; and then of
// the search around the best of them.
constexpr int kRings[] = {1, 2, 4, 8, 16, 32};
constexpr int kCloser[] = {8, 4, 2, 1};
constexpr int kAround[8][2] = {{1, 0},  {1, 1},   {0, 1},  {-1, 1},
                               {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
constexpr float kStraight = 0.8f;  // least cosine between two steps along one surface
constexpr float kPatch = 0.6f;     // half side of a patch, of the distance to the next texel
// Steps of the search for a shelf over the reach, and its bisections.
constexpr int kShelfSteps = 12, kShelfCloser = 4;
constexpr float kShelfLevel = 0.5f;   // least upward part of a shelf's normal
constexpr float kShelfInside = 0.7f;  // of its thickness: gas below that leaves downwards

bool finite(const glm::mat4& m) noexcept {
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r)
            if (!std::isfinite(m[c][r])) return false;
    return true;
}

// The step to the neighbouring place along a row or column; `before` and `after`: texels on each
// side. At an edge the nearer neighbour counts, if the surface continues straight on either side of
// the step. Zero: unknown.
vec3 slopeAt(const DepthPicture& picture, uint32_t at, uint32_t step, uint32_t before,
             uint32_t after) noexcept {
    const auto between = [&](uint32_t from, uint32_t to, vec3& out) {
        const DepthTexel &a = picture.texels[from], &b = picture.texels[to];
        out = b.place - a.place;
        return a.shown && b.shown;
    };
    FW_ASSERT(at < picture.texels.size(), "texel %u", at);
    vec3 steps[4];  // from two before it to two after
    const bool there[4] = {before > 1 && between(at - 2 * step, at - step, steps[0]),
                           before > 0 && between(at - step, at, steps[1]),
                           after > 0 && between(at, at + step, steps[2]),
                           after > 1 && between(at + step, at + 2 * step, steps[3])};
    vec3 slope(0.0f);
    float least = 1e30f;
    for (const int k : {1, 2}) {
        const float length = glm::length(steps[k]);
        if (!there[k] || length >= least) continue;
        const auto goesOn = [&](int other) {
            return there[other] && glm::dot(steps[other], steps[k]) >
                                       kStraight * glm::length(steps[other]) * length;
        };
        if (!goesOn(k - 1) && !goesOn(k + 1)) continue;
        least = length;
        slope = steps[k];
    }
    return slope;
}

struct Nearest {
    float away = 1e9f;  // m
    int column = 0, row = 0;
    Surface surface;
};

// Keeps the texel's patch if it is the nearest so far. `behind`: the camera does not see the point.
bool meet(const DepthTexel& texel, float reach, vec3 point, bool behind,
          Nearest& nearest) noexcept {
    if (!texel.known) return false;
    const vec3 off = point - texel.place;
    const float above = glm::dot(off, texel.normal);
    // A visible point is inside nothing, however far a patch reaches.
    if (above < (behind ? -kThick * reach : 0.0f)) return false;
    vec3 beside = off - above * texel.normal;
    for (const vec3& side : {texel.across, texel.down})
        beside -= side * std::clamp(glm::dot(beside, side) / glm::dot(side, side), -kPatch, kPatch);
    const float away = std::sqrt(above * above + glm::dot(beside, beside));
    if (away > reach || away >= nearest.away) return false;
    nearest.away = away;
    if (above < 0.0f || away < 1e-6f)
        nearest.surface = {above, texel.normal};
    else
        nearest.surface = {away, (above * texel.normal + beside) / away};
    return true;
}

// The texel at a point from the camera; null: the point is beside the picture.
const DepthTexel* texelAt(const DepthPicture& picture, vec3 off, int& column, int& row) noexcept {
    const vec4 clip = picture.toClip * vec4(off, 1.0f);
    if (!(clip.w > 1e-6f)) return nullptr;
    const float x = (0.5f * clip.x / clip.w + 0.5f) * float(picture.columns);
    const float y = (0.5f * clip.y / clip.w + 0.5f) * float(picture.rows);
    if (!(x >= 0.0f && y >= 0.0f && x < float(picture.columns) && y < float(picture.rows)))
        return nullptr;
    column = int(x), row = int(y);
    FW_ASSERT(picture.texels.size() == size_t(picture.columns) * picture.rows);
    return &picture.texels[size_t(row) * picture.columns + size_t(column)];
}

bool isBehind(const DepthTexel& texel, vec3 off) noexcept {
    return texel.known && glm::dot(off - texel.place, texel.normal) < 0.0f;
}

// Keeps the underside of a shelf over a point: a surface seen from above whose room below is also
// visible. The underside lies kThick below the top, or where the visible room ends. Ground has no
// such room.
void meetShelf(const DepthPicture& picture, float reach, vec3 off, Nearest& nearest) noexcept {
    const vec3 step(0.0f, reach / float(kShelfSteps), 0.0f);
    const auto hides = [&](vec3 at, const DepthTexel*& texel) {
        int column, row;
        texel = texelAt(picture, at, column, row);
        return texel && isBehind(*texel, at);
    };
    const DepthTexel* texel = nullptr;  // of the last point
    bool hidden = hides(off, texel);
    int up = 1;
    for (; up <= kShelfSteps; ++up) {
        const bool before = hidden;
        hidden = hides(off + float(up) * step, texel);
        if (!texel) return;
        if (before && !hidden) break;
    }
    if (up > kShelfSteps) return;
    // Bisects to the top: from higher points, rays to the camera pass over surfaces behind it.
    vec3 over = off + float(up) * step, under = over - step;
    for (int k = 0; k < kShelfCloser; ++k) {
        const DepthTexel* at = nullptr;
        const vec3 middle = 0.5f * (over + under);
        if (hides(middle, at)) {
            under = middle;
        } else {
            over = middle;
            texel = at;
        }
        if (!at) return;
    }
    if (!texel->known || texel->normal.y < kShelfLevel) return;
    const float top = over.y - glm::dot(over - texel->place, texel->normal) / texel->normal.y;
    if (over.y - top > step.y) return;  // the texel shows a surface far behind
    float room = 1e9f;
    for (int down = up - 1; down >= up - 2 * kShelfSteps && room == 1e9f; --down) {
        const vec3 at = off + float(down) * step;
        const bool covered = hides(at, texel);
        if (!texel) return;
        if (!covered && at.y < top) room = at.y;
    }
    if (room == 1e9f) return;
    const float thick = std::min(kThick * reach, top - room);
    const float below = top - thick - off.y;
    if (below < -kShelfInside * thick || below >= nearest.away) return;
    nearest.away = std::abs(below);
    nearest.surface = {below, vec3(0.0f, -1.0f, 0.0f)};
}

}  // namespace

void setDepthPicture(DepthPicture& picture, std::span<const float> depths, uint32_t columns,
                     uint32_t rows, const float view[16], const float projection[16]) {
    const glm::mat4 toView = glm::make_mat4(view), toScreen = glm::make_mat4(projection);
    const glm::mat3 rotation(toView);  // rigid: the inverse is the transpose
    const glm::mat4 toClip = toScreen * glm::mat4(rotation);
    const glm::mat4 fromClip = glm::inverse(toClip);
    if (!finite(toView) || !finite(toClip) || !finite(fromClip))
        core::refuse("view and projection of the picture of depth have no inverse.");
    FW_ASSERT(depths.size() == size_t(columns) * rows, "%zu depths, %u x %u texels", depths.size(),
              columns, rows);
    picture.texels.resize(size_t(columns) * rows);
    picture.columns = columns;
    picture.rows = rows;
    picture.eye = -(glm::transpose(rotation) * vec3(toView[3]));
    picture.toClip = toClip;
    for (uint32_t row = 0; row < rows; ++row)
        for (uint32_t column = 0; column < columns; ++column) {
            const size_t at = size_t(row) * columns + column;
            const vec4 clip(2.0f * (float(column) + 0.5f) / float(columns) - 1.0f,
                            2.0f * (float(row) + 0.5f) / float(rows) - 1.0f, depths[at], 1.0f);
            const vec4 there = fromClip * clip;
            DepthTexel& texel = picture.texels[at];
            texel = {};
            if (!(there.w > 1.0f / kFarthest)) continue;  // the background
            texel.place = vec3(there) / there.w;
            texel.shown = true;
        }
    // The direction in which clip w grows, whatever the host's view space.
    const float side = toScreen[2][3] > 0.0f ? 1.0f : -1.0f;
    const vec3 forward = side * vec3(rotation[0][2], rotation[1][2], rotation[2][2]);
    const bool perspective = toScreen[2][3] != 0.0f;
    for (uint32_t row = 0; row < rows; ++row)
        for (uint32_t column = 0; column < columns; ++column) {
            const uint32_t at = row * columns + column;
            DepthTexel& texel = picture.texels[at];
            if (!texel.shown) continue;
            const vec3 x = slopeAt(picture, at, 1, column, columns - 1 - column);
            const vec3 y = slopeAt(picture, at, columns, row, rows - 1 - row);
            const vec3 ray = perspective ? texel.place : forward;
            const vec3 normal = glm::cross(x, y);
            const float size = glm::length(normal) * glm::length(ray);
            const float facing = size > 0.0f ? glm::dot(normal, ray) / size : 0.0f;
            if (!(std::abs(facing) > kGrazing)) continue;
            texel.normal = glm::normalize(facing > 0.0f ? -normal : normal);
            texel.across = x;
            texel.down = y;
            texel.known = true;
        }
}

Surface surfaceOf(const DepthPicture& picture, float reach, vec3 point) noexcept {
    const vec3 off = point - picture.eye;
    int column = 0, row = 0;
    const DepthTexel* own = texelAt(picture, off, column, row);
    if (!own) return {};
    const bool behind = isBehind(*own, off);
    Nearest nearest;
    const auto look = [&](int i, int j) {
        if (i < 0 || j < 0 || i >= int(picture.columns) || j >= int(picture.rows)) return;
        const DepthTexel& texel = picture.texels[size_t(j) * picture.columns + size_t(i)];
        if (meet(texel, reach, off, behind, nearest)) nearest.column = i, nearest.row = j;
    };
    look(column, row);
    for (const int ring : kRings)
        for (const auto& off2 : kAround) look(column + ring * off2[0], row + ring * off2[1]);
    if (nearest.away <= reach)
        for (const int ring : kCloser) {
            const int i = nearest.column, j = nearest.row;
            for (const auto& off2 : kAround) look(i + ring * off2[0], j + ring * off2[1]);
        }
    meetShelf(picture, reach, off, nearest);
    return nearest.away <= reach ? nearest.surface : Surface{};
}

}  // namespace fw::volume
