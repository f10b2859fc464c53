// What is left of a surface that fire eats, and what of that still hangs on something: a board
// whose middle is gone, the end of which falls. Texels and their links alone: it knows no heat and
// no object.
#pragma once
#include "mesh/burn_domain.h"

namespace fw::mesh {

// The parts that an object consists of as it was made: by texel, and how many.
struct Pieces {
    explicit Pieces(std::pmr::memory_resource* memory) : of(memory) {}
    std::pmr::vector<uint32_t> of;  // kNone: the texel is none, or cut out
    uint32_t count = 0;
};
// `gone`: by texel, 1 where the object is cut out; empty: nowhere. Throws std::bad_alloc.
void findPieces(const BurnDomain& domain, std::span<const uint8_t> gone, Pieces& pieces);

enum HoldMark : uint8_t {  // of a texel
    kHoldStands = 1,       // it is real, and there: neither gone nor lost
    kHoldBears = 2,        // it rests on something, as long as it is there
    kHoldHeld = 4,
    kHoldSeen = 8,
};

struct HoldScratch {
    explicit HoldScratch(std::pmr::memory_resource* memory)
        : marks(memory), stack(memory), lowest(memory), lost(memory) {}
    std::pmr::vector<uint8_t> marks;   // by texel: HoldMarks
    std::pmr::vector<uint32_t> stack;  // texels
    std::pmr::vector<int64_t> lowest;  // by piece
    std::pmr::vector<uint32_t> lost;   // texels of one part
};
// What all of the below need for a mesh, and no more after it. Throws std::bad_alloc.
void reserveHold(const BurnDomain& domain, const Pieces& pieces, HoldScratch& scratch);

// Marks what each piece stands on where `up` points up (any scale, |up| <= 1024): its lowest
// texels, and those up to `reach` (in units of up times position units) above them.
void markFeet(const BurnDomain& domain, const Pieces& pieces, const int32_t (&up)[3], int64_t reach,
              HoldScratch& scratch) noexcept;
// The first part from texel `from` on, in the order of their least texels, that stands and is not
// held; it is in scratch.lost, and marked as seen. After markHeld. False: there are no more.
void markHeld(const BurnDomain& domain, HoldScratch& scratch) noexcept;
bool nextLost(const BurnDomain& domain, uint32_t& from, HoldScratch& scratch) noexcept;

}  // namespace fw::mesh
