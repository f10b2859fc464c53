// Creation and destruction of meshes: the data that objects of one mesh share on the device.
#include "gpu/vk/backend_state.h"
#include "gpu/vk/drawn_order.h"
#include "gpu/vk/vk_extension.h"
#include "mesh/exchange_tiles.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace fw::gpu::vk {
namespace {

// Where the runs of each material end, and how large triangles are.
void measureDrawn(const mesh::BurnDomain& domain, MeshEntry& entry) {
    double area = 0;
    for (size_t i = 0; i + 2 < domain.indices.size(); i += 3) {
        glm::dvec3 p[3];
        for (size_t k = 0; k < 3; ++k) {
            const auto& at = domain.vertices[domain.indices[i + k]].position;
            p[k] = {at[0], at[1], at[2]};
        }
        area += glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));  // of two
        for (size_t k = 0; k < 3; ++k) {
            const auto& from = domain.vertices[domain.indices[i + k]].atlasUv;
            const auto& to = domain.vertices[domain.indices[i + (k + 1) % 3]].atlasUv;
            entry.texelEdge =
                std::max(entry.texelEdge, std::hypot(from[0] - to[0], from[1] - to[1]));
        }
        entry.materialEnd[materialOf(domain, i)] += 3;
    }
    for (uint32_t m = 1; m < kMaterialsPerObject; ++m)
        entry.materialEnd[m] += entry.materialEnd[m - 1];
    if (entry.indices >= 3) entry.edge = float(std::sqrt(area / double(entry.indices / 3)));
}

}  // namespace

void VkBackend::createMesh(uint32_t slot, const mesh::BurnDomain& domain) {
    BackendState& s = *state_;
    const uint64_t last = s.ring.newest();
    MeshEntry& entry = slotOf(s.scene.meshes, slot);
    FW_ASSERT(!entry.live, "mesh %u is there", slot);
    MeshEntry fresh;
    fresh.live = true;
    fresh.width = domain.width;
    fresh.height = domain.height;
    fresh.tilesX = domain.tilesX;
    fresh.tiles = domain.tileCount();
    fresh.vertices = uint32_t(domain.vertices.size());
    fresh.indices = uint32_t(domain.indices.size());
    fresh.domain = &domain;
    fresh.parts = !domain.partLinks.empty();
    measureDrawn(domain, fresh);
    std::pmr::vector<ExchangeTile> exchangeTiles(s.memory);
    fresh.sourceCells = mesh::exchangeTiles(domain, exchangeTiles);
    const DrawnOrder order(domain, s.memory);
    const auto allocate = [&](BufferPool pool, size_t units) {
        return s.buffers.allocate(pool, std::max(1u, uint32_t(units)), last);
    };
    fresh.meshTiles = allocate(kPoolMeshTiles, fresh.tiles);
    fresh.slowness = allocate(kPoolSlowness, fresh.tiles);
    fresh.links = allocate(kPoolLinks, domain.links.size() / 8);
    fresh.dependents = allocate(kPoolDependents, domain.dependents.size());
    fresh.vertexRange = allocate(kPoolVertices, fresh.vertices);
    fresh.indexRange = allocate(kPoolIndices, fresh.indices);
    const auto bytesOf = [](const auto&... parts) {
        return (uint64_t(0) + ... + std::span(parts).size_bytes());
    };
    PendingUpload& upload = s.scene.uploads.stage(
        bytesOf(domain.texels, domain.normals, domain.tiles, domain.flameCells, exchangeTiles,
                domain.slowness, domain.links, domain.dependents, domain.vertices, domain.indices),
        "mesh staging");
    static_assert(sizeof(mesh::TexelPosition) == 8 && sizeof(mesh::TileStatic) == 32);
    const auto add = [&](uint32_t resource, const BufferRange& range, uint64_t perUnit,
                         const auto& data) {
        upload.add(resource, range.first() * perUnit, std::span(data));
    };
    add(FW_BIND_TEXELS, fresh.meshTiles, kTileTexels, domain.texels);
    add(FW_BIND_NORMALS, fresh.meshTiles, kTileTexels, domain.normals);
    add(FW_BIND_TILES, fresh.meshTiles, 1, domain.tiles);
    add(FW_BIND_FLAME_CELLS, fresh.meshTiles, 1, domain.flameCells);
    add(FW_BIND_EXCHANGE_TILES, fresh.meshTiles, 1, exchangeTiles);
    add(FW_BIND_SLOWNESS, fresh.slowness, kTileTexels, domain.slowness);
    add(FW_BIND_LINKS, fresh.links, 8, domain.links);
    add(FW_BIND_DEPENDENTS, fresh.dependents, 1, domain.dependents);
    // In the order in which the device has them.
    const auto place = [&](uint32_t resource, const BufferRange& range, const auto& data) {
        return upload.region(resource, range.first() * sizeof(data[0]), bytesOf(data));
    };
    order.copyVertices(domain.vertices,
                       place(kResourceVertices, fresh.vertexRange, domain.vertices));
    order.copyIndices(domain, place(kResourceIndices, fresh.indexRange, domain.indices));
    if (fresh.parts) ++s.scene.partMeshes;
    entry = std::move(fresh);
}

void VkBackend::createInnerSkin(uint32_t slot, const mesh::BurnDomain& domain,
                                std::span<const glm::vec3> places) {
    BackendState& s = *state_;
    std::pmr::vector<mesh::RenderVertex> vertices(domain.vertices, s.memory);
    FW_ASSERT(places.size() == vertices.size(), "%zu places of %zu vertices", places.size(),
              vertices.size());
    for (size_t i = 0; i < vertices.size(); ++i) {
        std::copy_n(&places[i].x, 3, vertices[i].position);
        vertices[i].material = 0;  // bound as shown vertices are, it is their lead
    }
    const DrawnOrder order(domain, s.memory);
    BufferRange range =
        s.buffers.allocate(kPoolVertices, uint32_t(vertices.size()), s.ring.newest());
    const uint64_t bytes = vertices.size() * sizeof(mesh::RenderVertex);
    PendingUpload& upload = s.scene.uploads.stage(bytes, "inner skin staging");
    order.copyVertices(vertices, upload.region(kResourceVertices,
                                               range.first() * sizeof(mesh::RenderVertex), bytes));
    s.scene.meshes[slot].innerVertices = std::move(range);
}

// Ranges are reused at once: all our work is in one queue's order, behind barriers.
void VkBackend::destroyMesh(uint32_t slot) noexcept {
    MeshEntry& entry = state_->scene.meshes[slot];
    if (entry.parts) --state_->scene.partMeshes;
    entry = {};
    if (extension()) extension()->vulkan->destroyMesh(*state_, slot);
}

}  // namespace fw::gpu::vk
