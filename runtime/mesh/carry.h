// Matches the texels of two meshes of the same shape (levels of detail): each texel of one takes
// its burn from a texel of the other.
#pragma once
#include "mesh/burn_domain.h"

namespace fw::mesh {

// out, by texel of `to`: the nearest texel of `from` in object space, with preference for texels
// that face the same way. kNone: none is within `reach` m, or the texel is not real. Returns the
// number of matches.
uint32_t matchTexels(const BurnDomain& from, const BurnDomain& to, float reach,
                     std::pmr::vector<uint32_t>& out);

}  // namespace fw::mesh
