// Structural support of a burnt surface: the texels that remain, and those of them that still
// connect to a support. The end of a board whose middle is gone falls. Works on texels and links
// only.
#pragma once
#include "mesh/burn_domain.h"

namespace fw::mesh {

// The connected pieces of an object before it burns: piece by texel, and their number.
struct Pieces {
    explicit Pieces(std::pmr::memory_resource* memory) : of(memory) {}
    std::pmr::vector<uint32_t> of;  // kNone: the texel is not real, or cut out
    uint32_t count = 0;
};
// `gone`: by texel, 1 where the object is cut out; empty: nowhere. Throws std::bad_alloc.
void findPieces(const BurnDomain& domain, std::span<const uint8_t> gone, Pieces& pieces);

enum HoldMark : uint8_t {  // of a texel
    kHoldStands = 1,       // real, and neither burnt away nor lost
    kHoldBears = 2,        // a support, as long as it stands
    kHoldHeld = 4,         // connected to a support
    kHoldSeen = 8,         // reported by nextLost
};

struct HoldScratch {
    explicit HoldScratch(std::pmr::memory_resource* memory)
        : marks(memory), stack(memory), lowest(memory), lost(memory) {}
    std::pmr::vector<uint8_t> marks;   // by texel: HoldMarks
    std::pmr::vector<uint32_t> stack;  // texels
    std::pmr::vector<int64_t> lowest;  // by piece
    std::pmr::vector<uint32_t> lost;   // texels of one part
};
// Reserves the memory that the functions below need for a mesh. Throws std::bad_alloc.
void reserveHold(const BurnDomain& domain, const Pieces& pieces, HoldScratch& scratch);

// Marks each piece's supports where `up` points up (any scale, |up| <= 1024): its lowest texels,
// and those up to `reach` (in units of up times position units) above them.
void markFeet(const BurnDomain& domain, const Pieces& pieces, const int32_t (&up)[3], int64_t reach,
              HoldScratch& scratch) noexcept;
// nextLost finds the first part from texel `from` on that stands and is not held, in the order of
// their least texels; it marks the part as seen and lists it in scratch.lost. Needs markHeld
// before. False: no part is left.
void markHeld(const BurnDomain& domain, HoldScratch& scratch) noexcept;
bool nextLost(const BurnDomain& domain, uint32_t& from, HoldScratch& scratch) noexcept;

}  // namespace fw::mesh
