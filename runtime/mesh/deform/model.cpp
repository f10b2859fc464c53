#include "mesh/deform/model.h"

#include "mesh/bake.h"
#include "mesh/surface.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>
#include <tuple>
#include <utility>

namespace fw::mesh {
namespace {

using gpu::DeformEmbedding;
using gpu::DeformParticle;
using gpu::kDeformRing;
using gpu::kDeformTexels;

constexpr double kAltitudeShare = 0.5;  // of the lowest altitude of the triangles around
constexpr double kNoWall = 1e30;
constexpr size_t kMostSteps = 256;  // triangles around one particle that are read
constexpr double kThickest = 0.25;  // m: walls farther apart never burn through together

glm::dvec3 placeOf(const RenderVertex& v) { return glm::dvec3(v.place()); }
glm::dvec3 restOf(const DeformParticle& p) { return glm::dvec3(glm::vec3(p.x, p.y, p.z)); }

// A vertex's place on Morton's curve through the mesh's bounds.
uint32_t alongCurve(const BurnDomain& domain, uint32_t vertex) {
    FW_ASSERT(vertex < domain.vertices.size(), "%u of %zu vertices", vertex,
              domain.vertices.size());
    uint32_t code = 0;
    float side = 1e-30f;
    for (size_t k = 0; k < 3; ++k)
        side = std::max(side, domain.boundsHigh[k] - domain.boundsLow[k]);
    for (size_t k = 0; k < 3; ++k) {
        const float share = (domain.vertices[vertex].position[k] - domain.boundsLow[k]) / side;
        uint32_t x = uint32_t(std::clamp(share, 0.0f, 1.0f) * 1023);
        for (uint32_t bit = 0; bit < 10; ++bit) code |= (x >> bit & 1u) << (3 * bit + uint32_t(k));
    }
    return code;
}

// Makes one particle of all vertices with the same position; the lowest vertex keeps it.
void weld(const BurnDomain& domain, DeformModel& model, std::pmr::memory_resource* memory) {
    const auto count = uint32_t(domain.vertices.size());
    std::pmr::vector<uint32_t> order(count, memory);
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](uint32_t i) {
        const glm::vec3 p = domain.vertices[i].place() + 0.0f;  // no -0
        return std::tuple(p.x, p.y, p.z);
    };
    std::sort(order.begin(), order.end(),
              [&](uint32_t a, uint32_t b) { return std::pair(key(a), a) < std::pair(key(b), b); });
    std::pmr::vector<uint32_t> keeper(count, memory);
    for (uint32_t i = 0; i < count; ++i)
        keeper[order[i]] =
            i && key(order[i]) == key(order[i - 1]) ? keeper[order[i - 1]] : order[i];
    // Neighbours are near each other in memory too.
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        return std::pair(alongCurve(domain, a), a) < std::pair(alongCurve(domain, b), b);
    });
    model.particleOf.resize(count);
    for (const uint32_t i : order) {
        if (keeper[i] != i) continue;
        model.particleOf[i] = uint32_t(model.particles.size());
        DeformParticle particle{};
        const RenderVertex& v = domain.vertices[i];
        particle.x = v.position[0];
        particle.y = v.position[1];
        particle.z = v.position[2];
        particle.vertex = i;
        particle.opposite = kNone;
        std::fill(std::begin(particle.texels), std::end(particle.texels), kNone);
        std::fill(std::begin(particle.ring), std::end(particle.ring), i);
        model.particles.push_back(particle);
    }
    for (uint32_t i = 0; i < count; ++i) model.particleOf[i] = model.particleOf[keeper[i]];
}

struct Step {  // one triangle around a particle: from one neighbour to the next
    uint32_t from, to;
};

// Joins the steps around a particle to its longest walk; true: the walk closes.
bool walk(std::pmr::vector<Step>& steps, std::pmr::vector<uint32_t>& out,
          std::pmr::vector<uint32_t>& best) {
    best.clear();
    bool bestCloses = false;
    while (!steps.empty()) {
        // An open fan begins at the neighbour that no step leads to.
        size_t first = 0;
        for (size_t i = 0; i < steps.size(); ++i) {
            const uint32_t from = steps[i].from;
            if (std::none_of(steps.begin(), steps.end(),
                             [from](const Step& s) { return s.to == from; })) {
                first = i;
                break;
            }
        }
        out.assign({steps[first].from});
        uint32_t at = steps[first].to;
        const uint32_t start = steps[first].from;
        steps.erase(steps.begin() + std::ptrdiff_t(first));
        while (at != start) {
            out.push_back(at);
            const auto next = std::find_if(steps.begin(), steps.end(),
                                           [at](const Step& s) { return s.from == at; });
            if (next == steps.end()) break;
            at = next->to;
            steps.erase(next);
        }
        const bool closes = at == start;
        if (out.size() > best.size()) {
            best = out;
            bestCloses = closes;
        }
    }
    return bestCloses;
}

struct Builder {
    const BurnDomain& domain;
    DeformModel& model;
    std::pmr::memory_resource* memory;
    // By particle: triangle * 3 + corner.
    Groups corners =
        groupBy(uint32_t(model.particles.size()), uint32_t(domain.indices.size()), memory,
                [this](uint32_t i) { return model.particleOf[domain.indices[i]]; });
    // By triangle: its real texels.
    Groups triangleTexels = groupBy(
        uint32_t(domain.indices.size() / 3), domain.texelCount(), memory,
        [this](uint32_t texel) { return domain.real(texel) ? domain.triangleOf[texel] : kNone; });
    std::pmr::vector<Step> steps{memory};
    std::pmr::vector<uint32_t> path{memory}, best{memory}, texels{memory};

    void run() {
        for (uint32_t i = 0; i < model.particles.size(); ++i) {
            offset(i);
            sample(i);
            neighbours(i);
        }
        lengths();
        for (uint32_t i = 0; i < domain.vertices.size(); ++i) embed(i);
    }

    [[nodiscard]] uint32_t vertexAt(uint32_t triangle, uint32_t corner) const {
        return domain.indices[size_t(triangle) * 3 + corner % 3];
    }
    [[nodiscard]] glm::dvec3 cornerPlace(uint32_t triangle, uint32_t corner) const {
        return placeOf(domain.cornerOf(triangle, corner % 3));
    }
    [[nodiscard]] uint32_t keeperAt(uint32_t triangle, uint32_t corner) const {
        return model.particles[model.particleOf[vertexAt(triangle, corner)]].vertex;
    }
    [[nodiscard]] glm::dvec3 areaNormal(uint32_t triangle) const {  // twice the area long
        const glm::dvec3 a = cornerPlace(triangle, 0);
        return glm::cross(cornerPlace(triangle, 1) - a, cornerPlace(triangle, 2) - a);
    }

    // Direction in which the particle recedes (see Faces), and its limit by the triangles around.
    void offset(uint32_t number) {
        DeformParticle& particle = model.particles[number];
        Faces faces;
        double altitude = 1e30, area = 0;
        for (const uint32_t corner : corners.of(number)) {
            const uint32_t triangle = corner / 3;
            const glm::dvec3 twice = areaNormal(triangle);
            const double size = glm::length(twice);
            if (!(size > 1e-30)) continue;
            const glm::dvec3 n = twice / size;
            // By the angle at the corner, so that a fan's cut does not matter.
            const glm::dvec3 at = cornerPlace(triangle, corner % 3);
            const glm::dvec3 a = unitOr(cornerPlace(triangle, corner % 3 + 1) - at, n);
            const glm::dvec3 b = unitOr(cornerPlace(triangle, corner % 3 + 2) - at, n);
            const double angle = std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0)) + 1e-6;
            faces.add(n, angle);
            area += size / 6;
            double longest = 0;
            for (uint32_t k = 0; k < 3; ++k)
                longest = std::max(
                    longest, glm::length(cornerPlace(triangle, k) - cornerPlace(triangle, k + 1)));
            altitude = std::min(altitude, size / std::max(longest, 1e-30));
        }
        particle.area = float(area);
        if (!(faces.weight > 0)) return;
        const glm::dvec3 o = faces.offset();
        if (o == glm::dvec3(0)) return;  // the two sides of a sheet
        particle.outX = float(o.x);
        particle.outY = float(o.y);
        particle.outZ = float(o.z);
        particle.limit = float(kAltitudeShare * altitude / std::max(glm::length(o), 1e-6));
    }

    // The texels that a particle samples, spread over its ring like the texels of one mip of its
    // burn map; and the wall behind.
    void sample(uint32_t number) {
        DeformParticle& particle = model.particles[number];
        texels.clear();
        uint32_t material = 0;
        for (const uint32_t corner : corners.of(number)) {
            const uint32_t triangle = corner / 3;
            material = domain.vertices[domain.indices[corner]].material;
            const std::span<const uint32_t> own = triangleTexels.of(triangle);
            texels.insert(texels.end(), own.begin(), own.end());
        }
        particle.flags = material & 7u;
        const uint32_t mip = gpu::mipOfRing(uint32_t(texels.size()), kDeformTexels);
        const uint32_t mask = (1u << mip) - 1, half = mask / 2;
        const auto central = [&](uint32_t texel) {
            return (texel % domain.width & mask) == half && (texel / domain.width & mask) == half;
        };
        // Texels in the middle of a texel of the mip come first.
        std::stable_partition(texels.begin(), texels.end(), central);
        const auto middles = size_t(std::count_if(texels.begin(), texels.end(), central));
        const size_t from = middles >= kDeformTexels / 2 ? middles : texels.size();
        const size_t taken = std::min<size_t>(from, kDeformTexels);
        for (size_t i = 0; i < taken; ++i) particle.texels[i] = texels[i * from / taken];
        const float place[3] = {particle.x, particle.y, particle.z};
        if (taken == 0) particle.texels[0] = nearestTexel(domain, place, 1e6f);

        double thin = kNoWall;
        for (const uint32_t texel : particle.texels)
            if (texel != kNone && domain.thickness[texel] != 0xFFFF)
                thin = std::min(thin, double(domain.thickness[texel]) * 1e-4);
        const glm::dvec3 out(double(particle.outX), double(particle.outY), double(particle.outZ));
        const double stretch = std::max(glm::length(out), 1e-6);
        particle.limit = float(std::min(double(particle.limit), kDepthShare * thin / stretch));
        if (thin > kThickest || particle.texels[0] == kNone) return;
        const glm::dvec3 behind = restOf(particle) + out / stretch * thin;
        const float point[3] = {float(behind.x), float(behind.y), float(behind.z)};
        const float reach = float(0.5 * thin) + domain.texelSide;
        const uint32_t texel = nearestTexel(domain, point, reach);
        if (texel == kNone) return;
        const glm::vec3 facing = gpu::unpackDirection(domain.normals[texel]);
        if (glm::dot(facing, glm::vec3(out / stretch)) > 0.3f) particle.opposite = texel;
    }

    // Adds the step past `center` along the far side of a corner's triangle.
    void addStep(uint32_t corner, uint32_t center) {
        const uint32_t triangle = corner / 3;
        const Step step{keeperAt(triangle, corner % 3 + 1), keeperAt(triangle, corner % 3 + 2)};
        if (step.from != step.to && step.from != center && step.to != center &&
            steps.size() < kMostSteps)
            steps.push_back(step);
    }

    // Puts the steps' longest walk into a ring; a closed one may end with its first entry, for
    // which `repeats` slots stay free. Returns whether the walk closes, and its entries.
    std::pair<bool, size_t> fillRing(uint32_t (&ring)[kDeformRing], size_t repeats) {
        const bool closes = walk(steps, path, best);
        const size_t all = best.size();
        const size_t kept = std::min<size_t>(all, kDeformRing - (closes ? repeats : 0));
        for (size_t i = 0; i < kept; ++i) ring[i] = best[i * all / kept];
        // Repeats the last one: loops over eight neighbours see no triangle between equal ones.
        for (size_t i = kept; i < kDeformRing && kept > 0; ++i)
            ring[i] = closes ? ring[0] : ring[kept - 1];
        FW_ASSERT(kept <= kDeformRing && (!closes || kept > 1), "a ring of %zu", kept);
        return {closes, kept};
    }

    // Neighbours in their order around the particle.
    void neighbours(uint32_t number) {
        DeformParticle& particle = model.particles[number];
        steps.clear();
        for (const uint32_t corner : corners.of(number)) addStep(corner, particle.vertex);
        const auto [closes, kept] = fillRing(particle.ring, 0);
        particle.flags |= (closes ? gpu::kParticleClosed : 0u) | uint32_t(kept)
                                                                     << gpu::kParticleRingShift;
    }
    [[nodiscard]] float restLength(const DeformParticle& particle, uint32_t vertex) const {
        return float(
            glm::length(restOf(model.particles[model.particleOf[vertex]]) - restOf(particle)));
    }
    // A link that only one end lists gets no length: forces need both ends.
    void lengths() {
        for (DeformParticle& particle : model.particles) {
            glm::dvec3 mean(0), turned(0), before(0), first(0);
            double links = 0;
            const auto mutual = [&](uint32_t vertex) {
                const uint32_t* list = model.particles[model.particleOf[vertex]].ring;
                return vertex != particle.vertex &&
                       std::find(list, list + kDeformRing, particle.vertex) != list + kDeformRing;
            };
            float ring[kDeformRing]{};
            const uint32_t count = particle.flags >> gpu::kParticleRingShift & 15u;
            for (uint32_t i = 0; i < kDeformRing; ++i) {
                const glm::dvec3 arm = placeOf(domain.vertices[particle.ring[i]]) -
                                       placeOf(domain.vertices[particle.vertex]);
                turned += glm::cross(before, arm);
                before = arm;
                if (i == 0) first = arm;
                if (i < count && mutual(particle.ring[i])) {
                    ring[i] = restLength(particle, particle.ring[i]);
                    mean += arm;
                    links += 1;
                }
            }
            if (particle.flags & gpu::kParticleClosed) turned += glm::cross(before, first);
            const glm::dvec3 normal = unitOr(turned, glm::dvec3(0));
            mean /= std::max(links, 1.0);
            particle.rise = float(glm::dot(mean, normal));
            const bool whole = (particle.flags & gpu::kParticleClosed) && links == double(count);
            if (whole &&
                glm::length(mean - normal * glm::dot(mean, normal)) < 0.06 * double(ring[0]))
                particle.flags |= gpu::kParticleEven;
            for (uint32_t i = 0; i < kDeformRing / 2; ++i)
                particle.ringLength[i] = glm::packHalf2x16({ring[i * 2], ring[i * 2 + 1]});
        }
    }

    // A drawn normal turns with the triangles that share it.
    void embed(uint32_t vertex) {
        const RenderVertex& v = domain.vertices[vertex];
        const uint32_t particle = model.particleOf[vertex];
        DeformEmbedding made{};
        made.particle = model.particles[particle].vertex;
        made.normal = v.normal;
        steps.clear();
        glm::dvec3 face(0);
        for (const uint32_t corner : corners.of(particle))
            if (domain.vertices[domain.indices[corner]].normal == v.normal)
                addStep(corner, made.particle);
        std::fill_n(made.ring, kDeformRing, made.particle);
        fillRing(made.ring, 1);
        const glm::dvec3 at = placeOf(v);
        for (const uint32_t other : made.ring) {
            const glm::dvec3 edge = placeOf(domain.vertices[other]) - at;
            made.longest = std::max(made.longest, float(glm::dot(edge, edge)));
        }
        for (size_t i = 0; i + 1 < kDeformRing; ++i)
            face += glm::cross(placeOf(domain.vertices[made.ring[i]]) - at,
                               placeOf(domain.vertices[made.ring[i + 1]]) - at);
        face = unitOr(face, glm::dvec3(0));
        made.faceX = float(face.x);
        made.faceY = float(face.y);
        made.faceZ = float(face.z);
        FW_ASSERT(model.embeddings.size() == vertex, "%zu embeddings, vertex %u",
                  model.embeddings.size(), vertex);
        model.embeddings.push_back(made);
    }
};

// Sorts particles by their number of neighbours within each group, and notes per run of particles
// the turns that it takes to read them and whether any has bending constraints. Device lanes that
// share a run then leave the loop over neighbours together.
void makeRuns(DeformModel& model, std::pmr::memory_resource* memory) {
    const size_t count = model.particles.size();
    const auto turnsOf = [](const DeformParticle& particle) {
        return std::max(
            ((particle.flags >> gpu::kParticleRingShift & 15u) + 1) / gpu::kLinksPerPass, 1u);
    };
    std::pmr::vector<uint32_t> order(count, memory), moved(count, memory);
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        return std::tuple(a / gpu::kDeformGroup, turnsOf(model.particles[a]), a) <
               std::tuple(b / gpu::kDeformGroup, turnsOf(model.particles[b]), b);
    });
    std::pmr::vector<DeformParticle> sorted(memory);
    sorted.reserve(count);
    for (const uint32_t i : order) {
        moved[i] = uint32_t(sorted.size());
        sorted.push_back(model.particles[i]);
    }
    FW_ASSERT(std::is_sorted(order.begin(), order.end(),
                             [](uint32_t a, uint32_t b) {
                                 return a / gpu::kDeformGroup < b / gpu::kDeformGroup;
                             }),
              "a particle left its group");
    model.particles.swap(sorted);
    for (uint32_t& particle : model.particleOf) particle = moved[particle];
    for (size_t first = 0; first < count; first += gpu::kDeformRun) {
        const std::span<DeformParticle> run(model.particles.data() + first,
                                            std::min<size_t>(gpu::kDeformRun, count - first));
        uint32_t turns = 1, bends = 0;
        for (const DeformParticle& particle : run) {
            turns = std::max(turns, turnsOf(particle));
            for (const uint32_t end : particle.bendEnds)
                bends |= end == kNone ? 0 : gpu::kParticleHasBends;
        }
        for (DeformParticle& particle : run)
            particle.flags |= bends | turns << gpu::kParticlePassesShift;
    }
}

}  // namespace

DeformModel makeDeformModel(const BurnDomain& domain, std::pmr::memory_resource* memory) {
    DeformModel model(memory);
    weld(domain, model, memory);
    model.embeddings.reserve(domain.vertices.size());
    Builder{domain, model, memory}.run();
    findBends(model, memory);
    makeRuns(model, memory);
    return model;
}

gpu::DeviceParticle deviceParticle(const DeformModel& model, uint32_t number) noexcept {
    FW_ASSERT(number < model.particles.size(), "%u of %zu particles", number,
              model.particles.size());
    const DeformParticle& particle = model.particles[number];
    gpu::DeviceParticle made{};
    made.vertex = particle.vertex;
    made.flags = particle.flags;
    made.rise = particle.rise;
    made.opposite = particle.opposite;
    const auto linked = [&](uint32_t vertex) {
        FW_ASSERT(vertex == kNone || vertex < model.particleOf.size(), "vertex %u", vertex);
        const uint32_t other = vertex == kNone ? number : model.particleOf[vertex];
        return other | gpu::linkOdds(number, other) << 24;
    };
    for (uint32_t i = 0; i < gpu::kDeformLinkPasses; ++i) {
        const uint32_t* near = particle.ring + 2 * i;
        made.near_[i] = {linked(near[0]), linked(near[1]), particle.ringLength[i], 0};
    }
    for (uint32_t set = 0; set < gpu::kBendSets; ++set) {
        const uint32_t* ends = particle.bendEnds + 2 * set;
        const float* lengths = particle.bendLength + 2 * set;
        made.bends[set] = {linked(ends[0]), linked(ends[1]),
                           glm::packHalf2x16({lengths[0], lengths[1]}), particle.bendRise[set]};
    }
    std::copy(std::begin(particle.texels), std::end(particle.texels), made.texels);
    made.x = particle.x;
    made.y = particle.y;
    made.z = particle.z;
    made.area = particle.area;
    made.outX = particle.outX;
    made.outY = particle.outY;
    made.outZ = particle.outZ;
    made.limit = particle.limit;
    return made;
}

}  // namespace fw::mesh
