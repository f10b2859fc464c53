#include "mesh/carry.h"

#include "shared/front.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fw::mesh {
namespace {

constexpr int64_t kFaces = int64_t(1) << 27;  // of two unit normals in Q14: within 60 degrees

// Micrometres: whole numbers, so that every machine picks the same texels.
using Place = std::array<int64_t, 3>;

Place micrometresOf(const BurnDomain& domain, uint32_t texel) noexcept {
    const TexelPosition& p = domain.texels[texel];
    const uint16_t units[3] = {p.x, p.y, p.z};
    Place place;
    for (size_t i = 0; i < 3; ++i)
        place[i] = std::llround(
            (double(domain.origin[i]) + double(domain.quantum) * double(units[i])) * 1e6);
    return place;
}

struct TexelCells {  // texels by the cell of a grid that they lie in
    explicit TexelCells(std::pmr::memory_resource* memory) : entries(memory) {}
    struct Entry {
        uint64_t key = 0;
        uint32_t texel = 0;
    };
    std::pmr::vector<Entry> entries;
    int64_t side = 1;

    [[nodiscard]] Place cellOf(const Place& place) const noexcept {
        Place cell;
        for (size_t i = 0; i < 3; ++i) cell[i] = (place[i] - (place[i] < 0 ? side - 1 : 0)) / side;
        return cell;
    }
    [[nodiscard]] static uint64_t keyOf(const Place& cell) noexcept {
        uint64_t key = 0;
        for (const int64_t part : cell) key = key << 21 | (uint64_t(part) & 0x1FFFFF);
        return key;
    }
};

}  // namespace

uint32_t matchTexels(const BurnDomain& from, const BurnDomain& to, float reach,
                     std::pmr::vector<uint32_t>& out) {
    TexelCells cells(out.get_allocator().resource());
    const double side = std::max({double(from.texelSide), double(to.texelSide), 1e-5});
    cells.side = std::llround(side * 1.5e6);
    for (uint32_t i = 0; i < from.texelCount(); ++i)
        if (from.real(i))
            cells.entries.push_back({TexelCells::keyOf(cells.cellOf(micrometresOf(from, i))), i});
    std::sort(cells.entries.begin(), cells.entries.end(), [](const auto& a, const auto& b) {
        return a.key != b.key ? a.key < b.key : a.texel < b.texel;
    });
    out.assign(to.texelCount(), kNone);
    const auto farthest = int64_t(double(reach) * 1e6);
    const int64_t rings = std::max<int64_t>((farthest + cells.side - 1) / cells.side, 1);
    const int64_t least = farthest * farthest;
    uint32_t matched = 0;
    for (uint32_t i = 0; i < to.texelCount(); ++i) {
        if (!to.real(i)) continue;
        const Place place = micrometresOf(to, i), cell = cells.cellOf(place);
        const gpu::ivec3 normal = gpu::decodeNormal(to.normals[i]);
        // A texel that faces another way counts as one reach further off.
        int64_t best = 2 * least + 1;
        const auto look = [&](const Place& at) {
            const uint64_t key = TexelCells::keyOf(at);
            auto one = std::lower_bound(
                cells.entries.begin(), cells.entries.end(), key,
                [](const TexelCells::Entry& entry, uint64_t wanted) { return entry.key < wanted; });
            for (; one != cells.entries.end() && one->key == key; ++one) {
                const Place there = micrometresOf(from, one->texel);
                int64_t square = 0;
                for (size_t k = 0; k < 3; ++k)
                    square += (there[k] - place[k]) * (there[k] - place[k]);
                if (square > least) continue;
                const gpu::ivec3 n = gpu::decodeNormal(from.normals[one->texel]);
                const int64_t along =
                    int64_t(n.x) * normal.x + int64_t(n.y) * normal.y + int64_t(n.z) * normal.z;
                if (along < kFaces) square += least;
                if (square >= best) continue;
                best = square;
                out[i] = one->texel;
            }
        };
        // Outwards, ring by ring, until no further one can hold a nearer texel.
        for (int64_t ring = 0; ring <= rings; ++ring) {
            const int64_t nearest = std::max<int64_t>(ring - 1, 0) * cells.side;
            if (out[i] != kNone && nearest * nearest > best) break;
            for (int64_t x = -ring; x <= ring; ++x)
                for (int64_t y = -ring; y <= ring; ++y) {
                    const bool face = std::abs(x) == ring || std::abs(y) == ring;
                    const int64_t step = face || ring == 0 ? 1 : 2 * ring;
                    for (int64_t z = -ring; z <= ring; z += step)
                        look({cell[0] + x, cell[1] + y, cell[2] + z});
                }
        }
        matched += out[i] != kNone ? 1u : 0u;
    }
    return matched;
}

}  // namespace fw::mesh
