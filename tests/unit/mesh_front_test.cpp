// The bake judged by the front on its links: confetti atlases, other unwraps of one mesh, and delay
// at seams of real meshes.
#include "core/hash.h"
#include "support/front_rig.h"
#include "support/sanitized.h"
#include "unit/mesh_checks.h"

namespace {

using namespace fw;
using namespace fw::test;

constexpr double kRate = 0.02;  // m/s

BurnDomain domainOf(const Mesh& mesh, double density, bool trust) {
    mesh::BakeInput input = mesh.input(density, 4096);
    input.trustUvs = trust;
    return bakeOf(input);
}

// Lights a disc of 3.1 texels around texel `start`, so that its first texels do not matter.
void lightAt(FrontRig& rig, const BurnDomain& d, uint32_t start) {
    const Vec3 from = texelPosition(d, start);
    rig.ignite([&](uint32_t i) {
        const double s = length(texelPosition(d, i) - from);
        return s < 3.1 * double(d.texelSide) ? s / kRate : -1;
    });
    rig.runAll();
}

// Every triangle is its own chart, shuffled over the atlas: the front must not change.
TEST(MeshFront, ConfettiAtlasesBurnLikeOneChart) {
    const double h = 1.0 / 128;
    for (double leg : {16.0, 8.0, 4.0, 2.0, 1.0, 0.5}) {
        if (kSanitized && leg < 2) continue;
        const int cells = int(std::min(100.0, 120 / leg));
        const double size = cells * leg * h;
        const BurnDomain d = domainOf(makeConfetti(size, cells, 3 * h), 128, true);
        FrontRig rig(d, {.rate = kRate});
        rig.ignite([&](uint32_t i) {
            const double x = texelPosition(d, i).x;
            return x < 4 * h ? x / kRate : -1;
        });
        rig.runAll();
        double worst = 0, sum = 0;
        int count = 0, unburnt = 0;
        for (uint32_t i = 0; i < d.texelCount(); ++i) {
            if (!d.real(i)) continue;
            const Vec3 p = texelPosition(d, i);
            unburnt += rig.arrival(i) < 0;
            if (p.x < 0.6 * size || std::abs(p.y / size - 0.5) > 0.4) continue;
            const double e = rig.arrival(i) / (p.x / kRate) - 1;
            worst = std::max(worst, std::abs(e));
            sum += e;
            ++count;
        }
        std::printf("confetti, legs %4.1f texels: unburnt %d, mean %+.2f %%, worst %.2f %%\n", leg,
                    unburnt, sum / count * 100, worst * 100);
        EXPECT_EQ(unburnt, 0) << leg;
        EXPECT_LT(std::abs(sum / count), 0.001) << leg;
        EXPECT_LT(worst, 0.006) << leg;
    }
}

// The same from a point over short paths, where a whole square has 0.5 and 1.1 %.
TEST(MeshFront, ConfettiAtlasesBurnLikeOneChartFromAPoint) {
    for (int cells : {4, 8, 16, 32, 64}) {
        const BurnDomain d = domainOf(makeConfetti(0.5, cells, 0.02), 128, true);
        const double h = double(d.texelSide);
        const uint32_t start = texelNear(d, {0.25, 0.25, 0});
        FrontRig rig(d, {.rate = kRate});
        lightAt(rig, d, start);
        double worst = 0, sum = 0;
        int count = 0;
        for (uint32_t i = 0; i < d.texelCount(); ++i) {
            if (!d.real(i)) continue;
            const double s = length(texelPosition(d, i) - texelPosition(d, start));
            if (s < 20 * h) continue;
            const double e = rig.arrival(i) / (s / kRate) - 1;
            worst = std::max(worst, std::abs(e));
            sum += e;
            ++count;
        }
        std::printf("from a point, legs %4.1f texels: mean %+.2f %%, worst %.2f %%\n",
                    0.5 / cells / h, sum / count * 100, worst * 100);
        EXPECT_LT(std::abs(sum / count), 0.009) << cells;
        EXPECT_LT(worst, 0.02) << cells;
    }
}

// Arrival at a point near texel i: a plane fitted to the arrivals of its ring. Samples of two
// unwraps lie up to 0.7 texels apart, more than the fronts differ.
double arrivalAt(const BurnDomain& d, const FrontRig& rig, uint32_t i, Vec3 point) {
    std::vector<std::pair<Vec3, double>> samples{{texelPosition(d, i), rig.arrival(i)}};
    for (uint32_t k = 0; k < 8; ++k)
        if (const uint32_t j = ringOf(d, i, k); j != kNone && rig.arrival(j) >= 0)
            samples.push_back({texelPosition(d, j), rig.arrival(j)});
    Vec3 middle;
    double mean = 0;
    for (const auto& [p, t] : samples) {
        middle = middle + p * (1.0 / double(samples.size()));
        mean += t / double(samples.size());
    }
    double m[3][4] = {};  // normal equations with a small ridge term: the samples have no depth
    for (const auto& [p, t] : samples) {
        const Vec3 e = p - middle;
        const double v[4] = {e.x, e.y, e.z, t - mean};
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 4; ++b) m[a][b] += v[a] * v[b];
    }
    for (int a = 0; a < 3; ++a)
        m[a][a] += 0.01 * double(d.texelSide) * double(d.texelSide) * double(samples.size());
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) {
            if (a == b) continue;
            const double f = m[b][a] / m[a][a];
            for (int k = 0; k < 4; ++k) m[b][k] -= f * m[a][k];
        }
    const Vec3 e = point - middle;
    return mean + m[0][3] / m[0][0] * e.x + m[1][3] / m[1][1] * e.y + m[2][3] / m[2][2] * e.z;
}

TEST(MeshFront, TenUnwrapsBurnAtTheSameTimes) {
    Mesh mesh;
    FW_LOAD_OR_SKIP(mesh, "bunny_4k.glb");
    struct Sample {
        Vec3 point;
        double arrival;
    };
    std::vector<Sample> reference;
    Vec3 start;
    for (uint32_t seed = 0; seed <= 10; ++seed) {
        const BurnDomain d =
            domainOf(seed == 0 ? mesh : randomUnwrap(mesh, seed, 40 + 60 * (seed % 4)), 64, false);
        const double h = double(d.texelSide);
        if (seed == 0) start = texelPosition(d, texelNear(d, {0, 0.6, 0.2}));
        FrontRig rig(d, {.rate = kRate});
        const uint32_t nearest = texelNear(d, start);
        rig.ignite([&](uint32_t i) {
            const double s = length(texelPosition(d, i) - start);
            return i == nearest || s < 2.5 * h ? s / kRate : -1;
        });
        rig.runAll();
        if (seed == 0) {
            std::vector<uint32_t> reals;
            for (uint32_t i = 0; i < d.texelCount(); ++i)
                if (d.real(i)) reals.push_back(i);
            for (uint32_t k = 0; k < 400; ++k) {
                const uint32_t i = reals[core::hash32(k) % reals.size()];
                const Vec3 p = texelPosition(d, i);
                if (length(p - start) > 15 * h) reference.push_back({p, rig.arrival(i)});
            }
            continue;
        }
        double worst = 0, sum = 0;
        for (const Sample& sample : reference) {
            const uint32_t i = texelNear(d, sample.point);
            ASSERT_GE(rig.arrival(i), 0) << "unwrap " << seed;
            const double later = arrivalAt(d, rig, i, sample.point) - sample.arrival;
            worst = std::max(worst, std::abs(later) * kRate / h);
            sum += std::abs(later) / sample.arrival;
        }
        std::printf("unwrap %2u: %u charts, mean %.2f %%, worst %.2f links\n", seed,
                    d.report.charts, sum / double(reference.size()) * 100, worst);
        EXPECT_LT(sum / double(reference.size()), 0.0035) << seed;
        EXPECT_LT(worst, 1.0) << seed;
    }
}

// Largest delay of the front, in nominal links, between texels that read each other across a seam,
// over all link records.
double worstSeamJump(const BurnDomain& d, const FrontRig& rig) {
    double worst = 0;
    for (uint32_t i = 0; i < d.texelCount(); ++i)
        for (uint32_t k = 0; d.real(i) && isRim(d, i) && k < 8; ++k) {
            const uint32_t j = ringOf(d, i, k);
            if (j == kNone || rig.arrival(i) < 0 || rig.arrival(j) < 0) continue;
            const double took = std::abs(rig.arrival(i) - rig.arrival(j)) * kRate;
            worst = std::max(worst, (took - linkMetres(d, i, j)) / double(d.texelSide));
        }
    return worst;
}

TEST(MeshFront, SeamDelaysOnRealMeshesAreSmall) {
    struct Case {
        const char* name;
        bool unwrap;  // with our charts in place of the mesh's UVs
        double density;
    };
    for (const Case& c : {Case{"bunny_4k.glb", true, 128}, Case{"bunny_4k.glb", true, 32},
                          Case{"bunny_4k.glb", false, 128}, Case{"bunny_4k.glb", false, 32},
                          Case{"bunny_31k.glb", true, 128}, Case{"spot.glb", true, 128},
                          Case{"bunny_35k_nouv.glb", false, 128}}) {
        Mesh mesh;
        FW_LOAD_OR_SKIP(mesh, c.name);
        if (!c.unwrap) mesh.uvs.clear();
        const BurnDomain d = domainOf(mesh, c.density, false);
        EXPECT_LE(d.report.aspectP99, 2.0);
        EXPECT_EQ(0u, d.report.withoutDependents) << "fire lit there could not spread";
        FrontRig rig(d, {.rate = kRate});
        lightAt(rig, d, texelNear(d, {0, 0.6, 0.2}));
        const double jump = worstSeamJump(d, rig);
        std::printf("%s, %s UVs, %3.0f/m: worst seam jump %.2f links\n", c.name,
                    d.report.usedOwnUv ? "its own" : "our", c.density, jump);
        EXPECT_LE(jump, 0.6) << c.name;
    }
}

}  // namespace
