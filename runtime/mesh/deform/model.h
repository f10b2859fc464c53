// What deformation needs to know of a mesh: its nodes (points of the drawn mesh, with all vertices
// on them), which way and how far each may recede, the texels around it, its neighbours; and what
// normals follow. Static, per mesh, made when the first object wants it. Moves nothing itself.
#pragma once
#include "mesh/burn_domain.h"
#include "shared/deform.h"

#include <cstring>

namespace fw::mesh {

struct DeformModel {
    explicit DeformModel(std::pmr::memory_resource* memory)
        : nodes(memory), coats(memory), nodeOf(memory) {}

    std::pmr::vector<gpu::DeformNode> nodes;  // `vertex`, `ring`, `cross_`: of BurnDomain::vertices
    std::pmr::vector<gpu::DeformCoat> coats;  // per vertex of the domain
    std::pmr::vector<uint32_t> nodeOf;        // per vertex of the domain
    float span = 0;                           // m, about the length of arms
};

// Vertices at one place are one node, whatever their normals and UVs.
DeformModel makeDeformModel(const BurnDomain& domain, std::pmr::memory_resource* memory);

// A node as devices have it: other nodes by number, with the odds of their links.
gpu::DeviceNode deviceNode(const DeformModel& model, uint32_t number) noexcept;
// Record `number` of `count`, nodes or coats, as devices have them: quad by quad.
template <class Record>
void putQuads(const Record& record, size_t number, size_t count, std::byte* to) noexcept {
    for (size_t quad = 0; quad < sizeof record / 16; ++quad)
        std::memcpy(to + (quad * count + number) * 16,
                    reinterpret_cast<const std::byte*>(&record) + quad * 16, 16);
}

}  // namespace fw::mesh
