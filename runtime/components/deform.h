// The record of an object that deforms, for the deformation passes, from its def and materials.
#pragma once
#include "components/burnable_mesh.h"
#include "shared/deform.h"

namespace fw::components {

// Throws core::Error naming the field.
void checkDeform(const FwBurnableMeshDef& def);
[[nodiscard]] bool deforms(const BurnableMesh& object) noexcept;
// The backend sets the record's bases.
gpu::DeformObject makeDeform(const FwBurnableMeshDef& def, const BurnableMesh& object,
                             const Records& records) noexcept;

}  // namespace fw::components
