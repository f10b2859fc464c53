// The adaptive refinement pattern: one template of four-way splits (id, SetLevel,
// Siblings, Parent, Status) laid over every eligible coarse triangle, driven by a growing heat
// boundary. Its rules as printed do not come to rest; the repaired ones do. It cracks between
// coarse triangles and inside a template where levels meet: the product scheme is
// shaders/shared/refine.h.
#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory_resource>
#include <span>
#include <vector>

namespace fw::reference {

constexpr uint32_t kPatternLattice = 64;  // corner coordinates of the template are in 1/64
constexpr uint32_t kPatternLevels = 5;    // SetLevel of the finest
constexpr uint32_t kPatternNone = 0xFFFFFFFFu;

// Status values. Drawn: active and processed, and the root while it is initial.
constexpr int8_t kPatternInactive = -1, kPatternInitial = 0, kPatternActive = 1,
                 kPatternProcessed = 2;

struct PatternTriangle {   // its number is the id; parents come before children
    uint8_t corner[3][2];  // barycentrics 1 and 2
    uint8_t setLevel;      // kPatternLevels: the finest
    uint32_t parent;       // or kPatternNone
    uint32_t firstChild;   // of four, who are each other's siblings; or kPatternNone
};

// The template of `depth` halvings, in 0..5. The finest have SetLevel kPatternLevels, so with four
// the coarse triangle has 1.
std::pmr::vector<PatternTriangle> makePatternTemplate(uint32_t depth,
                                                      std::pmr::memory_resource* memory);

enum class PatternRules {
    printed,   // comes to no rest, and draws most of the area twice
    repaired,  // siblings change only from initial, parents only from initial or active; a parent
};             // goes inactive when no child is initial

// One sweep of all three rules. serial: later triangles see what earlier ones did, from the leaves
// up; else all read the state before. Returns how many statuses changed.
uint32_t sweepPattern(std::span<const PatternTriangle> pattern, PatternRules rules,
                      std::span<const uint8_t> eligible, bool serial, std::span<int8_t> status,
                      std::pmr::memory_resource* memory);
bool isPatternDrawn(std::span<const int8_t> status, uint32_t triangle) noexcept;

// R^2 = | sin(pi Theta / dr) + sin(pi Theta) + psi |x - x0|^2 |: the boundary's own distance of a
// point. The fire has reached it once the radius, which grows by dr per step, exceeds R.
struct PatternHeat {
    glm::vec3 origin{0};  // m
    float radius = 0;     // grows by `step`
    float step = 0.1f;    // dr, > 0
    float psi = 1;        // 1/m^2, by the size of the triangles
};
float patternHeatDistance(const PatternHeat& heat, glm::vec3 point, float theta);

}  // namespace fw::reference
