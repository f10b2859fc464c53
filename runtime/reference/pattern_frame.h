// The refinement pattern on a whole mesh, frame by frame, on the CPU: a template on every coarse
// triangle, a heat boundary that grows from where the fire began, and the list of the triangles
// that the statuses draw. Where their vertices lie and what is consumed is the device's
// (pattern_word.h). Cosmetic, and a function of ticks: equal runs give equal
// lists.
#pragma once
#include "mesh/refine/model.h"
#include "reference/pattern.h"
#include "reference/pattern_word.h"

namespace fw::reference {

using mesh::BurnDomain;
using mesh::RefineModel;
using mesh::RefineOptions;

// A mesh's side of it, at one depth.
struct PatternModel {
    explicit PatternModel(std::pmr::memory_resource* memory)
        : pattern(memory), words(memory), corners(memory), materials(memory) {}
    std::pmr::vector<PatternTriangle> pattern;
    std::pmr::vector<uint32_t> words;  // of the template's triangles
    // Per coarse triangle, in the order of the RefineModel: three corners, m; material.
    std::pmr::vector<glm::vec3> corners;
    std::pmr::vector<uint32_t> materials;
    uint32_t depth = 0;
    float finest = 0;  // m, mean edge of the finest triangles
    [[nodiscard]] uint32_t triangles() const noexcept { return uint32_t(materials.size()); }
    // Triangles with everything at its deepest: no list is longer.
    [[nodiscard]] uint32_t most() const noexcept { return triangles() << (2 * depth); }
};
// How `model` is baked: nothing split beforehand, every side down to `depth`.
RefineOptions patternOptions(uint32_t depth);
// Throws core::Error where the mesh has too many triangles for that depth.
PatternModel makePatternModel(const BurnDomain& domain, const RefineModel& model, uint32_t depth,
                              std::pmr::memory_resource* memory);

struct PatternSettings {
    float psi = 1;            // 1/m^2, > 0
    float step = 0.1f;        // Delta r of a simulation step of 1/32 s, > 0
    float pixelsPerEdge = 8;  // > 0
};

// psi 0: one over the square of the mean finest edge; step 0: as much as `speed` (m/s).
PatternSettings patternSettings(const PatternModel& model, float psi, float step,
                                float speed) noexcept;

// An object's side.
struct PatternState {
    explicit PatternState(std::pmr::memory_resource* memory)
        : status(memory),
          distance(memory),
          nearest(memory),
          stage(memory),
          shown(memory),
          eligible(memory),
          list(memory) {}
    void reset(const PatternModel& model);

    bool lit = false;
    uint32_t litTick = 0;
    PatternHeat heat;
    std::pmr::vector<int8_t> status;   // per coarse triangle the template's
    std::pmr::vector<float> distance;  // per coarse triangle, of the finest: the boundary's radius
                                       // when it reaches a corner
    std::pmr::vector<float> nearest;   // the least of them
    std::pmr::vector<uint8_t> stage;   // 0: not reached; 1: at work; 2: all of it is finest
    std::pmr::vector<uint8_t> shown;   // halvings that its size on the screen is worth
    std::pmr::vector<uint8_t> eligible;  // scratch
    std::pmr::vector<uint32_t> list;     // what is drawn, words by coarse triangle; room for all
    uint32_t listed[gpu::kMaterialsPerObject] = {};  // of each material
    bool full = false;                               // the list holds everything at its deepest
};

// The boundary starts at `origin` (m, object space), as far out as two finest edges: the heat wave
// that runs ahead. One source: later calls change nothing.
void ignitePattern(const PatternModel& model, const PatternSettings& settings, glm::vec3 origin,
                   uint32_t tick, PatternState& state);
// r at a tick.
float patternRadius(const PatternSettings& settings, const PatternState& state, double tick);

struct PatternView {
    glm::vec3 eye{0};  // m, object space
    float focal = 0;   // pixels of 1 m at 1 m; 0: no limit by size
};
// One sweep of the rules where the boundary is, then the list. True: the list is another one.
// full: everything at its deepest, for comparison. Needs no memory.
bool advancePattern(const PatternModel& model, const PatternSettings& settings, double tick,
                    const PatternView& view, bool full, PatternState& state) noexcept;

}  // namespace fw::reference
