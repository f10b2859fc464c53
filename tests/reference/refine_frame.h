// Refinement of one object, frame by frame: levels from heat and views, counts, triangles,
// positions. The reference for the passes in shaders/refine: both follow shaders/shared/refine.h
// lane by lane. Floats, cosmetic; equal input gives equal output on one machine.
#pragma once
#include "mesh/refine/model.h"

namespace fw::mesh {

struct RefineView {
    float eye[3] = {};   // m, object space
    float focal = 1000;  // pixels that 1 m covers at 1 m
};

struct RefineSettings {
    float pixelsPerEdge = 8;     // > 0, screen length of the finest segments
    float rate = 4;              // levels per s once a surface has moved
    float cool = 1;              // s that a level outlasts its heat
    float grace = 0.25f;         // s of burning during which a surface counts as flat
    float recede = 0.9f;         // (0, 1), share of a slot's reach
    uint32_t budget = 400000;    // triangles aimed at; never less than one per coarse triangle
    uint32_t capacity = 600000;  // capacity in triangles, >= budget and coarse triangles
    bool morph = true;           // false: levels are whole, changes are sudden
    bool skipStill = true;       // false: every vertex in use is placed again each frame
};

struct RefineFrame {
    float now = 0, dt = 0;                // s since the object's epoch; since the last frame
    uint32_t nowTick = 0, epochTick = 0;  // the same in ticks
    std::span<const uint8_t> tiles;       // per tile: kRefineHot | kRefineBurning
    std::span<const RefineView> views;    // every view and shadow view; none: no limit by size
    std::span<const uint32_t> ticks;      // state of the object's texels
    std::span<const float> burnSeconds;   // per material: wall burnt through; < 0: never opens
};

struct RefineState {
    RefineState(const RefineModel& model, std::pmr::memory_resource* memory);

    std::pmr::vector<gpu::RefineLevel> edges, interiors;
    std::pmr::vector<uint32_t> levels;             // per triangle, packed
    std::pmr::vector<uint32_t> starts;             // triangles + 1, first output triangle
    std::pmr::vector<uint32_t> indices;            // draw vertices, 3 per output triangle
    std::pmr::vector<gpu::RefineVertex> vertices;  // per slot
    float bias = 0;                                // levels removed by the budget
    bool unmorphed = false;  // the last frame had no capacity for levels on their way down
    uint32_t emissions = 0;  // frames in which `indices` changed
    uint32_t placed = 0;     // vertices placed in the last frame

    // State of the passes between frames.
    float placedAt = -gpu::kRefineNever;  // s, the last frame
    std::pmr::vector<uint8_t> edgeHeat, interiorHeat;
    // Of each edge's and interior's vertices when last placed: kRefineGone, Stays, Going. Where a
    // rim crosses, or will, they stay hot.
    std::pmr::vector<uint8_t> edgeFate, interiorFate;
    std::pmr::vector<uint8_t> edgeMoving, interiorMoving;       // warm a moment ago, or moving
    std::pmr::vector<uint8_t> edgeTops;                         // integer levels, of the last count
    std::pmr::vector<uint32_t> emitted, emittedStarts, before;  // of the last emission
    std::pmr::vector<float> edgeShown, interiorShown;  // levels when last placed; < 0: never
    std::pmr::vector<uint8_t> edgeMoved;               // placed in this frame
};

// Heat of every tile from its TileState::flag: tiles on the front list are hot, tiles on the burn
// list burn. The front list knows of fire one ring of texels ahead, which is warning enough. ahead:
// grid neighbours and dependent tiles over seams are hot too, at a third to a half more triangles.
void refineHeat(const BurnDomain& domain, std::span<const uint32_t> tileFlags, bool ahead,
                std::span<uint8_t> tiles);

// The passes, in order.
void refineLevels(const RefineModel& model, const RefineSettings& settings,
                  const RefineFrame& frame, RefineState& state);
uint32_t refineScan(const RefineModel& model, RefineState& state);  // output triangles
void refineEmit(const RefineModel& model, RefineState& state);
void refinePlace(const RefineModel& model, const RefineSettings& settings, const RefineFrame& frame,
                 RefineState& state);
// All passes; triangles are emitted only when an integer level changed.
void refineFrame(const RefineModel& model, const RefineSettings& settings, const RefineFrame& frame,
                 RefineState& state);

}  // namespace fw::mesh
