// The order in which a mesh's triangles and vertices lie on the device, which is not the host's.
#pragma once
#include "gpu/passes/pass.h"
#include "mesh/bake.h"

#include <cstddef>
#include <memory_resource>
#include <span>
#include <vector>

namespace fw::gpu::vk {

// Of a corner's triangle.
[[nodiscard]] uint32_t materialOf(const mesh::BurnDomain& domain, size_t corner);

// Triangles by material, then along a space-filling curve over the atlas; vertices as they come.
// Neighbours share vertices, so devices shade each vertex about once, whatever order hosts give.
struct DrawnOrder {
    std::pmr::vector<uint32_t> triangles;  // first corner of each
    std::pmr::vector<uint32_t> vertices;   // old number by new
    std::pmr::vector<uint32_t> numbers;    // new by old

    DrawnOrder(const mesh::BurnDomain& domain, std::pmr::memory_resource* memory);
    void copyIndices(const mesh::BurnDomain& domain, std::byte* out) const;
    void copyVertices(std::span<const mesh::RenderVertex> of, std::byte* out) const;
};

}  // namespace fw::gpu::vk
