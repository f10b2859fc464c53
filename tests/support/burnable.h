// A mesh, its material and the burnable of both, in one call. Public headers only.
#pragma once
#include "flamewright/flamewright.h"

#include <gtest/gtest.h>

namespace fw::test {

// `def`: everything but the mesh and the first material.
inline FwBurnableMeshId addBurnable(FwWorld* world, const FwMeshDef& mesh,
                                    const FwMaterialDef& material,
                                    FwBurnableMeshDef def = fwDefaultBurnableMeshDef()) {
    const auto ok = [&](FwResult result) {
        char text[512] = "";
        if (result != FW_OK) (void)fwWorld_GetLastMessage(world, text, sizeof text);
        EXPECT_EQ(FW_OK, result) << text;
    };
    ok(fwWorld_CreateMesh(world, &mesh, &def.mesh));
    ok(fwWorld_CreateMaterial(world, &material, &def.materials[0]));
    FwBurnableMeshId id{};
    ok(fwWorld_CreateBurnableMesh(world, &def, &id));
    return id;
}
inline FwBurnableMeshId addBurnable(FwWorld* world, const FwMeshDef& mesh, uint32_t preset,
                                    const FwBurnableMeshDef& def = fwDefaultBurnableMeshDef()) {
    FwMaterialDef material = fwDefaultMaterialDef();
    EXPECT_EQ(FW_OK, fwInitMaterialPreset(&material, preset));
    return addBurnable(world, mesh, material, def);
}

}  // namespace fw::test
