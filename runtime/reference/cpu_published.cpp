// The published sixteen-tap kernel on the CPU: the floats of shaders/published.comp, in its
// order. Three planes, S * D twice and D, with a border of two zero texels around the map.
#include "gpu/cpu/cpu_state.h"
#include "reference/methods.h"
#include "reference/published.h"

#include <algorithm>
#include <bit>

namespace fw::reference {
namespace {

using namespace gpu;
using gpu::cpu::CpuObject;

constexpr size_t kPad = 2;  // texels on each side: as far as taps reach

size_t strideOf(const CpuObject& object) noexcept { return object.domain->width + 2 * kPad; }
size_t planeOf(const CpuObject& object) noexcept {
    return strideOf(object) * (object.domain->height + 2 * kPad);
}
size_t place(const CpuObject& object, uint32_t x, uint32_t y) noexcept {
    FW_ASSERT(x < object.domain->width && y < object.domain->height, "texel (%u, %u)", x, y);
    return (y + kPad) * strideOf(object) + x + kPad;
}

// Sign bit: S passes one half.
uint32_t crossing(float q, float next, float d) noexcept {
    return std::bit_cast<uint32_t>(q + q - d) & ~std::bit_cast<uint32_t>(next + next - d);
}

// `from`, `spread` and `to` at the row's first texel. True: some texel passes one half.
bool publishedRow(const float* from, const float* spread, float* to, size_t stride,
                  uint32_t width) noexcept {
    const float* below2 = from - 2 * stride;
    const float* below1 = from - stride;
    const float* above1 = from + stride;
    const float* above2 = from + 2 * stride;
    uint32_t pass = 0;
    for (std::ptrdiff_t x = 0; x < std::ptrdiff_t(width); ++x) {
        const auto one = [x](const float* row) { return row[x - 1] + row[x + 1]; };
        const auto two = [x](const float* row) { return row[x - 2] + row[x + 2]; };
        const float next = publishedNext(from[x], spread[x], (below1[x] + above1[x]) + one(from),
                                         one(below1) + one(above1),
                                         (two(below1) + two(above1)) + (one(below2) + one(above2)));
        to[x] = next;
        pass |= crossing(from[x], next, spread[x]);
    }
    return (pass & 0x80000000u) != 0;
}

}  // namespace

void createPublished(CpuObject& object) {
    const mesh::BurnDomain& domain = *object.domain;
    const size_t plane = planeOf(object);
    object.extended.resize(3 * plane);
    const uint16_t* slow =
        object.slowness.empty() ? domain.slowness.data() : object.slowness.data();
    for (uint32_t y = 0; y < domain.height; ++y)
        for (uint32_t x = 0; x < domain.width; ++x) {
            const uint32_t texel = y * domain.width + x;
            if (object.state[texel] != kNever) continue;
            const uvec4& up = object.materials[domain.texels[texel].materialFlags & 7].upCeiling;
            const int rise = dotInt(decodeNormal(domain.normals[texel]),
                                    ivec3(int(up.x), int(up.y), int(up.z)));  // Q24
            object.extended[2 * plane + place(object, x, y)] =
                publishedSpread(slow[texel], -rise >> 12);
        }
}

void publishedEvent(CpuObject& object, uint32_t texel, bool burns) noexcept {
    FW_ASSERT(texel < object.state.size(), "%u of %zu texels", texel, object.state.size());
    const size_t plane = planeOf(object);
    const size_t at = place(object, texel % object.domain->width, texel / object.domain->width);
    const float q = burns ? object.extended[2 * plane + at] : 0.0f;
    object.extended[at] = q;
    object.extended[plane + at] = q;
}

void publishedStep(gpu::cpu::CpuBackend::State& s, uint32_t now) noexcept {
    const uint32_t end = now + kStepTicks;
    for (core::Owned<CpuObject>& owned : s.objects) {
        if (!owned || !owned->live || owned->extended.empty()) continue;
        CpuObject& object = *owned;
        const uint32_t width = object.domain->width;
        const size_t plane = planeOf(object);
        FW_ASSERT(object.extended.size() == 3 * plane, "%zu of %zu floats", object.extended.size(),
                  3 * plane);
        FW_ASSERT(object.extensionParity < 2, "parity %u", object.extensionParity);
        float* planes = object.extended.data();
        for (uint32_t y = 0; y < object.domain->height; ++y) {
            const size_t row = place(object, 0, y);
            const float* from = planes + object.extensionParity * plane + row;
            const float* spread = planes + 2 * plane + row;
            float* to = planes + (object.extensionParity ^ 1u) * plane + row;
            if (!publishedRow(from, spread, to, strideOf(object), width)) continue;
            for (uint32_t x = 0; x < width; ++x) {
                uint32_t& state = object.state[y * width + x];
                if (crossing(from[x], to[x], spread[x]) >> 31 == 0 || !isReceptive(state)) continue;
                const uint32_t worldTile = object.worldTileOf(y * width + x);
                if (s.isRequestPass && !s.mayBurn(worldTile)) s.requestToBurn(worldTile);
                if (!s.mayBurn(worldTile)) to[x] = from[x];  // it passes again in the next step
                if (s.isRequestPass || !s.mayBurn(worldTile)) continue;
                state = end;
                object.addIgnitions(1, end);
                s.burning(worldTile);
            }
        }
        if (!s.isRequestPass) object.extensionParity ^= 1u;
    }
}

}  // namespace fw::reference
