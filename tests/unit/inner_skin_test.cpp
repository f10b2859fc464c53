// The inner skin of unrefined objects: at wall thickness under every face at any crease, one place
// per vertex position, none for open or solid parts.
#include "mesh/refine/model.h"
#include "support/refine_scene.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

namespace fw::test {
namespace {

constexpr float kWall = 0.02f;  // m

std::pmr::vector<glm::vec3> skinOf(const mesh::BurnDomain& domain) {
    return mesh::innerSkin(domain, kWall, std::pmr::new_delete_resource());
}

glm::vec3 restOf(const mesh::BurnDomain& domain, uint32_t vertex) {
    const float* p = domain.vertices[vertex].position;
    return {p[0], p[1], p[2]};
}

// Every corner of every face lies `wall` m under that face, and vertices at one position stay
// together.
void expectDeep(const mesh::BurnDomain& domain, const std::pmr::vector<glm::vec3>& skin,
                float slack) {
    ASSERT_EQ(domain.vertices.size(), skin.size());
    std::map<std::array<float, 3>, glm::vec3> places;
    for (size_t i = 0; i < domain.indices.size(); i += 3) {
        glm::vec3 p[3];
        for (size_t k = 0; k < 3; ++k) p[k] = restOf(domain, domain.indices[i + k]);
        const glm::vec3 normal = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
        for (size_t k = 0; k < 3; ++k) {
            const glm::vec3 inner = skin[domain.indices[i + k]];
            ASSERT_NEAR(kWall, glm::dot(p[k] - inner, normal), slack) << "corner " << i + k;
            const auto [at, fresh] = places.try_emplace({p[k].x, p[k].y, p[k].z}, inner);
            ASSERT_EQ(at->second, inner) << "corner " << i + k;
        }
    }
}

TEST(InnerSkin, LiesAtWallThicknessUnderEveryFace) {
    const mesh::BurnDomain box = RefineScene::bakeDomain(gridBox(1, 0.8, 0.6, 2, 3, 1, 11), 64);
    expectDeep(box, skinOf(box), 0.01f * kWall);
    const mesh::BurnDomain home = RefineScene::bakeDomain(house(1, 0.8, 1.5, 0.4, 1, 3), 64);
    expectDeep(home, skinOf(home), 0.01f * kWall);
}

// Plain normals would open concave edges.
TEST(InnerSkin, KeepsConcaveEdgesClosed) {
    constexpr double kAround[][2] = {{0, 0},     {0.4, 0}, {1, 0}, {1, 0.4},
                                     {0.4, 0.4}, {0.4, 1}, {0, 1}, {0, 0.4}};
    constexpr size_t kSides = std::size(kAround);
    SideBuilder s;
    for (size_t i = 0; i < kSides; ++i) {
        const double *a = kAround[i], *b = kAround[(i + 1) % kSides];
        s.side({a[0], a[1], 0}, {b[0] - a[0], b[1] - a[1], 0}, {0, 0, 0.5}, 1, 1);
    }
    for (const bool top : {true, false}) {  // three rectangles each
        const double z = top ? 0.5 : 0;
        const Vec3 wide = top ? Vec3{0.4, 0, 0} : Vec3{0, 0.4, 0};
        const Vec3 deep = top ? Vec3{0, 0.4, 0} : Vec3{0.4, 0, 0};
        s.side({0, 0, z}, wide, deep, 1, 1);
        if (top) {
            s.side({0.4, 0, z}, {0.6, 0, 0}, {0, 0.4, 0}, 1, 1);
            s.side({0, 0.4, z}, {0.4, 0, 0}, {0, 0.6, 0}, 1, 1);
        } else {
            s.side({0.4, 0, z}, {0, 0.4, 0}, {0.6, 0, 0}, 1, 1);
            s.side({0, 0.4, z}, {0, 0.6, 0}, {0.4, 0, 0}, 1, 1);
        }
    }
    const mesh::BurnDomain domain = RefineScene::bakeDomain(s.mesh, 64);
    expectDeep(domain, skinOf(domain), 0.01f * kWall);
}

// Triangles smaller than the wall thickness do not limit it.
TEST(InnerSkin, WorksOnFineMeshes) {
    const mesh::BurnDomain ball = RefineScene::bakeDomain(makeCube(0.3, 20, true), 128);
    expectDeep(ball, skinOf(ball), 0.1f * kWall);
}

// Opposite walls do not pass through each other.
TEST(InnerSkin, DoesNotInvertThinObjects) {
    const mesh::BurnDomain board = RefineScene::bakeDomain(gridBox(1, 1, 0.024, 4, 4, 1), 64);
    const std::pmr::vector<glm::vec3> skin = skinOf(board);
    ASSERT_EQ(board.vertices.size(), skin.size());
    for (uint32_t i = 0; i < skin.size(); ++i)
        EXPECT_GT((skin[i].z - 0.012f) * (restOf(board, i).z - 0.012f), 0) << "vertex " << i;
}

TEST(InnerSkin, OpenMeshesHaveNone) {
    EXPECT_TRUE(skinOf(RefineScene::bakeDomain(makePlane(0.6, 0.4), 64)).empty());
    Mesh open = gridBox(1, 1, 1, 1, 1, 1);
    open.indices.resize(open.indices.size() - 6);  // without its floor
    EXPECT_TRUE(skinOf(RefineScene::bakeDomain(open, 64)).empty());
}

}  // namespace
}  // namespace fw::test
