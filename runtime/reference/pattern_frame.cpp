// The pattern's statuses on a whole mesh.
#include "reference/pattern_frame.h"

#include "core/error.h"
#include "core/hash.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace fw::reference {
namespace {

constexpr uint32_t kMaxStatuses = 1u << 22;  // of an object
constexpr float kAhead = 2;  // initial lead of the heat wave over the fire, finest edges

// The corner with the right angle in the lattice comes first, whatever corner the template has
// there.
uint32_t wordOf(const PatternTriangle& t, uint32_t depth, uint32_t finest) {
    uint32_t k = 0;
    while (t.corner[k][1] != t.corner[(k + 1) % 3][1] || t.corner[k][0] != t.corner[(k + 2) % 3][0])
        ++k;
    const uint32_t step = kPatternLattice >> depth;
    const bool down = t.corner[(k + 1) % 3][0] < t.corner[k][0];
    return gpu::packPatternWord(t.corner[k][0] / step, t.corner[k][1] / step,
                                depth - (finest - t.setLevel), down);
}

glm::vec3 pointOf(const glm::vec3* corner, const uint8_t (&at)[2]) {
    const float a = float(at[0]) / kPatternLattice, b = float(at[1]) / kPatternLattice;
    return corner[0] * (1 - a - b) + corner[1] * a + corner[2] * b;
}

// Halvings for a triangle's longest edge on the screen.
uint32_t worth(const glm::vec3* corner, const PatternSettings& settings, const PatternView& view,
               uint32_t depth) {
    if (view.focal <= 0) return depth;
    float lod = 0;
    for (int k = 0; k < 3; ++k)
        lod = std::max(lod, gpu::refineLod(corner[k], corner[(k + 1) % 3], view.eye, view.focal,
                                           settings.pixelsPerEdge));
    return std::min(depth, gpu::topLevel(lod));
}

class Lister {
 public:
    Lister(const PatternModel& model, PatternState& state) : model_(model), state_(state) {
        state_.list.clear();
        std::fill(std::begin(state_.listed), std::end(state_.listed), 0u);
    }
    void add(uint32_t coarse, uint32_t triangle) {
        if (state_.list.size() == model_.most()) return;
        FW_ASSERT(triangle < model_.words.size() && state_.list.size() < state_.list.capacity(),
                  "triangle %u, %zu listed", triangle, state_.list.size());
        state_.list.push_back(model_.words[triangle] | coarse << 16);
        ++state_.listed[std::min(model_.materials[coarse], gpu::kMaterialsPerObject - 1)];
    }
    // All triangles of `halvings`.
    void addLevel(uint32_t coarse, uint32_t halvings) {
        const uint32_t first = ((1u << (2 * halvings)) - 1) / 3;  // breadth first
        for (uint32_t k = first; k < first + (1u << (2 * halvings)); ++k) add(coarse, k);
    }
    // Triangles drawn by their statuses, and no finer than `most` halvings: parents stand in for
    // finer children.
    void addDrawn(uint32_t coarse, uint32_t most) {
        const std::span<const int8_t> status(
            state_.status.data() + size_t(coarse) * model_.pattern.size(), model_.pattern.size());
        const uint32_t end = ((4u << (2 * most)) - 1) / 3;
        const uint32_t last = ((1u << (2 * most)) - 1) / 3;
        for (uint32_t k = 0; k < end; ++k)
            if (isPatternDrawn(status, k) || (k >= last && status[k] == kPatternInactive))
                add(coarse, k);
    }

 private:
    const PatternModel& model_;
    PatternState& state_;
};

}  // namespace

RefineOptions patternOptions(uint32_t depth) {
    RefineOptions options;
    options.cellTexels = 0;
    options.splitTexels = 0;
    options.depth = depth;
    return options;
}

PatternModel makePatternModel(const BurnDomain& domain, const RefineModel& model, uint32_t depth,
                              std::pmr::memory_resource* memory) {
    PatternModel made(memory);
    made.depth = depth;
    made.pattern = makePatternTemplate(depth, memory);
    const size_t statuses = model.triangles.size() * made.pattern.size();
    if (model.triangles.size() > gpu::kPatternMaxTriangles || statuses > kMaxStatuses)
        core::fail(FW_ERROR_INVALID_ARGUMENT,
                   "FwBurnableMeshDef::refineDepth is %u and the mesh has %zu triangles: the "
                   "pattern would keep %zu statuses; the limits are %u, and %u triangles.",
                   depth, model.triangles.size(), statuses, kMaxStatuses,
                   gpu::kPatternMaxTriangles);
    for (const PatternTriangle& t : made.pattern)
        made.words.push_back(wordOf(t, depth, kPatternLevels));
    double edges = 0;
    for (const gpu::RefineTriangle& t : model.triangles) {
        glm::vec3 corner[3];
        for (int k = 0; k < 3; ++k) {
            const gpu::RefineSlot& slot = model.slots[model.draws[t.corner[k]].slot];
            corner[k] = {slot.x, slot.y, slot.z};
            made.corners.push_back(corner[k]);
        }
        for (int k = 0; k < 3; ++k) edges += double(glm::distance(corner[k], corner[(k + 1) % 3]));
        made.materials.push_back(domain.vertices[domain.indices[size_t(t.source) * 3]].material);
    }
    const double count = 3.0 * double(std::max<size_t>(model.triangles.size(), 1));
    made.finest = std::max(float(edges / count) / float(1u << depth), 1e-6f);
    return made;
}

PatternSettings patternSettings(const PatternModel& model, float psi, float step,
                                float speed) noexcept {
    PatternSettings settings;
    settings.psi = psi > 0 ? psi : 1 / (model.finest * model.finest);
    const float own =
        speed * std::sqrt(settings.psi) * float(gpu::kStepTicks) / float(gpu::kTicksPerSecond);
    settings.step = std::max(step > 0 ? step : own, 1e-6f);
    return settings;
}

void PatternState::reset(const PatternModel& model) {
    const size_t triangles = model.triangles(), size = model.pattern.size();
    lit = full = false;
    status.assign(triangles * size, kPatternInitial);
    distance.assign(triangles << (2 * model.depth), 0.0f);
    nearest.assign(triangles, 0.0f);
    stage.assign(triangles, 0);
    shown.assign(triangles, 0);
    eligible.assign(size, 0);
    list.clear();
    list.reserve(model.most());
}

void ignitePattern(const PatternModel& model, const PatternSettings& settings, glm::vec3 origin,
                   uint32_t tick, PatternState& state) {
    if (state.lit) return;
    state.lit = true;
    state.litTick = tick;
    const float start = kAhead * model.finest * std::sqrt(settings.psi);
    state.heat = {origin, start, settings.step, settings.psi};
    const uint32_t finest = 1u << (2 * model.depth);
    const size_t first = model.pattern.size() - finest;
    for (uint32_t i = 0; i < model.triangles(); ++i) {
        const glm::vec3* corner = &model.corners[size_t(i) * 3];
        float least = 1e30f;
        for (uint32_t k = 0; k < finest; ++k) {
            float own = 1e30f;
            for (const auto& at : model.pattern[first + k].corner) {
                const uint32_t seed = core::hash32(i ^ core::hash32(uint32_t(at[0]) << 8 | at[1]));
                const float theta = float(seed >> 8) / 8388608.0f;
                own = std::min(own, patternHeatDistance(state.heat, pointOf(corner, at), theta));
            }
            state.distance[size_t(i) * finest + k] = own;
            least = std::min(least, own);
        }
        state.nearest[i] = least;
    }
}

float patternRadius(const PatternSettings& settings, const PatternState& state, double tick) {
    const double steps = std::max(tick - double(state.litTick), 0.0) / gpu::kStepTicks;
    return float(double(state.heat.radius) + double(settings.step) * steps);
}

bool advancePattern(const PatternModel& model, const PatternSettings& settings, double tick,
                    const PatternView& view, bool full, PatternState& state) noexcept {
    FW_ASSERT(state.status.size() == model.triangles() * model.pattern.size(), "%zu statuses",
              state.status.size());
    const float radius = state.lit ? patternRadius(settings, state, tick) : 0;
    const uint32_t finest = 1u << (2 * model.depth);
    const size_t size = model.pattern.size();
    bool changed = state.list.empty() || full != state.full;
    state.full = full;
    for (uint32_t i = 0; i < model.triangles(); ++i) {
        const uint32_t shown = worth(&model.corners[size_t(i) * 3], settings, view, model.depth);
        changed |= shown != state.shown[i];
        state.shown[i] = uint8_t(shown);
        if (!state.lit || state.stage[i] == 2 || state.nearest[i] >= radius) continue;
        state.stage[i] = 2;
        for (uint32_t k = 0; k < finest; ++k) {
            const bool reached = state.distance[size_t(i) * finest + k] < radius;
            state.eligible[size - finest + k] = reached ? 1 : 0;
            if (!reached) state.stage[i] = 1;
        }
        const std::span<int8_t> status(state.status.data() + i * size, size);
        changed |= sweepPattern(model.pattern, PatternRules::repaired, state.eligible, true, status,
                                nullptr) != 0;
    }
    if (!changed) return false;
    Lister lister(model, state);
    for (uint32_t i = 0; i < model.triangles(); ++i) {
        if (full)
            lister.addLevel(i, model.depth);
        else if (state.stage[i] == 0)
            lister.add(i, 0);
        else if (state.stage[i] == 2)
            lister.addLevel(i, state.shown[i]);
        else
            lister.addDrawn(i, state.shown[i]);
    }
    return true;
}

}  // namespace fw::reference
