// Bending constraints: two particles some distance apart with a third in their middle. They bend a
// sheet more widely than neighbours do (shared/deform.h). Closed meshes are stiff and have none.
#pragma once
#include "mesh/deform/model.h"

namespace fw::mesh {

// Sets DeformModel::span and the particles' bending constraints. Needs particles with rings and
// areas, and embeddings.
void findBends(DeformModel& model, std::pmr::memory_resource* memory);

}  // namespace fw::mesh
