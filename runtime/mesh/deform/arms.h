// Arms: pairs of nodes some distance apart with a third in their middle, which bend a sheet more
// widely than neighbours do (shared/deform.h). Only open meshes have arms; closed ones are stiff.
#pragma once
#include "mesh/deform/model.h"

namespace fw::mesh {

// Sets DeformModel::span and the nodes' arms. Needs nodes with rings and areas, and embeddings.
void findBends(DeformModel& model, std::pmr::memory_resource* memory);

}  // namespace fw::mesh
