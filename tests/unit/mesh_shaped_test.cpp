// A stretched burn domain against the geometry of the stretched mesh.
#include "mesh/bake.h"
#include "shared/front.h"
#include "support/meshes.h"

#include <gtest/gtest.h>
#include <glm/glm.hpp>

namespace fw::test {
namespace {

glm::dvec3 cornerOf(const mesh::BurnDomain& domain, size_t index) {
    const float* p = domain.vertices[domain.indices[index]].position;
    return {p[0], p[1], p[2]};
}

TEST(MeshShaped, MatchesTheStretchedMesh) {
    auto* memory = std::pmr::get_default_resource();
    const Mesh cube = makeCube(1.0, 4, true, false);
    mesh::BakeInput input = cube.input(48, 512);
    const mesh::BurnDomain from = mesh::bake(input, memory);
    for (const float mirror : {1.0f, -1.0f}) {
        const float shape[3] = {0.5f * mirror, 1.5f, 1.0f};
        const mesh::BurnDomain made = mesh::shaped(from, shape, memory);
        double area = 0, volume = 0;
        for (size_t i = 0; i + 2 < made.indices.size(); i += 3) {
            const glm::dvec3 a = cornerOf(made, i), b = cornerOf(made, i + 1),
                             c = cornerOf(made, i + 2);
            area += glm::length(glm::cross(b - a, c - a)) / 2;
            volume += glm::dot(a, glm::cross(b, c)) / 6;
        }
        EXPECT_GT(volume, 0) << "faces turn outwards";
        EXPECT_NEAR(made.report.texelArea, area, 0.01 * area);
        EXPECT_NEAR(made.report.meshArea, area, 0.02 * area);
        double sum = 0;
        for (uint32_t i = 0; i < made.texelCount(); ++i) {
            if (!made.real(i)) continue;
            sum += double(made.areas[i]);
            const mesh::TexelPosition& p = made.texels[i];
            const glm::dvec3 at = glm::dvec3(made.origin[0], made.origin[1], made.origin[2]) +
                                  double(made.quantum) * glm::dvec3(p.x, p.y, p.z);
            const size_t t = size_t(made.triangleOf[i]) * 3;
            const glm::dvec3 a = cornerOf(made, t), b = cornerOf(made, t + 1),
                             c = cornerOf(made, t + 2);
            const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
            ASSERT_LT(std::abs(glm::dot(at - a, normal)), 2 * double(made.quantum)) << i;
            const auto n = gpu::decodeNormal(made.normals[i]);
            ASSERT_GT(glm::dot(glm::dvec3(n.x, n.y, n.z) / 16384.0, normal), 0.995) << i;
        }
        EXPECT_NEAR(sum, made.report.texelArea, 1e-6 * sum);
        EXPECT_LE(made.linkMax, 8191 * made.quantum);
        EXPECT_LT(made.linkShort, from.linkShort);
        EXPECT_GE(made.linkShort, 0.5f * from.linkShort);
        EXPECT_EQ(made.links.size(), from.links.size());
    }
    const float same[3] = {1, 1, 1};
    const mesh::BurnDomain unit = mesh::shaped(from, same, memory);
    EXPECT_NEAR(unit.texelSide, from.texelSide, 1e-6f);
    EXPECT_NEAR(unit.linkMax, from.linkMax, 2 * from.quantum);
}

}  // namespace
}  // namespace fw::test
