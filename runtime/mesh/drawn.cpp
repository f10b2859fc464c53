// The drawn mesh: input corners with their places in the atlas, split where the atlas is cut.
#include "mesh/texels.h"

#include <cmath>
#include <cstring>
#include <glm/gtc/type_ptr.hpp>
#include <numeric>

namespace fw::mesh {
namespace {

constexpr double kCreaseCosine = 0.5;  // 60 degrees
constexpr int kChainLimit = 256;

// Normal of every corner: shared over edges that bend less than the crease angle.
std::pmr::vector<glm::dvec3> computeNormals(const Surface& surface) {
    const auto& triangles = surface.triangles;
    std::pmr::vector<uint32_t> parent(triangles.size() * 3, surface.memory);
    std::iota(parent.begin(), parent.end(), 0u);
    for (uint32_t i = 0; i < triangles.size(); ++i)
        for (uint32_t e = 0; e < 3; ++e) {
            const uint32_t n = triangles[i].neighbour[e];
            if (n == kNone || n < i) continue;
            if (glm::dot(triangles[i].normal, triangles[n].normal) < kCreaseCosine) continue;
            for (uint32_t corner : {e, (e + 1) % 3})
                for (uint32_t other = 0; other < 3; ++other)
                    if (triangles[n].point[other] == triangles[i].point[corner])
                        parent[rootOf(parent, i * 3 + corner)] = rootOf(parent, n * 3 + other);
        }
    std::pmr::vector<glm::dvec3> normals(parent.size(), glm::dvec3(0), surface.memory);
    for (uint32_t i = 0; i < triangles.size(); ++i)
        for (uint32_t k = 0; k < 3; ++k) {  // weighted by sine of the corner over its edge lengths
            const Triangle& t = triangles[i];
            const glm::dvec3 a = t.position[(k + 1) % 3] - t.position[k];
            const glm::dvec3 b = t.position[(k + 2) % 3] - t.position[k];
            const double scale = std::max(1e-300, glm::dot(a, a) * glm::dot(b, b));
            normals[rootOf(parent, i * 3 + k)] += t.normal * (2 * t.area / scale);
        }
    for (uint32_t i = 0; i < normals.size(); ++i) {
        const glm::dvec3 sum = normals[rootOf(parent, i)];
        if (rootOf(parent, i) != i) normals[i] = sum;
    }
    for (uint32_t i = 0; i < normals.size(); ++i)
        normals[i] = unitOr(normals[i], triangles[i / 3].normal);
    return normals;
}

}  // namespace

uint32_t packNormal(glm::dvec3 normal) {
    FW_ASSERT(normal == normal, "a component is NaN");
    const auto field = [](double v, int one) {
        return uint32_t(std::clamp(int(std::floor(v * one + 0.5)), -one, one));
    };
    return (field(normal.x, 1023) & 0x7FFu) | (field(normal.y, 1023) & 0x7FFu) << 11 |
           (field(normal.z, 511) & 0x3FFu) << 22;
}

void buildDrawn(const BakeInput& input, const Surface& surface, BurnDomain& domain) {
    std::pmr::vector<glm::dvec3> computed(surface.memory);
    if (input.normals.empty()) computed = computeNormals(surface);
    // Per input vertex: a chain of the corners made of it.
    std::pmr::vector<uint32_t> first(input.positions.size() / 3, kNone, surface.memory);
    std::pmr::vector<uint32_t> next(surface.memory);
    domain.indices.reserve(surface.triangles.size() * 3);
    for (uint32_t i = 0; i < surface.triangles.size(); ++i) {
        const Triangle& t = surface.triangles[i];
        for (uint32_t k = 0; k < 3; ++k) {
            const size_t source = t.corner[k];
            FW_ASSERT(source < first.size(), "vertex %zu of %zu", source, first.size());
            RenderVertex v;
            glm::dvec3 normal = input.normals.empty() ? computed[i * 3 + k] : t.normal;
            if (!input.normals.empty()) {
                const glm::dvec3 given(glm::make_vec3(&input.normals[source * 3]));
                const double length = glm::length(given);
                if (length > 1e-12) normal = given / length;
            }
            v.normal = packNormal(normal);
            std::copy_n(&input.positions[source * 3], 3, v.position);
            for (int c = 0; c < 2; ++c) v.atlasUv[c] = float(t.uv[k][c]);
            if (!input.uvs.empty()) std::copy_n(&input.uvs[source * 2], 2, v.textureUv);
            if (!input.details.empty()) std::copy_n(&input.details[source * 2], 2, v.detail);
            if (!input.tints.empty()) v.tint = input.tints[source];
            v.material = t.material;
            uint32_t same = first[source];
            int tries = 0;  // beyond kChainLimit different corners, each gets a vertex of its own
            while (same != kNone && std::memcmp(&domain.vertices[same], &v, sizeof v) != 0)
                same = ++tries < kChainLimit ? next[same] : kNone;
            if (same == kNone) {
                same = uint32_t(domain.vertices.size());
                domain.vertices.push_back(v);
                domain.sources.push_back(uint32_t(source));
                next.push_back(first[source]);
                first[source] = same;
            }
            domain.indices.push_back(same);
        }
    }
    domain.hasDetail = !input.details.empty();
}

}  // namespace fw::mesh
