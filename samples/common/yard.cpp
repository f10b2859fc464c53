#include "yard.h"

#include <flamewright/flamewright_debug.h>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace {

constexpr float kHalf = 0.25f, kApart = 0.9f;  // m

// Six faces of four corners each, counter-clockwise from outside.
FwMeshId makeCrate(FwWorld* world) {
    float positions[72];
    uint32_t indices[36];
    for (uint32_t v = 0; v < 24; ++v) {
        const uint32_t face = v / 4, x = face / 2, y = (x + 1) % 3, z = (x + 2) % 3;
        const float side = (face & 1) != 0 ? kHalf : -kHalf;
        positions[v * 3 + x] = side;
        positions[v * 3 + y] = ((v ^ v >> 1) & 1) != 0 ? side : -side;
        positions[v * 3 + z] = (v & 2) != 0 ? kHalf : -kHalf;
        positions[v * 3 + 1] += kHalf;
    }
    constexpr uint32_t kQuad[6] = {0, 1, 2, 0, 2, 3};
    for (uint32_t i = 0; i < 36; ++i) indices[i] = i / 6 * 4 + kQuad[i % 6];
    FwMeshDef def = fwDefaultMeshDef();
    def.positions = positions;
    def.vertexCount = 24;
    def.indices = indices;
    def.indexCount = 36;
    def.texelsPerMetre = 64;
    FwMeshId mesh{};
    check(fwWorld_CreateMesh(world, &def, &mesh), world);
    return mesh;
}

}  // namespace

uint32_t wholeOf(const std::string& name, const char* text, uint32_t low, uint32_t high) {
    char* end = nullptr;
    const unsigned long value = std::strtoul(text, &end, 10);
    if (end == text || *end != 0 || value < low || value > high)
        throw std::runtime_error(name + " is \"" + text + "\"; it is a number in [" +
                                 std::to_string(low) + ", " + std::to_string(high) + "]");
    return uint32_t(value);
}

void check(FwResult result, FwWorld* world) {
    if (result >= 0) return;
    char why[512] = "";
    fwWorld_GetLastMessage(world, why, sizeof why);
    throw std::runtime_error(std::string(fwResultName(result)) + ": " + why);
}

void placeOf(const Yard& yard, uint32_t crate, float (&place)[3]) {
    place[0] = kApart * float(crate % yard.columns);
    place[1] = 0;
    place[2] = kApart * float(crate / yard.columns);
}

Yard makeYard(FwWorld* world, uint32_t crates) {
    Yard yard;
    yard.columns = uint32_t(std::ceil(std::sqrt(double(crates))));
    FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
    def.mesh = makeCrate(world);
    const FwMaterialDef pine = fwDefaultMaterialDef();
    check(fwWorld_CreateMaterial(world, &pine, &def.materials[0]), world);
    for (uint32_t i = 0; i < crates; ++i) {
        float place[3];
        placeOf(yard, i, place);
        for (int c = 0; c < 3; ++c) def.transform[12 + c] = place[c];
        def.userData = i;
        check(fwWorld_CreateBurnableMesh(world, &def, &yard.crates.emplace_back()), world);
    }
    return yard;
}

void lightCrate(FwWorld* world, const Yard& yard, uint32_t crate) {
    FwIgnitionDef match = fwDefaultIgnitionDef();
    match.object = yard.crates[crate];
    placeOf(yard, crate, match.position);
    match.position[0] += kHalf;
    match.position[1] += 0.06f;
    match.radius = 0.06f;
    check(fwWorld_Ignite(world, &match, nullptr), world);
}

YardState stateOf(FwWorld* world, const Yard& yard) {
    YardState sum;
    for (const FwBurnableMeshId id : yard.crates) {
        FwObjectState state{};
        state.structSize = sizeof state;
        check(fwWorld_GetObjectState(world, id, &state), world);
        sum.burning += state.burning > 0 ? 1 : 0;
        sum.burnt += state.ignited > 0 && state.burning == 0 ? 1 : 0;
        sum.plays += state.playsBakedBurn;
        sum.power += state.power;
    }
    return sum;
}

uint64_t hashOf(FwWorld* world, const Yard& yard) {
    uint64_t all = 0;
    for (const FwBurnableMeshId id : yard.crates) {
        uint64_t one = 0;
        check(fwDebug_RequestBurnMap(world, id), world);
        check(fwDebug_FetchBurnMap(world, id, nullptr, 0, nullptr, &one, nullptr), world);
        all = all * 0x9E3779B97F4A7C15ull + one;
    }
    return all;
}
