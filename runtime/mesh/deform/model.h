// A mesh's static data for deformation: particles (points of the drawn mesh, with all vertices
// there), the direction and limit of each particle's recession, the texels around it, its
// neighbours; and the faces that drawn normals follow. Made per mesh for the first object that
// deforms.
#pragma once
#include "mesh/burn_domain.h"
#include "shared/deform.h"

#include <cstring>

namespace fw::mesh {

struct DeformModel {
    explicit DeformModel(std::pmr::memory_resource* memory)
        : particles(memory), embeddings(memory), particleOf(memory) {}

    std::pmr::vector<gpu::DeformParticle> particles;    // `vertex`, `ring`: of BurnDomain::vertices
    std::pmr::vector<gpu::DeformEmbedding> embeddings;  // per vertex of the domain
    std::pmr::vector<uint32_t> particleOf;              // per vertex of the domain
    float span = 0;  // m, about the distance between the ends of bending constraints
};

// Vertices at one place are one particle, whatever their normals and UVs.
DeformModel makeDeformModel(const BurnDomain& domain, std::pmr::memory_resource* memory);

// Sets DeformModel::span and the particles' bending constraints: two particles some distance apart
// with a third in their middle. They bend a sheet more widely than neighbours do
// (shared/deform.h). Closed meshes are stiff and have none. Of makeDeformModel; needs particles
// with rings and areas, and embeddings.
void findBends(DeformModel& model, std::pmr::memory_resource* memory);

// A particle in the device's form: other particles by number, with the odds of their links.
gpu::DeviceParticle deviceParticle(const DeformModel& model, uint32_t number) noexcept;
// Writes record `number` of `count` (particles or embeddings) in the device's order: quad by quad.
template <class Record>
void putQuads(const Record& record, size_t number, size_t count, std::byte* to) noexcept {
    FW_ASSERT(number < count, "%zu of %zu records", number, count);
    for (size_t quad = 0; quad < sizeof record / 16; ++quad)
        std::memcpy(to + (quad * count + number) * 16,
                    reinterpret_cast<const std::byte*>(&record) + quad * 16, 16);
}

}  // namespace fw::mesh
