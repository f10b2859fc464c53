// A burn domain stretched along its axes, or mirrored: as if the mesh had been baked that way, but
// with the atlas, links and tiles it has. For objects whose scale is not uniform.
#pragma once
#include "mesh/burn_domain.h"

namespace fw::mesh {

// `shape`: factor per object axis; x may be negative, which mirrors. Positions, normals, areas,
// thickness and lengths are those of the stretched mesh; detail coordinates stay.
BurnDomain shaped(const BurnDomain& domain, const float shape[3],
                  std::pmr::memory_resource* memory);

}  // namespace fw::mesh
