// Deformation of sheets: curling, shrinking, tearing and falling (XPBD), and the springs of the
// reference implementation. The CPU reads the maths of the passes.
#include "reference/deform_solver.h"

#include "support/sanitized.h"
#include "unit/mesh_checks.h"

#include <random>

namespace {

using namespace fw;
using namespace fw::test;
using gpu::vec3;
using mesh::DeformModel;
using mesh::DeformState;
using mesh::SheetDrive;

constexpr double kPaper = 0.2;  // m
constexpr float kSheetStep = float(gpu::kSoftTicks) / 4096;

gpu::DeformObject paper(float curl, float shrink = 0) {
    gpu::DeformObject object{};
    object.flags = gpu::kDeformShell;
    object.ground = -1e9f;
    object.scale = 1;
    for (gpu::DeformMaterial& m : object.materials) {
        m.curl = curl;
        m.shrink = shrink;
        m.bend = 0.5f;
        m.drag = 0;
    }
    return object;
}
void pin(gpu::DeformObject& object, vec3 from, vec3 to, float radius) {
    object.pins[object.pinCount * 2] = gpu::vec4(from, radius);
    object.pins[object.pinCount * 2 + 1] = gpu::vec4(to, 0);
    ++object.pinCount;
}

struct Sheet {
    BurnDomain domain;
    DeformModel model;
    DeformState state;
    gpu::DeformObject object;
    SheetDrive drive;

    Sheet(int cells, const gpu::DeformObject& what)
        : domain(bakeOf(makeSheet(kPaper, cells).input(64))),
          model(mesh::makeDeformModel(domain, std::pmr::new_delete_resource())),
          state(std::pmr::new_delete_resource()),
          object(what) {
        mesh::resetDeform(model, state);
        mesh::resetSoft(model, object, state);
        drive.gravity = 0;
        drive.updraft = 0;
    }
    void run(int steps) {
        for (int i = 0; i < steps; ++i) mesh::sheetStep(model, object, drive, state);
    }
    vec3 at(const gpu::DeformParticle& node) const {
        const gpu::ShownVertex& v = state.shown[node.vertex];
        return {v.x, v.y, v.z};
    }
    vec3 nearest(vec3 rest) const {
        const gpu::DeformParticle* best = nullptr;
        float least = 1e30f;
        for (const gpu::DeformParticle& node : model.particles) {
            const float d = gpu::length(vec3(node.x, node.y, node.z) - rest);
            if (d >= least) continue;
            least = d;
            best = &node;
        }
        return at(*best);
    }
    template <class Of>
    void burn(Of of) {
        for (const gpu::DeformParticle& node : model.particles)
            state.shown[node.vertex].burnt = of(vec3(node.x, node.y, node.z));
    }
    double kinetic() const {
        double sum = 0;
        for (const gpu::DeformParticle& node : model.particles) {
            const vec3 v = state.soft[node.vertex].place[state.parity] - at(node);
            sum += double(gpu::dot(v, v)) / double(drive.step) / double(drive.step) / 2;
        }
        return sum;
    }
    // Energy per unit mass: kinetic, and stored in links and bends.
    double energy() const {
        const double perStep = 1 / double(drive.step) / double(drive.step);
        double sum = kinetic();
        for (const gpu::DeformParticle& node : model.particles) {
            const DeformState::Soft& self = state.soft[node.vertex];
            for (uint32_t k = 0; k < gpu::kDeformRing; ++k) {
                const float rest = gpu::unpackHalf2x16(node.ringLength[k / 2])[int(k & 1)];
                if (!(rest > 0)) continue;
                const double over =
                    double(gpu::length(state.soft[node.ring[k]].place[state.parity] -
                                       self.place[state.parity]) -
                           rest);
                sum += double(gpu::kLinkRelax) / 8 * over * over * perStep;
            }
            const float stiff = std::max(object.materials[0].bend, 1e-3f);
            for (int kind = 0; kind < 2;
                 ++kind) {  // bending constraints of one direction, previous step
                const vec3 bend = self.bend[kind];
                const float relax = stiff * (kind ? gpu::kBendSetRelax : gpu::kBendRelax);
                sum += double(gpu::dot(bend, bend)) / 2 / double(relax) * perStep;
            }
        }
        return sum;
    }
    // Largest ratio of length to rest length over intact links.
    double stretch() const {
        double worst = 0;
        for (const gpu::DeformParticle& node : model.particles)
            for (uint32_t k = 0; k < gpu::kDeformRing; ++k) {
                const float rest = gpu::unpackHalf2x16(node.ringLength[k / 2])[int(k & 1)];
                if (!(rest > 0)) continue;
                const gpu::DeformParticle& other = model.particles[model.particleOf[node.ring[k]]];
                if (!gpu::linkHolds(state.shown[node.vertex].burnt, state.shown[other.vertex].burnt,
                                    gpu::linkOdds(model.particleOf[node.vertex],
                                                  model.particleOf[other.vertex])))
                    continue;
                worst = std::max(worst, double(gpu::length(at(node) - at(other)) / rest));
            }
        return worst;
    }
};

TEST(DeformSheet, StaysFlatWithoutFireOrForce) {
    Sheet s(16, paper(30));
    s.run(500);
    for (const gpu::DeformParticle& node : s.model.particles)
        ASSERT_LT(gpu::length(s.at(node) - vec3(node.x, node.y, node.z)), 1e-4f);
}

// From a crumpled start without input, energy only falls.
TEST(DeformSheet, EnergyNeverGrows) {
    for (const float bend : {0.0f, 0.3f, 0.9f}) {
        gpu::DeformObject object = paper(0);
        for (gpu::DeformMaterial& m : object.materials) m.bend = bend;
        Sheet s(16, object);
        std::mt19937 random(5);
        std::uniform_real_distribution<float> off(-0.0005f, 0.0005f);
        for (const gpu::DeformParticle& node : s.model.particles) {
            vec3& p = s.state.soft[node.vertex].place[0];
            p += vec3(off(random), off(random), off(random) + 0.01f * std::sin(20 * node.x));
        }
        double before = 1e30;
        for (int window = 0; window < rounds(40, 8); ++window) {
            double energy = 0;  // it swings between its shapes
            for (int i = 0; i < 50; ++i) {
                s.run(5);
                energy = std::max(energy, s.energy());
            }
            ASSERT_TRUE(std::isfinite(energy));
            ASSERT_LE(energy, before * 1.001 + 1e-5) << "window " << window << " bend " << bend;
            before = energy;
        }
        if (kSanitized) continue;  // windows too short to judge
        EXPECT_LT(before, 0.05);
        EXPECT_LT(s.kinetic(), 1e-3);
        EXPECT_LT(s.stretch(), 1.02);
    }
}

// A sheet held at one edge chars towards the other. `share`: how much nearer that edge comes to the
// sheet's middle. `lift`: m that particles leave the plane, at most.
struct Curl {
    double nearer = 0, most = 0;
};
Curl curlOf(float step, float curl) {
    gpu::DeformObject object = paper(curl);
    pin(object, {0, 0, 0}, {0, float(kPaper), 0}, 0.001f);
    for (gpu::DeformMaterial& m : object.materials) m.drag = 8;
    Sheet s(16, object);
    s.drive.step = step;
    s.burn([](vec3 at) { return 0.75f * std::max(0.0f, 2 * at.x / float(kPaper) - 1); });
    s.run(int(8.0f / step));
    Curl made;
    for (const gpu::DeformParticle& node : s.model.particles) {
        const double z = std::fabs(double(s.at(node).z));
        made.most = std::max(made.most, z);
    }
    constexpr int kRows = 9;
    for (int i = 0; i < kRows; ++i) {
        const float y = float(kPaper) * float(i) / (kRows - 1), half = 0.5f * float(kPaper);
        const float chord = gpu::length(s.nearest({half, y, 0}) - s.nearest({2 * half, y, 0}));
        made.nearer += double(1 - chord / half) / kRows;
    }
    return made;
}

TEST(DeformSheet, CharredPaperCurlsAtAnyTimeStep) {
    const Curl flat = curlOf(kSheetStep, 0), curled = curlOf(kSheetStep, 60),
               finer = curlOf(kSheetStep / 2, 60);
    std::printf(
        "[   FIGURE ] of %.2f m: nearer by %.4f, %.4f m at most; at half the step %.4f, %.4f\n",
        kPaper, curled.nearer, curled.most, finer.nearer, finer.most);
    EXPECT_LT(flat.most, 1e-4);
    EXPECT_GT(curled.most, 0.02);
    EXPECT_GT(curled.nearer, 0.04);
    EXPECT_NEAR(1, finer.nearer / curled.nearer, 0.05);
}

TEST(DeformSheet, CharredClothShrinks) {
    Sheet s(16, paper(0, 0.2f));
    s.burn([](vec3) { return 0.75f; });
    s.run(2000);
    const float side = gpu::length(s.nearest({float(kPaper), 0, 0}) - s.nearest({0, 0, 0}));
    EXPECT_NEAR(0.8 * kPaper, side, 0.02 * kPaper);
}

// A hanging cloth keeps its length; the part cut off below falls.
TEST(DeformSheet, HangsAndFallsWhenBurntOff) {
    gpu::DeformObject object = paper(0);
    pin(object, {0, float(kPaper), 0}, {float(kPaper), float(kPaper), 0}, 0.001f);
    object.ground = -0.5f;
    for (gpu::DeformMaterial& m : object.materials) m.drag = 4;
    Sheet s(24, object);
    s.drive.gravity = 9.81f;
    s.run(1000);
    const vec3 corner = s.nearest({0, 0, 0});
    EXPECT_LT(corner.y, 0.002f);
    EXPECT_GT(corner.y, -0.02f * float(kPaper));  // stretched by 2 % at most
    s.burn([](vec3 at) { return std::fabs(at.y - 0.1f) < 0.012f ? 1.0f : 0.0f; });
    s.run(600);
    EXPECT_LT(s.nearest({0.1f, 0.02f, 0}).y, -0.45f);
    EXPECT_GE(s.nearest({0.1f, 0.02f, 0}).y, -0.501f);
    EXPECT_GT(s.nearest({0.1f, 0.18f, 0}).y, 0.15f);
}

// Nothing holds the sheet any more, although each particle's neighbours still report support.
TEST(DeformSheet, FallsAtOnceWhenItsPinsHaveBurnt) {
    gpu::DeformObject object = paper(0);
    pin(object, {0, float(kPaper), 0}, {float(kPaper), float(kPaper), 0}, 0.001f);
    Sheet s(24, object);
    s.drive.gravity = 9.81f;
    s.run(400);
    const float before = s.nearest({0.1f, 0.1f, 0}).y;
    s.burn([](vec3 at) { return at.y > 0.195f ? 1.0f : 0.0f; });
    s.run(128);
    const float fallen = before - s.nearest({0.1f, 0.1f, 0}).y;
    std::printf("[   FIGURE ] %.2f m in a second\n", double(fallen));
    EXPECT_GT(fallen, 0.9f);
}

// Mean bend (m) within 5 cm of a sheet in a strong wind, over its particles and 4 s.
double bendsInWind(int cells, float stiffness, bool arms) {
    gpu::DeformObject object = paper(0);
    pin(object, {0, float(kPaper), 0}, {float(kPaper), float(kPaper), 0}, 0.001f);
    for (gpu::DeformMaterial& m : object.materials) {
        m.bend = stiffness;
        m.drag = 8;
    }
    Sheet s(cells, object);
    s.drive.gravity = 9.81f;
    s.drive.wind = {0.2f, 0, 2};
    std::vector<uint32_t> at(size_t(cells + 1) * size_t(cells + 1));
    const float cell = float(kPaper) / float(cells);
    for (gpu::DeformParticle& node : s.model.particles) {
        if (!arms) std::fill(std::begin(node.bendEnds), std::end(node.bendEnds), kNone);
        const auto column = size_t(std::lround(node.x / cell));
        at[size_t(std::lround(node.y / cell)) * size_t(cells + 1) + column] = node.vertex;
    }
    const auto place = [&](int x, int y) {
        const gpu::ShownVertex& v = s.state.shown[at[size_t(y * (cells + 1) + x)]];
        return vec3(v.x, v.y, v.z);
    };
    const int reach = cells / 4;
    double sum = 0, known = 0;
    for (int step = 0; step < 640; ++step) {
        s.drive.time = float(step) * kSheetStep;
        s.run(1);
        if (step < 128 || step % 16) continue;
        for (int y = reach; y + reach <= cells; ++y)
            for (int x = reach; x + reach <= cells; ++x) {
                const vec3 middle = place(x, y);
                sum += double(
                    gpu::length((place(x - reach, y) + place(x + reach, y)) * 0.5f - middle) +
                    gpu::length((place(x, y - reach) + place(x, y + reach)) * 0.5f - middle));
                known += 2;
            }
    }
    return sum / known;
}

// For every mesh resolution; cloth does not resist.
TEST(DeformSheet, PaperResistsBendingBeyondItsMeshResolution) {
    const double rag = bendsInWind(24, 0.8f, false), paper = bendsInWind(24, 0.8f, true);
    const double fine = bendsInWind(rounds(40, 32), 0.8f, true),
                 cloth = bendsInWind(24, 0.03f, true);
    std::printf("[   FIGURE ] %.4f m, finer %.4f; by neighbours alone %.4f; cloth %.4f\n", paper,
                fine, rag, cloth);
    EXPECT_LT(paper, 0.5 * rag);
    EXPECT_LT(fine, 0.7 * rag);
    EXPECT_GT(cloth, 1.5 * paper);
}

// From creation on, the sheet neither drops before its pins are known nor is flung back afterwards.
TEST(DeformSheet, PinsHoldFromTheFirstStep) {
    gpu::DeformObject object = paper(0);
    pin(object, {0, float(kPaper), 0}, {float(kPaper), float(kPaper), 0}, 0.001f);
    for (gpu::DeformMaterial& m : object.materials) m.drag = 4;
    Sheet s(24, object);
    s.drive.gravity = 9.81f;
    float worst = 0;
    for (int step = 0; step < 128; ++step) {
        s.run(1);
        for (const gpu::DeformParticle& node : s.model.particles)
            worst = std::max(worst, gpu::length(s.at(node) - vec3(node.x, node.y, node.z)));
    }
    EXPECT_LT(worst, 0.02f * float(kPaper));
}

TEST(DeformSheet, UnburntLinksNeverBreak) {
    for (uint32_t a = 0; a < 50; ++a)
        for (uint32_t b = 0; b < 50; ++b) {
            const uint32_t odds = gpu::linkOdds(a, b);
            EXPECT_EQ(odds, gpu::linkOdds(b, a));
            EXPECT_LT(odds, 256u);
            EXPECT_TRUE(gpu::linkHolds(0.79f, 1, odds));
            EXPECT_TRUE(gpu::linkHolds(1, 0.79f, odds));
            EXPECT_FALSE(gpu::linkHolds(0.96f, 1, odds));
        }
}

TEST(DeformSheet, AcceptsDegenerateMeshes) {
    for (uint32_t seed = 0; seed < fw::test::rounds(16u, 4u); ++seed) {
        const Mesh soup = makeSoup(seed);
        if (!refusal(soup.input(32)).empty()) continue;
        const BurnDomain domain = bakeOf(soup.input(32));
        const DeformModel model = mesh::makeDeformModel(domain, std::pmr::new_delete_resource());
        DeformState state(std::pmr::new_delete_resource());
        mesh::resetDeform(model, state);
        const gpu::DeformObject object = paper(100, 0.5f);
        mesh::resetSoft(model, object, state);
        SheetDrive drive;
        drive.wind = {30, -20, 10};
        for (gpu::ShownVertex& v : state.shown) v.burnt = 0.7f;
        for (int i = 0; i < 300; ++i) mesh::sheetStep(model, object, drive, state);
        mesh::skinVertices(model, state);
        for (const gpu::ShownVertex& v : state.shown)
            ASSERT_TRUE(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z)) << seed;
    }
}

// ---- springs of the reference implementation

// A row of particles with springs between neighbours: the stability bound on the fastest mode is
// sharp.
double springSpread(float share) {
    constexpr uint32_t kNodes = 64;
    constexpr float kRest = 0.0625f;
    DeformModel model(std::pmr::new_delete_resource());
    DeformState state(std::pmr::new_delete_resource());
    model.embeddings.resize(kNodes);
    for (uint32_t i = 0; i < kNodes; ++i) {
        gpu::DeformParticle node{};
        node.x = kRest * float(i);
        node.vertex = i;
        std::fill(std::begin(node.ring), std::end(node.ring), i);
        node.ring[0] = i ? i - 1 : i;
        node.ring[1] = i + 1 < kNodes ? i + 1 : i;
        node.ringLength[0] = gpu::packHalf2x16({i ? kRest : 0.0f, i + 1 < kNodes ? kRest : 0.0f});
        model.particles.push_back(node);
        model.embeddings[i].particle = i;
        for (uint32_t& other : model.embeddings[i].ring) other = i;
    }
    mesh::resetDeform(model, state);
    gpu::DeformObject object{};
    mesh::resetSoft(model, object, state);
    const float stiffness = gpu::springsAt(share, kSheetStep, 2) / gpu::kSpringShare;
    std::mt19937 random(3);
    std::uniform_real_distribution<float> off(-1e-5f, 1e-5f);
    for (uint32_t i = 0; i < kNodes; ++i) state.soft[i].place[0].x += off(random);
    double worst = 0;
    for (int i = 0; i < 10000; ++i) {
        mesh::springStep(model, {}, stiffness, kSheetStep, {}, 0, state);
        if (i % 100) continue;
        for (uint32_t n = 0; n < kNodes; ++n)
            worst = std::max(worst, double(std::fabs(state.shown[n].x - model.particles[n].x)));
        if (!std::isfinite(worst) || worst > 1) return 1e9;
    }
    return worst;
}

TEST(DeformSprings, AreStableBelowTheBoundAndNotAbove) {
    EXPECT_LT(springSpread(0.7f), 0.01);
    EXPECT_LT(springSpread(0.98f), 0.02);
    EXPECT_GT(springSpread(1.03f), 1.0);
}

TEST(DeformSprings, DecayMovesInwardsByTheLostDepth) {
    const Mesh ball = makeCube(0.2, 8, true);
    const BurnDomain domain = bakeOf(ball.input(64));
    const DeformModel model = mesh::makeDeformModel(domain, std::pmr::new_delete_resource());
    DeformState state(std::pmr::new_delete_resource());
    mesh::resetDeform(model, state);
    gpu::DeformObject object{};
    mesh::resetSoft(model, object, state);
    const std::vector<float> lost(model.particles.size(), 1e-5f);
    const auto far = reference::makeFarLinks(domain, model, std::pmr::new_delete_resource());
    for (int i = 0; i < 128; ++i)
        mesh::springStep(model, far, gpu::springStiffness(), kSheetStep, lost, gpu::kSpringDamping,
                         state);
    double sum = 0;
    for (const gpu::DeformParticle& node : model.particles) {
        const gpu::ShownVertex& v = state.shown[node.vertex];
        const float r = gpu::length(vec3(v.x, v.y, v.z));
        ASSERT_GT(r, 0.05f);
        sum += double(r);
    }
    EXPECT_LT(sum / double(model.particles.size()), 0.0995);
}

}  // namespace
