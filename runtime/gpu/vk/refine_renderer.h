// Adaptive refinement: the buffers that a mesh and an object bring to it, and the objects that a
// frame refines. Its passes are in shaders/refine.
#pragma once
#include "gpu/passes/draw.h"
#include "gpu/vk/frame.h"
#include "gpu/vk/world_buffers.h"

namespace fw::gpu::vk {

struct BackendState;
struct ObjectEntry;

// A mesh's refinement at one depth: the part that its objects share.
struct RefineMesh {
    bool live = false;
    uint32_t edgeCount = 0, triangleCount = 0, cornerCount = 0, slotCount = 0;
    uint32_t fullCount = 0;  // triangles with everything at its deepest
    uint32_t openEdges = 0;
    bool solid = false;                              // it has an inside
    float edgeLength = 0;                            // m, mean of its edges
    uint32_t materialEnd[kMaterialsPerObject] = {};  // of its triangles
    BufferRange triangles, edges, slots, words, draws;
};

struct RefineUse {  // an object's own
    bool on = false;
    bool started = false;  // it is drawn refined: some frame placed it
    uint32_t key = 0;      // of its mesh's refinement
    float pixelsPerEdge = 8;
    uint32_t epochTick = 0;
    uint32_t quietTick = 0;      // it is refined before this; 0: no fire yet
    bool cut = false;            // near: its holes are cut
    bool perPixelHoles = false;  // its cut is too coarse for the holes: texels show them
    uint32_t inner = 0;          // as RefineObject
    bool border = false;         // walls stand along its open edges, whether it burns or not
    float nearness = 0;          // as SurfaceDraw
    float now = 0;               // s since its epoch, of the frame that last placed it
    double turnTick = 0;         // of that frame
    vec4 turnEye{};              // in it: m, object space; w: as RefineRenderer::eyes
    bool due = false;            // it was among the last frame's that refined
    BufferRange items, triangles, slots, indices, cuts;
    uint32_t extendedPlus1 = 0;  // an extension refines it: its number there
    // `thick`: with an inner skin, where the mesh has an inside.
    void allocate(WorldBuffers& buffers, const RefineMesh& mesh, bool thick, uint64_t last);
    // Sets the parts of a draw that follow the object's last refinement.
    void show(DrawItem& item) const noexcept;
};

constexpr uint32_t refineKey(bool extended, uint32_t depth) noexcept {
    return extended ? kRefineDepth + 1 + depth : depth;
}

// Whether a frame may refine the object.
[[nodiscard]] bool refines(const ObjectEntry& object) noexcept;

struct RefineRenderer {
    explicit RefineRenderer(std::pmr::memory_resource* memory) : lists(memory), noise(memory) {}
    // Once, before any mesh: the table of patterns, and the noise of holes.
    void uploadTable(BackendState& s);
    // Which objects the open frame may refine; returns the bytes that it uploads for all of them.
    // May throw.
    uint64_t plan(BackendState& s, const FramePlan& plan);
    void record(BackendState& s, FrameInFlight& slot);
    // Takes the cameras of the open frame's views, which limit levels.
    void takeEyes(const BackendState& s) noexcept;
    [[nodiscard]] RefineObject recordOf(const BackendState& s, const ObjectEntry& object,
                                        bool atFull) const noexcept;

    std::pmr::vector<uint32_t> lists;  // of the frame's work buffer, as it begins
    std::pmr::vector<uint8_t> noise;   // of holes, tiling
    RefinePush push{};                 // of the frame; no objects: nothing is refined
    RefinePush last{};                 // of the last frame that refined
    uint32_t users = 0;                // objects that refine
    BufferRange table;                 // of words, in front of those of all meshes
    // Of the open frame's views. m, world; w: pixels of 1 m at 1 m, 0: no limit by size.
    std::array<vec4, kMaxViews> eyes{};
    uint32_t eyeCount = 0;
    float pixels = 0;   // of 1 m at clip w = 1, where it has most
    float bias = -1;    // levels that the budget takes; below 0: not known yet
    bool full = false;  // everything at its deepest, and placed in every frame

 private:
    void listRefined(const BackendState& s, bool all);
    bool chooseDue(BackendState& s, double now) noexcept;
    void turn(const BackendState& s, ObjectEntry& object, double now, RefineObject& record,
              FrameRecorder& recorder, RefineRecord& frame) const noexcept;
    [[nodiscard]] bool isDue(const BackendState& s, const ObjectEntry& object,
                             const RefineObject& record, double now) const noexcept;
    [[nodiscard]] vec4 eyeFor(const BackendState& s, const ObjectEntry& object) const noexcept;
    [[nodiscard]] bool hasPerPixelHoles(const ObjectEntry& object) const noexcept;
};

}  // namespace fw::gpu::vk
