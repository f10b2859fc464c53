// Meshes as they come and go: what objects of one mesh share on the device.
#include "gpu/vk/drawn_order.h"
#include "gpu/vk/world_state.h"
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
    State& s = *state_;
    const uint64_t last = s.ring.newest();
    MeshEntry& entry = slotOf(s.scene.meshes, slot);
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
    const size_t uploadsBefore = s.scene.uploads.size();
    const struct {
        RangeOf* range;
        BufferPool pool;
        uint32_t units;
    } wanted[] = {
        {&fresh.meshTiles, kPoolMeshTiles, fresh.tiles},
        {&fresh.slowness, kPoolSlowness, fresh.tiles},
        {&fresh.links, kPoolLinks, std::max(1u, uint32_t(domain.links.size() / 8))},
        {&fresh.readers, kPoolDependents, std::max(1u, uint32_t(domain.readers.size()))},
        {&fresh.vertexRange, kPoolVertices, std::max(1u, fresh.vertices)},
        {&fresh.indexRange, kPoolIndices, std::max(1u, fresh.indices)},
    };
    try {
        for (const auto& one : wanted) {
            one.range->first = s.buffers.allocate(one.pool, one.units, last);
            one.range->units = one.units;
        }
        const struct {
            uint32_t resource;
            const void* data;
            uint64_t bytes, at;
        } parts[] = {
            {FW_BIND_TEXELS, domain.texels.data(), domain.texels.size() * 8,
             uint64_t(fresh.meshTiles.first) * kTileTexels * 8},
            {FW_BIND_NORMALS, domain.normals.data(), domain.normals.size() * 4,
             uint64_t(fresh.meshTiles.first) * kTileTexels * 4},
            {FW_BIND_TILES, domain.tiles.data(), domain.tiles.size() * 32,
             uint64_t(fresh.meshTiles.first) * 32},
            {FW_BIND_EXCHANGE_TILES, exchangeTiles.data(),
             exchangeTiles.size() * sizeof(ExchangeTile),
             uint64_t(fresh.meshTiles.first) * sizeof(ExchangeTile)},
            {FW_BIND_SLOWNESS, domain.slowness.data(), domain.slowness.size() * 2,
             uint64_t(fresh.slowness.first) * kTileTexels * 2},
            {FW_BIND_LINKS, domain.links.data(), domain.links.size() * 4,
             uint64_t(fresh.links.first) * 32},
            {FW_BIND_DEPENDENTS, domain.readers.data(), domain.readers.size() * 4,
             uint64_t(fresh.readers.first) * 4},
            {kResourceVertices, domain.vertices.data(), domain.vertices.size() * 48,
             uint64_t(fresh.vertexRange.first) * 48},
            {kResourceIndices, domain.indices.data(), domain.indices.size() * 4,
             uint64_t(fresh.indexRange.first) * 4},
        };
        static_assert(std::size(parts) <= PendingUpload::kMaxRegions);
        uint64_t bytes = 0;
        for (const auto& part : parts) bytes += part.bytes;
        PendingUpload& upload = s.stage(bytes, "mesh staging");
        uint64_t from = 0;
        for (const auto& part : parts) {
            if (part.bytes == 0) continue;
            if (part.resource == kResourceIndices)
                order.copyIndices(domain, upload.staging.mapped + from);
            else if (part.resource == kResourceVertices)
                order.copyVertices(domain.vertices, upload.staging.mapped + from);
            else
                std::memcpy(upload.staging.mapped + from, part.data, part.bytes);
            upload.regions[upload.regionCount++] = {part.resource, from, part.at, part.bytes};
            from += part.bytes;
        }
    } catch (...) {
        for (const auto& one : wanted) {
            if (one.range->units) s.buffers.release(one.pool, one.range->first, one.range->units);
        }
        s.dropUploads(uploadsBefore);
        throw;
    }
    entry = fresh;
    if (entry.parts) ++s.scene.partMeshes;
}

void VkBackend::createInnerSkin(uint32_t slot, const mesh::BurnDomain& domain,
                                std::span<const glm::vec3> places) {
    State& s = *state_;
    std::pmr::vector<mesh::RenderVertex> vertices(domain.vertices, s.memory);
    for (size_t i = 0; i < vertices.size(); ++i) {
        std::copy_n(&places[i].x, 3, vertices[i].position);
        vertices[i].material = 0;  // bound as shown vertices are, it is their lead
    }
    const DrawnOrder order(domain, s.memory);
    RangeOf range{0, uint32_t(vertices.size())};
    range.first = s.buffers.allocate(kPoolVertices, range.units, s.ring.newest());
    try {
        const uint64_t bytes = vertices.size() * sizeof(mesh::RenderVertex);
        PendingUpload& upload = s.stage(bytes, "inner skin staging");
        order.copyVertices(vertices, upload.staging.mapped);
        upload.regions[upload.regionCount++] = {
            kResourceVertices, 0, uint64_t(range.first) * sizeof(mesh::RenderVertex), bytes};
    } catch (...) {
        s.buffers.release(kPoolVertices, range.first, range.units);
        throw;
    }
    s.scene.meshes[slot].innerVertices = range;
}

void VkBackend::destroyMesh(uint32_t slot) noexcept {
    State& s = *state_;
    MeshEntry& entry = s.scene.meshes[slot];
    if (!entry.live) return;
    if (entry.parts) --s.scene.partMeshes;
    // Ranges are reused at once: all our work is in one queue's order, behind barriers.
    s.buffers.release(kPoolMeshTiles, entry.meshTiles.first, entry.meshTiles.units);
    s.buffers.release(kPoolSlowness, entry.slowness.first, entry.slowness.units);
    s.buffers.release(kPoolLinks, entry.links.first, entry.links.units);
    s.buffers.release(kPoolDependents, entry.readers.first, entry.readers.units);
    s.buffers.release(kPoolVertices, entry.vertexRange.first, entry.vertexRange.units);
    s.buffers.release(kPoolIndices, entry.indexRange.first, entry.indexRange.units);
    if (entry.innerVertices.units)
        s.buffers.release(kPoolVertices, entry.innerVertices.first, entry.innerVertices.units);
    for (RefineMesh& one : entry.refine)
        if (one.live) one.release(s.buffers);
    if (entry.nodes.units)
        s.buffers.release(kPoolSheetParticles, entry.nodes.first, entry.nodes.units);
    if (entry.embeddings.units)
        s.buffers.release(kPoolEmbeddings, entry.embeddings.first, entry.embeddings.units);
    if (entry.skin.units) s.buffers.release(kPoolSkin, entry.skin.first, entry.skin.units);
    if (entry.skinSources.units)
        s.buffers.release(kPoolSkinSources, entry.skinSources.first, entry.skinSources.units);
    entry = {};
}

}  // namespace fw::gpu::vk
