// Recession of solids: which vertices move together, direction and depth, remaining volume, and
// when walls open. Uses the maths of the passes.
#include "reference/deform_solver.h"

#include "support/sanitized.h"
#include "unit/mesh_checks.h"

namespace {

using namespace fw;
using namespace fw::test;
using gpu::kTicksPerSecond;
using gpu::vec3;
using mesh::DeformModel;
using mesh::DeformState;

DeformModel modelOf(const BurnDomain& domain) {
    return mesh::makeDeformModel(domain, std::pmr::new_delete_resource());
}
DeformState restOf(const DeformModel& model) {
    DeformState state(std::pmr::new_delete_resource());
    mesh::resetDeform(model, state);
    return state;
}
vec3 placeOf(const gpu::ShownVertex& v) { return {v.x, v.y, v.z}; }

// One material: consumed after `seconds` s, `depth` m deep by then, holes after `hole` s of
// appearance time.
gpu::DeformObject objectOf(float seconds, float depth, float hole = 0) {
    gpu::DeformObject object{};
    for (gpu::DeformMaterial& m : object.materials) {
        m.charTicks = uint32_t(seconds * float(kTicksPerSecond));
        m.depth = depth;
        m.holeTicks = hole > 0 ? uint32_t(hole * float(kTicksPerSecond)) : gpu::kNoneTexel;
        m.holeSeconds = hole;
    }
    return object;
}
// Every covered texel caught at tick 1.
std::vector<uint32_t> allLit(const BurnDomain& domain) {
    std::vector<uint32_t> states(domain.texelCount(), gpu::kInert);
    for (uint32_t i = 0; i < domain.texelCount(); ++i)
        if (domain.real(i)) states[i] = 1;
    return states;
}

double volumeOf(const BurnDomain& domain, const DeformState& state) {
    double sum = 0;
    for (size_t i = 0; i + 2 < domain.indices.size(); i += 3) {
        const glm::dvec3 a(placeOf(state.shown[domain.indices[i]]));
        const glm::dvec3 b(placeOf(state.shown[domain.indices[i + 1]]));
        const glm::dvec3 c(placeOf(state.shown[domain.indices[i + 2]]));
        sum += glm::dot(a, glm::cross(b, c)) / 6;
    }
    return sum;
}

TEST(DeformMaths, PicksTheMipByEquation9) {
    EXPECT_EQ(0u, gpu::mipOfRing(16, 16));
    EXPECT_EQ(3u, gpu::mipOfRing(1024, 16));
    EXPECT_EQ(0u, gpu::mipOfRing(63, 16));
    EXPECT_EQ(1u, gpu::mipOfRing(64, 16));
    EXPECT_EQ(0u, gpu::mipOfRing(0, 16));
}

TEST(DeformMaths, NormalsRotateWithTheirFaces) {
    const vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    EXPECT_EQ(z, gpu::rotateNormal(z, y, y));
    EXPECT_NEAR(0, gpu::length(gpu::rotateNormal(x, x, y) - y), 1e-6f);
    EXPECT_NEAR(0, gpu::length(gpu::rotateNormal(z, x, y) - z), 1e-6f);
    EXPECT_EQ(-x, gpu::rotateNormal(y, x, -x));
    for (const vec3 v : {x, y, -z, vec3(0.6f, 0, -0.8f)})
        EXPECT_NEAR(0, gpu::length(gpu::unpackDirection(gpu::packDirection(v)) - v), 2e-3f);
}

TEST(DeformModel, CornersOfABoxRecedeOnAllThreeFaces) {
    const Mesh box = makeCube(0.4, 4);
    const BurnDomain domain = bakeOf(box.input(64));
    const DeformModel model = modelOf(domain);
    EXPECT_EQ(98u, model.particles.size());  // 6 * 25, less 12 edges * 3, less 8 corners * 2
    ASSERT_EQ(domain.vertices.size(), model.embeddings.size());
    for (const gpu::DeformParticle& node : model.particles) {
        const float at[3] = {node.x, node.y, node.z}, out[3] = {node.outX, node.outY, node.outZ};
        for (int k = 0; k < 3; ++k) {
            const float side = at[k] > 0.199f ? -1.0f : (at[k] < -0.199f ? 1.0f : 0.0f);
            EXPECT_NEAR(side, out[k], 0.01f);
        }
        EXPECT_NEAR(0.05f / std::sqrt(2.0f) /
                        std::sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]),
                    node.limit, 1e-3f);
        EXPECT_LT(0u, node.flags >> gpu::kParticleRingShift & 15u);
        EXPECT_TRUE(node.flags & gpu::kParticleClosed);
    }
}

// Bending constraints are mutual and of similar length; closed ones have none; particles of a run
// agree.
TEST(DeformModel, BendingConstraintsAreMutualAndRunsAgree) {
    const Mesh sheet = makeSheet(0.3, 20), ball = makeCube(0.3, 10, true);
    for (const Mesh* mesh : {&sheet, &ball}) {
        const BurnDomain domain = bakeOf(mesh->input(64));
        const DeformModel model = modelOf(domain);
        size_t armed = 0;
        for (uint32_t i = 0; i < model.particles.size(); ++i) {
            const gpu::DeformParticle& node = model.particles[i];
            ASSERT_EQ(i, model.particleOf[node.vertex]);
            const gpu::DeformParticle& first =
                model.particles[i / gpu::kDeformRun * gpu::kDeformRun];
            constexpr uint32_t kShared = (7u << gpu::kParticlePassesShift) | gpu::kParticleHasBends;
            EXPECT_EQ(first.flags & kShared, node.flags & kShared) << i;
            EXPECT_GE((node.flags >> gpu::kParticlePassesShift & 7u) * gpu::kLinksPerPass,
                      node.flags >> gpu::kParticleRingShift & 15u);
            for (uint32_t arm = 0; arm < 2 * gpu::kBendSets; ++arm) {
                if (node.bendEnds[arm] == kNone) continue;
                const gpu::DeformParticle& other =
                    model.particles[model.particleOf[node.bendEnds[arm]]];
                EXPECT_EQ(node.vertex, other.bendEnds[arm ^ 1]);
                EXPECT_EQ(node.bendLength[arm], other.bendLength[arm ^ 1]);
                EXPECT_NEAR(arm < 4 ? model.span : 0.6f * model.span, node.bendLength[arm],
                            0.15f * model.span);
                ++armed;
            }
        }
        if (mesh == &ball) {
            EXPECT_EQ(0u, armed);
        } else {
            EXPECT_GT(armed, model.particles.size() * 4);
        }
    }
}

TEST(RecedingSolid, VerticesSplitBySeamsStayTogether) {
    const Mesh sphere = randomUnwrap(makeCube(0.4, 12, true), 7, 20);
    const BurnDomain domain = bakeOf(sphere.input(128));
    const DeformModel model = modelOf(domain);
    ASSERT_LT(model.particles.size(), domain.vertices.size());
    DeformState state = restOf(model);
    std::vector<uint32_t> states = allLit(domain);
    for (uint32_t i = 0; i < states.size(); ++i)
        if (states[i] == 1) states[i] = 1 + domain.texels[i].x * 8u;  // a front along x
    const gpu::DeformObject object = objectOf(60, 0.02f);
    for (uint32_t now = 1; now < 200 * kTicksPerSecond; now += 9 * kTicksPerSecond) {
        mesh::recede(model, object, states, now, state);
        mesh::skinVertices(model, state);
        for (uint32_t v = 0; v < domain.vertices.size(); ++v) {
            const gpu::ShownVertex& a = state.shown[v];
            const gpu::ShownVertex& b = state.shown[model.particles[model.particleOf[v]].vertex];
            ASSERT_EQ(0, std::memcmp(&a, &b, 12)) << v;
        }
    }
}

TEST(RecedingSolid, UnburntMeshesDoNotChange) {
    const Mesh sphere = makeCube(0.4, 8, true);
    const BurnDomain domain = bakeOf(sphere.input(64));
    const DeformModel model = modelOf(domain);
    const DeformState state = restOf(model);
    for (uint32_t v = 0; v < domain.vertices.size(); ++v) {
        const float* rest = domain.vertices[v].position;
        ASSERT_EQ(vec3(rest[0], rest[1], rest[2]), placeOf(state.shown[v])) << v;
        ASSERT_EQ(domain.vertices[v].normal, state.shown[v].normal) << v;
    }
}

// The lost volume equals the burnt skin: exact on flat faces, close on round ones.
TEST(RecedingSolid, LostVolumeEqualsBurntFuel) {
    for (const bool sphere : {false, true}) {
        const Mesh mesh = makeCube(0.4, 16, sphere);
        const BurnDomain domain = bakeOf(mesh.input(64));
        const DeformModel model = modelOf(domain);
        DeformState state = restOf(model);
        const double before = volumeOf(domain, state);
        const double depth = 0.004;
        mesh::recede(model, objectOf(60, float(depth)), allLit(domain), 1 + 60 * kTicksPerSecond,
                     state);
        mesh::skinVertices(model, state);
        const double gone = before - volumeOf(domain, state);
        const double expected = domain.report.meshArea * depth;
        EXPECT_NEAR(expected, gone, (sphere ? 0.10 : 0.05) * expected) << sphere;
    }
}

TEST(RecedingSolid, NeverRecedesThroughTheFarWallOrBack) {
    const Mesh sphere = makeCube(0.2, 16, true);
    const BurnDomain domain = bakeOf(sphere.input(128));
    const DeformModel model = modelOf(domain);
    DeformState state = restOf(model);
    mesh::recede(model, objectOf(10, 1.0f), allLit(domain), 100 * kTicksPerSecond, state);
    mesh::skinVertices(model, state);
    EXPECT_LT(0, volumeOf(domain, state));
    for (size_t i = 0; i + 2 < domain.indices.size(); i += 3) {
        const auto& n = domain.indices;
        const vec3 a = placeOf(state.shown[n[i]]);
        const vec3 face =
            gpu::cross(placeOf(state.shown[n[i + 1]]) - a, placeOf(state.shown[n[i + 2]]) - a);
        ASSERT_LT(0, gpu::dot(face, a)) << i;  // still faces outwards
    }
    const vec3 before = placeOf(state.shown[0]);
    std::vector<uint32_t> out(domain.texelCount(), gpu::kOut);
    mesh::recede(model, objectOf(10, 1.0f), out, 101 * kTicksPerSecond, state);
    EXPECT_EQ(before, placeOf(state.shown[0]));
}

// A slab eaten from both sides at 0.65 mm/min opens in half the time, on both sides together.
TEST(RecedingSolid, SlabsOpenOnBothSidesTogether) {
    constexpr float kSlab = 0.010f, kCharRate = 0.65e-3f / 60;
    Mesh mesh;
    constexpr int kCells = 12;
    for (int side = 0; side < 2; ++side)
        for (int y = 0; y <= kCells; ++y)
            for (int x = 0; x <= kCells; ++x)
                mesh.addVertex(0.3 * x / kCells, 0.3 * y / kCells, side ? -double(kSlab) : 0.0,
                               (x + side * 1.2 * kCells) / 30.0, y / 30.0);
    for (uint32_t side = 0; side < 2; ++side)
        for (uint32_t y = 0; y < kCells; ++y)
            for (uint32_t x = 0; x < kCells; ++x) {
                const uint32_t a = side * (kCells + 1) * (kCells + 1) + y * (kCells + 1) + x;
                const uint32_t b = a + 1, c = a + kCells + 1, d = c + 1;
                if (side) {
                    mesh.addTriangle(a, c, b);
                    mesh.addTriangle(b, c, d);
                } else {
                    mesh.addTriangle(a, b, c);
                    mesh.addTriangle(b, d, c);
                }
            }
    const BurnDomain domain = bakeOf(mesh.input(128));
    const DeformModel model = modelOf(domain);
    const float whole = kSlab / kCharRate;  // s, from one side alone
    const gpu::DeformObject object = objectOf(whole, kSlab, whole);
    std::vector<uint32_t> states = allLit(domain);
    // The second side catches later, from one end to the other.
    for (uint32_t i = 0; i < states.size(); ++i)
        if (states[i] == 1 && gpu::unpackDirection(domain.normals[i]).z < 0)
            states[i] = 1 + domain.texels[i].x * 4u;
    uint32_t opened = 0;
    double worst = 0;
    std::vector<float> openAt(model.particles.size(), 0);
    DeformState state = restOf(model);
    const auto seconds = [](uint32_t ticks) { return float(ticks) / float(kTicksPerSecond); };
    for (uint32_t now = 1; now < uint32_t(1000 * kTicksPerSecond); now += kTicksPerSecond) {
        mesh::recede(model, object, states, now, state);
        for (size_t i = 0; i < model.particles.size(); ++i) {
            const gpu::DeformParticle& node = model.particles[i];
            const uint32_t t = states[node.texels[0]];
            const float age = now > t ? seconds(now - t) : 0;
            if (openAt[i] == 0 && age + state.shown[node.vertex].behind >= whole)
                openAt[i] = seconds(now);
        }
    }
    const size_t half = model.particles.size() / 2;
    for (size_t i = 0; i < half; ++i) {
        ASSERT_NE(kNone, model.particles[i].opposite);
        // The rule, from both sides' own ticks.
        const float a = seconds(states[model.particles[i].texels[0]]);
        const float b = seconds(states[model.particles[i].opposite]);
        const float rule = std::max((whole + a + b) / 2, std::max(a, b));
        worst = std::max(worst, double(std::fabs(openAt[i] - rule) / rule));
        ++opened;
    }
    EXPECT_EQ(half, opened);
    EXPECT_LT(worst, 0.05);
    // Both lit together: 462 s on either side.
    const std::vector<uint32_t> together = allLit(domain);
    for (const gpu::DeformParticle& node : model.particles) {
        state = restOf(model);
        mesh::recede(model, object, together, 1 + uint32_t(439 * kTicksPerSecond), state);
        EXPECT_LT(439 + state.shown[node.vertex].behind, whole);
        mesh::recede(model, object, together, 1 + uint32_t(485 * kTicksPerSecond), state);
        EXPECT_GE(485 + state.shown[node.vertex].behind, whole);
        if (&node - model.particles.data() > 4) break;
    }
}

TEST(DeformModel, AcceptsDegenerateMeshes) {
    for (uint32_t seed = 0; seed < fw::test::rounds(24u, 6u); ++seed) {
        const Mesh soup = makeSoup(seed);
        if (!refusal(soup.input(32)).empty()) continue;
        const BurnDomain domain = bakeOf(soup.input(32));
        const DeformModel model = modelOf(domain);
        DeformState state = restOf(model);
        std::vector<uint32_t> states = allLit(domain);
        mesh::recede(model, objectOf(5, 0.1f, 5), states, 50 * kTicksPerSecond, state);
        mesh::skinVertices(model, state);
        for (const gpu::ShownVertex& v : state.shown)
            ASSERT_TRUE(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z)) << seed;
    }
}

}  // namespace
