// The burnt object as a closed shell: the remaining outer skin, the inner skin behind it, and walls
// along holes and open edges. Corners are named by slots and small edges, so that neighbours agree
// by number; positions follow from the frame's vertices.
#pragma once
#include "reference/refine_frame.h"

namespace fw::mesh {

constexpr uint32_t kRefineInside = 0x80000000u;  // in RefineCorner::high: on the inner skin
struct RefineCorner {
    uint32_t low;   // slot
    uint32_t high;  // the same, or a cut point of the small edge low < high; kRefineInside
};

struct RefineShell {
    explicit RefineShell(std::pmr::memory_resource* memory) : corners(memory) {}

    std::pmr::vector<RefineCorner> corners;            // 3 per triangle
    uint32_t outer = 0, inner = 0, rim = 0, wall = 0;  // triangles of each kind
    uint32_t gone = 0;                                 // small triangles without a remainder
};

// inner: with the inner skin and walls (an object without a hole needs none); else the outer only.
// Replaces the shell's content.
void refineShell(const RefineModel& model, const RefineState& state, float now, bool inner,
                 RefineShell& shell);
glm::vec3 refineCornerPlace(const RefineModel& model, const RefineState& state, float now,
                            const RefineCorner& corner);
// Does any vertex in use of this triangle burn through by `now`? Others need no cut.
bool refineHoled(const RefineModel& model, const RefineState& state, float now, uint32_t triangle);

}  // namespace fw::mesh
