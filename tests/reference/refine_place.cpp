// Position and hole time of every vertex in use. Corners, then edges, then interiors: each reads
// only earlier ones.
#include "reference/refine_frame.h"

#include <algorithm>

namespace fw::mesh {
namespace {

class Placer {
 public:
    Placer(const RefineModel& model, const RefineSettings& settings, const RefineFrame& frame,
           RefineState& state)
        : model_(model), settings_(settings), frame_(frame), state_(state) {}

    void run() {
        state_.placed = 0;
        for (uint32_t s = 0; s < model_.cornerCount; ++s) evaluate(s);
        for (uint32_t e = 0; e < model_.edges.size(); ++e) edge(e);
        for (uint32_t i = 0; i < model_.triangles.size(); ++i) interior(i);
        for (uint32_t e = 0; e < model_.edges.size(); ++e) edgeFate(e);
        for (uint32_t i = 0; i < model_.triangles.size(); ++i) interiorFate(i);
        state_.placedAt = frame_.now;
    }

 private:
    [[nodiscard]] float arrival(uint32_t base, uint32_t weights) const {
        const uint32_t* t = &frame_.ticks[base];
        const uint32_t* up = t + model_.textureWidth;
        return gpu::refineArrival({t[0], t[1], up[0], up[1]}, weights, frame_.nowTick,
                                  frame_.epochTick);
    }

    void evaluate(uint32_t s) {
        const gpu::RefineSlot& slot = model_.slots[s];
        const float own = arrival(slot.texel & 0xFFFFFFu, slot.weights);
        float opposite = gpu::kRefineNever;
        if (slot.opposite != gpu::kRefineOpposed)
            opposite =
                arrival(slot.opposite & 0xFFFFFFu, gpu::refineOppositeWeights(slot.opposite));
        const glm::vec4 v =
            gpu::evaluateSlot(slot, own, opposite, frame_.now, frame_.burnSeconds[slot.texel >> 24],
                              settings_.recede);
        state_.vertices[s] = {v.x, v.y, v.z, v.w};
        ++state_.placed;
    }

    // At an unchanged level, a vertex that had burnt through when last placed no longer moves.
    void evaluateMoving(uint32_t s) {
        if (state_.vertices[s].hole > state_.placedAt) evaluate(s);
    }

    [[nodiscard]] glm::vec3 at(uint32_t s) const {
        const gpu::RefineVertex& v = state_.vertices[s];
        return {v.x, v.y, v.z};
    }
    void morph(uint32_t s, glm::vec3 a, glm::vec3 b, float age) {
        const glm::vec3 p = gpu::refineMorph(at(s), a, b, age);
        gpu::RefineVertex& v = state_.vertices[s];
        v.x = p.x;
        v.y = p.y;
        v.z = p.z;
    }

    void edge(uint32_t e) {
        const gpu::RefineEdge& edge = model_.edges[e];
        const float level = state_.edges[e].level;
        const bool still = (state_.edgeHeat[e] & gpu::kRefineBurning) == 0 &&
                           state_.edgeShown[e] == level && settings_.skipStill;
        const uint32_t l = gpu::topLevel(level), steps = 1u << l;
        const float age = gpu::levelMorphAge(level, l);
        const bool same = settings_.skipStill && state_.edgeShown[e] == level && age >= 1;
        state_.edgeMoved[e] = still ? 0 : 1;
        state_.edgeShown[e] = level;
        if (still) return;
        for (uint32_t i = 1; i < steps; ++i) {
            const uint32_t s = gpu::refineEdgeSlot(edge, i, l);
            same ? evaluateMoving(s) : evaluate(s);
        }
        if (l == 0 || age >= 1) return;
        for (uint32_t i = 1; i < steps; i += 2)
            morph(gpu::refineEdgeSlot(edge, i, l), at(gpu::refineEdgeSlot(edge, i - 1, l)),
                  at(gpu::refineEdgeSlot(edge, i + 1, l)), age);
    }

    // State of an edge or interior as one of its vertices shows it.
    [[nodiscard]] uint8_t fateOf(uint32_t s) const {
        const float hole = state_.vertices[s].hole;
        if (hole <= frame_.now) return gpu::kRefineGone;
        return hole < gpu::kRefineNever ? gpu::kRefineStays | gpu::kRefineGoing : gpu::kRefineStays;
    }
    void edgeFate(uint32_t e) {
        if (state_.edgeMoving[e] == 0) return;
        const gpu::RefineEdge& edge = model_.edges[e];
        const uint32_t l = gpu::topLevel(state_.edges[e].level);
        for (uint32_t i = 0; i <= 1u << l; ++i)
            state_.edgeFate[e] |= fateOf(gpu::refineEdgeSlot(edge, i, l));
    }
    void interiorFate(uint32_t i) {
        const gpu::RefineTriangle& t = model_.triangles[i];
        uint8_t moving = state_.interiorMoving[i];
        for (const uint32_t e : t.edge) moving |= state_.edgeMoving[e];
        const uint32_t m = gpu::refineInterior(state_.levels[i]), n = 1u << m;
        if (moving == 0 || m < 2) return;
        for (uint32_t c2 = 1; c2 + 1 < n; ++c2)
            for (uint32_t c1 = 1; c1 + c2 < n; ++c1)
                state_.interiorFate[i] |= fateOf(gpu::refineInnerSlot(t, c1, c2, m));
    }

    // A point of a triangle's lattice, or its position on the edge's polyline.
    [[nodiscard]] glm::vec3 latticePlace(const gpu::RefineTriangle& t, uint32_t levels, uint32_t c1,
                                         uint32_t c2) const {
        const gpu::RefineSpot spot = gpu::refineSpot(t, levels, c1, c2);
        if (spot.side == 3) return at(gpu::refineInnerSlot(t, c1, c2, gpu::refineInterior(levels)));
        const gpu::RefineEdge& edge = model_.edges[t.edge[spot.side]];
        const uint32_t l = gpu::refineSide(levels, spot.side);
        const glm::vec3 a = at(gpu::refineEdgeSlot(edge, spot.i, l));
        if (spot.f == 0) return a;
        return a + (at(gpu::refineEdgeSlot(edge, spot.i + 1, l)) - a) * spot.f;
    }

    void interior(uint32_t i) {
        const gpu::RefineTriangle& t = model_.triangles[i];
        const uint32_t levels = state_.levels[i], m = gpu::refineInterior(levels);
        if (m < 2) {
            state_.interiorShown[i] = -1;
            return;
        }
        const float level = state_.interiors[i].level;
        // A vertex fitted to its sides has no age of its own.
        const float age = gpu::topLevel(level) == m ? gpu::levelMorphAge(level, m) : 1;
        const float shown = float(m) - 1 + age;
        bool still = (state_.interiorHeat[i] & gpu::kRefineBurning) == 0 &&
                     state_.interiorShown[i] == shown && settings_.skipStill;
        if (age < 1)
            for (const uint32_t e : t.edge) still = still && state_.edgeMoved[e] == 0;
        const bool same = settings_.skipStill && state_.interiorShown[i] == shown && age >= 1;
        state_.interiorShown[i] = shown;
        if (still) return;
        const uint32_t n = 1u << m;
        for (uint32_t c2 = 1; c2 + 1 < n; ++c2)
            for (uint32_t c1 = 1; c1 + c2 < n; ++c1) {
                const uint32_t s = gpu::refineInnerSlot(t, c1, c2, m);
                same ? evaluateMoving(s) : evaluate(s);
            }
        if (age >= 1) return;
        for (uint32_t c2 = 1; c2 + 1 < n; ++c2)
            for (uint32_t c1 = 1; c1 + c2 < n; ++c1) {
                if (!gpu::refineIsNew(c1, c2)) continue;
                const gpu::RefineParents p = gpu::refineParents(c1, c2);
                morph(gpu::refineInnerSlot(t, c1, c2, m), latticePlace(t, levels, p.a1, p.a2),
                      latticePlace(t, levels, p.b1, p.b2), age);
            }
    }

    const RefineModel& model_;
    const RefineSettings& settings_;
    const RefineFrame& frame_;
    RefineState& state_;
};

}  // namespace

void refinePlace(const RefineModel& model, const RefineSettings& settings, const RefineFrame& frame,
                 RefineState& state) {
    Placer(model, settings, frame, state).run();
}

}  // namespace fw::mesh
