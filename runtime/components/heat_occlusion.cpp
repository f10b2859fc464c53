#include "components/heat_occlusion.h"

#include "components/pose.h"
#include "components/wind_zone.h"
#include "core/assert.h"
#include "core/error.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace fw::components {
namespace {

constexpr float kMinOcclusionCell = 0.05f, kMaxOcclusionCell = 10;  // m
constexpr float kMaxOcclusionOrigin = 1e6f;                         // m
constexpr uint32_t kEmpty = 0xFFFFFFFFu;

int floorDiv(int value, int by) noexcept {
    return value >= 0 ? value / by : -((-value + by - 1) / by);
}

gpu::ExchangePush rulesOf(const OcclusionGridShape& shape) noexcept {
    gpu::ExchangePush rules{};
    rules.occlusionX = shape.origin[0];
    rules.occlusionY = shape.origin[1];
    rules.occlusionZ = shape.origin[2];
    rules.occlusionCell = shape.cell;
    rules.occlusionCounts = countsOf(shape);
    return rules;
}

gpu::ivec3 placeOf(const float place[3]) noexcept {  // mm
    return {wholePlace(double(place[0])), wholePlace(double(place[1])),
            wholePlace(double(place[2]))};
}

// The cells filled so far, and the distance of each cell's texel from its middle.
class OcclusionFill {
 public:
    OcclusionFill(const OcclusionGridShape& shape, std::pmr::vector<OcclusionCell>& out)
        : shape_(shape),
          out_(out),
          index_(shape.cells(), kEmpty, out.get_allocator()),
          nearest_(out.get_allocator()) {}

    // half: mm, reach of the texel along its surface, not through it. normal: Q12.
    void texel(const gpu::ivec3& at, const gpu::ivec3& normal, double half, uint32_t what,
               uint32_t texel) {
        const int side = int(shape_.cell);
        int low[3], high[3], middle[3];
        for (int i = 0; i < 3; ++i) {
            const double n = std::min(std::abs(double(normal[i])) / 4096, 1.0);
            const int reach = int(half * std::sqrt(1 - n * n));
            const int64_t off = int64_t(at[i]) - shape_.origin[size_t(i)];
            const int count = int(shape_.counts[size_t(i)]);
            if (off + reach < 0 || off - reach >= int64_t(count) * side) return;
            middle[i] = int(off);
            low[i] = std::max(floorDiv(middle[i] - reach, side), 0);
            high[i] = std::min(floorDiv(middle[i] + reach, side), count - 1);
        }
        for (int z = low[2]; z <= high[2]; ++z)
            for (int y = low[1]; y <= high[1]; ++y)
                for (int x = low[0]; x <= high[0]; ++x) {
                    const int place[3] = {x, y, z};
                    uint64_t distance = 0;
                    for (int i = 0; i < 3; ++i) {
                        const int64_t d = int64_t(place[i]) * side + side / 2 - middle[i];
                        distance += uint64_t(d * d);
                    }
                    const uint32_t row = uint32_t(z) * shape_.counts[1] + uint32_t(y);
                    take({row * shape_.counts[0] + uint32_t(x), what, texel}, distance);
                }
    }

 private:
    void take(const OcclusionCell& cell, uint64_t distance) {
        FW_ASSERT(cell.cell < index_.size(), "%u of %zu cells", cell.cell, index_.size());
        uint32_t& entry = index_[cell.cell];
        FW_ASSERT(entry == kEmpty || entry < out_.size(), "entry %u of %zu", entry, out_.size());
        if (entry == kEmpty) {
            if (out_.size() >= gpu::kMaxBakedOcclusionCells)
                core::refuse(
                    "Objects fill more than %u cells of the heat-occlusion grid, which is the "
                    "limit: "
                    "larger cells are fewer.",
                    gpu::kMaxBakedOcclusionCells);
            entry = uint32_t(out_.size());
            out_.push_back(cell);
            nearest_.push_back(distance);
        } else if (distance < nearest_[entry]) {
            out_[entry] = cell;
            nearest_[entry] = distance;
        }
    }

    const OcclusionGridShape& shape_;
    std::pmr::vector<OcclusionCell>& out_;
    std::pmr::vector<uint32_t> index_;    // by cell: into `out_`, or kEmpty
    std::pmr::vector<uint64_t> nearest_;  // mm^2, as `out_`
};

}  // namespace

uint32_t countsOf(const OcclusionGridShape& shape) noexcept {
    return shape.counts[0] | shape.counts[1] << 10 | shape.counts[2] << 20;
}

OcclusionGridShape makeOcclusionGridShape(const FwHeatOcclusionDef& def) {
    OcclusionGridShape shape;
    checkFlags(def.flags, "FwHeatOcclusionDef::flags", FW_HEAT_OCCLUSION_ALL_OBJECTS);
    for (uint32_t i = 0; i < 3; ++i)
        if (def.counts[i] < 1 || def.counts[i] > gpu::kMaxOcclusionSide)
            core::refuse("FwHeatOcclusionDef::counts[%u] is %u; the limits are [1, %u].", i,
                         def.counts[i], gpu::kMaxOcclusionSide);
    std::copy_n(def.counts, 3, shape.counts.begin());
    if (shape.cells() > gpu::kMaxOcclusionCells)
        core::refuse("FwHeatOcclusionDef::counts makes %u x %u x %u = %u cells; the limit is %u.",
                     def.counts[0], def.counts[1], def.counts[2], shape.cells(),
                     gpu::kMaxOcclusionCells);
    checkLengths(def.origin, 3, "FwHeatOcclusionDef::origin", -kMaxOcclusionOrigin,
                 kMaxOcclusionOrigin);
    checkLength(def.cellSize, "FwHeatOcclusionDef::cellSize", kMinOcclusionCell, kMaxOcclusionCell);
    for (size_t i = 0; i < 3; ++i) shape.origin[i] = int32_t(millimetres(def.origin[i]));
    shape.cell = uint32_t(millimetres(def.cellSize));
    return shape;
}

void readOcclusionCells(const FwHeatOcclusionDef& def, const OcclusionGridShape& shape,
                        float unitsPerMetre, std::pmr::vector<uint32_t>& solid) {
    solid.assign(shape.words(), 0);
    if (!def.cells && !def.distance) return;
    const double side = double(shape.cell) / 1000;
    uint32_t cell = 0;
    for (uint32_t z = 0; z < shape.counts[2]; ++z)
        for (uint32_t y = 0; y < shape.counts[1]; ++y)
            for (uint32_t x = 0; x < shape.counts[0]; ++x, ++cell) {
                bool there = def.cells && def.cells[cell] != 0;
                if (!there && def.distance) {
                    const uint32_t at[3] = {x, y, z};
                    float place[3];
                    for (size_t i = 0; i < 3; ++i)
                        place[i] = float(double(shape.origin[i]) / 1000 + (at[i] + 0.5) * side) *
                                   unitsPerMetre;
                    const float units = def.distance(def.distanceData, place);
                    there = double(units / unitsPerMetre) < side / 2;
                }
                if (there) solid[cell / 32] |= 1u << cell % 32;
            }
}

bool OcclusionGridShape::plausible() const noexcept {
    if (*this == OcclusionGridShape{}) return true;
    bool fine = cell >= uint32_t(millimetres(kMinOcclusionCell)) &&
                cell <= uint32_t(millimetres(kMaxOcclusionCell));
    const int64_t far = millimetres(kMaxOcclusionOrigin);
    for (size_t i = 0; i < 3; ++i)
        fine = fine && counts[i] >= 1 && counts[i] <= gpu::kMaxOcclusionSide && origin[i] >= -far &&
               origin[i] <= far;
    return fine && cells() <= gpu::kMaxOcclusionCells;
}

void bakeOcclusion(const OcclusionGridShape& shape, std::span<const OcclusionObject> objects,
                   std::pmr::vector<OcclusionCell>& out) {
    out.clear();
    if (objects.empty()) return;
    OcclusionFill fill(shape, out);
    for (const OcclusionObject& object : objects) {
        const mesh::BurnDomain& domain = *object.domain;
        // Half of a texel, at most a cell and a half: larger texels leave gaps.
        const double half = std::min(0.5 * object.texelSide, 1.5 * shape.cell);
        for (uint32_t texel = 0; texel < domain.texelCount(); ++texel) {
            if (!domain.real(texel)) continue;
            const mesh::TexelPosition& p = domain.texels[texel];
            const uint32_t material = p.materialFlags & (gpu::kMaterialsPerObject - 1);
            const uint32_t what = object.slot | material << 24 |
                                  (object.stays >> material & 1 ? gpu::kOcclusionPermanent : 0u);
            const gpu::ivec3 at = gpu::toWorldMm(object.place, gpu::ivec3(p.x, p.y, p.z));
            const gpu::ivec3 normal =
                gpu::turnToWorld(object.place, gpu::decodeNormal(domain.normals[texel]));
            fill.texel(at, normal, half, what, texel);
        }
    }
    std::sort(out.begin(), out.end(),
              [](const OcclusionCell& a, const OcclusionCell& b) { return a.cell < b.cell; });
}

void packOcclusion(const HeatOcclusion& grid, std::pmr::vector<uint32_t>& words) {
    const size_t count = grid.shape.words();
    FW_ASSERT(grid.solid.size() == count, "%zu of %zu words", grid.solid.size(), count);
    FW_ASSERT(std::is_sorted(
        grid.baked.begin(), grid.baked.end(),
        [](const OcclusionCell& a, const OcclusionCell& b) { return a.cell < b.cell; }));
    words.assign(3 * count + 2 * grid.baked.size(), 0);
    std::copy(grid.solid.begin(), grid.solid.end(), words.begin());
    size_t at = 0;
    for (size_t word = 0; word < count; ++word) {
        words[count + 2 * word + 1] = uint32_t(at);
        for (; at < grid.baked.size() && grid.baked[at].cell / 32 == word; ++at) {
            const OcclusionCell& cell = grid.baked[at];
            const uint32_t bit = 1u << cell.cell % 32;
            words[word] |= bit;
            words[count + 2 * word] |= bit;
            words[3 * count + 2 * at] = cell.what;
            words[3 * count + 2 * at + 1] = cell.texel;
        }
    }
}

float sweepOcclusion(const HeatOcclusion& grid, const float from[3], const float direction[3],
                     float most) noexcept {
    if (grid.solid.empty()) return most;
    const float far = std::min(most, 0.001f * float(gpu::kExchangeFar - 1));
    float to[3];
    for (int i = 0; i < 3; ++i) to[i] = from[i] + direction[i] * far;
    gpu::OcclusionWalk w = gpu::beginOcclusionWalk(rulesOf(grid.shape), placeOf(from), placeOf(to));
    for (bool open = w.passed > 0; w.within; gpu::stepOcclusionWalk(w, grid.shape.cell)) {
        FW_ASSERT(w.cell < grid.shape.cells(), "%u of %u cells", w.cell, grid.shape.cells());
        const bool solid = grid.solid[w.cell / 32] >> w.cell % 32 & 1;
        if (solid && open) return std::min(most, far * float(w.passed) / float(w.of));
        open |= !solid;
    }
    return most;
}

bool isShadedByOcclusion(const OcclusionView& grid, const float from[3], const float to[3],
                         float spare) noexcept {
    if (grid.words.empty()) return false;
    const uint32_t words = grid.shape.words(), side = grid.shape.cell;
    gpu::OcclusionEnds ends;
    ends.from = ends.to = gpu::kNoneTexel;  // no object's: all cells count
    ends.fromSpare = side + uint32_t(std::clamp(spare, 0.0f, 10.0f) * 1000);
    ends.toSpare = side;
    gpu::OcclusionWalk w = gpu::beginOcclusionWalk(rulesOf(grid.shape), placeOf(from), placeOf(to));
    for (; w.within; gpu::stepOcclusionWalk(w, side)) {
        const uint32_t at = w.cell / 32, bit = 1u << w.cell % 32;
        FW_ASSERT(words + 2 * at + 1 < grid.words.size(), "word %u of %zu", at, grid.words.size());
        if ((grid.words[at] & bit) == 0) continue;
        if (gpu::isNearWalkEnd(w, ends, gpu::kNoneTexel, side)) continue;
        const uint32_t baked = grid.words[words + 2 * at];
        if ((baked & bit) == 0) return true;
        const uint32_t before = uint32_t(std::popcount(baked & (bit - 1)));
        const uint32_t i = grid.words[words + 2 * at + 1] + before;
        FW_ASSERT(3 * words + 2 * i < grid.words.size(), "cell %u, %zu words", i,
                  grid.words.size());
        const uint32_t slot = grid.words[3 * words + 2 * i] & gpu::kOcclusionSlotMask;
        if (slot >= grid.fallen.size() || grid.fallen[slot] == 0) return true;
    }
    return false;
}

}  // namespace fw::components
