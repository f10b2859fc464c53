// A burn domain stretched along its axes, or mirrored, with the same atlas, links and tiles. For
// objects with a non-uniform scale.
#pragma once
#include "mesh/burn_domain.h"

namespace fw::mesh {

// `shape`: factor per object axis; a negative x mirrors. Positions, normals, areas, thickness and
// lengths are those of the stretched mesh; detail coordinates stay.
BurnDomain shaped(const BurnDomain& domain, const float shape[3],
                  std::pmr::memory_resource* memory);

}  // namespace fw::mesh
