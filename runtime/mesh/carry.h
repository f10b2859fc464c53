// Which texel of one mesh each texel of another one takes its burn from, where both have the same
// shape: levels of detail.
#pragma once
#include "mesh/burn_domain.h"

namespace fw::mesh {

// By texel of `to`: the nearest of `from` in object space, of those that face the same way before
// others; kNone: none is within `reach` m, or it is no real texel. Returns how many have one.
uint32_t matchTexels(const BurnDomain& from, const BurnDomain& to, float reach,
                     std::pmr::vector<uint32_t>& out);

}  // namespace fw::mesh
