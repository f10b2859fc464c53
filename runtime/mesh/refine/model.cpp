// Numbers for every vertex that can ever be drawn: edges, slots, draw vertices.
#include "mesh/refine/model.h"

#include "core/error.h"
#include "mesh/refine/coarse.h"
#include "mesh/texels.h"

#include <cmath>

namespace fw::mesh {
namespace {

constexpr uint32_t kMaxSlots = 1u << 24;

void check(const RefineOptions& options) {
    if (!(options.wall > 0 && options.wall <= 0.6f))
        core::refuse("RefineOptions::wall is %g m; it must lie in (0, 0.6].", double(options.wall));
    if (options.depth > gpu::kRefineDepth)
        core::refuse("RefineOptions::depth is %u; it must be at most %u.", options.depth,
                     gpu::kRefineDepth);
    if (!(options.cellTexels >= 0) || !(options.splitTexels >= 0))
        core::refuse(
            "RefineOptions::cellTexels and splitTexels are %g and %g; neither may be "
            "negative.",
            double(options.cellTexels), double(options.splitTexels));
}

uint32_t deepest(double length, double cell, uint32_t depth) {
    uint32_t level = 0;
    while (level < depth && length / double(2u << level) >= cell * (1 - 1e-6)) ++level;
    return level;
}

// Attributes along an edge or at a corner are equal for owners with the same drawn corners, or with
// the same triangle.
struct Seen {
    uint32_t a = kNone, b = kNone;
    bool operator==(const Seen&) const = default;
};
Seen seenFrom(const BurnDomain& domain, uint32_t source, glm::dvec3 weight) {
    const uint32_t* corner = &domain.indices[size_t(source) * 3];
    const bool on[3] = {weight.x > 0, weight.y > 0, weight.z > 0};
    if (on[0] && on[1] && on[2]) return {kNone, source};
    Seen seen{kNone, 0};
    for (uint32_t k = 0; k < 3; ++k)
        if (on[k]) {
            seen.b = seen.a == kNone ? corner[k] : std::max(seen.a, corner[k]);
            seen.a = std::min(seen.a, corner[k]);
        }
    return seen;
}

struct Copy {  // of an edge's points or of a corner, for owners with other attributes
    Seen seen;
    uint32_t draw = 0;
    uint32_t next = kNone;
};

// Chooses the draw vertices of an owner: the canonical ones, a known copy, or a new one.
class Copies {
 public:
    Copies(uint32_t items, std::pmr::memory_resource* memory)
        : first_(items, kNone, memory), copies_(memory) {}

    // True if `draw` is a new vertex, `fresh`.
    bool find(uint32_t item, Seen seen, uint32_t canonical, uint32_t fresh, uint32_t& draw) {
        FW_ASSERT(item < first_.size(), "%u of %zu items", item, first_.size());
        uint32_t last = kNone;
        for (uint32_t c = first_[item]; c != kNone; c = copies_[c].next) {
            if (copies_[c].seen == seen) {
                draw = copies_[c].draw;
                return false;
            }
            last = c;
        }
        draw = last == kNone ? canonical : fresh;
        (last == kNone ? first_[item] : copies_[last].next) = uint32_t(copies_.size());
        copies_.push_back({seen, draw, kNone});
        return last != kNone;
    }

 private:
    std::pmr::vector<uint32_t> first_;
    std::pmr::vector<Copy> copies_;
};

void makeEdges(const CoarseMesh& coarse, double cell, uint32_t depth, RefineModel& model) {
    const std::pmr::vector<EdgeUse> uses = sortedUses(coarse.triangles, model.memory);
    model.owners.reserve(uses.size());
    for (size_t i = 0; i < uses.size(); ++i) {
        const EdgeUse& use = uses[i];
        FW_ASSERT(use.high < coarse.points.size(), "point %u of %zu", use.high,
                  coarse.points.size());
        if (i == 0 || !use.sameEdge(uses[i - 1])) {
            const double length = glm::length(coarse.points[use.low] - coarse.points[use.high]);
            model.ownerStart.push_back(uint32_t(i));
            model.edges.push_back({use.low, use.high, 0, deepest(length, cell, depth)});
        }
        gpu::RefineTriangle& t = model.triangles[use.triangle];
        t.edge[use.side] = uint32_t(model.edges.size() - 1);
        if (coarse.triangles[use.triangle].point[use.side] == use.high) t.flags |= 1u << use.side;
        t.flags |= model.edges.back().flags << (4 + 4 * use.side);
        model.owners.push_back(use.triangle << 2 | use.side);
    }
    model.ownerStart.push_back(uint32_t(uses.size()));
    for (uint32_t e = 0; e < model.edges.size(); ++e) {
        const uint32_t owners = model.ownerStart[e + 1] - model.ownerStart[e];
        if (owners == 1) model.edges[e].flags |= 16u;
        model.openEdges += owners == 1;
        model.nonManifoldEdges += owners > 2;
    }
}

void numberSlots(RefineModel& model) {
    uint64_t slots = model.cornerCount;
    for (gpu::RefineEdge& e : model.edges) {
        e.slot = uint32_t(slots);
        slots += (1u << (e.flags & 15)) - 1;
    }
    for (gpu::RefineTriangle& t : model.triangles) {
        const uint32_t a = gpu::refineSideDepth(t.flags, 0), b = gpu::refineSideDepth(t.flags, 1),
                       c = gpu::refineSideDepth(t.flags, 2);
        const uint32_t m = gpu::fitInterior(a, b, c, std::max({a, b, c}));
        t.flags |= m << 16;
        t.slot = uint32_t(slots);
        slots += gpu::refineInnerCount(m);
        if (slots > kMaxSlots)
            core::refuse(
                "Refinement needs more than %u vertices for %zu coarse triangles; lower "
                "RefineOptions::depth or raise cellTexels.",
                kMaxSlots, model.triangles.size());
    }
    FW_ASSERT(slots >= model.cornerCount, "%u corners", model.cornerCount);
    model.slots.resize(slots);
    model.draws.resize(slots);
}

gpu::RefineDraw drawAt(uint32_t slot, uint32_t triangle, glm::dvec3 weight) {
    return {slot, triangle, float(weight.y), float(weight.z)};
}

void makeDraws(const Surface& surface, const CoarseMesh& coarse, const BurnDomain& domain,
               RefineModel& model) {
    Copies corners(model.cornerCount, model.memory),
        sides(uint32_t(model.edges.size()), model.memory);
    for (uint32_t i = 0; i < model.triangles.size(); ++i) {
        gpu::RefineTriangle& t = model.triangles[i];
        const CoarseTriangle& c = coarse.triangles[i];
        const uint32_t source = surface.triangles[c.source].source;
        t.source = source;
        for (uint32_t k = 0; k < 3; ++k) {
            const uint32_t slot = c.point[k], fresh = uint32_t(model.draws.size());
            const bool isNew =
                corners.find(slot, seenFrom(domain, source, c.weight[k]), slot, fresh, t.corner[k]);
            if (isNew) model.draws.push_back({});
            if (isNew || model.draws[slot].triangle == kNone)
                model.draws[t.corner[k]] = drawAt(slot, source, c.weight[k]);
        }
        for (uint32_t e = 0; e < 3; ++e) {
            const gpu::RefineEdge& edge = model.edges[t.edge[e]];
            const uint32_t steps = 1u << (edge.flags & 15);
            glm::dvec3 low = c.weight[e], high = c.weight[(e + 1) % 3];
            if (gpu::refineFlipped(t.flags, e)) std::swap(low, high);
            const uint32_t fresh = uint32_t(model.draws.size());
            if (steps == 1) {
                t.side[e] = edge.slot;
                continue;
            }
            const bool isNew = sides.find(t.edge[e], seenFrom(domain, source, low + high),
                                          edge.slot, fresh, t.side[e]);
            if (!isNew && model.draws[edge.slot].triangle != kNone) continue;
            if (isNew) model.draws.resize(model.draws.size() + steps - 1);
            for (uint32_t k = 1; k < steps; ++k) {
                const double f = double(k) / steps;
                model.draws[t.side[e] + k - 1] =
                    drawAt(edge.slot + k - 1, source, low * (1 - f) + high * f);
            }
        }
        eachInner(1u << gpu::refineInteriorDepth(t.flags), [&](uint32_t number, glm::dvec3 w) {
            const uint32_t slot = t.slot + number;
            model.draws[slot] =
                drawAt(slot, source, mixed(c.weight[0], c.weight[1], c.weight[2], w));
        });
    }
}

}  // namespace

uint64_t RefineModel::fullCount() const noexcept {
    uint64_t count = 0;
    for (const gpu::RefineTriangle& t : triangles)
        count += gpu::refineCount(
            gpu::refinePack(gpu::refineSideDepth(t.flags, 0), gpu::refineSideDepth(t.flags, 1),
                            gpu::refineSideDepth(t.flags, 2), gpu::refineInteriorDepth(t.flags)));
    return count;
}

RefineModel bakeRefine(const BurnDomain& domain, const RefineOptions& options,
                       std::pmr::memory_resource* memory) {
    check(options);
    const double texel = double(domain.texelSide);
    const Surface surface = surfaceOf(domain, memory);
    CoarseMesh coarse =
        coarseMesh(surface, double(options.splitTexels) * texel, options.maxTriangles);
    // Draws go by material.
    const Groups order =
        groupBy(domain.materialCount, uint32_t(coarse.triangles.size()), memory, [&](uint32_t i) {
            const uint32_t source = surface.triangles[coarse.triangles[i].source].source;
            return domain.cornerOf(source, 0).material;
        });
    std::pmr::vector<CoarseTriangle> sorted(memory);
    for (const uint32_t i : order.items) sorted.push_back(coarse.triangles[i]);
    coarse.triangles.swap(sorted);
    RefineModel model(memory);
    model.textureWidth = domain.width;
    model.tileCount = domain.tileCount();
    model.cornerCount = uint32_t(coarse.points.size());
    model.triangles.resize(coarse.triangles.size());
    makeEdges(coarse, double(options.cellTexels) * texel, options.depth, model);
    numberSlots(model);
    for (gpu::RefineDraw& d : model.draws) d = {0, kNone, 0, 0};
    makeDraws(surface, coarse, domain, model);
    bakeOffsets(surface, coarse, domain, options, model);
    bakeSamples(surface, coarse, domain, model);
    return model;
}

RenderVertex refineRenderVertex(const BurnDomain& domain, const RefineModel& model, uint32_t draw) {
    FW_ASSERT(draw < model.draws.size(), "%u of %zu draw vertices", draw, model.draws.size());
    const gpu::RefineDraw& d = model.draws[draw];
    FW_ASSERT(d.slot < model.slots.size(), "%u of %zu slots", d.slot, model.slots.size());
    const float w[3] = {1 - d.weight1 - d.weight2, d.weight1, d.weight2};
    const gpu::RefineSlot& slot = model.slots[d.slot];
    RenderVertex v{{slot.x, slot.y, slot.z}};
    glm::dvec3 normal(0);
    glm::dvec4 tint(0);
    for (size_t k = 0; k < 3; ++k) {
        const RenderVertex& c = domain.cornerOf(d.triangle, k);
        for (int i = 0; i < 2; ++i) {
            v.atlasUv[i] += w[k] * c.atlasUv[i];
            v.textureUv[i] += w[k] * c.textureUv[i];
            v.detail[i] += w[k] * c.detail[i];
        }
        normal += double(w[k]) * unpackNormal(c.normal);
        for (int i = 0; i < 4; ++i) tint[i] += double(w[k]) * double(c.tint >> (8 * i) & 255);
    }
    const double length = glm::length(normal);
    v.normal = length > 1e-9 ? packNormal(normal / length) : domain.cornerOf(d.triangle, 0).normal;
    v.tint = 0;
    for (int i = 0; i < 4; ++i)
        v.tint |= uint32_t(std::clamp(tint[i] + 0.5, 0.0, 255.0)) << (8 * i);
    v.material = domain.cornerOf(d.triangle, 0).material;
    return v;
}

}  // namespace fw::mesh
