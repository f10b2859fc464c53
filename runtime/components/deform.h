// How an object of some materials deforms: the record that the deformation passes read. Plain
// functions over defs; nothing moves here.
#pragma once
#include "components/burnable_mesh.h"
#include "shared/deform.h"

namespace fw::components {

// Throws core::Error naming the field.
void checkDeform(const FwBurnableMeshDef& def);
[[nodiscard]] bool deforms(const BurnableMesh& object) noexcept;
// Bases are the backend's.
gpu::DeformObject makeDeform(const FwBurnableMeshDef& def, const BurnableMesh& object,
                             const Records& records) noexcept;

}  // namespace fw::components
