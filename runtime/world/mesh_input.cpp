#include "world/mesh_input.h"

#include "components/pose.h"
#include "core/error.h"
#include "mesh/bake.h"

namespace fw::world {
namespace {

constexpr uint32_t kMostVertices = 16u << 20;
constexpr uint32_t kMaxIndices = 48u << 20;

struct Input {
    std::pmr::vector<uint32_t> wide;  // 16-bit indices as 32-bit ones
    mesh::BakeInput bake;
};

template <class T>
std::span<const T> optional(const T* data, size_t count) {
    return data ? std::span<const T>(data, count) : std::span<const T>();
}

Input makeInput(const FwMeshDef& def, std::pmr::memory_resource* memory) {
    components::checkFlags(def.flags, "FwMeshDef::flags", FW_MESH_TRUST_UVS);
    components::checkWhole(def.reserved, "FwMeshDef::reserved", 0, 0);
    if (!def.positions) core::refuse("FwMeshDef::positions is null.");
    if (!def.indices) core::refuse("FwMeshDef::indices is null.");
    components::checkWhole(def.vertexCount, "FwMeshDef::vertexCount", 3, kMostVertices);
    if (def.indexCount < 3 || def.indexCount > kMaxIndices || def.indexCount % 3 != 0)
        core::refuse("FwMeshDef::indexCount is %u; it is a multiple of 3 in [3, %u].",
                     def.indexCount, kMaxIndices);
    if (def.indexSize != 2 && def.indexSize != 4)
        core::refuse("FwMeshDef::indexSize is %u; it is 2 or 4 bytes.", def.indexSize);
    components::checkWhole(def.mapSize, "FwMeshDef::mapSize", 8, 4096);
    if (!(def.texelsPerMetre > 0))
        core::refuse("FwMeshDef::texelsPerMetre is %g; the limits are (0, 4096].",
                     double(def.texelsPerMetre));
    components::checkValue(def.texelsPerMetre, "FwMeshDef::texelsPerMetre", 0, 4096);
    components::checkValue(def.noiseAmplitude, "FwMeshDef::noiseAmplitude", 0, 0.5f);
    components::checkValue(def.noiseFeature, "FwMeshDef::noiseFeature", 1e-4f, 1e3f);

    Input input{std::pmr::vector<uint32_t>(memory), {}};
    const size_t vertices = def.vertexCount;
    mesh::BakeInput& bake = input.bake;
    bake.positions = {def.positions, vertices * 3};
    bake.normals = optional(def.normals, vertices * 3);
    bake.uvs = optional(def.uvs, vertices * 2);
    bake.details = optional(def.details, vertices * 2);
    bake.tints = optional(def.colors, vertices);
    bake.triangleMaterials = optional(def.triangleMaterials, size_t(def.indexCount) / 3);
    if (def.indexSize == 4) {
        bake.indices = {static_cast<const uint32_t*>(def.indices), def.indexCount};
    } else {
        const auto* narrow = static_cast<const uint16_t*>(def.indices);
        input.wide.assign(narrow, narrow + def.indexCount);
        bake.indices = input.wide;
    }
    bake.texelsPerMetre = double(def.texelsPerMetre);
    bake.maxSide = def.mapSize;
    bake.noiseAmplitude = def.noiseAmplitude;
    bake.noiseFeature = def.noiseFeature;
    bake.noiseSeed = def.noiseSeed;
    bake.trustUvs = (def.flags & FW_MESH_TRUST_UVS) != 0;
    return input;
}

mesh::BurnDomain bakeOf(const FwMeshDef& def, std::pmr::memory_resource* memory) {
    const Input input = makeInput(def, memory);
    return mesh::bake(input.bake, memory);
}

}  // namespace

core::Owned<mesh::BurnDomain> makeDomain(const FwMeshDef& def, std::pmr::memory_resource* memory) {
    auto domain = core::Owned<mesh::BurnDomain>::make(memory, memory);
    if (def.cooked) {
        constexpr uint64_t kMost = uint64_t(1) << 32;
        if (def.cookedSize == 0 || def.cookedSize > kMost)
            core::refuse("FwMeshDef::cookedSize is %llu; the limits are [1, 2^32] bytes.",
                         static_cast<unsigned long long>(def.cookedSize));
        *domain = mesh::readCooked(
            {static_cast<const std::byte*>(def.cooked), size_t(def.cookedSize)}, memory);
    } else {
        *domain = bakeOf(def, memory);
    }
    return domain;
}

uint64_t cookKey(const FwMeshDef& def, std::pmr::memory_resource* memory) {
    const Input input = makeInput(def, memory);
    return mesh::bakeKey(input.bake);
}

std::pmr::vector<std::byte> cook(const FwMeshDef& def, std::pmr::memory_resource* memory) {
    if (def.cooked) core::refuse("FwMeshDef::cooked is given; only arrays can be cooked.");
    const Input input = makeInput(def, memory);
    const mesh::BurnDomain domain = mesh::bake(input.bake, memory);
    return mesh::writeCooked(domain, mesh::bakeKey(input.bake), memory);
}

}  // namespace fw::world
