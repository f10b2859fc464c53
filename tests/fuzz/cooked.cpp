// Cooked meshes, which then burn, and baked burns, which a mesh then plays.
#include "fuzz/signed_input.h"

namespace fuzz {
namespace {

FwMeshDef cookedMesh(const Bytes& bytes) {
    FwMeshDef def = fwDefaultMeshDef();
    def.cooked = bytes.data();
    def.cookedSize = bytes.size();
    return def;
}

bool burnCooked(host::HostedWorld& w, const Bytes& bytes) {
    const FwMeshDef def = cookedMesh(bytes);
    FwBurnableMeshDef object = fwDefaultBurnableMeshDef();
    if (fwWorld_CreateMesh(w.world, &def, &object.mesh) != FW_OK) return false;
    object.materials[0] =
        host::created(fwWorld_CreateMaterial, w.world, host::materialOf(FW_MATERIAL_PAPER));
    FwBurnableMeshId id{};
    if (fwWorld_CreateBurnableMesh(w.world, &object, &id) != FW_OK) return true;
    (void)w.touch(FW_IGNITE, id, 0, 0, 0, 0.5f);
    w.run(0.25);
    return true;
}

bool playBaked(host::HostedWorld& w, const Bytes& bytes) {
    FwBurnId burn{};
    if (fwWorld_CreateBurn(w.world, bytes.data(), bytes.size(), &burn) != FW_OK) return false;
    static const Bytes box = fixture("box.fwburn");
    FwBurnableMeshDef object = fwDefaultBurnableMeshDef();
    const FwMeshDef def = cookedMesh(box);
    object.mesh = host::created(fwWorld_CreateMesh, w.world, def);
    object.materials[0] =
        host::created(fwWorld_CreateMaterial, w.world, host::materialOf(FW_MATERIAL_PAPER));
    const auto id = host::created(fwWorld_CreateBurnableMesh, w.world, object);
    if (fwWorld_PlayBurn(w.world, id, burn, 0, 16) == FW_OK) w.run(0.5);
    w.ok(fwWorld_StopBurn(w.world, id));
    w.run(0.1);
    return true;
}

Bytes cookedSheet() {
    host::HostedWorld w(FW_BACKEND_CPU);
    const host::Sheet sheet(0.2f, 0.1f);
    const FwMeshDef def = sheet.def(40);
    uint64_t size = 0;
    EXPECT_EQ(FW_OK, fwCookMesh(w.context, &def, nullptr, &size));
    Bytes bytes(size);
    EXPECT_EQ(FW_OK, fwCookMesh(w.context, &def, bytes.data(), &size));
    return bytes;
}

const Fuzzer kCooked{"cooked",
                     [] {
                         return std::vector<Bytes>{cookedSheet(), fixture("box.fwburn"),
                                                   fixture("box_baked.fwburn")};
                     },
                     [](Input input) {
                         host::HostedWorld w(FW_BACKEND_CPU, host::pacedDef(16));
                         const Bytes bytes = signedInput(input);
                         if (bytes.empty()) return false;
                         return startsWith(bytes, "FWBB") ? playBaked(w, bytes)
                                                          : burnCooked(w, bytes);
                     }};

}  // namespace
}  // namespace fuzz
