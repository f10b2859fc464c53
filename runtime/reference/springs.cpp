#include "reference/far_links.h"
#include "reference/methods.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cstring>

namespace fw::reference {
namespace {

using gpu::kDeformRing;
using mesh::kNone;

glm::dvec3 placeOf(const mesh::RenderVertex& v) {
    return {v.position[0], v.position[1], v.position[2]};
}

glm::dvec3 unit(const glm::dvec3& v) {
    const double size = glm::length(v);
    return size > 1e-30 ? v / size : glm::dvec3(0);
}

}  // namespace

std::pmr::vector<FarLinks> makeFarLinks(const mesh::BurnDomain& domain,
                                        const mesh::DeformModel& model,
                                        std::pmr::memory_resource* memory) {
    std::pmr::vector<FarLinks> links(model.particles.size(), memory);
    const auto nodeAt = [&](uint32_t vertex) -> const gpu::DeformParticle& {
        return model.particles[model.particleOf[vertex]];
    };
    for (size_t i = 0; i < links.size(); ++i) {
        const gpu::DeformParticle& node = model.particles[i];
        const glm::dvec3 at = placeOf(domain.vertices[node.vertex]);
        std::fill(std::begin(links[i].vertex), std::end(links[i].vertex), kNone);
        for (uint32_t k = 0; k < (node.flags >> gpu::kParticleRingShift & 15u); ++k) {
            const gpu::DeformParticle& next = nodeAt(node.ring[k]);
            const glm::dvec3 middle = placeOf(domain.vertices[next.vertex]);
            const glm::dvec3 ahead = unit(middle - at);
            double straightest = 0.9;
            for (const uint32_t over : next.ring) {
                if (over == node.vertex || over == next.vertex) continue;
                const double c = glm::dot(ahead, unit(placeOf(domain.vertices[over]) - middle));
                if (c <= straightest) continue;
                straightest = c;
                links[i].vertex[k] = over;
            }
        }
    }
    // A link that only one end lists gets no length: forces need both ends.
    for (size_t i = 0; i < links.size(); ++i) {
        const gpu::DeformParticle& node = model.particles[i];
        for (uint32_t k = 0; k < kDeformRing; ++k) {
            const uint32_t far = links[i].vertex[k];
            if (far == kNone || far == node.vertex) continue;
            const auto& back = links[model.particleOf[far]].vertex;
            if (std::find(std::begin(back), std::end(back), node.vertex) == std::end(back))
                continue;
            const gpu::DeformParticle& other = nodeAt(far);
            links[i].length[k] = float(glm::length(glm::dvec3(double(other.x) - double(node.x),
                                                              double(other.y) - double(node.y),
                                                              double(other.z) - double(node.z))));
        }
    }
    return links;
}

void packFarLinks(const mesh::DeformModel& model, std::span<const FarLinks> links,
                  std::span<gpu::DeviceLinks> out) noexcept {
    const size_t count = links.size();
    FW_ASSERT(out.size() == count * gpu::kDeformLinkPasses, "%zu of %zu", out.size(), count);
    for (uint32_t i = 0; i < count; ++i)
        for (uint32_t turn = 0; turn < gpu::kDeformLinkPasses; ++turn) {
            const auto end = [&](uint32_t k) {
                const uint32_t vertex = links[i].vertex[2 * turn + k];
                return vertex == kNone ? i : model.particleOf[vertex];
            };
            const float* length = links[i].length + 2 * turn;
            out[turn * count + i] = {end(0), end(1), glm::packHalf2x16({length[0], length[1]}), 0};
        }
}

void createSprings(gpu::vk::BackendState& s, gpu::vk::ObjectEntry& fresh,
                   const gpu::ObjectInit& init, uint64_t last) {
    const mesh::DeformModel& model = *init.deformModel;
    const auto links = makeFarLinks(*s.scene.meshes[init.mesh].domain, model, s.memory);
    const auto count = uint32_t(links.size()) * gpu::kDeformLinkPasses;
    const uint64_t bytes = uint64_t(count) * sizeof(gpu::DeviceLinks);
    fresh.extensionWords = s.buffers.allocate(gpu::vk::kPoolExtensionWords, count, last);
    std::byte* const to =
        s.scene.uploads.stage(bytes, "far link staging")
            .region(FW_BIND_EXTENSION_WORDS, uint64_t(fresh.extensionWords.first()) * 16, bytes);
    packFarLinks(model, links, {reinterpret_cast<gpu::DeviceLinks*>(to), count});
}

}  // namespace fw::reference
