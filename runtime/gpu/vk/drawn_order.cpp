#include "gpu/vk/drawn_order.h"

#include <algorithm>
#include <cstring>
#include <tuple>

namespace fw::gpu::vk {
namespace {

// The bits of `v` at even places.
uint32_t spread(uint32_t v) {
    v = (v | v << 8) & 0x00FF00FFu;
    v = (v | v << 4) & 0x0F0F0F0Fu;
    v = (v | v << 2) & 0x33333333u;
    return (v | v << 1) & 0x55555555u;
}

}  // namespace

uint32_t materialOf(const mesh::BurnDomain& domain, size_t corner) {
    return std::min(domain.vertices[domain.indices[corner]].material, kMaterialsPerObject - 1);
}

DrawnOrder::DrawnOrder(const mesh::BurnDomain& domain, std::pmr::memory_resource* memory)
    : triangles(memory), vertices(memory), numbers(domain.vertices.size(), ~0u, memory) {
    struct Key {
        uint32_t material, curve, corner;
    };
    std::pmr::vector<Key> keys(memory);
    keys.reserve(domain.indices.size() / 3);
    for (uint32_t i = 0; i + 2 < domain.indices.size(); i += 3) {
        float at[2] = {};
        for (uint32_t k = 0; k < 3; ++k) {
            const mesh::RenderVertex& v = domain.vertices[domain.indices[i + k]];
            for (uint32_t c = 0; c < 2; ++c) at[c] += v.atlasUv[c] * 2.0f;
        }
        const auto cell = [](float x) { return uint32_t(std::clamp(x, 0.0f, 65535.0f)); };
        keys.push_back({materialOf(domain, i), spread(cell(at[0])) | spread(cell(at[1])) << 1, i});
    }
    std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
        return std::tie(a.material, a.curve, a.corner) < std::tie(b.material, b.curve, b.corner);
    });
    triangles.reserve(keys.size());
    vertices.reserve(domain.vertices.size());
    const auto number = [&](uint32_t vertex) {
        if (numbers[vertex] != ~0u) return;
        numbers[vertex] = uint32_t(vertices.size());
        vertices.push_back(vertex);
    };
    for (const Key& key : keys) {
        triangles.push_back(key.corner);
        for (uint32_t k = 0; k < 3; ++k) number(domain.indices[key.corner + k]);
    }
    for (uint32_t i = 0; i < domain.vertices.size(); ++i) number(i);
}

void DrawnOrder::copyIndices(const mesh::BurnDomain& domain, std::byte* out) const {
    for (const uint32_t corner : triangles) {
        for (uint32_t k = 0; k < 3; ++k, out += 4)
            std::memcpy(out, &numbers[domain.indices[corner + k]], 4);
    }
}
void DrawnOrder::copyVertices(std::span<const mesh::RenderVertex> of, std::byte* out) const {
    for (const uint32_t old : vertices) {
        std::memcpy(out, &of[old], sizeof(mesh::RenderVertex));
        out += sizeof(mesh::RenderVertex);
    }
}

}  // namespace fw::gpu::vk
