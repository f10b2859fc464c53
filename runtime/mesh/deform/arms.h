// Which nodes of a sheet belong in the middle of which others some way off: what bends wider than
// between neighbours (shared/deform.h). Open meshes alone have such arms; what closes is stiff.
#pragma once
#include "mesh/deform/model.h"

namespace fw::mesh {

// Sets DeformModel::span and the nodes' arms. Needs nodes with rings and areas, and coats.
void findArms(DeformModel& model, std::pmr::memory_resource* memory);

}  // namespace fw::mesh
