// Levels from heat, triangles from levels.
#include "mesh/refine/table.h"
#include "reference/refine_frame.h"

#include <algorithm>
#include <cmath>

namespace fw::mesh {
namespace {

// While it opens, and where the rim of a hole remains, an item keeps its levels.
void keepRims(std::span<uint8_t> fates, std::span<uint8_t> heat) {
    constexpr uint8_t kRim = gpu::kRefineGone | gpu::kRefineStays;
    for (size_t i = 0; i < fates.size(); ++i) {
        if ((fates[i] & gpu::kRefineGoing) != 0 || (fates[i] & kRim) == kRim)
            heat[i] |= gpu::kRefineHot;
        fates[i] &= gpu::kRefineGone;
    }
}

// Heat of edges and interiors from that of the tiles. The cost follows the fire.
void warm(const RefineModel& model, const RefineFrame& frame, RefineState& state) {
    std::fill(state.edgeHeat.begin(), state.edgeHeat.end(), uint8_t(0));
    std::fill(state.interiorHeat.begin(), state.interiorHeat.end(), uint8_t(0));
    const uint32_t edges = uint32_t(model.edges.size());
    for (uint32_t t = 0; t < model.tileCount; ++t) {
        const uint8_t heat = frame.tiles[t];
        if (heat == 0) continue;
        for (uint32_t i = model.tileStart[t]; i < model.tileStart[t + 1]; ++i) {
            const uint32_t item = model.tileItems[i];
            (item < edges ? state.edgeHeat[item] : state.interiorHeat[item - edges]) |= heat;
        }
    }
    keepRims(state.edgeFate, state.edgeHeat);
    keepRims(state.interiorFate, state.interiorHeat);
}

glm::vec3 cornerPlace(const RefineModel& model, uint32_t slot) {
    const gpu::RefineSlot& s = model.slots[slot];
    return {s.x, s.y, s.z};
}

float lodOf(const RefineModel& model, const RefineSettings& settings, const RefineFrame& frame,
            const gpu::RefineEdge& edge) {
    if (frame.views.empty()) return float(gpu::kRefineDepth + 1);
    const glm::vec3 a = cornerPlace(model, edge.low), b = cornerPlace(model, edge.high);
    float most = 0;
    for (const RefineView& v : frame.views)
        most = std::max(most, gpu::refineLod(a, b, {v.eye[0], v.eye[1], v.eye[2]}, v.focal,
                                             settings.pixelsPerEdge));
    return most;
}

// Has it neither heat nor a remainder?
bool asleep(const gpu::RefineLevel& s, uint8_t heat) {
    return heat == 0 && s.level == 0 && s.target == 0;
}

void aim(const RefineModel& model, const RefineSettings& settings, const RefineFrame& frame,
         RefineState& state) {
    for (size_t e = 0; e < model.edges.size(); ++e) {
        if (asleep(state.edges[e], state.edgeHeat[e])) continue;
        gpu::setRefineTarget(state.edges[e], state.edgeHeat[e],
                             lodOf(model, settings, frame, model.edges[e]),
                             float(model.edges[e].flags & 15), frame.now, settings.cool);
    }
    for (size_t i = 0; i < model.triangles.size(); ++i) {
        if (asleep(state.interiors[i], state.interiorHeat[i])) continue;
        const gpu::RefineTriangle& t = model.triangles[i];
        float lod = 0;
        for (const uint32_t e : t.edge)
            lod = std::max(lod, lodOf(model, settings, frame, model.edges[e]));
        gpu::setRefineTarget(state.interiors[i], state.interiorHeat[i], lod,
                             float(gpu::refineInteriorDepth(t.flags)), frame.now, settings.cool);
    }
}

// Target levels. Edges and interiors use separate numbers, so that both lose levels in one mixed
// order.
float edgeWant(const RefineState& state, uint32_t e, float bias) {
    const float target = state.edges[e].target;
    if (target == 0 || bias == 0) return target;
    return gpu::biasedLevel(target, bias, gpu::levelLossOrder(e * 2, state.edgeHeat[e]));
}
float interiorWant(const RefineState& state, uint32_t i, float bias) {
    const float target = state.interiors[i].target;
    if (target == 0 || bias == 0) return target;
    return gpu::biasedLevel(target, bias, gpu::levelLossOrder(i * 2 + 1, state.interiorHeat[i]));
}

uint32_t packed(const RefineState& state, const gpu::RefineTriangle& t, uint32_t interior) {
    const uint32_t a = state.edgeTops[t.edge[0]], b = state.edgeTops[t.edge[1]],
                   c = state.edgeTops[t.edge[2]];
    return gpu::refinePack(a, b, c, gpu::fitInterior(a, b, c, interior));
}

// Number of triangles for this bias; stops counting above `most`.
uint64_t aimedCount(const RefineModel& model, RefineState& state, float bias, uint64_t most) {
    for (uint32_t e = 0; e < model.edges.size(); ++e)
        state.edgeTops[e] = uint8_t(gpu::topLevel(edgeWant(state, e, bias)));
    uint64_t sum = 0;
    for (uint32_t i = 0; i < model.triangles.size() && sum <= most; ++i)
        sum += gpu::refineCount(
            packed(state, model.triangles[i], gpu::topLevel(interiorWant(state, i, bias))));
    return sum;
}

// The least of sixteen biases that fits the budget.
float minBias(const RefineModel& model, RefineState& state, uint32_t budget) {
    for (uint32_t k = 0; k + 1 < gpu::kRefineBiases; ++k) {
        const float bias = float(k) * gpu::kRefineBiasStep;
        if (aimedCount(model, state, bias, budget) <= budget) return bias;
    }
    return float(gpu::kRefineBiases - 1) * gpu::kRefineBiasStep;
}

// Does it move, or was it warm a moment ago?
uint8_t move(const RefineSettings& settings, const RefineFrame& frame, float want,
             gpu::RefineLevel& level) {
    const float before = level.level;
    gpu::moveRefineLevel(level, want, frame.now, frame.dt, settings.morph ? settings.rate : 1e9f,
                         settings.grace);
    if (!settings.morph) level.level = float(gpu::topLevel(level.level));
    return level.level != before || frame.now - level.lastHot < settings.cool ? 1 : 0;
}

// Levels of all triangles from those of edges and interiors, and their number of output triangles.
uint64_t packAll(const RefineModel& model, RefineState& state) {
    for (uint32_t e = 0; e < model.edges.size(); ++e)
        state.edgeTops[e] = uint8_t(gpu::topLevel(state.edges[e].level));
    uint64_t sum = 0;
    for (uint32_t i = 0; i < model.triangles.size(); ++i) {
        const uint32_t before = state.levels[i];
        state.levels[i] =
            packed(state, model.triangles[i], gpu::topLevel(state.interiors[i].level));
        if (state.levels[i] != before) state.interiorMoving[i] = 1;
        sum += gpu::refineCount(state.levels[i]);
    }
    return sum;
}

}  // namespace

RefineState::RefineState(const RefineModel& model, std::pmr::memory_resource* memory)
    : edges(model.edges.size(), {0, 0, -gpu::kRefineNever, gpu::kRefineNever}, memory),
      interiors(model.triangles.size(), {0, 0, -gpu::kRefineNever, gpu::kRefineNever}, memory),
      levels(model.triangles.size(), 0, memory),
      starts(model.triangles.size() + 1, 0, memory),
      indices(memory),
      vertices(model.slots.size(), memory),
      edgeHeat(model.edges.size(), 0, memory),
      interiorHeat(model.triangles.size(), 0, memory),
      edgeFate(model.edges.size(), 0, memory),
      interiorFate(model.triangles.size(), 0, memory),
      edgeMoving(model.edges.size(), 0, memory),
      interiorMoving(model.triangles.size(), 0, memory),
      edgeTops(model.edges.size(), 0, memory),
      emitted(memory),
      emittedStarts(memory),
      before(memory),
      edgeShown(model.edges.size(), -1.0f, memory),
      interiorShown(model.triangles.size(), -1.0f, memory),
      edgeMoved(model.edges.size(), 0, memory) {
    for (size_t s = 0; s < vertices.size(); ++s)
        vertices[s] = {model.slots[s].x, model.slots[s].y, model.slots[s].z, gpu::kRefineNever};
}

void refineHeat(const BurnDomain& domain, std::span<const uint32_t> tileFlags, bool ahead,
                std::span<uint8_t> tiles) {
    std::fill(tiles.begin(), tiles.end(), uint8_t(0));
    const int width = int(domain.tilesX), height = int(domain.tilesY);
    for (uint32_t t = 0; t < domain.tileCount(); ++t) {
        if ((tileFlags[t] & (gpu::kTileListed | gpu::kTileBurning)) == 0) continue;
        tiles[t] |= gpu::kRefineHot;
        if ((tileFlags[t] & gpu::kTileBurning) != 0) tiles[t] |= gpu::kRefineBurning;
        if (!ahead) continue;
        const int x = int(t) % width, y = int(t) / width;
        for (int v = std::max(0, y - 1); v <= std::min(height - 1, y + 1); ++v)
            for (int u = std::max(0, x - 1); u <= std::min(width - 1, x + 1); ++u)
                tiles[size_t(v * width + u)] |= gpu::kRefineHot;
        const TileStatic& tile = domain.tiles[t];
        for (uint32_t r = 0; r < tile.dependentCount; ++r)
            tiles[domain.dependents[tile.dependentStart + r]] |= gpu::kRefineHot;
    }
}

void refineLevels(const RefineModel& model, const RefineSettings& settings,
                  const RefineFrame& frame, RefineState& state) {
    warm(model, frame, state);
    aim(model, settings, frame, state);
    state.bias = minBias(model, state, settings.budget);
    for (uint32_t e = 0; e < state.edges.size(); ++e)
        state.edgeMoving[e] = move(settings, frame, edgeWant(state, e, state.bias), state.edges[e]);
    for (uint32_t i = 0; i < state.interiors.size(); ++i)
        state.interiorMoving[i] =
            move(settings, frame, interiorWant(state, i, state.bias), state.interiors[i]);
    state.unmorphed = packAll(model, state) > settings.capacity;
    if (!state.unmorphed) return;
    for (uint32_t e = 0; e < state.edges.size(); ++e)
        state.edges[e].level = edgeWant(state, e, state.bias);
    for (uint32_t i = 0; i < state.interiors.size(); ++i)
        state.interiors[i].level = interiorWant(state, i, state.bias);
    packAll(model, state);
}

uint32_t refineScan(const RefineModel& model, RefineState& state) {
    uint32_t sum = 0;
    for (size_t i = 0; i < model.triangles.size(); ++i) {
        state.starts[i] = sum;
        sum += gpu::refineCount(state.levels[i]);
    }
    state.starts[model.triangles.size()] = sum;
    return sum;
}

void refineEmit(const RefineModel& model, RefineState& state) {
    // Triangles with unchanged levels are moved, not emitted again.
    std::swap(state.indices, state.before);
    state.indices.resize(size_t(state.starts.back()) * 3);
    const bool known = state.emitted.size() == state.levels.size();
    const size_t count = model.triangles.size();
    for (size_t i = 0; i < count;) {
        size_t end = i;
        while (known && end < count && state.emitted[end] == state.levels[end]) ++end;
        if (end > i) {
            const uint32_t* from = &state.before[size_t(state.emittedStarts[i]) * 3];
            const size_t length = size_t(state.starts[end] - state.starts[i]) * 3;
            std::copy(from, from + length, &state.indices[size_t(state.starts[i]) * 3]);
            i = end;
            continue;
        }
        const gpu::RefineTriangle& t = model.triangles[i];
        const uint32_t levels = state.levels[i];
        uint32_t* out = &state.indices[size_t(state.starts[i]) * 3];
        for (uint32_t k = 0; k < state.starts[i + 1] - state.starts[i]; ++k) {
            const glm::uvec3 codes = refineTriangle(levels, k);
            for (int v = 0; v < 3; ++v) *out++ = gpu::refineDrawVertex(t, levels, codes[v]);
        }
        ++i;
    }
    state.emitted = state.levels;
    state.emittedStarts = state.starts;
    ++state.emissions;
}

void refineFrame(const RefineModel& model, const RefineSettings& settings, const RefineFrame& frame,
                 RefineState& state) {
    refineLevels(model, settings, frame, state);
    if (state.emitted != state.levels) {
        refineScan(model, state);
        refineEmit(model, state);
    }
    refinePlace(model, settings, frame, state);
}

}  // namespace fw::mesh
