// Short forms of C ABI calls that must succeed: ids and states as return values. Includes public
// headers only.
#pragma once
#include "flamewright/flamewright.h"

#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <type_traits>

namespace fw::test {

inline std::string lastMessage(FwWorld* world) {
    std::string text(fwWorld_GetLastMessage(world, nullptr, 0), '\0');
    (void)fwWorld_GetLastMessage(world, text.data(), text.size() + 1);
    return text;
}
inline std::string lastMessage(FwContext* context) {
    std::string text(fwContext_GetLastMessage(context, nullptr, 0), '\0');
    (void)fwContext_GetLastMessage(context, text.data(), text.size() + 1);
    return text;
}

// The id that `create` makes of `def`.
template <class Owner, class Def, class Id>
Id created(FwResult(FW_CALL* create)(Owner*, const Def*, Id*), Owner* owner, const Def& def) {
    Id id{};
    EXPECT_EQ(FW_OK, create(owner, &def, &id)) << lastMessage(owner);
    return id;
}

// The struct with a structSize that `get` fills, its last argument.
template <class Owner, class... Parameters, class... Arguments>
auto getState(FwResult(FW_CALL* get)(Owner*, Parameters...), Owner* owner,
              const Arguments&... arguments) {
    std::remove_pointer_t<
        std::tuple_element_t<sizeof...(Parameters) - 1, std::tuple<Parameters...>>>
        state{};
    state.structSize = sizeof state;
    EXPECT_EQ(FW_OK, get(owner, arguments..., &state)) << lastMessage(owner);
    return state;
}

inline FwMaterialDef materialOf(uint32_t preset) {
    FwMaterialDef def = fwDefaultMaterialDef();
    EXPECT_EQ(FW_OK, fwInitMaterialPreset(&def, preset));
    return def;
}

// `def`: everything but the mesh and the first material.
inline FwBurnableMeshId addBurnable(FwWorld* world, const FwMeshDef& mesh,
                                    const FwMaterialDef& material,
                                    FwBurnableMeshDef def = fwDefaultBurnableMeshDef()) {
    def.mesh = created(fwWorld_CreateMesh, world, mesh);
    def.materials[0] = created(fwWorld_CreateMaterial, world, material);
    return created(fwWorld_CreateBurnableMesh, world, def);
}
inline FwBurnableMeshId addBurnable(FwWorld* world, const FwMeshDef& mesh, uint32_t preset,
                                    const FwBurnableMeshDef& def = fwDefaultBurnableMeshDef()) {
    return addBurnable(world, mesh, materialOf(preset), def);
}

}  // namespace fw::test
