#include "mesh/deform/model.h"
#include "mesh/surface.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace fw::mesh {
namespace {

using gpu::DeformParticle;
using gpu::vec3;

constexpr double kSpanShare = 0.34;  // of the narrower side of the mesh
constexpr float kShorter = 0.6f;     // length of every other constraint, of the span
constexpr float kAside =
    0.15f;  // farthest that a particle may be off the place sought, of the span
constexpr float kFacing = 0.5f;  // cosine between normals at both ends, at least
constexpr float kEven = 0.02f;   // of the span, that the middle of two ends may be off, aside
// Squared, of the particles at edges to all particles: 16 for a square sheet.
constexpr double kOpen = 4;

vec3 restPlace(const DeformParticle& particle) { return {particle.x, particle.y, particle.z}; }

// The two directions in which a mesh is widest, and how wide it is there.
struct Axes {
    std::array<vec3, 2> along;
    std::array<double, 2> wide{};
};
Axes axesOf(std::span<const DeformParticle> particles) {
    double weights = 0;
    glm::dvec3 middle(0);
    for (const DeformParticle& particle : particles) {
        middle += glm::dvec3(restPlace(particle)) * double(particle.area);
        weights += double(particle.area);
    }
    middle /= std::max(weights, 1e-30);
    double m[3][3]{};
    for (const DeformParticle& particle : particles) {
        const glm::dvec3 d = glm::dvec3(restPlace(particle)) - middle;
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) m[r][c] += d[r] * d[c] * double(particle.area);
    }
    // Eigenvectors, by Jacobi's rotations.
    glm::dvec3 vectors[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const double all = m[0][0] + m[1][1] + m[2][2];
    for (int sweep = 0; sweep < 12; ++sweep)
        for (int p = 0; p < 2; ++p)
            for (int q = p + 1; q < 3; ++q) {
                if (std::fabs(m[p][q]) <= 0.01 * all) continue;
                const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
                const double t =
                    (theta < 0 ? -1 : 1) / (std::fabs(theta) + std::sqrt(theta * theta + 1));
                const double c = 1 / std::sqrt(t * t + 1), s = t * c;
                for (int k = 0; k < 3; ++k) {
                    const double a = m[k][p], b = m[k][q];
                    m[k][p] = c * a - s * b;
                    m[k][q] = s * a + c * b;
                }
                for (int k = 0; k < 3; ++k) {
                    const double a = m[p][k], b = m[q][k];
                    m[p][k] = c * a - s * b;
                    m[q][k] = s * a + c * b;
                }
                const glm::dvec3 a = vectors[p], b = vectors[q];
                vectors[p] = a * c - b * s;
                vectors[q] = a * s + b * c;
            }
    std::array<int, 3> order{0, 1, 2};
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return m[a][a] > m[b][b]; });
    Axes axes;
    for (size_t i = 0; i < 2; ++i) {
        axes.along[i] = vec3(vectors[order[i]]);
        double low = 1e30, high = -1e30;
        for (const DeformParticle& particle : particles) {
            const auto at = double(gpu::dot(restPlace(particle), axes.along[i]));
            low = std::min(low, at);
            high = std::max(high, at);
        }
        axes.wide[i] = std::max(high - low, 0.0);
    }
    return axes;
}

// Particles by their cell of a grid; cells share lists by their hash.
class Cells {
 public:
    Cells(std::span<const DeformParticle> particles, float side, std::pmr::memory_resource* memory)
        : side_(side), lists_(memory) {
        FW_ASSERT(side > 0, "%g m", double(side));
        mask_ = std::bit_ceil(uint32_t(particles.size()) + 1) - 1;
        lists_ = groupBy(mask_ + 1, uint32_t(particles.size()), memory,
                         [&](uint32_t i) { return bucket(cell(restPlace(particles[i]))); });
    }
    // All within `side` of a place, and others.
    template <class Do>
    void near(vec3 place, Do what) const {
        const glm::ivec3 middle = cell(place);
        for (int i = 0; i < 27; ++i) {
            const uint32_t at = bucket(middle + glm::ivec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
            for (const uint32_t particle : lists_.of(at)) what(particle);
        }
    }

 private:
    [[nodiscard]] glm::ivec3 cell(vec3 p) const {
        return glm::ivec3(glm::clamp(glm::floor(p / side_), -1.0e9f, 1.0e9f));
    }
    [[nodiscard]] uint32_t bucket(glm::ivec3 c) const {
        const uint32_t h =
            uint32_t(c.x) * 73856093u ^ uint32_t(c.y) * 19349663u ^ uint32_t(c.z) * 83492791u;
        return (h ^ h >> 15) & mask_;
    }
    float side_;
    uint32_t mask_ = 0;
    Groups lists_;
};

}  // namespace

void findBends(DeformModel& model, std::pmr::memory_resource* memory) {
    const std::span<DeformParticle> particles = model.particles;
    double area = 0, edge = 0;
    for (DeformParticle& particle : particles) {
        std::fill(std::begin(particle.bendEnds), std::end(particle.bendEnds), kNone);
        area += double(particle.area);
        edge += (particle.flags & gpu::kParticleClosed) ? 0 : 1;
    }
    if (edge * edge < kOpen * double(particles.size()) || !(area > 0)) return;
    const Axes axes = axesOf(particles);
    const double apart = std::sqrt(area / double(particles.size()));
    model.span = float(std::max(kSpanShare * axes.wide[1], 2 * apart));
    FW_ASSERT(model.span > 0 && apart > 0, "span %g m", double(model.span));
    const Cells cells(particles, kAside * model.span, memory);
    const auto facing = [&](const DeformParticle& particle) {
        const gpu::DeformEmbedding& own = model.embeddings[particle.vertex];
        return vec3(own.faceX, own.faceY, own.faceZ);
    };
    for (uint32_t set = 0; set < gpu::kBendSets; ++set) {
        const vec3 along = axes.along[set & 1] * (set < 2 ? model.span : kShorter * model.span);
        const uint32_t behind = 2 * set, ahead = behind + 1;
        for (uint32_t i = 0; i < particles.size(); ++i) {
            DeformParticle& particle = particles[i];
            const vec3 sought = restPlace(particle) + along;
            uint32_t best = kNone;
            float least = kAside * model.span;
            cells.near(sought, [&](uint32_t other) {
                const DeformParticle& there = particles[other];
                const float off = gpu::length(restPlace(there) - sought);
                // The lowest of several equally near ones, whatever the order of the cells.
                if (off > least || (off == least && other >= best) ||
                    there.bendEnds[behind] != kNone || ((there.flags ^ particle.flags) & 7u) ||
                    gpu::dot(facing(particle), facing(there)) < kFacing)
                    return;
                least = off;
                best = other;
            });
            if (best == kNone) continue;
            particle.bendEnds[ahead] = particles[best].vertex;
            particles[best].bendEnds[behind] = particle.vertex;
            particle.bendLength[ahead] = particles[best].bendLength[behind] =
                gpu::length(restPlace(particles[best]) - restPlace(particle));
        }
        for (DeformParticle& particle : particles) {
            if (particle.bendEnds[behind] == kNone || particle.bendEnds[ahead] == kNone) continue;
            const vec3 middle = (restPlace(particles[model.particleOf[particle.bendEnds[behind]]]) +
                                 restPlace(particles[model.particleOf[particle.bendEnds[ahead]]])) *
                                0.5f;
            const vec3 normal = facing(particle), off = middle - restPlace(particle);
            particle.bendRise[set] = gpu::dot(off, normal);
            if (gpu::length(off - normal * particle.bendRise[set]) < kEven * model.span)
                particle.flags |= gpu::kParticleBendsEven << set;
        }
    }
}

}  // namespace fw::mesh
