#include "mesh/hold.h"

#include <algorithm>

namespace fw::mesh {
namespace {

// Takes the texels of the stack and all real texels that `joins` accepts over links; `joins` marks
// the texels that it accepts.
template <class Stack, class Joins>
void spread(const BurnDomain& domain, Stack& stack, Joins joins) {
    while (!stack.empty()) {
        const uint32_t texel = stack.back();
        stack.pop_back();
        for (uint32_t k = 0; k < 8; ++k) {
            const uint32_t other = domain.ringOf(texel, k);
            if (other == kNone || !joins(other)) continue;
            FW_ASSERT(other < domain.texelCount(), "%u of %u texels", other, domain.texelCount());
            stack.push_back(other);
        }
    }
}

}  // namespace

void findPieces(const BurnDomain& domain, std::span<const uint8_t> gone, Pieces& pieces) {
    pieces.of.assign(domain.texelCount(), kNone);
    pieces.count = 0;
    std::pmr::vector<uint32_t> stack(pieces.of.get_allocator());
    const auto joins = [&](uint32_t texel) {
        if (!domain.real(texel) || pieces.of[texel] != kNone || (!gone.empty() && gone[texel]))
            return false;
        pieces.of[texel] = pieces.count;
        return true;
    };
    for (uint32_t i = 0; i < domain.texelCount(); ++i) {
        if (!joins(i)) continue;
        stack.push_back(i);
        spread(domain, stack, joins);
        ++pieces.count;
    }
}

void reserveHold(const BurnDomain& domain, const Pieces& pieces, HoldScratch& scratch) {
    scratch.marks.reserve(domain.texelCount());
    scratch.stack.reserve(domain.texelCount());  // each at most once
    scratch.lost.reserve(domain.texelCount());
    scratch.lowest.reserve(pieces.count);
}

void markFeet(const BurnDomain& domain, const Pieces& pieces, const int32_t (&up)[3], int64_t reach,
              HoldScratch& scratch) noexcept {
    const auto rise = [&](uint32_t i) {
        const TexelPosition& p = domain.texels[i];
        return int64_t(up[0]) * p.x + int64_t(up[1]) * p.y + int64_t(up[2]) * p.z;
    };
    FW_ASSERT(pieces.of.size() == domain.texelCount() && scratch.marks.size() == pieces.of.size(),
              "%zu and %zu of %u texels", pieces.of.size(), scratch.marks.size(),
              domain.texelCount());
    FW_ASSERT(pieces.count <= scratch.lowest.capacity(), "%u pieces", pieces.count);
    scratch.lowest.assign(pieces.count, INT64_MAX);
    for (uint32_t i = 0; i < domain.texelCount(); ++i)
        if (pieces.of[i] != kNone) {
            int64_t& lowest = scratch.lowest[pieces.of[i]];
            lowest = std::min(lowest, rise(i));
        }
    for (uint32_t i = 0; i < domain.texelCount(); ++i)
        if (pieces.of[i] != kNone && rise(i) <= scratch.lowest[pieces.of[i]] + reach)
            scratch.marks[i] |= kHoldBears;
}

void markHeld(const BurnDomain& domain, HoldScratch& scratch) noexcept {
    FW_ASSERT(scratch.stack.capacity() >= domain.texelCount(), "a stack of %zu texels",
              scratch.stack.capacity());
    scratch.stack.clear();
    const auto joins = [&](uint32_t texel) {
        uint8_t& mark = scratch.marks[texel];
        if ((mark & (kHoldStands | kHoldHeld)) != kHoldStands) return false;
        mark |= kHoldHeld;
        return true;
    };
    for (uint32_t i = 0; i < domain.texelCount(); ++i)
        if ((scratch.marks[i] & kHoldBears) != 0 && joins(i)) {
            scratch.stack.push_back(i);
            spread(domain, scratch.stack, joins);
        }
}

bool nextLost(const BurnDomain& domain, uint32_t& from, HoldScratch& scratch) noexcept {
    scratch.lost.clear();
    const auto joins = [&](uint32_t texel) {
        uint8_t& mark = scratch.marks[texel];
        if ((mark & (kHoldStands | kHoldHeld | kHoldSeen)) != kHoldStands) return false;
        mark |= kHoldSeen;
        FW_ASSERT(scratch.lost.size() < scratch.lost.capacity(), "%zu lost texels",
                  scratch.lost.size());
        scratch.lost.push_back(texel);
        return true;
    };
    for (; from < domain.texelCount(); ++from) {
        if (!joins(from)) continue;
        scratch.stack.push_back(from);
        spread(domain, scratch.stack, joins);
        return true;
    }
    return false;
}

}  // namespace fw::mesh
